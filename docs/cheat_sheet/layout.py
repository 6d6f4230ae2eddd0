"""Draws the cheat sheet: sections as tables in three columns on one A4 page, in the typeface of the figures.

Everything is measured before it is drawn, so that a formula too wide for its column, or a section too many for the
page, is an error and not an overlap. The page holds no date, so that equal contents are equal bytes.
"""

import functools
import itertools

import matplotlib
from matplotlib.backends.backend_pdf import FigureCanvasPdf
from matplotlib.figure import Figure
from matplotlib.font_manager import FontProperties
from matplotlib.lines import Line2D
from matplotlib.mathtext import MathTextParser

from loopbook.figures.style import GREY, ROLES, STYLE

POINTS = 72
PAGE = (841.89, 595.28)  # A4 on its side, in points
MARGIN, GUTTER, COLUMNS = 24, 16, 3
SIZE, SMALL, HEADING, TITLE = 8, 7.2, 9, 15  # of the type, in points
LEADINGS = (3.0, 2.5, 2.0, 1.5)  # between rows: the first with which all sections fit on the page
GAP = 4  # at least, between the columns of a table
COLOUR, RULE = ROLES["measurement"]["color"], "#bbbbbb"
TOP = MARGIN + 25  # where the columns begin, below the title
ROOM = PAGE[1] - MARGIN - TOP  # for a column
WIDTH = (PAGE[0] - 2 * MARGIN - (COLUMNS - 1) * GUTTER) / COLUMNS
PARSER = MathTextParser("path")
# Fonts as TrueType, so that words can be searched for and copied.
LOOK = {**{name: STYLE[name] for name in ("font.family", "mathtext.fontset")}, "pdf.fonttype": 42}


@functools.cache  # the same words are measured with each leading
def measure(text, size, weight="normal"):
    """Width, height above the baseline and depth below it of a line of text with formulas, in points."""
    if not text:
        return 0, 0, 0
    font = FontProperties(family=LOOK["font.family"], size=size, weight=weight)
    width, height, depth, *_ = PARSER.parse(text, POINTS, font)
    return width, max(height - depth, 0.68 * size), max(depth, 0.22 * size)


def wrapped(text, size, width):
    """The lines of a text, broken between words; a formula is not broken."""
    words, line = iter(joined_formulas(text)), ""
    for word in words:
        longer = f"{line} {word}".strip()
        if line and measure(longer, size)[0] > width:
            yield line
            longer = word
        line = longer
    yield line


def joined_formulas(text):
    """The words of a text, where a formula between dollars is part of one word."""
    word = ""
    for piece in text.split(" "):
        word = f"{word} {piece}" if word else piece
        if word.count("$") % 2 == 0:
            yield word
            word = ""


class Row:
    """Cells side by side on one baseline."""

    def __init__(self, cells, size=SIZE, colour="black"):
        self.cells, self.size, self.colour = cells, size, colour
        self.measures = [measure(cell, size) for cell in cells]
        self.above = max(above for _, above, _ in self.measures)
        self.below = max(below for _, _, below in self.measures)
        self.height = self.above + self.below


class Block:
    """A section, laid out: its heading and rows with their places from the top of the section down."""

    def __init__(self, section, leading=LEADINGS[0]):
        self.section = section
        self.heading = Row([section.title], HEADING)
        self.head = [Row(section.header, SMALL, GREY)] if section.header else []
        self.body = [Row(cells, SMALL if section.small else SIZE) for cells in section.cells()]
        lines = wrapped(section.note, SMALL, WIDTH) if section.note else ()
        self.notes = [Row([line], SMALL, GREY) for line in lines]
        self.starts = self._columns()
        self.height = sum(row.height + leading for row in (self.heading, *self.head, *self.body, *self.notes)) + 2

    def _columns(self):
        """Where the columns of the table begin: what is left of the width is between them."""
        rows = [*self.head, *self.body]
        widths = [max(row.measures[n][0] for row in rows) for n in range(len(rows[0].cells))]
        gaps = len([width for width in widths if width]) - 1
        left = WIDTH - sum(widths)
        if left < GAP * gaps or self.heading.measures[0][0] > WIDTH:
            room = WIDTH - GAP * gaps
            raise ValueError(f"{self.section.title} is {sum(widths):.0f} points wide: expected at most {room:.0f}")
        gap = min(left / gaps, 22) if gaps else 0
        return [0, *itertools.accumulate(width + gap for width in widths[:-1])]


