"""Marks by hand: the table that an instructor keeps, its history, and what results count with them."""

import datetime
import multiprocessing
import os
import re
import signal
import time

import pytest

from drawings import picture
from exercisebook import png
from exercisebook.judging import MISTAKE, OPEN, RIGHT, WAITING, WRONG
from exercisegrader import GradingError, tables
from exercisegrader.assignment import Assignment
from exercisegrader.lateness import Lateness
from exercisegrader.marking import Marked, Marking, Notice
from exercisegrader.overrides import HISTORY, Mark, code
from exercisegrader.reports.outputs import Grades
from exercisegrader.reports.outputs.to_mark import to_mark
from exercisegrader.results import JudgedAnswer, JudgedExercise, Result
from exercisegrader.student import Student, parts
from exercisegrader.submissions import Submission
from whole_pages import Checker

SOURCE = '''"""Responses"""
from exercisebook.authoring import *

SECRET = "a secret of many letters"


@exercise("1", title="A lag", points=6, weights={"T": 2})
def lag(T=between(15, 40, "s")):
    """It is {T}."""
    return answers(T=number(2 * T, "s"), sketch=figure("the response"), why=text("why", key="one lag"))


@exercise("2", title="Gain", points=2)
def gain(K=between(2, 6, "K/%")):
    """It is {K}."""
    return answers(K=number(K, "K/%"), y=number(2 * K), z=number(3 * K))
'''
ASSIGNMENT = Assignment.of(SOURCE, "responses")
CLASS = [Student(f"s{k}", name, section=name[:1]) for k, name in enumerate(["Ada", "Ben", "Bo"], start=1)]
CODES = {one.id: code(ASSIGNMENT.secret, one.id) for one in CLASS}
PICTURE = png.as_data(picture())
#: Where a mark by hand may be.
T, SKETCH, WHY, Y = ("1", "T"), ("1", "sketch"), ("1", "why"), ("2", "y")
FIRST, SECOND, ALL = ("1", ""), ("2", ""), ("", "")


def result(student, T=RIGHT, sketch=WAITING, why=WAITING, K=RIGHT, status="complete", picture=PICTURE):
    one = (
        JudgedAnswer("T", T, T, 60, "60 s", 2),
        JudgedAnswer("sketch", sketch, "a person marks this", picture if sketch == WAITING else None, ""),
        JudgedAnswer("why", why, "a person marks this", "late\n\n<b>" if why == WAITING else None, "one lag"),
    )
    other = tuple(JudgedAnswer(name, K, K, 3, "3 K/%") for name in ("K", "y", "z"))
    exercises = (
        JudgedExercise("1", "A lag", 6, "**Exercise 1 · A lag** (6 points)\n\nIt is 30 s.", (("T", "30 s"),), one),
        JudgedExercise("2", "Gain", 2, "It is 3.", (), other),
    )
    return Result("responses", student, "f.ipynb", True, "", status, "", (), (), exercises)


class Folder:
    """A folder of grades, in which one run after another marks."""

    def __init__(self, path):
        self.path, self.marks, self.history = path, path / "marks.csv", path / "marks_history.csv"

    def run(self, *results, before=()):
        """One run: what is there, `before`, is graded again."""
        marking = Marking(self.path, ASSIGNMENT, CLASS)
        marking.read({one.student: one for one in before}.get)
        marking.read({one.student: one for one in results}.get)
        self.marked = {one.result.student: one for one in marking.marked(results, {})}
        self.notes = marking.notes(list(self.marked.values()))
        return self.marked

    def table(self, part):
        return self.path / "to_mark" / f"{part}.csv"

    def write(self, *rows, head="student,exercise,quantity,points,comment", file="marks.csv"):
        saved = self.path / "saved"  # as programs do: the new file takes the place of the old one
        saved.write_bytes("".join(f"{row}\r\n" for row in (head, *rows)).encode())
        (self.path / file).parent.mkdir(exist_ok=True)
        saved.replace(self.path / file)

    def faults(self, *rows, **given):
        self.write(*rows, **given)
        with pytest.raises(GradingError) as problem:
            self.run(result("s1"))
        return str(problem.value).splitlines()

    def changes(self):
        """What the history holds: places, from and to."""
        rows = [row for _, row in tables.read_sheet(self.history, HISTORY).rows]
        return [tuple(row[name] for name in ("student", "exercise", "quantity", "from", "to")) for row in rows]


