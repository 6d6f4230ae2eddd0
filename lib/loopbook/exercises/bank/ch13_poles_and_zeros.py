"""Exercises of chapter 13, poles and zeros."""

from math import atan2, atanh, inf, sinh, sqrt
from math import exp as exponential
from math import sin as sine

import sympy
from sympy import Rational, exp, log, symbols

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
from loopbook.pid import PID

_SHAPES = ["inverse response", "overshoot", "neither"]


@exercise(
    "13.1",
    title="A response before it is drawn",
    points=2,
    where=lambda tau_1, tau_2, T: tau_1 > tau_2 and T not in (tau_1, tau_2),
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
    return "inverse response" if T < 0 else "overshoot" if T > slowest else "neither"


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


def _damping(overshoot):
    """The damping that belongs to an overshoot, a share of the step."""
    size = -log(overshoot)
    return size / sympy.sqrt(sympy.pi**2 + size**2)


def _real_part(percent, P):
    """The real part of the poles, and the time constant."""
    zeta = float(_damping(percent / 100))
    tau = float(P) * sqrt(1 - zeta**2) / (2 * float(sympy.pi))
    return -zeta / tau, tau


@exercise("13.2", title="A pressure loop oscillates", points=3, where=lambda before, after: after >= before + 1)
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
    "That is $P/2\\pi$, which is right for small damping only. Your loop oscillates a little slower than $1/\\tau$."
)
def _(P):
    return {"tau": P / (2 * sympy.pi)}


@swinging_loop.mistake("The imaginary part is the frequency of the oscillation in rad/s. You know its period.")
def _(percent, P):
    real, tau = _real_part(percent, P)
    return {"poles": [complex(real, 1 / tau), complex(real, -1 / tau)]}


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
    return {"second_peak": (percent / 100) ** 2} if abs(percent * (after - before) - 100) > 5 else {}


@swinging_loop.mistake("That is the pressure itself at the second peak. How far is it above the setpoint?")
def _(before, after, percent):
    return {"second_peak": after + (after - before) * (percent / 100) ** 3}


@exercise(
    "13.3",
    title="The cold feed of a hot reactor",
    points=3,
    where=lambda k, K, tau_1, tau_2: 5 * K <= 4 * k and 10 * K * tau_1 >= 12 * k * tau_2 and tau_1 >= 3 * tau_2,
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


@cold_feed.mistake("With this gain the temperature comes back to where it was: that is about the end of the response.")
def _(k):
    return {"K_limit": k}


@cold_feed.mistake("Compare how steeply the two effects begin: each slope is a gain over a lag.")
def _(k, tau_1, tau_2):
    return {"K_limit": k * tau_1 / tau_2}


@exercise(
    "13.4",
    title="How much gain, how much damping?",
    points=4,
    where=lambda k, tau_1, tau_2: tau_1 >= 2 * tau_2 and k != 1,
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
    product = tau_1 * tau_2
    square = (tau_1 + tau_2) ** 2 / (4 * Rational(zeta) ** 2 * product)  # 1 + K_c*k
    return answers(
        damping=expression(_damping_in_symbols(1), "the damping in symbols"),
        K_c=number((square - 1) / k, "%/K", "the gain of the controller"),
        offset=number(100 / square, "%", "the offset"),
        tau=number(sympy.sqrt(product / square), "s", "the time constant of the closed loop"),
    )


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
    return {"K_c": (tau_1 + tau_2) ** 2 / (4 * Rational(zeta) ** 2 * tau_1 * tau_2) - 1}


@gain_and_damping.mistake("That is the share that is reached. The offset is what is missing.")
def _(tau_1, tau_2, zeta):
    left = 4 * Rational(zeta) ** 2 * tau_1 * tau_2 / (tau_1 + tau_2) ** 2
    return {"offset": 100 * (1 - left)} if abs(1 / left - 2) > 0.05 else {}


@gain_and_damping.mistake("That is one over the loop gain. At rest the error is one over something else.")
def _(tau_1, tau_2, zeta):
    square = (tau_1 + tau_2) ** 2 / (4 * Rational(zeta) ** 2 * tau_1 * tau_2)
    return {"offset": 100 / (square - 1)}


@gain_and_damping.mistake("That is the coefficient of $s^2$. Which power of the time constant is it?")
def _(tau_1, tau_2, zeta):
    wrong = 4 * Rational(zeta) ** 2 * (tau_1 * tau_2) ** 2 / (tau_1 + tau_2) ** 2
    return {"tau": wrong} if abs(wrong - 1) > Rational(1, 10) else {}


@gain_and_damping.mistake("That is the time constant of the process without control. The loop makes it smaller.")
def _(tau_1, tau_2):
    return {"tau": sympy.sqrt(tau_1 * tau_2)}


@exercise(
    "13.5",
    title="The level that falls when water comes in",
    points=4,
    where=lambda K, rate, tau: 1.4 <= K / (rate * tau) <= 8,
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
