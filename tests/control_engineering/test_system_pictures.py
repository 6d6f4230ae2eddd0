"""Pictures of systems with dead time: the curves are exact, their phases continuous, marks lie where they belong."""

import math
import warnings
from typing import NamedTuple

import numpy as np
import pytest
import sympy
from sympy import Rational, exp

from loopbook.deadtime import System
from loopbook.deadtime.curves import frequency_curve, natural_range
from loopbook.deadtime.pictures import bode_plot, nyquist_plot, step_plot
from loopbook.figures import Picture, PlanePlot, TimePlot, half_rule_plot, map_plot
from loopbook.figures.style import look
from loopbook.loops import Loop
from loopbook.pid import PID
from loopbook.quasipolynomials import read
from pictures import in_inches, overlap
from plainmath.expressions import s

INTEGRATOR = exp(-s) / (2 * s)
LOOP = Loop(2 * exp(-s) / (4 * s + 1), PID(1, Ti=4))


class Marks(NamedTuple):
    """The fields of `stability.Margins`."""

    gain_margin: float = math.inf
    gain_reduction: float = 0.0
    phase_margin: float = math.inf
    delay_margin: float = math.inf
    Ms: float = 1.0
    omega_180: float = math.nan
    omega_c: float = math.nan
    omega_ms: float = math.nan


# exp(-s)/(2*s), by hand: |L| = 1/(2 w), arg L = -90 degrees - w
OF_INTEGRATOR = Marks(
    gain_margin=math.pi,
    phase_margin=math.degrees(math.pi / 2 - 0.5),
    delay_margin=math.pi - 1,
    Ms=1.5862,
    omega_180=math.pi / 2,
    omega_c=0.5,
    omega_ms=0.9,
)


def phase(H, low, high):
    curve = frequency_curve(read(H), low, high)
    return curve.omega, curve.phase


def texts(picture):
    return [text.get_text() for axes in picture.figure.axes for text in axes.texts if text.get_text()]


def labels(axes):
    return [text.get_text() for text in axes.get_legend().get_texts()]


def labelled(axes, start):
    return next(line for line in axes.lines if line.get_label().startswith(start))


# The phase.


@pytest.mark.parametrize("delay", [Rational(1, 1000), 1, 40, sympy.sqrt(2)])
def test_the_phase_of_a_dead_time_is_minus_omega_times_it(delay):
    omega, degrees = phase(exp(-delay * s), 0.01, 100)
    np.testing.assert_allclose(degrees, -np.degrees(omega * float(delay)), rtol=1e-12)


@pytest.mark.parametrize(
    ("H", "begins", "ends"),
    [
        (sympy.Integer(2), 0, 0),
        (sympy.Integer(-2), -180, -180),
        (1 / s, -90, -90),
        (-1 / s, -270, -270),
        (1 / s**2, -180, -180),
        (s / (s + 1), 90, 0),
        (1 / (s + 1) ** 30, 0, -2700),
        ((1 - s) / (s + 1), 0, -180),
        (1 / (s - 1), -180, -90),
        ((s + 1) / (s - 1) / s, -270, -90),
        (1 / (s**2 + s / 10**5 + 1), 0, -180),
        (1 / (s**2 - s / 10**5 + 1), 0, 180),
        (1 / (s**2 + s / 10**5 + 1) ** 2, 0, -360),
        (1 / (s**2 + 1), 0, -180),
        (1 / (s**2 + 1) ** 3, 0, -540),
        ((s**2 + 1) / (s + 1) ** 2, 0, 0),
        ((s**2 - s / 10**5 + 1) / (s**2 + s / 10**5 + 1), 0, -360),
        ((s**2 + s / 10**5 + 1) / (s**2 + s / 10**5 + Rational(1000001, 1000000)), 0, 0),
    ],
)
def test_the_phase_begins_and_ends_as_zeros_and_poles_say(H, begins, ends):
    degrees = phase(H, 1e-5, 1e6)[1]
    assert degrees[0] == pytest.approx(begins, abs=0.05)
    assert degrees[-1] == pytest.approx(ends, abs=0.05)


def test_the_phase_does_not_depend_on_where_the_picture_begins():
    H = exp(-s) / ((s**2 + s / 10**4 + 1) * (s**2 + s / 10**4 + 4))
    whole, late = (frequency_curve(read(H), low, 50) for low in (0.01, 10))
    assert late.phase[-1] == pytest.approx(whole.phase[-1], abs=1e-9)
    assert late.omega[0] == 10


