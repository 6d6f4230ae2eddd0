"""What is checked of an exercise that is tried: functions of one variant, and of all variants together.

Each yields what it has `Seen`. A new check is a new function in `OF_ONE` or `OF_ALL`.
"""

from __future__ import annotations

import inspect
import itertools
import json
import math
import re
from collections import Counter
from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

import numpy as np
import sympy

from exercisebook import kinds
from exercisebook.credit import NOTHING, Credit, worth
from exercisebook.grammar import listed, shortened
from exercisebook.judging import MISTAKE, OPEN, SECONDS, UNJUDGED, Verdict, is_right, judge
from exercisebook.kinds.kind import AS_IT_IS, rounded
from exercisebook.parameters import call, written
from exercisegrader.inside.plain import Plain, plain, unreadable

if TYPE_CHECKING:
    from exercisebook.kinds import Kind
    from exercisebook.question import Question

#: How bad it is: marks would be wrong, or a student stopped; a student would wonder; worth knowing.
WRONG, ODD, NOTE = LEVELS = ("wrong", "surprising", "note")
#: What happens in a smaller part of the variants is chance, and surprises nobody.
RARE = 0.1
#: An answer that is the same in so large a part of the variants is guessed.
USUAL = 0.9
#: What is so in every other variant is no chance any more: answers that can be copied, or a sentence that is not heard.
OFTEN = 0.5
#: A given changes by this fraction where it is rounded in its fourth digit.
ROUNDING = sympy.Rational(5, 10_000)
#: In so many variants the givens are changed, and pictures and solutions made: each takes its time.
MOST_CHANGED, MOST_SHOWN = 40, 3
#: A key whose largest value is so many times its smallest, or that is beyond these sizes, is not equally hard for all.
SPREAD, SMALL, LARGE = 1000, 1e-4, 1e6
#: A key that takes so many seconds is slow; a class waits for it when it is released and when it is graded.
SLOW = 0.2
#: A parameter with fewer values is a choice and nothing that is rounded; an exercise with fewer variants is copied.
FEWEST_VALUES, FEWEST_VARIANTS = 6, 8
#: In fewer variants than these, what never or always happens may do so by chance.
ENOUGH = 20
#: So many characters of an answer, and of a sentence, are shown.
LONGEST_ANSWER, LONGEST_SENTENCE = 70, 200

_TAKES_LONG = "takes too long"
_FORMULA = re.compile(r"\$\$.*?\$\$|\$.*?\$|`.*?`", re.DOTALL)
_NO_VALUE = re.compile(r"\b(?:nan|zoo|None)\b|<function|<[a-z]\w*\.[\w.]+ object")
_UNFILLED = re.compile(r"(?<![\\\w}_^{])\{[a-z]\w*\}")
_MANY_DIGITS = re.compile(r"(?<![\w.])\d*\.\d{5,}|(?<![\w.])\d+(?:\.\d+)?e[+-]?\d+|(?<![\w.])\d{7,}")


@dataclass(frozen=True)
class Seen:
    """Something that was seen: how bad it is, a sentence, an example, and up to which part it is chance."""

    level: str
    says: str
    example: str = ""
    least: float = 0.0


class Variant:
    """A student's variant of an exercise, with all that its functions return.

    Arguments:
        student: the id.
        place: of the student among those with whom the exercise is tried.
        question: the `Question`.
        seconds: that the key took.
        credit: what is worth something though it is not right.

    Attributes:
        key: of what is judged.
        by_hand: the names of what a person marks.
    """

    def __init__(self, student: str, place: int, question: Question, seconds: float, credit: Credit = NOTHING):
        self.student, self.place, self.question, self.seconds = student, place, question, seconds
        self.exercise, self.credit = question.exercise, credit
        self.by_hand = [name for name, kind in question.key.items() if kind.by_hand]
        self.key = {name: kind for name, kind in question.key.items() if name not in self.by_hand}
        self.mistakes = {name: question.mistakes[name] for name in self.key}
        numbers = {name: value for name, value in question.values.items() if not isinstance(value, str)}
        self.numbers: dict[str, sympy.Expr] = numbers

    def judged(self, name: str, answer: object) -> Verdict:
        """What a student is told on an answer."""
        data = sent(answer)
        if says := unreadable(data):
            return Verdict(name, UNJUDGED, says)
        background = self.question.background.of(name, {name: data})
        return judge(name, self.key[name], data, self.mistakes[name], background, self.credit)

    def is_right(self, name: str, answer: object) -> bool:
        """Whether an answer is right; faster than a verdict with its sentence."""
        return is_right(self.key[name], sent(answer))

    def solution(self, name: str) -> str:
        """The key in words, in short."""
        return shortened(self.key[name].solution, LONGEST_ANSWER)

    def of_kind(self, *wanted: type[Kind]) -> dict[str, Any]:
        """The asked quantities of these kinds."""
        return {name: kind for name, kind in self.key.items() if type(kind) in wanted}


