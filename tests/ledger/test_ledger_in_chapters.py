"""The ledger against the stored chapters: every result is checked where it belongs, and every status is true.

Nothing here uses the library's own comparison: the ledger is read as plain TOML, numbers are compared by decimal
arithmetic, and formulas by evaluating both at random points, with an elementary function for every unknown one.
"""

import ast
import copy
import functools
import json
import math
import operator
import os
import random
import re
import subprocess
import sys
import tomllib
from collections import Counter
from decimal import Context, Decimal, InvalidOperation, localcontext
from pathlib import Path

import mpmath
import pytest
import sympy
from sympy.integrals.manualintegrate import manualintegrate
from typer.testing import CliRunner

import contributing
import loopbook.ledger
from bookledger.errata import totals
from bookledger.evidence.criteria import CRITERIA
from bookledger.statuses import STATUSES
from draws import THOROUGH
from loopbook import errata, s
from loopbook.__main__ import app
from loopbook.evidence import decreasing, equal, every, greater, much_greater, negligible, refused, some, unstable
from loopbook.ledger import Source, sources
from plainmath.tables import is_symbol

ROOT = Path(__file__).parents[2]
LEDGER = ROOT / "lib" / "loopbook-books" / "loopbook" / "ledger"
CHAPTERS = ROOT / "chapters"
MIME_TYPE = "application/vnd.loopbook.check+json"
K, T = sympy.symbols("K T", positive=True)


def books():
    """The ledger as it is written: {source: {entry: {...}}}."""
    return {file.stem: entries_of(file.read_text(encoding="utf-8")) for file in sorted(LEDGER.glob("*.toml"))}


def entries_of(text):
    """The entries of a source."""
    return {key: entry for key, entry in tomllib.loads(text).items() if key != "source"}


def stored_checks():
    """The verdicts stored in the chapters: [(chapter, verdicts on an entry), ...]."""
    return [
        (file.stem, output["data"][MIME_TYPE])
        for file in sorted(CHAPTERS.glob("*.ipynb"))
        for cell in json.loads(file.read_text(encoding="utf-8"))["cells"]
        for output in cell.get("outputs", [])
        if MIME_TYPE in output.get("data", {})
    ]


# Coverage.


def gaps(written, checks, chapters):
    """What is wrong between the ledger and the checks stored in the chapters, in sentences."""
    found = []
    for chapter, check in checks:
        place = f"{check['source']}, {check['entry']}, checked in {chapter}"
        entry = written.get(check["source"], {}).get(check["entry"])
        if entry is None:
            found.append(f"{place}: no such entry")
            continue
        if chapter != entry["chapter"]:
            found.append(f"{place}: it belongs to {entry['chapter']}")
        expected = [(row["name"], *print_of(row), row.get("status", "computed")) for row in entry.get("result", [])]
        if [
            tuple(row.get(key) for key in ("name", "title", "book", "status")) for row in check["verdicts"]
        ] != expected:
            found.append(f"{place}: not the results of the ledger as it stands now: run `make execute`")
        found += [f"{place}: {row['name']} does not hold" for row in check["verdicts"] if row["holds"] is not True]
    checked = {(check["source"], check["entry"]) for _, check in checks}
    for source, entries in written.items():
        for name, entry in entries.items():
            if entry["chapter"] not in chapters:
                found.append(f"{source}, {name}: no notebook {entry['chapter']}")
            if entry.get("result") and (source, name) not in checked:
                found.append(f"{source}, {name}: checked by no chapter")
    return found


def print_of(row):
    """What a check shows of a result: what it is called, and what the book prints."""
    if "claim" in row:
        return " ".join(row["claim"].split()), "says so" if row.get("says", "true") == "true" else "denies it"
    title = row.get("label") or (row["name"] if is_symbol(row["name"]) else row["name"].replace("_", " "))
    return title, " ".join(f"{row['printed']} {row.get('unit', '')}".split())


def real():
    """The ledger of the library, the checks that its chapters store, and their names."""
    return books(), stored_checks(), {file.stem for file in CHAPTERS.glob("*.ipynb")}


