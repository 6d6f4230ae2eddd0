r"""Block diagrams, written in the order in which the signal runs: ``block_diagram("u", H1, "y_1", H2, "y_2")``.

A word is the name of a signal, a SymPy expression is a block, and `parallel_paths`, `feedback_loop` and `sum_of` stand
for the parts of a diagram with more than one path. Each part knows how much room it takes and draws itself from a
point onward, so parts can stand within parts.
"""

import math
import numbers
import re

import sympy
from sympy.printing.latex import LatexPrinter

from loopbook.expressions import s
from loopbook.figures import STYLE, Picture, plain_words

__all__ = [
    "block", "block_diagram", "conveyor_belt", "equivalent_diagrams", "feedback_loop", "parallel_paths", "sum_of",
]  # fmt: skip

# Lengths are in drawing units of half an inch, as schemdraw has them.
INCHES = 0.5
FONT_SIZE = 12
LINE = 1.1  # points
HEAD = {"arrowlength": 0.26, "arrowwidth": 0.19}
RADIUS = 0.22  # of a summing junction
WIRE = 1.0  # shortest distance between two blocks
GAP = 0.45  # between two paths above one another


def block_diagram(*items, title=None):
    """Draw a block diagram.

    Arguments:
        items: what the signal meets, in order. A text names the signal there (mathematics, as ``"y_1"``; one with
            dollar signs is taken as it is); a SymPy expression or `block` is a block; `parallel_paths`,
            `feedback_loop` and, in the first place, `sum_of` are parts with several paths.
        title: stands above the diagram; begins with the name of the book's figure where there is one.
    Returns:
        A `Picture`, which a notebook shows as the value of a cell.
    Raises:
        ValueError: for two signal names in a row, or anything that is no part of a block diagram.

    >>> T1, T2 = sympy.symbols("T1 T2")
    >>> block_diagram("u", 1 / (T1 * s + 1), "y_1", 1 / (T2 * s + 1), "y_2", title="Figure 6.5")
    <Figure 6.5: block diagram: u → [1/(T1*s + 1)] → y_1 → [1/(T2*s + 1)] → y_2>
    """
    chain = _Chain(items)
    sheet = _Sheet()
    chain.draw(sheet, 0, 0)
    return sheet.picture(title, f"block diagram: {chain}")


