"""Words as people say them: which mean the same, which say nothing, and how an option is found in what somebody wrote.

All of it looks at the options alone. Where two options are possible, or one of them is negated, none is found.
"""

from __future__ import annotations

import functools
import itertools
import re
from collections.abc import Iterable, Sequence

#: Words that mean the same, in one row. Of two options of one list, no row holds both.
SAME = """
setpoint, set point, set value, reference, reference value, desired value, target, target value, wanted value, sp
control error, error signal, control deviation, deviation from the setpoint
control signal, controller output, manipulated variable, manipulated value, mv, actuating signal
disturbance, load, load disturbance, disturbance variable, process disturbance
process output, process variable, pv, controlled variable, controlled quantity, process value, output of the process
measurement noise, sensor noise, noise of the measurement
up, upward, upwards, increase, increases, increasing, rises, rise, rising, raises, goes up, higher, climbs
down, downward, downwards, decrease, decreases, decreasing, falls, fall, falling, drops, drop, sinks, goes down, lower
towards, toward, in the right direction, right direction, the right way, right way
away, in the wrong direction, wrong direction, the wrong way, wrong way, in the opposite direction, opposite direction
well damped, good damping, sufficiently damped, damped well
poorly damped, badly damped, weakly damped, lightly damped, poor damping, damped poorly
yes, true, y, yep, it does, it is, certainly
no, false, n, nope, it does not, it is not, it doesn't, it isn't, not at all
runs over, overflow, overflows, overflowing, spills over, run over, running over, it floods
runs empty, empties, runs dry, run empty, run dry, running empty, running dry
direct, direct acting, direct action, directly acting
reverse, reverse acting, reverse action, reversed, inverse acting, indirect acting
stable, remains stable, stays stable, asymptotically stable, still stable
unstable, not stable, instable, no longer stable, non stable, not stable any more
smaller, less, lower, reduced, decreased, not as large
larger, bigger, greater, higher, more, increased
less stable, closer to instability, nearer to instability, more oscillatory, less well damped
as it was, unchanged, same, the same, no change, as before, equally stable, it stays the same
more sluggish, slower, sluggish, more slowly
cascade, cascade control, cascaded, cascade loop, cascade structure
single loop, one loop, simple loop, single loop control, single controller
lower, lower half, lower part, bottom half, first half
upper, upper half, upper part, top half, second half
none, nothing, none of them, none of these, nil, not any, no step, no one
dead end, deadend, blind alley
waiting forever, forever waiting, forever, waits forever, wait forever, never stops waiting, deadlock
twice active, active twice, doubly active, activated twice
sound, ok, okay, correct, no mistake, nothing wrong, error free
inverse response, wrong way response, undershoot first, wrong direction first
overshoot, overshoots, overshooting, with overshoot
neither, none, neither of them, neither of both, none of them, nothing
inside, within, inside of, in the window
outside, beyond, outside of, not inside
difference, differential, delta
fraction, ratio
controller, control, controls, controlling
indicator, indicate, indicates, indicating, indication
transmitter, transmit, transmits, transmitting, transmission
in the field, field, locally, local, on site, field mounted
in the control room, control room, central control room
behind the panel, rear of the panel, back of the panel
own instrument, separate instrument, discrete instrument, stand alone instrument, instrument of its own
shared display, shared control, shared display and control
electrical signal, electric signal, electric, electrical
process connection, connection to the process
pipe, pipeline, piping
heating, heats, heat, heater is on
cooling, cools, cool
faster, quicker, more quickly
open, opens, opened, opening
closed, closes, close, closing, shut
positive, plus, greater than zero
negative, minus, less than zero
real, purely real
complex, complex pair, complex conjugate, complex conjugated
"""
#: What may stand around an option and says nothing.
_ARTICLES = {"a", "an", "the", "it", "is", "its", "that", "this", "will", "be", "of", "to", "at", "by", "so"}
#: A synonym of these words alone says nothing within a sentence.
_AT_EASE = {"it", "is", "does", "y", "n", "t", "sp", "pv", "mv", "certainly", "true", "same"}
#: With one of these a sentence may say the opposite, or compare.
_DENIES = {
    "not", "no", "never", "none", "neither", "nor", "without", "instead", "rather", "than", "but", "or", "unlike",
    "hardly", "barely", "except", "opposite", "cannot", "false", "wrong", "if", "unless", "non", "isnt", "doesnt",
    "marginally", "almost", "nearly", "conditionally", "maybe", "perhaps", "either", "both", "depends", "less", "least",
}  # fmt: skip
#: An option without one of these is another thing.
_TELLS = {
    "less", "more", "well", "poorly", "not", "no", "low", "high", "noise", "inverse", "dead", "twice", "as", "was",
    "never", "non", "half", "single", "end", "over", "empty", "runs", "in", "the", "behind", "own", "first", "second",
}  # fmt: skip
#: What compares with nothing but the state before.
_BEFORE = re.compile(r" (?:than|compared (?:with|to)) (?:before|it was|without|previously|earlier)\b")
SHORTEST_TYPO, MOST_WORDS, LONGEST = 5, 12, 200


