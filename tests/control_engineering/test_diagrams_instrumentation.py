"""Plants with their instruments: symbols, pipes and signals, and that nothing lies on anything else."""

import functools
import itertools
import math

import pytest
from matplotlib.patches import Polygon

from loopbook.diagrams import (
    compressor,
    control_valve,
    conveyor,
    fan,
    feed_screw,
    heat_exchanger,
    heater,
    instrument,
    instrumentation_diagram,
    motor,
    pump,
    tank,
    turbine,
    valve,
    vessel,
)
from pictures import assert_tidy, measured, tip

EXAMPLES = {
    "Figure 1.2": lambda: instrumentation_diagram(
        """
        u  .      .      .     .     .     .    LC  y_SP
        .  chips  .      .     .     .     .    .   .
        M  screw  screw  .     .     .     .    .   .
        .  .      belt   belt  belt  1     .    .   .
        .  .      .      .     .     tank  tank LT  .
        .  .      .      .     .     tank  tank .   .
        .  .      .      .     .     out   out  .   outflow""",
        "chips screw belt 1 tank out outflow",
        "tank LT LC u M, y_SP LC",
        {"M": motor(), "screw": feed_screw(), "belt": conveyor(), "out": feed_screw(), "tank": tank(level="y")},
        shafts="M screw",
    ),
    "Figure 3.11": lambda: instrumentation_diagram(
        """
        in  1     .     .     .
        .   tank  tank  tank  T_e
        .   tank  tank  tank  .
        P   tank  tank  tank  out""",
        "in 1 tank out",
        "P tank",
        {"tank": tank("m, c, T", stirrer=True, heater=True)},
        {"in": "F, T_i", "out": "F, T"},
    ),
    "Figure 8.3": lambda: instrumentation_diagram(
        """
        .     .  .     .   F_f  rate
        .     u  1     LC  .    h_SP
        F_in  V  2     .   .    .
        .     .  tank  LT  .    .
        .     .  tank  .   FT   F_out""",
        "F_in V 2 tank FT F_out",
        "tank LT LC 1 u V, h_SP LC, FT F_f - 1, rate F_f",
        {"V": control_valve(), "tank": tank(level="h"), "F_f": "F_f"},
    ),
    "Figure 8.5": lambda: instrumentation_diagram(
        """
        .    F_f  1     TC  T_SP
        .    SI   .     TT  .
        air  fan  heat  2   out""",
        signals="2 TT TC 1 heat, T_SP TC, fan SI F_f 1",
        equipment={"fan": fan(), "heat": heater(), "F_f": "F_f"},
        ducts="air fan heat 2 out",
    ),
    "Figure 11.4": lambda: instrumentation_diagram(
        """
        .    1    .    .     .     .    TC1  T_SP
        .    .    F_p  2     .     .    .    .
        .    .    .    tank  tank  TT1  .    .
        .    TC2  TT2  tank  tank  .    .    .
        F_h  V    .    tank  tank  .    T_h  .
        .    .    .    .     3     .    T_p  .""",
        "F_p 2 tank 3 T_p, F_h V tank T_h",
        "tank TT1 TC1 1 TC2 V, tank TT2 TC2, T_SP TC1",
        {"V": control_valve(), "tank": tank(jacket=True, stirrer=True)},
    ),
    "Figure 11.8": lambda: instrumentation_diagram(
        """
        .        1   .  .   TC  T_SP
        .        FC  .  .   .   .
        hot      FT  V  2   .   .
        product  .   .  HX  TT  heated
        .        .   .  3   .   return""",
        "product HX TT heated, hot FT V 2 HX 3 return",
        "TT TC 1 FC V, FT FC, T_SP TC",
        {"V": control_valve("V1"), "HX": heat_exchanger("H1")},
    ),
    "separator": lambda: instrumentation_diagram(
        """
        .     .     PT    PC    .    .
        .     .     1     .     V1   gas
        feed  drum  drum  LT1   .    .
        .     drum  drum  .     LC1  .
        .     .     2     .     V2   oil
        .     3     .     V3    .    water""",
        "feed drum 1 V1 gas, drum 2 V2 oil, drum 3 V3 water",
        "1 PT PC V1, drum LT1 LC1 V2",
        {name: control_valve(name) for name in ("V1", "V2", "V3")} | {"drum": vessel(filled=0.5, lying=True)},
    ),
}
EXAMPLES = {name: functools.cache(make) for name, make in EXAMPLES.items()}


