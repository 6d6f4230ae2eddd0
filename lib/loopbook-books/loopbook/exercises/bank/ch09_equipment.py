"""Exercises of chapter 9, controller equipment."""

import math

import numpy as np
from sympy import Piecewise, Symbol, exp, pi, symbols

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
    time_function,
    word,
)
from loopbook.expressions import t
from loopbook.figures import plane_plot, time_plot


def _differs(value, *others, by=0.03):
    """Whether a wrong value can be told from the right one and from those of other mistakes."""
    return all(abs(value - other) > by * abs(other) for other in others)


@exercise(
    "9.1",
    title="A kiln behind a resistor",
    points=2,
    where=lambda T_low, T_high, R, V: 6 <= 1000 * V / R <= 18 and abs(5 * T_low - T_high) >= 80 and T_high != 9 * T_low,
    insight="A range that begins at 4 mA has a live zero: no current means a broken cable, and not a cold kiln.",
)
def kiln(
    T_low=between(100, 400, "°C", reference=200, step=50),
    T_high=between(800, 1400, "°C", reference=1200, step=50),
    R=choice(100, 250, 500, unit="Ω", reference=250),
    V=between(0.6, 9, "V", reference=3, step=0.1),
):
    """The thermometer of a kiln sends 4 to 20 mA for {T_low} to {T_high}. A resistor of {R} turns the current into a
    voltage, and a voltmeter across it shows {V}. What is the current, and how hot is the kiln? Then the cable breaks:
    which temperature would a controller show that keeps the same scaling and gives no alarm?
    """
    I = 1000 * V / R
    span = T_high - T_low
    return answers(
        I=number(I, "mA", "the current"),
        T=number(T_low + (I - 4) * span / 16, "°C", "the temperature of the kiln"),
        T_broken=number(T_low - span / 4, "°C", "the temperature that a broken cable shows"),
    )


@kiln.picture
def _(T_low, T_high, R, V):
    """From the temperature to the voltage: a thermometer of {T_low} to {T_high} sends 4 to 20 mA, and the current makes
    {V} at a resistor of {R}."""
    thermometer = draw.block(f"${written(T_low)}$ to ${written(T_high)}$ °C\n$4$ to $20$ mA")
    resistor = draw.block(f"Resistor\n${written(R)}$ Ω")
    return draw.block_diagram(r"$\vartheta$", thermometer, "I", resistor, f"${written(V)}$ V")


@kiln.mistake("A broken cable carries no current. Which temperature has the line of the scaling at 0 mA?")
def _():
    return {"T_broken": 0}


@kiln.mistake("The range of the temperature does not begin at zero. How wide is it?")
def _(T_low, T_high, R, V):
    share, span = (1000 * V / R - 4) / 16, T_high - T_low
    wrong = T_low + share * T_high
    apart = all(abs(wrong - other) > other / 30 for other in (T_low + share * span, T_low + 50 * V / R * span))
    found = {"T": wrong} if apart else {}
    return found | ({"T_broken": T_low - T_high / 4} if T_high != 4 * T_low else {})


@kiln.mistake("This scaling has its lower end at 0 mA. At which current does the kiln have the lowest temperature?")
def _(T_low, T_high, R, V):
    return {"T": T_low + 50 * V / R * (T_high - T_low), "T_broken": T_low}


@kiln.mistake("The lower end of the temperature range is missing in the sum.")
def _(T_low, T_high, R, V):
    return {"T": (1000 * V / R - 4) * (T_high - T_low) / 16, "T_broken": -(T_high - T_low) / 4}


@kiln.mistake("A current is a voltage divided by a resistance. Look at Ohm's law, and at the units.")
def _(R, V):
    return {"I": V * R / 1000} if abs(V * R / 1000 - 1000 * V / R) > 0.02 * 1000 * V / R else {}


@kiln.mistake("A current is a voltage divided by a resistance. Look at Ohm's law, and at the units.")
def _(R, V):
    return {"I": V * R}


@kiln.mistake("That share is one of 20 mA. How wide is the range from 4 to 20 mA?")
def _(T_low, T_high, R, V):
    share, span = (1000 * V / R - 4) / 16, T_high - T_low
    wrong = T_low + share * span * 16 / 20
    return {"T": wrong} if _differs(wrong, T_low + share * span, share * span) else {}


@kiln.mistake(
    "There the share is counted from 0 mA, and yet it is one of 16 mA. Where does the range of the current begin?"
)
def _(T_low, T_high, R, V):
    wrong, share = T_low + 1000 * V / R * (T_high - T_low) / 16, (1000 * V / R - 4) / 16
    return {"T": wrong} if _differs(wrong, T_low + share * T_high) else {}


kiln.hints(
    "Two laws are needed: one for the resistor, and one that says that the temperature is linear in the current.",
    "$I = V/R$. The current is above its lower end by $I - 4$ of 16 mA, and the temperature is by the same share of "
    "its range above {T_low}.",
    "$I = \\frac{ {V} }{ {R} }$ in amperes, times 1000 in mA. A broken cable carries 0 mA, which is {below} of the "
    "range below its lower end.",
)


@kiln.shows
def _():
    return {"below": "a quarter"}


@kiln.solution
def _(T_low, T_high, R, V):
    r"""By Ohm's law the current is $\frac{ {V} }{ {R} }$ in amperes, which is {I}.

    The range of the current is 16 mA wide and begins at 4 mA. So the current has made the share $x = \frac{I - 4}{16}$
    of it, and the temperature has made the same share of its own range, from {T_low} to {T_high}.

    ***

    Here the share is {share}, and the temperature is ${T_low} + {share} \cdot ({T_high} - {T_low})$, which is {T}.

    A broken cable carries no current at all, 0 mA. The share is then $-4/16$: the controller would show
    ${T_low} - ({T_high} - {T_low})/4$, which is {T_broken}. It would take the kiln for a cold one and heat with all its
    power.
    """
    return {"share": (1000 * V / R - 4) / 16}


@kiln.solution_picture
def _(T_low, T_high, R, V):
    """The scaling from the current to the temperature, with the kiln and the broken cable."""
    slope, current = (T_high - T_low) / 16, 1000 * V / R
    I = np.linspace(0, 20, 81)
    curve = {"temperature [°C]": float(T_low) + (I - 4) * float(slope)}
    limits = (float(T_low - 8 * slope), float(T_high))
    plot = time_plot(curve, I, xlabel="current [mA]", ylim=limits)
    return plot.mark(current, "kiln").mark(0, "broken cable").mark(4, "lower end")


@exercise(
    "9.2",
    title="A silo on load cells",
    points=2,
    where=lambda inaccuracy, drift, warming: (
        drift >= 0.02 * inaccuracy and abs(drift * warming - inaccuracy) >= 0.02 * inaccuracy
    ),
    insight="More bits show smaller steps of the same wrong number: the inaccuracy stays.",
)
def silo(
    span=between(10, 60, "t", reference=40, step=5),
    bits=choice(8, 10, 12, 14, reference=10),
    inaccuracy=choice(0.02, 0.05, 0.1, 0.2, unit="%", reference=0.05),
    drift=choice(0.001, 0.002, 0.005, unit="%/°C", reference=0.002),
    warming=between(10, 30, "°C", reference=20, step=5),
    finest=between(2, 10, "kg", reference=5, step=1),
):
    """A silo stands on load cells with a range of 0 to {span}. The input of the controller turns their signal into a
    number of {bits} bits, and sees a change only if it is at least a step of this number. How many kilograms is a step?

    The data sheet states an inaccuracy of at most {inaccuracy} of full scale, and a drift of {drift} (of full scale).
    How many kilograms are these two together, at most, when it has become {warming} warmer? Which is larger, the
    resolution (the step) or the inaccuracy with its drift? And how many bits are needed at least for a step of {finest}
    or less?
    """
    step, error = _step(span, bits), _error(span, inaccuracy, drift, warming)
    return answers(
        step=number(step, "kg", "the step"),
        error=number(error, "kg", "the largest error by inaccuracy and drift"),
        larger=word("resolution" if step > error else "inaccuracy", ["resolution", "inaccuracy"], "the larger one"),
        bits=number(_bits(span, finest), what="the number of bits", within=0),
    )


