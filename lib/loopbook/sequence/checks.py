"""What a chart must fulfil before it runs: its names, and the situations that it can come into.

The second kind is found by exploring the markings, the sets of steps that can be active together, with all conditions
taken as free. Where every situation in which single transitions are cleared one after the other is safe, so is
clearing several at once, because these have no step in common.
"""

import keyword

__all__ = ["MOST_MARKINGS", "reachable_markings"]

MOST_MARKINGS = 20_000
RESERVED = {"AND", "OR", "NOT", "XOR", "MOD", "TRUE", "FALSE"}


def names(inputs, outputs, steps):
    """Check the names of signals and steps, and that none is used for two things."""
    for what, group in (("input", inputs), ("output", outputs), ("step", steps)):
        for name in group:
            fits = isinstance(name, str) and name.isidentifier() and not keyword.iskeyword(name)
            if not fits or name.upper() in RESERVED:
                raise ValueError(f"the {what} {name!r} is no name: expected letters, digits and underscores")
    if not steps:
        raise ValueError("the chart has no steps")
    if twice := [name for name in inputs if list(inputs).count(name) > 1]:
        raise ValueError(f"the input {twice[0]} is named twice")
    if both := [name for name in inputs if name in outputs]:
        raise ValueError(f"{both[0]} is an input and an output of the chart: expected one of the two")
    if both := [name for name in (*inputs, *outputs) if name in steps]:
        raise ValueError(f"{both[0]} is a signal and a step of the chart: expected two names")


def initial_step(initial, steps):
    """The one initial step."""
    found = () if initial is None else (initial,) if isinstance(initial, str) else tuple(initial)
    if not found:
        raise ValueError("the chart has no initial step: expected the name of one")
    if len(found) > 1:
        raise ValueError(f"the chart has {len(found)} initial steps, {listed(found)}: expected one")
    if found[0] not in steps:
        raise ValueError(f"the initial step {found[0]} is no step of the chart: it has {listed(steps)}")
    return found[0]


def connections(chart):
    """Check that every step can be left and come into, as far as single transitions show it."""
    for transition in chart.transitions:
        for step in (*transition.sources, *transition.targets):
            if step not in chart.steps:
                raise ValueError(f"{transition.name} has the unknown step {step}: the chart has {listed(chart.steps)}")
    for step in chart.final:
        if step not in chart.steps:
            raise ValueError(f"the final step {step} is no step of the chart: it has {listed(chart.steps)}")
        if leaving := [x for x in chart.transitions if step in x.sources]:
            raise ValueError(f"{step} is a final step, but {leaving[0].name} leaves it")
    for step in chart.steps:
        if step != chart.initial and not any(step in transition.targets for transition in chart.transitions):
            raise ValueError(f"the step {step} cannot be reached: no transition leads to it")
        if step not in chart.final and not any(step in transition.sources for transition in chart.transitions):
            raise ValueError(f"no transition leaves the step {step}: declare it final, or add one")
    unconditional = []
    for transition, condition in zip(chart.transitions, chart.conditions, strict=True):
        if before := [x for x in unconditional if set(x.sources) <= set(transition.sources)]:
            raise ValueError(f"{transition.name} is never cleared: {before[0].name} comes first and is unconditional")
        if condition.constant is False:
            raise ValueError(f"{transition.name} is never cleared: its condition is always FALSE")
        if condition.constant is True:
            unconditional.append(transition)


def reachable_markings(chart):
    """Find all sets of steps that can be active together, with the conditions taken as free.

    Arguments:
        chart: a `Chart`.
    Returns:
        ``{marking: [(transition, next marking)]}``, the markings as frozen sets of steps; the initial one is the first.
    Raises:
        ValueError: where a step would be activated while it is active, as when a jump leaves simultaneous branches, or
            for more than 20 000 markings.
    """
    start = frozenset([chart.initial])
    found, waiting = {start: None}, [start]
    for marking in waiting:
        ways = []
        for transition in chart.transitions:
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


def situations(chart):
    """Check that every step and transition can have its turn, and that the chart stops in final steps alone."""
    markings = reachable_markings(chart)
    enabled = {transition for ways in markings.values() for transition, _ in ways}
    for transition in chart.transitions:  # the cause before its consequence, a step that is never reached
        reached = all(any(step in marking for marking in markings) for step in transition.sources)
        if transition not in enabled and reached:
            steps = listed(transition.sources, "and")
            raise ValueError(f"{transition.name} is never cleared: {steps} are never active together")
    for step in chart.steps:
        if not any(step in marking for marking in markings):
            raise ValueError(f"the step {step} cannot be reached from the initial step {chart.initial}")
    for marking, ways in markings.items():
        if not ways and (waiting := [step for step in chart.steps if step in marking and step not in chart.final]):
            together = listed([step for step in chart.steps if step in marking], "and")
            raise ValueError(
                f"the chart can stop for good with {together} active: no transition leaves {waiting[0]} then"
            )
    return markings


def listed(names, last=","):
    """Names as they are read: A, B and C."""
    *others, final = names
    if not others:
        return final
    return f"{', '.join(others)}{last if last == ',' else ' ' + last} {final}"
