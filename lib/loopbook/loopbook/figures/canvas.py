"""What a figure is drawn on: panels at fixed places, and one pass from the lines to the dots."""

from __future__ import annotations

import functools
from collections.abc import Sequence
from typing import TYPE_CHECKING, TypeAlias, Union

import numpy as np

from loopbook.figures.style import DOTS_PER_INCH, WIDTH

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure
    from matplotlib.mathtext import MathTextParser
    from PIL import Image

#: What a picture is drawn into: axes of one's own, as many as it has panels; or None for a new figure.
OwnAxes: TypeAlias = Union["Axes", Sequence["Axes"], np.ndarray, None]

# inches around and between the panels, for the names of the axes, their numbers and the title
LEFT, RIGHT, BELOW, ABOVE, BETWEEN = 0.66, 0.12, 0.5, 0.32, 0.14
MARGIN = 0.06  # inches of white around what is drawn


def panels(heights: Sequence[float], ax: OwnAxes = None) -> tuple[Figure, list[Axes]]:
    """Return a figure with panels of these heights above one another, in inches, and a common horizontal axis.

    The panels stay where they are: what the axes need outside is not negotiated but sticks out, and is cut out with the
    rest. So nothing is drawn twice, and all figures of a page have their axes in one line.

    Arguments:
        heights: of the panels.
        ax: axes of one's own in their place, one of matplotlib or as many as there are heights.
    Raises:
        ValueError: for another number of axes.

    >>> figure, (above, below) = panels([2, 1])
    >>> figure.get_size_inches().round(2), round(above.get_position().height / below.get_position().height)
    (array([6.  , 3.96]), 2)
    """
    if ax is not None:
        own = list(np.ravel(ax))
        if len(own) != len(heights):
            raise ValueError(f"{len(own)} axes for {len(heights)} panels: expected as many")
        for axes in own[1:]:
            if not axes.get_shared_x_axes().joined(axes, own[0]):
                axes.sharex(own[0])
        return own[0].figure.canvas.figure, own  # of a subfigure the whole

    from matplotlib.backends.backend_agg import FigureCanvasAgg
    from matplotlib.figure import Figure

    inside, gaps = sum(heights), BETWEEN * (len(heights) - 1)
    tall = BELOW + inside + gaps + ABOVE
    figure = Figure(figsize=(WIDTH, tall), dpi=DOTS_PER_INCH)
    # it measures texts; the canvas that a figure has by itself looks for this one every time
    FigureCanvasAgg(figure).get_renderer().mathtext_parser = formulas()
    places = {"left": LEFT / WIDTH, "right": 1 - RIGHT / WIDTH, "bottom": BELOW / tall, "top": 1 - ABOVE / tall}
    places |= {"height_ratios": heights, "hspace": BETWEEN / (inside / len(heights))}
    grid = figure.subplots(len(heights), sharex=True, squeeze=False, gridspec_kw=places)
    for axes in grid[:, 0]:
        axes.set_title("")
    return figure, list(grid[:, 0])


@functools.cache
def formulas() -> MathTextParser:
    """Return matplotlib's reader of formulas, with a memory: it needs milliseconds for each, and figures share them."""
    import matplotlib
    from matplotlib.backends.backend_agg import RendererAgg

    parser = RendererAgg(1, 1, DOTS_PER_INCH).mathtext_parser
    remembered = functools.lru_cache(maxsize=1000)(parser.parse)

    def parse(text, dpi=72, prop=None, *, antialiased=None):
        smooth = matplotlib.rcParams["text.antialiased"] if antialiased is None else antialiased
        return remembered(text, dpi, prop and prop.copy(), antialiased=smooth)

    parser.parse = parse
    return parser


def drawn(figure: Figure, room: float = 1.5) -> Image.Image:
    """Draw a figure with all that sticks out of it, in one pass, and cut the picture out.

    Arguments:
        figure: of matplotlib, with our dots per inch.
        room: inches beyond the figure in which something may stick out; it is drawn again with more if that is little.
    Returns:
        The image of Pillow, in RGB on white, as wide as the figure or wider.
    """
    from matplotlib.backends.backend_agg import RendererAgg
    from matplotlib.transforms import Bbox
    from PIL import Image, ImageChops

    width, height = figure.get_size_inches()
    size = tuple(round((length + 2 * room) * DOTS_PER_INCH) for length in (width, height))
    renderer = RendererAgg(*size, DOTS_PER_INCH)
    renderer.mathtext_parser = formulas()
    figure.bbox_inches.set(Bbox.from_bounds(room, room, width, height))
    try:
        figure.draw(renderer)
    finally:
        figure.bbox_inches.set(Bbox.from_bounds(0, 0, width, height))
    paper = Image.new("RGBA", size, "white")
    paper.alpha_composite(Image.frombuffer("RGBA", size, renderer.buffer_rgba()))
    paper = paper.convert("RGB")
    left, above, right, below = ImageChops.invert(paper).getbbox() or (1, 1, 2, 2)
    if not (left and above and right < size[0] and below < size[1]):
        return drawn(figure, 2 * room)
    begin, end, margin = (round(length * DOTS_PER_INCH) for length in (room, room + width, MARGIN))
    return paper.crop((min(left - margin, begin), above - margin, max(right + margin, end), below + margin))
