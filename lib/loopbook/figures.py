"""Figures: one look for the whole collection; signals against time, and curves and areas in a plane.

A signal has the same colour and the same kind of line in every figure. The colours are those of Okabe and Ito, which
stay apart without colour vision; the dashes stay apart on a grey printout.
"""

from __future__ import annotations

import base64
import io
import math
import numbers
import re
import struct
from collections.abc import Collection, Mapping, Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Any, BinaryIO, Protocol, Self, TypeAlias

import sympy

from loopbook.laplace import evaluate, t

if TYPE_CHECKING:
    import numpy
    from matplotlib.axes import Axes
    from matplotlib.axis import Axis
    from matplotlib.figure import Figure
    from matplotlib.lines import Line2D
    from matplotlib.text import Text
    from numpy.typing import ArrayLike
    from PIL import Image

    from loopbook.types import Number, Signal

__all__ = ["Picture", "PlanePlot", "TimePlot", "level_plot", "map_plot", "plane_plot", "time_plot", "trends"]

STYLE: dict[str, Any] = {
    # One typeface for words and mathematics; it comes with matplotlib, so that every machine draws the same picture.
    "font.family": "STIXGeneral",
    "mathtext.fontset": "stix",
    "font.size": 11,
    "axes.titlesize": 11.5,
    "axes.titlelocation": "left",
    "axes.titlepad": 8,
    "axes.labelsize": 11,
    "axes.linewidth": 0.8,
    "axes.spines.top": False,
    "axes.spines.right": False,
    "axes.grid": True,
    "axes.axisbelow": True,
    "axes.ymargin": 0.1,
    "grid.color": "#dddddd",
    "grid.linewidth": 0.6,
    "xtick.direction": "out",
    "ytick.direction": "out",
    "legend.frameon": True,
    "legend.framealpha": 0.9,
    "legend.edgecolor": "none",
    "legend.handlelength": 3.2,  # long enough to show the dashes
    "lines.dash_capstyle": "butt",
    "lines.scale_dashes": False,
    "figure.facecolor": "white",
    "savefig.facecolor": "white",
}

ROLES: dict[str, dict[str, Any]] = {
    "setpoint": {"color": "#000000", "linestyle": (0, (4, 3)), "linewidth": 1.2, "zorder": 3},
    "measurement": {"color": "#0072B2", "linestyle": "-", "linewidth": 2.0},
    "control signal": {"color": "#D55E00", "linestyle": (0, (16, 2)), "linewidth": 1.6},
    "disturbance": {"color": "#CC79A7", "linestyle": (0, (8, 2, 2, 2)), "linewidth": 1.6},
}
INPUTS = ("control signal", "disturbance")

# What has no role takes the next of these; four colours and five kinds of line make twenty that differ in both.
RESPONSE_COLOURS = ["#009E73", "#E69F00", "#56B4E9", "#555555"]
RESPONSE_LINES = ["-", (0, (7, 2)), (0, (8, 2, 2, 2)), (0, (2, 1.5)), (0, (12, 2, 2, 2, 2, 2))]

WIDTH = 6.4  # inches: a notebook column, and the text width of a printed page
BELOW = "below"  # the name of a legend that lies under its axes
DOTS_PER_INCH = 144  # half as many again as a browser calls an inch: sharp in print, and light in a notebook


#: A signal in a plot; in a pair with its role, or with the number of a response, where it has its look.
Drawn: TypeAlias = "Signal | tuple[Signal, str | int]"

#: Numbers in a row, such as the moments of a plot.
Values: TypeAlias = "Sequence[Number] | numpy.ndarray"

#: The lowest and the highest value of an axis.
Limits: TypeAlias = "tuple[Number, Number]"


class Recorded(Protocol):
    """What `trends` draws: a `simulation.Run`, a `deadtime.LoopResponse`, or what has their signals."""

    @property
    def times(self) -> numpy.ndarray:
        """The moments."""

    @property
    def signals(self) -> Mapping[str, numpy.ndarray]:
        """The signals by name, a value for each moment."""

    @property
    def output(self) -> str:
        """The name of the controlled signal."""

    @property
    def manipulated(self) -> str:
        """The name of the control signal."""

    @property
    def held(self) -> Collection[str]:
        """The names of the signals that are constant from one sample to the next."""

    def __getitem__(self, name: str, /) -> numpy.ndarray:
        """A signal by its name."""

    def unit(self, name: str, /) -> str:
        """The unit of a signal."""


