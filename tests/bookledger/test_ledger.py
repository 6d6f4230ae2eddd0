"""The checker accepts what agrees with the print and nothing else, and says in one line what is wrong."""

import decimal
import enum
import json
import math
import re
import sys
from decimal import Decimal
from fractions import Fraction

import nbclient
import nbformat
import numpy as np
import pytest
import sympy
from hypothesis import HealthCheck, assume, given, settings
from hypothesis import strategies as st

from bookledger import EXAMPLE, Disagreement, LedgerError, Source
from bookledger.evidence import Evidence, every, greater, increasing, less, much_greater, negligible, positive, some
from bookledger.kinds import Number
from bookledger.report import MIME_TYPE
from bookledger.statuses import STATUSES
from draws import draws
from plainmath.expressions import s, t

x, K, T = sympy.symbols("x K T", positive=True)


def toml(value):
    """A value as TOML writes it."""
    if isinstance(value, dict):
        return "{" + ", ".join(f"{json.dumps(key)} = {toml(part)}" for key, part in value.items()) + "}"
    if isinstance(value, list):
        return "[" + ", ".join(map(toml, value)) + "]"
    return json.dumps(value, ensure_ascii=False)


def book(**entry):
    """A source with one entry, "Example 1", of which some keys are told."""
    entry = {"title": "An example", "chapter": "02_walls"} | entry
    lines = [f"{key} = {toml(value)}" for key, value in entry.items()]
    return read("\n".join(['[source]\ntitle = "Author"\ncitation = "A. Author"\n["Example 1"]', *lines]).encode())


def read(content):
    """A source, all of whose entries have been read."""
    source = Source.read("book", content)
    list(source)
    return source


def example(printed, **result):
    """The entry of a book that prints one result `y`."""
    return book(result=[{"name": "y", "printed": printed} | result])["Example 1"]


def guess(printed, within, **result):
    """The entry of a book that prints one result `y`, which rests on an assumption."""
    table = f'[assumption.a]\ntext = "a guess"\nparameters = 1\nwithin = "{within}"\n'
    row = toml({"name": "y", "printed": printed, "status": "reconstructed", "assuming": "a"} | result)
    entry = f'["Example 1"]\ntitle = "An example"\nchapter = "02_walls"\nresult = [{row}]\n'
    return read((f'[source]\ntitle = "A"\ncitation = "A"\n{table}{entry}').encode())["Example 1"]


def holds(value, printed, **result):
    return example(printed, **result).compare(y=value).verdicts[0].holds


def agrees(value, printed):
    number = Number.read(printed)
    return bool(number.agrees(number.computed(value)))


def formula_holds(value, printed, **result):
    return holds(value, printed, kind="formula", **result)


# Numbers.

STYLES = ["1.50", "2e-3", "0.63", "-6.45", "1500", "+3", ".5", "1E+2", "0", "-0.0"]
OTHER_STYLES = st.builds(
    "{}{}{}{}".format,
    st.sampled_from(["", "+", "-"]),
    st.integers(0, 10**6),
    st.from_regex(r"(\.[0-9]{1,5})?", fullmatch=True),
    st.from_regex(r"([eE][+-]?[12]?[0-9])?", fullmatch=True),
)
PRINTED = st.sampled_from(STYLES) | OTHER_STYLES
DISTANCE = st.fractions(-3, 3, max_denominator=10**6) | st.sampled_from([Fraction(1), Fraction(-1)])


def reading(printed):
    """A printed number and half a unit of its last digit, by counting digits; of an integer what rounding does."""
    sign, whole, decimals, exponent = re.fullmatch(r"([+-]?)(\d*)\.?(\d*)(?:[eE]([+-]?\d+))?", printed).groups()
    unit = Fraction(10) ** (int(exponent or 0) - len(decimals))
    value = int(sign + "1") * int(whole + decimals) * unit
    is_exact = re.fullmatch(r"[+-]?\d+", printed)
    return value, max(1, abs(value)) / Fraction(10) ** 9 if is_exact else unit / 2


def inside(value, printed):
    middle, half = reading(printed)
    return abs(value - middle) <= half


def as_decimal(value):
    with decimal.localcontext(prec=40):
        return Decimal(value.numerator) / Decimal(value.denominator)


# How a fraction becomes a value of each type, and that value a fraction again.
TYPES = {
    "Fraction": (Fraction, Fraction),
    "int": (round, Fraction),
    "Decimal": (as_decimal, Fraction),
    "float64": (lambda v: np.float64(float(v)), lambda v: Fraction(float(v))),
    "float32": (lambda v: np.float32(float(v)), lambda v: Fraction(float(v))),
    "longdouble": (lambda v: np.longdouble(str(as_decimal(v))), lambda v: Fraction(*v.as_integer_ratio())),
    "int64": (lambda v: np.int64(round(v)), lambda v: Fraction(int(v))),
    "int32": (lambda v: np.int32(round(v)), lambda v: Fraction(int(v))),
    "Rational": (lambda v: sympy.Rational(v.numerator, v.denominator), lambda v: Fraction(int(v.p), int(v.q))),
    "Float": (lambda v: sympy.Float(float(v)), lambda v: Fraction(float(v))),
}


@pytest.mark.parametrize("name", TYPES)
@settings(max_examples=draws(200), deadline=None, derandomize=True)
@given(printed=PRINTED, distance=DISTANCE)
def test_a_number_passes_inside_half_a_unit_of_the_last_digit_and_never_outside(name, printed, distance):
    middle, half = reading(printed)
    make, read = TYPES[name]
    try:
        value = make(middle + distance * half)
    except OverflowError:
        assume(False)
    assert agrees(value, printed) == inside(read(value), printed)
    assert holds(value, printed) == inside(read(value), printed)


@settings(max_examples=draws(200), deadline=None, derandomize=True)
@given(printed=PRINTED, k=st.fractions(-2, 2, max_denominator=1000).filter(bool))
def test_an_irrational_number_passes_inside_and_never_outside(printed, k):
    middle, half = (sympy.Rational(part.numerator, part.denominator) for part in reading(printed))
    q = sympy.Rational(k.numerator, k.denominator)
    pi = Fraction("3.14159265358979323846264338327950288")
    assert agrees(middle + half * q * sympy.sqrt(2), printed) == (2 * k**2 <= 1)
    assert agrees(middle + half * sympy.exp(q), printed) == (k < 0)
    assert agrees(middle + half * q * sympy.pi, printed) == (abs(k) * pi < 1)


