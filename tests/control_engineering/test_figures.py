"""The look of the collection and the plot of signals against time."""

import base64
import io
import re
from dataclasses import replace

import numpy as np
import pytest
import sympy
from matplotlib._mathtext import Parser
from matplotlib.collections import PolyCollection, QuadMesh
from matplotlib.figure import Figure
from matplotlib.legend import Legend
from PIL import Image
from sympy import DiracDelta, Heaviside, exp

from loopbook.approximation import half_rule
from loopbook.deadtime.pictures import nyquist_plot
from loopbook.diagrams import block, block_diagram
from loopbook.figures import PlanePlot, TimePlot, half_rule_plot, level_plot, map_plot, plane_plot, time_plot, trends
from loopbook.figures.labels import free_place
from loopbook.figures.picture import with_few_colours
from loopbook.figures.style import DOTS_PER_INCH, GREY, MODELS, ROLES, STYLE, WIDTH, look
from loopbook.laplace import s, t
from loopbook.loops import Loop
from loopbook.pid import PID, Controller
from loopbook.plants import WoodChipTank
from loopbook.signals import stepwise
from loopbook.simulation import simulate

TIMES = np.linspace(0, 25, 501)
LAG = 2 * (1 - exp(-t / 5))


def texts(axes):
    return [text.get_text() for text in axes.texts]


def test_expression_is_drawn_at_the_given_times():
    line = time_plot({"$y(t)$": LAG}, TIMES).lines["$y(t)$"]
    np.testing.assert_array_equal(line.get_xdata(), TIMES)
    np.testing.assert_allclose(line.get_ydata(), 2 * (1 - np.exp(-TIMES / 5)), atol=1e-14)


@pytest.mark.parametrize("signal", [3, 3.0, sympy.Integer(3), np.full(501, 3), [3] * 501])
def test_numbers_and_arrays_are_signals_too(signal):
    line = time_plot({"u": signal}, TIMES).lines["u"]
    np.testing.assert_array_equal(line.get_ydata(), np.full(501, 3.0))


def test_step_at_zero_is_an_upright_edge_after_a_time_at_zero():
    plot = time_plot({"u": 1}, TIMES, before=2)
    x, y = plot.lines["u"].get_data()
    assert list(zip(x[:3], y[:3], strict=True)) == [(-2, 0), (0, 0), (0, 1)]
    assert plot.figure.axes[0].get_xlim() == (-2, 25)


@pytest.mark.parametrize("late", [sympy.Rational(1, 3), sympy.sqrt(2), 5, 7.77])
def test_late_step_is_an_upright_edge_between_the_given_times(late):
    x, y = time_plot({"u": 3 * Heaviside(t - late)}, np.linspace(0, 10, 21)).lines["u"].get_data()
    (jump,) = np.flatnonzero(np.diff(y))
    assert y[jump : jump + 2].tolist() == [0, 3]
    assert x[jump : jump + 2] == pytest.approx([float(late)] * 2, abs=2e-8)
    assert (np.diff(x) > 0).all()


def test_panels_share_the_time_axis_and_an_input_takes_less_room():
    plot = time_plot([{"y": LAG}, {"u": (1, "control signal")}], TIMES, title="Figure 6.2", before=2)
    response, control = plot.figure.axes
    plot.figure.draw_without_rendering()
    assert response.get_xlim() == control.get_xlim() == (-2, 25)
    assert response.get_position().height == pytest.approx(2 * control.get_position().height, rel=0.01)
    assert (response.get_title(loc="left"), control.get_title(loc="left")) == ("Figure 6.2", "")
    assert (response.get_xlabel(), control.get_xlabel()) == ("", "$t$ [s]")
    assert (response.get_ylabel(), control.get_ylabel()) == ("y", "u")


def test_several_signals_have_a_legend_and_one_has_its_name_on_the_axis():
    plot = time_plot([{"a": 1, "b": t}, {"c": t}], TIMES, ylabel=["level [m]", None])
    first, second = plot.figure.axes
    assert [text.get_text() for text in first.get_legend().get_texts()] == ["a", "b"]
    assert second.get_legend() is None
    assert (first.get_ylabel(), second.get_ylabel()) == ("level [m]", "c")


@pytest.mark.parametrize("role", ROLES)
def test_role_decides_colour_wherever_it_stands(role):
    for plot in (time_plot({"x": (t, role)}, TIMES), time_plot([{"a": 1, "b": 2}, {"x": (TIMES, role)}], TIMES)):
        assert plot.lines["x"].get_color() == ROLES[role]["color"]
        assert plot.lines["x"].get_linewidth() == ROLES[role]["linewidth"]


