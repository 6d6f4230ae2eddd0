"""Sequential function charts: what they refuse, and that they run as an independent token game says."""

import copy
import itertools

import numpy as np
import pytest
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st

from draws import draws
from loopbook.pid import PID, Controller
from loopbook.plants import BatchTank
from loopbook.sequence import Chart, Formula, Transition, checks, scan_by_scan
from loopbook.signals import stepwise
from loopbook.simulation import simulate
from loopbook.structures import ControlLoop
from test_balances import imbalances, with_totals

SIGNALS = ("a", "b", "c", "d")


def chart(steps, transitions, initial="A", final=(), inputs=SIGNALS, outputs=None):
    steps = {name: {} for name in steps} if isinstance(steps, str) else steps
    return Chart(inputs, outputs or {"y": False, "n": 0}, steps, initial, transitions, final)


def active(chart, **inputs):
    """The active steps after each scan, as texts."""
    length = len(next(iter(inputs.values())))
    return ["".join(step) for step in scan_by_scan(chart, **{x: [0] * length for x in chart.reads} | inputs).active]


# One scan after the other.


def test_a_transition_of_one_step_and_one_of_two_never_take_the_same_step_twice():
    """C may be left alone or together with B: the first in the list wins, and the other is not cleared by halves."""
    ways = [("A", ("B", "C")), (("B", "C"), "D", "a"), ("C", "E", "b"), (("B", "E"), "D", "c")]
    assert active(chart("ABCDE", ways, final="D"), a=[0, 0, 1], b=[0, 0, 1])[-1] == "D"
    ways[1], ways[2] = ways[2], ways[1]
    assert active(chart("ABCDE", ways, final="D"), a=[0, 0, 1], b=[0, 0, 1])[-1] == "BE"


def test_actions_are_executed_once_and_stored():
    steps = {"A": {"y": True}, "B": {"n": "n + 1"}, "C": {"y": False, "n": "2*n"}}
    counter = chart(steps, [("A", "B", "a"), ("B", "C", "b"), ("C", "A", "c")])
    found = scan_by_scan(counter, a=[0, 1, 0, 0, 0], b=[0, 0, 0, 1, 0], c=0, d=0)
    assert [row[-2:] for row in found.rows] == [
        ("TRUE", "0"), ("TRUE", "1"), ("TRUE", "1"), ("FALSE", "2"), ("FALSE", "2"),
    ]  # fmt: skip


def test_a_step_that_leads_to_itself_begins_anew():
    again = chart({"A": {"n": "n + 1"}}, [("A", "A", "A.T >= 2")])
    assert [again.update(dict.fromkeys(SIGNALS, 0), time)["n"] for time in range(7)] == [1, 1, 2, 2, 3, 3, 4]


def test_time_and_flag_of_a_step():
    late = chart("ABC", [("A", "B", "A.T >= 1"), ("B", "C", "B.X AND NOT A.X AND C.T = 0 AND B.T >= 0.3")], final="C")
    found = [late.update(dict.fromkeys(SIGNALS, 0), 0.1 * k) and late.active for k in range(14)]
    assert found == [("A",)] * 10 + [("B",)] * 3 + [("C",)]  # ten steps of 0.1 are one, in spite of rounding


def test_the_time_of_a_step_stays_when_it_becomes_passive_and_begins_anew_with_it():
    """As IEC 61131-3 says of the elapsed time; a step that leads to itself begins anew, too."""
    steps = {"A": {"n": "B.T"}, "B": {"n": "A.T"}, "C": {"n": "10*A.T + B.T"}}
    ways = [("A", "B", "A.T >= 2"), ("B", "B", "B.T >= 3"), ("B", "C", "a"), ("C", "A", "b")]
    times = chart(steps, ways)
    a, b = [0, 0, 0, 0, 0, 0, 1, 0, 0, 0], [0, 0, 0, 0, 0, 0, 0, 0, 0, 1]
    found = scan_by_scan(times, a=a, b=b, c=0, d=0)
    assert ["".join(step) for step in found.active] == [*"AABBBBCCCA"]
    assert [row[-1] for row in found.rows] == ["0", "0", "2", "2", "2", "2", "21", "21", "21", "1"]
    again = scan_by_scan(chart(steps, ways), a=[0, 0, 0, 0, 0, 0, 0, 1], b=0, c=0, d=0)
    assert again.rows[-1][-1] == "22"  # B began anew at 5