class Picture:
    """A finished figure that a notebook shows once, as the value of a cell, with a description for who cannot see it.

    Attributes:
        figure: the matplotlib figure, for any change that this module does not offer.
        alt: the description in words; also what `print` and a plain-text display show.
    """

    def __init__(self, figure: Figure, alt: str):
        self.figure = figure
        self.alt = " ".join(alt.split())

    def __repr__(self) -> str:
        return f"<{self.alt}>"

    def save(self, file: str | Path | BinaryIO, **options: Any) -> None:
        """Write the figure to a file (a name ending in .png, .pdf or .svg, or an open file).

        Arguments:
            file: name or open binary file.
            options: what else matplotlib's ``savefig`` understands.
        """
        import matplotlib

        with matplotlib.rc_context(STYLE):
            self.figure.savefig(file, **{"dpi": DOTS_PER_INCH, "bbox_inches": "tight", "pad_inches": 0.06} | options)

    def png(self) -> bytes:
        """Return the figure as the bytes of a PNG file, the same for the same versions of matplotlib and Pillow.

        >>> from loopbook.laplace import t
        >>> time_plot({"$y(t)$": 2 * t}, [0, 1, 2]).png()[:4]
        b'\\x89PNG'
        """
        from PIL import Image

        full, small = io.BytesIO(), io.BytesIO()
        self.save(full, format="png", metadata={"Software": None}, pil_kwargs={"compress_level": 1})
        with_few_colours(Image.open(full).convert("RGB")).save(small, "PNG", optimize=True)
        return small.getvalue()

    # The figure belongs to an object of our own because Jupyter would draw a matplotlib figure its own way, without
    # the description, and only after pyplot has been imported.
    def _repr_mimebundle_(self, include=None, exclude=None):
        image = self.png()
        width, height = (round(dots * 96 / DOTS_PER_INCH) for dots in struct.unpack(">II", image[16:24]))
        data = {"image/png": base64.b64encode(image).decode(), "text/plain": repr(self)}
        return data, {"image/png": {"alt": self.alt, "width": width, "height": height}}


def with_few_colours(image: Image.Image, shades: int = 3) -> Image.Image:
    """A line drawing with the colours of its lines and areas, in a few shades towards white: a quarter as large.

    Arguments:
        image: of Pillow, in RGB.
        shades: of each colour, for soft edges.
    Returns:
        The image with a palette.
    """
    from PIL import Image, ImageColor

    count = {colour: number for number, colour in image.getcolors(image.width * image.height)}
    lines = [*(look["color"] for look in ROLES.values()), *RESPONSE_COLOURS, "#000000"]
    of_lines = [colour for colour in map(ImageColor.getrgb, lines) if colour in count]
    # what covers half a per cent or more is an area or a grid, but for the white ones
    of_areas = [c for c, number in count.items() if number > 0.005 * image.width * image.height and min(c) < 245]
    mixed = [
        tuple(round(255 + (x - 255) * k / shades) for x in colour)
        for colour in [*of_lines, *of_areas]
        for k in range(1, shades + 1)
    ]
    if all(max(colour) == min(colour) for colour in [*of_lines, *of_areas]):  # black and white: two bits a dot
        greys = [colour for colour in of_areas if colour != (0, 0, 0)] or [(170, 170, 170)]
        mixed = [(0, 0, 0), (100, 100, 100), max(greys, key=lambda colour: count.get(colour, 0))]
    palette = Image.new("P", (1, 1))
    palette.putpalette([x for colour in dict.fromkeys([(255, 255, 255), *mixed]) for x in colour])
    return image.quantize(palette=palette, dither=Image.Dither.NONE)


