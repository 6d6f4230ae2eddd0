"""Reading what readers give, without running anything of theirs: values, rows of values, and formulas.

Numbers with their units are read in `kinds.numeric`.

Python's grammar reads the text of a formula, and what is no arithmetic is refused. A text that is none of Python's is
read as people write formulas, in `notation`, and a remark says how. SymPy's expressions, and linear systems of SciPy
and python-control, are read from what they spell.
"""

from __future__ import annotations

import ast
import itertools
import math
import re
import unicodedata
import warnings
from collections.abc import Collection, Iterable, Iterator, MappingView
from typing import Any

import numpy as np
import sympy
from sympy.core.function import AppliedUndef

from exercisebook import notation
from plainmath.validation import did_you_mean

#: What is left of an answer cell that nobody has filled in.
NOT_ANSWERED = "not answered yet"
LONGEST, MOST_NODES = 4000, 2000
#: Of what gives one value after another, so many are read.
MOST_VALUES = 10_000
#: A text that somebody typed, and not a program, has so many characters.
LONGEST_BY_HAND = 600
#: Brackets around a whole list.
MOST_BRACKETS = 10

#: What a formula may call, and with how many values.
ONE_VALUE = (
    "exp", "log", "ln", "log10", "sqrt", "sin", "cos", "tan", "sinh", "cosh", "tanh", "asin", "acos", "atan",
    "arcsin", "arccos", "arctan", "Abs", "abs", "sign", "re", "im",
)  # fmt: skip
SEVERAL_VALUES = ("Min", "Max", "min", "max", "Heaviside", "Piecewise")
CONSTANTS = {"pi": np.pi, "E": np.e, "e": np.e, "I": 1j, "j": 1j, "i": 1j}

#: Signs as they are printed, and as Python writes them.
_SIGNS = str.maketrans(
    dict.fromkeys("−–‐‑﹣－", "-") | dict.fromkeys("·⋅×∙•∗", "*") | dict.fromkeys("÷∕⁄", "/")
    | {"∞": "oo", "½": "(1/2)", "¼": "(1/4)", "¾": "(3/4)", "⅓": "(1/3)", "⅔": "(2/3)", "≤": "<=", "≥": ">=", "’": "'"}
)  # fmt: skip
_RAISED = str.maketrans("⁰¹²³⁴⁵⁶⁷⁸⁹⁻", "0123456789-")
_LOWERED = str.maketrans("₀₁₂₃₄₅₆₇₈₉", "0123456789")
#: What Python makes of the LaTeX in a text that is not raw: of ``\\tau`` a tab and "au".
_ESCAPED = {
    "\t": "t(?=au|heta|imes|ext|frac)", "\f": "f(?=rac)", "\r": "r(?=ight|m)", "\b": "b(?=eta|ig)",
    "\v": "v(?=ar)", "\a": "a(?=lpha)",
}  # fmt: skip
#: A quantity with its sign =, as "y(t) =", "dh/dt =" or "Y(s)/U(s) [K] =".
_NAME = r"(?:(?:\\d?dot ?\{? ?)?\\?[^\W\d]\w*(?:_\(\w+\))?\}?'*(?: ?\( ?\w+ ?\))?)"
_PREFIX = re.compile(rf"^(?!lambda\b)(?:{_NAME}(?: ?/ ?{_NAME})? ?(?:\[[^\]=]*\] ?)?)? ?(?:=(?!=)|≈|:(?!=)) ?")
_ABOUT = re.compile(r"^(?:~|≈|(?:ca|approx|approximately|about|around|circa|roughly|nearly)\b\.?) ?", re.IGNORECASE)

_ARITHMETIC = (
    ast.BinOp, ast.UnaryOp, ast.Call, ast.Compare, ast.Tuple, ast.Load,
    ast.Add, ast.Sub, ast.Mult, ast.Div, ast.Pow, ast.USub, ast.UAdd,
    ast.Lt, ast.LtE, ast.Gt, ast.GtE, ast.BitAnd, ast.BitOr,
)  # fmt: skip


