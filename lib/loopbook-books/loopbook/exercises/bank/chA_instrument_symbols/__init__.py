"""Exercises of appendix A, letters and symbols of P&I diagrams."""

from loopbook import diagrams as draw
from loopbook.exercises.authoring import answers, between, choice, exercise, number, word, words

# --- A.6 ----------------------------------------------------------------------------------------------------------

FAULTS = {
    "no transmitter": "nothing measures for the controller",
    "no signal to the valve": "the controller acts on nothing",
    "wrong letter": "what is measured is not what is controlled",
    "wrong number": "an instrument has the number of no loop",
    "wrong place": "the transmitter is where its valve has no effect on what it measures",
}
PLACES = {"panel": "a solid line across it", "behind": "a dashed line across it", "field": "no line across it"}


class _Plant:
    """Three loops, of a flow, a temperature and a level, one of them with a fault.

    Attributes:
        tags: of each loop, transmitter, controller and valve.
    """

    def __init__(self, first, case, places, shared):
        self.letter, self.fault = case[0], case[2:]
        self.numbers = dict(zip("FTL", range(int(first), int(first) + 3), strict=True))
        self.tags = {x: [f"{x}{kind}{n}" for kind in "TCV"] for x, n in self.numbers.items()}
        if self.fault == "wrong letter":
            self.tags[self.letter][0] = f"{ {'F': 'P', 'T': 'F', 'L': 'T'}[self.letter] }T{self.numbers[self.letter]}"
        if self.fault == "wrong number":
            self.tags[self.letter][2] = f"{self.letter}V{int(first) + 5}"
        self.places = dict(zip("FTL", places.split(), strict=True))
        self.shared = "FTL"[int(shared) - 1]

    @property
    def pipes(self):
        (FT, _, FV), (TT, _, TV), (_, _, LV) = self.tags.values()
        FT = "" if self._lacks("F") else FT
        before, behind = (TT, "") if self.fault == "wrong place" else ("", TT)
        behind = "" if self._lacks("T") else behind
        return f"feed P1 {FT} {FV} {before} E1 {behind} 1 T1 2 {LV} product, steam {TV} E1 water".replace("  ", " ")

    def _lacks(self, letter):
        return self.fault == "no transmitter" and letter == self.letter

    @property
    def signals(self):
        paths = []
        for letter, (T, C, V) in self.tags.items():
            path = ["T1"] * (letter == "L") + [T, C, V]
            if self._lacks(letter):
                path = [C, V]
            elif letter == self.letter and self.fault == "no signal to the valve":
                path = path[:-1]
            paths.append(" ".join(path))
        return ", ".join(paths)

    @property
    def readable(self):
        """The controllers that can be read in the control room."""
        return [self.tags[x][1] for x, place in self.places.items() if place == "panel"]

    @property
    def drawn(self):
        return ", ".join(f"{self.tags[x][1]} with {PLACES[place]}" for x, place in self.places.items())

    def picture(self):
        (FT, FC, FV), (TT, TC, TV), (LT, LC, LV) = self.tags.values()
        early = self.fault == "wrong place"
        before, behind = (TT, ".") if early else (".", TT)
        left, right = (TC, ".") if early else (".", TC)
        FT, behind, LT = ("." if self._lacks(x) else tag for x, tag in zip("FTL", (FT, behind, LT), strict=True))
        layout = f"""
            .     .   .     .     .           steam  .  .           .  .     .     .
            .     .   {FC}  .     {left}      {TV}   .  {right}     .  .     .     .
            feed  P1  {FT}  {FV}  {before}    E1     .  {behind}    1  .     .     .
            .     .   .     .     .           water  .  .          T1  {LT}  {LC}  .
            .     .   .     .     .           .      .  .          T1  .     .     .
            .     .   .     .     .           .      .  .          2   .     {LV}  product"""
        parts = {"P1": draw.pump("P1"), "E1": draw.heat_exchanger("E1", kind="shell and tube"), "T1": draw.tank()}
        parts |= {valve: draw.control_valve(valve) for valve in (FV, TV, LV)}
        for letter, place in self.places.items():
            device = "shared" if letter == self.shared and place != "field" else "discrete"
            parts[self.tags[letter][1]] = draw.instrument(self.tags[letter][1], place, device)
        return draw.instrumentation_diagram(layout, self.pipes, self.signals, parts)


