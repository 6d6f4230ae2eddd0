"""What several pages of chapter 13 need."""


def factor(value):
    """A factor in a formula; a factor of one is not written."""
    return "" if value == 1 else rf"{float(value):g}\,"
