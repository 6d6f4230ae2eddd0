"""What all symbols of a plant have in common: which way the flow passes them, and where their tags stand."""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import TYPE_CHECKING

from loopbook.diagrams.drawing import text_size
from loopbook.diagrams.grid import Node

if TYPE_CHECKING:
    from loopbook.diagrams.drawing import XY, Drawing, Way

THICK = 1.7  # points: pipes and the walls of vessels
THIN = 0.8
TAG_SIZE = 10
BELOW, RIGHT, ABOVE, LEFT = (0, -1), (1, 0), (0, 1), (-1, 0)
HALF_CIRCLE = [(math.cos(math.pi * n / 24), math.sin(math.pi * n / 24)) for n in range(25)]


def named(kind: str, what: str) -> str:
    """A symbol in words: the kind before it, but for the general one."""
    return what if kind == "general" else f"{kind} {what}"


class Equipment(Node):
    """A symbol with a heading, which is the direction of the flow, and perhaps a tag."""

    room = (0.7, 0.5)
    width = height = 0.9
    openings: tuple[Way, ...] = (LEFT, RIGHT)  # where a table of symbols draws a piece of pipe at it
    sides: Sequence[Way] = ()
    taps: Sequence[Way] = ()
    in_duct = on_shaft = False
    gap = 0.08  # between the symbol and its tag
    tag = ""

    def __init__(self, tag: str, words: str):
        self.tag, self.words = tag, f"{words} {tag}".strip()

    def met(self, sides: Sequence[Way], taps: Sequence[Way], heading: Way) -> None:
        """Learn at which sides pipes and signals meet it and which way the flow goes, and take the room for that."""
        self.sides, self.taps, self.heading = sides, taps, heading
        if self.tag:
            (dx, dy), (width, height) = self.tag_side(), text_size(self.tag, TAG_SIZE)
            across, up = 2 * (width + 0.2) if dx else width - self.width + 0.3, 2 * (height + 0.2) if dy else 0
            self.room = max(self.room[0], across), max(self.room[1], up)

    def tag_side(self) -> Way:
        """The first side where nothing else is; the lower left corner where there is none."""
        free = [side for side in (BELOW, RIGHT, ABOVE, LEFT) if side not in (*self.sides, *self.taps)]
        return free[0] if free else (-1, -1)

    def draw_tag(self, drawing: Drawing) -> None:
        if self.tag:
            dx, dy = self.tag_side()
            x, y = (self.x0, self.y0) if dx and dy else self.edge(dx, dy, self.x, self.y)
            halign, valign = {1: "left", 0: "center", -1: "right"}[dx], {1: "bottom", 0: "center", -1: "top"}[dy]
            drawing.text(x + self.gap * dx, y + self.gap * dy, self.tag, halign, valign, size=TAG_SIZE)

    def turned(self, *points: XY) -> list[XY]:
        """Points around the centre, turned from a flow to the right into the flow's direction."""
        return self.rotated(self.heading, *points)

    def rotated(self, way: Way, *points: XY) -> list[XY]:
        """Points around the centre, turned from a flow to the right into a way."""
        dx, dy = way
        return [(self.x + x * dx - y * dy, self.y + x * dy + y * dx) for x, y in points]

    def around(self, *points: XY) -> list[XY]:
        """Points around the centre, as they are."""
        return [(self.x + x, self.y + y) for x, y in points]
