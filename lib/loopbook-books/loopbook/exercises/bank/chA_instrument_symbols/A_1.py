"""Python beside the page of exercise A.1."""

from loopbook import diagrams as draw
from loopbook.exercises import authoring
from loopbook.instruments import decode


def number_of_loop(key):
    """The number, which is given in the tag."""
    return authoring.number(key, "", "the number of the loop", within=0)


def in_code(letters, loop):
    """The tag with its number."""
    return f"`{letters}{loop}`"


def joined(names):
    """Names in a sentence."""
    return " and ".join(names)


def read_functions(letters):
    """What the subsequent letters do, in their order, without the remarks in brackets."""
    return [part.meaning.partition(" (")[0] for part in decode(letters).at("function")]


def letter_by_letter(letters):
    """What each letter says."""
    return ", ".join(f"{part.letter} says {part.meaning.partition(' (')[0]}" for part in decode(letters).parts)


def phrase(letters, loop):
    """The tag in words."""
    return decode(f"{letters}{loop}").words


def picture(letters, loop):
    """A part of a drawing: from a plant, in which something is measured, a line leads to the instrument
    {letters}{loop}."""
    layout = """
        .       instrument  .
        stream  Plant       product"""
    parts = {"instrument": draw.instrument(f"{letters}{loop}"), "Plant": "Plant"}
    line = {"measuring line": "Plant instrument"}
    return draw.instrumentation_diagram(layout, "stream Plant product", "", parts, lines=line)


def solution_picture(letters, loop):
    """The symbol of this instrument, in the control room."""
    return draw.symbol_table({decode(letters).words: draw.instrument(f"{letters}{loop}", "panel")})