@pytest.mark.parametrize("edge", [-1, 1])
@pytest.mark.parametrize("printed", STYLES)
def test_at_the_edge_a_hair_decides(printed, edge):
    middle, half = reading(printed)
    hair = Fraction(1, 10**30)
    for make in (Fraction, lambda v: sympy.Rational(v.numerator, v.denominator)):
        assert holds(make(middle + edge * half), printed)
        assert holds(make(middle + edge * (half - hair)), printed)
        assert not holds(make(middle + edge * (half + hair)), printed)
        assert not holds(make(middle + edge * (half + hair)) + sympy.sqrt(2) / 10**32 * edge, printed)


@settings(max_examples=draws(300), deadline=None, derandomize=True, suppress_health_check=[HealthCheck.filter_too_much])
@given(printed=PRINTED, stored=PRINTED, near_stored=st.booleans(), distance=DISTANCE, percent=st.integers(1, 99))
def test_every_status_asks_exactly_for_what_it_means(printed, stored, near_stored, distance, percent):
    middle, half = reading(stored if near_stored else printed)
    value = middle + distance * half
    try:
        corrected = example(printed, status="corrected", correct=stored, because="slip of the pen")
        unreproduced = example(printed, status="unreproduced", computed=stored, because="unknown", tried="all")
    except LedgerError:  # fewer digits than printed
        assume(False)
    for entry in (corrected, unreproduced):
        assert entry.compare(y=value).verdicts[0].holds == (inside(value, stored) and not inside(value, printed))

    book_value, _ = reading(printed)
    margins = [(stored.lstrip("+"), reading(stored)[0])] if reading(stored)[0] > 0 else []
    if book_value:
        margins.append((f"{percent} %", abs(book_value) * percent / 100))
    for within, margin in margins:
        value = book_value + distance * margin
        assert guess(printed, within).compare(y=value).verdicts[0].holds == (abs(distance) <= 1)


@pytest.mark.parametrize("value", [math.inf, np.inf, Decimal("inf"), sympy.oo, sympy.Float("inf")])
def test_infinity_is_met_by_infinity_alone(value):
    assert holds(value, "oo")
    assert holds(-value, "-oo")
    assert not any([holds(value, "-oo"), holds(value, "1e99"), holds(10**400, "oo"), holds(Fraction(1), "oo")])
    assert not guess("5", "3").compare(y=value).verdicts[0].holds


def test_numbers_in_unusual_clothes():
    X = sympy.Symbol("X")
    poles = sympy.roots(X**3 - 3 * X + 1, X, multiple=True)  # real, but SymPy can only write them with I
    printed = {"-1.8794", "0.3473", "1.5321"}
    assert {text for text in printed for pole in poles if holds(pole, text)} == printed
    assert holds(sympy.Integral(sympy.exp(-x), (x, 0, sympy.oo)), "1.000")
    assert holds(sympy.sqrt(5 + 2 * sympy.sqrt(6)) - sympy.sqrt(2) - sympy.sqrt(3), "0")
    assert holds(sympy.sqrt(10**300 + 1) - 10**150, "5e-151")
    assert holds(sympy.sqrt(10**300 + 2) - 10**150, "1.0e-150")
    assert not holds(sympy.sqrt(10**300 + 1) - 10**150, "0e-155")
    assert holds(sympy.exp(-(10**12)), "0.00")
    # Numbers that differ from the edge only beyond a double's digits
    assert not holds(Decimal("0.63500000000000000000001"), "0.63")
    assert not holds(sympy.Float("0.63500000000000000000001", 30), "0.63")


@pytest.mark.parametrize(
    ("value", "printed", "shown"),
    [
        (1 - math.exp(-1), "0.63", "0.632121"),
        (Fraction(2, 3), "0.7", "0.66667"),
        (-0.00001, "-0.0", "-0.00001"),
        (-1e-9, "0", "0"),
        (63, "63", "63"),
        (1234.5678, "1e3", "1234.6"),
        (1234567, "2e7", "1235000"),
        (1e308, "0.63", "1e+308"),
        (10**4000, "0.63", "1e+4000"),
        (-(10**400), "oo", "-1e+400"),
        (1.5, "oo", "1.5"),
    ],
)
def test_a_computed_number_is_shown_with_a_few_more_digits(value, printed, shown):
    assert example(printed).compare(y=value).verdicts[0].computed == shown


# Formulas.


@pytest.mark.parametrize(
    ("value", "printed"),
    [
        ((K / T) / (s + 1 / T), "K/(T*s + 1)"),
        (sympy.Symbol("K") / (sympy.Symbol("T", real=True) * sympy.Symbol("s") + 1), "K/(T*s + 1)"),
        (sympy.Dummy("K") * 2, "2*K"),
        (sympy.Rational(1, 2), "0.5"),
        (Fraction(1, 2), "0.5"),
        (np.int64(3), "3"),
        (sympy.sin(x) ** 2, "1 - cos(x)**2"),
        ((-1) ** sympy.Symbol("n", integer=True), "cos(pi*n)"),
        (K * s ** (-x - 1) * sympy.gamma(x + 1), "K*factorial(x)/s**(x + 1)"),
        (sympy.Integral(sympy.Function("u")(x), (x, 0, t)), "Integral(u(theta), (theta, 0, t))"),
        (sympy.Eq(s * K, 2 * T - x), "x + s*K = 2*T"),
        (sympy.Eq(2 * T - x, s * K), "x + s*K = 2*T"),
        (sympy.oo, "oo"),
        (x * sympy.sqrt(5 + 2 * sympy.sqrt(6)), "x*(sqrt(2) + sqrt(3))"),
    ],
)
def test_a_formula_holds_in_every_form(value, printed):
    assert formula_holds(value, printed)


