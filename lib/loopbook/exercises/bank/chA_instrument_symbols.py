"""Exercises of appendix A, letters and symbols of P&I diagrams."""

from loopbook.exercises.authoring import answers, between, choice, exercise, number, numbers, word, words
from loopbook.instruments import decode

QUANTITIES = ["density", "flow", "level", "position", "pressure", "quality", "speed", "temperature", "viscosity"]
FUNCTIONS = ["alarm", "controller", "function", "indicator", "secure control", "transmitter", "valve"]


# --- A.1 ----------------------------------------------------------------------------------------------------------


def functions_of(letters):
    """What the subsequent letters do, in their order, without the remarks in brackets."""
    return [part.meaning.partition(" (")[0] for part in decode(letters).at("function")]


@exercise("A.1", title="A tag without a legend", points=1)
def tag(
    letters=choice("PDIC", "FFC", "DIC", "VIT", "TIC", "TDT", "QIC", "GT", "SC", "DT", "FY", "VT", "LZ", "FFIC", "PDT"),
    loop=between(11, 49, reference=31, step=1),
):
    """On a drawing stands an instrument with the tag {tag}. What is measured, is it modified, what is done with it, and
    to which loop does the instrument belong?
    """
    read = decode(letters)
    return answers(
        measured=word(read.measured, QUANTITIES, what="the measured quantity"),
        modifier=word(read.modifier or "none", ["difference", "fraction", "none"], what="the modifier"),
        functions=words(functions_of(letters), FUNCTIONS, what="the functions", ordered=True),
        loop=number(loop, "", "the number of the loop", within=0),
    )


@tag.shows
def _(letters, loop):
    return {"tag": f"`{letters}{loop}`"}


@tag.mistake("That is what the D means as the first letter. Here it follows one.")
def _(letters):
    return {"measured": "density"} if letters[1] == "D" else {}


@tag.mistake("A D that changes what is measured follows another letter. Which letter is the first one here?")
def _(letters):
    return {"modifier": "difference"} if letters[0] == "D" else {}


@tag.mistake("One of the letters says what is made of the measured quantity before it is used. Which one?")
def _(letters):
    return {"modifier": "none"} if decode(letters).modifier else {}


@tag.mistake("The T is the first letter here. Does it mean the same as after another letter?")
def _(letters):
    return {"functions": ["transmitter", *functions_of(letters)]} if letters == "TIC" else {}


# --- A.2 ----------------------------------------------------------------------------------------------------------

ALPHABET = list("ACDFGHILPQSTVYZ")
DEVICES = {
    "an indicating controller": "IC",
    "a transmitter": "T",
    "an indicating transmitter": "IT",
    "an indicator": "I",
    "a high alarm": "AH",
    "a low alarm": "AL",
    "an interlock, that is, a secure control,": "Z",
    "a mathematical function": "Y",
}
MEASURED = {
    "a pressure difference": "PD",
    "a viscosity": "V",
    "the fraction of two flows": "FF",
    "a density": "D",
    "a temperature": "T",
    "a speed": "S",
    "a quality": "Q",
    "a temperature difference": "TD",
    "a level": "L",
    "a position": "G",
    "a pressure": "P",
}


def letters_of(device, measured):
    """The letters of a tag, one by one."""
    return list(MEASURED[measured] + DEVICES[device])


@exercise("A.2", title="Write a tag", points=1)
def writing(device=choice(*DEVICES), measured=choice(*MEASURED)):
    """A drawing needs {device} of {measured}. Which letters does its tag have? Give them one by one as a list, as
    `["F", "C"]` for a flow controller.
    """
    letters = letters_of(device, measured)
    return answers(letters=words(letters, ALPHABET, what="the letters of the tag", ordered=True))


@writing.mistake("The last letter says what the instrument is. Is it primarily an indicator?")
def _(device, measured):
    letters = letters_of(device, measured)
    return {"letters": [*letters[:-2], *letters[:-3:-1]]} if DEVICES[device] in ("IC", "IT") else {}


@writing.mistake("A modifier follows the letter that it changes. As the first letter it has a meaning of its own.")
def _(device, measured):
    letters = letters_of(device, measured)
    if decode("".join(letters)).modifier and letters[0] != letters[1]:
        return {"letters": [letters[1], letters[0], *letters[2:]]}
    return {}


@writing.mistake("The measured quantity is there, and what is done with it. What is done to the quantity first?")
def _(device, measured):
    letters = letters_of(device, measured)
    return {"letters": [letters[0], *letters[2:]]} if decode("".join(letters)).modifier else {}


