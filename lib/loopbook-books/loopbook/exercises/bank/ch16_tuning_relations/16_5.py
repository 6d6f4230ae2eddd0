"""Two questions put to the formulas of exercise 16.5."""

import sympy


def by_fault(*formulas):
    """The letters of those that are sound, of those that depend on the unit of time, and of those without a limit."""
    sound, units, limit = [], [], []
    for letter, one, unit in zip("ABCD", formulas, (1, 1, 60, 60), strict=True):  # gains stay, times have 60 minutes
        value = sympy.lambdify(sympy.symbols("K tau theta tau_c"), sympy.sympify(one))
        if abs(value(2, 180, 42, 24) / (unit * value(2, 3, 0.7, 0.4)) - 1) > 1e-9:
            units.append(letter)
        elif abs(value(2e8, 1e8, 0.7, 0.4) / value(2e7, 1e7, 0.7, 0.4) - 1) > 0.1:
            limit.append(letter)
        else:
            sound.append(letter)
    return sound, units, limit
