"""Exercises of chapter 11, control structures."""

import cmath
import math

from sympy import Min, Rational, exp, symbols

from loopbook.exercises.authoring import (
    answers,
    between,
    choice,
    criterion,
    design,
    exercise,
    expression,
    number,
    settings,
    time_function,
    transfer_function,
    word,
)
from loopbook.exercises.parameters import written
from loopbook.expressions import s, t
from loopbook.pid import PID

OTHER = {"reverse": "direct", "direct": "reverse"}


# --- 11.1 ---------------------------------------------------------------------------------------------------------


@exercise("11.1", title="Lemonade from syrup", points=2)
def lemonade(
    x_S=between(58, 70, "%", reference=65),
    x_L=between(8, 16, "%", reference=13),
    F_S=between(0.4, 2, "kg/s", reference=0.5),
    part=between(20, 80, "%", reference=25, step=5),
):
    """Lemonade is made of sugar syrup and water. The syrup holds {x_S} of sugar by mass, the lemonade needs {x_L},
    and the water holds none. The syrup is the wild stream: its flow is what the filling machine asks for, now {F_S}. A
    ratio controller multiplies the measured flow of syrup by $K$ and hands the result to the flow controller of the
    water as its setpoint, $F_{W,SP} = K F_S$.

    Which ratio $K$ is needed, and what is the setpoint of the water now? Somebody proposes to control the measured
    quotient $F_W/F_S$ instead, with the same valve. The flow of syrup then falls to {part} of what it is now. By which
    factor does the gain from the control signal to the quotient change?
    """
    K = x_S / x_L - 1
    return answers(
        K=number(K, "", "the ratio of water to syrup"),
        F_W=number(K * F_S, "kg/s", "the setpoint of the water's flow"),
        factor=number(100 / part, "", "the factor by which the gain of the quotient changes"),
    )


@lemonade.mistake("That is the ratio of the lemonade to the syrup. What flows through the valve for water?")
def _(x_S, x_L, F_S):
    return {"K": x_S / x_L, "F_W": x_S / x_L * F_S}


@lemonade.mistake("That is the ratio of the two sugar contents. Set up two balances, of the sugar and of all the mass.")
def _(x_S, x_L, F_S):
    return {"K": x_L / x_S, "F_W": x_L / x_S * F_S}


@lemonade.mistake("That is the share of the water in the lemonade. The ratio controller starts from the flow of syrup.")
def _(x_S, x_L, F_S):
    return {"K": 1 - x_L / x_S, "F_W": (1 - x_L / x_S) * F_S}


@lemonade.mistake(
    "With $K F_S$ as setpoint the loop gain would stay as it is. The quotient has the flow of syrup in its denominator."
)
def _():
    return {"factor": 1}


@lemonade.mistake(
    "That is the fraction by which the flow of syrup falls. Write the quotient's gain before and after, and divide."
)
def _(part):
    return {"factor": 1 - part / 100} if part != 50 else {}


# --- 11.2 ---------------------------------------------------------------------------------------------------------


def blanket_valves(u, split, action):
    """The openings of the vent and of the inlet for nitrogen."""
    falling, rising = max(0, 100 * (1 - u / split)), max(0, 100 * (u - split) / (100 - split))
    return (falling, rising) if action == "reverse" else (rising, falling)


def _clear_opening(u, split):
    moving = max(blanket_valves(u, split, "reverse"))
    return split != 50 and abs(u - split) >= 5 and abs(moving - 50) >= 5 and moving <= 95


@exercise("11.2", title="Nitrogen over a solvent", points=2, where=_clear_opening)
def blanket(
    action=choice("reverse", "direct"),
    split=between(30, 70, "%", reference=40, step=5),
    u=between(5, 95, "%", reference=30, step=5),
):
    """The space above a solvent in a tank is filled with nitrogen. One pressure controller keeps the pressure with two
    valves: one lets nitrogen in, the other one, the vent, lets gas out. The two must never be open at the same time,
    and each passes its whole way between closed and open in its part of the control signal. Below {split} one of them
    works, above {split} the other. The controller is set to *{action}* action.

    Which of the valves moves in the lower part of the range? What are the openings when the control signal is {u}?
    """
    vent, inlet = blanket_valves(u, split, action)
    return answers(
        lower=word("vent" if action == "reverse" else "inlet", ["vent", "inlet"], what="the valve of the lower part"),
        vent=number(vent, "%", "the opening of the vent"),
        inlet=number(inlet, "%", "the opening of the inlet"),
    )


