"""What several tests of the grader begin with."""

import pytest

import assignments


@pytest.fixture
def tuning():
    """An assignment with all kinds of answers that are judged."""
    return assignments.tuning()
