"""Exercises of chapter 19, robustness: margins, unstable poles, and processes that change."""

import functools
import math

import numpy as np
from sympy import Rational, exp, log, symbols

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
    word,
)
from loopbook.expressions import s
from loopbook.figures import plane_plot, time_plot
from loopbook.ise import pi_first_order
from loopbook.pid import PID
from loopbook.stability import robustness_pi_first_order, shinskey_window
from loopbook.transfer import feedback, first_order


@exercise(
    "19.1",
    title="Three margins of one loop",
    points=2,
    where=lambda K, T, delay, Kc: 0.25 <= K * Kc * delay / T <= 1.2,
    insight="The gain margin says how much stronger the process may become, the delay margin how much "
    "slower; a phase margin is only a step on the way to it.",
)
def three_margins(
    K=between(0.5, 4, "", reference=2),
    T=between(5, 40, "s", reference=20),
    delay=between(2, 20, "s", reference=6),
    Kc=between(0.5, 4, "", reference=1.5),
):
    r"""A heat exchanger, with its signals in percent, has the gain {K}, a lag of {T} and a dead time of {delay}. Its
    PI controller has the gain {Kc}, and its integral time equals the lag.

    Simplify the loop transfer function $L(s)$ on paper, and find its gain margin, its phase margin and its delay
    margin.
    """
    a, x = float(K * Kc / T), float(K * Kc * delay / T)
    return answers(
        gain_margin=number(math.pi / (2 * x), "", "the gain margin"),
        phase_margin=number(90 - math.degrees(x), "deg", "the phase margin"),
        delay_margin=number((math.pi / 2 - x) / a, "s", "the delay margin"),
    )


@three_margins.mistake("That is the whole dead time on the limit. The margin is what may be added to the present one.")
def _(K, T, Kc):
    return {"delay_margin": math.pi * float(T / (K * Kc)) / 2}


@three_margins.mistake("That would be the margin with a controller whose gain is 1. Here it is {Kc} already.")
def _(K, T, delay, Kc):
    x, time = float(K * delay / T), float(T / K)
    wrong = {"gain_margin": math.pi / (2 * x), "phase_margin": 90 - math.degrees(x), "delay_margin": math.pi / 2 - x}
    if x >= 1.4 or abs(Kc - 1) < 0.1:  # no margin is left, or hardly another one
        return {"gain_margin": wrong["gain_margin"]} if Kc != 1 else {}
    return wrong | {"delay_margin": wrong["delay_margin"] * time}


@three_margins.mistake("That is the margin in decibels. Give the factor itself.")
def _(K, T, delay, Kc):
    return {"gain_margin": 20 * math.log10(math.pi * float(T / (K * Kc * delay)) / 2)}


@three_margins.mistake(
    "By that angle the dead time turns the phase. The margin is what is left of the right angle behind the integrator."
)
def _(K, T, delay, Kc):
    x = math.degrees(float(K * Kc * delay / T))
    return {"phase_margin": x} if abs(x - 45) > 2 else {}


@three_margins.mistake("The integrator has turned the phase by a right angle already.")
def _(K, T, delay, Kc):
    return {"phase_margin": 180 - math.degrees(float(K * Kc * delay / T))}


@three_margins.mistake("That is the phase margin in radians. Which frequency makes a time of it?")
def _(K, T, delay, Kc):
    wrong = math.pi / 2 - float(K * Kc * delay / T)
    return {"delay_margin": wrong} if abs(float(K * Kc / T) - 1) > 0.03 else {}


@three_margins.mistake("The delay margin is read where the phase margin is: at the frequency where $|L|$ is one.")
def _(K, T, delay, Kc):
    x = float(K * Kc * delay / T)
    wrong, right = (math.pi / 2 - x) / (math.pi / 2), (math.pi / 2 - x) / x
    return {"delay_margin": float(delay) * wrong} if abs(wrong / right - 1) > 0.03 else {}


@three_margins.mistake("An angle in radians was taken from one in degrees.")
def _(K, T, delay, Kc):
    return {"phase_margin": 90 - float(K * Kc * delay / T)}


three_margins.hints(
    "All three margins are read where $L(j\\omega)$ crosses something. What does the controller's zero do to the lag?",
    "With the integral time equal to the lag, $L = \\frac{a\\,e^{-\\theta s}}{s}$ with $a = KK_c/T$. Its size is "
    "$a/\\omega$, and its phase is $-90°$ from the integrator and $-\\omega\\theta$ from the dead time.",
    "The size is one at $\\omega = a$, and $a = \\frac{ {K} \\cdot {Kc} }{ {T} }$ rad/s. The phase is $-180°$ where "
    "$\\omega\\theta = \\pi/2$, with $\\theta = {delay}$ s.",
)


@three_margins.solution
def _(K, T, delay, Kc):
    r"""The zero of the controller cancels the lag, and $L(s) = \frac{a\,e^{-\theta s} }{s}$ is left, with
    $a = \frac{ {K} \cdot {Kc} }{ {T} } = {a}$ per second and $\theta = {delay}$ s.

    **Gain margin.** The integrator turns by $-90°$, the dead time adds the other $-90°$ where $\omega\theta = \pi/2$.

    ***

    That is at $\omega = {omega_180}$ rad/s. There the size of $L$ is $a/\omega = {size}$, and the gain may grow by the
    factor $1/{size} =$ {gain_margin}.

    **Phase margin.** The size is one at $\omega = a$. There the dead time turns by $a\theta$, which is {turn}; of the
    $90°$ that the integrator has left, {phase_margin} remain.

    **Delay margin.** More dead time $\Delta\theta$ turns by $a\,\Delta\theta$ at that frequency. It may be as long as
    the phase margin, in radians, divided by $a$: $\left(\frac{\pi}{2} - {x}\right)/{a} =$ {delay_margin}.
    """
    a, x = float(K * Kc / T), float(K * Kc * delay / T)
    w = math.pi / (2 * float(delay))
    return {"a": a, "x": x, "omega_180": w, "size": a / w, "turn": (math.degrees(x), "deg")}


@three_margins.solution_picture
def _(K, T, delay, Kc):
    """The Nyquist curve with the unit circle, and the two crossings at which gain and phase margin are read."""
    a, theta = float(K * Kc / T), float(delay)
    w = np.geomspace(a / 3, 40 * a, 800)
    plot = _nyquist(a * np.exp(-1j * w * theta) / (1j * w), (-1.6, 1.2), (-1.6, 1.2))
    plot.points([-2 * a * theta / math.pi], [0], "gain margin", "o")
    turned = np.exp(-1j * (math.pi / 2 + a * theta))
    return plot.points([turned.real], [turned.imag], "phase margin", "s")


def _nyquist(curve, xlim, ylim):
    """A Nyquist curve with the unit circle and the point -1."""
    circle = np.exp(1j * np.linspace(0, 2 * np.pi, 200))
    curves = {r"$L(j\omega)$": (curve.real, curve.imag), "unit circle": (circle.real, circle.imag, 3)}
    plot = plane_plot(curves, "real part", "imaginary part", xlim=xlim, ylim=ylim, equal=True)
    return plot.points([-1], [0], "$-1$", "x")


