"""Diagrams with any branches: what stands where is a table of names, and the wires are lists of the names they meet.

The table is the diagram in miniature. A name that fills several places next to one another stands in all of them, a
number is a point without a name, and a dot is an empty place. Columns and rows are as wide and as high as they must be.
"""

from __future__ import annotations

import copy
import re
from collections.abc import Callable, Iterable, Mapping
from itertools import pairwise
from typing import TYPE_CHECKING, TypeAlias

from loopbook.diagrams.blocks import _Block, _part, block
from loopbook.diagrams.drawing import RADIUS, Drawing, signal_name, text_size

if TYPE_CHECKING:
    from loopbook.diagrams.drawing import XY, Way
    from loopbook.figures import Picture
    from loopbook.types import Number


def grid_diagram(
    layout: str,
    wires: str,
    blocks: Mapping[str, str | Number | _Block] | None = None,
    names: Mapping[str, str] | None = None,
    title: str | None = None,
) -> Picture:
    r"""Draw a block diagram whose blocks and signals are placed on a grid.

    Arguments:
        layout: a text with one line a row, in it the names of what stands there, with blanks between them; "." for an
            empty place, a number for a corner or branch point, the same name in neighbouring places for a large block.
        wires: a text with the paths of the signals, a comma or a new line between them; each path is the names that it
            meets. A "-" or "+" before a name is the sign with which the path enters the summing junction.
        blocks: ``{name: block}`` for the names that are blocks; each a label as `block` takes it, a SymPy expression or
            one of the elementary blocks.
        names: ``{name: label}`` for signals that are to be written otherwise than their name in the layout.
        title: written above the diagram.
    Returns:
        A `Picture`, which a notebook shows as the value of a cell.
    Raises:
        ValueError: for a layout with rows of different length, a name that fills no rectangle, a path to a name that is
            not in the layout, or a wire that would run through a block.

    Where two paths end or one ends with a sign is a summing junction; where several begin is a branch point; any other
    name is written above the wire. A wire with a bend leaves a point up or down and anything else sideways.

    >>> layout = '''
    ...     .     .  d  .  .
    ...     y_SP  e  P  1  y
    ...     .     2  .  3  .'''
    >>> grid_diagram(layout, "y_SP e P 1 y, d P, 1 3 2 - e", blocks={"P": "Process"})
    <block diagram: y_SP → + e → [Process] → point 1 → y; d → [Process]; point 1 → - e>
    """
    blocks = {name: block(part) if isinstance(part, str) else _part(part) for name, part in (blocks or {}).items()}
    edges = connections(wires)
    entering, leaving = neighbours(edges)
    signed = {end for (_, end), sign in edges.items() if sign}

    def node(name):
        if name in blocks:
            return BlockNode(blocks[name])
        if name in signed or len(entering.get(name, ())) > 1:
            return Junction()
        if name.isdigit():
            return Point(dot=len(leaving.get(name, ())) > 1)
        return Label((names or {}).get(name, name), through=name in entering and name in leaving)

    grid = Grid(layout, node)
    grid.expect([*blocks, *(names or {}), *entering, *leaving])
    drawing = Drawing()
    for (start, end), sign in edges.items():
        points = grid.route(start, end)
        drawing.wire(*points, arrow="->" if grid[end].arrow_in else None)
        if isinstance(grid[end], Junction):
            drawing.sign(grid[end].x, grid[end].y, direction(points[-1], points[-2]), sign or "+")
    for node in grid.nodes.values():
        node.draw(drawing)
    return drawing.picture(title, f"block diagram: {grid.words(wires)}")


def direction(here: XY, there: XY) -> Way:
    """Which way a wire goes from one of its points to the next, as (dx, dy) of -1, 0 and 1."""
    return tuple(int(b > a + 1e-9) - int(b < a - 1e-9) for a, b in zip(here, there, strict=True))


def read_paths(text: str) -> list[list[tuple[str, str]]]:
    """The paths of a text, each a list of (name, sign with which the path enters it)."""
    if not isinstance(text, str):
        raise ValueError(f"paths are one text, as in 'a b c, d b', not {text!r}")
    found = []
    for path in re.split(r"[,\n]", text):
        steps, sign = [], ""
        for word in path.split():
            if word in ("+", "-"):
                sign = word
            else:
                steps.append((word, sign))
                sign = ""
        if len(steps) == 1:
            raise ValueError(f"a path meets two names or more, not only {steps[0][0]}")
        if steps:
            found.append(steps)
    return found


def connections(text: str) -> Edges:
    """The pieces of the paths in a text, from one name to the next: ``{(start, end): sign}``."""
    edges = {}
    for steps in read_paths(text):
        for (start, _), (end, sign) in pairwise(steps):
            edges[start, end] = edges.get((start, end)) or sign
    return edges


