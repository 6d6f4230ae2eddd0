"""The table of a term: weights, what is dropped, who is excused, and what is not known yet."""

import csv
import re

import pytest
from typer.testing import CliRunner

from exercisegrader import GradingError
from exercisegrader.__main__ import app
from exercisegrader.marking import Marked
from exercisegrader.overrides import Mark
from exercisegrader.reports import write_all
from exercisegrader.term import Term
from small_class import CLASS, MISSING, NAMED, RIGHT_ALL, STOPPED, TITLE, by_hand, changed

HEATER = """id,name,section,state,total,possible
s1,Ada,Mon,graded,12,15
s2,Bo,Tue,graded,9,15
s3,Cy,Tue,missing,,15
"""
LOOP = """\ufeffID;Name;Section;State;Total;Possible
S1;Ada L.;Mon;graded;2,5;5
s2;;;waits;;5
s4;Di;Mon;graded;4;5
"""


@pytest.fixture
def term(tmp_path):
    def made(settings="", **tables):
        for name, table in tables.items():
            (tmp_path / name).mkdir()
            (tmp_path / name / "points.csv").write_text(table, encoding="utf-8")
        if settings:
            (tmp_path / "term.toml").write_text(settings, encoding="utf-8")
        return Term(tmp_path)

    return made


def totals(found):
    return {student: found.of(student)[2] for student in found.students}


def test_each_student_has_a_row_and_each_assignment_a_column(term):
    found = term(heater=HEATER, loop=LOOP)
    assert found.table()[1:].splitlines() == [
        "id,name,section,heater of 15,loop of 5,dropped,total in percent",
        "s1,Ada L.,Mon,12,2.5,,72.5",
        "s2,Bo,Tue,9,waits,,",
        "s3,Cy,Tue,missing,not in the table,,",
        "s4,Di,Mon,not in the table,4,,",
    ]
    assert found.notes() == [
        "heater: s3 missing, which counts as nothing",
        "heater: s4 not in its points.csv: no total before there is a row, or [excused] in term.toml says so",
        "loop: s3 not in its points.csv: no total before there is a row, or [excused] in term.toml says so",
        "loop: s2 waiting for a mark: no total yet",
    ]


def test_what_is_excused_does_not_count(term):
    found = term('[excused]\ns3 = ["loop"]\ns4 = ["heater"]', heater=HEATER, loop=LOOP)
    assert totals(found) == {"s1": pytest.approx(72.5), "s2": None, "s3": 0, "s4": pytest.approx(80)}
    assert "s4,Di,Mon,excused,4,,80" in found.table()
    (_, note) = found.notes()
    assert note == "loop: s2 waiting for a mark: no total yet"


def test_who_is_excused_from_all_has_no_total(term):
    assert totals(term('[excused]\ns1 = ["heater"]', heater=HEATER))["s1"] is None


def test_weights_are_those_of_the_file_in_its_order(term):
    found = term("[weights]\nloop = 3\nheater = 1", heater=HEATER, loop=LOOP)
    assert [*found.points] == ["loop", "heater"]
    assert totals(found)["s1"] == pytest.approx((3 * 50 + 80) / 4)


def test_what_has_no_weight_keeps_nobody_from_a_total(term):
    found = term("[weights]\nloop = 0\nheater = 1", heater=HEATER, loop=LOOP)
    assert totals(found) == {"s1": pytest.approx(80), "s2": pytest.approx(60), "s3": 0, "s4": None}