@functools.cache
def _rows() -> tuple[frozenset[str], ...]:
    return tuple(frozenset(map(bare, row.split(","))) for row in SAME.strip().splitlines())


def bare(text: str) -> str:
    """A text without what makes no difference: case, spaces, hyphens, quotes and a full stop.

    >>> bare(" Set-point. "), bare("It doesn't")
    ('set point', "it doesn't")
    """
    text = text.replace("’", "'")
    return " ".join(re.sub(r"(?<=\w)[-‐‑](?=\w)", " ", text).split()).strip(" '\".!,;:").casefold() or text


@functools.lru_cache(maxsize=500)
def _forms(among: tuple[str, ...]) -> dict[str, str]:
    """The ways to say each option: {form: option}."""
    forms = {bare(option): option for option in among}
    for option in among:
        rows = [row for row in _rows() if bare(option) in row]
        for form in itertools.chain.from_iterable(rows):
            forms.setdefault(form, option)
    shared = [
        form
        for form, option in forms.items()
        if form not in map(bare, among)
        and len({one for one in among if any({form, bare(one)} <= row for row in _rows())}) > 1
    ]
    return {form: option for form, option in forms.items() if form not in shared}


def found(given: str, among: Sequence[str]) -> str | None:
    """Return the option that somebody means; None where none is meant, or several may be.

    >>> found("it is reverse-acting", ["reverse", "direct"]), found("not stable", ["stable", "unstable"])
    ('reverse', 'unstable')
    >>> found("not direct", ["reverse", "direct"]), found("sinle loop", ["cascade", "single loop"])
    (None, 'single loop')
    """
    if len(given) > LONGEST:
        return None
    options, text = tuple(among), re.sub(r"\bfor (?=ever\b)", "for", _BEFORE.sub("", bare(given)))
    if any(len(option) == 1 for option in options):  # letters are themselves, and an article is none
        letters = [word for word in re.findall(r"\w+", given) if word in options]
        words = {word.casefold() for word in re.findall(r"\w+", given)}
        return letters[0] if len(letters) == 1 and len(words) <= 4 and not words & _DENIES else None
    forms = _forms(options)
    words = re.findall(r"[\w'+]+", text)
    if not words or len(words) > MOST_WORDS:
        return None
    for form in (text, text.replace(" ", ""), *(_joined(words, k) for k in range(1, len(words)))):
        if form in forms:
            return forms[form]
    if words[0] in forms and {"yes", "no"} <= {*options} and re.match(r"\w+[,.;:]", text):
        return _first(words, forms)
    for way in (_typed, _in_sentence, _part):
        meant = way(words, forms, options)
        if meant:
            return meant
    return None


