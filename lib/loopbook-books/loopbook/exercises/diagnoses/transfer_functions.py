"""What of a transfer function is right: its gain, dead time, poles and zeros, from its values at some points."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator
from typing import Any

import numpy as np

from exercisebook.diagnoses import facts, own_formulas
from exercisebook.diagnoses.background import Answered, Background
from exercisebook.diagnoses.facts import constant, facts_listed, same
from exercisebook.diagnoses.finding import Finding
from exercisebook.formulas import Formula
from exercisebook.kinds import Expression
from loopbook.exercises.kinds.transfer_function import TransferFunction

#: A rational function is one up to so many poles, if it leaves no more than this.
MOST_POLES, LEFT = 4, 1e-7


@facts.of.register
def _(kind: TransferFunction, answer: Any, background: Background) -> Finding | None:
    if found := constant(kind, answer, background):
        return found
    if Expression.agrees(kind, answer):
        says = "its values are nearly right everywhere, but a pole of it is on the other side of the imaginary axis, "
        return Finding(says + "on that axis, or at zero where none should be: that is another system")
    key, found = facts_of(kind.key, kind), facts_of(answer, kind)
    if found and key and found.get("poles") is not None and key.get("poles") is not None:
        poles, right = found["poles"], key["poles"]
        if poles.size == right.size > 0 and np.all(right != 0) and not same(poles, right, kind):
            if same(poles, _in_order(1 / right), kind):
                return Finding("its poles are one divided by those that it should have: a lag of $T$ is $Ts + 1$")
            if same(poles, _in_order(-right), kind):
                return Finding("its poles are on the other side of the imaginary axis: look at the signs below")
    if not key.get("dead time") and not found.get("dead time"):
        key.pop("dead time", None)
    return facts_listed(kind, {name: (found.get(name), value) for name, value in key.items()})


@own_formulas.numbers_of.register
def _(kind: TransferFunction, one: Answered, background: Background) -> Iterator[tuple[float, float]]:
    if kind.symbols != ["s"]:
        return
    right, own = facts_of(kind.key, kind), facts_of(one.answer, kind)
    for fact in right.keys() & own.keys():
        first, other = (np.atleast_1d(known[fact]) for known in (right, own))
        if first.size == other.size == 1 and not (first.imag or other.imag):
            yield float(first[0].real), float(other[0].real)
            if fact == "poles" and first[0] and other[0]:
                yield float(-1 / first[0].real), float(-1 / other[0].real)


def facts_of(formula: Formula, kind: Expression) -> dict[str, Any]:
    """Dead time, static gain, poles and zeros; of symbols other than s, some values are taken."""
    others = {name: 0.7 + 0.37 * place for place, name in enumerate(sorted(kind.symbols)) if name != "s"}

    def values(s):
        return np.broadcast_to(formula(s=np.asarray(s, complex), **others), np.shape(s))

    def of_key(s):
        return np.broadcast_to(kind.key(s=np.asarray(s, complex), **others), np.shape(s))

    delay = _delay(values)
    if delay is None:
        return {}
    scale = _scale((of_key, values), delay)
    rest = []
    for exact in dict.fromkeys([0.0 if delay == 0 else float(f"{delay:.{digits}g}") for digits in range(1, 7)]):
        above, below = _rational(lambda s, exact=exact: values(s) * np.exp(exact * s), scale)
        if below is not None and (exact == 0) == (delay == 0):
            rest.append((exact, above, below))
    if not rest:
        return {"dead time": delay}
    # what a rounded dead time leaves has many poles and zeros that are none
    exact, above, below = min(rest, key=lambda one: len(one[2]))
    poles, zeros = _roots(below, scale), _roots(above, scale)
    small = 1e-6 / scale
    integrators = int(np.sum(np.abs(poles) < small)) - int(np.sum(np.abs(zeros) < small))
    low = np.array([1e-7 / scale])
    gain = (values(low) * low**integrators)[0].real
    name = "static gain" if integrators == 0 else "gain at low frequencies"
    return {name: gain, "dead time": exact, "poles": poles, "zeros": zeros}


def _scale(formulas: Iterable[Callable[[Any], Any]], delay: float) -> float:
    """A time in the range of theirs: where the size of one of them changes most with the frequency, or the delay."""
    frequencies = np.geomspace(1e-6, 1e6, 241)
    for values in formulas:
        with np.errstate(all="ignore"):
            change = np.abs(np.gradient(np.gradient(np.log(np.abs(values(1j * frequencies))))))
        change = np.where(np.isfinite(change), change, 0)
        if np.max(change) > 1e-4:
            # a zero and a pole change it alike: of the two the slower one, whatever rounding says
            return float(1 / frequencies[np.argmax(change > (1 - 1e-6) * np.max(change))])
    return delay or 1.0


def _delay(values: Callable[[Any], Any]) -> float | None:
    """The dead time, from what is left where s is large; powers of s fall out of the second difference.

    >>> round(_delay(lambda s: np.exp(-3 * s) / (5 * s + 1)), 3)
    3.0
    """
    steps = np.geomspace(1e7, 1e-7, 141)
    with np.errstate(all="ignore"):
        rows = np.log(np.abs(values(steps[:, None] * [1, 2, 4])))  # one call, or each step takes as long
    for step, logs in zip(steps, rows, strict=True):
        if np.isfinite(logs).all():
            size = abs(logs[2] - 2 * logs[1] + logs[0])  # of which a lag leaves next to nothing
            return float(-(logs[2] - 2 * logs[1] + logs[0]) / step) if size > 1 else 0.0
    return None


def _rational(values, scale):
    """Numerator and denominator, in scaled s, of a rational function; None where it is none of so many poles."""
    s = 1.7 * np.exp(1j * np.linspace(-1.3, 1.3, 41)) * np.geomspace(0.2, 5, 41)
    found = values(s / scale)
    if not np.isfinite(found).all():
        return None, None
    size = np.max(np.abs(found))
    for order in range(MOST_POLES + 1):
        powers = s[:, None] ** np.arange(order + 1)
        system = np.hstack([powers, -found[:, None] / size * powers])
        system = np.vstack([system.real, system.imag])
        widths = np.linalg.norm(system, axis=0)
        _, left, rows = np.linalg.svd(system / widths)
        if left[-1] < LEFT * left[0]:
            solution = rows[-1] / widths
            return solution[: order + 1], solution[order + 1 :]
    return None, None


def _roots(polynomial, scale):
    """The roots, lowest powers first, without those at infinity, in order."""
    largest = np.max(np.abs(polynomial))
    while polynomial.size and abs(polynomial[-1]) < 1e-6 * largest:
        polynomial = polynomial[:-1]
    roots = np.polynomial.polynomial.polyroots(polynomial) if polynomial.size > 1 else np.array([])
    return _in_order(np.where(np.abs(roots) < 1e-6, 0, roots) / scale)


def _in_order(roots):
    size = np.max(np.abs(roots), initial=0.0) or 1.0
    return np.array(sorted(roots, key=lambda root: (round(root.real / size, 6), root.imag)), complex)