Y = sympy.Function("Y")
WRONG = {
    "another letter": (x / (T * s + 1), "K/(T*s + 1)"),
    "the other sign": (K / (T * s - 1), "K/(T*s + 1)"),
    "a capital letter": (sympy.Symbol("k"), "K"),
    "a letter for a function": (sympy.Symbol("Y"), "Y(s)"),
    "nearly one half": (sympy.Rational(1, 2) + sympy.Rational(1, 10**40), "0.5"),
    "a tiny term": (x + x * sympy.Rational(1, 10**25), "x"),
    "a limiter": (sympy.Min(x, 100), "x"),
    "a dead band": (sympy.Max(x, sympy.Rational(1, 10**5)), "x"),
    "a corner": (sympy.Abs(x - 50), "50 - x"),
    "a piece": (sympy.Piecewise((x, x < 1000), (0, True)), "x"),
    "rounding down": (sympy.floor(x) + x - sympy.floor(x) * (1 + sympy.Rational(1, 10**22)), "x"),
    "a letter that is zero": (K / (sympy.Symbol("T", zero=True) * s + 1), "K"),
    "a letter that is even": (sympy.Symbol("n", even=True), "n*(-1)**n"),
    "a letter that is negative": (sympy.sqrt(sympy.Symbol("x", negative=True) ** 2), "x"),
    "a multiple of pi": (sympy.Integer(0), "sin(pi*n)"),
    "the product with zero": (sympy.Eq(0, 0, evaluate=False), "s*K = 2*T"),
    "the double": (sympy.Eq(2 * s * K, 4 * T, evaluate=False), "s*K = 2*T"),
    "another right side": (sympy.Eq(s * K, 3 * T), "s*K = 2*T"),
    "an expression for an equation": (s * K - 2 * T, "s*K = 2*T"),
    "an equation for an expression": (sympy.Eq(K, T), "K"),
    "one solution for the equation": (2 * T / s, "K = 2*T/s"),
    "infinity": (sympy.oo, "5"),
    "a number for infinity": (sympy.Integer(5), "oo"),
    "the other infinity": (-sympy.oo, "oo"),
}


def test_a_wrong_formula_does_not_hold(subtests):
    for name, (value, printed) in WRONG.items():
        with subtests.test(name):
            assert not formula_holds(value, printed)


def test_a_wrong_formula_is_recorded_as_the_books_error_with_its_correction():
    told = {"printed": "K/(T*s - 1)", "status": "corrected", "correct": "K/(T*s + 1)", "because": "a slip"}
    assert formula_holds(K / (T * s + 1), **told)
    assert not formula_holds(K / (T * s - 1), **told)
    assert not formula_holds(K / T, **told)
    assert not formula_holds(K / (T * s + 1), **told | {"printed": "(K/T)/(s + 1/T)"})  # the book was right


# Names.


class Word(str, enum.Enum):  # noqa: UP042 - as a reader may write it
    STABLE = "stable"


@pytest.mark.parametrize("value", ["stable", "Stable", " stable\n", np.str_("stable"), Word.STABLE])
def test_a_name_is_the_same_whatever_its_case_and_spaces(value):
    verdict = example("Stable", kind="name").compare(y=value).verdicts[0]
    assert (verdict.holds, verdict.computed.casefold()) == (True, "stable")


@pytest.mark.parametrize("value", ["", "unstable", "stable.", "not stable", "s table"])
def test_another_word_is_another_name(value):
    assert not holds(value, "stable", kind="name")
    assert holds("unstable", "stable", kind="name", status="corrected", correct="unstable", because="a slip")


# Claims.

CLAIM = {"name": "y", "about": "peak", "claim": "The peak grows with the gain."}
CONTRARY = {"status": "corrected", "correct": "The peak falls with the gain.", "because": "a slip"}


def claim_holds(evidence, **told):
    return book(result=[CLAIM | told])["Example 1"].compare(y=evidence).verdicts[0].holds


def test_evidence_decides_a_claim():
    for_it, against_it = greater(2, 1, "peak"), greater(1, 2, "peak")
    assert claim_holds(for_it)
    assert not claim_holds(against_it)
    assert claim_holds(against_it, says="false")
    assert not claim_holds(for_it, says="false")


@pytest.mark.parametrize("status", ["corrected", "damaged", "unreproduced"])
def test_evidence_contradicts_a_claim_that_is_wrong(status):
    told = CONTRARY | {"status": status}
    if status == "unreproduced":
        told |= {"computed": told.pop("correct"), "tried": "all"}
    assert claim_holds(greater(1, 2, "peak"), **told)
    assert not claim_holds(greater(2, 1, "peak"), **told)


@pytest.mark.parametrize(
    ("told", "evidence", "words"),
    [
        ({}, greater(2, 1, "mass of the moon"), "evidence about mass of the moon: the claim is about peak"),
        ({}, greater(2, 1), "evidence about nothing that it names: the claim is about peak"),
        ({}, every(greater(2, 1, "peak"), greater(2, 1, "time")), "evidence about peak, time"),
        ({"degree": "much"}, greater(2, 1, "peak"), "without the criterion for much, which the book says"),
        ({}, much_greater(2, 1, "peak"), "by the criterion much: the book has no word for it"),
        ({}, some(greater(2, 1, "peak")), "by the criterion may: the book has no word for it"),
        ({"degree": "hardly; much"}, much_greater(2, 1, "peak"), "without the criterion for hardly"),
        ({"measure": "speed"}, greater(2, 1, "peak"), "the claim is judged by time to 63 %"),
    ],
)
def test_evidence_of_another_claim_is_refused(told, evidence, words):
    row = CLAIM | {"claim": "The peak hardly grows much with the gain."} | told
    lines = [f"{key} = {toml(value)}" for key, value in {"title": "A", "chapter": "1", "result": [row]}.items()]
    source = "\n".join([HEAD, '[measure]\nspeed = "time to 63 %"', '["Example 1"]', *lines])
    assert words in complaint(read(source.encode())["Example 1"].check, y=evidence)


def test_words_of_degree_have_one_criterion_each():
    assert claim_holds(much_greater(2, 1, "peak"), claim="The peak is considerably higher.", degree="considerably")
    assert not claim_holds(much_greater(1.4, 1, "peak"), claim="The peak is much higher.", degree="much")
    assert claim_holds(negligible(0.01, 1, "peak"), claim="The peak hardly grows.", degree="hardly")
    for evidence in (some(less(1, 2, "peak"), less(3, 2, "peak")), less(1, 2, "peak")):  # what always is, may be
        assert claim_holds(evidence, claim="The peak may fall.", degree="may")


def test_no_two_claims_of_an_entry_are_about_the_same():
    said = complaint(book, result=[CLAIM, CLAIM | {"name": "z"}])
    assert said == "book, Example 1: y and z are about the same, expected a quantity of its own for each claim"


def test_numbers_with_units_are_compared_in_the_unit_of_the_print():
    entry = book(given={"d": "0.5 m", "v": "3 m/min"}, result=[{"name": "y", "printed": "10", "unit": "s"}])[
        "Example 1"
    ]
    d, v = entry.quantity("d", "v")
    assert entry.compare(y=d / v).verdicts[0].holds
    assert not entry.compare(y=2 * d / v).verdicts[0].holds
    assert "expected a value in s" in complaint(entry.check, y=d * v)
    assert "expected a number without a unit" in complaint(example("10").check, y=d)
    with pytest.raises(ValueError, match="'°C' is no unit"):
        book(given={"T": "20 °C"})["Example 1"].quantity("T")