@exercise(
    "A.6",
    title="What is wrong with this drawing?",
    points=3,
    insight="Follow each loop once around: from the process to the transmitter, to the controller, to the valve, and "
    "back to the process. What is missing shows where the way ends.",
)
def faulty_drawing(
    first=between(21, 81, reference=41, step=10),
    case=choice(
        "T wrong place", "F no transmitter", "F no signal to the valve", "F wrong letter", "F wrong number",
        "T no transmitter", "T no signal to the valve", "T wrong letter", "T wrong number", "L no transmitter",
        "L no signal to the valve", "L wrong letter", "L wrong number", "T wrong place ", "T wrong place  ",
    ),
    places=choice(
        "behind panel panel", "behind panel field", "field panel behind", "panel field panel", "panel behind panel",
        "field behind panel", "panel panel behind", "panel field behind",
    ),
    shared=choice(1, 2, 3),
):  # fmt: skip
    """The drawing shows a heater with three loops: the flow of the feed, its temperature behind the heat exchanger, and
    the level of the tank. One loop has a fault:

    {list}

    Which loop, and which fault? And which of the three controllers can be read in the control room?
    """
    plant = _Plant(first, case.strip(), places, shared)
    controllers = [plant.tags[x][1] for x in "FTL"]
    return answers(
        loop=number(plant.numbers[plant.letter], "", "the number of the faulty loop", within=0),
        fault=word(plant.fault, [*FAULTS], what="the fault"),
        readable=words(plant.readable, controllers, what="the controllers that can be read in the control room"),
    )


@faulty_drawing.shows
def _(first, case, places, shared):
    plant = _Plant(first, case.strip(), places, shared)
    return {
        "list": "\n".join(f"- *{name}*: {meaning}" for name, meaning in FAULTS.items()),
        "pipes": _arrows(plant.pipes),
        "signals": _arrows(plant.signals),
        "drawn": plant.drawn,
    }


def _arrows(paths):
    """The same paths with arrows, and without the corners of the drawing."""
    return ", ".join(" → ".join(x for x in path.split() if not x.isdigit()) for path in paths.split(", "))


def _not_this_loop(letter):
    def mistake(first, case):
        return {} if case[0] == letter else {"loop": int(first) + "FTL".index(letter)}

    return mistake


for _letter, _way in {
    "F": "from the pipe to its transmitter, to its controller, to the valve in the same pipe",
    "T": "from behind the heat exchanger to the controller, and to the valve in the steam",
    "L": "from the tank to the controller, and to the valve in the outflow",
}.items():
    faulty_drawing.mistake(f"Follow this loop: {_way}. Is anything missing on this way, or wrong in the tags?")(
        _not_this_loop(_letter)
    )


@faulty_drawing.mistake(
    "That is the number that is written at it. To which loop does the signal belong that ends there?"
)
def _(first, case):
    return {"loop": int(first) + 5} if case.strip().endswith("number") else {}


def _not_this_fault(fault):
    def mistake(case):
        return {} if case.strip().endswith(fault) else {"fault": fault}

    return mistake


for _fault, _question in {
    "no transmitter": "Without a transmitter no line would lead to the controller. Does one lead to each of the three?",
    "no signal to the valve": "Each valve is drawn with its actuator. Is there one at which no line ends?",
    "wrong letter": "The first letters of transmitter, controller and valve of a loop are the same. Are they not?",
    "wrong number": "Three instruments of a loop have one number. Is there one with another number?",
    "wrong place": "Does each valve have an effect on what is measured at the place of its transmitter?",
}.items():
    faulty_drawing.mistake(_question)(_not_this_fault(_fault))


@faulty_drawing.mistake("A dashed line means behind the panel, where no operator reaches it.")
def _(first, places):
    tags = _readable(first, places, "panel", "behind")
    return {"readable": tags} if "behind" in places else {}


@faulty_drawing.mistake("Without a line across it an instrument is in the field. Who can read it in the control room?")
def _(first, places):
    tags = _readable(first, places, "panel", "field")
    return {"readable": tags} if "field" in places else {}


@faulty_drawing.mistake(
    "Without a line across it an instrument is in the field. Which line stands for the control room?"
)
def _(first, places):
    return {"readable": _readable(first, places, "field")} if "field" in places else {}


@faulty_drawing.mistake("A dashed line means behind the panel. Which line stands for its front?")
def _(first, places):
    return {"readable": _readable(first, places, "behind")} if "behind" in places else {}


