"""Exercises of chapter 5, transfer functions."""

import numpy as np
from sympy import Symbol, exp, symbols

from loopbook import diagrams
from loopbook.exercises.authoring import (
    answers,
    between,
    choice,
    criterion,
    design,
    exercise,
    expression,
    number,
    poles,
    time_function,
    transfer_function,
    word,
)
from loopbook.expressions import s, t
from loopbook.figures import plane_plot, time_plot
from loopbook.transfer import step_response


@exercise(
    "5.1",
    title="A stirrer and its load",
    points=2,
    insight="The pole belongs to the machine, not to what acts on it: both inputs meet the same inertia and the same "
    "friction.",
)
def stirrer(
    J=between(0.2, 2, "kg m²", reference=0.6, step=0.1),
    k=between(0.5, 4, "N m/V", reference=1.5, step=0.25),
    b=between(0.1, 0.8, "N m s", reference=0.2, step=0.05),
):
    r"""The speed $\omega(t)$ [rad/s] of a stirrer rises with the voltage $u(t)$ [V] of its motor. Friction and the
    torque $M(t)$ [N m] of the thick liquid brake it:

    $$J\,\dot\omega(t) = k\,u(t) - b\,\omega(t) - M(t)$$

    Here $J$ = {J}, $k$ = {k} and $b$ = {b}. Find the transfer functions from the voltage and from the torque to the
    speed, and the pole that they share. (In the transfer functions leave the units out; the time is in seconds.)
    """
    return answers(
        H_u=transfer_function(k / (J * s + b), "the transfer function from the voltage"),
        H_M=transfer_function(-1 / (J * s + b), "the transfer function from the torque"),
        pole=number(-b / J, "1/s", "the pole"),
    )


@stirrer.mistake("The friction is missing: it depends on the speed, so it belongs on the left side of the equation.")
def _(J, k):
    return {"H_u": k / (J * s), "H_M": -1 / (J * s), "pole": 0}


@stirrer.mistake("Only the voltage is multiplied by $k$. What is the torque multiplied by in the equation?")
def _(J, k, b):
    return {"H_M": -k / (J * s + b)} if k != 1 else {}


@stirrer.mistake("The friction term changes sign when it moves to the left side.")
def _(J, k, b):
    return {"H_u": k / (J * s - b), "H_M": -1 / (J * s - b)}


@stirrer.mistake("That is the time constant. The pole is the root of the denominator.")
def _(J, b):
    return {"pole": J / b} if b != J else {}


@stirrer.mistake("Inertia and friction are interchanged: which of the two is multiplied by the derivative?")
def _(J, k, b):
    return {"H_u": k / (b * s + J), "H_M": -1 / (b * s + J)} if b != J else {}


@stirrer.mistake("That is minus the time constant. For which $s$ is the denominator zero?")
def _(J, b):
    return {"pole": -J / b} if b != J else {}


@stirrer.mistake("The voltage is multiplied by $k$ in the equation. What becomes of it?")
def _(J, k, b):
    return {"H_u": 1 / (J * s + b)} if k != 1 else {}


@stirrer.mistake("Here a part of the equation was divided by $J$. All of its terms must be.")
def _(J, k, b):
    return {"H_u": k / (s + b / J), "H_M": -1 / (s + b / J)} if J != 1 else {}


@stirrer.mistake("Does more torque make the stirrer faster or slower?")
def _(J, k, b):
    return {"H_M": 1 / (J * s + b)}


stirrer.hints(
    "A transfer function is the transform of the output over that of one input, from rest, with the other input zero.",
    r"From rest, the derivative becomes a factor $s$: $J s\,\Omega = k\,U - b\,\Omega - M$. Bring the friction to the "
    r"left, and divide by what multiplies $\Omega$.",
    r"With the numbers, $({J} s + {b})\,\Omega(s) = {k}\,U(s) - M(s)$. The pole is where the bracket is zero.",
)


@stirrer.solution
def _(J, k, b):
    r"""From rest, a derivative becomes a factor $s$, so the equation is

    $${J} s\,\Omega(s) = {k}\,U(s) - {b}\,\Omega(s) - M(s)$$

    The friction depends on the speed, so it belongs to the left side: $({J} s + {b})\,\Omega = {k}\,U - M$.

    ***

    Divide by the bracket. What each input is multiplied by is its transfer function:

    $$H_u(s) = {H_u}, \qquad H_M(s) = {H_M}$$

    Both have the same denominator. Its root is the pole, $s = -{b}/{J} =$ {pole}.
    """
    return {"H_u": k / (J * s + b), "H_M": -1 / (J * s + b)}


@stirrer.solution_picture
def _(J, k, b):
    """The diagram: the voltage times the gain, minus the torque, through one lag to the speed."""
    lag = diagrams.block(rf"\frac{{1}}{{{float(J):g} s + {float(b):g}}}")
    return diagrams.block_diagram(
        "u", diagrams.gain(f"{float(k):g}"), diagrams.disturbance("M", sign="-"), lag, r"\omega"
    )


