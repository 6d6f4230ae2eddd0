"""The record of a release: numbers stay as they were released, ids too, and what is not as it was is said."""

import json
import re
from dataclasses import replace

import nbformat
import pytest
from typer.testing import CliRunner

from assignments import ONE, written
from exercisegrader import GradingError
from exercisegrader.__main__ import app
from exercisegrader.assignment import load
from exercisegrader.imprint import Imprint, peek
from exercisegrader.release import as_text, installed, notebook, release
from exercisegrader.released import FEW, Released, texts
from exercisegrader.student import Student
from exercisegrader.submissions import collect

ADA = Student("s1", "Ada Lovelace", canvas_id="101", sis_id="A1", login="ada", email="ada@x.org")
BOB = Student("s2", "Bob Watt", canvas_id="102", sis_id="A2", login="bob", email="bob@x.org")
EVE = Student("s3", "Eve Black", canvas_id="103", sis_id="A3", login="eve", email="eve@x.org")
CLASS = (ADA, BOB, EVE)
X = Student("x", "X")
NAMES_ALONE = tuple(Student(one.id, one.name) for one in CLASS)


class Course:
    """An assignment in a folder, which can be changed, and its releases."""

    def __init__(self, folder):
        self.path, self.to = folder / "tuning.py", folder / "released"
        self.record = folder / "tuning.released.json"
        self.write(written())

    def write(self, text):
        self.path.write_text(text, encoding="utf-8")

    def mend(self, old, new):
        text = self.path.read_text(encoding="utf-8")
        assert old in text
        self.write(text.replace(old, new))

    @property
    def assignment(self):
        return load(self.path)

    @property
    def released(self):
        return Released.of(self.assignment)

    def release(self, students=CLASS, **options):
        return release(self.assignment, students, self.to, **options)

    def values(self, student, number="1"):
        """The numbers by which a student is graded."""
        return self.assignment.question(student, number, self.released.numbers(student).get(number)).values

    def edit(self, change):
        """Change what the record says."""
        data = json.loads(self.record.read_text(encoding="utf-8"))
        change(data)
        self.record.write_text(json.dumps(data), encoding="utf-8")

    def bytes(self):
        return {path: path.read_bytes() for path in [*self.to.rglob("*.ipynb"), self.record]}


@pytest.fixture
def fresh(tmp_path):
    """A course that has released nothing."""
    return Course(tmp_path)


@pytest.fixture
def course(fresh):
    """A course that was released to its class."""
    fresh.release()
    return fresh


RANGE = 'K=between(2, 6, "K/%"), T'


# Numbers.


def test_a_record_is_written_and_read(fresh):
    done = fresh.release()
    assert (done.added, done.kept, done.remarks, done.record) == (("s1", "s2", "s3"), (), (), fresh.record)
    released = fresh.released
    assert list(released.holders) == ["s1", "s2", "s3"]
    assert released.numbers("s1")["1"] == texts(fresh.assignment.question("s1", "1"))
    assert released.numbers("s1")["2"]["action"] in ("'heating'", "'cooling'")
    assert released.numbers("s9") == {}
    assert released.differences(fresh.assignment, CLASS) == ()
    again = fresh.record.read_bytes()
    fresh.release()
    assert fresh.record.read_bytes() == again


def test_numbers_stay_when_a_range_is_mended(course):
    before = {one.id: course.values(one.id) for one in CLASS}
    course.mend(RANGE, 'K=between(20, 60, "K/%"), T')
    assert course.assignment.question("s1", "1").values != before["s1"]
    assert {one.id: course.values(one.id) for one in CLASS} == before
    says = "other ranges than at the release: K in exercise 1; those who were released to keep their numbers"
    assert course.released.differences(course.assignment, CLASS) == (says,)
    # somebody who joins later has numbers of the new range, and everybody else the same notebook
    files = course.bytes()
    late = Student("s4", "Late Comer")
    done = course.release([*CLASS, late])
    assert (done.added, done.kept, done.remarks) == (("s4",), ("s1", "s2", "s3"), (says,))
    assert files.items() - course.bytes().items() == {(course.record, files[course.record])}
    assert course.values("s4")["K"] >= 20
    assert {one.id: course.values(one.id) for one in CLASS} == before


