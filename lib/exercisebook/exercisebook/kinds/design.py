"""Designs: whatever meets the criteria is right."""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

from exercisebook.grammar import Unreadable
from exercisebook.kinds.kind import Kind, Tried
from exercisebook.timeout import limited

if TYPE_CHECKING:
    from exercisebook.wholes import Whole
    from plainmath.types import Number

SECONDS = 1.5
#: A design at its limit is met by rounded numbers, too.
SLACK = 1e-3


@dataclass(frozen=True)
class Criterion:
    """What a design must achieve: a measure of it with a limit, or a condition that is true or false.

    Arguments:
        what: the measure in words, as "the mass", or the condition as a clause, as "the bridge holds".
        measure: function of the answer; infinite where it has no value.
        below, above: limits, themselves allowed.
        unit: of the measure.
        otherwise: the sentence where a condition does not hold; that it is not so, if not given.
    """

    what: str
    measure: Callable[[Any], Any]
    below: Number | None = None
    above: Number | None = None
    unit: str = ""
    otherwise: str = ""

    @property
    def demand(self) -> str:
        """The criterion in words."""
        limits = [f"at {word} {_written(limit, self.unit)}" for word, limit in self.limits()]
        return f"{self.what} is {' and '.join(limits)}" if limits else self.what

    def limits(self) -> list[tuple[str, Number]]:
        """The limits that there are, each with its word."""
        return [pair for pair in (("least", self.above), ("most", self.below)) if pair[1] is not None]

    def complaint(self, answer: Any) -> str:
        """Return a sentence on what an answer does not achieve; empty where it does."""
        value = self.measure(answer)
        if not self.limits():
            holds = bool(value) and not (isinstance(value, float) and math.isnan(value))
            return "" if holds else self.otherwise or f"asked is that {self.what}, and it is not so"
        value = float(value)
        low = -math.inf if self.above is None else float(self.above)
        high = math.inf if self.below is None else float(self.below)
        slack = SLACK * max(abs(limit) for limit in (low, high) if math.isfinite(limit))
        if low - slack <= value <= high + slack and math.isfinite(value):
            return ""
        found = (
            f"{self.what} is {_written(value, self.unit)}"
            if math.isfinite(value)
            else f"{self.what} has no finite value"
        )
        return f"{found}; asked is {' and '.join(f'at {word} {_written(x, self.unit)}' for word, x in self.limits())}"


class Design(Kind):
    """An answer of another kind that is judged by what it achieves.

    Arguments:
        example: the asked quantity, as one of the kinds; its key is a design that meets the criteria.
        criteria: each a `Criterion`.
        draws: returns a figure of what an answer does, with the limits that it must meet.

    >>> from exercisebook.kinds import Number
    >>> layers = Design(Number(2, what="the layers"), Criterion("the light", lambda n: 1 / (1 + n), below=0.4))
    >>> layers.agrees(1.6), layers.hint(1)
    (True, 'the light is 0.5; asked is at most 0.4')
    """

    def __init__(self, example: Kind, *criteria: Criterion, draws: Callable[[Any], Any] | None = None):
        if not criteria:
            raise ValueError("there are no criteria: expected at least one for a design")
        self.example, self.criteria, self.draws = example, criteria, draws
        self.unit, self.what, self.within, self.key = example.unit, example.what, example.within, example.key

    def like(self, value: Any) -> Design:
        """A design by the same criteria."""
        return Design(self.example.like(value), *self.criteria, draws=self.draws)

    def draw_from(self, seed: str) -> None:
        """As the quantity's kind."""
        super().draw_from(seed)
        self.example.draw_from(seed)

    def picture(self, answer: Any) -> Any:
        """The answer's own response, where the author draws it."""
        return self.draws(answer) if self.draws else None

    @property
    def shown(self) -> Any:
        """As the quantity's kind."""
        return self.example.shown

    @property
    def asked(self) -> str:
        """The quantity with its criteria."""
        return f"{self.example.asked}. Required: {'; '.join(one.demand for one in self.criteria)}"

    @property
    def expected(self) -> str:
        """As the quantity's kind."""
        return self.example.expected

    accuracy = ""
    FORM = ()
    making = ""  # the criteria are functions

    @property
    def keyless(self) -> Kind:
        """That of the quantity's kind."""
        return self.example.keyless

    @property
    def asking(self) -> str:
        """As of the quantity's kind: the criteria stay here."""
        return self.example.asking

    def read(self, given: object) -> tuple[Any, str]:
        """Return the answer as the quantity's kind reads it."""
        return self.example.read(given)

    def as_read(self, answer: Any) -> str:
        """As the quantity's kind."""
        return self.example.as_read(answer)

    def as_code(self, answer: Any = None) -> str:
        """As the quantity's kind."""
        return self.example.as_code(answer)

    def written(self, answer: Any) -> str:
        """As the quantity's kind."""
        return self.example.written(answer)

    @property
    def solution(self) -> str:
        """One of the designs that meet the criteria."""
        return f"for example {self.example.solution}"

    @property
    def field(self) -> dict[str, Any]:
        """As of the quantity's kind, with what it must achieve."""
        inner = self.example.field
        return inner | {"more": inner.get("more", {}) | {"demands": [one.demand for one in self.criteria]}}

    def right_forms(self) -> Iterator[Tried]:
        """As of the quantity's kind."""
        return self.example.right_forms()

    def wrong_forms(self) -> Iterator[Tried]:
        """As of the quantity's kind."""
        return self.example.wrong_forms()

    @property
    def whole(self) -> Whole | None:
        """That of the quantity's kind."""
        return self.example.whole

    def complaints(self, answer: Any) -> list[str]:
        """Return what an answer does not achieve, in sentences; a condition that fails stands alone."""

        def judge():
            found = []
            for one in self.criteria:
                try:
                    complaint = one.complaint(answer)
                except (ValueError, ArithmeticError) as error:
                    complaint = f"{one.what} has no value ({error})"
                found += [complaint] if complaint else []
                if complaint and not one.limits():
                    break
            return found

        try:
            return limited(SECONDS, judge)
        except TimeoutError:
            raise Unreadable("judging this design takes too long: expected one nearer to what is usual") from None

    def agrees(self, answer: Any) -> bool:
        """Whether the design meets all criteria."""
        return not self.complaints(answer)

    def is_value(self, answer: Any, wrong: Any) -> bool:
        """Whether an answer is the value of a mistake."""
        return self.example.is_value(answer, wrong)

    def hint(self, answer: Any) -> str:
        """Say which criteria are not met, and how far it is."""
        return "; ".join(self.complaints(answer))


def _written(value, unit):
    text = f"{float(value):.4g}"
    return f"{text}\N{NO-BREAK SPACE}{unit}" if unit else text