def equivalent_diagrams(rules, title=None):
    """Draw pairs of block diagrams that mean the same, one pair a row, with an arrow between the two.

    Arguments:
        rules: ``{name: (left, right)}``, each side a list of items as `block_diagram` takes them.
        title: stands above the table.
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
    sheet, y, words = _Sheet(), 0, []
    for name, (left, right) in rows.items():
        sheet.text(-0.1, y, name, halign="left", valign="top")
        y -= 0.75 + max(left.above, right.above)
        left.draw(sheet, 0, y)
        sheet.text(middle, y, r"$\Leftrightarrow$", size=1.5 * FONT_SIZE)
        right.draw(sheet, middle + 0.9, y)
        y -= max(left.below, right.below) + 0.8
        words.append(f"{name}: {left} equals {right}")
    return sheet.picture(title, "; ".join(words))


def block(label):
    r"""Return a block with a label of your own where a SymPy expression would not be written as you want it.

    Arguments:
        label: mathematics as LaTeX writes it, without dollar signs, or a text with dollar signs for mixed words.

    >>> block(r"\frac{K}{Ts+1}")
    [\frac{K}{Ts+1}]
    """
    return _Block(_mathematics(label), label)


def parallel_paths(*paths, signs=None):
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


def sum_of(*paths, signs=None):
    """Return the part of a diagram in which two or three separate signals are summed; it stands first in a diagram.

    Arguments:
        paths: from the top down, each a list of items that begins with the name of its signal.
        signs: one "+" or "-" for each path; all plus if not given.
    Raises:
        ValueError: for less than two or more than three paths, or for signs that do not fit.

    >>> G, H = sympy.symbols("G H")
    >>> sum_of(["u_1", G], ["u_2", H])
    (+ u_1 → [G] + u_2 → [H])
    """
    return _Paths(paths, signs, branch=False)


def feedback_loop(forward, back=None, sign="-"):
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


def conveyor_belt(inflow=r"F_{\mathrm{in}}", outflow=r"F_{\mathrm{out}}", delay=r"\tau", title=None):
    r"""Draw a conveyor belt, which turns an inflow into the same outflow some time later.

    Arguments:
        inflow, outflow, delay: mathematics at the arrow in, at the arrow out and at the time in between.
        title: stands above the drawing.
    Returns:
        A `Picture`, which a notebook shows as the value of a cell.

    >>> conveyor_belt(title="Figure 6.3")
    <Figure 6.3: conveyor belt: F_in falls on one end, F_out leaves the other end tau later>
    """
    sheet = _Sheet()
    length, r = 8.4, 0.42
    sheet.wire((0, r), (length, r))
    sheet.wire((0, -r), (length, -r))
    for x in (0, length):
        sheet.circle(x, 0, r)
        sheet.dot(x, 0)
    # the layer of material, from where it falls to where it leaves, and the way that it goes
    end = [(length, r + 0.32), (length + 0.3, r + 0.18), (length + r, 0.1), (length, r)]
    sheet.area([(0.15, r), (0.45, r + 0.32), *end], fill="#d9d9d9")
    sheet.wire((length / 2 - 0.7, 0), (length / 2 + 0.7, 0), arrow="->")
    # the chute
    for side in (-1, 1):
        sheet.wire((0.45 + side * 0.75, 2.4), (0.45 + side * 0.25, 1.75), (0.45 + side * 0.25, 1.35))
    sheet.wire((0.45, 3.1), (0.45, r + 0.4), arrow="->")
    sheet.text(0.7, 3.0, _mathematics(inflow), halign="left")
    sheet.wire((length + r + 0.1, -0.1), (length + r + 0.1, -1.5), arrow="->")
    sheet.text(length + r + 0.35, -1.1, _mathematics(outflow), halign="left")
    # the time on the belt, as a dimension line
    for x in (0.45, length + r + 0.1):
        sheet.wire((x, -1.75), (x, -2.25), width=0.8)
    sheet.wire((0.45, -2), (length + r + 0.1, -2), arrow="<->", width=0.8)
    sheet.text((0.55 + length + r) / 2, -1.9, _mathematics(delay), valign="bottom")
    words = f"conveyor belt: {inflow} falls on one end, {outflow} leaves the other end {delay} later"
    return sheet.picture(title, words)


# ------------------------------------------------------------------------------------------- the parts of a diagram
# Every part has a width, reaches so far above and below the axis on which it stands, and draws itself from the point
# (x, y) in the direction `way`: 1 to the right, -1 to the left, as in the return path of a loop.


class _Block:
    arrow_in = True

    def __init__(self, label, words):
        width, height = _text_size(label)
        self.label, self.words = label, words
        self.width = max(1.3, width + 0.5)
        self.above = self.below = max(0.5, height / 2 + 0.22)

    def __repr__(self):
        return f"[{self.words}]"

    def draw(self, sheet, x, y, way=1):
        sheet.box(x if way > 0 else x - self.width, y, self.width, 2 * self.above, self.label)


class _Chain:
    """Parts one after the other, a wire before, between and after them; a signal's name stands above its wire."""

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
        sizes = [_text_size(_mathematics(name)) if name else (0, 0) for name in self.names]
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
        return 0.8 if isinstance(self.parts[n], _Loop) else 0.3 if self.parts[n].arrow_in else 0

    def draw(self, sheet, x, y, way=1, arrow_out=True):
        for n, length in enumerate(self.lengths):
            head = arrow_out if n == len(self.parts) else self.parts[n].arrow_in
            if length:
                sheet.wire((x, y), (x + way * length, y), arrow="->" if head else None)
            if self.names[n]:
                centre = x + way * (length - self._end_of_wire(n)) / 2
                sheet.text(centre, y + 0.13, _mathematics(self.names[n]), valign="bottom")
            x += way * length
            if n < len(self.parts):
                self.parts[n].draw(sheet, x, y, way)
                x += way * self.parts[n].width


class _Paths:
    """Two or three paths into a summing junction; with `branch`, out of one branch point."""

    arrow_in = False

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

    def draw(self, sheet, x, y, way=1):
        end = x + way * self.span
        for chain, sign, height in zip(self.chains, self.signs, self.heights, strict=True):
            if self.branch and height:
                sheet.wire((x, y), (x, y + height))
            chain.draw(sheet, x, y + height, way, arrow_out=not height)
            sheet.into_junction(end, y, (0, height) if height else (-way, 0), sign)
        if self.branch:
            sheet.dot(x, y)
        sheet.circle(end, y, RADIUS)


class _Loop:
    """A summing junction, the forward path, a branch point, and the path back."""

    arrow_in = True

    def __init__(self, forward, back, sign):
        if sign not in ("-", "+"):
            raise ValueError(f"the sign of a feedback is - or +, not {sign!r}")
        self.forward, self.back, self.sign = _Chain(forward, 0), _Chain([] if back is None else back, 0), sign
        self.span = max(self.forward.width + RADIUS, self.back.width)  # from the junction to the branch point
        self.width = RADIUS + self.span
        self.forward.stretch(self.span - RADIUS)
        self.back.stretch(self.span)
        self.drop = max(1.0, self.forward.below + GAP + self.back.above)
        self.above, self.below = self.forward.above, self.drop + self.back.below

    def __repr__(self):
        return f"(loop {self.forward}, back {self.sign} {str(self.back) or '1'})"

    def draw(self, sheet, x, y, way=1):
        centre, out = x + way * RADIUS, x + way * self.width
        self.forward.draw(sheet, centre + way * RADIUS, y, way, arrow_out=False)
        sheet.wire((out, y), (out, y - self.drop))
        self.back.draw(sheet, out, y - self.drop, -way, arrow_out=False)
        sheet.into_junction(centre, y, (0, -self.drop), self.sign)
        sheet.sign(centre, y, (-way, 0), "+")
        sheet.circle(centre, y, RADIUS)
        sheet.dot(out, y)