def test_no_two_looks_agree_in_colour_or_in_grey():
    assert len({line["color"] for line in ROLES.values()}) == len(ROLES)
    assert len({(line["linestyle"], line["linewidth"]) for line in ROLES.values()}) == len(ROLES)
    assert len({(line["color"], line["linestyle"]) for line in map(look, range(30))}) == 30
    assert not {look(n)["color"] for n in range(30)} & {line["color"] for line in ROLES.values()}
    for looks in ([look(n) for n in range(5)], list(MODELS.values())):
        assert len({look["color"] for look in looks}) == len({look["linestyle"] for look in looks}) == len(looks)


def test_responses_go_on_with_the_next_look_in_the_next_panel_and_a_number_is_the_look_of_that_response():
    plot = time_plot([{"a": 1, "u": (1, "control signal")}, {"b": 2, "c": (3, 0)}], TIMES)
    assert [plot.lines[name].get_color() for name in "abc"] == [look(n)["color"] for n in (0, 1, 0)]


def test_mark_is_on_the_curve_with_guides_beyond_both_axes():
    plot = time_plot({"y": LAG}, TIMES, before=2)
    axes = plot.figure.axes[0]
    before = axes.get_xlim(), axes.get_ylim()
    plot.mark(5, "63 % at $t = T$")
    assert (axes.get_xlim(), axes.get_ylim()) == before
    upright, level, dot = axes.lines[-3:]
    assert (dot.get_xdata().item(), dot.get_ydata().item()) == pytest.approx((5, 2 * (1 - np.exp(-1))))
    assert list(upright.get_xdata()) == [5, 5]
    assert min(upright.get_ydata()) < axes.get_ylim()[0]
    assert level.get_ydata() == pytest.approx([2 * (1 - np.exp(-1))] * 2)
    assert min(level.get_xdata()) < axes.get_xlim()[0]
    assert texts(axes) == ["63 % at $t = T$"]


def test_mark_reads_the_curve_that_it_is_told():
    plot = time_plot([{"a": t, "b": 2 * t}, {"c": 3 * t}], TIMES)
    plot.mark(sympy.Rational(5, 2), "here", signal="b").mark(4, "there", signal="c")
    dots = [axes.lines[-1] for axes in plot.figure.axes]
    assert [d.get_xdata().item() for d in dots] == pytest.approx([2.5, 4])
    assert [d.get_ydata().item() for d in dots] == pytest.approx([5, 12])
    assert [d.get_color() for d in dots] == [plot.lines[x].get_color() for x in "bc"]


@pytest.mark.parametrize(("time", "value"), [(1, 45), (9.9, 45), (10, 60), (13, 60), (20, 50)])
def test_mark_is_on_the_staircase_of_a_signal_that_is_held(time, value):
    run = simulate(WoodChipTank(), until=20, step=10, u=[45, 60, 50])
    plot = trends(run)
    before = len(plot.figure.axes[1].lines)
    plot.mark(time, "here", signal="$u$")
    upright, level, dot = plot.figure.axes[1].lines[before:]
    assert (dot.get_xdata().item(), dot.get_ydata().item()) == (time, value)
    assert level.get_ydata()[0] == upright.get_ydata()[0] == value


@pytest.mark.parametrize(
    ("signal", "time", "corner"),
    [(t, 5, ("left", "top")), (t, 20, ("right", "bottom")), (-t, 5, ("left", "bottom")), (-t, 20, ("right", "top"))],
)
def test_label_of_a_mark_stands_clear_of_the_curve(signal, time, corner):
    (label,) = time_plot({"y": signal}, TIMES).mark(time, "here").figure.axes[0].texts
    assert (label.get_ha(), label.get_va()) == corner


@pytest.mark.parametrize("level", [2, 4, -3, sympy.Rational(1, 2)])
def test_level_is_inside_the_frame_with_its_label(level):
    plot = time_plot({"y": LAG}, TIMES).level(level, "$KU$")
    axes = plot.figure.axes[0]
    assert axes.lines[-1].get_ydata() == [float(level)] * 2
    assert axes.get_ylim()[0] < level < axes.get_ylim()[1]
    plot.png()  # places everything
    assert axes.texts[0].get_window_extent().y1 <= axes.get_window_extent().y1 + 1


def test_description_says_what_is_shown():
    plot = time_plot([{"$y_1(t)$": t}, {r"$F_{\mathrm{in}}$": 1}], TIMES, title="Figure 6.1 · An integrator")
    assert repr(plot.mark(1, "$t = T$").level(3, "$y_s$")) == (
        "<Figure 6.1 · An integrator: y_1(t); F_in against t [s]; marked: t = T; level: y_s>"
    )


