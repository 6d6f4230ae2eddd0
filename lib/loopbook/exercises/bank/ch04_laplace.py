"""Exercises of chapter 4, the Laplace transform."""

from sympy import Symbol, exp, log

from loopbook.exercises.authoring import (
    answers,
    between,
    choice,
    exercise,
    number,
    time_function,
    transfer_function,
    words,
)
from loopbook.expressions import s, t


@exercise("4.1", title="An oil bath warms up", points=2)
def oil_bath(
    start=between(15, 40, "°C", reference=20),
    rate=between(0.2, 2, "K/s", reference=0.5, step=0.1),
):
    r"""At $t = 0$ the oil in a bath has a temperature of {start}. From then on a heater raises it steadily, by {rate}.
    Call the temperature $\vartheta(t)$ and give its transform. Then give the transform of its time derivative
    $\dot\vartheta(t)$. Leave the units out: temperatures are in °C, the time is in seconds.
    """
    return answers(
        F=transfer_function(start / s + rate / s**2, "the transform of the temperature"),
        F_rate=transfer_function(rate / s, "the transform of the derivative"),
    )


@oil_bath.mistake(
    "A constant signal is a step at $t = 0$, and the transform of a step has an $s$. Look at its pair in the "
    "table again."
)
def _(start, rate):
    return {"F": start + rate / s**2}


@oil_bath.mistake("A signal that grows steadily is a ramp. Look again at the power of $s$ in its pair.")
def _(start, rate):
    return {"F": (start + rate) / s}


@oil_bath.mistake("That is a bath that starts at 0 °C. What does this one have at $t = 0$?")
def _(rate):
    return {"F": rate / s**2}


@oil_bath.mistake("Multiplying by $s$ is right for a signal that starts at zero. This one has an initial value.")
def _(start, rate):
    return {"F_rate": start + rate / s}


@exercise("4.2", title="A dose of dye", points=3)
def dose(
    q=between(2, 12, "mL/s", reference=5),
    begin=between(4, 20, "s", reference=10),
    duration=between(5, 30, "s", reference=15),
):
    """To measure the flow in a pipe, a pump adds dye to the water. The pump stands still at first. At $t$ = {begin} it
    starts and gives {q}, and it stops after it has run for {duration}. Write the flow of the dye as a sum of steps
    and transform it. How much dye has been added in the end? (Compare the total with the transform at $s = 0$.)
    """
    return answers(
        F=transfer_function(
            q / s * (exp(-begin * s) - exp(-(begin + duration) * s)), "the transform of the dye's flow"
        ),
        total=number(q * duration, "mL", "the amount of dye"),
    )


@dose.mistake("The delay of a step is counted from $t = 0$, not from the step before. When does the pump stop?")
def _(q, begin, duration):
    return {"F": q / s * (exp(-begin * s) - exp(-duration * s))} if begin != duration else {}


@dose.mistake("Your pump starts and never stops. A second step has to stop the flow.")
def _(q, begin):
    return {"F": q / s * exp(-begin * s)}


@dose.mistake(
    "Your flow starts at the right time, but as a pulse without height or width. What is the transform of a step?"
)
def _(q, begin, duration):
    return {"F": q * (exp(-begin * s) - exp(-(begin + duration) * s))}


@dose.mistake("Your pump starts a second time instead of stopping. Which sign has the second step?")
def _(q, begin, duration):
    return {"F": q / s * (exp(-begin * s) + exp(-(begin + duration) * s))}


@dose.mistake("Your pump runs from $t = 0$ on. When does it start?")
def _(q, duration):
    return {"F": q / s * (1 - exp(-duration * s))}


@dose.mistake("No dye flows before the pump starts. For how long does it run?")
def _(q, begin, duration):
    return {"total": q * (begin + duration)}


@exercise("4.3", title="Back to time", points=3, where=lambda A, B, p, q: A != B and q >= p + 0.2)
def back_to_time(
    A=between(2, 12, reference=8, step=1),
    B=between(1, 9, reference=3, step=1),
    p=between(0.1, 0.5, reference=0.2, step=0.1),
    q=between(0.3, 2, reference=0.7, step=0.1),
):
    r"""A tracer has been injected into a vessel that exchanges liquid with a second one. Its concentration $y(t)$, in
    mg/L with the time in minutes, has the transform

    $Y(s) =$ {Y}

    Find the concentration as a function of time, and its value just after the injection, at $t = 0$.
    """
    return answers(
        y=time_function(A * exp(-p * t) + B * exp(-q * t), 3 / p, "mg/L", "the concentration"),
        y_0=number(A + B, "mg/L", "the concentration at the beginning"),
    )


