"""The simulator against exact solutions, and what it refuses."""

import inspect
import math
from itertools import pairwise

import numpy as np
import pytest
import sympy
from hypothesis import given, settings
from hypothesis import strategies as st
from scipy.integrate import quad

from draws import draws
from loopbook import plants, s, t
from loopbook.deadtime import System
from loopbook.laplace import evaluate
from loopbook.pid import PID, Controller
from loopbook.plants import (
    BlendingTank,
    BufferTank,
    HeatedTank,
    HeatedTankWithTransport,
    LiquidTank,
    MassSpringDamper,
    Plant,
    Process,
    RCCircuit,
    WoodChipTank,
    name_of,
)
from loopbook.signals import stepwise
from loopbook.simulation import delayed_states, driver, held, integrator, simulate
from loopbook.transfer import feedback, first_order, response, step_response

EXACT = 1e-6  # relative to the size of the response


def close(computed, exact):
    return np.abs(computed - exact).max() <= EXACT * max(1, np.abs(exact).max())


# The plant alone: against the response of its transfer function, which SymPy inverts where it can.

OPEN = [cls() for _, cls in inspect.getmembers(plants, inspect.isclass) if issubclass(cls, Plant) and cls.quantities]
OPEN += [
    MassSpringDamper(D=0),
    WoodChipTank(tau=0),
    HeatedTank(U_h=0, P=8400),
    plants.AirHeaterWithFan(d=60, T_rise=18.5 / 1.16**0.5),
    plants.BatchTank(h=0.9),
]
WAYS = [(plant, name_of(x)) for plant in OPEN for x in plant.inputs]


@pytest.mark.parametrize(("plant", "source"), WAYS, ids=[f"{type(plant).__name__}-{x}" for plant, x in WAYS])
@pytest.mark.daily(8)
def test_where_an_input_acts_linearly_a_step_response_is_the_analytic_one(plant, source):
    if not plant.is_linear(source):
        return
    name, H = name_of(plant.output), plant.transfer_function(source, numbers=True)
    times = np.linspace(0, System(H).horizon() if H else 100, 151)
    recycles = H != 0 and len(System(H).denominator) > 1  # no end of echoes
    response = System(H).step(times) if recycles else evaluate(step_response(H, 1), times)
    low, high = (plant.numbers(sympy.sympify(x)) for x in plant.limits.get(plant.output, (-sympy.oo, sympy.oo)))
    at_rest = getattr(plant, name)
    size = float(min(1, (at_rest - low) / 2, (high - at_rest) / 2))
    change = size / (np.abs(response).max() or 1)
    run = simulate(plant, until=times[-1], step=times[1], **{source: getattr(plant, source) + change})
    assert np.abs(run[name] - float(at_rest) - change * response).max() <= EXACT * size


@settings(deadline=None, max_examples=draws(25))
@given(st.fractions("1/9", 4, max_denominator=9), st.fractions(0, 3, max_denominator=9))
def test_dead_time_needs_no_grid(ratio, moment):
    """Delays shorter or longer than a step, and steps of the input between the samples, are met exactly."""
    delay, moment = sympy.Rational(ratio), sympy.Rational(moment)
    H = sympy.exp(-delay * s) * 2 / ((3 * s + 1) * (s + 1))
    u = 3 * sympy.Heaviside(t - moment) - 5 * sympy.Heaviside(t - 2 * moment - 1)
    run = simulate(Process(H), until=12, step=0.75, u=u)
    assert close(run["y"], evaluate(response(H, u), run.times))


@pytest.mark.parametrize("u", [sympy.sin(t), t * sympy.exp(-t), t * sympy.Heaviside(t - 2) + 1])
def test_signals_that_change_all_the_time_are_integrated_too(u):
    H = sympy.exp(-sympy.Rational(3, 2) * s) / (2 * s + 1)
    run = simulate(Process(H), until=20, step=1, u=u, d=0)
    assert close(run["y"], evaluate(response(H, u), run.times))


def test_an_array_is_held_between_the_samples():
    levels = np.array([1.0, 1, 4, -2, 0, 0])
    u = sum((new - old) * sympy.Heaviside(t - k) for k, (old, new) in enumerate(pairwise([0, *levels])))
    run = simulate(Process(1 / (s + 1)), until=5, step=1, u=levels)
    assert close(run["y"], evaluate(response(1 / (s + 1), sympy.nsimplify(u)), run.times))
    assert (run["u"] == levels).all()


