"""Which lanes of tests a change needs beyond ``make test``: ``python tests/repository/lanes.py BASE`` prints them.

BASE is the commit before the change; without it the change is that of the last day before the newest commit.
"""

import fnmatch
import subprocess
import sys

#: The paths of each lane, as git names them; a `*` may hold slashes.
LANES = {
    "test-site": [
        "docs/*", "tests/site/*", "chapters/*", "lib/exercisebook/exercisebook/forms/*", "lib/bookledger/*",
        "lib/loopbook/loopbook/diagrams/*", "lib/loopbook/loopbook/figures/*", "lib/loopbook-books/loopbook/ledger/*",
        "lib/loopbook-books/loopbook/*.py", "environment.txt", "jupyter_lab_config.py",
    ],
    "test-grading": [
        "lib/exercisegrader/*", "lib/exercisebook/exercisebook/*.py", "lib/exercisebook/exercisebook/kinds/*",
        "lib/loopbook-books/loopbook/exercises/kinds/*", "lib/loopbook-books/loopbook/grading/*",
        "tests/exercisegrader/*", "tests/books_grading/*", "examples/*", "docs/authors.md", "docs/instructors.md",
        "environment.txt",
    ],
    "test-exercises": [
        "solutions/*", "tests/exercises/*", "lib/exercisebook/*", "lib/loopbook-books/loopbook/exercises/*",
        "environment.txt",
    ],
}  # fmt: skip


def lanes(changed: list[str]) -> list[str]:
    """Return the lanes whose paths have changed.

    >>> lanes(["README.md", "solutions/10_tuning.ipynb"])
    ['test-exercises']
    """
    return [
        lane for lane, paths in LANES.items() if any(fnmatch.fnmatch(file, path) for file in changed for path in paths)
    ]


def git(*words: str) -> str:
    return subprocess.run(["git", *words], check=True, capture_output=True, text=True).stdout.strip()


def day_before() -> str:
    """The newest commit that is a day older than the newest one; the first one where there is none."""
    newest = int(git("log", "-1", "--format=%ct"))
    before = git("rev-list", "-1", f"--before={newest - 24 * 3600}", "HEAD")
    return before or git("rev-list", "--max-parents=0", "HEAD").splitlines()[-1]


if __name__ == "__main__":
    base = sys.argv[1] if len(sys.argv) > 1 else day_before()
    print(*lanes(git("diff", "--name-only", base, "HEAD").splitlines()), sep="\n")
