"""What pytest is told of notebooks and of examples in texts, wherever in the repository they lie."""

import sys

import pytest
from nbval.plugin import IPyNbCell


def pytest_itemcollected(item):
    """Number the cells of a notebook, whose stored form has no execution counts.

    nbval takes a cell without a count for one that was never run, and would compare nothing.
    """
    if isinstance(item, IPyNbCell):
        item.cell.execution_count = item.cell_num + 1


def pytest_runtest_setup(item):
    """An example in a text begins without the attempts at its exercise that other tests have made."""
    authoring = sys.modules.get("exercisebook.authoring")
    if authoring and isinstance(item, pytest.DoctestItem):
        authoring.Exercise.question.cache_clear()