def test_a_plant_that_is_not_linear():
    """With a flow q that changes, V c' = w - c q is still linear in c; here it is solved by an integrating factor."""
    tank = BlendingTank()
    run = simulate(tank, until=600, step=5, q=0.01 + t / 20000)
    V, w, c_0 = float(tank.V), float(tank.w_A), float(tank.c_A)
    turned_over = np.polynomial.Polynomial([0, 0.01, 1 / 40000]) / V  # the integral of q/V
    put_in = [quad(lambda x: math.exp(turned_over(x)) * w / V, 0, time, epsabs=1e-12)[0] for time in run.times]
    assert close(run["c_A"], np.exp(-turned_over(run.times)) * (c_0 + np.array(put_in)))


# Dead time within the plant, and several of them.

E, SHORT = sympy.exp, sympy.Rational(1, 50)
WITH_DEAD_TIMES = {
    "two at the input": (E(-s) + 2 * E(-5 * s / 2)) / ((2 * s + 1) * (s + 1)),
    "two that differ by whole steps": (E(-s / 10) + E(-7 * s / 10) + E(-13 * s / 10) - E(-31 * s / 10)) / (s + 1),
    "one around an integrator": 1 / (s + E(-s)),
    "a recycle": (s + 1) * E(-s / 2) / (2 * (s + 1) * (3 * s + 1) - E(-7 * s / 3) / 2),
    "two inside": (s + 2 + E(-s / 5)) / (s**2 + 3 * s + 2 + s * E(-13 * s / 10) / 2 - E(-2 * s) / 3),
    "one far shorter than the step": 1 / (s + 1 + E(-SHORT * s)),
    "one beside a lag far shorter": 1 / ((s + 1) * (s / 200 + 1) - E(-s) / 2),
}
INSIDE = pytest.mark.parametrize("H", WITH_DEAD_TIMES.values(), ids=WITH_DEAD_TIMES)


@INSIDE
def test_dead_time_anywhere_is_exact(H):
    u = 3 * sympy.Heaviside(t - sympy.Rational(3, 10)) - 5 * sympy.Heaviside(t - sympy.Rational(41, 10))
    run = simulate(Process(H), until=10, step=0.5, u=u, d=sympy.sin(t))
    exact = System(H).response(run.times, u + sympy.sin(t))
    assert np.abs(run["y"] - exact).max() < 1e-8


@INSIDE
@pytest.mark.daily(3)
def test_dead_time_anywhere_is_exact_under_a_sampled_controller(H):
    run = simulate(Process(H), Controller(PID(0.5, Ti=4), step=0.3), until=15, setpoint=stepwise(1, {6: 0.5}))
    assert np.abs(run["y"] - System(H).response(run.times, run["u"])).max() < 1e-8
    assert np.ptp(run["u"]) > 0.1


class Recycle(Plant):
    """A stirred reactor, a part of whose product comes back some time later, and a pipe to the analyser."""

    V, q = plants.parameter(2, "m³", "volume"), plants.parameter(0.5, "m³/s", "flow through the reactor")
    r, k = plants.parameter(0.4, "1", "share that comes back"), plants.parameter(0.1, "1/s", "rate of the reaction")
    tau = plants.parameter(7, "s", "time on the way back")
    tau_m = plants.parameter(3, "s", "time in the pipe to the analyser")
    c_in = plants.signal(1.5, "mol/m³", "concentration of the feed")
    c = plants.signal(0.9, "mol/m³", "concentration")
    c_m = plants.measured(plants.delayed(c, tau_m), "mol/m³", "measured concentration")
    moles = plants.Balance(V * c, (1 - r) * q * c_in + r * q * plants.delayed(c, tau) - q * c - k * V * c)
    output, manipulated = c_m, c_in


def recycle_loop(step):
    return Controller(PID(0.8, Ti=12), step, u0=1.5, limits=(0, 5))


@pytest.mark.parametrize("tau", [7, 0.3, 0])
@pytest.mark.parametrize("step", [1, 0.7])
@pytest.mark.daily(2)
def test_a_dead_time_in_a_balance_is_exact(tau, step):
    plant = Recycle(tau=tau, tau_m=3 if tau > 1 else 0.4)  # also shorter than a step
    run = simulate(plant, recycle_loop(step), until=70, setpoint=1)
    H = System(plant.numbers(plant.transfer_function()))
    assert np.abs(run["c_m"] - 0.9 - H.response(run.times, run["c_in"] - 1.5)).max() < 1e-8
    assert run["c_m"][-1] == pytest.approx(1, abs=0.01)


