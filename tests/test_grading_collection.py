"""Rosters of our own, of Canvas and of Moodle, and the submissions that belong to their students."""

import io
import os
import pickle
import stat
import string
import sys
import zipfile

import pytest
from hypothesis import given
from hypothesis import strategies as st

from loopbook.grading import GradingError, entries, submissions
from loopbook.grading.owners import Owners
from loopbook.grading.roster import POSSIBLE_ID, Student, read_roster
from loopbook.grading.submissions import LARGEST, collect

JANE = Student("s1001", "Jane Doe", "Doe, Jane", canvas_id="123", moodle_id="77001")
JOHN = Student("s1002", "John Roe", "Roe, John", canvas_id="124", moodle_id="77002")
ANNE = Student("s1003", "Anne Müller-Lüdenscheidt", "Müller-Lüdenscheidt, Anne", canvas_id="125", moodle_id="77003")
CLASS = (JANE, JOHN, ANNE)

has_pipes = pytest.mark.skipif(sys.platform == "win32", reason="Windows has no pipes and seldom links among its files")
takes_any_name = pytest.mark.skipif(sys.platform != "linux", reason="elsewhere names of files are text")


def attempted(function, *arguments):
    """What a function returns, or None, and what it complains of, or ""."""
    try:
        return function(*arguments), ""
    except GradingError as problem:
        return None, str(problem)


# Rosters.


@pytest.fixture
def roster(tmp_path):
    """Writes a roster and reads it."""

    def read(content, encoding="utf-8"):
        path = tmp_path / "roster.csv"
        path.write_bytes(content if isinstance(content, bytes) else content.encode(encoding))
        return read_roster(path)

    return read


@pytest.mark.parametrize("encoding", ["utf-8", "utf-8-sig"])
@pytest.mark.parametrize("delimiter", [",", ";", "\t"])
def test_our_own_roster(roster, delimiter, encoding):
    lines = ["Name,ID,e-mail,Email,canvas_id,Sortable", '"Zoë  Ünal",s2,,z@x.org,7,', "", '"O\'Brien",s1,,,,O Brien']
    text = "\r\n".join(lines).replace(",", delimiter)
    assert roster(text, encoding) == (
        Student("s2", "Zoë Ünal", email="z@x.org", canvas_id="7"),
        Student("s1", "O'Brien", sortable="O Brien"),
    )


CANVAS = """\
Student,ID,SIS User ID,SIS Login ID,Section,Heater (11),Current Score
,,,,,Manual Posting,
    Points Possible,,,,,10,(read only)
"Doe, Jane",123,A17,jane,"C1, C2",9.00,
"Roe, John, Jr.",124,{sis},john,C1,,
"Nguyễn, Thị, Anh",125,A19,{login},C1,,
"=""=1+1""\",126,A20,odd,C1,,
"Student, Test",999,,4f3c2a,C1,,
"""


@pytest.mark.parametrize(
    ("sis", "login", "ids"),
    [
        ("A18", "anh", ["A17", "A18", "A19", "A20"]),
        ("", "anh", ["jane", "john", "anh", "odd"]),
        ("", "", ["123", "124", "125", "126"]),
    ],
)
def test_the_gradebook_of_canvas(roster, sis, login, ids):
    students = roster(CANVAS.format(sis=sis, login=login))
    assert [student.id for student in students] == ids
    assert [student.name for student in students] == ["Jane Doe", "John Roe Jr.", "Thị Anh Nguyễn", "=1+1"]
    jane = Student(ids[0], "Jane Doe", "Doe, Jane", canvas_id="123", sis_id="A17", login="jane", section="C1, C2")
    assert students[0] == jane


def test_the_gradebook_of_canvas_with_first_and_last_names(roster):
    header = "LastName;FirstName;ID;SIS Login ID;Section\n    Points Possible;;;;\n"
    (jane,) = roster(header + "Doe;Jane;123;jane;C1\nStudent;Test;9;x;C1\n")
    assert (jane.name, jane.sortable, jane.id, jane.canvas_id) == ("Jane Doe", "Doe, Jane", "jane", "123")


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


