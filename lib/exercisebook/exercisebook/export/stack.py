"""Variants of exercises as STACK questions of Moodle: formulas, lists and poles, beside numbers and words.

A formula is compared as in `agreement`: Maxima looks for numbers near those of the key with which the key has the
values of the answer, at points that the question has. Rounded numbers of an answer in another form are not looked for:
with four digits it is right, too. A mistake is known by its values.

Source: `question/type/stack/questiontype.php` of STACK 4.11, and its documentation of inputs and response trees.
"""

from __future__ import annotations

import ast
import itertools
from collections.abc import Iterable, Mapping
from importlib import resources
from xml.etree import ElementTree

import numpy as np

from exercisebook.agreement import EXACT, LEFT, LEFT_IN_TIME, sizes_in_time
from exercisebook.credit import NOTHING, Credit
from exercisebook.export.cells import CannotHoldError, Cell, Known, cells
from exercisebook.export.moodle import IN_A_TEXT, Held, add, add_text
from exercisebook.forms.text import escaped, sentence
from exercisebook.formulas import is_number
from exercisebook.kinds import Expression, Number, Numbers, Poles, TimeFunction, Word, Words
from exercisebook.kinds.kind import NONE
from exercisebook.kinds.numeric import DAMPING, ON_AXIS, allowed
from exercisebook.question import Question
from exercisebook.rounding import InRatio, InTime, Measure, Rounded

#: A formula is compared at so many points, and at one more for each of its numbers.
POINTS = 10
#: Where all numbers together change a value by no more than so many times what each may; for a mistake, at so many.
CALM, OF_MISTAKES = 20, 6
#: A function of time that changes by less than so many times its size is not told from a constant.
FLAT = 1e-3
#: Between these sizes a value is safe in Maxima.
SMALLEST, LARGEST = 1e-60, 1e60
#: Functions that are called alike in Maxima, and what else is.
FUNCTIONS = {"exp", "sqrt", "log", "sin", "cos", "tan", "asin", "acos", "atan", "sinh", "cosh", "tanh", "factorial"}
CONSTANTS = {"pi": "%pi", "E": "%e", "e": "%e", "I": "%i", "i": "%i", "j": "%i"}
_SIGNS = {ast.Add: "+", ast.Sub: "-", ast.Mult: "*", ast.Div: "/", ast.Pow: "^"}


def stack(question: Question, credit: Credit = NOTHING) -> Held:
    """Return a variant as a STACK question. Raises CannotHoldError for answers that it does not read."""
    for kind in question.key.values():
        if isinstance(kind, Expression) and kind.within == 0:
            raise CannotHoldError("an exact formula")
        if not isinstance(kind, Number | Numbers | Poles | Expression | Word) and not (
            isinstance(kind, Words) and not kind.ordered
        ):
            raise CannotHoldError(kind.maker.replace("_", " "))
    found = cells(question, credit)
    more = [ElementTree.Element("stackversion"), ElementTree.Element("questionvariables")]
    library = resources.files("exercisebook.export").joinpath("stack.mac").read_text("utf-8")
    for tag, text in (("specificfeedback", ""), ("questionnote", ""), ("prtcorrect", "Right."),
                      ("prtpartiallycorrect", ""), ("prtincorrect", "Not right.")):  # fmt: skip
        parent = ElementTree.Element("more")
        add_text(parent, tag, text)
        more.append(parent[0])
    trees, models = [], []
    for place, cell in enumerate(found, start=1):
        fields, code, known = _checked(cell, f"ans{place}")
        models.append(f"model{place}: {fields['tans']};")
        more.append(_input(f"ans{place}", fields | {"tans": f"model{place}"}))
        trees.append(_tree(f"prt{place}", cell.weight, f"place{place}: {code};", f"place{place}", known))
    add(more[1], "text", "\n".join([library, *models]))
    places = [f"[[input:ans{k}]] [[validation:ans{k}]] [[feedback:prt{k}]]" for k in range(1, len(found) + 1)]
    return "stack", list(zip(found, places, strict=True)), [*more, *trees]


def _input(name, fields):
    element = ElementTree.Element("input")
    usual = {"strictsyntax": 1, "insertstars": 4, "forbidfloat": 0, "checkanswertype": 0, "mustverify": 0}
    for tag, text in ({"name": name} | usual | {"showvalidation": 1, "boxsize": 40} | fields).items():
        add(element, tag, text)
    return element


def _tree(name: str, weight: int, code: str, place: str, known: Iterable[Known]) -> ElementTree.Element:
    """A tree that asks which of the known answers one is, one after the other."""
    element = ElementTree.Element("prt")
    add(element, "name", name)
    add(element, "value", weight)
    add(element, "autosimplify", 1)
    add(element, "feedbackstyle", 1)
    add(add(element, "feedbackvariables"), "text", code)
    known = list(known)
    for count, one in enumerate(known):
        node = add(element, "node")
        following = count + 1 if count + 1 < len(known) else -1
        for tag, text in {
            "name": count, "answertest": "AlgEquiv", "sans": place, "tans": count + 1, "testoptions": "", "quiet": 1,
            "truescoremode": "=", "truescore": f"{one.share / 100:g}", "truepenalty": "", "truenextnode": -1,
            "trueanswernote": f"{name}-{count + 1}", "falsescoremode": "=", "falsescore": 0, "falsepenalty": "",
            "falsenextnode": following, "falseanswernote": f"{name}-none" if following < 0 else f"{name}-{count + 1}-F",
        }.items():  # fmt: skip
            add(node, tag, text)
        add_text(node, "truefeedback", sentence(one.says).translate(IN_A_TEXT))
        add_text(node, "falsefeedback", "")
    return element