@blanket.mistake(
    "That belongs to the other action of the controller. Does its signal rise or fall as the pressure rises?"
)
def _(u, split, action):
    vent, inlet = blanket_valves(u, split, OTHER[action])
    return {"lower": "inlet" if action == "reverse" else "vent", "vent": vent, "inlet": inlet}


@blanket.mistake(
    "That valve moves the wrong way. Over the whole range more signal must move the pressure in one direction, "
    "so that one valve closes where the other one opens."
)
def _(u, split, action):
    openings = dict(zip(("vent", "inlet"), blanket_valves(u, split, action), strict=True))
    return {valve: 100 - opening for valve, opening in openings.items() if opening}


@blanket.mistake("At this control signal the other valve is open. May this one be open, too?")
def _(u, split, action):
    openings = dict(zip(("vent", "inlet"), blanket_valves(u, split, action), strict=True))
    return {valve: 100 for valve, opening in openings.items() if not opening}


@blanket.mistake("That is the control signal. Each valve travels its full range over a part of it.")
def _(u, split, action):
    openings = dict(zip(("vent", "inlet"), blanket_valves(u, split, action), strict=True))
    return {valve: u for valve, opening in openings.items() if opening and abs(opening - u) > 2}


@blanket.mistake("That would be right if the range were split in the middle. Where is it split here?")
def _(u, split, action):
    if (u - split) * (u - 50) <= 0:
        return {}
    here = blanket_valves(u, split, action)
    middle = blanket_valves(u, Rational(50), action)
    pairs = zip(("vent", "inlet"), here, middle, strict=True)
    return {valve: there for valve, opening, there in pairs if abs(there - opening) > 2}


# --- 11.3 ---------------------------------------------------------------------------------------------------------


ONE = [f"LC{n}" for n in (4, 1, 2, 3)]
TWO = [f"LC{n} and LC{m}" for n in range(1, 5) for m in range(n + 1, 5)]


def actions_in_row(place, closing):
    """The actions of the level controllers; the valves of some of them close as the signal rises."""
    actions = {f"LC{n}": "reverse" if n <= place else "direct" for n in range(1, 5)}
    return {name: OTHER[action] if name in closing else action for name, action in actions.items()}


@exercise("11.3", title="Four tanks in a row", points=2)
def tanks_in_row(place=choice(2, 0, 1, 3, 4), closing=choice(*ONE, *TWO)):
    r"""In a dairy the milk passes four tanks, one after the other. Each has a level controller, LC1 to LC4, whose valve
    is in the pipe in front of the tank or behind it. A flow controller {where} sets the production rate, and so that
    pipe has no valve of a level controller. Every valve opens as its control signal rises, with {exceptions} without
    signal and closed at 100 %.

    Which action does each level controller need, if no two controllers may share a pipe?
    """
    actions = actions_in_row(place, closing)
    return answers(
        **{name: word(action, ["reverse", "direct"], what=f"the action of {name}") for name, action in actions.items()}
    )


@tanks_in_row.shows
def _(place, closing):
    wheres = {0: "in front of tank 1", 4: "behind tank 4"}
    two = "and" in closing
    exceptions = "two exceptions: the valves of {} are open" if two else "one exception: the valve of {} is open"
    return {
        "where": wheres.get(place, f"between tank {place} and tank {place + 1}"),
        "exceptions": exceptions.format(closing),
    }


@tanks_in_row.mistake("That is right for a valve that opens as its signal rises. What does this valve do?")
def _(place, closing):
    return {name: OTHER[action] for name, action in actions_in_row(place, closing).items() if name in closing}


