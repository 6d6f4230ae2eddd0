"""What lies where in a finished picture: its texts as they are drawn, and what overlaps them."""

import itertools
from typing import NamedTuple

from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.text import Text
from matplotlib.transforms import Bbox

TOUCHING = 0.02  # inches: what overlaps by less only touches


class Written(NamedTuple):
    """A text of a picture and the box around it, in inches."""

    text: str
    box: Bbox


def written(picture):
    """All texts of a picture as it is drawn: those in it, its title, and the words at its axes."""
    figure = picture.figure
    renderer = FigureCanvasAgg(figure).get_renderer()
    figure.draw_without_rendering()
    return [Written(text.get_text(), in_inches(figure, text.get_window_extent(renderer))) for text in drawn(figure)]


def drawn(figure):
    found = [text for text in figure.findobj(Text) if text.get_visible() and text.get_text().strip()]
    hidden = {id(text) for axes in figure.axes if not axes.axison for text in of_axes(axes)}
    return [text for text in found if id(text) not in hidden]


def of_axes(axes):
    """The texts at the two axes, which are not drawn where these are off."""
    return [text for axis in (axes.xaxis, axes.yaxis) for text in axis.findobj(Text)]


def in_inches(figure, box):
    return box.transformed(figure.dpi_scale_trans.inverted())


def overlapping_texts(picture):
    """The pairs of texts that lie on one another, as they are written.

    >>> from loopbook.diagrams import block, block_diagram
    >>> overlapping_texts(block_diagram("u", block("P"), "y"))
    []
    """
    return overlapping(written(picture))


def overlapping(texts):
    pairs = itertools.combinations(texts, 2)
    return [(one.text, other.text) for one, other in pairs if overlap(one.box, other.box)]


def overlap(one, other):
    width = min(one.x1, other.x1) - max(one.x0, other.x0)
    height = min(one.y1, other.y1) - max(one.y0, other.y0)
    return width > TOUCHING and height > TOUCHING


def crossed_texts(picture):
    """The texts that a line of the picture runs through."""
    return crossed(picture.figure, written(picture))


def misplaced_texts(picture):
    """What `overlapping_texts` and `crossed_texts` find, for what lays the picture out once."""
    texts = written(picture)
    return overlapping(texts) + crossed(picture.figure, texts)


def crossed(figure, texts):
    found = []
    for line in (line for axes in figure.axes for line in axes.lines):
        points = figure.dpi_scale_trans.inverted().transform(line.get_transform().transform(line.get_xydata()))
        pieces = list(itertools.pairwise(points))
        found += [text.text for text in texts if any(crosses(*piece, text.box) for piece in pieces)]
    return found


def crosses(start, end, box):
    """Whether a straight line runs through a box and does not only touch it (Liang and Barsky)."""
    enter, leave = 0.0, 1.0
    for axis, (low, high) in enumerate(((box.x0, box.x1), (box.y0, box.y1))):
        low, high, way = low + TOUCHING, high - TOUCHING, end[axis] - start[axis]
        if abs(way) < 1e-12:
            if not low < start[axis] < high:
                return False
            continue
        one, other = sorted(((low - start[axis]) / way, (high - start[axis]) / way))
        enter, leave = max(enter, one), min(leave, other)
    return enter < leave


def smallest_print(picture):
    """The size of the smallest text of a picture, in points, as printed at its size."""
    return min(text.get_fontsize() for text in drawn(picture.figure))
