"""The notation of a chart: lines of text with steps, actions and transitions, as one would write them by hand.

A line is a step with its actions, ``Fill: inlet on``, or a transition with its condition, ``Fill -> Heat: level >=
0.9``. Several steps before or behind an arrow, with + between them, are simultaneous. The first step is the initial one
unless another one says so, ``Wait (initial)``. A duration alone, ``120 s``, is the time of the step. Other forms are
read as well: several words for on and off, conditions behind `if` or in brackets, transitions below their step, a table
with a row for each step, its actions, and the transition to the next one.
"""

from __future__ import annotations

import re
from collections.abc import Iterable
from dataclasses import dataclass, field

from exercisebook.grammar import Unreadable, shortened
from loopbook.exercises.charts.signals import Signals
from loopbook.sequence import Chart, Transition

MOST_LINES, LONGEST = 200, 4000

_ARROW = re.compile(r"\s*(?:-+>|→|⇒|⟶|➔|➜)\s*")
_THICK = re.compile(r"\s*=+>\s*")
_BULLET = re.compile(r"^\s*(?:[-*•]\s+(?!>)|\d+[.)]\s+)")
_COMMENT = re.compile(r"(#|//).*")
_LABELLED = re.compile(r"\s-+\[?\s*(?!>)((?:[^\[\]>]|>(?=[=\s]))*?[^\[\]>\s-])\s*\]?-+>")  # Wait --start--> Fill
_INITIAL = re.compile(
    r"(?i)^(?:the )?(?:initial(?: step)?|(?:start|first) step)(?: is|:| =| ) *(\w.*)$"
    r"|^(.+) is (?:the )?initial(?: step)?$"
)
_GO = re.compile(r"(?i)^(?:then )?(?:go to|goto|next step|next|continue with)[: ]+(.+)$")
_FROM = re.compile(r"(?i)^(?:transition )?from (.+?) to (.+)$")
_BRACKET = re.compile(r"^(.*?)\s*[\[({]\s*(.+?)\s*[\])}]$")
_CONDITION = re.compile(
    r"(?i)^([^:,]+?)\s*(?::|,|\b(?:if|when|once|as soon as)\b)\s*(.*)$|^(\S+(?: \S+)?)\s+(after\b.*)$"
)
_MARK = re.compile(r"(?i)\((?:initial|start|initial step)\)|\binitial[_ ]step\b|\*$|^\*|^initial\b|\binitial$")
_RULE = re.compile(r"[-:]+")
_TO = re.compile(r"(?i)^(.*?),?\s*(?:(?:back |then |go )*\bto\b|[-=]+>|→)\s*(\w+)$")
_STEP = re.compile(r"(?i)^step\b[: ]*(?=\S)")


@dataclass
class WrittenChart:
    """A chart as it was read: plain data.

    Attributes:
        initial: the name of the initial step.
        steps: ``{step: {output: whether it is switched on}}``.
        transitions: steps before it, steps behind it, and its condition.
    """

    initial: str = ""
    steps: dict[str, dict[str, bool]] = field(default_factory=dict)
    transitions: list[tuple[tuple[str, ...], tuple[str, ...], str]] = field(default_factory=list)

    @property
    def text(self) -> str:
        """The chart in lines, each step followed by the transitions that leave it; it reads back as the same chart."""
        lines = []
        for step in sorted(self.steps, key=lambda step: step != self.initial):
            actions = ", ".join(f"{name} {'on' if on else 'off'}" for name, on in self.steps[step].items())
            mark = " (initial)" if step == self.initial else ""
            lines += [f"{step}{mark}: {actions or 'none'}"]
            lines += [self.line(way) for way in self.transitions if way[0][0] == step]
        return "\n".join(lines)

    @staticmethod
    def line(way: tuple[tuple[str, ...], tuple[str, ...], str]) -> str:
        """A transition as a line."""
        before, behind, condition = way
        return f"{' + '.join(before)} -> {' + '.join(behind)}: {condition}"

    def leaving(self, step: str) -> list[tuple[tuple[str, ...], tuple[str, ...], str]]:
        """The transitions that leave a step, in the order of their priority."""
        return [way for way in self.transitions if step in way[0]]

    def chart(self, signals: Signals, step: float | None = None) -> Chart:
        """The chart that runs; raises ValueError where the check of charts finds a mistake in it."""
        final = [name for name in self.steps if not self.leaving(name)]
        try:
            return Chart(
                tuple(signals.inputs), dict.fromkeys(signals.outputs, False), self.steps, self.initial,
                [Transition(*way) for way in self.transitions], final, step=step,
            )  # fmt: skip
        except ValueError as error:
            says = str(error)
            for before, behind, _ in self.transitions:  # the library's names of transitions, in the reader's notation
                name = Transition(before, behind).name
                says = re.sub(rf"\b{name}\b", f"{' + '.join(before)} -> {' + '.join(behind)}", says)
            raise ValueError(says) from None


