"""What exact dead time costs and gives: `make bench` prints this library beside its peers, and errors beside times.

The peers are in `peers.py`: python-control with Pade approximations of order 10, the same in NumPy's arrays where that
is quicker, and grids of frequencies. Errors are those beside series of delays with many digits, or beside
the exact margins and integrals of this library, which its tests prove.

A ratio below one is a peer that is quicker. Many are, and some are as exact; what they do not give is a proof: that the
loop is stable, that a margin is the nearest one, how many digits are right. With ``--quick`` there are three rounds.
"""

import functools
import math
import os
import sys
from collections.abc import Callable
from time import process_time
from types import SimpleNamespace
from typing import NamedTuple

import control
import mpmath
import numpy as np
import sympy
from rich.console import Console
from rich.table import Table

import peers
from loopbook import s
from loopbook.deadtime import System, closed_loop
from loopbook.families import Family
from loopbook.integrals import integral_of_square, ise, pi_first_order
from loopbook.loops import Loop
from loopbook.pid import PID, Controller
from loopbook.plants import Process
from loopbook.simulation import simulate
from loopbook.stability import stability_map
from loopbook.transfer import first_order
from medians import compared, medians, seconds, shown
from peers import IN_CONTROL, IN_NUMPY, Linear

# ------------------------------------------------------------------------------------------------ step responses


class Case(NamedTuple):
    """A closed loop: of the library, of a peer, and the reference at some of the times."""

    name: str
    exact: Callable[[], System]
    peer: Callable[[SimpleNamespace], Linear]
    times: np.ndarray
    reference: Callable[[np.ndarray], np.ndarray]


def cases() -> list[Case]:
    def pi() -> System:
        return Loop(first_order(2, 3, delay=1), PID(1.5, 3)).servo

    def pi_of(kit: SimpleNamespace) -> Linear:
        return kit.closed(peers.pi_loop(2, 3, 1, 1.5, 3, kit))

    def pi_by_series(times: np.ndarray) -> np.ndarray:
        parts = {1.0: lambda p: 3 * (1 + 1 / (3 * p)) / (3 * p + 1)}
        return peers.by_series(times, parts, lambda _: 1, parts)

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

    def stiff() -> System:
        return Loop(first_order(1, 10, delay=2), PID(2, 10, 1, 0.0001)).servo

    def stiff_of(kit: SimpleNamespace) -> Linear:
        pid = kit.rational([2, 0.2], [1, 0]) + kit.rational([2, 0], [1e-4, 1])
        return kit.closed(kit.late(2) * kit.rational([1], [10, 1]) * pid)

    def stiff_by_series(times: np.ndarray) -> np.ndarray:
        parts = {2.0: lambda p: 2 * (1 + 1 / (10 * p) + p / (p / 10000 + 1)) / (10 * p + 1)}
        return peers.by_series(times, parts, lambda _: 1, parts)

    return [
        Case("PI, 20 delays", pi, pi_of, np.linspace(0, 20, 2001), pi_by_series),
        Case("Smith predictor, wrong model", smith, smith_of, np.linspace(0, 20, 2001), smith_by_series),
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
        "PI": (first_order(2, 3), PID(1.5, Ti=3), 1),
        "PID without filter": (first_order(1, 10), PID(1.68, Ti=20, Td=5.7), 2),
        "resonance, damping 1e-5": (sharp, PID(1), 2),
    }
    title = f"Margins and Ms: median of {runs}; relative differences from the exact ones"
    table = Table("loop, by", "time", "ratio", "gain margin", "phase margin", "Ms", title=title)
    for name, (process, controller, delay) in loops.items():
        parts = sympy.fraction(sympy.together(process * controller.expr))
        above, below = ([float(c) for c in sympy.Poly(part, s).all_coeffs()] for part in parts)

        def exact(process: sympy.Expr = process, controller: PID = controller, delay: int = delay) -> tuple[float, ...]:
            found = Loop(process * sympy.exp(-delay * s), controller).margins()
            return found.gain_margin, found.phase_margin, found.Ms

        def by_pade(above: list = above, below: list = below, delay: int = delay) -> tuple[float, ...]:
            L = control.tf(*control.pade(delay, 10)) * control.tf(above, below)
            gain, phase, distance, *_ = control.stability_margins(L)
            return gain, phase, 1 / distance

        def on_grid(above: list = above, below: list = below, delay: int = delay) -> tuple[float, ...]:
            def L(p: np.ndarray) -> np.ndarray:
                return np.polyval(above, p) / np.polyval(below, p) * np.exp(-delay * p)

            return peers.margins_on_grid(L, np.geomspace(1e-3, 1e2, 2000) / delay)

        tasks = {
            f"{name}: exact, proved": exact,
            "  python-control, Pade(10)": by_pade,
            "  NumPy, 2000 frequencies": on_grid,
        }
        compared(table, runs, tasks, {name: tuple(map(relative, task(), exact())) for name, task in tasks.items()})
        table.add_section()
    return table


def relative(value: float, expected: float) -> str:
    if math.isinf(value) or math.isinf(expected):
        return "exact" if value == expected else f"{value:.3g}, not {expected:.3g}"
    error = abs(value / expected - 1)
    return f"{error:.0e}" if error < 0.05 else f"{value:.3g}, not {expected:.3g}"


# ------------------------------------------------------------------------------------------------ integrals


