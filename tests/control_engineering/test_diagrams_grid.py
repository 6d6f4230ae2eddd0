"""Diagrams on a grid: what each name becomes, how the wires run, and that nothing lies on anything else."""

import functools
import itertools

import pytest
import sympy

from loopbook.diagrams import block, feedback_loop, gain, grid_diagram, integrator, switch
from pictures import assert_orthogonal, assert_tidy, measured, signs_near, smallest_print, tip, within
from plainmath.expressions import s

EXAMPLES = {
    "Figure 2.6": lambda: grid_diagram(
        """
        .  .  F  f  f  f  a  v  1  x  2  y
        .  3  .  f  f  f  .  .  .  .  .  .
        4  .  .  f  f  f  .  .  .  .  .  .
        .  .  .  m  D  K  .  .  .  .  .  .
        .  5  .  .  .  .  .  .  6  .  .  .
        7  .  .  .  .  .  .  .  .  .  8  .""",
        "F f a v 1 x 2 y, m f, D f, K f, 1 6 5 3 f, 2 8 7 4 f",
        {"f": r"\frac{1}{m}(F - D\dot{y} - Ky)", "v": integrator(r"\dot{y}(0)"), "x": integrator("y(0)")},
        {"a": r"\ddot{y}"},
    ),
    "Figure 7.1": lambda: grid_diagram(
        """
        .     .    .    .     .       .     .    .    d  .  .
        y_SP  f_4  sum  e     PID     auto  u    f_5  P  1  y
        .     .    .    .     u_0     auto  .    .    .  .  .
        .     .    2    y_mf  Filter  f_2   y_s  f_1  .  3  .""",
        "y_SP f_4 sum e PID auto u f_5 P 1 y, u_0 auto, d P\n1 3 f_1 y_s f_2 Filter y_mf 2 - sum",
        {name: name for name in ("f_1", "f_2", "f_4", "f_5", "PID", "Filter")} | {"auto": switch(), "P": "Process"},
    ),
    "Figure 8.1": lambda: grid_diagram(
        """
        .     .  .  F_fSP   f  F_fd  .       1    .  d
        .     .  .  .       .  .     .       P_d  .  .
        y_SP  2  e  F_c     s  u     P_u     sum  3  y
        .     .  4  Filter  .  y_m   Sensor  .    5  .""",
        "y_SP 2 e F_c s u P_u sum 3 y, 2 F_fSP f s, d 1 F_fd f, 1 P_d sum, 3 5 Sensor y_m Filter 4 - e",
        {name: name for name in ("F_fSP", "F_fd", "F_c", "P_u", "P_d", "Sensor", "Filter")},
    ),
    "Figure 11.1": lambda: grid_diagram(
        """
        .     .    .    .    .    .    .    d    .  .    .    .  .
        y_SP  e_1  C_1  u_1  e_2  C_2  u_2  P_2  1  y_2  P_1  2  y_1
        .     .    .    .    3    S_2  .    .    4  .    .    .  .
        .     5    .    .    .    S_1  .    .    .  .    .    6  .""",
        "y_SP e_1 C_1 u_1 e_2 C_2 u_2 P_2 1 y_2 P_1 2 y_1, d P_2, 1 4 S_2 3 - e_2, 2 6 S_1 5 - e_1",
        {name: name for name in ("P_1", "P_2", "S_1", "S_2")}
        | {"C_1": "Primary\ncontroller", "C_2": "Secondary\ncontroller"},
    ),
}

EXAMPLES = {name: functools.cache(make) for name, make in EXAMPLES.items()}


def on_rim(x, y, boxes, circles):
    """Whether the point is on a side of a box or on a circle."""
    for box in boxes:
        across, up = box.x0 - 1e-6 <= x <= box.x1 + 1e-6, box.y0 - 1e-6 <= y <= box.y1 + 1e-6
        if across and up and min(abs(x - box.x0), abs(x - box.x1), abs(y - box.y0), abs(y - box.y1)) < 1e-6:
            return True
    return any(abs(((x - c.center[0]) ** 2 + (y - c.center[1]) ** 2) ** 0.5 - c.radius) < 1e-6 for c in circles)


