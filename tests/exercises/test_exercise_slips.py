"""What is said instead of a traceback where Python stumbles over an answer, and that nothing else is touched."""

import pytest
from IPython.core.interactiveshell import InteractiveShell
from IPython.utils.capture import capture_output

from exercisebook import slips

BEFORE = """
import math
import numpy as np
import sympy
from loopbook import s, t
from loopbook.exercises import exercise
K, T = sympy.symbols("K T")
gain_of_mine = 3
"""
#: {a cell: words of the sentence}.
SAID = {
    "F=1/q": "nothing is called q here: run the cell that computes it",
    "F=gain_of_min": "did you mean 'gain_of_mine'",
    "F=exp(-s)": "exp is not known yet: run the cell with the imports at the top first",
    "F=2*j": "write 1j",
    "F=e**s": "write exp(...)",
    "pid=PI(2, 10)": 'the text "PI(2, 10)"',
    "F=s^2": "a power is **",
    "F=K(s + 1)": "before a bracket a product needs its *",
    "F=2(s + 1)": "before a bracket a product needs its *",
    "F=2s": "a product needs its *, as 2*s",
    "F=2 s": "belongs in quotes",
    "T=20 s": "belongs in quotes",
    "T=25%": "belongs in quotes",
    "K=0,5": "a decimal comma separates two values",
    "K=0,05, T=3": "a decimal comma separates two values",
    "K=1,5, T=3": "a decimal comma separates two values",
    "K=(0,5)*s": "a decimal comma separates two values",
    "K=1, 5 + s": "a decimal comma separates two values",
    "K=1, s": "give each answer by its name",
    "F=np.exp(s)": "that function is for numbers",
    "F=math.exp(s)": "that function is for numbers",
    "F='2' + s": "a text in quotes is not computed with",
    "y(t)=3": "stands a name alone",
    "F='3": "a quote is not closed",
    "F=(3, T=3": "a name alone, behind a comma",
    "F=3 − s": "− is no sign of Python's",
    "F=\\frac{1}{s}": "LaTeX belongs in quotes",
    "F=3 +* s": "look at its brackets, quotes and commas",
    "lambda=2": "lambda is a word of Python",
}
UNTOUCHED = [
    "1/q",
    "2s",
    "K(s + 1)",
    "s^2",
    "1/0",
    "exercise('4.1').check(F=1/0)",
    "import no_such_module",
    "raise TypeError",
]


@pytest.fixture(scope="module")
def shell():
    """A shell in which the exercises are imported."""
    shell = InteractiveShell()
    InteractiveShell._instance = shell
    shell.run_cell(BEFORE)
    slips.install()
    yield shell
    InteractiveShell.clear_instance()


def ran(shell, cell):
    """What a cell shows, and whether it succeeded."""
    with capture_output() as shown:
        result = shell.run_cell(cell)
    displayed = [output.data["text/plain"] for output in shown.outputs]
    return "".join([shown.stdout, shown.stderr, *displayed]), result.success


@pytest.mark.parametrize("answers", SAID)
def test_a_slip_in_an_answer_is_one_sentence(shell, answers):
    shown, succeeded = ran(shell, f"exercise('4.1').check({answers})")
    assert SAID[answers] in shown
    assert "Traceback" not in shown
    assert "Error" not in shown
    assert not succeeded


@pytest.mark.parametrize("cell", UNTOUCHED)
def test_other_cells_and_other_errors_are_untouched(shell, cell):
    shown, succeeded = ran(shell, cell)
    assert "Error" in shown
    assert "Not judged" not in shown
    assert not succeeded


def test_an_answer_that_python_reads_is_judged_as_ever(shell):
    shown, succeeded = ran(shell, "print(exercise('4.1').check(F='20/s + 0,5/s^2'))")
    assert succeeded
    assert "read as 20/s + 0.5/s**2" in shown


def test_what_is_not_in_the_cell_of_the_answer_is_shown_where_it_is(shell):
    ran(shell, "def model(s):\n    return s^2")
    shown, _ = ran(shell, "exercise('4.1').check(F=model(s))")
    assert "Traceback" in shown
    assert "model" in shown


def test_a_handler_that_is_there_keeps_its_errors():
    shell = InteractiveShell()
    seen = []
    shell.set_custom_exc((ZeroDivisionError, NameError), lambda *found, tb_offset=None: seen.append(found[1]) or [])
    InteractiveShell._instance = shell
    try:
        shell.run_cell(BEFORE)
        slips.install()
        slips.install()
        assert ran(shell, "1/0") == ("", False)
        assert ran(shell, "1/q") == ("", False)
        assert seen == [ZeroDivisionError, NameError]
        assert "Not judged" in ran(shell, "exercise('4.1').check(F=1/q)")[0]
        assert seen == [ZeroDivisionError, NameError]
    finally:
        InteractiveShell.clear_instance()


def test_without_a_shell_nothing_happens():
    InteractiveShell.clear_instance()
    slips.install()
    assert not InteractiveShell.initialized()


def test_the_box_is_that_of_a_response_and_escapes_what_it_quotes():
    slip = slips.Slip("nothing is called <b> here")
    assert "&lt;b&gt;" in slip._repr_html_()
    assert "border-left: 4px solid" in slip._repr_html_()
    assert repr(slip) == "? Not judged: nothing is called <b> here"


@pytest.mark.parametrize("row", slips.SLIPS, ids=range(len(slips.SLIPS)))
def test_each_sentence_can_be_filled_in(row):
    kind, _, _, says = row
    assert says.format("K", near="did you mean 'K'?")
    assert issubclass(kind, Exception)
