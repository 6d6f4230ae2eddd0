"""The tree of a formula, in any notation: Python's, LaTeX's, or as people write formulas.

The grammar is `formula.lark`. What can be read in two ways that differ is not guessed: a sentence asks for brackets. A
fraction is followed by a product only where everybody reads it alike, as in ``2/(10s + 1) e^(-3s)``.
"""

from __future__ import annotations

import ast
import functools
import itertools
import math
import re
import unicodedata
from collections.abc import Callable, Collection, Iterable, Iterator, Sequence
from importlib import resources
from typing import Any, NamedTuple

import lark
import numpy as np

from plainmath.validation import did_you_mean

#: What a formula may call, and with how many values.
ONE_VALUE = (
    "exp", "log", "ln", "log10", "sqrt", "sin", "cos", "tan", "sinh", "cosh", "tanh", "asin", "acos", "atan",
    "arcsin", "arccos", "arctan", "Abs", "abs", "sign", "re", "im",
)  # fmt: skip
SEVERAL_VALUES = ("Min", "Max", "min", "max", "Heaviside", "Piecewise", "where")
CONSTANTS = {"pi": np.pi, "E": np.e, "e": np.e, "I": 1j, "j": 1j, "i": 1j}
#: Names of steps, which are functions where the symbol is the time.
STEPS = ("Heaviside", "heaviside", "step", "unitstep", "u", "H", "sigma", "theta", "epsilon", "1")
#: Names by other names: functions, and letters of LaTeX.
OTHER_NAMES = {
    "√": "sqrt", "Sqrt": "sqrt", "root": "sqrt", "Exp": "exp", "Ln": "ln", "Log": "log", "Sin": "sin", "Cos": "cos",
    "dfrac": "frac", "tfrac": "frac", "infty": "oo", "log_10": "log10", "lg": "log10",
}  # fmt: skip
#: Letters that stand for the same in different books, {one: the other} in both directions, as `bare` writes them.
SAME_LETTERS: dict[str, str] = {}
#: Units of time, which the time of a piece may have, in s.
TIMES = {"ms": 0.001, "s": 1, "min": 60, "h": 3600, "d": 86400}
TIMES |= {"sec": 1, "second": 1, "seconds": 1, "minute": 60, "minutes": 60, "hour": 3600, "hours": 3600}
LONGEST, LONGEST_NAME, MOST_READINGS, MOST_NODES, MOST_PIECES = 4000, 40, 500, 2000, 6

_OPERATORS = {"+": ast.Add, "-": ast.Sub, "*": ast.Mult, "/": ast.Div, "&": ast.BitAnd, "|": ast.BitOr}
_COMPARES = {"<": ast.Lt, "<=": ast.LtE, ">": ast.Gt, ">=": ast.GtE}
_RAISED = str.maketrans("⁰¹²³⁴⁵⁶⁷⁸⁹⁻", "0123456789-")
_LOWERED = str.maketrans("₀₁₂₃₄₅₆₇₈₉", "0123456789")
_PARTS = {"½": (1, 2), "¼": (1, 4), "¾": (3, 4), "⅓": (1, 3), "⅔": (2, 3)}
#: What Python makes of the LaTeX in a text that is not raw: of ``\\tau`` a tab and "au".
_ESCAPED = re.compile("\t(?=au|heta|imes|ext|frac)|\f(?=rac)|\r(?=ight|m)|\b(?=eta|ig)|\v(?=ar)|\a(?=lpha)")
#: A word of LaTeX around a name, which is the name.
UPRIGHT = re.compile(r"\\(?:mathrm|mathbf|mathit|text|operatorname|rm) *\{? *(\w+) *\}?")
#: What a comma is that is a decimal one, and so between no two values.
DECIMAL = "‚"
_LETTERS = {"\t": "t", "\f": "f", "\r": "r", "\b": "b", "\v": "v", "\a": "a"}


class Unreadable(ValueError):  # noqa: N818 - it is what became of the answer
    """An answer that cannot be judged; the sentence says why and what is expected."""


class NotRead(Unreadable):
    """A text that the grammar does not know, or with names that stand for nothing."""


class Doubtful(Unreadable):
    """A text with several readings; the sentence says which."""


class Read(NamedTuple):
    """A formula: its tree, and whether it was written in another notation than Python's."""

    tree: ast.expr
    is_other: bool

    @property
    def text(self) -> str:
        """The formula in Python's notation."""
        return in_python(self.tree)


def in_python(tree: ast.expr) -> str:
    """Return the formula of a tree in Python's notation.

    >>> in_python(read("2e^(-3s)/(Ts + 1)", ["T", "s"]).tree)
    '2*e**(-3*s)/(T*s + 1)'
    """
    return re.sub(r" (\*\*|[*/]) ", r"\1", ast.unparse(tree))


@functools.cache
def parser() -> lark.Lark:
    """Return the parser, which takes its time to be built; a decimal comma is a `DECIMAL` for it."""
    grammar = resources.files(__package__).joinpath("formula.lark").read_text(encoding="utf-8")
    names = {"UNIT": lambda unit: unit.update(type="NAME")}
    return lark.Lark(grammar, parser="lalr", propagate_positions=True, lexer_callbacks=names)