def test_the_participants_and_grades_of_moodle(roster):
    (jane, john) = roster(
        '"First name",Surname,"ID number","Email address",Groups\nJane,Doe,,j@x.org,"A, B"\nJohn,,17,r@x.org,\n'
    )
    assert jane == Student("j@x.org", "Jane Doe", "Doe, Jane", email="j@x.org", section="A, B")
    assert john == Student("r@x.org", "John", "John", email="r@x.org", sis_id="17")
    (jane,) = roster('"First name","Last name","ID number",Username,"Assignment: Heater (Real)"\nJane,Doe,,jane,9.0\n')
    assert jane == Student("jane", "Jane Doe", "Doe, Jane", login="jane")


@pytest.mark.parametrize(
    ("content", "says"),
    [
        ("", "line 1: no header of a roster"),
        ("Vorname,Nachname\na,b\n", "an export in English of Canvas's"),
        ("id,name\n", "a header and no student"),
        ("Student,ID\n    Points Possible,\n", "a header and no student"),
        ("id,name\ns1,A\n\ns1,B\n", "line 4: the id 's1' is already that of line 2"),
        ("id,name\ns1,A\nS1,B\n", "line 3: the id 'S1' is already that of line 2"),
        ('id,name\ns1,"A\nB"\n,C\n', "line 4: a student without an id"),
        (
            "Student,ID,SIS User ID\nA,,\n",
            "line 2: a student without an id; ids come from the first full of: SIS User ID",
        ),
        ("id,name\nNul.a,A\n", "line 2: 'Nul.a' cannot be an id"),
        ("id,name\ncom1,A\n", "line 2: 'com1' cannot be an id"),
        ("id,name\ns1.,A\n", "line 2: 's1.' cannot be an id"),
        ("id,name\n../x,A\n", "line 2: '../x' cannot be an id"),
        ("id,name\n.x,A\n", "line 2: '.x' cannot be an id"),
        ("id,name\n2.3E+08,A\n", "line 2: '2.3E+08' cannot be an id"),
        (f"id,name\n{'x' * 101},A\n", "at most 100 characters"),
        ("id,name\nmüller,A\n", "line 2: 'müller' cannot be an id"),
        ('id,name\ns1,"A\ns2,B\n', "no table"),
        (f"id,name\ns1,{'x' * 200_000}\n", "line 2: no table"),
        (b"id,name\ns1,M\xfcller\n", "line 2: no text in UTF-8"),
        (b"PK\x03\x04\x14\x00\x06\x00", "line 1: no text"),
        ("id,name\n".encode("utf-16"), "line 1: no text"),
    ],
)
def test_a_roster_that_is_none(roster, content, says):
    with pytest.raises(GradingError) as raised:
        roster(content)
    assert says in str(raised.value)
    assert str(raised.value).startswith("roster.csv")
    assert "\n" not in str(raised.value)


def test_a_name_that_only_begins_like_a_device_is_an_id(roster):
    assert [student.id for student in roster("id,name\nconrad,A\ncom10,B\ns.con,C\n")] == ["conrad", "com10", "s.con"]


def test_a_roster_that_is_missing(tmp_path):
    for path in (tmp_path / "none.csv", tmp_path):
        with pytest.raises(GradingError, match="cannot be read"):
            read_roster(path)


@given(st.binary(max_size=60) | st.text(alphabet="id,name;\t\n\r\"'s1 \ufeff", max_size=60).map(str.encode))
def test_any_bytes_are_a_roster_or_one_sentence(tmp_path_factory, content):
    path = tmp_path_factory.getbasetemp() / "any.csv"
    path.write_bytes(b"id,name\n" + content)
    students, problem = attempted(read_roster, path)
    assert all(POSSIBLE_ID.fullmatch(student.id) for student in students or ())
    assert bool(students) != bool(problem)
    assert "\n" not in problem


# Owners.


