"""A plant: its quantities and its laws stated once, everything else derived from them."""

from __future__ import annotations

import functools
from collections.abc import Mapping
from typing import Any

import sympy
from sympy.core.function import AppliedUndef
from sympy.polys.domains import QQ, ZZ
from sympy.polys.matrices import DomainMatrix

from loopbook.plants.checks import refuse_gaps
from loopbook.plants.declarations import Balance, ClassBody, Declared, Lag, PlantMeta, Quantity, name_of
from loopbook.stability import is_stable
from loopbook.transfer import simplified
from loopbook.types import Number
from plainmath.expressions import exact, s, t
from plainmath.validation import did_you_mean, exact_not_negative, exact_real

__all__ = ["Plant"]


class Plant(metaclass=PlantMeta):
    """A process with parameters, inputs, states and one measured output; a subclass states its physics.

    What its body declares by `signal`, `parameter` and `measured` are the quantities; each `Balance` or `Lag` in it is
    a law, but for a sum of balances, which follows from its parts. Besides it names the ``output``, the signal that is
    measured and controlled, and the input ``manipulated`` that a controller acts on. Where nothing flows at the
    operating point, ``at_work = {signal: value}`` says when something does. Where the units of the quantities do not
    count time in seconds but in minutes, hours or days, ``time_unit = "min"``, "h" or "d".

    Attributes:
        quantities: ``{symbol or signal: (value, unit, meaning)}``, all of them.
        laws: ``{name: Balance or Lag}``.
        balances: those laws that are balances, and their sums, by their names in words.
        measured: ``{measured signal: formula}``.
        model: the equations, a tuple: the laws, and what is measured.
        limits: ``{state: (lowest, highest)}``, numbers or parameters, where a state cannot leave a range.

    An instance has a number for each quantity, as an attribute of its name.

    Arguments:
        values: numbers that replace the default values, by name, in the units of `quantities`.
    Raises:
        ValueError: for an unknown name, for a value that is not a number, a negative parameter, or a
            state outside its limits; and where a class is made, for what is missing in its body.
    """

    output: sympy.Expr | Any = None
    manipulated: sympy.Expr | Any = None
    at_work: Mapping[sympy.Expr, Number] = {}
    time_unit: str = "s"
    quantities: Mapping[sympy.Expr, Quantity] = {}
    laws: Mapping[str, Balance | Lag] = {}
    balances: Mapping[str, Balance] = {}
    measured: Mapping[sympy.Expr, sympy.Expr] = {}
    model: tuple[sympy.Equality, ...] = ()
    limits: Mapping[sympy.Expr, tuple[Number, Number]] = {}
    values: Mapping[sympy.Expr, sympy.Expr] = {}
    _declared: ClassBody

    def __init_subclass__(cls) -> None:
        super().__init_subclass__()
        said = cls._declared
        cls.quantities = {**cls.quantities, **said.quantities}
        cls.measured = {**cls.measured, **said.measured}
        cls.limits, cls.laws = {**cls.limits, **said.limits}, {**cls.laws, **said.laws}
        balances = {name: law for name, law in cls.laws.items() if isinstance(law, Balance)}
        cls.balances = {name.replace("_", " "): balance for name, balance in balances.items()}
        independent = [law for law in cls.laws.values() if not (isinstance(law, Balance) and law.parts)]
        equations = [law.equation for law in independent]
        cls.model = (*equations, *(sympy.Eq(x, f, evaluate=False) for x, f in cls.measured.items()))
        if cls.quantities or cls.laws:
            refuse_gaps(cls, _states(cls), _inputs(cls), len(independent))
            said_of_it = (cls.__doc__ or cls.__name__).rstrip()
            cls.__doc__ = "\n".join([said_of_it, "", "    Attributes:", *_table(cls.quantities), "    "])

    def __init__(self, **values: Number):
        known = {name_of(symbol): symbol for symbol in self.quantities}
        measured = {name_of(x): f for x, f in self.measured.items()}
        for name in values:
            if name not in known:
                raise ValueError(f"{type(self).__name__} has no {name!r}: {did_you_mean(name, known)}")
            if name in measured:
                raise ValueError(f"{name} is not given but measured: it is {measured[name]}")
        self.values = {}
        for name, symbol in known.items():
            if name not in measured:
                self.values[symbol] = self._checked(name, symbol, values.get(name, self.quantities[symbol].value))
        for name, formula in measured.items():
            self.values[known[name]] = self.numbers(self._in_constants(formula))
        for state, limits in self.limits.items():
            low, high = (self.numbers(sympy.sympify(x)) for x in limits)
            if not low <= self.values[state] <= high or low == high:
                raise ValueError(
                    f"{name_of(state)} is {_short(self.values[state])}: expected a value from {low} to {high}"
                )
        self.__dict__.update({name_of(symbol): value for symbol, value in self.values.items()})

    @classmethod
    def declared(cls, names: str) -> list[Any]:
        """Return quantities of this plant, by their names, to be declared once more in the body of another class."""
        known = {name_of(x): x for x in cls.quantities}
        if unknown := [name for name in names.split() if name not in known]:
            raise ValueError(f"{cls.__name__} has no {unknown[0]!r}: {did_you_mean(unknown[0], known)}")
        chosen = [known[name] for name in names.split()]
        return [Declared(cls.quantities[x], x.is_Symbol, cls.limits.get(x), cls.measured.get(x)) for x in chosen]

    @staticmethod
    def _checked(name, symbol, value):
        check = exact_not_negative if symbol.is_Symbol else exact_real
        return check(name, value, symbols=False)

    def __setattr__(self, name: str, value: object) -> None:
        if name in {name_of(symbol) for symbol in self.quantities}:
            given = f"{type(self).__name__}({name}={value})"
            raise ValueError(f"{name} cannot be changed: make another plant, {given}")
        super().__setattr__(name, value)

    # -------------------------------------------------------------------------------------------- what it consists of

    @functools.cached_property
    def states(self) -> list[sympy.Expr]:
        """The signals whose derivatives the laws give; of a second derivative, the first is a state too."""
        return _states(self)

    @functools.cached_property
    def inputs(self) -> list[sympy.Expr]:
        """The signals that drive the plant, in the order of its table."""
        return _inputs(self)

    @property
    def parameters(self) -> list[sympy.Symbol]:
        """The symbols of the plant, in the order of its table."""
        return [symbol for symbol in self.quantities if symbol.is_Symbol]

    def signal(self, name: str | sympy.Expr) -> sympy.Expr:
        """Return the signal with this name, as ``T(t)`` for "T"; a signal itself is returned as it is.

        Raises ValueError for a name that is not a signal of the plant.
        """
        if isinstance(name, sympy.Basic) and name in self.quantities and not name.is_Symbol:
            return name
        found = {name_of(x): x for x in self.quantities if not x.is_Symbol}
        if not isinstance(name, str) or name not in found:
            raise ValueError(f"{name!r} is not a signal of {type(self).__name__}: {did_you_mean(name, found)}")
        return found[name]

    # ---------------------------------------------------------------------------------------- what follows from it

    def state_equations(self) -> dict[sympy.Expr, sympy.Expr]:
        """Return ``{state: its derivative}``, the state-space model. (Haugen, equations 2.5 and 2.6)

        >>> from loopbook.plants import MassSpringDamper
        >>> for state, rate in MassSpringDamper().state_equations().items():
        ...     print(state, "changes at the rate", rate)
        y(t) changes at the rate Derivative(y(t), t)
        Derivative(y(t), t) changes at the rate -D*Derivative(y(t), t)/m - K*y(t)/m + F(t)/m
        """
        try:
            return dict(_rates(self.model, tuple(self.states)))
        except ValueError as error:
            raise ValueError(f"{type(self).__name__}: {error}") from None

    def is_linear(self, source: str | sympy.Expr | None = None) -> bool:
        """Whether the effects of changes of any size add up, in the states and in what is measured.

        Arguments:
            source: an input, a name or a signal, to ask only about its effect on the output while the other inputs
                rest; all signals if not given.

        >>> from loopbook.plants import BlendingTank, WoodChipTank
        >>> WoodChipTank().is_linear(), BlendingTank().is_linear(), BlendingTank().is_linear("w_A")
        (True, False, True)
        """
        equations, moving = self.state_equations(), {*self.states, *self.inputs}
        formulas = [*equations.values(), *self.measured.values()]
        if source is not None:
            source, wanted = self.signal(source), self.measured.get(self.output, self.output)
            moving = self._between(equations, source, wanted)
            formulas = [*(equations[x] for x in moving), wanted]
            moving = {source, *moving}
        slopes = (_sensitivity(f, x) for f in formulas for x in moving)
        return not any(_signals_in(slope) & moving for slope in slopes)

    @property
    def is_self_regulating(self) -> bool:
        """Whether all states come to rest again when the inputs have moved a little and stay, as a level does not.

        >>> from loopbook.plants import HeatedTank, WoodChipTank
        >>> HeatedTank().is_self_regulating, WoodChipTank().is_self_regulating
        (True, False)
        """
        rates = self._active_equations.values()
        A = sympy.Matrix([[self._gain(rate, x, numbers=True) for x in self.states] for rate in rates])
        return is_stable(1 / (s * sympy.eye(len(rates)) - A).det(method="berkowitz"))

    def static_response(self, *unknowns: str | sympy.Expr) -> dict[sympy.Symbol, sympy.Expr]:
        """Return the steady state: the balance laws with all derivatives set to zero, solved. (Haugen, Section 2.5)

        Arguments:
            unknowns: what to solve for, names or signals: as many as there are balance laws. The states, if not given.
        Returns:
            ``{signal: expression}`` in the constant values of the other signals, which are written without ``(t)``.
        Raises:
            ValueError: where the balance laws do not determine the unknowns, as the level of a tank with given flows.

        >>> from loopbook.plants import MassSpringDamper, WoodChipTank
        >>> MassSpringDamper().static_response()
        {y: F/K}
        >>> WoodChipTank().static_response("u")
        {u: w_out/K_s}
        """
        wanted = unknowns or [x for x in self.states if not x.is_Derivative]
        wanted = list(dict.fromkeys(_symbol(self.signal(x)) for x in wanted))
        constant = self._in_constants(
            [equation.lhs - equation.rhs for equation in self.model if equation.has(sympy.Derivative)]
        )
        solved = sympy.solve(constant, wanted, dict=True)
        if len(solved) != 1 or set(solved[0]) != set(wanted):
            raise ValueError(
                f"the balance laws of {type(self).__name__} at rest do not determine {', '.join(map(str, wanted))}: "
                f"name another unknown"
            )
        return solved[0]

    def linear_model(
        self, output: str | sympy.Expr | None = None
    ) -> tuple[sympy.Matrix, sympy.Matrix, sympy.Matrix, sympy.Matrix]:
        """Return the matrices A, B, C, D of the model linearised at a steady state, in symbols.

        With small changes dx of the states, du of the inputs and dy of the output, dx' = A dx + B du and
        dy = C dx + D du. The operating point appears as the signals' symbols. Delayed inputs keep their delay, which
        the matrices do not show; `transfer_function` has it.

        Arguments:
            output: a state or a measured signal, a name or a signal; the plant's output if not given.
        Raises:
            ValueError: for a name that is none, and for a delayed state, in the rates or in what is measured: no
                matrices describe it.

        >>> from loopbook.plants import BlendingTank
        >>> A, B, C, D = BlendingTank().linear_model()
        >>> A, B
        (Matrix([[-q/V]]), Matrix([[1/V, -c_A/V]]))
        """
        states, rates = list(self._active_equations), list(self._active_equations.values())
        output = self.signal(self.output if output is None else output)
        measured = self._active(self.measured.get(output, output))
        for f in rates:
            self._refuse_delayed_states(f, "no matrices A, B describe it, use transfer_function")
        self._refuse_delayed_states(measured, "no matrix C describes it, use transfer_function or another output")
        return tuple(
            sympy.Matrix([[self._in_constants(_sensitivity(f, x)) for x in among] for f in functions])
            for functions in (rates, [measured])
            for among in (states, self.inputs)
        )

    def _refuse_delayed_states(self, f, what):
        delays = {x: self.numbers(t - x.args[0]) for x in f.atoms(AppliedUndef) if x.func(t) in self.states}
        for x in sorted((x for x, delay in delays.items() if delay), key=str):
            raise ValueError(f"{type(self).__name__} has the delayed state {x}: {what}")

    def transfer_function(
        self, source: str | sympy.Expr | None = None, output: str | sympy.Expr | None = None, numbers: bool = False
    ) -> sympy.Expr:
        """Derive the transfer function from an input to the output, at a steady state for a plant that is not linear.

        Arguments:
            source: the input, a name or a signal; the manipulated one if not given.
            output: a state or the measured output; the output if not given.
            numbers: True to put the plant's values in from the beginning, where symbols would take too long.
        Returns:
            An expression in `s` and the symbols; the method `numbers` puts the values in.
        Raises:
            ValueError: for a name that is no input or output of the plant.

        >>> from loopbook.plants import HeatedTank, WoodChipTank
        >>> WoodChipTank().transfer_function("u")
        K_s*exp(-s*tau)/(A*rho*s)
        >>> HeatedTank().transfer_function("T_i")
        F*c/(F*c + U_h + c*m*s)
        """
        source = self.signal(self.manipulated if source is None else source)
        output = self.signal(self.output if output is None else output)
        if source not in self.inputs:
            raise ValueError(f"{source} is not an input: {did_you_mean(source, map(name_of, self.inputs))}")
        equations = self._active_equations
        wanted = self._active(self.measured.get(output, output))
        if output in self.inputs:
            raise ValueError(f"{output} is an input: expected a state or {name_of(self.output)}")

        def gains(f, x):
            return self._gain(f, x, numbers)

        states = [x for x in equations if x in self._between(equations, source, wanted)]
        rates = [equations[x] for x in states]
        A = sympy.Matrix(len(states), len(states), [gains(rate, x) for rate in rates for x in states])
        B = sympy.Matrix(len(states), 1, [gains(rate, source) for rate in rates])
        C = sympy.Matrix(1, len(states), [gains(wanted, x) for x in states])
        response = (C * _solved(s * sympy.eye(len(states)) - A, B))[0] if states else 0
        return simplified(response + gains(wanted, source))

    def _gain(self, f, x, numbers):
        """What a small change of the signal x does to f, with its dead time."""
        if (x if x.is_Derivative else x.func(t)) not in _signals_in(f):
            return sympy.S.Zero
        if (f, x, numbers) not in self._known_gains:  # many transfer functions of a plant have most of them in common
            self._known_gains[f, x, numbers] = self._gain_of(f, x, numbers)
        return self._known_gains[f, x, numbers]

    @functools.cached_property
    def _known_gains(self):
        return {}

    def _gain_of(self, f, x, numbers):
        if numbers:  # for all but x beforehand, which leaves little to differentiate
            rates = {rate: sympy.Dummy() for rate in f.atoms(sympy.Derivative)}
            others = {y: self.values[y.func(t)] for y in f.atoms(AppliedUndef) if y.func != x.func}
            f = self.numbers(f.xreplace(others | rates)).xreplace({dummy: rate for rate, dummy in rates.items()})
        found = self._in_constants(_sensitivity(f, x, with_delay=True))
        return self.numbers(found) if numbers else found

    @functools.cached_property
    def _active_equations(self):
        return {x: self._active(rate) for x, rate in self.state_equations().items()}

    def _active(self, f):
        """The formula with, for each Max and Min, the one of its arguments that counts at the operating point."""

        def chosen(limit):
            values = [self.numbers(self._in_constants(part)) for part in limit.args]
            extreme = type(limit)(*values)
            return limit.args[values.index(extreme)] if values.count(extreme) == 1 else limit

        return f.replace(lambda x: isinstance(x, (sympy.Max, sympy.Min)), chosen) if f.has(sympy.Max, sympy.Min) else f

    @staticmethod
    def _between(equations, source, wanted):
        """The states on the ways from a signal to a formula: the others do not appear in the transfer function."""
        occurring = {x: _signals_in(rate) for x, rate in equations.items()}
        before, grown = _signals_in(wanted) & set(equations), True
        after = {x for x in equations if source in occurring[x]}
        while grown:
            more_before = before.union(*(occurring[x] & set(equations) for x in before))
            more_after = after | {x for x in equations if occurring[x] & after}
            grown = (more_before, more_after) != (before, after)
            before, after = more_before, more_after
        return before & after

    def numbers(self, *expressions: Number | sympy.Equality | sympy.MatrixBase) -> Any:
        """Put the plant's values in for its symbols: parameters, and signals at the operating point (T, but not T(t)).

        Arguments:
            expressions: expressions, equations or matrices.
        Returns:
            One for one, a tuple for several.

        >>> from loopbook.plants import WoodChipTank
        >>> tank = WoodChipTank()
        >>> tank.numbers(tank.transfer_function("w_out"))
        -1/(1943*s)
        """
        values = {_symbol(symbol): value for symbol, value in self.values.items()}
        checked = (x if isinstance(x, (sympy.Equality, sympy.MatrixBase)) else exact(x) for x in expressions)
        found = tuple(x.xreplace(values) for x in checked)
        return found[0] if len(found) == 1 else found

    def _in_constants(self, expression):
        """The expression at rest: derivatives are zero, and signals are constants, written as symbols."""
        if isinstance(expression, list):
            return [self._in_constants(part) for part in expression]
        still = sympy.sympify(expression).replace(lambda x: isinstance(x, sympy.Derivative), lambda x: sympy.S.Zero)
        return still.xreplace({x: _symbol(x.func(t)) for x in still.atoms(AppliedUndef)})

    # ----------------------------------------------------------------------------------------------- how it is shown

    def __repr__(self) -> str:
        values = ", ".join(f"{name_of(symbol)}={_short(value)}" for symbol, value in self.values.items())
        return f"{type(self).__name__}({values})"

    def _repr_html_(self):
        rows = [
            f"<tr><td>${_latex(symbol)}$</td><td>{_short(value)} {self.quantities[symbol].unit}</td>"
            f"<td style='text-align: left'>{self.quantities[symbol].meaning}</td></tr>"
            for symbol, value in self.values.items()
        ]
        title = (type(self).__doc__ or type(self).__name__).strip().splitlines()[0]
        return f"<table><caption>{title}</caption>{''.join(rows)}</table>"


