"""Tuning the air heater

A fan blows air through a pipe, an electric heater warms it, and a sensor downstream measures its temperature. In these
five exercises you find a model of the heater, write it as a transfer function, tune a controller for it, look at the
closed loop, and at last design a controller of your own.

The numbers are yours alone. Each answer is judged to 1 %, so keep three or four digits on the way.
"""

from sympy import Rational, exp, sqrt, symbols

from loopbook.exercises.authoring import (
    Late,
    answers,
    between,
    choice,
    criterion,
    design,
    exercise,
    expression,
    largest_sensitivity,
    number,
    pi_controller,
    poles,
    settings,
    stable,
    transfer_function,
    word,
)
from loopbook.expressions import s
from loopbook.pid import PID

# Whoever knows it can compute the variants: an assignment that counts has a secret of its own, and stays secret itself.
SECRET = "an-example-that-everybody-may-read"
DUE = "2026-11-20 23:59 Europe/Berlin"
LATE = Late(percent=10, per="day", grace_minutes=15, at_most=50)


@exercise(
    "1", title="A step in the power", points=3, where=lambda t_28, t_63: 2 * t_28 <= t_63 <= Rational(5, 2) * t_28
)
def step_in_power(
    step=between(5, 20, "%", step=2.5, reference=10),
    rise=between(6, 24, "K", step=1.5, reference=12),
    t_28=between(12, 30, "s", step=1, reference=16),
    t_63=between(28, 70, "s", step=2, reference=36),
):
    """With the controller in manual mode, the power of the heater is raised by {step}. The temperature rises by {rise}
    in the end. It has covered 28 % of the rise {t_28} after the step, and 63 % after {t_63}.

    Find the gain, the time constant and the dead time of a lag with dead time that does the same: without dead time, a
    lag has covered 28 % after a third of its time constant, and 63 % after one.
    """
    T = Rational(3, 2) * (t_63 - t_28)
    return answers(
        K=number(rise / step, "K/%", "the gain"),
        T=number(T, "s", "the time constant"),
        tau=number(t_63 - T, "s", "the dead time", within=0.05),  # more exact numbers than 28 % and 63 % do no harm
    )


@step_in_power.mistake("That is the whole rise. The gain is the rise for one percent of power.")
def _(rise):
    return {"K": rise}


@step_in_power.mistake("That is the time from the step on. A part of it is dead time.")
def _(t_63):
    return {"T": t_63}


@step_in_power.mistake("At 28 % the response has been on its way for a third of the time constant already.")
def _(t_28):
    return {"tau": t_28}


_K, _K_p, _K_d = symbols("K K_p K_d", positive=True)


@exercise("2", title="The heater as a transfer function", points=3)
def as_transfer_function(
    K=between(0.5, 2, "K/%", step=0.1, reference=1.2),
    T=between(20, 60, "s", step=5, reference=30),
    delay=between(3, 9, "s", step=1, reference=6),
    K_p=between(1, 6, "%/K", step=0.5, reference=2),
):
    r"""A model of the heater has the gain {K}, the time constant {T} and the dead time {delay}. Write its transfer
    function from power to temperature, with the time in seconds and without units.

    Then let a P controller with the gain $K_p$ hold the temperature. A disturbance $d$ at the input of the process, in
    percent of power, stays for good: by how much does the temperature leave the setpoint in the end, for $d = 1$ %?
    Answer in the symbols $K$ and $K_p$ (type `K` and `K_p`), and then for $K_p$ = {K_p}.
    """
    return answers(
        H=transfer_function(K * exp(-delay * s) / (T * s + 1), "the transfer function"),
        e_s=expression(_K / (1 + _K * _K_p), "the deviation in symbols", symbols="K K_p"),
        e_s_1=number(K / (1 + K * K_p), "K", "the deviation"),
    )


@as_transfer_function.mistake("A time constant multiplies $s$ in the denominator, and a dead time in an exponent.")
def _(K, T, delay):
    return {"H": K * exp(-T * s) / (delay * s + 1)}


@as_transfer_function.mistake(
    "That is the part of a setpoint that is left over. Here the disturbance passes the process."
)
def _(K, K_p):
    left_over = {"e_s": 1 / (1 + _K * _K_p), "e_s_1": 1 / (1 + K * K_p)}
    return left_over if K != 1 else {"e_s": left_over["e_s"]}


@as_transfer_function.mistake("That is the deviation without a controller.")
def _(K):
    return {"e_s": _K, "e_s_1": K}


