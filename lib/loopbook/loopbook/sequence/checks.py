"""What a chart must fulfil before it runs: its names, and the situations that it can come into.

The second kind is found by exploring the markings, the sets of steps that can be active together, with all conditions
taken as free. Where every situation in which single transitions are cleared one after the other is safe, so is
clearing several at once, because these have no step in common.
"""

from __future__ import annotations

import keyword
from collections.abc import Collection, Iterable, Mapping, Sequence
from typing import TYPE_CHECKING, Any, TypeAlias

from loopbook.types import Number
from plainmath.validation import positive

if TYPE_CHECKING:
    from loopbook.sequence.formulas import Formula
    from loopbook.sequence.transitions import Transition

__all__ = [
    "MOST_MARKINGS",
    "connections",
    "initial_step",
    "kinds",
    "listed",
    "names",
    "reachable_markings",
    "several",
    "situations",
]

Marking: TypeAlias = frozenset[str]
Markings: TypeAlias = dict[Marking, list[tuple["Transition", Marking]]]

MOST_MARKINGS = 20_000
RESERVED = {"AND", "OR", "NOT", "XOR", "MOD", "TRUE", "FALSE"}


def kinds(outputs: Mapping[str, Any], steps: Mapping[str, Any], tag: str, step: Number | None) -> None:
    """Check what kinds of things a chart is made of."""
    if not isinstance(outputs, dict):
        raise ValueError(f"the outputs are {outputs!r}: expected {{name: value before the start}}")
    if not isinstance(steps, dict):
        raise ValueError(f"the steps are {steps!r}: expected {{step: {{output: value}}}}")
    if odd := [name for name, actions in steps.items() if not isinstance(actions, dict)]:
        raise ValueError(f"the step {odd[0]} has {steps[odd[0]]!r}: expected its actions, {{output: value}}")
    if not (isinstance(tag, str) and tag.strip()):
        raise ValueError(f"the tag is {tag!r}: expected a name, such as 'SFC'")
    if step is not None:
        positive("the step of the scans", step)


def several(what: str, values: str | Iterable[Any], expected: str) -> tuple[Any, ...]:
    """The values as a tuple; a text is one with blanks between names."""
    try:
        return tuple(values.split() if isinstance(values, str) else values)
    except TypeError:
        raise ValueError(f"{what} are {values!r}: expected {expected}") from None


def names(inputs: Sequence[str], outputs: Mapping[str, Any], steps: Mapping[str, Any]) -> None:
    """Check the names of signals and steps, and that none is used for two things."""
    for what, group in (("input", inputs), ("output", outputs), ("step", steps)):
        for name in group:
            fits = isinstance(name, str) and name.isidentifier() and not keyword.iskeyword(name)
            if not fits or name.upper() in RESERVED:
                raise ValueError(f"the {what} {name!r} is not a name: expected letters, digits and underscores")
    if not steps:
        raise ValueError("the chart has no steps")
    if twice := [name for name in inputs if list(inputs).count(name) > 1]:
        raise ValueError(f"the input {twice[0]} is named twice")
    if both := [name for name in inputs if name in outputs]:
        raise ValueError(f"{both[0]} is an input and an output of the chart: expected one of the two")
    if both := [name for name in (*inputs, *outputs) if name in steps]:
        raise ValueError(f"{both[0]} is a signal and a step of the chart: expected two names")


def initial_step(initial: str | Sequence[str], steps: Mapping[str, Any]) -> str:
    """The one initial step."""
    found = tuple(initial) if isinstance(initial, (list, tuple, set)) else (initial,) if initial is not None else ()
    if not found:
        raise ValueError("the chart has no initial step: expected the name of one")
    if len(found) > 1:
        raise ValueError(f"the chart has {len(found)} initial steps, {listed(map(str, found))}: expected one")
    if not isinstance(found[0], str) or found[0] not in steps:
        raise ValueError(f"the initial step {found[0]} is not a step of the chart: it has {listed(steps)}")
    return found[0]


