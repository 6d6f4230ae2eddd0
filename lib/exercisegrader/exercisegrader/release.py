"""Releasing an assignment: one notebook per student, with the student's own numbers and nothing of the key."""

from __future__ import annotations

import base64
import enum
import html
import importlib.metadata
import re
import textwrap
from collections.abc import Collection, Iterable, Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING

import nbformat
from nbformat import NotebookNode, v4

from exercisebook.forms.sheet import with_arrays
from exercisebook.kinds.kind import literal
from exercisebook.parameters import call
from exercisegrader import GradingError, files
from exercisegrader.assignment import check_names
from exercisegrader.imprint import Imprint, cells_of, proofs
from exercisegrader.released import Released, in_short, texts

if TYPE_CHECKING:
    from exercisebook.question import Question
    from exercisegrader.assignment import Assignment
    from exercisegrader.released import Numbers
    from exercisegrader.roster import Student

MOST_LINES, MOST_COLUMNS = 12, 88
_IMPORTS = re.compile(r"^(?:from|import) ", re.MULTILINE)
METADATA = {
    "kernelspec": {"display_name": "Python 3", "language": "python", "name": "python3"},
    "language_info": {"name": "python"},
}
#: Entry points of packages for whose subject this grader is used: each names the module from which a released notebook
#: imports the answer sheet, and the package that students install.
GROUP = "exercisegrader.answer_sheets"
#: Formulas and code, in which braces have a meaning of their own.
_NOT_FILLED_IN = re.compile(r"\$\$.*?\$\$|\$.*?\$|`.*?`", re.DOTALL)
#: The place of a value; in front of it is none of what LaTeX has before a brace.
_PLACE = re.compile(r"(?<![\w\\{}])\{([^\W\d]\w*)\}(?!\})")
#: The first bracket of a line of code, with what is before it, and what of the code is never broken.
_OPENING = re.compile(r"""[^"'(\[{]*[(\[{]""")
_TOGETHER = re.compile(r""""(?:[^"\\]|\\.)*"|'(?:[^'\\]|\\.)*'|(?<!,) +""")
_HOW_TO_ANSWER = (
    "Put your answers in the places of the dots and run the cells: each shows how your answer is read, and nothing "
    'about right or wrong. What is no plain number or list goes between quotes, as `"2 min"`. You can answer as often '
    "as you like before you save this notebook and hand it in; the last answer counts."
)


@dataclass(frozen=True)
class Release:
    """What a release did.

    Attributes:
        paths: of the notebooks of all students, in the order of the roster.
        added, replaced, kept: ids of those whose notebook is new, takes the place of another, or was there as it is.
        worked_in: ids of those whose notebook stays though it would be another one now: somebody has worked in it.
        record: where the numbers are kept; None for an assignment that was made from a text.
        remarks: sentences on what is no longer as at earlier releases.
        students: the roster, with the ids of the record.
    """

    paths: tuple[Path, ...]
    added: tuple[str, ...]
    replaced: tuple[str, ...]
    kept: tuple[str, ...]
    worked_in: tuple[str, ...]
    record: Path | None
    remarks: tuple[str, ...]
    students: tuple[Student, ...]


