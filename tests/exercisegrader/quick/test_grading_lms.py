"""Learning management systems: rosters, names in downloads, grades and feedback in their forms, notebooks for them."""

import csv
import datetime
import io
import json
import pickle
import re
import string
import zipfile
from dataclasses import replace
from pathlib import Path

import pytest
from hypothesis import given
from hypothesis import strategies as st
from markdown_it import MarkdownIt
from typer.testing import CliRunner

import contributing
from exercisegrader import GradingError, lms, reports, tables
from exercisegrader.__main__ import app
from exercisegrader.lms import Known, own
from exercisegrader.lms.canvas import canvas_grades
from exercisegrader.lms.gradescope import results_json
from exercisegrader.lms.moodle import moodle_grades
from exercisegrader.lms.own import grades_csv
from exercisegrader.marking import Marked, MarkedExercise
from exercisegrader.reports.outputs import Grades
from exercisegrader.results import JudgedAnswer, JudgedExercise, Result
from exercisegrader.roster import POSSIBLE_ID, moment, read_roster
from exercisegrader.student import Student
from rosters import ANNE, CLASS, JANE, JOHN, attempted
from small_class import HOSTILE


@pytest.fixture
def roster(tmp_path):
    """Writes a roster and reads it."""

    def read(content, encoding="utf-8"):
        path = tmp_path / "roster.csv"
        path.write_bytes(content if isinstance(content, bytes) else content.encode(encoding))
        return read_roster(path)

    return read


# Rosters of one's own.


HANDED_IN = datetime.datetime(2025, 11, 3, 23, 59)


@pytest.mark.parametrize("encoding", ["utf-8", "utf-8-sig"])
@pytest.mark.parametrize("delimiter", [",", ";", "\t"])
def test_our_own_roster(roster, delimiter, encoding):
    lines = ["Name,ID,e-mail,canvas_id,Sortable", '"Zoë  Ünal",s2,z@x.org,7,', "", '"O\'Brien",s1,,,O Brien']
    students = roster("\r\n".join(lines).replace(",", delimiter), encoding)
    assert students == (
        Student("s2", "Zoë Ünal", email="z@x.org", canvas_id="7"),
        Student("s1", "O'Brien", sortable="O Brien"),
    )
    assert pickle.loads(pickle.dumps(students)) == students
    assert lms.remarks(students) == ()


@pytest.mark.parametrize(
    ("header", "row", "student"),
    [
        ("Student ID,Full Name,E-mail", "s1,Jane Doe,j@x", Student("s1", "Jane Doe", email="j@x")),
        ("First name;Name;Student no.", "Jane;Doe;s1", Student("s1", "Jane Doe", "Doe, Jane")),
        ("STUDENT_NUMBER\tlast_name\tFirst Name", "s1\tDoe\tJane", Student("s1", "Jane Doe", "Doe, Jane")),
        ("student-id,student,Group,NetID", "s1,Jane Doe,A,jd", Student("s1", "Jane Doe", login="jd", section="A")),
        ("id;name;handed in at", "s1;Jane, Doe;2025-11-03 23:59", Student("s1", "Jane, Doe", handed_in=HANDED_IN)),
        # Moodle's heads, and an id of one's own
        ("Student ID,First name,Last name", "s1,Jane,Doe", Student("s1", "Jane Doe", "Doe, Jane")),
    ],
)
def test_the_heads_of_others(roster, header, row, student):
    assert roster(f"{header}\n{row}\n") == (student,)


def test_no_word_is_a_synonym_of_two_fields():
    fields = {}
    for field, listed in own.SYNONYMS.items():
        for word in listed.split(", "):
            assert tables.letters(word)
            assert fields.setdefault(tables.letters(word), field) == field
    assert {"id", "name", "email", "login", "section", "sis_id", "canvas_id", "moodle_id"} <= own.SYNONYMS.keys()


def test_the_instructors_guide_has_all_synonyms():
    guide = (Path(__file__).parents[3] / "docs" / "instructors.md").read_text(encoding="utf-8")
    for words in own.SYNONYMS.values():
        assert f"| {words} |" in guide


def test_two_columns_for_one_field_are_a_sentence(roster):
    with pytest.raises(GradingError) as raised:
        roster("ID,Student ID,Name\n1,s1,Jane\n")
    assert str(raised.value) == "roster.csv, line 1: 'ID' and 'Student ID' could both be the id: rename one of them"


# Rosters of Canvas.


CANVAS = """\
Student,ID,SIS User ID,SIS Login ID,Section,Heater (11),Current Score
,,,,,Manual Posting,
    Points Possible,,,,,10.00,(read only)
"Doe, Jane",123,A17,jane,"C1, C2",9.00,
"Roe, John, Jr.",124,{sis},john,C1,,
"Nguyễn, Thị, Anh",125,A19,{login},C1,EX,
"=""=1+1""\",126,A20,odd,C1,,
"Student, Test",999,,4f3c2a,C1,,
"""


