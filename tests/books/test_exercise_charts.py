"""Charts as readers write them: read in many forms, run on the plant, and told what happens."""

import pytest

from exercisebook.grammar import Unreadable
from exercisebook.judging import MISTAKE, RIGHT, UNJUDGED, WRONG, judge
from loopbook.exercises import bank
from loopbook.exercises.charts.notation import read_chart
from loopbook.exercises.charts.running import SCAN
from loopbook.exercises.charts.signals import Signals
from loopbook.plants import BatchTank
from loopbook.signals import stepwise
from loopbook.simulation import simulate

TANK = Signals(
    {"start": "", "level": "m", "temperature": "°C"},
    ["inlet", "heater", "outlet"],
    {"level": ["h"], "temperature": ["T", "temp"], "inlet": ["V1"]},
)


@pytest.fixture(scope="module")
def batch():
    """The exercise with the batch of hot water: 0.9 m, 60 °C, 120 s, 0.12 m."""
    exercises = bank.exercises("12").values()
    return next(one for one in exercises if one.title == "Write the chart, and watch it run").question()


def verdict(question, chart):
    return judge("chart", question.key["chart"], chart)


# The notation.

#: A transition, as it is read, and the ways to write it, between bars.
TRANSITIONS = {
    "Fill -> Heat: level >= 0.9": (
        "Fill → Heat: Level ≥ 0.9 m | Fill -> Heat if level >= 0.90 | Fill --level >= 0.9--> Heat"
        " | Fill -> level >= 0.9 -> Heat | Fill => Heat: level => 0.9 | 2. from Fill to Heat when level >= 90 cm"
        " | Fill -> Heat : h >= 0,9   // it is full | Fill [level >= 0.9] -> Heat"
        " | Fill: none\ngo to Heat if h >= 0.9 | Step Fill\n  -> Heat when the level is at least 0.9 m"
        " | \n# my chart\nFill -> Heat [level >= 0.9]\n"
    ),
    "Hold -> Empty: Hold.T >= 120": (
        "Hold -> Empty: Hold.T >= 2 min | Hold -> Empty: t >= 120 s | Hold -> Empty after 120 s | Hold [120 s] -> Empty"
    ),
    "Wait -> Fill: start": "Wait -> Fill when start is pressed | Wait -> Fill: START",
    "Wait -> Fill: start AND NOT heater": "Wait -> start and not heater -> Fill | Wait -> Fill if start & !heater",
    "Fill + Timer -> Wait: TRUE": "Fill + Timer -> Wait",
}
#: The actions of a step, in the same way.
ACTIONS = {
    "inlet off, heater on": (
        "Inlet := FALSE, Heater := TRUE | close the inlet valve and start the heater | V1 = 0; Do: heater"
        " | inlet=0, heater=1 | R inlet, S heater | inlet off, heater on  # now"
    ),
    "heater off": "switch off heater",
    "inlet off, heater off, outlet off": "all off",
    "none": "none",
}


@pytest.mark.parametrize("line", TRANSITIONS)
def test_a_transition_is_read_in_many_forms(line):
    for text in (line, *TRANSITIONS[line].split(" | ")):
        assert line in read_chart(text, TANK).text.splitlines(), text


@pytest.mark.parametrize("actions", ACTIONS)
def test_actions_are_read_in_many_forms(actions):
    for text in (actions, *ACTIONS[actions].split(" | ")):
        found = read_chart(f"Do: {text}\nDo -> End: start", TANK).text
        assert found.startswith(f"Do (initial): {actions}\n"), found


@pytest.mark.parametrize("text", ["2. Wait (initial): none", "Initial step: Wait", "Wait is the initial step"])
def test_the_first_step_is_the_initial_one_unless_another_one_is_named(text):
    assert read_chart("Fill: inlet on\nwait -> FILL: start", TANK).initial == "Fill"
    assert read_chart(f"Fill: inlet on\nWAIT -> Fill: start\n{text}", TANK).initial == "WAIT"


