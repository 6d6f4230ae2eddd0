"""A release says one version, one address and its licences wherever they stand, and its commands change all of them."""

import json
import re
import shutil
import tomllib
from pathlib import Path

import pytest
import yaml

import release

ROOT = Path(__file__).parents[2]
PACKAGES = sorted(path.parent for path in (ROOT / "lib").glob("*/pyproject.toml"))
ADDRESS = "https://github.com/OWNER/NAME"


def project(folder):
    return tomllib.loads((folder / "pyproject.toml").read_text(encoding="utf-8"))["project"]


@pytest.fixture
def copy(tmp_path):
    """The files in which the commands write, elsewhere."""
    for name in [*release.LINES, "README.md", "CHANGELOG.md"]:
        (tmp_path / name).parent.mkdir(parents=True, exist_ok=True)
        shutil.copy(ROOT / name, tmp_path / name)
    return tmp_path


def texts(root):
    return {name: (root / name).read_text(encoding="utf-8") for name in [*release.LINES, "README.md", "CHANGELOG.md"]}


# The version.


def test_the_version_that_stands_here_can_be_released_under_its_tag_and_no_other():
    assert release.wrong(f"v{release.version()}") == []
    assert release.wrong(release.version())
    assert release.notes()


def test_one_command_changes_the_version_wherever_it_stands(copy):
    before = texts(copy)
    text = before["CHANGELOG.md"].replace("\n## ", "\n## Not yet released\n\nMore.\n\n## ", 1)
    (copy / "CHANGELOG.md").write_text(text, encoding="utf-8")
    release.set_version("9.8.7rc1", "2031-02-03", copy)
    assert release.wrong("v9.8.7rc1", copy) == []
    assert release.notes(copy) == "More."
    for name in release.LINES:
        assert release.version() not in texts(copy)[name], name
    release.set_version(release.version(), yaml.safe_load(before["CITATION.cff"])["date-released"].isoformat(), copy)
    assert {name: texts(copy)[name] for name in release.LINES} == {name: before[name] for name in release.LINES}


def test_what_keeps_a_tag_from_being_released_is_named(copy):
    file = copy / "lib" / "exercisebook" / "pyproject.toml"
    file.write_text(file.read_text(encoding="utf-8").replace("plainmath==", "plainmath==7."), encoding="utf-8")
    (found,) = release.wrong(f"v{release.version()}", copy)
    assert found.startswith("lib/exercisebook/pyproject.toml says version ")
    with pytest.raises(ValueError, match="expected one as"):
        release.set_version("next", "2031-02-03", copy)


def test_a_citation_names_the_version():
    said = yaml.safe_load((ROOT / "CITATION.cff").read_text(encoding="utf-8"))
    assert said["version"] == release.version()
    assert f"## {said['version']} ({said['date-released']})" in (ROOT / "CHANGELOG.md").read_text(encoding="utf-8")


# The address.


@pytest.mark.parametrize("known", [ADDRESS, f"{ADDRESS}/tree/next", ""])
def test_one_command_changes_the_address_wherever_it_stands(copy, known):
    now = project(ROOT)["urls"].get("Repository", "")
    before = texts(copy)
    release.set_address("https://github.com/before/this", copy)
    release.set_address(known, copy)
    assert "before/this" not in "".join(texts(copy).values())
    for folder in [copy, *(copy / "lib" / path.name for path in PACKAGES)]:
        assert project(folder)["urls"].get("Repository", "") == known
    assert yaml.safe_load(texts(copy)["CITATION.cff"]).get("repository-code", "") == known
    assert texts(copy)["README.md"].count("OWNER/NAME") == (3 if known else 0)
    release.set_address(now, copy)
    assert texts(copy) == before


def test_no_page_leads_to_a_repository_that_is_not_there():
    """What a reader sees names no other address than that of pyproject.toml."""
    known = project(ROOT)["urls"].get("Repository") or "no address"
    pages = [
        *ROOT.glob("*.md"),
        *ROOT.glob("docs/*.md"),
        *ROOT.glob("chapters/*.ipynb"),
        *ROOT.glob("solutions/*.ipynb"),
    ]
    for page in pages:
        links = re.findall(r"https://(?:mybinder|colab|codespaces|github)[^\s)>\"]*", page.read_text(encoding="utf-8"))
        owner = known.removeprefix("https://github.com/").partition("/tree/")[0]
        assert [link for link in links if not re.search(f"{owner}|OWNER|YOUR-NAME", link)] == [], page.name


# The licences.


def test_each_package_holds_its_licences_as_they_are():
    for folder in PACKAGES:
        assert (folder / "LICENSE").read_bytes() == (ROOT / "LICENSE").read_bytes()
        expression = project(folder)["license"]
        assert (folder / "LICENSE-CONTENT").exists() == ("CC-BY-4.0" in expression)
        assert "BSD-3-Clause" in expression
    content = (ROOT / "LICENSE-CONTENT").read_bytes()
    assert (ROOT / "lib" / "loopbook-books" / "LICENSE-CONTENT").read_bytes() == content
    assert content.startswith(b"Attribution 4.0 International\n\n=====")


# The paper, what publishes, and the forms.


def test_the_paper_is_short_and_cites_what_its_list_has():
    paper, listed = ((ROOT / "docs" / "paper" / f"paper.{end}").read_text(encoding="utf-8") for end in ("md", "bib"))
    _, head, text = paper.split("---\n", 2)
    assert {"title", "tags", "authors", "affiliations", "date", "bibliography"} == {*yaml.safe_load(head)}
    assert len(text.split()) <= 1000
    assert {*re.findall(r"@(\w+)", text)} == {*re.findall(r"(?m)^@\w+\{(\w+)", listed)}


def test_a_tag_is_checked_and_its_wheels_are_proved_before_they_are_published():
    jobs = yaml.safe_load((ROOT / ".github/workflows/publish.yml").read_text(encoding="utf-8"))["jobs"]
    said = {name: json.dumps(job) for name, job in jobs.items()}
    assert "release.py check" in said["build"]
    assert "alone.py --into dist" in said["build"]
    assert jobs["publish"]["needs"] == "build"
    assert jobs["publish"]["permissions"] == {"id-token": "write"}
    assert [name for name, text in said.items() if "id-token" in text] == ["publish"]
    assert "release.py notes" in said["release"]


def test_forms_for_issues_are_forms():
    forms = sorted((ROOT / ".github" / "ISSUE_TEMPLATE").glob("*.yml"))
    assert len(forms) == 4
    for path in forms:
        form = yaml.safe_load(path.read_text(encoding="utf-8"))
        assert {"name", "description", "body"} <= {*form}, path.name
        ids = [field["id"] for field in form["body"] if field["type"] != "markdown"]
        assert ids
        assert len(ids) == len({*ids})