@pytest.fixture
def folder(tmp_path):
    return Folder(tmp_path)


# What a result counts.


def test_a_result_waits_until_a_person_has_marked_all_of_it():
    found = Marked.of(result("s1"))
    assert (found.total, found.waiting) == (None, (SKETCH, WHY))
    assert [one.earned for one in found.exercises] == [None, 2]
    found = Marked.of(result("s1"), {SKETCH: Mark(1)})
    assert (found.total, found.waiting) == (None, (WHY,))
    found = Marked.of(result("s1"), {SKETCH: Mark(1, "no units"), WHY: Mark(1.5)})
    assert (found.total, found.waiting) == (pytest.approx(3 + 1 + 1.5 + 2), ())
    assert found.exercises[0].history == (
        'sketch: 1 of 1.5 points by hand: "no units"', "why: 1.5 of 1.5 points by hand",
    )  # fmt: skip


def test_what_was_not_answered_does_not_wait():
    found = Marked.of(result("s1", sketch=OPEN, why=OPEN))
    assert (found.total, found.waiting) == (5, ())


def test_a_person_may_overrule_the_grader():
    of = result("s1", T=WRONG, sketch=OPEN, why=OPEN, K=MISTAKE)
    assert Marked.of(of).total == 0
    found = Marked.of(of, {T: Mark(2.5, "a slip"), Y: Mark(0, "no")})
    assert found.total == 2.5
    assert found.exercises[0].history == ('T: 0 by the grader, 2.5 of 3 points by hand: "a slip"',)
    assert found.exercises[1].history == ('y: 0 by the grader, 0 of 0.67 points by hand: "no"',)


def test_the_mark_of_a_whole_exercise_counts_more_than_those_in_it():
    found = Marked.of(result("s1"), {T: Mark(1), FIRST: Mark(5, "well done")})
    assert (found.total, found.waiting) == (7, ())
    assert found.exercises[0].history[-1] == '3 of 6 points by the grader, 5 by hand: "well done"'
    assert found.exercises[0].is_by_hand


def test_the_mark_of_the_whole_notebook_stands_as_it_is():
    found = Marked.of(result("s1"), {ALL: Mark(4, "ill")}, Lateness(0.5, "2 days late"))
    assert (found.total, found.waiting, found.deduction) == (4, (), 0)
    assert found.comments == ('5 of 8 points before, 4 by hand for all of it: "ill"',)
    assert found.late == "2 days late; the points by hand for all of it stay as they are"


def test_comments_alone_change_nothing():
    comments = {T: Mark(None, "see me"), FIRST: Mark(None, "nice"), ALL: Mark(None, "hm")}
    found = Marked.of(result("s1", sketch=OPEN), comments)
    assert (found.total, found.comments) == (None, ("hm",))
    assert found.exercises[0].comments == ("T: see me", "nice")


@pytest.mark.parametrize("status", ["missing", "not run"])
def test_what_is_not_there_is_an_empty_cell_until_a_person_says_otherwise(status):
    of = result("s1", T=OPEN, sketch=OPEN, why=OPEN, K=OPEN, status=status)
    assert Marked.of(of).total is None
    assert Marked.of(of, {FIRST: Mark(3)}).total is None
    assert Marked.of(of, {FIRST: Mark(3), SECOND: Mark(1)}).total == 4
    assert Marked.of(of, {ALL: Mark(0)}).total == 0


def test_what_is_late_costs_a_part_of_what_was_earned_by_hand_too():
    of = result("s1", sketch=OPEN)
    found = Marked.of(of, {WHY: Mark(1)}, Lateness(0.1, "late"))
    assert (found.deduction, found.total, found.late) == (pytest.approx(0.6), pytest.approx(5.4), "late")
    assert Marked.of(of, {WHY: Mark(1)}, Lateness(1, "late")).total == 0
    by_how_much = Lateness(0, "late", "by how much?")
    assert Marked.of(of, lateness=by_how_much).looks == (Notice(5, "by how much?"),)
    assert not Marked.of(of, {ALL: Mark(3)}, by_how_much).looks


# The table.


