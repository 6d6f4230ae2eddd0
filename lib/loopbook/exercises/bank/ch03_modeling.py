"""Exercises of chapter 3, mathematical modeling."""

import functools
import math

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
    time_function,
    transfer_function,
    word,
)
from loopbook.expressions import s, t


@exercise(
    "3.1",
    title="The cistern in the rain",
    points=2,
    where=lambda h, h_max, q_1, q_2, q_o: abs(q_1 + q_2 - q_o) >= 10 and h_max - h >= 200,
)
def cistern(
    A=between(3, 12, "m²", reference=6, step=0.5),
    h=between(300, 1500, "mm", reference=800),
    h_max=between(1600, 2400, "mm", reference=2000),
    q_1=between(10, 60, "L/min", reference=30, step=2),
    q_2=between(10, 60, "L/min", reference=45, step=1),
    q_o=between(20, 120, "L/min", reference=60, step=5),
):
    """Two gutters lead rain into a cistern with upright walls: {q_1} and {q_2}. A pump takes {q_o} out of it. The
    cross-section is {A}, the water stands {h} high, and the rim is at {h_max}.

    At which rate does the level change (negative if it falls)? If nothing changes, does the cistern run over or run
    empty, and after what time?
    """
    rate = (q_1 + q_2 - q_o) / A
    return answers(
        rate=number(rate, "mm/min", "the rate of the level"),
        end=word(
            "runs over" if rate > 0 else "runs empty", ["runs over", "runs empty"], what="what happens in the end"
        ),
        time=number((h_max - h) / rate if rate > 0 else -h / rate, "min", "the time until then"),
    )


@cistern.mistake("Which of the three flows leave the cistern? They have the other sign in the balance.")
def _(A, q_1, q_2, q_o):
    return {"rate": (q_1 + q_2 + q_o) / A}


@cistern.mistake("There are two gutters, and both bring water.")
def _(A, q_1, q_2, q_o):
    alone, both = q_1 - q_o, q_1 + q_2 - q_o
    return {"rate": alone / A} if abs(abs(alone / both) - 1) > 0.05 else {}


@cistern.mistake("There are two gutters, and both bring water.")
def _(A, q_1, q_2, q_o):
    alone, both = q_2 - q_o, q_1 + q_2 - q_o
    return {"rate": alone / A} if abs(abs(alone / both) - 1) > 0.05 else {}


@cistern.mistake("Which way does the level have to go, and how far is it from where it is now?")
def _(A, h, h_max, q_1, q_2, q_o):
    rate = (q_1 + q_2 - q_o) / A
    wrong, right = (h, h_max - h) if rate > 0 else (h_max - h, h)
    return {"time": wrong / abs(rate)} if abs(wrong / right - 1) > 0.03 else {}


@cistern.mistake("That is the flow that is left over. The level is its volume over the area.")
def _(q_1, q_2, q_o):
    return {"rate": q_1 + q_2 - q_o}


# Tanks that are not upright: what they look like, the area at the level z and that of the rim.
h, z, H, R, L, W, q_i, q_o, k, rho = sympy.symbols("h z H R L W q_i q_o k rho", positive=True)
SHAPES = {
    "funnel": (
        "A funnel is a cone with its tip at the bottom. At the height $H$ its radius is $R$",
        sympy.pi * (R * z / H) ** 2,
    ),
    "trough": (
        "A trough has upright ends and two sloping walls that meet at the bottom. It is $L$ long, and at the height"
        " $H$ it is $W$ wide",
        L * W * z / H,
    ),
    "bowl": (
        "The radius of a bowl grows with the square root of the height. At the height $H$ it is $R$",
        sympy.pi * R**2 * z / H,
    ),
    "pit": (
        "A settling pit has the shape of a pyramid with its tip at the bottom. At the height $H$ it is a square with "
        "sides of length $L$",
        (L * z / H) ** 2,
    ),
    "goblet": (
        "The radius of a goblet grows with the square of the height. At the height $H$ it is $R$",
        sympy.pi * (R * (z / H) ** 2) ** 2,
    ),
}
OUTLETS = {
    "pump": ("a pump takes the volume flow $q_o$ [m³/s] out of it", q_o),
    "hole": (r"through a hole at the bottom it loses the volume flow $k\sqrt h$ [m³/s]", k * sympy.sqrt(h)),
}


