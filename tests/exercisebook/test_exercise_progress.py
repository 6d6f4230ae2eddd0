"""What a reader has answered is kept beside the notebook, and a damaged file costs nothing."""

import json
import os
import subprocess
import sys
from pathlib import Path

import pytest

from exercisebook.progress import FILE
from shelf import exercise, progress

#: Where a program of its own finds the shelf.
HERE = os.pathsep.join([str(Path(__file__).parent), str(Path(__file__).parents[1])])


@pytest.fixture
def desk(own_folder):
    """The file of the progress."""
    return own_folder / FILE


def right(question):
    return question.check(**{name: kind.as_given for name, kind in question.key.items()})


def printed(program):
    """What a program of its own prints."""
    environment = os.environ | {"PYTHONPATH": os.pathsep.join([HERE, os.environ.get("PYTHONPATH", "")])}
    command = [sys.executable, "-c", program]
    return subprocess.run(command, capture_output=True, encoding="utf-8", check=True, env=environment).stdout


def test_progress_survives_a_restart(desk):
    assert progress("1").right == 0
    exercise("1.1").check(t=77)
    assert not json.loads(desk.read_text())["answered"]["1.1"]
    assert right(exercise("1.1")).is_right
    assert printed("from shelf import progress; print(progress('1'))").startswith("1 of 2 right")
    exercise("1.1").check(t=77)  # what was right once stays so
    assert progress("1").right == 1
    assert progress("1", student="Ada").right == 0
    assert "✓ Exercise 1.1" in progress("1")._repr_html_()


def test_the_whole_collection_at_a_glance(desk):
    exercise("1.1").check(t=77)
    right(exercise("1.2"))
    everything = progress()
    first, *rows = repr(everything).splitlines()
    assert first == everything.summary == "1 of 3 right"
    assert rows == ["  1 · Motion                   ✗ ✓", "  2 · Heat and how it is lost  ·"]
    page = everything._repr_html_()
    assert '<a href="01_motion.ipynb">1 · Motion</a>' in page
    assert "1 of 2" in page


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
        b'{"answered": {"1.1": "yes"}}',
    ],
)
def test_a_damaged_file_is_ignored_with_a_warning(desk, content):
    desk.write_bytes(content)
    with pytest.warns(UserWarning, match="is damaged and ignored"):
        assert progress("1").right == 0
    with pytest.warns(UserWarning, match="is damaged and ignored"):
        exercise("1.1").check(t=77)
    assert json.loads(desk.read_text()) == {"answered": {"1.1": False}}


def test_a_folder_that_cannot_be_written_is_said(desk):
    desk.mkdir()
    with pytest.warns(UserWarning, match="cannot be stored|damaged"):
        exercise("1.1").check(t=77)
    assert [file.name for file in desk.parent.iterdir()] == [desk.name]


def test_a_link_leads_to_the_file(desk):
    stored = desk.with_name("elsewhere.json")
    stored.write_bytes(b"\xef\xbb\xbf" + b'{"answered": {"1.2": true}}')  # as an editor may save it
    desk.symlink_to(stored)
    exercise("1.1").check(t=77)
    assert desk.is_symlink()
    assert json.loads(stored.read_text()) == {"answered": {"1.1": False, "1.2": True}}


@pytest.mark.skipif(not hasattr(os, "mkfifo"), reason="the system has no pipes")
def test_a_pipe_is_no_file(desk):
    os.mkfifo(desk)
    with pytest.warns(UserWarning, match="is damaged and ignored"):
        assert progress("1").right == 0


def test_what_is_not_answered_leaves_no_trace(desk):
    exercise("1.1").check(t=...)
    assert not desk.exists()
