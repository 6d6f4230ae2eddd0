"""What is late, and what that costs: due dates, policies, and extensions for single students.

``DUE`` and ``LATE`` in the module of an assignment are texts for people::

    DUE = "2026-12-01 23:59 Europe/Berlin"
    LATE = "10 % a day, 15 min grace, at most 50 %"

A time without seconds lasts to the end of its minute, a date without a time to the end of its day. Days are counted
from the due date, those that have begun, by the clock on the wall; what comes within the grace costs nothing, and days
are then counted from its end. The percentage is one of what was earned. Times that name no zone are of the same place
as the due date; where that names none either, all of them are of one place, and a time with a zone is refused.
"""

from __future__ import annotations

import ast
import datetime
import math
import re
import zoneinfo
from collections.abc import Collection, Iterable, Mapping
from dataclasses import dataclass
from datetime import timedelta
from pathlib import Path

from exercisebook.judging import harmless
from exercisegrader import GradingError
from exercisegrader.spreadsheet import Faults, read
from plainmath.validation import did_you_mean

_LENGTHS = {
    "minute": timedelta(minutes=1), "hour": timedelta(hours=1), "day": timedelta(days=1), "week": timedelta(weeks=1),
}  # fmt: skip
_SHORT = {"min": "minute", "h": "hour", "d": "day", "w": "week"}
#: How the sentence on an extension begins.
IN_TIME = "in time by"
_END = datetime.time(23, 59, 59, 999999)
_DATES = (
    r"(?P<year>\d{4})-(?P<month>\d\d?)-(?P<day>\d\d?)",
    r"(?P<day>\d\d?)\.\s?(?P<month>\d\d?)\.\s?(?P<year>\d{4})",
    r"(?P<first>\d\d?)/(?P<second>\d\d?)/(?P<year>\d{4})",
)
_TIME = (
    r"(?:(?:\s*T|,?\s+)(?P<hour>\d\d?):(?P<minute>\d\d)(?::(?P<seconds>\d\d)(?:\.\d*)?)?"
    r"\s*(?P<half>[AaPp]\.?[Mm]\.?)?)?"
)
_ZONE = r"\s*(?P<zone>Z|[+-]\d\d:?\d\d|[A-Za-z][\w+/-]*)?"
_MOMENTS = tuple(re.compile(date + _TIME + _ZONE) for date in _DATES)

_AMOUNT = r"(\d+(?:[.,]\d+)?)"
_UNIT = r"(min|minute|h|hour|d|day|w|week)s?"
_PARTS = {
    "a_unit": re.compile(rf"{_AMOUNT} ?% (?:an?|per|each|every|for each) (?:started )?{_UNIT}(?: late)?"),
    "once": re.compile(rf"{_AMOUNT} ?%"),
    "grace": re.compile(rf"{_AMOUNT} ?{_UNIT} (?:of )?grace"),
    "at_most": re.compile(rf"(?:at most|maximum|max\.?) {_AMOUNT} ?%"),
    "nothing": re.compile(rf"(?:nothing counts|not accepted) after {_AMOUNT} ?{_UNIT}"),
}
_EXAMPLES = (
    "'none', '10 % a day', '20 %', '15 min grace', 'at most 50 %' or 'not accepted after 7 days'"
)  # fmt: skip