def read(text: str, symbols: Collection[str] | None, time: str = "") -> Read:
    """Return a formula in some symbols; of any symbols where these are None.

    A time in the text may have a unit, as in "0 for t < 3 min", where the unit of t is known.

    Raises Unreadable in a sentence, and Doubtful where the text may mean several things.

    >>> read("0 for t < 3, 2t for t > 3", ["t"]).text
    'Piecewise((0, t < 3), (2*t, True))'
    >>> read("K/(T*s + 1)", ["s"])
    Traceback (most recent call last):
    exercisebook.grammar.NotRead: 'K' is not a symbol of this answer: expected an expression in s
    """
    if not text.strip():
        raise Unreadable(f"the text is empty: {_expected(symbols)}")
    return _read(text, None if symbols is None else tuple(symbols), time)


@functools.lru_cache(maxsize=500)  # mistakes and other numbers have the same formula
def _read(text, symbols, time):
    return in_either(text, lambda line, commas: Reader(line, symbols, commas, time).read())


def in_either(text: str, reading: Callable[[str, bool], Any]) -> Any:
    """Return what a text is read as, in one line, where commas are between values, or else are decimal ones.

    Raises Unreadable where it is neither.
    """
    if len(text) > LONGEST:
        raise Unreadable(f"the text has {len(text)} characters: expected at most {LONGEST}")
    line = " ".join(_ESCAPED.sub(lambda made: "\\" + _LETTERS[made[0]], text).split())
    problems = []
    for commas in (False, True) if "," in line else (False,):
        try:
            return reading(line, commas)
        except Doubtful:
            raise
        except Unreadable as problem:
            problems.append(problem)
        except RecursionError:
            raise Unreadable("the expression is very long: expected a simpler one") from None
    raise problems[0]


def _expected(symbols):
    return "expected an expression" + (f" in {listed(symbols)}" if symbols else "")


#: What the grammar makes of a part of the text.
Element = lark.Token | lark.Tree


class Part(NamedTuple):
    """A factor, and what it is: number, name, e, group, call, or power."""

    tree: ast.expr
    kind: str
    start: int
    end: int


