"""Assignments: read from a module, with variants from its secret; an error of the author is one sentence."""

import hashlib
import os

import pytest

from assignments import HEAD, ONE, written
from exercisegrader import GradingError
from exercisegrader.assignment import Assignment, load


def test_an_assignment(tuning):
    assert (tuning.title, tuning.introduction) == ("Tuning $K$", "An introduction.")
    assert list(tuning.exercises) == ["1", "2"]
    assert (tuning.points, tuning.name, tuning.path) == (7, "tuning", None)
    assert tuning.fingerprint == Assignment.of(written(), "other").fingerprint
    assert tuning.fingerprint != Assignment.of(written() + "\n", "tuning").fingerprint


def test_variants_come_from_the_secret_the_student_and_the_exercise(tuning):
    drawn = hashlib.new("sha256")
    for student in ("s1001", "s1002"):
        drawn.update(str(tuning.question(student, "1").values).encode())
    # the same on every machine
    assert drawn.hexdigest()[:12] == "7dfe031acf82"
    other = Assignment.of(written().replace("a secret", "another secret"), "tuning")
    values = [[one.question(f"s{k}", "1").values for k in range(8)] for one in (tuning, other)]
    assert values[0] != values[1]
    assert len({str(one) for one in values[0]}) > 4
    with pytest.raises(GradingError, match="no exercise '9'"):
        tuning.question("s1001", "9")


@pytest.mark.parametrize(
    ("source", "says"),
    [
        ("x = (", "tuning.py, line 1: '(' was never closed"),
        ("\n1/0", "tuning.py, line 2: ZeroDivisionError: division by zero"),
        ("\n\nraise SystemExit", "tuning.py, line 3: SystemExit"),
        ("import nothing_of_this_name", "line 1: ModuleNotFoundError"),
        ("x = 1", "has no docstring"),
        ('"Title"\n', "has no SECRET of at least 16 characters"),
        ('"Title"\nSECRET = "short"', 'write SECRET = "'),
        (HEAD, "has no exercise"),
        (
            HEAD + ONE.format('"1"', 1, "y=x") + ONE.replace("first", "second").format('"1"', 1, "y=x"),
            "two exercises 1",
        ),
        (HEAD + ONE.format("1", 1, "y=x"), "number of an exercise is 1: expected a text"),
        (HEAD + ONE.format('"a b"', 1, "y=x"), "number of an exercise is 'a b'"),
        (HEAD + ONE.format('"1"', 0, "y=x"), "has 0 points"),
        (HEAD + ONE.format('"1"', '"4"', "y=x"), "has '4' points"),
    ],
)
def test_an_error_of_the_author_is_one_sentence(source, says):
    with pytest.raises(GradingError) as error:
        Assignment.of(source, "tuning")
    assert says in str(error.value)
    assert "\n" not in str(error.value)


def test_a_file_is_loaded_with_the_modules_beside_it(tmp_path):
    (tmp_path / "heater_constants.py").write_text("GAIN = '7.125'\n")
    path = tmp_path / "tuning.py"
    path.write_text(
        "\N{ZERO WIDTH NO-BREAK SPACE}" + written().replace("import sympy\n", "import sympy, heater_constants\n")
    )
    found = load(path)
    assert (found.name, found.path, found.title) == ("tuning", path, "Tuning $K$")
    with pytest.raises(ModuleNotFoundError):
        __import__("heater_constants_2")
    assert str(tmp_path) not in os.sys.path


@pytest.mark.parametrize(
    ("name", "content", "says"),
    [("a.py", None, "cannot be read"), ("a.txt", b"", "expected pages, as heater.md, or a Python module"), ("a.py", b"\xff\xfe", "UTF-8")],
)
def test_what_is_no_assignment(tmp_path, name, content, says):
    if content is not None:
        (tmp_path / name).write_bytes(content)
    with pytest.raises(GradingError, match=says):
        load(tmp_path / name)
