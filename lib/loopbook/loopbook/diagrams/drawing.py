"""What the parts of a diagram draw on, and how labels are written."""

from __future__ import annotations

import math
import re
from collections.abc import Sequence
from functools import lru_cache
from typing import TypeAlias

from loopbook.figures import Picture
from loopbook.figures.canvas import formulas
from loopbook.figures.style import DOTS_PER_INCH, STYLE, styled
from plainmath.tables import plain_words

# Lengths are in drawing units of half an inch, as schemdraw has them.
INCHES = 0.5
WIDEST = 7.0  # inches; what is wider is drawn smaller
FONT_SIZE = 12
LINE = 1.1  # points
HEAD = {"arrowlength": 0.26, "arrowwidth": 0.19}
RADIUS = 0.22  # of a summing junction
MARGIN = 0.1  # around the lines of a drawing
LIQUID = "#d9d9d9"


#: A place in a drawing, in drawing units.
XY: TypeAlias = "tuple[float, float]"

#: A direction: to the right (1, 0), up (0, 1), or to a corner (-1, -1).
Way: TypeAlias = "tuple[int, int]"


def mathematics(text: str) -> str:
    """Text for matplotlib: mathematics unless it has dollar signs of its own, with fractions in full size."""
    return re.sub(r"\\frac\b", r"\\dfrac", text if "$" in text else f"${text}$")


def wording(text: str) -> str:
    """Text for matplotlib: plain words as they are, anything else mathematics, with all of a name's index lowered.

    >>> wording("Process"), wording("K_p"), wording("F_fd"), wording("P controller")
    ('Process', '$K_p$', '$F_{fd}$', 'P controller')
    """
    if re.fullmatch(r"[A-Za-z]+([\s/&,.-]+[A-Za-z]+)*", text) and re.search("[A-Za-z]{3}", text):
        return text
    return signal_name(text) if re.fullmatch(r"[A-Za-z]+_\w+", text) else mathematics(text)


def signal_name(text: str) -> str:
    """Text for matplotlib: a signal's name, with everything behind the underscore in its index.

    >>> signal_name("y_SP"), signal_name("T_{in}")
    ('$y_{SP}$', '$T_{in}$')
    """
    if re.fullmatch(r"[A-Za-z]{3,}(\s+[A-Za-z]+)*", text):
        return text
    return mathematics(text if "$" in text else re.sub(r"_(\w{2,})", r"_{\1}", text))


@lru_cache(maxsize=1000)
def text_size(label: str, size: float = FONT_SIZE) -> tuple[float, float]:
    """Width and height of a label in drawing units."""
    from matplotlib.font_manager import FontProperties
    from matplotlib.textpath import TextPath

    font = FontProperties(family=STYLE["font.family"], math_fontfamily=STYLE["mathtext.fontset"], size=size)

    def extent(line):
        if "$" in line:  # as it will be drawn, so that it is read once
            formula = formulas().parse(line, DOTS_PER_INCH, font)
            return formula.width / DOTS_PER_INCH * 72, formula.height / DOTS_PER_INCH * 72
        box = TextPath((0, 0), line or "-", prop=font).get_extents()
        return box.width, box.height

    widths, heights = zip(*map(extent, label.split("\n")), strict=True)
    height = heights[0] + 1.2 * size * (len(heights) - 1)
    return float(max(widths) / 72 / INCHES), float(height / 72 / INCHES)


