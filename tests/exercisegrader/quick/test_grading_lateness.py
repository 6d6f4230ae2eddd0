"""What is late and what it costs: due dates, policies, extensions, zones."""

import datetime
import itertools
import re
from datetime import timedelta

import pytest

from assignments import HEAD, ONE, written
from exercisebook.late import Late
from exercisegrader import GradingError
from exercisegrader.assignment import Assignment
from exercisegrader.lateness import Policy, lasting, lateness, moment, read_extensions, without_dates
from exercisegrader.student import Roll

DUE = "2026-12-01 23:59 Europe/Berlin"
UTC = datetime.UTC

# Moments.


@pytest.mark.parametrize(
    ("text", "iso"),
    [
        ("2026-12-01 23:59", "2026-12-01T23:59:59.999999"),
        (" 2026-12-01T09:05:07 ", "2026-12-01T09:05:59.999999"),
        ("2026-12-01 23:59 +02:00", "2026-12-01T23:59:59.999999+02:00"),
        ("2026-12-01 23:59 UTC", "2026-12-01T23:59:59.999999+00:00"),
        ("2026-07-01 23:59 Europe/Berlin", "2026-07-01T23:59:59.999999+02:00"),
        ("2026-12-01", "2026-12-01T23:59:59.999999"),
        ("2026-12-01 Asia/Tokyo", "2026-12-01T23:59:59.999999+09:00"),
    ],
)
def test_a_moment_is_the_last_one_that_the_text_means(text, iso):
    assert moment(text).isoformat() == iso


@pytest.mark.parametrize(
    ("text", "says"),
    [
        ("tomorrow", "'tomorrow' is not a date and time: expected one as 2026-12-01 23:59"),
        ("", "'' is not a date and time"),
        ("2026-12-01 11:59 PM", "there is no time zone 'PM'"),
        ("2026-02-30", "'2026-02-30' is not a date and time"),
        ("2026-12-01 25:00", "'2026-12-01 25:00' is not a date and time"),
        ("01.12.2026 23:59", "'01.12.2026 23:59' is not a date and time"),
        ("2026-12-01 23:59 Europe/Berlon", "there is no time zone 'Europe/Berlon': did you mean 'Europe/Berlin'?"),
        ("2026-12-01 23:59 Nowhere", "expected one such as Europe/Berlin"),
    ],
)
def test_what_is_no_moment_is_said(text, says):
    with pytest.raises(ValueError, match=re.escape(says)):
        moment(text)


# Policies.


@pytest.mark.parametrize(
    ("late", "costs"),
    [
        (Late(10, "day"), {0.1: 0.1, 24: 0.1, 24.1: 0.2, 9 * 24: 0.9, 30 * 24: 1}),
        (Late(2.5, "hour", at_most=30), {0.5: 0.025, 1.5: 0.05, 48: 0.3}),
        (Late(50, "week"), {1: 0.5, 169: 1}),
        (Late(20, grace_minutes=120), {2: 0, 2.1: 0.2, 100: 0.2}),
        (Late(10, "day", grace_minutes=60), {1: 0, 1.1: 0.1, 25: 0.1, 25.1: 0.2}),
        (Late(10, "day", at_most=50, accepted_days=2), {48: 0.2, 48.1: 1}),
        (Late(accepted_days=1), {24: 0, 24.1: 1}),
        (Late(accepted_days=0, grace_minutes=60), {1: 0, 1.1: 1}),
    ],
)
def test_what_it_costs_to_be_late(late, costs):
    assert {hours: late.costs(timedelta(hours=hours)) for hours in costs} == pytest.approx(costs)


@pytest.mark.parametrize(
    ("lines", "says"),
    [
        ("DUE = 3", "heater.py: DUE is 3: expected a text"),
        ('DUE = "soon"', "heater.py: DUE: 'soon' is not a date and time"),
        ('DUE = "2026-12-01"', "DUE: '2026-12-01' names no time zone: expected one, as in '2026-12-01 Europe/Berlin'"),
        ("LATE = Late(20)", "heater.py: there is LATE and no DUE: expected a text such as"),
        (
            f'DUE = "{DUE}"; LATE = "10 % a day, 15 min grace"',
            "heater.py: LATE is '10 % a day, 15 min grace': expected one as Late(percent=10, per=\"day\", "
            "grace_minutes=15, at_most=50, accepted_days=7), with Late from exercisebook.authoring",
        ),
        ("LATE = Late(percent=120)", "heater.py, line 4: ValueError: percent is 120: expected a number from 0 to 100"),
        ("LATE = Late(10, per='month')", "per is 'month': expected one of hour, day, week"),
        ("LATE = Late(10, grace_minutes='15')", "grace_minutes is '15': expected a number from 0"),
        ("LATE = Late(10, accepted_days=-1)", "accepted_days is -1: expected a number from 0"),
        ("LATE = Late(grace_minutes=15)", "costs nothing: expected a percent above 0, as in Late(percent=20)"),
    ],
)
def test_what_is_wrong_with_the_dates_of_an_assignment_is_said(lines, says):
    with pytest.raises(GradingError, match=re.escape(says)):
        Assignment.of(HEAD + lines + "\n" + ONE.format('"1"', 1, "y=x"), "heater")