@pytest.mark.parametrize(("before", "after"), [(7, 15), (0, 4)])
def test_a_plant_goes_on_with_another_dead_time_inside(before, after):
    """What comes back at first was there before."""
    first = simulate(Recycle(tau=before), until=20, step=1, c_in=2)
    run = simulate(Recycle(tau=after), until=60, step=1, c_in=2, after=first)
    now = np.arange(20 + after - before, 50)
    rates = (0.3 * 2 + 0.2 * run["c"][now - after] - 0.7 * run["c"][now]) / 2
    assert np.gradient(run["c"], 1.0)[now] == pytest.approx(rates, abs=2e-3)


def test_a_stiff_plant_with_a_delayed_state():
    """Far too stiff for the explicit method: x' = 1e5 (u - x + x(t - 1)/2), u a step, is a geometric series."""
    run = simulate(Process(1e5 / (s + 100_000 * (1 - sympy.exp(-s) / 2))), until=6, step=0.5, u=1)
    steps = np.floor(run.times[1:] - 1e-9)
    assert run["y"][2::2] == pytest.approx(2 - 0.5 ** steps[1::2], abs=1e-6)


def test_a_run_that_needs_too_many_steps_does_not_grow_beyond_all_numbers(monkeypatch):
    for module, H in ((delayed_states, 1 / (s**2 + 1 + sympy.exp(-50 * s) / 100)), (integrator, 1 / (s**2 + 1))):
        monkeypatch.setattr(module, "MOST_STEPS", 10)
        monkeypatch.setattr(delayed_states, "TOO_STIFF", 10)
        with pytest.raises(
            ValueError, match="x_2 needs more than 10 steps between t = 0 and 50: an oscillation is too fast"
        ):
            simulate(Process(H), until=100, step=50, u=t)


def test_the_history_is_no_longer_than_the_longest_dead_time_until_more_is_asked():
    runs = [simulate(Recycle(), until=until, step=1, c_in=2 + sympy.sin(t)) for until in (50, 250)]
    short, long = (run._past.integrator for run in runs)
    assert len(long.pieces) < 2 * len(short.pieces)
    assert long.oldest > 230
    moments = np.linspace(0.3, 40.3, 60)
    before = [long.trace[n] for n in range(len(long.times))]
    asked = [long.state_at(moment)[0] for moment in moments]
    assert long.trace == before
    assert len(long.pieces) > 3 * len(short.pieces)
    every = simulate(Recycle(tau_m=45), until=50, step=1, c_in=2 + sympy.sin(t))._past.integrator  # which keeps it all
    assert every.oldest == 0
    assert asked == pytest.approx([every.state_at(moment)[0] for moment in moments], abs=1e-9)


# A linear plant whose inputs are held.

HELD = {
    "a lag, two dead times": (E(-13 * s / 10) + 2 * E(-4 * s)) / (5 * s + 1),
    "an integrator": E(-s / 2) / (s * (2 * s + 1)),
    "a resonance": 2 / (9 * s**2 + s / 2 + 1),
    "stiff": E(-s / 3) / ((s + 1) * (s / 10_000 + 1)),
    "unstable": E(-s / 5) / (20 * s - 1),
}
STEPS = {"setpoint": stepwise(1, {20: 0.5}), "d": stepwise(0, {sympy.Rational(123, 10): 0.4})}


@pytest.mark.parametrize("H", HELD.values(), ids=HELD)
@pytest.mark.parametrize(
    "settings",
    [{}, {"limits": (0, 1.2), "T_filter": 0.5}, {"ramp": 0.2, "w_p": 0.3, "control_range": (-1, 3)}],
    ids=["PI", "limits", "ramp"],
)
@pytest.mark.daily(3)
def test_what_is_held_goes_from_sample_to_sample_by_a_recurrence(H, settings, monkeypatch):
    """Exact to rounding; and, in parts, with noise and by hand, what the integration says to its tolerance."""

    def run(plant=Process(H)):  # noqa: B008
        controller, more = Controller(PID(0.4, Ti=6), 0.7, **settings), STEPS | {"noise": 0.02}
        first = simulate(plant, controller, until=21, manual=[(7, 10, 0.3), (14, 15, None)], **more)
        assert isinstance(first._past.integrator, kind)
        later = simulate(plant, Controller(PID(0.3, Ti=6), 0.5, **settings), until=40, after=first, **more)
        return later, simulate(plant, controller, until=42, setpoint=1)

    kind = held.HeldIntegrator
    now, exact = run()
    assert close(exact["y"] * 1e5, System(H).response(exact.times, exact["u"]) * 1e5)
    kind = integrator.PlantIntegrator
    monkeypatch.setattr(driver, "_integrator", kind)
    before, _ = run()
    for name in before.signals:
        assert now[name] == pytest.approx(before[name], rel=1e-6, abs=1e-6), name


