"""Python beside the page of exercise 11.3."""

from loopbook.exercises.bank.ch11_control_structures.shared import vessels


def with_valve(action, name, closing):
    """The action of a controller: the other one where its valve closes as the signal rises."""
    return {"reverse": "direct", "direct": "reverse"}[action] if name in closing else action


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
    """The four tanks in a row, and the flow controller {position}."""
    pipes = [["FT", "V"] if n == place else [] for n in range(5)]
    return vessels("milk", pipes, "filling", {"FT": ("FC", "."), "V": ("9", ".")}, "FT FC 9 V")
