"""Exercises of chapter 13, poles and zeros."""

from math import atan2, atanh, inf, sinh, sqrt
from math import exp as exponential
from math import sin as sine

import numpy as np
import sympy
from sympy import Rational, exp, log, symbols

from loopbook import diagrams
from loopbook.deadtime import System
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
    poles,
    settings,
    stable,
    time_function,
    transfer_function,
    word,
)
from loopbook.expressions import s, t
from loopbook.figures import plane_plot, time_plot
from loopbook.pid import PID

_SHAPES = ["inverse response", "overshoot", "neither"]


def _factor(value):
    """A factor in a formula; a factor of one is not written."""
    return "" if value == 1 else rf"{float(value):g}\,"


def _apart(value, *others, by=0.04):
    """Whether a wrong value can be told from the right one and from those of other mistakes."""
    return all(abs(value - other) > by * abs(other) for other in others)


@exercise(
    "13.1",
    title="A response before it is drawn",
    points=2,
    where=lambda tau_1, tau_2, T: tau_1 > tau_2 and T not in (tau_1, tau_2),
    insight="Two limits, $g(0)$ and that of $s\\,g(s)$, and the zero tell the story of a step response "
    "before it is drawn.",
)
def before_it_is_drawn(
    k=between(1, 6, reference=2, step=1),
    tau_1=between(4, 12, reference=8, step=1),
    tau_2=between(1, 5, reference=2, step=1),
    T=choice(-8, -6, -5, -3, -2, 1, 2, 3, 6, 14, 18, 25, reference=-3),
    M=between(0.5, 4, reference=1.5, step=0.5),
):
    """A process has the transfer function

    $g(s) =$ {g}

    with the time in seconds. Its input steps from zero to $M =$ {M}. Read off the transfer function with which slope
    the response begins and where it ends. Which shape does it have: an inverse response, an overshoot, or neither?
    """
    return answers(
        slope=number(k * T * M / (tau_1 * tau_2), "1/s", "the initial slope"),
        end=number(k * M, "", "the final value"),
        shape=word(_shape(T, tau_1), _SHAPES, "the shape of the response"),
    )


def _shape(T, slowest):
    return "inverse response" if T < 0 else "overshoot" if slowest < T else "neither"


@before_it_is_drawn.shows
def _(k, tau_1, tau_2, T):
    return {"g": (k * T * s + k) / (tau_1 * tau_2 * s**2 + (tau_1 + tau_2) * s + 1)}


@before_it_is_drawn.mistake("That is the response to a step of height one. How high is this step?")
def _(k, tau_1, tau_2, T, M):
    return {"slope": k * T / (tau_1 * tau_2), "end": k} if M != 1 else {}


@before_it_is_drawn.mistake(
    "For large $s$, which term of the numerator is the larger one? The other one does not matter then."
)
def _(k, tau_1, tau_2, T, M):
    return {"slope": k * M / (tau_1 * tau_2)} if T != 1 else {}


@before_it_is_drawn.mistake("For large $s$ it is $s^2$ that remains in the denominator, not $s$.")
def _(k, tau_1, tau_2, T, M):
    return {"slope": k * T * M / (tau_1 + tau_2)} if tau_1 * tau_2 != tau_1 + tau_2 else {}


@before_it_is_drawn.mistake("That is the numerator alone. By what is its $s$ divided where $s$ is large?")
def _(k, tau_1, tau_2, T, M):
    return {"slope": k * T} if M not in (1, tau_1 * tau_2) else {}


@before_it_is_drawn.mistake("That is the numerator alone. By what is its $s$ divided where $s$ is large?")
def _(k, T, M):
    return {"slope": k * T * M}


@before_it_is_drawn.mistake(
    "Two lags alone would begin with the slope zero. What does the $s$ in the numerator do to that?"
)
def _():
    return {"slope": 0}


@before_it_is_drawn.mistake("Where does the response end if the input is one? The gain $g(0)$ says it.")
def _(k, M):
    return {"end": M} if k not in (1, M) else {}


@before_it_is_drawn.mistake(
    "The powers of $s$ and their factors decide nothing at rest. Which terms are left at $s = 0$?"
)
def _(k, tau_1, tau_2, M):
    return {"end": k * M / (tau_1 * tau_2)}


@before_it_is_drawn.mistake(
    "Compare the signs of the initial slope and of the final value. Does the response set out towards its end?"
)
def _(T):
    return {"shape": "neither"} if T < 0 else {}


@before_it_is_drawn.mistake(
    "For an overshoot the zero must be on the left, and slower than the slowest lag. Compare their time constants."
)
def _(tau_1, T):
    return {"shape": "overshoot"} if tau_1 > T else {}


@before_it_is_drawn.mistake("The zero is slower than the slowest lag here. What does that do to the response?")
def _(tau_1, T):
    return {"shape": "neither"} if tau_1 < T else {}


@before_it_is_drawn.mistake(
    "An inverse response sets out away from its end. Compare the signs of the initial slope and of the final value."
)
def _(T):
    return {"shape": "inverse response"} if T > 0 else {}


before_it_is_drawn.hints(
    "The two limit theorems tell both ends: what becomes of $g(s)$ for $s = 0$, and of $s\\,g(s)$ for large $s$?",
    "The end is $g(0)\\,M$. For the slope, keep the highest power of $s$ in the numerator and in the denominator, and "
    "multiply by $s$ and by $M$. For the shape, compare the time constant of the zero with those of the lags, sign "
    "included.",
    "$k =$ {k}, and $T = {T}$ is the factor of $s$ in the numerator, divided by $k$. The denominator begins with "
    "${tau_1} \\cdot {tau_2}\\,s^2$.",
)


@before_it_is_drawn.solution
def _(k, tau_1, tau_2, T, M):
    r"""In time constants, $g(s) = \frac{k\,(Ts + 1)}{(\tau_1s + 1)(\tau_2s + 1)}$ with $k = {k}$, $T = {T}$ s and the
    lags ${tau_1}$ s and ${tau_2}$ s. At rest $s = 0$, and the response ends at $g(0)\,M = {k} \cdot {M} =$ {end}.

    At the beginning $s$ is large, and only the highest powers count: $g(s) \to \frac{kT}{\tau_1\tau_2\,s}$.

    ***

    Multiplied by $s$ and by the height of the step, that is the slope:
    $\frac{ {k} \cdot ({T}) \cdot {M} }{ {tau_1} \cdot {tau_2} } = {slope}$ per second.

    {because} So the shape is: {shape}.
    """
    because = {
        "inverse response": "Slope and end have opposite signs, because the zero is in the right half-plane: the "
        "response sets out in the wrong direction.",
        "overshoot": "Slope and end have the same sign, and the zero is slower than the slowest lag: its lead is more "
        "than the lags take back.",
        "neither": "Slope and end have the same sign, and the zero is faster than the slowest lag: it makes the "
        "response quicker, and not so quick that it overshoots.",
    }
    return {"because": because[_shape(T, tau_1)]}


@before_it_is_drawn.solution_picture
def _(k, tau_1, tau_2, T, M):
    """The step response with its end."""
    g = (k * T * s + k) / (tau_1 * tau_2 * s**2 + (tau_1 + tau_2) * s + 1)
    times = np.linspace(0, float(6 * tau_1), 201)
    return time_plot({"$y$": M * System(g).step(times)}, times, low=True).level(k * M, "end")


def _damping(overshoot):
    """The damping that belongs to an overshoot, a share of the step."""
    size = -log(overshoot)
    return size / sympy.sqrt(sympy.pi**2 + size**2)


def _real_part(percent, P):
    """The real part of the poles, and the time constant."""
    zeta = float(_damping(percent / 100))
    tau = float(P) * sqrt(1 - zeta**2) / (2 * float(sympy.pi))
    return -zeta / tau, tau


@exercise(
    "13.2",
    title="A pressure loop oscillates",
    points=3,
    where=lambda before, after: after >= before + 1,
    insight="A record of two peaks tells the poles: the ratio of the peaks the damping, their distance the "
    "imaginary part.",
)
def swinging_loop(
    before=between(2, 5, "bar", reference=4, step=0.5),
    after=between(3, 8, "bar", reference=6, step=0.5),
    percent=between(20, 45, "%", reference=30, step=5),
    P=between(6, 40, "s", reference=12, step=1),
):
    r"""The setpoint of a pressure controller is raised from {before} to {after}, and the pressure follows without an
    offset. The first peak exceeds the new setpoint by {percent} of the step, and {P} later comes the next
    peak. Describe the loop by a transfer function of second order without a zero,
    $1/(\tau^2s^2 + 2\zeta\tau s + 1)$. Find the damping $\zeta$, the time constant $\tau$ and the poles. By how much
    does the *second* peak exceed the setpoint?
    """
    share = percent / 100
    zeta = _damping(share)
    tau = P * sympy.sqrt(1 - zeta**2) / (2 * sympy.pi)
    real, imaginary = float(-zeta / tau), float(2 * sympy.pi / P)
    return answers(
        zeta=number(zeta, "", "the damping"),
        tau=number(tau, "s", "the time constant"),
        poles=poles([complex(real, imaginary), complex(real, -imaginary)], "rad/s", "the poles"),
        second_peak=number(
            (after - before) * share**3, "bar", "the height of the second peak above the setpoint", within=0.02
        ),
    )


