"""Sequential function charts and state diagrams as drawings: all of the chart is there, and nothing overlaps."""

import itertools

import pytest
from hypothesis import HealthCheck, given, settings
from matplotlib.patches import Polygon

from draws import draws
from loopbook.diagrams import sequential_function_chart, state_diagram
from loopbook.sequence import Chart, Transition
from pictures import assert_tidy, measured, within
from test_sequence import chart, structured

TANK = Chart(
    "h T restart acknowledge",
    {"u_valve_in": False, "u_valve_out": False, "u_motor": False, "heating": False, "batches": 0},
    {
        "Idle": {},
        "Fill": {"u_valve_in": True},
        "Heat": {"u_valve_in": False, "u_motor": True, "heating": True},
        "Discharge": {"heating": False, "u_motor": False, "u_valve_out": True},
        "Finished": {"u_valve_out": False, "batches": "batches + 1"},
        "End": {},
        "Alarm": {"u_valve_in": False},
    },
    "Idle",
    [
        Transition("Idle", "Fill"),
        Transition("Fill", "Heat", "h >= 0.9"),
        Transition("Fill", "Alarm", "Fill.T > 400"),
        Transition("Alarm", "Idle", "acknowledge"),
        Transition("Heat", "Discharge", "Heat.T >= 1800"),
        Transition("Discharge", "Finished", "h <= 0.1"),
        Transition("Finished", "Fill", "restart AND batches < 2 AND NOT (h > 0.5 OR T > 90) AND NOT acknowledge"),
        Transition("Finished", "End", "NOT restart"),
    ],
    final="End",
)
ACTIONS = {"A": {"y": True}, "B": {"n": 1, "y": False}, "C": {"y": False}, "D": {"n": "n + 1"}, "E": {}, "F": {}}
CHARTS = {
    "tank": TANK,
    "one step": chart("A", [], final="A"),
    "own successor": chart("A", [("A", "A", "a")]),
    "simultaneous": chart(ACTIONS, [("A", ("B", "C", "D"), "a"), (("B", "C", "D"), "E"), ("E", "F"), ("F", "A")]),
    "three alternatives": chart(
        ACTIONS, [*(("A", x, y) for x, y in zip("BCD", "abc", strict=True)), ("B", "E"), ("C", "A", "d"), ("D", "E"),
                  ("E", "F"), ("F", "A", "a")]
    ),
    "skip and repeat": chart(
        ACTIONS, [("A", "B", "a"), ("A", "D", "b"), ("B", "C"), ("C", "D", "c"), ("C", "B", "d"), ("D", "E"),
                  ("E", "F"), ("F", "A")]
    ),
    "converges in two stages": chart(
        ACTIONS, [("A", ("B", "C", "D"), "a"), (("B", "D"), "E", "b"), (("E", "C"), "F"), ("F", "A")]
    ),
    "begins anew in two steps": chart("ABCD", [("A", ("B", "C")), (("B", "C"), "D", "a"), ("D", ("B", "C"), "b"),
                                              ("D", "A", "c")]),
    "converges here or there": chart(
        "ABCDEFG", [("A", ("B", "C")), ("B", "D", "a"), ("B", "E", "b"), (("D", "C"), "F", "c"), (("E", "C"), "G", "d"),
                    ("F", "A"), ("G", "A")]
    ),
    "two goals in common": chart(
        "ABCDEF", [("A", "B", "a"), ("A", "C", "b"), ("B", "D", "c"), ("B", "E", "d"), ("C", "D", "c"), ("C", "E", "d"),
                   ("D", "F"), ("E", "F"), ("F", "A")]
    ),
}  # fmt: skip


def lines_of(picture):
    """What stands in the drawing, each text once."""
    (axes,) = picture.figure.axes
    return [text.get_text() for text in axes.texts]


def nothing_overlaps(picture):
    texts, boxes, circles, _, wires = measured(picture)
    (axes,) = picture.figure.axes
    states = [p.get_path().get_extents() for p in axes.patches if isinstance(p, Polygon) and len(p.get_xy()) > 10]
    assert_tidy(picture, beyond=0.12)
    for label, extent in texts:
        for box in [*boxes, *states]:
            assert within(extent, box, margin=0.02) or not extent.overlaps(box), label
    outer = [box for box in boxes if not any(within(box, other) for other in boxes if other is not box)]
    for one, other in itertools.combinations([*outer, *states], 2):
        assert not one.overlaps(other)
    for wire in wires:
        for (x0, y0), (x1, y1) in itertools.pairwise(wire):
            assert min(abs(x0 - x1), abs(y0 - y1)) < 1e-9, "orthogonal"
            line = type(texts[0][1]).from_extents(min(x0, x1), min(y0, y1), max(x0, x1), max(y0, y1))
            for label, extent in texts:
                assert not crosses(line, extent), (label, wire)
            for box in outer:
                assert not crosses(line, box), wire
            for box in states:  # the line under a state's name goes from side to side
                assert not crosses(line, box) or within(line, box, margin=-1e-9), wire
    assert all(circle.radius < 0.2 for circle in circles)


