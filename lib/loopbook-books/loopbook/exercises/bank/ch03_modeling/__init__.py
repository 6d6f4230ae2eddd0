"""Exercises of chapter 3, mathematical modeling."""

import functools
import itertools
import math

import numpy as np
import sympy

from exercisebook.parameters import written
from loopbook import diagrams as draw
from loopbook.exercises.authoring import (
    answers,
    between,
    choice,
    criterion,
    design,
    exercise,
    expression,
    number,
    time_function,
    word,
)
from loopbook.expressions import t
from loopbook.figures import plane_plot, time_plot


# Circuits of two resistors and a capacitor: what they look like, how they are drawn, and the rate of the capacitor's
# voltage v.
R_1, R_2, C, V_IN, V_C = sympy.symbols("R_1 R_2 C v_in v", positive=True)
CIRCUITS = {
    "loaded": (
        "A resistor $R_1$ leads from the input to the output. From the output to ground lead a capacitor $C$ and, "
        "beside it, a resistor $R_2$, which is the input resistance of the instrument that reads the voltage",
        (["R_1"], ["C", "R_2"], False),
        ((V_IN - V_C) / R_1 - V_C / R_2) / C,
    ),
    "stepped": (
        "A resistor $R_1$ leads from the input to the output. From the output to ground lead, one behind the other, a "
        "resistor $R_2$ and a capacitor $C$",
        (["R_1"], ["R_2", "C"], True),
        (V_IN - V_C) / (R_1 + R_2) / C,
    ),
    "bridged": (
        "A resistor $R_1$ and, beside it, a capacitor $C$ lead from the input to the output. From the output to "
        "ground leads a resistor $R_2$",
        (["R_1", "C"], ["R_2"], False),
        ((V_IN - V_C) / R_2 - V_C / R_1) / C,
    ),
}


def _lag(circuit, R_1, R_2, C):
    return (R_1 + R_2) * C if circuit == "stepped" else R_1 * R_2 * C / (R_1 + R_2)


def _slow_and_fast(circuit, r_1, r_2):
    """By what the circuit multiplies a constant voltage, and a very fast one."""
    share = r_2 / (r_1 + r_2)
    return {
        "loaded": (share, sympy.Integer(0)),
        "stepped": (sympy.Integer(1), share),
        "bridged": (share, sympy.Integer(1)),
    }[circuit]


@exercise(
    "3.6",
    title="Two resistors and a capacitor",
    points=5,
    where=lambda r_1, r_2: r_1 != r_2,
    insight="Ask what a capacitor does at the two ends: it stops a constant current, and lets a very fast one through.",
)
def two_resistors(
    circuit=choice(*CIRCUITS, reference="loaded"),
    r_1=between(1, 20, "kΩ", reference=5),
    r_2=between(2, 60, "kΩ", reference=20),
    c=choice(1, 2, 5, 10, 20, 50, unit="µF", reference=10),
):
    r"""{looks}. Nothing else takes a current from the output.

    The voltage over the capacitor is $v$, with its plus at the side towards the input. Set up the balance of the
    currents: with which rate $\dot v$ does it change, as a formula in $v$, the input voltage $v_{in}$, $R_1$, $R_2$
    and $C$?

    Now let $R_1$ = {r_1}, $R_2$ = {r_2} and $C$ = {c}. With which time constant does the capacitor follow? By which
    factor does the circuit multiply a constant voltage on its way to the output, and by which one a voltage that
    changes very fast?
    """
    slow, fast = _slow_and_fast(circuit, r_1, r_2)
    return answers(
        rate=expression(
            CIRCUITS[circuit][2], "the rate of the voltage over the capacitor", symbols="R_1 R_2 C v_in v", unit="V/s"
        ),
        T=number(_lag(circuit, r_1, r_2, c), "ms", "the time constant"),
        slow=number(slow, "", "the factor for a constant voltage"),
        fast=number(fast, "", "the factor for a very fast one"),
    )