def the_integrals(runs: int) -> Table:
    """The integral of the squared error of a PI loop and of a Smith predictor with a wrong model."""
    K, T, delay, Kp, Ti = settings = 2.0, 0.7, 1.4, 0.3, 3.2
    expected = pi_first_order(*settings)
    many = np.random.default_rng(1).uniform(0.05, 0.3, 1_000_000)
    smith = closed_loop(PID(0.35, Ti=0.7), first_order(2, 0.7) - first_order(2, 0.7, delay=1.4))
    wrong = System(Loop(first_order(2, 0.7, delay=2.1), smith).error("servo"))
    grid = np.linspace(0, 60, 4001)

    def simulated() -> float:
        error = 1 - peers.Modes(peers.closed(peers.pi_loop(*settings))).step(grid)
        return float(np.trapezoid(error**2, grid))

    tasks = {
        "PI, `ise`, with building the loop": lambda: ise(first_order(K, T, delay=delay), PID(Kp, Ti)),
        "PI, closed form": lambda: pi_first_order(*settings),
        "PI, Pade(10) in sections, Lyapunov": lambda: peers.integral_of_square(peers.pi_loop(*settings)),
        "PI, Pade(10) by python-control, Lyapunov": lambda: peers.integral_of_square(
            peers.companion(peers.pi_polynomials(*settings))
        ),
        "PI, Pade(10) simulated by its modes": simulated,
    }
    others = {
        "a million settings, closed form": lambda: pi_first_order(2, 0.7, 1.4, many, 3.2),
        "Smith, wrong model, by its response": lambda: integral_of_square(wrong),
    }
    table = Table("", "time", "ratio", "relative error", title=f"Integral of the squared error, median of {runs}")
    compared(table, runs, tasks, {name: abs(task() / expected - 1) for name, task in tasks.items()})
    table.add_section()
    compared(table, runs, others, {})
    return table


# ------------------------------------------------------------------------------------------------ many settings


def the_map(runs: int) -> Table:
    """The number of unstable poles on a grid of 200 x 200 settings."""
    Kp, Ti = sympy.symbols("Kp Ti", positive=True)
    loop = first_order(2, 0.7, delay=1.4) * Kp * (1 + 1 / (Ti * s))
    gains, integral_times = np.linspace(0.02, 1.5, 200), np.linspace(0.1, 5, 200)
    points = [grid.ravel() for grid in np.meshgrid(gains, integral_times)]
    tasks = {
        "stability_map, exact": lambda: stability_map(loop, Kp=gains, Ti=integral_times),
        "NumPy, eigenvalues of Pade(10) in one batch": lambda: (
            peers.PISettings(2, 0.7, 1.4, *points).unstable_poles().reshape(200, 200)
        ),
    }
    right = tasks["stability_map, exact"]()
    notes = {name: f"{np.count_nonzero(task() != right)}" for name, task in tasks.items()}
    title = f"A map of stability, 200 x 200 points, median of {runs}"
    table = Table("", "time", "ratio", "points that differ", title=title)
    compared(table, runs, tasks, notes)
    return table


def the_settings(runs: int) -> Table:
    """Step response (201 points), integral of the squared error and Ms of 1,000 PI settings."""
    dice = np.random.default_rng(1)
    gains, integral_times, times = dice.uniform(0.05, 0.3, 1000), dice.uniform(1, 5, 1000), np.linspace(0, 30, 201)
    every = range(0, 1000, 50)

    def loop(k: int) -> Loop:
        return Loop(first_order(2, 0.7, delay=1.4), PID(float(gains[k]), float(integral_times[k])))

    def family() -> Family:
        Kp, Ti = sympy.symbols("Kp Ti", positive=True)
        return Family(first_order(2, 0.7, delay=1.4), PID(Kp, Ti), Kp=gains, Ti=integral_times)

    def batch() -> peers.PISettings:
        return peers.PISettings(2, 0.7, 1.4, gains, integral_times)

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


# ------------------------------------------------------------------------------------------------ sampled loops


def the_sampled_loop(runs: int) -> Table:
    """A PI controller that runs once a sample, on a lag with a dead time of 13 samples, for 100,000 samples."""
    K, T, _, Kp, Ti, step, count = numbers = 2, 5, 13, 0.5, 5, 0.1, 100_000
    process = Process(first_order(K, T, delay=sympy.Rational(13, 10)))

    def simulated(**settings: object) -> np.ndarray:
        return simulate(process, Controller(PID(Kp, Ti), step, **settings), until=count * step, setpoint=1)["y"]

    tasks = {
        "simulate": simulated,
        "simulate, with limits and anti wind-up": lambda: simulated(limits=(0, 1)),
        "simulate, the plant alone": lambda: simulate(process, until=count * step, step=step, u=1),
        "a loop of one's own, zero-order hold": lambda: peers.held_loop(*numbers),
        "python-control, forced_response": lambda: peers.sampled_loop(*numbers),
    }
    exact = peers.held_loop(*numbers)
    errors = {name: float(abs(task() - exact).max()) for k, (name, task) in enumerate(tasks.items()) if k not in (1, 2)}
    table = Table("", "time", "ratio", "difference", title=f"A sampled loop, {count:,} samples: median of {runs}")
    compared(table, runs, tasks, errors)
    return table


if __name__ == "__main__":
    # with matrices this small, threads only wait for each other, on all sides
    if "OPENBLAS_NUM_THREADS" not in os.environ:
        os.execve(sys.executable, [sys.executable, *sys.argv], os.environ | {"OPENBLAS_NUM_THREADS": "1"})
    console = Console()
    for table in (the_responses, the_margins, the_integrals, the_map, the_settings, the_sampled_loop):
        console.print(table(runs=3 if "--quick" in sys.argv else 9))