def _turns(x):
    """How many pairs of poles a loop x exp(-s)/s has in the right half-plane."""
    return max(math.floor((x - math.pi / 2) / (2 * math.pi)) + 1, 0)


def _away_from_limits(K, T, delay, Kc):
    x = float(K * Kc * delay / T)
    return 0.6 <= x <= 21 and abs((x - math.pi / 2 + math.pi) % (2 * math.pi) - math.pi) > 0.15


@exercise(
    "19.2",
    title="How many poles are unstable?",
    points=3,
    where=_away_from_limits,
    insight="A loop with dead time has infinitely many poles, and only as many are unstable as have crossed "
    "the axis, pair by pair.",
)
def unstable_poles(
    K=between(0.5, 4, "", reference=3),
    T=between(2, 12, "s", reference=5),
    delay=between(2, 12, "s", reference=8),
    Kc=between(0.5, 5, "", reference=2),
):
    r"""Someone has changed the settings of a loop. Now a PI controller with the gain {Kc} controls a process
    with the gain {K}, a lag of {T} and a dead time of {delay}; the integral time equals the lag.

    With which gain of the controller would the loop be on the limit of stability, and at which frequency would it
    then oscillate? And how many of its infinitely many poles are in the right half-plane with the present gain?
    (Pairs enter it one after the other as the gain grows. At which frequencies may they cross the axis?)
    """
    return answers(
        limit=number(math.pi * float(T / (2 * K * delay)), "", "the gain on the limit"),
        frequency=number(math.pi / float(2 * delay), "rad/s", "the frequency on the limit"),
        unstable=number(2 * _turns(float(K * Kc * delay / T)), "", "the number of unstable poles", within=0),
    )


@unstable_poles.mistake("Do not forget that each pole with an imaginary part has a partner.")
def _(K, T, delay, Kc):
    pairs = _turns(float(K * Kc * delay / T))
    return {"unstable": pairs} if pairs else {}


@unstable_poles.mistake(
    "Poles cross the axis only where $L = -1$. Every second crossing of the real axis is on its positive half."
)
def _(K, T, delay, Kc):
    x = float(K * Kc * delay / T)
    every = 2 * max(math.floor((x - math.pi / 2) / math.pi) + 1, 0)
    return {"unstable": every} if every != 2 * _turns(x) else {}


@unstable_poles.mistake("That is the gain of the process and the controller together.")
def _(K, T, delay):
    return {"limit": math.pi * float(T / (2 * delay))} if K != 1 else {}


@unstable_poles.mistake("The integrator turns the phase by a right angle; the dead time has to provide only the rest.")
def _(delay):
    return {"frequency": math.pi / float(delay)}


def _number_if_wrong(value):
    def wrong(K, T, delay, Kc):
        return {"unstable": value} if 2 * _turns(float(K * Kc * delay / T)) != value else {}

    return wrong


for _count, _sentence in {
    0: "Compare the present gain with the gain on the limit: has no pair crossed the axis yet?",
    1: "Poles cross the axis in pairs. And has the first pair crossed it with the present gain?",
    2: "Compare the present gain with those at which pairs cross. Has just one of them been passed?",
}.items():
    unstable_poles.mistake(_sentence)(_number_if_wrong(_count))


@unstable_poles.mistake("There $L$ is $+1$, on the other side. The first crossing is at a lower frequency.")
def _(K, T, delay):
    return {
        "limit": 3 * math.pi * float(T / (2 * K * delay)),
        "frequency": 3 * math.pi / float(2 * delay),
    }


@unstable_poles.mistake("That is the period of the oscillation. Which frequency in rad/s is that?")
def _(delay):
    wrong = 4 * float(delay)
    return {"frequency": wrong}


unstable_poles.hints(
    "A pole crosses the imaginary axis at $s = j\\omega$ where $L(j\\omega) = -1$. What does that say of size and "
    "phase?",
    "With the lag cancelled, $L = \\frac{a\\,e^{-\\theta s}}{s}$. Its phase $-\\frac{\\pi}{2} - \\omega\\theta$ must "
    "be "
    "$-\\pi$, or $-3\\pi$, or $-5\\pi$ and so on, and its size $a/\\omega$ must be one.",
    "So pairs cross at $\\omega\\theta = \\frac{\\pi}{2}, \\frac{5\\pi}{2}, \\frac{9\\pi}{2}$ and so on, with "
    "$\\theta = {delay}$ s, and as $a = \\omega$ there, at 1, 5, 9 and so on times the first gain. How many times the "
    "first gain is {Kc}?",
)


@unstable_poles.solution
def _(K, T, delay, Kc):
    r"""The integral time equals the lag, and $L = \frac{a\,e^{-\theta s} }{s}$ with $a = KK_c/T$ is left. On the axis
    $L = -1$: the phase $-\frac{\pi}{2} - \omega\theta$ is an odd multiple of $-\pi$, and the size $a/\omega$ is one.

    The first time that is at $\omega = \frac{\pi}{2\theta} = \frac{\pi}{2 \cdot {delay} } =$ {frequency}. The gain that
    makes $a$ equal to it is $K_c = \omega T/K =$ {limit}: beyond it the loop is unstable.

    Further pairs cross when the dead time has turned once more around, at frequencies and gains that are 5, 9, 13 and
    so on times the first ones. (At 3, 7, 11 times, $L$ is $+1$, and nothing crosses.) The present gain of {Kc} is
    {times} times the first limit: {crossed}. So the number of poles in the right half-plane is {unstable}.
    """
    times, pairs = float(K * Kc * delay / T) / (math.pi / 2), _turns(float(K * Kc * delay / T))
    crossed = {0: "no pair has crossed", 1: "one pair has crossed"}.get(pairs, f"{pairs} pairs have crossed")
    return {"times": times, "crossed": crossed}


@unstable_poles.solution_picture
def _(K, T, delay, Kc):
    """The poles nearest to the axis: those on its right are the unstable ones."""
    from scipy.special import lambertw

    theta = float(delay)
    found = lambertw(-float(K * Kc / T) * theta, np.arange(-7, 7)) / theta
    high, wide = 1.1 * float(max(abs(found.imag))), 1.15 * float(max(abs(found.real)))
    axis = {"imaginary axis": ([0, 0], [-high, high], "setpoint")}
    plot = plane_plot(axis, "real part [1/s]", "imaginary part [rad/s]", xlim=(-wide, wide), ylim=(-high, high))
    return plot.points(found.real, found.imag, "poles", "x")


