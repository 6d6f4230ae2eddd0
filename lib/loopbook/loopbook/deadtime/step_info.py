"""What a step response is judged by: rise, overshoot, settling, read off the exact response."""

from __future__ import annotations

import cmath
import math
from typing import TYPE_CHECKING, NamedTuple

import numpy as np
from numpy.polynomial import legendre

from loopbook.deadtime.response import Response
from plainmath.validation import number

if TYPE_CHECKING:
    from collections.abc import Callable, Sequence

__all__ = ["StepInfo", "first_time_at", "settled_response", "step_info", "zeros_of"]

MOST_DOUBLINGS = 40  # of the time up to which a response is followed
FEW_SEGMENTS, MOST_SEGMENTS = 1_000, 16_000  # after which a single mode is looked for, and none is found
ONE_MODE = 1e-9  # of what is left of a response, that may be more than a mode
ROUNDING = 1e-11  # a smaller overshoot, as a share of the peak, is none
REAL = 1e-7  # imaginary part of a root, of a segment of length 2, that may be rounding


class StepInfo(NamedTuple):
    """How a stable system answers to a unit step: what `System.step_info` returns.

    Attributes:
        rise_time: from 10 % to 90 % of the final value, or between the shares that were given.
        settling_time: after it the response stays within 2 % of the final value, or the share that was given; where
            the final value is zero, within that share of the peak.
        overshoot: the largest value beyond the final one, as a share of it: 0.05 is 5 %. Zero if there is none.
        undershoot: the largest value on the other side of zero, as a share of the final value.
        peak: the value of largest size.
        peak_time: when it is reached; infinite where the response only approaches it.
        final_value: the static gain.

    Where the final value is zero there is no rise and no overshoot: they are nan.
    """

    rise_time: float
    settling_time: float
    overshoot: float
    undershoot: float
    peak: float
    peak_time: float
    final_value: float


def step_info(
    response_until: Callable[[float], Response],
    begin: float,
    horizon: float,
    final: float,
    slowest: Callable[[], list[complex]],
    settling: float = 0.02,
    rise: Sequence[float] = (0.1, 0.9),
) -> StepInfo:
    """Return what characterises the step response of a stable system.

    Arguments:
        response_until: function of an end, that returns the `Response` up to there.
        begin, horizon: ends to begin with, the first where it oscillates very often up to the second, before which
            it is not taken for settled.
        final: the final value.
        slowest: function that returns some of the slowest poles.
        settling: half the width of the band, as a share.
        rise: two shares of the final value, increasing.
    Raises:
        ValueError: for shares that are none, or a response of which it is not decided when it settles, because several
            modes of it last too long.
    """
    number("the band for settling", settling, "a share between 0 and 1", lambda x: 0 < x < 1)
    low, high = (number("a share of the rise", share, "one from 0 to 1", lambda x: 0 <= x < 1) for share in rise)
    if not low < high:
        raise ValueError(f"the rise is from {low:g} to {high:g}: expected increasing shares")
    response, mode = settled_response(response_until, begin, horizon, final, settling, slowest)
    (top, top_time), (bottom, bottom_time) = _extreme(response, 1), _extreme(response, -1)
    peak, peak_time = (top, top_time) if top >= bottom else (-bottom, bottom_time)
    band = settling * (abs(final) or abs(peak))
    if final and abs(peak) <= abs(final) * (1 + ROUNDING):
        peak, peak_time = final, math.inf
    settled = mode.last_time_outside(band) if mode else _last_time_outside(response, final, band)
    if not final:
        return StepInfo(math.nan, settled, math.nan, math.nan, float(peak), float(peak_time), 0.0)
    beyond, opposite = (top, bottom) if final > 0 else (bottom, top)
    over, under = beyond / abs(final) - 1, opposite / abs(final)
    over, under = over if over > ROUNDING else 0.0, under if under > ROUNDING * abs(peak / final) else 0.0
    start, end = (first_time_at(response, share * final) for share in (low, high))
    return StepInfo(*map(float, (end - start, settled, over, under, peak, peak_time, final)))


def settled_response(
    response_until: Callable[[float], Response],
    begin: float,
    horizon: float,
    final: float,
    settling: float,
    slowest: Callable[[], list[complex]],
) -> tuple[Response, Mode | None]:
    """The response, followed twice as far until its later three quarters stay within a fifth of the band.

    A single quarter could lie between two swings, or within a dead time; and what may yet come is smaller than what has
    been in as long a time, since a stable response decays. Where that takes long, it ends as soon as the later half is
    a single mode, that of one of the slowest poles, which is then returned as well.
    """
    end, poles = min(begin, horizon), None
    for _ in range(MOST_DOUBLINGS):
        response = response_until(end)
        first, sizes = response.coefficients[:, 0], abs(response.coefficients).sum(axis=1)
        away = abs(first - final) + sizes - abs(first)
        band = settling * (abs(final) or sizes.max(initial=0.0))
        if end >= horizon and (away[response.edges[1:] > end / 4] <= band / 5).all():
            return response, None
        if len(sizes) > FEW_SEGMENTS:
            poles = slowest() if poles is None else poles
            found = (Mode.last(response, final, pole) for pole in poles)
            if mode := next(filter(None, found), None):
                return response, mode
        if len(sizes) > MOST_SEGMENTS:
            break
        end = 2 * end if end >= horizon else min(4 * end, horizon)
    raise ValueError(
        f"when the response settles at {final:g} is not decided: after t = {end:g} it has not, and what is left is "
        f"more than one mode"
    )


