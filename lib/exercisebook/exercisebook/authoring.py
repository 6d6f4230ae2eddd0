"""Writing exercises: statement, parameters, key and known mistakes in one place.

So an exercise looks::

    @exercise("2.3", title="Braking", points=4, where=lambda v, way: way > v)
    def braking(v=between(5, 30, "m/s"), way=between(10, 90, "m"), mass=between(800, 2000, "kg")):
        '''The statement in Markdown, with {v}, {way} and {mass}.'''
        return answers(
            t=number(2 * way / v, "s", "the time until the car stands"),
            F=number(mass * v**2 / (2 * way), "N", "the force of its brakes"),
        )

    @braking.mistake("The car does not go on at {v}: half of that is its mean velocity.")
    def _(v, way):
        return {"t": way / v}

    braking.hints("The mean velocity ...", "With $v^2 = 2 a s$ ...", "The first line is ...")

    @braking.solution
    def _(v, way):
        '''The worked solution in Markdown, with {v}, {a} and the key {F}.'''
        return {"a": (v**2 / (2 * way), "m/s²")}
"""

from __future__ import annotations

import functools
import itertools
import re
import unicodedata
from collections import Counter
from collections.abc import Callable, Mapping
from types import ModuleType
from typing import TYPE_CHECKING

import sympy

from exercisebook import plugins
from exercisebook.credit import Credit
from exercisebook.declared import Declared
from exercisebook.kinds import MAKERS, Criterion, Kind, Number
from exercisebook.late import Late
from exercisebook.parameters import between, call, choice
from exercisebook.question import Question

if TYPE_CHECKING:
    # editors read no registry
    from exercisebook.kinds import Design as design  # noqa: F401, N813
    from exercisebook.kinds import Expression as expression  # noqa: F401, N813
    from exercisebook.kinds import Figure as figure  # noqa: F401, N813
    from exercisebook.kinds import Number as number  # noqa: F401, N813
    from exercisebook.kinds import Numbers as numbers  # noqa: F401, N813
    from exercisebook.kinds import Poles as poles  # noqa: F401, N813
    from exercisebook.kinds import Text as text  # noqa: F401, N813
    from exercisebook.kinds import TimeFunction as time_function  # noqa: F401, N813
    from exercisebook.kinds import Word as word  # noqa: F401, N813
    from exercisebook.kinds import Words as words  # noqa: F401, N813
    from exercisebook.parameters import Value

criterion = Criterion

MOST_DRAWS = 1000


def answers(**kinds: Kind | float | sympy.Expr) -> dict[str, Kind]:
    """Return the key of an exercise: a kind for each asked quantity; a bare number is one without unit.

    >>> answers(K=2, T=number(12, "s", "the period"))["K"].key
    2.0
    """
    if not kinds:
        raise ValueError("an exercise asks for nothing: expected at least one quantity")
    return {name: kind if isinstance(kind, Kind) else Number(kind, what=name) for name, kind in kinds.items()}


def exercise(
    number: str,
    title: str,
    points: float = 1,
    where: Callable[..., object] = lambda: True,
    insight: str = "",
    weights: Mapping[str, float] | None = None,
) -> Callable[[Callable[..., dict[str, Kind]]], Exercise]:
    """Make an exercise of the function below, which returns its key; `where` is a condition on the parameters.

    Arguments:
        number: chapter and place in it, as "10.2".
        title: a few words.
        points: of the whole exercise; each asked quantity brings the same part, if weights do not say otherwise.
        where: a condition on the parameters that it names; other draws are discarded.
        insight: what one knows after a right answer, in one sentence.
        weights: {name of a quantity: what it counts}; the others count 1.
    """
    return functools.partial(Exercise, number, title, points, where, insight=insight, weights=weights)


class Exercise(Declared):
    """An exercise, with all its variants."""

    @functools.lru_cache(maxsize=64)  # noqa: B019 - the exercises live as long as the program
    def question(self, student: str | None = None) -> Question:
        """Return the variant of a student, or the reference variant.

        Raises ValueError where the condition does not hold for the reference, or hardly ever.
        """
        if student is not None and not isinstance(student, str):
            raise ValueError(f"student is {student!r}: expected a name or an identification, as text")
        if student is not None and not student.strip():
            raise ValueError("student is an empty text: expected a name or an identification")
        if student is None:
            values = {name: parameter.reference for name, parameter in self.parameters.items()}
            if why := self.not_drawn(values):
                raise ValueError(f"the reference variant of exercise {self.number} is none: {why}")
            return Question(self, student, values)
        return Question(self, student, self._drawn(student, {}))

    def question_with(self, student: str, values: Mapping[str, Value]) -> Question:
        """Return the variant of a student to whom values were given before: they hold, whatever the ranges are now.

        Arguments:
            student: for whom what is not among the values is drawn.
            values: {name: value}; of a name that is no parameter, the value is of no use.
        Raises:
            ValueError: where something has to be drawn and the condition hardly ever holds.

        >>> @exercise("1.1", title="Twice")
        ... def twice(x=between(1, 9, "m")):
        ...     "What is twice {x}?"
        ...     return answers(y=2 * x)
        >>> twice.question_with("Ada", {"x": sympy.Integer(12)}).key["y"].key
        24.0
        """
        kept = {name: values[name] for name in self.parameters if name in values}
        return Question(self, student, kept if len(kept) == len(self.parameters) else self._drawn(student, kept))

    def _drawn(self, student, kept):
        """The values of a student: some that are kept, and for the others the first draw that fulfils the condition."""
        reasons: Counter[str] = Counter()
        for attempt in range(MOST_DRAWS):
            text = unicodedata.normalize("NFC", f"{self.number}|{student}|{attempt}")
            values = {
                name: kept[name] if name in kept else one.draw(f"{text}|{name}")
                for name, one in self.parameters.items()
            }
            why = self.not_drawn(values)
            if not why:
                return values
            reasons[why] += 1
        why, often = reasons.most_common(1)[0]
        raise ValueError(f"exercise {self.number} has no variant in {MOST_DRAWS} draws: in {often} of them {why}")

    def not_drawn(self, values: Mapping[str, Value]) -> str:
        """Return why values are no variant; empty where they are one."""
        return "" if call(self.where, values) else "its condition does not hold"


def collected(module: ModuleType) -> dict[str, Exercise]:
    """Return the exercises that a module defines, or has in a list: {number: `Exercise`}; a variant stands for its own.

    Raises ValueError where two have a number.
    """
    found = {}
    for value in vars(module).values():
        for one in value if isinstance(value, list) else [value]:
            one = one.exercise if isinstance(one, Question) else one
            if isinstance(one, Exercise):
                if one.number in found:
                    raise ValueError(f"there are two exercises {one.number} in {module.__name__}: expected one")
                found[one.number] = one
    return in_order(found)


def in_order(exercises: Mapping[str, Exercise]) -> dict[str, Exercise]:
    """Return exercises in the order of their numbers; each knows the heading of the next one."""
    found = dict(sorted(exercises.items(), key=lambda item: [int(part) for part in re.findall(r"\d+", str(item[0]))]))
    for one, following in itertools.pairwise(found.values()):
        one.then = following.heading
    return found


plugins.load()
__all__ = ["Credit", "Exercise", "Late", "answers", "between", "choice", "collected", "criterion", "exercise", *MAKERS]
if taken := MAKERS.keys() & {*__all__[: -len(MAKERS)]}:
    raise ValueError(f"{min(taken)} is another function for authors: expected another name for this kind of answers")
# the kinds of answers, under the names that read well in an exercise
globals().update(MAKERS)
