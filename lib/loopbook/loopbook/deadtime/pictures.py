"""Pictures of systems with exact dead time: Bode and Nyquist plots with the margins marked, and step responses.

They show the exact curve, not samples of it: `curves` adds points until no turn and no peak is missed.
"""

from __future__ import annotations

import math
from typing import TYPE_CHECKING

import numpy as np

from loopbook.deadtime.curves import frequency_curve, natural_range
from loopbook.figures import Picture, PlanePlot, TimePlot, canvas, time_plot
from loopbook.figures.labels import decades, free_legend, free_place, legend_below
from loopbook.figures.picture import titled
from loopbook.figures.style import GUIDE, LEVEL, WIDTH, ZERO, look, styled
from loopbook.quasipolynomials import DelayFraction, read
from plainmath.tables import plain_words
from plainmath.validation import known_arguments, positive, real_numbers

if TYPE_CHECKING:
    from collections.abc import Sequence

    from matplotlib.axes import Axes
    from numpy.typing import ArrayLike

    from loopbook.deadtime.step_info import StepInfo
    from loopbook.figures.canvas import OwnAxes
    from loopbook.stability import Margins

__all__ = ["bode_plot", "nyquist_plot", "step_plot"]

OF_GAIN = look("control signal")["color"]
OF_PHASE = look("measurement")["color"]
LOWEST = 1e-8  # of the magnitude at low frequencies: what is drawn at least
WHOLE = 3.0  # magnitude up to which a Nyquist plot shows a whole curve
FLATTEST = 0.6, 0.75  # the least and the greatest height of a Nyquist plot beside its width
NEAR = 1.6  # otherwise the part of it below this
STILL = {"scalex": False, "scaley": False}  # what is marked does not change the limits
BAR = {"linewidth": 2.4, "marker": "_", "markersize": 9, "markeredgewidth": 2, "zorder": 4, **STILL}


# ------------------------------------------------------------------------------------------------ Bode


@known_arguments
def bode_plot(
    H: object,
    omega: ArrayLike | None = None,
    margins: Margins | None = None,
    title: str | None = None,
    unit: str = "s",
    db: bool = False,
    ax: OwnAxes = None,
) -> Picture:
    """Plot magnitude and phase of a frequency response against frequency, with exact dead time.

    The phase is continuous, as `curves.frequency_curve` proves it. Magnitudes are factors on a logarithmic axis, like
    the gain margin, unless decibels are asked for.

    Arguments:
        H: a `System`, an expression in `s` with numbers, or what else `quasipolynomials.read` understands; a `Loop`,
            whose open loop is shown; or ``{label: H}`` for several.
        omega: the lowest and the highest frequency, in radians for one unit of time, or an array that has them at its
            ends; by itself a decade around the corner frequencies.
        margins: those of the closed loop around H, from `stability.margins`: they are marked as bars.
        title: written above the plot.
        unit: of time, as the axis names it.
        db: magnitudes in decibels.
        ax: two axes of matplotlib to draw into, for magnitude and phase, in place of a new figure.
    Raises:
        ValueError: for frequencies that are not positive, H = 0, or margins with several systems.

    >>> from plainmath.expressions import s
    >>> from loopbook.stability import margins
    >>> import sympy
    >>> L = sympy.exp(-s) / (2 * s)
    >>> bode_plot(L, margins=margins(L), title="An integrator")
    <An integrator: magnitude and phase [deg] against omega [rad/s]; gain margin 3.14, phase margin 61.4°>
    """
    fractions = _fractions(H, margins)
    low, high = _range(fractions, omega, margins)
    curves = {label: frequency_curve(fraction, low, high) for label, fraction in fractions.items()}

    def size(values):
        return 20 * np.log10(abs(values)) if db else abs(values)

    with styled():
        figure, (above, below) = canvas.panels([2.25, 2.25], ax)
        for place, (label, curve) in enumerate(curves.items()):
            with np.errstate(divide="ignore"):
                above.plot(curve.omega, size(curve.values), label=label, **look(place))
            below.plot(curve.omega, curve.phase, label=label, **look(place))
        above.set_xscale("log")
        above.set_xlim(low, high)
        bottom, top = _magnitudes(curves.values(), with_one=margins is not None)
        if db:
            bottom, top = 20 * math.log10(bottom), 20 * math.log10(top)
        else:
            above.set_yscale("log")
            decades(above.yaxis, bottom, top)
        above.set_ylim(bottom, top)
        decades(below.xaxis, low, high)
        _degrees(below, curves.values(), with_half_turn=margins is not None)
        above.set(ylabel="magnitude [dB]" if db else "magnitude", title=title or "")
        below.set(ylabel="phase [deg]", xlabel=rf"$\omega$ [rad/{unit}]")
        figure.align_ylabels([above, below])
        if len(curves) > 1:
            free_legend(above)
        if margins is not None:
            (fraction,), (curve,) = fractions.values(), curves.values()
            _bode_margins(above, below, fraction, curve, margins, size, unit)
    return Picture(figure, _alt(title, curves, f"magnitude and phase [deg] against omega [rad/{unit}]", margins))