@exercise(
    "5.2",
    title="What the fraction tells",
    points=3,
    insight="A fraction tells its story at both ends: $s = 0$ is the end of the response, large $s$ its beginning.",
    where=lambda p, q, z: p != q and z not in (-p, -q),
)
def fraction(
    K=between(1, 6, reference=3, step=1),
    z=choice(-6, -5, -4, -3, -2, -1, 1, 2, 3, 4, 5, 6, reference=2),
    p=between(1, 5, reference=1, step=1),
    q=between(2, 8, reference=4, step=1),
    scale=choice(2, 4, 5, reference=2),
):
    """A system has the transfer function

    $H(s) =$ {H}

    with the time in seconds. Factor it. Give its poles and its zero, the gain $K$ of the zero-pole form
    $K\\,(s - z)/((s - p_1)(s - p_2))$, and the static gain. Does the step response set out towards its final value, or
    away from it?
    """
    return answers(
        poles=poles([-p, -q], "1/s", "the poles"),
        zeros=poles([z], "1/s", "the zero"),
        K=number(K, "", "the gain of the zero-pole form"),
        H_s=number(-K * z / (p * q), "", "the static gain"),
        sets_out=word(
            "away" if z > 0 else "towards", ["towards", "away"], "the direction in which the response sets out"
        ),
    )


@fraction.mistake(
    "In the zero-pole form each factor begins with $s$ alone. What is the factor of $s^2$ in the denominator?"
)
def _(K, scale):
    return {"K": K * scale}


@fraction.mistake("That is the gain of the other form: one of them belongs to $s = 0$, and one to large $s$.")
def _(K, z, p, q):
    return {"K": -K * z / (p * q), "H_s": K} if z != -p * q else {}


@fraction.mistake("At $s = 0$ the denominator is not one. Divide by what is left of it.")
def _(K, z, scale):
    return {"H_s": -scale * K * z}


@fraction.mistake("At $s = 0$ the denominator is not one. Divide by what is left of it.")
def _(K, z):
    return {"H_s": -K * z} if z != -1 else {}


@fraction.mistake(
    "Which sign has the response in the first moment, that of $K$, and which one in the end, that of $H(0)$?"
)
def _(z):
    return {"sets_out": "towards" if z > 0 else "away"}


@fraction.mistake("Look at the sign: a zero is a value of $s$ that makes the numerator zero.")
def _(z):
    return {"zeros": [-z]}


@fraction.mistake(
    "Divide by the factor of $s^2$ first: then two numbers are sought with the sum and the product that are left."
)
def _(p, q, scale):
    return {"poles": [-scale * p, -scale * q]}


@fraction.mistake("In the numerator, too, the factor of $s$ is not one. Where is the numerator zero?")
def _(K, z, scale):
    return {"zeros": [scale * K * z]} if scale * K != 1 else {}


@fraction.mistake("These are the roots of the numerator. Which of the two parts has the poles?")
def _(z):
    return {"poles": [z]}


@fraction.mistake("These are the roots of the denominator. Which of the two parts has the zeros?")
def _(p, q):
    return {"zeros": [-p, -q]}


@fraction.mistake("Put them into the denominator: is it zero there? Watch the signs.")
def _(p, q):
    return {"poles": [p, q]}


@fraction.mistake("At $s = 0$ only one of numerator and denominator was divided by {scale} here.")
def _(K, z, p, q, scale):
    return {"H_s": -scale * K * z / (p * q)}


fraction.hints(
    "Poles are the roots of the denominator, zeros those of the numerator. The static gain is the value at $s = 0$.",
    "First divide numerator and denominator by the factor of $s^2$. For the beginning of the step response look at "
    r"large $s$: there $H(s) \approx K/s$, so the response sets out with the slope $K$.",
    r"After the division the denominator is $s^2 + {sum}\,s + {product}$. Which two numbers have this sum and this "
    "product?",
)


@fraction.shows
def _(K, z, p, q, scale):
    H = (scale * K * s - scale * K * z) / (scale * s**2 + scale * (p + q) * s + scale * p * q)
    return {"H": H, "sum": p + q, "product": p * q}


@fraction.solution
def _(K, z, p, q, scale):
    r"""Divide above and below by {scale}, so that the denominator begins with $s^2$, and factor it:

    $$H(s) = {factored}$$

    So the poles are $-{p}$ and $-{q}$, the zero is ${z}$ (all in 1/s), and the gain of the zero-pole form is $K =$ {K}.

    The static gain is $H(0) = {K} \cdot \frac{ {minus_z} }{ {p} \cdot {q} } =$ {H_s}.

    For large $s$ the fraction is about $K/s$, so the step response sets out with the slope {K}, and it ends at {H_s}.
    The two signs are {compared}, so the response sets out {sets_out} its final value.
    """
    away = z > 0
    return {
        "factored": rf"\frac{{ {K}\,(s {'-' if z > 0 else '+'} {abs(z)}) }}{{ (s + {p})(s + {q}) }}", "minus_z": -z,
        "compared": "different" if away else "the same", "sets_out": "away from" if away else "towards",
    }  # fmt: skip


@fraction.solution_picture
def _(K, z, p, q):
    """The step response with its final value."""
    y = step_response(K * (s - z) / ((s + p) * (s + q)))
    times = np.linspace(0, 6 / float(min(p, q)), 201)
    return time_plot({"$y$": (y, "measurement")}, times, low=True).level(-K * z / (p * q), "static gain")


