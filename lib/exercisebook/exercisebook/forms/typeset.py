"""What is typed as a formula, in two dimensions while it is typed, and keys for what a telephone's keyboard hides."""

from __future__ import annotations

from collections.abc import Collection

from exercisebook.forms.mathml import convert
from exercisebook.grammar import Unreadable, read
from exercisebook.latex import latex, symbol

#: A longer text is no formula that one sees at a glance.
LONGEST = 400
#: What each key is called, what it shows, and what it writes; | is where one types on, around what was chosen.
_FIRST = (("power of e", r"e^{\square}", "e^(|)"), ("fraction", r"\frac{\square}{\square}", "(|)/()"),
          ("on to the next bracket", r"\rightarrow", ""))  # fmt: skip
_LAST = (("power", r"x^{\square}", "^(|)"), ("root", r"\sqrt{\square}", "sqrt(|)"), ("brackets", r"(\square)", "(|)"),
         ("times", r"\cdot", "*"), ("pi", r"\pi", "pi"))  # fmt: skip


def mathml(text: str, symbols: Collection[str]) -> str:
    """Return what is typed so far as MathML, as the reader that judges understands it, with its open brackets closed.

    Empty where it cannot be read (yet).

    >>> mathml("2/(s", ["s"]), mathml("2/", ["s"])
    ('<math displaystyle="true"><mfrac><mn>2</mn><mi>s</mi></mfrac></math>', '')
    """
    try:
        formula = latex(read(text + ")" * (text.count("(") - text.count(")")), symbols).tree)
        return convert(rf"\displaystyle {formula}") if formula and len(text) <= LONGEST else ""
    except (Unreadable, ValueError):
        return ""


def keys(symbols: Collection[str]) -> list[tuple[str, str, str]]:
    """Return the keys for a formula: what each is called, what it shows as MathML, and what it writes."""
    shown = (*_FIRST, *((name, symbol(name), name) for name in symbols), *_LAST)
    return [(name, convert(key), writes) for name, key, writes in shown]
