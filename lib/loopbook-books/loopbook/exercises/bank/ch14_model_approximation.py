"""Exercises of chapter 14, model approximation."""

import itertools
import math

import numpy as np
from sympy import Eq, Function, Heaviside, Integer, Rational, exp, pi, sqrt

from loopbook.deadtime import Loop, System
from loopbook.exercises.authoring import (
    answers,
    between,
    choice,
    criterion,
    design,
    exercise,
    largest_sensitivity,
    number,
    pi_controller,
    settings,
    stable,
    time_function,
    transfer_function,
    word,
)
from loopbook.expressions import s, t
from loopbook.figures import time_plot
from loopbook.pid import PID


@exercise(
    "14.1",
    title="A column that goes the wrong way first",
    points=2,
    insight="The half rule only moves lateness from one place to another: lags and delays keep their sum.",
    where=lambda tau_2, tau_3, T_inv, theta_0: (
        tau_3 < tau_2 - Rational(1, 2)
        and tau_3 not in (theta_0, T_inv)
        and len({tau_2 / 2, tau_3 / 2, theta_0, T_inv, 2 * T_inv}) == 5
    ),
)
def column(
    tau_1=between(15, 40, "min", step=1, reference=25),
    tau_2=between(4, 12, "min", step=1, reference=6),
    tau_3=between(1, 4, "min", step=0.5, reference=3),
    T_inv=between(1.5, 4, "min", step=0.5, reference=2),
    theta_0=between(0.5, 3, "min", step=0.5, reference=1),
):
    """More steam to a distillation column makes the liquid in its sump swell before it falls, and so the composition
    at the bottom goes the wrong way first. An analyser adds a dead time. With times in minutes, the process is

    {process}

    and the picture shows how its response to a step begins. Reduce it by the half rule to a model with one lag and a
    dead time. (Its gain is that of the process.)
    """
    return answers(
        tau_1=number(tau_1 + tau_2 / 2, "min", "the lag of the model"),
        theta=number(theta_0 + T_inv + tau_2 / 2 + tau_3, "min", "the effective delay"),
    )


@column.shows
def _(tau_1, tau_2, tau_3, T_inv, theta_0):
    return {"process": _equation("g", _column(tau_1, tau_2, tau_3, T_inv, theta_0))}


def _column(tau_1, tau_2, tau_3, T_inv, theta_0):
    return (1 - T_inv * s) * exp(-theta_0 * s) / ((tau_1 * s + 1) * (tau_2 * s + 1) * (tau_3 * s + 1))


def _until(end):
    """Times for a picture."""
    return np.linspace(0, float(end), 401)


def _equation(name, H):
    return Eq(Function(name)(s), H, evaluate=False)


@column.mistake("The largest of the neglected lags is shared between the lag that is kept and the delay.")
def _(tau_1, tau_2, tau_3, T_inv, theta_0):
    return {"tau_1": tau_1, "theta": theta_0 + T_inv + tau_2 + tau_3}


@column.mistake("Only the largest of the neglected lags is halved. What happens to a smaller one?")
def _(tau_1, tau_2, tau_3, T_inv, theta_0):
    return {"tau_1": tau_1 + (tau_2 + tau_3) / 2, "theta": theta_0 + T_inv + (tau_2 + tau_3) / 2}


@column.mistake("While the response goes the wrong way, the controller waits: is that more delay, or less?")
def _(tau_2, tau_3, T_inv, theta_0):
    return {"theta": theta_0 - T_inv + tau_2 / 2 + tau_3}


@column.mistake("The inverse response is missing in the delay.")
def _(tau_2, tau_3, theta_0):
    return {"theta": theta_0 + tau_2 / 2 + tau_3}


@column.mistake("The process has a dead time of its own before any rule is applied.")
def _(tau_2, tau_3, T_inv):
    return {"theta": T_inv + tau_2 / 2 + tau_3}


@column.mistake("The lag that is halved has two halves: only one of them goes to the lag that is kept.")
def _(tau_1, tau_2, tau_3, T_inv, theta_0):
    return {"tau_1": tau_1 + tau_2, "theta": theta_0 + T_inv + tau_3}


@column.mistake("Which of the two neglected lags is the larger one? That one is halved, and the other one is not.")
def _(tau_1, tau_2, tau_3, T_inv, theta_0):
    return {"tau_1": tau_1 + tau_3 / 2, "theta": theta_0 + T_inv + tau_2 + tau_3 / 2}


@column.mistake("Three lags in a row begin late, and a single lag as long as their sum does not.")
def _(tau_1, tau_2, tau_3, T_inv, theta_0):
    return {"tau_1": tau_1 + tau_2 + tau_3, "theta": theta_0 + T_inv}


@column.mistake("The smallest lag is missing. It is not halved, but it makes the process late all the same.")
def _(tau_2, T_inv, theta_0):
    return {"theta": theta_0 + T_inv + tau_2 / 2}


@column.mistake("The inverse response makes the process late by its time constant, once and not twice.")
def _(tau_2, tau_3, T_inv, theta_0):
    return {"theta": theta_0 + 2 * T_inv + tau_2 / 2 + tau_3}


@column.mistake("So much the lags make the process late. What else does?")
def _(tau_2, tau_3):
    return {"theta": tau_2 / 2 + tau_3}


column.hints(
    "The half rule keeps the largest lag. Everything else that makes the process late has to go somewhere: where?",
    "The largest lag that is neglected is halved: one half goes to the lag that is kept, the other to the dead time. "
    "All smaller lags go to the dead time as a whole, and so does the time constant of the inverse response.",
    "The lag of {tau_2} is the one that is halved. So half of it is added to {tau_1}, and the dead time of the model "
    "begins with {theta_0} and the other half. What else makes the process late?",
)


@column.solution
def _(tau_1, tau_2):
    r"""The model keeps the largest lag, {tau_1}. The largest one that it neglects, {tau_2}, is halved, and one half
    goes to the lag that is kept: $\tau = {tau_1} + {half}$.

    ***

    That is {lag}. The other half makes the process late. So do the dead time that it has itself, the time constant of
    the inverse response, and the smaller lag as a whole: $\theta = {half} + {theta_0} + {T_inv} + {tau_3}$, which is
    {theta}.

    A check: all lags and delays together are the same before and after.
    """
    return {"half": tau_2 / 2, "lag": (tau_1 + tau_2 / 2, "min")}