class Reader:
    """Of one text."""

    def __init__(self, text: str, symbols: Collection[str] | None, commas: bool, time: str = ""):
        self.time = time
        self.text, self.symbols, self.commas = text, symbols, commas
        self.known = set(symbols or ())
        self.constants = CONSTANTS.keys() - self.known
        self.is_other = commas
        self.doubt = ""  # on what Python reads in one way, and people in another

    def parsed(self) -> lark.Tree:
        """The parse tree of the text."""
        try:
            found = parser().parse(re.sub(r"(?<=\d),(?=\d)", DECIMAL, self.text) if self.commas else self.text)
        except lark.UnexpectedInput as problem:
            raise NotRead(self._unexpected(problem)) from None
        self._clear_commas(found)
        return found

    def read(self) -> Read:
        """The formula, with a sentence where it is none."""
        tree = self._start(self.parsed())
        if self.doubt and self.is_other:
            raise Doubtful(self.doubt)
        if isinstance(tree, ast.Compare) or isinstance(getattr(tree, "op", None), ast.BitAnd | ast.BitOr):
            raise Unreadable(f"{shortened(self.text)} compares: {_expected(self.symbols)}")
        if sum(1 for _ in itertools.islice(ast.walk(tree), MOST_NODES + 1)) > MOST_NODES:
            raise Unreadable("the expression is very long: expected a simpler one")
        return Read(tree, self.is_other)

    def _unexpected(self, problem):
        place = problem.pos_in_stream
        if place is None or not 0 <= place < len(self.text) or getattr(problem, "token", None) == "":
            return f"{shortened(self.text)} ends too early: {_expected(self.symbols)}"
        if self.text[place] == "#":
            return "there is a # in the formula: expected the formula alone"
        rest = shortened(self.text[place:], 20)
        return f"{shortened(self.text)} cannot be read from {rest!r} on: {_expected(self.symbols)}"

    def _clear_commas(self, parsed):
        """Raise Doubtful for 1,500, which few write with zeros at the end, unless another comma is a decimal one."""
        numbers = [leaf for leaf in leaves(parsed) if leaf.type == "NUMBER" and re.fullmatch(rf"\d+{DECIMAL}\d+", leaf)]
        if numbers and all(re.fullmatch(rf"(?!0+{DECIMAL})\d{{1,3}}{DECIMAL}[0-9]00", number) for number in numbers):
            whole, part = numbers[0].split(DECIMAL)
            raise Doubtful(f"{whole},{part} may be {whole}.{part} or {whole}{part}: write the decimal comma as a point")

    # A formula, perhaps in pieces.

    def _start(self, parsed):
        *sides, last = parsed.children
        if last.data == "within":
            raise Unreadable(f"there is a ± in the formula: {_expected(self.symbols)}")
        if sides and ":" in self.text and not is_name(sides[0]):
            raise NotRead(f"{shortened(self.text)} cannot be read: {_expected(self.symbols)}")
        for side in sides:
            names = {self._spelled(leaf) for leaf in leaves(side) if leaf.type == "NAME"} - {"s", "t"}
            if (names and names <= self.known) or not is_name(side):
                raise Unreadable(f"{self._quoted(side)} is no name of a quantity: expected one formula alone")
        return self._pieces(last)

    def _pieces(self, parsed):
        """One value, or a function in pieces, which is said for all times."""
        if len(parsed.children) == 1 and parsed.children[0].data not in ("during", "during_and_rest", "rest"):
            return self.tree(parsed.children[0])
        told: list[tuple[ast.expr, Any]] = []  # of each piece its value and its times; None for the others
        for piece in map(_with_times, parsed.children):
            match piece.data, piece.children:
                case "rest", [value]:
                    told.append((self.tree(value), None))
                case "during" | "during_and_rest", [value, times, *rest]:
                    told += [(self.tree(value), self._times(times)), *((self.tree(one), None) for one in rest)]
                case _:
                    tree = self.tree(piece)
                    if not (told and isinstance(tree, ast.Compare)):
                        told.append((tree, ...))
                    else:  # 2t, t > 3, and: for 3 < t and t < 5
                        value, times = told[-1]
                        told[-1] = value, tree if times is ... else ast.BinOp(times, ast.BitAnd(), tree)
        if "t" not in self.known and any(times is not ... for _, times in told):
            raise NotRead(f"{shortened(self.text)} cannot be read: {_expected(self.symbols)}")
        if any(times is ... for _, times in told) or len(told) > MOST_PIECES:
            raise Unreadable("there is a comma between two values: expected one expression, with a decimal point")
        return self._in_pieces(told)

    def _times(self, parsed):
        """The condition of a piece: while, until or since a time."""
        (condition,) = parsed.children
        if parsed.data == "while":
            return self.tree(condition)
        return ast.Compare(ast.Name("t"), [ast.Lt() if parsed.data == "until" else ast.GtE()], [self._time(condition)])

    def _in_pieces(self, told):
        self.is_other = True
        rest = [value for value, times in told if times is None]
        pieces = sorted(((*_interval(times), value, times) for value, times in told if times), key=lambda one: one[1])
        if len(rest) > 1 or not pieces:
            raise Unreadable("a piece of the function has no times: expected, as in: 0 for t < 3, ... for t > 3")
        first, last = min(piece[0] for piece in pieces), pieces[-1][1]
        if not rest and first > 0:
            told = f"0 for t < {first:g}, ... for t > {first:g}"
            raise Unreadable(f"what is it before t = {first:g}? Add it, as in: {told}")
        for (_, end, *_), (begin, *_) in itertools.pairwise(pieces):
            if not rest and begin > end:
                raise Unreadable(f"what is it from t = {end:g} to {begin:g}? Add it, as in: ... for t > {end:g}")
        if not rest and last < math.inf:
            raise Unreadable(f"what is it after t = {last:g}? Add it, as in: ... for t > {last:g}")
        pairs = [(value, times) for _, _, value, times in pieces]
        if not rest:  # at the moment itself, where it was said for < and > alone
            rest = [pairs.pop()[0]]
        return _piecewise([*pairs, (rest[0], ast.Constant(True))]) if pairs else rest[0]

    # Conditions, sums, terms.

    def tree(self, parsed: lark.Tree) -> ast.expr:
        """The syntax tree of a part of the formula."""
        match parsed.data:
            case "condition" | "sum":
                found = self.tree(parsed.children[0])
                for sign, other in _pairs(parsed.children[1:]):
                    found = ast.BinOp(found, _OPERATORS[sign_of(sign)](), self.tree(other))
                return found
            case "comparison":
                return self._compared(parsed.children)
            case "term":
                return self._term(parsed)
            case "signed":
                sign, operand = parsed.children
                return self.tree(operand) if sign_of(sign) == "+" else negative(self.tree(operand))
            case "row":
                return product(self._row(parsed.children))
        raise NotRead(
            f"{self._quoted(parsed)} cannot be read: {_expected(self.symbols)}"
        )  # times of a piece, in a call

    def _time(self, parsed):
        """A side of a comparison, which may be a time with its unit: t < 3 s."""
        number, *unit = parsed.children
        if parsed.data != "row" or len(unit) != 1 or not is_leaf(number, "NUMBER") or unit[0] not in TIMES:
            return self.tree(parsed)
        if self.time not in TIMES:
            raise Unreadable(f"which unit {self._quoted(parsed)} is in is not known here: expected the number alone")
        return ast.Constant(_value(number) * TIMES[unit[0]] / TIMES[self.time])

    def _compared(self, children):
        """One comparison, or of three sides two."""
        sides = [self._time(side) for side in children[::2]]
        signs = [_COMPARES[_compare(sign)] for sign in children[1::2]]
        pairs = [ast.Compare(one, [sign()], [other]) for one, sign, other in zip(sides, signs, sides[1:], strict=False)]
        return functools.reduce(lambda one, other: ast.BinOp(one, ast.BitAnd(), other), pairs)

    def _term(self, parsed):
        found = self.tree(parsed.children[0])
        is_number = is_leaf(_only(parsed.children[0]), "NUMBER")
        for sign, other in _pairs(parsed.children[1:]):
            if sign == "x" and "x" in self.known:
                raise Doubtful("x may be the symbol or a sign of multiplication: set a *")
            if sign_of(sign) == "*" or other.data != "row":
                found = ast.BinOp(found, _OPERATORS[sign_of(sign)](), self.tree(other))
            else:
                below, *others = self._below(self._row(other.children), is_number, found)
                found = ast.BinOp(found, ast.Div(), below.tree)
                for part in others:
                    found = ast.BinOp(found, ast.Mult(), part.tree)
            is_number = False
        return found

    def _below(self, factors, is_number, above):
        """The factors behind a fraction bar: that which is below, and those that are not."""
        below, *others = factors
        while others and others[0].start == below.start:  # letters of one name: K/Ts
            below = joined(below, others.pop(0))
        if others:
            self._check_fraction(below, others[0], is_number)
        return below, *others

    def _check_fraction(self, below, after, is_number):
        """Raise Doubtful where a product follows a fraction and may belong below."""
        space = below.end < after.start
        if after.kind in ("power of e", "call") and (space or below.kind in ("group", "call")):
            return
        if space and (after.kind == "group" or (is_number and below.kind == "number")):
            return
        said = "(...)" if after.kind == "group" else self.text[after.start : after.end]
        bottom = self.text[below.start : below.end] if below.end - below.start < 20 else "(...)"
        says = f".../{bottom}{' ' if space else ''}{said} may be .../({bottom}*{said}) or (.../{bottom})*{said}"
        raise Doubtful(f"{says}: set brackets, or a *")

    # Rows of powers: products without their sign, and functions with what follows them.

    def _row(self, elements):
        """The factors of a row of powers."""
        waiting, factors = list(elements), []
        while waiting:
            found = self._next(waiting)
            if factors:
                self.is_other |= found[0].kind != "unit"
                self._check_product(factors[-1], found[0])
            factors += found
        return factors

    def _check_product(self, before, part):
        """Raise where a product without its sign does not go without saying."""
        space, written = before.end < part.start, self.text[before.start : before.end]
        after = self.text[part.start : part.end]
        if part.kind == "number" and not (space and written[-1] in ")]}"):
            raise Unreadable(f"between {written[-20:]!r} and {after!r} a sign is missing")
        if before.kind == "number" and "e" in written.lower() and not space:
            raise Doubtful(f"{written}{after} may be a number or a power of e: expected a * in it")

    def _next(self, waiting):
        """The factors that the first of some powers is, with those behind it that belong to it."""
        element = waiting.pop(0)
        base, exponent = _power(element)
        start, end = span(base)
        if is_leaf(base, "NUMBER"):
            return self._number(base, exponent, waiting)
        if is_leaf(base, "NAME"):
            return self._named(base, exponent, waiting)
        return [self._raised(Part(self._inside(base), "group", start, end), exponent)]

    def _inside(self, group):
        """What stands in brackets, or between the beginning and the end of cases."""
        if not group.children:
            raise Unreadable("there is nothing between two brackets: expected a value")
        if group.data == "cases":
            cases = [(value, *times) for value, _, *times in (case.children for case in group.children)]
            return self._in_pieces([(self.tree(one), self.tree(*times) if times else None) for one, *times in cases])
        return self._pieces(group.children[0])

    def _number(self, token, exponent, waiting):
        text, (start, end) = str(token), span(token)
        if text == "1" and exponent is None and self._is_step(waiting):
            return [self._call("Heaviside", waiting, start)]
        self.is_other |= " " in text or "'" in text
        if text[-1] in _PARTS:
            above, below = _PARTS[text[-1]]
            tree = ast.BinOp(ast.Constant(above + below * _value(text[:-1] or "0")), ast.Div(), ast.Constant(below))
        else:
            tree = ast.Constant(_value(text))
            base, power = _power(waiting[0]) if waiting else (None, None)
            if is_leaf(base, "NAME") and base in self.constants & {"i", "j", "I"} and base.start_pos == end:
                del waiting[0]
                tree, exponent, end = ast.Constant(complex(0, tree.value)), power, base.end_pos
        return [self._raised(Part(tree, "number", start, end), exponent)]

    def _raised(self, part, exponent, waiting=()):
        """A part with its exponent, if it has one; behind e with the names that follow without a space: e^-3s."""
        if exponent is None:
            return part
        first, *others = exponent.children
        end = span(exponent)[1]
        if first.type == "RAISED":
            try:
                power = int(first.translate(_RAISED))
            except ValueError:
                raise Unreadable(f"{str(first)!r} is no exponent: expected a number") from None
            tree = ast.Constant(power) if power >= 0 else ast.UnaryOp(ast.USub(), ast.Constant(-power))
        else:
            signs = [one for one in others if is_leaf(one, "SIGN")]
            atom, *more = others[len(signs) :]
            factors = self._next([atom])
            is_run = part.kind == "e" and not more and isinstance(atom, lark.Token)
            while is_run and waiting and self._goes_on(waiting, end):
                self.is_other = True
                factors += self._next(waiting)
                end = factors[-1].end
            if more:
                factors[-1] = self._raised(factors[-1], more[0])
            if len(factors) > 1 and not is_run:
                raise Doubtful(f"the exponent {self.text[factors[0].start : end]} needs brackets")
            is_negative = [sign_of(sign) for sign in signs].count("-") % 2
            follows = waiting or re.match(r" ?/ ?[^( ]", self.text[end:])
            if is_run and follows and (is_negative or len(factors) > 1):
                run = "*".join(self.text[one.start : one.end] for one in factors)
                self.doubt = f"the exponent of e needs brackets: e^({'-' if is_negative else ''}{run}...)"
            tree = negative(product(factors)) if is_negative else product(factors)
        kind = "power of e" if part.kind == "e" else "power"
        return Part(ast.BinOp(part.tree, ast.Pow(), tree), kind, part.start, end)

    def _goes_on(self, waiting, end):
        """Whether a name follows here, which is no function."""
        base, _ = _power(waiting[0])
        is_name = is_leaf(base, "NAME") and base.start_pos == end and not self._function(base)
        return is_name and not is_group(waiting[1:2])

    def _squared(self, function, exponent):
        """The exponent behind the name of a function, sin²; None where there is none."""
        if exponent is None:
            return None
        power = self._raised(Part(ast.Name(function), "name", 0, 0), exponent).tree.right
        if not isinstance(power, ast.Constant) or power.value not in range(2, 10):
            raise Doubtful(f"{function}^... may be a power or the inverse function: set brackets")
        self.is_other = True
        return power

    # Names.

    def _spelled(self, token):
        """A name as the symbols are spelled: K_p for K_{p}, x_2 for x₂, tau for τ."""
        name = re.sub(r"^(?:np|numpy|math|cmath|sympy|sp)\.", "", token)
        if name in self.known:
            return name
        name = UPRIGHT.sub(r"\1", name)
        name = re.sub("[₀-₉]+", lambda low: "_" + low[0].translate(_LOWERED), name)
        name = re.sub(r"_\{? *(\w+) *\}?", r"_\1", name.removeprefix("\\")).removeprefix("var")
        if "Ͱ" <= name[0] <= "Ͽ" and name[0] not in "".join(self.known):
            name = unicodedata.name(name[0]).split()[-1].lower() + name[1:]
        return OTHER_NAMES.get(name, name) if name not in self.known else name

    def _function(self, token):
        """The function that a name is; None for another name."""
        name = self._spelled(token)
        is_function = name in (*ONE_VALUE, *SEVERAL_VALUES, "frac") and name not in self.known
        return name if is_function else None

    def _named(self, token, exponent, waiting):
        """The factors of a name: a function with its value, a symbol, or several."""
        name, (start, end) = self._spelled(token), span(token)
        if name not in self.known and name in STEPS and exponent is None and self._is_step(waiting):
            return [self._call("Heaviside", waiting, start)]
        if self._function(token):
            return self._of_function(name, exponent, waiting, start)
        before, function = self._ending_in_function(name, exponent, waiting)
        names = self._symbols(before, start, end)
        if function:
            self.is_other = True
            if function != "e":
                return [*names, *self._of_function(function, exponent, waiting, start)]
            names.append(Part(ast.Name("e"), "e", end - 1, end))
        *others, last = names
        if exponent is not None:
            return [*others, self._raised(last, exponent, waiting)]
        if is_group(waiting[:1]):
            self._check_call(name, last, waiting)
        return names

    def _check_call(self, name, last, waiting):
        """Take the time behind a signal, u(t), which is a symbol here; raise where a bracket may be a call."""
        leaf = _only_leaf(waiting[0])
        if last.kind == "e":
            raise Doubtful("a power of e has a ^: write e^(...) or exp(...)")
        if self.symbols is None and len(name.partition("_")[0]) > 1 and not leaf:
            raise Unreadable(f"{shortened(name, 30)!r} is not a known function: expected exp, log, sqrt, sin ...")
        if leaf in ("t", "s") and leaf in self.known:
            raise Doubtful(f"{name}({leaf}) may be a product or a function: write {name}*{leaf}")
        if leaf in ("t", "s"):
            del waiting[0]

    def _ending_in_function(self, name, exponent, waiting):
        """A name that ends in a function, or in e before its exponent, in its two parts: texp(-t), Ke^(-s)."""
        if self.symbols is None or self._readings(name):
            return name, ""
        ends = ["e"] if exponent is not None else []
        if is_group(waiting[:1]) and exponent is None:
            ends += sorted((*ONE_VALUE, *SEVERAL_VALUES), key=len, reverse=True)
        for function in ends:
            before = name.removesuffix(function)
            if before and before != name and self._readings(before):
                return before, function
        return name, ""

    def _is_step(self, waiting):
        """Whether a bracket with the time follows: u(t - 3) is a step."""
        if "t" not in self.known or not is_group(waiting[:1]):
            return False
        inside = list(leaves(waiting[0]))
        return bool(inside) and inside[0] == "t" and (len(inside) == 1 or inside[1].type == "SIGN")

    def _of_function(self, function, exponent, waiting, start):
        """A function, with its value in brackets or without."""
        if function == "sqrt" and waiting and self.text[start] == "\\" and self.text[span(waiting[0])[0]] == "[":
            raise Unreadable("a root other than the square root is a power: x^(1/3)")
        if function == "frac":
            return [self._fraction(waiting, start)]
        power = self._squared(function, exponent)
        part = (self._call if is_group(waiting[:1]) else self._applied)(function, waiting, start)
        return [part if power is None else part._replace(tree=ast.BinOp(part.tree, ast.Pow(), power), kind="power")]

    def _call(self, function, waiting, start):
        """A function of what stands in the brackets behind it."""
        group, exponent = _power(waiting.pop(0))
        if not group.children:
            raise Unreadable(f"{function} has no arguments: expected at least one")
        pieces = group.children[0].children
        values = [self._pair(piece) if function == "Piecewise" else self.tree(piece) for piece in pieces]
        if function in ONE_VALUE and len(values) != 1:
            raise Unreadable(f"{function} has {len(values)} arguments: expected one")
        if function == "Heaviside" and len(values) > 1 and not _is_value_at_zero(values[1]):
            raise Unreadable(f"{self._quoted(group)} has a comma in it: expected one value, with a decimal point")
        match function, values:
            case "Piecewise", [*pairs, (value, condition)]:
                tree = _piecewise([*pairs, (value, _going_on(condition) if pairs else condition)])
            case "where", [condition, value, other]:
                tree = _piecewise([(value, condition), (other, ast.Constant(True))])
            case "where", _:
                raise Unreadable("where has a condition and two values: expected where(t < 3, ..., ...)")
            case _:
                tree = ast.Call(ast.Name(function), values, [])
        return self._raised(Part(tree, "call", start, span(group)[1]), exponent)

    def _pair(self, piece):
        """A value and the condition on which it holds."""
        pair = _only(piece)
        if not is_group([pair]) or len(pair.children[0].children) != 2:
            raise Unreadable(f"{self._quoted(piece)} cannot be read: expected pairs of a value and a condition")
        value, condition = pair.children[0].children
        return self.tree(value), ast.Constant(True) if _only_leaf(condition) == "True" else self.tree(condition)

    def _fraction(self, waiting, start):
        """A fraction of LaTeX: of two groups, or of two digits."""
        self.is_other = True
        if waiting and is_leaf(waiting[0], "NUMBER") and re.fullmatch(r"\d\d", waiting[0]):
            digits = waiting.pop(0)
            above, below = map(ast.Constant, map(int, digits))
            return Part(ast.BinOp(above, ast.Div(), below), "group", start, digits.end_pos)
        if not is_group(waiting[:1]) or not is_group(waiting[1:2]):
            raise Unreadable(f"\\frac lacks what is above or below: {_expected(self.symbols)}")
        above, (below, exponent) = waiting.pop(0), _power(waiting.pop(0))
        tree = ast.BinOp(self._inside(above), ast.Div(), self._inside(below))
        return self._raised(Part(tree, "group", start, span(below)[1]), exponent)

    def _applied(self, function, waiting, start):
        """A function without brackets: sin 3t, ln 2."""
        needs = Doubtful(f"{function} needs brackets: {function}(...)")
        if function in SEVERAL_VALUES or not waiting:
            raise needs
        self.is_other = True
        run, root = [], function == "sqrt"
        if self._is_function(waiting[0], "frac"):
            run = self._next(waiting)
        while waiting and isinstance(_power(waiting[0])[0], lark.Token) and not self._is_function(waiting[0]):
            space = run and run[-1].end < span(waiting[0])[0] and not (len(run) == 1 and run[0].kind == "number")
            if run and (is_leaf(waiting[0], "NUMBER") or root or space):
                break
            run += self._next(waiting)
        if root and run and waiting and run[-1].end == span(waiting[0])[0]:
            raise Doubtful("a root of a product needs brackets: sqrt(...)")
        if not run or (waiting and not self._is_function(waiting[0])):
            raise needs
        if not root and re.match(r" ?[/*·^]", self.text[run[-1].end :]):
            raise needs
        return Part(ast.Call(ast.Name(function), [product(run)], []), "call", start, run[-1].end)

    def _is_function(self, element, one=""):
        """Whether an element is the name of a function, or of this one."""
        base, _ = _power(element)
        function = self._function(base) if is_leaf(base, "NAME") else None
        return function == one if one else function is not None

    def _symbols(self, name, start, end):
        """The parts that a name stands for: a symbol, a constant, or a product of them."""
        if name in self.known or name in self.constants or self.symbols is None:
            return [Part(ast.Name(name), "e" if name in ("e", "E") and name not in self.known else "name", start, end)]
        if (imaginary := re.fullmatch(r"[ij](\d+)", name)) and name[0] in self.constants:
            self.is_other = True
            return [Part(ast.Constant(complex(0, int(imaginary[1]))), "number", start, end)]
        readings = self._readings(name)
        if not readings:
            raise NotRead(self._unknown(name, self.text[end : end + 1] == "("))
        if len(readings) > 1:
            several = " or ".join("*".join(one) for one in readings[:2])
            raise Doubtful(f"{name!r} may be {several}: set a * or a space")
        self.is_other = True
        return [Part(ast.Name(one), "name", start, end) for one in readings[0]]

    def _unknown(self, name, is_called):
        if is_called:
            hint = did_you_mean(name, (*ONE_VALUE, *SEVERAL_VALUES), otherwise="expected exp, log, sqrt, sin ...")
            return f"{shortened(name, 30)!r} is not a known function: {hint}"
        if not self.symbols:
            return f"{shortened(name, 30)!r} stands for no number: expected a value without symbols"
        hint = did_you_mean(name, self.symbols, otherwise=f"expected an expression in {listed(self.symbols)}")
        return f"{shortened(name, 30)!r} is not a symbol of this answer: {hint}"

    def _readings(self, name):
        """The products of symbols that a name may stand for, each once: [["T", "s"]] for Ts."""
        if self.symbols is None or name in self.known or name in self.constants:
            return [[name]]
        if len(name) > LONGEST_NAME:
            return []
        spelled: dict[str, set[str]] = {}
        for symbol in (*self.symbols, *({"pi"} & self.constants)):
            for form in {symbol, symbol.replace("_", "")} | ({bare(symbol)} if len(symbol) > 1 else set()):
                spelled.setdefault(form, set()).add(symbol)
        alone = {one for form in {name, name.replace("_", "")} for one in spelled.get(form, ())}
        if not alone and len(name) > 1:
            same = {bare(name), SAME_LETTERS.get(bare(name))}
            alone = {symbol for symbol in self.symbols if len(symbol) > 1 and bare(symbol) in same}
        found = {(one,): [one] for one in sorted(alone)}
        steps = iter(range(MOST_READINGS))
        for parts in _split(name, {form: sorted(ones) for form, ones in spelled.items()}, steps):
            found.setdefault(tuple(sorted(parts)), parts)
            if len(found) > 2:
                break
        return list(found.values())

    def _quoted(self, parsed):
        """The part of the text that a tree was read from."""
        start, end = span(parsed)
        return shortened(self.text[start:end])