@tanks_in_row.mistake(
    "Look at where the flow is already decided. Upstream of that point a level must be controlled by its "
    "inflow, downstream of it by its outflow."
)
def _(place, closing):
    return {name: OTHER[action] for name, action in actions_in_row(place, closing).items() if name not in closing}


# --- 11.4 ---------------------------------------------------------------------------------------------------------


@exercise("11.4", title="A drying oven in cascade", points=3)
def oven(
    K_1=between(0.5, 0.95, "K/K", reference=0.8, step=0.05),
    T_1=between(200, 600, "s", reference=400, step=20),
    K_2=between(0.5, 2.5, "K/%", reference=1.5),
    T_2=between(20, 60, "s", reference=40),
    K_p2=between(2, 6, "%/K", reference=2),
):
    """Painted parts dry in an oven with hot air. From the opening of the burner's valve to the temperature $y_2$ of the
    air the process is a lag of {T_2} with the gain {K_2}; from there to the temperature $y_1$ of the parts it is a lag
    of {T_1} with the gain {K_1}. The pressure of the fuel varies, and this acts like an additional opening $d$ of the
    valve, in %. The secondary controller is a P controller with the gain {K_p2}, which has the air's measurement
    without delay. The primary controller is in manual mode.

    Find the transfer function from $d$ to $y_1$, with the time in seconds. By which factor does the secondary loop make
    the final effect of a constant $d$ on $y_1$ smaller, and which time constant does that loop have?
    """
    loop = 1 + K_p2 * K_2
    return answers(
        H=transfer_function(K_1 * K_2 / ((T_1 * s + 1) * (T_2 * s + loop)), "the transfer function from d to $y_1$"),
        factor=number(loop, "", "the factor by which the effect is smaller"),
        T=number(T_2 / loop, "s", "the time constant of the secondary loop"),
    )


@oven.mistake("That is the process without the secondary loop. How does the air's temperature come back to the valve?")
def _(K_1, T_1, K_2, T_2):
    return {"H": K_1 * K_2 / ((T_1 * s + 1) * (T_2 * s + 1)), "T": T_2}


@oven.mistake("There the loop goes around both parts of the process. The secondary loop closes at $y_2$.")
def _(K_1, T_1, K_2, T_2, K_p2):
    both = K_1 * K_2 / ((T_1 * s + 1) * (T_2 * s + 1))
    loop, inner = 1 + K_p2 * K_1 * K_2, K_p2 * K_2
    return {"H": both / (1 + K_p2 * both)} | ({"factor": loop} if abs(loop - inner) > inner / 20 else {})


@oven.mistake(
    "That is the response to the setpoint of the secondary loop. The disturbance does not pass the controller."
)
def _(K_1, T_1, K_2, T_2, K_p2):
    return {"H": K_p2 * K_1 * K_2 / ((T_1 * s + 1) * (T_2 * s + 1 + K_p2 * K_2))}


@oven.mistake("That is the fraction by which the effect falls. How many times smaller does it become?")
def _(K_2, K_p2):
    return {"factor": 1 - 1 / (1 + K_p2 * K_2)}


@oven.mistake("The secondary loop makes its lag shorter. Does it leave the effect of a constant disturbance as it was?")
def _(K_1, T_1, K_2, T_2, K_p2):
    return {"H": K_1 * K_2 / ((T_1 * s + 1) * (T_2 / (1 + K_p2 * K_2) * s + 1))}


@oven.mistake("That is the gain of the secondary loop alone. What else is in the denominator of a closed loop?")
def _(K_2, K_p2, T_2):
    return {"factor": K_p2 * K_2, "T": T_2 / (K_p2 * K_2)}


# --- 11.5 ---------------------------------------------------------------------------------------------------------