def moment(text: str, zone: datetime.tzinfo | None = None) -> datetime.datetime:
    """Return the last moment that a text means: of its minute, where it has no seconds; of its day, without a time.

    Arguments:
        text: a date, as 2026-12-01 or as a spreadsheet writes it (1.12.2026, 12/31/2026), and perhaps a time and a
            zone: Europe/Berlin, UTC, +01:00.
        zone: for a text without one.
    Raises:
        ValueError: in a sentence, for what is no date, for a date that means two days, and for an unknown zone.

    >>> moment("2026-12-01 23:59 Europe/Berlin").isoformat()
    '2026-12-01T23:59:59.999999+01:00'
    >>> moment("31.12.2026").isoformat(), moment("12/31/2026 1:30 PM").isoformat()
    ('2026-12-31T23:59:59.999999', '2026-12-31T13:30:59.999999')
    """
    found = next((match for one in _MOMENTS if (match := one.fullmatch(" ".join(str(text).split())))), None)
    if not found:
        raise ValueError(f"{harmless(repr(text))} is not a date and time: expected one such as 2026-12-01 23:59")
    parts = found.groupdict()
    try:
        date = datetime.date(int(parts["year"]), *_month_and_day(parts, text))
        when = datetime.datetime.combine(date, _time(parts))
    except ValueError as problem:
        raise ValueError(
            f"{harmless(repr(text))} is not a date and time ({problem}): expected one such as 2026-12-01 23:59"
        ) from None
    return when.replace(tzinfo=_zone(parts["zone"]) if parts["zone"] else zone)


def _month_and_day(parts, text):
    if "month" in parts:
        return int(parts["month"]), int(parts["day"])
    first, second = int(parts["first"]), int(parts["second"])
    if first != second and first <= 12 and second <= 12:
        raise ValueError("it may mean two days")
    return (first, second) if first <= 12 else (second, first)


def _time(parts):
    if parts["hour"] is None:
        return _END
    hour, minute = int(parts["hour"]), int(parts["minute"])
    if parts["half"]:
        if not 1 <= hour <= 12:
            raise ValueError("hour must be in 1..12")
        hour = hour % 12 + (12 if parts["half"][0] in "pP" else 0)
    elif (hour, minute) == (24, 0):
        return _END
    if parts["seconds"] is None:
        return datetime.time(hour, minute, 59, 999999)
    return datetime.time(hour, minute, int(parts["seconds"]), 999999)


def _zone(name):
    if name in ("Z", "UTC"):
        return datetime.UTC
    if name[0] in "+-":
        hours, minutes = int(name[1:3]), int(name[-2:])
        return datetime.timezone(timedelta(hours=hours, minutes=minutes) * (-1 if name[0] == "-" else 1))
    try:
        return zoneinfo.ZoneInfo(name)
    except (KeyError, OSError, ValueError):
        known = zoneinfo.available_timezones()
    if not known:
        raise ValueError(f"this machine has no list of time zones, in which {name} would be: install tzdata")
    raise ValueError(
        f"there is no time zone {name!r}: {did_you_mean(name, known, 'expected one such as Europe/Berlin')}"
    )


def written(when: datetime.datetime) -> str:
    """Return a moment as people write it, with its zone where it has one.

    >>> written(moment("2026-12-01 23:59 Europe/Berlin")), written(moment("2026-12-01"))
    ('2026-12-01 23:59 Europe/Berlin', '2026-12-01 23:59')
    """
    zone = when.tzinfo
    name = "" if zone is None else getattr(zone, "key", "") or when.tzname()
    return f"{when:%Y-%m-%d %H:%M} {name}".strip()


def lasting(span: timedelta) -> str:
    """Return a length of time in words, to the minute.

    >>> lasting(timedelta(hours=27)), lasting(timedelta(minutes=95)), lasting(timedelta(seconds=20))
    ('1 day 3 h', '1 h 35 min', 'less than 1 min')
    """
    minutes = int(span / timedelta(minutes=1))
    days, minutes = divmod(minutes, 24 * 60)
    hours, minutes = divmod(minutes, 60)
    parts = [f"{days} day{'' if days == 1 else 's'}" if days else "", f"{hours} h" if hours else ""]
    parts.append(f"{minutes} min" if minutes and not days else "")
    return " ".join(filter(None, parts)) or "less than 1 min"