@two_resistors.picture
def _(circuit, r_1, r_2, c):
    """The circuit. {looks}. The voltage v over the capacitor has its plus at the side towards the input."""
    values = {"R_1": written(r_1, "kΩ"), "R_2": written(r_2, "kΩ"), "C": written(c, "µF")}
    title = ", ".join(f"${name}$ = {value}" for name, value in values.items())
    return draw.voltage_divider(*CIRCUITS[circuit][1], title=title, voltages={"C": "v"})


@two_resistors.mistake("There is a second resistor, and a current flows through it as well.")
def _(circuit, r_1, c):
    alone = {"loaded": (V_IN - V_C) / (R_1 * C), "stepped": (V_IN - V_C) / (R_1 * C), "bridged": -V_C / (R_1 * C)}
    return {"rate": alone[circuit], "T": r_1 * c}


@two_resistors.mistake("There is a second resistor, and a current flows through it as well.")
def _(circuit, r_2, c):
    alone = {"loaded": -V_C / (R_2 * C), "stepped": (V_IN - V_C) / (R_2 * C), "bridged": (V_IN - V_C) / (R_2 * C)}
    return {"rate": alone[circuit], "T": r_2 * c}


@two_resistors.mistake(
    "Which of the currents charge the capacitor, and which one discharges it? They have opposite signs."
)
def _(circuit):
    wrong = {
        "loaded": ((V_IN - V_C) / R_1 + V_C / R_2) / C,
        "stepped": (V_IN + V_C) / ((R_1 + R_2) * C),
        "bridged": ((V_IN - V_C) / R_2 + V_C / R_1) / C,
    }
    return {"rate": wrong[circuit]}


@two_resistors.mistake("Across which of the two resistors is the output voltage?")
def _(circuit, r_1, r_2):
    return {"fast" if circuit == "stepped" else "slow": r_1 / (r_1 + r_2)} if abs(r_1 / r_2 - 1) > 0.03 else {}


@two_resistors.mistake(
    "Replace the source by a wire, for which its voltage is zero. Are the two resistors, seen from the capacitor, "
    "in series or in parallel?"
)
def _(circuit, r_1, r_2, c):
    return {"T": r_1 * r_2 * c / (r_1 + r_2) if circuit == "stepped" else (r_1 + r_2) * c}


@two_resistors.mistake(
    "Replace the source by a wire, for which its voltage is zero. Are the two resistors, seen from the capacitor, "
    "in series or in parallel?"
)
def _(circuit):
    end = {"loaded": V_IN * R_2 / (R_1 + R_2), "stepped": V_IN, "bridged": V_IN * R_1 / (R_1 + R_2)}[circuit]
    lag = R_1 * R_2 / (R_1 + R_2) if circuit == "stepped" else R_1 + R_2
    return {"rate": (end - V_C) / (lag * C)}


@two_resistors.mistake("Which of the three parts share one current, and which of them share one voltage?")
def _(circuit):
    _, _, other = CIRCUITS["loaded" if circuit == "stepped" else "stepped"]
    return {"rate": other}


@two_resistors.mistake("When the capacitor is charged, it takes no current. To which voltage is it charged, then?")
def _(circuit):
    end = {"loaded": V_IN, "stepped": V_IN * R_2 / (R_1 + R_2), "bridged": V_IN}[circuit]
    return {"rate": (end - V_C) / (_lag(circuit, R_1, R_2, C))}


@two_resistors.mistake("That is a current. Which law connects the current into a capacitor with its voltage?")
def _(circuit):
    return {"rate": CIRCUITS[circuit][2] * C}


@two_resistors.mistake("That is the circuit with its values. Give the formula in the symbols.")
def _(circuit, r_1, r_2, c):
    return {"rate": CIRCUITS[circuit][2].subs({R_1: 1000 * r_1, R_2: 1000 * r_2, C: c / 10**6})}


@two_resistors.mistake("A capacitor lets no constant current through, and is like a wire for a very fast one.")
def _(circuit, r_1, r_2):
    slow, fast = _slow_and_fast(circuit, r_1, r_2)
    return {"slow": fast, "fast": slow}


def _seen_otherwise(name, wrong):
    """One of the two factors as 0 or 1, where neither of them is that."""

    def found(circuit, r_1, r_2):
        return {name: wrong} if wrong not in _slow_and_fast(circuit, r_1, r_2) else {}

    return found


