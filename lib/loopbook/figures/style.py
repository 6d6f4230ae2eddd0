"""One look for all figures: typeface, colours, kinds of lines, sizes.

A signal has the same colour and the same kind of line in every figure. The colours are those of Okabe and Ito, which
stay apart without colour vision; the dashes stay apart on a grey printout.
"""

from __future__ import annotations

from contextlib import AbstractContextManager
from typing import Any

from loopbook.validation import did_you_mean

GREY = "#555555"

STYLE: dict[str, Any] = {
    # One typeface for words and mathematics; it comes with matplotlib, so that every machine draws the same picture.
    "font.family": "STIXGeneral",
    "mathtext.fontset": "stix",
    "font.size": 11,
    "axes.titlesize": 11.5,
    "axes.titlelocation": "left",
    "axes.titlepad": 8,
    "axes.labelsize": 11,
    "axes.linewidth": 0.8,
    "axes.spines.top": False,
    "axes.spines.right": False,
    "axes.grid": True,
    "axes.axisbelow": True,
    "axes.ymargin": 0.1,
    "grid.color": "#dddddd",
    "grid.linewidth": 0.6,
    "xtick.direction": "out",
    "ytick.direction": "out",
    "legend.frameon": True,
    "legend.framealpha": 0.9,
    "legend.edgecolor": "none",
    "legend.handlelength": 3.2,  # long enough to show the dashes
    "lines.dash_capstyle": "butt",
    "lines.scale_dashes": False,
    "figure.facecolor": "white",
    "savefig.facecolor": "white",
}

ROLES: dict[str, dict[str, Any]] = {
    "setpoint": {"color": "#000000", "linestyle": (0, (4, 3)), "linewidth": 1.2, "zorder": 3},
    "measurement": {"color": "#0072B2", "linestyle": "-", "linewidth": 2.0},
    "control signal": {"color": "#D55E00", "linestyle": (0, (16, 2)), "linewidth": 1.6},
    "disturbance": {"color": "#CC79A7", "linestyle": (0, (8, 2, 2, 2)), "linewidth": 1.6},
}
INPUTS = ("control signal", "disturbance")

# What has no role takes the next of these; four colours and five kinds of line make twenty that differ in both.
RESPONSE_COLOURS = ["#009E73", "#E69F00", "#56B4E9", GREY]
RESPONSE_LINES = ["-", (0, (7, 2)), (0, (8, 2, 2, 2)), (0, (2, 1.5)), (0, (12, 2, 2, 2, 2, 2))]

# What is no signal: the axes of a plane, a level such as a steady state, the way from a point to an axis, words.
ZERO: dict[str, Any] = {"color": GREY, "linewidth": 0.8, "zorder": 1}
LEVEL: dict[str, Any] = {"color": GREY, "linestyle": (0, (6, 3)), "linewidth": 1, "zorder": 1.5}
GUIDE: dict[str, Any] = {
    "color": GREY, "linestyle": (0, (2, 2)), "linewidth": 1, "zorder": 1.6, "scalex": False, "scaley": False
}  # fmt: skip
ON_WHITE: dict[str, Any] = {"facecolor": "white", "edgecolor": "none", "alpha": 0.85, "pad": 1}

WIDTH = 6.4  # inches: a notebook column, and the text width of a printed page
DOTS_PER_INCH = 144  # half as many again as a browser calls an inch: sharp in print, and light in a notebook


def styled() -> AbstractContextManager[None]:
    """Return the context in which a figure is made and saved: within it, matplotlib has our style."""
    import matplotlib

    return matplotlib.rc_context(STYLE)


def look(role: str | int) -> dict[str, Any]:
    """Return colour, kind and width of the line for a role, or for response 0, 1, 2 ... that has none of its own.

    Raises ValueError for an unknown role.

    >>> look("measurement")["color"], look(0)["color"], look(1)["linestyle"]
    ('#0072B2', '#009E73', (0, (7, 2)))
    """
    if isinstance(role, str):
        if role not in ROLES:
            raise ValueError(f"the role is {role!r}: {did_you_mean(role, ROLES)}")
        return ROLES[role]
    colour = RESPONSE_COLOURS[role % len(RESPONSE_COLOURS)]
    return {"color": colour, "linestyle": RESPONSE_LINES[role % len(RESPONSE_LINES)], "linewidth": 1.8}