@pytest.mark.parametrize(
    ("kind", "printed", "right", "wrong", "no_value"),
    [
        ("vector", "1.0, -2.5", [1.04, -2.46], [1.06, -2.5], [1, 2, 3]),
        ("vector", "[1, 2]", np.array([1, 2]), (1, 2.1), 1),
        ("range", "0.5 to 2", (0.52, 2), (0.5, 2.1), 1),
        ("complex", "-0.50 + 1.2i", -0.501 + 1.22j, 0.5 + 1.2j, "i"),
        ("complex", "2 - j", 2 - sympy.I, 2 + sympy.I, [1, 2]),
    ],
)
def test_several_numbers_agree_each_within_its_digits(kind, printed, right, wrong, no_value):
    assert holds(right, printed, kind=kind)
    assert not holds(wrong, printed, kind=kind)
    assert f"expected a {kind}, got" in complaint(example(printed, kind=kind).check, y=no_value)


def test_an_integer_is_exact_unless_it_says_how_it_is_rounded():
    assert holds(1500, "1500")
    assert not holds(1500.1, "1500")
    assert holds(1504, "1500", rounded_to="10")
    assert not holds(1506, "1500", rounded_to="10")


def test_a_symbol_of_either_sign_is_declared():
    told = {"title": "A", "chapter": "1", "result": [{"name": "y", "kind": "formula", "printed": "K"}]}
    assert book(**told)["Example 1"].compare(y=abs(sympy.Symbol("K"))).verdicts[0].holds
    assert not book(**told, real="K")["Example 1"].compare(y=abs(sympy.Symbol("K"))).verdicts[0].holds


def test_a_near_thing_is_said_to_be_one():
    report = book(result=[CLAIM])["Example 1"].compare(y=increasing([1, 1.01], "peak"))
    assert report.verdicts[0].word == "computed (a near thing)"
    assert "computed (a near thing): The peak grows" in repr(report)
    assert not book(result=[CLAIM])["Example 1"].compare(y=increasing([1, 2], "peak")).verdicts[0].near


def test_a_claim_that_does_not_hold_is_told_with_its_evidence(capsys):
    said = complaint(book(result=[CLAIM])["Example 1"].check, error=Disagreement, y=greater(1, 2, "peak"))
    assert said == (
        "book, Example 1: y the evidence (peak 1 not > 2) does not say that it is true: The peak grows with the gain."
    )
    capsys.readouterr()


@pytest.mark.parametrize("value", [True, "grows", 1.5, None, [greater(2, 1)], Evidence])
def test_what_is_no_evidence_is_refused(value):
    said = complaint(book(result=[CLAIM])["Example 1"].check, y=value)
    assert said.startswith("book, Example 1, y: expected evidence, got ")
    assert "hand over evidence, as greater(2.3, 1.6)" in said


# What is no value at all. Each complaint is one line, with the names of source, entry and result.


class Hostile(float):
    """A number that claims to be every other one."""

    __hash__ = float.__hash__

    def __eq__(self, other):
        return True

    def __ne__(self, other):
        return False


class Failing(float):
    def as_integer_ratio(self):
        raise ZeroDivisionError("on\npurpose")


class Unprintable:
    def __repr__(self):
        raise RuntimeError("no\nrepr")


NO_NUMBER = {
    "nan": (math.nan, "NaN"),
    "numpy nan": (np.float32("nan"), "NaN"),
    "signalling nan": (Decimal("sNaN"), "InvalidOperation"),
    "complex infinity": (sympy.zoo, "zoo"),
    "unevaluated 0 times infinity": (sympy.Mul(0, sympy.oo, evaluate=False), "0"),
    "complex": (1 + 0j, "complex number"),
    "sympy complex": (1 + sympy.I / 10**50, "complex number"),
    "string": ("1.5", "type str"),
    "none": (None, "NoneType"),
    "bool": (True, "truth value"),
    "numpy bool": (np.bool_(True), "truth value"),
    "sympy true": (sympy.true, "True"),
    "list": ([1.5], "type list"),
    "array without axes": (np.array(1.5), "type ndarray"),
    "array of three": (np.array([[1.5], [2], [3]]), "type ndarray"),
    "matrix": (sympy.ImmutableMatrix([[1.5]]), "Matrix"),
    "duration": (np.timedelta64(1, "s"), "timedelta64"),
    "letters": (2 * K, "2*K"),
    "function": (sympy.Function("f")(2), "f(2)"),
    "bounds": (sympy.AccumBounds(1, 2), "AccumBounds"),
    "too large": (sympy.exp(10**12), "beyond 1e2000"),
    "limit": (sympy.Limit(sympy.sin(x) / x, x, 0), "Limit"),
    "equation": (sympy.Eq(x, 1), "Eq"),
    "failing": (Failing(1.5), "ZeroDivisionError"),
    "unprintable": (Unprintable(), "Unprintable"),
}
NO_FORMULA = {
    "rounded decimals": (0.5 * K, "rounded decimals"),
    "float": (0.5 * sympy.Symbol("K"), "rounded decimals"),
    "nan": (math.nan, "nan"),
    "complex infinity": (K * sympy.zoo, "zoo"),
    "bounds": (sympy.AccumBounds(1, 2) * K, "AccumBounds"),
    "string": ("K/(T*s + 1)", "type str"),
    "inequality": (K > 0, "type"),
    "true": (sympy.Eq(K, K), "BooleanTrue"),
    "bool": (True, "type bool"),
    "none": (None, "NoneType"),
    "list": ([K], "type list"),
    "matrix": (sympy.Matrix([K, T]), "Matrix"),
    "tuple": (sympy.Tuple(K, T), "Tuple"),
    "two symbols of one name": (K + sympy.Symbol("K"), "two different symbols named K"),
    "unprintable": (Unprintable(), "Unprintable"),
}
NO_NAME = {
    "number": (1, "type int"),
    "symbol": (sympy.Symbol("stable"), "Symbol"),
    "bool": (True, "type bool"),
    "bytes": (b"stable", "type bytes"),
    "none": (None, "NoneType"),
}
NO_VALUE = [("number", "1.5", NO_NUMBER), ("formula", "K/(T*s + 1)", NO_FORMULA), ("name", "stable", NO_NAME)]


def complaint(call, *arguments, error=LedgerError, **named):
    with pytest.raises(error) as caught:
        call(*arguments, **named)
    assert "\n" not in str(caught.value)
    return str(caught.value)


