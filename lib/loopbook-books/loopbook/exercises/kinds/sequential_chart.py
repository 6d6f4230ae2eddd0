"""Sequential function charts, written as text and judged by what they do on a plant."""

from __future__ import annotations

import re
import textwrap
from collections.abc import Iterable, Iterator, Mapping
from typing import TYPE_CHECKING, Any

from exercisebook.grammar import Unreadable
from exercisebook.kinds.kind import AS_IT_IS, LINES, Kind, Tried
from exercisebook.reading import alone, answered, in_a_row
from exercisebook.timeout import limited
from loopbook.exercises.charts.notation import WrittenChart, read_chart
from loopbook.exercises.charts.signals import Signals
from loopbook.sequence import Chart

if TYPE_CHECKING:
    from loopbook.exercises.charts.running import ChartRun, Demand, Scenario
    from loopbook.figures import Picture

#: Running a chart in all scenarios may take so many seconds.
SECONDS = 4


class SequentialChart(Kind):
    r"""A sequential function chart, read from lines of text and run on a plant in several scenarios.

    Arguments:
        key: a chart that does what is asked, in the same notation; in a run it says what the plant is in need of.
        inputs: ``{name: unit}`` of what the chart reads; the unit of a button is empty.
        outputs: the names of what it switches on and off.
        demands: each a `charts.running.Demand`, or a list of its parts.
        scenarios: each a `charts.running.Scenario`, or a list of its parts.
        what: the chart in words.
        also: ``{name: other names}`` of signals.
        plant: one of `charts.running.PLANTS`.

    >>> asked = {"start": "", "level": "m"}, ["inlet"]
    >>> key = "Wait -> Fill: start; Fill: inlet on; Fill -> Full: level >= 0.9; Full: inlet off; Full -> Wait: 30 s"
    >>> demand = ("the inlet is open, although the level has reached 0.9 m", "inlet", "Full")
    >>> filling = SequentialChart(key, *asked, [demand], [("", 1, {"start": "Wait.X"})])
    >>> answer, _ = filling.read("A -> B: start; B: inlet on; B -> A: level > 1 m")
    >>> filling.hint(answer)
    'at t = 170\xa0s the inlet is open, although the level has reached 0.9 m: B is active and waits for level > 1'
    """

    FORM = ("inputs", "outputs", "also")
    expected = "lines such as 'Fill: inlet on' and 'Fill -> Heat: level >= 0.9'"
    accuracy = ""
    draws = True

    def __init__(
        self,
        key: object,
        inputs: Mapping[str, str],
        outputs: Iterable[str],
        demands: Iterable[Demand | Iterable[Any]],
        scenarios: Iterable[Scenario | Iterable[Any]],
        what: str = "the chart",
        also: Mapping[str, Iterable[str]] | None = None,
        plant: str = "batch tank",
    ):
        self.inputs, self.outputs, self.also, self.plant = dict(inputs), list(outputs), also, plant
        self.demands, self.scenarios = [tuple(one) for one in demands], [tuple(one) for one in scenarios]
        super().__init__(key, "", what, 0)
        self.referee, self._known = self.key, {}

    @property
    def signals(self) -> Signals:
        """What the chart reads and sets."""
        return Signals(self.inputs, self.outputs, self.also or {})

    @property
    def asked(self) -> str:
        """The chart with its signals."""
        reads = ", ".join(f"`{name}` in {unit}" if unit else f"`{name}`" for name, unit in self.inputs.items())
        sets = ", ".join(f"`{name}`" for name in self.outputs)
        return f"{self.what}, as lines of text; it reads {reads}, and switches {sets} on and off"

    def read(self, given: object) -> tuple[str, str]:
        """Return the chart in lines of one form; a `loopbook.sequence.Chart` is read as well."""
        given = alone(answered(given))
        if isinstance(given, Chart):
            given = _as_text(given)
        lines = [given] if isinstance(given, str) else in_a_row(given)
        if not lines or not all(isinstance(line, str) for line in lines):
            raise Unreadable(f"this is not a chart: expected {self.expected}")
        return read_chart(lines, self.signals).text, ""

    def written(self, answer: str) -> str:
        """The lines of the chart in one."""
        return "; ".join(answer.splitlines())

    def agrees(self, answer: str) -> bool:
        """Whether the chart meets all demands in all scenarios."""
        return not self.hint(answer)

    def hint(self, answer: str) -> str:
        """Say what happens in the first run in which a demand is not met; empty for a chart that is right."""
        found = self._found(answer)
        if isinstance(found, str):
            return found
        scenario, run = found
        if run.violated is None:
            return ""
        (says, *_), time = run.violated
        when = self.scenarios[scenario][0]
        begins = [when] if when else []
        begins += [f"after {'the first round' if run.rounds == 1 else f'{run.rounds} rounds'}"] if run.rounds else []
        at = f"at t = {time:g}\N{NO-BREAK SPACE}s" if time else "from the beginning"
        return f"{', '.join([*begins, at])} {says}" + (f": {run.why}" if run.why else "")

    def is_value(self, answer: str, wrong: object) -> bool:
        """Whether a chart fails as that of a mistake does: at the same demand, and for the same cause."""
        return answer == wrong or self._failure(answer) == self._failure(self.read(wrong)[0])

    def picture(self, answer: str) -> Picture | None:
        """The run in which a demand is not met, or the first one, and the chart as it was read."""
        return self.drawn(answer, "What your chart does", "Your chart, as it was read")

    def drawn(self, answer: str, run_title: str = "A run", chart_title: str = "The chart") -> Picture | None:
        """The run that counts and the chart, each with a title; None for a chart that cannot run."""
        from loopbook.diagrams import sequential_function_chart
        from loopbook.figures import sequence_trends, stacked

        found = self._found(answer)
        if isinstance(found, str):
            return None
        (_, run), chart = found, self._chart(answer)
        says = self.hint(answer).partition(": ")[0]
        title = textwrap.fill(says[:1].upper() + says[1:] or run_title, 76)
        trends = [name for name, unit in self.inputs.items() if unit]
        switched = [name for name, unit in self.inputs.items() if not unit] + self.outputs
        plot = sequence_trends(run, chart, trends, switched, title=title, minutes=True)
        if run.violated and run.violated[1] <= run.times[-1]:
            for axes in plot.figure.axes:
                axes.axvline(run.violated[1] / 60, color="black", linestyle=":", linewidth=1.2)
        return stacked(plot, sequential_function_chart(chart, title=chart_title))

    # ----------------------------------------------------------------------------------------------- runs of a chart

    @property
    def field(self) -> dict[str, Any]:
        """Lines."""
        says = "A line for each step and each transition, as `Fill: inlet on` and `Fill -> Heat: level >= 0.9`."
        return {"control": LINES, "asked": self.asked.replace(", as lines of text", ""), "help": says}

    def right_forms(self) -> Iterator[Tried]:
        """The chart as a list of lines."""
        yield AS_IT_IS, self.key
        yield "as a list of lines", self.key.splitlines()

    def wrong_forms(self) -> Iterator[Tried]:
        """Charts that only switch something on."""
        for output in self.outputs:
            yield f"a chart that only switches {output} on", f"Start: {output} on"

    def _chart(self, text):
        from loopbook.exercises.charts.running import SCAN

        return read_chart(text, self.signals).chart(self.signals, SCAN)

    def _found(self, text):
        """The number of the scenario that counts and its run, or a sentence on a chart that cannot run."""
        if text not in self._known:
            try:
                self._known[text] = limited(SECONDS, self._runs, text)
            except ValueError as error:
                self._known[text] = str(error)
        return self._known[text]

    def _runs(self, text) -> tuple[int, ChartRun]:
        from loopbook.exercises.charts.running import PLANTS, Demand, Scenario, run_chart

        found = None
        demands = [Demand(*one) for one in self.demands]
        for number, scenario in enumerate(self.scenarios):
            charts = self._chart(text), self._chart(self.referee)
            run = run_chart(*charts, PLANTS[self.plant](), Scenario(*scenario), demands)
            if run.violated:
                return number, run
            found = found or (number, run)
        return found

    def _failure(self, text):
        """What makes two wrong charts wrong in the same way."""
        found = self._found(text)
        if isinstance(found, str):
            return "", text
        scenario, run = found
        return scenario, run.violated and run.violated[0], re.sub(r"\d+(\.\d+)?", "#", run.cause)


def _as_text(chart):
    """A chart that runs in lines of text."""
    written = WrittenChart(chart.initial)
    for step, actions in chart.actions.items():
        written.steps[step] = {output: formula.text == "TRUE" for output, formula in actions}
    written.transitions = [(x.sources, x.targets, x.condition) for x in chart.transitions]
    return written.text
