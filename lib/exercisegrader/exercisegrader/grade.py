"""Grading a class: collect, run, judge, keep, report. Interrupted at any moment, the same call goes on.

Each submission is one task, which knows nothing of the others. It is followed by a thread; the student's code is in a
child, behind the jail's walls.
"""

from __future__ import annotations

import contextlib
import json
import os
import threading
from collections.abc import Callable, Collection, Iterator, Mapping, Sequence
from concurrent.futures import FIRST_COMPLETED, Executor, ThreadPoolExecutor, wait
from contextlib import AbstractContextManager
from dataclasses import dataclass, replace
from pathlib import Path
from typing import TYPE_CHECKING

from exercisebook.judging import harmless
from exercisegrader import GradingError, NoJail, lms
from exercisegrader.events import Outcome
from exercisegrader.imprint import peek, what_it_is
from exercisegrader.jail import USUAL, Jail, Limits, demand_hidden
from exercisegrader.judge import Judge
from exercisegrader.keeping import Kept, executed, source
from exercisegrader.marking import Marking
from exercisegrader.paper import typed
from exercisegrader.released import Released
from exercisegrader.reports import registered, write_all
from exercisegrader.results import (
    COMPLETE,
    MISSING,
    NOT_RUN,
    STOPPED,
    CellError,
    Result,
    Results,
    fingerprint,
    looks,
    same_each_time,
)
from exercisegrader.sources import answered
from exercisegrader.student import in_short
from exercisegrader.submissions import collect

if TYPE_CHECKING:
    from exercisegrader.assignment import Assignment
    from exercisegrader.student import Student

#: Where so many submissions that were graded before are gone, and most of them, something else has happened.
FEWEST_GONE = 3
#: Tasks that wait for each worker: none is idle, and the notebooks of a large class are not all in memory.
WAITING = 2


@dataclass(frozen=True)
class Task:
    """A submission to be graded, as a worker gets it: plain values."""

    name: str
    source: str
    path: str
    student: str
    label: str
    content: bytes
    problem: str
    jailed: bool
    limits: Limits
    fingerprint: str
    numbers: dict[str, dict[str, str]]
    doubts: tuple[str, ...]
    chosen: str
    show: bool
    typed: Mapping[str, Mapping[str, str]] | None = None


@dataclass(frozen=True)
class Graded:
    """What a worker returns: the result, and if asked the page of the executed notebook, and its source."""

    result: Result
    page: str = ""
    source: str = ""


class Desk:
    """What a worker keeps between two submissions of one assignment: a jail and a judge, started when first needed."""

    jail: Jail | None

    def __init__(self, task: Task):
        self.jailed, self.limits = task.jailed, task.limits
        self.judge, self.jail = Judge(task.name, task.source, task.path), None

    def graded(self, task: Task) -> Graded:
        """Return what becomes of a task. Raises GradingError where it has none, through no fault of the student."""
        outcome = Outcome(refused=task.problem)
        if task.typed is not None:
            outcome = Outcome(answers={number: dict(given) for number, given in task.typed.items()})
        elif task.label and not task.problem:
            if self.jail is None:
                with _starting:
                    self.judge.begin()
                    self.jail = Jail(self.jailed, self.limits)
            outcome = self.jail.run(task.content)
        found = _result(task, outcome, self.judge.judge(task.student, outcome.answers, task.numbers))
        if not task.show:
            return Graded(found)
        shown, stopped = self.jail.show(task.content) if self.jail and task.content else ((), "")
        return Graded(found, executed(found, task.content, shown, stopped), source(task.content))

    def close(self) -> None:
        """End both processes."""
        self.judge.close()
        if self.jail:
            self.jail.close()


def _result(task, outcome, exercises):
    """What became of a task that was run and judged; its texts are the same each time."""
    status = MISSING if not task.label else NOT_RUN if outcome.refused else STOPPED if outcome.stopped else COMPLETE
    says = same_each_time(outcome.refused or outcome.stopped)
    errors = tuple(CellError(cell, same_each_time(text)) for cell, text in outcome.errors)
    if_empty = what_it_is(task.content)
    found = looks(task.student, outcome, exercises, answered(task.content), task.doubts, if_empty)
    owner = harmless(outcome.named[0]) if outcome.named else ""
    return Result(
        task.name, task.student, task.label, task.jailed, task.fingerprint, status, says, errors, tuple(found),
        tuple(exercises), owner, task.chosen,
    )  # fmt: skip


