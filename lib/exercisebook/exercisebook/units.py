"""Units: what an answer means in the unit that is asked, and in which other unit it may have been meant."""

from __future__ import annotations

import functools
import math
import re
from collections.abc import Callable
from fractions import Fraction
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    import pint

    from plainmath.types import Number

#: Units that are taken for one another.
FAMILIES = (
    ("s", "min", "h", "ms", "d"),
    ("m", "km", "cm", "mm"),
    ("kg", "g", "t"),
    ("m³", "L", "mL"),
    ("mol", "kmol"),
    ("Pa", "kPa", "bar"),
    ("W", "kW", "MW"),
    ("J", "kJ", "MJ"),
    ("N", "kN"),
    ("A", "mA"),
    ("V", "mV"),
    ("Ω", "kΩ", "MΩ"),
    ("F", "µF", "nF"),
    ("rad", "deg"),
)
_PART = re.compile(r"[^\W\d_]+³?|%")
#: A name and its exponent of one digit, as "m³", "s^-1", "m**2" or "m3".
_FACTOR = re.compile(r"[^\W\d_¹²³]+\s?(?:\^|\*\*)?(?:-?[1-9]|⁻?[¹²³])?(?![\d^]|\*\*)")
_CELSIUS = re.compile(r"\s*(°\s?C|º\s?C|℃|C|C\s?°|deg(rees?)?\.?\s?([Cc]elsius|C)|[Cc]elsius)\s*")
_LONGEST = 40
#: Units as people write them, and what Pint knows them by.
_SPELLINGS = {
    "percentage points": "%",
    "percent": "%", "per cent": "%", "pct": "%", "percents": "%", "mins": "min", "hrs": "h", "secs": "s", "Sec": "s",
    "Min": "min", "Nm": "N m", "kNm": "kN m", "Nms": "N m s", "Ohm": "Ω", "Ohms": "Ω", "kOhm": "kΩ", "cbm": "m³",
    "degs": "deg", "Ns": "N s", "decibel": "dB", "decibels": "dB", "KW": "kW", "Kg": "kg", "sec.": "s", "min.": "min",
}  # fmt: skip
_SPELLED = re.compile(
    rf"(?<![^\W\d_])(?:{'|'.join(map(re.escape, sorted(_SPELLINGS, key=len, reverse=True)))})(?![^\W\d_])"
)


def _everyday():
    """Products and quotients of names that are units, such as "1/min", "kg m²" and "K/(L/min)"."""
    names = {"K", "Hz"}.union(*FAMILIES) - {"m³"}
    factor = f"(?:%|(?:{'|'.join(sorted(names))})[²³]?)"
    product, group = f"{factor}(?: {factor}){{0,2}}", f"\\({factor}[ /]{factor}\\)"
    return re.compile(f"(?:{product})?|°C|(?:1|{product}|{group})/(?:°C|{factor}|{group})")


_EVERYDAY = _everyday()


def is_unit(text: str) -> bool:
    """Whether a text is a unit, as "m³/s", "%/K", "1/min" or "kJ/(kg K)"; nothing is one of them.

    >>> [is_unit(text) for text in ("kg/min", "°C", "%", "", "apples", "s^99")]
    [True, True, True, True, False, False]
    """
    if isinstance(text, str) and _EVERYDAY.fullmatch(text):  # without Pint, whose registry takes its time to load
        return True
    try:
        _parsed(text)
    except ValueError:
        return False
    return True


def convert(value: Number, unit: str, to: str) -> float:
    """Return a value in another unit.

    A turn is not forgotten: 1 Hz is 2 pi rad/s. A ratio in dB is one of amplitudes. Where a temperature stands alone
    it is one, not a difference.

    Raises ValueError where one of the two is not a unit, or they measure different quantities.

    >>> convert(0.5, "min", to="s"), convert(20, "°C", to="K"), convert(3, "%", to="")
    (30.0, 293.15, 0.03)
    >>> convert(2, "kg", to="s")
    Traceback (most recent call last):
    ValueError: kg is not a unit of the same quantity as s
    """
    import pint

    if (unit, to) == ("dB", ""):  # of an amplitude, as margins are
        return 10 ** (float(value) / 20)
    if re.search("rad|deg", unit + to):
        unit, to = unit.replace("Hz", "turn/s"), to.replace("Hz", "turn/s")
    if (unit, to) in (("", "dB"), ("%", "dB")):
        return 20 * math.log10(float(value) / (100 if unit else 1)) if value > 0 else -math.inf
    try:
        return float(registry().Quantity(float(value), _parsed(unit)).to(_parsed(to)).magnitude)
    except (pint.PintError, AssertionError, OverflowError, TypeError):  # logarithms, of a Fraction and to a power
        raise ValueError(f"{unit or 'a number without unit'} is not a unit of the same quantity as {to or 1}") from None


