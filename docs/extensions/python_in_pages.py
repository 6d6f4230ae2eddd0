"""The site holds what its pages need to run Python in the reader's browser, and works without a network once visited.

With ``OFFLINE=1`` in the environment its pages take Python from the site itself, where ``docs/__main__.py`` has put it.
"""

import os
from pathlib import Path

from browser import site


def write(app, exception):
    """Write it when all pages are there, because the service worker knows the site by its content."""
    if app.builder.name == "html" and not exception:
        site.write(Path(app.outdir), bool(os.environ.get("OFFLINE")))


def setup(app):
    app.add_js_file("offline.js", loading_method="defer")
    app.connect("build-finished", write, priority=900)
    return {"parallel_read_safe": True, "parallel_write_safe": True}
