"""Heat exchangers and heaters."""

from __future__ import annotations

from typing import TYPE_CHECKING

from loopbook.diagrams.conductors import DUCT
from loopbook.diagrams.drawing import LIQUID
from loopbook.diagrams.equipment import ABOVE, BELOW, HALF_CIRCLE, LEFT, RIGHT, THICK, THIN, Equipment, named
from plainmath.validation import one_of

if TYPE_CHECKING:
    from loopbook.diagrams.drawing import XY, Drawing

EXCHANGERS = ("general", "shell and tube", "plate", "cooler", "air cooler", "condenser", "reboiler")
HEATERS = ("duct", "electric", "steam", "fired")
SIZES = {"shell and tube": (2.2, 0.9), "plate": (1.0, 1.2), "air cooler": (1.5, 1.2), "condenser": (2.2, 1.1),
         "reboiler": (2.2, 1.1), "electric": (1.6, 0.8)}  # fmt: skip


def heat_exchanger(tag: str = "", kind: str = "general") -> Equipment:
    """Return a heat exchanger, which one stream passes along and the other one across; its tag is beside it.

    Arguments:
        tag: written beside it.
        kind: "general", "shell and tube", "plate", "cooler" (by a medium of the plant), "air cooler", "condenser" or
            "reboiler".
    Raises:
        ValueError: for another kind.

    >>> heat_exchanger("H1"), heat_exchanger(kind="plate")
    (<heat exchanger H1>, <plate heat exchanger>)
    """
    one_of("the heat exchanger", kind, EXCHANGERS)
    words = named(kind, "heat exchanger") if kind in ("general", "shell and tube", "plate") else kind
    return Circled(tag, words, kind) if kind in ("general", "cooler") else Boxed(tag, words, kind)


def heater(tag: str = "", kind: str = "duct") -> Equipment:
    """Return a heater; its tag is below it.

    Arguments:
        tag: written below it, or beside it where a pipe is below.
        kind: "duct" (electrical, within an air duct), "electric", "steam" or "fired" (a furnace).
    Raises:
        ValueError: for another kind.

    >>> heater(), heater("F1", kind="fired")
    (<heater>, <fired heater F1>)
    """
    words = "heater" if one_of("the heater", kind, HEATERS) == "duct" else f"{kind} heater"
    return {"duct": DuctHeater, "fired": Furnace, "steam": Circled, "electric": Boxed}[kind](tag, words, kind)


class Circled(Equipment):
    """One stream goes on, the other one bends its way across; an arrow upwards brings heat, one downwards takes it."""

    radius = 0.45

    def __init__(self, tag: str, words: str, kind: str):
        super().__init__(tag, words)
        self.kind = kind
        if kind == "general":
            self.openings = (LEFT, RIGHT, ABOVE, BELOW)

    def draw(self, drawing: Drawing) -> None:
        drawing.circle(self.x, self.y, self.radius)
        if self.kind == "general":
            bends = ((0, 0.45), (0, 0.25), (0.25, 0.12), (-0.25, -0.12), (0, -0.25), (0, -0.45))
            drawing.wire(*self.around(*bends), zorder=3)
        else:
            up = 1 if self.kind == "steam" else -1
            drawing.wire(*self.around((-0.42, -0.42 * up), (0.44, 0.44 * up)), arrow="->", zorder=3)
        self.draw_tag(drawing)


