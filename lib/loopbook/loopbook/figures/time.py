"""Signals against time: in one panel or several, with points and levels marked; loops as an operator sees them."""

from __future__ import annotations

import numbers
from collections.abc import Collection, Mapping, Sequence
from typing import TYPE_CHECKING, Protocol, Self, TypeAlias

import numpy as np
import sympy

from loopbook.figures import canvas
from loopbook.figures.labels import add_legend, free_legend, free_place, make_room
from loopbook.figures.picture import Picture, titled
from loopbook.figures.style import EVENT, GUIDE, INPUTS, LEVEL, ON_WHITE, ZERO, look, pale, styled
from loopbook.laplace import evaluate, t
from plainmath.tables import plain_words
from plainmath.validation import did_you_mean, increasing, one_of

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.lines import Line2D

    from loopbook.figures.canvas import OwnAxes
    from loopbook.types import Limits, Number, Signal, Values

#: A signal in a plot; in a pair with its role, or with the number of a response, where it has its look.
Drawn: TypeAlias = "Signal | tuple[Signal, str | int]"


class Recorded(Protocol):
    """What `trends` draws: a `simulation.Run`, a `loops.LoopResponse`, or what has their signals."""

    @property
    def times(self) -> np.ndarray:
        """The moments."""

    @property
    def time_unit(self) -> str:
        """The unit of the moments."""

    @property
    def signals(self) -> Mapping[str, np.ndarray]:
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

    def __getitem__(self, name: str, /) -> np.ndarray:
        """A signal by its name."""

    def unit(self, name: str, /) -> str:
        """The unit of a signal."""


