"""Exercises of chapter 5, transfer functions."""

from sympy import Symbol, exp, symbols

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


@exercise("5.1", title="A stirrer and its load", points=2)
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
    return {"H_u": k / (J * s), "H_M": -1 / (J * s)}


@stirrer.mistake("Only the voltage is multiplied by $k$. What is the torque multiplied by in the equation?")
def _(J, k, b):
    return {"H_M": -k / (J * s + b)} if k != 1 else {}


@stirrer.mistake("The friction term changes sign when it moves to the left side.")
def _(J, k, b):
    return {"H_u": k / (J * s - b), "H_M": -1 / (J * s - b)}


@stirrer.mistake("That is the time constant. The pole is the root of the denominator.")
def _(J, b):
    return {"pole": J / b} if J != b else {}


@exercise("5.2", title="What the fraction tells", points=3, where=lambda p, q, z: p != q and z not in (-p, -q))
def fraction(
    K=between(1, 6, reference=3, step=1),
    z=choice(-6, -5, -4, -3, -2, -1, 1, 2, 3, 4, 5, 6, reference=2),
    p=between(1, 5, reference=1, step=1),
    q=between(2, 8, reference=4, step=1),
    scale=choice(2, 4, 5, reference=2),
):
    """A system has the transfer function

    $H(s) =$ {H}

    with the time in seconds. Factor it. Give its poles and its zero, the gain $K$ of the zero-pole form, and the static
    gain. Does the step response set out towards its final value, or away from it?
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


@fraction.shows
def _(K, z, p, q, scale):
    return {"H": (scale * K * s - scale * K * z) / (scale * s**2 + scale * (p + q) * s + scale * p * q)}


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


@exercise(
    "5.3",
    title="A force sensor that creeps",
    points=4,
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
    "Beginning and end are interchanged: large $s$ belongs to the beginning, and $s = 0$ to the end."
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


@exercise(
    "5.4",
    title="Two loops and a bypass",
    points=4,
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
    by_chance = below == 0 or abs(above / below / right - 1) < 0.02
    return {"M": M} if by_chance else {"M": M, "M_s": above / below}


def _range(K, T, share, T_max, u_max, step):
    """The least and the largest gain of the feedback in exercise 5.5."""
    least = max(share / (100 - share) / K, (T / T_max - 1) / K)
    return least, u_max / step


@exercise(
    "5.5",
    title="A hot plate becomes faster",
    points=5,
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
            number((least + largest) / 2, "kW/K", "the gain of the feedback"),
            criterion("the loop is stable", lambda gain: 1 + float(gain) * float(K) > 0),
            criterion("the share of the step that is reached", measured(_reached(K)), above=share, unit="%"),
            criterion("the time constant", measured(_time_constant(K, T)), below=T_max, unit="s"),
            criterion("the largest power", measured(lambda gain: gain * float(step)), below=u_max, unit="kW"),
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