def test_a_run_that_goes_on_knows_the_times_of_passive_steps():
    two = chart(
        {"A": {}, "B": {"n": 0}, "C": {"n": "A.T"}}, [("A", "B", "A.T >= 5"), ("B", "C", "B.T >= 9"), ("C", "A")]
    )
    inputs = dict.fromkeys(SIGNALS, 0)
    first = simulate(BatchTank(), [two], until=8, step=1, **inputs)
    later = simulate(BatchTank(), [two], until=14, step=1, after=first, **inputs)
    assert later["n"].max() == 5


def test_conditions_see_the_outputs_as_the_scan_before_left_them():
    ways = [("A", "B", "y"), ("B", "A", "NOT y")]
    assert active(chart({"A": {"y": True}, "B": {"y": False}}, ways), a=[0] * 5) == [*"ABABA"]


def test_a_run_does_not_change_the_chart_and_a_copy_goes_its_own_way():
    two = chart("AB", [("A", "B"), ("B", "A")])
    scan_by_scan(two, a=[0, 0], b=0, c=0, d=0)
    assert two.active == ()
    two.update(dict.fromkeys(SIGNALS, 0), 0)
    other = copy.deepcopy(two)
    other.update(dict.fromkeys(SIGNALS, 0), 1)
    assert (two.active, other.active) == (("A",), ("B",))
    assert other.recorded == {"A": 0, "B": 1}
    assert set(other.reads) == set(SIGNALS)
    assert set(other.writes) == {"y", "n"}


def test_a_run_that_goes_on_continues_the_chart():
    two = chart("ABC", [("A", "B", "A.T >= 10"), ("B", "C", "B.T >= 12"), ("C", "A", "a")])
    inputs = dict.fromkeys(SIGNALS, 0)
    whole = simulate(BatchTank(), [two], until=40, step=1, **inputs)
    first = simulate(BatchTank(), [two], until=15, step=1, **inputs)
    later = simulate(BatchTank(), [two], until=40, step=1, after=first, **inputs)
    for step in two.steps:
        assert later[f"SFC.{step}"].tolist() == whole[f"SFC.{step}"].tolist()
    other = chart("AD", [("A", "D", "a"), ("D", "A", "b")])
    with pytest.raises(ValueError, match="SFC cannot go on with B active"):
        simulate(BatchTank(), [other], until=40, step=1, after=first, **inputs)


# Random charts against a token game that is written from the definition of a Petri net.


@st.composite
def structured(draw):
    """Steps and transitions of a chart that is built of sequences, alternatives, simultaneous branches and loops."""
    names = (f"S{n}" for n in itertools.count())
    transitions = []

    def condition():
        return draw(st.sampled_from(["a", "b", "NOT c", "d AND a", "TRUE", "b OR c"]))

    def part(depth):  # the first and the last step of a part
        kind = draw(st.sampled_from(["step", "sequence", "alternative", "simultaneous", "loop"])) if depth else "step"
        if kind == "step":
            name = next(names)
            return name, name
        if kind in ("sequence", "loop"):
            first, second = part(depth - 1), part(depth - 1)
            transitions.append(Transition(first[1], second[0], "a" if kind == "loop" else condition()))
            if kind == "loop":
                end = next(names)
                transitions.append(Transition(second[1], first[0], "b"))
                transitions.append(Transition(second[1], end, "c"))
                return first[0], end
            return first[0], second[1]
        branches = [part(depth - 1) for _ in range(draw(st.integers(2, 3)))]
        begin, end = next(names), next(names)
        if kind == "alternative":
            for letter, (first, last) in zip(SIGNALS, branches, strict=False):
                transitions.append(Transition(begin, first, letter))
                transitions.append(Transition(last, end, condition()))
        else:
            transitions.append(Transition(begin, tuple(first for first, _ in branches), condition()))
            transitions.append(Transition(tuple(last for _, last in branches), end, condition()))
        return begin, end

    first, last = part(draw(st.integers(1, 3)))
    closed = draw(st.booleans())
    if closed:
        transitions.append(Transition(last, first, condition()))
    names_used = {step for x in transitions for step in (*x.sources, *x.targets)} or {first}
    steps = sorted(names_used, key=lambda name: int(name[1:]))
    return chart({name: {} for name in steps}, transitions, first, () if closed else (last,))


