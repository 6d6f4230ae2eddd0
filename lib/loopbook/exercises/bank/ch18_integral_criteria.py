"""Exercises of chapter 18, integral criteria: what they punish, and how they are computed."""

import math

from sympy import Rational, exp

from loopbook.exercises.authoring import (
    answers,
    between,
    criterion,
    design,
    exercise,
    largest_sensitivity,
    number,
    numbers,
    pi_controller,
    settings,
    stable,
    transfer_function,
    word,
)
from loopbook.expressions import s
from loopbook.ise import pi_first_order
from loopbook.pid import PID


def _clear(T, delay):
    """Whether both criteria have a clear winner."""
    return abs(T / (2 * delay) - 1) > 0.08 and abs(2 * (T / delay) ** 2 - 1) > 0.15


def _winner(A, B):
    return "A" if A < B else "B"


@exercise(
    "18.1",
    title="Two loops in a contest",
    points=2,
    where=lambda T, delay: 3 * delay >= T and delay <= 3 * T and _clear(T, delay),
)
def contest(
    delay=between(4, 20, "s", reference=10),
    T=between(4, 40, "s", reference=16),
):
    """Two loops control the same tank, with sensors at different places. After a unit step of the setpoint the error
    of loop A stays at 1 for {delay}, because its sensor is far away, and is zero from then on. The error of loop B
    begins to fade at once, like a lag of {T}.

    Compute the integral of the squared error (ISE) and the one of the absolute error multiplied with time (ITAE) for
    both loops. Which loop wins by the first, which by the second criterion?
    """
    ISE, ITAE = [delay, T / 2], [delay**2 / 2, T**2]
    return answers(
        ISE=numbers(ISE, "s", "the ISE of A and of B"),
        ITAE=numbers(ITAE, "s²", "the ITAE of A and of B"),
        by_ISE=word(_winner(*ISE), ["A", "B"], what="the winner by ISE"),
        by_ITAE=word(_winner(*ITAE), ["A", "B"], what="the winner by ITAE"),
    )


@contest.mistake("A squared error fades twice as fast.")
def _(delay, T):
    return {"ISE": [delay, T]}


@contest.mistake("For loop B the error was squared as well; the A in ITAE stands for the absolute value.")
def _(delay, T):
    return {"ITAE": [delay**2 / 2, T**2 / 4]}


@contest.mistake("While the error of A stays at 1, its product with time is a triangle. How large is its area?")
def _(delay, T):
    return {"ITAE": [delay**2, T**2]}


@contest.mistake("Both are sums of errors: the smaller one wins.")
def _(delay, T):
    return {"by_ISE": _winner(-delay, -T / 2), "by_ITAE": _winner(-(delay**2) / 2, -(T**2))}


@exercise("18.2", title="A level by Parseval", points=3, where=lambda Kc: Kc != 1)
def level(
    K=between(0.02, 0.2, "1/min", reference=0.05),
    Kc=between(1.5, 8, "", reference=4),
    Ti=between(5, 40, "min", reference=25),
):
    r"""The level of a tank [%] integrates the position of the inflow valve [%] with the slope {K}: each percent of
    valve raises the level by so many percent in a minute. There is no dead time, and a PI controller with the gain
    {Kc} and the integral time {Ti}.

    Find the transform $E(s)$ of the error after a unit step of the setpoint, and by Parseval's theorem its ISE. What
    is the ISE after a unit step of the load at the input of the process?

    (For $E(s) = \frac{b_1 s + b_0}{s^2 + a_1 s + a_0}$ the residues give $\mathrm{ISE} = \frac{a_0 b_1^2 + b_0^2}{2
    a_0 a_1}$.)
    """
    a = K * Kc
    return answers(
        E=transfer_function(s / (s**2 + a * s + a / Ti), "the transform of the error"),
        servo=number(1 / (2 * a), "min", "the ISE after the setpoint step"),
        load=number(Ti / (2 * Kc**2), "min", "the ISE after the load step"),
    )


@level.mistake("That is the transform of the level. The error is the setpoint minus the level.")
def _(K, Kc, Ti):
    a = K * Kc
    return {"E": (a * s + a / Ti) / (s * (s**2 + a * s + a / Ti))}


