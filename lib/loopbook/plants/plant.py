"""A plant: its equations and its quantities stated once, everything else derived from them."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any, NamedTuple

import sympy
from sympy.core.function import AppliedUndef
from sympy.polys.domains import QQ, ZZ
from sympy.polys.matrices import DomainMatrix

from loopbook.expressions import exact, s, t
from loopbook.transfer import simplified
from loopbook.types import Number

__all__ = ["Plant", "Quantity", "name_of", "parameters", "signals"]


class Quantity(NamedTuple):
    """A parameter or a signal of a plant: its value (of a signal: at the operating point), unit and meaning.

    A measured signal has None for a value, which follows from the others.
    """

    value: Number | None
    unit: str
    meaning: str


def signals(names: str) -> tuple[AppliedUndef, ...]:
    """The functions of time with these names, as ``T(t)``."""
    return tuple(sympy.Function(name)(t) for name in names.split())


def parameters(names: str) -> tuple[sympy.Symbol, ...]:
    """The letters with these names; parameters are positive."""
    return tuple(sympy.Symbol(name, positive=True) for name in names.split())


class Plant:
    """A process with parameters, inputs, states and one measured output; a subclass states its physics.

    Attributes of the class:
        model: the equations, a tuple of SymPy equations. Each with a derivative is a balance law; one without says what
            is measured. A signal may be delayed, as ``u(t - tau)``.
        output: the signal that is measured and controlled.
        manipulated: the input that a controller acts on.
        quantities: ``{letter or signal: (value, unit, meaning)}``, all of them.
        limits: ``{state: (lowest, highest)}``, numbers or letters, where the state cannot leave a range.
        balances: ``{name: (content, net inflow)}``: the mass or the energy in the plant, of which the net inflow is the
            rate of change; both in signals and letters.

    An instance has a number for each quantity, as an attribute of its name.

    Arguments:
        values: numbers that replace the default values, by name, in the units of `quantities`.
    Raises:
        ValueError: for a name that the plant does not have, for a value that is no number, a negative parameter, or a
            state outside its limits.
    """

    # a class states its model and its quantities in short, and has them in full afterwards
    model: tuple[sympy.Equality, ...] | Any = ()
    output: sympy.Expr | Any = None
    manipulated: sympy.Expr | Any = None
    quantities: Mapping[sympy.Expr, Quantity | Any] = {}
    limits: Mapping[sympy.Expr, tuple[Number, Number]] = {}
    balances: Mapping[str, tuple[sympy.Expr, sympy.Expr]] = {}
    values: dict[sympy.Expr, sympy.Expr]

    def __init_subclass__(cls) -> None:
        super().__init_subclass__()
        cls.model = (cls.model,) if isinstance(cls.model, sympy.Equality) else tuple(cls.model)
        cls.quantities = {letter: Quantity(*row) for letter, row in cls.quantities.items()}

    def __init__(self, **values: Number):
        known = {name_of(letter): letter for letter in self.quantities}
        measured = {name_of(x): f for x, f in self.measured.items()}
        for name in values:
            if name not in known:
                raise ValueError(f"{type(self).__name__} has no {name!r}: it has {', '.join(known)}")
            if name in measured:
                raise ValueError(f"{name} is not given but measured: it is {measured[name]}")
        self.values = {}
        for name, letter in known.items():
            if name not in measured:
                self.values[letter] = self._checked(name, letter, values.get(name, self.quantities[letter].value))
        for name, formula in measured.items():
            self.values[known[name]] = self.numbers(self._in_constants(formula))
        for state, limits in self.limits.items():
            low, high = (self.numbers(sympy.sympify(x)) for x in limits)
            if not low <= self.values[state] <= high or low == high:
                raise ValueError(
                    f"{name_of(state)} is {_short(self.values[state])}: expected a value from {low} to {high}"
                )
        self.__dict__.update({name_of(letter): value for letter, value in self.values.items()})

    @staticmethod
    def _checked(name, letter, value):
        try:
            value = exact(value)
        except ValueError as error:
            raise ValueError(f"{name}: {error}") from None
        if not (value.is_number and value.is_finite and value.is_real):
            raise ValueError(f"{name} is {value}: expected a number")
        if letter.is_Symbol and value < 0:
            raise ValueError(f"{name} is {value}: expected a parameter that is not negative")
        return value

    def __setattr__(self, name: str, value: object) -> None:
        if name in {name_of(letter) for letter in self.quantities}:
            given = f"{type(self).__name__}({name}={value})"
            raise ValueError(f"{name} cannot be changed: make another plant, {given}")
        super().__setattr__(name, value)

    # -------------------------------------------------------------------------------------------- what it consists of

    @property
    def states(self) -> list[sympy.Expr]:
        """The signals whose derivatives the balance laws give; of a second derivative, the first is a state too."""
        orders = {}
        for derivative in sympy.Tuple(*self.model).atoms(sympy.Derivative):
            orders[derivative.expr] = max(orders.get(derivative.expr, 0), derivative.derivative_count)
        return [x.diff(t, n) for x in self.quantities if x in orders for n in range(orders[x])]

    @property
    def inputs(self) -> list[sympy.Expr]:
        """The signals that drive the plant, in the order of its table."""
        inside = {x.subs(x.args[0], t) for x in sympy.Tuple(*self.model).atoms(AppliedUndef)}
        followed = {*self.states, *self.measured}
        return [x for x in self.quantities if x in inside and x not in followed]

    @property
    def parameters(self) -> list[sympy.Symbol]:
        """The letters of the plant, in the order of its table."""
        return [letter for letter in self.quantities if letter.is_Symbol]

    @property
    def measured(self) -> dict[sympy.Expr, sympy.Expr]:
        """What the equations without derivatives say: ``{measured signal: formula}``."""
        return {equation.lhs: equation.rhs for equation in self.model if not equation.has(sympy.Derivative)}

    def signal(self, name: str | sympy.Expr) -> sympy.Expr:
        """Return the signal with this name, as ``T(t)`` for "T"; a signal itself is returned as it is.

        Raises ValueError for a name that is no signal of the plant.
        """
        if isinstance(name, sympy.Basic) and name in self.quantities and not name.is_Symbol:
            return name
        found = {name_of(x): x for x in self.quantities if not x.is_Symbol}
        if not isinstance(name, str) or name not in found:
            raise ValueError(f"{name!r} is no signal of {type(self).__name__}: it has {', '.join(found)}")
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
        balances = [equation for equation in self.model if equation.has(sympy.Derivative)]
        states = self.states
        highest = [x.diff(t) for x in states if x.diff(t) not in states]
        if any(equation.has(sympy.Max, sympy.Min) for equation in balances):
            solved = [_solved_one_by_one(balances, highest)]  # `solve` would tell the cases apart, all of them
        else:
            solved = sympy.solve(balances, highest, dict=True)
        if len(solved) != 1:
            raise ValueError(f"the equations of {type(self).__name__} do not determine {highest}")
        return {x: solved[0].get(x.diff(t), x.diff(t)) for x in states}

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
        wanted = list(dict.fromkeys(_letter(self.signal(x)) for x in wanted))
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

    def linear_model(self) -> tuple[sympy.Matrix, sympy.Matrix, sympy.Matrix, sympy.Matrix]:
        """Return the matrices A, B, C, D of the model linearised at a steady state, in letters.

        With small changes dx of the states, du of the inputs and dy of the output, dx' = A dx + B du and
        dy = C dx + D du. The operating point appears as the signals' letters. Delayed inputs keep their delay, which
        the matrices do not show; `transfer_function` has it.

        >>> from loopbook.plants import BlendingTank
        >>> A, B, C, D = BlendingTank().linear_model()
        >>> A, B
        (Matrix([[-q/V]]), Matrix([[1/V, -c_A/V]]))
        """
        equations = self.state_equations()
        states, rates = list(equations), [self._active(rate) for rate in equations.values()]
        measured = self._active(self.measured.get(self.output, self.output))
        return tuple(
            sympy.Matrix([[self._in_constants(_sensitivity(f, x)) for x in among] for f in functions])
            for functions in (rates, [measured])
            for among in (states, self.inputs)
        )

    def transfer_function(
        self, source: str | sympy.Expr | None = None, output: str | sympy.Expr | None = None, numbers: bool = False
    ) -> sympy.Expr:
        """Derive the transfer function from an input to the output, at a steady state for a plant that is not linear.

        Arguments:
            source: the input, a name or a signal; the manipulated one if not given.
            output: a state or the measured output; the output if not given.
            numbers: True to put the plant's values in from the beginning, where letters would take too long.
        Returns:
            An expression in `s` and the letters; the method `numbers` puts the values in.
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
            raise ValueError(f"{source} is no input: expected one of {', '.join(map(name_of, self.inputs))}")
        equations = {x: self._active(rate) for x, rate in self.state_equations().items()}
        wanted = self._active(self.measured.get(output, output))
        if output in self.inputs:
            raise ValueError(f"{output} is an input: expected a state or {name_of(self.output)}")

        def gains(f, x):  # what a small change of the signal x does to f, with its dead time
            if numbers:  # for all but x beforehand, which leaves little to differentiate
                f = f.xreplace({y: self.values[y.func(t)] for y in f.atoms(AppliedUndef) if y.func != x.func})
                f = self.numbers(f)
            found = self._in_constants(_sensitivity(f, x, with_delay=True))
            return self.numbers(found) if numbers else found

        states = [x for x in equations if x in self._between(equations, source, wanted)]
        rates = [equations[x] for x in states]
        A = sympy.Matrix(len(states), len(states), [gains(rate, x) for rate in rates for x in states])
        B = sympy.Matrix(len(states), 1, [gains(rate, source) for rate in rates])
        C = sympy.Matrix(1, len(states), [gains(wanted, x) for x in states])
        response = (C * _solved(s * sympy.eye(len(states)) - A, B))[0] if states else 0
        return simplified(response + gains(wanted, source))

    def _active(self, f):
        """The formula with, for each Max and Min, the one of its arguments that counts at the operating point."""

        def chosen(limit):
            values = [self.numbers(self._in_constants(part)) for part in limit.args]
            extreme = type(limit)(*values)
            return limit.args[values.index(extreme)] if values.count(extreme) == 1 else limit

        return f.replace(lambda x: isinstance(x, (sympy.Max, sympy.Min)), chosen)

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
        """Put the plant's values in for its letters: parameters, and signals at the operating point (T, but not T(t)).

        Arguments:
            expressions: expressions, equations or matrices.
        Returns:
            One for one, a tuple for several.

        >>> from loopbook.plants import WoodChipTank
        >>> tank = WoodChipTank()
        >>> tank.numbers(tank.transfer_function("w_out"))
        -1/(1943*s)
        """
        values = {_letter(letter): value for letter, value in self.values.items()}
        checked = (x if isinstance(x, (sympy.Equality, sympy.MatrixBase)) else exact(x) for x in expressions)
        found = tuple(x.xreplace(values) for x in checked)
        return found[0] if len(found) == 1 else found

    def _in_constants(self, expression):
        """The expression at rest: derivatives are zero, and signals are constants, written as letters."""
        if isinstance(expression, list):
            return [self._in_constants(part) for part in expression]
        still = sympy.sympify(expression).replace(lambda x: isinstance(x, sympy.Derivative), lambda x: sympy.S.Zero)
        return still.xreplace({x: _letter(x.func(t)) for x in still.atoms(AppliedUndef)})

    # ----------------------------------------------------------------------------------------------- how it is shown

    def __repr__(self) -> str:
        values = ", ".join(f"{name_of(letter)}={_short(value)}" for letter, value in self.values.items())
        return f"{type(self).__name__}({values})"

    def _repr_html_(self):
        rows = [
            f"<tr><td>${_latex(letter)}$</td><td>{_short(value)} {self.quantities[letter].unit}</td>"
            f"<td style='text-align: left'>{self.quantities[letter].meaning}</td></tr>"
            for letter, value in self.values.items()
        ]
        title = (type(self).__doc__ or type(self).__name__).strip().splitlines()[0]
        return f"<table><caption>{title}</caption>{''.join(rows)}</table>"


