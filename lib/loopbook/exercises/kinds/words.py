"""Words from a list, one or several."""

from collections import Counter

from loopbook.exercises.kinds.kind import Kind, answered
from loopbook.exercises.reading import Unreadable

_TRUTH = {True: "yes", False: "no"}


class Word(Kind):
    """One word of several; upper and lower case are alike.

    >>> action = Word("reverse", ["reverse", "direct"], "the action of the controller")
    >>> action.agrees(action.read(" Reverse")[0])
    True
    """

    def __init__(self, key, among, what="the word"):
        self.among = tuple(among)
        super().__init__(key, "", what, 0)

    @property
    def asked(self):
        """The quantity with its words."""
        return f"{self.what}: {_either(self.among)}"

    @property
    def expected(self):
        """The words."""
        return _either(self.among)

    accuracy = ""

    def read(self, given):
        """Return the word as it stands in the list."""
        return _word(answered(given), self.among, self.expected), ""

    def agrees(self, answer):
        """Whether it is the word."""
        return answer == self.key


class Words(Kind):
    """Several words of a list, in any order or in one.

    >>> steps = Words(["S2", "S4"], ["S1", "S2", "S3", "S4"], "the active steps")
    >>> steps.agrees(steps.read("s4, s2")[0])
    True
    """

    def __init__(self, key, among, what="the words", ordered=False):
        self.among, self.ordered = tuple(among), ordered
        super().__init__(list(key), "", what, 0)

    @property
    def asked(self):
        """The quantity with its words."""
        order = "in their order, out of" if self.ordered else "those of"
        return f"{self.what}, {order} {', '.join(self.among)}"

    @property
    def expected(self):
        """A list of words."""
        return f"a list of words out of {', '.join(self.among)}"

    accuracy = ""

    def read(self, given):
        """Return the words as they stand in the list."""
        if isinstance(answered(given), str):
            single = "," not in given and all(len(word) == 1 for word in self.among)
            given = [part for part in (given if single else given.split(",")) if part.strip()]
        if not isinstance(given, list | tuple | set | frozenset):
            raise Unreadable(f"this is no list: expected {self.expected}")
        if self.ordered and isinstance(given, set | frozenset):
            raise Unreadable(f"a set has no order: expected {self.expected}")
        words = [_word(word, self.among, self.expected) for word in given]
        return words if self.ordered else sorted(set(words), key=self.among.index), ""

    def agrees(self, answer):
        """Whether they are the words."""
        return answer == self.key

    def mistakes(self):
        """The opposite order."""
        if self.ordered and len(self.key) > 1:
            yield "the words are right, in the opposite order", self.key[::-1]

    def hint(self, answer):
        """Say how many are right."""
        if not answer:
            return "the list is empty"
        right = (Counter(answer) & Counter(self.key)).total()
        if self.ordered and sorted(answer) == sorted(self.key):
            return "the words are right, their order is not"
        if right == len(answer) < len(self.key):
            return "what is there is right, and something is missing"
        if right == len(self.key):
            return "all that is asked is there, and more besides"
        return f"{right} of your {len(answer)} belong there" if right else ""


def _word(given, among, expected):
    if isinstance(given, bool):
        given = _TRUTH[given]
    if not isinstance(given, str):
        raise Unreadable(f"this is no text: expected {expected}")
    wanted = " ".join(given.split()).casefold()
    for word in among:
        if word.casefold() == wanted:
            return word
    shown = given if len(given) <= 40 else given[:37] + "..."
    raise Unreadable(f"{shown!r} is none of the words: expected {expected}")


def _either(words):
    return f"{', '.join(words[:-1])} or {words[-1]}"
