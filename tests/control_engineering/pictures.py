"""What lies where in a finished picture: its texts as they are drawn, and what overlaps them."""

import functools
import itertools
from typing import NamedTuple

from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.patches import Circle, Polygon
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


# Diagrams, in the units of their drawing.


@functools.lru_cache(maxsize=32)
def measured(picture):
    """The texts, boxes, circles and wires of a picture, in drawing units."""
    figure = picture.figure
    FigureCanvasAgg(figure)
    figure.draw_without_rendering()
    (axes,) = figure.axes
    to_units = axes.transData.inverted()
    texts = [(text.get_text(), text.get_window_extent().transformed(to_units)) for text in axes.texts]
    boxes = [p.get_path().get_extents() for p in axes.patches if isinstance(p, Polygon) and len(p.get_xy()) == 5]
    circles = [p for p in axes.patches if isinstance(p, Circle)]
    heads = [p.get_xy() for p in axes.patches if isinstance(p, Polygon) and len(p.get_xy()) == 4]
    wires = [list(zip(*line.get_data(), strict=True)) for line in axes.lines]
    return texts, boxes, circles, heads, wires


def within(inner, outer, margin=0.0):
    return (
        outer.x0 + margin <= inner.x0 <= inner.x1 <= outer.x1 - margin
        and outer.y0 + margin <= inner.y0 <= inner.y1 <= outer.y1 - margin
    )


def signs_near(texts, x, y):
    """The signs at a junction, with the side on which each stands."""
    found = []
    for text, extent in texts:
        dx, dy = (extent.x0 + extent.x1) / 2 - x, (extent.y0 + extent.y1) / 2 - y
        if text in ("$+$", "$-$") and max(abs(dx), abs(dy)) < 0.9:
            found.append((text[1], "left" if abs(dy) < 0.4 else "above" if dy > 0 else "below"))
    return sorted(found, key=lambda item: item[1])


def tip(head):
    """The point of an arrow head, which is the second of its corners."""
    return tuple(map(float, head[1]))


def assert_tidy(picture, beyond=0.05):
    """The labels lie on none other, on no arrow head, and inside the drawing, which fits a page."""
    texts, _, _, heads, _ = measured(picture)
    (axes,) = picture.figure.axes
    (left, right), (bottom, top) = axes.get_xlim(), axes.get_ylim()
    for (one, here), (other, there) in itertools.combinations(texts, 2):
        assert not here.overlaps(there), (one, other)
    for label, extent in texts:
        assert left - beyond <= extent.x0 <= extent.x1 <= right + beyond, label
        assert bottom - beyond <= extent.y0 <= extent.y1 <= top + beyond, label
        assert not any(extent.contains(*head.mean(axis=0)) for head in heads), (label, "is on an arrow head")
    assert picture.figure.get_size_inches()[0] <= 7.01


def assert_orthogonal(picture, besides=()):
    """The wires run across or upright, and through no box, apart from those boxes that have wires in them."""
    _, boxes, _, _, wires = measured(picture)
    for wire in wires:
        for (x0, y0), (x1, y1) in itertools.pairwise(wire):
            assert min(abs(x0 - x1), abs(y0 - y1)) < 1e-9
            x, y = (x0 + x1) / 2, (y0 + y1) / 2
            for box in boxes:
                inside = box.x0 + 0.01 < x < box.x1 - 0.01 and box.y0 + 0.01 < y < box.y1 - 0.01
                assert not inside or box in besides