@pytest.mark.parametrize("name", EXAMPLES)
def test_blocks_and_labels_do_not_overlap_and_wires_cross_no_block(name):
    picture = EXAMPLES[name]()
    assert_tidy(picture)
    texts, boxes, *_ = measured(picture)
    assert not any(one.overlaps(other) for one, other in itertools.combinations(boxes, 2))
    for label, extent in texts:
        assert all(within(extent, box) for box in boxes if box.overlaps(extent)), label
    switch_of_it = [max(boxes, key=lambda box: box.height)] if name == "Figure 7.1" else []
    assert_orthogonal(picture, switch_of_it)
    assert smallest_print(picture) > 7


@pytest.mark.parametrize("name", EXAMPLES)
def test_every_arrow_ends_at_a_block_a_junction_or_an_output(name):
    picture = EXAMPLES[name]()
    _, boxes, circles, heads, _ = measured(picture)
    _, right = picture.figure.axes[0].get_xlim()
    outputs = [head for head in heads if not on_rim(*tip(head), boxes, circles)]
    assert len(outputs) == 1
    assert outputs[0][:, 0].max() == pytest.approx(right - 0.1, abs=0.02)


def test_each_name_becomes_what_its_paths_make_of_it():
    texts, boxes, circles, heads, _ = measured(EXAMPLES["Figure 8.1"]())
    labels = [text for text, _ in texts]
    assert all(labels.count(name) == 1 for name in ("$y_{SP}$", "$d$", "$u$", "$F_{fSP}$"))
    assert not {"$1$", "$e$", "$sum$"} & set(labels)
    assert len(boxes) == 7
    assert len([circle for circle in circles if circle.radius > 0.1]) == 4  # e, f, s, sum
    assert len([circle for circle in circles if circle.radius < 0.1]) == 3  # 1, 2, 3
    assert len(heads) == 16


def test_signs_stand_at_the_paths_they_are_written_for():
    layout = """
        .  d  .
        u  j  y
        .  w  ."""
    texts, _, (junction,), _, _ = measured(grid_diagram(layout, "u j y, d - j, w j"))
    assert signs_near(texts, *junction.center) == [("-", "above"), ("+", "below"), ("+", "left")]


def test_a_single_path_with_a_sign_enters_a_junction():
    _, _, circles, _, _ = measured(grid_diagram("u j y", "u - j y"))
    assert [circle.radius for circle in circles] == [0.22]


def test_a_large_block_takes_up_its_places_and_is_entered_on_a_level():
    _, boxes, _, heads, wires = measured(grid_diagram("a B\n c B\n . x", "a B, c B, x B", {"B": "f"}))
    (box,) = boxes
    tips = sorted(tip(head) for head in heads)
    assert tips[0][0] == tips[1][0] == pytest.approx(box.x0)
    assert tips[2][1] == pytest.approx(box.y0)
    assert all(wire[0][1] == wire[-1][1] or wire[0][0] == wire[-1][0] for wire in wires)


def test_the_description_follows_the_paths():
    picture = grid_diagram("u P 1 y\n . 2 3 .", "u P 1 y, 1 3 2 P", {"P": 1 / (s + 1)}, title="Figure 8.1")
    assert picture.alt == "Figure 8.1: block diagram: u → [1/(s + 1)] → point 1 → y; point 1 → [1/(s + 1)]"


def test_the_blocks_handed_in_stay_as_they_are():
    part = block("f")
    before = dict(vars(part))
    grid_diagram("a B\n b B", "a B, b B", {"B": part})
    assert vars(part) == before


@pytest.mark.parametrize(
    ("make", "message"),
    [
        (lambda: grid_diagram("", "a b"), "the layout is empty"),
        (lambda: grid_diagram("a b\n c", "a b"), "row 2 of the layout has 1 places, but row 1 has 2"),
        (lambda: grid_diagram("a b a", "a b"), "a must fill a rectangle of the layout"),
        (lambda: grid_diagram("a b", "a c"), "c is not in the layout, which has a, b"),
        (lambda: grid_diagram("a b", "a b", {"P": "Process"}), "P is not in the layout"),
        (lambda: grid_diagram("a b", "a b, b"), "a path meets two names or more, not only b"),
        (lambda: grid_diagram("a P b", "a b", {"P": gain("K")}), "the way from a to b runs through P"),
        (lambda: grid_diagram("a P", "a P", {"P": feedback_loop(sympy.Symbol("H"))}), "a grid takes single blocks"),
        (lambda: grid_diagram("a P", "a P", {"P": None}), "None is not a part of a block diagram"),
    ],
)
def test_bad_input_is_told_in_one_sentence(make, message):
    with pytest.raises(ValueError, match=message):
        make()
