"""A document as outputs: a page, and the same as Markdown."""

from __future__ import annotations

import functools
from collections.abc import Callable
from typing import TypeVar

from exercisegrader.reports import markdown, page
from exercisegrader.reports.document import Document
from exercisegrader.reports.outputs import output

_Function = TypeVar("_Function", bound="Callable[..., Document]")


def published(file: str, what: str) -> Callable[[_Function], _Function]:
    """Register a function that returns a document as what makes two files, ``file.html`` and ``file.md``.

    Arguments:
        file: as of `output`, without its ending.
        what: the page is, and for whom.
    """

    def register(function):
        for ending, written, says in ((".html", page.written, what), (".md", markdown.written, "the same as Markdown")):
            output(f"{file}{ending}", says)(_in_turn(function, written))
        return function

    return register


def _in_turn(function, written):
    """The function, and then a writer of what it returns; it asks for what the function asks for."""

    @functools.wraps(function)
    def content(**known):
        return written(function(**known))

    return content
