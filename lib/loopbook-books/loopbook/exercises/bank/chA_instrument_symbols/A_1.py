"""The instrument of exercise A.1."""

from loopbook import diagrams as draw
from loopbook.instruments import decode


def read(letters, loop):
    """The tag as the library reads it."""
    return decode(f"{letters}{loop}")


def letter_by_letter(letters):
    """What each letter says, without the remarks in brackets."""
    return ", ".join(f"{part.letter} says {part.meaning.partition(' (')[0]}" for part in decode(letters).parts)


def picture(letters, loop):
    """A part of a drawing: a plant, with a measuring line to the instrument {letters}{loop}."""
    layout = """
        .       instrument  .
        stream  Plant       product"""
    parts = {"instrument": draw.instrument(f"{letters}{loop}"), "Plant": "Plant"}
    line = {"measuring line": "Plant instrument"}
    return draw.instrumentation_diagram(layout, "stream Plant product", "", parts, lines=line)