class TimePlot(Picture):
    """What `time_plot` returns: a picture of signals against time, on which points and levels can be marked."""

    def __init__(self, axes: Sequence[Axes], alt: str, lines: dict[str, Line2D]):
        super().__init__(axes[0].figure.canvas.figure, alt)
        self.axes = axes  # from the top down
        self.lines = lines  # {label: matplotlib line}

    def mark(self, time: Number, label: str, signal: str | None = None) -> Self:
        """Mark the point where a curve is at `time`: a dot, dashed guides to both axes, and a label.

        The point is on the line as it is drawn: a signal that is held has its last value, and its new one at a step.

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
        line = self._line(signal)
        axes, (times, values) = line.axes, _corners(line)
        time = float(time)
        if not times[0] <= time <= times[-1]:
            raise ValueError(f"cannot mark t = {time:g}: the plot shows {times[0]:g} to {times[-1]:g}")
        value = np.interp(time, times, values)
        (left, right), (bottom, top) = axes.get_xlim(), axes.get_ylim()
        # The guides run on beyond the frame, which cuts them off wherever it comes to lie.
        axes.plot([time, time], [value, bottom - 2 * (top - bottom)], **GUIDE)
        axes.plot([time, left - (right - left)], [value, value], **GUIDE)
        axes.plot(time, value, "o", color=line.get_color(), markersize=6, zorder=4)

        # A rising curve leaves room below it on the right and above it on the left; a falling one the other way.
        on_right = time < left + 0.6 * (right - left)
        ahead = np.interp(time + 0.05 * (right - left) * (1 if on_right else -1), times, values)
        above = ahead < value if on_right else ahead <= value
        with styled():
            axes.annotate(
                label, (time, value), (9 if on_right else -9, 5 if above else -5), textcoords="offset points",
                ha="left" if on_right else "right", va="bottom" if above else "top", zorder=5,
                bbox=ON_WHITE,
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
        axes.axhline(value, **LEVEL)
        bottom, top = axes.get_ylim()
        room = 0.2 * (max(top, value) - min(bottom, value))
        curve = line.get_ydata()
        below = curve[-len(curve) // 5 :].mean() > value  # the curve comes down to the level
        axes.set_ylim(min(bottom, value - room / (1 if below else 2)), max(top, value + room / (2 if below else 1)))
        with styled():
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
        with styled():
            free_legend(axes)
        self.alt += f"; points: {plain_words(label)}"
        return self

    def area(self, signal: str, other: str | Number = 0, label: str = "") -> Self:
        """Shade what lies between a curve and another one, or a level, and name it where it is widest.

        Arguments:
            signal: label of the curve.
            other: label of a curve in the same panel, as "setpoint"; or a number.
            label: words on the shaded area; mathematics between dollar signs.
        Returns:
            The plot itself, so that it can stand last in a cell.
        Raises:
            ValueError: for a label that no curve has, or curves in two panels.

        >>> from loopbook.laplace import t
        >>> plot = time_plot({"setpoint": (1, "setpoint"), "$y$": (1 - sympy.exp(-t), "measurement")}, range(6))
        >>> plot.area("$y$", "setpoint", "integral of the error")
        <setpoint, y against t [s]; shaded: integral of the error>
        """
        line = self._line(signal)
        axes, (times, values) = line.axes, _corners(line)
        level = np.full(len(times), 0.0 if isinstance(other, str) else float(other))
        if isinstance(other, str):
            reference = self._line(other)
            if reference.axes is not axes:
                raise ValueError(f"{signal} and {other} are in two panels: expected them in one")
            there = _corners(reference)
            times, values, level = _on_common_times(times, values, *there)
        low, high = axes.get_ylim()
        tint = pale(line.get_color())
        axes.fill_between(times, values, level, facecolor=tint, linewidth=0, zorder=0.6, interpolate=True)
        axes.set_ylim(min(low, level.min()), max(high, level.max()))
        if label:
            widest = int(np.argmax(abs(values - level)))
            with styled():
                free_place(axes, label, (times[widest], (values[widest] + level[widest]) / 2), ("right", "left"))
        self.alt += f"; shaded: {plain_words(label)}" if label else ""
        return self

    def event(self, time: Number, label: str) -> Self:
        """Draw a thin upright line through all panels where something happens, with a few words at its top.

        Arguments:
            time: in the unit of the time axis.
            label: what happens; mathematics between dollar signs.
        Returns:
            The plot itself, so that it can stand last in a cell.
        Raises:
            ValueError: for a time outside the plot.

        >>> from loopbook.laplace import t
        >>> time_plot({"$y$": 1 - sympy.exp(-t)}, range(6)).event(2, "load")
        <y against t [s]; at 2: load>
        """
        time, top = float(time), self.axes[0]
        first, last = top.get_xlim()
        if not first <= time <= last:
            raise ValueError(f"cannot mark t = {time:g}: the plot shows {first:g} to {last:g}")
        for axes in self.axes:
            axes.vlines(time, 0, 1, transform=axes.get_xaxis_transform(), **EVENT)
        on_right = time < first + 0.75 * (last - first)
        with styled():
            words = top.annotate(
                label, (time, 1), (3 if on_right else -3, -2), xycoords=("data", "axes fraction"),
                textcoords="offset points", ha="left" if on_right else "right", va="top", zorder=5, bbox=ON_WHITE,
            )  # fmt: skip
        words.set_gid("event")
        for other in (text for text in top.texts if text.get_gid() == "event"):  # the legend may have moved there
            legend = top.get_legend()
            if legend and (box := legend.get_window_extent()).overlaps(other.get_window_extent()):
                other.xyann = (other.xyann[0], -2 - (top.bbox.y1 - box.y0) * 72 / self.figure.dpi)
        make_room(top, words, 1)
        self.alt += f"; at {time:g}: {plain_words(label)}"
        return self

    def _line(self, label):
        if label is None:
            return next(iter(self.lines.values()))
        if label not in self.lines:
            raise ValueError(f"no signal {label!r} in this plot: {did_you_mean(label, self.lines)}")
        return self.lines[label]


def _corners(line):
    """The times and values between which a line is straight, of one that is held, too."""
    from matplotlib.cbook import STEP_LOOKUP_MAP

    return STEP_LOOKUP_MAP[line.get_drawstyle()](line.get_xdata(), line.get_ydata())


def _on_common_times(times, values, other_times, others):
    """All times of two lines, with the values of both there; where one is upright it keeps its two values."""
    if np.array_equal(times, other_times):
        return times, values, others
    all_times = np.unique(np.r_[times, np.nextafter(times, -np.inf), other_times, np.nextafter(other_times, -np.inf)])
    all_times = all_times[(all_times >= max(times[0], other_times[0])) & (all_times <= min(times[-1], other_times[-1]))]
    return all_times, np.interp(all_times, times, values), np.interp(all_times, other_times, others)


def time_plot(
    signals: Mapping[str, Drawn] | Sequence[Mapping[str, Drawn]],
    times: Values,
    title: str | None = None,
    xlabel: str = "$t$ [s]",
    ylabel: str | Sequence[str | None] | None = None,
    ylim: Limits | list[Limits | None] | None = None,
    before: float = 0,
    low: bool = False,
    error_from: str | None = None,
    ax: OwnAxes = None,
) -> TimePlot:
    """Plot signals against time, in one panel or in several above one another with a common time axis.

    Arguments:
        signals: ``{label: signal}``, or a list of these, one a panel from the top down. A signal is a SymPy expression
            in `t`, a number, or an array with one value for each time; ``(signal, role)`` gives it the colour of its
            role: "setpoint", "measurement", "control signal" or "disturbance", "raw" for what is filtered (thin and
            grey), "process", "model", "second model" and "third model", or a number 0, 1, 2 ... for that of a
            response. Labels may hold mathematics between dollar signs. A panel with one input and nothing else is half
            as high as the others.
        times: increasing times, in the unit that `xlabel` says.
        title: written above the plot; begins with the name of the book's figure where there is one.
        xlabel, ylabel: names of the axes with their units; `ylabel` is a list where there are several panels. A panel
            with one signal takes the signal's label if no `ylabel` is given.
        ylim: lowest and highest value of the top panel's axis, where it must not follow the signals, as under a slider;
            or a list of these, one for each panel, with None where the axis follows the signals.
        before: how much time to show ahead of t = 0, with every signal at zero, so that a step at t = 0 is seen.
        low: make it less high, and flat the legend under a given `ylim`, where a chapter has many figures.
        error_from: label of a curve in the first panel from which the others there hardly differ; a panel below shows
            by how much they do.
        ax: axes of matplotlib to draw into, in place of a new figure, as many as there are panels.
    Returns:
        A `TimePlot`, which a notebook shows as the value of a cell; ``.mark``, ``.level``, ``.points``, ``.area`` and
            ``.event`` add to it.
    Raises:
        ValueError: for times that do not increase, a signal that is neither expression nor array or has another length
            than the times, an unknown role, a label used twice, or an expression with symbols besides `t`.

    >>> from loopbook.laplace import t
    >>> time_plot([{"$y(t)$": 2 * t}, {"$u(t)$": (1, "control signal")}], range(11), title="Figure 6.1", before=1)
    <Figure 6.1: y(t); u(t) against t [s]>

    A process and its model, with the difference below:

    >>> curves = {"process": (1 - sympy.exp(-t), "process"), "model": (1 - 0.99 * sympy.exp(-t), "model")}
    >>> time_plot(curves, range(6), error_from="process")
    <process, model; difference from process against t [s]>
    """
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
    times = increasing("times", times, least=2)
    if before < 0 or (before and times[0] != 0):
        raise ValueError("time before t = 0 can be shown only in front of times that start at 0, and is not negative")
    curves = [{label: _curve(label, what, times, before) for label, what in panel.items()} for panel in panels]
    if error_from is not None and (error_from not in panels[0] or len(panels[0]) < 2):
        raise ValueError(f"the errors are from {error_from!r}: expected one of several curves of the first panel")
    labels = [label for panel in panels for label in panel]
    if len(set(labels)) < len(labels):
        raise ValueError(f"two signals have the same label: {', '.join(labels)}")

    inputs = [len(panel) == 1 and all(role in INPUTS for *_, role in panel.values()) for panel in curves]
    heights = [1 if only_input and len(panels) > 1 else 2 for only_input in inputs]
    with styled():
        unit = 0.8 if low else 1.0
        if error_from is not None:
            heights.insert(1, 1)
        figure, grid = canvas.panels([unit * height for height in heights], ax)
        panes = [*grid]
        of_error = grid.pop(1) if error_from is not None else None
        lines, looks = {}, {}
        number = 0
        for axes, panel, name, fixed in zip(grid, curves, ylabels, fixed_axes, strict=True):
            for label, (x, y, role) in panel.items():
                number += role is None
                looks[label] = look(number - 1 if role is None else role)
                (lines[label],) = axes.plot(x, y, label=label, **looks[label])
            axes.set_ylabel(name or (label if len(panel) == 1 else ""))
            # from here on, what is marked does not move the curves
            axes.set_ylim(fixed or axes.get_ylim())
        if of_error is not None:
            _errors(of_error, lines, error_from, {label: looks[label] for label in curves[0]})
        grid[0].set_xlim(times[0] - before, times[-1])
        panes[-1].set_xlabel(xlabel)
        grid[0].set_title(title or "")
        figure.align_ylabels(panes)
        explained = set()
        for axes, panel, fixed in zip(grid, curves, fixed_axes, strict=True):
            responses = [{(role, word.strip()) for word in label.split(",")} for label, (*_, role) in panel.items()]
            # "u, PI" below "y, PI", "PI, load" below "PI": the same responses in the same looks need no second legend
            numbered = all(isinstance(role, int) for *_, role in panel.values())
            if len(panel) > 1 and not (numbered and all(map(explained.intersection, responses))):
                if fixed:
                    add_legend(axes, columns=3 if low else 1)
                else:
                    free_legend(axes)
            explained = explained.union(*responses)
    shown = [", ".join(map(plain_words, panel)) for panel in panels]
    if error_from is not None:
        shown.insert(1, f"difference from {plain_words(error_from)}")
    shown = "; ".join(shown)
    return TimePlot(panes, titled(title, f"{shown} against {plain_words(xlabel)}"), lines)


def _errors(axes, lines, reference, looks):
    """The differences of curves from one of them, each in its look."""
    times, values = lines[reference].get_data()
    axes.axhline(0, **ZERO)
    for label in looks:
        if label != reference:
            at, here, there = _on_common_times(*lines[label].get_data(), times, values)
            (lines[f"{label}, error"],) = axes.plot(at, here - there, **looks[label])
    axes.set_ylabel("error")


def _curve(label, what, times, before):
    """The points of a line, and its role."""
    with_role = isinstance(what, tuple) and len(what) == 2 and isinstance(what[1], (str, int))
    signal, role = what if with_role else (what, None)
    if isinstance(signal, (sympy.Expr, numbers.Real)):
        signal = sympy.sympify(signal)
        evaluate(signal, times[:1])  # says what is wrong with the expression before its steps are looked for
        times = _with_edges(signal, times)
        values = evaluate(signal, times)
    else:
        try:
            values = np.asarray(list(signal), dtype=float)
        except (TypeError, ValueError):
            raise ValueError(f"{label} must be a SymPy expression in t or an array of numbers") from None
        if values.shape != times.shape:
            raise ValueError(f"{label} has {values.size} values for {times.size} times")
    if before:
        times, values = np.r_[-before, 0, times], np.r_[0, 0, values]
    return times, values, role


def _with_edges(signal, times):
    """The times, with two more around every late step, so that the step is drawn upright and not between two times."""
    moments = {float(moment) for step in signal.atoms(sympy.Heaviside) for moment in sympy.solve(step.args[0], t)}
    shortest = 1e-9 * (times[-1] - times[0])
    edges = [moment + side for moment in moments for side in (-shortest, shortest) if times[0] < moment < times[-1]]
    return np.unique(np.r_[times, edges])


#: How many of a unit of time make a minute.
IN_A_MINUTE = {"s": 60, "min": 1, "h": 1 / 60, "d": 1 / 1440}


def times_of(run: Recorded, minutes: bool) -> tuple[np.ndarray, str]:
    """Return the times of a run and their unit: the run's own, or minutes.

    Raises ValueError for a unit of which it is not known how many make a minute.
    """
    if not minutes:
        return run.times, run.time_unit
    return run.times / IN_A_MINUTE[one_of("the run's unit of time", run.time_unit, IN_A_MINUTE)], "min"


def trends(
    runs: Recorded | Mapping[str, Recorded],
    title: str | None = None,
    disturbances: Sequence[str] = (),
    measured: bool = False,
    minutes: bool = False,
    limits: Limits | None = None,
    control_limits: Limits | None = None,
    ax: OwnAxes = None,
) -> TimePlot:
    """Plot loops as an operator sees them: setpoint and measurement above, control signal below.

    Arguments:
        runs: a `simulation.Run` or a `loops.LoopResponse`, or ``{label: run}`` for several with the same times and
            the same setpoint.
        title: written above the plot; begins with the name of the book's figure where there is one.
        disturbances: names of inputs of the plant, each shown in a panel of its own below the others.
        measured: show the noisy measurement instead of the plant's output.
        minutes: write the time in minutes, whatever the unit of the runs is.
        limits, control_limits: lowest and highest value of the upper panel's axis, and of the control signal's, where
            they must not follow the signals.
        ax: axes of matplotlib to draw into, in place of a new figure, as many as there are panels.
    Returns:
        A `TimePlot`, which a notebook shows as the value of a cell.
    Raises:
        ValueError: for runs with different times or units of time, or a signal that they do not have.

    >>> from loopbook.pid import PID, Controller
    >>> from loopbook.plants import HeatedTank
    >>> from loopbook.simulation import simulate
    >>> controller = Controller(PID(2000, Ti=300), step=10, u0=10000)
    >>> trends(simulate(HeatedTank(), controller, until=1000, setpoint=31), "A warmer tank")
    <A warmer tank: setpoint, T; P against t [s]>
    """
    runs = runs if isinstance(runs, dict) else {"": runs}
    if not runs or not all(hasattr(run, "signals") for run in runs.values()):
        raise ValueError("expected a run, or {label: run} with one run or more")
    if isinstance(disturbances, str):
        raise ValueError(f"disturbances is {disturbances!r}: expected a list of names")
    first = next(iter(runs.values()))
    for run in runs.values():
        if not np.array_equal(run.times, first.times):
            raise ValueError("the runs have different times: expected the same step and the same end")
        if run.time_unit != first.time_unit:
            raise ValueError(f"the runs have times in {first.time_unit} and in {run.time_unit}: expected one unit")
        for name in ("setpoint", *disturbances):
            if name in first.signals and not np.array_equal(run[name], first[name], equal_nan=True):
                raise ValueError(f"the runs have different signals {name!r}: expected the same in all")
    output, control = first.output, first.manipulated
    source = "measurement" if measured else output

    def curves(name, signal, role):
        symbol = f"${sympy.latex(sympy.Symbol(name))}$"
        if len(runs) == 1:
            return {symbol: (first[signal], role)}
        return {f"{symbol}, {label}": (run[signal], n) for n, (label, run) in enumerate(runs.items())}

    top = {"setpoint": (first["setpoint"], "setpoint")} if "setpoint" in first.signals else {}
    panels = [top | curves(output, source, "measurement"), curves(control, control, "control signal")]
    panels += [{f"${sympy.latex(sympy.Symbol(x))}$": (first[x], "disturbance")} for x in disturbances]
    names = [f"${sympy.latex(sympy.Symbol(x))}$ [{first.unit(x)}]" for x in (output, control, *disturbances)]
    ylim = [limits, control_limits, *(None for _ in disturbances)]
    times, unit = times_of(first, minutes)
    plot = time_plot(panels, times, title=title, xlabel=f"$t$ [{unit}]", ylabel=names, ylim=ylim, ax=ax)
    for panel, name in zip(panels, (output, control, *disturbances), strict=True):
        for label in panel:
            if ("setpoint" if label == "setpoint" else name) in first.held:
                plot.lines[label].set_drawstyle("steps-post")
    return plot
