r"""Block diagrams, written in the order in which the signal runs: ``block_diagram("u", H1, "y_1", H2, "y_2")``.

A word is the name of a signal, a SymPy expression is a block, and `parallel_paths`, `feedback_loop`, `disturbance` and
`sum_of` stand for the parts of a diagram with more than one path. Each part knows how much room it takes and draws
itself from a point onward, so parts can stand within parts.
"""

from __future__ import annotations

import numbers
from collections.abc import Mapping, Sequence
from typing import TYPE_CHECKING, TypeAlias

import sympy

from loopbook.diagrams.drawing import FONT_SIZE, RADIUS, Drawing, mathematics, signal_name, text_size, wording
from plainmath.latex import latex

if TYPE_CHECKING:
    from loopbook.figures import Picture
    from loopbook.types import Number

WIRE = 1.0  # shortest distance between two blocks
GAP = 0.45  # between two paths above one another
SYMBOL = 1.4 * FONT_SIZE  # of an elementary block
STUB = 0.6  # the arrow of a value that enters a block from above or below

#: What stands in a block diagram: a signal's name, an expression, or what `block` and the other functions here return.
Item: TypeAlias = "str | Number | _Block | _Entry | _Paths | _Loop"

#: A path of a diagram: a single item, or several in the order in which the signal runs.
Items: TypeAlias = "Item | Sequence[Item]"


def block_diagram(*items: Item, title: str | None = None) -> Picture:
    """Draw a block diagram.

    Arguments:
        items: what the signal meets, in order. A text names the signal there (mathematics, as ``"y_1"``; one with
            dollar signs is taken as it is); a SymPy expression or `block` is a block; `parallel_paths`,
            `feedback_loop` and, in the first place, `sum_of` are parts with several paths.
        title: written above the diagram; begins with the name of the book's figure where there is one.
    Returns:
        A `Picture`, which a notebook shows as the value of a cell.
    Raises:
        ValueError: for two signal names in a row, or anything that is not a part of a block diagram.

    >>> from plainmath.expressions import s
    >>> T1, T2 = sympy.symbols("T1 T2")
    >>> block_diagram("u", 1 / (T1 * s + 1), "y_1", 1 / (T2 * s + 1), "y_2", title="Figure 6.5")
    <Figure 6.5: block diagram: u → [1/(T1*s + 1)] → y_1 → [1/(T2*s + 1)] → y_2>
    """
    chain = _Chain(items)
    drawing = Drawing()
    chain.draw(drawing, 0, 0)
    return drawing.picture(title, f"block diagram: {chain}")


def equivalent_diagrams(
    rules: Mapping[str, tuple[Sequence[Item], Sequence[Item]]], title: str | None = None
) -> Picture:
    """Draw pairs of block diagrams that mean the same, one pair a row, with an arrow between the two.

    Arguments:
        rules: ``{name: (left, right)}``, each side a list of items as `block_diagram` takes them.
        title: written above the table.
    Returns:
        A `Picture`, which a notebook shows as the value of a cell.
    Raises:
        ValueError: as `block_diagram`, or when a rule is not a pair.

    >>> G, H = sympy.symbols("G H")
    >>> equivalent_diagrams({"Series": (["u", G, H, "y"], ["u", G * H, "y"])}, title="Figure 5.2")
    <Figure 5.2: Series: u → [G] → [H] → y equals u → [G*H] → y>
    """
    if not rules or any(not isinstance(pair, (list, tuple)) or len(pair) != 2 for pair in rules.values()):
        raise ValueError("rules must be {name: (left, right)}, each side a list of items")
    rows = {name: (_Chain(left), _Chain(right)) for name, (left, right) in rules.items()}
    middle = max(left.width for left, _ in rows.values()) + 0.9
    drawing, y, words = Drawing(), 0, []
    for name, (left, right) in rows.items():
        drawing.text(-0.1, y, name, halign="left", valign="top")
        y -= 0.75 + max(left.above, right.above)
        left.draw(drawing, 0, y)
        drawing.text(middle, y, r"$\Leftrightarrow$", size=1.5 * FONT_SIZE)
        right.draw(drawing, middle + 0.9, y)
        y -= max(left.below, right.below) + 0.8
        words.append(f"{name}: {left} equals {right}")
    return drawing.picture(title, "; ".join(words))


