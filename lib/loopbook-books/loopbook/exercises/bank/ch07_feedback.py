"""Exercises of chapter 7, feedback control."""

import math

import numpy as np
from sympy import Heaviside, Rational, Symbol, exp, pi

from loopbook import diagrams, signals
from loopbook.deadtime import Loop
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
from loopbook.expressions import s, t
from loopbook.figures import time_plot
from loopbook.pid import PID, LowpassFilter
from loopbook.stability import delay_margin, ultimate
from loopbook.transfer import first_order

ACTIONS = ["reverse", "direct"]


def _apart(wrong, right, by=0.05):
    """Whether a wrong value cannot be taken for the right one."""
    return abs(float(wrong) - float(right)) > by * abs(float(right))


@exercise(
    "7.1",
    title="Behind the percent of a boiler",
    points=2,
    insight="A percentage is a share of a range, and a gain changes its value whenever one of its two units does.",
)
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

    The panel shows a pressure of {y}. Find the pressure $p$ in bar and the current $I$ in the cable.

    The gain of the controller is {K_p}, percent for percent. What is it in engineering units? (A gain is the change of
    the output for one unit of the input. So count the oil flow, in kg/h, that this controller adds when the pressure
    falls by one bar.)
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


@boiler.picture
def _(p_low, p_high, q_max):
    """From the pressure to the oil flow: sensor, current of 4 to 20 mA, percent, controller, percent, oil flow."""
    sensor = diagrams.block(f"Sensor\n${p_low}$ to ${p_high}$ bar")
    burner = diagrams.block(f"Burner\n$0$ to ${q_max}$ kg/h")
    current, controller = diagrams.block("$4$ to $20$ mA\nto percent"), diagrams.block("Controller\nin percent")
    return diagrams.block_diagram("p", sensor, "I", current, "y", controller, "u", burner, "q")


@boiler.mistake("The range of the current begins at 4 mA and ends at 20 mA. How large is its span?")
def _(y):
    return {"I": 4 + 20 * y / 100}


@boiler.mistake("This is percent of the control signal for one bar. How much oil is one percent?")
def _(p_low, p_high, q_max, K_p):
    return {"K_p": K_p * 100 / (p_high - p_low)}


@boiler.mistake("This is the oil for one percent of the pressure range. How many of these percent are one bar?")
def _(p_low, p_high, q_max, K_p):
    return {"K_p": K_p * q_max / 100} if _apart(p_high - p_low, 100) else {}


@boiler.mistake("So it would be with a gain of one. How many percent does this controller make of one percent?")
def _(p_low, p_high, q_max, K_p):
    return {"K_p": q_max / (p_high - p_low)} if K_p not in (1, q_max / 100) else {}


@boiler.mistake("The percentage is a share of the *span*, from the lower end to the upper one.")
def _(p_low, p_high, y):
    return {"p": p_low + y * p_high / 100}


boiler.hints(
    "A linear scale maps one range onto another along a straight line: equal shares of the two ranges belong together.",
    "With the share $y/100$ both values are *lower end + share times span*. For the gain, send an error of 1 bar "
    "through the chain: how many percent is it, what does the controller make of them, and how much oil is that?",
    "The span of the pressure is ${p_high} - {p_low}$ bar, so 1 bar is $100/({p_high} - {p_low})$ percent; and one "
    r"percent of the control signal is $\frac{ {q_max} }{100}$ kg/h.",
)


@boiler.solution
def _(p_low, p_high, y, q_max, K_p):
    r"""The percentage is a share of a range, counted from its lower end. The pressure has a span of
    ${p_high} - {p_low} =$ {span}, so

    $$p = {p_low} + \frac{ {y} }{100} \cdot {span} = {p}\ \text{bar}$$

    The current has a span of 16 mA, and begins at 4 mA: $I = 4 + \frac{ {y} }{100} \cdot 16 =$ {I}.

    ***

    For the gain, follow an error of 1 bar. It is $100/{span} =$ {percent} of the range. The controller makes
    ${K_p} \cdot {percent} =$ {u} of it, and one percent of the control signal is {flow} of oil. So 1 bar gives

    $$K_p = {flow} \cdot {K_p} \cdot {percent} = {gain}\ \frac{\text{kg/h}}{\text{bar}}$$
    """
    span = p_high - p_low
    return {
        "span": (span, "bar"), "percent": (100 / span, "%"), "u": (K_p * 100 / span, "%"),
        "flow": (q_max / 100, "kg/h"),
        "gain": K_p * q_max / span,
    }  # fmt: skip


@exercise(
    "7.2",
    title="Which way to turn",
    points=2,
    insight="Valve and medium may each turn the sign around: only the product of all signs in the loop decides on the "
    "action.",
    where=lambda K_p, rise: K_p * rise <= 16,
)
def jacket(
    medium=choice("cooling water", "steam"),
    valve=choice("opens", "closes"),
    K_p=between(1, 4, reference=2, step=0.5),
    u_0=between(40, 60, "%", reference=50, step=5),
    rise=between(2, 8, "%", reference=5, step=1),
):
    """The temperature in a stirred vessel is controlled with {medium} in its jacket. The valve for the {medium}
    {valve} when its control signal rises. Which action does the controller need?

    Take a P controller with a gain of {K_p} in magnitude and a nominal control signal of {u_0}. With the right action,
    what is its control signal when the temperature has risen {rise} above its setpoint? (All signals are in percent of
    their ranges, and the gain is percent for percent.)
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


@jacket.picture
def _(medium, valve):
    """A stirred vessel with a jacket; the controller of its temperature acts on a valve in the supply of {medium}."""
    layout = """
        .       1  .     TC   T_SP
        .       .  tank  TT   .
        medium  V  tank  out  ."""
    parts = {"V": diagrams.control_valve(), "tank": diagrams.tank(jacket=True, stirrer=True)}
    names = {"medium": medium, "out": "out", "T_SP": "$T_{SP}$"}
    pipes, lines = "medium V tank out", "tank TT TC 1 V, T_SP TC"
    return diagrams.instrumentation_diagram(layout, pipes, lines, parts, names)


@jacket.mistake("How many percent of control signal does the controller make of one percent of error?")
def _(medium, valve, K_p, u_0, rise):
    return {"u": u_0 + _push(medium, valve) * rise} if K_p != 1 else {}


@jacket.mistake("Does a larger gain make the controller stronger or weaker?")
def _(medium, valve, K_p, u_0, rise):
    return {"u": u_0 + _push(medium, valve) * rise / K_p} if K_p != 1 else {}


jacket.hints(
    "Negative feedback: what the controller does to a temperature that is too high must make it fall.",
    "Go around the loop with signs. Does more control signal give more of the medium? Does more of the medium make "
    "the vessel warmer? Then choose the action that makes the whole loop negative.",
    "Here the valve {valve} when its signal rises, and the medium is {medium}. The temperature is {rise} too high, so "
    "the vessel needs {wanted} {medium}, and the valve has to {moves}.",
)


@jacket.shows
def _(medium, valve):
    moves = "open further" if medium == "cooling water" else "close a little"
    return {"wanted": "more" if medium == "cooling water" else "less", "moves": moves}


@jacket.solution
def _(medium, valve, K_p, u_0, rise):
    r"""The temperature is too high, so the vessel needs {wanted} {medium}: the valve has to {moves}. This valve {valve}
    when its signal rises, so the control signal has to {go}.

    A rise of the measurement that makes the control signal {go} is what we call {action} action.

    The proportional term has the size ${K_p} \cdot {rise} =$ {size}, and with the direction that we have found,

    $$u = {u_0} {sign} {size} = {u}\ \%$$
    """
    push = _push(medium, valve)
    return {
        "go": "rise" if push > 0 else "fall", "size": (K_p * rise, "%"), "sign": "+" if push > 0 else "-",
        "action": _action(medium, valve),
    }  # fmt: skip


@exercise(
    "7.3",
    title="A panel in another language",
    points=3,
    insight="A narrow band is a large gain, and many repeats are a short integral time: old panels count the other "
    "way round.",
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
    """On the panel of an old PI controller you read a proportional band of {P_B} and {repeats} repeats per minute. The
    proportional band is the control error, in percent, that drives the control signal through its full range of 100 %
    by the proportional term alone. The repeats say how often, in a minute, the integral term repeats what the
    proportional term has done, while the error stays constant. What are the settings? Give the gain, and the integral
    time in seconds, as `PID(Kp, Ti)`.

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
def _(P_B, repeats, u_0, error):
    return {"settings": PID(100 / P_B, 60 * repeats), "u": u_0 + 100 / P_B * error * (1 + t / (60 * repeats))}


