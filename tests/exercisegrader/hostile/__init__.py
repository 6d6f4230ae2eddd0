"""The hostile corpus: what students might submit who want marks for nothing, or the machine.

Every attack is real. None must ever run outside a jail: those that would do harm look for a jail first, and where there
is none they do nothing, and say so in an answer. Looking at the corpus and making its files does nothing.

How a test uses it:

    target = Target(answers={"1": 'sheet.answer("1", K=1.5)', "2": ...}, leak=("4", "becomes"), names=("H",), ...)
    for attack in ATTACKS:
        attack.submit(target, folder, "s1001", "air_heater.ipynb")     # or a zip of attack.archive("s1001", right)
    ... grade, with about 2 s for a cell and 6 s in all ...
    assert not attack.complaints(result_of_s1001, target)

Around each attack, or around a class of them, the test has honest submissions, whose results must be as they are
without it, byte for byte. Afterwards it looks whether all `target.writes` are what they were, whether a file
`target.outside + ".code"` or `".pickled"` has come up, and whether there are `survivors()`.

The test plants a `canary(place)` where nobody may look: in the assignment's secret and in its source, in another
student's notebook, in a file of results, in the environment of the grader, in a list that the grader holds in memory,
in a file that it holds open. Attacks hunt for them, and for other ways out, and answer what they have found;
`complaints(...)`, or `leaks(...)` on any other text that was written, finds that.

Wrong answers that are written so that the judging might be blind to them are in `hostile.masked`; no machine is harmed.

The attack "traces of the submission before" wants two students who both submit it. The files in `target.reads` should
have names of their own, because some attacks look for them by name.
"""

from hostile import files, made
from hostile.attack import CANARY, ESCAPED, Attack, Expects, Target, canary, leaks, notebook, survivors, told

__all__ = [
    "ATTACKS", "CANARY", "ESCAPED", "Attack", "Expects", "Target", "canary", "leaks", "notebook", "survivors",
]  # fmt: skip

#: The files of attacks on time, memory and processes, on what is not theirs, and on the tools of whoever judges.
TOLD = (
    "resources", "endings", "processes", "reading", "borders", "redefinitions", "forgery", "lies", "interactive",
)  # fmt: skip
ATTACKS = (*(attack for name in TOLD for attack in told(name)), *made.ATTACKS, *files.ATTACKS)
