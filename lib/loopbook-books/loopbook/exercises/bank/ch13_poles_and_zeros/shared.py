"""What several pages of chapter 13 need."""

from loopbook.laplace import evaluate


def factor(value):
    """A factor in a formula; a factor of one is not written."""
    return "" if value == 1 else rf"{float(value):g}\,"


def at(y, time):
    """The value of a function of time."""
    return float(evaluate(y, [float(time)])[0])
