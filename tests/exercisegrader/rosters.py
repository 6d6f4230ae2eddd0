"""A class of three whom both Canvas and Moodle know, and what a reader of files complains of."""

from exercisegrader import GradingError
from exercisegrader.student import Student

JANE = Student("s1001", "Jane Doe", "Doe, Jane", canvas_id="123", moodle_id="77001")
JOHN = Student("s1002", "John Roe", "Roe, John", canvas_id="124", moodle_id="77002")
ANNE = Student("s1003", "Anne Müller-Lüdenscheidt", "Müller-Lüdenscheidt, Anne", canvas_id="125", moodle_id="77003")
CLASS = (JANE, JOHN, ANNE)


def attempted(function, *arguments):
    """What a function returns, or None, and what it complains of, or ""."""
    try:
        return function(*arguments), ""
    except GradingError as problem:
        return None, str(problem)
