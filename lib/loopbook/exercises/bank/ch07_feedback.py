"""Exercises of chapter 7, feedback control."""

import math

from sympy import Symbol, pi

from loopbook.exercises.authoring import (
    answers,
    between,
    choice,
    criterion,
    design,
    exercise,
    expression,
    number,
    pi_controller,
    settings,
    stable,
    time_function,
    word,
)
from loopbook.expressions import t
from loopbook.pid import PID
from loopbook.stability import delay_margin, ultimate
from loopbook.transfer import first_order

ACTIONS = ["reverse", "direct"]


@exercise("7.1", title="Behind the percent of a boiler", points=2)
def boiler(
    p_low=between(1, 4, "bar", reference=2, step=1),
    p_high=between(8, 20, "bar", reference=12, step=1),
    y=between(25, 75, "%", reference=65, step=5),
    q_max=between(200, 800, "kg/h", reference=500, step=50),
    K_p=between(1, 4, reference=2, step=0.5),
):
    """The steam pressure of a boiler is measured between {p_low} and {p_high}. A current of 4 to 20 mA brings it to
    the controller, which works in percent of this range. Its control signal of 0 to 100 % becomes an oil flow to the
    burner of 0 to {q_max}.

    The panel shows a pressure of {y}. Find the pressure $p$ in bar and the current $I$ in the cable. The gain of the
    controller is {K_p}, percent for percent. What is its gain in engineering units, in kg/h of oil for each bar?
    """
    span = p_high - p_low
    return answers(
        p=number(p_low + y * span / 100, "bar", "the pressure"),
        I=number(4 + 16 * y / 100, "mA", "the current"),
        K_p=number(K_p * q_max / span, "(kg/h)/bar", "the gain in engineering units"),
    )


@boiler.mistake("The percentage counts from the lower end of the range. Which pressure is 0 %, and which is 100 %?")
def _(p_high, y):
    return {"p": y * p_high / 100}


@boiler.mistake("This pressure is how far it is above the lower end of the range; the lower end itself is missing.")
def _(p_low, p_high, y):
    return {"p": y * (p_high - p_low) / 100}


@boiler.mistake("This current would be zero at 0 %. But the range of the current does not begin at zero.")
def _(y):
    return {"I": 20 * y / 100}


@boiler.mistake(
    "This current is how far it is above the lower end of its range. At 0 % it would be zero, but it is not."
)
def _(y):
    return {"I": 16 * y / 100}


@boiler.mistake(
    "This is still percent for percent. How many bar are one percent of the one, how many kg/h of the other?"
)
def _(K_p):
    return {"K_p": K_p}


@boiler.mistake(
    "Watch the units: the gain is control signal for one unit of measurement, so one factor multiplies and one divides."
)
def _(p_low, p_high, q_max, K_p):
    return {"K_p": K_p * (p_high - p_low) / q_max}


@boiler.mistake("One percent of the pressure is a share of the range, and the range does not begin at zero.")
def _(p_high, q_max, K_p):
    return {"K_p": K_p * q_max / p_high}


@exercise("7.2", title="Which way to turn", points=2, where=lambda K_p, rise: K_p * rise <= 16)
def jacket(
    medium=choice("cooling water", "steam"),
    valve=choice("opens", "closes"),
    K_p=between(1, 4, reference=2, step=0.5),
    u_0=between(40, 60, "%", reference=50, step=5),
    rise=between(2, 8, "%", reference=5, step=1),
):
    """The temperature in a stirred vessel is controlled with {medium} in its jacket. The valve for the {medium}
    {valve} when its control signal rises. Which action does the controller need?

    Let it be a P controller with a gain of {K_p} in magnitude and a nominal control signal of {u_0}. With the right
    action, what is its control signal when the temperature has risen {rise} above its setpoint? (The signals are in
    percent, the gain is in percent for percent.)
    """
    return answers(
        action=word(_action(medium, valve), ACTIONS, "the action of the controller"),
        u=number(u_0 + _push(medium, valve) * K_p * rise, "%", "the control signal"),
    )


