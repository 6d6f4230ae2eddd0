"""Time constants as bars: what the half rule makes of them."""

from __future__ import annotations

from collections.abc import Mapping
from typing import TYPE_CHECKING, NamedTuple

from loopbook.figures import canvas
from loopbook.figures.picture import Picture, titled
from loopbook.figures.style import GREY, look, pale, styled

if TYPE_CHECKING:
    from loopbook.figures.canvas import OwnAxes
    from loopbook.types import Number

ROW = 0.34  # inches
BAR = 0.68  # height of a bar in its row
HOMES = {"lag": "measurement", "second lag": 0, "dead time": "control signal"}  # each in the colour of a role


def half_rule_plot(
    lags: Mapping[str, Number],
    delay: Mapping[str, Number] | None = None,
    order: int = 1,
    title: str | None = None,
    unit: str = "s",
    ax: OwnAxes = None,
) -> Picture:
    """Draw the half rule as bars that are cut: where each time constant of a process goes in its model.

    The largest lag is kept, or the two largest for a model of second order. The next one is cut in half: one half makes
    the last kept lag longer, the other one is dead time. All others become dead time as a whole.

    Arguments:
        lags: the time constants in the denominator, ``{name: value}``.
        delay: what is dead time already, as a whole: dead times and the time constants of right half-plane zeros.
        order: 1 or 2, of the model.
        title: written above the picture.
        unit: of time, as the axis names it.
        ax: axes of matplotlib to draw into, in place of a new figure.
    Returns:
        A `Picture`, which a notebook shows as the value of a cell.
    Raises:
        ValueError: for another order, or fewer lags than that.

    >>> half_rule_plot({r"$\\tau_1$": 8, r"$\\tau_2$": 3, r"$\\tau_3$": 1}, {r"$\\theta$": 0.5}, title="Three lags")
    <Three lags: half rule: lag 8 + 3/2 = 9.5 s, dead time 3/2 + 1 + 0.5 = 3 s>
    """
    if order not in (1, 2) or len(lags) < order:
        raise ValueError(f"order {order} with {len(lags)} lags: expected 1 or 2, and as many lags or more")
    ranked = sorted(((name, float(value)) for name, value in lags.items()), key=lambda lag: -lag[1])
    kept = ["lag", "second lag"][:order]
    rows = {name: [_Piece(name, value, 1, home)] for (name, value), home in zip(ranked, kept, strict=False)}
    for name, value in ranked[order : order + 1]:
        rows[name] = [_Piece(name, value, 2, kept[-1]), _Piece(name, value, 2, "dead time")]
    for name, value in [*ranked[order + 1 :], *(delay or {}).items()]:
        rows[name] = [_Piece(name, float(value), 1, "dead time")]
    pieces = [piece for row in rows.values() for piece in row]
    model = {home: [piece for piece in pieces if piece.home == home] for home in dict.fromkeys(p.home for p in pieces)}

    with styled():
        figure, (axes,) = canvas.panels([ROW * (len(rows) + len(model) + 0.7)], ax)
        places = [-n - (0.7 if n >= len(rows) else 0) for n in range(len(rows) + len(model))]
        for place, row in zip(places, [*rows.values(), *model.values()], strict=True):
            _bar(axes, place, row)
        axes.axhline(0.15 - len(rows), color=GREY, linewidth=0.8)  # above it the process, below it the model
        axes.set_yticks(places, [*rows, *model])
        axes.tick_params(axis="y", length=0)
        axes.grid(visible=False, axis="y")
        axes.set_ylim(places[-1] - 0.6, 0.6)
        axes.set_xlim(0, 1.02 * max(sum(piece.size for piece in row) for row in model.values()))
        axes.set_xlabel(f"[{unit}]")
        axes.set_title(title or "")
    words = ", ".join(f"{home} {_sum(row)} {unit}" for home, row in model.items())
    return Picture(figure, titled(title, f"half rule: {words}"))


class _Piece(NamedTuple):
    """One of the equal parts of a time constant, and where it goes."""

    name: str
    whole: float
    parts: int
    home: str

    @property
    def size(self):
        return self.whole / self.parts


def _sum(pieces):
    """The sum of pieces in numbers."""
    terms = [f"{piece.whole:g}/{piece.parts}" if piece.parts > 1 else f"{piece.whole:g}" for piece in pieces]
    total = sum(piece.size for piece in pieces)
    return f"{' + '.join(terms)} = {total:g}" if len(terms) > 1 else terms[0]


def _bar(axes, place, pieces):
    """A bar of pieces in a row, each in the colour of where it goes, with its name; a cut is a dashed line."""
    begin = 0.0
    for piece in pieces:
        colour = look(HOMES[piece.home])["color"]
        axes.barh(place, piece.size, BAR, begin, color=pale(colour, 0.35), edgecolor=colour, linewidth=1.2)
        name = f"{piece.name}/{piece.parts}" if piece.parts > 1 else piece.name
        axes.text(begin + piece.size / 2, place, name, ha="center", va="center", fontsize=10)
        begin += piece.size
    if len({piece.home for piece in pieces}) > 1:
        axes.plot([begin / 2] * 2, [place - 0.48, place + 0.48], color="#000000", linewidth=1.4, linestyle=(0, (3, 2)))
