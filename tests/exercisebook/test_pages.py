"""Exercises as pages: what is read, what follows from the formulas, and what is said of a page that is wrong."""

import itertools
import math
import re

import pytest

from exercisebook.judging import RIGHT, WRONG
from exercisebook.pages import page
from exercisebook.pages.columns import Columns
from exercisebook.pages.parts import PageError
from exercisebook.pages.slips import slips
from exercisebook.parameters import between

PAGE = """\
# 1 How long? (2 points)

An empty tank with the cross-section {A} is filled with {q}, at {side}. When is the level {h}?

## Given
| name | values | unit | example |
|---|---|---|---|
| A | 0.5 … 3 by 0.5 | m² | 1 |
| h | 1 … 4 by 0.5 | m | 2 |
| q | 2 … 9 by 1 | L/s | 4 |
| side | left, right | | |

## Formulas
```
where h/A < 5
V     = A*h                 [m³]  # what it holds
share = 1/4
late  = V/q                 [min]
half  = share*2*late
    + 0*late                [min]
where half > 1/10
```

## Asked
- `V` the volume
- `late` the time until then `number(within=0.02)`
- `half` half of it

## Mistakes
- `V = A` The height is missing.
- `share = 1/2` Half of a half is a quarter.
- `late = V/q` That is in other units:
  look at the litre.
- `A = h; h = 2*A` The two are interchanged.

## Hints
1. One.
2. Two, {V}.

## Solution
It holds {V}, and $V = {V}$.

***

It takes {late}.

## Insight
A level is an integral.

## Check
```
late = 2*half
V/q == late
half < late
```
"""


def made(text=PAGE, **functions):
    (one,) = page.of(text, "tank.md", functions)[1].values()
    return one


@pytest.fixture(scope="module")
def question():
    return made().question()


def test_a_page_is_an_exercise(question):
    exercise = question.exercise
    assert exercise.heading == "Exercise 1 · How long?"
    assert exercise.points == 2
    assert exercise.parameters["q"] == between(2, 9, "L/s", reference=4, step=1)
    assert exercise.parameters["side"].values == ("left", "right")
    assert "with 4\xa0L/s, at left." in question.statement.body
    assert question.rungs == ["One.", "Two, 2\xa0m³.", "It holds 2\xa0m³, and $V = 2$.\n\nThe rest is yours."]
    assert "It takes 8.333\xa0min" in question.solved().text
    assert exercise.insight == "A level is an integral."


def test_units_convert_by_themselves(question):
    key = question.key
    assert {name: (kind.key, kind.unit) for name, kind in key.items()} == {
        "V": (2, "m³"),
        "late": (pytest.approx(2 * 1000 / 4 / 60), "min"),
        "half": (pytest.approx(2 * 1000 / 4 / 60 / 2), "min"),
    }
    assert key["late"].within == 0.02
    assert (key["late"].what, key["V"].what) == ("the time until then", "the volume")


@pytest.mark.parametrize(
    ("formula", "value"),
    [
        ("h/m  [%]", 200),
        ("part*V  [L]", 2000 * 5 / 100),
        ("V**(2/3)  [m²]", 2 ** (2 / 3)),
        ("h//m", 2),
    ],
)
def test_units_of_powers_parts_and_quotients(formula, value):
    page_ = made(PAGE.replace("share = 1/4", f"m = 1  [m]\npart = 5  [%]\nmore = {formula}\nshare = 1/4"))
    assert float(page_.quantities(page_.question().values)["more"]) == pytest.approx(value)


def test_what_follows_from_a_mistake_follows_and_comes_after_those_of_the_quantity_itself(question):
    late = question.mistakes["late"]
    assert [says for says, _ in late] == [
        "That is in other units: look at the litre.",
        "The two are interchanged.",
        "The height is missing.",
    ]
    assert [float(value) for _, value in late] == pytest.approx([0.5, 2 * 2 * 1000 / 4 / 60, 1000 / 4 / 60])
    assert ("Half of a half is a quarter.", pytest.approx(2 * 1000 / 4 / 60)) in question.mistakes["half"]
    assert "The height is missing." in [says for says, _ in question.mistakes["half"]]


