"""How JupyterLab starts, for `make lab` and for the tests: it opens the folder of the chapters."""

import os

c = get_config()  # noqa: F821 - Jupyter's, where it reads this

c.LabApp.default_url = "/lab/tree/chapters"
# in a container there is often nobody but root
c.ServerApp.allow_root = hasattr(os, "getuid") and os.getuid() == 0