# What a parsed tree is.


def is_leaf(parsed: Any, kind: str) -> bool:
    """Whether this is a token of a kind."""
    return isinstance(parsed, lark.Token) and parsed.type == kind


def is_group(elements: Sequence[Element]) -> bool:
    """Whether the first of some powers is a group, perhaps with an exponent."""
    return bool(elements) and isinstance(base := _power(elements[0])[0], lark.Tree) and base.data == "group"


def _power(element):
    """The base of a power and its exponent, which is None where it has none."""
    if isinstance(element, lark.Tree) and element.data == "raised":
        return element.children
    return element, None


def span(parsed: Element) -> tuple[int, int]:
    """Where a part of the text begins and ends."""
    where = parsed if isinstance(parsed, lark.Token) else parsed.meta
    return where.start_pos, where.end_pos


def leaves(parsed: Element) -> Iterable[lark.Token]:
    """The tokens in an element, in their order."""
    return [parsed] if isinstance(parsed, lark.Token) else parsed.scan_values(lambda _: True)


def _only(parsed):
    """The only element of a row; the tree itself where there are several."""
    is_row = isinstance(parsed, lark.Tree) and parsed.data == "row" and len(parsed.children) == 1
    return parsed.children[0] if is_row else parsed


def _only_leaf(parsed):
    found = list(leaves(parsed))
    return found[0] if len(found) == 1 else None


