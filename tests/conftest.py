"""What all tests share.

Random examples are the same at every run, so that no reader's test fails by luck; each week new ones are tried. Linear
algebra keeps to one thread: the tests themselves run in parallel, and many threads for small matrices only wait.
"""

import os
from pathlib import Path

from hypothesis import settings

ROOT = Path(__file__).parents[1]

os.environ.setdefault("OPENBLAS_NUM_THREADS", "1")
# what a reader has answered so far is no matter here, and stays as it is
os.environ["LOOPBOOK_PROGRESS"] = "off"

settings.register_profile("the same every time", derandomize=True, deadline=None)
settings.register_profile("new ones", deadline=None)
settings.load_profile("new ones" if os.environ.get("LOOPBOOK_UNPINNED") == "1" else "the same every time")


#: What takes long begins first, so that no process works alone at the end; before all, what builds the site for others.
FIRST = ("tests/repository/test_browser_site.py", "chapters/11_", "tests/test_ise.py",
         "tests/test_ledger_in_chapters.py", "tests/test_exercises.py", "chapters/",
         "tests/repository/test_browser.py", "tests/test_solutions.py")  # fmt: skip
#: What needs the site finds it built.
LAST = ("lib/", "README.md", "tests/repository/test_style.py", "tests/repository/test_book.py",
        "tests/repository/test_cheat_sheet.py")  # fmt: skip
for name in (*FIRST, *LAST):
    assert any(ROOT.glob(f"{name}*")), f"the order of the tests names {name}: expected the beginning of a path"


def pytest_collection_modifyitems(items):
    """Sort whole files, as `--no-loadscope-reorder` hands them out."""

    def place(item):
        for number, name in enumerate(FIRST):
            if item.nodeid.startswith(name):
                return number - len(FIRST)
        return 1 + LAST.index(name) if (name := next(filter(item.nodeid.startswith, LAST), None)) else 0

    items.sort(key=place)
