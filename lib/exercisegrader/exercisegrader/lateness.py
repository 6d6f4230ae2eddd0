"""What is late, and what that costs: due dates, policies, and extensions for single students.

The module of an assignment says both::

    DUE = "2026-12-01 23:59 Europe/Berlin"
    LATE = Late(percent=10, per="day", grace_minutes=15, at_most=50)

A time lasts to the end of its minute, a date without a time to the end of its day. Days are counted from the due date,
those that have begun, by the clock on the wall; what comes within the grace costs nothing, and days are then counted
from its end. The percentage is one of what was earned. Other times that name no zone are of the place of the due date.
"""

from __future__ import annotations

import datetime
import re
import zoneinfo
from dataclasses import dataclass
from datetime import timedelta
from pathlib import Path
from typing import TYPE_CHECKING

from exercisebook.judging import harmless
from exercisebook.late import Late
from exercisegrader import GradingError
from exercisegrader.student import in_short
from exercisegrader.tables import Faults, read_sheet
from plainmath.validation import did_you_mean

if TYPE_CHECKING:
    from exercisegrader.student import Roll

#: How the sentence on an extension begins.
IN_TIME = "in time by"
_DATES = re.compile(
    r"""^(?:(?:DUE|due) = (["'])[^"'\n]*\1|LATE = Late\([^()]*\)|late = \{[^{}]*\})[ \t]*(?:#.*)?\n""", re.MULTILINE
)


def moment(text: str, zone: datetime.tzinfo | None = None) -> datetime.datetime:
    """Return the last moment of the minute that a text means; of the day, where it says no time.

    Arguments:
        text: a date, and perhaps a time and a zone: Europe/Berlin, UTC, +01:00.
        zone: for a text without one.
    Raises:
        ValueError: in a sentence, for what is no date, and for an unknown zone.

    >>> moment("2026-12-01 23:59 Europe/Berlin").isoformat()
    '2026-12-01T23:59:59.999999+01:00'
    >>> moment("2026-12-31").isoformat()
    '2026-12-31T23:59:59.999999'
    """
    day, *rest = text.split() or [""]
    place = rest.pop() if rest and rest[-1][0].isalpha() and rest[-1] != "Z" else ""
    said = day + "".join(rest) if "T" in day else f"{day} {''.join(rest) or '23:59'}"
    try:
        when = datetime.datetime.fromisoformat(said).replace(second=59, microsecond=999_999)
    except ValueError:
        raise ValueError(f"{harmless(repr(text))} is not a date and time: expected one as 2026-12-01 23:59") from None
    return when if when.tzinfo else when.replace(tzinfo=_zone(place) if place else zone)


def _zone(name):
    try:
        return zoneinfo.ZoneInfo(name)
    except (KeyError, OSError, ValueError):
        otherwise = "expected one such as Europe/Berlin (this machine takes them from the package tzdata)"
        near = did_you_mean(name, zoneinfo.available_timezones(), otherwise)
        raise ValueError(f"there is no time zone {name!r}: {near}") from None


def written(when: datetime.datetime) -> str:
    """Return a moment as people write it, with its zone.

    >>> written(moment("2026-12-01 Europe/Berlin")), written(moment("2026-12-01 23:59+01:00"))
    ('2026-12-01 23:59 Europe/Berlin', '2026-12-01 23:59 UTC+01:00')
    """
    return f"{when:%Y-%m-%d %H:%M} {getattr(when.tzinfo, 'key', '') or when.tzname()}"


def lasting(span: timedelta) -> str:
    """Return a length of time in words, to the minute.

    >>> lasting(timedelta(hours=27)), lasting(timedelta(minutes=95)), lasting(timedelta(seconds=20))
    ('1 day 3 h', '1 h 35 min', 'less than 1 min')
    """
    minutes = int(span / timedelta(minutes=1))
    days, hours, minutes = minutes // (24 * 60), minutes // 60 % 24, minutes % 60
    parts = [(days, "day" if days == 1 else "days"), (hours, "h"), (0 if days else minutes, "min")]
    return " ".join(f"{count} {unit}" for count, unit in parts if count) or "less than 1 min"


@dataclass(frozen=True)
class Policy:
    """A due date, and what it costs to come later.

    Attributes:
        due: the last moment that is in time.
        late: what it costs; None where it is reported and costs nothing.

    >>> print(Policy(moment("2026-12-01 23:59 Europe/Berlin"), Late(percent=20)))
    due 2026-12-01 23:59 Europe/Berlin; late: 20 %
    """

    due: datetime.datetime
    late: Late | None = None

    def __str__(self) -> str:
        return f"due {written(self.due)}; late: {self.late or 'costs nothing'}"