def _bode_margins(above, below, H, curve, margins, size, unit) -> None:
    (left, right), bottom, top = above.get_xlim(), above.get_ylim()[0], below.get_ylim()[1]
    one, labels, half_turns = float(size(1.0)), [], set()
    above.axhline(one, **LEVEL)

    def phase_at(w):
        known = np.isfinite(curve.phase)
        about = np.interp(math.log(w), np.log(curve.omega[known]), curve.phase[known])
        angle = math.degrees(np.angle(H(1j * w)))
        return angle + 360 * round((about - angle) / 360)

    def mark(w, color, of_bar, bar, of_point, point):
        of_bar.plot([w, w], bar, color=color, **BAR)
        of_point.plot([w], [point], "o", color=color, markersize=5, zorder=4, **STILL)
        magnitudes, phases = (bar, [point]) if of_bar is above else ([point], bar)
        above.plot([w, w], [min(magnitudes), bottom], **GUIDE)
        below.plot([w, w], [top, max(phases)], **GUIDE)

    of_gain = [("gain margin", margins.gain_margin, margins.omega_180)]
    if margins.gain_reduction > 0 and (w := _crossing(H, curve, 1 / margins.gain_reduction)):
        of_gain.append(("gain reduction", margins.gain_reduction, w))
    for name, value, w in of_gain:
        if math.isfinite(value) and left < w < right:
            there, angle = float(size(H(1j * w))), phase_at(w)
            mark(w, OF_GAIN, above, [one, there], below, angle)
            half_turns.add(round(angle))
            words = f"{name} {_short(size(value))}{' dB' if one == 0 else ''}"
            labels.append((above, words, (w, max(one, there)), OF_GAIN, ("above right", "above left")))
    if math.isfinite(margins.phase_margin) and left < margins.omega_c < right:
        w, angle = margins.omega_c, phase_at(margins.omega_c)
        half_turn = 360 * round((angle - 180) / 360) + 180
        mark(w, OF_PHASE, below, [half_turn, angle], above, one)
        half_turns.add(half_turn)
        words = _phase_words(margins, unit)
        labels.append((below, words, (w, half_turn), OF_PHASE, ("below left", "above left", "below right")))
    for angle in half_turns or {-180}:
        below.axhline(angle, **LEVEL)
    if margins.omega_180 == math.inf:
        words = f"gain margin {_short(margins.gain_margin)} at ever higher frequencies"
        labels.append((above, words, (right, one), OF_GAIN, ("above left", "below left")))
    for axes, words, point, color, places in labels:
        free_place(axes, words, point, places, color=color)


def _crossing(H, curve, size) -> float | None:
    """The frequency at which the curve crosses the negative real axis at this distance from zero."""
    from scipy.optimize import brentq

    turns, found = np.floor((curve.phase + 180) / 360), []
    for k in np.flatnonzero(np.diff(turns)):
        a, b = curve.omega[k : k + 2].tolist()  # as brentq takes them: an array's item is computed otherwise
        if np.isfinite(turns[k : k + 2]).all() and H(1j * a).imag * H(1j * b).imag < 0:
            w = float(brentq(lambda w: H(1j * w).imag, a, b, xtol=1e-15 * b))
            found.append((abs(abs(H(1j * w)) - size), w))
    apart, w = min(found, default=(math.inf, None))
    return w if apart < 0.01 * size else None


