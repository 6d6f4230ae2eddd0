"""Block diagrams: what is drawn, where, and that every label has its room."""

import functools
import itertools
import sys

import pytest
import sympy
from matplotlib.patches import Polygon

from loopbook.diagrams import (
    block,
    block_diagram,
    conveyor_belt,
    delay,
    disturbance,
    division,
    elementary_blocks,
    equivalent_diagrams,
    feedback_loop,
    gain,
    integrator,
    multiplication,
    overall_diagram,
    parallel_paths,
    sum_of,
)
from pictures import assert_orthogonal, assert_tidy, measured, signs_near, within
from plainmath.expressions import s

K, T, T1, T2, a, tau = sympy.symbols("K T T_1 T_2 a tau")
H1, H2, H3 = (sympy.Function(f"H_{n}")(s) for n in (1, 2, 3))

EXAMPLES = {
    "Figure 5.1": lambda: block_diagram(
        sum_of(["u_1(s)", K / (s - a), "y_1(s)"], ["u_2(s)", H2, "y_2(s)"], ["y_0", 1 / (s - a), "y_{init}(s)"]), "y(s)"
    ),
    "Figure 5.2": lambda: equivalent_diagrams(
        {
            "Series": (["u", H1, H2, "y"], ["u", H1 * H2, "y"]),
            "Parallel": (["u", parallel_paths(H1, H2), "y"], ["u", H1 + H2, "y"]),
            "Feedback": (["u", feedback_loop(H1, H2), "y"], ["u", H1 / (1 + H1 * H2), "y"]),
        }
    ),
    "Figure 6.3": lambda: conveyor_belt(),
    "Figure 6.5": lambda: block_diagram("u(s)", 1 / (T1 * s + 1), "y_1(s)", 1 / (T2 * s + 1), "y_2(s)"),
    "loop": lambda: block_diagram(
        "y_{SP}", feedback_loop(["e", K * (1 + 1 / (T * s)), "u", K * sympy.exp(-tau * s) / (T * s + 1)], [1 / s]), "y"
    ),
    "unity": lambda: block_diagram("r", feedback_loop(["e", parallel_paths(H1, H2, H3, signs="+-+"), "u", H1]), "y"),
    "nested": lambda: block_diagram("u", feedback_loop(feedback_loop(H1, H2), parallel_paths(H2, H3)), "y"),
    "Figure 1.1": lambda: block_diagram(
        "y_SP",
        feedback_loop(
            ["e", block("Controller"), "u", block("Process", above=["d"])],
            [block("Sensor", below=["n"]), "y_m", block("Measurement\nfilter"), "y_mf"],
        ),
        "y",
    ),
    "Figure 2.5": lambda: block_diagram(
        "F",
        feedback_loop(
            [
                feedback_loop([division("m"), r"\ddot{y}", integrator(r"\dot{y}(0)")], multiplication("D")),
                r"\dot{y}",
                integrator("y(0)"),
            ],
            multiplication("K"),
        ),
        "y",
    ),
    "Figure 3.5": lambda: block_diagram(
        "q_i", disturbance("q_o", sign="-"), division("A"), integrator("h_0", limits=["h_min", "h_max"]), "h"
    ),
    "Figure 7.14": lambda: block_diagram(
        "y_SP",
        feedback_loop(
            ["e", H1, "u", H2, disturbance("d", block(r"\frac{K_d}{T_d s+1}"))], [disturbance("n", side="below"), H3]
        ),
        "y",
    ),
    "two disturbances": lambda: block_diagram(
        "u", disturbance("v", H1, H2, side="below"), disturbance("d", H1 / (1 + H2 * s), sign="-"), "y"
    ),
    "overall": lambda: overall_diagram("Tank", ["P", "Q"], ["T_i", "T_e"], ["c", "m", "U_h"], ["T", "h"]),
    "long": lambda: block_diagram("a long name of a signal", block(r"\frac{s^4+a s^3+b s^2+c s+d}{s^5+e s^4+1}"), "y"),
}


EXAMPLES = {name: functools.cache(make) for name, make in EXAMPLES.items()}  # each is drawn once


