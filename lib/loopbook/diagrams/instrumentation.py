r"""Diagrams of plants with their pipes, instruments and signals (P&I diagrams), placed on a grid as in `grid_diagram`.

A name of two to four capitals, with a number behind it or without, is an instrument (LT, TC1); what else is to be drawn
stands in `equipment`; every other name is a text, such as that of a stream.
"""

import copy
import math
import re

from loopbook.diagrams.blocks import block
from loopbook.diagrams.grid import BlockNode, Grid, Junction, Label, Node, Point, connections, direction, neighbours
from loopbook.diagrams.sheet import FONT_SIZE, LIQUID, Sheet, signal_name, wording

THICK = 1.7  # points: pipes and the walls of vessels
DASHES = "--"
DUCT = 0.5  # half the width of an air duct
BOW = 0.35  # height of the round end of a vessel
HALF_CIRCLE = [(math.cos(math.pi * n / 24), math.sin(math.pi * n / 24)) for n in range(25)]


def instrumentation_diagram(layout, pipes="", signals="", equipment=None, names=None, ducts="", shafts="", title=None):
    """Draw a plant with its pipes, instruments and signals.

    Arguments:
        layout: a text with one line a row, in it the names of what stands there, as `grid_diagram` takes it.
        pipes: a text with the ways of the material, a comma or a new line between them; each the names that it meets.
        signals: the same for the signals, which are dashed; from a pipe or vessel to an instrument the line is solid,
            as there something is measured. Several signals into one number are summed, with the sign before the number.
        equipment: ``{name: what it is}``: `tank`, `vessel`, `valve`, `control_valve`, `pump`, `motor` and so on; a text
            is a box with that label, such as a function block.
        names: ``{name: label}`` for texts that are to be written otherwise than their name in the layout.
        ducts, shafts: the same as `pipes` for wide ducts (air, gas) and for mechanical shafts.
        title: stands above the diagram.
    Returns:
        A `Picture`, which a notebook shows as the value of a cell.
    Raises:
        ValueError: for a layout with rows of different length, a name that fills no rectangle, a path to a name that is
            not in the layout, a line that would run through other equipment, or equipment of no known kind.

    >>> layout = '''
    ...     q_in  1     .   h_SP  .
    ...     .     tank  LT  LC    .
    ...     .     2     .   pump  q_out'''
    >>> parts = {"tank": tank(), "pump": pump()}
    >>> instrumentation_diagram(layout, "q_in 1 tank 2 pump q_out", "tank LT LC pump, h_SP LC", parts)
    <P&I diagram: pipes: q_in → tank → pump → q_out; signals: tank → LT → LC → pump; h_SP → LC>
    """
    equipment, names = dict(equipment or {}), names or {}
    for name, what in equipment.items():
        equipment[name] = BlockNode(block(what)) if isinstance(what, str) else what
        if not isinstance(equipment[name], Node):
            raise ValueError(f"{name} is {what!r}, which is no equipment of a plant")
    kinds = {"pipes": pipes, "ducts": ducts, "shafts": shafts, "signals": signals}
    edges = {kind: connections(text) for kind, text in kinds.items()}
    every = [edge for kind in edges.values() for edge in kind]
    entering, leaving = neighbours(every)
    told = neighbours(edges["signals"])[0]

    def node(name):
        if name in equipment:
            return copy.copy(equipment[name])
        if name.isdigit():
            return Junction() if len(told.get(name, ())) > 1 else Point()
        if name not in names and re.fullmatch(r"[A-Z]{2,4}\d*", name):
            return instrument(name)
        return Label(names.get(name, name), through=name in entering and name in leaving)

    grid = Grid(layout, node)
    grid.expect([*equipment, *names, *entering, *leaving])
    sheet = Sheet()
    for kind, draw in (("pipes", _pipe), ("ducts", _duct), ("shafts", _shaft)):
        for start, end in edges[kind]:
            points = grid.route(start, end)
            if kind != "shafts":
                grid[start].heading, grid[end].heading = direction(*points[:2]), direction(*points[-2:])
            draw(sheet, points, grid[end])
    for (start, end), sign in edges["signals"].items():
        points = grid.route(start, end, at="tap")
        measured = start not in told and not isinstance(grid[start], (Instrument, Label, BlockNode))
        _signal(sheet, points, grid[end], measured)
        if isinstance(grid[end], Junction):
            sheet.sign(grid[end].x, grid[end].y, direction(points[-1], points[-2]), sign or "+")
    for node in grid.nodes.values():
        node.draw(sheet)
    words = "; ".join(f"{kind}: {grid.words(text)}" for kind, text in kinds.items() if text.strip())
    return sheet.picture(title, f"P&I diagram: {words}")


