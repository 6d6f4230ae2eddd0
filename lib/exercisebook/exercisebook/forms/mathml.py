"""Mathematics as MathML: a browser draws it without a script and without a network.

latex2mathml does the translation. What is done here is what its output lacks in a browser: upright names of functions
with their space, accents that sit close, bars without air, and a fraction of the bytes. And whoever wrote a formula, it
is one and nothing else: the translator does not escape what is text in it, and hands on links and styles.
"""

from __future__ import annotations

import functools
import html
import re
from collections.abc import Iterator
from itertools import pairwise
from xml.etree import ElementTree as ET

from latex2mathml.converter import convert as translate

__all__ = ["convert", "formulas", "in_html"]

NAMESPACE = "{http://www.w3.org/1998/Math/MathML}"
APPLY = "\u2061"  # the invisible sign between a function and its argument
PRIMES = {"′", "″", "‴"}
BRACKETS = set("()[]{}⟨⟩")
SIGNS = {"−", "+", "±"}
CLOSING = {")", "]", "}", "|", "!"}
HIGH = {"mfrac", "mtable", "msqrt", "mroot", "munder", "mover", "munderover"}
TAGS = {
    "math", "mrow", "mi", "mn", "mo", "mtext", "mspace", "mfrac", "msqrt", "mroot", "msub", "msup", "msubsup",
    "mover", "munder", "munderover", "mtable", "mtr", "mtd", "mstyle", "mpadded", "mphantom", "menclose",
}  # fmt: skip
ATTRIBUTES = {
    "display", "stretchy", "fence", "separator", "form", "mathvariant", "mathsize", "displaystyle", "scriptlevel",
    "linebreak", "linethickness", "width", "columnalign", "columnspacing", "rowspacing", "minsize", "maxsize", "lspace",
    "rspace", "accent", "accentunder", "movablelimits", "notation",
}  # fmt: skip
SUMS = {"∫", "∑", "∏"}
BIG = {"lim", "max", "min", "sup", "inf", "arg min", "arg max"}  # their index is below them in a displayed formula


@functools.cache
def convert(latex: str, display: bool = False) -> str:
    """Return a formula as MathML.

    Arguments:
        latex: the formula, without dollars.
        display: on a line of its own.
    Raises:
        ValueError: the formula cannot be translated.
    """
    source = latex.strip()
    large = source.startswith(r"\displaystyle")
    source = source.removeprefix(r"\displaystyle").strip()
    try:
        tree = ET.fromstring(translate(_prepared(source), display="block" if display or large else "inline"))
    except Exception as problem:
        raise ValueError(f"{latex!r} cannot be written as MathML: {type(problem).__name__} {problem}") from problem
    for element in tree.iter():
        element.tag = element.tag.removeprefix(NAMESPACE)
        if element.tag not in TAGS:  # the translator takes what is between < and > for an element
            raise ValueError(f"{latex!r} cannot be written as MathML: it holds <{element.tag}>")
        for name in element.attrib.keys() - ATTRIBUTES:
            del element.attrib[name]
    _mend(tree, large=display or large)
    for row in (tree, *tree.findall("mrow")) if display or large else ():
        for place, child in reversed(list(enumerate(row))):
            if child.tag == "mstyle":  # it is large already
                row[place : place + 1] = list(child)
    tree.attrib.clear()
    if display:
        tree.set("display", "block")
    elif large and any(element.tag in HIGH or element.text in BIG | SUMS for element in tree.iter()):
        tree.set("displaystyle", "true")
    return ET.tostring(tree, encoding="unicode")


def _prepared(latex):
    r"""Return a formula in the words that the translator knows.

    >>> _prepared(r"\mathrm{kg}"), _prepared(r"\text{remains, $D$ here}")
    ('\\text{kg}', '\\text{remains, }D\\text{ here}')
    """
    latex = re.sub(r"\\mathrm\s*\{([^{}\\]*)\}", r"\\text{\1}", latex)
    return re.sub(r"\\text\{([^{}$]*)\$((?:[^{}$]|\{[^{}]*\})*)\$([^{}$]*)\}", r"\\text{\1}\2\\text{\3}", latex)