@pytest.mark.parametrize(
    ("settings", "dropped", "total"),
    [
        ("", "", (8 + 5 + 10) / 30),
        ("[drop]\nlowest = 1", "b", (8 + 10) / 20),
        ("[drop]\nlowest = 7", "b, a", 1),
        ('[drop]\nlowest = 1\nof = ["a", "c"]', "a", (5 + 10) / 20),
        ('[drop]\nlowest = 1\n[excused]\ns1 = ["b"]', "a", 1),
        ("[drop]\nlowest = 1\n[weights]\na = 1\nb = 9\nc = 3", "b", (0.8 + 3) / 4),
    ],
)
def test_the_lowest_in_percent_are_dropped_and_never_the_last(term, settings, dropped, total):
    found = term(
        settings, **{name: f"id,total,possible\ns1,{has},10\n" for name, has in {"a": 8, "b": 5, "c": 10}.items()}
    )
    (_, row) = csv.reader(found.table()[1:].splitlines())
    assert row[-2:] == [dropped, f"{100 * total:.2f}".rstrip("0").rstrip(".")]


@pytest.mark.parametrize(
    ("settings", "says"),
    [
        ("[weight]\nheater = 1", "there is no setting 'weight': did you mean 'weights'?"),
        ("[weights]\nheatr = 1", "there is no assignment 'heatr': did you mean 'heater'?"),
        ("[weights]\nheater = 1", "loop has no weight: expected one, 0 where it does not count"),
        ("[weights]\nheater = -1\nloop = 1", "heater is -1: expected a number from 0"),
        ("[weights]\nheater = true\nloop = 1", "heater is True: expected a number from 0"),
        ("weights = 3", "weights is 3: expected a table"),
        ("[drop]\nlow = 1", "there is no setting 'low': did you mean 'lowest'?"),
        ("[drop]\nlowest = '1'", "lowest is '1': expected a number from 0"),
        ("[drop]\nof = ['lop']", "there is no assignment 'lop': did you mean 'loop'?"),
        ("[excused]\ns9 = []", "there is no student 's9'"),
        ("[excused]\ns1 = 'heater'", "s1 is 'heater': expected names of assignments, in brackets"),
        ("[excused]\ns1 = ['x']", "there is no assignment 'x'"),
        ("[excused", "Expected ']' at the end of a table declaration"),
    ],
)
def test_a_setting_that_is_none_is_told(term, settings, says):
    with pytest.raises(GradingError, match=re.escape(f"term.toml: {says}")):
        term(settings, heater=HEATER, loop=LOOP)


@pytest.mark.parametrize(
    ("table", "says"),
    [
        ("id,points\n", "there is no column 'total'"),
        ("id,total,possible\ns1,x,10\n", "heater: points.csv, line 2: 'x' of '10': expected numbers"),
        ("id,total,possible\ns1,,\n", "line 2: '' of '': expected numbers, the first perhaps none"),
        ("id,total,possible\ns1,1,10\ns1,2,10\n", "line 3: the id is 's1': expected one, and each once"),
    ],
)
def test_what_is_no_table_of_points_is_told(term, table, says):
    with pytest.raises(GradingError, match=re.escape(says)):
        term(heater=table)


def test_the_command_takes_what_grading_leaves(tmp_path):
    assert "has no grades: expected a folder for each" in CliRunner().invoke(app, ["term", str(tmp_path)]).output
    marks = [by_hand(), NAMED, Marked.of(STOPPED.result, {("", ""): Mark(4)}), MISSING]
    write_all(tmp_path / "heater", TITLE, CLASS, marks)
    write_all(tmp_path / "loop", TITLE, CLASS[:1], [changed(RIGHT_ALL, jailed=False)])
    done = CliRunner().invoke(app, ["term", str(tmp_path)])
    assert done.exit_code == 0
    assert "heater: s1004 missing, which counts as nothing" in done.output
    assert "4 students in heater, loop" in done.output
    head, ada, bob, eve, zoe = csv.reader((tmp_path / "term.csv").read_text(encoding="utf-8-sig").splitlines())
    assert head[3:] == ["heater of 9", "loop of 5", "dropped", "total in percent", "graded without a jail"]
    assert ada[:5] == ["s1001", "Ada Lovelace", "A", "waits", "5"]
    assert (bob[3], eve[1], eve[3], zoe[3]) == ("3.67", "'=HYPERLINK(1)", "4", "missing")