class TimePlot(Picture):
    """What `time_plot` returns: a picture of signals against time, on which points and levels can be marked."""

    def __init__(self, figure: Figure, alt: str, lines: dict[str, Line2D]):
        super().__init__(figure, alt)
        self.lines = lines  # {label: matplotlib line}

    def mark(self, time: Number, label: str, signal: str | None = None) -> Self:
        """Mark the point where a curve is at `time`: a dot, dashed guides to both axes, and a label.

        Arguments:
            time: the time of the point, in the unit of the time axis; a number or an exact SymPy number.
            label: text beside the point; mathematics between dollar signs.
            signal: label of the curve; the first curve if not given.
        Returns:
            The plot itself, so that it can stand last in a cell.
        Raises:
            ValueError: for a time outside the plot, or a label that no curve has.

        >>> from loopbook.laplace import t
        >>> plot = time_plot({"$y(t)$": 2 * (1 - sympy.exp(-t / 5))}, range(26), title="Figure 6.2")
        >>> plot.mark(5, "63 % at $t = T$").level(2, "$KU$")
        <Figure 6.2: y(t) against t [s]; marked: 63 % at t = T; level: KU>
        """
        import numpy

        line = self._line(signal)
        axes, times, values = line.axes, line.get_xdata(), line.get_ydata()
        time = float(time)
        if not times[0] <= time <= times[-1]:
            raise ValueError(f"cannot mark t = {time:g}: the plot shows {times[0]:g} to {times[-1]:g}")
        value = numpy.interp(time, times, values)
        (left, right), (bottom, top) = axes.get_xlim(), axes.get_ylim()
        guide = {"color": "#555555", "linestyle": (0, (2, 2)), "linewidth": 1, "scalex": False, "scaley": False}
        # The guides run on beyond the frame, which cuts them off wherever it comes to lie.
        axes.plot([time, time], [value, bottom - 2 * (top - bottom)], **guide)
        axes.plot([time, left - (right - left)], [value, value], **guide)
        axes.plot(time, value, "o", color=line.get_color(), markersize=6, zorder=4)

        # A rising curve leaves room below it on the right and above it on the left; a falling one the other way.
        on_right = time < left + 0.6 * (right - left)
        ahead = numpy.interp(time + 0.05 * (right - left) * (1 if on_right else -1), times, values)
        above = ahead < value if on_right else ahead <= value
        with self._style():
            axes.annotate(
                label, (time, value), (9 if on_right else -9, 5 if above else -5), textcoords="offset points",
                ha="left" if on_right else "right", va="bottom" if above else "top", zorder=5,
                bbox={"facecolor": "white", "edgecolor": "none", "alpha": 0.85, "pad": 1},
            )  # fmt: skip
        self.alt += f"; marked: {plain_words(label)}"
        return self

    def level(self, value: Number, label: str, signal: str | None = None) -> Self:
        """Draw a horizontal dashed line, as for a steady state, with a label at its right end, out of the curve's way.

        Arguments:
            value: the level, in the unit of the vertical axis; a number or an exact SymPy number.
            label: text on the line; mathematics between dollar signs.
            signal: label of a curve in the panel that is meant; the first panel if not given.
        Returns:
            The plot itself, so that it can stand last in a cell.
        Raises:
            ValueError: for a label that no curve has.

        >>> from loopbook.laplace import t
        >>> time_plot({"$h(t)$": 3 - 3 * sympy.exp(-t)}, range(9)).level(3, "$h_s$")
        <h(t) against t [s]; level: h_s>
        """
        line = self._line(signal)
        axes, value = line.axes, float(value)
        axes.axhline(value, color="#555555", linestyle=(0, (6, 3)), linewidth=1, zorder=1.5)
        bottom, top = axes.get_ylim()
        room = 0.2 * (max(top, value) - min(bottom, value))
        curve = line.get_ydata()
        below = curve[-len(curve) // 5 :].mean() > value  # the curve comes down to the level
        axes.set_ylim(min(bottom, value - room / (1 if below else 2)), max(top, value + room / (2 if below else 1)))
        with self._style():
            axes.annotate(
                label, (1, value), (-2, -3 if below else 2), xycoords=("axes fraction", "data"),
                textcoords="offset points", ha="right", va="top" if below else "bottom",
            )  # fmt: skip
        self.alt += f"; level: {plain_words(label)}"
        return self

    def points(
        self,
        times: Values,
        values: Values,
        label: str,
        signal: str | None = None,
    ) -> Self:
        """Add single points, such as data between which a curve interpolates.

        Arguments:
            times, values: one of each for every point, in the units of the axes.
            label: how the legend calls the points.
            signal: label of a curve in the panel that is meant; the first panel if not given.
        Returns:
            The plot itself, so that it can stand last in a cell.
        Raises:
            ValueError: for unequal lengths, or a label that no curve has.

        >>> time_plot({"$u_f$": [2, 3, 5]}, [0, 1, 2], xlabel="$d$ [%]").points([0, 1, 2], [2, 3, 5], "experiments")
        <u_f against d [%]; points: experiments>
        """
        if len(times) != len(values):
            raise ValueError(f"{label} has {len(times)} times and {len(values)} values")
        axes = self._line(signal).axes
        low, high = axes.get_ylim()
        axes.plot(times, values, "o", color="#000000", markersize=5, label=label, zorder=4)
        axes.set_ylim(min(low, *map(float, values)), max(high, *map(float, values)))
        with self._style():
            add_legend(axes, may_grow=True)
        self.alt += f"; points: {plain_words(label)}"
        return self

    def _line(self, label):
        if label is None:
            return next(iter(self.lines.values()))
        if label not in self.lines:
            raise ValueError(f"no signal {label!r} in this plot: it has {', '.join(self.lines)}")
        return self.lines[label]

    @staticmethod
    def _style():
        import matplotlib

        return matplotlib.rc_context(STYLE)


def time_plot(
    signals: Mapping[str, Drawn] | Sequence[Mapping[str, Drawn]],
    times: Values,
    title: str | None = None,
    xlabel: str = "$t$ [s]",
    ylabel: str | Sequence[str | None] | None = None,
    ylim: Limits | list[Limits | None] | None = None,
    before: float = 0,
    low: bool = False,
) -> TimePlot:
    """Plot signals against time, in one panel or in several above one another with a common time axis.

    Arguments:
        signals: ``{label: signal}``, or a list of these, one a panel from the top down. A signal is a SymPy expression
            in `t`, a number, or an array with one value for each time; ``(signal, role)`` gives it the colour of its
            role: "setpoint", "measurement", "control signal" or "disturbance", or a number 0, 1, 2 ... for that of a
            response. Labels may hold mathematics between dollar signs. A panel with one input and nothing else is half
            as high as the others.
        times: increasing times, in the unit that `xlabel` says.
        title: stands above the plot; begins with the name of the book's figure where there is one.
        xlabel, ylabel: names of the axes with their units; `ylabel` is a list where there are several panels. A panel
            with one signal takes the signal's label if no `ylabel` is given.
        ylim: lowest and highest value of the top panel's axis, where it must not follow the signals, as under a slider;
            or a list of these, one for each panel, with None where the axis follows the signals.
        before: how much time to show ahead of t = 0, with every signal at zero, so that a step at t = 0 is seen.
        low: make it less high, and flat the legend under a given `ylim`, where a chapter has many figures.
    Returns:
        A `TimePlot`, which a notebook shows as the value of a cell; `.mark` and `.level` add to it.
    Raises:
        ValueError: for times that do not increase, a signal that is neither expression nor array or has another length
            than the times, an unknown role, a label used twice, or an expression with letters besides `t`.

    >>> from loopbook.laplace import t
    >>> time_plot([{"$y(t)$": 2 * t}, {"$u(t)$": (1, "control signal")}], range(11), title="Figure 6.1", before=1)
    <Figure 6.1: y(t); u(t) against t [s]>
    """
    import matplotlib
    from matplotlib.figure import Figure

    panels = list(signals) if isinstance(signals, (list, tuple)) else [signals]
    ylabels = list(ylabel) if isinstance(ylabel, (list, tuple)) else [ylabel] * len(panels)
    if not panels or not all(isinstance(panel, dict) and panel for panel in panels):
        raise ValueError("signals must be {label: signal}, or a list of these, with at least one signal in each")
    if len(ylabels) != len(panels):
        raise ValueError(f"{len(ylabels)} names of vertical axes for {len(panels)} panels")
    fixed_axes = ylim if isinstance(ylim, list) else [ylim] + [None] * (len(panels) - 1)
    fixed_axes = [fixed and tuple(map(float, fixed)) for fixed in fixed_axes]
    if len(fixed_axes) != len(panels):
        raise ValueError(f"{len(fixed_axes)} ranges of vertical axes for {len(panels)} panels")
    times = _increasing(times)
    if before < 0 or (before and times[0] != 0):
        raise ValueError("time before t = 0 can be shown only in front of times that start at 0, and is not negative")
    curves = [{label: _curve(label, what, times, before) for label, what in panel.items()} for panel in panels]
    labels = [label for panel in panels for label in panel]
    if len(set(labels)) < len(labels):
        raise ValueError(f"two signals have the same label: {', '.join(labels)}")

    inputs = [len(panel) == 1 and all(role in INPUTS for *_, role in panel.values()) for panel in curves]
    heights = [1 if only_input and len(panels) > 1 else 2 for only_input in inputs]
    with matplotlib.rc_context(STYLE):
        figure = Figure(figsize=(WIDTH, 1.2 + (0.7 if low else 0.95) * sum(heights)), layout="constrained")
        grid = figure.subplots(len(panels), sharex=True, squeeze=False, height_ratios=heights)[:, 0]
        lines = {}
        number = 0
        for axes, panel, name, fixed in zip(grid, curves, ylabels, fixed_axes, strict=True):
            for label, (x, y, role) in panel.items():
                number += role is None
                look = ROLES[role] if role in ROLES else response_look(number - 1 if role is None else role)
                (lines[label],) = axes.plot(x, y, label=label, **look)
            axes.set_ylabel(name or (label if len(panel) == 1 else ""))
            # from here on, what is marked does not move the curves
            axes.set_ylim(fixed or axes.get_ylim())
        grid[-1].set_xlim(times[0] - before, times[-1])
        grid[-1].set_xlabel(xlabel)
        grid[0].set_title(title or "")
        figure.align_ylabels()
        explained = set()
        for axes, panel, fixed in zip(grid, curves, fixed_axes, strict=True):
            looks = {role for *_, role in panel.values()}
            # the same responses in the same looks need no second legend
            if len(panel) > 1 and not (looks <= explained and all(isinstance(look, int) for look in looks)):
                add_legend(axes, may_grow=not fixed, columns=3 if low else 1)
            explained |= looks
    shown = "; ".join(", ".join(map(plain_words, panel)) for panel in panels)
    return TimePlot(figure, f"{plain_words(title) + ': ' if title else ''}{shown} against {plain_words(xlabel)}", lines)


def trends(
    runs: Recorded | Mapping[str, Recorded],
    title: str | None = None,
    disturbances: Sequence[str] = (),
    measured: bool = False,
    minutes: bool = False,
    limits: Limits | None = None,
    control_limits: Limits | None = None,
) -> TimePlot:
    """Plot loops as an operator sees them: setpoint and measurement above, control signal below.

    Arguments:
        runs: a `simulation.Run` or a `deadtime.LoopResponse`, or ``{label: run}`` for several with the same times and
            the same setpoint.
        title: stands above the plot; begins with the name of the book's figure where there is one.
        disturbances: names of inputs of the plant, each shown in a panel of its own below the others.
        measured: show the noisy measurement instead of the plant's output.
        minutes: write the time in minutes, for runs in seconds.
        limits, control_limits: lowest and highest value of the upper panel's axis, and of the control signal's, where
            they must not follow the signals.
    Returns:
        A `TimePlot`, which a notebook shows as the value of a cell.
    Raises:
        ValueError: for runs with different times, or a signal that they do not have.

    >>> from loopbook.pid import PID, Controller
    >>> from loopbook.plants import HeatedTank
    >>> from loopbook.simulation import simulate
    >>> controller = Controller(PID(2000, Ti=300), step=10, u0=10000)
    >>> trends(simulate(HeatedTank(), controller, until=1000, setpoint=31), "A warmer tank")
    <A warmer tank: setpoint, T; P against t [s]>
    """
    import numpy

    runs = runs if isinstance(runs, dict) else {"": runs}
    if not runs or not all(hasattr(run, "signals") for run in runs.values()):
        raise ValueError("expected a run, or {label: run} with one run or more")
    if isinstance(disturbances, str):
        raise ValueError(f"disturbances is {disturbances!r}: expected a list of names")
    first = next(iter(runs.values()))
    for run in runs.values():
        if not numpy.array_equal(run.times, first.times):
            raise ValueError("the runs have different times: expected the same step and the same end")
        for name in ("setpoint", *disturbances):
            if name in first.signals and not numpy.array_equal(run[name], first[name], equal_nan=True):
                raise ValueError(f"the runs have different signals {name!r}: expected the same in all")
    output, control = first.output, first.manipulated
    source = "measurement" if measured else output

    def panel(name, signal, role):
        letter = f"${sympy.latex(sympy.Symbol(name))}$"
        if len(runs) == 1:
            return {letter: (first[signal], role)}
        return {f"{letter}, {label}": (run[signal], n) for n, (label, run) in enumerate(runs.items())}

    top = {"setpoint": (first["setpoint"], "setpoint")} if "setpoint" in first.signals else {}
    panels = [top | panel(output, source, "measurement"), panel(control, control, "control signal")]
    panels += [{f"${sympy.latex(sympy.Symbol(x))}$": (first[x], "disturbance")} for x in disturbances]
    names = [f"${sympy.latex(sympy.Symbol(x))}$ [{first.unit(x)}]" for x in (output, control, *disturbances)]
    ylim = [limits, control_limits, *(None for _ in disturbances)]
    times = first.times / (60 if minutes else 1)
    xlabel = "$t$ [min]" if minutes else "$t$ [s]"
    plot = time_plot(panels, times, title=title, xlabel=xlabel, ylabel=names, ylim=ylim)
    for panel, name in zip(panels, (output, control, *disturbances), strict=True):
        for label in panel:
            if ("setpoint" if label == "setpoint" else name) in first.held:
                plot.lines[label].set_drawstyle("steps-post")
    return plot


class PlanePlot(Picture):
    """What `plane_plot`, `map_plot` and `level_plot` return, to which areas, points and words can be added."""

    def __init__(self, figure: Figure, alt: str):
        super().__init__(figure, alt)
        self.axes = figure.axes[0]

    def area(self, x: Values, y: Values, label: str) -> Self:
        """Shade the polygon with these corners; the legend calls it by its label. Returns the plot itself.

        >>> plane_plot({"limit": ([1, 2], [2, 1])}, "$x$", "$y$").area([0, 1, 1], [0, 0, 1], "window")
        <limit: y against x; area: window>
        """
        (patch,) = self.axes.fill(x, y, facecolor="#eeeeee", edgecolor="#555555", linewidth=1, label=label, zorder=0.5)
        patch.set_hatch("///")
        patch.set_hatch_linewidth(0.4)
        return self._explained(f"; area: {plain_words(label)}")

    def line(self, x: Values, y: Values, label: str, role: str | int = 0) -> Self:
        """Add a curve, as a limit of stability over a map; look as in `plane_plot`. Returns the plot itself.

        >>> plane_plot({"limit": ([1, 2], [2, 1])}, "$x$", "$y$").line([1, 2], [1, 2], "diagonal", role=1)
        <limit: y against x; line: diagonal>
        """
        look = ROLES[role] if role in ROLES else response_look(role)
        self.axes.plot(x, y, label=label, scalex=False, scaley=False, **look)
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
        look = {"color": "#000000", "markersize": 6 if mark == "o" else 8, "markeredgewidth": 1.6, "zorder": 4}
        self.axes.plot(x, y, mark, label=label, linestyle="", scalex=False, scaley=False, **look)
        return self._explained(f"; points: {plain_words(label)}")

    def text(self, x: float, y: float, words: str) -> Self:
        """Write words around a point of the plane. Returns the plot itself.

        >>> plane_plot({"limit": ([1, 2], [2, 1])}, "$x$", "$y$").text(1.5, 1.8, "unstable")
        <limit: y against x; unstable>
        """
        import matplotlib

        white = {"facecolor": "white", "edgecolor": "none", "alpha": 0.85, "pad": 1.5}
        with matplotlib.rc_context(STYLE):
            self.axes.text(x, y, words, ha="center", va="center", zorder=5, bbox=white)
        self.alt += f"; {plain_words(words)}"
        return self

    def _explained(self, words):
        import matplotlib

        with matplotlib.rc_context(STYLE):
            add_legend(self.axes, may_grow=False)
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
) -> PlanePlot:
    """Plot curves in a plane: limits of stability, frequency responses in the complex plane.

    Arguments:
        curves: ``{label: (x, y)}`` with arrays of equal length; a curve may turn back, and is broken at a NaN. A third
            item, a role or a number as in `time_plot`, gives it that look; by itself, curve after curve has its own.
        xlabel, ylabel: names of the axes with their units.
        title: stands above the plot; begins with the name of the book's figure where there is one.
        xlim, ylim: lowest and highest value of an axis.
        log: logarithmic axes.
        equal: one unit is as long on both axes, as for complex numbers; then both axes are drawn at zero.
    Returns:
        A `PlanePlot`, which a notebook shows as the value of a cell; `.area`, `.points` and `.text` add to it.
    Raises:
        ValueError: for no curve, or unequal lengths.

    >>> plane_plot({"limit": ([1, 2, 3], [3, 2, 1])}, "gain ratio", "delay ratio", "Figure 2")
    <Figure 2: limit: delay ratio against gain ratio>
    """
    import matplotlib
    import numpy
    from matplotlib.figure import Figure

    if not isinstance(curves, dict) or not curves:
        raise ValueError(f"the curves are {curves!r}: expected {{label: (x, y)}} with at least one")
    with matplotlib.rc_context(STYLE):
        figure = Figure(figsize=(WIDTH, 0.68 * WIDTH if not equal else 0.8 * WIDTH), layout="constrained")
        axes = figure.subplots()
        for number, (label, (x, y, *look)) in enumerate(curves.items()):
            x, y = numpy.asarray(x, dtype=float), numpy.asarray(y, dtype=float)
            if x.shape != y.shape:
                raise ValueError(f"{label} has {x.size} values for x and {y.size} for y: expected as many")
            role = look[0] if look else number
            axes.plot(x, y, label=label, **(ROLES[role] if role in ROLES else response_look(role)))
        if log:
            _logarithmic(axes)
        _finish_plane(axes, xlabel, ylabel, title, xlim, ylim)
        if equal:
            axes.set_aspect("equal")
            axes.axhline(0, color="#555555", linewidth=0.8, zorder=1)
            axes.axvline(0, color="#555555", linewidth=0.8, zorder=1)
        if len(curves) > 1:
            add_legend(axes, may_grow=False)
    shown = ", ".join(map(plain_words, curves))
    words = f"{shown}: {plain_words(ylabel)} against {plain_words(xlabel)}"
    return PlanePlot(figure, f"{plain_words(title) + ': ' if title else ''}{words}")


