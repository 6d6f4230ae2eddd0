"""Pipes, ducts, shafts and the lines of signals, each with the marks that tell its kind."""

from __future__ import annotations

import math
from collections.abc import Sequence
from itertools import pairwise
from typing import TYPE_CHECKING

from loopbook.diagrams.drawing import LINE
from loopbook.diagrams.equipment import THICK, THIN, Equipment
from loopbook.diagrams.grid import direction
from plainmath.validation import one_of

if TYPE_CHECKING:
    from loopbook.diagrams.drawing import XY, Drawing

DASHES = "--"
DUCT = 0.5  # half the width of an air duct
SHAFT = 0.05  # the same of a shaft
HEAD = 0.3  # the piece of a line that ends in an arrow head
STEP = 0.9  # from mark to mark
WAVE = [(0.02 * n - 0.3, 0.13 * math.sin(math.pi * n / 7.5)) for n in range(31)]

#: What is drawn across a signal's line, in a frame whose first axis is the line.
MARKS = {
    "electrical": (),
    "pneumatic": (((-0.13, -0.13), (-0.01, 0.13)), ((0.01, -0.13), (0.13, 0.13))),
    "hydraulic": (((0, 0.16), (0, -0.16), (0.14, -0.16)),),
    "capillary": (((-0.11, -0.11), (0.11, 0.11)), ((-0.11, 0.11), (0.11, -0.11))),
    "guided wave": (WAVE,),
    "radio": (WAVE,),
    "data link": (),
    "measuring line": (),
}
SIGNALS = tuple(MARKS)
CONDUCTORS = ("pipe", "crossing", "junction", "duct", "shaft", "measuring line",
              *(kind for kind in SIGNALS if kind != "measuring line"))  # fmt: skip


def conductor(kind: str = "pipe") -> Conductor:
    """Return a piece of a pipe or of a signal's line, for a table of symbols or a legend.

    Arguments:
        kind: "pipe", "crossing" (of pipes that are not joined), "junction" (of pipes that are), "duct", "shaft",
            "measuring line" (from the process to an instrument), "electrical", "pneumatic", "hydraulic", "capillary",
            "guided wave", "radio" or "data link".
    Raises:
        ValueError: for another kind.

    >>> conductor("pneumatic")
    <pneumatic>
    """
    return Conductor(one_of("the conductor", kind, CONDUCTORS))


def draw_pipe(drawing: Drawing, points: Sequence[XY], arrow: bool = False) -> None:
    drawing.wire(*points, arrow="->" if arrow else None, width=THICK)


def draw_duct(drawing: Drawing, points: Sequence[XY], arrow: bool = False) -> None:
    (x0, y), (x1, _) = points[0], points[-1]
    for side in (-DUCT, DUCT):
        drawing.wire((x0, y + side), (x1, y + side), width=THICK)
    if arrow:
        drawing.wire((x1 - 0.6, y), (x1, y), arrow="->")


def draw_shaft(drawing: Drawing, points: Sequence[XY], arrow: bool = False) -> None:
    for start, end in pairwise(points):
        dx, dy = (0, SHAFT) if start[1] == end[1] else (SHAFT, 0)
        for side in (-1, 1):
            drawing.wire(*[(x + side * dx, y + side * dy) for x, y in (start, end)])


def draw_signal(drawing: Drawing, points: Sequence[XY], kind: str, arrow: bool = False) -> None:
    """A signal's line through the points, with its marks and, on a piece of its own, its arrow head."""
    if kind == "measuring line":
        drawing.wire(*points, width=THIN)
        return
    if kind != "radio":  # which has no line
        dashed = kind == "electrical"
        drawing.wire(*points, style=DASHES if dashed else "-", width=LINE if dashed else THIN)
    pieces = list(pairwise(points))
    for n, (start, end) in enumerate(pieces):
        _mark(drawing, start, end, kind, HEAD if arrow and n == len(pieces) - 1 else 0)
    if arrow:  # on a piece of its own, as a dash may not reach it
        (x, y), (dx, dy) = points[-1], direction(*points[-2:])
        drawing.wire((x - HEAD * dx, y - HEAD * dy), (x, y), arrow="->")


def _mark(drawing, start, end, kind, spared):
    """The marks of one straight piece, evenly along it but for what the arrow head takes up."""
    (x0, y0), (dx, dy) = start, direction(start, end)
    length = abs(end[0] - x0) + abs(end[1] - y0) - spared
    if length < 0.25:  # no room
        return
    count = max(1, round(length / STEP))
    for n in range(count):
        way = length * (n + 0.5) / count
        x, y = x0 + way * dx, y0 + way * dy
        if kind == "data link":
            drawing.circle(x, y, 0.08)
        for mark in MARKS[kind]:
            drawing.wire(*[(x + a * dx - b * dy, y + a * dy + b * dx) for a, b in mark], width=THIN)


class Conductor(Equipment):
    width, height, openings = 2.7, 0.6, ()

    def __init__(self, kind: str):
        super().__init__("", kind)
        self.kind = kind
        if kind in ("crossing", "junction", "duct"):
            self.height = 1.1

    def draw(self, drawing: Drawing) -> None:
        line, upright = [(self.x0, self.y), (self.x1, self.y)], [(self.x, self.y0), (self.x, self.y1)]
        match self.kind:
            case "pipe":
                draw_pipe(drawing, line, arrow=True)
            case "crossing":
                draw_pipe(drawing, line)
                draw_pipe(drawing, upright)
            case "junction":
                draw_pipe(drawing, line)
                draw_pipe(drawing, upright)
                drawing.dot(self.x, self.y)
            case "duct":
                draw_duct(drawing, line, arrow=True)
            case "shaft":
                draw_shaft(drawing, line)
            case _:
                draw_signal(drawing, line, self.kind)
