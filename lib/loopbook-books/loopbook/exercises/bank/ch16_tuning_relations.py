"""Exercises of chapter 16, tuning relations."""

import math

import numpy as np
from sympy import Max, Min, Rational, exp, pi, symbols

from loopbook.deadtime import Loop
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
    word,
    words,
)
from loopbook.expressions import s
from loopbook.figures import time_plot
from loopbook.ise import pi_first_order
from loopbook.pid import PID
from loopbook.transfer import integrator


def _until(end):
    """Times for a picture."""
    return np.linspace(0, float(end), 401)


@exercise(
    "16.1",
    title="A reaction curve on paper",
    points=2,
    insight="Two numbers of a response are enough for a first controller: when it begins, and how fast it rises.",
)
def reaction_curve(
    step=between(4, 15, "%", step=1, reference=8),
    slope=between(0.5, 4, "K/min", step=0.25, reference=1.5),
    theta=between(1.5, 8, "min", step=0.5, reference=4),
):
    """An old furnace has no model, but somebody has kept a strip of paper. At time zero the gas valve was opened by
    {step} by hand, and the pen drew the temperature. The dashed line is a ruler, laid along the steepest part of the
    curve and drawn from zero on.

    Read off the dead time and the slope, and find the PI settings of Ziegler and Nichols by this reaction curve.
    (`t, y = exercise("16.1").given("t", "y")` are the times and the rise of the temperature, if you prefer to compute.)
    """
    slope_of_one_percent = slope / step
    return answers(
        Kc=number(Rational(9, 10) / (slope_of_one_percent * theta), "%/K", "the gain of the controller", within=0.08),
        tau_I=number(Rational(333, 100) * theta, "min", "the integral time", within=0.08),
    )


def _reaction_curve(slope, theta):
    """Times, and the rise of two equal lags behind a dead time whose steepest tangent crosses zero at `theta`."""
    slope, theta = float(slope), float(theta)
    lag = 2 * theta  # its tangent crosses zero 3 - e lags after the dead time
    times = _until(6 * theta)
    late = np.maximum(times - theta + (3 - math.e) * lag, 0) / lag
    return times, slope * math.e * lag * (1 - (1 + late) * np.exp(-late))


def _where_it_leaves(theta):
    """Where an eye sees the curve leave zero: about at two thirds of the dead time by the ruler."""
    return Rational(3, 5) * theta


def _differs(wrong, right):
    """Whether a mistake is far enough from the key for a value that is read by ruler."""
    return abs(float(wrong / right) - 1) > 0.2


@reaction_curve.shows
def _(slope, theta):
    return dict(zip(("t", "y"), _reaction_curve(slope, theta), strict=True))


@reaction_curve.picture
def _(slope, theta):
    """The temperature after the step of the valve, an S-shaped rise, with the tangent at its steepest point."""
    times, y = _reaction_curve(slope, theta)
    ruler = np.where(times >= theta, float(slope) * (times - float(theta)), np.nan)
    curves = {"record": (y, "measurement"), "ruler": (ruler, "setpoint")}
    return time_plot(curves, times, "The strip of paper", "$t$ [min]", "temperature rise [K]")


@reaction_curve.mistake("The slope on the paper is for the whole step. The rule uses the slope for one percent.")
def _(slope, theta):
    return {"Kc": Rational(9, 10) / (slope * theta)}


@reaction_curve.mistake("That is the gain of a P controller. With integral action it is somewhat smaller.")
def _(step, slope, theta):
    return {"Kc": step / (slope * theta)}


@reaction_curve.mistake("That is from the row of the PID controller; here it is a PI controller.")
def _(step, slope, theta):
    return {"Kc": Rational(12, 10) * step / (slope * theta)}


@reaction_curve.mistake(
    "Twice the dead time is from the row of the PID controller. If you have multiplied by 3.33, look at where the "
    "*ruler* crosses zero: the curve itself leaves zero earlier."
)
def _(theta):
    return {"tau_I": 2 * theta}


@reaction_curve.mistake("The curve leaves zero earlier than the ruler. At which of the two is the dead time read?")
def _(step, slope, theta):
    begin = _where_it_leaves(theta)
    return {"Kc": Rational(9, 10) * step / (slope * begin)}


@reaction_curve.mistake("The slope and the dead time are both in the denominator: a quick process needs less gain.")
def _(step, slope, theta):
    wrong = Rational(9, 10) * slope * theta / step
    return {"Kc": wrong} if _differs(wrong, Rational(9, 10) * step / (slope * theta)) else {}


@reaction_curve.mistake("The dead time is missing: the later a process responds, the smaller the gain.")
def _(step, slope, theta):
    return {"Kc": Rational(9, 10) * step / slope}


@reaction_curve.mistake("In the rule for a PI controller the dead time is multiplied by 3.33.")
def _(theta):
    return {"tau_I": theta * Rational(3, 10)}


@reaction_curve.mistake("That is the dead time itself. The rule takes a multiple of it.")
def _(theta):
    return {"tau_I": theta}


@reaction_curve.mistake("Divided by 1.2 is the ultimate period, in the other rule. This one takes the dead time.")
def _(theta):
    return {"tau_I": theta / Rational(12, 10)}


reaction_curve.hints(
    "Ziegler and Nichols need two numbers of a reaction curve: the dead time, and the slope for one percent of valve.",
    "The dead time $\\theta$ is where the tangent crosses the initial value. With the slope $R$ of the tangent, "
    "divided by the step, the PI settings are $K_c = \\frac{0.9}{R\\theta}$ and $\\tau_I = 3.33\\,\\theta$.",
    "Take two points of the tangent that are far apart, and divide the rise by the time between them and by {step}: $R "
    "= \\frac{\\mathrm{rise}}{\\mathrm{time} \\cdot {step} }$.",
)


@reaction_curve.solution
def _(step, slope, theta):
    r"""The tangent crosses the initial value at {theta}: that is the dead time. It rises by {slope}, after a step of
    {step}. For one percent of valve that is $R = \frac{ {slope} }{ {step} }$, which is {R}.

    ***

    The rule for a PI controller: $K_c = \frac{0.9}{R\theta} = \frac{0.9}{ {R} \cdot {theta} }$, which is {Kc}, and
    $\tau_I = 3.33 \cdot {theta}$, which is {tau_I}.

    By ruler you will be a few percent off; the tolerance allows for it, and the furnace does not mind.
    """
    return {"R": (slope / step, "K/min/%")}