def release(
    assignment: Assignment,
    students: Iterable[Student],
    folder: str | Path,
    *,
    replace: bool = False,
    new_numbers: bool = False,
) -> Release:
    """Write the notebooks of the students, ``folder/<student's id>/<assignment's name>.ipynb``, and the record.

    Numbers that were released before, by the record beside the assignment, stay. The same call writes the same bytes.
    All notebooks are made before the first one is written; where one is there that would change, none is written.

    Arguments:
        assignment: `Assignment`.
        students: each with `id` and `name`.
        folder: where to; made if it is not there.
        replace: put new notebooks in the place of others; those in which somebody has worked stay.
        new_numbers: with `replace`, draw the numbers anew from the ranges as they are now.
    Raises:
        GradingError: where a variant fails, for notebooks that would change, for a file in the way, and for a record
            that does not belong to the assignment.
    """
    if new_numbers and not replace:
        raise GradingError("new numbers are for notebooks that are replaced: expected --replace beside --new-numbers")
    before = Released.of(assignment)
    students, remarks = before.identified(students)
    plans = [_plan(assignment, student, Path(folder), before, new_numbers) for student in students]
    _demand_allowed(plans, folder, replace, new_numbers, before)
    record = before
    for plan in plans:
        if plan.what is not _What.WORKED_IN or plan.student.id not in before.holders:
            record = record.with_release(plan.student, plan.numbers)
    if assignment.record:
        record.write(assignment.record, assignment.secret)
    for plan in plans:
        if plan.what in (_What.ADDED, _What.TEXT, _What.NUMBERS):
            files.write(plan.path, plan.text)

    def ids(*which):
        return tuple(plan.student.id for plan in plans if plan.what in which)

    known = [student for student in students if student.id in before.holders]
    if before.path and not new_numbers:
        remarks += before.differences(assignment, known)
    return Release(
        tuple(plan.path for plan in plans), ids(_What.ADDED), ids(_What.TEXT, _What.NUMBERS), ids(_What.SAME),
        ids(_What.WORKED_IN), assignment.record, remarks, students,
    )  # fmt: skip


class _What(enum.Enum):
    """What a release would do to the place of a notebook."""

    ADDED = "nothing is there"
    SAME = "it is there"
    TEXT = "another text is there, with the same numbers"
    NUMBERS = "others are there, with other numbers"
    WORKED_IN = "another one is there, in which somebody has worked"
    FOREIGN = "something else is there"


@dataclass(frozen=True)
class _Plan:
    """The notebook of a student: where, which, with which numbers, and what of it would be another."""

    student: Student
    path: Path
    text: str
    numbers: dict[str, dict[str, str]]
    what: _What
    parts: tuple[str, ...] = ()


def _plan(assignment, student, folder, record, new_numbers):
    released = {} if new_numbers else record.numbers(student.id)
    questions = {n: asked(assignment, student.id, n, released.get(n)) for n in assignment.exercises}
    numbers = {number: texts(question) for number, question in questions.items()}
    path = folder / student.id / f"{assignment.name}.ipynb"
    made = _notebook(assignment, student, questions)
    content = as_text(made)
    there, imprint = _there(path)
    if there is None:
        return _Plan(student, path, content, numbers, _What.ADDED)
    if there == content:
        return _Plan(student, path, content, numbers, _What.SAME)
    if imprint is None or (imprint.assignment, imprint.student) != (assignment.name, student.id):
        return _Plan(student, path, content, numbers, _What.FOREIGN)
    as_before = _notebook(assignment, student, questions, imprint.version)
    if there == as_text(as_before):
        return _Plan(student, path, there, numbers, _What.SAME)
    old = nbformat.reads(there, as_version=4)
    is_same = imprint == Imprint.of(as_before.metadata)
    base = record.numbers(student.id) or numbers
    proof = proofs(assignment.secret, student.id, base)
    has_numbers = bool(imprint.numbers) and all(proof.get(n, one) == one for n, one in imprint.numbers.items())
    if cells_of(old) != imprint.cells:
        what = _What.SAME if is_same else _What.WORKED_IN if has_numbers else _What.FOREIGN
    else:
        what = _What.TEXT if has_numbers else _What.NUMBERS
    return _Plan(student, path, content, numbers, what, _changed(old, made))


def _there(path):
    """The text of a notebook that is there, and its imprint; None for each that is missing."""
    try:
        text = path.read_bytes().decode("utf-8", "replace")
        return text, Imprint.of(nbformat.reads(text, as_version=4).metadata)
    except FileNotFoundError:
        return None, None
    except OSError as problem:
        raise GradingError(f"{path} cannot be read: {problem.strerror}") from None
    except Exception:  # nbformat fails in as many ways as a file can be malformed
        return text, None


def _changed(old, new):
    """The parts whose text is not in the older one of two notebooks, and those that were in it alone, by their names.

    The texts of a notebook as it is released are its introduction and, in the order of its numbers, its statements.
    """
    before, numbers = (Imprint.of(made.metadata).numbers for made in (old, new))
    texts = [cell.source for cell in new.cells if cell.cell_type == "markdown"]
    there = {cell.source for cell in old.cells}
    parts = zip(["the introduction", *(f"exercise {one}" for one in numbers)], texts, strict=True)
    gone = [f"exercise {one}" for one in before or () if one not in numbers]
    return (*(part for part, text in parts if text not in there), *gone)


