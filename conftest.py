"""What pytest is told of notebooks, wherever in the repository they lie."""

from nbval.plugin import IPyNbCell


def pytest_itemcollected(item):
    """Number the cells of a notebook, whose stored form has no execution counts.

    nbval takes a cell without a count for one that was never run, and would compare nothing.
    """
    if isinstance(item, IPyNbCell):
        item.cell.execution_count = item.cell_num + 1