def _step(span, bits):
    return 1000 * span / (2**bits - 1)


def _error(span, inaccuracy, drift, warming):
    return 10 * span * (inaccuracy + drift * warming)


def _bits(span, finest):
    return next(bits for bits in range(1, 40) if _step(span, bits) <= finest)


@silo.picture
def _(span, bits):
    """A silo on load cells of 0 to {span}; the input of the controller makes {bits} bits of their signal."""
    layout = """
        silo  cells  input  controller"""
    parts = {
        "silo": draw.silo(),
        "cells": f"Load cells\n$0$ to ${written(span)}$ t",
        "input": f"Input\n${written(bits)}$ bits",
        "controller": "Controller",
    }
    return draw.instrumentation_diagram(layout, "", "silo cells input controller", parts)


@silo.mistake("A number of bits is whole. Which whole number is enough?")
def _(span, finest):
    exact = math.log2(1000 * span / finest)
    return {"bits": round(exact, 3)} if abs(exact - round(exact)) > 0.1 else {}


@silo.mistake("That is the number of steps. How many bits does it take to count so far?")
def _(span, finest):
    return {"bits": 1000 * span / finest}


@silo.mistake("A number with that many bits has many more values. How many are there with two bits, with three bits?")
def _(span, bits):
    return {"step": 1000 * span / bits}


@silo.mistake("This is in percent of full scale. How many kilograms is full scale?")
def _(bits, inaccuracy, drift, warming):
    return {"step": 100 / (2**bits - 1), "error": inaccuracy + drift * warming}


@silo.mistake("By so much rounding may be wrong. A step is from one value to the next.")
def _(span, bits):
    return {"step": _step(span, bits) / 2}


@silo.mistake("The drift is missing. It grows with each degree.")
def _(span, inaccuracy):
    return {"error": 10 * span * inaccuracy}


@silo.mistake("The drift is stated for one degree. By how many degrees has the temperature risen?")
def _(span, inaccuracy, drift):
    return {"error": 10 * span * (inaccuracy + drift)}


@silo.mistake("This is the drift alone. Even without it the display may be wrong.")
def _(span, drift, warming):
    return {"error": 10 * span * drift * warming}


@silo.mistake("Compare your two results: which of them hides more kilograms?")
def _(span, bits, inaccuracy, drift, warming):
    step, error = _step(span, bits), _error(span, inaccuracy, drift, warming)
    return {"larger": "inaccuracy" if step > error else "resolution"}


@silo.mistake("With one bit less than needed, a step is still too large. Round upwards.")
def _(span, finest):
    return {"bits": _bits(span, finest) - 1}


@silo.mistake("That many values have one step fewer between them. Count the steps from the first value to the last.")
def _(span, finest):
    exact = math.log2(float(1000 * span / finest))
    return {"bits": math.ceil(exact) + 1} if math.ceil(exact) == _bits(span, finest) else {}


silo.hints(
    "A number of $n$ bits has $2^n$ values. How many steps are between the first and the last of them?",
    "A step is the full scale divided by $2^n - 1$. The error is a share of full scale: the inaccuracy, plus the drift "
    "times the degrees.",
    "Step: $\\frac{1000 \\cdot {span} }{2^{{n}} - 1}$ in kg, with $n$ = {bits}. Error, in percent of full scale: "
    "${inaccuracy} + {drift} \\cdot {warming}$.",
)


@silo.solution
def _(span, bits, finest, inaccuracy, drift, warming):
    r"""A number of {bits} bits has {values} values, and one step fewer between them. So a step is
    $\frac{1000 \cdot {span} }{ {steps} }$ in kg, which is {step}.

    The errors add up, in percent of full scale: ${inaccuracy} + {drift} \cdot {warming} = {percent}$. Of {span} these
    are {error}. So the {larger} is the larger one.

    A step of {finest} or less needs at least $\frac{1000 \cdot {span} }{ {finest} }$, which is {needed} steps. The
    powers of two around it: $2^{ {one_less} } - 1 = {fewer}$ is not enough, $2^{ {bits_needed} } - 1 = {enough}$ is. So
    {bits_needed} bits are needed.
    """
    n = _bits(span, finest)
    return {
        "values": 2**bits, "steps": 2**bits - 1, "percent": inaccuracy + drift * warming, "bits_needed": n,
        "needed": 1000 * span / finest, "one_less": n - 1, "fewer": 2 ** (n - 1) - 1, "enough": 2**n - 1,
    }  # fmt: skip


@exercise(
    "9.3",
    title="The far end of a dam",
    points=3,
    where=lambda R_load, inputs, R_in: R_load - inputs * R_in >= 100 and R_load != 2 * inputs * R_in,
    insight="The same current flows everywhere in its loop; a voltage is shared out along the way.",
)
def dam(
    R_load=between(400, 800, "Ω", reference=650, step=50),
    inputs=choice(1, 2, reference=2),
    R_in=choice(100, 250, unit="Ω", reference=250),
    wire=choice(12, 18, 24, 36, unit="Ω/km", reference=18),
    length=between(0.5, 4, "km", reference=2, step=0.5),
    R_voltage=choice(2, 5, 10, 20, 100, unit="kΩ", reference=10),
):
    """A controller sets a gate at the far end of a dam with a current of 4 to 20 mA. Its output can drive a load of at
    most {R_load} in all. In the loop are {receivers} an input of {R_in}, and the cable, each of whose two wires has
    {wire}.

    Which voltage must the output supply at 20 mA, if its load is the largest one allowed? How far away may the gate be?
    A colleague would rather send a voltage to an input of {R_voltage}. Which share of it, in percent, is lost on
    {length} of the same cable?
    """
    R_cable = 2 * wire * length
    return answers(
        V=number(R_load / 50, "V", "the voltage of the output"),
        distance=number((R_load - inputs * R_in) / (2 * wire), "km", "the distance"),
        lost=number(100 * R_cable / (R_cable + 1000 * R_voltage), "%", "the lost share of the voltage"),
    )


@dam.shows
def _(inputs):
    one, two = "the positioner of the gate with", "the positioner of the gate and a display, each with"
    return {"receivers": one if inputs == 1 else two}


@dam.picture
def _(R_load, inputs, R_in, wire):
    """The loop: an output of at most {R_load}, a wire of {wire}, {receivers} an input of {R_in}, and a wire back."""
    output = f"$4$ to $20$ mA\nup to ${written(R_load)}$ Ω"
    return draw.current_loop([f"${written(R_in)}$ Ω"] * int(inputs), f"${written(wire)}$ Ω/km", output)


@dam.mistake("The display is in the loop as well. Which resistance do both inputs have together?")
def _(R_load, inputs, R_in, wire):
    return {"distance": (R_load - R_in) / (2 * wire)} if inputs == 2 and R_load != 3 * R_in else {}


