"""What the collection costs beside what it stands on: `make bench` prints tables of medians and their ratios.

The library: a fresh interpreter that imports loopbook, beside one that imports SymPy only. The simulator: a closed loop
with all practical features, beside a bare loop around SciPy's solver; a cascade, and a plant with all its loops. Model
reduction and internal model control. The responses to answers of the exercises. A chapter: its import cell and
the whole of it, each in a fresh kernel, beside a fresh kernel that imports no more than the packages the chapter uses;
what it takes beside its imports, and how much of that is the drawing of its figures.
Dead time has a benchmark of its own, `bench_deadtime.py`.
"""

import functools
import os
import subprocess
import sys
from collections.abc import Callable
from pathlib import Path
from statistics import median

import sympy
from nbformat import NotebookNode, v4
from rich.console import Console
from rich.table import Table
from scipy.integrate import solve_ivp

from loopbook import notebooks, s
from loopbook.approximation import half_rule, taylor
from loopbook.exercises import bank
from loopbook.pid import PID, Controller
from loopbook.plants import BatchTank, FlashPlant, JacketedTank, WoodChipTank
from loopbook.signals import stepwise
from loopbook.simulation import simulate
from loopbook.structures import ControlLoop
from loopbook.synthesis import IMC_TABLE, imc
from loopbook.transfer import second_order

ROOT = Path(__file__).parents[1]
sys.path.insert(0, str(ROOT / "tests" / "control_engineering"))

from medians import medians, seconds  # noqa: E402 - of tests/, where it has just become possible to import from
from test_plantwide import CALM, structure  # noqa: E402
from test_sequence import batches_of_two  # noqa: E402

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


STOPWATCH = """
from time import process_time
from loopbook.figures import Picture
drawn, png = [], Picture.png
def timed(picture):
    begin = process_time()
    image = png(picture)
    drawn.append(process_time() - begin)
    return image
Picture.png = timed
"""


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


def drawing(chapter: NotebookNode) -> tuple[int, float]:
    """How many figures `chapter` draws in a fresh kernel, and the seconds of the processor that this takes."""
    first, last = (v4.new_code_cell(source) for source in (STOPWATCH, "print(len(drawn), sum(drawn))"))
    after = notebooks.run(v4.new_notebook(cells=[first, *chapter.cells, last]), ROOT / "chapters")
    number, time = after.cells[-1].outputs[0].text.split()
    return int(number), float(time)


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
    """The time of each chapter and of its import cell, beside an empty kernel that imports the packages it uses.

    Sliders draw their figures, too.
    """
    columns = (
        "packages only",
        "import cell",
        "ratio",
        "whole chapter",
        "ratio",
        "beside imports",
        "figures",
        "drawn in",
    )
    table = Table("fresh kernel", *columns, title=f"Running a chapter, median of {runs}")
    for path in paths:
        chapter = notebooks.read(path)
        imports = next(cell.source for cell in chapter.cells if cell.cell_type == "code")
        times = medians(
            runs, packages=kernel(only(packages(chapter))), imports=kernel(only(imports)), whole=kernel(chapter)
        )
        figures = [drawing(chapter) for _ in range(runs)]
        table.add_row(
            path.stem,
            seconds(times["packages"]),
            seconds(times["imports"]),
            f"{times['imports'] / times['packages']:.2f}",
            seconds(times["whole"]),
            f"{times['whole'] / times['packages']:.2f}",
            seconds(times["whole"] - times["imports"]),
            str(figures[0][0]),
            seconds(median(time for _, time in figures)),
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


def the_exercises(runs: int) -> Table:
    """The responses to right and to wrong answers: the slowest exercise of each kind of answer."""
    os.environ["LOOPBOOK_PROGRESS"] = "off"
    slowest: dict[str, tuple[float, str]] = {}
    for chapter in bank.chapters():
        for number, exercise in bank.exercises(chapter).items():
            question = exercise.question()
            for name, kind in question.key.items():
                for answer in (kind.as_given, *(form for _, form in kind.wrong_forms())):
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
    console.print(the_derivations(runs=9))
    console.print(the_exercises(runs=3))
    chapters = sorted((ROOT / "chapters").glob("*.ipynb"))
    if chapters:
        with console.status("running the chapters"):
            table = the_chapters(3, chapters)
        console.print(table)
