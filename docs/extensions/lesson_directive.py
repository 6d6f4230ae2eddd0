"""The directive ``{lesson} name``: a live lesson with its sliders, its pictures, its results and what to try.

The page gets HTML that can be read without a script, with the results of the first position of the sliders. The curves
are in a file of their own, a script that a page opened from a disk may load, and only pages with a lesson load it.
"""

import html
import json
from pathlib import Path

import lessons
from docutils import nodes
from sphinx.util.docutils import SphinxDirective

STYLES = ("vendor/uPlot.min.css", "lessons.css")


class Lesson(SphinxDirective):
    """A live lesson, by its name."""

    required_arguments = 1

    def run(self):
        name = self.arguments[0]
        try:
            lesson = lessons.load(name)
        except ValueError as problem:
            raise self.error(str(problem)) from None
        data = json.loads(lessons.data((name,))[name])
        title = html.escape(lesson.title)
        questions = "\n".join(f"1. {question}" for question in lesson.questions)
        return [
            raw(f'<section class="lesson" id="lesson-{name}" data-lesson="{name}" aria-label="{title}">', name),
            *self.parse_text_to_nodes(lesson.about),
            raw(desk(name, lesson, data)),
            *self.parse_text_to_nodes(f"**What to try.**\n\n{questions}"),
            raw("</section>"),
        ]


def raw(text, lesson=None):
    """A piece of HTML; the one that opens a lesson has its name."""
    node = nodes.raw("", text, format="html")
    if lesson:
        node["lesson"] = lesson
    return node


def desk(name, lesson, data):
    """The sliders, the pictures with their legends, and the result, as HTML."""
    sliders = "\n".join(control(name, slider) for slider in lesson.sliders)
    pictures = "\n".join(picture(number, lesson, data) for number in range(len(lesson.panels)))
    verdict, results = data["answers"][first(data)][:2]
    return f"""<div class="lesson-desk">
<div class="lesson-controls">
{sliders}
<div class="lesson-buttons" hidden>
<button type="button" class="lesson-keep" aria-pressed="false">Keep these curves in grey</button>
<button type="button" class="lesson-reset">Back to the start</button>
</div>
</div>
<noscript><p>The sliders need JavaScript. In JupyterLab, the chapter has a slider of its own.</p></noscript>
{pictures}
<p class="lesson-result" aria-live="polite">{said(verdict, data["results"], results)}</p>
</div>"""


def first(data):
    """The number of the answer for the sliders as they stand at the beginning."""
    number = 0
    for start, count in zip(data["start"], data["counts"], strict=True):
        number = number * count + start
    return number


def said(verdict, labels, results):
    """The line of results; lessons.js writes the same."""
    pairs = (f"<span>{label} <b>{html.escape(text)}</b></span>" for label, text in zip(labels, results, strict=True))
    return f"<strong>{html.escape(verdict)}.</strong> " + " ".join(pairs)


def control(lesson, slider):
    """A slider with its label and value, or a list to choose from where the values are words."""
    name, shown = f"lesson-{lesson}-{slider.name}", [html.escape(text) for text in slider.shown]
    label = f'<label for="{name}">{slider.label}</label>'
    if slider.words:
        chosen = (" selected" if number == slider.first else "" for number in range(len(shown)))
        options = "".join(
            f'<option value="{number}"{mark}>{text}</option>'
            for number, (text, mark) in enumerate(zip(shown, chosen, strict=True))
        )
        return f'<div class="lesson-slider">{label}<select id="{name}" autocomplete="off">{options}</select></div>'
    texts = html.escape(json.dumps(slider.shown, ensure_ascii=False))
    return (
        f'<div class="lesson-slider">{label}<output for="{name}">{shown[slider.first]}</output>'
        f'<input type="range" id="{name}" min="0" max="{len(shown) - 1}" step="1" value="{slider.first}" '
        f'autocomplete="off" aria-valuetext="{shown[slider.first]}" data-texts="{texts}"></div>'
    )


def picture(number, lesson, data):
    """One picture: its legend, with the lines as they are drawn, and the place where the script draws."""
    lines = []
    for curve, look in zip(lesson.curves, data["curves"], strict=True):
        if curve.panel == number:
            dashes = " ".join(map(str, look["dash"]))
            line = f'<line x1="0" y1="4" x2="40" y2="4" stroke-width="{look["width"]}" stroke-dasharray="{dashes}"/>'
            colours = f"--light: {look['light']}; --dark: {look['dark']}"
            svg = f'<svg width="40" height="8" aria-hidden="true" style="{colours}">{line}</svg>'
            lines.append(f"<li>{svg} {curve.label}</li>")
    return (
        f'<div class="lesson-picture"><ul class="lesson-legend">{"".join(lines)}</ul>\n'
        f'<div class="lesson-plot" role="img" aria-label="{html.escape(lesson.panels[number].axis)}"></div></div>'
    )


def add_files(app, pagename, templatename, context, doctree):
    """Give a page with lessons the scripts and styles, and no other page."""
    names = [node["lesson"] for node in doctree.findall(nodes.raw) if "lesson" in node] if doctree else []
    if not names:
        return
    for style in STYLES:
        app.add_css_file(style)
    for script in ("vendor/uPlot.iife.min.js", *(f"lessons/{name}.js" for name in names), "lessons.js"):
        app.add_js_file(script, loading_method="defer")


def write_data(app):
    """Write the curves of all lessons beside the pages, before the pages that load them."""
    if app.builder.format != "html":
        return
    folder = Path(app.outdir, "_static", "lessons")
    folder.mkdir(parents=True, exist_ok=True)
    for name, text in lessons.data().items():
        script = f"(window.loopbookLessons ||= {{}}).{name} = {text};\n"
        (folder / f"{name}.js").write_text(script, encoding="utf-8")


def setup(app):
    """Tell Sphinx what is here."""
    app.add_directive("lesson", Lesson)
    app.connect("builder-inited", write_data)
    app.connect("html-page-context", add_files)
    return {"version": "1", "parallel_read_safe": True, "parallel_write_safe": True}
