"""The books' physical processes, each stated once: by its balance law.

A plant is a class whose body is the physics: the equations as the book writes them, and a table of the quantities with
their values and units. The state equations, the static response, the linear model, the transfer functions and the
simulation (`loopbook.simulation`) are all derived from these equations.

Signals are functions of time, ``T(t)``, parameters are letters. ``HeatedTank.m`` is the letter, ``HeatedTank(m=80).m``
the number.
"""

from typing import NamedTuple

import sympy
from sympy.core.function import AppliedUndef

from loopbook.expressions import exact, s, t
from loopbook.transfer import polynomials, simplified

__all__ = [
    "AirHeater", "AirHeaterWithFan", "BlendingTank", "BufferTank", "HeatedTank", "HeatedTankWithElement",
    "HeatedTankWithTransport", "JacketedTank", "LiquidTank", "MassSpringDamper", "MotorWithLoad", "Plant", "Process",
    "Quantity", "RCCircuit", "WoodChipTank", "capacitor", "inductor", "resistor", "resistors_in_parallel",
    "resistors_in_series",
]  # fmt: skip


class Quantity(NamedTuple):
    """A parameter or a signal of a plant: its value (of a signal: at the operating point), unit and meaning.

    A measured signal has None for a value, which follows from the others.
    """

    value: object
    unit: str
    meaning: str


def signals(names):
    """The functions of time with these names, as ``T(t)``."""
    return tuple(sympy.Function(name)(t) for name in names.split())


