"""Stored notebooks as rules look at them: their cells of code, what is in these, and the checks that they store."""

from __future__ import annotations

import ast
import functools
import re
from collections.abc import Mapping
from pathlib import Path
from typing import TYPE_CHECKING, Any, NamedTuple, Self

from bookledger.report import MIME_TYPE

if TYPE_CHECKING:
    from nbformat import NotebookNode


class Stored(NamedTuple):
    """A notebook as it lies in its folder."""

    path: Path
    text: str
    notebook: NotebookNode

    @classmethod
    def at(cls, path: Path) -> Self:
        """Read a notebook as it is, in whatever version of the format."""
        import nbformat

        text = path.read_bytes().decode()
        return cls(path, text, nbformat.reads(text, as_version=nbformat.NO_CONVERT))


def checks(notebook: Mapping[str, Any]) -> list[dict[str, Any]]:
    """Return the checks that a notebook stores, each the data of a `Report`."""
    outputs = (output for cell in notebook["cells"] for output in cell.get("outputs", []))
    return [output["data"][MIME_TYPE] for output in outputs if MIME_TYPE in output.get("data", {})]


def code(notebook: NotebookNode) -> list[tuple[str, NotebookNode]]:
    """Return the cells of code, each with its number when the notebook has been run and how it begins."""
    cells = [cell for cell in notebook.cells if cell.cell_type == "code"]
    begins = [next((line.strip() for line in cell.source.splitlines() if line.strip()), "") for cell in cells]
    return [(f"cell [{n}] {line[:40]!r}", cell) for n, (line, cell) in enumerate(zip(begins, cells, strict=True), 1)]


def sections(notebook: NotebookNode) -> list[list[tuple[str, NotebookNode]]]:
    """Return the cells of code, with their labels, between one heading of level 2 and the next."""
    labelled = iter(code(notebook))
    found: list[list[tuple[str, NotebookNode]]] = [[]]
    for cell in notebook.cells:
        if cell.cell_type == "code":
            found[-1].append(next(labelled))
        elif re.search(r"^## ", cell.source, re.MULTILINE):
            found.append([])
    return found


def tree(cell: NotebookNode) -> ast.Module:
    """Return the syntax tree of a cell, empty where it is not Python."""
    return parsed(cell.source) or ast.Module([], [])


@functools.cache
def parsed(source: str) -> ast.Module | None:
    """Return the syntax tree of a text, None where it is not Python."""
    try:
        return ast.parse(source)
    except SyntaxError:
        return None


@functools.cache
def walk(part: ast.AST) -> list[ast.AST]:
    """Return every node of a piece of code, of which each rule asks something."""
    return [*ast.walk(part)]
