"""Running the cells of a notebook as its kernel would, without a kernel: the student's side of the grader.

What happens is told as events, one after another; nothing is kept for later, so that what came before a crash counts.
"""

from __future__ import annotations

import asyncio
import json
import random
import signal
from collections.abc import Callable
from typing import Any

import numpy as np
from IPython.core.displayhook import DisplayHook
from IPython.core.displaypub import DisplayPublisher
from IPython.core.interactiveshell import InteractiveShell
from traitlets.config import Config

from exercisebook.judging import harmless
from exercisegrader.inside import answer_sheet


class _Quiet(DisplayHook):
    """The value of a cell goes into ``_``, and nowhere else."""

    def __call__(self, result=None):
        if result is not None and not self.quiet():
            self.update_user_ns(result)
            if showing := getattr(self.shell, "showing", None):
                showing.value(result)


class _Unseen(DisplayPublisher):
    """What a cell displays is seen by nobody, unless the notebook is run to be shown."""

    def publish(self, data, *arguments, **options):
        if showing := getattr(self.shell, "showing", None):
            showing.data(data)


class _Shell(InteractiveShell):
    """IPython with magics and shell escapes, which shows nothing; a cell's error is in its result."""

    displayhook_class = _Quiet
    display_pub_class = _Unseen

    def init_display_formatter(self):
        super().init_display_formatter()
        self.display_formatter.format = lambda *arguments, **options: ({}, {})

    def showtraceback(self, *arguments, **options):
        pass

    showsyntaxerror = showtraceback

    def enable_gui(self, gui=None):
        pass

    def ask_exit(self):
        pass


class OutOfTime(BaseException):
    """A cell took longer than it may; no ``except Exception`` of the cell stops this one."""


def shell() -> InteractiveShell:
    """Return a shell without history, in which `sheet` is a sheet that takes every answer."""
    settings = Config()
    settings.HistoryManager.enabled = False
    settings.InteractiveShell.colors = "nocolor"
    made = _Shell.instance(config=settings)
    made.user_ns["sheet"] = answer_sheet.AnswerSheet("", student="")
    return made


def run(
    content: bytes,
    interpreter: InteractiveShell,
    tell: Callable[[dict[str, Any]], object],
    seconds: float,
    show: bool = False,
) -> None:
    """Run a notebook, cell after cell; after an error the next cell follows.

    Arguments:
        content: a notebook as `sources.sources` returns it.
        interpreter: the shell.
        tell: a function that takes an event, a dictionary with one entry: "made for" with the student that the notebook
            names, "cell" with the number of a code cell that begins, "error" with the cell and a sentence, "answer"
            with student, exercise and what was given, "end".
        seconds: that a cell may take.
        show: tell also what the cells show, as `showing.Showing` does.
    """
    notebook = json.loads(content)
    if imprint := notebook["metadata"].get("loopbook"):
        tell({"made for": imprint["student"]})
    answer_sheet.deliver = lambda student, exercise, given: tell(
        {"answer": {"student": student, "exercise": exercise, "given": given}}
    )
    signal.signal(signal.SIGALRM, _out_of_time)
    asyncio.set_event_loop(asyncio.new_event_loop())
    random.seed(0), np.random.seed(0)  # the same numbers each time it is graded
    showing = None
    if show:
        from exercisegrader.inside.showing import Showing

        showing = Showing(interpreter, tell)
    sources = (cell["source"] for cell in notebook["cells"] if cell["cell_type"] == "code")
    for number, source in enumerate(sources, start=1):
        tell({"cell": number})
        if showing:
            showing.begin(number)
        says = _error(interpreter, source, seconds)
        if showing:
            showing.end()
        if says:
            tell({"error": {"cell": number, "says": says}})
    tell({"end": True})


def _error(interpreter, source, seconds):
    """Run a cell, and return the error that ended it, in a line; an empty text where there was none."""
    # again each second: the first one may meet an ``except:`` of the cell
    signal.setitimer(signal.ITIMER_REAL, seconds, 1)
    try:
        result = interpreter.run_cell(source)
        problem = result.error_before_exec or result.error_in_exec
        signal.setitimer(signal.ITIMER_REAL, 0)
    except BaseException as late:  # in the shell's own work, before or after the cell's
        signal.setitimer(signal.ITIMER_REAL, 0)
        problem = late
    if problem is None:
        return ""
    if isinstance(problem, OutOfTime):
        return f"it took longer than {seconds:g} s"
    try:
        return harmless(f"{type(problem).__name__}: {problem}")
    except Exception:  # an error of the student's own making may not even have a text
        return harmless(type(problem).__name__)


def _out_of_time(number, frame):
    raise OutOfTime
