"""A sequential function chart as data, and how it runs.

The semantics are those of IEC 61131-3 in a controller that works in scans. In the first scan the initial step becomes
active, and no transition is cleared (the standard leaves this open). Each later scan

1. reads the inputs;
2. finds the transitions that are enabled, which means that all steps before them have been active since the scan
   before, and whose condition is true; conditions see the inputs, and the outputs as the scan before has left them;
3. clears all of these at once: the steps before them become passive, the steps behind them active. Of several from one
   step only the first in the order of the list is cleared, so that no step is left by two;
4. executes the actions of the steps that have become active, once, in the order in which the steps are listed. An
   action assigns a value to an output, which keeps it until another step assigns another one.

So a step is active for one scan at least, also before an unconditional transition. The time of a step is zero when it
is activated, runs while it is active, and keeps its value when the step becomes passive. Actions that are executed once
at activation and store their values are the standard's qualifier P1 with assignments; a chart then lists only what a
step changes, as the book's action boxes do.

Why no state-machine library: in `transitions` and ``python-statemachine`` a machine waits for events, a transition has
one source and one target (several sources are alternatives), and parallel states must be nested; Petri net libraries
such as SNAKES have every convergence, but clear one transition at a time, without scan and priority.
"""

from __future__ import annotations

import copy
from collections.abc import Iterable, Mapping, Sequence
from typing import Any

from loopbook.sequence import checks
from loopbook.sequence.formulas import Formula
from loopbook.sequence.transitions import Transition
from loopbook.types import Number
from plainmath.validation import number, positive

__all__ = ["Chart", "Scans", "scan_by_scan"]


