"""Python beside the page of exercise 11.11."""

from loopbook.exercises.bank.ch11_control_structures.shared import vessels


def picture(place):
    """Three vessels in a row with the valves V1 to V4, and a filter in one pipe; no controller is connected yet."""
    pipes = [["Filter", f"V{n}"] if n == place else [f"V{n}"] for n in range(1, 5)]
    return vessels("feed", pipes, "pigment")