def overall_diagram(
    name: str,
    inputs: Sequence[str] = (),
    disturbances: Sequence[str] = (),
    parameters: Sequence[str] = (),
    outputs: Sequence[str] = (),
    title: str | None = None,
) -> Picture:
    r"""Draw a model as one block with everything that enters and leaves it.

    Arguments:
        name: stands in the block; words as they are, anything else mathematics.
        inputs: names of the manipulated variables, which enter from the left, from the top down.
        disturbances: names of the environmental variables, which enter from above, from left to right.
        parameters: names of the parameters, which enter from below.
        outputs: names of the variables that leave to the right.
        title: written above the diagram.
    Returns:
        A `Picture`, which a notebook shows as the value of a cell.
    Raises:
        ValueError: when a list of names is a single text.

    >>> overall_diagram("Heated tank", ["P"], ["T_i", "T_e"], ["c", "m"], ["T"], title="Figure 3.12")
    <Figure 3.12: overall block diagram: P → [Heated tank; from above T_i, T_e; from below c, m] → T>
    """
    _names(inputs), _names(outputs)
    part = block(name, above=disturbances, below=parameters)
    part.width, part.half = max(part.width, 3.2), max(part.half, 0.7, 0.4 * max(len(inputs), len(outputs)))
    drawing = Drawing()
    part.draw(drawing, 0, 0)
    for names, start in ((inputs, -1.6), (outputs, part.width)):
        for n, signal in enumerate(names):
            y = part.half * (1 - (2 * n + 1) / len(names))
            drawing.wire((start, y), (start + 1.6, y), arrow="->")
            drawing.text(start + 0.65, y + 0.1, signal_name(signal), valign="bottom")
    words = " → ".join(word for word in (", ".join(inputs), str(part), ", ".join(outputs)) if word)
    return drawing.picture(title, f"overall block diagram: {words}")


def elementary_blocks(title: str | None = None) -> Picture:
    """Draw the table of the blocks from which the diagram of a differential equation is built.

    Arguments:
        title: written above the table.
    Returns:
        A `Picture`, which a notebook shows as the value of a cell.

    >>> elementary_blocks(title="Figure 2.2").alt[:51]
    'Figure 2.2: Integrator: u → [integral; from above y'
    """
    rows = {
        "Integrator": (["u", integrator("y_0"), "y"], r"y(t) = y_0 + \int_0^t u(\theta)\,d\theta"),
        "Sum": (["u_1", disturbance("u_2"), disturbance("u_3", sign="-", side="below"), "y"], "y = u_1 + u_2 - u_3"),
        "Multiplication": (["u_1", multiplication("u_2"), "y"], "y = u_1 u_2"),
        "Division": (["u_1", division("u_2"), "y"], "y = u_1/u_2"),
        "Gain": (["u", gain("K"), "y"], "y = K u"),
        "Time delay": (["u", delay(), "y"], r"y(t) = u(t - \tau)"),
    }
    drawing, y, words = Drawing(), 0, []
    for name, (items, formula) in rows.items():
        chain = _Chain(items)
        y -= chain.above
        drawing.text(0, y, name, halign="left")
        chain.draw(drawing, 3, y)
        drawing.text(9, y, mathematics(formula), halign="left")
        y -= chain.below + 0.3
        words.append(f"{name}: {chain} means {formula}")
    return drawing.picture(title, "; ".join(words))


def block(label: str, above: Sequence[str] = (), below: Sequence[str] = ()) -> _Block:
    r"""Return a block with a label of your own where a SymPy expression would not be written as you want it.

    Arguments:
        label: words as they are; anything else is mathematics as LaTeX writes it, without dollar signs, or a text with
            dollar signs for mixed words. ``"\\n"`` begins a new line.
        above, below: names of the values that enter the block from above and from below.
    Raises:
        ValueError: when `above` or `below` is a single text and no list of names.

    >>> block(r"\frac{K}{Ts+1}")
    [\frac{K}{Ts+1}]
    >>> block("Process", above=["d"])
    [Process; from above d]
    """
    return _Block(wording(label), label, _names(above), _names(below))


def integrator(initial: str | None = None, limits: Sequence[str] = ()) -> _Block:
    """Return an integrator, as a block with the integral sign.

    Arguments:
        initial: name of the value at t = 0, which enters from above.
        limits: names of the lowest and the highest value, which enter from below.
    Raises:
        ValueError: unless there are none or two limits.

    >>> block_diagram("u", integrator("y_0", limits=("y_min", "y_max")), "y")
    <block diagram: u → [integral; from above y_0; from below y_min, y_max] → y>
    """
    if len(_names(limits)) not in (0, 2):
        raise ValueError(f"the limits of an integrator are its lowest and its highest value, not {limits!r}")
    return _Block(r"$\int$", "integral", [initial] if initial else [], limits, SYMBOL)