class Chart:
    """A sequential function chart: a block for `simulate`, checked before it runs. (Haugen, Chapter 12)

    Attributes:
        tag: the name in a run, where "SFC.Heat" is 1 while the step Heat is active.
        reads, writes: the names of the signals, the inputs and the outputs.
        step: time between two scans; None for every sample of the run.
        steps, initial, transitions, final: as given.
        active: the names of the active steps; none before the first scan.
        markings: all sets of steps that can be active together, with the conditions taken as free:
            ``{marking: [(transition, next marking)]}``, frozen sets of steps, the initial one first.

    Arguments:
        inputs: names of the signals that the conditions use, a tuple or a text with blanks.
        outputs: ``{name: value before the start}``; a truth value makes the output boolean, a number a number.
        steps: ``{step: {output: value}}``: the actions are the changes. A value is a number, TRUE or FALSE, or a text
            such as "batches + 1".
        initial: name of the initial step.
        transitions: list of `Transition`; where several leave one step, the first whose condition is true is taken.
        final: names of the steps that no transition leaves.
    Raises:
        ValueError: for no or two initial steps, a step that is unknown, that cannot be reached or that can stay active
            forever without being final, an unknown signal, a signal that is input and output, a condition that is
            none, a value that does not fit its output, a convergence whose steps are never active together, a step that
            could be activated while it is active, a transition that is never cleared, what is of another kind.

    >>> lamp = Chart("on off", {"light": False}, {"Dark": {"light": False}, "Bright": {"light": True}}, "Dark",
    ...              [Transition("Dark", "Bright", "on"), Transition("Bright", "Dark", "off OR Bright.T >= 60")])
    >>> for time in (0, 1, 2):
    ...     print(lamp.update({"on": 1, "off": 0}, time), lamp.active)
    {'light': 0.0} ('Dark',)
    {'light': 1.0} ('Bright',)
    {'light': 1.0} ('Bright',)
    """

    reads: tuple[str, ...]
    writes: tuple[str, ...]
    active: tuple[str, ...]
    markings: checks.Markings

    def __init__(
        self,
        inputs: str | Iterable[str],
        outputs: Mapping[str, Number],
        steps: Mapping[str, Mapping[str, Number | str]],
        initial: str | Sequence[str],
        transitions: Iterable[Transition | Sequence[Any]],
        final: str | Iterable[str] = (),
        tag: str = "SFC",
        step: Number | None = None,
    ):
        inputs = checks.several("the inputs", inputs, "names of signals")
        checks.kinds(outputs, steps, tag, step)
        checks.names(inputs, outputs, steps)
        self.tag, self.reads, self.writes, self.step = tag, inputs, tuple(outputs), step
        self.outputs, self.steps = dict(outputs), {name: dict(actions) for name, actions in steps.items()}
        self.initial = checks.initial_step(initial, self.steps)
        self.final = checks.several("the final steps", final, "names of steps")
        transitions = checks.several("the transitions", transitions, "a list of them")
        for way in transitions:
            if not (isinstance(way, Transition) or (isinstance(way, (list, tuple)) and len(way) in (2, 3))):
                raise ValueError(f"a transition is {way!r}: expected one such as Transition('Fill', 'Heat', 'h > 0.9')")
        self.transitions = [x if isinstance(x, Transition) else Transition(*x) for x in transitions]
        for name, value in self.outputs.items():
            if not isinstance(value, bool):
                number(f"the output {name}", value, "a number, or TRUE or FALSE")
        self.conditions = [Formula(x.condition, f"the condition of {x.name}").condition() for x in self.transitions]
        checks.connections(self.steps, self.initial, self.final, self.transitions, self.conditions)
        for formula in self.conditions:
            self._known(formula)
        self.actions = {step: self._read(step, actions) for step, actions in self.steps.items()}
        self.markings = checks.situations(self.steps, self.initial, self.final, self.transitions)
        used = [*self.conditions, *(formula for actions in self.actions.values() for _, formula in actions)]
        # the flags and times of steps that a formula needs
        self._flags = {name: name.split(".") for formula in used for name in formula.names if "." in name}
        self.active, self._stored = (), {name: float(x) for name, x in self.outputs.items()}
        self._since, self._lasted = {}, {}  # when a step was activated, and its time when it became passive

    def __repr__(self) -> str:
        return f"<chart {self.tag}: {len(self.steps)} steps, {len(self.transitions)} transitions>"

    def _known(self, formula):
        for name in formula.names:
            step, dot, _ = name.partition(".")
            if dot and step not in self.steps:
                raise ValueError(f"{formula.owner} has {name}, but {step} is not a step of the chart")
            if not dot and name not in (*self.reads, *self.writes):
                raise ValueError(f"{formula.owner} has the unknown signal {name}: expected an input or an output")

    def _read(self, step, actions):
        """The actions of a step as formulas, which fit their outputs."""
        found = []
        for output, value in actions.items():
            owner = f"the action on {output} in {step}"
            if output not in self.outputs:
                raise ValueError(f"the step {step} has an action on the unknown signal {output}: expected an output")
            boolean = isinstance(self.outputs[output], bool)
            if not isinstance(value, (str, bool)):
                value = f"{number(owner, value, 'a number, TRUE, FALSE or a formula'):.15g}"
            formula = Formula(value, owner)
            self._known(formula)
            if formula.kind == ("number" if boolean else "boolean"):
                expected = "TRUE or FALSE" if boolean else "a number"
                raise ValueError(f"{owner} assigns {formula.text}: expected {expected}, as the output is declared")
            found.append((output, formula))
        return found

    @property
    def recorded(self) -> dict[str, float]:
        """Which steps are active, as 1 and 0."""
        return {step: float(step in self.active) for step in self.steps}

    def take_over(self, earlier: Chart) -> None:
        """Go on where the same chart, maybe with other conditions, has stopped in an earlier run.

        Raises:
            ValueError: for steps that cannot be active together in this chart.
        """
        if earlier.active and frozenset(earlier.active) not in self.markings:
            raise ValueError(f"{self.tag} cannot go on with {checks.listed(earlier.active, 'and')} active")
        self.active, self._since, self._lasted = earlier.active, dict(earlier._since), dict(earlier._lasted)
        self._stored |= {name: value for name, value in earlier._stored.items() if name in self._stored}

    def update(self, values: Mapping[str, float], time: float) -> dict[str, float]:
        """Run one scan and return the outputs.

        Arguments:
            values: ``{input: number}``, 1 and 0 for TRUE and FALSE.
            time: the moment of the scan.
        Returns:
            ``{output: number}``.
        Raises:
            ValueError: for an input that is missing, or one that is not a truth value where a condition needs one.
        """
        if missing := [name for name in self.reads if name not in values]:
            raise ValueError(f"the input {missing[0]} is missing: the chart reads {checks.listed(self.reads)}")
        known = {name: values[name] for name in self.reads} | self._stored
        self._look(known, time)
        if not self.active:
            begun = {self.initial}
        else:
            left, begun = set(), set()
            for transition, condition in zip(self.transitions, self.conditions, strict=True):
                enabled = all(step in self.active and step not in left for step in transition.sources)
                if enabled and condition.true(known):
                    left.update(transition.sources)
                    begun.update(transition.targets)
            self._lasted.update((step, time - self._since[step]) for step in left)
            active = set(self.active) - left | begun
            self.active = tuple(step for step in self.steps if step in active)
        if not begun:
            return dict(self._stored)
        self.active = self.active or (self.initial,)
        self._since.update(dict.fromkeys(begun, time))
        self._look(known, time)
        for step in self.steps:
            for output, formula in self.actions[step] if step in begun else ():
                value = formula.true if isinstance(self.outputs[output], bool) else formula.value
                known[output] = self._stored[output] = float(value(known))
        return dict(self._stored)

    def _look(self, known, time):
        """Put the flags and times of the steps among the values; nine digits, so that ten steps of 0.1 are one."""
        for name, (step, what) in self._flags.items():
            on = step in self.active
            lasts = time - self._since[step] if on else self._lasted.get(step, 0.0)
            known[name] = on if what == "X" else round(lasts, 9)