def token_game(chart, inputs):
    """Places with tokens; a transition takes one from each place before it and puts one into each behind it."""
    tokens, seen = {step: int(step == chart.initial) for step in chart.steps}, []
    seen.append(dict(tokens))
    for values in inputs[1:]:
        letters = {name: bool(x) for name, x in values.items()}
        taken, put = dict.fromkeys(tokens, 0), dict.fromkeys(tokens, 0)
        for transition in chart.transitions:
            text = transition.condition.replace("AND", "and").replace("OR", "or").replace("NOT", "not")
            holds = eval(text.replace("TRUE", "True"), {}, letters)
            if holds and all(tokens[step] - taken[step] == 1 for step in transition.sources):
                for step in transition.sources:
                    taken[step] += 1
                for step in transition.targets:
                    put[step] += 1
        tokens = {step: tokens[step] - taken[step] + put[step] for step in tokens}
        seen.append(dict(tokens))
    return seen


@settings(deadline=None, max_examples=draws(80), suppress_health_check=[HealthCheck.too_slow])
@given(structured(), st.lists(st.tuples(*[st.booleans()] * 4), min_size=2, max_size=25))
def test_a_chart_runs_as_the_token_game_and_never_puts_two_tokens_in_a_step(chart, letters):
    inputs = [dict(zip(SIGNALS, row, strict=True)) for row in letters]
    game, marked = token_game(chart, inputs), set(chart.markings)
    for time, (values, tokens) in enumerate(zip(inputs, game, strict=True)):
        chart.update({name: float(x) for name, x in values.items()}, time)
        assert set(tokens.values()) <= {0, 1}
        assert set(chart.active) == {step for step, count in tokens.items() if count}
        assert frozenset(chart.active) in marked


@settings(deadline=None, max_examples=draws(40), suppress_health_check=[HealthCheck.too_slow])
@given(structured())
def test_in_a_structured_chart_every_element_has_its_turn(chart):
    assert set().union(*chart.markings) == set(chart.steps)
    assert {x for ways in chart.markings.values() for x, _ in ways} == set(chart.transitions)


# What is refused, in one sentence that names the culprit.

RING = [("A", "B", "a"), ("B", "A", "b")]
FORK = [("A", ("B", "C"), "a"), (("B", "C"), "A", "b")]