def crosses(line, box, margin=0.01):
    beside = line.x0 >= box.x1 - margin or line.x1 <= box.x0 + margin
    return not (beside or line.y0 >= box.y1 - margin or line.y1 <= box.y0 + margin)


def shows_all_of(chart, picture):
    found = lines_of(picture)
    words = " ".join(found)
    for step, actions in chart.actions.items():
        assert step in found
        for output, formula in actions:
            assert f"{output} := {formula.text}" in found
    for condition in chart.conditions:
        assert condition.text in words
    written = [condition.text for condition in chart.conditions]
    for text in {text for text in written if len(text) < 20}:  # each once, not one for two
        assert found.count(text) == written.count(text)


# What is joined to what, read off the lines of the drawing.


def on(point, line):
    (x, y), ((x0, y0), (x1, y1)) = point, line
    near = 0.02
    return min(x0, x1) - near <= x <= max(x0, x1) + near and min(y0, y1) - near <= y <= max(y0, y1) + near


def middle(head):
    return (head[:, 0].min() + head[:, 0].max()) / 2


def nets(picture):
    """The lines that touch, each group as a list, and the places of the bars; a bar cuts the line through it."""
    _, _, _, heads, _ = measured(picture)
    (axes,) = picture.figure.axes
    lines, bars = [], []
    for drawn in axes.lines:
        points = [tuple(map(float, point)) for point in zip(*drawn.get_data(), strict=True)]
        if drawn.get_linewidth() > 2:
            bars.append((sum(x for x, _ in points) / 2, points[0][1]))
        else:
            lines += itertools.pairwise(points)
    for head in heads:
        x, tip = middle(head), head[:, 1].min()
        lines.append(((x, tip), (x, head[:, 1].max())))
    for x, y in bars:
        (through,) = [line for line in lines if on((x, y), line)]
        lines.remove(through)
        lines += [((x, max(through[0][1], through[1][1])), (x, y + 0.05)),
                  ((x, y - 0.05), (x, min(through[0][1], through[1][1])))]  # fmt: skip
    groups = []
    for line in lines:
        touching = [group for group in groups if any(meet(line, other) for other in group)]
        groups = [group for group in groups if not any(group is other for other in touching)]
        groups.append([line, *itertools.chain(*touching)])
    return groups, bars


def meet(one, other):
    """Whether lines touch, or are the two of a double line."""
    if any(on(point, other) for point in one) or any(on(point, one) for point in other):
        return True
    level = all(abs(line[0][1] - line[1][1]) < 1e-9 for line in (one, other))
    return level and abs(one[0][1] - other[0][1]) < 0.2 and abs(one[0][0] - other[0][0]) < 1e-6


def connections(chart, picture):
    """For each transition the steps before and behind it, as the drawing shows them; a set of pairs of tuples."""
    texts, boxes, _, heads, _ = measured(picture)
    groups, bars = nets(picture)
    found = []
    steps = {}
    for label, extent in texts:
        around = [box for box in boxes if within(extent, box)]
        if label in chart.steps and around:
            steps[label] = max(around, key=lambda box: box.width)
    arrows = {}  # the names at arrows, by the places of their tips
    for label, extent in texts:
        x = (extent.x0 + extent.x1) / 2
        for head in heads:
            tip = (middle(head), head[:, 1].min())
            if abs(tip[0] - x) < 0.1 and 0 < tip[1] - extent.y1 < 0.4 and label in chart.steps:
                arrows[tip] = label

    def before(group):
        return {name for name, box in steps.items() for line in group if on(((box.x0 + box.x1) / 2, box.y0), line)}

    def behind(group):
        into = {name for name, box in steps.items() for line in group if on(((box.x0 + box.x1) / 2, box.y1), line)}
        return into | {name for tip, name in arrows.items() for line in group if on(tip, line)}

    for x, y in bars:
        (above,) = [group for group in groups if any(on((x, y + 0.05), line) for line in group)]
        (below,) = [group for group in groups if any(on((x, y - 0.05), line) for line in group)]
        found.append((tuple(sorted(before(above))), tuple(sorted(behind(below)))))
    return sorted(found)


def given_connections(chart):
    return sorted((tuple(sorted(x.sources)), tuple(sorted(x.targets))) for x in chart.transitions)


@pytest.mark.parametrize("name", [name for name in CHARTS if name != "converges here or there"])
def test_the_lines_of_a_chart_join_what_its_transitions_join(name):
    assert connections(CHARTS[name], sequential_function_chart(CHARTS[name])) == given_connections(CHARTS[name])


def test_a_convergence_of_distant_steps_is_drawn_by_names():
    """Here Y leads to a transition that stands elsewhere: arrows with the names of the one and of the other."""
    found = lines_of(sequential_function_chart(CHARTS["converges here or there"]))
    assert "T_E_C_G" in found
    assert found.count("E") == 2