@pytest.mark.parametrize("name", EXAMPLES)
def test_labels_and_instruments_do_not_overlap_and_stay_inside(name):
    picture = EXAMPLES[name]()
    assert_tidy(picture)
    bubbles = [circle for circle in measured(picture)[2] if circle.radius >= 0.4]
    for one, other in itertools.combinations(bubbles, 2):
        assert math.dist(one.center, other.center) > one.radius + other.radius


@pytest.mark.parametrize("name", EXAMPLES)
def test_signals_end_at_instruments(name):
    """Every arrow head at the rim of a circle points at its centre."""
    _, _, circles, heads, _ = measured(EXAMPLES[name]())
    for head in heads:
        x, y = tip(head)
        base = head[[0, 2]].mean(axis=0)
        for circle in circles:
            across, up = x - circle.center[0], y - circle.center[1]
            if abs((across**2 + up**2) ** 0.5 - circle.radius) < 1e-6:
                assert abs(across * (base[1] - y) - up * (base[0] - x)) < 1e-6


def styles(picture):
    return {line.get_linestyle() for line in picture.figure.axes[0].lines}


def test_a_measurement_is_a_solid_line_and_a_signal_a_dashed_one():
    layout = "tank LT LC\n tank . h"
    picture = instrumentation_diagram(layout, "", "tank LT", {"tank": tank()})
    assert styles(picture) == {"-"}
    _, _, _, heads, _ = measured(picture)
    assert heads == []
    assert styles(instrumentation_diagram(layout, "", "LT LC", {"tank": tank()})) == {"-", "--"}


def test_a_capital_name_is_an_instrument_unless_it_is_given_another_label():
    texts, _, circles, *_ = measured(instrumentation_diagram("LC TT12 P1 NH3", "P1 NH3", names={"NH3": "NH$_3$"}))
    assert [text for text, _ in texts] == ["LC", "TT", "12", "$P1$", "NH$_3$"]
    assert len(circles) == 2


def test_an_instrument_in_the_control_room_has_a_line_across_it():
    picture = instrumentation_diagram("LC", equipment={"LC": instrument("LC", place="panel")})
    _, _, (circle,), _, (wire,) = measured(picture)
    assert [x for x, _ in wire] == [circle.center[0] - 0.5, circle.center[0] + 0.5]


@pytest.mark.parametrize(("layout", "dy"), [("TC .\n V b", 1), ("V b\n TC .", -1)])
def test_the_actuator_of_a_valve_is_where_its_signal_ends(layout, dy):
    picture = instrumentation_diagram(layout, "V b", "TC V", {"V": control_valve()})
    _, _, (circle,), heads, _ = measured(picture)
    (end,) = (tip(head) for head in heads if tip(head)[0] == pytest.approx(circle.center[0]))
    assert dy * (circle.center[1] - end[1]) > 0
    polygons = [patch.get_xy() for patch in picture.figure.axes[0].patches if isinstance(patch, Polygon)]
    dome = max(polygons, key=len)
    assert max(dome[:, 1], key=lambda y: dy * y) == pytest.approx(end[1])


def test_pipes_meet_a_tank_where_its_walls_are():
    jacketed = {"tank": tank(jacket=True)}
    _, _, _, heads, _ = measured(instrumentation_diagram("a tank\n . tank\n b tank", "a tank, b tank", "", jacketed))
    upper, lower = sorted((tip(head) for head in heads), key=lambda point: -point[1])
    assert upper[0] - lower[0] == pytest.approx(0.3)  # into the tank itself, and into the jacket