@exercise(
    "19.3",
    title="Diagnosis of an oscillation",
    points=4,
    where=lambda T, Ti, period: period >= T / 2 and abs(T - Ti) >= T / 5,
    insight="An oscillation of constant amplitude is a measurement: its period and the known controller "
    "tell gain and dead time of the process.",
)
def diagnosis(
    T=between(4, 30, "min", reference=10),
    Kc=between(0.5, 5, "", reference=1.5),
    Ti=between(3, 30, "min", reference=6),
    period=between(6, 60, "min", reference=20),
):
    r"""A distillation column was well controlled for years. Since this week, its temperature loop oscillates: the
    amplitude neither grows nor shrinks, and the period is {period}. The PI controller has the gain {Kc} and the
    integral time {Ti}. The process has a lag of {T}, which nothing can change, but a gain and a dead time that may
    have changed (the gain is without unit, because both signals are in percent).

    At which frequency is the loop marginally stable? Which gain and which dead time has the process now?
    """
    w = 2 * math.pi / float(period)
    return answers(
        omega=number(w, "rad/min", "the frequency"),
        gain=number(_gain_on_limit(T, Kc, Ti, w), "", "the gain of the process"),
        delay=number(_delay_on_limit(T, Ti, w), "min", "the dead time of the process"),
    )


def _gain_on_limit(T, Kc, Ti, w):
    T, Kc, Ti = float(T), float(Kc), float(Ti)
    return Ti * w / Kc * math.sqrt((1 + (w * T) ** 2) / (1 + (w * Ti) ** 2))


def _delay_on_limit(T, Ti, w):
    return (math.pi / 2 + math.atan(w * float(Ti)) - math.atan(w * float(T))) / w


@diagnosis.mistake("That is the number of oscillations in a minute. How many radians does one of them have?")
def _(period):
    return {"omega": 1 / float(period)}


@diagnosis.mistake("The controller does not stand for its gain alone: its integral term acts at this frequency, too.")
def _(T, Kc, Ti, period):
    w = 2 * math.pi / float(period)
    wrong = math.hypot(1, w * float(T)) / float(Kc)
    return {"gain": wrong} if abs(wrong / _gain_on_limit(T, Kc, Ti, w) - 1) > 0.02 else {}


@diagnosis.mistake(
    "Lag and integral time are interchanged: the lag gives a phase lag, the zero of the controller a phase lead."
)
def _(T, Kc, Ti, period):
    w = 2 * math.pi / float(period)
    return {"delay": _delay_on_limit(Ti, T, w)}


@diagnosis.mistake("That is the gain of process and controller together. Divide by what the controller contributes.")
def _(T, Kc, Ti, period):
    w = 2 * math.pi / float(period)
    return {"gain": _gain_on_limit(T, 1, Ti, w)} if Kc != 1 else {}


@diagnosis.mistake("The integral term turns the phase by a right angle; it is missing from the sum.")
def _(T, Ti, period):
    w = 2 * math.pi / float(period)
    return {"delay": (math.pi + math.atan(w * float(Ti)) - math.atan(w * float(T))) / w}


@diagnosis.mistake("The phase of the controller is missing: it turns by $-90° + \\arctan\\omega T_i$.")
def _(T, Ti, period):
    w = 2 * math.pi / float(period)
    wrong, right = (math.pi - math.atan(w * float(T))) / w, _delay_on_limit(T, Ti, w)
    return {"delay": wrong} if abs(wrong / right - 1) > 0.02 else {}


@diagnosis.mistake("A quarter of a period belongs to an integrator. What do lag and controller turn besides?")
def _(T, Ti, period):
    wrong, right = float(period) / 4, _delay_on_limit(T, Ti, 2 * math.pi / float(period))
    return {"delay": wrong} if abs(wrong / right - 1) > 0.02 else {}


@diagnosis.mistake("Half a period belongs to a dead time alone. What do lag and controller turn besides?")
def _(period):
    return {"delay": period / 2}


diagnosis.hints(
    "The amplitude neither grows nor shrinks. What does that say of $L(j\\omega)$ at the frequency that is seen?",
    "$L(j\\omega) = -1$: its size is one, and its phase is $-180°$. The size does not depend on the dead time, the "
    "phase "
    "does not depend on the gain: two equations, one for each unknown.",
    "$\\omega = 2\\pi/{period}$ rad/min. Then $\\frac{KK_c\\sqrt{1 + (\\omega T_i)^2}}{\\omega T_i\\sqrt{1 + "
    "(\\omega T)^2}} = 1$ and $\\arctan\\omega T_i - \\frac{\\pi}{2} - \\arctan\\omega T - \\omega\\theta = -\\pi$.",
)


@diagnosis.solution
def _(T, Kc, Ti, period):
    r"""**Frequency.** The loop is on the limit of stability, and its pair of poles is at $\pm j\omega$ with the
    frequency that is seen: $\omega = \frac{2\pi}{ {period} } =$ {omega}.

    **Gain.** There $L(j\omega) = -1$. Its size knows nothing of the dead time:
    $\frac{KK_c\sqrt{1 + (\omega T_i)^2} }{\omega T_i\sqrt{1 + (\omega T)^2} } = 1$, with $\omega T_i = {wTi}$ and
    $\omega T = {wT}$. So $K = \frac{ {wTi} }{ {Kc} }\sqrt{\frac{1 + {wT}^2}{1 + {wTi}^2} } =$ {gain}.

    **Dead time.** Its phase knows nothing of the gain. The integral term turns by $-\frac{\pi}{2}$, the zero of the
    controller by $+\arctan {wTi}$, the lag by $-\arctan {wT}$, and the dead time has to turn by the rest of $-\pi$:
    $\omega\theta = \frac{\pi}{2} + \arctan {wTi} - \arctan {wT} = {rest}$ rad, so that $\theta =$ {delay}.

    The period alone would not have been enough: with it and the settings of the controller, both are known.
    """
    w = 2 * math.pi / float(period)
    return {"wTi": w * float(Ti), "wT": w * float(T), "rest": w * _delay_on_limit(T, Ti, w)}


@diagnosis.picture
def _(T, Kc, Ti, period):
    """The record of the temperature: an oscillation with a constant amplitude around the setpoint."""
    times = np.linspace(0, 3.5 * float(period), 401)
    w = 2 * math.pi / float(period)
    curves = {"temperature": (np.sin(w * times), "measurement"), "setpoint": (0, "setpoint")}
    return time_plot(curves, times, xlabel="$t$ [min]", ylabel="deviation [%]", low=True)


def _ratio(K, T, delay, Kc, Ti, k):
    """The delay ratio on the limit of stability, by equations (8) and (9)."""
    return float(robustness_pi_first_order(*(float(x) for x in (K, T, delay, Kc, Ti, k))))


def _window(k):
    """The upper side of Shinskey's window at the gain ratio k."""
    return np.where(k < 1, 2 * k, 2 / k)


def _judgeable(K, T, delay, Kc, Ti, k):
    # tuned like a loop that someone would run, and with a clear answer
    if not 1.3 <= _ratio(K, T, delay, Kc, Ti, 1) <= 3.5 or Ti == T:
        return False
    ratio, upper = _ratio(K, T, delay, Kc, Ti, k), float(_window(float(k)))
    return ratio * upper > 1.05 and abs(ratio / upper - 1) > 0.05


