"""Exercises of chapter 1, introduction to control."""

import math

import numpy as np
from sympy import Rational, exp

from exercisebook.parameters import written
from loopbook import diagrams as draw
from loopbook.exercises.authoring import (
    answers,
    between,
    choice,
    criterion,
    design,
    exercise,
    number,
    settings,
    time_function,
    word,
)
from loopbook.expressions import t
from loopbook.figures import plane_plot, time_plot
from loopbook.pid import PID

ROLES = {
    "r": "setpoint",
    "e": "control error",
    "u": "control signal",
    "d": "disturbance",
    "y": "process output",
    "n": "measurement noise",
}

# Which parts are asked for, on each page of the engineer's notebook.
PAGES = {12: "dyur", 15: "yrud", 18: "uedy", 21: "rduy", 24: "dnyu", 27: "eudy", 33: "yden", 36: "udny"}

# What plays which part, in five plants.
PLANTS = {
    "a greenhouse": {
        "r": "the 22 °C that tomatoes like",
        "e": "what the air lacks to the 22 °C, in kelvin",
        "u": "the opening that is asked of the heating valve",
        "d": "the sunshine on the glass",
        "y": "the temperature of the air",
        "n": "the jitter in the reading of the thermometer",
    },
    "a car with cruise control": {
        "r": "the 90 km/h that the driver has keyed in",
        "e": "how much slower than 90 km/h the car is",
        "u": "the position that is asked of the throttle",
        "d": "the slope of the road",
        "y": "the speed of the car",
        "n": "the jitter in the reading of the speedometer",
    },
    "a water tower": {
        "r": "the 6 m at which the water should stand",
        "e": "how far the water is below the 6 m",
        "u": "the speed that is asked of the pump in the well",
        "d": "the water that the town draws from the tower",
        "y": "the height of the water in the tower",
        "n": "the waves under the level sensor, as its signal shows them",
    },
    "a ferry on its course": {
        "r": "the heading that the captain has ordered",
        "e": "the angle from the heading of the ferry to the ordered one",
        "u": "the angle that is asked of the rudder",
        "d": "the wind from the side",
        "y": "the heading of the ferry",
        "n": "the trembling of the compass",
    },
    "an incubator for eggs": {
        "r": "the 37.7 °C that a hen would give",
        "e": "the distance of the air from the 37.7 °C, with its sign",
        "u": "the share of the time for which the heating coil is switched on",
        "d": "the cold air that comes in when somebody opens the door",
        "y": "the temperature of the air around the eggs",
        "n": "the random last digit of the measured temperature",
    },
}


@exercise(
    "1.1",
    title="Who plays which part?",
    points=2,
    insight="Find the process output first: it is the quantity that somebody would complain about.",
)
def parts(
    plant=choice(*PLANTS, reference="a water tower"),
    page=choice(*PAGES, reference=12),
):
    """Somebody automates {plant} by feedback. Page {page} of the engineer's notebook lists four quantities:

    - **a**: {a}
    - **b**: {b}
    - **c**: {c}
    - **d**: {d}

    Which part does each of them play in the control loop?
    """
    return answers(
        **{
            name: word(ROLES[role], list(ROLES.values()), what=f"the part that {name} plays")
            for name, role in zip("abcd", PAGES[page], strict=True)
        }
    )


@parts.shows
def _(plant, page):
    return {name: PLANTS[plant][role] for name, role in zip("abcd", PAGES[page], strict=True)}


def _taken_for(page, wrong):
    """Which answers somebody gives who takes each role for another."""
    return {name: ROLES[wrong[role]] for name, role in zip("abcd", PAGES[page], strict=True) if role in wrong}


@parts.mistake("Ask which quantity has to be kept at a wanted value, and what merely happens to the plant.")
def _(plant, page):
    return _taken_for(page, {"d": "y", "y": "d"}) if plant != "a water tower" else {}


@parts.mistake(
    "Ask which quantity has to be kept at a wanted value, and what merely happens to the plant. "
    "It does not matter that water flows out of the tower."
)
def _(plant, page):
    return _taken_for(page, {"d": "y", "y": "d"}) if plant == "a water tower" else {}


@parts.mistake(
    "Of control error and control signal one goes into the controller, and the other comes out of it and to a machine. "
    "Which of the two is this?"
)
def _(page):
    return _taken_for(page, {"e": "u", "u": "e"})


@parts.mistake("What somebody wishes for, and what the process does, are two signals. Which of them is this one?")
def _(page):
    return _taken_for(page, {"r": "y"})


@parts.mistake("What somebody wishes for, and what the process does, are two signals. Which of them is this one?")
def _(page):
    return _taken_for(page, {"y": "r"})


@parts.mistake(
    "Noise is only in the signal of the sensor, and a disturbance acts on the process itself. "
    "Would this one be there without a sensor?"
)
def _(page):
    return _taken_for(page, {"n": "d", "d": "n"})


# What to ask of a quantity that somebody takes for one of the parts.
DOUBTS = {
    "r": "A setpoint is a wish: somebody has stated it, and it stays until somebody changes it. Is this one a wish?",
    "e": "A control error is a difference of two signals. Of which two would this one be the difference?",
    "u": "The control signal is a command that the controller sends to a machine. Does this one command a machine?",
    "d": "A disturbance acts on the process from outside, and nothing in the loop decides on it. Who decides on this "
    "one?",
    "y": "The process output is a physical quantity for which there is a wanted value. Has this one a wanted value?",
    "n": "Noise exists only in the signal of a sensor. Would this one be there if nobody measured anything?",
}
#: Pairs of part and wrong part that have sentences of their own, above.
OFTEN = {("d", "y"), ("y", "d"), ("e", "u"), ("u", "e"), ("r", "y"), ("y", "r"), ("n", "d"), ("d", "n")}


def _doubted(wrong):
    def found(page):
        return _taken_for(page, {role: wrong for role in ROLES if role != wrong and (role, wrong) not in OFTEN})

    return found


for _role, _sentence in DOUBTS.items():
    parts.mistake(_sentence)(_doubted(_role))

parts.hints(
    "Draw the loop of Figure 1.1 for yourself: what is compared with what, what goes to a machine, and what acts on "
    "the process from outside?",
    "Begin with the process output. For which quantity of the plant is there a wanted value? Perhaps it is not even "
    "among the four.",
    "Ask the same of each of the others: is it a wish (setpoint), a difference (control error), a command to a machine "
    "(control signal), something that happens to the process (disturbance), or does it exist only in the signal of a "
    "sensor (noise)? Begin with this one: {a}.",
)

# Why a quantity plays its part.
REASONS = {
    "r": "This is a wish. Nothing in the plant makes it; somebody has chosen it, and it stays until it is changed",
    "e": "This is a difference, setpoint minus process output. The controller acts on it",
    "u": "This is a command. The controller sends it, and a machine obeys",
    "d": "This happens to the process from outside. Nothing in the loop decides on it, and the controller has to "
    "compensate for it",
    "y": "This is what should have a wanted value. The whole loop exists for its sake",
    "n": "This exists only in the signal of the sensor. Without a measurement it would not be there",
}


@parts.solution
def _(plant, page):
    """Look for the process output first: the quantity of {plant} that should have a wanted value. Then ask of each of
    the four what it is: a wish, a difference, a command, something that happens to the process, or something in the
    signal of the sensor alone.

    **a**, {a}: {why_a}. So it is the {part_a}.

    **b**, {b}: {why_b}. So it is the {part_b}.

    ***

    **c**, {c}: {why_c}. So it is the {part_c}.

    **d**, {d}: {why_d}. So it is the {part_d}.
    """
    roles = dict(zip("abcd", PAGES[page], strict=True))
    reasons = {f"why_{name}": REASONS[role] for name, role in roles.items()}
    return reasons | {f"part_{name}": ROLES[role] for name, role in roles.items()}


def _apart(value, *others):
    """Whether the value of a mistake differs clearly from the key and from the values of other mistakes."""
    return all(abs(value - other) > abs(other) * 3 / 100 for other in others)


