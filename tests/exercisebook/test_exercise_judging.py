"""Answers that are meant to break the judge: they fail, end the program, never end, or carry code."""

import contextlib
import itertools
import sys
import threading
import time

import pytest
import sympy

from exercisebook import judging, timeout
from exercisebook.authoring import number, time_function
from exercisebook.judging import UNJUDGED, judge
from exercisebook.timeout import limited
from judged import EVERY_KIND, assert_suffers_no_harm
from plainmath.expressions import t

PERIOD = number(120, "s", "the period")
Y = time_function(1 - sympy.exp(-t / 5), until=25, what="the response")


@pytest.mark.parametrize("kind", EVERY_KIND.values(), ids=EVERY_KIND)
def test_no_answer_does_harm(kind):
    assert_suffers_no_harm(kind)


def test_a_function_cannot_end_the_program():
    assert judge("y", Y, exit).status == UNJUDGED


@pytest.mark.parametrize("make", [lambda: (time.sleep(0.001) for _ in itertools.count()), lambda: EndlessNumber()])
def test_an_endless_answer_is_not_judged(make, monkeypatch):
    monkeypatch.setattr(judging, "SECONDS", 0.1)
    verdict = judge("x", PERIOD, make())
    assert verdict.status == UNJUDGED
    assert "takes too long" in verdict.says


class EndlessNumber:
    """A number that never comes to an end."""

    def __complex__(self):
        while True:
            time.sleep(0.001)


def test_of_an_endless_list_the_beginning_is_read():
    assert "there are 10000 values" in judge("x", PERIOD, itertools.count()).says


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


@pytest.mark.parametrize("has_threads", [True, False])
def test_a_limited_computation_raises_what_it_raises(monkeypatch, has_threads):
    """Without threads, as in a browser, whose page ends what takes too long, it is computed directly."""
    monkeypatch.setattr(timeout, "HAS_THREADS", has_threads)
    assert (limited(1, threading.get_ident) == threading.get_ident()) is not has_threads
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
