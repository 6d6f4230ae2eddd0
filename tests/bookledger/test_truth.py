"""A second opinion on the ledger: a true status is accepted, a false one and a check that is missing are found out."""

import copy
import tomllib
from decimal import InvalidOperation

import pytest
import sympy

from bookledger import EXAMPLE, Source, truth
from bookledger.books import Books, entries
from bookledger.evidence import (
    again,
    decreasing,
    equal,
    every,
    greater,
    less,
    much_greater,
    negligible,
    refused,
    some,
)
from bookledger.evidence.probing import same_formula, same_number

K, T = sympy.symbols("K T", positive=True)


# What stands in the ledger, and what notebooks store.

CHECK = Source.open(EXAMPLE)["Example 2.1"].compare(Q=576, R=0.417, thicker=less(1, 2)).data | {"source": "walls"}


def complaints(checks=(CHECK,), notebook="02_conduction", **changes):
    """What is said of an entry of the example of a source, with changes in its first result."""
    written = entries(EXAMPLE.read_text(encoding="utf-8"))
    written["Example 2.1"]["result"][0].update(changes)
    return truth.complaints("walls", "Example 2.1", Books({"walls": written}, {notebook: [*checks]}), 3)


def test_an_entry_with_results_is_checked_once_or_more():
    assert complaints() == complaints([CHECK, CHECK]) == []
    assert complaints([]) == ["no notebook checks it: expected a check in 02_conduction"]
    assert complaints(notebook="03_radiation") == ["there is no notebook 02_conduction"]


def test_each_of_several_checks_must_bear_the_entry_out():
    first, *others = CHECK["verdicts"]
    wrong = CHECK | {"verdicts": [first | {"computed": "500"}, *others]}
    assert complaints([wrong, CHECK]) == complaints([CHECK, wrong]) == ["Q: 500 is not 576"]


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


# Truth.


def untrue(book, computed):
    """The statuses of a source that are not true; `computed` holds texts and evidence by entry and result."""
    assumed = Books({"book": book}).assumptions("book")
    return [
        f"{name}, {sentence}"
        for name, entry in book.items()
        for sentence in truth.untrue(entry, {row: computed[of, row] for of, row in computed if of == name}, assumed, 3)
    ]


SYNTHETIC = tomllib.loads("""
[digits]
result = [
    { name = "share", printed = "0.63" },
    { name = "large", printed = "2e3" },
    { name = "limit", printed = "oo" },
    { name = "wrong", printed = "1.50", status = "corrected", correct = "1.60", because = "a slip" },
    { name = "open", printed = "1.50", status = "unreproduced", computed = "1.60", because = "unknown" },
    { name = "measured", printed = "17.3", status = "measured", because = "in the laboratory" },
]
[curves]
result = [
    { name = "first", printed = "10", status = "reconstructed", assuming = "F = 1", within = "5 %" },
    { name = "second", printed = "-2", status = "reconstructed", assuming = "F = 1", within = "0.1" },
    { name = "third", kind = "name", printed = "settles", status = "reconstructed", assuming = "F = 1" },
]
[formulas]
result = [
    { name = "H", kind = "formula", printed = "K/(T*s + 1)" },
    { name = "y", kind = "formula", printed = "s*Y(s) - y(0) = 2*U(s)" },
    { name = "h", kind = "formula", printed = "Integral(q(theta)/A, (theta, 0, t)) + f(oo)" },
    { name = "d", kind = "formula", printed = "Subs(Derivative(f(t), t), t, 0)" },
    { name = "wrong", kind = "formula", printed = "-K", status = "corrected", correct = "K", because = "a sign" },
    { name = "bracket", kind = "formula", printed = "K", status = "damaged", correct = "K**2", because = "a bracket" },
]
[names]
result = [
    { name = "valve", kind = "name", printed = "V1", status = "quoted", library = "math.pi" },
    { name = "action", kind = "name", printed = "direct", status = "corrected", correct = "reverse", because = "a" },
]
[claims]
result = [
    { name = "grows", claim = "It grows." },
    { name = "falls", claim = "It falls.", says = "false" },
    { name = "always", claim = "It grows in every case.", status = "corrected", correct = "At times.", because = "a" },
    { name = "can", claim = "It can be large.", status = "observed", on = "a wall" },
    { name = "much", claim = "It is much larger.", status = "observed", on = "a wall" },
    { name = "same", claim = "They are the same.", status = "quoted", library = "math.pi" },
    { name = "none", claim = "There is none.", status = "reconstructed", assuming = "F = 1" },
    { name = "unknown", claim = "It is small.", status = "unreproduced", computed = "It is large.", because = "a" },
]
""")
TRUE = {
    ("digits", "share"): "0.632121",
    ("digits", "large"): "1500",
    ("digits", "limit"): "oo",
    ("digits", "wrong"): "1.6049",
    ("digits", "open"): "1.595",
    ("curves", "first"): "10.5",
    ("curves", "second"): "-1.9",
    ("curves", "third"): "Settles",
    ("formulas", "H"): "K/T/(s + 1/T)",
    ("formulas", "y"): "-y(0) + s*Y(s) - 2*U(s) = 0",
    ("formulas", "h"): "f(oo) + Integral(q(x), (x, 0, t))/A",
    ("formulas", "d"): "Subs(Derivative(f(x), x), x, 0)",
    ("formulas", "wrong"): "K*(sin(T)**2 + cos(T)**2)",
    ("formulas", "bracket"): "K*K",
    ("names", "valve"): "v1",
    ("names", "action"): "Reverse",
    ("claims", "grows"): greater(2, 1, "peak [m]").data,
    ("claims", "falls"): decreasing([1, 2, 3]).data,
    ("claims", "always"): every({"K = 1": greater(2, 1), "K = 2": greater(1, 2)}).data,
    ("claims", "can"): some(equal("V1", "V2"), greater(2, 1)).data,
    ("claims", "much"): much_greater(3, 1).data,
    ("claims", "same"): equal(K * (T + 1), K * T + K).data,
    ("claims", "none"): refused(float, "a").data,
    ("claims", "unknown"): negligible(1, 2).data,
}