def is_name(side: lark.Tree) -> bool:
    """Whether this is the name of a quantity before its =: y(t), dh/dt, Y(s)/U(s) [K], h - h_SP."""
    (found, *others) = side.children
    is_pair = found.data in ("sum", "term") and len(found.children) == 3 and found.children[1] in ("/", "-", "−", "–")
    rows = found.children[::2] if is_pair else [found]
    return not others and all(row.data == "row" and _names_one(row.children) for row in rows)


def _names_one(elements):
    """Whether this is one name, as it is called: y, y(t), y [K] or \\dot{y}."""
    first, *others = elements
    if first in ("\\dot", "\\ddot") and others and is_leaf(others[0], "NAME"):
        first, *others = others
    is_name = is_leaf(_power(first)[0], "NAME") and first != "lambda"
    return is_name and all(is_group([one]) or str(one).startswith("_") for one in others)


def last_row(parsed: Element) -> lark.Tree | None:
    """The row with which a part of the formula ends; None where there is none."""
    while isinstance(parsed, lark.Tree) and parsed.data != "row" and parsed.children:
        parsed = parsed.children[-1]
    return parsed if isinstance(parsed, lark.Tree) and parsed.data == "row" else None


def _with_times(piece):
    """A piece whose times stand in brackets behind its value: 2t (t > 3)."""
    row = last_row(piece)
    if piece.data not in ("during", "during_and_rest", "rest") and row and is_group(row.children[1:][-1:]):
        inside = row.children[-1].children
        if inside and len(inside[0].children) == 1 and inside[0].children[0].data == "comparison":
            row.children.pop()
            return lark.Tree("during", [piece, lark.Tree("while", inside[0].children)])
    return piece


