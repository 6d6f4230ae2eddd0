"""What several pages of chapter 3 call."""

import sympy


def in_numbers(formula, **values):
    """A formula with numbers for its symbols."""
    formula = sympy.sympify(formula)
    return formula.subs({symbol: values[symbol.name] for symbol in formula.free_symbols})
