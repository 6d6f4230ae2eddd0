"""What a reader has answered is kept beside the notebook, and a damaged file costs nothing."""

import json
import os
import subprocess
import sys

import pytest

from exercisebook.progress import FILE
from loopbook import exercises


@pytest.fixture
def desk(own_folder):
    """The file of the progress."""
    return own_folder / FILE


def test_progress_survives_a_restart(desk):
    assert exercises.progress("10").right == 0
    question = exercises.exercise("10.1")
    question.check(K=77)
    assert not json.loads(desk.read_text())["answered"]["10.1"]
    assert question.check(**{name: kind.key for name, kind in question.key.items()}).is_right
    program = "from loopbook.exercises import progress; print(progress('10'))"
    result = subprocess.run([sys.executable, "-c", program], capture_output=True, encoding="utf-8", check=True)
    assert result.stdout.startswith("1 of ")
    question.check(K=77)  # what was right once stays so
    assert exercises.progress("10").right == 1
    assert exercises.progress("10", student="Ada").right == 0
    assert "✓ Exercise 10.1" in exercises.progress("10")._repr_html_()


@pytest.mark.parametrize(
    "content",
    [
        b"",
        b"{",
        b"[]",
        b"\xff\xfe",
        b"[" * 100_000,
        b" " * 2_000_000,
        b'{"answered": 3}',
        b'{"answered": {"10.1": "yes"}}',
    ],
)
def test_a_damaged_file_is_ignored_with_a_warning(desk, content):
    desk.write_bytes(content)
    with pytest.warns(UserWarning, match="is damaged and ignored"):
        assert exercises.progress("10").right == 0
    with pytest.warns(UserWarning, match="is damaged and ignored"):
        exercises.exercise("10.1").check(K=77)
    assert json.loads(desk.read_text()) == {"answered": {"10.1": False}}


def test_a_folder_that_cannot_be_written_is_said(desk):
    desk.mkdir()
    with pytest.warns(UserWarning, match="cannot be stored|damaged"):
        exercises.exercise("10.1").check(K=77)
    assert [file.name for file in desk.parent.iterdir()] == [desk.name]


def test_a_link_leads_to_the_file(desk):
    stored = desk.with_name("elsewhere.json")
    stored.write_bytes(b"\xef\xbb\xbf" + b'{"answered": {"10.2": true}}')  # as an editor may save it
    desk.symlink_to(stored)
    exercises.exercise("10.1").check(K=77)
    assert desk.is_symlink()
    assert json.loads(stored.read_text()) == {"answered": {"10.1": False, "10.2": True}}


@pytest.mark.skipif(not hasattr(os, "mkfifo"), reason="the system has no pipes")
def test_a_pipe_is_no_file(desk):
    os.mkfifo(desk)
    with pytest.warns(UserWarning, match="is damaged and ignored"):
        assert exercises.progress("10").right == 0


def test_what_is_not_answered_leaves_no_trace(desk):
    exercises.exercise("10.1").check(K=...)
    assert not desk.exists()