def neighbours(edges: Iterable[tuple[str, str]]) -> tuple[dict[str, list[str]], dict[str, list[str]]]:
    """What enters and what leaves each name: two dictionaries of lists."""
    entering, leaving = {}, {}
    for start, end in edges:
        entering.setdefault(end, []).append(start)
        leaving.setdefault(start, []).append(end)
    return entering, leaving


# ------------------------------------------------------------------------------------------------- what a grid holds
# A node knows its size and, once it is placed, its centre and corners; `edge` is where a wire on the line through
# (x, y) that goes away in the direction (dx, dy) leaves it.


#: The pieces of paths, from one name to the next, each with its sign, which may be empty.
Edges: TypeAlias = "dict[tuple[str, str], str]"


class Node:
    width: float = 0
    height: float = 0
    radius: float | None = None  # of what is round, or is met at its middle from all sides
    room: tuple[float, float] = (0.3, 0.3)  # what is left free around it, both sides together
    arrow_in, inline, words = True, False, ""
    heading: Way = (1, 0)
    levels: list[float]  # of the rows that it takes up, as far down as the layout goes
    leaves = "sideways"

    def place(self, x: float, y: float, width: float, height: float) -> None:
        """Stand in the middle; what fills several places takes up all of their room."""
        self.x, self.y = x, y
        self.x0, self.x1, self.y0, self.y1 = x - width / 2, x + width / 2, y - height / 2, y + height / 2

    def edge(self, dx: int, dy: int, x: float, y: float) -> XY:
        if self.radius:
            return self.x + dx * self.radius, self.y + dy * self.radius
        return (self.x1 if dx > 0 else self.x0, y) if dx else (x, self.y1 if dy > 0 else self.y0)

    def __repr__(self) -> str:
        return f"<{self.words}>"

    def tap(self, dx: int, dy: int, x: float, y: float) -> XY:
        """The same for a signal's line."""
        return self.edge(dx, dy, x, y)

    def draw(self, drawing: Drawing) -> None:
        pass


class Point(Node):
    """A corner of a wire or, with a dot, a branch point."""

    arrow_in, leaves = False, "up or down"

    def __init__(self, dot: bool = False):
        self.dot = dot

    def draw(self, drawing: Drawing) -> None:
        if self.dot:
            drawing.dot(self.x, self.y)


class Junction(Node):
    width = height = 2 * RADIUS
    radius = RADIUS
    room = (1.1, 0.9)

    def draw(self, drawing: Drawing) -> None:
        drawing.circle(self.x, self.y, RADIUS)


class Label(Node):
    """A signal's name: above its wire, beside a wire that goes up or down, or at the end of that."""

    def __init__(self, name: str, through: bool = False):
        self.words, self.label, self.through = name, signal_name(name), through
        self.width, self.height = text_size(self.label)
        self.room, self.arrow_in = (0.5 if through else 0.6, 0.6), not through
        self.sideways = self.upright = False

    def edge(self, dx: int, dy: int, x: float, y: float) -> XY:
        self.sideways, self.upright = self.sideways or bool(dx), self.upright or bool(dy)
        if self.through:
            return self.x, self.y
        return (x - dx * (self.width / 2 + 0.25), y) if dx else (x, y + dy * (self.height / 2 + 0.1))

    def draw(self, drawing: Drawing) -> None:
        if self.sideways:
            drawing.text(self.x, self.y + 0.13, self.label, valign="bottom")
        elif self.upright and self.through:
            drawing.text(self.x + 0.15, self.y, self.label, halign="left")
        else:
            drawing.text(self.x, self.y, self.label)


class BlockNode(Node):
    room = (0.8, 0.5)

    def __init__(self, part: _Block):
        if not isinstance(part, _Block):
            raise ValueError(f"a grid takes single blocks, not {part}")
        self.part, self.words = copy.copy(part), str(part)
        self.width, self.height = part.width, 2 * max(part.above, part.below)

    def place(self, x: float, y: float, width: float, height: float) -> None:
        self.part.width = width
        if len(self.levels) > 1:
            self.part.half = height / 2
            self.part.levels = [level - y for level in self.levels]
        super().place(x, y, width, 2 * self.part.half)

    def draw(self, drawing: Drawing) -> None:
        self.part.draw(drawing, self.x0, self.y)