def test_true_statuses_are_accepted():
    assert untrue(SYNTHETIC, TRUE) == []


@pytest.mark.parametrize(
    ("entry", "name", "value", "words"),
    [
        ("digits", "share", "0.6351", "0.6351 is not 0.63"),
        ("digits", "share", "oo", "oo is not 0.63"),
        ("digits", "limit", "1e99", "is not oo"),
        ("digits", "wrong", "1.50", "the book is right"),
        ("digits", "wrong", "1.606", "1.606 is not 1.60"),
        ("digits", "open", "1.505", "the book is right"),
        ("curves", "first", "10.51", "not within 5 %"),
        ("curves", "second", "-2.11", "not within 0.1"),
        ("curves", "third", "swings", "swings is not settles"),
        ("formulas", "H", "K/(T*s - 1)", "is not K/(T*s + 1)"),
        ("formulas", "H", "K/(T*s + 1) + 1/10**30", "is not K/(T*s + 1)"),
        ("formulas", "y", "s*Y(s) + y(0) = 2*U(s)", "is not s*Y(s)"),
        ("formulas", "h", "Integral(q(x), (x, 0, t)) + f(oo)", "is not Integral"),
        ("formulas", "wrong", "-K", "the book is right"),
        ("formulas", "wrong", "2*K", "2*K is not K"),
        ("formulas", "bracket", "K", "the book is right"),
        ("names", "valve", "V2", "V2 is not V1"),
        ("names", "action", "Direct", "the book is right"),
        ("names", "action", "neither", "neither is not reverse"),
        ("names", "action", None, "nothing is computed"),
        ("claims", "grows", greater(1, 2).data, "is not It grows."),
        ("claims", "grows", greater(1, 2).data | {"holds": True}, "told wrongly"),
        ("claims", "grows", much_greater(2, 1).data, "a criterion of ours, much"),
        ("claims", "grows", every(greater(2, 1), much_greater(2, 1)).data, "a criterion of ours, much"),
        ("claims", "grows", {"kind": "every", "cases": [], "holds": True}, "told wrongly"),
        ("claims", "grows", "yes", "no evidence"),
        ("claims", "falls", greater(T, K * T + T).data | {"right": "K"}, "judged again: T - K has either sign"),
        ("claims", "falls", decreasing([3, 2, 1]).data, "is not It falls."),
        ("claims", "always", every({"K = 1": greater(2, 1)}).data, "the book is right"),
        ("claims", "can", some(equal("V1", "V2"), greater(1, 2)).data, "is not It can be large."),
        ("claims", "unknown", negligible(1, 100).data, "the book is right"),
    ],
)
def test_a_value_that_belies_its_status_is_found_out(entry, name, value, words):
    found = untrue(SYNTHETIC, TRUE | {(entry, name): value})
    assert any(words in sentence for sentence in found), found
    assert all(sentence.startswith(f"{entry}, {name}: ") for sentence in found)


@pytest.mark.parametrize(
    ("entry", "name", "lie", "words"),
    [
        ("digits", "share", {"status": "corrected", "correct": "0.632", "because": "a"}, "the book is right"),
        ("digits", "wrong", {"status": "computed"}, "1.6049 is not 1.50"),
        ("digits", "wrong", {"correct": "1.7"}, "1.6049 is not 1.7"),
        ("curves", "first", {"within": "4 %"}, "not within 4 %"),
        ("curves", "first", {"assuming": "F = 2"}, "an assumption for this number alone"),
        ("claims", "grows", {"status": "corrected", "correct": "It falls.", "because": "a"}, "the book is right"),
        ("claims", "grows", {"says": "false"}, "is not It grows."),
        ("claims", "much", {"status": "computed"}, "a criterion of ours, much"),
        ("claims", "none", {"assuming": "F = 2"}, "an assumption for this number alone"),
        ("digits", "measured", {"status": "computed"}, "nothing is computed"),
    ],
)
def test_a_false_status_is_found_out(entry, name, lie, words):
    book = copy.deepcopy(SYNTHETIC)
    next(row for row in book[entry]["result"] if row["name"] == name).update(lie)
    assert any(f"{entry}, {name}: " in sentence and words in sentence for sentence in untrue(book, TRUE))


def test_what_cannot_be_read_is_no_agreement():
    with pytest.raises(ValueError, match="cannot read"):
        same_formula("K if T else s", "K", 3)
    with pytest.raises(InvalidOperation):
        same_number("about 3", "3")


def test_a_subject_adds_kinds_of_evidence(monkeypatch):
    warm = {"kind": "warmth", "degrees": 30, "holds": True, "near": False}
    with pytest.raises(ValueError, match="cannot judge"):
        again.speaks_for(warm, 3)
    monkeypatch.setitem(again.FURTHER, "warmth", lambda data: data["degrees"] > 20)
    assert untrue(SYNTHETIC, TRUE | {("claims", "grows"): warm}) == []
    assert untrue(SYNTHETIC, TRUE | {("claims", "grows"): warm | {"degrees": 10}}) != []
