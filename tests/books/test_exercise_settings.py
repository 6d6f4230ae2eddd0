"""Answers that are settings of a controller, in the form that is asked, whole and one by one."""

import math

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from exercisebook.asked_names import as_asked, by_name, matched
from exercisebook.formulas import Formula
from exercisebook.judging import MISTAKE, RIGHT, UNJUDGED, WRONG, is_right
from judged import assert_judged, assert_reads_back
from loopbook import s
from loopbook.exercises import bank
from loopbook.exercises.authoring import criterion, design, number, settings
from loopbook.pid import PID

PI = settings(PID(2, Ti=10), gain="%/K", what="the settings")
P = settings(PID(2))
PARALLEL = settings(PID(2.5, Ti=10, Td=1.6), gain="%/K", what="the settings", form="parallel")
SERIAL = settings(PID(2, Ti=8, Td=2, form="serial"), form="serial")
ANY = settings(PID(2.5, Ti=10, Td=1.6), gain="%/K", what="the settings")
READ_AS = "right, read as Kp = 2\N{NO-BREAK SPACE}%/K, Ti = 10\N{NO-BREAK SPACE}s"
STABLE = design(settings(PID(1, Ti=120)), criterion("the loop is stable", lambda pid: 100 < pid.Ti < 130))

#: Of each kind words of what is said, and the ways to write the right answer, between bars.
WRITTEN = [
    (
        PI,
        "right",
        "PI(2, 10) | PI(2, Ti=10) | PID(Kp=2, Ti=10) | pid(2, 10) | (2, 10) | [2, 10] | 2; 10 | 2, 10"
        " | Kp=2, Ti=10 s | Kc = 2; tau_I = 10 | Kc=2 and tauI=10 s | K_p = 2 %/K, T_i = 10 s"
        " | PI: Kp = 2, Ti = 10 | Kp: 2, Ti: 10 | Kp=2\nTi=10 | {'Kp': 2, 'Ti': 10}"
        " | {Kp: 2, Ti: 10} | gain = 2, integral time = 10 s | Kp = 2,0; Ti = 10,0 s | Kp=2 Ti=10 | P = 2, Ti = 10."
        " | PI with Kp = 2 and Ti = 10 s | a PI controller with gain 2 %/K and integral time 10 s"
        r" | K_{c} = 2, \tau_I = 10 | PI, Kc = 2, tau_I = 10 | gain of 2 and integral time of 10 s"
        " | Kp 2 Ti 10 | Kp = 2 / Ti = 10 s",
    ),
    (P, "right", "P: 2 | Kp = 2 | P(2) | Kp = 2, Ti = inf"),
    (
        ANY,
        "right",
        "PID(2.5, 10, 1.6) | Kc=2.5, tauI=10, tauD=1.6 | PID(2, 8, 2, form='serial') | Kp = 2,5, Ti = 10, Td = 1,6"
        " | 2, 8, 2, serial form | Kp = 2; Ti = 8; Td = 2 (series form)",
    ),
    (
        PARALLEL,
        "right",
        "2.5, 10, 1.6 (parallel) | parallel: 2.5, 10, 1.6 | parallel form, Kp = 2.5, Ti = 10, Td = 1.6"
        " | Kp = 2.5, Ti = 10, Td = 1.6, in parallel form | PID(2.5, 10, 1.6), ideal",
    ),
    # what was read is said of all settings
    (PI, READ_AS, "Kp = 2,0 %/K, Ti = 10 s"),
    # transfer functions with numbers
    (
        PI,
        READ_AS,
        r"2(1 + 1/(10 s)) | 2 + 0,2/s | C(s) = 2(10s+1)/(10s) | 2\left(1+\frac{1}{10s}\right)"
        " | 2000(s/100 + 0.001)/(10 s)",
    ),
    (ANY, "Td = 1.6\N{NO-BREAK SPACE}s, parallel form", "2.5(1 + 1/(10s) + 1.6s)"),
    (SERIAL, "right, read as Kp = 2, Ti = 8\N{NO-BREAK SPACE}s", "2.5*(1 + 1/(10*s) + 1.6*s)"),
]
#: The same of answers that are no text.
GIVEN = [
    (
        PI,
        "right",
        [
            PID(2, Ti=10),
            PID(2, Ti=10, form="serial"),
            (2, 10),
            [[2, 10]],
            {"Kp": "2 %/K", "Ti": "10 s"},
            {"Kc": 2, "tau_I": 10},
            {"K_c": 2, "T_i": 10},
            {"kc": "2", "tauI": "10 s"},
            {"gain": 2, "Ti": 10},
            [{"Kp": 2, "Ti": 10}],
        ],
    ),
    (P, "right", [{"Kc": 2}, {"Kp": 2, "Ti": "∞"}, (2, "inf")]),
    (ANY, "right", [PID(2, Ti=8, Td=2, form="serial"), {"Kc": 2.5, "tau_I": 10, "tau_D": 1.6}]),
    # gains of terms that are added
    (PI, "Ti = 10 from the gain Ki", [{"Kp": 2, "Ki": 0.2}]),
    (ANY, "Td = 1.6 from the gain Kd", [{"Kp": 2.5, "Ki": 0.25, "Kd": 4}]),
    (PI, READ_AS, [{"Kc": "2", "Ti": "1/6 min"}]),
    (PI, READ_AS, [2 * (1 + 1 / (10 * s)), PID(2, Ti=10).expr]),
    (ANY, "Td = 1.6\N{NO-BREAK SPACE}s, parallel form", [PID(2.5, 10, 1.6).expr, PID(2, 8, 2, form="serial").expr]),
    *(
        (settings(PID(2, Ti, Td, 0.1 * Td)), "Tf", [PID(2, Ti, Td, 0.1 * Td).expr])
        for Ti, Td in ((0.01, 0.002), (10, 1.6), (4000, 900))
    ),
]

