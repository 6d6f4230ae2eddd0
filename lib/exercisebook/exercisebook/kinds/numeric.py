"""Numbers, rows and tables of numbers, and poles in any order."""

from __future__ import annotations

import ast
import math
import re
from collections.abc import Iterator
from decimal import Decimal
from typing import Any

import numpy as np
import sympy

from exercisebook import units
from exercisebook.formulas import value_of
from exercisebook.grammar import Doubtful, NotRead, Unreadable, in_python, shortened
from exercisebook.kinds.kind import (
    ALL_DIGITS,
    AS_IT_IS,
    LINE,
    MANY_DIGITS,
    Kind,
    Tried,
    how_rounded,
    rounded,
    with_unit,
)
from exercisebook.quantities import quantities
from exercisebook.reading import alone, answered, in_a_row, listed_in, members

#: What may be beside a number, on either side, and says nothing of its size.
_BEFORE_IT = re.compile(
    r"^(?:.*(?:,|;| ) ?(?:so|thus|i\.e\.|that is) (?=\S*\d))?"
    r"(?:(?:(?:the )?[a-z_]+(?: [a-z]+)? is|at least|at most|at|after|up to|times|only|exactly|(?:falls |rises )?by|"
    r"(?:by )?(?:a )?factor(?: of)?|is|it is|magnitude|size) |"
    r"(?:[^\W\d]\w* ?)?(?:[<>≥≤]=?(?![<>≥≤=])|\\[lg]eq?\b) ?){0,2}",
    re.IGNORECASE,
)
_BOUND = re.compile(r"at (?:least|most)|up to|[<>≥≤]|\\[lg]e", re.IGNORECASE)
_BEHIND_IT = re.compile(
    r" too (?:low|high|large|small|much|little)\.?$|(?<=[%\w]) of (?:the |its |full )*[a-z ]+$"
    r"|(?<=[\d)]) times(?: (?:larger|bigger|greater|higher|longer|faster|more|as (?:large|much|big|high|long|fast)))?$"
)
#: Poles that occur several times: "-2 (double)", "double pole at -2".
_TIMES = {"double": 2, "twice": 2, "triple": 3, "two times": 2, "three times": 3, "2 times": 2, "3 times": 3}
_TIMES |= {"2x": 2, "3x": 3, "2×": 2, "3×": 3, "x2": 2, "x3": 3, "×2": 2, "×3": 3, "repeated": 2, "2 fold": 2}
_TIMES |= {"multiplicity 2": 2, "multiplicity 3": 3, "double pole": 2, "triple pole": 3, "double root": 2}
_MANY = "|".join(map(re.escape, sorted(_TIMES, key=len, reverse=True)))
_SEVERAL_TIMES = re.compile(rf"^(?P<pole>.*?\S) ?[\[(,]? ?(?P<times>{_MANY})[\])]?$", re.IGNORECASE)
_TIMES_BEFORE = re.compile(
    rf"^(?:an? )?(?P<times>{_MANY})(?: (?:pole|zero|root))?(?: (?:at|in))? (?P<pole>.*)$", re.IGNORECASE
)
#: A pair in one text, and the name of several poles before it, as "s_1,2 =".
_PAIR = re.compile(r"±|\+ ?/ ?-|\\pm\b|\+-")
_NAMES = re.compile(r"^\\?\w+?_?[{(]?1 ?[,/] ?2[})]? ?= ?")
#: A mistake is recognised in a rounded value, too, by as much as its digits tell and no more than this.
ROUNDED = 0.01
#: A number below this fraction of the key is zero.
NOTHING = 1e-9
#: A pole is on the imaginary axis where its real part is below this fraction of the largest one: what is worked out in
#: decimal numbers is not exactly there.
ON_AXIS = 1e-9
#: The real part of a pole, which damps, may be off by so many times the accuracy.
DAMPING = 5
#: In so many other units the key is tried.
MOST_UNITS = 2