@pytest.mark.parametrize(
    ("old", "new", "says"),
    [
        ("T=between(15", 'new=choice("a", "b"), T=between(15', "exercise 1: the parameter new has been added since"),
        ("T=between(15", "more=between(1, 9), T=between(15", "the parameter more has been added since"),
        ("action=choice", "other=choice", "exercise 2: the parameter action was released and is gone: it is ignored"),
        ('@exercise("2"', '@exercise("3"', "exercise 2 was released and is gone from tuning.py: it is not graded"),
        ('@exercise("2"', '@exercise("3"', "exercise 3 is not in the notebooks that s1, s2 and s3 got"),
    ],
)
def test_what_is_no_longer_as_it_was_released_is_said(course, old, new, says):
    before = course.values("s1")
    course.mend(old, new)
    if "other=" in new:
        course.mend("{action}", "{other}")
    found = course.released.differences(course.assignment, CLASS)
    assert any(says in one for one in found), found
    assert before.items() <= course.values("s1").items()


def test_those_without_a_release_are_named_and_a_lost_record_is(fresh):
    fresh.release([ADA])
    (says,) = fresh.released.differences(fresh.assignment, CLASS)
    assert says.startswith("tuning.released.json has no numbers of s2 and s3: nothing was released to them")
    fresh.record.unlink()
    (says,) = fresh.released.differences(fresh.assignment, CLASS)
    assert says.startswith("tuning.released.json is not beside tuning.py: all numbers are drawn from the secret")


def test_a_condition_that_nobody_new_could_meet_does_not_keep_the_others_from_grades(course):
    before = course.values("s1")
    course.mend('title="Gain", points=4', 'title="Gain", points=4, where=lambda K: K > 100')
    assert course.values("s1") == before
    (says,) = course.released.differences(course.assignment, CLASS)
    assert says.startswith("other ranges than at the release: K and T in exercise 1")


# A record that is not what it should be.


def _other_number(data):
    data["students"]["s1"]["numbers"]["1"]["K"] = "3" if data["students"]["s1"]["numbers"]["1"]["K"] != "3" else "4"


@pytest.mark.parametrize(
    ("change", "says"),
    [
        (_other_number, "was changed since it was written: put the one of the release back, from a copy"),
        (lambda data: data["students"].pop("s2"), "was changed since it was written"),
        (lambda data: data["students"]["s1"].update(email="eve@x.org"), "was changed since it was written"),
        (lambda data: data.pop("signature"), "is damaged: put the one of the release back"),
        (lambda data: data.update(signature=7), "was changed since it was written"),
        (lambda data: data.update(students=["s1"]), "is damaged"),
        (lambda data: data["students"].update(s1={}), "is damaged"),
        (lambda data: data.update(assignment="heater"), "is the record of 'heater', and the assignment is 'tuning'"),
    ],
)
def test_a_record_that_was_changed_is_one_sentence(course, change, says):
    course.edit(change)
    with pytest.raises(GradingError) as problem:
        _ = course.released
    assert says in str(problem.value)
    assert "\n" not in str(problem.value)
    with pytest.raises(GradingError, match=re.escape(says)):
        course.release(replace=True, new_numbers=True)


