"""What a tuning rule is: it says what it starts from, which settings it has, and where it is from.

The decorator `rule` puts a function into the registry `RULES`, and refuses one that leaves something of this open. The
cheat sheet, tables that compare rules, and the tests (units, signs, symbols) go through the registry.
"""

from __future__ import annotations

import inspect
import itertools
import re
from collections.abc import Callable, Mapping
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any, NamedTuple, TypeAlias, TypeVar

import sympy

from loopbook.transfer import first_order
from loopbook.validation import did_you_mean, one_of

if TYPE_CHECKING:
    from loopbook.pid import PID
    from loopbook.types import Number

#: Powers of the units of the process gain and of time in the unit of what rules start from.
DIMENSIONS = {
    "K": (1, 0), "T": (0, 1), "delay": (0, 1), "Ku": (-1, 0), "Pu": (0, 1), "KpGG": (-1, 0), "Tou": (0, 1),
}  # fmt: skip


class Need(NamedTuple):
    """What a rule starts from.

    Attributes:
        quantities: names of what describes it, all of them in ``DIMENSIONS``.
        parameters: the first parameters of the rule's function.
    """

    quantities: tuple[str, ...]
    parameters: tuple[str, ...]

    @property
    def symbols(self) -> dict[str, sympy.Symbol]:
        """The quantities as positive symbols, {name: symbol}."""
        return {name: sympy.Symbol(name, positive=True) for name in self.quantities}

    def arguments(self, values: Mapping[str, Number]) -> tuple[Any, ...]:
        """Return what the rule's function begins with, from {name: value} of the quantities."""
        given = [values[name] for name in self.quantities]
        return (first_order(*given),) if self.parameters == ("model",) else tuple(given)


_LAG = Need(("K", "T", "delay"), ("model",))
NEEDS = {
    "one or two lags or integrators": _LAG,
    "a lag or an integrator with dead time": _LAG,
    "a lag with dead time": _LAG,
    "the ultimate gain and period": Need(("Ku", "Pu"), ("Ku", "Pu")),
    "the static gain, and the ultimate gain and period": Need(("K", "Ku", "Pu"), ("K", "Ku", "Pu")),
    "the Good Gain experiment": Need(("KpGG", "Tou"), ("KpGG", "Tou")),
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
    def gives(self) -> str:
        """The type of its settings: "PID" or "WeightedPID"."""
        hint = inspect.signature(self.function).return_annotation
        return getattr(hint, "__name__", str(hint))

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

    def settings(self, values: Mapping[str, Number] | None = None, **chosen: Any) -> PID:
        """Return the `PID` of the rule; of weighted settings, the one through which the measurement acts.

        Arguments:
            values: {quantity of the need: number or symbol}; its own symbols if not given.
            chosen: further arguments of the function.

        >>> from loopbook.tuning import RULES
        >>> RULES["tyreus_luyben"].settings(kind="PI")
        PID(Kp=31*Ku/100, Ti=11*Pu/5)
        """
        found = self.function(*self.need.arguments(self.need.symbols if values is None else values), **chosen)
        return found.settings if self.gives == "WeightedPID" else found


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
    rule, parameters = f"the rule {made.function.__name__}", inspect.signature(made.function).parameters
    if made.function.__name__ in RULES:
        raise ValueError(f"{rule} is there already: expected another name")
    if not made.source:
        raise ValueError(f"{rule} has no source: expected 'Source: author (year)' in its docstring")
    if made.needs not in NEEDS:
        raise ValueError(f"{rule} needs {made.needs!r}, which is not known: {did_you_mean(made.needs, NEEDS)}")
    if (begins := tuple(parameters)[: len(made.need.parameters)]) != made.need.parameters:
        raise ValueError(f"{rule} begins with {', '.join(begins)}: expected {', '.join(made.need.parameters)}")
    if made.gives not in ("PID", "WeightedPID"):
        raise ValueError(f"{rule} has no hint of what it returns: expected -> PID or -> WeightedPID")
    for parameter in made.choices:
        if parameter not in parameters:
            raise ValueError(f"{rule} has no parameter {parameter!r}: {did_you_mean(parameter, parameters)}")
    for parameter, one in parameters.items():
        if isinstance(one.default, str):
            if parameter not in made.choices:
                raise ValueError(f"{rule} does not say what it takes: expected {parameter}=({one.default!r}, ...)")
            one_of(f"{parameter} by itself, in {rule},", one.default, made.choices[parameter])


def confirm(made: Rule) -> None:
    """Raise ValueError for a rule that refuses a variant which it names, gives another one, or has one unnamed.

    It works the settings out, which takes a while; the tests confirm all rules.
    """
    rule = f"the rule {made.function.__name__}"
    for chosen in made.variants.values():
        try:
            found = made.settings(**chosen)
        except (ValueError, KeyError) as error:
            raise ValueError(f"{rule} has no settings for {chosen}: {error}") from None
        if "kind" in chosen and (found.Ti.is_finite is not False, found.Td != 0) != _KINDS[chosen["kind"]]:
            raise ValueError(f"{rule} gives {found} for {chosen}: expected a {chosen['kind']} controller")
    for kind in _KINDS if "kind" in made.choices else ():
        if kind not in made.choices["kind"] and _has(made, kind):
            raise ValueError(f"{rule} has settings for {kind!r} too: expected it among its words for kind")


def _has(made, kind):
    try:
        made.settings(kind=kind)
    except ValueError:
        return False
    return True


def within(name: str, value: sympy.Expr, low: Number, high: Number, extrapolate: bool) -> None:
    """Raise ValueError for a value outside of the range that a rule was made for, unless it may be left."""
    if not extrapolate and ((low - value).is_positive or (value - high).is_positive):
        raise ValueError(
            f"{name} is {value.evalf(4)}: the rule is for {low} to {high}; extrapolate=True leaves this range"
        )
