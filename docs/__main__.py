"""Makes the site: ``python docs build/book``. Whatever else is said goes to Sphinx.

With ``OFFLINE=1`` in the environment the site holds Python as well, for readers who never have a network: the files of
the folder that ``PARTS`` names, or, without it, fetched ones.
"""

import logging
import os
import re
import shutil
import sys
from pathlib import Path

from sphinx.cmd.build import main

from browser import lite, runtime, site

OPTIONS = ("-W", "--keep-going", "-j", "auto", "-b", "html")


class Log:
    """Standard output where it is no terminal: of what Sphinx says at each page and picture, a line for each tenth."""

    def __init__(self, stream):
        self.stream, self.line, self.tenth = stream, "", ""

    def write(self, text: str) -> None:
        *lines, self.line = (self.line + text).split("\n")
        for line in lines:
            tenth = re.match(r"(.*\[ *\d*)\d%\]|", line)[1]
            if not tenth or tenth != self.tenth:
                print(line, file=self.stream, flush=True)
            self.tenth = tenth

    def flush(self) -> None:
        self.stream.flush()


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
    for noisy in ("myst_parser", "myst_nb"):
        logging.getLogger(f"sphinx.{noisy}").setLevel(logging.WARNING)
    if not sys.stdout.isatty():
        sys.stdout = Log(sys.stdout)
    # what Sphinx remembers, with paths of this machine, is no part of the site
    remembered = Path(folder).with_name(f"{Path(folder).name}.doctrees")
    sys.exit(main([*OPTIONS, "-d", str(remembered), *more, str(Path(__file__).parent), folder]))
