"""Python beside the page of exercise 11.11."""

from loopbook import diagrams


def picture(place):
    """Three vessels in a row with the valves V1 to V4, and a filter in one pipe; no controller is joined yet."""
    row, above, far = ["feed"], ["."], ["."]
    for n in range(1, 5):
        pipe = ["Filter", f"V{n}"] if n == place else [f"V{n}"]
        row, above, far = row + pipe, above + ["."] * len(pipe), far + ["."] * len(pipe)
        if n < 4:
            row, above, far = [*row, f"T{n}"], [*above, f"LT{n}"], [*far, f"LC{n}"]
    row, above, far = [*row, "pigment"], [*above, "."], [*far, "."]
    layout = "\n".join(" ".join(line) for line in (far, above, row))
    parts = {f"T{n}": diagrams.vessel(str(n), filled=0.5) for n in range(1, 4)} | {"Filter": "Filter"}
    parts |= {valve: diagrams.control_valve(valve) for valve in ("V1", "V2", "V3", "V4")}
    signals = ", ".join(f"T{n} LT{n} LC{n}" for n in range(1, 4))
    return diagrams.instrumentation_diagram(layout, " ".join(row), signals, parts)
