"""Python beside the page of exercise 12.1."""

from loopbook.diagrams import sequential_function_chart
from loopbook.sequence import Chart


def _chart(m):
    steps = {"Wait": {"u_cap": False}, "Fill": {"u_valve": True}, "Cap": {"u_valve": False, "u_cap": True}, "Away": {}}
    ways = [("Wait", "Fill", "bottle"), ("Fill", "Cap", f"mass >= {float(m):g}"), ("Cap", "Away", "TRUE")]
    ways.append(("Away", "Wait", "NOT bottle"))
    return Chart(("bottle", "mass"), {"u_valve": False, "u_cap": False}, steps, "Wait", ways)


def run(arrival, m, q):
    """When the steps behind Wait become active, scan by scan, and the mass in the end."""
    chart, mass, begun, valve = _chart(m), 0, {}, 0
    for time in range(30):
        mass += q * int(valve)
        valve = chart.update({"bottle": int(bool(time >= arrival)), "mass": float(mass)}, time)["u_valve"]
        begun.setdefault(chart.active[0], time)
    return [begun["Fill"], begun["Cap"], begun["Away"], mass]


def picture(m):
    """The chart: the steps Wait, Fill, Cap and Away in a circle, with their actions, as in the table."""
    return sequential_function_chart(_chart(m))