def _pressure(low, high, I):
    return low + (I - 4) * (high - low) / 16


@exercise(
    "1.2",
    title="One error, two units",
    points=4,
    insight="In percent of the range, a controller for bars is a controller for metres: its gain needs no unit.",
    where=lambda low, high, I, p_SP: (
        abs(p_SP - _pressure(low, high, I)) >= (high - low) / 20 and low < p_SP < high and p_SP != (low + high) / 2
    ),
)
def error_in_units(
    low=between(1, 3, "bar", reference=2, step=0.5),
    high=between(8, 16, "bar", reference=10),
    I=between(8, 16, "mA", reference=10.4, step=0.4),
    p_SP=between(4, 10, "bar", reference=7, step=0.5),
):
    """A controller keeps the pressure in a compressed-air network, whose setpoint is {p_SP}. The transmitter sends
    4 mA at {low} and 20 mA at {high}, with a straight line in between. Now it sends {I}, without any noise.

    What is the pressure, and what is the control error $e$, in bar and in percent of the measurement range? The
    control signal sets the speed of the compressor. Which way does a controller with positive gain move it, compared
    with what it was while the error was zero?
    """
    p = _pressure(low, high, I)
    return answers(
        p=number(p, "bar", "the pressure"),
        e=number(p_SP - p, "bar", "the control error"),
        e_percent=number(100 * (p_SP - p) / (high - low), "%", "the control error in percent of the range"),
        u=word("up" if p_SP > p else "down", ["up", "down"], what="the direction of the control signal"),
    )


@error_in_units.picture
def _(low, high, I, p_SP):
    """The loop: transmitter PT, {low} to {high}, sends {I} to controller PC, which moves the compressor."""
    layout = """
        .    .           setpoint  .  range    .
        .    1           PC        I  PT       .
        air  compressor  .         .  network  consumers"""
    parts = {"compressor": draw.compressor(), "network": draw.vessel()}
    names = {
        "setpoint": f"${written(p_SP)}$ bar",
        "I": f"${written(I)}$ mA",
        "range": f"${written(low)}$ to ${written(high)}$ bar",
    }
    pipes, signals = "air compressor network consumers", "network PT I PC 1 compressor, setpoint PC"
    return draw.instrumentation_diagram(layout, pipes, signals, parts, names)


def _with_pressure(p, low, high, I, p_SP):
    """Pressure and errors of somebody who has another pressure; an error that is right except for its sign is none."""
    e, right = p_SP - p, p_SP - _pressure(low, high, I)
    return {"p": p} | ({"e": e, "e_percent": 100 * e / (high - low)} if _apart(e, right, -right) else {})


@error_in_units.mistake("Look again at the current for the lower end of the range: it is not zero.")
def _(low, high, I, p_SP):
    return _with_pressure(low + I * (high - low) / 20, low, high, I, p_SP)


@error_in_units.mistake("At 4 mA the pressure is not zero: the range has a lower end.")
def _(low, high, I, p_SP):
    return _with_pressure((I - 4) * (high - low) / 16, low, high, I, p_SP)


@error_in_units.mistake("How many milliamperes are there between the two ends of the range?")
def _(low, high, I, p_SP):
    p, from_zero = low + (I - 4) * (high - low) / 20, (I - 4) * (high - low) / 16
    return _with_pressure(p, low, high, I, p_SP) if _apart(p, from_zero) else {}


@error_in_units.mistake("At the lower end of the range the current is not zero. How far has it come from there?")
def _(low, high, I, p_SP):
    return _with_pressure(low + I * (high - low) / 16, low, high, I, p_SP)


@error_in_units.mistake("Your line goes through zero bar. Through which two points does that of the transmitter go?")
def _(low, high, I, p_SP):
    p, others = high * (I - 4) / 16, [low + I * (high - low) / 20, low + (I - 4) * (high - low) / 20]
    return _with_pressure(p, low, high, I, p_SP) if _apart(p, _pressure(low, high, I), *others) else {}


@error_in_units.mistake("Your line goes through zero bar. Through which two points does that of the transmitter go?")
def _(low, high, I, p_SP):
    p, others = high * I / 20, [low + I * (high - low) / 20, low + (I - 4) * (high - low) / 20]
    return _with_pressure(p, low, high, I, p_SP) if _apart(p, _pressure(low, high, I), *others) else {}


def _other_shares(low, high, I, p_SP):
    """The errors, as a part of the range, of those who scale the current by another line."""
    span = high - low
    pressures = [low + span * I / 20, low + span * (I - 4) / 20, high * I / 20, high * (I - 4) / 16]
    return [(p_SP - p) / span for p in pressures]


@error_in_units.mistake("That is a percentage of the setpoint. What percentage of the measurement range is it?")
def _(low, high, I, p_SP):
    e, span = p_SP - _pressure(low, high, I), high - low
    others = [e / span, e / high, (e + low) / span, *_other_shares(low, high, I, p_SP)]
    return {"e_percent": 100 * e / p_SP} if _apart(e / p_SP, *others) else {}


@error_in_units.mistake("The range does not begin at zero. How wide is it?")
def _(low, high, I, p_SP):
    e = p_SP - _pressure(low, high, I)
    return {"e_percent": 100 * e / high} if _apart(e / high, *_other_shares(low, high, I, p_SP)) else {}


@error_in_units.mistake(
    "A controller with positive gain moves its signal in the direction of the error. Is the pressure above its "
    "setpoint or below it?"
)
def _(low, high, I, p_SP):
    return {"u": "down" if p_SP > _pressure(low, high, I) else "up"}


@error_in_units.mistake("That is the measurement in percent of the range. What about the setpoint?")
def _(low, high, I, p_SP):
    e, span = p_SP - _pressure(low, high, I), high - low
    share = (I - 4) / 16
    return {"e_percent": 100 * share} if _apart(share, e / span, e / high, e / p_SP, (e + low) / span) else {}


@error_in_units.mistake("That is the setpoint in percent of the range. What about the measurement?")
def _(low, high, I, p_SP):
    e, span = p_SP - _pressure(low, high, I), high - low
    share = (p_SP - low) / span
    return {"e_percent": 100 * share} if _apart(share, e / span, e / high, e / p_SP, (e + low) / span) else {}


error_in_units.hints(
    "The transmitter draws a straight line through two points: 4 mA at the lower end of the range, 20 mA at the upper "
    "one. And a control error is setpoint minus process output.",
    "Which part of the way from 4 mA to 20 mA has the current gone? The pressure has gone the same part of its way "
    "from $p_1$ to $p_2$: $p = p_1 + \\frac{I - 4}{20 - 4}\\,(p_2 - p_1)$.",
    "With your numbers $p = {low} + \\frac{ {I} - 4}{20 - 4}\\,({high} - {low})$, in bar. One percent of the range "
    "is a hundredth of {high} minus {low}.",
)


@error_in_units.solution
def _(low, high, I, p_SP):
    """Between 4 mA and 20 mA the current has gone $({I} - 4)/16 = {share}$ of its way. So has the pressure, from
    the lower end of its range to the upper one:

    $$p = {low} + {share}\\cdot({high} - {low}) = {p}$$

    in bar. The control error is setpoint minus process output: $e = {p_SP} - {p} =$ {e}.

    In percent, both are counted from the lower end of the range, which cancels in the difference. What remains is the
    error as a part of the width of the range, {width}: $100 \\cdot {e}/{width} =$ {e_percent}.

    The pressure is too {state}, the error is {sign}, and a controller with positive gain moves its signal {u}: the
    compressor runs {pace}.
    """
    too_low = p_SP > _pressure(low, high, I)
    return {
        "share": (I - 4) / 16,
        "width": (high - low, "bar"),
        "state": "low" if too_low else "high",
        "sign": "positive" if too_low else "negative",
        "pace": "faster" if too_low else "slower",
    }


