"""Exercises of appendix A, letters and symbols of P&I diagrams."""

from loopbook import diagrams as draw
from loopbook.exercises.authoring import (
    answers,
    between,
    choice,
    exercise,
    instrument_diagram,
    number,
    word,
    words,
)
from loopbook.exercises.connections import connections
from loopbook.exercises.diagram_layout import drawn
from loopbook.instruments import decode

QUANTITIES = ["density", "flow", "level", "position", "pressure", "quality", "speed", "temperature", "viscosity"]
FUNCTIONS = ["alarm", "controller", "function", "indicator", "secure control", "transmitter", "valve"]


# --- A.1 ----------------------------------------------------------------------------------------------------------


def functions_of(letters):
    """What the subsequent letters do, in their order, without the remarks in brackets."""
    return [part.meaning.partition(" (")[0] for part in decode(letters).at("function")]


@exercise(
    "A.1",
    title="A tag without a legend",
    points=1,
    insight="A tag is read from the left: what is measured, what is made of it, what is done with it. The place of a "
    "letter decides what it means.",
)
def tag(
    letters=choice(
        "PDIC", "DIC", "FFIC", "VIT", "TIC", "TDIT", "QIC", "PDIT", "TIZ", "LDIC", "DIT", "FFIT", "SIC", "TDIZ", "VIZ",
        "LDIT", "GIT", "PDIZ",
    ),
    loop=between(11, 49, reference=31, step=1),
):  # fmt: skip
    """On a drawing there is the instrument {tag}. What does it measure, and is that modified? What is done with it, and
    to which loop does it belong?
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
    read = decode(letters)
    names = [f"{part.letter} says {part.meaning.partition(' (')[0]}" for part in read.parts]
    return {"tag": f"`{letters}{loop}`", "first": letters[0], "names": ", ".join(names)}


@tag.picture
def _(letters, loop):
    """A part of a drawing: from a plant, in which something is measured, a line leads to the instrument
    {letters}{loop}."""
    layout = """
        .       instrument  .
        stream  Plant       product"""
    parts = {"instrument": draw.instrument(f"{letters}{loop}"), "Plant": "Plant"}
    line = {"measuring line": "Plant instrument"}
    return draw.instrumentation_diagram(layout, "stream Plant product", "", parts, lines=line)


@tag.mistake("That is what the D means as the first letter. Here it follows one.")
def _(letters):
    return {"measured": "density"} if letters[1] == "D" else {}


def _another_quantity(quantity):
    """The mistake of taking this quantity for the measured one."""

    def mistake(letters):
        is_modifier = quantity == "density" and letters[1] == "D"
        return {} if quantity == decode(letters).measured or is_modifier else {"measured": quantity}

    return mistake


for _quantity, _letter in zip(QUANTITIES, "DFLGPQSTV", strict=True):
    _sentence = f"The letter of {_quantity} is {_letter}. Is it the first one of this tag?"
    tag.mistake(_sentence)(_another_quantity(_quantity))


@tag.mistake("A D that changes what is measured follows another letter. Which letter is the first one here?")
def _(letters):
    return {"modifier": "difference"} if letters[0] == "D" else {}


@tag.mistake("For a difference a D follows the first letter. Is there one?")
def _(letters):
    return {"modifier": "difference"} if "D" not in letters else {}


@tag.mistake("For a fraction, or ratio, an F follows the first letter. Is there one?")
def _(letters):
    return {"modifier": "fraction"} if letters[1] != "F" else {}


@tag.mistake("One of the letters says what is made of the measured quantity before it is used. Which one?")
def _(letters):
    return {"modifier": "none"} if decode(letters).modifier else {}


@tag.mistake("The first letter says what is measured. Does it mean the same as after another letter?")
def _(letters):
    as_function = {"T": "transmitter", "V": "valve"}.get(letters[0])
    return {"functions": [as_function, *functions_of(letters)]} if as_function else {}


@tag.mistake("There are two letters behind what is measured. What does the other one say?")
def _(letters):
    return {"functions": functions_of(letters)[1:]}


@tag.mistake("It does show its value. But there is one more letter: what is the instrument first of all?")
def _(letters):
    return {"functions": functions_of(letters)[:1]}


@tag.mistake("A Z is no alarm: nobody is only told. What does it do on its own?")
def _(letters):
    return {"functions": ["indicator", "alarm"]} if letters.endswith("Z") else {}


@tag.mistake("A transmitter sends a value on, and a controller acts on it. Which letter is at the end?")
def _(letters):
    other = {"C": "transmitter", "T": "controller"}.get(letters[-1])
    return {"functions": ["indicator", other]} if other else {}


@tag.mistake("The number is read as a whole.")
def _(loop):
    return {"loop": loop // 10}


tag.hints(
    "A tag has two alphabets: one for the first letter, and one for those that follow. Which letter is which?",
    "The first letter says what is measured. A D or an F directly behind it says what is made of it first, a "
    "difference or a fraction. All others say what is done with it, and the number is that of the loop.",
    "The first letter is {first}, and two letters are left at the end for what the instrument does. Is there anything "
    "between them?",
)


@tag.solution
def _(letters, loop):
    """A tag is read from the left. The first letter says what is measured, and the number is that of the loop: all
    instruments of a loop have the same one.

    ***

    Letter by letter: {names}. The number is {loop}.

    So the measured quantity is {measured}, and the modifier: {modifier}. What is done with it: {done}. In one phrase,
    that is the {words}.
    """
    return {"done": " and ".join(functions_of(letters)), "words": decode(f"{letters}{loop}").words}


@tag.solution_picture
def _(letters, loop):
    """The symbol of this instrument, in the control room."""
    return draw.symbol_table({decode(letters).words: draw.instrument(f"{letters}{loop}", "panel")})


# --- A.2 ----------------------------------------------------------------------------------------------------------

ALPHABET = list("ACDFGHILPQSTVYZ")
DEVICES = {
    "an indicating controller": "IC",
    "an indicating transmitter": "IT",
    "a high alarm": "AH",
    "a low alarm": "AL",
}
MEASURED = {
    "a pressure difference": "PD",
    "a viscosity": "V",
    "the fraction of two flows": "FF",
    "a density": "D",
    "a temperature difference": "TD",
    "a speed": "S",
    "a quality": "Q",
    "a level difference": "LD",
    "a position": "G",
}
#: Where each of them is measured, and to whom each device speaks, for the picture.
MEASURED_AT = {
    "a pressure difference": "Filter",
    "a viscosity": "Oil pump",
    "the fraction of two flows": "Mixer",
    "a density": "Thickener",
    "a temperature difference": "Cooler",
    "a speed": "Fan",
    "a quality": "Reactor",
    "a level difference": "Screen",
    "a position": "Gate",
}
HEARD_BY = {"IC": "valve", "IT": "controller", "AH": "horn", "AL": "horn"}
#: What comes to mind first, from the English word or from the other standard.
TEMPTING = {"a viscosity": "Q", "a density": "G", "a speed": "V", "a quality": "A", "a position": "P"}


def letters_of(device, measured):
    """The letters of a tag, one by one."""
    return list(MEASURED[measured] + DEVICES[device])


@exercise(
    "A.2",
    title="Write a tag",
    points=1,
    insight="First the quantity with its modifier, then what is done with it, the noun last, and the limit at the very "
    "end: who writes by this order is understood everywhere.",
)
def writing(device=choice(*DEVICES), measured=choice(*MEASURED)):
    """In this drawing the empty circle is {device} of {measured}. Which letters does its tag have? Give them one by one
    as a list, as `["F", "C"]` for a flow controller.
    """
    letters = letters_of(device, measured)
    return answers(letters=words(letters, ALPHABET, what="the letters of the tag", ordered=True))


@writing.picture
def _(device, measured):
    """A part of a plant, and above it a circle without letters: {device} of {measured}."""
    layout = """
        .   .  heard  .  .
        .   .  .      .  .
        .   .  empty  .  .
        in  1  place  2  out"""
    parts = {"empty": draw.instrument(""), "place": MEASURED_AT[measured]}
    names, pipes = {"in": "feed", "out": "product", "heard": HEARD_BY[DEVICES[device]]}, "in 1 place 2 out"
    taps = "1 empty, 2 empty" if len(MEASURED[measured]) > 1 else "place empty"
    if measured == "the fraction of two flows":
        layout += "\n        .  .  3  product  ."
        names, pipes = names | {"in": "syrup", "out": "water"}, "in 1 place, out 2 place 3 product"
    lines = {"measuring line": taps}
    return draw.instrumentation_diagram(layout, pipes, "empty heard", parts, names, lines=lines)


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


@writing.mistake(
    "That letter comes from the word, or from another standard. Which letter has the quantity in Table A.1?"
)
def _(device, measured):
    letters = letters_of(device, measured)
    return {"letters": [TEMPTING[measured], *letters[1:]]} if measured in TEMPTING else {}


@writing.mistake("What it does is there, but a letter is missing: it also shows its value, or reacts at one side only.")
def _(device, measured):
    letters = letters_of(device, measured)
    return {"letters": [*letters[:-2], letters[-1]] if DEVICES[device] in ("IC", "IT") else letters[:-1]}


@writing.mistake("H and L are letters of the side at which an alarm reacts. At which side does this one?")
def _(device, measured):
    letters, other = letters_of(device, measured), {"AH": "L", "AL": "H"}.get(DEVICES[device])
    return {"letters": [*letters[:-1], other]} if other else {}


@writing.mistake("A D makes a difference of the quantity, an F a fraction. Which of them does the text speak of?")
def _(device, measured):
    letters = letters_of(device, measured)
    if not decode("".join(letters)).modifier:
        return {}
    return {"letters": [letters[0], {"D": "F", "F": "D"}[letters[1]], *letters[2:]]}


@writing.mistake("An S switches something on its own, and an A only tells. Which of them does the drawing need?")
def _(device, measured):
    letters = letters_of(device, measured)
    return {"letters": [*letters[:-2], "S", letters[-1]]} if DEVICES[device] in ("AH", "AL") else {}


@writing.mistake("An I only shows a value. What does the instrument do if the limit is passed?")
def _(device, measured):
    letters = letters_of(device, measured)
    return {"letters": [*letters[:-2], "I", letters[-1]]} if DEVICES[device] in ("AH", "AL") else {}


def _begins_with(letter):
    """The mistake of beginning the tag with the letter of another quantity."""

    def mistake(device, measured):
        right = letters_of(device, measured)
        return {"letters": [letter, *right[1:]]} if letter != right[0] else {}

    return mistake


for _quantity, _letter in zip(QUANTITIES, "DFLGPQSTV", strict=True):
    writing.mistake(f"{_letter} as the first letter means {_quantity}. Which quantity is measured here?")(
        _begins_with(_letter)
    )


@writing.mistake("Twice is the letter of the limit that is beyond the first one. Is that meant here?")
def _(device, measured):
    letters = letters_of(device, measured)
    return {"letters": [*letters, letters[-1]]} if DEVICES[device] in ("AH", "AL") else {}


@writing.mistake("A transmitter sends a value on, and a controller acts on it. Which of them does the drawing need?")
def _(device, measured):
    letters, other = letters_of(device, measured), {"IC": "T", "IT": "C"}.get(DEVICES[device])
    return {"letters": [*letters[:-1], other]} if other else {}


@writing.mistake("That is first what it does, and then what it measures. A tag begins with what is measured.")
def _(device, measured):
    return {"letters": list(DEVICES[device] + MEASURED[measured])}


writing.hints(
    "A tag is written in a fixed order. What comes first: what the instrument is, or what it measures?",
    "First the letter of the quantity, then a D for a difference or an F for a fraction, then what is done with it. "
    "The last function says what the instrument is; an indicating one has its I before that. The limit comes last.",
    "{count} letters: {first} for the quantity{modified}, and two for what it does.",
)


@writing.shows
def _(device, measured):
    letters = letters_of(device, measured)
    modifier = f", {letters[1]} for what is made of it" if len(MEASURED[measured]) > 1 else ""
    return {
        "count": {3: "Three", 4: "Four"}[len(letters)],
        "first": letters[0],
        "modified": modifier,
        "example": f"`{''.join(letters)}`",
    }


@writing.solution
def _(device, measured):
    """Write in the order in which a tag is read. The quantity: {measured}, which is {quantity}. What the instrument
    does: {device}, which is {does}. {why}

    Together the tag has the letters {example}, and is read back as {words}.
    """
    why = {
        "C": "The noun of the phrase, the controller, comes last; that it indicates is said before.",
        "T": "The noun of the phrase, the transmitter, comes last; that it indicates is said before.",
        "H": "An H behind the A says at which side it reacts.",
        "L": "An L behind the A says at which side it reacts.",
    }
    does = DEVICES[device]
    return {
        "quantity": f"`{MEASURED[measured]}`",
        "does": f"`{does}`",
        "why": why[does[-1]],
        "words": f'"{decode("".join(letters_of(device, measured))).words}"',
    }


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


@exercise(
    "A.3",
    title="Which loop is not closed?",
    points=2,
    where=lambda watched, lacking: watched != lacking,
    insight="Sorted by their numbers, tags become loops: a transmitter, a controller and a valve, and what is missing "
    "stands out.",
)
def open_loops(
    first=between(11, 71, reference=21, step=5),
    watched=choice(2, 1, 3, 4),
    lacking=choice(4, 1, 2, 3),
):
    """Four loops of a plant are numbered one after the other. A list of their instruments, sorted by kinds, reads:

    > {tags}

    Which loops are closed, that is, have a transmitter, a controller and a valve? One quantity is only watched: what is
    the number of its loop? And in another loop somebody has forgotten to draw the valve: in which one?
    """
    four = [str(first + n) for n in range(4)]
    closed = [first + n - 1 for n in range(1, 5) if n not in (watched, lacking)]
    return answers(
        closed=words([str(loop) for loop in closed], four, what="the numbers of the closed loops"),
        watched=number(first + watched - 1, "", "the number of the loop that is only watched", within=0),
        forgotten=number(first + lacking - 1, "", "the number of the loop without its valve", within=0),
    )


@open_loops.mistake("A controller without a valve has nothing to act on. Look for the V of each loop.")
def _(first, watched):
    return {"closed": [str(first + n - 1) for n in range(1, 5) if n != watched]}


@open_loops.mistake("This loop has a controller, which must act on something. What is only watched needs none.")
def _(first, lacking):
    return {"watched": first + lacking - 1}


@open_loops.mistake("Nothing is missing there: an indicator shows a value, and no valve belongs to it.")
def _(first, watched):
    return {"forgotten": first + watched - 1}


@open_loops.mistake("An indicator shows a value and does nothing about it. Which loops have a controller?")
def _(first, lacking):
    return {"closed": [str(first + n - 1) for n in range(1, 5) if n != lacking]}


def _with_the_open_one(kept):
    """The mistake of counting the loop without a valve in the place of one of the two complete ones."""

    def mistake(first, watched, lacking):
        complete = [n for n in range(1, 5) if n not in (watched, lacking)]
        return {"closed": [str(first + n - 1) for n in sorted([lacking, complete[kept]])]}

    return mistake


for _kept in (0, 1):
    open_loops.mistake("One of these has a controller that acts on nothing. And which loop has all three parts, too?")(
        _with_the_open_one(_kept)
    )


@open_loops.mistake("Not all of them are: look in each loop for a transmitter, a controller and a valve.")
def _(first):
    return {"closed": [str(first + n - 1) for n in range(1, 5)]}


def _one_closed(k):
    """The mistake of finding only one of the closed loops."""

    def mistake(first, watched, lacking):
        closed = [n for n in range(1, 5) if n not in (watched, lacking)]
        return {"closed": [str(first + closed[k] - 1)]}

    return mistake


for _k in (0, 1):
    open_loops.mistake("That loop is closed. An alarm or an indicator more does not open another one: look again.")(
        _one_closed(_k)
    )


@open_loops.mistake("Look again at the tags with this number: this loop has a controller, and something to act on.")
def _(first, watched, lacking):
    complete = [n for n in range(1, 5) if n not in (watched, lacking)]
    return {"watched": first + complete[0] - 1, "forgotten": first + complete[1] - 1}


@open_loops.mistake("All three parts of a closed loop have this number. What is asked is the one that lacks something.")
def _(first, watched, lacking):
    complete = [n for n in range(1, 5) if n not in (watched, lacking)]
    return {"watched": first + complete[1] - 1, "forgotten": first + complete[0] - 1}


open_loops.hints(
    "All instruments of a loop have the same number. Sort the list by numbers instead of kinds.",
    "For each number write down the last letters: T measures, C controls, V acts, I alone only shows. An alarm is no "
    "part of the loop.",
    "Number {first} has the tags {tags_of_first}. Go on with the other three.",
)


@open_loops.shows
def _(first, watched, lacking):
    tags = plant_tags(first, watched, lacking)
    return {"tags": ", ".join(tags), "tags_of_first": ", ".join(tag for tag in tags if tag.endswith(str(first)))}


@open_loops.solution
def _(first, watched, lacking):
    """Sorted by their numbers, the tags are these loops:

    {table}

    {closed} have a transmitter, a controller and a valve: they are closed. Loop {only} has no controller and needs no
    valve: its quantity is only watched. And loop {open} has a controller that acts on nothing: its valve has been
    forgotten, and in the plant the quantity would drift away.
    """
    tags = plant_tags(first, watched, lacking)
    rows = ["| loop | tags |", "|---|---|"]
    for n in range(int(first), int(first) + 4):
        rows.append(f"| {n} | {', '.join(tag for tag in tags if tag.endswith(str(n)))} |")
    closed = [str(first + n - 1) for n in range(1, 5) if n not in (watched, lacking)]
    return {
        "table": "\n".join(rows),
        "closed": "Loops " + " and ".join(closed),
        "only": str(first + watched - 1),
        "open": str(first + lacking - 1),
    }


# --- A.4 ----------------------------------------------------------------------------------------------------------

LINES = {"panel": "a solid line", "behind": "a dashed line", "field": "no line"}
FRAMES = {
    "shared": "The circle stands in a square",
    "discrete": "There is nothing around the circle",
    "computer": "In the place of the circle there is a hexagon",
}
WHERE = {"panel": "in the control room", "behind": "behind the panel", "field": "in the field"}
WHAT = {"shared": "shared display", "discrete": "own instrument", "computer": "computer function"}
WIRES = {
    "electrical signal": "a thin dashed line",
    "process connection": "a thin solid line without marks",
}


def _can_be(place, device, line):
    """Whether there is such an instrument: the process comes to what is beside it."""
    return line == "electrical signal" or (place == "field" and device == "discrete")


@exercise(
    "A.4",
    title="A symbol, described on the phone",
    points=2,
    where=_can_be,
    insight="The line across a symbol says where one goes to read it, its frame what kind of device it is, and the "
    "line that ends at it what comes from there.",
)
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
            WHERE[place],
            ["in the field", "in the control room", "behind the panel"],
            what="the place",
        ),
        device=word(
            WHAT[device],
            ["own instrument", "shared display", "computer function"],
            what="the kind of device",
        ),
        line=word(line, [*WIRES, "pipe"], what="what the line from below is"),
    )


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


@symbol.mistake("A line across a symbol means a panel. Does one run across this symbol, and which?")
def _(place):
    wrong = {"panel": "in the field", "behind": "in the field", "field": "behind the panel"}
    return {"place": wrong[place]}


@symbol.mistake("An own instrument is a circle alone. Is there anything else around the letters?")
def _(device):
    return {"device": "own instrument"} if device != "discrete" else {}


@symbol.mistake("A shared display has a square around its circle. Does your colleague see one?")
def _(device):
    return {"device": "shared display"} if device == "discrete" else {}


@symbol.mistake("A function of a computer is a hexagon. Does your colleague see one?")
def _(device):
    return {"device": "computer function"} if device == "discrete" else {}


symbol.hints(
    "A symbol says three things: where it is, what it is, and what is connected to it. Which stroke says which?",
    "A line across: solid in the control room, dashed behind the panel, none in the field. The frame: nothing, a "
    "square, or a hexagon. The line that ends at it: thick for material, thin for the process connection, with a mark "
    "or broken for signals.",
    'Draw it: "{frame}", with {across} across it, and {wire_low} from below. Compare with *Figures A.1 and A.2*.',
)


@symbol.shows
def _(place, device, line):
    return {
        "frame": FRAMES[device],
        "across": LINES[place],
        "wire": WIRES[line].capitalize(),
        "wire_low": WIRES[line],
    }


@symbol.solution
def _(place, device, line):
    """**Where?** Across the symbol runs {across}. A solid line is the front of the panel, seen from its edge, a dashed
    one its rear, and no line means that there is no panel. So it is {where}.

    **What?** {frame}. A circle alone is an instrument of its own, a square around it is a display that several loops
    share, a hexagon a function in a computer: {what}.

    **What comes from below?** The line is {wire_low}. Thick lines carry material; a thin one without marks is what the
    instrument feels of the process; a broken one is a signal in a wire. So it is: {line}.
    """
    return {"where": WHERE[place], "what": WHAT[device]}


@symbol.solution_picture
def _(place, device, letters):
    """The symbol as it was described."""
    return draw.symbol_table({decode(letters).words: draw.instrument(letters, place, device)})


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


@exercise(
    "A.5",
    title="All tags of a loop",
    points=4,
    insight="Five words of a sentence become five tags with one number; the alarm calls somebody, and the switch "
    "beyond it does not wait for him.",
)
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
    tag = loop_tags(quantity, n, alarm)[0]
    return {
        "what": what,
        "machine": machine,
        "side": SIDES[alarm],
        "number": str(n),
        "transmitter": f"`{tag}`",
        "letter": alarm,
    }


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


@whole_loop.mistake("What the controller is comes last, that it also indicates before. Which order has its tag?")
def _(quantity, n, alarm):
    transmitter, _, *others = loop_tags(quantity, n, alarm)
    return {"tags": [transmitter, f"{quantity}CI{n}", *others]}


@whole_loop.mistake("All instruments of a loop have the same number. One of yours has the next one.")
def _(quantity, n, alarm):
    return {"tags": [f"{quantity}T{n + 1}", *loop_tags(quantity, n, alarm)[1:]]}


@whole_loop.mistake("A V behind the letter of the quantity is the valve. What would a C behind it say?")
def _(quantity, n, alarm):
    first, second, _, *others = loop_tags(quantity, n, alarm)
    return {"tags": [first, second, f"{quantity}VC{n}", *others]}


@whole_loop.mistake("The loop measures and decides. With what does it act?")
def _(quantity, n, alarm):
    return {"tags": [tag for k, tag in enumerate(loop_tags(quantity, n, alarm)) if k != 2]}


@whole_loop.mistake("The machine is stopped, but nobody has been told before. What sounds at the first limit?")
def _(quantity, n, alarm):
    return {"tags": [tag for k, tag in enumerate(loop_tags(quantity, n, alarm)) if k != 3]}


@whole_loop.mistake("All instruments of a loop have the same number. One of yours has the next one.")
def _(quantity, n, alarm):
    first, second, _, *others = loop_tags(quantity, n, alarm)
    return {"tags": [first, second, f"{quantity}V{n + 1}", *others]}


@whole_loop.mistake("Alarm and switch are at two limits on one side. Which side does each of your tags name?")
def _(quantity, n, alarm):
    other = "L" if alarm == "H" else "H"
    return {"tags": [*loop_tags(quantity, n, alarm)[:4], f"{quantity}S{2 * other}{n}"]}


@whole_loop.mistake("Alarm and switch are at two limits on one side. Which side does each of your tags name?")
def _(quantity, n, alarm):
    first, second, third, _, last = loop_tags(quantity, n, alarm)
    other = "L" if alarm == "H" else "H"
    return {"tags": [first, second, third, f"{quantity}A{other}{n}", last]}


@whole_loop.mistake("The letter of the limit is the last one of a tag.")
def _(quantity, n, alarm):
    first, second, third, _, last = loop_tags(quantity, n, alarm)
    return {"tags": [first, second, third, f"{quantity}{alarm}A{n}", last]}


@whole_loop.mistake("Two of these are controllers, and the loop has one: which of them also indicates?")
def _(quantity, n, alarm):
    return {"tags": [*loop_tags(quantity, n, alarm), f"{quantity}C{n}"]}


@whole_loop.mistake("The loop is there. What else is said of the limits?")
def _(quantity, n, alarm):
    return {"tags": loop_tags(quantity, n, alarm)[:3]}


whole_loop.hints(
    "Read the sentence and underline each device. How many are there, and which numbers do they have?",
    "All begin with the letter of the quantity and end with the same number. Between them: T, what the controller is "
    "(it also indicates), V, an A with the side, and an S with the side, twice for the limit beyond the first one.",
    "The transmitter is {transmitter}. What is watched may become {side}: that is the letter {letter}. Four more tags.",
)


@whole_loop.solution
def _(quantity, n, alarm):
    """The sentence names five devices. All measure the same, and all have the number {number}.

    - The transmitter: {transmitter}.
    - The controller that also indicates: {controller}, with the I before the C.
    - The valve: {valve}.
    - The alarm at the limit that is {side}: {bell}, with the {letter} at the end.
    - The switch at the next limit on the same side: {switch}, with the {letter} twice.
    """
    names = ("transmitter", "controller", "valve", "bell", "switch")
    return {name: f"`{tag}`" for name, tag in zip(names, loop_tags(quantity, n, alarm), strict=True)}


@whole_loop.solution_picture
def _(quantity, n, alarm):
    """The loop on a drawing: transmitter, controller in the control room, valve, alarm and switch."""
    T, IC, V, A, S = loop_tags(quantity, n, alarm)
    layout = f"""
        in  tank  {T}  {IC}  {A}
        .   tank  {S}  .     .
        .   1     P1   {V}   out"""
    parts = {"tank": draw.tank(), "P1": draw.pump("P1"), V: draw.control_valve(V)}
    parts |= {IC: draw.instrument(IC, "panel"), A: draw.instrument(A, "panel", "shared")}
    wires = f"tank {T} {IC} {V}, {IC} {A}, tank {S} P1"
    return draw.instrumentation_diagram(layout, f"in tank 1 P1 {V} out", wires, parts)


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


# --- A.8 ----------------------------------------------------------------------------------------------------------

PROCESS = {"inlet": "pipe", "vessel": "vessel", "outlet": "pipe"}
OF_VESSEL = {"level": "L", "pressure": "P"}


def cascade(quantity, pipe, a, side, **other):
    """The connections of a cascade with an alarm, in which single lines may be other ones."""
    x, b = OF_VESSEL[quantity], a + 1
    lines = {
        "outer": f"vessel -> {x}T{a} -> {x}C{a}",
        "setpoint": f"{x}C{a} -> FC{b}",
        "inner": f"{pipe} -> FT{b} -> FC{b}",
        "valve": f"FC{b} -//-> FV{b} -> {pipe}",
        "alarm": f"{x}T{a} -> {x}A{side[0].upper()}{a}",
    }
    return "\n".join(line for line in (lines | other).values() if line)


def other_loop(a):
    """A loop that is an example of the notation."""
    n = a - 4
    return f"vessel -> TT{n} -> TC{n} -//-> TV{n} -> inlet\nTT{n} -> TI{n}"


def asked_diagram(quantity, pipe, a, side):
    """What A.8 asks."""
    also = {"inlet": ["inlet pipe", "in", "feed"], "vessel": ["tank", "drum"], "outlet": ["outlet pipe", "out"]}
    return instrument_diagram(cascade(quantity, pipe, a, side), PROCESS, "the instruments of the vessel", also)


@exercise(
    "A.8",
    title="Draw a cascade",
    points=3,
    insight="A P&I diagram is a list of connections before it is a drawing: what measures where, what tells whom, "
    "what acts where. Whoever can write the list can draw any loop.",
)
def drawing(
    quantity=choice(*OF_VESSEL),
    pipe=choice("outlet", "inlet"),
    a=between(11, 61, reference=21, step=2),
    side=choice("high", "low"),
):
    """The {quantity} of a vessel is kept by a cascade. The controller of the {quantity}, in loop {loop}, does not act
    on a valve: it gives the setpoint to the flow controller of loop {next}. That flow is measured in the {pipe}, and
    its controller throttles it with a valve in the same pipe. The signal to the valve is pneumatic, all others are
    electrical. The transmitter of the {quantity} also tells an alarm, which sounds when the {quantity} becomes too
    {side}. There is no separate indicator or recorder.

    Draw the diagram by its connections. The picture is an example of another loop, in these two lines:

    ```
    {example}
    ```

    Here `->` between two instruments is an electrical signal and `-//->` a pneumatic one. A place before an instrument
    says where it measures, and one behind a valve where it acts; the places are `inlet`, `vessel` and `outlet`. The
    response draws what you have written. In a notebook, put the lines between three quotes, or in a list.
    """
    return answers(diagram=asked_diagram(quantity, pipe, a, side))


@drawing.shows
def _(a):
    return {"loop": str(a), "next": str(a + 1), "example": other_loop(a)}


@drawing.mistake(
    "That is one loop, and it may work. But who keeps the flow when the pressure before the valve changes? The text "
    "has two controllers."
)
def _(quantity, pipe, a, side):
    x = OF_VESSEL[quantity]
    lines = dict(setpoint="", inner="", valve=f"{x}C{a} -//-> {x}V{a} -> {pipe}")
    return {"diagram": cascade(quantity, pipe, a, side, **lines)}


@drawing.mistake("Two controllers act on one valve. Which of them does what the other one tells it?")
def _(quantity, pipe, a, side):
    x = OF_VESSEL[quantity]
    return {"diagram": cascade(quantity, pipe, a, side, setpoint=f"{x}C{a} -//-> FV{a + 1}")}


@drawing.mistake(
    "In your cascade the fast loop gives the setpoint to the slow one. Which of the two quantities is the aim?"
)
def _(quantity, pipe, a, side):
    return {"diagram": cascade(quantity, pipe, a, side, setpoint=f"FC{a + 1} -> {OF_VESSEL[quantity]}C{a}")}


@drawing.mistake(
    "The flow is measured in the one pipe and throttled in the other: does this loop control what it measures?"
)
def _(quantity, pipe, a, side):
    wrong = {"inlet": "outlet", "outlet": "inlet"}[pipe]
    return {"diagram": cascade(quantity, pipe, a, side, inner=f"{wrong} -> FT{a + 1} -> FC{a + 1}")}


@drawing.mistake("What moves the valve is air on a diaphragm. Which mark has the line of such a signal?")
def _(quantity, pipe, a, side):
    return {"diagram": cascade(quantity, pipe, a, side, valve=f"FC{a + 1} -> FV{a + 1} -> {pipe}")}


@drawing.mistake("The alarm is connected to what makes the setpoint. Who knows first that the limit is passed?")
def _(quantity, pipe, a, side):
    x = OF_VESSEL[quantity]
    return {"diagram": cascade(quantity, pipe, a, side, alarm=f"{x}C{a} -> {x}A{side[0].upper()}{a}")}


@drawing.mistake(
    "The letter of a valve is that of the quantity which its own controller controls. Which controller has this valve?"
)
def _(quantity, pipe, a, side):
    x, b = OF_VESSEL[quantity], a + 1
    return {"diagram": cascade(quantity, pipe, a, side, valve=f"FC{b} -//-> {x}V{a} -> {pipe}")}


@drawing.mistake("The letters and the lines are right. Read again which number each of the two loops has.")
def _(quantity, pipe, a, side):
    x, b = OF_VESSEL[quantity], a + 1
    lines = [f"vessel -> {x}T{b} -> {x}C{b} -> FC{a} -//-> FV{a} -> {pipe}", f"{pipe} -> FT{a} -> FC{a}"]
    return {"diagram": "\n".join([*lines, f"{x}T{b} -> {x}A{side[0].upper()}{b}"])}


drawing.hints(
    "A loop is a chain: something is measured, a controller compares it with its setpoint, a valve acts. Which "
    "chain is inside the other one here?",
    "There are two transmitters, two controllers, one valve and one alarm. Each tag is the letter of what its loop "
    "measures, what the instrument does, and the number of the loop. The outer controller ends at the inner one.",
    "The inner loop is a chain that begins and ends in the {pipe}: transmitter, controller, valve. Its letter is F "
    "and its number {next}. Write it down, then the outer chain from the vessel to its controller, then the line "
    "between the two controllers.",
)


@drawing.solution
def _(quantity, pipe, a, side):
    """One chain at a time.

    *The outer loop* measures the {quantity} in the vessel: its letter is {x}, its number {loop}. Transmitter and
    controller are `{outer}`.

    *The inner loop* measures the flow in the {pipe} and throttles it there. All its instruments have the letter F and
    the number {next}, the valve too: it belongs to the controller that moves it. Air moves the valve, so its signal is
    pneumatic.

    ***

    *Between the two*, the outer controller gives the setpoint to the inner one. And the alarm hears the transmitter,
    not the controller, since a limit is passed whatever the controller does:

    ```
    {all}
    ```
    """
    x = OF_VESSEL[quantity]
    return {"x": x, "outer": f"vessel -> {x}T{a} -> {x}C{a}", "all": cascade(quantity, pipe, a, side)}


@drawing.picture
def _(quantity, pipe, a, side):
    """A vessel with its inlet and its outlet: a temperature is measured in the vessel, its controller acts on a valve
    in the inlet by a pneumatic signal, and an indicator shows it."""
    n = a - 4
    layout = f"""
        .   1      TC{n}   .      .    .
        .   .      .       .      .    .
        .   .      TT{n}   .      .    TI{n}
        in  TV{n}  vessel  vessel out  ."""
    parts = {f"TV{n}": draw.control_valve(f"TV{n}"), "vessel": draw.vessel()}
    names = {"in": "inlet", "out": "outlet"}
    signals, air = f"vessel TT{n} TC{n}, TT{n} TI{n}", {"pneumatic": f"TC{n} 1 TV{n}"}
    return draw.instrumentation_diagram(layout, f"in TV{n} vessel out", signals, parts, names, lines=air)


@drawing.solution_picture
def _(quantity, pipe, a, side):
    """The cascade: the transmitter and controller above the vessel, the flow loop at the {pipe}, and the alarm."""
    return drawn(connections(asked_diagram(quantity, pipe, a, side).key), PROCESS)
