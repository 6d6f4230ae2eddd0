"""Answers that are meant to break the judge: they fail, end the program, never end, or carry code."""

import contextlib
import itertools
import sys
import threading
import time

import pytest
import sympy

from exercisebook import judging, timeout
from exercisebook.judging import UNJUDGED, judge
from exercisebook.timeout import limited
from judged import EVERY_KIND
from loopbook import t
from loopbook.exercises.authoring import number, time_function

TI = number(120, "s", "the integral time")
Y = time_function(1 - sympy.exp(-t / 5), until=25, what="the response")
each_kind = pytest.mark.parametrize("kind", EVERY_KIND.values(), ids=EVERY_KIND)


class Liar:
    """An answer whose methods all fail."""

    def _fails(self, *_):
        raise RuntimeError("no")

    __eq__ = __float__ = __complex__ = __repr__ = __str__ = __iter__ = __len__ = __getattr__ = __array__ = _fails
    __hash__ = None


@each_kind
def test_an_answer_that_fails_in_every_way_is_not_judged(kind):
    assert judge("x", kind, Liar()).status == UNJUDGED


class Interrupting:
    """An answer whose methods end the program."""

    def _ends(self, *_):
        raise SystemExit

    def _interrupts(self, *_):
        raise KeyboardInterrupt

    __complex__ = __float__ = _ends
    __getattr__ = _interrupts


@each_kind
def test_an_answer_cannot_end_the_program(kind):
    assert judge("x", kind, Interrupting()).status == UNJUDGED


def test_a_function_cannot_end_the_program():
    assert judge("y", Y, exit).status == UNJUDGED


@pytest.mark.parametrize("make", [lambda: (time.sleep(0.001) for _ in itertools.count()), lambda: EndlessNumber()])
def test_an_endless_answer_is_not_judged(make, monkeypatch):
    monkeypatch.setattr(judging, "SECONDS", 0.1)
    verdict = judge("x", TI, make())
    assert verdict.status == UNJUDGED
    assert "takes too long" in verdict.says


class EndlessNumber:
    """A number that never comes to an end."""

    def __complex__(self):
        while True:
            time.sleep(0.001)


def test_of_an_endless_list_the_beginning_is_read():
    assert "there are 10000 values" in judge("x", TI, itertools.count()).says


@pytest.mark.parametrize(
    "given",
    ["$\\href{javascript:alert(1)}{x}$", "\ud800", "two\nlines", sympy.Symbol("$x$"), sympy.Symbol("x" * 10**5)],
)
@each_kind
def test_what_is_quoted_of_an_answer_is_harmless(kind, given):
    says = judge("x", kind, given).says
    assert "$" not in says
    assert "\n" not in says
    assert len(says) <= 400
    assert says.encode("utf-8")


def test_a_limited_computation_is_stopped():
    def endless():
        while True:
            with contextlib.suppress(Exception):  # it does not want to be stopped
                time.sleep(0.001)

    before = {*threading.enumerate()}
    with pytest.raises(TimeoutError):
        limited(0.05, endless)
    for worker in {*threading.enumerate()} - before:
        worker.join(60)
        assert not worker.is_alive()


def test_a_limited_computation_raises_what_it_raises():
    with pytest.raises(ZeroDivisionError):
        limited(1, lambda: 1 / 0)
    with pytest.raises(RuntimeError, match="stopped by SystemExit"):
        limited(1, sys.exit)


def test_without_threads_it_is_computed_directly(monkeypatch):
    """As in a browser, whose page ends what takes too long."""
    monkeypatch.setattr(timeout, "HAS_THREADS", False)
    assert limited(1, threading.get_ident) == threading.get_ident()
    with pytest.raises(ZeroDivisionError):
        limited(1, lambda: 1 / 0)
    with pytest.raises(RuntimeError, match="stopped by SystemExit"):
        limited(1, sys.exit)


def test_what_counts_is_the_time_of_the_processor(monkeypatch):
    """Whoever waits for the processor is not slow; who sleeps for long, or computes, is."""
    spent = iter([0.0, 0.01, 0.02])
    monkeypatch.setattr(time, "process_time", lambda: next(spent, 0.02))
    assert limited(0.2, lambda: time.sleep(0.4) or "done") == "done"
    with pytest.raises(TimeoutError):
        limited(0.1, lambda: [time.sleep(0.001) for _ in iter(int, 1)])
    monkeypatch.undo()
    with pytest.raises(TimeoutError):
        limited(0.1, lambda: [None for _ in iter(int, 1)])
