"""What the project says of itself, read from the one place that says it: pyproject.toml, and CITATION.cff for names."""

import re
import tomllib
from pathlib import Path

ROOT = Path(__file__).parents[2]
PROJECT = tomllib.loads((ROOT / "pyproject.toml").read_text(encoding="utf-8"))["project"]
VERSION = PROJECT["version"]
ADDRESS = PROJECT["urls"].get("Repository", "")  # empty until it is known
LICENCES = "Texts, figures and exercises: CC BY 4.0. Code: BSD-3-Clause."
COPYRIGHT = re.search(r"Copyright \(c\) (.*)", (ROOT / "LICENSE").read_text(encoding="utf-8"))[1]
AUTHORS = re.sub(r"^[\d, -]+", "", COPYRIGHT)