class Number(Kind):
    """A real number with its unit; a text may name another unit, as "2 min" where seconds are asked.

    >>> period = Number(120, "s", "the period")
    >>> period.agrees(period.read("2 min")[0])
    True
    """

    @property
    def expected(self) -> str:
        """A number in its unit."""
        return f"a number, in {self.unit}" if self.unit else "a number"

    def read(self, given: object) -> tuple[float, str]:
        """Return the number in the asked unit, as a float, and a remark where it came in another one."""
        given = answered(given)
        if isinstance(given, str) and not self.unit and (bare := _without_noun(given, self.what)):
            given, noun = bare, f"read as {bare}"
        else:
            noun = ""
        value, remark = one_number(given, self.unit, self.expected)
        return _real(value, self.expected), remark or noun

    @property
    def shown(self) -> tuple[float, str]:
        """The number and its unit."""
        return self.key, self.unit

    def written(self, answer: float) -> str:
        """The number with its unit."""
        return with_unit(in_digits(answer), self.unit)

    def agrees(self, answer: float) -> bool:
        """Whether the number is within the tolerance."""
        return near(answer, self.key, self.within)

    def is_value(self, answer: float, wrong: Any) -> bool:
        """Whether an answer is the value of a mistake, which a reader may have rounded."""
        wrong = self.like(wrong).key
        if wrong == 0:  # a small number is not nothing
            return abs(answer) <= NOTHING * abs(self.key)
        if self.within == 0:
            return near(answer, wrong, 0)
        rounding = max(_half_unit(answer, wrong), ROUNDED / 2)
        return near(answer, wrong, rounding if self.within <= ROUNDED else self.within)

    def off_by(self, answer: float, wrong: Any) -> float:
        """How far an answer is from the value of a mistake."""
        return abs(answer - self.like(wrong).key)

    def in_other_units(self, answer: float) -> Iterator[tuple[str, float]]:
        """What an answer would be if it had been given in another unit: pairs of the unit and the value."""
        for unit in units.neighbours(self.unit):
            yield unit, units.convert(answer, unit, to=self.unit)

    is_personal = True

    @property
    def field(self) -> dict[str, Any]:
        """A line, with the unit beside it."""
        return {"control": LINE}

    def right_forms(self) -> Iterator[Tried]:
        """The number rounded, as text, exact, with a decimal comma, and in other units.

        >>> dict(Number(90, "s").right_forms())["in min"]
        '1.5 min'
        """
        short = rounded(self.key, self.within)
        yield AS_IT_IS, self.key
        yield how_rounded(self.within), short
        yield "as text with its unit", f"{short!r} {self.unit}".strip()
        yield "as an exact number of SymPy", sympy.nsimplify(self.key, rational=True)
        if "." in repr(short) and "e" not in repr(short):
            yield "with a decimal comma", repr(short).replace(".", ",")
        for unit in list(units.neighbours(self.unit))[:MOST_UNITS]:
            # in °C a value may be a temperature or a difference
            is_clear = not {"°C", "K"} & {self.unit, unit}
            if unit and is_clear and units.convert(0, self.unit, to=unit) == 0:
                digits = MANY_DIGITS if self.within else ALL_DIGITS
                yield f"in {unit}", f"{units.convert(self.key, self.unit, to=unit):.{digits}g} {unit}"

    def wrong_forms(self) -> Iterator[Tried]:
        """Zero, the other sign, a factor of ten; one where the key is zero.

        >>> [answer for _, answer in Number(90, "s").wrong_forms()]
        [0.0, -90.0, 900.0, 9.0]
        """
        return _changed(self.key)


