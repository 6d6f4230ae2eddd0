"""Exercises of chapter 8, feedforward control."""

import itertools
import math

from sympy import Symbol, exp, symbols

from loopbook.exercises.authoring import (
    answers,
    between,
    criterion,
    design,
    exercise,
    expression,
    number,
    transfer_function,
    word,
)
from loopbook.expressions import s


def _hot_flows(T_SP, T_c, T_h, before, more):
    """The hot flow after the rise, and what three mistakes make of it."""
    right = (before + more) * (T_SP - T_c) / (T_h - T_SP)
    too_far_down = (before + more) * (T_SP - T_c) / (T_h - T_c)
    upside_down = (before + more) * (T_h - T_SP) / (T_SP - T_c)
    return right, too_far_down, upside_down, more * (T_SP - T_c) / (T_h - T_SP)


def _apart(values):
    """Whether no two of the values can be taken for one another."""
    return all(abs(x - y) > 0.03 * abs(x) for x, y in itertools.permutations(values, 2))


@exercise(
    "8.1",
    title="Wash water for the dairy",
    points=2,
    where=lambda T_SP, T_c, T_h, before, more: _apart(_hot_flows(T_SP, T_c, T_h, before, more)),
)
def wash_water(
    T_SP=between(40, 60, "°C", reference=48, step=2),
    T_c=between(6, 16, "°C", reference=8, step=1),
    T_h=between(70, 90, "°C", reference=72, step=2),
    before=between(2, 4, "kg/s", reference=3, step=0.2),
    more=between(0.4, 1.6, "kg/s", reference=0.9, step=0.1),
):
    """A dairy mixes wash water of {T_SP} from cold water of {T_c} and hot water of {T_h}. The cold flow $w_c$ [kg/s]
    is what another part of the plant leaves over: it is measured, but cannot be chosen. The hot flow $w_h$ [kg/s] is
    controlled. Both mix at once, and a kilogram of either holds the same heat for each kelvin.

    Find the feedforward from a heat balance: $w_h$ as a formula in $w_c$, in the setpoint $T_{{SP}}$ and in the
    temperatures $T_c$ and $T_h$ (write `w_c`, `T_SP`, `T_c`, `T_h`). The cold flow has been {before}, and rises by
    {more}. Which hot flow does it need now? And how warm is the wash water if the hot flow stays as it was?
    """
    hot = before * (T_SP - T_c) / (T_h - T_SP)
    cold = before + more
    return answers(
        w_h=expression(_hot_flow(), "the feedforward as a formula"),
        w_new=number(_hot_flows(T_SP, T_c, T_h, before, more)[0], "kg/s", "the new hot flow"),
        T_without=number((hot * T_h + cold * T_c) / (hot + cold), "°C", "the temperature without feedforward"),
    )


def _hot_flow():
    w_c, T_SP, T_c, T_h = symbols("w_c T_SP T_c T_h")
    return w_c * (T_SP - T_c) / (T_h - T_SP)


@wash_water.mistake("The hot water has to cool down to the setpoint only, not to the temperature of the cold water.")
def _(T_SP, T_c, T_h, before, more):
    w_c, setpoint, cold, hot = symbols("w_c T_SP T_c T_h")
    return {
        "w_h": w_c * (setpoint - cold) / (hot - cold),
        "w_new": _hot_flows(T_SP, T_c, T_h, before, more)[1],
    }


@wash_water.mistake("This ratio is upside down. Test it: the warmer the hot water, the less of it is needed.")
def _(T_SP, T_c, T_h, before, more):
    w_c, setpoint, cold, hot = symbols("w_c T_SP T_c T_h")
    return {
        "w_h": w_c * (hot - setpoint) / (setpoint - cold),
        "w_new": _hot_flows(T_SP, T_c, T_h, before, more)[2],
    }


@wash_water.mistake("Here numbers have been put in. Give the formula with all its symbols.")
def _(T_SP, T_c, T_h):
    return {"w_h": Symbol("w_c") * (T_SP - T_c) / (T_h - T_SP)}


@wash_water.mistake("This is the setpoint. But the cold flow has changed, and nothing has compensated for it.")
def _(T_SP):
    return {"T_without": T_SP}