def test_style_is_left_alone_and_nothing_stays_open_in_pyplot():
    import matplotlib.pyplot as plt

    before = dict(plt.rcParams)
    time_plot({"y": LAG}, TIMES, title="x").mark(5, "63 %").level(2, "$KU$").png()
    block_diagram("u", 1 / s, "y").png()
    assert dict(plt.rcParams) == before
    assert plt.get_fignums() == []
    assert set(STYLE) <= set(before)


def test_image_has_its_printed_size_and_an_alternative_text():
    plot, same = (time_plot({"y": LAG}, TIMES, title="Figure 6.2").mark(5, "63 %") for _ in range(2))
    data, metadata = plot._repr_mimebundle_()
    assert data["image/png"] == same._repr_mimebundle_()[0]["image/png"]
    assert set(data) == {"image/png", "text/plain"}
    assert base64.b64decode(data["image/png"]).startswith(b"\x89PNG")
    assert metadata["image/png"]["alt"] == plot.alt == data["text/plain"].strip("<>")
    assert metadata["needs_background"] == "light"  # by which JupyterLab marks it
    assert metadata["image/png"]["width"] == pytest.approx(WIDTH * 96, rel=0.03)


def test_saves_as_a_file(tmp_path):
    time_plot({"y": LAG}, TIMES).save(tmp_path / "y.pdf")
    assert (tmp_path / "y.pdf").read_bytes().startswith(b"%PDF")


@pytest.mark.parametrize(
    ("signals", "times", "options", "message"),
    [
        ({"y": [1, 2]}, [0, 1, 2], {}, "y has 2 values for 3 times"),
        ({"y": np.ones((3, 3))}, [0, 1, 2], {}, "y has 9 values for 3 times"),
        ({"y": t}, [0], {}, "the number of times is 1: expected 2 or more"),
        ({"y": (t, "output")}, [0, 1], {}, "the role is 'output': expected one of setpoint, measurement, "),
        ({"y": "t**2"}, [0, 1], {}, "y must be a SymPy expression in t or an array of numbers"),
        ({"y": sympy.Eq(t, 1)}, [0, 1], {}, "y must be a SymPy expression in t or an array of numbers"),
        ({"y": sympy.Symbol("K") * t}, [0, 1], {}, "give a number for K"),
        ({"y": DiracDelta(t)}, [0, 1], {}, "an impulse has an area but no value"),
        ([{"y": t}, {"y": 2 * t}], [0, 1], {}, "two signals have the same label: y, y"),
        ([], [0, 1], {}, "signals must be {label: signal}"),
        (t, [0, 1], {}, "signals must be {label: signal}"),
        ({"y": t}, [0, 1], {"ylabel": ["a", "b"]}, "2 names of vertical axes for 1 panels"),
        ({"y": t}, [1, 2], {"before": 1}, "only in front of times that start at 0"),
        ({"y": t}, [0, 2], {"before": -1}, "only in front of times that start at 0"),
    ],
)
def test_bad_input_is_told_in_one_sentence(signals, times, options, message):
    with pytest.raises(ValueError, match=re.escape(message)) as error:
        time_plot(signals, times, **options)
    assert "\n" not in str(error.value)


def test_a_raw_signal_is_thin_and_behind_what_is_made_of_it():
    lines = time_plot({"filtered": (LAG, "measurement"), "raw": (t, "raw")}, TIMES).lines
    assert lines["raw"].get_zorder() < lines["filtered"].get_zorder()
    assert lines["raw"].get_linewidth() < lines["filtered"].get_linewidth() / 2


def shaded(axes):
    (area,) = [drawn for drawn in axes.collections if isinstance(drawn, PolyCollection)]
    (path,) = area.get_paths()
    return path


def test_an_area_lies_between_two_curves():
    plot = time_plot({"setpoint": (2, "setpoint"), "y": (LAG, "measurement")}, TIMES).area("y", "setpoint", "lost")
    path = shaded(plot.figure.axes[0])
    assert path.contains_points([(5, 1.5), (15, 1.95)]).all()
    assert not path.contains_points([(5, 1.2), (5, 2.1), (15, 1.85)]).any()
    assert texts(plot.figure.axes[0]) == ["lost"]
    assert plot.alt.endswith("; shaded: lost")


def test_an_area_above_an_axis_that_was_not_seen_is_seen():
    axes = time_plot({"y": LAG + 5}, TIMES).area("y").figure.axes[0]
    assert axes.get_ylim()[0] <= 0
    assert shaded(axes).contains_point((20, 0.1))


def test_an_area_under_a_signal_that_is_held_has_corners():
    run = simulate(WoodChipTank(), until=20, step=10, u=[45, 60, 50])
    path = shaded(trends(run).area("$u$").figure.axes[1])
    assert path.contains_points([(9.9, 44), (10.1, 59)]).all()
    assert not path.contains_point((9.9, 46))