def _pairs(children):
    return list(zip(children[::2], children[1::2], strict=True))


def sign_of(token: lark.Token) -> str:
    """The sign of an operation, as Python writes it."""
    if token.type == "SIGN":
        return "+" if token in ("+", "plus") else "-"
    return "/" if token in ("/", "÷", "∕", "⁄", "\\div", "per", ":") else str(token) if token in ("&", "|") else "*"


def _compare(token):
    word = token.removeprefix("\\")
    return {"le": "<=", "leq": "<=", "≤": "<=", "ge": ">=", "geq": ">=", "≥": ">="}.get(word, word)


# Parts of syntax trees.


def joined(part: Part, other: Part) -> Part:
    """Two factors in one."""
    return part._replace(tree=ast.BinOp(part.tree, ast.Mult(), other.tree), end=other.end)


def product(parts: Iterable[Part]) -> ast.expr:
    """The tree of a product."""
    return functools.reduce(lambda one, other: ast.BinOp(one, ast.Mult(), other), [part.tree for part in parts])


def negative(tree: ast.expr) -> ast.expr:
    """A product with the other sign, which is that of its first factor, as Python has it: -2*s."""
    match tree:
        case ast.BinOp(left, ast.Mult() | ast.Div(), _):
            tree.left = negative(left)
            return tree
    return ast.UnaryOp(ast.USub(), tree)