@panel.mistake("A narrow band means a strong action. Does this gain become larger when the band becomes narrower?")
def _(P_B, repeats, u_0, error):
    return {"u": u_0 + P_B / 100 * error * (1 + t * repeats / 60)}


@panel.mistake("The integral term is there for an error of one percent. How large is the error?")
def _(P_B, repeats, u_0, error):
    return {"u": u_0 + 100 / P_B * (error + t * repeats / 60)} if error != 1 else {}


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


@panel.mistake(
    "The proportional band is in percent of a range of 100 %: which control error does that range divide by?"
)
def _(P_B, repeats):
    return {"settings": PID(1 / P_B, 60 / repeats)}


@panel.mistake("The gain is right. The integral time is asked in seconds; what you have is in minutes.")
def _(P_B, repeats):
    return {"settings": PID(100 / P_B, 1 / repeats)}


@panel.mistake("The gain multiplies the control error, in both terms.")
def _(P_B, repeats, u_0, error):
    return {"u": u_0 + error * (1 + t * repeats / 60)}


@panel.mistake("The number of repeats is no time: how long does one of them take?")
def _(P_B, repeats):
    return {"settings": PID(100 / P_B, repeats)}


@panel.mistake("Neither number of the panel is a setting yet. What does each of them count?")
def _(P_B, repeats):
    return {"settings": PID(P_B, repeats)}


@panel.mistake(
    "Both numbers count the other way round: a narrow band is a strong controller, many repeats a quick one."
)
def _(P_B, repeats):
    return {"settings": PID(P_B / 100, 60 * repeats)}


panel.hints(
    "Both numbers count the other way round: a *narrow* band is a strong controller, and *many* repeats are a quick "
    "integral term.",
    "The band is the error that moves the control signal by 100 %, so $K_p P_B = 100$. A repeat takes one integral "
    r"time, so there are $60\ \text{s}/T_i$ of them in a minute. For a constant error $E$, $u = u_0 + K_p E\,(1 + "
    "t/T_i)$.",
    "An error of {P_B} moves the control signal by 100 %: by how much does an error of 1 % move it? And {repeats} "
    "repeats take 60 s: how long does one of them take?",
)


@panel.solution
def _(P_B, repeats, u_0, error):
    r"""The band is the control error for which the proportional term runs through 100 %: $K_p \cdot {P_B} = 100$, so
    $K_p = 100/{P_B} =$ {gain}.

    In one integral time the integral term of a constant error grows as large as the proportional term; that is one
    repeat. With {repeats} of them in 60 s, $T_i = 60/{repeats} =$ {time}.

    When the error jumps to {error}, the proportional term jumps to ${gain} \cdot {error} =$ {jump} and stays there. The
    integral term adds the same amount evenly in each integral time, so it rises by {slope}:

    $$u(t) = {u_0} + {jump} + {slope}\,t\quad\text{in \%, with } t \text{ in s}$$
    """
    K_p, T_i = 100 / P_B, 60 / repeats
    return {
        "gain": K_p, "time": (T_i, "s"), "jump": (K_p * error, "%"), "slope": (K_p * error / T_i, "%/s"),
    }  # fmt: skip


@panel.solution_picture
def _(P_B, repeats, u_0, error):
    """The control signal after the error has jumped: a jump, then a ramp that repeats it in each integral time."""
    K_p, T_i = 100 / P_B, 60 / repeats
    times = np.linspace(0, float(max(60, T_i)), 121)
    curves = {
        "$u$": (u_0 + K_p * error * (1 + t / T_i), "control signal"),
        "without integral term": (u_0 + K_p * error, 0),
    }
    axes = {"ylabel": "$u$ [%]", "ylim": (u_0, u_0 + K_p * error * (2.2 + times[-1] / T_i)), "low": True}
    return time_plot(curves, times, **axes).mark(T_i, "first repeat, after $T_i$", "$u$")


@exercise(
    "7.4",
    title="What a P controller leaves",
    points=3,
    insight="A P controller needs an error to hold a load; the integral term holds it without one.",
    where=lambda K, W, e_max: 3 <= K * W / e_max <= 20,
)
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
def _(K, W, e_max):
    wrong, right = (W / e_max - 1) / K, (K * W / e_max - 1) / K
    numbers = {"K_p": wrong} if _apart(wrong, right) else {}
    return numbers | {"e": Symbol("W") / (1 + Symbol("K") * Symbol("K_p"))}


@oil_tank.mistake(
    "With the whole loop gain in the numerator the error would never fall when the gain rises. Does the loss pass "
    "through the controller before it reaches the temperature?"
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
    "With this gain the proportional term would cancel the loss completely. But then no error would be left, and that "
    "term needs one."
)
def _(W, e_max):
    return {"K_p": W / e_max}


@oil_tank.mistake("This is what the P controller does. It stops short of the loss; the integral term goes on.")
def _(K, W, e_max):
    return {"u_PI": W - e_max / K}


@oil_tank.mistake(
    "In this error the gain of the process is missing below. What does an error of one kelvin bring back?"
)
def _():
    return {"e": Symbol("K") * Symbol("W") / (1 + Symbol("K_p"))}


@oil_tank.mistake("So nothing would have to change. But who makes up for the loss when no error is left?")
def _():
    return {"u_PI": 0}


@oil_tank.mistake(
    "With this error the proportional term would cancel the loss completely. Would an error be left then?"
)
def _():
    return {"e": Symbol("W") / Symbol("K_p")}


@oil_tank.mistake("Solve once more for $K_p$: on which side of the equation does the one end up, and with which sign?")
def _(K, W, e_max):
    return {"K_p": (K * W / e_max + 1) / K}


@oil_tank.mistake("That is a temperature: what the loss does by itself. Which control signal makes up for it?")
def _(K, W):
    return {"u_PI": K * W} if _apart(K, 1) else {}


@oil_tank.mistake("By this factor the error has become smaller. How does it follow from the loop gain?")
def _(K, W, e_max):
    wrong, right = K * W / e_max, (K * W / e_max - 1) / K
    return {"K_p": wrong} if _apart(wrong, right) and K != 1 else {}


oil_tank.hints(
    "In the end nothing moves any more, and the process is its gain. Write down what arrives at its input.",
    "The heater gives $K_p e$ more than by day, and the loss takes $W$ away. So the temperature is too low by $e = "
    r"K\,(W - K_p e)$. Solve it for $e$, then for $K_p$.",
    r"With the numbers, $1 + {K} K_p = \frac{ {K} \cdot {W} }{ {e_max} }$. For the PI controller, ask what the "
    "integral term does as long as there is any error.",
)


@oil_tank.picture
def _(K, T):
    """The loop: the P controller, and the process, at whose input the loss $W$ is subtracted."""
    lag = diagrams.block(rf"\frac{{{float(K):g}}}{{{T}\,s+1}}")
    forward = ["e", diagrams.gain("K_p"), "u", diagrams.disturbance("W", sign="-"), lag]
    return diagrams.block_diagram("T_SP", diagrams.feedback_loop(forward), "T")


@oil_tank.solution
def _(K, W, e_max):
    r"""When everything has settled, the process is its gain $K$. By day the balance is right; at night the loss takes
    $W$ away at its input, and the controller adds $K_p e$. So the temperature ends too low by

    $$e = K\,(W - K_p e) \quad\Rightarrow\quad e = \frac{K W}{1 + K K_p}$$

    Without a controller the error would be $K W = {K} \cdot {W} =$ {bare}; the P controller divides it by one plus the
    loop gain. If {e_max} are to remain, this divisor must be ${bare}/{e_max} =$ {divisor}, so

    $$K_p = \frac{ {divisor} - 1}{ {K} } = {gain}\ \text{\%/K}$$

    A PI controller goes on integrating until no error is left. Then the heater makes up for the loss all alone, and its
    control signal is higher by $W =$ {W}.
    """
    return {"bare": (K * W, "K"), "divisor": K * W / e_max, "gain": (K * W / e_max - 1) / K}


