"""The site holds what its pages need to run Python in the reader's browser, and works without a network once visited.

Beside it is JupyterLite, in which every chapter and its solutions run as notebooks. With ``OFFLINE=1`` in the
environment both take Python from the site itself, where ``docs/__main__.py`` has put it.
"""

import os
import subprocess
from pathlib import Path

from sphinx.errors import SphinxError
from sphinx.util.display import progress_message

from browser import lite, runtime, site


class NoNotebooksError(SphinxError):
    category = "JupyterLite cannot be made"


def write(app, exception):
    """Write it when all pages are there, because the service worker knows the site by its content."""
    if app.builder.name != "html" or exception:
        return
    folder, offline = Path(app.outdir), bool(os.environ.get("OFFLINE"))
    try:
        with progress_message("packing Python for the pages, and the notebooks that run in them"):
            site.write(folder, offline)
            lite.write(folder, offline, os.environ.get("PARTS"))  # of the wheels, which are there now, it takes most
    except runtime.MissingError as problem:
        raise NoNotebooksError(str(problem)) from None
    except subprocess.CalledProcessError as problem:
        raise NoNotebooksError(f"{problem.stdout[-2000:]}{problem.stderr[-2000:]}") from None


def setup(app):
    app.add_js_file("offline.js", loading_method="defer")
    app.connect("build-finished", write, priority=900)
    return {"parallel_read_safe": True, "parallel_write_safe": True}