def test_an_assignment_has_its_policy():
    late = 'Late(10, "day", grace_minutes=15, at_most=50, accepted_days=7)'
    source = HEAD + f'DUE = "{DUE}"\nLATE = {late}\n' + ONE.format('"1"', 1, "y=x")
    terms = "10 % a day, 15 min grace, at most 50 %, not accepted after 7 days"
    assert str(Assignment.of(source, "heater").policy) == f"due {DUE}; late: {terms}"
    assert Assignment.of(HEAD + ONE.format('"1"', 1, "y=x"), "heater").policy is None


def test_another_due_date_is_no_reason_to_grade_again():
    lines = ("", 'DUE = "2026-12-01 UTC"\n', 'DUE = "2026-12-02 UTC"  # later\nLATE = Late(\n    percent=10,\n)\n')
    assert len({Assignment.of(written() + one, "tuning").fingerprint for one in lines}) == 1


@pytest.mark.parametrize(
    "source", ['x = 1; DUE = "2026-12-01"\n', 'DUE = "2026-" + "12-01"\n', 'if True:\n    DUE = "2026-12-01"\n']
)
def test_what_may_be_more_than_a_date_stays_part_of_the_assignment(source):
    assert without_dates(source) == source


# How late a submission is.


DAILY, USUAL = Late(10, "day"), Late(10, "day", grace_minutes=15, at_most=50)


def late(at, terms=USUAL, due=DUE, until=None):
    until = until and moment(until, moment(due).tzinfo)
    return lateness(Policy(moment(due), terms), at if isinstance(at, datetime.datetime) else moment(at), until=until)


@pytest.mark.parametrize(
    ("at", "part", "says"),
    [
        ("2026-12-01 23:59", 0, ""),
        ("2026-12-02 00:10", 0, f"handed in 11 min late (due {DUE}), within the grace of 15 min: nothing is deducted"),
        ("2026-12-02 00:20", 0.1, f"handed in 21 min late (due {DUE}): 10 % of the points are deducted"),
        ("2026-12-03 02:00", 0.2, "handed in 1 day 2 h late"),
        ("2027-03-01", 0.5, "handed in 90 days late"),
    ],
)
def test_a_time_without_a_zone_is_of_the_place_of_the_due_date(at, part, says):
    found = late(at)
    assert found.part == pytest.approx(part)
    assert found.says.startswith(says)
    assert bool(found.says) == bool(says)
    assert not found.look


def test_a_time_with_a_zone_is_compared_as_such():
    assert late(datetime.datetime(2026, 12, 1, 22, 59, tzinfo=UTC)).says == ""
    found = late(datetime.datetime(2026, 12, 1, 23, 30, tzinfo=UTC))
    assert found.says.startswith("handed in 30 min late")


def test_a_day_is_one_by_the_clock_on_the_wall():
    due = "2026-10-24 23:59 Europe/Berlin"  # the next day has 25 hours
    assert late("2026-10-25 23:59", DAILY, due).part == pytest.approx(0.1)
    assert late(datetime.datetime(2026, 10, 25, 22, 59, tzinfo=UTC), DAILY, due).part == pytest.approx(0.1)
    assert late("2026-10-25 23:59", Late(1, "hour"), due).part == pytest.approx(0.25)
    again = datetime.datetime(2026, 10, 25, 1, 30, tzinfo=UTC)  # 2:30 for the second time
    found = late(again, DAILY, "2026-10-25 02:45 Europe/Berlin")
    assert found.part == pytest.approx(0.1)


def test_an_extension_is_another_due_date():
    assert late("2026-12-04 12:00", until="2026-12-04").says == (
        "in time by an extension to 2026-12-04 23:59 Europe/Berlin"
    )
    found = late("2026-12-05 12:00", until="2026-12-04")
    assert found.part == pytest.approx(0.1)
    assert "(extended to 2026-12-04 23:59 Europe/Berlin)" in found.says
    assert late("2026-12-01 12:00", until="2026-12-04").says == ""
    for terms, delay in itertools.product((DAILY, Late(4, "hour")), (0.5, 1, 1.5, 30, 99)):
        policy, by = Policy(moment(DUE), terms), timedelta(hours=delay)
        until = policy.due + timedelta(days=3)
        parts = lateness(policy, until + by, until=until).part, lateness(policy, policy.due + by).part
        assert parts[0] == parts[1] > 0


def test_what_is_not_accepted_any_more():
    assert late("2026-12-09", Late(10, "day", accepted_days=7)).says.endswith(
        "after the last day on which it is accepted: all points are deducted"
    )


