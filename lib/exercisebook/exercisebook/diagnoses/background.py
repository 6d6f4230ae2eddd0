"""What a diagnosis may know besides key and answer: the givens, the other asked quantities, and the other answers."""

from __future__ import annotations

import contextlib
import copy
import itertools
import re
from collections.abc import Callable, Collection, Iterator, Mapping
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

import numpy as np

from exercisebook.grammar import Unreadable
from exercisebook.kinds import Number
from exercisebook.parameters import written
from exercisebook.timeout import limited

if TYPE_CHECKING:
    from exercisebook.kinds import Kind
    from exercisebook.parameters import Parameter, Value

#: So many changes of the givens are tried at most, of the likely and of the others: a key takes a millisecond, and one
#: with formulas several.
MOST_CHANGES, FEWER = 30, 18
#: All of them together may take so many seconds, of which they usually need a tenth.
SECONDS = 1.5
#: By these factors a given is wrong if its unit is mistaken, by what its unit contains.
_UNIT_FACTORS = (("min", 60), ("h", 60), ("h", 3600), ("s", 60), ("%", 100), ("m", 1000), ("kg", 1000), ("mm", 1000))


@dataclass(frozen=True)
class Amount:
    """A number with its unit and its words in a sentence: a given, or another asked quantity.

    Attributes:
        is_had: whether it is an asked quantity that the reader has right.
    """

    value: float
    unit: str
    words: str
    is_had: bool = False


@dataclass(frozen=True)
class Answered:
    """Another asked quantity, and what the reader has for it."""

    name: str
    kind: Kind
    answer: Any

    @property
    def is_right(self) -> bool:
        """Whether the answer is right."""
        return self.kind.agrees(self.answer)

    @property
    def words(self) -> str:
        """The quantity in a sentence."""
        return f"{self.kind.what}, `{self.name}`"


class Background:
    """What is known around the asked quantities of an exercise.

    Arguments:
        key: {name: kind} of the exercise.
        values: {name: exact value} of the parameters.
        parameters: {name: `Parameter`}, those alone that the statement shows.
        following: returns the key of a quantity as it follows from changes, {name: value} of parameters or of other
            asked quantities, and its name; None where nothing says how.
        sources: {name: names of all on which it depends}, by the formulas of the exercise.

    Attributes:
        name: the quantity in question; `of` sets it.
        answers: what the reader has answered, {name: answer}; `of` sets them.
    """

    name: str = ""
    answers: Mapping[str, Any] = {}

    def __init__(
        self,
        key: Mapping[str, Kind] | None = None,
        values: Mapping[str, Value] | None = None,
        parameters: Mapping[str, Parameter] | None = None,
        following: Callable[[Mapping[str, Any], str], Kind | None] = lambda changes, name: None,
        sources: Mapping[str, Collection[str]] | None = None,
    ):
        self.key, self.values, self.parameters, self.following = key or {}, values or {}, parameters or {}, following
        self.sources = sources or {}
        self._keys: dict[tuple[Any, ...], Kind | None] = {}
        self._given_up: set[str] = set()  # that a key took too long

    def of(self, name: str, answers: Mapping[str, Any]) -> Background:
        """The same around one quantity; what has been computed is kept."""
        other = copy.copy(self)
        other.name, other.answers = name, answers
        return other

    def answered(self, name: str) -> Answered | None:
        """What the reader has for a quantity; None where that is nothing that can be judged, or a person marks it."""
        if name not in self.answers or self.key[name].by_hand:
            return None
        try:
            return Answered(name, self.key[name], self.key[name].read(self.answers[name])[0])
        except Unreadable:
            return None

    @property
    def wrong_before(self) -> list[Answered]:
        """What is asked for before this quantity, and has a wrong answer: this one may follow from it."""
        before = itertools.takewhile(lambda name: name != self.name, self.key)
        found = [self.answered(name) for name in before if self.name in self.key]
        return [one for one in found if one and not one.is_right]

    @property
    def depends_on(self) -> Collection[str]:
        """The names of all quantities on which this one depends."""
        return self.sources.get(self.name, ())

    def carried_on(self) -> Iterator[tuple[str, Kind]]:
        """The key of this quantity as it follows from a wrong number before it, or from all of them, and a sentence."""
        wrong = {one.name: one for one in self.wrong_before if type(one.kind) is Number}
        several = [[*wrong]] if len(wrong) > 1 else []
        for names in [*([name] for name in reversed(wrong)), *several]:
            with contextlib.suppress(Exception), np.errstate(all="ignore"):  # not each wrong number leads somewhere
                if found := self.following({name: wrong[name].answer for name in names}, self.name):
                    yield follows(" and ".join(wrong[name].words for name in names)), found

    @property
    def givens(self) -> list[Amount]:
        """The numbers among the givens, as the statement shows them."""
        return [Amount(float(self.values[name]), self.parameters[name].unit, self.words(name)) for name in self.numbers]

    @property
    def numbers(self) -> list[str]:
        """The names of the givens that are numbers."""
        return [name for name in self.parameters if not isinstance(self.values[name], str)]

    def words(self, name: str) -> str:
        """A given as the statement shows it."""
        return written(self.values[name], self.parameters[name].unit)

    def changed_keys(self, likely: bool = True) -> Iterator[tuple[str, Kind]]:
        """The key of this quantity with a given changed, and a sentence on the change.

        Arguments:
            likely: the changes that a reader may make by mistake, or those that are rarer.
        """
        changes = (_likely_changes if likely else _rarer_changes)(self)
        most = FEWER if any(hasattr(kind, "expr") for kind in self.key.values()) else MOST_CHANGES
        yield from self._keys_with(list(itertools.islice(changes, most)))

    def keys_of_other_words(self) -> Iterator[tuple[str, Kind]]:
        """The key of this quantity with another word among the givens, and a sentence on the change."""
        yield from self._keys_with(list(_other_words(self)))

    def _keys_with(self, changes):
        """The key with each of the changes. One may never end: then those after it are left out."""

        def compute():
            for changed in missing:
                self._key_with(changed)

        if missing := [changed for _, changed in changes if self._place(changed) not in self._keys]:
            self._in_time(compute)
        for how, changed in changes:
            if key := self._keys.get(self._place(changed)):
                yield how, key

    def _in_time(self, compute):
        """Compute keys, as long as none has taken too long."""
        if not self._given_up:
            try:
                limited(SECONDS, compute)
            except TimeoutError:
                self._given_up.add(self.name)

    def _key_with(self, changed):
        """Work out the key of this quantity with other values of some givens; None where there is none."""
        place = self._place(changed)
        self._keys[place] = None
        # the author's functions are for her own ranges: for other values they may fail in any way
        with contextlib.suppress(Exception), np.errstate(all="ignore"):
            self._keys[place] = self.following(changed, self.name)

    def _place(self, changed):
        return (self.name, *changed.items())