@exercise(
    "5.3",
    title="A force sensor that creeps",
    points=4,
    insight="As many zeros as poles, and the output jumps with the input: the sensor is quick to react and slow to be "
    "right.",
    where=lambda T, T_0: 4 * T_0 <= 3 * T and abs(2 * T_0 - T) >= T / 10,
)
def creeping_sensor(
    K=between(0.2, 1.2, "mV/N", reference=0.5, step=0.1),
    T=between(20, 80, "s", reference=40, step=5),
    T_0=between(8, 60, "s", reference=30, step=2),
    U=between(10, 60, "N", reference=20, step=5),
):
    """A force sensor is glued to a beam. It reacts at once, but then the glue creeps, and the signal goes on rising for
    a while. From the force [N] to the signal [mV] its transfer function is

    $H(s) =$ {H}

    with the time in seconds. At $t = 0$ a force of {U} is put on. Find the signal just after that, its final value, and
    the signal as a function of time.
    """
    return answers(
        y_0=number(K * U * T_0 / T, "mV", "the signal just after the step"),
        y_s=number(K * U, "mV", "the final value"),
        y=time_function(K * U * (1 - (1 - T_0 / T) * exp(-t / T)), 4 * T, "mV", "the signal"),
    )


@creeping_sensor.shows
def _(K, T, T_0):
    return {"H": K * (T_0 * s + 1) / (T * s + 1)}


@creeping_sensor.mistake(
    "Large $s$ belongs to the beginning of the response, and $s = 0$ to its end: which of the two have you taken?"
)
def _(K, T, T_0, U):
    return {"y_0": K * U, "y_s": K * U * T_0 / T, "y": K * U * (T_0 / T + (1 - T_0 / T) * exp(-t / T))}


@creeping_sensor.mistake("That is right for a step of one newton. How high is this step?")
def _(K, T, T_0, U):
    unit = K * (1 - (1 - T_0 / T) * exp(-t / T))
    return {"y_0": K * T_0 / T, "y_s": K, "y": unit}


@creeping_sensor.mistake(
    "What does your signal begin with? Compare its value at $t = 0$ with that just after the step."
)
def _(K, T, T_0, U):
    return {"y": K * U * (1 - T_0 / T * exp(-t / T))}


@creeping_sensor.mistake("Beginning and end are right. Which time constant belongs to the pole?")
def _(K, T, T_0, U):
    return {"y": K * U * (1 - (1 - T_0 / T) * exp(-t / T_0))}


@creeping_sensor.mistake(
    "That is the response of the denominator alone. The numerator makes the sensor react immediately."
)
def _(K, T, U):
    return {"y": K * U * (1 - exp(-t / T))}


@creeping_sensor.mistake(
    "Your signal has the right beginning, but its exponential should fade and leave the final value."
)
def _(K, T, T_0, U):
    return {"y": K * U * T_0 / T * exp(-t / T)}


H_1, H_2, H_3, H_4 = symbols("H_1 H_2 H_3 H_4")


def _network(signal, sign, h_1=H_1, h_2=H_2, h_3=H_3, h_4=H_4):
    """From u to y: e = u - y, v = H_1*e + sign*H_3*(y or v), y = H_2*v + H_4*u."""
    if signal == "y":
        return (h_1 * h_2 + h_4) / (1 + h_1 * h_2 - sign * h_2 * h_3)
    return (h_1 * h_2 + h_4 * (1 - sign * h_3)) / (1 + h_1 * h_2 - sign * h_3)


_SIGNS = {"-": -1, "+": 1}


@creeping_sensor.mistake("Without a jump it would begin there. What does $H(s)$ become for large $s$?")
def _():
    return {"y_0": 0}


@creeping_sensor.mistake("For large $s$ there is a factor of $s$ below the fraction line, too.")
def _(K, T_0, U):
    return {"y_0": K * U * T_0}


@creeping_sensor.mistake("That is the response to an impulse. What is the transform of a step?")
def _(K, T, T_0, U):
    return {"y": K * U * (1 - T_0 / T) / T * exp(-t / T)}


@creeping_sensor.mistake("A longer time constant makes the exponential fade more slowly. Does yours?")
def _(K, T, T_0, U):
    return {"y": K * U * (1 - (1 - T_0 / T) * exp(-T * t))}


@creeping_sensor.mistake("The ratio is upside down: which of the two coefficients of $s$ is above the fraction line?")
def _(K, T, T_0, U):
    return {"y_0": K * U * T / T_0}


creeping_sensor.hints(
    "Large $s$ belongs to the beginning of a response, $s = 0$ to its end.",
    r"For a step of height $U$, the response begins at $U \cdot \lim_{s\to\infty} H(s)$ and ends at $U \cdot H(0)$. A "
    "system of first order goes from the one to the other along an exponential with the time constant of its pole.",
    r"The signal ends at ${K} \cdot {U}$ mV. It begins at the ratio of the two coefficients of $s$, times {U}. Then "
    r"$y = y_s + (y_0 - y_s)\,e^{-t/{T}}$.",
)


