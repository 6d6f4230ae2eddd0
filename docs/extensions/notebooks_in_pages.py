"""The site holds JupyterLite, in which every chapter and its solutions run in the reader's browser."""

import os
import subprocess
from pathlib import Path

from sphinx.errors import SphinxError

from browser import lite, runtime


class NoNotebooksError(SphinxError):
    category = "JupyterLite cannot be made"


def write(app, exception):
    """Write it after the wheels (python_in_pages.py), of which it takes most."""
    if app.builder.name != "html" or exception:
        return
    try:
        lite.write(Path(app.outdir), bool(os.environ.get("OFFLINE")), os.environ.get("PARTS"))
    except runtime.MissingError as problem:
        raise NoNotebooksError(str(problem)) from None
    except subprocess.CalledProcessError as problem:
        raise NoNotebooksError(f"{problem.stdout[-2000:]}{problem.stderr[-2000:]}") from None


def setup(app):
    app.connect("build-finished", write, priority=950)
    return {"parallel_read_safe": True, "parallel_write_safe": True}