@wash_water.mistake("This is how much more hot water is needed. How large is the whole hot flow?")
def _(T_SP, T_c, T_h, before, more):
    return {"w_new": _hot_flows(T_SP, T_c, T_h, before, more)[3]}


@wash_water.mistake("The temperature of a mixture is the mean of the two only if the flows are equal.")
def _(T_SP, T_c, T_h, before, more):
    hot = before * (T_SP - T_c) / (T_h - T_SP)
    mixed = (hot * T_h + (before + more) * T_c) / (hot + before + more)
    return {"T_without": (T_h + T_c) / 2} if abs(mixed - (T_h + T_c) / 2) > 2 else {}


@exercise(
    "8.2", title="A trolley against the wind", points=3, where=lambda m, v, rise, F_w: abs(m * v / rise - 2 * F_w) >= 50
)
def trolley(
    m=between(500, 2000, "kg", reference=1200, step=100),
    D=between(40, 120, "N s/m", reference=80, step=10),
    v=between(2, 6, "m/s", reference=4, step=0.5),
    rise=between(4, 12, "s", reference=8, step=1),
    F_w=between(100, 600, "N", reference=200, step=50),
):
    """The trolley of a container crane has the mass $m$ [kg] and runs with the speed $v$ [m/s]. The motor pulls it with
    the force $F$ [N], which is the control signal. The friction is $D v$ [N], and head wind pushes it back with the
    force $F_w$ [N], which follows from a wind meter:

    $$m \\frac{{dv}}{{dt}} = F - D v - F_w$$

    Find the feedforward $F_f$ from setpoint and wind, as a formula in $m$, $D$, $F_w$, the setpoint $v_{{SP}}$ and its
    slope $a_{{SP}} = dv_{{SP}}/dt$ (write `m`, `D`, `F_w`, `v_SP`, `a_SP`).

    Now let $m$ = {m}, $D$ = {D} and $F_w$ = {F_w}. The setpoint rises evenly from zero to {v} within {rise}, and stays
    there. Which force does the feedforward ask for at the very end of the rise, and which one after it?
    """
    return answers(
        F_f=expression(_force(), "the feedforward as a formula"),
        F_rise=number(m * v / rise + D * v + F_w, "N", "the force at the end of the rise"),
        F_after=number(D * v + F_w, "N", "the force after the rise"),
    )


def _force(inertia=1, friction=1, wind=1):
    m, D, F_w, v_SP, a_SP = symbols("m D F_w v_SP a_SP")
    return inertia * m * a_SP + friction * D * v_SP + wind * F_w


@trolley.mistake(
    "The wind pushes the trolley back, so the motor needs more force and not less. Look at the sign of $F_w$."
)
def _(m, D, v, rise, F_w):
    return {"F_f": _force(wind=-1), "F_rise": m * v / rise + D * v - F_w, "F_after": D * v - F_w}


@trolley.mistake("At a constant speed this would be right. What does it take to become faster?")
def _(D, v, F_w):
    return {"F_f": _force(inertia=0), "F_rise": D * v + F_w}


@trolley.mistake("The friction is missing: what holds the trolley back even at a constant speed and without wind?")
def _():
    return {"F_f": _force(friction=0)}


@trolley.mistake("This is the feedforward from the setpoint alone. The disturbance is measured, so use it as well.")
def _():
    return {"F_f": _force(wind=0)}


@trolley.mistake("Here numbers have been put in. Give the formula with all its symbols.")
def _(m, D, F_w):
    return {"F_f": m * Symbol("a_SP") + D * Symbol("v_SP") + F_w}


@trolley.mistake("After the rise the setpoint is constant. What is its slope then?")
def _(m, D, v, rise, F_w):
    return {"F_after": m * v / rise + D * v + F_w}


