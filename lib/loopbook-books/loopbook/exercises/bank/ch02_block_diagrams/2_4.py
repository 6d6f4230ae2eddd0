"""Python beside the page of exercise 2.4."""

from exercisebook.parameters import written
from loopbook import diagrams as draw


def pole(value):
    """A pole as a formula, in four digits."""
    value = complex(value)
    if not value.imag:
        return f"${value.real:.4g}$"
    return f"${value.real:.4g} {'+' if value.imag > 0 else '-'} {abs(value.imag):.4g}j$"


def picture(m, D, K):
    """A sack of {m} on a platform, which stands on a spring of {K} and a damper of {D}."""
    parts = f"${written(m)}$ kg", f"${written(K)}$ N/m", f"${written(D)}$ N s/m"
    return draw.mass_spring_damper(*parts, "F", standing=True)
