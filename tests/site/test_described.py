"""What pages say of themselves in the words of schema.org is JSON, and whole."""

import doctest
import json
import sys
from pathlib import Path
from types import SimpleNamespace

import pytest

ROOT = Path(__file__).parents[2]
sys.path[:0] = [str(ROOT / "docs"), str(ROOT / "docs" / "extensions")]

import described  # noqa: E402 - of docs/extensions/, which has just become a place to import from

PAGES = [path.relative_to(ROOT).with_suffix("").as_posix() for path in sorted(ROOT.glob("[cs]*s/*.ipynb"))]
CHAPTERS = [page for page in PAGES if page.startswith("chapters/") and page != "chapters/00_start"]


@pytest.mark.parametrize("page", ["index", *CHAPTERS])
def test_a_page_says_what_it_teaches_from_which_source_and_under_which_licence(page):
    said = described.of_page(page)
    assert {"name", "teaches", "isBasedOn", "license", "educationalLevel", "version"} <= {*said}
    assert said["@context"] == "https://schema.org"
    assert len(said["teaches"]) >= 3
    assert all("](" not in line and "$" not in line for line in said["teaches"])
    assert page in ("index", "chapters/A_instrument_symbols") or said["isBasedOn"]
    assert "url" not in said
    assert described.of_page(page, "https://control.example.edu/book/")["url"].endswith(f"/book/{page}.html")


def test_it_is_json_which_no_page_mistakes_for_its_own():
    context = {}
    app = SimpleNamespace(config=SimpleNamespace(html_baseurl=""))
    for page in PAGES:
        described.add(app, page, "", context, None)
        assert "<" not in context["described"]
        assert page == "chapters/00_start" or json.loads(context["described"])["@type"]
    for page in ("schools", "solutions"):
        described.add(app, page, "", context, None)
        assert context["described"] == ""


def test_examples():
    assert not doctest.testmod(described).failed
