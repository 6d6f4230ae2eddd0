"""The response to the answers of an exercise, as a small coloured box or as text."""

from __future__ import annotations

import contextlib
import dataclasses
import html
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field
from typing import TYPE_CHECKING, Any

from exercisebook.judging import MISTAKE, OPEN, RIGHT, UNJUDGED, WAITING, WRONG, earned
from exercisebook.showing import Showing
from exercisebook.timeout import limited

if TYPE_CHECKING:
    from exercisebook.judging import Verdict

#: The MIME type under which a stored notebook carries the response as data.
MIME_TYPE = "application/vnd.loopbook.response+json"

#: What drawing an answer may take (s).
SECONDS = 5

#: A sign and a colour for each status, as in the ledger's tables.
MARKS = {
    RIGHT: ("✓", "#00664d"),
    MISTAKE: ("≈", "#8a5a00"),
    WRONG: ("✗", "#b33c00"),
    UNJUDGED: ("?", "#5a5a5a"),
    OPEN: ("…", "#5a5a5a"),
    WAITING: ("✎", "#3b4fa8"),
}


@dataclass(frozen=True)
class Response(Showing):
    """The verdicts on all asked quantities of an exercise, and the points they bring.

    Attributes:
        heading: number and title of the exercise.
        verdicts: one for each asked quantity, in their order.
        points: of the whole exercise.
        weights: {name: weight} of quantities that do not count once.
        notes: sentences on the answers as a whole.
        drawings: functions that return figures of the answers, or None.
    """

    heading: str
    verdicts: tuple[Verdict, ...]
    points: float
    notes: tuple[str, ...] = ()
    drawings: tuple[Callable[[], Any], ...] = ()
    weights: Mapping[str, float] = field(default_factory=dict)

    def with_notes(self, *notes: str) -> Response:
        """The response with more sentences."""
        return dataclasses.replace(self, notes=(*self.notes, *notes))

    @property
    def pictures(self) -> Sequence[Any]:
        """The figures of the answers: what a design does. What cannot be drawn has none."""
        if self.drawings:
            import matplotlib.figure  # noqa: F401 - the limit below must not cut off its import
        pictures = []
        for draw in self.drawings:
            with contextlib.suppress(ArithmeticError, ValueError, TimeoutError):
                pictures.append(limited(SECONDS, draw))
        return [picture for picture in pictures if picture is not None]

    @property
    def is_right(self) -> bool:
        """Whether all of it is right."""
        return all(verdict.is_right for verdict in self.verdicts)

    @property
    def earned(self) -> float:
        """The points earned."""
        weights = {one: self.weights.get(one.name, 1) for one in self.verdicts}
        return earned(self.points, sum(weights[one] for one in weights if one.is_right), sum(weights.values()))

    @property
    def _right(self):
        """How many answers are right."""
        return sum(verdict.is_right for verdict in self.verdicts)

    @property
    def _status(self):
        """The status that the whole box shows."""
        statuses = {verdict.status for verdict in self.verdicts}
        order = (WRONG, MISTAKE, UNJUDGED, OPEN, WAITING, RIGHT)
        return next(status for status in order if status in statuses)

    @property
    def _heading(self):
        return self.heading if self.heading.endswith("?") else f"{self.heading}:"

    @property
    def summary(self) -> str:
        """How much of it is right, in a few words."""
        if all(verdict.status == OPEN for verdict in self.verdicts):
            return "not answered yet"
        if self.is_right:
            return "right"
        waiting = sum(verdict.status == WAITING for verdict in self.verdicts)
        if waiting == len(self.verdicts):
            return "taken down"
        to_be_marked = f", {waiting} to be marked" if waiting else ""
        return (
            f"{self._right} of {len(self.verdicts)} right{to_be_marked}" if len(self.verdicts) > 1 else "not right yet"
        )

    @property
    def data(self) -> dict[str, Any]:
        """The response as JSON data."""
        verdicts = [{"name": v.name, "status": v.status, "says": v.says} for v in self.verdicts]
        return {"exercise": self.heading, "right": self.is_right, "verdicts": verdicts}

    def __repr__(self) -> str:
        lines = [f"{MARKS[self._status][0]} {self._heading} {self.summary}"]
        lines += [f"  {MARKS[v.status][0]} {v.name}: {v.says}" for v in self.verdicts]
        return "\n".join([*lines, *(f"  {note}" for note in self.notes)])

    def _repr_html_(self):
        mark, colour = MARKS[self._status]
        box = f"border-left: 4px solid {colour}; background: {colour}14; padding: 0.4em 0.8em; margin: 0.3em 0"
        lines = [
            f'<div role="status" style="{box}">',
            f'<strong><span style="color: {colour}">{mark}</span> {_escape(self._heading)} {self.summary}</strong>',
        ]
        for verdict in self.verdicts:
            mark, colour = MARKS[verdict.status]
            lines.append(
                f'<div><span style="color: {colour}">{mark}</span> <code>{_escape(verdict.name)}</code>: '
                f"{_escape(verdict.shown)}</div>"
            )
        lines += [f"<div>{_escape(note)}</div>" for note in self.notes]
        return "\n".join([*lines, "</div>"])

    def _repr_mimebundle_(self, include=None, exclude=None):
        return {"text/plain": repr(self), "text/html": self._repr_html_(), MIME_TYPE: self.data}


def _escape(text):
    """Text as HTML, where a formula between two dollar signs stays one; other signs of formulas are none."""
    parts = html.escape(text, quote=False).split("$")
    sign = "$" if len(parts) % 2 else "<span>$</span>"
    parts[::2] = [part.replace("\\", "<span>\\</span>") for part in parts[::2]]
    return sign.join(parts)
