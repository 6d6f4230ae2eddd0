"""The live lessons: their numbers by another route, and what a page needs for readers without eyes or mouse."""

import dataclasses
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

from loopbook import approximation, s, stability, tuning
from loopbook.deadtime import Loop, System, closed_loop
from loopbook.figures import time_plot
from loopbook.identification import good_gain_experiment
from loopbook.laplace import t
from loopbook.pid import PID
from loopbook.transfer import first_order

ROOT = Path(__file__).parents[2]
sys.path[:0] = [str(ROOT / "docs"), str(ROOT / "docs" / "extensions")]

lessons = importlib.import_module("lessons")
desk, lesson, moving, places, proof, reading, recording, shapes, store, wording = (
    importlib.import_module(f"lessons.{name}")
    for name in (
        "desk", "lesson", "moving", "places", "proof", "reading", "recording", "shapes", "store", "wording",
    )
)  # fmt: skip
cascade, good_gain, half_rule, pi, smith, windup = (
    importlib.import_module(f"lessons.{name}")
    for name in ("cascade", "good_gain", "half_rule", "pi", "smith", "windup")
)

#: Recorded lessons whose chapters need to run for a moment only; three of them are computed anew, and all once a week.
QUICK = (
    "mass_damping_and_spring", "pole_and_initial_value", "gain_pole_and_zero", "two_lags_and_a_delay", "by_hand",
    "zero_to_move", "one_lag_for_three", "at_work", "predictor_at_work", "changed_process", "calm_or_not", "hot_water",
    "in_a_ratio", "one_loop_or_two", "first_feedforward", "along_the_row", "four_criteria", "wish_and_loop",
)  # fmt: skip
SEED = 24
CHOSEN = [*lessons.recorded()] if os.environ.get("LOOPBOOK_ALL") else random.Random(SEED).sample(QUICK, 3)


def at_the_start(name):
    """A lesson whose sliders have only the values at which they start: quickly computed."""
    whole = lessons.load(name)
    only = [dataclasses.replace(x, values=(x.start,), words=x.words[x.first :][:1]) for x in whole.sliders]
    return dataclasses.replace(whole, sliders=tuple(only))


# ------------------------------------------------------------------------------------------------ the numbers


def by_small_steps(T, delay, controller, times, load_at, steps=200):
    """A lag with dead time under control, by Heun's method with `steps` steps to one unit of time."""
    h, late = 1 / steps, round(delay * steps)
    count = round(times[-1] * steps)
    u, y = np.zeros(count + 1), np.zeros(count + 1)
    remember = [0.0]
    for k in range(count):
        u[k] = controller(1 - y[k], remember, h)
        now, then = (u[j - late] + (j >= load_at * steps + late) if j >= late else 0.0 for j in (k, k + 1))
        then = now if k + 1 == late or k + 1 == load_at * steps + late else then  # a jump belongs to the next step
        slope = (now - y[k]) / T
        y[k + 1] = y[k] + h / 2 * (slope + (then - y[k] - h * slope) / T)
    u[-1] = controller(1 - y[-1], remember, h)
    every = round(steps * (times[1] - times[0]))
    return y[::every], u[::every]


@pytest.mark.parametrize(("Kp", "Ti"), [(1.25, 10), (2, 4), (0.5, 30)])
def test_the_pi_lesson_shows_a_dead_time_and_no_approximation_of_it(Kp, Ti):
    def controller(e, memory, h):
        memory[0] += h * e
        return Kp * (e + (memory[0] - h * e / 2) / Ti)

    answer = pi.respond(sympy.Rational(str(Kp)), Ti)
    for name, expected in zip("yu", by_small_steps(pi.T, pi.DELAY, controller, pi.TIMES, pi.LOAD_AT), strict=True):
        assert answer.signals[name] == pytest.approx(expected, abs=0.01)
    assert (answer.signals["y"][pi.TIMES < pi.DELAY] == 0).all()