def _checked(cell: Cell, answer: str) -> tuple[dict[str, object], str, list[Known]]:
    """How an answer is typed, the code that finds its place among the known ones, and these."""
    kind, known = cell.kind, list(cell.known)
    if isinstance(kind, Number):
        between = _listed(_listed(_ends(one), 13) for one in known)
        return {"type": "numerical", "tans": _text(kind.key), "boxsize": 12}, f"lb_number({answer}, {between})", known
    if isinstance(kind, Word):
        order = {one.value: count for count, one in enumerate(known, start=1)}
        offered = _listed(_choice(k, word, word == kind.key) for k, word in enumerate(kind.among, start=1))
        code = f"{_listed(order[word] for word in kind.among)}[{answer}]"
        return {"type": "dropdown", "tans": offered, "showvalidation": 0}, code, known
    if isinstance(kind, Words):
        words = [*kind.field["words"]]
        sets = [[k for k, word in enumerate(words, 1) if word in (one.value or [NONE])] for one in known]
        offered = _listed(_choice(k, word, k in sets[0]) for k, word in enumerate(words, start=1))
        code = f"lb_place(makelist(is(setify({answer}) = setify(one)), one, {_listed(map(_listed, sets))}))"
        return {"type": "checkbox", "tans": offered, "showvalidation": 0}, code, known
    if isinstance(kind, Expression):
        code, known = _formula(kind, answer, known)
        words = ", ".join(sorted({"theta", "tau"}.union(one for one in kind.symbols if len(one) > 1)))
        return _typed("2*x*y") | {"tans": maxima(kind.key.tree), "allowwords": words}, code, known
    if not np.size(kind.key):
        raise CannotHoldError("an empty list")
    known = [one for one in known if np.size(one.value) or isinstance(kind, Poles)]  # there may be none
    rows = [np.ravel(one.value) for one in known]
    if isinstance(kind, Poles):
        on_axis = _text(ON_AXIS * np.max(np.abs(kind.key)))
        of = [(_listed(row), _listed(allowed(row, kind.within, 1e-12)), _damped(kind, row)) for row in rows]
        tests = [f"lb_poles(lb_list({answer}), {', '.join(one)}, {on_axis})" for one in of]
    else:
        tests = [f"lb_row(lb_list({answer}), {_listed(row)}, {_listed(kind.allowed(row))})" for row in rows]
    shown = _listed(_listed(row) for row in kind.key) if kind.key.ndim > 1 else _listed(kind.key)
    example = "[[1, 2], [3, 4]]" if kind.key.ndim > 1 else "[1, 2 + 3*i]" if isinstance(kind, Poles) else "[1, 2]"
    return _typed(example) | {"tans": shown}, f"lb_place({_listed(tests)})", known


def _typed(example):
    """An input whose empty field shows how one types: brackets and signs between symbols cannot be left out."""
    return {"type": "algebraic", "syntaxhint": example, "syntaxattribute": 1}


def _damped(kind, row):
    """By how much the real part of each pole may be off; of one on the axis its side is looked at."""
    return _listed(DAMPING * kind.within * abs(one.real) or LARGEST for one in row)


def _ends(one):
    """Between which a number is taken for it; of a single value, but for its last digits."""
    off = 1e-11 * abs(one.low) if one.low == one.high else 0
    return [one.low - off, one.high + off]


def _choice(place, word, is_right):
    text = escaped(word).replace('"', "&quot;").replace("\\", "\\\\")
    return f'[{place}, {"true" if is_right else "false"}, "{text}"]'


