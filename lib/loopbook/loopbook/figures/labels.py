"""Legends, words and numbers where they hide nothing."""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import TYPE_CHECKING

from loopbook.figures.style import ON_WHITE

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.axis import Axis
    from matplotlib.legend import Legend
    from matplotlib.text import Text

CORNERS = ("upper left", "upper right", "lower right", "lower left")
BELOW = "below"  # the name of a legend that lies under its axes


def add_legend(axes: Axes, columns: int = 1) -> None:
    """A legend where it hides least, and the axes stay as they are; one that lies below its axes remains there."""
    from matplotlib.collections import QuadMesh
    from matplotlib.contour import ContourSet

    if axes.get_legend() and axes.get_legend().get_gid() == BELOW:
        legend_below(axes)
    elif any(isinstance(drawn, QuadMesh) for drawn in axes.collections):
        axes.legend(loc="upper right")  # the search for a free place would go through every cell of a map
    elif any(isinstance(drawn, ContourSet) for drawn in axes.collections):
        axes.legend(
            loc=min(CORNERS, key=lambda corner: _hidden_levels(axes, corner))
        )  # that search does not see levels
    else:
        axes.legend(ncols=columns)


def _hidden_levels(axes, corner):
    """How much a legend in a corner would hide of lines of equal value and of points, in dots of the lines."""
    box = axes.legend(loc=corner).get_window_extent()
    paths = [path for drawn in axes.collections for path in drawn.get_paths()] + [
        line.get_path() for line in axes.lines
    ]
    texts = sum(box.overlaps(text.get_window_extent()) for text in axes.texts)
    return texts + sum(box.count_contains(axes.transData.transform(path.vertices)) for path in paths)


def free_legend(axes: Axes) -> None:
    """A legend where it hides no curve; if there is no such place, a flat one above them, for which the panel grows."""
    legend = axes.legend()
    if not hides(axes, legend):
        return
    for columns in range(len(axes.lines), 0, -1):
        legend = axes.legend(ncols=columns, loc="upper right")
        if legend.get_window_extent().width <= 0.95 * axes.bbox.width:
            break
    make_room(axes, legend, 1.1)


def hides(axes: Axes, words: Legend | Text) -> bool:
    """Tell whether a curve runs behind words or a legend."""
    box = words.get_window_extent()
    curves = (line.get_path().transformed(line.get_transform()) for line in axes.lines)
    return any(curve.intersects_bbox(box, filled=False) for curve in curves)


def make_room(axes: Axes, words: Legend | Text, share: float) -> None:
    """Let a panel grow above its curves by a share of what is written at its upper edge, if that hides a curve."""
    if not hides(axes, words):
        return
    box, scale = words.get_window_extent(), axes.yaxis.get_transform()
    low, high = scale.transform(axes.get_ylim())
    high += share * (high - low) * box.height / (axes.bbox.height - box.height)
    axes.set_ylim(scale.inverted().transform([low, high]))


def legend_below(axes: Axes) -> None:
    """A legend under the axes, where a picture has no empty corner; what is added later is explained there, too."""
    axes.legend(loc="upper center", bbox_to_anchor=(0.5, -0.13), ncols=2).set_gid(BELOW)


def decades(axis: Axis, low: float, high: float, short: float = 300) -> None:
    """Ordinary numbers on a logarithmic axis from `low` to `high`: 1, 2 and 5, or powers of ten where it is long.

    Arguments:
        axis: of matplotlib.
        low, high: its limits.
        short: the largest quotient of the two for which there is room for all numbers.
    """
    from matplotlib.ticker import FuncFormatter, LogLocator, NullFormatter

    long = high / low > short
    axis.set_major_locator(LogLocator(subs=(1,) if long else (1, 2, 5), numticks=9 if long else 12))
    plain = low >= 0.9e-3 and high <= 1.1e4
    name = (lambda x, _: f"{x:g}") if plain or not long else (lambda x, _: f"$10^{{{round(math.log10(x))}}}$")
    axis.set_major_formatter(FuncFormatter(name))
    axis.set_minor_formatter(NullFormatter())


# in points from the point that is named, and how the words lie around there
PLACES = {
    "right": (7, 0, "left", "center"),
    "left": (-7, 0, "right", "center"),
    "above": (0, 6, "center", "bottom"),
    "below": (0, -6, "center", "top"),
    "above right": (6, 4, "left", "bottom"),
    "above left": (-6, 4, "right", "bottom"),
    "below right": (6, -4, "left", "top"),
    "below left": (-6, -4, "right", "top"),
}


def free_place(
    axes: Axes, words: str, point: tuple[float, float], preferred: Sequence[str] = (), color: str = "#000000"
) -> Text:
    """Write words beside a point, at the first place where they hide no curve and no other words.

    Arguments:
        axes: of a figure that is otherwise finished, and has been drawn, so that its axes lie where they remain.
        words: the text.
        point: what it names, in the units of the axes.
        preferred: the names of places that are tried first, as "above right".
        color: of the words.
    Returns:
        The text of matplotlib.
    """
    frame = axes.get_window_extent()
    taken = [text.get_window_extent() for text in axes.texts if text.get_text()]
    if axes.get_legend():
        taken.append(axes.get_legend().get_window_extent())
    curves = [line.get_path().transformed(line.get_transform()) for line in axes.lines]
    best = None
    for far in (1, 2.5, 5):
        for name in dict.fromkeys([*preferred, *PLACES]):
            x, y, ha, va = PLACES[name]
            text = axes.annotate(
                words, point, (far * x, far * y), textcoords="offset points", ha=ha, va=va, color=color, zorder=5,
                bbox=ON_WHITE,
            )  # fmt: skip
            box = text.get_window_extent()
            hidden = sum(path.intersects_bbox(box, filled=False) for path in curves)
            hidden += 3 * sum(box.overlaps(other) for other in taken)
            hidden += 10 * (box.x0 < frame.x0 or box.x1 > frame.x1 or box.y0 < frame.y0 or box.y1 > frame.y1)
            if not hidden:
                if best:
                    best[1].remove()
                return text
            if best is None or hidden < best[0]:
                if best:
                    best[1].remove()
                best = hidden, text
            else:
                text.remove()
    return best[1]
