"""The cheat sheet is one A4 page, the same each time, and its formulas have the values that the library computes."""

import functools
import io
import math
import re
import sys
from pathlib import Path

import pytest
import sympy

from loopbook import s, t
from loopbook.approximation import SOPDT, pade, taylor, zero_rule
from loopbook.deadtime import System
from loopbook.identification import relay_experiment
from loopbook.integrals import ise, pi_first_order
from loopbook.stability import margins
from loopbook.synthesis import IMC_TABLE, imc
from loopbook.transfer import first_order
from loopbook.tuning import RULES, simc
from plainmath.latex import latex

ROOT = Path(__file__).parents[2]
sys.path.insert(0, str(ROOT / "docs"))

from cheat_sheet import contents, dynamics, layout, letters, rules, stated  # noqa: E402 - of docs/, from now on

VALUES = {
    letters.K: 2, letters.T: 5, letters.T1: 7, letters.T2: 3, letters.T3: 1, letters.theta: 2, letters.Tc: 4,
    letters.c: 3, letters.zeta: sympy.Rational(3, 10), letters.beta: sympy.Rational(1, 2),
    letters.r: sympy.Rational(2, 5),
}  # fmt: skip


def value(expression):
    return float(sympy.sympify(expression).subs(VALUES).evalf())


@functools.cache
def section(make):
    return make()


# The page.


sections = functools.cache(contents.sections)


def drawn(parts):
    file = io.BytesIO()
    layout.draw(parts, contents.TITLE, contents.LETTERS, file)
    return file.getvalue()


@functools.cache
def pdf():
    return drawn(sections())


def test_it_is_one_a4_page():
    assert len(re.findall(rb"/Type /Page\b", pdf())) == 1
    width, height = map(float, re.search(rb"/MediaBox \[ 0 0 ([\d.]+) ([\d.]+) \]", pdf()).groups())
    assert (width / 72 * 25.4, height / 72 * 25.4) == pytest.approx((297, 210), abs=0.1)


def test_its_fonts_are_inside():
    fonts = set(re.findall(rb"/FontName /(?:[A-Z]{6}\+)?([\w-]+)", pdf()))
    assert fonts
    assert all(name.startswith(b"STIX") for name in fonts)
    assert len(re.findall(rb"/FontFile2 ", pdf())) >= len(fonts)


def test_equal_contents_are_equal_bytes():
    assert drawn(sections()[:4]) == drawn(sections()[:4])
    assert b"CreationDate" not in pdf()


def test_its_type_can_be_read():
    assert min(layout.SIZE, layout.SMALL, layout.HEADING, layout.TITLE) >= 7


def test_too_much_is_refused():
    parts = [layout.Block(part) for part in sections()[-3:]]
    with pytest.raises(ValueError, match="points high: expected at most 100"):
        layout.columns(parts, 100)
    wide = type(parts[0].section)("Wide", "04_laplace", (("word " * 100,),))
    with pytest.raises(ValueError, match=r"Wide is \d+ points wide"):
        layout.Block(wide)


def test_each_section_leads_to_its_chapter():
    for part in sections():
        assert (ROOT / "chapters" / f"{part.chapter}.ipynb").exists(), part.title


# How formulas are written.


@pytest.mark.parametrize(
    ("text", "flat", "expected"),
    [
        ("9*x/10", False, "0.9 x"),
        ("10*x/63", True, "x/6.3"),
        ("x/2", True, "x/2"),
        ("K/(T_1*s + 1)", False, r"\dfrac{K}{T_{1} s + 1}"),
        ("K/(s*(T_1*s + 1))", True, "K/[s (T_{1} s + 1)]"),
        ("1 - K", False, "1 - K"),
        ("-K/2", True, "- K/2"),
    ],
)
def test_formulas_are_written_as_in_books(text, flat, expected):
    names = {name: sympy.Symbol(name, positive=True) for name in ("x", "K", "T_1")} | {"s": s}
    assert latex(sympy.sympify(text, locals=names), flat) == expected


# The values.


def test_step_responses():
    times = [0.5, 3, 11]
    for model, response in section(dynamics.responses).rows:
        exact = System(model.subs(VALUES)).step(times)
        assert [value(response.subs(t, moment)) for moment in times] == pytest.approx(list(exact)), model


def test_dead_times():
    delay = sympy.exp(-letters.theta * s)
    assert section(dynamics.dead_times).rows[0][0] == taylor(delay)
    for n, approximation in ((2, pade(delay)), (3, pade(delay, 2))):
        assert sympy.simplify(section(dynamics.dead_times).rows[0][n] - approximation) == 0


@pytest.mark.parametrize(
    ("T0", "T", "Tc", "rule", "row"),
    [(9, 6, 2, "T1", 0), (9, 2, 6, "T1a", 1), (4, 3, 6, "T1b", 2), (15, 20, 2, "T2", 0), (15, 20, 8, "T3", 1)],
)
def test_zero_rules(T0, T, Tc, rule, row):
    step, side = zero_rule(T0, T, Tc), 2 if rule in ("T2", "T3") else 0
    name, result = section(dynamics.zero_rules).rows[row][side : side + 2]
    assert step.rule == rule == name.partition(":")[0]
    result = sympy.sympify(result.strip("$") if isinstance(result, str) else result)
    known = {letters.T0: T0, letters.T: T, letters.Tc: Tc, letters.short: min(T, 5 * Tc)}
    assert sympy.simplify(result.subs(known) - step.after) == 0


