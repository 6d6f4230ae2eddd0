"""The symbols of plants: each keeps to its room, differs from all others, and can stand anywhere in a diagram."""

import copy
import itertools
from functools import partial

import numpy as np
import pytest
from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.patches import Circle, Polygon

from draws import of_the_day
from loopbook.diagrams import (
    ACTUATORS,
    COMPRESSORS,
    CONDUCTORS,
    DEVICES,
    EXCHANGERS,
    FANS,
    HEATERS,
    PLACES,
    PUMPS,
    ROOFS,
    SIGNALS,
    VALVES,
    compressor,
    conductor,
    control_valve,
    conveyor,
    cyclone,
    fan,
    feed_screw,
    heat_exchanger,
    heater,
    instrument,
    instrumentation_diagram,
    motor,
    pump,
    silo,
    symbol_table,
    tank,
    turbine,
    valve,
    vessel,
)
from loopbook.diagrams.drawing import Drawing
from loopbook.diagrams.valves import BODIES
from pictures import crossed_texts, misplaced_texts, overlapping_texts, smallest_print, written

TAGGED = {
    **{f"valve {kind}": partial(valve, kind=kind) for kind in VALVES},
    **{f"control valve {way}": partial(control_valve, actuator=way) for way in ACTUATORS},
    **{f"control valve {kind}": partial(control_valve, kind=kind) for kind in BODIES[1:]},
    **{f"pump {kind}": partial(pump, kind=kind) for kind in PUMPS},
    **{f"fan {kind}": partial(fan, kind=kind) for kind in FANS},
    **{f"compressor {kind}": partial(compressor, kind=kind) for kind in COMPRESSORS},
    **{f"exchanger {kind}": partial(heat_exchanger, kind=kind) for kind in EXCHANGERS},
    **{f"heater {kind}": partial(heater, kind=kind) for kind in HEATERS},
    **{make.__name__: make for make in (turbine, feed_screw, conveyor, cyclone, silo)},
}
BARE = {
    "motor": motor,
    "generator": lambda: motor("G"),
    **{f"tank {roof}": lambda roof=roof: tank(roof=roof) for roof in ROOFS},
    "tank stirred": lambda: tank("V", stirrer=True),
    "tank heated": lambda: tank("T", stirrer=True, heater=True),
    "tank jacketed": lambda: tank(level="h", jacket=True),
    "vessel": lambda: vessel("V1"),
    "drum": lambda: vessel("D1", lying=True),
    "separator": lambda: vessel(filled=0.5, lying=True),
    "tray column": lambda: vessel("A1", trays=6),
    "packed column": lambda: vessel("A1", packings=2),
    "reactor": lambda: vessel("R1", stirrer=True, filled=0.6),
    "jacketed reactor": lambda: vessel("R1", stirrer=True, jacket=True, filled=0.6),
    "vessel with coil": lambda: vessel("R1", coil=True, filled=0.7),
    "reactor with coil": lambda: vessel(stirrer=True, coil=True, filled=0.7),
    **{
        f"instrument {device} {place}": lambda device=device, place=place: instrument("FC123", place, device)
        for device in DEVICES
        for place in PLACES
    },
}
SYMBOLS = {name: partial(make, "FV123") for name, make in TAGGED.items()} | BARE
WAYS = {"right": (1, 0), "left": (-1, 0), "up": (0, 1), "down": (0, -1)}
LAYOUTS = {"right": "a x b", "left": "b x a", "up": "b\n x\n a", "down": "a\n x\n b"}


def extent(picture, *, of_texts):
    """Left, right, bottom and top of all that is drawn, in drawing units."""
    FigureCanvasAgg(picture.figure)
    picture.figure.draw_without_rendering()
    (axes,) = picture.figure.axes
    to_units = axes.transData.inverted()
    boxes = [patch.get_window_extent().transformed(to_units) for patch in axes.patches]
    if of_texts:
        boxes += [text.get_window_extent().transformed(to_units) for text in axes.texts]
    corners = [box.get_points() for box in boxes] + [line.get_xydata() for line in axes.lines]
    points = np.concatenate(corners)
    return points[:, 0].min(), points[:, 0].max(), points[:, 1].min(), points[:, 1].max()