def parameters(names):
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

    An instance has a number for each quantity, as an attribute of its name.

    Arguments:
        values: numbers that replace the default values, by name, in the units of `quantities`.
    Raises:
        ValueError: for a name that the plant does not have, for a value that is no number, a negative parameter, or a
            state outside its limits.
    """

    model = ()
    output = manipulated = None
    quantities = {}
    limits = {}

    def __init_subclass__(cls):
        super().__init_subclass__()
        cls.model = (cls.model,) if isinstance(cls.model, sympy.Equality) else tuple(cls.model)
        cls.quantities = {letter: Quantity(*row) for letter, row in cls.quantities.items()}

    def __init__(self, **values):
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

    def __setattr__(self, name, value):
        if name in {name_of(letter) for letter in self.quantities}:
            given = f"{type(self).__name__}({name}={value})"
            raise ValueError(f"{name} cannot be changed: make another plant, {given}")
        super().__setattr__(name, value)

    # -------------------------------------------------------------------------------------------- what it consists of

    @property
    def states(self):
        """The signals whose derivatives the balance laws give; of a second derivative, the first is a state too."""
        orders = {}
        for derivative in sympy.Tuple(*self.model).atoms(sympy.Derivative):
            orders[derivative.expr] = max(orders.get(derivative.expr, 0), derivative.derivative_count)
        return [x.diff(t, n) for x in self.quantities if x in orders for n in range(orders[x])]

    @property
    def inputs(self):
        """The signals that drive the plant, in the order of its table."""
        inside = {x.subs(x.args[0], t) for x in sympy.Tuple(*self.model).atoms(AppliedUndef)}
        return [x for x in self.quantities if x in inside and x not in {*self.states, *self.measured}]

    @property
    def parameters(self):
        """The letters of the plant, in the order of its table."""
        return [letter for letter in self.quantities if letter.is_Symbol]

    @property
    def measured(self):
        """What the equations without derivatives say: ``{measured signal: formula}``."""
        return {equation.lhs: equation.rhs for equation in self.model if not equation.has(sympy.Derivative)}

    def signal(self, name):
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

    def state_equations(self):
        """Return ``{state: its derivative}``, the state-space model. (Haugen, equations 2.5 and 2.6)

        >>> for state, rate in MassSpringDamper().state_equations().items():
        ...     print(state, "changes at the rate", rate)
        y(t) changes at the rate Derivative(y(t), t)
        Derivative(y(t), t) changes at the rate -D*Derivative(y(t), t)/m - K*y(t)/m + F(t)/m
        """
        balances = [equation for equation in self.model if equation.has(sympy.Derivative)]
        states = self.states
        highest = [x.diff(t) for x in states if x.diff(t) not in states]
        solved = sympy.solve(balances, highest, dict=True)
        if len(solved) != 1:
            raise ValueError(f"the equations of {type(self).__name__} do not determine {highest}")
        return {x: solved[0].get(x.diff(t), x.diff(t)) for x in states}

    def static_response(self, *unknowns):
        """Return the steady state: the balance laws with all derivatives set to zero, solved. (Haugen, Section 2.5)

        Arguments:
            unknowns: what to solve for, names or signals: as many as there are balance laws. The states, if not given.
        Returns:
            ``{signal: expression}`` in the constant values of the other signals, which are written without ``(t)``.
        Raises:
            ValueError: where the balance laws do not determine the unknowns, as the level of a tank with given flows.

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

    def linear_model(self):
        """Return the matrices A, B, C, D of the model linearised at a steady state, in letters.

        With small changes dx of the states, du of the inputs and dy of the output, dx' = A dx + B du and
        dy = C dx + D du. The operating point appears as the signals' letters. Delayed inputs keep their delay, which
        the matrices do not show; `transfer_function` has it.

        >>> A, B, C, D = BlendingTank().linear_model()
        >>> A, B
        (Matrix([[-q/V]]), Matrix([[1/V, -c_A/V]]))
        """
        states, rates = list(self.state_equations()), list(self.state_equations().values())
        return tuple(
            sympy.Matrix([[self._in_constants(_sensitivity(f, x)) for x in among] for f in functions])
            for functions in (rates, [self.measured.get(self.output, self.output)])
            for among in (states, self.inputs)
        )

    def transfer_function(self, source=None, output=None):
        """Derive the transfer function from an input to the output, at a steady state for a plant that is not linear.

        Arguments:
            source: the input, a name or a signal; the manipulated one if not given.
            output: a state or the measured output; the output if not given.
        Returns:
            An expression in `s` and the letters; `numbers` puts the values in.
        Raises:
            ValueError: for a name that is no input or output of the plant.

        >>> WoodChipTank().transfer_function("u")
        K_s*exp(-s*tau)/(A*rho*s)
        >>> HeatedTank().transfer_function("T_i")
        F*c/(F*c + U_h + c*m*s)
        """
        source = self.signal(self.manipulated if source is None else source)
        output = self.signal(self.output if output is None else output)
        if source not in self.inputs:
            raise ValueError(f"{source} is no input: expected one of {', '.join(map(name_of, self.inputs))}")
        equations = self.state_equations()
        states = list(equations)
        wanted = self.measured.get(output, output)
        if output in self.inputs:
            raise ValueError(f"{output} is an input: expected a state or {name_of(self.output)}")

        def gains(f, x):  # what a small change of the signal x does to f, with its dead time
            return self._in_constants(_sensitivity(f, x, with_delay=True))

        A = sympy.Matrix([[gains(rate, x) for x in states] for rate in equations.values()])
        B = sympy.Matrix([gains(rate, source) for rate in equations.values()])
        C = sympy.Matrix([[gains(wanted, x) for x in states]])
        response = (s * sympy.eye(len(states)) - A).LUsolve(B)
        return simplified((C * response)[0] + gains(wanted, source))

    def numbers(self, *expressions):
        """Put the plant's values in for its letters: parameters, and signals at the operating point (T, but not T(t)).

        Arguments:
            expressions: expressions, equations or matrices.
        Returns:
            One for one, a tuple for several.

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

    def __repr__(self):
        values = ", ".join(f"{name_of(letter)}={_short(value)}" for letter, value in self.values.items())
        return f"{type(self).__name__}({values})"

    def _repr_html_(self):
        rows = [
            f"<tr><td>${sympy.latex(_letter(letter))}$</td><td>{_short(value)} {self.quantities[letter].unit}</td>"
            f"<td style='text-align: left'>{self.quantities[letter].meaning}</td></tr>"
            for letter, value in self.values.items()
        ]
        title = (type(self).__doc__ or type(self).__name__).strip().splitlines()[0]
        return f"<table><caption>{title}</caption>{''.join(rows)}</table>"


def name_of(x):
    """How a quantity is called in Python: T for T(t)."""
    if x.is_Derivative:
        return f"{name_of(x.expr)}_{'dot' * x.derivative_count}"
    return str(x.func) if isinstance(x, AppliedUndef) else str(x)


def _letter(x):
    """The letter that stands for a signal at its operating point."""
    return x if x.is_Symbol else sympy.Symbol(name_of(x), real=True)


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


# ------------------------------------------------------------------------------------------------ motion


class MassSpringDamper(Plant):
    """A mass on a spring and a damper, moved by a force. (Haugen, Example 2.1, equation 2.3)

    The book prints K and F. The mass and the damping are ours.
    """

    y, F = signals("y F")
    m, D, K = parameters("m D K")
    model = sympy.Eq(m * y.diff(t, 2), F - D * y.diff(t) - K * y)
    output, manipulated = y, F
    quantities = {
        m: (20, "kg", "mass"),
        D: (4, "N/(m/s)", "damping constant"),
        K: (2, "N/m", "spring constant"),
        F: (0, "N", "applied force"),
        y: (0, "m", "position"),
    }


class MotorWithLoad(Plant):
    """A motor that moves a load along a line, by a gear and a rod. (Haugen, Example 3.4, equation 3.33)

    The book prints no values; these are ours.
    """

    y, i_m, F_L = signals("y i_m F_L")
    m, J, r, K_T = parameters("m J r K_T")
    model = sympy.Eq((m + J / r**2) * y.diff(t, 2), K_T / r * i_m - F_L)
    output, manipulated = y, i_m
    quantities = {
        m: (10, "kg", "mass of rod and load"),
        J: (0.004, "kg m²", "moment of inertia of motor and gear"),
        r: (0.02, "m", "radius of the gear"),
        K_T: (0.1, "N m/A", "torque constant of the motor"),
        i_m: (0, "A", "motor current"),
        F_L: (0, "N", "load force"),
        y: (0, "m", "position"),
    }


# ------------------------------------------------------------------------------------------------ electricity


def resistor(v, i, R):
    """Ohm's law for a resistor of R [ohm]: voltage v [V], current i [A]. (Haugen, equation 3.38)

    >>> v, i = signals("v i")
    >>> resistor(v, i, 100)
    Eq(v(t), 100*i(t))
    """
    return sympy.Eq(v, exact(R) * i)


def capacitor(v, i, C):
    """The current into a capacitor of C [F] changes its voltage. (Haugen, equation 3.39)

    >>> v, i = signals("v i")
    >>> capacitor(v, i, sympy.Symbol("C"))
    Eq(i(t), C*Derivative(v(t), t))
    """
    return sympy.Eq(i, exact(C) * sympy.diff(v, t))


def inductor(v, i, L):
    """The voltage over an inductor of L [H] changes its current. (Haugen, equation 3.40)

    >>> v, i = signals("v i")
    >>> inductor(v, i, sympy.Symbol("L"))
    Eq(v(t), L*Derivative(i(t), t))
    """
    return sympy.Eq(v, exact(L) * sympy.diff(i, t))


def resistors_in_series(*resistances):
    """The resistance of resistors in series: their sum. (Haugen, equation 3.36)

    >>> resistors_in_series(100, 300)
    400
    """
    return sympy.Add(*map(exact, resistances))


def resistors_in_parallel(*resistances):
    """The resistance of resistors in parallel: their conductances add up. (Haugen, equation 3.37)

    >>> resistors_in_parallel(100, 300)
    75
    """
    return sympy.factor(1 / sympy.Add(*(1 / exact(R) for R in resistances)))


class RCCircuit(Plant):
    """A resistor and a capacitor as a lowpass filter. (Haugen, Example 3.5, equation 3.46)

    The book prints no values; these are ours.
    """

    v_out, v_in = signals("v_out v_in")
    R, C = parameters("R C")
    model = sympy.Eq(R * C * v_out.diff(t), v_in - v_out)
    output, manipulated = v_out, v_in
    quantities = {
        R: (1000, "ohm", "resistance"),
        C: (0.001, "F", "capacitance"),
        v_in: (0, "V", "input voltage"),
        v_out: (0, "V", "output voltage"),
    }


# ------------------------------------------------------------------------------------------------ material


class LiquidTank(Plant):
    """A tank with pumped inflow and outflow. (Haugen, Example 3.1, equation 3.7)

    The book prints no values; these are ours.
    """

    h, q_i, q_o = signals("h q_i q_o")
    A, h_min, h_max = parameters("A h_min h_max")
    model = sympy.Eq(A * h.diff(t), q_i - q_o)
    output, manipulated = h, q_i
    limits = {h: (h_min, h_max)}
    quantities = {
        A: (1, "m²", "cross-sectional area"),
        h_min: (0, "m", "lowest level"),
        h_max: (1, "m", "highest level"),
        q_i: (0, "m³/s", "volumetric inflow"),
        q_o: (0, "m³/s", "volumetric outflow"),
        h: (0.5, "m", "level"),
    }


class BufferTank(Plant):
    """A liquid tank with mass flows, as for feedforward and for flow smoothing. (Haugen, equations 8.2 and 11.4)

    The density and the area are those of Example 11.5; Example 8.1's area is not printed. The heights are ours.
    """

    h, F_in, F_out = signals("h F_in F_out")
    rho, A, h_min, h_max = parameters("rho A h_min h_max")
    model = sympy.Eq(rho * A * h.diff(t), F_in - F_out)
    output, manipulated = h, F_in
    limits = {h: (h_min, h_max)}
    quantities = {
        rho: (1000, "kg/m³", "density"),
        A: (0.2, "m²", "cross-sectional area"),
        h_min: (0, "m", "lowest level"),
        h_max: (2, "m", "highest level"),
        F_in: (0, "kg/s", "mass inflow"),
        F_out: (0, "kg/s", "mass outflow"),
        h: (1, "m", "level"),
    }


class WoodChipTank(Plant):
    """The wood-chip tank with feed screw and conveyor belt. (Haugen, Section 1.2)

    The text prints the area, the time on the belt, the flow and that 45 % of the control signal are 1500 kg/min, from
    which the gain of the feed screw follows. The density is from the author's other public material. Flows are in kg/s.
    """

    h, u, w_out = signals("h u w_out")
    rho, A, K_s, tau, h_min, h_max = parameters("rho A K_s tau h_min h_max")
    model = sympy.Eq(rho * A * h.diff(t), K_s * u.subs(t, t - tau) - w_out)
    output, manipulated = h, u
    limits = {h: (h_min, h_max)}
    quantities = {
        rho: (145, "kg/m³", "density of the wood chip"),
        A: (13.4, "m²", "cross-sectional area"),
        K_s: (sympy.Rational(5, 9), "(kg/s)/%", "gain of the feed screw"),
        tau: (250, "s", "time on the conveyor belt"),
        h_min: (0, "m", "lowest level"),
        h_max: (15, "m", "highest level"),
        u: (45, "%", "control signal of the feed screw"),
        w_out: (25, "kg/s", "outflow"),
        h: (10, "m", "level"),
    }


class BlendingTank(Plant):
    """A stirred tank in which a material A is blended into a raw material. (Haugen, Example 3.2, equation 3.9)

    It is not linear: the outflow carries away the product of concentration and flow. The book prints no values; these
    are ours, and the operating point is a steady state.
    """

    c_A, w_A, q = signals("c_A w_A q")
    V = sympy.Symbol("V", positive=True)
    model = sympy.Eq(V * c_A.diff(t), w_A - c_A * q)
    output, manipulated = c_A, w_A
    limits = {c_A: (0, sympy.oo)}
    quantities = {
        V: (2, "m³", "volume of the liquid"),
        w_A: (0.02, "mol/s", "mole flow of material A"),
        q: (0.01, "m³/s", "volumetric flow of the raw material, and out of the tank"),
        c_A: (2, "mol/m³", "mole density of A in the tank"),
    }


# ------------------------------------------------------------------------------------------------ heat


class HeatedTank(Plant):
    """A stirred tank with a heating element and continuous flow. (Haugen, Example 3.3, equation 3.18)

    ``U_h=0`` makes it insulated, as in Example 6.2. The book prints no values; these are ours, and the operating point
    is a steady state.
    """

    T, P, F, T_i, T_e = signals("T P F T_i T_e")
    c, m, U_h = parameters("c m U_h")
    model = sympy.Eq(c * m * T.diff(t), P + c * F * (T_i - T) + U_h * (T_e - T))
    output, manipulated = T, P
    quantities = {
        c: (4200, "J/(kg K)", "specific heat capacity"),
        m: (100, "kg", "mass of the liquid"),
        U_h: (160, "W/K", "heat transfer coefficient to the environment"),
        P: (10000, "W", "power of the heating element"),
        F: (0.2, "kg/s", "mass flow"),
        T_i: (20, "°C", "temperature of the inflow"),
        T_e: (20, "°C", "temperature of the environment"),
        T: (30, "°C", "temperature in the tank and of the outflow"),
    }


class HeatedTankWithElement(HeatedTank):
    """The heated tank whose heating element stores heat: its power reaches the liquid through a lag.

    Example 3.3 of Haugen neglects this lag; P is the power supplied, Q the power that the liquid receives.
    """

    T, P, F, T_i, T_e, Q = signals("T P F T_i T_e Q")
    c, m, U_h, T_h = parameters("c m U_h T_h")
    model = (
        sympy.Eq(c * m * T.diff(t), Q + c * F * (T_i - T) + U_h * (T_e - T)),
        sympy.Eq(T_h * Q.diff(t), P - Q),
    )
    quantities = HeatedTank.quantities | {
        T_h: (60, "s", "lag of the heating element"),
        Q: (10000, "W", "power that the liquid receives"),
    }


class HeatedTankWithTransport(Plant):
    """The insulated heated tank under control, its sensor some way off. (Haugen, equations 10.33 and 10.34)

    The delay is a parameter; in Example 10.4 it is inversely proportional to the flow. The book prints the flows 12 to
    24 kg/min. The other values are ours, and the operating point is a steady state.
    """

    T, T_1, u, w, T_in = signals("T T_1 u w T_in")
    c, rho, V, K_P, tau = parameters("c rho V K_P tau")
    model = (
        sympy.Eq(c * rho * V * T_1.diff(t), K_P * u + c * w * (T_in - T_1)),
        sympy.Eq(T, T_1.subs(t, t - tau)),
    )
    output, manipulated = T, u
    quantities = {
        c: (4200, "J/(kg K)", "specific heat capacity"),
        rho: (1000, "kg/m³", "density"),
        V: (0.2, "m³", "volume of the liquid"),
        K_P: (420, "W/%", "gain of the power amplifier"),
        tau: (60, "s", "transport delay from the tank to the sensor"),
        u: (40, "%", "control signal"),
        w: (0.2, "kg/s", "mass flow"),
        T_in: (20, "°C", "temperature of the inflow"),
        T_1: (40, "°C", "temperature in the tank"),
        T: (None, "°C", "temperature at the sensor"),
    }


class AirHeater(Plant):
    """A heated air tube, as of the laboratory process of Haugen, Example 8.2.

    The book prints only the temperatures 20 to 70 °C of its scale. The model, a lag with dead time above the
    temperature of the room, and its values are in the author's other public material.
    """

    T, T_rise, u, T_env = signals("T T_rise u T_env")
    K, theta, tau = parameters("K theta tau")
    model = (
        sympy.Eq(theta * T_rise.diff(t), K * u.subs(t, t - tau) - T_rise),
        sympy.Eq(T, T_env + T_rise),
    )
    output, manipulated = T, u
    quantities = {
        K: (3.5, "K/V", "gain of the heater"),
        theta: (23, "s", "lag of the heater"),
        tau: (3, "s", "dead time of the air flow"),
        u: (0, "V", "control signal of the heater"),
        T_env: (21.5, "°C", "temperature of the room"),
        T_rise: (0, "K", "rise of the temperature"),
        T: (None, "°C", "temperature at the outlet"),
    }


class AirHeaterWithFan(AirHeater):
    """The air heater with a fan, the disturbance of Haugen, Example 8.2. The model and its values are ours.

    The pressure of the fan grows with the square of its speed and adds to that of the natural draught, and the flow of
    air grows with the square root of the sum: relative to the fan at rest it is sqrt(1 + (d/d_0)^2). More air carries
    more heat away.
    """

    T, T_rise, u, T_env, d = signals("T T_rise u T_env d")
    K, theta, tau, d_0 = parameters("K theta tau d_0")
    flow = sympy.sqrt(1 + (d / d_0) ** 2)
    model = (
        sympy.Eq(theta * T_rise.diff(t), K * u.subs(t, t - tau) - flow * T_rise),
        sympy.Eq(T, T_env + T_rise),
    )
    quantities = AirHeater.quantities | {
        K: (0.5, "K/%", "gain of the heater"),
        d_0: (150, "%", "fan speed that doubles the pressure"),
        u: (37, "%", "control signal of the heater"),
        d: (0, "%", "fan speed"),
        T_rise: (18.5, "K", "rise of the temperature"),
    }


class JacketedTank(Plant):
    """A tank heated by a liquid that flows through its jacket. (Haugen, equations 11.1 and 11.2)

    The text prints the temperatures of the inflows, the environment and the product. The other values are ours, and the
    operating point is a steady state.
    """

    T_p, T_h, T_pm, T_hm, F_h, F_p, T_pin, T_hin, T_e = signals("T_p T_h T_pm T_hm F_h F_p T_pin T_hin T_e")
    c_p, d_p, V_p, c_h, d_h, V_h, U_hp, U_eh, tau = parameters("c_p d_p V_p c_h d_h V_h U_hp U_eh tau")
    model = (
        sympy.Eq(c_p * d_p * V_p * T_p.diff(t), c_p * F_p * (T_pin - T_p) + U_hp * (T_h - T_p)),
        sympy.Eq(c_h * d_h * V_h * T_h.diff(t), c_h * F_h * (T_hin - T_h) - U_hp * (T_h - T_p) + U_eh * (T_e - T_h)),
        sympy.Eq(T_pm, T_p.subs(t, t - tau)),
        sympy.Eq(T_hm, T_h.subs(t, t - tau)),
    )
    output, manipulated = T_pm, F_h
    quantities = {
        c_p: (4200, "J/(kg K)", "specific heat capacity of the product"),
        d_p: (1000, "kg/m³", "density of the product"),
        V_p: (0.5, "m³", "volume of the tank"),
        c_h: (4200, "J/(kg K)", "specific heat capacity of the heating liquid"),
        d_h: (1000, "kg/m³", "density of the heating liquid"),
        V_h: (0.1, "m³", "volume of the jacket"),
        U_hp: (5600, "W/K", "heat transfer coefficient from jacket to tank"),
        U_eh: (100, "W/K", "heat transfer coefficient from the environment to the jacket"),
        tau: (10, "s", "dead time of both measurements"),
        F_p: (0.4, "kg/s", "flow of the product"),
        F_h: (sympy.Rational(181, 294), "kg/s", "flow of the heating liquid"),
        T_pin: (20, "°C", "inlet temperature of the product"),
        T_hin: (60, "°C", "inlet temperature of the heating liquid"),
        T_e: (20, "°C", "temperature of the environment"),
        T_p: (40, "°C", "temperature in the tank"),
        T_h: (46, "°C", "temperature in the jacket"),
        T_pm: (None, "°C", "measured temperature of the tank"),
        T_hm: (None, "°C", "measured temperature of the jacket"),
    }


# ------------------------------------------------------------------------------------------------ any transfer function


class Process(Plant):
    """A plant with a given transfer function and a load at its input: y = H (u + d).

    Arguments:
        H: a strictly proper transfer function with numbers, an expression in `s`, with at most one dead time.
    Raises:
        ValueError: for letters in H, more than one dead time, or a numerator of the denominator's degree or more.

    >>> Process(3 * sympy.exp(-2 * s) / (4 * s + 1)).transfer_function("u")
    3*exp(-2*s)/(4*s + 1)
    """

    def __init__(self, H):
        above, below, delay = polynomials(H)
        above, below = ([c / below.LC() for c in polynomial.all_coeffs()] for polynomial in (above, below))
        order = len(below) - 1
        above = [0] * (order - len(above)) + above
        u, d, y, *x = signals("u d y " + " ".join(f"x_{n}" for n in range(1, order + 1)))
        # the observable canonical form: a chain of integrators that ends in the output
        driven = (u + d).subs(t, t - delay)
        rates = [b * driven - a * x[0] + x_n for a, b, x_n in zip(below[1:], above, [*x[1:], 0], strict=True)]
        self.model = (*(sympy.Eq(x_n.diff(t), rate) for x_n, rate in zip(x, rates, strict=True)), sympy.Eq(y, x[0]))
        self.output, self.manipulated = y, u
        inside = {x_n: Quantity(0, "", "inner state") for x_n in x}
        outside = {u: Quantity(0, "", "control signal"), d: Quantity(0, "", "load at the input")}
        self.quantities = outside | {y: Quantity(None, "", "output")} | inside
        super().__init__()
