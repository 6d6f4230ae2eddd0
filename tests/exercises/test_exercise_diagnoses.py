"""The diagnoses of wrong answers: each mistake has its own sentence, and hardly any number is taken for a mistake."""

import contextlib
import itertools
import math
import random
import re

import numpy as np
import pytest
import sympy

from draws import STUDENTS, THOROUGH, of_the_day
from exercisebook.diagnoses import Background, explained
from exercisebook.diagnoses import numbers as in_numbers
from exercisebook.diagnoses.background import Amount
from exercisebook.diagnoses.numbers import FACTORS, GIVENS, MORE, TABLE, Case, found_in, in_general, is_recognised
from exercisebook.judging import MISTAKE, WRONG, judge
from exercisebook.reading import Unreadable
from loopbook import s
from loopbook.exercises import bank
from loopbook.exercises.authoring import (
    answers,
    between,
    choice,
    exercise,
    expression,
    number,
    numbers,
    poles,
    settings,
    time_function,
    transfer_function,
    word,
    words,
)
from loopbook.exercises.kinds import Expression, Number
from loopbook.pid import PID

# An exercise with everything in it.


@exercise("1.1", title="A tank", points=1)
def tank(
    K=between(1, 9, "K/%", reference=3),
    T=between(10, 90, "s", reference=40),
    tau=between(1, 20, "s", reference=8),
    action=choice("heating", "cooling"),
    noise=between(1, 999, step=1),
):
    """A {action} tank with {K}, {T}, {tau}."""
    sign = 1 if action == "heating" else -1
    return answers(
        Kp=number(sign * T / (K * (2 * tau)), "%/K", "the gain"),
        Ti=number(sympy.Min(T, 8 * tau), "s", "the integral time"),
        rise=number(T * sympy.log(2) + tau, "s", "the time to one half"),
        phase=number(65, "deg", "the phase margin"),
        pid=settings(PID(T / (2 * K * tau), T), "%/K", "s", "the settings"),
        H=transfer_function(K * sympy.exp(-tau * s) / (T * s + 1)),
        h=time_function(K * (1 - sympy.exp(-sympy.Symbol("t") / T)), until=200, unit="K"),
        way=word("up" if action == "heating" else "down", ["up", "down", "nowhere"], "the way"),
    )


RESPONSES = [
    ({"Kp": -2.5 / 3}, "the size is right, the sign is not"),
    ({"Kp": 1.2}, "that is the inverse"),
    ({"Kp": 2.5}, "as large as the 3\xa0K/%: is that missing"),
    ({"Kp": 1.667}, "it is off by a factor of 2"),
    ({"Ti": 8}, "that is the same number as the 8\xa0s of the question"),
    ({"Ti": 0.667}, "that would be the value in min"),
    ({"rise": 27.73}, "that is what comes out without the 8\xa0s"),
    ({"rise": 45.55}, "that is what comes out with 40\xa0s and 8\xa0s interchanged"),
    ({"rise": 40}, "another quantity that is asked for: have you interchanged the two?"),
    ({"rise": 40, "Ti": 35.7}, "this and the integral time, `Ti`, are interchanged"),
    ({"phase": 25}, "that is what is missing to a right angle"),
    ({"phase": 115}, "that is what is missing to half a turn"),
    ({"phase": 1.134}, "that would be the value in rad"),
    ({"Ti": 20.5, "Kp": 0.4271}, "this fits what you have for"),
    ({"pid": [2.5, 40]}, "Ti is right; that is what comes out without the 3\xa0K/%"),
    ({"pid": [0.8333, 8]}, "Kp is right; Ti: that is the same number as the 8\xa0s of the question"),
    ({"pid": PID(0.8333)}, "Kp is right; Ti: the integral term is missing"),
    ({"pid": PID(0.8333, 40, 5)}, "a derivative term is not asked for"),
    ({"H": "3*exp(-40*s)/(8*s + 1)"}, "with 40\xa0s and 8\xa0s interchanged"),
    ({"H": "3*exp(-8*s)/(40*s - 1)"}, "one sign is wrong"),
    ({"H": "3*exp(-8*s)/(37*s + 1)"}, "its static gain and dead time are right, but its poles are not"),
    ({"H": "3*exp(-5*s)/(40*s + 1)"}, "its static gain and poles are right, but its dead time is not"),
    ({"H": "3*exp(-8*s)/(s + 40)"}, "its poles are one divided by those that it should have"),
    ({"H": "7*exp(-8*s)/(40*s + 1)"}, "it is right but for a constant factor"),
    ({"H": "3*exp(-8*s)/(40*s + 1)/(5*s + 1)"}, "it has too many poles"),
    ({"h": "3*(1 - exp(-t/35))"}, "its initial value and final value are right, but its initial slope is not"),
    ({"h": "3*exp(-t/40)"}, "its initial value and final value are not right"),
    ({"h": "1 - exp(-t/40)"}, "without the 3\xa0K/%"),
    ({"h": "3*(1 - exp(-8*t))"}, "that is what comes out"),
    ({"way": "down"}, "that would be right for 'cooling' in place of 'heating'"),
]