@exercise(
    "16.2",
    title="Settings from a panel",
    points=2,
    insight="The ultimate cycle is one experiment; how careful the settings are is the choice of the rule.",
)
def panel(
    rule=choice("Tyreus and Luyben", "Ziegler and Nichols"),
    band=between(10, 80, "%", step=5, reference=25),
    P_u=between(2, 20, "min", step=1, reference=6),
):
    """The panel of an old controller shows the proportional band in percent instead of the gain. Under P control of a
    column's base level, the band was made narrower step by step. At {band} the level oscillated with a steady
    amplitude, as in the picture.

    Find the PI settings of {rule} from this cycle. (The gain of the controller is in percent per percent, so it
    has no unit. `t, y = exercise("16.2").given("t", "y")` are the times and the level.)
    """
    return answers(pid=settings(_by_cycle(rule, 100 / band, P_u), "", "min", "the settings", within=0.04))


def _cycle(P_u):
    """Times, and a level that oscillates."""
    times = np.linspace(0, 4.5 * float(P_u), 401)
    return times, 50 + 4 * np.sin(2 * math.pi * times / float(P_u) + 1)


@panel.picture
def _(P_u):
    """The level oscillates around 50 % with a steady amplitude; a little more than four periods are shown."""
    times, y = _cycle(P_u)
    return time_plot({"$y$": (y, "measurement")}, times, "At the limit of stability", "$t$ [min]", "level [%]")


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


def _with_miscounted_periods(share):
    def wrong(rule, band, P_u):
        return {"pid": _by_cycle(rule, 100 / band, share * P_u)}

    return wrong


# the whole picture over four or five periods, and the way between the outer peaks over their number
for _share in (Rational(9, 8), Rational(9, 10), Rational(4, 5)):
    panel.mistake("The gain is right. How far apart are the first and the last peak, and how many periods is that?")(
        _with_miscounted_periods(_share)
    )


@panel.mistake("That is the ultimate gain itself: at it the loop oscillates. Which share of it does the rule take?")
def _(rule, band, P_u):
    return {"pid": PID(100 / band, _by_cycle(rule, 1, P_u).Ti)}


@panel.mistake("The gain is right, and the time is the period itself. Which factor has the rule for it?")
def _(rule, band, P_u):
    return {"pid": PID(_by_cycle(rule, 100 / band, P_u).Kp, P_u)}


@panel.mistake("The gain is right. For the time, do you multiply by the factor of this rule, or divide?")
def _(rule, band, P_u):
    factor = _by_cycle(rule, 1, P_u).Ti / P_u
    return {"pid": PID(_by_cycle(rule, 100 / band, P_u).Kp, P_u / factor)}


@panel.mistake("With this gain the loop is far beyond the limit: the rule takes a share of the ultimate gain.")
def _(rule, band, P_u):
    share = _by_cycle(rule, 1, P_u).Kp
    return {"pid": PID(100 / band / share, _by_cycle(rule, 1, P_u).Ti)}


@panel.mistake("That is from the row of the PID controller. The question is about a PI controller.")
def _(rule, band, P_u):
    Kcu = 100 / band
    if rule == "Tyreus and Luyben":
        return {"pid": PID(Rational(45, 100) * Kcu, Rational(22, 10) * P_u, P_u / Rational(63, 10))}
    return {"pid": PID(Rational(6, 10) * Kcu, P_u / 2, P_u / 8)}


panel.hints(
    "At the limit of stability, the gain of the controller is the ultimate gain. Which gain is a proportional band of "
    "{band}?",
    "$K_{cu} = \\frac{100\\,\\%}{\\mathrm{{band}} }$, and the ultimate period is the time from peak to peak: read it "
    "over several periods. Table 12.6 has the factors of both rules.",
    "$K_{cu} = \\frac{100}{ {band} }$. The rule of {rule} multiplies it by {share}, and takes $P_u$ {times_P}.",
)


def _factors(rule):
    return ("0.31", "times 2.2") if rule == "Tyreus and Luyben" else ("0.45", "divided by 1.2")


@panel.shows
def _(rule, P_u):
    share, times_P = _factors(rule)
    times, y = _cycle(P_u)
    return {"share": share, "times_P": times_P, "t": times, "y": y}


@panel.solution
def _(rule, band, P_u):
    r"""A band of {band} is a gain of $\frac{100}{ {band} }$, which is {gain}. With it the loop is at its limit, so
    that is the ultimate gain.

    From the first peak in the picture to the last one there are several periods: divided by their number, one is {P_u}.

    The rule of {rule} for PI control: $K_c$ is {share} times the ultimate gain, {K_c}, and the integral time is $P_u$
    {times_P}, that is {tau_I}.
    """
    pid = _by_cycle(rule, 100 / band, P_u)
    return {"gain": 100 / band, "K_c": pid.Kp, "tau_I": (pid.Ti, "min")}


def _damping_squared(left, half_turns):
    """The square of the damping with which a swing falls to a share [%] in so many half turns."""
    fall = math.log(100 / left) / (half_turns * math.pi)
    return fall**2 / (1 + fall**2)


def _loop_gain(tau_1, tau_2, damping_squared):
    """K*Kc, from tau_1*tau_2*s^2 + (tau_1 + tau_2)*s + 1 + K*Kc."""
    return float((tau_1 + tau_2) ** 2 / (4 * tau_1 * tau_2)) / damping_squared - 1


@exercise(
    "16.3",
    title="From peak to peak",
    points=3,
    insight="A decay ratio is a damping in other words; without integral action the price of calm is an offset.",
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
    percent.) They are under P control, and the gain $K_c$ is chosen by the decay ratio: after a setpoint step, each
    peak above the final value should be followed by one of {left} of its height.

    Which $K_c$ does that? And which share of the setpoint step remains as an offset?
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
    loop_gain = _loop_gain(tau_1, tau_2, (math.log(100 / left) / (2 * math.pi)) ** 2)
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


@decay.mistake("That belongs to a decay ratio of a quarter. Which ratio is asked here?")
def _(K, tau_1, tau_2, left):
    if left != 25:
        loop_gain = _loop_gain(tau_1, tau_2, _damping_squared(25, 2))
        return {"Kc": loop_gain / K, "offset": 100 / (1 + loop_gain)}


@decay.mistake("The gain of the process is in the loop, too: the offset belongs to both gains together.")
def _(K, tau_1, tau_2, left):
    if K != 1:
        return {"offset": 100 / (1 + _loop_gain(tau_1, tau_2, _damping_squared(left, 2)) / K)}


@decay.mistake("The 1 is missing: behind a step the error is $1/(1 + KK_c)$ of it.")
def _(tau_1, tau_2, left):
    return {"offset": 100 / _loop_gain(tau_1, tau_2, _damping_squared(left, 2))}