RIGHT_CHARTS = {
    "transitions below their steps": """
        Step Start
          outlet off
          -> Fill when start is pressed
        Step Fill
          open inlet
          -> Heat when level > 0.9
        Step Heat
          close the inlet valve and start the heater
          -> Hold when the temperature is at least 60 °C
        Step Hold
          switch off heater
          -> Drain after 120 s
        Step Drain
          open outlet
          -> Start when level < 0.12""",
    "one line": "S1 -> S2: start; S2: V1 = 1; S2 -> S3: h >= 0,9; S3: V1 = 0; heater; S3 -> S4: temp >= 60; "
    "S4: heater = 0; S4 -> S5: t >= 120 s; S5: outlet = 1; S5 -> S1: h <= 12 cm; S1: outlet = 0",
    "as in IEC 61131-3, and a loop back to the beginning": """
        INITIAL_STEP Wait: outlet off
        Wait -> Fill: start
        Fill: inlet on
        Fill -> Heat: level >= 0.9
        Heat: inlet off, heater on
        Heat -> Hold: temperature >= 60
        Hold: heater off
        Hold -> Empty: Hold.T >= 120
        Empty: outlet on
        Empty -> Wait: level <= 0.12""",
    "a table": """
        | step | actions | transition to the next step |
        |:---|---|---:|
        | `Wait` (initial) | `outlet := FALSE` | `start` |
        | `Fill` | `inlet := TRUE` | `level >= 0.9` |
        | `Heat` | `inlet := FALSE`, `heater := TRUE` | `temperature >= 60` |
        | `Hold` | `heater := FALSE` | `Hold.T >= 120` |
        | `Empty` | `outlet := TRUE` | `level <= 0.12`, back to `Wait` |""",
    "steps at the same time": """
        Wait (initial): outlet off
        Wait -> Fill: start
        Fill: inlet on
        Fill -> Heat: level >= 0.9
        Heat: inlet off, heater on
        Heat -> Hold + Timer: temperature >= 60
        Hold: heater off
        Timer: none
        Hold + Timer -> Empty: Timer.T >= 120
        Empty: outlet on
        Empty -> Wait: level <= 0.12""",
}


@pytest.mark.parametrize("text", RIGHT_CHARTS.values(), ids=RIGHT_CHARTS)
def test_charts_in_many_forms_are_right(batch, text):
    for form in (text, text.splitlines()):
        assert verdict(batch, form).status == RIGHT, verdict(batch, form)
    assert read_chart(read_chart(text, TANK).text, TANK) == read_chart(text, TANK)


def test_a_chart_of_the_library_is_an_answer(batch):
    assert verdict(batch, read_chart(lines(), TANK).chart(TANK)).status == RIGHT


@pytest.mark.parametrize(
    ("lines", "message"),
    [
        ("Fill -> Heat: lvel > 1", "line 1, .*: 'lvel' is not a signal: did you mean 'level'?"),
        ("A: inlet\nA -> B: level > 90 °C", "line 2, .*: 90 °C is compared with level, which is in m"),
        ("A: inlet\nA -> B: start > 2 m", "line 2, .*: 2 m is compared with start, which is on or off"),
        ("A -> B: level := 1", "line 1, .*: := assigns a value: expected a comparison"),
        ("A -> B: 3", "line 1, .*: 3 is compared with nothing"),
        ("A -> B: C.T > 3", "line 1, .*: C is not a step"),
        ("A -> B: level", "line 1, .*: level is a number, in m: expected a comparison"),
        ("A -> B -> C -> A", "line 1, .*: there are several arrows: expected one transition in a line"),
        ("A: N inlet", "line 1, .*: 'N inlet' has the qualifier N; here values are stored"),
        ("A: pump on", "line 1, .*: 'pump on' is not an action: expected one of inlet, heater, outlet"),
        ("A: level = 3", "line 1, .*: level is measured, an action cannot set it"),
        ("A: inlet half", "line 1, .*: inlet cannot be 'half': expected on or off"),
        ("A: inlet on, inlet off", "line 1, .*: inlet is switched on and off in one step"),
        ("A: inlet on\nA: inlet off", "line 2, .*: inlet is switched on and off in the step A"),
        ("inlet on", "line 1, .*: there is no step before these actions"),
        ("-> B: start", "line 1, .*: there is no step before the arrow"),
        ("A -> : start", "line 1, .*: there is no step behind the arrow"),
        ("start: inlet on", "line 1, .*: start is a signal: expected another name for the step"),
        ("Open the inlet until the tank is full.", "line 1, .* is not the name of a step"),
        ("A: inlet on\nB: inlet off", "the chart has no transition"),
        ("", "the chart is empty"),
        ("A -> B: start\n" * 201, "the chart is very long"),
    ],
)
def test_what_cannot_be_read_is_said_in_one_sentence_with_its_line(lines, message):
    with pytest.raises(Unreadable, match=message) as found:
        read_chart(lines, TANK)
    assert "\n" not in str(found.value)


