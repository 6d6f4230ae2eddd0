"""On a dark page figures are turned over by a filter: every colour of theirs keeps its hue, and is seen as well."""

import colorsys
import re
from pathlib import Path

import numpy as np
import pytest
from matplotlib.colors import to_rgb

from loopbook.figures import style

DOCS = Path(__file__).parents[2] / "docs"
LINES = sorted({*(look["color"] for look in style.LOOKS.values()), *style.RESPONSE_COLOURS})


def turned(colour):
    """What the filter of a page makes of a colour, by the matrices of the Filter Effects Module."""
    sheets = "".join((DOCS / sheet).read_text("utf-8") for sheet in ("_static/loopbook.css", "jupyterlab/custom.css"))
    (inverted, degrees), *others = set(re.findall(r"filter: invert\(([\d.]+)\) hue-rotate\((\d+)deg\)", sheets))
    assert not others, "by the system and by the switch, on the site and in JupyterLab, it is one filter"
    share, angle = float(inverted), np.radians(float(degrees))
    weights = np.array([0.213, 0.715, 0.072])
    around = np.array([[-0.213, -0.715, 0.928], [0.143, 0.140, -0.283], [-0.787, 0.715, 0.072]])
    rotated = weights + np.cos(angle) * (np.eye(3) - weights) + np.sin(angle) * around
    return np.clip(rotated @ (share - (2 * share - 1) * np.array(to_rgb(colour))), 0, 1)


def contrast(one, other):
    """The contrast of two colours, as WCAG defines it: from 1 to 21."""
    light = sorted(
        np.dot([0.2126, 0.7152, 0.0722], [x / 12.92 if x <= 0.03928 else ((x + 0.055) / 1.055) ** 2.4 for x in colour])
        for colour in (one, other)
    )
    return (light[1] + 0.05) / (light[0] + 0.05)


@pytest.mark.parametrize("colour", LINES)
def test_a_line_keeps_its_hue_and_is_seen_as_well(colour):
    day, night = to_rgb(colour), turned(colour)
    assert contrast(day, to_rgb("white")) > 3
    assert contrast(night, turned("white")) > 4
    if max(day) - min(day) > 0.05:  # greys have no hue
        difference = abs(colorsys.rgb_to_hls(*day)[0] - colorsys.rgb_to_hls(*night)[0])
        assert min(difference, 1 - difference) * 360 < 3


def test_lines_that_differ_by_day_differ_by_night():
    def distance(one, other, seen):
        return np.linalg.norm(np.subtract(seen(one), seen(other)))

    for number, one in enumerate(LINES):
        for other in LINES[:number]:
            assert distance(one, other, turned) > 0.4 * distance(one, other, to_rgb), (one, other)


def test_words_are_read_by_day_and_by_night_and_on_every_tint():
    for words in (style.GREY, "black"):
        assert contrast(to_rgb(words), to_rgb("white")) > 7 < contrast(turned(words), turned("white"))
    for tint in style.TINTS:
        assert contrast(to_rgb(tint), to_rgb("black")) > 14


def test_white_becomes_the_page():
    assert turned("white") == pytest.approx([19 / 255] * 3, abs=0.02)  # #131416, the theme's own