class Boxed(Equipment):
    """What has tubes, plates or wires in a box or a shell."""

    def __init__(self, tag: str, words: str, kind: str):
        super().__init__(tag, words)
        self.kind, (self.width, self.height) = kind, SIZES[kind]
        if kind in ("shell and tube", "plate"):
            self.openings = (LEFT, RIGHT, ABOVE, BELOW)
        if kind in ("condenser", "reboiler"):
            self.openings = (ABOVE, BELOW)

    def draw(self, drawing: Drawing) -> None:
        corners = [(self.x0, self.y0), (self.x0, self.y1), (self.x1, self.y1), (self.x1, self.y0)]
        drawing.area(corners, fill="white")
        {"shell and tube": self._tubes, "plate": self._plates, "air cooler": self._air, "condenser": self._bath,
         "reboiler": self._bath, "electric": self._wire}[self.kind](drawing)  # fmt: skip
        self.draw_tag(drawing)

    def _tubes(self, drawing):
        for x in (self.x0 + 0.35, self.x1 - 0.35):
            drawing.wire((x, self.y0), (x, self.y1))
        for part in (0.2, 0.4, 0.6, 0.8):
            y = self.y0 + part * (self.y1 - self.y0)
            drawing.wire((self.x0 + 0.35, y), (self.x1 - 0.35, y), width=THIN)

    def _plates(self, drawing):
        for n in range(1, 6):
            x = self.x0 + n * (self.x1 - self.x0) / 6
            low, high = (0.12, 0) if n % 2 else (0, 0.12)
            drawing.wire((x, self.y0 + low), (x, self.y1 - high))

    def _air(self, drawing):
        drawing.zigzag((self.x0, self.y + 0.2), (self.x1, self.y + 0.2), teeth=4, height=0.2)
        for side in (-1, 1):
            x, y = self.x, self.y0 + 0.22
            blade = [(x, y), (x + 0.2 * side, y + 0.11), (x + 0.4 * side, y), (x + 0.2 * side, y - 0.11)]
            drawing.area(blade, fill="black")

    def _bath(self, drawing):
        """The tubes above the liquid that they make, or in the liquid that they boil."""
        condenser = self.kind == "condenser"
        surface = self.y0 + (0.3 if condenser else 0.65) * (self.y1 - self.y0)
        liquid = [(self.x0, self.y0), (self.x1, self.y0), (self.x1, surface), (self.x0, surface)]
        drawing.area(liquid, fill=LIQUID)
        low, high = (0.45, 0.75) if condenser else (0.15, 0.45)
        low, high = (self.y0 + part * (self.y1 - self.y0) for part in (low, high))
        end = self.x1 - 0.45
        curvature = [(end + (high - low) / 2 * y, (low + high) / 2 + (high - low) / 2 * x) for x, y in HALF_CIRCLE]
        drawing.wire((self.x0, high), *curvature, (self.x0, low))

    def _wire(self, drawing):
        drawing.zigzag((self.x0, self.y), (self.x1, self.y), teeth=5, height=0.22)


class Furnace(Equipment):
    """A box with a chimney, a flame in it, and the pipe that it heats."""

    width, height, room = 1.6, 1.9, (0.6, 0.5)

    def __init__(self, tag: str, words: str, kind: str):
        super().__init__(tag, words)

    def edge(self, dx: int, dy: int, x: float, y: float) -> XY:
        """Up to the shoulders, and above them to the chimney."""
        return super().edge(dx, dy, x, min(y, self.shoulder()))

    def shoulder(self) -> float:
        return self.y1 - 0.75

    def draw(self, drawing: Drawing) -> None:
        half, top = 0.16, self.shoulder()
        left = [(self.x0, self.y0), (self.x0, top), (self.x - half, top + 0.35), (self.x - half, self.y1)]
        drawing.area([*left, *[(2 * self.x - x, y) for x, y in reversed(left)]], fill="white")
        drawing.zigzag((self.x0, self.y), (self.x1, self.y), teeth=4, height=0.15)
        for side, height in ((-0.3, 0.3), (0, 0.42), (0.3, 0.3)):
            x = self.x + side
            flame = [(x - 0.1, self.y0 + 0.05), (x, self.y0 + 0.05 + height), (x + 0.1, self.y0 + 0.05)]
            drawing.wire(*flame)
        self.draw_tag(drawing)


class DuctHeater(Equipment):
    """Electrical heating elements across an air duct."""

    width, height, room, openings = 1.4, 2 * DUCT, (0.2, 0.5), ()

    def __init__(self, tag: str, words: str, kind: str):
        super().__init__(tag, words)

    def draw(self, drawing: Drawing) -> None:
        for y in (self.y0, self.y1):
            drawing.wire((self.x0, y), (self.x1, y), width=THICK)
        for x in (self.x - 0.5, self.x, self.x + 0.5):
            drawing.zigzag((x, self.y0), (x, self.y1), teeth=3, height=0.15)
        self.draw_tag(drawing)
