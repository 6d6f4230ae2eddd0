"""The limit of stability: the gain with which a loop oscillates forever, alone and over the times of a controller."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING

import numpy as np

from loopbook.quasipolynomials.arrays import Quasipolynomials
from loopbook.stability.confirmation import confirm, confirm_gains
from loopbook.stability.counting import (
    ON_LIMIT,
    count_closed,
    fraction_sums,
    is_closed_loop_stable,
    of_one_order,
    open_loop,
)
from loopbook.stability.crossings import Real, asked, steps, wider
from loopbook.stability.enclosures import UndecidedError
from loopbook.stability.high_frequencies import HighFrequencies
from loopbook.stability.loops import Loops
from plainmath.expressions import s
from plainmath.validation import positive, positive_numbers

if TYPE_CHECKING:
    from numpy.typing import ArrayLike

    from loopbook.quasipolynomials import DelayFraction

LARGEST = 1e100
FURTHEST = 1e15  # times the frequency of the fastest pole, beyond which nothing is looked for
MOST_TURNS = 400.0  # of the phase by dead time, in radians, in which a stable range begins or none is found


def ultimate(process: object) -> tuple[float, float]:
    """Return the ultimate gain Ku and the ultimate period Pu: with the gain Ku the loop oscillates with that period.

    Arguments:
        process: transfer function with numbers; dead times may stand anywhere. Of a loop with a controller in it, Ku is
            the factor by which its gain may grow.
    Returns:
        The floats ``(Ku, Pu)``, Pu in the unit of the lags. Ku is the upper end of the lowest range of gains for which
        the closed loop is stable; infinite, with Pu zero, where no gain makes it unstable.
    Raises:
        ValueError: if no positive gain makes the closed loop stable, looked for while the dead times turn the phase by
            400 rad; or as `unstable_poles`.

    >>> import sympy
    >>> from loopbook import s
    >>> Ku, Pu = ultimate(sympy.exp(-s) / s)
    >>> round(Ku, 4), round(Pu, 4)    # pi/2 and 4
    (1.5708, 4.0)
    """
    L = open_loop(process)
    loops, gain, frequency = _ultimate(L)
    if math.isnan(gain):
        opposite = -L
        other = _stable_range(Loops(*fraction_sums(opposite), opposite))[0][0]
        hint = "" if math.isnan(other) else ", but a negative one does"
        least = float(_gains_at_infinity(loops, HighFrequencies(loops, pivot=0.0))[0])
        below = f" below {least:.6g}, with which the gain at infinite frequency is 1," if least < math.inf else ""
        raise ValueError(f"no positive gain{below} makes the closed loop of {L.expr} stable{hint}")
    return gain, 2 * math.pi / frequency if frequency else math.inf


def _ultimate(L: DelayFraction) -> tuple[Loops, float, float]:
    """A loop, its ultimate gain and the frequency of that; nan without one."""
    loops = Loops(*fraction_sums(L), L)
    gain, frequency = (float(found[0]) for found in _stable_range(loops))
    if not math.isnan(gain):
        confirm(loops, {"gain_margin": gain, "omega_180": frequency}, itself=False)
    return loops, gain, frequency


def boundary_pi(process: object, Ti: ArrayLike) -> np.ndarray | float:
    """Return the gain Kp on the limit of stability for PI control, ``Kp*(1 + 1/(Ti*s))``, of any process.

    Of a first-order lag with dead time, the limit solves equations (4) and (5) of the source, here without their
    approximation.

    Arguments:
        process: transfer function with numbers; dead times may stand anywhere.
        Ti: integral time in the unit of the lags, a number or an array; ``math.inf`` is not among them.
    Returns:
        Kp, a number or an array, the upper end of the lowest range of positive gains with a stable loop; infinite where
        no gain is too high, nan where no positive one makes the loop stable.
    Raises:
        ValueError: for an integral time that is not positive and finite, or as `ultimate`.
    Source: Syder, Heeg and O'Dwyer, equations (4) and (5), Figure 1.

    >>> import sympy
    >>> from loopbook import s
    >>> boundary_pi(2 * sympy.exp(-1.4 * s) / (0.7 * s + 1), [1, 2]).round(4)
    array([0.5183, 0.671 ])
    """
    return boundary_pid(process, Ti, 0)


def boundary_pid(process: object, Ti: ArrayLike, Td: ArrayLike, Tf: ArrayLike = 0) -> np.ndarray | float:
    """Return the gain Kp on the limit of stability for PID control, ``Kp*(1 + 1/(Ti*s) + Td*s/(Tf*s + 1))``.

    Arguments:
        process: as for `boundary_pi`.
        Ti, Td, Tf: integral time, derivative time and lag of its filter, in the unit of the lags, numbers or arrays
            that fit together.
    Returns:
        Kp, as `boundary_pi`.
    Raises:
        ValueError: for times that are negative or infinite, Ti = 0, or a loop that is improper without filter.

    >>> import sympy
    >>> from loopbook import s
    >>> round(boundary_pid(sympy.exp(-s) / (s + 1), Ti=2, Td=0.5, Tf=0.05), 4)
    1.7547
    """
    given = [
        positive_numbers("values of Ti", Ti),
        *(positive_numbers(f"values of {name}", x, zero=True) for name, x in (("Td", Td), ("Tf", Tf))),
    ]
    try:
        Ti, Td, Tf = np.broadcast_arrays(*given)
    except ValueError:
        shapes = ", ".join(str(x.shape) for x in given)
        raise ValueError(f"Ti, Td and Tf have the shapes {shapes}: expected numbers, or arrays that fit") from None
    L = open_loop(process)
    A, B = fraction_sums(L)
    i, d, f = 1 / Ti.ravel(), Td.ravel(), np.where(Td > 0, Tf, 0).ravel()
    found = np.empty(Ti.size)
    above, below = (part * of_pid for part, of_pid in zip((A, B), _pid(i, d, f), strict=True))
    try:
        groups = list(of_one_order(above, below))  # PI, and PID without and with filter
    except ValueError:
        raise ValueError(
            f"PID control of {L.expr} without filter is improper: expected a lag Tf that is positive"
        ) from None
    for points, above, below in groups:
        try:
            loops = Loops(above, below)
            found[points], frequencies = _stable_range(loops)
            confirm_gains(loops, found[points], frequencies)
        except UndecidedError:  # one by one there are more digits
            times = zip(Ti.ravel()[points], d[points], f[points], strict=True)
            found[points] = [_ultimate(L * (1 + 1 / (t * s) + td * s / (tf * s + 1)))[1] for t, td, tf in times]
    found = found.reshape(Ti.shape)
    return found if found.ndim else float(found)


def _pid(i, d, f):
    """Numerator and denominator, times s, of ``1 + i/s + d*s/(f*s + 1)``."""
    nothing = np.zeros((1, len(i)))
    return (
        Quasipolynomials(np.array([[i, 1 + i * f, f + d]]), nothing),
        Quasipolynomials(np.array([[0 * i, 1 + 0 * i, f]]), nothing),
    )


def _stable_range(loops: Loops) -> tuple[np.ndarray, np.ndarray]:
    """The upper end of the lowest range of gains for which loops are stable, and its frequency; nan without such.

    The gains with poles on the axis are found in ever wider windows of frequency. One after the other, from the lowest
    on, is it asked whether the loop is stable up to there, as soon as none that is lower can lie beyond the window.
    """
    count, unit = loops.count, loops.unit
    at_infinity = HighFrequencies(loops, pivot=0.0) if loops.exact is not None else None
    gains_at_infinity = _gains_at_infinity(loops, at_infinity)
    real = Real(loops, all_gains=True)
    real.highest = np.minimum(real.highest, gains_at_infinity)
    found, place, lower = np.full(count, math.nan), np.full(count, math.nan), np.zeros(count)
    searched = np.ones(count, dtype=bool)
    static = loops.static_gains()
    some = np.flatnonzero(static > 0)
    real.add(some, static[some], 0 * static[some])
    done, end = loops.start, np.fmin(np.nan_to_num(loops.beyond(2 * np.ones(count)), nan=4.0), 64.0)
    while True:
        end = np.where(searched, np.maximum(done, end), done)
        asked(loops, [real], *steps(done, end))
        done = end
        while searched.any():
            # the lowest gain on the limit that is left, or the end of all
            next_gain, next_place = np.minimum(gains_at_infinity, LARGEST), np.full(count, math.inf)
            new = np.flatnonzero(real.gains > lower[real.points] * (1 + 1e-12))
            order = new[np.argsort(-real.gains[new])]
            better = order[real.gains[order] < next_gain[real.points[order]]]
            next_gain[real.points[better]], next_place[real.points[better]] = (
                real.gains[better],
                real.frequencies[better],
            )
            need = _complete_beyond(
                loops, at_infinity, lower, next_gain, next_gain >= gains_at_infinity, next_gain >= LARGEST
            )
            ready = searched & ((need <= done) | (next_gain <= _least_gain(loops, done)))
            if not ready.any():
                break
            points = np.flatnonzero(ready)
            unlimited = next_gain[points] >= LARGEST
            middle = np.where(unlimited, 2 * lower[points] + 1, (lower[points] + next_gain[points]) / 2)
            # between two gains that bring poles to the axis their number does not change: one gain stands for all
            good = _counted(loops, points, lower[points], middle) == 0
            stable = points[good]
            found[stable] = np.where(unlimited[good], math.inf, next_gain[stable])
            place[stable] = np.where(unlimited[good], math.inf, next_place[stable] * unit[stable])
            lower[points] = next_gain[points]
            searched[points[good | (next_gain[points] >= np.minimum(gains_at_infinity[points], LARGEST))]] = False
        if not searched.any():
            return found, place
        far_out = np.flatnonzero(searched & ((done * loops.longest > MOST_TURNS) | (done > FURTHEST)))
        if len(far_out):
            least = np.maximum(lower, _least_gain(loops, done))[far_out]
            still = _counted(loops, far_out, lower[far_out], (lower[far_out] + least) / 2) == 0
            if still.any():
                k = far_out[still][0]
                raise ValueError(
                    f"no gain on the limit of stability was found up to {least[still][0]:.3g}, where the loop is still "
                    f"stable, and what is beyond the frequency {done[k] * unit[k]:.6g} is not decided"
                )
            searched[far_out] = False
        end = np.where(searched, np.fmin(need, wider(loops, done)), done)


def _counted(loops, points, lower, middle):
    """The numbers of unstable poles with gains between two that bring poles to the axis, the lower one and another."""
    counts = np.full(len(points), ON_LIMIT)
    for share in (1.0, 0.6, 0.9):  # all gains between those two have the same number, but it may be hard to tell
        left = np.flatnonzero(counts == ON_LIMIT)
        gains = lower[left] + share * (middle - lower)[left]
        counts[left] = count_closed(loops.A[points[left]], loops.B[points[left]], gains)
        if (counts != ON_LIMIT).all():
            return counts
    if loops.fraction is not None:
        return np.array([0 if is_closed_loop_stable(float(middle[0]) * loops.fraction) else math.inf])
    gain = middle[np.flatnonzero(counts == ON_LIMIT)[0]]
    raise UndecidedError(f"the number of unstable poles with the gain {gain:.6g}", 0.0, math.inf)


def _complete_beyond(loops, at_infinity, lower, gain, is_at_infinity, is_largest):
    """The frequency beyond which no lower gain brings poles to the axis."""
    need = loops.beyond(np.minimum(gain, 1e100))
    if at_infinity is None:
        need = np.where(is_at_infinity & ~is_largest, np.fmin(need, loops.beyond_limit()), need)
    elif not at_infinity.vanishes:
        need = np.fmin(need, at_infinity.no_crossing_beyond(float(lower[0]), float(gain[0])))
    if is_largest.any():
        last = np.array([loops.real_beyond]) if at_infinity is not None else loops.real_beyond_all()
        need = np.where(is_largest, np.fmin(need, last), need)
    return np.nan_to_num(need, nan=math.inf)


def _least_gain(loops, w):
    """A gain that is too small for poles on the axis beyond a frequency."""
    A, B = loops._term_sizes
    powers = np.maximum(w, 1.0) ** np.arange(len(A))[:, None]
    least = loops._reserve_at_infinity * powers[-1] - (B[:-1] * powers[:-1]).sum(axis=0)
    return np.maximum(least, 0) / (A * powers).sum(axis=0)


def _gains_at_infinity(loops, at_infinity):
    """The lowest gain with which the highest powers alone have unstable roots; infinite if none is known."""
    if at_infinity is not None:
        return np.array([at_infinity.highest])
    a, b = (loops.A + 0.0 * loops.B).coefficients[:, -1], (0.0 * loops.A + loops.B).coefficients[:, -1]
    lowest = np.full(loops.count, math.inf)
    if not a.any():
        return lowest
    used = a.any(axis=1) | b.any(axis=1)
    if used[1:].sum() > 1:
        raise ValueError("the boundary of loops with several dead times in their highest powers is not known")
    for sign in (-1, 1):
        falling, rest = (x[0] + sign * x[1:].sum(axis=0) for x in (-a, b))
        with np.errstate(divide="ignore", invalid="ignore"):
            lowest = np.where(falling > 0, np.minimum(lowest, rest / falling), lowest)
    return lowest


def boundary_pi_approximate(T: float, delay: float, Ti: ArrayLike, K: float = 1) -> np.ndarray | float:
    """Return the gain Kp on the limit of stability for PI control of a lag with dead time, as the source approximates.

    The difference of two arc tangents in equation (5) is one, of ``x = w*(Ti - T)/(1 + w**2*T*Ti)``. Where abs(x) <= 1
    it is replaced by ``pi/4*x``, which makes (5) the cubic equation (6); elsewhere by ``pi/2 - pi/(4*x)``, which makes
    it the quadratic equation (7). A root counts where it is positive and its x lies in the branch from which it came.
    Of several the lowest frequency is taken, as in the exact problem.

    The second branch is printed for x > 1 alone: for x < -1 it would need -pi/2. As abs(x) is never above
    ``abs(Ti - T)/(2*sqrt(Ti*T))``, it is needed only for Ti > 5.8 T, and the other one for Ti < 0.17 T. There, and
    wherever no root lies in its branch, the result is nan.

    Arguments:
        T, delay: lag and dead time of the process, positive.
        Ti: integral time, in the same unit; a number or an array.
        K: gain of the process, positive.
    Returns:
        Kp, a number or an array.
    Raises:
        ValueError: for numbers that are not positive.
    Source: Syder, Heeg and O'Dwyer, equations (4), (6) and (7).

    >>> round(boundary_pi_approximate(0.7, 1.4, 1, K=2), 4)    # without approximation 0.5183
    0.5094
    """
    T, delay, K = positive("T", T), positive("delay", delay), positive("K", K)
    Ti = positive_numbers("values of Ti", Ti)
    found = np.full(Ti.size, math.nan)
    for number, I in enumerate(Ti.flat):
        cubic = [4 * delay * I * T / math.pi, -2 * I * T, (4 * delay - math.pi * I + math.pi * T) / math.pi, -2]
        quadratic = [delay * (I - T) + math.pi / 4 * I * T, -math.pi * (I - T), math.pi / 4]
        valid = []
        for equation, outer in ((cubic, False), (quadratic, True)):
            for root in np.roots(equation):
                w = root.real
                x = w * (I - T) / (1 + w**2 * I * T)
                if abs(root.imag) <= 1e-9 * abs(root) and w > 0 and (x > 1 if outer else abs(x) <= 1):
                    valid.append(w)
        if valid:
            w = min(valid)
            found[number] = I * w / K * math.sqrt((1 + (w * T) ** 2) / (1 + (w * I) ** 2))
    found = found.reshape(Ti.shape)
    return found if found.ndim else float(found)
