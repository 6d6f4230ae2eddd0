"""What exercise 17.2 needs."""

from loopbook import Loop, first_order
from loopbook.exercises.bank.ch17_dead_time_compensation.shared import is_step_response, predictor
from loopbook.exercises.bank.ch17_dead_time_compensation.shared import predictor_diagram as picture
from loopbook.ise import ise

__all__ = ["Loop", "first_order", "is_step_response", "ise", "picture", "predictor"]
