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
raise, increase, increasing, higher, up, upwards, turn up, larger, bigger
lower, decrease, decreasing, reduce, down, downwards, turn down, smaller
up, raise, turn up
reverse, increase decrease, reverse acting controller
direct, increase increase, direct acting controller
shell and tube exchanger, tube bundle exchanger, tube bundle heat exchanger, tubular heat exchanger
in the control room, operator panel, on the panel, front of the panel, panel front, in front of the panel
down, reduce, turn down
dead end, step without exit
IAE, integral of the absolute error, absolute error
ISE, integral of the squared error, squared error, integral squared error, integral of the square of the error
ITAE, integral of time and absolute error, time weighted absolute error, integral of time times the absolute error
a load that raises the output, a disturbance that raises the output, load that raises it
a load that lowers the output, a disturbance that lowers the output, load that lowers it
wrong action, reverse action, wrong direction of action
towards, toward, in the right direction, right direction, the right way, right way
away, in the wrong direction, wrong direction, the wrong way, wrong way
away, in the opposite direction, opposite direction, opposite, backwards, inverse response
well damped, good, good damping, sufficiently damped, damped well, enough damping, sufficient damping
poorly damped, poor, bad, badly damped, weakly damped, lightly damped
poorly damped, poor damping, damped poorly, too little damping, insufficiently damped, not enough damping, weak damping
yes, true, y, yep, it does, it is, certainly
no, false, n, nope, it does not, it is not, it doesn't, it isn't, not at all
runs over, over, overfills, overflow, overflows, overflowing, spills over, run over, running over, it floods
runs empty, empty, empties, runs dry, run empty, run dry, dries out, running empty, running dry
direct, dir, direct acting, direct action, directly acting
reverse, rev, reverse acting, reverse action, reversed, inverse, inverse action, inverse acting, indirect acting
stable, remains stable, stays stable, asymptotically stable, still stable
unstable, not stable, instable, no longer stable, non stable, not stable any more, diverges, diverging
smaller, less, lower, reduced, decreased, not as large, it decreased, has fallen
larger, bigger, greater, higher, more, increased, it increased, has risen
less stable, closer to instability, nearer to instability, more oscillatory, less well damped, less damped, less damping
as it was, unchanged, same, the same, no change, as before, equally stable, it stays the same
more sluggish, slower, sluggish, more slowly, too slow, too sluggish, slow
cascade, cascade control, cascaded, cascade loop, cascade structure
single loop, one loop, simple loop, single loop control, single controller
lower, lower half, lower part, bottom half, bottom, first half
upper, upper half, upper part, top half, top, second half
none, nothing, none of them, none of these, nil, not any, no step, no one
dead end, deadend, blind alley
waiting forever, forever waiting, forever, waits forever, wait forever, never stops waiting, deadlock
twice active, active twice, doubly active, activated twice
sound, ok, okay, correct, no mistake, nothing wrong, error free
inverse response, wrong way response, undershoot first, wrong direction first
overshoot, overshoots, overshooting, with overshoot
neither, none, neither of them, neither of both, none of both, none of them, nothing
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
process connection, connection to the process, measuring line, impulse line
pipe, pipeline, piping
heating, heats, heat, heater is on
cooling, cools, cool
faster, quicker, more quickly
open, opens, opened, opening
closed, closes, close, closing, shut
positive, plus, greater than zero
negative, minus, less than zero
at a limit, saturated, saturation, saturates, at its limit, at the limit, limited, limit reached
wrong action, wrong direction, wrong sign, wrong sign of the gain, acts the wrong way, wrong way round
no integral term, only proportional, proportional only, p only, only p, pure p, p controller only
inaccuracy, accuracy, measuring error, measurement error
resolution, quantisation, quantization, step size
heater, heating element
stirrer, agitator, mixer
lamp, light
dosing, dosing pump, dosage
flow, flow rate, flowrate, mass flow, volume flow
pneumatic signal, pneumatic, pneumatic line
hydraulic signal, hydraulic, hydraulic line
check valve, non return valve, nonreturn valve, one way valve
hand valve, manual valve, hand operated valve, manually operated valve
safety valve, relief valve, safety relief valve, pressure relief valve
solenoid valve, magnetic valve, electromagnetic valve, solenoid operated valve
pneumatic valve, pneumatic control valve, pneumatically actuated valve
gear pump, gear wheel pump
motor, electric motor
silo, bin
packed column, packed tower, packed bed column
column with trays, tray tower, plate column
data link, data bus, bus, fieldbus, data line, system link
radio signal, wireless, wireless signal, radio, radio link
too weak, undercompensated, undercompensates, undercompensation
too strong, overcompensated, overcompensates, overcompensation
too short, underestimated
too long, overestimated
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
    "un",
}  # fmt: skip
#: What denies a denial.
_TWICE_NO = re.compile(r"\b(?:not|never|n't) (?:an? )?no\b")
#: An option without one of these is another thing.
_TELLS = {
    "less", "more", "well", "poorly", "not", "no", "low", "high", "noise", "inverse", "dead", "twice", "as", "was",
    "never", "non", "half", "single", "end", "over", "empty", "runs", "in", "the", "behind", "own", "first", "second",
}  # fmt: skip
#: What is said in several words, and in one.
_PHRASES = (
    (r"\b(?:instead of|rather than) .*$", ""),
    (r"\b(?:much|far|way|a bit|a little|slightly|somewhat|clearly) (?=too\b)", ""),
    (r"\bnot (?:nearly )?enough\b|\btoo (?:few|less)\b", "little"),
    (r"\bnot (high|large|big|strong|much|long) enough\b", "little"),
    (r"\bnot (?:low|small|weak|little|short) enough\b", "much"),
    (r"\bmore and more\b|\bwith (?:an? )?(?:growing|increasing) amplitudes?\b", "growing"),
    (r"\bwith (?:an? )?(?:decaying|decreasing|falling|shrinking) amplitudes?\b", "decaying"),
    (r"\b(?:dies|die|dying|fades|fade|dying) (?:out|away|down)\b", "decaying"),
    (r"\b(?:monotonically|monotonic|monotonous|monotonously|aperiodic|aperiodically)\b", "without oscillating"),
    (r"\b(?:an?other|different|wrong|some other) (?:value|level|position)\b|\bsomewhere else\b", "elsewhere"),
    (r"\bmixed up\b", "interchanged"),
    (r"\bset point\b", "setpoint"),
    (r"\bwrong (?=sign\b)", ""),
    (r"(\bsign\b.*?) (?:is )?wrong$", r"\1"),
    (r"\b(?:controller|proportional|loop) gain\b|\bk_?[pc]\b|\bk\b(?!.*\bd\b)(?<!d and k)", "gain"),
    (r"\b(?:t_?i|tau_?i|(?:integral|integration|reset) time(?: constant)?)\b", "integral time"),
    (r"\b(?:t_?d|tau_?d|(?:derivative|rate) time(?: constant)?)\b", "derivative time"),
    (r"\b(integral|derivative)(?: (?:action|term|part))? too\b", r"\1 action"),
)
#: Words that say the same where an option has one of them.
_ALIKE = """
much, high, large, big, great, strong, long, excessive, excessively
little, low, small, weak, short, insufficient
late, slow, slowly, delayed
early, fast, quick, soon, quickly, premature
interchanged, swapped, exchanged, switched, confused
growing, grows, growth, diverging, diverges
decaying, decays, decay, damped, shrinking
without, no, non, not, lack, lacks, lacking
term, action, part
place, location
load, disturbance
raises, raising, raise, increases, increasing, lifts
lowers, lowering, decreases, decreasing, reduces, reducing
multiplied, multiply, multiplication, times
damper, damping
"""
#: What says nothing between such words.
_FILLERS = {
    "too", "and", "has", "have", "was", "been", "there", "very", "with", "for", "on", "from", "set", "chosen", "in",
    "comes", "acts", "loop",
}  # fmt: skip
#: What compares with nothing but the state before.
_BEFORE = re.compile(r" (?:than|compared (?:with|to)) (?:before|it was|without|previously|earlier)\b")
SHORTEST_TYPO, MOST_WORDS, LONGEST, MOST_INITIALS = 5, 12, 200, 4


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
        said = re.findall(r"\w+", re.sub(r"(?<=\w) ?\([^()]*\)$", "", given))  # without an explanation in brackets
        letters = [word for word in said if word in options]
        words = {word.casefold() for word in said}
        denied = words & _DENIES or "n't" in given
        return letters[0] if len(letters) == 1 and len(words) <= 4 and not denied else None
    if len(text) == 1 and len(options) <= MOST_INITIALS and all(re.fullmatch("[A-Za-z]{2,}", one) for one in options):
        begun = {option[0].casefold(): option for option in options}
        return begun.get(text) if len(begun) == len(options) else None  # d for direct, beside r for reverse
    forms = _forms(options)
    words = re.findall(r"[\w'+]+", text)
    if not words or len(words) > MOST_WORDS or _TWICE_NO.search(text):
        return None
    for form in (text, re.sub(r"[\W_]", "", text), *(_joined(words, k) for k in range(1, len(words)))):
        if form in forms:
            return forms[form]
    if words[0] in forms and {"yes", "no"} <= {*options} and re.match(r"\w+[,.;:]", text):
        return _first(words, forms)
    if meant := _numbered(text, options) or _none(text, options):
        return meant
    for way in (_typed, _in_sentence, _part, _of_same_words):
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
    if not said or said == ["wrong"] or any(len(word) < 4 for word in said):
        return None
    meant = [option for option in options if set(said) < set(bare(option).split())]
    missing = set(bare(meant[0]).split()) - set(said) if len(meant) == 1 else _TELLS
    return None if missing & (_TELLS - {"in", "the"}) else meant[0]


