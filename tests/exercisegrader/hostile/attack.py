"""What an attack is: a submission that tries something, and what must have become of it."""

import hashlib
import json
import os
import re
import string
from collections.abc import Callable, Iterable
from dataclasses import asdict, dataclass, field
from pathlib import Path

#: What a test plants where no submission may look; the attacks hunt for it and put what they find into an answer.
CANARY = re.compile(r"canary-[a-z]+-[0-9a-f]{32}")
#: What an attack answers when it could do what no submission may do.
ESCAPED = "ESCAPED"
#: The name of processes that attacks leave behind (15 signs are all that Linux keeps).
PROCESS = "loopbook-hostil"

COMPLETE, STOPPED, NOT_RUN, MISSING = "complete", "stopped", "not run", "missing"


def canary(place):
    """Return the canary of a place, a word of small letters; the same one every time.

    >>> bool(CANARY.fullmatch(canary("secret")))
    True
    """
    return f"canary-{place}-{hashlib.md5(place.encode()).hexdigest()}"


@dataclass(frozen=True)
class Target:
    """What a test gives to the attacks.

    Arguments:
        answers: {number: source of a cell that answers the exercise correctly} of two exercises.
        leak: number and name of a quantity of a third exercise that takes a text; what was found goes there.
        names: names of the quantities of the second exercise, for answers that lie.
        other: id of another student.
        reads: files that must not be readable: assignment, roster, other submissions, results.
        writes: files and folders that must not be writable; they should be copies made for the test.
        outside: a file that exists outside the jail, and must not be seen inside.
        port: of 127.0.0.1 and ::1, where the test listens; 0 where it does not.
        socket: path of a Unix socket, and name of an abstract one, on which the test listens.
        setup: source of the released set-up cell.
        megabytes, processes: more than the jail allows; bombs stop there, and say that they got so far.
    """

    answers: dict[str, str]
    leak: tuple[str, str]
    names: tuple[str, ...]
    other: str = "s1002"
    reads: tuple[str, ...] = ()
    writes: tuple[str, ...] = ()
    outside: str = "/nowhere"
    port: int = 0
    socket: str = "/nowhere.sock"
    setup: str = 'from exercisegrader.inside.answer_sheet import AnswerSheet\n\nsheet = AnswerSheet("", student="")'
    megabytes: int = 4000
    processes: int = 1500

    def prelude(self):
        """The cell with what the attacks share: what is given to them, and how they report."""
        given = {
            "leak": self.leak,
            "second": list(self.answers)[1],
            "names": self.names,
            "other": self.other,
            "reads": self.reads,
            "writes": self.writes,
            "outside": self.outside,
            "pid_namespace": _pid_namespace(),
            "port": self.port,
            "socket": self.socket,
            "megabytes": self.megabytes,
            "processes": self.processes,
        }
        return string.Template(_PRELUDE).substitute(given=repr(json.dumps(given)))


@dataclass(frozen=True)
class Expects:
    """What must have become of an attack.

    Arguments:
        counts: numbers of the exercises whose answers must all be right.
        may: those whose answers may be right, or not have arrived; all others must bring nothing.
        statuses: of the submission, allowed ones.
    """

    counts: frozenset[str] = frozenset({"1"})
    may: frozenset[str] = frozenset({"2"})
    statuses: frozenset[str] = frozenset({COMPLETE, STOPPED})


@dataclass(frozen=True)
class Attack:
    """A hostile submission.

    Attributes:
        name: unique.
        item: the item of the corpus that it belongs to.
        expects: `Expects`.
        cells: of a notebook, after the first answer; or none where the attack is a file.
        before: cells before the first answer.
        content: makes the bytes of the submitted file, given cells that answer correctly.
        place: instead of a file, puts what it likes into the folder of submissions, given the student's id and the
            bytes of a notebook that answers correctly.
        archive: makes the bytes of a zip, given the same; the submissions are then this zip.
    """

    name: str
    item: str
    expects: Expects = field(default_factory=Expects)
    cells: tuple[str, ...] = ()
    before: tuple[str, ...] = ()
    content: Callable[[list[str]], bytes] | None = None
    place: Callable[[Path, str, bytes], None] | None = None
    archive: Callable[[str, bytes], bytes] | None = None

    @property
    def needs_a_jail(self):
        """Whether it does harm without one; then it does nothing at all, and says so."""
        return any("only_in_a_jail()" in cell for cell in (*self.before, *self.cells))

    def sources(self, target):
        """The sources of all code cells of the notebook."""
        first, second = target.answers.values()
        return [target.setup, target.prelude(), *self.before, first, *self.cells, second]

    def bytes(self, target):
        """The bytes of the submitted file; for what is no file, of a notebook that answers correctly."""
        right = [target.setup, *target.answers.values()]
        if self.content:
            return self.content(right)
        return notebook(right if self.place or self.archive else self.sources(target))

    def submit(self, target, folder, student, name):
        """Put the attack into a folder of submissions, as `student/name`; an archive has no place in one."""
        if self.place:
            self.place(Path(folder), student, self.bytes(target))
            return
        path = Path(folder, student, name)
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_bytes(self.bytes(target))

    def complaints(self, result, target):
        """Return what is wrong with the result of the attack's submission, in sentences; none is as it should be.

        Arguments:
            result: of the submission, as the grader stores it.
            target: what the attack was given.
        """
        found = []
        if result.status not in self.expects.statuses:
            found.append(f"the status is {result.status!r} ({result.says}), not {sorted(self.expects.statuses)}")
        for one in result.exercises:
            if one.number in self.expects.counts and one.earned != one.points:
                found.append(f"exercise {one.number} brings {one.earned} of {one.points}: its answers are lost")
            if one.number not in self.expects.counts | self.expects.may and one.earned:
                found.append(f"exercise {one.number} brings {one.earned} that nobody has earned")
        found += leaks(json.dumps(asdict(result), ensure_ascii=False))
        return [f"{self.name}: {sentence}" for sentence in found]


