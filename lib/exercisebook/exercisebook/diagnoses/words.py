"""Mistakes in words: which of several are right, and for which other question a word would be."""

from __future__ import annotations

from collections import Counter

from exercisebook.diagnoses.background import Background
from exercisebook.diagnoses.finding import Finding, carried_on, explained
from exercisebook.grammar import listed
from exercisebook.kinds import Word, Words

#: What to ask oneself where there is the choice between such words.
QUESTIONS: list[tuple[set[str], str]] = [
    ({"A", "B"}, "put the numbers of both side by side"),
    ({"yes", "no"}, "what would have to be measured or computed to be sure?"),
]


@explained.register
def _(kind: Word, answer: str, background: Background) -> Finding | None:
    if found := carried_on(kind, answer, background):
        return found
    for how, key in background.keys_of_other_words():
        if isinstance(key, Word) and key.key == answer:
            return Finding(how)
    for words, question in QUESTIONS:
        if words <= {*kind.among}:
            return Finding(f"not right: {question}", is_mistake=False)
    return None


@explained.register
def _(kind: Words, answer: list[str], background: Background) -> Finding | None:
    if not answer:
        return Finding("not right: at least one belongs here", is_mistake=False)
    common = Counter(answer) & Counter(kind.key)
    right = [word for word in dict.fromkeys(answer) if word in common]
    wrong = [word for word in dict.fromkeys(answer) if word not in common]
    if kind.ordered and right and not wrong and len(answer) == len(kind.key):
        return Finding(f"the words are right, their order is not{_begins(kind, answer)}", is_mistake=False)
    if not wrong and common.total() < len(kind.key):
        return Finding("what is there is right, but something is missing", is_mistake=False)
    if common.total() == len(kind.key):
        return Finding("everything asked for is there, but also something that does not belong there", is_mistake=False)
    if not right:
        return Finding("none of them belongs there", is_mistake=False)
    says = f"{listed(right)} {'belongs' if len(right) == 1 else 'belong'} there, {listed(wrong)} {_belong(wrong)} not"
    return Finding(says + ("; something is missing, too" if len(answer) < len(kind.key) else ""), is_mistake=False)


def _belong(words):
    return "does" if len(words) == 1 else "do"


def _begins(kind, answer):
    """Up to where an order is right."""
    same = next(k for k, (one, other) in enumerate(zip(answer, kind.key, strict=True)) if one != other)
    return f": it is right up to {answer[same - 1]}" if same else ": look at what comes first"
