"""Every figure alone, with its code: a page for each chapter, a program for each figure, and a gallery of all of them.

The gallery is the directive ``figure-gallery``. A figure's picture is the one that its chapter shows; its program is
cut out of the chapter by programs.py.
"""

import base64
import functools
import hashlib
import html
import json
from pathlib import Path
from typing import NamedTuple

import permanent
import programs
from docutils import nodes
from sphinx.util.docutils import SphinxDirective

CHAPTERS = Path(__file__).parents[2] / "chapters"


class Figure(NamedTuple):
    """A figure of a chapter.

    Attributes:
        chapter, cell: where it is: name of the notebook, number of the cell.
        name: its place in the page.
        title, words: what it is called, and its description.
        picture: name of the file among the site's images.
        width, height: in pixels of the page.
    """

    chapter: str
    cell: int
    name: str
    title: str
    words: str
    picture: str
    width: int
    height: int


@functools.cache
def cells_of(chapter):
    """The cells of a chapter, each source in one piece."""
    content = json.loads((CHAPTERS / f"{chapter}.ipynb").read_text(encoding="utf-8"))
    return [{**cell, "source": "".join(cell["source"])} for cell in content["cells"]]


@functools.cache
def of_chapter(chapter):
    """Return the figures of a chapter, in their order."""
    cells = cells_of(chapter)
    places, found = permanent.figures(cells), []
    for number, cell in enumerate(cells):
        if cell.get("id") not in places:
            continue
        output = next(o for o in cell["outputs"] if "image/png" in o.get("data", {}))
        said, name = output["metadata"]["image/png"], places[cell["id"]][0]
        of = permanent.title_of(said["alt"])
        picture = f"{hashlib.sha256(content(output)).hexdigest()}.png"
        found.append(Figure(chapter, number, name, of, said["alt"], picture, said["width"], said["height"]))
    return found


def content(output):
    """The bytes of a picture."""
    return base64.b64decode("".join(output["data"]["image/png"]))


def place_picture(figure, folder):
    """Put the picture of a figure where the site has its images, if its chapter has a lesson in its place."""
    outputs = cells_of(figure.chapter)[figure.cell]["outputs"]
    if not (folder / figure.picture).exists():
        folder.mkdir(exist_ok=True)
        (folder / figure.picture).write_bytes(content(next(o for o in outputs if "image/png" in o.get("data", {}))))


@functools.cache
def program(figure):
    """Return the program that draws a figure."""
    place = f"From chapter {title_of(figure.chapter)} (chapters/{figure.chapter}.ipynb of loopbook)."
    return programs.program(cells_of(figure.chapter), figure.cell, figure.title, place, f"{figure.name}.png")


def title_of(chapter):
    """The title of a chapter."""
    return cells_of(chapter)[0]["source"].splitlines()[0].lstrip("# ")


def chapters():
    """The names of the chapters with figures, and their titles, in their order."""
    names = [file.stem for file in sorted(CHAPTERS.glob("*.ipynb"))]
    return {name: title_of(name) for name in names if of_chapter(name)}


def image(figure, to_images):
    """The picture, as HTML."""
    return (
        f'<img src="{to_images}{figure.picture}" alt="{html.escape(figure.words)}" '
        f'width="{figure.width}" height="{figure.height}" loading="lazy">'
    )


def body(chapter, title, highlighted):
    """The page of a chapter's figures, as HTML."""
    parts = [
        f"<h1>Figures of chapter {html.escape(title)}</h1>",
        f'<p>Each figure alone, and the program that draws it: cut out of <a href="../chapters/{chapter}.html">the '
        'chapter</a>, with what it needs and nothing else. It runs where loopbook is <a href="../contributors.html">'
        'installed</a>, and writes PNG, SVG or PDF. All chapters: <a href="../figures.html">figures</a>.</p>',
    ]
    for figure in of_chapter(chapter):
        heading = html.escape(figure.title)
        parts += [
            f'<section class="one-figure" id="{figure.name}">',
            f'<h2>{heading}<a class="headerlink" href="#{figure.name}" title="Link to this figure">¶</a></h2>',
            f"<figure>{image(figure, '../_images/')}</figure>",
            f'<p class="figure-links"><a href="../chapters/{chapter}.html#{figure.name}">In the chapter</a> · '
            f'<a href="../_images/{figure.picture}" download="{figure.name}.png">PNG</a> · '
            f'<a href="{chapter}/{figure.name}.py" download>Program</a>, {len(program(figure).splitlines())} lines</p>',
            f"<details><summary>The program</summary>{highlighted(program(figure))}</details>",
            "</section>",
        ]
    return "\n".join(parts)


def pages(app):
    """The page of each chapter's figures, and the programs beside it."""
    for chapter, title in chapters().items():
        if f"chapters/{chapter}" not in app.env.found_docs:
            continue
        folder = Path(app.outdir, "figures", chapter)
        folder.mkdir(parents=True, exist_ok=True)
        for figure in of_chapter(chapter):
            place_picture(figure, Path(app.outdir, "_images"))
            (folder / f"{figure.name}.py").write_text(program(figure), encoding="utf-8")

        def highlighted(code):
            return app.builder.highlighter.highlight_block(code, "python")

        context = {"title": f"Figures of chapter {title}", "body": body(chapter, title, highlighted), "parents": []}
        yield f"figures/{chapter}", context, "page.html"


class Gallery(SphinxDirective):
    """`figure-gallery`: all figures of all chapters, small, each with the way to its code."""

    def run(self):
        parts = []
        for chapter, title in chapters().items():
            self.env.note_dependency(str(CHAPTERS / f"{chapter}.ipynb"))
            heading = nodes.title("", title)
            section = nodes.section("", heading, ids=[f"chapter-{chapter.partition('_')[0].lower()}"])
            tiles = "\n".join(
                f'<li><a href="figures/{chapter}.html#{figure.name}">{image(figure, "_images/")}'
                f"<span>{html.escape(figure.title)}</span></a></li>"
                for figure in of_chapter(chapter)
            )
            section += nodes.raw("", f'<ul class="gallery">\n{tiles}\n</ul>', format="html")
            parts.append(section)
        return parts


def setup(app):
    """Join Sphinx."""
    app.add_directive("figure-gallery", Gallery)
    app.connect("html-collect-pages", pages)
    return {"parallel_read_safe": True, "parallel_write_safe": True}