def _value(text):
    """A number, with a decimal comma or separators of thousands where these are clear."""
    text = text.replace(DECIMAL, ",")
    if re.fullmatch(r"\d{1,3}(?:,\d{3})+\.\d+|\d{1,3}(?:,\d{3}){2,}", text):
        text = text.replace(",", "")
    elif re.fullmatch(r"\d{1,3}(?:\.\d{3})+,\d+|\d{1,3}(?:\.\d{3}){2,}", text):
        text = text.replace(".", "")
    text = re.sub("[ ']", "", text).replace(",", ".")
    if len(text) > 1 and text[0] == "0" and text.isdigit() and text.strip("0"):
        raise Unreadable(f"{text!r} is no number")
    try:
        value = int(text) if text.isdigit() else float(text)
        if not math.isfinite(value):
            raise OverflowError
    except OverflowError:
        raise Unreadable("a number in the expression is out of range: expected a simpler one") from None
    except ValueError:
        raise Unreadable(f"{shortened(text)!r} is no number: expected one, with a decimal point") from None
    return value


def _piecewise(pairs):
    return ast.Call(ast.Name("Piecewise"), [ast.Tuple(list(pair), ast.Load()) for pair in pairs], [])


def _going_on(condition):
    """The condition of the last piece, without its end, as in 20 < t < 45: the end is that of what is asked."""
    match condition:
        case ast.Compare(ast.Name(), [ast.Lt() | ast.LtE()], [_]):
            return ast.Constant(True)
        case ast.BinOp(begin, ast.BitAnd(), ast.Compare(ast.Name(), [ast.Lt() | ast.LtE()], [_])):
            return begin
    return condition


