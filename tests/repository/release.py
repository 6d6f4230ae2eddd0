"""What a release says of itself, written everywhere from one place, pyproject.toml.

python tests/repository/release.py version 0.2.0    # and today as its day
python tests/repository/release.py address https://github.com/OWNER/NAME    # without an address: none is known
python tests/repository/release.py check v0.2.0     # whether a tag is the version that stands everywhere
python tests/repository/release.py notes            # what CHANGELOG.md says of the version
"""

import datetime
import re
import sys
import tomllib
from pathlib import Path

ROOT = Path(__file__).parents[2]
sys.path.insert(0, str(ROOT / "docs" / "extensions"))

import launch  # noqa: E402 - of docs/extensions/, which has just become a place to import from

UNKNOWN = "set by make address"  # what stands in a line for an address that is not known
#: The lines that hold the address, by what they begin with.
LINES = {
    "pyproject.toml": "Repository = ",
    **{f"lib/{path.name}/pyproject.toml": "Repository = " for path in sorted((ROOT / "lib").iterdir())},
    "CITATION.cff": "repository-code: ",
}
ELSEWHERE = re.compile(r"(?<=<!-- elsewhere -->\n).*?(?=<!-- that is all -->)", re.DOTALL)


def version(root: Path = ROOT) -> str:
    return tomllib.loads((root / "pyproject.toml").read_text(encoding="utf-8"))["project"]["version"]


def set_version(new: str, day: str, root: Path = ROOT) -> None:
    """Write a version, and the day of its release, wherever they stand."""
    if not re.fullmatch(r"\d+\.\d+\.\d+((a|b|rc)\d+)?", new):
        raise ValueError(f"the version is {new}: expected one as 0.2.0 or 0.2.0rc1")
    for name in LINES:
        text = read(root / name)
        text = re.sub(r'(?m)^version(: | = )"?[\d.abrc]+"?$', lambda old: f'version{old[1]}"{new}"', text)
        if name.startswith("lib/"):
            ours = "|".join(path.name for path in (root / "lib").iterdir())
            text = re.sub(rf'"((?:{ours})(?:\[[\w,]+\])?)==[^"]+"', rf'"\1=={new}"', text)
        (root / name).write_text(re.sub(r"(?m)^date-released: .*$", f"date-released: {day}", text), encoding="utf-8")
    text = read(root / "CHANGELOG.md")
    heading = f"## {new} ({day})"
    if not re.search(rf"(?m)^## {re.escape(new)} ", text):
        text = text.replace("## Not yet released", heading, 1)
    (root / "CHANGELOG.md").write_text(re.sub(rf"(?m)^## {re.escape(new)} .*$", heading, text), encoding="utf-8")


def set_address(address: str, root: Path = ROOT) -> None:
    """Write the address of the repository, or that it is not known, wherever it stands.

    Raises:
        ValueError: it is not on GitHub, whose links Binder, Colab and Codespaces take.
    """
    elsewhere = says_elsewhere(address)
    for name, begins in LINES.items():
        line = f'{begins}"{address}"' if address else f'# {begins}"{UNKNOWN}"'
        (root / name).write_text(re.sub(rf"(?m)^(# )?{begins}.*$", line, read(root / name)), encoding="utf-8")
    (root / "README.md").write_text(ELSEWHERE.sub(elsewhere, read(root / "README.md")), encoding="utf-8")


def says_elsewhere(address: str) -> str:
    """Return what the README says of the places that run the notebooks."""
    if not address:
        return "Binder, Colab and Codespaces run a repository by its address, which this one does not have yet.\n"
    binder, colab, codespaces = (link for _, link in launch.links(address=address))
    return (
        f"Elsewhere [Binder]({binder}) runs all of it in JupyterLab,\n[Colab]({colab}) opens one notebook at a time "
        "(its first cell\ninstalls the library and may restart the session; if so, run the cells again), and a\n"
        f"[codespace]({codespaces}) is the repository in an editor.\n"
    )


def notes(root: Path = ROOT) -> str:
    """Return what CHANGELOG.md says of the version."""
    part = re.search(rf"(?ms)^## {re.escape(version(root))} .*?\n(.*?)(?=^## |\Z)", read(root / "CHANGELOG.md"))
    if not part:
        raise ValueError(f"CHANGELOG.md has no heading of version {version(root)}")
    return part[1].strip()


def wrong(tag: str, root: Path = ROOT) -> list[str]:
    """Return what keeps a tag from being released."""
    now, found = version(root), []
    if tag != f"v{now}":
        found.append(f"the tag is {tag}: expected v{now}, the version in pyproject.toml")
    for name in LINES:
        said = re.findall(r'(?m)^version(?:: | = )"?([\d.abrc]+)"?$', read(root / name))
        ours = "|".join(path.name for path in (root / "lib").iterdir())
        said += re.findall(rf'"(?:{ours})(?:\[[\w,]+\])?==([^"]+)"', read(root / name))
        if {*said} != {now}:
            found.append(f"{name} says version {', '.join(sorted({*said}))}: expected {now}")
    days = [re.search(pattern, read(root / name)) for name, pattern in (
        ("CHANGELOG.md", rf"(?m)^## {re.escape(now)} \((.*)\)$"), ("CITATION.cff", r"(?m)^date-released: (.*)$"),
    )]  # fmt: skip
    if not all(days) or days[0][1] != days[1][1]:
        found.append("CHANGELOG.md and CITATION.cff say no day of the release, or not the same")
    return found


def read(path: Path) -> str:
    return path.read_text(encoding="utf-8")


def main(command: str = "", word: str = "") -> None:
    if command == "version":
        set_version(word, datetime.date.today().isoformat())
    elif command == "address":
        set_address(word.rstrip("/"))
    elif command == "check":
        sys.exit("\n".join(wrong(word)))
    elif command == "notes":
        print(notes())
    else:
        sys.exit(__doc__)


if __name__ == "__main__":
    try:
        main(*sys.argv[1:])
    except ValueError as problem:
        sys.exit(str(problem))
