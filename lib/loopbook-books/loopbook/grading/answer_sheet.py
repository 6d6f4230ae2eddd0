"""The answer sheet under the name by which released notebooks import it."""

from exercisegrader.inside.answer_sheet import *
from exercisegrader.inside.answer_sheet import __all__  # noqa: F401