@np.errstate(all="ignore")
def _formula(kind: Expression, answer: str, known: list[Known]) -> tuple[str, list[Known]]:
    """The code that compares a formula, and the known answers that have values where it is compared."""
    points, in_time = kind.points(), isinstance(kind, TimeFunction)
    expected = kind.key.told_at(points)[0]
    measure: Measure = InTime(sizes_in_time(expected, points["t"], False)) if in_time else InRatio()
    key = Rounded.of(kind.key, points, kind.within, measure)
    factors = {id(one.node): f"lb_p[{k}]" for k, group in enumerate(key.numbers, 1) for one in group}
    text = maxima(kind.key.tree, factors)
    size = np.abs(expected)
    safe = np.flatnonzero(
        (key.reach < CALM * kind.within) & key.calm & np.isfinite(expected) & (size > SMALLEST) & (size < LARGEST)
    )
    if safe.size < POINTS:
        raise CannotHoldError("a formula of few values")
    left = max((LEFT_IN_TIME if in_time else LEFT) * kind.within, EXACT)
    scales = measure.size if isinstance(measure, InTime) else size
    wrong, values, reaches, all_told = [], [], [], safe
    for one in known[1:]:
        found = one.value.values_at(points)
        reach = np.abs(Rounded.of(one.value, points, kind.within, measure).reach) + left
        reach = reach * scales if in_time else np.minimum(reach, CALM * kind.within) * np.abs(found)
        reach = np.maximum(reach, left * scales)  # it may vanish
        told = all_told[(np.isfinite(found) & np.isfinite(reach) & (np.abs(found) < LARGEST))[all_told]]
        enough = told.size >= max(POINTS, safe.size / 2)  # it is compared where it has values
        if enough and in_time and "t" in _names(one.value.tree):  # no constant is taken for it
            change = np.ptp(found[told].real)
            enough, reach = change > FLAT * np.max(np.abs(found[told])), np.minimum(reach, change / 3)
        if enough:
            all_told = told
            wrong.append(one)
            values.append(found)
            reaches.append(reach)
    at = all_told[np.unique(np.linspace(0, all_told.size - 1, POINTS + len(key.numbers)).astype(int))]
    of_wrong = at[np.unique(np.linspace(0, at.size - 1, OF_MISTAKES).astype(int))]
    of_wrong = _telling_apart([one.says for one in wrong], values, reaches, all_told, of_wrong)
    at = np.union1d(at, of_wrong)
    some = np.searchsorted(at, of_wrong)
    rows = [
        _listed([_listed(one[of_wrong].real, 5), _listed(one[of_wrong].imag, 5), _listed(reach[of_wrong], 2)])
        for one, reach in zip(values, reaches, strict=True)
    ]
    scale = scales[at]
    slopes = (key.slopes[:, at] * (1 if in_time else expected[at] / scale)).T  # of values beside their sizes
    ways = np.linalg.pinv(np.concatenate([slopes.real, slopes.imag]), rcond=1e-10) / np.tile(scale, 2)
    drawn = [
        _listed(f"{name} = {_text(np.broadcast_to(v, expected.shape)[k], 5)}" for name, v in points.items()) for k in at
    ]
    own = f"{sum(one.is_own for one in wrong)}"
    said = [answer, _listed(rows), own, _listed(drawn), text, _listed(key.bounds), _listed(map(_listed, ways))]
    return f"lb_formula({', '.join([*said, _listed(left * scale), _listed(some + 1)])})", [known[0], *wrong]


def _names(tree):
    return {node.id for node in ast.walk(tree) if isinstance(node, ast.Name)}


def _telling_apart(says, values, reaches, places, chosen):
    """The chosen places, and one more for a mistake that is taken at all of these for an earlier with other words."""
    for (one, first, reach), (two, second, _) in itertools.combinations(zip(says, values, reaches, strict=True), 2):
        apart = np.abs(first - second) / reach
        if one != two and np.max(apart[chosen]) <= 1 < np.max(apart[places]):
            chosen = np.append(chosen, places[np.argmax(apart[places])])
    return np.unique(chosen)


def maxima(node: ast.expr, factors: Mapping[int, str] | None = None) -> str:
    """Return a formula as Maxima reads it. Raises CannotHoldError for a function that is another one there.

    Arguments:
        factors: {id of a node: symbol}, what some of its parts are multiplied by.

    >>> from exercisebook.formulas import Formula
    >>> maxima(Formula("2*exp(-3*s)/(10*s + 1)**2", "s").tree)
    '((2*exp(((-3)*s)))/(((10*s)+1)^2))'
    """
    match node:
        case ast.Constant(value=bool() | str()):
            raise CannotHoldError("a formula with pieces")
        case ast.Constant(value):
            found = _text(value, 15)
        case ast.Name(name):
            found = CONSTANTS[name] if is_number(node) else name
        case ast.UnaryOp(ast.USub(), inner):
            found = f"(-{maxima(inner, factors)})"
        case ast.UnaryOp(ast.UAdd(), inner):
            found = maxima(inner, factors)
        case ast.BinOp(left, sign, right) if type(sign) in _SIGNS:
            found = f"({maxima(left, factors)}{_SIGNS[type(sign)]}{maxima(right, factors)})"
        case ast.Call(ast.Name(name), arguments) if name in FUNCTIONS:
            found = f"{name}({', '.join(maxima(one, factors) for one in arguments)})"
        case _:
            raise CannotHoldError("a formula with steps or pieces")
    factor = (factors or {}).get(id(node))
    return f"({factor}*{found})" if factor else found


def _listed(values: Iterable[object], digits: int = 7) -> str:
    return f"[{', '.join(one if isinstance(one, str) else _text(one, digits) for one in values)}]"


def _text(value: complex, digits: int = 12) -> str:
    """A number as Maxima reads it."""
    value = complex(value)
    if value.imag:
        return f"({value.real:.{digits}g}) + ({value.imag:.{digits}g})*%i"
    if value.real.is_integer() and abs(value.real) < 10**digits:
        return f"{int(value.real)}"
    return f"{value.real:.{digits}g}"
