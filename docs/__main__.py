"""Makes the site: ``python docs build/book``. Whatever else is said goes to Sphinx.

With ``OFFLINE=1`` in the environment the site holds Python as well, for readers who never have a network: the files of
the folder that ``PARTS`` names, or, without it, fetched ones.
"""

import os
import shutil
import sys
from pathlib import Path

from sphinx.cmd.build import main

from browser import lite, runtime, site

OPTIONS = ("-W", "--keep-going", "-q", "-j", "auto", "-b", "html")


def place(folder: Path) -> None:
    """Put Python's own files into the site before anything else, because they may not be there."""
    names = [*site.of_all(), *lite.PYTHON, *map(runtime.wheel, lite.COMPILED)]
    try:
        site.place(names if os.environ.get("OFFLINE") else [], folder, os.environ.get("PARTS"))
    except runtime.MissingError as problem:
        sys.exit(f"OFFLINE=1: {problem}")


if __name__ == "__main__":
    folder, *more = sys.argv[1:]
    place(Path(folder))
    (Path(folder) / "loopbook.pdf").unlink(missing_ok=True)  # of an earlier state of the book
    shutil.rmtree(Path(folder) / ".doctrees", ignore_errors=True)
    # what Sphinx remembers, with paths of this machine, is no part of the site
    remembered = Path(folder).with_name(f"{Path(folder).name}.doctrees")
    sys.exit(main([*OPTIONS, "-d", str(remembered), *more, str(Path(__file__).parent), folder]))
