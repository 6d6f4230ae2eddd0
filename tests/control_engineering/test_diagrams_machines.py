"""Machines and circuits: labels have their room, and the description says what is drawn."""

import inspect
import itertools
from functools import cache, partial

import pytest

from loopbook.diagrams import (
    current_loop,
    hoist,
    kirchhoff_laws,
    mass_spring_damper,
    motor_with_load,
    rc_circuit,
    resistor_combinations,
    two_terminal_components,
    voltage_divider,
    widening_tank,
)
from pictures import assert_tidy, measured

EXAMPLES = [
    mass_spring_damper, partial(mass_spring_damper, standing=True), motor_with_load, hoist, partial(widening_tank, 1),
    partial(widening_tank, 2), kirchhoff_laws, rc_circuit, resistor_combinations, two_terminal_components,
    partial(voltage_divider, ["R_1"], ["C", "R_2"], voltages={"C": "v"}),
    partial(voltage_divider, ["R_1"], ["R_2", "C"], in_series=True, voltages={"C": "v"}),
    partial(voltage_divider, ["R_1", "C"], ["R_2"], voltages={"C": "v"}),
    partial(current_loop, ["R_1"]), partial(current_loop, ["R_1", "R_2"], source="Output\n$20$ mA"),
]  # fmt: skip
EXAMPLES = [cache(draw) for draw in EXAMPLES]


@pytest.mark.parametrize("draw", EXAMPLES)
def test_labels_have_their_room(draw):
    picture = draw(title="Figure")
    assert_tidy(picture)
    texts, _, circles, *_ = measured(picture)
    for label, extent in texts:
        assert not any(extent.contains(*circle.center) for circle in circles), label
    assert picture.alt.startswith("Figure: ")


@pytest.mark.parametrize("draw", EXAMPLES)
def test_no_wire_runs_through_a_label(draw):
    texts, *_, wires = measured(draw(title="Figure"))
    for wire in wires:
        for (x0, y0), (x1, y1) in itertools.pairwise(wire):
            for label, extent in texts:
                for n in range(1, 20):
                    assert not extent.contains(x0 + (x1 - x0) * n / 20, y0 + (y1 - y0) * n / 20), label


def labels(picture):
    return [text.get_text() for text in picture.figure.axes[0].texts]


def test_the_letters_are_the_ones_asked_for():
    assert {"$M$", "$k$", "$c$", "$f$", "$x$"} <= set(labels(mass_spring_damper("M", "k", "c", "f", "x")))
    assert {"$R_1$", "$C_2$"} <= set(labels(rc_circuit("R_1", "C_2")))
    for draw in (motor_with_load, hoist, partial(widening_tank, 1)):
        names = [name for name, one in inspect.signature(draw).parameters.items() if isinstance(one.default, str)]
        written = set(labels(draw(**{name: f"Q_{n}" for n, name in enumerate(names)})))
        assert {f"$Q_{n}$" for n in range(len(names))} <= written, draw


def test_the_laws_stand_with_the_components():
    assert r"$i=C\,\dfrac{dv}{dt}$" in labels(two_terminal_components())
    assert r"$R_{parallel}=\dfrac{R_1R_2}{R_1+R_2}$" in labels(resistor_combinations())
    assert {"$i_1+i_2+i_3=0$", "$v_1+v_2+v_3=0$"} <= set(labels(kirchhoff_laws()))


def test_the_rod_is_pushed_and_the_load_pushes_back():
    _, _, _, heads, _ = measured(motor_with_load())
    ways = sorted(head[1][0] - head[0][0] for head in heads if head[0][0] == head[2][0])
    assert ways[0] < 0 < ways[1]


def test_a_mass_without_a_force_has_no_arrow_for_it():
    assert "$F$" in labels(mass_spring_damper())
    assert "$F$" not in labels(mass_spring_damper(force=""))


def test_a_tank_widens_with_a_power_above_zero():
    with pytest.raises(ValueError, match="a power above zero"):
        widening_tank(0)


def test_a_current_loop_has_an_input_and_two_wires():
    assert sorted(labels(current_loop(["R_1", "R_2"], "R"))) == ["$I$", "$R$", "$R$", "$R_1$", "$R_2$"]
    with pytest.raises(ValueError, match="one input or more"):
        current_loop([])
