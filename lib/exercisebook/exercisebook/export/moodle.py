"""Variants of exercises as Moodle XML, the file that a question bank imports.

Numbers and words are cells of a Cloze question, each wrong answer that is known with its sentence and its share.

Source: `question/type/multianswer/questiontype.php` of Moodle 4.5, whose patterns a cell must meet. Of several answers
the first that fits counts, a tolerance is absolute, and entities in a sentence are decoded once.
"""

from __future__ import annotations

import base64
import re
import urllib.parse
from collections.abc import Callable, Iterable, Iterator, Sequence
from dataclasses import dataclass, field
from typing import TypeAlias
from xml.etree import ElementTree

from exercisebook.credit import NOTHING, Credit
from exercisebook.export.cells import CannotHoldError, Cell, cells
from exercisebook.forms.sheet import Sheet
from exercisebook.forms.text import escaped, html, inline, sentence
from exercisebook.kinds import Number, Word
from exercisebook.question import Question

#: A larger file is refused by a server that is as PHP comes.
LARGEST = 1_900_000
#: A number is written with so many digits; one that is compared more exactly than to this fraction, with all of them.
DIGITS, ALL_DIGITS, EXACTLY = 6, 15, 1e-3
#: What follows the statement: the numbers that are typed are read by others than our reader.
NOTE = "Write numbers with a decimal point and without their units."
#: What is in a page itself, and belongs into a file of its own.
_FILE = re.compile(r'"data:(?:image/(png);base64|text/(csv);charset=utf-8),([^"]+)"')
IN_A_TEXT = str.maketrans({sign: f"&#{ord(sign)};" for sign in "{}[]"})
_IN_A_CELL = str.maketrans({"&": "&amp;"} | {sign: f"&#{ord(sign)};" for sign in "}~#=%"})

#: How a type of questions holds a variant: its name, the cells with their places as HTML, and what else it says.
Held: TypeAlias = tuple[str, list[tuple[Cell, str]], list[ElementTree.Element]]


@dataclass
class Exported:
    """What was written, and what could not be.

    Attributes:
        files: each can be imported alone.
        questions: how many of them are in the files.
        left_out: {number of an exercise: what it asks for that has no place}.
    """

    files: list[bytes] = field(default_factory=list)
    questions: int = 0
    left_out: dict[str, str] = field(default_factory=dict)


def exported(
    exercises: Iterable[Iterable[Question]],
    place: str,
    credit: Credit = NOTHING,
    forms: Sequence[Callable[[Question, Credit], Held]] = (),
) -> Exported:
    """Return exercises as files of Moodle XML, with a category for each exercise.

    Arguments:
        exercises: the variants of each; equal ones are written once.
        place: the category above them.
        credit: what is worth something though it is not right.
        forms: in the first that holds an exercise it is written; in `cloze`, if there is none.
    """
    done, written = Exported(), []
    for variants in exercises:
        different = {tuple(one.values.items()): one for one in variants}.values()
        try:
            found = [_element(one, count, credit, forms or [cloze]) for count, one in enumerate(different, start=1)]
        except CannotHoldError as why:
            done.left_out[next(iter(different)).exercise.number] = str(why)
            continue
        exercise = next(iter(different)).exercise
        written.append((_category(place, f"{exercise.number} {exercise.title}"), found))
        done.questions += len(found)
    done.files = [b'<?xml version="1.0" encoding="UTF-8"?>\n<quiz>' + one + b"</quiz>\n" for one in _parts(written)]
    return done


def _parts(written: Iterable[tuple[ElementTree.Element, list[ElementTree.Element]]]) -> Iterator[bytes]:
    """The questions in parts that are not too large, each below its category."""
    part = b""
    for category, questions in written:
        head = b"\n" + ElementTree.tostring(category)
        part += head
        for one in map(ElementTree.tostring, questions):
            if len(part) + len(one) > LARGEST and part.count(b"<question ") > 1:
                yield part.removesuffix(head)
                part = head
            part += b"\n" + one
    if part:
        yield part


