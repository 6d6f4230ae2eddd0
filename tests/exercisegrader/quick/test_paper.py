"""An assignment on paper: sheets with each student's own numbers, and answers that are typed into a table."""

import csv
import io
import re
import shutil
from dataclasses import replace

import pytest

from assignments import HEAD, ONE, students
from exercisegrader import GradingError
from exercisegrader.assignment import Assignment
from exercisegrader.grade import grade
from exercisegrader.paper import sheets
from exercisegrader.release import asked
from exercisegrader.released import Released

CLASS = students("Ada Byron", "Bob <Bode>", "Eve")
SOURCE = HEAD.replace("import *", "import *\nCREDIT = Credit(unit=50)") + (
    '@exercise("1", title="Times", points=4)\ndef first(x=between(1, 9, "m"), T=between(20, 40, "s")):\n'
    '    "x is {x}, T is {T}"\n'
    '    return answers(y=number(2 * x, "m"), t=number(T, "s", "the time"),\n'
    '        k=figure("the sketch", key="what to look for"))\n'
    '@first.mistake("(25 %) That is once.")\ndef _(x):\n    return {"y": x}\n'
)


@pytest.fixture
def given(tmp_path, monkeypatch):
    """An assignment in a file, whose PDFs hold their HTML."""
    monkeypatch.setattr(sheets, "browser", lambda: "")
    monkeypatch.setattr(sheets, "printed", lambda text, chromium: text.encode())
    (tmp_path / "times.py").write_text(SOURCE, encoding="utf-8")
    return Assignment.of(SOURCE, "times", tmp_path / "times.py")


def numbers(assignment, student):
    return Released.of(assignment).numbers(student)


def rows_of(path):
    return list(csv.reader(io.StringIO(path.read_text(encoding="utf-8-sig"))))


def test_sheets_have_own_numbers_and_nothing_of_the_key(given, tmp_path):
    done = sheets.release(given, CLASS, tmp_path / "papers")
    assert [path.relative_to(tmp_path).as_posix() for path in done.paths] == [
        f"papers/s{1001 + k}/times.pdf" for k in range(3)
    ]
    for student, path in zip(CLASS, done.paths, strict=True):
        text, own = path.read_text(encoding="utf-8"), numbers(given, student.id)
        assert f"x is {own['1']['x']} m, T is {own['1']['T']} s" in text.replace("\N{NO-BREAK SPACE}", " ")
        assert f"&lt;code&gt;{student.id}&lt;/code&gt; · times" in text
        assert text.count("class='line'") == 2
        assert text.count("class='line box'") == 1
        assert not re.search(r"what to look for|That is once", text)
    assert "Bob &lt;Bode&gt;" in done.paths[1].read_text(encoding="utf-8")
    key = (done.beside / "times_key.pdf").read_text(encoding="utf-8")
    for student in CLASS:
        kind = given.question(student.id, "1").key["y"]
        assert f"<td>{kind.solution}</td>" in key
    assert (done.beside / "times_all.pdf").read_text(encoding="utf-8").count("<article") == 3
    assert rows_of(done.beside / "times_answers.csv")[:2] == [
        ["id", "name", "1 y", "1 t"], ["s1001", "Ada Byron", "", ""]
    ]  # fmt: skip


def test_released_again_numbers_and_what_was_typed_stay(given, tmp_path):
    table = sheets.release(given, CLASS[:2], tmp_path / "papers").beside / "times_answers.csv"
    table.write_text(table.read_text(encoding="utf-8").replace("Byron,,", "Byron,7,"), encoding="utf-8")
    before = numbers(given, "s1001")
    mended = Assignment.of(SOURCE.replace("between(1, 9,", "between(50, 90,"), "times", given.path)
    assert any("other ranges" in one for one in sheets.release(mended, CLASS, tmp_path / "papers").remarks)
    assert numbers(mended, "s1001") == before
    assert [row[:3] for row in rows_of(table)[1:]] == [
        ["s1001", "Ada Byron", "7"], ["s1002", "Bob <Bode>", ""], ["s1003", "Eve", ""]
    ]  # fmt: skip


