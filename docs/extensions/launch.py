"""Where a notebook can be opened and run without an installation: in the page, on Binder, Colab and Codespaces.

The repository's address is that of pyproject.toml, where `make address` writes it; until it is known nothing but the
page is offered. A branch other than main follows it, as in https://github.com/OWNER/NAME/tree/next.
"""

import re
from pathlib import Path
from urllib.parse import quote

import repository

ROOT = Path(__file__).resolve().parents[2]
ADDRESS = re.compile(r"https://github\.com/(?P<name>[\w.-]+/[\w.-]+?)(?:\.git)?(?:/tree/(?P<branch>[\w./-]+))?/?")
COPIES = "colab"  # the branch where the workflow colab.yml puts the notebooks with a cell that installs loopbook
FIRST = "chapters/00_start.ipynb"  # what is opened of the whole collection
IN_PAGE = "lite/notebooks/index.html?path="  # JupyterLite's place on the site, which browser/lite.py makes


def of_repository(address):
    """Return owner and name of a repository, as "OWNER/NAME", and its branch.

    Raises ValueError for an address that is not on GitHub.

    >>> of_repository("https://github.com/OWNER/NAME/tree/next")
    ('OWNER/NAME', 'next')
    """
    if not (found := ADDRESS.fullmatch(address)):
        raise ValueError(f"the repository is {address}: expected one on github.com")
    return found["name"], found["branch"] or "main"


def in_page(path="", root=""):
    """Return the address on the site at which a notebook, or without one the collection, runs in the reader's browser.

    Arguments:
        path: of a notebook from the root of the repository.
        root: how the site's root is seen from the page with the link, as "../".
    Raises:
        ValueError: for a path at which there is nothing.

    >>> in_page("chapters/01_introduction.ipynb", "../")
    '../lite/notebooks/index.html?path=chapters/01_introduction.ipynb'
    """
    return f"{root}{IN_PAGE}{quote(_existing(path) or FIRST)}"


def links(path="", address=repository.ADDRESS):
    """Return name and address of each place that opens a notebook, or without one the collection; none without address.

    A codespace is the whole repository: no address opens one notebook in it.

    Arguments:
        path: of a notebook from the root of the repository, as "chapters/01_introduction.ipynb".
        address: of the repository, empty where it is not known.
    Raises:
        ValueError: for a path at which there is nothing, or an address that is not on GitHub.

    >>> [name for name, _ in links("chapters/01_introduction.ipynb", "https://github.com/OWNER/NAME")]
    ['Binder', 'Colab', 'Codespaces']
    """
    _existing(path)
    if not address:
        return ()
    name, branch = of_repository(address)
    on_binder = quote(f"lab/tree/{path or FIRST}", safe="")
    return (
        ("Binder", f"https://mybinder.org/v2/gh/{name}/{quote(branch, safe='')}?urlpath={on_binder}"),
        ("Colab", f"https://colab.research.google.com/github/{name}/blob/{COPIES}/{quote(path or FIRST)}"),
        ("Codespaces", f"https://codespaces.new/{name}/tree/{quote(branch)}?quickstart=1"),
    )


def _existing(path):
    if not (ROOT / path).exists():
        raise ValueError(f"there is no {path}: expected the path of a notebook from the root of the repository")
    return path