@pytest.mark.parametrize(
    "H",
    [
        1 / (s + Rational(157, 100) * exp(-s)),  # near the limit of stability
        1 / (1 + s + Rational(999, 1000) * s * exp(-s)),
        (1 - exp(-s) / 2) / (s + exp(-sympy.sqrt(2) * s) + exp(-s / 7) / 3),
        exp(-30 * s) / (s + 1),
        (s**2 + s / 500 + 9) * exp(-s) / (s + 1) ** 3,
    ],
)
def test_phase_and_value_are_the_same_curve_and_no_step_is_coarse(H):
    curve = frequency_curve(read(H), 0.05, 60)
    np.testing.assert_allclose(curve.values, System(H).frequency(curve.omega), rtol=1e-12)
    np.testing.assert_allclose(abs(curve.values) * np.exp(1j * np.radians(curve.phase)), curve.values, rtol=1e-9)
    assert abs(np.diff(curve.phase)).max() <= 3.0001
    dense = np.unique(np.r_[curve.omega, np.geomspace(0.05, 60, 300_000)])
    reference = np.degrees(np.unwrap(np.angle(System(H).frequency(dense))))
    assert np.ptp(np.interp(dense, curve.omega, curve.phase) - reference) < 3


@pytest.mark.parametrize("damping", [Rational(1, 10**3), Rational(1, 10**5), Rational(1, 10**8)])
def test_a_resonance_has_its_height(damping):
    curve = frequency_curve(read(exp(-s) / (s**2 + 2 * damping * s + 1)), 0.1, 10)
    assert abs(curve.values).max() == pytest.approx(1 / (2 * float(damping)), rel=1e-3)
    assert len(curve.omega) < 1000


def test_the_curve_is_broken_at_zeros_on_the_axis():
    curve = frequency_curve(read((1 - exp(-s)) / s), 0.1, 20)
    broken = curve.omega[np.isnan(curve.phase)]
    np.testing.assert_allclose(broken, 2 * np.pi * np.arange(1, 4), rtol=1e-11)
    known = np.isfinite(curve.phase)
    turned = -curve.omega / 2 + np.pi * np.floor(curve.omega / 2 / np.pi)
    np.testing.assert_allclose(curve.phase[known], np.degrees(turned[known]), atol=1e-6)


@pytest.mark.parametrize(
    ("H", "low", "high", "message"),
    [
        (1 / s, 2, 1, "the frequencies go from 2 to 1: expected positive ones that increase"),
        (sympy.Integer(0), 1, 2, "the transfer function is 0: it has no phase"),
        (1 / (1 + exp(-s) / 2), 1, 1e7, "the curve turns too often between .*: expected a narrower range"),
    ],
)
def test_what_cannot_be_followed_is_said(H, low, high, message):
    with pytest.raises(ValueError, match=message):
        frequency_curve(read(H), low, high)


# Where to look.


@pytest.mark.parametrize(
    ("H", "expected"),
    [
        (1 / s, (0.1, 10)),
        (sympy.Integer(3), (0.1, 10)),
        (1 / (5 * s + 1), (0.02, 2)),
        (1 / ((s + 1) * (s + 100)), (0.1, 1000)),
        (exp(-s), (0.1, 10)),
        (exp(-100 * s) / (s + 1), (0.001, 0.1)),
        (exp(-100 * s) / (s**2 + s / 100 + 1), (0.001, 5)),
        (1 / (s + 2 * exp(-s)), (0.1, 10)),
    ],
)
def test_the_range_holds_corners_and_delays(H, expected):
    assert natural_range([read(H)]) == expected


def test_the_range_of_several_holds_that_of_each_and_what_else_is_asked_for():
    assert natural_range([read(1 / (s + 1)), read(1 / (s + 50))], also=[0.01, math.inf]) == (0.002, 500)


def test_the_range_holds_the_frequencies_of_the_margins():
    marks = Marks(gain_margin=2, omega_180=400, phase_margin=30, omega_c=0.003, omega_ms=1)
    low, high = bode_plot(1 / s, margins=marks).figure.axes[0].get_xlim()
    assert (low, high) == (0.001, 2000)


