"""The tuning rules: printed tables as formulas, units, limits, and what is refused."""

import functools
import inspect

import numpy as np
import pytest
import sympy
from hypothesis import given, settings
from hypothesis import strategies as st
from scipy.optimize import minimize
from sympy import Max, Min, Rational, exp, oo, sqrt, symbols

import contributing
from draws import draws
from loopbook import pid, s, tuning
from loopbook.approximation import SOPDT, model_of
from loopbook.integrals import criteria
from loopbook.oscillation import oscillation_of_pole
from loopbook.pid import PID
from loopbook.stability import dominant_poles
from loopbook.transfer import double_integrator, first_order, integrator, integrator_with_lag, second_order
from loopbook.tuning.registry import DIMENSIONS, confirm
from plainmath.validation import one_of

K, T, T1, T2, delay, Tc, c, Ku, Pu, x = symbols("K T T1 T2 delay Tc c Ku Pu x", positive=True)

POSITIVE = st.fractions(Rational(1, 20), 20, max_denominator=20).map(Rational)
GAINS = st.fractions(-20, 20, max_denominator=20).filter(bool).map(Rational)
RATIOS = st.fractions(Rational(1, 10), 1, max_denominator=40).map(Rational)  # of dead time and lag
RANGE_OF_HANG = st.fractions(Rational(3, 2), 15, max_denominator=40).map(Rational)
KINDS = ("P", "PI", "PID")

# every rule in every variant, for every process that it is for, as the registry has them
CASES = {
    f"{name}: {words}{f', {process}' if process else ''}": functools.partial(found.settings, process=process, **chosen)
    for name, found in tuning.RULES.items()
    for process in found.need.processes or [None]
    for words, chosen in found.variants.items()
}
CASES["simc: faster"] = functools.partial(tuning.RULES["simc"].settings, c=1.44)
RULES = {name: tuning.RULES[name.partition(":")[0]] for name in CASES}
of_all_rules = pytest.mark.parametrize("name", CASES)


def settings_of(name, values):
    """The settings of a rule in numbers, also where its range is left."""
    free = {"extrapolate": True} if "extrapolate" in inspect.signature(RULES[name].function).parameters else {}
    return CASES[name](values, **free)


def rules_of(*needs):
    """The rules, in every variant, that start from one of these, for each of its processes."""
    return pytest.mark.parametrize("rule", [name for name in CASES if RULES[name].needs in needs])


def times(settings):
    return settings.Ti, settings.Td


def same(one, other):
    return all(sympy.simplify(a - b) == 0 for a, b in zip(one, other, strict=True) if a != b)


# The registry.


@pytest.mark.parametrize("made", tuning.RULES.values(), ids=tuning.RULES)
def test_a_rule_has_the_settings_that_it_names_and_no_others(made):
    confirm(made)


def test_every_public_function_that_returns_settings_is_a_rule():
    others = {name for name in tuning.__all__ if str(getattr(tuning, name)).startswith("<function")} - {*tuning.RULES}
    returned = {name: inspect.signature(getattr(tuning, name)).return_annotation for name in others}
    assert {name for name, what in returned.items() if what in ("PID", "WeightedPID")} == {"adjusted"}


SOURCED = "Half of it.\n\nSource: nobody (1900)."


def half(Ku, Pu, kind="P") -> PID:
    return {"P": PID(Ku / 2), "PI": PID(Ku / 2, Pu)}[one_of("kind", kind, ("P", "PI"))]


def of_the_module(Ku, Pu) -> "pid.PID":
    return pid.PID(Ku / 4, Pu)


def of_no_name(Ku, Pu) -> "Settings":  # noqa: F821 - a name that is nowhere
    return PID(Ku, Pu)


def of_one_lag(model) -> PID:
    model = model_of(model)
    if model.T2 != 0:
        raise ValueError(f"{model} has two lags")
    return PID(1 / model.K, model.T1)


def of_a_relay(amplitude, period) -> PID:
    return PID(1 / amplitude, period)


def without_hint(Ku, Pu):
    return PID(Ku, Pu)