@column.picture
def _(tau_1, tau_2, tau_3, T_inv, theta_0):
    """The first minutes after a step of the steam: the composition rests, dips below zero, and then begins to rise."""
    times = _until(2 * (theta_0 + T_inv + tau_3))
    y = System(_column(tau_1, tau_2, tau_3, T_inv, theta_0)).step(times)
    return time_plot({"$y$": (y, "measurement")}, times, "The first minutes", "$t$ [min]", "share of the final value")


@column.solution_picture
def _(tau_1, tau_2, tau_3, T_inv, theta_0):
    """The process and its model: the model waits while the process goes the wrong way; then they stay together."""
    model = exp(-(theta_0 + T_inv + tau_2 / 2 + tau_3) * s) / ((tau_1 + tau_2 / 2) * s + 1)
    return _beside(
        {"process": _column(tau_1, tau_2, tau_3, T_inv, theta_0), "model": model},
        _until(2.5 * (tau_1 + tau_2)),
        "The column and its model",
    )


def _beside(systems, times, title, xlabel="$t$ [min]", ylabel="share of the step"):
    """The step responses of a process and its models."""
    roles = ("process", "model", "second model", "third model")
    curves = {name: (System(H).step(times), role) for (name, H), role in zip(systems.items(), roles, strict=False)}
    return time_plot(curves, times, title, xlabel, ylabel)


@exercise(
    "14.2",
    title="A gas holder, twice simplified",
    points=3,
    insight="Beside an integrator half of a lag is lost: the ramp of the model shows by how much it runs ahead.",
    where=lambda tau_2, tau_3: tau_3 < tau_2 <= 4 * tau_3,
)
def gas_holder(
    k=between(0.2, 2, "%/min", step=0.1, reference=0.4),
    tau_2=between(2, 8, "min", step=1, reference=4),
    tau_3=between(1, 4, "min", step=0.5, reference=1),
):
    r"""The level of a gas holder integrates the flow through its inlet valve. The valve and the level transmitter each
    add a lag. With level and valve position in percent and times in minutes:

    {process}

    For the half rule, the integrator is an infinite lag. Find the model of first order, $g_1$, and that of second
    order, $g_2$. Then the valve opens by one percent, and in the end the level rises as a ramp. How far is the ramp of
    $g_1$ above that of $g$?
    """
    return answers(
        g_1=transfer_function(k * exp(-(tau_2 / 2 + tau_3) * s) / s, "the model of first order"),
        g_2=transfer_function(
            k * exp(-tau_3 / 2 * s) / (s * ((tau_2 + tau_3 / 2) * s + 1)), "the model of second order"
        ),
        ahead=number(k * tau_2 / 2, "%", "the distance of the ramps"),
    )


@gas_holder.shows
def _(k, tau_2, tau_3):
    return {"process": _equation("g", k / (s * (tau_2 * s + 1) * (tau_3 * s + 1)))}


@gas_holder.mistake(
    "In a model of first order the integrator is all that is kept. Half of the lag is lost: it is negligible beside "
    "the integrator."
)
def _(k, tau_2, tau_3):
    return {"g_1": k * exp(-(tau_2 / 2 + tau_3) * s) / (s * (tau_2 / 2 * s + 1))}


@gas_holder.mistake("All of both lags as delay keeps the ramp, but the half rule halves the larger one of them.")
def _(k, tau_2, tau_3):
    return {"g_1": k * exp(-(tau_2 + tau_3) * s) / s}


@gas_holder.mistake(
    "Here the smaller lag is the largest one that is neglected: a half of it goes to the lag that is kept."
)
def _(k, tau_2, tau_3):
    return {"g_2": k * exp(-tau_3 * s) / (s * (tau_2 * s + 1))}


@gas_holder.mistake("Half of the smaller lag is in the delay. Where has the other half gone?")
def _(k, tau_2, tau_3):
    return {"g_2": k * exp(-tau_3 / 2 * s) / (s * (tau_2 * s + 1))}


@gas_holder.mistake("That is how far the ramp of $g$ lies below $kt$. And where does the ramp of $g_1$ lie?")
def _(k, tau_2, tau_3):
    return {"ahead": k * (tau_2 + tau_3)}


@gas_holder.mistake("That is how far the ramp of $g_1$ lies below $kt$. And where does the ramp of $g$ lie?")
def _(k, tau_2, tau_3):
    return {"ahead": k * (tau_2 / 2 + tau_3)}


@gas_holder.mistake("The two are interchanged. The order counts the poles, and the integrator is one of them.")
def _(k, tau_2, tau_3):
    lag = tau_2 + tau_3 / 2
    return {"g_1": k * exp(-tau_3 / 2 * s) / (s * (lag * s + 1)), "g_2": k * exp(-(tau_2 / 2 + tau_3) * s) / s}


@gas_holder.mistake("The integrator is the largest lag of all, and it stays: the level goes on rising.")
def _(k, tau_2, tau_3):
    lag = k * exp(-tau_3 / 2 * s) / ((tau_2 + tau_3 / 2) * s + 1)
    return {"g_1": lag, "g_2": lag}


@gas_holder.mistake("Both lags are halved here. The rule halves only the largest of those that are neglected.")
def _(k, tau_2, tau_3):
    return {"g_1": k * exp(-(tau_2 + tau_3) / 2 * s) / s}


@gas_holder.mistake("One of the two lags is in the dead time. What becomes of the other one?")
def _(k, tau_2):
    return {"g_1": k * exp(-tau_2 / 2 * s) / s}


@gas_holder.mistake("The larger lag has two halves. One is lost beside the integrator, and where is the other one?")
def _(k, tau_3):
    return {"g_1": k * exp(-tau_3 * s) / s}


@gas_holder.mistake("All of the smaller lag is in the lag that is kept. What makes the model late then?")
def _(k, tau_2, tau_3):
    return {"g_2": k / (s * ((tau_2 + tau_3) * s + 1))}


@gas_holder.mistake("The smaller lag has two halves. Here one of them is in the lag, and both are in the dead time.")
def _(k, tau_2, tau_3):
    return {"g_2": k * exp(-tau_3 * s) / (s * ((tau_2 + tau_3 / 2) * s + 1))}


@gas_holder.mistake("By that time, in minutes, the ramp is ahead. How far does a ramp rise in it?")
def _(k, tau_2):
    return {"ahead": tau_2 / 2} if k != 1 else {}


@gas_holder.mistake("Compare how late the two ramps are: the dead time of $g_1$, and all lags of $g$ together.")
def _():
    return {"ahead": 0}


