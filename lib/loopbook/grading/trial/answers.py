"""Answers to try an exercise with: its key in the forms in which students write it, and others that are wrong.

`forms` and `others` have a function for each kind of answers; a kind without one is tried with its key alone.
"""

from __future__ import annotations

import ast
import functools
from collections.abc import Iterator
from typing import Any, TypeAlias

import numpy as np
import sympy

from loopbook.exercises import kinds, units
from loopbook.exercises.kinds import Kind
from loopbook.exercises.kinds.settings import NAMES
from loopbook.pid import PID

#: An answer, and in words what it is.
Tried: TypeAlias = tuple[str, Any]
#: How many digits a careful student keeps; with a tolerance below this one, all that are needed.
DIGITS, MANY_DIGITS, ALL_DIGITS, ROUGHEST = 3, 8, 16, 0.005
#: In so many other units a number is tried.
MOST_UNITS = 2
AS_IT_IS = "as it is"
ROUNDED = "rounded to three digits"


@functools.singledispatch
def forms(kind: Kind) -> Iterator[Tried]:
    """Yield the key in forms that are right, each with its words, the plainest first.

    >>> from loopbook.exercises.kinds import Number
    >>> dict(forms(Number(90, "s")))["in min"]
    '1.5 min'
    """
    yield AS_IT_IS, ast.literal_eval(kind.as_code())


@functools.singledispatch
def others(kind: Kind) -> Iterator[Tried]:
    """Yield answers that are not the key, each with its words.

    >>> from loopbook.exercises.kinds import Number
    >>> [answer for _, answer in others(Number(90, "s"))]
    [0.0, -90.0, 900.0, 9.0]
    """
    yield from ()


def rounded(x: float, within: float = 0.01) -> float:
    """Return a number as a careful student rounds it: to three digits, where the tolerance allows it.

    >>> rounded(12.3456), rounded(12.3456, within=0.001)
    (12.3, 12.3456)
    """
    return float(f"{x:.{DIGITS if within >= ROUGHEST else MANY_DIGITS}g}")


def _rounded_complex(z, within):
    return complex(rounded(z.real, within), rounded(z.imag, within))


def _how_rounded(within):
    return ROUNDED if within >= ROUGHEST else "with eight digits"


# Numbers.


@forms.register
def _(kind: kinds.Number):
    x = kind.key
    short = rounded(x, kind.within)
    yield AS_IT_IS, x
    yield _how_rounded(kind.within), short
    yield "as text with its unit", f"{short!r} {kind.unit}".strip()
    yield "as an exact number of SymPy", sympy.nsimplify(x, rational=True)
    if "." in repr(short) and "e" not in repr(short):
        yield "with a decimal comma", repr(short).replace(".", ",")
    for unit in list(units.neighbours(kind.unit))[:MOST_UNITS]:
        if unit and units.convert(0, kind.unit, to=unit) == 0 and _is_clear(kind.unit, unit):
            digits = MANY_DIGITS if kind.within else ALL_DIGITS
            yield f"in {unit}", f"{units.convert(x, kind.unit, to=unit):.{digits}g} {unit}"


def _is_clear(unit, other):
    """Whether a value in another unit can mean one thing only: in °C it may be a temperature or a difference."""
    return not {"°C", "K"} & {unit, other}


@others.register
def _(kind: kinds.Number):
    yield from _changed(kind.key)


def _changed(key):
    """Zero, the other sign, and a factor of ten; of a row and of poles, those that are not the same once more."""
    changed = {
        "zero": 0 * key,
        "with the other sign": -key,
        "ten times as much": 10 * key,
        "a tenth of it": key / 10,
    }
    for how, answer in changed.items():
        if not np.array_equal(np.sort_complex(np.ravel(answer)), np.sort_complex(np.ravel(key))):
            yield how, answer


@forms.register
def _(kind: kinds.Numbers):
    short = np.vectorize(lambda x: rounded(x, kind.within))(kind.key)
    yield AS_IT_IS, kind.key.tolist()
    yield _how_rounded(kind.within), short.tolist()
    yield "as a matrix of SymPy", sympy.Matrix(kind.key)
    yield "as an array", kind.key
    yield "as text", str(short.tolist())


@others.register
def _(kind: kinds.Numbers):
    yield from _changed(kind.key)
    if not np.array_equal(kind.key, kind.key[::-1]):
        yield "in the opposite order", kind.key[::-1]


