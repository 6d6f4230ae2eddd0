"""Valves: a body that tells the kind, and what moves it on top."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING

from loopbook.diagrams.drawing import text_size
from loopbook.diagrams.equipment import ABOVE, HALF_CIRCLE, LEFT, RIGHT, TAG_SIZE, THIN, Equipment, named
from plainmath.validation import one_of

if TYPE_CHECKING:
    from loopbook.diagrams.drawing import XY, Drawing, Way

BODIES = ("general", "gate", "globe", "ball", "needle", "diaphragm", "butterfly", "angle", "three-way")
VALVES = (*BODIES, "check", "hand", "safety", "reducing")
ACTUATORS = ("diaphragm", "piston", "motor", "solenoid")
REACH, TOP, WHEEL = 0.42, 0.72, 0.52  # from the middle to a pipe, to where a signal ends, and to a hand wheel
HALF = 0.26  # of the body's height


def valve(tag: str = "", kind: str = "general") -> Valve:
    """Return a valve without an actuator; its tag, such as "V1", is beside it.

    Arguments:
        tag: written beside it.
        kind: "general", "gate", "globe", "ball", "needle", "diaphragm", "butterfly", "angle" and "three-way" (whose
            openings are where its pipes come from), "check" (lets the flow pass one way only), "hand" (with a wheel),
            "safety" (held by a spring) or "reducing" (holds the pressure behind it).
    Raises:
        ValueError: for another kind.

    >>> valve("V1"), valve(kind="ball")
    (<valve V1>, <ball valve>)
    """
    kind = one_of("the valve", kind, VALVES)
    top = kind if kind in ("hand", "safety", "reducing") else ""
    return Valve(tag, named(kind, "valve"), "general" if top else kind, top)


def control_valve(tag: str = "", actuator: str = "diaphragm", kind: str = "general") -> Valve:
    """Return a valve with an actuator, at which a signal ends; its tag is beside it.

    Arguments:
        tag: written beside it.
        actuator: "diaphragm" (pneumatic, with a spring), "piston" (pneumatic or hydraulic), "motor" (electrical) or
            "solenoid" (electrical, on and off).
        kind: of its body: "general", "gate", "globe", "ball", "needle", "diaphragm", "butterfly", "angle", "three-way".
    Raises:
        ValueError: for another actuator or kind.

    >>> control_valve("V1"), control_valve("V2", actuator="motor", kind="ball")
    (<control valve V1>, <ball control valve V2 with motor>)
    """
    made = Valve(tag, named(one_of("the control valve", kind, BODIES), "control valve"), kind,
                 one_of("the actuator", actuator, ACTUATORS))  # fmt: skip
    made.words += f" with {actuator}" * (actuator != "diaphragm")
    return made


class Valve(Equipment):
    inline, radius, height = True, REACH, 0.6

    def __init__(self, tag: str, words: str, kind: str, top: str):
        super().__init__(tag, words)
        self.kind, self.top = kind, top

    def met(self, sides: Sequence[Way], taps: Sequence[Way], heading: Way) -> None:
        """As for all equipment; what is on top points to where the signal comes from."""
        super().met(sides, taps, heading)
        reaches = dict.fromkeys(self.ports(), REACH)
        if self.top:
            reaches[self.side()] = TOP
        wide, high = (max(reaches.get(way, HALF) for way in ways) for ways in ((LEFT, RIGHT), (ABOVE, (0, -1))))
        self.width, self.height, self.room = max(0.6, 2 * wide + 0.06), max(0.6, 2 * high + 0.06), Equipment.room
        if self.tag:
            (dx, dy), (width, height) = self.tag_side(), text_size(self.tag, TAG_SIZE)
            across, up = 2 * (0.46 + width) - self.width, 2 * (0.46 + height) - self.height
            wider = width - self.width + 0.3
            self.room = max(self.room[0], across if dx else wider), max(self.room[1], up if dy else 0)

    @property
    def openings(self) -> tuple[Way, ...]:
        """Where its pipes are joined."""
        return self.ports()

    def ports(self) -> tuple[Way, ...]:
        """The sides at which pipes are joined: along the flow or, where the valve turns or divides it, as they come."""
        (dx, dy), count = self.heading, 3 if self.kind == "three-way" else 2
        if len(self.sides) == count and (count == 3 or self.sides[0] != _opposite(self.sides[1])):
            return tuple(self.sides)
        third = _opposite(self._top_side())
        return ((-dx, -dy), third) if self.kind == "angle" else ((-dx, -dy), (dx, dy), third)[:count]

    def side(self) -> Way:
        """Where its top is: where a signal comes from, or where no pipe is."""
        ports = self.ports()
        free = [way for way in (*self.taps, self._top_side(), ABOVE, RIGHT, (0, -1), LEFT) if way not in ports]
        return free[0]

    def _top_side(self):
        across = [way for way in self.taps if way not in (self.heading, _opposite(self.heading))]
        return across[0] if across else ABOVE if self.heading[0] else RIGHT

    def tag_side(self) -> Way:
        """Opposite to the top; at a corner where something else is there."""
        dx, dy = _opposite(self.side())
        return (dx, dy) if (dx, dy) not in (*self.ports(), *self.sides, *self.taps) else (dx or 1, dy or 1)

    def tap(self, dx: int, dy: int, x: float, y: float) -> XY:
        end = {"": REACH, "hand": WHEEL}.get(self.top, TOP)
        return self.x + end * dx, self.y + end * dy

    def draw(self, drawing: Drawing) -> None:
        if self.top:
            getattr(self, f"_{self.top}")(drawing)
        if self.kind in ("butterfly", "check"):
            for x in (-REACH, REACH):
                drawing.wire(*self.turned((x, -HALF), (x, HALF)))
        else:
            for port in self.ports():
                drawing.area(self.rotated(port, (0, 0), (REACH, HALF), (REACH, -HALF)), fill="white")
        self._inside(drawing)
        self.draw_tag(drawing)

    def draw_tag(self, drawing: Drawing) -> None:
        if self.tag:
            dx, dy = self.tag_side()
            halign, valign = _align(dx, "right", "left"), _align(dy, "top", "bottom")
            drawing.text(self.x + 0.36 * dx, self.y + 0.36 * dy, self.tag, halign, valign, size=TAG_SIZE)

    def _inside(self, drawing):
        match self.kind:
            case "gate":
                drawing.wire(*self.turned((0, -HALF), (0, HALF)))
            case "globe":
                drawing.circle(self.x, self.y, 0.11, fill="black")
            case "ball":
                drawing.circle(self.x, self.y, 0.15)
            case "needle":
                drawing.area(self.turned((0, -0.02), (-0.1, 0.26), (0.1, 0.26)), fill="black")
            case "diaphragm":
                drawing.wire(*self.turned(*[(0.28 * x, 0.06 + 0.24 * y) for x, y in HALF_CIRCLE]))
            case "butterfly":
                drawing.wire(*self.turned((-REACH, HALF), (REACH, -HALF)))
                drawing.circle(self.x, self.y, 0.08, fill="black")
            case "check":
                drawing.wire(*self.turned((-REACH, HALF), (REACH, -HALF)), arrow="->")

    # What is on top, in a frame of the flow and of the top's side.

    def _at(self, *points):
        (up_x, up_y), (dx, dy) = self.side(), self.heading
        if (dx, dy) in (self.side(), _opposite(self.side())):
            dx, dy = up_y, -up_x
        return [(self.x + a * dx + b * up_x, self.y + a * dy + b * up_y) for a, b in points]

    def _stem(self, drawing, end):
        drawing.wire(*self._at((0, 0), (0, end)))

    def _diaphragm(self, drawing):
        self._stem(drawing, 0.48)
        drawing.area(self._at(*[(0.26 * x, 0.48 + 0.24 * y) for x, y in HALF_CIRCLE]), fill="white")

    def _piston(self, drawing):
        self._stem(drawing, 0.54)
        drawing.wire(*self._at((-0.24, 0.34), (-0.24, TOP), (0.24, TOP), (0.24, 0.34), (-0.24, 0.34)))
        drawing.wire(*self._at((-0.24, 0.54), (0.24, 0.54)), width=2.2)

    def _motor(self, drawing):
        ((x, y),) = self._at((0, 0.5))
        self._stem(drawing, 0.28)
        drawing.circle(x, y, 0.22)
        drawing.text(x, y - 0.01, "M", size=9)

    def _solenoid(self, drawing):
        ((x, y),) = self._at((0, 0.5))
        self._stem(drawing, 0.28)
        drawing.area(self._at((-0.22, 0.28), (-0.22, TOP), (0.22, TOP), (0.22, 0.28)), fill="white")
        drawing.text(x, y - 0.01, "S", size=9)

    def _hand(self, drawing):
        self._stem(drawing, WHEEL)
        drawing.wire(*self._at((-0.22, WHEEL), (0.22, WHEEL)))

    def _safety(self, drawing):
        self._stem(drawing, 0.3)
        drawing.zigzag(*self._at((0, 0.28), (0, TOP - 0.02)), teeth=3, height=0.13)

    def _reducing(self, drawing):
        self._diaphragm(drawing)
        drawing.wire(*self._at((0.26, 0.48), (0.56, 0.48), (0.56, 0)), width=THIN)


def _opposite(way):
    return -way[0], -way[1]


def _align(way, towards, away):
    """The alignment of a text that lies on the positive or the negative side of its point."""
    return "center" if way == 0 else away if way > 0 else towards