@pytest.mark.parametrize(
    ("sis", "login", "ids"),
    [
        ("A18", "anh", ["A17", "A18", "A19", "A20"]),
        ("", "", ["A17", "john", "A19", "A20"]),
    ],
)
def test_the_gradebook_of_canvas(roster, sis, login, ids):
    students = roster(CANVAS.format(sis=sis, login=login))
    assert [student.id for student in students] == ids
    assert [student.name for student in students] == ["Jane Doe", "John Roe Jr.", "Thị Anh Nguyễn", "=1+1"]
    jane = Student(ids[0], "Jane Doe", "Doe, Jane", canvas_id="123", sis_id="A17", login="jane", section="C1, C2")
    assert students[0] == jane


def test_an_export_may_have_a_column_of_when_each_handed_in_which_is_not_sent_back(roster):
    students = roster(
        "Student,ID,SIS User ID,SIS Login ID,Section,Heater (11),Handed in\n"
        '"Doe, Jane",123,A17,jane,C1,,2025-11-03 23:59\n"Roe, John",124,A18,john,C1,,\n'
    )
    assert [student.handed_in for student in students] == [HANDED_IN, None]
    assert rows(canvas_grades(Grades("Heater", students, [])))[0][-1] == "Heater (11)"
    with pytest.raises(GradingError, match="line 2: 'yes' is no time"):
        roster('"First name","Last name","ID number","handed in"\nJane,Doe,s1,yes\n')


def test_a_guest_without_a_number_changes_nobody_elses_id_and_is_told(roster):
    rows = [f'"N{k}, Anna",{1000 + k},SIS{k},login{k},C1' for k in range(60)]
    header = "Student,ID,SIS User ID,SIS Login ID,Section\n"
    whole = roster("\n".join([header.strip(), *rows]))
    rows.insert(7, '"Guest, Gus",2000,,,C1')
    rows.insert(9, '"Auditor, Al",2001,,al,C1')
    with_guests = roster("\n".join([header.strip(), *rows]))
    ids = {student.canvas_id: student.id for student in with_guests}
    assert all(ids[student.canvas_id] == student.id for student in whole)
    assert (ids["2000"], ids["2001"]) == ("2000", "al")
    assert lms.remarks(whole) == ()
    assert lms.remarks(with_guests) == (
        "the ids of 60 students come from SIS User ID, and that of 1 from ID: 2000",
        "the ids of 60 students come from SIS User ID, and that of 1 from SIS Login ID: al",
    )


def test_a_student_who_is_called_test_student_takes_part(roster):
    header = "Student,ID,SIS User ID,SIS Login ID,Section\n"
    (tess,) = roster(header + '"Student, Test",1,A17,test,C\n"Student, Test",2,,4f3c2a,C\n')
    assert (tess.id, tess.name) == ("A17", "Test Student")


# Rosters of Moodle and Gradescope.


WORKSHEET = """\
Identifier,"Full name","ID number","Email address",Status,Grade,"Maximum grade","Grade can be changed",\
"Last modified (submission)","Last modified (grade)","Feedback comments"
"Participant 77001","Jane Doe",s1001,jane@x.org,"Submitted for grading",,17.00,Yes,\
"Monday, 3 November 2025, 11:59 PM",-,
"Participant 77002","John Roe",s1002,john@x.org,"No submission",3.00,17.00,Yes,-,"Tuesday, 4 November 2025, 9:05 AM",\
"<p>Good,
but late</p>"
"""


def test_the_grading_worksheet_of_moodle(roster):
    header = 'Identifier,"Full name","Email address",Status,Grade,"Maximum Grade","Last modified (grade)"\n'
    jane = '"Participant 77001","Jane Doe",jane@x.org,"No submission",,10.00,-\n'
    john = '"Participant 77002","John Roe",john@x.org,,,,\n'
    assert roster(header + jane + john) == (
        Student("77001", "Jane Doe", email="jane@x.org", moodle_id="77001"),
        Student("77002", "John Roe", email="john@x.org", moodle_id="77002"),
    )
    (anonymous,) = roster("Identifier,Status,Grade\nParticipant 77001,,\n")
    assert anonymous == Student("77001", "Participant 77001", moodle_id="77001")
    jane, john = roster(WORKSHEET)
    assert (jane.id, jane.handed_in) == ("s1001", HANDED_IN)
    assert (john.id, john.handed_in) == ("s1002", None)


def test_the_participants_and_grades_of_moodle(roster):
    (jane, john) = roster(
        '"First name",Surname,"ID number","Email address",Groups\nJane,Doe,,j@x.org,"A, B"\nJohn,,17,r@x.org,\n'
    )
    assert jane == Student("j@x.org", "Jane Doe", "Doe, Jane", email="j@x.org", section="A, B")
    assert john == Student("17", "John", "John", email="r@x.org", sis_id="17")
    assert lms.remarks((jane, john)) == (
        "the ids of 1 student come from Email address, and that of 1 from ID number: 17",
    )
    (jane,) = roster('"First name","Last name","ID number",Username,"Assignment: Heater (Real)"\nJane,Doe,,jane,9.0\n')
    assert jane == Student("jane", "Jane Doe", "Doe, Jane", login="jane")