def _magnitudes(curves, with_one) -> tuple[float, float]:
    """Limits of the magnitude; without the neighbourhood of zeros and poles on the axis."""
    lows, highs = [], []
    for curve in curves:
        w, sizes = curve.omega, abs(curve.values)
        shown = np.isfinite(sizes) & (sizes > 0)
        for gap in w[np.isnan(curve.phase)]:
            shown &= abs(w - gap) > 0.003 * gap
        steady = np.interp(np.geomspace(w[0], w[-1], 60)[:20], w[shown], sizes[shown]).max()
        highs.append(sizes[shown].max())
        lows.append(max(sizes[shown].min(), LOWEST * steady))
    low, high = min([*lows, *([0.5] if with_one else [])]), max([*highs, *([2.0] if with_one else [])])
    room = max((high / low) ** 0.06, 1.2)
    if high * room / (low / room) < 10:  # a flat curve is seen to be flat
        room *= math.sqrt(10 * low / high) / room
    return low / room, high * room


def _degrees(axes: Axes, curves, with_half_turn) -> None:
    """Angles on the vertical axis, marked at parts or multiples of a half turn."""
    from matplotlib.ticker import FuncFormatter, MultipleLocator

    phases = np.concatenate([curve.phase for curve in curves])
    low, high = np.nanmin(phases), np.nanmax(phases)
    if with_half_turn:
        low, high = min(low, -200.0), max(high, -160.0)
    room = max(0.08 * (high - low), 0.5 * (90 - high + low), 5.0)
    low, high = low - room, high + room
    step = next((x for x in (15, 45, 90, 180, 360, 720) if (high - low) / x <= 8), 360 * math.ceil((high - low) / 2880))
    axes.yaxis.set_major_locator(MultipleLocator(step))
    axes.yaxis.set_major_formatter(FuncFormatter(lambda x, _: f"{x:.0f}".replace("-", "\N{MINUS SIGN}")))
    axes.set_ylim(low, high)


# ------------------------------------------------------------------------------------------------ Nyquist


@known_arguments
def nyquist_plot(
    L: object,
    omega: ArrayLike | None = None,
    margins: Margins | None = None,
    title: str | None = None,
    unit: str = "s",
    ax: OwnAxes = None,
) -> PlanePlot:
    """Plot an open loop L(j omega) in the complex plane, with the point -1, the unit circle and the margins.

    The curve of negative frequencies is a thin line.
    The window holds the unit circle and the part of the curve around it, so that an integrator or a sharp resonance
    does not take all the room.

    Arguments:
        L: as for `bode_plot`.
        omega: as for `bode_plot`; by itself it reaches far beyond the corners.
        margins: those of the closed loop, from `stability.margins`: the gain margin is marked on the negative real
            axis, the phase margin as an arc, and Ms by the circle around -1 that the curve touches.
        title: written above the plot.
        unit: of time, for the delay margin.
        ax: axes of matplotlib to draw into, in place of a new figure.
    Returns:
        A `PlanePlot`, to which areas, points and words can be added.
    Raises:
        ValueError: as `bode_plot`.

    >>> from plainmath.expressions import s
    >>> from loopbook.stability import margins
    >>> import sympy
    >>> L = sympy.exp(-s) / (2 * s)
    >>> nyquist_plot(L, margins=margins(L))
    <imaginary part against real part; gain margin 3.14, phase margin 61.4°, Ms 1.59>
    """
    fractions = _fractions(L, margins)
    low, high = _range(fractions, omega, margins)
    if omega is None:  # no axis shows the frequency, and the curve is to end near zero
        low, high = low / 100, 3 * high
    curves = {label: frequency_curve(fraction, low, high, _coarse) for label, fraction in fractions.items()}
    (left, right), (bottom, top) = _window(curves.values(), margins)
    with styled():
        _, (axes,) = canvas.panels([(WIDTH - canvas.LEFT - canvas.RIGHT) * (top - bottom) / (right - left)], ax)
        axes.axhline(0, **ZERO)
        axes.axvline(0, **ZERO)
        circle = np.exp(1j * np.linspace(0, 2 * math.pi, 361))
        axes.plot(circle.real, circle.imag, **(GUIDE | {"label": "unit circle"}))
        for place, (label, curve) in enumerate(curves.items()):
            line = look(place)
            x, y = curve.values.real, curve.values.imag
            axes.plot(x, y, label=label or r"$L(j\omega)$", **line)
            thin = {"linewidth": 0.7, "linestyle": "-", "zorder": 1.8}
            axes.plot(x, -y, label=r"$L(-j\omega)$" if len(curves) == 1 else None, **(line | thin))
        axes.set(xlim=(left, right), ylim=(bottom, top), aspect="equal")
        for place, curve in enumerate(curves.values()):
            _arrow(axes, curve, look(place)["color"])
        if margins is not None:
            (fraction,) = fractions.values()
            _nyquist_margins(axes, fraction, margins, unit)
        axes.plot([-1], [0], "x", color="#000000", markersize=8, markeredgewidth=1.8, label="$-1$", zorder=5)
        axes.set(xlabel="real part", ylabel="imaginary part", title=title or "")
        legend_below(axes)
    return PlanePlot(axes, _alt(title, curves, "imaginary part against real part", margins, with_sensitivity=True))


