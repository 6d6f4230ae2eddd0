"""The lanes of the tests: what `make test` leaves out is a lane, and a lane is run where its paths change."""

import re
import subprocess
import tomllib
from pathlib import Path

import lanes

ROOT = Path(__file__).parents[2]
MAKEFILE = (ROOT / "Makefile").read_text(encoding="utf-8")


def recipe(target):
    return re.search(rf"^{target}:.*\n((?:\t.*\n)+)", MAKEFILE, re.MULTILINE)[1].split()


def test_every_lane_is_a_target_and_each_of_its_paths_is_one_of_a_file():
    tracked = subprocess.run(["git", "ls-files"], cwd=ROOT, capture_output=True, text=True, check=True).stdout.split(
        "\n"
    )
    for lane, paths in lanes.LANES.items():
        assert recipe(lane)
        assert [path for path in paths if not lanes.fnmatch.filter(tracked, path)] == []


def test_every_folder_of_tests_is_in_a_lane_or_in_every_run():
    project = tomllib.loads((ROOT / "pyproject.toml").read_text(encoding="utf-8"))
    always = project["tool"]["pytest"]["ini_options"]["testpaths"]
    listed = {*always, *(word for lane in lanes.LANES for word in recipe(lane))}
    folders = {path.parent.relative_to(ROOT) for path in (ROOT / "tests").rglob("test_*.py")}
    folders |= {Path(name) for name in ("lib", "chapters", "solutions", "README.md")}
    assert [folder for folder in folders if not {folder.as_posix(), folder.parent.as_posix()} & listed] == []
    assert {"tests", "lib", "chapters", "solutions", "README.md"} <= {*recipe("test-all")}