def drawn_alone(symbol, way, taps=()):
    """A symbol around the origin with a flow that goes its way, and the sizes of its box with its room."""
    (dx, dy), node = way, copy.copy(symbol)
    node.met(((-dx, -dy), (dx, dy)), taps, way)
    node.levels = [0.0]
    node.place(0.0, 0.0, node.width, node.height)
    drawing = Drawing()
    node.draw(drawing)
    return drawing.picture(None, ""), node.width + node.room[0], node.height + node.room[1]


def assert_it_keeps_to_its_room(symbol, way, taps=()):
    picture, width, height = drawn_alone(symbol, way, taps)
    left, right, bottom, top = extent(picture, of_texts=True)
    assert -width / 2 <= left <= right <= width / 2
    assert -height / 2 <= bottom <= top <= height / 2


def each_way(symbols):
    """Each symbol with one of the ways of a flow, another one each day; in a thorough run with all."""
    return [(name, way) for name in symbols for way in of_the_day([*WAYS], 1, name)]


def test_a_symbol_with_its_tag_keeps_to_its_room(subtests):
    for name, way in each_way(SYMBOLS):
        with subtests.test(name, way=way):
            assert_it_keeps_to_its_room(SYMBOLS[name](), WAYS[way])


def test_a_valve_keeps_to_its_room_wherever_its_signal_comes_from(subtests):
    for name, way in each_way([name for name in TAGGED if "valve" in name]):
        with subtests.test(name, way=way):
            for tap in WAYS.values():
                if (tap[0] == 0) != (WAYS[way][0] == 0):  # across the flow
                    assert_it_keeps_to_its_room(SYMBOLS[name](), WAYS[way], (tap,))


def test_a_symbol_can_stand_in_a_diagram_in_each_direction(subtests):
    for name, way in of_the_day(each_way(SYMBOLS), 15):
        with subtests.test(name, way=way):
            axis = int(way in ("up", "down"))
            picture = instrumentation_diagram(LAYOUTS[way], "a x b", equipment={"x": SYMBOLS[name]()})
            assert misplaced_texts(picture) == []
            pipes = [line.get_xydata() for line in picture.figure.axes[0].lines if line.get_linewidth() == 1.7]
            along = [pipe for pipe in pipes if len(pipe) == 2 and abs(pipe[1, axis] - pipe[0, axis]) > 0.1]
            assert along, "no pipe"


def shape(picture):
    """What is drawn, as numbers and words."""
    axes = picture.figure.axes[0]
    lines = [(line.get_linestyle(), np.round(line.get_xydata(), 3).tolist()) for line in axes.lines]
    circles = [(p.radius, p.get_facecolor(), *p.center) for p in axes.patches if isinstance(p, Circle)]
    areas = [(p.get_facecolor(), np.round(p.get_xy(), 3).tolist()) for p in axes.patches if isinstance(p, Polygon)]
    return str((sorted(map(str, lines)), sorted(map(str, circles)), sorted(map(str, areas)))), len(axes.texts)


def test_every_symbol_differs_from_every_other_one():
    plain = {name: make() for name, make in (BARE | TAGGED).items()}
    plain |= {f"conductor {kind}": conductor(kind) for kind in CONDUCTORS}
    del plain["generator"]  # differs from a motor by its letter
    shapes = {name: shape(symbol_table({"x": symbol})) for name, symbol in plain.items()}
    for (one, here), (other, there) in itertools.combinations(shapes.items(), 2):
        assert here != there, f"{one} looks like {other}"
    words = [repr(symbol) for name, symbol in plain.items() if "instrument" not in name]
    assert len(set(words)) == len(words)