def test_the_roster_of_gradescope(roster):
    jane, john = roster(
        "First Name,Last Name,SID,Email,Role,Sections\n"
        "Jane,Doe,s1001,jane@x.org,Student,A\nJohn,Roe,,john@x.org,Student,A\nAda,Byron,,ada@x.org,Instructor,\n"
    )
    assert jane == Student("s1001", "Jane Doe", "Doe, Jane", sis_id="s1001", section="A", email="jane@x.org")
    assert (john.id, john.id_from) == ("john@x.org", "Email")
    (jane,) = roster(
        "First Name,Last Name,SID,Email,Sections,Heater,Heater - Max Points,Submission Time,Lateness (H:M:S)\n"
        "Jane,Doe,s1001,jane@x.org,A,8,10,2025-11-03 23:59:30 -0700,00:00:00\n"
    )
    assert jane.handed_in == datetime.datetime(2025, 11, 3, 23, 59, 30)


# What is wrong with a roster.


@pytest.mark.parametrize(
    ("content", "says"),
    [
        ("", "line 1: no header of a roster"),
        ("Vorname,Nachname\na,b\n", "line 1: no header of a roster, 'Vorname' and 'Nachname'; expected the columns id"),
        ("id,name\n", "a header and no student"),
        ("Student,ID,Section\n    Points Possible,,\n", "a header and no student"),
        ("id,name\ns1,A\n\ns1,B\n", "line 4: the id 's1' is already that of line 2"),
        ("id,name\ns1,A\nS1,B\n", "line 3: the id 'S1' is already that of line 2"),
        ('id,name\ns1,"A\nB"\n,C\n', "line 4: a student without an id"),
        ("Student,ID,SIS User ID\nA,,\n", "line 2: a student without an id; ids come from the first full of: SIS"),
        ("id,name\nNul.a,A\n", "line 2: 'Nul.a' cannot be an id"),
        ("id,name\ns1.,A\n", "line 2: 's1.' cannot be an id"),
        ("id,name\n../x,A\n", "line 2: '../x' cannot be an id"),
        ("id,name\n2.3E+08,A\n", "line 2: '2.3E+08' cannot be an id"),
        (f"id,name\n{'x' * 101},A\n", "at most 100 characters"),
        ("id,name\nmüller,A\n", "line 2: 'müller' cannot be an id"),
        ("id,name\ns1,Doe, Jane\n", "line 2: there are 3 cells below 2 columns: put 'a,b' in quotes"),
        ("id,name,handed_in\ns1,A,03/11/2025\n", "line 2: '03/11/2025' is no time: expected one as 2025-11-03 23:59"),
        ('id,name\ns1,"A\ns2,B\n', "no table"),
        ('Foo;Bar\n1;"x";2\n', "line 1: no header of a roster, 'Foo' and 'Bar'; expected"),
        (f"id,name\ns1,{'x' * 200_000}\n", "line 2: no table"),
        ("id,name\ns1,Zoë\ns2,".encode() + b"\xfc\n", "line 3: no text in UTF-8; save it as CSV UTF-8"),
        ("id,name\ns1,A\n".encode("utf-16"), "line 1: no text in UTF-8; save it as CSV UTF-8"),
    ],
)
def test_a_roster_that_is_none(roster, content, says):
    with pytest.raises(GradingError) as raised:
        roster(content)
    assert says in str(raised.value)
    assert str(raised.value).startswith("roster.csv")
    assert "\n" not in str(raised.value)


def test_all_faults_are_told_at_once(roster):
    with pytest.raises(GradingError) as raised:
        roster("id,name,handed_in\n,A,\n.x,B,tomorrow\ns1,C,\nS1,D,\n")
    assert [line.partition(":")[0] for line in str(raised.value).split("\n")] == [
        "roster.csv, line 2",
        "roster.csv, line 3",
        "roster.csv, line 3",
        "roster.csv, line 5",
    ]


def test_a_name_that_only_begins_like_a_device_is_an_id(roster):
    assert [student.id for student in roster("id,name\nconrad,A\ncom10,B\ns.con,C\n")] == ["conrad", "com10", "s.con"]


def test_a_roster_that_is_missing(tmp_path):
    for path in (tmp_path / "none.csv", tmp_path):
        with pytest.raises(GradingError, match="cannot be read"):
            read_roster(path)


@given(st.binary(max_size=60) | st.text(alphabet="id,name;\t\n\r\"'s1 \ufeff", max_size=60).map(str.encode))
def test_any_bytes_are_a_roster_or_sentences(tmp_path_factory, content):
    path = tmp_path_factory.getbasetemp() / "any.csv"
    path.write_bytes(b"id,name\n" + content)
    students, problem = attempted(read_roster, path)
    assert all(POSSIBLE_ID.fullmatch(student.id) for student in students or ())
    assert bool(students) != bool(problem)
    assert all(line.startswith("any.csv") for line in problem.split("\n") if problem)


