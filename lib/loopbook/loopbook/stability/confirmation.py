"""Limits of stability confirmed by what does not know how they were found: the number of poles on both sides."""

from __future__ import annotations

import math
from fractions import Fraction
from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from loopbook.quasipolynomials.arrays import Quasipolynomials
from loopbook.quasipolynomials.fraction import Quasipolynomial, plus
from loopbook.stability.certified import certified_count
from loopbook.stability.counting import INFINITELY_MANY, ON_LIMIT, count_closed, count_roots
from loopbook.stability.enclosures import UndecidedError

if TYPE_CHECKING:
    from loopbook.stability.loops import Loops

MOST_INTERVALS, MOST_ALONE = 150_000, 40_000  # for all counts beside limits, and for one if these are too few
# Of a limit, by which the two sides differ from it, the first that decides: closer than the first, poles are nearer to
# the axis than counting can tell, and farther than the last, another limit may have been passed.
SHARES = (1e-6, 1e-5, 1e-4, 1e-3)


class Change(NamedTuple):
    """A loop with another gain, more dead time or another phase, in what it is a limit of, and near which frequency."""

    name: str
    limit: float
    inside: bool
    outwards: float
    near: float

    def at(self, share: float) -> tuple[float, float, float]:
        """Factor, dead time and angle."""
        value = self.limit * (1 + (-self.outwards if self.inside else self.outwards) * share)
        if self.name in ("gain_margin", "gain_reduction"):
            return value, 0.0, 0.0
        return (1.0, value, 0.0) if self.name == "delay_margin" else (1.0, 0.0, math.radians(value))


def confirm(loops: Loops, found: dict[str, float], itself: bool = True) -> None:
    """Count the unstable poles on both sides of each limit of a loop.

    Arguments:
        found: the limits by their names among those of `Margins`, and the frequencies at which they are.
        itself: whether the loop is to be stable as it is.
    Raises:
        ArithmeticError: where the numbers contradict a limit.
        ValueError: where poles are too close to the axis on one side of it to be counted.
    """
    changes = [Change("gain_margin", 1.0, True, 0.0, math.nan)] if itself else []
    for name, omega, outwards in (
        ("gain_margin", "omega_180", 1.0),
        ("gain_reduction", "omega_reduction", -1.0),
        ("phase_margin", "omega_c", 1.0),
        ("delay_margin", "omega_delay", 1.0),
    ):
        limit = found.get(name, math.inf)
        if 0 < limit < math.inf:
            near = found[omega]
            if near < math.inf:
                changes.append(Change(name, limit, True, outwards, near))
            changes.append(Change(name, limit, False, outwards, near))
    for share in SHARES:
        if not changes:
            return
        counts = _counted(loops, [change.at(share) for change in changes], [change.near for change in changes])
        left = []
        for change, count in zip(changes, counts, strict=True):
            if count == ON_LIMIT and change.name != "phase_margin":
                count = _exactly(loops, *change.at(share)[:2])
            if count == ON_LIMIT:
                left.append(change)
            elif (count == 0) != change.inside and share > SHARES[0]:
                raise ValueError(
                    f"the {change.name.replace('_', ' ')} is not decided: about {change.limit:.12g} there are poles so "
                    f"close to the axis that counting does not tell on which side they are"
                )
            elif (count == 0) != change.inside:
                side = "inside" if change.inside else "outside"
                raise ArithmeticError(
                    f"the {change.name.replace('_', ' ')} {change.limit:.12g} is not confirmed: just {side} of it "
                    f"there are {count:g} unstable poles"
                )
        changes = left


def _counted(loops, changes, near, most=MOST_INTERVALS):
    """As `_counts`, but on the limit for those that are not decided."""
    try:
        return _counts(loops, changes, near, most)
    except ValueError:
        if len(changes) == 1:
            return [ON_LIMIT]
    return [
        count for change, w in zip(changes, near, strict=True) for count in _counted(loops, [change], [w], MOST_ALONE)
    ]


def _counts(loops, changes, near, most):
    """The numbers of unstable poles of a loop with several changes; of those with another phase, of both conjugates."""
    both = [*changes, *((factor, delay, -angle) for factor, delay, angle in changes if angle)]
    factors = np.array([factor * complex(math.cos(angle), math.sin(angle)) for factor, _, angle in both])
    if not factors.imag.any():
        factors = factors.real
    unit = float(loops.unit[0])
    late = np.array([delay * unit for _, delay, _ in both])
    near = [*near, *(w for w, (*_, angle) in zip(near, changes, strict=True) if angle)]
    A, B = loops.A, loops.B
    count = len(both)
    coefficients = np.concatenate(
        [np.broadcast_to(B.coefficients, (*B.coefficients.shape[:2], count)), factors * A.coefficients]
    )
    delays = np.concatenate([np.broadcast_to(B.delays, (len(B.delays), count)), A.delays + late])
    counts = count_roots(
        Quasipolynomials(coefficients, delays),
        removable=int(loops.at_zero[4][0]),
        near=np.array(near) / unit,
        most=most,
    )
    turned = iter(counts[len(changes) :])
    found = []
    for number, (*_, angle) in zip(counts, changes, strict=False):
        other = next(turned) if angle else number
        found.append(ON_LIMIT if ON_LIMIT in (number, other) else round((number + other) / 2))
    return found


def _exactly(loops, factor, delay):
    """The number of unstable poles with more digits; on the limit where they do not decide."""
    A, B = loops.exact[:2]
    factor, delay = Fraction(factor), Fraction(delay)
    above = {d + delay: tuple(factor.numerator * c for c in part) for d, part in A.parts.items()}
    below = {d: tuple(factor.denominator * c for c in part) for d, part in B.parts.items()}
    parts: Quasipolynomial = plus(below, above)
    if max(map(len, parts.values())) > len(parts[Fraction(0)]):
        return INFINITELY_MANY
    try:
        count = certified_count(parts, int(loops.at_zero[4][0]))
    except UndecidedError:
        return ON_LIMIT
    return ON_LIMIT if count is None else count


def confirm_gains(loops: Loops, gains: np.ndarray, frequencies: np.ndarray) -> None:
    """Count the unstable poles of many loops on both sides of the ultimate gain of each, if that is finite.

    Raises ArithmeticError where the numbers contradict it.
    """
    left = np.flatnonzero(np.isfinite(gains))
    for inside in (True, False):
        points = left if not inside else left[np.isfinite(frequencies[left])]
        for share in SHARES:
            if not len(points):
                break
            changed = gains[points] * (1 - share if inside else 1 + share)
            near = frequencies[points] / loops.unit[points]
            counts = count_closed(loops.A[points], loops.B[points], changed, near)
            if (wrong := np.flatnonzero(((counts == 0) != inside) & (counts != ON_LIMIT))).size:
                raise ArithmeticError(
                    f"the ultimate gain {gains[points[wrong[0]]]:.12g} is not confirmed: just "
                    f"{'inside' if inside else 'outside'} of it there are {counts[wrong[0]]:g} unstable poles"
                )
            points = points[counts == ON_LIMIT]
