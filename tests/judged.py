"""One answer of each kind, what is no answer or means harm, and what tests ask of a verdict."""

import ast
import math

import numpy as np
import sympy

from exercisebook.authoring import criterion, design, expression, number, numbers, poles, time_function, word, words
from exercisebook.formulas import Formula
from exercisebook.judging import UNJUDGED, judge
from plainmath.expressions import t

X, K = sympy.symbols("x K")
#: By the code of their forms.
EVERY_KIND = {
    'number("K/%")': number(2.5, "K/%", "the gain", within=0.02),
    "number()": number(2),
    'numbers("s")': numbers([[1, 2], [3, 4]], "s", "the matrix"),
    "poles()": poles([-1, -2]),
    'poles("1/min")': poles([-1, -2], "1/min"),
    'expression("m³")': expression(X**2 * K, "the volume", unit="m³"),
    'expression("m³", symbols="K x y")': expression(X**2 * K, "the volume", symbols="K x y", unit="m³"),
    'time_function("°C")': time_function(1 - sympy.exp(-t / 7), 35, "°C", "the response"),
    'word(["direct", "reverse"])': word("reverse", ["direct", "reverse"]),
    'words(["a", "b"])': words(["b"], "ab"),
    'words(["a", "b"], ordered=True)': words(["b", "a"], "ab", ordered=True),
    'number("%")': design(number(2, "%"), criterion("the share", float, above=1, below=3)),
}
#: By what they are.
NOT_TO_BE_JUDGED = {
    "None": None, "ellipsis": ..., "NaN": math.nan, "infinite": math.inf, "a text": "about this much",
    "unclosed": "2*(s", "another letter": "xyzzy + 1", "an object": object(), "a type": dict, "empty list": [],
    "nested": [[1, 2], [3]], "truth": True, "code": "__import__('os').getcwd()", "a set": {"a", 1}, "bytes": b"1",
    "array of objects": np.array([None, object()]), "a failing function": lambda _: 1 / 0,
}  # fmt: skip
#: What a verdict may quote.
QUOTED = ["$\\href{javascript:alert(1)}{x}$", "\ud800", "two\nlines", sympy.Symbol("$x$"), sympy.Symbol("x" * 10**5)]


class Liar:
    """An answer whose methods all fail."""

    def _fails(self, *_):
        raise RuntimeError("no")

    __eq__ = __float__ = __complex__ = __repr__ = __str__ = __iter__ = __len__ = __getattr__ = __array__ = _fails
    __hash__ = None


class Interrupting:
    """An answer whose methods end the program."""

    def _ends(self, *_):
        raise SystemExit

    def _interrupts(self, *_):
        raise KeyboardInterrupt

    __complex__ = __float__ = _ends
    __getattr__ = _interrupts


def assert_judged(kind, given, status, says):
    """The verdict on an answer of a kind has this status, and its sentence holds these words."""
    verdict = judge("x", kind, given)
    assert verdict.status == status, verdict
    assert says in verdict.says, verdict


def assert_suffers_no_harm(kind):
    """An answer that fails or ends the program is not judged, and what a verdict quotes is plain text in one line."""
    for answer in (Liar(), Interrupting()):
        assert judge("x", kind, answer).status == UNJUDGED
    for answer in QUOTED:
        says = judge("x", kind, answer).says
        assert not {"$", "\n"} & {*says}
        assert len(says) <= 400
        assert says.encode("utf-8")


def assert_is_tried_in_its_forms(kind):
    """The forms in which an answer is tried are several, the right ones are right, and the wrong ones are not."""
    right = [form for _, form in kind.right_forms()]
    assert len(right) >= 2
    assert kind.agrees(kind.read(kind.as_given)[0])
    for form in right:
        assert kind.agrees(kind.read(form)[0]), form
    for _, form in kind.wrong_forms():
        assert not kind.agrees(kind.read(form)[0]), form


def alike(one, other):
    """Whether two answers, as they were read, are the same."""
    if isinstance(one, Formula):
        return isinstance(other, Formula) and one.text == other.text
    return np.array_equal(one, other) if isinstance(one, np.ndarray) else type(one) is type(other) and one == other


def assert_reads_back(kind, answer):
    """An answer as code, in one line, reads back as the same answer."""
    code = kind.as_code(answer)
    assert "\n" not in code
    assert alike(kind.read(ast.literal_eval(code))[0], answer), code


def assert_is_made_again(kind, names):
    """The code that makes a kind makes the same one again, with the names of authors."""
    made = eval(kind.making, names)
    assert made.agrees(kind.key)
    assert (made.asked, made.making) == (kind.asked, kind.making)
