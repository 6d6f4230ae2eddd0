"""What the collection costs beside what it stands on: `make bench` prints tables of medians and their ratios.

The library: a fresh interpreter that imports loopbook, beside one that imports SymPy only. The simulator: a closed loop
with all practical features, beside a bare loop around SciPy's solver; a cascade, and a plant with all its loops. Dead
time: exact responses and integrals of the squared error, beside python-control with Pade approximations of order 10,
and their errors; a map of stability. Model reduction and internal model control, and a fit to data. The responses to
answers of the exercises. A chapter: its import cell and the whole of it, each in a fresh kernel, beside a fresh kernel
that imports no more than the packages the chapter uses. What is compared runs in turn, so that a busy minute of the
machine burdens both sides.
"""

import functools
import math
import os
import subprocess
import sys
from collections.abc import Callable
from fractions import Fraction
from pathlib import Path
from statistics import median
from time import perf_counter

import control
import mpmath
import numpy as np
import sympy
from nbformat import NotebookNode, v4
from rich.console import Console
from rich.table import Table
from scipy.integrate import solve_ivp
from scipy.optimize import curve_fit

from loopbook import notebooks, s
from loopbook.approximation import half_rule, taylor
from loopbook.deadtime import Loop, System, closed_loop
from loopbook.exercises import bank
from loopbook.identification import fit
from loopbook.ise import integral_of_square, pi_first_order
from loopbook.pid import PID, Controller
from loopbook.plants import BatchTank, FlashPlant, JacketedTank, WoodChipTank
from loopbook.signals import stepwise
from loopbook.simulation import simulate
from loopbook.stability import stability_map
from loopbook.structures import ControlLoop
from loopbook.synthesis import IMC_TABLE, imc
from loopbook.transfer import first_order, second_order
from test_exercises import key_as_given, wrong_answers
from test_ise import by_parseval
from test_ise import loops as random_loops
from test_plantwide import CALM, structure
from test_sequence import batches_of_two

ROOT = Path(__file__).parents[1]
PACKAGES = {
    "control",
    "ipywidgets",
    "matplotlib.pyplot",
    "numpy",
    "schemdraw",
    "scipy.integrate",
    "scipy.linalg",
    "scipy.optimize",
    "scipy.signal",
    "sympy",
}


def medians(runs: int, **tasks: Callable[[], object]) -> dict[str, float]:
    """The median time (s) of each task over several rounds in which the tasks take turns."""
    times: dict[str, list[float]] = {name: [] for name in tasks}
    for _ in range(runs):
        for name, task in tasks.items():
            start = perf_counter()
            task()
            times[name].append(perf_counter() - start)
    return {name: median(values) for name, values in times.items()}


def python(program: str) -> Callable[[], object]:
    """A task: a fresh interpreter runs `program`."""
    return lambda: subprocess.run([sys.executable, "-c", program], check=True)


def kernel(notebook: NotebookNode) -> Callable[[], object]:
    """A task: a fresh kernel runs `notebook`, which is not stored."""
    return lambda: notebooks.run(notebook, ROOT / "chapters")


def only(source: str) -> NotebookNode:
    """A notebook of one cell."""
    return v4.new_notebook(cells=[v4.new_code_cell(source)])


def packages(chapter: NotebookNode) -> str:
    """The import of those packages that are loaded when `chapter` has run, whoever imported them."""
    probe = v4.new_code_cell(f"import sys\nprint(*sorted({PACKAGES} & set(sys.modules)), sep=', ')")
    after = notebooks.run(v4.new_notebook(cells=[*chapter.cells, probe]), ROOT / "chapters")
    loaded = after.cells[-1].outputs[0].text.strip()
    return f"import {loaded}" if loaded else "pass"


def seconds(value: float) -> str:
    scale, unit = next(((k, u) for k, u in ((1, "s"), (1e3, "ms")) if abs(value) * k >= 0.1), (1e6, "µs"))
    return f"{value * scale:.2f} {unit}"


