"""Stability of a feedback loop with dead time, without approximation.

The closed loop of L(s) = N(s)/D(s) exp(-delay*s) has the characteristic equation D(s) + N(s) exp(-delay*s) = 0. It has
infinitely many roots, but they enter the right half-plane only across the imaginary axis, at frequencies where
abs(D) = abs(N), and these are roots of a polynomial. (K. Walton and J. E. Marshall, IEE Proceedings D 134, 1987)
"""

import math

import sympy

from loopbook.expressions import function_of, s
from loopbook.laplace import by_delay

__all__ = ["StabilityLimitError", "delay_margin", "is_stable", "ultimate", "unstable_poles"]

CLOSE = 1e-9


class StabilityLimitError(ValueError):
    """The closed loop has poles on the imaginary axis: it is neither stable nor unstable."""


def unstable_poles(loop):
    """Return the number of closed-loop poles in the right half-plane, for negative feedback around a loop.

    Arguments:
        loop: the transfer function L(s) of the open loop, with numbers and at most one dead time.
    Raises:
        StabilityLimitError: for closed-loop poles on the imaginary axis.
        ValueError: for letters, several dead times, or a loop that is not strictly proper.

    >>> unstable_poles(sympy.exp(-s) / s), unstable_poles(2 * sympy.exp(-s) / s)
    (0, 2)
    """
    D, N, delay = _parts(loop)
    limit = StabilityLimitError(f"the closed loop of {loop} has poles on the imaginary axis")
    roots = sympy.Poly(D + N, s).nroots(n=30, maxsteps=500)
    on_axis = [abs(sympy.re(p)) < 1e-15 * max(1, abs(p)) for p in roots]
    if any(on_axis) and (not delay or 0 in roots):
        raise limit
    count = sum(bool(sympy.re(p) > 0) for p, limiting in zip(roots, on_axis, strict=True) if not limiting)
    for crossing, period, direction in _crossings(D, N):
        turns = (delay - crossing) / period
        if delay and turns > -CLOSE and abs(turns - round(turns)) < CLOSE:
            raise limit
        # A pair of poles crosses at this dead time, and again with each full turn more. One that lies on the axis
        # without dead time has not been counted yet, so that it only counts where it goes to the right.
        times = 0 if turns < 0 else math.floor(turns) + 1
        count += 2 * direction * times + (2 if times and crossing == 0 and direction < 0 else 0)
    return count


def is_stable(loop):
    """Say whether the closed loop of L(s), with negative feedback, is stable; one on the limit is not.

    Raises ValueError as `unstable_poles` does, but not for a loop on the limit.

    >>> is_stable(sympy.exp(-s) / s), is_stable(2 * sympy.exp(-s) / s)
    (True, False)
    """
    try:
        return unstable_poles(loop) == 0
    except StabilityLimitError:
        return False


def delay_margin(loop):
    """Return the additional dead time that brings a stable closed loop to the limit of stability.

    Arguments:
        loop: the transfer function L(s) of the open loop, with numbers and at most one dead time.
    Returns:
        The additional dead time, in the unit of the lags; infinite where none makes the loop unstable.
    Raises:
        ValueError: if the loop is not stable to begin with, or as `unstable_poles`.

    >>> round(delay_margin(sympy.exp(-s) / s), 4)    # pi/2 in all
    0.5708
    """
    if not is_stable(loop):
        raise ValueError(f"the closed loop of {loop} is not stable: it has no margin")
    D, N, delay = _parts(loop)
    ahead = [
        crossing + period * max(0, math.ceil((delay - crossing) / period)) - delay
        for crossing, period, _ in _crossings(D, N)
    ]
    return min(ahead, default=math.inf)