@exercise(
    "1.3",
    title="A bunker at the end of a belt",
    points=4,
    insight="During the delay the process is alone. What is lost by then, no controller can save.",
)
def bunker(
    length=between(40, 160, "m", reference=90, step=5),
    speed=choice(0.5, 0.6, 0.8, 0.9, 1, 1.2, unit="m/s", reference=0.6),
    u_0=between(30, 50, "%", reference=40, step=2),
    w_0=between(12, 40, "kg/s", reference=24, step=2),
    change=choice(-40, -30, -25, -20, 10, 15, 20, 25, 30, 40, 50, unit="%", reference=25),
):
    """A feeder drops gravel onto a belt of {length} that runs at {speed}. The flow through the feeder is proportional
    to its control signal. For a long time all has been as in the picture: as much gravel arrives as is drawn from the
    bunker, {w_0}, with a control signal of {u_0}, and the level is at its setpoint. Then the flow out of the bunker
    {event}, for good.

    How long is the time delay of the belt? By how much does the mass in the bunker change within this time,
    whatever the controller does? (A loss is negative.) Which way does the level go first? And where does the
    control signal end when a PI controller has brought the level back to its setpoint?
    """
    tau = length / speed
    return answers(
        tau=number(tau, "s", "the time delay"),
        dm=number(-w_0 * change / 100 * tau, "kg", "the change of the mass in the bunker"),
        level=word("falls" if change > 0 else "rises", ["rises", "falls"], what="the first movement of the level"),
        u=number(u_0 * (1 + change / 100), "%", "the control signal in the end"),
    )


@bunker.shows
def _(change):
    return {"event": f"{'grows' if change > 0 else 'drops'} by {abs(change)} %"}


@bunker.picture
def _(length, speed, u_0, w_0):
    """A feeder, a belt of {length} at {speed}, and a bunker, from which {w_0} leave; its level controller moves the
    feeder, with a control signal of {u_0}."""
    layout = """
        .       1       u     .     .       LC
        gravel  feeder  .     .     .       .
        .       belt    belt  belt  2       .
        .       .       .     .     bunker  LT
        .       .       .     .     3       out"""
    belt = draw.conveyor(f"${written(length)}$ m at ${written(speed)}$ m/s")
    parts = {"feeder": "Feeder", "belt": belt, "bunker": draw.silo()}
    names = {"u": f"${written(u_0)}\\,\\%$", "out": f"${written(w_0)}$ kg/s"}
    pipes, signals = "gravel feeder belt 2 bunker 3 out", "bunker LT LC u 1 feeder"
    return draw.instrumentation_diagram(layout, pipes, signals, parts, names)


@bunker.mistake(
    "A change in percent refers to the flow that changes. The control signal changes by the same fraction of its own "
    "value, which is a different number of percentage points."
)
def _(u_0, change):
    return {"u": u_0 + change}


@bunker.mistake("Metres times metres per second is not a time. Look at the units.")
def _(length, speed, w_0, change):
    wrong = length * speed
    return {"tau": wrong, "dm": -w_0 * change / 100 * wrong} if speed != 1 else {}


@bunker.mistake("That is the change of the control signal. Where does it end?")
def _(u_0, change):
    return {"u": u_0 * change / 100}


@bunker.mistake("Something flows out of the bunker, but something also arrives all the time. Set up the mass balance.")
def _(length, speed, w_0, change):
    return {"dm": -w_0 * (1 + change / 100) * length / speed}


@bunker.mistake("That is the mass on the belt. By how much do the flows into the bunker and out of it differ?")
def _(length, speed, w_0):
    return {"dm": w_0 * length / speed}


@bunker.mistake("That is the mass on the belt. By how much do the flows into the bunker and out of it differ?")
def _(length, speed, w_0):
    return {"dm": -w_0 * length / speed}


@bunker.mistake(
    "The controller responds soon, but what it drops arrives only after the delay. What happens in the bunker until "
    "then?"
)
def _():
    return {"dm": 0}


@bunker.mistake("When more is drawn, more has to arrive in the end, and when less is drawn, less.")
def _(u_0, change):
    return {"u": u_0 * (1 - change / 100)} if change != 50 else {}


@bunker.mistake(
    "At rest, inflow and outflow are equal again. Does the old control signal bring as much as is drawn now?"
)
def _(u_0):
    return {"u": u_0}


@bunker.mistake(
    "As long as the belt still brings what the feeder dropped before, only one of the two flows has changed. What does "
    "that do to the level?"
)
def _(change):
    return {"level": "rises" if change > 0 else "falls"}


bunker.hints(
    "What the controller does now arrives at the bunker only after the delay. Set up the mass balance of the bunker "
    "for the time until then.",
    "The delay is length over speed. Until it is over, the inflow is the old one, $w_0$, and the outflow is "
    "$w_0\\,(1 + p/100)$ with the change $p$ in percent. In the end, both flows are equal again.",
    "So $\\tau = \\frac{ {length} }{ {speed} }$, in seconds, and the mass changes by $\\Delta m = (w_0 - "
    "w_{out})\\,\\tau$ with $w_0 = {w_0}$ and $w_{out} = {w_0}\\,(1 + \\frac{ {change} }{100})$, in kg/s. How many "
    "percent of control signal bring that much?",
)


@bunker.solution
def _(length, speed, w_0, change):
    """The gravel is on the belt for length over speed, $\\tau = {length}/{speed} =$ {tau}.

    From now on {w_out} flow out. Until the delay is over, only gravel arrives that was on the belt before, at the old
    rate, {w_0}. So the mass changes at a constant rate of {w_0} minus {w_out}, which is {rate}, and in {tau} by

    $$\\Delta m = {rate} \\cdot {tau} = {dm}$$

    in kilograms: the level {level}.

    In the end the level rests at its setpoint, so as much arrives as flows out. The feeder gives $w_0/u_0$ for each
    percent, so its control signal grows in proportion to the flow: $u = {u_0} \\cdot {w_out}/{w_0} =$ {u}.
    """
    w_out = w_0 * (1 + change / 100)
    return {"w_out": (w_out, "kg/s"), "rate": (w_0 - w_out, "kg/s")}


@exercise(
    "1.4",
    title="Nobody looks at the tank",
    points=4,
    insight="A tank adds up what is missing in its balance. Without control, nothing brings it back.",
    where=lambda A, h_0, h_low, more: h_low <= h_0 / 2 and A * (h_0 - h_low) * 1000 / more >= 600,
)
def left_alone(
    A=between(4, 20, "m²", reference=8),
    h_0=between(2, 5, "m", reference=3, step=0.25),
    h_low=between(0.5, 1.5, "m", reference=0.6, step=0.1),
    q=between(6, 15, "L/s", reference=10),
    more=between(2, 8, "L/s", reference=5, step=0.5),
):
    r"""The fire-water tank of a harbour has upright walls and a cross-section of {A}. Its level is at {h_0}, and stays
    there as long as the pump delivers as much as is drawn, {q}. At $t = 0$ somebody opens one more hydrant, which takes
    {more}, and nobody touches the pump.

    How does the level $h(t)$ [m] continue, with $t$ in seconds, until the tank is empty? And when does it reach the
    alarm at {h_low}?
    """
    rate = more / 1000 / A
    return answers(
        h=time_function(h_0 - rate * t, until=h_0 / rate, unit="m", what="the level"),
        t_alarm=number((h_0 - h_low) / rate / 60, "min", "the time of the alarm"),
    )


@left_alone.picture
def _(A, h_0, h_low, q, more):
    """A tank of {A} with the level {h_0}: a pump brings {q}, {q} are drawn, and a hydrant takes {more} besides."""
    layout = """
        water  pump  in    1     .     .      .
        .      .     .     tank  tank  .      .
        .      .     .     tank  tank  .      drawn
        .      .     .     tank  tank  valve  hydrant
        .      .     .     tank  tank  LAL    alarm"""
    parts = {"pump": draw.pump(), "valve": draw.valve(kind="hand")}
    parts["tank"] = draw.tank(f"${written(A)}$ m²", level=f"${written(h_0)}$ m", filled=0.9)
    names = {
        "in": f"${written(q)}$ L/s",
        "alarm": f"at ${written(h_low)}$ m",
        "drawn": f"${written(q)}$ L/s",
        "hydrant": f"${written(more)}$ L/s",
    }
    pipes = "water pump in 1 tank drawn, tank valve hydrant"
    return draw.instrumentation_diagram(layout, pipes, "tank LAL", parts, names)