@pytest.fixture
def registered(monkeypatch):
    """Registers a function as a rule, in a registry of the test's own."""
    monkeypatch.setattr(tuning.registry, "RULES", dict(tuning.RULES))

    def put(function, docstring=SOURCED, needs="the ultimate gain and period", **choices):
        monkeypatch.setattr(function, "__doc__", docstring)
        tuning.rule("Half", needs=needs, **choices)(function)
        confirm(tuning.registry.RULES[function.__name__])

    return put


def test_a_complete_rule_is_registered(registered):
    registered(half, kind=("P", "PI"))
    assert list(tuning.registry.RULES["half"].variants) == ["Half P", "Half PI"]
    assert tuning.registry.RULES["half"].source == "nobody (1900)."


def test_the_rule_that_contributors_are_shown_is_the_one_of_the_library(registered):
    del tuning.registry.RULES["tyreus_luyben"]
    shown = contributing.run("Add a tuning rule")["tyreus_luyben"]
    made = tuning.registry.RULES["tyreus_luyben"]
    confirm(made)
    assert made.function is shown is not tuning.tyreus_luyben
    for chosen in made.variants.values():
        assert made.settings(**chosen) == tuning.RULES["tyreus_luyben"].settings(**chosen)


def test_a_hint_may_name_the_settings_by_their_module(registered):
    registered(of_the_module)
    assert tuning.registry.RULES["of_the_module"].settings() == PID(Ku / 4, Pu)


@pytest.mark.parametrize(
    ("function", "given", "message"),
    [
        (half, {"docstring": "Half of it."}, "rule half has no source: expected 'Source: author"),
        (half, {"needs": "ultimate gain"}, "half needs 'ultimate gain', .*: did you mean 'the ultimate gain and peri"),
        (half, {"needs": "luck"}, "half needs 'luck', which is not known: expected one of one or two lags"),
        (of_a_relay, {}, "of_a_relay begins with amplitude, period: expected Ku, Pu"),
        (without_hint, {}, "without_hint has no hint .*: expected -> PID"),
        (of_no_name, {}, "of_no_name has no hint .*: expected -> PID"),
        (
            of_one_lag,
            {"needs": "one or two lags or integrators"},
            "of_one_lag has no settings of two lags for {}: .* has two lags",
        ),
        (half, {}, r"half does not say what it takes: expected kind=\('P', ...\)"),
        (half, {"kinds": ("P", "PI")}, "half has no parameter 'kinds': did you mean 'kind'?"),
        (half, {"kind": ("PI",)}, "kind by itself, in the rule half, is 'P': expected one of PI"),
        (half, {"kind": ("P", "PI", "PID")}, "half has no settings for .*'PID'.: kind is 'PID': expected one of P, PI"),
        (half, {"kind": ("P",)}, "half has settings for 'PI' too"),
        (tuning.tyreus_luyben, {"kind": ("PI",)}, "rule tyreus_luyben is there already"),
    ],
)
def test_what_a_rule_forgets_is_said(registered, function, given, message):
    with pytest.raises(ValueError, match=message):
        registered(function, **given)


def test_a_rule_gives_the_kind_of_controller_that_it_says(registered):
    def integral(Ku, Pu, kind="P") -> PID:
        one_of("kind", kind, ("P",))
        return PID(Ku, Pu)

    with pytest.raises(ValueError, match=r"integral gives .* for \{'kind': 'P'\}: expected a P controller"):
        registered(integral, kind=("P",))


# Units: a rule must not know in which unit gain and time are measured.


@of_all_rules
@settings(max_examples=draws(20), deadline=None)
@given(K=GAINS, T=POSITIVE, ratio=RATIOS, k=RANGE_OF_HANG, scale=GAINS, slower=POSITIVE)
@pytest.mark.daily(11)
def test_units(name, K, T, ratio, k, scale, slower):
    values = {"K": K, "T": T, "delay": ratio * T, "Ku": k / K, "Pu": T, "KpGG": k / K, "Tou": T}
    scaled = {one: x * scale ** DIMENSIONS[one][0] * slower ** DIMENSIONS[one][1] for one, x in values.items()}
    before, after = settings_of(name, values), settings_of(name, scaled)
    assert same([scale * after.Kp, *times(after)], [before.Kp, slower * before.Ti, slower * before.Td])


