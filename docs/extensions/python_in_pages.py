"""The site holds what its pages need to run Python in the reader's browser, and works without a network once visited.

With ``OFFLINE=1`` in the environment the site holds Python itself as well, for readers who never have a network; the
files are those of the folder that ``PARTS`` names, or are fetched.
"""

import os
from pathlib import Path

from sphinx.errors import SphinxError

from browser import runtime, site


class NoRuntimeError(SphinxError):
    category = "OFFLINE=1 needs the parts of Pyodide, and one is missing"


def place(app):
    """Put Python's own files into the site before anything else, because they may not be there."""
    if app.builder.name == "html":
        try:
            site.place(Path(app.outdir), bool(os.environ.get("OFFLINE")), os.environ.get("PARTS"))
        except runtime.MissingError as problem:
            raise NoRuntimeError(str(problem)) from None


def write(app, exception):
    """Write the rest when all pages are there."""
    if app.builder.name == "html" and not exception:
        site.write(Path(app.outdir), bool(os.environ.get("OFFLINE")))


def setup(app):
    app.add_js_file("offline.js", loading_method="defer")
    app.connect("builder-inited", place)
    app.connect("build-finished", write, priority=900)
    return {"parallel_read_safe": True, "parallel_write_safe": True}