def shown():
    """The ledger that contributors are shown, with a check of its entry, and two chapters."""
    entry = Source.read("shown", contributing.ledger().encode())["Example 10.2"]
    k, T_, tau = entry.given("K", "T", "tau")
    H = K * sympy.exp(-sympy.Symbol("tau", positive=True) * s) / (T * s + 1)
    report = entry.compare(K_p=T_ / (2 * k * tau), H=H, less_stable=greater(2, 1, "Ms"))
    written = {"shown": entries_of(contributing.ledger())}
    return written, [("10_tuning", report._repr_mimebundle_()[MIME_TYPE])], {"10_tuning", "11_control_structures"}


@pytest.mark.parametrize("ledger", [real, shown])
def test_every_entry_is_checked_in_its_chapter(ledger):
    found = gaps(*ledger())
    assert not found, "\n" + "\n".join(found)


DOCTORED = [
    (lambda check: check.update(entry="Example 99"), "no such entry"),
    (lambda check: check.update(source="nobody"), "no such entry"),
    (lambda check: check["verdicts"][0].update(holds=False), "does not hold"),
    (lambda check: check["verdicts"][0].update(holds="yes"), "does not hold"),
    (lambda check: check["verdicts"][0].update(book="7"), "not the results of the ledger"),
    (lambda check: check["verdicts"][0].update(title="another"), "not the results of the ledger"),
    (lambda check: check["verdicts"][0].update(status="measured"), "not the results of the ledger"),
    (lambda check: check["verdicts"][0].update(name="other"), "not the results of the ledger"),
    (lambda check: check["verdicts"].pop(), "not the results of the ledger"),
    (lambda check: check["verdicts"].append(check["verdicts"][0]), "not the results of the ledger"),
]
MOVED_ON = [
    (lambda entry: entry.update(chapter="11_control_structures"), "belongs to 11_control_structures"),
    (lambda entry: entry.update(chapter="99_nothing"), "no notebook 99_nothing"),
    (lambda entry: entry["result"].append({"name": "another", "printed": "1"}), "not the results of the ledger"),
]


def test_a_check_that_is_not_that_of_the_ledger_is_found_out(subtests):
    for number, (change, words) in enumerate(DOCTORED):
        with subtests.test(f"doctored, case {number}: {words}"):
            written, [(chapter, check)], chapters = shown()
            change(check)
            assert words in "".join(gaps(written, [(chapter, check)], chapters))
    for number, (change, words) in enumerate(MOVED_ON):
        with subtests.test(f"moved on, case {number}: {words}"):
            written, checks, chapters = shown()
            change(written["shown"]["Example 10.2"])
            assert words in "".join(gaps(written, checks, chapters))


def test_an_entry_with_results_is_checked_once_or_more():
    written, checks, chapters = shown()
    assert gaps(written, checks * 2, chapters) == []
    assert gaps(written, [], chapters) == ["shown, Example 10.2: checked by no chapter"]
    written["shown"]["Figure 99"] = {"chapter": "10_tuning"}
    assert gaps(written, checks, chapters) == []


# Truth.


def untrue(written, computed):
    """The statuses of a source that are not true, in sentences; `computed` holds texts and evidence by result."""
    found = []
    checked = {name for name, _ in computed}  # of an entry that no chapter checks, `gaps` says so
    rows = [(name, row) for name, entry in written.items() for row in entry.get("result", []) if name in checked]
    assumed = Counter(row["assuming"] for _, row in rows if row.get("status") == "reconstructed")
    for entry, row in rows:
        status, kind = row.get("status", "computed"), "claim" if "claim" in row else row.get("kind", "number")
        if status == "measured" or (status == "unreproduced" and "computed" not in row):
            continue
        where = f"{entry}, {row['name']}"
        value = computed.get((entry, row["name"]))
        if value is None:
            found.append(f"{where}: nothing is computed")
            continue
        printed = row["claim" if kind == "claim" else "printed"]
        if kind == "claim":
            if not isinstance(value, dict) or value["holds"] is not speaks_for(value):
                found.append(f"{where}: no evidence, or told wrongly")
                continue
            if speaks_for(turned(value)) is value["holds"]:
                found.append(f"{where}: the evidence cannot fail")
            printed_holds = value["holds"] is (row.get("says", "true") == "true")
            if status == "computed" and (ours := criteria_of(value) & OURS):
                found.append(f"{where}: judged by a criterion of ours, {', '.join(sorted(ours))}")
        else:
            printed_holds = same(kind, value, printed)
        if status in ("computed", "quoted", "observed") and not printed_holds:
            found.append(f"{where}: {value} is not {printed}")
        if status in ("corrected", "damaged", "unreproduced"):
            told = row["computed" if status == "unreproduced" else "correct"]
            if printed_holds:
                found.append(f"{where}: the book is right")
            if kind != "claim" and not same(kind, value, told):
                found.append(f"{where}: {value} is not {told}")
        if status == "reconstructed":
            if kind in ("claim", "name") and not printed_holds:
                found.append(f"{where}: {value} is not {printed}")
            if kind == "number" and not within(value, row["printed"], row["within"]):
                found.append(f"{where}: {value} is not within {row['within']} of {row['printed']}")
            if assumed[row["assuming"]] < 2:
                found.append(f"{where}: an assumption for this number alone")
    return found


