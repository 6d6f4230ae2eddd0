"""The exercises in the stored notebooks: each is asked in its chapter, unanswered, and solved in its solution."""

import ast
import json
import re
from collections import Counter
from pathlib import Path

import pytest

import hygiene
from exercisebook.judging import OPEN
from loopbook.exercises import bank

ROOT = Path(__file__).parents[2]
MIME_TYPE = "application/vnd.loopbook.response+json"
#: The chapter of each notebook: a chapter may be several notebooks, 11_..., 11b_... and so on.
NOTEBOOKS = {name: re.match(r"0*(\d+|[A-Z])", name)[1] for name in sorted(hygiene.NAMES)}
each_chapter = pytest.mark.parametrize("chapter", bank.chapters())
each_notebook = pytest.mark.parametrize(("name", "chapter"), NOTEBOOKS.items(), ids=NOTEBOOKS)


def cells(folder, name):
    return json.loads((ROOT / folder / f"{name}.ipynb").read_text(encoding="utf-8"))["cells"]


def responses(folder, name):
    """The responses stored in a notebook, in their order."""
    return [
        output["data"][MIME_TYPE]
        for cell in cells(folder, name)
        for output in cell.get("outputs", [])
        if MIME_TYPE in output.get("data", {})
    ]


def calls(folder, name):
    """What a notebook does with exercises: pairs of a number and the answers, None where it shows the statement."""
    found = []
    for cell in cells(folder, name):
        if cell["cell_type"] != "code":
            continue
        for statement in ast.parse("".join(cell["source"])).body:
            match statement:
                case ast.Expr(ast.Call(ast.Name("exercise"), [ast.Constant(number)])):
                    found.append((number, None))
                case ast.Expr(ast.Call(ast.Attribute(ast.Call(ast.Name("exercise"), [ast.Constant(number)]), "check"))):
                    found.append((number, {word.arg: ast.unparse(word.value) for word in statement.value.keywords}))
    return found


def asked(name):
    """The numbers of the exercises whose statements a chapter's notebook shows."""
    return [number for number, answers in calls("chapters", name) if answers is None]


def test_every_chapter_has_exercises():
    assert {*NOTEBOOKS.values()} == {*bank.chapters()}
    assert {name[2:] for name in bank.chapters().values()} <= {*NOTEBOOKS}


@each_chapter
def test_a_chapter_has_one_title(chapter):
    name = bank.chapters()[chapter].removeprefix("ch")
    title = "".join(cells("chapters", name)[0]["source"]).splitlines()[0]
    assert title == f"# {bank.title(chapter)}"


@each_chapter
def test_a_chapter_asks_each_of_its_exercises_in_one_notebook(chapter):
    times = Counter(number for name, own in NOTEBOOKS.items() if own == chapter for number in asked(name))
    for number in bank.exercises(chapter) | times:
        assert number in bank.exercises(chapter), f"a notebook asks exercise {number}, which the bank does not have"
        said = f"exercise {number} is asked in {times[number]} notebooks: expected one, as chapters/{{}}.ipynb, with"
        said += f' exercise("{number}") and exercise("{number}").check(...) in two cells'
        assert times[number] == 1, said.format(bank.chapters()[chapter].removeprefix("ch"))


@each_chapter
def test_a_chapter_has_at_least_four_numbered_in_their_order(chapter):
    numbers = list(bank.exercises(chapter))
    assert len(numbers) >= 4
    assert numbers == [f"{chapter}.{k}" for k in range(1, len(numbers) + 1)]


@each_notebook
def test_a_notebook_asks_exercises_in_their_order_and_answers_none(name, chapter):
    expected = []
    for number in sorted(asked(name), key=lambda number: int(number.split(".")[1])):
        key = bank.exercises(chapter)[number].question().key
        expected += [(number, None), (number, dict.fromkeys(key, "..."))]
    assert expected
    assert calls("chapters", name) == expected
    assert {verdict["status"] for response in responses("chapters", name) for verdict in response["verdicts"]} == {OPEN}
    sources = ["".join(cell["source"]) for cell in cells("chapters", name)]
    assert f'progress("{chapter}")' in sources
    headings = [source for source in sources if source.startswith("## ")]
    assert any(heading.startswith("## Exercises\n") for heading in headings)


@each_notebook
def test_a_solution_solves_each_exercise(name, chapter):
    exercises = {number: bank.exercises(chapter)[number] for number in asked(name)}
    solved = [response["exercise"] for response in responses("solutions", name) if response["right"] is True]
    for one in exercises.values():
        assert one.heading in solved, f"solutions/{name}.ipynb has no right answer to exercise {one.number}"
    assert solved == [one.heading for one in exercises.values()], "the solutions are not in the order of the exercises"
    assert all(response["right"] for response in responses("solutions", name))
    shown = [number for number, answers in calls("solutions", name) if answers is None]
    assert shown == list(exercises)
    headings = re.findall(r"^## (Exercise .*)", "\n".join(map(_text, cells("solutions", name))), re.MULTILINE)
    assert headings == [one.heading for one in exercises.values()]


@each_notebook
def test_a_solution_asks_neither_for_the_key_nor_for_the_ledger(name, chapter):
    code = "\n".join("".join(cell["source"]) for cell in cells("solutions", name) if cell["cell_type"] == "code")
    attributes = {node.attr for node in ast.walk(ast.parse(code)) if isinstance(node, ast.Attribute)}
    assert not attributes & {"key", "mistakes", "criteria"}
    assert not re.search(r"bank|\bledger\b|\bevidence\b", code)


@each_notebook
def test_a_chapter_does_not_need_the_solutions(name, chapter):
    assert "solutions" not in "\n".join(map(_text, cells("chapters", name)))


def _text(cell):
    return "".join(cell["source"])
