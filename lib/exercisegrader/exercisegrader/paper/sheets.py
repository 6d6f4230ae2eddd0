"""Sheets to print: a PDF for each student, one with all, and one with the key, made of HTML by a browser."""

from __future__ import annotations

import itertools
import os
import shutil
import subprocess
import tempfile
from collections.abc import Callable, Iterable, Mapping, Sequence
from concurrent.futures import ThreadPoolExecutor
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING

from exercisebook.forms import Sheet
from exercisebook.forms.sheet import with_arrays
from exercisebook.forms.text import escaped, html, inline
from exercisebook.kinds.kind import ELSEWHERE
from exercisegrader import GradingError, files
from exercisegrader.paper import typed
from exercisegrader.release import asked
from exercisegrader.released import Released, texts
from exercisegrader.reports.wording import number as in_digits

if TYPE_CHECKING:
    from exercisebook.question import Question
    from exercisegrader.assignment import Assignment
    from exercisegrader.student import Student

#: Browsers that print without a window, by the names and places that they have on the usual systems.
BROWSERS = ("chromium", "chromium-browser", "google-chrome", "google-chrome-stable", "chrome", "msedge",
            "/Applications/Google Chrome.app/Contents/MacOS/Google Chrome",
            r"C:\Program Files\Google\Chrome\Application\chrome.exe",
            r"C:\Program Files (x86)\Microsoft\Edge\Application\msedge.exe")  # fmt: skip
#: A container has no user namespaces for the browser's own sandbox; what it prints is the instructor's own text.
_OPTIONS = ("--headless", "--no-sandbox", "--disable-gpu", "--disable-dev-shm-usage", "--no-pdf-header-footer")
_SECONDS = 300
#: A longer table of data is none for paper.
MOST_ROWS = 40
_HOW_TO_ANSWER = (
    "Write each answer on its line, and the way to it into the space below. A number in another unit than that asked "
    "for needs its unit. How many digits count stands at each exercise."
)


@dataclass(frozen=True)
class Printed:
    """What a release on paper did.

    Attributes:
        paths: of the students' PDFs, in the order of the roster.
        beside: the folder with what is for the instructor: all sheets in one file, the key, the table for answers.
        record: where the numbers are kept; None for an assignment that was made from a text.
        remarks: sentences on what is no longer as at earlier releases.
    """

    paths: tuple[Path, ...]
    beside: Path
    record: Path | None
    remarks: tuple[str, ...]


def release(
    assignment: Assignment,
    students: Iterable[Student],
    folder: Path,
    follow: Callable[[int, int], object] = lambda done, total: None,
) -> Printed:
    """Write the sheets of the students, ``folder/<id>/<name>.pdf``, the record, and beside the folder what is yours.

    Numbers that were released before, on paper or in notebooks, stay.

    Arguments:
        assignment: `Assignment`.
        students: each with `id` and `name`.
        folder: where to; made if it is not there.
        follow: is called with how many files are printed, and how many there are.
    Raises:
        GradingError: where a variant fails or does not fit on paper, there is no browser, or a file cannot be written.
    """
    chromium = browser()
    before = record = Released.of(assignment)
    students, remarks = before.identified(students)
    if before.path:
        remarks += before.differences(assignment, [one for one in students if one.id in before.holders])
    questions, articles = {}, {}
    for one in students:
        kept = before.numbers(one.id)
        own = {n: asked(assignment, one.id, n, kept.get(n)) for n in assignment.exercises}
        record = record.with_release(one, {n: texts(question) for n, question in own.items()})
        questions[one.id], articles[one.id] = own, sheets(assignment, one, own)
    beside = folder.resolve().with_name(f"{folder.resolve().name}_for_instructor")
    table = beside / f"{assignment.name}_answers.csv"
    rows = typed.template(table, typed.columns(questions[students[0].id]), students)
    title = escaped(assignment.title)
    wanted = {folder / one.id / f"{assignment.name}.pdf": page(title, [articles[one.id]]) for one in students}
    wanted[beside / f"{assignment.name}_all.pdf"] = page(title, articles.values())
    wanted[beside / f"{assignment.name}_key.pdf"] = page(f"{title} · key", [key(assignment, students, questions)])
    if assignment.record:
        record.write(assignment.record, assignment.secret)
    files.write(table, rows)
    with ThreadPoolExecutor(min(4, os.cpu_count() or 1)) as executor:
        pdfs = executor.map(lambda text: printed(text, chromium), wanted.values())
        for done, (path, pdf) in enumerate(zip(wanted, pdfs, strict=True), start=1):
            files.write(path, pdf)
            follow(done, len(wanted))
    return Printed(tuple(itertools.islice(wanted, len(students))), beside, assignment.record, remarks)


# ------------------------------------------------------------------------------------------------------------ texts


def page(title: str, parts: Iterable[str]) -> str:
    """Return a document of HTML with these parts, which brings all that it needs."""
    look, script = (Path(__file__).with_name(f"sheets.{end}").read_text(encoding="utf-8") for end in ("css", "js"))
    head = f'<meta charset="utf-8"><title>{title}</title><style>{look}</style>'
    return (
        f"<!DOCTYPE html><html lang=en><head>{head}</head><body>{''.join(parts)}<script>{script}</script></body></html>"
    )


