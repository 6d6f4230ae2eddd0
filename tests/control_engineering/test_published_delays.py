"""What others have published on systems with dead times, and closed formulas, beside what comes out here."""

import math

import pytest
import sympy

import loopbook as lb
from loopbook import s

HALF = sympy.Rational(1, 2)


def test_the_hopf_points_of_two_coupled_neurons():
    """Demonstration "neuron" of DDE-BIFTOOL, after L. P. Shayer and S. A. Campbell (2000): a21 and omega."""
    alone = (s + HALF + sympy.exp(-3 * HALF * s)) ** 2
    Ku, Pu = lb.ultimate(-sympy.exp(-2 * s / 5) / alone)
    assert Ku == pytest.approx(0.8071, abs=5e-5)
    assert 2 * math.pi / Pu == pytest.approx(0.7820, abs=5e-5)


@pytest.mark.parametrize(("a", "b"), [(1, 2), (HALF, 3), (-HALF, 1)])
def test_the_longest_dead_time_of_one_state(a, b):
    """N. D. Hayes (1950): x' = -a x - b x(t - tau) is stable up to tau = arccos(-a/b)/sqrt(b² - a²)."""
    longest = float(sympy.acos(-a / sympy.Integer(b)) / sympy.sqrt(b**2 - a**2))
    loop = lb.Loop(b / (s + a), 1)
    assert loop.margins().delay_margin == pytest.approx(longest, rel=1e-9)


def test_the_rightmost_pole_of_an_integrator_with_dead_time():
    """R. M. Corless and others (1996), on the W function: the roots of s + exp(-s) are its branches at -1."""
    first, _ = lb.Loop(sympy.exp(-s) / s, 1).poles(2)
    assert first == pytest.approx(complex(sympy.LambertW(-1).evalf()), rel=1e-12)