def _pipe(sheet, points, end):
    sheet.wire(*points, arrow="->" if end.arrow_in and not end.inline else None, width=THICK)


def _duct(sheet, points, end):
    (x0, y), (x1, _) = points[0], points[-1]
    for side in (-DUCT, DUCT):
        sheet.wire((x0, y + side), (x1, y + side), width=THICK)
    if isinstance(end, Label):
        sheet.wire((x1 - 0.6, y), (x1, y), arrow="->")


def _shaft(sheet, points, end):
    for side in (-0.05, 0.05):
        sheet.wire(*[(x, y + side) for x, y in points])


def _signal(sheet, points, end, measured):
    if measured:
        sheet.wire(*points, width=0.8)
        return
    sheet.wire(*points, style=DASHES)
    if end.arrow_in:  # the head on a piece of its own, as a dash may not reach it
        (x, y), (dx, dy) = points[-1], direction(*points[-2:])
        sheet.wire((x - 0.3 * dx, y - 0.3 * dy), (x, y), arrow="->")


# ---------------------------------------------------------------------------------------------------- the equipment


def instrument(letters, panel=False):
    """Return an instrument: a circle with its letters, and a number below them where there is one.

    Arguments:
        letters: such as "LT" or "FC123".
        panel: True for an instrument in the control room, which has a line across the circle.
    Raises:
        ValueError: for anything but one to four capitals with a number behind them or none.

    >>> instrument("TC1")
    <TC1>
    """
    if not re.fullmatch(r"[A-Z]{1,4}\d*", letters):
        raise ValueError(f"an instrument has one to four capital letters and perhaps a number, not {letters!r}")
    return Instrument(letters, panel)


def tank(text="", level="", stirrer=False, heater=False, jacket=False, filled=0.65):
    """Return an open tank with liquid; it takes up all the places that its name has in the layout.

    Arguments:
        text: stands in the liquid.
        level: name of the level, at an arrow from the bottom to the surface.
        stirrer, heater: True to draw a stirrer, or a heating element at the height of the lowest row.
        jacket: True for a jacket around it, in which a heating or cooling liquid flows.
        filled: how full it is, from 0 to 1.
    Raises:
        ValueError: when `filled` is not between 0 and 1.

    >>> tank(level="h", stirrer=True)
    <tank with level h, stirrer>
    """
    if not 0 <= filled <= 1:
        raise ValueError(f"a tank is filled between 0 and 1, not {filled}")
    return Tank(text, level, stirrer, heater, jacket, filled)


def vessel(text="", filled=0, trays=0, lying=False):
    """Return a closed vessel, as a drum, a reactor, a separator or a column.

    Arguments:
        text: stands in it; mathematics between dollar signs.
        filled: how full of liquid it is, from 0 to 1.
        trays: number of the trays of a column.
        lying: True for a vessel with its round ends at the sides.
    Raises:
        ValueError: when `filled` is not between 0 and 1.

    >>> vessel("A1", trays=5)
    <vessel A1 with 5 trays>
    """
    if not 0 <= filled <= 1:
        raise ValueError(f"a vessel is filled between 0 and 1, not {filled}")
    return Vessel(text, filled, trays, lying)


def valve(tag=""):
    """Return a valve that is set by hand; its tag, such as "V1", stands beside it.

    >>> valve("V1")
    <valve V1>
    """
    return Valve(tag, "valve", actuator=False)


def control_valve(tag=""):
    """Return a valve with an actuator, at which a signal ends; its tag stands beside it.

    >>> control_valve("V1")
    <control valve V1>
    """
    return Valve(tag, "control valve", actuator=True)


def pump(tag=""):
    """Return a pump; its tag stands below it.

    >>> pump("P1")
    <pump P1>
    """
    return Pump(tag, "pump")


def fan(tag=""):
    """Return a fan, in a duct or by itself; its tag stands below it.

    >>> fan()
    <fan>
    """
    return Fan(tag, "fan")


def heater(tag=""):
    """Return an electrical heater in a duct; its tag stands below it.

    >>> heater()
    <heater>
    """
    return Heater(tag, "heater")


def heat_exchanger(tag=""):
    """Return a heat exchanger, which one stream passes along and the other one across; its tag stands beside it.

    >>> heat_exchanger("H1")
    <heat exchanger H1>
    """
    return HeatExchanger(tag, "heat exchanger")