def test_a_row_is_added_for_each_answer_that_waits_in_the_table_of_the_section(folder):
    folder.run(result("s1"), result("s2", why=OPEN), result("s3", sketch=OPEN, why=OPEN))
    head = "\ufeffstudent,exercise,quantity,points,comment"
    assert folder.marks.read_bytes().decode() == f"{head}\r\n"
    assert folder.table("A").read_bytes().decode().split("\r\n") == [
        head, f"{CODES['s1']},1,sketch,,", f"{CODES['s1']},1,why,,", "",
    ]  # fmt: skip
    before = folder.table("B").read_bytes()
    assert before.decode().split("\r\n") == [head, f"{CODES['s2']},1,sketch,,", ""]
    folder.run(result("s1"), result("s2"), result("s3", sketch=OPEN, why=OPEN))
    assert folder.table("B").read_bytes() == before + f"{CODES['s2']},1,why,,\r\n".encode()
    assert not folder.history.exists()
    (note,) = folder.notes
    assert note.startswith("4 answers to be marked: the folder to_mark has a page")


def test_whose_answers_they_are_is_not_to_be_seen_by_their_order(folder):
    folder.run(*(result(one.id) for one in CLASS))
    rows = [line.partition(",")[0] for line in folder.table("B").read_text().splitlines()[1:]]
    assert rows == 2 * sorted([CODES["s2"], CODES["s3"]])
    others = {code("another secret of many letters", one.id) for one in CLASS}
    assert len({*CODES.values(), *others}) == 2 * len(CLASS)


def test_who_moves_to_another_section_waits_there(folder):
    folder.write(f"{CODES['s2']},1,sketch,,", file="to_mark/A.csv")
    folder.run(result("s2", why=OPEN))
    assert folder.table("B").read_text().count(CODES["s2"]) == 1


@pytest.mark.parametrize(
    ("sections", "found"),
    [(["", ""], ["all", "all"]), (["Mon 9:00", ""], ["Mon_9_00", "others"]), (["../x", "Ä/B"], ["x", "Ä_B"])],
)
def test_each_section_has_files_of_its_own(sections, found):
    assert [*parts([Student(f"s{k}", "", section=one) for k, one in enumerate(sections)]).values()] == found


def test_marks_come_back_by_their_codes_in_any_table_of_the_folder(folder):
    folder.run(result("s1"), result("s2"))
    folder.write(f"{CODES['s1']},1,sketch,1,units", file="to_mark/A (1).csv")  # as a browser names what comes twice
    folder.write(f"{CODES['s2'].upper()},1,why,0.5,", f"{CODES['s2']},1,sketch,,short", file="to_mark/B.csv")
    found = folder.run(result("s1"), result("s2"))
    assert found["s1"].exercises[0].history == ('sketch: 1 of 1.5 points by hand: "units"',)
    assert found["s2"].exercises[0].history == ("why: 0.5 of 1.5 points by hand",)
    assert found["s2"].exercises[0].comments == ("sketch: short",)
    assert folder.changes() == [
        ("s1", "1", "sketch", "", "1"),
        ("s2", "1", "why", "", "0.5"),
        ("s2", "1", "sketch", "", ""),
    ]


def test_what_the_instructor_says_counts_more_than_a_table_of_a_section(folder):
    folder.write(f"{CODES['s1']},1,sketch,1,units", f"{CODES['s1']},1,why,1,", file="to_mark/A.csv")
    folder.write("s1,1,sketch,1.5,yes", "s1,1,why,,well")
    history = folder.run(result("s1"))["s1"].exercises[0].history
    assert history == ('sketch: 1.5 of 1.5 points by hand: "yes"', 'why: 1 of 1.5 points by hand: "well"')


def test_two_tables_that_say_different_points_are_told(folder):
    folder.write(f"{CODES['s1']},1,sketch,1,", file="to_mark/A.csv")
    says = (
        "to_mark/B.csv, line 2: exercise 1, sketch: the points are 0.5, and to_mark/A.csv says 1: expected one of them"
    )
    folder.write("s1,1,T,8,")
    assert folder.faults(f"{CODES['s1']},1,sketch,0.5,", file="to_mark/B.csv") == [
        says, "marks.csv, line 2: the points are 8: expected 0 to 3 for exercise 1, T",
    ]  # fmt: skip
    folder.write()
    folder.write("s1,1,sketch,1,", file="to_mark/B.csv")
    assert folder.run(result("s1"))["s1"].waiting == (WHY,)


