"""The drawing of exercise A.6."""

from loopbook import diagrams as draw

PLACES = {"panel": "a solid line across it", "behind": "a dashed line across it", "field": "no line across it"}


def tags_of(first, case):
    """The tags of each loop as they are drawn: transmitter, controller and valve."""
    letter, fault = case[0], case[2:]
    tags = {x: [f"{x}{kind}{int(first) + n}" for kind in "TCV"] for n, x in enumerate("FTL")}
    if fault == "no transmitter":
        tags[letter][0] = ""
    if fault == "wrong letter":
        tags[letter][0] = {"F": "P", "T": "F", "L": "T"}[letter] + tags[letter][0][1:]
    if fault == "wrong number":
        tags[letter][2] = f"{letter}V{int(first) + 5}"
    return tags


def pipes_of(first, case):
    """The pipes, with what is in them in the order of the flow."""
    (FT, _, FV), (TT, _, TV), (_, _, LV) = tags_of(first, case).values()
    before, behind = (TT, "") if case.endswith("wrong place") else ("", TT)
    path = f"feed P1 {FT} {FV} {before} E1 {behind} 1 T1 2 {LV} product, steam {TV} E1 water"
    return " ".join(path.split())


def signals_of(first, case):
    """The signals, each from where it is measured to where it ends."""
    paths = []
    for letter, (T, C, V) in tags_of(first, case).items():
        path = [*["T1"] * (letter == "L"), T, C, V] if T else [C, V]
        paths.append(" ".join(path[:-1] if case == f"{letter} no signal to the valve" else path))
    return ", ".join(paths)


def arrows(paths):
    """The same paths with arrows, and without the corners of the drawing."""
    return ", ".join(" → ".join(x for x in path.split() if not x.isdigit()) for path in paths.split(", "))


def behind(case):
    """The fault, behind the letter of its loop."""
    return case[2:]


def places_of(places):
    """Where each controller is drawn."""
    return places.split()


def drawn_as(first, places, among):
    """The controllers whose symbols are drawn in one of these ways."""
    found = enumerate(zip("FTL", places.split(), strict=True))
    return [f"{letter}C{int(first) + n}" for n, (letter, place) in found if place in among.split()]


def lines_across(controllers, places, shared):
    """Which line is drawn across each controller, and around which one a square."""
    drawn = [f"{C} with {PLACES[place]}" for C, place in zip(controllers, places.split(), strict=True)]
    if places.split()[shared - 1] != "field":
        drawn[shared - 1] += " and a square around it"
    return ", ".join(drawn)


def examined(pipes, signals):
    """The number of the faulty loop and its fault, as one finds them along the signals and the pipes."""
    for path in signals.split(", "):
        tags = [tag for tag in path.split() if tag != "T1"]
        number = next(int(tag[2:]) for tag in tags if tag[1] == "C")
        kinds, letters, numbers = ({tag[part] for tag in tags} for part in (slice(1, 2), slice(1), slice(2, None)))
        if "T" not in kinds or "V" not in kinds:
            return [number, "no signal to the valve" if "T" in kinds else "no transmitter"]
        if len(letters) > 1 or len(numbers) > 1:
            return [number, "wrong letter" if len(letters) > 1 else "wrong number"]
        if tags[0][0] == "T" and pipes.index(tags[0]) < pipes.index("E1"):
            return [number, "wrong place"]


def picture(first, case, places, shared):
    """A P&I diagram. Its pipes are, in the direction of the flow: {pipes}; its signals: {signals}. Drawn are
    {drawn}."""
    (FT, FC, FV), (TT, TC, TV), (LT, LC, LV) = ([tag or "." for tag in tags] for tags in tags_of(first, case).values())
    before, left, behind, right = (TT, TC, ".", ".") if case.endswith("wrong place") else (".", ".", TT, TC)
    layout = f"""
        .     .   .     .     .           steam  .  .           .  .     .     .
        .     .   {FC}  .     {left}      {TV}   .  {right}     .  .     .     .
        feed  P1  {FT}  {FV}  {before}    E1     .  {behind}    1  .     .     .
        .     .   .     .     .           water  .  .          T1  {LT}  {LC}  .
        .     .   .     .     .           .      .  .          T1  .     .     .
        .     .   .     .     .           .      .  .          2   .     {LV}  product"""
    parts = {"P1": draw.pump("P1"), "E1": draw.heat_exchanger("E1", kind="shell and tube"), "T1": draw.tank()}
    parts |= {valve: draw.control_valve(valve) for valve in (FV, TV, LV)}
    for n, (C, place) in enumerate(zip((FC, TC, LC), places.split(), strict=True), start=1):
        parts[C] = draw.instrument(C, place, "shared" if n == shared and place != "field" else "discrete")
    return draw.instrumentation_diagram(layout, pipes_of(first, case), signals_of(first, case), parts)


def solution_picture(first, places, shared):
    """The same plant without the fault."""
    return picture(first, "F nothing", places, shared)
