"""What exact dead time costs and gives: `make bench` prints this library beside its peers, and errors beside times.

The peers are in `peers.py`: python-control with Pade approximations of order 10, the same in NumPy's arrays where that
is quicker, grids of frequencies and filters. Errors are those beside independent references: series of delays with
many digits, closed forms, quadrature.

A ratio below one is a peer that is quicker. Many are, and some are as exact; what they do not give is a proof: that the
loop is stable, that a margin is the nearest one, how many digits are right. With ``--quick`` there are three rounds.
"""

import functools
import itertools
import math
import os
import sys
import warnings
from collections.abc import Callable
from fractions import Fraction
from time import process_time
from types import SimpleNamespace
from typing import NamedTuple

import control
import mpmath
import numpy as np
import sympy
from rich.console import Console
from rich.table import Table
from scipy.optimize import curve_fit, minimize

import peers
from loopbook import s
from loopbook.deadtime import Loop, System, closed_loop
from loopbook.families import Family
from loopbook.identification import fit
from loopbook.ise import UnstableLoopError, criteria, integral_of_square, ise, pi_first_order
from loopbook.pid import PID
from loopbook.stability import stability_map
from loopbook.transfer import first_order, second_order
from medians import compared, medians, seconds, shown
from peers import IN_CONTROL, IN_NUMPY, Linear
from test_ise import by_frequencies, by_parseval

# ------------------------------------------------------------------------------------------------ step responses


class Case(NamedTuple):
    """A closed loop: of the library, of a peer, and the reference at some of the times.

    `settings` are K, T, delay, Kp and Ti of an ordinary PI loop, for those peers that know no other.
    """

    name: str
    exact: Callable[[], System]
    peer: Callable[[SimpleNamespace], Linear]
    times: np.ndarray
    reference: Callable[[np.ndarray], np.ndarray]
    settings: tuple[float, ...] | None = None


def pi_case(name: str, end: float, reference: Callable, *settings: object, points: int = 2001) -> Case:
    K, T, delay, Kp, Ti = settings
    numbers = tuple(map(float, settings))
    return Case(
        name,
        lambda: Loop(first_order(K, T, delay=delay), PID(Kp, Ti)).servo,
        lambda kit: kit.closed(peers.pi_loop(*numbers, kit)),
        np.linspace(0, end, points),
        functools.partial(reference, numbers),
        numbers,
    )


def by_series(settings: tuple[float, ...], times: np.ndarray) -> np.ndarray:
    K, T, delay, Kp, Ti = map(mpmath.mpf, settings)

    def loop(p: mpmath.mpc) -> mpmath.mpc:
        return K / (T * p + 1) * Kp * (1 + 1 / (Ti * p))

    return peers.by_series(times, {float(delay): loop}, lambda _: 1, {float(delay): loop})


def by_slow_poles(settings: tuple[float, ...], times: np.ndarray) -> np.ndarray:
    K, T, delay, Kp, Ti = map(mpmath.mpf, settings)

    def transform(p: mpmath.mpc) -> mpmath.mpc:
        loop = K * mpmath.exp(-delay * p) / (T * p + 1) * Kp * (1 + 1 / (Ti * p))
        return loop / (1 + loop) / p

    return peers.by_circle(times, transform, radius=1, points=800)