def _action(medium, valve):
    return "reverse" if (medium == "steam") == (valve == "opens") else "direct"


def _push(medium, valve):
    """The direction in which the control signal must go when the temperature has risen."""
    return -1 if _action(medium, valve) == "reverse" else 1


@jacket.mistake(
    "Let the temperature rise above the setpoint, and follow it around the loop: would this controller bring it back?"
)
def _(medium, valve):
    return {"action": next(action for action in ACTIONS if action != _action(medium, valve))}


@jacket.mistake("With this control signal the vessel would become even hotter. Which way does the valve have to move?")
def _(medium, valve, K_p, u_0, rise):
    return {"u": u_0 - _push(medium, valve) * K_p * rise}


@jacket.mistake("This is the proportional term, or its magnitude. From which value does the control signal start?")
def _(K_p, rise):
    return {"u": K_p * rise}


@jacket.mistake("This is the proportional term, or its magnitude. From which value does the control signal start?")
def _(K_p, rise):
    return {"u": -K_p * rise}


@exercise(
    "7.3",
    title="A panel in another language",
    points=3,
    where=lambda P_B, repeats, error, u_0: (
        u_0 + 100 * error * (1 + repeats) / P_B <= 95 and 100 * error / P_B * min(1, repeats) >= 3
    ),
)
def panel(
    P_B=choice(25, 40, 50, 80, 125, 160, 200, 250, unit="%", reference=80),
    repeats=choice(0.5, 0.8, 1.2, 1.5, 2, 2.5, 3, 4, reference=1.5),
    u_0=between(20, 50, "%", reference=40, step=5),
    error=between(1, 8, "%", reference=4, step=1),
):
    """On the panel of a PI controller you read a proportional band of {P_B} and {repeats} repeats per minute. What are
    its settings? Give the gain, and the integral time in seconds, as `PID(Kp, Ti)`.

    The controller has been at rest, with a control error of zero and a control signal of {u_0}. At $t = 0$ the error
    jumps to {error} and stays there, because the valve is stuck. Find the control signal $u(t)$ in percent over the
    next minute, with $t$ in seconds.
    """
    K_p, T_i = 100 / P_B, 60 / repeats
    return answers(
        settings=settings(PID(K_p, T_i), gain="%/%", time="s", what="the settings"),
        u=time_function(u_0 + K_p * error * (1 + t / T_i), until=60, unit="%", what="the control signal"),
    )


@panel.mistake("A narrow band means a strong action. Does your gain become larger when the band becomes narrower?")
def _(P_B, repeats):
    return {"settings": PID(P_B / 100, 60 / repeats)}


@panel.mistake(
    "The number of repeats says how often it happens in a minute. The integral time is how long one of them takes."
)
def _(P_B, repeats):
    return {"settings": PID(100 / P_B, 60 * repeats)}


@panel.mistake("In this function the time is in minutes. It should be in seconds.")
def _(P_B, repeats, u_0, error):
    return {"u": u_0 + 100 / P_B * error * (1 + t * repeats)}


@panel.mistake("These two terms are added to a control signal that is there already.")
def _(P_B, repeats, error):
    return {"u": 100 / P_B * error * (1 + t * repeats / 60)}


@panel.mistake("This is the integral term alone. Which term acts immediately when the error jumps?")
def _(P_B, repeats, u_0, error):
    return {"u": u_0 + 100 / P_B * error * t * repeats / 60}


@panel.mistake("This control signal jumps and then stays constant. An error that remains is integrated all the time.")
def _(P_B, u_0, error):
    return {"u": u_0 + 100 / P_B * error + 0 * t}