class Numbers(Kind):
    """A row or a table of real numbers, in order.

    >>> A = Numbers([[0, 1], [-2, -3]], what="the matrix A")
    >>> A.agrees(A.read(sympy.Matrix([[0, 1], [-2, -3]]))[0])
    True
    """

    EACH = "each number "

    @property
    def expected(self) -> str:
        """A row or a table of numbers."""
        unit = f", in {self.unit}" if self.unit else ""
        table = getattr(getattr(self, "key", None), "ndim", 1) > 1
        return f"a list of numbers such as {'[[1, 2], [3, 4]]' if table else '[1, 2]'}{unit}"

    def read(self, given: object) -> tuple[np.ndarray, str]:
        """Return an array of floats, and a remark where a number came in another unit."""
        given = list(given.values()) if isinstance(answered(given), dict) and alone(given) is given else given
        rows = _rows(given)
        if rows is None:
            raise Unreadable(f"this is not a list: expected {self.expected}")
        remarks: list[str] = []
        if isinstance(given, str):  # rows of a table in a text
            inner_texts = [_row_of_text(row) for row in rows]
            rows = inner_texts[0] if len(rows) == 1 else inner_texts
            rows = [row[0] if isinstance(row, list) and len(row) == 1 else row for row in rows]

        def number(value):
            value, remark = one_number(value, self.unit, self.expected)
            remarks.append(remark)
            return _real(value, self.expected)

        inner = [in_a_row(row) for row in rows]
        if any(row is not None for row in inner):
            if any(row is None or len(row) != len(inner[0]) for row in inner):
                raise Unreadable(f"the rows are of different length: expected {self.expected}")
            read = np.array([[number(value) for value in row] for row in inner], float)
        else:
            read = np.array([number(value) for value in rows], float)
        return read, self._remark(remarks, read)

    def _remark(self, remarks, read):
        """One remark on all numbers."""
        remark = max(remarks, default="")
        return f"read as {self.written(read)}" if remark.startswith("read as") else remark

    def written(self, answer: np.ndarray) -> str:
        """The list, or the list of rows, with its unit."""
        rows = [f"[{', '.join(map(in_digits, row))}]" for row in np.atleast_2d(answer)]
        return with_unit(rows[0] if answer.ndim == 1 else f"[{', '.join(rows)}]", self.unit)

    def agrees(self, answer: np.ndarray) -> bool:
        """Whether the shape is the same and each number within the tolerance; a column is a row."""
        answer, key = _flat(answer), _flat(self.key)
        return answer.shape == key.shape and bool(np.all(self.near_each(answer, key)))

    def near_each(self, answer: np.ndarray, key: np.ndarray) -> np.ndarray:
        """Which numbers are within the tolerance."""
        return np.abs(answer - key) <= self.allowed(key)

    def allowed(self, key: np.ndarray) -> np.ndarray:
        """By how much each number may be off."""
        off = allowed(key, self.within, 1e-12)
        if self.within <= ROUNDED:  # zero is zero, unless it is measured
            off = np.where(key == 0, NOTHING * np.max(np.abs(key), initial=0.0), off)
        return off

    def mistakes(self) -> Iterator[tuple[str, np.ndarray]]:
        """Wrong sign, another unit, rows for columns, the order turned."""
        is_one = np.size(self.key) == 1
        yield "the size is right, the sign is not" if is_one else "the sizes are right, the signs are not", -self.key
        for unit, converted in units.neighbours(self.unit).items():
            yield f"those would be the values {in_unit(unit)}; asked: {self.asked}", np.vectorize(converted)(self.key)
        if self.key.ndim == 2 and min(self.key.shape) > 1:
            if self.key.shape[0] == self.key.shape[1]:
                yield "rows and columns are interchanged", self.key.T
        else:
            yield "the values are right, in the opposite order", self.key[::-1]

    def hint(self, answer: np.ndarray) -> str:
        """Say how many are right. Raises Unreadable for another shape."""
        answer, key = _flat(answer), _flat(self.key)
        if answer.shape != key.shape:
            raise Unreadable(f"the shape is {_shape(answer)}: expected {_shape(key)}")
        right = int(np.sum(self.near_each(answer, key)))
        return f"{right} of {key.size} numbers are right" if right else ""

    is_personal = True

    @property
    def field(self) -> dict[str, Any]:
        """A line."""
        return {"control": LINE, "help": self.expected.removesuffix(f", in {self.unit}")}

    def right_forms(self) -> Iterator[Tried]:
        """The numbers rounded, as a matrix, an array and a text."""
        short = np.vectorize(lambda x: rounded(x, self.within))(self.key)
        yield AS_IT_IS, self.key.tolist()
        yield how_rounded(self.within), short.tolist()
        yield "as a matrix of SymPy", sympy.Matrix(self.key)
        yield "as an array", self.key
        yield "as text", str(short.tolist())

    def wrong_forms(self) -> Iterator[Tried]:
        """As of a number, and the opposite order."""
        yield from _changed(self.key)
        if not np.array_equal(self.key, self.key[::-1]):
            yield "in the opposite order", self.key[::-1]