@exercise(
    "8.3",
    title="Feedforward from two transfer functions",
    points=4,
    where=lambda K, T, tau, K_d, T_d, tau_d, rise: (
        tau_d > tau and abs(T - T_d) >= 0.2 * T and rise * K_d <= 20 * K and rise * K_d * T <= 30 * K * T_d
    ),
)
def pasteuriser(
    K=between(0.4, 2, "K/%", reference=0.8, step=0.1),
    T=between(20, 60, "s", reference=40, step=5),
    tau=between(2, 10, "s", reference=4, step=1),
    K_d=between(4, 20, "K/(kg/s)", reference=12, step=1),
    T_d=between(10, 60, "s", reference=25, step=5),
    tau_d=between(4, 20, "s", reference=10, step=1),
    rise=between(0.2, 0.9, "kg/s", reference=0.5, step=0.1),
):
    """Milk is heated in a plate heat exchanger. Experiments gave two transfer functions. From the control signal of
    the steam valve [%] to the temperature [K]: a gain of {K}, a lag of {T} and a dead time of {tau}. From the milk
    flow [kg/s] to the temperature: a gain of minus {K_d}, a lag of {T_d} and a dead time of {tau_d}, so that more milk
    makes it colder. Changes are counted from a steady state.

    Which transfer function $F_{{fd}}(s)$ from milk flow to control signal is the ideal feedforward? The milk flow rises
    by {rise} in a step. By how much does the feedforward raise the control signal in the end? And by how much at the
    first moment when it acts?
    """
    return answers(
        F_fd=transfer_function(K_d * (T * s + 1) / (K * (T_d * s + 1)) * exp(-(tau_d - tau) * s), "the feedforward"),
        u_end=number(rise * K_d / K, "%", "the change of the control signal in the end"),
        u_first=number(rise * K_d * T / (K * T_d), "%", "the first change of the control signal"),
    )


@pasteuriser.mistake("This feedforward is right only in the end. On the way there, the two lags differ.")
def _(K, K_d, tau, tau_d, rise):
    return {"F_fd": K_d / K * exp(-(tau_d - tau) * s), "u_first": rise * K_d / K}


@pasteuriser.mistake(
    "These are the gains alone: right in the end, but on the way there the lags and the dead times count."
)
def _(K, K_d):
    return {"F_fd": K_d / K}


@pasteuriser.mistake(
    "The two lags are interchanged. The lag of the transfer function in the denominator moves to the numerator."
)
def _(K, T, tau, K_d, T_d, tau_d, rise):
    F_fd = K_d * (T_d * s + 1) / (K * (T * s + 1)) * exp(-(tau_d - tau) * s)
    return {"F_fd": F_fd, "u_first": rise * K_d * T_d / (K * T)}


@pasteuriser.mistake(
    "The dead times do not add up. The milk flow needs its time to show; how long may the feedforward wait?"
)
def _(K, T, tau, K_d, T_d, tau_d):
    return {"F_fd": K_d * (T * s + 1) / (K * (T_d * s + 1)) * exp(-(tau_d + tau) * s)}


@pasteuriser.mistake("The feedforward would come too late: the control signal needs a dead time of its own.")
def _(K, T, K_d, T_d, tau_d):
    return {"F_fd": K_d * (T * s + 1) / (K * (T_d * s + 1)) * exp(-tau_d * s)}


@pasteuriser.mistake("This is for a rise of 1 kg/s. How large was the step?")
def _(K, T, K_d, T_d):
    return {"u_end": K_d / K, "u_first": K_d * T / (K * T_d)}


def _x(theta, P):
    """The phase that a measurement of that age is behind in a swing of that period, in rad."""
    return 2 * math.pi * float(theta / P)


@exercise(
    "8.4",
    title="A ship in gusts",
    points=4,
    where=lambda k, theta, P: k != 1 and 0.7 <= _x(theta, P) <= 2.8 and abs(P - 6 * theta) >= 0.3 * theta,
)
def ship(
    e_0=between(2, 8, "m", reference=5, step=0.5),
    k=between(0.6, 1.4, reference=0.8, step=0.1),
    theta=between(4, 12, "s", reference=6, step=1),
    P=between(15, 90, "s", reference=45, step=5),
):
    """Thrusters hold a ship in its place, and a feedforward from the wind helps them. In a swinging wind the position
    swings by {e_0} without the feedforward, under feedback alone.

    First let the feedforward act at once, but with $k$ = {k} times the force that the wind calls for. How far does the
    position swing? Then let the force be right, but {theta} late: so old is the measured wind when the computer gets
    it. The wind swings with a period of {P}. How far does the position swing now, and is that smaller or larger than
    without feedforward? Above which period does a feedforward that is so late always help?
    """
    return answers(
        e_wrong=number(abs(1 - k) * e_0, "m", "the swing with the wrong force"),
        e_late=number(2 * math.sin(_x(theta, P) / 2) * e_0, "m", "the swing with the late force"),
        compared=word(_compared(theta, P), ["smaller", "larger"], "the swing with the late force, compared"),
        P_min=number(6 * theta, "s", "the period above which it helps"),
    )