@swinging_loop.mistake(
    "The overshoot is counted from the final value, as a share of the step. Which logarithm belongs to it?"
)
def _(percent):
    return {"zeta": _damping(1 - percent / 100)} if percent != 50 else {}


@swinging_loop.mistake("That is the logarithm of the overshoot over $\\pi$, which is right for small damping only.")
def _(percent):
    return {"zeta": -log(percent / 100) / sympy.pi}


@swinging_loop.mistake(
    "That takes {percent} for the decay ratio, from one peak to the next. Here it is the first peak alone, counted "
    "from the setpoint."
)
def _(percent):
    return {"zeta": _damping(sympy.sqrt(percent / 100))}


@swinging_loop.mistake("That is with the decimal logarithm. Which one undoes the exponential function?")
def _(percent):
    size = -log(percent / 100, 10)
    return {"zeta": size / sympy.sqrt(sympy.pi**2 + size**2)}


@swinging_loop.mistake(
    "That is $P/2\\pi$, which is right for small damping only. Your loop oscillates a little slower than $1/\\tau$."
)
def _(P):
    return {"tau": P / (2 * sympy.pi)}


@swinging_loop.mistake("From one peak to the next is a whole period, not half of one.")
def _(percent, P):
    real, tau = _real_part(percent, 2 * P)
    w = float(sympy.pi / P)
    return {"tau": tau, "poles": [complex(real, w), complex(real, -w)]}


@swinging_loop.mistake("A period holds one turn, which is $2\\pi$ in radians. Where is it?")
def _(percent, P):
    real, tau = _real_part(percent, P)
    return {"tau": 2 * float(sympy.pi) * tau, "poles": [complex(real, 1 / P), complex(real, -1 / P)]}


@swinging_loop.mistake("Poles to the right of the imaginary axis: that oscillation would grow.")
def _(percent, P):
    real, _ = _real_part(percent, P)
    w = 2 * float(sympy.pi / P)
    return {"poles": [complex(-real, w), complex(-real, -w)]}


@swinging_loop.mistake("The imaginary part is the frequency of the oscillation in rad/s. You know its period.")
def _(percent, P):
    real, tau = _real_part(percent, P)
    return {"poles": [complex(real, 1 / tau), complex(real, -1 / tau)]}


@swinging_loop.mistake("Those would be the poles with the time constant one. What does $\\tau$ do to them?")
def _(percent):
    zeta = float(_damping(percent / 100))
    return {"poles": [complex(-zeta, sqrt(1 - zeta**2)), complex(-zeta, -sqrt(1 - zeta**2))]}


@swinging_loop.mistake("That is one of them. A complex pole of a real process never comes alone.")
def _(percent, P):
    real, _ = _real_part(percent, P)
    return {"poles": [complex(real, 2 * float(sympy.pi / P))]}


@swinging_loop.mistake(
    "From one peak to the next the height falls by the decay ratio, and that is not the overshoot itself."
)
def _(before, after, percent):
    return {"second_peak": (after - before) * (percent / 100) ** 2}


@swinging_loop.mistake("The decay ratio is a ratio: the second peak to the first one. How high is the first one?")
def _(before, after, percent):
    is_another = after - before != 1 and abs(percent * (after - before) - 100) > 5
    return {"second_peak": (percent / 100) ** 2} if is_another else {}


@swinging_loop.mistake("That is a share of the step. How high is the step?")
def _(before, after, percent):
    return {"second_peak": (percent / 100) ** 3} if after - before != 1 else {}


@swinging_loop.mistake("That is the first peak. By which ratio do the peaks become smaller?")
def _(before, after, percent):
    return {"second_peak": (after - before) * percent / 100}


@swinging_loop.mistake("That is a share of the new setpoint. The overshoot is counted as a share of the step.")
def _(before, after, percent):
    wrong, decay = after * (percent / 100) ** 3, (percent / 100) ** 2
    return {"second_peak": wrong} if _apart(wrong, (after - before) * decay, decay) else {}


@swinging_loop.mistake("That is the pressure itself at the second peak. How far is it above the setpoint?")
def _(before, after, percent):
    return {"second_peak": after + (after - before) * (percent / 100) ** 3}


swinging_loop.hints(
    "Overshoot, decay ratio and period of a second-order response depend on two numbers only. Which of the three "
    "depends on the damping alone?",
    "The overshoot is $e^{-\\pi\\zeta/\\sqrt{1 - \\zeta^2}}$, and the period is $2\\pi$ over the imaginary part of the "
    "poles. The real part is $-\\zeta/\\tau$.",
    "Take the logarithm: $\\ell = -\\ln {share} = {size}$, and $\\ell^2(1 - \\zeta^2) = \\pi^2\\zeta^2$. Solve "
    "this for $\\zeta$.",
)


@swinging_loop.shows
def _(percent):
    return {"share": f"{float(percent / 100):g}", "size": f"{float(-log(percent / 100)):.4g}"}


@swinging_loop.solution
def _(before, after, percent, P):
    r"""**Damping.** The overshoot is $e^{-\pi\zeta/\sqrt{1 - \zeta^2}} = {share}$. With $\ell = -\ln {share} = {size}$
    this is $\ell\sqrt{1 - \zeta^2} = \pi\zeta$; squared and solved, $\zeta = \ell/\sqrt{\pi^2 + \ell^2} = {zeta}$.

    **Time constant.** The period is $P = 2\pi\tau/\sqrt{1 - \zeta^2}$, so that
    $\tau = \frac{P\sqrt{1 - \zeta^2} }{2\pi} =$ {tau}.

    **Poles.** Their real part is $-\zeta/\tau = {real}$, and their imaginary part is the frequency that is seen,
    $2\pi/P = {imaginary}$: together ${real} \pm {imaginary}\,j$ rad/s.

    **Second peak.** The first peak is {first_peak} above the setpoint. From peak to peak the height falls by the decay
    ratio, the square of the overshoot, $({share})^2 = {decay}$. So the second one is {second_peak} above it.
    """
    real, _ = _real_part(percent, P)
    return {
        "real": real,
        "imaginary": float(2 * sympy.pi / P),
        "first_peak": ((after - before) * percent / 100, "bar"),
        "decay": (percent / 100) ** 2,
    }


@swinging_loop.picture
def _(before, after, percent, P):
    """The pressure after the step of its setpoint: a damped oscillation around the new setpoint."""
    times = np.linspace(0, float(P) * 2.2, 301)
    curves = {"pressure": (_swing(before, after, percent, P, times), "measurement"), "setpoint": (after, "setpoint")}
    plot = time_plot(curves, times, ylabel="pressure [bar]", low=True)
    return plot.mark(P / 2, "first peak", "pressure").mark(3 * P / 2, "next peak", "pressure")


def _swing(before, after, percent, P, times):
    """The pressure at these times."""
    (real, _), w = _real_part(percent, P), 2 * np.pi / float(P)
    wave = np.exp(real * times) * (np.cos(w * times) - real / w * np.sin(w * times))
    return float(after) - float(after - before) * wave


@exercise(
    "13.3",
    title="The cold feed of a hot reactor",
    points=3,
    where=lambda k, K, tau_1, tau_2: 4 * k >= 5 * K and 10 * K * tau_1 >= 12 * k * tau_2 and tau_1 >= 3 * tau_2,
    insight="A right half-plane zero is a conflict: a fast path that loses in the end against a slow one that wins.",
)
def cold_feed(
    k=between(2, 8, "K/(L/min)", reference=4, step=0.5),
    K=between(0.5, 4, "K/(L/min)", reference=1.5, step=0.25),
    tau_1=between(8, 30, "min", reference=15, step=1),
    tau_2=between(0.5, 4, "min", reference=1, step=0.5),
):
    r"""In a stirred reactor heat is set free. More feed has two effects on its temperature. The feed is cold, and so it
    lowers the temperature, by {K} in the end, with a lag of {tau_2}. Later there is more to react, which raises the
    temperature by {k} with a lag of {tau_1}. The two effects add up.

    Give the transfer function from the feed [L/min] to the temperature [K], with the time in minutes, and its zero. The
    response begins in the wrong direction. If only the gain of the fast effect could be changed, without its sign:
    below which gain would the inverse response be gone?
    """
    return answers(
        G=transfer_function(k / (tau_1 * s + 1) - K / (tau_2 * s + 1), "the transfer function"),
        zero=poles([(k - K) / (K * tau_1 - k * tau_2)], "1/min", "the zero"),
        K_limit=number(k * tau_2 / tau_1, "K/(L/min)", "the largest gain without inverse response"),
    )


@cold_feed.mistake("One of the two effects lowers the temperature. What is its sign?")
def _(k, K, tau_1, tau_2):
    return {"G": k / (tau_1 * s + 1) + K / (tau_2 * s + 1), "zero": [-(k + K) / (K * tau_1 + k * tau_2)]}