# Evidence, judged again from its data.

OURS = {criterion.word for criterion in CRITERIA if not criterion.published}
ORDER = {">": operator.gt, "<": operator.lt, "≥": operator.ge, "≤": operator.le}
CONTRARY = {">": "≤", "≤": ">", "<": "≥", "≥": "<", "=": "≠", "≠": "="}


def speaks_for(evidence):
    """Whether a piece of evidence holds, by its stored data."""
    match evidence["kind"]:
        case "every":
            return all(map(speaks_for, evidence["cases"])) and bool(evidence["cases"])
        case "some":
            return any(map(speaks_for, evidence["cases"]))
        case "stability":
            poles = evidence["unstable_poles"]
            return poles == "0" if evidence["is_stable"] else poles not in ("0", "nan")
        case "refusal":
            return bool(evidence["sentence"]) is evidence["is_refused"]
        case "ratio":
            return by_ratio(evidence) is not evidence["contrary"]
        case "comparison" if evidence["relation"] in "=≠":
            equal = {"texts": operator.eq, "numbers": nearly, "formulas": same_formula}[evidence["of"]]
            return equal(evidence["left"], evidence["right"]) is (evidence["relation"] == "=")
        case "comparison":
            holds, left, right = ORDER[evidence["relation"]], evidence["left"], evidence["right"]
            if evidence["of"] == "formulas":
                room = sympy.Float("1e-20") * {"≥": -1, "≤": 1}.get(
                    evidence["relation"], 0
                )  # for the noise around zero
                return all(holds(value, room) for value in differences(left, right))
            return holds(decimal_of(left), decimal_of(right))
    raise ValueError(f"cannot judge {evidence}")


def decimal_of(text):
    return Decimal({"oo": "Infinity", "-oo": "-Infinity"}.get(text, text))


ROUNDING = Decimal("1e-9")


def nearly(left, right):
    a, b = decimal_of(left), decimal_of(right)
    return a == b or abs(a - b) <= ROUNDING * max(abs(a), abs(b)) < Decimal("Infinity")


def by_ratio(evidence):
    a, b, limit = (decimal_of(evidence[key]) for key in ("left", "right", "limit"))
    match evidence["criterion"]:
        case "about equal":
            return a == b or abs(a - b) <= limit * max(abs(a), abs(b))
        case "negligible":
            return abs(a) <= limit * abs(b)
        case "roughly equal":
            return a == b or max(a, b) < (1 + limit) * min(a, b)
        case "much":
            return a > b and a >= (1 + limit) * b
        case "substantially":
            return a < b and a <= limit * b
    raise ValueError(f"cannot judge {evidence}")


def differences(left, right, points=12):
    """The difference of two expressions at random points, where all symbols are positive."""
    found = []
    for draw in range(points):
        difference, dice = read(left, draw) - read(right, draw), random.Random(draw)
        symbols = sorted(difference.free_symbols, key=str)
        point = {x: sympy.Rational(dice.randint(1, 10**6), 10 ** dice.randint(3, 8)) for x in symbols}
        found.append(difference.evalf(30, subs=point))
    return found