class Scans:
    """What `scan_by_scan` returns: a table with one row a scan, as a notebook shows it.

    Attributes:
        heads: the names of the columns.
        rows: a tuple of texts for each scan.
        active: the names of the active steps after each scan.
    """

    def __init__(self, heads: tuple[str, ...], rows: list[tuple[str, ...]], active: list[tuple[str, ...]]):
        self.heads, self.rows, self.active = heads, rows, active

    def __repr__(self) -> str:
        table = [self.heads, *self.rows]
        widths = [max(len(row[n]) for row in table) for n in range(len(self.heads))]
        return "\n".join("  ".join(f"{x:<{n}}" for x, n in zip(row, widths, strict=True)).rstrip() for row in table)

    def _repr_html_(self):
        head = "".join(f"<th>{name}</th>" for name in self.heads)
        body = "".join(f"<tr>{''.join(f'<td>{x}</td>' for x in row)}</tr>" for row in self.rows)
        return f"<table><tr>{head}</tr>{body}</table>"


def scan_by_scan(
    chart: Chart, step: Number = 1, scans: int | None = None, **inputs: Number | Sequence[Number]
) -> Scans:
    """Run a chart by itself, with given inputs, and show each scan.

    Arguments:
        chart: a `Chart`, which is not changed.
        step: time between two scans.
        scans: how many; needed only where no input is a list.
        inputs: a list for each input, one value a scan; True and False for TRUE and FALSE. A single value holds always.
    Returns:
        A `Scans`, which a notebook shows as a table of time, inputs, active steps and outputs after the scan.
    Raises:
        ValueError: for an input that the chart does not have or that is missing, lists of different lengths, what is no
            number, or a step that is not positive.

    >>> lamp = Chart("on", {"light": False}, {"Dark": {}, "Bright": {"light": True}}, "Dark",
    ...              [Transition("Dark", "Bright", "on")], final="Bright")
    >>> scan_by_scan(lamp, on=[False, True, True])
    time  on     active steps  light
    0     FALSE  Dark          FALSE
    1     TRUE   Bright        TRUE
    2     TRUE   Bright        TRUE
    """
    if not isinstance(chart, Chart):
        raise ValueError(f"the chart is {chart!r}: expected a Chart")
    chart = copy.deepcopy(chart)
    if odd := set(inputs) ^ set(chart.reads):
        raise ValueError(f"{sorted(odd)[0]} is missing or no input: the chart reads {checks.listed(chart.reads)}")
    step = positive("the step", step)
    lists = {name: list(x) for name, x in inputs.items() if hasattr(x, "__len__") and not isinstance(x, str)}
    counts = {len(values) for values in lists.values()} | ({scans} if scans is not None else set())
    if len(counts) != 1 or not isinstance(*counts, int):
        raise ValueError("expected lists of one length, one value for each scan, or scans=10 where there are none")
    for name, given in inputs.items():
        for value in lists.get(name, [given]):
            if not isinstance(value, bool):
                number(f"the input {name}", value, "a number, or True or False")
    rows, active = [], []
    for n in range(counts.pop()):
        values = {name: lists[name][n] if name in lists else x for name, x in inputs.items()}
        found = chart.update(values, n * step)
        shown = [found[name] != 0 if isinstance(chart.outputs[name], bool) else found[name] for name in found]
        rows.append((f"{n * step:g}", *map(_word, values.values()), ", ".join(chart.active), *map(_word, shown)))
        active.append(chart.active)
    return Scans(("time", *inputs, "active steps", *chart.writes), rows, active)


def _word(value):
    return str(value).upper() if isinstance(value, bool) else f"{value:.6g}"