def test_skogestad():
    models = (SOPDT(2, 7, delay=2), SOPDT(2, sympy.oo, delay=2), SOPDT(2, 7, 3, 2), SOPDT(2, sympy.oo, 3, 2))
    models = (*models, SOPDT(2, sympy.oo, sympy.oo, 2))
    for (process, *shown), model in zip(section(rules.skogestad).rows, models, strict=True):
        settings = simc(model, 4, c=3)
        assert process.subs(VALUES).equals(model.expr.subs(sympy.exp(-2 * s), 1))
        assert list(map(value, shown)) == pytest.approx([float(x) for x in (settings.Kp, settings.Ti, settings.Td)])


@pytest.mark.parametrize("name", IMC_TABLE)
def test_internal_model_control(name):
    row = list(IMC_TABLE).index(name)
    _, model, integral, gain, product = section(rules.internal_model).rows[row]
    approximation = IMC_TABLE[name][1] or taylor
    settings = imc(model.subs(VALUES), 4, approximation)
    tau = {letters.tau: sympy.Rational(1 * 2, 4 + 1 + 2)}
    integral, gain, product = (value(sympy.sympify(x).subs(tau)) for x in (integral, gain, product))
    Kp, Td = integral / gain / 2, product / integral
    assert (Kp, integral, Td) == pytest.approx([float(x) for x in (settings.Kp, settings.Ti, settings.Td)])
    assert settings.Tf == (1 if name in "IJ" else 0)


NUMBERS = {"K": 2, "T": 5, "delay": 2, "Ku": 3, "Pu": 6, "KpGG": 4, "Tou": 8}
UNITS = {letters.Ku: 3, letters.Pu: 6, letters.KpGG: 4, letters.Tou: 8}


@pytest.mark.parametrize(
    ("make", "needs", "gain", "time"),
    [
        (rules.experiments, {"the ultimate gain and period", "the Good Gain experiment"}, 1, 1),
        (rules.reaction_curves, {"a lag or an integrator with dead time"}, 2, 2),
        (rules.lag_alone, {"a lag with dead time"}, 2, 5),
    ],
)
def test_all_rules_for_a_need(make, needs, gain, time):
    rows = {name: settings for name, *settings in section(make).rows}
    found = {
        name: rule.settings(NUMBERS, **chosen)
        for rule in RULES.values()
        if rule.needs in needs
        for name, chosen in rule.variants.items()
    }
    assert rows.keys() == found.keys()
    for name, pid in found.items():
        expected = [gain * pid.Kp, pid.Ti / time, pid.Td / time]
        expected = ["" if x in (sympy.oo, 0) else pytest.approx(float(x)) for x in expected]
        assert [x if x == "" else value(sympy.sympify(x).subs(UNITS)) for x in rows[name]] == expected


def test_what_a_relay_tells():
    cycle = relay_experiment(first_order(2, 5, 2), amplitude=3)
    assert cycle.Ku == pytest.approx(float(stated.RELAY.subs({letters.d: 3, letters.A: cycle.amplitude})))


def test_margins():
    known = {letters.a: 0.3, letters.theta: 2}
    found = margins(sympy.Rational(3, 10) * sympy.exp(-2 * s) / s)
    assert float(stated.GAIN_MARGIN.subs(known)) == pytest.approx(found.gain_margin)
    assert math.degrees(stated.PHASE_MARGIN.subs(known)) == pytest.approx(found.phase_margin)
    assert float(stated.MORE_DEAD_TIME.subs(known)) == pytest.approx(found.delay_margin)


def test_squared_error_of_an_integrator():
    known = {letters.a: sympy.Rational(3, 10), letters.theta: 2}
    process = sympy.exp(-2 * s) / s
    assert float(dynamics.ise_of_integrator().subs(known)) == pytest.approx(ise(process, known[letters.a], "servo"))


@pytest.mark.parametrize("mode", ["servo", "regulator"])
@pytest.mark.parametrize("Kp", [0.3, 0.9])
def test_squared_error_of_pi_control(mode, Kp):
    K, T, delay, Ti = 2, 5, 2, 6
    known = {letters.T: T, letters.theta: delay, letters.Ti: Ti, letters.k: K * Kp}
    known[letters.rho] = stated.RHO.subs(known)
    known[letters.omega], known[letters.sigma] = stated.OMEGA.subs(known), stated.SIGMA.subs(known)
    known[letters.x] = stated.TWICE_X.subs(known) / 2
    loop = K * Kp * (1 + 1 / (Ti * s)) / (T * s + 1) * sympy.exp(-delay * s)
    known[letters.q] = stated.QUOTIENT.subs(letters.L, loop.subs(s, known[letters.sigma]))
    servo = mode == "servo"
    known[letters.P], known[letters.Q] = (x.subs(known) if servo else K**2 for x in (stated.SERVO_P, stated.SERVO_Q))
    assert float(stated.ISE.subs(known)) == pytest.approx(pi_first_order(K, T, delay, Kp, Ti, mode))
