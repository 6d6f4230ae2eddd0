"""Exercises of chapter 18, integral criteria: what they punish, and how they are computed."""

import math

import numpy as np
from sympy import Rational, exp

from loopbook import diagrams
from loopbook.deadtime import Loop
from loopbook.exercises.authoring import (
    answers,
    between,
    choice,
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
from loopbook.figures import plane_plot, time_plot
from loopbook.ise import pi_first_order
from loopbook.pid import PID
from loopbook.transfer import first_order, integrator


def _until(end):
    """Times for a picture."""
    return np.linspace(0, float(end), 401)


def _clear(T, delay):
    """Whether both criteria have a clear winner."""
    return abs(T / (2 * delay) - 1) > 0.08 and abs(2 * (T / delay) ** 2 - 1) > 0.15


def _winner(A, B):
    return "A" if A < B else "B"


@exercise(
    "18.1",
    title="Two loops in a contest",
    points=2,
    where=_clear,
    insight="A criterion is a taste: the square dislikes a bad beginning, the time dislikes a long end.",
)
def contest(
    # short, about as long as the lag, and long, so that A wins both, one or none of the two
    delay=choice(3, 3.5, 4, 10, 12, 14, 36, 40, 45, unit="s", reference=10),
    T=between(8, 24, "s", step=2, reference=16),
):
    """Two loops control the same tank, with sensors at different places. After a unit step of the setpoint the error
    of loop A stays at 1 for {delay}, because its sensor is far away, and is zero from then on. The error of loop B
    begins to fade immediately, like a lag of {T}. The picture shows both.

    Compute the integral of the squared error (ISE) and that of the absolute error multiplied with time (ITAE) for both
    loops. Which loop wins by the first criterion, and which by the second?
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


@contest.mistake("Both add up errors, and the smaller sum wins. Is each of your two sums the right one?")
def _(delay, T):
    return {"by_ISE": _winner(-delay, -T / 2), "by_ITAE": _winner(-(delay**2) / 2, -(T**2))}


@contest.mistake("For loop B this is the integral of the error itself: where has the factor of time gone?")
def _(delay, T):
    return {"ITAE": [delay**2 / 2, T]}


@contest.mistake("Those are the integrals of the errors themselves. Where has the factor of time gone?")
def _(delay, T):
    return {"ITAE": [delay, T]}


@contest.mistake("For loop B the integral of $t\\,e^{-t/T}$ has no half in it: integrate by parts.")
def _(delay, T):
    return {"ITAE": [delay**2 / 2, T**2 / 2]}


@contest.mistake("For loop A the square of one is one: its integral is the time itself.")
def _(delay, T):
    return {"ISE": [delay**2, T / 2]}


contest.hints(
    "Write down both errors as functions of time first: one is a rectangle, the other an exponential.",
    "A: the integrals of 1 and of $t$, from 0 to $\\theta$. B: the integrals of $e^{-2t/T}$ and of $t\\,e^{-t/T}$, "
    "from 0 to infinity.",
    "$\\int_0^{ {delay} } 1\\,dt$ and $\\int_0^\\infty e^{-2t/{T}} dt$ make the ISE, $\\int_0^{ {delay} } t\\,dt$ and "
    "$\\int_0^\\infty t\\,e^{-t/{T}} dt$ the ITAE.",
)


@contest.picture
def _(delay, T):
    """The errors over time: that of A is one and then jumps to zero, that of B fades from the beginning."""
    times = np.linspace(0, float(max(3 * T, Rational(5, 4) * delay)), 2001)
    curves = {"A": (np.where(times < float(delay), 1.0, 0.0), 0), "B": (np.exp(-times / float(T)), 1)}
    return time_plot(curves, times, "After a unit step of the setpoint", ylabel="error")


@contest.solution
def _(delay, T):
    r"""**ISE.** The error of A is 1 for {delay}, and so is its square: a rectangle. The error of B is $e^{-t/T}$. Its
    square fades twice as fast, so that the integral is half of $T$.

    ***

    So the ISE is {A_ISE} for A, and {B_ISE} for B.

    **ITAE.** The product of the error of A with time is a triangle, half of $\theta^2$: {A_ITAE}. For B,
    $\int_0^\infty t\,e^{-t/T} dt = T^2$, which is {B_ITAE}.

    The smaller one wins: loop {by_ISE} by ISE, and loop {by_ITAE} by ITAE.
    """
    return {
        "A_ISE": (delay, "s"),
        "B_ISE": (T / 2, "s"),
        "A_ITAE": (delay**2 / 2, "s²"),
        "B_ITAE": (T**2, "s²"),
    }


@contest.solution_picture
def _(delay, T):
    """What is added up: the squared errors above, and below the errors multiplied by the time."""
    times = np.linspace(0, float(max(3 * T, Rational(5, 4) * delay)), 2001)
    A, B = np.where(times < float(delay), 1.0, 0.0), np.exp(-times / float(T))
    panels = [{"A": (A**2, 0), "B": (B**2, 1)}, {"A, with time": (times * A, 0), "B, with time": (times * B, 1)}]
    return time_plot(panels, times, "What is added up", ylabel=["$e^2$", "$t\\,|e|$ [s]"])


@exercise(
    "18.2",
    title="A level by Parseval",
    points=3,
    where=lambda Kc: Kc != 1,
    insight="Parseval's theorem adds up a whole response without ever computing it.",
)
def level(
    K=between(0.02, 0.2, "1/min", reference=0.05),
    Kc=between(1.5, 8, "", reference=4),
    Ti=between(5, 40, "min", reference=25),
):
    r"""The level of a tank [%] integrates the position of the inflow valve [%] with the slope {K}: so much does the
    level rise in a minute for each percent of valve. There is no dead time. A PI controller with the gain {Kc} and the
    integral time {Ti} controls it.

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


@level.mistake("The gain multiplies the integral term, too: look at the last coefficient of the denominator.")
def _(K, Kc, Ti):
    return {"E": s / (s**2 + K * Kc * s + K / Ti)}


@level.mistake("That is with a gain alone. The controller has an integral term as well.")
def _(K, Kc):
    return {"E": 1 / (s + K * Kc)}


@level.mistake("That is the error after an impulse of the setpoint. Which factor belongs to a step?")
def _(K, Kc, Ti):
    a = K * Kc
    return {"E": s**2 / (s**2 + a * s + a / Ti)}


@level.mistake("The load goes through the tank before it is an error: $b_0$ is its slope, squared in the formula.")
def _(K, Kc, Ti):
    a = K * Kc
    return {"load": Ti / (2 * a**2)}


@level.mistake("That is after the setpoint step. Which of the $b$ is zero after the load?")
def _(K, Kc, Ti):
    wrong = 1 / (2 * K * Kc)
    return {"load": wrong} if _differs(wrong, Ti / (2 * Kc**2)) else {}


@level.mistake("That is the integral of the error itself, which overshoots. Square it first.")
def _():
    return {"servo": 0}


level.hints(
    "The error is $\\frac{1}{1 + L}$ times the setpoint. What is $L$ here?",
    "$L = K_c\\left(1 + \\frac{1}{T_i s}\\right)\\frac{{K}}{s}$. With $a = K K_c$ the error after the setpoint step is "
    "$\\frac{s}{s^2 + a s + a/T_i}$. After the load step the process comes first: $\\frac{-K}{s^2 + a s + a/T_i}$.",
    "$a = {K} \\cdot {Kc}$. In the formula, $a_1 = a$ and $a_0 = a/T_i$. For the setpoint $b_1 = 1$ and $b_0 = 0$; for "
    "the load $b_1 = 0$ and $b_0 = -K$.",
)


@level.picture
def _(K, Kc, Ti):
    """Block diagram: setpoint, PI controller, the load d added to its signal, the tank, and the level fed back."""
    forward = ["e", diagrams.block("PI"), "u", diagrams.disturbance("d"), integrator(K)]
    return diagrams.block_diagram("y_{SP}", diagrams.feedback_loop(forward), "y")


@level.solution
def _(K, Kc, Ti):
    r"""The open loop is $L = K_c\,\frac{T_i s + 1}{T_i s}\,\frac{{K}}{s}$, and $E = \frac{1}{1 + L}\,\frac{1}{s}$. With
    $a = K K_c = {K} \cdot {Kc}$, which is {a}, that is $\frac{s}{s^2 + a s + a/T_i}$, or {error}.

    In the formula $b_1 = 1$, $b_0 = 0$ and $a_1 = a$. So the ISE after the setpoint step is $\frac{1}{2a}$, which is
    {servo}. The integral time is not in it.

    After the load step $E = \frac{-K}{s^2 + a s + a/T_i}$. Now $b_1 = 0$ and $b_0 = -K$, and $\frac{K^2}{2\,a\,a/T_i}$
    is $\frac{T_i}{2 K_c^2} = \frac{ {Ti} }{2 \cdot {Kc}^2}$, which is {load}. The slope of the tank is not in it.
    """
    return {"a": (K * Kc, "1/min"), "error": s / (s**2 + K * Kc * s + K * Kc / Ti)}


@level.solution_picture
def _(K, Kc, Ti):
    """The squared errors over time after the setpoint step and after the load step, each with its area shaded."""
    loop, times = Loop(integrator(K), PID(Kc, Ti)), _until(6 * Ti)
    e, y = 1 - loop.servo.step(times), loop.regulator.step(times)
    panels = [{"setpoint": (e**2, 0)}, {"load": (y**2, 1)}]
    plot = time_plot(panels, times, "What the ISE adds up", "$t$ [min]", ["$e^2$, setpoint", "$e^2$, load"])
    return plot.area("setpoint").area("load")


@exercise(
    "18.3",
    title="The best gain for a conveyor",
    points=4,
    insight="The least ISE of this loop has a phase margin of 48°, whatever slope and dead time are.",
    where=lambda K, delay, Kp: 0.25 <= K * delay * Kp <= 1.2 and abs(K * delay * Kp - 0.739) > 0.05,
)
def conveyor(
    K=between(0.01, 0.2, "1/s", reference=0.05),
    delay=between(2, 20, "s", reference=8),
    Kp=between(0.5, 6, "", reference=1, step=0.25),
):
    r"""A belt carries wood chips to a bin. The level of the bin [%] integrates the speed of the belt [%] with the
    slope $K$ = {K}, but only after the chips have travelled for $\theta$ = {delay}. A proportional controller with the
    gain $K_p$ = {Kp} controls the level.

    How large is the phase margin, and how large the ISE after a unit step of the setpoint? Which $K_p$ gives the least
    ISE, and how large is it then? (This exercise needs the loop in the section *More than one dead time*, which is
    further reading: with $x = K K_p\theta$ its ISE is $\theta\,\frac{\cos x}{2x\,(1 - \sin x)}$.)
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


@conveyor.mistake("That is $x$, a pure number. Which factors of it belong to the process?")
def _(K, delay):
    return {"best_gain": 0.7390851332151607} if abs(K * delay - 1) > 0.05 else {}


@conveyor.mistake("With this gain the loop is on the limit of stability. Where does the derivative of the ISE vanish?")
def _(K, delay):
    return {"best_gain": math.pi / (2 * float(K * delay))}


@conveyor.mistake("Here sine and cosine are of an angle in degrees. The number $x$ is in radians.")
def _(K, delay, Kp):
    x = float(K * Kp * delay)
    r = math.radians(x)
    return {"ISE": float(delay) * math.cos(r) / (2 * x * (1 - math.sin(r)))}


@conveyor.mistake("In the denominator the sine is subtracted from one: the ISE grows towards the limit of stability.")
def _(K, delay, Kp):
    x = float(K * Kp * delay)
    return {"ISE": float(delay) * math.cos(x) / (2 * x * (1 + math.sin(x)))}


@conveyor.mistake("This is in dead times. How long is one?")
def _():
    return {"least_ISE": _of_integrator(0.7390851332151607)}


@conveyor.mistake("An angle in radians was taken from one in degrees.")
def _(K, delay, Kp):
    return {"phase_margin": 90 - float(K * Kp * delay)}


conveyor.hints(
    "Only one number matters in this loop: $x = K K_p\\theta$, its gain times its dead time.",
    "The crossover frequency is $K K_p$, and the dead time turns the phase there by $x$ (in radians). The least ISE is "
    "where the derivative of $\\frac{\\cos x}{2x\\,(1 - \\sin x)}$ vanishes.",
    "$x = {K} \\cdot {Kp} \\cdot {delay}$. The derivative vanishes where $x = \\cos x$: press the cosine key of a "
    "calculator (in radians) again and again.",
)


@conveyor.solution
def _(K, delay, Kp):
    r"""The gain of the loop times its dead time is $x = K K_p\theta = {K} \cdot {Kp} \cdot {delay}$, which is {x}.

    The open loop is $\frac{K K_p}{s}e^{-\theta s}$. Its gain is one at $\omega = K K_p$. There the integrator has
    turned the phase by 90°, and the dead time by $x$, which is {turned}. What is left is the phase margin,
    {phase_margin}.

    The ISE is $\theta\,\frac{\cos x}{2x\,(1 - \sin x)}$, that is {ISE}.

    The derivative of this vanishes where $x = \cos x$. That has one solution, {best}. So the best gain is
    $\frac{ {best} }{ {K} \cdot {delay} }$, which is {best_gain}, and the least ISE is {least_ISE}. Its phase margin is
    48°.
    """
    x = float(K * Kp * delay)
    return {"x": x, "turned": (math.degrees(x), "deg"), "best": 0.7390851332151607}


@conveyor.solution_picture
def _(K, delay, Kp):
    """The ISE over the gain: flat around the best gain, and steep towards the limit of stability."""
    x = np.linspace(0.2, 1.4, 200)
    curve = [float(delay) * _of_integrator(one) for one in x]
    scale, best = float(K * delay), 0.7390851332151607
    plot = plane_plot({"ISE": (x / scale, curve)}, "$K_p$", "ISE [s]", "The ISE over the gain")
    plot.points([best / scale], [float(delay) * _of_integrator(best)], "best", "x")
    return plot.points([float(Kp)], [float(delay) * _of_integrator(float(Kp) * scale)], "as given")


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
    insight="All that the dead time does to the ISE goes through the phase margin and one value of the open loop.",
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

    Two of them lie on the imaginary axis. Which frequency do they give, and which phase margin has the loop there?
    Then compute the ISE after a unit step of the setpoint. (This exercise needs the section *The formula in symbols*,
    which is further reading.)
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


def _margins_without_one(K, T, delay, Kc, Ti):
    """The phase margin without the dead time, without the lag, and with the dead time in radians."""
    w, _ = _crossover(K, T, Kc, Ti)
    right = _phase_margin(K, T, delay, Kc, Ti)
    turned = w * float(delay)
    return (
        right + math.degrees(turned),
        right + math.degrees(math.atan(w * float(T))),
        right + math.degrees(turned) - turned,
    )


@four_points.mistake(
    "One of the three that turn the phase is missing, or not in degrees: the dead time, the lag, the integral term."
)
def _(K, T, delay, Kc, Ti):
    without, lag, _ = _margins_without_one(K, T, delay, Kc, Ti)
    return {"phase_margin": without} if abs(lag / without - 1) < 0.02 else {}


def _without(which):
    def wrong(K, T, delay, Kc, Ti):
        return {"phase_margin": _margins_without_one(K, T, delay, Kc, Ti)[which]}

    return wrong


for _which, _sentence in enumerate(
    (
        "The dead time turns the phase, too: by $\\omega\\theta$ radians. How many degrees are that?",
        "The lag turns the phase, too. By how much at this frequency?",
        "The dead time turns by $\\omega\\theta$ in radians. How many degrees are that?",
    )
):
    four_points.mistake(_sentence)(_without(_which))


@four_points.mistake("That is how far the phase of the loop lags. The margin is what the lag leaves of half a turn.")
def _(K, T, delay, Kc, Ti):
    return {"phase_margin": 180 - _phase_margin(K, T, delay, Kc, Ti)}


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


@four_points.mistake("The integral term turns the phase, too. How much of a right angle is left of it at crossover?")
def _(K, T, delay, Kc, Ti):
    w, _ = _crossover(K, T, Kc, Ti)
    return {"phase_margin": 180 - math.degrees(math.atan(w * float(T)) + w * float(delay))}


@four_points.mistake("That is $\\sigma$, from the positive root. The frequency belongs to the negative one.")
def _(K, T, Kc, Ti):
    w, _ = _crossover(K, T, Kc, Ti)
    sigma = float(K * Kc) / (float(T * Ti) * w)
    return {"crossover": sigma} if _differs(sigma, w) else {}


@four_points.mistake("That is the root of the equation in $s^2$. The frequency is the square root of its size.")
def _(K, T, Kc, Ti):
    w, _ = _crossover(K, T, Kc, Ti)
    return {"crossover": w**2} if _differs(w, 1) else {}


@four_points.mistake("That would be a loop as fast as a lag of $T$ behind the dead time. Here the formula decides.")
def _(K, T, delay, Kc, Ti):
    wrong = float(delay + T / 2)
    return {"ISE": wrong} if _differs(wrong, _ISE(K, T, delay, Kc, Ti)) else {}


four_points.hints(
    "$\\Delta(s) = 0$ is a quadratic equation in $s^2$. What do its two roots mean?",
    "The negative root is $-\\omega^2$: at the crossover frequency $\\omega$ the open loop has the gain one. The "
    "positive one is $\\sigma^2$. The phase margin is $\\varphi = \\pi - \\omega\\theta - \\arctan\\omega T - "
    "\\arctan\\frac{1}{\\omega T_i}$.",
    "With $k = {K} \\cdot {Kc}$: $\\omega^2 = \\frac{\\sqrt{b^2 + 4 k^2 T^2 T_i^2} + b}{2 T^2 T_i^2}$ with $b = T_i^2 "
    "(k^2 - 1)$, and $\\sigma^2$ with $-b$ instead of $b$. Then the formula of the section.",
)


@four_points.solution
def _(K, T, delay, Kc, Ti):
    r"""With $k = K K_c = {K} \cdot {Kc}$, which is {k}, $\Delta = 0$ is a quadratic equation in $s^2$. Its negative
    root is $-\omega^2$ with the crossover frequency $\omega$ of {crossover}. Its positive root is $\sigma^2$ with
    $\sigma$ = {sigma}.

    The phase margin is $\varphi = \pi - \omega\theta - \arctan\omega T - \arctan\frac{1}{\omega T_i}$: of 180°, the
    dead time takes {by_delay}, the lag {by_lag}, and the integral term {by_integral}. What is left is {phase_margin}.

    At the real point the open loop has the value $\ell = L(\sigma) = k\,\frac{T_i\sigma + 1}{T_i\sigma\,(T\sigma +
    1)}\,e^{-\theta\sigma}$, which is {ell}.

    The formula is $\frac{1}{2T^2(\sigma^2 + \omega^2)}\left[\frac{1 + \omega^2T^2}{\omega}\,\cot\frac{\varphi}{2} -
    \frac{1 - \sigma^2T^2}{\sigma}\,\frac{1 - \ell}{1 + \ell}\right]$. The first part of the bracket is {at_omega}, the
    second {at_sigma}, and the factor in front of it {factor}. So the ISE is {ISE}.
    """
    K, T, delay, Kc, Ti = (float(x) for x in (K, T, delay, Kc, Ti))
    w, _ = _crossover(K, T, Kc, Ti)
    sigma = K * Kc / (T * Ti * w)
    ell = K * Kc * (Ti * sigma + 1) / (Ti * sigma * (T * sigma + 1)) * math.exp(-delay * sigma)
    half = math.radians(_phase_margin(K, T, delay, Kc, Ti)) / 2
    return {
        "k": K * Kc,
        "sigma": (sigma, "1/s"),
        "by_delay": (math.degrees(w * delay), "deg"),
        "by_lag": (math.degrees(math.atan(w * T)), "deg"),
        "by_integral": (math.degrees(math.atan(1 / (w * Ti))), "deg"),
        "ell": ell,
        "at_omega": (1 + (w * T) ** 2) / w / math.tan(half),
        "at_sigma": (1 - (sigma * T) ** 2) / sigma * (1 - ell) / (1 + ell),
        "factor": 1 / (2 * T**2 * (sigma**2 + w**2)),
    }


@four_points.solution_picture
def _(K, T, delay, Kc, Ti):
    """The squared error after the setpoint step, with its area shaded."""
    times = _until(3 * (T + delay))
    e = 1 - Loop(first_order(K, T, delay), PID(Kc, Ti)).servo.step(times)
    plot = time_plot({"$e^2$": (e**2, "measurement")}, times, "What the ISE adds up")
    return plot.area("$e^2$", label=f"{_ISE(K, T, delay, Kc, Ti):.3g} s")


@exercise(
    "18.5",
    title="Nearly the least ISE, but robust",
    points=6,
    where=lambda T, delay: T / 3 <= delay <= 3 * T,
    insight="A least value is flat: a few percent of the ISE buy a loop that is robust.",
)
def nearly_least(
    K=between(0.2, 4, "", reference=0.8),
    T=between(4, 30, "s", reference=12),
    delay=between(2, 20, "s", reference=6),
):
    r"""The settings with the least ISE oscillate for a long time and are not robust. A little more ISE buys much.

    For a process with the gain {K}, a lag of {T} and a dead time of {delay}, design a PI controller whose $M_s$ is at
    most 1.8, and whose ISE after a unit step of the setpoint is at most {limit}. That is 8 % more than the least one
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
            draws=lambda controller: _after_a_setpoint(K, T, delay, controller),
        )
    )


