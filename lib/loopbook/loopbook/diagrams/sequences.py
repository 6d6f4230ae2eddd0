"""Sequential function charts, laid out from the data that run."""

from __future__ import annotations

import re
import textwrap
from dataclasses import dataclass, field
from typing import TYPE_CHECKING

from loopbook.diagrams.drawing import FONT_SIZE, INCHES, LINE, Drawing, text_size

if TYPE_CHECKING:
    from loopbook.figures import Picture
    from loopbook.sequence import Chart, Formula

LEAD = 0.35  # length of a line into a step, in drawing units
BAR = 0.42  # half the width of a transition's bar
DOUBLE = 0.13  # distance of double lines
OVERHANG = 0.3  # of the double line over the outermost branch
GAP = 0.55  # between branches
SMALL = FONT_SIZE - 1
PITCH = 1.25 * SMALL / 72 / INCHES  # of lines of text
WIDEST = 26  # letters in a line of a condition
TIE = "\N{NO-BREAK SPACE}"


def sequential_function_chart(chart: Chart, title: str | None = None, names: bool = False) -> Picture:
    """Draw a chart as IEC 61131-3 shows it. (Haugen, Figures 12.1 and 12.3)

    A step is a box with its actions in the box beside it, double-lined where it is the initial one. A short bar is a
    transition, with its condition. A single line begins and ends alternative branches, which have priority from left
    to right, and a double line simultaneous ones. The way back to the initial step is a line where it ends the chart;
    any other way to a step that stands elsewhere is an arrow with the name of this step.

    Arguments:
        chart: a `sequence.Chart`.
        title: written above the drawing.
        names: True writes the name of a transition before its condition, as in "T_Fill_Heat: h >= 0.9".
    Returns:
        A `Picture`, which a notebook shows as the value of a cell.
    Raises:
        ValueError: for what is no chart.

    >>> from loopbook.sequence import Chart, Transition
    >>> lamp = Chart("on", {"light": False}, {"Dark": {}, "Bright": {"light": True}}, "Dark",
    ...              [Transition("Dark", "Bright", "on"), Transition("Bright", "Dark", "NOT on")])
    >>> sequential_function_chart(lamp, title="Figure 12.1")
    <Figure 12.1: sequential function chart: from Dark (initial) to Bright if on; from Bright to Dark if NOT on; Bright: light := TRUE>
    """  # noqa: E501
    check_chart(chart)
    drawing = Drawing()
    for kind, points, extra in _Layout(chart, names).whole().marks:
        if kind == "text":
            label, halign, valign, size = extra
            drawing.text(*points[0], label, halign=halign, valign=valign, size=size)
        elif kind == "box":
            (x0, y0), (x1, y1) = points
            drawing.area([(x0, y0), (x0, y1), (x1, y1), (x1, y0)], fill="white")
        else:
            drawing.wire(*points, arrow="->" if kind == "arrow" else None, width=extra)
    return drawing.picture(title, f"sequential function chart: {in_words(chart)}")


def check_chart(chart: object) -> None:
    if not hasattr(chart, "markings"):
        raise ValueError(f"the chart is {chart!r}: expected a sequence.Chart")


def in_words(chart: Chart) -> str:
    """The transitions and actions of a chart as a sentence."""
    ways = [
        f"from {' and '.join(step + ' (initial)' * (step == chart.initial) for step in x.sources)} "
        f"to {' and '.join(x.targets)} if {condition.text}"
        for x, condition in zip(chart.transitions, chart.conditions, strict=True)
    ]
    return "; ".join([*ways, *(f"{step}: {', '.join(action_lines(chart, step))}" for step in chart.steps
                               if chart.actions[step])])  # fmt: skip


def action_lines(chart: Chart, step: str) -> list[str]:
    """The actions of a step, one line each."""
    return [f"{output} := {formula.text}" for output, formula in chart.actions[step]]


def condition_lines(condition: Formula, name: str | None = None) -> list[str]:
    """A condition in lines of a readable length, which begin with AND and OR."""
    text = f"{name}: {condition.text}" if name else condition.text
    tied = re.sub(r"(?<!:) (?!(AND|OR)\b)", TIE, text)
    return [line.replace(TIE, " ") for line in textwrap.wrap(tied, WIDEST, break_long_words=False)]


