"""Words from a list, one or several."""

from __future__ import annotations

import difflib
import hashlib
import re
from collections.abc import Iterable, Iterator, Sequence
from typing import Any, Self

import sympy
from sympy.logic.boolalg import BooleanAtom

from exercisebook.grammar import Unreadable, shortened
from exercisebook.kinds.kind import AS_IT_IS, NONE, ONE, ORDER, SEVERAL, Kind, Tried
from exercisebook.reading import alone, answered, in_a_row, members

#: What is usually said for the same, a set for each; see `also_said`.
SAME: list[frozenset[str]] = []
#: A longer text names no option; in a shorter word a letter makes another word, as of "not" the word "now".
LONGEST, SHORTEST_WITH_A_SLIP = 200, 5
_ARTICLE = re.compile(r"\b(?:an?|the)\s+(?=\w\w)")
#: What two words may have between them or not; between digits it separates numbers.
_BETWEEN = re.compile(r"(?<=[^\W\d])[\s_‐‑-]+(?=\w)|(?<=\w)[\s_‐‑-]+(?=[^\W\d])")
_NONE = re.compile(r"none(?: of them| of these)?|nothing|no one|not any|no(?: \w+)?|[-–∅]|\[\]", re.IGNORECASE)
#: What denies the words of a sentence, turns them, or leaves them open.
_DENIED = re.compile(
    r"\b(?:not|no|never|neither|nor|without|less|more|or|but|instead|rather|opposite|if|either|both|un|non|hardly|marginally|almost|nearly)\b"
    r"|n't|\?"
)
#: Words of a sentence that name nothing, and endings of words of some letters.
_FILLING = re.compile(r"an?|the|its?|is|are|be|to|of|at|in|on|that|this|which|with|will|would|must|for|so|by|and")
_ENDING = re.compile(r"(?<=..)(?:ing|ed|es|s|ly|e)$")
#: An option of one word is known from so many letters of its beginning.
SHORTEST_BEGINNING = 3
_ONLY = re.compile(r"^(?:only|just|solely) ", re.IGNORECASE)
_COUNTED = re.compile(r"(\D*)(\d+(?:\.\d+)?)(\D*)")
_TRUTH = {True: "yes", False: "no"}
_SEPARATOR = re.compile(r"[,;&\n]|[-=]>|→|\b(?:and|then|und|plus)\b|(?<=\w)\s?/\s?(?=\w)|(?<=\w)\s?\+\s?(?=\w)")


class Word(Kind):
    """One word of several; case, spaces, hyphens and articles make no difference, and usual other words are read.

    >>> moves = Word("to the left", ["to the left", "to the right"], "the way in which it moves")
    >>> moves.agrees(moves.read(" To the Left")[0])
    True
    """

    def __init__(self, key: object, among: Iterable[str], what: str = "the word"):
        self.among = tuple(among)
        _check_key([key], self.among, what)
        super().__init__(key, "", what, 0)

    @property
    def asked(self) -> str:
        """The quantity with its words."""
        return f"{self.what}: {_either(self.among)}"

    @property
    def expected(self) -> str:
        """The words."""
        return _either(self.among)

    accuracy = ""
    FORM = ("among",)

    def shuffled(self, text: str) -> Self:
        """Return the quantity with its words in an order drawn from a text."""
        return _shuffled(self, text)

    def read(self, given: object) -> tuple[str, str]:
        """Return the word as it stands in the list, and a remark where another one was given for it."""
        return _word(answered(given), self.among, self.expected)

    def written(self, answer: str) -> str:
        """The word."""
        return answer

    def agrees(self, answer: str) -> bool:
        """Whether it is the word."""
        return answer == self.key

    @property
    def field(self) -> dict[str, Any]:
        """A choice of one."""
        return {"control": ONE, "words": self.among}

    def right_forms(self) -> Iterator[Tried]:
        """The word in capital letters, and with spaces."""
        yield AS_IT_IS, self.key
        yield "in capital letters", self.key.upper()
        yield "with spaces", f" {self.key} "


