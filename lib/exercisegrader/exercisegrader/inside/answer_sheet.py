"""The answer sheet of an assignment, in the student's notebook: takes answers down and shows how each one is read.

It knows the form of an answer, its unit or its words, and neither a key nor a tolerance. So it can say that an answer
cannot be read, and nothing about right or wrong. `exercisegrader.release` writes the notebooks.
"""

from __future__ import annotations

import contextlib
import html
from collections.abc import Callable
from dataclasses import dataclass
from typing import TYPE_CHECKING

from exercisebook import plugins, png
from exercisebook.grammar import Unreadable, shortened
from exercisebook.judging import harmless
from exercisebook.kinds import MAKERS
from exercisebook.reading import NOT_ANSWERED
from exercisegrader.inside.plain import Plain, plain, unreadable
from plainmath.validation import did_you_mean

if TYPE_CHECKING:
    from exercisebook.kinds import Kind

plugins.load()  # a released notebook imports nothing before the sheet that would know them
#: The forms of answers: each kind without a key, {name of its maker: maker}.
FORMS: dict[str, Callable[..., Kind]] = {name: kind.without_key for name, kind in MAKERS.items()}
globals().update(FORMS)

__all__ = ["AnswerSheet", *FORMS]

#: Where answers go when the notebook is graded: a function of student, exercise and {name: plain data}.
deliver: Callable[[str, str, dict[str, Plain]], object] | None = None

READ, UNREAD, OPEN = "·", "?", "…"
_COLOUR = "#5a5a5a"
_NO_VERDICT = "This says nothing about right or wrong."


class AnswerSheet:
    """The answers of one student to an assignment.

    Arguments:
        title: of the assignment.
        student: the student's id.

    >>> sheet = AnswerSheet("Tuning", student="s1001")
    >>> sheet.asks("1", Kp=number("%/K"), Ti=number("s"))
    >>> sheet.answer("1", Kp=2, Ti="2 min")
    · Exercise 1
      · Kp: 2 %/K
      · Ti: 120 s, converted from min
      Taken down. This says nothing about right or wrong.
    """

    def __init__(self, title: str = "", student: str = ""):
        self.title, self.student = title, student
        self._forms, self._taken = {}, {}

    def asks(self, exercise: object, /, **forms: Kind) -> None:
        """Say what an exercise asks: a form for each quantity. Several calls add up."""
        self._forms.setdefault(str(exercise), {}).update(forms)

    def answer(self, exercise: object = None, /, *alone: object, **given: object) -> Box:
        """Take answers down, by the names of the quantities, and show how each one is read.

        The last answer to a quantity counts; the dots, and None, are none. Whatever is given, this raises nothing.
        """
        name = _named(exercise)
        data = {quantity: plain(value) for quantity, value in given.items()}
        taken = self._taken.setdefault(name, {})
        taken.update({quantity: value for quantity, value in data.items() if value is not None})
        if deliver is not None:
            with contextlib.suppress(Exception):  # what becomes of the answers is no matter of the student's cell
                deliver(self.student, name, data)
        rows = [self._row(name, quantity) for quantity in dict.fromkeys([*self._forms.get(name, ()), *given])]
        pictures = [(harmless(one), value["png"]) for one, value in data.items() if png.is_data(value)]
        heading = f"Exercise {name}" if name else "Which exercise?"
        return Box(heading, tuple(rows), self._notes(name, alone, data), tuple(pictures))

    def taken(self, exercise: object) -> dict[str, Plain]:
        """Return what is taken down of an exercise: {quantity: plain data}."""
        return dict(self._taken.get(str(exercise), {}))

    def _row(self, exercise, quantity):
        mark, says = self._read(exercise, quantity)
        return mark, harmless(quantity), says

    def _read(self, exercise, quantity):
        """A mark and a sentence on what is taken down of a quantity."""
        data, forms = self._taken.get(exercise, {}).get(quantity), self._forms.get(exercise, {})
        if data is None:
            return OPEN, f"{NOT_ANSWERED}: expected {forms[quantity].expected}" if quantity in forms else NOT_ANSWERED
        if sentence := unreadable(data):
            return UNREAD, sentence
        if quantity not in forms:
            return UNREAD, f"this is not asked here: {did_you_mean(quantity, forms)}" if self._forms else "taken down"
        try:
            answer, remark = forms[quantity].read(data)
            says = shortened(harmless(forms[quantity].written(answer)), 200)
        except Unreadable as problem:
            return UNREAD, harmless(str(problem))
        except Exception as problem:  # the form, too, stands in a cell that can be edited
            return UNREAD, f"this cannot be read ({type(problem).__name__})"
        return READ, f"{says}, {remark}" if remark else says

    def _notes(self, exercise, alone, data):
        is_asked = not self._forms or exercise in self._forms
        is_given = any(value is not None for value in data.values())
        notes = [f"Taken down. {_NO_VERDICT}" if is_asked and is_given else _NO_VERDICT]
        if alone:
            notes.insert(0, "Give each answer by its name, as in sheet.answer('1', K=2); others are not taken down.")
        if not is_asked:
            notes.insert(0, f"This exercise is not asked here: {did_you_mean(exercise, self._forms)}")
        return tuple(notes)

    def _overview(self):
        rows = []
        for exercise in dict.fromkeys([*self._forms, *self._taken]):
            quantities = dict.fromkeys([*self._forms.get(exercise, ()), *self._taken.get(exercise, ())])
            for mark, quantity, says in (self._row(exercise, one) for one in quantities):
                rows.append((mark, f"{exercise}  {quantity}", says))
        asked = [(exercise, quantity) for exercise, forms in self._forms.items() for quantity in forms]
        marks = [self._read(*one)[0] for one in asked]
        counts = [(OPEN, f"of {len(asked)} not answered yet"), (UNREAD, "cannot be read")]
        notes = [f"{marks.count(mark)} {says}" for mark, says in counts if mark in marks]
        note = ", ".join(notes) or "An answer to all that is asked."
        return Box(f"{self.title} · {self.student}".strip(" ·") or "Answers", tuple(rows), (note,) if rows else ())

    def __repr__(self) -> str:
        return repr(self._overview())

    def _repr_html_(self):
        return self._overview()._repr_html_()