def _after_a_setpoint(K, T, delay, controller):
    times = _until(10 * delay)
    y = Loop(first_order(K, T, delay), controller).servo.step(times)
    panels = [{"$y$": (y, "measurement")}, {"$e^2$": ((1 - y) ** 2, 0)}]
    plot = time_plot(panels, times, "Your loop after a unit step of the setpoint", ylabel=["$y$", "$e^2$"])
    value = _ISE(K, T, delay, controller.Kp, controller.Ti)
    return plot.area("$e^2$", label=f"ISE {value:.4g} s, at most {_limit(delay):g}")


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


@nearly_least.mistake("That asks the loop to have no time constant of its own. How robust can it be then?")
def _(K, T, delay):
    return {"controller": PID(T / (K * delay), T)}


@nearly_least.mistake("The two settings are interchanged: which of them is a time, and which a gain?")
def _(K, T, delay):
    wrong = PID(T, Rational(57, 100) * T / (K * delay))
    return {"controller": wrong} if K * delay >= 2 else {}


@nearly_least.mistake("The gain of the process is missing: the loop has the product of both gains.")
def _(K, T, delay):
    return {"controller": PID(Rational(57, 100) * T / delay, T)} if K >= 2 or Rational(1, 2) >= K else {}


nearly_least.hints(
    "Begin with $T_i = T$: the lag is cancelled, and the loop is that of an integrator with dead time.",
    "Then only $x = \\frac{K K_c\\theta}{{T}}$ matters. The ISE is $\\theta\\,\\frac{\\cos x}{2x\\,(1 - \\sin x)}$, "
    "least at 0.739, and a smaller $x$ is more robust. How small may it be?",
    "Try a few values between 0.5, the cautious choice, and 0.739, with $K_c = x\\,\\frac{ {T} }{ {K} \\cdot {delay} "
    "}$ and $T_i$ = {T}. `margins` has $M_s$.",
)