@cold_feed.mistake("These would be two lags in series. But each effect starts from the feed, and their results add up.")
def _(k, K, tau_1, tau_2):
    return {"G": -k * K / ((tau_1 * s + 1) * (tau_2 * s + 1))}


@cold_feed.mistake("That is the time constant of the zero, up to its sign. The zero is the root of the numerator.")
def _(k, K, tau_1, tau_2):
    wrong, right = (K * tau_1 - k * tau_2) / (k - K), (k - K) / (K * tau_1 - k * tau_2)
    return {"zero": [wrong]} if abs(wrong / right - 1) > 0.05 else {}


@cold_feed.mistake("Those are the poles, the roots of the denominator. A zero is a root of the numerator.")
def _(tau_1, tau_2):
    return {"zero": [-1 / tau_1, -1 / tau_2]}


@cold_feed.mistake("Bring the fractions to a common denominator: each gain is multiplied by the lag of the other one.")
def _(k, K, tau_1, tau_2):
    return {"zero": [(k - K) / (k * tau_1 - K * tau_2)]}


@cold_feed.mistake("The minus in front of the second fraction holds for its whole numerator. Collect the terms again.")
def _(k, K, tau_1, tau_2):
    return {"zero": [(k - K) / (K * tau_1 + k * tau_2)]}


@cold_feed.mistake("That is a slope. Which gain gives the fast effect this slope?")
def _(k, tau_1, tau_2):
    return {"K_limit": k / tau_1} if tau_2 != 1 else {}


@cold_feed.mistake("The fast effect need not be gone. How strong may it be before it wins in the beginning?")
def _():
    return {"K_limit": 0}


@cold_feed.mistake(
    "That makes the present gain of the fast effect smaller by the ratio of the lags. Whose slope counts?"
)
def _(k, K, tau_1, tau_2):
    return {"K_limit": K * tau_2 / tau_1}


@cold_feed.mistake("With this gain the temperature comes back to where it was: that is about the end of the response.")
def _(k):
    return {"K_limit": k}


@cold_feed.mistake("Compare how steeply the two effects begin: each slope is a gain over a lag.")
def _(k, tau_1, tau_2):
    return {"K_limit": k * tau_1 / tau_2}


cold_feed.hints(
    "Two paths lead from the feed to the temperature, and the temperature is their sum. Which sign has each of them?",
    "Each path is a gain over a lag. Bring the two fractions to a common denominator; the zero is the root of the "
    "numerator. For the last question compare the slopes with which the two paths begin: a gain over its lag.",
    "With $k$ = {k} and $\\tau_1$ = {tau_1} for the slow effect, $K$ = {K} and $\\tau_2$ = {tau_2} for the fast one, "
    "the numerator is $k\\,(\\tau_2s + 1) - K\\,(\\tau_1s + 1)$. Collect its terms with $s$.",
)


@cold_feed.solution
def _(k, K, tau_1, tau_2):
    r"""The slow path warms, the fast one cools, and both start from the feed:
    $G(s) = \frac{ {k} }{ {tau_1}\,s + 1} - \frac{ {K} }{ {fast}s + 1}$.

    On a common denominator the numerator is $k(\tau_2s + 1) - K(\tau_1s + 1) = (k - K) - (K\tau_1 - k\tau_2)\,s$. Its
    root is $z = \frac{k - K}{K\tau_1 - k\tau_2} = \frac{ {difference} }{ {below} } = {z}$ per minute. It is positive,
    because the slow path wins in the end ($k > K$) and loses in the beginning ($K/\tau_2 > k/\tau_1$).

    At the beginning the fast path lowers the temperature by $K/\tau_2 =$ {steep} per minute, and the slow one raises it
    by $k/\tau_1 =$ {flat} only. The inverse response is gone as soon as the fast path is not the steeper one any more:
    $K \le k\,\tau_2/\tau_1 =$ {K_limit}.
    """
    return {
        "fast": _factor(tau_2),
        "difference": k - K,
        "below": K * tau_1 - k * tau_2,
        "z": (k - K) / (K * tau_1 - k * tau_2),
        "steep": (K / tau_2, "K"),
        "flat": (k / tau_1, "K"),
    }


@cold_feed.picture
def _(k, K, tau_1, tau_2):
    """The two effects of 1 L/min more feed, each alone: a slow rise and a fast fall."""
    times = np.linspace(0, float(4 * tau_1), 201)
    slow, fast = (float(x) * (1 - np.exp(-times / float(T))) for x, T in ((k, tau_1), (-K, tau_2)))
    curves = {"more to react": slow, "cold feed": fast}
    return time_plot(curves, times, xlabel="$t$ [min]", ylabel="temperature [K]", low=True)


@cold_feed.solution_picture
def _(k, K, tau_1, tau_2):
    """The sum of the two effects, and the same with the gain of the fast one at the limit."""
    times = np.linspace(0, float(4 * tau_1), 201)
    slow, fast = ((1 - np.exp(-times / float(T))) for T in (tau_1, tau_2))
    gains = {"as it is": K, "at the limit": k * tau_2 / tau_1}
    curves = {name: float(k) * slow - float(gain) * fast for name, gain in gains.items()}
    return time_plot(curves, times, xlabel="$t$ [min]", ylabel="temperature [K]", low=True)


@exercise(
    "13.4",
    title="How much gain, how much damping?",
    points=4,
    where=lambda k, tau_1, tau_2: tau_1 >= 2 * tau_2 and k != 1,
    insight="Gain buys accuracy and pays with damping: one over $1 + K_ck$ is left of the error, the root "
    "of it of the damping.",
)
def gain_and_damping(
    k=between(0.5, 4, "K/%", reference=2, step=0.5),
    tau_1=between(6, 30, "s", reference=12, step=1),
    tau_2=between(1, 6, "s", reference=3, step=0.5),
    zeta=choice(0.5, 0.6, 0.7, 0.8, reference=0.5),
):
    r"""The temperature of a small oven follows its heater with a gain of {k} and two lags, {tau_1} and {tau_2}. It is
    controlled by a P controller with the gain $K_c$ [%/K].

    Derive the damping $\zeta$ of the closed loop, in the symbols $k$, $K_c$, $\tau_1$ and $\tau_2$ (type `k`, `K_c`,
    `tau_1`, `tau_2`). For which gain is it {zeta}? With this gain, how much of a setpoint step is left as an offset,
    and which time constant $\tau$ does the closed loop have?
    """
    square = _one_and_loop_gain(tau_1, tau_2, zeta)
    return answers(
        damping=expression(_damping_in_symbols(1), "the damping in symbols"),
        K_c=number((square - 1) / k, "%/K", "the gain of the controller"),
        offset=number(100 / square, "%", "the offset"),
        tau=number(sympy.sqrt(tau_1 * tau_2 / square), "s", "the time constant of the closed loop"),
    )


def _one_and_loop_gain(tau_1, tau_2, zeta):
    """What 1 + K_c k must be for a damping."""
    return (tau_1 + tau_2) ** 2 / (4 * Rational(zeta) ** 2 * tau_1 * tau_2)


def _damping_in_symbols(one):
    k, K_c, tau_1, tau_2 = symbols("k K_c tau_1 tau_2", positive=True)
    return (tau_1 + tau_2) / (2 * sympy.sqrt(tau_1 * tau_2 * (one + K_c * k)))


@gain_and_damping.mistake(
    "In the constant term of the denominator there is more than the loop gain. Multiply $1 + gc$ out again."
)
def _():
    return {"damping": _damping_in_symbols(0)}


@gain_and_damping.mistake("That is the damping of the process alone. What does the loop do to the constant term?")
def _():
    tau_1, tau_2 = symbols("tau_1 tau_2", positive=True)
    return {"damping": (tau_1 + tau_2) / (2 * sympy.sqrt(tau_1 * tau_2))}


@gain_and_damping.mistake("The middle coefficient is $2\\zeta\\tau$, with a two.")
def _():
    return {"damping": 2 * _damping_in_symbols(1)}


@gain_and_damping.mistake("Here numbers have been put in. Give the formula with the symbols first.")
def _(k, tau_1, tau_2):
    return {"damping": (tau_1 + tau_2) / (2 * sympy.sqrt(tau_1 * tau_2 * (1 + k * symbols("K_c"))))}


@gain_and_damping.mistake("That is the loop gain $K_ck$. Which part of it belongs to the controller?")
def _(k, tau_1, tau_2, zeta):
    return {"K_c": _one_and_loop_gain(tau_1, tau_2, zeta) - 1}


@gain_and_damping.mistake("Is that $K_c$ times $k$ alone? In the constant term of the denominator there is one more.")
def _(k, tau_1, tau_2, zeta):
    square = _one_and_loop_gain(tau_1, tau_2, zeta)
    return {"K_c": square / k, "offset": 100 / (square + 1)}


@gain_and_damping.mistake("In the damping $1 + K_ck$ is below a root. What undoes the root?")
def _(k, tau_1, tau_2, zeta):
    return {"K_c": (sympy.sqrt(_one_and_loop_gain(tau_1, tau_2, zeta)) - 1) / k}


