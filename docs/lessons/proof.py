"""Whether a recorded lesson is still what its cell shows: by the cell's code, and by positions computed anew."""

import itertools
import random

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
        if (far := shapes.apart(shapes.decoded(one), shapes.decoded(other))) > NEAR:
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
