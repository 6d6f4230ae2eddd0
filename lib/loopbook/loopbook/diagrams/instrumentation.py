r"""Diagrams of plants with their pipes, instruments and signals (P&I diagrams), placed on a grid as in `grid_diagram`.

A name of two to four capitals, with a number behind it or without, is the tag of an instrument (LT, TC1); what else is
to be drawn stands in `equipment`; every other name is a text, such as that of a stream.
"""

from __future__ import annotations

import copy
import re
from collections.abc import Mapping
from typing import TYPE_CHECKING

from loopbook.diagrams.blocks import block
from loopbook.diagrams.conductors import SIGNALS, draw_duct, draw_pipe, draw_shaft, draw_signal
from loopbook.diagrams.drawing import Drawing
from loopbook.diagrams.equipment import Equipment
from loopbook.diagrams.grid import BlockNode, Grid, Junction, Label, Node, Point, connections, direction, neighbours
from loopbook.diagrams.instrument_symbols import Instrument, instrument
from plainmath.validation import one_of

if TYPE_CHECKING:
    from loopbook.figures import Picture

TAG = re.compile(r"[A-Z]{2,4}(\d+[A-Z]?)?")


def instrumentation_diagram(
    layout: str,
    pipes: str = "",
    signals: str = "",
    equipment: Mapping[str, str | Node] | None = None,
    names: Mapping[str, str] | None = None,
    ducts: str = "",
    shafts: str = "",
    title: str | None = None,
    lines: Mapping[str, str] | None = None,
) -> Picture:
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
        title: written above the diagram.
        lines: ``{kind: paths}`` for signals whose lines say of what kind they are: "pneumatic", "hydraulic",
            "capillary", "guided wave", "radio", "data link", "measuring line"; those in `signals` are "electrical".
    Returns:
        A `Picture`, which a notebook shows as the value of a cell.
    Raises:
        ValueError: for a layout with rows of different length, a name that fills no rectangle, a path to a name that is
            not in the layout, a line that would run through other equipment, equipment or lines of no known kind, or a
            tag that the table of letters (`loopbook.instruments`) does not explain.

    >>> from loopbook.diagrams import pump, tank
    >>> layout = '''
    ...     q_in  1     .   h_SP  .
    ...     .     tank  LT  LC    .
    ...     .     2     .   pump  q_out'''
    >>> parts = {"tank": tank(), "pump": pump()}
    >>> instrumentation_diagram(layout, "q_in 1 tank 2 pump q_out", "tank LT LC pump, h_SP LC", parts)
    <P&I diagram: pipes: q_in → tank → pump → q_out; signals: tank → LT → LC → pump; h_SP → LC>
    """
    plan = _Plan(pipes, signals, equipment or {}, names or {}, ducts, shafts, lines or {})
    # The places are settled twice: first to learn from which sides each part is met, then with the room that it takes.
    grid = Grid(layout, lambda name: plan.node(name, {}))
    grid.expect([*plan.equipment, *plan.names, *plan.entering, *plan.leaving])
    meetings = plan.meetings(grid)
    grid = Grid(layout, lambda name: plan.node(name, meetings))
    drawing = Drawing()
    plan.draw(drawing, grid)
    words = "; ".join(f"{kind}: {grid.words(text)}" for kind, text in plan.kinds.items() if text.strip())
    return drawing.picture(title, f"P&I diagram: {words}")


class _Plan:
    """What is joined to what, and what each name stands for."""

    def __init__(self, pipes, signals, equipment, names, ducts, shafts, lines):
        self.equipment, self.names = {name: _part(name, what) for name, what in equipment.items()}, names
        of_kinds = {one_of("the kind of line", kind, SIGNALS): text for kind, text in lines.items()}
        self.kinds = {"pipes": pipes, "ducts": ducts, "shafts": shafts, "signals": signals, **of_kinds}
        self.edges = {kind: connections(text) for kind, text in self.kinds.items()}
        self.entering, self.leaving = neighbours([edge for edges in self.edges.values() for edge in edges])
        for start, end in (edge for kind in ("signals", *of_kinds) for edge in self.edges[kind]):
            if self._function(start).endswith("C") and self._function(end).endswith("T"):
                raise ValueError(f"a signal goes from {start} to {end}: expected one from transmitter to controller")
        self.told = neighbours([edge for kind in ("signals", *of_kinds) for edge in self.edges[kind]])[0]

    def _function(self, name):
        """The letters of an instrument; none for anything else."""
        own = name in self.names or name in self.equipment or not TAG.fullmatch(name)
        return "" if own else re.match("[A-Z]+", name)[0]

    def node(self, name, meetings):
        """What stands in the place of a name, with what it learns from its neighbours."""
        if name in self.equipment:
            node = copy.copy(self.equipment[name])
        elif name.isdigit():
            node = Junction() if len(self.told.get(name, ())) > 1 else Point()
        elif name not in self.names and TAG.fullmatch(name):
            node = _instrument(name)
        else:
            through = name in self.entering and name in self.leaving
            node = Label(self.names.get(name, name), through=through)
        if isinstance(node, Equipment):
            node.in_duct, node.on_shaft = (
                any(name in edge for edge in self.edges[kind]) for kind in ("ducts", "shafts")
            )
            node.met(*meetings.get(name, ((), (), node.heading)))
        return node

    def meetings(self, grid):
        """For each name the sides at which pipes and at which signals meet it, and its heading, the way of the flow."""
        sides, taps, headings = {}, {}, {}
        for kind, edges in self.edges.items():
            of_material = kind in ("pipes", "ducts", "shafts")
            for start, end in edges:
                points = grid.route(start, end, at="edge" if of_material else "tap")
                ways = {start: direction(*points[:2]), end: direction(*points[-2:])}
                if kind in ("pipes", "ducts"):
                    headings |= ways
                found = sides if of_material else taps
                for name, (dx, dy) in ways.items():
                    found.setdefault(name, []).append((dx, dy) if name == start else (-dx, -dy))
        return {
            name: (tuple(dict.fromkeys(sides.get(name, ()))), tuple(dict.fromkeys(taps.get(name, ()))),
                   headings.get(name, (1, 0)))
            for name in {**sides, **taps}
        }  # fmt: skip

    def draw(self, drawing, grid):
        for kind, draw in (("pipes", draw_pipe), ("ducts", draw_duct), ("shafts", draw_shaft)):
            for start, end in self.edges[kind]:
                node = grid[end]
                arrow = isinstance(node, Label) if kind == "ducts" else node.arrow_in and not node.inline
                draw(drawing, grid.route(start, end), arrow)
        for kind, edges in self.edges.items():
            if kind not in ("pipes", "ducts", "shafts"):
                for (start, end), sign in edges.items():
                    self._signal(drawing, grid, start, end, sign, "electrical" if kind == "signals" else kind)
        for node in grid.nodes.values():
            node.draw(drawing)

    def _signal(self, drawing, grid, start, end, sign, kind):
        points, measures = grid.route(start, end, at="tap"), isinstance(grid[start], (Instrument, Label, BlockNode))
        if kind == "electrical" and start not in self.told and not measures:
            kind = "measuring line"
        draw_signal(drawing, points, kind, grid[end].arrow_in)
        if isinstance(grid[end], Junction):
            drawing.sign(grid[end].x, grid[end].y, direction(points[-1], points[-2]), sign or "+")


def _part(name, what):
    part = BlockNode(block(what)) if isinstance(what, str) else what
    if not isinstance(part, Node):
        raise ValueError(f"{name} is {what!r}, which is not equipment of a plant")
    return part


def _instrument(name):
    try:
        return instrument(name)
    except ValueError as error:
        raise ValueError(f"{error}; where {name} is not an instrument, give its label in names") from None