def map_plot(
    x: Values,
    y: Values,
    numbers: ArrayLike,
    xlabel: str,
    ylabel: str,
    label: str,
    title: str | None = None,
    log: bool = False,
) -> PlanePlot:
    """Plot whole numbers on a grid as shades of grey, white for 0, with a scale: a map of unstable poles, for example.

    Arguments:
        x, y: the values along the two axes, increasing arrays.
        numbers: an integer array with a row for each y and a column for each x; a negative one is drawn as 0.
        xlabel, ylabel: names of the axes with their units.
        label: what the numbers are.
        title, log: as in `plane_plot`.
    Returns:
        A `PlanePlot`.
    Raises:
        ValueError: for an array of another shape.

    >>> map_plot([1, 2], [1, 2, 3], [[0, 0], [0, 2], [2, 4]], "$K_p$", "$T_i$ [s]", "unstable poles")
    <unstable poles (0 to 4): T_i [s] against K_p>
    """
    import matplotlib
    import numpy
    from matplotlib.figure import Figure

    x, y, numbers = _on_grid(x, y, numbers)
    levels = sorted({int(n) for n in numpy.unique(numbers)} | {0})
    levels = [n for n in levels if n >= 0]
    shade = numpy.searchsorted(levels, numpy.maximum(numbers, 0))
    greys = [
        "#ffffff",
        *(matplotlib.colors.to_hex(str(g)) for g in numpy.linspace(0.82, 0.35, max(len(levels) - 1, 1))),
    ]
    colours = matplotlib.colors.ListedColormap(greys[: len(levels)])
    with matplotlib.rc_context(STYLE):
        figure = Figure(figsize=(WIDTH, 0.68 * WIDTH), layout="constrained")
        axes = figure.subplots()
        mesh = axes.pcolormesh(
            x, y, shade, cmap=colours, vmin=-0.5, vmax=len(levels) - 0.5, shading="nearest", rasterized=True
        )
        axes.grid(False)
        scale = figure.colorbar(mesh, ax=axes, ticks=range(len(levels)), label=label)
        scale.ax.set_yticklabels(levels)
        if log:
            _logarithmic(axes)
        _finish_plane(axes, xlabel, ylabel, title, (x[0], x[-1]), (y[0], y[-1]))
    words = f"{plain_words(label)} ({levels[0]} to {levels[-1]}): {plain_words(ylabel)} against {plain_words(xlabel)}"
    return PlanePlot(figure, f"{plain_words(title) + ': ' if title else ''}{words}")