@dataclass
class _Piece:
    """A part of the drawing around the vertical line x = 0, from y = 0 downwards.

    `entries` are the places of the lines in at its top, `exit` that of its line out at the bottom. `end` is where this
    line goes, a step or a transition, with the elements that it comes from; None where nothing goes on.
    """

    left: float = 0.0
    right: float = 0.0
    height: float = 0.0
    marks: list = field(default_factory=list)
    entries: list = field(default_factory=lambda: [0.0])
    exit: float = 0.0
    end: tuple | None = None

    def shifted(self, dx, dy=0.0):
        marks = [(kind, [(x + dx, y + dy) for x, y in points], extra) for kind, points, extra in self.marks]
        entries = [x + dx for x in self.entries]
        return _Piece(self.left - dx, self.right + dx, self.height - dy, marks, entries, self.exit + dx, self.end)

    def line(self, *points, arrow=False):
        self.marks.append(("arrow" if arrow else "line", list(points), LINE))

    def text(self, x, y, label, halign="center", valign="center", size=SMALL):
        self.marks.append(("text", [(x, y)], (label, halign, valign, size)))

    def box(self, *corners):
        self.marks.append(("box", list(corners), None))

    def then(self, below):
        """This piece with another one under its line out."""
        below = below.shifted(self.exit, -self.height)
        left, right = max(self.left, below.left), max(self.right, below.right)
        return _Piece(left, right, below.height, self.marks + below.marks, self.entries, below.exit, below.end)


def _beside(pieces):
    """The pieces side by side, each where it stands: the first one's line is x = 0."""
    placed = [pieces[0]]
    for piece in pieces[1:]:
        placed.append(piece.shifted(placed[-1].right + GAP + piece.left))
    return placed