@pytest.mark.parametrize(
    ("arguments", "message"),
    [
        (("AB", RING, None), "no initial step"),
        (("AB", RING, ("A", "B")), "2 initial steps, A, B: expected one"),
        (("AB", RING, "X"), "initial step X is not a step of the chart: it has A, B"),
        (("AB", [*RING, ("A", "X", "c")]), "T_A_X has the unknown step X"),
        (("ABC", [*RING, ("C", "A", "c")]), "step C cannot be reached: no transition leads to it"),
        (("ABCD", [*RING, ("C", "D", "c"), ("D", "C", "c")]), "step C cannot be reached from the initial step A"),
        (("ABC", [*RING, ("A", "C", "c")]), "no transition leaves the step C: declare it final, or add one"),
        (("AB", RING, "A", "B"), "B is a final step, but T_B_A leaves it"),
        (("AB", RING, "A", "X"), "final step X is not a step"),
        (("AB", [("A", "B", "x > 1"), RING[1]]), "condition of T_A_B has the unknown signal x"),
        (("AB", [("A", "B", "X.T > 1"), RING[1]]), "condition of T_A_B has X.T, but X is not a step"),
        (("AB", [("A", "B", "a + 1"), RING[1]]), "condition of T_A_B is 'a \\+ 1', a number"),
        (("AB", [("A", "B", "a >"), RING[1]]), "condition of T_A_B is 'a >': expected a formula"),
        (("AB", [("A", "B", "a := 1"), RING[1]]), ":= assigns, a condition compares with =="),
        (("AB", [("A", "B", ""), RING[1]]), "condition of T_A_B is '': expected a text"),
        (("AB", [("A", "B", "open('x')"), RING[1]]), "\"open\\('x'\\)\" is not a part of a formula"),
        (("AB", [("A", "B", "FALSE"), RING[1]]), "T_A_B is never cleared: its condition is always FALSE"),
        (("ABC", [("A", "B"), ("A", "C", "a"), RING[1], ("C", "A", "a")]), "T_A_C is never cleared: T_A_B comes first"),
        ((dict(A={"x": True}, B={}), RING), "step A has an action on the unknown signal x"),
        ((dict(A={"a": True}, B={}), RING), "step A has an action on the unknown signal a: expected an output"),
        ((dict(A={"y": 1}, B={}), RING), "action on y in A assigns 1: expected TRUE or FALSE"),
        ((dict(A={"n": True}, B={}), RING), "action on n in A assigns TRUE: expected a number"),
        ((dict(A={"n": float("nan")}, B={}), RING), "action on n in A is nan: expected a number"),
        ((dict(A={"n": "x + 1"}, B={}), RING), "action on n in A has the unknown signal x"),
        (({}, RING), "no steps"),
        (({"A": None, "B": {}}, RING), "step A has None: expected its actions"),
        (("AB", [*RING, ("A",)]), "a transition is \\('A',\\): expected one such as"),
        (("AB", [*RING, (1, "A")]), "sources of a transition are \\(1,\\): expected the names of steps"),
        (({"Step 1": {}}, RING), "step 'Step 1' is not a name"),
        (({"NOT": {}}, RING), "step 'NOT' is not a name"),
        (({"a": {}, "A": {}}, RING), "a is a signal and a step"),
        (("AB", [("A", ("B", "B"), "a"), RING[1]]), "step B twice among its targets"),
        (("AB", [("A", (), "a"), RING[1]]), "targets of a transition are \\(\\)"),
        # simultaneous branches that do not end as such
        (("ABCD", [("A", "B", "a"), ("A", "C", "b"), (("B", "C"), "D"), ("D", "A")]), "T_B_C_D is never cleared: B"),
        (("ABC", [*FORK, ("B", "A", "c")]), "T_A_B_C can activate the step C while it is active"),
        (("ABCD", [*FORK, ("B", "D", "c")], "A", "D"), "stop for good with C and D active: no transition leaves C"),
        # the same, while the other branch goes round
        (("ABCDE", [*FORK, ("B", "D", "c"), ("D", "E", "a"), ("E", "D", "b")]), "go on for good with C and D active"),
        (("ABCD", [*FORK, ("B", "D", "c"), ("D", "D", "a")]), "go on for good with C and D active: no"),
        (("AB", [*RING, ("A", "B", "a")]), "T_A_B is never cleared: T_A_B comes first and has the same condition, a"),
        # what is not even a list
        (("AB", 5), "transitions are 5: expected a list"),
        (("AB", Transition("A", "B")), "transitions are T_A_B: TRUE: expected a list"),
        (("AB", RING, 5), "initial step 5 is not a step"),
        (("AB", RING, "A", 5), "final steps are 5: expected names"),
        ((["A", "B"], RING), "steps are \\['A', 'B'\\]: expected {step"),
        (("AB", [("A", "B", "A.T > T#5s"), RING[1]]), "'A.T > T#5s': expected a time as a plain number"),
    ],
)  # fmt: skip
def test_a_wrong_chart_is_refused(arguments, message):
    with pytest.raises(ValueError, match=message) as caught:
        chart(*arguments)
    assert "\n" not in str(caught.value)


@pytest.mark.parametrize(
    ("what", "message"),
    [({"tag": 5}, "tag is 5: expected a name"), ({"tag": " "}, "tag is ' '"), ({"step": 0}, "step of the scans is 0")],
)
def test_a_wrong_tag_and_a_wrong_time_between_scans_are_refused(what, message):
    with pytest.raises(ValueError, match=message):
        Chart("a b", {"y": False}, {"A": {}, "B": {}}, "A", RING, **what)