@dam.mistake("A cable has two wires: the current goes there and comes back.")
def _(R_load, inputs, R_in, wire, length, R_voltage):
    R_cable = wire * length
    lost = 100 * R_cable / (R_cable + 1000 * R_voltage)
    return {"distance": (R_load - inputs * R_in) / wire, "lost": lost}


@dam.mistake("The cable is not alone in the loop: what else is part of the load?")
def _(R_load, wire):
    return {"distance": R_load / (2 * wire)}


@dam.mistake("This is the voltage at the lowest current. Where is the highest one needed?")
def _(R_load):
    return {"V": 4 * R_load / 1000}


@dam.mistake("The cable and the input share the voltage. What share of the total resistance does the cable have?")
def _(wire, length, R_voltage):
    R_cable = 2 * wire * length
    return {"lost": 100 - 100 * R_cable / (R_cable + 1000 * R_voltage)}


@dam.mistake("That would drive the inputs alone. What else may the current have to flow through?")
def _(R_load, inputs, R_in):
    wrong = inputs * R_in / 50
    return {"V": wrong} if _differs(wrong, 4 * R_load / 1000) else {}


@dam.mistake("That is the cable compared with the input. What part is it of the two together?")
def _(wire, length, R_voltage):
    R_cable, R_input = 2 * wire * length, 1000 * R_voltage
    return {"lost": 100 * R_cable / R_input} if R_cable > R_input / 60 else {}


dam.hints(
    "What do all parts of a current loop have in common? And how do two resistances in series share a voltage?",
    "The largest load is the inputs and both wires: {R_load} in all. The voltage is this load times the largest "
    "current. A cable with the resistance $R_c$ takes the share $\\frac{R_c}{R_c + R_{in} }$ of a voltage.",
    "{R_load} at 0.02 A. For the cable are left ${R_load} - {inputs} \\cdot {R_in}$ in Ω, and each kilometre takes "
    "$2 \\cdot {wire}$.",
)


@dam.solution
def _(R_load, inputs, R_in, wire, length, R_voltage):
    r"""The same current flows through everything. At 20 mA the largest load needs ${R_load} \cdot 0.02$, which is {V}.

    The inputs take ${inputs} \cdot {R_in}$ in Ω, and {left} are left for the cable. It has two wires, there and back,
    $2 \cdot {wire}$ in Ω/km. So the gate may be {distance} away.

    A voltage divides between the cable, $2 \cdot {wire} \cdot {length}$, which is {cable}, and the input. The cable
    takes $100 \cdot \frac{ {cable} }{ {cable} + 1000 \cdot {R_voltage} }$ percent, which is {lost}.
    """
    return {"left": (R_load - inputs * R_in, "Ω"), "cable": (2 * wire * length, "Ω")}


@dam.solution_picture
def _(wire, length, R_voltage):
    """The lost share of the voltage for cables up to twice as long."""
    km = np.linspace(0, 2 * float(length), 101)
    cable = 2 * float(wire) * km
    curve = {"lost voltage [%]": 100 * cable / (cable + 1000 * float(R_voltage))}
    return time_plot(curve, km, xlabel="length [km]", low=True).mark(length, "this cable")


@exercise(
    "9.4",
    title="Pulses for a pump",
    points=3,
    where=lambda A, q, ripple: 4 * ripple * A >= 15 * q,
    insight="The ripple grows with the cycle, and is largest where the pump runs for half of the time.",
)
def pump_sump(
    A=between(1, 8, "m²", reference=3, step=0.5),
    q=between(4, 30, "L/s", reference=12, step=1),
    D=choice(0.2, 0.25, 0.3, 0.7, 0.75, 0.8, reference=0.7),
    ripple=between(5, 40, "mm", reference=20, step=5),
):
    """A pump can only run or stand still. While it runs, it delivers $q$ [L/s] into a tank with the area $A$ [m²]. It
    is switched by pulse-width modulation: in each cycle of $P$ [s] it runs for the share $D$ (between 0 and 1). The
    outflow is constant, and such that the level is the same after each cycle.

    How far does the level move up and down, from the lowest to the highest point? Give the ripple in mm as a formula in
    $q$, $A$, $D$ and $P$. (A litre on a square metre is a millimetre.) With $q$ = {q}, $A$ = {A} and $D$ = {D}, which
    is the longest cycle for a ripple of {ripple}? And which cycle keeps the ripple within {ripple} with any $D$?
    """
    return answers(
        ripple=expression(_sump_ripple(), "the ripple as a formula"),
        P=number(ripple * A / (q * D * (1 - D)), "s", "the longest cycle for this duty cycle"),
        P_any=number(4 * ripple * A / q, "s", "the longest cycle for any duty cycle"),
    )


def _sump_ripple():
    q, A, D, P = symbols("q A D P")
    return q * D * (1 - D) * P / A


@pump_sump.mistake("While the pump runs, the outflow goes on. By how much does the level rise in each second?")
def _(A, q, D, ripple):
    formula = _sump_ripple() / (1 - Symbol("D"))
    return {"ripple": formula, "P": ripple * A / (q * D), "P_any": ripple * A / q}


@pump_sump.mistake("Here numbers have been put in. Give the formula with the symbols first.")
def _(A, q, D):
    return {"ripple": q * D * (1 - D) / A * Symbol("P")}


@pump_sump.mistake("At this rate the level falls or rises only for a part of the cycle. For how long?")
def _(A, q, D, ripple):
    return {"ripple": _sump_ripple() / Symbol("D"), "P": ripple * A / (q * (1 - D))}


@pump_sump.mistake(
    "This is how far the level moves from the middle. How far is it from the lowest to the highest point?"
)
def _(A, q, D, ripple):
    return {"ripple": _sump_ripple() / 2, "P": 2 * ripple * A / (q * D * (1 - D)), "P_any": 8 * ripple * A / q}


pump_sump.hints(
    "In a whole cycle as much flows out as in. How large is the constant outflow, then?",
    "The outflow is $D q$. While the pump runs, the level rises by $\\frac{q - D q}{{A}}$ in each second, and it runs "
    "for $D P$.",
    "With the numbers, the ripple is $\\frac{ {q} \\cdot {D} \\cdot (1 - {D})\\,P}{ {A} }$ in mm. For any $D$, ask "
    "where $D(1 - D)$ is largest.",
)


@pump_sump.solution
def _():
    r"""The pump delivers $q D P$ in each cycle, and so much must flow out in it: the outflow is $D q$ all the time.

    While the pump runs, $q - D q$ more flows in than out, and the level rises by $\frac{q (1 - D)}{{A}}$ in each
    second. It does so for $D P$, so that the ripple is {ripple_formula}. (While the pump stands still, the level falls
    by $\frac{D q}{{A}} (1 - D) P$, which is the same.)

    Solved for the cycle, with the numbers: $P = \frac{ {ripple} \cdot {A} }{ {q} \cdot {D} \cdot (1 - {D})}$, which is
    {P}.

    $D(1 - D)$ is largest at half of the time, where it is 1/4. So with $P = \frac{4 \cdot {ripple} \cdot {A} }{ {q} }$,
    which is {P_any}, the ripple is small enough whatever $D$ is.
    """
    return {"ripple_formula": r"$\frac{q\,D\,(1 - D)\,P}{A}$"}


@pump_sump.picture
def _(q, D):
    """The flow of the pump in three cycles: it runs for the share D of each."""
    cycles = np.linspace(0, 3, 601)[:-1]
    flow = np.where(cycles % 1 < float(D), float(q), 0.0)
    return time_plot({"pump [L/s]": (flow, "control signal")}, cycles, xlabel="time in cycles, $t/P$", low=True)


