"""The diagnoses of wrong answers: each mistake has its own sentence, and none tells the key."""

import numpy as np
import pytest
import sympy

from exercisebook.authoring import (
    answers,
    between,
    choice,
    exercise,
    expression,
    number,
    numbers,
    poles,
    time_function,
    word,
    words,
)
from exercisebook.diagnoses import Background, explained
from exercisebook.diagnoses.background import Amount
from exercisebook.diagnoses.numbers import Case, found_in, in_general
from exercisebook.judging import MISTAKE, WRONG, judge
from exercisebook.pages import page
from plainmath.expressions import t

# An exercise with everything in it.


@exercise("1.1", title="A tank", points=1)
def tank(
    K=between(1, 9, "K/%", reference=3),
    T=between(10, 90, "s", reference=40),
    tau=between(1, 20, "s", reference=8),
    action=choice("filled", "emptied"),
    noise=between(1, 999, step=1),
):
    """A tank that is {action} with {K}, {T}, {tau}."""
    sign = 1 if action == "filled" else -1
    return answers(
        a=number(sign * T / (K * (2 * tau)), "%/K", "the slope"),
        b=number(sympy.Min(T, 8 * tau), "s", "the pause"),
        rise=number(T * sympy.log(2) + tau, "s", "the time to one half"),
        phase=number(65, "deg", "the angle"),
        h=time_function(K * (1 - sympy.exp(-t / T)), until=200, unit="K"),
        way=word("up" if action == "filled" else "down", ["up", "down", "nowhere"], "the way"),
    )


@pytest.mark.parametrize(
    ("given", "says"),
    [
        ({"a": -2.5 / 3}, "the size is right, the sign is not"),
        ({"a": 1.2}, "that is the inverse"),
        ({"a": -33.33}, "as large as the 40\xa0s: is that missing"),
        ({"a": 1.667}, "it is off by a factor of 2"),
        ({"b": 8}, "that is the same number as the 8\xa0s of the question"),
        ({"b": 0.667}, "that would be the value in min"),
        ({"rise": 27.73}, "that is what comes out without the 8\xa0s"),
        ({"rise": 45.55}, "that is what comes out with 40\xa0s and 8\xa0s interchanged"),
        ({"rise": 40}, "another quantity that is asked for: have you interchanged the two?"),
        ({"rise": 40, "b": 35.7}, "this and the pause, `b`, are interchanged"),
        ({"phase": 25}, "that is what is missing to a right angle"),
        ({"phase": 115}, "that is what is missing to half a turn"),
        ({"phase": 1.134}, "that would be the value in rad"),
        ({"h": "3*(1 - exp(-t/35))"}, "its initial value and final value are right, but its initial slope is not"),
        ({"h": "3*exp(-t/40)"}, "its initial value and final value are not right"),
        ({"h": "1 - exp(-t/40)"}, "without the 3\xa0K/%"),
        ({"way": "down"}, "that would be right for 'emptied' in place of 'filled'"),
    ],
)
def test_responses(given, says):
    assert says in repr(tank.question().check(**given))


def test_what_the_statement_does_not_show_is_no_given():
    question = tank.question()
    assert "noise" not in question.background.parameters
    assert {"K", "T", "tau", "action"} == question.background.parameters.keys()