def _interval(times):
    """Between which times a condition holds."""
    match times:
        case ast.BinOp(one, ast.BitAnd(), other):
            (begin, end), (other_begin, other_end) = _interval(one), _interval(other)
            return max(begin, other_begin), min(end, other_end)
        case ast.Compare(ast.Name("t"), [sign], [ast.Constant(time)]):
            return (-math.inf, time) if isinstance(sign, ast.Lt | ast.LtE) else (time, math.inf)
        case ast.Compare(ast.Constant(time), [sign], [ast.Name("t")]):
            return (-math.inf, time) if isinstance(sign, ast.Gt | ast.GtE) else (time, math.inf)
    raise Unreadable("the times of a piece are no comparison of t with a number: expected, as in: 0 for t < 3")


def _is_value_at_zero(node):
    """Whether this may be the second value of a step, as SymPy has one: where it is 0."""
    return not isinstance(node, ast.Constant) or node.value in (0, 0.5, 1)


def _split(name: str, spelled: dict[str, list[str]], steps: Iterator[int]) -> Iterator[list[str]]:
    """The ways in which a name is a row of symbols; of so many steps."""
    if next(steps, None) is None:
        return
    if not name:
        yield []
    for form, symbols in spelled.items():
        # a digit belongs to the letter before it
        if name.startswith(form) and not name[len(form) :][:1].isdigit() and not name[len(form) :].startswith("_"):
            for rest in _split(name[len(form) :], spelled, steps):
                for symbol in symbols:
                    yield [symbol, *rest]


def bare(name: str) -> str:
    """A name without case and underscores, and with Greek letters spelled out.

    >>> bare("τ_1"), bare("T_SP")
    ('tau1', 'tsp')
    """
    letters = (
        unicodedata.name(letter, letter).split()[-1] if "Ͱ" <= letter <= "Ͽ" else letter
        for letter in unicodedata.normalize("NFKC", name)
    )
    return "".join(letters).replace("_", "").replace(" ", "").casefold()


def shortened(text: str, length: int = 60) -> str:
    """The text, or its beginning."""
    return text if len(text) <= length else text[: length - 3] + "..."


def listed(names: Collection[str]) -> str:
    """Names in a sentence.

    >>> listed(["K", "T", "s"])
    'K, T and s'
    """
    *others, last = names
    return f"{', '.join(others)} and {last}" if others else last
