"""P&I diagrams, written as connections and judged by their structure."""

from __future__ import annotations

import re
from collections.abc import Iterable, Iterator, Mapping
from typing import TYPE_CHECKING, Any

from exercisebook.grammar import LONGEST, Unreadable, shortened
from exercisebook.kinds.kind import AS_IT_IS, LINES, Kind, Tried
from exercisebook.reading import alone, answered, in_a_row
from loopbook.exercises.connections import ELECTRICAL, PNEUMATIC, TAG, Connection, connections
from loopbook.instruments import Tag, decode
from plainmath.validation import did_you_mean

if TYPE_CHECKING:
    from loopbook.figures import Picture

MOST_CONNECTIONS = 60

_ARROW = re.compile(
    r"\s*(?:(?P<pneumatic>[-=]*\s*//\s*[-=]*>?|~+>|-*\s*\(?pneumatic\)?\s*-*>)|-*\s*\(?electrical\)?\s*-*>|[-=]+>|--+)\s*",
    re.IGNORECASE,
)
_SIGNS = str.maketrans({"–": "-", "—": "-", "−": "-", "→": "->", "⇒": "->", "←": "<-", "⫽": "//", "\xa0": " "})
_BACK = re.compile(r"(<\s*[-=~/]+(?:\s*//\s*-+)?)")
#: What is said of a signal behind the instrument that it goes to.
_NOTE = re.compile(r" \((pneumatic|electrical|setpoint|set point|measurement|signal|cascade)\)\s*$")
_AT = re.compile(r"(?i)^(.+?)(?:\s*:\s*|\s+(?:measures(?: at| in)?|is in|sits in|acts on|at|in|on)\s+)(?:the )?(.+)$")
#: What an instrument does, the strongest first.
ROLES = ("valve", "controller", "switch", "alarm", "secure control", "function", "transmitter", "indicator")


