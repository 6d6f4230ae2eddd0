"""Requests and replies in JSON, between a page and the exercises."""

from __future__ import annotations

import functools
import hashlib
import json
from collections.abc import Callable
from typing import Any

from exercisebook import naming, notes, plugins
from exercisebook.errors import ExerciseError
from exercisebook.forms.sheet import Sheet
from exercisebook.forms.typeset import mathml
from exercisebook.question import Question
from plainmath.validation import did_you_mean

#: So many forms are kept, each with its key.
KEPT = 64


class Desk:
    """Replies to requests about the exercises of a bank.

    Arguments:
        exercise: a function that returns a question, as `Bank.exercise` does.
    """

    def __init__(self, exercise: Callable[[str, str | None], Question]):
        self._sheet = functools.lru_cache(maxsize=KEPT)(lambda number, student: Sheet(exercise(number, student)))

    def answer(self, text: str) -> str:
        """Return the reply to a request, JSON for JSON; nothing is read from files or written to them.

        The requests by what they ``do``, each with an ``exercise`` and a ``student``, who is null without a name:

        - show: ``{html, controls}``: the statement and the fields, as HTML;
        - check, with ``answers``: ``{right, says, html, verdicts: [{name, status, says, html}]}``;
        - prepare: ``{}``; the key is computed and judged, so that the first answer takes no longer than the next one;
        - hint, with a ``rung`` from 1: ``{html}``;
        - solution: ``{html}``. Whether an attempt comes first is for the page to say;
        - typeset, with the ``text`` of a formula and its ``symbols``, for no exercise: ``{mathml}``, how it is read.

        What cannot be answered has the reply ``{"problem": "one sentence"}``.
        """
        try:
            request = _read(text)
            if not isinstance(request, dict):
                raise ExerciseError("the request is no table: expected one with do and exercise")
            do = request.get("do")
            if do == "typeset":
                reply = {"mathml": mathml(str(request.get("text", "")), str(request.get("symbols", "")).split())}
            elif not isinstance(do, str) or do not in _REPLIES:
                raise ExerciseError(f"the request asks to do {do!r}: {did_you_mean(str(do), _REPLIES)}")
            else:
                with notes.off():
                    reply = _REPLIES[do](self._sheet(request.get("exercise"), _name(request.get("student"))), request)
        except (ExerciseError, ValueError) as problem:
            reply = {"problem": str(problem)}
        return json.dumps(reply, ensure_ascii=False)


@functools.cache
def version() -> str:
    """Return a short hash of the library: a page and the Python that answers in it must have the same."""
    found = hashlib.sha256()
    for path in sorted(path for folder in plugins.folders() for path in folder.rglob("*.py")):
        found.update(path.read_bytes())
    return found.hexdigest()[:12]


def _read(text):
    try:
        return json.loads(text)
    except ValueError as problem:
        raise ExerciseError(f"the request is no JSON: {problem}") from None


def _name(student):
    return None if student is None else naming.checked(student)


def _show(sheet: Sheet, request: dict[str, Any]) -> dict[str, Any]:
    return {"html": sheet.statement, "controls": sheet.controls}


def _check(sheet: Sheet, request: dict[str, Any]) -> dict[str, Any]:
    return sheet.check(request.get("answers", {}))


def _prepare(sheet: Sheet, request: dict[str, Any]) -> dict[str, Any]:
    sheet.rehearse()
    return {}


def _hint(sheet: Sheet, request: dict[str, Any]) -> dict[str, Any]:
    return {"html": sheet.hint(request.get("rung", 1))}


def _solution(sheet: Sheet, request: dict[str, Any]) -> dict[str, Any]:
    return {"html": sheet.solution}


_REPLIES: dict[str, Callable[[Sheet, dict[str, Any]], dict[str, Any]]] = {
    "show": _show,
    "check": _check,
    "prepare": _prepare,
    "hint": _hint,
    "solution": _solution,
}