@pytest.mark.parametrize("ending", ["\r\n", "\n"])
@pytest.mark.parametrize("mark", ["", "\ufeff"])
@pytest.mark.parametrize("delimiter", [",", ";", "\t"])
@pytest.mark.parametrize("is_whole", [True, False])
def test_what_a_spreadsheet_left_stays_byte_for_byte(folder, delimiter, mark, ending, is_whole):
    quoted = {",": ('"1,5"', '"so, so ü"'), ";": ("1,5", "so, so ü"), "\t": ("1,5", "so; so ü")}[delimiter]
    head = ["Mine", "Student", "Exercise", "Quantity", "Points", "Comment"]
    rows = [head, ["x", "S1", "1", "sketch", *quoted], [""] * 6, ["", "s1", "", "", "", "nice"]]
    table = mark + ending.join(map(delimiter.join, rows)) + (ending if is_whole else "")
    folder.table("A").parent.mkdir()
    folder.table("A").write_bytes(table.encode())
    found = folder.run(result("s1"))["s1"]
    assert found.exercises[0].history[0].startswith("sketch: 1.5 of 1.5 points by hand")
    assert found.comments == ("nice",)
    added = delimiter.join(["", CODES["s1"], "1", "why", "", ""])
    assert folder.table("A").read_bytes() == (table + ("" if is_whole else ending) + added + ending).encode()


def test_of_several_rows_for_a_place_the_last_counts(folder):
    folder.write("s1,1,sketch,1,first", "s1,1,why,1,", "S1,1,sketch,0.5,second")
    found = folder.run(result("s1"))["s1"]
    assert found.exercises[0].history[0] == 'sketch: 0.5 of 1.5 points by hand: "second"'
    folder.write("s1,1,sketch,1,first", "s1,1,sketch,,")
    assert folder.run(result("s1"))["s1"].waiting == (("1", "sketch"), ("1", "why"))


def test_all_faults_are_told_at_once(folder):
    rows = [
        "s1,1,sketch,2,", "s9,1,sketch,1,", "s1,3,,1,", "s1,1,skech,1,", "s1,1,T,two,", "s1,,T,1,", "s1,2,,-1,",
        "s1,,,9,", "s1,1,sketch,1.504,", ",1,,1,", "s1,2,y,nan,",
    ]  # fmt: skip
    assert len(folder.faults(*rows * 10)) == tables.MOST_FAULTS + 1
    assert folder.faults(*rows) == [
        "marks.csv, line 2: the points are 2: expected 0 to 1.5 for exercise 1, sketch",
        "marks.csv, line 3: there is no student 's9' on the roster: expected an id",
        "marks.csv, line 4: there is no exercise '3': expected one of 1, 2",
        "marks.csv, line 5: exercise 1 asks for no 'skech': did you mean 'sketch'?",
        "marks.csv, line 6: the points are 'two': expected a number, or nothing",
        "marks.csv, line 7: the quantity 'T' has no exercise: expected its number",
        "marks.csv, line 8: the points are -1: expected 0 to 2 for exercise 2",
        "marks.csv, line 9: the points are 9: expected 0 to 8 for the whole notebook",
        "marks.csv, line 11: there is no student '' on the roster: expected an id",
        "marks.csv, line 12: the points are 'nan': expected a number, or nothing",
    ]


@pytest.mark.parametrize(
    ("head", "says"),
    [
        ("student,exercise,quantity,point", "there is no column 'points' ('point' is none): expected the columns"),
        ("a table of something", "there is no column 'student'"),
        ("student,exercise,quantity,points,points", "there are 2 columns 'points': expected one"),
    ],
)
def test_a_table_without_its_columns_is_refused(folder, head, says):
    assert says in folder.faults("s1,1,T,1", head=head)[0]


def test_an_id_of_the_roster_stands_for_the_one_that_was_released(folder):
    folder.write("A17,1,sketch,1,", "s1,1,why,1,")
    marking = Marking(folder.path, ASSIGNMENT, CLASS, also={"a17": "s1", "s1": "s1"})
    marking.read({"s1": result("s1")}.get)
    assert not marking.marked([result("s1")], {})[0].waiting