def _compared(theta, P):
    return "smaller" if 6 * theta < P else "larger"


@ship.mistake("That is what the feedforward removes. How much is left? (An amplitude has no sign.)")
def _(e_0, k):
    return {"e_wrong": k * e_0}


@ship.mistake("This is the factor by which the feedforward changes the amplitude. How many metres is that?")
def _(k, theta, P):
    return {"e_wrong": abs(1 - k), "e_late": 2 * math.sin(_x(theta, P) / 2)}


@ship.mistake("Here an angle in radians was put into a sine that takes degrees.")
def _(e_0, theta, P):
    return {"e_late": 2 * math.sin(math.radians(_x(theta, P) / 2)) * e_0}


@ship.mistake(
    "That holds for slow oscillations only. How long is the difference of two arrows of length one with that angle?"
)
def _(e_0, theta, P):
    return {"e_late": _x(theta, P) * e_0}


@ship.mistake("With one radian between them, wind and feedforward differ by less than the wind itself.")
def _(theta):
    return {"P_min": 2 * math.pi * theta}


@ship.mistake("At this period the feedforward is exactly opposite to what is needed. Where does it begin to do harm?")
def _(theta):
    return {"P_min": 2 * theta}


@ship.mistake("Compare the amplitude with the one under feedback alone.")
def _(theta, P):
    return {"compared": "larger" if _compared(theta, P) == "smaller" else "smaller"}


def _needed(u_0, u_full, d):
    return u_0 + (u_full - u_0) * d**2 / 10000


def _line(u_0, u_full, points, d):
    """What a table of so many points, evenly from 0 to 100, gives at d."""
    width = 100 / (points - 1)
    left = d // width * width
    low, high = _needed(u_0, u_full, left), _needed(u_0, u_full, left + width)
    return low + (high - low) * (d - left) / width


