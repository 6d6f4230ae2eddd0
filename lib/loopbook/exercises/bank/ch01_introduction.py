"""Exercises of chapter 1, introduction to control."""

import math

from sympy import Rational

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
        "r": "the 6 m that the water is to stand high",
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


@exercise("1.1", title="Who plays which part?", points=2)
def parts(
    plant=choice(*PLANTS, reference="a water tower"),
    page=choice(*PAGES, reference=12),
):
    """Somebody automates {plant} by feedback. On page {page} of the engineer's notebook stand four quantities:

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
    "Look at the arrows of the controller once more: one of the two goes into it, the other comes out of it."
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


def _pressure(low, high, I):
    return low + (I - 4) * (high - low) / 16


@exercise(
    "1.2",
    title="One error, two units",
    points=4,
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
    """The pressure of a compressed-air net is to be {p_SP}. Its transmitter sends 4 mA at {low} and 20 mA at {high},
    and in between the current follows a straight line. Now it sends {I}, and there is no noise.

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


@error_in_units.mistake("Look again at the current for the lower end of the range: it is not zero.")
def _(low, high, I, p_SP):
    p = low + I * (high - low) / 20
    return {"p": p, "e": p_SP - p, "e_percent": 100 * (p_SP - p) / (high - low)}


@error_in_units.mistake("At 4 mA the pressure is not zero: the range has a lower end.")
def _(low, high, I, p_SP):
    p = (I - 4) * (high - low) / 16
    return {"p": p, "e": p_SP - p, "e_percent": 100 * (p_SP - p) / (high - low)}


@error_in_units.mistake("That is a percentage of the setpoint. What percentage of the measurement range is it?")
def _(low, high, I, p_SP):
    e = p_SP - _pressure(low, high, I)
    wrong = 100 * e / p_SP
    others = [100 * e / (high - low), 100 * e / high, 100 * (e + low) / (high - low)]
    return {"e_percent": wrong} if all(abs(wrong / other - 1) > 0.03 for other in others) else {}


@error_in_units.mistake("The range does not begin at zero. How wide is it?")
def _(low, high, I, p_SP):
    return {"e_percent": 100 * (p_SP - _pressure(low, high, I)) / high}