@pytest.mark.parametrize(
    "symbol",
    [*(tank(roof=roof, jacket=True) for roof in ROOFS), vessel(), vessel(jacket=True, filled=0.5), vessel(packings=2)],
    ids=repr,
)
def test_an_upright_container_is_its_own_mirror_image(symbol):
    picture, *_ = drawn_alone(symbol, WAYS["right"])
    points = {(x, y) for line in picture.figure.axes[0].lines for x, y in np.round(line.get_xydata(), 3)}
    assert points == {(-x, y) for x, y in points}


@pytest.mark.parametrize("kind", [kind for kind in SIGNALS if kind != "electrical"])
@pytest.mark.parametrize("layout", ["LC b", "b LC", "LC\n b", "b\n LC", "LC 1\n . b"])
@pytest.mark.daily(12)
def test_each_kind_of_line_leads_wherever_a_signal_can_lead(kind, layout):
    path = "LC 1 b" if "1" in layout else "LC b"
    electrical = instrumentation_diagram(layout, "", path)
    picture = instrumentation_diagram(layout, lines={kind: path})
    assert shape(picture) != shape(electrical)
    assert crossed_texts(picture) == []
    assert picture.alt == f"P&I diagram: {kind}: LC → b"
    heads = [p for p in picture.figure.axes[0].patches if isinstance(p, Polygon) and len(p.get_xy()) == 4]
    assert len(heads) == (kind != "measuring line")


@pytest.mark.parametrize("way", WAYS)
@pytest.mark.parametrize(("make", "narrows"), [(compressor, True), (turbine, False)])
def test_a_compressor_narrows_and_a_turbine_widens_with_the_flow(make, narrows, way):
    picture, *_ = drawn_alone(make(), WAYS[way])
    (area,) = [p.get_xy()[:4] for p in picture.figure.axes[0].patches if isinstance(p, Polygon)]
    along, across = area @ np.array(WAYS[way]), area @ np.array(WAYS[way][::-1])
    ahead, back = (np.ptp(across[np.sign(along) == side]) for side in (1, -1))
    assert (ahead < back) == narrows


def test_a_three_way_valve_opens_where_its_pipes_come_from():
    layout = "a V b\n . c ."
    for pipes, parts in (("a V b, V c", 3), ("c V b, a V", 3)):
        picture = instrumentation_diagram(layout, pipes, equipment={"V": valve("V1", kind="three-way")})
        triangles = [p.get_xy()[:3] for p in picture.figure.axes[0].patches if p.get_facecolor() == (1, 1, 1, 1)]
        ends = {tuple(np.round(points[1:].mean(axis=0) - points[0], 2)) for points in triangles}
        assert ends == {(-0.42, 0), (0.42, 0), (0, -0.42)}
        assert len(triangles) == parts
        assert crossed_texts(picture) == []


@pytest.mark.parametrize("make", [valve, control_valve, lambda tag: valve(tag, kind="angle")])
def test_a_valve_turns_with_its_pipes(make):
    picture = instrumentation_diagram("a V\n . c", "a V c", equipment={"V": make("V1")})
    assert crossed_texts(picture) == []
    triangles = [p.get_xy()[:3] for p in picture.figure.axes[0].patches if p.get_facecolor() == (1, 1, 1, 1)]
    triangles = [points for points in triangles if np.allclose(points[0], triangles[-1][0])]
    assert {tuple(np.round(p[1:].mean(axis=0) - p[0], 2)) for p in triangles} == {(-0.42, 0), (0, -0.42)}


def test_a_tag_stands_where_no_pipe_and_no_signal_is():
    part = {"P": pump("P1")}
    for layout, pipes, signals in (
        ("a P b", "a P b", ""),
        ("a\n P\n b", "a P b", ""),
        (". LC .\n a P b\n . c .", "a P b, P c", "LC P"),
    ):
        picture = instrumentation_diagram(layout, pipes, signals, part)
        assert overlapping_texts(picture) == crossed_texts(picture) == []
        assert "P1" in [text for text, _ in written(picture)]