def level_plot(
    x: Values,
    y: Values,
    values: ArrayLike,
    levels: Sequence[float] | numpy.ndarray,
    xlabel: str,
    ylabel: str,
    label: str,
    title: str | None = None,
    log: bool = False,
) -> PlanePlot:
    """Plot lines of equal value over a plane, with the value written on each: a criterion over two settings.

    Arguments:
        x, y: the values along the two axes, increasing arrays.
        values: an array with a row for each y and a column for each x; what is not finite is left out.
        levels: increasing values, those of the lines.
        xlabel, ylabel: names of the axes with their units.
        label: what the values are.
        title, log: as in `plane_plot`.
    Returns:
        A `PlanePlot`.
    Raises:
        ValueError: for an array of another shape.

    >>> import numpy
    >>> x = y = numpy.array([1.0, 2.0, 3.0])
    >>> level_plot(x, y, numpy.outer(y, x), [2, 4, 6], "$K_p$", "$T_i$ [s]", "ISE")
    <levels of ISE, 2 to 6: T_i [s] against K_p>
    """
    import matplotlib
    import numpy
    from matplotlib.figure import Figure

    x, y, values = _on_grid(x, y, values)
    with matplotlib.rc_context(STYLE):
        figure = Figure(figsize=(WIDTH, 0.68 * WIDTH), layout="constrained")
        axes = figure.subplots()
        finite = numpy.ma.masked_invalid(values)
        lines = axes.contour(x, y, finite, levels, colors=RESPONSE_COLOURS[0], linewidths=1.3)
        axes.clabel(lines, fmt="%g", fontsize=9, colors="#000000")
        if log:
            _logarithmic(axes)
        _finish_plane(axes, xlabel, ylabel, title, (x[0], x[-1]), (y[0], y[-1]))
    words = f"levels of {plain_words(label)}, {levels[0]:g} to {levels[-1]:g}"
    words = f"{words}: {plain_words(ylabel)} against {plain_words(xlabel)}"
    return PlanePlot(figure, f"{plain_words(title) + ': ' if title else ''}{words}")


