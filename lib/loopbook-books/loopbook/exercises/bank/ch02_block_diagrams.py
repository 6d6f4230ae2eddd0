"""Exercises of chapter 2, block diagrams and state-space models."""

import functools
import math

import numpy as np
import sympy

from exercisebook.parameters import written
from loopbook import diagrams as draw
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
from loopbook.expressions import s, t
from loopbook.figures import time_plot

g_earth = sympy.Rational("9.81")


@exercise(
    "2.1",
    title="An integrator remembers",
    points=2,
    insight="Gain and integrator may change places, but what the integrator holds does not move along.",
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
    Maker A has put the gain in front of the integrator, maker B behind it. To begin with, both integrators hold {y_0}.
    A flow of {a} begins at {t_1} and stops at {t_2}; at all other times nothing flows.

    What comes out of the last block at {t_end}, in meter A and in meter B?
    """
    volume = a * (t_2 - t_1)
    return answers(
        y_A=number(y_0 + K * volume, "L", "the output of meter A"),
        y_B=number(K * (y_0 + volume), "L", "the output of meter B"),
    )


@two_meters.picture
def _(K, y_0):
    """Meter A: from u through a gain of {K} into an integrator that begins at {y_0}, whose output is y_A. Meter B: from
    u into such an integrator, and then through the gain to y_B."""
    layout = """
        A    u_A  K_A  I_A  y_A
        B    u_B  I_B  K_B  y_B"""
    gain, sum_up = draw.gain(written(K)), draw.integrator(written(y_0))
    blocks = {"K_A": gain, "I_A": sum_up, "I_B": sum_up, "K_B": gain}
    names = {"A": "Meter A", "B": "Meter B", "u_A": "u", "u_B": "u"}
    return draw.grid_diagram(layout, "u_A K_A I_A y_A, u_B I_B K_B y_B", blocks, names)


@two_meters.mistake("What did the integrator hold before the flow began?")
def _(K, a, t_1, t_2):
    return {"y_A": K * a * (t_2 - t_1), "y_B": K * a * (t_2 - t_1)}


@two_meters.mistake(
    "When does the flow stop? From then on the input of the integrator is zero, and it stays where it is."
)
def _(K, y_0, a, t_1, t_end):
    return {"y_A": y_0 + K * a * (t_end - t_1), "y_B": K * (y_0 + a * (t_end - t_1))}


@two_meters.mistake("The flow begins at one moment and stops at another one. For how long does it last?")
def _(K, y_0, a, t_1, t_2, t_end):
    volume = a * (t_2 - t_1)
    found = {"y_A": y_0 + K * a * t_end, "y_B": K * (y_0 + a * t_end)}
    others = {"y_A": K * (y_0 + volume), "y_B": y_0 + K * volume}
    return {name: value for name, value in found.items() if _apart(value, others[name], y_0 + volume)}


@two_meters.mistake("Nothing flows any more by then. What does an integrator do when its input is zero?")
def _():
    return {"y_A": 0, "y_B": 0}


def _apart(value, *others):
    """Whether the value of a mistake differs clearly from those of other mistakes."""
    return all(abs(value - other) > abs(other) / 30 for other in others)


@two_meters.mistake("That came out before anything flowed. When the flow stops, does an integrator go back?")
def _(K, y_0):
    return {"y_A": y_0, "y_B": K * y_0}


@two_meters.mistake("There is a gain in the meter, too. What does it multiply?")
def _(K, y_0, a, t_1, t_2):
    volume = a * (t_2 - t_1)
    found = {"y_A": y_0 + volume, "y_B": y_0 + volume}
    return found if abs(K - 1) * volume >= (y_0 + K * volume) / 30 else {}


@two_meters.mistake("When does the flow begin? Before that, the integrator adds up nothing.")
def _(K, y_0, a, t_1, t_2):
    volume = a * (t_2 - t_1)
    found = {"y_A": y_0 + K * a * t_2, "y_B": K * (y_0 + a * t_2)}
    others = {"y_A": K * (y_0 + volume), "y_B": y_0 + K * volume}
    return {name: value for name, value in found.items() if _apart(value, others[name], y_0 + volume)}


@two_meters.mistake(
    "Follow the signal block by block: does the gain multiply what the integrator held at the beginning?"
)
def _(K, y_0, a, t_1, t_2):
    volume = a * (t_2 - t_1)
    return {"y_A": K * (y_0 + volume), "y_B": y_0 + K * volume}


two_meters.hints(
    "An integrator adds up its input, beginning with what it holds. A gain multiplies whatever comes out of the block "
    "before it.",
    "Work out what flows between $t_1$ and $t_2$. In meter A the gain multiplies the flow before it is added up, in "
    "meter B it multiplies everything that the integrator holds.",
    "Between {t_1} and {t_2} the volume ${a}\\cdot({t_2} - {t_1})$ passes, in litres. In meter A the integrator adds "
    "{K} times as much to its {y_0}.",
)


@two_meters.solution
def _(y_0, a, t_1, t_2, K):
    r"""A flow of {a} passes from {t_1} to {t_2}, for {duration}. That is a volume of ${a}\cdot{duration} =$
    {volume}. When the flow stops, the input of the integrator is zero, and it stays where it is until {t_end} and
    longer.

    **Meter A.** The gain multiplies the flow before it is added up, and the integrator begins at {y_0}:

    $$y_A = {y_0} + {K}\cdot{volume} = {y_A}$$

    ***

    **Meter B.** The integrator adds up the flow itself and holds ${y_0} + {volume} = {held}$ litres. The gain
    behind it multiplies all of that, and also what was there to begin with:

    $$y_B = {K}\cdot({y_0} + {volume}) = {y_B}$$

    in litres. The two differ by ${K} - 1$ times the initial value, and by nothing else.
    """
    volume = a * (t_2 - t_1)
    return {"duration": (t_2 - t_1, "s"), "volume": (volume, "L"), "held": (y_0 + volume, "L")}


@two_meters.solution_picture
def _(K, y_0, a, t_1, t_2, t_end):
    """The outputs of both meters: they begin apart and remain as far apart, since both rise by the same."""
    times = [0, float(t_1), float(t_2), float(t_end)]
    volume = a * (t_2 - t_1)
    outputs = {"meter A": [y_0, y_0, y_0 + K * volume, y_0 + K * volume]}
    outputs["meter B"] = [K * y_0, K * y_0, K * (y_0 + volume), K * (y_0 + volume)]
    return time_plot(outputs, times, ylabel="output [L]")


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


@exercise(
    "2.2",
    title="In front of the first integrator",
    points=3,
    insight="A differential equation of any order is a chain of integrators and one formula in front of it.",
)
def first_integrator(model=choice(*MODELS, reference="pendulum")):
    """{situation}. The model is

    {equation}

    How many integrators does its block diagram need? Call what comes out of the last one $x_1$ (this is $y$), what
    comes out of the one before it $x_2$, and so on. Which formula must the blocks in front of the first integrator
    compute? Write it with these symbols and those of the model.
    """
    driving, against, factor, order = MODELS[model][2]
    formula = (driving - against) / factor
    names = " ".join(["x_1 x_2 x_3", *sorted(symbol.name for symbol in formula.free_symbols)])
    return answers(
        integrators=number(order, "", "the number of integrators", within=0),
        formula=expression(formula, "the formula in front of the first integrator", symbols=names),
    )


@first_integrator.shows
def _(model):
    situation, equation, (*_, factor, order) = MODELS[model]
    highest = [r"$\dot{y}$", r"$\ddot{y}$", r"$\dddot{y}$"][order - 1]
    return {"situation": situation, "equation": f"$${equation}$$", "highest": highest, "factor": factor}


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


@first_integrator.mistake("The whole equation is divided by this factor, not only what drives the plant.")
def _(model):
    driving, against, factor, _ = MODELS[model][2]
    return {"formula": driving / factor - against}


@first_integrator.mistake("What comes out of the last integrator is $x_1 = y$. What is its derivative, then?")
def _(model):
    driving, against, factor, order = MODELS[model][2]
    late = against.subs({x_2: x_1, x_3: x_2}, simultaneous=True)
    return {"formula": (driving - late) / factor} if order > 1 and not against.has(x_1) else {}


@first_integrator.mistake("The outputs are counted from the end: which integrator delivers $y$, and which $x_3$?")
def _(model):
    driving, against, factor, order = MODELS[model][2]
    reversed_order = against.subs({x_1: x_3, x_3: x_1}, simultaneous=True)
    return {"formula": (driving - reversed_order) / factor} if order == 3 else {}


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


@first_integrator.mistake("How many times is $y$ differentiated? Each integrator takes one of these dots away.")
def _(model):
    order = MODELS[model][2][3]
    return {"integrators": order - 1} if order > 1 else {}


first_integrator.hints(
    "Follow the recipe of Example 2.1: the highest derivative alone on the left, a chain of integrators behind it, and "
    "the right side in front of it.",
    "Count the dots: each integrator removes one. Behind the last one is $x_1 = y$, in front of it $x_2 = \\dot y$, "
    "and so on. Replace $y$ and its lower derivatives by these names.",
    "Solve the model for {highest}: bring every other term to the right side, and divide by ${factor}$.",
)


@first_integrator.solution
def _(model):
    r"""The highest derivative is {highest}, so the order of the model is {integrators}: as many integrators lead
    from there to $y$, one for each dot.

    Bring all other terms to the right side, where they change their sign, and divide by ${factor}$. Then give the
    outputs of the integrators their names, {names}:

    $${formula}$$

    This is what the blocks in front of the first integrator have to compute from the outputs of the integrators and
    the input.
    """
    order = MODELS[model][2][3]
    names = ["$x_1 = y$", r"$x_2 = \dot y$", r"$x_3 = \ddot y$"]
    return {"names": ", ".join(names[:order])}


@exercise(
    "2.3",
    title="Twice round the diagram",
    points=3,
    insight="A simulator knows no calculus: it walks round the diagram, and small steps make it right.",
    where=lambda m, D, K, h: 0.03 <= h**2 * K / m <= 0.3 and 0.03 <= h * D / m <= 0.5,
)
def two_rounds(
    m=between(2, 8, "kg", reference=4, step=0.5),
    D=between(1, 8, "N s/m", reference=4, step=0.5),
    K=between(10, 40, "N/m", reference=20),
    y_0=between(10, 40, "cm", reference=20),
    h=choice(0.1, 0.2, unit="s", reference=0.1),
):
    r"""A spring of {K} and a damper of {D} hold a mass of {m}; its position $y$ is zero where it rests. Somebody pulls
    it {y_0} away and lets it go. A simulator goes round the block diagram in steps of {h}: in each
    round it works out the acceleration from what the two integrators hold at the beginning of the round, and lets
    each integrator add its input times the step.

    What do the integrators hold after the second round?
    """
    y, v = _rounds(m, D, K, y_0 / 100, h, 2)
    return answers(
        y=number(y, "m", "the position after two rounds"),
        v=number(v, "m/s", "the speed after two rounds"),
    )


@two_rounds.picture
def _(m, D, K, y_0):
    """A mass of {m} on a wall by a spring of {K} and a damper of {D}, before it is let go {y_0} from its rest."""
    parts = f"${written(m)}$ kg", f"${written(K)}$ N/m", f"${written(D)}$ N s/m"
    return draw.mass_spring_damper(*parts, force="", position=f"$y(0) = {written(y_0)}$ cm")


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


@two_rounds.mistake("The damper acts against the motion. Which way does the mass move when the second round begins?")
def _(m, D, K, y_0, h):
    _, v = _rounds(m, D, K, y_0 / 100, h, 2)
    _, undamped = _rounds(m, sympy.Integer(0), K, y_0 / 100, h, 2)
    return {"v": 2 * undamped - v}


@two_rounds.mistake("Spring and damper pull back. Which sign has the acceleration of a mass that has been pulled away?")
def _(m, D, K, y_0, h):
    y, v = _rounds(-m, D, K, y_0 / 100, h, 2)
    return {"y": y, "v": v}


@two_rounds.mistake("The force of the spring is not yet an acceleration. What is it divided by?")
def _(m, D, K, y_0, h):
    y, _ = _rounds(sympy.Integer(1), D, K, y_0 / 100, h, 2)
    return {"y": y} if m > sympy.Rational(7, 2) else {}


@two_rounds.mistake("That is the result after three rounds. The first one begins with the mass at rest.")
def _(m, D, K, y_0, h):
    return _found_apart(_rounds(m, D, K, y_0 / 100, h, 3), m, D, K, y_0, h)


@two_rounds.mistake("That is how the mass really moves. What does the simulator make of it, in two steps?")
def _(m, D, K, y_0, h):
    mass, damping, stiffness, start, end = (float(x) for x in (m, D, K, y_0 / 100, 2 * h))
    root = np.sqrt(complex(damping**2 - 4 * mass * stiffness))
    if abs(root) < 1e-3:
        return {}
    p, q = (-damping + root) / (2 * mass), (-damping - root) / (2 * mass)
    y = start * ((p * np.exp(q * end) - q * np.exp(p * end)) / (p - q)).real
    v = start * (p * q * (np.exp(q * end) - np.exp(p * end)) / (p - q)).real
    return _found_apart((y, v), m, D, K, y_0, h)


def _found_apart(found, m, D, K, y_0, h):
    """Position and speed of a mistake, where they differ from those that are right and those of other mistakes."""
    start = y_0 / 100
    others = [_rounds(m, D, K, start, h, 2), _rounds(m, D, K, start, h, 1), _rounds(m, D, K, start, h, 2, True)]
    others.append(_rounds(m, sympy.Integer(0), K, start, h, 2))
    told = zip("yv", found, zip(*others, strict=True), strict=True)
    return {name: value for name, value, different in told if _apart(value, *different)}


two_rounds.hints(
    "There are two integrators, one holds the position and one the speed. In each round, each of them adds its input "
    "times the step.",
    "The input of the first integrator is the acceleration, $a = -(Dv + Ky)/m$, that of the second one is the speed. "
    "Use what both hold at the beginning of the round, and only then change both.",
    "First round: $y = {y_start}$ m and $v = 0$, so $a = -\\frac{ {K} \\cdot {y_start} }{ {m} }$ in m/s². The position "
    "does not move yet, and the speed becomes $a \\cdot {h}$.",
)


@two_rounds.solution
def _(m, D, K, y_0, h):
    r"""**First round.** At the beginning the integrators hold $y = {y_start}$ m and $v = 0$. The blocks in front of
    the first integrator make $a = -({D}\cdot 0 + {K}\cdot{y_start})/{m} = {a_1}$, in m/s². Each integrator adds its
    input times the step: the position remains {y_start} m, since its input was zero, and the speed becomes
    ${a_1}\cdot{h} = {v_1}$, in m/s.

    **Second round.** Now they hold $y = {y_start}$ m and $v = {v_1}$ m/s, and the damper acts too:
    $a = -({D}\cdot({v_1}) + {K}\cdot{y_start})/{m} = {a_2}$. Again each integrator adds its input times the step:

    $$y = {y_start} + {h}\cdot({v_1}) = {y}, \qquad v = {v_1} + {h}\cdot({a_2}) = {v}$$

    The position is one round behind the acceleration: in the first round it does not move at all.
    """
    start = y_0 / 100
    a_1 = -K * start / m
    v_1 = a_1 * h
    return {"y_start": start, "a_1": a_1, "v_1": v_1, "a_2": -(D * v_1 + K * start) / m}


@two_rounds.shows
def _(y_0):
    return {"y_start": written(y_0 / 100)}


@exercise(
    "2.4",
    title="Does the scale settle?",
    points=4,
    insight="Where it rests, spring and weight decide alone. Whether it oscillates is up to the damper.",
    where=lambda m, D, K: abs(D**2 / (4 * m * K) - 1) > 0.15 and m * g_earth / K <= 0.15,
)
def scale(
    m=between(10, 50, "kg", reference=20, step=5),
    D=between(100, 1200, "N s/m", reference=240, step=20),
    K=between(2000, 6000, "N/m", reference=4000, step=200),
):
    r"""The platform of a scale has next to no mass. It stands on a spring of {K} with a damper of {D}, and $y$ is
    how far it is pressed down. Somebody sets down a sack of {m} on it. With the weight of the sack as the force $F$,
    and with $g = 9.81$ m/s²: where does the platform come to rest? What are the poles of the transfer function from
    the force to the position, and does the platform oscillate on its way?
    """
    root = sympy.sqrt(D**2 - 4 * m * K)
    return answers(
        y_s=number(1000 * m * g_earth / K, "mm", "the position at rest"),
        poles=poles([(-D + root) / (2 * m), (-D - root) / (2 * m)], "1/s", "the poles"),
        swings=word("yes" if 4 * m * K > D**2 else "no", ["yes", "no"], what="whether the platform oscillates"),
    )


@scale.picture
def _(m, D, K):
    """A sack of {m} on a platform, which stands on a spring of {K} and a damper of {D}."""
    parts = f"${written(m)}$ kg", f"${written(K)}$ N/m", f"${written(D)}$ N s/m"
    return draw.mass_spring_damper(*parts, "F", standing=True)


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


@scale.mistake("Which $g$ does the statement give? Ten is not near enough here.")
def _(m, K):
    return {"y_s": 10000 * m / K}


@scale.mistake("Which sign has the product of the outer coefficients, under the root?")
def _(m, D, K):
    root = sympy.sqrt(D**2 + 4 * m * K)
    return {"poles": [(-D + root) / (2 * m), (-D - root) / (2 * m)]}


@scale.mistake("How many times the product of the outer coefficients is under the root?")
def _(m, D, K):
    root = sympy.sqrt(D**2 - m * K)
    return {"poles": [(-D + root) / (2 * m), (-D - root) / (2 * m)]}


@scale.mistake("The sack moves together with the platform. Which mass is it that spring and damper have to move?")
def _(D, K):
    return {"poles": [-K / D]}


@scale.mistake("The sack moves together with the platform. Which mass is it that spring and damper have to move?")
def _(D, K):
    return {"poles": [-K / D, 0]}


@scale.mistake("In the formula for the roots of a quadratic, all of it is above the fraction line, also the root.")
def _(m, D, K):
    root = sympy.sqrt(D**2 - 4 * m * K)
    return {"poles": [-D / (2 * m) + root, -D / (2 * m) - root]}


@scale.mistake("In the formula for the roots of a quadratic, the $2m$ is below both parts, also below the root.")
def _(m, D, K):
    root = sympy.sqrt(D**2 - 4 * m * K)
    return {"poles": [-D / (2 * m) + root / m, -D / (2 * m) - root / m]}


@scale.mistake("That happens without the damper. It is in the polynomial, in the term with $s$.")
def _(m, K):
    root = sympy.sqrt(K / m) * sympy.I
    return {"poles": [root, -root]}


@scale.mistake("Compare $D^2$ with $4mK$: what is under the root decides whether the poles are real or complex.")
def _(m, D, K):
    return {"swings": "no" if 4 * m * K > D**2 else "yes"}


scale.hints(
    "Newton's second law for the sack: $m\\ddot y = F - D\\dot y - Ky$, with $F$ for its weight. At rest, all "
    "derivatives are zero.",
    "In the transfer function each dot is a factor $s$, so its denominator is $ms^2 + Ds + K$. The poles are its "
    "roots. A pair of complex poles means oscillation.",
    "Its roots are $\\frac{-{D} \\pm \\sqrt{ {D}^2 - 4\\cdot{m}\\cdot{K} }}{2\\cdot{m}}$, in 1/s. Is what is under "
    "the root positive or negative? At rest, the spring alone holds ${m}\\cdot 9.81$ N.",
)


@scale.solution
def _(m, D, K):
    r"""**At rest** only the spring holds the sack. Its weight is $F = {m}\cdot 9.81 =$ {F}, and $Ky = F$ gives
    $y = F/K =$ {y_s}.

    **The poles.** With a factor $s$ for each dot, $m\ddot y + D\dot y + Ky = F$ becomes $(ms^2 + Ds + K)\,Y = F$.
    The poles are the roots of this polynomial:

    $$s = \frac{-{D} \pm \sqrt{ {D}^2 - 4\cdot{m}\cdot{K} }}{2\cdot{m}}$$

    Under the root is ${inside}$. It is {sign}, so the poles are {which}: {p_1} and {p_2}, in 1/s. Real poles creep
    to the new position, complex ones oscillate. Does the platform oscillate? The answer is {swings}.
    """
    inside = D**2 - 4 * m * K
    root = np.sqrt(complex(inside))
    one, other = ((-complex(D) + sign * root) / (2 * complex(m)) for sign in (1, -1))
    return {
        "F": (m * g_earth, "N"),
        "inside": inside,
        "sign": "positive" if inside > 0 else "negative",
        "which": "real" if inside > 0 else "a complex pair",
        "p_1": _pole(one),
        "p_2": _pole(other),
    }


def _pole(value):
    """A pole as a formula, in four digits."""
    if not value.imag:
        return f"${value.real:.4g}$"
    return f"${value.real:.4g} {'+' if value.imag > 0 else '-'} {abs(value.imag):.4g}j$"


@scale.solution_picture
def _(m, D, K):
    """How far the platform is pressed down: its way to the position at rest."""
    mass, damping, stiffness = float(m), float(D), float(K)
    slowest = abs(np.roots([mass, damping, stiffness]).real).min()
    times = np.linspace(0, 5 / slowest, 401)
    end = 1000 * mass * 9.81 / stiffness
    pressed = {"$y$": (end * _positions(mass, damping, stiffness, times), "measurement")}
    return time_plot(pressed, times, ylabel="$y$ [mm]").level(end, "at rest")


# A furnace and a workpiece in it: T_1 x_1' = K u - x_1, T_2 x_2' = x_1 - x_2; z_1 = x_1 - x_2, z_2 = x_2.


@exercise(
    "2.5",
    title="Two other states",
    points=5,
    where=lambda T_1, T_2: 3 * T_2 <= 2 * T_1,
    insight="States may be chosen, and the matrices change with them. The transfer function does not.",
)
def other_states(
    T_1=between(10, 50, "min", reference=20, step=5),
    T_2=choice(2, 4, 5, 8, 10, unit="min", reference=5),
    K=between(2, 10, "K/%", reference=8),
    wanted=choice("the difference $z_1$", "the temperature $z_2$ of the workpiece", reference="the difference $z_1$"),
):
    r"""A workpiece lies in a furnace. $x_1$ is the temperature of the furnace and $x_2$ that of the workpiece, both
    in kelvin above the temperature of the hall, and $u$ is the power of the furnace in percent:

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


@other_states.picture
def _(T_1, T_2, K):
    """A block diagram of the two equations: two integrators, each in a loop of its own; {K} in front of the first one,
    division by {T_1} in the first loop and by {T_2} in the second one."""
    furnace, workpiece = (draw.feedback_loop([draw.division(written(T)), draw.integrator()]) for T in (T_1, T_2))
    return draw.block_diagram("u", draw.gain(written(K)), furnace, "x_1", workpiece, "x_2")


@other_states.mistake(
    "That matrix belongs to the old states. Put $x_1 = z_1 + z_2$ and $x_2 = z_2$ into both equations."
)
def _(T_1, T_2):
    return {"A": [[-1 / T_1, 0], [1 / T_2, -1 / T_2]]}


@other_states.mistake("In the first row, $\\dot z_1 = \\dot x_1 - \\dot x_2$. Where is $\\dot x_2$ in it?")
def _(T_1, T_2):
    return {"A": [[-1 / T_1, -1 / T_1], [1 / T_2, 0]]}


@other_states.mistake("In $\\dot z_1 = \\dot x_1 - \\dot x_2$, which sign does $z_1/T_2$ have?")
def _(T_1, T_2):
    return {"A": [[-1 / T_1 + 1 / T_2, -1 / T_1], [1 / T_2, 0]]}


@other_states.mistake("The temperature of the furnace is more than the difference: what is $x_1$ in the new states?")
def _(T_1, T_2):
    return {"A": [[-1 / T_1 - 1 / T_2, 0], [1 / T_2, 0]]}


@other_states.mistake("The temperature of the furnace is more than the difference: what is $x_1$ in the new states?")
def _(T_1, T_2):
    return {"A": [[-1 / T_1 - 1 / T_2, 1 / T_2], [1 / T_2, -1 / T_2]]}


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


other_states.hints(
    "A state-space model has the rates of the new states on the left, and on the right only the new states and the "
    "input.",
    "Differentiate: $\\dot z_1 = \\dot x_1 - \\dot x_2$ and $\\dot z_2 = \\dot x_2$. Put in the two model equations, "
    "and then $x_1 = z_1 + z_2$ and $x_2 = z_2$.",
    "The second row is short: $\\dot z_2 = \\frac{x_1 - x_2}{ {T_2} } = \\frac{z_1}{ {T_2} }$. The first one is "
    "$\\dot z_1 = \\frac{ {K}u - (z_1 + z_2)}{ {T_1} } - \\frac{z_1}{ {T_2} }$: collect $z_1$, $z_2$ and $u$.",
)


@other_states.solution
def _(T_1, T_2, K, wanted):
    r"""The workpiece first, as it is shorter: $\dot z_2 = \dot x_2 = (x_1 - x_2)/T_2 = z_1/{T_2}$.

    The difference: $\dot z_1 = \dot x_1 - \dot x_2 = ({K}u - x_1)/{T_1} - z_1/{T_2}$, and $x_1 = z_1 + z_2$.
    Collected,

    $$\dot z_1 = -\left(\frac{1}{ {T_1} } + \frac{1}{ {T_2} }\right) z_1
    - \frac{z_2}{ {T_1} } + \frac{ {K} }{ {T_1} }\,u$$

    With the numbers,

    $$A = {matrix}, \qquad B = {column}$$

    **The transfer function.** Transformed, the two equations of the model are $({T_1}s + 1)\,x_1 = {K}u$ and
    $({T_2}s + 1)\,x_2 = x_1$. {last}

    $$H(s) = {fraction}$$
    """
    temperature = "That gives $x_2$, which is $z_2$, by multiplication:"
    difference = (
        "The difference is $z_1 = x_1 - x_2 = {T_2}s\\,x_2$, so it gets a factor ${T_2}s$ above the line:".replace(
            "{T_2}", written(T_2)
        )
    )
    above = K * T_2 * s if "difference" in wanted else K
    A = sympy.Matrix([[-1 / T_1 - 1 / T_2, -1 / T_1], [1 / T_2, 0]])
    return {
        "matrix": sympy.latex(A),
        "column": sympy.latex(sympy.Matrix([K / T_1, 0])),
        "last": difference if "difference" in wanted else temperature,
        "fraction": rf"\frac{{{sympy.latex(above)}}}{{({written(T_1)} s + 1)({written(T_2)} s + 1)}}",
    }


def _positions(m, D, K, times):
    """The step response of mass, spring and damper, relative to its final value."""
    root = np.sqrt(complex(D**2 - 4 * m * K)) or 1e-6 * D
    p, q = (-D + root) / (2 * m), (-D - root) / (2 * m)
    return 1 + ((q * np.exp(p * times) - p * np.exp(q * times)) / (p - q)).real


@exercise(
    "2.6",
    title="A damper for the machine",
    points=5,
    where=lambda m, K, t_s: 4.2 <= t_s * math.sqrt(1000 * K / m) <= 6,
    insight="Too little damping oscillates, too much creeps. The shortest way to rest is a little less than critical.",
)
def damper(
    m=between(100, 500, "kg", reference=200, step=20),
    K=between(2, 20, "kN/m", reference=5),
    t_s=between(0.4, 2, "s", reference=1, step=0.1),
):
    """A machine of {m} stands on springs that have {K} together. When a press comes down on it, a constant force $F$
    acts on it, and it moves to a new position. Choose the damping constant $D$ of the damper beside the springs. The
    machine should move beyond its new position by at most 10 % of the way, and {t_s} after the step it should be
    within 5 % of the way and remain there.

    Try values in a simulation, or look at the exact response.
    """
    mass, stiffness, end = float(m), 1000 * float(K), float(t_s)

    def overshoot(D):
        zeta = D / (2 * math.sqrt(mass * stiffness))
        return 100 * math.exp(-math.pi * zeta / math.sqrt(1 - zeta**2)) if zeta < 1 else 0.0

    def error_after(D):
        times = np.linspace(end, 5 * end, 1001)
        return 100 * float(abs(1 - _positions(mass, D, stiffness, times)).max())

    def way_to_rest(D):
        times = np.linspace(0, 2 * end, 401)
        way = 100 * _positions(mass, max(D, 0.0), stiffness, times)
        limits = np.where(times < end, 110, 105), np.where(times < end, np.nan, 95)
        signals = {"way to the new position": (way, "measurement"), "upper limit": (limits[0], "setpoint")}
        signals["lower limit"] = (limits[1], "setpoint")
        return time_plot(signals, times, f"With $D$ = {D:.4g} N s/m", ylabel="way [%]")

    return answers(
        D=design(
            number(1.5 * math.sqrt(mass * stiffness), "N s/m", "the damping constant"),
            criterion("the damping constant is positive", lambda D: D > 0),
            criterion("the overshoot", overshoot, below=10, unit="%"),
            criterion(f"the largest error after {written(t_s, 's')}", error_after, below=5, unit="%"),
            draws=way_to_rest,
        )
    )


@damper.picture
def _(m, K):
    """A machine of {m} on springs of {K} and a damper D; a force F presses it down."""
    return draw.mass_spring_damper(f"${written(m)}$ kg", f"${written(K)}$ kN/m", "D", standing=True)


def _with_factor(zeta, factor):
    """The damping constant for one relative damping, of somebody who has lost a factor."""

    def found(m, K):
        return {"D": 2 * zeta * math.sqrt(1000 * m * K) * factor}

    return found


#: The relative dampings that people choose.
USUAL = (0.75, 0.59, 0.6, 0.65, 0.7, 0.707, 0.8, 0.9, 1)
for _zeta in USUAL:
    damper.mistake("The springs have that many kilonewtons a metre. How many newtons is that?")(
        _with_factor(_zeta, 1000**-0.5)
    )
for _zeta in USUAL:
    damper.mistake(
        "There is a factor 2 between the damping constant and the relative damping: $D = 2\\zeta\\sqrt{{mK}}$."
    )(_with_factor(_zeta, 0.5))


@damper.mistake(
    "That is critical damping. It never overshoots, which nobody asked for, and it needs longer than is allowed here."
)
def _(m, K, t_s):
    from_then_on = t_s * math.sqrt(1000 * K / m)
    return {"D": 2 * math.sqrt(1000 * m * K)} if (1 + from_then_on) * math.exp(-from_then_on) > 0.052 else {}


@damper.mistake("With so little damping the machine oscillates far beyond its new position.")
def _(m, K):
    return {"D": 0.4 * math.sqrt(1000 * m * K)}


damper.hints(
    "Newton's second law gives $m\\ddot y + D\\dot y + Ky = F$. The overshoot is decided by the relative damping "
    "$\\zeta = D/(2\\sqrt{{mK}})$ alone, and the time by $\\omega_0 = \\sqrt{K/m}$ as well.",
    "The overshoot is $e^{-\\pi\\zeta/\\sqrt{1 - \\zeta^2}}$, so 10 % is a lower limit for $\\zeta$. Too much "
    "damping makes the machine creep, and the time becomes too long.",
    "Here $\\sqrt{{mK}} = \\sqrt{ {m}\\cdot 1000\\cdot{K} }$, in N s/m. From the overshoot $\\zeta$ must be at least "
    "0.59, and 1 is critical damping. Try values in between.",
)


@damper.solution
def _(m, K, t_s):
    r"""Divided by $m$, the balance is $\ddot y + 2\zeta\omega_0\dot y + \omega_0^2 y = F/m$ with
    $\omega_0 = \sqrt{K/m} = \sqrt{1000\cdot{K}/{m}} =$ {omega} and $\zeta = D/(2\sqrt{{mK}})$.

    **The overshoot** $e^{-\pi\zeta/\sqrt{1 - \zeta^2}}$ is 10 % for $\zeta$ = 0.59, and less with more damping.

    **The time.** With $\zeta$ = 0.75 the machine is within 5 % of its way after {needed}, and {t_s} are
    allowed. More damping makes it creep, and sooner or later the time is too long.

    So $\zeta$ = 0.75 does both: $D = 2\cdot 0.75\cdot\sqrt{1000\cdot{m}\cdot{K}} =$ {D}.
    """
    omega = math.sqrt(1000 * K / m)
    return {"omega": (omega, "rad/s"), "needed": (_settled(0.75) / omega, "s")}


def _settled(zeta):
    """After which time the step response is within 5 % of its end, for a natural frequency of 1."""
    times = np.linspace(0, 20, 4001)
    return times[np.flatnonzero(abs(1 - _positions(1.0, 2 * zeta, 1.0, times)) > 0.05)[-1]]


# Three diagrams of one loop around an integrator: where the disturbance enters.
u_, d_, y_, v_, F_ = sympy.symbols("u d y v F")
LAYOUTS = {
    "behind the gain": lambda K, a, c: a * (K * u_ - d_ - c * y_),
    "before the integrator": lambda K, a, c: a * (K * u_ - c * y_) - d_,
    "before the gain": lambda K, a, c: a * (K * (u_ - d_) - c * y_),
}


def _at(formula, **values):
    return formula.subs({sympy.Symbol(name): value for name, value in values.items()})


def _rest(layout, K, a, c, u, d):
    (rest,) = sympy.solve(_at(LAYOUTS[layout](K, a, c), u=u, d=d), y_)
    return rest


@exercise(
    "2.7",
    title="What does this diagram compute?",
    points=4,
    where=lambda layout, K, a, c, u, d, y_0: (
        d < u
        and abs(_at(LAYOUTS[layout](K, a, c), u=u, d=d, y=y_0)) >= 0.5
        and abs(_rest(layout, K, a, c, u, d)) >= 0.5
        and len({sympy.expand(each(K, a, c)) for each in LAYOUTS.values()}) == 3
    ),
    insight="What goes into the integrator is the rate. Write that down, and the diagram has become an equation.",
)
def read_diagram(
    layout=choice(*LAYOUTS),
    K=between(2, 6, reference=3, step=1),
    a=choice(0.2, 0.25, 0.4, 0.5, reference=0.25),
    c=choice(1.5, 2, 2.5, 4, 5, reference=2),
    u=between(3, 9, reference=5, step=1),
    d=between(1, 6, reference=3, step=1),
    y_0=between(1, 12, reference=4, step=1),
):
    r"""A colleague has left this diagram of a plant behind, and no equation. Its numbers have no units, and time is
    in minutes.

    Which formula does it compute for the rate $\dot y$ of its output, from $u$, $d$ and $y$? While the integrator
    still holds what it holds in the diagram, the inputs become $u$ = {u} and $d$ = {d}, and remain there. With
    which rate does $y$ begin to move? And where does it come to rest?
    """
    formula = LAYOUTS[layout](K, a, c)
    return answers(
        rate=expression(formula, "the rate of the output, in $u$, $d$ and $y$", symbols="u d y"),
        start=number(_at(formula, u=u, d=d, y=y_0), "1/min", "the rate at the beginning"),
        rest=number(_rest(layout, K, a, c, u, d), "", "where the output comes to rest"),
    )


@read_diagram.shows
def _(layout, K, a, c, y_0):
    enters, before, after = "minus $d$", [f"gain {written(K)}"], [f"gain {written(a)}"]
    path = {"behind the gain": [*before, enters], "before the gain": [enters, *before]}.get(layout, before)
    after += [enters] if layout == "before the integrator" else []
    loop = f"sum minus what comes back from $y$ through the gain {written(c)}"
    words = ", then ".join([*path, loop, *after, f"integrator that holds {written(y_0)}"])
    return {"diagram": f"from $u$ through {words}, to $y$"}


@read_diagram.picture
def _(layout, K, a, c, y_0):
    """A block diagram: {diagram}."""
    gain, enters = draw.gain(written(K)), draw.disturbance("d", sign="-")
    inside = [draw.gain(written(a)), draw.integrator(written(y_0))]
    if layout == "before the integrator":
        inside.insert(1, enters)
    loop = draw.feedback_loop(inside, draw.gain(written(c)))
    before = {"behind the gain": [gain, enters], "before the gain": [enters, gain]}.get(layout, [gain])
    return draw.block_diagram("u", *before, loop, "y")


def _elsewhere(place):
    """The formula of somebody who reads $d$ at one of the two other places."""
    return lambda layout, K, a, c: [each for name, each in LAYOUTS.items() if name != layout][place](K, a, c)


#: What is said of a formula that is not that of the diagram, and the formula.
MISREAD = [
    (
        "There is a sign beside the arrow of $d$. Which one?",
        lambda layout, K, a, c: LAYOUTS[layout](K, a, c).subs(d_, -d_),
    ),
    (
        "Something comes back from the output, with a sign of its own. Which one, at the sum?",
        lambda layout, K, a, c: LAYOUTS[layout](K, a, c).subs(y_, -y_),
    ),
    (
        "The output goes back to the sum, too. What does it meet on its way?",
        lambda layout, K, a, c: LAYOUTS[layout](K, a, c).subs(y_, 0),
    ),
    (
        "A gain is in the path that leads back. What does the sum subtract?",
        lambda layout, K, a, c: LAYOUTS[layout](K, a, 1),
    ),
    (
        "One gain is behind the sum. What does it multiply: one of the two signals there, or both?",
        lambda layout, K, a, c: LAYOUTS[layout](K, a, c / a),
    ),
    (
        "There is a gain between the sum and the integrator. Is it in your formula?",
        lambda layout, K, a, c: LAYOUTS[layout](K, 1, c),
    ),
    (
        "$u$ passes a gain before it comes to the sum. Is it in your formula?",
        lambda layout, K, a, c: LAYOUTS[layout](1, a, c),
    ),
    ("Follow $d$ from its arrow to the integrator: which blocks does it pass, and which not?", _elsewhere(0)),
    ("Follow $d$ from its arrow to the integrator: which blocks does it pass, and which not?", _elsewhere(1)),
]


def _numbers_of(formula, u, d, y_0):
    """The rate at the beginning and the rest by a formula; none by one that does not know the output."""
    if not formula.has(y_):
        return {}
    (rest,) = sympy.solve(_at(formula, u=u, d=d), y_)
    return {"start": _at(formula, u=u, d=d, y=y_0), "rest": rest}


@functools.cache
def _all_numbers(layout, K, a, c, u, d, y_0):
    """Those of the diagram, and of all formulas that are not its own."""
    formulas = [LAYOUTS[layout](K, a, c), *(formula(layout, K, a, c) for _, formula in MISREAD)]
    return [_numbers_of(formula, u, d, y_0) for formula in formulas]


def _told(layout, K, a, c, u, d, y_0, name):
    """The rates at the beginning, or the rests, by all of these formulas."""
    return [one.get(name) for one in _all_numbers(layout, K, a, c, u, d, y_0)]


def _misread_as(number):
    """Formula and numbers of a mistake; of the numbers only those that no other mistake makes."""

    def found(layout, K, a, c, u, d, y_0):
        wrong = _all_numbers(layout, K, a, c, u, d, y_0)[number + 1]
        told = {
            name: value for name, value in wrong.items() if _told(layout, K, a, c, u, d, y_0, name).count(value) == 1
        }
        return {"rate": MISREAD[number][1](layout, K, a, c)} | told

    return found


for _number, (_sentence, _) in enumerate(MISREAD):
    read_diagram.mistake(_sentence)(_misread_as(_number))


@read_diagram.mistake(
    "At rest the path that leads back brings as much as comes in. Is $y$ multiplied by {c}, or divided?"
)
def _(layout, K, a, c, u, d):
    return {"rest": _rest(layout, K, a, c, u, d) * c**2}


@read_diagram.mistake("What does the integrator hold at the beginning? The number that enters it from above.")
def _(layout, K, a, c, u, d, y_0):
    start = _at(LAYOUTS[layout](K, a, c), u=u, d=d, y=0)
    return {"start": start} if start not in _told(layout, K, a, c, u, d, y_0, "start") else {}


@read_diagram.mistake("The second input is not zero. How does it act here?")
def _(layout, K, a, c, u, d, y_0):
    formula = LAYOUTS[layout](K, a, c)
    start, rest = _at(formula, u=u, d=0, y=y_0), _rest(layout, K, a, c, u, 0)
    starts = [*_told(layout, K, a, c, u, d, y_0, "start"), _at(formula, u=u, d=d, y=0)]
    rests = [*_told(layout, K, a, c, u, d, y_0, "rest"), 0]
    found = {"start": start} if start not in starts else {}
    return found | ({"rest": rest} if rest not in rests else {})


@read_diagram.mistake("At rest the input of the integrator is zero, not its output. Solve the formula for $y$.")
def _():
    return {"rest": 0}


read_diagram.hints(
    "Begin at the integrator: its output is $y$, so its input is $\\dot y$. Go backwards from there, block by block.",
    "Each gain multiplies what comes to it, and each sum adds with the signs beside its arrows. Note which gains $u$ "
    "passes, which ones $d$ passes, and which ones the path that leads back has.",
    "$u$ passes two gains, {K} and {a}, before it arrives at the integrator, so $\\dot y = {a}\\cdot{K}\\,u - \\dots$ "
    "At rest, $\\dot y = 0$.",
)


@read_diagram.solution
def _(layout, K, a, c, u, d, y_0):
    r"""The output of the integrator is $y$, so its input is $\dot y$. Go back from there. The input $u$ passes the
    gains {K} and {a}; the path that leads back has the gain {c}, a minus at the sum, and then also passes {a}. The
    other input, $d$, enters {layout}, with a minus, and {passes}. So

    $$\dot y = {form}$$

    **At the beginning** the integrator holds {y_0}, and with $u$ = {u} and $d$ = {d} the rate is {start}.

    **At rest** nothing changes any more: the input of the integrator is zero. The formula, set to zero and solved for
    $y$, gives {rest}.
    """
    passes = {
        "behind the gain": f"passes only {written(a)}",
        "before the integrator": "passes no gain at all",
        "before the gain": f"passes both, {written(K)} and {written(a)}",
    }
    where_d = {
        "behind the gain": rf"{written(a)}\,({written(K)}\,u - d - {written(c)}\,y)",
        "before the integrator": rf"{written(a)}\,({written(K)}\,u - {written(c)}\,y) - d",
        "before the gain": rf"{written(a)}\,({written(K)}\,(u - d) - {written(c)}\,y)",
    }
    return {"passes": passes[layout], "form": where_d[layout]}


@read_diagram.solution_picture
def _(layout, K, a, c, u, d, y_0):
    """The output on its way from what the integrator holds at the beginning to its rest."""
    rest = _rest(layout, K, a, c, u, d)
    y = rest + (y_0 - rest) * sympy.exp(-a * c * t)
    times = np.linspace(0, 5 / float(a * c), 201)
    return time_plot({"$y$": (y, "measurement")}, times, xlabel="$t$ [min]").level(rest, "at rest")


SIGN_OF_D, SIGN_OF_K, SWAPPED, MULTIPLIED = PLANTED = [
    "sign of the damper", "sign of the spring", "D and K interchanged", "mass multiplied",
]  # fmt: skip
ENDS = {
    SIGN_OF_D: "oscillates more and more",
    SIGN_OF_K: "runs away to one side",
    SWAPPED: "settles elsewhere",
    MULTIPLIED: "settles at F/K",
}


def _as_drawn(fault, m, D, K):
    """The acceleration that the diagram computes, with the fault in it."""
    return {
        SIGN_OF_D: (F_ + D * v_ - K * y_) / m,
        SIGN_OF_K: (F_ - D * v_ + K * y_) / m,
        SWAPPED: (F_ - K * v_ - D * y_) / m,
        MULTIPLIED: m * (F_ - D * v_ - K * y_),
    }[fault]


@exercise(
    "2.8",
    title="Find the fault",
    points=4,
    where=lambda m, D, K: abs(D / K - 1) > 0.2 and 4 * m * K > 1.5 * D**2,
    insight="A plus for a minus turns a plant that settles into one that does not: check the signs of a loop first.",
)
def find_the_fault(
    fault=choice(*PLANTED, reference=SIGN_OF_K),
    m=between(2, 12, "kg", reference=5, step=1),
    D=between(2, 12, "N s/m", reference=4, step=1),
    K=between(3, 20, "N/m", reference=8, step=1),
):
    r"""A mass $m$ = {m} hangs on a spring with $K$ = {K} and a damper with $D$ = {D}. A force $F$ pulls at it:

    $$m\ddot y = F - D\dot y - Ky$$

    A colleague has drawn the block diagram of the picture for a simulation, with these numbers in SI units, and made
    one mistake. Which formula does his diagram compute for the acceleration, in $F$, the speed $v$ and the position
    $y$? What is the mistake: the sign of the damper, the sign of the spring, are $D$ and $K$ interchanged, or is the
    force multiplied by the mass? And what does the simulation show when a constant force begins to pull at a mass at
    rest?
    """
    return answers(
        acceleration=expression(
            _as_drawn(fault, m, D, K),
            "the acceleration that the diagram computes, in $F$, $v$ and $y$",
            symbols="F v y",
        ),
        fault=word(fault, PLANTED, what="the mistake"),
        shows=word(ENDS[fault], list(ENDS.values()), what="what the position does in the simulation"),
    )


@find_the_fault.shows
def _(fault, m, D, K):
    signs = ["plus" if fault == wrong else "minus" for wrong in (SIGN_OF_K, SIGN_OF_D)]
    outer, inner = (D, K) if fault == SWAPPED else (K, D)
    loops = f"{signs[0]} {written(outer)} times $y$, {signs[1]} {written(inner)} times $v$"
    mass = f"{'multiplied' if fault == MULTIPLIED else 'divided'} by {written(m)}"
    return {"diagram": f"$F$, {loops}, then {mass}, then an integrator to $v$ and an integrator to $y$"}


@find_the_fault.picture
def _(fault, m, D, K):
    """A block diagram: {diagram}."""
    inner, outer = (K, D) if fault == SWAPPED else (D, K)
    mass = draw.multiplication(written(m)) if fault == MULTIPLIED else draw.division(written(m))
    braked = draw.feedback_loop(
        [mass, draw.integrator("0")], draw.multiplication(written(inner)), sign="+" if fault == SIGN_OF_D else "-"
    )
    whole = draw.feedback_loop(
        [braked, "v", draw.integrator("0")],
        draw.multiplication(written(outer)),
        sign="+" if fault == SIGN_OF_K else "-",
    )
    return draw.block_diagram("F", whole, "y")


@find_the_fault.mistake(
    "That is what the model says. What does the diagram compute, sign by sign and number by number?"
)
def _(m, D, K):
    return {"acceleration": (F_ - D * v_ - K * y_) / m}


@find_the_fault.mistake("That is a force. Which block does it meet on its way to the first integrator?")
def _(fault, m, D, K):
    drawn = _as_drawn(fault, m, D, K)
    return {"acceleration": sympy.expand(drawn / m if fault == MULTIPLIED else drawn * m)}


@find_the_fault.mistake("Both loops arrive with a plus in your formula. Look at the signs beside their arrows.")
def _(fault, m, D, K):
    inner, outer = (K, D) if fault == SWAPPED else (D, K)
    return {"acceleration": (F_ + inner * v_ + outer * y_) * (m if fault == MULTIPLIED else 1 / m)}


@find_the_fault.mistake(
    "The block in front of the first integrator acts on the whole sum. On what does it act for you?"
)
def _(fault, m, D, K):
    loops = _as_drawn(fault, m, D, K).subs(F_, 0)
    divided = fault != MULTIPLIED
    return {"acceleration": F_ / m + m * loops if divided else m * F_ + loops / m}


@find_the_fault.mistake("What does the block in front of the first integrator do with the sum: multiply or divide it?")
def _(fault, m, D, K):
    return {"acceleration": sympy.expand(_as_drawn(fault, m, D, K) * m**2)} if fault != MULTIPLIED else {}


@find_the_fault.mistake("Which of the two loops begins behind the first integrator, and which behind the second one?")
def _(fault, m, D, K):
    drawn = _as_drawn(fault, m, D, K)
    return {"acceleration": drawn.subs({v_: y_, y_: v_}, simultaneous=True)} if fault != SWAPPED else {}


def _misread(other):
    """The formula of somebody who sees another fault than the diagram has."""

    def found(fault, m, D, K):
        return {"acceleration": _as_drawn(other, m, D, K)} if other != fault else {}

    return found


for _other in PLANTED:
    find_the_fault.mistake("The diagram has one fault, and your formula another one. Read it block by block.")(
        _misread(_other)
    )


FAULT_DOUBTS = {
    SIGN_OF_D: "Look at the sum where the inner loop arrives. Which sign is beside its arrow, and which one should be?",
    SIGN_OF_K: "Look at the sum where the outer loop arrives. Which sign is beside its arrow, and which one should be?",
    SWAPPED: "Compare both numbers with the statement: which one multiplies the speed, and which one the position?",
    MULTIPLIED: "Look at the block in front of the first integrator: what does it do with the number that enters it?",
}
END_DOUBTS = {
    ENDS[SIGN_OF_D]: "For this the speed would have to be driven on in the diagram, by the inner loop. Is it?",
    ENDS[SIGN_OF_K]: "For this the position would have to push itself further away, by the outer loop. Does it?",
    ENDS[SWAPPED]: "At rest, $v = 0$ and the acceleration is zero. Does your formula then give another $y$ than $F/K$?",
    ENDS[
        MULTIPLIED
    ]: "At rest, $v = 0$ and the acceleration is zero. What is $y$ by your formula? And does it get there?",
}


def _doubt(name, wrong):
    def found(fault):
        right = fault if name == "fault" else ENDS[fault]
        return {name: wrong} if wrong != right else {}

    return found


for _name, _doubts in (("fault", FAULT_DOUBTS), ("shows", END_DOUBTS)):
    for _wrong, _sentence in _doubts.items():
        find_the_fault.mistake(_sentence)(_doubt(_name, _wrong))

find_the_fault.hints(
    "Read the diagram as if you knew nothing about the plant, and only then compare it with the model.",
    "The input of the first integrator is the acceleration. Go back from there: one block, then a sum with two loops "
    "that arrive with a sign and a number. The inner loop begins behind the first integrator, with the speed $v$, "
    "the outer one behind the second, with the position $y$.",
    "The model wants $a = \\frac{1}{ {m} }\\,(F - {D}\\,v - {K}\\,y)$. Compare each sign, each number, and what the "
    "block in front of the first integrator does. Then ask what your formula makes of a large $v$, and of a large "
    "$y$.",
)


@find_the_fault.solution
def _(fault, m, D, K):
    r"""Go back from the first integrator, whose input is the acceleration. As it is drawn, the diagram computes

    $$a = {drawn}$$

    The model wants $a = ({wanted})/{m}$. What differs is this: {fault}.

    {why} So the position {shows}.
    """
    why = {
        SIGN_OF_D: "The damper now drives the mass on, the more so the faster it is. The spring pulls it back, so "
        "it passes its place of rest again and again, and farther each time.",
        SIGN_OF_K: "The spring now pushes the mass away, the harder the farther it is. Nothing brings it back.",
        SWAPPED: "At rest only the outer loop acts, and it has the number of the damper: the mass settles at "
        f"$F/{written(D)}$, not at $F/{written(K)}$.",
        MULTIPLIED: "At rest the sum of the forces is zero, whatever it is multiplied by. The way there "
        "is much too fast, but it ends at the right place.",
    }
    over = r"\frac{1}{%s}\,(%s)"
    forms = {
        SIGN_OF_D: over % (written(m), rf"F + {written(D)}\,v - {written(K)}\,y"),
        SIGN_OF_K: over % (written(m), rf"F - {written(D)}\,v + {written(K)}\,y"),
        SWAPPED: over % (written(m), rf"F - {written(K)}\,v - {written(D)}\,y"),
        MULTIPLIED: rf"{written(m)}\,(F - {written(D)}\,v - {written(K)}\,y)",
    }
    wanted = rf"F - {written(D)}\,v - {written(K)}\,y"
    return {"drawn": forms[fault], "wanted": wanted, "why": why[fault]}