def test_a_plant_alone_is_a_recurrence_too():
    times = np.arange(2001) * 0.7
    u = np.random.default_rng(1).normal(size=2001)
    for H in (2 * E(-13 * s / 10) / (5 * s + 1), 1 / (9 * s**2 + s / 2 + 1), 1 / (3 * s + 1) ** 4):
        run = simulate(Process(H), until=times[-1], step=0.7, u=u)
        assert np.abs(run["y"] - System(H).response(run.times, u)).max() < 1e-11


def test_an_input_that_stays_may_act_in_a_product():
    tank, P = HeatedTank(), stepwise(10_000, {10: 9000})
    run = simulate(tank, until=100, step=1, P=P, F=0.3)
    assert type(run._past.integrator) is held.HeldIntegrator
    steps = np.diff(run["T"])[10:]
    assert steps[1:] / steps[:-1] == pytest.approx(math.exp(-(0.3 * 4200 + 160) / (100 * 4200)), abs=1e-9)
    run = simulate(tank, until=100, step=1, P=P, F=stepwise(0.3, {50: 0.2}))
    assert type(run._past.integrator) is integrator.PlantIntegrator


# Limits.


class RecycleWithRim(Plant):
    """A vessel out of which flows what was in it a second ago."""

    u = plants.signal(0, "1/s", "inflow")
    x = plants.signal(0, "1", "level", limits=(0, sympy.Rational(1, 2)))
    volume = plants.Balance(x, u - plants.delayed(x, 1))
    output, manipulated = x, u


def test_a_level_with_a_dead_time_stays_within_its_limits_too():
    run = simulate(RecycleWithRim(), until=6, step=0.3, u=stepwise(1, {3: 0}))
    falling = np.interp(run.times, [0, 0.5, 3, 4], [0, 0.5, 0.5, 0])  # for a second what flows out is what was there
    assert run["x"] == pytest.approx(falling, abs=1e-6)


def test_a_level_stays_within_its_limits_and_leaves_them_at_once():
    run = simulate(LiquidTank(), until=40, step=1, q_i=stepwise(0.1, {15: 0, 25: 0.05}), q_o=stepwise(0, {15: 0.15}))
    exact = np.interp(run.times, [0, 5, 15, 15 + 1 / 0.15, 40], [0.5, 1, 1, 0, 0])
    assert run["h"] == pytest.approx(exact, abs=1e-9)


def test_a_concentration_is_never_negative():
    run = simulate(BlendingTank(), until=1000, step=10, w_A=-0.05)
    assert run["c_A"].min() == 0


# The loop.


def method_of_steps(k, delay=1):
    """Setpoint response of y' = k (1 - y(t - delay)), integrated from one multiple of the delay to the next."""
    terms = [-((-k) ** (n + 1)) * (t - (n + 1) * delay) ** (n + 1) / sympy.factorial(n + 1) * sympy.Heaviside(
        t - (n + 1) * delay) for n in range(12)]  # fmt: skip
    return sum(terms)


def test_a_loop_with_dead_time_approaches_the_exact_one_with_the_order_of_the_held_control_signal():
    errors = []
    for step in (0.1, 0.05, 0.025, 0.0125):
        run = simulate(Process(sympy.exp(-s) / s), Controller(PID(0.5), step), until=10, setpoint=1)
        errors.append(np.abs(run["y"] - evaluate(method_of_steps(sympy.Rational(1, 2)), run.times)).max())
    orders = [math.log2(coarse / fine) for coarse, fine in pairwise(errors)]
    assert orders == pytest.approx([1, 1, 1], abs=0.05)
    assert errors[-1] < 0.003


def test_a_sampled_loop_is_that_of_its_difference_equation():
    """y' = u(t - 1), held: y rises by step*u(k - n) in each step; exact to rounding."""
    step, n = 0.25, 4
    run = simulate(Process(sympy.exp(-s) / s), Controller(PID(0.5, 10), step), until=20, setpoint=1)
    y, u, integral = [0.0], [], 0.0
    for k in range(len(run.times)):
        error = 1 - y[k]
        u.append(0.5 * error + integral)
        integral += 0.5 * step / 10 * error
        y.append(y[k] + step * (u[k - n] if k >= n else 0))
    assert run["y"] == pytest.approx(y[:-1], abs=1e-9)
    assert run["u"] == pytest.approx(u, abs=1e-9)


