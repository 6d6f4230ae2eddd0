"""Words and numbers of the outputs, and texts of students made harmless."""

from __future__ import annotations

import re
from typing import TYPE_CHECKING

from exercisebook import png
from exercisebook.grammar import shortened
from exercisebook.judging import MISTAKE, OPEN, RIGHT, UNJUDGED, WAITING, WRONG
from exercisebook.wholes import WHOLES
from exercisegrader.results import NO_CODE, UNASKED
from plainmath.tables import plain_words

if TYPE_CHECKING:
    from exercisegrader.inside.plain import Plain
    from exercisegrader.results import JudgedAnswer, Result

#: The line that every output carries where student code ran with nothing around it.
NO_JAIL = "Graded without a jail: nothing kept the code of the notebook from the grader, and results can be forged."
#: The statuses of a verdict, from good to bad.
STATUSES = (RIGHT, MISTAKE, WRONG, UNJUDGED, WAITING, OPEN)

LONGEST_ANSWER = 200
LONGEST_REMARK = 400
MOST_REMARKS = 20
#: Joiners are invisible and belong to names in several scripts, and to emoji.
_JOINERS = "\u200c\u200d"
#: White space, but for what keeps a number and its unit in one line.
_SPACE = re.compile(r"[^\S\N{NO-BREAK SPACE}]+")


def visible(text: str) -> str:
    r"""Return a text in one line, with all that cannot be seen or cannot be stored written as an escape.

    >>> visible("two\nlines \x1b[31m \u202e \ud800")
    'two lines \\x1b[31m \\u202e \\ud800'
    """
    return spelled_out(" ".join(text.split()), but=_JOINERS)


def spelled_out(text: str, but: str) -> str:
    r"""Return a text with all that cannot be seen or cannot be stored written as an escape, but for some characters.

    >>> spelled_out("two\nlines \x1b[31m", but="\n")
    'two\nlines \\x1b[31m'
    """
    return text if text.isprintable() else "".join(c if c.isprintable() or c in but else _escaped(c) for c in text)


def spaced(text: str) -> str:
    """Return a text as `visible` does, with a space at each end where it had one.

    A space at which no line may be broken, as between a number and its unit, stays one.

    >>> spaced(" of \\n"), spaced("\\n"), spaced("")
    (' of ', ' ', '')
    """
    return spelled_out(_SPACE.sub(" ", text), but=f"{_JOINERS}\N{NO-BREAK SPACE}")


def _escaped(character):
    return character.encode("ascii", "backslashreplace").decode() if character > "\x7f" else f"\\x{ord(character):02x}"


def number(value: float) -> str:
    """Return a number with at most two decimals.

    >>> number(8 / 3), number(4), number(2.5)
    ('2.67', '4', '2.5')
    """
    return f"{value:.2f}".rstrip("0").rstrip(".")


def of_points(earned: float, points: float) -> str:
    """Return the points earned of those possible, in words.

    >>> of_points(8 / 3, 4), of_points(0, 1)
    ('2.67 of 4 points', '0 of 1 point')
    """
    return f"{number(earned)} of {number(points)} point{'' if points == 1 else 's'}"


def percent(fraction: float) -> str:
    """Return a fraction in percent.

    >>> percent(2 / 3)
    '67 %'
    """
    return f"{100 * fraction:.0f} %"


def counted(count: int, noun: str) -> str:
    """Return a number of things.

    >>> counted(1, "submission"), counted(0, "student")
    ('1 submission', '0 students')
    """
    return f"{count} {noun}{'' if count == 1 else 's'}"


def answer_in_words(answer: Plain) -> str:
    """Return an answer that came as plain data, on one line and not long; empty for none and for an unreadable one.

    >>> answer_in_words([2.5, "3 min", {"-1": 2}]), answer_in_words({"unreadable": "a function"})
    ('[2.5, 3 min, {-1: 2}]', '')
    """
    if isinstance(answer, dict) and [*answer] == ["unreadable"]:
        return ""
    if png.is_data(answer):
        return "a figure"
    return shortened(visible(_in_words(answer)), LONGEST_ANSWER)


def _in_words(answer):
    if isinstance(answer, dict):
        for whole in WHOLES:
            if (said := whole.in_words(answer, _in_words)) is not None:
                return said
        return "{" + ", ".join(f"{name}: {_in_words(value)}" for name, value in answer.items()) + "}"
    if isinstance(answer, list):
        return "[" + ", ".join(map(_in_words, answer)) + "]"
    if isinstance(answer, float):
        return f"{answer:.12g}"
    return "" if answer is None else str(answer)


def remarks(result: Result) -> list[str]:
    """Return what became of a notebook besides its answers, as sentences of which students may have written parts."""
    if result.status == "missing":
        return [result.says or "no notebook was handed in"]
    found = [result.says] if result.says else []
    if not found and result.status != "complete":
        found = [f"the notebook was {result.status}"]
    found += [f"cell {error.cell}: {error.says}" for error in result.errors]
    more = [f"and {len(found) - MOST_REMARKS} more"] if len(found) > MOST_REMARKS else []
    return [shortened(visible(text), LONGEST_REMARK) for text in found[:MOST_REMARKS]] + more


def hints(result: Result) -> list[str]:
    """Return what a student should know of answers that do not count where they stand, as `remarks` are."""
    return [shortened(visible(look.says), LONGEST_REMARK) for look in result.looks if look.kind in (UNASKED, NO_CODE)]


def explained(answer: JudgedAnswer) -> str:
    """Return the sentence on an answer without the word that its status says already.

    One on an answer that could not be judged may quote it: it holds no formulas.

    >>> from exercisegrader.results import JudgedAnswer
    >>> explained(JudgedAnswer("Ti", "right", "right, converted from min", "2 min", "120 s"))
    'converted from min'
    """
    says = answer.says
    if answer.status == UNJUDGED:
        return says.replace("$", "")
    return says.removeprefix("right").removeprefix(", ") if answer.status == RIGHT else says


def verdict_and_reading(answer: JudgedAnswer) -> tuple[str, str]:
    """Return what `explained` says in two parts: on the answer, and how it was read.

    >>> from exercisegrader.results import JudgedAnswer
    >>> verdict_and_reading(JudgedAnswer("Ti", "wrong", "not right; asked: the time · read as 60 s", "1 min", "120 s"))
    ('not right; asked: the time', 'read as 60 s')
    >>> verdict_and_reading(JudgedAnswer("Ti", "right", "right, converted from min", "2 min", "120 s"))
    ('', 'converted from min')
    """
    says = explained(answer)
    if answer.status == RIGHT:
        return "", says
    before, dot, behind = says.rpartition(" · ")
    return (before, behind) if dot and answer.status != UNJUDGED else (says, "")


def in_text(sentence: str) -> str:
    r"""Return a sentence without signs of formulas; a dollar sign without another one is text.

    >>> in_text(r"here $T_c = \tau$ is asked"), in_text("5 $ each")
    ('here T_c = tau is asked', '5 $ each')
    """
    pieces = spaced(sentence).split("$")
    if len(pieces) % 2 == 0:
        return "$".join(pieces)
    return "".join(plain_words(piece) if place % 2 else piece for place, piece in enumerate(pieces))