def _left_point(u_0, u_full, points, d):
    """The value of the table at its last point before d."""
    width = 100 / (points - 1)
    return _needed(u_0, u_full, d // width * width)


def _fewest(u_0, u_full, e_max):
    """The fewest points of a table whose largest error is at most e_max."""
    intervals = 1
    while (u_full - u_0) / (4 * intervals**2) > e_max:
        intervals += 1
    return intervals + 1


@exercise(
    "8.5",
    title="A table for a water main",
    points=4,
    where=lambda u_0, u_full, points, d, e_max: (
        d % (100 / (points - 1)) != 0
        and _apart((_line(u_0, u_full, points, d), _needed(u_0, u_full, d), _left_point(u_0, u_full, points, d)))
        and _fewest(u_0, u_full, e_max) > points
    ),
)
def water_main(
    u_0=between(20, 40, "%", reference=30, step=5),
    u_full=between(70, 95, "%", reference=90, step=5),
    points=between(3, 5, reference=3, step=1),
    d=between(10, 90, "m³/h", reference=30, step=5),
    e_max=between(0.2, 1, "%", reference=0.5, step=0.1),
):
    """A pump holds the pressure in a water main. The more the town consumes, the more pressure is lost on the way, with
    the square of the consumption $d$ [m³/h]. Without consumption the control signal must be {u_0}, at 100 m³/h it must
    be {u_full}, and in general {curve}, in %. But nobody in the control room knows this formula. The feedforward takes
    straight lines between {points} points of a table. The points are exact, and evenly spaced from $d$ = 0 to 100 m³/h.

    Which control signal does it give at a consumption of {d}? How large is its error at the worst consumption? And how
    many points does it take, at least, if the error is nowhere to be more than {e_max}?
    """
    return answers(
        u_f=number(_line(u_0, u_full, points, d), "%", "the control signal from the table"),
        e_worst=number((u_full - u_0) / (4 * (points - 1) ** 2), "%", "the largest error of the table"),
        N=number(_fewest(u_0, u_full, e_max), what="the number of points", within=0),
    )


@water_main.shows
def _(u_0, u_full):
    d = Symbol("d")
    return {"curve": u_0 + (u_full - u_0) * (d / 100) ** 2}


@water_main.mistake("This is what is needed at that consumption. The table has the curve at its points only.")
def _(u_0, u_full, d):
    return {"u_f": _needed(u_0, u_full, d)}


@water_main.mistake("This is the value of the point before. Between two points the feedforward is on a straight line.")
def _(u_0, u_full, points, d):
    return {"u_f": _left_point(u_0, u_full, points, d)}


@water_main.mistake("This is the value of the next point. Between two points the feedforward is on a straight line.")
def _(u_0, u_full, points, d):
    width = 100 / (points - 1)
    right = _needed(u_0, u_full, d // width * width + width)
    return {"u_f": right} if _apart((right, _line(u_0, u_full, points, d))) else {}


@water_main.mistake("This is the number of intervals. How many points do they need?")
def _(u_0, u_full, e_max):
    return {"N": _fewest(u_0, u_full, e_max) - 1}


@water_main.mistake(
    "With this many points the error is small enough, but fewer will do. "
    "How does it fall when the intervals become shorter?"
)
def _(u_0, u_full, points, e_max):
    # as if the error fell in proportion to the length of the interval
    N = math.ceil((u_full - u_0) / (4 * (points - 1) * e_max)) + 1
    return {"N": N} if _fewest(u_0, u_full, e_max) < N else {}


@exercise(
    "8.6",
    title="A filter for the feedforward",
    points=5,
    where=lambda A, jump, e_max, sigma, sigma_max: (
        1.5 <= float(A * e_max / jump / (sigma**2 / (2 * sigma_max**2))) <= 4
        and float(sigma**2 / (2 * sigma_max**2)) >= 3
    ),
)
def flow_filter(
    A=between(2, 10, "m²", reference=4, step=1),
    jump=between(4, 20, "L/s", reference=10, step=1),
    e_max=between(10, 60, "mm", reference=30, step=5),
    sigma=between(0.5, 3, "L/s", reference=1, step=0.1),
    sigma_max=between(0.1, 0.6, "L/s", reference=0.3, step=0.05),
):
    """The feedforward of a level control sets the inflow of a tank equal to the measured outflow. The tank has an area
    of {A}. The flow is measured once a second, with a noise of {sigma} (standard deviation). If it went straight into
    the inflow, the valve would not live long. So the measurement passes a lowpass filter with the time constant $T_f$
    [s]. Take the share of the noise that it leaves as $\\sqrt{h/(2 T_f)}$, where $h$ is the time between two samples.

    Choose $T_f$ such that two demands are met:

    - The noise in the feedforward has a standard deviation of at most {sigma_max}.
    - When the outflow rises by {jump} in a step, the level falls by at most {e_max}, by the feedforward alone.

    Any time constant that meets both is right.
    """
    low, high = float(sigma**2 / (2 * sigma_max**2)), float(A * e_max / jump)
    return answers(
        T_f=design(
            number(round(math.sqrt(low * high), 2), "s", "the time constant of the filter"),
            criterion(
                "the noise in the feedforward", lambda T_f: _noise(sigma, T_f), below=float(sigma_max), unit="L/s"
            ),
            criterion("the fall of the level", lambda T_f: float(jump / A) * T_f, below=float(e_max), unit="mm"),
        )
    )


def _noise(sigma, T_f):
    """The standard deviation behind the filter; a filter of no time leaves everything."""
    return float(sigma) * math.sqrt(min(1, 1 / (2 * T_f))) if T_f > 0 else float(sigma)


@flow_filter.mistake("The noise falls with the square root of the time constant, not in proportion to it.")
def _(sigma, sigma_max):
    return {"T_f": sigma / (2 * sigma_max)}