@pytest.mark.parametrize(
    ("text", "time"),
    [
        ("2025-11-03T09:05", "2025-11-03 09:05:00"),
        ("2025-11-03 23:59:30", "2025-11-03 23:59:30"),
        ("2025-11-03T23:59+01:00", "2025-11-03 23:59:00+01:00"),
        ("Sunday, 28 March 2027, 12:05 AM", "2027-03-28 00:05:00"),
        ("Sunday, 28 March 2027, 12:05 PM", "2027-03-28 12:05:00"),
        ("Sunday, March 28, 2027, 12:05 PM", "2027-03-28 12:05:00"),
    ],
)
def test_times(text, time):
    assert str(moment(text)) == time


@pytest.mark.parametrize(
    "text", ["2025-11-03", "2025-13-03 10:00", "Monday, 31 April 2025, 10:00 AM", "11/03/2025 10:00", "36 days late"]
)
def test_what_is_no_time(text):
    with pytest.raises(ValueError, match="expected one as"):
        moment(text)


# Owners.


@pytest.mark.parametrize(
    ("name", "student", "said"),
    [
        ("s1001", JANE, ()),
        ("s1001.IPYNB", JANE, ()),
        ("Jane Doe (s1001)", JANE, ()),
        ("doejane_123_456_heater.ipynb", JANE, (None, 456)),
        ("doejane_LATE_123_456_heater-1.ipynb", JANE, (True, 456)),
        ("doejane_123_456_LATE_heater.ipynb", JANE, (None, 456)),
        ("müllerlüdenscheidtanne_125_456_a_b.ipynb", ANNE, (None, 456)),
        ("mu\u0308llerlu\u0308denscheidtanne_LATE_125_456_heater.ipynb", ANNE, (True, 456)),
        ("doejane_123_456_124_789_x.ipynb", JANE, (None, 456)),  # a file's own name is the student's to choose
        ("Jane Doe_77001_assignsubmission_file", JANE, ()),
        ("Jane Doe_77001_assignsubmission_file_heater.ipynb", JANE, ()),
        ("Jane Doe_5_assignsubmission_file_John Roe_77002_assignsubmission_file_x.ipynb", JANE, ()),
        ("Participant_77002_assignsubmission_file_", JOHN, ()),
        ("Anne Müller-Lüdenscheidt_5_assignsubmission_file", ANNE, ()),  # the number is that of another assignment
    ],
)
def test_whose_it_is(name, student, said):
    found = Known(CLASS).owner(name)
    assert (found.student, found.reason) == (student, "")
    assert (found.late, found.upload) == (said or (None, None))


@pytest.mark.parametrize(
    ("name", "says"),
    [
        ("S1001", "no student"),
        ("s1001 ", "no student"),
        ("Jane Doe", "no student"),
        ("heater (s1001)", "no student"),
        ("heater.ipynb", "no student"),
        ("doejane_999_456_heater.ipynb", "999"),
        ("roejohn_123_456_heater.ipynb", "has Canvas's number of s1001 and another name"),
        ("x_9_123_456_heater.ipynb", "Canvas's number 9"),
        ("anon_Ab3dE_456_heater.ipynb", "anonymous"),
        ("LATE_anon_12345_456_heater.ipynb", "anonymous"),
        ("Group A_12_assignsubmission_file", "of Moodle that the roster does not have"),
        ("Default group_assignsubmission_file", "no student"),
        ("Participant_5_assignsubmission_file", "of Moodle"),
        ("submission_299342034", "a download of Gradescope, which does not say whose it is"),
    ],
)
def test_whose_it_is_not(name, says):
    found = Known(CLASS).owner(name)
    assert found.student is None
    assert says in found.reason


def test_what_may_be_that_of_two():
    twins = [Student("a", "Jane Doe"), Student("b", "Jané  Doe"), Student("c", "C", canvas_id="3", moodle_id="5")]
    known = Known([*twins, Student("d", "D", canvas_id="3"), Student("e", "E", canvas_id="4")])
    for name in ("Jane Doe_1_assignsubmission_file", "janedoe_1_2_x.ipynb", "c_3_4_x.ipynb", "x_4_8_3_9_y.ipynb"):
        found = known.owner(name)
        assert found.student is None
        assert found.reason.startswith("may be that of ")


def test_a_name_decides_only_where_there_is_no_number():
    known = Known([Student("a", "Jane Doe", "Doe, Jane"), JOHN])
    assert known.owner("doejane_7_8_x.ipynb").student.id == "a"
    assert known.owner("roejohn_7_8_x.ipynb").student is None


