"""The examples that contributors are shown, as the tests run them."""

import re
import textwrap
from pathlib import Path
from unittest import mock

GUIDE = Path(__file__).parents[1] / "docs" / "contributors.md"


def example(heading, language="python"):
    """The first block of code under a heading of the contributor's guide."""
    text = re.sub(r"^````.*?^````$", "", GUIDE.read_text(encoding="utf-8"), flags=re.DOTALL | re.MULTILINE)
    section = text.partition(f"\n## {heading}\n")[2].partition("\n## ")[0]
    return textwrap.dedent(re.search(rf"```{language}\n(.*?)```", section, re.DOTALL)[1])


def ledger():
    """The source that contributors are shown, as TOML: how a book begins, and an entry."""
    return example("Add a book", "toml") + example("Add an example", "toml")


def run(heading, known=()):
    """The names that the example under a heading makes."""
    names = dict(known)
    exec(compile(example(heading), heading, "exec"), names)
    return names


def exercise():
    """The exercise that contributors are shown: its page, and the Python beside it."""
    from exercisebook.pages import page

    text = re.search(r"^````markdown\n(.*?)^````$", GUIDE.read_text(encoding="utf-8"), re.DOTALL | re.MULTILINE)[1]
    return page.of(text, "contributors.md", run("Add an exercise"))[1]["10.11"]


def kind():
    """The kind of answers that contributors are shown, of which the registry keeps nothing: one may be there by now."""
    from exercisebook.kinds import MAKERS  # which a test of the control library does without

    with mock.patch.dict(MAKERS):
        MAKERS.pop("span", None)
        return run("Add a kind of answers")["Span"]
