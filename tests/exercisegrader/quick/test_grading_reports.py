"""The outputs of grading: grades, pages of students, Gradescope's format, the summary."""

import json
import random
import re
from dataclasses import replace
from unittest import mock

import pytest

import contributing
from exercisegrader import GradingError, reports
from exercisegrader.lms.gradescope import results_json
from exercisegrader.reports.outputs import output, registered
from exercisegrader.student import Student
from small_class import (
    ADA,
    BOB,
    CLASS,
    HOSTILE,
    NAMED,
    RESULTS,
    RIGHT_ALL,
    STOPPED,
    TITLE,
    changed,
    grades,
    result_of,
    right,
)

# Whatever is registered.


def texts(one, results=RESULTS, students=CLASS, **more):
    return [text for _, text in one.files(grades(results, students=students, **more)) if isinstance(text, str)]


def shown():
    """The output that contributors are shown, of which the registry keeps nothing."""
    with mock.patch.dict(reports.outputs._REGISTERED, clear=True):
        contributing.run("Add an output")
        return reports.outputs._REGISTERED["names.txt"]


#: Those for any roster; those of learning management systems are tested with their rosters.
each_output = pytest.mark.parametrize(
    "one", [*(one for one in registered() if texts(one)), shown()], ids=lambda one: one.file
)


@each_output
def test_an_output_is_one_file_or_one_for_each_student_or_section(one):
    sections = 2 if one.is_for_each_part else 1
    assert len(texts(one)) == (len(RESULTS) if one.is_for_each_student else sections)
    assert len(texts(one, [])) == (0 if one.is_for_each_student else sections)


@each_output
@pytest.mark.parametrize("reveal", [False, True])
def test_keys_are_shown_only_where_they_are_revealed(one, reveal):
    """And to students alone: who grades the class has them."""
    result = result_of(ADA, {"1": {"K": 1.5}})
    exercises_ = tuple(
        replace(one, answers=tuple(replace(answer, key=f"KEY{answer.name}") for answer in one.answers))
        for one in result.result.exercises
    )
    result = changed(result, exercises=exercises_)
    text, *_ = texts(one, [result], reveal=reveal)
    assert text.count("KEY") == (4 if reveal and one.is_for_each_student else 0)


@each_output
def test_without_a_jail_an_output_of_marks_says_so(one):
    if texts(one) != texts(one, []):
        for text in texts(one, [changed(mark, jailed=False) for mark in RESULTS]):
            assert "without a jail" in text, f"{one.file} has marks: expected the line NO_JAIL of reports.wording in it"
    assert not any("without a jail" in text for text in texts(one))


@each_output
def test_what_a_student_writes_leaves_no_output_torn(one):
    hostile = Student("s1003", HOSTILE)
    for text in (*texts(one, [STOPPED], [hostile]), results_json(grades(), hostile, STOPPED)):
        assert re.search(r"[\x00-\x09\x0b-\x1f\x7f-\x9f\u202e]", text) is None


def test_two_outputs_with_one_file_are_refused():
    with pytest.raises(GradingError, match=r"two outputs have the file 'grades.csv'"):
        output("grades.csv", "the grades")


def test_the_output_that_contributors_are_shown_is_what_they_are_told():
    assert texts(shown()) == ["\n".join(student.name for student in CLASS)]


def test_what_no_file_can_hold_is_refused():
    says = "the output 'new.csv' has '\\ud800', half a character that no file can hold: expected what"
    with pytest.raises(GradingError, match=re.escape(says)):
        texts(reports.Output("new.csv", "the grades", lambda grades: "Ada \ud800"))


def test_an_output_that_does_not_fit_the_roster_is_no_file():
    for file in ("new.csv", "{student}.csv"):
        assert list(reports.Output(file, "the grades", lambda *told: None).files(grades())) == []


# Gradescope.


def test_gradescope_reads_the_result():
    data = json.loads(results_json(grades(), BOB, NAMED))
    assert data["score"] == 3.67
    assert data["output_format"] == data["test_output_format"] == data["test_name_format"] == "text"
    assert data["visibility"] == "visible"
    first, second = data["tests"]
    assert (first["number"], first["name"]) == ("1", "Gain below K_u")
    assert (first["score"], first["max_score"], first["status"]) == (2.67, 4, "failed")
    assert (second["score"], second["max_score"], second["status"]) == (1, 1, "passed")
    assert first["output"].splitlines()[0].startswith("≈ K: mistake, That is the gain itself, (K)/(1), not twice")


def test_gradescope_shows_keys_only_when_grades_are_published():
    data = json.loads(results_json(grades(reveal=True), BOB, NAMED))
    assert {data["visibility"], *(test["visibility"] for test in data["tests"])} == {"after_published"}


# All of it.


def class_of(count):
    """A class in which everybody solves the exercises more or less well."""
    luck = random.Random(8)
    students = [Student(f"s{k:04}", f"Student {k}") for k in range(count)]

    def some(question):
        return {name: luck.choice([value, value, value, None]) for name, value in right(question).items()}

    return students, [result_of(student, some) for student in students]


def test_the_outputs_do_not_depend_on_order_or_place(tmp_path):
    students, results = class_of(12)
    written = []
    for name, order in (("a", results), ("b", results[::-1])):
        reports.write_all(tmp_path / name, TITLE, students, order)
        paths = [path for path in (tmp_path / name).rglob("*") if path.is_file()]
        written.append({path.relative_to(tmp_path / name): path.read_bytes() for path in paths})
    fitting = [one for one in registered() if texts(one)]
    of_texts = sum(len(students) if one.is_for_each_student else 1 for one in fitting)
    assert len(written[0]) == of_texts + len(["feedback.zip"])
    assert written[0] == written[1]
    assert all(b"\r" not in content for path, content in written[0].items() if path.suffix != ".zip")


def test_results_of_others_are_left_out_and_nothing_is_deleted(tmp_path):
    kept = tmp_path / "feedback" / "s0" / "feedback.html"
    kept.parent.mkdir(parents=True)
    kept.write_text("mine")
    reports.write_all(tmp_path, TITLE, [ADA], [*RESULTS, changed(RIGHT_ALL, student="../../x")])
    assert sorted(path.name for path in (tmp_path / "feedback").iterdir()) == ["s0", "s1001"]
    assert kept.read_text() == "mine"