class Poles(Kind):
    """Complex numbers in any order, as often as they occur, such as poles and zeros.

    The side of the imaginary axis is a part of each, and so is that one is on the axis, or zero.

    >>> poles = Poles([-1, -1, -2])
    >>> poles.agrees(poles.read({-1: 2, -2: 1})[0])
    True
    """

    EACH = "each number "

    def __init__(self, key: object, unit: str = "rad/s", what: str = "the poles", within: float = 0.01):
        super().__init__(key, unit, what, within)

    @property
    def expected(self) -> str:
        """A list of numbers."""
        return "a list of numbers such as [-1, -2 + 3j]"

    def read(self, given: object) -> tuple[np.ndarray, str]:
        """Return an array of complex numbers; a dictionary says how often each one occurs.

        In a text a sign ± stands for a pair, and "double" for two.
        """
        if isinstance(answered(given), dict) and alone(given) is given:
            given = [pole for pole, times in given.items() for _ in range(self._times(times))]
        elif isinstance(given, set | frozenset | sympy.FiniteSet):
            given = members(given)
        elif isinstance(given, str) and re.fullmatch(
            r"(?:there are )?(?:none|no (?:finite )?(?:poles|zeros?))\.?", given.strip().lower()
        ):
            given = []
        rows = _rows(given)
        rows = [given] if rows is None else rows
        inner = in_a_row(rows[0]) if len(rows) == 1 else None
        rows = _each_pole(rows if inner is None else inner)
        read = [one_number(value, self.unit, self.expected) for value in rows]
        remark = max((remark for _, remark in read), default="")
        several = len(rows) > len([given] if isinstance(given, str) and len(listed_in(given)) == 1 else rows)
        if remark.startswith("read as") or (several and not remark):
            remark = f"read as {', '.join(in_digits(value) for value, _ in read)}"
        return np.array([value for value, _ in read], complex), remark

    def _times(self, times):
        times = _real(one_number(times, "", self.expected)[0], self.expected)
        if not (times == int(times) and 0 <= times <= 20):
            raise Unreadable(f"a pole cannot occur {times:g} times: expected {self.expected}")
        return int(times)

    def written(self, answer: np.ndarray) -> str:
        """The list with its unit."""
        return with_unit(f"[{', '.join(map(in_digits, answer))}]", self.unit)

    def agrees(self, answer: np.ndarray) -> bool:
        """Whether each pole has its counterpart."""
        return len(answer) == len(self.key) == len(self.matched(answer))

    def matched(self, answer: np.ndarray) -> dict[int, int]:
        """Which of the answer's values are among the key's, each taken once: {place in it: place in the key}."""
        off, pairs = allowed(self.key, self.within, 1e-12), {}
        sides, own_sides = self.sides(answer), self.sides(self.key)
        for place, value in enumerate(answer):
            left = [k for k in range(len(self.key)) if k not in pairs.values() and sides[place] == own_sides[k]]
            nearest = min(left, key=lambda k, value=value: abs(value - self.key[k]), default=None)
            if nearest is not None and self._is_near(value, self.key[nearest], off[nearest]):
                pairs[place] = nearest
        return pairs

    def _is_near(self, value, key, allowed):
        """Whether a pole is where it should be; one of little damping has that damping, too."""
        off = abs(value.real - key.real)
        return abs(value - key) <= allowed and (key.real == 0 or off <= DAMPING * self.within * abs(key.real))

    def sides(self, values: np.ndarray) -> list[int]:
        """On which side of the imaginary axis each of some values is: -1, 0 or 1."""
        on_axis = ON_AXIS * (np.max(np.abs(self.key), initial=0.0) or 1.0)
        return [0 if abs(one.real) <= on_axis else int(np.sign(one.real)) for one in np.asarray(values)]

    def mistakes(self) -> Iterator[tuple[str, np.ndarray]]:
        """All signs turned, times instead of poles, another unit."""
        is_one = np.size(self.key) == 1
        yield "the size is right, the sign is not" if is_one else "the sizes are right, the signs are not", -self.key
        if np.all(self.key != 0):
            yield "those are the inverses, the times instead of the values in s", 1 / self.key
            yield "those are the time constants: a time constant of T makes the value -1/T", -1 / self.key
        if np.any(self.key.imag):
            yield "real part and imaginary part are interchanged", self.key.imag + 1j * self.key.real
        for unit, converted in units.neighbours(self.unit).items():
            yield f"those would be the values {in_unit(unit)}; asked: {self.asked}", self.key * converted(1)

    is_personal = True

    @property
    def field(self) -> dict[str, Any]:
        """A line."""
        return {"control": LINE, "help": self.expected}

    def right_forms(self) -> Iterator[Tried]:
        """The poles rounded, in the opposite order, as expressions and as a text."""
        short = [complex(rounded(z.real, self.within), rounded(z.imag, self.within)) for z in self.key]
        yield AS_IT_IS, self.key.tolist()
        yield how_rounded(self.within), short
        yield "in the opposite order", self.key[::-1]
        yield "as expressions of SymPy", [sympy.Float(z.real) + sympy.I * sympy.Float(z.imag) for z in self.key]
        if short:
            yield "as text", ", ".join(f"{z.real!r} {'-' if z.imag < 0 else '+'} {abs(z.imag)!r}j" for z in short)

    def wrong_forms(self) -> Iterator[Tried]:
        """As of a number, and one more pole."""
        yield from _changed(self.key)
        yield "one more pole", [*self.key, -1]


