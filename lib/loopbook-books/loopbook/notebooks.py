"""Run a notebook from top to bottom and store it so that the same outputs are the same bytes.

A stored notebook is part of the proof: its outputs are compared cell by cell at each test, and its changes are read
in a diff. So nothing is stored that differs from run to run or from machine to machine, or with what comes before a
cell: no times, no execution counts, no widget models, no paths, no addresses. A cell keeps its id for life. The library
never imports this module; ``python -m loopbook execute`` does.
"""

import ast
import copy
import json
import math
import os
import re
from collections.abc import Iterable, Iterator
from concurrent.futures import ThreadPoolExecutor, as_completed
from hashlib import sha256
from pathlib import Path
from queue import Empty
from subprocess import DEVNULL
from time import monotonic, perf_counter
from typing import NamedTuple

import nbformat
from jupyter_client import KernelClient
from jupyter_client.kernelspec import NoSuchKernel
from nbclient import NotebookClient
from nbclient.exceptions import CellExecutionError, CellTimeoutError, DeadKernelError
from nbformat import NotebookNode

from bookledger.stored import parsed, walk

SECONDS_PER_CELL = 120
"""A cell that takes longer than this (s) waits for something that never comes, and is stopped."""

METADATA = {
    "kernelspec": {"display_name": "Python 3", "language": "python", "name": "python3"},
    "language_info": {"name": "python"},
}
WIDGET = "application/vnd.jupyter.widget-view+json"
PICTURES = {"image/png", "image/jpeg"}  # base64 is not text, though it may happen to spell anything

SLIDERS = "nbval-ignore-output"
"""The tag of a cell with sliders: nbval runs it, and does not compare the widgets that it shows."""
INTERACT = {"sliders", "interact", "interactive", "interact_manual", "interactive_output"}
FOLDED = "hide-input"
"""The tag of a cell whose code is folded, in JupyterLab and on a page: imports, sliders, and what serves the ledger."""
FURTHER = re.compile(r"^\*Further[ .:]|^## How we know\b", re.MULTILINE)
"""What the text under a heading begins with when its section may be skipped: JupyterLab opens it folded."""
ID = re.compile(r"[a-zA-Z0-9_-]{1,64}")  # what the format of notebooks allows

PATH = re.compile(
    r"(?<![\w.~-])/(?:home|media|mnt|opt|private|root|srv|tmp|Users|usr|var|work)/[^\s\"'<>]*"
    r"|\b[A-Za-z]:[\\/]+Users\b[^\s\"'<>]*"
)
ADDRESS = re.compile(r"\b0x[0-9a-fA-F]{7,}\b")


class NotebookError(Exception):
    """A notebook that cannot be run or stored; the message is one line that names the notebook and the cell."""


class Outcome(NamedTuple):
    """What became of one notebook: the time it took (s), whether its file changed, and the error if there was one."""

    path: Path
    seconds: float
    changed: bool
    error: NotebookError | None


def found(paths: Iterable[Path]) -> list[Path]:
    """The notebooks that `paths` name: each file, and those of each folder in the order of their names.

    Raises NotebookError when a path does not exist or is not a notebook.
    """
    notebooks: list[Path] = []
    for path in paths:
        if path.is_dir():
            notebooks += sorted(path.glob("*.ipynb"))
        elif not path.exists():
            raise NotebookError(f"{path}: no such notebook")
        elif path.suffix != ".ipynb":
            raise NotebookError(f"{path}: not a notebook, its name does not end in .ipynb")
        else:
            notebooks.append(path)
    return list(dict.fromkeys(notebooks))


def execute_all(paths: Iterable[Path]) -> Iterator[Outcome]:
    """Execute and store notebooks, as many at a time as there are cores; yields outcomes in the order of finishing."""
    pool = ThreadPoolExecutor(os.cpu_count())
    try:
        for finished in as_completed([pool.submit(_outcome, path) for path in paths]):
            yield finished.result()
    finally:
        pool.shutdown(wait=False, cancel_futures=True)  # so that an interruption does not wait for the running cells


def _outcome(path: Path) -> Outcome:
    start, changed, error = perf_counter(), False, None
    try:
        changed = execute(path)
    except NotebookError as problem:
        error = problem
    return Outcome(path, perf_counter() - start, changed, error)


