"""Binder, Codespaces and Colab install what environment.txt says, and the links to them are whole."""

import ast
import json
import re
import shutil
import subprocess
import sys
import tomllib
from pathlib import Path
from urllib.parse import unquote, urlsplit

import pytest
from packaging.requirements import Requirement
from packaging.specifiers import SpecifierSet

ROOT = Path(__file__).parents[2]
ADDRESS = "https://github.com/OWNER/NAME"
sys.path[:0] = [str(ROOT / "docs" / "extensions"), str(ROOT / ".colab")]

import copies  # noqa: E402 - of .colab/, which has just become a place to import from
import launch  # noqa: E402
import prepare  # noqa: E402

PROJECT = tomllib.loads((ROOT / "pyproject.toml").read_text(encoding="utf-8"))["project"]
PACKAGES = sorted((ROOT / "lib").glob("*/pyproject.toml"))
ENVIRONMENT = (ROOT / "environment.txt").read_text(encoding="utf-8")
NOTEBOOKS = [path.relative_to(ROOT).as_posix() for path in sorted(ROOT.glob("chapters/*.ipynb"))]


def text(path):
    return (ROOT / path).read_text(encoding="utf-8")


def devcontainer():
    return json.loads(text(".devcontainer/devcontainer.json"))


# The environment.


def pythons():
    """The Python of each place that is asked for one."""
    return {
        "Binder": re.fullmatch(r"python-(\d+\.\d+)\s*", text(".binder/runtime.txt"))[1],
        "Codespaces": re.match(r"python:(\d+\.\d+)-", devcontainer()["image"])[1],
    }


def test_all_places_have_one_python_which_is_in_range_and_tested():
    (python,) = set(pythons().values())
    assert SpecifierSet(PROJECT["requires-python"]).contains(python)
    assert f'"{python}"' in re.search(r"python: \[(.*)\]", text(".github/workflows/test.yml"))[1]


def test_binder_installs_the_environment_and_nothing_else():
    lines = [line for line in text(".binder/requirements.txt").splitlines() if not line.startswith("#")]
    assert lines == ["-r ../environment.txt"]
    assert (ROOT / ".binder" / lines[0].split()[1]).resolve() == ROOT / "environment.txt"
    assert sorted(path.name for path in (ROOT / ".binder").iterdir()) == ["requirements.txt", "runtime.txt"]


@pytest.mark.skipif(shutil.which("make") is None, reason="there is no make")
def test_a_codespace_makes_what_make_lab_makes():
    assert devcontainer()["postCreateCommand"] == "make .venv/ready"
    assert made("lab").startswith(made(".venv/ready"))
    assert "pip install" in made(".venv/ready")
    assert "--requirement environment.txt" in made(".venv/ready")


def made(target):
    """What make would run for a target on a machine that has nothing yet."""
    command = ["make", "--dry-run", "--always-make", "--no-print-directory", target]
    return subprocess.run(command, cwd=ROOT, capture_output=True, encoding="utf-8", check=True).stdout


def test_a_codespace_opens_files_that_are_there_in_an_editor_that_knows_notebooks():
    tools = devcontainer()["customizations"]
    assert all((ROOT / path).exists() for path in tools["codespaces"]["openFiles"])
    assert {"ms-python.python", "ms-toolsai.jupyter"} == set(tools["vscode"]["extensions"])
    assert ".venv/bin/python" in tools["vscode"]["settings"]["python.defaultInterpreterPath"]
    assert [str(port) for port in devcontainer()["forwardPorts"]] == list(devcontainer()["portsAttributes"])


def test_no_place_has_a_list_of_packages_of_its_own():
    """A version stands in environment.txt only."""
    names = {Requirement(line).name.lower() for line in prepare.constraints(ENVIRONMENT)}
    for path in [
        ".binder/requirements.txt",
        ".devcontainer/devcontainer.json",
        ".colab/copies.py",
        ".colab/prepare.py",
    ]:
        assert not {name.lower() for name in re.findall(r"([\w-]+)[=~<>]=\s*\d", text(path))} & names, path


# Colab.


