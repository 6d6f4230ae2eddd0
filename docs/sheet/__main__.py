"""Writes the cheat sheet alone: ``cd docs; ../.venv/bin/python -m sheet cheat_sheet.pdf``."""

import sys

from sheet.contents import LETTERS, TITLE, sections
from sheet.layout import draw

draw(sections(), TITLE, LETTERS, *sys.argv[1:])
