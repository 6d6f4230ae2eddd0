"""Pumps, fans, compressors, turbines and motors."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING

from loopbook.diagrams.equipment import HALF_CIRCLE, TAG_SIZE, Equipment, named
from plainmath.validation import one_of

if TYPE_CHECKING:
    from loopbook.diagrams.drawing import XY, Drawing

PUMPS = ("general", "centrifugal", "displacement", "gear", "screw", "diaphragm")
FANS = ("axial", "radial")
COMPRESSORS = ("turbo", "general", "piston", "screw")
ROUND = 0.45  # radius


def pump(tag: str = "", kind: str = "general") -> Pump:
    """Return a pump, which points the way of the flow; its tag is below it.

    Arguments:
        tag: written below it, or beside it where a pipe is below.
        kind: "general", "centrifugal", "displacement" (a piston), "gear", "screw" or "diaphragm".
    Raises:
        ValueError: for another kind.

    >>> pump("P1"), pump(kind="gear")
    (<pump P1>, <gear pump>)
    """
    return Pump(tag, named(one_of("the pump", kind, PUMPS), "pump"), kind)


def fan(tag: str = "", kind: str = "axial") -> Fan:
    """Return a fan, in a duct or by itself; its tag is below it.

    Arguments:
        tag: written below it, or beside it where a pipe is below.
        kind: "axial" (a propeller) or "radial" (a blower).
    Raises:
        ValueError: for another kind.

    >>> fan(), fan(kind="radial")
    (<fan>, <radial fan>)
    """
    return Fan(tag, "fan" if one_of("the fan", kind, FANS) == "axial" else "radial fan", kind)


def compressor(tag: str = "", kind: str = "turbo") -> Equipment:
    """Return a compressor, which narrows in the direction of the flow.

    Arguments:
        tag: stands in a turbo compressor, and below another one.
        kind: "turbo", or a circle: "general", "piston" or "screw".
    Raises:
        ValueError: for another kind.

    >>> compressor("K1"), compressor(kind="piston")
    (<compressor K1>, <piston compressor>)
    """
    if one_of("the compressor", kind, COMPRESSORS) == "turbo":
        return Turbo(tag, "compressor", (1, 0.5))
    return Compressor(tag, f"{kind} compressor", kind)


def turbine(tag: str = "") -> Turbo:
    """Return a turbine, which widens in the direction of the flow; its tag stands in it.

    >>> turbine("T1")
    <turbine T1>
    """
    return Turbo(tag, "turbine", (0.5, 1))


def motor(letters: str = "M") -> Motor:
    """Return a circle with a letter: "M" a motor, "G" a generator.

    >>> motor("G")
    <generator>
    """
    return Motor(letters)


class Round(Equipment):
    """A circle with what tells the kind in it."""

    radius = ROUND

    def __init__(self, tag: str, words: str, kind: str):
        super().__init__(tag, words)
        self.kind = kind

    def draw(self, drawing: Drawing) -> None:
        drawing.circle(self.x, self.y, self.radius)
        self.inside(drawing)
        self.draw_tag(drawing)

    def line(self, drawing: Drawing, *points: XY) -> None:
        drawing.wire(*self.turned(*points), zorder=3)

    def piston(self, drawing: Drawing, x: float = 0.0) -> None:
        self.line(drawing, (x - 0.16, -0.15), (x - 0.16, 0.15), (x + 0.06, 0.15), (x + 0.06, -0.15), (x - 0.16, -0.15))
        self.line(drawing, (x - 0.05, -0.15), (x - 0.05, 0.15))

    def screw(self, drawing: Drawing, x: float = 0.0) -> None:
        self.line(drawing, (x - 0.2, 0), (x + 0.15, 0))
        for n in range(3):
            self.line(drawing, (x - 0.2 + 0.12 * n, -0.13), (x - 0.12 + 0.12 * n, 0.13))


class Pump(Round):
    def inside(self, drawing: Drawing) -> None:
        self.line(drawing, (-0.22, 0.38), (0.45, 0), (-0.22, -0.38))
        match self.kind:
            case "centrifugal":
                drawing.circle(self.x, self.y, 0.13, fill="black")
            case "displacement":
                self.piston(drawing, -0.03)
            case "gear":
                for x, y in self.turned((-0.12, 0.13), (-0.12, -0.13)):
                    drawing.circle(x, y, 0.13)
            case "screw":
                self.screw(drawing, -0.05)
            case "diaphragm":
                self.line(drawing, *[(-0.22 + 0.22 * y, 0.26 * x) for x, y in HALF_CIRCLE])


class Compressor(Round):
    def inside(self, drawing: Drawing) -> None:
        for side in (-1, 1):
            self.line(drawing, (-0.25, 0.374 * side), (0.41, 0.185 * side))
        if self.kind == "piston":
            self.piston(drawing, 0.05)
        if self.kind == "screw":
            self.screw(drawing)


class Fan(Round):
    def edge(self, dx: int, dy: int, x: float, y: float) -> XY:
        """The walls of a duct go around it."""
        return (self.x, y) if dx and self.in_duct else super().edge(dx, dy, x, y)

    def inside(self, drawing: Drawing) -> None:
        if self.kind == "radial":
            drawing.circle(self.x, self.y, 0.2)
            for n in range(10):
                a, b = 2 * math.pi * n / 10, 2 * math.pi * (n + 0.6) / 10
                self.line(drawing, (0.2 * math.cos(a), 0.2 * math.sin(a)), (0.36 * math.cos(b), 0.36 * math.sin(b)))
            return
        for side in (-1, 1):
            blade = ((0, 0), (-0.12, 0.2 * side), (0, 0.36 * side), (0.12, 0.2 * side))
            drawing.area(self.turned(*blade), fill="black", zorder=3)


class Motor(Equipment):
    radius, room, openings = 0.42, (0.3, 0.4), ()

    def __init__(self, letters: str):
        super().__init__("", {"M": "motor", "G": "generator"}.get(letters, letters))
        self.letters = letters

    def draw(self, drawing: Drawing) -> None:
        drawing.circle(self.x, self.y, self.radius)
        drawing.text(self.x, self.y - 0.02, self.letters)


class Turbo(Equipment):
    width, height = 1.2, 1.2

    def __init__(self, tag: str, words: str, ends: tuple[float, float]):
        super().__init__("", words)
        self.inside, self.ends = tag, ends
        self.words = f"{words} {tag}".strip()

    def edge(self, dx: int, dy: int, x: float, y: float) -> XY:
        x, y = super().edge(dx, dy, x, y)
        ahead, aside = self.heading
        if (dx and ahead) or (dy and aside):
            return x, y
        # on a slanted side, which is nearer
        reach = self.reach((x - self.x) * ahead + (y - self.y) * aside)
        return (self.x + dx * reach, y) if dx else (x, self.y + dy * reach)

    def reach(self, along: float) -> float:
        """Half of its width at a place along the flow."""
        back, front = self.ends
        return 0.5 * self.height * (back + (front - back) * (along / self.width + 0.5))

    def draw(self, drawing: Drawing) -> None:
        half = self.width / 2
        back, front = self.reach(-half), self.reach(half)
        drawing.area(self.turned((-half, -back), (-half, back), (half, front), (half, -front)), fill="white")
        if self.inside:
            drawing.text(self.x, self.y, self.inside, size=TAG_SIZE)