# Bode.


def test_bode_plot_shows_the_exact_curve():
    picture = bode_plot(LOOP.T, omega=(0.02, 30))
    assert isinstance(picture, Picture)
    above, below = picture.figure.axes
    omega, sizes = above.lines[0].get_data()
    assert (omega[0], omega[-1]) == (0.02, 30)
    np.testing.assert_allclose(sizes, abs(LOOP.T.frequency(omega)), rtol=1e-12)
    turned = np.exp(1j * np.radians(below.lines[0].get_ydata()))
    np.testing.assert_allclose(sizes * turned, LOOP.T.frequency(omega), rtol=1e-9)
    assert (above.get_xscale(), above.get_yscale(), below.get_yscale()) == ("log", "log", "linear")
    assert repr(picture) == "<magnitude and phase [deg] against omega [rad/s]>"


def test_decibels_are_those_of_amplitudes():
    picture = bode_plot(INTEGRATOR, margins=OF_INTEGRATOR, db=True, unit="min")
    omega, sizes = picture.figure.axes[0].lines[0].get_data()
    np.testing.assert_allclose(sizes, -20 * np.log10(2 * omega), atol=1e-9)
    assert picture.figure.axes[0].get_ylabel() == "magnitude [dB]"
    assert picture.figure.axes[1].get_xlabel() == r"$\omega$ [rad/min]"
    assert texts(picture)[0] == "gain margin 9.94 dB"


def test_the_margins_are_bars_from_the_curve_to_one_and_to_half_a_turn():
    picture = bode_plot(LOOP, margins=OF_INTEGRATOR, title="A loop")
    above, below = picture.figure.axes
    bars = [line.get_xydata() for axes in (above, below) for line in axes.lines if line.get_marker() == "_"]
    np.testing.assert_allclose(bars[0], [[math.pi / 2, 1], [math.pi / 2, 1 / math.pi]])
    np.testing.assert_allclose(bars[1], [[0.5, -180], [0.5, -90 - math.degrees(0.5)]])
    assert texts(picture) == ["gain margin 3.14", "phase margin 61.4° (delay margin 2.14 s)"]
    assert picture.alt.startswith("A loop: ")
    assert picture.alt.endswith("; gain margin 3.14, phase margin 61.4°")


def test_margins_after_several_turns_are_measured_to_the_nearest_half_turn():
    # abs(L) = 1 where a resonance has turned the curve already
    L = read(exp(-5 * s) / (s**2 + s / 100 + 1) / 60)
    w = 1.006
    margin = math.degrees(abs(np.angle(-L(1j * w))))
    picture = bode_plot(L, margins=Marks(phase_margin=margin, omega_c=w))
    (bar,) = [line.get_ydata() for line in picture.figure.axes[1].lines if line.get_marker() == "_"]
    assert bar[0] == -540
    assert abs(bar[1] - bar[0]) == pytest.approx(margin)


def test_the_gain_reduction_of_an_unstable_process_is_found_on_the_curve():
    L = read(2 * exp(-s / 5) / (s - 1) * (1 + 1 / (10 * s)))
    marks = Marks(gain_margin=3.58, gain_reduction=0.5116, omega_180=7.1)
    picture = bode_plot(L, margins=marks)
    bars = [line.get_xydata() for line in picture.figure.axes[0].lines if line.get_marker() == "_"]
    (w, one), (_, size) = bars[1]
    assert one == 1
    assert size == pytest.approx(1 / 0.5116, rel=1e-3)
    assert L(1j * w) == pytest.approx(-size)
    assert "gain reduction 0.512" in texts(picture)


def test_infinite_margins_are_not_drawn_but_one_at_endless_frequency_is_named():
    assert texts(bode_plot(INTEGRATOR, margins=Marks())) == []
    endless = Marks(gain_margin=1.0443, omega_180=math.inf, Ms=23.9)
    assert texts(bode_plot(exp(-s) * (s + 2) / (s + 1), margins=endless)) == [
        "gain margin 1.04 at ever higher frequencies"
    ]