def columns(blocks, room):
    """The blocks in the columns of the page, in their order, so that the fullest one is as short as can be."""
    best = None
    for breaks in itertools.combinations(range(1, len(blocks)), COLUMNS - 1):
        ends = (0, *breaks, len(blocks))
        parts = [blocks[start:end] for start, end in itertools.pairwise(ends)]
        tallest = max(sum(block.height for block in part) for part in parts)
        if best is None or tallest < best[0]:
            best = tallest, parts
    tallest, parts = best
    needed = tallest + 4 * max(len(part) - 1 for part in parts)
    if needed > room:
        raise ValueError(f"a column is {needed:.0f} points high: expected at most {room:.0f}")
    return parts


def arranged(sections, room):
    """The widest leading with which the sections fit, and the blocks of each column."""
    for leading in LEADINGS:
        try:
            return leading, columns([Block(section, leading) for section in sections], room)
        except ValueError as problem:
            reason = problem
    raise reason


class Page:
    """An A4 page that is written on from the upper left corner, in points."""

    def __init__(self, leading=LEADINGS[0]):
        self.leading = leading
        self.figure = Figure(figsize=[x / POINTS for x in PAGE])
        FigureCanvasPdf(self.figure)

    def text(self, x, y, text, size, colour="black", weight="normal", ha="left"):
        """Write a line whose baseline is y below the upper edge."""
        look = {"fontsize": size, "color": colour, "fontweight": weight, "ha": ha, "va": "baseline"}
        self.figure.text(x / PAGE[0], 1 - y / PAGE[1], text, **look)

    def rule(self, x, y, width, colour=RULE, thickness=0.6):
        line = Line2D([x / PAGE[0], (x + width) / PAGE[0]], [1 - y / PAGE[1]] * 2, color=colour, linewidth=thickness)
        self.figure.add_artist(line)

    def row(self, x, y, row, starts=(0,), colour=None, weight="normal"):
        """Write a row whose upper edge is at y, and return where the next one begins."""
        for start, cell in zip(starts, row.cells, strict=False):
            if cell:
                self.text(x + start, y + row.above, cell, row.size, colour or row.colour, weight)
        return y + row.height + self.leading

    def block(self, x, y, block):
        y = self.row(x, y, block.heading, colour=COLOUR, weight="bold")
        self.rule(x, y - self.leading / 2, WIDTH)
        y += 2
        for row in (*block.head, *block.body):
            y = self.row(x, y, row, block.starts)
        for row in block.notes:
            y = self.row(x, y, row)
        return y


def draw(sections, title, letters, file):
    """Write the sheet to a PDF file.

    Arguments:
        sections: what has `title`, `header`, `cells()` and `note`, texts with formulas between dollars.
        title: of the page.
        letters: lines that say what the symbols mean.
        file: name or open binary file.
    Raises:
        ValueError: for what does not fit on the page.
    """
    with matplotlib.rc_context(LOOK):
        leading, parts = arranged(sections, ROOM)
        page = Page(leading)
        page.text(MARGIN, MARGIN + 10, title, TITLE, weight="bold")
        for number, line in enumerate(letters):
            page.text(PAGE[0] - MARGIN, MARGIN - 5 + 9 * number, line, SMALL, GREY, ha="right")
        page.rule(MARGIN, TOP - 7, PAGE[0] - 2 * MARGIN, "black", 0.8)
        for number, blocks in enumerate(parts):
            space = (ROOM - sum(block.height for block in blocks)) / max(len(blocks) - 1, 1)
            y = TOP
            for block in blocks:
                y = page.block(MARGIN + number * (WIDTH + GUTTER), y, block) + space
        page.figure.savefig(file, format="pdf", metadata={"Title": f"loopbook: {title}", "CreationDate": None})