def compressor(tag=""):
    """Return a compressor, which narrows in the direction of the flow; its tag stands in it.

    >>> compressor("K1")
    <compressor K1>
    """
    return Turbo(tag, "compressor", (1, 0.5))


def turbine(tag=""):
    """Return a turbine, which widens in the direction of the flow; its tag stands in it.

    >>> turbine("T1")
    <turbine T1>
    """
    return Turbo(tag, "turbine", (0.5, 1))


def feed_screw(tag=""):
    """Return a feed screw; it takes up all the places that its name has in the layout.

    >>> feed_screw()
    <feed screw>
    """
    return Screw(tag, "feed screw")


def conveyor(tag=""):
    """Return a conveyor belt; it takes up all the places that its name has in the layout.

    >>> conveyor()
    <conveyor belt>
    """
    return Conveyor(tag, "conveyor belt")


def motor(letters="M"):
    """Return a circle with a letter: "M" a motor, "G" a generator.

    >>> motor("G")
    <generator>
    """
    return Motor(letters)


# ------------------------------------------------------------------------------------------------ how it is drawn


class Equipment(Node):
    """What has a tag beside it, and a heading: the direction of the flow."""

    room = (0.7, 0.5)
    width = height = 0.9

    def __init__(self, tag, words):
        self.tag, self.words = tag, f"{words} {tag}".strip()

    def tag_below(self, sheet):
        if self.tag:
            sheet.text(self.x, self.y0 - 0.08, self.tag, valign="top", size=10)

    def turned(self, *points):
        """Points around the centre, turned from a flow to the right into the flow's direction."""
        dx, dy = self.heading
        return [(self.x + x * dx - y * dy, self.y + x * dy + y * dx) for x, y in points]


class Instrument(Node):
    width = height = 1.0
    radius, room, inline = 0.5, (0.6, 0.4), True

    def __init__(self, letters, panel):
        self.words, self.panel = letters, panel

    def draw(self, sheet):
        letters, number = re.fullmatch(r"(\D*)(\d*)", self.words).groups()
        sheet.circle(self.x, self.y, self.radius)
        if self.panel:
            sheet.wire((self.x - 0.5, self.y), (self.x + 0.5, self.y), zorder=3)
        lift = 0.2 if self.panel or number else 0
        sheet.text(self.x, self.y + lift - 0.03, letters, size=10 if lift else 11)
        if number:
            sheet.text(self.x, self.y - 0.22, number, size=9)


class Tank(Node):
    height, room, leaves = 2.4, (0.7, 0.4), "up or down"

    def __init__(self, text, level, stirrer, heater, jacket, filled):
        self.text, self.level, self.filled = text, level, filled
        self.stirrer, self.heater, self.jacket = stirrer, heater, 0.3 if jacket else 0
        parts = [f"level {level}"] * bool(level) + ["stirrer"] * stirrer + ["heater"] * heater + ["jacket"] * jacket
        self.words = "tank" + (f" {text}" if text else "") + (f" with {', '.join(parts)}" if parts else "")
        self.width = 3.0 if stirrer else 2.4

    def inside(self):
        return self.x0 + self.jacket, self.x1 - self.jacket, self.y0 + self.jacket, self.y1

    def jacket_top(self):
        return self.y0 + 0.72 * (self.y1 - self.y0)

    def edge(self, dx, dy, x, y):
        x0, x1, _, y1 = self.inside()
        if dx and y > self.jacket_top():
            return (x1 if dx > 0 else x0), y
        return (x, y1 - 0.2) if dy > 0 else super().edge(dx, dy, x, y)

    def draw(self, sheet):
        x0, x1, y0, y1 = self.inside()
        surface = y0 + self.filled * (y1 - y0)
        if self.jacket:
            top, slant = self.jacket_top(), self.jacket
            sheet.wire((x0, top), (self.x0, top - slant), (self.x0, self.y0), (self.x1, self.y0),
                       (self.x1, top - slant), (x1, top), width=THICK)  # fmt: skip
        if self.filled:
            sheet.area([(x0, y0), (x1, y0), (x1, surface), (x0, surface)], fill=LIQUID, outline=0)
            sheet.wire((x0, surface), (x1, surface), width=0.8)
        sheet.wire((x0, y1), (x0, y0), (x1, y0), (x1, y1), width=THICK)
        middle = (x0 + x1) / 2
        if self.stirrer:
            blade = y0 + (0.5 if self.heater else 0.3) * (surface - y0)
            sheet.wire((middle, y1 + 0.3), (middle, blade))
            for side in (-0.24, 0.24):
                sheet.area([(middle, blade), (middle + side, blade + 0.1), (middle + 1.7 * side, blade),
                            (middle + side, blade - 0.1)], fill="white")  # fmt: skip
        if self.heater:
            sheet.zigzag((x0, self.levels[-1]), (x0 + 0.45 * (x1 - x0), self.levels[-1]), teeth=4, height=0.16)
        if self.level:
            at = x1 - 0.3
            sheet.wire((at, y0), (at, surface), arrow="<->", width=0.8)
            sheet.text(at - 0.12, y0 + 0.68 * (surface - y0), signal_name(self.level), halign="right")
        if self.text:
            left = 0.27 if self.stirrer else 0.43 if self.level else 0.5
            up = 0.75 if self.stirrer or self.heater else 0.3 if self.level else 0.5
            sheet.text(x0 + left * (x1 - x0), y0 + up * (surface - y0), wording(self.text))