def turned(evidence):
    """The evidence turned around: sides exchanged, a counterexample among the cases, another system."""
    match evidence:
        case {"kind": "every" | "some" as kind, "cases": cases}:
            first = next(number for number, case in enumerate(cases) if case["holds"] is evidence["holds"])
            whole = evidence["holds"] is (kind == "some")  # all of them turn the verdict, otherwise the first one does
            return evidence | {
                "cases": [
                    turned(case) if number == first or (whole and case["holds"] is evidence["holds"]) else case
                    for number, case in enumerate(cases)
                ]
            }
        case {"kind": "comparison", "relation": ">" | "<", "holds": True, "left": left, "right": right}:
            return evidence | {"left": right, "right": left}
        case {"kind": "comparison", "relation": relation}:
            return evidence | {"relation": CONTRARY[relation]}
        case {"kind": "ratio", "criterion": "much", "contrary": False, "holds": True}:
            return evidence | {"left": evidence["right"], "right": evidence["left"]}
        case {"kind": "ratio", "contrary": contrary}:
            return evidence | {"contrary": not contrary}
        case {"kind": "stability", "unstable_poles": poles}:
            return evidence | {"unstable_poles": "1" if poles == "0" else "0"}
        case {"kind": "refusal", "sentence": sentence}:
            return evidence | {"sentence": "" if sentence else "no"}
    raise ValueError(f"cannot turn {evidence}")


def criteria_of(evidence):
    """The words of all criteria that a piece of evidence rests on."""
    return {evidence.get("criterion", "")}.union(*map(criteria_of, evidence.get("cases", [])))


# Values.


def same(kind, value, told):
    if kind == "name":
        return value.split() == told.split() or value.lower().split() == told.lower().split()
    return same_number(value, told) if kind == "number" else same_formula(value, told)


def same_number(value, told):
    """Whether a number lies within half a unit of the last digit of another."""
    if "oo" in (value, told):
        return value == told
    mantissa, _, exponent = told.lower().partition("e")
    half = Decimal(5).scaleb(int(exponent or 0) - len(mantissa.partition(".")[2]) - 1)
    with localcontext(Context(prec=200)):
        return abs(Decimal(value) - Decimal(told)) <= half


def within(value, printed, margin):
    with localcontext(Context(prec=200)):
        if margin.endswith("%"):
            margin = abs(Decimal(printed)) * Decimal(margin.rstrip("% ")) / 100
        return abs(Decimal(value) - Decimal(printed)) <= Decimal(margin)


KNOWN = [
    "exp", "log", "sqrt", "Abs", "sign", "sin", "cos", "tan", "asin", "acos", "atan", "atan2", "sinh", "cosh", "tanh",
    "re", "im", "Min", "Max", "factorial", "gamma", "Heaviside", "Derivative", "Integral", "Subs",
]  # fmt: skip
CALLS = re.compile(r"(\w+)\s*\(")
OPERATIONS = {
    ast.Add: operator.add,
    ast.Sub: operator.sub,
    ast.Mult: operator.mul,
    ast.Div: operator.truediv,
    ast.Pow: operator.pow,
}


def read(text, draw):
    """An expression with an elementary function in place of each unknown one: in every draw another."""
    return _read(text, draw if any(name not in KNOWN or name == "Integral" for name in CALLS.findall(text)) else 0)


@functools.cache
def _read(text, draw):

    def coefficients(name, number):
        dice = random.Random(f"{name} {draw}")
        return [sympy.Rational(dice.randint(1, 999), 500) for _ in range(number)]

    def of(node):
        match node:
            case ast.Constant(int() | float()):
                return sympy.Rational(ast.get_source_segment(text, node))
            case ast.Name("pi" | "oo" | "I" as name):
                return getattr(sympy, name)
            case ast.Name(name):
                return sympy.Symbol(name, positive=True) if name != "s" else sympy.Symbol("s")
            case ast.BinOp(left, operation, right):
                return OPERATIONS[type(operation)](of(left), of(right))
            case ast.UnaryOp(ast.USub(), operand):
                return -of(operand)
            case ast.UnaryOp(ast.UAdd(), operand):
                return of(operand)
            case ast.Tuple(parts):
                return sympy.Tuple(*map(of, parts))
            case ast.Call(ast.Name("Integral"), [integrand, ast.Tuple([variable, *limits])]) if "oo" in ast.unparse(
                node
            ):
                # of a signal that is not known: the integrand somewhere, and which limits are infinite
                endless = [n for n, limit in enumerate(limits, start=2) if of(limit).is_infinite]
                return math.prod(endless) * of(integrand).subs(of(variable), sympy.Rational(draw + 1, 7))
            case ast.Call(ast.Name("Integral"), [integrand, ast.Tuple([variable, low, high])]):
                # term by term, and by rules, because the general method takes seconds for a sum of exponentials
                whole = manualintegrate(sympy.expand(of(integrand).doit()), of(variable))
                return whole.subs(of(variable), of(high)) - whole.subs(of(variable), of(low))
            case ast.Call(ast.Name(name), arguments) if name in KNOWN:
                return getattr(sympy, name)(*map(of, arguments))
            case ast.Call(ast.Name(name), arguments):
                start, height, *rates = coefficients(name, 2 + len(arguments))
                exponent = sum(rate * of(argument) for rate, argument in zip(rates, arguments, strict=True))
                return start + height * sympy.exp(-exponent)
        raise ValueError(f"cannot read {text!r}")

    return of(ast.parse(text, mode="eval").body).doit()