@exercise(
    "19.4",
    title="If the gain changes",
    points=4,
    where=_judgeable,
    insight="The limit of stability is a curve over all changes of the process; one margin is one point of it.",
)
def gain_changes(
    K=between(0.5, 4, "", reference=1.25),
    T=between(4, 30, "s", reference=15),
    delay=between(2, 20, "s", reference=10),
    Kc=between(0.25, 3, "", reference=0.75),
    Ti=between(4, 30, "s", reference=12),
    k=choice(0.6, 0.8, 1.25, 1.5, 1.75, reference=1.5),
):
    r"""A process with the gain {K}, a lag of {T} and a dead time of {delay} is controlled by a PI controller with the
    gain {Kc} and the integral time {Ti}. With another product, the gain of the process is {k} times as large, and the
    dead time changes, too.

    Which dead time would put the loop on the limit of stability, and at which frequency would it then oscillate? What
    is the delay ratio, and is this point of the limit inside or outside of Shinskey's window?
    """
    w, ratio = _frequency(K, T, Kc, Ti, k), _ratio(K, T, delay, Kc, Ti, k)
    return answers(
        omega=number(w, "rad/s", "the frequency on the limit"),
        longest=number(_delay_on_limit(T, Ti, w), "s", "the dead time on the limit"),
        ratio=number(ratio, "", "the delay ratio on the limit"),
        limit=word(
            "outside" if ratio > _window(float(k)) else "inside", ["inside", "outside"], what="the side of the window"
        ),
    )


def _frequency(K, T, Kc, Ti, k=1):
    """The frequency at which a PI loop has the gain one, by equation (8)."""
    K, T, Kc, Ti, k = (float(x) for x in (K, T, Kc, Ti, k))
    b = Ti * ((K * Kc * k) ** 2 - 1)
    return math.sqrt((b + math.hypot(b, 2 * K * Kc * k * T)) / (2 * Ti)) / T


@gain_changes.mistake(
    "That belongs to the gain as it was. With another gain of the process, the limit is at another frequency."
)
def _(K, T, delay, Kc, Ti):
    w = _frequency(K, T, Kc, Ti)
    return {"omega": w, "longest": _delay_on_limit(T, Ti, w), "ratio": _ratio(K, T, delay, Kc, Ti, 1)}


@gain_changes.mistake(
    "Lag and integral time are interchanged: the lag gives a phase lag, the zero of the controller a phase lead."
)
def _(K, T, delay, Kc, Ti, k):
    w = _frequency(K, T, Kc, Ti, k)
    wrong = _delay_on_limit(Ti, T, w)
    return {"longest": wrong}


@gain_changes.mistake(
    "That is what may be added. The delay ratio compares the whole dead time on the limit with the present one."
)
def _(K, T, delay, Kc, Ti, k):
    return {"ratio": _ratio(K, T, delay, Kc, Ti, k) - 1}


@gain_changes.mistake(
    "The upper side of the window falls with the gain ratio beyond one, and rises with it below. How high is it at "
    "this gain ratio, and where is your delay ratio?"
)
def _(K, T, delay, Kc, Ti, k):
    return {"limit": "inside" if _ratio(K, T, delay, Kc, Ti, k) > _window(float(k)) else "outside"}


@gain_changes.mistake("The delay ratio has the present dead time in its denominator, and not the lag.")
def _(K, T, delay, Kc, Ti, k):
    right = _ratio(K, T, delay, Kc, Ti, k)
    return {"ratio": right * float(delay / T)} if abs(T / delay - 1) > Rational(1, 20) else {}


@gain_changes.mistake("The integral term turns by a right angle: only the other one and the two arc tangents are left.")
def _(K, T, Kc, Ti, k):
    w = _frequency(K, T, Kc, Ti, k)
    return {"longest": _delay_on_limit(T, Ti, w) + math.pi / 2 / w}


@gain_changes.mistake("The two arc tangents, of the zero of the controller and of the lag, are missing.")
def _(K, T, Kc, Ti, k):
    w = _frequency(K, T, Kc, Ti, k)
    wrong, right = math.pi / 2 / w, _delay_on_limit(T, Ti, w)
    return {"longest": wrong} if abs(wrong / right - 1) > 0.03 else {}


@gain_changes.mistake("The new gain is the old one *times* the ratio.")
def _(K, T, Kc, Ti, k):
    return {"omega": _frequency(K, T, Kc, Ti, 1 / k)}


@gain_changes.mistake(
    "The gain ratio takes the place of the gain here. The loop has the product of both, and of $K_c$."
)
def _(K, T, Kc, Ti, k):
    return {"omega": _frequency(1, T, Kc, Ti, k)} if abs(K - 1) > Rational(1, 10) else {}


gain_changes.hints(
    "On the limit $L(j\\omega) = -1$. Which of its two conditions does not contain the dead time?",
    "The size gives the frequency, with the new gain $kK$: $\\frac{kKK_c\\sqrt{1 + (\\omega T_i)^2}}{\\omega "
    "T_i\\sqrt{1 "
    "+ (\\omega T)^2}} = 1$. Squared, it is quadratic in $\\omega^2$. Then the phase gives the dead time. Shinskey's "
    "window ends at the delay ratio $2/k$ where $k > 1$ and at $2k$ where $k < 1$.",
    "With $kKK_c = {k} \\cdot {K} \\cdot {Kc} = {loop_gain}$ and $q = \\omega^2$: $T^2T_i^2q^2 + T_i^2(1 - "
    "{loop_gain}^2)\\,q - {loop_gain}^2 = 0$, with $T = {T}$ s and $T_i = {Ti}$ s.",
)


@gain_changes.solution
def _(K, T, delay, Kc, Ti, k):
    r"""**Frequency.** With the new gain of the process the loop has the gain $kKK_c = {k} \cdot {K} \cdot {Kc} =
    {loop_gain}$. The size of $L$ is one where
    $T^2T_i^2q^2 + T_i^2(1 - {loop_gain}^2)\,q - {loop_gain}^2 = 0$ with $q = \omega^2$. One root is positive, and
    $\omega =$ {omega}.

    **Dead time.** The phase is $-\pi$ there: $\omega\theta = \frac{\pi}{2} + \arctan\omega T_i - \arctan\omega T =
    {phase}$, so that $\theta =$ {longest}.

    **Delay ratio.** Divided by the present dead time of {delay}, that is {ratio}.

    **Window.** At the gain ratio {k} the upper side of Shinskey's window is at {upper}. The limit of stability is
    {side} it: {limit}. What is required of a robust loop is that the limit stays outside of the window everywhere, and
    one point can disprove that, though not prove it.
    """
    w = _frequency(K, T, Kc, Ti, k)
    upper = float(_window(float(k)))
    return {
        "phase": w * _delay_on_limit(T, Ti, w),
        "upper": upper,
        "side": "above" if _ratio(K, T, delay, Kc, Ti, k) > upper else "below",
    }


@gain_changes.shows
def _(K, Kc, k):
    return {"loop_gain": f"{float(k * K * Kc):.4g}"}