def test_an_area_to_a_late_step_keeps_the_step_upright():
    plot = time_plot({"setpoint": (Heaviside(t - 5), "setpoint"), "y": 0}, TIMES).area("setpoint", "y")
    path = shaded(plot.figure.axes[0])
    assert path.contains_point((5.001, 0.99))
    assert not path.contains_point((4.999, 0.01))


def test_an_event_is_in_all_panels_with_words_that_hide_no_curve():
    plot = time_plot([{"y": 2}, {"u": t}], TIMES).event(10, "load").event(24, "the end is near")
    above, below = plot.figure.axes
    for axes in (above, below):
        moments = [x for line in axes.collections for segment in line.get_segments() for x in segment[:, 0]]
        assert moments == [10, 10, 24, 24]
    assert texts(above) == ["load", "the end is near"]
    assert texts(below) == []
    for words in above.texts:
        box = words.get_window_extent()
        assert above.bbox.x0 < box.x0
        assert box.x1 < above.bbox.x1
        assert not plot.lines["y"].get_path().transformed(above.transData).intersects_bbox(box, filled=False)


def test_the_words_at_events_are_not_behind_the_legend():
    plot = time_plot({"y": t / 25, "z": t**2 / 625}, TIMES)
    (axes,) = plot.figure.axes
    legend = axes.legend(loc="upper left")
    plot.event(2, "load").event(20, "setpoint")
    boxes = [words.get_window_extent() for words in axes.texts]
    assert not any(legend.get_window_extent().overlaps(box) for box in boxes)
    assert boxes[0].y1 < legend.get_window_extent().y0 < boxes[1].y0


def test_errors_have_a_panel_of_their_own_in_the_looks_of_their_curves():
    curves = {"process": (LAG, "process"), "model": (LAG + exp(-t), "model"), "other": (LAG - 0.1, "second model")}
    plot = time_plot([curves, {"u": (1, "control signal")}], TIMES, error_from="process", ylabel=["y", None])
    top, errors, control = plot.figure.axes
    assert [axes.get_ylabel() for axes in plot.figure.axes] == ["y", "error", "u"]
    assert (errors.get_xlabel(), control.get_xlabel()) == ("", "$t$ [s]")
    np.testing.assert_allclose(plot.lines["model, error"].get_ydata(), np.exp(-TIMES), atol=1e-12)
    np.testing.assert_allclose(plot.lines["other, error"].get_ydata(), -0.1, atol=1e-12)
    for label in ("model", "other"):
        line, error = plot.lines[label], plot.lines[f"{label}, error"]
        assert (line.axes, error.axes) == (top, errors)
        box = error.get_window_extent()
        assert errors.bbox.y0 < box.y0 <= box.y1 < errors.bbox.y1
        assert line.get_color() == error.get_color()
        assert line._unscaled_dash_pattern == error._unscaled_dash_pattern
    assert "difference from process" in plot.alt
    for wrong in ("plant", "u"):
        with pytest.raises(ValueError, match=f"the errors are from '{wrong}'"):
            time_plot([curves, {"u": 1}], TIMES, error_from=wrong)


def test_regions_are_named_where_there_is_room():
    plot = plane_plot({"border": ([1, 100], [1, 100])}, "$x$", "$y$", log=True, xlim=(1, 100), ylim=(1, 100))
    plot.region([1, 1e9, 1], [1, 1e9, 1e9], "above").region([1, 100, 100], [1, 100, 1], "below")
    above, below = plot.axes.texts
    for words, side in ((above, 1), (below, -1)):
        x, y = words.get_position()  # in the frame
        assert 0.2 < side * (y - x) < 0.8
        assert 0.1 < x < 0.9
        assert 0.1 < y < 0.9
    one, other = plot.axes.patches
    assert one.get_facecolor() != other.get_facecolor()
    assert one.get_xy().max() <= 100
    assert plot.alt.endswith("; region: above; region: below")
    assert plot.axes.get_legend() is None


def test_borders_of_regions_need_no_legend():
    curves = {"a": ([0, 1], [0, 1]), "b": ([0, 1], [1, 0])}
    assert plane_plot(curves, "x", "y").axes.get_legend() is not None
    assert plane_plot(curves, "x", "y", legend=False).axes.get_legend() is None