def read_chart(given: str | Iterable[str], signals: Signals) -> WrittenChart:
    """Read a chart from lines of text.

    Arguments:
        given: a text, or its lines.
        signals: those of the plant.
    Raises:
        Unreadable: in one sentence that names the line.

    >>> lamp = Signals({"button": ""}, ["light"])
    >>> chart = read_chart("Dark -> Bright: button; Bright: light on; Bright → Dark: 60 s; Dark: light off", lamp)
    >>> print(chart.text)
    Dark (initial): light off
    Dark -> Bright: button
    Bright: light on
    Bright -> Dark: Bright.T >= 60
    """
    lines = [line for text in ([given] if isinstance(given, str) else given) for line in text.splitlines()]
    if sum(map(len, lines)) > LONGEST or len(lines) > MOST_LINES:
        raise Unreadable(f"the chart is very long: expected at most {MOST_LINES} lines and {LONGEST} characters")
    numbered = _untabled([(n, _COMMENT.sub("", line)) for n, line in enumerate(lines, start=1)])
    numbered = [(n, part) for n, line in numbered for part in line.split(";")]
    numbered = [(n, " ".join(_BULLET.sub("", part).split()), part) for n, part in numbered if part.strip()]
    if not numbered:
        raise Unreadable("the chart is empty: expected lines such as 'Fill: inlet on' and 'Fill -> Heat: level >= 0.9'")
    return _Reader(signals).read(numbered)


def _untabled(lines):
    """The lines of a chart, where a table is one for each step and for each transition; others stay as they are."""
    rows = [(n, [cell.strip(" `") for cell in line.strip()[1:-1].split("|")])
            for n, line in lines if re.fullmatch(r"\s*\|.*\|\s*", line)]  # fmt: skip
    rows = [(n, cells) for n, cells in rows if not all(map(_RULE.fullmatch, cells))]
    if not rows:
        return lines
    if any("step" in cell.casefold() for cell in rows[0][1]):
        del rows[0]  # the heads of the columns
    found = [(n, line) for n, line in lines if not line.lstrip().startswith("|")]
    following = [_MARK.sub("", cells[0]).strip(" `") for _, cells in [*rows[1:], *rows[:1]]]
    for (n, cells), after in zip(rows, following, strict=True):
        step, actions, *conditions = (cell.replace("`", "") for cell in cells)
        name = _MARK.sub("", step).strip()
        found.append((n, f"{step}: {actions}"))
        for condition in filter(None, re.split(r"<br ?/?>", " ".join(conditions))):
            way = _TO.match(condition.strip())
            found.append((n, f"{name} -> {way[2] if way else after}: {way[1] if way else condition.strip()}"))
    return found