def test_pipes_meet_the_round_end_of_a_vessel():
    drum = {"V": vessel(lying=True)}
    axes = instrumentation_diagram("V V V\n b . c", "V b, V c", equipment=drum).figure.axes[0]
    outline = max((patch.get_path().vertices for patch in axes.patches), key=len)
    starts = [line.get_xydata()[0] for line in axes.lines]
    assert len(starts) == 2
    for x, y in starts:
        assert min(abs(x - corner[0]) + abs(y - corner[1]) for corner in outline) < 0.1
        assert y > outline[:, 1].min() + 0.05


def test_every_symbol_can_be_drawn_alone_and_has_a_name():
    symbols = [
        tank("V", level="h"), vessel("A", filled=0.3, trays=3), valve("V1"), control_valve("V2"), pump("P1"), fan(),
        heater(), heat_exchanger("H1"), compressor("K1"), turbine("T1"), motor(), motor("G"), feed_screw(), conveyor(),
    ]  # fmt: skip
    words = [repr(symbol) for symbol in symbols]
    assert len(set(words)) == len(words)
    for symbol in symbols:
        picture = instrumentation_diagram("a x b", "a x b", equipment={"x": symbol})
        assert picture.alt == f"P&I diagram: pipes: a → {symbol.words} → b"
        assert picture.png()


def test_the_symbols_handed_in_stay_as_they_are():
    part = control_valve("V1")
    before = dict(vars(part))
    instrumentation_diagram("TC .\n V b", "V b", "TC V", {"V": part})
    assert vars(part) == before


def test_the_description_tells_pipes_and_signals():
    picture = EXAMPLES["Figure 8.3"]()
    assert picture.alt == (
        "P&I diagram: pipes: F_in → control valve → tank with level h → FT → F_out; signals: tank with level h → LT → "
        "LC → + 1 → u → control valve; h_SP → LC; FT → [F_f] → - 1; rate → [F_f]"
    )


@pytest.mark.parametrize(
    ("make", "message"),
    [
        (lambda: instrumentation_diagram(""), "the layout is empty"),
        (lambda: instrumentation_diagram("a b\n c"), "row 2 of the layout has 1 places, but row 1 has 2"),
        (lambda: instrumentation_diagram(["a b"]), "a layout is one text with a line for each row"),
        (lambda: instrumentation_diagram("a b", {"a": pump()}), "paths are one text, as in 'a b c, d b'"),
        (lambda: instrumentation_diagram("a b", "a tank"), "tank is not in the layout, which has a, b"),
        (lambda: instrumentation_diagram("a b", equipment={"a": 3}), "a is 3, which is not equipment of a plant"),
        (lambda: instrumentation_diagram("a LT b", "a b"), "the way from a to b runs through LT"),
        (lambda: instrumentation_diagram("FC2 FT2", signals="FC2 FT2"), "a signal goes from FC2 to FT2"),
        (lambda: tank(filled=2), "a tank is filled between 0 and 1, not 2"),
        (lambda: instrument("level"), "a tag has capital letters and then perhaps a loop number"),
    ],
)
def test_bad_input_is_told_in_one_sentence(make, message):
    with pytest.raises(ValueError, match=message):
        make()


@pytest.mark.parametrize("container", [tank(stirrer=True), vessel(stirrer=True), tank(stirrer=True, roof="cone")])
@pytest.mark.parametrize("pipe", ["water 1 tank out", "in tank out"])
def test_a_shaft_from_above_goes_on_to_the_stirrer(container, pipe):
    first, second = (". .", "in") if pipe.startswith("in") else ("water 1", ".")
    layout = f"{first} M1 . .\n {second} tank tank tank out"
    picture = instrumentation_diagram(layout, pipe, "", {"M1": motor(), "tank": container}, shafts="M1 tank")
    (motor_sign,) = [extent for label, extent in measured(picture)[0] if label == "M"]
    middle = (motor_sign.x0 + motor_sign.x1) / 2
    lines = [line.get_xydata()[:2].T for line in picture.figure.axes[0].lines]
    upright = [sorted(y) for x, y in lines if abs(x[0] - x[1]) < 1e-9 and 0.01 < x[0] - middle < 0.1]
    lower, upper = sorted(upright)  # the stirrer's own, and the one from the motor
    assert lower[1] == pytest.approx(upper[0], abs=1e-6)