def test_what_follows_from_slips_in_many_variants_at_once_is_what_follows_in_each():
    text = PAGE.replace("late  = V/q ", "f = 2 if side == 'left' else 3\nlate  = other(V)*f/q ")
    one = made(text, other=lambda V: V if V > 0 else [])
    variants = [one.question(f"s{k}").values for k in range(5)]
    columns = Columns(one, variants)
    assert columns.numbers == ["A", "h", "q", "V", "share", "f", "late", "half"]
    for slip in itertools.islice(slips(one, "half", columns.numbers), 0, None, 150):
        for values, found in zip(variants, columns.by(slip, "half"), strict=True):
            try:
                follows = one.following(values, slip, "half").key
            except ValueError:
                follows = math.nan
            assert found == pytest.approx(follows, rel=1e-9, nan_ok=True), slip


def test_a_variant_in_which_a_mistake_is_right_is_not_drawn():
    near = made(PAGE.replace("`V = A` The height", "`V = A*h + (h - 2)/300` The height"))
    assert {near.question(f"student {n}").values["h"] for n in range(20)} == {2}  # where it changes nothing
    with pytest.raises(ValueError, match=r"in 902 of them the mistake 'V = 1.001.V' would be right"):
        made(PAGE.replace("`V = A` The height", "`V = 1.001*V` The height")).question("Ada")


def test_a_change_that_changes_nothing_is_no_mistake():
    same = made(PAGE.replace("| A | 0.5 … 3 by 0.5 | m² | 1 |", "| A | 0.5 … 3 by 0.5 | m² | 2 |")).question()
    assert "The two are interchanged." in [says for says, _ in same.mistakes["V"]]  # 2 and twice 2
    equal = made(PAGE.replace("h = 2*A", "h = A").replace("| m² | 1 |", "| m² | 2 |")).question()
    assert "The two are interchanged." not in [says for says, _ in equal.mistakes["V"]]


def test_two_quantities_with_formulas_may_be_interchanged():
    swapped = made(PAGE.replace("`A = h; h = 2*A`", "`V = share; share = V`")).question()
    found = {name: [float(value) for says, value in swapped.mistakes[name] if "two" in says] for name in swapped.key}
    assert found == {"V": [0.25], "late": [pytest.approx(0.25 * 1000 / 4 / 60)], "half": []}  # which has both in it


def test_what_has_no_value_after_a_mistake_breaks_none_where_nothing_asked_needs_it():
    shown = made(PAGE.replace("share = 1/4", "share = 1/4\nrest = log(1 - 2*share)").replace("One.", "One, {rest}."))
    assert "Half of a half is a quarter." in [says for says, _ in shown.question().mistakes["half"]]


def test_answers_are_judged(question):
    assert [one.status for one in question.check(V="2 m³", late="500 s", half=5).verdicts] == [RIGHT, RIGHT, WRONG]
    assert "The height is missing." in question.check(V=1).verdicts[0].says


def test_conditions_may_use_formulas():
    exercise = made()
    assert all(exercise.question(f"s{number}").key["half"].key > 0.1 for number in range(40))
    with pytest.raises(ValueError, match="in 894 of them 'where half > 1000' does not hold"):
        made(PAGE.replace("half > 1/10", "half > 1000")).question("s1")


def test_the_second_way_is_tried():
    exercise = made()
    found = {text: holds for text, holds, _ in exercise.second_ways(exercise.question("s1").values)}
    assert found == {"late = 2*half": True, "V/q == late": True, "half < late": True}
    wrong = made(PAGE.replace("late = 2*half", "late = 3*half"))
    assert next(iter(wrong.second_ways(wrong.question().values))) == ("late = 3*half", False, "8.33333, not 12.5")


def test_python_beside_a_page_is_called_by_its_name():
    exercise = made(PAGE.replace("share*2*late", "halved(late)"), halved=lambda value: value / 2)
    assert exercise.question().key["half"].key == pytest.approx(25 / 6)


