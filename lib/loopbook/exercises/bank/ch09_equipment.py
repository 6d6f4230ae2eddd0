"""Exercises of chapter 9, controller equipment."""

import math

from sympy import Piecewise, Symbol, exp, pi, symbols

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


@exercise(
    "9.1",
    title="A kiln behind a resistor",
    points=2,
    where=lambda T_low, T_high, R, V: 6 <= 1000 * V / R <= 18 and abs(5 * T_low - T_high) >= 80 and T_high != 9 * T_low,
)
def kiln(
    T_low=between(100, 400, "°C", reference=200, step=50),
    T_high=between(800, 1400, "°C", reference=1200, step=50),
    R=choice(100, 250, 500, unit="Ω", reference=250),
    V=between(0.6, 9, "V", reference=3, step=0.1),
):
    """The thermometer of a kiln sends 4 to 20 mA for {T_low} to {T_high}. A resistor of {R} turns the current into a
    voltage, and a voltmeter across it shows {V}. What is the current, and how hot is the kiln? Then the cable breaks.
    Which temperature would the controller show, if it went on with the same scaling and gave no alarm?
    """
    I = 1000 * V / R
    span = T_high - T_low
    return answers(
        I=number(I, "mA", "the current"),
        T=number(T_low + (I - 4) * span / 16, "°C", "the temperature of the kiln"),
        T_broken=number(T_low - span / 4, "°C", "the temperature that a broken cable shows"),
    )


@kiln.mistake("This scaling has its lower end at 0 mA. At which current does the kiln have the lowest temperature?")
def _(T_low, T_high, R, V):
    return {"T": T_low + 50 * V / R * (T_high - T_low), "T_broken": T_low}


@kiln.mistake("The lower end of the temperature range is missing in the sum.")
def _(T_low, T_high, R, V):
    return {"T": (1000 * V / R - 4) * (T_high - T_low) / 16, "T_broken": -(T_high - T_low) / 4}


@kiln.mistake("A current is a voltage divided by a resistance. Look at Ohm's law, and at the units.")
def _(R, V):
    return {"I": V * R / 1000} if abs(V * R / 1000 - 1000 * V / R) > 0.02 * 1000 * V / R else {}


