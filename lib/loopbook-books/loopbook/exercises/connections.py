"""Connections of a P&I diagram: between instruments, and between an instrument and a place of the process."""

from __future__ import annotations

import re
from dataclasses import dataclass

ELECTRICAL, PNEUMATIC = "electrical", "pneumatic"
TAG = re.compile(r"([A-Za-z]{2,5})[\s_-]?(\d+)[\s_-]?([A-Ja-j]?)")


@dataclass(frozen=True, order=True)
class Connection:
    """A connection: from one tag or place to another, and by what kind of signal; none at a place of the process."""

    start: str
    end: str
    kind: str = ""

    def __str__(self) -> str:
        return f"{self.start} {'-//->' if self.kind == PNEUMATIC else '->'} {self.end}"


def connections(text: str) -> list[Connection]:
    """The connections of a diagram as it was read."""
    found = []
    for part in text.split("; "):
        start, arrow, end = re.fullmatch(r"(.+?) (-//->|->) (.+)", part).groups()
        found.append(Connection(start, end, PNEUMATIC if arrow == "-//->" else ELECTRICAL))
    return [Connection(x.start, x.end) if " " in x.start + x.end or not (is_tag(x.start) and is_tag(x.end)) else x
            for x in found]  # fmt: skip


def is_tag(name: str) -> bool:
    """Return whether a name is the tag of an instrument."""
    return bool(TAG.fullmatch(name)) and any(sign.isdigit() for sign in name)