@functools.cache
def _volume(shape):
    """The volume of the liquid, and its area at the level."""
    area = SHAPES[shape][1]
    return sympy.integrate(area, (z, 0, h)), area.subs(z, h)


@exercise("3.2", title="Walls that are not upright", points=3)
def sloping_walls(shape=choice(*SHAPES, reference="funnel"), outlet=choice(*OUTLETS, reference="pump")):
    r"""{looks}. It holds a liquid of constant density $\rho$ [kg/m³], and its level $h$ [m] is counted from the
    bottom. All lengths are in metres. The volume flow $q_i$ [m³/s] comes in, and {loses}.

    Find the volume $V$ of the liquid, and from the mass balance the rate $\dot h$ at which the level changes, both as
    formulas in these symbols.
    """
    (V, area), out = _volume(shape), OUTLETS[outlet][1]
    names = " ".join(["rho", *(symbol.name for symbol in (V + area + out + q_i).free_symbols)])
    return answers(
        V=expression(V, "the volume", symbols=names, unit="m³"),
        rate=expression((q_i - out) / area, "the rate of the level", symbols=names, unit="m/s"),
    )


@sloping_walls.shows
def _(shape, outlet):
    return {"looks": SHAPES[shape][0], "loses": OUTLETS[outlet][0]}


@sloping_walls.mistake("The area is not the same at every height. Add it up from the bottom to the level.")
def _(shape, outlet):
    (_, area), net = _volume(shape), q_i - OUTLETS[outlet][1]
    return {"V": area * h, "rate": net / (area * h).diff(h)}


@sloping_walls.mistake("That is the area of the rim. The liquid has the area that belongs to its level.")
def _(shape, outlet):
    area, net = SHAPES[shape][1].subs(z, H), q_i - OUTLETS[outlet][1]
    return {"V": area * h, "rate": net / area}


@sloping_walls.mistake(
    "That is the flow over the mean area, $V/h$. What is the derivative of the volume with respect to time?"
)
def _(shape, outlet):
    (V, _), net = _volume(shape), q_i - OUTLETS[outlet][1]
    return {"rate": net * h / V}


@sloping_walls.mistake("The density is the same inside and in both flows. Is it needed here?")
def _(shape, outlet):
    (V, area), net = _volume(shape), q_i - OUTLETS[outlet][1]
    return {"V": rho * V, "rate": net / (rho * area)}


@sloping_walls.mistake("What flows in is there. What flows out of the tank, and with which sign?")
def _(shape, outlet):
    (_, area), out = _volume(shape), OUTLETS[outlet][1]
    return {"rate": (q_i + out) / area}


def _decay(V, q, k):
    """How fast the concentration follows, and which part of the inflow's remains."""
    return V / (q + k * V), q / (q + k * V)


@exercise("3.3", title="A pond that cleans itself", points=4, where=lambda V, q, k: 0.15 <= k * V / q <= 3)
def pond(
    V=between(100, 600, "m³", reference=300),
    q=between(4, 20, "m³/h", reference=10),
    k=choice(0.01, 0.02, 0.04, 0.05, 0.06, 0.08, 0.1, unit="1/h", reference=0.05),
    c_in=between(20, 80, "g/m³", reference=50, step=5),
):
    r"""Waste water flows through a stirred pond with the constant volume {V}: {q} in and {q} out. Bacteria eat the
    waste. In every cubic metre of the pond they take $kc$ grams an hour, where $c$ [g/m³] is the concentration in the
    pond and in the outflow, and $k$ = {k}.

    The pond is clean when, at $t = 0$, water with {c_in} of waste begins to flow in. Set up the balance of the waste.
    With which time constant does the concentration follow, where does it end, and what is $c(t)$, with $t$ in hours?
    """
    T, share = _decay(V, q, k)
    return answers(
        T=number(T, "h", "the time constant"),
        c_s=number(share * c_in, "g/m³", "the concentration in the end"),
        c=time_function(share * c_in * (1 - sympy.exp(-t / T)), until=5 * T, unit="g/m³", what="the concentration"),
    )