def the_library(runs: int) -> Table:
    """The time that `import loopbook` adds to `import sympy`."""
    times = medians(
        runs, python=python("pass"), sympy=python("import sympy"), loopbook=python("import sympy; import loopbook")
    )
    table = Table("fresh interpreter", "time", "beside sympy", title=f"Importing the library, median of {runs}")
    for name, time in times.items():
        table.add_row(name, seconds(time), f"{time / times['sympy']:.2f}")
    table.add_row("loopbook adds", seconds(times["loopbook"] - times["sympy"]), "")
    return table


def the_chapters(runs: int, paths: list[Path]) -> Table:
    """The time of each chapter and of its import cell, beside an empty kernel that imports the packages it uses."""
    columns = ("packages only", "import cell", "ratio", "whole chapter", "ratio")
    table = Table("fresh kernel", *columns, title=f"Running a chapter, median of {runs}")
    for path in paths:
        chapter = notebooks.read(path)
        imports = next(cell.source for cell in chapter.cells if cell.cell_type == "code")
        times = medians(
            runs, packages=kernel(only(packages(chapter))), imports=kernel(only(imports)), whole=kernel(chapter)
        )
        table.add_row(
            path.stem,
            seconds(times["packages"]),
            seconds(times["imports"]),
            f"{times['imports'] / times['packages']:.2f}",
            seconds(times["whole"]),
            f"{times['whole'] / times['packages']:.2f}",
        )
    return table


def the_simulator(runs: int) -> Table:
    """A closed loop of 10,000 samples, beside a loop of one's own that calls SciPy's solver once a sample."""
    samples = 10_000
    tank = WoodChipTank()
    controller = Controller(
        PID(1.35, 917, 60, 6),
        step=1,
        u0=45,
        limits=(0, 100),
        w_p=0.3,
        w_d=0,
        ramp=0.01,
        T_filter=20,
        measurement_range=(0, 15),
    )
    signals = {"setpoint": stepwise(10, {1000: 11}), "w_out": stepwise(25, {5000: 30})}

    def everything() -> None:
        simulate(tank, controller, until=samples, noise=0.05, **signals)

    def bare() -> None:  # a P controller and the tank, without any practical feature
        h, belt = 10.0, [45.0] * 250
        for k in range(samples):
            belt.append(45 + 1.35 * ((10 if k < 1000 else 11) - h) * 100 / 15)
            inflow = 5 / 9 * belt.pop(0)
            outflow = 25 if k < 5000 else 30
            rate = (inflow - outflow) / (145 * 13.4)
            h = solve_ivp(lambda _, x, rate=rate: [rate], (k, k + 1), [h], rtol=1e-9, atol=1e-12).y[0, -1]

    times = medians(runs, everything=everything, bare=bare)
    table = Table(f"{samples} samples", "time", "ratio", title=f"Simulating a loop, median of {runs}")
    table.add_row("simulate, all practical features", seconds(times["everything"]), "1.00")
    table.add_row(
        "solve_ivp once a sample, bare loop", seconds(times["bare"]), f"{times['bare'] / times['everything']:.2f}"
    )
    return table