@creeping_sensor.solution
def _(K, T, T_0, U):
    r"""For large $s$ only the terms with $s$ count, and the fraction is $\frac{ {above} }{ {T} } =$ {first}. So
    just after the step the signal is ${first} \cdot {U} =$ {y_0}.

    At $s = 0$ the fraction is {K}, so the signal ends at ${K} \cdot {U} =$ {y_s}.

    There is one pole, at $-1/{T}$, and so one exponential, $e^{-t/{T}}$. The signal goes from {y_0} to {y_s} along it:

    $$y(t) = {y_s} + ({y_0} - {y_s})\,e^{-t/{T}} = {y}\quad\text{in mV}$$
    """
    y_0, y_s = K * U * T_0 / T, K * U
    return {"above": K * T_0, "first": (K * T_0 / T, "mV/N"), "y": y_s - (y_s - y_0) * exp(-t / T)}


@creeping_sensor.solution_picture
def _(K, T, T_0, U):
    """The signal after the step: it jumps, and then creeps to its final value."""
    y = K * U * (1 - (1 - T_0 / T) * exp(-t / T))
    plot = time_plot({"signal [mV]": (y, "measurement")}, np.linspace(0, 5 * float(T), 201), low=True)
    return plot.level(K * U, "final value")


@exercise(
    "5.4",
    title="Two loops and a bypass",
    points=4,
    insight="In words: direct over one plus the loop, from the inside out; what enters within a loop is fed back as "
    "well.",
    where=lambda signal, sign, k_2, k_3: sign == "-" or (k_2 * k_3 if signal == "y" else k_3) < 0.8,
)
def two_loops(
    signal=choice("y", "v", reference="y"),
    sign=choice("-", "+", reference="-"),
    k_1=between(1, 8, reference=4, step=0.5),
    k_2=between(0.5, 3, reference=2, step=0.25),
    k_3=between(0.3, 1.5, reference=0.5, step=0.1),
    k_4=between(0.4, 2, reference=1, step=0.2),
):
    r"""Four blocks are connected in a diagram with the input $u(s)$ and the output $y(s)$:

    - $e = u - y$
    - {inner}
    - $y = H_2\,v + H_4\,u$

    Draw the diagram, and reduce it to one block: give $y(s)/u(s)$ in the symbols $H_1$, $H_2$, $H_3$ and $H_4$. Which
    static gain does it have if the static gains of the four blocks are {k_1}, {k_2}, {k_3} and {k_4}?
    """
    sense = _SIGNS[sign]
    return answers(
        M=expression(_network(signal, sense), "the transfer function from $u$ to $y$"),
        M_s=number(_network(signal, sense, k_1, k_2, k_3, k_4), "", "its static gain"),
    )


@two_loops.shows
def _(signal, sign):
    return {"inner": f"$v = H_1\\,e {sign} H_3\\,{signal}$"}


@two_loops.mistake("The inner loop around $H_3$ is missing in the denominator.")
def _(signal, sign, k_1, k_2, k_3, k_4):
    return _with_gains((H_1 * H_2 + H_4) / (1 + H_1 * H_2), k_1, k_2, k_3, k_4, signal, sign)


@two_loops.mistake("Look again at the sign of the inner loop: is the feedback added or subtracted?")
def _(signal, sign, k_1, k_2, k_3, k_4):
    return _with_gains(_network(signal, -_SIGNS[sign]), k_1, k_2, k_3, k_4, signal, sign)


@two_loops.mistake("You have left out the bypass through $H_4$.")
def _(signal, sign, k_1, k_2, k_3, k_4):
    return _with_gains(_network(signal, _SIGNS[sign], h_4=0), k_1, k_2, k_3, k_4, signal, sign)


@two_loops.mistake(
    "What comes through $H_4$ is fed back as well: it is a part of $y$, so that it is inside the outer loop."
)
def _(signal, sign, k_1, k_2, k_3, k_4):
    return _with_gains(_network(signal, _SIGNS[sign], h_4=0) + H_4, k_1, k_2, k_3, k_4, signal, sign)


def _with_gains(M, k_1, k_2, k_3, k_4, signal, sign):
    """A wrong transfer function with its static gain, if that is not near the right one by chance."""
    above, below = M.subs({H_1: k_1, H_2: k_2, H_3: k_3, H_4: k_4}).as_numer_denom()
    right = _network(signal, _SIGNS[sign], k_1, k_2, k_3, k_4)
    by_chance = below == 0 or not above.is_finite or abs(above / below / right - 1) < 0.02
    return {"M": M} if by_chance else {"M": M, "M_s": above / below}


def _range(K, T, share, T_max, u_max, step):
    """The least and the largest gain of the feedback in exercise 5.5."""
    least = max(share / (100 - share) / K, (T / T_max - 1) / K)
    return least, u_max / step


@two_loops.mistake("Where does the signal of $H_3$ enter: before $H_1$, or after it?")
def _(signal, sign, k_1, k_2, k_3, k_4):
    return _with_gains(_network(signal, _SIGNS[sign], h_3=H_1 * H_3), k_1, k_2, k_3, k_4, signal, sign)


@two_loops.mistake("In $e = u - y$ the output is subtracted. Which sign has the outer loop in the denominator?")
def _(signal, sign, k_1, k_2, k_3, k_4):
    above, below = _network(signal, _SIGNS[sign]).as_numer_denom()
    return _with_gains(above / (below - 2 * H_1 * H_2), k_1, k_2, k_3, k_4, signal, sign)


@two_loops.mistake("Where does the bypass enter: before $H_2$, or after it?")
def _(signal, sign, k_1, k_2, k_3, k_4):
    return _with_gains(_network(signal, _SIGNS[sign], h_4=H_2 * H_4), k_1, k_2, k_3, k_4, signal, sign)


