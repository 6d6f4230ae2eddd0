"""Exercises as forms of a web page: what is asked becomes fields, and what is typed in them is judged.

A page asks in JSON, and a `Desk` answers in JSON, in a program on a desk as in a browser that runs Python. Nothing is
judged here: a text goes to the same ``check`` to which a notebook hands it.
"""

from exercisebook.forms.protocol import Desk, version
from exercisebook.forms.sheet import Sheet

__all__ = ["Desk", "Sheet", "version"]
