"""The hostile corpus itself: complete, and what it says is Python is Python. Nothing of it is run here."""

import ast
from collections import Counter

import pytest
from IPython.core.inputtransformer2 import TransformerManager

import hostile
from exercisegrader.results import JudgedAnswer, JudgedExercise, Result
from hostile import ATTACKS, Attack, Target

TARGET = Target(
    answers={"1": 'sheet.answer("1", K=1)', "2": 'sheet.answer("2", H=1)'},
    leak=("4", "becomes"),
    names=("H",),
    reads=("/somewhere/secret's.py",),
)
#: All that is to be withstood.
ITEMS = {
    "endless loop", "memory bomb", "fork bomb", "thread bomb", "disk filling", "giant output", "os._exit", "sys.exit",
    "segmentation fault", "killing the parent or everything", "background process", "network", "reading", "writing",
    "leaving the jail", "redefining", "transformers", "forging the stream", "lying classes", "sympy forever",
    "answers with code", "malformed JSON", "not a notebook", "nbformat 3", "100 MB notebook", "zip bomb",
    "zip path traversal", "symbolic links", "missing file", "wrong kernel", "magics and shells", "widgets", "input",
    "loops of events", "figures",
}  # fmt: skip


def test_the_corpus_has_every_item_and_no_name_twice():
    assert {attack.item for attack in ATTACKS} == ITEMS
    assert [name for name, count in Counter(attack.name for attack in ATTACKS).items() if count > 1] == []


def test_cells_are_python_or_meant_not_to_be():
    manager, odd = TransformerManager(), set()
    for attack in ATTACKS:
        for cell in attack.sources(TARGET) if attack.cells or attack.before else ():
            try:
                compile(manager.transform_cell(cell), "cell", "exec", ast.PyCF_ALLOW_TOP_LEVEL_AWAIT)
            except (SyntaxError, ValueError):
                odd.add(attack.name)
    assert odd == {"magics and shells: a language that is none"}


def test_what_would_harm_this_machine_looks_for_a_jail_first():
    harms = ("os.kill(-1", "os.kill(os.getppid", "os.killpg", '"megabytes"', '"processes"', "'x' * 10**6)", "mount(")
    for attack in ATTACKS:
        for cell in (*attack.before, *attack.cells):
            if any(harm in cell for harm in harms):
                assert attack.needs_a_jail, attack.name


def test_a_result_is_judged_by_what_counts_and_by_what_could_get_out():
    def exercise(number, right):
        answers = (JudgedAnswer("x", "right" if right else "wrong", "", 1, "1"),)
        return JudgedExercise(number, "", 2, "", (), answers)

    def result(status="complete", says="", right=(True, True, False)):
        exercises = tuple(map(exercise, "123", right))
        return Result("target", "s1", "a.ipynb", True, "", status, says, (), (), exercises)

    attack = Attack("an attack", "an item")
    assert attack.complaints(result(), TARGET) == []
    assert "the status is 'not run'" in attack.complaints(result(status="not run"), TARGET)[0]
    assert "could get out: canary-key-" in attack.complaints(result(says=hostile.canary("key")), TARGET)[0]
    assert "could get out: ESCAPED: x" in attack.complaints(result(says="ESCAPED: x"), TARGET)[0]
    first, second = attack.complaints(result(right=(False, True, True)), TARGET)
    assert first.endswith("its answers are lost")
    assert second.endswith("that nobody has earned")


@pytest.mark.parametrize("attack", [one for one in ATTACKS if one.place], ids=lambda one: one.name)
def test_traps_can_be_laid(attack, tmp_path):
    attack.submit(TARGET, tmp_path, "s1001", "air_heater.ipynb")
    assert any(tmp_path.iterdir())