@pump_sump.solution_picture
def _(A, q, D, ripple):
    """Three of the longest cycles: the level, and the pump."""
    P = float(ripple * A / (q * D * (1 - D)))
    times = np.linspace(0, 3 * P, 601)[:-1]
    share = (times / P) % 1
    runs = share < float(D)
    level = float(ripple) * np.where(runs, share / float(D), (1 - share) / (1 - float(D)))
    panels = [{"level [mm]": (level, "measurement")}, {"pump": (runs.astype(float), "control signal")}]
    return time_plot(panels, times, low=True)


def _distinct(T, D, P):
    """Whether the ripple of the first cycle and the formula for short cycles can be told apart."""
    first, short = 1 - math.exp(-D * P / T), float(D * (1 - D) * P / T)
    return abs(first - short) > 0.03 * first


@exercise(
    "9.5",
    title="An oven that switches slowly",
    points=4,
    where=lambda T, D, P: 1.2 <= float(P / T) <= 3 and _distinct(T, D, P),
    insight="A long cycle leaves the mean as it is: what it costs is the ripple.",
)
def oven(
    full=between(200, 800, "K", reference=400, step=50),
    T=between(10, 40, "min", reference=20, step=2),
    D=choice(0.25, 0.4, 0.5, 0.6, 0.75, reference=0.4),
    P=between(15, 60, "min", reference=30, step=5),
):
    """An electric oven responds to its power like a lag with a time constant of {T}; full power would heat it by {full}
    above the room. To spare the contacts, its relay switches slowly: the cycle period is {P}. The duty cycle is {duty}.
    The oven begins at room temperature, with the relay on.

    Let $y$ [K] be the temperature above the room and $t$ the time in minutes. Find $y(t)$ in the first cycle, for the
    on-state and the off-state (a `Piecewise` of SymPy, or a function of $t$). What is the mean of $y$ in the end? And
    how large is its ripple in the end, from the lowest to the highest value?
    """
    a, b = exp(-D * P / T), exp(-(1 - D) * P / T)
    return answers(
        y=time_function(_first_cycle(full, T, D * P), until=P, unit="K", what="the temperature above the room"),
        mean=number(full * D, "K", "the mean in the end"),
        ripple=number(full * (1 - a) * (1 - b) / (1 - a * b), "K", "the ripple in the end"),
    )


@oven.shows
def _(D, P):
    return {"duty": f"{100 * float(D):g} %", "on": (D * P, "min")}


def _first_cycle(full, T, on):
    highest = full * (1 - exp(-on / T))
    return Piecewise((full * (1 - exp(-t / T)), t < on), (highest * exp(-(t - on) / T), True))


@oven.mistake("The relay is off, and the oven is still hot. How does a lag lose its heat?")
def _(full, T, D, P):
    return {"y": Piecewise((full * (1 - exp(-t / T)), t < D * P), (0, True))}


@oven.mistake("While the relay is on, all of the power is there. Towards which temperature does the oven go, then?")
def _(full, T, D, P):
    return {"y": D * _first_cycle(full, T, D * P)}


@oven.mistake("That is the share of the time in which the relay is off.")
def _(full, D):
    return {"mean": full * (1 - D)} if abs(2 * D - 1) > 0.05 else {}


@oven.mistake("This is right as long as the relay is on. And when it is off?")
def _(full, T):
    return {"y": full * (1 - exp(-t / T))}


@oven.mistake("When the relay opens, the oven is not at its final temperature yet. From where does it begin to cool?")
def _(full, T, D, P):
    on = D * P
    return {"y": Piecewise((full * (1 - exp(-t / T)), t < on), (full * exp(-(t - on) / T), True))}


@oven.mistake("In the off-state this cools as if the relay had opened at the very beginning. When did it open?")
def _(full, T, D, P):
    on = D * P
    cooling = full * (1 - exp(-on / T)) * exp(-t / T)
    return {"y": Piecewise((full * (1 - exp(-t / T)), t < on), (cooling, True))}


@oven.mistake("This is the response to the mean of the power. The relay lets full power through, or nothing.")
def _(full, T, D):
    return {"y": full * D * (1 - exp(-t / T))}


@oven.mistake("The oven would be that hot with the relay always on. What part of the power does it get on average?")
def _(full):
    return {"mean": full}


@oven.mistake(
    "That is the middle between the highest and the lowest value. Is the oven above it for as long as below it?"
)
def _(full, T, D, P):
    a, b = (math.exp(-share * P / T) for share in (D, 1 - D))
    middle = (1 - a) * (1 + b) / (1 - a * b) / 2
    return {"mean": full * middle} if _differs(middle, D, by=0.013) else {}


@oven.mistake("That formula holds for cycles that are short compared with the time constant. This one is not.")
def _(full, T, D, P):
    return {"ripple": full * D * (1 - D) * P / T}


@oven.mistake("That is the highest value in the end. How low does the oven become in between?")
def _(full, T, D, P):
    a, b, short = exp(-D * P / T), exp(-(1 - D) * P / T), D * (1 - D) * P / T
    highest = (1 - a) / (1 - a * b)
    return {"ripple": full * highest} if b > 0.05 and abs(highest - short) > 0.03 * short else {}


@oven.mistake("By that much the oven cools in the first cycle. Does it begin to cool as hot in the end?")
def _(full, T, D, P):
    a, b = (float(exp(-share * P / T)) for share in (D, 1 - D))
    short, ripple = float(D * (1 - D) * P / T), (1 - a) * (1 - b) / (1 - a * b)
    fall = (1 - a) * (1 - b)
    return {"ripple": full * fall} if all(abs(fall / other - 1) > 0.03 for other in (short, ripple)) else {}


@oven.mistake("This is the ripple of the first cycle, which begins at room temperature. In the end no cycle does.")
def _(full, T, D, P):
    return {"ripple": full * (1 - exp(-D * P / T))}


@oven.mistake("That is the lowest value in the end. How far above it is the highest one?")
def _(full, T, D, P):
    a, b = (math.exp(-share * P / T) for share in (D, 1 - D))
    highest, first, short = (1 - a) / (1 - a * b), 1 - a, float(D * (1 - D) * P / T)
    lowest = b * highest
    is_another = _differs(lowest, highest - lowest, first, first * (1 - b), short)
    return {"ripple": full * lowest} if is_another else {}


oven.hints(
    "Each part of a cycle is the step response of a lag, from where it begins towards where it would end. Where is "
    "that in the on-state, and where in the off-state?",
    "On: $y = {full}\\,(1 - e^{-t/T})$, up to the moment $t_1 = D P$. Off: from there with $e^{-(t - t_1)/T}$ towards "
    "zero. In the end each cycle begins where it ends, which is one equation for the lowest value.",
    "The relay opens after $t_1$ = {on}. With $a = e^{-t_1/T}$ and $b = e^{-(P - t_1)/T}$: $y_{max} = {full} - "
    "({full} - y_{min})\\,a$ and $y_{min} = b\\,y_{max}$.",
)


