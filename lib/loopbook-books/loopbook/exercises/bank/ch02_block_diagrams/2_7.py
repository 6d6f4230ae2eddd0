"""Python beside the page of exercise 2.7."""

import numpy as np
import sympy

from exercisebook.parameters import written
from loopbook import diagrams as draw
from loopbook.expressions import t
from loopbook.figures import time_plot


def block_by_block(layout, K, a, c, u, d, y):
    """What comes to the integrator."""
    x = K * (u - d) if layout == "before the gain" else K * u
    x = a * (x - d - c * y) if layout == "behind the gain" else a * (x - c * y)
    return x - d if layout == "before the integrator" else x


def formula_of(layout, K, a, c):
    """The formula as a hand would write it."""
    K, a, c = map(written, (K, a, c))
    return {
        "behind the gain": rf"{a}\,({K}\,u - d - {c}\,y)",
        "before the integrator": rf"{a}\,({K}\,u - {c}\,y) - d",
        "before the gain": rf"{a}\,({K}\,(u - d) - {c}\,y)",
    }[layout]


def in_words(layout, K, a, c, y_0):
    """The blocks one after the other."""
    enters, before, after = "minus $d$", [f"gain {written(K)}"], [f"gain {written(a)}"]
    path = {"behind the gain": [*before, enters], "before the gain": [enters, *before]}.get(layout, before)
    after += [enters] if layout == "before the integrator" else []
    loop = f"sum minus what comes back from $y$ through the gain {written(c)}"
    words = ", then ".join([*path, loop, *after, f"integrator that holds {written(y_0)}"])
    return f"from $u$ through {words}, to $y$"


def picture(layout, K, a, c, y_0):
    """A block diagram: {diagram}."""
    gain, enters = draw.gain(written(K)), draw.disturbance("d", sign="-")
    inside = [draw.gain(written(a)), draw.integrator(written(y_0))]
    if layout == "before the integrator":
        inside.insert(1, enters)
    loop = draw.feedback_loop(inside, draw.gain(written(c)))
    before = {"behind the gain": [gain, enters], "before the gain": [enters, gain]}.get(layout, [gain])
    return draw.block_diagram("u", *before, loop, "y")


def solution_picture(a, c, y_0, rest):
    """The output on its way from what the integrator holds at the beginning to its rest."""
    y = rest + (y_0 - rest) * sympy.exp(-a * c * t)
    times = np.linspace(0, 5 / float(a * c), 201)
    return time_plot({"$y$": (y, "measurement")}, times, xlabel="$t$ [min]").level(rest, "at rest")