class Grid:
    """The names of a layout, each with what stands there; `node` makes that from the name."""

    def __init__(self, layout: str, node: Callable[[str], Node]):
        if not isinstance(layout, str):
            raise ValueError(f"a layout is one text with a line for each row, not {layout!r}")
        rows = [line.split() for line in layout.strip().splitlines()]
        if not rows:
            raise ValueError("the layout is empty")
        for n, row in enumerate(rows, 1):
            if len(row) != len(rows[0]):
                raise ValueError(f"row {n} of the layout has {len(row)} places, but row 1 has {len(rows[0])}")
        cells = {}
        for y, row in enumerate(rows):
            for x, name in enumerate(row):
                if name != ".":
                    cells.setdefault(name, []).append((x, y))
        self.nodes, self.spans = {name: node(name) for name in cells}, {}
        for name, places in cells.items():
            across, down = ({place[axis] for place in places} for axis in (0, 1))
            left, right, top, bottom = min(across), max(across), min(down), max(down)
            if len(places) != (right - left + 1) * (bottom - top + 1):
                raise ValueError(f"{name} must fill a rectangle of the layout, in places next to one another")
            self.spans[name] = (left, right), (top, bottom)
        xs, ys = self._lines(0, len(rows[0])), self._lines(1, len(rows))
        for name, ((left, right), (top, bottom)) in self.spans.items():
            node = self.nodes[name]
            width, height = xs[right + 1] - xs[left], ys[bottom + 1] - ys[top]
            node.levels = [-(ys[n] + ys[n + 1]) / 2 for n in range(top, bottom + 1)]
            node.place(
                xs[left] + width / 2,
                -ys[top] - height / 2,
                node.width if left == right else width - node.room[0],
                node.height if top == bottom else height - node.room[1],
            )

    def __getitem__(self, name: str) -> Node:
        return self.nodes[name]

    def words(self, text: str) -> str:
        """The paths of a text in words; a corner is not a part of them, a branch point is."""

        def word(name, sign):
            if isinstance(self[name], Junction):
                return f"{sign or '+'} {name}"
            return f"point {name}" if isinstance(self[name], Point) else self[name].words

        corners = {name for name, node in self.nodes.items() if isinstance(node, Point) and not node.dot}
        told = [[word(*step) for step in steps if step[0] not in corners] for steps in read_paths(text)]
        return "; ".join(" → ".join(steps) for steps in told)

    def expect(self, names: Iterable[str]) -> None:
        for name in names:
            if name not in self.nodes:
                raise ValueError(f"{name} is not in the layout, which has {', '.join(self.nodes)}")

    def _lines(self, axis, count):
        """Where the columns or the rows begin: each as wide as it must be, the narrow ones settled first."""
        sizes = [0.4] * count
        for name in sorted(self.nodes, key=lambda name: self.spans[name][axis][1] - self.spans[name][axis][0]):
            node, (first, last) = self.nodes[name], self.spans[name][axis]
            need = (node.width, node.height)[axis] + node.room[axis]
            sizes[first : last + 1] = _filled(sizes[first : last + 1], need)
        return [sum(sizes[:n]) for n in range(count + 1)]

    def route(self, start: str, end: str, at: str = "edge") -> list[XY]:
        """The points of a wire between the rims of two nodes; it may not run through a third."""
        points = self._way(self.nodes[start], self.nodes[end], at)
        for name, node in self.nodes.items():
            if name in (start, end) or isinstance(node, (Point, Label)):
                continue
            for (x0, y0), (x1, y1) in pairwise(points):
                if max(x0, x1) > node.x0 and min(x0, x1) < node.x1 and max(y0, y1) > node.y0 and min(y0, y1) < node.y1:
                    raise ValueError(
                        f"the way from {start} to {end} runs through {name}: lead it around over a number in the layout"
                    )
        return points

    @staticmethod
    def _way(a, b, at):
        """The points of a wire: straight if it can be, else with a bend."""
        leave, arrive = getattr(a, at), getattr(b, at)
        across = b.x0 > a.x1 - 1e-6 or a.x0 > b.x1 - 1e-6
        level = min(a, b, key=lambda node: node.y1 - node.y0).y
        if across and all(node.y0 - 1e-6 <= level <= node.y1 + 1e-6 for node in (a, b)):
            dx = 1 if b.x > a.x else -1
            return [leave(dx, 0, a.x, level), arrive(-dx, 0, b.x, level)]
        upright = min(a, b, key=lambda node: node.x1 - node.x0).x
        if not across and all(node.x0 - 1e-6 <= upright <= node.x1 + 1e-6 for node in (a, b)):
            dy = 1 if b.y > a.y else -1
            return [leave(0, dy, upright, a.y), arrive(0, -dy, upright, b.y)]
        dx, dy = (1 if b.x > a.x else -1), (1 if b.y > a.y else -1)
        if a.leaves == "sideways":
            return [leave(dx, 0, a.x, a.y), (b.x, a.y), arrive(0, -dy, b.x, b.y)]
        return [leave(0, dy, a.x, a.y), (a.x, b.y), arrive(-dx, 0, b.x, b.y)]


def _filled(sizes, need):
    """The sizes, with the smallest of them grown to one level, so that together they are what is needed."""
    ranked = sorted(sizes)
    for n in range(len(sizes), 0, -1):
        level = (need - sum(ranked[n:])) / n
        if level >= ranked[n - 1]:
            return [max(size, level) for size in sizes]
    return sizes