@gain_changes.solution_picture
def _(K, T, delay, Kc, Ti, k):
    """The limit of stability over the gain ratio, with Shinskey's window and the point of this exercise."""
    return _robustness_plot(K, T, delay, PID(Kc, Ti)).points(
        [float(k)], [_ratio(K, T, delay, Kc, Ti, k)], "with the new gain", "^"
    )


def _robustness_plot(K, T, delay, controller):
    ratios = np.geomspace(0.4, 2.5, 81)
    numbers = (float(x) for x in (K, T, delay, controller.Kp, controller.Ti))
    limit = robustness_pi_first_order(*numbers, ratios)
    high = 1.2 * max(3.0, min(float(limit.max()), 12.0))
    labels = "gain ratio $k$", "delay ratio $d$"
    plot = plane_plot({"limit of stability": (ratios, limit)}, *labels, xlim=(0.4, 2.5), ylim=(0.3, high), log=True)
    return plot.area(*shinskey_window(), "window").points([1], [1], "as tuned")


@exercise(
    "19.5",
    title="Robust in the window, and quick",
    points=6,
    where=lambda T, delay: 3 * delay <= T <= 8 * delay,
    insight="Robustness and quick recovery from loads are bought with the same two settings, and a design "
    "is a point between their limits.",
)
def in_the_window(
    K=between(0.5, 5, "", reference=2.5),
    T=between(10, 60, "s", reference=24),
    delay=between(2, 15, "s", reference=5),
):
    r"""A loop controls a process with the gain {K}, a lag of {T} and a dead time of {delay}. Gain and dead time
    change with the load of the plant, so the loop should be robust in Shinskey's sense: the limit of stability should
    stay outside of the window everywhere. Its lag does not change.

    That alone would be easy, with a small gain. But after a unit step of the load at the input of the process the
    integral of the squared error (ISE) should be at most {limit}, with the gain and the dead time as above. Design a
    PI controller that does both. Many do, and any that does is right.

    (The response says how far the limit of stability is from the window: 1 if it touches, 2 if it is twice as far in
    gain or dead time.)
    """
    return answers(
        controller=design(
            settings(
                PID(Rational(3, 5) * T / (K * delay), min(T, 4 * delay)),
                time="s",
                what="the settings of the PI controller",
            ),
            pi_controller(),
            stable(by=lambda controller: _load_ISE(K, T, delay, controller) < math.inf),
            criterion("the distance from the window", lambda controller: _distance(K, T, delay, controller), above=1),
            criterion(
                "the ISE after the load step",
                lambda controller: _load_ISE(K, T, delay, controller),
                below=_ISE_limit(K, T, delay),
                unit="s",
            ),
            draws=lambda controller: _robustness_plot(K, T, delay, controller),
        )
    )


def _distance(K, T, delay, controller):
    """The least quotient of the limit of stability and the upper sides of Shinskey's window."""
    Kp, Ti = float(controller.Kp), float(controller.Ti)
    if Kp <= 0 or not 0 < Ti < math.inf:
        return 0.0
    k = np.geomspace(0.5, 2, 201)
    limit = robustness_pi_first_order(float(K), float(T), float(delay), Kp, Ti, k)
    return float((limit / _window(k)).min())


def _load_ISE(K, T, delay, controller):
    Kp, Ti = float(controller.Kp), float(controller.Ti)
    if not 0 < Ti < math.inf:
        return math.inf
    return float(pi_first_order(float(K), float(T), float(delay), Kp, Ti, "regulator", math.inf))


def _ISE_limit(K, T, delay):
    key = PID(Rational(3, 5) * T / (K * delay), min(T, 4 * delay))
    return float(f"{1.1 * _load_ISE(K, T, delay, key):.3g}")


@in_the_window.mistake(
    "That is robust, but a closed-loop time constant as long as the dead time, with the lag cancelled, is too slow "
    "for loads here."
)
def _(K, T, delay):
    return {"controller": PID(T / (2 * K * delay), T)}


@in_the_window.mistake(
    "With this gain the loop is on the limit of stability before the gain of the process has doubled."
)
def _(K, T, delay):
    return {"controller": PID(T / (K * delay), min(T, 4 * delay))}


@in_the_window.mistake(
    "The gain is that of the loop. The controller's part of it is this divided by the gain of the process."
)
def _(K, T, delay):
    return {"controller": PID(Rational(3, 5) * T / delay, min(T, 4 * delay))} if K >= 2 else {}


in_the_window.hints(
    "Two demands pull at the gain: the load wants a large one, the window a small one. What does the integral time do "
    "for the load, and what does it cost?",
    "Cancel the lag first, $T_i = T$: then the limit of stability is at $KK_c\\theta/T = \\frac{\\pi}{2}$, "
    "whatever gain and dead time make it so. Half of it still keeps the window. A shorter integral time takes a load "
    "back sooner.",
    "Try $K_c = x\\,T/(K\\theta)$ with $x$ between 0.5 and 0.7, where $T/(K\\theta) = {unit_gain}$, and an "
    "integral time between $2\\theta$ and the lag.",
)


@in_the_window.shows
def _(K, T, delay):
    return {
        "limit": f"{_ISE_limit(K, T, delay):g} s",
        "process": first_order(K, T, delay),
        "unit_gain": f"{float(T / (K * delay)):.4g}",
    }


@in_the_window.solution
def _(K, T, delay):
    r"""Measure the gain by $x = KK_c\theta/T$, so that the units do not matter: $K_c = x\,T/(K\theta) =
    x \cdot {unit_gain}$.

    With the lag cancelled ($T_i = T$) the loop is $\frac{x}{\theta}\frac{e^{-\theta s} }{s}$ and on the limit of
    stability at $x = \pi/2$. The far corners of the window, twice the gain or twice the dead time, are kept up to half
    of that. With $x = 0.5$, Skogestad's choice, the distance from the window is {calm_distance}, but the ISE is
    {calm_ISE}: robust, and too slow for loads, because they fade with the long integral time.

    So take the load back sooner. With $x = 0.6$ and an integral time of four dead times (or the lag, if that is
    shorter), $K_c = {Kp}$ and $T_i =$ {Ti}, the distance is {distance} and the ISE {ISE}; at most {limit} is allowed.
    Both demands are met.
    """
    calm, good = PID(T / (2 * K * delay), T), PID(Rational(3, 5) * T / (K * delay), min(T, 4 * delay))
    return {
        "calm_distance": _distance(K, T, delay, calm),
        "calm_ISE": (_load_ISE(K, T, delay, calm), "s"),
        "Kp": good.Kp,
        "Ti": (good.Ti, "s"),
        "distance": _distance(K, T, delay, good),
        "ISE": (_load_ISE(K, T, delay, good), "s"),
    }


# --- 19.6 ---------------------------------------------------------------------------------------------------------