def execute(path: Path) -> bool:
    """Run the notebook at `path` in a fresh kernel, in its own folder, and store it; returns whether its file changed.

    Raises NotebookError, and leaves the file as it was, when a cell fails or shows what may not be stored.
    """
    try:
        notebook = normalised(run(normalised(read(path)), path.resolve().parent))
        if problems := unfit(notebook):
            more = f" (and {len(problems) - 1} more)" if problems[1:] else ""
            raise NotebookError(problems[0] + more)
    except NotebookError as error:
        raise NotebookError(f"{path}: {error}") from error
    try:
        return store(as_text(notebook), path)
    except OSError as error:
        raise NotebookError(f"{path}: cannot be stored: {error.strerror}") from error


def read(path: Path) -> NotebookNode:
    """The notebook stored at `path`. Raises NotebookError when the file is none."""
    try:
        return nbformat.reads(path.read_text(encoding="utf-8"), as_version=4)
    except OSError as error:
        raise NotebookError(error.strerror) from error
    except Exception as error:  # nbformat fails in as many ways as a file can be malformed
        raise NotebookError(f"not a notebook ({_first_line(str(error))})") from error


def run(notebook: NotebookNode, folder: Path) -> NotebookNode:
    """A copy of `notebook` with the outputs of a fresh kernel that works in `folder`.

    Raises NotebookError at the first cell that fails: its label and the first line of the error.
    """
    client = _Client(copy.deepcopy(notebook), kernel_name="python3", timeout=SECONDS_PER_CELL, record_timing=False)
    # Figures belong in the notebook, whatever backend the caller's own programs use.
    environment = {name: value for name, value in os.environ.items() if name != "MPLBACKEND"}
    # What the reader has answered so far stays as it is, and out of what is stored.
    environment["LOOPBOOK_PROGRESS"] = "off"
    labels = [label for label, cell in labelled(notebook) if cell.cell_type == "code"]
    try:
        # What cells print to stderr arrives as an output; what the kernel itself says there is of no use to the reader.
        notebook = client.execute(cwd=str(folder), env=environment, stderr=DEVNULL)
    except CellExecutionError as error:
        problem = f"{error.ename}: {_first_line(error.evalue)}"
        raise NotebookError(f"{labels[client.code_cells_executed - 1]}: {problem}") from error
    except CellTimeoutError as error:
        label = labels[client.code_cells_executed - 1]
        raise NotebookError(f"{label}: not done after {SECONDS_PER_CELL} s") from error
    except NoSuchKernel as error:
        raise NotebookError("no kernel named python3 here: install ipykernel") from error
    except DeadKernelError as error:
        raise NotebookError(f"{labels[client.code_cells_executed - 1]}: the kernel died") from error
    for output in _slider_outputs(notebook):
        if output["output_type"] == "error":
            raise NotebookError(f"a slider fails: {output['ename']}: {_first_line(output['evalue'])}")
    return notebook


class _Client(NotebookClient):
    """A client that looks for the reply of the kernel five times a second, and does not wait to be told of it.

    A slider's output answers the kernel through the socket on which the client waits for the reply. If the reply comes
    just then, the answer takes the notice of it away, and the client would wait for as long as a cell may take.
    """

    async def async_start_new_kernel_client(self) -> KernelClient:
        kernel = await super().async_start_new_kernel_client()
        once = kernel.shell_channel.get_msg

        async def patiently(timeout: float | None = None) -> dict:
            end = math.inf if timeout is None else monotonic() + timeout
            while True:
                try:
                    return await once(timeout=min(0.2, max(0.0, end - monotonic())))
                except Empty:
                    if monotonic() >= end:
                        raise

        kernel.shell_channel.get_msg = patiently
        return kernel


def _slider_outputs(notebook: NotebookNode) -> Iterator[dict]:
    """What the functions behind the sliders show: an error there is shown in the widget and does not fail the cell."""
    widgets = notebook.metadata.get("widgets", {}).get("application/vnd.jupyter.widget-state+json", {})
    for model in widgets.get("state", {}).values():
        yield from model["state"].get("outputs", [])


def _first_line(text: str) -> str:
    return next(iter(text.strip().splitlines()), "")


