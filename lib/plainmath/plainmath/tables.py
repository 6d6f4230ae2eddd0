"""Answers that a reader can read: quantities with their names and units, and tables of them, rounded once.

>>> quantities({"gain margin": 2.0973, "phase margin [°]": 28.86}, Ms=3.1416)
gain margin   2.10
phase margin  28.9 °
Ms            3.14
>>> table(["Kp", "Ti [s]"], {"Good Gain": [1.2, 900], "Skogestad": [1.04, 1000.4]}, of="method")
method     Kp    Ti [s]
Good Gain  1.20  900
Skogestad  1.04  1000
"""

from __future__ import annotations

import html
import math
import numbers
import re
from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from typing import Any

import sympy

from plainmath.latex import GREEK, latex

__all__ = [
    "Table", "aligned", "is_symbol", "marked", "plain_words", "quantities", "rounded", "symbol", "table", "typeset",
]  # fmt: skip

_LEFT = 'style="text-align:left"'  # JupyterLab would centre the heads and align texts to the right
_LARGEST_DENOMINATOR = 12  # a fraction with a larger one says less than a decimal number
_RIGHT = 'style="text-align:right"'
#: A number that is off from a whole one by this share has come to it by a computation, which ends otherwise elsewhere.
_ROUNDING = 1e-12


@dataclass(frozen=True)
class Table:
    """What a notebook shows as a table.

    Attributes:
        head: the names of the columns; empty where the rows are quantities, whose first cell is the name.
        rows: of values, which are rounded when they are shown.
        digits: significant digits of the numbers.
    """

    head: tuple[str, ...]
    rows: tuple[tuple[Any, ...], ...]
    digits: int = 3

    def _written(self, tex):
        return [tuple(_written(value, self.digits, tex) for value in row) for row in self.rows]

    def __repr__(self) -> str:
        return "\n".join(aligned([*([self.head] if self.head else []), *self._written(tex=False)]))

    def _repr_html_(self):
        head = "".join(f"<th {_LEFT}>{_label(name)}</th>" for name in self.head)
        lines = []
        for row, written in zip(self.rows, self._written(tex=True), strict=True):
            first, *cells = written
            sides = [_RIGHT if self.head and _is_number(value) else _LEFT for value in row[1:]]
            told = [f"<td {side}>{marked(cell)}</td>" for side, cell in zip(sides, cells, strict=True)]
            lines.append(f'<tr><th {_LEFT} scope="row">{_label(first)}</th>{"".join(told)}</tr>')
        above = [f"<thead><tr>{head}</tr></thead>"] if self.head else []
        return "\n".join(['<table class="loopbook-table">', *above, "<tbody>", *lines, "</tbody>", "</table>"])


def quantities(named: Mapping[str, Any] | None = None, /, *, digits: int = 3, **symbols: Any) -> Table:
    """Return quantities under each other, each with its name and unit.

    Arguments:
        named: the value of each, by its name and, in square brackets, its unit: ``{"rise time [s]": 3.21}``.
        digits: significant digits; what is before the decimal point is never rounded.
        symbols: more of them by their symbols, where they have no unit.
    Returns:
        A table, as text and as HTML. A truth value is shown as yes or no, a formula is typeset, several values have
        commas between them, and an exact fraction stays one if its denominator is small.
    Raises:
        ValueError: if there is nothing to show.

    >>> quantities({"settling time [min]": 12.345, "is stable": True}, K=sympy.Rational(1, 3))
    settling time  12.3 min
    is stable      yes
    K              1/3
    """
    rows = []
    for name, value in {**(named or {}), **symbols}.items():
        label, unit = _with_unit(str(name))
        rows.append((label, _Quantity([*value] if isinstance(value, Iterator) else value, unit)))
    if not rows:
        raise ValueError("no quantity to show: expected at least one, as quantities(K=2)")
    return Table((), tuple(rows), digits)