@pytest.mark.parametrize("make", [lambda: tank(stirrer=True), lambda: vessel(stirrer=True, filled=0.5)])
def test_a_stirrer_gives_way_to_a_pipe_from_above(make):
    picture = instrumentation_diagram("a\n x\n b", "a x b", equipment={"x": make()})
    upright = [line.get_xydata() for line in picture.figure.axes[0].lines if len(line.get_xydata()) == 2]
    places = sorted(points[0, 0] for points in upright if points[0, 0] == points[1, 0])
    assert places[-1] - places[0] > 0.3


def test_what_is_written_over_something_is_found():
    picture = instrumentation_diagram("a LT\n b c", "a LT", names={"a": "long name"})
    (axes,) = picture.figure.axes
    x, y = next(text.get_position() for text in axes.texts if text.get_text() == "long name")
    assert overlapping_texts(picture) == crossed_texts(picture) == []
    axes.text(x - 0.3, y, "another one", ha="right")
    assert overlapping_texts(picture) == [("long name", "another one")]
    axes.plot([x + 0.3, x + 0.5], [y - 0.5, y + 1])
    assert crossed_texts(picture) == ["long name"]


def test_a_table_has_each_symbol_over_its_name():
    names = ["a ball valve", "a valve that holds back the pressure of a whole plant", "pump", "tank", "x" * 12]
    symbols = dict(zip(names, (valve(kind="ball"), valve(kind="safety"), pump("P1"), tank(), motor()), strict=True))
    for columns in (1, 2, 3, 7):
        picture = symbol_table(symbols, title="Figure A.3", columns=columns)
        assert overlapping_texts(picture) == crossed_texts(picture) == []
        assert picture.figure.get_size_inches()[0] <= 7 + 1e-9
        assert smallest_print(picture) > 5.5
    assert picture.alt == f"Figure A.3: symbols: {', '.join(names)}"


@pytest.mark.parametrize(
    ("make", "message"),
    [
        (lambda: valve(kind="bal"), "the valve is 'bal': expected one of general, gate"),
        (lambda: control_valve(actuator="air"), "the actuator is 'air': expected one of diaphragm, piston"),
        (lambda: control_valve(kind="check"), "the control valve is 'check'"),
        (lambda: pump(kind="turbo"), "the pump is 'turbo': expected one of general, centrifugal"),
        (lambda: fan(kind=""), "the fan is ''"),
        (lambda: compressor(kind="gear"), "the compressor is 'gear'"),
        (lambda: heat_exchanger(kind="tube"), "the heat exchanger is 'tube'"),
        (lambda: heater(kind="gas"), "the heater is 'gas'"),
        (lambda: tank(roof="lid"), "the roof is 'lid'"),
        (lambda: conductor("wire"), "the conductor is 'wire'"),
        (lambda: instrument("FC1", "room"), "the place is 'room': expected one of field, panel"),
        (lambda: instrument("FC1", device="plc"), "the device is 'plc'"),
        (lambda: instrument("CF1"), "CF1 begins with C, which means controller only after another letter"),
        (lambda: vessel(trays=3, packings=1), "either trays or packings, not 3 trays and 1 packings"),
        (lambda: vessel(lying=True, stirrer=True), "a lying vessel has neither trays nor packings, stirrer"),
        (lambda: symbol_table({}), "a table of symbols needs one symbol or more"),
        (lambda: symbol_table({"a": "valve"}), "a is 'valve', which is not a symbol of a plant"),
        (lambda: symbol_table({"a": valve()}, columns=0), "a table has one column or more, not 0"),
        (lambda: instrumentation_diagram("NH3 b", "NH3 b"), "NH3 .*; where NH3 is not an instrument, give its label"),
        (lambda: instrumentation_diagram("LC b", lines={"air": "LC b"}), "the kind of line is 'air': expected "),
    ],
)
def test_bad_input_is_told_in_one_sentence(make, message):
    with pytest.raises(ValueError, match=message):
        make()
