"""The author's guide, as the tests read it: its tables of calls, and its assignments.

``python tests/books_grading/authors_guide.py`` prints the rows of both tables with the calls as they are now.
"""

import inspect
import re
from pathlib import Path

from loopbook.exercises import authoring
from loopbook.exercises.kinds import MAKERS

PAGE = Path(__file__).parents[2] / "docs" / "authors.md"
TOOLS = (
    "exercise", "between", "choice", "answers", "Late", "criterion", "pi_controller", "stable", "largest_sensitivity",
)  # fmt: skip
#: Where the kinds of the library are; those of a contributor are elsewhere.
OURS = ("exercisebook", "loopbook")
METHODS = ("mistake", "shows", "hints", "solution", "picture", "solution_picture")


def call(name):
    """The call of a function for authors, with what it takes if nothing else is said."""
    function = getattr(authoring, name, None) or getattr(authoring.Exercise, name)
    owner = "" if hasattr(authoring, name) else "."
    parameters = [one for one in inspect.signature(function).parameters.values() if one.name != "self"]
    return f"`{owner}{name}({', '.join(map(_parameter, parameters))})`"


def _parameter(one):
    stars = {one.VAR_POSITIONAL: "*", one.VAR_KEYWORD: "**"}.get(one.kind, "")
    if one.default is one.empty:
        return f"{stars}{one.name}"
    default = "..." if callable(one.default) else repr(one.default).replace("'", '"')
    return f"{one.name}={default}"


def rows():
    """The rows of the tables: {name of the function: (its call, what is said of it)}."""
    text = PAGE.read_text(encoding="utf-8")
    found = re.findall(r"^\| (`\.?(\w+)\([^|]*\)`) \| ([^|]+) \|$", text, re.MULTILINE)
    return {name: (said, words) for said, name, words in found}


def assignments():
    """The assignments of the guide by the headings above them: {kind of answers: text of the module}."""
    text = PAGE.read_text(encoding="utf-8").partition("\n## A whole assignment for each kind\n")[2]
    return dict(re.findall(r"^### (\w+)\n.*?^```python\n(.*?)^```$", text, re.MULTILINE | re.DOTALL))


def kinds():
    """The kinds of answers that authors have, those of the library alone."""
    return [name for name, kind in MAKERS.items() if kind.__module__.startswith(OURS)]


if __name__ == "__main__":
    known = rows()
    for name in (*TOOLS, *METHODS, *sorted(kinds())):
        print(f"| {call(name)} | {known.get(name, ('', 'TODO'))[1]} |")