def follows(words: str) -> str:
    """A sentence on a quantity that follows by the right way from a wrong one before it, or from several."""
    are = "are" if "` and " in words else "is"
    return f"this is right for what you have for {words}, which {are} not right"


def _likely_changes(background):
    """Two givens of one unit interchanged, another word, a given left out."""
    values, parameters, numbers, words = background.values, background.parameters, background.numbers, background.words
    for one, other in itertools.combinations(numbers, 2):
        if parameters[one].unit == parameters[other].unit and values[one] != values[other]:
            how = f"that is what comes out with {words(one)} and {words(other)} interchanged"
            yield how, {one: values[other], other: values[one]}
    yield from _other_words(background)
    for name in numbers:
        # nothing of it, hardly anything where a key has no value for nothing, as a factor, and as an integral time
        for nothing in (0 * values[name], values[name] / 10**6, values[name] ** 0, values[name] * 10**6):
            if values[name] != nothing:
                yield f"that is what comes out without the {words(name)}", {name: nothing}


def _other_words(background):
    for name, parameter in background.parameters.items():
        value = background.values[name]
        for other in parameter.values if isinstance(value, str) else ():
            if other != value:
                yield f"that would be right for '{other}' in place of '{value}'", {name: other}


def _rarer_changes(background):
    """A given for another one, in a mistaken unit, with another sign."""
    values, parameters, numbers, words = background.values, background.parameters, background.numbers, background.words
    for one, other in itertools.combinations(numbers, 2):
        if parameters[one].unit != parameters[other].unit and values[one] != values[other]:
            how = f"that is what comes out with the numbers of {words(one)} and {words(other)} interchanged"
            yield how, {one: values[other], other: values[one]}
    for name in numbers:
        for factor in _mistaken(parameters[name].unit):
            for changed in (values[name] * factor, values[name] / factor):
                how = f"that is what comes out if the unit of {words(name)} is mistaken by a factor of {factor}"
                yield how, {name: changed}
    for name in numbers:
        yield f"that is what comes out with another sign of the {words(name)}", {name: -values[name]}


def _mistaken(unit):
    parts = re.findall(r"[^\W\d_]+|%", unit)
    return sorted({factor for part, factor in _UNIT_FACTORS if part in parts})
