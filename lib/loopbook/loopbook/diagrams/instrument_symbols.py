"""Instruments: a circle with the letters of the tag; a line across it says where the instrument is."""

from __future__ import annotations

import re
from typing import TYPE_CHECKING

from loopbook.diagrams.conductors import DASHES
from loopbook.diagrams.drawing import text_size
from loopbook.diagrams.equipment import Equipment
from loopbook.instruments import decode
from plainmath.validation import one_of

if TYPE_CHECKING:
    from loopbook.diagrams.drawing import Drawing

PLACES = ("field", "panel", "behind", "local panel")
DEVICES = ("discrete", "shared", "computer")
HEXAGON = ((0.56, 0), (0.28, 0.5), (-0.28, 0.5), (-0.56, 0), (-0.28, -0.5), (0.28, -0.5))
SQUARE = ((0.5, 0.5), (-0.5, 0.5), (-0.5, -0.5), (0.5, -0.5))


def instrument(letters: str, place: str = "field", device: str = "discrete") -> Instrument:
    """Return an instrument: a circle with its letters, and a number below them where there is one.

    Arguments:
        letters: a tag that `loopbook.instruments.decode` explains, such as "LT" or "FC123"; "" where it is not yet
            written.
        place: "field" (beside the process), "panel" (in the control room: a line across it), "behind" (behind the
            panel, where no operator reaches it: a dashed line) or "local panel" (two lines).
        device: "discrete" (one instrument), "shared" (a display or controller of a control system, which several loops
            share: a square around it) or "computer" (a function of a computer: a hexagon).
    Raises:
        ValueError: for a tag that the table of letters does not explain, another place or another device.

    >>> instrument("TC1", place="panel")
    <TC1>
    >>> instrument("")
    <instrument without a tag>
    """
    if letters:
        decode(letters)
    return Instrument(letters, one_of("the place", place, PLACES), one_of("the device", device, DEVICES))


class Instrument(Equipment):
    width = height = 1.0
    radius: float | None
    radius, room, inline, openings = 0.5, (0.6, 0.4), True, ()

    def __init__(self, letters: str, place: str, device: str):
        super().__init__("", letters or "instrument without a tag")
        self.letters = letters
        self.place_in_plant, self.device = place, device
        if device == "computer":
            self.radius, self.width = None, 2 * HEXAGON[0][0]

    def draw(self, drawing: Drawing) -> None:
        letters, number = re.fullmatch(r"([A-Z]*)-?(.*)", self.letters).groups()
        if self.device == "computer":
            drawing.area(self.around(*HEXAGON), fill="white", zorder=3)
        else:
            if self.device == "shared":
                drawing.area(self.around(*SQUARE), fill="white", zorder=3)
            drawing.circle(self.x, self.y, 0.5)
        lines = {"field": (), "panel": (0,), "behind": (0,), "local panel": (-0.04, 0.04)}[self.place_in_plant]
        half = self.width / 2
        for y in lines:
            style = DASHES if self.place_in_plant == "behind" else "-"
            drawing.wire((self.x - half, self.y + y), (self.x + half, self.y + y), style=style, zorder=3)
        lift = 0.2 if lines or number else 0
        size = 10 if lift else 11
        size *= min(1, 0.72 / text_size(letters, size)[0])  # four letters and more
        drawing.text(self.x, self.y + lift - 0.03, letters, size=size)
        if number:
            drawing.text(self.x, self.y - 0.22, number, size=9 * min(1, 0.66 / text_size(number, 9)[0]))
