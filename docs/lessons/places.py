"""Where the lessons stand in the chapters: at the end of a section, below the reader's own slider."""

import copy

import nbformat

from lessons.store import PLACES, load


def headings(cell):
    """The headings in a cell, as [(level, text)]."""
    if cell.cell_type != "markdown":
        return []
    lines = [line.partition(" ") for line in cell.source.splitlines() if line.startswith("#")]
    return [(len(marks), text.strip()) for marks, _, text in lines if not marks.strip("#")]


def place_in(cells, section):
    """Return the number of the cell before which a section's lesson stands, at its end, and the level of its heading.

    Raises ValueError where there is no such section.
    """
    found = [(number, level, text) for number, cell in enumerate(cells) for level, text in headings(cell)]
    at = next((k for k, (_, _, text) in enumerate(found) if text.startswith(section)), None)
    if at is None:
        raise ValueError(f"there is no heading {section!r} where its lesson should stand")
    level = found[at][1]
    end = next((number for number, other, _ in found[at + 1 :] if other <= level), len(cells))
    return end, level + 1


def with_lessons(cells, chapter):
    """Return the cells of a chapter with its lessons among them, as Markdown cells with the directive.

    Arguments:
        cells: of the notebook; they are not changed.
        chapter: name of the notebook, without its folder and ending.
    """
    cells = list(map(copy.copy, cells))
    for name, place in PLACES.items():
        if place.chapter == chapter:
            number, level = place_in(cells, place.section)
            directive = f"```{{lesson}} {name}\n```"
            lesson = nbformat.v4.new_markdown_cell(
                f"{'#' * level} {load(name).title}\n\n{directive}", id=f"lesson-{name}"
            )
            cells.insert(number, lesson)
    return cells
