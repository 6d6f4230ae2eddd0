"""Evidence of several cases: that something holds always, mostly or once, or grows from one case to the next."""

from __future__ import annotations

import itertools
from collections.abc import Iterable, Mapping
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING, Any

from bookledger.evidence.comparisons import Comparison, Evidence, greater, less
from bookledger.evidence.criteria import GENERALLY, MAY, Criterion
from bookledger.evidence.sides import EvidenceError, Typeset, texts

if TYPE_CHECKING:
    from plainmath.types import Number

_SHOWN = 4  # cases that a sentence tells
#: Whether the cases that hold are enough, by their number and that of all cases.
_ENOUGH = {
    "every": lambda holding, cases: holding == cases,
    "some": lambda holding, cases: holding > 0,
    "most": lambda holding, cases: 2 * holding > cases,
}


@dataclass(frozen=True, repr=False)
class Cases(Evidence):
    """Evidence of several cases.

    Attributes:
        cases: the evidence of each, by its name.
        kind: how many of them must hold: "every", "some" or "most".
        criterion: the word of degree that so many stand for, if it is one.
    """

    cases: tuple[tuple[str, Evidence], ...]
    kind: str = "every"
    criterion: Criterion | None = None

    @property
    def criteria(self) -> tuple[Criterion, ...]:
        """Those of all cases and its own, each once."""
        own = (self.criterion,) if self.criterion else ()
        return tuple(dict.fromkeys([*(found for _, case in self.cases for found in case.criteria), *own]))

    @property
    def quantities(self) -> frozenset[str]:
        """Those of all cases."""
        return frozenset().union(*(case.quantities for _, case in self.cases))

    def _is_enough(self, holding):
        return _ENOUGH[self.kind](sum(holding), len(self.cases))

    @property
    def holds(self) -> bool:
        """Whether enough of the cases hold."""
        return self._is_enough(case.holds for _, case in self.cases)

    @property
    def divided(self) -> bool:
        """Whether some of the cases hold and others do not."""
        return len({case.holds for _, case in self.cases}) > 1

    @property
    def near(self) -> bool:
        """Whether other verdicts on the near things would turn the verdict on all."""
        at_least = self._is_enough(case.holds and not case.near for _, case in self.cases)
        return at_least is not self._is_enough(case.holds or case.near for _, case in self.cases)

    @property
    def room(self) -> float:
        """How far apart the closest numbers are."""
        return min(case.room for _, case in self.cases)

    @property
    def probed(self) -> bool:
        """Whether one of the cases was found at random points."""
        return any(case.probed for _, case in self.cases)

    def turned(self) -> Cases:
        """A counterexample to what always holds; nothing of what holds in some or most cases; all of what fails."""
        (name, first), *others = self.cases
        if self.kind == "every" and self.holds:
            return replace(self, cases=((name, first.turned()), *others))
        cases = ((name, case.turned() if case.holds is self.holds else case) for name, case in self.cases)
        return replace(self, cases=tuple(cases))

    def told(self, typeset: Typeset = str) -> str:
        """The deciding cases: counterexamples to what should hold always, examples of what should hold once.

        Of many those are told in which the numbers are closest.
        """
        deciding = [pair for pair in self.cases if pair[1].holds is (self.kind != "every")] or list(self.cases)
        closest = sorted(range(len(deciding)), key=lambda place: deciding[place][1].room)[:_SHOWN]
        shown = [deciding[place] for place in sorted(closest)]
        told = [f"{name}: {case.told(typeset)}" if name else case.told(typeset) for name, case in shown]
        number, count = len(self.cases), sum(case.holds for _, case in self.cases)
        if number > _SHOWN or (any(name for name, _ in self.cases) and not (self.kind == "every" and self.holds)):
            told.insert(0, f"in {count} of {number} cases")
        return self._once("; ".join([*told, "..."] if len(deciding) > _SHOWN else told))

    def _once(self, text):
        """The sentence with each criterion explained where it is used last, and not before."""
        for why in (f" ({more}{c.meaning})" for c in self.criteria for more in ("", f"{c.word}: ")):
            before, found, after = text.rpartition(why)
            text = before.replace(why, "") + found + after
        return text

    @property
    def data(self) -> dict[str, Any]:
        """The data of all cases."""
        cases = [({"case": name} if name else {}) | case.data for name, case in self.cases]
        return {"kind": self.kind, "cases": cases, "holds": self.holds, "near": self.near}