def test_late_by_an_unknown_time_costs_nothing_and_is_told():
    policy = Policy(moment(DUE), DAILY)
    found = lateness(policy, late=True)
    assert (found.part, found.says) == (0, "handed in late, by how much is not known: nothing is deducted")
    assert "add a column handed_in to the roster, or a row to marks.csv" in found.look
    assert "extension to 2026-12-04" in lateness(policy, late=True, until=moment("2026-12-04", UTC)).look
    assert lateness(policy) == lateness(policy, late=False) == lateness(None)
    assert lateness(None, late=True).says == "handed in late, says the learning management system"
    assert lateness(policy, moment("2026-12-01"), late=True).says == ""  # a time says more than a word


@pytest.mark.parametrize(
    ("span", "words"),
    [(timedelta(minutes=59), "59 min"), (timedelta(days=2, minutes=5), "2 days"), (timedelta(hours=1), "1 h")],
)
def test_lengths_of_time_in_words(span, words):
    assert lasting(span) == words


# Extensions.


@pytest.fixture
def extensions(tmp_path):
    def read(text, due=DUE, also=None, former=()):
        path = tmp_path / "extensions.csv"
        path.write_bytes(text if isinstance(text, bytes) else text.encode())
        roll = Roll(["s1001", "s1002", "s1003"], also, former)
        return read_extensions(path, roll, "heater", due and Policy(moment(due)))

    return read


@pytest.mark.parametrize("delimiter", [",", ";", "\t"])
def test_extensions(extensions, delimiter):
    lines = ["Student,Until,Assignment,why", "S1001,2026-12-05 12:00,,ill", "s1002,2026-12-05,Heater,"]
    found = extensions("\ufeff" + "\r\n".join([*lines, "s1003,x,other,", ",,,"]).replace(",", delimiter))
    assert {name: f"{until:%m-%d %H:%M %z}" for name, until in found[0].items()} == {
        "s1001": "12-05 12:00 +0100", "s1002": "12-05 23:59 +0100",
    }  # fmt: skip
    assert found[1] == ["extensions.csv, of no effect here: s1003, for the assignment 'other'"]


def test_of_several_extensions_the_latest_counts(extensions):
    rows = "s1001,,2026-12-05\ns1001,heater,2026-12-03\ns1002,,2026-12-03\ns1002,,2026-12-04"
    found = extensions(f"student,assignment,until\n{rows}\n")
    assert [found[0][name].day for name in ("s1001", "s1002")] == [5, 4]


def test_an_extension_is_of_the_place_of_the_due_date(extensions):
    (until,) = extensions("student,until\ns1001,2026-12-05 12:00Z\n")[0].values()
    assert f"{until:%H:%M %z}" == "13:00 +0100"


def test_an_extension_by_another_id_of_the_student(extensions):
    assert [*extensions("student,until\nA17,2026-12-05\n", also={"a17": "s1001"})[0]] == ["s1001"]


@pytest.mark.parametrize(
    ("student", "until", "more", "note"),
    [
        ("s1001", "2026-11-05", {}, "s1001, before the due date"),
        ("s9", "2026-12-05", {"former": {"s9"}}, "s9, no longer on the roster"),
        ("s1001", "2026-12-05", {"due": None}, "s1001, heater has no DUE"),
    ],
)
def test_extensions_that_have_no_effect_are_told(extensions, student, until, more, note):
    found = extensions(f"student,until\n{student},{until}\n", **more)
    assert found == ({}, [f"extensions.csv, of no effect here: {note}"])


def test_all_faults_of_the_extensions_are_told_at_once(extensions):
    with pytest.raises(GradingError) as problem:
        extensions("student,until,assignment\ns1O01,2026-12-05,\ns1001,soon,\n")
    assert str(problem.value).splitlines() == [
        "extensions.csv, line 2: there is no student 's1O01' on the roster: did you mean 's1001'?",
        "extensions.csv, line 3: 'soon' is not a date and time: expected one as 2026-12-01 23:59",
    ]


@pytest.mark.parametrize(
    ("text", "says"),
    [
        ("", "extensions.csv, line 1: there is no column 'student': expected the columns student, until"),
        ("student,untill\ns1001,x\n", "there is no column 'until' ('untill' is none): expected the columns student,"),
        ("student,until,until\n", "there are 2 columns 'until': expected one"),
        ("student,until\ns1001,2026,12\n", "line 2: there are 3 cells below 2 columns: put 'a,b' in quotes"),
        ('student,until\ns1001,"x\n', "no table"),
        ("student,until\n\0", "line 2: no text in UTF-8; save it as CSV UTF-8"),
        (b"student,until,why\ns1001,2026-12-05,f\xfcr\n", "line 2: no text in UTF-8; save it as CSV UTF-8"),
    ],
)
def test_what_is_no_table_of_extensions_is_said(extensions, text, says):
    with pytest.raises(GradingError, match=re.escape(says)):
        extensions(text)
