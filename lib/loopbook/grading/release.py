"""Releasing an assignment: one notebook per student, with the student's own numbers and nothing of the key."""

from __future__ import annotations

import base64
import hashlib
import html
import io
import itertools
import json
import re
import tokenize
from collections.abc import Callable, Collection, Iterable, Mapping
from pathlib import Path
from typing import TYPE_CHECKING

from nbformat import v4

from loopbook import notebooks
from loopbook.exercises.kinds.kind import literal
from loopbook.exercises.parameters import call
from loopbook.grading import GradingError, files
from loopbook.grading.assignment import check_names

if TYPE_CHECKING:
    from nbformat import NotebookNode

    from loopbook.exercises.question import Question
    from loopbook.grading.assignment import Assignment
    from loopbook.grading.roster import Student

MOST_LINES, MOST_COLUMNS = 12, 88
#: Formulas and code, in which braces have a meaning of their own.
_NOT_FILLED_IN = re.compile(r"\$\$.*?\$\$|\$.*?\$|`.*?`", re.DOTALL)
#: The place of a value; in front of it is none of what LaTeX has before a brace.
_PLACE = re.compile(r"(?<![\w\\{}])\{([^\W\d]\w*)\}(?!\})")
_HOW_TO_ANSWER = (
    "Put your answers in the places of the dots and run the cells: each shows how your answer is read, and nothing "
    "about right or wrong. You can answer as often as you like before you save this notebook and hand it in; the last "
    "answer counts."
)


def release(assignment: Assignment, students: Iterable[Student], folder: str | Path) -> list[Path]:
    """Write the notebooks of the students, ``folder/<student's id>/<assignment's name>.ipynb``; return their paths.

    The same call writes the same bytes. All notebooks are made before the first one is written.

    Arguments:
        assignment: `Assignment`.
        students: each with `id` and `name`.
        folder: where to; made if it is not there.
    Raises:
        GradingError: where a variant fails, and for a file in the way that is not as it was released.
    """
    texts = {}
    for student in students:
        path = Path(folder, student.id, f"{assignment.name}.ipynb")
        texts[path] = notebooks.as_text(notebook(assignment, student))
        _check_replaceable(path, texts[path])
    for path, text in texts.items():
        files.write(path, text)
    return list(texts)


def notebook(assignment: Assignment, student: Student) -> NotebookNode:
    """Return the notebook of a student. Raises GradingError where a variant fails."""
    questions = {number: asked(assignment, student.id, number) for number in assignment.exercises}
    person = f"**{as_markdown(student.name or student.id)}** (`{student.id}`)"
    introduction = [f"# {assignment.title}", person, assignment.introduction, _HOW_TO_ANSWER]
    cells = [v4.new_markdown_cell("\n\n".join(part for part in introduction if part))]
    cells += map(v4.new_code_cell, set_up(assignment.title, student.id, questions))
    for number, question in questions.items():
        cells += statement_cells(question)
        cells.append(v4.new_code_cell(answer_call(number, dict.fromkeys(question.key, "..."))))
    cells.append(v4.new_code_cell("sheet"))
    made = bare(cells)
    made.metadata.loopbook = {
        "assignment": assignment.name,
        "released": _digest(made),
        "student": student.id,
    }
    return made


def asked(assignment: Assignment, student_id: str, number: str) -> Question:
    """Return a student's question, with all that will be needed of it. Raises GradingError where that fails."""
    label = f"exercise {number} of {assignment.name} for student {student_id}"
    return checked(lambda: assignment.question(student_id, number), label)


def checked(make: Callable[[], Question], label: str) -> Question:
    """Return the question that a function makes, with all that will be needed of it.

    Raises GradingError, in a sentence that begins with the label, where a function of the author fails.
    """
    try:
        question = make()
        check_names(question)
        _check_places(question)
        _check_key(question)
        statement_cells(question)
    except GradingError:
        raise
    except Exception as problem:  # the functions are the author's
        raise GradingError(f"{label}: {problem}") from problem
    return question


def statement_cells(question: Question) -> list[NotebookNode]:
    """Return the cells that put a question: the statement with its picture, and the data that it hands out."""
    cell = v4.new_markdown_cell(question.statement)
    if picture := question.picture:
        cell.source += f"\n\n![{as_markdown(picture.alt)}](attachment:picture.png)"
        cell.attachments = {"picture.png": {"image/png": base64.b64encode(picture.png()).decode()}}
    data = [wrapped(f"{name} = {literal(values)}") for name, values in question.data.items()]
    return [cell, *([v4.new_code_cell("\n".join(data))] if data else [])]


def _check_places(question):
    """Raise GradingError for a place in the statement, or in the sentence of a mistake, that no value fills."""
    exercise = question.exercise
    names = [*question.values, *call(exercise.shown, question.values)]
    for text in (exercise.statement, *(sentence for sentence, _ in exercise.mistakes)):
        for place in _PLACE.finditer(_NOT_FILLED_IN.sub("", text)):
            if place[1] not in names:
                raise GradingError(
                    f"exercise {exercise.number} has {place[0]} in a text: expected one of {', '.join(names)}, or "
                    f"{{{place[0]}}} for the braces themselves"
                )


def _check_key(question):
    """Raise GradingError for a key that would not be right, and for a mistake that is not a possible answer."""
    number = question.exercise.number
    for name, kind in question.key.items():
        if not (kind.by_hand or kind.agrees(kind.key)):
            says = f"the key of {name} in exercise {number} would not be right{question.with_values}"
            raise GradingError(f"{says}: {kind.hint(kind.key)}")
        for sentence, wrong in question.mistakes[name]:
            try:
                kind.like(wrong)
            except ValueError as problem:
                says = f'the mistake "{sentence}" of {name} in exercise {number} is not a possible answer'
                raise GradingError(f"{says}{question.with_values}: {problem}") from problem


