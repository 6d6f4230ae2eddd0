"""How many random draws a test makes: all of them each week and by ``make test-all``, in an ordinary run a third.

An ordinary run makes the same draws each time, so that no reader's test fails by luck; each week there are new ones.
"""

import math
import os

NEW = os.environ.get("LOOPBOOK_UNPINNED") == "1"
THOROUGH = NEW or os.environ.get("LOOPBOOK_ALL") == "1"


def draws(count: int) -> int:
    """How many of so many draws this run makes."""
    return count if THOROUGH else math.ceil(count / 3)