@exercise(
    "7.5",
    title="A dryer after the frost",
    points=4,
    insight="What is integrated while the actuator is at its limit has to be integrated back before the loop is alive "
    "again.",
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


@dryer.mistake("As if the integral term had not moved during the frost. Where was it when it was halted?")
def _(K_p, u_0, e_frost, e_after):
    return {"u_after": u_0 - K_p * e_after} if u_0 + K_p * e_frost < 99 else {}


@dryer.mistake("The gain multiplies the integral term as well.")
def _(K_p, T_i, u_0, e_frost, frost):
    wrong = T_i * (100 - u_0 - K_p * e_frost) / e_frost
    return {"t_limit": wrong, "u_end": u_0 + K_p * e_frost + e_frost * frost / T_i} if K_p != 1 else {}


@dryer.mistake("In how long does the integral term of a constant error grow as large as the proportional term?")
def _(K_p, T_i, u_0, e_frost, frost):
    u_p = K_p * e_frost
    return {"t_limit": (100 - u_0 - u_p) / u_p, "u_end": u_0 + u_p * (1 + frost)}


@dryer.mistake("While the integral term runs back, which control error is it that drives it?")
def _(K_p, T_i, u_0, e_frost, e_after, frost):
    u_i = K_p * e_frost * frost / T_i
    wrong = T_i * (u_0 + u_i - K_p * e_after - 100) / (K_p * e_frost)
    return {"t_wait": wrong} if _apart(e_frost, e_after) else {}


@dryer.mistake("After the frost the error is negative. Which sign does the proportional term have then?")
def _(K_p, T_i, u_0, e_frost, e_after, frost):
    wait = _wound_up(K_p, T_i, u_0, e_frost, e_after, frost)[2]
    return {"t_wait": wait + 2 * T_i} if e_frost != e_after else {}


@dryer.mistake("The integral term is right. With the new error, what has become of the proportional term?")
def _(K_p, T_i, u_0, e_frost, e_after, frost):
    return {"t_wait": _wound_up(K_p, T_i, u_0, e_frost, e_after, frost)[2] + T_i}


@dryer.mistake("That is the first moment. What has the integral term done during the frost?")
def _(K_p, u_0, e_frost):
    return {"u_end": u_0 + K_p * e_frost}


@dryer.mistake(
    "The heater leaves full power when the sum is back at 100 %. Does the integral term have to vanish for that?"
)
def _(K_p, T_i, u_0, e_frost, e_after, frost):
    wait = _wound_up(K_p, T_i, u_0, e_frost, e_after, frost)[2]
    return {"t_wait": frost * e_frost / e_after} if _apart(frost * e_frost / e_after, wait) else {}


@dryer.mistake("The error after the frost has the other sign. In which direction does the proportional term go?")
def _(K_p, e_frost, e_after):
    return {"u_after": 100 - K_p * (e_frost - e_after)} if e_frost != e_after else {}


dryer.hints(
    "A constant error makes a constant proportional term, and an integral term that grows along a straight line.",
    r"During the frost $u = u_0 + K_p e\,(1 + t/T_i)$, and nothing stops it at 100 %. After the frost the error has "
    "the other sign: the proportional term changes at once, the integral term runs back along another line.",
    r"First: ${u_0} + {K_p} \cdot {e_frost}\,(1 + t/{T_i}) = 100$. At the end of the frost put $t = {frost}$ min. "
    "With anti wind-up the *sum* of all terms is 100 % until the end; then only the proportional term changes.",
)


@dryer.solution
def _(K_p, T_i, u_0, e_frost, e_after, frost):
    r"""During the frost the proportional term is ${K_p} \cdot {e_frost} =$ {u_p} from the first moment on, and the
    integral term rises by {slope}. The sum reaches 100 % when

    $${u_0} + {u_p} + {slope}\,t = 100 \quad\Rightarrow\quad t = {t_limit}\ \text{min}$$

    The program knows no limit. When the frost ends, the integral term has grown to ${slope} \cdot {frost} =$ {u_i}, and
    the sum to ${u_0} + {u_p} + {u_i} =$ {u_end}.

    Now the error is minus {e_after}. The proportional term becomes minus {u_q} at once, so the sum is {start}, and the
    integral term falls by {back}. The heater leaves full power when the sum is back at 100 %:

    $${start} - {back}\,t = 100 \quad\Rightarrow\quad t = {t_wait}\ \text{min}$$

    With anti wind-up the sum stays at 100 % until the frost is over. Then the error changes by ${e_frost} + {e_after}$
    percent, and the proportional term follows: $u = 100 - {K_p}\,({e_frost} + {e_after}) =$ {u_after}.
    """
    u_p, u_q, u_i = K_p * e_frost, K_p * e_after, K_p * e_frost * frost / T_i
    return {
        "u_p": (u_p, "%"), "slope": (u_p / T_i, "%/min"), "u_i": (u_i, "%"), "u_q": (u_q, "%"),
        "start": (u_0 + u_i - u_q, "%"), "back": (u_q / T_i, "%/min"),
    }  # fmt: skip


@dryer.solution_picture
def _(K_p, T_i, u_0, e_frost, e_after, frost):
    """The sum of the terms without anti wind-up: it rises above 100 % during the frost, and takes long to come back."""
    _, at_end, wait, _ = _wound_up(K_p, T_i, u_0, e_frost, e_after, frost)
    jump = K_p * (e_frost + e_after)
    falls = at_end - jump - K_p * e_after / T_i * (t - frost)
    during = u_0 + K_p * e_frost * (1 + t / T_i)
    computed = during + (falls - during) * Heaviside(t - frost)
    times = np.linspace(0, float(frost + 1.8 * wait), 301)
    plot = time_plot(
        {"computed": (computed, "control signal")}, times, xlabel="$t$ [min]", ylabel="sum of the terms [%]"
    )
    return plot.level(100, "full power").event(frost, "frost ends").mark(frost + wait, "heater leaves full power")


@exercise(
    "7.6",
    title="Weeds in the canal",
    points=4,
    insight="Integrator and dead time share half a turn: one limit on the product of gain and delay, whichever of "
    "them grows.",
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
    "At the limit, integrator and dead time together turn the phase by half a turn. How much of it does the "
    "integrator take, and what is left?"
)
def _(A, tau, K_p):
    return {"K_u": pi * A / tau, "P_u": 2 * tau, "delay_margin": pi * A / K_p - tau}


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


@canal.mistake("This is how long the delay is in summer. By how much may it *grow* before the loop is at its limit?")
def _(tau, factor):
    return {"delay_margin": (factor - 1) * tau}


@canal.mistake("That is the whole turn in the time of the delay. How much of a turn does the delay make at the limit?")
def _(tau):
    return {"P_u": tau}


@canal.mistake("Does the gain of the integrator contain turns in a second, or radians in a second?")
def _(A, tau):
    return {"K_u": A / (4 * tau)}


@canal.mistake("One radian is not yet the limit. Which part of half a turn does the integrator leave to the dead time?")
def _(A, tau, K_p):
    return {"delay_margin": A / K_p - tau} if _angle(A, tau, K_p) < 0.9 else {}


canal.hints(
    "At the limit of stability an oscillation comes back from its way around the loop as large as it went, and "
    "exactly in step.",
    "The integrator takes a quarter of a turn at all frequencies. What is left of half a turn belongs to the dead "
    r"time: $\omega\tau = \pi/2$. And the loop gain is one where $K_p/(A\omega) = 1$.",
    r"For the ultimate gain: $\omega = \frac{\pi}{2 \cdot {tau} }$ rad/s, and $K_u = {A}\,\omega$. For the delay "
    r"margin it is the other way round: $\omega = \frac{ {K_p} }{ {A} }$ rad/s is fixed by the gain. Which delay is "
    r"$\pi/2$ there?",
)


@canal.picture
def _(A, tau, K_p):
    """The level after a setpoint step of one metre, in winter: it arrives after the delay and overshoots a little."""
    loop = Loop(exp(-tau * s) / (A * s), PID(K_p))
    times = np.linspace(0, 14 * float(tau), 300)
    curves = {"setpoint": (1, "setpoint"), "level in winter": (loop.servo.step(times), "measurement")}
    return time_plot(curves, times / 60, xlabel="$t$ [min]", ylabel="change of the level [m]", low=True)


@canal.solution
def _(A, tau, K_p, factor):
    r"""At the limit of stability a sinusoid comes back from its way around the loop unchanged. The minus sign of the
    feedback makes up for half a turn, $\pi$. The integrator takes $\pi/2$ of it at all frequencies, so the dead time
    has the other $\pi/2$: $\omega\tau = \pi/2$, and the period is $2\pi/\omega = 4\tau =$ {P_u}.

    There $\omega = \frac{\pi}{2 \cdot {tau} } =$ {omega_u}, and the integrator has the gain $1/(A\omega)$. So the gain
    that makes the loop gain one is $K_u = A\omega = {A} \cdot {omega_u} =$ {K_u}.

    With a gain of {K_p}, the loop gain is one at $\omega = K_p/A =$ {omega}. Here the dead time may be
    $\frac{\pi/2}{ {omega} } =$ {at_limit}; it is {tau}, so it may grow by {delay_margin}.

    In summer it is ${factor} \cdot {tau} =$ {summer}. That is {compared} than the delay at the limit: the loop is
    {in_summer}.
    """
    at_limit = math.pi / 2 * float(A / K_p)
    return {
        "omega_u": (math.pi / 2 / float(tau), "rad/s"), "omega": (K_p / A, "rad/s"), "at_limit": (at_limit, "s"),
        "summer": (factor * tau, "s"), "compared": "shorter" if factor * tau < at_limit else "longer",
        "in_summer": _in_summer(A, tau, K_p, factor),
    }  # fmt: skip


@canal.solution_picture
def _(A, tau, K_p, factor):
    """The level after a setpoint step in winter and in summer, with the longer delay."""
    times = np.linspace(0, 14 * float(tau), 300)
    curves = {"setpoint": (1, "setpoint")}
    for season, delay in {"winter": tau, "summer": factor * tau}.items():
        curves[season] = Loop(exp(-delay * s) / (A * s), PID(K_p)).servo.step(times)
    return time_plot(curves, times / 60, xlabel="$t$ [min]", ylabel="change of the level [m]", ylim=(-1.5, 3.5))


@exercise(
    "7.7",
    title="Settings that bear a change",
    points=5,
    insight="Robustness bounds the gain from above and the load from below, and what is between them is the room for "
    "design.",
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
            draws=lambda pid: _three_responses(K, T, delay, pid),
        )
    )