@gas_holder.mistake("All of the smaller lag is in the dead time of $g_1$. Of which lag is a part lost?")
def _(k, tau_3):
    return {"ahead": k * tau_3 / 2}


@gas_holder.mistake("Only a part of the larger lag is lost in $g_1$. Which part is in its dead time?")
def _(k, tau_2):
    return {"ahead": k * tau_2}


gas_holder.hints(
    "Which is the largest lag of this process? It is kept, and it is not {tau_2}.",
    "To first order only the integrator is kept: the larger of the two lags is halved, the smaller becomes dead time. "
    "To second order the larger lag is kept too, and now the smaller one is halved.",
    "The dead time of $g_1$ is $\\frac{ {tau_2} }{2} + {tau_3}$, that of $g_2$ is $\\frac{ {tau_3} }{2}$. For the "
    "ramps: one that is late by a time $\\theta$ is $k\\theta$ below $kt$. How late is each of the two?",
)


@gas_holder.solution
def _(k, tau_2, tau_3):
    r"""The model of first order keeps the integrator. Half of the larger lag goes to it, where it is negligible, and
    half becomes dead time, together with all of the smaller lag: $\frac{ {tau_2} }{2} + {tau_3}$, which is {delay_1}.
    So $g_1 =$ {first}.

    The model of second order keeps the integrator and the larger lag. Now the smaller lag is the largest one that is
    neglected: half of it goes to the lag that is kept, which becomes {lag}, and half, {delay_2}, to the dead time. So
    $g_2 =$ {second}.

    Ramps: $g$ is late by the sum of its lags, {late}, and $g_1$ by {delay_1} only. With a slope of {k}, the ramp of
    $g_1$ is ahead by ${k}\cdot({late} - {delay_1})$, which is {ahead}. This is $k\tau_2/2$: what was lost beside
    the integrator.
    """
    return {
        "delay_1": (tau_2 / 2 + tau_3, "min"),
        "delay_2": (tau_3 / 2, "min"),
        "lag": (tau_2 + tau_3 / 2, "min"),
        "late": (tau_2 + tau_3, "min"),
        "first": k * exp(-(tau_2 / 2 + tau_3) * s) / s,
        "second": k * exp(-tau_3 / 2 * s) / (s * ((tau_2 + tau_3 / 2) * s + 1)),
    }


@gas_holder.solution_picture
def _(k, tau_2, tau_3):
    """The level after a step of the valve, and those of both models: one ramp is ahead, the other one is right."""
    systems = {
        "$g$": k / (s * (tau_2 * s + 1) * (tau_3 * s + 1)),
        "$g_1$": k * exp(-(tau_2 / 2 + tau_3) * s) / s,
        "$g_2$": k * exp(-tau_3 / 2 * s) / (s * ((tau_2 + tau_3 / 2) * s + 1)),
    }
    return _beside(systems, _until(5 * tau_2), "The gas holder and its models", ylabel="level [%]")


def _rule(T_0, tau_0, theta):
    """The rule for a zero beside a lag, and what it puts in the place of both."""
    if theta < tau_0 < T_0:
        return "T1", T_0 / tau_0
    if tau_0 < theta < T_0:
        return "T1a", T_0 / theta
    if tau_0 < T_0:
        return "T1b", Integer(1)
    if 5 * theta < T_0:
        return "T2", T_0 / tau_0
    shorter = min(tau_0, 5 * theta)
    return "T3", shorter / tau_0 / ((shorter - T_0) * s + 1)


def _far_apart(*times):
    """Whether no two times are so near that one could wonder which is the larger one."""
    return all(4 * max(a, b) >= 5 * min(a, b) for n, a in enumerate(times) for b in times[:n])


@exercise(
    "14.3",
    title="A zero beside a lag",
    points=3,
    insight="What a zero beside a lag does depends on the loop: only the first few dead times count.",
    where=lambda T_0, tau_0, theta: _far_apart(T_0, tau_0, theta, 5 * theta),
)
def zero_beside_a_lag(
    # below, about and beyond the dead time, so that each of the five rules has its share
    T_0=choice(2, 2.5, 3, 15, 40, 45, 50, 55, 60, unit="s", reference=6),
    tau_0=choice(1, 1.5, 8, 10, 80, 90, 100, unit="s", reference=40),
    theta=between(4, 5.5, "s", step=0.5, reference=4),
):
    r"""A damper acts on the temperature in an air duct in two ways, one quick and one slow. Together they make a zero
    in the left half-plane, with the time constant $T_0$ = {T_0}, beside a lag $\tau_0$ = {tau_0}. (Times in seconds.)

    {part}

    In the loop around it the effective dead time is $\theta$ = {theta}, and the loop should be as fast as
    that. Which of the rules T1, T1a, T1b, T2 and T3 holds, and what does it put in the place of the fraction?
    """
    rule, instead = _rule(T_0, tau_0, theta)
    return answers(
        rule=word(rule, ["T1", "T1a", "T1b", "T2", "T3"], "the rule"),
        instead=transfer_function(instead, "the replacement"),
    )


def _where_it_is_not(rule):
    def wrong(T_0, tau_0, theta):
        return {"rule": rule} if _rule(T_0, tau_0, theta)[0] != rule else None

    return wrong


for _name, _range in {
    "T1": "T1 is for a lag beyond the dead time below a zero that is longer still.",
    "T1a": "T1a is for a dead time between the two: the lag is shorter than it, and the zero longer.",
    "T1b": "T1b is for a zero and a lag that are both shorter than the dead time, the zero the longer one.",
    "T2": "T2 is for a zero longer than five dead times, below a lag that is longer still.",
    "T3": "T3 is for a zero shorter than the lag, and shorter than five dead times.",
}.items():
    zero_beside_a_lag.mistake(f"{_range} Sort $T_0$ = {{T_0}}, $\\tau_0$ = {{tau_0}} and the dead time of {{theta}}.")(
        _where_it_is_not(_name)
    )


@zero_beside_a_lag.mistake(
    "The lag is long compared with the loop. It is shortened, with the slope kept, before the difference is taken."
)
def _(T_0, tau_0, theta):
    if _rule(T_0, tau_0, theta)[0] == "T3" and tau_0 > 5 * theta:
        return {"instead": 1 / ((tau_0 - T_0) * s + 1)}


@zero_beside_a_lag.mistake(
    "The lag is shortened as it should be. But the slope must stay as it was, and that costs gain."
)
def _(T_0, tau_0, theta):
    if _rule(T_0, tau_0, theta)[0] == "T3" and tau_0 > 5 * theta:
        return {"instead": 1 / ((5 * theta - T_0) * s + 1)}