@exercise("3", title="Settings by Skogestad's rule", points=3)
def settings_by_rule(
    K=between(0.5, 2, "K/%", step=0.1, reference=1.2),
    T=between(20, 60, "s", step=5, reference=30),
    delay=between(3, 9, "s", step=1, reference=6),
    c=choice(2, 4),
):
    r"""Tune a PI controller for the heater with the gain {K}, the time constant {T} and the dead time {delay} by
    Skogestad's rule: $T_C$ equal to the dead time, and the factor {c} in $T_i = \min(T, c\,(T_C + \tau))$.
    """
    return answers(pid=settings(PID(T / (K * 2 * delay), min(T, 2 * c * delay)), "%/K", "s", "the settings"))


@settings_by_rule.mistake("The dead time counts twice in $K_p$: as itself, and as $T_C$.")
def _(K, T, delay, c):
    return {"pid": PID(T / (K * delay), min(T, 2 * c * delay))}


@settings_by_rule.mistake("The integral time is the smaller one of two. Which other one is there?")
def _(K, T, delay, c):
    return {"pid": PID(T / (K * 2 * delay), max(T, 2 * c * delay))} if 2 * c * delay != T else {}


@exercise(
    "4",
    title="The loop, without dead time",
    points=2,
    where=lambda K, T, K_p, T_i: _quadratic(K, T, K_p, T_i)[1] != 0,
)
def loop_without_dead_time(
    K=between(0.5, 2, "K/%", step=0.1, reference=1.2),
    T=between(20, 60, "s", step=5, reference=30),
    K_p=between(1, 6, "%/K", step=0.5, reference=2),
    T_i=between(4, 40, "s", step=4, reference=8),
):
    r"""At a high flow the dead time hardly counts, and the heater is a lag with the gain {K} and the time constant {T}.
    A PI controller has $K_p$ = {K_p} and $T_i$ = {T_i}. Where are the poles of the loop, and does it oscillate?
    """
    b, under_the_root = _quadratic(K, T, K_p, T_i)
    root = sqrt(under_the_root)
    return answers(
        poles=poles([(-b + root) / 2, (-b - root) / 2], "rad/s", "the poles"),
        swings=word("yes" if under_the_root < 0 else "no", ["yes", "no"], "whether the loop oscillates"),
    )


def _quadratic(K, T, K_p, T_i):
    """Of the loop's polynomial s^2 + b s + c: b, and b^2 - 4 c."""
    b, c = (1 + K * K_p) / T, K * K_p / (T * T_i)
    return b, b**2 - 4 * c


@loop_without_dead_time.mistake("That is the pole of the heater alone, and the integrator.")
def _(T):
    return {"poles": [-1 / T, 0]}


@loop_without_dead_time.mistake("Poles with an imaginary part belong to a response that oscillates.")
def _(K, T, K_p, T_i):
    return {"swings": "no" if _quadratic(K, T, K_p, T_i)[1] < 0 else "yes"}


@exercise("5", title="A controller of your own", points=4)
def controller_of_your_own(
    K=between(0.5, 2, "K/%", step=0.1, reference=1.2),
    T=between(30, 60, "s", step=5, reference=30),
    delay=between(4, 8, "s", step=1, reference=6),
):
    r"""Design a PI controller for the heater with the gain {K}, the time constant {T} and the dead time {delay}. It
    should

    - leave the loop a margin: the largest sensitivity $M_s$ is at most 1.7;
    - fight disturbances: after a step of 1 % at the input of the process, the integral of the control error is at most
      {limit}. (It is $T_i/K_p$, as long as the loop is stable.)

    Any settings that do both are right.
    """
    process = K * exp(-delay * s) / (T * s + 1)
    return answers(
        pid=design(
            settings(PID(T / (K * 2 * delay), T), "%/K", "s", "the settings"),
            pi_controller(),
            stable(process),
            largest_sensitivity(process, until=30 / delay, below=1.7),
            criterion("the integral of the error", lambda pid: pid.Ti / pid.Kp, below=_limit(K, delay), unit="K s/%"),
        )
    )


def _limit(K, delay):
    """A fifth more than Skogestad's rule leaves where the integral time is the time constant."""
    return round(float(Rational(12, 5) * K * delay), 1)


@controller_of_your_own.shows
def _(K, delay):
    return {"limit": f"{_limit(K, delay):g}\N{NO-BREAK SPACE}K s/%"}


@controller_of_your_own.mistake("With $T_C = 2\\tau$ there is margin enough, but disturbances stay for too long.")
def _(K, T, delay):
    return {"pid": PID(T / (K * 3 * delay), T)}


@controller_of_your_own.mistake("With $T_C = 0$ the loop is quick, and close to its limit of stability.")
def _(K, T, delay):
    return {"pid": PID(T / (K * delay), T)}