def test_colab_takes_every_pin_as_a_constraint_and_none_as_a_wish():
    pins = prepare.constraints(ENVIRONMENT)
    assert [line for line in ENVIRONMENT.splitlines() if "==" in line] == pins
    assert all(Requirement(line).specifier for line in pins)
    assert {*ENVIRONMENT.splitlines()} >= {
        f"-e lib/{path.parent.name}" for path in PACKAGES
    }  # which prepare.py installs


def imported(path):
    """The packages that the cells of a notebook import."""
    for cell in json.loads(text(path))["cells"]:
        if cell["cell_type"] == "code":
            for node in ast.walk(ast.parse("".join(cell["source"]))):
                if isinstance(node, (ast.Import, ast.ImportFrom)):
                    names = [alias.name for alias in node.names] if isinstance(node, ast.Import) else [node.module]
                    yield from (name.partition(".")[0] for name in names)


def test_colab_has_what_the_chapters_import():
    """Our packages are installed with what they need."""
    needs = [tomllib.loads(path.read_text(encoding="utf-8"))["project"]["dependencies"] for path in PACKAGES]
    installed = {Requirement(line).name for lines in needs for line in lines}
    needed = {name for path in NOTEBOOKS for name in imported(path)} - set(sys.stdlib_module_names)
    assert needed <= installed


@pytest.mark.parametrize("path", NOTEBOOKS[:2])
def test_a_copy_is_the_notebook_behind_a_cell_that_installs(path):
    original, (first, *rest) = json.loads(text(path)), json.loads(copies.copy(text(path), ADDRESS))["cells"]
    assert rest == original["cells"]
    source = "".join(first["source"])
    assert f"{ADDRESS}.git loopbook\n" in source
    assert (ROOT / source.rpartition("%run loopbook/")[2]).exists()


def test_copies_lie_where_the_links_lead(tmp_path, monkeypatch):
    monkeypatch.setattr(copies, "copy", lambda notebook, address: "")
    copies.main(tmp_path, ADDRESS)
    assert all((tmp_path / path).exists() for path in NOTEBOOKS)
    workflow = text(".github/workflows/colab.yml")
    assert f"--initial-branch {launch.COPIES}" in workflow
    assert re.search(r"git push .* colab$", workflow, re.MULTILINE)


# Links.


@pytest.mark.parametrize("path", ["", *NOTEBOOKS])
def test_links_are_whole(path):
    places = dict(launch.links(path, ADDRESS))
    assert list(places) == ["Binder", "Colab", "Codespaces"]
    for address in places.values():
        assert urlsplit(address).scheme == "https"
        assert "/OWNER/NAME" in address
        assert " " not in address
    assert unquote(places["Binder"]).endswith(f"/main?urlpath=lab/tree/{path or NOTEBOOKS[0]}")
    assert places["Colab"].endswith(f"/blob/colab/{path or NOTEBOOKS[0]}")


def test_where_no_address_is_known_no_link_leads_nowhere():
    assert launch.links(address="") == ()


def test_another_branch_stands_behind_the_address():
    assert launch.of_repository("https://github.com/a/b.c") == ("a/b.c", "main")
    assert launch.of_repository("https://github.com/a/b.git") == ("a/b", "main")
    assert launch.of_repository("https://github.com/a/b/tree/new/look") == ("a/b", "new/look")


@pytest.mark.parametrize("address", ["https://example.org/a/b", "https://github.com/a", ""])
def test_a_repository_elsewhere_is_refused(address):
    with pytest.raises(ValueError, match="expected one on github"):
        launch.of_repository(address)


@pytest.mark.parametrize("place", [launch.links, launch.in_page])
def test_a_notebook_that_is_not_there_is_refused(place):
    with pytest.raises(ValueError, match="there is no chapters/99"):
        place("chapters/99_nothing.ipynb")


def test_in_the_page_a_link_leads_to_the_notebook_or_to_the_first_one():
    assert launch.in_page("solutions/10_tuning.ipynb", "../").endswith("=solutions/10_tuning.ipynb")
    assert launch.in_page().endswith(f"={launch.FIRST}")
