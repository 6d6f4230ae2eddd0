"""Random examples are the same at every run, so that no reader's test fails by luck; each week new ones are tried."""

import os

from hypothesis import settings

settings.register_profile("the same every time", derandomize=True)
if os.environ.get("LOOPBOOK_UNPINNED") != "1":
    settings.load_profile("the same every time")