@dataclass(frozen=True)
class Policy:
    """A due date, and what it costs to come later; percentages are fractions here.

    Attributes:
        due: the last moment that is in time.
        a_unit, unit: what each day that has begun costs, or each hour or week; `unit` is its name.
        once: what it costs to be late at all.
        grace: what is as good as in time.
        at_most: the most that it costs.
        accepted: what comes later than this earns nothing; None where there is no such limit.

    >>> policy = Policy.of("2026-12-01 23:59 Europe/Berlin", "10 % a day, 15 min grace, at most 50 %")
    >>> print(policy)
    due 2026-12-01 23:59 Europe/Berlin; late: 10 % a day, 15 min grace, at most 50 %
    >>> policy.costs(timedelta(minutes=15)), policy.costs(timedelta(hours=25)), policy.costs(timedelta(days=9))
    (0.0, 0.2, 0.5)
    """

    due: datetime.datetime
    a_unit: float = 0
    unit: str = "day"
    once: float = 0
    grace: timedelta = timedelta()
    at_most: float = 1
    accepted: timedelta | None = None

    @classmethod
    def of(cls, due: str, late: str = "none") -> Policy:
        """Return the policy that two texts say. Raises GradingError in a sentence."""
        for name, text in {"DUE": due, "LATE": late}.items():
            if not isinstance(text, str):
                raise GradingError(f"{name} is {harmless(repr(text))}: expected a text")
        try:
            return cls(moment(due), **_terms(late))
        except ValueError as problem:
            raise GradingError(f"DUE or LATE: {problem}") from None

    def costs(self, by: timedelta) -> float:
        """Return what it costs to be late by so much, as a fraction of what was earned."""
        if by <= self.grace:
            return 0.0
        if self.accepted is not None and by > self.accepted:
            return 1.0
        begun = math.ceil((by - self.grace) / _LENGTHS[self.unit])
        return min(self.once + self.a_unit * begun, self.at_most, 1.0)

    def __str__(self) -> str:
        parts = [f"{_percent(self.a_unit)} {'an' if self.unit == 'hour' else 'a'} {self.unit}"] if self.a_unit else []
        parts += [_percent(self.once)] if self.once else []
        parts += [f"{lasting(self.grace)} grace"] if self.grace else []
        parts += [f"at most {_percent(self.at_most)}"] if self.at_most < 1 else []
        parts += [f"not accepted after {lasting(self.accepted)}"] if self.accepted is not None else []
        return f"due {written(self.due)}; late: {', '.join(parts) or 'costs nothing'}"


def policy_of(module: object, name: str) -> Policy | None:
    """Return the policy of an assignment's module; None where it says nothing of it.

    Raises GradingError for texts that cannot be read, and for a `LATE` without a `DUE`.
    """
    due, late = (getattr(module, one, None) for one in ("DUE", "LATE"))
    if due is None and late is None:
        return None
    if due is None:
        raise GradingError(f'{name}.py has LATE and no DUE: expected one, as DUE = "2026-12-01 23:59 Europe/Berlin"')
    try:
        return Policy.of(due, "none" if late is None else late)
    except GradingError as problem:
        raise GradingError(f"{name}.py: {problem}") from None


def without_dates(source: str) -> str:
    """Return the text of a module without the lines that say when it is due, where nothing else in it reads them.

    >>> without_dates('x = 1\\nDUE = "2026-12-01"  # a Tuesday\\ny = 2\\n')
    'x = 1\\ny = 2\\n'
    """
    tree, lines = ast.parse(source), source.splitlines(keepends=True)
    named = [node.id for node in ast.walk(tree) if isinstance(node, ast.Name)]
    for node in tree.body:
        is_text = isinstance(node, ast.Assign) and isinstance(node.value, ast.Constant) and len(node.targets) == 1
        name = node.targets[0] if is_text else None
        if isinstance(name, ast.Name) and name.id in ("DUE", "LATE") and named.count(name.id) == 1:
            at, text = slice(node.lineno - 1, node.end_lineno), ast.get_source_segment(source, node)
            if re.fullmatch(re.escape(text or "") + r"\s*(?:#.*)?\s*", "".join(lines[at])):
                lines[at] = [""] * (at.stop - at.start)
    return "".join(lines)


