"""Tanks, vessels, reactors and columns."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING

from loopbook.diagrams.conductors import DASHES, draw_shaft
from loopbook.diagrams.drawing import FONT_SIZE, LIQUID, signal_name, wording
from loopbook.diagrams.equipment import HALF_CIRCLE, THICK, THIN, Equipment
from plainmath.validation import one_of

if TYPE_CHECKING:
    from loopbook.diagrams.drawing import XY, Drawing

BOW = 0.35  # height of the round end of a vessel
JACKET = 0.3
LID = 0.35  # height of a roof
DRIVE = 0.5  # height of a stirrer's motor above a vessel
ROOFS = ("open", "flat", "cone", "dome", "floating")


def tank(
    text: str = "",
    level: str = "",
    stirrer: bool = False,
    heater: bool = False,
    jacket: bool = False,
    filled: float = 0.65,
    roof: str = "open",
) -> Tank:
    """Return a tank with liquid; it takes up all the places that its name has in the layout.

    Arguments:
        text: stands in the liquid.
        level: name of the level, at an arrow from the bottom to the surface.
        stirrer, heater: True to draw a stirrer, or a heating element at the height of the lowest row of several.
        jacket: True for a jacket around it, in which a heating or cooling liquid flows.
        filled: how full it is, from 0 to 1.
        roof: "open" (none), "flat", "cone", "dome" or "floating" (on the liquid).
    Raises:
        ValueError: when `filled` is not between 0 and 1, or for another roof.

    >>> tank(level="h", stirrer=True)
    <tank with level h, stirrer>
    """
    if not 0 <= filled <= 1:
        raise ValueError(f"a tank is filled between 0 and 1, not {filled}")
    return Tank(text, level, stirrer, heater, jacket, filled, one_of("the roof", roof, ROOFS))


def vessel(
    text: str = "",
    filled: float = 0,
    trays: int = 0,
    lying: bool = False,
    packings: int = 0,
    stirrer: bool = False,
    jacket: bool = False,
    coil: bool = False,
) -> Vessel:
    """Return a closed vessel, as a drum, a reactor, a separator or a column.

    Arguments:
        text: stands in it; mathematics between dollar signs.
        filled: how full of liquid it is, from 0 to 1.
        trays: number of the trays of a column.
        lying: True for a vessel with its round ends at the sides.
        packings: number of the packed beds of a column.
        stirrer: True for a stirrer with its motor, as in a reactor.
        jacket: True for a jacket around it, in which a heating or cooling liquid flows.
        coil: True for a heating or cooling coil in the liquid.
    Raises:
        ValueError: when `filled` is not between 0 and 1, and for what does not go together: trays and packings, or any
            of these, a stirrer, a jacket or a coil in a lying vessel.

    >>> vessel("A1", trays=5), vessel(stirrer=True, jacket=True)
    (<vessel A1 with 5 trays>, <vessel with stirrer, jacket>)
    """
    if not 0 <= filled <= 1:
        raise ValueError(f"a vessel is filled between 0 and 1, not {filled}")
    if trays and packings:
        raise ValueError(f"a column has either trays or packings, not {trays} trays and {packings} packings")
    if lying and (trays or packings or stirrer or jacket or coil):
        raise ValueError("a lying vessel has neither trays nor packings, stirrer, jacket or coil: lying=False")
    return Vessel(text, filled, trays, lying, packings, stirrer, jacket, coil)


def cyclone(tag: str = "") -> Funnel:
    """Return a cyclone, which separates a solid from a gas; its tag stands in it.

    >>> cyclone("C1")
    <cyclone C1>
    """
    return Funnel(tag, "cyclone")


def silo(tag: str = "") -> Funnel:
    """Return a silo for solid material; its tag stands in it.

    >>> silo("S1")
    <silo S1>
    """
    return Funnel(tag, "silo")


class Container(Equipment):
    """What fills all places of its name, with what may be in it."""

    room, leaves, openings = (0.7, 0.4), "up or down", ()
    tops: tuple[float, ...] = ()  # where pipes come from above

    def stirrer_place(self, middle: float, width: float) -> float:
        """In the middle, or a little aside where a pipe comes from above; under the shaft where there is one."""
        if self.on_shaft and self.tops:
            return min(self.tops, key=lambda x: abs(x - middle))
        return middle + (0.27 * width if any(abs(x - middle) < 0.35 for x in self.tops) else 0)

    def met_above(self, x: float) -> None:
        self.tops = (*self.tops, x)

    def draw_jacket(self, drawing: Drawing, x0: float, x1: float) -> None:
        """Around walls at x0 and x1, if there is one."""
        if self.jacket:
            top = self.jacket_top() - self.jacket
            outside = [(self.x0, top), (self.x0, self.y0), (self.x1, self.y0), (self.x1, top)]
            drawing.wire((x0, self.jacket_top()), *outside, (x1, self.jacket_top()), width=THICK)


def draw_stirrer(
    drawing: Drawing, x: float, top: float, blade: float, half: float = 0.41, on_shaft: bool = False
) -> None:
    if on_shaft:
        draw_shaft(drawing, [(x, top), (x, blade)])
    else:
        drawing.wire((x, top), (x, blade))
    for side in (-half, half):
        tip = [(x + part * side, blade + lift) for part, lift in ((0.6, 0.1), (1, 0), (0.6, -0.1))]
        drawing.area([(x, blade), *tip], fill="white")


class Tank(Container):
    height = 2.4

    def __init__(self, text: str, level: str, stirrer: bool, heater: bool, jacket: bool, filled: float, roof: str):
        self.text, self.level, self.filled, self.roof = text, level, filled, roof
        self.stirrer, self.heater, self.jacket = stirrer, heater, JACKET if jacket else 0
        parts = [f"level {level}"] * bool(level) + ["stirrer"] * stirrer + ["heater"] * heater + ["jacket"] * jacket
        parts += [f"{roof} roof"] * (roof != "open")
        self.words = "tank" + (f" {text}" if text else "") + (f" with {', '.join(parts)}" if parts else "")
        self.width = 3.0 if stirrer else 2.4

    def inside(self) -> tuple[float, float, float, float]:
        lid = LID if self.roof in ("cone", "dome") else 0
        return self.x0 + self.jacket, self.x1 - self.jacket, self.y0 + self.jacket, self.y1 - lid

    def jacket_top(self) -> float:
        return self.y0 + 0.72 * (self.y1 - self.y0)

    def surface(self) -> float:
        _, _, y0, y1 = self.inside()
        return y0 + self.filled * (y1 - y0)

    def edge(self, dx: int, dy: int, x: float, y: float) -> XY:
        x0, x1, _, y1 = self.inside()
        if dx:
            return ((x1 if dx > 0 else x0), min(y, y1)) if y > self.jacket_top() else super().edge(dx, dy, x, y)
        if dy < 0:  # through the jacket, whose own pipes meet it at its sides
            return x, self.inside()[2]
        self.met_above(x)
        return x, self.roof_at(x)

    def roof_at(self, x: float) -> float:
        """Where what comes from above ends: within an open tank, and on a roof."""
        x0, x1, _, y1 = self.inside()
        part = min(1, abs(2 * x - x0 - x1) / (x1 - x0))  # from the middle to the wall
        match self.roof:
            case "flat":
                return y1
            case "cone":
                return y1 + LID * (1 - part)
            case "dome":
                return y1 + LID * math.sqrt(1 - part**2)
        return y1 - 0.2

    def draw(self, drawing: Drawing) -> None:
        x0, x1, y0, y1 = self.inside()
        surface, middle = self.surface(), (x0 + x1) / 2
        self.draw_jacket(drawing, x0, x1)
        if self.filled:
            drawing.area([(x0, y0), (x1, y0), (x1, surface), (x0, surface)], fill=LIQUID, outline=0)
            drawing.wire((x0, surface), (x1, surface), width=THIN)
        drawing.wire((x0, y1), (x0, y0), (x1, y0), (x1, y1), width=THICK)
        self.draw_roof(drawing)
        if self.stirrer:
            blade = y0 + (0.5 if self.heater else 0.3) * (surface - y0)
            x = self.stirrer_place(middle, x1 - x0)
            draw_stirrer(drawing, x, self.roof_at(x) if self.on_shaft else self.y1 + 0.2, blade, on_shaft=self.on_shaft)
        if self.heater:
            at = self.levels[-1] if len(self.levels) > 1 else y0 + 0.25 * (y1 - y0)
            drawing.zigzag((x0, at), (x0 + 0.45 * (x1 - x0), at), teeth=4, height=0.16)
        if self.level:
            at = x1 - 0.3
            drawing.wire((at, y0), (at, surface), arrow="<->", width=THIN)
            drawing.text(at - 0.12, y0 + 0.68 * (surface - y0), signal_name(self.level), halign="right")
        if self.text:
            left = 0.27 if self.stirrer else 0.43 if self.level else 0.5
            up = 0.75 if self.stirrer or self.heater else 0.3 if self.level else 0.5
            drawing.text(x0 + left * (x1 - x0), y0 + up * (surface - y0), wording(self.text))

    def draw_roof(self, drawing: Drawing) -> None:
        x0, x1, *_ = self.inside()
        if self.roof == "floating":
            height = self.surface() + 0.1
            drawing.wire((x0 + 0.06, height), (x1 - 0.06, height), width=2 * THICK)
        elif self.roof != "open":
            xs = [(x0 + x1 + (x1 - x0) * x) / 2 for x, _ in HALF_CIRCLE]
            drawing.wire(*[(x, self.roof_at(x)) for x in xs], width=THICK)


class Vessel(Container):
    width, height, room = 1.5, 2.0, (0.6, 0.5)

    def __init__(
        self, text: str, filled: float, trays: int, lying: bool, packings: int, stirrer: bool, jacket: bool, coil: bool
    ):
        self.text, self.filled, self.trays, self.lying = text, filled, trays, lying
        self.packings, self.stirrer, self.coil, self.jacket = packings, stirrer, coil, JACKET if jacket else 0
        if lying:
            self.width, self.height = 2.4, 1.3
        if trays or packings:
            self.height = 2.8
        self.width += 2 * self.jacket
        self.height += self.jacket + DRIVE * stirrer
        parts = [f"{trays} trays"] * bool(trays) + [f"{packings} packings"] * bool(packings)
        parts += ["stirrer"] * stirrer + ["jacket"] * jacket + ["coil"] * coil
        self.words = f"{'lying ' * lying}vessel {text}".strip() + (f" with {', '.join(parts)}" if parts else "")

    def shell(self) -> tuple[float, float, float, float]:
        j = self.jacket
        return self.x0 + j, self.x1 - j, self.y0 + j, self.y1 - DRIVE * self.stirrer

    def jacket_top(self) -> float:
        return self.shell()[3] - BOW - 0.15

    def edge(self, dx: int, dy: int, x: float, y: float) -> XY:
        """On the round ends it is further in; around a jacket it is further out."""
        if dy > 0:
            self.met_above(x)
        if self.jacket and (dy < 0 or (dx and y < self.jacket_top())):
            return super().edge(dx, dy, x, y)
        x0, x1, y0, y1 = self.shell()
        end, across = ((x0, x1), x) if self.lying else ((y0, y1), y)
        depth = min(1, max(0, BOW - min(across - end[0], end[1] - across)) / BOW)
        inward = (1 - math.sqrt(1 - depth**2)) * (y1 - y0 if self.lying else x1 - x0) / 2
        if self.lying:
            return ((x1 if dx > 0 else x0), y) if dx else (x, (y1 if dy > 0 else y0) - dy * inward)
        if dx:
            return (x1 if dx > 0 else x0) - dx * inward, min(y, y1)
        return x, (y1 if dy > 0 else y0)

    def draw(self, drawing: Drawing) -> None:
        x0, x1, y0, y1 = self.shell()
        outline, surface = self._outline(x0, x1, y0, y1), y0 + self.filled * (y1 - y0)
        self.draw_jacket(drawing, x0, x1)
        drawing.area(outline, fill="white", outline=THICK)
        if self.filled:
            drawing.area([(x, min(y, surface)) for x, y in outline], fill=LIQUID, outline=THICK)
        bottom = max(surface, y0 + BOW)
        for n in range(self.trays):
            y = bottom + (y1 - BOW - bottom) * (n + 0.5) / self.trays
            drawing.wire((x0, y), (x1, y), style=DASHES, width=THIN)
        self._packings(drawing, x0, x1, bottom, y1 - BOW)
        if self.coil:
            at = self.levels[-1] if len(self.levels) > 1 else y0 + 0.35 * (y1 - y0)
            drawing.zigzag((x0, at), (x1, at), teeth=4, height=0.14)
        if self.stirrer:
            self._stirrer(drawing, x0, x1, y0, y1)
        if self.text:
            column = self.trays or self.packings
            text = y1 - 0.6 * BOW if column else (surface + y1) / 2 if self.filled else (y0 + y1) / 2
            x = x0 + 0.25 * (x1 - x0) if self.stirrer else self.x
            drawing.text(x, text, self.text, size=10 if column or self.stirrer else FONT_SIZE)

    def _stirrer(self, drawing, x0, x1, y0, y1):
        x = self.stirrer_place(self.x, x1 - x0)
        blade = y0 + (0.55 if self.coil else 0.25) * (y1 - y0)
        if self.on_shaft:  # its motor is drawn elsewhere
            draw_stirrer(drawing, x, y1, blade, half=0.33, on_shaft=True)
            return
        draw_stirrer(drawing, x, y1 + 0.1, blade, half=0.33)
        drawing.circle(x, y1 + 0.28, 0.2)
        drawing.text(x, y1 + 0.27, "M", size=8)

    def _packings(self, drawing, x0, x1, low, high):
        for n in range(self.packings):
            pitch = (high - low) / self.packings
            bottom, top = (low + pitch * (n + part) for part in (0.12, 0.88))
            drawing.wire((x0, bottom), (x1, bottom), (x0, top), (x1, top), (x0, bottom), width=THIN)

    def _outline(self, x0, x1, y0, y1):
        half, middle, height = (y1 - y0 if self.lying else x1 - x0) / 2, (x0 + x1) / 2, (y0 + y1) / 2
        if self.lying:
            right = [(x1 - BOW + BOW * y, height - half * x) for x, y in HALF_CIRCLE]
            return right + [(x0 + x1 - x, y0 + y1 - y) for x, y in right]
        top = [(middle + half * x, y1 - BOW + BOW * y) for x, y in HALF_CIRCLE]
        return top + [(x0 + x1 - x, y0 + y1 - y) for x, y in top]


class Funnel(Container):
    """A cylinder with a cone below it."""

    width, height, mouth = 1.3, 2.0, 0.12

    def __init__(self, tag: str, kind: str):
        self.kind, self.text, self.words = kind, tag, f"{kind} {tag}".strip()

    def knee(self) -> float:
        return self.y0 + 0.5 * (self.y1 - self.y0)

    def edge(self, dx: int, dy: int, x: float, y: float) -> XY:
        half, way = (self.x1 - self.x0) / 2, self.knee() - self.y0
        if dx and y < self.knee():
            return self.x + dx * (self.mouth + (half - self.mouth) * (y - self.y0) / way), y
        if dy < 0:
            return x, self.y0 + way * max(0, abs(x - self.x) - self.mouth) / (half - self.mouth)
        return super().edge(dx, dy, x, y)

    def draw(self, drawing: Drawing) -> None:
        knee = self.knee()
        left = [(self.x - self.mouth, self.y0), (self.x0, knee), (self.x0, self.y1)]
        drawing.area([*left, *[(2 * self.x - x, y) for x, y in reversed(left)]], fill="white", outline=THICK)
        if self.kind == "cyclone":  # the pipe in which the gas goes up
            for side in (-0.18, 0.18):
                drawing.wire((self.x + side, self.y1), (self.x + side, knee + 0.35), width=THIN)
        else:
            heap = [(self.x0, knee + 0.15), (self.x, knee + 0.5), (self.x1, knee + 0.15)]
            drawing.area([left[0], left[1], *heap, (self.x1, knee), (self.x + self.mouth, self.y0)], fill=LIQUID,
                       outline=THICK)  # fmt: skip
        if self.text:
            drawing.text(self.x, knee - 0.1, self.text, size=10)