@pytest.mark.parametrize("draw", [sequential_function_chart, state_diagram])
def test_what_is_no_chart_is_refused(draw):
    with pytest.raises(ValueError, match="chart is 5: expected a"):
        draw(5)


@pytest.mark.parametrize("name", CHARTS)
@pytest.mark.parametrize("names", [False, True])
@pytest.mark.daily(7)
def test_a_function_chart_shows_everything_and_nothing_overlaps(name, names):
    picture = sequential_function_chart(CHARTS[name], title="Figure 12.3", names=names)
    nothing_overlaps(picture)
    if not names:
        shows_all_of(CHARTS[name], picture)


@pytest.mark.parametrize("name", CHARTS)
def test_a_state_diagram_shows_every_state_and_nothing_overlaps(name):
    chart = CHARTS[name]
    picture = state_diagram(chart)
    nothing_overlaps(picture)
    found = lines_of(picture)
    for marking in chart.markings:
        assert " + ".join(step for step in chart.steps if step in marking) in found
    assert all(condition.text in " ".join(found) for condition in chart.conditions)
    _, _, _, heads, _ = measured(picture)
    ways = {(one, other) for one, following in chart.markings.items() for _, other in following}
    assert len(heads) == len(ways) + 1


@settings(deadline=None, max_examples=draws(15), suppress_health_check=[HealthCheck.too_slow])
@given(structured())
def test_any_structured_chart_is_drawn(chart):
    picture = sequential_function_chart(chart)
    nothing_overlaps(picture)
    shows_all_of(chart, picture)
    assert connections(chart, picture) == given_connections(chart)


@settings(deadline=None, max_examples=draws(15), suppress_health_check=[HealthCheck.too_slow])
@given(structured())
def test_any_small_chart_has_a_state_diagram(chart):
    if len(chart.markings) <= 30:
        nothing_overlaps(state_diagram(chart))


def test_the_initial_step_is_double_lined_and_simultaneous_branches_have_double_lines():
    picture = sequential_function_chart(CHARTS["simultaneous"])
    _, boxes, _, _, wires = measured(picture)
    inner = [box for box in boxes if any(within(box, other) for other in boxes if other is not box)]
    assert len(inner) == 1
    level = [wire for wire in wires if len(wire) == 2 and abs(wire[0][0] - wire[1][0]) > 4]
    wide = sorted(wire[0][1] for wire in level)
    gaps = [other - one for one, other in itertools.pairwise(wide)]
    assert len(wide) == 4
    assert gaps[0] == pytest.approx(gaps[2])
    assert gaps[0] < 0.2 < gaps[1]


def test_the_way_back_is_a_line_and_other_jumps_are_arrows_with_names():
    _, _, _, heads, _ = measured(sequential_function_chart(CHARTS["simultaneous"]))
    assert len(heads) == 1
    found = lines_of(sequential_function_chart(TANK))
    assert [found.count(step) for step in ("Fill", "Idle", "Heat")] == [2, 2, 1]


def test_priority_goes_from_left_to_right():
    """Also where branches that meet must be put together."""
    picture = sequential_function_chart(CHARTS["three alternatives"])
    places = {text: extent.x0 for text, extent in measured(picture)[0]}
    assert places["a"] < places["b"] < places["c"]


def test_the_words_say_what_is_drawn():
    lamp = Chart("on", {"light": False}, {"Dark": {}, "Bright": {"light": True}}, "Dark",
                 [Transition("Dark", "Bright", "on"), Transition("Bright", "Dark", "NOT on")])  # fmt: skip
    assert repr(sequential_function_chart(lamp)) == (
        "<sequential function chart: from Dark (initial) to Bright if on; from Bright to Dark if NOT on; "
        "Bright: light := TRUE>"
    )


def test_a_long_condition_beside_a_state_diagram_reads_downwards():
    condition = "level_low AND heater_is_hot OR NOT pump_is_off AND NOT operator_stops"
    names = "level_low heater_is_hot pump_is_off operator_stops"
    picture = state_diagram(Chart(names, {}, {"A": {}, "B": {}}, "A", [("A", "B", condition), ("B", "A", "level_low")]))
    lines = [text for text in picture.figure.axes[0].texts if len(text.get_text()) > 1 and text.get_text() in condition]
    downwards = sorted(lines, key=lambda line: (-line.get_position()[0], -line.get_position()[1]))
    assert len(lines) > 2
    assert " ".join(line.get_text() for line in downwards).startswith(condition)


def test_a_state_diagram_of_too_many_states_is_refused():
    branches = [(f"P{n}", f"Q{n}") for n in range(5)]
    ways = [("A", tuple(p for p, _ in branches)), *((p, q, "a") for p, q in branches)]
    ways.append((tuple(q for _, q in branches), "A"))
    many = chart({name: {} for name in ["A", *itertools.chain(*branches)]}, ways)
    with pytest.raises(ValueError, match="33 states: expected at most 30"):
        state_diagram(many)
    nothing_overlaps(sequential_function_chart(many))
