"""The reader's copy of the notebooks: renewed where she has changed nothing, and never a loss where she has."""

import json

import pytest
from typer.testing import CliRunner

from loopbook import working_copy
from loopbook.__main__ import app
from loopbook.working_copy import brought_up_to_date, fresh

TUNING = "chapters/10_tuning.ipynb"


def store(path, *sources, output="as stored"):
    """Write a notebook whose cells have these sources."""
    cells = [{"cell_type": "code", "source": source, "outputs": [output]} for source in sources]
    path.parent.mkdir(parents=True, exist_ok=True)
    path.write_text(json.dumps({"cells": cells}), encoding="utf-8")


def said(path):
    """The sources in a notebook, and the output of its last cell."""
    cells = json.loads(path.read_text(encoding="utf-8"))["cells"]
    return [cell["source"] for cell in cells], cells[-1]["outputs"][0]


@pytest.fixture
def repository(tmp_path):
    folder = tmp_path / "repository"
    for name in (working_copy.START, TUNING, "solutions/10_tuning.ipynb"):
        store(folder / name, "K = 1")
    return folder


@pytest.fixture
def copy(repository):
    folder = repository / "my-copy"
    assert brought_up_to_date(repository, folder) == []
    return folder


def test_the_copy_has_what_the_repository_has(repository, copy):
    for name in working_copy.originals(repository):
        assert (copy / name).read_bytes() == (repository / name).read_bytes()


def test_to_run_a_notebook_changes_nothing(repository, copy):
    store(copy / TUNING, "K = 1", "", output="as run")  # with the empty cell at the end that running adds
    assert brought_up_to_date(repository, copy) == []
    assert said(copy / TUNING) == (["K = 1", ""], "as run"), "there is nothing newer"
    store(repository / TUNING, "K = 2")
    assert brought_up_to_date(repository, copy) == []
    assert said(copy / TUNING) == (["K = 2"], "as stored")


def test_newer_outputs_come_too(repository, copy):
    store(repository / TUNING, "K = 1", output="a better figure")
    assert brought_up_to_date(repository, copy) == []
    assert said(copy / TUNING) == (["K = 1"], "a better figure")


def test_a_changed_notebook_stays_and_a_newer_one_is_told_of_once(repository, copy):
    store(copy / TUNING, "K = 'mine'")
    assert brought_up_to_date(repository, copy) == [], "there is nothing newer"
    for newer in ("K = 2", "K = 3"):
        store(repository / TUNING, newer)
        assert brought_up_to_date(repository, copy) == [TUNING]
        assert brought_up_to_date(repository, copy) == []
    assert said(copy / TUNING)[0] == ["K = 'mine'"]


def test_what_was_changed_back_is_renewed_again(repository, copy):
    store(copy / TUNING, "K = 'mine'")
    store(repository / TUNING, "K = 2")
    assert brought_up_to_date(repository, copy) == [TUNING]
    store(copy / TUNING, "K = 1")
    assert brought_up_to_date(repository, copy) == []
    assert said(copy / TUNING)[0] == ["K = 2"]


def test_to_say_ones_name_changes_nothing(repository, copy):
    store(repository / working_copy.START, "progress()", "student(...)")
    brought_up_to_date(repository, copy)
    store(copy / working_copy.START, "progress()", 'student("Mira")')
    store(repository / working_copy.START, "progress()  # newer", "student(...)")
    assert brought_up_to_date(repository, copy) == []
    assert said(copy / working_copy.START)[0] == ["progress()  # newer", "student(...)"]


def test_what_was_deleted_is_there_again(repository, copy):
    (copy / TUNING).unlink()
    assert brought_up_to_date(repository, copy) == []
    assert said(copy / TUNING)[0] == ["K = 1"]


@pytest.mark.parametrize(("mine", "stays"), [("K = 1", False), ("K = 'mine'", True)])
def test_a_notebook_whose_original_has_gone_stays_where_it_was_changed(repository, copy, mine, stays):
    store(copy / TUNING, mine)
    (repository / TUNING).unlink()
    assert brought_up_to_date(repository, copy) == []
    assert (copy / TUNING).exists() is stays


@pytest.mark.parametrize("record", ["", "{", "[]", '{"chapters/10_tuning.ipynb": 3}'])
def test_without_a_record_what_differs_is_hers(repository, copy, record):
    store(copy / TUNING, "K = 'mine'")
    (copy / working_copy.RECORD).write_text(record)
    assert brought_up_to_date(repository, copy) == [TUNING]
    assert brought_up_to_date(repository, copy) == []
    assert said(copy / TUNING)[0] == ["K = 'mine'"]


@pytest.mark.parametrize("content", [b"", b"{", b"\xff\xfe", b'{"cells": 3}'])
def test_what_is_no_notebook_is_hers(repository, copy, content):
    (copy / TUNING).write_bytes(content)
    store(repository / TUNING, "K = 2")
    assert brought_up_to_date(repository, copy) == [TUNING]
    assert (copy / TUNING).read_bytes() == content


def test_answers_from_before_there_was_a_copy_go_along_once(repository):
    answers = repository / "chapters" / ".loopbook-progress.json"
    answers.write_text("before")
    copy = repository / "my-copy"
    brought_up_to_date(repository, copy)
    answers.write_text("after")
    brought_up_to_date(repository, copy)
    assert (copy / "chapters" / answers.name).read_text() == "before"


@pytest.mark.parametrize("wanted", ["10", "tuning", "10_tuning", TUNING])
def test_a_fresh_notebook_leaves_the_changed_one_beside_it(repository, copy, wanted):
    for number, kept in enumerate(["10_tuning_mine", "10_tuning_mine_2"]):
        store(copy / TUNING, f"K = 'mine {number}'")
        assert fresh(repository, copy, wanted) == [(TUNING, f"chapters/{kept}.ipynb")]
        assert said(copy / TUNING)[0] == ["K = 1"]
    assert brought_up_to_date(repository, copy) == []
    assert said(copy / "chapters/10_tuning_mine.ipynb")[0] == ["K = 'mine 0'"]
    assert said(copy / "chapters/10_tuning_mine_2.ipynb")[0] == ["K = 'mine 1'"]
    store(repository / TUNING, "K = 2")  # the fresh one is renewed like any other
    assert brought_up_to_date(repository, copy) == []
    assert said(copy / TUNING)[0] == ["K = 2"]


def test_of_what_was_not_changed_nothing_is_kept(repository, copy):
    assert fresh(repository, copy, "solutions/10_tuning.ipynb") == [("solutions/10_tuning.ipynb", None)]
    assert fresh(repository, copy, "0") == [(working_copy.START, None)]
    assert fresh(repository, copy, "99") == []
    assert not list(copy.rglob("*_mine*"))


def test_the_commands_say_what_they_do(repository, copy, monkeypatch):
    monkeypatch.chdir(repository)
    store(copy / TUNING, "K = 'mine'")
    done = CliRunner().invoke(app, ["fresh", "10"])
    assert done.output.splitlines() == [f"my-copy/{TUNING} is fresh; yours is my-copy/chapters/10_tuning_mine.ipynb"]
    wrong = CliRunner().invoke(app, ["fresh", "99"])
    assert wrong.exit_code == 1
    assert wrong.output.startswith("no notebook 99: expected a chapter's number")
    monkeypatch.chdir(copy / "solutions")
    elsewhere = CliRunner().invoke(app, ["lab", "--no-browser"])
    assert elsewhere.exit_code == 1
    assert "run this in the folder that holds chapters" in elsewhere.output
