"""Live through the term: run the commands of README.md, in their order.

    python examples/course/term.py [FOLDER]

FOLDER is `build` beside this file if not given; what an earlier run has left there is replaced.
"""

import os
import re
import shutil
import subprocess
import sys
from pathlib import Path

HERE = Path(__file__).parent
COMMAND = re.compile(r"^    (\S.*)$", re.MULTILINE)


def main(folder):
    """Copy the course to a folder, and run the commands there."""
    shutil.rmtree(folder, ignore_errors=True)
    shutil.copytree(HERE, folder, ignore=shutil.ignore_patterns("build", "README.md", "__pycache__"))
    for module in folder.glob("*.py"):  # a secret that stands in an example is refused
        text = module.read_text(encoding="utf-8")
        module.write_text(text.replace("that-everybody-may-read", "of-this-run-alone"), encoding="utf-8")
    tools = f"{Path(sys.executable).parent}{os.pathsep}{os.environ['PATH']}"
    for command in COMMAND.findall((HERE / "README.md").read_text(encoding="utf-8")):
        print(f"$ {command}", flush=True)
        subprocess.run(["bash", "-c", command], cwd=folder, env=os.environ | {"PATH": tools}, check=True)


if __name__ == "__main__":
    main(Path(sys.argv[1]) if sys.argv[1:] else HERE / "build")