class _Reader:
    """Reads the lines of a chart one after the other, twice: first the names of the steps, then all of it."""

    def __init__(self, signals):
        self.signals = signals
        self.names = {}  # of the steps, by their names in small letters
        self.current, self.chart = "", WrittenChart()

    def read(self, lines):
        for only_names in (True, False):
            self.only_names, self.current = only_names, ""
            for n, line, written in lines:
                try:
                    self._line(line)
                except Unreadable as problem:
                    raise Unreadable(f"line {n}, '{shortened(' '.join(written.split()), 50)}': {problem}") from None
        chart = self.chart
        if not chart.transitions:
            raise Unreadable("the chart has no transition: expected one such as 'Fill -> Heat: level >= 0.9'")
        chart.initial = chart.initial or next(iter(chart.steps))
        # an order of its own, so that a chart reads the same however its lines are mixed
        found = WrittenChart(chart.initial)
        for step in sorted(chart.steps, key=lambda step: step != chart.initial):
            found.steps[step] = chart.steps[step]
            found.transitions += [way for way in chart.transitions if way[0][0] == step]
        return found

    # ---------------------------------------------------------------------------------------------------- a line

    def _line(self, line):
        line = _LABELLED.sub(r" -> \1 ->", line)
        parts = _ARROW.split(line)
        if len(parts) == 1:
            steps, colon, condition = line.partition(":")
            parts = _THICK.split(steps + colon + re.sub(r"=>(?=\s*-?\d)", ">=", condition))
        if len(parts) == 1 and (way := _FROM.match(line)):
            parts = list(way.groups())
        if len(parts) == 1 and (way := _GO.match(line)) and self.current:
            parts = ["", way[1]]
        if len(parts) > 1:
            self._way([part.strip() for part in parts])
        elif (initial := _INITIAL.match(line)) and not (initial[1] and self._are_actions(initial[1])):
            self.chart.initial = self._step(initial[1] or initial[2])
        elif ":" in line.replace(":=", "") and not self._are_actions(line):
            name, _, actions = (part.strip() for part in line.partition(":"))
            self.current = self._step(name)
            self._act(actions)
        elif not self.current or _STEP.match(line) or (not self._are_actions(line) and self._is_name(line)):
            if self._are_actions(line):
                raise Unreadable("there is no step before these actions: expected its name, as in 'Fill: inlet on'")
            self.current = self._step(line)
        else:
            self._act(line)

    def _act(self, text):
        if text and not self.only_names:
            found = self.signals.actions(text)
            actions = self.chart.steps[self.current]
            for name, on in found.items():
                if actions.setdefault(name, on) != on:
                    raise Unreadable(
                        f"{name} is switched on and off in the step {self.current}: expected one of the two"
                    )

    def _way(self, parts):
        left, *middle, right = parts
        condition = ""
        if ":" in left.replace(":=", ""):  # a step with its actions, or the name of the transition
            name, _, rest = (part.strip() for part in left.partition(":"))
            if not rest or self._are_actions(rest):
                self._line(f"{name}: {rest}")
                left = ""
            else:
                left = rest
        if len(middle) > 1 or (middle and not self._is_condition(middle[0])):
            raise Unreadable(
                "there are several arrows: expected one transition in a line, as 'Fill -> Heat: level >= 0.9'"
            )
        if middle:
            condition = middle[0]
        elif (match := _BRACKET.match(left)) and match[1] and self._is_condition(match[2]):
            left, condition = match.groups()
        elif left and not self._is_step(left) and self._is_condition(left) and self.current:
            left, condition = "", re.sub(r"(?i)^(if|when) ", "", left)
        if not left and not self.current:
            raise Unreadable("there is no step before the arrow: expected one, as in 'Fill -> Heat: level >= 0.9'")
        before = self._steps(left) if left else (self.current,)
        if not condition:
            right, condition = self._divided(right)
        if not right:
            raise Unreadable("there is no step behind the arrow: expected one, as in 'Fill -> Heat: level >= 0.9'")
        behind = self._steps(right)
        if not self.only_names:
            way = (before, behind, self.signals.condition(condition, before[0], self.names))
            if way not in self.chart.transitions:
                self.chart.transitions.append(way)

    def _divided(self, right):
        """What is behind an arrow: the steps, and the condition, which may be empty."""
        if (match := _BRACKET.match(right)) and match[1] and self._is_condition(match[2]):
            return match.groups()
        if ":" in right:
            steps, _, condition = right.partition(":")
            return steps.strip(), re.sub(r"(?i)^ *(if|when|once) ", "", condition).strip()
        if match := _CONDITION.match(right):
            steps, condition = match[1] or match[3], match[2] or match[4]
            if self._is_condition(condition):
                return steps.strip(), condition
            if not re.search(r",", right) or re.search(r"(?i)\b(if|when)\b", right):
                return steps.strip(), condition
        return right, ""

    # --------------------------------------------------------------------------------------------- names of steps

    def _steps(self, text):
        """The steps before or behind an arrow."""
        parts = re.split(r"\+|&|,|\band\b", text.strip("(){}[] ")) if not self._is_step(text) else [text]
        return tuple(dict.fromkeys(self._step(part) for part in parts if part.strip()))

    def _is_step(self, text):
        return _plain_name(text).casefold() in self.names

    def _step(self, text):
        """The name of a step, which is known from here on."""
        initial = bool(_MARK.search(text))
        name = _plain_name(text)
        if not name.isidentifier() or len(text.split()) > 4:
            raise Unreadable(
                f"{shortened(text.strip(), 40)!r} is not the name of a step: "
                "expected lines such as 'Fill: inlet on' and 'Fill -> Heat: level >= 0.9'"
            )
        name = self.names.setdefault(name.casefold(), name)
        if name in self.signals.names:
            raise Unreadable(f"{name} is a signal: expected another name for the step")
        self.chart.steps.setdefault(name, {})
        if initial:
            self.chart.initial = name
        return name

    def _is_name(self, text):
        return len(text.split()) <= 3 and _plain_name(text).isidentifier() and not self.signals.named(text)

    def _is_condition(self, text):
        """Whether a text reads as a condition; a step that is known has the first claim on its name."""
        if self._is_step(text) and text in self.names.values():
            return False
        try:
            self.signals.condition(text, "Step", self.names | {"step": "Step"})
        except Unreadable as problem:
            # while the names are gathered, the time of a step that comes later is a condition, too
            return bool(re.search(r"[<>=≥≤]|\.[TtXx]\b", text)) or "is not a step" in str(problem)
        return True

    def _are_actions(self, text):
        try:
            return bool(self.signals.actions(text)) or not text.strip()
        except Unreadable:
            return False


def _plain_name(text):
    """The name of a step as the chart has it: Filling_tank, S1."""
    text = _STEP.sub("", _MARK.sub("", text).strip(" []()'\"`*:."))
    name = re.sub(r"[\s-]+", "_", text.strip(" []()'\"`*:."))
    return f"S{name}" if name[:1].isdigit() else name