@of_all_rules
def test_symbols_give_the_formula_that_numbers_fit(name):
    need = RULES[name].need
    values = {"K": -2, "T": 10, "delay": 3, "Ku": -3, "Pu": 11, "KpGG": -2, "Tou": 11}
    formula, found = CASES[name](), CASES[name](values)
    numbers = {symbol: sympy.Integer(values[one]) for one, symbol in need.symbols.items()}
    assert same([e.xreplace(numbers) for e in (formula.Kp, *times(formula))], [found.Kp, *times(found)])
    assert found.Kp.is_negative
    assert found.Ti.is_extended_positive


# Limits.


FOR_INTEGRATORS = [name for name in CASES if RULES[name].needs == "a lag or an integrator with dead time"]


@pytest.mark.parametrize("name", [name for name in FOR_INTEGRATORS if CASES[name].keywords["process"] == "a lag"])
def test_an_infinite_lag_is_an_integrator(name):
    """With the slope K = gain/T fixed, the settings for a lag become those for an integrator."""
    values = {"K": K * T, "T": T, "delay": delay}
    lag, infinite = CASES[name](values), CASES[name](values, process="an integrator")
    limits = [sympy.limit(e, T, oo) for e in (lag.Kp, *times(lag))]
    assert same(limits, [infinite.Kp, *times(infinite)])


@pytest.mark.parametrize("kind", KINDS)
def test_the_two_reaction_curve_rules_are_near_for_a_long_lag(kind):
    process = integrator(1, 1)
    one, other = tuning.ziegler_nichols_reaction(process, kind), tuning.cohen_coon(process, kind)
    assert float(other.Kp / one.Kp) == pytest.approx(1, abs=0.13)
    if kind != "P":
        assert float(other.Ti / one.Ti) == pytest.approx(1, abs=0.24)


@pytest.mark.parametrize(
    "printed", [sqrt(T / delay), Rational("0.9") * sqrt(T / delay), sqrt(T / delay) + Rational(1, 3)]
)
def test_a_root_would_leave_an_integrator_without_control(printed):
    """Seborg's slides, as extracted, print roots for brackets; K is then the gain of the lag, slope times T."""
    assert sympy.limit(printed / (K * T), T, oo) == 0


@rules_of("a lag or an integrator with dead time", "a lag with dead time")
def test_a_vanishing_dead_time_lets_the_gain_grow_without_end(rule):
    sizes = [settings_of(rule, {"K": 1, "T": 1, "delay": Rational(1, n)}) for n in (10, 100, 1000)]
    assert sizes[0].Kp < sizes[1].Kp / 5 < sizes[2].Kp / 25
    assert sizes[0].Td >= sizes[1].Td >= sizes[2].Td


def test_skogestad_for_a_lag_becomes_that_for_an_integrator():
    lag, infinite = tuning.simc(first_order(K * T, T, delay), Tc, c), tuning.simc(integrator(K, delay), Tc, c)
    assert lag.Kp == infinite.Kp
    assert lag.Ti.subs({delay: 1, Tc: 2, c: 4, T: 10**6}) == infinite.Ti.subs({delay: 1, Tc: 2, c: 4})


def test_skogestad_without_dead_time_is_the_limit():
    """Table 7.2 is Table 7.1 with a dead time of zero."""
    for process in (integrator, double_integrator):
        with_delay, without = tuning.simc(process(K, delay), Tc, c), tuning.simc(process(K), Tc, c)
        assert same([e.subs(delay, 0) for e in (with_delay.Kp, *times(with_delay))], [without.Kp, *times(without)])


# The printed tables.


@pytest.mark.parametrize(
    ("process", "Kp", "Ti", "Td"),
    [
        (integrator(K, delay), 1 / (K * (Tc + delay)), c * (Tc + delay), 0),
        (first_order(K, T, delay), T / (K * (Tc + delay)), Min(T, c * (Tc + delay)), 0),
        (integrator_with_lag(K, T, delay), 1 / (K * (Tc + delay)), c * (Tc + delay), T),
        (SOPDT(K, T1, T2, delay), T1 / (K * (Tc + delay)), Min(T1, c * (Tc + delay)), T2),
        (double_integrator(K, delay), 1 / (4 * K * (Tc + delay) ** 2), 4 * (Tc + delay), 4 * (Tc + delay)),
    ],
)
def test_skogestads_five_rows(process, Kp, Ti, Td):
    settings = tuning.simc(process, Tc, c)
    assert settings.form == "serial"
    assert settings.Ti.equals(Ti)
    assert same([settings.Kp, settings.Td], [Kp, Td])


