"""A question: one variant of an exercise, as a reader sees and answers it."""

from __future__ import annotations

import functools
import re
from typing import TYPE_CHECKING, Any

from loopbook.exercises.judging import OPEN, Verdict, harmless, judge
from loopbook.exercises.kinds import Kind
from loopbook.exercises.parameters import call
from loopbook.exercises.progress import note
from loopbook.exercises.reading import NOT_ANSWERED
from loopbook.exercises.response import Response
from loopbook.validation import did_you_mean

if TYPE_CHECKING:
    from loopbook.exercises.authoring import Exercise
    from loopbook.exercises.parameters import Value

_PLACE = re.compile(r"\{\{(\w+)\}\}|\{(\w+)\}")


class Question:
    """One variant of an exercise. Shown in a notebook, it is the statement; `check` responds to answers.

    Attributes:
        values: {name: value} of the parameters, exact numbers or words.
    """

    def __init__(self, exercise: Exercise, student: str | None, values: dict[str, Value]):
        self.exercise, self.student, self.values = exercise, student, values

    def given(self, *names: str) -> Any:
        """Return values of parameters, exact, and of what else the statement shows; a single one alone.

        Raises ValueError for a name that is none of them.

        >>> from loopbook.exercises.authoring import answers, between, exercise
        >>> @exercise("1.1", title="Twice", points=1)
        ... def twice(x=between(1, 9, "m", reference=3)):
        ...     "What is twice {x}?"
        ...     return answers(y=2 * x)
        >>> twice.question().given("x")
        3
        """
        known = self.values | call(self.exercise.shown, self.values)
        for name in names:
            if name not in known:
                raise ValueError(f"exercise {self.exercise.number} gives no {name!r}: expected {_listed(known)}")
        found = tuple(known[name] for name in names)
        return found[0] if len(found) == 1 else found

    @functools.cached_property
    def key(self) -> dict[str, Kind]:
        """The asked quantities with their keys: {name: kind}."""
        key = self._called(self.exercise.key, "the key")
        if not (isinstance(key, dict) and key and all(isinstance(kind, Kind) for kind in key.values())):
            raise ValueError(f"exercise {self.exercise.number} returns {key!r}: expected answers(...)")
        return key

    @functools.cached_property
    def mistakes(self) -> dict[str, list[tuple[str, Any]]]:
        """The known mistakes of the exercise in this variant: {name of a quantity: pairs of sentence and value}."""
        found: dict[str, list[tuple[str, Any]]] = {name: [] for name in self.key}
        for sentence, function in self.exercise.mistakes:
            for name, value in (self._called(function, "a mistake") or {}).items():
                if name not in found:
                    raise ValueError(
                        f"a mistake of exercise {self.exercise.number} is in {name!r}: expected {_listed(found)}"
                    )
                found[name].append((self.filled_in(sentence), value))
        return found

    def _called(self, function, what):
        """What a function of the author returns for this variant; raises ValueError where it fails."""
        try:
            return call(function, self.values)
        except Exception as error:
            values = ", ".join(f"{name} = {value}" for name, value in self.values.items())
            raise ValueError(f"{what} of exercise {self.exercise.number} fails for {values}: {error}") from error

    @functools.cached_property
    def _places(self):
        return self.exercise.places(self.values)

    def filled_in(self, text: str) -> str:
        """Return a text with the values of this variant in the places of their names; ``{{K}}`` is the letter K."""

        def fill(match):
            letter, name = match.groups()
            return "{" + letter + "}" if letter else self._places.get(name, match[0])

        return _PLACE.sub(fill, text)

    def check(self, /, *alone: object, **given: object) -> Response:
        """Respond to answers, whatever they are: ``check(Kp=2, Ti="3 min")``; a single quantity needs no name.

        Raises nothing: what cannot be judged is said in the response.
        """
        names, notes = list(self.key), []
        if alone and len(names) == len(alone) == 1 and not given:
            given = {names[0]: alone[0]}
        elif alone:
            notes.append(f"give the answers by their names: {_listed(names)}")
        for name in given:
            if name not in names:
                hint = did_you_mean(name, names, otherwise=f"asked is {_listed(names)}")
                notes.append(f"{harmless(name)} is not asked: {hint}")
        verdicts = tuple(
            judge(name, kind, given[name], self.mistakes[name]) if name in given else Verdict(name, OPEN, NOT_ANSWERED)
            for name, kind in self.key.items()
        )
        response = Response(self.exercise.heading, verdicts, self.exercise.points, tuple(notes))
        if any(verdict.status != OPEN for verdict in verdicts):
            note(self.exercise.number, self.student, response.is_right)
        return response

    @property
    def statement(self) -> str:
        """The statement in Markdown, with the values of this variant and a list of what is asked."""
        points = f"{self.exercise.points} point{'' if self.exercise.points == 1 else 's'}"
        lines = [f"**{self.exercise.heading}** ({points})", ""]
        lines += [self.filled_in(self.exercise.statement), ""]
        listed = set()
        for name, kind in self.key.items():
            among = getattr(kind, "among", None)
            lines.append(f"- `{name}`: " + (f"{kind.what}, out of the same list" if among in listed else kind.asked))
            listed.add(among or name)
        return "\n".join(lines + self._accuracy())

    def _accuracy(self):
        """A line on how near the answers must be: what holds for most of them, and then the others by name."""
        about = {}
        for name, kind in self.key.items():
            if kind.accuracy:
                about.setdefault(kind.accuracy, []).append(f"`{name}`")
        if not about:
            return []
        most, *others = sorted(about, key=lambda accuracy: -len(about[accuracy]))
        parts = [most, *(", ".join(about[one]) + ": " + one for one in others)]
        return ["", f"*Accuracy: {'; '.join(parts)}*"]

    def _repr_mimebundle_(self, include=None, exclude=None):
        return {"text/plain": repr(self), "text/markdown": self.statement}

    def __repr__(self) -> str:
        return self.statement


def _listed(names):
    return ", ".join(map(repr, names)) or "nothing"
