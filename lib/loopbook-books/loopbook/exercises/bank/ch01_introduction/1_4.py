"""Python beside the page of exercise 1.4."""

from exercisebook.parameters import written
from loopbook import diagrams as draw


def picture(A, h_0, h_low, q, more):
    """A tank of {A} with the level {h_0}: a pump brings {q}, {q} are drawn, and a hydrant takes {more} besides."""
    layout = """
        water  pump  in    1     .     .      .
        .      .     .     tank  tank  .      .
        .      .     .     tank  tank  .      drawn
        .      .     .     tank  tank  valve  hydrant
        .      .     .     tank  tank  LAL    alarm"""
    tank = draw.tank(f"${written(A)}$ m²", level=f"${written(h_0)}$ m", filled=0.9)
    parts = {"pump": draw.pump(), "valve": draw.valve(kind="hand"), "tank": tank}
    names = {"in": f"${written(q)}$ L/s", "drawn": f"${written(q)}$ L/s", "hydrant": f"${written(more)}$ L/s"}
    names["alarm"] = f"at ${written(h_low)}$ m"
    pipes = "water pump in 1 tank drawn, tank valve hydrant"
    return draw.instrumentation_diagram(layout, pipes, "tank LAL", parts, names)