@dataclass(frozen=True, repr=False)
class Chain(Cases):
    """Comparisons of neighbours in a row of values."""

    def told(self, typeset: Typeset = str) -> str:
        """The quantity and all values in a row."""
        links: list[Comparison] = [link for _, link in self.cases]
        if len(links) > 2 * _SHOWN or not self.holds:
            return super().told(typeset)
        first = links[0]
        row = texts([first.left, *(link.right for link in links)], first.unit, typeset)
        return f"{first.quantity} {f' {first.relation} '.join(row)}{first.way}".strip()


def every(*cases: Evidence | Mapping[Any, Evidence]) -> Cases:
    """Evidence that each of several cases holds: for "always", and for "and".

    Arguments:
        cases: evidence, or one mapping with evidence by the names of the cases.
    Raises:
        EvidenceError: without cases, and for what is no evidence.

    >>> every(greater(2.3, 1.6, "width"), less(8, 9, "cooling time [s]"))
    holds: width 2.3 > 1.6; cooling time 8 s < 9 s
    >>> every({"K = 1": less(1, 2), "K = 2": less(3, 2)})
    does not hold: in 1 of 2 cases; K = 2: 3 not < 2
    """
    return Cases(_read(cases))


def some(*cases: Evidence | Mapping[Any, Evidence]) -> Cases:
    """Evidence that at least one of several cases holds: for "can" and "in some cases"; otherwise as `every`.

    >>> some({"K = 1": less(1, 2), "K = 2": less(3, 2)})
    holds: in 1 of 2 cases; K = 1: 1 < 2
    """
    return Cases(_read(cases), "some", MAY)


def most(*cases: Evidence | Mapping[Any, Evidence]) -> Cases:
    """Evidence that more than half of the cases hold: for "in general"; otherwise as `every`.

    >>> most({"K = 1": less(1, 2), "K = 2": less(3, 2), "K = 3": less(3, 4)})
    holds: in 2 of 3 cases; K = 1: 1 < 2; K = 3: 3 < 4
    """
    return Cases(_read(cases), "most", GENERALLY)


def _read(cases):
    if len(cases) == 1 and isinstance(cases[0], Mapping):
        pairs = tuple((str(name), case) for name, case in cases[0].items())
    else:
        pairs = tuple(("", case) for case in cases)
    if not pairs:
        raise EvidenceError("no case is given: nothing always holds of none")
    for name, case in pairs:
        if not isinstance(case, Evidence):
            where = f" {name}" if name else ""
            raise EvidenceError(f"the case{where} is {case!r:.60}: expected evidence, as greater(2.3, 1.6)")
    return pairs


def increasing(values: Iterable[Number], quantity: str = "") -> Chain:
    """Evidence that each of several values is larger than the one before it.

    Arguments:
        values: at least two, as for `greater`.
        quantity: what they are values of, with its unit in brackets.
    Raises:
        EvidenceError: for fewer values, or as `greater`.

    >>> increasing([1.4, 1.6, 2.1], "width")
    holds: width 1.4 < 1.6 < 2.1
    """
    return _chain(values, less, quantity)


def decreasing(values: Iterable[Number], quantity: str = "") -> Chain:
    """Evidence that each of several values is smaller than the one before it; otherwise as `increasing`.

    >>> decreasing([9, 5, 7], "deflection [mm]")
    does not hold: deflection 5 mm not > 7 mm
    """
    return _chain(values, greater, quantity)


def _chain(values, compared, quantity):
    try:
        values = list(values)
    except TypeError:
        raise EvidenceError(f"{values!r:.60} is not a row: expected at least two values") from None
    if len(values) < 2:
        raise EvidenceError(f"{values} is not a row: expected at least two values")
    links: list[Comparison] = [compared(a, b, quantity) for a, b in itertools.pairwise(values)]
    return Chain(tuple(("", link) for link in links))
