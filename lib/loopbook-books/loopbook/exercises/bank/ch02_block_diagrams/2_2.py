"""Python beside the page of exercise 2.2."""

import re

import sympy

x_1, x_2, x_3 = sympy.symbols("x_1 x_2 x_3", positive=True)
J, D, m, g, l, T, A, q, k, a, b, c, u = sympy.symbols("J D m g l T A q k a b c u", positive=True)
L, R, C, v, V, P, F, K = sympy.symbols("L R C v V P F K", positive=True)

_MODELS = {
    "pendulum": (
        "Take a pendulum with a motor at its axis. $J$ is its inertia [kg m²], $T$ the torque of the motor [N m], "
        "$D$ a damping constant [N m s/rad], $m$ the mass [kg] at the distance $l$ [m], $g$ the acceleration of "
        "gravity [m/s²], and $y$ the angle [rad]",
        r"J\ddot{y} + D\dot{y} + mgl\sin(y) = T",
        (T, D * x_2 + m * g * l * sympy.sin(x_1), J, 2),
    ),
    "tank": (
        "Take a tank with a hole in its bottom. $A$ is the cross-section [m²], $q$ the inflow [m³/s], $k$ a "
        "constant of the hole [m³/s per √m], and $y$ the level [m]",
        r"A\dot{y} + k\sqrt{y} = q",
        (q, k * sympy.sqrt(x_1), A, 1),
    ),
    "parachute": (
        "Take a parachutist on the way down. $m$ is the mass [kg], $g$ the acceleration of gravity [m/s²], $k$ a "
        "constant of the parachute [kg/m], and $y$ the distance fallen [m]",
        r"m\ddot{y} + k\dot{y}^2 = mg",
        (m * g, k * x_2**2, m, 2),
    ),
    "cylinder": (
        "Take a hydraulic cylinder with a mass on its rod. $y$ is the position of the rod [m], $u$ the opening of the "
        "valve [%], and $a$, $b$, $c$ and $k$ are constants of oil, mass and valve",
        r"a\dddot{y} + b\ddot{y} + c\dot{y} = ku",
        (k * u, b * x_3 + c * x_2, a, 3),
    ),
    "circuit": (
        "Take a coil, a resistor and a capacitor in a row. $L$ is the inductance [H], $R$ the resistance [Ω], $C$ the "
        "capacitance [F], $v$ the voltage over all three [V], and $y$ the charge of the capacitor [C]",
        r"L\ddot{y} + R\dot{y} + \frac{y}{C} = v",
        (v, R * x_2 + x_1 / C, L, 2),
    ),
    "oven": (
        "Take the filament of an oven in a vacuum. $C$ is its heat capacity [J/K], $P$ the electric power [W], $k$ a "
        "constant of the radiation [W/K⁴], and $y$ the temperature [K]",
        r"C\dot{y} + ky^4 = P",
        (P, k * x_1**4, C, 1),
    ),
    "buoy": (
        "Take a buoy in the waves. $m$ is its mass [kg], $F$ the force of the waves [N], $k$ a constant of the drag"
        " of the water [kg/m], $K$ one of the buoyancy [N/m], and $y$ the position [m] while the buoy goes up",
        r"m\ddot{y} + k\dot{y}^2 + Ky = F",
        (F, k * x_2**2 + K * x_1, m, 2),
    ),
    "reactor": (
        "Take a stirred reactor in which two molecules of a substance become one of another. $V$ is the volume "
        "[m³], $q$ the flow in and out [m³/s], $c$ the concentration of the inflow [mol/m³], $k$ a constant of the "
        "reaction [m³/(mol s)], and $y$ the concentration in the reactor [mol/m³]",
        r"V\dot{y} + qy + kVy^2 = qc",
        (q * c, q * x_1 + k * V * x_1**2, V, 1),
    ),
    "drive": (
        "Take an antenna on a springy shaft, turned by a motor with a lag. $y$ is its angle [rad], $u$ the voltage "
        "of the motor [V], and $a$, $b$, $c$, $J$ and $K$ are constants of motor, shaft and antenna",
        r"aJ\dddot{y} + b\ddot{y} + c\dot{y} + y = Ku",
        (K * u, b * x_3 + c * x_2 + x_1, a * J, 3),
    ),
}


def of_model(model):
    """Words and equation; what drives it, what acts against that, the factor of the highest derivative, its order."""
    situation, equation, parts = _MODELS[model]
    return situation, f"$${equation}$$", *parts


def letters_of(formula):
    """The symbols that may occur in an answer."""
    return " ".join(["x_1 x_2 x_3", *sorted(symbol.name for symbol in formula.free_symbols)])


def renamed(formula, **names):
    """A formula with other outputs of the integrators."""
    other = {sympy.Symbol(old, positive=True): sympy.Symbol(new, positive=True) for old, new in names.items()}
    return formula.subs(other, simultaneous=True)


def for_small_angles(formula):
    """A formula without its sine."""
    return formula.replace(sympy.sin, lambda x: x)


def with_number_for_g(formula):
    """A formula with the acceleration of gravity as a number."""
    return formula.subs(g, sympy.Rational("9.81"))


def dots_in(equation):
    """The dots of the highest derivative."""
    return max(len(dots) for dots in re.findall(r"\\(d+)ot", equation))