@decay.mistake("Without integral action something is left. How large an error does the controller need for its signal?")
def _():
    return {"offset": 0}


@decay.mistake("In $2\\zeta\\omega_0$ there is a factor of two, which is squared in the last step.")
def _(K, tau_1, tau_2, left):
    return {"Kc": (4 * (1 + _loop_gain(tau_1, tau_2, _damping_squared(left, 2))) - 1) / K}


@decay.mistake("The damping enters with its square: compare the polynomials once more.")
def _(K, tau_1, tau_2, left):
    return {"Kc": _loop_gain(tau_1, tau_2, math.sqrt(_damping_squared(left, 2))) / K}


decay.hints(
    "A decay ratio belongs to a damping $\\zeta$, and the damping to the characteristic polynomial of the loop.",
    "From peak to peak the oscillation has two half turns: the ratio is $e^{-2\\pi\\zeta/\\sqrt{1 - \\zeta^2}}$. The "
    "polynomial is $\\tau_1\\tau_2 s^2 + (\\tau_1 + \\tau_2)s + 1 + KK_c$.",
    "With the logarithm $\\ell = \\ln\\frac{100}{ {left} }$, $\\zeta^2 = \\frac{\\ell^2}{4\\pi^2 + \\ell^2}$. And in "
    "the polynomial, $1 + KK_c = \\frac{(\\tau_1 + \\tau_2)^2}{4\\,\\tau_1\\tau_2\\,\\zeta^2}$.",
)


@decay.solution
def _(K, tau_1, tau_2, left):
    r"""The decay ratio of {left} has the logarithm $\ell = \ln\frac{100}{ {left} }$, which is {logarithm}. It is
    $2\pi\zeta/\sqrt{1 - \zeta^2}$, so that $\zeta^2 = \frac{\ell^2}{4\pi^2 + \ell^2}$, which is {square}, and $\zeta$
    is {zeta}.

    The characteristic polynomial of the loop is $\tau_1\tau_2 s^2 + (\tau_1 + \tau_2)s + 1 + KK_c$. Compared with
    $s^2 + 2\zeta\omega_0 s + \omega_0^2$ it has $1 + KK_c = \frac{(\tau_1 + \tau_2)^2}{4\,\tau_1\tau_2\,\zeta^2}$,
    which is {total}.

    So $KK_c$ is one less, and $K_c$ that divided by {K}: {Kc}.

    The measurement ends at $\frac{KK_c}{1 + KK_c}$ of the step. What is missing is $\frac{1}{1 + KK_c}$, {offset}.
    """
    square = _damping_squared(left, 2)
    return {
        "logarithm": math.log(100 / left),
        "square": square,
        "zeta": math.sqrt(square),
        "total": 1 + _loop_gain(tau_1, tau_2, square),
    }


@decay.solution_picture
def _(K, tau_1, tau_2, left):
    """The response to a setpoint step: two peaks above its final value, which is below the setpoint."""
    square = _damping_squared(left, 2)
    loop_gain = _loop_gain(tau_1, tau_2, square)
    turn = math.sqrt((1 + loop_gain) / float(tau_1 * tau_2) * (1 - square))
    times = _until(4.5 * math.pi / turn)
    y = Loop(K / ((tau_1 * s + 1) * (tau_2 * s + 1)), PID(loop_gain / K)).servo.step(times)
    plot = time_plot({"$y$": (y, "measurement")}, times, "A unit step of the setpoint", "$t$ [min]", "$y$")
    plot.mark(math.pi / turn, "a peak").mark(3 * math.pi / turn, "the next one")
    return plot.level(loop_gain / (1 + loop_gain), "final value")


_K, _d, _theta = symbols("K d theta", positive=True)


@exercise(
    "16.4",
    title="A relay that waits",
    points=4,
    insight="A relay measures its own cycle: hysteresis makes it longer and higher, and the estimate more careful.",
)
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
    return {"a": _K * _d * _theta, "P": 4 * _theta, "Kcu": 4 / (pi * _K * _theta)}


def _share_of_two_experiments(q):
    """The estimate with hysteresis as a share [%] of the one without."""
    return 100 / (1 + q / 100)


# The true gain with the wrong estimate, and the wrong gain: the numbers may be close, and the sentence holds for both.
for _share in (lambda: {"share": 800 / pi**2}, lambda q: {"share": _share_of_two_experiments(q)}):
    relay_with_hysteresis.mistake(
        "The share compares the estimate with hysteresis and the true ultimate gain. Which two have you compared?"
    )(_share)


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


@relay_with_hysteresis.mistake("From peak to peak it is twice as much: the amplitude counts from the middle.")
def _(q):
    return {"a": 2 * (1 + q / 100) * _K * _d * _theta}


@relay_with_hysteresis.mistake("The relay puts out $+d$ or $-d$, so the slope is $Kd$ and not a half of it.")
def _(q):
    return {"a": (1 + q / 100) * _K * _d * _theta / 2}


@relay_with_hysteresis.mistake("The output of the relay is $+d$ or $-d$: its amplitude is $d$, and that of $y$ is $a$.")
def _(q):
    return {"Kcu": 2 / (pi * (1 + q / 100) * _K * _theta)}


@relay_with_hysteresis.mistake("That is the true ultimate gain. What does the experiment give?")
def _():
    return {"Kcu": pi / (2 * _K * _theta), "share": 100}


@relay_with_hysteresis.mistake("That is the true gain as a share of the estimate. Which of the two is the whole?")
def _(q):
    return {"share": 100 * pi**2 * (1 + q / 100) / 8}


@relay_with_hysteresis.mistake("By so much the estimate is off. How many percent of the true gain is it?")
def _(q):
    wrong = abs(100 - 800 / pi**2 / (1 + q / 100))
    is_told = abs(wrong - 50) > 3 and abs(wrong - _share_of_two_experiments(q)) > 2
    return {"share": wrong} if is_told else {}


relay_with_hysteresis.hints(
    "Follow $y$ for one half of the cycle. It is an integral of a constant, so it consists of straight lines. How "
    "steep are they?",
    "The slope is $\\pm Kd$. The relay switches when $y$ has passed $h$, but the process goes on for one dead time "
    "more. Then $y$ has to fall from its peak to $-h$.",
    "The peak is $h + Kd\\theta$, and $h$ is {q} of $Kd\\theta$. From peak to peak, $y$ goes up and down by twice the "
    "amplitude each time, with the slope $Kd$. For a sine, $K_{cu} = \\frac{4d}{\\pi a}$.",
)