@two_loops.mistake("There are two loops. Which one does $e = u - y$ close?")
def _(signal, sign, k_1, k_2, k_3, k_4):
    above, below = _network(signal, _SIGNS[sign]).as_numer_denom()
    return _with_gains(above / (below - H_1 * H_2), k_1, k_2, k_3, k_4, signal, sign)


@two_loops.mistake("In the denominator something is missing that has no symbol: direct over *one* plus the loops.")
def _(signal, sign, k_1, k_2, k_3, k_4):
    above, below = _network(signal, _SIGNS[sign]).as_numer_denom()
    return _with_gains(above / (below - 1), k_1, k_2, k_3, k_4, signal, sign)


@two_loops.mistake("Which of the gains belongs to which block? Two of them are interchanged.")
def _(signal, sign, k_1, k_2, k_3, k_4):
    sense = _SIGNS[sign]
    right, wrong = (_network(signal, sense, k_1, k_2, *gains) for gains in ((k_3, k_4), (k_4, k_3)))
    return {"M_s": wrong} if abs(wrong / right - 1) > 0.02 else {}


@two_loops.mistake("Does a loop that subtracts add its loop gain to the one in the denominator, or take it away?")
def _(signal, sign, k_1, k_2, k_3, k_4):
    above, below = _network(signal, _SIGNS[sign]).as_numer_denom()
    return _with_gains(above / (2 - below), k_1, k_2, k_3, k_4, signal, sign)


two_loops.hints(
    "Each block multiplies. Write every signal in terms of the others, then eliminate all but $u$ and $y$.",
    "Put $e$ into the equation of $v$, and that into the equation of $y$. Or by the rules: the inner loop is direct "
    "over one plus its loop if it subtracts, and over one minus its loop if it adds; it is then one block of the outer "
    "loop.",
    r"Here {inner}. Put $e = u - y$ into it, and then $v$ into $y = H_2\,v + H_4\,u$: collect what is multiplied by "
    "$y$ on the left, and what is multiplied by $u$ on the right.",
)


@two_loops.solution
def _(signal, sign, k_1, k_2, k_3, k_4):
    r"""Begin with {inner}, and put $e = u - y$ into it.{solved} Then $y = H_2 v + H_4 u$ becomes

    $$y = {y}$$

    Collect $y$ on the left and $u$ on the right, and divide:

    $$\frac{{y}}{u} = {M}$$

    For the static gain each block is its own static gain, {k_1}, {k_2}, {k_3} and {k_4}:
    $M(0) = \frac{ {above} }{ {below} } =$ {M_s}.
    """
    M = _network(signal, _SIGNS[sign])
    u, y = symbols("u y")
    sense = _SIGNS[sign]
    v = H_1 * (u - y) + sense * H_3 * y if signal == "y" else H_1 * (u - y) / (1 - sense * H_3)
    k_1, k_2, k_3, k_4 = (f"{float(k):g}" for k in (k_1, k_2, k_3, k_4))
    minus, by_bypass = "-" if sense > 0 else "+", k_4
    around = f"{k_2} \\cdot {k_3}" if signal == "y" else k_3
    if signal == "v":
        by_bypass += f" \\cdot (1 {minus} {k_3})"
    by_itself = f" There is $v$ on both sides; solved for it, $v = \\frac{{H_1 (u - y)}}{{1 {minus} H_3}}$."
    return {
        "M": M,
        "y": H_2 * v + H_4 * u,
        "solved": by_itself if signal == "v" else "",
        "above": f"{k_1} \\cdot {k_2} + {by_bypass}",
        "below": f"1 + {k_1} \\cdot {k_2} {minus} {around}",
    }


@two_loops.solution_picture
def _(signal, sign):
    """The block diagram with the two loops and the bypass."""
    if signal == "y":
        layout = """
            .  6  .  .    .     H_4  7    .  .
            u  5  e  H_1  add   H_2  out  4  y
            .  .  .  .    8     H_3  .    3  .
            .  .  1  .    .     .    .    2  ."""
        ways = "u 5 e H_1 add H_2 out 4 y, 4 3 H_3 8"
    else:
        layout = """
            .  6  .  .    .    .  .  H_4  7    .  .
            u  5  e  H_1  add  v  4  H_2  out  3  y
            .  .  .  .    8    H_3  9  .  .    .  .
            .  .  1  .    .    .  .  .    .    2  ."""
        ways = "u 5 e H_1 add v 4 H_2 out 3 y, 4 9 H_3 8"
    wires = f"{ways} {sign} add, 5 6 H_4 7 out, 3 2 1 - e"
    return diagrams.grid_diagram(layout, wires, {name: name for name in ("H_1", "H_2", "H_3", "H_4")})