@nearly_least.solution
def _(K, T, delay):
    r"""With $T_i = T$ the lag is cancelled, and $x = \frac{K K_c\theta}{{T}}$ alone decides. The ISE is
    $\theta\,\frac{\cos x}{2x\,(1 - \sin x)}$: least at $x = 0.739$, with {least}, but there $M_s$ is {M_least}.

    With $x = 0.5$, a closed-loop time constant as long as the dead time, $M_s$ is {M_cautious}, but the ISE is
    {cautious}, more than the {limit} that are asked.

    Between them there is a window. With $x = 0.57$ the ISE is {chosen}, and $M_s$ is {M_chosen}: both limits are met.

    So $K_c = 0.57\,\frac{ {T} }{ {K} \cdot {delay} }$, which is {gain}, and $T_i$ is {T}.
    """
    w = np.linspace(0.01, 6, 4000)  # in dead times
    found = {"least": 0.7390851332151607, "cautious": 0.5, "chosen": 0.57}
    largest = {f"M_{name}": f"{max(1 / abs(1 + x * np.exp(-1j * w) / (1j * w))):.3g}" for name, x in found.items()}
    values = {name: (float(delay) * _of_integrator(x), "s") for name, x in found.items()}
    return {**largest, **values, "gain": Rational(57, 100) * T / (K * delay)}