#: Whatever happens in the middle, the first answer counts.
STOPS = Expects()
#: Nothing comes of it: the cells after it run, and their answers count.
GOES_ON = Expects(frozenset({"1", "2"}), frozenset(), frozenset({COMPLETE}))
#: After the tools were spoilt nothing must count; what counts all the same is right.
SPOILT = Expects(frozenset(), frozenset({"1", "2"}))
#: The same where a submission may say that it is none.
MAY_REFUSE = Expects(frozenset(), frozenset({"1", "2"}), frozenset({COMPLETE, STOPPED, NOT_RUN}))
#: What must have become of an attack, as a file of attacks says it behind the arrow.
BECOMES = {"": STOPS, "goes on": GOES_ON, "spoilt": SPOILT, "may refuse": MAY_REFUSE}


def attack(item, name, *cells, expects=STOPS, before=()):
    """Return the attack of a notebook, with cells after and before the first answer."""
    after, before = (tuple(cell.strip("\n") for cell in group) for group in (cells, before))
    return Attack(f"{item}: {name}", item, expects, after, before)


def told(name):
    """Return the attacks that a file beside this one tells, as Python with marks at the beginning of a line.

    ``=== item: name -> what becomes of it`` begins an attack, and ``---`` another cell; what is above
    ``--- first answer`` comes before it. ``=== part word`` is code with which each cell below ``--- word`` begins.
    """
    parts, found = {}, []
    text = Path(__file__).with_name(f"{name}.txt").read_text(encoding="utf-8")
    for block in re.split("^=== ", text, flags=re.MULTILINE)[1:]:
        title, _, body = block.partition("\n")
        if title.startswith("part "):
            parts[title.removeprefix("part ")] = body.strip("\n")
            continue
        title, _, becomes = title.partition(" -> ")
        item, _, one = title.partition(": ")
        before, _, after = body.rpartition("--- first answer\n")
        cells = _cells(after, parts)
        found.append(attack(item, one, *cells, expects=BECOMES[becomes], before=_cells(before, parts)))
    return found


def _cells(text, parts):
    """The cells in a text of a file of attacks."""
    first, *others = re.split(r"^---(?: (\w+))?\n", text, flags=re.MULTILINE)
    pieces = [(None, first), *zip(others[::2], others[1::2], strict=True)]
    cells = [f"{parts[part]}\n\n\n{cell}" if part else cell for part, cell in pieces]
    return [cell for cell in cells if cell.strip("\n")]


def leaks(text):
    """Return what a text shows that no submission should have got hold of."""
    found = sorted(set(CANARY.findall(text))) + re.findall(rf"{ESCAPED}[^\";]*", text)
    return [f"it could get out: {one}" for one in found]


def notebook(sources: Iterable[str], **metadata):
    """Return the bytes of a notebook with code cells."""
    cells = [
        {"cell_type": "code", "execution_count": None, "id": f"c{k}", "metadata": {}, "outputs": [], "source": source}
        for k, source in enumerate(sources)
    ]
    kernel = {"kernelspec": {"display_name": "Python 3", "language": "python", "name": "python3"}}
    content = {"cells": cells, "metadata": kernel | metadata, "nbformat": 4, "nbformat_minor": 5}
    return json.dumps(content, ensure_ascii=False).encode("utf-8", "surrogatepass")


def survivors():
    """Return the numbers of the processes that attacks have left behind on this machine."""
    found = []
    for process in Path("/proc").glob("[0-9]*"):
        try:
            if process.joinpath("comm").read_text().strip() == PROCESS:
                found.append(int(process.name))
        except OSError:  # it is over
            continue
    return found


def _pid_namespace():
    try:
        return os.readlink("/proc/self/ns/pid")
    except OSError:  # not Linux
        return ""


_PRELUDE = r"""
import ctypes, fcntl, json, os, re, signal, socket, subprocess, sys, threading, time

GIVEN = json.loads($given)
LIBC = ctypes.CDLL(None, use_errno=True)
LEAKS = []
HUNTED = re.compile(rb"canary-[a-z]+-[0-9a-f]{32}")


def leak(text):
    LEAKS.append(str(text)[:600])
    number, name = GIVEN["leak"]
    sheet.answer(number, **{name: "; ".join(LEAKS)[-4500:]})


def escaped(what):
    leak("ESC" + "APED: " + str(what))


def hunt(data, where):
    for found in set(HUNTED.findall(data)):
        leak(f"{found.decode()} in {where}")


def only_in_a_jail():
    try:
        same = os.readlink("/proc/self/ns/pid") == GIVEN["pid_namespace"]
    except OSError:
        same = False
    if same or os.path.exists(GIVEN["outside"]):
        escaped("there is no jail around this; nothing was tried")
        raise RuntimeError("no jail")


def attempt(what, function, *arguments):
    try:
        found = function(*arguments)
    except Exception:
        return None
    escaped(what)
    return found


def give(value):
    sheet.answer(GIVEN["second"], **{name: value for name in GIVEN["names"]})


def pids():
    try:
        return [int(name) for name in os.listdir("/proc") if name.isdigit()]
    except OSError:
        return []


def call_oneself():
    LIBC.prctl(15, b"loopbook-hostil", 0, 0, 0)
""".strip()