def _coarse(a, b):
    with np.errstate(invalid="ignore"):
        return (abs(b - a) > 0.02) & (np.minimum(abs(a), abs(b)) < 4)


def _window(curves, margins):
    """Limits that hold the unit circle, and as much of the curves as does not dwarf it."""
    x, y = [-1.15, 1.15], [-1.15, 1.15]
    for curve in curves:
        values = curve.values[np.isfinite(curve.values)]
        near = abs(values) <= NEAR
        if near.any() and abs(values[near.argmax() :]).max() <= WHOLE:  # it comes from far, as from an integrator
            values = values[near.argmax() :]
        elif abs(values).max() > WHOLE:
            values = values[near]
        if len(values):
            x += [values.real.min(), values.real.max()]
            y += [sign * value for value in (values.imag.min(), values.imag.max()) for sign in (1, -1)]
    if margins is not None:
        if margins.gain_reduction > 1 / WHOLE:
            x.append(-1 / margins.gain_reduction)
        if margins.Ms > 1:
            x.append(-1 - min(1 / margins.Ms, 0.9))
    (x, width), (y, height) = (((max(z) + min(z)) / 2, 1.12 * (max(z) - min(z))) for z in (x, y))
    width, height = max(width, height / FLATTEST[1]), max(height, FLATTEST[0] * width)
    return (x - width / 2, x + width / 2), (y - height / 2, y + height / 2)


def _arrow(axes, curve, colour) -> None:
    """An arrow towards higher frequencies, on the longest part that is seen."""
    values = curve.values
    (left, right), (bottom, top) = axes.get_xlim(), axes.get_ylim()
    with np.errstate(invalid="ignore"):
        seen = (left < values.real) & (values.real < right) & (bottom < values.imag) & (values.imag < top)
    lengths = np.where(seen[1:] & seen[:-1], abs(np.diff(values)), 0.0)
    ends = np.flatnonzero(np.diff(np.r_[False, lengths > 0, False].astype(int))).reshape(-1, 2)
    if not len(ends):
        return
    a, b = max(ends, key=lambda run: lengths[run[0] : run[1]].sum())
    way = np.cumsum(lengths[a:b])
    k = a + int(np.searchsorted(way, 0.32 * way[-1]))
    start, tip = values[k], values[k + 1]
    if start == tip:
        return
    tip = start + (tip - start) / abs(tip - start) * 0.01 * (right - left)
    axes.annotate(
        "", (tip.real, tip.imag), (start.real, start.imag), zorder=3,
        arrowprops={"arrowstyle": "-|>,head_width=0.35,head_length=0.7", "color": colour, "linewidth": 1.8,
                    "shrinkA": 0, "shrinkB": 0},
    )  # fmt: skip


def _nyquist_margins(axes, L, margins, unit) -> None:
    for name, value, marker in (("margin", margins.gain_margin, "o"), ("reduction", margins.gain_reduction, "s")):
        if 0 < value < math.inf:
            label, of_gain = f"gain {name} {_short(value)}", {"color": OF_GAIN, **STILL}
            axes.plot([-1, -1 / value], [0, 0], linewidth=2.4, zorder=3.5, **of_gain)
            axes.plot([-1 / value], [0], marker, markersize=6, label=label, zorder=4, **of_gain)
    if math.isfinite(margins.phase_margin):
        point = L(1j * margins.omega_c)
        arc = np.exp(1j * np.linspace(math.pi, np.angle(point) % (2 * math.pi), 90))
        of_phase = {"color": OF_PHASE, **STILL}
        axes.plot(arc.real, arc.imag, linewidth=2.4, zorder=3.4, label=_phase_words(margins, unit), **of_phase)
        axes.plot([0, point.real], [0, point.imag], linewidth=1, linestyle=(0, (2, 2)), zorder=1.7, **of_phase)
        axes.plot([point.real], [point.imag], "o", markersize=6, zorder=4, **of_phase)
    if math.isfinite(margins.Ms) and margins.Ms > 0:
        circle = -1 + np.exp(1j * np.linspace(0, 2 * math.pi, 181)) / margins.Ms
        thin = look("disturbance") | {"linewidth": 1.4, "zorder": 1.9}
        axes.plot(circle.real, circle.imag, label=f"$M_s$ = {_short(margins.Ms)}", **thin, **STILL)
        if math.isfinite(margins.omega_ms):
            near = L(1j * margins.omega_ms)
            axes.plot([-1, near.real], [0, near.imag], color=thin["color"], linewidth=1.2, zorder=1.9, **STILL)