@exercise("11.5", title="A basin for rain", points=3, where=lambda F, k: 0.1 <= F / k <= 0.5)
def basin(
    A=between(4, 20, "m²", reference=10),
    F=between(5, 20, "kg/s", reference=8),
    k=between(20, 80, "kg/(s m)", reference=40),
):
    r"""A basin with vertical walls and an area of {A} takes up rain water, so that less of its variations reach the
    sewage works. A P controller keeps the level, $u = u_0 + K_p (h_{SP} - h)$, where $u$ is the outflow in kg/s; the
    magnitude of $K_p$ is {k}, and its sign is the right one. The level is at its setpoint. Then it begins to rain, and
    the inflow is larger by {F} from $t = 0$ on. Water has a density of 1000 kg/m³.

    With which time constant does the level answer, how far above its setpoint does it end, and what is its deviation
    $h - h_{SP}$ as a function of time?
    """
    T = 1000 * A / k
    return answers(
        T=number(T, "s", "the time constant of the level"),
        left=number(F / k, "m", "the deviation of the level in the end"),
        deviation=time_function(F / k * (1 - exp(-t / T)), 5 * T, "m", "the deviation for t in s"),
    )


@basin.mistake("There volumes and masses are mixed: all the flows are masses per second, and so is what $K_p$ moves.")
def _(A, F, k):
    return {"T": A / k, "left": F / (1000 * k)}


@basin.mistake("That is the level without control, where the outflow stays as it was.")
def _(A, F):
    return {"deviation": F * t / (1000 * A)}


@basin.mistake("Only an integral term would bring the level back to its setpoint, and this controller has none.")
def _():
    return {"left": 0}


@basin.mistake("That is how the deviation would die away. It begins at zero and ends where the outflow is the inflow.")
def _(A, F, k):
    return {"deviation": F / k * exp(-t * k / (1000 * A))}


# --- 11.6 ---------------------------------------------------------------------------------------------------------


def two_P(K_1, T_1, K_2, T_2, L_1, L_2):
    """The gains of the cascade that has the lags L_1 and L_2."""
    inner = T_2 / L_1 + T_2 / L_2 - T_2 / T_1 - 1  # K_2 K_p2
    outer = (T_1 * T_2 / (L_1 * L_2) - 1 - inner) / inner  # K_1 K_p1
    return outer / K_1, inner / K_2


def _two_reasonable_gains(K_1, T_1, K_2, T_2, L_1, L_2):
    if L_2 >= L_1 or L_1 >= T_1 or L_2 >= T_2:
        return False
    K_p1, K_p2 = two_P(K_1, T_1, K_2, T_2, L_1, L_2)
    return K_p2 * K_2 >= 0.5 and K_p1 * K_1 >= 0.4 and abs(K_p2 - 1) > 0.1


@exercise("11.6", title="Two P controllers for two poles", points=4, where=_two_reasonable_gains)
def two_poles(
    K_1=between(0.5, 0.9, "K/K", reference=0.8, step=0.05),
    T_1=between(80, 200, "s", reference=120, step=10),
    K_2=between(0.5, 2, "K/%", reference=1.25, step=0.25),
    T_2=between(20, 50, "s", reference=30, step=5),
    L_1=between(20, 60, "s", reference=40, step=5),
    L_2=between(8, 20, "s", reference=10, step=1),
):
    r"""Air is warmed by a heater and then warms a drying drum. The temperature $y_2$ of the air follows the control
    signal with the gain {K_2} and a lag of {T_2}; the temperature $y_1$ of the drum follows the air with the gain {K_1}
    and a lag of {T_1}. There are no dead times. Both temperatures are measured, and two P controllers are to control
    the drum in cascade, $u = K_{p2}\,(K_{p1}(y_{SP} - y_1) - y_2)$, all counted from the operating point.

    Choose the two gains so that the closed loop has two real poles, which belong to lags of {L_1} and {L_2}. A P
    controller leaves an error: give, with the symbols `K_1`, `K_2`, `K_p1` and `K_p2`, what is left of a setpoint step
    of 1 K in the end.
    """
    K_p1, K_p2 = two_P(K_1, T_1, K_2, T_2, L_1, L_2)
    k_1, k_2, p_1, p_2 = symbols("K_1 K_2 K_p1 K_p2", positive=True)
    left = (1 + k_2 * p_2) / (1 + k_2 * p_2 + k_1 * k_2 * p_1 * p_2)
    return answers(
        K_p2=number(K_p2, "%/K", "the gain of the secondary controller"),
        K_p1=number(K_p1, "K/K", "the gain of the primary controller"),
        left=expression(left, "the error that is left, in K_1, K_2, K_p1 and K_p2"),
    )