@pytest.mark.parametrize(
    ("name", "student"),
    [
        ("s1001", JANE),
        ("s1001.ipynb", JANE),
        ("s1001.IPYNB", JANE),
        ("doejane_123_456_heater.ipynb", JANE),
        ("doejane_LATE_123_456_heater-1.ipynb", JANE),
        ("müllerlüdenscheidtanne_125_456_a_b.ipynb", ANNE),
        ("mu\u0308llerlu\u0308denscheidtanne_LATE_125_456_heater.ipynb", ANNE),
        ("doejane_123_456_124_789_x.ipynb", JANE),  # a file's own name is the student's to choose
        ("Jane Doe_77001_assignsubmission_file", JANE),
        ("Jane Doe_77001_assignsubmission_file_", JANE),
        ("Jane Doe_77001_assignsubmission_file_heater.ipynb", JANE),
        ("Jane Doe_5_assignsubmission_file_John Roe_77002_assignsubmission_file_x.ipynb", JANE),
        ("Participant_77002_assignsubmission_file_", JOHN),
        ("Anne Müller-Lüdenscheidt_5_assignsubmission_file", ANNE),  # the number is that of another assignment
    ],
)
def test_whose_it_is(name, student):
    assert Owners(CLASS).of(name) == (student, "")


@pytest.mark.parametrize(
    ("name", "says"),
    [
        ("S1001", "no student"),
        ("s1001 ", "no student"),
        ("s100", "no student"),
        ("Jane Doe", "no student"),
        ("heater.ipynb", "no student"),
        ("doejane_999_456_heater.ipynb", "999"),
        ("roejohn_123_456_heater.ipynb", "has Canvas's number of s1001 and another name"),
        ("x_9_123_456_heater.ipynb", "Canvas's number 9"),
        ("doejane_123_124_777_x.ipynb", None),
        ("anon_Ab3dE_456_heater.ipynb", "anonymous"),
        ("LATE_anon_12345_456_heater.ipynb", "anonymous"),
        ("anon_00123_123_456_x.ipynb", "anonymous"),
        ("Group A_12_assignsubmission_file", "of Moodle that the roster does not have"),
        ("Default group_assignsubmission_file", "no student"),
        ("Participant_5_assignsubmission_file", "of Moodle"),
    ],
)
def test_whose_it_is_not(name, says):
    student, reason = Owners(CLASS).of(name)
    assert (student, says) == (JANE, None) or (student is None and says in reason)


def test_what_may_be_that_of_two():
    twins = [Student("a", "Jane Doe"), Student("b", "Jané  Doe"), Student("c", "C", canvas_id="3", moodle_id="5")]
    owners = Owners([*twins, Student("d", "D", canvas_id="3"), Student("e", "E", canvas_id="4")])
    for name in ("Jane Doe_1_assignsubmission_file", "janedoe_1_2_x.ipynb", "c_3_4_x.ipynb", "x_4_8_3_9_y.ipynb"):
        student, reason = owners.of(name)
        assert student is None
        assert reason.startswith("may be that of ")


def test_a_name_decides_only_where_there_is_no_number():
    owners = Owners([Student("a", "Jane Doe", "Doe, Jane"), JOHN])
    assert owners.of("doejane_7_8_x.ipynb")[0].id == "a"
    assert owners.of("roejohn_7_8_x.ipynb")[0] is None


@given(st.text(alphabet=string.ascii_letters + string.digits + "_ -.ü", max_size=30))
def test_the_name_of_a_file_stands_for_nobody_else(own):
    """What a student chooses never makes a file that of another student."""
    for written in (f"doejane_123_456_{own}.ipynb", f"Jane Doe_77001_assignsubmission_file_{own}.ipynb"):
        assert Owners(CLASS).of(written) == (JANE, "")


# Submissions in folders.


def lay(root, **files):
    for name, content in files.items():
        path = root / name.replace("__", "/").replace("_ipynb", ".ipynb")
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_text(content)


def labels(collection):
    return {found.student.id: found.label for found in collection.submissions if not found.problem}


