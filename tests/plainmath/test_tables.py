"""Quantities and tables: what a reader sees, rounded once."""

import math
from types import SimpleNamespace

import numpy as np
import pytest
import sympy

from plainmath.tables import quantities, rounded, table


@pytest.mark.parametrize(
    ("value", "text"),
    [
        (12.3456, "12.3"), (-0.012349, "-0.0123"), (999.96, "1000"), (1236.3, "1236"), (0.99996, "1.00"), (3.0, "3"),
        (123456.7, "123457"), (1234567.8, "1.23e6"), (5e-5, "5e-5"), (math.inf, "∞"), (math.nan, "not a number"),
    ],
)  # fmt: skip
def test_numbers_are_rounded_to_three_digits_but_not_before_the_point(value, text):
    assert rounded(value) == text


@pytest.mark.parametrize(
    ("value", "text"),
    [
        (True, "yes"), (np.bool_(False), "no"), (sympy.false, "no"), (None, "–"), (np.float64(0.5), "0.500"),
        (np.int64(7), "7"), (1 - 2j, "1 - 2j"), (sympy.Rational(3, 2), "3/2"), (sympy.oo, "∞"),
        (sympy.Rational(27, 20), "1.35"), (sympy.Float(2.5), "2.50"),
        ([1.0, 2.5], "1, 2.50"), ([], "none"), (SimpleNamespace(K=2), "namespace(K=2)"), ("as said", "as said"),
    ],
)  # fmt: skip
def test_a_value_of_any_kind_is_shown(value, text):
    assert repr(quantities({"x": value})) == f"x  {text}"


def test_the_unit_stands_behind_the_value_and_symbols_are_typeset():
    shown = quantities({"Ti [s]": 900.4}, Ms=2)._repr_html_()
    assert "$T_{i}$" in shown
    assert "<td" in shown
    assert "900 s" in shown
    assert "$M_{s}$" in shown


def test_a_formula_is_typeset_and_text_cannot_become_html():
    assert r"\dfrac{1}{3}" in quantities(K=sympy.Rational(1, 3))._repr_html_()
    assert "<b>" not in table(["<b>"], {"<b>": ["<b>"]}, of="<b>")._repr_html_()


def test_a_table_has_one_value_for_each_column():
    with pytest.raises(ValueError, match="the row 'PI' has 2 values, and there are 1 columns"):
        table(["Kp"], {"PI": [1, 2]})
    with pytest.raises(ValueError, match="expected at least one"):
        table(["Kp"], {})
    with pytest.raises(ValueError, match="no quantity"):
        quantities()


def test_rows_of_one_column_need_no_list_and_rows_need_no_names():
    assert repr(table(["K"], {"a": 1, "b": 2}, of="loop")).splitlines() == ["loop  K", "a     1", "b     2"]
    assert repr(table(["t", "y"], np.array([[0, 1.0], [1, 0.25]]))).splitlines()[-1] == "1  0.250"


def test_names_of_rows_may_be_numbers():
    shown = table(["K"], {0.2: 1, 2: 3}, of="lag [s]")
    assert repr(shown).splitlines()[1:] == ["0.2      1", "2        3"]
    assert "$2$" not in shown._repr_html_()


def test_what_can_be_gone_through_once_is_shown_as_often_as_it_is_asked_for():
    shown = quantities({"steps [s]": map(float, (0.5, 2))})
    assert repr(shown) == repr(shown) == "steps  0.500, 2 s"