class _Layout:
    """Steps (names) and transitions (their numbers) in columns that divide and meet again."""

    def __init__(self, chart, names):
        self.chart, self.names = chart, names
        self.after = {step: [] for step in chart.steps} | {n: list(x.targets) for n, x in enumerate(chart.transitions)}
        for n, transition in enumerate(chart.transitions):
            for step in transition.sources:
                self.after[step].append(n)
        self.order, self.back = self._without_cycles()
        self.open = dict.fromkeys(self.after, 0)  # how many lines still have to meet before an element
        for one, others in self.after.items():
            for other in others:
                self.open[other] += (one, other) not in self.back
        self.placed, self.linked = set(), False

    def _without_cycles(self):
        """The elements in an order of the flow, and the connections that lead back in it."""
        forward, back, seen, order = {x: [] for x in self.after}, set(), {self.chart.initial}, []

        def reaches(one, other):
            waiting, known = [one], {one}
            for x in waiting:
                more = [y for y in forward[x] if y not in known]
                waiting += more
                known.update(more)
            return other in known

        stack = [(self.chart.initial, iter(self.after[self.chart.initial]))]
        while stack:
            element, rest = stack[-1]
            following = next(rest, None)
            if following is None:
                order.append(stack.pop()[0])
                continue
            if reaches(following, element):
                back.add((element, following))
                continue
            forward[element].append(following)
            # a convergence has its turn when all that converges has been seen
            sources = () if isinstance(following, str) else self.chart.transitions[following].sources
            if following not in seen and seen.issuperset(sources):
                seen.add(following)
                stack.append((following, iter(self.after[following])))
        position, into = {}, {x: 0 for x in forward}
        for others in forward.values():
            for other in others:
                into[other] += 1
        ready = [x for x in reversed(order) if not into[x]]
        for x in ready:
            position[x] = len(position)
            for other in forward[x]:
                into[other] -= 1
                if not into[other]:
                    ready.append(other)
        return position, back

    # ------------------------------------------------------------------------------------------------- the structure

    def whole(self):
        piece = self._column(self.chart.initial, (), trunk=True)
        if self.linked:  # the way back, along the left side
            x, bottom, margin = piece.exit, -piece.height, -piece.left - 0.5
            piece.line((x, bottom), (margin, bottom), (margin, 0), (0, 0), (0, -LEAD), arrow=True)
        while True:
            if piece.end:  # what would have met it has become arrows
                node, sources = piece.end
                piece = piece.then(self._column(node, sources))
                continue
            rest = [x for x in self.order if x not in self.placed]
            if not rest:
                return piece
            other = _beside([piece, self._column(min(rest, key=self.order.get), ())])[1]
            height = max(piece.height, other.height)
            piece = _Piece(piece.left, other.right, height, piece.marks + other.marks, exit=other.exit, end=other.end)

    def _column(self, node, sources, trunk=False):
        """An element and all that follows it, as far as nothing else must come first."""
        column = _Piece()
        while node is not None:
            self.placed.add(node)
            column = column.then(self._element(node, sources))
            following = self.after[node]
            if not following:
                break
            if trunk and following == [self.chart.initial]:
                self.linked = True
                break
            tail = self._way(node, following[0]) if len(following) == 1 else self._branches(node, following)
            column, node = column.then(tail), None
            if column.end and len(column.end[1]) >= self.open[column.end[0]]:
                (node, sources), column.end = column.end, None
        return column

    def _way(self, one, other):
        """The line from an element to the next, or an arrow with its name."""
        piece = _Piece(0.45, 0.45, end=(other, (one,)))
        if (one, other) in self.back:
            return self._arrow(piece)
        if other in self.placed:
            self.open[other] += 1
        return self._arrow_instead(piece) if other in self.placed else piece

    def _continued(self, piece):
        if piece.end and len(piece.end[1]) >= self.open[piece.end[0]]:
            (node, sources), piece.end = piece.end, None
            return piece.then(self._column(node, sources))
        return piece

    def _branches(self, node, following):
        """What divides under an element, up to where it is one line again, or none."""
        simultaneous = not isinstance(node, str)
        columns = [self._continued(self._way(node, x)) for x in following]
        while True:
            ends = [column.end[0] for column in columns if column.end]
            meeting = {x for x in ends if ends.count(x) > 1}
            if not meeting:
                break
            first = min(meeting, key=self.order.get)
            members = [n for n, column in enumerate(columns) if column.end and column.end[0] == first]
            if simultaneous:  # their order means nothing: put together what meets
                moved = [columns[n] for n in members]
                columns = [column for column in columns if column not in moved or column is moved[0]]
                columns[members[0] : members[0] + 1] = moved
                members = range(members[0], members[0] + len(moved))
            begin, end = members[0], members[-1] + 1
            for n in range(begin, end):  # a line between them would have to cross
                if n not in members and columns[n].end:
                    columns[n] = self._arrow_instead(columns[n])
            whole = self._meeting(columns[begin:end], double=not isinstance(first, str))
            if end - begin == len(columns):  # it goes on under all of them, where the caller has reached
                columns = [whole]
                break
            columns[begin:end] = [self._continued(whole)]
        still_open = [n for n, column in enumerate(columns) if column.end]
        for n in still_open[1:]:
            columns[n] = self._arrow_instead(columns[n])
        return self._division(columns, double=simultaneous)

    def _arrow_instead(self, piece):
        self.open[piece.end[0]] -= len(piece.end[1])
        return self._arrow(piece)

    # ----------------------------------------------------------------------------------------------------- the pieces

    def _element(self, node, sources):
        return self._step(node) if isinstance(node, str) else self._transition(node, sources)

    def _step(self, step):
        initial, lines = step == self.chart.initial, action_lines(self.chart, step)
        half, tall = max(0.6, text_size(step)[0] / 2 + 0.3), 0.85
        piece = _Piece(half, half, LEAD + tall)
        if not initial:
            piece.line((0, 0), (0, -LEAD))
        piece.box((-half, -LEAD), (half, -LEAD - tall))
        if initial:
            piece.box((-half + 0.09, -LEAD - 0.09), (half - 0.09, -LEAD - tall + 0.09))
        piece.text(0, -LEAD - tall / 2, step, size=FONT_SIZE)
        if lines:
            x, deep = half + 0.35, max(tall, PITCH * len(lines) + 0.3)
            wide = max(text_size(line, SMALL)[0] for line in lines) + 0.36
            piece.line((half, -LEAD - tall / 2), (x, -LEAD - tall / 2))
            piece.box((x, -LEAD), (x + wide, -LEAD - deep))
            piece.right, piece.height = x + wide, LEAD + deep
            for n, line in enumerate(lines):
                piece.text(x + 0.18, -LEAD - deep / 2 + PITCH * ((len(lines) - 1) / 2 - n), line, halign="left")
            piece.line((0, -LEAD - tall), (0, -piece.height))
        return piece

    def _transition(self, n, sources):
        transition = self.chart.transitions[n]
        name = transition.name if self.names else None
        lines = condition_lines(self.chart.conditions[n], name)
        tall = max(0.9, PITCH * len(lines) + 0.3)
        piece = _Piece(BAR, BAR, tall)
        piece.line((0, 0), (0, -tall))
        piece.marks.append(("line", [(-BAR, -tall / 2), (BAR, -tall / 2)], 2 * LINE))
        for k, line in enumerate(lines):
            piece.text(BAR + 0.15, -tall / 2 + PITCH * ((len(lines) - 1) / 2 - k), line, halign="left")
        piece.right = BAR + 0.15 + max(text_size(line, SMALL)[0] for line in lines) + 0.05
        missing = [step for step in transition.sources if step not in sources]
        return self._from_elsewhere(missing, bool(sources)).then(piece) if missing else piece

    def _from_elsewhere(self, steps, connected):
        """A convergence of steps that stand somewhere else in the chart: arrows with their names."""
        columns = [_Piece(0.45, 0.45, end=(None, ()))] if connected else []
        for step in steps:
            half = max(0.45, text_size(step, SMALL)[0] / 2)
            column = _Piece(half, half, PITCH + 0.6, end=(None, ()))
            column.text(0, -PITCH / 2, step)
            column.line((0, -PITCH), (0, -PITCH - 0.6), arrow=True)
            columns.append(column)
        return self._meeting(columns, double=True, room=0)

    def _arrow(self, piece):
        """A piece whose line out becomes an arrow with the name of where it goes."""
        node = piece.end[0]
        label = node if isinstance(node, str) else self.chart.transitions[node].name
        half = max(0.45, text_size(label, SMALL)[0] / 2)
        arrow = _Piece(half, half, 0.7 + PITCH)
        arrow.line((0, 0), (0, -0.6), arrow=True)
        arrow.text(0, -0.65 - PITCH / 2, label)
        piece.end = None
        return piece.then(arrow)

    def _division(self, columns, double):
        """Columns under one line, single or double; at most one of them goes on below."""
        columns, top = _beside(columns), 0.25 if not double else DOUBLE
        entries = [x for column in columns for x in column.entries]
        whole = _Piece(columns[0].left, columns[-1].right, top + max(column.height for column in columns) + 0.15)
        if double:
            for y in (0, -DOUBLE):
                whole.line((entries[0] - OVERHANG, y), (entries[-1] + OVERHANG, y))
        else:
            whole.line((0, 0), (0, -top))
            whole.line((entries[0], -top), (entries[-1], -top))
        for column in columns:
            whole.marks += column.shifted(0, -top).marks
            if column.end:
                whole.exit, whole.end = column.exit, column.end
                whole.line((column.exit, -top - column.height), (column.exit, -whole.height))
        return whole

    def _meeting(self, columns, double, room=0.15):
        """Columns whose open ones meet in one line, single or double."""
        columns = _beside(columns)
        deep = max(column.height for column in columns) + room
        whole = _Piece(columns[0].left, columns[-1].right, deep + DOUBLE * double)
        whole.entries = [x for column in columns for x in column.entries]
        for column in columns:
            whole.marks += column.marks
        meeting = [column for column in columns if column.end]
        for column in meeting:
            whole.line((column.exit, -column.height), (column.exit, -deep))
        for y in (-deep, -deep - DOUBLE) if double else (-deep,):
            over = OVERHANG * double
            whole.line((meeting[0].exit - over, y), (meeting[-1].exit + over, y))
        whole.exit = meeting[0].exit
        whole.end = (meeting[0].end[0], tuple(x for column in meeting for x in column.end[1]))
        return whole