def test_a_folder_for_each_student(tmp_path):
    lay(tmp_path, s1003__heater_ipynb="3", s1001__inner__heater_ipynb="1", s1002_ipynb="2")
    for passed in (".DS_Store", "s1001/.ipynb_checkpoints/heater-checkpoint.ipynb", "__MACOSX/s1001/._heater.ipynb"):
        (tmp_path / passed).parent.mkdir(parents=True, exist_ok=True)
        (tmp_path / passed).write_text("?")
    found = collect(tmp_path, CLASS, "heater")
    assert [(item.student, item.label, item.problem, item.read()) for item in found.submissions] == [
        (JANE, "s1001/inner/heater.ipynb", "", b"1"),
        (JOHN, "s1002.ipynb", "", b"2"),
        (ANNE, "s1003/heater.ipynb", "", b"3"),
    ]
    assert found.complaints == ()
    assert pickle.loads(pickle.dumps(found)) == found
    assert collect(str(tmp_path), CLASS, "heater") == found


def test_a_wrapping_folder_is_seen_through(tmp_path):
    lay(tmp_path / "heater", heater__s1001__a_ipynb="1")
    for root, label in ((tmp_path, "heater/heater/s1001/a.ipynb"), (tmp_path / "heater", "heater/s1001/a.ipynb")):
        found = collect(root, CLASS, "heater")
        assert labels(found) == ({} if root == tmp_path else {"s1001": label})
    assert labels(collect(tmp_path / "heater", CLASS, "tank")) == {"s1001": "heater/s1001/a.ipynb"}
    assert collect(tmp_path / "heater", [Student("heater", "H")], "heater").submissions[0].student.id == "heater"


def test_two_notebooks_of_one_student_are_not_run(tmp_path):
    lay(tmp_path, s1001__a_ipynb="1", s1001__b_ipynb="2", s1002__a_ipynb="1", s1002_ipynb="2", s1003__x_ipynb="3")
    found = collect(tmp_path, CLASS, "a")
    problem = "two notebooks: s1001/a.ipynb and s1001/b.ipynb; keep one"
    assert [item.problem for item in found.submissions][::2] == [problem, ""]
    assert found.complaints[0] == f"s1001/a.ipynb: {problem}"
    assert "two notebooks: s1002/a.ipynb and s1002.ipynb; keep one" in found.complaints[1]
    with pytest.raises(GradingError, match="two notebooks"):
        found.submissions[0].read()
    lay(tmp_path, s1001__c_ipynb="", s1001__d_ipynb="", s1001__e_ipynb="")
    problem = collect(tmp_path, CLASS, "a").submissions[0].problem
    assert problem == "5 notebooks: s1001/a.ipynb, s1001/b.ipynb, s1001/c.ipynb and 2 more; keep one"


@has_pipes
def test_what_is_no_notebook_of_a_student_is_said(tmp_path):
    lay(tmp_path, s1001__notes="", grades="", mallory__a_ipynb="", deep__1__2__3__4__5__6__a_ipynb="")
    lay(tmp_path, s1002__1__2__3__4__5__a_ipynb="as deep as may be")
    os.mkfifo(tmp_path / "s1003.ipynb")
    (tmp_path / "s1001" / "secret.ipynb").symlink_to("/etc/passwd")
    (tmp_path / "link").symlink_to(tmp_path)
    found = collect(tmp_path, CLASS, "a")
    assert labels(found) == {"s1002": "s1002/1/2/3/4/5/a.ipynb"}
    assert set(found.complaints) == {
        "deep/1/2/3/4/5/6: is nested deeper than 6 folders",
        "grades: is not a notebook (.ipynb)",
        "link: is a symbolic link, which is not followed",
        "mallory/a.ipynb: is named after no student of the roster",
        "s1001/notes: is not a notebook (.ipynb)",
        "s1001/secret.ipynb: is a symbolic link, which is not followed",
        "s1003.ipynb: is not a file but a device, a pipe or a socket",
    }