@writing.mistake("That says at which side the quantity is, and then what reacts to it. The limit comes last.")
def _(device, measured):
    letters = letters_of(device, measured)
    return {"letters": [*letters[:-2], letters[-1], letters[-2]]} if DEVICES[device] in ("AH", "AL") else {}


# --- A.3 ----------------------------------------------------------------------------------------------------------

LETTERS = "FTLP"


def plant_tags(first, watched, lacking):
    """The tags of four loops, sorted by their kinds: one loop only shows its quantity, and one lacks its valve."""
    loops = [(letter, int(first) + n, n + 1) for n, letter in enumerate(LETTERS)]
    tags = [f"{letter}T{loop}" for letter, loop, n in loops]
    tags += [f"{letter}I{loop}" for letter, loop, n in loops if n == watched]
    tags += [f"{letter}IC{loop}" for letter, loop, n in loops if n != watched]
    tags += [f"{letter}AH{loop}" for letter, loop, n in loops if n in (watched, 3)]
    return tags + [f"{letter}V{loop}" for letter, loop, n in loops if n not in (watched, lacking)]


@exercise("A.3", title="Which loop is not closed?", points=2, where=lambda watched, lacking: watched != lacking)
def open_loops(
    first=between(101, 181, reference=121, step=5),
    watched=choice(2, 1, 3, 4),
    lacking=choice(4, 1, 2, 3),
):
    """Four loops of a plant are numbered one after the other. A list of their instruments, sorted by kinds, reads:

    > {tags}

    Which loops are closed, that is, have a transmitter, a controller and a valve? Which quantity is only watched: what
    is the number of its loop? In another loop the draughtsman has forgotten the valve: in which one?
    """
    closed = [first + n - 1 for n in range(1, 5) if n not in (watched, lacking)]
    return answers(
        closed=numbers(closed, "", "the numbers of the closed loops, in increasing order", within=0),
        watched=number(first + watched - 1, "", "the number of the loop that is only watched", within=0),
        forgotten=number(first + lacking - 1, "", "the number of the loop without its valve", within=0),
    )


@open_loops.shows
def _(first, watched, lacking):
    return {"tags": ", ".join(plant_tags(first, watched, lacking))}


@open_loops.mistake("A controller without a valve has nothing to act on. Look for the V of each loop.")
def _(first, watched):
    return {"closed": [first + n - 1 for n in range(1, 5) if n != watched]}


@open_loops.mistake("This loop has a controller, which must act on something. What is only watched needs none.")
def _(first, lacking):
    return {"watched": first + lacking - 1}


@open_loops.mistake("Nothing is missing there: an indicator shows a value, and no valve belongs to it.")
def _(first, watched):
    return {"forgotten": first + watched - 1}


# --- A.4 ----------------------------------------------------------------------------------------------------------

LINES = {"panel": "a solid line", "behind": "a dashed line", "field": "no line"}
FRAMES = {
    "shared": "The circle stands in a square",
    "discrete": "There is nothing around the circle",
    "computer": "In the place of the circle there is a hexagon",
}
WIRES = {
    "electrical signal": "a thin dashed line",
    "process connection": "a thin solid line without marks",
}


def _can_be(place, device, line):
    """Whether there is such an instrument: the process comes to what is beside it."""
    return line == "electrical signal" or (place == "field" and device == "discrete")


@exercise("A.4", title="A symbol, described on the phone", points=2, where=_can_be)
def symbol(
    place=choice(*LINES),
    device=choice(*FRAMES),
    line=choice("electrical signal", *["process connection"] * 3),
    letters=choice("TIC", "PIC", "LIC", "FIC", "QIC"),
):
    """A colleague on site has the drawing and describes a symbol: "The letters are {letters}. {frame}, and {across}
    runs across it. {wire} ends at it from below."

    Where is the instrument, or where can it be read? Is it an instrument of its own? And what comes from below?
    """
    return answers(
        place=word(
            {"panel": "in the control room", "behind": "behind the panel", "field": "in the field"}[place],
            ["in the field", "in the control room", "behind the panel"],
            what="the place",
        ),
        device=word(
            {"shared": "shared display", "discrete": "own instrument", "computer": "computer function"}[device],
            ["own instrument", "shared display", "computer function"],
            what="the kind of device",
        ),
        line=word(line, [*WIRES, "pipe"], what="what the line from below is"),
    )


@symbol.shows
def _(place, device, line):
    return {"frame": FRAMES[device], "across": LINES[place], "wire": WIRES[line].capitalize()}