NO_CONTROLLERS = (
    "2*s | 1/s | 2*(1 + 1/(-10*s)) | 2*(1 + 1/(10*s))**2 | K*(1 + 1/s) | 2*exp(-s)/s | 1/(s - 1.3) | s/(1 - s) | 0*s"
    " | 1/(s*s*s*s*s*s*s*s*s) | sqrt(-1)*(1 + 1/s) | Kp = 2, Kp = 3, Ti = 10 | 2 | PI | good settings | Ti = 10 | I: 10"
    " | 2 or 10"
)
JUDGED = [
    (PI, {"Kp": 2, "Ti": "1 min"}, WRONG, "Kp is right; Ti is not: too large"),
    (PI, {"Kp": 2, "Ki": 3}, WRONG, "Kp is right; Ti is not"),
    (PI, PID(-2, Ti=10), MISTAKE, "sign of Kp"),
    (PI, PID(0.5, Ti=10), MISTAKE, "inverted"),
    (PI, PID(50, Ti=10), MISTAKE, "proportional band"),
    (PI, PID(2, Ti=0.2), MISTAKE, "integral gain"),
    (PI, "2 + 0.1/s", MISTAKE, "Kp is right; Ti: it is off by a factor of 2"),
    (PI, {"Kp": 2, "Ki": 0}, UNJUDGED, "from Ki follows no Ti"),
    (PI, {"Kp": 2, "Ti": 10, "Ki": 3}, UNJUDGED, "Ki is not a setting"),
    (PI, {"Kp": 2, "PB": 50}, UNJUDGED, "PB is not a setting"),
    (PI, {2, 10}, UNJUDGED, "a set has no order"),
    (PI, {"Kp = 2", "Ti = 10"}, UNJUDGED, "a set has no order"),
    (PI, {"Kp": 2, "Kc": 2, "Ti": 10}, UNJUDGED, "two values for Kp"),
    (PI, (2, np.array([10, 11])), UNJUDGED, "2 values"),
    (PI, "2(1 + 1/10s)", UNJUDGED, "may be .../(10*s)"),
    (PI, 2, UNJUDGED, "no controller"),
    (PI, s**900, UNJUDGED, "no controller"),
    *((PI, one, UNJUDGED, "no controller") for one in NO_CONTROLLERS.split(" | ")),
    (SERIAL, "2.5*(1 + 1/(3*s) + 1.6*s)", WRONG, ""),  # of which there is no serial form
    (PARALLEL, PID(2, Ti=8, Td=2, form="serial"), MISTAKE, "asks for its parallel form"),
    (PARALLEL, PID(2, Ti=8, Td=2), MISTAKE, "numbers of the serial form"),
    (PARALLEL, PID(2.5, Ti=1.6, Td=10), MISTAKE, "exchanged"),
    (PARALLEL, PID(2.5, Ti=10, Td=1.6, form="serial"), WRONG, "not right"),
    (STABLE, PID(1, Ti=2), WRONG, "asked is that the loop is stable, and it is not so"),
    (STABLE, PID(1, Ti=99), WRONG, "asked is that the loop is stable"),
]


def test_judging(subtests):
    given_as = [*((kind, says, ways.split(" | ")) for kind, says, ways in WRITTEN), *GIVEN]
    rightly = [(kind, answer, RIGHT, says) for kind, says, answers in given_as for answer in answers]
    for kind, answer, status, says in rightly + JUDGED:
        with subtests.test(f"{answer!r:.60}"):
            assert_judged(kind, answer, status, says)


def test_a_form_that_there_is_not():
    with pytest.raises(ValueError, match=r"form is 'ideal': expected one of any, parallel, serial"):
        settings(PID(2), form="ideal")


moderate = st.floats(-1e12, 1e12).filter(lambda x: x == 0 or abs(x) > 1e-12)


@given(
    moderate,
    moderate.map(abs).filter(bool) | st.just(math.inf),
    moderate.map(abs),
    moderate.map(abs),
    st.sampled_from(["serial", "parallel"]),
    st.sampled_from(["any", "serial", "parallel"]),
)
def test_settings_as_code_read_back(Kp, Ti, Td, Tf, form, asked):
    kind = settings(PID(1, 2), form=asked)
    assert_reads_back(kind, kind.read(PID(Kp, Ti, Td, Tf, form))[0])