@given(st.text(alphabet=string.ascii_letters + string.digits + "_ -.ü()", max_size=30))
def test_the_name_of_a_file_stands_for_nobody_else(own_name):
    """What a student chooses never makes a file that of another student, and never takes LATE away."""
    for written, late in (
        (f"doejane_LATE_123_456_{own_name}.ipynb", True),
        (f"doejane_123_456_{own_name}.ipynb", None),
        (f"Jane Doe_77001_assignsubmission_file_{own_name}.ipynb", None),
    ):
        found = Known(CLASS).owner(written)
        assert (found.student, found.late) == (JANE, late)


# Grades.


def mark(student, earned, points=17, status="complete", file="", **more):
    """What a student has earned, of so many points."""
    answers = (
        JudgedAnswer("K", "right", "right", 2, "2", weight=earned or 0),
        JudgedAnswer("T", "wrong", "not right", 3, "4", weight=points - (earned or 0)),
    )
    exercise = JudgedExercise("1", "Gain", points, "What is the gain?", (), answers)
    label = file or f"{student}/heater.ipynb"
    result = Result("heater", student, label, True, "0" * 64, status, "", (), (), (exercise,))
    return Marked.of(replace(result, **more))


def rows(text):
    return list(csv.reader(io.StringIO(text.removeprefix("\ufeff"))))


def test_the_grades_that_are_always_there():
    text = grades_csv(Grades("Heater", CLASS, [mark("s1001", 17 / 3), mark("s1002", None, status="missing")]))
    assert text == "\ufeffid,name,points\ns1001,Jane Doe,5.67\ns1002,John Roe,\n"
    head = rows(grades_csv(Grades("Heater", CLASS, [mark("s1001", 1, jailed=False)])))[0]
    assert head == ["id", "name", "points (graded without a jail)"]


@pytest.mark.parametrize(
    "name", ["=1+1", "+1+2", "-1+x", "@SUM(A1)", " =1", "\t=1", "\r\n=1", "Doe;=1", "＝1", "Doe; -1"]
)
def test_no_name_is_a_formula(name):
    cell = rows(grades_csv(Grades("Heater", [Student("s1001", name)], [mark("s1001", 1)])))[1][1]
    assert all(not part.strip().startswith(("=", "+", "-", "@", "＝")) for part in cell.split(";"))
    assert "\n" not in cell


@pytest.mark.parametrize("name", ["Anne-Marie O'Hara", "Doe, Jane", 'Jane "J" Doe', "李 小龙", "Ünal"])
def test_other_names_stay_as_they_are(name):
    assert rows(grades_csv(Grades("Heater", [Student("s1001", name)], [mark("s1001", 1)])))[1][1] == name


def test_canvas_gets_its_own_columns_with_the_number_of_the_assignment(roster):
    students = roster(CANVAS.format(sis="", login="anh"))
    marks = [mark("A17", 10, 10), mark("john", None, 10, "missing"), mark("A19", 3, 10), mark("A20", 2.5, 10)]
    assert rows(canvas_grades(Grades("heater", students, marks))) == [
        ["Student", "ID", "SIS User ID", "SIS Login ID", "Section", "Heater (11)"],
        ["    Points Possible", "", "", "", "", "10.00"],
        ["Doe, Jane", "123", "A17", "jane", "C1, C2", "10"],
        ["Roe, John, Jr.", "124", "", "john", "C1", ""],
        ["Nguyễn, Thị, Anh", "125", "A19", "anh", "C1", "EX"],  # who is excused stays so
        ["'=1+1", "126", "A20", "odd", "C1", "2.5"],
    ]
    assert lms.remarks(students, "heater", 10)[1:] == ("canvas_grades.csv: A19 is excused in Canvas, and so left",)
    kept = canvas_grades(Grades("Heater", students, [mark("A17", None, 10, "not run")]))
    assert rows(kept)[-1][-1] == "9.00"  # what stands in Canvas
    assert not kept.startswith("\ufeff")


def test_canvas_asks_where_it_cannot_know_and_that_is_said(roster):
    students = roster(CANVAS.format(sis="A18", login="anh"))
    marks = [mark("A17", 10)]
    table = rows(canvas_grades(Grades("Tank", students, marks)))
    assert [row[-1] for row in table] == ["Tank", "17", "10"]
    assert lms.remarks(students, "Tank", 17) == (
        "canvas_grades.csv: the gradebook of the roster has no assignment called 'Tank' but 'Heater', so that Canvas "
        "will ask where the grades go; export it again once there is one",
    )
    assert lms.remarks(students, "Heater", 17)[1:] == (
        "canvas_grades.csv: Heater (11) has 10 points in Canvas and 17 here, and grades are not scaled: change it in "
        "Canvas",
    )
    two = roster(CANVAS.format(sis="A18", login="anh").replace("Current Score", "Heater (12)"))
    assert {row[-1] for row in rows(canvas_grades(Grades("Heater", two, marks)))} == {"Heater", "17", "10"}
    assert "two assignments or more called 'Heater'" in lms.remarks(two, "Heater", 17)[0]
    unsafe = [mark("A17", 10, jailed=False)]
    assert rows(canvas_grades(Grades("Heater", students, unsafe)))[0][-1] == "Heater (graded without a jail)"


