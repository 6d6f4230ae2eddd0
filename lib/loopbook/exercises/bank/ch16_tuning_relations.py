"""Exercises of chapter 16, tuning relations."""

from sympy import Max, Min, Rational, exp, pi, symbols

from loopbook.exercises.authoring import (
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
    settings,
    stable,
    words,
)
from loopbook.expressions import s
from loopbook.pid import PID


@exercise("16.1", title="A reaction curve on paper", points=2)
def reaction_curve(
    step=between(4, 15, "%", step=1, reference=8),
    slope=between(0.5, 4, "K/min", step=0.25, reference=1.5),
    theta=between(1.5, 8, "min", step=0.5, reference=4),
):
    """An old furnace has no model, but somebody has kept a strip of paper: the gas valve was opened by {step} by
    hand, nothing happened for {theta}, and then the temperature rose, at its steepest by {slope}.

    Find the PI settings of Ziegler and Nichols by this reaction curve.
    """
    slope_of_one_percent = slope / step
    return answers(
        Kc=number(Rational(9, 10) / (slope_of_one_percent * theta), "%/K", "the gain of the controller"),
        tau_I=number(Rational(333, 100) * theta, "min", "the integral time"),
    )


@reaction_curve.mistake("The slope on the paper is for the whole step. The rule uses the slope for one percent.")
def _(slope, theta):
    return {"Kc": Rational(9, 10) / (slope * theta)}


@reaction_curve.mistake("That is the gain of a P controller. With integral action it is somewhat smaller.")
def _(step, slope, theta):
    return {"Kc": step / (slope * theta)}


@reaction_curve.mistake("That is from the row of the PID controller; here it is a PI controller.")
def _(step, slope, theta):
    return {"Kc": Rational(12, 10) * step / (slope * theta), "tau_I": 2 * theta}


@exercise("16.2", title="Settings from a panel", points=2)
def panel(
    rule=choice("Tyreus and Luyben", "Ziegler and Nichols"),
    band=between(10, 80, "%", step=5, reference=25),
    P_u=between(2, 20, "min", step=1, reference=6),
):
    """The panel of an old controller shows the proportional band in percent instead of the gain. Under P control of a
    column's base level, the band was made narrower step by step, until at {band} the level oscillated with a steady
    amplitude. From peak to peak {P_u} went by.

    Find the PI settings of {rule} from this cycle. (The gain of the controller is in percent per percent, so that
    it has no unit.)
    """
    return answers(pid=settings(_by_cycle(rule, 100 / band, P_u), "", "min", "the settings"))


def _by_cycle(rule, K_cu, P_u):
    if rule == "Tyreus and Luyben":
        return PID(Rational(31, 100) * K_cu, Rational(22, 10) * P_u)
    return PID(Rational(45, 100) * K_cu, P_u / Rational(12, 10))


@panel.mistake("These are the settings of another rule of the table: compare its name with the one in the question.")
def _(rule, band, P_u):
    other = {"Tyreus and Luyben": "Ziegler and Nichols", "Ziegler and Nichols": "Tyreus and Luyben"}[rule]
    return {"pid": _by_cycle(other, 100 / band, P_u)}


@panel.mistake("The proportional band is not the ultimate gain: the narrower the band, the higher the gain.")
def _(rule, band, P_u):
    return {"pid": _by_cycle(rule, band / 100, P_u)}


@panel.mistake("The band is in percent. Does a band of 100 % mean a gain of 0.01?")
def _(rule, band, P_u):
    return {"pid": _by_cycle(rule, 1 / band, P_u)}


@panel.mistake("That is the setting of a P controller with the gain margin 2. Integral action reduces it further.")
def _(rule, band, P_u):
    return {"pid": PID(50 / band, _by_cycle(rule, 1, P_u).Ti)}


@panel.mistake("The gain is right. For the time, the rule takes the period from peak to peak, and not a half of it.")
def _(rule, band, P_u):
    return {"pid": _by_cycle(rule, 100 / band, P_u / 2)}


