"""A ledger is believed where each entry is checked in its chapter, and each assumption confirms more than it took."""

import pytest

from bookledger import EXAMPLE, Source, truth
from bookledger.books import Books, entries
from bookledger.evidence import less

CHECK = Source.open(EXAMPLE)["Example 2.1"].compare(Q=576, R=0.417, thicker=less(1, 2, "heat flow [W]")).data
CHECK |= {"source": "walls"}


def complaints(checks=(CHECK,), notebook="02_conduction", **changes):
    """What is said of an entry of the example of a source, with changes in its first result."""
    written = entries(EXAMPLE.read_text(encoding="utf-8"))
    written["Example 2.1"]["result"][0].update(changes)
    return truth.complaints("walls", "Example 2.1", Books({"walls": written}, {notebook: [*checks]}))


def test_an_entry_with_results_is_checked_once_or_more():
    assert complaints() == complaints([CHECK, CHECK]) == []
    assert complaints([]) == ["no notebook checks it: expected a check in 02_conduction"]
    assert complaints(notebook="03_radiation") == ["there is no notebook 02_conduction"]


def test_what_is_no_symbol_has_a_label():
    assert "heat_flow: is no symbol: expected a label" in complaints(name="heat_flow")
    assert not any("label" in said for said in complaints(name="heat_flow", label="heat flow"))


QUOTED = {
    "math.tau": [],
    "sympy.gamma": [],
    "math.tauu": ["Q: quoted by math.tauu, which cannot be imported"],
    "nothing.pi": ["Q: quoted by nothing.pi, which cannot be imported"],
    "pi": ["Q: quoted by pi, which cannot be imported"],
    "math.__loader__": ["Q: quoted by math.__loader__, which is not public or says nothing of itself"],
}


@pytest.mark.parametrize("library", QUOTED)
def test_what_is_quoted_can_be_imported(library):
    assert complaints(status="quoted", library=library) == QUOTED[library]


ASSUMED = """
[source]
title = "Warm Walls"
citation = "A. N. Author, Warm Walls"
[assumption.still_air]
text = "still air"
parameters = PARAMETERS
[measure]
warmer = "temperature"
["Example 1"]
title = "A wall"
chapter = "walls"
result = [
    { name = "Q", printed = "5.1", status = "FIRST", assuming = "still_air" },
    { name = "R", printed = "0.2" },
]
["Example 2"]
title = "A window"
chapter = "walls"
result = [{ name = "Q", printed = "5.1", status = "reconstructed", assuming = "still_air" }]
"""


@pytest.mark.parametrize(
    ("parameters", "status", "found"),
    [
        (1, "reconstructed", []),
        (1, "fitted", []),
        (2, "fitted", ["Example 2, Q is reconstructed: expected fitted, with 2 free parameters for 2 results"]),
    ],
)
def test_what_takes_as_many_parameters_as_there_are_results_is_fitted(parameters, status, found):
    text = ASSUMED.replace("PARAMETERS", str(parameters)).replace("FIRST", status)
    assert truth.of_assumption(Source.read("walls", text.encode()), "still_air") == found
    assert list(entries(text)) == ["Example 1", "Example 2"]


def test_an_assumption_serves_a_result():
    text = ASSUMED.partition('["Example 1"]')[0].replace("PARAMETERS", "0")
    assert truth.of_assumption(Source.read("walls", text.encode()), "still_air") == ["no result rests on it"]