def sheets(assignment: Assignment, student: Student, questions: Mapping[str, Question]) -> str:
    """Return the sheets of a student as HTML, which a script cuts into pages.

    Raises GradingError where an exercise hands out more numbers than a sheet holds.
    """
    _check_lengths(questions)
    ids = f"<code>{escaped(student.id)}</code> · {escaped(assignment.name)}"
    says = "\n\n".join(filter(None, [assignment.introduction, _HOW_TO_ANSWER, assignment.credit.says]))
    first = f"<h1>{inline(assignment.title)}</h1><p class=whose>{escaped(student.name)}</p>{html(says)}"
    parts = [f"<section>{first}</section>", *(_exercise(question) for question in questions.values())]
    return f'<article data-foot="{escaped(ids)}">{"".join(parts)}</article>'


def _exercise(question):
    """An exercise as HTML: the statement, a line for each answer, and space."""
    sheet, exercise, statement = Sheet(question), question.exercise, question.statement
    text = html(with_arrays(statement.body, "in the table below"))
    boxes = [" box" if kind.by_hand or kind.field["control"] == ELSEWHERE else "" for kind in question.key.values()]
    lines = [
        f"<div class='line{box}'><span>{inline(said)}</span></div>"
        for said, box in zip(statement.asked, boxes, strict=True)
    ]
    parts = [f"<h2>{inline(exercise.heading)} <small>{statement.points}</small></h2>", text, sheet.pictures]
    parts += [_data(sheet), *lines, sheet.accuracy]
    return (
        f"<section>{''.join(parts)}<div class=space style='min-height:{12 + 6 * exercise.points:g}mm'></div></section>"
    )


def is_too_long(question: Question) -> bool:
    """Return whether an exercise hands out more numbers than a sheet holds."""
    return len(Sheet(question).csv.splitlines()) > MOST_ROWS + 1


def _check_lengths(questions):
    """Raise GradingError where exercises hand out more numbers than a sheet holds, and name them all."""
    long = {number: Sheet(one).csv.splitlines() for number, one in questions.items() if is_too_long(one)}
    if long:
        named = [f"{n} ({len(rows) - 1} of {rows[0].replace(',', ', ')})" for n, rows in long.items()]
        raise GradingError(
            f"no sheet holds the values that are handed out by exercise {', '.join(named)}: expected at most "
            f"{MOST_ROWS}; leave out what has more, or let it show what is needed"
        )


def _data(sheet):
    rows = sheet.csv.splitlines()
    cells = ["".join(f"<td>{escaped(cell)}</td>" for cell in row.split(",")) for row in rows]
    return f"<table class=data>{''.join(f'<tr>{row}</tr>' for row in cells)}</table>" if rows else ""


def key(assignment: Assignment, students: Sequence[Student], questions: Mapping[str, Mapping[str, Question]]) -> str:
    """Return, as HTML, the right answers of all students for each exercise, and a table to write their points into.

    Arguments:
        assignment: `Assignment`.
        students: in the order of the rows.
        questions: {student: {number of an exercise: question}}.
    """

    def table(heads, cells):
        top = "".join(f"<th>{head}</th>" for head in ("Student", *heads))
        rows = "".join(
            f"<tr><td>{escaped(one.name)} <code>{escaped(one.id)}</code></td>"
            f"{''.join(f'<td>{cell}</td>' for cell in cells(one))}</tr>"
            for one in students
        )
        return f"<table><thead><tr>{top}</tr></thead><tbody>{rows}</tbody></table>"

    parts = [f"<h1>{inline(assignment.title)}: key</h1>"]
    for number, question in questions[students[0].id].items():
        exercise, weights = question.exercise, question.exercise.weights
        whole = sum(weights.get(name, 1) for name in question.key)
        heads = [
            f"<code>{name}</code> {in_digits(exercise.points * weights.get(name, 1) / whole)} p."
            + (f"<br><small>{kind.precision}</small>" if kind.precision else "")
            for name, kind in question.key.items()
        ]
        answers = table(heads, lambda one, n=number: [escaped(k.solution) for k in questions[one.id][n].key.values()])
        parts.append(f"<h2>{inline(exercise.heading)} <small>{question.statement.points}</small></h2>{answers}")
    points = [f"{number}<br><small>of {one.points:g}</small>" for number, one in assignment.exercises.items()]
    sums = [*points, f"Sum<br><small>of {in_digits(assignment.points)}</small>"]
    marking = table(sums, lambda one: [""] * len(sums))
    return f"<main>{''.join(parts)}<h2 class=marking>Points</h2>{marking}</main>"


# --------------------------------------------------------------------------------------------------------- printing


def browser() -> str:
    """Return where a browser that prints is. Raises GradingError where there is none."""
    if found := next(filter(None, map(shutil.which, BROWSERS)), None):
        return found
    raise GradingError(
        "there is no browser here to print with: install Chromium, for example with apt-get install chromium, or "
        "Chrome or Edge; the sheets are PDF files that it makes"
    )


def printed(text: str, chromium: str) -> bytes:
    """Return a document of HTML as PDF. Raises GradingError where the browser does not print it."""
    with tempfile.TemporaryDirectory(prefix="paper") as folder:
        source, pdf = Path(folder, "sheets.html"), Path(folder, "sheets.pdf")
        source.write_text(text, encoding="utf-8")
        options = (*_OPTIONS, f"--user-data-dir={folder}/profile", f"--print-to-pdf={pdf}")
        try:
            ended = subprocess.run(
                [chromium, *options, source.as_uri()], capture_output=True, timeout=_SECONDS, check=False
            )
        except (OSError, subprocess.TimeoutExpired) as problem:
            raise GradingError(f"{chromium} does not print: {problem}") from None
        if not pdf.exists():
            said = ended.stderr.decode(errors="replace").strip().rpartition("\n")[2]
            raise GradingError(
                f"{chromium} does not print: it ends with {ended.returncode}, {said or 'without a word'}"
            )
        return pdf.read_bytes()
