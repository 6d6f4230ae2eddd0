"""Exercises of chapter 2, block diagrams and state-space models."""

import math

import numpy as np
import sympy

from loopbook.exercises.authoring import (
    answers,
    between,
    choice,
    criterion,
    design,
    exercise,
    expression,
    number,
    numbers,
    poles,
    transfer_function,
    word,
)
from loopbook.expressions import s

g_earth = sympy.Rational("9.81")


@exercise(
    "2.1",
    title="An integrator remembers",
    points=2,
    where=lambda K, y_0, a, t_1, t_2, t_end: (
        t_end - t_1 - t_2 >= 5 and abs(K - 1) * y_0 >= (y_0 + K * a * (t_2 - t_1)) / 30
    ),
)
def two_meters(
    K=choice(0.8, 0.9, 1.1, 1.2, 1.25, 1.5, reference=1.2),
    y_0=between(20, 100, "L", reference=50),
    a=between(2, 8, "L/s", reference=4, step=0.5),
    t_1=between(5, 10, "s", reference=5),
    t_2=between(15, 30, "s", reference=20),
    t_end=between(30, 60, "s", reference=40),
):
    """A water meter adds up the flow $u(t)$ in an integrator, and a gain of {K} corrects what the impeller senses.
    Maker A has put the gain in front of the integrator, maker B behind it. In both meters the integrator holds {y_0}
    to begin with. A flow of {a} begins at {t_1} and stops at {t_2}; at all other times nothing flows.

    What comes out of the last block at {t_end}, in meter A and in meter B?
    """
    volume = a * (t_2 - t_1)
    return answers(
        y_A=number(y_0 + K * volume, "L", "the output of meter A"),
        y_B=number(K * (y_0 + volume), "L", "the output of meter B"),
    )


@two_meters.mistake("What did the integrator hold before the flow began?")
def _(K, a, t_1, t_2):
    return {"y_A": K * a * (t_2 - t_1), "y_B": K * a * (t_2 - t_1)}


@two_meters.mistake(
    "When does the flow stop? From then on the input of the integrator is zero, and it stays where it is."
)
def _(K, y_0, a, t_1, t_end):
    return {"y_A": y_0 + K * a * (t_end - t_1), "y_B": K * (y_0 + a * (t_end - t_1))}


@two_meters.mistake("There is a gain in the meter, too. What does it multiply?")
def _(K, y_0, a, t_1, t_2):
    volume = a * (t_2 - t_1)
    found = {"y_A": y_0 + volume, "y_B": y_0 + volume}
    return found if abs(K - 1) * volume >= (y_0 + K * volume) / 30 else {}


@two_meters.mistake("When does the flow begin? Before that, the integrator adds up nothing.")
def _(K, y_0, a, t_2):
    return {"y_A": y_0 + K * a * t_2, "y_B": K * (y_0 + a * t_2)}


@two_meters.mistake(
    "Follow the signal block by block: does the gain multiply what the integrator held at the beginning?"
)
def _(K, y_0, a, t_1, t_2):
    volume = a * (t_2 - t_1)
    return {"y_A": K * (y_0 + volume), "y_B": y_0 + K * volume}