class Unreadable(ValueError):  # noqa: N818 - it is what became of the answer
    """An answer that cannot be judged; the sentence says why and what is expected."""


class NotPython(Unreadable):
    """A text that is no expression of Python's."""


# --------------------------------------------------------------------------------------------------------- values


def answered(given: object) -> Any:
    """Return what was given; raises Unreadable where that is nothing yet."""
    if given is None or given is Ellipsis:
        raise Unreadable(NOT_ANSWERED)
    return given


def in_a_row(given: object) -> list[Any] | None:
    """Return the values of a list, tuple, array, matrix or range as a list; None where there is no row of values."""
    if isinstance(given, sympy.MatrixBase):
        return given.tolist()
    if isinstance(given, sympy.Tuple | list | tuple | range | Iterator | MappingView):
        return list(itertools.islice(given, MOST_VALUES))
    if hasattr(given, "tolist") and hasattr(given, "ndim"):
        return given.tolist() if given.ndim else None
    return None


def members(given: Iterable[Any]) -> list[Any]:
    """Return the members of a set in an order that is the same in each run of Python, numbers before texts.

    >>> members({"S4", "S2", 1})
    [1, 'S2', 'S4']
    """
    return sorted(given, key=lambda one: (isinstance(one, str), str(one)))


def alone(given: object) -> Any:
    """Return the value that stands alone in a row, a set, an array, or an equation for a symbol; others as they are.

    >>> alone([{sympy.Symbol("x"): 3}]), alone(sympy.Eq(sympy.Symbol("x"), 3)), alone([1, 2])
    (3, 3, [1, 2])
    """
    if isinstance(given, sympy.Equality) and isinstance(given.lhs, sympy.Symbol | AppliedUndef):
        return given.rhs
    if isinstance(given, dict) and len(given) == 1 and isinstance(next(iter(given)), sympy.Symbol | AppliedUndef):
        return next(iter(given.values()))
    if isinstance(given, set | frozenset | sympy.FiniteSet):
        given = members(given)
    elif getattr(given, "ndim", None) == 0 and hasattr(given, "tolist") and not hasattr(given, "units"):
        return given.tolist()
    row = in_a_row(given)
    if row is None:
        return given
    return alone(row[0]) if len(row) == 1 else row


#: A name before a list or an array, and the call that makes an array.
_NAMED_LIST = re.compile(r"^[^\W\d]\w* ?= ?(?=\[|(?:\w+\.)?(?:Matrix|array)\()")
_ARRAY = re.compile(r"(?:\w+\.)?(?:Matrix|array)\((.*)\)")


def listed_in(text: str) -> list[str]:
    """Return the parts of a text that lists several: "[1, 2]" or "1; 2".

    Between brackets every comma separates, unless there are semicolons; elsewhere a comma before a space or a sign
    does, as others are decimal commas.

    >>> listed_in("[-1,-2]"), listed_in("-1 + 2j; -3"), listed_in("1,5"), listed_in("[0,5; 1]")
    (['-1', '-2'], ['-1 + 2j', '-3'], ['1,5'], ['0,5', '1'])
    >>> listed_in("[[1, 2], [3, 4]]"), listed_in("1, 2 and 3")
    (['[1, 2]', '[3, 4]'], ['1', '2', '3'])
    """
    text = _NAMED_LIST.sub("", " ".join(text.split()))
    if array := _ARRAY.fullmatch(text):
        text = array[1]
    if not text:
        return [text]
    inside = _unwrapped(text)
    for separator in (r";|\n", r",? (?:and|und|&) |, |,(?=[-−+±])", r"," if inside != text else r",(?=\[)"):
        depths = _depths(inside)
        places = [found for found in re.finditer(separator, inside) if not depths[found.start()]]
        if places:
            ends = [(0, 0), *(found.span() for found in places), (len(inside), len(inside))]
            parts = [inside[one[1] : other[0]].strip() for one, other in itertools.pairwise(ends)]
            return [part for part in parts if part]
    return [inside] if inside else []


