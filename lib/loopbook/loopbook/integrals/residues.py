"""The residue method in numbers, for one dead time and denominators of any order, of many errors at once.

Each integral comes with a bound of the digits that it loses where zeros lie close together, or the loop near its limit.
"""

from __future__ import annotations

import functools

import numpy as np
from numpy.polynomial.polynomial import polyval

from loopbook.integrals.error import ErrorFraction, NotApplicableError
from loopbook.integrals.residue_method import both_residues

__all__ = ["by_residues", "sums_of_residues"]

ROUNDING = 2.3e-16
MOST_DIGITS_LOST = 1e-11  # the relative error that a sum of residues may have

_value = functools.partial(polyval, tensor=False)  # of polynomials, one for each point, the lowest power first


def by_residues(fraction: ErrorFraction) -> float:
    """One dead time: minus the sum of Re F(p) over the zeros p of Delta, one of each p and -p (see `ResidueMethod`)."""
    if len({delay for delay in (*fraction.N, *fraction.D) if delay}) > 1:
        raise NotApplicableError("there are different dead times")
    if fraction.pole:
        raise NotApplicableError("a pole at zero is cancelled by dead times only")
    speed = fraction.speed
    N, D = fraction.sums(speed)
    value = float(sums_of_residues(N.coefficients, N.delays, D.coefficients, D.delays)[0])
    if np.isnan(value):
        raise NotApplicableError("the residues lose too many digits")
    return value * speed


def sums_of_residues(
    above: np.ndarray, above_delays: np.ndarray, below: np.ndarray, below_delays: np.ndarray
) -> np.ndarray:
    """Return the integrals of e(t)^2 for stable errors; nan where there are several dead times or digits are lost.

    Arguments:
        above, below: coefficients of numerators and denominators, arrays [part, power, point].
        above_delays, below_delays: the dead times, arrays [part, point].
    """
    used = [(delays > 0) & part.any(axis=1) for part, delays in ((above, above_delays), (below, below_delays))]
    every = np.concatenate([np.where(u, d, 0) for u, d in zip(used, (above_delays, below_delays), strict=True)])
    delay = every.max(axis=0)
    fits = ((every == 0) | (every == delay)).all(axis=0)
    (A, C), (B, D) = (
        [(part * chosen[:, None]).sum(axis=0) for chosen in (~late, late)]
        for part, late in ((below, used[1]), (above, used[0]))
    )
    order = len(A) - 1
    if not order:
        return np.full(len(delay), np.nan)
    with np.errstate(all="ignore"):
        A, B, C, D = (part / A[-1] for part in (A, B, C, D))
        Delta, sizes = np.zeros((2, order + 1, len(delay)))
        for part, sign in ((A, 1), (C, -1)):
            for i in range(order + 1):
                for j in range(i % 2, order + 1, 2):
                    product = part[i] * part[j]
                    Delta[(i + j) // 2] += sign * (-1) ** j * product
                    sizes[(i + j) // 2] += abs(product)
        x, radius, slope = _zeros(Delta, sizes)
        # a zero as uncertain as that could lie on either side of the axis, where the formula is another one
        fits &= (np.isfinite(x) & (radius <= 1e-3 * abs(x))).all(axis=0)
        x = np.where(fits, x, 1.0)
        p = np.sqrt(x)
        at_A, at_B, at_C, at_D = (_value(p, part) for part in (A, B, C, D))
        z = np.exp(-delay * p)
        close = at_A + at_C * z
        # dDelta/ds = 2 s dDelta/d(s^2)
        shares = both_residues(at_A, at_B, at_C, at_D, _value(-p, B), _value(-p, D), z) / (close * 2 * p * slope)
        total = -shares.real.sum(axis=0)
        # what polynomials lose where their terms cancel is seen from the sizes of the terms
        terms = _value(abs(p), abs(A)) + _value(abs(p), abs(C)) * abs(z)
        near = terms * (1 + abs(p) * delay) / abs(close)
        sensitivity = radius / abs(x) / (4 * order**2 * ROUNDING)
        lost = 4e-16 * (abs(shares) * ((1 + sensitivity) ** 2 + near * (1 + sensitivity))).sum(axis=0)
        return np.where(fits & np.isfinite(total) & (lost <= MOST_DIGITS_LOST * total), total, np.nan)


def _zeros(coefficients, sizes):
    """The zeros of polynomials, radii of discs in which there is one, and the slopes there: arrays [zero, point].

    The discs are those of Smith (1970), after Gerschgorin; `sizes` are those of the terms of each coefficient, by which
    rounding enlarges them.
    """
    n, points = len(coefficients) - 1, coefficients.shape[1]
    unit = abs(coefficients[0] / coefficients[-1]) ** (1 / n)
    unit = np.where((unit > 0) & np.isfinite(unit), unit, 1.0)  # where the product of the zeros is 1
    powers = np.arange(n + 1)[:, None]
    scaled = coefficients / coefficients[-1] * unit ** (powers - n)
    sizes = sizes / abs(coefficients[-1]) * unit ** (powers - n)
    scaled = np.where(np.isfinite(scaled).all(axis=0), scaled, (powers == n) * 1.0 + (powers == 0))
    companion = np.zeros((points, n, n))
    companion[:, np.arange(1, n), np.arange(n - 1)] = 1
    companion[:, :, -1] = -scaled[:-1].T
    x = np.linalg.eigvals(companion).T.astype(complex)
    step = _value(x, scaled) / _value(x, scaled[1:] * powers[1:])
    x = np.where(abs(step) < 1e-6 * abs(x), x - step, x)
    apart = x[:, None] - x[None]
    apart[np.arange(n), np.arange(n)] = 1
    slope = apart.prod(axis=1)
    left = abs(_value(x, scaled)) + 4 * n * ROUNDING * _value(abs(x), sizes)
    return x * unit, n * left / abs(slope) * unit, slope * coefficients[-1] * unit ** (n - 1)
