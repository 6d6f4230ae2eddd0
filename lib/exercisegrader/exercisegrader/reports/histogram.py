"""The distribution of the sums: a drawing, and the same in words."""

from __future__ import annotations

import io
import re
from collections.abc import Sequence

from markupsafe import Markup

from exercisegrader.reports.wording import counted, number
from loopbook.figures import Picture
from loopbook.figures.style import STYLE, WIDTH

_BAR = "#0072B2"
#: Stands for the colour of the page's text, which follows its ground.
_INK = "#010203"


def histogram_svg(steps: Sequence[tuple[float, float, int]]) -> Markup:
    """Return the distribution as SVG for a page: text in the page's colour, on its ground; the same bytes every time.

    Arguments:
        steps: triples of lower end, upper end and count.
    """
    import matplotlib
    from matplotlib.figure import Figure
    from matplotlib.ticker import MaxNLocator

    label = histogram_words(steps)
    ink = dict.fromkeys(["text.color", "axes.labelcolor", "axes.edgecolor", "xtick.color", "ytick.color"], _INK)
    ink["axes.facecolor"] = "none"
    fixed = {"svg.hashsalt": "loopbook", "svg.fonttype": "path"}
    with matplotlib.rc_context(STYLE | ink | fixed):
        figure = Figure(figsize=(WIDTH, 2.6), layout="constrained")
        axes = figure.subplots()
        axes.bar(
            [lower for lower, _, _ in steps],
            [count for _, _, count in steps],
            [0.94 * (upper - lower) for lower, upper, _ in steps],
            align="edge",
            color=_BAR,
        )
        axes.set_xticks([*(lower for lower, _, _ in steps), steps[-1][1]])
        axes.set_xticklabels([*(number(lower) for lower, _, _ in steps), number(steps[-1][1])])
        axes.yaxis.set_major_locator(MaxNLocator(nbins=5, integer=True))
        axes.set_xlim(-0.01 * steps[-1][1], 1.01 * steps[-1][1])
        axes.set_ylim(0, max(1, *(count for _, _, count in steps)) * 1.1)
        axes.grid(visible=False, axis="x")
        axes.grid(visible=True, axis="y", color="#888888", alpha=0.35)
        axes.set_xlabel("points")
        axes.set_ylabel("submissions")
        file = io.BytesIO()
        metadata = dict.fromkeys(["Creator", "Date", "Format", "Type"])
        Picture(figure, label).save(file, format="svg", facecolor="none", metadata=metadata)
    drawing = file.getvalue().decode()
    drawing = drawing[drawing.index("<svg") :].replace(_INK, "currentColor")
    drawing = re.sub(r"<metadata>.*?</metadata>|<!--.*?-->", "", drawing, flags=re.DOTALL)
    drawing = re.sub(r"\s*\n\s*", "\n", drawing).strip()
    return Markup(drawing.replace("<svg ", f'<svg role="img" aria-label="{label}" ', 1))


def histogram_words(steps: Sequence[tuple[float, float, int]]) -> str:
    """Return the distribution in words.

    >>> histogram_words([(0, 1, 2), (1, 2, 0), (2, 3, 1)])
    'Distribution of the points: 0 to 1: 2 submissions; 2 to 3: 1 submission'
    """
    told = (f"{number(lower)} to {number(upper)}: {counted(n, 'submission')}" for lower, upper, n in steps if n)
    return "Distribution of the points: " + "; ".join(told)