def _category(*path):
    found = ElementTree.Element("question", type="category")
    # a slash parts one from another
    add(add(found, "category"), "text", "/".join(["$course$/top", *(one.replace("/", "//") for one in path)]))
    return found


def _element(question, count, credit, forms):
    """One variant, in the first form that holds it."""
    for form in forms:
        try:
            kind, places, more = form(question, credit)
            break
        except CannotHoldError as problem:
            why = problem
    else:
        raise why
    exercise = question.exercise
    element = ElementTree.Element("question", type=kind)
    add(add(element, "name"), "text", f"{exercise.number} {exercise.title} · {count}")
    asked = "".join(
        f"<p><code>{escaped(cell.name)}</code>: {inline(_asked(cell.kind)).translate(IN_A_TEXT)} {place}</p>"
        for cell, place in places
    )
    sheet = Sheet(question)
    above = "\n".join(filter(None, [sheet.text, sheet.pictures, sheet.download()]))
    has_numbers = any(not hasattr(cell.kind, "among") for cell, _ in places)
    below = sheet.accuracy + (f"<p>{NOTE}</p>" if has_numbers else "")
    add_text(element, "questiontext", above.translate(IN_A_TEXT) + asked + below.translate(IN_A_TEXT))
    solution = html(question.solved().body).translate(IN_A_TEXT) if exercise.worked else ""
    add_text(element, "generalfeedback", solution)
    add(element, "defaultgrade", sum(cell.weight for cell, _ in places))
    element.extend(more)
    return element


def _asked(kind):
    """What is asked; words to choose from are in the cell."""
    return kind.what if hasattr(kind, "among") else kind.asked


def add(parent: ElementTree.Element, tag: str, text: object = "") -> ElementTree.Element:
    """Append an element with a text to another one, and return it."""
    one = ElementTree.SubElement(parent, tag)
    one.text = str(text)
    return one


def add_text(parent: ElementTree.Element, tag: str, text: str) -> None:
    """Append a text in HTML to an element, with the files that are in it beside it."""
    one, files = add(parent, tag), []

    def beside(found):
        content = found[3] if found[1] else base64.b64encode(urllib.parse.unquote(found[3]).encode()).decode()
        files.append((f"{len(files) + 1}.{found[1] or found[2]}", content))
        return f'"@@PLUGINFILE@@/{files[-1][0]}"'

    one.set("format", "html")
    add(one, "text", _FILE.sub(beside, text))
    for name, content in files:
        add(one, "file", content).attrib.update(name=name, path="/", encoding="base64")


def cloze(question: Question, credit: Credit = NOTHING) -> Held:
    """Return a variant as a Cloze question. Raises CannotHoldError for answers that it does not read."""
    for kind in question.key.values():
        if type(kind) is not Number and not (type(kind) is Word and len(kind.among) > 1):
            raise CannotHoldError(kind.maker.replace("_", " "))
    return "cloze", [(one, _cell(one)) for one in cells(question, credit)], []


def _cell(cell):
    """A cell as text, in braces."""
    if type(cell.kind) is Number:
        answers = [_number(cell.kind, one) for one in cell.known]
        return f"{{{cell.weight}:NUMERICAL:{'~'.join(answers)}}}"
    known = {one.value: one for one in cell.known}
    answers = [_alternative(escaped(word).translate(_IN_A_CELL), known[word]) for word in cell.kind.among]
    return f"{{{cell.weight}:MULTICHOICE:{'~'.join(answers)}}}"


def _number(kind, known):
    """A number and by how much an answer may be off; of what may be rounded no more digits than are needed."""
    digits = ALL_DIGITS if kind.within < EXACTLY else DIGITS
    value = known.value if known.share == 100 and not known.says else (known.low + known.high) / 2
    value = float(f"{value:.{digits}g}")
    off = max(known.high - value, 0.0) if known.low != known.high else 0.0
    return _alternative(f"{value!r}" + (f":{off:.6g}" if off else ""), known)


def _alternative(text, known):
    share = "=" if known.share == 100 else f"%{known.share:g}%" if known.share else ""
    return f"{share}{text}#{sentence(known.says).translate(_IN_A_CELL)}" if known.says else f"{share}{text}"