@gain_and_damping.mistake("There the middle coefficient is $\\zeta\\tau$. A factor is missing in it.")
def _(k, tau_1, tau_2, zeta):
    return {"K_c": (4 * _one_and_loop_gain(tau_1, tau_2, zeta) - 1) / k}


@gain_and_damping.mistake("That is the middle coefficient, $2\\zeta\\tau$. What does it leave for $\\tau$?")
def _(tau_1, tau_2, zeta):
    return {"tau": (tau_1 + tau_2) / _one_and_loop_gain(tau_1, tau_2, zeta)} if 2 * zeta != 1 else {}


@gain_and_damping.mistake("That is the share that is reached. The offset is what is missing.")
def _(tau_1, tau_2, zeta):
    left = 1 / _one_and_loop_gain(tau_1, tau_2, zeta)
    return {"offset": 100 * (1 - left)} if abs(1 / left - 2) > 0.05 else {}


@gain_and_damping.mistake("That is one over the loop gain. At rest the error is one over something else.")
def _(tau_1, tau_2, zeta):
    return {"offset": 100 / (_one_and_loop_gain(tau_1, tau_2, zeta) - 1)}


@gain_and_damping.mistake("That is the coefficient of $s^2$. Which power of the time constant is it?")
def _(tau_1, tau_2, zeta):
    wrong = tau_1 * tau_2 / _one_and_loop_gain(tau_1, tau_2, zeta)
    return {"tau": wrong} if abs(wrong - 1) > Rational(1, 10) else {}


@gain_and_damping.mistake("That is the time constant of the process without control. The loop makes it smaller.")
def _(tau_1, tau_2):
    return {"tau": sympy.sqrt(tau_1 * tau_2)}


gain_and_damping.hints(
    "A closed loop is $\\frac{gc}{1 + gc}$. Its denominator tells damping and time constant.",
    "Multiply $1 + gc$ by the two lags and divide by the constant term. Compare with "
    "$\\tau^2s^2 + 2\\zeta\\tau s + 1$. The offset of a P controller is $\\frac{1}{1 + K_ck}$ of the step.",
    "The denominator is $\\tau_1\\tau_2s^2 + (\\tau_1 + \\tau_2)\\,s + 1 + K_ck$ with $\\tau_1\\tau_2 = {product}$ and "
    "$\\tau_1 + \\tau_2 = {total}$. Put in $\\zeta =$ {zeta} and solve for $1 + K_ck$ first.",
)


@gain_and_damping.shows
def _(tau_1, tau_2):
    return {"product": f"{float(tau_1 * tau_2):g}", "total": f"{float(tau_1 + tau_2):g}"}


@gain_and_damping.solution
def _(k, tau_1, tau_2, zeta):
    r"""The closed loop is $\frac{K_ck}{(\tau_1s + 1)(\tau_2s + 1) + K_ck}$. Divide its denominator by the constant
    term $1 + K_ck$:
    $\tau^2 = \frac{\tau_1\tau_2}{1 + K_ck}$ and $2\zeta\tau = \frac{\tau_1 + \tau_2}{1 + K_ck}$.

    Divide the second one by $2\tau$, and the damping is
    $\zeta = \frac{\tau_1 + \tau_2}{2\sqrt{\tau_1\tau_2\,(1 + K_ck)} }$: the more gain, the less damping.

    For $\zeta =$ {zeta} that gives
    $1 + K_ck = \frac{(\tau_1 + \tau_2)^2}{4\zeta^2\tau_1\tau_2} = \frac{ {total}^2}{4 \cdot {zeta}^2 \cdot {product} }
    = {square}$, and with $k =$ {k} the gain is $K_c =$ {K_c}.

    At rest the lags are one, and the share $\frac{1}{1 + K_ck} = \frac{1}{ {square} }$ of the step is left: {offset}.
    The time constant is $\tau = \sqrt{ {product}/{square} } =$ {tau}.
    """
    return {"square": _one_and_loop_gain(tau_1, tau_2, zeta)}


@gain_and_damping.picture
def _(k, tau_1, tau_2):
    """A loop of the controller with the gain K_c and a process of two lags."""
    lags = "".join(f"({_factor(x)}s + 1)" for x in (tau_1, tau_2))
    process = diagrams.block(rf"\frac{{{float(k):g}}}{{{lags}}}")
    return diagrams.block_diagram("y_s", diagrams.feedback_loop([diagrams.block("K_c"), "u", process]), "y")


@gain_and_damping.solution_picture
def _(k, tau_1, tau_2, zeta):
    """A setpoint step of the loop with this gain: it oscillates, and an offset is left."""
    square = float(_one_and_loop_gain(tau_1, tau_2, zeta))
    tau = sqrt(tau_1 * tau_2 / square)
    times = np.linspace(0, 12 * tau, 301)
    y = (1 - 1 / square) * System(1 / (tau**2 * s**2 + 2 * zeta * tau * s + 1)).step(times)
    curves = {"temperature": (y, "measurement"), "setpoint": (1, "setpoint")}
    return time_plot(curves, times, ylabel="share of the step", low=True)


@exercise(
    "13.5",
    title="The level that falls when water comes in",
    points=4,
    where=lambda K, rate, tau: 1.4 <= K / (rate * tau) <= 8,
    insight="The shrinking level is the same conflict with an integrator: what is measured first is not "
    "what happens in the end.",
)
def shrinking_drum(
    rate=between(0.1, 1, "cm/s", reference=0.2, step=0.1),
    K=between(2, 15, "cm", reference=6, step=1),
    tau=between(5, 30, "s", reference=10, step=1),
    M=choice(0.5, 1.5, 2, 2.5, 3, reference=2, unit="kg/s"),
):
    r"""In the drum of a steam boiler, water boils. Each kg/s more of feedwater, with the same steam, lets the level
    rise by {rate}, steadily. But the feedwater is colder: some steam bubbles collapse, which lowers the level by {K}
    for each kg/s, with a lag of {tau}. Both effects add up.

    Give the transfer function from the feedwater [kg/s] to the level [cm], with the time in seconds, and its zero. At
    $t = 0$ the feedwater is raised by {M}. Find the change of the level as a function of time. When is the level
    lowest?
    """
    return answers(
        G=transfer_function(rate / s - K / (tau * s + 1), "the transfer function"),
        zero=poles([rate / (K - rate * tau)], "1/s", "the zero"),
        h=time_function(M * (rate * t - K * (1 - exp(-t / tau))), 4 * tau, "cm", "the change of the level"),
        t_low=number(tau * log(K / (rate * tau)), "s", "the moment of the lowest level"),
    )


@shrinking_drum.mistake("The bubbles that collapse lower the level. What is the sign of this effect?")
def _(rate, K, tau, M):
    return {
        "G": rate / s + K / (tau * s + 1),
        "zero": [-rate / (K + rate * tau)],
        "h": M * (rate * t + K * (1 - exp(-t / tau))),
    }


@shrinking_drum.mistake("A level that goes on rising belongs to an integrator. Your first effect ends somewhere.")
def _(rate, K, tau):
    return {"G": rate - K / (tau * s + 1)}


@shrinking_drum.mistake("These are two effects in series. But each of them starts from the feedwater, and they add up.")
def _(rate, K, tau):
    return {"G": -rate * K / (s * (tau * s + 1))}


@shrinking_drum.mistake("That is the response to one kg/s. How much feedwater is added?")
def _(rate, K, tau):
    return {"h": rate * t - K * (1 - exp(-t / tau))}


@shrinking_drum.mistake(
    "That is the response to a short pulse of water, not to a step. Where is the $1/s$ of the step?"
)
def _(rate, K, tau, M):
    return {"h": M * (rate - K / tau * exp(-t / tau))}


@shrinking_drum.mistake("That is one over the zero. The level is lowest where its slope is zero.")
def _(rate, K, tau):
    return {"t_low": (K - rate * tau) / rate}


def _back(rate, K, tau):
    """When the level is back where it began."""
    from scipy.special import lambertw

    x = float(K / (rate * tau))
    return float(tau) * (x + float(lambertw(-x * exponential(-x)).real))


@shrinking_drum.mistake("Collect the terms with $s$ again: one of the two fractions is subtracted.")
def _(rate, K, tau):
    return {"zero": [rate / (K + rate * tau)]}


@shrinking_drum.mistake("The slope of $e^{-t/\\tau}$ has one over the time constant in it. Differentiate once more.")
def _(rate, K, tau):
    wrong = tau * log(K / rate)
    return {"t_low": wrong} if _apart(wrong, _back(rate, K, tau), (K - rate * tau) / rate) else {}


@shrinking_drum.mistake("There the level is back at its beginning. It has been lowest before, where its slope is zero.")
def _(rate, K, tau):
    return {"t_low": _back(rate, K, tau)}


@shrinking_drum.mistake("The height of the step multiplies both effects. What does it do where their slopes cancel?")
def _(rate, K, tau, M):
    wrong = tau * log(M * K / (rate * tau))
    others = tau * log(K / (rate * tau)), tau * log(K / rate), _back(rate, K, tau), (K - rate * tau) / rate
    return {"t_low": wrong} if wrong > 0 and _apart(wrong, *others) else {}