@level.mistake("That is the transform after the load step.")
def _(K, Kc, Ti):
    a = K * Kc
    return {"E": K / (s**2 + a * s + a / Ti)}


@level.mistake("There is a factor of two too much: look at the formula, or think of the ISE of a lag.")
def _(K, Kc, Ti):
    return {"servo": 1 / (K * Kc), "load": Ti / Kc**2}


@level.mistake("That is the integral of the error itself; it has to be squared first.")
def _(Kc, Ti):
    return {"load": Ti / Kc}


@exercise(
    "18.3",
    title="The best gain for a conveyor",
    points=4,
    where=lambda K, delay, Kp: 0.25 <= K * delay * Kp <= 1.2 and abs(K * delay * Kp - 0.739) > 0.05,
)
def conveyor(
    K=between(0.01, 0.2, "1/s", reference=0.05),
    delay=between(2, 20, "s", reference=8),
    Kp=between(0.5, 6, "", reference=1, step=0.25),
):
    r"""A belt carries wood chips to a bin. The level of the bin [%] integrates the speed of the belt [%] with the
    slope $K$ = {K}, but only after the chips have travelled for $\theta$ = {delay}. A proportional controller with
    the gain $K_p$ = {Kp} controls the level.

    How large is the phase margin, and how large is the ISE after a unit step of the setpoint? Which $K_p$ gives the
    least ISE, and how large is that?
    """
    x, best = float(K * Kp * delay), 0.7390851332151607  # x = cos(x)
    return answers(
        phase_margin=number(90 - math.degrees(x), "deg", "the phase margin"),
        ISE=number(float(delay) * _of_integrator(x), "s", "the ISE"),
        best_gain=number(best / float(K * delay), "", "the best gain"),
        least_ISE=number(float(delay) * _of_integrator(best), "s", "the least ISE"),
    )


def _of_integrator(x):
    """The ISE of an integrator with dead time, in dead times; x is the gain of the loop times the dead time."""
    return math.cos(x) / (2 * x * (1 - math.sin(x)))


@conveyor.mistake("That is the ISE without dead time. Even the time before the first chips arrive adds more.")
def _(K, Kp):
    return {"ISE": 1 / (2 * K * Kp)}


@conveyor.mistake("The integrator has turned the phase by a right angle already.")
def _(K, delay, Kp):
    return {"phase_margin": 180 - math.degrees(float(K * Kp * delay))}


@conveyor.mistake("By that angle the dead time turns the phase. The margin is what is left of a right angle.")
def _(K, delay, Kp):
    x = math.degrees(float(K * Kp * delay))
    return {"phase_margin": x} if abs(x - 45) > 3 else {}


@conveyor.mistake("That is the gain of the whole loop. Which part of it is the slope of the process?")
def _(delay):
    return {"best_gain": 0.7390851332151607 / float(delay)}


@conveyor.mistake("Half of the ultimate gain is close, but it is a rule of thumb. Look for the zero of the derivative.")
def _(K, delay):
    return {"best_gain": math.pi / (4 * float(K * delay))}


def _crossover(K, T, Kc, Ti):
    """The frequency where a PI loop around a lag has the gain one, and the phase there without dead time [rad]."""
    K, T, Kc, Ti = (float(x) for x in (K, T, Kc, Ti))
    b = Ti**2 * ((K * Kc) ** 2 - 1)
    w = math.sqrt((b + math.sqrt(b**2 + 4 * (K * Kc * T * Ti) ** 2)) / 2) / (T * Ti)
    return w, math.atan(w * Ti) - math.pi / 2 - math.atan(w * T)


def _phase_margin(K, T, delay, Kc, Ti):
    w, phase = _crossover(K, T, Kc, Ti)
    return 180 + math.degrees(phase - w * float(delay))