def cases() -> list[Case]:
    half = sympy.Rational(1, 2)

    def smith() -> System:
        model = first_order(2, 0.7)
        predictor = closed_loop(PID(0.35, Ti=0.7), model - first_order(2, 0.7, delay=1.4))
        return Loop(first_order(2, 0.7, delay=2.1), predictor).servo

    def smith_of(kit: SimpleNamespace) -> Linear:
        pi, lag = kit.rational([0.35 * 0.7, 0.35], [0.7, 0]), kit.rational([2], [0.7, 1])
        predictor = kit.closed(pi, lag + -(kit.late(1.4) * lag))
        return kit.closed(kit.late(2.1) * lag * predictor)

    def smith_by_series(times: np.ndarray) -> np.ndarray:
        def open_loop(p: mpmath.mpc) -> mpmath.mpc:
            return mpmath.mpf(0.35) * (1 + 1 / (mpmath.mpf(0.7) * p)) * 2 / (mpmath.mpf(0.7) * p + 1)

        below = {1.4: lambda p: -open_loop(p), 2.1: open_loop}
        return peers.by_series(times, {2.1: open_loop}, lambda p: 1 + open_loop(p), below)

    paths = [(half, 2, 1), (3 * half / 5, 3, sympy.sqrt(2)), (2 * half / 5, 1, sympy.sqrt(3))]

    def three() -> System:
        return Loop(sum(first_order(K, T, delay=delay) for K, T, delay in paths), PID(0.6, 3)).servo

    def three_of(kit: SimpleNamespace) -> Linear:
        plants = [kit.late(float(delay)) * kit.rational([float(K)], [T, 1]) for K, T, delay in paths]
        return kit.closed((plants[0] + plants[1] + plants[2]) * kit.rational([1.8, 0.6], [3, 0]))

    def three_by_series(times: np.ndarray) -> np.ndarray:
        parts = {
            mpmath.sqrt(k): lambda p, K=K, T=T: K * mpmath.mpf(6) / 10 * (1 + 1 / (3 * p)) / (T * p + 1)
            for k, (K, T) in enumerate([(mpmath.mpf(5) / 10, 2), (mpmath.mpf(3) / 10, 3), (mpmath.mpf(2) / 10, 1)], 1)
        }
        return peers.by_series(times, parts, lambda _: 1, parts)

    def stiff() -> System:
        return Loop(first_order(1, 10, delay=2), PID(2, 10, 1, 0.0001)).servo

    def stiff_of(kit: SimpleNamespace) -> Linear:
        pid = kit.rational([2, 0.2], [1, 0]) + kit.rational([2, 0], [1e-4, 1])
        return kit.closed(kit.late(2) * kit.rational([1], [10, 1]) * pid)

    def stiff_by_series(times: np.ndarray) -> np.ndarray:
        def loop(p: mpmath.mpc) -> mpmath.mpc:
            return 2 * (1 + 1 / (10 * p) + p / (p / 10000 + 1)) / (10 * p + 1)

        return peers.by_series(times, {2.0: loop}, lambda _: 1, {2.0: loop})

    return [
        pi_case("PI, 20 delays", 20, by_series, 2, 3, 1, 3 * half, 3),
        pi_case("PI, 20 delays, 201 points", 20, by_series, 2, 3, 1, 3 * half, 3, points=201),
        Case("Smith predictor, wrong model", smith, smith_of, np.linspace(0, 20, 2001), smith_by_series),
        Case("three irrational dead times", three, three_of, np.linspace(0, 12, 2001), three_by_series),
        pi_case("short: delay 0.001, lag 10, to 100", 100, by_slow_poles, 1, 10, half / 500, 5, 8),
        pi_case("long: delay 20, lag 1, to 200", 200, by_series, 1, 1, 20, 3 * half / 5, 5),
        Case("stiff PID, Td/Tf = 10,000", stiff, stiff_of, np.linspace(0, 40, 2001), stiff_by_series),
    ]


def the_responses(runs: int) -> Table:
    """Building a loop from its numbers, and its step response."""
    title = f"Build a loop, and its response to a step at 2001 times: median of {runs}, largest error at 12 times"
    table = Table("loop, by", "time", "ratio", "error", title=title)
    for case in cases():
        times = case.times
        some = (np.linspace(0.03, 1, 12) * (len(times) - 1)).astype(int)
        expected = case.reference(times[some])
        tasks = {
            f"{case.name}: exact": lambda case=case, times=times: case.exact().step(times),
            "  python-control, Pade(10)": lambda case=case, times=times: peers.by_control(case.peer(IN_CONTROL), times),
            "  NumPy, modes of Pade(10)": lambda case=case, times=times: peers.Modes(case.peer(IN_NUMPY)).step(times),
        }
        if case.settings:
            K, T, delay, Kp, Ti = case.settings
            h = min(times[1], delay)
            steps, every = round(delay / h), round(times[1] / h)
            tasks[f"  SciPy, bilinear with step {h:g}"] = (
                lambda every=every, times=times, given=(K, T, steps, Kp, Ti, h): peers.tustin_pi_step(
                    *given, (len(times) - 1) * every + 1
                )[::every]
            )
        errors = {name: float(abs(task()[some] - expected).max()) for name, task in tasks.items()}
        compared(table, runs, tasks, errors)
        table.add_section()
    return table