def normalised(notebook: NotebookNode) -> NotebookNode:
    """The one form in which a notebook is stored; ``normalised(normalised(n)) == normalised(n)``.

    A cell keeps its id; one without an id, or with the id of a cell before it, gets one from its content. Empty cells
    and execution counts are dropped, neighbouring pieces of printed text joined. Widget views are dropped, because
    their models have random names and live in the kernel only; a picture beside one stays. Metadata says no more than
    which kernel runs the notebook, which cells have sliders, whose code is folded, and which sections are further
    reading. All of it follows from the cells: no tag can hide one from the tests.

    >>> from nbformat import v4
    >>> cells = [v4.new_code_cell("T = 5", id="lag", execution_count=7), v4.new_code_cell(""), v4.new_code_cell("T")]
    >>> first, last = normalised(v4.new_notebook(cells=cells)).cells
    >>> first.id, first.execution_count, last.id == cells[2].id
    ('lag', None, True)
    """
    cells: list[NotebookNode] = []
    for cell in notebook.cells:
        source = cell.source.replace("\r\n", "\n").rstrip()
        if not source:
            continue
        kept = NotebookNode(id=cell.get("id", ""), cell_type=cell.cell_type, source=source, metadata=NotebookNode())
        if "attachments" in cell:
            kept.attachments = cell.attachments
        if cell.cell_type == "code":
            kept.execution_count = None
            kept.outputs = _outputs(cell.outputs)
            if has_sliders(source):
                kept.metadata.tags = [SLIDERS]
        elif source.startswith("## ") and FURTHER.search(source):
            kept.metadata["jp-MarkdownHeadingCollapsed"] = True
        cells.append(kept)
    for cell in folded(cells):
        cell.metadata.tags = [FOLDED, *cell.metadata.get("tags", [])]
        cell.metadata.jupyter = {"source_hidden": True}
    for cell, own in zip(cells, _ids(cells), strict=True):
        cell.id = own
    return nbformat.from_dict({"nbformat": 4, "nbformat_minor": 5, "metadata": METADATA, "cells": cells})


def _ids(cells: list[NotebookNode]) -> list[str]:
    """The ids of cells: the own one of each, or one from its content where that is missing or an earlier cell's."""
    theirs, ids = {cell.id for cell in cells}, []
    for cell in cells:
        own = cell.id
        while own in ids or not ID.fullmatch(own) or (own != cell.id and own in theirs):
            own = sha256(f"{own} {cell.cell_type} {cell.source}".encode()).hexdigest()[:8]
        ids.append(own)
    return ids


def has_sliders(source: str) -> bool:
    """Whether the code of a cell makes sliders, with `sliders` or ipywidgets' `interact` or one like it."""
    nodes = _walked(source)
    names = {node.id for node in nodes if isinstance(node, ast.Name)}
    return not INTERACT.isdisjoint(names.union(node.attr for node in nodes if isinstance(node, ast.Attribute)))


def folded(cells: Iterable[NotebookNode]) -> list[NotebookNode]:
    """The cells whose code a reader need not see: imports, sliders, checks, diagrams, and what serves these alone.

    A cell serves these alone if it shows nothing and all that it binds is used in folded cells only. What belongs to
    the argument is shown, and is not folded then.

    >>> from nbformat import v4
    >>> codes = ["x = 1", "x + 1", "worst = max(x, 2)", "example.check(worst=worst)", "draw.conveyor_belt()"]
    >>> [cell.source for cell in folded([v4.new_code_cell(code) for code in codes])]
    ['worst = max(x, 2)', 'example.check(worst=worst)', 'draw.conveyor_belt()']
    """
    code = [cell for cell in cells if cell.cell_type == "code"]
    bound, used = [bound_in(cell.source) for cell in code], [_used_in(cell.source) for cell in code]
    sources = [cell.source for cell in code]
    hidden = {n for n, x in enumerate(sources) if _imports(x) or has_sliders(x) or _checks(x) or _draws(x)}

    def serves_hidden_cells(n: int) -> bool:
        if n in hidden or not bound[n] or code[n].outputs:
            return False
        return all(m in hidden or m == n or bound[n].isdisjoint(used[m]) for m in range(len(code))) and any(
            not bound[n].isdisjoint(used[m]) for m in hidden
        )

    while more := {n for n in range(len(code)) if serves_hidden_cells(n)}:
        hidden |= more
    return [code[n] for n in sorted(hidden)]


def _draws(source: str) -> bool:
    """Whether a cell ends in a diagram, whose code is its layout."""
    match _parsed(source).body:
        case [*_, ast.Expr(ast.Call(ast.Attribute(ast.Name("draw" | "diagrams"))))]:
            return True
    return False


def _walked(source: str) -> list[ast.AST]:
    return walk(_parsed(source))


def _parsed(source: str) -> ast.Module:
    """The syntax tree of a cell, empty where it is no Python, such as a magic of IPython."""
    return parsed(source) or ast.Module([], [])