def test_what_may_not_be_read_is_said(tmp_path, monkeypatch):
    lay(tmp_path, s1001_ipynb="", s1002__a_ipynb="")
    listing = os.scandir

    def refuses(folder):
        if str(folder).endswith("s1002"):
            raise PermissionError(13, "Permission denied", str(folder))
        return listing(folder)

    monkeypatch.setattr(entries.os, "access", lambda path, mode: False)
    monkeypatch.setattr(entries.os, "scandir", refuses)
    found = collect(tmp_path, CLASS, "a")
    assert found.submissions == ()
    assert found.complaints == (
        "s1001.ipynb: cannot be read: no permission",
        "s1002: cannot be read: Permission denied",
    )


@pytest.mark.parametrize(
    "becomes",
    [pytest.param("link", marks=has_pipes), pytest.param("pipe", marks=has_pipes), "folder", "gone", "larger"],
)
def test_a_file_that_has_changed_since(tmp_path, becomes):
    lay(tmp_path, s1001_ipynb="")
    (found,) = collect(tmp_path, CLASS, "a").submissions
    path = tmp_path / "s1001.ipynb"
    if becomes == "larger":
        path.write_bytes(b" " * (LARGEST + 1))
    else:
        path.unlink()
    if becomes == "link":
        path.symlink_to("/etc/passwd")
    elif becomes == "pipe":
        os.mkfifo(path)
    elif becomes == "folder":
        path.mkdir()
    with pytest.raises(GradingError, match=r"^s1001.ipynb: (cannot be read|is larger than 10 MiB)"):
        found.read()


def test_a_notebook_that_is_too_large(tmp_path):
    (tmp_path / "s1001.ipynb").write_bytes(b" " * LARGEST)
    with open(tmp_path / "s1002.ipynb", "wb") as file:
        file.truncate(100 * 2**20)
    fits, large = collect(tmp_path, CLASS, "a").submissions
    assert len(fits.read()) == LARGEST
    assert large.problem == "is larger than 10 MiB"


@takes_any_name
def test_names_that_cannot_be_shown_are_spelled_out(tmp_path):
    for name in (b"s1001/\xff\x1b[31m.ipynb", b"line\nbreak.ipynb"):
        path = os.path.join(os.fsencode(tmp_path), name)
        os.makedirs(os.path.dirname(path), exist_ok=True)
        with open(path, "wb") as file:
            file.write(b"{}")
    found = collect(tmp_path, CLASS, "a")
    assert found.submissions[0].label == r"s1001/\udcff\x1b[31m.ipynb"
    assert found.submissions[0].read() == b"{}"
    assert found.complaints == (r"line\nbreak.ipynb: is named after no student of the roster",)


def test_a_flood_of_files_harms_nobody_else(tmp_path, monkeypatch):
    monkeypatch.setattr(entries, "MOST", 40)
    for number in range(30):
        lay(tmp_path, **{f"s1001__{number}": "", f"s1003__{number % 2}__{number}": ""})
        lay(tmp_path, **{f"s1003__{number % 2}__{number + 30}": ""})
    lay(tmp_path, s1002_ipynb="", s1001__a_ipynb="", s1003__a_ipynb="")
    found = collect(tmp_path, CLASS, "a")
    assert labels(found) == {"s1001": "s1001/a.ipynb", "s1002": "s1002.ipynb"}
    assert found.complaints[-1] == "s1003: has more than 40 files and folders"
    assert found.complaints[10] == "s1001: has 20 more that cannot be used"
    for number in range(50):
        lay(tmp_path, **{f"x{number}": ""})
    with pytest.raises(GradingError, match="more than 40 files and folders: expected those of one class"):
        collect(tmp_path, CLASS, "a")


@has_pipes
def test_where_there_is_nothing(tmp_path):
    assert collect(tmp_path, CLASS, "a") == submissions.Collection((), ())
    os.mkfifo(tmp_path / "pipe")
    for path in (tmp_path / "none", tmp_path / "pipe"):
        with pytest.raises(GradingError, match="there is neither a folder nor a zip file"):
            collect(path, CLASS, "a")


# Submissions in zip files.