class Mode(NamedTuple):
    """What is left of a response from a time on, ``Re(amplitude*exp(pole*(t - begin)))``."""

    begin: float
    amplitude: complex
    pole: complex

    @classmethod
    def last(cls, response: Response, final: float, pole: complex) -> Mode | None:
        """That of a complex pole, if the later half of a response is nothing else, and several of its periods long."""
        half = response.edges[-1] / 2
        times = response.quadrature()[0]
        times = times[times[:, 0] >= half].ravel()
        if pole.imag * half < 4 * math.pi:
            return None
        left = response(times) - final
        swing = np.exp(pole * (times - times[0]))
        basis = np.stack([swing.real, -swing.imag], axis=1)
        shares = np.linalg.lstsq(basis, left)[0]
        if abs(basis @ shares - left).max() > ONE_MODE * abs(left).max():
            return None
        return cls(float(times[0]), complex(*shares), pole)

    def __call__(self, t: float) -> float:
        return (self.amplitude * cmath.exp(self.pole * (t - self.begin))).real

    def last_time_outside(self, band: float) -> float:
        """When the size of it is that of the band, and later below."""
        rate, w = -self.pole.real, self.pole.imag
        # the last swing out of the band ends on the way to the next zero
        turning = cmath.phase(self.amplitude * self.pole)
        latest = math.log(abs(self.amplitude) * w / abs(self.pole) / band) / rate
        top = (math.floor((w * latest + turning) / math.pi - 0.5) + 0.5) * math.pi - turning
        low, high = self.begin + top / w, self.begin + (top + math.pi / 2) / w
        for _ in range(60):
            middle = (low + high) / 2
            low, high = (middle, high) if abs(self(middle)) > band else (low, middle)
        return low


def _extreme(response: Response, sign: int) -> tuple[float, float]:
    """The largest value of ``sign*response`` and when it is reached."""
    rows = sign * response.coefficients
    bounds = rows[:, 0] + abs(rows[:, 1:]).sum(axis=1)
    points = np.r_[-1.0, legendre.leggauss(rows.shape[1])[0], 1.0]
    values = legendre.legval(points, rows.T)
    segment, point = np.unravel_index(values.argmax(), values.shape)
    best, place = values[segment, point], (segment, points[point])
    for k in np.argsort(-bounds):
        if bounds[k] <= best * (1 + 1e-15):
            break
        turning = zeros_of(legendre.legder(rows[k]))
        heights = legendre.legval(turning, rows[k])
        if len(turning) and heights.max() > best:
            best, place = heights.max(), (k, turning[heights.argmax()])
    return float(best), _moment(response, *place)


def first_time_at(response: Response, level: float) -> float:
    """When a response first reaches a level, from below a positive one, from above a negative one."""
    sign = -1.0 if level < 0 else 1.0
    rows = sign * response.coefficients.copy()
    rows[:, 0] -= abs(level)
    for k in np.flatnonzero(rows[:, 0] + abs(rows[:, 1:]).sum(axis=1) >= 0):
        if legendre.legval(-1.0, rows[k]) >= -ROUNDING * max(abs(level), abs(rows[k]).max()):
            return float(response.edges[k])
        if len(found := zeros_of(rows[k])):
            return _moment(response, k, found.min())
    raise ValueError(f"the response does not reach {level:g} up to t = {response.edges[-1]:g}")


def _last_time_outside(response: Response, final: float, band: float) -> float:
    """The last moment at which the distance from the final value is that of the band."""
    rows = response.coefficients.copy()
    rows[:, 0] -= final
    for k in np.flatnonzero(abs(rows).sum(axis=1) > band)[::-1]:
        crossings = np.concatenate([zeros_of(legendre.legadd(rows[k], [side])) for side in (-band, band)])
        if len(crossings):
            return _moment(response, k, crossings.max())
        if abs(rows[k].sum()) > band:  # until a jump at the end of the segment
            return float(response.edges[k + 1])
    return 0.0


def zeros_of(row: np.ndarray) -> np.ndarray:
    """The zeros of a Legendre series between -1 and 1."""
    row = np.trim_zeros(np.where(abs(row) > 1e-16 * abs(row).max(initial=0.0), row, 0.0), "b")
    roots = legendre.legroots(row) if len(row) > 1 else np.zeros(0)
    return roots.real[(abs(roots.imag) < REAL) & (abs(roots.real) <= 1)]


def _moment(response: Response, segment: int, local: float) -> float:
    begin, end = response.edges[segment], response.edges[segment + 1]
    return float(begin + (end - begin) * (local + 1) / 2)