@pytest.mark.parametrize("plot", [bode_plot, nyquist_plot])
def test_several_systems_have_a_legend_and_looks_of_their_own(plot):
    gains = {f"$K_p$ = {K}": Loop(2 * exp(-s) / (4 * s + 1), PID(K, Ti=4)) for K in (0.5, 1, 2)}
    picture = plot(gains, title="Gains")
    axes = picture.figure.axes[0]
    assert set(gains) <= set(labels(axes))
    for number, label in enumerate(gains):
        assert labelled(axes, label).get_color() == look(number)["color"]
    assert picture.alt.startswith("Gains: K_p = 0.5, K_p = 1, K_p = 2: ")


def test_a_zero_and_a_pole_on_the_axis_do_not_take_all_the_room():
    bottom, top = bode_plot((s**2 + 4) / (s**2 + 1)).figure.axes[0].get_ylim()
    assert bottom > 1e-4
    assert top < 1e4


# Nyquist.


def test_nyquist_plot_shows_the_exact_curve_and_its_mirror():
    plot = nyquist_plot(LOOP)
    assert isinstance(plot, PlanePlot)
    curve, mirror = (labelled(plot.axes, label).get_xydata() for label in (r"$L(j\omega)$", r"$L(-j\omega)$"))
    np.testing.assert_array_equal(mirror, curve * [1, -1])
    x, y = curve.T
    omega = 1 / (2 * abs(x + 1j * y))  # abs(L) = 1/(2 w)
    np.testing.assert_allclose(x + 1j * y, System(INTEGRATOR).frequency(omega), rtol=1e-9)
    near = abs(x + 1j * y) < 1
    assert np.hypot(*np.diff(curve[near], axis=0).T).max() < 0.03


def test_the_marks_of_nyquist_are_where_the_margins_are():
    plot = nyquist_plot(LOOP, margins=OF_INTEGRATOR)
    gain = labelled(plot.axes, "gain margin 3.14").get_xydata()
    np.testing.assert_allclose(gain, [[-1 / math.pi, 0]])
    arc = labelled(plot.axes, "phase margin 61.4° (delay margin 2.14 s)").get_xydata()
    np.testing.assert_allclose(np.hypot(*arc.T), 1)
    np.testing.assert_allclose(arc[0], [-1, 0], atol=1e-12)
    assert np.hypot(*np.diff(arc, axis=0).T).sum() == pytest.approx(math.radians(61.4), rel=1e-3), "the short way"
    crossing = System(INTEGRATOR).frequency(0.5)
    np.testing.assert_allclose(arc[-1], [crossing.real, crossing.imag])
    circle = labelled(plot.axes, "$M_s$ = 1.59").get_xydata()
    np.testing.assert_allclose(np.hypot(circle[:, 0] + 1, circle[:, 1]), 1 / 1.5862)
    assert plot.alt.endswith("; gain margin 3.14, phase margin 61.4°, Ms 1.59")


@pytest.mark.parametrize(
    "L",
    [
        INTEGRATOR,
        1 / s**2 / (s + 1),
        exp(-s / 10) / (s**2 + s / 10**5 + 1),
        1000 * exp(-s) / (s + 1) ** 3,
        exp(-s) / 1000,
        1 / (s**2 + 1),
    ],
)
def test_the_window_is_that_of_the_unit_circle(L):
    plot = nyquist_plot(L)
    (left, right), (bottom, top) = plot.axes.get_xlim(), plot.axes.get_ylim()
    assert -4 < left < -1.1 < 1.1 < right < 4
    assert -3 < bottom < -1.1 < 1.1 < top < 3


def test_more_can_be_added():
    plot = nyquist_plot(LOOP).points([-0.5], [-0.5], "a point").text(0.5, 0.5, "words")
    assert labels(plot.axes)[-1] == "a point"
    assert plot.alt.endswith("; points: a point; words")


# Step responses.


def test_step_plot_of_a_system_marks_what_characterises_it():
    H = System(exp(-s) / (s**2 + s + 1))
    info = H.step_info(settling=0.05, rise=(0.2, 0.8))
    plot = step_plot(H, info=info, unit="min", settling=0.05, rise=(0.2, 0.8))
    assert isinstance(plot, TimePlot)
    times, values = plot.lines["$y(t)$"].get_data()
    np.testing.assert_allclose(values, H.step(times), atol=1e-12)
    assert times[-1] > info.settling_time
    (bar,) = [line.get_xydata() for line in plot.figure.axes[0].lines if line.get_marker() == "_"]
    np.testing.assert_allclose(bar, [[info.peak_time, 1], [info.peak_time, info.peak]])
    (rise,) = [line.get_xdata() for line in plot.figure.axes[0].lines if line.get_marker() == "|"]
    assert rise[1] - rise[0] == pytest.approx(info.rise_time, rel=0.02)
    assert plot.alt == "y(t) against t [min]; overshoot 16.3 %, rise time 1.16 min, settling time 6.29 min"
    assert set(texts(plot)) == {"overshoot 16.3 %", "rise time 1.16 min", "settling time 6.29 min"}


