"""The judge: a process of its own, which holds the assignment and its keys, and sees answers as plain data only.

``python -m exercisegrader.judge`` is that process; `Judge` talks with it in lines of JSON. What takes too long, or
takes the process down, is not judged, and the judge begins again behind it.
"""

from __future__ import annotations

import contextlib
import json
import os
import subprocess
import sys
from collections.abc import Callable, Collection, Mapping
from dataclasses import asdict
from multiprocessing.connection import wait
from pathlib import Path
from typing import TYPE_CHECKING, Any, Self

from exercisebook import units
from exercisebook.credit import NOTHING, Credit
from exercisebook.judging import SECONDS, UNJUDGED, Verdict, judge
from exercisebook.parameters import written
from exercisebook.timeout import WAITING
from exercisegrader import GradingError
from exercisegrader.inside.plain import unreadable
from exercisegrader.results import JudgedAnswer, JudgedExercise

if TYPE_CHECKING:
    from exercisebook.question import Question

MEMORY = 2 * 2**30
#: What comparing one answer may take (s). The comparison itself has a limit; this one is for what does not heed it.
PATIENCE = WAITING * SECONDS + 5
#: What loading the assignment, and working out the keys of a variant, may take (s).
STARTING = 120


class Judge:
    """A judge for an assignment.

    Arguments:
        name, source, path: of the `Assignment`, which this process need not load; no path is an empty text.
    """

    def __init__(self, name: str, source: str, path: str = ""):
        self.assignment = {"name": name, "source": source, "path": path}
        self.process: subprocess.Popen[bytes] | None = None

    def begin(self) -> None:
        """Start the process, if there is none, and do not wait for it: there may be something else to start."""
        if self.process is None:
            self.process = subprocess.Popen(
                [sys.executable, "-m", "exercisegrader.judge"],
                stdin=subprocess.PIPE,
                stdout=subprocess.PIPE,
                bufsize=0,
                start_new_session=True,  # who interrupts the command does not interrupt what it has started
            )
            self._left, self._is_ready = b"", False
            self._say(self.assignment)

    def _start(self):
        """Start the process, if there is none, and wait until it is ready."""
        self.begin()
        if not self._is_ready and "ready" not in (reply := self._heard(STARTING)):
            self.close()
            raise GradingError(reply.get("failed", "the judge does not start"))
        self._is_ready = True

    def _say(self, data):
        with contextlib.suppress(BrokenPipeError):  # then it says nothing, which is noticed
            self.process.stdin.write(json.dumps(data).encode() + b"\n")

    def _heard(self, seconds):
        """The next line of the judge; empty where it is silent for longer, or gone."""
        while b"\n" not in self._left:
            ready = wait([self.process.stdout], seconds)
            chunk = self.process.stdout.read(65536) if ready else b""
            if not chunk:
                return {}
            self._left += chunk
        line, self._left = self._left.split(b"\n", 1)
        return json.loads(line)

    def judge(
        self,
        student: str,
        given: Mapping[str, Mapping[str, Any]],
        numbers: Mapping[str, Mapping[str, str]] | None = None,
    ) -> list[JudgedExercise]:
        """Judge answers; returns a `JudgedExercise` for each exercise.

        Arguments:
            student: id.
            given: {exercise: {name: plain data}}.
            numbers: that were released, {exercise: {parameter: text}}; others are drawn.
        Raises:
            GradingError: where the assignment has no variant for the student.
        """
        hopeless: list[list[str]] = []
        while True:
            self._start()
            self._say({"student": student, "given": given, "numbers": numbers or {}, "hopeless": hopeless})
            exercises: list[JudgedExercise] = []
            at = None
            while reply := self._heard(STARTING if at is None else PATIENCE):
                if "failed" in reply:
                    raise GradingError(reply["failed"])
                if "done" in reply:
                    return exercises
                if "exercise" in reply:
                    exercises.append(JudgedExercise.of_data(reply["exercise"]))
                at = reply.get("at")
            self.close()
            if at is None or at in hopeless:
                raise GradingError(f"the judge ends without a word for student {student}")
            hopeless.append(at)

    def close(self) -> None:
        """End the process."""
        if self.process is not None:
            self.process.kill()
            self.process.communicate()
            self.process = None

    def __enter__(self) -> Self:
        return self

    def __exit__(self, *problem: object) -> None:
        self.close()


def judged(
    question: Question,
    given: Mapping[str, Any],
    hopeless: Collection[str] = (),
    at: Callable[[str], object] = lambda name: None,
    credit: Credit = NOTHING,
) -> JudgedExercise:
    """Return what becomes of the answers to one exercise.

    Arguments:
        question: the student's variant.
        given: {name: plain data}.
        hopeless: names of quantities that cannot be judged.
        at: is told each name before it is judged.
        credit: what is worth something though it is not right.
    """
    answers = []
    for name, kind in question.key.items():
        answer = given.get(name)
        at(name)
        if name in hopeless:
            verdict = Verdict(name, UNJUDGED, f"judging this takes too long: expected {kind.expected}")
        elif says := unreadable(answer):
            verdict = Verdict(name, UNJUDGED, says)
        else:
            verdict = judge(name, kind, answer, question.mistakes[name], question.background.of(name, given), credit)
        weight, says = question.exercise.weights.get(name, 1), verdict.says
        if verdict.percent:
            says += f" · {verdict.percent:g}\N{NO-BREAK SPACE}% of its points"
        answers.append(
            JudgedAnswer(name, verdict.status, says, answer, kind.solution, weight, verdict.look, verdict.percent)
        )
    exercise, asked = question.exercise, question.statement.below_heading
    numbers = tuple((name, written(value, exercise.parameters[name].unit)) for name, value in question.stated.items())
    return JudgedExercise(exercise.number, exercise.title, exercise.points, asked, numbers, tuple(answers))


def main() -> None:
    """Read an assignment from standard input, and then answers; write what is judged to standard output."""
    import resource

    from exercisegrader.assignment import Assignment

    out = os.fdopen(os.dup(1), "w")
    os.dup2(2, 1)  # what the assignment prints

    def say(data):
        try:
            print(json.dumps(data), file=out, flush=True)
        except BrokenPipeError:  # the grader is gone, and nobody listens any more
            os._exit(1)

    said = json.loads(sys.stdin.readline())
    try:
        assignment = Assignment.of(said["source"], said["name"], Path(said["path"]) if said["path"] else None)
    except GradingError as problem:
        say({"failed": str(problem)})
        return
    units.convert(1, "min", to="s")  # loads what the first answer with a unit would wait for
    say({"ready": True})
    resource.setrlimit(resource.RLIMIT_AS, (MEMORY, MEMORY))
    for line in sys.stdin:
        job = json.loads(line)
        try:
            for number in assignment.exercises:
                question = assignment.question(job["student"], number, job["numbers"].get(number))
                hopeless = [name for one, name in job["hopeless"] if one == number]
                given = job["given"].get(number, {})
                found = judged(
                    question, given, hopeless, lambda name, n=number: say({"at": [n, name]}), assignment.credit
                )
                say({"exercise": asdict(found)})
        except (GradingError, ValueError) as problem:
            say({"failed": f"exercise {number} for student {job['student']}: {problem}"})
        else:
            say({"done": True})


if __name__ == "__main__":
    main()