@pytest.mark.parametrize("pid", [PID(2, 5), PID(2, 5, 1, 0.1), PID(2)])
def test_a_loop_without_dead_time_approaches_the_transfer_functions_of_the_closed_loop(pid):
    process, errors = 1 / ((4 * s + 1) * (s + 1)), []
    exact = step_response(feedback(pid.expr * process)) - step_response(feedback(process, pid.expr)) / 2
    for step in (0.02, 0.01):
        run = simulate(Process(process), Controller(pid, step), until=15, setpoint=1, d=-0.5)
        errors.append(np.abs(run["y"] - evaluate(exact, run.times)).max())
    assert errors[1] < 0.01
    assert errors[0] / errors[1] == pytest.approx(2, rel=0.1)


def chip_loop(**changes):
    settings = {"step": 5, "u0": 45, "limits": (0, 100), "measurement_range": (0, 15), "T_filter": 20} | changes
    return Controller(PID(1.35, 917), **settings)


def test_what_a_run_contains():
    run = simulate(
        WoodChipTank(), chip_loop(), until=500, setpoint=10, noise=0.05, seed=3, w_out=stepwise(25, {100: 30})
    )
    assert set(run.signals) == {
        "h", "u", "w_out", "setpoint", "measurement", "ramped", "filtered", "u_p", "u_i", "u_d",
    }  # fmt: skip
    assert all(len(values) == len(run.times) == 101 for values in run.signals.values())
    assert run["w_out"][[0, 19, 20, 100]].tolist() == [25, 25, 30, 30]
    assert run["u"] == pytest.approx(45 + run["u_p"] + run["u_i"] + run["u_d"])
    assert 0.03 < (run["measurement"] - run["h"]).std() < 0.07
    assert [run.unit(name) for name in ("h", "setpoint", "measurement", "filtered")] == 4 * ["m"]
    assert [run.unit(name) for name in ("u", "u_p", "u_i", "u_d")] == 4 * ["%"]
    with pytest.raises(ValueError, match="'x' is not a signal of WoodChipTank"):
        run.unit("x")
    in_percent = Controller(PID(1.35, 917), 5, u0=50, control_range=(0, 90), measurement_range=(0, 15))
    later = simulate(WoodChipTank(), in_percent, until=700, setpoint=10, after=run)
    assert (later.unit("u_p"), simulate(WoodChipTank(), until=800, step=5, after=later).unit("u_p")) == ("%", "%")
    assert repr(run) == (
        "<run of 101 samples, t = 0 to 500: h, u, w_out, setpoint, measurement, ramped, filtered, u_p, u_i, u_d>"
    )


def test_noise_is_the_same_for_the_same_seed_and_goes_on_as_noise_of_its_own():
    controller = chip_loop()
    one, two, other = (
        simulate(WoodChipTank(), controller, until=500, setpoint=11, noise=0.05, seed=seed) for seed in (1, 1, 2)
    )
    assert (one["h"] == two["h"]).all()
    assert (one["h"] != other["h"]).any()
    assert controller.u is None  # a run does not change its controller
    longer = simulate(WoodChipTank(), controller, until=1000, setpoint=11, noise=0.05, after=one)
    added = longer["measurement"] - longer["h"]
    assert abs(np.corrcoef(added[:100], added[100:200])[0, 1]) < 0.4


def test_manual_mode_for_a_while():
    run = simulate(WoodChipTank(), chip_loop(), until=2000, setpoint=10.5, manual=[(100, 300, None), (300, 500, 40)])
    held = run["u"][19]
    assert (run["u"][20:60] == held).all()
    assert (run["u"][60:100] == 40).all()
    assert run["u"][100] == pytest.approx(40)


def test_feedforward_is_added():
    tank = BufferTank(F_in=2, F_out=2)
    controller = Controller(PID(1), 1, limits=(0, 5), pid_limits=(-5, 5))
    run = simulate(tank, controller, until=50, setpoint=1, F_out=2 + sympy.sin(t / 5), feedforward=2 + sympy.sin(t / 5))
    # what is left is the holding of the control signal: half a step of it, over the density times the area
    assert np.abs(run["h"] - 1).max() < 1.02 * 0.5 * 1 / (1000 * 0.2)
    assert run["F_in"] == pytest.approx(2 + np.sin(run.times / 5), abs=0.01)


# A run that goes on.