@oven.solution
def _(full, T, D, P):
    r"""**The first cycle.** As long as the relay is on, $y = {full}\,(1 - e^{-t/{T} })$. It opens at $t_1 = D P$ =
    {on}, where the oven has come up to {top}. From there it cools towards the room: $y = {high}\,e^{-(t - {on})/{T} }$.

    **The mean.** In the end the oven loses as much heat as it gets, and on average it gets {duty} of full power: the
    mean is {mean}.

    **The ripple.** In the end each cycle is like the one before, from $y_{min}$ up to $y_{max}$ and back. With
    $a = e^{-{on}/{T} } = {a}$ and $b = e^{-({P} - {on})/{T} } = {b}$ they obey
    $y_{max} = {full} - ({full} - y_{min})\,a$ and $y_{min} = b\,y_{max}$. So
    $y_{max} = {full} \cdot \frac{1 - a}{1 - ab}$, which is {highest}, and $y_{min}$ is {lowest}. The ripple is their
    difference, {ripple}.
    """
    a, b = math.exp(-D * P / T), math.exp(-(1 - D) * P / T)
    top, highest = float(full) * (1 - a), float(full) * (1 - a) / (1 - a * b)
    return {
        "top": (top, "K"), "high": top, "a": a, "b": b, "highest": (highest, "K"), "lowest": (b * highest, "K")
    }  # fmt: skip


@oven.picture
def _(D, P):
    """The power that the relay lets through in the first three cycles."""
    times = np.linspace(0, 3 * float(P), 601)[:-1]
    power = np.where(times % float(P) < float(D * P), 100.0, 0.0)
    return time_plot({"power [%]": (power, "control signal")}, times, xlabel="$t$ [min]", low=True)


@oven.solution_picture
def _(full, T, D, P):
    """The first cycles, from room temperature to where each cycle is like the one before."""
    on, full, T, P = (float(x) for x in (D * P, full, T, P))
    times, y, now = np.linspace(0, 5 * P, 1001), [], 0.0
    step = times[1]
    for time in times:
        y.append(now)
        end = full if time % P < on else 0.0
        now = end + (now - end) * math.exp(-step / T)
    plot = time_plot({"temperature above the room [K]": (y, "measurement")}, times, xlabel="$t$ [min]")
    return plot.level(full * float(D), "mean in the end")


@exercise(
    "9.6",
    title="How often must the program run?",
    points=4,
    where=lambda K, T, tau, K_p, h: 0.5 * tau <= _margin(K, T, tau, K_p) <= min(4 * tau, 15 * h) and h <= tau,
    insight="A program that runs every $h$ seconds acts like half a step of dead time; the delay margin pays for it.",
)
def program(
    K=between(0.5, 3, reference=1.5, step=0.1),
    T=between(2, 30, "s", reference=10, step=1),
    tau=between(0.5, 4, "s", reference=2, step=0.5),
    K_p=between(0.5, 6, reference=2, step=0.1),
    h=between(0.2, 2, "s", reference=0.4, step=0.2),
):
    """A steam pressure responds to its valve with a gain of $K$ = {K} (percent for percent), a time constant of
    $T$ = {T} and a dead time of $\\tau$ = {tau}. The PI controller has the gain $K_p$ = {K_p}, and its integral time is
    equal to $T$. So the open loop is an integrator with dead time.

    Find the delay margin of the loop with a controller that runs all the time. A digital controller runs once in a
    time step. Above which time step is the loop unstable, by the estimate with half a step of dead time? How much of
    the delay margin is left with a time step of {h}?
    """
    margin = _margin(K, T, tau, K_p)
    return answers(
        margin=number(margin, "s", "the delay margin"),
        h_limit=number(2 * margin, "s", "the time step at the limit of stability"),
        left=number(margin - h / 2, "s", "the delay margin that is left"),
    )


def _margin(K, T, tau, K_p):
    return math.pi / 2 * float(T / (K * K_p)) - float(tau)


@program.picture
def _(K, T, tau, K_p):
    """The loop: a PI controller with the gain {K_p} and the integral time {T}, and a process with the gain {K}, the
    time constant {T} and the dead time {tau}."""
    controller = draw.block(rf"{written(K_p)}\left(1+\frac{{1}}{{{written(T)}\,s}}\right)")
    process = draw.block(rf"\frac{{{written(K)}\,e^{{-{written(tau)}s}}}}{{{written(T)}\,s+1}}")
    return draw.block_diagram("y_SP", draw.feedback_loop(["e", controller, "u", process]), "y")


@program.mistake("Here the margin is the whole dead time at the limit. But some of it is there already.")
def _(K, T, tau, K_p, h):
    whole = pi * T / (2 * K * K_p)
    return {"margin": whole, "h_limit": 2 * whole, "left": whole - h / 2}


@program.mistake("This is the time in which the phase turns by one radian. The integrator leaves a quarter of a turn.")
def _(K, T, tau, K_p):
    return {"margin": T / (K * K_p) - tau}


@program.mistake(
    "The gain of the loop is that of the controller times that of the process. Are both in your crossover?"
)
def _(K, T, tau, K_p):
    alone, right = pi * T / (2 * K_p) - tau, _margin(K, T, tau, K_p)
    others = [right, float(pi * T / (K * K_p) - tau), float(T / (K * K_p) - tau)]
    apart = all(abs(float(alone) - other) > 0.03 * abs(other) for other in others)
    return {"margin": alone} if alone > 0 and apart else {}


@program.mistake("Here the phase is turned by half a turn. The integrator accounts for a part of that.")
def _(K, T, tau, K_p):
    return {"margin": pi * T / (K * K_p) - tau} if K != 2 and K_p != 2 else {}


@program.mistake(
    "How far does the integrator turn the phase by itself? And are both gains in your crossover frequency?"
)
def _(K, T, tau, K_p):
    return {"margin": pi * T / (K * K_p) - tau} if K == 2 or K_p == 2 else {}


@program.mistake("A phase in degrees over a frequency in rad/s is no time. What is a quarter of a turn in radians?")
def _(K, T, tau, K_p):
    return {"margin": 90 * T / (K * K_p) - tau}


@program.mistake("The crossover frequency is upside down: does more gain make a loop slower or quicker?")
def _(K, T, tau, K_p):
    wrong, right = pi / 2 * T * K * K_p - tau, _margin(K, T, tau, K_p)
    others = right, right + float(tau), 2 * right + float(tau), float(T / (K * K_p) - tau), _margin(1, T, tau, K_p)
    is_another = wrong > 0 and _differs(float(wrong), *others, float(90 * T / (K * K_p) - tau))
    return {"margin": wrong} if is_another else {}


@program.mistake("Half of the step may be as long as the margin. How long may the whole step be?")
def _(K, T, tau, K_p):
    return {"h_limit": _margin(K, T, tau, K_p) / 2}


@program.mistake("The controller's output is constant for a whole step. How old is it on average?")
def _(K, T, tau, K_p, h):
    margin = _margin(K, T, tau, K_p)
    left = margin - float(h)
    return {"h_limit": margin, "left": left if abs(left) > 0.02 else 0}


program.hints(
    "At the delay margin the phase at the crossover frequency is half a turn. Where is that frequency in an integrator "
    "with dead time, and how much phase does each of the two take?",
    "The open loop is $\\frac{K K_p}{Ts}\\,e^{-\\tau s}$. Its gain is one at $\\omega_c = \\frac{K K_p}{{T}}$. The "
    "integrator takes a quarter of a turn, so that the dead time may take another quarter: $\\omega_c\\,(\\tau + "
    "\\Delta\\tau) = \\pi/2$.",
    "$\\omega_c = \\frac{ {K} \\cdot {K_p} }{ {T} }$ in rad/s. A signal that is held for a step is half a step old on "
    "average.",
)