def _corners(wait, fall, down, up, depth):
    """The corners of an error that waits, falls through zero, and comes back: times and values."""
    times = np.cumsum([0, wait, fall, down, up]).astype(float)
    return times, np.array([1, 1, 0, -float(depth), 0])


def _changed(wait, fall, down, up, depth, change):
    """The corners after the change: a worse beginning, or one more oscillation at the end."""
    times, e = _corners(wait, fall, down, up, depth)
    if change == "beginning":
        return times, np.array([1, 1.8, *e[2:]])
    return np.append(times, times[-1] + [3.0, 6.0]), np.append(e, [0.6 * float(depth), 0])


def _criteria(times, e):
    """IAE, ISE and ITAE of an error of straight lines that changes its sign only at corners."""
    step, (first, second) = np.diff(times), np.abs((e[:-1], e[1:]))
    return (
        float(step @ (first + second) / 2),
        float(step @ (first**2 + first * second + second**2) / 3),
        float(step @ (times[:-1] * (2 * first + second) + times[1:] * (first + 2 * second)) / 6),
    )


_NAMES = ["IAE", "ISE", "ITAE"]


@exercise(
    "18.6",
    title="Areas by ruler",
    points=4,
    where=lambda wait, fall, down, up, depth: 5 * wait**2 > _criteria(*_corners(wait, fall, down, up, depth))[2],
    insight="Squares notice what is large, the time notices what is late: ask both before you trust one.",
)
def areas(
    wait=between(3, 6, "s", step=1, reference=3),
    fall=between(3, 6, "s", step=1, reference=4),
    down=between(1, 4, "s", step=1, reference=2),
    up=between(2, 6, "s", step=1, reference=5),
    depth=between(0.3, 0.6, "", step=0.1, reference=0.5),
    change=choice("beginning", "end"),
):
    r"""The picture shows the error of a loop after a unit step of the setpoint, drawn in straight lines with dots at
    the corners. Read off the corners, and compute the integral of the absolute error (IAE), that of the squared error
    (ISE), and that of the absolute error multiplied with time (ITAE).

    Then somebody changes the loop, and its error follows the dashed line where the two differ. Which of the three
    grows most, in percent of its value before?
    (`t, e, changed = exercise("18.6").given("t", "e", "changed")` are the times and both errors.)
    """
    before = _criteria(*_corners(wait, fall, down, up, depth))
    after = _criteria(*_changed(wait, fall, down, up, depth, change))
    growth = [new / old for new, old in zip(after, before, strict=True)]
    IAE, ISE, ITAE = before
    return answers(
        IAE=number(IAE, "s", "the IAE", within=0.05),
        ISE=number(ISE, "s", "the ISE", within=0.05),
        ITAE=number(ITAE, "s²", "the ITAE", within=0.07),
        grows=word(_NAMES[int(np.argmax(growth))], _NAMES, "the one that grows most"),
    )