@two_poles.mistake("That makes the secondary loop alone have the shorter lag. The primary loop then moves this pole.")
def _(K_2, T_2, L_2):
    return {"K_p2": (T_2 / L_2 - 1) / K_2}


@two_poles.mistake(
    "That is the gain with which the state feedback acts on $y_1$. The signal of the primary controller passes "
    "the secondary one before it reaches the heater."
)
def _(K_1, T_1, K_2, T_2, L_1, L_2):
    K_p1, K_p2 = two_P(K_1, T_1, K_2, T_2, L_1, L_2)
    return {"K_p1": K_p1 * K_p2}


@two_poles.mistake("That may be its value here. Give an expression in the symbols.")
def _(K_1, T_1, K_2, T_2, L_1, L_2):
    K_p1, K_p2 = two_P(K_1, T_1, K_2, T_2, L_1, L_2)
    return {"left": float((1 + K_2 * K_p2) / (1 + K_2 * K_p2 + K_1 * K_2 * K_p1 * K_p2))}


@two_poles.mistake("That is the gain of a controller times that of its process. Give the controller's gain alone.")
def _(K_1, T_1, K_2, T_2, L_1, L_2):
    K_p1, K_p2 = two_P(K_1, T_1, K_2, T_2, L_1, L_2)
    return {"K_p1": K_1 * K_p1} | ({"K_p2": K_2 * K_p2} if K_2 != 1 else {})


@two_poles.mistake("That is how far the drum comes. How much is missing in the end?")
def _():
    k_1, k_2, p_1, p_2 = symbols("K_1 K_2 K_p1 K_p2", positive=True)
    return {"left": k_1 * k_2 * p_1 * p_2 / (1 + k_2 * p_2 + k_1 * k_2 * p_1 * p_2)}


@two_poles.mistake(
    "There the air would follow its setpoint without an error, but the secondary controller is a P, too."
)
def _():
    k_1, p_1 = symbols("K_1 K_p1", positive=True)
    return {"left": 1 / (1 + k_1 * p_1)}


@two_poles.mistake("There the air is not fed back. At rest the secondary loop gives less than its setpoint.")
def _():
    k_1, k_2, p_1, p_2 = symbols("K_1 K_2 K_p1 K_p2", positive=True)
    return {"left": 1 / (1 + k_1 * k_2 * p_1 * p_2)}


# --- 11.7 ---------------------------------------------------------------------------------------------------------


@exercise(
    "11.7",
    title="From the inside out",
    points=5,
    where=lambda T_1, T_2, delay: T_1 >= 2 * T_2 and abs(T_2 - delay) >= 0.5 * delay,
)
def inside_out(
    K_1=between(0.4, 2, "K/K", reference=0.5),
    T_1=between(60, 200, "s", reference=120, step=10),
    K_2=between(0.5, 4, "K/%", reference=2),
    T_2=between(2, 36, "s", reference=30, step=2),
    delay=between(4, 16, "s", reference=6, step=1),
):
    r"""The temperature $y_1$ of a mould is controlled through the temperature $y_2$ of the oil that flows around it.
    From the valve to the oil the process is a lag of {T_2} behind a dead time of {delay}, with the gain {K_2}; from the
    oil to the mould it is a lag of {T_1}, with the gain {K_1}.

    Tune both PI controllers of the cascade by Skogestad's rule with $c = 4$, each with $T_C$ equal to the dead time of
    its model. For the primary controller take the secondary loop as it was ordered, a lag $T_C$ behind the dead time,
    and use the half rule. For comparison: which dead time would the half rule leave for a single PI controller from
    $y_1$ to the valve? And in which of the two structures has the controller of $y_1$ the shorter dead time in its
    model?
    """
    inner, outer, alone = tuned_inside_out(K_1, T_1, K_2, T_2, delay)
    return answers(
        secondary=settings(inner, gain="%/K", time="s", what="the settings of the secondary controller"),
        primary=settings(outer, gain="K/K", time="s", what="the settings of the primary controller"),
        alone=number(alone, "s", "the dead time of the model for the single loop"),
        better=word(
            "cascade" if alone > 3 * delay / 2 else "single loop",
            ["cascade", "single loop"],
            what="the structure with the shorter dead time",
        ),
    )


