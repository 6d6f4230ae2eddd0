"""The exercises of the chapters, which respond to answers.

>>> from loopbook.exercises import exercise, progress
>>> exercise("10.1", student="Ada").statement.heading
'Exercise 10.1 · A model by ruler'
>>> progress("10").right
0
"""

from exercisebook import slips
from exercisebook.bank import student
from exercisebook.errors import ExerciseError
from loopbook.exercises.bank import BANK

__all__ = ["ExerciseError", "exercise", "progress", "student"]

exercise, progress = BANK.exercise, BANK.progress
slips.install()