@pytest.mark.parametrize(("kind", "printed", "cases"), NO_VALUE)
def test_what_is_no_value_is_refused_in_one_line(kind, printed, cases, subtests):
    for name, (value, words) in cases.items():
        with subtests.test(name):
            said = complaint(example(printed, kind=kind).check, y=value)
            assert said.startswith(f"book, Example 1, y: expected a {kind}, got ")
            assert words in said


def test_a_decimal_alone_is_an_exact_formula():
    assert holds(1.5, "1.5", kind="formula")
    assert not holds(1.5000001, "1.5", kind="formula")


def test_a_number_that_claims_to_be_every_other_one():
    assert not holds(Hostile(7), "1.5")


def test_a_disagreement_names_the_place_the_value_and_the_print(capsys):
    said = complaint(example("1.50").check, error=Disagreement, y=1.506)
    assert said == "book, Example 1: y = 1.506 does not agree with the printed 1.50"
    said = complaint(example("1", kind="name").check, error=Disagreement, y="a\nb")
    assert "y = a b" in said
    said = complaint(example("1", status="corrected", correct="2", because="a slip").check, error=Disagreement, y=1)
    assert all(word in said for word in ("y = 1", "2", "1", "corrected"))
    said = complaint(guess("1", "5 %").check, error=Disagreement, y=1.06)
    assert "5 %" in said
    several = book(result=[{"name": name, "printed": "1"} for name in ("a", "b", "c")])["Example 1"]
    assert complaint(several.check, error=Disagreement, a=1, b=2, c=3).endswith("(and 1 more)")
    capsys.readouterr()


TWO = book(given={"K": "1", "tau": "0.5 s"}, result=[{"name": "Kp", "printed": "1"}, {"name": "Ti", "printed": "2"}])


@pytest.mark.parametrize(
    ("call", "words"),
    [
        (lambda: TWO["Example 1"].check(Kpp=1, Ti=2), ["book, Example 1", "'Kpp'", "did you mean 'Kp'"]),
        (lambda: TWO["Example 1"].check(Kp=1), ["book, Example 1", "nothing was given for Ti", "expected Kp, Ti"]),
        (lambda: TWO["Example 1"].check(), ["book, Example 1", "nothing was given for Kp, Ti"]),
        (lambda: TWO["Example 1"].check(Kp=1, Ti=2, q=3), ["book, Example 1", "'q'", "expected one of Kp, Ti"]),
        (lambda: TWO["Example 1"].check(Kp=1, Ti=2, self=3), ["book, Example 1", "'self'"]),
        (lambda: TWO["Exampel 1"], ["book", "'Exampel 1'", "did you mean 'Example 1'"]),
        (lambda: TWO["zzz"], ["book", "'zzz'", "expected one of Example 1"]),
        (lambda: TWO[1], ["book", "no entry 1"]),
        (lambda: TWO[["Example 1"]], ["book", "no entry ['Example 1']"]),
        (lambda: TWO["Example 1"].given("Tau"), ["book, Example 1", "'Tau' is not given", "did you mean 'tau'"]),
        (lambda: TWO["Example 1"].given("q"), ["book, Example 1", "expected one of K, tau"]),
        (lambda: TWO["Example 1"].given(["K"]), ["book, Example 1", "['K'] is not given"]),
        (lambda: book(given={"K": "1"})["Example 1"].check(), ["book, Example 1", "no result", "nothing to check"]),
    ],
)
def test_a_wrong_use_is_explained_in_one_line(call, words):
    said = complaint(call)
    assert all(word in said for word in words), said


def test_a_source_is_a_file_anywhere(tmp_path):
    path = tmp_path / "walls.toml"
    with pytest.raises(LedgerError, match=r"walls\.toml cannot be read: No such file"):
        Source.open(path)
    path.write_bytes(EXAMPLE.read_bytes())
    for where in (path, str(path)):
        assert Source.open(where).name == "walls"
        assert [*Source.open(where)] == [*Source.read("walls", path.read_bytes())]


def test_an_entry_is_read_when_it_is_asked_for():
    source = Source.read("book", (HEAD + '["Example 1"]\ntitle = "A"\nchapter = "1"\n["Example 2"]').encode())
    assert source["Example 1"].title == "A"
    with pytest.raises(LedgerError, match="book, Example 2: title"):
        source["Example 2"]


# Malformed sources, as they are written: each line is a fault, and what is said of it.

