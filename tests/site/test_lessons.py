"""The live lessons: what is recorded of a cell, and what a page needs for readers without eyes or mouse."""

import importlib
import os
import random
import re
import sys
import types
from html.parser import HTMLParser
from pathlib import Path

import nbformat
import numpy as np
import pytest
import sympy

from loopbook.figures import time_plot
from loopbook.laplace import t

ROOT = Path(__file__).parents[2]
sys.path[:0] = [str(ROOT / "docs"), str(ROOT / "docs" / "extensions")]

lessons = importlib.import_module("lessons")
desk, moving, proof, reading, recording, shapes, store, wording = (
    importlib.import_module(f"lessons.{name}")
    for name in ("desk", "moving", "proof", "reading", "recording", "shapes", "store", "wording")
)

#: Recorded lessons whose chapters need to run for a moment only; three of them are computed anew, and all once a week.
QUICK = (
    "mass_damping_and_spring", "pole_and_initial_value", "gain_pole_and_zero", "two_lags_and_a_delay", "by_hand",
    "zero_to_move", "one_lag_for_three", "at_work", "predictor_at_work", "changed_process", "calm_or_not", "hot_water",
    "in_a_ratio", "one_loop_or_two", "first_feedforward", "along_the_row", "four_criteria", "wish_and_loop",
)  # fmt: skip
SEED = 24
CHOSEN = [*lessons.recorded()] if os.environ.get("LOOPBOOK_ALL") else random.Random(SEED).sample(QUICK, 3)


# ------------------------------------------------------------------------------------------------ shapes and words


def test_a_line_is_written_with_few_letters_and_read_again():
    x = np.linspace(0, 1, 301)
    y = 0.5 + 0.4 * np.exp(-3 * x) * np.cos(20 * x)
    text = shapes.encoded([np.column_stack([x, y])])
    assert len(text) < 150
    (read,) = shapes.decoded(text)
    read = np.array(read) / (shapes.WIDE, shapes.TALL)
    assert read[[0, -1], 0].tolist() == [0, 1]
    assert np.interp(x, read[:, 0], 1 - read[:, 1]) == pytest.approx(y, abs=6 / shapes.TALL)


@pytest.mark.parametrize("way", [0, 40, 41, -40, -41, 363, 364, -364, -365, 4000, -4000])
def test_every_way_is_written_in_letters(way):
    text = "".join(map(shapes.letters, (way, -way)))
    assert shapes.decoded(text) == [[(way, -way)]]


def test_a_line_that_leaves_the_frame_comes_back_where_it_does():
    points = np.array([[0, 0.5], [0.25, 0.5], [0.5, 9], [0.75, 0.5], [1, 0.5]])
    left, right = shapes.inside(points)
    assert left[:2].tolist() == points[:2].tolist()
    assert left[-1, 1] == right[0, 1] == pytest.approx(1 + shapes.ROOM)
    assert right[0, 0] == pytest.approx(0.75 - 0.25 * (0.5 + shapes.ROOM) / 8.5)
    assert right[1:].tolist() == points[3:].tolist()


def test_a_gap_in_a_line_stays_one():
    points = np.array([[0, 0.5], [0.25, 0.5], [0.5, np.nan], [0.75, 0.5], [1, 0.5]])
    assert [len(piece) for piece in shapes.inside(points)] == [2, 2]


def test_a_figure_is_read_as_it_was_drawn():
    plot = time_plot(
        {"$y$": 1 - sympy.exp(-t), "setpoint": (1, "setpoint")}, np.linspace(0, 8, 81), "A lag", ylim=(0, 2)
    )
    scene = reading.scene_of([plot.mark(1, "63 %", "$y$").level(1.5, "limit").event(4, "load")])
    (panel,) = scene.panels
    assert (panel.title, panel.clock, panel.grid) == ("A lag", "<i>t</i> [s]", True)
    assert [text for _, text in panel.x] == ["0", "1", "2", "3", "4", "5", "6", "7", "8"]
    named = {part.label: part for part in scene.parts if part.label}
    assert {*named} == {"<i>y</i>", "setpoint"}
    assert named["setpoint"].look == {"colour": "#000000", "dash": [5.3, 4.0], "width": 1.6}
    (curve,) = named["<i>y</i>"].pieces
    low, high = 0, 2
    assert low + curve[:, 1] * (high - low) == pytest.approx(1 - np.exp(-8 * curve[:, 0]), abs=1e-9)
    (dot,) = (part for part in scene.parts if part.kind == "dots")
    assert dot.pieces[0][0] == pytest.approx([1 / 8, (1 - np.exp(-1)) / 2], abs=1e-3)
    assert {word.text: round(word.x, 3) for word in scene.words} == {"63 %": 0.125, "limit": 1, "load": 0.5}


def test_mathematics_that_has_no_letters_is_refused():
    with pytest.raises(ValueError, match=r"has \\sqrt: expected letters, indices and simple signs"):
        wording.in_html(r"$\sqrt{2}$")