@pytest.mark.parametrize(
    ("old", "new", "line", "says"),
    [
        ("# 1 How long? (2 points)", "# How long?", 1, "the heading is 'How long?': expected number, title and points"),
        ("## Insight", "## Insights", 47, "there is no section 'Insights': did you mean 'Insight'?"),
        ("| q | 2 … 9 by 1 | L/s | 4 |", "| q | 2 … 9 by 1 | apples | 4 |", 10, "'apples' is not a unit"),
        ("| q | 2 … 9 by 1 | L/s | 4 |", "| q | 9 … 2 | L/s | 4 |", 10, "the range is 9 to 2"),
        ("V/q                 [min]", "V/Q                 [min]", 18, "V/Q: there is no 'Q': did you mean 'q'?"),
        ("A*h                 [m³]", "A*h                 [s]", 16, "meter^3 is not a unit of the same"),
        ("A*h                 [m³]", "A + h                 [m³]", 16, "meter is not a unit of the same"),
        ("A*h                 [m³]", "A*h.__class__                 [m³]", 16, "'__class__' is no name of a quantity"),
        ("A*h                 [m³]", "[x for x in A]                 [m³]", 16, "is nothing that a formula may say"),
        ("A*h                 [m³]", "open(A)                 [m³]", 16, "there is no function 'open'"),
        ("share = 1/4", "V = 1/4", 17, "V is there already: expected another name for this quantity"),
        ("share = 1/4", "share 1/4", 17, "'share 1/4' is no formula: expected one such as"),
        ("- `V` the volume", "- the volume", 25, "names no quantity"),
        ("- `V` the volume", "- `W` the volume", 25, "W has no formula"),
        ("`number(within=0.02)`", "`numbr(within=0.02)`", 26, "there is no function 'numbr': did you mean 'number'?"),
        ("- `V = A` The height", "- `W = A` The height", 30, "'W' is no quantity of this page: expected one of A, h"),
        ("- `V = A` The height is missing.", "- `V = A`", 30, "is no mistake: expected a change and a sentence"),
        ("- `V = A` The height is missing.", "- The height is missing.", 30, "is no mistake"),
        ("2. Two, {V}.", r"2. Two, $\frac{1}{V}$.", 38, "{V}: write {{V}} for the letter, or { {V} } for its value"),
        ("2. Two, {V}.", r"2. Two, $t_{V}$.", 38, "_{V}: write {{V}} for the letter"),
        ("V/q                 [min]", "V**q                [min]", 18, "a unit to a power that is no number"),
        ("V/q                 [min]", "V^2                 [min]", 18, "^ is no power: expected **"),
        ("V/q                 [min]", "V q                 [min]", 18, "every product needs a *"),
        ("V/q                 [min]", "V/q [min]", 18, "has one space before the unit: expected two"),
        ("V/q                 [min]", "V/\n  q)              [min]", 18, "(with line 19, which is indented)"),
        ("share = 1/4", "share = 0,25", 17, "there is a comma: expected a decimal point"),
        ("q | 2 … 9 by 1", "q | 2 - 9 by 1", 10, "is no range: expected one as '50 … 400 by 10'"),
        ("with the cross-section {A}", "with the cross-section {AA}", 3, "there is no 'AA': did you mean 'A'?"),
        ("It takes {late}.", "It takes {lat}.", 45, "there is no 'lat': did you mean 'late'?"),
        ("$V = {V}$", "$V = {V}", 41, "a $ in this section has no other one"),
        ("## Asked\n- `V` the volume", "- `V` the volume", 1, "exercise 1 has no section Asked"),
    ],
)  # fmt: skip
def test_what_is_wrong_in_a_page_is_said_with_its_line(old, new, line, says):
    assert PAGE.count(old) == 1
    with pytest.raises(PageError, match=rf"^tank\.md:{line}: .*{re.escape(says)}"):
        made(PAGE.replace(old, new))


def test_several_pages_have_a_front():
    front, found = page.of(
        f'# Tanks\n\nTwo of them.\n\n```toml\nsecret = "x"\n```\n\n{PAGE}\n{PAGE.replace("# 1 How", "# 2 How")}',
        "tanks.md",
    )
    assert (front.title, front.introduction, front.settings) == ("Tanks", "Two of them.", {"secret": "x"})
    assert [*found] == ["1", "2"]
    with pytest.raises(PageError, match="there are two exercises 1: expected one"):
        page.of(PAGE + "\n" + PAGE, "tanks.md")
