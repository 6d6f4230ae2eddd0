"""Makes the site: ``python docs build/book``. Whatever else is said goes to Sphinx."""

import sys
from pathlib import Path

from sphinx.cmd.build import main

OPTIONS = ("-W", "--keep-going", "-q", "-j", "auto", "-b", "html")

if __name__ == "__main__":
    folder, *more = sys.argv[1:]
    sys.exit(main([*OPTIONS, *more, str(Path(__file__).parent), folder]))