@pytest.mark.parametrize(
    ("text", "condition"),
    [
        ("start", "start"),
        ("NOT start", "NOT start"),
        ("start off", "NOT start"),
        ("start = 1", "start = 1"),
        ("level is above 0.5", "level > 0.5"),
        ("0.5 m < level", "0.5 < level"),
        ("level reaches 90 cm", "level >= 0.9"),
        ("T > 50", "temperature > 50"),
        ("T > 50 s", "Fill.T > 50"),
        ("timer >= 1 min", "Fill.T >= 60"),
        ("wait 2 min", "Fill.T >= 120"),
        ("1 min 40 s", "Fill.T >= 100"),
        ("time in Fill >= 1 min 40 s", "Fill.T >= 100"),
        ("timer of Fill > 9 s", "Fill.T > 9"),
        ("always", "TRUE"),
        ("start || (level<1 && !heater)", "start OR (level < 1 AND NOT heater)"),
        ("fill.t >= 10", "Fill.T >= 10"),
        ("Fill.X", "Fill.X"),
    ],
)
def test_conditions(text, condition):
    assert TANK.condition(text, "Fill", {"fill": "Fill"}) == condition


# The run.


def lines(**other):
    """The lines of a chart that is right, some of them other ones."""
    usual = {
        "wait": "Wait (initial): outlet off", "to_fill": "Wait -> Fill: start", "fill": "Fill: inlet on",
        "to_heat": "Fill -> Heat: level >= 0.9", "heat": "Heat: inlet off, heater on",
        "to_hold": "Heat -> Hold: temperature >= 60", "hold": "Hold: heater off", "to_empty": "Hold -> Empty: 120 s",
        "empty": "Empty: outlet on", "to_wait": "Empty -> Wait: level <= 0.12",
    }  # fmt: skip
    return [line for line in (usual | other).values() if line]