class InstrumentDiagram(Kind):
    """The instruments of a plant and their connections, from lines such as "vessel -> LT1 -> LC1 -> LV1 -> outlet".

    Arguments:
        key: the connections that are asked, in the same notation; ``-//->`` is a pneumatic signal.
        places: the parts of the process in the order of the flow, ``{name: "pipe" or "vessel"}``.
        what: the diagram in words.
        also: ``{place: other names}``.

    >>> asked = InstrumentDiagram("vessel -> LT1 -> LC1 -> LV1 -> outlet", {"vessel": "vessel", "outlet": "pipe"})
    >>> asked.agrees(asked.read("lt-1 → LIC-1; LT-1: vessel; LIC-1 → LV 1; LV-1 in outlet")[0])
    True
    >>> asked.hint(asked.read("vessel -> LT1 -> LC1 -> FV1 -> outlet")[0])
    'FV1 begins with F, for flow: a valve has the letter of what its loop controls, whatever flows through it'
    """

    FORM = ("places", "also")
    expected = "connections such as 'vessel -> LT1 -> LC1 -> LV1 -> outlet'"
    accuracy = ""
    draws = True

    def __init__(
        self,
        key: object,
        places: Mapping[str, str],
        what: str = "the diagram",
        also: Mapping[str, Iterable[str]] | None = None,
    ):
        self.places, self.also = dict(places), also
        super().__init__(key, "", what, 0)

    @property
    def asked(self) -> str:
        """The diagram with its places."""
        return f"{self.what}, as lines of connections; its places are {', '.join(f'`{one}`' for one in self.places)}"

    # -------------------------------------------------------------------------------------------------------- reading

    def read(self, given: object) -> tuple[str, str]:
        """Return the connections, each once, in an order of their own."""
        given = alone(answered(given))
        lines = [given] if isinstance(given, str) else in_a_row(given)
        lines = [_from_pair(line) for line in lines or ()]
        if not lines or not all(isinstance(line, str) for line in lines):
            raise Unreadable(f"this is not a diagram: expected {self.expected}")
        if sum(map(len, lines)) > LONGEST:
            raise Unreadable(f"the text is very long: expected at most {LONGEST} characters")
        lines = [line.translate(_SIGNS) for line in lines]
        parts = [part.strip() for line in lines for part in re.split(r"[;\n]|,(?=[^)]*$)", line) if part.strip(" .")]
        parts = _with_starts([_forwards(part) for part in parts])
        found = [one for number, part in enumerate(parts, start=1) for one in self._line(number, part)]
        if not found:
            raise Unreadable(f"the diagram is empty: expected {self.expected}")
        if len(found) > MOST_CONNECTIONS:
            raise Unreadable(f"there are {len(found)} connections: expected at most {MOST_CONNECTIONS}")
        kinds: dict[tuple[str, str], str] = {}
        for one in found:
            if kinds.setdefault((one.start, one.end), one.kind) != one.kind:
                raise Unreadable(f"the signal from {one.start} to {one.end} is of two kinds: expected one of them")
        return "; ".join(str(Connection(*pair, kind)) for pair, kind in sorted(kinds.items())), ""

    def _line(self, number, part):
        """The connections of one line."""
        part = re.sub(r"^\s*(?:[-*•]\s+(?!>)|\d+[.)]\s+)", "", part).strip(" .")
        try:
            arrows = list(_ARROW.finditer(part))
            if not arrows:
                if not (at := _AT.match(part)):
                    raise Unreadable(f"there is no arrow: expected {self.expected}")
                names, kinds = [self._name(at[1]), self._name(at[2])], [ELECTRICAL]
            else:
                bounds = [0, *(x for arrow in arrows for x in arrow.span()), len(part)]
                texts = [part[begin:end] for begin, end in zip(bounds[::2], bounds[1::2], strict=True)]
                notes = [_NOTE.search(text) for text in texts]
                names = [self._name(_NOTE.sub("", text)) for text in texts]
                kinds = [_kind(arrow, note and note[1]) for arrow, note in zip(arrows, notes[1:], strict=True)]
            return [self._connection(*pair) for pair in zip(names, names[1:], kinds, strict=False)]
        except Unreadable as problem:
            raise Unreadable(f"connection {number}, '{shortened(part, 50)}': {problem}") from None

    def _name(self, text):
        """A place, or a tag as FC101."""
        plain = _bare(text)
        for place in self.places:
            if plain in {_bare(name) for name in (place, *(self.also or {}).get(place, ()))}:
                return place
        match = TAG.fullmatch(text.strip(" .()[]'\"`"))
        if not match:
            if re.fullmatch(r"[A-Z]{2,4}", text.strip()):
                raise Unreadable(f"{text.strip()} has no number: expected that of its loop, as in {text.strip()}101")
            raise Unreadable(f"{shortened(text.strip(), 30)!r} is neither a tag nor a place: "
                             f"{did_you_mean(text.strip(), self.places)}")  # fmt: skip
        tag = "".join(match.groups()).upper()
        try:
            decode(tag)
        except ValueError as error:
            raise Unreadable(str(error)) from None
        return tag

    def _connection(self, start, end, kind):
        if start in self.places and end in self.places:
            raise Unreadable(f"{start} and {end} are both parts of the process: expected an instrument between them")
        if start == end:
            raise Unreadable(f"{start} is connected to itself")
        if start not in self.places and end not in self.places:
            return Connection(start, end, kind)
        # where an instrument is, whichever end is named first: a valve acts on its place, others measure there
        place, tag = (start, end) if start in self.places else (end, start)
        acts = role_of(decode(tag)) in ("valve", "controller")
        return Connection(tag, place) if acts else Connection(place, tag)

    # -------------------------------------------------------------------------------------------------------- judging

    def agrees(self, answer: str) -> bool:
        """Whether instruments, places and connections are those that are asked."""
        return not self.hint(answer)

    def hint(self, answer: str) -> str:
        """Say what is missing or connected to the wrong thing, the first fault of each kind."""
        return next(iter(self.faults(answer)), "")

    def faults(self, answer: str) -> Iterator[str]:
        """The faults of a diagram, in sentences, the deepest first."""
        given, asked = connections(answer), connections(self.key)
        tags, wanted = self._tags(given), self._tags(asked)
        as_asked = _matched(tags, wanted)
        yield from self._wrong_tags(tags, wanted, as_asked)
        found = {Connection(as_asked.get(x.start, x.start), as_asked.get(x.end, x.end), x.kind): x for x in given}
        yield from self._wrong_places(found, asked)
        yield from self._wrong_signals(found, asked)

    def _tags(self, found):
        return list(dict.fromkeys(name for one in found for name in (one.start, one.end) if name not in self.places))

    def _wrong_tags(self, tags, wanted, as_asked):
        """Instruments that are missing, or have another letter or number, and those that are too many."""
        missing = [tag for tag in wanted if tag not in as_asked.values()]
        others = [tag for tag in tags if tag not in as_asked]
        for tag in missing:
            meant = decode(tag)
            role = role_of(meant)
            # the one of its kind that has the same letter, or the same number, or none of the two
            alike = sorted(
                (one for one in others if role_of(decode(one)) == role),
                key=lambda one: (decode(one).loop != meant.loop, decode(one).measured != meant.measured),
            )
            if not alike:
                beside = [one for one in others if _letters(one) == _letters(tag) and decode(one).loop == meant.loop]
                if beside:
                    yield f"{beside[0]} is {_article(decode(beside[0]))}; what else must be done with this quantity?"
                yield f"something is missing: there is no {_plain(meant)} in loop {meant.loop}"
                continue
            one = alike[0]
            others.remove(one)
            yield self._wrong_tag(decode(one), meant, role)
        for one in others:
            yield f"{one} is not asked for: the text names no {_plain(decode(one))}" + (
                f" in loop {decode(one).loop}" if decode(one).loop else ""
            )

    @staticmethod
    def _wrong_tag(given, meant, role):
        tag, begins = given.text, f"{given.text} begins with {given.text[0]}, for {given.measured}"
        if _letters(tag) != _letters(meant.text):
            if role == "valve":
                return f"{begins}: a valve has the letter of what its loop controls, whatever flows through it"
            return f"{begins}: is that what is to be {_DONE.get(role, 'read')}?"
        if given.loop != meant.loop:
            return f"{tag} has the number {given.loop}: which loop does it belong to, and what is its number?"
        if given.limit != meant.limit:
            if not given.limit:
                return f"{tag} does not say at which limit it reacts: which letter does?"
            return f"{tag} reacts when the {given.measured} is {given.limit}: is that the side of the text?"
        return f"{tag} is not what is asked: {meant.measured} needs another function there"

    def _located(self, found):
        """The pairs of an instrument and its place."""
        pairs = ((x.end, x.start) if x.start in self.places else (x.start, x.end) for x in found)
        return [(tag, place) for tag, place in pairs if place in self.places]

    def _wrong_places(self, found, asked):
        """Instruments that are nowhere, or somewhere else."""
        names, here, wanted = _names(found), self._located(found), self._located(asked)
        for tag, place in wanted:
            name, acts = names.get(tag, tag), role_of(decode(tag)) == "valve"
            others = [other for one, other in here if one == tag]
            if not others:
                does = "acts" if acts else "measures"
                yield f"nothing says where {name} {does}: connect it to its place in the process"
            elif place not in others:
                asks = "which flow should it throttle" if acts else f"which {decode(tag).measured} is meant"
                yield f"{name} is in the wrong place, '{others[0]}': {asks}?"
        for tag, place in here:
            if (tag, place) not in wanted and role_of(decode(tag)) == "controller":
                yield f"{names[tag]} acts on '{place}' itself: what moves there?"
            elif (tag, place) not in wanted:
                yield f"{names[tag]} is connected to '{place}', which is not asked"

    def _wrong_signals(self, found, asked):
        """Signals that go to the wrong instrument, are missing, or are of the wrong kind."""
        names = _names(found)
        pairs = {(x.start, x.end): x.kind for x in asked if not {x.start, x.end} & {*self.places}}
        given = {(x.start, x.end): x.kind for x in found if not {x.start, x.end} & {*self.places}}
        for start, end in given:
            if (start, end) not in pairs:
                yield self._wrong_signal(start, end, pairs, names)
        for start, end in pairs:
            if (start, end) not in given:
                a, b = names.get(start, start), names.get(end, end)
                roles = role_of(decode(start)), role_of(decode(end))
                if roles == ("controller", "controller"):
                    yield f"nothing connects {a} and {b}: from where does the inner loop have its setpoint?"
                elif roles[1] == "controller":
                    yield f"{b} has no measurement: no signal of {a} comes to it"
                elif roles[0] == "controller":
                    yield f"{a} acts on nothing: its signal does not come to {b}"
                else:
                    yield f"no signal comes to {b}: which instrument tells it the {decode(end).measured}?"
        for pair, kind in pairs.items():
            if pair in given and given[pair] != kind:
                a, b = (names.get(x, x) for x in pair)
                yield f"the signal from {a} to {b} is {given[pair]} in your diagram: what kind does {b} need?"

    @staticmethod
    def _wrong_signal(start, end, pairs, names):
        a, b = names.get(start, start), names.get(end, end)
        roles = role_of(decode(start)), role_of(decode(end))
        if (end, start) in pairs:
            return f"the signal between {b} and {a} goes the other way: which of the two knows something first?"
        if roles == ("transmitter", "valve"):
            return f"{a} is connected to {b} itself: what compares the measurement with the setpoint?"
        if roles == ("controller", "valve"):
            return f"{a} should not act on {b} itself: which controller has this valve?"
        if roles == ("transmitter", "controller"):
            return f"{a} is connected to {b}: is the {decode(start).measured} what this controller controls?"
        return f"{a} is connected to {b}, which is not asked: follow the signal from the measurement to the valve"

    # -------------------------------------------------------------------------------------------------------- drawing

    def written(self, answer: str) -> str:
        """The connections in one line."""
        return answer

    def picture(self, answer: str) -> Picture | None:
        """The P&I diagram of what was given."""
        from loopbook.exercises.diagram_layout import drawn

        return drawn(connections(answer), self.places, "Your diagram, as it was read")

    @property
    def field(self) -> dict[str, Any]:
        """Lines."""
        says = (
            "A line for each connection, or several in one, as `vessel -> LT1 -> LC1 -> LV1 -> outlet`; "
            "a pneumatic signal is `-//->`."
        )
        return {"control": LINES, "asked": self.asked.replace(", as lines of connections", ""), "help": says}

    def right_forms(self) -> Iterator[Tried]:
        """The diagram as a list of connections."""
        yield AS_IT_IS, self.key
        yield "as a list of connections", self.key.split("; ")

    def wrong_forms(self) -> Iterator[Tried]:
        """The first connection alone."""
        first, *more = self.key.split("; ")
        if more:
            yield "its first connection alone", first