# ------------------------------------------------------------------------------------------------ margins


def the_margins(runs: int) -> Table:
    """Margins and Ms of loops that are easy, sharp, and with a gain at infinite frequency."""
    z = sympy.Rational(1, 100_000)
    sharp = 6 * z**2 / 5 / (s**2 + 2 * z * s + 1) ** 2
    loops = {  # process without its dead time, controller, dead time
        "PI": (lambda: first_order(2, 3), lambda: PID(1.5, Ti=3), 1),
        "PID with filter": (lambda: first_order(2, 5), lambda: PID(1, 6, 1, 0.1), 2),
        "PID without filter": (lambda: first_order(1, 10), lambda: PID(1.68, Ti=20, Td=5.7), 2),
        "resonance, damping 1e-5": (lambda: sharp, lambda: 1, 2),
    }
    title = f"Margins and Ms: median of {runs}; relative errors, beside the exact ones refined to 30 digits"
    table = Table("loop, by", "time", "ratio", "gain margin", "phase margin", "Ms", title=title)
    for name, (process, controller, delay) in loops.items():

        def built(process: Callable = process, controller: Callable = controller, delay: int = delay) -> Loop:
            return Loop(process() * sympy.exp(-delay * s), controller())

        loop = built()
        above, below = (
            [float(c) for c in sympy.Poly(part, s).all_coeffs()]
            for part in sympy.fraction(sympy.together(loop.open * sympy.exp(delay * s)))
        )

        def by_pade(above: list = above, below: list = below, delay: int = delay) -> tuple[float, ...]:
            return in_order(control.tf(*control.pade(delay, 10)) * control.tf(above, below))

        def in_order(L: control.TransferFunction) -> tuple[float, ...]:
            gain, phase, distance, *_ = control.stability_margins(L)
            return gain, phase, 1 / distance

        def on_grid(above: list = above, below: list = below, delay: int = delay) -> tuple[float, ...]:
            def L(p: np.ndarray) -> np.ndarray:
                return np.polyval(above, p) / np.polyval(below, p) * np.exp(-delay * p)

            found = peers.margins_on_grid(L, np.geomspace(1e-3, 1e2, 2000) / delay)
            return found.gain_margin, found.phase_margin, found.Ms

        def exact(of: Loop) -> tuple[float, ...]:
            found = of.margins()
            return found.gain_margin, found.phase_margin, found.Ms

        pade = control.tf(*control.pade(delay, 10)) * control.tf(above, below)
        tasks = {
            f"{name}: exact, proved": lambda built=built, exact=exact: exact(built()),
            "  python-control, Pade(10)": by_pade,
            "  NumPy, 2000 frequencies": on_grid,
            "  exact, loop built before": lambda loop=loop, exact=exact: exact(loop),
            "  python-control, loop built before": lambda pade=pade, in_order=in_order: in_order(pade),
        }
        expected = polished(loop.open, loop.margins())
        notes = {name: tuple(map(relative, task(), expected)) for name, task in tasks.items()}
        compared(table, runs, tasks, notes)
        table.add_section()
    return table


def polished(L: sympy.Expr, found: object) -> tuple[float, ...]:
    """Gain margin, phase margin in degrees and Ms with 30 digits, at the crossings and the peak that were found."""
    with mpmath.workdps(30):
        value = sympy.lambdify(s, sympy.nsimplify(L), "mpmath")

        def at(w: mpmath.mpf) -> mpmath.mpc:
            return value(mpmath.mpc(0, w))

        def near(w: float) -> tuple[mpmath.mpf, mpmath.mpf]:  # two starts, closer than a resonance is wide
            return mpmath.mpf(w), mpmath.mpf(w) * (1 + mpmath.mpf(10) ** -10)

        gain, phase = found.gain_margin, found.phase_margin
        if math.isfinite(gain) and math.isfinite(found.omega_180) and found.omega_180:
            gain = -1 / at(mpmath.findroot(lambda w: at(w).imag, near(found.omega_180))).real
        if math.isfinite(phase):
            w = mpmath.findroot(lambda w: abs(at(w)) ** 2 - 1, near(found.omega_c))
            phase = mpmath.degrees(abs(mpmath.arg(-at(w))))
        Ms = found.Ms
        if math.isfinite(found.omega_ms):
            w = mpmath.findroot(lambda w: mpmath.diff(lambda x: abs(1 + at(x)) ** 2, w), near(found.omega_ms))
            Ms = 1 / abs(1 + at(w))
        return float(gain), float(phase), float(Ms)