class Vessel(Node):
    width, height, room, leaves = 1.5, 2.0, (0.6, 0.5), "up or down"

    def __init__(self, text, filled, trays, lying):
        self.text, self.filled, self.trays, self.lying = text, filled, trays, lying
        if lying:
            self.width, self.height = 2.4, 1.3
        self.words = f"vessel {text}".strip() + (f" with {trays} trays" if trays else "")

    def edge(self, dx, dy, x, y):
        """On the round ends it is further in."""
        end, across = ((self.x0, self.x1), x) if self.lying else ((self.y0, self.y1), y)
        depth = max(0, BOW - min(across - end[0], end[1] - across)) / BOW
        inward = (1 - math.sqrt(max(0, 1 - depth**2))) * (self.y1 - self.y0 if self.lying else self.x1 - self.x0) / 2
        x, y = super().edge(dx, dy, x, y)
        return (x, y - dy * inward) if self.lying else (x - dx * inward, y)

    def draw(self, sheet):
        x0, x1, y0, y1 = self.x0, self.x1, self.y0, self.y1
        outline, surface = self._outline(x0, x1, y0, y1), y0 + self.filled * (y1 - y0)
        sheet.area(outline, fill="white", outline=THICK)
        if self.filled:
            sheet.area([(x, min(y, surface)) for x, y in outline], fill=LIQUID, outline=THICK)
        for n in range(self.trays):
            y = surface + (y1 - BOW - surface) * (n + 0.5) / self.trays
            sheet.wire((x0, y), (x1, y), style=DASHES, width=0.8)
        if self.text:
            text = y1 - 0.6 * BOW if self.trays else (surface + y1) / 2 if self.filled else (y0 + y1) / 2
            sheet.text(self.x, text, self.text, size=10 if self.trays else FONT_SIZE)

    def _outline(self, x0, x1, y0, y1):
        half = (y1 - y0 if self.lying else x1 - x0) / 2
        if self.lying:
            right = [(x1 - BOW + BOW * y, self.y - half * x) for x, y in HALF_CIRCLE]
            return right + [(x0 + x1 - x, y0 + y1 - y) for x, y in right]
        top = [(self.x + half * x, y1 - BOW + BOW * y) for x, y in HALF_CIRCLE]
        return top + [(x0 + x1 - x, y0 + y1 - y) for x, y in top]


class Valve(Equipment):
    inline, radius = True, 0.42

    def __init__(self, tag, words, actuator):
        super().__init__(tag, words)
        self.actuator, self.side, self.height = actuator, None, 1.5 if actuator else 0.6

    def tap(self, dx, dy, x, y):
        self.side = (dx, dy)
        return self.x + 0.72 * dx, self.y + 0.72 * dy

    def draw(self, sheet):
        sheet.area(self.turned((-0.42, 0.26), (0.42, -0.26), (0.42, 0.26), (-0.42, -0.26)), fill="white")
        dx, dy = self.side or ((0, 1) if self.heading[0] else (1, 0))
        if self.actuator:
            foot_x, foot_y = self.x + 0.48 * dx, self.y + 0.48 * dy
            sheet.wire((self.x, self.y), (foot_x, foot_y))
            dome = [(0.26 * x, 0.24 * y) for x, y in HALF_CIRCLE]
            sheet.area([(foot_x + x * dy + y * dx, foot_y - x * dx + y * dy) for x, y in dome], fill="white")
        if self.tag:  # on the other side
            halign, valign = {1: "right", 0: "center", -1: "left"}[dx], {1: "top", 0: "center", -1: "bottom"}[dy]
            sheet.text(self.x - 0.36 * dx, self.y - 0.36 * dy, self.tag, halign, valign, size=10)


