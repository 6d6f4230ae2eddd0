"""The names under which readers answer, matched with those that are asked: ``check(K_c=2)`` where `Kp` is asked."""

from __future__ import annotations

from collections.abc import Callable, Iterable

from loopbook.exercises.notation import bare

#: Names of one quantity in different books, without case and underscores. A name in two rows may be either.
SYNONYMS = (
    "k kp kc gain",
    "kp kc kprop proportionalgain controllergain",
    "ti taui integraltime resettime",
    "td taud derivativetime",
    "tau theta delay deadtime timedelay",
    "tau t tau1 t1 lag timeconstant",
    "tc tauc lambda",
    "ku kcu kcr ultimategain",
    "pu tu pcr ultimateperiod period p",
    "omega w frequency crossover",
    "zeta xi damping dampingratio",
    "gainmargin gm",
    "phasemargin pm",
    "delaymargin dm",
    "pole poles p",
    "zero zeros z",
    "settings controller pid pi c",
    "h g m tf transferfunction",
)


def matched(given: Iterable[str], asked: Iterable[str]) -> dict[str, str]:
    """Return which asked name each given one means: {given: asked}; a name that may mean none or several is left out.

    The same names come first, then those that differ in case, underscores and Greek letters, then those that other
    books use for the quantity. What is taken already is meant by no second name.

    >>> matched(["K_c", "tauI"], ["Kp", "Ti"])
    {'K_c': 'Kp', 'tauI': 'Ti'}
    >>> matched(["T", "θ"], ["T", "tau"])
    {'T': 'T', 'θ': 'tau'}
    >>> matched(["tau"], ["tau_1", "theta"])
    {}
    """
    given, asked, found = list(dict.fromkeys(given)), list(asked), {}
    rules: tuple[Callable[[str, str], bool], ...] = (str.__eq__, _same_spelling, _same_quantity)
    for means in rules:
        left, open_ = [name for name in given if name not in found], set(asked) - set(found.values())
        meant = {name: [one for one in asked if one in open_ and means(name, one)] for name in left}
        for name, ones in meant.items():
            rivals = [other for other in left if ones and ones[0] in meant[other]]
            if len(ones) == len(rivals) == 1:
                found[name] = ones[0]
    return {name: found[name] for name in given if name in found}


def _same_spelling(one: str, other: str) -> bool:
    return bare(one) == bare(other)


def _same_quantity(one: str, other: str) -> bool:
    pair = {bare(one), bare(other)}
    return any(pair <= set(row.split()) for row in SYNONYMS)