def multiplication(factor: str) -> _Block:
    """Return a block that multiplies the signal by another one, which enters from below.

    >>> block_diagram("u", multiplication("K"), "y")
    <block diagram: u → [×; from below K] → y>
    """
    return _Block(r"$\times$", "×", below=[factor], size=SYMBOL)


def division(divisor: str) -> _Block:
    """Return a block that divides the signal by another one, which enters from below.

    >>> block_diagram("u", division("A"), "y")
    <block diagram: u → [÷; from below A] → y>
    """
    return _Block(r"$\div$", "÷", below=[divisor], size=SYMBOL)


def gain(factor: str) -> _Block:
    """Return a constant gain, as a triangle.

    >>> block_diagram("u", gain("K"), "y")
    <block diagram: u → [gain K] → y>
    """
    return _Gain(wording(factor), f"gain {factor}")


def delay(time: str = r"\tau") -> _Block:
    """Return a block that passes the signal on some time later.

    >>> block_diagram("u", delay("3"), "y")
    <block diagram: u → [delay 3] → y>
    """
    return _Block(f"Delay\n{mathematics(time)}", f"delay {time}")


def switch() -> _Block:
    """Return a switch that lets one of two signals through, auto as it is drawn, or manual; for `grid_diagram`.

    >>> switch()
    [switch between auto and manual]
    """
    return _Switch("auto", "manual")


def disturbance(name: str, *path: Item, sign: str = "+", side: str = "above") -> _Entry:
    """Return a signal that enters a diagram in its middle, through a summing junction.

    Arguments:
        name: of the signal, such as a disturbance or noise; "" for none.
        path: blocks between the signal and the junction, in the order in which the signal runs.
        sign: "+" or "-".
        side: "above" or "below", where the signal comes from.
    Raises:
        ValueError: for another sign or side, or for a path with anything but blocks.

    >>> H_d = sympy.Symbol("H_d")
    >>> block_diagram("u", gain("K"), disturbance("d", H_d), "y")
    <block diagram: u → [gain K] → (+ d → [H_d] from above) → y>
    """
    return _Entry(name, path, sign, side)


def parallel_paths(*paths: Items, signs: str | None = None) -> _Paths:
    """Return the part of a diagram in which a signal branches into two or three paths that are summed again.

    Arguments:
        paths: from the top down, each a block or a list of items as `block_diagram` takes them.
        signs: one "+" or "-" for each path, as in ``"+-"``; all plus if not given.
    Raises:
        ValueError: for less than two or more than three paths, or for signs that do not fit.

    >>> G, H = sympy.symbols("G H")
    >>> parallel_paths(G, H, signs="+-")
    (+ [G] - [H])
    """
    return _Paths(paths, signs, branch=True)


def sum_of(*paths: Sequence[Item], signs: str | None = None) -> _Paths:
    """Return the part of a diagram in which two or three separate signals are summed; it stands first in a diagram.

    Arguments:
        paths: from the top down, each a list of items that begins with the name of its signal.
        signs: one "+" or "-" for each path; all plus if not given.
    Raises:
        ValueError: for less than two or more than three paths, or for signs that do not fit.

    >>> G, H = sympy.symbols("G H")
    >>> sum_of(["u_1", G], ["u_2", H], signs="+-")
    (+ u_1 → [G] - u_2 → [H])
    """
    return _Paths(paths, signs, branch=False)


def feedback_loop(forward: Items, back: Items | None = None, sign: str = "-") -> _Loop:
    """Return a feedback loop as part of a diagram.

    Arguments:
        forward, back: each a block or a list of items as `block_diagram` takes them, in the order in which the signal
            runs; nothing for `back` means that the output is fed back as it is.
        sign: "-" for negative, "+" for positive feedback.
    Raises:
        ValueError: for any other sign.

    >>> G, H = sympy.symbols("G H")
    >>> feedback_loop(["e", G], H)
    (loop e → [G], back - [H])
    """
    return _Loop(forward, back, sign)


