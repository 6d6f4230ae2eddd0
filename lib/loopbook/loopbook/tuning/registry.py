"""What a tuning rule is: it says what it starts from, which settings it has, and where it is from.

The decorator `rule` puts a function into the registry `RULES`, and refuses one that leaves something of this open. The
cheat sheet, tables that compare rules, and the tests (units, signs, symbols) go through the registry.
"""

from __future__ import annotations

import inspect
import itertools
import re
import types
import typing
from collections.abc import Callable, Mapping
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any, NamedTuple, TypeAlias, TypeVar

import sympy

from loopbook.pid import PID
from loopbook.transfer import double_integrator, first_order, integrator, integrator_with_lag, second_order
from loopbook.tuning.weighted import WeightedPID
from plainmath.expressions import exact
from plainmath.validation import did_you_mean, one_of

if TYPE_CHECKING:
    from loopbook.types import Number

#: Powers of the units of the process gain and of time in the unit of what rules start from.
DIMENSIONS = {
    "K": (1, 0), "T": (0, 1), "delay": (0, 1), "Ku": (-1, 0), "Pu": (0, 1), "KpGG": (-1, 0), "Tou": (0, 1),
}  # fmt: skip


class Need(NamedTuple):
    """What a rule starts from.

    Attributes:
        quantities: names of what describes it, all of them in ``DIMENSIONS``.
        processes: {words: function that returns a process made of the quantities}, one of each sort that the rules are
            for; empty where they start from the quantities themselves.
    """

    quantities: tuple[str, ...]
    processes: Mapping[str, Callable[..., sympy.Expr]] = types.MappingProxyType({})

    @property
    def parameters(self) -> tuple[str, ...]:
        """The first parameters of the rule's function."""
        return ("model",) if self.processes else self.quantities

    @property
    def symbols(self) -> dict[str, sympy.Symbol]:
        """The quantities as positive symbols, {name: symbol}."""
        return {name: sympy.Symbol(name, positive=True) for name in self.quantities}

    def arguments(self, values: Mapping[str, Number], process: str | None = None) -> tuple[Any, ...]:
        """Return what the rule's function begins with.

        Arguments:
            values: {quantity: number or symbol}.
            process: which of the processes; the first if not given.

        >>> need = NEEDS["a lag or an integrator with dead time"]
        >>> need.arguments({"K": 2, "T": 8, "delay": 1}, "an integrator")
        (exp(-s)/(4*s),)
        """
        given = tuple(exact(values[name]) for name in self.quantities)
        return (self.processes[process or next(iter(self.processes))](*given),) if self.processes else given


_OF_A_PROCESS = ("K", "T", "delay")
_LAG = {"a lag": first_order}
_INTEGRATOR = {"an integrator": lambda K, T, delay: integrator(K / T, delay)}
_SECOND_ORDER = {
    "two lags": lambda K, T, delay: second_order(K, T, T / 3, delay),
    "an integrator with a lag": lambda K, T, delay: integrator_with_lag(K / T, T, delay),
    "two integrators": lambda K, T, delay: double_integrator(K / T**2, delay),
}
NEEDS = {
    "one or two lags or integrators": Need(_OF_A_PROCESS, _LAG | _INTEGRATOR | _SECOND_ORDER),
    "a lag or an integrator with dead time": Need(_OF_A_PROCESS, _LAG | _INTEGRATOR),
    "a lag with dead time": Need(_OF_A_PROCESS, _LAG),
    "the ultimate gain and period": Need(("Ku", "Pu")),
    "the static gain, and the ultimate gain and period": Need(("K", "Ku", "Pu")),
    "the Good Gain experiment": Need(("KpGG", "Tou")),
}

#: Which terms the kinds of controllers have.
_KINDS = {"P": (False, False), "PI": (True, False), "PID": (True, True)}
#: {parameter: {word: the word for people}}.
Choices: TypeAlias = dict[str, dict[str, str]]
_Function = TypeVar("_Function", bound=Callable[..., Any])


@dataclass(frozen=True)
class Rule:
    """A tuning rule with what it says of itself.

    Attributes:
        name: for people, as "Ziegler-Nichols".
        function: that returns the settings.
        needs: what it starts from, one of ``NEEDS``.
        choices: {parameter: {word: the word for people}}, as {"kind": {"P": "P", "PI": "PI"}}.
        source: where it is from.
    """

    name: str
    function: Callable[..., Any]
    needs: str
    choices: Choices
    source: str

    @property
    def need(self) -> Need:
        """What it starts from, in quantities."""
        return NEEDS[self.needs]

    @property
    def variants(self) -> dict[str, dict[str, str]]:
        """All that it can be asked for: {words for people: arguments}.

        >>> from loopbook.tuning import RULES
        >>> RULES["ziegler_nichols_reaction"].variants["Ziegler-Nichols PI"]
        {'kind': 'PI'}
        >>> list(RULES["itae"].variants)
        ['ITAE PI, load', 'ITAE PI, setpoint', 'ITAE PID, load', 'ITAE PID, setpoint']
        """
        found = {}
        for words in itertools.product(*self.choices.values()):
            chosen = dict(zip(self.choices, words, strict=True))
            spoken = [self.choices[parameter][word] for parameter, word in chosen.items() if parameter != "kind"]
            name = f"{self.name} {self.choices['kind'][chosen['kind']]}" if "kind" in chosen else self.name
            found[", ".join([name, *spoken])] = chosen
        return found

    def settings(self, values: Mapping[str, Number] | None = None, process: str | None = None, **chosen: Any) -> PID:
        """Return the `PID` of the rule; of weighted settings, the one through which the measurement acts.

        Arguments:
            values: {quantity of the need: number or symbol}; its own symbols if not given.
            process: which of the processes of the need; the first if not given.
            chosen: further arguments of the function.

        >>> from loopbook.tuning import RULES
        >>> RULES["tyreus_luyben"].settings(kind="PI")
        PID(Kp=31*Ku/100, Ti=11*Pu/5)
        """
        values = self.need.symbols if values is None else values
        found = self.function(*self.need.arguments(values, process), **chosen)
        return found.settings if isinstance(found, WeightedPID) else found