def test_canvas_with_semicolons_has_decimal_commas(roster):
    text = (
        "LastName;FirstName;ID;SIS User ID;SIS Login ID;Section;Heater (11)\n    Points Possible;;;;;;17,00\n"
        "Doe;Jane;123;A17;jane;C1;\n"
    )
    students = roster(text, "utf-8-sig")
    assert (students[0].name, students[0].sortable) == ("Jane Doe", "Doe, Jane")
    written = canvas_grades(Grades("Heater", students, [mark("A17", 2.5)]))
    assert written == text.replace("jane;C1;", "jane;C1;2,5")  # before LastName Canvas takes no byte-order mark
    assert lms.remarks(students, "Heater", 17) == ()
    assert canvas_grades(Grades("Heater", roster(CANVAS.format(sis="", login=""), "utf-8-sig"), [])).startswith(
        "\ufeff"
    )


def test_the_worksheet_of_moodle_is_filled_in_and_nothing_else_changes(roster):
    students = roster(WORKSHEET)
    marks = [replace(mark("s1001", 4.5), comments=("- See me.",)), mark("s1002", None, status="missing")]
    before, after = rows(WORKSHEET), rows(moodle_grades(Grades("Heater", students, marks)))
    assert after[0] == before[0]
    assert (after[1][5], after[1][10]) == ("4.5", "- See me.")
    assert [cell for k, cell in enumerate(after[1]) if k not in (5, 10)] == [
        cell for k, cell in enumerate(before[1]) if k not in (5, 10)
    ]
    assert after[2] == before[2]
    assert lms.remarks(students, "Heater", 17) == ()
    assert lms.remarks(students, "Heater", 20) == (
        "moodle_grades.csv: the assignment has 17 points in Moodle and 20 here, and grades are not scaled: change it "
        "in Moodle, and take its worksheet again",
    )
    unsafe = rows(moodle_grades(Grades("Heater", students, [mark("s1001", 4, jailed=False)])))
    assert unsafe[0][-1] == "Heater (graded without a jail)"
    assert unsafe[1] == ["Participant 77001", "Jane Doe", "s1001", "jane@x.org", "4"]


def by_hand(earned, waiting=()):
    """A late submission with what a person has added to it."""
    one = mark("s1001", 4)
    exercise = MarkedExercise(
        one.result.exercises[0], earned, ("K < 0: look at the sign",), ("4 by the grader, 5 by hand",)
    )
    return replace(one, exercises=(replace(exercise, waiting=waiting),), late="A day late: 10 %.", deduction=0.5)


def test_what_a_person_says_goes_to_moodle_and_gradescope(roster):
    filled = rows(moodle_grades(Grades("Heater", roster(WORKSHEET), [by_hand(5)])))[1]
    said = "A day late: 10 %. · Exercise 1: 4 by the grader, 5 by hand · Exercise 1: K &lt; 0: look at the sign"
    assert (filled[5], filled[10]) == ("4.5", said)
    data = json.loads(results_json(Grades("Heater", CLASS, []), JANE, by_hand(5)))
    assert (data["score"], data["tests"][0]["score"]) == (4.5, 5)
    assert "A day late" in data["output"]
    assert data["tests"][0]["output"].endswith("4 by the grader, 5 by hand\nK < 0: look at the sign")


def test_what_waits_for_a_person_is_no_grade_and_gradescope_says_so(roster):
    waits = by_hand(None, ("K",))
    assert rows(moodle_grades(Grades("Heater", roster(WORKSHEET), [waits])))[1][5] == ""
    data = json.loads(results_json(Grades("Heater", CLASS, []), JANE, waits))
    assert data["score"] == 0
    assert data["output"].endswith("Waiting for a mark by hand: exercise 1.")


def test_what_students_write_into_the_worksheet_is_no_formula(roster):
    students = roster(WORKSHEET.replace("Jane Doe", "=1+1").replace("<p>Good", "-Good"))
    after = rows(moodle_grades(Grades("Heater", students, [mark("s1001", 4)])))
    assert after[1][1] == "'=1+1"
    assert after[1][9] == "-"
    assert after[2][10].startswith("-Good")  # the instructor's own


def test_other_tables_of_moodle_get_a_table_for_the_gradebook(roster):
    students = roster('"First name",Surname,"ID number","Email address"\nJane,Doe,s1001,j@x.org\nJohn,Roe,s1002,\n')
    marks = [mark("s1001", 2)]
    assert rows(moodle_grades(Grades("Heater", students, marks))) == [
        ["First name", "Surname", "ID number", "Email address", "Heater"],
        ["Jane", "Doe", "s1001", "j@x.org", "2"],
    ]
    assert lms.remarks(students, "Heater", 17)[0].startswith("moodle_grades.csv is for the import of the gradebook")