def table(
    columns: Sequence[str],
    rows: Mapping[Any, Any] | Iterable[Sequence[Any]],
    *,
    of: str = "",
    digits: int = 3,
) -> Table:
    """Return a table.

    Arguments:
        columns: the names of the columns, with units in square brackets: ``["Kp", "Ti [s]"]``.
        rows: the values of each row by the row's name; where there is one column, each may be a single value. Or,
            without names, a list of rows.
        of: what the names of the rows are, for the head of their column.
        digits: significant digits; what is before the decimal point is never rounded.
    Returns:
        A table, as text and as HTML.
    Raises:
        ValueError: if there is no row, or a row has not one value for each column.

    >>> table(["overshoot [%]"], {"PI": 12.34, "PID": 5}, of="controller")
    controller  overshoot [%]
    PI          12.3
    PID         5
    >>> table(["t [s]", "y"], [(0, 0.0), (1, 0.6321)])
    t [s]  y
    0      0
    1      0.632
    """
    named = isinstance(rows, Mapping)
    if named:
        lines = [(f"{x:g}" if isinstance(x, float) else x, *_row(values)) for x, values in rows.items()]
    else:
        lines = [(*_row(values),) for values in rows]
    head = (of, *columns) if named else tuple(columns)
    if not lines:
        raise ValueError("a table without rows: expected at least one")
    for line in lines:
        if len(line) != len(head):
            of_row = f"the row {line[0]!r}" if named else f"the row {line!r}"
            raise ValueError(
                f"{of_row} has {len(line) - named} values, and there are {len(columns)} columns: expected one for each"
            )
    return Table(head, tuple(lines), digits)


@dataclass(frozen=True)
class _Quantity:
    """A value with its unit."""

    value: Any
    unit: str


def _row(values):
    """The values of a row; a single one is a row of one."""
    if isinstance(values, str | sympy.Basic) or not isinstance(values, Iterable):
        return [values]
    return [[*value] if isinstance(value, Iterator) else value for value in values]


def _with_unit(name):
    """A name without its unit, and the unit.

    >>> _with_unit("rise time [s]"), _with_unit("Ms")
    (('rise time', 's'), ('Ms', ''))
    """
    found = re.fullmatch(r"(.*\S) \[([^\[\]]+)\]", name)
    return found.groups() if found else (name, "")


def _written(value, digits, tex):
    """A value as text: a number rounded, a formula typeset if `tex`, several values with commas between them."""
    if isinstance(value, _Quantity):
        return f"{_written(value.value, digits, tex)} {value.unit}".strip()
    if value is None:
        return "–"
    if isinstance(value, str):
        return value
    if isinstance(value, bool) or type(value).__name__ == "bool" or isinstance(value, sympy.logic.boolalg.BooleanAtom):
        return "yes" if value else "no"
    if isinstance(value, sympy.Basic):
        if value.is_Float or value in (sympy.oo, -sympy.oo) or (value.is_Rational and value.q > _LARGEST_DENOMINATOR):
            return rounded(float(value), digits)
        return str(value) if value.is_Integer or not tex else typeset(value)
    if isinstance(value, numbers.Integral):
        return str(value)
    if isinstance(value, numbers.Real):
        return rounded(float(value), digits)
    if isinstance(value, numbers.Complex):
        sign = "+" if value.imag >= 0 else "-"
        return f"{rounded(value.real, digits)} {sign} {rounded(abs(value.imag), digits)}j"
    if isinstance(value, Iterable) and not hasattr(value, "_fields"):  # a named tuple says more by itself
        return ", ".join(_written(item, digits, tex) for item in value) or "none"
    return str(value)


def _is_number(value):
    return isinstance(value, numbers.Number) and not isinstance(value, bool)


def rounded(value: float, digits: int = 3) -> str:
    """Return a number with so many significant digits; what is before the decimal point is never rounded.

    Arguments:
        value: any float.
        digits: significant digits, 1 or more.
    Returns:
        Text, with a power of ten where the number is above a million or below a ten-thousandth.

    >>> rounded(2 / 3), rounded(1236.3), rounded(25.0), rounded(0.0), rounded(1.2e-7), rounded(-math.inf)
    ('0.667', '1236', '25', '0', '1.2e-7', '-∞')
    >>> rounded(10.999999999999998), rounded(10.99999)
    ('11', '11.0')
    """
    if math.isnan(value):
        return "not a number"
    if math.isinf(value):
        return "∞" if value > 0 else "-∞"
    if value == 0:
        return "0"
    if abs(value - round(value)) <= _ROUNDING * abs(value) and abs(value) < 10**6:
        return f"{value:.0f}"
    size = math.floor(math.log10(abs(float(f"{value:.{digits - 1}e}"))))
    if not -4 <= size < 6:
        mantissa, _, exponent = f"{value:.{digits - 1}e}".partition("e")
        return f"{mantissa.rstrip('0').rstrip('.')}e{int(exponent)}"
    return f"{value:.{max(0, digits - 1 - size)}f}"