def tuned_inside_out(K_1, T_1, K_2, T_2, delay):
    """The settings of the cascade, and the dead time of the model for a single loop."""
    inner = PID(T_2 / (2 * K_2 * delay), Min(T_2, 8 * delay))
    late = delay + delay / 2  # with half of the secondary loop's lag
    outer = PID((T_1 + delay / 2) / (2 * K_1 * late), Min(T_1 + delay / 2, 8 * late))
    return inner, outer, delay + min(T_1, T_2) / 2


@inside_out.mistake("That takes the secondary loop for a dead time alone. It was specified with a lag as well.")
def _(K_1, T_1, delay):
    return {"primary": PID(T_1 / (2 * K_1 * delay), Min(T_1, 8 * delay))}


@inside_out.mistake(
    "In Skogestad's rule $c$ multiplies $T_C$ and the dead time, both. Which integral time does that allow?"
)
def _(K_1, T_1, K_2, T_2, delay):
    inner, outer, _ = tuned_inside_out(K_1, T_1, K_2, T_2, delay)
    short = {"secondary": (inner, 4 * delay), "primary": (outer, 6 * delay)}
    return {name: PID(pid.Kp, Ti) for name, (pid, Ti) in short.items() if Ti < pid.Ti}


@inside_out.mistake("What else is in the denominator of Skogestad's gain beside $T_C$?")
def _(K_1, T_1, K_2, T_2, delay):
    inner, outer, _ = tuned_inside_out(K_1, T_1, K_2, T_2, delay)
    return {"secondary": PID(2 * inner.Kp, inner.Ti), "primary": PID(2 * outer.Kp, outer.Ti)}


@inside_out.mistake("That is tuned for the whole process. The primary controller acts on the closed secondary loop.")
def _(K_1, T_1, K_2, T_2, delay):
    late = delay + T_2 / 2
    return {"primary": PID((T_1 + T_2 / 2) / (2 * K_1 * K_2 * late), Min(T_1 + T_2 / 2, 8 * late))}


@inside_out.mistake(
    "The half rule gives half of the neglected lag to the lag that stays. The dead time gets the other half."
)
def _(T_2, delay):
    return {"alone": delay + T_2}


@inside_out.mistake("That is only what comes from the neglected lag. Which dead time was there before?")
def _(T_2, delay):
    return {"alone": T_2 / 2}


@inside_out.mistake(
    "A dead time and a lag are different things: the half rule turns some of the smaller lag into dead time."
)
def _(delay):
    return {"alone": delay}


# --- 11.8 ---------------------------------------------------------------------------------------------------------


def _unequal_halves(K_c, K_h, margin):
    large, small = max(K_c, K_h), min(K_c, K_h)
    return 1.5 * small <= large and margin * small >= 1.2 * large


@exercise("11.8", title="Where to split", points=3, where=_unequal_halves)
def where_to_split(
    K_c=between(0.1, 0.8, "K/%", reference=0.6, step=0.05),
    K_h=between(0.1, 0.8, "K/%", reference=0.2, step=0.05),
    margin=between(3, 6, "", reference=4, step=0.5),
):
    """A fermenter is cooled or heated by one controller in split range: the valve of the chilled water closes from 100
    to 0 % over the lower half of the control signal, the valve of the steam opens over the upper half. For each percent
    by which they open, chilled water makes the fermenter {cold} colder in the end, and steam makes it {warm} warmer.
    Apart from the gains the dynamics are the same.

    Which static gain does the controller see in the lower half, which in the upper one? In which half must it be tuned?
    Suppose somebody tunes it in the other half, with a gain margin of {margin} there: which gain margin is left where
    the gain is larger? And at which control signal should the range be split instead, so that one tuning is right in
    both parts?
    """
    large, small = max(K_c, K_h), min(K_c, K_h)
    return answers(
        lower=number(2 * K_c, "K/%", "the gain in the lower half"),
        upper=number(2 * K_h, "K/%", "the gain in the upper half"),
        tune=word("lower" if K_c > K_h else "upper", ["lower", "upper"], what="the half for the tuning"),
        left=number(margin * small / large, "", "the gain margin that is left"),
        split=number(100 * K_c / (K_c + K_h), "%", "the control signal at which to split"),
    )