def _three_responses(K, T, delay, pid):
    """The response to the load step as it is, and at the two limits that the loop has to bear."""
    processes = {
        "as it is": first_order(K, T, delay),
        "gain 2.5 times": first_order(K * Rational(5, 2), T, delay),
        "dead time 2.5 times": first_order(K, T, delay * Rational(5, 2)),
    }
    times = np.linspace(0, 4 * float(T), 301)
    curves = {name: Loop(process, pid).regulator.step(times) for name, process in processes.items()}
    limits = -float(K), float(K)  # without a controller it would end at K
    return time_plot(curves, times, "After a load step of 1 %", ylabel="deviation [%]", ylim=limits)


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


@heat_exchanger.mistake(
    "With this gain the loop is at its limit as it is. The gain may grow by the factor 2.5 *before* it gets there."
)
def _(K, T, delay):
    return {"settings": PID(pi * T / (2 * K * delay), T)}


@heat_exchanger.mistake(
    "The settings would fit a process with a gain of one. Where does the gain of this process belong?"
)
def _(K, T, delay):
    return {"settings": PID(T / (2 * delay), T)} if K >= 1.4 or K <= 0.6 else {}


@heat_exchanger.mistake(
    "The process gain has gone to the wrong side: the loop gain is the product of the two, and it has to stay small."
)
def _(K, T, delay):
    return {"settings": PID(K * T / (2 * delay), T)} if K**2 >= 1.4 or K**2 <= 0.6 else {}


@heat_exchanger.mistake(
    "The integral time is right for cancelling the lag, but this gain is that of the demand times 2.5, instead of "
    "divided."
)
def _(K, T, delay):
    return {"settings": PID(pi * T / (2 * K * delay) * Rational(5, 2), T)}


@heat_exchanger.mistake(
    "The integral time is the lag of the process here, not its dead time: what should the zero cancel?"
)
def _(K, T, delay):
    return {"settings": PID(T / (2 * K * delay), delay)}


heat_exchanger.hints(
    "One choice makes it easy: an integral time equal to the lag of the process cancels the lag, and what is left of "
    "the loop is an integrator with a dead time.",
    r"With $T_i = T$ the loop is $\frac{K K_p}{T s}e^{-\tau s}$, which is at its limit when $\frac{K K_p \tau}{{T}} = "
    r"\frac{\pi}{2}$. It does not matter whether gain or dead time grows. And the integral of the error after the "
    "load step is $T_i/K_p$.",
    "With $T_i$ = {T} the third demand is a lower limit of the gain. The first two are an upper one: at 2.5 times your "
    "gain the loop may be at its limit, and not before.",
)


@heat_exchanger.solution
def _(K, T, delay, area):
    r"""Let the integral time be the lag, $T_i =$ {T}. Then the controller's zero cancels the lag, and the loop is an
    integrator with a dead time:

    $$K_p \frac{T s + 1}{T s} \cdot \frac{K e^{-\tau s}}{T s + 1} = \frac{K K_p}{T s} e^{-\tau s}$$

    It is at its limit when integrator and dead time together turn the phase by half a turn where the loop gain is one:
    $K K_p \tau/T = \pi/2$. Only the product of gain and dead time counts, so the first two demands are one, and
    the product may be $\frac{\pi}{2}/2.5$ at most:

    $$K_p \le \frac{\pi}{2 \cdot 2.5} \cdot \frac{ {T} }{ {K} \cdot {delay} } = {highest}$$

    After the load step the integral term has taken up 1 %. It is $\frac{K_p}{T_i}$ times the integral of the error, so
    that integral is $T_i/K_p$, and the third demand says

    $$K_p \ge \frac{ {T} }{ {area} } = {lowest}$$

    Any gain between the two will do, for example the middle, $K_p =$ {middle} with $T_i =$ {T}.
    """
    highest, lowest = math.pi / 5 * float(T / (K * delay)), float(T / area)
    return {"highest": highest, "lowest": lowest, "middle": (highest + lowest) / 2}


STEP = 0.2  # s, between the samples of exercise 7.8


def _through_filter(jump, start, sigma, T_f, noise):
    """Times, measurement and filtered measurement of exercise 7.8, counted from the old pressure."""
    times = np.arange(0, float(start + 7 * T_f), STEP)
    raw = (times >= float(start)) * float(jump) + signals.noise(times, sigma, seed=int(noise))
    lowpass = LowpassFilter(T_f, STEP)
    return times, raw, np.array([lowpass.update(x) for x in raw])


@exercise(
    "7.8",
    title="The filter of a pressure gauge",
    points=3,
    where=lambda start, T_f: 0.6 * T_f <= start <= 2 * T_f and abs(start - T_f) >= 0.5,
    insight="Half the noise costs four times the time constant, and every second of it is a second of lag in the loop.",
)
def gauge(
    p=between(100, 300, "kPa", reference=200, step=20),
    jump=between(40, 120, "kPa", reference=80, step=10),
    start=between(4, 20, "s", reference=6, step=1),
    T_f=between(3, 12, "s", reference=5, step=0.5),
    rate=between(1, 6, "kPa/s", reference=2, step=0.5),
    noise=between(1, 999, reference=12, step=1),
):
    """On the test bench, a valve switches a pressure sensor from {p} to {top} in a step, at $t$ = {start}. Its signal
    is noisy, and passes through a measurement filter, a lag of gain one. The picture shows both: the grey line is the
    measurement, the blue one what comes out of the filter.

    Read the time constant $T_f$ of the filter off the picture. (`t, p_raw, p_filtered = exercise("7.8").given("t",
    "p_raw", "p_filtered")` are the samples, if you prefer to compute.)

    The noise of the display is still twice what the operators want. What a lag leaves of such noise is proportional to
    $1/\\sqrt{{T_f}}$. Which time constant leaves half as much? And with that new filter, how far does the display lag
    behind a pressure that has been rising by {rate} for a long time?
    """
    return answers(
        T_f=number(T_f, "s", "the time constant of the filter in the picture", within=0.1),
        T_new=number(4 * T_f, "s", "the time constant that leaves half as much noise", within=0.1),
        behind=number(4 * T_f * rate, "kPa", "how far the display lags behind with the new filter", within=0.1),
    )