def _part(item):
    if isinstance(item, (_Block, _Paths, _Loop)):
        return item
    if isinstance(item, (sympy.Expr, numbers.Real)):
        item = sympy.sympify(item)
        return _Block(_mathematics(_AsBooksDo().doprint(item)), str(item))
    raise ValueError(f"{item!r} is no part of a block diagram: expected a signal's name, an expression or a part")


class _AsBooksDo(LatexPrinter):
    """LaTeX in the order of the books: descending powers of s (s - a, not -a + s), numbers first among the rest
    (1 + G, not G + 1), and s behind its coefficient (tau s, not s tau)."""

    _last = sympy.Symbol("zz")  # stands for s, and comes after every other letter

    def doprint(self, expr):
        self._settings["symbol_names"] = {self._last: "s"}
        return super().doprint(expr.xreplace({s: self._last}))

    def _as_ordered_terms(self, expr, order=None):
        terms = super()._as_ordered_terms(expr, order)
        powers = {term: term.as_coeff_exponent(self._last)[1] for term in terms}
        if not all(power.is_number for power in powers.values()):
            return terms
        return sorted(terms, key=lambda term: (-powers[term], not term.is_number))


# ------------------------------------------------------------------------------------------------------ the drawing


def _mathematics(text):
    """Text for matplotlib: mathematics unless it has dollar signs of its own, with fractions in full size."""
    return re.sub(r"\\frac\b", r"\\dfrac", text if "$" in text else f"${text}$")


def _text_size(label):
    """Width and height of a label in drawing units."""
    from matplotlib.font_manager import FontProperties
    from matplotlib.textpath import TextPath

    font = FontProperties(family=STYLE["font.family"], math_fontfamily=STYLE["mathtext.fontset"])
    box = TextPath((0, 0), label, size=FONT_SIZE, prop=font).get_extents()
    return box.width / 72 / INCHES, box.height / 72 / INCHES


class _Sheet:
    """What the parts draw on: schemdraw's segments at given places."""

    def __init__(self):
        import schemdraw
        from schemdraw import segments

        self.segments = segments
        self.drawing = schemdraw.Drawing(show=False)
        font = {"font": STYLE["font.family"], "mathfont": STYLE["mathtext.fontset"], "fontsize": FONT_SIZE}
        self.drawing.config(inches_per_unit=INCHES, lw=LINE, **font)

    def _add(self, segment):
        from schemdraw.elements import Element

        element = Element().at((0, 0)).theta(0)
        element.segments.append(segment)
        self.drawing.add(element)

    def wire(self, *points, arrow=None, width=LINE):
        """A line through the points; `arrow` is "->" or "<->"."""
        self._add(self.segments.Segment(points, arrow=arrow, lw=width, **HEAD))

    def box(self, x, y, width, height, label):
        """A box with the middle of its left side at (x, y)."""
        corners = [(x, y - height / 2), (x, y + height / 2), (x + width, y + height / 2), (x + width, y - height / 2)]
        self.area(corners, fill="white")
        self.text(x + width / 2, y, label)

    def area(self, corners, fill):
        self._add(self.segments.SegmentPoly(corners, fill=fill, lw=LINE))

    def circle(self, x, y, radius, fill="white"):
        self._add(self.segments.SegmentCircle((x, y), radius, fill=fill, zorder=3))

    def dot(self, x, y):
        self.circle(x, y, 0.08, fill="black")

    def text(self, x, y, label, halign="center", valign="center", size=FONT_SIZE):
        self._add(self.segments.SegmentText((x, y), label, align=(halign, valign), fontsize=size, zorder=4))

    def into_junction(self, x, y, side, sign):
        """The last piece of a path into the summing junction at (x, y), and its sign; `side` is where it comes from."""
        if side[1]:
            self.wire((x, y + side[1]), (x, y + math.copysign(RADIUS, side[1])), arrow="->")
        self.sign(x, y, side, sign)

    def sign(self, x, y, side, sign):
        """The sign stands over a path from the side, and on the left of a path from above or below."""
        away = math.copysign(RADIUS + 0.34, side[0] or side[1])
        dx, dy = (away, 0.25) if side[0] else (-0.3, away)
        self.text(x + dx, y + dy, {"+": "$+$", "-": "$-$"}[sign])

    def picture(self, title, words):
        import matplotlib
        from matplotlib.figure import Figure

        with matplotlib.rc_context(STYLE):
            figure = Figure()
            axes = figure.add_axes((0, 0, 1, 1))
            self.drawing.draw(show=False, canvas=axes)
            axes.set_axis_off()
            axes.set_aspect("equal")
            # schemdraw guesses the width of mathematics from its source, so the lines decide how wide the drawing is.
            box, margin = self.drawing.get_bbox(), 0.1
            left, right = axes.dataLim.xmin - margin, axes.dataLim.xmax + margin
            bottom, top = box.ymin - margin, box.ymax + margin
            axes.set(xlim=(left, right), ylim=(bottom, top))
            figure.set_size_inches(INCHES * (right - left), INCHES * (top - bottom))
            axes.set_title(title or "")
        return Picture(figure, plain_words(f"{title}: {words}" if title else words))
