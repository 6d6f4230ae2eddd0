"""One style of code, in the library, the tests and the notebooks."""

import os
import subprocess
import sys
from pathlib import Path

import pytest

ROOT = Path(__file__).parents[2]

pytestmark = pytest.mark.skipif(os.environ.get("LOOPBOOK_UNPINNED") == "1", reason="a newer ruff may know more rules")


@pytest.mark.parametrize(
    "command",
    [["check", "."], ["format", "--check", "lib", "tests", "docs", "examples", ".colab", "conftest.py"]],
    ids=lambda words: words[0],
)
def test_ruff_has_nothing_to_say(command):
    command = [sys.executable, "-m", "ruff", *command]
    ruff = subprocess.run(command, cwd=ROOT, capture_output=True, encoding="utf-8", check=False)
    assert ruff.returncode == 0, ruff.stdout + ruff.stderr