@left_alone.mistake("The pump is still running. What is missing in the balance is the difference of the two flows.")
def _(A, h_0, h_low, q, more):
    rate = (q + more) / 1000 / A
    return {"h": h_0 - rate * t, "t_alarm": (h_0 - h_low) / rate / 60}


@left_alone.mistake("That is what the pump delivers. How much more than that is drawn?")
def _(A, h_0, h_low, q, more):
    rate = q / 1000 / A
    found = {"h": h_0 - rate * t, "t_alarm": (h_0 - h_low) / rate / 60}
    return found if abs(q / more - 1) > Rational(1, 20) else {}


def _is_told_twice(h_0, h_low, q, more):
    """Whether the way down to the alarm at a wrong rate takes as long as that to the bottom at the right one."""
    return not _apart(h_0 / more * abs(q - more), h_0 - h_low)


def _without_the_old_outflow(sign):
    """The balance of the pump and the new hydrant alone, with either sign."""

    def wrong(A, h_0, h_low, q, more):
        rate = abs(q - more) / 1000 / A
        if rate == 0 or not _apart(abs(q - more), more, q):
            return {}
        minutes = {} if _is_told_twice(h_0, h_low, q, more) else {"t_alarm": (h_0 - h_low) / rate / 60}
        return {"h": h_0 + sign * rate * t} | minutes

    return wrong


for _sign in (-1, 1):
    left_alone.mistake("What the pump delivers was drawn already before. By how much do the two flows differ now?")(
        _without_the_old_outflow(_sign)
    )


@left_alone.mistake(
    "An exponential belongs to an outflow that grows with the level. Does the flow through the hydrant change here?"
)
def _(A, h_0, h_low, q, more):
    T = h_0 / (more / 1000 / A)
    minutes, flows = T * math.log(h_0 / h_low) / 60, {more, q, q + more, abs(q - more)} - {0}
    others = [h_0 / (more / 1000 / A) / 60, *((h_0 - h_low) / (flow / 1000 / A) / 60 for flow in flows)]
    return {"h": h_0 * exp(-t / T)} | ({"t_alarm": minutes} if _apart(minutes, *others) else {})


@left_alone.mistake("That is how far the level falls in this time. Where is it at the beginning?")
def _(A, more):
    return {"h": -more / 1000 / A * t}


@left_alone.mistake("The level does not fall by the height of the alarm, but down to it.")
def _(A, h_0, h_low, q, more):
    wrong, right = h_low / more, (h_0 - h_low) / more
    others = [right, (h_0 - h_low) / q, (h_0 - h_low) / (q + more)]
    return {"t_alarm": 1000 * A * wrong / 60} if _apart(wrong, *others) else {}


@left_alone.mistake("That is the time until the tank is empty. The alarm comes earlier.")
def _(A, h_0, h_low, q, more):
    return {} if _is_told_twice(h_0, h_low, q, more) else {"t_alarm": h_0 * A * 1000 / more / 60}


@left_alone.mistake("How far does the level fall until the alarm, and at which rate?")
def _(A, h_0, h_low, q, more):
    return {"t_alarm": h_0 * A * 1000 / more / 60} if _is_told_twice(h_0, h_low, q, more) else {}


@left_alone.mistake("A litre is not a cubic metre. Put the flow into m³/s before you divide it by the area.")
def _(A, h_0, h_low, more):
    return {"h": h_0 - more * t / A, "t_alarm": (h_0 - h_low) * A / more / 60}


@left_alone.mistake("In the formula, $t$ is in seconds. Did you count minutes?")
def _(A, h_0, more):
    return {"h": h_0 - 60 * more / 1000 / A * t}


@left_alone.mistake("Which way does the level go when more is drawn than the pump delivers?")
def _(A, h_0, more):
    return {"h": h_0 + more * t / 1000 / A}


left_alone.hints(
    "Mass balance, or volume balance for a constant density: what is in the tank changes at the rate inflow minus "
    "outflow.",
    "With the cross-section $A$, the rate of the level is $\\dot h = (q_{in} - q_{out})/A$. Before $t = 0$ both flows "
    "were equal, so what remains is the flow that is new. It is constant: the level is a straight line.",
    "In cubic metres per second the new flow is ${more}/1000$, and $\\dot h = -\\frac{ {more}/1000}{ {A} }$, in m/s. "
    "At $t = 0$ the level is {h_0}.",
)


@left_alone.solution
def _(A, h_0, h_low, q, more):
    """Until $t = 0$ the balance was even: {q} in, {q} out. Now {more} more flow out, and the pump does not respond.
    A litre is a thousandth of a cubic metre, so with the cross-section {A} the level falls at

    $$\\frac{ {more}/1000}{ {A} } = {rate}$$

    in metres per second. The rate is constant, the level is a straight line that begins at {h_0}: $h(t) = {line}$.

    The alarm comes when the level has fallen from {h_0} to {h_low}, by {fall}. At the rate above this takes
    {seconds}, which is {t_alarm}.
    """
    rate = more / 1000 / A
    return {
        "rate": float(rate),
        "line": h_0 - rate * t,
        "fall": (h_0 - h_low, "m"),
        "seconds": ((h_0 - h_low) / rate, "s"),
    }


@left_alone.solution_picture
def _(A, h_0, h_low, more):
    """The level falls along a straight line, past the alarm, until the tank is empty."""
    rate = more / 1000 / A
    times = np.linspace(0, float(h_0 / rate), 101)
    plot = time_plot({"$h$": (h_0 - rate * t, "measurement")}, times, ylabel="$h$ [m]")
    return plot.level(h_low, "alarm").mark((h_0 - h_low) / rate, "the alarm")


def _silo(h_SP, above, left, period):
    """The level after a step of the setpoint: a first swing `above`, and then one of `left` times as much."""
    times = np.linspace(0, 2.5 * float(period), 501)
    step, omega = float(above / left), 2 * np.pi / float(period)
    decay = -2 * np.log(float(left)) / float(period)
    swing = np.cos(omega * times) + decay / omega * np.sin(omega * times)
    return times, float(h_SP) - step * np.exp(-decay * times) * swing


@exercise(
    "1.5",
    title="Is this loop calm enough?",
    points=4,
    where=lambda above, below: 0.56 <= below / above <= 0.94,
    insight="Two swings of a trend tell how well a loop is damped: no model, no formula, only a ruler.",
)
def swings(
    above=between(0.4, 1.2, "m", reference=0.8, step=0.05),
    below=between(0.3, 1.1, "m", reference=0.6, step=0.05),
    Kp=between(1, 4, "", reference=2, step=0.2),
    Ti=between(4, 20, "min", reference=8),
    h_SP=between(5, 8, "m", reference=6, step=0.5),
    above_now=between(0.4, 0.8, "m", reference=0.6, step=0.05),
    left_now=choice(0.2, 0.25, 0.3, 0.35, 0.4, 0.65, 0.68, 0.71, 0.74, 0.78, reference=0.4),
    period=between(30, 60, "min", reference=40),
):
    """The level in a silo gets a new setpoint and oscillates around it: first {above} beyond the setpoint, then
    {below} to the other side. The level is controlled in percent, with a gain of {Kp} (percent by percent) and an
    integral time of {Ti}.

    How much of a swing is left in the next one? By the limit of Section 1.4, half of a swing, this is poor damping.
    Which settings follow from the present ones by the advice of that section? (Type a gain of 5 and an integral time
    of 3 min as `PID(5, 3)`.)

    A colleague has tried settings of his own. The picture shows what they do when the setpoint becomes {h_SP}. Lay a
    ruler on it: how much of a swing is left in the next one now, and is the loop well damped or poorly damped?
    (`t, h = exercise("1.5").given("t", "h")` are its times [min] and levels [m].)
    """
    return answers(
        left=number(below / above, "", "the part of a swing that is left in the next one, before"),
        settings=settings(PID(Kp / 2, Ti * 2), gain="", time="min", what="the settings by the advice", form="any"),
        left_now=number(left_now, "", "the part of a swing that is left in the picture", within=0.1),
        damping=word(
            "poorly damped" if left_now > 0.5 else "well damped",
            ["well damped", "poorly damped"],
            what="the verdict on the picture",
        ),
    )