FITTING = {
    "own": {"grades.csv", "feedback.zip", "moodle_feedback.zip"},
    "canvas": {"grades.csv", "canvas_grades.csv", "canvas_feedback.zip"},
    "moodle": {"grades.csv", "moodle_grades.csv", "moodle_feedback.zip"},
    "gradescope": {"grades.csv"},
}


def test_only_what_fits_the_roster_is_written(roster, tmp_path):
    file = "doejane_LATE_123_456_heater-1.ipynb"
    classes = {
        "own": (CLASS, mark("s1001", 2)),
        "canvas": (roster(CANVAS.format(sis="", login="")), mark("A17", 2, file=file)),
        "moodle": (roster(WORKSHEET), mark("s1001", 2)),
        "gradescope": (roster("First Name,Last Name,SID,Email\nJane,Doe,s1001,jane@x.org\n"), mark("s1001", 2)),
    }
    for system, (students, one) in classes.items():
        reports.write_all(tmp_path / system, "Heater", students, [one])
        written = {path.name for path in (tmp_path / system).iterdir()}
        assert written & set().union(*FITTING.values()) == FITTING[system]


# Feedback.


def members(content):
    with zipfile.ZipFile(io.BytesIO(content)) as archive:
        assert {member.date_time for member in archive.infolist()} <= {(1980, 1, 1, 0, 0, 0)}
        return {member.filename: archive.read(member).decode() for member in archive.infolist()}


def test_feedback_goes_to_canvas_under_the_names_of_the_download(roster, tmp_path):
    students = roster(CANVAS.format(sis="", login=""))
    marks = [
        replace(mark("A17", 2, file="heater submissions/doejane_LATE_123_456_heater-1.ipynb"), comments=(HOSTILE,)),
        mark("john", 2, file="john/heater.ipynb"),
        mark("A19", None, status="missing", file=""),
    ]
    reports.write_all(tmp_path, "Heater", students, marks)
    ((name, text),) = members((tmp_path / "canvas_feedback.zip").read_bytes()).items()
    assert name == "doejane_LATE_123_456_heater-1.ipynb"
    (cell,) = json.loads(text)["cells"]
    assert cell["source"].splitlines()[:3] == ["    Heater", "    Jane Doe (A17)", "    2 of 17 points"]
    shown = MarkdownIt("commonmark", {"html": True}).render(cell["source"])
    assert re.findall("<[^>]*>", shown) == ["<pre>", "<code>", "</code>", "</pre>"]


def test_feedback_goes_to_moodle_by_the_numbers(tmp_path):
    students = [JANE, replace(JOHN, moodle_id=""), replace(ANNE, name="Anne_M/L: ü", moodle_id="")]
    anne = mark("s1003", 2, file="Anne M-L_99_assignsubmission_file_/heater.ipynb")
    marks = [mark("s1001", 2), mark("s1002", 2), anne]
    reports.write_all(tmp_path, "Heater", students, marks)
    files = members((tmp_path / "moodle_feedback.zip").read_bytes())
    page = (tmp_path / "feedback" / "s1001" / "feedback.html").read_text(encoding="utf-8")
    assert files.pop("Jane Doe_77001_assignsubmission_file_feedback.html") == page
    assert [*files] == ["Anne M L ü_99_assignsubmission_file_feedback.html"]


# Released notebooks.


@pytest.fixture
def released(tmp_path):
    for student in CLASS:
        path = tmp_path / "released" / student.id / "heater.ipynb"
        path.parent.mkdir(parents=True)
        path.write_text(f'{{"of": "{student.id}"}}')
    return tmp_path / "released"


def test_notebooks_for_moodle_are_feedback_files(released):
    made = lms.packed("moodle", released, CLASS)
    assert list(made.files) == ["heater_for_moodle.zip"]
    assert members(made.files["heater_for_moodle.zip"]) == {
        "Jane Doe_77001_assignsubmission_file_heater.ipynb": '{"of": "s1001"}',
        "John Roe_77002_assignsubmission_file_heater.ipynb": '{"of": "s1002"}',
        "Anne Müller-Lüdenscheidt_77003_assignsubmission_file_heater.ipynb": '{"of": "s1003"}',
    }
    assert "Upload multiple feedback files in a zip" in made.says
    with pytest.raises(
        GradingError, match="there is none of s1002: take the worksheet of the assignment as the roster"
    ):
        lms.packed("moodle", released, [JANE, replace(JOHN, moodle_id="")])


def test_notebooks_for_canvas_are_links_that_nobody_can_guess(released):
    made = lms.packed("canvas", released, CLASS, "heater", "a secret of some length")
    assert "Canvas cannot give each student a file of their own" in made.says
    (head, *links) = rows(made.files["links.csv"].decode())
    assert head == ["id", "name", "email", "login", "link"]
    assert [row[0] for row in links] == ["s1001", "s1002", "s1003"]
    for row in links:
        assert re.fullmatch(r"[a-z2-7]{26}/heater\.ipynb", row[-1])
        assert json.loads(made.files[f"links/{row[-1]}"])["of"] == row[0]
    again = lms.packed("canvas", released, CLASS, "heater", "a secret of some length")
    other = lms.packed("canvas", released, CLASS, "heater", "another secret of some length")
    assert again.files == made.files
    assert not {*other.files} & {*made.files} - {"links.csv"}