@shrinking_drum.mistake("At $t = 0$ this level has jumped already. How does the step response of a lag begin?")
def _(rate, K, tau, M):
    return {"h": M * (rate * t - K * exp(-t / tau))}


@shrinking_drum.mistake("The step of the feedwater makes both effects larger, not one of them.")
def _(rate, K, tau, M):
    return {"h": M * rate * t - K * (1 - exp(-t / tau))}


@shrinking_drum.mistake("The bubbles do not collapse at once: their effect comes with a lag.")
def _(rate, K, M):
    return {"h": M * (rate * t - K)}


shrinking_drum.hints(
    "Two paths again: one effect goes on rising as long as there is more water, the other one ends. Which kind of "
    "process is each of them?",
    "The steady rise is an integrator, the collapse of the bubbles a lag with a negative gain; the level is their sum. "
    "The response to a step of height $M$ is $M$ times the sum of a ramp and a lag's step response. The level is "
    "lowest where its slope is zero.",
    "The ramp of 1 kg/s rises by {rate_n} cm in each second. The lag's step response $1 - e^{-t/\\tau}$ with $\\tau$ = "
    "{tau} has the slope $\\frac{1}{\\tau}e^{-t/\\tau}$: times its gain it must be as steep as the ramp.",
)


@shrinking_drum.shows
def _(rate, K, tau):
    return {"rate_n": f"{float(rate):g}", "K_n": f"{float(K):g}", "tau_n": f"{float(tau):g}"}


@shrinking_drum.solution
def _(rate, K, tau, M):
    r"""More water lets the level rise steadily, an integrator; the collapsing bubbles lower it by a certain amount, a
    lag: $G(s) = \frac{ {rate_n} }{s} - \frac{ {K_n} }{ {tau_n}\,s + 1}$.

    On a common denominator the numerator is ${times}({tau_n}\,s + 1) - {K_n}\,s$. Its root is
    $\frac{ {rate_n} }{ {K_n} - {ramp} } = {z}$ per second. It is positive because the bubbles win in
    the beginning: they lower the level by {steep} in each second, the water raises it by {rate_n} cm only.

    The step of {M} makes a ramp of the integrator and a lag's step response of the other one:
    $h(t) = {M_n}\left({times}t - {K_n}\,(1 - e^{-t/{tau_n} })\right)$ cm.

    Its slope is zero where $\frac{ {K_n} }{ {tau_n} }e^{-t/{tau_n} } = {rate_n}$, that is at
    $t = {tau_n}\,\ln\frac{ {K_n} }{ {ramp} } =$ {t_low}. There the level is {lowest} below its
    beginning, and an operator who looks at it would add still more water.
    """
    return {
        "z": rate / (K - rate * tau),
        "steep": (K / tau, "cm"),
        "times": _factor(rate),
        "ramp": f"{float(tau):g}" if rate == 1 else rf"{float(rate):g} \cdot {float(tau):g}",
        "M_n": f"{float(M):g}",
        "lowest": (float(M * (K - rate * tau - rate * tau * log(K / (rate * tau)))), "cm"),
    }


@shrinking_drum.picture
def _(rate, K, tau):
    """The two effects of 1 kg/s more feedwater, each alone: a ramp upwards, and a fall that ends."""
    times = np.linspace(0, float(4 * tau), 201)
    curves = {"more water": float(rate) * times, "fewer bubbles": float(-K) * (1 - np.exp(-times / float(tau)))}
    return time_plot(curves, times, ylabel="level [cm]", low=True)


@shrinking_drum.solution_picture
def _(rate, K, tau, M):
    """The level after the step of the feedwater, with its lowest point."""
    lowest = float(tau * log(K / (rate * tau)))
    times = np.linspace(0, max(2.5 * lowest, float(3 * tau)), 201)
    h = float(M) * (float(rate) * times - float(K) * (1 - np.exp(-times / float(tau))))
    return time_plot({"level [cm]": h}, times, low=True).mark(lowest, "lowest")


def _peak(controller, A, d):
    """The largest deviation of a level under PI control after a step d of the inflow; tank area A."""
    Kp, Ti = float(controller.Kp), float(controller.Ti)
    if Kp <= 0 or Ti <= 0:
        return inf
    if Ti == inf:
        return d / Kp
    w, zeta = sqrt(Kp / (A * Ti)), _zeta(controller, A)
    if abs(zeta - 1) < 1e-6:
        return d / (A * w * exponential(1))
    root = sqrt(abs(zeta**2 - 1))
    if zeta > 1:
        x = atanh(root / zeta) / root
        return d / (A * w * root) * exponential(-zeta * x) * sinh(root * x)
    x = atan2(root, zeta) / root
    return d / (A * w * root) * exponential(-zeta * x) * sine(root * x)


def _zeta(controller, A):
    """The damping of a level under PI control."""
    Kp, Ti = float(controller.Kp), float(controller.Ti)
    return sqrt(Kp * Ti / A) / 2 if Kp > 0 and Ti > 0 else -inf


@exercise(
    "13.6",
    title="A calm level and a calm outflow",
    points=6,
    where=lambda A, d, h_max, r_max: 0.8 <= h_max / 100 * (r_max * A / d) / d <= 0.95,
    insight="A level needs gain: too little of it with a short integral time is what makes levels oscillate slowly.",
)
def calm_level(
    A=between(4, 20, "m²", reference=10, step=1),
    d=between(0.2, 1, "m³/min", reference=0.5, step=0.05),
    h_max=between(20, 90, "cm", reference=42, step=2),
    r_max=between(0.01, 0.1, "m³/min²", reference=0.05, step=0.005),
):
    r"""The level in a buffer tank with the area {A} is held by a PI controller that moves the outflow. The tank should
    protect the plant behind it. When the inflow suddenly rises by {d}, the level must not rise by more than {h_max},
    and the outflow must not change faster than by {r_max} at first. Then the level should come back without
    oscillations.

    With $u = -\Delta q_{out}$ the level is an integrating process $k'/s$ with $k' = 1/A$, and the gain $K_c$ of the
    controller is positive. Give the least integral time $\tau_I$ without oscillations, in the symbols $A$ and $K_c$
    (type `A`, `K_c`). Then choose $K_c$ and $\tau_I$; a `PID` calls them `Kp` and `Ti`.
    """
    A_symbol, K_c = symbols("A K_c", positive=True)
    Kp = Rational(98, 100) * r_max * A / d
    numbers = float(A), float(d)
    return answers(
        tau_least=expression(4 * A_symbol / K_c, "the least integral time in symbols"),
        controller=design(
            settings(
                PID(Kp, Ti=Rational(41, 10) * A / Kp), gain="m²/min", time="min", what="the settings of the controller"
            ),
            pi_controller(),
            stable(by=lambda controller: controller.Kp > 0 and controller.Ti > 0),
            criterion("the damping", lambda controller: _zeta(controller, numbers[0]), above=1),
            criterion(
                "the largest rise of the level",
                lambda controller: 100 * _peak(controller, *numbers),
                below=h_max,
                unit="cm",
            ),
            criterion(
                "the first change of the outflow",
                lambda controller: float(controller.Kp) / numbers[0] * numbers[1],
                below=r_max,
                unit="m³/min²",
            ),
            draws=lambda controller: calm_trends(controller, A, d, h_max, r_max),
        ),
    )


@calm_level.mistake("The area is upside down: $k'$ is one over the area.")
def _():
    A, K_c = symbols("A K_c", positive=True)
    return {"tau_least": 4 / (A * K_c)}


@calm_level.mistake("Look again at the discriminant of the closed loop's denominator and its leading factor.")
def _():
    A, K_c = symbols("A K_c", positive=True)
    return {"tau_least": A / K_c}


@calm_level.mistake("In the discriminant the product of the outer coefficients counts four times, not twice.")
def _():
    A, K_c = symbols("A K_c", positive=True)
    return {"tau_least": 2 * A / K_c}


@calm_level.mistake("That is upside down: does a larger gain allow a shorter integral time or need a longer one?")
def _():
    A, K_c = symbols("A K_c", positive=True)
    return {"tau_least": K_c / (4 * A)}


@calm_level.mistake("Here a number has been put in for the area. Give the formula with the symbols.")
def _(A):
    return {"tau_least": 4 * A / symbols("K_c", positive=True)}


@calm_level.mistake(
    "With this integral time the damping is one half only: in the middle coefficient $2\\zeta\\tau$ there is a two."
)
def _(A, d, r_max):
    Kp = Rational(98, 100) * r_max * A / d
    return {"controller": PID(Kp, Ti=A / Kp)}


@calm_level.mistake("The level is limited in cm, the area and the flow are in m. How much is the limit in m?")
def _(A, d, h_max):
    Kp = Rational(3, 4) * d / h_max
    return {"controller": PID(Kp, Ti=5 * A / Kp)}