WITHOUT_GIVENS = [
    (number(0.6667, "s", "the time"), 0.7, WRONG, "rounded to 1 digit, but the accuracy asked for"),
    (number(25, "%", "the share"), 20, WRONG, "not right, though of about the right size"),
    (number(-0.08, "K", "the lowest value"), -0.6, WRONG, "too large in size"),
    (number(17.97, "s", "the time"), 18.5, WRONG, "more than the rounding of a result"),
    (number(17.97, "s", "the time"), 3, WRONG, "too small"),
    (number(17.97, "s", "the time"), 9000, WRONG, "much too large"),
    (number(17.97, "s", "the time"), -3, WRONG, "the sign is not, nor is the size"),
    (number(7, "", "the number of states"), 9, WRONG, "not right"),
    (number(4, "", "the ratio"), 12.04, MISTAKE, "in dB"),
    (numbers([1, 2, 3], what="A"), [2, 1, 3], MISTAKE, "in another order"),
    (numbers([1, 2, 3], what="A"), [1, 2, 7.7], WRONG, "look at the third number"),
    (poles([-1 + 2j, -1 - 2j]), [-1 + 2j], MISTAKE, "its mirror image is missing"),
    (poles([-1, -1, -2]), [-1, -2], MISTAKE, "one of them counts several times"),
    (poles([-0.2]), 0.2, MISTAKE, "the size is right, the sign is not"),
    (poles([-1, -2]), [-1], WRONG, "what is there is right, but something is missing"),
    (poles([-1, -2]), [1], MISTAKE, "one has the wrong sign"),
    (poles([-1, -2]), [-1, -2, -3], WRONG, "all that are asked for are there, but also more"),
    (poles([-4, -2]), [-0.25, -2], MISTAKE, "1 of 2 is right; one is the inverse"),
    (expression("a/(b + c)"), "a/(b - c)", MISTAKE, "one sign is wrong: look at the term with c"),
    (expression("90*K_c/(260*s + 1 + 90*K_c)"), "7.2/(260*s+8.2)", MISTAKE, "right if K_c is 0.08: leave K_c"),
    (expression("a*b/(a + c)"), "-3*b/(c - 3)", MISTAKE, "that is right if a is -3"),
    (expression("a/(b + c)"), "a/b", MISTAKE, "a term is missing: look for one with c"),
    (expression("a/(b + c)"), "a*(b + c)", MISTAKE, "b and c multiplies where it should divide"),
    (expression("a/(b + c)"), "b/(a + c)", MISTAKE, "a and b are interchanged"),
    (expression("a**2/(b + c)"), "a/(b + c)", MISTAKE, "a power is wrong: look at the part with a"),
    (expression("a*b/(a + c)"), "5*a*b/(a + c)", MISTAKE, "right but for a constant factor"),
    (expression("a*b/(a + c)"), "-60*a*b/(a + c)", MISTAKE, "a constant factor of 60 and the sign"),
    (expression("a*b*c/(c + d)"), "a*b*(c**2 + 7*d)", WRONG, "it depends on a and b in the right way"),
    (expression("a*b*sqrt(c + d)"), "a**3 + b + d", WRONG, "it does not depend on c, but it should"),
    (expression("4*T**2*(a + b)/(T + a + b)**2"), "4*T*(a + b)/(T + a + b)", WRONG, "right for a very large T"),
    (words(["S2", "S4"], ["S1", "S2", "S3", "S4"]), "S2, S1", WRONG, "S2 belongs there, S1 does not"),
    (words(["S2", "S4"], ["S1", "S2", "S3", "S4"]), "S1", WRONG, "none of them belongs there"),
    (words("ABC", "ABCD", ordered=True), "A, C, B", WRONG, "their order is not: it is right up to A"),
    (words("ABC", "ABCD", ordered=True), "B, A, C", WRONG, "look at what comes first"),
]


@pytest.mark.parametrize(("kind", "given", "status", "says"), WITHOUT_GIVENS)
def test_responses_without_givens(kind, given, status, says):
    verdict = judge("x", kind, given)
    assert verdict.status == status, verdict
    assert says in verdict.says, verdict


@pytest.mark.parametrize(
    ("kind", "given", "is_bare"),
    [
        (number(17.97, "s"), 41.3, True),
        (number(17.97, "s"), -17.97, False),
        (number(17.97, "s"), 18.5, False),
        (expression("a*b + c"), "a**3 + b**3 - 7*c**2", True),
        (word("up", ["up", "down"]), "down", True),
    ],
)
def test_a_verdict_says_whether_it_is_bare(kind, given, is_bare):
    assert judge("x", kind, given).is_bare == is_bare


