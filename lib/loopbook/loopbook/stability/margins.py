"""The margins of a stable loop: how far its gain, its phase and its dead time are from the limit, and Ms."""

from __future__ import annotations

import contextlib
import functools
import math
from typing import NamedTuple

import numpy as np

from loopbook.quasipolynomials.fraction import common_polynomial, times
from loopbook.stability.confirmation import confirm
from loopbook.stability.counting import (
    cancels,
    characteristic,
    fraction_sums,
    is_closed_loop_stable,
    is_stable,
    open_loop,
)
from loopbook.stability.crossings import Real, SizeOne, asked, phase_left, steps, wider
from loopbook.stability.enclosures import MOST_INTERVALS, divided
from loopbook.stability.high_frequencies import HighFrequencies
from loopbook.stability.loops import ENOUGH, Loops
from loopbook.stability.polynomials import unstable_roots_of
from loopbook.stability.sensitivity import Peak, to_the_top

MOST_TURNS = 2000.0  # of the phase by dead time, in radians, after which it is given up that has no end in sight
NEAR_PEAK = np.array([-36.0, -12.0, -4.0, -1.0, 1.0, 4.0, 12.0, 36.0]) / 16  # ends of intervals, in widths of it
FURTHEST = 1e15  # times the frequency of the fastest pole, beyond which nothing is looked for


class Margins(NamedTuple):
    """How far a stable loop is from the limit of stability: what `margins` returns.

    Attributes:
        gain_margin: the factor by which the gain may grow; infinite where it may grow without end.
        gain_reduction: the factor to which the gain may fall; 0 where it may fall without end.
        phase_margin: the angle by which the phase may turn, either way, in degrees.
        delay_margin: the additional dead time, in the unit of the lags.
        Ms: the largest value of abs(1/(1 + L)) at any frequency; 1/Ms is the distance of L from -1.
        omega_180, omega_c, omega_ms: the frequencies of gain margin, phase margin and Ms, in radians for one unit of
            time; nan where a margin is infinite, inf where it is that of ever higher frequencies.
    """

    gain_margin: float
    gain_reduction: float
    phase_margin: float
    delay_margin: float
    Ms: float
    omega_180: float
    omega_c: float
    omega_ms: float


NOTHING = Margins(math.inf, 0.0, math.inf, math.inf, 1.0, math.nan, math.nan, math.nan)


def delay_margin(loop: object) -> float:
    """Return the additional dead time in the loop that brings a stable closed loop to the limit of stability.

    Arguments:
        loop: the open loop L(s), as for `unstable_closed_loop_poles`.
    Returns:
        The additional dead time, in the unit of the lags; infinite where none makes the loop unstable, zero where any
        does, because the gain at infinite frequency is 1 or more.
    Raises:
        ValueError: if the loop is not stable to begin with, or as `unstable_closed_loop_poles`.

    >>> import sympy
    >>> from loopbook import s
    >>> round(delay_margin(sympy.exp(-s) / s), 4)    # pi/2 in all
    0.5708
    """
    loops = _read(loop)
    if loops is None:
        return math.inf
    with _or_unstable(loop):
        survey = Survey(loops, [SizeOne()])
        found = survey.delay_margins()
        confirm(loops, found)
        if not found["delay_margin"] and not is_closed_loop_stable(loop):  # nothing is beside it to be confirmed
            raise ValueError
    return found["delay_margin"]


def margins(loop: object) -> Margins:
    """Return gain margin, phase margin, delay margin and Ms of a stable loop, with any dead times, as `Margins`.

    All crossings are found, by enclosures that exclude others, and of several the nearest one counts. Of the limits,
    each is confirmed by the number of unstable poles on either side of it. A gain margin above 1e12 counts as infinite.

    Arguments:
        loop: the open loop L(s), as for `unstable_closed_loop_poles`.
    Raises:
        ValueError: if the closed loop is not stable, as `unstable_closed_loop_poles`, or where something is not decided
            with 60,000 intervals of frequency; the message says what, and where.

    >>> import sympy
    >>> from loopbook import s
    >>> found = margins(sympy.exp(-s) / (2 * s))
    >>> round(found.gain_margin, 4), round(found.phase_margin, 4), round(found.delay_margin, 4)
    (3.1416, 61.3521, 2.1416)
    """
    loops = _read(loop)
    if loops is None:
        return NOTHING
    if not loops.fraction.delays and not loops.fraction.order:
        return _of_constant(float(loops.fraction(0).real))
    with _or_unstable(loop):
        real, size, peak = Real(loops), SizeOne(), Peak(loops)
        survey = Survey(loops, [real, size, peak])
        found = survey.gain_margins() | survey.phase_margins() | survey.delay_margins()
        confirm(loops, found)
    Ms, omega_ms = float(peak.most[0]), float(peak.place[0] * loops.unit[0])
    return Margins(
        found["gain_margin"], found["gain_reduction"], found["phase_margin"], found["delay_margin"], Ms,
        found["omega_180"], found["omega_c"], omega_ms,
    )  # fmt: skip


