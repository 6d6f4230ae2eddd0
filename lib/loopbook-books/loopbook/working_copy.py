"""The reader's own copy of the notebooks: what she has not changed stays up to date, what she has changed stays hers.

`brought_up_to_date` copies chapters and solutions from the repository into a folder that git ignores. A notebook counts
as changed when the text of a cell differs from what was copied: to run it changes nothing, and neither does saying
one's name, which has a file of its own. No notebook imports this module; ``python -m loopbook lab`` does.
"""

import json
import re
import shutil
from hashlib import sha256
from pathlib import Path

FOLDER = "my-copy"
PARTS = ("chapters", "solutions")
START = "chapters/00_start.ipynb"
#: What was copied: {notebook: {"original": its bytes, "cells": its text, "told": the newer original she knows of}}.
RECORD = ".loopbook-copies.json"


def originals(repository: Path) -> dict[str, Path]:
    """Return the notebooks of the repository by their names in the copy, such as "chapters/10_tuning.ipynb"."""
    return {f"{part}/{path.name}": path for part in PARTS for path in sorted((repository / part).glob("*.ipynb"))}


def brought_up_to_date(repository: Path, copy: Path) -> list[str]:
    """Make the copy, or renew in it what the reader has not changed.

    Returns the notebooks that she has changed, and of which there is now a newer one that she was not told of yet.
    """
    is_new = not copy.exists()
    record, news = _recorded(copy), []
    there = originals(repository)
    for name, original in there.items():
        known, now = record.setdefault(name, {}), _digest(original)
        if not (copy / name).exists() or (known.get("original") != now and _is_as_copied(copy / name, original, known)):
            record[name] = _copied(original, copy / name)
        elif now not in (known.get("original"), known.get("told")):
            known["told"] = now
            news.append(name)
    for name in [name for name in record if name not in there]:  # its original has gone
        known = record.pop(name)
        if (copy / name).exists() and cells(copy / name) == known.get("cells"):
            (copy / name).unlink()
    if is_new:
        for remembered in repository.glob("chapters/.loopbook-*.json"):  # answers given before there was a copy
            shutil.copy(remembered, copy / "chapters")
    _write(copy / RECORD, json.dumps(record, indent=1, sort_keys=True).encode())
    return news


def fresh(repository: Path, copy: Path, wanted: str) -> list[tuple[str, str | None]]:
    """Put fresh notebooks into the copy, and keep under another name those that the reader has changed.

    Arguments:
        wanted: number or name of a chapter, as "10" or "tuning", or a notebook, as "solutions/10_tuning.ipynb".
    Returns:
        The notebook and the name under which the changed one is kept, or None, for each notebook that was meant.
    """
    record, done = _recorded(copy), []
    for name, original in originals(repository).items():
        if not _is_meant(name, wanted):
            continue
        mine, kept = copy / name, None
        if mine.exists() and not _is_as_copied(mine, original, record.get(name, {})):
            kept = _free(mine)
            mine.rename(kept)
        record[name] = _copied(original, mine)
        done.append((name, kept and kept.relative_to(copy).as_posix()))
    if done:
        _write(copy / RECORD, json.dumps(record, indent=1, sort_keys=True).encode())
    return done


def cells(path: Path) -> str | None:
    """Return a digest of what stands in the cells of a notebook, their outputs left aside; None where it is none."""
    try:
        found = [
            (cell["cell_type"], "".join(cell["source"]).strip())
            for cell in json.loads(path.read_text(encoding="utf-8"))["cells"]
        ]
    except (OSError, ValueError, KeyError, TypeError, RecursionError):
        return None
    kept = [(kind, text) for kind, text in found if text and not re.fullmatch(r"student\([^\n]*\)", text)]
    return sha256(json.dumps(kept).encode()).hexdigest()


def _is_as_copied(mine, original, known):
    """Whether the reader's notebook has the text of the one that was copied, or already that of the newer one."""
    text = cells(mine)
    return text is not None and text in (known.get("cells"), cells(original))


def _is_meant(name, wanted):
    part, stem = name.removesuffix(".ipynb").split("/")
    number, _, title = stem.partition("_")
    names = {number, number.lstrip("0") or "0", title, stem} if part == "chapters" else set()
    return wanted in {name, *names}


def _copied(original, target):
    """Copy a notebook, and return what is to be recorded of it."""
    _write(target, original.read_bytes())
    return {"original": _digest(original), "cells": cells(original)}


def _free(mine):
    """A name of which there is no notebook yet."""
    number, kept = 1, mine.with_stem(f"{mine.stem}_mine")
    while kept.exists():
        number += 1
        kept = mine.with_stem(f"{mine.stem}_mine_{number}")
    return kept


def _recorded(copy):
    try:
        record = json.loads((copy / RECORD).read_text(encoding="utf-8"))
        return {name: dict(known) for name, known in record.items()}
    except (OSError, ValueError, TypeError, AttributeError, RecursionError):
        return {}  # then a notebook that differs from its original is hers


def _digest(path):
    return sha256(path.read_bytes()).hexdigest()


def _write(path, content):
    """Write a file in one step, so that an interruption leaves the old one or the new one."""
    path.parent.mkdir(parents=True, exist_ok=True)
    partial = path.with_name(f".{path.name}.partial")
    partial.write_bytes(content)
    partial.replace(path)