@exercise(
    "5.5",
    title="A hot plate becomes faster",
    points=5,
    insight="Feedback makes a lag faster by one plus the loop gain; the price is paid in power, in the very first "
    "moment.",
    where=lambda K, T, share, T_max, u_max, step: (
        1.15 <= _range(K, T, share, T_max, u_max, step)[1] / _range(K, T, share, T_max, u_max, step)[0] <= 2.5
    ),
)
def hot_plate(
    K=between(40, 120, "K/kW", reference=80, step=10),
    T=between(120, 600, "s", reference=300, step=20),
    share=choice(80, 85, 90, reference=90, unit="%"),
    T_max=between(20, 60, "s", reference=40, step=5),
    u_max=between(1, 6, "kW", reference=3, step=0.5),
    step=between(10, 40, "K", reference=20, step=5),
):
    r"""A hot plate follows the power $u$ [kW] of its heater with a gain of {K} and a time constant of {T}; its output
    $y$ is its temperature above that of the room. To make it faster, the temperature is compared with a wanted one,
    $r$, and the heater gets $u = K_c\,(r - y)$.

    Give the transfer function from $r$ to $y$, in $s$ and the symbol $K_c$, with the numbers of the plate. Then choose
    $K_c$ for a step of {step} in $r$, from rest: in the end the plate should be at {share} of the step or more, the
    time constant of the whole must not exceed {T_max}, and the power must not exceed {u_max}. (When is it largest?)
    """
    K_c = Symbol("K_c", positive=True)
    least, largest = _range(K, T, share, T_max, u_max, step)

    def measured(of):
        return lambda gain: of(float(gain))

    return answers(
        M=transfer_function(K_c * K / (T * s + 1 + K_c * K), "the transfer function from $r$ to $y$"),
        K_c=design(
            number(float(f"{float(least + largest) / 2:.2g}"), "kW/K", "the gain of the feedback"),
            criterion("the loop is stable", lambda gain: 1 + float(gain) * float(K) > 0),
            criterion("the share of the step that is reached", measured(_reached(K)), above=share, unit="%"),
            criterion("the time constant", measured(_time_constant(K, T)), below=T_max, unit="s"),
            criterion("the largest power", measured(lambda gain: gain * float(step)), below=u_max, unit="kW"),
            draws=lambda gain: _plate_and_heater(float(gain), *map(float, (K, T, share, T_max, u_max, step))),
        ),
    )


def _reached(K):
    return lambda gain: 100 * gain * float(K) / (1 + gain * float(K))


def _time_constant(K, T):
    return lambda gain: float(T) / (1 + gain * float(K))


@hot_plate.mistake("That is the path from $r$ to $y$ without its loop: the rule for feedback has a denominator.")
def _(K, T):
    return {"M": Symbol("K_c", positive=True) * K / (T * s + 1)}


@hot_plate.mistake(
    "The temperature is subtracted from the wanted one. Which sign does the loop have in the denominator?"
)
def _(K, T):
    K_c = Symbol("K_c", positive=True)
    return {"M": K_c * K / (T * s + 1 - K_c * K)}


@hot_plate.mistake("In the numerator is the path from $r$ to $y$. It passes through $K_c$, too.")
def _(K, T):
    K_c = Symbol("K_c", positive=True)
    return {"M": K / (T * s + 1 + K_c * K)}


def _plate_and_heater(gain, K, T, share, T_max, u_max, step):
    """Temperature and power after the step, with what is demanded of them."""
    rate = (1 + gain * K) / T or 1e-9  # the gain of minus one over K leaves an integrator
    times = np.linspace(0, 4 * T_max, 301)
    y = step * gain * K / T * (1 - np.exp(-np.maximum(rate * times, -50))) / rate
    panels = [{"$y$": (y, "measurement")}, {"$u$": (gain * (step - y), 0)}]
    plot = time_plot(
        panels,
        times,
        "The plate in your loop",
        ylabel=["$y$ [K]", "$u$ [kW]"],
        ylim=[(-0.2 * step, 1.4 * step), (0, 2 * u_max)],
        low=True,
    )
    plot.level(share / 100 * step, "at least, in the end", "$y$").level(u_max, "at most", "$u$")
    return plot.event(T_max, "63 % of its way by then")


@hot_plate.mistake(
    "That would be the gain without a loop. With feedback the share is a loop gain over one plus that loop gain."
)
def _(K, share):
    return {"K_c": share / 100 / K}


@hot_plate.mistake("This power is computed from the error that is left in the end. When is the error largest?")
def _(share, u_max, step):
    return {"K_c": u_max / step / (1 - share / 100)}


@hot_plate.mistake(
    "This is the whole loop gain. Which part of it is the gain of the feedback, and which one that of the plate?"
)
def _(T, T_max):
    return {"K_c": T / T_max - 1}


@hot_plate.mistake("This is a loop gain, and the plate has a part in it. How much is left for the feedback?")
def _(share):
    return {"K_c": share / (100 - share)}


@hot_plate.picture
def _(K, T):
    """The loop: the gain of the feedback and the plate, a lag, with the temperature fed back."""
    plate = diagrams.block(rf"\frac{{{float(K):g}}}{{{float(T):g} s + 1}}")
    return diagrams.block_diagram("r", diagrams.feedback_loop(["e", diagrams.gain("K_c"), "u", plate]), "y")


hot_plate.hints(
    "The rule for feedback is direct over one plus the loop. What comes out is a lag again, with a smaller time "
    "constant.",
    r"With $G = K/(Ts + 1)$ it is $\frac{K_c G}{1 + K_c G} = \frac{K_c K}{Ts + 1 + K_c K}$: divide by the constant "
    r"term to read off gain and time constant. The power $K_c\,(r - y)$ is largest in the first moment, when $y = 0$.",
    r"So you need $\frac{ {K} K_c}{1 + {K} K_c} \ge \frac{ {share} }{100}$ and $\frac{ {T} }{1 + {K} K_c} \le "
    r"{T_max}$ from below, and ${step}\,K_c \le {u_max}$ from above.",
)


