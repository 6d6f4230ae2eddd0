"""The formulas of the cheat sheet that no function of the library returns with symbols; a test compares each with one.

They are the rule T3 for zeros, what a relay tells, the margins of a dead time behind an integrator, and the closed form
of the integral of the squared error in the symbols of `loopbook.integrals.pi_first_order`.
"""

from sympy import atan, pi, sqrt, tan

from cheat_sheet.letters import T0, A, L, P, Q, T, Ti, a, d, k, omega, q, rho, short, sigma, theta, x
from loopbook import s

ZERO_T3 = short / T / ((short - T0) * s + 1)
RELAY = 4 * d / (pi * A)
GAIN_MARGIN, PHASE_MARGIN, MORE_DEAD_TIME = pi / (2 * a * theta), pi / 2 - a * theta, pi / (2 * a) - theta

ISE = Ti / (2 * rho) * (P * tan(x) / omega - Q * q / sigma)
RHO = sqrt(Ti**2 * (k**2 - 1) ** 2 + 4 * k**2 * T**2)
TWICE_X = omega * theta + atan(omega * T) + atan(1 / (omega * Ti))
OMEGA, SIGMA = (sqrt((rho + sign * Ti * (k**2 - 1)) / (2 * Ti * T**2)) for sign in (1, -1))
QUOTIENT = (1 - L) / (1 + L)
SERVO_P, SERVO_Q = 1 + omega**2 * T**2, 1 - sigma**2 * T**2
