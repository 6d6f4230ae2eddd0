"""Python beside the page of exercise 12.4."""

import re

from loopbook.sequence import Chart

#: What the library says of a chart with each mistake.
SAYS = {
    "dead end": "no transition leaves the step D",
    "orphan": "the step D cannot be reached",
    "covered branch": "comes first and is unconditional",
    "waiting forever": "never active together",
    "twice active": "C",
}


def in_lines(ways, names, most=None):
    """The transitions with the names of the steps, one a line."""
    lines = re.sub(r"\b[A-D]\b", lambda letter: names["ABCD".index(letter[0])], ways).split("; ")
    return "\n".join(lines[: most and int(most)])


def refusal(ways):
    """What is wrong with a chart as the library finds it."""
    parts = [re.fullmatch("(.+) → (.+): (.+)", one).groups() for one in ways.split("; ")]
    transitions = [(before.split(" and "), behind.split(" and "), condition) for before, behind, condition in parts]
    inputs = {condition for *_, condition in transitions} - {"TRUE"}
    try:
        Chart(inputs, {}, {step: {} for step in "ABCD"}, "A", transitions)
    except ValueError as error:
        return next((name for name, words in SAYS.items() if words in str(error)), str(error))
    return "sound"
