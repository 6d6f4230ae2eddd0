"""The example of a ledger is proved by the plug-in alone, and `python -m bookledger` writes its pages."""

import shutil
import subprocess
import sys
from pathlib import Path

ROOT = Path(__file__).parents[2]


def run(folder, *command):
    """Run a module of Python in a folder and return what it printed."""
    ended = subprocess.run([sys.executable, "-m", *command], cwd=folder, capture_output=True, encoding="utf-8")
    assert ended.returncode == 0, ended.stdout + ended.stderr
    return ended.stdout


def test_the_example_is_proved_and_has_its_pages(tmp_path):
    example = shutil.copytree(ROOT / "examples" / "ledger", tmp_path / "ledger")
    assert "9 passed" in run(example, "pytest", "-q", "-p", "no:cacheprovider")
    run(example, "bookledger", "ledger/swings.toml", "--notebooks", "chapters")
    assert "<td>✓ computed</td><td>3.3</td><td>its frequency</td>" in (example / "ledger.html").read_text("utf-8")
    assert "prints `6.28`, correct is `4.44`" in (example / "ERRATA.md").read_text("utf-8")