def _joined(words: list[str], k: int) -> str:
    """The words after the first ones, where these are articles."""
    rest = " ".join(words[k:]) if set(words[:k]) <= _ARTICLES else ""
    return rest if k < len(words) else ""


def _first(words, forms):
    """Yes or no at the beginning of a sentence that does not say the opposite."""
    option, others = forms[words[0]], words[1:]
    says_both = {forms[word] for word in others if word in forms} - {option}
    return None if says_both or (option == "yes" and set(others) & _DENIES) else option


def _in_sentence(words, forms, options):
    """The one option that occurs among the words, where nothing else denies or compares."""
    left, meant = list(words), set()
    for form in sorted(forms, key=lambda one: -len(one.split())):
        if set(form.split()) <= _AT_EASE:
            continue
        size = len(form.split())
        for k in range(len(left) - size + 1):
            if left[k : k + size] == form.split():
                meant.add(forms[form])
                left[k : k + size] = ["_"] * size
    others = {word for option in options if option not in meant for word in bare(option).split()} - _ARTICLES - {"in"}
    denied = set(left) & (_DENIES | others) or any(word.endswith("n't") for word in left)
    denied = denied or any(one_slip(word, other) for word in left for other in others if len(other) >= SHORTEST_TYPO)
    return meant.pop() if len(meant) == 1 and not denied else None


def _part(words, forms, options):
    """The one option that has all these words, where what it has beyond them tells nothing."""
    said = [word for word in words if word not in _ARTICLES]
    if not said or any(len(word) < 4 for word in said):
        return None
    meant = [option for option in options if set(said) < set(bare(option).split())]
    missing = set(bare(meant[0]).split()) - set(said) if len(meant) == 1 else _TELLS
    return None if missing & (_TELLS - {"in", "the", "behind"}) else meant[0]


def _typed(words, forms, options):
    """The one option, or a way to say it, that differs by one slip of the keyboard."""
    text = " ".join(words)
    plain = [form for form in forms if len(form) >= SHORTEST_TYPO and re.fullmatch(r"[a-z' ]+", form)]
    close = [form for form in plain if one_slip(text, form)]
    # a first letter is hardly ever wrong: slower is no lower
    return forms[close[0]] if len({forms[form] for form in close}) == 1 and close[0][0] == text[0] else None


def one_slip(typed: str, meant: str) -> bool:
    """Whether two words differ by one letter that is missing, too many, another one, or by two that are interchanged.

    >>> [one_slip(typed, "reverse") for typed in ("revese", "reversee", "reverze", "revesre", "rverze")]
    [True, True, True, True, False]
    """
    if abs(len(typed) - len(meant)) > 1 or typed == meant:
        return False
    k = next(
        (k for k, (one, other) in enumerate(zip(typed, meant, strict=False)) if one != other),
        min(len(typed), len(meant)),
    )
    one, other = typed[k:], meant[k:]
    return (
        one[1:] == other
        or one == other[1:]
        or one[1:] == other[1:]
        or (one[:2] == other[1::-1] and one[2:] == other[2:])
    )


def listed(given: str, among: Iterable[str]) -> list[str] | None:
    """Return the options in a text without separators, in their order; None where there is anything else in it.

    >>> listed("Indicator controller", ["indicator", "controller", "secure control"])
    ['indicator', 'controller']
    """
    options = tuple(among)
    if len(given) > LONGEST:
        return None
    if all(len(option) == 1 for option in options):
        letters = re.sub(r"[^\w]", "", given)
        return list(letters) if set(letters) <= set(options) else None
    forms, words, meant, k = _forms(options), re.findall(r"[\w'+]+", bare(given)), [], 0
    while k < len(words):
        size = next((n for n in range(len(words) - k, 0, -1) if " ".join(words[k : k + n]) in forms), 0)
        if size:
            meant.append(forms[" ".join(words[k : k + size])])
        elif words[k] not in _ARTICLES | {"and"}:
            return None
        k += size or 1
    return meant