# ------------------------------------------------------------------------------------------------ step responses


@known_arguments
def step_plot(
    H: object,
    end: float | None = None,
    info: StepInfo | None = None,
    title: str | None = None,
    unit: str = "s",
    settling: float = 0.02,
    rise: Sequence[float] = (0.1, 0.9),
    ax: OwnAxes = None,
) -> TimePlot:
    """Plot the response to a unit step: the output of a system, or y and u of a loop after a step of its setpoint.

    Arguments:
        H: a `System`; a `Loop`; or ``{label: H}`` for several of one kind.
        end: the last time; by itself late enough for the response to settle.
        info: what `System.step_info` returns, for one system or the servo response of one loop: it is marked.
        title: written above the plot.
        unit: of time, as the axis names it.
        settling, rise: the shares with which `info` was asked for.
        ax: axes of matplotlib to draw into, two for loops, in place of a new figure.
    Raises:
        ValueError: for an end that is not positive, info with several systems, or systems beside loops.

    >>> from loopbook.deadtime import System
    >>> from plainmath.expressions import s
    >>> H = System(1 / (s**2 + s + 1))
    >>> step_plot(H, info=H.step_info(), title="Two poles")
    <Two poles: y(t) against t [s]; overshoot 16.3 %, rise time 1.64 s, settling time 8.08 s>
    """
    systems = _labelled(H, info)
    loops = [hasattr(x, "open_fraction") for x in systems.values()]
    if any(loops) and not all(loops):
        raise ValueError("a plot shows loops or systems: expected no systems beside loops")
    outputs = [x.servo if any(loops) else x for x in systems.values()]
    end = positive("the end", end) if end is not None else max(x.horizon(info) for x in outputs)
    controls = [x.setpoint_to_control for x in systems.values()] if any(loops) else []
    responses = [system.step_until(end) for system in (*outputs, *controls)]
    times = _times(responses, end)
    values = [response(times) for response in responses]

    def panel(letter, rows, role):
        if len(systems) == 1:
            return {f"${letter}(t)$": (rows[0], role)}
        names = systems if letter == "y" else [f"${letter}$, {label}" for label in systems]
        return {name: (row, k) for k, (name, row) in enumerate(zip(names, rows, strict=True))}

    panels = [panel("y", values[: len(systems)], "measurement")]
    first = next(iter(panels[0]))
    if controls:
        setpoint = {"setpoint": (np.ones(len(times)), "setpoint")}
        panels = [setpoint | panels[0], panel("u", values[len(systems) :], "control signal")]
    names = ["$y$", "$u$"][: len(panels)] if controls or len(systems) > 1 else None
    plot = time_plot(panels, times, title=title, xlabel=f"$t$ [{unit}]", ylabel=names, ax=ax)
    if info is not None:
        with styled():
            found = _mark_info(plot.axes[0], plot.lines[first], info, settling, rise, unit)
        plot.alt += f"; {', '.join(found)}" if found else ""
    return plot