def test_notebooks_for_a_drive_come_back_from_there(released):
    odd = replace(JOHN, name='John "J" Roe: <x>/..')
    made = lms.packed("drive", released, [JANE, odd])
    folders = [row[0] for row in rows(made.files["folders.csv"].decode())[1:]]
    assert folders == ["Jane Doe (s1001)", "John J Roe x (s1002)"]
    assert sorted(made.files) == [*(f"{folder}/heater.ipynb" for folder in folders), "folders.csv"]
    assert [Known([JANE, odd]).owner(folder).student for folder in folders] == [JANE, odd]


def test_the_command_packs_what_it_releases(tmp_path):
    module = tmp_path / "heater.py"
    module.write_text(
        '"""Heater\n"""\nfrom exercisebook.authoring import answers, between, exercise, number\n'
        'SECRET = "a secret of some length"\n@exercise("1", title="Gain", points=1)\n'
        'def gain(K=between(1, 9, reference=2)):\n    """A gain {K}."""\n'
        '    return answers(G=number(2 * K, what="twice the gain"))\n'
    )
    (tmp_path / "roster.csv").write_text(WORKSHEET)
    command = ["release", str(module), "--to", str(tmp_path / "released"), "--for"]
    done = CliRunner().invoke(app, [*command, "moodle"])
    assert done.exit_code == 0, done.output
    assert "Upload multiple feedback files in a zip" in " ".join(done.output.split())
    packed = tmp_path / "released_for_moodle" / "heater_for_moodle.zip"
    before = packed.read_bytes()
    notebook = (tmp_path / "released" / "s1002" / "heater.ipynb").read_text(encoding="utf-8")
    assert members(before)["John Roe_77002_assignsubmission_file_heater.ipynb"] == notebook
    assert CliRunner().invoke(app, [*command, "moodle"]).exit_code == 0
    assert packed.read_bytes() == before
    done = CliRunner().invoke(app, ["release", str(module), "--to", str(tmp_path / "other"), "--for", "nowhere"])
    assert done.exit_code == 1
    assert re.search("notebooks cannot be packed for 'nowhere': expected one of .*canvas.* moodle", done.output)
    assert not (tmp_path / "other").exists()


def test_what_cannot_be_handed_out_is_said(released):
    with pytest.raises(GradingError, match=r"cannot be packed for 'gradescope': expected one of .*canvas.* moodle"):
        lms.packed("gradescope", released, CLASS)
    with pytest.raises(GradingError, match="has no notebook of s9: expected a folder for each student"):
        lms.packed("drive", released, [*CLASS, Student("s9", "N")])


# The registry.


def test_what_a_system_lacks_is_said(tmp_path, monkeypatch):
    monkeypatch.setattr(lms, "_REGISTERED", dict(lms._REGISTERED))
    for attributes, says in [
        ({}, "a system has the name '': expected one that no other has"),
        ({"name": "moodle"}, "a system has the name 'moodle': expected one"),
    ]:
        with pytest.raises(GradingError, match=says):
            lms.system(type("New", (lms.System,), attributes))
    (tmp_path / "lectern_without_system.py").write_text("")
    monkeypatch.setattr(lms, "__path__", [*lms.__path__, str(tmp_path)])
    with pytest.raises(GradingError, match="lectern_without_system registers no system: expected a class with @system"):
        lms.registered()


def test_the_system_that_contributors_are_shown_is_one(monkeypatch, roster):
    """Beside those of the library, of which one may be the same by now."""
    monkeypatch.setattr(lms, "__path__", [])
    monkeypatch.setattr(lms, "_REGISTERED", {name: lms._REGISTERED[name] for name in ("canvas", "moodle", "own")})
    monkeypatch.setattr(reports.outputs, "_REGISTERED", {})
    contributing.run("Add a learning management system")
    jane, john = students = roster("Person;Badge\nJane Doe;b7\nJohn Roe;b8\n")
    assert (jane.id, jane.name, jane.id_from, jane.system) == ("b7", "Jane Doe", "Badge", "lectern")
    assert Known(students).owner("badge b8 late.ipynb").student == john
    assert Known(students).owner("badge b8 late.ipynb").late is True
    assert Known(students).owner("badge b7.ipynb").late is None
    assert "not on the roster" in Known(students).owner("badge b9.ipynb").reason
    one = reports.outputs._REGISTERED["lectern_grades.csv"]
    assert dict(one.files(Grades("Heater", students, [mark("b7", 2.5)]))) == {
        "lectern_grades.csv": "Badge;Points\nb7;2.5\n"
    }
    assert dict(one.files(Grades("Heater", CLASS, []))) == {}
    with pytest.raises(GradingError, match="an export of Lectern's participants"):
        roster("a,b\n")
