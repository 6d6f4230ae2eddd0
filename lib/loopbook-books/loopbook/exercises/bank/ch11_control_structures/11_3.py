"""Python beside the page of exercise 11.3."""

from loopbook import diagrams


def with_valve(action, name, closing):
    """The action of a controller: the other one where its valve closes as the signal rises."""
    return {"reverse": "direct", "direct": "reverse"}[action] if name in closing else action


def except_for(closing):
    """What the statement says of the valves that close."""
    two = "and" in closing
    return ("two exceptions: the valves of {} are open" if two else "one exception: the valve of {} is open").format(
        closing
    )


def highest_in_the_end(place, closing, actions):
    """The largest deviation of four levels that begin too high, each under a P controller with its action."""
    levels = [1.0] * 4
    for _ in range(400):
        flows = [0.0] * 5
        for n, action in enumerate(actions, 1):
            signal = levels[n - 1] if action == "direct" else -levels[n - 1]
            flows[n - 1 if n <= place else n] = -signal if f"LC{n}" in closing else signal
        levels = [level + 0.1 * (flows[n] - flows[n + 1]) for n, level in enumerate(levels)]
    return max(map(abs, levels))


def picture(place):
    """The four tanks, and the flow controller in one of the five pipes."""
    tanks, pipes, above, far = ["milk"], ["milk"], ["."], ["."]
    for n in range(5):
        if n == place:
            tanks, above, far = [*tanks, "FT", "V"], [*above, "FC", "9"], [*far, ".", "."]
            pipes += ["FT", "V"]
        if n < 4:
            tanks, above, far = [*tanks, f"T{n + 1}"], [*above, f"LT{n + 1}"], [*far, f"LC{n + 1}"]
            pipes.append(f"T{n + 1}")
    rows = [[*far, "."], [*above, "."], [*tanks, "filling"]]
    layout = "\n".join(" ".join(row) for row in rows)
    parts = {f"T{n}": diagrams.vessel(str(n), filled=0.5) for n in range(1, 5)} | {"V": diagrams.control_valve()}
    signals = ", ".join(["FT FC 9 V", *(f"T{n} LT{n} LC{n}" for n in range(1, 5))])
    return diagrams.instrumentation_diagram(layout, " ".join([*pipes, "filling"]), signals, parts)