def _depths(text):
    """How many brackets are open before each sign of a text, and after the last one."""
    return list(itertools.accumulate(((sign in "([{") - (sign in ")]}") for sign in text), initial=0))


def _unwrapped(text):
    """What stands within the brackets around the whole text; within round ones, where it lists several."""
    pairs = {"[": "]", "{": "}", "(": ")"}
    for _ in range(MOST_BRACKETS):
        depths = _depths(text)
        if not text or pairs.get(text[0]) != text[-1] or not all(depths[1:-1]):
            break
        lists = any(sign in ",;" and depth == 1 for sign, depth in zip(text, depths, strict=False))
        if text[0] == "(" and not lists:
            break
        text = text[1:-1].strip()
        if lists:
            break
    return text


# ------------------------------------------------------------------------------------------------------- formulas


def plain(text: str) -> str:
    """Return a text in one line, with Python's signs, and without a name and = before it or a full stop behind it.

    Raises Unreadable for a long one.

    >>> plain("T_i = 2 · 10 min"), plain("dh/dt ≈ 3 m."), plain("ca. 20 s")
    ('2 * 10 min', '3 m', '20 s')
    """
    if len(text) > LONGEST:
        raise Unreadable(f"the text has {len(text)} characters: expected at most {LONGEST}")
    for made, meant in _ESCAPED.items():
        if made in text:
            text = re.sub(made + meant[1:], "\\\\" + meant[0], text)
    line = " ".join(text.translate(_SIGNS).split())
    line = re.sub("[₀-₉]+", lambda low: "_" + low[0].translate(_LOWERED), line)
    line = re.sub(r"√ ?(?=\()", "sqrt", line)
    line = re.sub(r"√", " sqrt ", line).strip()
    line = _ABOUT.sub("", _PREFIX.sub("", line))
    line = re.sub(r"(?<=.),? \(?(?:approx|approximately|roughly|or so)\b\.?\)?$", "", line)
    return re.sub(r"(?<=[^\d\s.])\.$", "", line)


def _in_python(text, symbols):
    """A formula as Python writes it: powers, names of Greek letters, 2j for 2i, exp for np.exp."""
    text = re.sub("[⁰¹²³⁴-⁹⁻]+", lambda raised: "^" + raised[0].translate(_RAISED), plain(text))
    for greek in set(re.findall("[α-ω]", text)) - set("".join(symbols)):
        text = text.replace(greek, unicodedata.name(greek).split()[-1].lower())
    if "t" not in symbols:  # a signal is a symbol here
        text = re.sub(r"\b(\w+) ?\(t\)", lambda call: call[1] if call[1] in symbols else call[0], text)
    text = re.sub(r"\b(np|numpy|math|cmath|sympy|sp)\.(?=[A-Za-z])", "", text)
    return re.sub(r"\b(\d+\.?\d*)i\b", r"\1j", text).replace("^", "**")


def _as_people_write(text, symbols):
    """A formula in Python's notation that is written in another one; raises notation.Ambiguous."""
    if len(text) > LONGEST_BY_HAND:
        raise notation.Ambiguous("the text is very long")
    known = symbols or ()
    text = plain(notation.from_latex(plain(text))).translate(str.maketrans("[]{}", "()()"))
    text = re.sub("[⁰¹²³⁴-⁹⁻]+", lambda raised: f"^({raised[0].translate(_RAISED)})", text)
    for greek in set(re.findall("[α-ω]", text)) - set("".join(known)):
        name = unicodedata.name(greek).split()[-1].lower()
        # a letter is a factor of its own, with its index
        text = re.sub(rf"(?<=[^\W_]){greek}", f" {greek}", text) if not re.search(rf"\d{greek}", text) else text
        text = re.sub(rf"{greek}(?=[^\W\d_])", f"{name} ", text).replace(greek, name)
    if "x" not in known:
        text = re.sub(r"(?<=\d) ?x ?(?=10 ?\^)", "*", text)
    if not {"i", "j"} & {symbol[0] for symbol in known}:
        text = re.sub(r"(?<![\w.])[ij](\d+(?:\.\d+)?)(?![\w.])", r"\1j", text)
    text = re.sub(r"\b(np|numpy|math|cmath|sympy|sp)\.(?=[A-Za-z])", "", text).replace("^", "**")
    if not re.search(rf"\b({'|'.join(name for name in SEVERAL_VALUES if name != 'Heaviside')})\b", text):
        text = notation.decimal_points(text)
    return notation.in_python(text, symbols, (*ONE_VALUE, *SEVERAL_VALUES), CONSTANTS)


