"""Exercises as forms in the chapters' pages, and the progress in them.

The page has all that needs no Python: the statement with the numbers of everybody, the fields, and for readers without
JavaScript the folded solution. What answers is Python in the reader's browser; exercises.js asks it. Beside the pages
are, for who has no Python yet, the hints and solutions of each chapter, the records of measurements as CSV, and a table
of all exercises, from which the progress is shown.
"""

import functools
import html
import json
import re
from pathlib import Path

import slugs

from exercisebook import notes
from loopbook.exercises import bank, exercise
from loopbook.exercises.forms import Sheet, version

ROOT = Path(__file__).parents[2]
FOLDER = "exercises"  # of what is beside the pages, in _static
MEGABYTES = 25  # of Python, fetched once

NO_SCRIPT = "Check, hints and your own numbers need JavaScript, which is off here. The solution is folded below."
FROM_FILE = (
    "This page was opened as a file, and from a file a browser may not start the Python that checks answers: on the "
    "web, or in JupyterLab, it does. The solution is folded below."
)
HOW_TO = (
    "Fill in what you have found and press Check: Python, the same as in JupyterLab, reads your answers in this page "
    "and says what it recognises. Type as you would write: `2 min`, `12e^(-0.3t)`. Stuck? Each hint goes one step "
    "further. The solution comes after an attempt. Nothing that you type leaves your browser."
)


@functools.cache
def sheet(number):
    """The exercise with the numbers of everybody."""
    with notes.off():
        return Sheet(exercise(number))


def form(number, points, pictures, solutions):
    """Return an exercise as a form, in Markdown that is HTML.

    Arguments:
        number: of the exercise.
        points: in words.
        pictures: those of the statement as HTML, from the notebook.
        solutions: the address of the page of solutions, from the chapter's page.
    """
    one, place = sheet(number), slugs.slug(number)
    data = one.download(f"../_static/{FOLDER}/{place}.csv")
    solution = one.solution_text
    if one.question.exercise.drawn_in_solution:
        solution += (
            f'\n<p><a href="{solutions}#solution-{place}">Its picture is in the solutions of this chapter.</a></p>'
        )
    own, own_button = "", ""
    if one.question.values:
        own, own_button = ' data-own="yes"', '<button type="button" class="own">Your own numbers</button>'
    return raw(
        f"""<div class="exercise docutils" data-exercise="{number}" data-rungs="{one.rungs}"{own}>
<p class="state"><span class="points">{points}</span><span class="known"></span>
<span class="whose"></span>{own_button}</p>
<div class="statement">
{one.text}
{pictures}
{data}
{one.asked}
</div>
<form novalidate autocomplete="off" aria-label="Answers to exercise {number}">
<div class="fields">
{one.controls}
</div>
{one.accuracy}
<div class="buttons">
<button type="submit" class="check">Check</button>
{'<button type="button" class="hint">Hint</button>' if one.rungs else ""}
<button type="button" class="solve" aria-expanded="false">Solution</button>
</div>
</form>
<p class="why no-script">{NO_SCRIPT}</p>
<p class="why from-file">{FROM_FILE}</p>
<div class="loading" hidden></div>
<div class="answer" role="status"></div>
<div class="hints" aria-live="polite"></div>
<div class="solved"></div>
<noscript><details class="solution"><summary>Solution</summary>
{solution}
</details></noscript>
<p class="exercise-links"><a href="{solutions}#solution-{place}">In the solutions of this chapter</a></p>
</div>"""
    )


def raw(text):
    """HTML within Markdown, whose empty lines would end it elsewhere."""
    return f"``````{{raw}} html\n{text}\n``````"


def progress(chapter):
    """The place of a chapter's progress, which exercises.js fills in."""
    return raw(f'<p class="progress-of-chapter" data-chapter="{chapter}"></p>')


@functools.cache
def pages():
    """The pages of the chapters by the exercises in them: {"10.1": "10_tuning", ...}."""
    found = {}
    for path in sorted((ROOT / "chapters").glob("*.ipynb")):
        for number in re.findall(r'"exercise\(\\"([\dA-Z]+\.\d+)\\"\)"', path.read_text(encoding="utf-8")):
            found.setdefault(number, path.stem)
    return found


@functools.cache
def table():
    """All chapters with their exercises, as JSON data."""
    return [
        {
            "chapter": chapter,
            "title": bank.title(chapter),
            "exercises": [
                {"number": one.number, "title": one.title, "page": f"chapters/{pages()[one.number]}.html"}
                for one in bank.exercises(chapter).values()
                if one.number in pages()
            ],
        }
        for chapter in bank.chapters()
    ]


def of_all(to_root=""):
    """The progress in all chapters before anything is known of the reader, as HTML."""
    rows = "\n".join(
        f'<li data-chapter="{one["chapter"]}"><a href="{to_root}{one["exercises"][0]["page"]}#exercises">'
        f'{html.escape(one["title"])}</a> <span class="bar" aria-hidden="true"><span></span></span> '
        f'<span class="count">0 of {len(one["exercises"])}</span></li>'
        for one in table()
    )
    count = sum(len(one["exercises"]) for one in table())
    return f"""<div class="progress-of-all">
<p class="progress-says"><strong class="sum">{count} exercises answer in the page.</strong>
<span class="next"></span></p>
<ul class="progress-rows">
{rows}
</ul>
<p class="progress-buttons"><button type="button" class="save">Save my progress as a file</button>
<label class="load">Read it from a file<input type="file" accept=".json,application/json"></label>
<button type="button" class="forget">Forget my progress</button></p>
<p class="progress-note" role="status"></p>
</div>"""


def add_files(app, pagename, templatename, context, doctree):
    """Give a page with exercises or with the progress its script and its style, and no other page."""
    body = context.get("body", "")
    if '<div class="progress-of-all"></div>' in body:
        to_root = "../" * pagename.count("/")
        body = context["body"] = body.replace('<div class="progress-of-all"></div>', of_all(to_root))
    if 'class="progress-of-all"' in body or "data-exercise=" in body:
        app.add_css_file("exercises.css")
        app.add_js_file(f"{FOLDER}/table.js", loading_method="defer")
        app.add_js_file("exercises.js", loading_method="defer")


def write_data(app, env):
    """Write what is beside the pages that are there."""
    if app.builder.format != "html":
        return
    folder = Path(app.outdir, "_static", FOLDER)
    folder.mkdir(parents=True, exist_ok=True)
    known = {"version": version(), "chapters": table()}
    script = f"window.loopbookExercises = {json.dumps(known, ensure_ascii=False)};\n"
    (folder / "table.js").write_text(script, encoding="utf-8")
    for chapter in table():
        if chapter["exercises"][0]["page"].removesuffix(".html") not in env.found_docs:
            continue
        helps = {}
        for number in (one["number"] for one in chapter["exercises"]):
            one = sheet(number)
            helps[number] = {
                "hints": [one.hint(rung) for rung in range(1, one.rungs + 1)],
                "solution": one.solution_text,
            }
            if one.csv:
                (folder / f"{slugs.slug(number)}.csv").write_text(one.csv + "\n", encoding="utf-8")
        text = json.dumps(helps, ensure_ascii=False)
        (folder / f"help-{slugs.slug(chapter['chapter'])}.json").write_text(text, encoding="utf-8")


def setup(app):
    """Tell Sphinx what is here."""
    app.connect("env-updated", write_data)
    app.connect("html-page-context", add_files, priority=600)
    return {"parallel_read_safe": True, "parallel_write_safe": True}
