"""A gain schedule: controller settings as a function of a measured variable. (Haugen, Section 10.5.3)"""

from __future__ import annotations

import bisect
import copy
import itertools
from collections.abc import Mapping
from typing import Any

import sympy

from loopbook.pid import PID, Controller
from loopbook.types import Number
from plainmath.expressions import exact
from plainmath.validation import exact_real, number, one_of

WAYS = ("constant", "linear")


class GainSchedule:
    """A table of PID settings over a scheduling variable GS, and the way between its rows.

    "constant": the settings of a row hold from its GS up to the next row's, because those of lower GS are the safe ones
    (as in a tank with flow GS, whose gain and dead time are largest at low flow); with ``safe="high"`` it is the other
    way round. With a hysteresis h, GS must pass a border by h/2 before the settings change, so that noise does not make
    them chatter. "linear": each setting lies on the straight line between two rows. Beyond the ends of the table the
    first and the last row hold.

    Arguments:
        table: ``{GS: PID}``, two rows at least, all in the same form.
        way: "constant" or "linear".
        hysteresis: h, in the unit of GS; for "constant" only.
        safe: "low" or "high", which end of an interval has the settings that are safe in all of it.
    Raises:
        ValueError: for a table that is too short, of mixed forms, with a GS twice or, if linear, with an integral term
            in some rows only; another way; or a hysteresis larger than the smallest distance of two rows.
    Source: Haugen, Table 10.2, Figure 10.14, equations (10.30) to (10.32) and (10.41).

    >>> table = {12: PID(4.1, Ti=7), 16: PID(5.4, Ti=5.4), 20: PID(6.8, Ti=4.4)}
    >>> GainSchedule(table).settings(18)
    PID(Kp=27/5, Ti=27/5)
    >>> GainSchedule(table, "linear").settings(18)
    PID(Kp=61/10, Ti=49/10)
    """

    def __init__(self, table: Mapping[Any, PID], way: str = "constant", hysteresis: Number = 0, safe: str = "low"):
        if not isinstance(table, dict) or len(table) < 2 or not all(isinstance(x, PID) for x in table.values()):
            raise ValueError(f"the table is {table!r}: expected {{GS: PID}} with two rows or more")
        if len({settings.form for settings in table.values()}) > 1:
            raise ValueError("the settings in the table have different forms: expected the same form in all rows")
        one_of("the way", way, WAYS)
        one_of("the safe end", safe, ("low", "high"))
        if way == "linear" and len({settings.Ti == sympy.oo for settings in table.values()}) > 1:
            raise ValueError("only some rows have an integral term: between these no straight line leads")
        self.rows = sorted(exact_real("GS", GS, symbols=False) for GS in table)
        self.table = {exact(GS): settings for GS, settings in table.items()}
        smallest = min(high - low for low, high in itertools.pairwise(self.rows))
        if smallest == 0:
            raise ValueError(f"the table is {table!r}: expected different values of GS")
        expected = f"0 to {smallest}, and none for a linear schedule"
        number("the hysteresis", hysteresis, expected, lambda x: 0 <= x <= (smallest if way == "constant" else 0))
        self.way, self.safe, self.hysteresis = way, safe, exact(hysteresis)
        self.row = None  # that of the last settings

    def settings(self, GS: Number) -> PID:
        """Return the settings for a value of GS, a number; with a hysteresis they depend on the values before.

        Raises ValueError for a value that is not a number.
        """
        GS = exact_real("GS", GS, symbols=False)
        return self._linear(GS) if self.way == "linear" else self.table[self._row(GS)]

    def reset(self) -> None:
        """Forget the values before."""
        self.row = None

    def _row(self, GS):
        low = self._interval(GS - self.hysteresis / 2)
        high = self._interval(GS + self.hysteresis / 2)
        if self.row is None:
            self.row = self._interval(GS)
        elif self.row < low:  # GS has passed a border upwards by half the hysteresis
            self.row = low
        elif self.row > high:
            self.row = high
        return self.rows[self.row]

    def _interval(self, GS):
        """The number of the row whose interval holds GS."""
        if self.safe == "low":
            return max(bisect.bisect_right(self.rows, GS) - 1, 0)
        return min(bisect.bisect_left(self.rows, GS), len(self.rows) - 1)

    def _linear(self, GS):
        GS = min(max(GS, self.rows[0]), self.rows[-1])
        k = min(bisect.bisect_right(self.rows, GS), len(self.rows) - 1)
        low, high = self.rows[k - 1], self.rows[k]
        share = (GS - low) / (high - low)
        one, other = self.table[low], self.table[high]
        between = (getattr(one, x) + share * (getattr(other, x) - getattr(one, x)) if getattr(one, x) !=
                   getattr(other, x) else getattr(one, x) for x in ("Kp", "Ti", "Td", "Tf"))  # fmt: skip
        return PID(*between, form=one.form)

    def __repr__(self) -> str:
        rows = ", ".join(f"{GS}: {settings}" for GS, settings in self.table.items())
        return f"GainSchedule({{{rows}}}, {self.way!r})"


class ScheduledController(Controller):
    """The practical PID controller with settings from a gain schedule. (Haugen, Figure 10.13)

    ``simulate(..., scheduling=signal)`` tells it the value of GS at each sample. The settings change without a bump for
    a loop at rest; while there is a control error, the proportional term steps with its gain.

    Arguments:
        schedule: a `GainSchedule`; the controller has a copy of its own, without the values before.
        step, options: as of `Controller`.

    >>> schedule = GainSchedule({12: PID(4), 16: PID(5)})
    >>> controller = ScheduledController(schedule, step=1, u0=50)
    >>> [controller.update(setpoint=1, measurement=0, scheduling=GS) for GS in (12, 15, 17)]
    [54.0, 54.0, 55.0]
    """

    recorded = ("Kp", "Ti")  # what a simulation notes besides the signals

    def __init__(self, schedule: GainSchedule, step: Number, **options: Any):
        if not isinstance(schedule, GainSchedule):
            raise ValueError(f"the schedule is {schedule!r}: expected a GainSchedule")
        self.schedule = copy.copy(schedule)
        self.schedule.reset()
        super().__init__(next(iter(schedule.table.values())), step, **options)

    def update(
        self,
        setpoint: Number,
        measurement: Number,
        feedforward: Number = 0.0,
        manual: Number | None = None,
        scheduling: Number | None = None,
    ) -> float:
        """Take the signals of this sample, and the value of GS, and return the control signal."""
        if scheduling is None:
            raise ValueError("the value of GS is missing: expected a number for the schedule")
        settings = self.schedule.settings(scheduling)
        if settings != self.settings:
            self.change(settings)
        return super().update(setpoint, measurement, feedforward, manual)

    def take_over(self, other: Controller) -> None:
        super().take_over(other)
        if isinstance(other, ScheduledController):
            self.schedule.row = other.schedule.row
