"""Every link in the collection's pages leads somewhere."""

import json
import re
from pathlib import Path

import pytest

ROOT = Path(__file__).parents[2]
LINK = re.compile(r"\]\(([^)\s#]+)[^)]*\)")
PAGES = [*ROOT.glob("*.md"), *ROOT.glob("chapters/*.ipynb"), *ROOT.glob("solutions/*.ipynb")]


def links(page):
    text = page.read_text(encoding="utf-8")
    if page.suffix == ".ipynb":
        cells = (cell for cell in json.loads(text)["cells"] if cell["cell_type"] == "markdown")
        text = "\n".join("".join(cell["source"]) for cell in cells)
    return [link for link in LINK.findall(text) if ":" not in link]


@pytest.mark.parametrize("page", PAGES, ids=lambda page: page.name)
def test_relative_links_exist(page):
    missing = [link for link in links(page) if not (page.parent / link).exists()]
    assert not missing, f"{page.name} links to {', '.join(missing)}"


def test_links_are_found():
    assert "ERRATA.md" in links(ROOT / "README.md")