@hot_plate.solution
def _(K, T, share, T_max, u_max, step):
    r"""In the loop, the plate gives direct over one plus the loop:

    $$\frac{y}{r} = \frac{K_c \cdot \frac{ {K} }{ {T} s + 1} }{1 + K_c \cdot \frac{ {K} }{ {T} s + 1} } = {M}$$

    Divided by the constant term of the denominator it is a lag with the gain $\frac{ {K} K_c}{1 + {K} K_c}$ and the
    time constant $\frac{ {T} }{1 + {K} K_c}$.

    - In the end at {share} or more: ${K} K_c \ge \frac{ {share} }{100 - {share} }$, so $K_c \ge$ {for_share}.
    - A time constant of {T_max} or less: $1 + {K} K_c \ge \frac{ {T} }{ {T_max} }$, so $K_c \ge$ {for_speed}.
    - The power is largest in the first moment, when the plate is still cold: $u(0) = K_c\,r$. So
      $K_c \le \frac{ {u_max} }{ {step} } =$ {at_most}.

    Any gain between the larger one of the first two and the third will do, for example $K_c =$ {K_c}.
    """
    return {
        "M": Symbol("K_c") * K / (T * s + 1 + Symbol("K_c") * K), "for_share": (share / (100 - share) / K, "kW/K"),
        "for_speed": ((T / T_max - 1) / K, "kW/K"), "at_most": (u_max / step, "kW/K"),
    }  # fmt: skip


KINDS = ("plain", "fast", "slow", "right")  # the zeros of H_1 to H_4 in exercise 5.6


def _with_zero(T_0, T_1, T_2):
    """The unit step response of (T_0 s + 1)/((T_1 s + 1)(T_2 s + 1)), an expression in t."""
    return 1 - ((T_1 - T_0) * exp(-t / T_1) - (T_2 - T_0) * exp(-t / T_2)) / (T_1 - T_2)


def _four_responses(K, T_1, T_2, T_0, T_r, order):
    """The four responses, each under its letter."""
    return dict(sorted(zip(order, (K * _with_zero(T, T_1, T_2) for T in (0, T_1, T_0, -T_r)), strict=True)))


@exercise(
    "5.6",
    title="Four zeros, four responses",
    points=4,
    where=lambda T_1, T_2, T_0, T_r: 2 * T_2 <= T_1 and 1.6 * T_1 <= T_0 <= 2.6 * T_1 and 0.3 * T_1 <= T_r <= 0.9 * T_1,
    insight="The poles say which exponentials there are; the zeros say how much there is of each, even none of one.",
)
def four_zeros(
    K=between(1, 6, reference=2, step=0.5),
    T_1=between(4, 12, "s", reference=6, step=1),
    T_2=between(1, 5, "s", reference=2, step=0.5),
    T_0=between(7, 30, "s", reference=12, step=1),
    T_r=between(2, 10, "s", reference=4, step=0.5),
    order=choice(
        "ABCD", "BADC", "CDAB", "DCBA", "BCDA", "CADB", "DBAC", "ACBD", "BDCA", "CBDA", "DACB", "ADCB", reference="DBAC"
    ),
):
    r"""Four transfer functions have the same poles and the same static gain:

    $H_1 =$ {H_a}, $H_2 =$ {H_b}, $H_3 =$ {H_c}, $H_4 =$ {H_d}

    The time is in seconds. The picture shows their step responses as A, B, C and D. With poles and zeros in mind: which
    response belongs to which transfer function? Give also the zero of $H_4$, and the slope with which its step response
    sets out.
    """
    return answers(
        H_1=word(order[0], "ABCD", "the response of $H_1$"),
        H_2=word(order[1], "ABCD", "the response of $H_2$"),
        H_3=word(order[2], "ABCD", "the response of $H_3$"),
        H_4=word(order[3], "ABCD", "the response of $H_4$"),
        zero=number(1 / T_r, "1/s", "the zero of $H_4$"),
        slope=number(-K * T_r / (T_1 * T_2), "1/s", "the slope with which the response of $H_4$ sets out"),
    )


@four_zeros.shows
def _(K, T_1, T_2, T_0, T_r):
    below = T_1 * T_2 * s**2 + (T_1 + T_2) * s + 1
    numerators = {"H_a": 0, "H_b": T_1, "H_c": T_0, "H_d": -T_r}
    return {name: (K * T * s + K) / below for name, T in numerators.items()}


@four_zeros.picture
def _(K, T_1, T_2, T_0, T_r, order):
    """Four step responses A to D that end at the same value."""
    times = np.linspace(0, 6 * float(T_1), 300)
    return time_plot(_four_responses(K, T_1, T_2, T_0, T_r, order), times, ylabel="step response")


def _response_of(asked, taken):
    """A mistake: the response of another transfer function."""
    return lambda order: {f"H_{asked + 1}": order[taken]}