@swings.shows
def _(h_SP, above_now, left_now, period):
    times, levels = _silo(h_SP, above_now, left_now, period)
    return {"t": times, "h": levels}


@swings.picture
def _(h_SP, above_now, left_now, period):
    """The level overshoots its new setpoint, falls below it, and so on, each time less far."""
    times, levels = _silo(h_SP, above_now, left_now, period)
    signals = {"setpoint": (h_SP, "setpoint"), "$h$": (levels, "measurement")}
    return time_plot(signals, times, "A new setpoint at $t = 0$", xlabel="$t$ [min]", ylabel="$h$ [m]")


@swings.mistake("Those are the present settings of the controller. Are the swings of this loop within the limit?")
def _(Kp, Ti):
    return {"settings": PID(Kp, Ti)}


@swings.mistake("The advice changes both settings, each in its own direction: what does more gain do to the swings?")
def _(Kp, Ti):
    return {"settings": PID(Kp * 2, Ti / 2)}


@swings.mistake("Only one of the two settings has been changed. The advice of Section 1.4 changes both.")
def _(Kp, Ti):
    return {"settings": PID(Kp / 2, Ti)}


@swings.mistake("Only one of the two settings has been changed. The advice of Section 1.4 changes both.")
def _(Kp, Ti):
    return {"settings": PID(Kp, Ti * 2)}


@swings.mistake("The gain has the right direction. What does a shorter integral time do to the swings?")
def _(Kp, Ti):
    return {"settings": PID(Kp / 2, Ti / 2)}


@swings.mistake("That is by how much the next swing is smaller. How much of it is left?")
def _(above, below, left_now):
    gone = {"left": 1 - below / above}
    return gone | {"left_now": 1 - left_now} if abs((1 - left_now) / left_now - 1) > 0.15 else gone


@swings.mistake("What is left of a swing is less than all of it. Which swing comes first, and which is the next one?")
def _(above, below, left_now):
    return {"left": above / below, "left_now": 1 / left_now}


@swings.mistake("Those are two levels, one over the other. From which line is a swing measured?")
def _(h_SP, above_now, left_now):
    levels = (h_SP - above_now * left_now) / (h_SP + above_now)
    return {"left_now": levels} if abs(levels / left_now - 1) > 0.15 else {}


@swings.mistake("Those are two swings to the same side. The next swing of a level above its setpoint is one below it.")
def _(left_now):
    return {"left_now": left_now**2}


@swings.mistake("That is a difference in metres. Which part of the first swing is the next one?")
def _(above, below):
    gone = above - below
    return {"left": gone} if _apart(gone, below / above, 1 - below / above) else {}


@swings.mistake("Half of a swing is the limit. Is what you have read more, or less?")
def _(left_now):
    return {"damping": "well damped" if left_now > 0.5 else "poorly damped"}


swings.hints(
    "A swing is how far the level goes beyond its setpoint, to one side. Compare each swing with the next one, which "
    "is to the other side.",
    "What is left is the second swing divided by the first. The advice of Section 1.4 makes a loop calmer by a smaller "
    "gain and a longer integral time. By which factors?",
    "Before: $\\frac{ {below} }{ {above} }$. In the picture, measure both swings from the line at {h_SP}: from "
    "there up to the first peak, and from there down to the trough behind it.",
)


@swings.solution
def _(Kp, Ti, above_now, left_now):
    """The second swing as a part of the first is ${below}/{above} =$ {left}, more than a half.

    The advice for a loop that oscillates too much is half the gain and twice the integral time: {Kp_new} instead of
    {Kp}, and {Ti_new} instead of {Ti}.

    In the picture the level goes {above_now} beyond its setpoint, and then {below_now} to the other side. So
    ${below_now}/{above_now} =$ {left_now} of a swing is left, {compared} than a half: the loop is {damping}.
    """
    return {
        "Kp_new": Kp / 2,
        "Ti_new": (2 * Ti, "min"),
        "below_now": (above_now * left_now, "m"),
        "compared": "more" if left_now > 0.5 else "less",
    }


@swings.solution_picture
def _(h_SP, above_now, left_now, period):
    """The picture of the statement, with the two swings marked that are compared."""
    times, levels = _silo(h_SP, above_now, left_now, period)
    signals = {"setpoint": (h_SP, "setpoint"), "$h$": (levels, "measurement")}
    plot = time_plot(signals, times, "Two swings, one after the other", xlabel="$t$ [min]", ylabel="$h$ [m]")
    return plot.mark(period / 2, "first", signal="$h$").mark(period, "next", signal="$h$")


def _gain_limits(reach, sigma, per_percent, more, e_max, u_max):
    """The gains between which both wishes come true."""
    return more / per_percent * reach / e_max, u_max * reach / sigma


@exercise(
    "1.6",
    title="A gain between error and noise",
    points=5,
    insight="More gain, less error, more noise: every tuning is a choice between what you want and what you can bear.",
    where=lambda reach, sigma, per_percent, more, e_max, u_max: (
        1.5 <= u_max * reach / sigma / (more / per_percent * reach / e_max) <= 5
    ),
)
def gain_between(
    reach=between(2, 6, "m", reference=4, step=0.5),
    sigma=between(1, 4, "cm", reference=2, step=0.5),
    per_percent=choice(0.1, 0.15, 0.2, 0.25, 0.3, 0.4, unit="L/s", reference=0.2),
    more=between(1, 5, "L/s", reference=2, step=0.5),
    e_max=between(5, 30, "cm", reference=20),
    u_max=between(1, 4, "%", reference=2, step=0.5),
):
    """A tank is filled by a pump: one percent of control signal is {per_percent} of water. A controller with a gain
    $K_p$ alone (percent by percent, no integral term) keeps the level, and all is at rest, with the level at its
    setpoint. The transmitter measures over a range of {reach}; its noise has a standard deviation of {sigma}, and there
    is no filter.

    Choose $K_p$ for two wishes at once. When {more} more are drawn from the tank, for good, the error that stays
    should not be larger than {e_max}. And the standard deviation of the control signal, which the noise causes,
    should not be larger than {u_max}.
    """
    low, high = (float(x) for x in _gain_limits(reach, sigma, per_percent, more, e_max, u_max))
    stays, trembles = low * float(e_max), float(u_max) / high

    def error_that_stays(Kp):
        return stays / Kp

    def noise_in_control_signal(Kp):
        return trembles * Kp

    def against_both_limits(Kp):
        gains = np.linspace(low / 2, max(1.3 * high, 1.1 * Kp), 200)
        curves = {"error that stays": (gains, low / gains), "noise of the control signal": (gains, gains / high)}
        plot = plane_plot(curves, "$K_p$", "part of what is allowed", "Both should be at most 1")
        return plot.line([gains[0], gains[-1]], [1, 1], "limit", role="setpoint").points(
            [Kp, Kp], [low / Kp, Kp / high], "your gain"
        )

    return answers(
        Kp=design(
            number(math.sqrt(low * high), "", "the gain"),
            criterion("the gain is positive", lambda Kp: Kp > 0),
            criterion("the error that stays", error_that_stays, below=float(e_max), unit="cm"),
            criterion(
                "the standard deviation of the control signal", noise_in_control_signal, below=float(u_max), unit="%"
            ),
            draws=against_both_limits,
        )
    )


