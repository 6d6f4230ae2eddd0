"""A name that is said once: kept beside the progress, used by every exercise of the folder, and forgotten on demand."""

import pytest

from exercisebook.bank import student
from exercisebook.errors import ExerciseError
from exercisebook.naming import FILE, keep
from shelf import exercise, progress
from test_exercise_progress import printed, right


@pytest.fixture
def desk(own_folder):
    """The file of the name."""
    return own_folder / FILE


def test_a_name_is_said_once_and_survives_a_restart(desk):
    own, reference = exercise("1.1", student="Mira").statement, exercise("1.1").statement
    assert own != reference
    assert repr(student("Mira")).startswith("Mira: the exercises have your own numbers")
    assert exercise("1.1").statement == own
    program = "from shelf import exercise; from exercisebook.bank import student; "
    assert printed(f"{program}print(student().name, exercise('1.1').student)") == "Mira Mira\n"
    assert repr(student(None)).startswith("No name yet")
    assert exercise("1.1").statement == reference
    assert student(None).name is None, "to forget what is forgotten is no fault"


def test_dots_change_nothing(desk):
    assert student(...).name is None
    assert not desk.exists()
    student("Mira")
    assert student(...) == student() == student("Mira")


def test_progress_is_that_of_the_name_and_another_name_wins(desk):
    right(exercise("1.1"))
    student("Mira")
    assert progress("1").right == 0
    right(exercise("1.1"))
    right(exercise("1.2"))
    assert (progress("1").right, progress().right) == (2, 2)
    assert exercise("1.1", student="Ada").student == "Ada"
    right(exercise("1.1", student="Ada"))
    assert (progress("1").right, progress("1", student="Ada").right) == (2, 1)
    student(None)
    assert (progress("1").right, progress().right) == (1, 1)


def test_one_spelling(desk):
    assert student("  Zoe\u0308 ").name == student("Zo\u00eb").name == "Zo\u00eb"


@pytest.mark.parametrize(
    ("name", "says"),
    [
        ("", r"student is an empty text: expected a name, as in student\('Mira'\)$"),
        (" ", "student is an empty text"),
        (3, "student is 3: expected a name in quotes"),
        ("Mira\nAda", r"student is 'Mira\\nAda': expected a name in one line of at most 100 characters"),
        ("M" * 101, "expected a name in one line of at most 100 characters"),
        ("\ud800", "expected a name in one line"),
    ],
)
def test_what_is_no_name_is_said_in_a_sentence_and_kept_nowhere(desk, name, says):
    with pytest.raises(ExerciseError, match=says):
        student(name)
    assert not desk.exists()


def test_the_switch_of_the_progress_is_that_of_the_name(desk, monkeypatch):
    student("Mira")
    monkeypatch.setenv("LOOPBOOK_PROGRESS", "off")
    assert student().name is None
    assert exercise("1.1").student is None
    student("Ada")
    student(None)
    monkeypatch.delenv("LOOPBOOK_PROGRESS")
    assert student().name == "Mira", "what is off changes nothing"


@pytest.mark.parametrize("content", [b"{", b'{"student": 3}', b'{"student": " Mira"}'])
def test_a_damaged_file_is_ignored_with_a_warning(desk, content):
    desk.write_bytes(content)
    with pytest.warns(UserWarning, match="is damaged and ignored; say your name again"):
        assert exercise("1.1").student is None
    assert student("Mira").name == "Mira"


def test_a_name_that_cannot_be_stored_is_said(desk):
    desk.mkdir()
    with pytest.warns(UserWarning, match="the name cannot be stored"):
        keep("Mira")


@pytest.mark.parametrize(
    ("make", "says"),
    [
        (lambda: exercise("1.9"), "there is no exercise '1.9': did you mean '1."),
        (lambda: exercise("99.1"), "there is no chapter '99'"),
        (lambda: exercise(1.1), "the exercise is 1.1: expected chapter and place in it as text"),
        (lambda: exercise("1.1", student=""), "empty text"),
        (lambda: exercise("1.1", student=3), "student is 3"),
        (lambda: progress("B"), "there is no chapter 'B'"),
    ],
)
def test_a_reader_is_told_what_there_is(make, says):
    with pytest.raises(ExerciseError) as caught:
        make()
    assert says in str(caught.value)