@exercise("7.4", title="What a P controller leaves", points=3, where=lambda K, W, e_max: 3 <= K * W / e_max <= 20)
def oil_tank(
    K=between(0.5, 2, "K/%", reference=0.8, step=0.1),
    T=between(20, 90, "min", reference=50, step=5),
    W=between(5, 25, "%", reference=15, step=1),
    e_max=between(0.5, 3, "K", reference=2, step=0.5),
):
    """The heater of an oil tank acts on the temperature with a gain of $K$ = {K} and a lag of {T}. On cold nights the
    tank loses so much more heat that the heater would have to give $W$ = {W} more to make up for it: the loss acts
    like a control signal that is $W$ too small. The controller is a P controller with the gain $K_p$ [%/K]. Its nominal
    control signal is right for the days, and is not changed.

    Which control error remains in the end? Give it first as a formula in $K$, $K_p$ and $W$. Then find the gain with
    which {e_max} remain. A PI controller replaces the P controller: by how much has it raised the control signal in
    the end?
    """
    return answers(
        e=expression(
            Symbol("K") * Symbol("W") / (1 + Symbol("K") * Symbol("K_p")),
            "the control error that remains, as a formula",
        ),
        K_p=number((K * W / e_max - 1) / K, "%/K", "the gain of the P controller"),
        u_PI=number(W, "%", "the change of the control signal under PI control"),
    )


@oil_tank.mistake("That much would remain without any controller. The P controller reduces it.")
def _():
    return {"e": Symbol("K") * Symbol("W")}


@oil_tank.mistake("Follow the loss on its way to the temperature: it goes through the same gain as the control signal.")
def _():
    return {"e": Symbol("W") / (1 + Symbol("K") * Symbol("K_p"))}


@oil_tank.mistake(
    "With the whole loop gain in the numerator the error would never fall when the gain rises. "
    "Does the loss pass through the controller before it reaches the temperature?"
)
def _():
    K, K_p, W = Symbol("K"), Symbol("K_p"), Symbol("W")
    return {"e": K * K_p * W / (1 + K * K_p)}


@oil_tank.mistake("Here numbers have been put in. Give the formula with the symbols first.")
def _(K, W):
    return {"e": K * W / (1 + K * Symbol("K_p"))}


@oil_tank.mistake("This is a loop gain, without unit. Which part of it belongs to the controller?")
def _(K, W, e_max):
    return {"K_p": K * W / e_max - 1} if K != 1 else {}


@oil_tank.mistake(
    "With this gain the proportional term would cancel the loss completely. But then no error would be left, and "
    "that term needs one."
)
def _(W, e_max):
    return {"K_p": W / e_max}


@oil_tank.mistake("This is what the P controller does. It stops short of the loss; the integral term goes on.")
def _(K, W, e_max):
    return {"u_PI": W - e_max / K}


@exercise(
    "7.5",
    title="A dryer after the frost",
    points=4,
    where=lambda K_p, T_i, u_0, e_frost, e_after, frost: (
        T_i * ((100 - u_0) / (K_p * e_frost) - 1) >= 2
        and 2 * T_i * ((100 - u_0) / (K_p * e_frost) - 1) <= frost
        and T_i * ((u_0 + K_p * e_frost * frost / T_i - 100) / (K_p * e_after) - 1) >= 5
        and K_p * (e_frost + e_after) <= 80
        and abs(frost - T_i * (1 + e_frost / e_after)) >= 4  # two mistakes would be one
    ),
)
def dryer(
    K_p=between(1, 4, reference=2, step=0.5),
    T_i=between(5, 20, "min", reference=10, step=1),
    u_0=between(50, 80, "%", reference=70, step=5),
    e_frost=between(3, 10, "%", reference=5, step=1),
    e_after=between(3, 10, "%", reference=4, step=1),
    frost=between(30, 90, "min", reference=60, step=5),
):
    """A PI controller with a gain of {K_p} (percent for percent) and an integral time of {T_i} keeps the temperature
    of a dryer. Its control signal is steady at {u_0}, the error zero. Then a frost comes in, for {frost}, and the
    heater is too small for it: take the control error as {e_frost} from the first moment to the last. After the frost
    the dryer is too hot for a while, with an error of minus {e_after} as long as the heater is at full power.

    First, without anti wind-up: how many minutes after the beginning of the frost does the computed control signal
    reach 100 %? How large is it when the frost ends? And how many minutes after the end of the frost does the heater
    leave full power? Then with anti wind-up, which halts the integration at 100 %: what is the control signal
    directly after the frost, when the error has changed?
    """
    at_limit, at_end, wait, after = _wound_up(K_p, T_i, u_0, e_frost, e_after, frost)
    return answers(
        t_limit=number(at_limit, "min", "the time from the beginning of the frost to the limit"),
        u_end=number(at_end, "%", "the computed control signal at the end of the frost"),
        t_wait=number(wait, "min", "the time at full power after the frost"),
        u_after=number(after, "%", "the control signal directly after the frost, with anti wind-up"),
    )


