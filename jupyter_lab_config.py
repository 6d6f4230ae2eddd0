"""How JupyterLab starts, for `make lab` and `make edit`, and for the tests. Nothing of the user's own is changed."""

import os
from pathlib import Path

c = get_config()  # noqa: F821 - Jupyter's, where it reads this
ANNOUNCEMENTS = "@jupyterlab/apputils-extension:announcements"


def calm(handler, page_config):
    """Take away the question whether to be told news of Jupyter, and what is JupyterLite's, which fails here."""
    page_config["disabledExtensions"] = [*page_config["disabledExtensions"], ANNOUNCEMENTS]
    extensions = page_config["federated_extensions"]
    page_config["federated_extensions"] = [one for one in extensions if not one["name"].startswith("@jupyterlite/")]
    return page_config


c.LabApp.default_url = "/lab/tree/chapters"
# in a container there is often nobody but root
c.ServerApp.allow_root = hasattr(os, "getuid") and os.getuid() == 0
# figures that suit the dark theme, for this JupyterLab only: whoever has a custom.css of their own keeps it elsewhere
c.LabApp.custom_css = True
c.ServerApp.tornado_settings = {
    "page_config_hook": calm,
    "static_custom_path": [str(Path(__file__).parent / "docs" / "jupyterlab")],
}