def _terms(late):
    """What a text of LATE says, as arguments of `Policy`. Raises ValueError."""
    found = {}
    for part in re.split(r"(?<!\d),|,(?!\d)|;", late):
        text = " ".join(part.split()).casefold()
        if text in ("", "none", "costs nothing", "no deduction"):
            continue
        term, match = next(((name, m) for name, one in _PARTS.items() if (m := one.fullmatch(text))), ("", None))
        if not match:
            raise ValueError(f"{part.strip()!r} says nothing about what is late: expected {_EXAMPLES}")
        if term in found:
            raise ValueError(f"{late!r} says twice what {match[0]!r} says: expected one")
        amount, unit = float(match[1].replace(",", ".")), match[2] if len(match.groups()) > 1 else ""
        unit = _SHORT.get(unit, unit)
        if "%" in text and not 0 < amount <= 100:
            raise ValueError(f"{part.strip()!r} is not possible: expected a percentage above 0 and up to 100")
        found[term] = amount, unit
    if {"a_unit", "once"} <= found.keys():
        raise ValueError(f"{late!r} has two costs: expected one, as in '10 % a day' or in '20 %'")
    if {"a_unit", "once", "nothing"}.isdisjoint(found) and found:
        raise ValueError(f"{late!r} does not say what it costs: expected '10 % a day' or '20 %' besides")
    terms = {name: found[name][0] / 100 for name in ("a_unit", "once", "at_most") if name in found}
    terms |= {"unit": found["a_unit"][1]} if "a_unit" in found else {}
    spans = {"grace": "grace", "nothing": "accepted"}
    return terms | {name: found[one][0] * _LENGTHS[found[one][1]] for one, name in spans.items() if one in found}


def _percent(fraction):
    return f"{100 * fraction:.4g} %"


@dataclass(frozen=True)
class Lateness:
    """How late a submission is, and what that costs.

    Attributes:
        part: of what was earned that it costs.
        says: how late it is and what that costs, for student and instructor; empty where it is in time.
        look: why the instructor should see to it; empty where there is no need.
    """

    part: float = 0
    says: str = ""
    look: str = ""


def lateness(
    policy: Policy | None,
    handed_in: datetime.datetime | None = None,
    late: bool | None = None,
    until: datetime.datetime | None = None,
) -> Lateness:
    """Return how late a submission is; nothing is guessed: what is not known costs nothing.

    Arguments:
        policy: of the assignment; None where it has no due date.
        handed_in: when it was handed in; a time without a zone is of the place of the due date.
        late: whether the LMS says that it is late; None where it says nothing.
        until: an extension for this student.
    Raises:
        GradingError: where the time has a zone and the due date has none.

    >>> policy = Policy.of("2026-12-01 23:59", "10 % a day")
    >>> lateness(policy, moment("2026-12-03 02:00")).says
    'handed in 1 day 2 h late (due 2026-12-01 23:59): 20 % of the points are deducted'
    >>> lateness(policy, late=True).says
    'handed in late, by how much is not known: nothing is deducted'
    """
    if policy is None:
        return Lateness(says="handed in late, says the learning management system") if late else Lateness()
    due = max(policy.due, until) if until else policy.due
    if handed_in is None:
        if not late:
            return Lateness()
        says = "handed in late, by how much is not known: nothing is deducted"
        look = "it is late, by how much is not known, and nothing is deducted"
        look += f" (there is an extension to {written(until)})" if until else ""
        return Lateness(0, says, f"{look}: add a column handed_in to the roster, or a row to marks.csv")
    if due.tzinfo is None and handed_in.tzinfo is not None:
        raise GradingError(
            f"a submission was handed in at {written(handed_in)}, and DUE names no time zone: expected one, as in "
            f'DUE = "{written(policy.due)} Europe/Berlin"'
        )
    handed_in = handed_in.replace(tzinfo=due.tzinfo) if handed_in.tzinfo is None else handed_in.astimezone(due.tzinfo)
    if _instant(handed_in) <= _instant(due):
        if _instant(handed_in) > _instant(policy.due):
            return Lateness(0, f"{IN_TIME} an extension to {written(until)}")
        return Lateness()
    if policy.unit == "hour":
        by = _instant(handed_in) - _instant(due)
    else:  # as clocks on the wall say: the same time of the next day is a day later
        by = handed_in.replace(tzinfo=None) - due.replace(tzinfo=None)
    by = max(by, timedelta(microseconds=1))
    part = policy.costs(by)
    how = f"handed in {lasting(by)} late ({'extended to' if due != policy.due else 'due'} {written(due)})"
    if policy.accepted is not None and by > policy.accepted:
        return Lateness(part, f"{how}, after the last day on which it is accepted: all points are deducted")
    if part:
        return Lateness(part, f"{how}: {_percent(part)} of the points are deducted")
    within = f", within the grace of {lasting(policy.grace)}" if by <= policy.grace and policy.grace else ""
    return Lateness(0, f"{how}{within}: nothing is deducted")