@pytest.mark.parametrize("name", EXAMPLES)
def test_labels_fit_inside_their_blocks_and_never_overlap(name):
    picture = EXAMPLES[name]()
    assert_tidy(picture)
    texts, boxes, circles, _, _ = measured(picture)
    inside = [label for label in texts if any(box.overlaps(label[1]) for box in boxes)]
    assert len(inside) == len(boxes)
    for label, extent in inside:
        assert any(within(extent, box, margin=0.1) for box in boxes), label
    for label, extent in texts:
        assert not any(extent.contains(*circle.center) for circle in circles), label


@pytest.mark.parametrize("name", [name for name in EXAMPLES if name != "Figure 6.3"])  # where the chute is slanted
def test_lines_are_orthogonal_and_cross_no_block(name):
    assert_orthogonal(EXAMPLES[name]())


@pytest.mark.parametrize("name", EXAMPLES)
def test_arrow_heads_are_alike(name):
    _, _, _, heads, _ = measured(EXAMPLES[name]())
    sizes = {tuple(sorted(round(float(side), 6) for side in head.max(axis=0) - head.min(axis=0))) for head in heads}
    assert sizes == {(0.19, 0.26)}


def test_series_runs_from_left_to_right_on_one_axis():
    texts, boxes, circles, heads, wires = measured(block_diagram("u", H1, "x", H2, "y"))
    assert [text for text, _ in sorted(texts, key=lambda item: item[1].x0)] == [
        "$u$", r"$H_{1}(s)$", "$x$", r"$H_{2}(s)$", "$y$",
    ]  # fmt: skip
    assert circles == []
    assert len(heads) == len(wires) == 3
    assert {y for wire in wires for _, y in wire} == {0}
    tips = sorted(head[:, 0].max() for head in heads)
    assert tips[:2] == pytest.approx(sorted(box.x0 for box in boxes))


@pytest.mark.parametrize(
    ("part", "expected"),
    [
        (parallel_paths(H1, H2), [("+", "above"), ("+", "below")]),
        (parallel_paths(H1, H2, signs="+-"), [("+", "above"), ("-", "below")]),
        (parallel_paths(H1, H2, H3, signs="-+-"), [("-", "above"), ("-", "below"), ("+", "left")]),
        (feedback_loop(H1, H2), [("-", "below"), ("+", "left")]),
        (feedback_loop(H1, H2, sign="+"), [("+", "below"), ("+", "left")]),
        (feedback_loop(H1), [("-", "below"), ("+", "left")]),
    ],
)
def test_signs_stand_beside_the_path_that_they_belong_to(part, expected):
    texts, _, circles, _, _ = measured(block_diagram("u", part, "y"))
    (junction,) = [circle for circle in circles if circle.radius > 0.1]
    (branch,) = [circle for circle in circles if circle.radius < 0.1]
    assert signs_near(texts, *junction.center) == expected
    assert branch.center[1] == junction.center[1] == 0


def test_feedback_runs_back_below_from_the_branch_point_to_the_junction():
    _, boxes, circles, heads, wires = measured(block_diagram("u", feedback_loop(H1, H2), "y"))
    junction, branch = sorted(circles, key=lambda circle: circle.center[0])
    forward, back = sorted(boxes, key=lambda box: -box.y0)
    assert back.y1 < forward.y0
    assert junction.center[0] < back.x0 < back.x1 < branch.center[0]
    into_back = [head for head in heads if head[:, 0].min() == pytest.approx(back.x1)]
    assert len(into_back) == 1
    up = [wire for wire in wires if wire[0][0] == wire[-1][0] == pytest.approx(junction.center[0])]
    assert len(up) == 1
    assert up[0][0][1] == pytest.approx((back.y0 + back.y1) / 2)


def test_inputs_and_blocks_of_a_sum_stand_in_columns():
    texts, boxes, circles, _, wires = measured(EXAMPLES["Figure 5.1"]())
    assert len({round(box.x0, 6) for box in boxes}) == 1
    assert [wire[0][0] for wire in wires].count(0) == 3
    assert len(circles) == 1
    assert signs_near(texts, *circles[0].center) == [("+", "above"), ("+", "below"), ("+", "left")]


def test_rows_of_equivalent_diagrams_do_not_touch():
    texts, *_ = measured(EXAMPLES["Figure 5.2"]())
    captions = {text: extent for text, extent in texts if text in ("Series", "Parallel", "Feedback")}
    assert captions["Series"].y0 > captions["Parallel"].y1 > captions["Feedback"].y1
    assert len({round(extent.x0, 2) for extent in captions.values()}) == 1
    assert [text for text, _ in texts].count(r"$\Leftrightarrow$") == 3


