"""Python beside the page of exercise 12.5."""

import functools
from itertools import pairwise

from loopbook.diagrams import sequential_function_chart
from loopbook.sequence import Chart


def _chart(T_SP, n, dose, react):
    second = [f"Dose{k}" for k in range(1, int(n) + 1)] + ["Ready"]
    ways = [("Start", ("Heat", "Dose1"), "button"), ("Heat", "Hold", f"T >= {T_SP}")]
    ways += [(one, other, f"{one}.T >= {dose}") for one, other in pairwise(second)]
    ways += [(("Hold", "Ready"), "React", "TRUE"), ("React", "Start", f"React.T >= {react}")]
    steps = {step: {} for step in ("Start", "Heat", "Hold", *second, "React")}
    return Chart(("button", "T"), {}, steps, "Start", ways)


def markings(*givens):
    """How many sets of steps can be active together."""
    return len(_chart(*givens).markings)


@functools.cache
def run(T_0, T_SP, rate, n, dose, react):
    """When React begins and ends, in min, and which step is active alone at the end of its branch before that."""
    chart, scan, seen, waits = _chart(T_SP, n, dose, react), 0.05, [], ""
    for k in range(10_000):
        T = float(T_0) + float(rate) * scan * max(k - 1, 0)
        chart.update({"button": 1, "T": T}, scan * k)
        waits = waits or next((step for step in ("Hold", "Ready") if step in chart.active), "")
        seen += ["React" in chart.active]
        if seen[-2:] == [True, False]:
            return [scan * (seen.index(True) - 1), scan * (k - 1), waits]


def solution_picture(T_SP, n, dose, react):
    """The chart, with its two simultaneous branches."""
    return sequential_function_chart(_chart(T_SP, n, dose, react))