# ------------------------------------------------------------------------------------------------ what it consists of


def _states(plant):
    orders = {}
    for derivative in sympy.Tuple(*plant.model).atoms(sympy.Derivative):
        orders[derivative.expr] = max(orders.get(derivative.expr, 0), derivative.derivative_count)
    return [x.diff(t, n) for x in plant.quantities if x in orders for n in range(orders[x])]


def _inputs(plant):
    inside = {x.func(t) for equation in plant.model for x in equation.atoms(AppliedUndef)}
    followed = {*_states(plant), *plant.measured}
    return [x for x in plant.quantities if x in inside and x not in followed]


def _table(quantities):
    """What the docstring says of the quantities, a line for each."""
    for x, (value, unit, meaning) in quantities.items():
        amount = "measured in" if value is None else _short(value)
        yield f"        {name_of(x)}: {meaning}, {amount}{'' if unit == '1' else f' {unit}'}"


@functools.lru_cache(maxsize=4096)
def _symbol(x):
    """The symbol that stands for a signal at its operating point."""
    return x if x.is_Symbol else sympy.Symbol(name_of(x), real=True)


@functools.lru_cache(maxsize=1024)
def _signals_in(expression):
    """The signals and derivatives in an expression, a delayed signal as the signal itself."""
    derivatives = expression.atoms(sympy.Derivative)
    rest = expression.xreplace({x: sympy.Dummy() for x in derivatives})
    return frozenset(derivatives | {x.func(t) for x in rest.atoms(AppliedUndef)})