calm_level.hints(
    "Write the loop as the level that follows the inflow: process over one plus loop. What says that a second-order "
    "denominator does not oscillate?",
    "The denominator is $A\\tau_Is^2 + K_c\\tau_Is + K_c$; it does not oscillate if its discriminant is not negative. "
    "The first change of the outflow does not depend on the integral time, and so it limits the gain from above. The "
    "rise of the level limits it from below.",
    "At first the level rises by $\\frac{ {d_n} }{ {A_n} }$ in m/min, inflow over area. The controller lets the "
    "outflow grow $K_c$ times as fast, and that may be {r_max}. Take a gain a little below, then the integral time.",
)


@calm_level.shows
def _(A, d, r_max):
    return {"r_max_n": f"{float(r_max):g}", "A_n": f"{float(A):g}", "d_n": f"{float(d):g}"}


@calm_level.solution
def _(A, d, h_max, r_max):
    r"""With the process $\frac{1}{As}$ and the controller $K_c\left(1 + \frac{1}{\tau_Is}\right)$, the level follows
    the inflow by $\frac{\tau_Is}{A\tau_Is^2 + K_c\tau_Is + K_c}$. The discriminant $K_c^2\tau_I^2 - 4A\tau_IK_c$ must
    not be negative: $\tau_I \ge \frac{4A}{K_c}$. A small gain needs a long integral time, and a level with both small
    oscillates slowly.

    **The gain from above.** At first the level rises by $d/A$ in a minute, and the outflow by $K_c$ times as much. That
    may be {r_max}, so that $K_c \le \frac{ {r_max_n} \cdot {A_n} }{ {d_n} } =$ {most}.

    **The gain from below.** With the least integral time both poles are the same, and the level follows
    $(d/A)\,t\,e^{-t/\tau}$ with $\tau = \tau_I/2 = 2A/K_c$. Its peak, at $t = \tau$, is
    $\frac{2d}{eK_c}$. That may be {h_max}, so that $K_c \ge \frac{2d}{e\,h_{max} } =$ {least}.

    Between the two there is room. A gain of {chosen} with an integral time just above $4A/K_c$, say {Ti}, meets all
    three.
    """
    chosen = Rational(98, 100) * r_max * A / d
    return {
        "most": (r_max * A / d, "m²/min"),
        "least": (float(2 * d / (sympy.E * h_max / 100)), "m²/min"),
        "chosen": (chosen, "m²/min"),
        "Ti": (Rational(41, 10) * A / chosen, "min"),
    }


@calm_level.picture
def _(A, d):
    """A buffer tank whose level controller moves the valve in the outflow."""
    layout = """
        inflow  1     .    .   .        .
        .       tank  LT   LC  .        .
        .       tank  .    .   .        .
        .       2     .    LV  .  outflow"""
    parts = {"tank": diagrams.tank(rf"${float(A):g}\ \mathrm{{m^2}}$", level="h"), "LV": diagrams.control_valve("LV")}
    names = {"inflow": rf"$+{float(d):g}\ \mathrm{{m^3/min}}$"}
    return diagrams.instrumentation_diagram(layout, "inflow 1 tank 2 LV outflow", "tank LT LC LV", parts, names)


def calm_trends(controller, A, d, h_max, r_max):
    """Level and outflow after the step of the inflow, with their limits."""
    process, C = 1 / (A * s), controller.expr
    end = 4 * max(float(controller.Ti) if controller.Ti.is_finite else 0, float(A / controller.Kp))
    times = np.linspace(0, end, 301)
    level = 100 * System(sympy.cancel(d * process / (1 + process * C))).step(times)
    outflow = System(sympy.cancel(d * process * C / (1 + process * C))).step(times)
    steepest = np.where(float(r_max) * times <= 1.1 * float(d), float(r_max) * times, np.nan)
    curves = {"outflow": outflow, "steepest allowed": (steepest, "setpoint")}
    signals = [{"level": (level, "measurement")}, curves]
    labels = ["level [cm]", "outflow [m³/min]"]
    return time_plot(signals, times, xlabel="$t$ [min]", ylabel=labels, low=True).level(h_max, "highest allowed")


# --- 13.7 ---------------------------------------------------------------------------------------------------------

#: The frequencies of the curve, times the dead time.
_FREQUENCIES = np.linspace(0.02, 2.6, 259)


def _sensitivity(x, w=_FREQUENCIES):
    """The size of the sensitivity of a loop x exp(-s)/s at these frequencies."""
    return abs(1 / (1 + float(x) * np.exp(-1j * w) / (1j * w)))


def _largest(x):
    return float(_sensitivity(x, np.linspace(0.8, 2.2, 1401)).max())


def _helps_until(x):
    """The frequency at which the size of the sensitivity becomes one: x = 2 w sin(w)."""
    low, high = 0.0, 1.5
    for _ in range(50):
        middle = (low + high) / 2
        low, high = (middle, high) if 2 * middle * sine(middle) < x else (low, middle)
    return low


def _w_of(period, delay):
    return 2 * np.pi * float(delay) / float(period)


def _is_read_well(x, delay, period):
    w = _w_of(period, delay)
    size = float(_sensitivity(x, np.array([w]))[0])
    Ms = _largest(x)
    away_from_one = 0.35 <= size <= 0.85 or size >= 1.25
    return 0.25 <= w <= 2 and away_from_one and size < 0.85 * Ms and abs(size * Ms - 1) > 0.2


@exercise(
    "13.7",
    title="What the peak of the sensitivity says",
    points=4,
    where=_is_read_well,
    insight="One number, the peak of $|S|$, bounds the gain margin and the phase margin at the same time, because "
    "one over it is the shortest distance of the Nyquist curve from $-1$.",
)
def sensitivity_peak(
    x=choice(0.45, 0.5, 0.55, 0.6, 0.65, 0.7, 0.75, 0.8, reference=0.6),
    delay=between(1, 6, "min", reference=2, step=0.5),
    period=between(4, 80, "min", reference=30, step=2),
    amplitude=between(2, 8, "K", reference=4, step=0.5),
):
    r"""The temperature of a distillation column is controlled. The curve shows the size of the sensitivity function,
    $|S| = \left|\frac{1}{1 + gc}\right|$: by how much a disturbance of each frequency is reduced, or amplified.

    Read the curve with a ruler. How high is its peak $M_s$? Up to which frequency does control help at all? Without
    control a disturbance with a period of {period} lets the temperature oscillate with an amplitude of {amplitude};
    what is the amplitude with control? And which gain margin and which phase margin does this peak guarantee, whatever
    the loop is otherwise?

    (For those who cannot see the picture: `w, S = exercise("13.7").given("w", "S")` are the points of the curve.)
    """
    Ms = _largest(x)
    reduced = float(amplitude) * float(_sensitivity(x, np.array([_w_of(period, delay)]))[0])
    return answers(
        Ms=number(Ms, "", "the peak of the sensitivity", within=0.03),
        helps=number(_helps_until(x) / float(delay), "rad/min", "the frequency up to which control helps", within=0.05),
        amplitude_left=number(reduced, "K", "the amplitude with control", within=0.08),
        gain_margin=number(Ms / (Ms - 1), "", "the guaranteed gain margin", within=0.08),
        phase_margin=number(_guaranteed_phase(Ms), "deg", "the guaranteed phase margin", within=0.05),
    )


def _guaranteed_phase(Ms):
    """The angle of a chord of length 1/Ms of the unit circle, in degrees."""
    return float(np.degrees(2 * np.arcsin(0.5 / Ms)))


@sensitivity_peak.shows
def _(x, delay, period):
    return {
        "w": _FREQUENCIES / float(delay),
        "S": _sensitivity(x),
        "period_n": f"{float(period):g}",
        "w_n": f"{2 * np.pi / float(period):.3g}",
    }


def _peak_at(x, delay):
    """The frequency of the peak."""
    w = np.linspace(0.8, 2.2, 1401)
    return float(w[_sensitivity(x, w).argmax()]) / float(delay)


@sensitivity_peak.mistake("That is the frequency at which the peak is. How high is it?")
def _(x, delay):
    at = _peak_at(x, delay)
    return {"Ms": at} if _apart(at, _largest(x), by=0.1) else {}


@sensitivity_peak.mistake("There control does most harm. Up to which frequency is $|S|$ below one?")
def _(x, delay):
    return {"helps": _peak_at(x, delay)}


@sensitivity_peak.mistake("The axis is in rad/min already. Which frequency is written below the crossing of one?")
def _(x, delay):
    return {"helps": _helps_until(x) / float(delay) / (2 * np.pi)}


@sensitivity_peak.mistake("That is the peak in decibels. The curve has it as a factor.")
def _(x):
    return {"Ms": 20 * float(np.log10(_largest(x)))}


@sensitivity_peak.mistake("That is how far the peak is above one. Its height counts from zero.")
def _(x):
    return {"Ms": _largest(x) - 1}


@sensitivity_peak.mistake("There a disturbance is halved. It is not amplified yet a little further on, either.")
def _(x, delay):
    w = np.linspace(0.02, 1.5, 1481)
    return {"helps": float(w[_sensitivity(x, w) < 0.5][-1]) / float(delay)}