@zero_beside_a_lag.mistake(
    "That is what a very fast loop would see. Compare both time constants with the dead time once more."
)
def _(T_0, tau_0, theta):
    if _rule(T_0, tau_0, theta)[0] in ("T1a", "T1b", "T3"):
        return {"instead": T_0 / tau_0}


@zero_beside_a_lag.mistake(
    "That is what a very slow loop would see. Compare both time constants with the dead time once more."
)
def _(T_0, tau_0, theta):
    if _rule(T_0, tau_0, theta)[0] != "T1b":
        return {"instead": 1}


@zero_beside_a_lag.mistake("The dead time takes the place of the lag only where the lag is the shorter of the two.")
def _(T_0, tau_0, theta):
    return {"instead": T_0 / theta} if _rule(T_0, tau_0, theta)[0] != "T1a" else {}


@zero_beside_a_lag.mistake("That is the fraction itself. What does the loop see of it?")
def _(T_0, tau_0):
    return {"instead": (T_0 * s + 1) / (tau_0 * s + 1)}


@zero_beside_a_lag.mistake("That is the lag without the zero. Does the zero do nothing in this loop?")
def _(tau_0):
    return {"instead": 1 / (tau_0 * s + 1)}


@zero_beside_a_lag.mistake("The slope is kept by this gain. But a lag is left: the difference of which two times?")
def _(T_0, tau_0, theta):
    if _rule(T_0, tau_0, theta)[0] == "T3" and tau_0 > 5 * theta:
        return {"instead": 5 * theta / tau_0}


@zero_beside_a_lag.mistake("The lag is shortened too far: the loop looks at several dead times, not at one.")
def _(T_0, tau_0, theta):
    if _rule(T_0, tau_0, theta)[0] == "T3" and tau_0 > theta > T_0:
        return {"instead": theta / tau_0 / ((theta - T_0) * s + 1)}


zero_beside_a_lag.hints(
    "A loop that is as fast as its dead time looks at the fraction where $s$ is about $1/\\theta$. What is the "
    "fraction there?",
    "First compare the zero with the lag: a longer zero leads to T1, T1a or T1b, a shorter one to T2 or T3. Then "
    "compare both with the dead time, and a short zero with five dead times.",
    "In numbers: $T_0$ = {T_0}, $\\tau_0$ = {tau_0}, $\\theta$ = {theta}, and five dead times are {five}. Sort these "
    "four by size, and look for the rule whose inequalities they meet.",
)


@zero_beside_a_lag.solution
def _(T_0, tau_0, theta):
    r"""Two comparisons decide. The zero, {T_0}, is {longer} than the lag, {tau_0}. And the dead time is {theta}, five
    of them {five}: {why}.

    So rule {rule} holds, and in the place of the fraction comes {instead}.
    """
    rule, instead = _rule(T_0, tau_0, theta)
    shorter = min(tau_0, 5 * theta)
    shortened = (
        f"the lag is longer than that, and shortened to {float(shorter):g} s with the slope kept, which costs the "
        f"factor "
        f"{float(shorter):g}/{float(tau_0):g}"
        if tau_0 > 5 * theta
        else "the lag need not be shortened"
    )
    return {
        "longer": "longer" if tau_0 < T_0 else "shorter",
        "five": (5 * theta, "s"),
        "instead": instead,
        "why": {
            "T1": "both are longer than the dead time, so the loop sees the quotient of the two",
            "T1a": "the lag is shorter than the dead time, so $\\theta$ takes its place in the quotient",
            "T1b": "both are shorter than the dead time, so the loop sees neither",
            "T2": "the zero is beyond even five dead times, so the loop sees the quotient of the two",
            "T3": f"the zero is shorter than five dead times, so a lag with the difference remains; {shortened}",
        }[rule],
    }


@zero_beside_a_lag.shows
def _(T_0, tau_0, theta):
    return {"part": (T_0 * s + 1) / (tau_0 * s + 1), "five": f"{float(5 * theta):g}\N{NO-BREAK SPACE}s"}


@zero_beside_a_lag.solution_picture
def _(T_0, tau_0, theta):
    """The step response of zero and lag behind the dead time, and of what takes their place."""
    systems = {"zero and lag": (T_0 * s + 1) / (tau_0 * s + 1), "instead": _rule(T_0, tau_0, theta)[1]}
    systems = {name: H * exp(-theta * s) for name, H in systems.items()}
    return _beside(systems, _until(6 * theta), "What the loop sees", "$t$ [s]")


@exercise(
    "14.4",
    title="The price of a fraction",
    points=4,
    insight="A fraction turns the phase by less than the dead time, so the program calls unstable loops stable.",
    where=lambda T, theta: theta <= T <= 8 * theta,
)
def price_of_a_fraction(
    T=between(6, 40, "s", step=1, reference=20),
    theta=between(2, 12, "s", step=0.5, reference=4),
):
    r"""A simulation program knows no dead time. To simulate P control of a process with the gain 1, a lag of {T} and
    a dead time $\theta$ = {theta}, you replace the dead time by its Padé approximation of first order. (Times in
    seconds.)

    Which transfer function does the program simulate? Which ultimate gain will you find with it, and which period of
    the oscillation? And by how many percent is this ultimate gain larger than that of the process with its exact dead
    time?
    """
    K_u = 1 + 2 * T / theta
    program, exact = _gains(T, theta)
    return answers(
        g=transfer_function((1 - theta / 2 * s) / ((1 + theta / 2 * s) * (T * s + 1)), "the process in the program"),
        Ku=number(K_u, "", "the ultimate gain in the program"),
        Pu=number(_period(T, theta, K_u), "s", "the period in the program"),
        too_large=number(100 * (program / exact - 1), "%", "the error of the ultimate gain", within=0.03),
    )


def _period(T, theta, K_u):
    """The period at the limit: theta/2 T s^2 + K_u + 1 = 0, as the term in s vanishes."""
    return 2 * pi * sqrt(theta * T / 2 / (K_u + 1))


def _phase_crossing(T, theta):
    """The frequency in rad/s at which lag and dead time together turn by 180 degrees."""
    from scipy.optimize import brentq

    return brentq(lambda w: math.atan(w * T) + w * theta - math.pi, math.pi / 2 / theta, math.pi / theta)


