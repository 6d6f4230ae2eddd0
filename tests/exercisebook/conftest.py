"""What the tests of the tool share."""

import pytest

from exercisebook.asked_names import SYNONYMS, also_called
from exercisebook.wholes import WHOLES
from springs import SPRINGS


@pytest.fixture
def mechanics():
    """A subject that has springs and names of its own, and has gone again after the test."""
    before = [*SYNONYMS]
    also_called("k kappa stiffness", "l length", "spring coil", "m mass", "w omega speed", "w width")
    WHOLES.append(SPRINGS)
    yield
    WHOLES.remove(SPRINGS)
    SYNONYMS[:] = before