def test_skogestad_takes_the_dead_time_for_Tc():
    assert tuning.simc(first_order(1, 1, 0.5), c=2) == PID(1, Ti=1, form="serial")  # Haugen, Example 10.2
    assert tuning.simc(integrator(K, delay)).Kp == 1 / (2 * K * delay)  # Haugen, equation (10.28)


@given(T1=POSITIVE, T2=POSITIVE, delay=POSITIVE, K=GAINS, c=st.integers(2, 6))
def test_skogestad_cancels_the_smaller_lag(T1, T2, delay, K, c):
    """In whatever order the two lags are written."""
    settings = tuning.simc(second_order(K, T1, T2, delay), c=c)
    assert (settings.Td, settings.Ti) == (min(T1, T2), min(max(T1, T2), 2 * c * delay))
    assert settings == tuning.simc(second_order(K, T2, T1, delay), c=c)
    assert settings.Ti == tuning.skogestad_integral_time(max(T1, T2), delay, delay, c)


def test_ziegler_nichols_of_a_reaction_curve():
    by_kind = [tuning.ziegler_nichols_reaction(first_order(K, T, delay), kind) for kind in KINDS]
    gains = [settings.Kp * K for settings in by_kind]
    assert same(gains, [T / delay, Rational("0.9") * T / delay, Rational("1.2") * T / delay])
    assert [times(settings) for settings in by_kind] == [(oo, 0), (Rational("3.33") * delay, 0), (2 * delay, delay / 2)]


def test_cohen_and_coon():
    r = delay / T
    P, PI, PID_ = (tuning.cohen_coon(first_order(K, T, delay), kind) for kind in KINDS)
    printed = [1 / r + Rational(1, 3), Rational("0.9") / r + Rational("0.083"), Rational("1.35") / r + Rational("0.27")]
    assert same([K * settings.Kp for settings in (P, PI, PID_)], printed)
    Ti = delay * (Rational("3.33") + Rational("0.33") * r) / (1 + Rational("2.2") * r)
    assert same([*times(PI), PID_.Ti / T], [Ti, 0, r * (32 + 6 * r) / (13 + 8 * r)])
    assert same([PID_.Td / T], [Rational("0.37") * r / (1 + Rational("0.2") * r)])


@pytest.mark.parametrize(
    ("mode", "kind", "printed"),
    [
        ("regulator", "PI", [(0.859, -0.977), (0.674, -0.680)]),
        ("regulator", "PID", [(1.357, -0.947), (0.842, -0.738), (0.381, 0.995)]),
        ("servo", "PI", [(0.586, -0.916), (1.03, -0.165)]),
        ("servo", "PID", [(0.965, -0.85), (0.796, -0.1465), (0.308, 0.929)]),
    ],
)
def test_the_rows_of_table_12_3(mode, kind, printed):
    """Three digits and a power law at three dead times; the integral mode of the servo is linear in the dead time."""
    for r in (0.1, 0.37, 1):
        settings = tuning.itae(SOPDT(3, 20, delay=20 * r), kind, mode)
        found = [float(3 * settings.Kp), 20 / float(settings.Ti), float(settings.Td) / 20]
        expected = [A * r**B for A, B in printed] + [0] * (3 - len(printed))
        if mode == "servo":
            expected[1] = printed[1][0] + printed[1][1] * r
        assert found == pytest.approx(expected, rel=1e-12)


