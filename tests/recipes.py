"""What the Makefile's targets run, so that the tests run the same."""

import os
import re
import shlex
import sys
from pathlib import Path

MAKEFILE = Path(__file__).parents[1] / "Makefile"


def recipe(target: str) -> list[str]:
    """The words of a target's one command, with the Python that runs the tests.

    >>> recipe("pictures")[1:]
    ['docs/pictures.py']
    """
    command = re.search(rf"^{target}:.*\n\t(.+)$", MAKEFILE.read_text(encoding="utf-8"), re.MULTILINE)[1]
    root = "--allow-root" if hasattr(os, "getuid") and os.getuid() == 0 else ""
    return [sys.executable, *shlex.split(command.replace("$(root)", root))[1:]]
