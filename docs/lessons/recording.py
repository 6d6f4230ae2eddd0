"""Recorded lessons: what the cells with sliders of the chapters show, evaluated beforehand at many positions.

A chapter's code runs up to such a cell, as far as the cell needs it, with a `sliders` that keeps the function instead
of showing it. The function is then called for a thinned grid of positions, and what its figures show is taken out of
them.
"""

import ast
import hashlib
import html
import inspect
import io
import itertools
import json
import math
import os
import re
import sys
from contextlib import contextmanager, redirect_stdout
from dataclasses import dataclass, replace
from pathlib import Path

import nbformat
from rich.console import Console
from rich.progress import track

import loopbook.sliders
from lessons import moving
from lessons.reading import Scene, scene_of
from lessons.wording import in_html
from loopbook.figures.picture import Picture, Stack
from loopbook.notebooks import bound_in
from loopbook.sliders import _control
from plainmath.tables import Table, is_symbol, symbol

ROOT = Path(__file__).resolve().parents[2]
POSITIONS = 2000  # of all sliders of a lesson together, at most
LARGEST = 300_000  # characters of a recording
FEW = 10  # values of a slider that do not become fewer


@dataclass(frozen=True)
class Knob:
    """A slider of a cell: its parameter, label and unit, values, the one at the start, words, what a text names."""

    name: str
    label: str
    unit: str
    values: tuple
    start: object
    words: bool = False
    named: tuple = ()

    def thinned(self, stride):
        """The same with every so many values only, the start and those that a text names among them."""
        even = self.values[self.values.index(self.start) % stride :: stride]
        return replace(self, values=tuple(value for value in self.values if value in even or value in self.named))

    @property
    def shown(self):
        """What the page says for each value."""
        if self.words:
            return [in_html(str(value)) for value in self.values]
        digits = max(decimals(value) for value in self.values)
        unit = f"\u202f{self.unit}" if self.unit and self.unit != "1" else ""
        return [f"{value:.{digits}f}{unit}".replace("-", "−") for value in self.values]


def decimals(number):
    """How many digits after the point a number has, up to four.

    >>> decimals(0.25), decimals(3), decimals(1.0)
    (2, 0, 0)
    """
    return len(f"{float(number):.4f}".rstrip("0").partition(".")[2])


def cells_of(chapter):
    """The cells of code of a chapter."""
    notebook = nbformat.read(ROOT / "chapters" / f"{chapter}.ipynb", as_version=4)
    return [cell for cell in notebook.cells if cell.cell_type == "code"]


def is_moving(source):
    """Whether a cell has sliders that are shown by our `sliders`."""
    return "@sliders(" in source


def function_of(source):
    """The name of the function behind the sliders of a cell."""
    tree = ast.parse(source)
    return next(node.name for node in tree.body if isinstance(node, ast.FunctionDef) and node.decorator_list)


def needed(cells, at):
    """The sources of the cells that a cell needs, itself at the end.

    A cell is needed if it binds a name that is used later; names of functions of other cells do not matter here.
    """
    used, kept = names_in(cells[at].source), [cells[at].source]
    for cell in reversed(cells[:at]):
        if is_moving(cell.source) and not (bound_in(cell.source) - {function_of(cell.source)}) & used:
            continue
        if bound_in(cell.source) & used:
            used |= names_in(cell.source)
            kept.append(cell.source)
    return kept[::-1]


def names_in(source):
    """All names that a cell uses, also those that it binds only in a part of itself."""
    return {node.id for node in ast.walk(ast.parse(source)) if isinstance(node, ast.Name)}


def code_of(cells, at):
    """A short text that changes with the code that a cell needs."""
    return hashlib.sha256("\n\n".join(needed(cells, at)).encode()).hexdigest()[:16]


def place_of(chapter, function):
    """The cells of code of a chapter, and the number of the one with a slider's function.

    Raises ValueError where there is none.
    """
    cells = cells_of(chapter)
    for number, cell in enumerate(cells):
        if is_moving(cell.source) and function_of(cell.source) == function:
            return cells, number
    raise ValueError(f"the chapter {chapter} has no cell with sliders for {function!r}")


def captured(sources, folder=ROOT / "chapters"):
    """Run sources as a notebook does, and return the function and the labels of the sliders of the last one."""
    kept = []

    def sliders(labels):
        def keep(function):
            kept.append((function, labels))
            return function

        return keep

    space = {"__name__": "__main__", "display": lambda *_: None}
    with instead(loopbook.sliders, "sliders", sliders), working_in(folder), redirect_stdout(io.StringIO()):
        for source in sources:
            exec(compile(source, "<cell>", "exec"), space)
    return kept[-1]


@contextmanager
def instead(module, name, other):
    """Give a module another thing of a name for a while."""
    own = getattr(module, name)
    setattr(module, name, other)
    try:
        yield
    finally:
        setattr(module, name, own)


@contextmanager
def working_in(folder):
    """Work in a folder for a while, where no progress is kept."""
    before, progress = Path.cwd(), os.environ.get("LOOPBOOK_PROGRESS")
    os.chdir(folder)
    os.environ["LOOPBOOK_PROGRESS"] = "off"
    try:
        yield
    finally:
        os.chdir(before)
        if progress is None:
            del os.environ["LOOPBOOK_PROGRESS"]
        else:
            os.environ["LOOPBOOK_PROGRESS"] = progress