@pytest.mark.parametrize(
    ("settings", "Kp", "Ti", "Td"),
    [
        (tuning.ziegler_nichols_ultimate(Ku, Pu, "P"), "0.5", None, 0),
        (tuning.ziegler_nichols_ultimate(Ku, Pu, "PI"), "0.45", "1.2", 0),
        (tuning.ziegler_nichols_ultimate(Ku, Pu), "0.6", "2", "8"),
        (tuning.modified_ziegler_nichols(Ku, Pu), "0.33", "2", "3"),
        (tuning.modified_ziegler_nichols(Ku, Pu, "none"), "0.2", "3", "2"),
        (tuning.tyreus_luyben(Ku, Pu), "0.31", Rational(1) / Rational("2.2"), 0),
        (tuning.tyreus_luyben(Ku, Pu, "PID"), "0.45", Rational(1) / Rational("2.2"), "6.3"),
    ],
)
def test_rules_of_the_ultimate_cycle(settings, Kp, Ti, Td):
    Ti, Td = oo if Ti is None else Pu / Rational(Ti), Pu / Rational(Td) if Td else 0
    assert settings == PID(Rational(Kp) * Ku, Ti, Td)


def test_good_gain():
    assert tuning.good_gain(1.5, 12) == PID(1.2, Ti=18)  # Haugen, Example 10.1
    assert tuning.good_gain(1.5, 12, "P") == PID(1.5)
    assert tuning.good_gain(Ku, Pu, "PID").Td == tuning.good_gain(Ku, Pu).Ti / 4


def test_hang_joins_at_the_ends_of_its_ranges():
    """At k = 2.25 the integral times meet, but the weights, which allow other overshoots, do not."""
    below, above = (tuning.hang(1, Rational("2.25") + change, 4) for change in (-Rational(1, 10**9), 0))
    assert float(above.settings.Ti - below.settings.Ti) == pytest.approx(0, abs=1e-8)
    assert [round(float(w.w_p), 3) for w in (below, above)] == [0.941, 0.739]
    assert tuning.hang(1, 15, 4).w_p == 0


@given(RANGE_OF_HANG, POSITIVE)
def test_hang_of_symbols_is_that_of_numbers(k, gain):
    formula, found = tuning.hang(K, Ku, Pu), tuning.hang(gain, k / gain, 5)
    numbers = {K: gain, Ku: k / gain, Pu: 5}
    assert formula.w_p.subs(numbers) == found.w_p
    assert formula.settings.Ti.subs(numbers) == found.settings.Ti
    assert sympy.expand(found.from_setpoint - found.settings.Kp * (found.w_p + 1 / (found.settings.Ti * s))) == 0


def test_hang_outside_of_its_range():
    assert tuning.hang(1, 1, 9, extrapolate=True).settings.Ti == 2  # mu = 4/9
    assert tuning.hang(1, 20, 9, extrapolate=True).w_p == Rational(-1, 7)


# What the empirical rules were made for, by exact poles and exact responses.


@pytest.mark.parametrize("r", [0, Rational(1, 10), Rational(1, 2), 1])
def test_cohen_and_coons_proportional_control_decays_to_a_quarter(r):
    process = SOPDT(1 / r, 1 / Rational(r), delay=1).expr if r else integrator(1, 1)
    pair = dominant_poles(tuning.cohen_coon(process, "P").expr * process)[0]
    assert float(oscillation_of_pole(pair).decay_ratio) == pytest.approx(0.25, abs=0.03)


@pytest.mark.parametrize("kind", ["P", "PI"])
def test_ziegler_and_nichols_decay_to_a_quarter_where_the_lag_is_infinite(kind):
    process = integrator(1, 1)
    pair = dominant_poles(tuning.ziegler_nichols_reaction(process, kind).expr * process)[0]
    assert float(oscillation_of_pole(pair).decay_ratio) == pytest.approx(0.25, abs=0.03)


def of_setpoint(C):
    """The setpoint's way to the control signal where the derivative term sees the measurement only."""
    return C.Kp * (1 + 1 / (C.Ti * s))


def least_itae(process, start, mode, measured):
    """The least ITAE that Nelder and Mead's search finds in sixty steps, in the logarithms."""

    def cost(x):
        C = PID(*np.exp(x).round(6))
        return criteria(process, C, mode, of_setpoint(C) if measured else None, tolerance=1e-4).ITAE

    begin = np.log([float(x) for x in (start.Kp, start.Ti, start.Td) if x != 0])
    simplex = np.vstack([begin, begin + 0.1 * np.eye(len(begin))])
    return minimize(cost, begin, method="Nelder-Mead", options={"maxfev": 60, "initial_simplex": simplex}).fun


