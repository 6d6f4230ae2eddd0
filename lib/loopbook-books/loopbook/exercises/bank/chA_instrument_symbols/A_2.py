"""The drawing of exercise A.2."""

from loopbook import diagrams as draw
from loopbook.instruments import decode

#: Where each quantity is measured, and to whom each device speaks.
PLACES = {"PD": "Filter", "V": "Oil pump", "FF": "Mixer", "D": "Thickener", "TD": "Cooler", "S": "Fan", "Q": "Reactor"}
PLACES |= {"LD": "Screen", "G": "Gate"}
HEARD_BY = {"IC": "valve", "IT": "controller", "AH": "horn", "AL": "horn"}


def one_by_one(letters):
    """The letters of a text."""
    return list(letters)


def is_read_as(tag, device, measured):
    """Whether a tag is read with these words."""
    read = decode(tag)
    named = (read.measured, read.modifier, read.limit, read.functions[-1])
    return all(word in f"{device} of {measured}" for word in named if word)


def picture(symbol, does):
    """A part of a plant, and above it a circle without letters: {device} of {measured}."""
    layout = """
        .   .  heard  .  .
        .   .  .      .  .
        .   .  empty  .  .
        in  1  place  2  out"""
    parts = {"empty": draw.instrument(""), "place": PLACES[symbol]}
    names, pipes = {"in": "feed", "out": "product", "heard": HEARD_BY[does]}, "in 1 place 2 out"
    if symbol == "FF":
        layout += "\n        .  .  3  product  ."
        names, pipes = names | {"in": "syrup", "out": "water"}, "in 1 place, out 2 place 3 product"
    lines = {"measuring line": "1 empty, 2 empty" if len(symbol) > 1 else "place empty"}
    return draw.instrumentation_diagram(layout, pipes, "empty heard", parts, names, lines=lines)