def _numbered(text, options):
    """The one option with this number, where all of them are the same letters and a number: "valve 2" for V2."""
    parts = [re.fullmatch(r"([A-Za-z]+)(\d+)", option) for option in options]
    said = re.fullmatch(r"(?:the )?(?:(?:valve|step|rule) (?:no |number )?)?([a-z]+)? ?(\d+)", text)
    if not said or not all(parts) or len({part[1] for part in parts}) > 1:
        return None
    fits = [part[0] for part in parts if part[2] == said[2] and said[1] in (None, part[1].casefold())]
    return fits[0] if len(fits) == 1 else None


def _none(text, options):
    """The option "none" in "no modifier", where the word behind it is no option."""
    said = re.fullmatch(r"no(?: (\w+))?|without(?: an?y? \w+)?", text)
    others = {_stem(word) for option in options for word in bare(option).split()}
    return "none" if said and "none" in options and "no" not in options and _stem(said[1] or "") not in others else None


def _of_same_words(words, forms, options):
    """The one option that says the same in other words, or in another order: "too much gain" for "gain too high".

    What an option has beyond that tells nothing; what there is beyond an option denies nothing.
    """
    known = {option: _concepts(option) for option in options}
    if len(set(known.values())) < len(options):
        return None
    said = _concepts(" ".join(words), frozenset().union(*known.values()))
    denied = {word for one in known.values() for word in one if word.startswith("no ")}
    telling = denied | {word.removeprefix("no ") for word in denied} | set(map(_stem, _TELLS))
    rules = (
        lambda one: one == said,
        lambda one: one < said and (len(one) > 1 or said - one <= {"gain", "feedforward", "effect"}),
        lambda one: said and said < one and said != {"wrong"} and not (one - said) & telling,
    )
    for fits in rules:
        meant = [option for option, one in known.items() if one and fits(one)]
        if len(meant) == 1:
            beyond = said - known[meant[0]]
            of_others = frozenset().union(*known.values()) - known[meant[0]]
            denied = beyond & (_DENIES | of_others) or any(word.startswith("no ") for word in beyond)
            return None if denied or len(beyond) > 2 else meant[0]
        if meant:
            return None
    return None


