"""What a change anywhere must leave standing of the grader and of the site; lanes of their own prove all of both."""

import csv
import subprocess
import sys
from collections import Counter
from pathlib import Path

import pytest
from matplotlib import pyplot

from courses import Course
from exercisegrader.inside.rehearsal import rehearse
from loopbook.exercises.bank import exercises
from needs import needs_jail
from test_book import Page

ROOT = Path(__file__).parents[2]
CHAPTER = "05_transfer_functions"
#: Looks for a key where it lies, and for another submission; what it finds it would answer with.
SPYING = """
import contextlib, pathlib
found = ""
for valuable in {valuables!r}:
    with contextlib.suppress(OSError):
        found += pathlib.Path(valuable).read_text()
sheet.answer("1", y={{K}} * 2 if found else 0, p=-1 / {{T}} if found else 0)
"""


@needs_jail
def test_a_class_is_graded_and_who_spies_gains_nothing(tmp_path):
    course = Course(tmp_path)
    valuables = [str(course.path), str(course.submissions / "s0" / "lag.ipynb")]
    course.fill_in("s2", {"1": SPYING.format(valuables=valuables)})
    run = subprocess.run(course.command("graded", "loopbook"), capture_output=True, encoding="utf-8")
    assert run.returncode == 0, run.stderr
    with (tmp_path / "graded" / "grades.csv").open(encoding="utf-8-sig", newline="") as file:
        points = {row["id"]: row["points"] for row in csv.DictReader(file)}
    assert points == {"s0": "5", "s1": "0", "s2": "3", "s3": "5", "s4": ""}
    page = (tmp_path / "graded" / "feedback" / "s1" / "feedback.html").read_text(encoding="utf-8")
    assert "That is the gain." in page


def test_a_rehearsal_leaves_no_figure_for_the_submission_behind_it():
    rehearse()
    assert not pyplot.get_fignums()


@pytest.fixture(scope="module")
def site(tmp_path_factory):
    """The site with one chapter."""
    folder = tmp_path_factory.mktemp("site")
    chapters = (path.stem for path in sorted((ROOT / "chapters").glob("*.ipynb")) if path.stem != CHAPTER)
    others = [f"{part}/{name}.ipynb" for name in chapters for part in ("chapters", "solutions")]
    command = [sys.executable, "-m", "sphinx", "-q", "-b", "html", "-d", str(folder / "doctrees")]
    left_out = ",".join(["lessons", "reference", "ledger*", "figures*", "cheat_sheet.md", *others])
    command += ["-D", f"exclude_patterns={left_out}", "docs", str(folder / "book")]
    sphinx = subprocess.run(command, cwd=ROOT, capture_output=True, encoding="utf-8")
    assert sphinx.returncode == 0, sphinx.stderr
    complaints = [line for line in sphinx.stderr.splitlines() if f"{CHAPTER}.ipynb" in line]
    assert [line for line in complaints if "xref_missing" not in line] == []  # the other chapters are not there
    return folder / "book"


def test_a_chapter_is_a_page_with_formulas_figures_exercises_and_lessons(site):
    page = Page(site / "chapters" / f"{CHAPTER}.html")
    assert not page.torn
    assert len(page.all("math")) > 10
    assert not [text for text in page.text if "$" in text]
    assert all(image.get("alt") for image in page.all("img"))
    classes = Counter(attributes.get("class") for _, attributes, _ in page.elements)
    assert classes["lesson-picture"] == 1
    assert classes["answer"] == len(exercises("5"))
    assert f"../solutions/{CHAPTER}.html#solution-5-1" in {a.get("href") for a in page.all("a")}
    assert (site / "index.html").is_file()