HEAD = '[source]\ntitle = "A"\ncitation = "A"\n'
SOURCES = {
    "[source": "book.toml is not valid TOML",
    HEAD + "[a]\n[a]\n": "book.toml is not valid TOML",
    '["Example 1"]\ntitle = "A"\n': "book.toml: expected a table [source] with title and citation",
    'source = "A"\n': "book.toml: expected a table [source]",
    HEAD + 'year = "2010"\n': "and nothing else",
    '[source]\ncitation = "A"\n': "book.toml: expected a table [source]",
    '[source]\ntitle = "A"\ncitation = 1\n': "book.toml: expected a table [source]",
    "a = 1\n" + HEAD: "book, a: the entry is 1, expected a table",
}
ENTRIES = """
chapter = "10"                                  | title is None, expected text
title = "A"                                     | chapter is None, expected text
title = " "                                     | title is ' ', expected text
title = "A" ; chapter = 10                      | chapter is 10, expected text
results = []                                    | unknown key 'results', did you mean 'result'?
given = ["K"]                                   | expected `given` to be a table
result = { name = "y" }                         | and `result` a list of tables
given = { K = 1.5 }                             | given K is 1.5, expected text in quotes
given = { K = "" }                              | given K is '', expected text in quotes
given = { K = "1,5" }                           | given K: cannot read '1,5'
given = { K = "1.5 (s" }                        | given K: cannot read
given = { K = "1/0" }                           | given K: cannot read '1/0' as an expression: 1/0 has no value
result = ["y"]                                  | a result is 'y', expected a table
result = [{ printed = "1" }]                    | a result has no 'name'
result = [{ name = "y" }]                       | a result has no 'printed'
result = [{ name = "y", printed = "1" }, { name = "y", printed = "1" }] | y is a result twice
misprint = "a"                                  | misprint is 'a', expected a list
misprint = [{ printed = "a", correct = "b" }]   | misprint: {'printed': 'a', 'correct': 'b'}, expected a table with
damage = [{ printed = "a", correct = "b", because = "" }] | damage: because is ''
"""
RESULTS = """
units = "s"                                     | unknown key 'units', did you mean 'unit'?
printed = 1.50                                  | printed is 1.5, expected text in quotes
printed = ["1"]                                 | printed is ['1'], expected text in quotes
printed = ""                                    | printed is '', expected text in quotes
printed = "1,5"                                 | y: printed is '1,5', expected a number like 1.50
printed = "1.5 s"                               | y: printed is '1.5 s', expected a number
printed = "63 %"                                | y: printed is '63 %', expected a number
printed = "stable"                              | or else a kind such as 'formula' or 'name'
printed = "nan"                                 | y: printed is 'nan'
printed = "1."                                  | y: printed is '1.'
printed = "١.٥"                                 | y: printed is '١.٥'
printed = "1e999999999"                         | y: printed is '1e999999999'
kind = "formulae"                               | y: the kind is 'formulae', did you mean 'formula'?
kind = "formula" ; printed = "K/(T*s"           | y: printed is cannot read 'K/(T*s'
kind = "formula" ; printed = "1,5"              | y: printed is cannot read '1,5'
kind = "formula" ; printed = "K/0"              | has no value
kind = "formula" ; printed = "a = b = c"        | y: printed is cannot read
kind = "formula" ; printed = "= b"              | y: printed is cannot read
kind = "formula" ; printed = "0 = 0"            | says nothing
kind = "formula" ; printed = "2*(a + b) = 2*a + 2*b" | says nothing
kind = "formula" ; printed = "a <= b"           | y: printed is cannot read
name = "K p"                                    | K p: expected a name that can be an argument in Python
name = "lambda"                                 | lambda: expected a name that can be an argument in Python
status = "correct"                              | y: the status is 'correct', did you mean 'corrected'?
status = "corrected" ; correct = "2"            | 'corrected' needs 'because'
status = "corrected" ; because = "a"            | 'corrected' needs 'correct'
status = "corrected" ; correct = "two" ; because = "a" | correct is 'two'
status = "corrected" ; correct = "1.0" ; because = "a" ; printed = "0.123" | as many digits as in '0.123'
because = "a"                                   | 'computed' has no use for 'because'
status = "unreproduced" ; computed = "2" ; because = "a" | 'unreproduced' needs 'tried'
status = "unreproduced" ; because = "a" ; tried = "b" | 'unreproduced' needs 'computed'
status = "not computable"                       | 'not computable' needs 'because'
status = "divided" ; on = "a tank"              | 'divided' is of claims only, got a number
within = "5 %"                                  | unknown key 'within'
rounded_to = "10" ; printed = "1.5"             | '1.5' rounded to '10', expected an integer
rounded_to = "ten"                              | '1' rounded to 'ten', expected an integer that is rounded to a number
kind = "vector" ; printed = "1.5, b"            | '1.5, b', expected a vector like 0.5, 1.20, 3.0
kind = "range" ; printed = "1.5"                | '1.5', expected a range like 0.5 to 2.0
kind = "complex" ; printed = "1.5"              | '1.5', expected a complex like -0.50 + 1.2i
status = "measured"                             | 'measured' needs 'because'
status = "quoted"                               | 'quoted' needs 'library'
status = "observed"                             | 'observed' needs 'on'
status = "damaged" ; because = "a"              | 'damaged' needs 'correct'
status = "reconstructed"                        | 'reconstructed' needs 'assuming'
status = "fitted" ; assuming = "guess"          | no assumption 'guess' is declared
says = "true"                                   | a print has no use for 'says'
claim = "It grows."                             | a claim has no use for 'printed'
claim = "It grows." ; printed                   | the claim needs 'about'
claim = "It grows." ; about = "a" ; degree = "rather" ; printed | the degree is 'rather', expected a word of the claim
claim = "It grows." ; about = "a" ; degree = "much" ; printed | the degree is 'much', expected a word of the claim
claim = "It grows." ; about = "a" ; measure = "speed" ; printed | the measure is 'speed'
claim = "grows" ; about = "a" ; printed | the claim is 'grows', expected a sentence with a full stop
claim = "It grows." ; about = "a" ; says = "yes" ; printed    | says is 'yes', expected true or false
claim = "It grows." ; about = "a" ; status = "corrected" ; correct = "It falls." ; printed | 'corrected' needs 'because'
"""
ASSUMPTIONS = """
text = "a"                                      | expected a table with text, parameters and perhaps within
text = "a" ; parameters = "two"                 | parameters is 'two', expected how many values were chosen
text = "a" ; parameters = true                  | parameters is True, expected how many values were chosen
text = " " ; parameters = 1                     | text is ' ', expected a sentence
text = "a" ; parameters = 1 ; within = "a little" | within is 'a little', expected a positive number
text = "a" ; parameters = 1 ; within = "0"      | within is '0', expected a positive number
text = "a" ; parameters = 1 ; within = "-1 %"   | within is '-1 %', expected a positive number
text = "a" ; parameters = 1 ; within = "1 s"    | within is '1 s', expected a positive number
text = "a" ; parameters = 1 ; within = "100 %"  | or a percentage below 100 %
text = "a" ; parameters = 1 ; within = "oo"     | within is 'oo', expected a positive number
"""


def faults(lines):
    return [[part.strip() for part in line.rsplit("|", 1)] for line in lines.strip().splitlines()]


def table(keys, **usual):
    """A table of TOML: some keys as they are written, beside usual ones, of which those named alone are left out."""
    own = dict(part.strip().partition(" = ")[::2] for part in keys.split(" ; "))
    return {key: value for key, value in ({key: f'"{text}"' for key, text in usual.items()} | own).items() if value}


def test_a_malformed_source_is_explained_in_one_line(subtests):
    cases = [*SOURCES.items()]
    for keys, words in faults(ENTRIES):
        usual = {} if keys.startswith(("title", "chapter")) else {"title": "A", "chapter": "10"}
        lines = [f"{key} = {value}" for key, value in table(keys, **usual).items()]
        cases.append(("\n".join([HEAD + '["Example 1"]', *lines]), words))
    for keys, words in faults(RESULTS):
        row = ", ".join(f"{key} = {value}" for key, value in table(keys, name="y", printed="1").items())
        cases.append((f'{HEAD}["Example 1"]\ntitle = "A"\nchapter = "10"\nresult = [{{ {row} }}]', words))
    for keys, words in faults(ASSUMPTIONS):
        lines = [f"{key} = {value}" for key, value in table(keys).items()]
        cases.append(("\n".join([HEAD + "[assumption.guess]", *lines]), words))
    cases.append((HEAD + "[measure]\nspeed = 1", "the measure of 'speed' is 1, expected quantities in quotes"))
    for content, words in cases:
        with subtests.test(words=words):
            said = complaint(read, content.encode())
            assert said.startswith("book")
            assert words in said
    assert "decode" in complaint(read, HEAD.encode() + "# Å".encode("latin-1"))


