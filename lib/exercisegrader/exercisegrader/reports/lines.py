"""A result as lines of text, for systems that take no page."""

from __future__ import annotations

from typing import TYPE_CHECKING

from exercisebook.response import MARKS
from exercisegrader.reports.wording import (
    NO_JAIL,
    answer_in_words,
    explained,
    hints,
    in_text,
    of_points,
    remarks,
    visible,
)

if TYPE_CHECKING:
    from exercisegrader.marking import Marked, MarkedExercise
    from exercisegrader.results import JudgedAnswer


def overall(mark: Marked) -> list[str]:
    """Return what is to be said of a result besides its answers."""
    result = mark.result
    lines = [] if result.jailed else [NO_JAIL]
    lines += [of_points(mark.known, result.points), *remarks(result), *hints(result), *filter(None, [mark.late])]
    lines += map(visible, mark.comments)
    if mark.waiting:
        where = dict.fromkeys(number for number, _ in mark.waiting)
        lines.append(f"Waiting for a mark by hand: exercise {', '.join(where)}.")
    return lines


def of_exercise(marked: MarkedExercise, reveal: bool) -> list[str]:
    """Return what became of the answers to an exercise.

    Arguments:
        marked: of a result.
        reveal: whether the keys are in it.
    """
    lines = [_of_answer(one, reveal) for one in marked.judged.answers]
    return lines + [visible(one) for one in (*marked.history, *marked.comments)]


def _of_answer(judged: JudgedAnswer, reveal: bool) -> str:
    status, says, answer = judged.status, explained(judged), answer_in_words(judged.answer)
    line = f"{MARKS[status][0]} {judged.name}: {status}"
    line += f", {in_text(says)}" if says else ""
    line = line if line.endswith((".", "?", "!")) else line + "."
    line += f" Answer: {answer}" if answer else ""
    return line + (f" Key: {visible(judged.key)}" if reveal else "")
