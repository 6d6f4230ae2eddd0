"""Writes the cheat sheet alone: ``cd docs; ../.venv/bin/python -m cheat_sheet cheat_sheet.pdf``."""

import sys

from cheat_sheet.contents import LETTERS, TITLE, sections
from cheat_sheet.layout import draw

draw(sections(), TITLE, LETTERS, *sys.argv[1:])