def _crossings(r):
    """Where the phase of exp(-s)/(r s + 1) is -180°, -540°, -900°, and -360°: pairs of frequency and size."""
    found = []
    for phase in (math.pi, 3 * math.pi, 5 * math.pi, 2 * math.pi):
        low, high = phase - math.pi / 2, phase
        for _ in range(60):
            middle = (low + high) / 2
            low, high = (middle, high) if middle + math.atan(r * middle) < phase else (low, middle)
        found.append((low, 1 / math.hypot(1, r * low)))
    return found


def _crossover(k, r):
    """Frequency and phase, in radians, where k exp(-s)/(r s + 1) has the size one."""
    w = math.sqrt(float(k) ** 2 - 1) / float(r)
    return w, -w - math.atan(float(r) * w)


def _is_read_from_nyquist(k, r, more):
    first, *later = (float(k) * size for _, size in _crossings(float(r))[:3])
    margin = math.pi + _crossover(k, r)[1]
    # the third crossing stays inside, and with it all further ones, which no ruler tells apart
    far = all(abs(math.log(float(more) * size)) > 0.18 for size in (first, *later)) and float(more) * later[-1] < 1
    return 0.35 <= first <= 0.7 and math.radians(18) <= margin <= math.radians(78) and far


def _encirclements(k, r, more):
    """How often the whole curve, negative frequencies included, goes around -1 with more gain."""
    return 2 * sum(float(more * k) * size > 1 for _, size in _crossings(float(r))[:3])


@exercise(
    "19.6",
    title="Read a Nyquist curve",
    points=4,
    where=_is_read_from_nyquist,
    insight="One curve answers three questions: how much more gain, how much more dead time, and how many unstable "
    "poles "
    "beyond. But no margin says how the loop behaves when both change at the same time.",
)
def nyquist(
    k=between(1.2, 3, "", step=0.1, reference=1.7),
    r=choice(0.8, 1, 1.25, 1.5, 2, reference=1.25),
    delay=choice(0.5, 1, 1.5, 2, 3, 4, 5, reference=2, unit="min"),
    more=choice(1.2, 1.4, 1.6, 2.5, 3, 4, 5, 7, 8, reference=4),
):
    r"""The curve is the Nyquist curve of a temperature loop, measured with sine waves, for frequencies from zero on.
    (It begins far on the right, on the real axis; the process is stable and its P controller has no poles.) Where the
    curve crosses the unit circle, the frequency is {crossover} rad/min.

    Read the curve with a ruler. How large are the gain margin, the phase margin and the delay margin? Then someone
    makes the gain of the controller {times} times as large. How many poles of the loop are in the right half-plane now?

    (For those who cannot see the picture: `L = exercise("19.6").given("L")` are the points of the curve.)
    """
    w, phase = _crossover(k, r)
    return answers(
        gain_margin=number(1 / (float(k) * _crossings(float(r))[0][1]), "", "the gain margin", within=0.05),
        phase_margin=number(180 + math.degrees(phase), "deg", "the phase margin", within=0.06),
        delay_margin=number((math.pi + phase) / w * float(delay), "min", "the delay margin", within=0.07),
        unstable=number(_encirclements(k, r, more), "", "the number of unstable poles with more gain", within=0),
    )


def _nyquist_points(k, r):
    w = np.concatenate([np.linspace(0, 3, 121), np.linspace(3.05, 30, 540)])
    return float(k) * np.exp(-1j * w) / (1 + 1j * float(r) * w)


@nyquist.shows
def _(k, r, delay, more):
    return {
        "L": _nyquist_points(k, r),
        "crossover": f"{_crossover(k, r)[0] / float(delay):.3g}",
        "times": f"{float(more):g}",
        "read": f"{float(k) * _crossings(float(r))[0][1]:.2f}",
    }


@nyquist.mistake("That is where the curve crosses the axis. By which factor may it grow until it reaches $-1$?")
def _(k, r):
    return {"gain_margin": float(k) * _crossings(float(r))[0][1]}


@nyquist.mistake(
    "That is the distance from $-1$ along the axis. A gain multiplies: which factor brings the curve there?"
)
def _(k, r):
    crossing = float(k) * _crossings(float(r))[0][1]
    return {"gain_margin": 1 - crossing} if abs(crossing - 0.5) > 0.05 else {}


@nyquist.mistake("That is a later crossing, further inside. Which crossing reaches $-1$ first as the gain grows?")
def _(k, r):
    return {"gain_margin": 1 / (float(k) * _crossings(float(r))[1][1])}


@nyquist.mistake("There the curve crosses the positive real axis, on the other side. Where is $-1$?")
def _(k, r):
    return {"gain_margin": 1 / (float(k) * _crossings(float(r))[-1][1])}


@nyquist.mistake("That is the phase itself, without its sign. How much is missing to half a turn?")
def _(k, r):
    return {"phase_margin": -math.degrees(_crossover(k, r)[1])}


@nyquist.mistake("That is the angle from the imaginary axis. The margin counts from the negative real axis.")
def _(k, r):
    margin = 180 + math.degrees(_crossover(k, r)[1])
    return {"phase_margin": abs(margin - 90)} if abs(margin - 45) > 5 and abs(margin - 90) > 5 else {}


@nyquist.mistake("An angle over a frequency in rad/min is a time only if the angle is in radians.")
def _(k, r, delay):
    w, phase = _crossover(k, r)
    return {"delay_margin": (180 + math.degrees(phase)) / w * float(delay)}


@nyquist.mistake("That is the time of a whole turn, times the margin. Is the frequency in rad/min or in turns?")
def _(k, r, delay):
    w, phase = _crossover(k, r)
    return {"delay_margin": 2 * math.pi * (math.pi + phase) / w * float(delay)}


@nyquist.mistake("That takes the frequency for turns per minute. It is in rad/min: which unit must the angle have?")
def _(k, r, delay):
    w, phase = _crossover(k, r)
    return {"delay_margin": (math.pi + phase) / (2 * math.pi * w) * float(delay)}


@nyquist.mistake("That is the dead time that a loop with a phase of zero could have. What is left of half a turn here?")
def _(k, r, delay):
    w, _ = _crossover(k, r)
    return {"delay_margin": math.pi / w * float(delay)}


@nyquist.mistake("The curve for negative frequencies, its mirror image, goes around $-1$ as well.")
def _(k, r, more):
    around = _encirclements(k, r, more)
    return {"unstable": 1} if around == 2 else {}


@nyquist.mistake(
    "The crossings of the positive real axis do not count: they are not beyond $-1$, they are on the other side."
)
def _(k, r, more):
    *negative, positive = (float(more * k) * size > 1 for _, size in _crossings(float(r)))
    return {"unstable": 2 * (sum(negative) + positive)} if positive else {}


@nyquist.mistake(
    "More gain stretches the whole curve. Is its first crossing of the negative real axis still inside of $-1$?"
)
def _(k, r, more):
    return {"unstable": 0} if _encirclements(k, r, more) else {}


@nyquist.mistake(
    "More gain stretches the curve, but by this factor? Multiply its crossing by it, and compare with one."
)
def _(k, r, more):
    return {"unstable": 2} if not _encirclements(k, r, more) else {}


