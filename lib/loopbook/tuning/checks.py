"""What the rules ask of their input, numbers or letters: one sentence that names the value and what was expected."""

from __future__ import annotations

from typing import TYPE_CHECKING

import sympy

from loopbook.expressions import exact
from loopbook.types import Number

if TYPE_CHECKING:
    from loopbook.approximation import SOPDT


def steepest_slope(model: SOPDT, rule: str) -> sympy.Expr:
    """The steepest slope of the step response: the gain over the largest lag."""
    if model.T1 == 0:
        raise ValueError(f"{rule} needs a lag or an integrator, and {model} has none: give it a small lag")
    return model.K if model.is_integrating else model.K / model.T1


def within(name: str, value: sympy.Expr, low: Number, high: Number, extrapolate: bool) -> None:
    if not extrapolate and ((low - value).is_positive or (value - high).is_positive):
        raise ValueError(
            f"{name} is {value.evalf(4)}: the rule is for {low} to {high}; extrapolate=True leaves this range"
        )


def gain(name: str, value: Number) -> sympy.Expr:
    value = exact(value)
    if value == 0 or value.is_infinite or value.is_real is False:
        raise ValueError(f"{name} is {value}: expected a finite gain that is not zero")
    return value


def positive(name: str, value: Number) -> sympy.Expr:
    if (value := finite_time(name, value)) == 0:
        raise ValueError(f"{name} is 0: expected a positive number")
    return value


def finite_time(name: str, value: Number) -> sympy.Expr:
    if (value := endless_time(name, value)).is_infinite:
        raise ValueError(f"{name} is {value}: expected a finite number")
    return value


def endless_time(name: str, value: Number) -> sympy.Expr:
    value = exact(value)
    if value.is_negative or (value.is_real is False and value != sympy.oo):
        raise ValueError(f"{name} is {value}: expected a number that is not negative")
    return value