def test_what_is_typed_is_judged_as_in_a_notebook(given, tmp_path):
    table = sheets.release(given, CLASS, tmp_path / "papers").beside / "times_answers.csv"
    own = {one.id: {name: float(text) for name, text in numbers(given, one.id)["1"].items()} for one in CLASS}
    ada, bob = own["s1001"], own["s1002"]
    lines = [
        "1 t;id;1 y",
        f"{ada['T'] / 60:.6g} min;S1001;{2 * ada['x']:g}".replace(".", ","),
        f"{bob['T'] / 60:.6g};s1002;{bob['x']:g}",
        ";s1003;",
    ]
    table.write_text("\n".join(lines), encoding="utf-8")
    done = grade(given, CLASS, table, tmp_path / "grades")
    assert (done.graded, done.missing, done.failures) == (2, 1, ())
    points = {
        row["id"]: row for row in csv.DictReader(io.StringIO((tmp_path / "grades/points.csv").read_text("utf-8-sig")))
    }
    third = 4 / 3
    assert [float(points["s1001"][name]) for name in ("1 y", "1 t", "1 k")] == [pytest.approx(third, abs=0.01)] * 2 + [
        0
    ]
    assert float(points["s1002"]["1 y"]) == pytest.approx(third / 4, abs=0.01)  # the named mistake
    assert float(points["s1002"]["1 t"]) == pytest.approx(third / 2, abs=0.01)  # the other unit
    assert points["s1003"]["state"] == "missing"
    assert grade(given, CLASS, table, tmp_path / "grades").kept == 2
    lines[1] = lines[1].replace("min", "s")
    table.write_text("\n".join(lines), encoding="utf-8")
    assert grade(given, CLASS, table, tmp_path / "grades").graded == 1


@pytest.mark.parametrize(
    ("table", "says"),
    [
        (
            "id,1 y,1 t\ns9,1,2\n,1,2\ns1001,1,2\ns1001,3,4",
            ["no student 's9'", "without an id", "a row already, line 4"],
        ),
        ("id,1 y\ns1001,1", ["there is no column '1 t'"]),
        ("id,1 y,1 t\ns1003,1,2", ["answers of s1003, to whom nothing was released"]),
        ("id,1 y,1 t,1 T\ns1001,1", ["nothing is asked as '1 T'"]),
        ("id,1 y,1 y,1 t\ns1001,1", ["there are two columns '1 y'"]),
    ],
)
def test_all_faults_of_a_table_are_told_and_nothing_is_graded(given, tmp_path, table, says):
    sheets.release(given, CLASS[:2], tmp_path / "papers")
    (tmp_path / "typed.csv").write_text(table, encoding="utf-8")
    with pytest.raises(GradingError) as told:
        grade(given, CLASS, tmp_path / "typed.csv", tmp_path / "grades")
    assert all(one in str(told.value) for one in says), str(told.value)


def test_an_assignment_may_have_its_exercises_in_a_list():
    source = HEAD + ONE.format('"1"', 1, "y=x") + "EXERCISES = [first]\ndel first\n"
    assert [*Assignment.of(source, "list").exercises] == ["1"]
    assert [*Assignment.of(source.replace("[first]", "[first.question()]"), "of_variants").exercises] == ["1"]


def test_what_paper_cannot_hold_is_said(monkeypatch):
    source = HEAD + ONE.format('"1"', 1, "y=x") + "import numpy\nfirst.shows(lambda: {'t': numpy.arange(float(<n>))})\n"
    for n, is_refused in ((40, False), (41, True)):
        assignment = Assignment.of(source.replace("<n>", str(n)), "data")
        questions = {"1": asked(assignment, "s1001", "1")}
        if is_refused:
            with pytest.raises(GradingError, match=r"no sheet holds .* exercise .*\(41 of t\): expected at most 40"):
                sheets.sheets(assignment, CLASS[0], questions)
        else:
            assert "<td>39</td>" in sheets.sheets(assignment, CLASS[0], questions)
    monkeypatch.setattr(sheets, "BROWSERS", ())
    with pytest.raises(GradingError, match="no browser here to print with: install Chromium"):
        sheets.browser()


@pytest.mark.skipif(not any(map(shutil.which, sheets.BROWSERS)), reason="no browser: nothing was printed")
def test_a_browser_cuts_into_sheets(given, monkeypatch):
    pypdf = pytest.importorskip("pypdf")
    monkeypatch.undo()
    long = replace(given, introduction="\n\n".join(["A long introduction."] * 60))
    parts = []
    for one in CLASS[:2]:
        parts.append(sheets.sheets(long, one, {"1": asked(given, one.id, "1")}))
    pages = pypdf.PdfReader(io.BytesIO(sheets.printed(sheets.page("Times", parts), sheets.browser()))).pages
    feet = [re.search(r"(s100\d) · times\s*(sheet.+|this.+)", page.extract_text()).groups() for page in pages]
    ends = ["sheet 1 of 3", "sheet 2 of 3", "sheet 3 of 3", "this side is empty"]
    assert feet == [(student, end) for student in ("s1001", "s1002") for end in ends]