@symbol.mistake("A line across the symbol is a panel, seen from its edge. Is the instrument in front of it, or hidden?")
def _(place):
    other = {"panel": "behind the panel", "behind": "in the control room"}
    return {"place": other[place]} if place in other else {}


@symbol.mistake("No line crosses this symbol, so there is no panel. Where does one go to read it?")
def _(place):
    return {"place": "in the control room"} if place == "field" else {}


@symbol.mistake(
    "You took a square for a hexagon, or a hexagon for a square. Which of them is a function in a computer?"
)
def _(device):
    other = {"shared": "computer function", "computer": "shared display"}
    return {"device": other[device]} if device in other else {}


@symbol.mistake("Material flows in thick lines. How thick is this one?")
def _():
    return {"line": "pipe"}


@symbol.mistake("A signal of an instrument carries a mark, or its line is broken. What does a solid line mean?")
def _(line):
    return {"line": "electrical signal"} if line == "process connection" else {}


@symbol.mistake("The connection of an instrument to the process is a solid line. What does a broken one mean?")
def _(line):
    return {"line": "process connection"} if line == "electrical signal" else {}


# --- A.5 ----------------------------------------------------------------------------------------------------------

#: What is measured and which machine is stopped, if it becomes too high and if it becomes too low.
VESSELS = {
    "L": {"H": ("The level of a settling tank", "the inlet pump"), "L": ("The level of a day tank", "the outlet pump")},
    "P": {"H": ("The pressure of a boiler", "the burner"), "L": ("The pressure of a cooling system", "the pump")},
    "T": {"H": ("The temperature of an oven", "the heater"), "L": ("The temperature of chilled water", "the chiller")},
    "D": {"H": ("The density of a brine", "the salt feeder"), "L": ("The density of a slurry", "the water pump")},
    "V": {"H": ("The viscosity of a heavy oil", "the pump"), "L": ("The viscosity of a glue", "the spraying machine")},
}
SIDES = {"H": "too high", "L": "too low"}


def loop_tags(quantity, n, alarm):
    """The tags of the loop, with its alarm and the switch beyond it."""
    return [f"{quantity}{rest}{n}" for rest in ("T", "IC", "V", f"A{alarm}", f"S{2 * alarm}")]


def decoys(quantity, n, alarm):
    """Tags that are almost right."""
    other = "L" if alarm == "H" else "H"
    rests = ("CI", "C", "VC", f"A{other}", f"{alarm}A", f"S{2 * other}", f"S{alarm}")
    return [f"{quantity}{rest}{n}" for rest in rests] + [f"{quantity}T{n + 1}", f"{quantity}V{n + 1}"]


@exercise("A.5", title="All tags of a loop", points=4)
def whole_loop(
    quantity=choice(*VESSELS),
    n=between(2, 40, reference=7, step=1),
    alarm=choice("L", "H"),
):
    """{what} is measured by a transmitter and kept by a controller that also indicates it, with a valve. If it becomes
    {side}, an alarm sounds; if it goes on in this direction to the next limit, a switch stops {machine}. All of it
    belongs to loop {number}.

    Choose the tags that the drawing must have.
    """
    tags = loop_tags(quantity, n, alarm)
    return answers(tags=words(tags, sorted(tags + decoys(quantity, n, alarm)), what="the tags of the loop"))


@whole_loop.shows
def _(quantity, n, alarm):
    what, machine = VESSELS[quantity][alarm]
    return {"what": what, "machine": machine, "side": SIDES[alarm], "number": str(n)}


@whole_loop.mistake("The alarm or the switch is on the wrong side: read again what becomes too high or too low.")
def _(quantity, n, alarm):
    other = "L" if alarm == "H" else "H"
    return {"tags": [*loop_tags(quantity, n, alarm)[:3], f"{quantity}A{other}{n}", f"{quantity}S{2 * other}{n}"]}


@whole_loop.mistake("The controller should also show its value: a letter is missing from its tag.")
def _(quantity, n, alarm):
    transmitter, _, *others = loop_tags(quantity, n, alarm)
    return {"tags": [transmitter, f"{quantity}C{n}", *others]}


@whole_loop.mistake("Alarm and switch would react at the same limit. How is the second limit written?")
def _(quantity, n, alarm):
    return {"tags": [*loop_tags(quantity, n, alarm)[:4], f"{quantity}S{alarm}{n}"]}


@whole_loop.mistake("The alarm tells that something is wrong, but nothing stops the machine.")
def _(quantity, n, alarm):
    return {"tags": loop_tags(quantity, n, alarm)[:4]}