@where_to_split.shows
def _(K_c, K_h):
    return {"cold": written(K_c, "K"), "warm": written(K_h, "K")}


@where_to_split.mistake(
    "That is the gain from the opening. How many percent does the valve move for one percent of the control signal?"
)
def _(K_c, K_h):
    return {"lower": K_c, "upper": K_h}


@where_to_split.mistake(
    "A valve travels its full range over half of the signal: is its characteristic then steeper or flatter?"
)
def _(K_c, K_h):
    return {"lower": K_c / 2, "upper": K_h / 2}


@where_to_split.mistake("In the other half the loop gain is then larger than the controller was made for.")
def _(K_c, K_h):
    return {"tune": "upper" if K_c > K_h else "lower"}


@where_to_split.mistake("There the valve with the larger effect has become the steeper one. It needs the wider part.")
def _(K_c, K_h):
    return {"split": 100 * K_h / (K_c + K_h)}


@where_to_split.mistake("There the range is split already, and the two gains differ.")
def _():
    return {"split": 50}


@where_to_split.mistake(
    "The loop gain becomes larger as the fermenter comes into that half. Does the margin grow with it?"
)
def _(K_c, K_h, margin):
    return {"left": margin * max(K_c, K_h) / min(K_c, K_h)}


# --- 11.9 ---------------------------------------------------------------------------------------------------------

HIGHEST = math.sqrt(2) * math.exp(-math.pi / 4)  # of the level, with simc and c = 2, relative to F T_C/(rho A)


def shortest_T_C(period, gain):
    """The T_C with which a wave of a period passes with a flow gain, in %."""
    g = (float(gain) / 100) ** 2
    y = (1 + math.sqrt(1 + g * (1 - g))) / (2 * g)
    return math.sqrt(y) * float(period) / (2 * math.pi)


def longest_T_C(A, F, dh):
    return 1000 * float(A) * float(dh) / (HIGHEST * float(F))


def _some_room(A, F, dh, period, gain):
    return 1.2 < longest_T_C(A, F, dh) / shortest_T_C(period, gain) < 2.5


def buffer_loop(pid, A):
    """The coefficients a, b of s**2 + a s + b in the closed loop; None where that is not stable."""
    Kp, Ti = float(pid.Kp), float(pid.Ti)
    if Kp >= 0 or Ti <= 0:
        return None
    a = -Kp / (1000 * float(A))
    return a, a / Ti


def rise_of_level(pid, A, F):
    """The highest point of the level after a step F of the inflow, in m."""
    if (loop := buffer_loop(pid, A)) is None:
        return math.inf
    a, b = loop
    size, split = float(F) / (1000 * float(A)), a * a / 4 - b
    if b == 0:
        return size / a
    if abs(split) < 1e-9 * a * a:
        return size * 2 / a * math.exp(-1)
    w = math.sqrt(abs(split))
    time = (math.atanh(2 * w / a) if split > 0 else math.atan2(2 * w, a)) / w
    return size * math.exp(-a * time / 2) * (math.sinh if split > 0 else math.sin)(w * time) / w


def flow_gain(pid, A, w):
    """How large a wave of the inflow comes out, in %."""
    if (loop := buffer_loop(pid, A)) is None:
        return math.inf
    a, b = loop
    return 100 * math.sqrt((a * a * w * w + b * b) / ((b - w * w) ** 2 + a * a * w * w))