def _changed(key):
    """Zero, the other sign, and a factor of ten; of a row and of poles, those that are not the same once more."""
    changed = {"with the other sign": -key, "ten times as much": 10 * key, "a tenth of it": key / 10}
    for how, answer in ({"zero": 0 * key} | changed if np.any(key) else {"one": key + 1}).items():
        if not np.array_equal(np.sort_complex(np.ravel(answer)), np.sort_complex(np.ravel(key))):
            yield how, answer


def _without_noun(text, what):
    """A number without the noun of what is asked, as "4 boxes" or "room 31"; empty where there is none."""
    nouns = "|".join(re.sub("(?:(?<=[cs]h)e)?s$", "", word) for word in re.findall(r"[a-z]{4,}", what))
    text = re.sub(r" \([A-Za-z ]+\)$|\.$", "", text.strip())
    if re.fullmatch(r"(?:(?:no|nr|number)\b\.? ?|# ?)?\d+", text, re.IGNORECASE):
        return re.sub(r"\D", "", text)
    if what.startswith("the number of the ") and (tag := re.fullmatch(r"[A-Z]{1,5}[- ]?(\d+)", text)):  # TC41
        return tag[1]
    some = r"([\w.,]+)(?: (?:full|whole|complete))?"
    found = re.fullmatch(rf"(?:(?:the )?(?:{nouns}) ([\w.,]+)|{some} (?:{nouns})(?:e?s)?)", text) if nouns else None
    return (found[1] or found[2]) if found else ""


