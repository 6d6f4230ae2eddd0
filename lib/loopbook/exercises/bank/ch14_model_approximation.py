"""Exercises of chapter 14, model approximation."""

from sympy import Integer, exp, pi, sqrt

from loopbook.exercises.authoring import (
    answers,
    between,
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
from loopbook.pid import PID


@exercise(
    "14.1",
    title="A column that goes the wrong way first",
    points=2,
    where=lambda tau_2, tau_3, T_inv, theta_0: tau_3 < tau_2 and len({tau_3 / 2, theta_0, T_inv, 2 * T_inv}) == 4,
)
def column(
    tau_1=between(15, 40, "min", step=1, reference=25),
    tau_2=between(4, 12, "min", step=1, reference=6),
    tau_3=between(1, 4, "min", step=0.5, reference=3),
    T_inv=between(0.5, 2.5, "min", step=0.5, reference=2),
    theta_0=between(0.5, 3, "min", step=0.5, reference=1),
):
    """When the steam to a distillation column is increased, the level in its sump swells before it falls, and so the
    composition at the bottom goes the wrong way first. (Times in minutes.) An analyser adds a dead time:

    {process}

    Find the first-order model with dead time that the half rule gives. Its gain is that of the process.
    """
    return answers(
        tau_1=number(tau_1 + tau_2 / 2, "min", "the lag of the model"),
        theta=number(theta_0 + T_inv + tau_2 / 2 + tau_3, "min", "the effective delay"),
    )


@column.shows
def _(tau_1, tau_2, tau_3, T_inv, theta_0):
    lags = (tau_1 * s + 1) * (tau_2 * s + 1) * (tau_3 * s + 1)
    return {"process": _equation("g", (1 - T_inv * s) * exp(-theta_0 * s) / lags)}


def _equation(name, H):
    from sympy import Eq, Function

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


@exercise(
    "14.2",
    title="A gas holder, twice simplified",
    points=3,
    where=lambda tau_2, tau_3: tau_3 < tau_2 <= 4 * tau_3,
)
def gas_holder(
    k=between(0.2, 2, "%/min", step=0.1, reference=0.4),
    tau_2=between(2, 8, "min", step=1, reference=4),
    tau_3=between(1, 4, "min", step=0.5, reference=1),
):
    r"""The level of a gas holder follows the valve of its inlet through an integrator and two lags, the valve's and
    the transmitter's. Level and valve opening are in percent, and times in minutes:

    {process}

    The integrator counts as an infinite lag. Find by the half rule the model of first order, $g_1$, and that of second
    order, $g_2$. Then let the valve open by one percent. The level rises as a ramp in the end: by how much does the
    ramp of $g_1$ lie above that of $g$?
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
    "In a model of first order the integrator is all that is kept. Half of the lag is lost: it is negligible "
    "beside the integrator."
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
    where=lambda T_0, tau_0, theta: _far_apart(T_0, tau_0, theta, 5 * theta),
)
def zero_beside_a_lag(
    T_0=between(1, 60, "s", reference=6),
    tau_0=between(1, 60, "s", reference=40),
    theta=between(0.5, 8, "s", step=0.5, reference=4),
):
    r"""A damper acts on the temperature in an air duct in two ways, one of them quick and one of them slow. Together
    they make a zero in the left half-plane, with the time constant $T_0$ = {T_0}, beside a lag $\tau_0$ = {tau_0}.
    (Times in seconds.)

    {part}

    In the loop around it the effective dead time is $\theta$ = {theta}, and the loop is meant to be as fast as
    that. By which of the rules T1, T1a, T1b, T2 and T3 is the fraction replaced, and by what?
    """
    rule, instead = _rule(T_0, tau_0, theta)
    return answers(
        rule=word(rule, ["T1", "T1a", "T1b", "T2", "T3"], "the rule"),
        instead=transfer_function(instead, "the replacement"),
    )


@zero_beside_a_lag.shows
def _(T_0, tau_0):
    return {"part": (T_0 * s + 1) / (tau_0 * s + 1)}


@zero_beside_a_lag.mistake("It is true that the zero goes with a longer lag. Now compare $T_0$ with five dead times.")
def _(T_0, tau_0, theta):
    other = {"T2": "T3", "T3": "T2"}.get(_rule(T_0, tau_0, theta)[0])
    return {"rule": other} if other else {}


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


@exercise(
    "14.4",
    title="The price of a fraction",
    points=4,
    where=lambda T, theta: theta <= T <= 8 * theta,
)
def price_of_a_fraction(
    T=between(6, 40, "s", step=1, reference=20),
    theta=between(2, 12, "s", step=0.5, reference=4),
):
    r"""A program without dead time should simulate the P control of a process with the gain 1, a lag of {T} and a dead
    time $\theta$ = {theta}. So the dead time is replaced by its Padé approximation of first order. (Times in seconds.)

    Find the transfer function that the program knows, and the ultimate gain and the period (of the oscillation there)
    that one would find with it. By how many percent is this ultimate gain larger than the one of the process with its
    exact dead time?
    """
    K_u = 1 + 2 * T / theta
    omega = _phase_crossing(float(T), float(theta))
    exact = (1 + (float(T) * omega) ** 2) ** 0.5
    return answers(
        g=transfer_function((1 - theta / 2 * s) / ((1 + theta / 2 * s) * (T * s + 1)), "the process in the program"),
        Ku=number(K_u, "", "the ultimate gain in the program"),
        Pu=number(_period(T, theta, K_u), "s", "the period in the program"),
        too_large=number(100 * (float(K_u) / exact - 1), "%", "the error of the ultimate gain", within=0.03),
    )


def _period(T, theta, K_u):
    """The period at the limit: theta/2 T s^2 + K_u + 1 = 0, as the term in s vanishes."""
    return 2 * pi * sqrt(theta * T / 2 / (K_u + 1))


def _phase_crossing(T, theta):
    """The frequency in rad/s at which lag and dead time together turn by 180 degrees."""
    import math

    from scipy.optimize import brentq

    return brentq(lambda w: math.atan(w * T) + w * theta - math.pi, math.pi / 2 / theta, math.pi / theta)


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
    omega = _phase_crossing(float(T), float(theta))
    return {"Ku": (1 + (float(T) * omega) ** 2) ** 0.5, "Pu": 2 * float(pi) / omega}


@price_of_a_fraction.mistake("That is the frequency in rad/s. How long does one oscillation take?")
def _(T, theta):
    return {"Pu": 2 * pi / _period(T, theta, 1 + 2 * T / theta)}


@price_of_a_fraction.mistake("That is the percentage by which the exact gain is smaller. Take the exact gain as 100 %.")
def _(T, theta):
    omega = _phase_crossing(float(T), float(theta))
    exact = (1 + (float(T) * omega) ** 2) ** 0.5
    return {"too_large": 100 * (1 - exact / float(1 + 2 * T / theta))}


@exercise(
    "14.5",
    title="Before the dead time is over",
    points=4,
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
    from math import exp, log

    K, tau, a = float(K), float(tau), float(theta) / 2
    moment = log(2 * tau / (tau + a)) * a * tau / (tau - a)
    return moment, K * (1 + (2 * a * exp(-moment / a) - (tau + a) * exp(-moment / tau)) / (tau - a))


@before_the_dead_time.mistake(
    "Half of the dead time is above the fraction bar and half below; here it is all of it, twice."
)
def _(K, tau, theta):
    if theta != tau:
        return {"y": _response(K, tau, 2 * theta)}


@before_the_dead_time.mistake(
    "That is the response with the exact dead time, which is not the question. The response with the fraction "
    "begins immediately."
)
def _(K, tau, theta):
    from sympy import Heaviside

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


@exercise(
    "14.6",
    title="A controller for the whole process",
    points=5,
    where=lambda T_1, T_2, T_3: T_3 < T_2 and 2 * T_2 <= T_1,
)
def whole_process(
    k=between(0.5, 3, "", step=0.5, reference=2),
    T_1=between(15, 40, "s", step=1, reference=24),
    T_2=between(4, 12, "s", step=1, reference=8),
    T_3=between(1, 4, "s", step=0.5, reference=3),
    theta=between(1, 3, "s", step=0.5, reference=1),
):
    r"""A mill, its classifier and the sensor behind it have been measured one by one. (Times in seconds; control
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
        )
    )


def _whole(k, T_1, T_2, T_3, theta):
    return k * exp(-theta * s) / ((T_1 * s + 1) * (T_2 * s + 1) * (T_3 * s + 1))


def _by_half_rule(k, T_1, T_2, T_3, theta):
    tau, delay = T_1 + T_2 / 2, theta + T_2 / 2 + T_3
    return PID(tau / (2 * k * delay), min(tau, 8 * delay))


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