def _mark_info(axes, line, info, settling, rise, unit) -> list[str]:
    """Mark what characterises a step response, and return it in words."""
    times, values = line.get_data()
    end, final = times[-1], info.final_value
    size, sign = abs(final) or abs(info.peak), -1 if final < 0 else 1
    floor, ceiling = axes.get_ylim()[::sign]
    if 0 < info.overshoot < math.inf:  # room for its name
        ceiling += 0.08 * (ceiling - floor)
    axes.set_ylim(*(floor, ceiling)[::sign])
    axes.axhline(final, **LEVEL)
    axes.axhspan(final - settling * size, final + settling * size, color="#eeeeee", zorder=0.4)
    labels = []
    if info.overshoot > 0 and info.peak_time <= end:
        axes.plot([info.peak_time] * 2, [final, info.peak], color=OF_GAIN, **BAR)
        places = ("above right", "above", "right") if sign > 0 else ("below right", "below", "right")
        words = f"overshoot {_short(100 * info.overshoot)} %"
        labels.append((words, (info.peak_time, info.peak), places, OF_GAIN))
    if math.isfinite(info.rise_time):
        start, finish = (times[np.argmax(sign * values >= share * abs(final))] for share in rise)
        level = floor + 0.06 * (final - floor)
        for moment, share in ((start, rise[0]), (finish, rise[1])):
            axes.plot([moment] * 2, [floor, share * final], **GUIDE)
            axes.plot([moment], [share * final], "o", color="#000000", markersize=4, zorder=4, **STILL)
        axes.plot([start, finish], [level, level], color="#000000", marker="|", markersize=7, linewidth=1.4, **STILL)
        words = f"rise time {_short(info.rise_time)} {unit}"
        labels.append((words, (finish, level), ("right", "above right"), "#000000"))
    if 0 < info.settling_time <= end:
        there = np.interp(info.settling_time, times, values)
        axes.plot([info.settling_time] * 2, [floor, there], **GUIDE)
        axes.plot([info.settling_time], [there], "o", color="#000000", markersize=5, zorder=4, **STILL)
        words, middle = f"settling time {_short(info.settling_time)} {unit}", floor + 0.45 * (final - floor)
        labels.append((words, (info.settling_time, middle), ("left", "right"), "#000000"))
    for words, point, places, colour in labels:
        free_place(axes, words, point, places, color=colour)
    return [words for words, *_ in labels]


def _times(responses, end):
    """Even times, and two at each jump, so that it is drawn upright."""
    times = [np.linspace(0, end, 1201)]
    for response in responses:
        edges = response.edges[(response.edges > 0) & (response.edges < end)]
        if not len(edges) or len(edges) > 20_000:
            continue
        before = edges - 1e-9 * end
        jump = abs(response(edges) - response(before))
        seen = jump > 1e-4 * max(abs(response(times[0])).max(), 1e-300)
        times += [edges[seen], before[seen]]
    return np.unique(np.concatenate(times))


# ------------------------------------------------------------------------------------------------ common


def _labelled(H, marks) -> dict[str, object]:
    systems = H if isinstance(H, dict) else {"": H}
    if not systems:
        raise ValueError("the systems are {}: expected one or more")
    if marks is not None and len(systems) > 1:
        raise ValueError(f"marks of one system beside {len(systems)}: expected one system, or no margins and no info")
    return systems


def _fractions(H, marks) -> dict[str, DelayFraction]:
    systems = _labelled(H, marks).items()
    return {label: x.open_fraction if hasattr(x, "open_fraction") else read(x) for label, x in systems}


def _range(fractions, omega, margins) -> tuple[float, float]:
    if omega is None:
        marked = [] if margins is None else [margins.omega_180, margins.omega_c, margins.omega_ms]
        return natural_range(fractions.values(), [w for w in marked if not math.isnan(w)])
    omega = real_numbers("frequencies", omega)
    if omega.ndim != 1 or len(omega) < 2 or not 0 < omega[0] < omega[-1]:
        raise ValueError(f"the frequencies are {omega}: expected a lowest and a highest one, both positive")
    return float(omega[0]), float(omega[-1])


def _short(value: float) -> str:
    """Three digits, without a power of ten where none is needed."""
    return f"{value:.0f}" if 999.5 <= abs(value) < 1e5 else f"{value:.3g}"


def _phase_words(margins, unit) -> str:
    words = f"phase margin {_short(margins.phase_margin)}°"
    turned = math.radians(margins.phase_margin) / margins.omega_c
    if math.isclose(turned, margins.delay_margin, rel_tol=1e-6):  # both belong to the same frequency
        words += f" (delay margin {_short(margins.delay_margin)} {unit})"
    return words


def _alt(title, curves, words, margins, with_sensitivity=False) -> str:
    if len(curves) > 1:
        words = f"{', '.join(map(plain_words, curves))}: {words}"
    if margins is not None:
        marks = [f"gain margin {_short(margins.gain_margin)}"]
        if margins.gain_reduction > 0:
            marks.append(f"gain reduction {_short(margins.gain_reduction)}")
        marks.append(f"phase margin {_short(margins.phase_margin)}{'°' if math.isfinite(margins.phase_margin) else ''}")
        if with_sensitivity:
            marks.append(f"Ms {_short(margins.Ms)}")
        words = f"{words}; {', '.join(marks)}"
    return titled(title, words)
