"""Stability of a feedback loop with dead time, without approximation.

The closed loop of L(s) = N(s)/D(s) exp(-delay*s) has the characteristic equation D(s) + N(s) exp(-delay*s) = 0. It has
infinitely many roots, but they enter the right half-plane only across the imaginary axis, at frequencies where
abs(D) = abs(N), and these are roots of a polynomial. (K. Walton and J. E. Marshall, IEE Proceedings D 134, 1987)
"""

import math

import mpmath
import sympy

from loopbook.expressions import function_of, s
from loopbook.transfer import polynomials

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
    N, D, delay = polynomials(loop)
    limit = StabilityLimitError(f"the closed loop of {loop} has poles on the imaginary axis")
    count, on_axis = 0, []
    for p, n in _roots(D + N):
        if abs(sympy.re(p)) <= 1e-15 * abs(p):
            on_axis.append(p)
        elif sympy.re(p) > 0:
            count += n
    if on_axis and (not delay or 0 in on_axis):
        raise limit
    for crossing, period, direction in _crossings(N, D):
        turns = (float(delay) - crossing) / period
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
    N, D, delay = polynomials(loop)
    delay = float(delay)
    ahead = [
        crossing + period * max(0, math.ceil((delay - crossing) / period)) - delay
        for crossing, period, _ in _crossings(N, D)
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
    process = function_of(s, process)
    if (found := _lowest_stable_range(process)) is None:
        hint = ", but a negative one does" if _lowest_stable_range(-process) else ""
        raise ValueError(f"no positive gain makes the closed loop of {process} stable{hint}")
    gain, frequency = found
    return gain, 2 * math.pi / frequency if frequency else math.inf


def _lowest_stable_range(process):
    """The upper end of the lowest range of gains for which the loop is stable, and its frequency; None without such."""

    def stable(gain):
        return is_stable(sympy.Rational(gain) * process)

    lower = 0.0
    for gain, frequency in [*_limiting_gains(process), (math.inf, math.inf)]:
        if stable(2 * lower + 1 if gain == math.inf else (lower + gain) / 2):
            if gain < math.inf and (not stable(0.999 * gain) or stable(1.001 * gain)):
                raise ValueError(f"the limit of stability of {process} was not found near the gain {gain:g}")
            return gain, frequency
        lower = gain
    return None


def _roots(polynomial):
    """The roots of a polynomial with how often each occurs, to 30 digits."""
    for factor, n in polynomial.sqf_list()[1]:
        # a scale of frequency at which the coefficients are of one size
        first, *_, last = factor.all_coeffs()
        scale = sympy.Rational(10) ** round(math.log10(abs(last / first)) / factor.degree()) if last else sympy.S.One
        scaled = sympy.Poly(factor.as_expr().subs(s, scale * s), s)
        try:
            roots = scaled.nroots(n=30, maxsteps=1000)
        except mpmath.NoConvergence:
            raise ValueError(f"the roots of {polynomial.as_expr()} are too far apart to be found") from None
        yield from ((scale * root, n) for root in roots)


def _crossings(N, D):
    """Where poles cross the imaginary axis: (first dead time, period to the next, direction: 1 to the right)."""
    square = sympy.Symbol("square")

    def power(polynomial):  # abs(polynomial)^2 on the imaginary axis, in the square of the frequency
        even = sympy.Poly(polynomial.as_expr() * polynomial.as_expr().subs(s, -s), s)
        return sympy.Poly({(n // 2,): c * (-1) ** (n // 2) for (n,), c in even.terms()}, square)

    difference = power(D) - power(N)
    for root, n in difference.real_roots(multiple=False) if difference.degree() > 0 else []:
        if root <= 0 or n % 2 == 0:  # a pole that touches the axis comes back from it
            continue
        frequency = math.sqrt(root.evalf(30))
        there = sympy.I * sympy.Float(frequency, 30)
        ratio = complex((-N.as_expr() / D.as_expr()).subs(s, there).evalf(30))
        angle = math.atan2(ratio.imag, ratio.real)
        angle = 0.0 if abs(angle) < CLOSE else angle % (2 * math.pi)
        rising = sympy.N(difference.diff((square, n)).eval(root), 30) > 0
        yield angle / frequency, 2 * math.pi / frequency, 1 if rising else -1


def _limiting_gains(process):
    """The gains at which poles lie on the imaginary axis, with their frequencies, the lowest gains first."""
    import numpy
    from scipy.optimize import brentq

    N, D, delay = polynomials(process)
    delay = float(delay)
    N, D = (numpy.poly1d([float(c) for c in polynomial.all_coeffs()]) for polynomial in (N, D))

    def response(w):
        return N(1j * w) / D(1j * w) * numpy.exp(-1j * w * delay)

    roots = [*N.roots, *D.roots]
    corners = [abs(root) for root in roots if abs(root) > 0] or [1 / delay if delay else 1.0]
    low, high = min(corners) / 1000, max(corners) * 1000
    grids = [numpy.geomspace(low, high, 20_000)]
    # near a lightly damped root the phase turns within a small range
    grids += [root.imag + abs(root.real) * numpy.linspace(-50, 50, 2000) for root in roots if root.imag > 0]
    if delay:
        # the phase turns with the dead time, and beyond the corners each turn needs more gain than the last
        end = max(corners) + 6 * math.pi / delay
        grids.append(numpy.linspace(0, end, min(1_000_000, 20_000 + math.ceil(10 * delay * end))))
    grid = numpy.unique(numpy.concatenate(grids))
    grid = grid[grid > 0]
    with numpy.errstate(divide="ignore", invalid="ignore"):  # at a pole on the axis, which no gain moves there
        imaginary = response(grid).imag
    found = []
    for n in numpy.flatnonzero(imaginary[:-1] * imaginary[1:] < 0):
        w = brentq(lambda w: response(w).imag, grid[n], grid[n + 1], xtol=1e-15 * grid[n], rtol=1e-14)
        if (real := response(w).real) < 0:
            found.append((float(-1 / real), float(w)))
    if (static := D(0) and N(0) / D(0)) < 0:
        found.append((float(-1 / static), 0.0))
    return sorted(found)
