"""The live lessons of the book: what a slider does to a loop, computed by the library and shown by the page alone."""

from lessons.store import NAMES, PLACES, data, load

__all__ = ["NAMES", "PLACES", "data", "load"]
