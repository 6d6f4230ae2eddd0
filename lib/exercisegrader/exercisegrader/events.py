"""What a submission tells while it runs, read with suspicion: whoever runs a submission's code can tell anything.

A line is a JSON object with one entry, as `shell.run` tells them. What is something else is counted and skipped.
Nothing here decides on marks: an answer is a claim of the student's, and whose it is was known before.
"""

from __future__ import annotations

import json
import math
import signal
from dataclasses import dataclass, field
from time import monotonic
from typing import Any, BinaryIO

from exercisebook.judging import harmless
from exercisegrader.inside.plain import DEEPEST, MOST_DIGITS

#: So many exercises, quantities of one, and errors are kept.
MOST = 200
#: No notebook has more cells.
MOST_CELLS = 10**6
#: What a cell, and a notebook, may show (characters).
LONGEST_SHOWN, MOST_SHOWN = 500_000, 3_000_000


@dataclass(frozen=True)
class Outcome:
    """What became of a submission.

    Attributes:
        answers: {exercise: {name: plain data}}, the last one of each that is more than a placeholder.
        errors: pairs of a cell's number and a sentence.
        named: the students that the notebook and its sheets name, without repetition.
        stopped: a sentence on why it did not run to its end; empty where it did.
        refused: a sentence on why it did not run at all.
        odd: how many lines could not be read.
    """

    answers: dict[str, dict[str, Any]] = field(default_factory=dict)
    errors: tuple[tuple[int, str], ...] = ()
    named: tuple[str, ...] = ()
    stopped: str = ""
    refused: str = ""
    odd: int = 0


class Story:
    """The events of one submission, as they come.

    Arguments:
        longest: line, and all lines together (bytes).

    Attributes:
        cell_began: when the running cell began (s, of the monotonic clock).
        too_long: a sentence where it told more than it may.
    """

    def __init__(self, longest: int, most: int):
        self.longest, self.most = longest, most
        self.answers: dict[str, dict[str, Any]] = {}
        self.errors: list[tuple[int, str]] = []
        self.named: dict[str, bool] = {}
        self.refused, self.ended, self.odd, self.cell = "", False, 0, 0
        self.cell_began, self.too_long = monotonic(), ""
        self._left, self._taken, self._skipping = b"", 0, False

    def read(self, events: BinaryIO) -> bool:
        """Take what has come; returns whether more may come."""
        chunk = events.read(65536)
        if not chunk:
            return False
        # cut where the limit is, not where a piece happens to end: so that the same lines count each time
        chunk, size = chunk[: max(0, self.most - self._taken)], len(chunk)
        self._taken += size
        if self._taken > self.most:
            self.too_long = "it told more than the grader takes"
        *lines, self._left = (self._left + chunk).split(b"\n")
        for line in lines:
            if self._skipping or len(line) > self.longest:
                self._skipping = False
                self.odd += 1
            else:
                self._take(line)
        if len(self._left) > self.longest:
            self._left, self._skipping = b"", True
        return True

    def _take(self, line):
        try:
            ((what, value),) = json.loads(line.decode(), parse_constant=_no_number).items()
            self._tell(what, value)
        except Exception:  # whatever it is, it is not what a notebook's answers look like
            self.odd += 1

    def _tell(self, what, value):
        """Take an event; raises anything for what is none."""
        match what:
            case "refused" if not (self.cell or self.answers):  # later it runs
                self.refused = self.refused or harmless(value)
            case "made for":
                self._named(value)
            case "cell":
                self.cell, self.cell_began = _place(value), monotonic()
            case "error":
                number, says = _place(value["cell"]), harmless(value["says"])
                if len(self.errors) < MOST:
                    self.errors.append((number, says))
            case "answer":
                self._answer(value)
            case "end":
                self.ended = True
            case _:
                raise ValueError(what)

    def _named(self, student):
        if student and len(self.named) < MOST:
            self.named[harmless(student)] = True

    def _answer(self, answer):
        number, given = answer["exercise"], answer["given"]
        if not (isinstance(number, str) and isinstance(given, dict) and len(self.answers) < MOST and len(given) < MOST):
            raise ValueError
        if not all(map(_is_plain, given.values())):
            raise ValueError
        self._named(answer["student"])
        # what is still a placeholder, in a copy of the cell, takes nothing back
        filled = {name: value for name, value in given.items() if value is not None}
        self.answers.setdefault(number, {}).update(filled)

    def outcome(self, why: str, exit_code: int) -> Outcome:
        """Return the `Outcome`.

        Arguments:
            why: it was ended from outside, in a sentence; empty where it ended by itself.
            exit_code: of its first process, or minus the signal that ended it.
        """
        if not (why or self.refused) and not (self.ended and exit_code == 0):
            why = f"its process ended by {_ended(exit_code)}"
        stopped = f"stopped in cell {self.cell}: {why}" if why and self.cell else why
        return Outcome(self.answers, tuple(self.errors), tuple(self.named), stopped, self.refused, self.odd)


@dataclass(frozen=True)
class Shown:
    """What a cell has shown: its number, "text", "error" or "png", and the data, a text or a picture in base64."""

    cell: int
    kind: str
    data: str


class Scene(Story):
    """The events of a submission that is run to be shown; its answers count for nothing.

    Attributes:
        shown: so much as MOST_SHOWN allows, in the order in which it came.
    """

    def __init__(self):
        super().__init__(4 * LONGEST_SHOWN, 4 * MOST_SHOWN)
        self.shown: list[Shown] = []
        self._room, self._in_cell = MOST_SHOWN, {}

    def _tell(self, what, value):
        if what == "shown":
            cell, kind, data = _place(value["cell"]), value["kind"], value["data"]
            if kind not in ("text", "png") or not isinstance(data, str):
                raise ValueError(kind)
            self._take_in(Shown(cell, kind, data))
            return
        super()._tell(what, value)
        if what == "error":
            self._take_in(Shown(_place(value["cell"]), "error", harmless(value["says"])))

    def _take_in(self, shown):
        self._room -= len(shown.data) + 10
        self._in_cell[shown.cell] = self._in_cell.get(shown.cell, 0) + len(shown.data) + 10
        if self._room >= 0 and self._in_cell[shown.cell] <= LONGEST_SHOWN:
            self.shown.append(shown)


_SIGNALS = {
    "SIGSEGV": "a segmentation fault",
    "SIGXCPU": "too much processor time",
    "SIGXFSZ": "a file that is too large",
    "SIGKILL": "force",
}


def _ended(exit_code):
    if exit_code >= 0:
        return "itself"
    name = {one.value: one.name for one in signal.Signals}.get(-exit_code, f"signal {-exit_code}")
    return _SIGNALS.get(name, name)


def _no_number(name):
    raise ValueError(name)


def _place(number):
    """The number of a cell; raises ValueError for another one."""
    if type(number) is not int or not 0 < number <= MOST_CELLS:
        raise ValueError(number)
    return number


def _is_plain(value, depth=0):
    """Whether data may come from `plain`: finite (1e999 is not), and not too deep for whoever goes through it later."""
    match value:
        case float():
            return math.isfinite(value)
        case int():
            return value.bit_length() <= MOST_DIGITS * math.log2(10)
        case list() | dict():
            inside = value.values() if isinstance(value, dict) else value
            return depth < DEEPEST and all(_is_plain(one, depth + 1) for one in inside)
    return True