def knobs_of(function, labels, instead_of_typing=()):
    """The sliders of a captured cell, with all their values.

    Arguments:
        function, labels: as `captured` returns them.
        instead_of_typing: texts to choose from where a cell has a field to type in.
    """
    knobs = []
    for (name, parameter), (label, given) in zip(
        inspect.signature(function).parameters.items(), labels.items(), strict=True
    ):
        control = _control(label, given, parameter.default)
        words, unit = label.rpartition(" [")[::2] if label.endswith("]") else (label, "")
        words, unit = in_html(words), unit.removesuffix("]")
        if hasattr(control, "options"):
            options = tuple(getattr(control, "_options_values", control.options))
            knobs.append(Knob(name, words, unit, options, control.value, words=True))
        elif hasattr(control, "max"):
            count = round((control.max - control.min) / control.step)
            values = [round(control.min + k * control.step, 10) for k in range(count + 1)]
            values = sorted({type(control.value)(value) for value in values} | {control.value})
            knobs.append(Knob(name, words, unit, tuple(values), control.value))
        elif isinstance(control.value, bool):
            knobs.append(Knob(name, words, unit, (False, True), control.value))
        else:
            knobs.append(Knob(name, words, unit, tuple(instead_of_typing), control.value, words=True))
    return knobs


def thinned(knobs, most):
    """The sliders with so few values that there are at most so many positions; the last ones become coarser first."""
    thin, strides = list(knobs), [1] * len(knobs)
    while math.prod(len(knob.values) for knob in thin) > most:
        choice = [k for k, knob in enumerate(thin) if not knob.words and len(knob.values) > FEW]
        if not choice:
            return thin
        strides[choice[-1]] += 1
        thin[choice[-1]] = knobs[choice[-1]].thinned(strides[choice[-1]])
    return thin


def answer_of(function, values):
    """What a cell's function shows for values of its sliders: verdict, results, scene and image."""
    pictures, results, verdict, image = [], {}, "", ""
    try:
        shown = function(**values)
    except ValueError as problem:  # as the cell shows it: the reader sees what is wrong, and moves on
        return html.escape(str(problem).partition(";")[0]), {}, Scene(), ""
    for part in shown if isinstance(shown, list | tuple) else [shown]:
        if isinstance(part, Stack):
            pictures += part.pictures
        elif isinstance(part, Picture) and is_drawing(part):
            data = part._repr_mimebundle_()[0]["image/png"]
            image, verdict = data, in_html(part.alt.partition(": ")[2].removeprefix("symbols: "))
        elif isinstance(part, Picture):
            pictures.append(part)
        elif isinstance(part, Table):
            results |= quantities_of(part)
        else:
            verdict = in_html(str(part))
    return verdict, results, scene_of(pictures) if pictures else Scene(), image


def is_drawing(picture):
    """Whether a picture is a drawing, not a plot: it has no axes with numbers."""
    return not any(axes.axison for axes in picture.figure.axes)


def quantities_of(found):
    """The rows of a table of quantities, as {label: text}, with HTML."""
    told = {}
    for name, text in found._written(tex=False):
        written = re.sub(r"^([A-Z])([a-z])$", r"\1_\2", name)
        told[in_html(symbol(written) if is_symbol(written) else name)] = in_html(text).replace(" ", "\u202f", 1)
    return told


def recording(lesson, most=POSITIONS):
    """Return the recording of a cell: what a lesson's page needs, and the cell's code as a number.

    Arguments:
        lesson: a `Recorded`.
        most: positions of all the sliders together.
    Raises:
        ValueError: if the cell's first figure is not the one that the notebook stores.
    """
    cells, at = place_of(lesson.chapter, lesson.function)
    call, labels = captured(needed(cells, at))
    knobs = knobs_of(call, labels, lesson.typed)
    knobs = [replace(knob, named=tuple(lesson.named.get(knob.name, ()))) for knob in knobs]
    known = {}

    def answer(values):
        if values not in known:
            known[values] = answer_of(call, dict(zip((knob.name for knob in knobs), values, strict=True)))
        return known[values]

    alt = alt_at_start(call, knobs)
    stored = next((o.metadata["image/png"]["alt"] for o in cells[at].outputs if "image/png" in o.get("data", {})), alt)
    if alt != stored:
        raise ValueError(f"{lesson.chapter}, {lesson.function}: the cell shows {stored!r}, and the recording {alt!r}")
    while (size := len(text_of(data := data_of(thin := thinned(knobs, most), answer)))) > LARGEST and len(thin) > 1:
        most = int(0.9 * math.prod(len(knob.values) for knob in thin) * LARGEST / size)
    return {
        "code": code_of(cells, at),
        "alt": alt,
        "sliders": [
            {
                "name": k.name, "label": k.label, "shown": k.shown, "first": k.values.index(k.start),
                "list": k.words, "values": list(k.values),
            }
            for k in thin
        ],
        "data": data,
    }  # fmt: skip


def alt_at_start(function, knobs):
    """The words of what a cell shows at the start."""
    shown = function(**{knob.name: knob.start for knob in knobs})
    parts = shown if isinstance(shown, list | tuple) else [shown]
    return next((part.alt for part in parts if isinstance(part, Picture)), "")


def data_of(knobs, answer):
    """The page's data for sliders, asking for every answer once."""
    positions = list(itertools.product(*(knob.values for knob in knobs)))
    bar = {"console": Console(stderr=True), "transient": True, "disable": not sys.stderr.isatty()}
    answers = [answer(values) for values in track(positions, "  positions of the sliders", **bar)]
    return moving.told(answers, [len(k.values) for k in knobs], [k.values.index(k.start) for k in knobs])


def text_of(data):
    """The data as the page gets them."""
    return json.dumps(data, ensure_ascii=False, separators=(",", ":"))