def relative(value: float, expected: float) -> str:
    if math.isinf(value) or math.isinf(expected):
        return "exact" if value == expected else f"{value:.3g}, not {expected:.3g}"
    error = abs(value / expected - 1)
    return f"{error:.0e}" if error < 0.05 else f"{value:.3g}, not {expected:.3g}"


# ------------------------------------------------------------------------------------------------ integrals


def the_integrals(runs: int) -> Table:
    """The integral of the squared error of a PI loop and of a Smith predictor with a wrong model."""
    settings = 2.0, 0.7, 1.4, 0.3, 3.2
    K, T, delay, Kp, Ti = settings
    many = np.random.default_rng(1).uniform(0.05, 0.3, 1_000_000)
    with mpmath.workdps(30):
        expected = float(by_parseval("servo", settings))
    process, model = first_order(2, 0.7, delay=1.4), first_order(2, 0.7)
    smith = closed_loop(PID(0.35, Ti=0.7), model - process)
    wrong = System(Loop(first_order(2, 0.7, delay=2.1), smith).error("servo"))
    crooked = System(Loop(first_order(2, 0.7, delay=sympy.sqrt(3)), smith).error("servo"))
    grid = np.linspace(0, 60, 4001)

    def simulated() -> float:
        error = 1 - peers.Modes(peers.closed(peers.pi_loop(*settings))).step(grid)
        return float(np.trapezoid(error**2, grid))

    tasks = {
        "PI, `ise`, with building the loop": lambda: ise(first_order(K, T, delay=delay), PID(Kp, Ti)),
        "PI, closed form": lambda: pi_first_order(*settings),
        "PI, Pade(10) in sections, Lyapunov": lambda: peers.integral_of_square(peers.pi_loop(*settings)),
        "PI, Pade(10) by python-control, balanced, Lyapunov": lambda: peers.integral_of_square(
            peers.companion(peers.pi_polynomials(*settings)), balanced=True
        ),
        "PI, Pade(10) simulated by its modes": simulated,
    }
    table = Table("", "time", "ratio", "relative error", title=f"Integral of the squared error, median of {runs}")
    compared(table, runs, tasks, {name: abs(task() / expected - 1) for name, task in tasks.items()})
    table.add_section()
    others = {
        "a million settings, closed form": lambda: pi_first_order(2, 0.7, 1.4, many, 3.2),
        "Smith, wrong model, by its response": lambda: integral_of_square(wrong),
        "Smith, delays without common base, by its response": lambda: integral_of_square(crooked),
    }
    notes = {
        name: abs(integral_of_square(E) / by_frequencies(E) - 1)
        for name, E in zip(list(others)[1:], (wrong, crooked), strict=True)
    }
    compared(table, runs, others, notes)
    return table


