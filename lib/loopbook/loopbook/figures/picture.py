"""A finished figure, as a notebook shows and stores it: sharp, light, and described in words."""

from __future__ import annotations

import base64
import io
import struct
from pathlib import Path
from typing import TYPE_CHECKING, Any, BinaryIO

from loopbook.figures.canvas import drawn
from loopbook.figures.style import DOTS_PER_INCH, LOOKS, RESPONSE_COLOURS, styled
from plainmath.tables import plain_words

if TYPE_CHECKING:
    from matplotlib.figure import Figure
    from PIL import Image


SHADES = 3  # of each colour of a stored picture, for soft edges


class Picture:
    """A finished figure that a notebook shows once, as the value of a cell, with a description for who cannot see it.

    Attributes:
        figure: the matplotlib figure, for any change that this module does not offer.
        alt: the description in words; also what `print` and a plain-text display show.
    """

    def __init__(self, figure: Figure, alt: str):
        self.figure = figure
        self.alt = " ".join(alt.split())

    def __repr__(self) -> str:
        return f"<{self.alt}>"

    def save(self, file: str | Path | BinaryIO, **options: Any) -> None:
        """Write the figure to a file (a name ending in .png, .pdf or .svg, or an open file).

        Arguments:
            file: name or open binary file.
            options: what else matplotlib's ``savefig`` understands.
        """
        with styled():
            self.figure.savefig(file, **{"dpi": DOTS_PER_INCH, "bbox_inches": "tight", "pad_inches": 0.06} | options)

    def png(self) -> bytes:
        """Return the figure as the bytes of a PNG file, the same for the same versions of matplotlib and Pillow.

        >>> from loopbook.figures import time_plot
        >>> from loopbook.laplace import t
        >>> time_plot({"$y(t)$": 2 * t}, [0, 1, 2]).png()[:4]
        b'\\x89PNG'
        """
        data = io.BytesIO()
        with_few_colours(self._image()).save(data, "PNG", compress_level=8)
        return data.getvalue()

    def _image(self):
        """The figure as an image of Pillow."""
        if self.figure.dpi != DOTS_PER_INCH:  # one that is not ours, into which it was drawn
            from PIL import Image

            self.save(data := io.BytesIO(), format="png")
            return Image.open(data).convert("RGB")
        with styled():
            return drawn(self.figure)

    # The figure belongs to an object of our own because Jupyter would draw a matplotlib figure its own way, without
    # the description, and only after pyplot has been imported.
    def _repr_mimebundle_(self, include=None, exclude=None):
        if hasattr(self.figure, "number"):  # a figure of pyplot, in which it was drawn, is shown by pyplot
            return {"text/plain": repr(self)}, {}
        image = self.png()
        width, height = (round(dots * 96 / DOTS_PER_INCH) for dots in struct.unpack(">II", image[16:24]))
        data = {"image/png": base64.b64encode(image).decode(), "text/plain": repr(self)}
        shown = {"alt": self.alt, "width": width, "height": height}
        # it is drawn for white: JupyterLab marks such an image, and custom.css turns it over in a dark theme
        return data, {"image/png": shown, "needs_background": "light"}


class Stack(Picture):
    """Several pictures, one below the other, as one."""

    def __init__(self, *pictures: Picture):
        super().__init__(pictures[0].figure, "; ".join(picture.alt for picture in pictures))
        self.pictures = pictures

    def save(self, file: str | Path | BinaryIO, **options: Any) -> None:
        """Write all of them to a file, as the image that a notebook shows; ``options`` are those of Pillow."""
        self._image().save(file, **options)

    def _image(self):
        from PIL import Image

        images = [picture._image() for picture in self.pictures]
        whole = Image.new("RGB", (max(one.width for one in images), sum(one.height for one in images)), "white")
        top = 0
        for image in images:
            whole.paste(image, ((whole.width - image.width) // 2, top))
            top += image.height
        return whole


def stacked(*pictures: Picture) -> Stack:
    """Return pictures one below the other as one picture, which a notebook shows as the value of a cell.

    >>> from loopbook.figures import time_plot
    >>> from loopbook.laplace import t
    >>> stacked(time_plot({"$y(t)$": 2 * t}, [0, 1, 2]), time_plot({"$u(t)$": t}, [0, 1, 2]))
    <y(t) against t [s]; u(t) against t [s]>
    """
    return Stack(*pictures)


def with_few_colours(image: Image.Image) -> Image.Image:
    """A line drawing with the colours of its lines and areas, in a few shades towards white: a quarter as large.

    Arguments:
        image: of Pillow, in RGB.
    Returns:
        The image with a palette: three shades of each colour, or black, white and two greys where there is no other.
    """
    from PIL import Image, ImageColor

    count = {colour: number for number, colour in image.getcolors(image.width * image.height)}
    lines = [*(look["color"] for look in LOOKS.values()), *RESPONSE_COLOURS, "#000000"]
    of_lines = [colour for colour in map(ImageColor.getrgb, lines) if colour in count]
    # what covers half a per cent or more is an area or a grid, but for the white ones
    of_areas = [c for c, number in count.items() if number > 0.005 * image.width * image.height and min(c) < 245]
    mixed = [
        tuple(round(255 + (x - 255) * k / SHADES) for x in colour)
        for colour in [*of_lines, *of_areas]
        for k in range(1, SHADES + 1)
    ]
    if all(max(colour) == min(colour) for colour in [*of_lines, *of_areas]):  # black and white: two bits a dot
        greys = [colour for colour in of_areas if colour != (0, 0, 0)] or [(170, 170, 170)]
        mixed = [(0, 0, 0), (100, 100, 100), max(greys, key=lambda colour: count.get(colour, 0))]
    palette = Image.new("P", (1, 1))
    palette.putpalette([x for colour in dict.fromkeys([(255, 255, 255), *mixed]) for x in colour])
    return image.quantize(palette=palette, dither=Image.Dither.NONE)


def titled(title: str | None, words: str) -> str:
    """Return the description of a figure behind its title, where it has one.

    >>> titled("A lag with $T$ = 2", "y(t) against t [s]")
    'A lag with T = 2: y(t) against t [s]'
    """
    return f"{plain_words(title)}: {words}" if title else words
