"""State-space models with delay channels, what responses in time are computed from.

They are in the controllable canonical form, and from order 12 on in Schwarz's. A companion form holds a polynomial by
its coefficients, and those of (s + 1)^18 rounded to sixteen digits have roots up to 1.3, some of them in the right
half-plane. Schwarz's matrix is skew but for one damping at the end, so that without input the sum of the squares of the
states only falls; the states are orthogonal, so that an output is a sum in which nothing cancels, and rounding is lost
as the motion decays.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from loopbook.quasipolynomials.fraction import ZERO

if TYPE_CHECKING:
    from collections.abc import Sequence
    from fractions import Fraction

    from loopbook.quasipolynomials import DelayFraction

__all__ = ["ChannelModel", "companion_form", "schwarz_form", "state_space"]

HIGH_ORDER = 12  # from which on a companion matrix loses too many digits
BITS = 64  # for each power of the denominator


class ChannelModel(NamedTuple):
    """A state-space model with delay channels: what `System.state_space` returns.

    x' = A x + B1 u + B2 w,  y = C1 x + D11 u + D12 w,  z = C2 x + D21 u + D22 w,  and w_k(t) = z_k(t - delays[k]).
    The arrays are two-dimensional; `delays` is a list of fractions.
    """

    A: np.ndarray
    B1: np.ndarray
    B2: np.ndarray
    C1: np.ndarray
    C2: np.ndarray
    D11: np.ndarray
    D12: np.ndarray
    D21: np.ndarray
    D22: np.ndarray
    delays: list[Fraction]


def state_space(H: DelayFraction) -> ChannelModel:
    """Return a model of a proper fraction, with balanced states: what `System.state_space` returns."""
    from scipy.linalg import matrix_balance

    back, ahead = ({delay: part for delay, part in side.items() if delay} for side in (H.denominator, H.numerator))
    parts = [H.numerator.get(ZERO, ()), *back.values(), *ahead.values()]
    is_high = H.order >= HIGH_ORDER
    A, C, D = (schwarz_form if is_high else companion_form)(H.denominator[ZERO], parts)
    if len(A):
        with np.errstate(invalid="ignore"):  # SciPy makes integers of scales
            closed = A.copy()
            if is_high:
                closed[-1] += abs(C[1 : 1 + len(back)]).sum(axis=0)
            _, (scale, _) = matrix_balance(closed, permute=False, separate=True)
        A, C = A * scale / scale[:, None], C * scale
    # into the states and what is direct goes u - what comes back
    enters = np.r_[1.0, -np.ones(len(back)), np.zeros(len(ahead))]
    B, D = np.zeros((len(A), len(parts))), np.outer(D, enters)
    B[-1:] = enters / (scale[-1] if len(A) else 1)
    D[0, 1 + len(back) :] = 1.0
    return ChannelModel(
        A, B[:, :1], B[:, 1:], C[:1], C[1:], D[:1, :1], D[:1, 1:], D[1:, :1], D[1:, 1:], [*back, *ahead]
    )


def schwarz_form(below: Sequence[int], above: Sequence[Sequence[int]]) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Return A, C and D: ``above/below`` is ``D + C (s - A)^-1 B``, where the input B is 1 for the last state alone.

    Roots at zero are a chain of integrators behind the others, exact. Where the others are not all in the left
    half-plane, the form is that of a function of s less a shift.

    Arguments:
        below: coefficients, the lowest power first.
        above: of each numerator, not of a higher degree.
    Returns:
        A matrix, one with a row for each numerator, and an array with a number for each.
    Source: H. R. Schwarz, Zeitschrift fuer angewandte Mathematik und Physik 7 (1956) 473.

    >>> A, C, D = schwarz_form([2, 3, 1], [[2]])    # 2/(s**2 + 3*s + 2)
    >>> (C @ np.linalg.solve(1j * np.eye(2) - A, [0, 1])).round(12)
    array([0.2-0.6j])
    """
    from mpmath import mpf, sqrt, workprec

    n = len(below) - 1
    m = next(k for k, c in enumerate(below) if c)  # integrators
    A, C, direct = np.zeros((n, n)), np.zeros((len(above), n)), np.zeros(len(above))
    with workprec(BITS * (n + 4)):
        D = [mpf(c) / below[-1] for c in below[m:]]
        shift, speed, damping, couplings, basis = mpf(0), mpf(1), mpf(0), [], []
        if n > m:
            speed = 1 / max(abs(d / D[0]) ** (mpf(1) / i) for i, d in enumerate(D) if i)
            while not (found := _routh(_moved(D, shift))):
                shift = 2 * shift or speed / 4
            damping, couplings, basis = found
        # the equations are those of neighbours; the states' units make what leads there and back equal
        there = [*[speed] * (m if n > m else m - 1), *map(sqrt, couplings)]
        units = [mpf(1)] * n
        for k in range(n - 2, -1, -1):
            units[k] = units[k + 1] / there[k]
            A[k, k + 1] = there[k]
            A[k + 1, k] = -there[k] if k >= m else 0
        for k in range(m, n):
            A[k, k] = shift - (damping if k == n - 1 else 0)
        for number, row in enumerate(above):
            part = [mpf(c) / below[-1] for c in row] + [mpf(0)] * (n + 1 - len(row))
            direct[number] = part[n]
            rest = _moved([c - part[n] * d for c, d in zip(part[m:], D, strict=True)], shift)
            for k in range(n - m - 1, -1, -1):
                top = part[m + k] = rest[k]
                for i, c in enumerate(basis[k]):
                    rest[k - 2 * i] -= top * c
            C[number] = [c * unit for c, unit in zip(part, units, strict=False)]
    return A, C, direct


def companion_form(below: Sequence[int], above: Sequence[Sequence[int]]) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Return the same in the controllable canonical form, whose states are derivatives of one signal.

    >>> A, C, D = companion_form([2, 3, 1], [[2]])
    >>> A.tolist(), C.tolist(), D.tolist()
    ([[0.0, 1.0], [-2.0, -3.0]], [[2.0, 0.0]], [0.0])
    """
    n, leading = len(below) - 1, below[-1]
    rows = np.array([[c / leading for c in part] + [0.0] * (n + 1 - len(part)) for part in (below, *above)])
    own, parts = rows[0, :n], rows[1:]
    A = np.diag(np.ones(max(n - 1, 0)), 1)[:n, :n]
    if n:
        A[-1] = -own
    return A, parts[:, :n] - parts[:, n:] * own, parts[:, n]


def _moved(p, shift):
    """The coefficients of p(s + shift), the lowest power first."""
    p = list(p)
    if shift:
        for i in range(len(p)):
            for k in range(len(p) - 2, i - 1, -1):
                p[k] += shift * p[k + 1]
    return p


def _routh(p):
    """Damping and couplings, and each state's polynomial, of every second power from its highest on, by Routh's array.

    None where p has roots that are not in the left half-plane.
    """
    one, other = p[::-1][::2], p[::-1][1::2]
    damping, couplings, basis = other[0], [], []
    lead = damping
    while lead > 0:
        one, other = [c / lead for c in other], one
        basis.insert(0, one)
        other = [a - b for a, b in zip(other[1:], [*one[1:], 0], strict=False)]
        if not other:
            return damping, couplings, basis
        lead = other[0]
        couplings.insert(0, lead)
    return None