# ------------------------------------------------------------------------------------------------ the recordings


def test_every_cell_with_sliders_is_a_lesson():
    """The 43 cells of the chapters move in the page, and each lesson has its cell."""
    of_cells = [
        lessons.of_cell(path.stem, cell.source)
        for path in sorted((ROOT / "chapters").glob("*.ipynb"))
        for cell in nbformat.read(path, as_version=4).cells
        if cell.cell_type == "code" and "nbval-ignore-output" in cell.metadata.get("tags", [])
    ]
    assert None not in of_cells
    assert [lesson.name for lesson in of_cells] == [*lessons.recorded()]


@pytest.mark.parametrize("name", lessons.recorded())
def test_a_recording_is_of_its_cell_as_it_is(name):
    """Otherwise: ``python docs/lessons`` records what has changed."""
    lesson = lessons.recorded()[name]
    assert not proof.is_stale(lesson), f"the cell of {name} has changed since it was recorded"
    data = lesson.record()["data"]
    columns = [data["verdict"], data["result"], data["axis"], data["word"], data["image"]]
    columns += [item["line"] for item in data["items"]]
    moving = [column for column in columns if isinstance(column, list)]
    assert moving, f"nothing moves in {name}"
    assert {len(column) for column in moving} == {np.prod(data["counts"])}
    assert all(0 <= k < n for k, n in zip(data["start"], data["counts"], strict=True))


@pytest.mark.parametrize("name", CHOSEN)
def test_a_recording_is_what_the_cell_shows(name):
    assert proof.difference(lessons.recorded()[name], seed=SEED) == ""


def test_a_recording_of_another_cell_is_noticed():
    lesson = lessons.recorded()["zero_to_move"]
    record = lesson.record()
    record["data"]["lines"] = [shapes.encoded([np.array([[0, 0.2], [1, 0.3]])])] * len(record["data"]["lines"])
    changed = types.SimpleNamespace(record=lambda: record, chapter=lesson.chapter, function=lesson.function)
    assert "pixels from where it was" in proof.difference(changed, seed=1)


def test_all_recordings_together_are_light():
    sizes = {file.stem: file.stat().st_size for file in (ROOT / "docs" / "lessons" / "recorded").iterdir()}
    assert {*sizes} == {*lessons.recorded()}
    assert max(sizes.values()) < 320_000
    assert sum(sizes.values()) < 4_000_000


def test_the_last_sliders_become_coarser_first_and_keep_what_a_text_names():
    first, second = (recording.Knob(name, name, "", tuple(range(20)), 7, named=(10,)) for name in "KT")
    other = recording.Knob("kind", "kind", "", ("a", "b"), "b", words=True)
    thin = recording.thinned([first, second, other], 440)
    assert [knob.values for knob in thin] == [first.values, (1, 3, 5, 7, 9, 10, 11, 13, 15, 17, 19), other.values]


def test_every_lesson_has_a_title_and_asks_for_something():
    """By the text above its cell."""
    assert len({lesson.title for lesson in lessons.recorded().values()}) == len(lessons.recorded())
    silent = []
    for one in lessons.recorded().values():
        cells = nbformat.read(ROOT / "chapters" / f"{one.chapter}.ipynb", as_version=4).cells
        at = next(k for k, cell in enumerate(cells) if lessons.of_cell(one.chapter, cell.source) is one)
        above = next(cell.source for cell in reversed(cells[:at]) if cell.cell_type == "markdown")
        if not re.search(r"\?|\b([Mm]ove|[Cc]hoose|[Ww]atch|[Ss]lider)\b", above.split("\n\n")[-1]):
            silent.append(one.name)
    assert silent == []


def test_each_chapter_opens_with_a_lesson():
    """Before its first section."""
    for path in sorted((ROOT / "chapters").glob("*.ipynb")):
        cells = nbformat.read(path, as_version=4).cells
        section = next(k for k, cell in enumerate(cells) if re.search(r"^## ", cell.source, re.MULTILINE))
        opens = any(lessons.of_cell(path.stem, cell.source) for cell in cells[:section] if cell.cell_type == "code")
        assert opens or path.stem == "00_start", path.stem


# ------------------------------------------------------------------------------------------------ the data


def test_a_shape_between_two_others_is_what_is_seen_there():
    def response(lag):
        times = np.linspace(0, 1, 101)
        stairs = np.array([[0, 0.1], [0.2, 0.1], [0.2, 0.5], [1, 0.5]])  # upright parts stay upright
        return shapes.encoded([np.column_stack([times, 1 - np.exp(-times / lag)]), stairs, np.array([[lag, 0.5]])])

    seen = shapes.between(response(0.2), response(0.22), 0.5)
    assert shapes.apart(seen, shapes.decoded(response(0.21))) < 1
    assert shapes.between(response(0.2), "", 0.5) is None


