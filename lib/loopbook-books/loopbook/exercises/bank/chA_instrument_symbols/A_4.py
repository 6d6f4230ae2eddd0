"""The symbol of exercise A.4."""

from loopbook import diagrams as draw
from loopbook.exercises import authoring
from loopbook.instruments import decode


def what_it_is(key, what, among):
    """A word for what a symbol says."""
    return authoring.word(key, among, what=what)


def solution_picture(place, device, letters):
    """The symbol as it was described."""
    return draw.symbol_table({decode(letters).words: draw.instrument(letters, place, device)})