def bound_in(source: str) -> set[str]:
    """The names that a cell binds for those after it; those of functions and comprehensions remain in them.

    >>> sorted(bound_in("K, T = 2, 5\\ndef lag(x): y = x"))
    ['K', 'T', 'lag']
    """
    found: set[str] = set()
    waiting: list[ast.AST] = [_parsed(source)]
    while waiting:
        for node in ast.iter_child_nodes(waiting.pop()):
            match node:
                case ast.FunctionDef(name=name) | ast.ClassDef(name=name):
                    found.add(name)
                case ast.Name(id=name, ctx=ast.Store()):
                    found.add(name)
                case ast.alias():
                    found.add((node.asname or node.name).split(".")[0])
                case ast.Lambda() | ast.comprehension():
                    pass
                case _:
                    waiting.append(node)
    return found


def _used_in(source: str) -> set[str]:
    return {n.id for n in _walked(source) if isinstance(n, ast.Name) and isinstance(n.ctx, ast.Load)}


def _imports(source: str) -> bool:
    return any(isinstance(node, ast.Import | ast.ImportFrom) for node in _walked(source))


def _checks(source: str) -> bool:
    """Whether a cell compares results with the ledger; an answer to an exercise is none."""
    for node in _walked(source):
        match node:
            case ast.Call(func=ast.Attribute(value=ast.Call(func=ast.Name("exercise")), attr="check")):
                pass
            case ast.Call(func=ast.Attribute(attr="check")):
                return True
    return False


def _outputs(outputs: list[NotebookNode]) -> list[NotebookNode]:
    kept: list[NotebookNode] = []
    for output in copy.deepcopy(outputs):
        if WIDGET in output.get("data", {}):
            if PICTURES.isdisjoint(output.data):
                continue
            del output.data[WIDGET]
        if output.output_type == "execute_result":
            output.execution_count = None
        # How many pieces a printed text arrives in depends on how fast the machine is.
        if output.output_type == "stream" and kept and kept[-1].get("name") == output.name:
            kept[-1].text += output.text
        else:
            kept.append(output)
    return kept


def unfit(notebook: NotebookNode) -> list[str]:
    """What `notebook` shows that may not be stored: errors, warnings, paths of a machine, memory addresses.

    >>> from nbformat import v4
    >>> output = v4.new_output("stream", name="stdout", text="<Loop object at 0x7f3a5c0d1e50>")
    >>> unfit(v4.new_notebook(cells=[v4.new_code_cell("print(loop)", outputs=[output])]))
    ["cell [1] 'print(loop)': shows a memory address, 0x7f3a5c0d1e50"]
    """
    problems = []
    for label, cell in labelled(notebook):
        texts = [cell.source]
        for output in cell.get("outputs", []):
            if output.output_type == "error":
                problems.append(f"{label}: stored error {output.ename}: {_first_line(output.evalue)}")
            if output.get("name") == "stderr":
                problems.append(f"{label}: writes to stderr: {_first_line(output.text)}")
            texts += [output.get("text", "")]
            texts += [json.dumps(data) for mime, data in output.get("data", {}).items() if mime not in PICTURES]
        for text in texts:
            if path := PATH.search(text):
                problems.append(f"{label}: shows a path of one machine, {path[0]}")
            if address := ADDRESS.search(text):
                problems.append(f"{label}: shows a memory address, {address[0]}")
    return problems


def labelled(notebook: NotebookNode) -> Iterator[tuple[str, NotebookNode]]:
    """The cells with what a reader finds them by, their first line; the seventh code cell is ``cell [7]`` besides.

    That is the number beside it after the notebook has been run.
    """
    count = 0
    for cell in notebook.cells:
        beginning = repr(_first_line(cell.source)[:40])
        if cell.cell_type == "code":
            count += 1
            yield f"cell [{count}] {beginning}", cell
        else:
            yield f"text {beginning}", cell


def as_text(notebook: NotebookNode) -> str:
    """The text of the notebook's file: JSON in the manner of JupyterLab, with a newline at the end."""
    return nbformat.writes(notebook) + "\n"


def store(text: str, path: Path) -> bool:
    """Make `text` the content of `path` in one step, so that no interruption leaves half a notebook.

    Returns whether that changed the file. Lines end in LF on every system.
    """
    content = text.encode()
    if path.exists() and path.read_bytes() == content:
        return False
    partial = path.with_name(f".{path.name}.partial")
    partial.write_bytes(content)
    partial.replace(path)
    return True