@gauge.shows
def _(p, jump, start, T_f, noise):
    times, raw, filtered = _through_filter(jump, start, jump / 20, T_f, noise)
    return {
        "top": f"{p + jump}\N{NO-BREAK SPACE}kPa", "t": times,
        "p_raw": float(p) + raw, "p_filtered": float(p) + filtered,
    }  # fmt: skip


@gauge.picture
def _(p, jump, start, T_f, noise):
    """A noisy pressure that steps up, and the filtered pressure, which follows along an exponential."""
    times, raw, filtered = _through_filter(jump, start, jump / 20, T_f, noise)
    curves = {"measurement": (float(p) + raw, "raw"), "filtered": (float(p) + filtered, "measurement")}
    return time_plot(curves, times, ylabel="pressure [kPa]")


@gauge.mistake(
    "The clock of the picture does not begin with the step. From which moment on does the filter have to work?"
)
def _(start, T_f):
    return {"T_f": start + T_f}


@gauge.mistake("At that moment the filtered pressure has gone half of its way. How much of it is gone after one $T_f$?")
def _(T_f):
    return {"T_f": T_f * math.log(2)}


@gauge.mistake(
    "By then the filter has nearly arrived. One time constant is the time to 63 % of the way, not to the end."
)
def _(T_f):
    return {"T_f": 4 * T_f}


@gauge.mistake("Twice the time constant does not halve the noise: look at the square root.")
def _(T_f, rate):
    return {"T_new": 2 * T_f, "behind": 2 * T_f * rate}


@gauge.mistake("With such a filter the display would be noisier than today. On which side is the time constant?")
def _(T_f):
    return {"T_new": T_f / 4}


@gauge.mistake("That is how far the old filter lags behind. The new one is slower.")
def _(T_f, rate):
    return {"behind": T_f * rate}


def _behind_by(share):
    def wrong(T_f, rate):
        return {"behind": 4 * T_f * rate * share}

    return wrong


# 63 % of the way, and a time constant read halfway: the values are close, and the sentence holds for both
for _share in (1 - math.exp(-1), math.log(2)):
    gauge.mistake(
        "That is too short a time behind the ramp: is the time constant too short, or is this a share of it?"
    )(_behind_by(_share))


@gauge.mistake("Nine tenths of the way are behind it at that moment. Which share belongs to one $T_f$?")
def _(start, T_f):
    return {"T_f": T_f * math.log(10)} if abs(start + T_f - 2.3 * T_f) > 0.3 * T_f else {}


@gauge.mistake("By then the filter has nearly arrived. One time constant is the time to 63 % of the way only.")
def _(start, T_f):
    return {"T_f": 3.3 * T_f} if start + T_f < 2.95 * T_f else {}


@gauge.mistake("By then the filter has nearly arrived. One time constant is the time to 63 % of the way only.")
def _(T_f):
    return {"T_f": 5 * T_f}


@gauge.mistake("The pressure rises by so much in each second. How far does it come while the display is late?")
def _(T_f, rate):
    return {"behind": 4 * T_f / rate} if rate >= 1.5 else {}


gauge.hints(
    "A filter of this kind is a lag. After one time constant its step response has gone 63 % of the way, whatever the "
    "height of the step.",
    "The step has a height of {jump}. Mark 63 % of it on the vertical axis, go across to the smooth line, and count "
    r"the time from the step. For the noise, $1/\sqrt{T_{new}} = \frac{1}{2} \cdot 1/\sqrt{{T_f}}$.",
    r"The 63 % are at ${p} + 0.63 \cdot {jump}$ kPa; the step is at $t$ = {start}. Behind an even rise, a lag of gain "
    "one finally stays by the rate times its time constant.",
)


@gauge.solution
def _(p, jump, start, T_f, rate):
    r"""The filtered pressure starts at {p} and goes up by {jump}. After one time constant it has gone 63 % of this way,
    and is at ${p} + 0.632 \cdot {jump} =$ {level}. The blue line is there at about $t$ = {moment}. The step came at
    {start}, so $T_f \approx {moment} - {start} =$ {T_f}.

    To halve $1/\sqrt{{T_f}}$, the root must double, and the time constant grow fourfold: $4 \cdot {T_f} =$ {T_new}.

    Behind a ramp, a lag of gain one finally stays by its time constant: the display shows what the pressure was {T_new}
    ago. In this time it has risen by ${rate} \cdot {T_new} =$ {behind}. So little noise has its price.
    """
    return {"level": (p + jump * (1 - math.exp(-1)), "kPa"), "moment": (start + T_f, "s")}


@gauge.solution_picture
def _(p, jump, start, T_f, noise):
    """The same picture, with the point where the filtered pressure has gone 63 % of its way."""
    times, raw, filtered = _through_filter(jump, start, jump / 20, T_f, noise)
    curves = {"measurement": (float(p) + raw, "raw"), "filtered": (float(p) + filtered, "measurement")}
    plot = time_plot(curves, times, ylabel="pressure [kPa]")
    return plot.mark(start + T_f, "63 %, after $T_f$", "filtered").event(start, "step")


def _staircase(q, slope):
    """Times and measured temperature of exercise 7.9: the transmitter sends it in steps."""
    rise = 8 * float(q)
    times = np.linspace(0, rise / float(slope), 641)
    return times, float(q) * np.floor(float(slope) * times / float(q) + 0.5)


@exercise(
    "7.9",
    title="A derivative term in steps",
    points=3,
    where=lambda h, T_d, a, q, seconds: (
        a * T_d >= 5 * h and seconds >= 4 * h and abs(seconds - T_d) >= 2 and abs(a * T_d / h - T_d / seconds) > 0.5
    ),
    insight="The derivative looks at the smallest and quickest things in a signal; its filter makes it look at the "
    "trend.",
)
def in_steps(
    K_p=between(2, 8, "%/K", reference=5, step=1),
    T_d=between(20, 90, "s", reference=60, step=5),
    h=choice(0.5, 1, 2, unit="s", reference=1),
    a=choice(0.1, 0.125, 0.2, 0.25, reference=0.1),
    q=choice(0.1, 0.2, 0.25, 0.4, 0.5, unit="K", reference=0.2),
    seconds=between(10, 60, "s", reference=25, step=5),
):
    r"""A transmitter sends the temperature of an oven in steps: its digits are not finer. The picture shows what
    arrives while the oven becomes slowly and evenly warmer. A PID controller with the gain {K_p} and the derivative
    time {T_d} takes a sample every {h}.

    How large, as a magnitude, is the derivative term that the true rise of the temperature calls for? How large is it
    in the sample in which the measurement takes a step, if the program divides the change from the last sample by the
    time between the samples? And how large is it just after the step if the derivative term has a filter with the time
    constant $a T_d$, $a$ = {a}? (Take this filter as continuous, and the derivative term as zero before.)
    """
    return answers(
        u_true=number(K_p * T_d * q / seconds, "%", "the derivative term for the true rise", within=0.05),
        u_step=number(
            K_p * T_d * q / h, "%", "the derivative term in the sample of the step, without filter", within=0.05
        ),
        u_filtered=number(K_p * q / a, "%", "the derivative term just after the step, with filter", within=0.05),
    )


@in_steps.shows
def _(q, seconds):
    return {"slope": q / seconds}


@in_steps.picture
def _(q, seconds):
    """The measured temperature against time: a staircase that rises evenly."""
    times, values = _staircase(q, q / seconds)
    return time_plot({"measured": (20 + values, "measurement")}, times, ylabel="temperature [°C]")


@in_steps.mistake(
    "That is what the proportional term does when the measurement takes a step. What does the derivative do?"
)
def _(K_p, q):
    return {"u_step": K_p * q, "u_filtered": K_p * q}


@in_steps.mistake("The derivative is a change *per time*. In which time does the program see the step happen?")
def _(K_p, T_d, q, h):
    return {"u_step": K_p * T_d * q} if h != 1 and K_p * h != 1 else {}


@in_steps.mistake("The derivative is a change *per time*: by what must the height of a step be divided?")
def _(K_p, T_d, q):
    return {"u_true": K_p * T_d * q}


@in_steps.mistake("The gain of the controller multiplies all three terms, the derivative term as well.")
def _(K_p, T_d, q, h, a, seconds):
    filtered = {"u_filtered": q / a} if K_p * a != 1 else {}
    return filtered | {"u_true": T_d * q / seconds, "u_step": T_d * q / h}


