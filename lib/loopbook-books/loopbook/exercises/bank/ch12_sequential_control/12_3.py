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


def conditions(order, w_1, w_2):
    """The conditions of the branches in their order."""
    return [condition.format(w_1, w_2) for condition in BRANCHES[order]]


def in_lines(order, w_1, w_2):
    """The branches in a list."""
    pairs = zip(order.split(), conditions(order, w_1, w_2), strict=True)
    return "\n".join(f"{n}. to `{size}`: `{condition}`" for n, (size, condition) in enumerate(pairs, start=1))


def branch(order, w_1, w_2, egg, true, place):
    """The step of that condition, at a place among those that are true, or false, for an egg; None if there is none."""
    found = []
    for step, condition in zip(order.split(), conditions(order, w_1, w_2), strict=True):
        _, relation, limit = f"{condition} x x".split()[:3]
        is_true = egg < int(limit) if relation == "<" else relation == "x" or egg >= int(limit)
        found += [step] * (bool(is_true) == true)
    return found[int(place)] if place < len(found) and found else None


def missing(sizes, reached):
    """The size that nothing reaches, or none."""
    return next((size for size in sizes if size not in reached), "none")


def way(order, step):
    """Past which steps an egg comes to its own."""
    before = order.split()[: order.split().index(step)] if step else []
    return f"not {' and not '.join(f'`{name}`' for name in before)}, but " if before else "immediately "


def _chart(order, w_1, w_2):
    ways = [("Weigh", *one) for one in zip(order.split(), conditions(order, w_1, w_2), strict=True)]
    return Chart("mass", {}, {step: {} for step in ("Weigh", *order.split())}, "Weigh", ways, final=order)


def run(order, w_1, w_2, eggs):
    """Where the chart sends eggs."""
    chart = _chart(order, w_1, w_2)
    return [scan_by_scan(chart, mass=[float(egg)] * 2).active[-1][0] for egg in eggs]


def picture(order, w_1, w_2):
    """The chart: from Weigh three branches lead to the sizes, from left to right in the order of the list."""
    return sequential_function_chart(_chart(order, w_1, w_2))