def test_text_over_several_lines_is_joined():
    entry = example("1", status="corrected", correct="2", because="the author\n  slipped")
    assert entry.results[0].status.because == "the author slipped"
    assert book(title="two\nlines")["Example 1"].title == "two lines"


# Givens.


def test_givens_are_exact():
    entry = book(given={"K": "0.1", "T": "-1.5e-3 s", "share": "63 %", "H": "K/(0.5*s + 1)", "m": "a = b"})["Example 1"]
    K_, T_, share, H, m = entry.given("K", "T", "share", "H", "m")
    assert (K_, T_, share) == (sympy.Rational(1, 10), sympy.Rational(-15, 10**4), 63)
    assert K / (s / 2 + 1) == H
    assert isinstance(m, sympy.Equality)
    assert entry.given("K") == K_
    assert entry.givens == {"K": K_, "T": T_, "share": share, "H": H, "m": m}
    assert [given.unit for given in entry.inputs.values()] == ["", "s", "%", "", ""]


def test_printed_values_are_had_for_numbers_of_any_status():
    rows = [
        {"name": "Kp", "printed": "1.50"},
        {"name": "Ti", "printed": "8", "status": "not computable", "because": "it is not said how"},
        {"name": "Td", "printed": "2", "status": "corrected", "correct": "3", "because": "of a slip"},
        {"name": "H", "kind": "formula", "printed": "K/s"},
        {"name": "fast", "about": "time", "claim": "It is fast."},
        {"name": "limit", "printed": "oo"},
    ]
    entry = book(result=rows)["Example 1"]
    assert entry.printed_value("Kp") == sympy.Rational(3, 2)
    assert entry.printed_value("Td", "Ti", "Kp") == (2, 8, sympy.Rational(3, 2))
    assert entry.as_printed("Ti") == 8
    for name in ("H", "fast", "limit", "Kc", 3):
        with pytest.raises(LedgerError, match="is no printed number"):
            entry.printed_value(name)
    with pytest.raises(LedgerError, match="no number that only the book has"):
        entry.as_printed("Kp")


def test_a_notebook_cannot_change_the_ledger():
    entry = TWO["Example 1"]
    entry.givens["K"] = 5  # a copy
    for change in (
        lambda: entry.inputs.__setitem__("K", 5),
        lambda: TWO.tables.__setitem__("Example 1", None),
        lambda: TWO.__setitem__("Example 1", None),
        lambda: setattr(entry, "results", ()),
        lambda: setattr(entry.results[0], "printed", "2"),
        lambda: setattr(entry.inputs["K"], "value", 5),
    ):
        with pytest.raises((AttributeError, TypeError)):
            change()
    assert TWO["Example 1"].given("K") == 1


# What the reader sees.

MIXED = read(b"""
[source]
title = "Author"
citation = "A. Author"
[assumption.flow]
text = "F = 1 <kg/s>"
parameters = 1
within = "5 %"
["Example 1"]
title = 'A <b>title</b> & "more"'
chapter = "02_walls"
given = { K = "1.5 s", H = "K/(T*s + 1)" }
result = [
    { name = "share", equation = "6.21", printed = "0.63", unit = "m/s" },
    { name = "H", kind = "formula", printed = "K/(T*s + 1)" },
    { name = "action", kind = "name", printed = "Reverse" },
    { name = "a", printed = "1", status = "corrected", correct = "2", because = 'a <b>"slip"</b> & more' },
    { name = "b", printed = "1", status = "reconstructed", assuming = "flow" },
    { name = "c", printed = "1", status = "unreproduced", computed = "2", because = "nobody knows", tried = "F = 2" },
    { name = "d", printed = "17.3", status = "measured", because = "in the laboratory" },
    { name = "e", printed = "8.4", status = "not computable", because = "its settings are not printed" },
    { name = "f", printed = "0.9", label = "share of <water>", status = "quoted", library = "math.pi" },
    { name = "grows", about = "peak", claim = "The peak grows with the gain." },
    { name = "is_large", about = "gain", claim = "The gain is large & positive.", status = "observed", on = "a tank" },
    { name = "m", about = "y", degree = "much", claim = "Much.", status = "corrected", correct = "N.", because = "a" },
    { name = "b_3", printed = "2(a+b)", kind = "name", status = "damaged", correct = "2", because = "a bracket" },
    { name = "g", printed = "3", status = "fitted", assuming = "flow" },
    { name = "better", about = "area; time", claim = "It is better.", status = "divided", on = "a tank of ours" },
]
misprint = [{ printed = "Section ??", correct = "Section 9.2", because = "the reference is lost" }]
damage = [{ printed = "k 1", correct = "k_1", because = "an index is lost", place = "footnote" }]
""")["Example 1"]
GOOD = {
    "share": 0.632121,
    "H": K / (T * s + 1),
    "action": "reverse",
    "a": 2,
    "b": 1.04,
    "c": 2,
    "f": 0.9,
    "grows": greater(1.5, 1.2, "peak [m]"),
    "is_large": positive(K * T, "gain"),
    "m": much_greater(1.2, 1, "y [m]"),
    "b_3": "2",
    "g": 3.1,
    "better": every(greater(2, 1, "area"), greater(1, 2, "time")),
}


def test_a_report_tells_everything_as_text():
    told = repr(MIXED.compare(**GOOD))
    for row in MIXED.results:
        assert all(part in told for part in (row.title, row.printed.text, row.status.word, row.status.note))
    assert "\nreconstructed to within 5 %, assuming F = 1 <kg/s> (1 free parameter)\n" in told  # the only one
    assert "\na: corrected: a <b>" in told  # one of two
    assert "\none claim: corrected: a\n" in told
    for part in ("Author, Example 1", MIXED.title, "6.21", "m/s", "0.632121", "reverse", "5 %", "F = 1 <kg/s>"):
        assert part in told
    assert "computed: The peak grows with the gain.\n    peak 1.5 m > 1.2 m\n" in told
    assert "misprint: the book prints `Section ??` for `Section 9.2`: the reference is lost" in told
    assert "damaged: our copy prints `k 1` (footnote) for `k_1`: an index is lost" in told
    heading = told.splitlines()[0]
    assert heading.endswith(": 4 computed, 2 corrected, 1 reconstructed, 1 unreproduced, 1 measured, "
                            "1 not computable, 1 quoted, 1 observed, 1 damaged, 1 fitted, 1 divided")  # fmt: skip
    assert "does not hold" not in told
    assert repr(MIXED.compare(**GOOD | {"a": 1})).count("does not hold") == 1


