"""What a submission tells while it runs, read with suspicion: whoever runs a submission's code can tell anything.

A line is a JSON object with one entry, as `shell.run` tells them. What is something else is counted and passed over.
Nothing here decides on marks: an answer is a claim of the student's, and whose it is was known before.
"""

import json
import math
import signal
from dataclasses import dataclass, field
from time import monotonic

from loopbook.exercises.judging import harmless

#: So many exercises, quantities of one, and errors are kept.
MOST = 200


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

    answers: dict = field(default_factory=dict)
    errors: tuple = ()
    named: tuple = ()
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

    def __init__(self, longest, most):
        self.longest, self.most = longest, most
        self.answers, self.errors, self.named = {}, [], {}
        self.refused, self.ended, self.odd, self.cell = "", False, 0, 0
        self.cell_began, self.too_long = monotonic(), ""
        self._left, self._taken, self._skipping = b"", 0, False

    def read(self, events):
        """Take what has come; returns whether more may come."""
        chunk = events.read(65536)
        if not chunk:
            return False
        self._taken += len(chunk)
        if self._taken > self.most:
            self.too_long = "it told more than the grader takes"
            return True
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
            event = json.loads(line.decode(), parse_constant=_no_number)
            ((what, value),) = event.items()
            getattr(self, _KINDS[what])(value)
        except Exception:  # whatever it is, it is not what a notebook's answers look like
            self.odd += 1

    def _refused(self, says):
        self.refused = self.refused or harmless(says)

    def _named(self, student):
        if student and len(self.named) < MOST:
            self.named[harmless(student)] = True

    def _cell(self, number):
        self.cell, self.cell_began = int(number), monotonic()

    def _error(self, error):
        number, says = int(error["cell"]), harmless(error["says"])
        if len(self.errors) < MOST:
            self.errors.append((number, says))

    def _answer(self, answer):
        number, given = answer["exercise"], answer["given"]
        if not (isinstance(number, str) and isinstance(given, dict) and len(self.answers) < MOST and len(given) < MOST):
            raise ValueError
        if not _finite(given):
            raise ValueError
        self._named(answer["student"])
        # what is still a placeholder, in a copy of the cell, takes nothing back
        filled = {name: value for name, value in given.items() if value is not None}
        self.answers.setdefault(number, {}).update(filled)

    def _end(self, value):
        self.ended = True

    def outcome(self, why, exit_code):
        """Return the `Outcome`.

        Arguments:
            why: it was ended from outside, in a sentence; empty where it ended by itself.
            exit_code: of its first process, or minus the signal that ended it.
        """
        if not (why or self.refused) and not (self.ended and exit_code == 0):
            why = (
                f"its process ended by {_SIGNALS.get(-exit_code, f'signal {-exit_code}')}"
                if exit_code < 0
                else ("its process ended by itself")
            )
        stopped = f"stopped in cell {self.cell}: {why}" if why and self.cell else why
        return Outcome(self.answers, tuple(self.errors), tuple(self.named), stopped, self.refused, self.odd)


_KINDS = {
    "refused": "_refused", "made for": "_named", "cell": "_cell", "error": "_error", "answer": "_answer", "end": "_end",
}  # fmt: skip
_SIGNALS = {
    signal.SIGSEGV: "a segmentation fault",
    signal.SIGXCPU: "too much processor time",
    signal.SIGXFSZ: "a file that is too large",
    signal.SIGKILL: "force",
}


def _no_number(name):
    raise ValueError(name)


def _finite(value):
    """Whether all numbers are finite: 1e999 is none."""
    if isinstance(value, float):
        return math.isfinite(value)
    if isinstance(value, dict):
        value = value.values()
    return all(map(_finite, value)) if isinstance(value, list | type({}.values())) else True