def test_step_plot_of_a_loop_has_setpoint_y_and_u():
    plot = step_plot(LOOP, end=8, title="A step")
    times, y = plot.lines["$y(t)$"].get_data()
    assert times[-1] == 8
    np.testing.assert_allclose(y, LOOP.servo.step(times), atol=1e-12)
    np.testing.assert_allclose(plot.lines["$u(t)$"].get_ydata(), LOOP.setpoint_to_control.step(times), atol=1e-12)
    assert plot.alt == "A step: setpoint, y(t); u(t) against t [s]"


def test_step_plot_of_several_loops():
    loops = {f"$K_p$ = {K}": Loop(2 * exp(-s) / (4 * s + 1), PID(K, Ti=4)) for K in (0.5, 1)}
    plot = step_plot(loops)
    assert list(plot.lines) == ["setpoint", *loops, "$u$, $K_p$ = 0.5", "$u$, $K_p$ = 1"]
    assert labels(plot.figure.axes[0]) == ["setpoint", *loops]


def test_a_jump_of_a_step_response_is_upright():
    H = System((1 - exp(-2 * s)) * (s + 2) / (s + 1))
    times, values = step_plot(H, end=5).lines["$y(t)$"].get_data()
    at = np.flatnonzero(abs(np.diff(values)) > 0.5)
    assert len(at) == 1
    assert times[at + 1] - times[at] < 1e-7
    assert times[at + 1] == 2


@pytest.mark.parametrize("H", [System(exp(-s) / s), System(1 / (s - 1)), System(1 / (s**2 + 1)), System(2)])
def test_what_does_not_settle_is_drawn_to_some_end(H):
    times = step_plot(H).lines["$y(t)$"].get_xdata()
    assert 1 <= times[-1] <= 100


# Axes of one's own.


def test_pictures_are_drawn_into_axes_of_ones_own():
    from matplotlib import pyplot

    figure, axes = pyplot.subplots(2, 4)
    bode = LOOP.bode(ax=axes[:, 0], title="Bode")
    assert bode.figure is figure
    assert labelled(axes[0, 0], "").get_xdata()[0] == axes[1, 0].get_xlim()[0]
    assert (axes[0, 0].get_title(loc="left"), axes[1, 0].get_xlabel()) == ("Bode", r"$\omega$ [rad/s]")
    assert LOOP.nyquist(ax=axes[0, 1]).axes is axes[0, 1]
    assert LOOP.servo.plot_step(ax=axes[1, 1]).lines["$y(t)$"].axes is axes[1, 1]
    step = LOOP.plot_step(20, ax=axes[:, 2]).event(5, "here")
    assert list(step.axes) == list(axes[:, 2])
    assert axes[0, 2].get_xlim() == axes[1, 2].get_xlim() == (0, 20)
    map_plot([1, 2], [1, 2], [[0, 2], [2, 4]], "x", "y", "poles", ax=axes[0, 3])
    half_rule_plot({"a": 2, "b": 1}, ax=axes[1, 3])
    assert all(each.has_data() for each in axes.flat)
    assert bode._repr_mimebundle_() == ({"text/plain": repr(bode)}, {})  # pyplot shows the figure
    assert bode.png()[:4] == b"\x89PNG"
    with pytest.raises(ValueError, match="1 axes for 2 panels: expected as many"):
        LOOP.bode(ax=axes[0, 0])
    pyplot.close(figure)


# python-control.


def test_frequency_data_are_exact_and_python_control_draws_them():
    import control
    from matplotlib import pyplot

    data = System(INTEGRATOR).to_control()
    np.testing.assert_allclose(data.complex, System(INTEGRATOR).frequency(data.omega))
    gain, angle, at_180, at_c = control.margin(data)
    assert (gain, at_180) == pytest.approx((math.pi, math.pi / 2), rel=1e-5)
    assert (angle, at_c) == pytest.approx((OF_INTEGRATOR.phase_margin, 0.5), rel=1e-5)
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        control.bode_plot(data)
        control.nichols_plot(data)
        control.nyquist_plot(data, warn_encirclements=False)
    assert (data * control.tf([1], [1, 1])).omega[0] == data.omega[0]
    pyplot.close("all")