def connections(
    steps: Collection[str],
    initial: str,
    final: Collection[str],
    transitions: Sequence[Transition],
    conditions: Sequence[Formula],
) -> None:
    """Check that every step can be left and come into, as far as single transitions show it."""
    for transition in transitions:
        for step in (*transition.sources, *transition.targets):
            if step not in steps:
                raise ValueError(f"{transition.name} has the unknown step {step}: the chart has {listed(steps)}")
    for step in final:
        if step not in steps:
            raise ValueError(f"the final step {step} is not a step of the chart: it has {listed(steps)}")
        if leaving := [x for x in transitions if step in x.sources]:
            raise ValueError(f"{step} is a final step, but {leaving[0].name} leaves it")
    for step in steps:
        if step != initial and not any(step in transition.targets for transition in transitions):
            raise ValueError(f"the step {step} cannot be reached: no transition leads to it")
        if step not in final and not any(step in transition.sources for transition in transitions):
            raise ValueError(f"no transition leaves the step {step}: declare it final, or add one")
    earlier = []
    for transition, condition in zip(transitions, conditions, strict=True):
        for before, other in earlier:
            if set(before.sources) <= set(transition.sources) and (other.constant or other.text == condition.text):
                why = "is unconditional" if other.constant else f"has the same condition, {other.text}"
                raise ValueError(f"{transition.name} is never cleared: {before.name} comes first and {why}")
        if condition.constant is False:
            raise ValueError(f"{transition.name} is never cleared: its condition is always FALSE")
        earlier.append((transition, condition))


def reachable_markings(initial: str, transitions: Sequence[Transition]) -> Markings:
    """Find all sets of steps that can be active together, with the conditions taken as free.

    Returns:
        ``{marking: [(transition, next marking)]}``, the markings as frozen sets of steps; the initial one is the first.
    Raises:
        ValueError: where a step would be activated while it is active, as when a jump leaves simultaneous branches, or
            for more than 20 000 markings.
    """
    start = frozenset([initial])
    found, waiting = {start: None}, [start]
    for marking in waiting:
        ways = []
        for transition in transitions:
            if not marking.issuperset(transition.sources):
                continue
            others = marking.difference(transition.sources)
            if again := sorted(others.intersection(transition.targets)):
                raise ValueError(
                    f"{transition.name} can activate the step {again[0]} while it is active: "
                    f"it leaves a simultaneous branch without its convergence"
                )
            following = others.union(transition.targets)
            ways.append((transition, following))
            if following not in found:
                found[following] = None
                waiting.append(following)
        found[marking] = ways
        if len(found) > MOST_MARKINGS:
            raise ValueError(f"more than {MOST_MARKINGS} sets of steps can be active together: divide the chart")
    return found


def situations(
    steps: Collection[str], initial: str, final: Collection[str], transitions: Sequence[Transition]
) -> Markings:
    """Check that every step and transition can have its turn, and that the chart stops in final steps alone."""
    markings = reachable_markings(initial, transitions)
    enabled = {transition for ways in markings.values() for transition, _ in ways}
    for transition in transitions:  # the cause before its consequence, a step that is never reached
        reached = all(any(step in marking for marking in markings) for step in transition.sources)
        if transition not in enabled and reached:
            together = listed(transition.sources, "and")
            raise ValueError(f"{transition.name} is never cleared: {together} are never active together")
    for step in steps:
        if not any(step in marking for marking in markings):
            raise ValueError(f"the step {step} cannot be reached from the initial step {initial}")
    for last in closing(markings):
        active = frozenset().union(*last)
        left = {step for marking in last for transition, _ in markings[marking] for step in transition.sources}
        if waiting := [step for step in steps if step in active - left and step not in final]:
            together = listed([step for step in steps if step in last[0]], "and")
            how = "go on" if any(markings[marking] for marking in last) else "stop"
            raise ValueError(
                f"the chart can {how} for good with {together} active: no transition leaves {waiting[0]} then"
            )
    return markings


def closing(markings: Markings) -> list[list[Marking]]:
    """The groups of markings that a chart never leaves: one in which it stops, or several through which it goes on."""
    from scipy.sparse import coo_array
    from scipy.sparse.csgraph import connected_components

    place = {marking: n for n, marking in enumerate(markings)}
    pairs = [(n, place[following]) for n, ways in enumerate(markings.values()) for _, following in ways]
    rows, columns = zip(*pairs, strict=True) if pairs else ((), ())
    shape = (len(place), len(place))
    _, group = connected_components(coo_array(([1] * len(pairs), (rows, columns)), shape), connection="strong")
    left = {group[one] for one, other in pairs if group[one] != group[other]}
    found = {}
    for marking, n in place.items():
        if group[n] not in left:
            found.setdefault(group[n], []).append(marking)
    return list(found.values())


def listed(names: Iterable[str], last: str = ",") -> str:
    """Names as they are read: A, B and C."""
    *others, final = names
    if not others:
        return final
    return f"{', '.join(others)}{last if last == ',' else ' ' + last} {final}"
