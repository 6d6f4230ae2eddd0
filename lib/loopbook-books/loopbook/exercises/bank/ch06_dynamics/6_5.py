"""Python beside the page of exercise 6.5."""

from loopbook.exercises.bank.ch06_dynamics.shared import after  # noqa: F401
from loopbook.transfer import response_time, second_order  # noqa: F401
