"""The layout of a P&I diagram that nobody has laid out: a process in one row, its instruments above it.

Each instrument has a column of its own, or is above the only one that it hears, and each controller has a row of
its own. So no line has to run through an instrument: it goes up or along in the row and column of the two that it
joins.
"""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from typing import TYPE_CHECKING

from loopbook.diagrams import control_valve, instrumentation_diagram, vessel
from loopbook.instruments import decode

if TYPE_CHECKING:
    from loopbook.exercises.connections import Connection
    from loopbook.figures import Picture


def drawn(given: Iterable[Connection], places: Mapping[str, str], title: str | None = None) -> Picture:
    """Draw connections as a P&I diagram.

    Arguments:
        given: the connections.
        places: the parts of the process in the order of the flow, ``{name: "pipe" or "vessel"}``.
        title: written above it.
    """
    return _Layout(list(given), places).picture(title)


class _Layout:
    def __init__(self, given, places):
        self.places, self.points = places, 0
        self.located = {}  # tag: its place
        self.signals = []
        for one in given:
            ends = [name for name in (one.start, one.end) if name in places]
            if ends:
                self.located.setdefault(one.end if ends[0] == one.start else one.start, ends[0])
            else:
                self.signals.append(one)
        tags = [name for one in given for name in (one.start, one.end) if name not in places]
        self.tags = list(dict.fromkeys(tags))
        self.valves = [tag for tag in self.tags if decode(tag).functions[-1] == "valve"]
        self.columns, self.rows = {}, {}
        self.cells = {}  # (row, column): name; row 0 is the process, 1 the transmitters, from 2 on the controllers
        self._process()
        self._controllers()

    def _point(self):
        self.points += 1
        return str(self.points)

    def _hears(self, tag):
        return [one.start for one in self.signals if one.end == tag]

    def _tells(self, tag):
        return [one.end for one in self.signals if one.start == tag]

    def _process(self):
        """The pipes and vessels from left to right, with the valves in them and what measures above them."""
        self.pipe, self.spans, self.taps, column = ["from"], {}, [], 1
        self.cells[0, 0] = "from"
        for place, what in self.places.items():
            here = [tag for tag, where in self.located.items() if where == place]
            inline = [tag for tag in here if tag in self.valves] if what == "pipe" else []
            above = [tag for tag in here if tag not in inline]
            # behind an instrument a column for each that only listens to it, as an alarm does
            first = column
            for tag in above:
                self._put(tag, 1, column)
                if what == "pipe":
                    self.cells[0, column] = point = self._point()
                    self.pipe.append(point)
                self.taps.append((point if what == "pipe" else place, tag))
                column += 1
                for other in self._listeners(tag):
                    self._put(other, 1, column)
                    column += 1
            for tag in inline:
                self._put(tag, 0, column)
                self.pipe.append(tag)
                column += 1
            if what == "vessel":
                column = max(column, first + 2)
                self.cells |= {(0, n): place for n in range(first, column)}
                self.pipe.append(place)
            elif column == first:
                column += 1
        self.cells[0, column] = "to"
        self.pipe.append("to")
        self.width = column + 1

    def _listeners(self, tag):
        """What hears this one alone, and tells nobody."""
        return [other for other in self._tells(tag) if self._hears(other) == [tag] and not self._tells(other)
                and other not in self.located and other not in self.valves]  # fmt: skip

    def _put(self, tag, row, column):
        if tag not in self.columns:
            self.rows[tag], self.columns[tag] = row, column
            self.cells[row, column] = tag

    def _controllers(self):
        """Who is nowhere yet: above the only one that it hears, or to the right; who tells is above who is told."""
        left = [tag for tag in self.tags if tag not in self.columns]
        order = []
        while left:
            last = [tag for tag in left if not any(other in left for other in self._tells(tag) if other != tag)]
            order += last[:1] or left[:1]
            left = [tag for tag in left if tag not in order]
        self.height = 2
        for tag in order:
            heard = [one for one in self._hears(tag) if one in self.columns and self.rows[one] == 1]
            under = [one for one in heard if [x for x in self._tells(one) if x not in self._listeners(one)] == [tag]
                     and not any(row > 1 and column == self.columns[one] for row, column in self.cells)]  # fmt: skip
            if under:
                column = self.columns[under[0]]
            else:
                column, self.width = self.width, self.width + 1
            self._put(tag, self.height, column)
            self.height += 1

    def _paths(self):
        """The signals as paths, with corners where they turn."""
        found = {"signals": [], "pneumatic": []}
        for one in self.signals:
            (a, x), (b, y) = ((self.rows[tag], self.columns[tag]) for tag in (one.start, one.end))
            corners = []
            if a != b and x != y:
                row, column = (a, y) if a > 1 else (b, x)
                if row < 2:  # from one that measures to another or to a valve: over a row of their own
                    row, self.height = self.height, self.height + 1
                    corners = [(row, x), (row, y)]
                else:
                    corners = [(row, column)]
            elif a == b and abs(x - y) > 1:
                row, self.height = self.height, self.height + 1
                corners = [(row, x), (row, y)]
            names = [self.cells.setdefault(corner, None) or self._corner(corner) for corner in corners]
            kind = "pneumatic" if one.kind == "pneumatic" else "signals"
            found[kind].append(" ".join([one.start, *names, one.end]))
        return found

    def _corner(self, corner):
        self.cells[corner] = name = self._point()
        return name

    def picture(self, title):
        """The diagram."""
        paths = self._paths()
        names = {place: f"part{n}" for n, place in enumerate(self.places)}  # names without blanks
        rows = [
            " ".join(names.get(self.cells.get((row, n)), self.cells.get((row, n))) or "." for n in range(self.width))
            for row in range(self.height - 1, -1, -1)
        ]
        parts = {tag: control_valve(tag) for tag in self.valves}
        parts |= {names[place]: vessel(place) for place, what in self.places.items() if what == "vessel"}
        (first, begins), *_, (last, ends) = self.places.items()
        labels = {"from": first if begins == "pipe" else "in", "to": last if ends == "pipe" else "out"}
        taps = [f"{names.get(point, point)} {tag}" for point, tag in self.taps]
        return instrumentation_diagram(
            "\n".join(rows), " ".join(names.get(one, one) for one in self.pipe), ", ".join([*taps, *paths["signals"]]),
            parts, labels, title=title, lines={"pneumatic": ", ".join(paths["pneumatic"])},
        )  # fmt: skip
