"""What all tests share.

Random examples are the same at every run, so that no reader's test fails by luck; each week new ones are tried. Linear
algebra keeps to one thread: the tests themselves run in parallel, and many threads for small matrices only wait.
"""

import os

from hypothesis import settings

os.environ.setdefault("OPENBLAS_NUM_THREADS", "1")
# what a reader has answered so far is no matter here, and stays as it is
os.environ["LOOPBOOK_PROGRESS"] = "off"

settings.register_profile("the same every time", derandomize=True, deadline=None)
settings.register_profile("new ones", deadline=None)
settings.load_profile("new ones" if os.environ.get("LOOPBOOK_UNPINNED") == "1" else "the same every time")
