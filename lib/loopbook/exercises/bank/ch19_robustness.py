"""Exercises of chapter 19, robustness: margins, unstable poles, and processes that change."""

import math

import numpy as np
from sympy import Rational

from loopbook.exercises.authoring import (
    answers,
    between,
    choice,
    criterion,
    design,
    exercise,
    number,
    pi_controller,
    settings,
    stable,
    word,
)
from loopbook.ise import pi_first_order
from loopbook.pid import PID
from loopbook.stability import robustness_pi_first_order
from loopbook.transfer import first_order


@exercise(
    "19.1",
    title="Three margins of one loop",
    points=2,
    where=lambda K, T, delay, Kc: 0.25 <= K * Kc * delay / T <= 1.2,
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


@three_margins.mistake("That is the gain on the limit. By which factor is it larger than the present one?")
def _(K, T, delay, Kc):
    return {"gain_margin": math.pi * float(T / (K * delay)) / 2} if Kc != 1 else {}


@three_margins.mistake("That is the margin in decibels. Give the factor itself.")
def _(K, T, delay, Kc):
    return {"gain_margin": 20 * math.log10(math.pi * float(T / (K * Kc * delay)) / 2)}


@three_margins.mistake("That is the phase shift of the dead time. The margin is what is left of half a turn.")
def _(K, T, delay, Kc):
    x = math.degrees(float(K * Kc * delay / T))
    return {"phase_margin": x} if abs(x - 45) > 2 else {}


@three_margins.mistake("The integrator has turned the phase by a right angle already.")
def _(K, T, delay, Kc):
    return {"phase_margin": 180 - math.degrees(float(K * Kc * delay / T))}


def _turns(x):
    """How many pairs of poles a loop x exp(-s)/s has in the right half-plane."""
    return max(math.floor((x - math.pi / 2) / (2 * math.pi)) + 1, 0)


def _away_from_limits(K, T, delay, Kc):
    x = float(K * Kc * delay / T)
    return 0.6 <= x <= 21 and abs((x - math.pi / 2 + math.pi) % (2 * math.pi) - math.pi) > 0.15


@exercise("19.2", title="How many poles are unstable?", points=3, where=_away_from_limits)
def unstable_poles(
    K=between(0.5, 4, "", reference=3),
    T=between(2, 12, "s", reference=5),
    delay=between(2, 12, "s", reference=8),
    Kc=between(0.5, 5, "", reference=2),
):
    r"""Someone has exchanged the settings of two loops. Now a PI controller with the gain {Kc} controls a process
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


@exercise(
    "19.3",
    title="Diagnosis of an oscillation",
    points=4,
    where=lambda T, Ti, period: period >= T / 2 and abs(T - Ti) >= T / 5,
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


@exercise("19.4", title="If the gain changes", points=4, where=_judgeable)
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


@exercise("19.5", title="Robust in the window, and quick", points=6, where=lambda T, delay: 3 * delay <= T <= 8 * delay)
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

    (The response says how far the limit of stability is from the window: 1 if it touches, 2 if it is twice as high.)
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


@in_the_window.shows
def _(K, T, delay):
    return {"limit": f"{_ISE_limit(K, T, delay):g} s", "process": first_order(K, T, delay)}


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