@faulty_drawing.mistake("The lines across the circles differ. What does each of them mean?")
def _(first, places):
    return {"readable": _readable(first, places, "panel", "behind", "field")} if len(set(places.split())) == 3 else {}


@faulty_drawing.mistake("The square says that several loops share the display, and not where it is. Look at the lines.")
def _(first, places, shared):
    k = int(shared) - 1
    tag = f"{'FTL'[k]}C{int(first) + k}"
    right = _readable(first, places, "panel")
    return {"readable": [tag]} if right != [tag] and places.split()[k] != "field" else {}


def _readable(first, places, *among):
    """The controllers whose symbols are drawn in one of these ways."""
    found = enumerate(zip("FTL", places.split(), strict=True))
    return [f"{letter}C{int(first) + n}" for n, (letter, place) in found if place in among]


faulty_drawing.hints(
    "Follow each loop around once: process, transmitter, controller, valve, process. Where does the way end, or where "
    "does a tag not fit?",
    "Three tags of a loop have the same first letter and the same number. The transmitter measures behind the place "
    "where the valve acts, except for a flow, which is the same all along its pipe. And the line across a circle says "
    "where it can be read.",
    "These are the signals: {signals}. And these are the pipes, in the way of the flow: {pipes}.",
)


@faulty_drawing.solution
def _(first, case, places, shared):
    """The signals on the drawing are {signals}, and the pipes {pipes}.

    {story} So the fault of loop {loop} is: {fault}.

    **In the control room** are the instruments with a solid line across them. Drawn are {drawn}. So an operator reads
    {read} there; a dashed line is behind the panel, and no line is beside the process. (A square says that several
    loops share a display, wherever it is.)
    """
    plant = _Plant(first, case.strip(), places, shared)
    T, C, V = plant.tags[plant.letter]
    stories = {
        "no transmitter": f"No line leads to {C}: it controls what it does not know.",
        "no signal to the valve": f"No line leads from {C} to {V}: whatever the controller decides, the valve stays.",
        "wrong letter": f"{C} is told by {T}, which measures something else, as its first letter says.",
        "wrong number": f"The signal of {C} ends at {V}, whose number belongs to no loop: it should be that of {C}.",
        "wrong place": f"{T} measures before the heat exchanger, into which {V} lets the steam: the valve has no "
        "effect on what is measured, and the controller would open it further and further.",
    }
    return {"story": stories[plant.fault], "read": " and ".join(plant.readable)}


@faulty_drawing.picture
def _(first, case, places, shared):
    """A P&I diagram. Its pipes are, in the way of the flow: {pipes}; its signals: {signals}. Drawn are {drawn}."""
    return _Plant(first, case.strip(), places, shared).picture()


@faulty_drawing.solution_picture
def _(first, places, shared):
    """The same plant without the fault."""
    return _Plant(first, "F nothing", places, shared).picture()


# --- A.7 ----------------------------------------------------------------------------------------------------------

#: Symbols by their names: how each is drawn, and how it looks.
VALVES = {
    "ball valve": (draw.valve(kind="ball"), "two triangles with a circle between them"),
    "butterfly valve": (draw.valve(kind="butterfly"), "a slanting line with a dot in its middle"),
    "check valve": (draw.valve(kind="check"), "a slanting line with an arrow at its end"),
    "hand valve": (draw.valve(kind="hand"), "two triangles with a T on top"),
    "pneumatic valve": (draw.control_valve(), "two triangles with half a circle on top"),
    "safety valve": (draw.valve(kind="safety"), "two triangles with a zigzag on top"),
    "solenoid valve": (draw.control_valve(actuator="solenoid"), "two triangles with a square on top, and an S in it"),
}
MACHINES = {
    "axial fan": (draw.fan(kind="axial"), "a circle with two blades, one above the other"),
    "centrifugal pump": (draw.pump(kind="centrifugal"), "a circle with a triangle, and a dot in it"),
    "compressor": (draw.compressor(), "a shape that becomes narrower to the right"),
    "gear pump": (draw.pump(kind="gear"), "a circle with a triangle, and two small circles in it"),
    "motor": (draw.motor(), "a circle with an M, where no pipe ends"),
    "radial fan": (draw.fan(kind="radial"), "a circle with a wheel of many blades"),
    "turbine": (draw.turbine(), "a shape that becomes wider to the right"),
}
APPARATUS = {
    "column with trays": (draw.vessel(trays=6), "an upright vessel with dashed lines all across"),
    "cyclone": (draw.cyclone(), "a funnel with two upright strokes in its top"),
    "packed column": (draw.vessel(packings=2), "an upright vessel with two crossed boxes"),
    "plate exchanger": (draw.heat_exchanger(kind="plate"), "a box with upright lines in it"),
    "reactor": (draw.vessel(stirrer=True, jacket=True, filled=0.6), "a vessel with a stirrer, and a motor above it"),
    "shell and tube exchanger": (
        draw.heat_exchanger(kind="shell and tube"),
        "a long box with lines along it, between two heads",
    ),
    "silo": (draw.silo(), "a funnel with a heap in it"),
}
CONDUCTORS = {
    "capillary": (draw.conductor("capillary"), "a line with small crosses"),
    "data link": (draw.conductor("data link"), "a line with small circles"),
    "electrical signal": (draw.conductor("electrical"), "a dashed line"),
    "hydraulic signal": (draw.conductor("hydraulic"), "a line with small Ls"),
    "pneumatic signal": (draw.conductor("pneumatic"), "a line with pairs of slanting strokes"),
    "process connection": (draw.conductor("measuring line"), "a thin line without marks"),
    "radio signal": (draw.conductor("radio"), "waves without a line"),
}
SYMBOLS = {"valve": VALVES, "machine": MACHINES, "apparatus": APPARATUS, "line": CONDUCTORS}


