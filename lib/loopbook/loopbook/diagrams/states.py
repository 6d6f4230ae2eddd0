"""State diagrams, laid out from the chart that runs."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING

from loopbook.diagrams.drawing import FONT_SIZE, Drawing, text_size
from loopbook.diagrams.sequences import PITCH, SMALL, action_lines, check_chart, condition_lines

if TYPE_CHECKING:
    from loopbook.figures import Picture
    from loopbook.sequence import Chart

MOST_STATES = 30
PORT = 0.4  # between two arrows at the side of a state
CORNER = 0.28


def state_diagram(chart: Chart, title: str | None = None) -> Picture:
    """Draw the states that a chart can be in, and the ways between them. (Haugen, Chapter 12)

    A state is a set of steps that are active together, a single step where nothing is simultaneous. Each arrow is one
    transition with its condition; two that are cleared in the same scan are two arrows one behind the other. The
    actions stand in the states where each state is a single step.

    Arguments:
        chart: a `sequence.Chart`.
        title: written above the drawing.
    Returns:
        A `Picture`, which a notebook shows as the value of a cell.
    Raises:
        ValueError: for what is no chart, or more than 30 states.

    >>> from loopbook.sequence import Chart, Transition
    >>> lamp = Chart("on", {"light": False}, {"Dark": {}, "Bright": {"light": True}}, "Dark",
    ...              [Transition("Dark", "Bright", "on"), Transition("Bright", "Dark", "NOT on")])
    >>> state_diagram(lamp)
    <state diagram, beginning in Dark: from Dark to Bright if on; from Bright to Dark if NOT on>
    """
    check_chart(chart)
    if len(chart.markings) > MOST_STATES:
        raise ValueError(f"the chart has {len(chart.markings)} states: expected at most {MOST_STATES} for a drawing")
    states = _in_order_of_the_flow(chart)
    arrows = {}  # the labels between two states
    for n, state in enumerate(states):
        for transition, following in chart.markings[state]:
            label = condition_lines(chart.conditions[chart.transitions.index(transition)])
            arrows.setdefault((n, states.index(following)), []).extend(label)
    names = [" + ".join(step for step in chart.steps if step in state) for state in states]
    single = all(len(state) == 1 for state in states)
    actions = [action_lines(chart, *state) if single else [] for state in states]
    drawing = Drawing()
    _StateGraph(drawing, names, actions, arrows).draw()
    ways = "; ".join(f"from {names[i]} to {names[j]} if {' '.join(text)}" for (i, j), text in arrows.items())
    return drawing.picture(title, f"state diagram, beginning in {names[0]}: {ways}")


def _in_order_of_the_flow(chart):
    """The states, each after one that leads to it, and the first way of each goes straight on where it can."""
    order, waiting = [], [next(iter(chart.markings))]
    while waiting:
        state = waiting.pop()
        if state not in order:
            order.append(state)
            waiting += [following for _, following in reversed(chart.markings[state])]
    return order


class _StateGraph:
    """States in one column; what does not go to the next one runs in lanes, forward at the right, back at the left."""

    def __init__(self, drawing, names, actions, arrows):
        self.drawing, self.names, self.actions, self.arrows = drawing, names, actions, arrows
        self.sides = {1: [], -1: []}
        for one, other in arrows:
            if other != one + 1:
                self.sides[1 if other > one else -1].append((one, other))
        wide = [text_size(name, FONT_SIZE)[0] for name in names]
        wide += [text_size(line, SMALL)[0] for lines in actions for line in lines]
        self.half = max(0.7, max(wide) / 2 + 0.3)
        self._rows()
        self.lanes = {side: self._lanes(side) for side in self.sides}

    def _rows(self):
        """The heights of the states and of what is between them."""
        self.tops, self.bottoms, y = [], [], 0.0
        for n, lines in enumerate(self.actions):
            ends = [sum((one == n) + (other == n) for one, other in ways) for ways in self.sides.values()]
            tall = max(0.9 + PITCH * len(lines) + 0.1 * bool(lines), PORT * (max(ends) + 1))
            self.tops.append(y)
            self.bottoms.append(y - tall)
            labels = [len(text) for (one, other), text in self.arrows.items() if n in (one, one - 1)]
            y -= tall + max(1.0, PITCH * max(labels, default=0) + 0.5)

    def _lanes(self, side):
        """The distance of each arrow's upright line from the middle."""
        straight = [
            text_size(line, SMALL)[0]
            for (one, other), text in self.arrows.items()
            if other == one + 1 and side > 0
            for line in text
        ]
        x, lanes, found = max(self.half, 0.15 + max(straight, default=0)) + 0.4, [], {}
        ways = sorted((way for way in self.sides[side] if way[0] != way[1]), key=lambda way: abs(way[0] - way[1]))
        for way in ways:
            low, high = sorted(way)
            free = [lane for lane in lanes if all(high < a or low > b for a, b in map(sorted, lane))]
            (free[0] if free else lanes).append(way if free else [way])
        loops = [way for way in self.sides[side] if way[0] == way[1]]
        for lane in [*lanes, loops] if loops else lanes:  # the loops outside, because their labels stand in the rows
            found |= dict.fromkeys(lane, side * x)
            x += 0.4 + max(text_size(line, SMALL)[0] for way in lane for line in self.arrows[way])
        return found

    def draw(self):
        drawing, half = self.drawing, self.half
        for name, lines, top, bottom in zip(self.names, self.actions, self.tops, self.bottoms, strict=True):
            drawing.area(_rounded(half, top, bottom), fill="white")
            middle = (top + bottom) / 2 + PITCH * len(lines) / 2
            drawing.text(0, middle, name)
            if lines:
                drawing.wire((-half, middle - 0.36), (half, middle - 0.36), width=0.8)
            for k, line in enumerate(lines):
                drawing.text(0.2 - half, middle - 0.4 - PITCH * (k + 0.6), line, halign="left", size=SMALL)
        drawing.circle(0, self.tops[0] + 0.8, 0.12, fill="black")
        drawing.wire((0, self.tops[0] + 0.8), (0, self.tops[0]), arrow="->")
        for (one, other), text in self.arrows.items():
            if other == one + 1:
                begin, end = self.bottoms[one], self.tops[other]
                drawing.wire((0, begin), (0, end), arrow="->")
                self._label(0.15, (begin + end) / 2, text, "left")
        for side in self.sides:
            self._in_lanes(side)

    def _in_lanes(self, side):
        # what goes up or comes from above has the upper places at a side, in an order in which the lanes do not cross
        ends = {n: [] for n in range(len(self.names))}
        for way in self.sides[side]:
            for n, where in ((way[0], "out"), (way[1], "in")):
                away = way[1] + way[0] - 2 * n
                reach = abs(self.lanes[side][way]) * (1 if away < 0 else -1)
                ends[n].append((away > 0, reach, where == "in", way, where))
        places = {}
        for n, group in ends.items():
            room = (self.tops[n] - self.bottoms[n]) / (len(group) + 1)
            for k, (*_, way, where) in enumerate(sorted(group)):
                places[way, where] = self.tops[n] - room * (k + 1)
        for way in self.sides[side]:
            (one, other), x = way, self.lanes[side][way]
            begin, end = places[way, "out"], places[way, "in"]
            self.drawing.wire((side * self.half, begin), (x, begin), (x, end), (side * self.half, end), arrow="->")
            gap = one if side > 0 else one - 1  # beside the upright line, where no arrow leaves or enters a state
            y = (begin + end) / 2 if one == other else (self.bottoms[gap] + self.tops[gap + 1]) / 2
            self._label(x + side * 0.12, y, self.arrows[way], "left" if side > 0 else "right")

    def _label(self, x, y, lines, halign):
        for k, line in enumerate(lines):
            self.drawing.text(x, y + PITCH * ((len(lines) - 1) / 2 - k), line, halign=halign, size=SMALL)


def _rounded(half, top, bottom):
    """The outline of a state."""
    corners = [(half, top, 0), (-half, top, 1), (-half, bottom, 2), (half, bottom, 3)]
    points = []
    for x, y, quarter in corners:
        x, y = x - math.copysign(CORNER, x), y + (CORNER if quarter > 1 else -CORNER)
        for k in range(7):
            angle = math.pi / 2 * (quarter + k / 6)
            points.append((x + CORNER * math.cos(angle), y + CORNER * math.sin(angle)))
    return points
