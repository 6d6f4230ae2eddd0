"""Dead times that are multiples of one: the autocorrelation from a boundary value problem."""

from __future__ import annotations

import math
from fractions import Fraction

import numpy as np

from loopbook.ise.error import ErrorFraction, NotApplicableError

MOST_STATES = 48  # of a boundary value problem; beyond, quadrature is faster
MOST_DIGITS_LOST = 2e-11  # how far solutions in different units of time may lie apart
CERTAIN = 1e-12  # how near two of them lie where no third is needed


def by_boundary_values(fraction: ErrorFraction) -> float:
    """Dead times h, 2h ... m h: the autocorrelation of the response of 1/D from a boundary value problem.

    R(theta), the integral of x(t) x(t + theta) where D x = delta, is even, and D R = 0 for theta > 0, because x is zero
    before t = 0. On an interval of length h the functions phi_j(theta) = R(j h + theta) and
    psi_j(theta) = R((j + 1) h - theta), j < m, fulfil ordinary differential equations. At zero the odd derivatives of
    R vanish, but that of order 2n - 1 jumps to (-1)^n/2; the pieces are joined; in the middle phi_j is psi_j, mirrored.
    The integral of e^2 is N(s, z) N(-s, 1/z) applied to R at zero, s being the derivative and z the shift.

    A pole at zero that N cancels makes W in place of R, with R as its second derivative (but for the sign): that is D
    with two more powers of s, and values that are zero at zero.
    """
    fraction.need_retarded()
    # rounding comes out otherwise in another unit of time, so that it is seen; but two can agree by chance
    one = _from_autocorrelation(fraction, fraction.mean_speed)
    for factor in (1.6, 0.7):
        other = _from_autocorrelation(fraction, factor * fraction.mean_speed)
        if not abs(one - other) <= MOST_DIGITS_LOST * one:
            raise NotApplicableError(f"rounding leaves {one:.12g} or {other:.12g}")
        if abs(one - other) <= CERTAIN * one:
            break
    return one


def _from_autocorrelation(fraction: ErrorFraction, speed: float) -> float:
    """The integral from the boundary value problem, solved with 1/speed as the unit of time."""
    from scipy.linalg import expm

    delays = [d for d in (*fraction.N, *fraction.D) if d]
    unit = Fraction(math.gcd(*(d.numerator for d in delays)) or 1, math.lcm(*(d.denominator for d in delays)))
    m = int(max(delays, default=1) / unit)
    twice = 2 * fraction.pole
    order = fraction.order + twice
    states = 2 * m * order
    if states > MOST_STATES:
        raise NotApplicableError(f"it has {states} states, more than {MOST_STATES}")
    h = float(unit) * speed
    above, above_delays, below, below_delays = fraction.arrays(speed)
    N, D = np.zeros((m + 1, above.shape[1])), np.zeros((m + 1, order))
    N[np.rint(above_delays / h).astype(int)] = above
    D[np.rint(below_delays / h).astype(int), twice:] = below[:, :-1]

    def place(j):  # of phi_j, and of psi_j m places later
        return slice(j * order, (j + 1) * order)

    M = np.kron(np.eye(2 * m), np.diag(np.ones(order - 1), 1))
    mirror = (-1.0) ** np.arange(order)
    for j in range(m):
        for i in range(m + 1):
            forward, back = (j - i, m + j - i) if i <= j else (m + i - j - 1, i - j - 1)
            M[(j + 1) * order - 1, place(forward)] -= D[i]
            M[(m + j + 1) * order - 1, place(back)] -= D[i] * mirror * (-1) ** order

    # the derivatives at zero, as rows that multiply the state
    highest = twice + 2 * fraction.order - 1
    derivatives = [np.eye(1, states)]
    for _ in range(highest):
        derivatives.append(derivatives[-1] @ M)
    at_zero = [*range(twice), *range(twice + 1, highest + 1, 2)]
    start = np.vstack([derivatives[k] for k in at_zero])
    value = np.zeros(states)
    value[len(at_zero) - 1] = (-1) ** (fraction.pole + fraction.order) / 2
    joined = np.zeros(((m - 1) * order, states))
    for j in range(m - 1):
        joined[place(j), place(m + j)] = np.diag(mirror)
        joined[place(j), place(j + 1)] = -np.eye(order)
    middle = np.hstack([np.eye(m * order), -np.kron(np.eye(m), np.diag(mirror))])

    # left @ Y(0) + right @ Y(h/2) = 0, from short steps, which are joined without forming a large exponential
    doublings = max(0, math.ceil(math.log2(abs(M).sum(axis=1).max() * h / 2)))
    left, right = -expm(M * (h / 2 / 2**doublings)), np.eye(states)
    for _ in range(doublings):
        combination = np.linalg.qr(np.vstack([right, left]), mode="complete")[0][:, states:].T
        left, right = combination[:, :states] @ left, combination[:, states:] @ right
    nothing = np.zeros((m * order, states))
    system = np.block([[np.vstack([start, joined]), nothing], [left, right], [nothing, middle]])
    Y = np.linalg.solve(system, np.concatenate([value, np.zeros(states)]))[:states]

    mirrored, total = N * (-1.0) ** np.arange(N.shape[1]), 0.0
    for shift in range(m + 1):
        product = sum(np.convolve(N[q + shift], mirrored[q]) for q in range(m + 1 - shift))
        if not product.any():
            continue
        # R at shift*h: the beginning of phi, or the one of the last psi, where the direction is the other one
        row = np.zeros(states)
        row[(shift if shift < m else 2 * m - 1) * order] = 1
        direction = -1.0 if shift < m else 1.0
        for k, c in enumerate(product):
            total += (1 if shift == 0 else 2) * c * direction**k * (row @ Y)
            row = row @ M
    return float(total) * speed
