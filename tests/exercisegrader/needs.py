"""What some tests need of the machine."""

import os
import shutil
import sys

import pytest

#: On Linux, continuous integration has a jail: a test that is skipped there proves nothing.
needs_jail = pytest.mark.skipif(
    sys.platform != "linux" or (shutil.which("bwrap") is None and not os.environ.get("CI")),
    reason="a jail needs Linux and bubblewrap",
)