@in_steps.mistake(
    "The filter's time constant is a share of $T_d$. A sudden change goes through $K_p T_d s/(a T_d s + 1)$ with "
    "which gain?"
)
def _(K_p, q, a):
    return {"u_filtered": K_p * q * a}


@in_steps.mistake("How long does the temperature take from one step to the next? One of the two is not read correctly.")
def _(K_p, T_d, q, h, a, seconds):
    of_the_picture = {"u_true": K_p * T_d * q / (8 * seconds)} if K_p != 8 else {}  # 8 would be the gain left out
    return of_the_picture | {"u_step": K_p * T_d * q / seconds}


@in_steps.mistake("The first stair is only half as long as the others. How long is a whole one?")
def _(K_p, T_d, q, seconds):
    return {"u_true": 2 * K_p * T_d * q / seconds}


@in_steps.mistake("The rate is upside down: how many kelvins are there in one second?")
def _(K_p, T_d, q, seconds):
    return {"u_true": K_p * T_d * seconds / q}


@in_steps.mistake("The filter is not a share of the unfiltered term. What does it make of a jump, in its first moment?")
def _(K_p, T_d, q, h, a):
    wrong, right = a * K_p * T_d * q / h, K_p * q / a
    return {"u_filtered": wrong} if _apart(wrong, right, 0.1) else {}


@in_steps.mistake("The time constant of the filter is a share of $T_d$. What does $T_d$ do below the fraction line?")
def _(K_p, T_d, q, a):
    return {"u_filtered": K_p * T_d * q / a}


in_steps.hints(
    "The derivative term is $K_p T_d$ times the rate at which the measurement changes. What matters is the time in "
    "which a change is seen to happen.",
    "Read two things off the staircase: how high is one step, and how much time is there from one step to the next? "
    r"The true rate is the one by the other. For a sudden change $q$, the filtered term $\frac{K_p T_d s}{a T_d s + "
    "1}$ has the gain of large $s$, $K_p/a$.",
    r"With the step height $q$ from the picture: without filter the program computes ${K_p} \cdot {T_d} \cdot "
    r"\frac{{q}}{ {h} }$, and with the filter the term begins at $\frac{ {K_p} }{ {a} }\,q$.",
)


@in_steps.solution
def _(K_p, T_d, h, a, q, seconds):
    r"""The picture shows steps of {q}, one every {seconds}. So the oven becomes warmer by $\frac{ {q} }{ {seconds} } =$
    {rate}, and the derivative term that this calls for is ${K_p} \cdot {T_d} \cdot {rate} =$ {u_true}.

    The program knows nothing of that. In most samples it sees no change at all, and the term is zero. In the sample of
    a step it sees {q} within {h}, and computes

    $${K_p} \cdot {T_d} \cdot \frac{ {q} }{ {h} } = {u_step}\ \%$$

    With the filter, the derivative term is $\frac{K_p T_d s}{a T_d s + 1}$. A sudden change passes with the gain of
    large $s$, which is $K_p/a$, so that the term begins at $\frac{ {K_p} }{ {a} } \cdot {q} =$ {u_filtered}. Then it
    fades with the time constant {T_f}: smaller by a factor of {factor}, and much calmer for the valve.
    """
    return {"rate": (q / seconds, "K/s"), "T_f": (a * T_d, "s"), "factor": a * T_d / h}


@in_steps.solution_picture
def _(K_p, T_d, h, a, q, seconds):
    """The magnitude of the derivative term over some steps: with the filter, and what the rise calls for."""
    K_p, T_d, a, q, seconds = map(float, (K_p, T_d, a, q, seconds))
    times = np.linspace(0, 2.5 * seconds, 501)
    filtered = sum(K_p * q / a * np.exp(-(times - k * seconds) / (a * T_d)) * (times >= k * seconds) for k in range(3))
    curves = {"with filter": filtered, "for the true rise": K_p * T_d * q / seconds}
    return time_plot(curves, times, ylabel="derivative term [%]", low=True)


WAYS = {"both": (1, 1), "p_only": (1, 0), "none": (0, 0)}  # the setpoint weights w_p and w_d of exercise 7.10


def _kicks(K_p, T_i, T_d, step_SP, u_0):
    """Times, outputs and control signals after the setpoint step, for each pair of weights, by small Euler steps."""
    h, K_p, T_i, T_d, jump = 0.05, float(K_p), float(T_i), float(T_d), float(step_SP)
    times = np.arange(-0.1 * T_i, 2.5 * T_i, h)
    found = {}
    for way, (w_p, w_d) in WAYS.items():
        x = y = u_i = 0.0
        lag = 0.0  # the filter of the derivative term, with a tenth of T_d
        u = np.zeros(len(times))
        for k, time in enumerate(times):
            y_SP = jump * (time >= 0)
            seen = w_d * y_SP - y
            u_d = 10 * K_p * (seen - lag)
            u[k] = K_p * (w_p * y_SP - y) + u_i + u_d
            lag += h * (seen - lag) / (0.1 * T_d)
            u_i += h * K_p / T_i * (y_SP - y)
            x += h * (0.8 * u[k] - x) / (0.8 * T_i)
            y += h * (x - y) / (0.2 * T_i)
        found[way] = float(u_0) + u
    return times, found


def _curve_of(order):
    """The letter of each way in a variant, such as {"both": "B", ...}."""
    return dict(zip(WAYS, order, strict=True))


@exercise(
    "7.10",
    title="The kick of a setpoint",
    points=4,
    insight="A setpoint is changed by people: the controller may look at its error and yet need not kick the valve.",
)
def kick(
    K_p=between(1, 3, reference=2, step=0.25),
    T_i=between(20, 60, "s", reference=40, step=5),
    T_d=between(4, 12, "s", reference=8, step=1),
    step_SP=between(2, 6, "%", reference=4, step=0.5),
    u_0=between(20, 45, "%", reference=30, step=5),
    ramp=between(10, 40, "s", reference=20, step=5),
    order=choice("ABC", "ACB", "BAC", "BCA", "CAB", "CBA", reference="BCA"),
):
    r"""A PID controller with a gain of {K_p} (percent for percent), an integral time of {T_i} and a derivative time of
    {T_d} keeps a process at rest; its control signal is {u_0}. At $t = 0$ the operator raises the setpoint by {step_SP}
    in a step. The derivative term has the usual filter, with a time constant of a tenth of $T_d$.

    The weights $w_p$ and $w_d$ say how much of the setpoint the proportional and the derivative term see:
    $u_p = K_p\,(w_p y_{{SP}} - y)$, and $u_d$ is $K_p T_d$ times the filtered derivative of $w_d y_{{SP}} - y$. The
    picture shows the control signal for three controllers; it cuts off what is higher. Which curve belongs to
    $w_p = w_d = 1$, which to $w_p = 1$ and $w_d = 0$, which to $w_p = w_d = 0$? (`t, A, B, C =
    exercise("7.10").given("t", "A", "B", "C")` are the curves of the picture.)

    How high does the control signal of the first one kick, directly after the step, as it is computed, before any
    limit? And if the setpoint rises evenly within {ramp} instead of in a step, how much does the setpoint add to its
    derivative term, once the filter has followed?
    """
    of = _curve_of(order)
    return answers(
        both=word(of["both"], "ABC", "the curve of $w_p = w_d = 1$"),
        p_only=word(of["p_only"], "ABC", "the curve of $w_p = 1$, $w_d = 0$"),
        none=word(of["none"], "ABC", "the curve of $w_p = w_d = 0$"),
        u_kick=number(
            u_0 + 11 * K_p * step_SP, "%", "the control signal directly after the step, with $w_p = w_d = 1$"
        ),
        u_ramp=number(K_p * T_d * step_SP / ramp, "%", "what the ramp adds to the derivative term"),
    )


@kick.shows
def _(K_p, T_i, T_d, step_SP, u_0, order):
    times, found = _kicks(K_p, T_i, T_d, step_SP, u_0)
    highest = _limits(K_p, step_SP, u_0)[1]
    return {"t": times} | {letter: np.minimum(found[way], highest) for letter, way in zip(order, WAYS, strict=True)}


def _limits(K_p, step_SP, u_0):
    """What the picture shows of the control signals."""
    return float(u_0 - 0.3 * K_p * step_SP), float(u_0 + 1.6 * K_p * step_SP)


