"""What exercise 17.3 needs."""

from loopbook import System
from loopbook.exercises.bank.ch17_dead_time_compensation.shared import predictor as smith
from loopbook.exercises.bank.ch17_dead_time_compensation.shared import predictor_diagram as picture

__all__ = ["System", "picture", "smith"]
