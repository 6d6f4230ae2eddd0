"""Chapters and solutions become pages: the notebooks as stored are copied into docs/, with what a page needs.

A copy differs from its notebook in this: exercises are forms, solutions are folded, formulas within
tables are MathML, checks have a place of their own and a link to the ledger, sections name the functions that they
use, and every page says where else it can be opened. The notebooks themselves are not touched, and nothing is run.
"""

import json
import re
from html import escape
from pathlib import Path

import checks
import exercise_forms
import functions_used
import launch
import mathml
import nbformat
import permanent
import reading
import single_figures
import slugs
from lessons import of_cell
from light import is_wide
from nbformat.v4.rwbase import rejoin_lines
from sphinx import addnodes
from sphinx.util.matching import Matcher

DOCS = Path(__file__).parents[1]
ROOT = DOCS.parent
FOLDERS = ("chapters", "solutions")
START = ROOT / launch.FIRST  # what it leads to is the site's own front page
FOLDED = "hide-input"
EVERYWHERE = ("loopbook.tables.", "loopbook.sliders.")  # what no section needs to name
RESPONSE = "application/vnd.loopbook.response+json"
SHOWN = ("image/png", "text/html", "text/latex", "text/markdown", "text/plain")  # the first of these that there is
PROGRESS = re.compile(r"What (?:you have|is) right so far .*:")  # above the cell that shows it
EXERCISE = re.compile(r'exercise\("([\w.]+)"\)')  # a cell that shows a statement


def stored(path):
    """Return a notebook, each text in it in one piece. (nbformat would check it besides, which tests do.)"""
    return rejoin_lines(nbformat.from_dict(json.loads(path.read_text(encoding="utf-8"))))


def markdown(source):
    """A cell of text."""
    return nbformat.v4.new_markdown_cell(source)


def page(path):
    """Return the notebook at a path, as its page needs it.

    Arguments:
        path: of a notebook in chapters/ or solutions/.
    """
    content = stored(path)
    folder, name = path.parent.name, path.stem
    whole = content["cells"]
    figures, taken = permanent.figures(whole), permanent.taken(whole)
    if folder == "chapters":
        takes = f"about {reading.minutes(whole)} minutes with its code and lessons"
        whole[0]["source"] = re.sub(r"about \d+ minutes", takes, whole[0]["source"], count=1)
        whole = with_functions(whole)
    cells = []
    for cell in whole:
        cells += in_markdown(cell) if cell["cell_type"] == "markdown" else in_code(cell, folder, name, figures, taken)
    cells.insert(1, markdown(opening(folder, name)))
    if folder == "solutions":
        cells = folded(cells)
    for number, cell in enumerate(cells, start=1):
        cell["id"] = f"cell-{number}"
    content["cells"] = cells
    return content


def opening(folder, name):
    """The line below a page's title: where it runs in the browser, its other half, and where else it can be opened."""
    what = {"chapters": "this chapter", "solutions": "these solutions"}[folder]
    here = launch.in_page(f"{folder}/{name}.ipynb", root="../")
    run = f'<a class="run" href="{here}">Run {what} in the browser</a>'
    other = {"chapters": "solutions", "solutions": "chapters"}[folder]
    word = {"chapters": "Solutions", "solutions": "Chapter"}[folder]
    places = " · ".join(f"[{place}]({address})" for place, address in launch.links(f"{folder}/{name}.ipynb"))
    line = f"{{.opening}}\n{run} · [{word} of this chapter](/{other}/{name}.ipynb)" + (
        places and f" · Open in: {places}"
    )
    return line.replace("Chapter of this chapter", "The chapter")


def in_markdown(cell):
    """A cell of text; the headings of the solutions are places to link to."""
    lines = []
    for line in with_forms(cell["source"]).splitlines():
        exercise = re.match(r"## Exercise ([\dA-Z]+\.\d+)", line)
        if exercise:  # in the solutions
            lines.append(f"(solution-{slugs.slug(exercise[1])})=")
        lines.append(line)
    return [markdown("\n".join(lines))]


def with_forms(source):
    """What a chapter says of its exercises, for a page in which they are forms."""
    source = re.sub(r"(?m)^Replace the dots .*?(?=\n|$)", said_of_forms, source)
    return "" if PROGRESS.fullmatch(source) else source


def said_of_forms(found):
    """How the forms are answered, and what a chapter says besides, which begins with the number of an exercise."""
    besides = re.search(r"(?<= )Exercise [\dA-Z]+\.\d+ needs .*", found[0])
    return " ".join(filter(None, [exercise_forms.HOW_TO, besides and besides[0]]))