class Words(Kind):
    """Several words of a list, in any order or in one.

    >>> steps = Words(["S2", "S4"], ["S1", "S2", "S3", "S4"], "the active steps")
    >>> steps.agrees(steps.read("s4, s2")[0])
    True
    """

    def __init__(self, key: Iterable[object], among: Iterable[str], what: str = "the words", ordered: bool = False):
        self.among, self.ordered = tuple(among), ordered
        key = list(key)
        _check_key(key, self.among, what)
        super().__init__(key, "", what, 0)

    @property
    def asked(self) -> str:
        """The quantity with its words."""
        order = "in their order, out of" if self.ordered else "those of"
        return f"{self.what}, {order} {', '.join(self.among)}"

    @property
    def expected(self) -> str:
        """A list of words."""
        return f"a list of words out of {', '.join(self.among)}"

    accuracy = ""
    FORM = ("among", "ordered")

    def shuffled(self, text: str) -> Self:
        """Return the quantity with its words in an order drawn from a text."""
        return _shuffled(self, text)

    def read(self, given: object) -> tuple[list[str], str]:
        """Return the words as they stand in the list, and a remark where others were given for them."""
        if isinstance(answered(given), str) and _NONE.fullmatch(given.strip()) and NONE not in self.among:
            given = []
        elif isinstance(given, str):
            parts = self._parts(_ONLY.sub("", given.strip(" []{}")))
            given = [part.strip() for part in parts if part.strip()]
        is_set = isinstance(given, set | frozenset)
        row = members(given) if is_set else in_a_row(given)
        if row is None:
            raise Unreadable(f"this is not a list: expected {self.expected}")
        if self.ordered and is_set:
            raise Unreadable(f"a set has no order: expected {self.expected}")
        read = [_word(word, self.among, self.expected) for word in row]
        words, remarks = [word for word, _ in read], [remark for _, remark in read if remark]
        said = ", ".join([remarks[0], *(remark.removeprefix("read as ") for remark in remarks[1:])]) if remarks else ""
        return words if self.ordered else sorted(set(words), key=self.among.index), said

    def written(self, answer: list[str]) -> str:
        """The words, or that there are none."""
        return ", ".join(answer) or "none of them"

    def _parts(self, text):
        """The parts of a text, between separators, or one word or letter after the other."""
        if _spelled(text, [word for word in self.among if " " in word or _SEPARATOR.search(word)]):
            return [text]
        if _SEPARATOR.search(text):
            return _SEPARATOR.split(text)
        letters = re.sub(r"[\s-]", "", text)
        if all(len(word) == 1 for word in self.among) and set(letters) <= set(self.among):
            return list(letters)
        return [text] if any(" " in word for word in self.among) else text.split()

    def agrees(self, answer: list[str]) -> bool:
        """Whether they are the words."""
        return answer == self.key

    def mistakes(self) -> Iterator[tuple[str, list[str]]]:
        """The opposite order."""
        if self.ordered and len(self.key) > 1:
            yield "the words are right, in the opposite order", self.key[::-1]

    @property
    def field(self) -> dict[str, Any]:
        """A choice of several or of none, or a line for words in their order."""
        if self.ordered:
            return {"control": ORDER, "words": self.among, "help": "in their order, with commas between them"}
        none = () if NONE in self.among else (NONE,)
        return {"control": SEVERAL, "words": (*self.among, *none), "help": "one, several, or none of them"}

    def right_forms(self) -> Iterator[Tried]:
        """The words as a text, and in another order where that is no question."""
        yield AS_IT_IS, self.key
        yield "as text", ", ".join(self.key)
        if not self.ordered:
            yield "in another order", self.key[::-1]

    def wrong_forms(self) -> Iterator[Tried]:
        """None of the words, and all of them."""
        found = {"no word": [], "all words": list(self.among)}
        yield from ((how, answer) for how, answer in found.items() if answer != self.key)


def _check_key(words, among, what):
    """Refuse a key that is none of the words, however near it is to one."""
    for word in words:
        if isinstance(word, str) and bare(word) not in map(bare, among):
            raise ValueError(f"the key of {what} is {word!r}: expected one of {', '.join(among)}")


def in_drawn_order(words: Iterable[str], text: str) -> tuple[str, ...]:
    """Return words in an order drawn from a text; the one in which they come leaves no trace.

    Words that count, as numbers, letters, or S1, S2, S3, count up, and yes comes before no.

    >>> in_drawn_order(["direct", "reverse"], "Ada") == in_drawn_order(["reverse", "direct"], "Ada")
    True
    >>> in_drawn_order(["S10", "S2"], "Ada"), in_drawn_order(["no", "yes"], "Ada")
    (('S2', 'S10'), ('yes', 'no'))
    """
    words = tuple(words)
    if set(words) == set(_TRUTH.values()):
        return tuple(_TRUTH.values())
    parts = [_COUNTED.fullmatch(word) for word in words]
    if all(parts) and len({(part[1], part[3]) for part in parts}) == 1:
        return tuple(sorted(words, key=lambda word: float(_COUNTED.fullmatch(word)[2])))
    if all(len(word) == 1 for word in words):
        return tuple(sorted(words))
    return tuple(sorted(words, key=lambda word: hashlib.sha256(f"{text}|{word}".encode()).digest()))


def _shuffled(kind, text):
    other = kind.like(kind.key)
    other.among = in_drawn_order(kind.among, text)
    other.key = other.read(kind.key)[0]  # a list of words follows the order in which they are listed
    return other


def _word(given, among, expected):
    given = alone(given)
    if isinstance(given, bool | BooleanAtom):
        if not {*_TRUTH.values()} <= {*among}:
            raise Unreadable(f"{given} is a truth value: expected {expected}")
        given = _TRUTH[bool(given)]
    elif isinstance(given, int | float | sympy.Number) and f"{float(given):g}" in among:
        given = f"{float(given):g}"
    if not isinstance(given, str):
        raise Unreadable(f"this is not text: expected {expected}")
    meant = named(given, among)
    if meant is None:
        raise Unreadable(f"{shortened(given, 40)!r} is none of the words: expected {expected}")
    return meant, "" if bare(given) == bare(meant) else f'read as "{meant}"'


