"""What a page needs of a lesson: the pictures for every position of its sliders, written as little as can be."""

from dataclasses import dataclass

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


def told(answers, counts, start, close=shapes.CLOSE):
    """Return the data of a lesson, made of texts, numbers and lists.

    Arguments:
        answers: for every position of the sliders, the last one moving first: (verdict, {label: result}, scene, image).
        counts: how many positions each slider has.
        start: the position of each slider at the beginning.
        close: pixels by which a line may be elsewhere.
    """
    scenes = [scene for *_, scene, _ in answers]
    parts, panels = all_parts(scenes), next((scene.panels for scene in scenes if scene.panels), [])
    labels = {label: None for _, said, *_ in answers for label in said}
    lines, words, axes, images, results, verdicts, groups = (Book() for _ in range(7))
    one_title = len({scene.panels[0].title for scene in scenes if scene.panels}) <= 1
    rows = []
    for verdict, said, scene, image in answers:
        own = {key: shapes.encoded(part.pieces, close) if part.pieces else "" for key, part in keyed(scene)}
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
        found = [row[name] for row in rows]
        return found[0] if len(set(found)) == 1 else found

    return {
        "counts": list(counts),
        "start": list(start),
        "panels": [
            {
                "axis": panel.axis, "clock": panel.clock, "height": panel.height, "grid": panel.grid,
                "title": panel.title if number or one_title else "",
            }
            for number, panel in enumerate(panels)
        ],
        "items": [
            {"panel": p.panel, "kind": p.kind, "label": p.label, **inked(p.look), "line": column(key)}
            for key, p in parts.items()
        ],
        "labels": list(labels),
        "verdict": column("verdict"), "verdicts": verdicts.things,
        "result": column("results"), "results": results.things,
        "axis": column("axes"), "axes": axes.things,
        "word": column("words"), "groups": groups.things, "words": words.things,
        "image": column("image"), "images": images.things,
        "lines": lines.things,
    }  # fmt: skip


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

    lines = [at(item["line"]) for item in data["items"]]
    return View(
        verdict=data["verdicts"][at(data["verdict"])],
        results=data["results"][at(data["result"])],
        axes=data["axes"][at(data["axis"])],
        shapes=[data["lines"][line] if line >= 0 else "" for line in lines],
        words=[data["words"][word] for word in data["groups"][at(data["word"])]],
        image=data["images"][at(data["image"])] if at(data["image"]) >= 0 else "",
    )