@pytest.mark.parametrize(("given", "says"), RESPONSES[:-2] + RESPONSES[-1:])
def test_responses(given, says):
    assert says in repr(tank.question().check(**given))


def test_what_the_statement_does_not_show_is_no_given():
    question = tank.question()
    assert "noise" not in question.background.parameters
    assert {"K", "T", "tau", "action"} == question.background.parameters.keys()


WITHOUT_GIVENS = [
    (number(0.6667, "s", "the time"), 0.7, WRONG, "rounded to 1 digit, but the accuracy asked for"),
    (number(17.97, "s", "the time"), 18.5, WRONG, "more than the rounding of a result"),
    (number(17.97, "s", "the time"), 3, WRONG, "too small"),
    (number(17.97, "s", "the time"), 9000, WRONG, "much too large"),
    (number(17.97, "s", "the time"), -3, WRONG, "the sign is not, nor is the size"),
    (number(7, "", "the number of states"), 9, WRONG, "not right"),
    (number(4, "", "the gain margin"), 12.04, MISTAKE, "in dB"),
    (numbers([[1, 2], [3, 4]], what="A"), [[1, 2], [3, -4]], MISTAKE, "row 2, column 2: the size is right"),
    (numbers([1, 2, 3], what="A"), [2, 1, 3], MISTAKE, "in another order"),
    (numbers([1, 2, 3], what="A"), [1, 2, 7.7], WRONG, "look at the third number"),
    (poles([-1 + 2j, -1 - 2j]), [-1 + 2j], MISTAKE, "its mirror image is missing"),
    (poles([-1, -1, -2]), [-1, -2], MISTAKE, "one of them counts several times"),
    (poles([-1, -2]), [-1], WRONG, "what is there is right, but something is missing"),
    (poles([-1, -2]), [1], MISTAKE, "one has the wrong sign"),
    (poles([-1, -2]), [-1, -2, -3], WRONG, "all that are asked for are there, but also more"),
    (poles([-4, -2]), [-0.25, -2], MISTAKE, "1 of 2 is right; one is the inverse"),
    (poles([-1, -2]), [-1, -2.05], MISTAKE, "off by a few percent"),
    (expression("a/(b + c)"), "a/(b - c)", MISTAKE, "one sign is wrong: look at the term with c"),
    (transfer_function("90*K_c/(260*s + 1 + 90*K_c)"), "7.2/(260*s+8.2)", MISTAKE, "right if K_c is 0.08: leave K_c"),
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
    (words(["S2", "S4"], ["S1", "S2", "S3", "S4"]), "S2", WRONG, "something is missing"),
    (words(["S2", "S4"], ["S1", "S2", "S3", "S4"]), "S2, S1", WRONG, "S2 belongs there, S1 does not"),
    (
        words(["S2", "S4"], ["S1", "S2", "S3", "S4"]),
        "S2, S4, S1",
        WRONG,
        "but also something that does not belong there",
    ),
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
    kind = transfer_function(2 / (3 * s + 1))
    assert judge("H", kind, "2/(3s - 1)").says.endswith(" · read as 2/(3*s - 1)")
    assert judge("H", kind, "2/(3s + 1)").says.startswith("right")
    assert "read as" not in judge("K", number(2), 3).says


def test_a_key_that_never_ends_for_other_givens_is_given_up():
    def key(n):
        while n != 7:
            pass
        return answers(x=number(n, "s", "the time"))

    background = Background(key(7), {"n": 7}, {"n": between(1, 9, "s")}, key)
    assert explained(number(7, "s"), 3.3, background.of("x", {})).is_bare  # and it comes to an end


def test_no_diagnosis_stumbles():
    bank_ = [one for chapter in bank.chapters() for one in bank.exercises(chapter).values()]
    for one in of_the_day(bank_, len(bank_) // 6):
        question = one.question()
        for name, kind in question.key.items():
            if isinstance(kind, Expression):
                wrong = [2.5 * kind.expr, (kind.expr + 7) * 5, kind.expr**2, kind.expr - 1 / (kind.expr + 2)]
            else:
                wrong = [value for _, value in (*question.mistakes[name], *kind.mistakes())]
            for answer in (kind.read(value)[0] for value in of_the_day(wrong, 2, f"{one.number} {name}")):
                if not kind.agrees(answer):
                    with contextlib.suppress(Unreadable):  # a list of another length
                        explained(kind, answer, question.background.of(name, {name: answer}))


# The table of mistakes in numbers.


def cases(students):
    """The numbers that are asked for in all exercises, in some variants."""
    for chapter in bank.chapters():
        for one in bank.exercises(chapter).values():
            for student in students:
                question = one.question.__wrapped__(one, student)
                for name, kind in question.key.items():
                    if isinstance(kind, Number):
                        yield question, name, kind


def case_of(question, name, kind, monkeypatch=None):
    """The case that the diagnosis of a number looks at."""
    seen = []
    monkeypatch.setattr(in_numbers, "found_in", lambda answer, case, agrees: seen.append(case))
    explained(kind, math.pi, question.background.of(name, {}))
    monkeypatch.undo()
    return seen[0]


@pytest.mark.parametrize("part", range(4))
def test_each_mistake_is_answered_by_its_own_sentence(part, monkeypatch):
    """Or by that of another mistake with the same value in this variant, one that comes before it."""
    many = [*itertools.islice(cases(STUDENTS if THOROUGH else STUDENTS[:1]), part, None, 4)]
    for place, (question, name, kind) in enumerate(of_the_day(many, len(many) // 6, part)):
        case = case_of(question, name, kind, monkeypatch)
        before = []
        for mistake in (
            (*TABLE, *GIVENS, *FACTORS, *MORE) if THOROUGH or place % 5 == 0 else (*TABLE, *GIVENS, *FACTORS)
        ):  # keys with other givens take time
            for wrong, says in mistake.wrongs(case):
                if not math.isfinite(wrong) or wrong == 0 or kind.agrees(wrong):
                    continue
                before.append((wrong, says))
                if (mistake.is_rarest and not is_recognised(wrong, wrong, is_rarest=True)) or case.is_count(wrong):
                    continue
                found = found_in(wrong, case, kind.agrees)
                alike = {one for value, one in before if is_recognised(wrong, value)}
                assert found is not None, f"{question.exercise.number} {name} = {wrong}: {says}"
                alike |= {
                    one
                    for other in TABLE
                    for value, one in (other.wrongs(case) if other.is_plain else ())
                    if abs(wrong - value) <= case.within * abs(value)
                }
                is_other = found.says.endswith("which factor belongs there?") or found.says.startswith(
                    "that is rounded"
                )
                alike |= {found.says} if is_other else set()
                assert found.says == says or found.says in alike, f"{question.exercise.number} {name} = {wrong}: {says}"


def test_hardly_any_other_number_is_taken_for_a_mistake():
    dice = random.Random(22)
    taken, count = 0, 0
    many = [*cases([None])]
    for question, name, kind in many if THOROUGH else many[::3]:
        for _ in range(6 if THOROUGH else 2):
            answer = kind.key * math.exp(dice.uniform(-2, 2))
            answer = float(f"{answer:.{dice.choice((2, 3))}e}")
            if kind.key and not kind.agrees(answer):
                found = explained(kind, answer, question.background.of(name, {}))
                count += 1
                taken += found.is_mistake
    assert count > 150
    assert taken <= 0.04 * count


def test_no_sentence_tells_the_key(monkeypatch):
    many = [*cases([None])]
    for question, name, kind in of_the_day(many, len(many) // 6, "key"):
        case = case_of(question, name, kind, monkeypatch)
        known = (
            {amount.value for amount in case.givens}
            | {*case.shown}
            | {0, 1, 2, 4, 10, 60, 90, 100, 180, 360, 1000, 3600, 0.632}
        )
        if any(is_recognised(kind.key, value) for value in known if value):
            continue
        answers_ = [wrong for mistake in (*TABLE, *GIVENS, *FACTORS) for wrong, _ in mistake.wrongs(case)]
        for answer in (*answers_[::3], 1.3 * kind.key, 4.7 * kind.key, 1.04 * kind.key):
            if math.isfinite(answer) and not kind.agrees(answer):
                says = explained(kind, answer, question.background.of(name, {})).says.replace(kind.asked, "")
                told = [float(text) for text in re.findall(r"\d+\.?\d*", says)]
                near = [value for value in told if abs(value - abs(kind.key)) <= 1e-3 * abs(kind.key)]
                assert not near, f"{kind.key}: {says}"


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
    assert found_in(30.75, case).says == "that is 6.15 s times 5 %: is that the time, in s?"
    assert found_in(17.85, case).says == "look at the 6.15 s: is that left out, or is it there once too often?"


# What a wrong number has to do with other wrong and right ones.


@exercise("1.2", title="A relay", points=1)
def relay(
    swing=between(1, 9, "K", reference=2.5),
    height=between(5, 20, "%", reference=12),
    first=between(10, 90, "s", reference=54),
    last=between(20, 200, "s", reference=135),
):
    """A relay of {height} makes {swing} at {first} and {last}; the fraction has 44 in it."""
    ultimate, T = 4 * height / (sympy.pi * swing), sympy.Rational(3, 2) * (last - first)
    return answers(
        Ku=number(ultimate, "%/K", "the ultimate gain"),
        Kp=number(0.6 * ultimate, "%/K", "the gain"),
        T=number(T, "s", "the time constant"),
        tau=number(first - T / 3, "s", "the dead time"),
        Pu=number(4 * (last - first), "s", "the ultimate period"),
        poles=poles([-3, -5], what="the poles"),
        zeros=poles([5], what="the zeros"),
    )


FITS = "this fits what you have for"
TOGETHER = [
    ({"Ku": 3.38, "Kp": 2.03}, "Ku", "not right"),
    ({"Ku": 3.38, "Kp": 2.03}, "Kp", f"{FITS} the ultimate gain, `Ku`"),
    ({"T": 135, "tau": 9}, "tau", f"{FITS} the time constant, `T`"),  # neither by a factor nor by a difference
    ({"Ku": 3.38, "tau": 20}, "tau", "not right: too large; asked: the dead time, in s"),
    ({"T": 135, "Pu": 333}, "Pu", "What you have for the time constant, `T`, is not right either"),
    ({"Ku": 6.112, "Kp": 6.112}, "Kp", "that is the ultimate gain, `Ku`, itself: asked here is the gain"),
    ({"Ku": 3.667, "Kp": 6.112}, "Kp", "this and the ultimate gain, `Ku`, are interchanged"),
    ({"Ku": 6.112, "Kp": 2.75}, "Kp", "that is 0.45 times the ultimate gain, `Ku`: which factor belongs there?"),
    ({"Ku": 269}, "Ku", "as large as the 44: is that missing"),
    ({"Ku": 0.265}, "Ku", "with the numbers of 2.5\xa0K and 12\xa0% interchanged"),
    ({"Pu": 0.01939}, "Pu", "an angular frequency instead of a period"),
    ({"poles": [5], "zeros": [-3, -5]}, "poles", "this and the zeros, `zeros`, are interchanged"),
    ({"poles": [5]}, "poles", "have you interchanged the two?"),
    ({"poles": [-3, -5], "zeros": [-3, -5]}, "zeros", "that is the poles, `poles`, itself"),
]


@pytest.mark.parametrize(("given", "name", "says"), TOGETHER)
def test_numbers_that_belong_together(given, name, says):
    said = {one.name: one.says for one in relay.question().check(**given).verdicts}
    assert says in said[name], said
    first = next(iter(given))
    assert FITS not in said[first]


@exercise("1.3", title="A loop", points=1)
def loop(K=between(1, 9, reference=3), T=between(10, 90, "s", reference=40), H=between(0.1, 0.9, reference=0.4)):
    """A loop of {K}, {T} and {H}."""
    return answers(
        M=transfer_function(K / (T * s + 1 + K * H)),
        gain=number(K / (1 + K * H), "", "the gain of the loop"),
        T_M=number(T / (1 + K * H), "s", "the time constant of the loop"),
        y=time_function(K * (1 - sympy.exp(-sympy.Symbol("t") / T)), until=200, unit="K"),
        end=number(K, "K", "the end"),
        M_0=expression("K/(1 + K*H)"),
    )


@pytest.mark.parametrize(
    ("given", "name"),
    [
        ({"M": "3/(40*s + 1 - 1.2)", "gain": -15}, "gain"),
        ({"M": "3/(40*s + 1 + 3)", "T_M": 10}, "T_M"),
        ({"y": "7.2*(1 - exp(-t/40))", "end": 7.2}, "end"),
        ({"M_0": "K/(1 + K + H)", "gain": 0.682}, "gain"),
    ],
)
def test_a_number_may_belong_to_a_wrong_formula(given, name):
    said = {one.name: one.says for one in loop.question().check(**given).verdicts}
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


@pytest.mark.parametrize(("answer", "is_named"), [(5, False), (30, False), (2.57, True)])
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


def test_a_dead_time_of_several_digits_leaves_no_poles_behind():
    says = judge("H", transfer_function("exp(-15*s)/s"), "exp(-5.4*s)/s").says
    assert says.startswith("its gain at low frequencies and poles are right, but its dead time is not")


def test_a_formula_with_another_sign_is_not_right_at_a_limit():
    kind = expression("(F - 20*v - 6*y)/10")
    assert "for a very small F" not in judge("a", kind, "(F + 20*v + 6*y)/10").says


def test_settings_may_be_interchanged():
    assert "Kp and Ti are interchanged" in judge("pid", settings(PID(1.5, 12)), PID(12, 1.5)).says


def test_a_unit_that_was_given_is_the_one_that_is_wrong():
    says = judge("Ti", number(18, "min", "the integral time"), "18 s").says
    assert says == "the number is right, but in min: you have given it in s"


def test_rounding_does_not_choose_between_two_corners_that_change_a_formula_alike():
    said = set()
    for gain in range(1, 8):
        kind = transfer_function(f"{gain}*(480*s + 12)*exp(-6*s)/(20*s + 4/5)")
        says = judge("F", kind, f"35*{gain} + 5*{gain}*(480*s + 12)*exp(-6*s)/(20*s + 4/5)").says
        said.add(says.partition(" · ")[0])
    assert len(said) == 1