@pytest.mark.parametrize("order", [1, 2])
def test_the_half_rule_as_bars_is_the_half_rule(order):
    lags, theta = {"a": 3.0, "b": 8.0, "c": 1.0, "d": 0.4}, 0.5
    process = exp(-theta * s) / sympy.prod(value * s + 1 for value in lags.values())
    model = half_rule(process, order=order)
    plot = half_rule_plot(lags, {"theta": theta}, order=order, unit="min")
    axes = plot.figure.axes[0]
    assert axes.get_xlabel() == "[min]"
    rows = {}
    for bar in axes.patches:
        rows.setdefault(round(bar.get_y(), 3), []).append(bar)
    names = [label.get_text() for label in axes.get_yticklabels()]
    lengths = {
        name: sum(bar.get_width() for bar in rows[y]) for name, y in zip(names, sorted(rows, reverse=True), strict=True)
    }
    kept = [name for name in ("lag", "second lag") if name in lengths]
    assert len(kept) == order
    line = next(line for line in axes.lines if line.get_color() == GREY)  # the process above it, the model below it
    homes = {*kept, "dead time"}
    assert all((y < line.get_ydata()[0]) == (name in homes) for name, y in zip(names, axes.get_yticks(), strict=True))
    assert [lengths[name] for name in kept] == pytest.approx([float(T) for T in (model.T1, model.T2)][:order])
    assert lengths["dead time"] == pytest.approx(float(model.delay))
    assert sum(lengths[name] for name in (*kept, "dead time")) == pytest.approx(sum(lags.values()) + theta)
    assert {name: lengths[name] for name in lags} == pytest.approx(lags)


def test_a_half_rule_needs_lags():
    with pytest.raises(ValueError, match="order 2 with 1 lags"):
        half_rule_plot({"T": 1}, order=2)


@pytest.mark.parametrize(
    ("add", "message"),
    [
        (lambda plot: plot.mark(30, "late"), "cannot mark t = 30: the plot shows 0 to 25"),
        (lambda plot: plot.event(26, "late"), "cannot mark t = 26: the plot shows 0 to 25"),
        (lambda plot: plot.level(2, "$KU$", signal="z"), "no signal 'z' in this plot: expected one of a, b"),
        (lambda plot: plot.area("z"), "no signal 'z' in this plot"),
        (lambda plot: plot.area("a", "b"), "a and b are in two panels"),
        (lambda plot: plot.points([0, 2], [1], "data"), "2 times and 1 values"),
    ],
)
def test_bad_marks_are_told_in_one_sentence(add, message):
    with pytest.raises(ValueError, match=message):
        add(time_plot([{"a": 1}, {"b": t}], TIMES))


def test_points_are_added_and_stay_inside():
    plot = time_plot({"u": 1}, [0, 1, 2]).points([0, 2], [1, 7], "data")
    (axes,) = plot.figure.axes
    assert axes.get_ylim()[1] >= 7
    assert [text.get_text() for text in axes.get_legend().get_texts()] == ["u", "data"]


@pytest.mark.parametrize(("plot", "kind"), [(time_plot, TimePlot), (plane_plot, PlanePlot)])
def test_what_can_be_added_is_said_where_a_plot_is_made(plot, kind):
    (returns,) = re.findall(r"Returns:(.*?)Raises:", plot.__doc__, re.DOTALL)
    assert {f"``.{name}``" for name in vars(kind) if not name.startswith("_")} == set(re.findall(r"``[^`]*``", returns))


def test_black_and_white_has_two_bits_for_a_dot():
    drawing = Image.new("RGB", (40, 40), "white")
    for x, grey in enumerate([0, 60, 120, 170, 230]):
        drawing.putpixel((x, 0), (grey, grey, grey))
    few = with_few_colours(drawing).convert("L")
    assert {grey for _, grey in few.getcolors()} == {0, 100, 170, 255}
    assert [few.getpixel((x, 0)) for x in range(6)] == [0, 100, 100, 170, 255, 255]


def hidden(plot):
    """The curves of the first panel that run behind its legend."""
    plot.figure.draw_without_rendering()
    axes = plot.figure.axes[0]
    box = axes.get_legend().get_window_extent()
    return [
        line.get_label()
        for line in axes.lines
        if line.get_path().transformed(axes.transData).intersects_bbox(box, filled=False)
    ]


def test_a_low_figure_has_a_flat_legend():
    usual, low = (time_plot({f"y{n}": n * t for n in range(6)}, [0, 1], ylim=(0, 9), low=low) for low in (False, True))
    assert low.figure.get_figheight() < usual.figure.get_figheight()
    heights = [p.figure.axes[0].get_legend().get_window_extent().height for p in (usual, low)]
    assert heights[1] < heights[0] / 2


def test_a_legend_hides_no_curve():
    everywhere = {"one": sympy.sin(3 * t), "another": sympy.cos(3 * t), "a third": sympy.sin(2 * t)}
    assert hidden(time_plot(everywhere, TIMES)) == []
    assert hidden(time_plot(everywhere, TIMES, ylim=(-1, 1))) != []  # an axis that was asked for stays
    assert time_plot({"a": LAG, "b": 1}, TIMES).figure.axes[0].get_ylim()[1] < 2.3  # there is room


