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
_IMPORTS = (
    "is not known yet: run the cell with the imports at the top first, and after a restart the cells above this one"
)
_UNIT = 'a value with its unit belongs in quotes, as in T="20 s"; and a product needs its *'
#: Names that the first cell of a chapter imports.
_IMPORTED = (
    "exercise|progress|student|s|t|np|sympy|sp|exp|sqrt|log|sin|cos|pi|oo|PID|System|Piecewise|Heaviside|Symbol|symbols"
)
_LETTERS = r"Symbol|Mul|Add|Pow|Integer|Float|Rational|int|float|complex|exp|One|Zero|Half|Pi"

#: What Python says, what is in the cell, and what is said instead; the first row that fits counts. In a sentence
#: {0} is what the first group of the message holds, and {near} the names that are like it.
SLIPS = (
    (NameError, rf"name '({_IMPORTED})' is not defined", "", "{0} " + _IMPORTS),
    (
        NameError,
        r"name '([ijI])' is not defined",
        "",
        "{0} alone is no number in Python: write 1j, or put the answer in quotes",
    ),
    (NameError, r"name '(e)' is not defined", "", f"{{0}} alone is no number in Python: write exp(...), {_QUOTES}"),
    (
        NameError,
        r"name '(PI|PD|P)' is not defined",
        "",
        '{0} is not known here: PID(2, Ti=10) is a controller, and so is the text "{0}(2, 10)" in quotes',
    ),
    (NameError, r"name '(\w+)' is not defined", "", "nothing is called {0} here: {near}"),
    (
        TypeError,
        rf"'(?:{_LETTERS})' object is not callable",
        "",
        f"before a bracket a product needs its *, as K*(s + 1); {_QUOTES}",
    ),
    (
        TypeError,
        r"for \^|'\^'|Xor|boolean",
        r"\^",
        "a power is ** in Python; or put the formula in quotes: there ^ and 2s are understood",
    ),
    (TypeError, r"'tuple'|multiply sequence", r"\d,\d", _COMMA),
    (
        TypeError,
        r"ufunc|convert expression to float|must be real number",
        "",
        f"that function is for numbers, not for symbols: write exp, sqrt ... of SymPy, {_QUOTES}",
    ),
    (
        TypeError,
        r"'str'|concatenate str|multiply sequence",
        "",
        "a text in quotes is not computed with: put the whole answer in quotes, or nothing of it",
    ),
    (AttributeError, r"'Question' object has no attribute '(\w+)'", "", "an exercise has no {0}: {near}"),
    (
        AttributeError,
        r"'(?:Symbol|Mul|Add|Pow)' object has no attribute '(?:exp|sqrt|sin|cos|log)'",
        "",
        f"that function is for numbers, not for symbols: write exp, sqrt ... of SymPy, {_QUOTES}",
    ),
    (SyntaxError, r"positional argument follows keyword|leading zeros", r"\d,\s?\d", _COMMA),
    (SyntaxError, r"positional argument follows keyword", "", "give each answer by its name, as in check(K=2, T=10)"),
    (
        SyntaxError,
        r"cannot contain assignment|cannot assign",
        "",
        "before each = stands a name alone, as the exercise asks for it: check(y=...), not check(y(t)=...)",
    ),
    (
        SyntaxError,
        r"invalid decimal literal|invalid imaginary literal|invalid hexadecimal",
        "",
        f'a product needs its *, as 2*s, and a value with a unit needs quotes, as "2 s"; {_QUOTES}',
    ),
    (
        SyntaxError,
        r"invalid (?:non-printable )?character '(.)'",
        "",
        "{0} is no sign of Python's: put the answer in quotes, where it is understood",
    ),
    (
        SyntaxError,
        r"invalid (?:non-printable )?character",
        "",
        "there is a sign that is none of Python's: put the answer in quotes",
    ),
    (SyntaxError, r"unterminated string", "", "a quote is not closed: a text begins and ends with the same one"),
    (SyntaxError, r"never closed|unexpected EOF|EOF while", "", "a bracket is not closed: count them, from ( to )"),
    (
        SyntaxError,
        r"unmatched|does not match",
        "",
        "there is a bracket too many, or one of another kind: count them, from ( to )",
    ),
    (
        SyntaxError,
        r"unexpected character after line continuation",
        "",
        'LaTeX belongs in quotes with an r before them: r"\\frac{{1}}{{s}}"',
    ),
    (SyntaxError, r"forgot a comma", "", f"{_UNIT}; {_QUOTES}"),
    (
        SyntaxError,
        r"Maybe you meant",
        "",
        "before each = stands a name alone, behind a comma: count the brackets before it",
    ),
    (SyntaxError, r"invalid syntax", r"\d\s?[%°]|[%°]\s?[,)]", _UNIT),
    (
        SyntaxError,
        r"invalid syntax",
        r"\blambda\s*=",
        'lambda is a word of Python: give this answer as check(**{{"lambda": 2}})',
    ),
    (
        SyntaxError,
        r"invalid syntax",
        "",
        f"Python cannot read this: look at its brackets, quotes and commas, {_QUOTES}",
    ),
)
#: What a question can do, for one who misspells it.
_CAN = ("check", "given", "hint", "solution", "statement", "picture")
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

    >>> sentence(NameError("name 's' is not defined"), "exercise('4.1').check(F=1/s)")[:40]
    's is not known yet: run the cell with th'
    >>> sentence(NameError("name 's' is not defined"), "1/s")
    ''
    """
    if not _ANSWERS.search(cell):
        return ""
    message = str(getattr(error, "msg", None) or error)
    for kind, pattern, in_cell, says in SLIPS:
        found = re.search(pattern, message)
        if isinstance(error, kind) and found and re.search(in_cell, cell):
            name = found[1] if found.groups() else ""
            names = _CAN if kind is AttributeError else [one for one in known if not one.startswith("_")]
            otherwise = "run the cell that computes it, or put the answer in quotes"
            return says.format(name, near=did_you_mean(name, names, otherwise=otherwise))
    return ""


def install() -> None:
    """Switch the sentences on, where this is IPython; a handler that is there already keeps what is not ours."""
    shell = sys.modules["IPython"].get_ipython() if "IPython" in sys.modules else None
    if shell is None or getattr(shell, "_loopbook_slips", False):
        return
    before, others = getattr(shell, "CustomTB", None), tuple(shell.custom_exceptions)

    def handle(shell: Any, kind: type, error: BaseException, trace: Any, tb_offset: int | None = None) -> Any:
        says = sentence(error, _cell(shell, error, trace), shell.user_ns)
        if says:
            from IPython.display import display

            display(Slip(harmless(says)))
            return []
        if others and isinstance(error, others) and before is not None:
            return before(kind, error, trace, tb_offset=tb_offset)
        shell.showtraceback((kind, error, trace), tb_offset=tb_offset, running_compiled_code=True)
        return None

    shell.set_custom_exc((*others, NameError, TypeError, SyntaxError, AttributeError), handle)
    shell._loopbook_slips = True


def _cell(shell, error, trace):
    """The code of the cell in which an error came up; empty where it came up elsewhere."""
    if isinstance(error, SyntaxError):  # of the cell itself, or of a file that it imports
        return "".join(linecache.getlines(error.filename or ""))
    while trace is not None:
        if trace.tb_frame.f_globals is shell.user_ns or trace.tb_frame.f_globals is shell.user_global_ns:
            return "".join(linecache.getlines(trace.tb_frame.f_code.co_filename))
        trace = trace.tb_next
    return ""
