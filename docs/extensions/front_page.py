"""What the front page shows of the book: its chapters with pictures and lessons, an exercise, and a checked result.

The role is ``{hours}`4 5 6` ``, the directives are ``chapter-list``, ``front-exercise 10.1``, and
``checked-result haugen; Example 7.4; T_i_in_minutes``.
"""

import html
import re

import exercise_forms
import ledger_page
import reading
import single_figures
import stored
from checks import COLUMNS, cells, code
from docutils import nodes
from lessons import titles
from slugs import check_anchor, ledger_anchor, slug
from sphinx.util.docutils import SphinxDirective

from loopbook.ledger import sources


class ChapterList(SphinxDirective):
    """The chapters in their order, as the README's table has them, each with its first picture and all its lessons."""

    def run(self):
        readme = stored.ROOT / "README.md"
        self.env.note_dependency(str(readme))
        row = re.compile(r"^\| \[(.+)\]\(chapters/(\w+)\.ipynb\) \| (.+) \| (.+) \|$", re.MULTILINE)
        rows = row.findall(readme.read_text("utf-8"))
        if not rows:
            raise self.error("the README has no table of chapters")
        return [nodes.raw("", f'<ol class="chapters">{"".join(tile(*row) for row in rows)}</ol>', format="html")]


def tile(title, chapter, what, source):
    """A chapter in the list, as HTML."""
    address = f"chapters/{chapter}.html"
    links = " · ".join(
        f'<a href="{address}#lesson-{name}">{html.escape(says)}</a>' for of, name, says in titles() if of == chapter
    )
    picture = single_figures.image(single_figures.of_chapter(chapter)[0], "_images/")
    return (
        f'<li><a href="{address}" tabindex="-1" aria-hidden="true">{picture}</a><div>'
        f'<p><a href="{address}"><strong>{html.escape(title)}</strong></a> '
        f"<small>{html.escape(source)} · {minutes_of(chapter)} min</small></p>"
        f'<p>{html.escape(what[:1].upper() + what[1:])}.</p><p class="lessons">{links}</p></div></li>'
    )


def minutes_of(chapter):
    """How long the core of a chapter takes."""
    return reading.minutes(single_figures.cells_of(chapter))


def hours(name, rawtext, text, lineno, inliner, options=None, content=()):
    """The role `hours`: how long the cores of some chapters take, by their numbers, as "6 7 10"."""
    names = [next((stored.ROOT / "chapters").glob(f"{number:0>2}_*.ipynb")).stem for number in text.split()]
    total = sum(map(minutes_of, names))
    return [nodes.Text(f"{total} minutes" if total < 100 else f"{round(total / 60)} hours")], []


class FrontExercise(SphinxDirective):
    """An exercise that answers, by its number."""

    required_arguments = 1

    def run(self):
        number = self.arguments[0]
        chapter = exercise_forms.pages().get(number)
        if not chapter:
            raise self.error(f"no chapter shows exercise {number}")
        self.env.note_dependency(str(stored.ROOT / "chapters" / f"{chapter}.ipynb"))
        cells = single_figures.cells_of(chapter)
        outputs = next(cell["outputs"] for cell in cells if cell["source"] == f'exercise("{number}")')
        statement = exercise_forms.sheet(number).question.statement
        pictures = stored.pictures(outputs, "_images/")
        form = exercise_forms.form(number, statement.points, pictures, f"solutions/{chapter}.html")
        link = f"[In its chapter](chapters/{chapter}.ipynb#exercise-{slug(number)})"
        return self.parse_text_to_nodes(f"**{statement.heading}.** {link}\n\n{form}")


class CheckedResult(SphinxDirective):
    """One result of the ledger with its verdict: source, entry and result, with semicolons between."""

    required_arguments = 1
    final_argument_whitespace = True

    def run(self):
        source, entry, name = (part.strip() for part in self.arguments[0].split(";"))
        try:
            chapter, verdicts = ledger_page.stored()[source, entry]
            verdict = verdicts[name]
        except KeyError as missing:
            raise self.error(f"the chapters store no check of {source}; {entry}; {name}: {missing}") from None
        result = next(one for one in sources()[source][entry].results if one.name == name)
        head = "".join(f'<th scope="col">{column}' for column in COLUMNS if column != "equation")
        title = html.escape(f"{sources()[source].title}, {entry}")
        text = f"""<div class="table checked" tabindex="0" role="region" aria-label="A checked result">
<table><caption>{title}</caption><thead><tr>{head}</thead><tbody>
<tr>{cells(verdict, equations=False)}
</tbody></table></div>
<p>{code(ledger_page.note(result))} <a href="chapters/{chapter}.html#{check_anchor(source, entry)}">In its chapter</a> ·
<a href="ledger/{chapter}.html#{ledger_anchor(source, entry, name)}">in the ledger</a></p>"""
        return [nodes.raw("", text, format="html")]


def add_files(app, pagename, templatename, context, doctree):
    """The look of the front page, for this page alone."""
    if pagename == app.config.root_doc:
        app.add_css_file("front.css")


def setup(app):
    app.add_directive("chapter-list", ChapterList)
    app.add_role("hours", hours)
    app.add_directive("front-exercise", FrontExercise)
    app.add_directive("checked-result", CheckedResult)
    app.connect("html-page-context", add_files)
    return {"parallel_read_safe": True, "parallel_write_safe": True}
