"""What a lesson is: sliders, curves for every position of the sliders, and results in words."""

import itertools
import math
from dataclasses import dataclass

import numpy as np

from loopbook.figures.style import RESPONSE_COLOURS, RESPONSE_LINES, ROLES

ALPHABET = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789-_"
TOP = len(ALPHABET) ** 2 - 1  # a value is two letters: finer than a screen, and a third of what decimals would take
ROOM = 0.5  # beyond the axis on either side, in heights of it; what is farther out does not come back into the picture
LARGEST = 300_000  # characters in the file of a lesson

# The colours of the figures in a dark page: as far apart, and light enough.
IN_THE_DARK = {
    "#000000": "#ffffff", "#0072B2": "#56B4E9", "#D55E00": "#ff9248", "#CC79A7": "#e6a3c8",
    "#009E73": "#2fc79a", "#C88600": "#f2b632", "#3F9BD6": "#8fd0f5", "#555555": "#b0b0b0",
    "#6A3D9A": "#c9a6ee", "#8A3324": "#f0a898", "#8C8C8C": "#8c8c8c",
}  # fmt: skip


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

    @property
    def look(self):
        """Colour in a light and in a dark page, dashes and width in pixels."""
        if self.role in ROLES:
            look = ROLES[self.role]
        else:
            look = {"color": RESPONSE_COLOURS[self.role], "linestyle": RESPONSE_LINES[self.role], "linewidth": 2.0}
        dashes = [] if look["linestyle"] == "-" else [round(4 / 3 * points, 1) for points in look["linestyle"][1]]
        colour = look["color"]
        return {
            "light": colour, "dark": IN_THE_DARK[colour], "dash": dashes, "width": round(look["linewidth"] * 4 / 3, 1),
        }  # fmt: skip


@dataclass(frozen=True)
class Panel:
    """One picture of a lesson: the name of its vertical axis, and its lowest and highest value."""

    axis: str
    low: float
    high: float


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
        lines, places, answers = [], {"": -1}, []
        for values in self.settings():
            answer = self.respond(**values)
            which = []
            for curve in self.curves:
                text = self._encoded(answer.signals.get(curve.name), self.panels[curve.panel])
                if text not in places:  # curves that do not depend on all the sliders are kept once
                    places[text] = len(lines)
                    lines.append(text)
                which.append(places[text])
            marks = [[panel, rounded(time), rounded(value), label] for panel, time, value, label in answer.marks]
            answers.append([answer.verdict, list(answer.results.values()), which, marks])
        found = {
            "start": [slider.first for slider in self.sliders],
            "counts": [len(slider.values) for slider in self.sliders],
            "time": {"from": float(self.times[0]), "to": float(self.times[-1]), "count": len(self.times)},
            "clock": self.clock,
            "panels": [{"axis": p.axis, "low": p.low, "high": p.high} for p in self.panels],
            "curves": [{"panel": c.panel, "label": c.name, **c.look} for c in self.curves],
            "results": list(answer.results),
            "answers": answers,
            "lines": lines,
        }
        size = sum(map(len, lines)) + len(str(answers))
        if size > LARGEST:
            raise ValueError(f"the lesson {self.title!r} takes {size} characters: expected {LARGEST} at most")
        return found

    @staticmethod
    def _encoded(values, panel):
        """Values as letters, two each: 0 is half a height below the axis, and `TOP` half a height above it."""
        if values is None:
            return ""
        height = panel.high - panel.low
        share = (np.asarray(values, dtype=float) - panel.low + ROOM * height) / ((1 + 2 * ROOM) * height)
        steps = np.rint(np.clip(share, 0, 1) * TOP).astype(int)
        return "".join(ALPHABET[step // 64] + ALPHABET[step % 64] for step in steps)


def decoded(text, panel):
    """Values of a curve from the letters of the page's data, as the page itself reads them."""
    steps = np.array([64 * ALPHABET.index(a) + ALPHABET.index(b) for a, b in zip(text[::2], text[1::2], strict=True)])
    height = panel.high - panel.low
    return panel.low - ROOM * height + steps / TOP * (1 + 2 * ROOM) * height


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