@program.solution
def _(K, T, tau, K_p, h):
    r"""With $T_i = T$ the controller cancels the time constant, and the open loop is $\frac{K K_p}{Ts}\,e^{-\tau s}$.
    Its gain is one at $\omega_c = \frac{ {K} \cdot {K_p} }{ {T} }$, which is {crossover}.

    The integrator turns the phase by a quarter of a turn. At the limit the dead time turns it by another quarter,
    $\omega_c (\tau + \Delta\tau) = \pi/2$. So the dead time may be {whole} in all, of which {tau} are there already:
    the delay margin is {margin}.

    The output of the program is held for a step $h$; on average it is half a step old, as if the dead time were longer
    by $h/2$. The limit is a step of twice the margin, {h_limit}. With a step of {h}, half of it is spent, and {left}
    are left.
    """
    crossover = K * K_p / T
    return {"crossover": (crossover, "rad/s"), "whole": (math.pi / 2 / float(crossover), "s")}


@program.solution_picture
def _(K, T, tau, K_p, h):
    """The response to a setpoint step with a program that runs all the time, and with half a step more dead time."""
    from loopbook.deadtime import Loop
    from loopbook.expressions import s

    times, steps = np.linspace(0, 15 * float(tau), 301), {"all the time": 0, f"every {float(h):g} s": h}
    loops = {name: Loop(K * K_p * exp(-(tau + step / 2) * s) / (T * s), 1) for name, step in steps.items()}
    curves = {name: loop.servo.step(times) for name, loop in loops.items()}
    return time_plot({"setpoint": (1, "setpoint")} | curves, times, ylabel="pressure [%]", low=True)


@exercise(
    "9.7",
    title="A cycle for the heating relay",
    points=5,
    where=lambda T, ripple, cycle, fineness, life, years: (
        1.5 <= _longest(T, ripple) / _shortest(cycle, fineness, life, years) <= 6
    ),
    insight="One period has three masters: the process wants it short, the resolution and the relay want it long.",
)
def relay(
    T=between(10, 60, "min", reference=20, step=5),
    ripple=choice(0.5, 1, 1.5, 2, unit="%", reference=1),
    cycle=choice(10, 20, 50, unit="ms", reference=20),
    fineness=choice(0.1, 0.2, 0.5, unit="%", reference=0.2),
    life=choice(2, 5, 10, reference=10),
    years=between(3, 10, reference=6, step=1),
):
    """A PLC heats a greenhouse by way of a relay, with pulse-width modulation. The greenhouse is a lag with a time
    constant of {T}. The PLC can switch an output only once in its own cycle of {cycle}, and the relay lasts for {life}
    million switching cycles (on and off again). Choose the period $P$ of the modulation in seconds such that

    - the ripple in the temperature, from the lowest to the highest point, is at most {ripple} of the full range with
      any duty cycle,
    - the pulse width can be set in steps of {fineness} of the period, or finer,
    - the relay lasts for {years} years, day and night.

    Any period that meets the three demands is right.
    """
    longest, shortest = _longest(T, ripple), _shortest(cycle, fineness, life, years)
    return answers(
        P=design(
            number(round(math.sqrt(longest * shortest), 2), "s", "the period"),
            criterion("the period is positive", lambda P: P > 0),
            criterion("the ripple", lambda P: _ripple(T, P), below=float(ripple), unit="%"),
            criterion("the step of the pulse width", lambda P: _fine(cycle, P), below=float(fineness), unit="%"),
            criterion("the life of the relay", lambda P: _life(life, P), above=float(years), unit="years"),
            draws=lambda P: _at_half_power(T, ripple, P),
        )
    )


YEAR = 365.25 * 24 * 3600


def _ripple(T, P):
    """The ripple of a lag at half power, where it is largest, in percent: P in s, T in min."""
    return 100 * math.tanh(P / (4 * 60 * float(T)))


def _fine(cycle, P):
    return float(cycle) / 10 / P if P > 0 else math.inf


def _life(life, P):
    return float(life) * 1e6 * max(P, 0) / YEAR


def _longest(T, ripple):
    return 240 * float(T) * math.atanh(float(ripple) / 100)


def _shortest(cycle, fineness, life, years):
    return max(float(cycle) / 10 / float(fineness), float(years) * YEAR / (float(life) * 1e6))


def _at_half_power(T, ripple, P):
    """Four cycles at half power, where the ripple is largest, between the limits of it."""
    lag, P = 60 * float(T), max(float(P), 1e-3)
    times = np.linspace(0, 4 * P, 801)
    a, since = math.exp(-P / (2 * lag)), times % P
    low, high = 100 * a / (1 + a), 100 / (1 + a)
    on = since < P / 2
    y = np.where(on, 100 - (100 - low) * np.exp(-since / lag), high * np.exp(-(since - P / 2) / lag))
    edge = float(ripple) / 2
    curve = {"temperature [% of its range]": (y, "measurement")}
    plot = time_plot(curve, times, ylim=(50 - 3 * edge, 50 + 3 * edge))
    return plot.level(50 + edge, "highest allowed").level(50 - edge, "lowest allowed")


@relay.picture
def _(T, cycle, life):
    """From the duty cycle to the temperature: a PLC with a cycle of {cycle}, a relay for {life} million switching
    cycles, and a greenhouse with the time constant {T}."""
    plc = draw.block(f"PLC, a cycle\nof ${written(cycle)}$ ms")
    contacts = draw.block(f"Relay, ${written(life)}$\nmillion cycles")
    greenhouse = draw.block(f"Greenhouse\n$T = {written(T)}$ min")
    return draw.block_diagram("D", plc, "pulses", contacts, "heat", greenhouse, r"$\vartheta$")


@relay.mistake(
    "With this period the steps of the pulse width are fine enough. But how often does the relay switch in a year?"
)
def _(cycle, fineness, life, years):
    P = float(cycle) / 10 / float(fineness)
    return {"P": P} if 0.98 * _shortest(cycle, fineness, life, years) > P else {}


@relay.mistake("The ripple grows with the period. Compare it with the time constant.")
def _(T, ripple):
    return {"P": 60 * float(T)}


@relay.mistake("That is short enough for a duty cycle of 10 %. At which duty cycle is the ripple largest?")
def _(T, ripple):
    return {"P": 60 * float(T) * float(ripple) / 100 / 0.09}


@relay.mistake("On and off again are one switching cycle, not two. How many periods does the relay last for?")
def _(cycle, fineness, life, years):
    P = float(years) * YEAR / (2e6 * float(life))
    return {"P": P} if 0.98 * _shortest(cycle, fineness, life, years) > P else {}


relay.hints(
    "Each of the three demands limits the period on one side. Which ones want it short, and which ones long?",
    "At half power, where it is largest, the ripple is $\\frac{{P}}{4T}$ of the full range. A step of the pulse width "
    "is one cycle of the PLC. And the relay makes one switching cycle in each period.",
    "The ripple: $P$ is at most $4 \\cdot {ripple}/100$ times the time constant of {T}. The steps: $P$ is at least "
    "{cycle} divided by ${fineness}/100$. The relay: count the seconds of {years} years.",
)


@relay.solution
def _(T, ripple, cycle, fineness, life, years):
    r"""**The ripple** is largest at half power, and there it is $\frac{{P}}{4T}$ of the full range as long as the
    period is short. With the time constant of {T} the period may be up to $4 \cdot {ripple}/100 \cdot 60 \cdot {T}$ in
    seconds, which is {longest}.

    **The steps** of the pulse width are one cycle of the PLC, {cycle}. They are {fineness} of a period of {fine}, or
    less of a longer one.

    **The relay** makes one switching cycle in each period. In {years} years there are {seconds}, and with {life}
    million cycles a period must last at least {wear}.

    So any period from {shortest} to {longest} will do, for example their geometric mean, {P}.
    """
    seconds = float(years) * YEAR
    return {
        "longest": (_longest(T, ripple), "s"), "shortest": (_shortest(cycle, fineness, life, years), "s"),
        "fine": (float(cycle) / 10 / float(fineness), "s"), "wear": (seconds / (float(life) * 1e6), "s"),
        "seconds": (seconds, "s"),
    }  # fmt: skip


