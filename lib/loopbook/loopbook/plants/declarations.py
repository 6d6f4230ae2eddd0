"""The words in which a plant states its physics: its quantities, and the laws that they obey.

In the body of a `Plant`, ``T = signal(30, "°C", "temperature")`` declares a signal and makes ``T`` the function T(t),
``m = parameter(100, "kg", "mass")`` makes ``m`` a symbol, and both are then the words of the laws.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any, NamedTuple

import sympy
from sympy.core.function import AppliedUndef

from loopbook.types import Number
from plainmath.expressions import exact, t
from plainmath.validation import exact_real, is_number
from plainmath.validation import limits as checked_limits

__all__ = [
    "Balance", "Lag", "Quantity", "delayed", "measured", "name_of", "parameter", "parameters", "signal", "signals",
]  # fmt: skip


# ---------------------------------------------------------------------------------------------------- quantities


class Quantity(NamedTuple):
    """A parameter or a signal of a plant: its value (of a signal: at the operating point), unit and meaning.

    A measured signal has None for a value, which follows from the others.
    """

    value: Number | None
    unit: str
    meaning: str


@dataclass(frozen=True)
class Declared:
    """A quantity in the body of a class, before it has the name of the attribute to which it is given."""

    quantity: Quantity
    is_parameter: bool = False
    limits: tuple[Number, Number] | None = None
    formula: sympy.Expr | None = None


def signals(names: str) -> tuple[AppliedUndef, ...]:
    """The functions of time with these names, as ``T(t)``."""
    return tuple(map(_function, names.split()))


def parameters(names: str) -> tuple[sympy.Symbol, ...]:
    """The symbols with these names; in formulas they count as positive, as parameters do."""
    return tuple(map(_positive, names.split()))


def signal(value: Number, unit: str = "", meaning: str = "", limits: tuple[Number, Number] | None = None) -> Any:
    """Declare a signal of a plant, in the body of its class: an input, or a state that a law makes of it.

    Arguments:
        value: at the operating point, in the unit.
        unit: such as "kg/s"; "1" for a number.
        meaning: in a few words.
        limits: ``(lowest, highest)``, numbers or parameters, for a state that cannot leave this range.
    Returns:
        In the body of the class, the function of time, as ``T(t)``.
    """
    return Declared(Quantity(value, unit, meaning), limits=limits)


def parameter(value: Number, unit: str = "", meaning: str = "") -> Any:
    """Declare a parameter of a plant, in the body of its class.

    Its symbol counts as positive in formulas, as where a root is simplified; its value may be zero, but not negative.

    Arguments:
        value: in the unit.
        unit: such as "kg/s"; "1" for a number.
        meaning: in a few words.
    Returns:
        In the body of the class, the symbol.
    """
    return Declared(Quantity(value, unit, meaning), is_parameter=True)


def measured(formula: sympy.Expr, unit: str = "", meaning: str = "") -> Any:
    """Declare a signal that follows from others at once, or some dead time later.

    Arguments:
        formula: what is measured, such as ``delayed(T_1, tau)``.
        unit: such as "kg/s"; "1" for a number.
        meaning: in a few words.
    Returns:
        In the body of the class, the function of time, as ``T(t)``.
    """
    return Declared(Quantity(None, unit, meaning), formula=_formula("what is measured", formula))


def delayed(x: sympy.Expr, delay: Number) -> sympy.Expr:
    """Return a signal, or a formula of signals, as it was some time ago.

    >>> (u,), (tau,) = signals("u"), parameters("tau")
    >>> delayed(2 * u, tau)
    2*u(t - tau)
    """
    return _formula("what is delayed", x).subs(t, t - exact_real("the delay", delay))


def name_of(x: sympy.Expr) -> str:
    """How a quantity is called in Python: T for T(t)."""
    if x.is_Derivative:
        return f"{name_of(x.expr)}_{'dot' * x.derivative_count}"
    return str(x.func) if isinstance(x, AppliedUndef) else str(x)


def _function(name):
    return sympy.Function(name)(t)


def _positive(name):
    return sympy.Symbol(name, positive=True)


def _formula(what, given):
    """A formula as it was given, or a number."""
    if isinstance(given, sympy.Expr):
        return given
    if is_number(given):
        return exact(given)
    raise ValueError(f"{what} is {given!r}: expected a formula of signals and parameters")


# ---------------------------------------------------------------------------------------------------------- laws


@dataclass(frozen=True)
class Balance:
    """What is stored in a part of a plant changes by what flows in, what flows out, and what is generated there.

    Accumulation is inflow less outflow plus generation: of mass, energy, momentum, or of a substance, which a reaction
    generates or consumes. The sum of two balances is that of both parts together: what one hands on to the other
    cancels.

    Arguments:
        content: what is stored, a formula of signals and parameters.
        inflow: the net rate at which the content changes: what flows in, less what flows out, plus what is generated.

    >>> (h_1, h_2, q_in, q_12, q_out), (A,) = signals("h_1 h_2 q_in q_12 q_out"), parameters("A")
    >>> first, second = Balance(A * h_1, q_in - q_12), Balance(2 * A * h_2, q_12 - q_out)
    >>> first.equation
    Eq(A*Derivative(h_1(t), t), -q_12(t) + q_in(t))
    >>> (first + second).inflow
    q_in(t) - q_out(t)
    """

    content: sympy.Expr
    inflow: sympy.Expr
    parts: tuple[Balance, ...] = ()

    def __post_init__(self) -> None:
        for name in ("content", "inflow"):
            object.__setattr__(self, name, _formula(f"the {name} of a balance", getattr(self, name)))

    @property
    def equation(self) -> sympy.Equality:
        """The law as an equation: the derivative of the content is the net rate."""
        return sympy.Eq(sympy.diff(self.content, t), self.inflow, evaluate=False)

    def __add__(self, other: Balance) -> Balance:
        if not isinstance(other, Balance):
            return NotImplemented
        return Balance(self.content + other.content, self.inflow + other.inflow, (self, other))

    def subs(self, old: sympy.Expr, new: sympy.Expr) -> Balance:
        """Return the balance of a plant in which another quantity has the place of one.

        >>> (m, F, F_1) = signals("m F F_1")
        >>> Balance(m, F).subs(F, 2 * F_1).inflow
        2*F_1(t)
        """
        parts = tuple(part.subs(old, new) for part in self.parts)
        return Balance(self.content.subs(old, new), self.inflow.subs(old, new), parts)


@dataclass(frozen=True)
class Lag:
    """A signal follows another one with a lag, as a valve its control signal: T x' = u - x. Nothing is stored.

    Arguments:
        x: the signal that follows.
        u: what it follows, a formula of signals and parameters.
        T: the lag.

    >>> (x, u), (T_v,) = signals("x u"), parameters("T_v")
    >>> Lag(x, u, T_v).equation
    Eq(T_v*Derivative(x(t), t), u(t) - x(t))
    """

    x: sympy.Expr
    u: sympy.Expr
    T: Number

    def __post_init__(self) -> None:
        for name in ("x", "u", "T"):
            object.__setattr__(self, name, _formula(f"{name} of a lag", getattr(self, name)))

    @property
    def equation(self) -> sympy.Equality:
        """The law as an equation."""
        return sympy.Eq(self.T * sympy.diff(self.x, t), self.u - self.x, evaluate=False)


# ----------------------------------------------------------------------------------------------- the body of a class


class ClassBody(dict):
    """The body of a plant's class while it is read: what is declared gets its name, and is recorded."""

    def __init__(self, plant: str, bases: tuple[type, ...]):
        super().__init__()
        self.plant, self.bases = plant, bases
        self.quantities: dict[sympy.Expr, Quantity] = {}
        self.limits: dict[sympy.Expr, tuple[Number, Number]] = {}
        self.measured: dict[sympy.Expr, sympy.Expr] = {}
        self.laws: dict[str, Balance | Lag] = {}

    def __setitem__(self, name: str, value: Any) -> None:
        if isinstance(value, (Declared, Balance, Lag)):
            if name in self:
                raise ValueError(f"{self.plant}.{name} is declared twice: expected another name")
            for base in self.bases:
                if not isinstance(getattr(base, name, value), (sympy.Basic, Balance, Lag, Declared)):
                    raise ValueError(f"{self.plant}.{name}: every plant has a {name!r}, expected another name")
        if isinstance(value, Declared):
            value = self._named(name, value)
        elif isinstance(value, (Balance, Lag)):
            self.laws[name] = value
        super().__setitem__(name, value)

    def _named(self, name, declared):
        number, unit, meaning = declared.quantity
        if not (isinstance(unit, str) and unit and isinstance(meaning, str) and meaning):
            said = f"the unit {unit!r} and the meaning {meaning!r}"
            raise ValueError(
                f"{self.plant}.{name} has {said}: expected both, as 'kg/s' ('1' for a number) and 'inflow'"
            )
        symbol = _positive(name) if declared.is_parameter else _function(name)
        self.quantities[symbol] = declared.quantity
        if declared.formula is not None:
            self.measured[symbol] = declared.formula
        elif number is None:
            raise ValueError(f"{self.plant}.{name} has no value: expected a number, of a signal at the operating point")
        else:
            try:
                exact(number)
            except ValueError as error:
                raise ValueError(f"{self.plant}.{name}: {error}") from None
        if declared.limits is not None:
            self.limits[symbol] = checked_limits(f"{self.plant}: the limits of {name}", declared.limits, symbols=True)
        return symbol


class PlantMeta(type):
    """The metaclass of plants: it reads the bodies of their classes as declarations."""

    @classmethod
    def __prepare__(cls, name: str, bases: tuple[type, ...], **_: Any) -> dict[str, Any]:
        return ClassBody(name, bases)

    def __new__(cls, name: str, bases: tuple[type, ...], body: dict[str, Any], **more: Any) -> Any:
        if not isinstance(body, ClassBody):
            raise ValueError(f"{name} is made by type(): expected a class statement, or types.new_class")
        return super().__new__(cls, name, bases, dict(body) | {"_declared": body}, **more)