def test_a_line_that_is_seen_between_others_is_not_kept():
    def answer(a, b):
        times = np.linspace(0, 1, 51)
        curve = np.column_stack([times, 0.5 + a / 40 * times]) if a != 7 else np.array([[0, 0.9], [1, 0.1]])
        part = reading.Part(0, "line", {"colour": "#000000"}, "y", [curve])
        return "", {}, reading.Scene([reading.Panel("y", "t", 210, True, [], [])], [part]), ""

    data = moving.told([answer(a, b) for a in range(20) for b in range(2)], [20, 2], [0, 0])
    (item,) = data["items"]
    assert min(item["line"][12:18]) >= 0, "the odd one and those beside it"
    assert item["line"].count(moving.BETWEEN) >= 24
    for position in range(40):
        (there,), (seen,) = moving.view(data, position).shapes, answer(position // 2, 0)[2].parts
        assert shapes.apart(shapes.decoded(there), shapes.decoded(seen.letters)) < moving.INVISIBLE + 1


def test_each_position_of_the_sliders_has_its_answer_and_equal_curves_are_kept_once():
    def answer(a, b):
        curves = [np.array([[0, a**2 / 8], [1, a**2 / 8]])], []
        ink = {"colour": "#000000"}
        parts = [reading.Part(0, "line", ink, name, pieces) for name, pieces in zip("yz", curves, strict=True)]
        return f"{a} {b}", {"a": str(a)}, reading.Scene([reading.Panel("y", "t", 210, True, [], [])], parts), ""

    data = moving.told([answer(a, b) for a in range(3) for b in range(2)], [3, 2], [1, 0])
    assert [moving.view(data, k).verdict for k in range(6)] == ["0 0", "0 1", "1 0", "1 1", "2 0", "2 1"]
    curve, none = data["items"]
    assert curve["line"] == [0, 0, 1, 1, 2, 2]
    assert none["line"] == -1
    assert shapes.decoded(moving.view(data, 4).shapes[0]) == [[(0, shapes.TALL / 2), (shapes.WIDE, shapes.TALL / 2)]]
    assert moving.view(data).verdict == "1 0"


def test_an_unknown_lesson_is_refused_by_name():
    with pytest.raises(ValueError, match="there is no lesson 'bode': expected one of operator, "):
        lessons.load("bode")


def test_a_lesson_that_was_not_recorded_says_what_to_do():
    with pytest.raises(ValueError, match="the lesson 'new' is not recorded: run make execute"):
        store.Recorded("new", "10_tuning", "new", "New").record()


# ------------------------------------------------------------------------------------------------ the page


class Elements(HTMLParser):
    """All elements of a piece of HTML, as (name, attributes)."""

    def __init__(self, text):
        super().__init__()
        self.found = []
        self.feed(text)

    def handle_starttag(self, tag, attrs):
        self.found.append((tag, dict(attrs)))

    def all(self, *tags):
        return [attributes for tag, attributes in self.found if tag in tags]


@pytest.mark.parametrize("name", lessons.recorded())
def test_every_input_has_a_label_and_every_picture_a_description(name):
    record = lessons.load(name).record()
    page = Elements(desk.desk(name, record))
    inputs = page.all("input", "select")
    assert len(inputs) == len(record["sliders"])
    labelled = [label["for"] for label in page.all("label")]
    assert [field["id"] for field in inputs] == labelled
    assert all(field["aria-valuetext"] for field in page.all("input"))
    pictures = [attributes for attributes in page.all("div") if attributes.get("class") == "lesson-plot"]
    assert len(pictures) == len(record["data"]["panels"])
    assert all(picture["role"] == "img" and picture["aria-label"] for picture in pictures)
    assert len(pictures) or page.all("img")[0]["alt"]
    assert [p.get("aria-live") for p in page.all("p") if p.get("class") == "lesson-result"] == ["polite"]


@pytest.mark.parametrize("name", lessons.recorded())
def test_without_a_script_the_lesson_is_seen_at_its_start(name):
    record = lessons.load(name).record()
    seen = moving.view(record["data"])
    page = Elements(desk.desk(name, record))
    drawn = [path["d"] for path in page.all("path") if "data-item" in path]
    pairs = sorted(zip(record["data"]["items"], seen.shapes, strict=True), key=lambda pair: pair[0]["panel"])
    assert [bool(d) for d in drawn] == [bool(shape) for _, shape in pairs]
    assert any(drawn) or seen.image


def test_the_page_reads_shapes_as_they_are_written():
    script = (ROOT / "docs" / "_static" / "lessons.js").read_text(encoding="utf-8")
    constants = {name: int(number) for name, number in re.findall(r"const ([A-Z]+) = (\d+);", script)}
    assert constants == {"WIDE": shapes.WIDE, "TALL": shapes.TALL, "NEAR": shapes.NEAR}
    assert "http" not in script