@sensitivity_peak.mistake(
    "That is the reading at one over the period. The axis is in rad/min: how many radians has one period?"
)
def _(x, delay, period, amplitude):
    w = np.array([float(delay / period)])
    return {"amplitude_left": float(amplitude) * float(_sensitivity(x, w)[0])}


@sensitivity_peak.mistake("That is what the worst frequency would make of it. Which frequency has this disturbance?")
def _(x, amplitude):
    return {"amplitude_left": float(amplitude) * _largest(x)}


@sensitivity_peak.mistake("You have divided by $|S|$. With $S$ near zero, does control work well or badly?")
def _(x, delay, period, amplitude):
    return {"amplitude_left": float(amplitude) / _left_of_one(x, delay, period)}


def _left_of_one(x, delay, period):
    """The size of the sensitivity at the frequency of the disturbance."""
    return float(_sensitivity(x, np.array([_w_of(period, delay)]))[0])


@sensitivity_peak.mistake("That is $|S|$ at this frequency. What does it leave of {amplitude}?")
def _(x, delay, period, amplitude):
    size, slow = _left_of_one(x, delay, period), _sensitivity(x, np.array([float(delay / period)]))[0]
    return {"amplitude_left": size} if _apart(size, float(amplitude) * slow, float(amplitude) / size, by=0.16) else {}


@sensitivity_peak.mistake("That is by how much control reduces the amplitude. How much is left?")
def _(x, delay, period, amplitude):
    size = _left_of_one(x, delay, period)
    wrong = float(amplitude) * (1 - size)
    return {"amplitude_left": wrong} if size < 1 and _apart(wrong, float(amplitude) * size, size, by=0.16) else {}


@sensitivity_peak.mistake(
    "That is where the curve may cross the real axis, counted from zero. What gain takes it to $-1$?"
)
def _(x):
    Ms = _largest(x)
    return {"gain_margin": 1 - 1 / Ms} if _apart(1 - 1 / Ms, 1 / Ms, by=0.1) else {}


@sensitivity_peak.mistake(
    "That is the peak itself. If the curve comes as near to $-1$ as $1/M_s$, where does it cross?"
)
def _(x):
    Ms = _largest(x)
    return {"gain_margin": Ms} if _apart(Ms, Ms / (Ms - 1), by=0.1) else {}


@sensitivity_peak.mistake("The chord is $2\\sin(PM/2)$ long: what becomes of its two when it is compared with $1/M_s$?")
def _(x):
    Ms = _largest(x)
    return {"phase_margin": float(np.degrees(2 * np.arcsin(1 / Ms)))}


@sensitivity_peak.mistake("That is by how much the gain may fall for certain. By how much may it grow?")
def _(x):
    return {"gain_margin": _largest(x) / (_largest(x) + 1)}


@sensitivity_peak.mistake(
    "That is the shortest distance from $-1$. If the curve of $L$ crosses the real axis there, at which point is that?"
)
def _(x):
    Ms = _largest(x)
    return {"gain_margin": 1 / Ms} if abs((Ms + 1) / Ms**2 - 1) > 0.1 else {}


@sensitivity_peak.mistake("That is half of the angle: the point $-1$ and the curve are on either side of its bisector.")
def _(x):
    return {"phase_margin": _guaranteed_phase(_largest(x)) / 2}


sensitivity_peak.hints(
    "$S$ multiplies every disturbance at the output. Where is $|S|$ below one, and what does its largest value say "
    "about the distance of $L = gc$ from the point $-1$?",
    "$|1 + L|$ is the distance of the Nyquist curve from $-1$, and it is nowhere smaller than $1/M_s$. A crossing of "
    "the real axis is at $-1/GM$, and a crossing of the unit circle is a chord of length $2\\sin(PM/2)$ away from "
    "$-1$.",
    "So $1 - \\frac{1}{GM} \\ge \\frac{1}{M_s}$ and $2\\sin\\frac{PM}{2} \\ge \\frac{1}{M_s}$. The disturbance has the "
    "frequency $2\\pi/{period_n} = {w_n}$ rad/min: read $|S|$ there.",
)


@sensitivity_peak.solution
def _(x, delay, period, amplitude):
    r"""**The peak** is at {at}, and its height is $M_s =$ {Ms}. It is above one: no controller reduces the
    disturbances of all frequencies.

    **Control helps** where $|S| < 1$. The curve crosses one at {helps}. Faster disturbances are amplified, most of all
    those near the peak, and very fast ones pass unchanged.

    **The disturbance** with a period of {period} has the frequency $2\pi/{period_n} =$ {w_n} rad/min. There the curve
    reads $|S| = {size}$, so that of {amplitude} the amplitude {amplitude_left} is left.

    **Margins.** $1/|S| = |1 + L|$ is the distance of $L(j\omega)$ from $-1$, nowhere below $1/M_s = {distance}$. The
    curve therefore crosses the negative real axis no nearer to $-1$ than that, at $-(1 - {distance})$ or to the right
    of it: the gain margin is at least $\frac{1}{1 - 1/M_s} = \frac{M_s}{M_s - 1} =$ {gain_margin}.

    On the unit circle, two points with the angle $PM$ between them are $2\sin(PM/2)$ apart. So
    $PM \ge 2\arcsin\frac{1}{2M_s} =$ {phase_margin}. The loop may have more of both, but never less.
    """
    Ms, there = _largest(x), np.array([_w_of(period, delay)])
    return {
        "at": (_peak_at(x, delay), "rad/min"),
        "size": float(_sensitivity(x, there)[0]),
        "distance": 1 / Ms,
    }


def _sensitivity_curve(x, delay):
    """The size of the sensitivity against the frequency, with fine lines to read it by."""
    w, high = _FREQUENCIES / float(delay), 0.5 * float(np.ceil(2.2 * _largest(x)))
    axes = {"xlim": (0, float(w[-1])), "ylim": (0, high)}
    plot = plane_plot({"$|S|$": (w, _sensitivity(x))}, r"frequency $\omega$ [rad/min]", "$|S|$", **axes)
    plot.axes.minorticks_on()
    plot.axes.grid(which="minor", linewidth=0.3)
    return plot


@sensitivity_peak.picture
def _(x, delay):
    """The size of the sensitivity function against the frequency: it rises from zero over one to a peak, and falls."""
    return _sensitivity_curve(x, delay)


@sensitivity_peak.solution_picture
def _(x, delay, period):
    """The same curve, with the peak, the end of the range in which control helps, and the disturbance."""
    unit, there = float(delay), _w_of(period, delay)
    plot = _sensitivity_curve(x, delay).points([_peak_at(x, delay)], [_largest(x)], "$M_s$")
    plot.points([_helps_until(x) / unit], [1], "control helps up to here", "s")
    return plot.points([there / unit], _sensitivity(x, np.array([there])), "the disturbance", "^")


# --- 13.8 ---------------------------------------------------------------------------------------------------------

_BEHAVIOURS = ["decays without oscillating", "decays oscillating", "grows without oscillating", "grows oscillating"]


def _eigenvalues(ends, kind, p, q):
    """A complex pair, two that decay, or one that grows and one that decays; exact, that of the last mode first."""
    last = p if ends == "grows" else -p
    return [last + q * sympy.I, last - q * sympy.I] if kind == "oscillating" else [last, -q]


def _state_matrix(ends, kind, p, q, skew, b):
    """A matrix with these eigenvalues; `skew` and `b` distribute them over its entries."""
    one, other = _eigenvalues(ends, kind, p, q)
    middle, product = (one + other) / 2, sympy.expand(one * other)
    return sympy.ImmutableMatrix([[middle + skew, b], [(middle**2 - skew**2 - product) / b, middle - skew]])


def _complex(values):
    return [complex(value) for value in values]


@exercise(
    "13.8",
    title="Modes of a reactor",
    points=3,
    where=lambda ends, kind, p, q, skew, b: _state_matrix(ends, kind, p, q, skew, b)[1, 0] != 0,
    insight="The eigenvalue with the largest real part has the last word: its sign says whether the plant comes back, "
    "its size how long that takes.",
)
def modes(
    ends=choice("decays", "grows", reference="grows"),
    kind=choice("without oscillating", "oscillating"),
    p=between(0.1, 0.5, step=0.1, reference=0.2),
    q=between(0.8, 2.4, step=0.1, reference=1.5),
    skew=choice(0.3, -0.3, 0.5, -0.5, 0.7, -0.7, reference=0.5),
    b=choice(0.25, 0.5, 1, -0.25, -0.5, -1, reference=-0.5),
):
    r"""Near its operating point, a stirred reactor has two states: $x_1$, the deviation of its temperature, and $x_2$,
    that of its concentration, both in percent. With the time in minutes and all inputs at rest,

    $\frac{dx}{dt} = Ax \quad\text{with}\quad A =$ {A}

    Find the eigenvalues of $A$. A small disturbance has moved both states a little; then the reactor is left alone.
    What do the states do in the end? One mode (or one pair) is left when all others have faded beside it: what is its
    time constant, in which it changes by the factor $e$?
    """
    return answers(
        eigenvalues=poles(_complex(_eigenvalues(ends, kind, p, q)), "1/min", "the eigenvalues"),
        behaviour=word(f"{ends} {kind}", _BEHAVIOURS, "what the states do in the end"),
        time_constant=number(1 / p, "min", "the time constant of the mode that is left"),
    )