# The settings of a formula.


@pytest.mark.parametrize(
    ("given", "right"),
    [
        ("2*(1 + 1/(10*s))", True),
        ("2 + 0.2/s + s - s", True),
        ("2*(1 + 1/(10*s)) + ((1e40 + 1e40*I + 100*s) - 1e40 - 1e40*I)", False),
        ("2*(1 + 1/(10*s)) - ((1e40 + 1e40*I + 4 + 2.8/s) - 1e40 - 1e40*I)", False),
        ("2*(1 + 1/(10*s)) + ((1e40 + 5) - 1e40)", False),
    ],
)
def test_the_settings_of_a_formula_are_those_in_all_its_digits(given, right):
    kind = settings(PID(2, Ti=10))
    kind.draw_from("a secret")
    assert is_right(kind, given) is right


@pytest.mark.parametrize("more", ["1e-9/(s - 1)", "1e9*(s - 1)*(s - 2)", "1e-9*s**3", "0.001*exp(-s)"])
def test_a_term_more_tells_no_settings_however_small(more):
    assert not is_right(settings(PID(2, Ti=10)), f"2*(1 + 1/(10*s)) + {more}")


# Names of other books.


@pytest.mark.parametrize(
    ("given", "asked", "found"),
    [
        ("K_p T_i", "Kp Ti", "Kp Ti"),
        ("Kc tau_I", "Kp Ti", "Kp Ti"),
        ("K T theta", "K T tau", "K T tau"),
        ("K T delay", "K T tau", "K T tau"),
        ("Kp T", "K T tau", "K T"),
        ("K_cu", "a P Kcu share", "Kcu"),
        ("t1 theta", "tau_1 theta", "tau_1 theta"),
        ("PM", "ISE phase_margin", "phase_margin"),
        ("pole", "poles zeros", "poles"),
        ("w", "omega gain delay", "omega"),
        ("K", "omega gain delay", "gain"),
        ("zeta", "damping K_c offset", "damping"),
        ("G", "H t_half t_slow", "H"),
        ("tau", "tau_1 theta", ""),  # the lag of some books, the dead time of others
        ("Kc K_c", "Kp Ti", ""),
        ("K", "K_u Pu", ""),
    ],
)
def test_a_name_that_can_mean_one_thing_means_it(given, asked, found):
    assert list(matched(given.split(), asked.split()).values()) == found.split()


def test_in_the_bank_each_name_means_itself_in_other_spellings_too():
    for chapter in bank.chapters():
        for exercise in bank.exercises(chapter).values():
            asked = list(exercise.question().key)
            assert matched(asked, asked) == {name: name for name in asked}
            plain = [name.replace("_", "") for name in asked]
            assert list(matched(plain, asked).values()) == asked, exercise.number


CONTROLLER = {"K": number(3), "pid": PI}
ONE_BY_ONE = {"Ku": number(4), "Kp": number(2), "Ti": number(10, "s"), "Td": number(1, "s")}


@pytest.mark.parametrize(
    ("key", "given", "asked"),
    [
        (CONTROLLER, {"K": 3, "Kc": 2, "tau_I": 10}, {"K": 3, "pid": {"Kp": 2, "Ti": 10}}),
        (CONTROLLER, {"K": 3, "gain": 2, "Ki": 0.2}, {"K": 3, "pid": {"Kp": 2, "Ki": 0.2}}),
        (CONTROLLER, {"Kp": 3}, {"K": 3}),  # the gain that is asked by itself
        (CONTROLLER, {"K": 3, "Kp": 2}, {"K": 3, "pid": {"Kp": 2}}),
        (ONE_BY_ONE, {"pid": PID(2, 10)}, {"Kp": 2, "Ti": 10, "Td": 0}),
        (ONE_BY_ONE, {"Ku": 4, "settings": "Kc = 2, tau_I = 10 s"}, {"Ku": 4, "Kp": "2", "Ti": "10 s"}),
        (ONE_BY_ONE, {"controller": [2, 10, 1]}, {"Kp": 2, "Ti": 10, "Td": 1}),
    ],
)
def test_settings_may_be_given_as_a_controller_and_one_by_one(key, given, asked):
    assert as_asked(given, key) == asked


def test_a_controller_without_a_name_is_its_settings():
    assert by_name(PID(2, 10), ONE_BY_ONE) == {"Kp": 2, "Ti": 10, "Td": 0}
    assert by_name("PID(2, 10 s, 1 s)", ONE_BY_ONE) == {"Kp": "2", "Ti": "10 s", "Td": "1 s"}


def test_the_letters_of_the_gain_are_the_same_in_a_formula():
    for text in ("K Kc", "K K_c", "K*Kp"):
        assert Formula(text, "K K_p").text == "K*K_p"