def understood(text: str, symbols: Collection[str]) -> tuple[str, ast.expr]:
    """Return a formula in some symbols in Python's notation, where it was not given in it, and its syntax tree.

    Raises Unreadable in a sentence.

    >>> understood("2e^(-3s)/(10s + 1)", ["s"])[0], understood("2*s", ["s"])[0]
    ('2*e**(-3*s)/(10*s + 1)', '')
    >>> understood("0 for t < 3, 2t for t > 3", ["t"])[0]
    'Piecewise((0, t < 3), (2*t, True))'
    """
    if "#" in text:  # which Python does not read on from
        raise Unreadable("there is a # in the formula: expected the formula alone")
    for side in re.split(r"(?<![<>=!])=(?!=)", text)[:-1]:
        names = set(re.findall(r"[^\W\d]\w*'*", side)) - {"s", "t"}
        if names and names <= set(symbols):
            raise Unreadable("there is a formula on either side of =: expected one of them")
    if "t" in symbols and (pieces := _in_pieces(text)):
        source = _piecewise(pieces, symbols)
        return source, parsed(source, symbols)
    try:
        return "", parsed(text, symbols)
    except Unreadable as problem:
        if not text.strip() or len(text) > LONGEST:
            raise
        try:
            source = _as_people_write(text, symbols)
            return source, parsed(source, symbols)
        except RecursionError:
            raise problem from None
        except Unreadable as other:
            raise (other if isinstance(problem, NotPython) else problem) from None
        except notation.Ambiguous as doubt:
            raise _the_better(problem, doubt, symbols) from None


#: The times for which a piece of a function holds, behind it: "for t < 3 s", "until 3 s", "otherwise".
_TIME = r"(\d+(?:[.,]\d+)?)(?: ?(?:s|min|h|sec|seconds|minutes|hours))?"
_WHEN = re.compile(
    rf"[,:]? ?\(?(?:(?:for|if|when|where|while|at)? ?(?:{_TIME} ?(<=?) ?)?t ?(<=?|>=?) ?{_TIME}"
    rf"|(?:for |for times )?(until|up to|before|from|after) (?:t ?= ?)?{_TIME}(?: on)?"
    r"|(otherwise|else|elsewhere|after(?:wards)?|then))\)?"
)
_TELLS_TIMES = re.compile(r"\bt ?[<>]|\b(?:for|if|when|until|before|after|from|otherwise|else)\b")
_THE_REST = re.compile(r"^(?:else|otherwise|then|afterwards?|after that|elsewhere)[,:]? (.+)$")
_ENDS_PIECE = re.compile(r"\s*(?:[;,.]|and\b|else\b|otherwise\b|\Z)")
MOST_PIECES = 6


def _in_pieces(text):
    """The pieces of a function in words, pairs of a formula and the match of its times; none of another text."""
    if len(text) > LONGEST_BY_HAND or "Piecewise" in text or not _TELLS_TIMES.search(text):
        return []
    line, pieces = plain(text), []
    while line and len(pieces) < MOST_PIECES:
        if pieces:
            line = _THE_REST.sub(r"\1 otherwise", line)
        found = next((one for one in _WHEN.finditer(line) if _ENDS_PIECE.match(line, one.end())), None)
        if not found or not line[: found.start()].strip():
            return []
        pieces.append((_PREFIX.sub("", line[: found.start()].strip()), found))
        line = re.sub(r"^\s*(?:[;,.] ?(?:and )?|and )", "", line[found.end() :]).strip()
    return [] if line else pieces