def _two_errors(wait, fall, down, up, depth, change):
    both = _corners(wait, fall, down, up, depth), _changed(wait, fall, down, up, depth, change)
    times = np.linspace(0, float(wait + fall + down + up + 7), 20 * int(wait + fall + down + up + 7) + 1)
    return times, *(np.interp(times, *corners) for corners in both)


@areas.shows
def _(wait, fall, down, up, depth, change):
    return dict(zip(("t", "e", "changed"), _two_errors(wait, fall, down, up, depth, change), strict=True))


@areas.picture
def _(wait, fall, down, up, depth, change):
    """The error in straight lines: it stays at one, falls below zero, and returns; dashed, after the change."""
    times, e, changed = _two_errors(wait, fall, down, up, depth, change)
    curves = {"error": (e, "measurement"), "after the change": (changed, "setpoint")}
    plot = time_plot(curves, times, "After a unit step of the setpoint", ylabel="error")
    return plot.points(*_corners(wait, fall, down, up, depth), "corners")


@areas.mistake("Below zero it is an error, too: the absolute value does not let areas cancel each other.")
def _(wait, fall, down, up, depth):
    return {"IAE": wait + fall / 2 - depth * (down + up) / 2}


@areas.mistake("A triangle is half of its rectangle. Squared, its sides are parabolas: which share is left then?")
def _(wait, fall, down, up, depth):
    return {"ISE": wait + fall / 2 + depth**2 * (down + up) / 2}