def _gains(T, theta):
    """The ultimate gain in the program, and that with the exact dead time."""
    return float(1 + 2 * T / theta), math.hypot(1, float(T) * _phase_crossing(float(T), float(theta)))


@price_of_a_fraction.mistake("The dead time is shared between both sides of the fraction bar. Each side gets a half.")
def _(T, theta):
    K_u = 1 + T / theta
    return {
        "g": (1 - theta * s) / ((1 + theta * s) * (T * s + 1)),
        "Ku": K_u,
        "Pu": _period(T, 2 * theta, K_u),
    }


@price_of_a_fraction.mistake(
    "That comes from the Taylor approximation, which has no denominator. Padé's fraction has one."
)
def _(T, theta):
    return {"g": (1 - theta * s) / (T * s + 1), "Ku": T / theta}


@price_of_a_fraction.mistake("That is the process itself. The program has no dead time: what replaces it?")
def _(T, theta):
    return {"g": exp(-theta * s) / (T * s + 1)}


@price_of_a_fraction.mistake(
    "That holds with the exact dead time. The program does not have it: use its transfer function."
)
def _(T, theta):
    return {"Ku": _gains(T, theta)[1], "Pu": 2 * float(pi) / _phase_crossing(float(T), float(theta))}


@price_of_a_fraction.mistake("That is the frequency in rad/s. How long does one oscillation take?")
def _(T, theta):
    return {"Pu": 2 * pi / _period(T, theta, 1 + 2 * T / theta)}


@price_of_a_fraction.mistake("That is the percentage by which the exact gain is smaller. Take the exact gain as 100 %.")
def _(T, theta):
    program, exact = _gains(T, theta)
    return {"too_large": 100 * (1 - exact / program)}


@price_of_a_fraction.mistake("With the signs like this the fraction has an unstable pole. Which side gets the minus?")
def _(T, theta):
    return {"g": (1 + theta / 2 * s) / ((1 - theta / 2 * s) * (T * s + 1))}


@price_of_a_fraction.mistake(
    "In the middle coefficient the denominator has two times, that of the lag and one of the fraction."
)
def _(T, theta):
    return {"Ku": 2 * T / theta}


@price_of_a_fraction.mistake("That holds for an integrator with the exact dead time. Here it is a lag, and a fraction.")
def _(T, theta):
    return {"Ku": float(pi) * T / (2 * theta), "Pu": 4 * theta}


@price_of_a_fraction.mistake("The last coefficient of the polynomial is not 1: the gain of the controller is in it.")
def _(T, theta):
    return {"Pu": _period(T, theta, 0)}


@price_of_a_fraction.mistake("The last coefficient of the polynomial is not the gain alone: the denominator has a 1.")
def _(T, theta):
    return {"Pu": _period(T, theta, 2 * T / theta)}


@price_of_a_fraction.mistake("That would be a dead time alone, which turns by all of the 180°. Here the lag helps.")
def _(theta):
    return {"Pu": 2 * theta}


@price_of_a_fraction.mistake("That is the program's gain in percent of the exact one. How much more than 100 % is it?")
def _(T, theta):
    program, exact = _gains(T, theta)
    return {"too_large": 100 * program / exact}


@price_of_a_fraction.mistake("That is the difference of the two gains. How large is it in percent of the exact one?")
def _(T, theta):
    program, exact = _gains(T, theta)
    return {"too_large": program - exact}


price_of_a_fraction.hints(
    "Padé shares the dead time between numerator and denominator. With a fraction in its place, the limit of stability "
    "can be found from a polynomial.",
    "The characteristic polynomial is the denominator plus $K_u$ times the numerator, here of second order. At the "
    "limit its zeros lie on the imaginary axis: which coefficient vanishes? For the exact dead time, look for the "
    "frequency where $\\arctan\\omega T + \\omega\\theta$ is $\\pi$.",
    "The polynomial is $\\frac{\\theta T}{2}s^2 + \\left(T + \\frac{\\theta}{2} - K_u\\frac{\\theta}{2}\\right)s + 1 + "
    "K_u$, with $T$ = {T} and $\\theta$ = {theta}. Its middle coefficient gives $K_u$, the other two the frequency.",
)


@price_of_a_fraction.solution
def _(T, theta):
    r"""Half of the dead time is above the fraction bar and half below: the program simulates {fraction}.

    With the gain $K_u$ the characteristic polynomial is $\frac{\theta T}{2}s^2 + \left(T + \frac{\theta}{2} -
    K_u\frac{\theta}{2}\right)s + 1 + K_u$. Its zeros lie on the imaginary axis when the coefficient of $s$ vanishes,
    that is at $K_u = 1 + 2T/\theta$, which is {Ku}.

    There $\omega^2 = \frac{1 + K_u}{\theta T/2}$, so $\omega$ is {omega}, and the period $2\pi/\omega$ is {Pu}.

    With the exact dead time the phase is $-180°$ where $\arctan\omega T + \omega\theta = \pi$. A search for the zero
    gives {exact_omega}. The lag has the gain $1/\sqrt{1 + (\omega T)^2}$ there, so the exact ultimate gain is {exact}.
    The one of the program is larger by {too_large}.
    """
    omega = _phase_crossing(float(T), float(theta))
    return {
        "fraction": (1 - theta / 2 * s) / ((1 + theta / 2 * s) * (T * s + 1)),
        "omega": (2 * float(pi) / float(_period(T, theta, 1 + 2 * T / theta)), "rad/s"),
        "exact_omega": (omega, "rad/s"),
        "exact": math.hypot(1, float(T) * omega),
    }


@price_of_a_fraction.solution_picture
def _(T, theta):
    """The exact loop at the program's ultimate gain: its oscillation grows; the program shows one that stays."""
    times = _until(12 * theta)
    gain = PID(1 + 2 * T / theta)
    fraction = (1 - theta / 2 * s) / ((1 + theta / 2 * s) * (T * s + 1))
    processes = {"exact dead time": exp(-theta * s) / (T * s + 1), "in the program": fraction}
    curves = {name: Loop(G, gain).servo.step(times) for name, G in processes.items()}
    return time_plot(curves, times, "Both loops with the program's ultimate gain", ylabel="measurement")


