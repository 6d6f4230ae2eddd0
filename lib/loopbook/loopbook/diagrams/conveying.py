"""What moves solid material: a feed screw and a conveyor belt."""

from __future__ import annotations

from typing import TYPE_CHECKING

from loopbook.diagrams.equipment import THIN, Equipment

if TYPE_CHECKING:
    from loopbook.diagrams.drawing import XY, Drawing


def feed_screw(tag: str = "") -> Screw:
    """Return a feed screw; it takes up all the places that its name has in the layout.

    >>> feed_screw()
    <feed screw>
    """
    return Screw(tag, "feed screw")


def conveyor(tag: str = "") -> Conveyor:
    """Return a conveyor belt; it takes up all the places that its name has in the layout.

    >>> conveyor()
    <conveyor belt>
    """
    return Conveyor(tag, "conveyor belt")


class Screw(Equipment):
    width, height, room = 2.4, 0.7, (0.2, 0.5)

    def draw(self, drawing: Drawing) -> None:
        drawing.area([(self.x0, self.y0), (self.x0, self.y1), (self.x1, self.y1), (self.x1, self.y0)], fill="white")
        drawing.wire((self.x0, self.y), (self.x1, self.y), width=THIN)
        turns = max(3, round((self.x1 - self.x0) / 0.45))
        pitch = (self.x1 - self.x0) / turns
        for n in range(turns):
            x = self.x0 + n * pitch
            drawing.wire((x, self.y0), (x + pitch, self.y1))
        self.draw_tag(drawing)


class Conveyor(Equipment):
    width, height, room = 3.0, 0.5, (0.4, 0.5)

    def draw(self, drawing: Drawing) -> None:
        r = 0.22
        for y in (self.y - r, self.y + r):
            drawing.wire((self.x0 + r, y), (self.x1 - r, y))
        for x in (self.x0 + r, self.x1 - r):
            drawing.circle(x, self.y, r)
            drawing.dot(x, self.y)
        drawing.wire((self.x - 0.5, self.y), (self.x + 0.5, self.y), arrow="->", width=THIN)
        self.draw_tag(drawing)

    def edge(self, dx: int, dy: int, x: float, y: float) -> XY:
        return (self.x1 if dx > 0 else self.x0, y) if dx else (x, self.y + 0.24 * dy)