def test_the_pi_lesson_knows_the_limit_of_stability():
    limit = stability.boundary_pi(first_order(pi.K, pi.T, pi.DELAY), 10)
    verdicts = [pi.respond(limit * share, 10).verdict for share in (0.98, 1.02)]
    assert verdicts == ["Stable, with little to spare", "Unstable"]


@pytest.mark.parametrize("delay", [1, 4])
def test_the_good_gain_by_hand_is_that_of_the_library(delay):
    found = good_gain_experiment(good_gain.process_with(delay))
    answer = good_gain.respond(sympy.Rational(found.KpGG), delay)
    assert answer.verdict.startswith("Barely observable")
    assert answer.results["undershoot"] == "5.0\u202f%"
    assert float(answer.results[good_gain.KP]) == pytest.approx(0.8 * found.KpGG, rel=0.01)
    (_, top, *_), (_, bottom, *_) = answer.marks
    assert bottom - top == pytest.approx(found.Tou, rel=0.02)


def test_without_an_undershoot_there_is_no_pi_controller():
    answer = good_gain.respond(sympy.Rational(2, 5), 0)
    assert answer.verdict == "No undershoot: more gain"
    assert "PI" not in answer.signals
    assert not answer.marks


@pytest.mark.parametrize("ratio", [sympy.Rational(1, 5), sympy.Rational(1, 2), sympy.Rational(4, 5)])
def test_half_is_the_share_of_the_half_rule(ratio):
    model = approximation.half_rule(half_rule.process_of(ratio, 2))
    shared = half_rule.shared_model(ratio, 2, sympy.Rational(1, 2))
    assert (shared.T1, shared.delay) == (model.T1, model.delay)
    # the process by its partial fractions
    lags = [float(T) for T in half_rule.lags_of(ratio)]
    y = 1.0
    for T in lags:
        share = (1 + 2 / T) * T**3 / np.prod([T - other for other in lags if other != T])
        y = y - share * np.exp(-half_rule.TIMES / T)
    assert half_rule.of_process(ratio, 2)[0] == pytest.approx(y, abs=1e-9)


@pytest.mark.parametrize(("delay", "gain", "Tc"), [(1, 1, 2), ("1.2", "0.8", 1), (0, "1.5", "0.5")])
def test_the_short_formula_of_the_predictor_is_the_predictor(delay, gain, Tc):
    delay, gain, Tc = map(sympy.Rational, (delay, gain, Tc))
    model = first_order(smith.K * gain, smith.T)
    inner = PID(smith.T / (smith.K * gain * Tc), Ti=smith.T).expr
    controller = closed_loop(inner, model - model * sympy.exp(-smith.DELAY * delay * s))
    loop = Loop(first_order(smith.K, smith.T, smith.DELAY), controller)
    servo, regulator = smith.predictor(delay, gain, Tc)
    omega = np.logspace(-2, 1, 40)
    assert servo.frequency(omega) == pytest.approx(loop.servo.frequency(omega), rel=1e-9)
    assert regulator.frequency(omega) == pytest.approx(loop.regulator.frequency(omega), rel=1e-9)
    assert servo.is_stable == stability.is_closed_loop_stable(loop.open)


def test_with_the_right_model_the_predictor_does_what_was_wanted():
    answer = smith.respond(sympy.Rational(1), sympy.Rational(1), sympy.Rational(2))
    before = smith.TIMES < smith.LOAD_AT
    wanted = System(sympy.exp(-smith.DELAY * s) / (2 * s + 1)).step(smith.TIMES)
    assert answer.signals["smith"][before] == pytest.approx(wanted[before], abs=1e-9)


@pytest.mark.parametrize(("cold", "limit"), [(2, 80), (30, 100)])
def test_the_heater_that_winds_up_obeys_its_balance(cold, limit):
    answer = windup.respond(cold, limit)
    at = np.searchsorted(windup.TIMES, windup.END / 60) - 1
    per_percent = (windup.SETPOINT - windup.WARM) / windup.NOMINAL
    balance = min(windup.SETPOINT, cold + limit * per_percent)
    for way in ("with", "without"):
        assert answer.signals[f"T {way}"][at] == pytest.approx(balance, abs=0.3)
        assert max(answer.signals[f"u {way}"]) <= limit
    assert answer.verdict == ("The heater is at its limit" if balance < windup.SETPOINT else "The heater can do it")