@exercise(
    "14.5",
    title="Before the dead time is over",
    points=4,
    insight="A dead time does nothing at first; the zero of its fraction makes the model move, and the wrong way.",
    where=lambda tau, theta: theta <= tau <= 2 * theta,
)
def before_the_dead_time(
    K=between(1, 4, "K/%", step=0.5, reference=2),
    tau=between(4, 20, "min", step=1, reference=6),
    theta=between(2, 10, "min", step=1, reference=4),
):
    r"""The temperature behind a long heated pipe has the gain {K}, a lag of {tau} and a dead time of {theta}. For a
    state-space model the dead time is replaced by its Padé approximation of first order.

    The heating makes a step of one percent at time zero. Find the response of the *approximation*, as a function of
    the time in minutes, and when and where it has its lowest point.
    """
    moment, lowest = _lowest_point(K, tau, theta)
    return answers(
        y=time_function(_response(K, tau, theta), until=5 * tau, unit="K", what="the response"),
        moment=number(moment, "min", "the moment of the lowest point"),
        lowest=number(lowest, "K", "the lowest value of the response", within=0.02),
    )


def _response(K, tau, theta):
    a = theta / 2
    return K * (1 + (2 * a * exp(-t / a) - (tau + a) * exp(-t / tau)) / (tau - a))


def _lowest_point(K, tau, theta):
    """Time and value of the response where its two exponentials fall and rise equally fast."""
    K, tau, a = float(K), float(tau), float(theta) / 2
    moment = math.log(2 * tau / (tau + a)) * a * tau / (tau - a)
    return moment, K * (1 + (2 * a * math.exp(-moment / a) - (tau + a) * math.exp(-moment / tau)) / (tau - a))


@before_the_dead_time.mistake(
    "Half of the dead time is above the fraction bar and half below; here it is all of it, twice."
)
def _(K, tau, theta):
    if theta != tau:
        return {"y": _response(K, tau, 2 * theta)}


@before_the_dead_time.mistake(
    "That is the response with the exact dead time, which is not the question. The response with the fraction begins "
    "immediately."
)
def _(K, tau, theta):
    return {"y": K * (1 - exp(-(t - theta) / tau)) * Heaviside(t - theta)}


@before_the_dead_time.mistake(
    "That belongs to the exact dead time, and only to the time after it. The response with the fraction begins "
    "immediately."
)
def _(K, tau, theta):
    return {"y": K * (1 - exp(-(t - theta) / tau))}


@before_the_dead_time.mistake("The gain of the process is missing.")
def _(K, tau, theta):
    if K != 1:
        return {"y": _response(1, tau, theta), "lowest": _lowest_point(1, tau, theta)[1]}


@before_the_dead_time.mistake("The zero is there, but the denominator of Padé's fraction is missing.")
def _(K, tau, theta):
    return {"y": K * (1 - (1 + theta / tau) * exp(-t / tau))}


@before_the_dead_time.mistake("The fraction alone begins at minus one. What does the lag behind it do to such a jump?")
def _(K):
    return {"lowest": -K}


@before_the_dead_time.mistake(
    "At that time the exact dead time is over. When does the derivative of your response vanish?"
)
def _(theta):
    return {"moment": theta}


@before_the_dead_time.mistake("That is the response to an impulse. Which factor makes it the one to a step?")
def _(K, tau, theta):
    return {"y": _response(K, tau, theta).diff(t)}


@before_the_dead_time.mistake("The denominator of Padé's fraction is there, but its numerator, the zero, is missing.")
def _(K, tau, theta):
    a = theta / 2
    return {"y": K * (1 + (a * exp(-t / a) - tau * exp(-t / tau)) / (tau - a))}


@before_the_dead_time.mistake("That is the time constant of the fraction. When does the derivative of $y$ vanish?")
def _(theta):
    return {"moment": theta / 2}


@before_the_dead_time.mistake("That is the lag itself. When does the derivative of $y$ vanish?")
def _(tau):
    return {"moment": tau}


@before_the_dead_time.mistake("A logarithm is a pure number. Which times, from the exponents, make minutes of it?")
def _(tau, theta):
    wrong = math.log(float(2 * tau / (tau + theta / 2)))
    return {"moment": wrong}


@before_the_dead_time.mistake(
    "That would be so with the exact dead time. The approximation moves immediately: where to?"
)
def _():
    return {"moment": 0, "lowest": 0}


@before_the_dead_time.mistake("There the response is back at zero. What is zero where it is lowest?")
def _(K, tau, theta):
    low, high = _lowest_point(K, tau, theta)[0], 5 * float(tau)
    tau, a = float(tau), float(theta) / 2
    for _ in range(40):  # halve the range in which the response comes back
        middle = (low + high) / 2
        is_below = tau - a + 2 * a * math.exp(-middle / a) < (tau + a) * math.exp(-middle / tau)
        low, high = (middle, high) if is_below else (low, middle)
    return {"moment": low}


before_the_dead_time.hints(
    "Write the approximation as a transfer function with a zero and two poles. What are they?",
    "$Y(s) = \\frac{{K}}{s}\\,\\frac{1 - a s}{(1 + a s)(\\tau s + 1)}$ with $a = \\theta/2$. Partial fractions make it "
    "a step and two exponentials. The lowest point is where the derivative of $y(t)$ vanishes.",
    "Here $a$ = {a}, so the exponentials are $e^{-t/{a}}$ and $e^{-t/{tau}}$. In the derivative they balance each "
    "other: $e^{-t(1/a - 1/\\tau)} = \\frac{\\tau + a}{2\\tau}$. Take the logarithm.",
)


@before_the_dead_time.shows
def _(theta):
    return {"a": f"{float(theta / 2):g}"}


@before_the_dead_time.solution
def _(K, tau, theta):
    r"""With $a = \theta/2 = {a}$ min, the response of the approximation has the transform
    $Y(s) = \frac{{K}}{s}\,\frac{1 - a s}{(1 + a s)(\tau s + 1)}$.

    Partial fractions: the residue at zero is the gain, at $-1/a$ it is $\frac{2 a K}{\tau - a}$, and at
    $-1/\tau$ it is $-K\frac{\tau + a}{\tau - a}$. So $y(t) =$ {response}.

    It begins at zero and falls. In its derivative the two exponentials balance where $e^{-t(1/a - 1/\tau)} =
    \frac{\tau + a}{2\tau} =$ {balance}. The logarithm is {logarithm}, divided by $1/a - 1/\tau$: the lowest
    point is at {moment}.

    There the response is {lowest}. The process itself is still at rest at that time.
    """
    a = theta / 2
    return {
        "response": _response(K, tau, theta),
        "balance": (tau + a) / (2 * tau),
        "logarithm": math.log(2 * tau / (tau + a)),
    }