def neighbours(unit: str) -> dict[str, Callable[[Number], float]]:
    """Return the units in which a value may have been meant: {unit: what 1 of the asked unit is in it, or a function}.

    One part of the unit is exchanged for another of its family; percent and fraction, °C and K, Hz and rad/s, too.

    >>> {name: round(in_it(30), 3) for name, in_it in neighbours("s").items()}
    {'min': 0.5, 'h': 0.008, 'ms': 30000.0, 'd': 0.0}
    """
    names = []
    for part in _PART.finditer(unit):
        for family in FAMILIES:
            if part[0] in family:
                names += [unit[: part.start()] + other + unit[part.end() :] for other in family if other != part[0]]
    if unit in ("", "%"):
        names.append("%" if unit == "" else "")
    elif unit.startswith("%/"):
        names.append("1" + unit.removeprefix("%"))
    elif unit.endswith("/%"):
        names.append(unit.removesuffix("/%"))
    names += {"°C": ["K"], "K": ["°C"], "Hz": ["rad/s"], "rad/s": ["Hz"]}.get(unit, [])
    return {name: functools.partial(convert, unit=unit, to=name) for name in names if _compatible(unit, name)}


def _compatible(unit, other):
    try:
        convert(1, unit, other)
    except ValueError:
        return False
    return unit != other


def spelled(unit: str) -> str:
    """Return a unit as it is usually spelled: °C for "deg C", "m/s" for "m per second", % for "percent".

    >>> spelled("degrees C"), spelled("kg per min"), spelled("K/percent"), spelled("Minutes")
    ('°C', 'kg/min', 'K/%', 'minutes')
    """
    if not isinstance(unit, str) or len(unit) > _LONGEST:
        return unit
    if _CELSIUS.fullmatch(unit):
        return "°C"
    unit = _SPELLED.sub(lambda name: _SPELLINGS[name[0]], unit)
    unit = re.sub(r"(?<=\S) per (?=\S)", "/", unit)
    return re.sub(r"\b[A-Z](?=[a-z]{3})", lambda letter: letter[0].lower(), unit)


@functools.cache
def registry() -> pint.UnitRegistry:
    """Return Pint's registry, which takes its time to load, so there is one; its factors are exact."""
    import pint

    found = pint.UnitRegistry(cache_folder=None, non_int_type=Fraction)
    found.define("dB_ = []")  # in a graph of formulas decibels are numbers, which Pint's are not
    found.define("percent_ = [share]")  # and percent are those of the range of a signal: K/% is no K
    return found


def with_powers(text: str) -> str:
    """Return a unit with the sign of a power where it is left out, as Pint reads it.

    >>> with_powers("m3/s"), with_powers("s-1")
    ('m^3/s', 's^-1')
    """
    return re.sub(r"(?<=[A-Za-z])(-?[1-9])(?!\d)", r"^\1", text)


@functools.lru_cache(maxsize=1000)
def _parsed(text):
    text = spelled(text)
    # names with exponents, and what is between them: no power of a power can be worked out for hours
    between = _FACTOR.sub("", text) if isinstance(text, str) and len(text) <= _LONGEST else "?"
    if not re.fullmatch(r"(\s*1\s*/)?[\s%°·*/()]*", between):
        raise ValueError(f"{text!r} is not a unit: expected one such as 's', 'kg/min' or '%/K'")
    try:
        return registry().parse_units(with_powers(text))
    except Exception:  # Pint fails in as many ways as a text can be no unit
        raise ValueError(f"{text!r} is not a unit: expected one such as 's', 'kg/min' or '%/K'") from None