@gain_between.picture
def _(reach, sigma, per_percent):
    """A tank with its level controller: the transmitter has a range of {reach} and a noise of {sigma}; a pump, of which
    one percent is {per_percent}, fills the tank."""
    layout = """
        .      .     .     K_p   .
        .      1     .     LC    .
        water  pump  2     .     .
        .      .     tank  LT    reach
        .      .     tank  .     drawn"""
    pump = draw.pump(f"${written(per_percent)}$ L/s\nfor $1\\,\\%$")
    parts = {"pump": pump, "tank": draw.tank(level="h")}
    names = {"reach": f"$0$ to ${written(reach)}$ m,\nnoise ${written(sigma)}$ cm"}
    pipes, signals = "water pump 2 tank drawn", "tank LT LC 1 pump, K_p LC"
    return draw.instrumentation_diagram(layout, pipes, signals, parts, names)


@gain_between.mistake(
    "The controller works in percent of the measurement range. How many percent are the centimetres of the error?"
)
def _(reach, per_percent, more, e_max):
    return {"Kp": more / per_percent / e_max}


@gain_between.mistake("The gain is in percent by percent. How many percent of the range are the metres of the error?")
def _(per_percent, more, e_max):
    return {"Kp": 100 * more / per_percent / e_max}


@gain_between.mistake("The gain is in percent by percent. How many percent of the range are the metres of the noise?")
def _(sigma, u_max):
    return {"Kp": 100 * u_max / sigma}


@gain_between.mistake(
    "The gain multiplies an error in percent and gives a control signal in percent. How many percent of control signal "
    "bring the water that is missing?"
)
def _(reach, sigma, per_percent, more, e_max, u_max):
    wrong = more * reach / e_max
    return {"Kp": wrong} if _apart(wrong, more / per_percent / e_max, u_max / sigma) else {}


@gain_between.mistake("The range is in metres, the error in centimetres. How many centimetres are one percent of it?")
def _(reach, per_percent, more, e_max):
    return {"Kp": more / per_percent * reach / e_max / 100}


@gain_between.mistake(
    "That would be the limit of the noise for a measurement in centimetres. The controller sees percent of the range."
)
def _(reach, sigma, per_percent, more, e_max, u_max):
    low, high = _gain_limits(reach, sigma, per_percent, more, e_max, u_max)
    return {"Kp": u_max / sigma} if high / reach < low * 0.98 else {}


gain_between.hints(
    "Each wish is a limit of the gain, one from below and one from above. Which one is which?",
    "With a gain alone, $u - u_0 = K_p e$: at rest, the error that stays makes the control signal that is needed. And "
    "the noise goes through the same gain. Put everything into percent first, levels in percent of the range.",
    "The pump needs $\\Delta u = \\frac{ {more} }{ {per_percent} }$ percent more. An error of {e_max} is "
    "$\\frac{ {e_max} }{ {reach} }$ percent of the range, and the noise has $\\frac{ {sigma} }{ {reach} }$ percent.",
)


@gain_between.solution
def _(reach, sigma, per_percent, more, e_max, u_max):
    """**The error.** To deliver {more} more, the pump needs $\\Delta u = {more}/{per_percent} =$ {du} more control
    signal. Without an integral term, only an error can keep it there: $K_p e = \\Delta u$. One percent of the range
    of {reach} is as many centimetres as the range has metres, so {e_max} are {e_percent}, and

    $$K_p \\geq \\frac{ {du} }{ {e_percent} } = {low}$$

    **The noise.** Its standard deviation of {sigma} is {noise} of the range. The gain multiplies it, and at most
    {u_max} are allowed:

    $$K_p \\leq \\frac{ {u_max} }{ {noise} } = {high}$$

    Any gain between the two will do. The geometric mean, {Kp}, has the same reserve to both sides.
    """
    low, high = _gain_limits(reach, sigma, per_percent, more, e_max, u_max)
    return {
        "du": (more / per_percent, "%"),
        "e_percent": (e_max / reach, "%"),
        "noise": (sigma / reach, "%"),
        "low": low,
        "high": high,
    }


FAULTS = ["at a limit", "wrong action", "no integral term", "oscillation"]
#: The control signal of the pump stays between these, in percent.
SLOWEST, FASTEST = 20.0, 100.0
NIGHT = np.linspace(0, 180, 721)
#: How fast one percent of control signal fills the tower, in metres a minute, and how high it is.
FILLING, HEIGHT = 0.003, 4.0


def _night(h_SP, u_0, Kp, t_load, size, outflow, fault):
    """Level and control signal of a water tower; `size` is by how many percent the pump would have to go up or down."""
    setpoint, start, gain = float(h_SP), float(u_0), float(Kp)
    missing = float(size) if outflow == "larger" else -float(size)
    if fault == "at a limit":  # two or three percent more than the pump can give, or than it can be held back
        missing = (FASTEST - start if missing > 0 else SLOWEST - start) + 0.13 * missing
    time_of_integration = 25.0 if fault == "at a limit" else np.inf
    sign = -1 if fault == "wrong action" else 1
    level, integral, h, u = setpoint, 0.0, [], []
    step = NIGHT[1] - NIGHT[0]
    for now in NIGHT:
        error = 100 * (setpoint - level) / HEIGHT
        control = start + sign * gain * (error + integral / time_of_integration)
        limited = min(max(control, SLOWEST), FASTEST)
        integral += error * step if control == limited else 0.0
        h.append(level)
        u.append(limited)
        balance = limited - start - (missing if now >= t_load else 0.0)
        level = min(max(level + FILLING * balance * step, 0.0), HEIGHT)
    return np.array(h), np.array(u)


@exercise(
    "1.7",
    title="What happened in the night?",
    points=4,
    insight="A trend is read from the left: what moved first, what responded to it, and did the response help?",
)
def night(
    h_SP=between(1.6, 2.4, "m", reference=2, step=0.2),
    u_0=between(52, 68, "%", reference=60, step=2),
    Kp=choice(0.8, 0.9, 1, 1.1, 1.2, reference=1),
    t_load=between(30, 75, "min", reference=40, step=1),
    size=between(16, 24, "%", reference=20, step=1),
    outflow=choice("larger", "smaller"),
    fault=choice(*FAULTS[:3], reference="wrong action"),
):
    """A pump fills a water tower, and a controller keeps the level at {h_SP}. Its control signal can go from 20 %
    to 100 %, and the tower is 4 m high. In the morning you find the trend of the picture. At some moment in the
    night the flow that is drawn from the tower has changed, and then remained as it was.

    When did it change, and has it become larger or smaller? How large is the control error at the right-hand edge?
    And what is wrong with this loop: is the control signal at a limit that is too narrow for what is drawn ("at a
    limit"), does the controller move the pump in the wrong direction ("wrong action"), does it work without an
    integral term ("no integral term"), or is it poorly damped ("oscillation")?

    (`t, h, u = exercise("1.7").given("t", "h", "u")` are the times [min], levels [m] and control signals [%].)
    """
    level, _ = _night(h_SP, u_0, Kp, t_load, size, outflow, fault)
    return answers(
        t_load=number(t_load, "min", "the moment at which the outflow changes", within=0.06),
        outflow=word(outflow, ["larger", "smaller"], what="what the outflow has become"),
        e=number(float(h_SP) - level[-1], "m", "the control error at the right-hand edge", within=0.1),
        fault=word(fault, FAULTS, what="what is wrong"),
    )


@night.shows
def _(h_SP, u_0, Kp, t_load, size, outflow, fault):
    level, control = _night(h_SP, u_0, Kp, t_load, size, outflow, fault)
    return {"t": NIGHT, "h": level, "u": control}


@night.picture
def _(h_SP, u_0, Kp, t_load, size, outflow, fault):
    """Level with its setpoint, and control signal: both rest at first, and then they move."""
    return _night_trend(h_SP, u_0, Kp, t_load, size, outflow, fault, "The water tower in the night")