for _taken, _sentence in enumerate((
    "This response begins with the slope zero. How many more poles than zeros does this transfer function have?",
    "This response is that of a single exponential, and a quick one. Which pole would the zero have to cancel?",
    "This response goes beyond its final value. Where would the zero be, compared with the poles?",
    "This response sets out in the wrong direction. On which side would the zero be?",
)):  # fmt: skip
    for _asked in range(4):
        if _asked != _taken:
            four_zeros.mistake(_sentence)(_response_of(_asked, _taken))


@four_zeros.mistake("That is a time. The zero is the value of $s$ that makes the numerator zero.")
def _(T_r):
    return {"zero": T_r}


@four_zeros.mistake("Put it into the numerator: is it zero there? Watch the sign.")
def _(T_r):
    return {"zero": -1 / T_r}


@four_zeros.mistake(
    "This would be the slope of a numerator $s$ alone. What is the factor of $s$ in the numerator of $H_4$?"
)
def _(K, T_1, T_2, T_r):
    return {"slope": -K / (T_1 * T_2)} if T_r != 1 else {}


@four_zeros.mistake("For large $s$ the highest powers of $s$ count, in the denominator as well.")
def _(K, T_1, T_2, T_r):
    return {"slope": -K * T_r / (T_1 + T_2)} if abs(T_1 * T_2 / (T_1 + T_2) - 1) > 0.05 else {}


@four_zeros.mistake("That is the numerator for large $s$. What does the denominator do there?")
def _(K, T_1, T_2, T_r):
    return {"slope": -K * T_r} if T_1 * T_2 != 1 else {}


@four_zeros.mistake("For large $s$ the numerator is not its constant. Which of its terms is larger there?")
def _(K, T_1, T_2):
    return {"slope": K / (T_1 * T_2)}


@four_zeros.mistake("For large $s$ the highest powers of $s$ count, in the numerator and in the denominator.")
def _(K, T_1, T_2):
    return {"slope": K / (T_1 + T_2)}


@four_zeros.mistake("That belongs to another of the four. Where is the numerator of $H_4$ zero?")
def _(T_0, T_r):
    return {"zero": 1 / T_0} if abs(T_0 / T_r - 1) > 0.03 else {}


@four_zeros.mistake("So it would be with a static gain of one. What is it here?")
def _(K, T_1, T_2, T_r):
    return {"slope": -T_r / (T_1 * T_2)} if K not in (1, T_r) else {}


four_zeros.hints(
    "Poles say which exponentials a response is made of. A zero says how much of each: a zero on a pole takes it "
    "away, one to the right of the imaginary axis turns the beginning around, and a slow one to the left makes it "
    "overshoot.",
    "Factor the denominator as $(T_1 s + 1)(T_2 s + 1)$. Then compare each numerator: is there a zero at all, is it "
    "one of the poles, is it nearer to the origin than they are, is it positive? The initial slope is "
    r"$\lim_{s\to\infty} s\,H(s)$.",
    "The denominator is $({T_1} s + 1)({T_2} s + 1)$, so the poles are $-1/{T_1}$ and $-1/{T_2}$. The numerator of "
    r"$H_4$ is zero where ${T_r}\,s = 1$.",
)


@four_zeros.solution
def _(K, T_1, T_2, T_0, T_r, order):
    r"""The denominator is $({T_1} s + 1)({T_2} s + 1)$, so all four have the poles $-1/{T_1} =$ {p_1} and $-1/{T_2} =$
    {p_2}.

    - $H_1$ has no zero. With two poles more than zeros it begins with the slope zero: {a}.
    - $H_2$ has its zero at $-1/{T_1}$, which is the slow pole. The two cancel, and the quick lag is left alone, with a
    corner at the beginning: {b}.
    - $H_3$ has its zero at $-1/{T_0} =$ {z_3}, nearer to the origin than both poles. It sets out so steeply that it
    overshoots: {c}.
    - $H_4$ has its zero at $1/{T_r} =$ {zero}, on the right. Its response sets out in the wrong direction: {d}.

    The initial slope of a step response is $s\,H(s)$ for large $s$, where only the highest powers count:

    $$\frac{ {K} \cdot (-{T_r}) }{ {T_1} \cdot {T_2} } = {slope}\ \text{1/s}$$
    """
    a, b, c, d = order
    return {
        "a": a,
        "b": b,
        "c": c,
        "d": d,
        "p_1": (-1 / T_1, "1/s"),
        "p_2": (-1 / T_2, "1/s"),
        "z_3": (-1 / T_0, "1/s"),
    }


@four_zeros.solution_picture
def _(T_1, T_2, T_0, T_r):
    """The poles and the zeros of the four in the complex plane, all of them on the real axis."""
    poles, zeros = [float(-1 / T_1), float(-1 / T_2)], [float(x) for x in (-1 / T_1, -1 / T_0, 1 / T_r)]
    wide = 1.2 * max(map(abs, poles + zeros))
    axes = {"xlim": (-wide, wide), "ylim": (-0.5, 0.5)}
    plot = plane_plot(
        {"imaginary axis": ([0, 0], [-0.5, 0.5], "setpoint")}, "real part [1/s]", "imaginary part [1/s]", **axes
    )
    plot.points(poles, [0, 0], "poles", mark="x").points(zeros, [0, 0, 0], "zeros")
    for which, x in zip((2, 3, 4), zeros, strict=True):
        plot.text(x, 0.12, f"$H_{which}$")
    return plot
