"""How many random draws a test makes, and which.

Each week, and by ``make test-all``, all of them are made; each week there are new ones. In an ordinary run the examples
of hypothesis are a tenth and the same each time; of the variants of exercises, all of which are proved each week, the
day draws a few, so that no reader's test fails by luck and a fault that one variant in ten shows is found within days.
"""

import datetime
import math
import os
import random

NEW = os.environ.get("LOOPBOOK_UNPINNED") == "1"
THOROUGH = NEW or os.environ.get("LOOPBOOK_ALL") == "1"
#: A run begins before midnight and ends after it; its processes draw what the first one does.
DAY = os.environ.setdefault("LOOPBOOK_DAY", datetime.datetime.now(datetime.UTC).date().isoformat())
STUDENTS = [f"student {k}" for k in range(200)]


def draws(count: int) -> int:
    """How many of so many draws this run makes."""
    return count if THOROUGH else math.ceil(count / 10)


def of_the_day(many: list, count: int, what: object = "") -> list:
    """So many of a list, others each day and for each purpose; all of them in a thorough run."""
    return many if THOROUGH else random.Random(f"{DAY} {what}").sample(many, min(count, len(many)))