def _each_pole(rows):
    """The values of a list, where a text may stand for a pair or for a multiple one."""
    found, texts = [], [row.replace(" ", "") for row in rows if isinstance(row, str)]
    for row in rows:
        if not isinstance(row, str):
            found.append(row)
            continue
        row = " ".join(row.split()).rstrip(".")
        named, row = row, _NAMES.sub("", row)
        # s_1,2 = -1 and s_1 = s_2 = -1 are two, but of a pair each stands for one
        are_two = row != named and not re.search(r"[ij]", row) and not _PAIR.search(row)
        times = 2 if are_two else max(1, len(re.findall(r"[a-z]_?\{?\d\}? ?=", row)))
        if found and row.lower() in _TIMES:  # -2, twice
            found += found[-1:] * (_TIMES[row.lower()] - 1)
            continue
        several = _SEVERAL_TIMES.match(row) or _TIMES_BEFORE.match(row)
        if several:
            row, times = several["pole"], _TIMES[several["times"].lower()]
        pair = _PAIR.search(row)
        # a program writes -1+-2j for -1-2j, beside -1+2j
        if pair and pair[0] == "+-" and row.replace(" ", "").replace("+-", "+") in texts:
            pair = None
        both = [_PAIR.sub(sign, row, count=1) for sign in "+-"] if pair else [row]
        found += [re.sub(r"([+-]) ?[ij] ?(?=\d)(\d+\.?\d*|\.\d+)", r"\1 \2j", one) for one in both] * times
    return found


def near(answer: float, key: float, within: float) -> bool:
    """Whether a number is within a fraction of the key; of a key of 0, within as much absolutely."""
    return math.isfinite(answer) and abs(answer - key) <= within * (abs(key) or 1) + 1e-12 * abs(key)


def _half_unit(answer, value):
    """Half a unit of the last digit with which an answer is given, as a fraction of a value, and at most `ROUNDED`."""
    _, _, exponent = Decimal(repr(float(answer))).normalize().as_tuple()
    return min(0.5 * 10.0**exponent / abs(value), ROUNDED)


def in_digits(value: complex | sympy.Expr) -> str:
    """Return a number as text, to eight digits.

    >>> in_digits(8 / 3), in_digits(-1 - 2.5j), in_digits(2 + 0j)
    ('2.6666667', '-1 - 2.5j', '2')
    """
    value = complex(value)
    if not value.imag:
        return f"{value.real:.8g}"
    return f"{value.real:.8g} {'-' if value.imag < 0 else '+'} {abs(value.imag):.8g}j"


def one_number(given: object, unit: str, expected: str) -> tuple[complex, str]:
    """Return a finite number, real or complex, in a unit, and a remark where it was given in another one."""
    given = alone(given)
    if isinstance(given, str):
        return _number_of_text(given, unit, expected)
    if hasattr(given, "magnitude") and hasattr(given, "units"):  # a quantity of Pint
        value, named = one_number(given.magnitude, "", expected)[0], f"{given.units:~C}".replace("Δ°C", "K")
        return _in_unit_asked(value, named, unit, expected)
    row = in_a_row(given)
    if row is not None:
        raise Unreadable(f"there are {len(row)} values: expected {expected}")
    if given is None or given is Ellipsis:
        raise Unreadable(f"a value is missing: expected {expected}")
    if isinstance(given, bool | np.bool_) or given is sympy.true or given is sympy.false:
        raise Unreadable(f"{given} is a truth value: expected {expected}")
    if isinstance(given, sympy.Expr) and given.free_symbols:
        symbols = shortened(", ".join(sorted(symbol.name for symbol in given.free_symbols)))
        raise Unreadable(f"there is still {symbols} in it: expected {expected}")
    if (isinstance(given, dict | set) or callable(given)) and not isinstance(given, sympy.Basic):
        raise Unreadable(f"this is of type {type(given).__name__}: expected {expected}")
    try:
        value = complex(given)
    except Exception:  # objects of others may fail in any way
        raise Unreadable(f"this is of type {type(given).__name__}: expected {expected}") from None
    return _finite(value, expected), ""