TRANSPORT = Controller(PID(5, 300), 10, u0=40, limits=(0, 100))
IN_PARTS = {
    "chips": (WoodChipTank(), chip_loop(), [255, 300, 1000], {"w_out": stepwise(25, {400: 30}) + sympy.sin(t / 100)}),
    "recycle": (Recycle(), recycle_loop(1), [9, 12, 60], {}),
    "transport": (HeatedTankWithTransport(tau=72.3), TRANSPORT, [300, 500, 1000], {}),
}


@pytest.mark.parametrize("name", IN_PARTS)
def test_a_run_in_parts_is_the_whole_run(name):
    plant, controller, parts, signals = IN_PARTS[name]
    rest = getattr(plant, name_of(plant.output))
    signals |= {"setpoint": stepwise(float(rest), {parts[0] // 2: float(rest) * 1.1})}
    whole, run = simulate(plant, controller, until=parts[-1], **signals), None
    for until in parts:
        run = simulate(plant, controller, until=until, after=run, **signals)
    assert run.times.tolist() == whole.times.tolist()
    for name in whole.signals:
        assert run[name] == pytest.approx(whole[name], abs=1e-8), name


def test_new_settings_and_a_new_delay_take_effect_from_their_moment_on():
    first = simulate(WoodChipTank(), chip_loop(), until=1000, setpoint=11)
    longer = simulate(WoodChipTank(tau=600), chip_loop(), until=3000, setpoint=11, after=first)
    assert (longer["h"][:201] == first["h"]).all()
    # what now arrives was put on the belt 600 s ago
    slope = np.diff(longer["h"]) / 5
    arrived = (float(WoodChipTank().K_s) * longer["u"] - 25) / (145 * 13.4)
    assert slope[320:500] == pytest.approx(arrived[200:380], abs=1e-9)


def test_an_open_run_before_a_closed_one():
    first = simulate(RCCircuit(), until=2, step=0.5, v_in=3)
    run = simulate(RCCircuit(), Controller(PID(2, 1), 0.5), until=10, setpoint=1, after=first)
    assert np.isnan(run["setpoint"][:4]).all()
    assert run["v_out"][:5].tolist() == first["v_out"].tolist()
    assert run["v_in"][4] == pytest.approx(3)  # from which the controller begins
    assert run["v_out"][-1] == pytest.approx(1, abs=0.05)


@pytest.mark.parametrize("tau", [65, 72.3])
def test_a_delayed_output_needs_no_grid(tau):
    """The sensor tells what the tank was at that time, on a grid ten times finer."""
    tank = HeatedTankWithTransport(tau=tau)
    run = simulate(tank, TRANSPORT, until=1000, setpoint=stepwise(40, {100: 45}))
    finer = simulate(tank, until=1000, step=0.1, u=np.repeat(run["u"], 100)[: 10_000 + 1])
    assert run["T"][20:] == pytest.approx(np.interp(run.times[20:] - tau, finer.times, finer["T_1"]), abs=1e-4)


def test_new_settings_do_not_move_a_loop_at_rest():
    weighted = chip_loop(w_p=0.3)
    run = simulate(WoodChipTank(), weighted, until=500, setpoint=10)
    run = simulate(
        WoodChipTank(), Controller(PID(2, 917), 5, u0=45, measurement_range=(0, 15)), until=1000, setpoint=10, after=run
    )
    assert run["u"] == pytest.approx(45)


def test_another_process_goes_on_from_the_same_output():
    run = simulate(Process(1 / (s + 1)), until=10, step=1, u=1)
    run = simulate(Process(1 / (2 * s + 1)), until=12, step=1, u=1, after=run)
    assert run["y"] == pytest.approx(
        1 - np.exp(-np.minimum(run.times, 10)) * np.exp(-np.maximum(run.times - 10, 0) / 2)
    )


def test_the_controller_may_act_on_another_input():
    tank = BufferTank(F_in=3, F_out=3)
    controller = Controller(PID(6), 1, u0=3, action="direct")
    run = simulate(tank, controller, until=400, setpoint=1, F_in=4, manipulated="F_out")
    # at rest: 4 kg/s = 3 kg/s + 6 kg/(m s) times the level above its setpoint
    assert run["h"][-1] == pytest.approx(1 + 1 / 6, abs=1e-4)
    assert run.manipulated == "F_out"


class OnOff:
    """A controller of one's own."""

    step = 1.0

    def update(self, setpoint, measurement, feedforward=0, manual=None):
        return 10.0 if measurement < setpoint else 0.0


def test_any_object_with_a_step_and_an_update_is_a_controller():
    tank = HeatedTank()
    run = simulate(tank, OnOff(), until=10, setpoint=40)
    assert set(run["P"]) == {10.0}
    assert "u_p" not in run.signals
    longer = simulate(tank, OnOff(), until=20, setpoint=20, after=run)
    assert longer["P"].tolist() == 10 * [10] + 11 * [0]
    pid = simulate(tank, Controller(PID(1, 100), 1), until=40, setpoint=30, after=longer)
    assert pid["P"][20] == pytest.approx(0, abs=1e-12)  # it begins as after manual mode


@pytest.mark.parametrize("scale", [1e-9, 1e-3, 1, 1e6, 1e12])
def test_the_unit_of_time_does_not_matter(scale):
    exact = evaluate(step_response(first_order(1, 1, delay=sympy.Rational(3, 10))), np.arange(51) / 10)
    T, delay = sympy.Rational(scale), sympy.Rational(3, 10) * sympy.Rational(scale)
    run = simulate(Process(sympy.exp(-delay * s) / (T * s + 1)), until=5 * scale, step=scale / 10, u=1)
    assert run["y"] == pytest.approx(exact, abs=1e-6)


def test_one_moment_is_one_sample_for_all_signals():
    """Seven times 0.7 is 4.9 and not a little less."""
    controller, step = Controller(PID(1), 0.7), stepwise(0, {4.9: 1})
    run = simulate(
        Process(1 / (s + 1)), controller, until=14, setpoint=step, d=step, feedforward=step, manual=[(4.9, 7, 3)]
    )
    assert run["setpoint"].tolist() == run["d"].tolist() == 7 * [0] + 14 * [1]
    assert run["u"][7:11].tolist() == [3, 3, 3, pytest.approx(3)]


def test_a_level_at_its_limit_with_an_inflow_that_changes_all_the_time():
    run = simulate(LiquidTank(h=0.95), until=40, step=2, q_i=sympy.sin(t) / 10, q_o=0)
    level, exact = 0.95, [0.95]
    for start in np.arange(0, 40, 2):  # stepped finely
        for time in start + 1e-4 * np.arange(20_000):
            level = min(1, max(0, level + 1e-4 * math.sin(time + 5e-5) / 10))
        exact.append(level)
    assert run["h"] == pytest.approx(exact, abs=1e-5)


@pytest.mark.parametrize("T", ["1/1000", "1/100000"])
def test_a_lag_far_shorter_than_the_step(T):
    H = 1 / ((s + 1) * (sympy.Rational(T) * s + 1))
    run = simulate(Process(H), until=10, step=1, u=1)
    assert close(run["y"], evaluate(step_response(H), run.times))


# What is refused.

TANK, LOOP = WoodChipTank(), chip_loop()


class Early(Plant):
    """It would have to know the future."""

    u, x = plants.signal(0, "1", "input"), plants.signal(0, "1", "state")
    law = plants.Balance(x, plants.delayed(u, -1) - x)
    output, manipulated = x, u


class AtOnce(Plant):
    """Its output has the input in it."""

    u, x = plants.signal(0, "1", "input"), plants.signal(0, "1", "state")
    y = plants.measured(x + u, "1", "output")
    decay = plants.Balance(x, -x)
    output, manipulated = y, u


class Dividing(Plant):
    """It divides by zero on its way, within SciPy's solver, which would not come back from an error there."""

    x, u = plants.signal(0, "1", "state"), plants.signal(-1, "1", "input")
    law = plants.Balance(x, u / x)
    output, manipulated = x, u


REFUSED = {
    "a plant in a sampled loop that responds at once": (
        lambda: simulate(AtOnce(), Controller(PID(1), 1), until=10, setpoint=1),
        "at once",
    ),
    "a division by zero on the way": (
        lambda: simulate(Dividing(), until=2, step=1),
        "x grows beyond all numbers before t = 1",
    ),
    "a missing step": (lambda: simulate(TANK, until=100), "step is missing"),
    "a step of zero": (lambda: simulate(TANK, until=100, step=0), "step is 0"),
    "an end that is not a number": (lambda: simulate(TANK, until=math.nan, step=1), "until is nan"),
    "an end between two samples": (lambda: simulate(TANK, until=10.5, step=1), "whole number of steps"),
    "a dead time before its time": (lambda: simulate(Early(), until=10, step=1), "u acts 1 before its time"),
    "a dead time inside far too short": (
        lambda: simulate(Recycle(tau=1e-9), until=10, step=1),
        "the dead time 1e-09 inside the plant makes 10000000000 stretches",
    ),
    "two different steps": (lambda: simulate(TANK, LOOP, until=100, step=1, setpoint=10), "runs every 5"),
    "a missing setpoint": (lambda: simulate(TANK, LOOP, until=100), "setpoint is missing"),
    "a setpoint for nobody": (lambda: simulate(TANK, until=100, step=1, setpoint=10), "no controller"),
    "two hands on one valve": (lambda: simulate(TANK, LOOP, until=100, setpoint=10, u=5), "controller that sets it"),
    "an unknown input": (lambda: simulate(TANK, until=100, step=1, q=5), "no input 'q': expected one of u, w_out"),
    "a letter in a signal": (lambda: simulate(TANK, until=100, step=1, u=sympy.Symbol("K")), "u: .*number for K"),
    "an impulse": (lambda: simulate(TANK, until=100, step=1, u=sympy.DiracDelta(t)), "impulse"),
    "a signal that is text": (lambda: simulate(TANK, until=100, step=1, u="45"), "u: '45' is of type str"),
    "a short array": (lambda: simulate(TANK, until=100, step=1, u=[1, 2, 3]), "u has 3 values for 101 samples"),
    "NaN in an array": (lambda: simulate(TANK, until=2, step=1, u=[1, math.nan, 3]), "u is nan at t = 1"),
    "NaN as a number": (lambda: simulate(TANK, LOOP, until=100, setpoint=math.nan), "setpoint: nan is not a number"),
    "negative noise": (lambda: simulate(TANK, LOOP, until=100, setpoint=10, noise=-1), "deviation is -1"),
    "half a stretch by hand": (lambda: simulate(TANK, LOOP, until=100, setpoint=10, manual=[(0, 5)]), "manual has"),
    "another plant's run": (
        lambda: simulate(RCCircuit(), until=20, step=1, after=simulate(TANK, until=10, step=1)),
        "has the inputs",
    ),
    "a class for a plant": (lambda: simulate(WoodChipTank, until=10, step=1), "the plant is"),
    "a plant for the earlier run": (lambda: simulate(TANK, until=10, step=1, after=TANK), "after is"),
    "settings for a controller": (lambda: simulate(TANK, PID(1), until=10, setpoint=1), "the controller is PID"),
    "noise for nobody": (lambda: simulate(TANK, until=10, step=1, noise=1), "noise is given, but no controller"),
    "an unknown manipulated input": (
        lambda: simulate(TANK, LOOP, until=10, setpoint=1, manipulated="h"),
        "has no input 'h'",
    ),
    "a manual mode that ends before it begins": (
        lambda: simulate(TANK, LOOP, until=10, setpoint=1, manual=[(300, 100, 40)]),
        "the beginning before the end",
    ),
    "a manual mode that is a number": (lambda: simulate(TANK, LOOP, until=10, setpoint=1, manual=5), "manual is 5"),
    "a seed that is none": (lambda: simulate(TANK, LOOP, until=10, setpoint=1, noise=1, seed=0.5), "seed is 0.5"),
    "an endless run": (lambda: simulate(TANK, until=1e12, step=1), "at most"),
    "a signal without a value": (lambda: simulate(TANK, until=10, step=1, w_out=sympy.log(t)), "w_out"),
    "a signal with a hole between the samples": (
        lambda: simulate(TANK, until=10, step=1, w_out=1 / (t - sympy.Rational(15, 2))),
        "between t = 7 and 8: an oscillation is too fast for the step, or a signal infinite",
    ),
    "parameters that divide by zero": (lambda: simulate(RCCircuit(R=0), until=10, step=1), "divides by zero"),
    "a controller that returns nothing": (
        lambda: simulate(TANK, type("Silent", (OnOff,), {"update": lambda *a, **k: None})(), until=10, setpoint=1),
        "gives u = None at t = 0: expected a finite number",
    ),
    "a signal that the run lacks": (lambda: simulate(TANK, until=10, step=1)["setpoint"], "no signal 'setpoint'"),
    "an unstable plant": (
        lambda: simulate(Process(1 / (s - 1)), until=2000, step=1, u=1),
        "grows beyond all numbers before t = 7",
    ),
}


@pytest.mark.parametrize("case", REFUSED)
def test_what_is_refused_in_one_sentence(case):
    call, message = REFUSED[case]
    with pytest.raises(ValueError, match=message) as caught:
        call()
    assert "\n" not in str(caught.value)