def _night_trend(h_SP, u_0, Kp, t_load, size, outflow, fault, title):
    level, control = _night(h_SP, u_0, Kp, t_load, size, outflow, fault)
    panels = [{"setpoint": (h_SP, "setpoint"), "$h$": (level, "measurement")}, {"$u$": (control, "control signal")}]
    names, ranges = ["$h$ [m]", "$u$ [%]"], [None, (10, 110)]
    return time_plot(panels, NIGHT, title, xlabel="$t$ [min]", ylabel=names, ylim=ranges)


@night.mistake("At that moment the control signal reaches its limit. When does the level begin to move?")
def _(h_SP, u_0, Kp, t_load, size, outflow, fault):
    _, control = _night(h_SP, u_0, Kp, t_load, size, outflow, fault)
    stopped = NIGHT[(control == SLOWEST) | (control == FASTEST)]
    return {"t_load": stopped[0]} if stopped.size and stopped[0] > 1.1 * t_load else {}


@night.mistake("At that moment the tower is full, or empty. When does the level begin to move?")
def _(h_SP, u_0, Kp, t_load, size, outflow, fault):
    level, control = _night(h_SP, u_0, Kp, t_load, size, outflow, fault)
    ends = NIGHT[(level <= 0) | (level >= HEIGHT)]
    stopped = NIGHT[(control == SLOWEST) | (control == FASTEST)]
    told = ends.size and ends[0] > 1.1 * t_load and not (stopped.size and abs(ends[0] / stopped[0] - 1) < 0.05)
    return {"t_load": ends[0]} if told else {}


@night.mistake("That is the level at the right-hand edge. How far is it from its setpoint, and on which side?")
def _(h_SP, u_0, Kp, t_load, size, outflow, fault):
    level, _ = _night(h_SP, u_0, Kp, t_load, size, outflow, fault)
    e = float(h_SP) - level[-1]
    return {"e": level[-1]} if abs(level[-1] - e) > 0.15 * abs(e) else {}


@night.mistake("That is the error in percent of the height of the tower. How many metres is it?")
def _(h_SP, u_0, Kp, t_load, size, outflow, fault):
    level, _ = _night(h_SP, u_0, Kp, t_load, size, outflow, fault)
    return {"e": 100 * (float(h_SP) - level[-1]) / HEIGHT}


@night.mistake(
    "Just after the change the controller has hardly done anything yet. Which way does the level go then, and what "
    "does that say about the balance?"
)
def _(outflow):
    return {"outflow": "smaller" if outflow == "larger" else "larger"}


@night.mistake("The control signal reaches a limit, but which one of the two? Does the pump help the level there?")
def _(fault):
    return {"fault": "at a limit"} if fault == "wrong action" else {}


@night.mistake("Does this control signal come to 20 % or to 100 % anywhere?")
def _(fault):
    return {"fault": "at a limit"} if fault == "no integral term" else {}


@night.mistake(
    "Compare the two curves behind the change: the level goes one way, and the pump is moved. Does that push the level "
    "back, or further away?"
)
def _(fault):
    return {"fault": "wrong action"} if fault != "wrong action" else {}


@night.mistake(
    "Without an integral term the control signal rests wherever the error keeps it. What keeps this one where it is?"
)
def _(fault):
    return {"fault": "no integral term"} if fault != "no integral term" else {}


@night.mistake("A level that oscillates crosses its setpoint again and again. How often does this one cross it?")
def _():
    return {"fault": "oscillation"}


night.hints(
    "Read from the left. Before anything happens both curves are flat. What moves first tells what has happened to the "
    "balance of the tower, and what moves next is what the controller makes of it.",
    "If more is drawn than the pump brings, the level falls. Then a controller that acts in the right direction raises "
    "its signal. Follow the pump: does it help? Does it stop at a value of its own, or at 20 % or 100 %?",
    "The control error is setpoint minus level, $e = {h_SP} - h$ in metres, read at $t$ = 180 min. An error that stays "
    "has three usual reasons: the pump cannot do more, it is moved the wrong way, or nothing adds up the error.",
)


@night.solution
def _(h_SP, u_0, Kp, t_load, size, outflow, fault):
    """Until {t_load} both curves are flat: the balance is even. Then the level begins to {moves}, before the
    controller has done anything. So {cause} is drawn, and the outflow has become {outflow}.

    At the right-hand edge the level is at {level}, so the control error is setpoint minus level, ${h_SP} - {level}
    =$ {e}.

    The pump should run {needed} now. {verdict} The fault is: {fault}.
    """
    more = outflow == "larger"
    level, _ = _night(h_SP, u_0, Kp, t_load, size, outflow, fault)
    verdicts = {
        "at a limit": "It does, as far as it can: the control signal goes to {limit} and stays there, and that does "
        "not suffice for what is drawn.",
        "wrong action": "But the control signal goes the other way, which makes the balance worse, the error larger, "
        "and the control signal goes on until it is at its limit, at the wrong end.",
        "no integral term": "It does, and the level comes to rest, but beside its setpoint: a gain alone needs an "
        "error to keep the control signal away from the old value, and nothing adds up the error that stays.",
    }
    return {
        "level": (level[-1], "m"),
        "moves": "fall" if more else "rise",
        "cause": "more than the pump brings" if more else "less than the pump brings",
        "needed": "faster" if more else "more slowly",
        "verdict": verdicts[fault].replace("{limit}", "100 %" if more else "20 %"),
    }


def _new_level(h_1, h_2, reach, Kp, zeta, per_percent, u_0):
    """Trend of a tank with a PI controller, from one setpoint to another at 10 min: times, level, control signal.

    A tank is an integrator: error and control signal obey s² + 2ζω s + ω², with 2ζω = Kp times its rate per percent.
    """
    damping = float(Kp * per_percent) / 2
    omega = damping / float(zeta)
    swing = math.sqrt(omega**2 - damping**2)
    before, after = np.linspace(0, 9.9999, 41), np.linspace(0, 5 / damping, 401)
    fades, angle = np.exp(-damping * after), swing * after
    step = float(h_2 - h_1)
    error = step * fades * (np.cos(angle) - damping / swing * np.sin(angle))
    added = step * fades * np.sin(angle) / swing * omega**2 / (2 * damping)
    control = float(u_0) + float(Kp) * 100 / float(reach) * (error + added)
    times = np.r_[before, 10 + after]
    level = np.r_[np.full(before.shape, float(h_1)), float(h_2) - error]
    return times, level, np.r_[np.full(before.shape, float(u_0)), control]


def _read(zeta, Kp, per_percent):
    """When the setpoint is reached first, in minutes after the step, and the overshoot as a part of the step."""
    angle, ratio = math.acos(zeta), float(zeta) / math.sqrt(1 - float(zeta) ** 2)
    swing = float(Kp * per_percent) / 2 / ratio
    return angle / swing, math.exp(-2 * angle * ratio)