def policy_of(module: object, file: str) -> Policy | None:
    """Return the policy of an assignment's module; None where it says nothing of it.

    Raises GradingError for a `DUE` that cannot be read or names no zone, a `LATE` of another form or without a `DUE`.
    """
    due, late = getattr(module, "DUE", None), getattr(module, "LATE", None)
    if due is None and late is None:
        return None
    if not isinstance(due, str):
        said = "there is LATE and no DUE" if due is None else f"DUE is {harmless(repr(due))}"
        raise GradingError(f'{file}: {said}: expected a text such as "2026-12-01 23:59 Europe/Berlin"')
    if late is not None and not isinstance(late, Late):
        raise GradingError(
            f'{file}: LATE is {harmless(repr(late))}: expected one as Late(percent=10, per="day", grace_minutes=15, '
            "at_most=50, accepted_days=7), with Late from exercisebook.authoring"
        )
    try:
        when = moment(due)
        if when.tzinfo is None:
            raise ValueError(f"{due!r} names no time zone: expected one, as in {due + ' Europe/Berlin'!r}")
    except ValueError as problem:
        raise GradingError(f"{file}: DUE: {problem}") from None
    return Policy(when, late)


def without_dates(source: str) -> str:
    """Return the text of a module without the statements that say when it is due.

    >>> without_dates('x = 1\\nDUE = "2026-12-01"  # a Tuesday\\nLATE = Late(\\n    20,\\n)\\ny = 2\\n')
    'x = 1\\ny = 2\\n'
    """
    return _DATES.sub("", source)


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

    >>> policy = Policy(moment("2026-12-01 23:59 UTC"), Late(percent=10, per="day"))
    >>> lateness(policy, moment("2026-12-03 02:00")).says
    'handed in 1 day 2 h late (due 2026-12-01 23:59 UTC): 20 % of the points are deducted'
    >>> lateness(policy, late=True).says
    'handed in late, by how much is not known: nothing is deducted'
    """
    if policy is None:
        return Lateness(says="handed in late, says the learning management system") if late else Lateness()
    due = max(policy.due, until or policy.due, key=_instant)
    if handed_in is None:
        says = "handed in late, by how much is not known: nothing is deducted"
        granted = f" (there is an extension to {written(until)})" if until else ""
        look = f"{says}{granted}; add a column handed_in to the roster, or a row to marks.csv"
        return Lateness(0, says, look) if late else Lateness()
    handed_in = handed_in.replace(tzinfo=due.tzinfo) if handed_in.tzinfo is None else handed_in.astimezone(due.tzinfo)
    if _instant(handed_in) <= _instant(due):
        is_extended = until and _instant(handed_in) > _instant(policy.due)
        return Lateness(says=f"{IN_TIME} an extension to {written(due)}" if is_extended else "")
    terms = policy.late
    if terms and terms.per == "hour":
        by = _instant(handed_in) - _instant(due)
    else:  # as clocks on the wall say: the same time of the next day is a day later
        by = max(handed_in.replace(tzinfo=None) - due.replace(tzinfo=None), timedelta(microseconds=1))
    how = f"handed in {lasting(by)} late ({'extended to' if due != policy.due else 'due'} {written(due)})"
    if terms and terms.refuses(by):
        return Lateness(1, f"{how}, after the last day on which it is accepted: all points are deducted")
    if terms and (part := terms.costs(by)):
        return Lateness(part, f"{how}: {100 * part:.4g} % of the points are deducted")
    within = f", within the grace of {lasting(terms.grace)}" if terms and by <= terms.grace else ""
    return Lateness(0, f"{how}{within}: nothing is deducted")


def _instant(when):
    """A moment for comparisons: of two with one zone Python compares the clocks on the wall."""
    return when.astimezone(datetime.UTC)


def read_extensions(
    path: str | Path, roll: Roll, assignment: str, policy: Policy | None
) -> tuple[dict[str, datetime.datetime], list[str]]:
    """Return the extensions of a file, {student's id: the last moment}, and sentences on rows of no effect here.

    A row has student, until, and perhaps assignment; without one it is for every one. Of several rows for a student the
    latest time counts.

    Arguments:
        path: of the file.
        roll: the ids of the roster.
        assignment: the name of this one.
        policy: its policy.
    Raises:
        GradingError: with all faults, each with its line: a student who is not on the roster, what is no time.
    """
    sheet = read_sheet(path, ["student", "until"], ["assignment"])
    faults, until, idle = Faults(sheet.table.path.name), {}, {}
    for line, row in sheet.rows:
        of, said = row.get("assignment", ""), row["student"]
        student, why = roll.find(said), ""
        if of and of.casefold() != assignment.casefold():
            why = f"for the assignment {of!r}"
        elif said in roll.former:
            why = "no longer on the roster"
        elif not student:
            faults.add(line, roll.fault(said))
        elif policy is None:
            why = f"{assignment} has no DUE"
        else:
            try:
                when = moment(row["until"], policy.due.tzinfo).astimezone(policy.due.tzinfo)
            except ValueError as problem:
                faults.add(line, str(problem))
            else:
                if _instant(when) < _instant(policy.due):
                    why = "before the due date"
                else:
                    until[student] = max(when, until.get(student, when), key=_instant)
        if why:
            idle.setdefault(why, []).append(said)
    faults.demand_none()
    start = f"{sheet.table.path.name}, of no effect here"
    return until, [f"{start}: {in_short(who)}, {why}" for why, who in idle.items()]