@areas.mistake("Square the error first, and then integrate: the square of an area is something else.")
def _(wait, fall, down, up, depth):
    return {"ISE": (wait + fall / 2 + depth * (down + up) / 2) ** 2}


@areas.mistake(
    "While the error stays at one, its product with time is a triangle, not a rectangle. And then it falls: its centre "
    "of gravity is nearer to the upright side."
)
def _(wait, fall, down, up, depth):
    times, e = _corners(wait, fall, down, up, depth)
    return {"ITAE": _criteria(times, e)[2] + float(wait) ** 2 / 2}


@areas.mistake("Time is counted from the step of the setpoint for every part, not from where the part begins.")
def _(wait, fall, down, up, depth):
    times, e = _corners(wait, fall, down, up, depth)
    parts = zip(np.diff(times), abs(e[:-1]), abs(e[1:]), strict=True)
    return {"ITAE": float(sum(step**2 * (first + 2 * second) / 6 for step, first, second in parts))}


def _instead(name):
    def wrong(wait, fall, down, up, depth, change):
        before = _criteria(*_corners(wait, fall, down, up, depth))
        after = _criteria(*_changed(wait, fall, down, up, depth, change))
        best = _NAMES[int(np.argmax(np.divide(after, before)))]
        return {"grows": name} if name != best else None

    return wrong


