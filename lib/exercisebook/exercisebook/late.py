"""What it costs to hand in an assignment late, as its author says it."""

from __future__ import annotations

import math
from dataclasses import dataclass
from datetime import timedelta

from plainmath.validation import number, one_of

_UNITS = {"hour": timedelta(hours=1), "day": timedelta(days=1), "week": timedelta(weeks=1)}


@dataclass(frozen=True)
class Late:
    """What it costs to be late, in percent of what was earned.

    Attributes:
        percent: what it costs.
        per: "hour", "day" or "week", each of which costs so much as soon as it has begun; None where it costs so much
            once.
        grace_minutes: what costs nothing; hours, days and weeks are counted from its end.
        at_most: the most that it costs, in percent.
        accepted_days: what is later than this earns nothing; None where there is no such limit.
    Raises:
        ValueError: for what is none of these, and where nothing of it costs anything.

    >>> late = Late(percent=10, per="day", grace_minutes=15, at_most=50)
    >>> [late.costs(timedelta(minutes=15)), late.costs(timedelta(hours=25)), late.costs(timedelta(days=9))]
    [0.0, 0.2, 0.5]
    >>> str(late)
    '10 % a day, 15 min grace, at most 50 %'
    """

    percent: float = 0
    per: str | None = None
    grace_minutes: float = 0
    at_most: float = 100
    accepted_days: float | None = None

    def __post_init__(self) -> None:
        most = {"percent": 100, "grace_minutes": 100_000, "at_most": 100, "accepted_days": 1000}
        if self.accepted_days is None:
            most.pop("accepted_days")
        for name, end in most.items():
            number(name, getattr(self, name), f"a number from 0 to {end}", lambda x, end=end: 0 <= x <= end)
        if self.per is not None:
            one_of("per", self.per, _UNITS)
        if self.accepted_days is None and not (self.percent and self.at_most):
            raise ValueError(f"{self!r} costs nothing: expected a percent above 0, as in Late(percent=20)")

    @property
    def grace(self) -> timedelta:
        """What costs nothing."""
        return timedelta(minutes=self.grace_minutes)

    def refuses(self, by: timedelta) -> bool:
        """Whether what is late by so much earns nothing."""
        return self.accepted_days is not None and by > max(self.grace, timedelta(days=self.accepted_days))

    def costs(self, by: timedelta) -> float:
        """Return what it costs to be late by so much, as a fraction of what was earned."""
        if by <= self.grace:
            return 0.0
        if self.refuses(by):
            return 1.0
        begun = math.ceil((by - self.grace) / _UNITS[self.per]) if self.per else 1
        return min(self.percent * begun, self.at_most, 100) / 100

    def __str__(self) -> str:
        each = {None: "", "hour": " an hour"}.get(self.per, f" a {self.per}")
        parts = [f"{self.percent:g} %{each}"] if self.percent else []
        parts += [f"{self.grace_minutes:g} min grace"] if self.grace_minutes else []
        parts += [f"at most {self.at_most:g} %"] if self.at_most < 100 else []
        if (days := self.accepted_days) is not None:
            parts.append(f"not accepted after {days:g} day{'' if days == 1 else 's'}")
        return ", ".join(parts)
