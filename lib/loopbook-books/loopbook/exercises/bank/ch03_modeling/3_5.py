"""Python beside the page of exercise 3.5."""

import itertools

import sympy

from exercisebook.parameters import written
from loopbook import diagrams as draw

LETTERS = sympy.symbols("m_1 m_2 J r T g", positive=True)
G = sympy.Rational("9.81")


def in_numbers(formula, *values):
    """A formula with the values of m_1, m_2, J, r and T."""
    return sympy.sympify(formula).subs(dict(zip(LETTERS, (*values, G), strict=True)))


def of_three_balances():
    """The acceleration as a machine finds it, with the tensions of the rope."""
    m_1, m_2, J, r, T, g = LETTERS
    a, first, second = sympy.symbols("a F_1 F_2")
    balances = [first - m_1 * g - m_1 * a, m_2 * g - second - m_2 * a, T - first * r + second * r - J * a / r]
    return sympy.solve(balances, [a, first, second])[a]


def differ(T, J, r, m_1, m_2):
    """Whether the masses, and the accelerations, that follow from the usual mistakes are all different."""
    moved = m_1 + m_2 + J / r**2
    masses = [m_1 + m_2, m_1 - m_2 + J / r**2, J + (m_1 + m_2) * r**2]
    if not masses[1]:
        return False
    force, *forces = [T / r - mass * G for mass in (m_1 - m_2, m_1, m_1 + m_2, m_2 - m_1)]
    forces.append(-T / r - (m_1 - m_2) * G)
    accelerations = [*(one / moved for one in forces), *(force / mass for mass in (*masses[:2], moved * r))]
    pairs = itertools.chain(itertools.combinations(masses, 2), itertools.combinations(accelerations, 2))
    return all(abs(one - other) > abs(other) / 40 for one, other in pairs)


def picture(m_1, m_2, J, r):
    """A rope over a drum of {J} with the radius {r}; on its left hangs the cabin of {m_1}, on its right the
    counterweight of {m_2}. The torque T lifts the cabin."""
    cabin, weight = f"${written(m_1)}$ kg", f"${written(m_2)}$ kg"
    return draw.hoist(cabin, weight, f"${written(J)}$ kg m²", f"${written(r)}$ m")