@forms.register
def _(kind: kinds.Poles):
    short = [_rounded_complex(z, kind.within) for z in kind.key]
    yield AS_IT_IS, kind.key.tolist()
    yield _how_rounded(kind.within), short
    yield "in the opposite order", kind.key[::-1]
    yield "as expressions of SymPy", [sympy.Float(z.real) + sympy.I * sympy.Float(z.imag) for z in kind.key]
    if short:
        yield "as text", ", ".join(f"{z.real!r} {'-' if z.imag < 0 else '+'} {abs(z.imag)!r}j" for z in short)


@others.register
def _(kind: kinds.Poles):
    yield from _changed(kind.key)
    yield "one more pole", [*kind.key, -1]


# Formulas.


@forms.register
def _(kind: kinds.Expression):
    expr = kind.expr
    yield AS_IT_IS, str(expr)
    yield "as an expression of SymPy", expr.xreplace({one: sympy.Symbol(one.name) for one in expr.free_symbols})
    yield "multiplied out", str(sympy.expand(expr))
    yield "in one fraction", str(sympy.together(expr))
    if (short := _with_rounded_numbers(expr, kind.within)) != expr:
        yield f"with its numbers {_how_rounded(kind.within)}", str(short)


def _with_rounded_numbers(expr, within):
    """An expression whose numbers are decimals of a few digits, except in powers, which are exact."""
    if isinstance(expr, sympy.Rational | sympy.Float):
        short = rounded(float(expr), within)
        return expr if expr == short or expr.is_Integer else sympy.Float(short)
    if isinstance(expr, sympy.Pow) and expr.exp.is_number:
        base = _with_rounded_numbers(expr.base, within)
        return base**expr.exp if not base.is_number else sympy.Float(rounded(float(expr), within))
    return expr.func(*(_with_rounded_numbers(one, within) for one in expr.args)) if expr.args else expr


@others.register
def _(kind: kinds.Expression):
    changed = {"zero": 0, "one": 1, "with the other sign": -kind.expr, "ten times as much": 10 * kind.expr}
    yield from ((how, str(answer)) for how, answer in changed.items() if answer != kind.expr)


# Controllers and designs.


@forms.register
def _(kind: kinds.Settings):
    yield AS_IT_IS, ast.literal_eval(kind.as_code())
    short = _with_each(kind.key, lambda name, x: rounded(x, kind.within))
    yield _how_rounded(kind.within), short
    yield "as a PID of SymPy's numbers", kind.key
    said = [(name, getattr(short, name)) for name in NAMES if _is_said(short, name)]
    form = "" if short.Td == short.Tf == 0 else f" ({short.form})"
    yield "as text", ", ".join(f"{name} = {float(value)!r}" for name, value in said) + form


def _is_said(pid, name):
    return name == "Kp" or getattr(pid, name) not in (0, sympy.oo)


def _with_each(pid, change):
    """A controller whose settings, of those that it has, are changed by a function of their names and values."""
    changed = {
        name: change(name, float(getattr(pid, name))) if _is_said(pid, name) else getattr(pid, name) for name in NAMES
    }
    return PID(**changed, form=pid.form)


@others.register
def _(kind: kinds.Settings):
    for how, factor in (("with the other sign", -1), ("ten times the gain", 10), ("a tenth of the gain", 0.1)):
        yield how, _with_each(kind.key, lambda name, x, by=factor: by * x if name == "Kp" else x)


@forms.register
def _(kind: kinds.Design):
    yield from forms(kind.example)


@others.register
def _(kind: kinds.Design):
    yield from others(kind.example)


# Words, charts and diagrams.


@forms.register
def _(kind: kinds.Word):
    yield AS_IT_IS, kind.key
    yield "in capital letters", kind.key.upper()
    yield "with spaces", f" {kind.key} "


@forms.register
def _(kind: kinds.Words):
    yield AS_IT_IS, kind.key
    yield "as text", ", ".join(kind.key)
    if not kind.ordered:
        yield "in another order", kind.key[::-1]


@others.register
def _(kind: kinds.Words):
    found = {"no word": [], "all words": list(kind.among)}
    yield from ((how, answer) for how, answer in found.items() if answer != kind.key)


@forms.register
def _(kind: kinds.SequentialChart):
    yield AS_IT_IS, kind.key
    yield "as a list of lines", kind.key.splitlines()


@others.register
def _(kind: kinds.SequentialChart):
    for output in kind.outputs:
        yield f"a chart that only switches {output} on", f"Start: {output} on"


@forms.register
def _(kind: kinds.InstrumentDiagram):
    yield AS_IT_IS, kind.key
    yield "as a list of connections", kind.key.split("; ")


@others.register
def _(kind: kinds.InstrumentDiagram):
    first, *more = kind.key.split("; ")
    if more:
        yield "its first connection alone", first


def as_given(kind: Kind) -> Any:
    """Return the key of a kind as a student would give it."""
    return next(iter(forms(kind)))[1]