@relay_with_hysteresis.solution
def _(q):
    r"""While the relay puts out $+d$, $y$ rises with the slope $Kd$, and with $-d$ it falls as fast: a triangle.

    The relay switches down when $y$ passes $h$. The process feels that one dead time later, and until then $y$ rises
    by another $Kd\theta$. So the amplitude is $a = h + Kd\theta$, that is {a} with $h$ as {q} of $Kd\theta$.

    A period is four times the way from zero to the peak: $P = \frac{4a}{Kd}$, which is {P}.

    A square wave has a fundamental of $\frac{4d}{\pi}$. Divided by the amplitude, that is the estimate
    $K_{cu} = \frac{4d}{\pi a}$, or {Kcu}.

    The true ultimate gain of an integrator with dead time is $\frac{\pi}{2K\theta}$. The estimate is
    $\frac{8}{\pi^2\,(1 + q)}$ of it, with $q$ = {q}: {share}.
    """
    return {}


@relay_with_hysteresis.solution_picture
def _(q):
    """The measurement is a triangle; the relay switches when it has passed the hysteresis, before each peak."""
    amplitude, times = 1 + float(q) / 100, np.linspace(0, 8, 801)
    y = amplitude * (1 - 2 * abs((times / amplitude + 1) % 4 / 2 - 1))
    axes = {"xlabel": "$t$ in dead times", "ylabel": "$y$ in $Kd\\theta$"}
    plot = time_plot({"$y$": (-y, "measurement")}, times, "A relay with hysteresis", **axes)
    return plot.level(float(q) / 100, "$h$").level(-float(q) / 100, "$-h$")


# each formula as a text, with its LaTeX, what is wrong with it, and why
_GAINS_A = {
    "(0.4 + 0.6*tau/theta)/K": (
        r"K_c = \frac{1}{K}\left(0.4 + 0.6\,\frac{\tau}{\theta}\right)",
        "",
        "only a ratio of times is in the bracket, and for a long lag the gain tends to $0.6/(k\\theta)$",
    ),
    "(0.4 + 0.6*tau)/K": (
        r"K_c = \frac{1}{K}\left(0.4 + 0.6\,\tau\right)",
        "units",
        "a time is added to a pure number",
    ),
    "0.8*sqrt(tau/theta)/K": (
        r"K_c = \frac{0.8}{K}\sqrt{\frac{\tau}{\theta}}",
        "limit",
        "with $K = k\\tau$ the gain is $0.8/(k\\sqrt{\\tau\\theta})$, which vanishes for a long lag",
    ),
}
_GAINS_B = {
    "(tau + 0.5*theta)/(K*(tau_c + theta))": (
        r"K_c = \frac{\tau + 0.5\,\theta}{K\,(\tau_c + \theta)}",
        "",
        "times are divided by times, and for a long lag the gain tends to $1/(k(\\tau_c + \\theta))$",
    ),
    "(tau + 0.5)/(K*(tau_c + theta))": (
        r"K_c = \frac{\tau + 0.5}{K\,(\tau_c + \theta)}",
        "units",
        "a pure number is added to a time",
    ),
    "(0.7 + 0.3*theta/tau)/K": (
        r"K_c = \frac{1}{K}\left(0.7 + 0.3\,\frac{\theta}{\tau}\right)",
        "limit",
        "with $K = k\\tau$ the gain is about $0.7/(k\\tau)$, which vanishes for a long lag",
    ),
}
_INTEGRAL_TIMES = {
    "theta*(3 + 0.3*theta/tau)/(1 + 2*theta/tau)": (
        r"\tau_I = \theta\,\frac{3 + 0.3\,\theta/\tau}{1 + 2\,\theta/\tau}",
        "",
        "a time, multiplied by ratios, and for a long lag it tends to $3\\theta$",
    ),
    "theta*(3 + 0.3*theta)/(1 + 2*theta/tau)": (
        r"\tau_I = \theta\,\frac{3 + 0.3\,\theta}{1 + 2\,\theta/\tau}",
        "units",
        "a time is added to a pure number",
    ),
    "theta*(3 + 0.3*tau/theta)/(1 + 2*theta/tau)": (
        r"\tau_I = \theta\,\frac{3 + 0.3\,\tau/\theta}{1 + 2\,\theta/\tau}",
        "limit",
        "for a long lag it grows with $0.3\\tau$, without end",
    ),
}
_DERIVATIVE_TIMES = {
    "0.4*theta/(1 + 0.2*theta/tau)": (
        r"\tau_D = \frac{0.4\,\theta}{1 + 0.2\,\theta/\tau}",
        "",
        "a time, divided by a pure number, and for a long lag it tends to $0.4\\theta$",
    ),
    "0.4/(1 + 0.2*theta/tau)": (
        r"\tau_D = \frac{0.4}{1 + 0.2\,\theta/\tau}",
        "units",
        "a derivative time that is a pure number",
    ),
    "0.4*sqrt(theta*tau)": (
        r"\tau_D = 0.4\,\sqrt{\theta\,\tau}",
        "limit",
        "for a long lag it grows with $\\sqrt{\\tau}$, without end",
    ),
}
_FORMULAS = _GAINS_A | _GAINS_B | _INTEGRAL_TIMES | _DERIVATIVE_TIMES
_LABELS = ["A", "B", "C", "D"]


def _which(fault, *formulas):
    return [label for label, text in zip(_LABELS, formulas, strict=True) if _FORMULAS[text][1] == fault]