def with_functions(cells):
    """Put at the end of each section the functions of the library that its code uses."""
    sections = functions_used.of_sections(cells)
    result, number = [], 0
    for cell in cells:
        pieces = re.split(r"(?m)^(?=## )", cell["source"]) if cell["cell_type"] == "markdown" else [""]
        for piece in pieces[1:]:
            if pieces[0].strip():
                result.append(markdown(pieces[0]))
            result += line_of_functions(sections[number][1])
            number += 1
            pieces[0] = piece
        result.append(markdown(pieces[0]) if len(pieces) > 1 else cell)
    return result + line_of_functions(sections[-1][1])


def line_of_functions(used):
    told = {address: name for address, name in used.items() if not address.startswith(EVERYWHERE)}
    names = sorted(told.items(), key=lambda pair: pair[1].lower())
    text = ", ".join(f"{{py:obj}}`{name} <{address}>`" for address, name in names)
    return [markdown(f"{{.functions}}\nFunctions used here: {text}")] if names else []


def in_code(cell, folder, name, figures, taken):
    """A cell of code: an exercise becomes a form, sliders a lesson, others keep their code and output.

    Arguments:
        cell: of the notebook.
        folder, name: of the notebook.
        figures: the places of the figures of a chapter, by the ids of their cells.
        taken: the places of the page that have their names already.
    """
    outputs = [shown for output in cell["outputs"] if (shown := one_way(output, taken))]
    if asked := EXERCISE.fullmatch(cell["source"]):
        shown = pictures(outputs)
        return [markdown(exercise(asked[1], shown) if folder == "solutions" else with_form(asked[1], shown, name))]
    if folder == "chapters" and any(RESPONSE in output.get("data", {}) for output in cell["outputs"]):
        return []  # dots in the place of answers: the page has a form
    if folder == "chapters" and (asked := re.fullmatch(r'progress\("(\w+)"\)', cell["source"])):
        return [markdown(exercise_forms.progress(asked[1]))]
    metadata = {"mystnb": {"image": {"alt": alt}}} if (alt := alternative(outputs)) else {}
    imports = all(line.startswith(("from ", "import ", " ", ")")) for line in cell["source"].splitlines())
    if imports or FOLDED in cell["metadata"].get("tags", []):
        word = "Imports" if imports else "Code"
        prompts = {"code_prompt_show": word, "code_prompt_hide": word}
        metadata = {"tags": [FOLDED], "mystnb": metadata.get("mystnb", {}) | prompts}
    lesson = of_cell(name, cell["source"]) if folder == "chapters" else None
    names = figures.get(cell.get("id")) if folder == "chapters" else None
    if names and not lesson:
        label = f"{permanent.title_of(alt)}: alone, with its code"
        metadata = metadata | {permanent.FIGURE: {"names": names, "label": escape(label)}}
    code = nbformat.from_dict({**cell, "metadata": metadata, "outputs": [] if lesson else outputs})
    if not lesson:
        return [code]
    before, after = permanent.frame(names, name, f"{lesson.title}: alone, with its code") if names else ("", "")
    return [markdown(f"{before}\n\n```{{lesson}} {lesson.name}\n:cell:\n```\n\n{after}"), code]


def alternative(outputs):
    """The words for a figure that the notebook stores beside it."""
    return next((o["metadata"]["image/png"].get("alt") for o in outputs if "image/png" in o.get("data", {})), None)


def one_way(output, taken):
    """Return an output in the one form that the page shows, or nothing if it has none.

    Arguments:
        output: of a cell.
        taken: the places of the page that have their names already; those of a check are added.
    """
    if "data" not in output:
        return output
    mime = next((mime for mime in SHOWN if mime in output["data"]), None)
    if mime is None:
        return None
    content = output["data"][mime]
    if mime == "text/latex" and not re.fullmatch(r"\$\$?([^$]|\\text\{[^}]*\})*\$\$?", content.strip()):
        mime, content = "text/html", f'<div class="math" tabindex="0">{mathml.in_html(content)}</div>'
    elif mime == "text/html":
        data = output["data"].get(checks.MIME_TYPE)
        content = checks.check(data, taken) if data else html(content)
    return {**output, "data": {mime: content}}


