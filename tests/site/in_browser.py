"""What the tests ask of Python in the browser, and partly of the Python here: to judge answers, to run chapters.

This module runs in both. It imports only what the collection needs, and everything that it returns is plain data.
"""

from __future__ import annotations

import functools
import json
import pickle
import re
import time
from collections.abc import Iterator, Sequence
from pathlib import Path
from typing import Any

from exercisebook import judging
from loopbook.exercises import authoring, bank
from loopbook.exercises.kinds import MAKERS

#: What is compared as a picture, or belongs to a kernel only.
NOT_TEXT = {"image/png", "image/jpeg", "application/vnd.jupyter.widget-view+json"}
_PICTURE = re.compile(r"<img\b[^>]*>")
_WORDS = re.compile(r'alt="([^"]*)"')


def perform(jobs: Path, results: Path) -> None:
    """Do all jobs of a file, pickled pairs of a word and what it is about, and write a line of JSON for each."""
    with jobs.open("rb") as file, results.open("w", encoding="utf-8") as out:
        for word, about in pickle.load(file):
            began = time.perf_counter()
            try:
                found = {"is": DOES[word](about)}
            except Exception as error:
                found = {"error": f"{type(error).__name__}: {error}"}
            out.write(json.dumps({**found, "seconds": time.perf_counter() - began}) + "\n")
            out.flush()


# ---- answers


def judged(answer: tuple) -> list:
    """Return what is said to an answer: a list for each asked quantity, and the notes.

    Arguments:
        answer: ("check", number of the exercise, student, answers without a name, answers by their names), ("judge",
            name, code that makes the kind, seed, answer, mistakes), or ("is right", code, seed, answer); the answers
            are pickled.
    """
    what, *rest = answer
    if what == "check":
        number, student, given = rest
        alone, named = pickle.loads(given)
        question = bank.exercises(number.partition(".")[0])[number].question(student)
        question._hints_seen = question._answered = question._bare = 0  # what was answered before is another story
        response = question.check(*alone, **named)
        return [*map(_said, response.verdicts), *response.notes]
    if what == "judge":
        name, making, seed, given = rest
        answer, mistakes = pickle.loads(given)
        return [_said(judging.judge(name, made(making, seed), answer, mistakes))]
    making, seed, given = rest
    return [judging.is_right(made(making, seed), pickle.loads(given))]


@functools.lru_cache(maxsize=1000)
def made(making: str, seed: str) -> Any:
    """Return the kind that code makes."""
    kind = eval(making, {name: getattr(authoring, name) for name in MAKERS} | {"inf": float("inf")})
    if seed:
        kind.draw_from(seed)
    return kind


def _said(verdict):
    return [verdict.name, verdict.status, verdict.says, verdict.look]


def replied(request: str) -> Any:
    """Return the reply to a request of the page, with the words of a picture in its place."""
    from loopbook.exercises import forms

    return _in_words(json.loads(forms.answer(request)))


def _in_words(reply):
    match reply:
        case str():
            return _PICTURE.sub(lambda image: f"[{''.join(_WORDS.findall(image[0]))}]", reply)
        case list():
            return [_in_words(one) for one in reply]
        case dict():
            return {name: _in_words(one) for name, one in reply.items()}
    return reply


# ---- chapters


def shown(path: str) -> list[list]:
    """Run a notebook and return the texts that its code cells show: see `texts`. A failure is shown as its message."""
    return list(_shown(json.loads(Path(path).read_text(encoding="utf-8"))))


def _shown(notebook: dict) -> Iterator[list]:
    from IPython.core.displaypub import DisplayPublisher
    from IPython.core.interactiveshell import InteractiveShell
    from IPython.utils.capture import capture_output

    outputs: list[dict] = []

    class Publisher(DisplayPublisher):
        def publish(self, data, *others, **named):
            outputs.append(data)

    def show(value):
        data = {} if value is None else shell.display_formatter.format(value)[0]
        if data:  # what shows itself leaves nothing
            outputs.append(data)

    shell = InteractiveShell.instance()
    shell.reset(new_session=True)
    shell.display_pub, shell.display_trap.hook = Publisher(), show
    for cell in notebook["cells"]:
        if cell["cell_type"] != "code":
            continue
        outputs.clear()
        with capture_output(display=False) as captured:
            run = shell.run_cell("".join(cell["source"]), store_history=False)
        if run.success:
            yield texts(captured.stdout, captured.stderr, outputs)
        else:
            error = run.error_before_exec or run.error_in_exec
            yield ["fails", f"{type(error).__name__}: {error}"]


def texts(printed: str, errors: str, outputs: Sequence[dict]) -> list:
    """Return what a cell shows as text: what it prints, and the data of its outputs but for pictures and widgets."""
    data = [{mime: one for mime, one in output.items() if mime not in NOT_TEXT} for output in outputs]
    return [printed, errors, data]


DOES = {"answer": judged, "request": replied, "chapter": shown}