def sent(answer: object) -> Plain:
    """Return an answer as the judge gets it, plain data that was JSON on its way."""
    return json.loads(json.dumps(plain(answer)))


def in_short(answer: object) -> str:
    """Return an answer as it is shown in a report.

    >>> in_short([1.5, 2]), in_short("2 min")
    ('[1.5, 2]', "'2 min'")
    """
    if isinstance(answer, np.ndarray | np.generic):
        answer = answer.tolist()
    if isinstance(answer, sympy.Rational) and not answer.is_Integer:
        answer = float(f"{float(answer):.6g}")
    return shortened(repr(answer), LONGEST_ANSWER)


# One variant.


def keys_in_their_forms(variant: Variant) -> Iterator[Seen]:
    """The key, as it is and as people write it, is right."""
    for name, kind in variant.key.items():
        for how, answer in kind.right_forms():
            if variant.is_right(name, answer):
                continue
            told = variant.judged(name, answer)
            if told.is_right or _TAKES_LONG in told.says:  # with less to do at the same time it was quick enough
                yield Seen(
                    ODD, f"{name}: judging the key takes about {SECONDS} s, which is the limit", in_short(answer)
                )
            elif "may be" not in told.says:  # what may mean two things is asked about before it is handed in
                is_usual = how == AS_IT_IS or not isinstance(kind, kinds.Design)
                says = f"{name}: the key is not right" + ("" if how == AS_IT_IS else f" {how}")
                example = f"{in_short(answer)}, the key is {variant.solution(name)}: {told.says}"
                yield Seen(WRONG if is_usual else ODD, says, example)
                if how == AS_IT_IS:
                    break


def words_of_a_list(variant: Variant) -> Iterator[Seen]:
    """Each word of a list is read as itself."""
    for name, kind in variant.of_kind(kinds.Word, kinds.Words).items():
        for word in kind.among:
            one = kinds.Word(word, kind.among)
            if one.key != word:
                yield Seen(WRONG, f'{name}: the word "{word}" is read as "{one.key}"')


def other_answers(variant: Variant) -> Iterator[Seen]:
    """Other answers than the key are not right, and no answer is none."""
    for name, kind in variant.key.items():
        for how, answer in kind.wrong_forms():
            if not variant.is_right(name, answer):
                continue
            example = f"{in_short(answer)}, the key is {variant.solution(name)}"
            if isinstance(kind, kinds.Design):
                yield Seen(ODD, f"{name}: the example, {how}, meets the criteria, too", example, RARE)
            else:
                yield Seen(WRONG, f"{name}: the key, {how}, is right, too", example)
        for empty in ("", "...", [], None):
            if variant.is_right(name, empty) and np.size(kind.key):
                yield Seen(WRONG, f"{name}: an empty answer is right", repr(empty))


def second_ways(variant: Variant) -> Iterator[Seen]:
    """What an exercise says has to hold, as another way to its key, does."""
    try:
        for text, holds, sides in variant.exercise.second_ways(variant.question.values):
            if not holds:
                example = f"{sides}{variant.question.with_values}".strip()
                yield Seen(WRONG, f"the check {text} does not hold", example)
    except ValueError as problem:
        yield Seen(WRONG, f"a check fails: {problem}")


def declared_mistakes(variant: Variant) -> Iterator[Seen]:
    """A declared mistake is wrong, and gets its own sentence."""
    texts = {worth(variant.question.filled_in(says))[1]: worth(says)[1] for says, _ in variant.exercise.mistakes}
    for name, given in variant.mistakes.items():
        mistakes = [(worth(text)[1], value) for text, value in given]
        # several wrong numbers may come from one cause; a wrong word is one of its own
        is_word = isinstance(variant.key[name], kinds.Word)
        for text, count in Counter(text for text, _ in mistakes if is_word).items():
            if count > 1:
                says = f'{name}: {count} mistakes have the same sentence, "{shortened(texts[text], LONGEST_ANSWER)}"'
                yield Seen(ODD, says, ", ".join(in_short(value) for said, value in mistakes if said == text))
        for text, value in mistakes:
            told = variant.judged(name, value)
            mistake = f'{name}: the mistake "{shortened(texts[text], LONGEST_ANSWER)}"'
            example = f"{in_short(value)}, the key is {variant.solution(name)}"
            if told.is_right:
                yield Seen(WRONG, f"{mistake} is right", example)
            elif _TAKES_LONG in told.says:
                yield Seen(ODD, f"{mistake} takes too long to be judged", in_short(value))
            elif told.status in (OPEN, UNJUDGED):
                yield Seen(WRONG, f"{mistake} cannot be judged", f"{in_short(value)}: {told.says}")
            elif told.status != MISTAKE or not told.says.startswith(text):
                other = next((one for one in texts if told.says.startswith(one)), "")
                gets = f'that of "{shortened(texts[other], LONGEST_ANSWER)}"' if other else "another sentence"
                yield Seen(ODD, f"{mistake} gets {gets}", f"{in_short(value)}: {told.says}", OFTEN)
            elif told.percent:
                yield Seen(NOTE, f"{mistake} brings {told.percent:g} % of the points", example)
            elif type(variant.key[name]) is kinds.Number and variant.is_right(name, rounded(float(value))):
                yield Seen(ODD, f"{mistake} is right when it is rounded", example, RARE)


