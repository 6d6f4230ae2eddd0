"""Exercises as forms of a web page: what is asked becomes fields, and what is typed in them is judged.

A page asks in JSON, and `answer` answers in JSON, in a program on a desk as in a browser that runs Python:

>>> import json
>>> reply = json.loads(answer('{"do": "check", "exercise": "7.1", "answers": {"I": "14.4 mA", "p": "0.85 MPa"}}'))
>>> reply["right"], [(one["name"], one["status"]) for one in reply["verdicts"]]
(False, [('p', 'right'), ('I', 'right'), ('K_p', 'open')])

Nothing is judged here: a text goes to the same ``check`` to which a notebook hands it.
"""

from exercisebook.forms.protocol import answer, version
from exercisebook.forms.sheet import Sheet

__all__ = ["Sheet", "answer", "version"]