for _name, _question in {
    "IAE": "The IAE counts all errors alike. Is there a criterion that counts just these errors more?",
    "ISE": "Squares make large errors count more, and small ones hardly. Are those that were added large?",
    "ITAE": "The time makes late errors count more, and early ones hardly. Are those that were added late?",
}.items():
    areas.mistake(_question)(_instead(_name))


def _parts(wait, fall, down, up, depth):
    """IAE, ISE and ITAE of the part above zero, and of the one below."""
    times, e = _corners(wait, fall, down, up, depth)
    return _criteria(times[:3], e[:3]), _criteria(times[2:], e[2:])


def _apart(wrong, *corners):
    """Those of three wrong values that a ruler can tell from the right ones."""
    both = zip(_NAMES, wrong, _criteria(*_corners(*corners)), strict=True)
    return {name: value for name, value, right in both if value is not None and abs(float(value) / right - 1) > 0.1}


@areas.mistake("The part below zero is missing: it is an error, too.")
def _(wait, fall, down, up, depth):
    return _apart(_parts(wait, fall, down, up, depth)[0], wait, fall, down, up, depth)


@areas.mistake("The part below zero is subtracted here. Squares and absolute values are never negative.")
def _(wait, fall, down, up, depth):
    above, below = _parts(wait, fall, down, up, depth)
    return _apart(np.subtract(above, below), wait, fall, down, up, depth)