# ------------------------------------------------------------------------------------------- the parts of a diagram
# Every part has a width, reaches so far above and below the axis on which it stands, and draws itself from the point
# (x, y) in the direction `way`: 1 to the right, -1 to the left, as in the return path of a loop.


class _Block:
    arrow_in, end_of_wire = True, 0.3

    def __init__(self, label, words, above=(), below=(), size=FONT_SIZE):
        width, height = text_size(label, size)
        self.label, self.words, self.entries, self.size = label, words, [(above, 1), (below, -1)], size
        self.width = max(1.3, width + 0.5, *(self._column(names) * len(names) for names in (above, below)))
        self.half = max(0.5, height / 2 + 0.22)

    above = property(lambda self: self._reach(0))
    below = property(lambda self: self._reach(1))

    def _reach(self, side):
        names = self.entries[side][0]
        return self.half + (STUB + 0.1 + max(text_size(signal_name(name))[1] for name in names) if names else 0)

    @staticmethod
    def _column(names):
        return max((text_size(signal_name(name))[0] for name in names), default=0) + 0.25

    def __repr__(self):
        sides = zip(("above", "below"), (names for names, _ in self.entries), strict=True)
        return f"[{'; '.join([self.words, *(f'from {where} ' + ', '.join(names) for where, names in sides if names)])}]"

    def draw(self, drawing, x, y, way=1):
        left = x if way > 0 else x - self.width
        self.outline(drawing, left, y, way)
        for names, side in self.entries:
            for n, name in enumerate(names):
                across, rim = left + self.width * (2 * n + 1) / (2 * len(names)), y + side * self.half
                drawing.wire((across, rim + side * STUB), (across, rim), arrow="->")
                place = "bottom" if side > 0 else "top"
                drawing.text(across, rim + side * (STUB + 0.1), signal_name(name), valign=place)

    def outline(self, drawing, left, y, way):
        drawing.box(left, y, self.width, 2 * self.half, self.label, self.size)


class _Gain(_Block):
    def __init__(self, label, words):
        super().__init__(label, words)
        self.width, self.half = self.width + 0.2, max(0.65, self.half)

    def outline(self, drawing, left, y, way):
        back, tip = (left, left + self.width)[::way]
        drawing.area([(back, y - self.half), (back, y + self.half), (tip, y)], fill="white")
        drawing.text((2 * back + tip) / 3, y, self.label)


class _Switch(_Block):
    """Two contacts on the left, the upper one closed and level with the way out; made for two rows of a grid."""

    def __init__(self, upper, lower):
        super().__init__("", f"switch between {upper} and {lower}")
        self.names, self.width, self.half, self.levels = (upper, lower), 1.9, 0.95, (0.5, -0.5)

    def outline(self, drawing, left, y, way):
        drawing.box(left, y, self.width, 2 * self.half, "")
        right, contact, pole = left + self.width, left + 0.45, left + self.width - 0.45
        for level, name, lift in zip(self.levels, self.names, (-0.12, 0.12), strict=True):
            drawing.wire((left, y + level), (contact, y + level))
            drawing.text((contact + right) / 2, y + level + lift, name, valign="top" if lift < 0 else "bottom", size=10)
        drawing.wire((contact, y + self.levels[0]), (right, y + self.levels[0]))
        for x, level in ((contact, self.levels[0]), (contact, self.levels[1]), (pole, self.levels[0])):
            drawing.circle(x, y + level, 0.07)