@modes.shows
def _(ends, kind, p, q, skew, b):
    A = _state_matrix(ends, kind, p, q, skew, b)
    trace, det = A.trace(), A.det()
    return {"A": A, "polynomial": rf"\lambda^2 {_term(-trace)}\lambda {_term(det, last=True)}"}


def _term(value, last=False):
    """A term of a sum with its sign; a factor of one before something is not written."""
    sign = "-" if value < 0 else "+"
    return f"{sign} {abs(float(value)):.4g}" if last else f"{sign} {_factor(abs(value))}"


@modes.mistake("These are the entries on the diagonal. They are the eigenvalues only where one of the others is zero.")
def _(ends, kind, p, q, skew, b):
    A = _state_matrix(ends, kind, p, q, skew, b)
    return {"eigenvalues": _complex([A[0, 0], A[1, 1]])}


@modes.mistake("Look at the determinant again: the product of the other two entries is subtracted.")
def _(ends, kind, p, q, skew, b):
    A = _state_matrix(ends, kind, p, q, skew, b)
    return {"eigenvalues": _roots(A.trace(), A[0, 0] * A[1, 1] + A[0, 1] * A[1, 0])}


@modes.mistake(
    "In $\\det(\\lambda I - A)$ the trace has a minus sign: $\\lambda^2 - (a_{11} + a_{22})\\lambda + \\det A$."
)
def _(ends, kind, p, q):
    return {"eigenvalues": [-value for value in _complex(_eigenvalues(ends, kind, p, q))]}


@modes.mistake("The square root is of the whole discriminant, and the formula divides by two. Which half is missing?")
def _(ends, kind, p, q):
    return {"eigenvalues": [2 * value for value in _complex(_eigenvalues(ends, kind, p, q))]}


@modes.mistake("The root of the discriminant is divided by two as well. Look at the imaginary part, or the distance.")
def _(ends, kind, p, q, skew):
    one, other = _eigenvalues(ends, kind, p, q)
    middle, is_diagonal = (one + other) / 2, abs(skew) == abs(one - other)
    return {} if is_diagonal else {"eigenvalues": _complex([2 * one - middle, 2 * other - middle])}


@modes.mistake("The trace is divided by two as well. Look at the real parts: what is half of their sum?")
def _(ends, kind, p, q):
    one, other = _eigenvalues(ends, kind, p, q)
    middle = (one + other) / 2
    return {"eigenvalues": _complex([one + middle, other + middle])}


@modes.mistake("Look at the sign of the discriminant: what is the root of a negative number?")
def _(ends, kind, p, q):
    last = p if ends == "grows" else -p
    if kind != "oscillating":
        return {}
    wrong, others = 1 / (q + last), (1 / p, 1 / q, 1 / sympy.sqrt(p**2 + q**2), 1 / (2 * p), log(2) / p)
    return {"eigenvalues": _complex([last + q, last - q])} | (
        {"time_constant": wrong} if _apart(wrong, *others) else {}
    )


@modes.mistake("The determinant has a plus sign in $\\lambda^2 - (a_{11} + a_{22})\\lambda + \\det A$.")
def _(ends, kind, p, q, skew, b):
    A = _state_matrix(ends, kind, p, q, skew, b)
    added = A[0, 0] * A[1, 1] + A[0, 1] * A[1, 0]
    is_another = _apart(-A.det(), added, by=0.1) and (kind != "oscillating" or 5 * p > q)
    return {"eigenvalues": _roots(A.trace(), -A.det())} if is_another else {}


def _roots(trace, product):
    root = sympy.sqrt(trace**2 - 4 * product)
    return _complex([(trace + root) / 2, (trace - root) / 2])


@modes.mistake("Growing or decaying is decided by real parts. Which sign has the largest of them?")
def _(ends, kind):
    return {"behaviour": f"{'decays' if ends == 'grows' else 'grows'} {kind}"}


@modes.mistake("Whether it oscillates is decided by imaginary parts. Is there one that is not zero?")
def _(ends, kind):
    return {"behaviour": f"{ends} {'oscillating' if kind.startswith('without') else 'without oscillating'}"}


@modes.mistake(
    "Both parts of this do not fit. What does the real part of an eigenvalue say, and what the imaginary part?"
)
def _(ends, kind):
    other = "oscillating" if kind.startswith("without") else "without oscillating"
    return {"behaviour": f"{'decays' if ends == 'grows' else 'grows'} {other}"}


@modes.mistake("That mode has faded long before the other one. Which of the two is left in the end?")
def _(kind, q):
    return {"time_constant": 1 / q} if kind.startswith("without") else {}


@modes.mistake("That is one over the imaginary part, which says how fast it oscillates and not how fast it changes.")
def _(kind, q):
    return {"time_constant": 1 / q} if kind == "oscillating" else {}


@modes.mistake("That is one over the size of the eigenvalue. Only its real part decides how fast the mode changes.")
def _(kind, p, q):
    return {"time_constant": 1 / sympy.sqrt(p**2 + q**2)} if kind == "oscillating" and 4 * p > q else {}


@modes.mistake("That is the period of the oscillation. In which time does its amplitude change by the factor $e$?")
def _(kind, p, q):
    return {"time_constant": 2 * sympy.pi / q} if kind == "oscillating" and _apart(2 * sympy.pi / q, 1 / p) else {}


@modes.mistake("That is the time in which it changes by the factor two.")
def _(p):
    return {"time_constant": log(2) / p}


@modes.mistake("That is one over the trace, the sum of both eigenvalues. Which real part has one of them?")
def _(ends, kind, p, q):
    one, other = _eigenvalues(ends, kind, p, q)
    wrong = 1 / abs(sympy.expand(one + other))
    return {"time_constant": wrong} if _apart(wrong, 1 / p, 1 / q) else {}


modes.hints(
    "A mode is a solution $v\\,e^{\\lambda t}$. Put it into $\\dot x = Ax$: which numbers $\\lambda$ are possible?",
    "They are the roots of $\\det(\\lambda I - A) = \\lambda^2 - (a_{11} + a_{22})\\lambda + a_{11}a_{22} - "
    "a_{12}a_{21}$. $e^{\\lambda t}$ grows or decays with the real part and oscillates with the imaginary part.",
    "With these numbers it is ${polynomial} = 0$.",
)


def _enclosed(value):
    """A number within a product or a power: a negative one in brackets."""
    return f"({float(value):.4g})" if value < 0 else f"{float(value):.4g}"


@modes.solution
def _(ends, kind, p, q, skew, b):
    r"""The characteristic polynomial is ${polynomial}$, with minus the trace and the determinant of $A$. Its
    discriminant is ${trace}^2 - 4 \cdot {det} = {discriminant}$: {because}

    The eigenvalues are ${first}$ and ${second}$ per minute. So there are the modes $e^{ {first_t} }$ and
    $e^{ {second_t} }$, and every motion of the reactor is a sum of them.

    {story} In one word, the disturbance {behaviour}. The time constant of that mode is one over the size of the real
    part, $1/{p} =$ {time_constant}.
    """
    A = _state_matrix(ends, kind, p, q, skew, b)
    stable, turning = ends == "decays", kind == "oscillating"
    one, other = ([f"{float(x):g}" for x in _eigenvalues(ends, kind, p, q)] if not turning
                  else [f"{-float(p) if stable else float(p):g} {sign} {float(q):g}\\,j" for sign in "+-"])  # fmt: skip
    story = {
        (True, True): "The real part of the pair is negative: the states come back, oscillating.",
        (False, True): "The real part of the pair is positive: each oscillation is larger than the one before.",
        (True, False): "Both are negative. The larger one fades more slowly, and is left in the end.",
        (False, False): "The negative one fades, and what is left grows without end, although the sum of the "
        "eigenvalues, the trace, is negative: one positive eigenvalue is enough.",
    }[stable, turning]
    return {
        "trace": _enclosed(A.trace()),
        "det": _enclosed(A.det()),
        "discriminant": A.trace() ** 2 - 4 * A.det(),
        "because": "negative, a complex pair." if turning else "positive, two real eigenvalues.",
        "first": one,
        "second": other,
        "first_t": f"({one})t" if turning else f"{one}t",
        "second_t": f"({other})t" if turning else f"{other}t",
        "story": story,
        "p": f"{float(p):g}",
    }


@modes.solution_picture
def _(ends, kind, p, q, skew, b):
    """Both states after a small disturbance of the first one."""
    A = np.array(_state_matrix(ends, kind, p, q, skew, b), dtype=float)
    times = np.linspace(0, 2.5 / float(p), 301)
    values, vectors = np.linalg.eig(A)
    shares = np.linalg.solve(vectors, np.array([1, 0]))
    x_1, x_2 = (vectors @ (shares[:, None] * np.exp(np.outer(values, times)))).real
    return time_plot({"$x_1$": x_1, "$x_2$": x_2}, times, xlabel="$t$ [min]", ylabel="deviation [%]", low=True)
