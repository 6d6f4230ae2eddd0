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
REPORT = Source.open(EXAMPLE)["Example 2.1"].compare(Q=576, R=0.417, thicker=less(1, 2))


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


IMPORTS = code("from shelf import walls\nfrom bookledger import evidence\n"
               "from bookledger.evidence import every, greater, less, positive")  # fmt: skip
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
    rules.checks_are_computed: [
        ("not plain Python", with_code("%time example.check(Q=2)")),
        ("not computed", with_code("a, b = 2.04, 3\nexample.check(Q=a)")),
        ("not computed", with_code("example.check(Q=(a := 2.04))")),
        ("not computed", with_code("a: float = 2.04\nb = a\nexample.check(Q=-b)")),
        ("not computed", with_code("example.check(Q=sum([2.04]))")),
        ("not computed", with_code("for a in [2.04]:\n    example.check(Q=a)")),
        ("another name", with_code("judge = example.check\njudge(Q=2.04)")),
        ("2", with_code("example.check(2)")),
        ("-2.5", with_code("example.check(Q=-2.5)")),
        ("'stable'", with_code("example.check(wall='stable')")),
        ("True", with_code("example.check(stable=True)")),
        ("S(2)", with_code("example.check(Q=S(2))")),
        ("Rational(1, 2)", with_code("example.check(Q=Rational(1, 2))")),
        ("sympy.Float('0.5')", with_code("example.check(Q=-sympy.Float('0.5'))")),
        ("Integer(3)", with_code("walls['Example 3.1'].check(Q=Integer(3) / 2)")),
        ("[1, 2]", with_code("example.check(roots=[1, 2])")),
        ("oo", with_code("example.check(R=oo)")),
        ("'Q': 2", with_code("example.check(**{'Q': 2})")),
        ("flow", with_code("flow = 2", "example.check(Q=flow)")),
        ("itself", with_code("example.check(Q=example['Q'].printed)")),
        ("itself", with_code("example.check(Q=example.printed_value('Q'))")),
        ("itself", with_code("told = example.printed_value('Q')", "example.check(Q=told)")),
        ("itself", with_code("p = [example.printed_value('Q')]\nq = p[0]\nexample.check(Q=2 * q)")),
    ],
    rules.evidence_can_fail: [
        ("of literals", with_code("example.check(Q=Q, large=greater(2, 1))")),
        ("of literals", with_code("a, b = 2, 1", "greater(a, 3 * b)")),
        ("of literals", with_code("every(less(Q, R), greater(2, 1, 'width'))")),
        ("of literals", with_code("evidence.positive(3)")),
        ("of literals", with_code("pair = [2, 1]", "greater(*pair)")),
        ("of literals", with_code("greater(left=2, right=1)")),
        ("with itself", with_code("greater(Q, Q)")),
        ("with itself", with_code("again = Q", "evidence.equal(again, Q)")),
        ("with itself", with_code("greater(2 * Q + 1, 2*Q+1)")),
        ("with itself", with_code("greater(max(Q), min(Q))")),
        ("put in order", with_code("less(*sorted([Q, R]))")),
        ("made positive", with_code("positive(abs(Q))")),
        ("chooses", with_code("greater(Q, R) if Q > R else less(Q, R)")),
        ("turns", with_code("greater(Q, R).turned()")),
        ("another name", with_code("from bookledger.evidence import greater as more")),
        ("another name", with_code("from bookledger import evidence as judge")),
        ("another name", with_code("import bookledger.evidence as judge")),
        ("its making", with_code("from bookledger.evidence import Comparison")),
        ("its making", with_code("from bookledger.evidence.comparisons import greater")),
    ],
    rules.no_truth_value_becomes_a_word: [
        ("chooses", with_code('{1: "stable", 0: "not stable"}[Q < 2]')),
        ("chooses", with_code('word = Q < 2 and "stable" or "not stable"')),
        ("chooses", with_code('if Q < 2:\n    word = "stable"\nelse:\n    word = "not stable"')),
        ("chooses", with_code('("worse", "better")[Q < 2]')),
        ("into a word", with_code('word = "stable" if Q < 2 else "not stable"')),
        ("into a word", with_code('example.check(a=f"{x} more" if x else "less")')),
        ("words for", with_code('words = {True: "stable", False: "unstable"}')),
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
    rules.checks_are_computed: [
        with_code(
            "a, b = table.printed_value('a', 'b')",
            "larger = greater(a, table.printed_value('c'), 'heat flow [W]')",
            "claims.check(larger=larger, both=every({'a': greater(a, b, 'heat flow [W]')}))",
        ),
        with_code("count = 0", "count += roots", "example.check(order=count)"),
        with_code("example.check(Q=D / 2, H=k / (D*s + 1))"),
        with_code('exercise("1.1").check(a="setpoint", b=...)'),
    ],
    rules.evidence_can_fail: [
        with_code("greater(Q, 0)", "less(1, Q)", "positive(R)", 'greater(*pair, "angle [rad]")'),
        with_code("a = Q", "a = 2 * a", "greater(a, Q)"),
        stored(code("def greater(a, b): return a > b"), code("greater(2, 1)")),
    ],
    rules.no_truth_value_becomes_a_word: [
        with_code('label = name if name else "wall"', '("P", "PI")[-1]', "k if stable else 0", '{"a": 1, "b": 2}'),
        stored(code('word = "hot" if T > 300 else "cold"', tags=["nbval-ignore-output"])),
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