def _solved(A, B):
    """The solution of A x = B; by SymPy's polynomials where it has numbers alone, since they cancel as they go."""
    if not (A.free_symbols | B.free_symbols) - {s}:
        polynomials, numbers = DomainMatrix.from_Matrix(A), DomainMatrix.from_Matrix(B)
        if polynomials.domain in (ZZ[s], QQ[s]) and numbers.domain in (ZZ, QQ):
            polynomials = polynomials.to_field()
            return polynomials.lu_solve(numbers.convert_to(polynomials.domain)).to_Matrix()
    return A.LUsolve(B)


@functools.lru_cache(maxsize=256)  # whatever their values, plants of a class have one model
def _rates(model, states):
    """``{state: its derivative}``, solved from the laws."""
    laws = [equation for equation in model if equation.has(sympy.Derivative)]
    highest = [x.diff(t) for x in states if x.diff(t) not in states]
    if any(law.has(sympy.Max, sympy.Min) for law in laws):
        solved = [_solved_one_by_one(laws, highest)]  # `solve` would tell the cases apart, all of them
    else:
        solved = sympy.solve(laws, highest, dict=True)
    if len(solved) != 1:
        raise ValueError(f"the laws do not determine {', '.join(map(str, highest))}")
    return {x: solved[0].get(x.diff(t), x.diff(t)) for x in states}


