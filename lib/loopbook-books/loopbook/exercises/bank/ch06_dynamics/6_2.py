"""Python beside the page of exercise 6.2."""

from loopbook.exercises.bank.ch06_dynamics.shared import after  # noqa: F401
from loopbook.transfer import first_order  # noqa: F401