class _Entry:
    """A summing junction, with a path of blocks that comes to it from above or below."""

    arrow_in, end_of_wire = True, 0.8

    def __init__(self, name, path, sign, side):
        self.name, self.sign, self.side, self.blocks = name, _sign(sign), _side(side), [_part(item) for item in path]
        if not all(isinstance(part, _Block) for part in self.blocks):
            raise ValueError("between a disturbance and its junction stand blocks only")
        # A wide block needs longer wires around the junction, to keep away from the neighbours.
        self.width = max([2 * RADIUS, *(part.width - 1.6 for part in self.blocks)])
        if self.width > 2 * RADIUS:
            self.width, self.arrow_in, self.end_of_wire = max(self.width, 2 * RADIUS + 0.6), False, 0.5
        reach = RADIUS + 0.9 + sum(part.half * 2 + STUB for part in self.blocks)
        reach += text_size(signal_name(name))[1] + 0.1 if name else 0
        self.above, self.below = (reach, RADIUS) if side == "above" else (RADIUS, reach)

    def __repr__(self):
        path = " → ".join([self.name, *map(str, self.blocks)] if self.name else map(str, self.blocks))
        return f"({self.sign} {path} from {self.side})"

    def draw(self, drawing, x, y, way=1):
        start, end = x, x + way * self.width
        x, up = (start + end) / 2, 1 if self.side == "above" else -1
        if not self.arrow_in:
            drawing.wire((start, y), (x - way * RADIUS, y), arrow="->")
            drawing.wire((x, y), (end, y))
        height, length = RADIUS, 0.9
        for part in reversed(self.blocks):
            drawing.wire((x, y + up * (height + length)), (x, y + up * height), arrow="->")
            height, length = height + length + 2 * part.half, STUB
            part.draw(drawing, x - part.width / 2, y + up * (height - part.half))
        drawing.wire((x, y + up * (height + length)), (x, y + up * height), arrow="->")
        if self.name:
            top = y + up * (height + length + 0.1)
            drawing.text(x, top, signal_name(self.name), valign="bottom" if up > 0 else "top")
        drawing.sign(x, y, (0, up), self.sign)
        drawing.sign(x, y, (-way, 0), "+")
        drawing.circle(x, y, RADIUS)


class _Chain:
    """Parts one after the other, a wire before, between and after them; a signal's name is above its wire."""

    def __init__(self, items, at_end=0.3):
        """`at_end` is what the arrow head or whatever else stands at the end takes away from the last name."""
        items = items if isinstance(items, (list, tuple)) else [items]
        self.parts, self.names, self.at_end = [], [None], at_end
        for item in items:
            if not isinstance(item, str):
                self.parts.append(_part(item))
                self.names.append(None)
            elif self.names[-1] is not None:
                raise ValueError(f"there must be a block between the signals {self.names[-1]} and {item}")
            else:
                self.names[-1] = item
        if any(isinstance(part, _Paths) and not part.branch for part in self.parts[1:]) or (
            self.starts_with_sum and self.names[0] is not None
        ):
            raise ValueError("sum_of brings its own signals, so it stands first in a diagram")
        sizes = [text_size(signal_name(name)) if name else (0, 0) for name in self.names]
        self.lengths = [max(WIRE, w + 0.5 + self._end_of_wire(n)) if w else WIRE for n, (w, _) in enumerate(sizes)]
        if self.starts_with_sum:
            self.lengths[0] = 0
        self.above = max([part.above for part in self.parts] + [h + 0.2 for _, h in sizes])
        self.below = max([part.below for part in self.parts], default=0.1)

    @property
    def width(self):
        return sum(self.lengths) + sum(part.width for part in self.parts)

    @property
    def starts_with_sum(self):
        return bool(self.parts) and isinstance(self.parts[0], _Paths) and not self.parts[0].branch

    def stretch(self, width):
        """Take up all of the width, with longer wires at both ends."""
        spare = width - self.width
        self.lengths[0] += spare / 2
        self.lengths[-1] += spare / 2

    def __repr__(self):
        words = [self.names[0]]
        for part, name in zip(self.parts, self.names[1:], strict=True):
            words += [str(part), name]
        return " → ".join(word for word in words if word)

    def _end_of_wire(self, n):
        """How much of wire n an arrow head, and at a junction the sign, take away from the name."""
        if n == len(self.parts):
            return self.at_end
        return self.parts[n].end_of_wire

    def draw(self, drawing, x, y, way=1, arrow_out=True):
        for n, length in enumerate(self.lengths):
            head = arrow_out if n == len(self.parts) else self.parts[n].arrow_in
            if length:
                drawing.wire((x, y), (x + way * length, y), arrow="->" if head else None)
            if self.names[n]:
                centre = x + way * (length - self._end_of_wire(n)) / 2
                drawing.text(centre, y + 0.13, signal_name(self.names[n]), valign="bottom")
            x += way * length
            if n < len(self.parts):
                self.parts[n].draw(drawing, x, y, way)
                x += way * self.parts[n].width