class Drawing:
    """A drawing of schemdraw's segments at given places."""

    def __init__(self) -> None:
        try:
            import schemdraw
            from schemdraw import segments
        except ModuleNotFoundError:
            raise ModuleNotFoundError("schemdraw draws the diagrams: install loopbook[diagrams]") from None

        self.segments = segments
        self.schemdraw = schemdraw.Drawing(show=False)
        font = {"font": STYLE["font.family"], "mathfont": STYLE["mathtext.fontset"], "fontsize": FONT_SIZE}
        self.schemdraw.config(inches_per_unit=INCHES, lw=LINE, **font)

    def _add(self, segment):
        from schemdraw.elements import Element

        element = Element().at((0, 0)).theta(0)
        element.segments.append(segment)
        self.schemdraw.add(element)

    def wire(
        self, *points: XY, arrow: str | None = None, width: float = LINE, style: str = "-", zorder: int | None = None
    ) -> None:
        """A line through the points; `arrow` is "->" or "<->"."""
        self._add(self.segments.Segment(points, arrow=arrow, lw=width, ls=style, zorder=zorder, **HEAD))

    def zigzag(self, start: XY, end: XY, teeth: int = 6, height: float = 0.2) -> None:
        """A line that goes to and fro on its way, as a spring or a heating element does."""
        (x0, y0), (x1, y1) = start, end
        length = math.hypot(x1 - x0, y1 - y0)
        along, across = ((x1 - x0) / length, (y1 - y0) / length), (-(y1 - y0) / length, (x1 - x0) / length)
        points = [start]
        for n in range(2 * teeth):
            way, off = length * (n + 0.5) / (2 * teeth), height * (1 if n % 2 else -1)
            points.append((x0 + way * along[0] + off * across[0], y0 + way * along[1] + off * across[1]))
        self.wire(*points, end)

    def box(self, x: float, y: float, width: float, height: float, label: str, size: float = FONT_SIZE) -> None:
        """A box with the middle of its left side at (x, y)."""
        corners = [(x, y - height / 2), (x, y + height / 2), (x + width, y + height / 2), (x + width, y - height / 2)]
        self.area(corners, fill="white")
        self.text(x + width / 2, y, label, size=size)

    def area(self, corners: Sequence[XY], fill: str, outline: float = LINE, zorder: int | None = None) -> None:
        color = "black" if outline else fill
        self._add(self.segments.SegmentPoly(corners, fill=fill, lw=outline, color=color, zorder=zorder))

    def circle(self, x: float, y: float, radius: float, fill: str = "white", zorder: int = 3) -> None:
        self._add(self.segments.SegmentCircle((x, y), radius, fill=fill, zorder=zorder))

    def arc(
        self, x: float, y: float, width: float, height: float, start: float, end: float, arrow: str | None = None
    ) -> None:
        """A part of an ellipse around (x, y), between two angles in degrees; `arrow` is "cw" or "ccw"."""
        self._add(self.segments.SegmentArc((x, y), width, height, theta1=start, theta2=end, arrow=arrow))

    def dot(self, x: float, y: float) -> None:
        self.circle(x, y, 0.08, fill="black")

    def text(
        self, x: float, y: float, label: str, halign: str = "center", valign: str = "center", size: float = FONT_SIZE
    ) -> None:
        self._add(self.segments.SegmentText((x, y), label, align=(halign, valign), fontsize=size, zorder=4))

    def into_junction(self, x: float, y: float, side: XY, sign: str) -> None:
        """The last piece of a path into the summing junction at (x, y), and its sign; `side` is where it comes from."""
        if side[1]:
            self.wire((x, y + side[1]), (x, y + math.copysign(RADIUS, side[1])), arrow="->")
        self.sign(x, y, side, sign)

    def sign(self, x: float, y: float, side: XY, sign: str) -> None:
        """The sign stands over a path from the side, and on the left of a path from above or below."""
        away = math.copysign(RADIUS + 0.34, side[0] or side[1])
        dx, dy = (away, 0.25) if side[0] else (-0.3, away)
        self.text(x + dx, y + dy, {"+": "$+$", "-": "$-$"}[sign])

    def picture(self, title: str | None, words: str) -> Picture:
        from matplotlib.figure import Figure

        with styled():
            figure = Figure(dpi=DOTS_PER_INCH)
            axes = figure.add_axes((0, 0, 1, 1))
            self.schemdraw.draw(show=False, canvas=axes)
            axes.set_axis_off()
            axes.set_aspect("equal")
            left, right, bottom, top = self._extent(axes)
            scale = min(1, WIDEST / INCHES / (right - left))
            axes.set(xlim=(left, right), ylim=(bottom, top))
            figure.set_size_inches(scale * INCHES * (right - left), scale * INCHES * (top - bottom))
            for text in axes.texts:
                text.set_fontsize(scale * text.get_fontsize())
            axes.set_title(title or "")
        return Picture(figure, plain_words(f"{title}: {words}" if title else words))

    def _extent(self, axes):
        """Left, right, bottom and top of the drawing: schemdraw guesses the width of mathematics from its source, so
        the lines and the labels as they are decide how wide the drawing is."""
        box, lines = self.schemdraw.get_bbox(), axes.dataLim
        xs, ys = [lines.xmin - MARGIN, lines.xmax + MARGIN], [box.ymin - MARGIN, box.ymax + MARGIN]
        for text in axes.texts:
            (x, y), (width, height) = text.get_position(), text_size(text.get_text(), text.get_fontsize())
            left = x - width * {"left": 0, "center": 0.5, "right": 1}[text.get_ha()]
            bottom = y - height * {"bottom": 0, "baseline": 0.25, "center": 0.5, "top": 1}[text.get_va()]
            xs += [left, left + width]
            ys += [bottom, bottom + height]
        return min(xs), max(xs), min(ys), max(ys)