def _piecewise(pieces, symbols):
    """A function in pieces, in Python's notation; raises Unreadable where it is not said for all times."""
    parts, rest, begins, ends = [], [], [], []
    for formula, when in pieces:
        source = understood(formula, symbols)[0] or plain(formula)
        low, _, sign, time, word, moment, otherwise = (one and one.replace(",", ".") for one in when.groups())
        if otherwise:
            rest.append(f"({source}, True)")
            continue
        if word:
            sign, time = ("<" if word in ("until", "up to", "before") else ">="), moment
        begins.append(float(low or 0) if sign[0] == "<" else float(time))
        ends.append(float(time) if sign[0] == "<" else math.inf)
        parts.append((ends[-1], f"({source}, t {sign} {time})"))
    first, last = min(begins, default=0), max(ends, default=0)
    if not rest and first > 0 and min(ends) > first:
        raise Unreadable(f"what is it before t = {first:g}? Add it, as in: 0 for t < {first:g}, ... for t > {first:g}")
    if not rest and last < math.inf:
        raise Unreadable(f"what is it after t = {last:g}? Add it, as in: ... for t > {last:g}")
    found = [part for _, part in sorted(parts, key=lambda one: one[0])]
    if not rest:  # at the moment itself, where it was said for < and > alone
        found[-1] = found[-1].rpartition(", ")[0] + ", True)"
    return f"Piecewise({', '.join(found + rest[:1])})"


def _the_better(problem, doubt, symbols):
    """The sentence that helps more: on the text as Python's, or on the text as people write it."""
    if doubt.several:
        return Unreadable(str(doubt))
    if doubt.name and isinstance(problem, NotPython):
        try:
            _check_symbol(doubt.name, symbols)
        except Unreadable as unknown:
            return unknown
    return problem


def parsed(text: str, symbols: Collection[str]) -> ast.expr:
    """Return the syntax tree of a formula in some symbols: arithmetic, known functions, and nothing else.

    Raises Unreadable in a sentence.

    >>> parsed("K/(T*s + 1)", ["s"])
    Traceback (most recent call last):
    exercisebook.reading.Unreadable: 'K' is not a symbol of this answer: expected an expression in s
    """
    source = _in_python(text, symbols)
    expected = "expected an expression" + (f" in {listed(symbols)}" if symbols else "")
    if not source:
        raise Unreadable(f"the text is empty: {expected}")
    try:
        with warnings.catch_warnings():  # of Python, on what it reads all the same, as 2or
            warnings.simplefilter("ignore", SyntaxWarning)
            tree = ast.parse(source, mode="eval").body
    except (SyntaxError, ValueError, RecursionError, MemoryError):
        raise NotPython(f"{shortened(source)} cannot be read: {expected}, with * for every product") from None
    nodes = list(ast.walk(tree))
    if len(nodes) > MOST_NODES:
        raise Unreadable("the expression is very long: expected a simpler one")
    calls = [node for node in nodes if isinstance(node, ast.Call)]
    called = {id(call.func) for call in calls}
    pieces = {id(piece) for call in calls for piece in call.args if getattr(call.func, "id", "") == "Piecewise"}
    conditions = {id(piece.elts[-1]) for call in calls for piece in call.args if isinstance(piece, ast.Tuple)}
    for node in nodes:
        match node:
            case ast.Constant(bool()) if id(node) in conditions:
                pass
            case ast.Constant():
                _check_number(node.value, expected)
            case ast.Name() if id(node) in called:
                _check_function(node.id, symbols)
            case ast.Name():
                _check_symbol(node.id, symbols)
            case ast.Call():
                _check_call(node, source)
            case ast.Tuple() if id(node) not in pieces or len(node.elts) != 2:
                raise Unreadable("there is a comma between two values: expected one expression, with a decimal point")
            case ast.Compare() if len(node.ops) > 1:
                raise Unreadable(f"{_quoted(source, node)} compares twice: expected one comparison, or & between two")
            case _ if not isinstance(node, _ARITHMETIC):
                raise Unreadable(f"{_quoted(source, node)} cannot be read: {expected}")
    return tree