@functools.cache
def same_formula(one, other):
    """Whether two formulas, or two equations, agree to 35 digits at random points: at three, or at six and more."""
    least = 6 if THOROUGH else 3
    if ("=" in one) != ("=" in other):
        return False
    alike, opposite = [], []
    for draw in range(12):
        if len(alike) == least and not THOROUGH:
            break
        sides = []
        for text in (one, other):
            left, _, right = (part.strip() for part in text.partition("="))
            sides.append(read(left, draw) - (read(right, draw) if right else 0))
        if "oo" in (one, other):
            return sides[0] == sides[1]
        dice = random.Random(draw)
        point = {}
        for letter in sorted(sides[0].free_symbols | sides[1].free_symbols, key=str):
            point[letter] = sympy.Rational(dice.randint(1, 10**6), 10 ** dice.randint(3, 8))
            if letter.name == "s":
                point[letter] = point[letter] * sympy.I + dice.randint(-3, 3)
        values = [side.evalf(60, subs=point) for side in sides]
        if all(value.is_number and value.is_finite for value in values):
            with mpmath.workdps(60):
                a, b = (mpmath.mpc(*value.as_real_imag()) for value in values)
                limit = mpmath.mpf("1e-35") * (mpmath.mpf("1e-20") + abs(a) + abs(b))
                alike.append(abs(a - b) <= limit)
                # an equation may have its sides exchanged
                opposite.append("=" in one and abs(a + b) <= limit)
    return len(alike) >= least and (all(alike) or all(opposite))


def computed_in(checks, source):
    return {
        (check["entry"], row["name"]): row.get("evidence", row["computed"])
        for _, check in checks
        if check["source"] == source
        for row in check["verdicts"]
    }


@pytest.mark.parametrize(("ledger", "source"), [*((real, name) for name in books()), (shown, "shown")])
def test_every_status_is_true(ledger, source):
    written, checks, _ = ledger()
    found = untrue(written[source], computed_in(checks, source))
    assert not found, "\n" + "\n".join(map(str, found))


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
    { name = "valve", kind = "name", printed = "V1", status = "quoted", library = "loopbook.instruments.says" },
    { name = "action", kind = "name", printed = "direct", status = "corrected", correct = "reverse", because = "a" },
]
[claims]
result = [
    { name = "grows", claim = "It grows." },
    { name = "falls", claim = "It falls.", says = "false" },
    { name = "always", claim = "It grows in every case.", status = "corrected", correct = "At times.", because = "a" },
    { name = "can", claim = "It can be unstable.", status = "observed", on = "a tank" },
    { name = "much", claim = "It is much larger.", status = "observed", on = "a tank" },
    { name = "same", claim = "They are the same.", status = "quoted", library = "loopbook.tuning.simc" },
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
    ("claims", "can"): some(equal("V1", "V2"), unstable(1 / (s - 1))).data,
    ("claims", "much"): much_greater(3, 1).data,
    ("claims", "same"): equal(K * (T + 1), K * T + K).data,
    ("claims", "none"): refused(unstable, K).data,
    ("claims", "unknown"): negligible(1, 2).data,
}


def test_true_statuses_are_accepted():
    assert untrue(SYNTHETIC, TRUE) == []