def _instant(when):
    """A moment for comparisons: of two with one zone Python compares the clocks on the wall."""
    return when.astimezone(datetime.UTC) if when.tzinfo else when


@dataclass(frozen=True)
class Extensions:
    """The extensions of one assignment.

    Attributes:
        until: {student's id: the last moment}.
        notes: sentences on rows that have no effect here.
    """

    until: Mapping[str, datetime.datetime]
    notes: tuple[str, ...] = ()


def read_extensions(
    path: str | Path,
    students: Iterable[str],
    assignment: str,
    policy: Policy | None,
    also: Mapping[str, str] | None = None,
    former: Collection[str] = (),
) -> Extensions:
    """Return the extensions that a file grants: student, until, and perhaps assignment, one row for each.

    A row without an assignment is for every one.

    Arguments:
        path: of the file.
        students: the ids of the roster.
        assignment: the name of this one.
        policy: its policy.
        also: {another id of a student: id}.
        former: the ids of those who have left the roster.
    Raises:
        GradingError: with all faults, each with its line: a student who is not on the roster, what is no time, a time
            before the due date, two rows for one student.
    """
    sheet = read(path, ["student", "until"], ["assignment"])
    known = {other.casefold(): student for other, student in (also or {}).items()}
    known |= {student.casefold(): student for student in students}
    faults, until, lines, others, early, left = Faults(sheet.path.name), {}, {}, {}, [], []
    for line, row in sheet.rows:
        of = row.get("assignment", "")
        if of and of.casefold() != assignment.casefold():
            others[of] = others.get(of, 0) + 1
            continue
        student = known.get(row["student"].casefold())
        if not student and row["student"] in former:
            left.append(row["student"])
            continue
        if not student:
            known_ids = did_you_mean(row["student"], known.values(), "expected an id")
            faults.add(line, f"there is no student {row['student']!r} on the roster: {known_ids}")
            continue
        if policy is None:
            continue
        try:
            when = moment(row["until"], policy.due.tzinfo)
        except ValueError as problem:
            faults.add(line, str(problem))
            continue
        if when.tzinfo and not policy.due.tzinfo:
            faults.add(line, f"{row['until']!r} names a time zone, and DUE names none: expected one in both")
        elif _instant(when) < _instant(policy.due):
            if of:
                faults.add(
                    line, f"{row['until']!r} is before the due date, {written(policy.due)}: expected a later time"
                )
            else:
                early.append(student)
        elif (first := lines.get((student, bool(of)))) is not None:
            faults.add(line, f"{student!r} has an extension in line {first} already: expected one")
        else:
            lines[student, bool(of)] = line
            until[student] = max(when, until[student], key=_instant) if student in until else when
    faults.demand_none()
    notes = [f"{count} for the assignment {name!r}" for name, count in others.items()]
    notes += [f"{', '.join(early)}: before the due date"] if early else []
    notes += [f"{', '.join(left)}: no longer on the roster"] if left else []
    if policy is None and sheet.rows:
        notes.append(f"{assignment} has no DUE")
    return Extensions(until, tuple(f"{sheet.path.name}, of no effect here: {note}" for note in notes))