def _damping_squared(left, half_turns):
    """The square of the damping with which a swing falls to a share [%] in so many half turns."""
    from math import log
    from math import pi as half_turn

    fall = log(100 / left) / (half_turns * half_turn)
    return fall**2 / (1 + fall**2)


def _loop_gain(tau_1, tau_2, damping_squared):
    """K*Kc, from tau_1*tau_2*s^2 + (tau_1 + tau_2)*s + 1 + K*Kc."""
    return float((tau_1 + tau_2) ** 2 / (4 * tau_1 * tau_2)) / damping_squared - 1


@exercise(
    "16.3",
    title="A quarter, or less",
    points=3,
    where=lambda K, tau_1, tau_2, left: (
        tau_1 >= 2 * tau_2 and _loop_gain(tau_1, tau_2, _damping_squared(left, 2)) < min(40, 25 * K)
    ),
)
def decay(
    K=between(0.5, 3, "", step=0.25, reference=2),
    tau_1=between(10, 40, "min", step=2, reference=20),
    tau_2=between(2, 12, "min", step=1, reference=5),
    left=between(5, 30, "%", step=5, reference=25),
):
    r"""Two lags in series, {tau_1} and {tau_2}, have the gain $K$ = {K}. (Control signal and measurement are in
    percent.) They are under P control, and the gain $K_c$ should be chosen by the decay ratio: after a setpoint
    step, each peak above the final value should be followed by one of {left} of its height.

    Find $K_c$. And which share of the setpoint step will remain as an offset?
    """
    loop_gain = _loop_gain(tau_1, tau_2, _damping_squared(left, 2))
    return answers(
        Kc=number(loop_gain / K, "", "the gain of the controller"),
        offset=number(100 / (1 + loop_gain), "%", "the offset"),
    )


@decay.mistake("That belongs to an overshoot of this size. From one peak to the next there are two half periods.")
def _(K, tau_1, tau_2, left):
    loop_gain = _loop_gain(tau_1, tau_2, _damping_squared(left, 1))
    return {"Kc": loop_gain / K, "offset": 100 / (1 + loop_gain)}


@decay.mistake("That is close for small damping. But the decay ratio contains the root of $1 - \\zeta^2$.")
def _(K, tau_1, tau_2, left):
    from math import log
    from math import pi as half_turn

    loop_gain = _loop_gain(tau_1, tau_2, (log(100 / left) / (2 * half_turn)) ** 2)
    return {"Kc": loop_gain / K, "offset": 100 / (1 + loop_gain)}


@decay.mistake("The polynomial of the closed loop has $1 + KK_c$ as its last term. Do not forget the 1.")
def _(K, tau_1, tau_2, left):
    return {"Kc": (_loop_gain(tau_1, tau_2, _damping_squared(left, 2)) + 1) / K}


@decay.mistake("That is the gain of the whole loop. The process has a gain, too.")
def _(K, tau_1, tau_2, left):
    if K != 1:
        return {"Kc": _loop_gain(tau_1, tau_2, _damping_squared(left, 2))}


@decay.mistake("That is the share of the step that the measurement reaches. The offset is what is missing.")
def _(tau_1, tau_2, left):
    return {"offset": 100 - 100 / (1 + _loop_gain(tau_1, tau_2, _damping_squared(left, 2)))}


_K, _d, _theta = symbols("K d theta", positive=True)