@nyquist.mistake(
    "That is one crossing with its mirror image, or two crossings without it. How many crossings of the negative real "
    "axis are beyond $-1$?"
)
def _(k, r, more):
    return {"unstable": 2} if _encirclements(k, r, more) == 4 else {}


@nyquist.mistake("A phase margin in radians over a frequency is a time. Is this the margin, or the whole phase?")
def _(k, r, delay):
    w, phase = _crossover(k, r)
    return {"delay_margin": -phase / w * float(delay)} if abs(math.pi / -phase - 2) > 0.2 else {}


nyquist.hints(
    "The loop is on the limit of stability if its curve goes through $-1$. More gain stretches the curve, more dead "
    "time "
    "turns its points clockwise. Which point of the curve comes to $-1$ each time?",
    "The gain margin is one over the distance from the origin at which the curve crosses the negative real axis. The "
    "phase margin is the angle between that axis and the point on the unit circle. Dead time turns this point by "
    "$\\omega\\,\\Delta\\theta$. And each time the whole curve, with its mirror image, goes around $-1$, there is one "
    "unstable pole.",
    "The curve crosses the negative real axis first at about $-{read}$. Stretch this crossing, and the next one on the "
    "same side, by the factor {times}: which are beyond $-1$ then?",
)


@nyquist.solution
def _(k, r, delay, more):
    r"""**Gain margin.** The curve crosses the negative real axis at $-{first}$. The gain may grow by
    $\frac{1}{ {first} } =$ {gain_margin} until that point is at $-1$.

    **Phase margin.** On the unit circle the curve is at ${x} - {y}\,j$. The angle between this point and the negative
    real axis is $\arctan\frac{ {y} }{ {minus_x} } =$ {phase_margin} (from the side of the negative axis).

    **Delay margin.** More dead time turns that point by $\omega\,\Delta\theta$, with $\omega = {crossover}$ rad/min. It
    may be as long as the phase margin in radians over the frequency: ${radians}/{crossover} =$ {delay_margin}.

    **More gain.** {times} times as far out, the first crossing is at $-{new_first}$ and the next one on this side at
    $-{new_second}$. {count} The open loop has no unstable poles, so that as many poles of the closed loop are unstable
    as the curve goes around $-1$, with its mirror image for negative frequencies: {unstable}.
    """
    first, second, *_ = (float(k) * size for _, size in _crossings(float(r)))
    phase = _crossover(k, r)[1]
    point = complex(math.cos(phase), math.sin(phase))
    counts = {
        0: "Neither is beyond $-1$: the loop is still stable.",
        2: "Only the first one is beyond $-1$: the curve goes around it once.",
        4: "Both are beyond $-1$: the curve goes around it twice.",
    }
    return {
        "first": first,
        "x": point.real,
        "y": abs(point.imag),
        "minus_x": -point.real,
        "radians": math.pi + phase,
        "new_first": float(more) * first,
        "new_second": float(more) * second,
        "count": counts[_encirclements(k, r, more)],
    }


def _curve_to_read(k, r, delay):
    w, phase = _crossover(k, r)
    curve = _nyquist_points(k, r)
    plot = _nyquist(curve, (-1.25, 1.15), (-1.35, 1.05))
    plot.axes.set_xticks(np.arange(-1.2, 1.2, 0.2))
    plot.axes.set_yticks(np.arange(-1.2, 1.2, 0.2))
    plot.axes.minorticks_on()
    plot.axes.grid(which="minor", linewidth=0.3)
    plot.points([math.cos(phase)], [math.sin(phase)], f"{w / float(delay):.3g} rad/min", "o")
    plot.axes.get_legend().set_loc("upper right")  # where nothing but the unit circle is
    return plot


@nyquist.picture
def _(k, r, delay):
    """The last part of a Nyquist curve, which turns around the origin, with the unit circle and the point -1."""
    return _curve_to_read(k, r, delay)


@nyquist.solution_picture
def _(k, r, delay):
    """The same curve, with the crossings of the negative real axis."""
    crossings = [-float(k) * size for _, size in _crossings(float(r))[:2]]
    plot = _curve_to_read(k, r, delay).points(crossings, [0, 0], "crossings", "s")
    plot.axes.get_legend().set_loc("upper right")
    return plot


# --- 19.7 ---------------------------------------------------------------------------------------------------------


def _mistaken_predictor(K, T, delay, model, T_c):
    """Process and controller: a Smith predictor whose model has another dead time."""
    right = first_order(K, T)
    return first_order(K, T, delay), feedback(PID(T / (K * T_c), Ti=T).expr, right - first_order(K, T, model))


def _is_a_short_model(T, delay, model, T_c):
    missing = delay - model
    return missing >= 2 and 0.15 <= missing / delay <= 0.45 and missing != T_c and T_c <= missing <= 3 * T_c and T_c < T


def _mismatch(first="theta", second="theta_m"):
    return exp(-symbols(first, positive=True) * s) - exp(-symbols(second, positive=True) * s)


@exercise(
    "19.7",
    title="A predictor that expects its effect too early",
    points=4,
    where=_is_a_short_model,
    insight="A predictor may be as quick as its dead time is known: a closed-loop time constant as long as the error "
    "of "
    "the dead time is always safe.",
)
def short_model(
    K=choice(0.5, 0.8, 1.25, 2, reference=1.25),
    T=between(6, 20, "min", step=1, reference=10),
    delay=between(8, 20, "min", step=1, reference=12),
    model=between(5, 17, "min", step=1, reference=9),
    T_c=choice(1, 1.5, 2, 3, 4, unit="min", reference=2),
    step=choice(1, -1, 2, -2, unit="%"),
):
    r"""A dryer is controlled by a Smith predictor with a PI controller. Gain and lag of its model are right, and the
    integral time equals the lag, so that without the dead time the loop would follow the setpoint with the time
    constant $T_C =$ {T_c}. But since the belt runs more slowly, the dead time of the model is too short. The figure
    shows a step of the setpoint by {step}.

    Which dead time has the process, and which one has the model? (Where does the controller first act on something that
    it did not expect?) What does the predictor take the missing response for?

    With the process's $\theta$ and the model's $\theta_m$ the characteristic equation of this loop is
    $T_Cs + 1 + M(s) = 0$. Derive the term $M$ that the wrong dead time adds (type `theta` and `theta_m`). On the
    imaginary axis its size is at most $\omega$ times something. With which least time constant $T_C$, given this
    error of the dead time, can it therefore never reach the size of $T_Cs + 1$?

    (For those who cannot see the picture: `t, y, u = exercise("19.7").given("t", "y", "u")` are the curves.)
    """
    return answers(
        delay=number(delay, "min", "the dead time of the process", within=0.04),
        model=number(model, "min", "the dead time of the model", within=0.04),
        taken_for=word(
            _LESS if step > 0 else _MORE,
            [_MORE, _LESS, _NOISE, _SETPOINT],
            "what the predictor takes the missing response for",
        ),
        M=expression(_mismatch(), "the term of the wrong dead time"),
        T_safe=number(delay - model, "min", "the least time constant that is safe", within=0.12),
    )


