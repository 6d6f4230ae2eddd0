"""Python beside the page of exercise 6.1."""

from loopbook import diagrams


def picture(q_in, q_out, start, top):
    """A tank with a level; water flows in from above, and a pump takes it out."""
    layout = """
        q_in  1     .     .
        .     tank  .     .
        .     2     pump  q_out"""
    parts = {"tank": diagrams.tank(level="h", filled=float(0.9 * start / top)), "pump": diagrams.pump()}
    names = {"q_in": f"${q_in}$ L/s", "q_out": f"${q_out}$ L/s"}
    return diagrams.instrumentation_diagram(layout, "q_in 1 tank 2 pump q_out", "", parts, names)