def _of_constant(gain: float) -> Margins:
    """The margins of a loop without lags and dead times: with the gain -1 it has no solution."""
    limit = -1 / gain if gain < 0 else math.nan
    return NOTHING._replace(
        gain_margin=limit if limit > 1 else math.inf,
        gain_reduction=limit if limit < 1 else 0.0,
        phase_margin=180.0 if gain == 1 else math.inf,
        delay_margin=math.inf if abs(gain) < 1 else 0.0,
        Ms=1 / abs(1 + gain),
    )


def _read(loop: object) -> Loops | None:
    """A loop in numbers; None for none."""
    L = open_loop(loop, zero=True)
    if cancels(loop) and not _cancels_stable(loop):
        raise ValueError(f"{loop} is not stable: controller and process cancel an unstable pole; it has no margin")
    if L.numerator:
        characteristic(L)  # raises for what is not a loop
        return Loops(*fraction_sums(L), L)
    if not is_stable(L):
        raise ValueError(f"{L.expr} is not stable: it has no margin")
    return None


def _cancels_stable(loop: object) -> bool:
    """Whether the poles that controller and process cancel are in the left half-plane."""
    P, C, L = loop.process_fraction, loop.controller_fraction, loop.open_fraction
    above, below = times(P.numerator, C.numerator), times(P.denominator, C.denominator)
    common, rest = common_polynomial(dict(enumerate((*below.values(), *above.values()))))
    if list(rest.values())[: len(below)] == list(L.denominator.values()):
        return unstable_roots_of(common) == 0
    return is_stable(loop)  # what is cancelled has dead times


@contextlib.contextmanager
def _or_unstable(loop: object):
    """Say of a loop for which something fails that it is not stable, if that is so; its own poles are counted, too."""
    try:
        with np.errstate(all="ignore"):  # what is not finite decides nothing
            yield
    except (ValueError, ArithmeticError):
        L = open_loop(loop)
        if not is_closed_loop_stable(L):
            raise ValueError(f"the closed loop of {L.expr} is not stable: it has no margin") from None
        raise


