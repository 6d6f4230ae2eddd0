"""What a page needs of a lesson: the pictures for every position of its sliders, written as little as can be."""

import itertools
import math
from dataclasses import dataclass

import numpy as np

from lessons import shapes
from lessons.look import dark
from lessons.reading import Scene


class Book:
    """Things by number, each kept once."""

    def __init__(self):
        self.things, self.numbers = [], {}

    def number(self, thing):
        """The number of a thing, a new one where it is new."""
        key = repr(thing)
        if key not in self.numbers:
            self.numbers[key] = len(self.things)
            self.things.append(thing)
        return self.numbers[key]


INVISIBLE = 1  # pixels by which a line between two recorded ones may be elsewhere
SPANS = (32, 16, 8, 4, 2)  # positions of a slider, over which a line is tried to be between two
BETWEEN = -2  # in the place of the number of a line


def sparse(column, lines, counts, along, start):
    """Return the numbers of lines for all positions, with `BETWEEN` where a line is seen between two others.

    Arguments:
        column: the numbers, -1 for no line.
        lines: the letters of all lines.
        counts: how many positions each slider has.
        along: the number of the slider between whose positions a line may be.
        start: the position of that slider at the beginning, where no line is between others.
    """
    grid = np.array(column).reshape(counts)
    across = np.moveaxis(grid, along, -1)
    for place in np.ndindex(across.shape[:-1]):
        row, first = across[place], 0
        while first < len(row) - 1:
            farthest = start if first < start else len(row) - 1
            ends = (min(first + span, farthest) for span in SPANS)
            last = next((end for end in ends if end > first + 1 and is_seen(row[first : end + 1], lines)), first + 1)
            row[first + 1 : last] = BETWEEN
            first = last
    return grid.ravel().tolist()


def is_seen(row, lines):
    """Whether each line of a row can be seen between the first and the last one."""
    if (row < 0).any():
        return False
    for number, line in enumerate(row[1:-1], start=1):
        found = shapes.between(lines[row[0]], lines[row[-1]], number / (len(row) - 1))
        if found is None or shapes.apart(found, shapes.decoded(lines[line])) > INVISIBLE:
            return False
    return True


def told(answers, counts, start):
    """Return the data of a lesson, made of texts, numbers and lists.

    Arguments:
        answers: for every position of the sliders, the last one moving first: (verdict, {label: result}, scene, image).
        counts: how many positions each slider has.
        start: the position of each slider at the beginning.
    """
    scenes = [scene for *_, scene, _ in answers]
    parts, panels = all_parts(scenes), next((scene.panels for scene in scenes if scene.panels), [])
    labels = {label: None for _, said, *_ in answers for label in said}
    lines, words, axes, images, results, verdicts, groups = (Book() for _ in range(7))
    one_title = len({scene.panels[0].title for scene in scenes if scene.panels}) <= 1
    rows = []
    for verdict, said, scene, image in answers:
        own = {key: part.letters for key, part in keyed(scene)}
        title = scene.panels[0].title if scene.panels and not one_title else ""
        rows.append(
            {
                "verdict": verdicts.number(verdict or title),
                "results": results.number([said.get(label, "–") for label in labels]),
                "axes": axes.number([[panel.x, panel.y] for panel in scene.panels]),
                "words": groups.number([words.number(word.as_list()) for word in scene.words]),
                "image": images.number(image) if image else -1,
                **{key: lines.number(own[key]) if own.get(key) else -1 for key in parts},
            }
        )

    def column(name):
        """A number for each answer, or only one where it is always the same."""
        return alone([row[name] for row in rows])

    along = int(np.argmax(counts))
    columns = {key: sparse([row[key] for row in rows], lines.things, counts, along, start[along]) for key in parts}
    kept = sorted({line for numbers in columns.values() for line in numbers if line >= 0})
    anew = {line: number for number, line in enumerate(kept)}
    columns = {key: [anew.get(line, line) for line in numbers] for key, numbers in columns.items()}
    return {
        "counts": list(counts),
        "start": list(start),
        "along": along,
        "panels": [
            {
                "axis": panel.axis, "clock": panel.clock, "height": panel.height, "grid": panel.grid,
                "title": panel.title if number or one_title else "",
            }
            for number, panel in enumerate(panels)
        ],
        "items": [
            {"panel": p.panel, "kind": p.kind, "label": p.label, **inked(p.look), "line": alone(columns[key])}
            for key, p in parts.items()
        ],
        "labels": list(labels),
        "verdict": column("verdict"), "verdicts": verdicts.things,
        "result": column("results"), "results": results.things,
        "axis": column("axes"), "axes": axes.things,
        "word": column("words"), "groups": groups.things, "words": words.things,
        "image": column("image"), "images": images.things,
        "lines": [lines.things[line] for line in kept],
    }  # fmt: skip