for _name, _sentence in (
    ("slow", "Take the capacitor out of the circuit. Through which resistors does a current flow then?"),
    ("fast", "Put a wire in the place of the capacitor. Which parts are bridged by it, and where is the output then?"),
):
    for _wrong in (0, 1):
        two_resistors.mistake(_sentence)(_seen_otherwise(_name, _wrong))

two_resistors.hints(
    "Kirchhoff's law of currents: what flows into a junction flows out of it. The current into a capacitor is "
    "$C\\dot v$, that through a resistor is its voltage over $R$.",
    "{way}",
    "For the two factors, take the capacitor out of the circuit (constant voltage), and then put a wire in its place "
    "(very fast). With $R_1 = {r_1}$ and $R_2 = {r_2}$, in kΩ, what is left is a voltage divider, or less than that.",
)


@two_resistors.shows
def _(circuit):
    way = {
        "loaded": "At the output three branches meet: what comes through $R_1$, with the voltage $v_{in} - v$, goes on "
        "through $C$ and through $R_2$, which both have the voltage $v$.",
        "stepped": "All three are one behind the other and share one current. The two resistors together have the "
        "voltage $v_{in} - v$.",
        "bridged": "The voltage over $R_1$ is $v$ as well, so $R_2$ has $v_{in} - v$. What comes through $C$ and $R_1$ "
        "together goes on through $R_2$.",
    }
    return {"looks": CIRCUITS[circuit][0], "way": way[circuit]}


@two_resistors.solution
def _(circuit, r_1, r_2, c):
    r"""{way} So the balance of the currents is

    $${balance}$$

    and solved for the rate it is $\dot v = {solved}$.

    **The time constant.** Collect what has $v$ in it and bring the equation to the form $T\dot v + v = \dots$: in
    front of the rate is {lag}, with the two resistors in {together}. With kΩ times µF in milliseconds, $T$ = {T}.

    **A constant voltage.** The capacitor is charged and takes no current. Take it out of the circuit: what is left
    multiplies the voltage by {how_slow}{slow}.

    **A very fast one.** The capacitor has no time to change its voltage, and lets the current through like a wire:
    now the circuit multiplies it by {how_fast}{fast}.
    """
    balance = {
        "loaded": r"\frac{v_{in} - v}{R_1} = C\dot v + \frac{v}{R_2}",
        "stepped": r"C\dot v = \frac{v_{in} - v}{R_1 + R_2}",
        "bridged": r"C\dot v + \frac{v}{R_1} = \frac{v_{in} - v}{R_2}",
    }
    solved = {
        "loaded": r"\frac{1}{C}\left(\frac{v_{in} - v}{R_1} - \frac{v}{R_2}\right)",
        "stepped": r"\frac{v_{in} - v}{(R_1 + R_2)\,C}",
        "bridged": r"\frac{1}{C}\left(\frac{v_{in} - v}{R_2} - \frac{v}{R_1}\right)",
    }
    in_series = circuit == "stepped"
    share = r"$\frac{R_2}{R_1 + R_2}$, which is "
    return {
        "how_slow": "" if in_series else share,
        "how_fast": share if in_series else "",
        "balance": balance[circuit],
        "solved": solved[circuit],
        "lag": r"$(R_1 + R_2)\,C$" if in_series else r"$\frac{R_1 R_2}{R_1 + R_2}\,C$",
        "together": "series" if in_series else "parallel",
    }


@two_resistors.solution_picture
def _(circuit, r_1, r_2, c):
    """The output after a step of the input, from the factor for very fast voltages to that for constant ones."""
    slow, fast = _slow_and_fast(circuit, r_1, r_2)
    T = _lag(circuit, r_1, r_2, c)
    output = slow + (fast - slow) * sympy.exp(-t / T)
    axes = {"xlabel": "$t$ [ms]", "ylabel": "$v_{out}/v_{in}$", "ylim": (-0.05, 1.1)}
    return time_plot({"$v_{out}$": (output, "measurement")}, np.linspace(0, 5 * float(T), 201), **axes).level(
        slow, "slow"
    )