def test_anti_windup_brings_the_temperature_back_sooner():
    times = [windup.back_after(*windup.run_with(10, 100, halt)[:2]) for halt in (False, True)]
    assert times[0] > 3 * times[1]


def test_the_cascade_ends_where_the_balances_of_its_plant_say():
    tank, run = cascade.TANK, cascade.run_with("colder heating liquid", 1)
    T_h = tank.T_p + tank.c_p * tank.F_p * (tank.T_p - tank.T_pin) / tank.U_hp
    F_h = (tank.U_hp * (T_h - tank.T_p) - tank.U_eh * (tank.T_e - T_h)) / (tank.c_h * (55 - T_h))
    assert run["T_p"][-1] == pytest.approx(float(tank.T_p), abs=0.02)
    assert run["F_h"][-1] == pytest.approx(float(F_h), rel=0.01)


def test_the_settings_of_the_cascade_are_those_of_chapter_11():
    sensor = 1 / (5 * s + 1)
    jacket, tank = (cascade.TANK.numbers(cascade.TANK.transfer_function("F_h", *to)) * sensor for to in (("T_hm",), ()))
    found = tuning.simc(approximation.half_rule(jacket))
    assert [f"{float(x):.3g}" for x in (found.Kp, found.Ti)] == ["0.301", "48.6"]
    assert PID(0.301, Ti=48.6) == cascade.SECONDARY
    assert 1.5 < stability.margins(tank * cascade.SINGLE.expr).Ms <= 1.7


# ------------------------------------------------------------------------------------------------ shapes and words


def test_a_line_is_written_with_few_letters_and_read_again():
    x = np.linspace(0, 1, 301)
    y = 0.5 + 0.4 * np.exp(-3 * x) * np.cos(20 * x)
    text = shapes.encoded([np.column_stack([x, y])])
    assert len(text) < 150
    (read,) = shapes.decoded(text)
    read = np.array(read) / (shapes.WIDE, shapes.TALL)
    assert read[[0, -1], 0].tolist() == [0, 1]
    assert np.interp(x, read[:, 0], 1 - read[:, 1]) == pytest.approx(y, abs=4 / shapes.TALL)


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
    assert max(sizes.values()) < 160_000
    assert sum(sizes.values()) < 4_000_000


def test_a_slider_becomes_coarser_about_its_start():
    knob = recording.Knob("K", "gain", "", tuple(range(20)), 7)
    other = recording.Knob("kind", "kind", "", ("a", "b"), "b", words=True)
    thin, same = recording.thinned([knob, other], 16)
    assert thin.values == (0, 1, 4, 7, 10, 13, 16, 19)
    assert same == other


def test_every_lesson_has_a_title_and_asks_for_something():
    """A recorded one by the text above its cell."""
    told = [lessons.load(name) for name in lessons.names()]
    assert len({lesson.title for lesson in told}) == len(told)
    assert all(lessons.load(name).about and 1 <= len(lessons.load(name).questions) <= 3 for name in lessons.PLACES)
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
        section = next(k for k, cell in enumerate(cells) if any(level == 2 for level, _ in places.headings(cell)))
        opens = any(lessons.of_cell(path.stem, cell.source) for cell in cells[:section] if cell.cell_type == "code")
        assert opens or path.stem == "00_start", path.stem


# ------------------------------------------------------------------------------------------------ the data


def counting_lesson(**changes):
    """A lesson whose one curve and result say which values the sliders have."""
    sliders = lesson.Slider("a", "A", (0, 1, 2), 1), lesson.Slider("b", "B", (0, 1), 0, words=("no", "yes"))
    whole = lesson.Lesson(
        title="Counting", about="", questions=(), sliders=sliders, panels=(lesson.Panel("y", 0, 4),),
        curves=(lesson.Curve("y", "y"), lesson.Curve("none", "none")), times=np.linspace(0, 1, 5),
        respond=lambda a, b: lesson.Answer(f"{a} {b}", {"a": str(a)}, {"y": np.full(5, a)}),
    )  # fmt: skip
    return dataclasses.replace(whole, **changes)


