"""Figures of a run under sequential control: analogue signals, what is on and off, and the active steps."""

from __future__ import annotations

from collections.abc import Collection, Mapping, Sequence
from typing import Any, Protocol

import numpy as np
import sympy

from loopbook.figures import canvas
from loopbook.figures.canvas import OwnAxes
from loopbook.figures.picture import titled
from loopbook.figures.style import DOTS_PER_INCH, WIDTH, look, styled
from loopbook.figures.time import Recorded, TimePlot, times_of

ROW = 0.24  # inches, of a signal that is on or off and of a step
BAR = 0.62  # height of a bar in its row


class Charted(Protocol):
    """The chart of a run, a `sequence.Chart` or what has its steps and outputs."""

    @property
    def tag(self) -> str:
        """What the names of its steps in a run begin with."""

    @property
    def steps(self) -> Collection[str]:
        """The names of the steps; the signal ``tag.step`` of a run is 1 while the step is active."""

    @property
    def outputs(self) -> Mapping[str, Any]:
        """The signals that it sets by their names, with what they are at the beginning."""


def sequence_trends(
    run: Recorded,
    chart: Charted,
    signals: Sequence[str | tuple[str, str]],
    on_off: Sequence[str] | None = None,
    title: str | None = None,
    minutes: bool = False,
    ax: OwnAxes = None,
) -> TimePlot:
    """Plot a run as the screen of a batch plant shows it: trends above, below them bars for what is on and active.

    Arguments:
        run: a `simulation.Run` with the chart among its blocks.
        chart: the `sequence.Chart`.
        signals: names of analogue signals, each for a panel; ("T", "T_SP") shows a measurement and its setpoint in one.
        on_off: names of the signals that are 0 or 1; the boolean outputs of the chart if not given.
        title: written above the plot; begins with the name of the book's figure where there is one.
        minutes: write the time in minutes, whatever the unit of the run is.
        ax: axes of matplotlib to draw into, in place of a new figure, as many as there are panels.
    Returns:
        A `figures.TimePlot`, which a notebook shows as the value of a cell.
    Raises:
        ValueError: for what is no run or chart, a signal that the run does not have, or one among `on_off` that has
            other values than 0 and 1.

    >>> from loopbook.plants import BatchTank
    >>> from loopbook.sequence import Chart, Transition
    >>> from loopbook.simulation import simulate
    >>> chart = Chart("h", {"u_valve_in": False}, {"Fill": {"u_valve_in": True}, "Full": {"u_valve_in": False}}, "Fill",
    ...               [Transition("Fill", "Full", "h > 0.9")], final="Full")
    >>> sequence_trends(simulate(BatchTank(), [chart], until=240, step=2), chart, ["h"], title="Filling")
    <Filling: h; on and off: u_valve_in; active steps: Fill, Full against t [s]>
    """
    signals, on_off = _checked(run, chart, signals, on_off)
    rows = [group for group in (on_off, [*chart.steps]) if group]
    times, unit = times_of(run, minutes)
    heights = [1.05] * len(signals) + [ROW * len(group) + 0.2 for group in rows]
    lines = {}
    with styled():
        figure, grid = canvas.panels(heights, ax)
        for axes, names in zip(grid, signals, strict=False):
            lines |= _trend(axes, run, times, names)
        for axes, group in zip(grid[len(signals) :], rows, strict=True):
            steps = group is not on_off
            active = [run[f"{chart.tag}.{name}"] if steps else run[name] for name in group]
            _bars(axes, times, group, active, "black" if steps else look("control signal")["color"])
            axes.set_ylabel("active step" if steps else "on")
        grid[-1].set_xlim(times[0], times[-1])
        grid[-1].set_xlabel(f"$t$ [{unit}]")
        grid[0].set_title(title or "")
        figure.align_ylabels(grid)
    shown = [", ".join(name for names in signals for name in names)] * bool(signals)
    shown += [f"on and off: {', '.join(on_off)}"] * bool(on_off) + [f"active steps: {', '.join(chart.steps)}"]
    words = f"{'; '.join(shown)} against t [{unit}]"
    return TimePlot(grid, titled(title, words), lines)


def _checked(run, chart, signals, on_off):
    """The names in lists, if the run has them all."""
    if not hasattr(run, "signals"):
        raise ValueError(f"the run is {run!r}: expected what simulate returns")
    if not hasattr(chart, "steps"):
        raise ValueError(f"the chart is {chart!r}: expected a sequence.Chart")
    for what, group in (("signals", signals), ("on_off", on_off)):
        if not isinstance(group, (list, tuple)) and not (what == "on_off" and group is None):
            raise ValueError(f"{what} is {group!r}: expected a list of names")
    panels = [(names,) if isinstance(names, str) else tuple(names) for names in signals]
    if odd := [names for names in panels if len(names) not in (1, 2)]:
        raise ValueError(f"a panel has {odd[0]!r}: expected a name, or a measurement and its setpoint")
    if on_off is None:
        on_off = [name for name, value in chart.outputs.items() if isinstance(value, bool)]
    for name in (*(name for names in panels for name in names), *(f"{chart.tag}.{step}" for step in chart.steps)):
        run[name]  # says what is missing
    for name in on_off:
        if not set(run[name]) <= {0, 1}:
            raise ValueError(f"{name} has other values than 0 and 1: expected it among the signals")
    return panels, list(on_off)


def _trend(axes, run, times, names):
    """Draw a measurement, with its setpoint, or what a controller sets; the lines by their names."""
    from matplotlib.ticker import MaxNLocator

    lines = {}
    symbol = f"${sympy.latex(sympy.Symbol(names[0]))}$"
    for name, role in zip(names, ("measurement", "setpoint"), strict=False):
        held = name in run.held
        role = "control signal" if held and role == "measurement" else role
        (lines[name],) = axes.plot(times, run[name], drawstyle="steps-post" if held else "default", **look(role))
    low, high = axes.get_ylim()
    ticks = MaxNLocator(4, steps=[1, 2, 2.5, 5, 10]).tick_values(low, high)
    axes.set_yticks([tick for tick in ticks if low <= tick <= high])
    axes.set_ylabel(f"{symbol} [{run.unit(names[0])}]")
    if len(names) == 2:
        axes.legend(lines.values(), (symbol, "setpoint"), ncols=2)
    return lines


def _bars(axes, times, names, values, colour):
    """A row for each name, from the top down, with a bar while its value is 1."""
    thin = 3 * (times[-1] - times[0]) / (WIDTH * DOTS_PER_INCH)  # what lasts for a scan is seen, too
    for n, value in enumerate(values):
        on = np.r_[0, value > 0, 0]
        begins, ends = (np.flatnonzero(np.diff(on) == change) for change in (1, -1))
        ends = times[np.minimum(ends, len(times) - 1)]
        spans = [(times[begin], max(end - times[begin], thin)) for begin, end in zip(begins, ends, strict=True)]
        axes.broken_barh(spans, (-n - BAR / 2, BAR), facecolors=colour, linewidth=0, zorder=2)
    axes.set_ylim(0.4 - len(names), 0.6)
    axes.set_yticks([-n for n in range(len(names))], names, fontsize=10)
    axes.tick_params(axis="y", length=0)