@kick.picture
def _(K_p, T_i, T_d, step_SP, u_0, order):
    """Three control signals A, B and C after a setpoint step; what is too high is cut off."""
    times, found = _kicks(K_p, T_i, T_d, step_SP, u_0)
    curves = {letter: found[way] for letter, way in sorted(zip(order, WAYS, strict=True))}
    return time_plot(curves, times, ylabel="control signal [%]", ylim=_limits(K_p, step_SP, u_0))


def _taken_for(asked, other):
    """A mistake: one curve taken for another."""
    return lambda order: {asked: _curve_of(order)[other]}


for _asked, _other, _sentence in (
    ("both", "p_only", "This curve jumps once and goes on from there. What else should be seen if a derivative term "
                       "saw the jump?"),
    ("both", "none", "This curve does not jump at all. What does a proportional term do that sees all of a setpoint "
                     "step?"),
    ("p_only", "both", "This one leaves the picture at the moment of the step. Which term is strong enough for that?"),
    ("p_only", "none", "This one begins without a jump. What does a proportional term do that sees the whole step?"),
    ("none", "both", "This one leaves the picture at the moment of the step. Which term can still see the setpoint "
                     "here?"),
    ("none", "p_only", "This one jumps at the moment of the step. Which of the terms can jump, and does it see the "
                       "setpoint?"),
):  # fmt: skip
    kick.mistake(_sentence)(_taken_for(_asked, _other))


@kick.mistake("That is the jump of the proportional term. What does the derivative term add, through its filter?")
def _(K_p, step_SP, u_0):
    return {"u_kick": u_0 + K_p * step_SP}


@kick.mistake("From which value does the control signal kick?")
def _(K_p, step_SP):
    return {"u_kick": 11 * K_p * step_SP}


@kick.mistake("That is the derivative term. The proportional term sees the setpoint as well.")
def _(K_p, step_SP, u_0):
    return {"u_kick": u_0 + 10 * K_p * step_SP}


@kick.mistake("Does the derivative term see the height of the ramp, or its slope?")
def _(K_p, T_d, step_SP):
    return {"u_ramp": K_p * T_d * step_SP}


@kick.mistake("The filter has followed by then: it is the derivative that counts, not the gain for sudden changes.")
def _(K_p, T_d, step_SP):
    return {"u_ramp": 10 * K_p * step_SP} if T_d != 10 else {}


@kick.mistake("The gain multiplies the derivative term, too.")
def _(T_d, step_SP, ramp, K_p):
    return {"u_ramp": T_d * step_SP / ramp} if K_p != 1 else {}


@kick.mistake("That is what multiplies the slope. How steep is the ramp?")
def _(K_p, T_d):
    return {"u_ramp": K_p * T_d}


@kick.mistake("That is the slope of the ramp. What does the derivative term make of it?")
def _(step_SP, ramp):
    return {"u_ramp": step_SP / ramp}


@kick.mistake("That is what the valve gets in the end. What does the controller compute, before any limit?")
def _(K_p, step_SP, u_0):
    return {"u_kick": 100} if abs(u_0 + 11 * K_p * step_SP - 100) > 3 else {}


@kick.mistake("$K_p T_d$ belongs to a slope. What does the filter make of a sudden change?")
def _(K_p, T_d, step_SP, u_0):
    size = K_p * step_SP
    return {"u_kick": u_0 + T_d * size} if T_d not in (10, 11) else {}


@kick.mistake("$K_p T_d$ belongs to a slope. What does the filter make of a sudden change?")
def _(K_p, T_d, step_SP, u_0):
    size = K_p * step_SP
    return {"u_kick": u_0 + (1 + T_d) * size} if T_d not in (9, 10) else {}


@kick.mistake("The factor of ten is the filter's answer to a sudden change. Is a long ramp one?")
def _(K_p, T_d, step_SP, ramp):
    return {"u_ramp": 10 * K_p * T_d * step_SP / ramp} if ramp != 10 and 10 * step_SP != ramp else {}


@kick.mistake("That is the proportional term at the end of the ramp. What does the derivative term see?")
def _(K_p, T_d, step_SP, ramp):
    return {"u_ramp": K_p * step_SP} if _apart(T_d, ramp) and ramp != 10 * T_d and step_SP != T_d else {}


kick.hints(
    "A proportional term follows a jump with a jump. A derivative term follows it with a spike. An integral term can "
    "only begin to rise.",
    r"For a sudden change the filtered derivative term has the gain $K_p T_d/(0.1\,T_d)$; for a ramp it is $K_p T_d$ "
    "times the slope. Look at the first moment of each curve: spike, jump or neither?",
    r"Directly after the step only the setpoint has moved: add what the proportional term and the derivative term make "
    r"of {step_SP} to the {u_0} from before. The ramp has the slope $\frac{ {step_SP} }{ {ramp} }$ percent per second.",
)


@kick.solution
def _(K_p, T_d, step_SP, u_0, ramp, order):
    r"""Look at the first moment. Curve {both} leaves the picture in a spike: its derivative term sees the step, so its
    weights are both one. Curve {p_only} jumps and goes on from there: its proportional term sees the step, its
    derivative term does not. Curve {none} begins without a jump: only the integral term knows of the new setpoint.

    The proportional term jumps by ${K_p} \cdot {step_SP} =$ {jump}. The derivative term has a filter of a tenth of
    $T_d$, so its gain for a sudden change is $K_p T_d/(0.1\,T_d)$, ten times as large. Together they kick to

    $$u = {u_0} + {jump} + 10 \cdot {jump} = {u_kick}\ \%$$

    The ramp has the slope $\frac{ {step_SP} }{ {ramp} } =$ {slope}, and adds
    $K_p T_d \cdot {slope} = {K_p} \cdot {T_d} \cdot {slope} =$ {u_ramp}. A valve can live with that.
    """
    return _curve_of(order) | {"jump": (K_p * step_SP, "%"), "slope": (step_SP / ramp, "%/s")}


def _transfer(K_p, u_0, u_old, u_man, e):
    """The integral term for a transfer without a bump, the bump without care, and the integral term after tracking."""
    return u_man - u_0 - K_p * e, u_0 + K_p * e + u_old - u_man, u_man - u_0


def _by_hand(SP, e, u_man, u_before):
    """Times [min] and trends of exercise 7.11 up to the transfer at 30 min: setpoint, temperature, control signal."""
    times = np.linspace(0, 30, 301)
    since = np.maximum(times - 10, 0)
    y = float(SP) - float(e) * (1 - np.exp(-since / 4))
    u = np.where(times < 10, float(u_before), float(u_man))
    return times, y, u


@exercise(
    "7.11",
    title="The operator hands over",
    points=4,
    where=lambda K_p, T_i, u_0, u_old, u_man, e, wait: (
        min(map(abs, _transfer(K_p, u_0, u_old, u_man, e))) >= 6
        and abs(K_p * e) >= 4
        and abs(u_old - (u_man - u_0 - K_p * e)) >= 6
        and abs(u_old) >= 4
        and 0 <= u_0 + K_p * e + u_old <= 100
        and 5 <= u_0 + u_old <= 95
        and u_0 + u_old != u_man
        and abs(K_p * e * wait / T_i) >= 5
        and (u_man - u_0 - u_old) * e < 0  # more heating, a higher temperature
    ),
    insight="At the moment of transfer the integral term is free: set to the right value, it makes the two signals "
    "meet.",
)
def hand_over(
    K_p=between(1, 4, reference=2, step=0.5),
    T_i=between(4, 15, "min", reference=10, step=1),
    u_0=between(30, 60, "%", reference=40, step=5),
    u_old=between(-15, 15, "%", reference=10, step=5),
    u_man=between(20, 80, "%", reference=70, step=5),
    SP=between(45, 60, "%", reference=50, step=5),
    e=choice(-8, -6, -4, 4, 6, 8, unit="%", reference=-6),
    wait=between(2, 8, "min", reference=5, step=1),
):
    r"""A PI controller of a temperature has a gain of {K_p} (percent for percent), an integral time of {T_i} and a
    nominal control signal of {u_0}. At $t$ = 10 min the operator takes over and sets the control signal by hand; at 30
    min she switches back to automatic. The picture is the trend up to that moment. When she took over, the integral
    term was {u_old}, and in manual mode it is not changed.

    Read what you need off the picture. (`t, T, u = exercise("7.11").given("t", "T", "u")` are its curves, and the
    setpoint is {SP}.) To which value does the controller have to set its integral term, so that the
    transfer is bumpless? By how much, with its sign, would the control signal jump if the integral term were left as it
    was? After the bumpless transfer, what is the control signal {wait} later, if the control error is still the same?
    And which integral term would be right if the setpoint were first made equal to the measurement?
    """
    u_i, bump, tracked = _transfer(K_p, u_0, u_old, u_man, e)
    return answers(
        u_i=number(u_i, "%", "the integral term for a bumpless transfer", within=0.05),
        bump=number(bump, "%", "the jump of the control signal without care", within=0.05),
        u_later=number(
            u_man + K_p * e * wait / T_i, "%", "the control signal later, after the bumpless transfer", within=0.03
        ),
        u_tracked=number(tracked, "%", "the integral term if the setpoint equals the measurement", within=0.05),
    )


