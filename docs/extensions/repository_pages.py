"""Pages of the repository within the site: a block `repository-page` in a page is replaced by a file, or a part of it.

Its links lead to the site's own pages where there are such, and else to the repository, once that has an address; until
then the text of such a link is left. `THE-ADDRESS` in a page of the site is that of the repository. Options: `from` and
`until` cut at the first occurrence of a text, `deeper` moves headings down by so many levels. The text is put in before
the page is read, because headings are to be those of the page.
"""

import posixpath
import re
from pathlib import Path

from repository import ADDRESS

ROOT = Path(__file__).parents[2]
PAGES = {
    "ERRATA.md": "errata.md",
    "CONTRIBUTING.md": "contributors.md",
    "README.md": "index.md",
    "examples/course/README.md": "instructors.md",
    "examples/autograder/README.md": "instructors.md",
    "chapters": "index.md",
    "solutions": "solutions.md",
}
BLOCK = re.compile(r"^```\{repository-page\} (.*)\n((?::.*\n)*)```$", re.MULTILINE)
OPTION = re.compile(r"^:(from|until|deeper): (.*)$", re.MULTILINE)
_LINK = re.compile(r"\[([^\[\]]*)\]\((?![a-z]+:|#)([^)\s#]+)(#[^)\s]*)?\)")
_FENCE = re.compile(r"^( *)(```+).*?^\1\2$", re.MULTILINE | re.DOTALL)


def target(file, link, anchor="", address=ADDRESS):
    """Return where a link of a file of the repository leads to in the site; nothing where that is not known.

    >>> target("CONTRIBUTING.md", "ERRATA.md")
    '/errata.md'
    >>> target("ERRATA.md", "chapters/10_tuning.ipynb")
    '/chapters/10_tuning.ipynb'
    >>> target("examples/course/README.md", "roster.csv", address="https://github.com/OWNER/NAME")
    'https://github.com/OWNER/NAME/blob/main/examples/course/roster.csv'
    """
    path = posixpath.normpath(posixpath.join(posixpath.dirname(file), link))
    if path.endswith(".ipynb"):
        return f"/{path}{anchor}"
    if path.startswith("docs/"):
        return f"/{path.removeprefix('docs/')}"
    if path in PAGES:
        return f"/{PAGES[path]}{anchor}"
    return address and f"{address}/{'tree' if (ROOT / path).is_dir() else 'blob'}/main/{path}{anchor}"


def text_of(file, begin="", end="", deeper=0):
    """Return the text of a file without its title, with its links as the site needs them.

    Raises:
        ValueError: the file does not hold the text at which it should be cut.
    """
    text = (ROOT / file).read_text(encoding="utf-8")
    for mark in (begin, end):
        if mark and mark not in text:
            raise ValueError(f"{file} does not hold {mark!r}, at which a page of the site cuts it")
    text = text[text.index(begin) + len(begin) :] if begin else re.sub(r"\A# .*\n", "", text)
    text = text.partition(end)[0] if end else text
    pieces, start = [], 0
    for fence in _FENCE.finditer(text):
        pieces += [_mended(file, text[start : fence.start()], deeper), fence[0]]
        start = fence.end()
    return "".join([*pieces, _mended(file, text[start:], deeper)])


def _mended(file, text, deeper):

    def link(found):
        leads = target(file, found[2], found[3] or "")
        return f"[{found[1]}]({leads})" if leads else found[1]

    text = _LINK.sub(link, text)
    return re.sub(r"^(?=#+ )", "#" * deeper, text, flags=re.MULTILINE)


def put_in(app, docname, source):
    """Replace the blocks of a page by what they name."""

    def text(block):
        file, options = block[1], dict(OPTION.findall(block[2]))
        app.env.note_dependency(str(ROOT / file), docname=docname)
        return text_of(file, options.get("from", ""), options.get("until", ""), int(options.get("deeper", 0))).strip()

    source[0] = source[0].replace("THE-ADDRESS", ADDRESS or "THE-ADDRESS")
    # what the ledger writes calls a chapter by its file
    source[0] = re.sub(r"(?<=\(\[)0?(\w+?)_\w+(?=\]\(/chapters/)", r"chapter \1", BLOCK.sub(text, source[0]))


def setup(app):
    """Join Sphinx."""
    app.connect("source-read", put_in)
    return {"parallel_read_safe": True, "parallel_write_safe": True}
