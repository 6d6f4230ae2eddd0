"""The distribution of the sums: a drawing, and the same in words."""

from __future__ import annotations

from collections.abc import Sequence

from markupsafe import Markup, escape

from exercisegrader.reports.wording import counted, number

#: The size of the drawing, and what is above the highest bar and below all of them.
WIDTH, HEIGHT, HEAD, FOOT = 640, 230, 40, 50
_BAR = "#0072B2"


def histogram_svg(steps: Sequence[tuple[float, float, int]]) -> Markup:
    """Return the distribution as SVG for a page: bars with their counts, text in the page's colour.

    Arguments:
        steps: triples of lower end, upper end and count.
    """
    wide, ground = WIDTH / (len(steps) + 1), HEIGHT - FOOT
    scale = (ground - HEAD) / max(1, *(count for _, _, count in steps))
    drawn = [f'<path d="M0 {ground}H{WIDTH}" stroke="currentColor"/>', _text(WIDTH / 2, HEIGHT - 8, "points")]
    drawn.append(_text(0, 16, "submissions", "start"))
    for place, (lower, upper, count) in enumerate(steps):
        left, top = (place + 0.5) * wide, ground - scale * count
        if count:
            drawn.append(
                f'<rect x="{left + 0.03 * wide:.1f}" y="{top:.1f}" width="{0.94 * wide:.1f}" '
                f'height="{scale * count:.1f}" fill="{_BAR}"/>'
            )
            drawn.append(_text(left + wide / 2, top - 6, str(count)))
        drawn.append(_text(left, ground + 18, number(lower)))
        if place == len(steps) - 1:
            drawn.append(_text(left + wide, ground + 18, number(upper)))
    label = escape(histogram_words(steps))
    head = f'<svg role="img" aria-label="{label}" viewBox="0 0 {WIDTH} {HEIGHT}" width="{WIDTH}" font-size="14">'
    return Markup("\n".join([head, *drawn, "</svg>"]))


def _text(x, y, text, anchor="middle"):
    return f'<text x="{x:.1f}" y="{y:.1f}" text-anchor="{anchor}" fill="currentColor">{escape(text)}</text>'


def histogram_words(steps: Sequence[tuple[float, float, int]]) -> str:
    """Return the distribution in words.

    >>> histogram_words([(0, 1, 2), (1, 2, 0), (2, 3, 1)])
    'Distribution of the points: 0 to 1: 2 submissions; 2 to 3: 1 submission'
    """
    told = (f"{number(lower)} to {number(upper)}: {counted(n, 'submission')}" for lower, upper, n in steps if n)
    return "Distribution of the points: " + "; ".join(told)