def test_who_has_left_the_class_stops_nobody(folder):
    folder.write("s1,1,sketch,1,", f"{CODES['s2']},1,sketch,1,")
    folder.run(result("s1"), result("s2"))
    (folder.path / "results").mkdir()
    (folder.path / "results" / "s2.json").touch()
    marking = Marking(folder.path, ASSIGNMENT, CLASS[:1])
    marking.read({"s1": result("s1")}.get)
    marks = marking.marked([result("s1")], {})
    assert "There are marks of s2, no longer on the roster: they stay where they are." in marking.notes(marks)
    assert len(folder.changes()) == 2
    assert folder.run(result("s1"), result("s2"))["s2"].waiting == (("1", "why"),)


def test_a_file_that_is_saved_meanwhile_is_not_touched(folder):
    folder.write("s1,1,sketch,1,", file="to_mark/A.csv")
    marking = Marking(folder.path, ASSIGNMENT, CLASS)
    marking.read({"s1": result("s1")}.get)
    folder.write("s1,1,sketch,0.5,", file="to_mark/A.csv")
    saved = folder.table("A").read_bytes()
    marking.marked([result("s1")], {})
    assert folder.table("A").read_bytes() == saved
    assert folder.run(result("s1"))["s1"].exercises[0].history[0].startswith("sketch: 0.5")


# The history.


def test_each_change_is_noted_once(folder):
    folder.write("s1,1,sketch,1,units?", "s2,2,,1,")
    folder.run(result("s1"), result("s2"))
    assert folder.changes() == [("s1", "1", "sketch", "", "1"), ("s2", "2", "", "", "1")]
    os.utime(folder.marks, (0, 0))
    before = folder.history.read_bytes()
    folder.run(result("s1"), result("s2"))
    assert folder.history.read_bytes() == before
    folder.write("s1,1,sketch,1.5,units?", "s2,2,,1,")
    os.utime(folder.marks, (1_800_000_000, 1_800_000_000))
    folder.run(result("s1"), result("s2"))
    text = folder.history.read_bytes()
    assert text.startswith(before)
    assert text[len(before) :].startswith(b"2027-01-15T08:00:00Z,s1,1,sketch,1,1.5,units?,to be marked,")
    folder.write("s2,2,,1,yes")
    folder.run(result("s1"), result("s2"))
    assert folder.changes()[3:] == [("s1", "1", "sketch", "1.5", ""), ("s2", "2", "", "1", "1")]
    assert "1 mark by hand withdrawn since the last time." in folder.notes


def test_a_mark_for_a_student_without_a_result_is_noted_later(folder):
    folder.write("s1,1,sketch,1,")
    folder.run(result("s2"))
    assert not folder.history.exists()
    folder.run(result("s1"), result("s2"))
    assert folder.changes() == [("s1", "1", "sketch", "", "1")]


@pytest.mark.parametrize("file", ["marks.csv", "to_mark/A.csv"])
def test_a_table_that_is_gone_is_asked_for(folder, file):
    folder.write("s1,1,sketch,1,", file=file)
    folder.run(result("s1"))
    (folder.path / file).unlink()
    with pytest.raises(GradingError, match=rf"{file} is gone, and marks_history\.csv knows 1 row of it"):
        folder.run(result("s1"))
    folder.history.unlink()
    assert folder.run(result("s1"))["s1"].waiting


def test_another_verdict_for_what_is_marked_by_hand_is_told(folder):
    was = result("s1", T=WRONG)
    folder.write("s1,1,T,2,", "s1,1,sketch,1,", "s1,2,,1,", "s1,,,7,")
    assert not folder.run(was)["s1"].looks
    is_now = result("s1", K=WRONG)
    assert not folder.run(was, before=[was])["s1"].looks
    found = folder.run(is_now, before=[was])["s1"]
    assert [(one.points, one.says) for one in found.looks] == [
        (3, "exercise 1, T: marked by hand with 2 when the grader said 'wrong'; now it says 'right'"),
        (2, "exercise 2: marked by hand with 1 when the grader said '2 of 2'; now it says '0 of 2'"),
        (8, "the whole notebook: marked by hand with 7 when the grader said '2 of 8'; now it says '3 of 8'"),
    ]
    assert folder.run(is_now, before=[is_now])["s1"].looks == found.looks
    folder.write("s1,1,T,2,seen", "s1,1,sketch,1,", "s1,2,,1,seen", "s1,,,7,seen")
    assert not folder.run(is_now, before=[is_now])["s1"].looks