@back_to_time.shows
def _(A, B, p, q):
    return {"Y": ((A + B) * s + A * q + B * p) / (s**2 + (p + q) * s + p * q)}


@back_to_time.mistake("Each factor belongs to the other exponential. Which fraction has which pole?")
def _(A, B, p, q):
    return {"y": B * exp(-p * t) + A * exp(-q * t)} if abs(A - B) >= 0.4 * (A + B) and q >= 2 * p else {}


@back_to_time.mistake("Look at the signs of the poles again: the tracer cannot multiply.")
def _(A, B, p, q):
    return {"y": A * exp(p * t) + B * exp(q * t)}


@back_to_time.mistake("The value at the beginning is $y(0)$. You have put $s = 0$ into the transform.")
def _(A, B, p, q):
    return {"y_0": A / p + B / q}


@exercise("4.4", title="A thermometer comes into warm water", points=4, where=lambda bath, start: bath >= start + 20)
def thermometer(
    T=between(4, 20, "s", reference=8, step=1),
    start=between(15, 30, "°C", reference=22, step=1),
    bath=between(40, 75, "°C", reference=62, step=1),
    rest=between(0.5, 2, "K", reference=1, step=0.25),
):
    r"""A thermometer shows {start}. At $t = 0$ it is put into water of {bath}. From then on its reading $y(t)$ follows
    the temperature of the water $u$ with the time constant $T$ = {T},

    $$T\,\dot y(t) + y(t) = u$$

    Transform this equation with its initial value and solve it for $Y(s)$. Find the reading as a function of time, and
    the moment from which on it is less than {rest} away from the temperature of the water. (In $Y(s)$ and $y(t)$ leave
    the units out: °C and seconds.)
    """
    return answers(
        Y=transfer_function((T * start * s + bath) / (s * (T * s + 1)), "the transform of the reading"),
        y=time_function(bath - (bath - start) * exp(-t / T), 5 * T, "°C", "the reading", within=0.005),
        t_near=number(T * log((bath - start) / rest), "s", "the moment from which on the reading is near"),
    )


@thermometer.mistake(
    "That is a thermometer that starts at 0 °C. The derivative brings the initial value into the equation."
)
def _(T, bath, rest):
    return {"Y": bath / (s * (T * s + 1)), "y": bath * (1 - exp(-t / T)), "t_near": T * log(bath / rest)}


@thermometer.mistake("In the equation the derivative is multiplied by the time constant, and so is its initial value.")
def _(T, start, bath):
    return {"Y": (start * s + bath) / (s * (T * s + 1)), "y": bath - (bath - start / T) * exp(-t / T)}


@thermometer.mistake(
    "The temperature of the water is constant in time. So its transform is that of a step, with an $s$ in the "
    "denominator."
)
def _(T, start, bath):
    return {"Y": (T * start + bath) / (T * s + 1), "y": (start + bath / T) * exp(-t / T)}


@thermometer.mistake("An exponent is a pure number: here it must be a time over a time constant.")
def _(T, start, bath):
    return {"y": bath - (bath - start) * exp(-T * t)}


@thermometer.mistake("This reading runs away from the water. Look at the sign of the pole again.")
def _(T, start, bath):
    return {"y": bath - (bath - start) * exp(t / T)}


@thermometer.mistake("You have added the final value to the whole response from zero. What is the reading at $t = 0$?")
def _(T, start, bath):
    return {"Y": start / s + bath / (s * (T * s + 1)), "y": start + bath * (1 - exp(-t / T))}


@thermometer.mistake("That is the rise of the reading. What does the thermometer show at $t = 0$?")
def _(T, start, bath):
    rise = bath - start
    return {"Y": rise / (s * (T * s + 1)), "y": rise * (1 - exp(-t / T))}


@exercise("4.5", title="Which of them settle?", points=3)
def which_settle(
    order=choice("ABCD", "BDAC", "CADB", "DCBA", "BACD", "CDBA", "ADCB", "DBAC", reference="BDAC"),
    a=between(1, 9, reference=4, step=1),
    b=between(2, 12, reference=6, step=1),
    p=between(2, 5, reference=3, step=1),
    w=between(2, 5, reference=2, step=1),
):
    """Four signals have these transforms, with the time in seconds:

    - $A(s) =$ {A}
    - $B(s) =$ {B}
    - $C(s) =$ {C}
    - $D(s) =$ {D}

    Which of the signals settle, at whatever value? Exactly one signal settles at a value that is not zero. At which?
    """
    settles, _, _, fades = order
    return answers(
        settling=words(sorted([settles, fades]), ["A", "B", "C", "D"], "the signals that settle"),
        value=number(b / p, "", "the final value that is not zero"),
    )


