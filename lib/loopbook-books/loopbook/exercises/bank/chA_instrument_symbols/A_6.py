"""Python beside the page of exercise A.6."""

from loopbook import diagrams as draw

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


def plant_of(first, case, places, shared):
    """The plant with its fault."""
    return _Plant(first, case, places, shared)


def arrows(paths):
    """The same paths with arrows, and without the corners of the drawing."""
    return ", ".join(" → ".join(x for x in path.split() if not x.isdigit()) for path in paths.split(", "))


def places_of(places):
    """Where each controller is drawn."""
    return places.split()


def drawn_as(first, places, among):
    """The controllers whose symbols are drawn in one of these ways."""
    found = enumerate(zip("FTL", places.split(), strict=True))
    return [f"{letter}C{int(first) + n}" for n, (letter, place) in found if place in among.split()]


def joined(names):
    """Names in a sentence."""
    return " and ".join(names)


def examined(plant):
    """The number of the faulty loop and its fault, as one finds them along the signals and the pipes."""
    pipes = plant.pipes.split()
    for path in plant.signals.split(", "):
        tags = [tag for tag in path.split() if tag != "T1"]
        number = next(int(tag[2:]) for tag in tags if tag[1] == "C")
        kinds, letters, numbers = ({tag[part] for tag in tags} for part in (slice(1, 2), slice(1), slice(2, None)))
        if "T" not in kinds or "V" not in kinds:
            return [number, "no signal to the valve" if "T" in kinds else "no transmitter"]
        if len(letters) > 1 or len(numbers) > 1:
            return [number, "wrong letter" if len(letters) > 1 else "wrong number"]
        if tags[0][0] == "T" and pipes.index(tags[0]) < pipes.index("E1"):
            return [number, "wrong place"]


def picture(plant):
    """A P&I diagram. Its pipes are, in the way of the flow: {pipes}; its signals: {signals}. Drawn are {drawn}."""
    return plant.picture()


def solution_picture(first, places, shared):
    """The same plant without the fault."""
    return _Plant(first, "F nothing", places, shared).picture()