def alone(numbers):
    """Numbers, or only one where they are all the same."""
    return numbers[0] if len(set(numbers)) == 1 else numbers


def inked(look):
    """A look with its colours in a light and in a dark page."""
    found = {name: value for name, value in look.items() if name not in ("colour", "edge")}
    found |= {"light": look["colour"], "dark": dark(look["colour"])}
    if "edge" in look:
        found |= {"edge": look["edge"], "darkEdge": dark(look["edge"])}
    return found


def keyed(scene: Scene):
    """The parts of a scene, each with what it is recognised by in another position of the sliders."""
    seen = {}
    for part in scene.parts:
        kind = (part.panel, part.kind, part.label, repr(part.look))
        seen[kind] = seen.get(kind, -1) + 1
        yield (*kind, seen[kind]), part


def all_parts(scenes):
    """The parts that there are at any position, in the order of drawing, by what they are recognised by."""
    found = {}
    for scene in scenes:
        for key, part in keyed(scene):
            found.setdefault(key, part)
    return dict(sorted(found.items(), key=lambda pair: pair[1].order))


def first(data):
    """The number of the answer for the sliders as they stand at the beginning."""
    number = 0
    for start, count in zip(data["start"], data["counts"], strict=True):
        number = number * count + start
    return number


@dataclass(frozen=True)
class View:
    """What is seen at one position of the sliders.

    Attributes:
        verdict: a few words, as HTML.
        results: a text for each of the lesson's labels.
        axes: the numbers of both axes, for each panel.
        shapes: letters for each item, none where it is missing.
        words: those in the panels, as `reading.Words` lists them.
        image: where it has no panels, the PNG picture in base64.
    """

    verdict: str
    results: list
    axes: list
    shapes: list
    words: list
    image: str


def view(data, number=None):
    """Return what is seen at one position of the sliders, the first if no other."""
    number = first(data) if number is None else number

    def at(column):
        return column[number] if isinstance(column, list) else column

    return View(
        verdict=data["verdicts"][at(data["verdict"])],
        results=data["results"][at(data["result"])],
        axes=data["axes"][at(data["axis"])],
        shapes=[shape_at(data, item["line"], number) for item in data["items"]],
        words=[data["words"][word] for word in data["groups"][at(data["word"])]],
        image=data["images"][at(data["image"])] if at(data["image"]) >= 0 else "",
    )


def shape_at(data, column, number):
    """The letters of an item at a position, none where it is missing."""
    line = column[number] if isinstance(column, list) else column
    if line != BETWEEN:
        return data["lines"][line] if line >= 0 else ""
    step = math.prod(data["counts"][data["along"] + 1 :])
    first, last = (next(k for k in itertools.count(1) if column[number + way * k * step] >= 0) for way in (-1, 1))
    ends = (data["lines"][column[number + way * step]] for way in (-first, last))
    return shapes.in_letters(shapes.between(*ends, first / (first + last)))
