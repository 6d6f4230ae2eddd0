"""One exercise as a form: its statement, its fields, hints and solution as HTML, and what was typed as answers."""

from __future__ import annotations

import copy
import functools
import re
import urllib.parse
from collections.abc import Mapping
from typing import Any

import numpy as np

from exercisebook.errors import ExerciseError
from exercisebook.forms import controls
from exercisebook.forms.fields import Field, field_of
from exercisebook.forms.text import escaped, html, inline, sentence
from exercisebook.kinds.kind import NONE, SEVERAL
from exercisebook.question import Question

#: Longer ones are no answers that somebody typed.
LONGEST = 20_000
#: Of the largest value of a record, a smaller part is zero.
_TRACE = 1e-12
#: What comes along where somebody copies, and nobody sees.
_UNSEEN = re.compile("[\u200b-\u200f\u2060-\u2064\ufeff]")
#: How something whole begins that is typed as it is called, as Spring(2, 0.5).
_CALLED = re.compile(r"\s*[A-Za-z]+\s*\(")
#: What a notebook calls for the arrays of an exercise; a page has them as a file.
_CALL = re.compile(r'`([^`=]+?)\s*=\s*exercise\("[^`]*`')


def with_arrays(statement: str, where: str) -> str:
    """Return a statement that says where its arrays are, and not how a chapter gets them.

    >>> with_arrays('`t, y = exercise("1.1").given("t", "y")` are the record.', "in the cell below")
    '`t, y` in the cell below are the record.'
    """
    return _CALL.sub(rf"`\1` {where}", statement)