@pond.mistake(
    "That is a pond without bacteria, or nearly so. They remove that much from every cubic metre: how much is it "
    "in the whole pond?"
)
def _(V, q, c_in):
    T, c_s = V / q, c_in
    return {"T": T, "c_s": c_s, "c": c_s * (1 - sympy.exp(-t / T))}


@pond.mistake("The bacteria take waste out of the pond. Which sign has their term, compared with that of the outflow?")
def _(V, q, k, c_in):
    if abs(q - k * V) < q / 20:
        return {}
    return {"T": V / (q - k * V), "c_s": q * c_in / (q - k * V)}


@pond.mistake("That is the time constant of the bacteria alone. What else carries waste out of the pond?")
def _(V, q, k):
    return {"T": 1 / k} if abs(k * V / q - 1) > 0.03 else {}


@pond.mistake("Your concentration ends at that of the inflow. Do the bacteria not remove anything?")
def _(V, q, k, c_in):
    T, _ = _decay(V, q, k)
    return {"c": c_in * (1 - sympy.exp(-t / T))}


@pond.mistake("Your concentration ends where it should. How fast does it get there when the bacteria help?")
def _(V, q, k, c_in):
    _, share = _decay(V, q, k)
    return {"c": share * c_in * (1 - sympy.exp(-t * q / V))}


@pond.mistake("An exponent is a pure number: here it must be a time over a time constant.")
def _(V, q, k, c_in):
    T, share = _decay(V, q, k)
    return {"c": share * c_in * (1 - sympy.exp(-t * T))}


@pond.mistake("At first the pond is clean, and in the end it is not. It is the other way round.")
def _(V, q, k, c_in):
    T, share = _decay(V, q, k)
    return {"c": share * c_in * sympy.exp(-t / T)}


@exercise("3.4", title="Milk that is kept warm", points=4, where=lambda T_i, T_e, T_SP: T_e - T_i >= 5 and T_e < T_SP)
def milk(
    m=between(100, 500, "kg", reference=200, step=20),
    F=choice(0.05, 0.08, 0.1, 0.12, 0.15, 0.2, unit="kg/s", reference=0.1),
    c=choice(3900, 3950, 4000, unit="J/(kg K)", reference=3900),
    U_h=between(50, 200, "W/K", reference=110, step=10),
    T_i=between(4, 12, "°C", reference=6),
    T_e=between(15, 30, "°C", reference=20),
    T_SP=between(35, 65, "°C", reference=45),
):
    r"""Milk flows through a stirred vat that always holds {m}: {F} in and as much out. Its specific heat capacity is
    {c}. It comes in at {T_i}, the dairy has {T_e}, and between vat and dairy the heat transfer coefficient is {U_h}.
    An element heats the milk with the power $P$.

    Which power holds the milk at {T_SP}? Which temperature does the milk reach in the end if the element fails? And
    what is the transfer function from the power [W] to the temperature [°C], with the numbers of the vat and with time
    in seconds?
    """
    return answers(
        P=number((c * F * (T_SP - T_i) + U_h * (T_SP - T_e)) / 1000, "kW", "the power"),
        T_off=number((c * F * T_i + U_h * T_e) / (c * F + U_h), "°C", "the temperature without the element"),
        H=transfer_function(1 / (c * m * s + c * F + U_h), "the transfer function from the power"),
    )


