"""The exercises of the chapters as forms of a web page.

>>> import json
>>> reply = json.loads(answer('{"do": "check", "exercise": "7.1", "answers": {"I": "14.4 mA", "p": "0.85 MPa"}}'))
>>> reply["right"], [(one["name"], one["status"]) for one in reply["verdicts"]]
(False, [('p', 'right'), ('I', 'right'), ('gain', 'open')])
>>> answer('{"do": "check", "exercise": "7.77"}')
'{"problem": "there is no exercise \\'7.77\\': did you mean \\'7.7\\'?"}'
"""

from exercisebook.forms import Desk, Sheet, version
from loopbook.exercises.bank import BANK

__all__ = ["Sheet", "answer", "version"]

answer = Desk(BANK.exercise).answer
