"""Every figure alone, with the cell that draws it: a page for each chapter, and a gallery of all figures.

The gallery is the directive ``figure-gallery``. A figure's picture is the one that its chapter shows. Its cell runs
below the chapter's first one, which has the imports; where it takes a name from a cell between, the page says so.
"""

import ast
import base64
import functools
import hashlib
import html
import json
from pathlib import Path
from typing import NamedTuple

import launch
import permanent
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
        size = said["width"], said["height"]
        found.append(Figure(chapter, number, name, of, said["alt"], file_name(output), *size))
    return found


def content(output):
    """The bytes of a picture."""
    return base64.b64decode("".join(output["data"]["image/png"]))


def file_name(output):
    """The file of a picture, by what it holds."""
    return f"{hashlib.sha256(content(output)).hexdigest()}.png"


def place_pictures(folder):
    """Put the pictures where the site has its images that Sphinx does not put there.

    They are those of exercises, and of cells in whose place a chapter has a lesson.
    """
    folder.mkdir(exist_ok=True)
    for path in [*CHAPTERS.glob("*.ipynb"), *CHAPTERS.with_name("solutions").glob("*.ipynb")]:
        for cell in json.loads(path.read_text(encoding="utf-8"))["cells"]:
            for output in cell.get("outputs", ()):
                if "image/png" in output.get("data", {}) and not (folder / file_name(output)).exists():
                    (folder / file_name(output)).write_bytes(content(output))


def imports(chapter):
    """The first cell of a chapter with code: it imports what the others use."""
    return next(cell["source"] for cell in cells_of(chapter) if cell["cell_type"] == "code")


def goes_on(figure):
    """Whether the cell of a figure may take what a cell before it has made."""
    cells = cells_of(figure.chapter)
    before = [names(cell["source"])[0] for cell in cells[: figure.cell] if cell["cell_type"] == "code"]
    made, taken = names(cells[figure.cell]["source"])
    return not taken.isdisjoint(set().union(*before) - made)


def names(source):
    """Return the names that some code gives a value, and those of which it takes the value.

    >>> made, taken = names("a = b + 1\\ndef f(x): return x")
    >>> sorted(made), sorted(taken)
    (['a', 'f'], ['b', 'x'])
    """
    nodes = list(ast.walk(ast.parse(source)))
    found = [(node.id, isinstance(node.ctx, ast.Load)) for node in nodes if isinstance(node, ast.Name)]
    functions = {node.name for node in nodes if isinstance(node, ast.FunctionDef | ast.ClassDef)}
    return functions | {name for name, is_taken in found if not is_taken}, {
        name for name, is_taken in found if is_taken
    }


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
    notebook = f'<a href="{html.escape(launch.in_page(f"chapters/{chapter}.ipynb", "../"))}">the notebook</a>'
    parts = [
        f"<h1>Figures of chapter {html.escape(title)}</h1>",
        f'<p>Each figure of <a href="../chapters/{chapter}.html">the chapter</a> alone, and the cell that draws it, to '
        'be run below the imports. All chapters: <a href="../figures.html">figures</a>.</p>',
        '<section class="one-figure"><details><summary>The imports of all cells</summary>'
        f"{highlighted(imports(chapter))}</details></section>",
    ]
    for figure in of_chapter(chapter):
        heading = html.escape(figure.title)
        code = highlighted(cells_of(chapter)[figure.cell]["source"])
        more = f"<p>The cell goes on from cells before it: run {notebook}.</p>" if goes_on(figure) else ""
        parts += [
            f'<section class="one-figure" id="{figure.name}">',
            f'<h2>{heading}<a class="headerlink" href="#{figure.name}" title="Link to this figure">¶</a></h2>',
            f"<figure>{image(figure, '../_images/')}</figure>",
            f'<p class="figure-links"><a href="../chapters/{chapter}.html#{figure.name}">In the chapter</a> · '
            f'<a href="../_images/{figure.picture}" download="{figure.name}.png">PNG</a></p>',
            f"<details><summary>The cell</summary>{more}{code}</details>",
            "</section>",
        ]
    return "\n".join(parts)


def pages(app):
    """The page of each chapter's figures."""

    def highlighted(code):
        return app.builder.highlighter.highlight_block(code, "python")

    place_pictures(Path(app.outdir, "_images"))
    for chapter, title in chapters().items():
        if f"chapters/{chapter}" not in app.env.found_docs:
            continue
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