def quantities_with_one_answer(variant: Variant) -> Iterator[Seen]:
    """Two quantities have different answers, and none of them is a given."""
    numbers = variant.of_kind(kinds.Number)
    for one, other in itertools.combinations(numbers, 2):
        if numbers[one].unit == numbers[other].unit and numbers[one].agrees(numbers[other].key):
            yield Seen(ODD, f"{one} and {other} have the same answer", variant.solution(one), OFTEN)
    for name, given in itertools.product(numbers, variant.numbers.keys() & variant.question.background.parameters):
        is_given = variant.exercise.parameters[given].unit == numbers[name].unit
        if is_given and numbers[name].key and numbers[name].agrees(float(variant.numbers[given])):
            yield Seen(ODD, f"{name}: the answer is the given {given}", variant.solution(name), USUAL)


def rounded_givens(variant: Variant) -> Iterator[Seen]:
    """An answer from givens that are rounded on the way, in their fourth digit, is right as well."""
    if variant.place >= MOST_CHANGED:
        return
    quantities = {name: kind for name, kind in variant.key.items() if _is_rounded(kind)}
    for given, value in variant.numbers.items():
        if not _is_measured(variant.exercise.parameters[given]):
            continue
        for near in (value * (1 + ROUNDING), value * (1 - ROUNDING)):
            try:
                key = call(variant.exercise.key, variant.question.values | {given: near})
                wrong = [name for name, kind in quantities.items() if not kind.agrees(key[name].key)]
            except Exception:  # it need not have a value there
                continue
            for name in wrong:
                unit = variant.exercise.parameters[given].unit
                example = f"{variant.solution(name)}; for {written(near, unit)} {shortened(key[name].solution, 70)}"
                yield Seen(ODD, f"{name}: {given} rounded to four digits makes it wrong", example, RARE)


def _is_measured(parameter):
    """Whether a given is a number that may be rounded, and neither a choice nor a count."""
    numbers = [value for value in parameter.values if not isinstance(value, str)]
    return len(numbers) >= FEWEST_VALUES and bool(parameter.unit or not all(one.is_integer for one in numbers))


def _is_rounded(kind):
    """Whether it is a word, or has numbers that may be rounded; the numbers of a formula are those of its author."""
    if isinstance(kind, kinds.Word | kinds.Words):
        return True
    return kind.is_personal and bool(kind.within) and not isinstance(kind, kinds.Expression)


def texts_and_pictures(variant: Variant) -> Iterator[Seen]:
    """The statement has its values, as people write them; pictures can be drawn, hints and solution are filled in."""
    question, exercise = variant.question, variant.exercise
    made: dict[str, Callable[[], Any]] = {
        "the statement": lambda: f"{question.statement.heading}\n\n{question.statement.body}",
        "a hint": lambda: "\n".join(question.rungs),
        "the insight": lambda: question.filled_in(exercise.insight, also={}),
        "the solution": lambda: question._worked_text,
        "the picture": lambda: question.picture,
        "the picture of the solution": question._draws(exercise.drawn_in_solution),
    }
    for what, make in list(made.items())[: None if variant.place < MOST_SHOWN else 1]:
        try:
            found = make()
        except Exception as problem:  # the functions are the author's
            yield Seen(WRONG, f"{what} fails", shortened(str(problem), LONGEST_SENTENCE))
            continue
        is_statement = what == "the statement"
        if isinstance(found, str) and (place := _NO_VALUE.search(found) or _UNFILLED.search(_FORMULA.sub("", found))):
            yield Seen(WRONG if is_statement else ODD, f"a place of {what.removeprefix('a ')} has no value", place[0])
        if is_statement and (digits := _MANY_DIGITS.search(found)):
            yield Seen(ODD, "the statement has a number of many digits", digits[0])
        if is_statement and found.count("$") % 2:
            yield Seen(WRONG, "the statement has a $ without another one")


OF_ONE: tuple[Callable[[Variant], Iterator[Seen]], ...] = (
    keys_in_their_forms, second_ways, words_of_a_list, other_answers, declared_mistakes, quantities_with_one_answer,
    rounded_givens, texts_and_pictures,
)  # fmt: skip


