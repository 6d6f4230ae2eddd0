"""The term of the example course: its commands do what its page says."""

import csv
import json
import re
import runpy
import subprocess
import sys
import zipfile
from pathlib import Path

import pytest

from needs import needs_jail

COURSE = Path(__file__).parents[2] / "examples" / "course"


def table(path):
    """The rows of a CSV file as dictionaries."""
    with path.open(encoding="utf-8-sig", newline="") as file:
        return list(csv.DictReader(file))


def points(path, head="points"):
    """The points by id, as they are written."""
    return {row["id"]: row[head] for row in table(path)}


@pytest.fixture(scope="module")
def term(tmp_path_factory):
    folder = tmp_path_factory.mktemp("term") / "course"
    said = subprocess.run(
        [sys.executable, COURSE / "term.py", folder], capture_output=True, text=True, encoding="utf-8"
    )
    assert said.returncode == 0, said.stdout[-3000:] + said.stderr[-3000:]
    return folder, said.stdout + said.stderr


def page():
    return (COURSE / "README.md").read_text(encoding="utf-8")


def test_every_command_of_the_page_is_run():
    command = runpy.run_path(str(COURSE / "term.py"))["COMMAND"]
    lines = command.findall(page())
    assert len(lines) > 20
    assert {line.split()[0] for line in lines} == {"loopbook", "python", "echo", "sed", "mkdir", "mv"}


def test_the_class_of_the_page_is_the_one_that_hands_in():
    listed = re.findall(r"^\| (s10\d\d) \|", page(), re.MULTILINE)
    handed_in = {student for student, *_ in runpy.run_path(str(COURSE / "hand_in.py"))["AIR_HEATER"]}
    assert listed == [f"s10{k:02}" for k in range(1, 14)]
    assert set(listed) - handed_in == {"s1011"}


@needs_jail
class TestATerm:
    def test_nothing_surprises_in_either_assignment(self, term):
        assert term[1].count("nothing surprising") == 2

    def test_who_joins_has_the_new_range_and_the_others_keep_their_numbers(self, term):
        folder, said = term
        record = json.loads((folder / "air_heater.released.json").read_text(encoding="utf-8"))
        assert list(record["students"])[-1] == "s1013"
        assert "13 notebooks of 'Tuning the air heater' in released: 1 new, 12 unchanged" in said
        assert "other ranges than at the release: step in exercise 1" in said

    def test_the_grades_of_the_first_assignment_are_those_of_the_page(self, term):
        full = dict.fromkeys(["s1001", "s1004", "s1006", "s1007", "s1008", "s1012", "s1013"], "15")
        assert points(term[0] / "grades" / "air_heater" / "grades.csv") == full | {
            "s1002": "0",  # each of them a mistake
            "s1003": "7",  # two days late, with an extension
            "s1005": "12.15",  # 12 of the grader's and 1.5 of the instructor's, a tenth less for a day
            "s1009": "0",  # as the instructor said
            "s1010": "0",
            "s1011": "",
        }

    def test_the_marks_of_the_instructor_are_all_there(self, term):
        rows = table(term[0] / "grades" / "air_heater" / "marks.csv")
        assert [(row["student"], row["exercise"], row["points"]) for row in rows] == [
            ("s1005", "3", "1.5"),
            ("s1009", "", "0"),
        ]

    def test_canvas_gets_its_own_heads(self, term):
        grades = table(term[0] / "grades" / "air_heater" / "canvas_grades.csv")
        assert grades[0]["Tuning the air heater (4711)"] == "15"
        sent = {row["SIS User ID"]: row["Tuning the air heater (4711)"] for row in grades[1:]}
        assert sent == points(term[0] / "grades" / "air_heater" / "grades.csv")

    def test_what_waited_is_marked_and_moodle_gets_its_worksheet(self, term):
        folder = term[0] / "grades" / "closed_loop"
        assert "11 answers to be marked" in term[1]
        marked = {part: table(folder / "to_mark" / f"{part}.csv") for part in ("Monday", "Thursday")}
        assert {part: len(rows) for part, rows in marked.items()} == {"Monday": 7, "Thursday": 4}
        assert all(row["points"] and not row["student"].startswith("s1") for rows in marked.values() for row in rows)
        filled = {row["ID number"]: row["Grade"] for row in table(folder / "moodle_grades.csv")}
        assert {student for student, grade in filled.items() if grade} == {
            "s1001", "s1002", "s1004", "s1005", "s1007", "s1013",
        }  # fmt: skip
        with zipfile.ZipFile(folder / "moodle_feedback.zip") as archive:
            assert any("Océane Lefèvre" in name for name in archive.namelist())

    def test_the_term_has_one_table(self, term):
        folder, said = term
        rows = {row["id"]: row for row in table(folder / "grades" / "term.csv")}
        assert len(rows) == 13
        both = rows["s1001"]
        assert both["air_heater of 15"] == "15"
        assert both["section"] == "Monday"
        late, only = rows["s1013"], float(rows["s1013"]["closed_loop of 7"])
        assert late["air_heater of 15"] == "excused"
        assert float(late["total in percent"]) == pytest.approx(100 * only / 7, abs=0.01)
        assert (rows["s1011"]["air_heater of 15"], rows["s1011"]["total in percent"]) == ("missing", "0")
        assert "air_heater: s1011 missing, which counts as nothing" in said

    def test_the_notebook_of_the_complaint_is_kept(self, term):
        kept = (term[0] / "grades" / "air_heater" / "notebooks" / "s1005.html").read_text(encoding="utf-8")
        assert "NameError" in kept
