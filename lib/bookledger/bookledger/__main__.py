"""Write a page of HTML and a list of errata, from ledgers and from the checks that notebooks store.

python -m bookledger ledger/*.toml --notebooks chapters
"""

import argparse
import json
from collections.abc import Mapping, Sequence
from html import escape
from pathlib import Path
from typing import Any

from bookledger.errata import listed, totals
from bookledger.results import FAILS
from bookledger.source import Source
from bookledger.statuses import STATUSES, Corrected
from bookledger.stored import checks

_HEAD = """<!DOCTYPE html><html lang="en"><meta charset="utf-8"><meta name="viewport" content="width=device-width">
<title>Ledger</title><style>td:first-child { white-space: nowrap; }
body { font: 16px/1.5 sans-serif; max-width: 62em; margin: 2em auto; padding: 0 1em; } p { color: #444; }
table { border-collapse: collapse; width: 100%; } td, th { text-align: left; vertical-align: top; padding: .3em .6em; }
tr { border-bottom: 1px solid #ccc; } .agrees td:first-child { color: #176b2c; } .fails { color: #a3161b; }</style>"""
_COLUMNS = "<tr><th>verdict</th><th>equation</th><th>result</th><th>book</th><th>computed</th></tr>"


def page(sources: Mapping[str, Source], stored: Mapping[tuple[str, str], Mapping[str, Any]]) -> str:
    """Return a page of all results, beside what the stored checks, by source and entry, have computed."""
    lines = [_HEAD]
    for name, counts in totals(sources).items():
        counted = ", ".join(f"{count} {word}" for word, count in counts.items() if count)
        lines += [f"<h1>{escape(sources[name].title)}</h1>", f"<p>{escape(sources[name].citation)}: {counted}.</p>"]
        for entry in sources[name]:
            check = stored.get((name, entry.name), {"verdicts": [], "notes": ["No notebook checks it."]})
            lines += [f"<h2>{escape(entry.name)} · {escape(entry.title)}</h2><table>{_COLUMNS}"]
            for row in check["verdicts"]:
                sign, kind = STATUSES[row["status"]].mark if row["holds"] else FAILS
                cells = (f"{sign} {row['word']}", row.get("equation", ""), row["title"], row["book"], row["computed"])
                lines.append(f'<tr class="{kind}">{"".join(f"<td>{escape(cell)}</td>" for cell in cells)}</tr>')
            lines += ["</table>", *(f"<p>{escape(note)}</p>" for note in check["notes"])]
    return "\n".join([*lines, "</html>\n"])


def main(arguments: Sequence[str] | None = None) -> None:
    """Write ledger.html and ERRATA.md into the folder in which it is run."""
    parser = argparse.ArgumentParser(prog="python -m bookledger", description=(__doc__ or "").partition("\n")[0])
    parser.add_argument("sources", nargs="+", type=Path, help="ledgers, as TOML files")
    parser.add_argument("--notebooks", type=Path, required=True, help="the folder of the notebooks that check them")
    told = parser.parse_args(arguments)
    found = (one for path in told.notebooks.glob("*.ipynb") for one in checks(json.loads(path.read_text("utf-8"))))
    books = {path.stem: Source.open(path) for path in told.sources}
    errata = listed(books, Corrected, f"{told.notebooks.as_posix()}/")
    html = page(books, {(check["source"], check["entry"]): check for check in found})
    Path("ledger.html").write_text(html, encoding="utf-8")
    Path("ERRATA.md").write_text(f"# Errata\n\n{errata}", encoding="utf-8")


if __name__ == "__main__":
    main()
