"""What several exercises of chapter 8 need."""

from loopbook.expressions import parse


def in_numbers(formula, **values):
    """A formula with numbers for its symbols."""
    found = parse(str(formula))
    return found.subs({symbol: values[symbol.name] for symbol in found.free_symbols})