def largest_flow_gain(pid, A):
    """That of the worst wave, in %; a P controller makes none larger."""
    if (loop := buffer_loop(pid, A)) is None:
        return math.inf
    a, b = loop
    if b == 0:
        return 100.0
    return flow_gain(pid, A, math.sqrt((math.sqrt(b**4 + 2 * a * a * b**3) - b * b) / (a * a)))


def level_after(pid, A, F, time):
    """The deviation of the level at a time after the step of the inflow, in m."""
    if (loop := buffer_loop(pid, A)) is None:
        return math.inf
    a, b = loop
    size, w = float(F) / (1000 * float(A)), cmath.sqrt(a * a / 4 - b)
    if abs(w) < 1e-6 * a:
        return size * time * math.exp(-a * time / 2)
    modes = cmath.exp((w - a / 2) * time) - cmath.exp(-(w + a / 2) * time)
    return size * abs(modes / (2 * w))


@exercise("11.9", title="A lazy tank", points=6, where=_some_room)
def lazy_tank(
    A=between(1, 6, "m²", reference=2),
    F=between(3, 12, "kg/s", reference=6),
    dh=between(0.2, 0.6, "m", reference=0.4, step=0.05),
    period=between(100, 400, "s", reference=250, step=10),
    gain=between(30, 70, "%", reference=40, step=5),
):
    r"""Process water reaches a distillation column by way of a tank with vertical walls and an area of {A}. The pump
    upstream cycles: its flow has a wave with a period of {period}, of which at most {gain} may reach the column. Now
    and then another pump is started; then {F} more flow in for good, and the level must not rise by more than {dh}. Two
    hours later it must be back at its setpoint, to 1 cm. And no wave of any other period may leave the tank with more
    than 130 % of its size. The level controller acts on the outflow $u$ in kg/s, and the density is 1000 kg/m³.

    First, for Skogestad's settings with $c = 2$: the longest time constant $T_C$ that the rise of the level allows.
    Then design a PI controller that meets all the demands, by whatever method; write its gain with the sign that
    belongs to $u = u_0 + K_p(e + \frac{1}{T_i} \int e\,dt)$ with $e = h_{SP} - h$.
    """
    w = 2 * math.pi / float(period)
    longest = longest_T_C(A, F, dh)
    T_C = math.sqrt(longest * shortest_T_C(period, gain))
    return answers(
        T_C=number(longest, "s", "the longest time constant that the level allows"),
        controller=design(
            settings(PID(-1000 * float(A) / T_C, 2 * T_C), gain="kg/(s m)", time="s", what="the settings"),
            criterion("there is no derivative term", lambda pid: pid.Td == 0),
            criterion(
                "the loop is stable",
                lambda pid: buffer_loop(pid, A) is not None,
                otherwise="the loop is not stable: must more or less flow out when the level is too high, and where "
                "is $e$ then?",
            ),
            criterion("the rise of the level", lambda pid: rise_of_level(pid, A, F), below=float(dh), unit="m"),
            criterion(
                "the flow gain at the wave's period", lambda pid: flow_gain(pid, A, w), below=float(gain), unit="%"
            ),
            criterion("the largest flow gain", lambda pid: largest_flow_gain(pid, A), below=130, unit="%"),
            criterion("the deviation two hours later", lambda pid: level_after(pid, A, F, 7200), below=0.01, unit="m"),
        ),
    )


@lazy_tank.mistake(
    "That is what a P controller alone would allow. The integral term keeps the excursion of the level smaller."
)
def _(A, F, dh, period, gain):
    T_C = 1000 * float(A) * float(dh) / float(F)
    return {"T_C": T_C} if abs(T_C / shortest_T_C(period, gain) - 1) > 0.03 else {}


@lazy_tank.mistake(
    "That is where the wave just passes with what is allowed. This demand sets the shortest $T_C$, not the longest."
)
def _(period, gain):
    return {"T_C": shortest_T_C(period, gain)}


@lazy_tank.mistake("The density is missing: the flows are masses per second.")
def _(A, F, dh):
    return {"T_C": longest_T_C(A, F, dh) / 1000}