def also_said(*rows: str) -> None:
    """Say which words mean the same.

    Arguments:
        rows: words with commas between them; none is in a row with one that says the opposite.
    """
    SAME.extend(frozenset(map(bare, row.split(","))) for row in rows)


def named(given: str, among: Sequence[str]) -> str | None:
    """Return the option that a text is: spelled in any way, as a usual other word, or with one slip of the keyboard.

    None where it is none, or may be several. Of a sentence it is the only one in it, unless something is denied there.

    >>> named("Set-point", ["set point", "load"]), named("increases", ["up", "down"])
    ('set point', 'up')
    >>> named("not up", ["up", "down"]), named("sinle beam", ["frame", "single beam"])
    (None, 'single beam')
    >>> named("It must be tuned at B.", ["A", "B"]), named("a load lowering it", ["a load that lowers it", "noise"])
    ('B', 'a load that lowers it')
    """
    is_denied = re.match(r"\s*(?:[¬!~≠/]|<>)", given)  # not stable, as programs write it
    found = [] if len(given) > LONGEST or is_denied else _spelled(given, among) or _in_a_sentence(given, among)
    return found[0] if len(found) == 1 else None


def _spelled(given, among):
    """The options that a text is, spelled in any way."""
    text = bare(given)
    if exact := [option for option in among if bare(option) == text][:1]:
        return exact
    if NONE in among and _NONE.fullmatch(given.strip()):
        return [NONE]
    meant = [option for option in among if any({bare(option), text} <= row for row in SAME)]
    return meant or [option for option in among if _has_a_slip(given, option)]


def _in_a_sentence(given, among):
    """The options of which all words are in a sentence, or else those of which all are but such as others have, too."""
    said, begun = _stems(given), given.strip(" .").casefold()
    options = {one: _stems(one) for one in among}
    found = [one for one, stems in options.items() if stems and stems <= said]
    if re.search(r"\d", "".join(among)):  # V1 is another valve than V1 2
        found = [one for one in found if not any(word[0].isdigit() for word in said - options[one])]
    found = [one for one in found if not any(options[one] < options[other] for other in found)]
    shared = {one: set().union(*(options[other] for other in among if other != one)) for one in among}
    found = found or [one for one, stems in options.items() if said and said <= stems <= said | shared[one]]
    if not found and len(begun) >= SHORTEST_BEGINNING:
        found = [one for one in among if " " not in one and one.casefold().startswith(begun)]
    is_denied = len(found) == 1 and {*_DENIED.findall(found[0].casefold())} != {*_DENIED.findall(begun)}
    return [] if is_denied else found


def _stems(text):
    """The words of a text that say something, without their endings; of single letters the case counts."""
    words = re.findall(r"[^\W_]+(?:[/.][^\W_]+)*", text)
    return {
        word if len(word) == 1 else _ENDING.sub("", word.casefold()) for word in words if not _FILLING.fullmatch(word)
    }


def bare(text: str) -> str:
    """Return a text without what makes no difference: case, articles, spaces, hyphens, quotes and a full stop.

    >>> bare("the Set-point."), bare("V_1"), bare("-1"), bare("21 22")
    ('setpoint', 'v1', '-1', '21 22')
    """
    return _BETWEEN.sub("", _plain(text)) or text


def _plain(text):
    return _ARTICLE.sub("", " ".join(text.casefold().split()).strip(" '\"`*.,;:!()"))


def _has_a_slip(typed, option):
    """Whether of one word a letter, and not the first one, is missing, too many or another one, or two are swapped."""
    words = [re.split(r"[\s_‐‑-]+", _plain(text)) for text in (typed, option)]
    pairs = [pair for pair in zip(*words, strict=False) if len(set(pair)) == 2]
    if len(words[0]) != len(words[1]) or len(pairs) != 1:
        return False
    short, long = sorted(pairs[0], key=len)
    if len(short) < SHORTEST_WITH_A_SLIP or short[0] != long[0] or not (short + long).isalpha():
        return False  # a number in it makes it a tag, of which one sign more is another one
    blocks = difflib.SequenceMatcher(None, short, long, autojunk=False).get_matching_blocks()
    return sum(block.size for block in blocks) >= len(long) - 1


def _either(words):
    return f"{', '.join(words[:-1])} or {words[-1]}"


also_said(
    "up, raise, raises, rises, increase, increases, higher, goes up, upwards",
    "down, lower, lowers, falls, decrease, decreases, reduce, goes down, downwards, drops, sinks",
    "larger, greater, bigger, higher, increased",
    "smaller, lower, less, reduced, decreased",
    "yes, true, y",
    "no, false, n",
    "none, nothing",
    "as it was, unchanged, the same, no change",
    "too long, too large, longer",
    "too short, too small, shorter",
)