def symbols_in(given: object) -> list[str]:
    """Return the symbols of a formula, whichever they are, in their order; of what is no formula, none.

    Raises Unreadable where nothing spells it.

    >>> symbols_in("K*exp(-tau*s)/(T*s + 1)")
    ['K', 'T', 's', 'tau']
    """
    text = spelled(given)
    nodes: list[ast.AST] = []
    for read in (_in_python, _as_people_write):
        try:
            nodes = list(ast.walk(ast.parse(read(text, () if read is _in_python else None), mode="eval")))
            break
        except Unreadable:
            raise
        except (notation.Ambiguous, SyntaxError, ValueError, RecursionError, MemoryError):
            continue
    calls = [node for node in nodes if isinstance(node, ast.Call) and isinstance(node.func, ast.Name)]
    # h(t) is a signal, a symbol; K(s + 1) a product without its sign, which is said of a symbol
    signals = [call for call in calls if [ast.unparse(argument) for argument in call.args] == ["t"]]
    signals = [call for call in signals if call.func.id not in (*ONE_VALUE, *SEVERAL_VALUES)]
    symbols = {call.func.id for call in calls if len(call.func.id.partition("_")[0]) == 1 or call in signals}
    passed = {id(call.func) for call in calls} | {id(call.args[0]) for call in signals}
    symbols |= {node.id for node in nodes if isinstance(node, ast.Name) and id(node) not in passed}
    return sorted(symbols - CONSTANTS.keys())


def _quoted(source, node):
    """The part of the text that a node was read from."""
    part = ast.get_source_segment(source, node) if isinstance(node, ast.expr) else None
    return shortened(part or source)


def _check_number(value, expected):
    if type(value) not in (int, float, complex):
        raise Unreadable(f"{shortened(repr(value))} is not a number: {expected}")
    try:
        in_range = np.isfinite(complex(value))
    except OverflowError:
        in_range = False
    if not in_range:
        raise Unreadable("a number in the expression is out of range: expected a simpler one")


def _check_function(name, symbols):
    known = (*ONE_VALUE, *SEVERAL_VALUES)
    if name in symbols or name in CONSTANTS:
        raise Unreadable(f"{name} comes before a bracket: a product needs its *")
    if name not in known:
        hint = did_you_mean(name, known, otherwise="expected exp, log, sqrt, sin ...")
        raise Unreadable(f"{shortened(name, 30)!r} is not a known function: {hint}")


def _check_symbol(name, symbols):
    if name in symbols or name in CONSTANTS:
        return
    if not symbols:
        raise Unreadable(f"{shortened(name, 30)!r} stands for no number: expected a value without symbols")
    hint = did_you_mean(name, symbols, otherwise=f"expected an expression in {listed(symbols)}")
    raise Unreadable(f"{shortened(name, 30)!r} is not a symbol of this answer: {hint}")


def _check_call(node, source):
    if isinstance(node.func, ast.Constant | ast.BinOp | ast.Call):
        raise Unreadable(f"{_quoted(source, node)} lacks a *: every product needs one, before a bracket too")
    if not isinstance(node.func, ast.Name) or node.keywords or any(isinstance(one, ast.Starred) for one in node.args):
        raise Unreadable(f"{_quoted(source, node)} cannot be read: expected one function of a value")
    if node.func.id in ONE_VALUE and len(node.args) != 1:
        raise Unreadable(f"{node.func.id} has {len(node.args)} arguments: expected one")
    if node.func.id == "Piecewise" and not all(isinstance(piece, ast.Tuple) for piece in node.args):
        raise Unreadable(f"{_quoted(source, node)} cannot be read: expected pairs of a value and a condition")
    if node.func.id == "Piecewise" and len(node.args) > 1:
        _goes_on(node.args[-1])
    if not node.args:
        raise Unreadable(f"{node.func.id} has no arguments: expected at least one")
    if node.func.id == "Heaviside" and len(node.args) > 1 and not _is_value_at_zero(node.args[1]):
        raise NotPython(f"{_quoted(source, node)} has a comma in it: expected one value, with a decimal point")