@exercise("1.3", title="A bunker at the end of a belt", points=4)
def bunker(
    length=between(40, 160, "m", reference=90, step=5),
    speed=choice(0.5, 0.6, 0.8, 0.9, 1, 1.2, unit="m/s", reference=0.6),
    u_0=between(30, 50, "%", reference=40, step=2),
    w_0=between(12, 40, "kg/s", reference=24, step=2),
    change=choice(-40, -30, -25, -20, 10, 15, 20, 25, 30, 40, 50, unit="%", reference=25),
):
    """A vibrating feeder drops gravel onto a belt of {length} that runs at {speed} and ends above a bunker. The flow
    through the feeder is proportional to its control signal. For a long time the signal has been {u_0}, as much gravel
    has arrived as is drawn from the bunker, {w_0}, and the level has been at its setpoint. Then the flow out of the
    bunker {event}, for good.

    How long is the time delay of the belt? By how much does the mass in the bunker change within this time, whatever
    the controller does? (A loss is negative.) Which way does the level go first? And where does the control signal end
    when a PI controller has brought the level back to its setpoint?
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


@bunker.mistake(
    "A change in percent refers to the flow that changes. The control signal changes by the same fraction of its own "
    "value, which is a different number of percentage points."
)
def _(u_0, change):
    return {"u": u_0 + change}


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


@bunker.mistake("When more is drawn, more has to arrive in the end, and when less is drawn, less.")
def _(u_0, change):
    return {"u": u_0 * (1 - change / 100)} if change != 50 else {}


@bunker.mistake(
    "At rest, inflow and outflow are equal again. Does the old control signal bring as much as is drawn now?"
)
def _(u_0):
    return {"u": u_0}


@exercise(
    "1.4",
    title="Nobody looks at the tank",
    points=4,
    where=lambda A, h_0, h_low, more: h_low <= h_0 / 2 and A * (h_0 - h_low) * 1000 / more >= 600,
)
def left_alone(
    A=between(4, 20, "m²", reference=8),
    h_0=between(2, 5, "m", reference=3, step=0.25),
    h_low=between(0.5, 1.5, "m", reference=0.6, step=0.1),
    q=between(6, 15, "L/s", reference=10),
    more=between(2, 8, "L/s", reference=5, step=0.5),
):
    r"""The fire-water tank of a harbour has upright walls and a cross-section of {A}. A pump keeps its level at {h_0}:
    it delivers {q}, as much as is drawn. At $t = 0$ somebody opens one more hydrant, which takes {more}, and nobody
    touches the pump.

    How does the level $h(t)$ [m] go on, with $t$ in seconds, until the tank is empty? And when does the level reach
    the alarm at {h_low}?
    """
    rate = more / 1000 / A
    return answers(
        h=time_function(h_0 - rate * t, until=h_0 / rate, unit="m", what="the level"),
        t_alarm=number((h_0 - h_low) / rate / 60, "min", "the time of the alarm"),
    )


@left_alone.mistake("The pump is still running. What is missing in the balance is the difference of the two flows.")
def _(A, h_0, h_low, q, more):
    rate = (q + more) / 1000 / A
    return {"h": h_0 - rate * t, "t_alarm": (h_0 - h_low) / rate / 60}


@left_alone.mistake("That is what the pump delivers. How much more than that is drawn?")
def _(A, h_0, h_low, q, more):
    rate = q / 1000 / A
    found = {"h": h_0 - rate * t, "t_alarm": (h_0 - h_low) / rate / 60}
    return found if abs(q / more - 1) > Rational(1, 20) else {}


@left_alone.mistake("That is how far the level falls in this time. Where is it at the beginning?")
def _(A, more):
    return {"h": -more / 1000 / A * t}


@left_alone.mistake("The level does not fall by the height of the alarm, but down to it.")
def _(A, h_0, h_low, more):
    return {"t_alarm": h_low * A * 1000 / more / 60} if abs(h_low / (h_0 - h_low) - 1) > Rational(1, 20) else {}


@left_alone.mistake("That is the time until the tank is empty. The alarm comes earlier.")
def _(A, h_0, more):
    return {"t_alarm": h_0 * A * 1000 / more / 60}


@left_alone.mistake("A litre is not a cubic metre. Put the flow into m³/s before you divide it by the area.")
def _(A, h_0, h_low, more):
    return {"h": h_0 - more * t / A, "t_alarm": (h_0 - h_low) * A / more / 60}


@left_alone.mistake("In the formula, $t$ is in seconds. Did you count minutes?")
def _(A, h_0, more):
    return {"h": h_0 - 60 * more / 1000 / A * t}


@left_alone.mistake("Which way does the level go when more is drawn than the pump delivers?")
def _(A, h_0, more):
    return {"h": h_0 + more * t / 1000 / A}


def _is_poor(above, below):
    return below / above >= 0.5


@exercise(
    "1.5",
    title="Is this loop calm enough?",
    points=4,
    where=lambda above, below: below < above * 0.95 and abs(below / above - 0.5) > 0.06,
)
def swings(
    above=between(0.4, 1.2, "m", reference=0.8, step=0.05),
    below=between(0.05, 0.9, "m", reference=0.6, step=0.05),
    Kp=between(1, 4, "", reference=2, step=0.2),
    Ti=between(4, 20, "min", reference=8),
):
    """The level in a silo gets a new setpoint. The trend shows how it oscillates around it: first {above} beyond the
    setpoint, then {below} to the other side. The level is controlled in percent, with a gain of {Kp} (percent by
    percent) and an integral time of {Ti}.

    How much of a swing is left in the next one? Is the loop well damped or poorly damped by the limit of Section 1.4,
    half of a swing? Which settings do you leave in the controller: those that it has if it is well damped, and
    otherwise those that the advice of Section 1.4 makes of them?
    """
    poor = _is_poor(above, below)
    factor = 2 if poor else 1
    return answers(
        left=number(below / above, "", "the part of a swing that is left in the next one"),
        damping=word(
            "poorly damped" if poor else "well damped", ["well damped", "poorly damped"], what="the verdict on the loop"
        ),
        settings=settings(
            PID(Kp / factor, Ti * factor), gain="", time="min", what="the settings of the controller", form="any"
        ),
    )


@swings.mistake("The advice is for loops that oscillate too much, and for no others. Does this one?")
def _(above, below, Kp, Ti):
    return {} if _is_poor(above, below) else {"settings": PID(Kp / 2, Ti * 2)}


@swings.mistake("Those are the present settings of the controller. Are the swings of this loop within the limit?")
def _(above, below, Kp, Ti):
    return {"settings": PID(Kp, Ti)} if _is_poor(above, below) else {}


@swings.mistake("The advice changes both settings, each in its own direction: what does more gain do to the swings?")
def _(above, below, Kp, Ti):
    return {"settings": PID(Kp * 2, Ti / 2)} if _is_poor(above, below) else {}


@swings.mistake("Only one of the two settings has been changed. The advice of Section 1.4 changes both.")
def _(above, below, Kp, Ti):
    return {"settings": PID(Kp / 2, Ti)} if _is_poor(above, below) else {}


@swings.mistake("Only one of the two settings has been changed. The advice of Section 1.4 changes both.")
def _(above, below, Kp, Ti):
    return {"settings": PID(Kp, Ti * 2)} if _is_poor(above, below) else {}


@swings.mistake("That is how much smaller the next swing is. How much of it is left?")
def _(above, below):
    return {"left": 1 - below / above}


def _gain_limits(reach, sigma, per_percent, more, e_max, u_max):
    """The gains between which both wishes come true."""
    return more / per_percent * reach / e_max, u_max * reach / sigma


@exercise(
    "1.6",
    title="A gain between error and noise",
    points=5,
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
    $K_p$ alone (percent by percent, no integral term) keeps the level, and everything is at rest with the level at its
    setpoint. The transmitter measures the level over a range of {reach}; its noise has a standard deviation of
    {sigma}, and there is no filter.

    Choose $K_p$ for two wishes at once. When {more} more are drawn from the tank, for good, the error that stays should
    not be larger than {e_max}. And the standard deviation of the control signal, which the noise causes, should not be
    larger than {u_max}.
    """
    low, high = (float(x) for x in _gain_limits(reach, sigma, per_percent, more, e_max, u_max))
    stays, trembles = low * float(e_max), float(u_max) / high

    def error_that_stays(Kp):
        return stays / Kp

    def noise_in_control_signal(Kp):
        return trembles * Kp

    return answers(
        Kp=design(
            number(math.sqrt(low * high), "", "the gain"),
            criterion("the gain is positive", lambda Kp: Kp > 0),
            criterion("the error that stays", error_that_stays, below=float(e_max), unit="cm"),
            criterion(
                "the standard deviation of the control signal", noise_in_control_signal, below=float(u_max), unit="%"
            ),
        )
    )
