"""Python beside the page of exercise 2.2."""

import re


def dots_in(equation):
    """The dots of the highest derivative."""
    return max(len(dots) for dots in re.findall(r"\\(d+)ot", equation))
