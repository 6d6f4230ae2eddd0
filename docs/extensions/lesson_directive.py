"""The directive ``{lesson} name``: a live lesson with its sliders, its pictures, its results and what to try.

The page gets HTML that can be read without a script, with the pictures of the first position of the sliders. What the
other positions show is in a file of its own, a script that a page opened from a disk may load, too; a page loads it
when the reader comes near. Only pages with a lesson load a script at all.
"""

import hashlib
import html
import json
from pathlib import Path
from typing import ClassVar

import lessons
from docutils import nodes
from docutils.parsers.rst import directives
from lessons.desk import desk
from sphinx.util.docutils import SphinxDirective


class Lesson(SphinxDirective):
    """A live lesson, by its name.

    ``:cell:`` is for the cell of a lesson, where the text above says what is seen, and no heading has its title.
    """

    required_arguments = 1
    option_spec: ClassVar[dict] = {"cell": directives.flag}

    def run(self):
        name = self.arguments[0]
        try:
            lesson = lessons.load(name)
            record = lesson.record()
        except ValueError as problem:
            raise self.error(str(problem)) from None
        self.env.note_dependency(lessons.__path__[0] + "/words.toml")
        self.env.note_dependency(str(lesson.file))
        title = html.escape(lesson.title)
        version = hashlib.sha256(lesson.file.read_bytes()).hexdigest()[:8]
        found = [
            raw(
                f'<section class="lesson" id="lesson-{name}" data-lesson="{name}" data-version="{version}" '
                f'aria-label="{title}">',
                name,
            )
        ]
        if "cell" in self.options:
            found += self.parse_text_to_nodes(f"{{.lesson-title}}\n{lesson.title}")
        elif lesson.about:
            found += self.parse_text_to_nodes(lesson.about)
        found.append(raw(desk(name, record)))
        if lesson.questions:
            questions = "\n".join(f"1. {question}" for question in lesson.questions)
            found += self.parse_text_to_nodes(f"**What to try.**\n\n{questions}")
        return [*found, raw("</section>")]


def raw(text, lesson=None):
    """A piece of HTML; the one that opens a lesson has its name."""
    node = nodes.raw("", text, format="html")
    if lesson:
        node["lesson"] = lesson
    return node


def add_files(app, pagename, templatename, context, doctree):
    """Give a page with lessons the script and the style, and no other page."""
    if doctree and any("lesson" in node for node in doctree.findall(nodes.raw)):
        app.add_css_file("lessons.css")
        app.add_js_file("lessons.js", loading_method="defer")


def write_data(app):
    """Write what all lessons show beside the pages, before the pages that load it."""
    if app.builder.format != "html":
        return
    folder = Path(app.outdir, "_static", "lessons")
    folder.mkdir(parents=True, exist_ok=True)
    for name, lesson in lessons.recorded().items():
        shown = json.dumps(lesson.record()["data"], ensure_ascii=False, separators=(",", ":"))
        script = f"(window.loopbookLessons ||= {{}}).{name} = {shown};\n"
        (folder / f"{name}.js").write_text(script, encoding="utf-8")


def setup(app):
    """Tell Sphinx what is here."""
    app.add_directive("lesson", Lesson)
    app.connect("builder-inited", write_data)
    app.connect("html-page-context", add_files)
    return {"version": "1", "parallel_read_safe": True, "parallel_write_safe": True}