_MORE, _LESS = "a load that raises the output", "a load that lowers the output"
_NOISE, _SETPOINT = "noise of the measurement", "a change of the setpoint"


@functools.lru_cache(maxsize=16)
def _predictor_run(K, T, delay, model, T_c, step):
    """The step of the setpoint, exactly as the loop makes it: times, output and control signal."""
    times = np.linspace(0, 4 * float(delay), 481)
    run = Loop(*_mistaken_predictor(K, T, delay, model, T_c)).run(times, setpoint=step)
    return times, run["y"], run["u"]


@short_model.shows
def _(K, T, delay, model, T_c, step):
    t, y, u = _predictor_run(K, T, delay, model, T_c, step)
    return {"t": t, "y": y, "u": u}


@short_model.mistake("The two are interchanged. Which of the curves cannot know what the model believes?")
def _(delay, model):
    return {"delay": model, "model": delay}


@short_model.mistake(
    "There the response is half of its way. The dead time ends where the output begins to move at all."
)
def _(delay, T_c):
    return {"delay": delay + log(2) * T_c} if T_c > delay / 8 else {}


@short_model.mistake("That is the first peak of the output, long after it has begun to move.")
def _(delay):
    return {"delay": 2 * delay}


@short_model.mistake("The model expects a response and sees none: is what it measures too high or too low?")
def _(step):
    return {"taken_for": _MORE if step > 0 else _LESS}


@short_model.mistake("The predictor knows the setpoint. The only thing that it cannot explain is in the measurement.")
def _():
    return {"taken_for": _SETPOINT}


@short_model.mistake("Noise would come and go. How long does this difference last, and has it a sign?")
def _():
    return {"taken_for": _NOISE}


@short_model.mistake(
    "Which of the two enters with a plus sign: the measurement, or the model that is subtracted from it?"
)
def _():
    return {"M": -_mismatch()}


@short_model.mistake("That is the process in the loop alone. A predictor also subtracts its model with the dead time.")
def _():
    return {"M": exp(-symbols("theta", positive=True) * s)}


@short_model.mistake("A difference of two exponentials is not the exponential of the difference.")
def _():
    theta, theta_m = symbols("theta theta_m", positive=True)
    return {"M": exp(-(theta - theta_m) * s)}


@short_model.mistake("That is the whole dead time. For a predictor that knows it exactly, how large is $M$?")
def _(delay):
    return {"T_safe": delay}


@short_model.mistake("The model's own dead time does not matter. What is it that makes $M$ differ from zero?")
def _(model):
    return {"T_safe": model}


@short_model.mistake(
    "The size of $M$ is also at most two, but that says nothing about small frequencies. Compare slopes."
)
def _(delay, model):
    double = 2 * (delay - model)
    return {"T_safe": double} if all(abs(double - other) > delay / 6 for other in (delay, model)) else {}


@short_model.mistake("That holds for small $s$ only: the exponentials have more terms than these.")
def _():
    theta, theta_m = symbols("theta theta_m", positive=True)
    return {"M": (theta_m - theta) * s}


@short_model.mistake("The 1 is in the equation already: $T_Cs + 1 + M$. What comes besides it?")
def _():
    return {"M": 1 + _mismatch()}


short_model.hints(
    "A predictor compares the measurement with what its model says that it should be by now. When do the two differ "
    "for "
    "the first time, and when does the process respond at last?",
    "The output begins to move after the dead time of the process. The control signal has its first kink when the "
    "model "
    "expects the response and sees none. With the lag cancelled, the controller and the model make "
    "$\\frac{1}{T_Cs}$ of the error; write the loop with the measurement $e^{-\\theta s}v$ and the model's "
    "$v - e^{-\\theta_ms}v$.",
    "$T_Cs\\,v = y_{SP} - v + e^{-\\theta_ms}v - e^{-\\theta s}v$. On the axis "
    "$|e^{-j\\omega\\theta} - e^{-j\\omega\\theta_m}| = 2\\,|\\sin\\frac{\\omega(\\theta - \\theta_m)}{2}|$, and a "
    "sine is "
    "not larger than its angle. Compare that with $|1 + j\\omega T_C|$.",
)


@short_model.solution
def _(delay, model, step):
    r"""**The dead times.** The output first moves at {delay}: that is the process. The control signal calms down until
    {model} and then turns: that is when the model expects a response. For {missing} the predictor sees nothing of it.

    **What it takes it for.** The measurement is {side} than the model says, as if there were {taken_for}. The predictor
    acts against that, and everything it does so comes back later as an overshoot.

    **The characteristic equation.** Let $v$ be the output without its dead time. The controller sees
    $y_{SP} - (v - e^{-\theta_ms}v) - e^{-\theta s}v$, and with the lag cancelled it makes $T_Cs\,v$ of this. So
    $\left(T_Cs + 1 + e^{-\theta s} - e^{-\theta_ms}\right)v = y_{SP}$, and $M = e^{-\theta s} - e^{-\theta_ms}$. With
    the right dead time it is zero.

    **A safe time constant.** On the axis $|M| = 2\,|\sin\frac{\omega(\theta - \theta_m)}{2}| \le \omega\,(\theta -
    \theta_m)$, while $|1 + j\omega T_C| > \omega T_C$. With $T_C \ge \theta - \theta_m =$ {T_safe} the term never
    reaches the other two, and no pole crosses the axis. (The present $T_C$ of {T_c} is shorter: the loop
    may be stable, but nothing guarantees it.)
    """
    return {"missing": (delay - model, "min"), "side": "lower" if step > 0 else "higher"}


def _predictor_trends(K, T, delay, model, T_c, step):
    times, y, u = _predictor_run(K, T, delay, model, T_c, step)
    panels = [{"$y$": (y, "measurement"), "setpoint": (step, "setpoint")}, {"$u$": (u, "control signal")}]
    return time_plot(panels, times, xlabel="$t$ [min]", ylabel=["output [%]", "control signal [%]"])


@short_model.picture
def _(K, T, delay, model, T_c, step):
    """Output and control signal after the step of the setpoint: the output begins late, overshoots and oscillates."""
    plot = _predictor_trends(K, T, delay, model, T_c, step)
    for axes in plot.figure.axes:
        axes.minorticks_on()
        axes.grid(which="minor", axis="x", linewidth=0.3)
    return plot


@short_model.solution_picture
def _(K, T, delay, model, T_c, step):
    """The same response beside that of a predictor with the safe time constant."""
    times, y, _ = _predictor_run(K, T, delay, model, T_c, step)
    _, calm, _ = _predictor_run(K, T, delay, model, delay - model, step)
    name = f"$T_C$ = {float(delay - model):g} min"
    curves = {f"$T_C$ = {float(T_c):g} min": y, name: calm, "setpoint": (step, "setpoint")}
    return time_plot(curves, times, xlabel="$t$ [min]", ylabel="output [%]", low=True)
