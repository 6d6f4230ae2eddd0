"""The live lessons of the book: what a slider does to a loop, computed by the library and shown by the page alone."""

from lessons.store import load, of_cell, recorded, titles

__all__ = ["load", "of_cell", "recorded", "titles"]
