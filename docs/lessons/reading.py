"""What a finished figure shows, taken out of it again: lines, areas, points, words and axes, as shapes and HTML."""

import functools
from dataclasses import dataclass, field

import numpy as np
from matplotlib.cbook import STEP_LOOKUP_MAP
from matplotlib.collections import LineCollection, PolyCollection, QuadMesh
from matplotlib.colors import to_hex
from matplotlib.text import Annotation

from lessons import shapes
from lessons.look import dashes_of
from lessons.wording import in_html
from loopbook.figures.style import styled

PIXELS = 4 / 3  # of a point of print
HIGH = 105  # pixels of an inch of a panel: a little more than a browser's inch
NARROW = 2  # pixels of a stair
SIDE = {"left": 0, "center": -50, "right": -100}
LEVEL = {"top": 0, "center": -50, "bottom": -100, "baseline": -80}


@dataclass
class Part:
    """A line, an area or points of a panel.

    Attributes:
        panel: its number, from the top.
        kind: "line", "area" or "dots".
        look: colour, and dashes and width in pixels where it has them.
        label: how the legend calls it, as HTML; nothing where the figure has it in no legend.
        pieces: of its shape, in shares of the frame.
        order: what is drawn later has a larger one.
    """

    panel: int
    kind: str
    look: dict
    label: str
    pieces: list
    order: float = 0

    @functools.cached_property
    def letters(self):
        """Its shape as letters."""
        return shapes.encoded(self.pieces) if self.pieces else ""


@dataclass
class Words:
    """Words in a panel: where they are in shares of the frame, by how many pixels beside it, and how they lie there."""

    panel: int
    x: float
    y: float
    right: float
    down: float
    side: int
    level: int
    text: str

    def as_list(self):
        """As the page has them: per cent from the left and from the top, and the rest."""
        place = [round(100 * self.x, 1), round(100 * (1 - self.y), 1), round(self.right, 1), round(self.down, 1)]
        return [self.panel, *place, self.side, self.level, self.text]


@dataclass
class Panel:
    """One frame of a figure: names of its axes as HTML, its height in pixels, and its numbers.

    Attributes:
        axis: name of the vertical axis.
        clock: name of the horizontal axis, where it has its numbers below this panel.
        height: in pixels.
        grid: whether lines go through the numbers of its axes.
        x, y: the numbers: (share of the frame, text).
        title: of its picture; only the first panel of a picture has one.
    """

    axis: str
    clock: str
    height: int
    grid: bool
    x: list
    y: list
    title: str = ""


@dataclass
class Scene:
    """All that one figure, or several below one another, shows."""

    panels: list = field(default_factory=list)
    parts: list = field(default_factory=list)
    words: list = field(default_factory=list)


def scene_of(pictures):
    """Return what pictures of `loopbook.figures` show, from the top down.

    Raises ValueError for what has no equal in a page, as an unknown sign for points.
    """
    scene = Scene()
    for picture in pictures:
        with styled():
            read(picture.figure, scene)
    scene.parts.sort(key=lambda part: part.order)
    return scene


def read(figure, scene):
    """Add the panels of a figure of Matplotlib to a scene."""
    grid = [axes for axes in figure.axes if axes.get_label() != "<colorbar>"]
    for number, axes in enumerate(grid):
        panel = len(scene.panels)
        last = number == len(grid) - 1
        scene.panels.append(
            Panel(
                axis=in_html(axes.get_ylabel()),
                clock=in_html(axes.get_xlabel()) if last else "",
                height=round(axes.bbox.height / figure.dpi * HIGH),
                grid=bool(axes.xaxis.get_tick_params().get("gridOn")),
                x=numbers_of(axes.xaxis, axes.get_xlim(), axes),
                y=numbers_of(axes.yaxis, axes.get_ylim(), axes),
                title=in_html(axes.get_title(loc="left")) if number == 0 else "",
            )
        )
        explained = legend_of(axes)
        scene.parts += lines_of(axes, panel, explained)
        scene.parts += areas_of(axes, panel, explained, figure)
        scene.words += words_of(axes, panel)


def numbers_of(axis, limits, axes):
    """The numbers of an axis that are in the frame, with their places in it, in shares."""
    low, high = sorted(limits)
    places = [place for place in axis.get_majorticklocs() if low - 1e-9 * (high - low) <= place <= high * (1 + 1e-9)]
    texts = axis.get_major_formatter().format_ticks(places)
    way = axes.transData - axes.transAxes
    across = axis.axis_name == "x"
    left, bottom = min(axes.get_xlim()), min(axes.get_ylim())
    here = [(place, bottom) if across else (left, place) for place in places]
    shares = way.transform(np.array(here).reshape(-1, 2))[:, 0 if across else 1]
    return [(round(float(share), 4), in_html(text)) for share, text in zip(shares, texts, strict=True)]


def legend_of(axes):
    """The labels in the legend of a panel, as {label in the figure: label that is shown}."""
    legend = axes.get_legend()
    return {text.get_text(): in_html(text.get_text()) for text in legend.get_texts()} if legend else {}