def test_a_formula_is_read_once_for_all_figures(monkeypatch):
    read, parse = [], Parser.parse
    monkeypatch.setattr(Parser, "parse", lambda self, *what: read.append((what[0], what[2])) or parse(self, *what))
    for _ in range(2):
        time_plot({"$q_{once}$": LAG, "$q_{twice}$": 1}, TIMES, xlabel="$t_{only}$").png()
        block_diagram("q_once", block(r"\frac{K}{T_{only}s}"), "y").png()
    assert len(read) == len(set(read))
    assert {text for text, _ in read} >= {"$q_{once}$", "$t_{only}$", r"$\dfrac{K}{T_{only}s}$"}


def test_a_figure_is_drawn_in_one_pass_and_nothing_is_cut_off(monkeypatch):
    draws = []
    draw = Figure.draw
    monkeypatch.setattr(Figure, "draw", lambda *arguments: draws.append(arguments) or draw(*arguments))
    plot = time_plot({"$y$": LAG, "$u$": 1}, TIMES, title="A title that goes on and on " * 3)
    image = Image.open(io.BytesIO(plot.png())).convert("L")
    assert len(draws) == 1
    dots = np.asarray(image)
    assert {*dots[0], *dots[-1], *dots[:, 0], *dots[:, -1]} == {255}
    assert image.width > WIDTH * DOTS_PER_INCH  # because of the title
    assert time_plot({"y": LAG}, TIMES).figure.bbox_inches.p0.tolist() == plot.figure.bbox_inches.p0.tolist() == [0, 0]


def test_the_axes_of_all_figures_begin_in_one_line():
    plane = plane_plot({"a": ([0, 1], [0, 1])}, "x", "y")
    lefts = set()
    for plot in (time_plot({"y": 1000 * LAG}, TIMES), time_plot({"y": LAG}, TIMES), plane):
        image = np.asarray(Image.open(io.BytesIO(plot.png())).convert("L"))
        lefts.add(int(np.flatnonzero((image < 60).mean(axis=0) > 0.5)[0]))  # the axis is the first upright line
    assert len(lefts) == 1


def test_a_legend_over_a_map_does_not_look_for_a_free_place():
    class Cells(QuadMesh):
        """What a later version of Matplotlib may return."""

    plot = map_plot([1, 2, 3], [1, 2, 3], np.eye(3), "$x$", "$y$", "poles")
    plot.axes.collections[0].__class__ = Cells
    plot.points([2], [2], "settings")
    assert plot.axes.get_legend()._get_loc() == Legend.codes["upper right"]


@pytest.mark.parametrize("corner", [(0, 0), (0, 1), (1, 0), (1, 1)])
def test_a_legend_over_levels_is_where_no_level_is(corner):
    x = np.linspace(0, 1, 101)
    far = np.hypot(*np.meshgrid(x - corner[0], x - corner[1]))  # the levels are around all corners but one
    plot = level_plot(x, x, far, np.linspace(0.6, 1.3, 15), "$x$", "$y$", "distance").points([0.5], [0.5], "here")
    box = plot.axes.get_legend().get_window_extent()
    levels = plot.axes.transData.transform(
        np.concatenate([path.vertices for path in plot.axes.collections[0].get_paths()])
    )
    assert box.count_contains(levels) == 0
    assert not box.overlaps(plot.axes.texts[0].get_window_extent())


@pytest.mark.parametrize("point", [(x, y) for x in (0.2, 5, 9.8) for y in (-0.9, 0, 0.9)])
def test_words_beside_a_point_stay_within_their_panel(point):
    plot = plane_plot({"": ([0, 10], [-1, 1])}, "x", "y")
    words = free_place(plot.axes, "phase margin 61°", point).get_window_extent()
    panel = plot.axes.get_window_extent()
    assert panel.x0 <= words.x0 < words.x1 <= panel.x1
    assert panel.y0 <= words.y0 < words.y1 <= panel.y1


def test_a_legend_below_stays_there_with_its_columns():
    plot = nyquist_plot(exp(-s) / (s + 1))
    before = plot.axes.get_legend()
    after = plot.points([0.5], [0], "a point").axes.get_legend()
    assert before._ncols == after._ncols == 2
    assert after.get_bbox_to_anchor().y1 == before.get_bbox_to_anchor().y1 < plot.axes.bbox.y0
    assert after.get_texts()[-1].get_text() == "a point"


# Trends.


class TankInHours(WoodChipTank):
    """The same tank with the times of its quantities in hours."""

    time_unit = "h"


