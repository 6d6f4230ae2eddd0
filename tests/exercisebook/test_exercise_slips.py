"""What is said instead of a traceback where Python stumbles over an answer, and that nothing else is touched."""

import pytest
from IPython.core.interactiveshell import InteractiveShell
from IPython.utils.capture import capture_output

from exercisebook import slips

BEFORE = """
import sympy
from plainmath.expressions import s, t
from shelf import exercise
K, T = sympy.symbols("K T")
gain_of_mine = 3
"""
#: {a cell: words of the sentence}.
SAID = {
    "F=1/q": "nothing is called q here: run the cell that computes it",
    "F=gain_of_min": "did you mean 'gain_of_mine'",
    "F=exp(-s)": "exp is not known yet: run the cells above, imports first",
    "F=s^2": "a power is **",
    "F=K(s + 1)": "before a bracket a product needs its *",
    "F=2s": "a product needs its *",
    "T=20 s": "belongs in quotes",
    "T=25%": "belongs in quotes",
    "T=20 °C": "belongs in quotes",
    "K=0,5": "a decimal comma separates two values",
    "K=0,05, T=3": "a decimal comma separates two values",
    "K=(0,5)*s": "a decimal comma separates two values",
    "F='3": "Python cannot read this (unterminated string",
    "F=(3, T=3": "Python cannot read this",
}
UNTOUCHED = ["1/q", "2s", "K(s + 1)", "s^2", "exercise('1.1').check(F=1/0)", "exercise('1.1').chek(F=1)"]


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
    shown, succeeded = ran(shell, f"exercise('1.1').check({answers})")
    assert SAID[answers] in shown
    assert "Error" not in shown
    assert not succeeded


@pytest.mark.parametrize("cell", UNTOUCHED)
def test_other_cells_and_other_errors_are_untouched(shell, cell):
    shown, succeeded = ran(shell, cell)
    assert "Error" in shown
    assert "Not judged" not in shown
    assert not succeeded


def test_what_is_not_in_the_cell_of_the_answer_is_shown_where_it_is(shell):
    ran(shell, "def model(s):\n    return s^2")
    shown, _ = ran(shell, "exercise('1.1').check(F=model(s))")
    assert "Traceback" in shown
    assert "model" in shown


def test_without_a_shell_nothing_happens():
    InteractiveShell.clear_instance()
    slips.install()
    assert not InteractiveShell.initialized()


def test_the_box_escapes_what_it_quotes():
    slip = slips.Slip("nothing is called <b> here")
    assert "&lt;b&gt;" in slip._repr_html_()
    assert repr(slip) == "? Not judged: nothing is called <b> here"