class _Paths:
    """Two or three paths into a summing junction; with `branch`, out of one branch point."""

    arrow_in, end_of_wire = False, 0

    def __init__(self, paths, signs, branch):
        if not 2 <= len(paths) <= 3:
            raise ValueError(f"a summing junction has room for two or three paths, not {len(paths)}")
        ends = [0.8 + RADIUS, 0.8, 0.8 + RADIUS] if len(paths) == 3 else [0, 0]
        self.chains, self.branch = [_Chain(path, end) for path, end in zip(paths, ends, strict=True)], branch
        self.signs = signs or "+" * len(paths)
        if len(self.signs) != len(paths) or not set(self.signs) <= set("+-"):
            raise ValueError(f"signs must be one + or - for each of the {len(paths)} paths, not {self.signs!r}")
        for chain in self.chains:
            if not branch and (chain.names[0] is None or chain.starts_with_sum):
                raise ValueError("each path of sum_of begins with the name of its signal")
        if not branch:  # the inputs stand in one column, and so do the blocks
            longest = max(chain.lengths[0] for chain in self.chains)
            for chain in self.chains:
                chain.lengths[0] = longest
        top, *middle, bottom = self.chains
        if middle:
            up, down = top.below + middle[0].above, middle[0].below + bottom.above
            self.heights = [max(1.0, up + GAP), 0, -max(1.0, down + GAP)]
        else:
            half = max(0.9, (top.below + GAP + bottom.above) / 2)
            self.heights = [half, -half]
        # A path from the side ends at the rim of the junction, the others end above or below its centre.
        rims = [0 if height else RADIUS for height in self.heights]
        self.span = max(chain.width + rim for chain, rim in zip(self.chains, rims, strict=True))
        self.width = self.span + RADIUS
        for chain, rim in zip(self.chains, rims, strict=True):
            if branch:
                chain.stretch(self.span - rim)
            else:
                chain.lengths[-1] += self.span - rim - chain.width
        self.above = self.heights[0] + top.above
        self.below = -self.heights[-1] + bottom.below

    def __repr__(self):
        return f"({' '.join(f'{sign} {chain}' for sign, chain in zip(self.signs, self.chains, strict=True))})"

    def draw(self, drawing, x, y, way=1):
        end = x + way * self.span
        for chain, sign, height in zip(self.chains, self.signs, self.heights, strict=True):
            if self.branch and height:
                drawing.wire((x, y), (x, y + height))
            chain.draw(drawing, x, y + height, way, arrow_out=not height)
            drawing.into_junction(end, y, (0, height) if height else (-way, 0), sign)
        if self.branch:
            drawing.dot(x, y)
        drawing.circle(end, y, RADIUS)


class _Loop:
    """A summing junction, the forward path, a branch point, and the path back."""

    arrow_in, end_of_wire = True, 0.8

    def __init__(self, forward, back, sign):
        self.forward, self.back, self.sign = _Chain(forward, 0), _Chain([] if back is None else back, 0), _sign(sign)
        self.span = max(self.forward.width + RADIUS, self.back.width)  # from the junction to the branch point
        self.width = RADIUS + self.span
        self.forward.stretch(self.span - RADIUS)
        self.back.stretch(self.span)
        self.drop = max(1.0, self.forward.below + GAP + self.back.above)
        self.above, self.below = self.forward.above, self.drop + self.back.below

    def __repr__(self):
        return f"(loop {self.forward}, back {self.sign} {str(self.back) or '1'})"

    def draw(self, drawing, x, y, way=1):
        centre, out = x + way * RADIUS, x + way * self.width
        self.forward.draw(drawing, centre + way * RADIUS, y, way, arrow_out=False)
        drawing.wire((out, y), (out, y - self.drop))
        self.back.draw(drawing, out, y - self.drop, -way, arrow_out=False)
        drawing.into_junction(centre, y, (0, -self.drop), self.sign)
        drawing.sign(centre, y, (-way, 0), "+")
        drawing.circle(centre, y, RADIUS)
        drawing.dot(out, y)


def _sign(sign):
    if sign not in ("-", "+"):
        raise ValueError(f"the sign of a feedback or disturbance is - or +, not {sign!r}")
    return sign


def _side(side):
    if side not in ("above", "below"):
        raise ValueError(f"the side is above or below, not {side!r}")
    return side


def _names(names):
    if isinstance(names, str):
        raise ValueError(f"{names!r} must be a list of names")
    return list(names)


def _part(item):
    if isinstance(item, (_Block, _Entry, _Paths, _Loop)):
        return item
    if isinstance(item, (sympy.Expr, numbers.Real)):
        item = sympy.sympify(item)
        return _Block(mathematics(latex(item)), str(item))
    raise ValueError(f"{item!r} is not a part of a block diagram: expected a signal's name, an expression or a part")