def test_the_unit_of_time_is_the_plants():
    run = simulate(TankInHours(), until=20, step=10, u=45)
    assert (TankInHours().time_unit, WoodChipTank().time_unit, run.time_unit) == ("h", "s", "h")
    assert trends(run).alt == "h; u against t [h]"
    assert simulate(TankInHours(), until=30, step=10, u=45, after=run).time_unit == "h"
    in_minutes = trends(run, minutes=True)
    assert in_minutes.figure.axes[-1].get_xlabel() == "$t$ [min]"
    np.testing.assert_allclose(in_minutes.lines["$h$"].get_xdata(), [0, 600, 1200], rtol=1e-15)
    with pytest.raises(ValueError, match="the runs have times in h and in s: expected one unit"):
        trends({"a": run, "b": simulate(WoodChipTank(), until=20, step=10, u=45)})


def test_minutes_of_an_unknown_unit_are_refused():
    response = replace(Loop(1 / (s + 1), PID(1)).run([0, 1, 2]), time_unit="years")
    assert trends(response).figure.axes[-1].get_xlabel() == "$t$ [years]"
    with pytest.raises(ValueError, match="the run's unit of time is 'years': expected one of s, min, h, d"):
        trends(response, minutes=True)


def loop(Kp, **options):
    controller = Controller(PID(Kp, 917), step=10, u0=45, limits=(0, 100), measurement_range=(0, 15))
    signals = {"setpoint": stepwise(10, {100: 11}), "w_out": stepwise(25, {500: 30})} | options
    return simulate(WoodChipTank(), controller, until=1000, **signals)


def test_trends_show_the_loop_as_an_operator_sees_it():
    run = loop(1.35, noise=0.1)
    plot = trends(run, "Figure 1.3", disturbances=["w_out"], minutes=True)
    top, middle, bottom = plot.figure.axes
    assert [axes.get_ylabel() for axes in (top, middle, bottom)] == ["$h$ [m]", "$u$ [%]", "$w_{out}$ [kg/s]"]
    assert bottom.get_xlabel() == "$t$ [min]"
    np.testing.assert_array_equal(plot.lines["$h$"].get_xdata(), run.times / 60)
    for label, name, role in [
        ("setpoint", "setpoint", "setpoint"),
        ("$h$", "h", "measurement"),
        ("$u$", "u", "control signal"),
        ("$w_{out}$", "w_out", "disturbance"),
    ]:
        np.testing.assert_array_equal(plot.lines[label].get_ydata(), run[name])
        assert plot.lines[label].get_color() == ROLES[role]["color"]
    styles = {label: line.get_drawstyle() for label, line in plot.lines.items()}
    assert styles == {"setpoint": "steps-post", "$h$": "default", "$u$": "steps-post", "$w_{out}$": "steps-post"}
    swinging = trends(loop(1, w_out=25 + sympy.sin(t)), disturbances=["w_out"])
    assert swinging.lines["$w_{out}$"].get_drawstyle() == "default"
    assert trends(run, measured=True).lines["$h$"].get_ydata()[3] == run["measurement"][3] != run["h"][3]


def test_trends_compare_runs_in_one_colour_each():
    plot = trends({"slow": loop(0.5), "fast": loop(2)}, limits=(9, 12))
    assert list(plot.lines) == ["setpoint", "$h$, slow", "$h$, fast", "$u$, slow", "$u$, fast"]
    for label in ("slow", "fast"):
        assert plot.lines[f"$h$, {label}"].get_color() == plot.lines[f"$u$, {label}"].get_color()
    assert plot.figure.axes[0].get_ylim() == (9, 12)
    assert [axes.get_legend() is not None for axes in plot.figure.axes] == [True, False]


def test_trends_of_a_plant_alone_and_of_runs_that_do_not_fit():
    short = simulate(WoodChipTank(), until=500, step=10, u=50)
    assert list(trends(short).lines) == ["$h$", "$u$"]
    with pytest.raises(ValueError, match="different times"):
        trends({"a": short, "b": loop(1)})
    with pytest.raises(ValueError, match="different signals 'setpoint'"):
        trends({"a": loop(1), "b": loop(1, setpoint=10)})
    for wrong in ({}, [short]):
        with pytest.raises(ValueError, match="expected a run"):
            trends(wrong)
    with pytest.raises(ValueError, match="expected a list of names"):
        trends(short, disturbances="w_out")
    with pytest.raises(ValueError, match="'wind'"):
        trends(short, disturbances=["wind"])