def test_each_position_of_the_sliders_has_its_answer_and_equal_curves_are_kept_once():
    data = counting_lesson().data()
    assert data["counts"] == [3, 2]
    assert [moving.view(data, k).verdict for k in range(6)] == ["0 0", "0 1", "1 0", "1 1", "2 0", "2 1"]
    curve, none = data["items"]
    assert curve["line"] == [0, 0, 1, 1, 2, 2]
    assert none["line"] == -1
    assert shapes.decoded(moving.view(data, 4).shapes[0]) == [[(0, shapes.TALL / 2), (shapes.WIDE, shapes.TALL / 2)]]
    assert moving.view(data).verdict == "1 0"


def test_a_lesson_that_is_too_large_is_refused(monkeypatch):
    monkeypatch.setattr(lesson, "LARGEST", 100)
    with pytest.raises(ValueError, match=r"'Counting' takes [0-9]+ characters: expected 100 at most"):
        counting_lesson().data()


def test_a_slider_cannot_start_between_its_values():
    with pytest.raises(ValueError, match="cannot start at 3"):
        lesson.Slider("a", "A", (1, 2), 3)


def test_an_unknown_lesson_is_refused_by_name():
    with pytest.raises(ValueError, match="there is no lesson 'bode': expected one of pi, good_gain"):
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


@pytest.mark.parametrize("name", lessons.names())
def test_every_input_has_a_label_and_every_picture_a_description(name):
    record = at_the_start(name).record() if name in lessons.PLACES else lessons.load(name).record()
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


@pytest.mark.parametrize("name", lessons.names())
def test_without_a_script_the_lesson_is_seen_at_its_start(name):
    record = at_the_start(name).record() if name in lessons.PLACES else lessons.load(name).record()
    seen = moving.view(record["data"])
    page = Elements(desk.desk(name, record))
    drawn = [path["d"] for path in page.all("path") if "data-item" in path]
    pairs = sorted(zip(record["data"]["items"], seen.shapes, strict=True), key=lambda pair: pair[0]["panel"])
    assert [bool(d) for d in drawn] == [bool(shape) for _, shape in pairs]
    assert any(drawn) or seen.image


def test_every_lesson_of_the_folder_has_its_place():
    files = (ROOT / "docs" / "lessons").glob("*.py")
    assert {file.stem for file in files if "\nLESSON = " in file.read_text(encoding="utf-8")} == set(lessons.PLACES)


@pytest.mark.parametrize("name", lessons.PLACES)
def test_the_lessons_stand_at_the_end_of_their_sections(name):
    chapter, section = lessons.PLACES[name]
    cells = nbformat.read(ROOT / "chapters" / f"{chapter}.ipynb", as_version=4).cells
    cells = places.with_lessons(cells, chapter)
    at = next(number for number, cell in enumerate(cells) if cell.get("id") == f"lesson-{name}")
    assert re.search(r"^```\{lesson\} " + name, cells[at].source, re.MULTILINE)
    above = [(level, text) for cell in cells[:at] for level, text in places.headings(cell)]
    ((own, _),) = places.headings(cells[at])
    around = next(text for level, text in reversed(above) if level < own)
    assert around.startswith(section)
    assert places.headings(cells[at + 1])[0][0] < own


def test_the_page_reads_shapes_as_they_are_written():
    script = (ROOT / "docs" / "_static" / "lessons.js").read_text(encoding="utf-8")
    constants = {name: int(number) for name, number in re.findall(r"const ([A-Z]+) = (\d+);", script)}
    assert constants == {"WIDE": shapes.WIDE, "TALL": shapes.TALL, "NEAR": shapes.NEAR}
    assert "http" not in script
