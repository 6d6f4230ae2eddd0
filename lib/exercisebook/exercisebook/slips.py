"""A sentence instead of a traceback, where Python stumbles over a cell that answers an exercise.

Python's message says what is wrong with the code; `SLIPS` says what a reader of the exercise can do. Where none of its
patterns fits, and in all other cells, everything is as it was.
"""

from __future__ import annotations

import html
import linecache
import re
import sys
from collections.abc import Collection
from dataclasses import dataclass
from typing import Any

from exercisebook.judging import UNJUDGED, harmless
from exercisebook.response import MARKS
from plainmath.validation import did_you_mean

_QUOTES = "or put the formula in quotes: there 2s, K(s + 1), ^ and a decimal comma are understood"
_COMMA = "a decimal comma separates two values in Python: write 0.5 with a point, or put the number in quotes"
_UNIT = f'a value with its unit belongs in quotes, as in T="20 s"; and a product needs its *; {_QUOTES}'
#: Names that the first cell of a chapter imports.
_IMPORTED = "exercise|progress|student|s|t|np|sympy|sp|exp|sqrt|log|sin|cos|pi|oo|PID|System|Piecewise|Symbol|symbols"
_FACTORS = r"Symbol|Mul|Add|Pow|Integer|Float|Rational|int|float|complex|exp|One|Zero|Half|Pi"

#: What Python says, what is in the cell, and what is said instead; the first row that fits counts. In a sentence
#: {0} is what the first group of the message holds, and {near} the names that are like it.
SLIPS = (
    (
        NameError,
        rf"name '({_IMPORTED})' is not defined",
        "",
        "{0} is not known yet: run the cells above, imports first",
    ),
    (NameError, r"name '(\w+)' is not defined", "", "nothing is called {0} here: {near}"),
    (TypeError, rf"'({_FACTORS})' object is not callable", "", f"before a bracket a product needs its *; {_QUOTES}"),
    (TypeError, r"(for \^|Xor)", r"\^", f"a power is ** in Python; {_QUOTES}"),
    (TypeError, r"('tuple'|multiply sequence)", r"\d,\d", _COMMA),
    (SyntaxError, r"(positional argument follows keyword|leading zeros)", r"\d,\s?\d", _COMMA),
    (SyntaxError, r"(decimal literal|forgot a comma|invalid character)", r"\d\s?[^\W\d]|\d\s?[%°]", _UNIT),
    (SyntaxError, r"(invalid syntax)", r"\d\s?%", _UNIT),
    (SyntaxError, r"(.+)", "", f"Python cannot read this ({{0}}): look at its brackets, quotes and commas, {_QUOTES}"),
)
_ANSWERS = re.compile(r"\.\s*check\s*\(|\bexercise\([^()]*\)\s*\.")


@dataclass(frozen=True)
class Slip:
    """A sentence on a cell that Python could not run, shown in the box of a response."""

    says: str

    def __repr__(self) -> str:
        return f"{MARKS[UNJUDGED][0]} Not judged: {self.says}"

    def _repr_html_(self) -> str:
        mark, colour = MARKS[UNJUDGED]
        box = f"border-left: 4px solid {colour}; background: {colour}14; padding: 0.4em 0.8em; margin: 0.3em 0"
        return (
            f'<div role="status" style="{box}"><strong><span style="color: {colour}">{mark}</span> '
            f"Not judged:</strong> {html.escape(self.says, quote=False)}</div>"
        )


def sentence(error: BaseException, cell: str, known: Collection[str] = ()) -> str:
    """Return what is said instead of an error in a cell; empty where nothing is.

    Arguments:
        error: as Python raised it.
        cell: the code.
        known: the names of the reader's variables.

    >>> sentence(NameError("name 's' is not defined"), "exercise('4.1').check(F=1/s)")
    's is not known yet: run the cells above, imports first'
    >>> sentence(NameError("name 's' is not defined"), "1/s")
    ''
    """
    if not _ANSWERS.search(cell):
        return ""
    message = str(getattr(error, "msg", None) or error)
    for kind, pattern, in_cell, says in SLIPS:
        found = re.search(pattern, message)
        if isinstance(error, kind) and found and re.search(in_cell, cell):
            names = [one for one in known if not one.startswith("_")]
            otherwise = "run the cell that computes it, or put the answer in quotes"
            return says.format(found[1], near=did_you_mean(found[1], names, otherwise=otherwise))
    return ""


def install() -> None:
    """Switch the sentences on, where this is IPython and nothing else handles its errors."""
    shell = sys.modules["IPython"].get_ipython() if "IPython" in sys.modules else None
    if shell is None or shell.custom_exceptions:
        return

    def handle(shell: Any, kind: type, error: BaseException, trace: Any, tb_offset: int | None = None) -> Any:
        says = sentence(error, _cell(shell, error, trace), shell.user_ns)
        if says:
            from IPython.display import display

            display(Slip(harmless(says)))
            return []
        shell.showtraceback((kind, error, trace), tb_offset=tb_offset, running_compiled_code=True)
        return None

    shell.set_custom_exc((NameError, TypeError, SyntaxError), handle)


def _cell(shell, error, trace):
    """The code of the cell in which an error came up; empty where it came up elsewhere."""
    if isinstance(error, SyntaxError):  # of the cell itself, or of a file that it imports
        return "".join(linecache.getlines(error.filename or ""))
    while trace is not None:
        if trace.tb_frame.f_globals is shell.user_ns or trace.tb_frame.f_globals is shell.user_global_ns:
            return "".join(linecache.getlines(trace.tb_frame.f_code.co_filename))
        trace = trace.tb_next
    return ""