@exercise("16.4", title="A relay that waits", points=4)
def relay_with_hysteresis(
    q=between(10, 80, "%", step=5, reference=25),
):
    r"""Noise would make a relay chatter. So it is given a hysteresis $h$: it switches down when the measurement $y$
    has risen to $h$ above the setpoint, and up when it has fallen to $h$ below. The process is an integrator with
    dead time, $\frac{{K}}{{s}}e^{-\theta s}$, the relay puts out $+d$ or $-d$, and $h$ is chosen as {q} of the
    amplitude $Kd\theta$ that the oscillation has without hysteresis.

    Find the amplitude $a$ and the period $P$ of the oscillation, and the ultimate gain that one computes from $a$
    as if $y$ were a sine, all in the symbols $K$, $d$ and $\theta$. How many percent of the true ultimate gain is
    that?
    """
    q = q / 100
    names = "K d theta"
    return answers(
        a=expression((1 + q) * _K * _d * _theta, "the amplitude", symbols=names),
        P=expression(4 * (1 + q) * _theta, "the period", symbols=names),
        Kcu=expression(4 / (pi * (1 + q) * _K * _theta), "the estimate of the ultimate gain", symbols=names),
        share=number(800 / (pi**2 * (1 + q)), "%", "the estimate as a share of the true ultimate gain"),
    )


@relay_with_hysteresis.mistake("That is the oscillation without hysteresis. The relay switches later now.")
def _():
    return {"a": _K * _d * _theta, "P": 4 * _theta, "Kcu": 4 / (pi * _K * _theta), "share": 800 / pi**2}


@relay_with_hysteresis.mistake("From switch to switch is half a period. A period has two switches.")
def _(q):
    return {"P": 2 * (1 + q / 100) * _theta}


@relay_with_hysteresis.mistake(
    "When the relay has switched, the process does not react yet, but goes on for one dead time."
)
def _(q):
    return {"a": q / 100 * _K * _d * _theta}


@relay_with_hysteresis.mistake(
    "On the way back, $y$ has to pass zero and fall to the other side of the hysteresis as well."
)
def _(q):
    return {"P": 2 * (2 + q / 100) * _theta}


@relay_with_hysteresis.mistake(
    "That is height over amplitude. The fundamental of a square wave is higher than the wave."
)
def _(q):
    return {"Kcu": 1 / ((1 + q / 100) * _K * _theta)}


# each formula as a text, with its LaTeX and what is wrong with it
_GAINS_A = {
    "(0.4 + 0.6*tau/theta)/K": (r"K_c = \frac{1}{K}\left(0.4 + 0.6\,\frac{\tau}{\theta}\right)", ""),
    "(0.4 + 0.6*tau)/K": (r"K_c = \frac{1}{K}\left(0.4 + 0.6\,\tau\right)", "units"),
    "0.8*sqrt(tau/theta)/K": (r"K_c = \frac{0.8}{K}\sqrt{\frac{\tau}{\theta}}", "limit"),
}
_GAINS_B = {
    "(tau + 0.5*theta)/(K*(tau_c + theta))": (r"K_c = \frac{\tau + 0.5\,\theta}{K\,(\tau_c + \theta)}", ""),
    "(tau + 0.5)/(K*(tau_c + theta))": (r"K_c = \frac{\tau + 0.5}{K\,(\tau_c + \theta)}", "units"),
    "(0.7 + 0.3*theta/tau)/K": (r"K_c = \frac{1}{K}\left(0.7 + 0.3\,\frac{\theta}{\tau}\right)", "limit"),
}
_INTEGRAL_TIMES = {
    "theta*(3 + 0.3*theta/tau)/(1 + 2*theta/tau)": (
        r"\tau_I = \theta\,\frac{3 + 0.3\,\theta/\tau}{1 + 2\,\theta/\tau}",
        "",
    ),
    "theta*(3 + 0.3*theta)/(1 + 2*theta/tau)": (
        r"\tau_I = \theta\,\frac{3 + 0.3\,\theta}{1 + 2\,\theta/\tau}",
        "units",
    ),
    "theta*(3 + 0.3*tau/theta)/(1 + 2*theta/tau)": (
        r"\tau_I = \theta\,\frac{3 + 0.3\,\tau/\theta}{1 + 2\,\theta/\tau}",
        "limit",
    ),
}
_DERIVATIVE_TIMES = {
    "0.4*theta/(1 + 0.2*theta/tau)": (r"\tau_D = \frac{0.4\,\theta}{1 + 0.2\,\theta/\tau}", ""),
    "0.4/(1 + 0.2*theta/tau)": (r"\tau_D = \frac{0.4}{1 + 0.2\,\theta/\tau}", "units"),
    "0.4*sqrt(theta*tau)": (r"\tau_D = 0.4\,\sqrt{\theta\,\tau}", "limit"),
}
_FORMULAS = _GAINS_A | _GAINS_B | _INTEGRAL_TIMES | _DERIVATIVE_TIMES
_LABELS = ["A", "B", "C", "D"]