@exercise(
    "A.7",
    title="Four symbols to name",
    points=2,
    insight="A symbol shows how a thing works: what narrows, what turns, which way is free, what travels along a line.",
)
def naming(
    valve=choice(*VALVES, reference="safety valve"),
    machine=choice(*MACHINES, reference="turbine"),
    apparatus=choice(*APPARATUS, reference="packed column"),
    line=choice(*CONDUCTORS, reference="pneumatic signal"),
):
    """Four symbols are cut out of a drawing on which everything flows from left to right: a valve (1), a machine (2),
    an apparatus (3) and a thin line that ends at an instrument (4). What are they called?

    (For those who cannot see the picture, its description says what is drawn.)
    """
    drawn = {"valve": valve, "machine": machine, "apparatus": apparatus, "line": line}
    return answers(**{name: word(right, [*SYMBOLS[name]], what=f"the {name}") for name, right in drawn.items()})


@naming.shows
def _(valve, machine, apparatus, line):
    right = zip(SYMBOLS.values(), (valve, machine, apparatus, line), strict=True)
    return {f"look_{n}": symbols[name][1] for n, (symbols, name) in enumerate(right, start=1)}


def _not_named(kind, name):
    """The mistake of giving a symbol this name."""

    def mistake(valve, machine, apparatus, line):
        right = {"valve": valve, "machine": machine, "apparatus": apparatus, "line": line}[kind]
        return {} if name == right else {kind: name}

    return mistake


for _kind, _symbols in SYMBOLS.items():
    for _name, (_, _look) in _symbols.items():
        _article = "An" if _name[0] in "aeiou" else "A"
        naming.mistake(f"{_article} {_name} is drawn as {_look}. Do you see that?")(_not_named(_kind, _name))


naming.hints(
    "A symbol is a small picture of how a thing works. What in it moves, narrows, or is marked?",
    "For a valve look at what is between the two triangles and on top of them; for a machine at whether it becomes "
    "wider or narrower and at what turns in its circle; for an apparatus at what is inside; for a line at its marks.",
    "Compare with *Figures A.2* (lines), *A.3* (valves), *A.4* (machines), *A.5* and *A.6* (apparatus). The line is "
    "the easiest: what are its marks?",
)


@naming.solution
def _(valve, machine, apparatus, line):
    """1. The first symbol is {look_1}. That is the {valve}.
    2. The second one is {look_2}: the {machine}. (What narrows to the right compresses, what widens expands; what turns
       in a circle is drawn in it.)
    3. The third one is {look_3}: the {apparatus}.
    4. The fourth one is {look_4}: the {line}. Each kind of signal has a mark of its own, and a thin line without marks
       connects an instrument with the process.
    """


@naming.picture
def _(valve, machine, apparatus, line):
    """Four symbols with numbers: 1 is {look_1}, 2 is {look_2}, 3 is {look_3}, 4 is {look_4}."""
    right = zip(SYMBOLS.values(), (valve, machine, apparatus, line), strict=True)
    return draw.symbol_table({str(n): symbols[name][0] for n, (symbols, name) in enumerate(right, start=1)})