@milk.mistake("Heat also passes through the wall, between the vat and the dairy.")
def _(m, F, c, T_i, T_SP):
    return {"P": c * F * (T_SP - T_i) / 1000, "T_off": T_i, "H": 1 / (c * m * s + c * F)}


@milk.mistake("The milk that flows through carries heat, too: it comes in cold and leaves as warm as the vat.")
def _(m, F, c, U_h, T_e, T_SP):
    found = {"P": U_h * (T_SP - T_e) / 1000, "T_off": T_e}
    return found if abs(U_h / (c * F) - 1) < 0.05 else found | {"H": 1 / (c * m * s + U_h)}


@milk.mistake("The dairy is warmer than the milk that comes in: the two differences of temperature are not the same.")
def _(F, c, U_h, T_i, T_SP):
    return {"P": (c * F + U_h) * (T_SP - T_i) / 1000}


@milk.mistake(
    "The mean of the two temperatures would be right if stream and wall carried the same heat for one kelvin."
)
def _(F, c, U_h, T_i, T_e):
    mean, right = (T_i + T_e) / 2, (c * F * T_i + U_h * T_e) / (c * F + U_h)
    return {"T_off": mean} if abs(mean / right - 1) > 0.03 else {}


@milk.mistake("That is per kilowatt. Here the power is in watts.")
def _(m, F, c, U_h):
    return {"H": 1000 / (c * m * s + c * F + U_h)}


@milk.mistake("That is right with the time in minutes. Here it should be in seconds.")
def _(m, F, c, U_h):
    return {"H": 1 / (c * m * s / 60 + c * F + U_h)}


@milk.mistake("The lag is right. By how many kelvin does one watt more warm the milk in the end?")
def _(m, F, c, U_h):
    return {"H": 1 / (c * m / (c * F + U_h) * s + 1)}


@milk.mistake("The energy inside is that of the whole mass. What is the rate of the temperature multiplied by?")
def _(F, c, U_h):
    return {"H": 1 / (c * s + c * F + U_h)}


g_earth = sympy.Rational("9.81")
TORQUE, INERTIA, RADIUS, CABIN, WEIGHT, G = sympy.symbols("T J r m_1 m_2 g", positive=True)


def _lift(T, J, r, m_1, m_2, g):
    return (T / r - (m_1 - m_2) * g) / (m_1 + m_2 + J / r**2)


@exercise(
    "3.5",
    title="A lift with a counterweight",
    points=5,
    where=lambda m_1, m_2, J, r, T: (
        abs(m_1 - m_2) >= 60
        and abs(T) >= 200
        and sympy.Rational(1, 5) <= abs(_lift(T, J, r, m_1, m_2, g_earth)) <= 2
        and abs(T / r) <= 3 * abs(T / r - (m_1 - m_2) * g_earth)
    ),
)
def lift(
    m_1=between(600, 1500, "kg", reference=1100, step=20),
    m_2=between(800, 1200, "kg", reference=900, step=20),
    J=between(20, 120, "kg m²", reference=50, step=5),
    r=choice(0.25, 0.3, 0.35, 0.4, 0.5, unit="m", reference=0.4),
    T=between(-2000, 2000, "N m", reference=1500, step=50),
):
    r"""A rope runs over the drum of a motor. On its one side hangs the cabin of a lift with the mass $m_1$ = {m_1},
    people included, on the other a counterweight of $m_2$ = {m_2}. Drum and motor have the inertia $J$ = {J} and the
    radius $r$ = {r}, and the rope does not slip. The motor turns with the torque $T$, positive where it lifts the
    cabin. Rope and friction count for nothing, and $g$ = 9.81 m/s².

    The tension of the rope is an inner force on each side. Get rid of both, and find the acceleration of the cabin,
    upwards positive, as a formula in the symbols. Then in numbers: the mass that the rope seems to move, the torque
    that holds the cabin where it is, and the acceleration under a torque of {T}.
    """
    return answers(
        formula=expression(
            _lift(TORQUE, INERTIA, RADIUS, CABIN, WEIGHT, G), "the formula for the acceleration of the cabin"
        ),
        mass=number(m_1 + m_2 + J / r**2, "kg", "the mass that seems to move"),
        T_hold=number((m_1 - m_2) * g_earth * r, "N m", "the torque that holds the cabin"),
        a=number(_lift(T, J, r, m_1, m_2, g_earth), "m/s²", "the acceleration"),
    )