def _which(fault, *formulas):
    return [label for label, text in zip(_LABELS, formulas, strict=True) if _FORMULAS[text][1] == fault]


@exercise(
    "16.5",
    title="Four formulas from a bad copy",
    points=3,
    where=lambda a, b, c, d: all(_which(fault, a, b, c, d) for fault in ("", "units", "limit")),
)
def bad_copy(
    a=choice(*_GAINS_A, reference="0.8*sqrt(tau/theta)/K"),
    b=choice(*_GAINS_B),
    c=choice(*_INTEGRAL_TIMES, reference="theta*(3 + 0.3*theta)/(1 + 2*theta/tau)"),
    d=choice(*_DERIVATIVE_TIMES),
):
    r"""A bad copy of a tuning relation is found in a drawer. It is for a lag $\tau$ with the gain $K$ and the dead
    time $\theta$, and $\tau_c$ is the desired time constant of the closed loop (all times in one unit):

    - **A**: ${A}$
    - **B**: ${B}$
    - **C**: ${C}$
    - **D**: ${D}$

    Some formulas cannot have been meant like this, because of their **units**. Which? Of the others, some fail in the
    **limit**: when the lag becomes infinite and the slope $k = K/\tau$ stays as it is, gain and times of the controller
    must stay finite, and the gain must not vanish. Which?
    """
    return answers(
        units=words(_which("units", a, b, c, d), _LABELS, "the formulas with wrong units"),
        limit=words(_which("limit", a, b, c, d), _LABELS, "the formulas with a wrong limit"),
    )


@bad_copy.shows
def _(a, b, c, d):
    return {label: _FORMULAS[text][0] for label, text in zip(_LABELS, (a, b, c, d), strict=True)}


@bad_copy.mistake(
    "At least one of these has consistent units: a ratio of times is a pure number, and so is its root; the root of a "
    "product of two times is a time."
)
def _(a, b, c, d):
    return {"units": sorted(_which("units", a, b, c, d) + _which("limit", a, b, c, d))}


@bad_copy.mistake("These already fail because of their units; the limit concerns the others.")
def _(a, b, c, d):
    return {"limit": _which("units", a, b, c, d)}


@bad_copy.mistake(
    "Do not keep $K$ fixed while the lag grows. Put $K = k\\tau$ first, and then look at the limits of all four."
)
def _(a, b, c, d):
    return {"limit": _which("", a, b, c, d)}


@exercise(
    "16.6",
    title="A factor for a damping",
    points=3,
    where=lambda T, tau, n, zeta: not Rational(3, 4) < 4 * zeta**2 * (1 + n) * tau / T < Rational(4, 3),
)
def factor_for_a_damping(
    K=between(0.5, 3, "K/%", step=0.25, reference=1.5),
    T=between(20, 90, "min", step=5, reference=60),
    tau=between(2, 10, "min", step=1, reference=4),
    n=choice(1.5, 2, 2.5, 3, reference=2),
    zeta=between(0.55, 0.95, step=0.05, reference=0.8),
):
    r"""A fermenter's temperature answers to the warm water in its jacket with the gain {K}, a lag $T$ of {T} and a
    dead time $\tau$ of {tau}. Skogestad's rule should be used with $T_C = {n}\,\tau$
    and with such a factor $k_1$ that the loop of an integrator would have the damping $\zeta = {zeta}$.

    Find the factor, and the PI settings for the fermenter.
    """
    k_1, total = 4 * zeta**2, (1 + n) * tau
    return answers(
        k_1=number(k_1, "", "the factor"),
        Kp=number(T / (K * total), "%/K", "the proportional gain"),
        Ti=number(Min(T, k_1 * total), "min", "the integral time"),
    )


