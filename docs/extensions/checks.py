"""A check of a chapter, and a row of the ledger, as HTML, from the data that a notebook stores with its check."""

import html
import re
from xml.etree import ElementTree

import permanent
from mathml import in_html, width
from slugs import check_anchor, ledger_anchor

from bookledger.statuses import STATUSES
from loopbook.ledger import sources

MIME_TYPE = "application/vnd.loopbook.check+json"
WIDE = 26  # letters of a formula that fit into a cell, on a phone too
COLUMNS = ("verdict", "equation", "result", "book", "computed")
#: Between two cases of some evidence, each with its name; the other semicolons of HTML end a sign such as "&lt;".
CASE = re.compile(r"(?<!&lt)(?<!&gt)(?<!&amp); (?=[^<>;&]{1,40}: )")
CLAIMS = ("verdict", "equation", "claim", "evidence")


def typeset(verdict, key, formulas=in_html):
    """Return a text of a verdict, its title, print or computed value, as HTML with its formulas."""
    text = verdict.get("tex", {}).get(key, verdict[key])
    pieces = re.split(r"(\$[^$]+\$)", text)
    # what is no formula is text, also where it has a sign that HTML knows
    return formulas("".join(html.escape(p, quote=False) if n % 2 == 0 else p.replace("<", r"\lt ").replace(">", r"\gt ")
                            for n, p in enumerate(pieces)))  # fmt: skip


def cells(verdict, formulas=in_html, equations=True):
    """Return the cells of a verdict: what was done first, then equation, result, print, and what was computed.

    Arguments:
        verdict: as a notebook stores it.
        formulas: what writes those of a text as HTML.
        equations: whether there is a column for their numbers.
    """
    status = STATUSES[verdict["status"]]
    sign = status.mark[0] if verdict["holds"] else "✗"
    word, _, more = verdict["word"].partition(" (")
    more = f" <small>{html.escape(more.rstrip(')'))}</small>" if more else ""
    title, book, computed = (typeset(verdict, key, formulas) for key in ("title", "book", "computed"))
    equation = f"({html.escape(verdict['equation'])})" if "equation" in verdict else ""
    label = f' aria-label="{html.escape(verdict["name"])}"' if "<math" in title else ""  # for readers of a screen
    parts = [
        f'<td class="verdict {verdict["status"].replace(" ", "-")}">{sign}&nbsp;{html.escape(word)}{more}',
        *([f'<td class="equation">{equation}'] if equations else []),
    ]
    if verdict["kind"] == "claim":
        computed = CASE.sub("<br>", computed)
        denied = f" <small>({book})</small>" if book != "says so" else ""
        parts.append(f'<th scope="row" class="claim" colspan="2">{title}{denied}')
    else:
        parts += [f'<th scope="row" class="result"{label}>{title}', f'<td class="book">{_framed(book)}']
    if verdict["kind"] == "formula" and computed == book:
        computed = "the same"
    return "".join([*parts, f'<td class="value">{_framed(computed) or "–"}'])


def check(data, taken):
    """Return the check of an entry as one line that opens, with its place and its link to the ledger.

    Arguments:
        data: what a notebook stores.
        taken: the names of the page's places; what has none yet gets its name here: the entry, and its equations. A
            status is explained where the page has it first.
    """
    chapter = sources()[data["source"]][data["entry"]].chapter
    place, heading = ledger_anchor(data["source"], data["entry"]), html.escape(data["heading"], quote=False)
    equations = any("equation" in verdict for verdict in data["verdicts"])
    columns = CLAIMS if all(verdict["kind"] == "claim" for verdict in data["verdicts"]) else COLUMNS
    wide = {"claim": ' colspan="2"'}
    head = "".join(f'<th scope="col"{wide.get(name, "")}>{name}' for name in columns if equations or name != "equation")
    sign = "✓" if all(verdict["holds"] for verdict in data["verdicts"]) else "✗"
    entry, rows = fresh(permanent.names_of(data["entry"]), taken), []
    for verdict in data["verdicts"]:
        names = fresh(permanent.names_of(f"Equation {verdict.get('equation', '-')}"), taken)
        rows.append(f"<tr{numbered(cells(verdict, equations=equations), names)}")
    return "\n".join(
        [
            *(f'<span id="{name}"></span>' for name in entry),
            f'<details class="check" id="{check_anchor(data["source"], data["entry"])}">',
            f"<summary>{sign} <strong>{heading}</strong>: {html.escape(data['counts'])}</summary>",
            '<div class="table" tabindex="0">',
            f'<table class="results"><thead><tr>{head}</thead><tbody>',
            *rows,
            "</table></div>",
            *(f"<p>{code(note)}</p>" for note in data["notes"]),
            f'<p><a href="../ledger/{chapter}.html#{place}">In the ledger</a></p>',
            "</details>",
            *meanings(data, taken),
        ]
    )


def meanings(data, taken):
    """What the counts of a check mean, where the page has no check above it that has said so."""
    new = [word for word in STATUSES if any(word == verdict["status"] for verdict in data["verdicts"])]
    new = [name.removeprefix("means ") for name in fresh([f"means {word}" for word in new], taken)]
    said = "; ".join(f"<strong>{word}</strong>: {html.escape(STATUSES[word].meaning)}" for word in new)
    first = (
        "A check compares what the book prints with what the cells above have found. "
        if fresh(["means"], taken)
        else ""
    )
    return [f'<p class="means">{first}{said[:1].upper()}{said[1:]}.</p>'] if said else []


def fresh(names, taken):
    """Those of some names that are not taken; now they are."""
    found = [name for name in names if name not in taken]
    taken.update(found)
    return found


def numbered(cells, names):
    """The rest of a row: its names, and a number that is a link to it."""
    if not names:
        return f">{cells}"
    first, *others = names
    more = "".join(f'<span id="{name}"></span>' for name in others)
    cells = re.sub(
        r'<td class="equation">(\([^<]*\))', rf'<td class="equation">{more}<a href="#{first}">\1</a>', cells, count=1
    )
    return f' id="{first}">{cells}'


def code(text):
    """Return a sentence as HTML, what is between back-quotes as code."""
    return re.sub(r"`([^`]+)`", r"<code>\1</code>", html.escape(text, quote=False))


def _framed(cell):
    """A cell whose formula scrolls within itself where it is wide; it is then reached by the keyboard too."""
    found = re.findall(r"<math.*?</math>", cell, re.DOTALL)
    wide = any(width(ElementTree.fromstring(formula)) > WIDE for formula in found)
    return f'<div class="wide" tabindex="0">{cell}</div>' if wide else cell