def _lift_with(mass, weight):
    """Formula, mass and acceleration of somebody who counts another mass or another weight."""

    def found(m_1, m_2, J, r, T):
        in_letters = {"m_1": CABIN, "m_2": WEIGHT, "J": INERTIA, "r": RADIUS}
        in_numbers = {"m_1": m_1, "m_2": m_2, "J": J, "r": r}
        return {
            "formula": (TORQUE / RADIUS - weight(**in_letters) * G) / mass(**in_letters),
            "mass": mass(**in_numbers),
            "T_hold": weight(**in_numbers) * g_earth * r,
            "a": (T / r - weight(**in_numbers) * g_earth) / mass(**in_numbers),
        }

    return found


def _moved(m_1, m_2, J, r):
    """The mass that the rope seems to move."""
    return m_1 + m_2 + J / r**2


def _only(found, *names):
    return {name: found[name] for name in names}


@lift.mistake("Drum and motor have to be turned as well. What is their inertia, seen from the rope?")
def _(m_1, m_2, J, r, T):
    found = _lift_with(lambda m_1, m_2, J, r: m_1 + m_2, lambda m_1, m_2, J, r: m_1 - m_2)(m_1, m_2, J, r, T)
    different = found["mass"] * sympy.Rational("1.02") < m_1 + m_2 + J / r**2
    return _only(found, "formula", "mass", "a") if different else _only(found, "formula")


@lift.mistake(
    "The weights of cabin and counterweight pull against each other, but both masses have to be set in motion. "
    "Which of the two is a difference, which a sum?"
)
def _(m_1, m_2, J, r, T):
    found = _lift_with(lambda m_1, m_2, J, r: m_1 - m_2 + J / r**2, lambda m_1, m_2, J, r: m_1 - m_2)(m_1, m_2, J, r, T)
    return _only(found, "formula", "mass")


@lift.mistake("The counterweight helps the motor: it pulls on the other side of the drum.")
def _(m_1, m_2, J, r, T):
    found = _lift_with(_moved, lambda m_1, m_2, J, r: m_1)(m_1, m_2, J, r, T)
    return _only(found, "formula", "T_hold", "a")


@lift.mistake(
    "The weights of cabin and counterweight are on two sides of the drum. Do they turn it in the same direction?"
)
def _(m_1, m_2, J, r, T):
    found = _lift_with(_moved, lambda m_1, m_2, J, r: m_1 + m_2)(m_1, m_2, J, r, T)
    return _only(found, "formula", "T_hold", "a")


@lift.mistake("Which of the two weights pulls the cabin down, and which one up?")
def _(m_1, m_2, J, r, T):
    found = _lift_with(_moved, lambda m_1, m_2, J, r: m_2 - m_1)(m_1, m_2, J, r, T)
    return _only(found, "formula", "a")


@lift.mistake("That belongs to the turning of the drum. How is the motion of the rope connected with it?")
def _(m_1, m_2, J, r, T):
    angular = _lift(TORQUE, INERTIA, RADIUS, CABIN, WEIGHT, G) / RADIUS
    return {"formula": angular, "mass": J + (m_1 + m_2) * r**2, "a": _lift(T, J, r, m_1, m_2, g_earth) / r}