@exercise(
    "9.2",
    title="A silo on load cells",
    points=2,
    where=lambda inaccuracy, drift, warming: (
        drift >= 0.02 * inaccuracy and abs(drift * warming - inaccuracy) >= 0.02 * inaccuracy
    ),
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
    number of {bits} bits, so that a change shows only if it is a step of this number. How many kilograms is a step? The
    data sheet also states an inaccuracy of {inaccuracy} of full scale at most, and a drift of {drift} (of full scale).
    How many kilograms do these two make together, at most, when it has become {warming} warmer? Which is larger, the
    resolution (the step) or the inaccuracy with its drift? And how many bits, at least, make the step no larger than
    {finest}?
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


@silo.mistake("A number with that many bits has many more values. How many are there with two bits, with three bits?")
def _(span, bits):
    return {"step": 1000 * span / bits}


@silo.mistake("This is in percent of full scale. How many kilograms is full scale?")
def _(bits, inaccuracy, drift, warming):
    return {"step": 100 / (2**bits - 1), "error": inaccuracy + drift * warming}


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


@exercise(
    "9.3",
    title="The far end of a dam",
    points=3,
    where=lambda R_load, inputs, R_in: R_load - inputs * R_in >= 100 and R_load != 2 * inputs * R_in,
)
def dam(
    R_load=between(400, 800, "Ω", reference=650, step=50),
    inputs=choice(1, 2, reference=2),
    R_in=choice(100, 250, unit="Ω", reference=250),
    wire=choice(12, 18, 24, 36, unit="Ω/km", reference=18),
    length=between(0.5, 4, "km", reference=2, step=0.5),
    R_voltage=choice(2, 5, 10, 20, 100, unit="kΩ", reference=10),
):
    """A controller sets a gate at the far end of a dam by a current of 4 to 20 mA. Its output drives at most {R_load}
    in all. In the loop are {receivers} an input of {R_in}, and the cable. Each of its two wires has {wire}.

    Which voltage must the output have at 20 mA, when its load is the largest one? How far away may the gate be? A
    colleague would rather send a voltage to an input of {R_voltage}. Which share of it, in percent, is lost on {length}
    of the same cable?
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


@exercise("9.4", title="Pulses for a pump", points=3, where=lambda A, q, ripple: 4 * ripple * A >= 15 * q)
def pump_sump(
    A=between(1, 8, "m²", reference=3, step=0.5),
    q=between(4, 30, "L/s", reference=12, step=1),
    D=choice(0.2, 0.25, 0.3, 0.7, 0.75, 0.8, reference=0.7),
    ripple=between(5, 40, "mm", reference=20, step=5),
):
    """A pump can only run or stand still. When it runs it delivers $q$ [L/s] into a tank with the area $A$ [m²]. It is
    switched by pulse-width modulation: in each cycle of $P$ [s] it runs for the share $D$ (between 0 and 1). The
    outflow is steady, and so large that the level is the same after each cycle.

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


def _distinct(T, D, P):
    """Whether the ripple of the first cycle and the formula for short cycles can be told apart."""
    first, short = 1 - math.exp(-D * P / T), float(D * (1 - D) * P / T)
    return abs(first - short) > 0.03 * first


@exercise(
    "9.5",
    title="An oven that switches slowly",
    points=4,
    where=lambda T, D, P: 1.2 <= float(P / T) <= 3 and _distinct(T, D, P),
)
def oven(
    full=between(200, 800, "K", reference=400, step=50),
    T=between(10, 40, "min", reference=20, step=2),
    D=choice(0.25, 0.4, 0.5, 0.6, 0.75, reference=0.4),
    P=between(15, 60, "min", reference=30, step=5),
):
    """An electric oven answers to its power with a lag of {T}; full power would heat it by {full} above the room. To
    spare the contacts, its relay switches slowly: the cycle period is {P}. The duty cycle is {duty}. The oven begins
    at room temperature, and with full power.

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
def _(D):
    return {"duty": f"{100 * float(D):g} %"}


def _first_cycle(full, T, on):
    highest = full * (1 - exp(-on / T))
    return Piecewise((full * (1 - exp(-t / T)), t < on), (highest * exp(-(t - on) / T), True))


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


@oven.mistake("That formula holds for cycles that are short compared with the time constant. This one is not.")
def _(full, T, D, P):
    return {"ripple": full * D * (1 - D) * P / T}


@oven.mistake("This is the ripple of the first cycle, which begins at room temperature. In the end no cycle does.")
def _(full, T, D, P):
    return {"ripple": full * (1 - exp(-D * P / T))}


@exercise(
    "9.6",
    title="How often must the program run?",
    points=4,
    where=lambda K, T, tau, K_p, h: 0.5 * tau <= _margin(K, T, tau, K_p) <= min(4 * tau, 15 * h) and h <= tau,
)
def program(
    K=between(0.5, 3, reference=1.5, step=0.1),
    T=between(2, 30, "s", reference=10, step=1),
    tau=between(0.5, 4, "s", reference=2, step=0.5),
    K_p=between(0.5, 6, reference=2, step=0.1),
    h=between(0.2, 2, "s", reference=0.4, step=0.2),
):
    """A steam pressure answers to its valve with a gain of $K$ = {K} (percent for percent), a lag of $T$ = {T} and a
    dead time of $\\tau$ = {tau}. The PI controller has a gain of $K_p$ = {K_p}, and its integral time is equal to $T$.
    Then the open loop is an integrator with dead time.

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


@program.mistake("Here the margin is the whole dead time at the limit. But some of it is there already.")
def _(K, T, tau, K_p, h):
    whole = pi * T / (2 * K * K_p)
    return {"margin": whole, "h_limit": 2 * whole, "left": whole - h / 2}


@program.mistake("This is the time in which the phase turns by one radian. The integrator leaves a quarter of a turn.")
def _(K, T, tau, K_p):
    return {"margin": T / (K * K_p) - tau}


@program.mistake("Here the phase is turned by half a turn. The integrator accounts for a part of that.")
def _(K, T, tau, K_p):
    return {"margin": pi * T / (K * K_p) - tau}


@program.mistake("The controller's output is constant for a whole step. How old is it on average?")
def _(K, T, tau, K_p, h):
    margin = _margin(K, T, tau, K_p)
    return {"h_limit": margin, "left": margin - h}


@exercise(
    "9.7",
    title="A cycle for the heating relay",
    points=5,
    where=lambda T, ripple, cycle, fineness, life, years: (
        1.5 <= _longest(T, ripple) / _shortest(cycle, fineness, life, years) <= 6
    ),
)
def relay(
    T=between(10, 60, "min", reference=20, step=5),
    ripple=choice(0.5, 1, 1.5, 2, unit="%", reference=1),
    cycle=choice(10, 20, 50, unit="ms", reference=20),
    fineness=choice(0.1, 0.2, 0.5, unit="%", reference=0.2),
    life=choice(2, 5, 10, reference=10),
    years=between(3, 10, reference=6, step=1),
):
    """A PLC heats a greenhouse with a relay and pulse-width modulation. The greenhouse is a lag with a time constant of
    {T}. The PLC switches an output only once in its own cycle of {cycle}, and the relay lasts for {life} million
    switching cycles (on and off again). Choose the period $P$ of the modulation in seconds such that

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
            criterion("the ripple", lambda P: _ripple(T, P), below=float(ripple), unit="%"),
            criterion("the step of the pulse width", lambda P: _fine(cycle, P), below=float(fineness), unit="%"),
            criterion("the life of the relay", lambda P: _life(life, P), above=float(years), unit="years"),
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


@relay.mistake(
    "With this period the steps of the pulse width are fine enough. But how often does the relay switch in a year?"
)
def _(cycle, fineness, life, years):
    P = float(cycle) / 10 / float(fineness)
    return {"P": P} if 0.98 * _shortest(cycle, fineness, life, years) > P else {}


@relay.mistake("The ripple grows with the period. Compare it with the time constant.")
def _(T, ripple):
    return {"P": 60 * float(T)}