_DONE = {"transmitter": "measured", "controller": "controlled", "alarm": "watched", "switch": "watched"}


def _names(found):
    """The names that a reader has given to the instruments that are asked."""
    return {name: own for x, given in found.items() for name, own in ((x.start, given.start), (x.end, given.end))}


def role_of(tag: Tag) -> str:
    """What an instrument is in its loop: "transmitter", "controller", "valve"; an indicating controller controls."""
    return next((role for role in ROLES if role in tag.functions), tag.functions[-1])


def _matched(tags, wanted):
    """``{tag: the asked one}`` of those that are the same but for letters that only show: TIC1 is TC1."""
    found = {tag: tag for tag in tags if tag in wanted}
    for tag in tags:
        for other in wanted:
            same = _letters(tag) == _letters(other) and decode(tag).loop == decode(other).loop
            same = same and role_of(decode(tag)) == role_of(decode(other)) and decode(tag).limit == decode(other).limit
            if same and tag not in found and other not in found.values():
                found[tag] = other
    return found


def _letters(tag):
    """The letters of what is measured."""
    return "".join(part.letter for part in (*decode(tag).at("first letter"), *decode(tag).at("modifier")))


def _plain(tag):
    return f"{tag.limit} {tag.measured} {tag.modifier} {role_of(tag)}".replace("  ", " ").strip()