@lift.mistake("A mass is not yet a force. How large is the force of gravity on it?")
def _(m_1, m_2, r):
    return {"T_hold": (m_1 - m_2) * r}


@lift.mistake("An inertia in kg m² does not become a mass when it is multiplied by the radius. Look at the units.")
def _(m_1, m_2, J, r, T):
    found = _lift_with(lambda m_1, m_2, J, r: m_1 + m_2 + J * r**2, lambda m_1, m_2, J, r: m_1 - m_2)(m_1, m_2, J, r, T)
    return _only(found, "formula")


@lift.mistake("A torque is not a force. How long is the arm at which the rope pulls?")
def _(m_1, m_2, J, r, T):
    return {
        "formula": (TORQUE - (CABIN - WEIGHT) * G) / (CABIN + WEIGHT + INERTIA / RADIUS**2),
        "T_hold": (m_1 - m_2) * g_earth,
    }


@lift.mistake("In the formula, leave $g$ a symbol.")
def _():
    return {"formula": _lift(TORQUE, INERTIA, RADIUS, CABIN, WEIGHT, g_earth)}


# Circuits of two resistors and a capacitor: what they look like, the transfer function, the time constant.
R_1, R_2, C = sympy.symbols("R_1 R_2 C", positive=True)
CIRCUITS = {
    "loaded": (
        "A resistor $R_1$ leads from the input to the output. From the output to ground lead a capacitor $C$ and, "
        "beside it, a resistor $R_2$, which is the input resistance of the instrument that reads the voltage",
        R_2 / (R_1 + R_2 + R_1 * R_2 * C * s),
    ),
    "stepped": (
        "A resistor $R_1$ leads from the input to the output. From the output to ground lead, one behind the other, a "
        "resistor $R_2$ and a capacitor $C$",
        (R_2 * C * s + 1) / ((R_1 + R_2) * C * s + 1),
    ),
    "bridged": (
        "A resistor $R_1$ and, beside it, a capacitor $C$ lead from the input to the output. From the output to "
        "ground leads a resistor $R_2$",
        R_2 * (R_1 * C * s + 1) / (R_1 + R_2 + R_1 * R_2 * C * s),
    ),
}


def _lag(circuit, R_1, R_2, C):
    return (R_1 + R_2) * C if circuit == "stepped" else R_1 * R_2 * C / (R_1 + R_2)


@exercise("3.6", title="Two resistors and a capacitor", points=5, where=lambda r_1, r_2: r_1 != r_2)
def two_resistors(
    circuit=choice(*CIRCUITS, reference="loaded"),
    r_1=between(1, 20, "kΩ", reference=5),
    r_2=between(2, 60, "kΩ", reference=20),
    c=choice(1, 2, 5, 10, 20, 50, unit="µF", reference=10),
):
    """{looks}. Nothing else takes a current from the output.

    Set up the balance of the currents, and find the transfer function from the input voltage to the output voltage in
    the symbols $R_1$, $R_2$ and $C$.

    Now let $R_1$ = {r_1}, $R_2$ = {r_2} and $C$ = {c}. With which time constant does the capacitor follow? By which
    factor does the circuit multiply a constant voltage, and by which one a voltage that changes very fast?
    """
    H = CIRCUITS[circuit][1]
    share = r_2 / (r_1 + r_2)
    slow, fast = {"loaded": (share, 0), "stepped": (1, share), "bridged": (share, 1)}[circuit]
    return answers(
        H=transfer_function(H, "the transfer function", symbols="R_1 R_2 C"),
        T=number(_lag(circuit, r_1, r_2, c), "ms", "the time constant"),
        slow=number(slow, "", "the factor for a constant voltage"),
        fast=number(fast, "", "the factor for a very fast one"),
    )


@two_resistors.shows
def _(circuit):
    return {"looks": CIRCUITS[circuit][0]}