def _wound_up(K_p, T_i, u_0, e_frost, e_after, frost):
    at_limit = T_i * ((100 - u_0) / (K_p * e_frost) - 1)
    u_i = K_p * e_frost * frost / T_i
    wait = T_i * ((u_0 + u_i - 100) / (K_p * e_after) - 1)
    return at_limit, u_0 + K_p * e_frost + u_i, wait, 100 - K_p * (e_frost + e_after)


@dryer.mistake(
    "The integral term does not have to cover the whole way to the limit. What does the other term do immediately?"
)
def _(K_p, T_i, u_0, e_frost):
    return {"t_limit": T_i * (100 - u_0) / (K_p * e_frost)}


@dryer.mistake(
    "The integral term alone has grown that far. The proportional term is there as long as there is an error."
)
def _(K_p, T_i, u_0, e_frost, frost):
    return {"u_end": u_0 + K_p * e_frost * frost / T_i}


@dryer.mistake("This is what the heater gets. What does the program compute, which knows no limit?")
def _():
    return {"u_end": 100}


@dryer.mistake("When the error changes its sign, the proportional term changes too, before any integration.")
def _(K_p, T_i, u_0, e_frost, e_after, frost):
    return {"t_wait": T_i * (u_0 + K_p * e_frost * (1 + frost / T_i) - 100) / (K_p * e_after)}


@dryer.mistake("This time is counted from the beginning of the frost. Count it from the end.")
def _(K_p, T_i, u_0, e_frost, e_after, frost):
    return {"t_wait": frost + _wound_up(K_p, T_i, u_0, e_frost, e_after, frost)[2]}


@dryer.mistake("The proportional term was there before, with the error of the frost. By how much does it change?")
def _(K_p, e_after):
    return {"u_after": 100 - K_p * e_after}


@dryer.mistake("Here only the old proportional term has gone. With the error after the frost there is another one.")
def _(K_p, e_frost, e_after):
    return {"u_after": 100 - K_p * e_frost} if e_frost != e_after else {}


@dryer.mistake("That was so while the frost lasted. Which term follows the error immediately when the frost ends?")
def _():
    return {"u_after": 100}


@dryer.mistake("It would be that large without anti wind-up. At which value has the integral term been halted?")
def _(K_p, T_i, u_0, e_frost, e_after, frost):
    return {"u_after": _wound_up(K_p, T_i, u_0, e_frost, e_after, frost)[1] - K_p * (e_frost + e_after)}


def _angle(A, tau, K_p):
    """How far the dead time turns the phase where the loop gain is one, in rad; a quarter of a turn is the limit."""
    return float(K_p * tau / A)