def the_structures(runs: int) -> Table:
    """Many loops on one plant: a cascade, beside a bare loop of one's own, and a plant with all its controllers."""
    samples = 3000
    tank, flash, batch_tank, batch = JacketedTank(), FlashPlant(), BatchTank(), batches_of_two()
    primary = Controller(PID(2, Ti=400), step=1, u0=46)
    secondary = Controller(PID(0.05, Ti=60), step=1, u0=tank.F_h, limits=(0, 1.5))
    cascade = [ControlLoop("TC1", primary, 41, "T_pm", "T_hSP"), ControlLoop("TC2", secondary, "T_hSP", "T_hm", "F_h")]

    def bare() -> None:  # two P controllers and the tank, without dead time or any practical feature
        x, mass_p, mass_h = [40.0, 46.0], 4200 * 500, 4200 * 100
        for k in range(samples):
            flow = 0.6 + 0.05 * (46 + 2 * (41 - x[0]) - x[1])

            def rates(_: float, x: list[float], flow: float = flow) -> list[float]:
                heat = 5600 * (x[1] - x[0])
                jacket = 4200 * flow * (60 - x[1]) - heat + 100 * (20 - x[1])
                return [(1680 * (20 - x[0]) + heat) / mass_p, jacket / mass_h]

            x = solve_ivp(rates, (k, k + 1), x, rtol=1e-9, atol=1e-12).y[:, -1].tolist()

    times = medians(
        runs,
        cascade=lambda: simulate(tank, cascade, until=samples),
        bare=bare,
        batches=lambda: simulate(batch_tank, batch, until=4800, start=stepwise(0, {60: 1})),
        plant=lambda: simulate(flash, structure(), until=7200, **(CALM | {"F_SP": stepwise(5, {600: 6})})),
    )
    table = Table("several loops", "time", "ratio", title=f"Control structures, median of {runs}")
    table.add_row(f"simulate, cascade, {samples} samples", seconds(times["cascade"]), "1.00")
    ratio = times["bare"] / times["cascade"]
    table.add_row("solve_ivp once a sample, bare cascade", seconds(times["bare"]), f"{ratio:.2f}")
    ratio = times["plant"] / times["cascade"]
    table.add_row("simulate, plant with 8 loops, 2 h in 1440 samples", seconds(times["plant"]), f"{ratio:.2f}")
    ratio = times["batches"] / times["cascade"]
    table.add_row("simulate, two batches under a chart, 2400 scans", seconds(times["batches"]), f"{ratio:.2f}")
    return table


def pade_loop(K: float, T: float, delay: float, Kp: float, Ti: float) -> control.StateSpace:
    """A PI loop around a lag with dead time, as python-control has it, from the setpoint to the output."""
    late = control.tf(*control.pade(delay, 10)) * control.tf([K], [T, 1])
    return control.feedback(control.ss(late * control.tf([Kp * Ti, Kp], [Ti, 0])), 1)


def the_responses(runs: int) -> Table:
    """The step response of a PI loop over 20 delays, of which the exact solution is a finite series."""
    times = np.linspace(0, 20, 2001)
    process, settings = first_order(2, 3, delay=1), PID(sympy.Rational(3, 2), Ti=3)  # L = exp(-s)/s

    def series(x: Fraction) -> float:
        return float(sum((-1) ** (n + 1) * (x - n) ** n / math.factorial(n) for n in range(1, int(x) + 1)))

    expected = np.array([series(Fraction(n, 100)) for n in range(2001)])
    exact, pade = Loop(process, settings).servo, pade_loop(2, 3, 1, 1.5, 3)

    def by_pade(system: control.StateSpace) -> np.ndarray:
        return control.forced_response(system, times, np.ones_like(times))[1]

    tasks = {
        "exact": lambda: exact.step(times),
        "exact, with building the loop": lambda: Loop(process, settings).servo.step(times),
        "python-control, Pade(10)": lambda: by_pade(pade),
        "python-control, with building the loop": lambda: by_pade(pade_loop(2, 3, 1, 1.5, 3)),
    }
    table = Table("step response", "time", "ratio", "largest error", title=f"20 delays, 2001 points, median of {runs}")
    errors = {name: abs(task() - expected).max() for name, task in tasks.items()}
    times_of = medians(runs, **tasks)
    for name, time in times_of.items():
        table.add_row(name, seconds(time), f"{time / times_of['exact']:.2f}", f"{errors[name]:.0e}")
    return table


