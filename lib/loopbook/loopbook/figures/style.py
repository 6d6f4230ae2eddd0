"""One look for all figures: typeface, colours, kinds of lines, sizes.

A signal has the same colour and the same kind of line in every figure. The colours are those of Okabe and Ito, which
stay apart without colour vision, two of them darkened for thin lines; the dashes stay apart on a grey printout. A
figure is drawn for white paper; on a dark page a style sheet turns it over: `docs/_static/loopbook.css` on the site,
`docs/jupyterlab/custom.css` in JupyterLab.
"""

from __future__ import annotations

from contextlib import AbstractContextManager
from typing import Any

from plainmath.validation import did_you_mean

GREY = "#555555"

STYLE: dict[str, Any] = {
    # One typeface for words and mathematics; it comes with matplotlib, so that every machine draws the same picture.
    "font.family": "STIXGeneral",
    "mathtext.fontset": "stix",
    "font.size": 12,
    "axes.titlesize": 12,
    "axes.titlelocation": "left",
    "axes.titlepad": 8,
    "axes.titley": 1.0,  # where it is; a search for ticks above would take a fifth of the time of a drawing
    "xtick.labelsize": 11,
    "ytick.labelsize": 11,
    "legend.fontsize": 11.5,
    "axes.linewidth": 0.8,
    "axes.spines.top": False,
    "axes.spines.right": False,
    "axes.grid": True,
    "axes.axisbelow": True,
    "axes.ymargin": 0.1,
    "grid.color": "#dddddd",
    "grid.linewidth": 0.6,
    "hatch.linewidth": 0.4,
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
    "control signal": {"color": "#D55E00", "linestyle": "-", "linewidth": 1.5},
    "disturbance": {"color": "#CC79A7", "linestyle": (0, (8, 2, 2, 2)), "linewidth": 1.6},
    "raw": {"color": "#8C8C8C", "linestyle": "-", "linewidth": 0.7, "zorder": 1.8},  # behind what is made of it
}
INPUTS = ("control signal", "disturbance")

# What has no role takes the next of these; six colours and five kinds of line make thirty that differ in one of them.
RESPONSE_COLOURS = ["#009E73", "#C88600", "#3F9BD6", GREY, "#6A3D9A", "#8A3324"]
RESPONSE_LINES = ["-", (0, (7, 2)), (0, (8, 2, 2, 2)), (0, (2, 1.5)), (0, (12, 2, 2, 2, 2, 2))]

# A process is broad, and what is to be equal to it is drawn over it.
MODELS: dict[str, dict[str, Any]] = {
    "process": {"color": "#0072B2", "linestyle": "-", "linewidth": 3.2, "zorder": 1.9},
    "model": {"color": "#C88600", "linestyle": (0, (7, 2)), "linewidth": 1.7, "zorder": 2.3},
    "second model": {"color": "#6A3D9A", "linestyle": (0, (8, 2, 2, 2)), "linewidth": 1.7, "zorder": 2.2},
    "third model": {"color": "#009E73", "linestyle": (0, (2, 1.5)), "linewidth": 1.7, "zorder": 2.1},
}
LOOKS = ROLES | MODELS

# Regions of a plane, one beside the other: so pale that a curve and words on them are read.
TINTS = ["#dcebf5", "#fbe3d3", "#d9efe6", "#f6ecd2", "#ece2f3", "#e8e8e8"]

# What is not a signal: the axes of a plane, a level such as a steady state, the way from a point to an axis, words.
ZERO: dict[str, Any] = {"color": GREY, "linewidth": 0.8, "zorder": 1}
LEVEL: dict[str, Any] = {"color": GREY, "linestyle": (0, (6, 3)), "linewidth": 1, "zorder": 1.5}
GUIDE: dict[str, Any] = {
    "color": GREY, "linestyle": (0, (2, 2)), "linewidth": 1, "zorder": 1.6, "scalex": False, "scaley": False
}  # fmt: skip
EVENT: dict[str, Any] = {"color": GREY, "linewidth": 0.8, "zorder": 1.4}
ON_WHITE: dict[str, Any] = {"facecolor": "white", "edgecolor": "none", "alpha": 0.85, "pad": 1}

WIDTH = 6.0  # inches: less than a notebook column or a printed page, so that it can be read on a phone, too
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
        if role not in LOOKS:
            raise ValueError(f"the role is {role!r}: {did_you_mean(role, LOOKS)}")
        return LOOKS[role]
    colour = RESPONSE_COLOURS[role % len(RESPONSE_COLOURS)]
    return {"color": colour, "linestyle": RESPONSE_LINES[role % len(RESPONSE_LINES)], "linewidth": 1.8}


def pale(colour: str, share: float = 0.2) -> str:
    """Return a colour mixed with white, for an area under a line of that colour.

    >>> pale("#000000"), pale("#0072B2")
    ('#cccccc', '#cce3f0')
    """
    parts = (int(colour[k : k + 2], 16) for k in (1, 3, 5))
    return "#" + "".join(f"{round(255 + (part - 255) * share):02x}" for part in parts)
