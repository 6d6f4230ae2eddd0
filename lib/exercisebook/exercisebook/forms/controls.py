"""Fields as HTML: what a reader types in or chooses from, each with a label and a place for its verdict."""

from __future__ import annotations

from collections.abc import Sequence

from exercisebook.forms.fields import Field
from exercisebook.forms.text import escaped
from exercisebook.forms.typeset import keys
from exercisebook.kinds.kind import ELSEWHERE, LINE, LINES, NONE, ONE, ORDER, PARTS, SEVERAL

#: Up to so many words are buttons beside each other, and up to so many where no other field has the same words.
FEW, MORE = 4, 6
#: A row of words that is no longer leaves room for another field beside it; each word has a button of so many letters.
SHORT, ROOM = 28, 5
#: The kinds of answers that a short line holds.
SHORT_KINDS = ("number",)
#: No keyboard of a phone may correct a formula.
_PLAIN = 'autocomplete="off" autocapitalize="off" autocorrect="off" spellcheck="false"'


def slug(number: str) -> str:
    """Return the number of an exercise as a part of an address.

    >>> slug("A.1")
    'a-1'
    """
    return number.replace(".", "-").lower()


def html(number: str, field: Field, beside: Sequence[Field] = ()) -> str:
    """Return a field as HTML.

    Arguments:
        number: of the exercise.
        field: the field.
        beside: all fields of the exercise.
    """
    place = f"answer-{slug(number)}-{field.name}"
    is_group = field.control in (SEVERAL, PARTS) or (field.control == ONE and not _is_list(field, beside))
    tag, label = ("fieldset", "legend") if is_group else ("div", "label")
    target = "" if is_group or field.control == ELSEWHERE else f' for="{place}"'
    if field.control == ELSEWHERE:
        label = "p"
    says = f"<code>{escaped(field.name)}</code> {field.asked}{_weighted(field)}"
    head = f'<{label}{target} class="asked-for">{says}</{label}>'
    demands = "; ".join(field.more.get("demands", ()))
    demands = f'<p class="help">such that {demands}</p>' if demands else ""
    help_ = f'<p class="help" id="{place}-help">{field.help}</p>' if field.help else ""
    typeset = _typeset(field.symbols) if field.symbols else ""
    said = f'<p class="verdict" id="{place}-verdict"></p>'
    body = _BODIES[field.control](place, field, beside)
    wide = " wide" if _is_wide(field, is_group) else ""
    return (
        f'<{tag} class="field {field.control}{wide}" data-name="{escaped(field.name)}" data-control="{field.control}">'
        f"{head}{demands}{body}{help_}{typeset}{said}</{tag}>"
    )


def _weighted(field):
    """How much a quantity counts, in words; empty where it counts once."""
    usual = {1: "", 2: "counts double", 0.5: "counts half"}
    says = usual.get(field.weight, f"counts {field.weight:g} times")
    return f' <small class="weight">({says})</small>' if says else ""


def _is_list(field, beside):
    """Whether one word is chosen from a list that opens, because buttons would be too many."""
    if len(field.words) <= FEW:
        return False
    alike = sum(set(other.words) == set(field.words) for other in beside)
    return len(field.words) > MORE or alike > 1 or sum(map(len, field.words)) > 90


def _is_wide(field, is_group):
    """Whether a field takes the width of the form; the others are beside each other."""
    if field.control == ONE:
        return is_group and sum(len(word) + ROOM for word in field.words) > SHORT
    return field.control != LINE or field.kind not in SHORT_KINDS


def _described(place, field, *more):
    """What a field is described by."""
    names = [*(f"{place}-help" for _ in [0] if field.help), *more, f"{place}-verdict"]
    return f'aria-describedby="{" ".join(names)}"'


def _unit(place, unit):
    return f'<span class="unit" id="{place}-unit">{escaped(unit)}</span>' if unit else ""


def _line(place, field, beside):
    unit = [f"{place}-unit"] if field.unit else []
    size = "short" if field.kind in SHORT_KINDS else "long"
    symbols = f' data-symbols="{escaped(" ".join(field.symbols))}"' if field.symbols else ""
    return (
        f'<span class="box"><input type="text" id="{place}" class="{size}" {_PLAIN} '
        f"{_described(place, field, *unit)}{symbols}>{_unit(place, field.unit)}</span>"
    )


def _typeset(symbols):
    """The place for what is typed in two dimensions, which repeats the field, and the keys that a telephone shows."""
    buttons = "".join(
        f'<button type="button" class="key" aria-label="{escaped(name)}" data-writes="{escaped(writes)}">{key}</button>'
        for name, key, writes in keys(symbols)
    )
    row = f'<div class="keys" role="group" aria-label="keys for the formula" hidden>{buttons}</div>'
    return f'<div class="typeset" aria-hidden="true"></div>{row}'


def _lines(place, field, beside):
    return f'<textarea id="{place}" rows="8" {_PLAIN} {_described(place, field)}></textarea>'


def _one(place, field, beside):
    if _is_list(field, beside):
        options = "".join(f"<option>{escaped(word)}</option>" for word in field.words)
        none = '<option value="">choose</option>'
        return f'<select id="{place}" autocomplete="off" {_described(place, field)}>{none}{options}</select>'
    return _choices(place, field, "radio")


def _several(place, field, beside):
    return _choices(place, field, "checkbox")


def _choices(place, field, kind):
    """Words beside each other, each with a button or a box."""
    boxes = "".join(
        f'<label class="choice"><input type="{kind}" name="{place}" value="{escaped(word)}" autocomplete="off"'
        f"{' data-none' if kind == 'checkbox' and word == NONE else ''}> <span>{_spoken(field, word)}</span></label>"
        for word in field.words
    )
    return f'<div class="choices">{boxes}</div>'


def _spoken(field, word):
    return "none of them" if field.control == SEVERAL and word == NONE else escaped(word)


def _order(place, field, beside):
    """A line of text, and buttons that write their words into it."""
    buttons = "".join(f'<button type="button" class="word">{escaped(word)}</button>' for word in field.words)
    return (
        f'<span class="box"><input type="text" id="{place}" class="long" {_PLAIN} {_described(place, field)}></span>'
        f'<div class="words" role="group" aria-label="words to put in">{buttons}</div>'
    )


def _parts(place, field, beside):
    """A line for each part, and where it may have several forms a list of them."""
    lines = [
        f'<span class="part"><label for="{place}-{name}"><code>{name}</code> <span>{what}</span></label>'
        f'<span class="box"><input type="text" id="{place}-{name}" class="short" data-part="{name}" {_PLAIN} '
        f"{_described(place, field, *([f'{place}-{name}-unit'] if unit else []))}>"
        f"{_unit(f'{place}-{name}', unit)}</span></span>"
        for name, what, unit in field.parts
    ]
    if forms := field.more.get("forms"):
        options = "".join(f"<option>{form}</option>" for form in forms)
        lines.append(
            f'<span class="part"><label for="{place}-form">form</label>'
            f'<select id="{place}-form" data-part="form" autocomplete="off">{options}</select></span>'
        )
    return f'<div class="parts">{"".join(lines)}</div>'


def _elsewhere(place, field, beside):
    return ""


_BODIES = {
    LINE: _line,
    LINES: _lines,
    ONE: _one,
    SEVERAL: _several,
    ORDER: _order,
    PARTS: _parts,
    ELSEWHERE: _elsewhere,
}