def _solved_one_by_one(laws, highest):
    """The rates, where the laws can be put in an order in which each has one rate more than those before."""
    found, left = {}, list(laws)
    while left:
        law = next((law for law in left if len(law.lhs.atoms(sympy.Derivative) & set(highest) - set(found)) == 1), None)
        if law is None:
            raise ValueError(
                f"{left[0].lhs} = {left[0].rhs} has a Max or Min: expected one rate alone on its left side"
            )
        (rate,) = law.lhs.atoms(sympy.Derivative) & set(highest) - set(found)
        factor, known = law.lhs.coeff(rate), (law.lhs - law.lhs.coeff(rate) * rate).expand()
        # what is known cancels in the sum, multiplied out, as the warmth of what flows out of a tank
        found[rate] = sympy.expand(law.rhs - known.xreplace(found)) / factor if known else law.rhs / factor
        left.remove(law)
    return found


def _latex(symbol):
    """A symbol as LaTeX, with everything behind its first underscore in the index: ``u_{valve,in}``."""
    name, _, index = name_of(symbol).partition("_")
    return f"{name}_{{{index.replace('_', ',')}}}" if "_" in index else sympy.latex(_symbol(symbol))


def _short(value):
    return f"{float(value):.6g}"


def _sensitivity(f, signal, with_delay=False):
    """The derivative of f with respect to a signal and to its delayed values, each with its dead time if wanted."""
    total = sympy.S.Zero
    if signal.is_Derivative:
        return f.diff(signal)
    f = f.xreplace({d: sympy.Dummy() for d in f.atoms(sympy.Derivative)})
    for occurrence in f.atoms(type(signal)):
        delay = t - occurrence.args[0]
        total += f.diff(occurrence) * (sympy.exp(-delay * s) if with_delay else 1)
    return total