@pytest.mark.parametrize(
    ("entry", "name", "value", "words"),
    [
        ("digits", "share", "0.6351", "0.6351 is not 0.63"),
        ("digits", "share", "oo", "oo is not 0.63"),
        ("digits", "large", "2501", "2501 is not 2e3"),
        ("digits", "limit", "1e99", "is not oo"),
        ("digits", "wrong", "1.50", "the book is right"),
        ("digits", "wrong", "1.606", "1.606 is not 1.60"),
        ("digits", "open", "1.505", "the book is right"),
        ("digits", "open", "1.7", "1.7 is not 1.60"),
        ("curves", "first", "10.51", "not within 5 %"),
        ("curves", "second", "-2.11", "not within 0.1"),
        ("curves", "third", "swings", "swings is not settles"),
        ("formulas", "H", "K/(T*s - 1)", "is not K/(T*s + 1)"),
        ("formulas", "H", "K/(T*s + 1) + 1/10**30", "is not K/(T*s + 1)"),
        ("formulas", "H", "K/(T*s + 1) = 0", "is not K/(T*s + 1)"),
        ("formulas", "y", "s*Y(s) + y(0) = 2*U(s)", "is not s*Y(s)"),
        ("formulas", "h", "Integral(q(x), (x, 0, t)) + f(oo)", "is not Integral"),
        ("formulas", "d", "Subs(Derivative(f(x), x), x, 1)", "is not Subs"),
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
        ("claims", "falls", decreasing([3, 2, 1]).data, "is not It falls."),
        ("claims", "always", every({"K = 1": greater(2, 1)}).data, "the book is right"),
        ("claims", "can", some(equal("V1", "V2"), unstable(1 / (s + 1))).data, "is not It can be unstable."),
        ("claims", "much", much_greater(1.2, 1).data, "is not It is much larger."),
        ("claims", "same", equal(K * T, K + T).data, "is not They are the same."),
        ("claims", "none", refused(abs, 1).data, "is not There is none."),
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
        ("digits", "share", {"status": "unreproduced", "computed": "0.63", "because": "a"}, "the book is right"),
        ("digits", "wrong", {"status": "computed"}, "1.6049 is not 1.50"),
        ("digits", "wrong", {"correct": "1.7"}, "1.6049 is not 1.7"),
        ("curves", "first", {"within": "4 %"}, "not within 4 %"),
        ("curves", "first", {"assuming": "F = 2"}, "an assumption for this number alone"),
        ("formulas", "H", {"status": "corrected", "correct": "K", "because": "a"}, "the book is right"),
        ("claims", "grows", {"status": "unreproduced", "computed": "It falls.", "because": "a"}, "the book is right"),
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
        same_formula("K if T else s", "K")
    with pytest.raises(InvalidOperation):
        same_number("about 3", "3")


# ERRATA.md and the command that writes it.


def test_errata_is_what_the_command_writes():
    assert (ROOT / "ERRATA.md").read_text(encoding="utf-8") == errata.page(sources())
    assert (ROOT / "docs" / "damage.md").read_text(encoding="utf-8") == errata.damaged(sources())
    assert (ROOT / "docs" / "unreproduced.md").read_text(encoding="utf-8") == errata.unreproduced(sources())


def test_errata_names_every_error_of_the_books():
    pages = {"corrected": ROOT / "ERRATA.md"} | {
        status: ROOT / "docs" / f"{name}.md" for status, name in (("unreproduced",) * 2, ("damaged", "damage"))
    }
    texts = {status: page.read_text(encoding="utf-8") for status, page in pages.items()}
    for source, entries in books().items():
        for name, entry in entries.items():
            for row in entry.get("result", []):
                if row.get("status") not in texts:
                    continue
                claim = " ".join(row.get("claim", "").split())
                called = claim or f", {print_of(row)[0]}: "
                told = texts[row["status"]]
                line = next(line for line in told.splitlines() if f"**{name}" in line and called in line)
                stored = row.get("correct") or row.get("computed") or ("" if claim else "cannot be computed")
                because = " ".join(row["because"].split())
                assert all(part in line for part in (row.get("printed", claim), stored, because, entry["chapter"]))
            for slip in entry.get("misprint", []):
                told = texts["corrected"]
                line = next(line for line in told.splitlines() if f"**{name}" in line and slip["printed"] in line)
                assert all(" ".join(part.split()) in line for part in slip.values())
        assert source in sources()


def test_errata_lists_corrections_and_what_is_not_reproduced_and_nothing_else():
    content = """
[source]
title = "Author"
citation = "A. Author"
["Example 1"]
title = "An example"
chapter = "10_tuning"
result = [
    { name = "a", printed = "1", equation = "1.2", status = "corrected", correct = "2", because = "a slip" },
    { name = "b", printed = "3", status = "unreproduced", computed = "4", because = "nobody knows" },
    { name = "c", printed = "5", status = "reconstructed", assuming = "F = 1", within = "5 %" },
    { name = "d", printed = "6", status = "measured", because = "in the laboratory" },
    { name = "e", printed = "7" },
    { name = "f", printed = "8", status = "damaged", correct = "9", because = "a bracket is lost" },
    { name = "g", claim = "It falls.", status = "corrected", correct = "It grows.", because = "the sign" },
    { name = "h", printed = "8", status = "quoted", library = "loopbook.tuning.simc" },
]
misprint = [{ printed = "Section ??", correct = "Section 2", because = "a lost reference", place = "footnote" }]
damage = [{ printed = "k 1", correct = "k_1", because = "a lost index" }]
"""
    book = {"book": Source.read("book", content.encode())}
    told = errata.page(book)
    assert "A. Author" in told
    corrected, claim, misprint = [line for line in told.splitlines() if line.startswith("- ")]
    (unreproduced,) = [line for line in errata.unreproduced(book).splitlines() if line.startswith("- ")]
    assert all(part in corrected for part in ("Example 1", "1.2", ", a: ", "`1`", "`2`", "a slip", "10_tuning"))
    assert all(part in unreproduced for part in ("Example 1", ", b: ", "`3`", "`4`", "nobody knows", "10_tuning"))
    assert "claims: It falls. It should read: It grows. Reason: the sign." in claim
    assert "prints `Section ??` (footnote) for `Section 2`: a lost reference." in misprint
    damaged = [line for line in errata.damaged(book).splitlines() if line.startswith("- ")]
    assert len(damaged) == 2
    assert all(part in damaged[0] for part in (", f: ", "`8`", "`9`", "a bracket is lost"))
    assert "prints `k 1` for `k_1`: a lost index." in damaged[1]
    nothing = {"book": Source.read("book", content.partition("result")[0].encode())}
    assert errata.page(nothing) == errata.INTRODUCTION + "\n"
    assert errata.damaged(nothing) == errata.DAMAGE + "\n"
    assert errata.unreproduced(nothing) == errata.UNREPRODUCED + "\n"


def test_the_totals_add_up():
    for source, count in totals(sources()).items():
        expected = Counter(
            row.get("status", "computed") for entry in books()[source].values() for row in entry.get("result", [])
        )
        assert {status: number for status, number in count.items() if number} == expected


def test_the_command_prints_every_source_and_writes_errata(tmp_path):
    command = [sys.executable, "-m", "loopbook", "ledger"]
    environment = os.environ | {"PYTHONUTF8": "1"}
    done = subprocess.run(command, cwd=tmp_path, capture_output=True, encoding="utf-8", env=environment, check=False)
    assert (done.returncode, done.stderr) == (0, "")
    expected = totals(sources())
    head, *lines = [line.split() for line in done.stdout.splitlines() if line.split()]
    assert head == ["source", *STATUSES, "all"]
    numbers = {line[0]: [int(number) for number in line[1:]] for line in lines if line[-1].isdigit()}
    for source, count in expected.items():
        assert numbers[source] == [*count.values(), sum(count.values())]
    assert numbers["all"] == [sum(column) for column in zip(*(numbers[source] for source in expected), strict=True)]
    assert (tmp_path / "ERRATA.md").read_bytes() == (ROOT / "ERRATA.md").read_bytes().replace(b"\r\n", b"\n")


@pytest.mark.parametrize("content", ["[source", '[source]\ncitation = "A"\n["Example 1"]\ntitle = "A"\n'])
def test_the_command_refuses_a_malformed_source_in_one_line(tmp_path, monkeypatch, content):
    (tmp_path / "malformed.toml").write_text(content, encoding="utf-8")
    monkeypatch.setattr(loopbook.ledger, "_FOLDER", tmp_path)
    done = CliRunner().invoke(app, ["ledger", "--errata", str(tmp_path / "ERRATA.md")])
    assert done.exit_code == 1
    assert done.output.startswith("malformed")
    assert len(done.output.splitlines()) == 1
    assert not (tmp_path / "ERRATA.md").exists()
