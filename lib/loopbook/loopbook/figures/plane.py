"""Curves, areas, maps and levels in a plane: limits of stability, the complex plane, a criterion over two settings."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import TYPE_CHECKING, Self

import numpy as np

from loopbook.figures import canvas
from loopbook.figures.labels import add_legend, decades
from loopbook.figures.picture import Picture, titled
from loopbook.figures.style import GREY, ON_WHITE, RESPONSE_COLOURS, TINTS, WIDTH, ZERO, look, styled
from plainmath.tables import plain_words

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from numpy.typing import ArrayLike

    from loopbook.figures.canvas import OwnAxes
    from loopbook.types import Number, Values


TALL = 0.55 * WIDTH  # of a panel, in inches


class PlanePlot(Picture):
    """What `plane_plot`, `map_plot` and `level_plot` return, to which areas, points and words can be added."""

    def __init__(self, axes: Axes, alt: str):
        super().__init__(axes.figure.canvas.figure, alt)
        self.axes = axes

    def area(self, x: Values, y: Values, label: str) -> Self:
        """Shade the polygon with these corners; the legend calls it by its label. Returns the plot itself.

        >>> plane_plot({"limit": ([1, 2], [2, 1])}, "$x$", "$y$").area([0, 1, 1], [0, 0, 1], "window")
        <limit: y against x; area: window>
        """
        plain = {"facecolor": "#eeeeee", "edgecolor": GREY, "linewidth": 1, "zorder": 0.5}
        with styled():  # whose thin hatching belongs to the patch in Matplotlib 3.10, and to the drawing before
            self.axes.fill(x, y, hatch="///", label=label, **plain)
        return self._explained(f"; area: {plain_words(label)}")

    def region(self, x: Values, y: Values, words: str) -> Self:
        """Fill the polygon with these corners in a pale colour of its own, and name it there instead of in a legend.

        Each region that is added has the next colour. What is beyond the axes is cut off, so that a corner may be far
        away; the words are where there is most room around them. Returns the plot itself.

        >>> plot = plane_plot({"border": ([1, 2], [1, 2])}, "$x$", "$y$", xlim=(1, 2), ylim=(1, 2))
        >>> plot.region([1, 2, 1], [1, 2, 2], "above").region([1, 2, 2], [1, 2, 1], "below")
        <border: y against x; region: above; region: below>
        """
        from matplotlib.path import Path

        number = sum(patch.get_gid() == "region" for patch in self.axes.patches)
        low, high = np.transpose([self.axes.get_xlim(), self.axes.get_ylim()])
        corners = np.clip(np.column_stack([x, y]).astype(float), low, high)
        (patch,) = self.axes.fill(*corners.T, facecolor=TINTS[number % len(TINTS)], edgecolor="none", zorder=0.5)
        patch.set_gid("region")

        to_frame = self.axes.transData - self.axes.transAxes  # from values to shares of the frame, on any scale
        corners = to_frame.transform(corners)
        grid = np.stack(np.meshgrid(*2 * [np.linspace(0.01, 0.99, 60)]), -1).reshape(-1, 2)
        inside = grid[Path(corners).contains_points(grid)]
        start, way = corners[:, None], (np.roll(corners, -1, axis=0) - corners)[:, None]
        share = np.clip(((inside - start) * way).sum(-1) / np.maximum((way**2).sum(-1), 1e-12), 0, 1)
        to_edge = np.hypot(*np.moveaxis(inside - start - share[..., None] * way, -1, 0)).min(axis=0)
        place = inside[to_edge.argmax()] if len(inside) else corners.mean(axis=0)
        with styled():
            self.axes.text(*place, words, ha="center", va="center", zorder=5, transform=self.axes.transAxes)
        self.alt += f"; region: {plain_words(words)}"
        return self

    def line(self, x: Values, y: Values, label: str, role: str | int = 0) -> Self:
        """Add a curve, as a limit of stability over a map; look as in `plane_plot`. Returns the plot itself.

        >>> plane_plot({"limit": ([1, 2], [2, 1])}, "$x$", "$y$").line([1, 2], [1, 2], "diagonal", role=1)
        <limit: y against x; line: diagonal>
        """
        self.axes.plot(x, y, label=label, scalex=False, scaley=False, **look(role))
        return self._explained(f"; line: {plain_words(label)}")

    def points(self, x: Number | Values, y: Number | Values, label: str, mark: str = "o") -> Self:
        """Add single points, by the name that the legend gives them. Returns the plot itself.

        Arguments:
            x, y: one value or as many for each.
            label: their name.
            mark: "o" for dots, "x" for crosses, as for poles; or another sign of Matplotlib, as "s" and "^".

        >>> plane_plot({"limit": ([1, 2], [2, 1])}, "$x$", "$y$").points([1], [1], "settings")
        <limit: y against x; points: settings>
        """
        dots = {"color": "#000000", "markersize": 6 if mark == "o" else 8, "markeredgewidth": 1.6, "zorder": 4}
        self.axes.plot(x, y, mark, label=label, linestyle="", scalex=False, scaley=False, **dots)
        return self._explained(f"; points: {plain_words(label)}")

    def text(self, x: float, y: float, words: str) -> Self:
        """Write words around a point of the plane. Returns the plot itself.

        >>> plane_plot({"limit": ([1, 2], [2, 1])}, "$x$", "$y$").text(1.5, 1.8, "unstable")
        <limit: y against x; unstable>
        """
        with styled():
            self.axes.text(x, y, words, ha="center", va="center", zorder=5, bbox=ON_WHITE | {"pad": 1.5})
        self.alt += f"; {plain_words(words)}"
        return self

    def _explained(self, words):
        with styled():
            add_legend(self.axes)
        self.alt += words
        return self


def plane_plot(
    curves: Mapping[str, tuple[Values, Values] | tuple[Values, Values, str | int]],
    xlabel: str,
    ylabel: str,
    title: str | None = None,
    xlim: tuple[float, float] | None = None,
    ylim: tuple[float, float] | None = None,
    log: bool = False,
    equal: bool = False,
    legend: bool = True,
    ax: OwnAxes = None,
) -> PlanePlot:
    """Plot curves in a plane: limits of stability, frequency responses in the complex plane.

    Arguments:
        curves: ``{label: (x, y)}`` with arrays of equal length; a curve may turn back, and is broken at a NaN. A third
            item, a role or a number as in `time_plot`, gives it that look; by itself, curve after curve has its own.
        xlabel, ylabel: names of the axes with their units.
        title: written above the plot; begins with the name of the book's figure where there is one.
        xlim, ylim: lowest and highest value of an axis.
        log: logarithmic axes.
        equal: one unit is as long on both axes, as for complex numbers; then both axes are drawn at zero.
        legend: explain several curves in a legend; not needed where they are borders of regions that have their names.
        ax: axes of matplotlib to draw into, in place of a new figure.
    Returns:
        A `PlanePlot`, which a notebook shows as the value of a cell; ``.area``, ``.region``, ``.line``,
            ``.points`` and ``.text`` add to it.
    Raises:
        ValueError: for no curve, or unequal lengths.

    >>> plane_plot({"limit": ([1, 2, 3], [3, 2, 1])}, "gain ratio", "delay ratio", "Figure 2")
    <Figure 2: limit: delay ratio against gain ratio>
    """
    if not isinstance(curves, dict) or not curves:
        raise ValueError(f"the curves are {curves!r}: expected {{label: (x, y)}} with at least one")
    with styled():
        _, (axes,) = canvas.panels([TALL if not equal else TALL + 0.12 * WIDTH], ax)
        for number, (label, (x, y, *role)) in enumerate(curves.items()):
            x, y = np.asarray(x, dtype=float), np.asarray(y, dtype=float)
            if x.shape != y.shape:
                raise ValueError(f"{label} has {x.size} values for x and {y.size} for y: expected as many")
            axes.plot(x, y, label=label, **look(role[0] if role else number))
        _finish(axes, xlabel, ylabel, title, xlim, ylim, log)
        if equal:
            axes.set_aspect("equal")
            axes.axhline(0, **ZERO)
            axes.axvline(0, **ZERO)
        if legend and len(curves) > 1:
            add_legend(axes)
    shown = ", ".join(map(plain_words, curves))
    words = f"{shown}: {plain_words(ylabel)} against {plain_words(xlabel)}"
    return PlanePlot(axes, titled(title, words))


def map_plot(
    x: Values,
    y: Values,
    numbers: ArrayLike,
    xlabel: str,
    ylabel: str,
    label: str,
    title: str | None = None,
    log: bool = False,
    ax: OwnAxes = None,
) -> PlanePlot:
    """Plot whole numbers on a grid as shades of grey, white for 0, with a scale: a map of unstable poles, for example.

    Arguments:
        x, y: the values along the two axes, increasing arrays.
        numbers: an integer array with a row for each y and a column for each x; a negative one is drawn as 0.
        xlabel, ylabel: names of the axes with their units.
        label: what the numbers are.
        title, log, ax: as in `plane_plot`.
    Returns:
        A `PlanePlot`.
    Raises:
        ValueError: for an array of another shape.

    >>> map_plot([1, 2], [1, 2, 3], [[0, 0], [0, 2], [2, 4]], "$K_p$", "$T_i$ [s]", "unstable poles")
    <unstable poles (0 to 4): T_i [s] against K_p>
    """
    from matplotlib.colors import ListedColormap, to_hex

    x, y, numbers = _on_grid(x, y, numbers)
    levels = sorted({int(n) for n in np.unique(numbers)} | {0})
    levels = [n for n in levels if n >= 0]
    shade = np.searchsorted(levels, np.maximum(numbers, 0))
    greys = [
        "#ffffff",
        *(to_hex(str(g)) for g in np.linspace(0.82, 0.35, max(len(levels) - 1, 1))),
    ]
    colours = ListedColormap(greys[: len(levels)])
    with styled():
        _, (axes,) = canvas.panels([TALL], ax)
        mesh = axes.pcolormesh(
            x, y, shade, cmap=colours, vmin=-0.5, vmax=len(levels) - 0.5, shading="nearest", rasterized=True
        )
        axes.grid(False)
        scale = axes.figure.colorbar(mesh, ax=axes, ticks=range(len(levels)), label=label)
        scale.ax.set_yticklabels(levels)
        _finish(axes, xlabel, ylabel, title, (x[0], x[-1]), (y[0], y[-1]), log)
    words = f"{plain_words(label)} ({levels[0]} to {levels[-1]}): {plain_words(ylabel)} against {plain_words(xlabel)}"
    return PlanePlot(axes, titled(title, words))


def level_plot(
    x: Values,
    y: Values,
    values: ArrayLike,
    levels: Sequence[float] | np.ndarray,
    xlabel: str,
    ylabel: str,
    label: str,
    title: str | None = None,
    log: bool = False,
    ax: OwnAxes = None,
) -> PlanePlot:
    """Plot lines of equal value over a plane, with the value written on each: a criterion over two settings.

    Arguments:
        x, y: the values along the two axes, increasing arrays.
        values: an array with a row for each y and a column for each x; what is not finite is left out.
        levels: increasing values, those of the lines.
        xlabel, ylabel: names of the axes with their units.
        label: what the values are.
        title, log, ax: as in `plane_plot`.
    Returns:
        A `PlanePlot`.
    Raises:
        ValueError: for an array of another shape.

    >>> import numpy as np
    >>> x = y = np.array([1.0, 2.0, 3.0])
    >>> level_plot(x, y, np.outer(y, x), [2, 4, 6], "$K_p$", "$T_i$ [s]", "ISE")
    <levels of ISE, 2 to 6: T_i [s] against K_p>
    """
    x, y, values = _on_grid(x, y, values)
    with styled():
        _, (axes,) = canvas.panels([TALL], ax)
        finite = np.ma.masked_invalid(values)
        lines = axes.contour(x, y, finite, levels, colors=RESPONSE_COLOURS[0], linewidths=1.3)
        axes.clabel(lines, fmt="%g", fontsize=10, colors="#000000")
        _finish(axes, xlabel, ylabel, title, (x[0], x[-1]), (y[0], y[-1]), log)
    words = f"levels of {plain_words(label)}, {levels[0]:g} to {levels[-1]:g}"
    words = f"{words}: {plain_words(ylabel)} against {plain_words(xlabel)}"
    return PlanePlot(axes, titled(title, words))


def _on_grid(x, y, values):
    """The arrays of two axes and of the values over them, if they fit."""
    x, y, values = (np.asarray(array, dtype=float) for array in (x, y, values))
    if values.shape != (len(y), len(x)):
        raise ValueError(f"the values have the shape {values.shape}: expected {(len(y), len(x))}, a row for each y")
    return x, y, values


def _finish(axes, xlabel, ylabel, title, xlim, ylim, log):
    """Names, limits and numbers of the axes."""
    axes.set_xlabel(xlabel)
    axes.set_ylabel(ylabel)
    axes.set_title(title or "")
    if log:
        axes.set(xscale="log", yscale="log")
    axes.set_xlim(xlim or axes.get_xlim())
    axes.set_ylim(ylim or axes.get_ylim())
    if log:
        decades(axes.xaxis, *axes.get_xlim(), short=3000)
        decades(axes.yaxis, *axes.get_ylim(), short=3000)