def aligned(rows: Iterable[Sequence[str]]) -> list[str]:
    """Return rows of texts as lines, with the columns below each other.

    >>> aligned([("K", "2"), ("delay", "10")])
    ['K      2', 'delay  10']
    """
    rows = [*rows]
    widths = [max(map(len, column)) for column in zip(*rows, strict=True)]
    return ["  ".join(cell.ljust(width) for cell, width in zip(row, widths, strict=True)).rstrip() for row in rows]


# ---------------------------------------------------------------------------------------------------------- typesetting


def typeset(expression: Any) -> str:
    """Return a formula between dollar signs; a symbol whose name is a word, such as a unit, stands upright.

    >>> from plainmath.expressions import parse
    >>> typeset(parse("K/(T*s + 1)"))
    '$\\\\displaystyle \\\\dfrac{K}{T s + 1}$'
    """
    return rf"$\displaystyle {latex(expression)}$"


def is_symbol(name: str) -> bool:
    """Whether a name is that of a symbol, K or y_SP_1 or tau, which needs no other label.

    >>> is_symbol("y_SP_1"), is_symbol("tau"), is_symbol("T_i_in_minutes"), is_symbol("2")
    (True, True, False, False)
    """
    letter, *indices = name.split("_")
    is_letter = (len(letter) == 1 and letter.isalpha()) or letter in GREEK
    return is_letter and len(indices) <= 2 and all(len(index) <= 3 for index in indices)


def symbol(name: str) -> str:
    """Return a name as a formula where it is a symbol, K or T_1 or tau, and as words otherwise.

    >>> symbol("T_1"), symbol("y_SP_1"), symbol("time_to_rest")
    ('$T_{1}$', '$y_{SP,1}$', 'time to rest')
    """
    return f"${latex(sympy.Symbol(name))}$" if is_symbol(name) else name.replace("_", " ")


def plain_words(text: str) -> str:
    r"""Return a label without its LaTeX commands, for a description in words.

    >>> plain_words(r"$F_{\mathrm{in}}(t)$ after $\tau$")
    'F_in(t) after tau'
    >>> plain_words(r"$\dot{h}_{SP}$, $\frac{1}{T s}$")
    'dh_SP/dt, (1)/(T s)'
    """
    text = re.sub(r"\\d?frac\{([^{}]*)\}\{([^{}]*)\}", r"(\1)/(\2)", text)
    text = re.sub(r"\\dot\{(\w+)\}(_\w+|_\{\w+\})?", r"d\1\2/dt", text)
    return re.sub(r"\\(mathrm|mathit|left|right)\b|[$\\{}]", "", text)


def marked(text: str) -> str:
    """Return a text as HTML; what is between dollar signs stays a formula.

    >>> marked("K < 1, $T < 2$")
    'K &lt; 1, $T &lt; 2$'
    """
    pieces = re.split(r"(\$[^$]+\$)", text)
    return "".join(
        _formula(piece) if piece[:1] == "$" and piece[1:] else html.escape(piece, quote=False) for piece in pieces
    )


def _formula(latex):
    # an older MathJax breaks lines as soon as it can, unless the cell has the width that the formula needs
    room = min(16, 1 + 0.2 * len(re.sub(r"\\[a-z]+|[{}]", "", latex)))
    formula = html.escape(latex, quote=False)
    return f'<span style="display: inline-block; min-width: {room:.0f}em">{formula}</span>' if room > 6 else formula


def _label(name):
    """A name with or without unit, as HTML; Kp and Ti, as they are written in code, are the symbols that books print.

    >>> _label("Ti [s]"), _label("gain margin"), _label("T_1")
    ('$T_{i}$ [s]', 'gain margin', '$T_{1}$')
    """
    name, unit = _with_unit(name)
    written = re.sub(r"^([A-Z])([a-z])$", r"\1_\2", name)
    told = symbol(written) if is_symbol(written) and name else name
    return marked(told + (f" [{unit}]" if unit else ""))