def the_criteria(runs: int) -> Table:
    """The integral of the squared error of a PI loop and of a Smith predictor with a wrong model."""
    process, model = first_order(2, 0.7, delay=1.4), first_order(2, 0.7)
    smith = closed_loop(PID(0.35, Ti=0.7), model - process)
    wrong = System(Loop(first_order(2, 0.7, delay=2.1), smith).error("servo"))
    filtered = System(Loop(process, PID(0.45, 1.9, 0.5, 0.05)).error("servo"))
    crooked = System(Loop(first_order(2, 0.7, delay=sympy.sqrt(3)), smith).error("servo"))
    gains = np.random.default_rng(1).uniform(0.05, 0.3, 1_000_000)
    exact = pi_first_order(2.0, 0.7, 1.4, 0.3, 3.2)
    points = 4001  # for an error of about 1e-5
    grid = np.linspace(0, 60, points)

    def simulated() -> float:
        error = 1 - control.forced_response(pade_loop(2, 0.7, 1.4, 0.3, 3.2), grid, np.ones(points))[1]
        return float(np.trapezoid(error**2, grid))

    def again(count: int, task: Callable[[], object]) -> Callable[[], object]:
        def repeated() -> None:
            for _ in range(count):
                task()

        return repeated

    def difference(E: System, one: str, other: str) -> str:
        a, b = (integral_of_square(E, method) for method in (one, other))
        return f"{abs(a / b - 1):.0e}"

    calls = {  # how often in a round, so that a quick one is seen as in a search for settings
        "PI, closed form, a call": (1000, lambda: pi_first_order(2.0, 0.7, 1.4, 0.3, 3.2)),
        "PI, closed form, a million settings": (1, lambda: pi_first_order(2, 0.7, 1.4, gains, 3.2)),
        "PID with filter, residues": (20, lambda: integral_of_square(filtered, "residues")),
        "Smith, wrong model, boundary values": (20, lambda: integral_of_square(wrong, "boundary value")),
        "Smith, delays without common base, quadrature": (20, lambda: integral_of_square(crooked, "quadrature")),
        "python-control, Pade(10), simulated": (20, simulated),
    }
    with mpmath.workdps(30):
        closed = [abs(pi_first_order(*loop) / by_parseval("servo", loop) - 1) for loop in random_loops(100, seed=1)]
    errors = {
        "PI, closed form, a call": f"{float(max(closed)):.0e}",
        "PID with filter, residues": difference(filtered, "residues", "response"),
        "Smith, wrong model, boundary values": difference(wrong, "boundary value", "response"),
        "Smith, delays without common base, quadrature": difference(crooked, "quadrature", "response"),
        "python-control, Pade(10), simulated": f"{abs(simulated() / exact - 1):.0e}",
    }
    times = medians(runs, **{name: again(*call) for name, call in calls.items()})
    times = {name: time / calls[name][0] for name, time in times.items()}
    pade = times["python-control, Pade(10), simulated"]
    title = f"Integral of the squared error, median of {runs}; error of the closed form: the largest of 100 loops,"
    title += " beside quadrature with 30 digits; of the others: beside the exact response"
    table = Table("", "time", "python-control takes", "relative error", title=title)
    for name, time in times.items():
        table.add_row(name, seconds(time), f"{pade / time:.3g} x", errors.get(name, ""))
    return table


def the_map(runs: int) -> Table:
    """The number of unstable poles on a grid of 200 x 200 settings, beside one python-control loop a point."""
    Kp, Ti = sympy.symbols("Kp Ti", positive=True)
    loop = first_order(2, 0.7, delay=1.4) * Kp * (1 + 1 / (Ti * s))
    gains, integral_times = np.linspace(0.02, 1.5, 200), np.linspace(0.1, 5, 200)

    def hundred_points() -> None:
        for gain in gains[::2]:
            pade_loop(2, 0.7, 1.4, float(gain), 2).poles()

    times = medians(runs, map=lambda: stability_map(loop, Kp=gains, Ti=integral_times), hundred=hundred_points)
    table = Table("200 x 200 points", "time", "ratio", title=f"A map of stability, median of {runs}")
    table.add_row("stability_map, exact", seconds(times["map"]), "1.00")
    pade = 400 * times["hundred"]
    table.add_row("poles of a Pade(10) loop, 100 points times 400", seconds(pade), f"{pade / times['map']:.2f}")
    return table