@pytest.mark.parametrize("content", [b"", b"{", b"\xff\xfe", b"[]", b"null", b"[" * 100_000, None])
def test_a_damaged_record_is_one_sentence(course, content):
    whole = course.record.read_bytes()
    course.record.write_bytes(whole[: len(whole) // 2] if content is None else content)
    with pytest.raises(GradingError, match="is damaged"):
        _ = course.released


def test_a_record_after_an_editor_is_the_same_record(course):
    text = course.record.read_text(encoding="utf-8").replace("\n", "\r\n")
    course.record.write_bytes(b"\xef\xbb\xbf" + text.encode())
    assert list(course.released.holders) == ["s1", "s2", "s3"]


def test_another_secret_is_one_sentence_and_the_record_tells_nothing_of_it(course):
    assert "a secret of" not in course.record.read_text(encoding="utf-8")
    course.mend("a secret of many letters", "another secret of letters")
    with pytest.raises(GradingError, match=r"the SECRET of tuning\.py is not the one with which"):
        _ = course.released


# Who somebody is.


@pytest.mark.parametrize(
    ("row", "kept"),
    [
        (Student("17", "A. Lovelace", canvas_id="101"), "s1"),
        (Student("17", "Ada", canvas_id="101", sis_id="changed", email="new@x.org"), "s1"),
        (Student("17", "Ada", sis_id="a1"), "s1"),
        (Student("17", "Ada", login="ADA "), "s1"),
        (Student("17", "Ada", email="Ada@X.org"), "s1"),
        (Student("17", "Ada Lovelace"), "17"),
        (Student("s1", "Ada King"), "s1"),
        (Student("101", "Somebody", canvas_id="199"), "101"),
    ],
)
def test_the_id_of_the_release_is_kept(course, row, kept):
    (one,), said = course.released.identified([row])
    assert one == replace(row, id=kept)
    changed = f"the roster gives other ids than at the release; those of the release are kept: {kept} (now {row.id})"
    assert (changed in said) == (kept != row.id)


def test_ids_of_a_whole_class_are_kept(course):
    files = course.bytes()
    done = course.release([replace(one, id=one.login) for one in CLASS])
    assert done.kept == ("s1", "s2", "s3")
    assert course.bytes() == files
    (said,) = done.remarks
    assert said.endswith("those of the release are kept: s1 (now ada), s2 (now bob) and s3 (now eve)")


def test_submissions_are_found_by_both_ids(course, tmp_path):
    kept, _ = course.released.identified([replace(one, id=one.login) for one in CLASS])
    for name in ("s1", "bob"):
        (tmp_path / "in" / name).mkdir(parents=True)
        (tmp_path / "in" / name / "tuning.ipynb").write_text("{}", encoding="utf-8")
    found = collect(tmp_path / "in", kept, "tuning")
    found = {one.student.id: one.label for one in found.submissions}
    assert found == {"s1": "s1/tuning.ipynb", "s2": "bob/tuning.ipynb"}


def test_an_id_that_was_all_that_was_known_is_found_in_other_columns(fresh):
    fresh.release(NAMES_ALONE)
    (one,), _ = fresh.released.identified([Student("ada", "Ada Lovelace", sis_id="S1", login="ada")])
    assert one.id == "s1"


def test_another_name_for_an_id_is_said(fresh):
    fresh.release(NAMES_ALONE)
    kept, said = fresh.released.identified([Student("s1", "Bob Watt")])
    assert (kept[0].id, said) == ("s1", ("s1 was Ada Lovelace at the release, and is Bob Watt on the roster",))


@pytest.mark.parametrize(
    ("rows", "says"),
    [
        ([replace(X, canvas_id="101", sis_id="A2")], "X (x on the roster) is by Canvas's number s1, and by the SIS id"),
        ([replace(X, canvas_id="9", email="ada@x.org")], "is by the e-mail address s1 (Ada Lovelace), and by Canvas's"),
        ([replace(X, id="s1", canvas_id="9")], "is by the id s1 (Ada Lovelace), and by Canvas's number somebody else"),
        ([replace(X, canvas_id="101"), replace(X, id="y", login="ada")], "X (x) and X (y), and by tuning.released"),
        ([replace(X, canvas_id="101"), replace(X, id="S1", canvas_id="7")], "both are S1"),
    ],
)
def test_contradictions_are_a_sentence(course, rows, says):
    with pytest.raises(GradingError, match=re.escape(says)):
        course.released.identified(rows)


# Released again.


def test_a_mended_statement_waits_for_its_word(course):
    before = course.bytes()
    course.mend("It is {K} and {T}.", "The gain is {K}, the time {T}.")
    late = [*CLASS, Student("s4", "Late Comer")]
    with pytest.raises(GradingError) as problem:
        course.release(late)
    assert str(problem.value) == (
        f"nothing is written: the notebooks of s1, s2 and s3 in {course.to} would be others in exercise 1: --replace "
        "puts them in place, with the numbers of the release, except where somebody has worked in one"
    )
    assert course.bytes() == before
    numbers = {one.id: course.released.numbers(one.id) for one in CLASS}
    course.mend(RANGE, 'K=between(20, 60, "K/%"), T')
    done = course.release(late, replace=True)
    assert (done.replaced, done.added) == (("s1", "s2", "s3"), ("s4",))
    assert {one.id: course.released.numbers(one.id) for one in CLASS} == numbers
    assert "The gain is" in (course.to / "s1" / "tuning.ipynb").read_text(encoding="utf-8")


def test_new_numbers_are_drawn_where_that_is_said_twice(course):
    course.mend(RANGE, 'K=between(20, 60, "K/%"), T')
    with pytest.raises(GradingError, match="expected --replace beside --new-numbers"):
        course.release(new_numbers=True)
    done = course.release(replace=True, new_numbers=True)
    assert (done.replaced, done.remarks) == (("s1", "s2", "s3"), ())
    assert course.values("s1") == course.assignment.question("s1", "1").values
    assert course.values("s1")["K"] >= 20


def _work(path, answer="Kp=2"):
    text = path.read_text(encoding="utf-8")
    path.write_text(text.replace("Kp=...", answer), encoding="utf-8")
    return path.read_bytes()


@pytest.mark.parametrize("new_numbers", [False, True])
def test_a_notebook_in_which_somebody_has_worked_stays(course, new_numbers):
    path = course.to / "s2" / "tuning.ipynb"
    work, numbers = _work(path), course.released.numbers("s2")
    assert course.release().kept == ("s1", "s2", "s3")  # it is of this release
    course.mend("It is {K} and {T}.", "The gain is {K}, the time {T}.")
    course.mend(RANGE, 'K=between(20, 60, "K/%"), T')
    with pytest.raises(GradingError, match="the notebooks of s1, s2 and s3 in"):
        course.release()
    done = course.release(replace=True, new_numbers=new_numbers)
    assert (done.replaced, done.worked_in) == (("s1", "s3"), ("s2",))
    assert path.read_bytes() == work
    assert course.released.numbers("s2") == numbers
    assert (course.values("s1")["K"] >= 20) == new_numbers


def test_without_its_record_a_release_is_not_replaced_by_other_numbers(course):
    _work(course.to / "s2" / "tuning.ipynb")
    before = {path: content for path, content in course.bytes().items() if path != course.record}
    course.record.unlink()
    assert course.release().kept == ("s1", "s2", "s3")  # nothing has changed: the record is made again
    course.record.unlink()
    course.mend(RANGE, 'K=between(20, 60, "K/%"), T')
    for options in ({}, {"replace": True}):
        with pytest.raises(GradingError, match=r"tuning\.ipynb is in the way and no notebook of this release"):
            course.release(**options)
        with pytest.raises(GradingError, match="other numbers than those that are drawn today, and no record says"):
            course.release([ADA, EVE], **options)
    assert not course.record.exists()
    assert {path: path.read_bytes() for path in before} == before
    assert course.release([ADA, EVE], replace=True, new_numbers=True).replaced == ("s1", "s3")


def test_another_version_is_no_reason_to_replace(course, monkeypatch):
    _work(course.to / "s2" / "tuning.ipynb")
    before = course.bytes()
    newer = replace(installed(), version="9.9")
    monkeypatch.setattr("exercisegrader.release.installed", lambda: newer)
    assert course.release().kept == ("s1", "s2", "s3")
    assert course.bytes() == before
    assert b" 9.9." in course.release([*CLASS, Student("s4", "Late")]).paths[-1].read_bytes()


def test_an_exercise_that_is_added_later_needs_a_word(course):
    numbers = course.released.numbers("s1")
    more = ONE.format('"3"', 1, "y=x").replace("first", "third")
    course.write(course.path.read_text(encoding="utf-8") + more)
    with pytest.raises(GradingError, match="would be others in exercise 3: --replace"):
        course.release()
    assert course.release(replace=True).replaced == ("s1", "s2", "s3")
    found = course.released.numbers("s1")
    assert found.pop("3")
    assert found == numbers


# The command.


def run(course, *options):
    return CliRunner().invoke(app, ["release", str(course.path), "--to", str(course.to), *options])


def test_the_command_says_what_it_did(fresh):
    roster = fresh.path.with_name("roster.csv")
    roster.write_text("id,name\ns1,Ada\ns2,Bob\n", encoding="utf-8")
    first = run(fresh).output.splitlines()
    assert first[0] == f"2 notebooks of 'Tuning $K$' in {fresh.to}: 2 new"
    assert first[1] == f"{fresh.record} has their numbers: keep it with the assignment, grade needs it"
    roster.write_text("id,name\ns1,Ada\ns2,Bob\ns3,Eve\n", encoding="utf-8")
    assert run(fresh).output.splitlines()[0].endswith(": 1 new, 2 unchanged")
    _work(fresh.to / "s2" / "tuning.ipynb")
    fresh.mend("It is {K} and {T}.", "The gain is {K}, the time {T}.")
    refused = run(fresh)
    assert (refused.exit_code, refused.output.count("\n")) == (1, 1)
    assert "--replace puts them in place" in refused.output
    said = run(fresh, "--replace").output
    assert ": 2 replaced\n" in said
    assert f"{fresh.to / 's2'}: somebody has worked in this notebook; it stays, without what was mended\n" in said


# What notebooks say themselves.


def test_the_imprint_of_a_notebook(course):
    (path, *_) = course.release().paths
    content = path.read_bytes()
    imprint = peek(content)
    assert imprint == Imprint.of(nbformat.read(path, as_version=4).metadata)
    assert (imprint.assignment, imprint.student) == ("tuning", "s1")
    assert peek(json.dumps(json.loads(content), indent=None).encode()) == imprint
    moved = {"metadata": json.loads(content)["metadata"], **json.loads(content)}
    moved["cells"][1]["source"] = '"loopbook": {"assignment": "tuning", "student": "s9"}'
    assert peek(json.dumps(moved).encode()) == imprint
    assert peek(b"") is None
    for other in ({}, {"loopbook": 1}, {"loopbook": {"student": 1, "assignment": "a"}}):
        assert peek(json.dumps({"metadata": other}).encode()) is None


def proofs_in(course, student, numbers=None):
    return peek(as_text(notebook(course.assignment, student, numbers)).encode()).numbers


def test_the_proof_of_the_numbers_needs_the_secret(course):
    one = proofs_in(course, ADA)
    course.mend("a secret of many letters", "another secret of letters")
    numbers = {"1": {"K": "5/2", "T": "20"}, "2": {"K": "3", "action": "'heating'"}}
    others = [proofs_in(course, student, numbers) for student in (ADA, BOB)]
    course.mend("another secret of letters", "a secret of many letters")
    proofs = [proof for found in (one, *others, proofs_in(course, ADA, numbers)) for proof in found.values()]
    assert len(set(proofs)) == len(proofs)


def test_what_speaks_against_a_notebook(course):
    released, assignment = course.released, course.assignment
    imprint = peek((course.to / "s1" / "tuning.ipynb").read_bytes())
    assert released.doubts(assignment, "s1", imprint) == ()
    assert released.doubts(assignment, "s1", None) == ()
    assert released.doubts(assignment, "s2", imprint) == ("it was released to another student: s1",)
    other = replace(imprint, assignment="heater")
    assert released.doubts(assignment, "s1", other) == ("it was released for the assignment heater",)
    other = replace(imprint, numbers={**imprint.numbers, "1": "0"})
    assert released.doubts(assignment, "s1", other) == ("it was released with other numbers in exercise 1",)
    assert Released("tuning").doubts(assignment, "s1", other) == ("it was released with other numbers in exercise 1",)


def _class(size):
    return tuple(Student(f"s{number}", f"Student {number}") for number in range(size))


def _handed_in(course, students, others, folder):
    """The submissions of a class, of which each has the notebook of the one beside in another class."""
    for student, other in zip(students, others, strict=True):
        (folder / student.id).mkdir(parents=True)
        content = (course.to / other.id / "tuning.ipynb").read_bytes()
        (folder / student.id / "tuning.ipynb").write_bytes(content)
    return collect(folder, students, "tuning").submissions


@pytest.mark.parametrize(("size", "wrong", "stops"), [(8, 8, True), (8, 5, True), (8, 4, False), (2, FEW - 1, False)])
def test_most_notebooks_of_others_are_not_graded(fresh, tmp_path, size, wrong, stops):
    students = _class(size)
    fresh.release(students)
    others = [students[(k + 1) % size] if k < wrong else students[k] for k in range(size)]
    found = _handed_in(fresh, students, others, tmp_path / "in")
    if not stops:
        fresh.released.demand_fitting(fresh.assignment, found)
        return
    with pytest.raises(GradingError, match=rf"^{wrong} of {size} notebooks are not those") as problem:
        fresh.released.demand_fitting(fresh.assignment, found)
    assert ": it was released to another student: s" in str(problem.value)
    assert str(problem.value).endswith(": this one gives other ids, or is of another class")


def test_most_notebooks_of_another_release_are_not_graded(fresh, tmp_path):
    students = _class(5)
    fresh.release(students)
    found = _handed_in(fresh, students, students, tmp_path / "in")
    fresh.record.unlink()
    fresh.released.demand_fitting(fresh.assignment, found)
    fresh.mend(RANGE, 'K=between(20, 60, "K/%"), T')
    with pytest.raises(GradingError, match=r"other numbers in exercise 1. Put tuning.released.json of their release"):
        fresh.released.demand_fitting(fresh.assignment, found)