# All variants together.


def equal_answers(variants: Sequence[Variant]) -> Iterator[Seen]:
    """An answer is not the same for nearly all, and those of one student are not right for others."""
    if len(variants) < ENOUGH:
        return
    for name, kind in variants[0].key.items():  # what a person marks is not among them
        said = Counter(variant.key[name].solution for variant in variants if name in variant.key)
        (most, count), *_ = said.most_common(1)
        if count >= USUAL * len(variants) and not _is_in_symbols(kind):
            how_often = "for all" if count == len(variants) else f"in {count} of {len(variants)} variants"
            yield Seen(ODD, f"{name}: the answer is the same {how_often}, {shortened(most, LONGEST_ANSWER)}")
    different = len({tuple(map(str, variant.question.values.values())) for variant in variants})
    if different < FEWEST_VARIANTS and variants[0].key:
        yield Seen(ODD, f"there are only {different} different variants")
    pairs = [pair for pair in itertools.pairwise(variants) if pair[0].question.values != pair[1].question.values]
    copied = [
        (one, other)
        for one, other in pairs
        if one.key.keys() == other.key.keys() != set()
        and all(other.is_right(name, kind.as_given) for name, kind in one.key.items())
    ]
    if len(copied) >= OFTEN * len(pairs) > 0:
        one, other = copied[0]
        says = f"the answers of one student are right for another one, {len(copied)} of {len(pairs)} times"
        yield Seen(ODD, says, f"{one.student} and {other.student}")


def _is_in_symbols(kind):
    """Whether the answer is a formula in symbols, which is the same for all by its nature."""
    return isinstance(kind, kinds.Expression) and bool({*kind.symbols} - kind.always)


def marked_by_hand(variants: Sequence[Variant]) -> Iterator[Seen]:
    """What a person marks is named."""
    if names := variants[0].by_hand:
        yield Seen(NOTE, f"a person marks {listed(names)}")


def sizes(variants: Sequence[Variant]) -> Iterator[Seen]:
    """Numbers are of about one size, such as people write, and not zero."""
    for name in variants[0].of_kind(kinds.Number):
        keys = [abs(variant.key[name].key) for variant in variants if name in variant.key]
        numbers = [key for key in keys if key and math.isfinite(key)]
        zeros = keys.count(0)
        if 0 < zeros < len(keys) and variants[0].key[name].within:
            yield Seen(ODD, f"{name}: the key is 0 in {zeros} of {len(keys)} variants, where the accuracy is absolute")
        if not numbers:
            continue
        low, high = min(numbers), max(numbers)
        if high > SPREAD * low:
            yield Seen(ODD, f"{name}: the keys are between {low:.3g} and {high:.3g}: not equally hard for all")
        if low < SMALL or high >= LARGE:
            extreme = low if low < SMALL else high
            yield Seen(ODD, f"{name}: a key is {extreme:.3g}: another unit makes a number that people write")


def mistakes_that_do_not_occur(variants: Sequence[Variant]) -> Iterator[Seen]:
    """Each declared mistake occurs."""
    texts = {(place, text) for place, one in enumerate(variants) for made in one.mistakes.values() for text, _ in made}
    for sentence, _ in variants[0].exercise.mistakes:
        told = any((place, one.question.filled_in(sentence)) in texts for place, one in enumerate(variants))
        if not told and len(variants) >= ENOUGH:
            yield Seen(
                ODD, f'the mistake "{shortened(sentence, LONGEST_ANSWER)}" occurs in none of {len(variants)} variants'
            )


def parameters_that_nobody_sees(variants: Sequence[Variant]) -> Iterator[Seen]:
    """Each parameter is in the statement, or used for what it shows."""
    exercise = variants[0].exercise
    shows = [function for function in (exercise.shown, exercise.drawn) if function]
    used = {name for function in shows for name in inspect.signature(function).parameters}
    for name in exercise.parameters:
        if f"{{{name}}}" not in exercise.statement and name not in used:
            yield Seen(WRONG, f"the statement does not show {name}, of which the key may depend")


def slow_keys(variants: Sequence[Variant]) -> Iterator[Seen]:
    """A key is quick."""
    seconds = sum(variant.seconds for variant in variants) / len(variants)
    if seconds > SLOW:
        yield Seen(ODD, f"the key takes {seconds:.1f} s a variant, in which a class of 300 waits {5 * seconds:.0f} min")


OF_ALL: tuple[Callable[[Sequence[Variant]], Iterator[Seen]], ...] = (
    equal_answers, marked_by_hand, sizes, mistakes_that_do_not_occur, parameters_that_nobody_sees, slow_keys,
)  # fmt: skip