def html(content):
    """A table or a response: formulas as MathML, colours by name."""
    content = mathml.in_html(content)
    content = re.sub(r'style="color: (#\w+)(?:; (white-space: nowrap))?"', with_class, content)
    content = re.sub(
        r'style="border-left: 4px solid (#\w+); background: [^"]*"',
        lambda match: f'class="response {COLOURS[match[1]]}"',
        content,
    )
    content = content.replace(' role="status"', "")  # what stands in a page from the beginning is no news
    content = content.replace(' style="text-align:left"', "").replace(' style="text-align:right"', ' class="number"')
    return f'<div class="table" tabindex="0">{content}</div>' if "<table" in content else content


COLOURS = {"#00664d": "right", "#5a5a5a": "open", "#555555": "open", "#8a5a00": "differs"}


def with_class(match):
    return f'class="{COLOURS[match[1]]}{" nowrap" if match[2] else ""}"'


def pictures(outputs, to_images="../_images/"):
    """The pictures among outputs, as HTML with their sizes and their descriptions.

    Arguments:
        outputs: of a cell.
        to_images: the way from the page to the site's images.
    """
    shown = [
        (single_figures.file_name(o), o["metadata"]["image/png"]) for o in outputs if "image/png" in o.get("data", {})
    ]
    return "\n\n".join(
        f'<div class="picture"><img src="{to_images}{image}" alt="{escape(said["alt"])}" loading="lazy" '
        f'width="{said["width"]}" height="{said["height"]}"{" class=wide" if is_wide(said["width"]) else ""}></div>'
        for image, said in shown
    )


def with_form(number, pictures, name):
    """An exercise of a chapter, answered by a form, with the way to its solution."""
    statement = exercise_forms.sheet(number).question.statement
    form = exercise_forms.form(number, statement.points, pictures, f"../solutions/{name}.html")
    return f"(exercise-{slugs.slug(number)})=\n### {statement.heading}\n\n{form}"


def exercise(number, pictures):
    """The statement of an exercise in a box, in the solutions, with the way back to the chapter."""
    statement = exercise_forms.sheet(number).question.statement
    last = f"{{.exercise-links}}\n{statement.points} · {{ref}}`In the chapter <exercise-{slugs.slug(number)}>`"
    body = "\n\n".join(filter(None, [statement.below_heading, pictures, last]))
    return f":::::{{container}} exercise\n{body}\n:::::"


def folded(cells):
    """The solutions: from below an exercise's statement to the next heading everything is behind "Solution"."""
    result, is_open = [], False
    for cell in cells:
        if cell["cell_type"] == "markdown" and re.search(r"^## ", cell["source"], re.MULTILINE) and is_open:
            result.append(markdown("```{raw} html\n</details>\n```"))
            is_open = False
        result.append(cell)
        if cell["cell_type"] == "markdown" and "{container} exercise" in cell["source"]:
            result.append(markdown('```{raw} html\n<details class="solution"><summary>Solution</summary>\n```'))
            is_open = True
    return [*result, markdown("```{raw} html\n</details>\n```")] if is_open else result


def copy(app, config):
    """Write the copies that have changed, and take away those whose notebook is gone."""
    is_left_out = Matcher(config.exclude_patterns)
    for folder in FOLDERS:
        target = DOCS / folder
        target.mkdir(exist_ok=True)
        paths = [path for path in sorted((ROOT / folder).glob("*.ipynb")) if path != START]
        for path in (path for path in paths if not is_left_out(f"{folder}/{path.name}")):
            text = json.dumps(page(path), ensure_ascii=False, indent=1)
            write(target / path.name, text)
        for stale in {file.name for file in target.glob("*.ipynb")} - {path.name for path in paths}:
            (target / stale).unlink()


def write(path, text):
    """Write a file if it is to change, at once, so that another build never reads half of it."""
    if not path.exists() or path.read_text(encoding="utf-8") != text:
        fresh = path.with_suffix(".new")
        fresh.write_text(text, encoding="utf-8")
        fresh.replace(path)


def with_short_titles(app, doctree):
    """In the list of the solutions, which says already what they are, a solution has the title of its chapter."""
    for toctree in doctree.findall(addnodes.toctree):
        for place, (title, page_name) in enumerate(toctree["entries"]):
            if (page_name or "").startswith("solutions/"):
                title = stored(DOCS / f"{page_name}.ipynb").cells[0].source.splitlines()[0]
                toctree["entries"][place] = (title.removeprefix("# Solutions · "), page_name)


def setup(app):
    app.connect("config-inited", copy)
    app.connect("doctree-read", with_short_titles)
    return {"parallel_read_safe": True, "parallel_write_safe": True}