@dataclass(frozen=True)
class Box:
    """What a sheet shows: a heading, rows of a mark, a name and a sentence, notes, and figures as they were taken."""

    heading: str
    rows: tuple[tuple[str, str, str], ...]
    notes: tuple[str, ...] = ()
    pictures: tuple[tuple[str, str], ...] = ()

    @property
    def _mark(self):
        marks = {mark for mark, _, _ in self.rows}
        return next((mark for mark in (UNREAD, OPEN) if mark in marks), READ)

    def __repr__(self) -> str:
        rows = [f"  {mark} {name}: {says}" for mark, name, says in self.rows]
        return "\n".join([f"{self._mark} {self.heading}", *rows, *(f"  {note}" for note in self.notes)])

    def _repr_html_(self):
        style = f"border-left: 4px solid {_COLOUR}; background: {_COLOUR}14; padding: 0.4em 0.8em; margin: 0.3em 0"
        rows = [f"<div>{mark} <code>{_escape(name)}</code>: {_escape(says)}</div>" for mark, name, says in self.rows]
        notes = [f"<div>{_escape(note)}</div>" for note in self.notes]
        heading = f"<strong>{self._mark} {_escape(self.heading)}</strong>"
        look = "max-width: 24em; background: #ffffff"
        pictures = [
            f'<img style="{look}" alt="{html.escape(name)}" src="data:image/png;base64,{html.escape(data)}">'
            for name, data in self.pictures
        ]
        return "\n".join([f'<div role="status" style="{style}">', heading, *rows, *pictures, *notes, "</div>"])


def _named(exercise):
    """The name of an exercise: a text, or a number that a student writes without quotes; an empty one for all else."""
    if isinstance(exercise, int | float) and abs(exercise) < 1000:
        return f"{exercise:g}"
    return shortened(harmless(exercise)) if isinstance(exercise, str) else ""


def _escape(text):
    """Text as HTML in which nothing is a formula."""
    return html.escape(text).replace("$", "<span>$</span>").replace("\\", "<span>\\</span>")
