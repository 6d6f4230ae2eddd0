"""Expressions, and functions of time."""

from __future__ import annotations

import functools
import re
from collections.abc import Iterator, Sequence
from typing import TYPE_CHECKING, Any, Self

import numpy as np
import sympy

from exercisebook import units
from exercisebook.agreement import agree, agree_in_time
from exercisebook.formulas import Formula, is_number
from exercisebook.grammar import Unreadable, in_python, listed, shortened
from exercisebook.kinds.kind import AS_IT_IS, LINE, Kind, Tried, how_rounded, literal, rounded, with_unit
from exercisebook.kinds.numeric import in_unit
from exercisebook.points import points_for, times_for
from exercisebook.quantities import quantities
from exercisebook.reading import alone, answered, symbols_in
from exercisebook.wholes import WHOLES
from plainmath.expressions import exact, parse

if TYPE_CHECKING:
    from plainmath.types import Number


#: At about so many points an answer is looked at first; it may be off by this fraction, at this part of them by more.
FEW, FIRST_LOOK, MOST_OFF = 15, 0.1, 0.3
#: Of a formula that is shown as it was read, so many characters.
LONGEST_SHOWN = 120


class Expression(Kind):
    """An expression in symbols, equal in any form; its numbers may be rounded.

    Arguments:
        key: an expression, or a text that spells one.
        symbols: that an answer may have, all of the key's among them; a notebook that is handed out tells a wrong one.
            Those of the key, if not given: what symbols there are is then a part of the answer.
        real: those that may be negative, as "v x"; others are positive. Of a key of SymPy's, its symbols with
            ``real=True`` are as well.
    Raises:
        ValueError: for a key with a symbol that is not among them, and where it has the sign or size of one that is
            not said to be of either sign.

    >>> R = Expression("R_1*R_2/(R_1 + R_2)", "the resistance of both")
    >>> R.agrees(R.read("1/(1/R1 + 1/R2)")[0])
    True
    """

    def __init__(
        self,
        key: Number | str,
        what: str = "the expression",
        symbols: str = "",
        within: float = 0.01,
        unit: str = "",
        real: str = "",
    ):
        self.expr = _expression(key, real)
        self.real = real or " ".join(sorted(one.name for one in self.expr.free_symbols if _is_of_either_sign(one)))
        names, self._told = {symbol.name for symbol in self.expr.free_symbols}, symbols
        self.symbols = sorted(self.always.union(symbols.split() or names))
        if beyond := sorted(names.difference(self.symbols)):
            raise ValueError(f"the key has the symbol {beyond[0]}: expected only {listed(self.symbols)}")
        if unknown := sorted({*real.split()} - {*self.symbols}):
            raise ValueError(f"real has {unknown[0]}: expected some of {listed(self.symbols)}")
        super().__init__(self.expr, unit, what, within)

    ANY_FORM, EACH = "in any form, ", "each number in it "
    expr: sympy.Expr | None
    always: frozenset[str] = frozenset()
    #: Without a key, any symbol may occur.
    symbols: Sequence[str] | None = None
    _told = real = time = ""
    _points: dict[str, np.ndarray] | None = None

    @classmethod
    def without_key(cls, *parts: Any, symbols: str = "", **named: Any) -> Self:
        """Return a kind that reads answers; in the symbols that the author has told, or in any."""
        kind = super().without_key(*parts, **named)
        if symbols:
            kind._told, kind.symbols = symbols, sorted(cls.always.union(symbols.split()))
        return kind

    @property
    def asking(self) -> str:
        """The call that makes a kind of this form, with the symbols that the author has told."""
        call = super().asking[:-1]
        told = f"{'' if call.endswith('(') else ', '}symbols={literal(self._told)}" if self._told else ""
        return f"{call}{told})"

    @property
    def making(self) -> str:
        """The call that makes this kind with its key, a text; empty for a formula that `parse` does not read."""
        try:
            is_read = self.is_value(self.key, str(self.expr))
        except ValueError:
            is_read = False
        return super().making if is_read else ""

    def _argument(self, name):
        return " ".join(self.symbols) if name == "symbols" else super()._argument(name)

    def as_code(self, answer: Any = None) -> str:
        """The text of the formula. Raises ValueError for a function of the reader's."""
        formula = self.key if answer is None else answer
        if not isinstance(formula, Formula):
            raise ValueError("the answer is a function of the reader's: expected an expression")
        return literal(formula.text)

    def like(self, value: Any) -> Self:
        """The same quantity with another key, compared at the same points."""
        self.points()
        other = super().like(value)
        other.expr = None if isinstance(value, Formula) else _expression(value, self.real)
        return other

    @property
    def expected(self) -> str:
        """An expression in its symbols."""
        return f"an expression in {', '.join(self.symbols)}" if self.symbols else "an expression"

    def read(self, given: object) -> tuple[Formula, str]:
        """Return the `Formula`; without a key, also a remark on its symbols."""
        given = answered(given)
        if isinstance(given, Formula):
            return given, ""
        given = alone(given)
        if isinstance(given, dict):  # something whole, as data
            given = next((one for whole in WHOLES if (one := whole.of_data(given)) is not None), given)
        used = symbols_in(given) if self.symbols is None else ()
        formula, remark = self._formula(
            given, sorted(self.always.union(used)) if self.symbols is None else self.symbols
        )
        self._demand_values(formula)
        return formula, ", ".join(one for one in (f"an expression in {listed(used)}" if used else "", remark) if one)

    def _formula(self, given, symbols):
        """The formula, where a text may end in its unit or have units behind its numbers, and a remark."""
        try:
            formula = Formula(given, symbols, self.time)
            return formula, formula.remark
        except Unreadable as problem:
            if not isinstance(given, str):
                raise
            for text, unit in _with_units(given):
                if any(re.search(rf"(?<![/(])\b{symbol}\b", unit) for symbol in symbols):  # a factor, perhaps
                    continue
                try:
                    formula = Formula(text, symbols)
                except Unreadable:
                    continue
                return self._in_asked_unit(formula, unit)
            return self._of_quantities(given, symbols, problem)

    def _of_quantities(self, given, symbols, problem):
        """A formula of numbers with units, in the asked one; raises the problem that it is without units."""
        if not (self.unit or self.time) or not {*symbols} <= {"t"}:
            raise problem
        try:
            *_, quantity = quantities(given, symbols)
            if not quantity.units:
                raise problem
            text = in_python(quantity.in_unit(self.unit, self.time))
        except Unreadable:
            raise problem from None
        except ValueError as error:
            raise Unreadable(f"{error}: expected {self.expected}") from None
        return Formula(text, symbols), f"read as {text}"

    def _in_asked_unit(self, formula, unit):
        """A formula whose text ends in a unit, in the asked one."""
        if not self.unit:
            raise Unreadable(f"the text ends in {unit}: expected {self.expected}, without a unit")
        try:
            zero, factor = (units.convert(value, unit, to=self.unit) for value in (0, 1))
        except ValueError as error:
            raise Unreadable(f"{error}: expected {self.expected}") from None
        if zero:
            raise Unreadable(f"the text is in {unit}, and asked is {self.unit}: expected {self.expected}")
        if factor == 1:
            return formula, formula.remark
        return Formula(f"({formula.text})*{factor!r}", formula.symbols), f"converted from {unit}"

    def as_read(self, answer: Any) -> str:
        """The formula in Python's notation; of a function of the reader's, nothing."""
        return shortened(answer.text, LONGEST_SHOWN) if isinstance(answer, Formula) else ""

    def written(self, answer: Any) -> str:
        """The expression with its unit."""
        return with_unit(answer.text, self.unit)

    @property
    def solution(self) -> str:
        """The key with its unit; fractions of many digits are decimals."""
        if self.expr is None:
            return super().solution
        long = [number for number in self.expr.atoms(sympy.Rational) if number.q > 1000]
        return with_unit(str(self.expr.xreplace({number: sympy.Float(number, 8) for number in long})), self.unit)

    @property
    def shown(self) -> sympy.Expr | str:
        """The key as an expression."""
        return self.solution if self.expr is None else self.expr

    def draw_from(self, seed: str) -> None:
        """Draw the points of comparison from a text."""
        super().draw_from(seed)
        self._points = None

    def points(self) -> dict[str, np.ndarray]:
        """The values of the symbols at which formulas are compared, the same for other keys, as mistakes have them."""
        if self._points is None:
            self._points = self._drawn_points()
        return self._points

    def _drawn_points(self):
        return points_for(self.key, self.seed, self.real.split())

    @property
    def precision(self) -> str:
        """As of other quantities, and what the symbols may be."""
        symbols = [name for name in self.symbols or () if name not in ("s", "t")]
        signs = f"{listed(self.real.split())} of either sign" if self.real else "for positive symbols"
        return super().precision + (f", {signs}" if symbols and super().precision else "")

    def _demand_values(self, formula):
        usual = _usual_points(tuple(formula.symbols))
        if np.isfinite(formula(**usual)).any():
            return
        points = points_for(formula)
        if not (np.isfinite(formula(**points)).any() or np.isfinite(formula.values_at(points)).any()):
            raise Unreadable(f"this has no finite value: expected {self.expected}")

    def incomparable(self, answer: Any) -> tuple[str, str]:
        """Say where an answer has no value though the key has one, or that it is no function of s as the key is."""
        if not isinstance(answer, Formula):
            return "", ""
        function = answer.decides if "s" in self.symbols and not self.key.decides else ""
        if function:
            says = f"{function} of s is in it, which is in no transfer function"
            return says, f"{says}: {shortened(answer.text, LONGEST_SHOWN)}"
        points = self.points()
        found, told = answer.told_at(points)
        missing = np.isfinite(self.key.values_at(points)) & told & np.isnan(found)
        if not missing.any():
            return "", ""
        place = tuple(np.argwhere(missing)[missing.sum() // 2])
        at = [f"{name} = {_number(np.broadcast_to(values, missing.shape)[place])}" for name, values in points.items()]
        says = f"this has no value at {', '.join(at)}, where the answer has one" if at else "this has no value"
        return says, f"{says} (at {missing.sum()} of {told.sum()} points): {shortened(answer.text, LONGEST_SHOWN)}"

    def may_agree(self, answer: Any) -> bool:
        """Whether both are near each other at a few points."""
        points = self.points()
        shape = np.broadcast_shapes(*(np.shape(values) for values in points.values())) or (1,)
        found = np.broadcast_to(answer if isinstance(answer, np.ndarray) else answer(**points), shape)
        finite = np.flatnonzero(np.isfinite(found))
        if not finite.size:
            return True
        few = finite[:: max(1, finite.size // FEW)]
        values = np.broadcast_to(
            self.key(**{name: np.broadcast_to(one, shape)[few] for name, one in points.items()}), few.shape
        )
        with np.errstate(all="ignore"):
            off = np.abs(values - found[few]) > FIRST_LOOK * np.maximum(np.abs(found[few]), 1e-12)
        return bool(np.mean(off | ~np.isfinite(values)) <= MOST_OFF)

    def agrees(self, answer: Any) -> bool:
        """Whether both have the same values, but for the rounding of numbers."""
        return agree(self.key, answer, self.points(), self.within)

    def is_value(self, answer: Any, wrong: Any) -> bool:
        """Whether an answer is the formula of a mistake; a number is none that has s, t or another symbol in it."""
        other = self.like(wrong)
        return not (_is_constant(answer) and not is_number(other.key.tree)) and other.agrees(answer)

    def mistakes(self) -> Iterator[tuple[str, Any]]:
        """Wrong sign, the inverse."""
        yield "that is right except for its sign", -self.expr
        if self.expr != 0:
            yield "that is the inverse: one divided by the answer", 1 / self.expr
        yield from self._in_other_units()

    is_personal = True

    @property
    def field(self) -> dict[str, Any]:
        """A line."""
        says = f"an expression in {', '.join(self.symbols)}" if self.symbols else "an expression"
        return {"control": LINE, "help": says, "symbols": tuple(self.symbols or ())}

    def right_forms(self) -> Iterator[Tried]:
        """The formula as an expression of SymPy, multiplied out, in one fraction, and with rounded numbers."""
        expr = self.expr
        yield AS_IT_IS, str(expr)
        yield "as an expression of SymPy", expr.xreplace({one: sympy.Symbol(one.name) for one in expr.free_symbols})
        yield "multiplied out", str(sympy.expand(expr))
        yield "in one fraction", str(sympy.together(expr))
        if (short := _with_rounded_numbers(expr, self.within)) != expr:
            yield f"with its numbers {how_rounded(self.within)}", str(short)

    def wrong_forms(self) -> Iterator[Tried]:
        """Zero, one, the other sign, a factor of ten."""
        changed = {"zero": 0, "one": 1, "with the other sign": -self.expr, "ten times as much": 10 * self.expr}
        yield from ((how, str(answer)) for how, answer in changed.items() if answer != self.expr)

    def _in_other_units(self):
        """The values in other units; a temperature in another scale is no multiple."""
        for unit, converted in units.neighbours(self.unit).items():
            if converted(0) == 0:
                yield f"those would be the values {in_unit(unit)}; asked: {self.asked}", self.expr * exact(converted(1))


def _with_rounded_numbers(expr, within):
    """An expression whose numbers are decimals of a few digits, except in powers, which are exact."""
    if isinstance(expr, sympy.Rational | sympy.Float):
        short = rounded(float(expr), within)
        return expr if expr == short or expr.is_Integer else sympy.Float(short)
    if isinstance(expr, sympy.Pow) and expr.exp.is_number:
        base = _with_rounded_numbers(expr.base, within)
        return base**expr.exp if not base.is_number else sympy.Float(rounded(float(expr), within))
    return expr.func(*(_with_rounded_numbers(one, within) for one in expr.args)) if expr.args else expr


@functools.cache
def _usual_points(symbols):
    return points_for(Formula("1", symbols))


def _is_constant(answer):
    """Whether an answer, a formula or the values of a function, is a number."""
    return bool(np.all(answer == answer[0])) if isinstance(answer, np.ndarray) else is_number(answer.tree)


def _number(value):
    """A number in a sentence."""
    value = complex(value)
    return f"{value:.3g}" if value.imag else f"{value.real:.3g}"


def _with_units(text):
    """The ways in which a text ends in a unit: pairs of what is before it and the unit, the longest unit first."""
    text = text.strip().rstrip(".")
    if bracket := re.search(r"^(.*\S) ?\[([^][]+)\]$", text):
        yield bracket[1], bracket[2]
    for place in re.finditer(r"(?<=[\w)}\]])(?: (?:in )?|(?=%$))", text):
        if 0 < len(unit := text[place.end() :]) <= 20 and units.is_unit(unit):
            yield text[: place.start()], unit


def _expression(key, real=""):
    """The key in SymPy; of a text, what it spells. Raises ValueError where it has the sign of a positive symbol."""
    if not isinstance(key, str):
        return exact(key)
    for part in parse(key, " ".join(re.findall(r"[^\W\d]\w*", key))).atoms(sympy.Abs, sympy.sign):
        for one in sorted({symbol.name for symbol in part.free_symbols} - {*real.split(), "s", "t"}):
            raise ValueError(f"the key has {part}: expected real={one!r}, as {one} would be positive without it")
    return parse(key, real)


def _is_of_either_sign(symbol):
    return symbol.is_real and symbol.is_positive is None and symbol.name not in ("s", "t")


def in_other_time(kind: Expression, variable: str) -> Iterator[tuple[str, Formula]]:
    """Yield the same with another unit of time, seconds and minutes or minutes and hours exchanged, or milliseconds."""
    for factor in (60, 3600, 1000):
        for scale in (f"{factor}", f"(1/{factor})"):
            text = re.sub(rf"\b{variable}\b", f"({scale}*{variable})", kind.key.text)
            yield "its unit of time is not the one in the question", Formula(text, kind.symbols)


class TimeFunction(Expression):
    """A function of time from t = 0 on, given as an expression in t or as a function of an array of times.

    Arguments:
        until: the end of the times at which it is compared, in the unit of t.
        time: the unit of t, which the statement says; without it, no number in an answer has a unit of time.

    >>> from plainmath.expressions import t
    >>> y = TimeFunction(1 - sympy.exp(-t / 5), until=25, what="the response")
    >>> y.agrees(y.read("1 - exp(-0.2*t)")[0])
    True
    """

    always = frozenset({"t"})
    symbols = ("t",)
    until: float | None = None
    FORM = ("unit", "time")

    def __init__(
        self,
        key: Number | str,
        until: Number,
        unit: str = "",
        what: str = "the function of time",
        within: float = 0.01,
        time: str = "",
    ):
        self.until, self.time = float(until), time
        super().__init__(key, what, "", within, unit)

    @property
    def asked(self) -> str:
        """The quantity with its unit, and the unit of t."""
        return super().asked + (f", for t in {self.time}" if self.time else "")

    @property
    def expected(self) -> str:
        """An expression in t; where there is no key, there are no times at which a function could be called."""
        other = "" if self.until is None else ", or a function of an array of times"
        return f"an expression in t{other}" + (f", in {self.unit}" if self.unit else "")

    def read(self, given: object) -> tuple[Any, str]:
        """Return the `Formula`, or of a function its values at the times of the grid."""
        is_function = callable(answered(given)) and not isinstance(given, sympy.Basic | Formula)
        if self.until is not None and is_function and not hasattr(given, "expr"):
            return self._of_function(given), ""
        return super().read(given)

    @property
    def precision(self) -> str:
        """As of an expression, and that numbers which are added may be rounded alike."""
        added = ", or to the decimal of the largest that is added" if self.within else ""
        return super().precision + added

    def written(self, answer: Any) -> str:
        """The expression with its unit, or that it is a function."""
        return "a function of an array of times" if isinstance(answer, np.ndarray) else super().written(answer)

    @property
    def times(self) -> np.ndarray:
        """The times at which functions are compared."""
        return self.points()["t"]

    def _drawn_points(self):
        return {"t": times_for(self.key, self.until, self.seed)}

    def _of_function(self, given):
        try:
            values = self._called(given)
        except Exception:  # the function is the reader's
            raise Unreadable(f"the function returns no numbers: expected {self.expected}") from None
        if not np.isfinite(values).all():
            raise Unreadable(f"the function has no finite value at some times: expected {self.expected}")
        return values

    def _called(self, given):
        """The values of a function for all times at once, or one time after another."""
        try:
            values = np.asarray(given(self.times), complex)
            if values.shape == self.times.shape:
                return values
        except Exception:  # it asks for one time
            pass
        return np.array([complex(given(float(time))) for time in self.times])

    def mistakes(self) -> Iterator[tuple[str, Any]]:
        """Wrong sign."""
        yield "that is right except for its sign", -self.expr
        yield from self._in_other_units()
        yield from in_other_time(self, "t")

    def agrees(self, answer: Any) -> bool:
        """Whether both have the same values, but for the rounding of numbers."""
        return agree_in_time(self.key, answer, self.points(), self.within)