def _number_of_text(text, unit, expected):
    line = _BEHIND_IT.sub("", " ".join(text.split()))
    before = _BEFORE_IT.match(line)[0]
    line = line[len(before) :]
    try:
        found = [_in_asked(one, unit, expected) for one in quantities(line)]
    except Doubtful as doubt:
        raise Unreadable(str(doubt)) from None
    except NotRead:
        raise Unreadable(f"{shortened(text, 40)!r} is a text that is not a number: expected {expected}") from None
    value, remark = found[-1]
    if _BOUND.search(before):  # which is no value
        remark = f"read as {in_digits(value)} {unit}".strip()
    parts = (1, 100) if unit == "%" else (1,)  # 0.25 = 25 %
    for one, _ in found[:-1]:
        if not any(abs(k * one - value) <= ROUNDED * (abs(value) or 1) for k in parts):
            raise Unreadable(f"{shortened(text, 40)!r} has two sides that differ: expected {expected}")
    return value, remark


def _in_asked(quantity, unit, expected):
    """A quantity in the asked unit, and a remark."""
    if quantity.apart is None:
        try:
            value = _finite(value_of(quantity.in_unit(unit)), expected)
        except ValueError as problem:
            raise Unreadable(f"{problem}: expected {expected}") from None
        return value, f"read as {in_digits(value)} {unit}".strip()
    number, named = quantity.apart
    value = _finite(value_of(number), expected)
    remark = f"read as {in_python(number)} {named}".strip() if quantity.is_other else ""
    if len(quantity.units) > 1 and isinstance(number, ast.BinOp):  # 15 K / 10 %
        remark = f"read as {in_digits(value)} {named}"
    if not named:
        return value, remark
    value, converted = _in_unit_asked(value, named, unit, expected)
    return value, ", ".join(one for one in (remark, converted) if one)


def _in_unit_asked(value, named, unit, expected):
    """A number that was given with a unit, in the asked one; degrees are those of the asked unit."""
    if unit in ("°C", "K") and re.fullmatch("deg(rees?)?", named):
        named = unit
    if (units.spelled(named), unit) == ("°C", "K"):
        raise Unreadable(f"in °C, this may be a temperature or a difference of two: expected {expected}")
    value = _finite(complex(value), expected)
    try:
        factor = units.convert(1, named, to=unit)
        converted = value * factor if value.imag else complex(units.convert(value.real, named, to=unit))
    except ValueError as error:
        raise Unreadable(f"{error}: expected {expected}") from None
    return _finite(converted, expected), "" if factor == 1 else f"converted from {named}"


def _finite(value, expected):
    if math.isnan(value.real) or math.isnan(value.imag):
        raise Unreadable(f"this is not a number (NaN): expected {expected}")
    if math.isinf(value.real) or math.isinf(value.imag):
        raise Unreadable(f"this is infinite: expected {expected}")
    return value


def _real(value, expected):
    # roots of polynomials keep a trace of an imaginary part
    if abs(value.imag) > 1e-9 * abs(value):
        raise Unreadable(f"this is a complex number: expected {expected}")
    return value.real


def in_unit(unit: str) -> str:
    """A unit in a sentence."""
    return {"": "as a fraction", "%": "in percent"}.get(unit, f"in {unit}")


def _rows(given):
    """The values of a list in a text too."""
    return listed_in(given) if isinstance(given, str) else in_a_row(given)


def _row_of_text(row):
    """The numbers of a row that is a text, between commas or between spaces."""
    parts = listed_in(row)
    in_spaces = len(parts) == 1 and re.fullmatch(r"[-+−]?[\d./]+(?: +[-+−]?[\d./]+)+", parts[0])
    if in_spaces and not re.fullmatch(r"\S+( \d{3})+|[-+−]?\d+ \d+/\d+", parts[0]):  # which are 12 000, or 1 1/2
        return re.split(" +", parts[0])
    return parts


def allowed(key: np.ndarray, within: float, least: float) -> np.ndarray:
    """Return by how much each number may be off: a fraction of it, where it is 0 of the smallest other one."""
    sizes = np.abs(key)
    smallest = min(sizes[sizes > 0], default=1.0)
    return within * np.where(sizes == 0, smallest, sizes) + least * np.max(sizes, initial=0.0)


def _flat(array):
    return array.ravel() if array.ndim == 2 and 1 in array.shape else array


def _shape(array):
    return " by ".join(map(str, array.shape)) if array.ndim > 1 else f"a row of {array.size}"
