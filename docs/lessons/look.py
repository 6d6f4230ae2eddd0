"""Colours and lines of the lessons, in a light page and in a dark one: those of the book's figures."""

import colorsys

# The colours of the figures in a dark page: as far apart, and light enough.
IN_THE_DARK = {
    "#000000": "#ffffff", "#0072b2": "#56b4e9", "#d55e00": "#ff9248", "#cc79a7": "#e6a3c8",
    "#009e73": "#2fc79a", "#c88600": "#f2b632", "#3f9bd6": "#8fd0f5", "#555555": "#b0b0b0",
    "#6a3d9a": "#c9a6ee", "#8a3324": "#f0a898", "#8c8c8c": "#8c8c8c",
}  # fmt: skip


def dark(colour):
    """Return a colour of a figure as it is on a dark page; what is pale on white, as an area, is dim there.

    >>> dark("#0072B2"), dark("#eeeeee")
    ('#56b4e9', '#2f2f2f')
    """
    if colour.lower() in IN_THE_DARK:
        return IN_THE_DARK[colour.lower()]
    red, green, blue = (int(colour[k : k + 2], 16) / 255 for k in (1, 3, 5))
    hue, light, strength = colorsys.rgb_to_hls(red, green, blue)
    turned = colorsys.hls_to_rgb(hue, 0.12 + 0.95 * (1 - light), 0.7 * strength)
    return "#" + "".join(f"{round(255 * min(1, share)):02x}" for share in turned)


def dashes_of(line):
    """The dashes of a line of Matplotlib, in pixels."""
    _, dashes = line._unscaled_dash_pattern  # Matplotlib tells it in no other way
    return [round(4 / 3 * points, 1) for points in dashes or ()]