def _on_grid(x, y, values):
    """The arrays of two axes and of the values over them, if they fit."""
    import numpy

    x, y, values = (numpy.asarray(array, dtype=float) for array in (x, y, values))
    if values.shape != (len(y), len(x)):
        raise ValueError(f"the values have the shape {values.shape}: expected {(len(y), len(x))}, a row for each y")
    return x, y, values


def _finish_plane(axes, xlabel, ylabel, title, xlim, ylim):
    axes.set_xlabel(xlabel)
    axes.set_ylabel(ylabel)
    axes.set_title(title or "")
    axes.set_xlim(xlim or axes.get_xlim())
    axes.set_ylim(ylim or axes.get_ylim())


def _logarithmic(axes):
    """Logarithmic axes with ordinary numbers on them."""
    from matplotlib.ticker import LogLocator, NullFormatter, StrMethodFormatter

    for axis, scale in ((axes.xaxis, axes.set_xscale), (axes.yaxis, axes.set_yscale)):
        scale("log")
        axis.set_major_locator(LogLocator(subs=(1, 2, 5)))
        axis.set_major_formatter(StrMethodFormatter("{x:g}"))
        axis.set_minor_formatter(NullFormatter())


def add_legend(axes: Axes, may_grow: bool, columns: int = 1) -> None:
    """A legend where it hides no curve; if there is no such place, a flat one above them, for which the panel grows."""
    if axes.get_legend() and axes.get_legend().get_gid() == BELOW:
        legend_below(axes)
        return
    if any(type(drawn).__name__ == "QuadMesh" for drawn in axes.collections):
        axes.legend(loc="upper right")  # the search for a free place would go through every cell of a map
        return
    if not may_grow:
        axes.legend(ncols=columns)
        return
    box = _legend_box(axes)
    hides = any(line.get_path().transformed(axes.transData).intersects_bbox(box, filled=False) for line in axes.lines)
    if hides:
        columns = len(axes.lines)
        while columns > 1 and _legend_box(axes, ncols=columns).width > 0.95 * axes.bbox.width:
            columns -= 1
        box, scale = _legend_box(axes, ncols=columns, loc="upper right"), axes.yaxis.get_transform()
        low, high = scale.transform(axes.get_ylim())
        high += 1.1 * (high - low) * box.height / (axes.bbox.height - box.height)
        axes.set_ylim(scale.inverted().transform([low, high]))


