"""Whether a ledger can be believed: each entry is checked where it belongs, and each assumption earns its status."""

from __future__ import annotations

import importlib

from bookledger.books import Books
from bookledger.source import Source
from plainmath.tables import is_symbol


def complaints(source: str, name: str, books: Books) -> list[str]:
    """Return what is wrong with an entry of the ledger, a sentence for each fault.

    Arguments:
        source, name: of the entry.
        books: the ledger, and the checks that are stored.
    """
    entry = books.written[source][name]
    found = [f"{row['name']}: {why}" for row in entry.get("result", []) for why in _unfit(row)]
    if entry["chapter"] not in books.stored:
        found.append(f"there is no notebook {entry['chapter']}")
    if entry.get("result") and not books.checks_of(source, name):
        found.append(f"no notebook checks it: expected a check in {entry['chapter']}")
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


def of_assumption(source: Source, name: str) -> list[str]:
    """Return what is wrong with the results that rest on an assumption of a source, a sentence for each fault.

    They may be `reconstructed` where they are more than the parameters that were chosen for them; what is one of the
    data that the assumption was made from is `fitted`, and so are all results of one that has no more than parameters.
    """
    resting = [
        (entry, row)
        for entry, table in source.tables.items()
        for row in table.get("result", [])
        if row.get("assuming") == name
    ]
    if not resting:
        return ["no result rests on it"]
    parameters = source.language.assumptions[name].parameters
    if parameters < len(resting):
        return []
    count = f"{parameters} free parameter{'s' * (parameters != 1)} for {len(resting)} result{'s' * (len(resting) != 1)}"
    return [
        f"{entry}, {row['name']} is {row.get('status')}: expected fitted, with {count}"
        for entry, row in resting
        if row.get("status") != "fitted"
    ]
