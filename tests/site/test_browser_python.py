"""Python in the browser says what Python here says: to an answer, to a page that asks, and in the chapters.

An ordinary run compares a part; ``make test-all`` compares every answer that the tests give, every exercise as a form,
and all chapters with their solutions. One Pyodide does all of it.
"""

import json
import time

import nbformat
import pytest

import answers_of_tests
import browser_python
import in_browser
from draws import THOROUGH
from exercisebook.judging import SECONDS
from loopbook.exercises import bank
from typed import typed

ROOT = browser_python.ROOT
SOME = 200
CHAPTERS = (
    sorted(f"{folder}/{path.name}" for folder in ("chapters", "solutions") for path in (ROOT / folder).glob("*.ipynb"))
    if THOROUGH
    else ["chapters/02_block_diagrams.ipynb", "chapters/04_laplace.ipynb", "chapters/05_transfer_functions.ipynb"]
)
EXERCISES = [number for chapter in bank.chapters() for number in bank.exercises(chapter)][:: 1 if THOROUGH else 16]


def requests(number, student):
    """What a page asks about an exercise: to see it, and to judge what is typed."""
    key = bank.exercises(number.partition(".")[0])[number].question(student).key
    about = {"exercise": number, "student": student}
    yield json.dumps({"do": "show", **about})
    yield json.dumps({"do": "check", "answers": {name: typed(kind) for name, kind in key.items()}, **about})


def judged_here(answers):
    """What is said here to answers, in pairs, but for those that are stopped here: a page stops them otherwise."""
    for answer in answers:
        began = time.process_time()
        said = in_browser.judged(answer)
        stopped = any(isinstance(one, list) and "takes too long" in one[2] for one in said)
        if not stopped and time.process_time() - began < 0.8 * SECONDS:
            yield answer, said


def stored(path):
    """What the code cells of a notebook show as text, by their ids."""
    for cell in nbformat.read(ROOT / path, as_version=4).cells:
        if cell.cell_type == "code":
            printed = "".join(output.text for output in cell.outputs if output.output_type == "stream")
            yield cell.id, in_browser.texts(printed, "", [one.data for one in cell.outputs if "data" in one])


class Both:
    """What is said here, and what is said there."""

    def __init__(self, folder):
        parts = browser_python.required()
        answers = answers_of_tests.of_all(folder) if THOROUGH else answers_of_tests.of_bank(SOME, seed=24)
        self.answers = list(judged_here(answers))
        self.requests = [one for number in EXERCISES for one in requests(number, "Ada")]
        jobs = [("answer", answer) for answer, _ in self.answers] + [("request", one) for one in self.requests]
        jobs += [("chapter", f"/{path}") for path in CHAPTERS]
        there = iter(browser_python.performed(jobs, parts, folder))
        self.judged = [next(there) for _ in self.answers]
        self.replied = [next(there) for _ in self.requests]
        self.shown = {path: next(there) for path in CHAPTERS}


@pytest.fixture(scope="module")
def both(tmp_path_factory):
    return Both(tmp_path_factory.mktemp("browser"))


def test_an_answer_is_judged_in_the_browser_as_here(both):
    assert len(both.answers) >= (10_000 if THOROUGH else 0.9 * SOME)
    other = [
        f"{answer!r}: here {said}, there {found}"
        for (answer, said), found in zip(both.answers, both.judged, strict=True)
        if found.get("is") != json.loads(json.dumps(said))
    ]
    assert other == []


def test_a_form_replies_in_the_browser_as_here(both):
    other = [
        f"{request}: here {said}, there {found}"
        for request, found in zip(both.requests, both.replied, strict=True)
        if found.get("is") != (said := json.loads(json.dumps(in_browser.replied(request))))
    ]
    assert other == []


@pytest.mark.parametrize("path", CHAPTERS)
def test_a_chapter_shows_in_the_browser_what_is_stored(both, path):
    assert "is" in both.shown[path], both.shown[path]
    cells = dict(stored(path))
    other = [
        f"{cell}: stored {said}, there {found}"
        for (cell, said), found in zip(cells.items(), both.shown[path]["is"], strict=True)
        if found != json.loads(json.dumps(said))
    ]
    assert other == []


def test_what_only_this_python_has_is_not_sent():
    assert answers_of_tests.portable(2.5)
    assert answers_of_tests.portable({"K": bank}) is None
    assert answers_of_tests.portable(judged_here) is None
