"""Python beside the page of exercise A.4."""

from loopbook import diagrams as draw
from loopbook.exercises import authoring
from loopbook.instruments import decode


def place_of(key):
    """Where a symbol says that it is."""
    return authoring.word(key, ["in the field", "in the control room", "behind the panel"], what="the place")


def device_of(key):
    """What its frame says."""
    among = ["own instrument", "shared display", "computer function"]
    return authoring.word(key, among, what="the kind of device")


def line_of(key):
    """What ends at it."""
    among = ["electrical signal", "process connection", "pipe"]
    return authoring.word(key, among, what="what the line from below is")


def solution_picture(place, device, letters):
    """The symbol as it was described."""
    return draw.symbol_table({decode(letters).words: draw.instrument(letters, place, device)})
