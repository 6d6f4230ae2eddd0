"""The highest powers of a quasipolynomial, which alone count at infinite frequency: ``1 + c1*exp(-delay1*s) + ...``

Where that has roots in the right half-plane, so has the sum, an infinite row of them. Where its size has a lower bound
in all of the right half-plane, the sum has none beyond a certain frequency.
"""

from __future__ import annotations

import math
from fractions import Fraction
from typing import NamedTuple

import numpy as np

HIGHEST_MULTIPLE = 5000  # of one dead time, up to which others count as multiples of it
CLOSE = 1e-9


class AtInfinity(NamedTuple):
    """What the highest powers are in the right half-plane: a lower bound of the size, and the phase on the boundary.

    `least` is zero on the limit, negative where there are roots in the right half-plane. Without `angles` the phase is
    that of the undelayed term, within a quarter turn; otherwise it is known at those of ``exp(-unit*s)``.
    """

    least: float
    unit: float = 0.0
    angles: np.ndarray | None = None
    phases: np.ndarray | None = None
    values: np.ndarray | None = None
    terms: tuple | None = None

    def phase(self, w: float) -> float:
        """The phase at s = j w, continued from the far right, where it is zero."""
        if self.angles is None:
            return 0.0
        angle = (self.unit * w) % (2 * math.pi)
        near = int(abs(self.angles - angle).argmin())
        later, powers = self.terms
        value = 1 + later @ np.exp(-1j * powers * angle)
        return float(self.phases[near] + np.angle(value / self.values[near]))


def common_unit(delays: list[float]) -> tuple[float, list[int]] | None:
    """The dead time of which all are whole multiples, and these; None where they are none of up to some hundred."""
    ratios = [Fraction(delay / delays[0]).limit_denominator(HIGHEST_MULTIPLE) for delay in delays]
    if any(abs(r * delays[0] / delay - 1) > 1e-13 for r, delay in zip(ratios, delays, strict=True)):
        return None
    share = Fraction(math.gcd(*(r.numerator for r in ratios)), math.lcm(*(r.denominator for r in ratios)))
    powers = [int(ratio / share) for ratio in ratios]
    return (delays[0] * float(share), powers) if max(powers) <= HIGHEST_MULTIPLE else None


def at_infinite_frequency(later: np.ndarray, delays: np.ndarray) -> AtInfinity:
    """What ``1 + sum(later*exp(-delays*s))`` is in the right half-plane.

    Raises ValueError where that is not decided: where the sizes add up to 1 or more and the dead times are not
    multiples of one.
    """

    some = later != 0
    later, delays = later[some], delays[some]
    total = float(abs(later).sum())
    if total < 1:
        return AtInfinity(1 - total)
    if len(set(delays.tolist())) == 1:
        later = later.sum(keepdims=True)
        total = float(abs(later[0]))
        if total < 1:
            return AtInfinity(1 - total)
        return AtInfinity(0.0 if total == 1 else -1.0)
    if abs(later).max() > total - abs(later).max() + 1:
        # on the axis this one outweighs all others, so that the phase turns with it without end; far to the right only
        # the undelayed one is left, and it does not turn: in between there are roots
        return AtInfinity(-1.0)
    unit = common_unit(delays.tolist())
    if unit:
        found = _on_circle(later, *unit)
        if found is not None:
            return found
    raise ValueError(
        f"whether there is an end of unstable roots is not decided: the highest power returns with the coefficients "
        f"{', '.join(f'{c:g}' for c in later)}, whose sizes add up to 1 or more, and with the dead times "
        f"{', '.join(f'{delay:g}' for delay in delays)}"
    )


def _on_circle(later, unit, powers):
    """The same for dead times that are multiples of one; None where it is too close to the limit."""
    powers = np.array(powers, dtype=float)
    steep = float(abs(later) @ powers)
    count = 16 * int(max(powers))
    edges = np.linspace(0, 2 * math.pi, count + 1)
    for _ in range(30):
        values = 1 + later @ np.exp(-1j * np.multiply.outer(powers, edges))
        middle, half = (edges[1:] + edges[:-1]) / 2, (edges[1:] - edges[:-1]) / 2
        # from both ends, no value on an interval is farther than half of it allows
        low = np.minimum(abs(values[1:]), abs(values[:-1])) - steep * half
        if (open_ := low <= 0).any():
            if half.min() < CLOSE or len(edges) > 2_000_000:
                return None
            edges = np.sort(np.concatenate([edges, middle[open_]]))
            continue
        turns = np.angle(values[1:] / values[:-1])
        if round(turns.sum() / (2 * math.pi)):
            return AtInfinity(-1.0)  # exp(-unit*s) runs through the disc in which there are roots
        phases = np.concatenate([[0.0], np.cumsum(turns)])
        return AtInfinity(float(low.min()), unit, edges, phases, values, (later, powers))
    return None


def prevailing(coefficients: np.ndarray, least: np.ndarray | None = None) -> np.ndarray:
    """A frequency beyond which the highest power of the first part outweighs all other terms; nan without one.

    Arguments:
        coefficients: array [part, power, point].
        least: a lower bound of the size of all terms with the highest power, if it is known to be better than that of
            the first part without the sizes of the others.
    """
    sizes = abs(coefficients).sum(axis=0)
    order = len(sizes) - 1
    reserve = 2 * abs(coefficients[0, -1]) - sizes[-1]
    if least is not None:
        reserve = np.maximum(reserve, least)
    reserve = np.where(reserve > 0, reserve, math.nan)
    # Fujiwara's bound: there each lower term is below a half, a quarter, an eighth ... of the highest
    bounds = 2 * (sizes[:-1] / reserve) ** (1 / np.arange(order, 0, -1)[:, None])
    end = bounds.max(axis=0) if order else 0 * reserve
    return np.where(end == 0, 1.0, end)


def power_of_two(frequency: np.ndarray) -> np.ndarray:
    """The next power of two, so that time in its unit rounds nothing."""
    return 2.0 ** np.ceil(np.log2(frequency))
