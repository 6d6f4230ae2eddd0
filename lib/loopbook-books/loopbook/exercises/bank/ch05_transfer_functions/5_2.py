"""Python beside the page of exercise 5.2."""

from loopbook.transfer import initial_slope, static_gain, zeros  # noqa: F401
from loopbook.transfer import poles as poles_of  # noqa: F401

in_order = sorted
