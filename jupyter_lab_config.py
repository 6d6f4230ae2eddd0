"""How JupyterLab starts, for `make lab` and for the tests: it opens the folder of the chapters."""

import os
from pathlib import Path

c = get_config()  # noqa: F821 - Jupyter's, where it reads this

c.LabApp.default_url = "/lab/tree/chapters"
# in a container there is often nobody but root
c.ServerApp.allow_root = hasattr(os, "getuid") and os.getuid() == 0
# figures that suit the dark theme, for this JupyterLab only: whoever has a custom.css of their own keeps it elsewhere
c.LabApp.custom_css = True
c.ServerApp.tornado_settings = {"static_custom_path": [str(Path(__file__).parent / "docs" / "jupyterlab")]}