@which_settle.shows
def _(order, a, b, p, w):
    settles, grows, swings, fades = b / (s * (s + p)), b / (s * (s - p + 1)), a / (s**2 + w**2), a / ((s + 1) * (s + w))
    return dict(zip(order, (settles, grows, swings, fades), strict=True))


@which_settle.mistake(
    "For each of these, $sF(s)$ has a limit at $s = 0$. Does that suffice? Look at the poles of $sF(s)$."
)
def _():
    return {"settling": ["A", "B", "C", "D"]}


@which_settle.mistake("One of these oscillates forever. A pair of poles on the imaginary axis does not fade.")
def _(order):
    return {"settling": sorted([order[0], order[2], order[3]])}


@which_settle.mistake("One of these grows without bounds. On which side of the imaginary axis is its pole?")
def _(order):
    return {"settling": sorted([order[0], order[1], order[3]])}


@which_settle.mistake("Zero is a final value, too: a signal that dies out has settled.")
def _(order):
    return {"settling": [order[0]]}


@which_settle.mistake(
    "That number is the limit of $sF(s)$ for a signal that grows without bounds. It has no final value."
)
def _(b, p):
    return {"value": -b / (p - 1)}


@which_settle.mistake("Put $s = 0$ into all of $sF(s)$, into its denominator as well.")
def _(b):
    return {"value": b}


def _excess(K, full, warmer):
    """How many times warmer full power would make the oven in the end, compared with what is wanted."""
    return K * full / warmer


@exercise(
    "4.6",
    title="Full power first, then just enough",
    points=5,
    where=lambda K, full, warmer: 1.25 <= _excess(K, full, warmer) <= 4 and abs(_excess(K, full, warmer) - 2) > 0.1,
)
def full_power_first(
    K=between(20, 60, "K/kW", reference=40, step=5),
    T=between(10, 40, "min", reference=20, step=1),
    full=between(4, 10, "kW", reference=6, step=0.5),
    warmer=between(80, 240, "K", reference=160, step=10),
):
    r"""An oven has the temperature of the room. Its temperature above that of the room, $y(t)$, follows the power
    $u(t)$ of the heater by

    $$T\,\dot y(t) + y(t) = K\,u(t)$$

    with $K$ = {K} and $T$ = {T}. The oven should become {warmer} warmer than the room, soon, and then stay so. At
    $t = 0$ the heater is switched to its full power, $u_1$ = {full}. At the moment $t_1$, when the temperature is
    reached, it is switched back to a power $u_2$ that just holds it. Transform the power, in the symbols $u_1$, $u_2$,
    $t_1$ and $s$. Then find $u_2$ and $t_1$.
    """
    u_1, u_2, t_1 = (Symbol(name, positive=True) for name in ("u_1", "u_2", "t_1"))
    return answers(
        U=transfer_function(
            u_1 / s + (u_2 - u_1) / s * exp(-t_1 * s),
            "the transform of the power, in the symbols $u_1$, $u_2$, $t_1$ and $s$",
        ),
        u_2=number(warmer / K, "kW", "the power that holds the temperature"),
        t_1=number(T * log(K * full / (K * full - warmer)), "min", "the moment of switching back"),
    )


@full_power_first.mistake("Your power is $u_1 + u_2$ after the switch. How large is the step from $u_1$ to $u_2$?")
def _():
    u_1, u_2, t_1 = (Symbol(name, positive=True) for name in ("u_1", "u_2", "t_1"))
    return {"U": u_1 / s + u_2 / s * exp(-t_1 * s)}


@full_power_first.mistake("Your power is $u_1 - u_2$ after the switch. How large is the step from $u_1$ to $u_2$?")
def _():
    u_1, u_2, t_1 = (Symbol(name, positive=True) for name in ("u_1", "u_2", "t_1"))
    return {"U": u_1 / s - u_2 / s * exp(-t_1 * s)}


@full_power_first.mistake("Under full power the temperature does not rise along a straight line to its end: it bends.")
def _(T, K, full, warmer):
    return {"t_1": T * warmer / (K * full)}


@full_power_first.mistake("The exponential is what is still missing on the way to $Ku_1$, not what has been covered.")
def _(T, K, full, warmer):
    return {"t_1": T * log(K * full / warmer)} if abs(_excess(K, full, warmer) - 1.763) > 0.1 else {}


@full_power_first.mistake(
    "After one time constant, 63 % of the way to $Ku_1$ is covered. Is that the wanted temperature?"
)
def _(T, K, full, warmer):
    return {"t_1": T} if abs(_excess(K, full, warmer) - 1.582) > 0.05 else {}