def _mend(parent, large):
    """Set right, in place, what the translator leaves to be wished."""
    for child in list(parent):
        _mend(child, large)
    for place, child in reversed(list(enumerate(list(parent)))):
        if _is_function(child):
            after = parent[place + 1] if place + 1 < len(parent) else None
            script_base = parent.tag in {"msub", "msup", "msubsup", "munder", "mover", "munderover"}
            if not script_base and after is not None and after.tag != "mo":
                if not _is_bracketed(after):
                    parent.insert(place + 1, _made("mspace", width="0.167em"))
                parent.insert(place + 1, _made("mo", APPLY))
    if parent.tag in {"mi", "mo"} and _is_name(parent):
        parent.tag = "mi"
        parent.attrib.clear()
    if parent.tag == "mtext" and parent.text:
        parent.text = parent.text.replace(r"\%", "%")  # a percent sign alone would begin a comment
    if parent.tag == "msub" and large and parent[0].text in BIG:
        parent.tag = "munder"
    if parent.tag in {"msup", "msubsup"} and parent[-1].text in PRIMES:
        _prime(parent)
    if parent.tag == "mover" and parent[1].tag == "mo":
        parent.set("accent", "true")
    if parent.tag == "mo":
        _slim(parent)
    if parent.tag == "mrow" and len(parent) > 1:
        _keep_small(parent)
    for before, child in pairwise(parent):
        if child.tag == before.tag == "mo" and child.text in SIGNS and before.text not in CLOSING:
            child.set("form", "prefix")  # the sign of a number, not an operation
    for place, child in enumerate(list(parent)):
        if child.tag == "mrow" and len(child) == 1:
            parent[place] = child[0]
    if parent.tag == "math" and len(parent) == 1 and parent[0].tag == "mrow":
        inner = parent[0]
        parent[:] = list(inner)


def _prime(element):
    """Put a prime beside its letter: the font raises it already."""
    letter, *index, sign = element
    element[:] = []
    marked = _made("mrow")
    marked[:] = [letter, _made("mo", sign.text, lspace="0", rspace="0")]
    element.tag = "msub" if index else "mrow"
    element[:] = [marked, *index] if index else list(marked)


def _is_name(element):
    return bool(element.text) and len(element.text) > 1 and element.text.replace(" ", "").isalpha()


def _is_function(element):
    base = element[0] if element.tag in {"msub", "msup", "msubsup", "munder"} and len(element) else element
    return base.tag == "mi" and _is_name(base)


def _is_bracketed(element):
    while element.tag == "mrow" and len(element):
        element = element[0]
    return element.tag == "mo" and element.text in BRACKETS | {"|"}


def _slim(operator):
    """Leave away what a browser assumes of a bracket, and the air around a bar that belongs to a pair."""
    if operator.get("stretchy") == "true" and operator.text in BRACKETS:
        for name in ("stretchy", "fence", "form"):
            operator.attrib.pop(name, None)
    elif operator.text == "/" or (operator.text == "|" and operator.get("stretchy") == "false"):
        operator.set("lspace", "0")
        operator.set("rspace", "0")


def _keep_small(row):
    """Brackets about what is no higher than a letter stay as they are: a browser would take the next larger ones."""
    pair = [child for child in (row[0], row[-1]) if child.tag == "mo" and child.text in BRACKETS]
    if len(pair) == 2 and not HIGH & {element.tag for element in row.iter()}:
        for bracket in pair:
            bracket.set("stretchy", "false")


def _made(tag, text=None, **attributes):
    element = ET.Element(tag, attributes)
    element.text = text
    return element


def formulas(text: str) -> Iterator[tuple[str, bool]]:
    r"""Cut a text at its formulas: yield pairs (piece, is it a formula). A dollar within braces ends no formula.

    >>> list(formulas(r"a $x$ b"))
    [('a ', False), ('x', True), (' b', False)]
    """
    start = position = depth = 0
    inside = False
    while position < len(text):
        sign = text[position]
        if sign == "\\":
            position += 1
        elif inside and sign in "{}":
            depth += 1 if sign == "{" else -1
        elif sign == "$" and depth == 0:
            yield text[start:position], inside
            start, inside = position + 1, not inside
        position += 1
    yield text[start:], inside


def in_html(text: str) -> str:
    """Return a piece of HTML with its formulas between dollars as MathML; what is code stays as it is."""
    pieces = re.split(r"(<code>.*?</code>)", text, flags=re.DOTALL)
    return "".join(
        piece
        if piece.startswith("<code>")
        else "".join(convert(html.unescape(part)) if is_formula else part for part, is_formula in formulas(piece))
        for piece in pieces
    )