@factor_for_a_damping.mistake(
    "The damping does not enter with its first power: look at the polynomial of the loop again."
)
def _(zeta):
    return {"k_1": 4 * zeta}


@factor_for_a_damping.mistake("That is the root of the factor.")
def _(zeta):
    return {"k_1": 2 * zeta}


@factor_for_a_damping.mistake(
    "That belongs to the usual factor 4, which is made for critical damping. Here the factor is another one."
)
def _(T, tau, n):
    return {"k_1": 4} | ({"Ti": 4 * (1 + n) * tau} if 4 * (1 + n) * tau < T else {})


@factor_for_a_damping.mistake("The rule compares two times, and takes the shorter one. You took the longer one.")
def _(T, tau, n, zeta):
    return {"Ti": Max(T, 4 * zeta**2 * (1 + n) * tau)}


@factor_for_a_damping.mistake("Here the loop need not be as fast as the dead time: look at $T_C$.")
def _(K, T, tau):
    return {"Kp": T / (K * 2 * tau)}


@exercise(
    "16.7",
    title="Not so nervous, not so slow",
    points=5,
    where=lambda tau, theta: tau / 5 <= theta <= 2 * tau / 5,
)
def not_so_nervous(
    K=between(0.5, 4, "K/%", step=0.5, reference=2),
    tau=between(10, 40, "min", step=2, reference=20),
    theta=between(2, 16, "min", step=1, reference=5),
):
    r"""The temperature of a reactor is a lag of {tau} with the gain {K} and the dead time {theta}. Loads act at its
    input. Ziegler and Nichols' PI settings make its loop nervous; Skogestad's, with $\tau_c = \theta$ and the
    factor 4, make it slow to recover from loads.

    Find PI settings between them, with

    - a largest sensitivity $M_s$ of at most 2, and
    - an ISE of at most {limit} after a load step of 1 %.

    Any settings that meet both are right. The closed formula of `pi_first_order` computes the ISE.
    """
    good = PID(Rational(3, 5) * tau / (K * theta), Min(tau, 3 * theta))
    process = K * exp(-theta * s) / (tau * s + 1)
    return answers(
        pid=design(
            settings(good, "%/K", "min", "the settings"),
            pi_controller(),
            stable(process),
            largest_sensitivity(process, 30 / theta, below=2),
            criterion("the ISE", lambda pid: _ise(pid, K, tau, theta), below=_limit(K, tau, theta), unit="K² min"),
        )
    )


def _ise(pid, K, tau, theta):
    """The ISE after a load step of one percent."""
    from loopbook.ise import pi_first_order

    given = (float(x) for x in (K, tau, theta, pid.Kp, pid.Ti))
    return float(pi_first_order(*given, "regulator", unstable=float("inf")))


def _limit(K, tau, theta):
    """85 % of the ISE that Skogestad's settings make."""
    value = 0.85 * _ise(PID(tau / (2 * K * theta), min(tau, 8 * theta)), K, tau, theta)
    return float(f"{value:.2g}")


@not_so_nervous.shows
def _(K, tau, theta):
    return {"limit": f"{_limit(K, tau, theta):g}\N{NO-BREAK SPACE}K² min"}


@not_so_nervous.mistake("These are Ziegler and Nichols' settings: good against loads, but too aggressive.")
def _(K, tau, theta):
    return {"pid": PID(Rational(9, 10) * tau / (K * theta), Rational(333, 100) * theta)}


@not_so_nervous.mistake("These are Skogestad's settings: calm enough, but too slow against loads.")
def _(K, tau, theta):
    return {"pid": PID(tau / (2 * K * theta), min(tau, 8 * theta))}