def _demand_allowed(plans, folder, replace, new_numbers, record):
    """Raise GradingError where something is in the way, or would change without being asked for."""
    foreign = [plan for plan in plans if plan.what is _What.FOREIGN]
    if foreign:
        more = f" ({len(foreign) - 1} more are in the way)" if foreign[1:] else ""
        raise GradingError(
            f"{foreign[0].path} is in the way and no notebook of this release: move it away, or release to another "
            f"folder; nothing is written{more}"
        )

    def whose(plans):
        return in_short([plan.student.id for plan in plans])

    numbers = [plan for plan in plans if plan.what is _What.NUMBERS and not new_numbers]
    if numbers:
        none = "that are drawn today, and no record says which were released"
        drawn = f"of {record.path.name}" if record.path else none
        raise GradingError(
            f"nothing is written: the notebooks of {whose(numbers)} in {folder} have other numbers than those "
            f"{drawn}: put the record of their release beside the assignment, or say --replace --new-numbers"
        )
    others = [plan for plan in plans if plan.what in (_What.TEXT, _What.NUMBERS, _What.WORKED_IN)]
    if others and not replace:
        parts = list(dict.fromkeys(part for plan in others for part in plan.parts))
        what = f" in {in_short(parts)}" if parts else ""
        raise GradingError(
            f"nothing is written: the notebooks of {whose(others)} in {folder} would be others{what}: "
            "--replace puts them in place, with the numbers of the release, except where somebody has worked in one"
        )


def notebook(assignment: Assignment, student: Student, numbers: Numbers | None = None) -> NotebookNode:
    """Return the notebook of a student.

    Arguments:
        assignment: `Assignment`.
        student: whose.
        numbers: that were released before, {exercise: {parameter: text}}; others are drawn.
    Raises:
        GradingError: where a variant fails.
    """
    released = numbers or {}
    questions = {n: asked(assignment, student.id, n, released.get(n)) for n in assignment.exercises}
    return _notebook(assignment, student, questions)


def _notebook(assignment, student, questions, version=None):
    """The notebook of a student; one of an earlier version where nothing else has changed."""
    version = installed().version if version is None else version
    person = f"**{as_markdown(student.name or student.id)}** (`{student.id}`)"
    introduction = [f"# {assignment.title}", person, assignment.introduction, _HOW_TO_ANSWER]
    introduction += [assignment.credit.says, _needs(version)]
    cells = [v4.new_markdown_cell("\n\n".join(part for part in introduction if part))]
    cells += map(v4.new_code_cell, set_up(assignment.title, student.id, questions))
    for number, question in questions.items():
        statement, *data = statement_cells(question)
        statement.source += f"\n\n{_reading(question)}"
        cells += [statement, *data]
        cells.append(v4.new_code_cell(answer_call(number, dict.fromkeys(question.key, "..."))))
    cells.append(v4.new_code_cell("sheet"))
    made = bare(cells)
    numbers = proofs(assignment.secret, student.id, {number: texts(one) for number, one in questions.items()})
    made.metadata.loopbook = Imprint(assignment.name, student.id, version, cells_of(made), numbers).as_metadata()
    return made


def _needs(version):
    """What a student needs to run the notebook, folded."""
    name = installed().module.partition(".")[0]
    address = installed().repository
    if address:
        how = (
            "which is installed once, by running this in a cell and then restarting the kernel:\n\n"
            f"    %pip install git+{address}\n\nOn a computer of your own without Jupyter, "
            f"[{address.removeprefix('https://')}]({address}) says how to begin. "
        )
    else:
        how = "which is installed as whoever gave it to you says. "
    return (
        f"<details><summary>If the first cell fails with <code>No module named '{name}'</code></summary>\n\n"
        f"This notebook needs Python 3.11 or newer and {name}, {how}The notebook was released with {name} {version}."
        "\n\n</details>"
    )