def test_a_formula_that_is_not_right_is_shown_as_it_was_read():
    kind = expression("2/(3*s + 1)")
    assert judge("H", kind, "2/(3s - 1)").says.endswith(" · read as 2/(3*s - 1)")
    assert judge("H", kind, "2/(3s + 1)").says.startswith("right")
    assert "read as" not in judge("K", number(2), 3).says


def test_a_key_that_never_ends_for_other_givens_is_given_up():
    def following(changes, name):
        while True:
            pass

    background = Background(answers(x=number(7, "s", "the time")), {"n": 7}, {"n": between(1, 9, "s")}, following)
    assert explained(number(7, "s"), 3.3, background.of("x", {})).is_bare  # and it comes to an end


def test_sizes_do_not_narrow_the_key_down_by_asking_again():
    """What is said of a size is the same for all keys between two powers of two."""

    def said(key):
        far = [x for x in np.geomspace(1e-3, 1e3, 200) if abs(x / key - 1) > 0.6]
        return {float(x): in_general(float(f"{x:.6g}"), Case(key, "s", "x")).says for x in far}

    one, other = said(4.1), said(7.9)
    assert all(one[x] == other[x] for x in one.keys() & other.keys())


def test_a_given_explains_a_factor_better_than_units_do():
    case = Case(2.4, "%", "the term, in %", givens=[Amount(60, "s", "60 s")])
    assert "as large as the 60 s" in found_in(0.04, case).says
    assert "seconds and minutes" in found_in(0.04, Case(2.4, "%", "the term, in %")).says


def test_amounts_read_well():
    case = Case(24, "s", "the time, in s", givens=[Amount(6.15, "s", "6.15 s"), Amount(5, "%", "5 %")])
    says = "it is off by a factor as large as the 6.15 s: is that missing, or in it once too often?"
    assert found_in(147.6, case).says == says


# What a wrong number has to do with other wrong and right ones.


SWING = page.of(
    """\
# 1.2 A swing (1 point)

A height of {height} makes {way} at {first} and {last}.

## Given
| name | values | unit | example |
|---|---|---|---|
| way | 1 … 9 | K | 2.5 |
| height | 5 … 20 | % | 12 |
| first | 10 … 90 | s | 54 |
| last | 20 … 200 | s | 135 |

## Formulas
```
u = 4*height/(pi*way)  [%/K]
a = 0.6*u  [%/K]
T = 3/2*(last - first)  [s]
tau = first - T/3  [s]
P = 8/3*T  [s]
roots = [-3, -5]
zeros = [5]
```

## Asked
- `u` the largest slope
- `a` the slope
- `T` the time constant
- `tau` the delay
- `P` the period
- `roots` the poles `poles()`
- `zeros` the zeros `poles()`
""",
    "swing.md",
)[1]["1.2"]


FITS = "this is right for what you have for"
TOGETHER = [
    ({"u": 3.38, "a": 2.03}, "u", "not right"),
    ({"u": 3.38, "a": 2.03}, "a", f"{FITS} the largest slope, `u`"),
    ({"T": 135, "tau": 9}, "tau", f"{FITS} the time constant, `T`"),  # neither by a factor nor by a difference
    ({"u": 3.38, "tau": 20}, "tau", "not right: too large; asked: the delay, in s"),
    ({"T": 135, "P": 333}, "P", "What you have for the time constant, `T`, is not right either"),
    ({"u": 6.112, "a": 6.112}, "a", "that is the largest slope, `u`, itself: asked here is the slope"),
    ({"u": 3.667, "a": 6.112}, "a", "this and the largest slope, `u`, are interchanged"),
    ({"u": 0.265}, "u", "with the numbers of 2.5\xa0K and 12\xa0% interchanged"),
    ({"P": 0.01939}, "P", "an angular frequency instead of a period"),
    ({"roots": [5], "zeros": [-3, -5]}, "roots", "this and the zeros, `zeros`, are interchanged"),
    ({"roots": [5]}, "roots", "have you interchanged the two?"),
    ({"roots": [-3, -5], "zeros": [-3, -5]}, "zeros", "that is the poles, `roots`, itself"),
]