@two_resistors.mistake("There is a second resistor, and a current flows through it as well.")
def _(circuit, r_1, c):
    if circuit == "stepped":
        return {"H": 1 / (R_1 * C * s + 1), "T": r_1 * c}
    return {"H": 1 / (R_1 * C * s + 1) if circuit == "loaded" else R_2 * C * s / (R_2 * C * s + 1), "T": r_1 * c}


@two_resistors.mistake("There is a second resistor, and a current flows through it as well.")
def _(r_2, c):
    return {"T": r_2 * c}


@two_resistors.mistake("Across which of the two resistors is the output voltage?")
def _(circuit, r_1, r_2):
    return {"fast" if circuit == "stepped" else "slow": r_1 / (r_1 + r_2)} if abs(r_1 / r_2 - 1) > 0.03 else {}


@two_resistors.mistake(
    "Replace the source by a wire, for which its voltage is zero. Are the two resistors, seen from the capacitor, "
    "in series or in parallel?"
)
def _(circuit, r_1, r_2, c):
    return {"T": r_1 * r_2 * c / (r_1 + r_2) if circuit == "stepped" else (r_1 + r_2) * c}


@two_resistors.mistake("That is the voltage over another part of the circuit. Between which two points is the output?")
def _(circuit):
    H = CIRCUITS[circuit][1]
    return {"H": 1 / ((R_1 + R_2) * C * s + 1) if circuit == "stepped" else sympy.together(1 - H)}


@two_resistors.mistake("That is the circuit with its values. Give the transfer function in the symbols.")
def _(circuit, r_1, r_2, c):
    return {"H": CIRCUITS[circuit][1].subs({R_1: 1000 * r_1, R_2: 1000 * r_2, C: c / 10**6})}


@two_resistors.mistake("A capacitor lets no constant current through, and is like a wire for a very fast one.")
def _(circuit, r_1, r_2):
    share = r_2 / (r_1 + r_2)
    slow, fast = {"loaded": (share, 0), "stepped": (1, share), "bridged": (share, 1)}[circuit]
    return {"slow": fast, "fast": slow}


@exercise(
    "3.7",
    title="A filter against the hum",
    points=5,
    where=lambda f, rest, t_95: (
        1.3 <= 2 * math.pi * f * t_95 / 1000 / math.log(20) / math.sqrt((100 / float(rest)) ** 2 - 1) <= 4
    ),
)
def hum(
    f=choice(50, 60, unit="Hz", reference=50),
    rest=choice(2, 3, 4, 5, 6, 8, 10, 12, 15, unit="%", reference=5),
    t_95=between(60, 800, "ms", reference=300, step=20),
    C=choice(1, 2.2, 3.3, 4.7, 6.8, 10, 15, 22, unit="µF", reference=4.7),
):
    r"""The signal of a thermometer carries the hum of the mains, a sine of {f}. An RC circuit as in Example 3.5 should
    take it away. A capacitor of {C} is at hand.

    Choose the resistance $R$: no more than {rest} of the amplitude of the hum should come through. And when the
    temperature makes a step, the output should have gone 95 % of the way after {t_95} at the latest.
    """
    omega, capacitance, end = 2 * math.pi * float(f), float(C) * 1e-6, float(t_95)

    def hum_left(R):
        return 100 / math.hypot(1, omega * R * 1000 * capacitance)

    def time_to_95(R):
        return 1000 * math.log(20) * R * 1000 * capacitance

    smallest = math.sqrt((100 / float(rest)) ** 2 - 1) / omega / capacitance / 1000
    largest = end / 1000 / math.log(20) / capacitance / 1000
    return answers(
        R=design(
            number(math.sqrt(smallest * largest), "kΩ", "the resistance"),
            criterion("the resistance is positive", lambda R: R > 0),
            criterion("the rest of the hum", hum_left, below=float(rest), unit="%"),
            criterion("the time to 95 % of the way", time_to_95, below=end, unit="ms"),
        )
    )