def lines_of(axes, panel, explained):
    """The lines and points of a panel."""
    found = []
    for line in axes.lines:
        if not line.get_visible():
            continue
        x, y = corners_of(line, axes)
        x, y = np.broadcast_arrays(np.asarray(x, dtype=float), np.asarray(y, dtype=float))
        with np.errstate(all="ignore"):
            shares = (line.get_transform() - axes.transAxes).transform(np.column_stack([x, y]))
        label = explained.get(line.get_label(), "")
        colour, order = to_hex(line.get_color()), line.get_zorder()
        if line.get_marker() not in ("None", None, ""):
            if line.get_marker() not in "o.s^":
                raise ValueError(f"points are drawn as {line.get_marker()!r}: expected dots")
            look = {"colour": colour, "width": round(line.get_markersize() * PIXELS, 1)}
            points = [point for k in range(len(shares)) for point in shapes.inside(shares[k : k + 1], room=0.02)]
            found.append(Part(panel, "dots", look, label, points, order))
            continue
        look = {"colour": colour, "dash": dashes_of(line), "width": round(line.get_linewidth() * PIXELS, 1)}
        found.append(Part(panel, "line", look, label, shapes.inside(shares), order))
    for lines in axes.collections:
        if isinstance(lines, LineCollection):
            pieces = [
                piece
                for segment in lines.get_segments()
                for piece in shapes.inside((lines.get_transform() - axes.transAxes).transform(segment))
            ]
            colour, width = to_hex(lines.get_color()[0]), round(float(lines.get_linewidth()[0]) * PIXELS, 1)
            look = {"colour": colour, "dash": [], "width": width}
            found.append(Part(panel, "line", look, "", pieces, lines.get_zorder()))
    return found


def corners_of(line, axes):
    """The corners of a line; stairs that are narrower than the eye sees are none."""
    x, y = line.get_xdata(), line.get_ydata()
    low, high = sorted(axes.get_xlim())
    stair = np.median(np.diff(x)) / (high - low) * shapes.WIDE * shapes.STEP[0] if len(x) > 1 else 0
    return (x, y) if stair < NARROW else STEP_LOOKUP_MAP[line.get_drawstyle()](x, y)


def areas_of(axes, panel, explained, figure):
    """The areas of a panel: between curves, of bars, of polygons, and of a map."""
    found = []
    for area in axes.collections:
        if isinstance(area, QuadMesh):
            found += map_of(area, axes, panel, figure)
        elif isinstance(area, PolyCollection):
            way = area.get_transform() - axes.transAxes
            pieces = [held(way.transform(corners)) for path in area.get_paths() for corners in path.to_polygons()]
            look = {"colour": to_hex(area.get_facecolor()[0])}
            found.append(Part(panel, "area", look, explained.get(area.get_label(), ""), pieces, area.get_zorder()))
        elif not isinstance(area, LineCollection):
            raise ValueError(f"a figure has {type(area).__name__}: expected lines, areas and maps")
    for patch in axes.patches:
        way = patch.get_transform() - axes.transAxes
        pieces = [held(way.transform(corners)) for corners in patch.get_path().to_polygons()]
        look = {"colour": to_hex(patch.get_facecolor())}
        if patch.get_linewidth() and patch.get_edgecolor()[3]:
            look |= {"edge": to_hex(patch.get_edgecolor()), "width": round(patch.get_linewidth() * PIXELS, 1)}
        found.append(Part(panel, "area", look, explained.get(patch.get_label(), ""), pieces, patch.get_zorder()))
    return found


def held(corners):
    """The corners of an area, those far away at the edge of what is drawn."""
    return np.clip(corners, -shapes.ROOM, 1 + shapes.ROOM)


def map_of(mesh, axes, panel, figure):
    """The areas of a map of whole numbers, one for each shade, as stripes."""
    scale = next(other for other in figure.axes if other.get_label() == "<colorbar>")
    names = [text.get_text() for text in scale.get_yticklabels()]
    title = in_html(scale.get_ylabel() or scale.get_xlabel())
    corners = mesh.get_coordinates()
    rows, columns = corners.shape[0] - 1, corners.shape[1] - 1
    shares = (mesh.get_transform() - axes.transAxes).transform(corners.reshape(-1, 2)).reshape(rows + 1, columns + 1, 2)
    shade = np.asarray(mesh.get_array()).reshape(rows, columns)
    found = []
    for number, name in enumerate(names):
        pieces = []
        for row in range(rows):
            edges = np.flatnonzero(np.diff(np.r_[False, shade[row] == number, False]))
            for first, last in edges.reshape(-1, 2):
                low, high = shares[row, first], shares[row + 1, last]
                pieces.append(held(np.array([low, [high[0], low[1]], high, [low[0], high[1]]])))
        colour = to_hex(mesh.cmap(mesh.norm(number)))
        found.append(Part(panel, "area", {"colour": colour, "crisp": True}, f"{title}: {name}", pieces, 0))
    return found


def words_of(axes, panel):
    """The words in a panel."""
    found = []
    for text in axes.texts:
        if not text.get_text():
            continue
        if isinstance(text, Annotation):
            kinds = text.xycoords if isinstance(text.xycoords, tuple) else (text.xycoords,) * 2
            x, y = (
                place if kind == "axes fraction" else share_of(axes, place, along)
                for place, kind, along in zip(text.xy, kinds, (0, 1), strict=True)
            )
            right, up = text.xyann
        else:
            x, y = (text.get_transform() - axes.transAxes).transform(text.get_position())
            right, up = 0, 0
        if -0.02 <= x <= 1.02 and -0.02 <= y <= 1.02:
            side, level = SIDE[text.get_ha()], LEVEL[text.get_va()]
            found.append(
                Words(panel, float(x), float(y), right * PIXELS, -up * PIXELS, side, level, in_html(text.get_text()))
            )
    return found


def share_of(axes, place, along):
    """A value of one axis as a share of the frame."""
    point = [min(axes.get_xlim()), min(axes.get_ylim())]
    point[along] = float(place)
    return (axes.transData - axes.transAxes).transform(point)[along]
