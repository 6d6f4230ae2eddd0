"""A second opinion on the ledger: whether the checks that are stored bear out what it says of an entry.

Nothing here compares as a check itself does: the ledger is read as plain TOML, evidence is judged from its data.
"""

from __future__ import annotations

import importlib
from collections import Counter
from collections.abc import Mapping
from decimal import Decimal

from bookledger.books import Books, Written
from bookledger.evidence.again import Data, criteria, speaks_for
from bookledger.evidence.criteria import CRITERIA
from bookledger.evidence.probing import apart, same_formula, same_number
from plainmath.tables import is_symbol


def complaints(source: str, name: str, books: Books, points: int) -> list[str]:
    """Return what is wrong with an entry of the ledger, a sentence for each fault.

    Arguments:
        source, name: of the entry.
        books: the ledger, and the checks that are stored.
        points: at how many random points formulas are compared.
    """
    entry, checks = books.written[source][name], books.checks_of(source, name)
    found = [f"{row['name']}: {why}" for row in entry.get("result", []) for why in _unfit(row)]
    if entry["chapter"] not in books.stored:
        found.append(f"there is no notebook {entry['chapter']}")
    if entry.get("result") and not checks:
        found.append(f"no notebook checks it: expected a check in {entry['chapter']}")
    for check in checks:
        values = {verdict["name"]: verdict.get("evidence", verdict["computed"]) for verdict in check["verdicts"]}
        found += untrue(entry, values, books.assumptions(source), points)
    return found


def _unfit(row):
    """What a reader would miss of a result."""
    if not (is_symbol(row["name"]) or "label" in row or "claim" in row):
        yield "is no symbol: expected a label"
    if row.get("status") == "quoted":
        module, _, name = row["library"].rpartition(".")
        try:
            found = getattr(importlib.import_module(module), name)
        except (ImportError, AttributeError, ValueError):
            yield f"quoted by {row['library']}, which cannot be imported"
        else:
            if name.startswith("_") or (callable(found) and not found.__doc__):
                yield f"quoted by {row['library']}, which is not public or says nothing of itself"


def untrue(entry: Written, values: Data, assumed: Counter[str], points: int) -> list[str]:
    """Return the statuses of an entry that are not true, a sentence for each.

    Arguments:
        entry: as the ledger writes it.
        values: what was computed, as text, and evidence as data, by the results' names.
        assumed: how many results of the source rest on each assumption.
        points: at how many random points formulas are compared.
    """
    return [
        f"{row['name']}: {why}"
        for row in entry.get("result", [])
        for why in _untrue(row, values.get(row["name"]), assumed, points)
    ]


def _untrue(row, value, assumed, points):
    status, kind = row.get("status", "computed"), "claim" if "claim" in row else row.get("kind", "number")
    if status == "measured" or (status == "unreproduced" and "computed" not in row):
        return
    if value is None:
        yield "nothing is computed"
        return
    printed = row["claim" if kind == "claim" else "printed"]
    if kind == "claim":
        try:
            told_truly = isinstance(value, Mapping) and value["holds"] is speaks_for(value, points)
        except ValueError as error:
            yield f"the evidence cannot be judged again: {error}"
            return
        if not told_truly:
            yield "no evidence, or told wrongly"
            return
        agrees = value["holds"] is (row.get("says", "true") == "true")
        if status == "computed" and (ours := criteria(value) & {c.word for c in CRITERIA if not c.published}):
            yield f"judged by a criterion of ours, {', '.join(sorted(ours))}"
    else:
        agrees = _same(kind, value, printed, points)
    if status in ("corrected", "damaged", "unreproduced"):
        told = row["computed" if status == "unreproduced" else "correct"]
        if agrees:
            yield "the book is right"
        if kind != "claim" and not _same(kind, value, told, points):
            yield f"{value} is not {told}"
    elif "within" in row:
        if not _within(value, printed, row["within"]):
            yield f"{value} is not within {row['within']} of {printed}"
    elif not agrees:
        yield f"{value} is not {printed}"
    if status == "reconstructed" and assumed[row["assuming"]] < 2:
        yield "an assumption for this number alone"


def _same(kind, value, told, points):
    if kind == "name":
        return value.split() == told.split() or value.lower().split() == told.lower().split()
    return same_number(value, told) if kind == "number" else same_formula(value, told, points)


def _within(value, printed, margin):
    if margin.endswith("%"):
        return apart(value, printed) <= abs(Decimal(printed)) * Decimal(margin.rstrip("% ")) / 100
    return apart(value, printed) <= Decimal(margin)