def _goes_on(piece):
    """Let the last piece of a function end nowhere: its end, as in 20 < t < 45, is that of what is asked."""
    match piece.elts:
        case [_, ast.Compare(ast.Name(), [ast.Lt() | ast.LtE()], [_])]:
            piece.elts[1] = ast.Constant(True)
        case [_, ast.BinOp(begin, ast.BitAnd(), ast.Compare(ast.Name(), [ast.Lt() | ast.LtE()], [_]))]:
            piece.elts[1] = begin


def _is_value_at_zero(node):
    """Whether this may be the second value of a step, as SymPy has one: where it is 0."""
    return not isinstance(node, ast.Constant) or node.value in (0, 0.5, 1)


def spelled(given: object) -> str:
    """Return the text of a formula that was given as text, number, expression or system; raises Unreadable."""
    if isinstance(given, str):
        return given
    if isinstance(given, bool | np.bool_):
        raise Unreadable(f"{given} is a truth value: expected an expression")
    if isinstance(given, sympy.Xor):
        raise Unreadable("in Python ^ is no power: write **, or put the formula in quotes")
    try:
        expression = _expression(given)
    except Exception:  # objects of others may fail in any way
        expression = None
    if expression is None:
        raise Unreadable("this is neither an expression nor a text that spells one")
    nodes = zip(sympy.preorder_traversal(expression), range(MOST_NODES + 1), strict=False)
    if sum(1 for _ in nodes) > MOST_NODES:
        raise Unreadable("the expression is very long: expected a simpler one")
    return str(expression)


def _expression(given):
    """The expression in SymPy that an object is or has; None where there is none."""
    if isinstance(given, sympy.Expr):
        # a signal, h(t), is a symbol here
        return None if given.is_Matrix else given.replace(_is_signal, lambda signal: sympy.Symbol(signal.func.__name__))
    if isinstance(getattr(given, "expr", None), sympy.Expr):
        return given.expr
    if hasattr(given, "to_expr"):  # SymPy's own systems
        return given.to_expr()
    if hasattr(given, "gain") and hasattr(given, "to_tf"):  # SciPy's zeros and poles
        given = given.to_tf()
    if all(hasattr(given, part) for part in ("num", "den")) or all(hasattr(given, part) for part in "ABCD"):
        return _of_system(given)
    if np.ndim(given) == 0:
        value = complex(given)
        return sympy.sympify(value if value.imag else value.real) if math.isfinite(abs(value)) else None
    return None


def _is_signal(part):
    return isinstance(part, AppliedUndef) and [str(argument) for argument in part.args] == ["t"]


def _of_system(given):
    """The expression of a system of python-control or SciPy; None unless it is one in s with one input and output."""
    if getattr(given, "dt", None) or getattr(given, "ninputs", 1) * getattr(given, "noutputs", 1) != 1:
        return None
    if hasattr(given, "num"):
        above, below = np.ravel(given.num), np.ravel(given.den)
    else:
        import scipy.signal

        above, below = map(np.ravel, scipy.signal.ss2tf(given.A, given.B, given.C, given.D))
        above = np.where(np.abs(above) > 1e-12 * np.abs(below), above, 0)  # powers that are there by rounding alone
    above, below = (sympy.Poly([float(x) for x in part], sympy.Symbol("s")).as_expr() for part in (above, below))
    return above / below


def shortened(text: str, length: int = 60) -> str:
    """The text, or its beginning."""
    return text if len(text) <= length else text[: length - 3] + "..."


def listed(names: Iterable[str]) -> str:
    """Names in a sentence.

    >>> listed(["K", "T", "s"])
    'K, T and s'
    """
    *others, last = names
    return f"{', '.join(others)} and {last}" if others else last