def test_a_branch_may_go_round_while_the_other_one_has_ended():
    """An end that is declared is none that was forgotten."""
    ways = [("A", ("B", "C"), "a"), ("B", "D", "b"), ("D", "B", "c")]
    found = active(chart("ABCD", ways, final="C"), a=[0, 1, 0, 0], b=[1, 1, 1, 0], c=[0, 0, 0, 1])
    assert found == ["A", "BC", "CD", "BC"]


def test_scans_take_arrays_and_a_chart_without_inputs_a_number_of_scans():
    two = chart("AB", RING)
    found = scan_by_scan(two, a=np.array([0, 1, 0]), b=range(2, -1, -1), c=0, d=False)
    assert found.active == [("A",), ("B",), ("B",)]
    alone = Chart("", {"n": 0}, {"A": {"n": "n + 1"}}, "A", [("A", "A", "A.T >= 2")])
    assert [row[-1] for row in scan_by_scan(alone, scans=5).rows] == ["1", "1", "2", "2", "3"]
    with pytest.raises(ValueError, match="or scans=10 where there are none"):
        scan_by_scan(alone)
    with pytest.raises(ValueError, match="step is 0: expected a positive number"):
        scan_by_scan(alone, step=0, scans=5)
    with pytest.raises(ValueError, match="input a is None: expected a number, or True or False"):
        scan_by_scan(two, a=[0, None], b=0, c=0, d=0)


@pytest.mark.parametrize(
    ("signals", "message"),
    [
        ({"inputs": ("a", "b", "y")}, "y is an input and an output"),
        ({"inputs": ("a", "b", "a")}, "input a is named twice"),
        ({"inputs": ("a", "b", "2")}, "input '2' is not a name"),
        ({"outputs": {"if": False}}, "output 'if' is not a name"),
        ({"outputs": {"y": "on"}}, "output y is 'on'"),
        ({"outputs": "y"}, "outputs are 'y': expected {name"),
        ({"inputs": 5}, "inputs are 5: expected names"),
    ],
)
def test_wrong_signals_are_refused(signals, message):
    with pytest.raises(ValueError, match=message):
        chart("AB", RING, **signals)


def test_a_chart_with_too_many_situations_is_refused(monkeypatch):
    """Fifteen branches of two steps: every set of one step of each."""
    branches = [(f"P{n}", f"Q{n}") for n in range(15)]
    ways = [("A", tuple(p for p, _ in branches)), *((p, q, "a") for p, q in branches)]
    ways.append((tuple(q for _, q in branches), "A"))
    monkeypatch.setattr(checks, "MOST_MARKINGS", 2000)
    with pytest.raises(ValueError, match="more than 2000 sets of steps"):
        chart({name: {} for name in ["A", *itertools.chain(*branches)]}, ways)


def test_a_missing_input_and_a_truth_value_that_is_none_are_named():
    two = chart("AB", RING)
    with pytest.raises(ValueError, match="input a is missing"):
        two.update({"b": 0}, 0)
    two.update(dict.fromkeys(SIGNALS, 0), 0)
    with pytest.raises(ValueError, match=r"condition of T_A_B is 'a', with a signal of 0.9: expected 1 or 0"):
        two.update(dict.fromkeys(SIGNALS, 0.9), 1)
    with pytest.raises(ValueError, match="chart is 5: expected a Chart"):
        scan_by_scan(5)
    with pytest.raises(ValueError, match="lists of one length"):
        scan_by_scan(two, a=[0, 1], b=[0], c=0, d=0)
    with pytest.raises(ValueError, match="x is missing or no input"):
        scan_by_scan(two, a=[0, 1], b=0, c=0, d=0, x=0)


# Formulas.


@pytest.mark.parametrize(
    ("text", "value"),
    [
        ("True", True), ("not false", True), ("TRUE", True), ("NOT FALSE", True),
        ("x = 2", True), ("x == 2", True), ("x <> 2", False), ("x != 2", False),
        ("x>=2 AND x<=2", True), ("NOT x > 1 OR on", True), ("on = TRUE", True), ("on <> (x > 1)", False),
        ("Heat.T >= 600", True), ("Heat.X", True), ("NOT Heat.X", False), ("-x + 3*x/2 - 1 = 0", True),
        ("off AND x/0 > 1", False), ("on\n AND\n NOT off", True),
    ],
)  # fmt: skip
def test_formulas_as_in_structured_text(text, value):
    assert Formula(text).true({"x": 2.0, "on": 1.0, "off": 0.0, "Heat.T": 600.0, "Heat.X": True}) is value


