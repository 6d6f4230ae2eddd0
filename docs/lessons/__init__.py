"""The live lessons of the book: what a slider does to a loop, computed by the library and shown by the page alone."""

from lessons.store import NAMES, data, load

__all__ = ["NAMES", "data", "load"]
