"""How the benchmarks measure: what is compared runs in turn, so that a busy minute of the machine burdens all of it."""

from collections.abc import Callable
from statistics import median
from time import perf_counter, process_time

from rich.table import Table


def medians(runs: int, clock: Callable[[], float] = perf_counter, **tasks: Callable[[], object]) -> dict[str, float]:
    """The median time (s) of each task over several rounds in which the tasks take turns."""
    times: dict[str, list[float]] = {name: [] for name in tasks}
    for _ in range(runs):
        for name, task in tasks.items():
            start = clock()
            task()
            times[name].append(clock() - start)
    return {name: median(values) for name, values in times.items()}


def seconds(value: float) -> str:
    scale, unit = next(((k, u) for k, u in ((1, "s"), (1e3, "ms")) if abs(value) * k >= 0.1), (1e6, "µs"))
    return f"{value * scale:.2f} {unit}"


def compared(table: Table, runs: int, tasks: dict[str, Callable[[], object]], notes: dict[str, object]) -> None:
    """Add a row for each task: its name, its time, how many times that of the first, and what else is said of it.

    The time is the processor's, which tasks of milliseconds do not share with what else the machine does.
    """
    times = medians(runs, process_time, **tasks)
    first = next(iter(times.values()))
    for name, time in times.items():
        note = notes.get(name, "")
        texts = note if isinstance(note, tuple) else (note,)
        table.add_row(name, seconds(time), f"{time / first:.2f}", *map(shown, texts))


def shown(note: object) -> str:
    return note if isinstance(note, str) else f"{note:.0e}"
