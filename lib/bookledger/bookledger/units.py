"""Units of results: a value that SymPy computed with units is compared in the unit that the book prints."""

from __future__ import annotations

import sympy
from sympy.physics import units
from sympy.physics.units import Quantity, convert_to

from plainmath.expressions import parse

_BASE = [units.meter, units.kilogram, units.second, units.ampere, units.kelvin, units.mole]
#: Units as a book prints them that SymPy has under another name, or not at all.
_SYMBOLS = {
    "%": sympy.Rational(1, 100), "°": sympy.pi / 180, "rad": sympy.S.One, "Ω": units.ohm, "Hz": units.hertz,
    "min": units.minute, "h": units.hour, "d": units.day, "t": units.metric_ton, "l": units.liter, "L": units.liter,
    "bar": units.bar, "mbar": units.bar / 1000, "kPa": 1000 * units.pascal, "kN": 1000 * units.newton,
    "kW": 1000 * units.watt, "MW": 10**6 * units.watt, "kJ": 1000 * units.joule, "MJ": 10**6 * units.joule,
    "mA": units.ampere / 1000, "mV": units.volt / 1000, "kmol": 1000 * units.mole,
}  # fmt: skip


def unit_of(text: str) -> sympy.Expr:
    """Return a unit as a book prints it, such as "W/(m^2*K)", as an expression of SymPy's quantities.

    Raises ValueError for what is no unit, and for °C, of which only differences could be computed with.

    >>> unit_of("kg/min")
    kilogram/minute
    """
    if text in _SYMBOLS or not text:
        return _SYMBOLS.get(text, sympy.S.One)
    try:
        spelled = parse(text.replace("^", "**").replace("·", "*"))
        return spelled.xreplace({symbol: _quantity(symbol.name) for symbol in spelled.free_symbols})
    except ValueError:
        raise ValueError(f"{text!r} is no unit that can be computed with, expected one like W/(m^2*K)") from None


def _quantity(name):
    found = _SYMBOLS.get(name, getattr(units, name, None))
    if not isinstance(found, sympy.Expr):
        raise ValueError(name)
    return found


def without_unit(value: object, unit: str) -> object:
    """Return a value as a number in a unit; one without a unit of its own is taken as it is.

    Raises ValueError where it has a unit of another kind.

    >>> without_unit(2 * units.minute, "s"), without_unit(120, "s")
    (120, 120)
    """
    if not isinstance(value, sympy.Expr) or not value.has(Quantity):
        return value
    ratio = convert_to(value / unit_of(unit), _BASE)
    if ratio.has(Quantity):
        raise ValueError(
            f"{value}, expected a value in {unit}" if unit else f"{value}, expected a number without a unit"
        )
    return ratio
