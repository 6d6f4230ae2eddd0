"""A section of the cheat sheet: a table of texts and expressions."""

from dataclasses import dataclass

import sympy

from plainmath.latex import latex


@dataclass(frozen=True)
class Is:
    """A formula with what it is called, `left` in LaTeX, and what the library says that it is."""

    left: str
    right: sympy.Expr


@dataclass(frozen=True)
class Section:
    """A part of the sheet: a table whose cells are texts (with LaTeX between dollars), expressions, or an `Is`."""

    title: str
    chapter: str
    rows: tuple
    header: tuple = ()
    note: str = ""
    small: bool = False

    def cells(self):
        """The rows as texts."""
        return [tuple(shown(cell, flat=bool(self.header)) for cell in row) for row in self.rows]


def shown(cell, flat=False):
    """Return the text of a cell, its formula between dollars; `flat` keeps fractions on one line, as in tables."""
    match cell:
        case str():
            return cell
        case Is(left, right):
            return f"${left} = {latex(right, flat)}$"
    return f"${latex(cell, flat)}$"


def joined(*cells):
    """Return the text of several cells in one."""
    return ",  ".join(map(shown, cells))