@pytest.mark.parametrize("side", ["above", "below"])
@pytest.mark.parametrize("sign", ["+", "-"])
def test_a_disturbance_enters_a_junction_from_its_side_through_its_block(side, sign):
    picture = block_diagram("u", disturbance("d", H1, sign=sign, side=side), "y")
    texts, (box,), (junction,), heads, _ = measured(picture)
    x, y = junction.center
    extents = dict(texts)
    up = 1 if side == "above" else -1
    assert y == 0
    assert (box.x0 + box.x1) / 2 == pytest.approx(x)
    assert up * box.y0 > 0
    assert up * (extents["$d$"].y0 - (box.y1 if up > 0 else box.y0)) > 0
    assert signs_near(texts, x, y) == sorted([(sign, side), ("+", "left")], key=lambda item: item[1])
    ends = sorted(up * head[1][1] for head in heads if head[1][0] == pytest.approx(x))  # the second corner is the tip
    assert ends == pytest.approx([junction.radius, up * (box.y1 if up > 0 else box.y0)])
    assert repr(picture) == f"<block diagram: u → ({sign} d → [H_1(s)] from {side}) → y>"


def test_a_disturbance_without_a_name_and_with_a_wide_block():
    wide = block(r"\frac{s^4+a s^3+b s^2+c s+d}{s^5+e s^4+1}")
    picture = block_diagram("u", H1, disturbance("", wide), H2, "y")
    texts, boxes, (junction,), heads, _ = measured(picture)
    assert len(texts) == 7
    assert not any(one.overlaps(other) for one, other in itertools.combinations(boxes, 2))
    assert any(tuple(head[1]) == pytest.approx((junction.center[0] - junction.radius, 0)) for head in heads)


@pytest.mark.parametrize(
    ("part", "label", "entries"),
    [
        (integrator(), r"$\int$", []),
        (integrator("y_0", limits=["a", "b"]), r"$\int$", ["$y_0$", "$a$", "$b$"]),
        (multiplication("K"), r"$\times$", ["$K$"]),
        (division("A"), r"$\div$", ["$A$"]),
        (block("f(u)", above=["d"], below=["a", "b", "c"]), "$f(u)$", ["$d$", "$a$", "$b$", "$c$"]),
        (delay(), "Delay\n$\\tau$", []),
    ],
)
def test_values_enter_a_block_by_arrows_that_end_at_it(part, label, entries):
    texts, (box,), _, heads, _ = measured(block_diagram("u", part, "y"))
    assert [text for text, _ in texts if text not in ("$u$", "$y$")] == [label, *entries]
    vertical = [head[1][1] for head in heads if box.x0 < head[1][0] < box.x1]
    assert len(vertical) == len(entries)
    assert all(y in (pytest.approx(box.y0), pytest.approx(box.y1)) for y in vertical)


def test_a_gain_is_a_triangle_that_points_along_the_signal():
    figure = block_diagram("u", feedback_loop(gain("K"), gain("L")), "y").figure
    triangles = [p.get_xy() for p in figure.axes[0].patches if isinstance(p, Polygon) and p.get_facecolor()[0] == 1]
    tips = [corners[2][0] - corners[0][0] for corners in triangles]
    assert len(tips) == 2
    assert tips[0] > 0 > tips[1]


def test_an_overall_diagram_has_each_kind_of_variable_on_its_side():
    texts, (box,), _, heads, _ = measured(EXAMPLES["overall"]())
    place = {text: ((extent.x0 + extent.x1) / 2, (extent.y0 + extent.y1) / 2) for text, extent in texts}
    assert all(place[name][0] < box.x0 for name in ("$P$", "$Q$"))
    assert all(place[name][0] > box.x1 for name in ("$T$", "$h$"))
    assert all(place[name][1] > box.y1 for name in ("$T_i$", "$T_e$"))
    assert all(place[name][1] < box.y0 for name in ("$c$", "$m$", "$U_h$"))
    assert len(heads) == 9
    assert EXAMPLES["overall"]().alt == (
        "overall block diagram: P, Q → [Tank; from above T_i, T_e; from below c, m, U_h] → T, h"
    )