_desks = threading.local()
#: A jail and a judge take a processor each to start: the first of them are ready early, rather than all of them late.
_starting = threading.BoundedSemaphore(max(1, (os.cpu_count() or 1) // 2))
_all_desks = []


def graded(task: Task) -> Graded | str:
    """Grade a task on this thread's desk; returns what becomes of it, or a sentence where there is no result."""
    wanted = (task.name, task.source, task.path, task.jailed, task.limits)
    try:
        if getattr(_desks, "wanted", None) != wanted:
            if hasattr(_desks, "desk"):
                _desks.desk.close()
            _desks.desk, _desks.wanted = Desk(task), wanted
            _all_desks.append(_desks.desk)
        return _desks.desk.graded(task)
    except NoJail:  # the next one would fare no better
        raise
    except (GradingError, OSError) as problem:  # a full disk, say, under one submission
        return str(problem)


@dataclass(frozen=True)
class Summary:
    """What a run of the grader did.

    Attributes:
        graded, kept, missing: how many submissions were graded, had been before, and are not there.
        outdated: ids of students who were not to be graded and whose result is another one by now: the assignment, the
            submission or the limits have changed.
        complaints: sentences on files that are nobody's, or cannot be.
        notes: sentences on the roster, and on the grades as the system takes them.
        failures: pairs of a student's id and a sentence: these have no result.
    """

    graded: int
    kept: int
    missing: int
    outdated: tuple[str, ...]
    complaints: tuple[str, ...]
    notes: tuple[str, ...]
    failures: tuple[tuple[str, str], ...]


def grade(
    assignment: Assignment,
    students: Sequence[Student],
    submissions: Path,
    folder: Path,
    *,
    place: AbstractContextManager[tuple[Executor, int]] | None = None,
    extensions: Path | None = None,
    only: Collection[str] = (),
    regrade: bool = False,
    jailed: bool = True,
    reveal: bool = False,
    latest: bool = False,
    keep_notebooks: bool = False,
    limits: Limits = USUAL,
    follow: Callable[[int, int], object] = lambda done, total: None,
) -> Summary:
    """Grade the submissions of a class, and write the reports.

    Arguments:
        assignment: `Assignment`.
        students: the roster.
        submissions: folder or zip file, or the table with answers that were typed from paper.
        folder: where results and reports go.
        place: where submissions are graded, ``here(workers)``; ``here(1)`` if not given.
        extensions: the file that grants them to single students, if there is one.
        only: ids of the students to grade; all if empty.
        regrade: grade again what has a result.
        jailed: without a jail, submissions run with the rights of whoever grades, and every output says so.
        reveal: show the key in the feedback.
        latest: of several notebooks of a student the latest counts, as `submissions.collect` tells it.
        keep_notebooks: keep each notebook as executed; a page that is there is kept up to date in any case.
        limits: `jail.Limits`.
        follow: is called with how many submissions are done, and how many there are.
    Returns:
        The `Summary`.
    Raises:
        GradingError: for submissions, marks by hand or extensions that cannot be read, ids that are on no roster, a
            folder that another grader works in, that lies among the submissions or holds another assignment, or where
            there is no jail.
    """
    registered()  # what is wrong with one of them is said before an hour of grading, and not after it
    released = Released.of(assignment)
    on_roster = students
    students, changes = released.identified(on_roster)
    kept_ids = {own.id: student.id for own, student in zip(on_roster, students, strict=True)}
    only = [kept_ids.get(one, one) for one in only]
    unknown = sorted(set(only) - {student.id for student in students})
    if unknown:
        raise GradingError(f"there is no student {unknown[0]!r} on the roster")
    if submissions.resolve() in (folder.resolve(), *folder.resolve().parents):  # and would be collected
        raise GradingError(f"{folder} lies among the submissions in {submissions}: expected a folder beside them")
    on_paper = submissions.suffix.lower() == ".csv"
    if jailed and not on_paper:
        demand_hidden(*filter(None, [assignment.path, submissions, folder]))
    if on_paper:
        collection = typed.collect(submissions, students, assignment, released)
    else:
        collection = collect(submissions, students, assignment.name, latest)
    notes = [*changes, *released.differences(assignment, [one.student for one in collection.submissions])]
    marking = Marking(folder, assignment, students, extensions, kept_ids)
    results, pages = Results(folder / "results", assignment.secret), Kept(folder / "notebooks")
    with _alone(folder):
        results.demand_of(assignment.name, [student.id for student in students])
        released.demand_fitting(assignment, collection.submissions)
        marking.read(results.if_whole)  # before anything is graded again: a mark by hand is one of what was there
        found = {one.student.id: one for one in collection.submissions}
        wanted = [student for student in students if not only or student.id in only]
        notes += _gone(results, wanted, found, submissions)

        def task(student):
            one = _task(assignment, released, student, found.get(student.id), jailed, limits)
            asked = bool(one.label) and one.typed is None and (keep_notebooks or pages.is_there(student.id))
            return replace(one, show=asked and not pages.is_there(student.id, one.fingerprint))

        graded, kept, failures = 0, 0, []
        for done, (student, outcome) in enumerate(
            _outcomes(map(task, wanted), results, regrade, place or here(1)), start=1
        ):
            if isinstance(outcome, str):
                failures.append((student, outcome))
            elif outcome is None:
                kept += student in found
            else:
                graded += student in found
                if outcome.page:  # before the result: where that is there, so is the page
                    pages.keep(student, outcome.page, outcome.source)
                results.keep(outcome.result)
            follow(done, len(wanted))
        stored = {student.id: one for student in students if (one := results.of(student.id))}
        marking.read(stored.get)
        marks = marking.marked(list(stored.values()), found)
        notes += [*marking.notes(marks), *lms.remarks(students, assignment.title, assignment.points if marks else None)]
        write_all(folder, assignment.title, students, marks, collection.complaints, notes, reveal)
        others = [student for student in students if student not in wanted and student.id in stored]
        outdated = [one.id for one in others if stored[one.id].fingerprint != task(one).fingerprint]
        missing = sum(student.id not in found for student in wanted)
    return Summary(graded, kept, missing, tuple(outdated), collection.complaints, tuple(notes), tuple(sorted(failures)))


def _gone(results, students, found, submissions):
    """Return a sentence on those whose submission was graded before, and is not there any more.

    Raises GradingError where that is most of the class: then it is not the students who took something back.
    """
    before = [one.id for one in students if (kept := results.if_whole(one.id)) and kept.status != MISSING]
    gone = [student for student in before if student not in found]
    if len(gone) >= FEWEST_GONE and 2 * len(gone) > len(before):
        raise GradingError(
            f"{len(gone)} of {len(before)} students who were graded have no submission in {submissions} any more: "
            f"{in_short(gone)}; nothing is graded; look whether place and roster are the right ones, or grade into "
            "another folder"
        )
    return [f"Graded before, and without a submission now: {in_short(gone)}."] if gone else []


def _task(assignment, released, student, submission, jailed, limits):
    """The task of one student; without a submission, one without a label."""
    label, content, problem, chosen, answers = "", b"", "", "", None
    if submission:
        label, problem, chosen = submission.label, submission.problem, submission.chosen
        answers = submission.answers
        if not problem:
            try:
                content = submission.read()
            except GradingError as why:
                problem = str(why)
    numbers, doubts = released.numbers(student.id), released.doubts(assignment, student.id, peek(content))
    said = content if answers is None else json.dumps(answers).encode()
    mark = fingerprint(assignment, numbers, said, label, problem or chosen, jailed, limits)
    return Task(
        assignment.name, assignment.source, str(assignment.path or ""), student.id, label, content, problem, jailed,
        limits, mark, numbers, doubts, chosen, False, answers,
    )  # fmt: skip


def _outcomes(tasks, results, regrade, place):
    """Yield pairs of a student and the result, None where the stored one holds, or a sentence; as they are done."""
    with place as (executor, at_a_time):
        running = {}
        try:
            for task in tasks:
                stored = None if regrade else results.of(task.student)
                if stored and stored.fingerprint == task.fingerprint and not task.show:
                    yield task.student, None
                    continue
                running[executor.submit(graded, task)] = task.student
                while len(running) >= WAITING * at_a_time:
                    yield from _done(running)
            while running:
                yield from _done(running)
        finally:
            for future in running:
                future.cancel()


def _done(running):
    finished, _ = wait(running, return_when=FIRST_COMPLETED)
    for future in finished:
        yield running.pop(future), future.result()


@contextlib.contextmanager
def here(workers: int) -> Iterator[tuple[Executor, int]]:
    """Yield an executor of threads on this machine, and how many tasks they take at a time; their desks end with it."""
    executor, others = ThreadPoolExecutor(workers), list(_all_desks)
    try:
        yield executor, workers
    finally:
        executor.shutdown(wait=False, cancel_futures=True)
        for desk in [one for one in _all_desks if one not in others]:
            _all_desks.remove(desk)
            desk.close()


@contextlib.contextmanager
def _alone(folder):
    """Keep other graders out of a folder; the system lets go when this process ends, however it ends."""
    try:
        import fcntl  # Windows has none
    except ImportError:
        raise GradingError("this system cannot lock a folder: grade on Linux, or in a container") from None
    try:
        folder.mkdir(parents=True, exist_ok=True)
        file = open(folder / ".lock", "w")  # noqa: SIM115 - it is closed below
    except OSError as problem:
        raise GradingError(f"{folder} cannot be written: {problem.strerror}") from None
    with file:
        try:
            fcntl.flock(file, fcntl.LOCK_EX | fcntl.LOCK_NB)
        except OSError:
            raise GradingError(f"another grader works in {folder}: wait for it, or take another folder") from None
        yield