@exercise(
    "9.8",
    title="A valve as it is in the plant",
    points=3,
    where=lambda kind, authority: (authority < 0.3) == (kind == "linear"),
    insight="What counts is the valve in its pipe: its slope is a factor of the loop gain, and the loop must be tuned "
    "where it is steepest.",
)
def stroked_valve(
    kind=choice("linear", "equal percentage"),
    authority=choice(0.1, 0.15, 0.2, 0.5, 0.7, 0.9, reference=0.1),
    low=between(30, 40, "%", step=5, reference=35),
    high=between(65, 75, "%", step=5, reference=70),
    middle=between(44, 60, "%", step=2, reference=52),
):
    r"""A control valve has been moved through its range, in its pipe, with its pump. The picture shows the flow, in
    percent of the flow with the valve fully open, against the opening. In summer the valve works at point A, in winter
    at B.

    Read off the picture: the opening for a flow of {flow}; and the gain of the valve at A and at B, in percent of flow
    for one percent of opening (lay a ruler along the curve). All the rest of the loop is the same in summer and in
    winter: at which of the two points must its controller be tuned, if it should be stable at both?
    """
    at_A, at_B = (installed(kind, authority, x)[1] for x in (low, high))
    return answers(
        opening=number(_opening(kind, authority, middle), "%", "the opening for that flow", within=0.05),
        gain_A=number(at_A, "%/%", "the gain of the valve at A", within=0.15),
        gain_B=number(at_B, "%/%", "the gain of the valve at B", within=0.15),
        tune=word("A" if at_A > at_B else "B", ["A", "B"], "the point for the tuning"),
    )


def installed(kind, authority, opening):
    """The flow in percent and its slope, for an opening in percent, of a valve in series with a pipe."""
    x, authority = np.asarray(opening, float) / 100, float(authority)
    inherent, slope = (x, np.ones_like(x)) if kind == "linear" else (50 ** (x - 1), math.log(50) * 50 ** (x - 1))
    flow = inherent / np.sqrt(authority + (1 - authority) * inherent**2)
    return 100 * flow, slope * authority / (authority + (1 - authority) * inherent**2) ** 1.5


def _flow(kind, authority, opening):
    """A flow as a picture can tell it, in whole percent."""
    return round(float(installed(kind, authority, opening)[0]))


def _opening(kind, authority, middle):
    openings = np.linspace(0, 100, 10001)
    return float(np.interp(_flow(kind, authority, middle), installed(kind, authority, openings)[0], openings))


@stroked_valve.shows
def _(kind, authority, middle):
    return {"flow": (_flow(kind, authority, middle), "%")}


def _apart(right, wrong):
    """Those of the wrong values that a ruler tells from the right ones."""
    return {name: x for name, x in wrong.items() if not 0.75 < x / right[name] < 1.3}


def _gains(kind, authority, low, high):
    return {"gain_A": installed(kind, authority, low)[1], "gain_B": installed(kind, authority, high)[1]}


def _not_the_slope(kind, authority, low, high):
    """For the gain at each point what is taken for it: flow over opening, the gain at the other point, and so on."""
    right, flows = _gains(kind, authority, low, high), [float(installed(kind, authority, x)[0]) for x in (low, high)]
    line, openings = (flows[1] - flows[0]) / float(high - low), (float(low), float(high))
    return {
        name: {"origin": flow / opening, "other": right[other], "line": line, "inverse": 1 / right[name]}
        for name, other, flow, opening in zip(right, reversed(right), flows, openings, strict=True)
    }


_ALONE = {
    "inverse": "Percent of flow for one percent of opening: which of the two is divided by the other?",
    "other": "At which of the two points is the curve that steep?",
    "origin": "That is flow over opening, a line from the origin. The gain is how steep the curve is at the point.",
    "line": "That is the slope of the line from A to B. At each of them the curve has its own.",
}
#: Where a ruler does not tell two of them apart.
_TOGETHER = (
    "Lay the ruler along the curve at this very point. What is its slope, in percent of flow for one of opening?"
)


def _taken_for(why, alone):
    """A mistake: this for the gain, where a ruler tells it from the gain and, if alone, from all else."""

    def mistake(kind, authority, low, high):
        found = {}
        for name, wrong in _not_the_slope(kind, authority, low, high).items():
            if alone == all(not 0.8 < x / wrong[why] < 1.25 for other, x in wrong.items() if other != why):
                found[name] = wrong[why]
        return _apart(_gains(kind, authority, low, high), found)

    return mistake


for why, sentence in _ALONE.items():
    stroked_valve.mistake(sentence)(_taken_for(why, alone=True))
    stroked_valve.mistake(_TOGETHER)(_taken_for(why, alone=False))


@stroked_valve.mistake("That is the flow at this point. By how much does it change with the opening?")
def _(kind, authority, low, high):
    (q_A, _), (q_B, _) = (installed(kind, authority, x) for x in (low, high))
    return {"gain_A": q_A, "gain_B": q_B}


@stroked_valve.mistake("That is a flow. Which axis has the opening, and where does the curve reach this flow?")
def _(kind, authority, middle):
    flow = _flow(kind, authority, middle)
    wrong = float(installed(kind, authority, flow)[0])
    return _apart({"opening": _opening(kind, authority, middle)}, {"opening": wrong})


@stroked_valve.mistake("Tuned there, the loop has a larger gain at the other point than it was made for.")
def _(kind, authority, low, high):
    at_A, at_B = _gains(kind, authority, low, high).values()
    return {"tune": "B" if at_A > at_B else "A"}


stroked_valve.hints(
    "A gain is a slope. Where is the curve steep, and where is it flat?",
    "Lay a ruler along the curve at A. It crosses the frame of the picture at two places: the gain is the difference "
    "of their flows divided by the difference of their openings. The gain of the loop is proportional to it.",
    "At A the valve is open by {low}. Read the flows of the curve 5 % before and 5 % behind it and divide their "
    "difference by 10 %.",
)


@stroked_valve.solution
def _(kind, authority, low, high):
    r"""The curve reaches {flow} at an opening of {opening}.

    **The gains.** Around A the flow goes from {q_1} at {x_1} to {q_2} at {x_2} of opening, so the slope is
    $\frac{ {q_2} - {q_1} }{10}$. The tangent itself has {gain_A}. Around B it goes from {q_3} to {q_4} in the same way,
    and the tangent has {gain_B}.

    **The tuning.** The gain of the loop is {times} times as large at {tune} as at the other point. A controller that is
    tuned at {tune} is slow at the other one, but stable. The other way round the loop would have {times} times the gain
    that it was made for.
    """
    near = [x + step for x in (low, high) for step in (-5, 5)]
    q = [float(installed(kind, authority, x)[0]) for x in near]
    at_A, at_B = map(float, _gains(kind, authority, low, high).values())
    flows = {f"q_{k}": (value, "%") for k, value in enumerate(q, 1)}
    return flows | {"x_1": (near[0], "%"), "x_2": (near[1], "%"), "times": max(at_A, at_B) / min(at_A, at_B)}


_AXES = "opening [%]", "flow [%]"


