"""Python beside the page of exercise 2.7."""

from exercisebook.parameters import written
from loopbook import diagrams as draw


def block_by_block(layout, K, a, c, u, d, y):
    """What comes to the integrator."""
    x = K * (u - d) if layout == "before the gain" else K * u
    x = a * (x - d - c * y) if layout == "behind the gain" else a * (x - c * y)
    return x - d if layout == "before the integrator" else x


def picture(layout, K, a, c, y_0):
    """A block diagram from $u$ to $y$: {first}the gain {K}, {second}a sum that subtracts what comes back from $y$
    through the gain {c}, the gain {a}, {third}and an integrator that holds {y_0}."""
    gain, enters = draw.gain(written(K)), draw.disturbance("d", sign="-")
    inside = [draw.gain(written(a)), draw.integrator(written(y_0))]
    if layout == "before the integrator":
        inside.insert(1, enters)
    loop = draw.feedback_loop(inside, draw.gain(written(c)))
    before = {"behind the gain": [gain, enters], "before the gain": [enters, gain]}.get(layout, [gain])
    return draw.block_diagram("u", *before, loop, "y")