def the_derivations(runs: int) -> Table:
    """Model reduction and the table of internal model control, with numbers and with letters."""
    K, T1, T2, T3, delay, Tc = sympy.symbols("K T1 T2 T3 delay Tc", positive=True)
    numbers = (
        (1 - 0.3 * s) * (0.08 * s + 1) / ((2 * s + 1) * (s + 1) * (0.4 * s + 1) * (0.2 * s + 1) * (s / 20 + 1) ** 3)
    )
    letters = K * sympy.exp(-delay * s) / ((T1 * s + 1) * (T2 * s + 1) * (T3 * s + 1))
    tasks = {
        "half_rule, two zeros and seven lags": lambda: half_rule(numbers),
        "half_rule, three lags with letters": lambda: half_rule(letters, largest_first=[T1, T2, T3]),
        "imc, two lags with dead time": lambda: imc(second_order(2, 10, 5, delay=1), Tc=3),
    }
    for case, (model, approximation) in IMC_TABLE.items():
        tasks[f"imc, row {case} with letters"] = functools.partial(imc, model, Tc, approximation or taylor)
    table = Table("", "time", title=f"One call, median of {runs}, after a first one")
    for task in tasks.values():
        task()
    for name, time in medians(runs, **tasks).items():
        table.add_row(name, seconds(time))
    return table


def the_fit(runs: int) -> Table:
    """Two lags and a dead time fitted to 110 samples: from a grid of starts, beside Pade responses from one start."""
    times = np.arange(110.0)
    u = np.where(times < 10, 0.0, 1.0)
    y = System(3 * (1 - 0.1 * s) / ((10 * s + 1) * (3 * s + 1) * (s + 1) ** 3)).response(times, u)

    def by_pade(_: np.ndarray, K: float, T1: float, T2: float, delay: float) -> np.ndarray:
        late = control.tf(*control.pade(delay, 10)) * control.tf([K], [T1 * T2, T1 + T2, 1])
        return control.forced_response(control.ss(late), times, u)[1]

    tasks = {
        "fit, exact": lambda: fit(times, u, y, "second order"),
        "curve_fit around python-control, Pade(10)": lambda: curve_fit(by_pade, times, y, p0=(2, 8, 2, 2)),
    }
    table = Table("second order with dead time", "time", "ratio", title=f"A fit to 110 samples, median of {runs}")
    found = medians(runs, **tasks)
    for name, time in found.items():
        table.add_row(name, seconds(time), f"{time / found['fit, exact']:.2f}")
    return table


def the_exercises(runs: int) -> Table:
    """The responses to right and to wrong answers: the slowest exercise of each kind of answer."""
    os.environ["LOOPBOOK_PROGRESS"] = "off"
    slowest: dict[str, tuple[float, str]] = {}
    for chapter in bank.chapters():
        for number, exercise in bank.exercises(chapter).items():
            question = exercise.question()
            for name, kind in question.key.items():
                for answer in (key_as_given(kind), *wrong_answers(kind)):
                    time = medians(runs, check=functools.partial(question.check, **{name: answer}))["check"]
                    found = slowest.get(type(kind).__name__, (0.0, ""))
                    slowest[type(kind).__name__] = max(found, (time, f"{number}, {name}"))
    table = Table("kind of answer", "slowest response", "exercise", title=f"Responses, median of {runs}")
    for kind, (time, where) in sorted(slowest.items()):
        table.add_row(kind, seconds(time), where)
    return table


if __name__ == "__main__":
    console = Console()
    console.print(the_library(runs=7))
    console.print(the_simulator(runs=3))
    console.print(the_structures(runs=3))
    console.print(the_responses(runs=15))
    console.print(the_criteria(runs=7))
    console.print(the_map(runs=3))
    console.print(the_derivations(runs=9))
    console.print(the_fit(runs=3))
    console.print(the_exercises(runs=3))
    chapters = sorted((ROOT / "chapters").glob("*.ipynb"))
    if chapters:
        with console.status("running the chapters"):
            table = the_chapters(3, chapters)
        console.print(table)