@pytest.fixture
def packed(tmp_path):
    """Writes a zip file of (name or ZipInfo, content) and collects from it."""

    def pack(*members, compression=zipfile.ZIP_DEFLATED, change=None):
        memory = io.BytesIO()
        with zipfile.ZipFile(memory, "w", compression) as archive:
            for name, content in members:
                archive.writestr(name, content)
        path = tmp_path / "heater submissions.zip"
        path.write_bytes(change(memory.getvalue()) if change else memory.getvalue())
        return collect(path, CLASS, "heater")

    yield pack
    entries._archive.cache_clear()  # closes it


def test_downloads_of_both_systems(packed):
    found = packed(
        ("roejohn_LATE_124_9_heater.ipynb", "2"),
        ("doejane_123_8_heater.ipynb", "1"),
        ("doejane_123_7_notes.pdf", "?"),
        ("anon_Ab3dE_456_heater.ipynb", "?"),
        ("Anne Müller-Lüdenscheidt_77003_assignsubmission_file/inner/", ""),
        ("Anne Müller-Lüdenscheidt_77003_assignsubmission_file/inner/heater.ipynb", "3"),
        ("__MACOSX/._doejane_123_8_heater.ipynb", "?"),
    )
    assert [item.student for item in found.submissions] == [*CLASS]
    assert [item.read() for item in reversed(found.submissions)] == [b"3", b"2", b"1"]
    assert found.complaints == (
        "doejane_123_7_notes.pdf: is not a notebook (.ipynb)",
        "anon_Ab3dE_456_heater.ipynb: is from an anonymous download of Canvas, which does not say whose it is",
    )
    assert pickle.loads(pickle.dumps(found)).submissions[1].read() == b"2"


def test_names_that_are_utf_8_without_saying_so(packed):
    """As the zip files of Canvas have them."""
    name = "müllerlüdenscheidtanne_125_9_heater.ipynb"
    raw = name.encode()
    plain = "x" * len(raw)
    found = packed((plain, "3"), change=lambda content: content.replace(plain.encode(), raw))
    assert labels(found) == {"s1003": name}
    assert found.submissions[0].read() == b"3"
    found = packed((plain, "3"), change=lambda content: content.replace(plain.encode(), b"\xff" * len(raw)))
    assert len(found.complaints) == 1


def test_names_that_say_they_are_utf_8_and_are_not(packed):
    with pytest.raises(GradingError, match="is not a zip file, or it is damaged"):
        packed(("ü.ipynb", ""), change=lambda content: content.replace("ü".encode(), b"\xff\xff"))


def test_a_zip_file_of_a_folder(packed):
    found = packed(("heater submissions/s1001/a.ipynb", "1"), ("heater submissions/s1002.ipynb", "2"))
    assert labels(found) == {"s1001": "heater submissions/s1001/a.ipynb", "s1002": "heater submissions/s1002.ipynb"}
    assert labels(packed(("other/s1001/a.ipynb", "1"))) == {}


def info(name, mode=0):
    member = zipfile.ZipInfo(name)
    member.external_attr = mode << 16
    return member


@pytest.mark.parametrize(
    ("name", "says"),
    [
        ("../s1001.ipynb", "has a path that leads out of the folder"),
        ("s1001/../../x.ipynb", "has a path that leads out of the folder"),
        ("../.ssh/x.ipynb", "has a path that leads out of the folder"),
        ("..\\s1001.ipynb", "has a path that leads out of the folder"),
        ("/s1001.ipynb", "has an absolute path"),
        ("/", "has an absolute path"),
        ("C:\\s1001.ipynb", "has an absolute path"),
        (info("s1001.ipynb", stat.S_IFLNK | 0o777), "is a symbolic link, which is not followed"),
        (info("s1001.ipynb", stat.S_IFCHR | 0o666), "is not a file but a device, a pipe or a socket"),
        ("s1001/1/2/3/4/5/6/a.ipynb", "is nested deeper than 6 folders"),
        (f"s1001/{'x' * 300}.ipynb", "has a name longer than any file has"),
        ("s1001/a.py", "is not a notebook (.ipynb)"),
        ("mallory.ipynb", "is named after no student of the roster"),
    ],
)
def test_members_that_are_left_alone(packed, name, says):
    found = packed((name, "1"), ("s1002.ipynb", "2"))
    assert labels(found) == {"s1002": "s1002.ipynb"}
    (complaint,) = found.complaints
    shown = getattr(name, "filename", name).replace("\\", "/")
    assert complaint.replace("\\", "/").startswith(shown[:100])
    assert complaint.endswith(f": {says}")