@before_the_dead_time.solution_picture
def _(K, tau, theta):
    """The response of the approximation dips below zero at first; the exact one waits for the dead time."""
    times = _until(4 * tau)
    curves = {"Padé": (_response(K, tau, theta), "model"), "exact": (K * exp(-theta * s) / (tau * s + 1), "process")}
    curves["exact"] = (System(curves["exact"][0]).step(times), "process")
    plot = time_plot(curves, times, "Before the dead time is over", "$t$ [min]", "temperature [K]")
    return plot.mark(_lowest_point(K, tau, theta)[0], "lowest", "Padé")


@exercise(
    "14.6",
    title="A controller for the whole process",
    points=5,
    insight="A good model may be crude; what counts is the loop with the whole process.",
    where=lambda T_1, T_2, T_3: T_3 < T_2 and 2 * T_2 <= T_1,
)
def whole_process(
    k=between(0.5, 3, "", step=0.5, reference=2),
    T_1=between(15, 40, "s", step=1, reference=24),
    T_2=between(4, 12, "s", step=1, reference=8),
    T_3=between(1, 4, "s", step=0.5, reference=3),
    theta=between(1, 3, "s", step=0.5, reference=1),
):
    r"""A mill, its classifier and the sensor behind it have been identified one by one. (Times in seconds; control
    signal and measurement are in percent of their ranges.) Together they are

    {process}

    Find a PI controller for which

    - the largest sensitivity $M_s$ of the loop with this process, and not with a model of it, is at most 1.8, and
    - the integral of the control error after a load step of 1 % at the process input is at most {limit}. (It is
      $T_i/K_p$, as long as the loop is stable.)

    Any settings that meet both are right. A reduced model, and Skogestad's rule with $\tau_c = \theta$ and the
    factor 4, are a good way to begin.
    """
    good = _by_half_rule(k, T_1, T_2, T_3, theta)
    process = _whole(k, T_1, T_2, T_3, theta)
    return answers(
        pid=design(
            settings(good, "", "s", "the settings"),
            pi_controller(),
            stable(process),
            largest_sensitivity(process, 100 / T_1, below=1.8),
            criterion("the integral of the error", _area, below=_most(good), unit="% s"),
            draws=lambda pid: _after_a_load(process, pid, 6 * T_1, _most(good)),
        )
    )


def _whole(k, T_1, T_2, T_3, theta):
    return k * exp(-theta * s) / ((T_1 * s + 1) * (T_2 * s + 1) * (T_3 * s + 1))


def _by_half_rule(k, T_1, T_2, T_3, theta):
    tau, delay = T_1 + T_2 / 2, theta + T_2 / 2 + T_3
    return PID(tau / (2 * k * delay), min(tau, 8 * delay))


def _after_a_load(process, pid, end, most):
    times = _until(end)
    y = Loop(process, pid).regulator.step(times)
    plot = time_plot({"$y$": (y, "measurement")}, times, "Your loop after a load step of 1 %", ylabel="$y$ [%]")
    return plot.area("$y$", label=f"at most {most:g} % s")


def _most(good):
    """The integral of the error that may be: some 15 % more than that of the settings by the half rule."""
    value = 1.15 * _area(good)
    return round(value) if value < 50 else 5 * round(value / 5)


def _area(pid):
    """The integral of the control error after a load step of one percent."""
    return float(pid.Ti / pid.Kp)


@whole_process.shows
def _(k, T_1, T_2, T_3, theta):
    good = _by_half_rule(k, T_1, T_2, T_3, theta)
    return {
        "process": _equation("g", _whole(k, T_1, T_2, T_3, theta)),
        "limit": f"{_most(good):g}\N{NO-BREAK SPACE}% s",
    }


@whole_process.mistake("The small lags are not in the model. But the loop has them: count them in the delay.")
def _(k, T_1, T_2, T_3, theta):
    return {"pid": PID(T_1 / (2 * k * theta), min(T_1, 8 * theta))}


@whole_process.mistake("That is stable enough, but too careful: only half of the largest neglected lag becomes delay.")
def _(k, T_1, T_2, T_3, theta):
    delay = theta + T_2 + T_3
    return {"pid": PID(T_1 / (2 * k * delay), min(T_1, 8 * delay))}


@whole_process.mistake("Ziegler and Nichols' settings for the model are quick against loads. Which limit do they miss?")
def _(k, T_1, T_2, T_3, theta):
    delay = theta + T_2 / 2 + T_3
    return {"pid": PID(Rational(9, 10) * (T_1 + T_2 / 2) / (k * delay), Rational(333, 100) * delay)}


@whole_process.mistake("The gain of the process is missing: the loop has the product of both gains.")
def _(k, T_1, T_2, T_3, theta):
    return {"pid": _by_half_rule(1, T_1, T_2, T_3, theta)} if k != 1 else {}


@whole_process.mistake("The rule adds $\\tau_c$ to the dead time of the model. Without it, how robust is the loop?")
def _(k, T_1, T_2, T_3, theta):
    tau, delay = T_1 + T_2 / 2, theta + T_2 / 2 + T_3
    return {"pid": PID(tau / (k * delay), min(tau, 4 * delay))}


@whole_process.mistake("The lag is that of the model. Its dead time is longer than that of the process: by what?")
def _(k, T_1, T_2, T_3, theta):
    tau = T_1 + T_2 / 2
    return {"pid": PID(tau / (2 * k * theta), min(tau, 8 * theta))}


whole_process.hints(
    "Do not tune with the whole process. Reduce it first, to one lag and a dead time.",
    "The half rule keeps the largest lag. Skogestad's rule then gives $K_p = \\frac{\\tau}{k(\\tau_c + \\theta)}$ and "
    "the shorter of $\\tau$ and $4(\\tau_c + \\theta)$ for $T_i$, with the dead time of the *model*.",
    "The model has the lag ${T_1} + \\frac{ {T_2} }{2}$ and the dead time ${theta} + \\frac{ {T_2} }{2} + {T_3}$. With "
    "$\\tau_c = \\theta$ its settings meet both limits. Check $M_s$ with `margins(pid.expr * process).Ms`.",
)