@dataclass(frozen=True)
class Installed:
    """What students install: the module with the answer sheet, its version, and where it is from (empty if unknown)."""

    module: str
    version: str
    repository: str


def installed() -> Installed:
    """Return what a released notebook needs: the package that names its answer sheet in `GROUP`, or this one."""
    [plugin] = [*importlib.metadata.entry_points(group=GROUP)][:1] or [None]
    about = importlib.metadata.metadata(plugin.dist.name if plugin else "exercisegrader")
    links = dict(one.split(", ") for one in about.get_all("Project-URL", []))
    module = plugin.value if plugin else "exercisegrader.inside.answer_sheet"
    return Installed(module, importlib.metadata.version(about["Name"]), links.get("Repository", ""))


def _reading(question):
    """How the answers to a question are read and how exactly they are compared, folded; nothing of it is of the key."""
    lines = [
        f"- `{name}`: {kind.keyless.expected}{f' ({kind.precision})' if kind.precision else ''}"
        for name, kind in question.key.items()
    ]
    return "\n".join(["<details><summary>How your answers are read</summary>", "", *lines, "", "</details>"])


def asked(assignment: Assignment, student_id: str, number: str, values: Mapping[str, str] | None = None) -> Question:
    """Return a student's question, with all that will be needed of it. Raises GradingError where that fails.

    Arguments:
        assignment, number, values: as `Assignment.question` takes them.
        student_id: whose.
    """
    try:
        question = assignment.question(student_id, number, values)
        check_names(question)
        _check_places(question)
        _check_key(question)
        statement_cells(question)
    except GradingError:
        raise
    except Exception as problem:  # the functions are the author's
        raise GradingError(f"exercise {number} of {assignment.name} for student {student_id}: {problem}") from problem
    return question


def statement_cells(question: Question) -> list[NotebookNode]:
    """Return the cells that put a question: the statement with its picture, and the data that it hands out."""
    cell = v4.new_markdown_cell(with_arrays(str(question.statement), "in the cell below"))
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
    for number, cell in enumerate(cells, start=1):
        cell.id = f"cell-{number:03}"  # a new cell has one at random
        cell.source = cell.source.replace("\r\n", "\n").rstrip()
        if cell.cell_type == "code" and _IMPORTS.search(cell.source):  # JupyterLab shows such a cell folded
            cell.metadata = NotebookNode(jupyter={"source_hidden": True}, tags=["hide-input"])
    return v4.new_notebook(cells=[cell for cell in cells if cell.source], metadata=METADATA)


def as_text(notebook: NotebookNode) -> str:
    """Return the text of a notebook's file: JSON in the manner of JupyterLab, with a newline at the end."""
    return nbformat.writes(notebook) + "\n"


def set_up(title: str, student_id: str, questions: Mapping[str, Question]) -> list[str]:
    """Return the sources of the cells that make the sheet and say what it asks: forms, and nothing of the keys."""
    makers = {kind.asking.partition("(")[0] for question in questions.values() for kind in question.key.values()}
    sheet = wrapped(f"sheet = AnswerSheet({literal(title)}, student={literal(student_id)})")
    sources = [f"{imported(installed().module, {'AnswerSheet', *makers})}\n\n{sheet}"]
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
    """Return a line of code with a bracket as lines that are not too long, broken after commas.

    >>> print(wrapped(f"sheet.asks({', '.join(['1', *(f'angle_{k}=number()' for k in range(5))])})"))
    sheet.asks(
        1, angle_0=number(), angle_1=number(), angle_2=number(), angle_3=number(),
        angle_4=number()
    )
    """
    if len(code) <= MOST_COLUMNS:
        return code
    opening = _OPENING.match(code)
    if not opening:
        return code
    inside = _TOGETHER.sub(lambda found: found[0].replace(" ", "\0"), code[opening.end() : -1])
    lines = textwrap.wrap(inside, MOST_COLUMNS - 4, break_long_words=False, break_on_hyphens=False)
    return "\n".join([opening[0], *(f"    {line}" for line in lines), code[-1]]).replace("\0", " ")


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