def test_a_report_tells_everything_as_html_and_escapes_it():
    told = MIXED.compare(**GOOD)._repr_html_()
    for part in ("Example 1", "6.21", "0.63", "m/s", "0.632121", "reverse", "corrected", "reconstructed", "measured"):
        assert part in told
    assert "A &lt;b&gt;title&lt;/b&gt; &amp; " in told
    assert "a &lt;b&gt;" in told
    assert "F = 1 &lt;kg/s&gt;" in told
    assert "<b>" not in told
    assert "share of &lt;water&gt;" in told
    assert "The gain is large &amp; positive." in told
    assert not re.search("colou?r", told)
    assert "<summary>✓ <strong>Author, Example 1" in told
    assert '<details class="loopbook-check" open>' in MIXED.compare(**GOOD | {"a": 1})._repr_html_()
    assert "does not hold" in MIXED.compare(**GOOD | {"a": 1})._repr_html_()


def test_a_report_marks_agreement_only_where_there_is_some():
    told = MIXED.compare(**GOOD)._repr_html_().partition("</thead>")[2]
    marks = re.findall(r'class="verdict">(.)&nbsp;([a-z ]+)', told)
    agreement = {"computed": "✓", "reconstructed": "✓", "observed": "✓", "quoted": "="}
    others = {
        "corrected": "≠", "damaged": "≠", "unreproduced": "?", "measured": "–", "not computable": "–", "fitted": "~",
        "divided": "±",
    }  # fmt: skip
    assert marks == [((agreement | others)[row.status.word], row.status.word) for row in MIXED.results]
    assert {word for _, word in marks} == set(STATUSES)
    assert "✗" in MIXED.compare(**GOOD | {"c": 1})._repr_html_()


def test_a_report_carries_its_verdicts_as_data():
    bundle = MIXED.compare(**GOOD)._repr_mimebundle_()
    assert {"text/plain", "text/html", MIME_TYPE} <= set(bundle)
    data = json.loads(json.dumps(bundle["application/vnd.loopbook.check+json"], allow_nan=False))
    assert (data["source"], data["entry"]) == ("book", "Example 1")
    assert [(v["name"], v["book"], v["status"], v["computed"], v["holds"], v["how"]) for v in data["verdicts"]] == [
        ("share", "0.63 m/s", "computed", "0.632121", True, "digits"),
        ("H", "K/(T*s + 1)", "computed", "K/(T*s + 1)", True, "proved"),
        ("action", "Reverse", "computed", "reverse", True, "word"),
        ("a", "1", "corrected", "2", True, "digits"),
        ("b", "1", "reconstructed", "1.04", True, "within"),
        ("c", "1", "unreproduced", "2", True, "digits"),
        ("d", "17.3", "measured", "", True, "measured"),
        ("e", "8.4", "not computable", "", True, "not computable"),
        ("f", "0.9", "quoted", "0.9", True, "digits"),
        ("grows", "says so", "computed", "peak 1.5 m > 1.2 m", True, "evidence"),
        ("is_large", "says so", "observed", "gain K*T > 0, proved", True, "evidence"),
        ("m", "says so", "corrected", GOOD["m"].told(), True, "evidence"),
        ("b_3", "2(a+b)", "damaged", "2", True, "word"),
        ("g", "3", "fitted", "3.1", True, "within"),
        ("better", "says so", "divided", GOOD["better"].told(), True, "evidence"),
    ]
    H, is_large = data["verdicts"][1], data["verdicts"][-5]
    assert H["tex"]["computed"] == H["tex"]["book"] == r"$\displaystyle \dfrac{K}{T s + 1}$"
    assert is_large["tex"] == {"computed": r"gain $\displaystyle K T$ > 0, proved"}
    assert is_large["evidence"] == positive(K * T, "gain").data
    failed = MIXED.compare(**GOOD | {"a": 1})._repr_mimebundle_()[MIME_TYPE]["verdicts"]
    assert [verdict["name"] for verdict in failed if not verdict["holds"]] == ["a"]


def test_an_entry_shows_its_givens():
    for told in (repr(MIXED), MIXED._repr_html_()):
        assert all(part in told for part in ("Example 1", "1.5 s", "K", "H"))
    assert "<b>" not in MIXED._repr_html_()
    assert "A. Author" in repr(TWO)


def test_a_check_is_shown_once_and_before_the_error(capsys, monkeypatch):
    MIXED.check(**GOOD)
    shown = capsys.readouterr().out
    assert shown == repr(MIXED.compare(**GOOD)) + "\n"
    monkeypatch.delitem(sys.modules, "IPython", raising=False)
    MIXED.check(**GOOD)
    assert capsys.readouterr().out == shown
    with pytest.raises(Disagreement):
        MIXED.check(**GOOD | {"a": 1})
    assert capsys.readouterr().out.count("does not hold") == 1


BOOK = """
[source]
title = "Author"
citation = "A. Author"
["Equation 1"]
title = "A gain and a time constant"
chapter = "02_walls"
result = [{ name = "K", printed = "1.5" }, { name = "T", kind = "formula", printed = "2" }]
"""
CELLS = [
    f'from bookledger import Source\nbook = Source.read("book", {BOOK.encode()})\nlag = book["Equation 1"]',
    "lag.check(K=1.5, T=2)",
    "lag.check(K=1.5, T=3)",
    'book["Equatoin 1"]',
    "lag.check(K=1.5, T=None)",
]


def test_a_notebook_shows_the_table_once_and_an_error_as_one_sentence():
    cells = [nbformat.v4.new_code_cell(source) for source in CELLS]
    notebook = nbformat.v4.new_notebook(cells=cells)
    nbclient.NotebookClient(notebook, timeout=60, kernel_name="python3", allow_errors=True).execute()
    imported, good, bad, unknown, no_number = (cell.outputs for cell in notebook.cells)
    assert imported == []
    assert [output.output_type for output in good] == ["display_data"]
    assert {"text/plain", "text/html", MIME_TYPE} <= set(good[0].data)
    assert [output.output_type for output in bad] == ["display_data", "error"]
    assert [v["holds"] for v in bad[0].data[MIME_TYPE]["verdicts"]] == [True, False]
    assert [output.output_type for output in (*unknown, *no_number)] == ["error", "error"]
    for output, words in [
        (bad[1], "book, Equation 1: T = 3 does not agree with the printed 2"),
        (unknown[0], "book has no entry 'Equatoin 1', did you mean 'Equation 1'?"),
        (no_number[0], "book, Equation 1, T: expected a formula, got None of type NoneType"),
    ]:
        assert output.evalue == words
        assert output.traceback == [f"{output.ename}: {words}"]