class Sheet:
    """An exercise, with the numbers of everybody or those of a name, as a page shows it.

    Arguments:
        question: the exercise in a variant.

    >>> from exercisebook.authoring import answers, between, exercise, number
    >>> @exercise("1.1", title="Twice")
    ... def twice(x=between(1, 9, "m", reference=3)):
    ...     "What is twice {x}?"
    ...     return answers(y=number(2 * x, "m"))
    >>> [field.unit for field in Sheet(twice.question()).fields]
    ['m']
    """

    def __init__(self, question: Question):
        self.question = question
        self.number = question.exercise.number

    @functools.cached_property
    def fields(self) -> tuple[Field, ...]:
        """The fields, one for each asked quantity, in their order."""
        weights = self.question.exercise.weights
        return tuple(field_of(name, kind, weights.get(name, 1)) for name, kind in self.question.key.items())

    @functools.cached_property
    def _statement(self):
        return self.question.statement

    @property
    def text(self) -> str:
        """The text of the statement as HTML, without its heading, its picture and what is asked."""
        return html(with_arrays(self._statement.body, "in the file below"))

    @property
    def asked(self) -> str:
        """What is asked as a list in HTML, for print and for readers whose browser has no fields."""
        return html(self._statement.list_of_asked).replace("<ul>", '<ul class="asked">', 1)

    @property
    def accuracy(self) -> str:
        """How near the answers must be, as HTML; empty where that is no question."""
        accuracy = self._statement.accuracy
        return f'<p class="accuracy">Accuracy: {inline(accuracy)}</p>' if accuracy else ""

    @property
    def controls(self) -> str:
        """The fields as HTML."""
        return "\n".join(controls.html(self.number, field, self.fields) for field in self.fields)

    @property
    def columns(self) -> dict[str, Any]:
        """The arrays that the exercise hands out, by their names; curves A, B, C in this order, whatever they are."""
        data = self.question.data
        letters = iter(sorted(name for name in data if _is_letter(name)))
        order = [next(letters) if _is_letter(name) else name for name in data]
        return {name: data[name] for name in order}

    @property
    def csv(self) -> str:
        """The arrays that the exercise hands out as a table in CSV; empty where there are none."""
        data = self.columns
        # the last digits, and what rounding leaves of a zero, are others in another Python
        columns = [np.where(np.abs(one) < _TRACE * np.max(np.abs(one)), 0.0, one) for one in data.values()]
        rows = (",".join(f"{type(value)(f'{value:.12g}'):.6g}" for value in row) for row in zip(*columns, strict=True))
        return "\n".join([",".join(data), *rows]) if data else ""

    def download(self, address: str = "") -> str:
        """Return the link to the arrays of the exercise, as HTML; empty where there are none.

        Arguments:
            address: of the file; if not given, the link holds the file itself.
        """
        if not self.csv:
            return ""
        address = address or f"data:text/csv;charset=utf-8,{urllib.parse.quote(self.csv, safe=',.-')}"
        names = ", ".join(f"<code>{escaped(name)}</code>" for name in self.columns)
        file = f"exercise-{controls.slug(self.number)}.csv"
        return f'<p class="data"><a href="{address}" download="{file}">The record as a file</a> (CSV: {names})</p>'

    @property
    def pictures(self) -> str:
        """The picture of the statement as HTML; empty where there is none."""
        return "".join(map(image, self.question.pictures))

    @property
    def statement(self) -> str:
        """All that is above the fields, as HTML: text, picture, data, and the list for print."""
        return "\n".join(filter(None, [self.text, self.pictures, self.download(), self.asked]))

    # ------------------------------------------------------------------------------------------------- help and answers

    @property
    def rungs(self) -> int:
        """How many hints there are."""
        return len(self.question.rungs)

    def hint(self, rung: int) -> str:
        """Return a hint as HTML. Raises ExerciseError for an unknown one."""
        return html(self.question.hint(rung).body)

    @property
    def solution(self) -> str:
        """The solution as HTML, with its picture."""
        return "\n".join([self.solution_text, *map(image, self.question.solved().pictures)])

    @property
    def solution_text(self) -> str:
        """The same without the picture."""
        return html(self.question.solved().body)

    def check(self, answers: Mapping[str, Any]) -> dict[str, Any]:
        """Return the response to what was typed and chosen.

        Arguments:
            answers: {name of a field: its text}; a list of texts where several words are chosen, and texts by the
                names of the parts where something is asked that has some. What is empty is not answered yet.
        Raises:
            ExerciseError: for what is none of these.
        """
        question = self.question
        response = question.check(**self.given(answers))
        notes = [self._in_a_page(note) for note in response.notes]
        verdicts = [{"name": v.name, "status": v.status, "says": v.says, "html": sentence(v.shown)}
                    for v in response.verdicts]  # fmt: skip
        lines = [f"<p>{note}</p>" for note in notes] + [image(picture) for picture in response.pictures]
        return {
            "right": response.is_right,
            "says": response.summary,
            "html": "\n".join(lines),
            "verdicts": verdicts,
            "notes": list(response.notes),
        }

    def rehearse(self) -> None:
        """Judge the key, and forget it: what that needs for the first time takes longer, and an answer need not."""
        copy.copy(self.question).check(**{name: kind.key for name, kind in self.question.key.items()})

    def given(self, answers: Mapping[str, Any]) -> dict[str, Any]:
        """Return what was typed and chosen as the exercise takes it; `check` says what it may be."""
        if not isinstance(answers, Mapping):
            raise ExerciseError(f"the answers are {answers!r:.60}: expected texts by the names of the fields")
        several = {field.name for field in self.fields if field.control == SEVERAL}
        given = {}
        for name, typed in answers.items():
            answer = _UNSEEN.sub("", typed) if isinstance(typed, str) else typed
            if isinstance(answer, Mapping):
                answer = {part: text for part, text in answer.items() if _is_typed(part, text)}
                answer = {} if answer.keys() == {"form"} else answer  # a form alone is no answer
                # in the place of one part somebody may write the whole
                answer = next((text for text in answer.values() if _CALLED.match(text)), answer)
            elif isinstance(answer, list):
                answer = [word for word in answer if _is_typed(name, word)]
                # a box of its own says that none is chosen
                answer = NONE if answer == [NONE] and name in several else answer
            elif not _is_typed(name, answer):
                continue
            if answer:
                given[name] = answer
        return given

    def _in_a_page(self, note):
        """A note as HTML: what a notebook calls has a button here, and the next exercise is a link."""
        if note == self.question.offer_of_a_hint:
            return "A hint is one press away."
        following = self.question.exercise.then
        if following and note == f"Next: {following}":
            number = re.match(r"Exercise (\S+)", following)[1]
            return f'Next: <a href="#exercise-{controls.slug(number)}">{escaped(following)}</a>'
        return sentence(note)


def _is_letter(name):
    return len(name) == 1 and name.isupper()


def _is_typed(name, text):
    """Whether something is in a field. Raises ExerciseError for what is no text."""
    if not isinstance(text, str):
        raise ExerciseError(f"the answer to {name} is {text!r:.60}: expected a text")
    if len(text) > LONGEST:
        raise ExerciseError(f"the answer to {name} has {len(text)} characters: expected at most {LONGEST}")
    return bool(text.strip())


def image(picture: Any) -> str:
    """Return a picture as HTML, in the page itself and with its description."""
    data, said = picture._repr_mimebundle_()
    said = said["image/png"]
    size = f'width="{said["width"]}" height="{said["height"]}"'
    return f'<img src="data:image/png;base64,{data["image/png"]}" alt="{escaped(said["alt"])}" {size}>'