def name_of(x: sympy.Expr) -> str:
    """How a quantity is called in Python: T for T(t)."""
    if x.is_Derivative:
        return f"{name_of(x.expr)}_{'dot' * x.derivative_count}"
    return str(x.func) if isinstance(x, AppliedUndef) else str(x)


def _letter(x):
    """The letter that stands for a signal at its operating point."""
    return x if x.is_Symbol else sympy.Symbol(name_of(x), real=True)


def _signals_in(expression):
    """The signals and derivatives in an expression, a delayed signal as the signal itself."""
    derivatives = expression.atoms(sympy.Derivative)
    rest = expression.xreplace({x: sympy.Dummy() for x in derivatives})
    return derivatives | {x.func(t) for x in rest.atoms(AppliedUndef)}


def _solved(A, B):
    """The solution of A x = B; by SymPy's polynomials where it has numbers alone, since they cancel as they go."""
    if not (A.free_symbols | B.free_symbols) - {s}:
        polynomials, numbers = DomainMatrix.from_Matrix(A), DomainMatrix.from_Matrix(B)
        if polynomials.domain in (ZZ[s], QQ[s]) and numbers.domain in (ZZ, QQ):
            polynomials = polynomials.to_field()
            return polynomials.lu_solve(numbers.convert_to(polynomials.domain)).to_Matrix()
    return A.LUsolve(B)


def _solved_one_by_one(balances, highest):
    """The rates, where every balance law has one of them on its left side, perhaps with a factor, and nowhere else."""
    found = {}
    for law in balances:
        rate = next((x for x in highest if law.lhs.has(x) and x not in found), None)
        factor = law.lhs.coeff(rate) if rate else 0
        if not factor or law.lhs != factor * rate or law.rhs.has(*highest):
            raise ValueError(f"{law.lhs} = {law.rhs} has a Max or Min: expected a rate with a factor on its left side")
        found[rate] = law.rhs / factor
    return found


def _latex(letter):
    """A letter as LaTeX, with everything behind its first underscore in the index: u_{valve,in}."""
    name, _, index = name_of(letter).partition("_")
    return f"{name}_{{{index.replace('_', ',')}}}" if "_" in index else sympy.latex(_letter(letter))


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