@areas.mistake("A triangle is half of its rectangle.")
def _(wait, fall, down, up, depth):
    return {"IAE": wait + fall + depth * (down + up)}


@areas.mistake("Below zero the depth has to be squared as well.")
def _(wait, fall, down, up, depth):
    return _apart((None, wait + fall / 3 + depth * (down + up) / 3, None), wait, fall, down, up, depth)


@areas.mistake("That belongs to the dashed line. Asked is first the error before the change.")
def _(wait, fall, down, up, depth, change):
    return _apart(_criteria(*_changed(wait, fall, down, up, depth, change)), wait, fall, down, up, depth)


areas.hints(
    "Between two corners the error is a straight line. Cut the picture into a rectangle and triangles.",
    "A triangle of width $b$ and height $h$ has the area $\\frac{bh}{2}$; squared it has $\\frac{b h^2}{3}$. "
    "Multiplied with time it has its area times the time of its centre of gravity, a third of the width from the "
    "upright side.",
    "The first corner after the rectangle is where the error leaves 1. With $w$ for its time, the rectangle gives $w$, "
    "$w$ and $\\frac{w^2}{2}$ for the three. The next part is the triangle down to zero.",
)


@areas.solution
def _(wait, fall, down, up, depth, change):
    r"""There are three parts: a rectangle of {wait}, a triangle that falls to zero in {fall}, and one below zero,
    {both} wide and {depth} high.

    **IAE.** The areas: ${wait} + \frac{ {fall} }{2} + \frac{ {both} \cdot {depth} }{2}$, which is {IAE}.

    **ISE.** A squared triangle has a third of its rectangle: ${wait} + \frac{ {fall} }{3} + \frac{ {both} \cdot
    {depth}^2}{3}$, which is {ISE}.

    **ITAE.** Each area times the time of its centre of gravity. The rectangle: {first} at {centre_1}. The falling
    triangle: {second} at {centre_2}. The one below zero: {third} at {centre_3}. The sum of the products is {ITAE}.

    **The change.** It adds {what}. IAE, ISE and ITAE grow by {growth}. So {grows} grows most.
    """
    before = _criteria(*_corners(wait, fall, down, up, depth))
    after = _criteria(*_changed(wait, fall, down, up, depth, change))
    start = wait + fall
    percent = [f"{100 * (new / old - 1):.3g} %" for new, old in zip(after, before, strict=True)]
    return {
        "both": (down + up, "s"),
        "first": (wait, "s"),
        "centre_1": (wait / 2, "s"),
        "second": (fall / 2, "s"),
        "centre_2": (wait + fall / 3, "s"),
        "third": (depth * (down + up) / 2, "s"),
        "centre_3": (start + (2 * down + up) / 3, "s"),
        "what": "a large error at the beginning" if change == "beginning" else "a small error at the end",
        "growth": f"{percent[0]}, {percent[1]} and {percent[2]}",
    }


@areas.solution_picture
def _(wait, fall, down, up, depth, change):
    """What the three criteria add up before the change: the absolute error, its square, and its product with time."""
    times, e, _ = _two_errors(wait, fall, down, up, depth, change)
    panels = [{"$|e|$": (abs(e), 0)}, {"$e^2$": (e**2, 1)}, {"$t\\,|e|$": (times * abs(e), 2)}]
    plot = time_plot(panels, times, "What is added up", low=True)
    return plot.area("$|e|$").area("$e^2$").area("$t\\,|e|$")