@exercise(
    "16.5",
    title="Four formulas from a bad copy",
    points=3,
    insight="Units and a limit know nothing of tuning, and still they find most misprints.",
    where=lambda a, b, c, d: all(_which(fault, a, b, c, d) for fault in ("", "units", "limit")),
)
def bad_copy(
    a=choice(*_GAINS_A, reference="0.8*sqrt(tau/theta)/K"),
    b=choice(*_GAINS_B),
    c=choice(*_INTEGRAL_TIMES, reference="theta*(3 + 0.3*theta)/(1 + 2*theta/tau)"),
    d=choice(*_DERIVATIVE_TIMES),
):
    r"""A bad copy of a tuning relation turns up in a drawer. It is for a lag $\tau$ with the gain $K$ and the dead
    time $\theta$, and $\tau_c$ is the desired time constant of the closed loop (all times in one unit). The section
    *Two questions that find a misprint*, which is further reading, shows how to test such formulas.

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


@bad_copy.mistake("Every sum needs two terms of one kind. And has the whole formula the unit of what it stands for?")
def _(a, b, c, d):
    return {"units": _which("", a, b, c, d)}


@bad_copy.mistake("Of the others means: what fails because of its units is not asked here again.")
def _(a, b, c, d):
    return {"limit": sorted(_which("units", a, b, c, d) + _which("limit", a, b, c, d))}


@bad_copy.mistake("Do not keep $K$ fixed: with $K = k\\tau$, is there a formula among these that stays finite?")
def _(a, b, c, d):
    return {"limit": sorted(_which("", a, b, c, d) + _which("limit", a, b, c, d))}


@bad_copy.mistake("These already fail because of their units; the limit concerns the others.")
def _(a, b, c, d):
    return {"limit": _which("units", a, b, c, d)}


@bad_copy.mistake(
    "Do not keep $K$ fixed while the lag grows. Put $K = k\\tau$ first, and then look at the limits of all four."
)
def _(a, b, c, d):
    return {"limit": _which("", a, b, c, d)}


bad_copy.hints(
    "Two questions find a misprint: does the formula survive another unit of time, and does it survive a limit?",
    "Units: what is added must be of one kind, a gain is a pure number over $K$, and $\\tau_I$ and $\\tau_D$ are "
    "times. Limit: put $K = k\\tau$, keep $k$ and $\\theta$, and let $\\tau$ grow.",
    "Begin with the units, formula by formula: A is ${A}$. Is there a time added to a pure number? Then put $K = "
    "k\\tau$ into those whose units are right.",
)


@bad_copy.solution
def _(a, b, c, d):
    r"""Formula by formula:

    - **A**: {of_A}.
    - **B**: {of_B}.
    - **C**: {of_C}.
    - **D**: {of_D}.

    So the units are wrong in {units}, and the limit in {limit}.
    """
    return {f"of_{label}": _FORMULAS[text][2] for label, text in zip(_LABELS, (a, b, c, d), strict=True)}


@exercise(
    "16.6",
    title="A factor for a damping",
    points=3,
    insight="The factor 4 of Skogestad's rule is a damping of one; less damping buys a quicker recovery.",
    where=lambda T, tau, n, zeta: not Rational(3, 4) < 4 * zeta**2 * (1 + n) * tau / T < Rational(4, 3),
)
def factor_for_a_damping(
    K=between(0.5, 3, "K/%", step=0.25, reference=1.5),
    T=between(20, 90, "min", step=5, reference=60),
    tau=between(2, 10, "min", step=1, reference=4),
    n=choice(1.5, 2, 2.5, 3, reference=2),
    zeta=between(0.55, 0.95, step=0.05, reference=0.8),
):
    r"""The temperature of a fermenter responds to the warm water in its jacket with the gain {K}, a lag $T$ of {T} and
    a dead time $\tau$ of {tau}. Use Skogestad's rule with $T_C = {n}\,\tau$, and with such a factor $k_1$ that the loop
    around an integrator would have the damping $\zeta = {zeta}$.

    How large is the factor, and which are the PI settings for the fermenter?
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
def _(K, T, tau, n, zeta):
    if n == 2:  # the same as without the dead time, see below
        return {}
    right, wrong = Min(T, 4 * zeta**2 * (1 + n) * tau), Min(T, 8 * zeta**2 * tau)
    return {"Kp": T / (K * 2 * tau)} | ({"Ti": wrong} if abs(wrong / right - 1) > Rational(1, 20) else {})


@factor_for_a_damping.mistake("A factor of 1.44 belongs to another damping. Which one is asked here?")
def _(T, tau, n, zeta):
    if abs(zeta - Rational(6, 10)) < Rational(4, 100):
        return {}
    right, wrong = Min(T, 4 * zeta**2 * (1 + n) * tau), Min(T, Rational(144, 100) * (1 + n) * tau)
    return {"k_1": 1.44} | ({"Ti": wrong} if wrong < T and abs(wrong / right - 1) > Rational(1, 20) else {})


@factor_for_a_damping.mistake("Compare the coefficients once more: the damping is half of the root of the factor.")
def _(zeta):
    return {"k_1": zeta**2}


@factor_for_a_damping.mistake("In the gain stands $T_C$ with one dead time more, and $T_C$ is {n} times the dead time.")
def _(K, T, tau, n):
    return {"Kp": T / (K * n * tau)}


@factor_for_a_damping.mistake("The gain of the process is missing: the loop has the product of both gains.")
def _(K, T, tau, n):
    return {"Kp": T / ((1 + n) * tau)} if K != 1 else {}


@factor_for_a_damping.mistake("That is $T_C$ and the dead time together. Which factor comes before it?")
def _(T, tau, n, zeta):
    wrong = (1 + n) * tau
    return {"Ti": wrong} if abs(wrong / Min(T, 4 * zeta**2 * wrong) - 1) > Rational(1, 20) else {}


@factor_for_a_damping.mistake(
    "The factor multiplies $T_C$ and one dead time more, and $T_C$ is {n} times the dead time."
)
def _(T, tau, n, zeta):
    right, wrong = Min(T, 4 * zeta**2 * (1 + n) * tau), 4 * zeta**2 * n * tau
    return {"Ti": wrong} if abs(wrong / right - 1) > Rational(1, 20) else {}


factor_for_a_damping.hints(
    "Close the loop around an integrator (dead time neglected) with the controller of the rule. What is its damping?",
    "With $K_p = \\frac{1}{k\\,(T_C + \\tau)}$ and $T_i = k_1(T_C + \\tau)$ the polynomial is $k_1 (T_C + \\tau)^2 s^2 "
    "+ k_1 (T_C + \\tau)s + 1$. Compare it with $s^2 + 2\\zeta\\omega_0 s + \\omega_0^2$.",
    "$\\omega_0^2 = \\frac{1}{k_1 (T_C + \\tau)^2}$ and $2\\zeta\\omega_0 = \\frac{1}{T_C + \\tau}$, so $\\zeta = "
    "\\frac{\\sqrt{{k_1}} }{2}$, which should be {zeta}. And $T_C + \\tau = (1 + {n}) \\cdot {tau}$ min.",
)


@factor_for_a_damping.solution
def _(T, tau, n, zeta):
    r"""With the settings of the rule, the loop of an integrator has the polynomial
    $k_1 (T_C + \tau)^2 s^2 + k_1 (T_C + \tau)s + 1$. Its damping is $\zeta = \frac{\sqrt{{k_1}}}{2}$. So
    $k_1 = 4\zeta^2 = 4 \cdot {zeta}^2$, which is {k_1}.

    For the fermenter, $T_C + \tau = (1 + {n}) \cdot {tau}$, which is {total}. The gain is
    $K_p = \frac{{T}}{K(T_C + \tau)} = \frac{ {T} }{ {K} \cdot {total} }$, that is {Kp}.

    The integral time is the shorter of the lag, {T}, and $k_1(T_C + \tau)$, {other}. It is {Ti}.
    """
    total = (1 + n) * tau
    return {"total": (total, "min"), "other": (4 * zeta**2 * total, "min")}


