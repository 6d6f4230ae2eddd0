"""The rules for notebooks that check a ledger: each accepts a good notebook, and finds what it is there for."""

from pathlib import Path

from nbformat import v4, writes

from bookledger import EXAMPLE, Source, rules
from bookledger.books import Books, entries
from bookledger.evidence import less
from bookledger.report import MIME_TYPE
from bookledger.stored import Stored

NUMBERS = {
    "chapter": "02_conduction",
    "given": {"k": "1", "D": "1 K", "d": "0.5 m", "area": "2e-3 m^2", "power": "1500 W"},
    "result": [
        {"name": "level", "printed": "-6.45", "unit": "m"},
        {"name": "y", "printed": "7*exp(-4*t) + K1*t**3 + Derivative(y(t), (t, 3))"},
        {"name": "model", "printed": "Example 5.1"},
    ],
}
BOOKS = Books({"walls": entries(EXAMPLE.read_text(encoding="utf-8")) | {"Example 3.1": NUMBERS}})
REPORT = Source.open(EXAMPLE)["Example 2.1"].compare(Q=576, R=0.417, thicker=less(1, 2, "heat flow [W]"))


def code(source, *outputs, **metadata):
    return v4.new_code_cell(source, outputs=list(outputs), metadata=metadata)


def checked(**changes):
    """The output of a check of the example of the book, with changes in its data."""
    data = REPORT._repr_mimebundle_()[MIME_TYPE] | {"source": "walls"} | changes
    return v4.new_output("display_data", data={MIME_TYPE: data})


def row(**changes):
    """The same with changes in its first verdict."""
    first, *others = REPORT.data["verdicts"]
    return checked(verdicts=[first | changes, *others])


IMPORTS = code("from shelf import walls")
GIVENS = code('example = walls["Example 3.1"]\nk, D, d = example.given("k", "D", "d")')
CHECK = code("example.check(Q=wall.Q, R=D + d)", checked())
GOOD = [IMPORTS, v4.new_markdown_cell("## Example 3.1 · a wall"), GIVENS, CHECK]


def stored(*cells, name="02_conduction"):
    notebook = v4.new_notebook(cells=list(cells))
    return Stored(Path(f"{name}.ipynb"), writes(notebook), notebook)


def with_code(*sources):
    """The good notebook with more cells in the section of its example."""
    return stored(*GOOD, *map(code, sources))


BROKEN = {
    rules.checks_are_of_the_ledger: [
        ("no such entry", stored(code("", checked(entry="Example 99")))),
        ("no such entry", stored(code("", checked(source="nobody")))),
        ("belongs to 02_conduction", stored(*GOOD, name="03_radiation")),
        ("does not hold", stored(code("", row(holds=False)))),
        ("does not hold", stored(code("", row(holds="yes")))),
        *(
            ("not the results of the ledger", stored(code("", row(**change))))
            for change in ({"book": "7"}, {"title": "another"}, {"status": "measured"}, {"name": "other"})
        ),
        ("not the results of the ledger", stored(code("", checked(verdicts=REPORT.data["verdicts"][:-1])))),
        ("not the results of the ledger", stored(code("", checked(verdicts=REPORT.data["verdicts"] * 2)))),
    ],
    rules.nothing_is_handed_back: [
        ("not computed", with_code("a, b = 2.04, 3\nexample.check(Q=a)")),
        ("not computed", with_code("flow = 2", "example.check(Q=flow)")),
        ("-2.5", with_code("example.check(Q=-2.5)")),
        ("'stable'", with_code("example.check(wall='stable')")),
        ("True", with_code("example.check(stable=True)")),
        ("S(2)", with_code("example.check(Q=S(2))")),
        ("Rational(1, 2)", with_code("example.check(Q=Rational(1, 2))")),
        ("Integer(3)", with_code("walls['Example 3.1'].check(Q=Integer(3) / 2)")),
        ("[1, 2]", with_code("example.check(roots=[1, 2])")),
        ("2 in a check", with_code("example.check(**{'Q': 2})")),
        ("k in a check", with_code("example.check(Q=k)")),
        ("given('k')", with_code("example.check(Q=example.given('k'))")),
    ],
    rules.no_number_of_the_book: [
        ("0.5 stands in walls Example 3.1", with_code("wall = Wall(depth=0.5)")),
        ("0.5", with_code("wall = Wall(depth=1/2)")),
        ("0.5", with_code("wall = Wall(depth=Rational(1, 2))")),
        ("0.5", with_code("wall = Wall(depth=S('0.5'))")),
        ("-6.45", with_code("level = -6.45")),
        ("1500", with_code("power = 1.5e3")),
        ("0.002", with_code("area = 0.002")),
        ("7", with_code("response = 7 * exp(-t)")),
        ("4", with_code("response = exp(-4 * t)")),
        ("0.5", stored(code('book = Source.open("shelf/walls.toml")\nbook["Example 3.1"]\nWall(0.5)'))),
    ],
}
ACCEPTED = {
    rules.checks_are_of_the_ledger: [stored(code("", checked(), checked()))],
    rules.nothing_is_handed_back: [
        with_code("count = 0", "count += roots", "example.check(order=count)"),
        with_code("example.check(Q=D / 2, H=k / (D*s + 1), **{'R': f'{d} m'})"),
        with_code('exercise("1.1").check(a="setpoint", b=...)'),
    ],
    rules.no_number_of_the_book: [
        with_code("area = 2 * x**4 + roots[7] + y(t).diff(t, 4)"),
        with_code("3 * x", "5.1 * x"),
        stored(*GOOD, v4.new_markdown_cell("## Another section"), code("Wall(depth=0.5)")),
        stored(code("Wall(depth=0.5)")),
    ],
}


def test_a_good_notebook_is_accepted():
    assert [complaint for rule in rules.RULES for complaint in rule(stored(*GOOD), BOOKS)] == []


def test_what_looks_alike_is_accepted(subtests):
    for rule, notebooks in ACCEPTED.items():
        for notebook in notebooks:
            with subtests.test(rule=rule.__name__):
                assert rule(notebook, BOOKS) == []


def test_a_broken_notebook_is_refused(subtests):
    for rule, cases in BROKEN.items():
        for words, notebook in cases:
            with subtests.test(rule=rule.__name__, words=words):
                found = rule(notebook, BOOKS)
                assert any(words in complaint for complaint in found), found


def test_each_rule_has_been_seen_to_refuse_and_to_accept():
    assert {*BROKEN} == {*ACCEPTED} == {*rules.RULES}