def test_another_answer_to_what_is_marked_by_hand_is_told(folder):
    was = result("s1")
    folder.run(was)
    folder.write("s1,1,sketch,1,", "s1,1,why,1,")
    other = result("s1", picture=png.as_data(picture(9, 9)))
    found = folder.run(other, before=[was])["s1"]  # marked before it was graded again
    (look,) = found.looks
    assert look.says == "exercise 1, sketch: marked by hand with 1, and the answer has changed since"


# In the reports.


def test_a_marker_sees_all_answers_of_a_section_to_a_question_and_not_whose_they_are(folder):
    marks = list(folder.run(*(result(one.id, why=OPEN if one.id == "s2" else WAITING) for one in CLASS)).values())
    grades = Grades("Responses", CLASS, marks)
    page = to_mark(grades, "B")
    text = Checker(page).text
    assert "<title>Responses: to be marked, B</title>" in page
    assert page.count(f'src="data:image/png;base64,{PICTURE["png"]}"') == 2
    assert "<b>" not in page
    both = sorted([CODES["s2"], CODES["s3"]])
    assert [Checker(heading).text for heading in re.findall(r"<h\d>.*</h\d>", page)] == [
        "Responses: to be marked, B", "Exercise 1 · A lag · sketch", *both, "Exercise 1 · A lag · why", CODES["s3"],
    ]  # fmt: skip
    assert "To look for: one lag" in text
    assert "each worth at most\n1.5 of 6 points" in text
    assert not [one for one in CLASS if one.name in text or one.id in re.findall(r"\w+", text)]
    folder.write(f"{CODES['s1']},1,sketch,1,units", f"{CODES['s1']},1,why,0,", file="to_mark/A.csv")
    marks = list(folder.run(result("s1"), result("s2")).values())
    assert "0 answers to 0 questions." in to_mark(Grades("Responses", CLASS, marks), "A")


# What is late.


def handed_in(student, at, late=None):
    return Submission(student, f"{student.id}.ipynb", "", at, late)


def test_submissions_are_late_by_the_roster_or_by_their_names(tmp_path):
    due = 'DUE = "2026-12-01 23:59 Europe/Berlin"\nLATE = Late(percent=10, per="day")\n'
    marking = Marking(tmp_path, Assignment.of(SOURCE + due, "responses"), CLASS)
    late = datetime.datetime(2026, 12, 2, 12, 0)
    handed = (handed_in(CLASS[0], late), handed_in(CLASS[1], None, True), handed_in(CLASS[2], None))
    submissions = {one.student.id: one for one in handed}
    results = [result(student.id, sketch=OPEN, why=OPEN) for student in CLASS]
    marking.read({one.student: one for one in results}.get)
    marks = marking.marked(results, submissions)
    assert [mark.total for mark in marks] == [pytest.approx(4.5), 5, 5]
    assert [len(mark.looks) for mark in marks] == [0, 1, 0]
    assert marking.notes(marks) == [
        "Due 2026-12-01 23:59 Europe/Berlin; late: 10 % a day. 2 submissions came late.",
        "Of 1 submission nothing says when it was handed in: it counts as in time. A column handed_in in the roster "
        "says it.",
    ]


# Interrupted.


def run_forever(path):
    folder = Folder(path)
    while True:
        folder.run(result("s1"), result("s2"), result("s3"))


def test_a_run_that_is_killed_loses_nothing(folder):
    """Killed at 30 moments, while rows are added below and marks are changed above."""
    processes = multiprocessing.get_context("fork")
    for k in range(30):
        row = f"s1,1,sketch,{(k % 10 + 1) / 10},round {k}"
        folder.write(row, "s2,1,T,3,kept")
        process = processes.Process(target=run_forever, args=(folder.path,))
        process.start()
        time.sleep(0.002 * (k % 10))
        process.kill()
        process.join()
        assert process.exitcode == -signal.SIGKILL
        rows = folder.marks.read_bytes().decode().splitlines()
        assert rows[1:3] == [row, "s2,1,T,3,kept"]
        found = folder.run(result("s1"), result("s2"), result("s3"))
        assert f'"round {k}"' in found["s1"].exercises[0].history[0]
        assert ("s1", "1", "sketch") in [one[:3] for one in folder.changes()[-2:]]
        assert folder.marks.read_bytes().decode().splitlines() == rows
        for part, count in {"A": 1, "B": 4}.items():
            waiting = folder.table(part).read_bytes().decode().splitlines()
            assert len(waiting) == len(set(waiting)) == 1 + count
    assert len(folder.changes()) == 31