@factor_for_a_damping.solution_picture
def _(K, T, tau, n, zeta):
    """The temperature after a step of the load with this factor, and with the usual factor of four."""
    times, total = _until(10 * (1 + n) * tau), (1 + n) * tau
    factors = {"this factor": 4 * zeta**2, "factor 4": 4}
    process = K * exp(-tau * s) / (T * s + 1)
    curves = {
        name: Loop(process, PID(T / (K * total), Min(T, factor * total))).regulator.step(times)
        for name, factor in factors.items()
    }
    return time_plot(curves, times, "After a load step of 1 %", "$t$ [min]", "temperature [K]")


@exercise(
    "16.7",
    title="Not so nervous, not so slow",
    points=5,
    insight="Between a nervous rule and a slow one there is room; two numbers, $M_s$ and ISE, say where you are.",
    where=lambda tau, theta: tau / 5 <= theta <= 2 * tau / 5,
)
def not_so_nervous(
    K=between(0.5, 4, "K/%", step=0.5, reference=2),
    tau=between(10, 40, "min", step=2, reference=20),
    theta=between(2, 16, "min", step=1, reference=5),
):
    r"""The temperature of a reactor is a lag of {tau} with the gain {K} and the dead time {theta}. Loads act at its
    input. Ziegler and Nichols' PI settings make the loop nervous; Skogestad's, with $\tau_c = \theta$ and the factor 4,
    recover slowly from loads.

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
            draws=lambda pid: _after_a_load(pid, K, tau, theta),
        )
    )


def _ise(pid, K, tau, theta):
    """The ISE after a load step of one percent."""
    given = (float(x) for x in (K, tau, theta, pid.Kp, pid.Ti))
    return float(pi_first_order(*given, "regulator", unstable=float("inf")))


def _after_a_load(pid, K, tau, theta):
    times = _until(20 * theta)
    y = Loop(K * exp(-theta * s) / (tau * s + 1), pid).regulator.step(times)
    labels = {"xlabel": "$t$ [min]", "ylabel": ["$y$ [K]", "$y^2$ [K²]"]}
    panels = [{"$y$": (y, "measurement")}, {"$y^2$": (y**2, 0)}]
    plot = time_plot(panels, times, "Your loop after a load step of 1 %", **labels)
    words = f"ISE {_ise(pid, K, tau, theta):.3g}, at most {_limit(K, tau, theta):g}"
    return plot.area("$y^2$", label=words)


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


@not_so_nervous.mistake("That asks the loop to have no time constant of its own. How robust can it be then?")
def _(K, tau, theta):
    return {"pid": PID(tau / (K * theta), tau)}


@not_so_nervous.mistake("The gain of the process is missing: the loop has the product of both gains.")
def _(K, tau, theta):
    return {"pid": PID(Rational(3, 5) * tau / theta, min(tau, 3 * theta))} if K >= 2 else {}


@not_so_nervous.mistake("The two settings are interchanged: which of them is a time, and which a gain?")
def _(K, tau, theta):
    wrong = PID(min(tau, 3 * theta), Rational(3, 5) * tau / (K * theta))
    return {"pid": wrong} if K * wrong.Kp * theta > 2 * tau else {}


not_so_nervous.hints(
    "Both rules have $K_p$ in the form of a number times $\\frac{\\tau}{K\\theta}$. What are the two numbers?",
    "0.9 is too nervous, 0.5 too slow. And the integral time may be shorter than Skogestad's: it is what brings the "
    "loop back after a load.",
    "Begin a little above $0.5\\,\\frac{\\tau}{K\\theta} = 0.5 \\cdot \\frac{ {tau} }{ {K} \\cdot {theta} }$, and "
    "shorten the integral time step by step, from the lag of {tau} downwards, as long as $M_s$ allows it.",
)


@not_so_nervous.solution
def _(K, tau, theta):
    r"""Ziegler and Nichols take $0.9\,\frac{\tau}{K\theta}$ as the gain, Skogestad $0.5\,\frac{\tau}{K\theta}$.
    Between them, 0.6 is a good beginning: $0.6 \cdot \frac{ {tau} }{ {K} \cdot {theta} }$, which is {gain}.

    After a load the integral term does the work, so let the integral time be three dead times, or the lag if that is
    shorter: {time}.

    The ISE is {value}, and at most {limit} is asked. Ziegler and Nichols' settings have {nervous}, but an $M_s$ above
    2; Skogestad's have {slow}. The $M_s$ of the new settings is {sensitivity}.
    """
    good = PID(Rational(3, 5) * tau / (K * theta), Min(tau, 3 * theta))
    nervous = PID(Rational(9, 10) * tau / (K * theta), Rational(333, 100) * theta)
    slow = PID(tau / (2 * K * theta), Min(tau, 8 * theta))
    values = {"value": good, "nervous": nervous, "slow": slow}
    w = np.geomspace(1e-3, 20, 3000) / float(theta)
    L = Loop(K * exp(-theta * s) / (tau * s + 1), good).S.frequency(w)
    return {
        "gain": (good.Kp, "%/K"),
        "time": (good.Ti, "min"),
        "sensitivity": f"{max(abs(L)):.3g}",
        **{name: (_ise(pid, K, tau, theta), "K² min") for name, pid in values.items()},
    }


def _with_decay(left):
    """Of an integrator with dead time: the share that is left from peak to peak [%] by gain and frequency, in dead
    times.

    With s = -sigma + j omega in s + k e^{-s} = 0, tan omega = omega/sigma.
    """
    omega = math.atan(2 * math.pi / math.log(100 / float(left)))
    sigma = omega / math.tan(omega)
    return omega * math.exp(-sigma) / math.sin(omega), omega


def _recorded(low, step, delay, left):
    """Times and temperature after a step of the setpoint, with the moments and heights of two peaks and a trough."""
    gain, omega = _with_decay(left)
    delay, period = float(delay), 2 * math.pi * float(delay) / omega
    times = np.linspace(0, 3 * period, 3001)
    y = Loop(integrator(gain / delay, delay), PID(1)).servo.step(times) - 1
    first = np.argmax(y)
    trough = np.argmin(np.where((times > times[first]) & (times < times[first] + 0.75 * period), y, 1))
    extremes = [first, trough, trough + np.argmax(y[trough:])]
    return times[::5], float(low) + float(step) * (1 + y[::5]), times[extremes].tolist(), y[extremes].tolist()


@exercise(
    "16.8",
    title="Two peaks on a screen",
    points=4,
    insight="Two peaks tell the damping of a loop, whatever its process is: count from the final value.",
)
def two_peaks(
    low=between(120, 180, "°C", step=10, reference=150),
    step=choice(4, 5, 8, 10, unit="K", reference=10),
    delay=between(2, 8, "min", step=0.5, reference=4),
    left=choice(12, 14, 16, 36, 40, 44, unit="%", reference=40),
):
    r"""The setpoint of a PI loop was raised by {step}, from {low}. The temperature goes as in the picture.

    Read off the decay ratio, the height of the second peak as a share of the first, and the period from peak to peak.
    What is the damping $\zeta$ of a loop of second order with this decay ratio? And in which direction would you
    change the gain for a decay ratio of a quarter?
    (`t, y = exercise("16.8").given("t", "y")` are the times and the temperature.)
    """
    _, _, moments, (first, _, second) = _recorded(low, step, delay, left)
    ratio = 100 * second / first
    return answers(
        decay_ratio=number(ratio, "%", "the decay ratio", within=0.12),
        period=number(moments[2] - moments[0], "min", "the period", within=0.05),
        zeta=number(math.sqrt(_damping_squared(ratio, 2)), "", "the damping", within=0.1),
        gain=word("raise" if left < 25 else "lower", ["raise", "lower"], "what to do with the gain"),
    )


@two_peaks.shows
def _(low, step, delay, left):
    return dict(zip(("t", "y"), _recorded(low, step, delay, left)[:2], strict=True))


@two_peaks.picture
def _(low, step, delay, left):
    """The temperature after the step of the setpoint: it overshoots, and then oscillates around the new setpoint."""
    times, y, *_ = _recorded(low, step, delay, left)
    curves = {"temperature": (y, "measurement"), "setpoint": (np.full(len(times), float(low + step)), "setpoint")}
    return time_plot(curves, times, "A step of the setpoint", "$t$ [min]", "temperature [°C]")


@two_peaks.mistake(
    "That is the overshoot, the first peak as a share of the step, or the trough behind it as a share of that peak. "
    "Which two heights does a decay ratio compare?"
)
def _(low, step, delay, left):
    first = _recorded(low, step, delay, left)[3][0]
    right = 100 * _recorded(low, step, delay, left)[3][2] / first
    return {"decay_ratio": 100 * first} if abs(100 * first / right - 1) > 0.25 else {}


@two_peaks.mistake("Heights are counted from the final value, not from where the temperature began.")
def _(low, step, delay, left):
    first, _, second = _recorded(low, step, delay, left)[3]
    return {"decay_ratio": 100 * (1 + second) / (1 + first)}


@two_peaks.mistake("That is from a peak to the trough behind it, a half turn. The next peak is another half turn away.")
def _(low, step, delay, left):
    moments = _recorded(low, step, delay, left)[2]
    return {"period": moments[1] - moments[0]}


@two_peaks.mistake("That is the frequency in rad/min. How long does one turn take?")
def _(low, step, delay, left):
    moments = _recorded(low, step, delay, left)[2]
    return {"period": 2 * math.pi / (moments[2] - moments[0])}


@two_peaks.mistake("That is when the first peak comes. The period is from there to the next one.")
def _(low, step, delay, left):
    moments = _recorded(low, step, delay, left)[2]
    return {"period": moments[0]} if abs(moments[0] / (moments[2] - moments[0]) - 1) > 0.12 else {}


@two_peaks.mistake("That is when the second peak comes. The period is counted from the first one.")
def _(low, step, delay, left):
    return {"period": _recorded(low, step, delay, left)[2][2]}


@two_peaks.mistake("That is the logarithm of the ratio. How does one get from it to a damping?")
def _(low, step, delay, left):
    first, _, second = _recorded(low, step, delay, left)[3]
    return {"zeta": math.log(first / second)}


@two_peaks.mistake("This damping belongs to a decay ratio of a quarter. Which one does the picture show?")
def _():
    return {"zeta": math.sqrt(_damping_squared(25, 2))}


@two_peaks.mistake("From peak to peak there are two half turns, and the angle is $2\\pi$.")
def _(low, step, delay, left):
    first, _, second = _recorded(low, step, delay, left)[3]
    return {"zeta": math.sqrt(_damping_squared(100 * second / first, 1))}


@two_peaks.mistake("That is the second peak as a share of the step. With what does a decay ratio compare it?")
def _(low, step, delay, left):
    return {"decay_ratio": 100 * _recorded(low, step, delay, left)[3][2]}


@two_peaks.mistake("A quarter is 25 %. Is more than that left of the first peak here, or less?")
def _(left):
    return {"gain": "lower" if left < 25 else "raise"}


two_peaks.hints(
    "A decay ratio compares heights above the *final value*. Draw that line first.",
    "With $\\ell = \\ln\\frac{1}{\\mathrm{decay\\ ratio}}$ the damping is $\\zeta = \\frac{\\ell}{\\sqrt{4\\pi^2 + "
    "\\ell^2}}$. A higher gain leaves more of a peak.",
    "The final value is the new setpoint, {step} above {low}. Measure how far the first and the second peak are above "
    "it, and divide the smaller height by the larger one.",
)


@two_peaks.solution
def _(low, step, delay, left):
    r"""The temperature ends at the new setpoint, {end}. The first peak is {first} above it, the second {second}. Their
    ratio is {decay_ratio}.

    The peaks are at {at_first} and {at_second}. The period is the difference, {period}.

    The logarithm of the ratio, $\ell$, is {logarithm}, and $\zeta = \frac{\ell}{\sqrt{4\pi^2 + \ell^2}}$ is {zeta}.

    For a quarter, 25 %, {gain} the gain: the higher the gain, the more is left of a peak.
    """
    _, _, moments, (first, _, second) = _recorded(low, step, delay, left)
    return {
        "end": (low + step, "°C"),
        "first": (float(step) * first, "K"),
        "second": (float(step) * second, "K"),
        "at_first": (moments[0], "min"),
        "at_second": (moments[2], "min"),
        "logarithm": math.log(first / second),
    }


@exercise(
    "16.9",
    title="A decay ratio with a dead time",
    points=5,
    insight="A loop with dead time has infinitely many poles; the first pair decides the decay, and can be placed "
    "exactly.",
)
def decay_with_dead_time(
    K=between(0.5, 4, "K/%", step=0.5, reference=1.5),
    T=between(10, 60, "min", step=2, reference=30),
    delay=between(2, 10, "min", step=0.5, reference=4),
    left=choice(10, 15, 20, 25, 30, unit="%", reference=25),
):
    r"""A dryer has the gain {K}, a lag $T$ of {T} and a dead time $\theta$ of {delay}. A PI controller with $T_i = T$
    cancels the lag, so that the open loop is $L(s) = \frac{k}{s}e^{-\theta s}$ with $k = KK_c/T$. The gain should be
    such that {left} of each peak is left in the next one.

    That belongs to the first pair of poles, $s = -\sigma \pm j\omega$. Put it into $s + k\,e^{-\theta s} = 0$, once
    for the real part and once for the imaginary part. What gain $K_c$ does the controller have, what is the
    period of the oscillation, and what is the gain margin of the loop?
    """
    x, omega = _with_decay(left)
    return answers(
        Kc=number(x * float(T / (K * delay)), "%/K", "the gain of the controller"),
        period=number(2 * math.pi * float(delay) / omega, "min", "the period of the oscillation"),
        gain_margin=number(math.pi / 2 / x, "", "the gain margin"),
    )


def _all_three(x, omega, K, T, delay):
    return {
        "Kc": x * float(T / (K * delay)),
        "period": 2 * math.pi * float(delay) / omega,
        "gain_margin": math.pi / 2 / x,
    }


@decay_with_dead_time.mistake(
    "That ratio is reached after a half turn already. From peak to peak the angle is $2\\pi$."
)
def _(K, T, delay, left):
    return _all_three(*_with_decay(float(left) ** 2 / 100), K, T, delay)


@decay_with_dead_time.mistake("That comes from a lag in place of the dead time, and such a loop would be unstable.")
def _(K, T, delay, left):
    return {"Kc": float(T / (K * delay)) / (4 * _damping_squared(left, 2))}


@decay_with_dead_time.mistake(
    "At the pole, $e^{-\\theta s}$ is not only a turn: with $-\\sigma$ it is larger than one."
)
def _(K, T, delay, left):
    _, omega = _with_decay(left)
    x = omega / math.sin(omega)
    return {"Kc": x * float(T / (K * delay))}


@decay_with_dead_time.mistake("That is the gain $k$ of the open loop. Which part of it belongs to the controller?")
def _(delay, left):
    return {"Kc": _with_decay(left)[0] / float(delay)}


@decay_with_dead_time.mistake("That is the period at the limit of stability. This loop is calmer, and slower.")
def _(delay):
    return {"period": 4 * delay}


@decay_with_dead_time.mistake("The phase is $-180°$ at $\\omega\\theta = \\pi/2$: what is $|L|$ there?")
def _(left):
    return {"gain_margin": 1 / _with_decay(left)[0]}


@decay_with_dead_time.mistake(
    "That is $k\\theta$, a pure number. Which factors lead from it to the gain of the controller?"
)
def _(K, T, delay, left):
    x = _with_decay(left)[0]
    return {"Kc": x} if abs(float(T / (K * delay)) - 1) > 0.05 else {}


@decay_with_dead_time.mistake("That belongs to a decay ratio of a quarter. Which ratio is asked here?")
def _(K, T, delay, left):
    return _all_three(*_with_decay(25), K, T, delay) if left != 25 else {}


@decay_with_dead_time.mistake(
    "That is $|L|$ where the phase is $-180°$. By which factor may the gain grow until it is one?"
)
def _(left):
    return {"gain_margin": _with_decay(left)[0] * 2 / math.pi}


@decay_with_dead_time.mistake("That is the frequency in rad/min. How long does one turn take?")
def _(delay, left):
    return {"period": _with_decay(left)[1] / float(delay)}


@decay_with_dead_time.mistake(
    "That is $\\omega\\theta$, an angle. Which time makes a frequency of it, and that a period?"
)
def _(delay, left):
    return {"period": _with_decay(left)[1]}


decay_with_dead_time.hints(
    "The poles of the loop are where $1 + L(s) = 0$. The decay ratio fixes the quotient of $\\sigma$ and $\\omega$.",
    "From peak to peak, $e^{-\\sigma t}$ falls to $e^{-2\\pi\\sigma/\\omega}$. The two parts of $s = -k\\,e^{-\\theta "
    "s}$ are $\\sigma = k e^{\\sigma\\theta}\\cos\\omega\\theta$ and $\\omega = k "
    "e^{\\sigma\\theta}\\sin\\omega\\theta$. Divide one by the other.",
    "So $\\tan\\omega\\theta = \\frac{\\omega}{\\sigma} = \\frac{2\\pi}{\\ln(100/{left})}$, which gives "
    "$\\omega\\theta$, and then $\\sigma\\theta$. What is $k\\theta$ then?",
)


@decay_with_dead_time.solution
def _(left):
    r"""From one peak to the next, $e^{-\sigma t}$ falls to $e^{-2\pi\sigma/\omega}$, which should be {left}. So
    $\frac{\omega}{\sigma} = \frac{2\pi}{\ln(100/{left})}$, which is {quotient}.

    The pole is a solution of $s = -k\,e^{-\theta s}$. Real and imaginary part: $\sigma = k
    e^{\sigma\theta}\cos\omega\theta$ and $\omega = k e^{\sigma\theta}\sin\omega\theta$. The quotient of the two is
    $\tan\omega\theta$. So $\omega\theta$ is {turn} rad, and $\sigma\theta$ is {fall}.

    The imaginary part gives the gain: $k\theta = \frac{\omega\theta}{\sin\omega\theta}\,e^{-\sigma\theta}$, which is
    {x}. With $k = KK_c/T$ the controller has $K_c = \frac{{T}}{K\theta}\,k\theta = \frac{ {T} }{ {K} \cdot {delay} }
    \cdot {x}$: {Kc}.

    The period is $\frac{2\pi}{\omega} = \frac{2\pi\theta}{\omega\theta}$, that is {period}.

    At $\omega\theta = \pi/2$ the phase is $-180°$, and there $|L| = \frac{2k\theta}{\pi}$. One over it is the gain
    margin, {gain_margin}.
    """
    x, omega = _with_decay(left)
    return {"quotient": math.tan(omega), "turn": omega, "fall": omega / math.tan(omega), "x": x}


@decay_with_dead_time.solution_picture
def _(K, T, delay, left):
    """The response of the loop to a unit step of the setpoint, with its first two peaks."""
    x, omega = _with_decay(left)
    period = 2 * math.pi * float(delay) / omega
    times = _until(3 * period)
    y = Loop(K * exp(-delay * s) / (T * s + 1), PID(x * float(T / (K * delay)), T)).servo.step(times)
    first = float(times[np.argmax(y)])
    plot = time_plot({"$y$": (y, "measurement")}, times, "A unit step of the setpoint", "$t$ [min]", "$y$ [K]")
    return plot.mark(first, "first peak").mark(first + period, "second peak").level(1, "setpoint")
