"""What an author declares of an exercise."""

from __future__ import annotations

import inspect
import textwrap
from collections.abc import Callable, Collection, Iterable, Mapping
from typing import TYPE_CHECKING, Any, TypeVar

from exercisebook.parameters import Parameter, call
from plainmath.validation import is_number

if TYPE_CHECKING:
    from exercisebook.kinds import Kind
    from exercisebook.parameters import Value

_Function = TypeVar("_Function", bound=Callable[..., Any])


class Declared:
    """An exercise as its author declares it: statement, key, mistakes, hints, solution.

    Attributes:
        number, title, points, insight, weights: as given.
        parameters: {name: `Parameter`}.
    """

    def __init__(
        self,
        number: str,
        title: str,
        points: float,
        where: Callable[..., object],
        key: Callable[..., dict[str, Kind]],
        insight: str = "",
        weights: Mapping[str, float] | None = None,
    ):
        self.number, self.title, self.points, self.where, self.key = number, title, points, where, key
        self.insight, self.then = insight, ""  # the heading of the next exercise, which a collection knows
        self.weights = dict(weights or {})
        for name, weight in self.weights.items():
            if not is_number(weight) or not weight > 0:
                raise ValueError(f"the weight of {name} in exercise {number} is {weight!r}: expected a positive number")
        self.statement = textwrap.dedent(" " * 4 + (key.__doc__ or "")).strip()
        self.parameters: dict[str, Parameter] = {
            name: item.default for name, item in inspect.signature(key).parameters.items()
        }
        self.mistakes: list[tuple[str, Callable[..., dict[str, Any] | None]]] = []
        self.shown: Callable[..., dict[str, Any]] = lambda: {}
        self.rungs: tuple[str, ...] = ()
        self.worked: Callable[..., dict[str, Any] | None] | None = None
        self.drawn: Callable[..., Any] | None = None
        self.drawn_in_solution: Callable[..., Any] | None = None
        for name, parameter in self.parameters.items():
            if not isinstance(parameter, Parameter):
                raise ValueError(f"{name} of exercise {number} is {parameter!r}: expected between(...) or choice(...)")
        if not self.statement:
            raise ValueError(f"exercise {number} has no statement: expected one as the docstring of its function")

    @property
    def heading(self) -> str:
        """Number and title."""
        return f"Exercise {self.number} · {self.title}"

    def mistake(self, sentence: str) -> Callable[[_Function], _Function]:
        """Declare a mistake: a function of parameters that returns {name: wrong value}, and {} where there is none."""

        def declared(function):
            self.mistakes.append((sentence, function))
            return function

        return declared

    def shows(self, function: _Function) -> _Function:
        """Declare what else the statement shows: {name: expression, equation or text}; an array is data to work on."""
        self.shown = function
        return function

    def hints(self, *rungs: str) -> None:
        """Declare the hints, from the law that helps to the first line; each goes one step further."""
        self.rungs = rungs

    def solution(self, function: _Function) -> _Function:
        """Declare the solution: its text is the docstring, and the function returns what else the text shows.

        What is below a line of three stars is left to the reader in the last hint.
        """
        self.worked = function
        return function

    def picture(self, function: _Function) -> _Function:
        """Declare the picture of the statement; the docstring says what is in it to those who cannot see it."""
        self.drawn = function
        return function

    def solution_picture(self, function: _Function) -> _Function:
        """Declare the picture of the solution, as that of the statement."""
        self.drawn_in_solution = function
        return function

    def sources(self, name: str) -> Collection[str]:
        """Return the names of all on which a quantity depends, where formulas say it."""
        return ()

    def following(self, values: Mapping[str, Value], changes: Mapping[str, Any], name: str) -> Kind | None:
        """Return the key of an asked quantity as it follows from changes; None where nothing says how.

        Arguments:
            values: of the parameters.
            changes: {name of a parameter, or of another asked quantity: value}.
            name: of the asked quantity.
        """
        return call(self.key, {**values, **changes}).get(name) if changes.keys() <= self.parameters.keys() else None

    def second_ways(self, values: Mapping[str, Value]) -> Iterable[tuple[str, bool, str]]:
        """Yield what has to hold for some values of the parameters, each with whether it does, and its sides."""
        return ()

    def __repr__(self) -> str:
        return self.heading