@hand_over.shows
def _(SP, e, u_man, u_0, u_old):
    times, temperature, u = _by_hand(SP, e, u_man, u_0 + u_old)
    return {"t": times, "T": temperature, "u": u}


@hand_over.picture
def _(SP, e, u_man, u_0, u_old):
    """Temperature and setpoint, and below them the control signal, which the operator moves at 10 min."""
    times, y, u = _by_hand(SP, e, u_man, u_0 + u_old)
    panels = [{"setpoint": (float(SP), "setpoint"), "temperature": (y, "measurement")}, {"$u$": (u, "control signal")}]
    plot = time_plot(panels, times, xlabel="$t$ [min]", ylabel=["temperature [%]", "$u$ [%]"])
    return plot.event(10, "to manual").event(30, "to automatic")


@hand_over.mistake(
    "The proportional term is there in the first moment, too. Which share of the control signal is its own?"
)
def _(u_man, u_0):
    return {"u_i": u_man - u_0}


@hand_over.mistake("The sign of the control error: is the temperature above its setpoint, or below?")
def _(K_p, T_i, u_0, u_old, u_man, e, wait):
    u_i, bump, _ = _transfer(K_p, u_0, u_old, u_man, -e)
    return {"u_i": u_i, "bump": bump, "u_later": u_man - K_p * e * wait / T_i}


@hand_over.mistake("The nominal control signal is a part of the sum: the three of them make what the operator left.")
def _(K_p, u_man, e):
    return {"u_i": u_man - K_p * e}


@hand_over.mistake(
    "This is the control signal directly after the transfer. By how much does it differ from the operator's?"
)
def _(K_p, u_0, u_old, e):
    return {"bump": u_0 + K_p * e + u_old}


@hand_over.mistake("Without care there is a proportional term in the first moment, with the error of the picture.")
def _(u_0, u_old, u_man):
    return {"bump": u_0 + u_old - u_man}


@hand_over.mistake(
    "After the transfer the proportional term does not come on top: the integral term has made room for it."
)
def _(K_p, T_i, u_man, e, wait):
    return {"u_later": u_man + K_p * e * (1 + wait / T_i)}


@hand_over.mistake("The error lasts. What does the integral term do meanwhile?")
def _(u_man):
    return {"u_later": u_man}


@hand_over.mistake(
    "With the setpoint at the measurement there is no control error. What is the proportional term then?"
)
def _(K_p, u_0, u_man, e):
    return {"u_tracked": u_man - u_0 - K_p * e}


@hand_over.mistake("That would be the proportional term once more. How much does the integral term add in this time?")
def _(K_p, T_i, u_man, e, wait):
    return {"u_later": u_man + K_p * e} if abs(K_p * e * (1 - wait / T_i)) > 4 else {}


@hand_over.mistake("The gain multiplies the integral term as well.")
def _(K_p, T_i, u_man, e, wait):
    return {"u_later": u_man + e * wait / T_i} if abs((K_p - 1) * e * wait / T_i) > 4 else {}


@hand_over.mistake("The nominal control signal is a part of the sum, too: what is left for the integral term?")
def _(u_man):
    return {"u_tracked": u_man}


@hand_over.mistake("Read the control signal at 30 min: it is the operator's, and not that of the time before.")
def _(K_p, T_i, u_0, u_old, u_man, e, wait):
    u_i, bump, tracked = _transfer(K_p, u_0, u_old, u_man, e)
    added = K_p * e * wait / T_i
    wrong = {"u_i": u_old - K_p * e, "bump": K_p * e, "u_later": u_0 + u_old + added, "u_tracked": u_old}
    right = {"u_i": u_i, "bump": bump, "u_later": u_man + added, "u_tracked": tracked}
    return {name: value for name, value in wrong.items() if _apart(value, right[name])}


@hand_over.mistake("The proportional term is the error times the gain.")
def _(K_p, u_0, u_old, u_man, e):
    u_i, bump, _ = _transfer(K_p, u_0, u_old, u_man, e)
    wrong_u_i, wrong_bump, _ = _transfer(1, u_0, u_old, u_man, e)
    found = {"u_i": wrong_u_i} if _apart(wrong_u_i, u_i) else {}
    return found | ({"bump": wrong_bump} if _apart(wrong_bump, bump) else {})


@hand_over.mistake("The integral term adds so much in each integral time. How long is that?")
def _(K_p, T_i, u_man, e, wait):
    return {"u_later": u_man + K_p * e * wait}


@hand_over.mistake("So much the integral term adds in one minute. How many minutes are asked for?")
def _(K_p, T_i, u_man, e, wait):
    wrong, right = u_man + K_p * e / T_i, u_man + K_p * e * wait / T_i
    return {"u_later": wrong} if _apart(wrong, right) and abs(K_p * e / T_i) > 3 else {}


@hand_over.mistake("That is the old integral term. Would the control signal be the operator's with it?")
def _(u_old):
    return {"u_i": u_old}


@hand_over.mistake("The integral term is not all of the control signal. What else is in the sum?")
def _(K_p, u_0, u_old, u_man, e):
    return {"u_i": u_man} if _apart(u_man, _transfer(K_p, u_0, u_old, u_man, e)[0], 0.1) else {}


@hand_over.mistake("Without care the old integral term stays. Does the sum happen to be what the operator left?")
def _():
    return {"bump": 0}


hand_over.hints(
    "Bumpless means that the first control signal of the controller is the last one of the operator.",
    "In automatic mode $u = u_0 + K_p e + u_i$. In the first moment the integral term is all that can be chosen: set "
    "$u$ equal to the operator's control signal, and solve for it.",
    "Read the operator's control signal off the lower panel and $e$, setpoint minus temperature at 30 min, off the "
    r"upper one. Then ${u_0} + {K_p}\,e + u_i$ has to be the operator's value; and while the error lasts, the "
    r"integral term grows by $\frac{ {K_p} }{ {T_i} }\,e$ in each minute.",
)


@hand_over.solution
def _(K_p, T_i, u_0, u_old, u_man, SP, e, wait):
    r"""At 30 min the picture shows a control signal of {u_man}, a setpoint of {SP} and a temperature of {level}. So the
    control error is ${SP} - {level} =$ {e}, and the proportional term ${K_p} \cdot {error} =$ {u_p}.

    For a bumpless transfer the sum of all terms must be what the operator left:

    $${u_0} {plus_u_p} + u_i = {u_man} \quad\Rightarrow\quad u_i = {u_i}\ \%$$

    With the old integral term the controller would begin at ${u_0} {plus_u_p} {plus_u_old} =$ {start}, and the control
    signal would jump by ${start} - {u_man} =$ {bump}.

    After the bumpless transfer the constant error is integrated: in {wait} it adds
    $\frac{ {K_p} }{ {T_i} } \cdot {error} \cdot {wait} =$ {added}, so the control signal is then {u_later}.

    If the setpoint is first made equal to the measurement, there is no control error and no proportional term, and the
    integral term is ${u_man} - {u_0} =$ {u_tracked}.
    """
    return {
        "level": (SP - e, "%"), "u_p": (K_p * e, "%"), "start": (u_0 + K_p * e + u_old, "%"),
        "added": (K_p * e * wait / T_i, "%"), "u_i": (u_man - u_0 - K_p * e, "%"),
        "error": f"({e})" if e < 0 else f"{e}", "plus_u_p": _added(K_p * e), "plus_u_old": _added(u_old),
    }  # fmt: skip


def _added(value):
    """A number behind a sum, with its sign."""
    return f"{'-' if value < 0 else '+'} {abs(float(value)):g}"