def legend_below(axes: Axes, columns: int = 2) -> None:
    """A legend under the axes, where a picture has no empty corner; what is added later is explained there, too."""
    axes.legend(loc="upper center", bbox_to_anchor=(0.5, -0.13), ncols=columns).set_gid(BELOW)


def _legend_box(axes, **options):
    legend = axes.legend(**options)
    axes.figure.draw_without_rendering()
    return legend.get_window_extent()


def decades(axis: Axis, low: float, high: float) -> None:
    """Ordinary numbers on a logarithmic axis from `low` to `high`: powers of ten, or 1, 2 and 5 where it is short."""
    from matplotlib.ticker import FuncFormatter, LogLocator, NullFormatter

    long = high / low > 300
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
                bbox={"facecolor": "white", "edgecolor": "none", "alpha": 0.85, "pad": 1},
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


def response_look(number: int) -> dict[str, Any]:
    """Return colour, kind and width of the line for response `number` (0, 1, 2 ...) that has no role of its own.

    >>> response_look(0)["color"], response_look(1)["linestyle"]
    ('#009E73', (0, (7, 2)))
    """
    colour = RESPONSE_COLOURS[number % len(RESPONSE_COLOURS)]
    return {"color": colour, "linestyle": RESPONSE_LINES[number % len(RESPONSE_LINES)], "linewidth": 1.8}


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


