"""The answer sheet under the name by which released notebooks import it."""

from exercisegrader.student_side.answer_sheet import *
from exercisegrader.student_side.answer_sheet import __all__  # noqa: F401
