"""A question: one variant of an exercise, as a reader sees and answers it."""

from __future__ import annotations

import functools
import inspect
import re
from collections.abc import Callable, Mapping, Sequence
from typing import TYPE_CHECKING, Any

import numpy as np

from exercisebook import filling
from exercisebook.asked_names import as_asked, by_name
from exercisebook.diagnoses import Background
from exercisebook.errors import ExerciseError
from exercisebook.judging import OPEN, UNJUDGED, WAITING, Verdict, harmless, is_right, judge
from exercisebook.kinds import Kind, Number
from exercisebook.parameters import call
from exercisebook.progress import is_answered, note, students
from exercisebook.reading import NOT_ANSWERED
from exercisebook.response import Response
from exercisebook.showing import Page, Showing, Statement
from plainmath.validation import did_you_mean

if TYPE_CHECKING:
    from exercisebook.declared import Declared
    from exercisebook.parameters import Value

#: In a solution, what is below it is left to the reader in the last hint.
FADES = re.compile(r"^\*\*\*\n", re.MULTILINE)
#: After so many responses that name no mistake, the hint is offered.
BARE = 2


class Question(Showing):
    """One variant of an exercise. Shown in a notebook, it is the statement; `check` responds to answers.

    Attributes:
        values: {name: value} of the parameters, exact numbers or words.
    """

    def __init__(self, exercise: Declared, student: str | None, values: dict[str, Value]):
        self.exercise, self.student, self.values = exercise, student, values
        self._hints_seen = self._answered = self._bare = 0

    def given(self, *names: str) -> Any:
        """Return values of parameters, exact, and of what else the statement shows; a single one alone.

        Raises ValueError for a name that is none of them.

        >>> from exercisebook.authoring import answers, between, exercise
        >>> @exercise("1.1", title="Twice", points=1)
        ... def twice(x=between(1, 9, "m", reference=3)):
        ...     "What is twice {x}?"
        ...     return answers(y=2 * x)
        >>> twice.question().given("x")
        3
        """
        known = self.values | self._shows
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
        if unknown := [name for name in self.exercise.weights if name not in key]:
            raise ValueError(f"exercise {self.exercise.number} weighs {unknown[0]!r}: {did_you_mean(unknown[0], key)}")
        # the order in which an author lists words says something about the right one, so each variant has its own
        key = {name: kind.shuffled(f"{self.exercise.number}|{self.student}") for name, kind in key.items()}
        for name, kind in key.items():  # in an assignment, `student` is drawn from its secret
            kind.draw_from(f"{self.exercise.number}|{self.student}|{name}")
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

    @functools.cached_property
    def background(self) -> Background:
        """What the diagnoses of a wrong answer may know: the givens of the statement, and the key for others."""
        parameters = {name: one for name, one in self.exercise.parameters.items() if name in self.stated}
        following = functools.partial(self.exercise.following, self.values)
        sources = {name: self.exercise.sources(name) for name in self.key}
        return Background(self.key, self.values, parameters, following, sources)

    @functools.cached_property
    def stated(self) -> dict[str, Value]:
        """The values of the parameters that the statement shows in the places of their names."""
        text = self.exercise.statement
        return {name: value for name, value in self.values.items() if re.search(rf"(?<!{{)\{{{name}\}}(?!}})", text)}

    def _called(self, function, what):
        """What a function of the author returns for this variant; raises ValueError where it fails."""
        try:
            return call(function, self.values)
        except Exception as error:
            raise ValueError(f"{what} of exercise {self.exercise.number} fails{self.with_values}: {error}") from error

    @property
    def with_values(self) -> str:
        """The values of this variant, as the end of a sentence about it; empty where there are no parameters."""
        values = ", ".join(f"{name} = {value}" for name, value in self.values.items())
        return f" for {values}" if values else ""

    @functools.cached_property
    def _shows(self):
        """What the statement shows besides the parameters."""
        return self._called(self.exercise.shown, "what the statement shows")

    @property
    def data(self) -> dict[str, np.ndarray]:
        """The arrays that the exercise hands out, by their names."""
        return {name: value for name, value in self._shows.items() if isinstance(value, np.ndarray)}

    def filled_in(self, text: str, also: Mapping[str, Any] | None = None) -> str:
        """Return a text with the values of this variant in the places of their names; ``{{K}}`` is the letter K.

        Arguments:
            text: of the author; in a formula a value is bare, elsewhere it has its unit.
            also: more that is shown, by name.
        """
        more = self._shows | (also or {})

        def find(name):
            if name in more and not isinstance(more[name], np.ndarray):
                return filling.shown(more[name])
            if name in self.values:
                return filling.of_parameter(self.values[name], self.exercise.parameters[name].unit)
            return filling.shown(self.key[name].shown) if also is not None and name in self.key else None

        return filling.filled_in(text, find)

    def check(self, /, *alone: object, **given: object) -> Response:
        """Respond to answers, whatever they are: ``check(Kp=2, Ti="3 min")``; a single quantity needs no name.

        A name may be that of another book, ``K_c`` for ``Kp``.

        Raises nothing: what cannot be judged is said in the response.
        """
        names, notes = list(self.key), []
        named = by_name(alone[0], self.key) if len(alone) == 1 and not given else {}
        if alone and not named:
            notes.append(f"give the answers by their names: {_listed(names)}")
        given = as_asked(given | named, self.key)
        for name in given:
            if name not in names:
                hint = did_you_mean(name, names, otherwise=f"asked is {_listed(names)}")
                notes.append(f"{harmless(name)} is not asked: {hint}")
        verdicts = tuple(
            judge(name, kind, given[name], self.mistakes[name], self.background.of(name, given))
            if name in given
            else Verdict(name, OPEN, NOT_ANSWERED)
            for name, kind in self.key.items()
        )
        judged = {one.name: one for one in verdicts if one.status not in (OPEN, UNJUDGED, WAITING)}
        drawn = [name for name in judged if self.key[name].draws]
        drawings = tuple(functools.partial(_drawn, self.key[name], given[name]) for name in drawn)
        exercise = self.exercise
        response = Response(exercise.heading, verdicts, exercise.points, tuple(notes), drawings, exercise.weights)
        if all(verdict.status == OPEN for verdict in verdicts):
            return response
        self._answered += 1
        self._bare += any(one.is_bare for one in verdicts)
        note(self.exercise.number, self.student, response.is_right)
        return response.with_notes(*self._afterwards(response, {name: given[name] for name in judged}))

    def _afterwards(self, response, given):
        """What is said below the verdicts: after a right answer where to go, after wrong ones where help is."""
        if response.is_right:
            insight = self.filled_in(self.exercise.insight, also={})
            return filter(None, [insight, self.exercise.then and f"Next: {self.exercise.then}"])
        if name := self._whose(given):
            return [f"With the numbers of {name} all of that is right. Yours are those of {_person(self.student)}."]
        if self._bare >= BARE and self.exercise.rungs and any(one.is_bare for one in response.verdicts):
            return [self.offer_of_a_hint]
        return []

    @property
    def offer_of_a_hint(self) -> str:
        """What is said after responses that name no mistake, in a notebook."""
        return f'A hint is one call away: exercise("{self.exercise.number}").hint()'

    def _whose(self, given):
        """Who has the numbers with which all answers would be right, of those for whom the exercise was shown.

        A word, a design, or a single number is right for many: it alone does not tell whose numbers these are.
        """
        wrong = [name for name in given if self._tells(name, given[name])]
        if len(wrong) < len([name for name in given if self._is_specific(name)]):
            return None  # a part is right: then these are no numbers of somebody else
        if not wrong or (len(wrong) == 1 and type(self.key[wrong[0]]) is Number):
            return None
        for student in students(self.exercise.number):
            other = self.exercise.question(student)
            if other.values != self.values and all(is_right(other.key[name], given[name]) for name in given):
                return _person(student)
        return None

    def _tells(self, name, given):
        """Whether a wrong answer to a quantity tells for whose numbers it would be right."""
        return self._is_specific(name) and not is_right(self.key[name], given)

    def _is_specific(self, name):
        return self.key[name].is_personal

    @property
    def rungs(self) -> list[str]:
        """The hints of this variant, from the law that helps to the solution with its last steps left to the reader."""
        rungs = [self.filled_in(rung, also={}) for rung in self.exercise.rungs]
        begun, *rest = FADES.split(self._worked_text)
        return [*rungs, f"{begun.strip()}\n\nThe rest is yours."] if rest else rungs

    def hint(self, rung: int | None = None) -> Page:
        """Return the next hint; each goes one step further, and the last one is shown again.

        Arguments:
            rung: a certain one, from 1.
        Raises:
            ExerciseError: for an unknown one.
        """
        rungs = self.rungs
        if rung is not None and not (isinstance(rung, int) and 1 <= rung <= len(rungs)):
            raise ExerciseError(f"the hint is {rung!r}: expected one from 1 to {len(rungs)}")
        if not rungs:
            return Page(f"Exercise {self.exercise.number} has no hints.")
        self._hints_seen = min(self._hints_seen + 1, len(rungs)) if rung is None else rung
        head = f"**Hint {self._hints_seen} of {len(rungs)}** · {self.exercise.heading}"
        return Page(rungs[self._hints_seen - 1], head)

    def solution(self) -> Page:
        """Return the solution with the numbers of this variant; before the first attempt, how to make one."""
        if not self.exercise.worked:
            return Page(f"Exercise {self.exercise.number} has no solution here.")
        if not (self._answered or is_answered(self.exercise.number, self.student)):
            return Page(
                f"The solution of exercise {self.exercise.number} comes after your first attempt: answer with "
                f'`check(...)`, or begin with `exercise("{self.exercise.number}").hint()`.'
            )
        return self.solved()

    def solved(self) -> Page:
        """Return the solution, whether there was an attempt or not."""
        if not self.exercise.worked:
            return Page(f"Exercise {self.exercise.number} has no solution here.")
        head = f"**Solution** · {self.exercise.heading}"
        return Page(FADES.sub("", self._worked_text), head, self._draws(self.exercise.drawn_in_solution))

    @functools.cached_property
    def _worked_text(self):
        worked = self.exercise.worked
        if not worked:
            return ""
        return self.filled_in(inspect.getdoc(worked) or "", also=self._called(worked, "the solution") or {})

    @property
    def pictures(self) -> Sequence[Any]:
        """The picture of the statement, if there is one."""
        return () if self.picture is None else (self.picture,)

    @functools.cached_property
    def picture(self) -> Any:
        """The figure of the statement, from the numbers of this variant; None where there is none."""
        return self._draws(self.exercise.drawn)()

    def _draws(self, function: Callable[..., Any] | None) -> Callable[[], Any]:
        """A function that draws one of the author's pictures, described in his words."""

        def draw():
            if function is None:
                return None
            picture = self._called(function, "a picture")
            if hasattr(picture, "alt") and (words := inspect.getdoc(function)):
                picture.alt = " ".join(self.filled_in(words, also={}).replace("$", "").split())
            return picture

        return draw

    @property
    def statement(self) -> Statement:
        """The statement, with the values of this variant and what is asked."""
        points = f"{self.exercise.points} point{'' if self.exercise.points == 1 else 's'}"
        body = self.filled_in(self.exercise.statement)
        asked, listed = [], set()
        for name, kind in self.key.items():
            among = getattr(kind, "among", None)
            what = f"{kind.what}, out of the same list" if among in listed else kind.asked
            asked.append(f"`{name}`: {what}{_weighted(self.exercise.weights.get(name, 1))}")
            listed.add(among or name)
        return Statement(self.exercise.heading, points, body, tuple(asked), self._accuracy())

    def _accuracy(self):
        """How near the answers must be: what holds for most of them, and then the others by name."""
        about = {}
        for name, kind in self.key.items():
            if kind.accuracy:
                about.setdefault(kind.accuracy, []).append(f"`{name}`")
        most, *others = sorted(about, key=lambda accuracy: -len(about[accuracy])) or [""]
        return "; ".join([most, *(", ".join(about[one]) + ": " + one for one in others)])

    def _repr_mimebundle_(self, include=None, exclude=None):
        return {"text/plain": repr(self), "text/markdown": repr(self)}

    def __repr__(self) -> str:
        return str(self.statement)


def _weighted(weight):
    """How much a quantity counts, in words; empty where it counts once."""
    usual = {1: "", 2: " (counts double)", 0.5: " (counts half)"}
    return usual.get(weight, f" (counts {weight:g} times)")


def _listed(names):
    return ", ".join(map(repr, names)) or "nothing"


def _person(student):
    return student or "everybody, without a name"


def _drawn(kind, given):
    return kind.picture(kind.read(given)[0])