@functools.lru_cache(maxsize=1000)
def _concepts(text: str, known: frozenset[str] = frozenset()) -> frozenset[str]:
    """What a text says, without order and endings: "no signal to the valve" is {"no signal", "valv"}.

    Arguments:
        text: an option, or what somebody wrote.
        known: the words of the options; one that differs from one of them by one slip of the keyboard is it.
    """
    text = bare(text).replace("'", "")
    for pattern, meant in _PHRASES:
        text = re.sub(pattern, meant, text)
    words = [_stem(word) for word in re.findall(r"[\w+]+", text) if word not in _ARTICLES | _FILLERS]
    plain = sorted(word.removeprefix("no ") for word in known)
    found, denied = [], False
    for word in words:
        if word not in plain:
            close = [other for other in plain if len(other) >= SHORTEST_TYPO and one_slip(word, other)]
            word = close[0] if len(close) == 1 and close[0][0] == word[0] else word
        if word == "without":
            found, denied = (found, True) if not denied else ([*found, "no "], False)
        elif word == "miss":  # the transmitter is missing, a missing transmitter
            denied = not found
            found[:1] = [f"no {one}" for one in found[:1]]
        else:
            found.append(f"no {word}" if denied else word)
            denied = False
    meant = frozenset([*found, "no "] if denied else found)
    if {"integral", "term"} < meant and len(sizes := meant & {"much", "little"}) == 1:  # of a short integral time
        return (meant - {"term"} - sizes) | {"time"} | ({"much", "little"} - sizes)
    if {"derivative", "term"} < meant and meant & {"much", "little"}:
        return (meant - {"term"}) | {"time"}
    return meant


def _stem(word):
    """A word for all that are alike, without an ending."""
    if word in (alike := _alike()):
        return alike[word]
    return re.sub(r"(?<=\w{4})(?:at)?(?:ions?|ory|ings?|ed|es?|s)$", "", word)


@functools.cache
def _alike() -> dict[str, str]:
    rows = [[bare(word) for word in row.split(",")] for row in _ALIKE.strip().splitlines()]
    return {word: row[0] for row in rows for word in row}


def _typed(words, forms, options):
    """The one option, or a way to say it, that differs by one slip of the keyboard."""
    text = " ".join(words)
    plain = [form for form in forms if len(form) >= SHORTEST_TYPO and re.fullmatch(r"[a-z' ]+", form)]
    begun = [option for option in options if len(text) >= 4 and bare(option).startswith(text) and " " not in option]
    if len(begun) == 1:  # temp
        return begun[0]
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