@pytest.mark.parametrize(
    ("kind", "mode", "measured", "most"),
    [
        ("PI", "regulator", False, 1.05),
        ("PID", "regulator", False, 1.07),
        ("PI", "servo", False, 1.01),
        ("PID", "servo", True, 1.05),
    ],
)
@pytest.mark.daily(1)
def test_the_itae_rule_is_near_the_minimum(kind, mode, measured, most):
    process = first_order(1, 1, Rational(1, 2))
    settings = tuning.itae(process, kind, mode)
    found = criteria(process, settings, mode, of_setpoint(settings) if measured else None).ITAE
    assert 1 <= found / least_itae(process, settings, mode, measured) < most


def test_the_itae_settings_for_the_setpoint_are_for_a_derivative_of_the_measurement():
    process = first_order(1, 1, Rational(1, 5))
    PI, PID_ = (tuning.itae(process, kind, "servo") for kind in ("PI", "PID"))
    with_PI, of_the_error, of_the_measurement = (
        criteria(process, C, "servo", R).ITAE for C, R in ((PI, None), (PID_, None), (PID_, of_setpoint(PID_)))
    )
    assert of_the_measurement < 0.6 * with_PI < 0.6 * of_the_error


# The time constant of the closed loop.


def test_guidelines_for_the_closed_loop():
    process = first_order(K, T, delay)
    assert tuning.closed_loop_time(process) == delay
    range_ = tuning.closed_loop_time(process, "rivera")
    assert (range_.start, range_.end) == (Max(Rational("0.8") * delay, T / 10), oo)
    assert tuning.closed_loop_time(first_order(1, 20, 4), "chien") == sympy.Interval.open(4, 20)
    assert 4 in tuning.closed_loop_time(first_order(1, 20, 4), "rivera")
    assert tuning.closed_loop_time(integrator(1, 3)) == 3


@given(T=POSITIVE, delay=POSITIVE)
def test_skogestads_guideline_is_one_that_rivera_allows_unless_the_lag_is_long(T, delay):
    allowed = delay in tuning.closed_loop_time(SOPDT(1, T, delay=delay), "rivera")
    assert bool(allowed) == (delay > T / 10)


# A changed process.


def test_adjusted_as_the_book_says():
    """Haugen, Example 10.3: twice the gain halves Kp; twice the dead time halves Kp and doubles Ti."""
    settings = PID(Rational("0.7"), Ti=9)
    before = integrator(K, delay)
    assert tuning.adjusted(settings, before, integrator(2 * K, delay)) == PID(Rational("0.35"), Ti=9)
    assert tuning.adjusted(settings, before, integrator(K, 2 * delay)) == PID(Rational("0.35"), Ti=18)


def filtered(settings):
    """The same settings with a filter of a tenth of the derivative time."""
    return PID(settings.Kp, settings.Ti, settings.Td, settings.Td / 10, settings.form)


@settings(deadline=None)
@given(K=GAINS, T1=POSITIVE, T2=POSITIVE, delay=POSITIVE, scale=POSITIVE, slower=POSITIVE)
def test_adjusting_skogestads_settings_gives_skogestads_settings(K, T1, T2, delay, scale, slower):
    before = model_of(second_order(K, T1, T2, delay))
    after = model_of(second_order(scale * K, slower * T1, T2, delay))
    old, new = tuning.simc(before), tuning.simc(after)
    assert tuning.adjusted(filtered(old), before, after) == filtered(new)
    assert tuning.adjusted(old.parallel(), before, after) == new.parallel()
    assert tuning.adjusted(new, after, before) == old


@given(K=GAINS, T=POSITIVE, delay=POSITIVE, slower=POSITIVE)
def test_a_slower_process_makes_every_time_longer(K, T, delay, slower):
    """Also for a PID controller of a process for which Skogestad's is PI."""
    settings = PID(3, Ti=4, Td=1, Tf=Rational(1, 10))
    found = tuning.adjusted(settings, SOPDT(K, T, delay=delay), SOPDT(K, slower * T, delay=slower * delay))
    assert found == PID(3, slower * 4, slower, slower / 10)