def ultimate(process):
    """Return the ultimate gain Ku and the ultimate period Pu: with the gain Ku the loop oscillates with that period.

    Arguments:
        process: transfer function with numbers and at most one dead time, strictly proper. Of a loop with a controller
            in it, Ku is the factor by which its gain may grow.
    Returns:
        The floats ``(Ku, Pu)``, Pu in the unit of the lags. Ku is the upper end of the lowest range of gains for which
        the closed loop is stable; infinite, with Pu zero, where no gain makes it unstable.
    Raises:
        ValueError: if no positive gain makes the closed loop stable, or as `unstable_poles`.

    >>> Ku, Pu = ultimate(sympy.exp(-s) / s)
    >>> round(Ku, 4), round(Pu, 4)    # pi/2 and 4
    (1.5708, 4.0)
    """
    limits = _limiting_gains(process)
    lower = 0.0
    for gain, frequency in [*limits, (math.inf, math.inf)]:
        inside = 2 * lower + 1 if gain == math.inf else (lower + gain) / 2
        if is_stable(sympy.nsimplify(inside, rational=True) * function_of(s, process)):
            return gain, 2 * math.pi / frequency
        lower = gain
    raise ValueError(f"no gain makes the closed loop of {process} stable")


def _parts(loop):
    """Denominator, numerator and dead time of a strictly proper loop."""
    loop = function_of(s, loop)
    if letters := sorted(map(str, loop.free_symbols - {s})):
        raise ValueError(f"the stability of {loop} is not known: give a number for {', '.join(letters)}")
    if len(parts := by_delay(loop)) != 1:
        raise ValueError(f"{loop} adds terms of different dead times: expected one dead time")
    ((delay, rational),) = parts.items()
    N, D = sympy.cancel(rational).as_numer_denom()
    if sympy.degree(N, s) >= sympy.degree(D, s):
        raise ValueError(f"{loop} is not strictly proper: expected more poles than zeros")
    return D, N, float(delay)


def _crossings(D, N):
    """Where poles cross the imaginary axis: (first dead time, period to the next, direction: 1 to the right)."""
    omega = sympy.Symbol("omega", positive=True)
    square = sympy.Symbol("square")

    def power(polynomial):  # abs(polynomial)^2 on the imaginary axis, in the square of the frequency
        there = polynomial.subs(s, sympy.I * omega)
        return sympy.expand(there * sympy.conjugate(there)).subs(omega, sympy.sqrt(square))

    difference = sympy.Poly(sympy.expand(power(D) - power(N)), square)
    for root, n in sympy.Poly(difference, square).real_roots(multiple=False) if difference.degree() > 0 else []:
        if root <= 0 or n % 2 == 0:
            continue
        frequency = math.sqrt(root.evalf(30))
        ratio = complex((-N / D).subs(s, sympy.I * sympy.Float(frequency, 30)).evalf(30))
        angle = math.atan2(ratio.imag, ratio.real)
        angle = 0.0 if abs(angle) < CLOSE else angle % (2 * math.pi)
        rising = difference.diff(square)
        direction = 1 if sympy.N(rising.eval(root), 30) > 0 else -1
        yield angle / frequency, 2 * math.pi / frequency, direction


def _limiting_gains(process):
    """The gains at which poles lie on the imaginary axis, with their frequencies, the lowest gains first."""
    import numpy
    from scipy.optimize import brentq

    D, N, delay = _parts(process)
    D, N = (numpy.poly1d([float(c) for c in sympy.Poly(p, s).all_coeffs()]) for p in (D, N))

    def response(w):
        return N(1j * w) / D(1j * w) * numpy.exp(-1j * w * delay)

    corners = [abs(root) for root in [*D.roots, *N.roots] if abs(root) > 0] or [1 / delay if delay else 1.0]
    low, high = min(corners) / 1000, max(corners) * 1000
    grid = numpy.geomspace(low, high, 20_000)
    if delay:
        # beyond the corners the phase turns with the dead time alone, and each turn needs more gain than the last
        low, high = min(low, 0.001 / delay), max(corners) + 6 * math.pi / delay
        grid = numpy.unique(numpy.r_[numpy.geomspace(low, high, 20_000), numpy.linspace(low, high, 20_000)])
    imaginary = response(grid).imag
    found = []
    for n in numpy.flatnonzero(imaginary[:-1] * imaginary[1:] < 0):
        w = brentq(lambda w: response(w).imag, grid[n], grid[n + 1], xtol=1e-15 * grid[n], rtol=1e-14)
        if (real := response(w).real) < 0:
            found.append((float(-1 / real), float(w)))
    if (static := D(0) and N(0) / D(0)) < 0:
        found.append((float(-1 / static), 0.0))
    return sorted(found)