def _article(tag):
    words = tag.words.partition(" of loop")[0]
    return f"an {words}" if words[0] in "aeiou" else f"a {words}"


def _bare(text):
    words = re.sub(r"[\s_-]+", " ", text.casefold()).strip(" .:()[]'\"`").removeprefix("the ")
    return re.sub(r"\b(pipe|line)\b", "", words).strip() or words


def _kind(arrow, note):
    """The kind of a signal by its arrow and by what is said behind it."""
    if arrow["pneumatic"] and note == ELECTRICAL:
        raise Unreadable("its arrow is that of a pneumatic signal, and it is called electrical: expected one of them")
    return PNEUMATIC if arrow["pneumatic"] or note == PNEUMATIC else ELECTRICAL


def _from_pair(line):
    """A connection that is given as its two ends, and perhaps its kind, in a line of text."""
    if isinstance(line, tuple | list) and 2 <= len(line) <= 3 and all(isinstance(end, str) for end in line):
        return f"{line[0]} {'-//->' if PNEUMATIC in line[2:] else '->'} {line[1]}"
    return line


def _forwards(part):
    """A line whose arrows all point back, turned round."""
    if ">" in part or not _BACK.search(part):
        return part
    pieces = [piece if k % 2 == 0 else ("-//->" if "/" in piece or "~" in piece else "->")
              for k, piece in enumerate(_BACK.split(part))]  # fmt: skip
    return " ".join(piece.strip() for piece in reversed(pieces))


def _with_starts(parts):
    """The lines, where a name alone goes on from the start of the last arrow: "PT1 -> PC1, PAH1"."""
    found: list[str] = []
    for part in parts:
        arrows = list(_ARROW.finditer(found[-1])) if found else []
        if arrows and TAG.fullmatch(part.strip(" .")):
            begin = arrows[-2].end() if len(arrows) > 1 else 0
            part = f"{found[-1][begin : arrows[-1].start()]} -> {part}"
        found.append(part)
    return found
