"""Scaling between units: Haugen, equations (7.2) to (7.8), and the round trips of Figure 7.1."""

import numpy as np
import pytest
import sympy
from hypothesis import assume, given
from hypothesis import strategies as st

from loopbook.scaling import PERCENT, Scaling

ENDS = st.fractions(-1000, 1000, max_denominator=100).map(sympy.Rational)


@given(*4 * [ENDS], ENDS)
def test_ends_meet_ends_and_the_inverse_goes_back(x_min, x_max, z_min, z_max, x):
    assume(x_min != x_max and z_min != z_max)
    scaling = Scaling((x_min, x_max), (z_min, z_max))
    assert (scaling(x_min), scaling(x_max)) == (z_min, z_max)
    assert scaling.inverse(scaling(x)) == x
    assert scaling.b == z_max - scaling.a * x_max  # equation (7.5)


def test_sensor_and_percent_make_one_scaling():
    f_1, f_2, f_3 = Scaling((0, 15), (4, 20)), Scaling((4, 20), PERCENT), Scaling((0, 15), PERCENT)
    assert all(f_1.then(f_2)(level) == f_3(level) for level in (0, 3, 7.5, 15))


def test_a_difference_has_no_offset():
    scaling = Scaling((20, 70), PERCENT)
    assert scaling.of_differences()(1) == scaling(41) - scaling(40) == 2


def test_arrays_and_floats_are_scaled_as_numbers():
    scaling = Scaling(PERCENT, (4, 20))
    assert scaling(np.array([0, 25.0, 100])) == pytest.approx([4, 8, 20])
    assert isinstance(scaling(25.0), float)


@pytest.mark.parametrize("wrong", [(0, 0), (0,), 5, ("a", "b"), (0, sympy.oo), (0, sympy.Symbol("x")), None])
def test_a_range_is_two_different_numbers(wrong):
    with pytest.raises(ValueError, match="range is"):
        Scaling(wrong, PERCENT)