def test_the_table_of_elementary_blocks_names_each_with_its_formula():
    picture = elementary_blocks(title="Figure 2.2")
    texts, *_ = measured(picture)
    shown = [text for text, _ in texts]
    assert [name for name in shown if name.isalpha()] == ["Integrator", "Sum", "Multiplication", "Division", "Gain"]
    assert "Time delay: u → [delay tau] → y means y(t) = u(t - tau)" in picture.alt
    assert_tidy(picture)


@pytest.mark.parametrize(
    ("expression", "label"),
    [
        (K / (s - a), r"$\dfrac{K}{s - a}$"),
        (1 / (T * s + 1), r"$\dfrac{1}{T s + 1}$"),
        (1 / (s**2 + 2 * a * s + 1), r"$\dfrac{1}{s^{2} + 2 a s + 1}$"),
        (1 / (1 + H1), r"$\dfrac{1}{1 + H_{1}(s)}$"),
        (sympy.exp(-tau * s), r"$e^{-\tau s}$"),
        (2, "$2$"),
    ],
)
def test_expressions_are_written_as_books_do(expression, label):
    texts, *_ = measured(block_diagram("u", expression, "y"))
    assert label in [text for text, _ in texts]


def test_labels_of_ones_own():
    texts, *_ = measured(block_diagram("$u$ [V]", block(r"\frac{K}{Ts+1}"), "y_1", block("Valve $K_v$")))
    assert {text for text, _ in texts} == {"$u$ [V]", r"$\dfrac{K}{Ts+1}$", "$y_1$", "Valve $K_v$"}


def test_conveyor_delay_spans_from_the_inflow_to_the_outflow():
    texts, _, _, _, wires = measured(conveyor_belt(title="Figure 6.3"))
    assert [text for text, _ in texts] == [r"$F_{\mathrm{in}}$", r"$F_{\mathrm{out}}$", r"$\tau$"]
    down = [wire for wire in wires if wire[0][0] == wire[-1][0] and wire[0][1] - wire[-1][1] > 1]
    inflow, outflow = sorted(wire[0][0] for wire in down)
    dimension = min((wire for wire in wires if wire[0][1] == wire[-1][1]), key=lambda wire: wire[0][1])
    drawn = [x for x, _ in dimension]
    assert (min(drawn), max(drawn)) == pytest.approx((inflow, outflow), abs=0.3)  # the heads take the rest


def test_description_and_title():
    picture = block_diagram("u", feedback_loop(H1), "y", title="Figure 7.1")
    assert repr(picture) == "<Figure 7.1: block diagram: u → (loop [H_1(s)], back - 1) → y>"
    assert picture.figure.axes[0].get_title(loc="left") == "Figure 7.1"
    assert picture.png() == picture.png()


def test_without_schemdraw_a_sentence_says_what_to_install(monkeypatch):
    monkeypatch.setitem(sys.modules, "schemdraw", None)
    with pytest.raises(ImportError, match=r"schemdraw draws the diagrams: install loopbook\[diagrams\]"):
        block_diagram("u", H1, "y")


@pytest.mark.parametrize(
    ("make", "message"),
    [
        (lambda: block_diagram("u", "v", H1), "there must be a block between the signals u and v"),
        (lambda: block_diagram("u", None, "y"), "None is not a part of a block diagram"),
        (lambda: block_diagram("u", sum_of(["a", H1], ["b", H2])), "sum_of brings its own signals"),
        (lambda: sum_of([H1], ["b", H2]), "each path of sum_of begins with the name of its signal"),
        (lambda: parallel_paths(H1), "room for two or three paths, not 1"),
        (lambda: parallel_paths(H1, H2, signs="+"), "signs must be one . or - for each of the 2 paths, not '.'"),
        (lambda: feedback_loop(H1, sign="negative"), "the sign of a feedback or disturbance is - or ., not 'negative'"),
        (lambda: disturbance("d", sign="*"), "the sign of a feedback or disturbance is - or ., not '.'"),
        (lambda: disturbance("d", side="left"), "the side is above or below, not 'left'"),
        (lambda: disturbance("d", parallel_paths(H1, H2)), "between a disturbance and its junction stand blocks only"),
        (lambda: integrator(limits=["a"]), "the limits of an integrator are its lowest and its highest value"),
        (lambda: block("f", above="d"), "'d' must be a list of names"),
        (lambda: equivalent_diagrams({"Series": ["u"]}), "rules must be {name: "),
    ],
)
def test_bad_input_is_told_in_one_sentence(make, message):
    with pytest.raises(ValueError, match=message):
        make()
