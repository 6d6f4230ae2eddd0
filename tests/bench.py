"""What the collection costs beside what it stands on: `make bench` prints tables of medians and their ratios.

The library: a fresh interpreter that imports loopbook, beside one that imports SymPy only. The simulator: a closed loop
with all practical features, beside a bare loop around SciPy's solver. A chapter: its import cell
and the whole of it, each in a fresh kernel, beside a fresh kernel that imports no more than the packages the chapter
uses. What is compared runs in turn, so that a busy minute of the machine burdens both sides.
"""

import subprocess
import sys
from collections.abc import Callable
from pathlib import Path
from statistics import median
from time import perf_counter

from nbformat import NotebookNode, v4
from rich.console import Console
from rich.table import Table
from scipy.integrate import solve_ivp

from loopbook import notebooks
from loopbook.pid import PID, Controller
from loopbook.plants import WoodChipTank
from loopbook.signals import stepwise
from loopbook.simulation import simulate

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
    return f"{value:.2f} s"


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


if __name__ == "__main__":
    console = Console()
    console.print(the_library(runs=7))
    console.print(the_simulator(runs=3))
    chapters = sorted((ROOT / "chapters").glob("*.ipynb"))
    if chapters:
        with console.status("running the chapters"):
            table = the_chapters(3, chapters)
        console.print(table)
