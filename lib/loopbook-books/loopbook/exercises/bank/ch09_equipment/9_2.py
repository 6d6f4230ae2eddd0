"""Python beside the page of exercise 9.2."""

from exercisebook import authoring
from exercisebook.parameters import written
from loopbook import diagrams as draw


def whole(bits_needed):
    """A number of bits, which has no tolerance."""
    return authoring.number(bits_needed, what="the number of bits", within=0)


def count_up(span, bits):
    """The kilograms of a step: the full scale over the steps between all values."""
    return 1000 * span / sum(2**one for one in range(int(bits)))


def tried(span, finest):
    """The smallest number of bits for a step, found by trying one after the other."""
    return next(bits for bits in range(1, 40) if count_up(span, bits) <= finest)


def picture(span, bits):
    """A silo on load cells of 0 to {span}; the input of the controller converts their signal to {bits} bits."""
    parts = {
        "silo": draw.silo(),
        "cells": f"Load cells\n$0$ to ${written(span)}$ t",
        "input": f"Input\n${written(bits)}$ bits",
        "controller": "Controller",
    }
    row = " ".join(parts)
    return draw.instrumentation_diagram(row, "", row, parts)
