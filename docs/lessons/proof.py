"""Whether a recorded lesson is still what its cell shows: by the cell's code, and by positions computed anew."""

import itertools
import random

import numpy as np

from lessons import moving, shapes
from lessons.recording import answer_of, captured, code_of, needed, place_of

NEAR = 2.5  # pixels between a line and the recorded one: what simplifying and rounding may make of it


def is_stale(lesson):
    """Whether the code that a lesson's cell needs has changed since it was recorded."""
    return code_of(*place_of(lesson.chapter, lesson.function)) != lesson.record()["code"]


def difference(lesson, seed, positions=2):
    """Compute some positions of a lesson anew, and return what is different, as words; an empty text for nothing.

    Arguments:
        lesson: a recorded one.
        seed: of the choice of positions; the start is always among them.
        positions: how many there are besides.
    """
    record = lesson.record()
    data, sliders = record["data"], record["sliders"]
    call, _ = captured(needed(*place_of(lesson.chapter, lesson.function)))
    grid = list(itertools.product(*(range(count) for count in data["counts"])))
    chosen = {moving.first(data), *random.Random(seed).sample(range(len(grid)), min(positions, len(grid)))}
    for number in sorted(chosen):
        values = {slider["name"]: slider["values"][k] for slider, k in zip(sliders, grid[number], strict=True)}
        if found := one_difference(data, number, answer_of(call, values)):
            return f"at {', '.join(f'{name} = {value}' for name, value in values.items())} {found}"
    return ""


def one_difference(data, number, answer):
    """What is different between a recorded answer and a fresh one, as words."""
    fresh = moving.told([answer], [1], [0])
    seen, now = moving.view(data, number), moving.view(fresh)
    if told(data, seen) != told(fresh, now):
        return "the results differ"
    title = answer[0] or (answer[2].panels[0].title if answer[2].panels else "")
    if seen.verdict and seen.verdict != title:
        return f"it says {title!r}, and recorded is {seen.verdict!r}"
    if numbers(seen) != numbers(now):
        return "the axes differ"
    if [word[-1] for word in seen.words] != [word[-1] for word in now.words]:
        return "the words differ"
    if seen.image != now.image:
        return "the picture differs"
    there = {key_of(item): line for item, line in zip(data["items"], seen.shapes, strict=True) if line}
    here = {key_of(item): line for item, line in zip(fresh["items"], now.shapes, strict=True) if line}
    if there.keys() != here.keys():
        return f"there are {len(here)} lines and areas, and recorded are {len(there)}"
    pairs = zip(sorted(there.items()), sorted(here.items()), strict=True)
    for (_, one), (key, other) in pairs:
        if (far := apart(one, other)) > NEAR:
            return f"{key[2] or key[1]} is {far:.1f} pixels from where it was"
    return ""


def told(data, seen):
    """The results that there are."""
    return {label: text for label, text in zip(data["labels"], seen.results, strict=True) if text != "–"}


def numbers(seen):
    """The texts on the axes."""
    return [[text for _, text in axis] for panel in seen.axes for axis in panel]


def key_of(item):
    """What an item is recognised by."""
    return item["panel"], item["kind"], item["label"], item["light"], str(item.get("dash"))


def apart(one, other):
    """The largest distance of two shapes, in pixels: of the corners of each from the lines of the other."""
    return max(distance(one, other), distance(other, one))


def distance(corners, line):
    """The largest distance of the corners of a shape from the lines of another one."""
    points = np.array([point for piece in shapes.decoded(corners) for point in piece]) * shapes.STEP
    nearest = np.full(len(points), np.inf)
    for piece in shapes.decoded(line):
        ends = np.array(piece) * shapes.STEP
        starts, ways = ends[:-1] if len(ends) > 1 else ends, np.diff(ends, axis=0) if len(ends) > 1 else 0 * ends
        for start, way in zip(starts, ways, strict=True):
            length = way @ way
            share = np.clip((points - start) @ way / length, 0, 1) if length else np.zeros(len(points))
            nearest = np.minimum(nearest, np.hypot(*(points - start - share[:, None] * way).T))
    return float(nearest.max())