class Pump(Equipment):
    radius = 0.45

    def draw(self, sheet):
        sheet.circle(self.x, self.y, self.radius)
        self.inner(sheet)
        self.tag_below(sheet)

    def inner(self, sheet):
        tip, up, down = self.turned((0.45, 0), (-0.22, 0.38), (-0.22, -0.38))
        sheet.wire(up, tip, down, zorder=3)


class Fan(Pump):
    def edge(self, dx, dy, x, y):
        """The walls of a duct go around it."""
        return (self.x, y) if dx else super().edge(dx, dy, x, y)

    def inner(self, sheet):
        for side in (-1, 1):
            sheet.area([(self.x, self.y), (self.x - 0.12, self.y + 0.2 * side), (self.x, self.y + 0.36 * side),
                        (self.x + 0.12, self.y + 0.2 * side)], fill="black", zorder=3)  # fmt: skip


class HeatExchanger(Pump):
    def inner(self, sheet):
        bends = ((0, 0.45), (0, 0.25), (0.25, 0.12), (-0.25, -0.12), (0, -0.25), (0, -0.45))
        sheet.wire(*[(self.x + x, self.y + y) for x, y in bends], zorder=3)

    def tag_below(self, sheet):
        if self.tag:
            sheet.text(self.x - 0.4, self.y - 0.4, self.tag, halign="right", valign="top", size=10)


class Motor(Node):
    width = height = 0.9
    radius, room = 0.42, (0.3, 0.4)

    def __init__(self, letters):
        self.letters = letters
        self.words = {"M": "motor", "G": "generator"}.get(letters, letters)

    def draw(self, sheet):
        sheet.circle(self.x, self.y, self.radius)
        sheet.text(self.x, self.y - 0.02, self.letters)


class Turbo(Equipment):
    width, height = 1.1, 1.3

    def __init__(self, tag, words, ends):
        super().__init__(tag, words)
        self.ends = ends

    def edge(self, dx, dy, x, y):
        x, y = super().edge(dx, dy, x, y)
        if dy:  # on the slanted side
            part = (x - self.x0) / (self.x1 - self.x0)
            reach = self.ends[0] + (self.ends[1] - self.ends[0]) * part
            y = self.y + dy * reach * self.height / 2
        return x, y

    def draw(self, sheet):
        back, front = (end * self.height / 2 for end in self.ends)
        sheet.area([(self.x0, self.y - back), (self.x0, self.y + back), (self.x1, self.y + front),
                    (self.x1, self.y - front)], fill="white")  # fmt: skip
        if self.tag:
            sheet.text(self.x, self.y, self.tag, size=10)


class Heater(Equipment):
    width, height, room = 1.4, 2 * DUCT, (0.2, 0.5)

    def draw(self, sheet):
        for y in (self.y0, self.y1):
            sheet.wire((self.x0, y), (self.x1, y), width=THICK)
        for x in (self.x - 0.5, self.x, self.x + 0.5):
            sheet.zigzag((x, self.y0), (x, self.y1), teeth=3, height=0.15)
        self.tag_below(sheet)


class Screw(Equipment):
    width, height, room = 2.4, 0.7, (0.2, 0.5)

    def draw(self, sheet):
        sheet.area([(self.x0, self.y0), (self.x0, self.y1), (self.x1, self.y1), (self.x1, self.y0)], fill="white")
        sheet.wire((self.x0, self.y), (self.x1, self.y), width=0.8)
        turns = max(3, round((self.x1 - self.x0) / 0.45))
        pitch = (self.x1 - self.x0) / turns
        for n in range(turns):
            x = self.x0 + n * pitch
            sheet.wire((x, self.y0), (x + pitch, self.y1))
        self.tag_below(sheet)


class Conveyor(Equipment):
    width, height, room = 3.0, 0.5, (0.4, 0.5)

    def draw(self, sheet):
        r = 0.22
        for y in (self.y - r, self.y + r):
            sheet.wire((self.x0 + r, y), (self.x1 - r, y))
        for x in (self.x0 + r, self.x1 - r):
            sheet.circle(x, self.y, r)
            sheet.dot(x, self.y)
        sheet.wire((self.x - 0.5, self.y), (self.x + 0.5, self.y), arrow="->", width=0.8)
        self.tag_below(sheet)

    def edge(self, dx, dy, x, y):
        return (self.x1 if dx > 0 else self.x0, y) if dx else (x, self.y + 0.24 * dy)