def test_trends_of_loops_with_exact_dead_time():
    process = exp(-s) / (s + 1)
    load = stepwise(0, {4: 1})
    runs = {f"{Kp}": Loop(process, PID(Kp, Ti=1)).run(np.linspace(0, 8, 81), load=load) for Kp in (0.3, 0.6)}
    plot = trends(runs, "Two gains", disturbances=["d"])
    assert plot.alt == "Two gains: setpoint, y, 0.3, y, 0.6; u, 0.3, u, 0.6; d against t [s]"
    np.testing.assert_array_equal(plot.lines["$y$, 0.6"].get_ydata(), runs["0.6"]["y"])
    assert plot.lines["$d$"].get_drawstyle() == "steps-post"


def test_a_plane_shows_curves_areas_points_and_words():
    ratios = np.geomspace(0.5, 2, 7)
    plot = plane_plot({"PI": (ratios, 1 / ratios), "PID": (ratios, 2 / ratios)}, "gain ratio", "delay ratio", log=True)
    before = plot.axes.get_xlim(), plot.axes.get_ylim()
    plot.area([1, 2, 1, 0.5], [2, 1, 0.5, 1], "window").points([1], [1], "tuned for").text(1.8, 1.8, "unstable")
    assert (plot.axes.get_xlim(), plot.axes.get_ylim()) == before
    assert [text.get_text() for text in plot.axes.get_legend().get_texts()] == ["PI", "PID", "window", "tuned for"]
    assert plot.axes.get_xscale() == plot.axes.get_yscale() == "log"
    assert texts(plot.axes) == ["unstable"]
    assert plot.alt == ("PI, PID: delay ratio against gain ratio; area: window; points: tuned for; unstable")
    assert plot.axes.lines[0].get_color() != plot.axes.lines[1].get_color()


def test_complex_numbers_have_equal_axes():
    circle = np.exp(1j * np.linspace(0, 6, 100))
    plot = plane_plot({"circle": (circle.real, circle.imag, "setpoint")}, "real", "imaginary", equal=True)
    assert plot.axes.get_aspect() == 1
    assert plot.axes.lines[0].get_color() == ROLES["setpoint"]["color"]


def test_a_map_has_one_grey_for_each_number():
    numbers = np.array([[0, 0, 2], [0, 2, 4], [-1, 4, 8]])
    plot = map_plot([1, 2, 3], [10, 20, 30], numbers, "$x$", "$y$", "poles")
    mesh = plot.axes.collections[0]
    np.testing.assert_array_equal(mesh.get_array(), [[0, 0, 1], [0, 1, 2], [0, 2, 3]])
    colours = [tuple(mesh.cmap(n)) for n in range(4)]
    assert colours[0] == (1, 1, 1, 1)
    assert [c[0] for c in colours] == sorted((c[0] for c in colours), reverse=True)
    assert len(set(colours)) == 4
    scale = plot.figure.axes[1]
    assert [label.get_text() for label in scale.get_yticklabels()] == ["0", "2", "4", "8"]


def test_levels_are_where_the_values_are():
    x, y = np.linspace(1, 3, 41), np.linspace(1, 2, 31)
    values = np.outer(y, x)
    values[values > 5] = np.inf  # unstable there
    plot = level_plot(x, y, values, [2, 4, 5.5], "$x$", "$y$", "$xy$")
    paths = plot.axes.collections[0].get_paths()
    for level, path in zip([2, 4], paths, strict=False):
        assert path.vertices.prod(axis=1) == pytest.approx(level, rel=1e-3)
    assert len(paths[2].vertices) == 0
    assert {text.get_text() for text in plot.axes.texts} == {"2", "4"}


def test_what_makes_no_plane():
    with pytest.raises(ValueError, match=r"shape \(2, 3\): expected \(3, 2\)"):
        level_plot([1, 2], [1, 2, 3], np.zeros((2, 3)), [1], "x", "y", "n")
    with pytest.raises(ValueError, match=r"expected .* with at least one"):
        plane_plot({}, "x", "y")
    with pytest.raises(ValueError, match="limit has 2 values for x and 3 for y"):
        plane_plot({"limit": ([1, 2], [1, 2, 3])}, "x", "y")
    with pytest.raises(ValueError, match=r"shape \(2, 3\): expected \(3, 2\)"):
        map_plot([1, 2], [1, 2, 3], np.zeros((2, 3)), "x", "y", "n")


def test_a_panel_goes_without_a_legend_only_below_one_that_explains_its_responses():
    first = {"y, PI": ([0, 1], 0), "y, PID": ([1, 0], 1)}
    same = time_plot([first, {"u, PI": ([2, 1], 0), "u, PID": ([1, 2], 1)}], [0, 1])
    other = time_plot([first, {"inflow": ([2, 1], 0), "outflow": ([1, 2], 1)}], [0, 1])
    assert [axes.get_legend() is not None for axes in same.figure.axes] == [True, False]
    assert [axes.get_legend() is not None for axes in other.figure.axes] == [True, True]
