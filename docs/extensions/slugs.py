"""The names of places in the book's pages, which several extensions must write alike."""

import re
import unicodedata


def slug(text):
    """Return a text as a part of an address: small letters, digits, and hyphens for all else.

    >>> slug("Equations (7.89) to (7.91)")
    'equations-7-89-to-7-91'
    """
    plain = unicodedata.normalize("NFKD", text).encode("ascii", "ignore").decode().lower()
    return re.sub(r"[^a-z0-9]+", "-", plain).strip("-")


def check_anchor(source, entry):
    """Return the place, in its chapter's page, of the cell that checks an entry of the ledger.

    >>> check_anchor("haugen", "Example 6.2")
    'check-haugen-example-6-2'
    """
    return f"check-{slug(source)}-{slug(entry)}"


def ledger_anchor(source, entry, result=""):
    """Return the place of an entry, or of one of its results, in the page of the ledger.

    >>> ledger_anchor("haugen", "Example 6.2")
    'ledger-haugen-example-6-2'
    >>> ledger_anchor("haugen", "Example 6.2", "T_p")
    'ledger-haugen-example-6-2.T_p'
    """
    place = f"ledger-{slug(source)}-{slug(entry)}"
    return f"{place}.{result}" if result else place  # as it is: an entry may have both a k and a K