WRONG_CHARTS = {
    "heats the empty tank": (
        lines(fill="Fill: inlet on, heater on"),
        "at t = 22 s the heater is on while the level is still below 0.4 m: Fill switches it on, "
        "and is reached by Wait -> Fill: start",
    ),
    "true at once": (
        lines(to_heat="Fill -> Heat: level <= 0.9"),
        "Fill lasts for one scan only, because level <= 0.9 is true at once",
    ),
    "another of two is true at once": (
        lines(early="Fill -> Late: Fill.T <= 200", late="Late: inlet off", on="Late -> Empty: 10 s"),
        "Fill lasts for one scan only, because Fill.T <= 200 is true at once",
    ),
    "no condition": (
        lines(to_heat="Fill -> Heat"),
        "Fill -> Heat has no condition, so Fill lasts for one scan only",
    ),
    "the wrong signal": (
        lines(to_heat="Fill -> Heat: T > 60"),
        "the inlet is still open, although the level has reached 0.9 m: Fill is active and waits for temperature > 60",
    ),
    "a missing action": (
        lines(hold="Hold: none", empty="Empty: heater off, outlet on"),
        "the heater is still on, although the water has reached 60 °C: Heat has switched it on, "
        "and Hold does not switch it off",
    ),
    "an action that never comes": (
        lines(heat="Heat: inlet off"),
        "the heater stays off, although the full tank is colder than 60 °C: "
        "Heat does not switch it on; Heat is active and waits for temperature >= 60",
    ),
    "no return": (
        lines(to_wait="Empty -> End: level <= 0.12", wait="Wait (initial): outlet off", end="End: outlet off"),
        "after the first round, at t = 970 s the inlet is closed, although start was pressed and the level is "
        "below 0.9 m: End does not switch it on; End is active, and no transition leaves it",
    ),
    "by the clock": (
        lines(to_heat="Fill -> Heat: 171 s"),
        "if the supply fails for a while, at t = 194 s the heater is on while the level is still below 0.4 m: "
        "Heat switches it on, and is reached by Fill -> Heat: Fill.T >= 171",
    ),
    "a button that is not ignored": (
        lines(again="Heat -> Fill: start"),
        "if somebody presses start during the batch, at t = 252 s the inlet is still open",
    ),
    "does not wait for the button": (
        ["Fill: inlet on, outlet off", *lines(wait="", to_fill="", fill="", to_wait="Empty -> Fill: h < 0.12")],
        "from the beginning the inlet opens, although nobody has pressed start: Fill, the initial step, switches it on",
    ),
    "two steps at the same time": (
        lines(to_fill="Wait -> Fill + Heat: start", to_heat="Fill -> Hold: level >= 0.9"),
        "Hold can activate the step Hold while it is active: it leaves a simultaneous branch without its convergence",
    ),
    "a step that is not reached": (lines(fly="Fly -> Wait: start"), "the step Fly cannot be reached"),
}


@pytest.mark.parametrize(("chart", "says"), WRONG_CHARTS.values(), ids=WRONG_CHARTS)
def test_a_run_says_what_happens_and_why(batch, chart, says):
    found = verdict(batch, chart)
    assert found.status == WRONG
    assert says in found.says.replace("\N{NO-BREAK SPACE}", " ")


def test_a_chart_that_fails_as_a_mistake_does_has_its_sentence_whatever_its_names(batch):
    kind, mistakes = batch.key["chart"], batch.mistakes["chart"]
    given = "\n".join(lines(to_heat="Fill -> Heat: level < 0.8")).replace("Fill", "Gather")
    found = judge("chart", kind, given, mistakes)
    assert found.status == MISTAKE
    assert found.says.startswith("The heater comes on in the nearly empty tank")


def test_the_picture_shows_the_run_and_the_chart(batch):
    kind = batch.key["chart"]
    right, wrong = (kind.picture(kind.read(chart)[0]) for chart in (lines(), WRONG_CHARTS["the wrong signal"][0]))
    assert right.png()[:4] == b"\x89PNG"
    assert "sequential function chart: from Wait (initial) to Fill if start" in right.alt
    assert wrong.alt.startswith("At t = 190")
    assert "the inlet is still open" in wrong.alt
    assert kind.picture(kind.read(WRONG_CHARTS["a step that is not reached"][0])[0]) is None


def test_the_tank_runs_as_the_plant_does(batch):
    """The steps of the run against an integration of the plant, with the same valves at the same times."""
    run = batch.key["chart"]._found(batch.key["chart"].key)[1]
    names = {"inlet": "u_valve_in", "outlet": "u_valve_out", "heater": "u_heat"}
    given = {}
    for name, own in names.items():
        changes = [n for n in range(1, len(run.times)) if run[name][n] != run[name][n - 1]]
        factor = 100 if name == "heater" else 1
        given[own] = stepwise(0, {run.times[n]: factor * run[name][n] for n in changes})
    given["u_motor"] = given["u_heat"] / 100
    plant = simulate(BatchTank(P_max=90000), until=run.times[-1], step=SCAN, **given)
    assert abs(plant["h"] - run["level"]).max() < 0.01
    assert abs(plant["T"] - run["temperature"]).max() < 1


def test_what_is_no_chart_is_not_judged(batch):
    for given in (3, [1, 2], {"a": 1}, lambda: 1):
        assert verdict(batch, given).status == UNJUDGED