def test_adjusted_of_a_P_controller():
    assert tuning.adjusted(PID(3), integrator(1), integrator(6), Tc=1) == PID(Rational(1, 2))


# What is refused.

LAG, LATE = first_order(1, 2), first_order(1, 2, 1)


@pytest.mark.parametrize(
    ("call", "message"),
    [
        (lambda: tuning.adjusted(PID(1, 2), SOPDT(1, 10, 3, 1), SOPDT(1, 10, delay=1)), "process of the same kind"),
        (lambda: tuning.simc(LAG), "no dead time to take Tc from: choose Tc"),
        (lambda: tuning.simc(LAG, Tc=0), "both 0: expected a positive Tc"),
        (lambda: tuning.simc(LATE, Tc=oo), "Tc is oo"),
        (lambda: tuning.simc(2 * exp(-s)), "needs a lag or an integrator.*give it a small lag"),
        (lambda: tuning.simc(0), "zero"),
        (lambda: tuning.simc(1 / (s + 1) ** 3, Tc=1), "half_rule"),
        (lambda: tuning.skogestad_integral_time(-1, 1, 1), "T1 is -1"),
        (lambda: tuning.skogestad_integral_time(5, 0, 0), "Tc . delay is 0: expected a positive number"),
        (lambda: tuning.skogestad_integral_time(0, 1, 1), "T1 is 0: expected a positive number"),
        (lambda: tuning.ziegler_nichols_reaction(LAG), "no dead time: .* infinite gain"),
        (lambda: tuning.ziegler_nichols_reaction(LATE, "PD"), "kind is 'PD': expected one of P, PI, PID"),
        (lambda: tuning.ziegler_nichols_reaction(second_order(1, 5, 2, 1)), "one lag or integrator .* half_rule"),
        (lambda: tuning.cohen_coon(exp(-s)), "needs a lag"),
        (lambda: tuning.itae(LATE, "P"), "kind is 'P': expected one of PI, PID"),
        (lambda: tuning.itae(LATE, mode="load"), "mode is 'load': expected one of servo, regulator"),
        (lambda: tuning.itae(integrator(1, 1)), "integrating"),
        (lambda: tuning.itae(first_order(1, 1, 2)), "delay/T is 2.000: expected 1/10 to 1; extrapolate"),
        (lambda: tuning.itae(first_order(1, 1, 7), mode="servo", extrapolate=True), "no positive integral time"),
        (lambda: tuning.ziegler_nichols_ultimate(0, 1), "Ku is 0: expected a number other than zero"),
        (lambda: tuning.ziegler_nichols_ultimate(1, 0), "Pu is 0: expected a positive number"),
        (lambda: tuning.modified_ziegler_nichols(1, 1, "little"), "overshoot is 'little': expected one of some, none"),
        (lambda: tuning.tyreus_luyben(1, 1, "P"), "kind is 'P': expected one of PI, PID"),
        (lambda: tuning.good_gain(0, 1), "KpGG is 0"),
        (lambda: tuning.good_gain(1, 0), "Tou is 0"),
        (lambda: tuning.hang(0, 1, 1), "K is 0"),
        (lambda: tuning.hang(1, 1, 1), "K.Ku is 1.000: expected 3/2 to 15"),
        (lambda: tuning.closed_loop_time(LAG), "no dead time"),
        (lambda: tuning.closed_loop_time(LATE, "morari"), "guideline is 'morari'"),
        (lambda: tuning.closed_loop_time(integrator(1, 1), "rivera"), "one lag with dead time"),
        (lambda: tuning.closed_loop_time(first_order(1, 1, 2), "chien"), "no Tc lies between"),
        (lambda: tuning.adjusted(PID(1, 2), LAG, LAG), "choose Tc"),
        (lambda: tuning.adjusted(2, LATE, LATE), "settings are 2: expected a PID"),
    ],
)
def test_what_is_refused(call, message):
    with pytest.raises(ValueError, match=message):
        call()