@whole_process.solution
def _(k, T_1, T_2, T_3, theta):
    r"""The half rule keeps the lag of {T_1} and halves that of {T_2}. The model has the lag {lag} and the dead time
    {delay}; the gain stays {k}.

    Skogestad's rule with $\tau_c$ as long as this dead time: $K_p = \frac{\tau}{2k\theta}$ is {gain}, and $T_i$ is the
    shorter of $\tau$ and $8\theta$, that is {time}.

    The loop with the whole process has the integral of the error $T_i/K_p$, which is {area} and below {limit}. Its
    $M_s$ is below 1.8, and there is some robustness to spare: the gain may be a little larger, or the integral time
    a little shorter.
    """
    good = _by_half_rule(k, T_1, T_2, T_3, theta)
    return {
        "lag": (T_1 + T_2 / 2, "s"),
        "delay": (theta + T_2 / 2 + T_3, "s"),
        "gain": good.Kp,
        "time": (good.Ti, "s"),
        "area": (_area(good), "% s"),
    }


# each model, and what it does to the lags of a process: (first lag, second lag, dead time)
_MODELS = {
    "half_rule": lambda a, b, c, d, e: (a + b / 2, 0, b / 2 + c + d + e),
    "all_as_delay": lambda a, b, c, d, e: (a, 0, b + c + d + e),
    "neglected": lambda a, b, c, d, e: (a, 0, e),
    "second_order": lambda a, b, c, d, e: (a, b + c / 2, c / 2 + d + e),
}
_CURVES = "ABCD"
_ORDERS = ["".join(order) for order in itertools.permutations(_CURVES)]


@exercise(
    "14.7",
    title="Four models of one process",
    points=3,
    insight="Look where a response begins and how it begins: the dead time and the order of a model show there first.",
)
def four_models(
    tau_1=between(20, 32, "min", step=1, reference=24),
    tau_2=between(8, 14, "min", step=1, reference=10),
    tau_3=between(2, 5, "min", step=0.5, reference=4),
    T_inv=between(1, 4, "min", step=0.5, reference=2),
    theta_0=between(1, 3, "min", step=0.5, reference=1),
    order=choice(*_ORDERS, reference="CADB"),
):
    r"""A coil heats the air of a long duct. Its lags, a small inverse response and the dead time of the sensor were
    measured one by one (times in minutes):

    {process}

    Four people have simplified it:

    - by the half rule to one lag and a dead time,
    - by the half rule to two lags and a dead time,
    - to the largest lag, with *all* that it neglects as dead time,
    - to the largest lag and the dead time of the sensor; the rest is *neglected*.

    The picture shows the step responses of the four models, A to D, beside that of the process. Which curve belongs to
    which model? (`t, y, A, B, C, D = exercise("14.7").given("t", "y", "A", "B", "C", "D")` are the times, the response
    of the process, and the four curves.)
    """
    curves = dict(zip(_MODELS, order, strict=True))
    return answers(
        half_rule=word(curves["half_rule"], _CURVES, "the model of first order by the half rule"),
        second_order=word(curves["second_order"], _CURVES, "the model of second order by the half rule"),
        all_as_delay=word(curves["all_as_delay"], _CURVES, "the largest lag with all else as dead time"),
        neglected=word(curves["neglected"], _CURVES, "the largest lag with all else neglected"),
    )


def _model(name, *times):
    first, second, delay = _MODELS[name](*times)
    return exp(-delay * s) / ((first * s + 1) * (second * s + 1))


@four_models.shows
def _(tau_1, tau_2, tau_3, T_inv, theta_0, order):
    times = _until(3 * tau_1)
    process = _column(tau_1, tau_2, tau_3, T_inv, theta_0)
    curves = {
        label: System(_model(name, tau_1, tau_2, tau_3, T_inv, theta_0)).step(times)
        for name, label in zip(_MODELS, order, strict=True)
    }
    return {"process": _equation("g", process), "t": times, "y": System(process).step(times), **curves}


@four_models.picture
def _(tau_1, tau_2, tau_3, T_inv, theta_0, order):
    """The step responses of the process and of the models A to D, which begin at different times."""
    times = _until(2 * tau_1)
    names = dict(zip(order, _MODELS, strict=True))
    curves = {"process": (System(_column(tau_1, tau_2, tau_3, T_inv, theta_0)).step(times), "process")}
    for look, label in enumerate(_CURVES):
        curves[label] = (System(_model(names[label], tau_1, tau_2, tau_3, T_inv, theta_0)).step(times), look)
    return time_plot(curves, times, "Which curve is which model?", "$t$ [min]", "share of the step")


def _confused(one, other):
    def wrong(order):
        curves = dict(zip(_MODELS, order, strict=True))
        return {one: curves[other], other: curves[one]}

    return wrong


for _one, _other, _sentence in (
    ("half_rule", "all_as_delay", "How much of the second lag does each of the two make dead time?"),
    ("half_rule", "neglected", "A model that neglects all small lags begins early, one by the half rule does not."),
    ("half_rule", "second_order", "A model with one lag begins with a corner, one with two lags begins smoothly."),
    ("all_as_delay", "neglected", "All small times as dead time: does that make a response begin later, or earlier?"),
    ("all_as_delay", "second_order", "Two lags begin smoothly and soon. Is this curve smooth where it begins?"),
    ("neglected", "second_order", "Both begin early. Which of them lies far from the process afterwards, and why?"),
):
    four_models.mistake(_sentence)(_confused(_one, _other))


four_models.hints(
    "A response begins when the dead time of its model is over. Whose dead time is the shortest, whose the longest?",
    "Work out the dead time of each model: the half rule halves the largest lag that is neglected, and makes smaller "
    "ones, the inverse response and the dead time itself delay as a whole. Two lags begin without a corner.",
    "The one that neglects the small lags begins at {theta_0}, the one with all of them as dead time last. Find these "
    "two in the picture. Of the other two, one begins with a corner.",
)


@four_models.solution
def _(tau_1, tau_2, tau_3, T_inv, theta_0, order):
    r"""Each model begins when its dead time is over:

    - all small lags neglected: after {neglected}. That is curve {of_neglected}, which is far ahead of the process.
    - by the half rule to second order: half of {tau_3}, the inverse response and the dead time, together
      {second_order}. That is curve {of_second_order}. It has two lags, so it begins smoothly and stays nearest.
    - by the half rule to first order: half of {tau_2}, all of {tau_3}, the inverse response and the dead time, together
      {half_rule}. That is curve {of_half_rule}, which begins with a corner.
    - all as dead time: after {all_as_delay}. That is curve {of_all_as_delay}, the last one to begin, and too late.
    """
    times = (tau_1, tau_2, tau_3, T_inv, theta_0)
    begins = {name: (model(*times)[2], "min") for name, model in _MODELS.items()}
    return begins | {f"of_{name}": label for name, label in zip(_MODELS, order, strict=True)}