def test_members_that_cannot_be_unpacked_safely(packed):
    def encrypted(content):
        place = content.index(b"PK\x01\x02") + 8
        return content[:place] + bytes([content[place] | 1]) + content[place + 1 :]

    assert packed(("s1001.ipynb", "1"), change=encrypted).complaints == ("s1001.ipynb: is encrypted",)
    (complaint,) = packed(("s1001.ipynb", "1"), compression=zipfile.ZIP_BZIP2).complaints
    assert complaint == "s1001.ipynb: is compressed in a way that the systems do not use"


def test_two_members_of_one_name(packed):
    with pytest.warns(UserWarning, match="Duplicate name"):
        found = packed(("s1001.ipynb", "1"), ("s1001.ipynb", "2"))
    assert found.submissions[0].problem == "two notebooks: s1001.ipynb and s1001.ipynb; keep one"


def test_a_zip_bomb_is_known_by_what_is_read(packed, monkeypatch):
    monkeypatch.setattr(submissions, "LARGEST", 2**20)
    bomb = ("s1001.ipynb", b" " * (2**20 + 1))
    assert packed(bomb).submissions[0].problem == "is larger than 1 MiB"

    def smaller(content):
        """The same, announced as a thousand bytes."""
        place = content.index(b"PK\x01\x02") + 24
        return content[:place] + (1000).to_bytes(4, "little") + content[place + 4 :]

    (found,) = packed(bomb, change=smaller).submissions
    assert found.problem == ""
    with pytest.raises(GradingError, match=r"^s1001.ipynb: (is larger than|cannot be read: )"):
        found.read()


def test_damaged_zip_files(packed, tmp_path):
    def torn(content):
        place = content.index(b"Jupyter")
        return content[:place] + b"Jupiter" + content[place + 7 :]

    (found,) = packed(("s1001.ipynb", "Jupyter"), compression=zipfile.ZIP_STORED, change=torn).submissions
    with pytest.raises(GradingError, match=r"s1001.ipynb: cannot be read: Bad CRC-32"):
        found.read()
    for change in (lambda content: content[:-30], lambda content: b"", lambda content: b"{}"):
        with pytest.raises(GradingError, match="is not a zip file, or it is damaged"):
            packed(("s1001.ipynb", "1"), change=change)
    (found,) = packed(("s1001.ipynb", "1")).submissions
    packed(("s1001.ipynb", "another"))
    with pytest.raises(GradingError, match="the zip file has changed"):
        found.read()


@given(st.integers(0, 10**6), st.binary(min_size=1, max_size=3))
def test_no_damage_does_more_than_say_so(tmp_path_factory, place, noise):
    memory = io.BytesIO()
    with zipfile.ZipFile(memory, "w", zipfile.ZIP_DEFLATED) as archive:
        archive.writestr("s1001.ipynb", "{}" * 50)
        archive.writestr("s1002/a.ipynb", "{}")
    content = bytearray(memory.getvalue())
    place %= len(content)
    content[place : place + len(noise)] = noise
    path = tmp_path_factory.getbasetemp() / "damaged.zip"
    path.write_bytes(content)
    found, problem = attempted(collect, path, CLASS, "a")
    for submission in found.submissions if found else ():
        problem += attempted(submission.read)[1]
    entries._archive.cache_clear()
    assert "\n" not in problem


def test_too_many_members(packed, monkeypatch):
    monkeypatch.setattr(entries, "MOST", 3)
    with pytest.raises(GradingError, match="more than 3 files and folders: expected those of one class"):
        packed(*((f"{number}.ipynb", "") for number in range(4)))