@pytest.mark.parametrize(("given", "name", "says"), TOGETHER)
def test_numbers_that_belong_together(given, name, says):
    said = {one.name: one.says for one in SWING.question().check(**given).verdicts}
    assert says in said[name], said
    first = next(iter(given))
    assert FITS not in said[first]


@exercise("1.3", title="A cup", points=1)
def cup(K=between(1, 9, reference=3), T=between(10, 90, "s", reference=40), H=between(0.1, 0.9, reference=0.4)):
    """A cup of {K}, {T} and {H}."""
    return answers(
        share=number(K / (1 + K * H), "", "the share"),
        y=time_function(K * (1 - sympy.exp(-t / T)), until=200, unit="K"),
        end=number(K, "K", "the end"),
        M=expression("K/(1 + K*H)"),
    )


@pytest.mark.parametrize(
    ("given", "name"),
    [
        ({"y": "7.2*(1 - exp(-t/40))", "end": 7.2}, "end"),
        ({"M": "K/(1 + K + H)", "share": 0.682}, "share"),
    ],
)
def test_a_number_may_belong_to_a_wrong_formula(given, name):
    said = {one.name: one.says for one in cup.question().check(**given).verdicts}
    assert FITS in said[name], said


def test_a_small_number_is_not_nothing():
    mistakes = [("without a jump", 0)]
    kind = number(15.68, "mV", "the jump")
    assert judge("y", kind, 0, mistakes).says == "without a jump"
    assert "without a jump" not in judge("y", kind, 0.01568, mistakes).says


def test_of_two_mistakes_the_nearest_one_is_named():
    mistakes = [("the wind", 1785), ("the friction", 1770)]
    assert judge("F", number(1900, "N", within=0.05), 1770, mistakes).says == "the friction"


def test_what_is_exact_has_exact_mistakes():
    kind = number(123, "", "the number of the loop", 0)
    assert judge("loop", kind, 124, [("the next one", 124)]).says == "the next one"
    assert judge("loop", number(120, "", "the number", 0), 123, [("the next one", 124)]).status == WRONG


def test_a_function_that_grows_is_no_mistake_of_others():
    kind = time_function("exp(-t)", until=30)
    assert judge("y", kind, "1", [("it grows", "exp(9*t/5)")]).says != "it grows"


@pytest.mark.parametrize(("answer", "is_named"), [(5, False), (30, False), (0.628, True)])
def test_round_numbers_are_no_coincidence_of_givens(answer, is_named):
    case = Case(11.3, "", "the ratio", givens=[Amount(18, "s", "18 s"), Amount(7, "K", "7 K"), Amount(90, "m", "90 m")])
    assert bool(found_in(answer, case)) == is_named


def test_a_plain_slip_is_seen_in_a_value_that_is_read_off():
    kind = number(1.447, "mm/s", "the rate", 0.15)
    assert judge("rate", kind, -1.3).says == "the size is right, the sign is not"
    assert "in m/s" in judge("rate", kind, 0.0014).says


def test_a_count_is_nothing_of_the_givens_by_chance():
    case = Case(3, "", "the number of poles", givens=[Amount(6, "s", "6 s"), Amount(2, "s", "2 s")])
    assert found_in(6, case) is None


def test_a_formula_with_another_sign_is_not_right_at_a_limit():
    kind = expression("(F - 20*v - 6*y)/10")
    assert "for a very small F" not in judge("a", kind, "(F + 20*v + 6*y)/10").says


def test_a_unit_that_was_given_is_the_one_that_is_wrong():
    says = judge("Ti", number(18, "min", "the pause"), "18 s").says
    assert says == "the number is right, but in min: you have given it in s"