def _increasing(times):
    import numpy

    try:
        times = numpy.asarray(times, dtype=float)
    except (TypeError, ValueError):
        times = numpy.empty(0)
    if times.ndim != 1 or len(times) < 2 or not (numpy.diff(times) > 0).all():
        raise ValueError("times must be an array of two or more increasing numbers")
    return times


def _curve(label, what, times, before):
    """The points of a line, and its role."""
    import numpy

    with_role = isinstance(what, tuple) and len(what) == 2 and isinstance(what[1], (str, int))
    signal, role = what if with_role else (what, None)
    if isinstance(role, str) and role not in ROLES:
        raise ValueError(f"{label} has the unknown role {role!r}: the roles are {', '.join(ROLES)}")
    if isinstance(signal, (sympy.Expr, numbers.Real)):
        signal = sympy.sympify(signal)
        evaluate(signal, times[:1])  # says what is wrong with the expression before its steps are looked for
        times = _with_edges(signal, times)
        values = evaluate(signal, times)
    else:
        try:
            values = numpy.asarray(list(signal), dtype=float)
        except (TypeError, ValueError):
            raise ValueError(f"{label} must be a SymPy expression in t or an array of numbers") from None
        if values.shape != times.shape:
            raise ValueError(f"{label} has {values.size} values for {times.size} times")
    if before:
        times, values = numpy.r_[-before, 0, times], numpy.r_[0, 0, values]
    return times, values, role


def _with_edges(signal, times):
    """The times, with two more around every late step, so that the step is drawn upright and not between two times."""
    import numpy

    moments = {float(moment) for step in signal.atoms(sympy.Heaviside) for moment in sympy.solve(step.args[0], t)}
    shortest = 1e-9 * (times[-1] - times[0])
    edges = [moment + side for moment in moments for side in (-shortest, shortest) if times[0] < moment < times[-1]]
    return numpy.unique(numpy.r_[times, edges])