def the_conditioning() -> Table:
    """Where a Pade approximation with a Lyapunov equation is wrong: the error of one integral, in four ways.

    The companion form is what `control.ss` makes of a product of transfer functions; its largest entry, times the
    rounding, is the error of SciPy's solver. Balanced states, one line more, are the remedy.
    """
    title = "Integral of the squared error of exp(-delay s) k/s, relative errors; ! where SciPy warned"
    table = Table("delay/lag", "k", "order", "largest entry", "companion", "balanced", "sections", "exact", title=title)
    near = [(float(sympy.pi / 2 * (1 - sympy.Float(x))), 10) for x in (1e-3, 1e-5, 1e-7)]
    for product, order in [*itertools.product((0.0025, 0.05, 0.25, 1.25), (4, 8, 10, 14)), *near]:
        k = 0.25 if product < 1.5 else 1.0  # the lag is one, and the controller cancels it
        settings = 1.0, 1.0, product / k, k, 1.0
        with mpmath.workdps(40):
            x = mpmath.mpf(settings[2]) * k
            expected = mpmath.cos(x) / (2 * mpmath.mpf(k) * (1 - mpmath.sin(x)))

        def error(value: float, expected: mpmath.mpf = expected) -> str:
            return shown(float(abs(value / expected - 1)))

        loop, texts = peers.companion(peers.pi_polynomials(*settings, order)), []
        for form, balanced in ((loop, False), (loop, True), (peers.pi_loop(*settings, order=order), False)):
            with warnings.catch_warnings(record=True) as warned:
                warnings.simplefilter("always")
                texts.append(error(peers.integral_of_square(form, balanced)) + " !" * bool(warned))
        own = error(ise(first_order(1, 1, delay=sympy.Rational(settings[2])), PID(k, 1)))
        table.add_row(
            f"{settings[2]:.9g}", f"{k:g}", f"{order}", shown(abs(loop.A).max()), *texts, own, end_section=order == 14
        )
    return table


# ------------------------------------------------------------------------------------------------ many settings


def the_map(runs: int) -> Table:
    """The number of unstable poles on a grid of 200 x 200 settings."""
    Kp, Ti = sympy.symbols("Kp Ti", positive=True)
    loop = first_order(2, 0.7, delay=1.4) * Kp * (1 + 1 / (Ti * s))
    gains, integral_times = np.linspace(0.02, 1.5, 200), np.linspace(0.1, 5, 200)
    points = [grid.ravel() for grid in np.meshgrid(gains, integral_times)]

    def by_limits() -> np.ndarray:
        """The first limit of each integral time, from a grid of frequencies: for plants that are stable."""
        omega = np.linspace(0.01, 3, 3000)
        loops = 2 * np.exp(-1.4j * omega) / (0.7j * omega + 1) * (1 + 1 / (1j * omega * integral_times[:, None]))
        a, b = loops[:, :-1], loops[:, 1:]
        real = (a.real * b.imag - b.real * a.imag) / (b.imag - a.imag)  # where the line between two points is real
        limit = -1 / real.min(axis=1, where=np.signbit(a.imag) != np.signbit(b.imag), initial=-1e-9)
        return (gains > limit[:, None]).astype(int)

    limits = "NumPy, first limit of each integral time: stable or not, no numbers"
    tasks = {
        "stability_map, exact": lambda: stability_map(loop, Kp=gains, Ti=integral_times),
        "NumPy, eigenvalues of Pade(10) in one batch": lambda: (
            peers.PISettings(2, 0.7, 1.4, *points).unstable_poles().reshape(200, 200)
        ),
        "NumPy, eigenvalues of Pade(4) in one batch": lambda: (
            peers.PISettings(2, 0.7, 1.4, *points, order=4).unstable_poles().reshape(200, 200)
        ),
        limits: by_limits,
    }
    right = tasks["stability_map, exact"]()
    notes = {name: f"{np.count_nonzero(task() != right)}" for name, task in tasks.items()}
    notes[limits] = f"{np.count_nonzero(by_limits() != (right > 0))}"
    title = f"A map of stability, 200 x 200 points, median of {runs}"
    table = Table("", "time", "ratio", "points that differ", title=title)
    compared(table, runs, tasks, notes)
    return table