@pytest.mark.parametrize(
    "text",
    ["x > 1 # TRUE", "Heat.T >= T#600s",
     "x.y.T > 1", "Heat.Y", "x[0] > 1", "f(x)", "lambda: x", "1 < x < 3", "x if on else y", "'a' = 'b'", "x ** 2 > 1",
     "x > TRUE", "on + TRUE = 1", "NOT 1", "1 AND on", "__import__('os')", "x := 1", "x;y", "(x > 1", "None", "1j = x",
     "[x for x in y]", "~x = 1", "x and\\"],
)  # fmt: skip
def test_everything_else_is_no_formula(text):
    with pytest.raises(ValueError, match="the formula is"):
        Formula(text)


def test_a_number_is_no_condition_and_a_division_by_zero_is_told():
    with pytest.raises(ValueError, match="a number: expected a condition"):
        Formula("x + 1").condition()
    with pytest.raises(ValueError, match="'1/x', which divides by zero here"):
        Formula("1/x").value({"x": 0})


# The batch tank, by the formulas of filling and discharging.


def test_filling_and_discharging_take_the_time_that_the_formulas_say():
    tank = BatchTank()
    filled = simulate(tank, until=200, step=1, u_valve_in=1)
    assert filled["h"][-1] == pytest.approx(0.1 + 0.0012 * 200 / 0.25, rel=1e-9)
    full = 0.9
    emptied = simulate(BatchTank(h=full), until=600, step=1, u_valve_out=1)
    root = np.maximum(np.sqrt(full - 0.05) - 0.002 * emptied.times / (2 * 0.25), 0)
    assert np.allclose(emptied["h"], 0.05 + root**2, rtol=1e-7, atol=1e-9)
    assert emptied["h"].min() >= 0.05 - 1e-9


def test_what_is_more_than_the_tank_holds_runs_over():
    run = simulate(BatchTank(h=1.19), until=2000, step=1, u_valve_in=1)
    assert run["h"][-1] == pytest.approx(1.2 + 0.0012 ** (2 / 3), rel=1e-6)


def batches_of_two():
    """The blocks of a batch process that is restarted once: the chart, and the temperature loop that it switches."""
    steps = {
        "Idle": {},
        "Fill": {"u_valve_in": True},
        "Heat": {"u_valve_in": False, "u_motor": True, "heating": True},
        "Discharge": {"heating": False, "u_motor": False, "u_valve_out": True},
        "Finished": {"u_valve_out": False, "batches": "batches + 1"},
        "End": {},
    }
    ways = [
        ("Idle", "Fill", "start"),
        ("Fill", "Heat", "h > 0.95"),
        ("Heat", "Discharge", "Heat.T >= 1800"),
        ("Discharge", "Finished", "h < 0.12"),
        ("Finished", "Fill", "batches < 2"),
        ("Finished", "End"),
    ]
    outputs = dict.fromkeys(["u_valve_in", "u_valve_out", "u_motor", "heating"], False) | {"batches": 0}
    batch = Chart("h start", outputs, steps, "Idle", ways, final="End")
    controller = Controller(PID(20, 400), step=2, limits=(0, 100), bumpless=False)
    loop = ControlLoop("TC1", controller, setpoint=60, measurement="T", output="u_heat", mode="heating", manual=0)
    return [batch, loop]


def test_two_batches_under_a_chart_lose_neither_water_nor_energy():
    """Also where valves open and close."""
    batch, loop = batches_of_two()
    run = simulate(with_totals(BatchTank)(), [batch, loop], until=4800, start=stepwise(0, {60: 1}))
    assert [run[f"SFC.{step}"][-1] for step in batch.steps] == [0, 0, 0, 0, 0, 1]
    assert run["batches"][-1] == 2
    assert max(imbalances(run)) < 1e-9
    assert 60 < run["T"].max() < 62
    assert set(run["u_valve_in"]) == {0, 1}
    assert (run["u_heat"][run["u_motor"] == 0] == 0).all()
    assert batch.active == ()