@exercise(
    "7.6",
    title="Weeds in the canal",
    points=4,
    where=lambda A, tau, K_p, factor: (
        0.4 <= _angle(A, tau, K_p) <= 1.2 and abs(_angle(A, tau * factor, K_p) - math.pi / 2) > 0.1
    ),
)
def canal(
    A=between(1000, 6000, "m²", reference=3000, step=500),
    tau=between(120, 900, "s", reference=300, step=30),
    K_p=between(1, 20, "(m³/s)/m", reference=7, step=1),
    factor=choice(1.5, 2, 2.5, 3, reference=2.5),
):
    """A gate lets water into a reach of an irrigation canal. The water needs {tau} to its lower end, and raises the
    level there like that of a tank of {A}. So the transfer function from the inflow [m³/s] to the level [m] is
    $e^{-\\tau s}/(A s)$, with $\\tau$ = {tau} and $A$ = {A}. A P controller of the level, in engineering units, acts
    on the gate.

    Find the ultimate gain and the period of the oscillation there. The controller has a gain of {K_p}: how much may
    the delay grow until the loop is at the limit of stability? In summer, weeds make the delay {factor} times as long.
    Is the loop then stable?
    """
    return answers(
        K_u=number(pi * A / (2 * tau), "(m³/s)/m", "the ultimate gain"),
        P_u=number(4 * tau, "s", "the period of the oscillation"),
        delay_margin=number(pi * A / (2 * K_p) - tau, "s", "the growth of the delay up to the limit"),
        in_summer=word(_in_summer(A, tau, K_p, factor), ["stable", "unstable"], "the loop in summer"),
    )


def _in_summer(A, tau, K_p, factor):
    return "stable" if _angle(A, tau * factor, K_p) < math.pi / 2 else "unstable"


@canal.mistake(
    "At the limit, integrator and dead time together turn the phase by half a turn. How much of it does the integrator "
    "take, and what is left?"
)
def _(A, tau):
    return {"K_u": pi * A / tau, "P_u": 2 * tau}


@canal.mistake(
    "Here the dead time turns the phase by one radian. Half a turn minus the integrator's share is more than that."
)
def _(A, tau):
    return {"K_u": A / tau, "P_u": 2 * pi * tau}


@canal.mistake("This is the whole delay at the limit. Part of it is already there.")
def _(A, K_p):
    return {"delay_margin": pi * A / (2 * K_p)}


@canal.mistake("Compare the delay of the summer with the delay at the limit.")
def _(A, tau, K_p, factor):
    return {"in_summer": "unstable" if _in_summer(A, tau, K_p, factor) == "stable" else "stable"}


@exercise(
    "7.7",
    title="Settings that bear a change",
    points=5,
    where=lambda K, delay, area: 2.2 * K * delay <= area <= 2.8 * K * delay,
)
def heat_exchanger(
    K=between(0.5, 3, reference=1.2, step=0.1),
    T=between(40, 90, "s", reference=48, step=2),
    delay=between(5, 12, "s", reference=10, step=1),
    area=between(8, 80, "% s", reference=30, step=1),
):
    """A heat exchanger answers to its steam valve with a gain of {K} (percent for percent), a lag of {T} and a dead
    time of {delay}. Find settings of a PI controller, as `PID(Kp, Ti)` with the integral time in seconds, that meet
    three demands at once:

    - The loop gain may grow to 2.5 times its value before the loop becomes unstable.
    - The dead time may grow to 2.5 times its value before the loop becomes unstable.
    - After a load step of 1 % of the control signal, the integral of the control error is at most {area}. (In the end
      the integral term has taken up the whole load. So the integral of the error follows from the settings.)

    Any settings that do this are right. A slower, safer controller fails the third demand, a stronger one the others.
    """
    process = first_order(K, T, delay)
    return answers(
        settings=design(
            settings(PID(T / (2 * K * delay), T), gain="%/%", time="s"),
            pi_controller(),
            stable(process),
            criterion("the factor by which the gain may grow", lambda pid: _gain_factor(process, pid), above=2.5),
            criterion(
                "the factor by which the dead time may grow", lambda pid: _delay_factor(process, delay, pid), above=2.5
            ),
            criterion("the integral of the error", _area, below=float(area), unit="% s"),
        )
    )


def _gain_factor(process, pid):
    try:
        return ultimate(process * pid.expr)[0]
    except ValueError:  # no gain makes it stable
        return 0.0


def _delay_factor(process, delay, pid):
    try:
        return 1 + delay_margin(process * pid.expr) / float(delay)
    except ValueError:  # unstable as it is
        return 0.0


def _area(pid):
    return abs(float(pid.Ti / pid.Kp)) if pid.Kp else math.inf
