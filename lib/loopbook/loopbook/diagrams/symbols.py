"""Tables of symbols, each with its name below it."""

from __future__ import annotations

import copy
from collections.abc import Mapping, Sequence
from typing import TYPE_CHECKING

from loopbook.diagrams.conductors import draw_pipe
from loopbook.diagrams.drawing import INCHES, WIDEST, Drawing, text_size
from loopbook.diagrams.equipment import Equipment

if TYPE_CHECKING:
    from loopbook.diagrams.equipment import Equipment
    from loopbook.figures import Picture

PIECE, UPRIGHT = 0.5, 0.25  # of pipe, at the sides and above or below
SIZE = 10  # of the names
LINE = 0.4  # from one line of a name to the next
GAP = 0.3


def symbol_table(
    symbols: Mapping[str, Equipment] | Sequence[Equipment], title: str | None = None, columns: int = 4
) -> Picture:
    """Draw a table of symbols, each with its name below it.

    Arguments:
        symbols: ``{name: symbol}``, the symbols as `instrumentation_diagram` takes them; or a list of symbols, whose
            names are then their own words.
        title: written above the table.
        columns: how many symbols stand in a row.
    Returns:
        A `Picture`, which a notebook shows as the value of a cell.
    Raises:
        ValueError: for a table without symbols, for what is not a symbol of a plant, or fewer columns than one.

    >>> from loopbook.diagrams import pump, valve
    >>> symbol_table({"a valve": valve(), "a pump": pump()})
    <symbols: a valve, a pump>
    >>> symbol_table([valve(kind=kind) for kind in ("ball", "check")])
    <symbols: ball valve, check valve>
    """
    if not isinstance(symbols, dict):
        symbols = {getattr(symbol, "words", symbol): symbol for symbol in symbols}
    if not symbols:
        raise ValueError("a table of symbols needs one symbol or more")
    for name, symbol in symbols.items():
        if not isinstance(symbol, Equipment):
            raise ValueError(f"{name} is {symbol!r}, which is not a symbol of a plant")
    if not isinstance(columns, int) or columns < 1:
        raise ValueError(f"a table has one column or more, not {columns!r}")
    drawing, top = Drawing(), 0.0
    cells = [(_placed(symbol), name) for name, symbol in symbols.items()]
    width = _column_width(cells, columns)
    for n in range(0, len(cells), columns):
        row = cells[n : n + columns]
        high = max(node.height + node.room[1] for node, _ in row)
        names = [_wrapped(name, width - GAP) for _, name in row]
        for column, ((node, _), lines) in enumerate(zip(row, names, strict=True)):
            _draw(drawing, node, (column + 0.5) * width, top - high / 2)
            for k, line in enumerate(lines):
                drawing.text((column + 0.5) * width, top - high - (k + 0.9) * LINE, line, valign="base", size=SIZE)
        top -= high + LINE * (max(map(len, names)) + 0.2) + GAP
    return drawing.picture(title, f"symbols: {', '.join(symbols)}")


def _placed(symbol):
    """A copy of a symbol by itself."""
    node = copy.copy(symbol)
    node.met((), (), (1, 0))
    return node


def _column_width(cells, columns):
    """As wide as the widest cell needs, but within the page as long as a name can be broken into lines."""
    symbols = max(node.width + 2 * PIECE * bool(node.openings) for node, _ in cells)
    words = max(text_size(word, SIZE)[0] for _, name in cells for word in name.split() or [""])
    whole = max(text_size(name, SIZE)[0] for _, name in cells)
    return max(symbols, words, min(whole, WIDEST / INCHES / columns - GAP)) + GAP


def _wrapped(name, width):
    """The lines of a name, none wider than its column unless it is a single word."""
    lines = [""]
    for word in name.split():
        longer = f"{lines[-1]} {word}".strip()
        if lines[-1] and text_size(longer, SIZE)[0] > width:
            lines.append(word)
        else:
            lines[-1] = longer
    return lines


def _draw(drawing, node, x, y):
    node.levels = [y]
    node.place(x, y, node.width, node.height)
    for dx, dy in node.openings:
        start, length = node.edge(dx, dy, x, y), PIECE if dx else UPRIGHT
        draw_pipe(drawing, [start, (start[0] + length * dx, start[1] + length * dy)])
    node.draw(drawing)
