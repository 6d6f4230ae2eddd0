"""Python beside the page of exercise 12.3."""

from loopbook.diagrams import sequential_function_chart
from loopbook.sequence import Chart, scan_by_scan

#: The conditions of the branches by their order, with the two limits.
BRANCHES = {
    "Medium Small Large": ("mass < {1}", "mass < {0}", "TRUE"),
    "Small Large Medium": ("mass < {0}", "mass >= {0}", "mass < {1}"),
    "Small Medium Large": ("mass < {0}", "mass < {1}", "TRUE"),
    "Large Small Medium": ("mass >= {1}", "mass < {1}", "mass >= {0}"),
    "Large Medium Small": ("mass >= {1}", "mass >= {0}", "TRUE"),
    "Medium Large Small": ("mass >= {0}", "mass >= {1}", "TRUE"),
}


def branches_of(order, w_1, w_2):
    """The branches in their order: pairs of a step and its condition."""
    conditions = [condition.format(w_1, w_2) for condition in BRANCHES[order]]
    return list(zip(order.split(), conditions, strict=True))


def in_lines(ways):
    """The branches in a list."""
    return "\n".join(f"{n}. to `{size}`: `{condition}`" for n, (size, condition) in enumerate(ways, start=1))


def branch(ways, egg, true, place):
    """The step of that condition, at a place among those that are true, or false, for an egg; None if there is none."""
    holds = {"<": lambda limit: egg < limit, ">=": lambda limit: egg >= limit}
    found = []
    for step, condition in ways:
        _, *parts = condition.split()
        is_true = holds[parts[0]](int(parts[1])) if parts else True
        found += [step] * (bool(is_true) == true)
    return found[int(place)] if place < len(found) and found else None


def missing(sizes, reached):
    """The size that nothing reaches, or none."""
    return next((size for size in sizes if size not in reached), "none")


def way(order, step):
    """Past which steps an egg comes to its own."""
    before = order.split()[: order.split().index(step)] if step else []
    return f"not {' and not '.join(f'`{name}`' for name in before)}, but " if before else "immediately "


def _chart(ways):
    sizes = [size for size, _ in ways]
    steps = {step: {} for step in ("Weigh", *sizes)}
    return Chart("mass", {}, steps, "Weigh", [("Weigh", *one) for one in ways], final=" ".join(sizes))


def run(ways, eggs):
    """Where the chart sends eggs."""
    chart = _chart(ways)
    return [scan_by_scan(chart, mass=[float(egg)] * 2).active[-1][0] for egg in eggs]


def picture(ways):
    """The chart: from Weigh three branches lead to the sizes, from left to right in the order of the list."""
    return sequential_function_chart(_chart(ways))