#: All rules: {name of the function: `Rule`}.
RULES: dict[str, Rule] = {}


def rule(name: str, needs: str, **choices: tuple[str, ...] | Mapping[str, str]) -> Callable[[_Function], _Function]:
    """Put a function into the registry of tuning rules, and return it as it is.

    Arguments:
        name: of the rule, for people.
        needs: what the rule starts from, one of ``NEEDS``; the function begins with the parameters of that.
        choices: the words that a parameter of the function takes, as ``kind=("P", "PI", "PID")``; where people call
            them otherwise ``mode={"servo": "setpoint"}``.
    Raises:
        ValueError: for a rule without source, of an unknown need, or whose choices are not those of its function.

    >>> @rule("Tight", needs="the ultimate gain and period", kind=("P",))
    ... def tight(Ku, Pu, kind="P"): ...
    Traceback (most recent call last):
    ValueError: the rule tight has no source: expected 'Source: author (year)' in its docstring
    """

    def registered(function):
        words = {key: dict(one) if isinstance(one, Mapping) else {x: x for x in one} for key, one in choices.items()}
        source = re.search(r"^Source: ((?:.+\n?)+)", inspect.getdoc(function) or "", re.MULTILINE)
        made = Rule(name, function, needs, words, " ".join(source[1].split()) if source else "")
        _check(made)
        RULES[function.__name__] = made
        return function

    return registered


def _check(made):
    """Raise ValueError for what a rule has left open."""
    subject, parameters = f"the rule {made.function.__name__}", inspect.signature(made.function).parameters
    if made.function.__name__ in RULES:
        raise ValueError(f"{subject} is there already: expected another name")
    if not made.source:
        raise ValueError(f"{subject} has no source: expected 'Source: author (year)' in its docstring")
    if made.needs not in NEEDS:
        raise ValueError(f"{subject} needs {made.needs!r}, which is not known: {did_you_mean(made.needs, NEEDS)}")
    if (begins := tuple(parameters)[: len(made.need.parameters)]) != made.need.parameters:
        raise ValueError(f"{subject} begins with {', '.join(begins)}: expected {', '.join(made.need.parameters)}")
    if _returned(made.function) not in (PID, WeightedPID):
        raise ValueError(f"{subject} has no hint of what it returns: expected -> PID or -> WeightedPID")
    for parameter in made.choices:
        if parameter not in parameters:
            raise ValueError(f"{subject} has no parameter {parameter!r}: {did_you_mean(parameter, parameters)}")
    for parameter, one in parameters.items():
        if isinstance(one.default, str):
            if parameter not in made.choices:
                raise ValueError(f"{subject} does not say what it takes: expected {parameter}=({one.default!r}, ...)")
            one_of(f"{parameter} by itself, in {subject},", one.default, made.choices[parameter])


def _returned(function):
    """The class that a function says it returns, however the hint names it; None where it says none."""
    # a hint of the result alone, since those of the parameters may name what only type checkers import
    hint = types.SimpleNamespace(__annotations__={"return": function.__annotations__.get("return")})
    try:
        return typing.get_type_hints(hint, function.__globals__)["return"]
    except NameError:
        return None


def confirm(made: Rule) -> None:
    """Raise ValueError for a rule that refuses a variant which it names, gives another one, or has one unnamed.

    It works the settings out, which takes a while; the tests confirm all rules.
    """
    subject = f"the rule {made.function.__name__}"
    for process, chosen in itertools.product(made.need.processes or [None], made.variants.values()):
        try:
            found = made.settings(process=process, **chosen)
        except (ValueError, KeyError) as error:
            of = f" of {process}" if process else ""
            raise ValueError(f"{subject} has no settings{of} for {chosen}: {error}") from None
        if "kind" in chosen and (found.Ti.is_finite is not False, found.Td != 0) != _KINDS[chosen["kind"]]:
            raise ValueError(f"{subject} gives {found} for {chosen}: expected a {chosen['kind']} controller")
    for kind in _KINDS if "kind" in made.choices else ():
        if kind not in made.choices["kind"] and _has(made, kind):
            raise ValueError(f"{subject} has settings for {kind!r} too: expected it among its words for kind")


def _has(made, kind):
    try:
        made.settings(kind=kind)
    except ValueError:
        return False
    return True
