"""Units as people write them: read, converted, and what is none."""

import math

import pytest

from exercisebook import units


@pytest.mark.parametrize(
    ("value", "unit", "to", "expected"),
    [
        (2, "min", "s", 120),
        (1, "m³/s", "L/min", 60_000),
        (1, "m^3/s", "m³/h", 3600),
        (5, "%", "", 0.05),
        (1, "%/K", "1/°C", 0.01),
        (20, "°C", "K", 293.15),
        (1, "K/%", "°C/%", 1),
        (0.5, "Hz", "rad/s", math.pi),
        (180, "deg", "rad", math.pi),
        (1, "1/s", "Hz", 1),
        (3, "kJ/(kg K)", "J/(kg K)", 3000),
    ],
)
def test_units_convert(value, unit, to, expected):
    assert units.convert(value, unit, to) == pytest.approx(expected, rel=1e-12)


@pytest.mark.parametrize(
    "text",
    [
        "apples",
        "s**99999",
        "s^-12",
        "__import__",
        "()",
        "m" * 50,
        "1",
        "1/",
        "s;m",
        3,
        None,
        "2 s",
        "m^9^9^9",
        "(m^9)^9",
        "m²²²",
        "%**%",
        "(m)**(m)",
        "1 2",
        "1 m",
    ],
)
def test_what_is_no_unit(text):
    assert not units.is_unit(text)


NAMES = sorted({"K", "Hz", "%"}.union(*units.FAMILIES))


@pytest.mark.parametrize("name", NAMES)
def test_what_is_taken_for_a_unit_without_pint_is_one_for_pint(name):
    texts = [
        name,
        f"1/{name}",
        f"K/{name}",
        f"{name}/({name}/s)",
        f"1/(kg {name})",
        f"{name} s kg/°C",
        f"({name}/s)/m",
        "",
        "°C",
    ]
    texts += [name + exponent for exponent in "²³" if name not in ("%", "m³")]
    assert all(units._EVERYDAY.fullmatch(text) for text in texts)
    assert all(units._parsed(text) for text in texts)


@pytest.mark.parametrize("unit", ["s", "1/s", "%", "", "°C", "K", "rad/s", "kg/min", "%/K", "K/%", "m³/s", "rad", "Hz"])
def test_neighbours_are_other_values_of_the_same_quantity(unit):
    for other, converted in units.neighbours(unit).items():
        assert units.convert(converted(3.0), other, to=unit) == pytest.approx(3.0)
        assert converted(3.0) != pytest.approx(3.0)
