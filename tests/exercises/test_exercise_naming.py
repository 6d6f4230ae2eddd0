"""A name that is said once: kept beside the progress, used by every exercise of the folder, and forgotten on demand."""

import os
import subprocess
import sys

import pytest

from exercisebook.naming import FILE
from loopbook import exercises
from loopbook.exercises import bank, exercise, progress, student


@pytest.fixture
def desk(own_folder):
    """The file of the name."""
    return own_folder / FILE


def right(question):
    return question.check(**{name: kind.key for name, kind in question.key.items()})


def test_a_name_is_said_once_and_survives_a_restart(desk):
    own, reference = exercise("10.1", student="Mira").statement, exercise("10.1").statement
    assert own != reference
    assert repr(student("Mira")).startswith("Mira: the exercises have your own numbers")
    assert exercise("10.1").statement == own
    program = "from loopbook.exercises import exercise, student; print(student().name, exercise('10.1').student)"
    result = subprocess.run([sys.executable, "-c", program], capture_output=True, encoding="utf-8", check=True)
    assert result.stdout == "Mira Mira\n"
    assert repr(student(None)).startswith("No name yet")
    assert exercise("10.1").statement == reference
    assert student(None).name is None, "to forget what is forgotten is no fault"


def test_dots_change_nothing(desk):
    assert student(...).name is None
    assert not desk.exists()
    student("Mira")
    assert student(...) == student() == student("Mira")


def test_an_explicit_name_wins(desk):
    student("Mira")
    assert exercise("10.1", student="Ada").student == "Ada"
    right(exercise("10.1", student="Ada"))
    assert (progress("10").right, progress("10", student="Ada").right) == (0, 1)


def test_progress_is_that_of_the_name(desk):
    right(exercise("10.1"))
    student("Mira")
    assert progress("10").right == 0
    right(exercise("10.1"))
    right(exercise("10.2"))
    assert (progress("10").right, progress().right) == (2, 2)
    student(None)
    assert (progress("10").right, progress().right) == (1, 1)


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
    with pytest.raises(exercises.ExerciseError, match=says):
        student(name)
    assert not desk.exists()


def test_the_switch_of_the_progress_is_that_of_the_name(desk, monkeypatch):
    student("Mira")
    monkeypatch.setenv("LOOPBOOK_PROGRESS", "off")
    assert student().name is None
    assert exercise("10.1").student is None
    student("Ada")
    student(None)
    monkeypatch.delenv("LOOPBOOK_PROGRESS")
    assert student().name == "Mira", "what is off changes nothing"


@pytest.mark.parametrize("content", [b"", b"{", b"[]", b"\xff\xfe", b'{"student": 3}', b'{"student": " Mira"}'])
def test_a_damaged_file_is_ignored_with_a_warning(desk, content):
    desk.write_bytes(content)
    with pytest.warns(UserWarning, match="is damaged and ignored; say your name again"):
        assert exercise("10.1").student is None
    assert student("Mira").name == "Mira"


@pytest.mark.skipif(not hasattr(os, "geteuid") or os.geteuid() == 0, reason="nothing is forbidden to root")
def test_a_folder_that_cannot_be_written_is_said(desk):
    desk.parent.chmod(0o500)
    with pytest.warns(UserWarning, match="the name cannot be stored"):
        student("Mira")
    desk.parent.chmod(0o700)


def test_the_whole_collection_at_a_glance(desk):
    right(exercise("10.2"))
    exercise("10.1").check(K=77)
    everything = progress()
    total = sum(len(bank.exercises(chapter)) for chapter in bank.chapters())
    first, *rows = repr(everything).splitlines()
    assert first == everything.summary == f"1 of {total} right"
    assert len(rows) == len(bank.chapters())
    own = len(bank.exercises("10"))
    assert [row for row in rows if "10 · Tuning of PID controllers" in row and row.endswith("✗ ✓" + " ·" * (own - 2))]
    page = everything._repr_html_()
    assert '<a href="10_tuning.ipynb">10 · Tuning of PID controllers</a>' in page
    assert f"1 of {own}" in page