def test_frequency_data_at_given_frequencies():
    data = System(1 / (s + 1)).to_control(omega=[1, 2])
    np.testing.assert_allclose(data.complex, [0.5 - 0.5j, 0.2 - 0.4j])


# What is wrong is said.


@pytest.mark.parametrize(
    ("call", "message"),
    [
        (lambda: bode_plot({}), "the systems are {}: expected one or more"),
        (lambda: bode_plot(1 / s, omega=[1]), "expected a lowest and a highest one, both positive"),
        (lambda: bode_plot(1 / s, omega=(0, 1)), "expected a lowest and a highest one, both positive"),
        (lambda: nyquist_plot(1 / s, omega=(2, 1)), "expected a lowest and a highest one, both positive"),
        (lambda: bode_plot(0), "the transfer function is 0"),
        (lambda: nyquist_plot({"a": 1 / s, "b": 2 / s}, margins=Marks()), "marks of one system beside 2"),
        (lambda: bode_plot(sympy.Symbol("K") / s), "give a number for K"),
        (lambda: step_plot({"a": LOOP, "b": LOOP.T}), "expected no systems beside loops"),
        (lambda: step_plot(LOOP, end=-1), "the end is -1: expected a positive number"),
        (lambda: System(1 / s).to_control(omega=[2, 1]), "the frequencies go from 2 to 1: expected increasing numbers"),
        (lambda: System(1 / (s**2 + 1)).to_control(omega=[1]), "has a pole at the frequency 1"),
    ],
)
def test_what_is_wrong_is_said(call, message):
    with pytest.raises(ValueError, match=message):
        call()


# The look.


@pytest.mark.parametrize(
    "picture",
    [
        lambda: bode_plot(LOOP, margins=OF_INTEGRATOR, title="Margins of a loop"),
        lambda: bode_plot(INTEGRATOR, margins=OF_INTEGRATOR, db=True),
        lambda: nyquist_plot(LOOP, margins=OF_INTEGRATOR, title="Margins of a loop"),
        lambda: step_plot(LOOP, info=LOOP.servo.step_info(), title="A step"),
        lambda: step_plot(System((1 - 3 * s) / (s + 1) ** 3), info=System((1 - 3 * s) / (s + 1) ** 3).step_info()),
    ],
)
def test_no_words_lie_on_one_another_or_on_a_curve(picture):
    figure = picture().figure
    figure.draw_without_rendering()
    for axes in figure.axes:
        written = [text for text in axes.texts if text.get_text()]
        boxes = [text.get_window_extent() for text in written]
        for line in axes.lines:
            path = line.get_path().transformed(line.get_transform())
            assert not [text for text, box in zip(written, boxes, strict=True) if path.intersects_bbox(box, False)]
        if axes.get_legend():
            boxes.append(axes.get_legend().get_window_extent())
        boxes = [in_inches(figure, box) for box in boxes]
        assert not any(overlap(one, other) for k, one in enumerate(boxes) for other in boxes[:k])


def test_pictures_are_small_and_have_the_colours_of_the_collection():
    image = nyquist_plot(LOOP, margins=OF_INTEGRATOR).png()
    assert image[:4] == b"\x89PNG"
    assert len(image) < 40_000


def test_the_pictures_of_systems_and_loops_take_their_ranges():
    for of in (LOOP, System(INTEGRATOR)):
        low, high = of.bode((0.02, 30)).figure.axes[0].get_xlim()
        assert (low, high) == (0.02, 30)
        whole, part = (max(abs(of.nyquist(omega, unit="min").axes.lines[3].get_xdata())) for omega in (None, (1, 2)))
        assert part < whole
        assert of.plot_step(7).figure.axes[0].get_xlim()[1] == pytest.approx(7, rel=0.1)
    marked, plain = (System(1 / (s**2 + s + 1)).plot_step(info=info).alt for info in (True, False))
    assert marked.startswith(plain)
    assert "overshoot" in marked