class Survey:
    """Questions about one loop, asked in windows of frequency until bounds answer them for all that is beyond."""

    def __init__(self, loops: Loops, questions: list):
        self.loops, self.at_infinity = loops, HighFrequencies(loops)
        kinds = {type(question): question for question in questions}
        self.real, self.size, self.peak = (kinds.get(kind) for kind in (Real, SizeOne, Peak))
        self._begin()
        self._ask(questions)

    def _begin(self):
        """What is known at zero and at infinite frequency."""
        loops, at_infinity, one = self.loops, self.at_infinity, np.zeros(1, dtype=int)
        if self.real:
            self.real.highest = np.minimum(self.real.highest, at_infinity.highest)
            self.real.lowest = np.maximum(self.real.lowest, at_infinity.lowest)
            if (static := loops.static_gains())[0] > 0:
                self.real.add(one, static, np.zeros(1))
        if self.peak:
            self.peak.see(one, np.array([at_infinity.sensitivity]), np.full(1, math.inf))

    def _end(self, question, done: float) -> float:
        """A frequency beyond which a question is decided; nan where none is known yet."""
        at_infinity = self.at_infinity
        if question is self.real:
            low, high = float(question.lowest[0]), float(question.highest[0])
            end = at_infinity.no_crossing_beyond(low, high)
            if not end <= done and (math.isnan(end) or high == question.infinite_from[0]):
                end = min(end if end == end else math.inf, self.loops.real_beyond)
            return end
        if question is self.size:
            return at_infinity.size_end()
        return at_infinity.no_peak_beyond(float(question.most[0]) * (1 + ENOUGH))

    def _ask(self, questions):
        loops = self.loops
        if self.size and self.at_infinity.size == 0:
            if questions == [self.size] and self.at_infinity.exceeds_one:
                return
            raise ValueError("whether the loop's gain at ever higher frequencies stays away from 1 is not decided")
        done = self.peak.below() if self.peak else loops.start
        longest = float(loops.longest[0])
        end, left, most = self._scout(float(done[0]), questions), questions, MOST_INTERVALS
        while True:
            most -= asked(loops, left, *self._intervals(float(done[0]), end), most)
            done = np.array([end])
            ends = {id(question): self._end(question, end) for question in questions}
            left = [question for question in questions if not ends[id(question)] <= end]
            if not left:
                return
            furthest = max(math.inf if math.isnan(each) else each for each in ends.values())
            if (furthest == math.inf and (end * longest > MOST_TURNS or end > FURTHEST)) or end > 1e3 * FURTHEST:
                raise ValueError(self._undecided(left, end))
            end = min(furthest, float(wider(loops, done)[0]))
            if (end - float(done[0])) * longest > most:
                raise ValueError(self._undecided(left, float(done[0])))

    def _undecided(self, questions, end):
        """What is not decided beyond a frequency, and what is known about it."""
        text = " and ".join(question.name for question in questions)
        text += f", beyond the frequency {end * self.loops.unit[0]:.6g}, is not decided"
        if self.at_infinity.is_open:
            text += ", where the highest powers have several dead times"
        if self.real in questions:
            low, high = float(self.real.lowest[0]), float(self.real.highest[0])
            sure = (1 + (high - 1) * (1 - 0.5**n) for n in range(12, 0, -1))
            known = next((k for k in sure if self.at_infinity.no_crossing_beyond(low, k) <= end), 1.0)
            text += f"; the gain margin is between {known:.8g} and {high:.8g}"
        if self.peak in questions:
            text += f"; Ms is {self.peak.most[0]:.8g} or more"
        return text

    def _scout(self, start, questions):
        """See from values alone where the answers may be, so that they are soon proved; an end of the first window."""
        loops = self.loops
        end = float(loops.beyond(np.full(1, 2.0))[0])
        end = max(end if end < 64 else 4.0, 4 * start)
        w = start * (2 * end / start) ** (np.arange(80) / 79)
        index = np.zeros(len(w), dtype=int)
        A, B = (x[0] for x in loops.values(index, w))
        if self.peak:
            C = A + B
            highest = abs(B * C).argmax() if not C.all() else (abs(B) / abs(C)).argmax()
            self.peak.see(index[:1], (abs(B) / abs(C))[[highest]], w[[highest]])
            to_the_top(loops, self.peak)
        if self.real:
            product = A * B.conj()
            imag, negative = product.imag, product.real < 0
            some = np.flatnonzero(((imag[1:] > 0) != (imag[:-1] > 0)) & negative[1:] & negative[:-1])[:8]
            if len(some):
                self.real.solve(index[some], w[some], w[some + 1], imag[some], imag[some + 1])
        ends = [self._end(question, end) for question in questions if question is not self.size]
        return max([end, *(each for each in ends if each < 8 * end)])

    def _intervals(self, start, end):
        """Geometric steps, divided where dead times turn the phase much, and the peak in the middle of one of them."""
        _, a, b = steps(np.full(1, start), np.full(1, end))
        edges = np.append(a, b[-1])
        if self.peak and start < self.peak.place[0] < end:
            p, width = float(self.peak.place[0]), self.peak.width
            near = p + width * NEAR_PEAK
            inner = edges[1:-1][~(abs(edges[1:-1] - p) < width / 16)]
            edges = np.sort(np.concatenate([edges[[0, -1]], inner, near[(near > start) & (near < end)]]))
        a, b = edges[:-1], edges[1:]
        return divided(np.zeros(len(a), dtype=int), a, b, np.ceil((b - a) * self.loops.longest).clip(1, 64).astype(int))

    # ---- what was found

    def gain_margins(self) -> dict[str, float]:
        """How far the gain may grow and fall, and the frequencies of both."""
        real, unit = self.real, float(self.loops.unit[0])
        found = {}
        for name, omega, value, none in (
            ("gain_margin", "omega_180", float(real.highest[0]), float(real.infinite_from[0])),
            ("gain_reduction", "omega_reduction", float(real.lowest[0]), 0.0),
        ):
            if value == none:
                found |= {name: math.inf if none else 0.0, omega: math.nan}
                continue
            at = np.flatnonzero(real.gains == value)
            found |= {name: value, omega: float(real.frequencies[at[0]]) * unit if len(at) else math.inf}
        return found

    @functools.cached_property
    def _crossings(self):
        """The frequencies where abs(L) is 1, and how far the phase may still fall there."""
        _, w, A, B = self.size.solved(self.loops)
        return w * float(self.loops.unit[0]), phase_left(A, B)

    def phase_margins(self) -> dict[str, float]:
        """How far the phase may turn, either way, and the frequency; infinite where abs(L) is never 1."""
        w, left = self._crossings
        if not len(w):
            return {"phase_margin": math.inf, "omega_c": math.nan}
        either_way = np.minimum(left, 2 * math.pi - left)
        nearest = either_way.argmin()
        return {"phase_margin": math.degrees(either_way[nearest]), "omega_c": float(w[nearest])}

    def delay_margins(self) -> dict[str, float]:
        """How much more dead time there may be; none where the gain at ever higher frequencies is 1 or more."""
        w, left = self._crossings
        if self.at_infinity.size >= 0:
            return {"delay_margin": 0.0, "omega_delay": math.inf}
        if not len(w):
            return {"delay_margin": math.inf, "omega_delay": math.nan}
        nearest = (left / w).argmin()
        return {"delay_margin": float(left[nearest] / w[nearest]), "omega_delay": float(w[nearest])}