def bare(cells: list[NotebookNode]) -> NotebookNode:
    """Return the notebook of some cells, in the form in which notebooks are stored, of which nothing was run."""
    made = notebooks.normalised(v4.new_notebook(cells=cells))
    for number, cell in enumerate(made.cells, start=1):
        cell.id = f"cell-{number:03}"  # a new cell has one at random
    return made


def set_up(title: str, student_id: str, questions: Mapping[str, Question]) -> list[str]:
    """Return the sources of the cells that make the sheet and say what it asks: forms, and nothing of the keys."""
    makers = {kind.asking.partition("(")[0] for question in questions.values() for kind in question.key.values()}
    sheet = wrapped(f"sheet = AnswerSheet({literal(title)}, student={literal(student_id)})")
    sources = [f"{imported('loopbook.grading.answer_sheet', {'AnswerSheet', *makers})}\n\n{sheet}"]
    for number, question in questions.items():
        forms = [f"{name}={kind.asking}" for name, kind in question.key.items()]
        call = wrapped(f"sheet.asks({', '.join([literal(number), *forms])})")
        together = f"{sources[-1]}\n{call}"
        if together.count("\n") < MOST_LINES:
            sources[-1] = together
        else:
            sources.append(call)
    return sources


def imported(module: str, names: Collection[str]) -> str:
    """Return the import of several names, as code."""
    names = ", ".join(sorted(names))
    line = f"from {module} import {names}"
    return line if len(line) <= MOST_COLUMNS else wrapped(f"from {module} import ({names})")


def answer_call(number: str, values: Mapping[str, str]) -> str:
    """Return the call that gives answers, as code: {quantity: code of its value}."""
    return wrapped(f"sheet.answer({', '.join([literal(number), *(f'{n}={v}' for n, v in values.items())])})")


def wrapped(code: str) -> str:
    """Return a line of code with a bracket as lines that are not too long, broken after commas, outer ones first.

    >>> print(wrapped(f"sheet.asks({', '.join(['1', *(f'angle_{k}=number()' for k in range(5))])})"))
    sheet.asks(
        1, angle_0=number(), angle_1=number(), angle_2=number(), angle_3=number(),
        angle_4=number()
    )
    """
    if len(code) <= MOST_COLUMNS:
        return code
    opening, outer, inner = _places(code)
    if opening is None:
        return code
    lines, closing = [""], len(code) - 1
    for start, end in _pieces(opening, outer, closing):
        breaks = [place for place in inner if start < place < end] if end - start > MOST_COLUMNS - 4 else []
        if breaks and lines[-1]:  # what needs several lines begins on one of its own
            lines.append("")
        for piece in (code[begin:stop].strip() for begin, stop in _pieces(start, breaks, end)):
            if lines[-1] and len(lines[-1]) + 1 + len(piece) > MOST_COLUMNS - 4:
                lines.append("")
            lines[-1] += f" {piece}" if lines[-1] else piece
    return "\n".join([code[:opening], *(f"    {line}" for line in lines), code[closing:]])


def _places(code):
    """Where the first bracket of some code has opened, and where its commas end: its own, and those further inside."""
    opening, depth, outer, inner = None, 0, [], []
    for token in tokenize.generate_tokens(io.StringIO(code).readline):
        if token.type != tokenize.OP:
            continue
        if token.string in "([{":
            opening = opening or token.end[1]
            depth += 1
        elif token.string in ")]}":
            depth -= 1
        elif token.string == "," and depth:
            (outer if depth == 1 else inner).append(token.end[1])
    return opening, outer, inner


def _pieces(start, places, end):
    """Pairs of a beginning and an end, from each of the places to the next."""
    return list(itertools.pairwise([start, *places, end]))


def as_markdown(text: str) -> str:
    r"""Return a text as Markdown in which it is nothing but that text: no markup, no link, no formula.

    >>> print(as_markdown("*Zoë* O'Brien-Lee <b> $x$"))
    \*Zoë\* O'Brien-Lee &lt;b&gt; <span>&#36;</span>x<span>&#36;</span>
    """
    line = html.escape(" ".join(text.split()), quote=False)
    # HTML takes the place of what Markdown and formulas would both look at
    return re.sub(r"[$\\]|[`*_{}\[\]#+!|~:.@=^]", _harmless_sign, re.sub(r"&(?!\w+;)", "&amp;", line))


def _harmless_sign(match):
    return f"<span>&#{ord(match[0])};</span>" if match[0] in "$\\" else f"\\{match[0]}"


def _check_replaceable(path, text):
    """Raise GradingError where a file is in the way that is neither this text nor a notebook as it was released."""
    if not path.exists():
        return
    try:
        if path.read_bytes() == text.encode():
            return
        there = notebooks.read(path)
    except OSError as problem:
        raise GradingError(f"{path} cannot be read: {problem.strerror}") from None
    except notebooks.NotebookError:
        there = None
    released = there.metadata.get("loopbook", {}).get("released") if there else None
    if released is None or released != _digest(there):
        raise GradingError(
            f"{path} is in the way and not as it was released: move it away, or release to another folder"
        )


def _digest(released):
    """A text that changes with the cells of a notebook."""
    sources = [(cell.cell_type, cell.source) for cell in released.cells]
    return hashlib.sha256(json.dumps(sources).encode()).hexdigest()