# Models: what they are about, the equation, what drives them, what acts against it, the factor of the highest
# derivative, and its order. x_1 is the output of the last integrator.
x_1, x_2, x_3 = sympy.symbols("x_1 x_2 x_3", positive=True)
J, D, m, g, l, T, A, q, k, a, b, c, u = sympy.symbols("J D m g l T A q k a b c u", positive=True)
L, R, C, v, V, P, F, K = sympy.symbols("L R C v V P F K", positive=True)
MODELS = {
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


@exercise("2.2", title="In front of the first integrator", points=3)
def first_integrator(model=choice(*MODELS, reference="pendulum")):
    """{situation}. The model is

    {equation}

    How many integrators does its block diagram need? Call what comes out of the last one $x_1$ (this is $y$), what
    comes out of the one before it $x_2$, and so on. Which formula must the blocks in front of the first integrator
    compute? Write it with these symbols and those of the model.
    """
    driving, against, factor, order = MODELS[model][2]
    formula = (driving - against) / factor
    names = " ".join(["x_1 x_2 x_3", *(symbol.name for symbol in formula.free_symbols)])
    return answers(
        integrators=number(order, "", "the number of integrators", within=0),
        formula=expression(formula, "the formula in front of the first integrator", symbols=names),
    )


@first_integrator.shows
def _(model):
    situation, equation, _ = MODELS[model]
    return {"situation": situation, "equation": f"$${equation}$$"}


@first_integrator.mistake("The highest derivative is not alone yet: what is it multiplied by?")
def _(model):
    driving, against, _, _ = MODELS[model][2]
    return {"formula": driving - against}


@first_integrator.mistake("Solve for the highest derivative again: a term that changes sides changes its sign.")
def _(model):
    driving, against, factor, _ = MODELS[model][2]
    return {"formula": (driving + against) / factor}


@first_integrator.mistake(
    "There is no feedback in it yet: what the integrators deliver acts on the highest derivative, too."
)
def _(model):
    driving, _, factor, _ = MODELS[model][2]
    return {"formula": driving / factor}


@first_integrator.mistake(
    "Look at the integrators once more: the last one delivers $y$ itself. Which one delivers $x_2$?"
)
def _(model):
    driving, against, factor, order = MODELS[model][2]
    exchanged = against.subs({x_1: x_2, x_2: x_1}, simultaneous=True)
    return {"formula": (driving - exchanged) / factor} if order > 1 else {}


@first_integrator.mistake("There is a sine in the model. The angle need not be small.")
def _(model):
    driving, against, factor, _ = MODELS[model][2]
    return {"formula": (driving - against.replace(sympy.sin, lambda x: x)) / factor} if against.has(sympy.sin) else {}


@first_integrator.mistake("In the formula, leave $g$ a symbol.")
def _(model):
    driving, against, factor, _ = MODELS[model][2]
    formula = (driving - against) / factor
    return {"formula": formula.subs(g, g_earth)} if formula.has(g) else {}


@first_integrator.mistake("Each integrator removes one dot. How many dots has the highest derivative?")
def _(model):
    return {"integrators": MODELS[model][2][3] + 1}


@exercise(
    "2.3",
    title="Twice round the diagram",
    points=3,
    where=lambda m, D, K, h: 0.03 <= h**2 * K / m <= 0.3 and 0.03 <= h * D / m <= 0.5,
)
def two_rounds(
    m=between(2, 8, "kg", reference=4, step=0.5),
    D=between(1, 8, "N s/m", reference=4, step=0.5),
    K=between(10, 40, "N/m", reference=20),
    y_0=between(10, 40, "cm", reference=20),
    h=choice(0.1, 0.2, unit="s", reference=0.1),
):
    r"""A mass of {m} hangs between a spring of {K} and a damper of {D}; its position $y$ is zero where it rests.
    Somebody pulls it {y_0} away and lets it go. A simulator goes round the block diagram in steps of {h}: in each
    round it works out the acceleration from what the two integrators hold at the beginning of the round, and lets each
    integrator add its input times the step.

    What do the integrators hold after the second round?
    """
    y, v = _rounds(m, D, K, y_0 / 100, h, 2)
    return answers(
        y=number(y, "m", "the position after two rounds"),
        v=number(v, "m/s", "the speed after two rounds"),
    )


def _rounds(m, D, K, y, h, count, new_speed=False):
    v = sympy.Integer(0)
    for _ in range(count):
        a = -(D * v + K * y) / m
        y, v = y + h * (v + h * a if new_speed else v), v + h * a
    return y, v


@two_rounds.mistake("In a round, both integrators work with what they held at its beginning. Which speed did you use?")
def _(m, D, K, y_0, h):
    y, v = _rounds(m, D, K, y_0 / 100, h, 2, new_speed=True)
    return {"y": y, "v": v}


@two_rounds.mistake("That is the result after one round. Go round once more.")
def _(m, D, K, y_0, h):
    y, v = _rounds(m, D, K, y_0 / 100, h, 1)
    return {"y": y, "v": v}


@two_rounds.mistake("In the second round the mass moves already. What does the damper do with that?")
def _(m, K, y_0, h):
    _, v = _rounds(m, sympy.Integer(0), K, y_0 / 100, h, 2)
    return {"v": v}


@two_rounds.mistake("The force of the spring is not yet an acceleration. What is it divided by?")
def _(m, D, K, y_0, h):
    y, _ = _rounds(sympy.Integer(1), D, K, y_0 / 100, h, 2)
    return {"y": y} if m > sympy.Rational(7, 2) else {}


@exercise(
    "2.4",
    title="Does the scale settle?",
    points=4,
    where=lambda m, D, K: abs(D**2 / (4 * m * K) - 1) > 0.15 and m * g_earth / K <= 0.15,
)
def scale(
    m=between(10, 50, "kg", reference=20, step=5),
    D=between(100, 1200, "N s/m", reference=240, step=20),
    K=between(2000, 6000, "N/m", reference=4000, step=200),
):
    r"""The platform of a scale has next to no mass. It stands on a spring of {K} with a damper of {D}, and $y$ is how
    far it is pressed down. Somebody sets down a sack of {m} on it. With the weight of the sack as the force, and with
    $g = 9.81$ m/s²: where does the platform come to rest? Which poles has the transfer function from the force to the
    position, and does the platform oscillate on its way?
    """
    root = sympy.sqrt(D**2 - 4 * m * K)
    return answers(
        y_s=number(1000 * m * g_earth / K, "mm", "the position at rest"),
        poles=poles([(-D + root) / (2 * m), (-D - root) / (2 * m)], "1/s", "the poles"),
        swings=word("yes" if 4 * m * K > D**2 else "no", ["yes", "no"], what="whether the platform oscillates"),
    )


@scale.mistake("That is the mass of the sack in kilograms. With how many newtons does it press down?")
def _(m, K):
    return {"y_s": 1000 * m / K}


@scale.mistake("The polynomial begins with the mass times $s^2$. What do you divide it by before you solve it?")
def _(D, K):
    root = sympy.sqrt(D**2 - 4 * K)
    return {"poles": [(-D + root) / 2, (-D - root) / 2]}


@scale.mistake("The formula for the roots of a quadratic has a 2 under the fraction line, too.")
def _(m, D, K):
    root = sympy.sqrt(D**2 - 4 * m * K)
    return {"poles": [(-D + root) / m, (-D - root) / m]}


@scale.mistake("That happens without the damper. It is in the polynomial, in the term with $s$.")
def _(m, K):
    root = sympy.sqrt(K / m) * sympy.I
    return {"poles": [root, -root]}


# A furnace and a workpiece in it: T_1 x_1' = K u - x_1, T_2 x_2' = x_1 - x_2; z_1 = x_1 - x_2, z_2 = x_2.


@exercise("2.5", title="Two other states", points=5, where=lambda T_1, T_2: 3 * T_2 <= 2 * T_1)
def other_states(
    T_1=between(10, 50, "min", reference=20, step=5),
    T_2=choice(2, 4, 5, 8, 10, unit="min", reference=5),
    K=between(2, 10, "K/%", reference=8),
    wanted=choice("the difference $z_1$", "the temperature $z_2$ of the workpiece", reference="the difference $z_1$"),
):
    r"""A workpiece lies in a furnace. $x_1$ is the temperature of the furnace and $x_2$ that of the workpiece, both in
    kelvin above the temperature of the hall, and $u$ is the power of the furnace in percent:

    $$T_1 \dot x_1 = Ku - x_1, \qquad T_2 \dot x_2 = x_1 - x_2$$

    The furnace has the time constant $T_1$ = {T_1} and the gain $K$ = {K}, the workpiece the time constant $T_2$ =
    {T_2}. What cracks the workpiece is the difference of the two temperatures. So choose other states: $z_1 = x_1 -
    x_2$ and $z_2 = x_2$.

    Find the matrices of $\dot z = Az + Bu$, with time in minutes, and the transfer function from $u$ to {wanted}.
    """
    numerator = K * T_2 * s if "difference" in wanted else K
    return answers(
        A=numbers([[-1 / T_1 - 1 / T_2, -1 / T_1], [1 / T_2, 0]], "1/min", "the matrix A"),
        B=numbers([K / T_1, 0], "K/(% min)", "the matrix B"),
        H=transfer_function(numerator / ((T_1 * s + 1) * (T_2 * s + 1)), "the transfer function"),
    )


@other_states.mistake(
    "That matrix belongs to the old states. Put $x_1 = z_1 + z_2$ and $x_2 = z_2$ into both equations."
)
def _(T_1, T_2):
    return {"A": [[-1 / T_1, 0], [1 / T_2, -1 / T_2]]}


@other_states.mistake("With $z = Mx$, on which side of the old matrix is $M$, and on which is its inverse?")
def _(T_1, T_2):
    return {"A": [[1 / T_2 - 1 / T_1, 1 / T_1 - 2 / T_2], [1 / T_2, -2 / T_2]]}


@other_states.mistake("Which of the new states does the power reach directly? Differentiate $z_1$ and $z_2$ and look.")
def _(T_1, K):
    return {"B": [K / T_1, K / T_1]}


@other_states.mistake("In the state-space model the rates are alone on the left. What is the gain divided by, then?")
def _(K):
    return {"B": [K, 0]}


@other_states.mistake("That is the transfer function to the other one of the two new states.")
def _(T_1, T_2, K, wanted):
    return {"H": (K if "difference" in wanted else K * T_2 * s) / ((T_1 * s + 1) * (T_2 * s + 1))}


@other_states.mistake("That is right with the time in seconds. Here it should be in minutes.")
def _(T_1, T_2, K, wanted):
    numerator = K * T_2 * 60 * s if "difference" in wanted else K
    return {"H": numerator / ((60 * T_1 * s + 1) * (60 * T_2 * s + 1))}


@other_states.mistake("That is the transfer function to the temperature of the furnace.")
def _(T_1, K):
    return {"H": K / (T_1 * s + 1)}


def _positions(m, D, K, times):
    """The step response of mass, spring and damper, relative to its final value."""
    root = np.sqrt(complex(D**2 - 4 * m * K)) or 1e-6 * D
    p, q = (-D + root) / (2 * m), (-D - root) / (2 * m)
    return 1 + ((q * np.exp(p * times) - p * np.exp(q * times)) / (p - q)).real


@exercise(
    "2.6", title="A damper for the machine", points=5, where=lambda m, K, t_s: 4.2 <= t_s * math.sqrt(1000 * K / m) <= 6
)
def damper(
    m=between(100, 500, "kg", reference=200, step=20),
    K=between(2, 20, "kN/m", reference=5),
    t_s=between(0.4, 2, "s", reference=1, step=0.1),
):
    """A machine of {m} stands on springs that have {K} together. When a press comes down on it, a constant force acts
    on the machine, and it moves to a new position. Choose the damping constant $D$ of the damper beside the springs.
    The machine should move beyond its new position by no more than 10 % of the way, and {t_s} after the step it should
    be within 5 % of the way and remain there.

    Try values in a simulation, or look at the exact response.
    """
    mass, stiffness, end = float(m), 1000 * float(K), float(t_s)

    def overshoot(D):
        zeta = D / (2 * math.sqrt(mass * stiffness))
        return 100 * math.exp(-math.pi * zeta / math.sqrt(1 - zeta**2)) if zeta < 1 else 0.0

    def error_after(D):
        times = np.linspace(end, 5 * end, 1001)
        return 100 * float(abs(1 - _positions(mass, D, stiffness, times)).max())

    return answers(
        D=design(
            number(1.5 * math.sqrt(mass * stiffness), "N s/m", "the damping constant"),
            criterion("the damping constant is positive", lambda D: D > 0),
            criterion("the overshoot", overshoot, below=10, unit="%"),
            criterion("the largest error from then on", error_after, below=5, unit="%"),
        )
    )