@exercise(
    "1.8",
    title="A new level, read with a ruler",
    points=4,
    where=lambda h_1, h_2, reach, Kp, u_0: (
        h_2 <= reach * 4 / 5
        and 8 <= Kp * (h_2 - h_1) / reach * 100 <= 78 - u_0
        and h_2 - h_1 >= 0.4
        and abs(h_2 - h_1 - 1) >= 0.2
    ),
    insight="The first jump of the control signal is the gain at work: the integral has had no time yet.",
)
def new_level(
    h_1=between(1, 3, "m", reference=2, step=0.2),
    h_2=between(1.6, 4, "m", reference=2.6, step=0.2),
    reach=between(4, 8, "m", reference=5, step=1),
    Kp=between(1.2, 4, "", reference=2, step=0.2),
    zeta=choice(0.35, 0.4, 0.45, 0.5, 0.55, 0.6, 0.65, 0.7, reference=0.5),
    per_percent=choice(0.02, 0.025, 0.03, 0.04, unit="%/min per %", reference=0.03),
    u_0=between(30, 50, "%", reference=40, step=2),
):
    """A PI controller keeps the level in a tank by the pump that fills it. It works in percent, of the measurement
    range from zero to {reach} and of the control signal. After ten quiet minutes the setpoint is raised from {h_1}
    to {h_2}. The picture shows what happens. The flow out of the tank is constant all the time.

    Read with a ruler: how long after the step is the level at its new setpoint for the first time? How far does it go
    beyond it, in percent of the step? Which gain (percent by percent) does the controller have? And where does the
    control signal end?

    (`t, h, u = exercise("1.8").given("t", "h", "u")` are the times [min], levels [m] and control signals [%].)
    """
    t_rise, overshoot = _read(zeta, Kp, per_percent)
    return answers(
        t_rise=number(t_rise, "min", "the time from the step to the first moment at the new setpoint", within=0.08),
        overshoot=number(100 * overshoot, "%", "the overshoot, in percent of the step", within=0.1),
        Kp=number(Kp, "", "the gain, percent by percent", within=0.1),
        u_end=number(u_0, "%", "the control signal in the end", within=0.05),
    )


@new_level.shows
def _(h_1, h_2, reach, Kp, zeta, per_percent, u_0):
    times, level, control = _new_level(h_1, h_2, reach, Kp, zeta, per_percent, u_0)
    return {"t": times, "h": level, "u": control}


@new_level.picture
def _(h_1, h_2, reach, Kp, zeta, per_percent, u_0):
    """The setpoint makes a step, the level rises beyond it and comes back; the control signal jumps and returns."""
    return _new_level_trend(h_1, h_2, reach, Kp, zeta, per_percent, u_0, "A new setpoint after ten minutes")


def _new_level_trend(h_1, h_2, reach, Kp, zeta, per_percent, u_0, title):
    times, level, control = _new_level(h_1, h_2, reach, Kp, zeta, per_percent, u_0)
    setpoint = np.where(times < 10, float(h_1), float(h_2))
    panels = [{"setpoint": (setpoint, "setpoint"), "$h$": (level, "measurement")}, {"$u$": (control, 0)}]
    return time_plot(panels, times, title, xlabel="$t$ [min]", ylabel=["$h$ [m]", "$u$ [%]"])


@new_level.mistake("That is the time on the axis. When does the setpoint make its step?")
def _(zeta, Kp, per_percent):
    return {"t_rise": _read(zeta, Kp, per_percent)[0] + 10}


@new_level.mistake("That is the moment of the highest level. When does it pass the setpoint for the first time?")
def _(zeta, Kp, per_percent):
    t_rise, _ = _read(zeta, Kp, per_percent)
    return {"t_rise": 2 * t_rise} if abs(2 * t_rise / (t_rise + 10) - 1) > 0.18 else {}


@new_level.mistake("That is the highest level as a part of the step. How far is it beyond the new setpoint?")
def _(zeta, Kp, per_percent):
    return {"overshoot": 100 * (1 + _read(zeta, Kp, per_percent)[1])}


@new_level.mistake("That is the overshoot in percent of the measurement range. What part of the step is it?")
def _(h_1, h_2, reach, zeta, Kp, per_percent):
    return {"overshoot": 100 * _read(zeta, Kp, per_percent)[1] * (h_2 - h_1) / reach}


@new_level.mistake("That is the overshoot in percent of the setpoint. What part of the step is it?")
def _(h_1, h_2, zeta, Kp, per_percent):
    return {"overshoot": 100 * _read(zeta, Kp, per_percent)[1] * (h_2 - h_1) / h_2}


@new_level.mistake("That is the overshoot in metres. What part of the step is it?")
def _(h_1, h_2, zeta, Kp, per_percent):
    return {"overshoot": _read(zeta, Kp, per_percent)[1] * (h_2 - h_1)}


@new_level.mistake("That is control signal for one metre of error. The controller sees percent of the range.")
def _(reach, Kp):
    return {"Kp": 100 * Kp / reach}


def _error_as_a_part_of(whole):
    def wrong(h_1, h_2, reach, Kp):
        return {"Kp": Kp * {"old": h_1, "new": h_2, "metre": 1}[whole] / reach}

    return wrong


for _whole in ("old", "new", "metre"):
    new_level.mistake("The controller sees percent of the measurement range. Of what are your percent of the error?")(
        _error_as_a_part_of(_whole)
    )


@new_level.mistake("That is the jump of the control signal in percent. By how many percent has the error jumped?")
def _(h_1, h_2, reach, Kp):
    return {"Kp": 100 * Kp * (h_2 - h_1) / reach}


@new_level.mistake("That is where the control signal jumps to, over the jump of the error. By how much does it jump?")
def _(h_1, h_2, reach, Kp, u_0):
    error = 100 * (h_2 - h_1) / reach
    wrong, others = Kp + u_0 / error, [100 * Kp / reach, Kp * error]
    return {"Kp": wrong} if all(abs(wrong / other - 1) > 0.15 for other in others) else {}


@new_level.mistake(
    "That is where the control signal jumps to. Where is it when the level rests, with the same outflow?"
)
def _(h_1, h_2, reach, Kp, u_0):
    return {"u_end": u_0 + 100 * Kp * (h_2 - h_1) / reach}


@new_level.mistake("That is the lowest control signal. Where is it when nothing moves any more?")
def _(h_1, h_2, reach, Kp, zeta, per_percent, u_0):
    _, _, control = _new_level(h_1, h_2, reach, Kp, zeta, per_percent, u_0)
    return {"u_end": control.min()} if control.min() < 0.94 * u_0 else {}


new_level.hints(
    "Times are counted from the step, and swings from the new setpoint. For the gain look at the very first moment: "
    "which of the two terms of the controller has had no time yet?",
    "At the step, the error jumps by the whole step of the setpoint, and the integral is still what it was. So the "
    "jump of the control signal is $K_p$ times the jump of the error, both in percent. For the end, look at the "
    "balance of the tank: what must be equal when the level rests?",
    "The error jumps by $100\\,\\frac{ {h_2} - {h_1} }{ {reach} }$ percent of the range. Read off by how much the "
    "control signal jumps at 10 min, and divide.",
)


@new_level.solution
def _(h_1, h_2, reach, Kp, zeta, per_percent, u_0):
    """The level crosses the line of its new setpoint at {crossing}; the step is at 10 min, so this takes {t_rise}.

    The highest level is {highest}, which is {beyond} above the new setpoint. The step is {step} high, so the
    overshoot is $100\\cdot{beyond}/{step} =$ {overshoot}.

    At the step the error jumps from zero to {step}, which is {error} of the range of {reach}. The control signal
    jumps from {u_0} to {jump}, by {kick}. The integral has had no time yet, so this is the gain alone: $K_p =
    {kick}/{error} =$ {Kp}.

    In the end the level rests again. The outflow is what it has always been, so the inflow is, too: the control
    signal ends where it began, at {u_end}. Only in between has it been larger, to bring the water that now is in
    the tank.
    """
    t_rise, overshoot = _read(zeta, Kp, per_percent)
    step = h_2 - h_1
    error = 100 * step / reach
    return {
        "crossing": (10 + t_rise, "min"),
        "highest": (float(h_2) + overshoot * float(step), "m"),
        "beyond": (overshoot * float(step), "m"),
        "step": (step, "m"),
        "error": (error, "%"),
        "jump": (u_0 + Kp * error, "%"),
        "kick": (Kp * error, "%"),
    }


@new_level.solution_picture
def _(h_1, h_2, reach, Kp, zeta, per_percent, u_0):
    """The picture of the statement, with the first moment at the setpoint and the highest level marked."""
    plot = _new_level_trend(h_1, h_2, reach, Kp, zeta, per_percent, u_0, "What is read off")
    t_rise, _ = _read(zeta, Kp, per_percent)
    return plot.mark(10 + t_rise, "at the setpoint", signal="$h$").mark(10 + 2 * t_rise, "highest", signal="$h$")