@exercise(
    "18.4",
    title="Four points for a PI loop",
    points=4,
    where=lambda K, T, delay, Kc, Ti: Ti != T and 25 <= _phase_margin(K, T, delay, Kc, Ti) <= 80,
)
def four_points(
    K=between(0.5, 3, "", reference=1.5),
    T=between(4, 20, "s", reference=10),
    delay=between(1, 12, "s", reference=4),
    Kc=between(0.25, 3, "", reference=0.8),
    Ti=between(3, 20, "s", reference=8),
):
    r"""A process with the gain $K$ = {K}, a lag of $T$ = {T} and the dead time $\theta$ = {delay} is controlled by a
    PI controller with the gain $K_c$ = {Kc} and the integral time $T_i$ = {Ti}. Its ISE comes from four points, the
    zeros of $\Delta(s) = T^2 T_i^2 s^4 + T_i^2 (k^2 - 1) s^2 - k^2$ with $k = K K_c$.

    Two of them lie on the imaginary axis. Which frequency do they give, and what phase margin has the loop there?
    Then compute the ISE after a unit step of the setpoint.
    """
    w, _ = _crossover(K, T, Kc, Ti)
    return answers(
        crossover=number(w, "rad/s", "the crossover frequency"),
        phase_margin=number(_phase_margin(K, T, delay, Kc, Ti), "deg", "the phase margin"),
        ISE=number(_ISE(K, T, delay, Kc, Ti), "s", "the ISE"),
    )


def _ISE(K, T, delay, Kc, Ti, mode="servo"):
    """The ISE of a PI loop around a lag with dead time, infinite if it is not stable."""
    if not 0 < Ti < math.inf:
        return math.inf
    return float(pi_first_order(*(float(x) for x in (K, T, delay, Kc, Ti)), mode, math.inf))


def _differs(value, key):
    return abs(value / key - 1) > 0.03


@four_points.mistake("Here the integral time does not cancel the lag, so the crossover is not that of an integrator.")
def _(K, T, Kc, Ti):
    w = float(K * Kc / Ti)
    return {"crossover": w} if _differs(w, _crossover(K, T, Kc, Ti)[0]) else {}


@four_points.mistake("The dead time turns the phase, too.")
def _(K, T, delay, Kc, Ti):
    return {"phase_margin": _phase_margin(K, T, 0, Kc, Ti)}


@four_points.mistake("That is the ISE after a step of the load.")
def _(K, T, delay, Kc, Ti):
    settings_ = K, T, delay, Kc, Ti
    load, key = _ISE(*settings_, "regulator"), _ISE(*settings_)
    return {"ISE": load} if _differs(load, key) else {}


@four_points.mistake(
    "That is the ISE without the dead time, which is in the phase margin and in the value of $L$ at the real point."
)
def _(K, T, delay, Kc, Ti):
    return {"ISE": _ISE(K, T, 0, Kc, Ti)}


@exercise("18.5", title="Nearly the least ISE, but robust", points=6, where=lambda T, delay: T / 3 <= delay <= 3 * T)
def nearly_least(
    K=between(0.2, 4, "", reference=0.8),
    T=between(4, 30, "s", reference=12),
    delay=between(2, 20, "s", reference=6),
):
    r"""The settings with the least ISE oscillate for long and are not robust. A little more ISE buys much.

    For a process with the gain {K}, a lag of {T} and a dead time of {delay}, design a PI controller whose $M_s$ is at
    most 1.8, and whose ISE after a unit step of the setpoint is at most {limit}, which is 8 % above the least one
    that a controller with $T_i = T$ can have. Many settings do it, and any that do are right.
    """
    return answers(
        controller=design(
            settings(PID(Rational(57, 100) * T / (K * delay), T), time="s", what="the settings of the PI controller"),
            pi_controller(),
            stable(by=lambda controller: _ISE(K, T, delay, controller.Kp, controller.Ti) < math.inf),
            largest_sensitivity(K * exp(-delay * s) / (T * s + 1), 20 / delay, below=1.8),
            criterion(
                "the ISE",
                lambda controller: _ISE(K, T, delay, controller.Kp, controller.Ti),
                below=_limit(delay),
                unit="s",
            ),
        )
    )


def _limit(delay):
    return round(1.08 * float(delay) * _of_integrator(0.7390851332151607), 2)


@nearly_least.shows
def _(delay):
    return {"limit": f"{_limit(delay):g} s"}


@nearly_least.mistake("That is the least ISE with this integral time. It leaves too little robustness.")
def _(K, T, delay):
    return {"controller": PID(Rational(739, 1000) * T / (K * delay), T)}


@nearly_least.mistake(
    "That is the usual choice of a closed-loop time constant as long as the dead time. It is robust, but a little "
    "faster is asked."
)
def _(K, T, delay):
    return {"controller": PID(T / (2 * K * delay), T)}
