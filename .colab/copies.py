"""Write the copies of the notebooks that Colab opens: chapters and solutions behind a cell that installs loopbook.

Colab gives each notebook a machine of its own, on which loopbook is not installed, and the chapters themselves hold no
set-up code. The workflow colab.yml puts the copies on the branch `colab`, where the buttons of the book lead.

    python .colab/copies.py build/colab https://github.com/OWNER/NAME
"""

import json
import sys
from pathlib import Path

ROOT = Path(__file__).resolve().parents[1]
FOLDERS = ("chapters", "solutions")


def installing(address):
    """The first cell of a copy, which takes loopbook from the repository with that address."""
    lines = [
        "# Colab has no loopbook yet: this installs it, in a minute, and may restart the session. Then go on below.\n",
        f"![ -d loopbook ] || git clone --quiet --depth 1 {address}.git loopbook\n",
        "%run loopbook/.colab/prepare.py",
    ]
    return {
        "cell_type": "code",
        "execution_count": None,
        "id": "on-colab",
        "metadata": {},
        "outputs": [],
        "source": lines,
    }


def copy(text, address):
    """Return the text of a notebook with the installing cell first, and all else as it was."""
    notebook = json.loads(text)
    notebook["cells"].insert(0, installing(address))
    return json.dumps(notebook, ensure_ascii=False, indent=1) + "\n"


def main(target, address):
    """Write all copies into a folder, each at the path of its original."""
    for folder in FOLDERS:
        (Path(target) / folder).mkdir(parents=True, exist_ok=True)
        for original in sorted((ROOT / folder).glob("*.ipynb")):
            text = copy(original.read_text(encoding="utf-8"), address)
            (Path(target) / folder / original.name).write_text(text, encoding="utf-8")


if __name__ == "__main__":
    main(*sys.argv[1:])
