"""What a lesson is: sliders, curves for every position of the sliders, and results in words."""

import itertools
import math
from dataclasses import dataclass

import numpy as np

from lessons import moving, reading, shapes
from lessons.look import look_of

LARGEST = 200_000  # characters of a lesson
HIGH = 210  # pixels of a panel


@dataclass(frozen=True)
class Slider:
    """One thing to change.

    Attributes:
        name: the argument of the lesson's function.
        label: how the page calls it, with HTML for letters.
        values: what it may be, from left to right.
        start: the value at the beginning.
        unit: of the values.
        words: what the page shows for each value, where that is not the number; then it is a list to choose from.
    """

    name: str
    label: str
    values: tuple
    start: object
    unit: str = ""
    words: tuple = ()

    def __post_init__(self):
        if self.start not in self.values:
            raise ValueError(f"the slider {self.name} cannot start at {self.start}: it has {self.values}")

    @property
    def shown(self):
        """What the page says for each value, with the unit."""
        texts = self.words or [f"{float(value):g}".replace("-", "−") for value in self.values]
        unit = self.unit if self.unit.startswith("\u202f") or not self.unit else f"\u202f{self.unit}"
        return [f"{text}{unit}" for text in texts]

    @property
    def first(self):
        """The position of the value at the beginning."""
        return self.values.index(self.start)


@dataclass(frozen=True)
class Curve:
    """One line of a picture.

    Attributes:
        name: of the signal in what the lesson's function returns.
        label: how the legend calls it, with HTML for letters.
        panel: number of the picture, from the top.
        role: as in `loopbook.figures.style`: a role, or the number of a response.
    """

    name: str
    label: str
    panel: int = 0
    role: object = "measurement"


@dataclass(frozen=True)
class Panel:
    """One picture of a lesson: the name of its vertical axis, and its lowest and highest value."""

    axis: str
    low: float
    high: float

    def share(self, values):
        """Values as shares of the height."""
        return (np.asarray(values, dtype=float) - self.low) / (self.high - self.low)


@dataclass(frozen=True)
class Answer:
    """What a lesson says for one position of its sliders.

    Attributes:
        verdict: a word or two.
        results: {label: text}, the numbers that matter; the labels, with HTML for letters, are the same everywhere.
        signals: {name of the curve: values}; a curve that is missing is omitted.
        marks: [(panel, time, value, label)], points to be marked.
    """

    verdict: str
    results: dict
    signals: dict
    marks: tuple = ()


@dataclass(frozen=True)
class Lesson:
    """A lesson: `respond` makes the `Answer` for one value of each slider.

    Attributes:
        title: of the lesson.
        about, questions: what is shown, and what to try; Markdown, with mathematics.
        sliders, panels, curves: as the page has them.
        times: of all the curves, evenly spaced.
        clock: name of the time axis.
        respond: a function of the sliders' values, by name.
        light: whether all of it takes a moment only, so that a copy of it need not be kept.
    """

    title: str
    about: str
    questions: tuple
    sliders: tuple
    panels: tuple
    curves: tuple
    times: np.ndarray
    respond: object
    clock: str = "time [s]"

    def settings(self):
        """All positions of the sliders, the last slider moving first."""
        names = [slider.name for slider in self.sliders]
        for values in itertools.product(*(slider.values for slider in self.sliders)):
            yield dict(zip(names, values, strict=True))

    def data(self):
        """Return what the page needs, made of texts, numbers and lists.

        Raises ValueError where that is more than a page should have to load.
        """
        answers = [(a.verdict, a.results, self.scene(a), "") for a in (self.respond(**x) for x in self.settings())]
        counts, start = [len(slider.values) for slider in self.sliders], [slider.first for slider in self.sliders]
        found = moving.told(answers, counts, start)
        size = len(str(found))
        if size > LARGEST:
            raise ValueError(f"the lesson {self.title!r} takes {size} characters: expected {LARGEST} at most")
        return found

    def scene(self, answer):
        """What the pictures show of an answer."""
        begin, end = float(self.times[0]), float(self.times[-1])
        shares = (self.times - begin) / (end - begin)
        scene = reading.Scene()
        for number, panel in enumerate(self.panels):
            last = panel is self.panels[-1]
            y = ticks(panel.low, panel.high, 6)
            scene.panels.append(
                reading.Panel(panel.axis, self.clock if last else "", HIGH, True, ticks(begin, end, 9), y)
            )
            for place, curve in enumerate(self.curves):
                values = answer.signals.get(curve.name)
                if curve.panel == number:
                    corners = np.column_stack([shares, panel.share(values)]) if values is not None else None
                    pieces = shapes.inside(corners) if values is not None else []
                    scene.parts.append(
                        reading.Part(number, "line", look_of(curve.role), curve.label, pieces, 10 * number + place / 10)
                    )
        for panel, time, value, label in answer.marks:
            x, y = (time - begin) / (end - begin), self.panels[panel].share(value)
            way = np.array([[x, y], [x, 0]])
            ink = {"colour": "#000000"}
            scene.parts += [
                reading.Part(panel, "line", {**ink, "dash": [3, 3], "width": 1}, "", shapes.inside(way), 100),
                reading.Part(panel, "dots", {**ink, "width": 8}, "", shapes.inside(way[:1]), 101),
            ]
            below = label.startswith("under")
            scene.words.append(reading.Words(panel, x, y, 7, 6 if below else -4, 0, 0 if below else -100, label))
        return scene

    def record(self):
        """Return the lesson as a recorded one is stored: its sliders and its data."""
        sliders = [
            {"name": s.name, "label": s.label, "shown": s.shown, "first": s.first, "list": bool(s.words)}
            for s in self.sliders
        ]  # fmt: skip
        return {"sliders": sliders, "data": self.data()}


def ticks(low, high, most):
    """The round numbers of an axis, as [(share, text)]."""
    from matplotlib.ticker import MaxNLocator

    places = MaxNLocator(most, steps=[1, 2, 2.5, 5, 10]).tick_values(low, high)
    inside = [place for place in places if low - 1e-9 <= place <= high + 1e-9]
    return [(round((p - low) / (high - low), 4), f"{round(p, 9):g}".replace("-", "−")) for p in inside]


def rounded(number, digits=3):
    """A number with a few digits, as the page needs it."""
    return float(f"{float(number):.{digits + 1}g}")


def percent(share):
    """A share as a text, as "23 %"."""
    return f"{100 * float(share):.0f}\u202f%"


def figures(number, digits=3, unit=""):
    """A number as a text, with a few digits and its unit; "∞" where it has no end, "–" where there is none."""
    number = float(number)
    if math.isnan(number):
        return "–"
    text = "∞" if math.isinf(number) else f"{number:.{digits}g}"
    if "e" in text:
        text = f"{number:.0f}" if abs(number) > 1 else f"{number:.6f}"
    return text.replace("-", "−") + (f"\u202f{unit}" if unit else "")


def overshoot(y, final=1.0):
    """How far a response goes beyond its final value, as a text."""
    return percent(max(0.0, float(np.max(y)) / final - 1))


def stepped(times, system_to_setpoint, system_to_load, load_at, load=1.0):
    """The response to a step of the setpoint at once, and of the load later: two systems with exact dead time."""
    late = np.maximum(times - load_at, 0)
    return system_to_setpoint.step(times) + load * (times >= load_at) * system_to_load.step(late)
