"""Runs under sequential control as figures: every bar is where its signal is on, and nothing overlaps."""

import numpy as np
import pytest

from loopbook.figures import sequence_trends
from loopbook.plants import BatchTank
from loopbook.sequence import Chart, Transition
from loopbook.signals import stepwise
from loopbook.simulation import simulate
from pictures import crossed_texts, overlapping_texts, smallest_print

STEPS = {
    "Idle": {},
    "Fill": {"u_valve_in": True},
    "Stir": {"u_motor": True},
    "Full": {"u_valve_in": False, "u_motor": False},
    "Empty": {"u_valve_out": True, "batches": "batches + 1"},
    "End": {"u_valve_out": False},
}
CHART = Chart(
    "h start",
    dict.fromkeys(("u_valve_in", "u_motor", "u_valve_out"), False) | {"batches": 0},
    STEPS,
    "Idle",
    [
        Transition("Idle", ("Fill", "Stir"), "start"),
        Transition(("Fill", "Stir"), "Full", "h > 0.9"),
        Transition("Full", "Empty"),
        Transition("Empty", "End", "h < 0.2"),
    ],
    final="End",
)
RUN = simulate(BatchTank(), [CHART], until=600, step=2, start=stepwise(0, {60: 1}), T_in=15)


def bars(axes, row):
    """The beginnings and ends of the bars in a row, counted from the top."""
    paths = axes.collections[row].get_paths()
    return [(path.vertices[:, 0].min(), path.vertices[:, 0].max()) for path in paths]


@pytest.fixture(scope="module")
def picture():
    return sequence_trends(RUN, CHART, ["h", ("T", "T_in")], title="One batch")


def test_each_bar_stands_where_its_signal_is_on(picture):
    *_, on_off, steps = picture.figure.axes
    for axes, names in ((on_off, ["u_valve_in", "u_motor", "u_valve_out"]), (steps, [f"SFC.{x}" for x in STEPS])):
        assert [label.get_text() for label in axes.get_yticklabels()] == [x.removeprefix("SFC.") for x in names]
        for row, name in enumerate(names):
            inside = np.zeros(len(RUN.times), dtype=bool)
            for begin, end in bars(axes, row):
                inside |= (RUN.times >= begin) & (RUN.times < end)
            inside[-1] |= name == "SFC.End"  # the last sample is at the frame
            assert (inside == (RUN[name] > 0)).all() or name == "SFC.Full"


def test_simultaneous_steps_have_a_bar_each_and_one_of_a_single_scan_is_seen(picture):
    steps = picture.figure.axes[-1]
    assert bars(steps, 1) == bars(steps, 2)
    ((begin, end),) = bars(steps, 3)
    assert begin == RUN.times[RUN["SFC.Full"] > 0][0]
    assert end - begin >= 2


def test_nothing_overlaps_and_the_words_say_what_is_shown(picture):
    assert overlapping_texts(picture) == []
    assert crossed_texts(picture) == []
    assert smallest_print(picture) >= 7
    assert repr(picture) == (
        "<One batch: h, T, T_in; on and off: u_valve_in, u_motor, u_valve_out; "
        "active steps: Idle, Fill, Stir, Full, Empty, End against t [s]>"
    )
    assert list(picture.lines) == ["h", "T", "T_in"]


def test_minutes_and_a_choice_of_signals():
    picture = sequence_trends(RUN, CHART, ["h"], on_off=[], minutes=True)
    trend, steps = picture.figure.axes
    assert (trend.get_ylabel(), steps.get_xlabel(), steps.get_xlim()) == ("$h$ [m]", "$t$ [min]", (0, 10))


def test_the_unit_of_time_is_the_plants():
    class Slow(BatchTank):
        """The same tank with the times of its quantities in hours."""

        time_unit = "h"

    run = simulate(Slow(), [CHART], until=20, step=2, start=0, T_in=15)
    picture = sequence_trends(run, CHART, ["h"])
    assert picture.figure.axes[-1].get_xlabel() == "$t$ [h]"
    assert picture.alt.endswith("against t [h]")
    assert sequence_trends(run, CHART, ["h"], minutes=True).figure.axes[-1].get_xlim() == pytest.approx((0, 1200))


@pytest.mark.parametrize(
    ("arguments", "message"),
    [
        ((5, CHART, ["h"]), "run is 5: expected what simulate returns"),
        ((RUN, 5, ["h"]), "chart is 5: expected a sequence.Chart"),
        ((RUN, CHART, "h"), "signals is 'h': expected a list of names"),
        ((RUN, CHART, ["h"], "start"), "on_off is 'start': expected a list of names"),
        ((RUN, CHART, ["p"]), "run has no signal 'p'"),
        ((RUN, CHART, ["h"], ["h"]), "h has other values than 0 and 1: expected it among the signals"),
        ((RUN, CHART, [("h", "T", "T_in")]), "a panel has .*: expected a name, or a measurement and its setpoint"),
    ],
)
def test_wrong_arguments_are_told(arguments, message):
    with pytest.raises(ValueError, match=message):
        sequence_trends(*arguments)