def the_settings(runs: int) -> Table:
    """Step response (201 points), integral of the squared error and Ms of 1,000 PI settings."""
    dice = np.random.default_rng(1)
    gains, integral_times, times = dice.uniform(0.05, 0.3, 1000), dice.uniform(1, 5, 1000), np.linspace(0, 30, 201)
    numbers = 2, 0.7, 1.4
    every = range(0, 1000, 50)

    def loop(k: int) -> Loop:
        return Loop(first_order(2, 0.7, delay=1.4), PID(float(gains[k]), float(integral_times[k])))

    def family() -> Family:
        Kp, Ti = sympy.symbols("Kp Ti", positive=True)
        return Family(first_order(2, 0.7, delay=1.4), PID(Kp, Ti), Kp=gains, Ti=integral_times)

    def batch() -> peers.PISettings:
        return peers.PISettings(*numbers, gains, integral_times)

    columns = "one", "20, one by one", "1,000 in one call", "beside one", "1,000 by NumPy", "error", "NumPy's error"
    title = f"1,000 settings of a PI controller: median of {runs}; largest errors, beside one by one"
    table = Table("", *columns, title=title)
    for name, of, together, by_numpy in (
        ("step", lambda k: loop(k).servo.step(times), lambda: family().step(times), lambda: batch().step(times)),
        ("ISE", lambda k: ise(loop(k)), lambda: family().ise(), lambda: batch().ise()),
        ("Ms", lambda k: loop(k).margins().Ms, lambda: family().Ms(), lambda: batch().Ms()),
    ):
        expected = np.array([of(k) for k in every])
        unit = 1 if name == "step" else expected
        errors = [np.max(abs(task()[every] - expected) / unit) for task in (together, by_numpy)]
        found = medians(
            runs,
            process_time,
            one=functools.partial(of, 0),
            several=lambda of=of: [of(k) for k in every],
            together=together,
            numpy=by_numpy,
        )
        beside = f"{found['together'] / found['one']:.1f}"
        cells = [seconds(found[key]) for key in ("one", "several", "together", "numpy")]
        table.add_row(name, *cells[:3], beside, cells[3], *map(shown, errors))
    return table


def the_optimisation(runs: int) -> Table:
    """A user's search: the PI settings with the least IAE after a step of the load, and Ms at most 1.6."""
    process = second_order(1, 10, 4, delay=3)
    times, omega = np.linspace(0, 120, 1201), np.geomspace(1e-3, 10, 500)
    plant = np.exp(-3j * omega) / ((10j * omega + 1) * (4j * omega + 1))

    def exact(Kp: float, Ti: float) -> tuple[float, float]:
        loop = Loop(process, PID(Kp, Ti))
        try:
            return criteria(process, PID(Kp, Ti), "regulator").IAE, loop.margins().Ms
        except UnstableLoopError:
            return math.inf, math.inf

    def approximate(Kp: float, Ti: float, kit: SimpleNamespace, respond: Callable) -> tuple[float, float]:
        late_lags = kit.late(3) * kit.rational([1], [40, 14, 1])
        y = respond(kit.closed(late_lags, kit.rational([Kp * Ti, Kp], [Ti, 0])), times)
        Ms = 1 / abs(1 + plant * Kp * (1 + 1 / (1j * omega * Ti))).min()
        return (float(np.trapezoid(abs(y), times)), Ms) if abs(y[-1]) < 1 else (math.inf, math.inf)

    def search(of: Callable[[float, float], tuple[float, float]]) -> np.ndarray:
        def cost(x: np.ndarray) -> float:
            IAE, Ms = of(*map(float, np.exp(x)))
            return IAE * (1 + 100 * max(0.0, Ms - 1.6)) if math.isfinite(Ms) else 1e9

        return np.exp(minimize(cost, np.log([1.0, 10.0]), method="Nelder-Mead", options={"maxfev": 60}).x)

    tasks = {
        "exact: `criteria` and `margins`": lambda: search(exact),
        "python-control, Pade(10), 1201 points; Ms on a grid": lambda: search(
            functools.partial(approximate, kit=IN_CONTROL, respond=peers.by_control)
        ),
        "NumPy, modes of Pade(10), 1201 points; Ms on a grid": lambda: search(
            functools.partial(approximate, kit=IN_NUMPY, respond=lambda system, t: peers.Modes(system).step(t))
        ),
    }
    notes = {}
    for name, task in tasks.items():
        IAE, Ms = exact(*map(float, task()))
        notes[name] = f"{IAE:.4f}", f"{Ms:.4f}"
    title = f"Least IAE with Ms at most 1.6, 60 evaluations, median of {runs}; what was found, judged exactly"
    table = Table("", "time", "ratio", "IAE", "Ms", title=title)
    compared(table, runs, tasks, notes)
    return table


# ------------------------------------------------------------------------------------------------ records


