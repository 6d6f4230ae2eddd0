"""What all tests share.

Linear algebra keeps to one thread: the tests themselves run in parallel, and many threads for small matrices only wait.
"""

import gc
import importlib.util
import os
import shutil
import sys
import tempfile
from pathlib import Path

import pytest
from hypothesis import settings

import forked_kernels
from draws import DAY, NEW, THOROUGH, draws, of_the_day

ROOT = Path(__file__).parents[1]

os.environ.setdefault("OPENBLAS_NUM_THREADS", "1")
# what a reader has answered so far is no matter here, and stays as it is
os.environ["LOOPBOOK_PROGRESS"] = "off"

settings.register_profile("loopbook", derandomize=not NEW, deadline=None, max_examples=draws(100))
settings.load_profile("loopbook")


@pytest.hookimpl(tryfirst=True)
def pytest_configure(config):
    """Let the kernels of a run with several processes begin with the libraries imported, where processes can fork."""
    is_first = not hasattr(config, "workerinput") and config.getoption("numprocesses", None)
    has_books = importlib.util.find_spec("loopbook")  # where a tool alone is tested there are no notebooks
    if is_first and has_books and sys.platform == "linux" and not THOROUGH:
        folder = Path(tempfile.mkdtemp(prefix="loopbook-kernels-"))
        config.pluginmanager.register(Kernels(folder))
        config.add_cleanup(lambda: shutil.rmtree(folder))


class Kernels:
    """The process that forks kernels. Where it has failed the run ends at once, before each notebook says so."""

    def __init__(self, folder):
        self.folder, self.server = folder, forked_kernels.start(folder)

    @pytest.hookimpl(optionalhook=True)
    def pytest_xdist_node_collection_finished(self):
        if why := forked_kernels.failure(self.folder):
            pytest.exit(f"there are no kernels for the notebooks: {why}", returncode=1)

    def pytest_unconfigure(self):
        self.server.stdin.close()
        self.server.wait()


def pytest_report_header():
    return "all variants" if THOROUGH else f"variants of {DAY}; LOOPBOOK_DAY={DAY} draws them again"


def pytest_collection_finish():
    """Leave the tests themselves out of Python's collections of garbage, whose pauses look like a slow answer.

    What SymPy makes by the thousand is rarely garbage in circles: looking for it less often takes 7 % off a run.
    """
    gc.collect()
    gc.freeze()
    gc.set_threshold(50_000)


#: What takes long begins first, so that no process works alone at the end; before all, what builds the site for others.
FIRST = ("tests/site/test_browser_site.py", "tests/exercises/test_exercises.py", "chapters/16_",
         "tests/control_engineering/test_ise.py", "lib/loopbook-books/loopbook/ledger/haugen.toml", "chapters/",
         "tests/site/test_browser.py", "tests/exercises/test_exercise_solutions.py")  # fmt: skip
#: What needs the site finds it built.
LAST = ("lib/", "README.md", "tests/repository/test_style.py", "tests/site/test_book.py",
        "tests/site/test_cheat_sheet.py")  # fmt: skip
for name in (*FIRST, *LAST):
    assert any(ROOT.glob(f"{name}*")), f"the order of the tests names {name}: expected the beginning of a path"


def pytest_collection_modifyitems(config, items):
    """Draw the cases of the day, and sort whole files, as `--no-loadscope-reorder` hands them out."""
    cases = {}
    for item in items:
        if marker := item.get_closest_marker("daily"):
            cases.setdefault((item.nodeid.partition("[")[0], *marker.args), []).append(item)
    drawn = {id(item) for (test, count), of_test in cases.items() for item in of_the_day(of_test, count, test)}
    left_out = {id(item): item for of_test in cases.values() for item in of_test if id(item) not in drawn}
    config.hook.pytest_deselected(items=[*left_out.values()])
    items[:] = [item for item in items if id(item) not in left_out]

    def place(item):
        for number, name in enumerate(FIRST):
            if item.nodeid.startswith(name):
                return number - len(FIRST)
        return 1 + LAST.index(name) if (name := next(filter(item.nodeid.startswith, LAST), None)) else 0

    items.sort(key=place)


@pytest.fixture
def own_folder(tmp_path, monkeypatch):
    """A reader's folder, in which exercises remember what she answered."""
    monkeypatch.chdir(tmp_path)
    monkeypatch.delenv("LOOPBOOK_PROGRESS", raising=False)
    return tmp_path