@stroked_valve.picture
def _(kind, authority, low, high):
    """The flow against the opening of the valve, as measured in the plant, with the points A and B."""
    x = np.linspace(0, 100, 201)
    plot = plane_plot(
        {"valve": (x, installed(kind, authority, x)[0], "measurement")}, *_AXES, xlim=(0, 100), ylim=(0, 105)
    )
    flows = [float(installed(kind, authority, opening)[0]) for opening in (low, high)]
    plot.points([float(low), float(high)], flows, "working points")
    return plot.text(float(low) - 3, flows[0] + 5, "A").text(float(high) - 3, flows[1] + 5, "B")


@stroked_valve.solution_picture
def _(kind, authority, low, high):
    """The curve with its tangents at A and B."""
    x = np.linspace(0, 100, 201)
    curves = {"flow [%]": (x, installed(kind, authority, x)[0], "measurement")}
    for name, at in (("A", low), ("B", high)):
        flow, slope = installed(kind, authority, at)
        near = np.array([-15.0, 15.0])
        curves[f"tangent at {name}"] = (float(at) + near, flow + slope * near)
    return plane_plot(curves, *_AXES, xlim=(0, 100), ylim=(0, 105))


@exercise(
    "9.9",
    title="The root of a pressure",
    points=3,
    where=lambda inaccuracy, allowed: 0.1 <= _turndown(inaccuracy, allowed) <= 0.45,
    insight="A flow that is measured by a pressure difference is inaccurate where it is small: a tenth of the flow is "
    "a hundredth of the signal.",
)
def orifice(
    q_max=between(40, 200, "m³/h", step=10, reference=120),
    I=choice(5, 6, 7, 8, 10, 12, unit="mA", reference=8),
    inaccuracy=choice(0.1, 0.2, 0.25, 0.5, unit="%", reference=0.2),
    allowed=choice(1, 2, 3, 5, unit="%", reference=2),
):
    r"""The flow in a water main makes a pressure difference at an orifice, and a sensor sends 4 to 20 mA for it. The
    picture shows its current against the flow: the pressure difference grows with the square of the flow.

    Which flow belongs to 20 mA? Now the sensor sends {I}. How large is the flow, and what would a controller show that
    takes the current for proportional to the flow? The pressure difference is measured with an inaccuracy of
    {inaccuracy} of its full scale. Down to which flow is the flow then known within {allowed} of its own value?
    """
    share = (I - 4) / 16
    return answers(
        q_max=number(q_max, "m³/h", "the flow that belongs to 20 mA", within=0.04),
        q=number(q_max * math.sqrt(share), "m³/h", "the flow now", within=0.05),
        shown=number(q_max * share, "m³/h", "what the controller would show", within=0.05),
        least=number(q_max * _turndown(inaccuracy, allowed), "m³/h", "the lowest flow", within=0.05),
    )


def _turndown(inaccuracy, allowed):
    """The share of the largest flow down to which a flow is known within a share of its own value."""
    return math.sqrt(float(inaccuracy / allowed) / 2)


@orifice.mistake("That is where the axis ends. Where does the curve reach 20 mA?")
def _(q_max):
    return {"q_max": q_max * 6 / 5}


@orifice.mistake(
    "That takes the current for proportional to the flow. How does the pressure difference depend on the flow?"
)
def _(q_max, I):
    return {"q": q_max * (I - 4) / 16}


@orifice.mistake("That is the true flow. A controller without the square root scales the current linearly.")
def _(q_max, I):
    return {"shown": q_max * math.sqrt((I - 4) / 16)}


@orifice.mistake("That is the largest current. The flow that belongs to it is on the other axis.")
def _():
    return {"q_max": 20}


@orifice.mistake("The factor 2 is on the wrong side: an error of $x^2$ is $2x$ times that of $x$. Which one is known?")
def _(q_max, inaccuracy, allowed):
    return {"least": q_max * math.sqrt(2 * inaccuracy / allowed)}


@orifice.mistake("That is a share of the largest flow. How large is the flow itself?")
def _(inaccuracy, allowed):
    return {"least": _turndown(inaccuracy, allowed)}


@orifice.mistake("The current does not begin at zero. Which share of its range is it?")
def _(q_max, I):
    found = {"q": q_max * math.sqrt(I / 20), "shown": q_max * I / 20}
    return found if I > 5 else {"q": found["q"]}


@orifice.mistake("A factor 2 is missing: by how much does $x^2$ change when $x$ changes a little? Take the derivative.")
def _(q_max, inaccuracy, allowed):
    return {"least": q_max * math.sqrt(inaccuracy / allowed)}


@orifice.mistake("That would hold for a sensor that is linear in the flow. Here the signal is its square.")
def _(q_max, inaccuracy, allowed):
    return {"least": q_max * float(inaccuracy / allowed)}


@orifice.mistake("That is the square of the share of the flow. What is left to do?")
def _(q_max, inaccuracy, allowed):
    return {"least": q_max * float(inaccuracy / allowed) / 2}


orifice.hints(
    "With $x$ for the share of the largest flow, which share of the largest pressure difference, and which current "
    "belong to it?",
    "The current has made the share $x^2$ of its 16 mA. For the inaccuracy, ask by how much $x$ is wrong when $x^2$ "
    "is: a small error of $x^2$ is $2x$ times that of $x$.",
    "Read the flow at 20 mA off the picture. Now $x^2 = \\frac{ {I} - 4}{16}$. And relative to the flow, the error is "
    "$\\frac{ {inaccuracy} }{2x^2}$ in percent: it must be at most {allowed}.",
)


@orifice.solution
def _(q_max, I, inaccuracy, allowed):
    r"""The curve reaches 20 mA at {q_max}. With $x$ for the share of this flow, the pressure difference is the share
    $x^2$ of its own largest value, and so is the current of its 16 mA.

    At {I} the share is $x^2 = \frac{ {I} - 4}{16} = {share}$. So $x = {root}$ and the flow is {q}. A controller that
    takes the current for proportional would show ${share} \cdot {q_max}$, which is {shown}.

    **The lowest flow.** An error of $x^2$ is $2x$ times the error of $x$. With {inaccuracy} for $x^2$, the error of $x$
    is $\frac{ {inaccuracy} }{2x}$, and relative to $x$ it is $\frac{ {inaccuracy} }{2x^2}$. It is {allowed} at
    $x = \sqrt{\frac{ {inaccuracy} }{2 \cdot {allowed} } } = {turndown}$, which is a flow of {least}. Below, the reading
    is worth less and less.
    """
    share = (I - 4) / 16
    return {"share": share, "root": math.sqrt(share), "turndown": _turndown(inaccuracy, allowed)}


@orifice.picture
def _(q_max):
    """The current of the sensor against the flow: it begins at 4 mA and grows with the square of the flow to 20 mA."""
    x, full = np.linspace(0, 1, 201), float(q_max)
    curve = {"current": (x * full, 4 + 16 * x**2, "measurement")}
    return plane_plot(curve, "flow [m³/h]", "current [mA]", xlim=(0, 1.2 * full), ylim=(0, 22))


@orifice.solution_picture
def _(inaccuracy, allowed):
    """The error of the flow relative to the flow, with the lowest flow that is known well enough."""
    x = np.linspace(0.05, 1, 191)
    error = float(inaccuracy) / (2 * x**2)
    plot = time_plot(
        {"error [% of the flow]": error}, 100 * x, xlabel="flow [% of the largest]", ylim=(0, 4 * float(allowed))
    )
    return plot.mark(100 * _turndown(inaccuracy, allowed), "lowest flow")