def the_record(runs: int) -> Table:
    """The response to 20,000 samples that are held: of a loop, and of a process without feedback."""
    h, count = 0.05, 20_000
    u = np.repeat(np.random.default_rng(1).normal(size=count // 50), 50)
    times, steps = h * np.arange(count), np.diff(u, prepend=0)
    process = first_order(2, 3, delay=1)
    servo, alone = Loop(process, PID(sympy.Rational(3, 2), Ti=3)).servo, System(process)  # L = exp(-s)/s
    pade = peers.closed(peers.pi_loop(2, 3, 1, 1.5, 3))

    def expected() -> np.ndarray:
        """Superposed steps of the loop, each a finite series; after 120 delays nothing is left of it."""
        moments = [Fraction(k, 20) for k in range(2400)]
        series = [
            float(sum((-1) ** (n + 1) * (x - n) ** n / Fraction(math.factorial(n)) for n in range(1, int(x) + 1)))
            for x in moments
        ]
        return np.convolve(steps, np.append(series, np.ones(count)))[:count]

    lagged = np.where(times >= 1, 2 * (1 - np.exp(-(times - 1) / 3)), 0)
    loop = {
        "loop: exact": lambda: servo.response(times, u, hold="zero order"),
        "  python-control, Pade(10)": lambda: peers.by_control(control.c2d(control.ss(*pade), h, "zoh"), times, u),
        "  SciPy, Pade(10), a filter for each mode": lambda: peers.Modes(pade).held(u, h),
    }
    process_alone = {
        "process: exact": lambda: alone.response(times, u, hold="zero order"),
        "  SciPy, exact too, one filter": lambda: peers.held_late([2], [3, 1], 1, h, u),
    }
    table = Table("", "time", "ratio", "largest error", title=f"Response to {count} samples, median of {runs}")
    for tasks, right in ((loop, expected()), (process_alone, np.convolve(steps, lagged)[:count])):
        compared(table, runs, tasks, {name: float(abs(task() - right).max()) for name, task in tasks.items()})
        table.add_section()
    return table


def the_fit(runs: int) -> Table:
    """Two lags and a dead time fitted to 110 samples: from a grid of starts, beside searches from one good start."""
    times = np.arange(110.0)
    u = np.where(times < 10, 0.0, 1.0)
    y = System(3 * (1 - 0.1 * s) / ((10 * s + 1) * (3 * s + 1) * (s + 1) ** 3)).response(times, u, hold="zero order")

    def exact(_: np.ndarray, K: float, T1: float, T2: float, delay: float) -> np.ndarray:
        return peers.held_late([K], [T1 * T2, T1 + T2, 1], max(delay, 0), 1.0, u)

    def by_pade(_: np.ndarray, K: float, T1: float, T2: float, delay: float) -> np.ndarray:
        return peers.by_control(control.ss(*(peers.late(delay) * peers.rational([K], [T1 * T2, T1 + T2, 1]))), times, u)

    start = 2, 8, 2, 2
    tasks = {
        "fit: starts found by itself, standard errors": lambda: [*fit(times, u, y, "second order").parameters.values()],
        "curve_fit around an exact filter in SciPy": lambda: curve_fit(exact, times, y, p0=start)[0],
        "curve_fit around python-control, Pade(10)": lambda: curve_fit(by_pade, times, y, p0=start)[0],
    }
    left = {name: f"{np.std(exact(times, *task()) - y):.5f}" for name, task in tasks.items()}
    title = f"A fit to 110 samples, median of {runs}; what the model found leaves, but for a constant"
    table = Table("second order with dead time", "time", "ratio", "left", title=title)
    compared(table, runs, tasks, left)
    return table


if __name__ == "__main__":
    if (
        "OPENBLAS_NUM_THREADS" not in os.environ
    ):  # with matrices this small, threads only wait for each other, on all sides
        os.execve(sys.executable, [sys.executable, *sys.argv], os.environ | {"OPENBLAS_NUM_THREADS": "1"})
    console = Console()
    for table in (
        the_responses, the_margins, the_integrals, the_map, the_settings, the_optimisation, the_record, the_fit,
    ):  # fmt: skip
        console.print(table(runs=3 if "--quick" in sys.argv else 9))
    console.print(the_conditioning())
