"""Conditions and values of a chart, written in the manner of Structured Text, read through a white list.

``h >= 0.9 AND NOT stop``, ``TRUE``, ``Heat.T >= 600``. A text is parsed by `ast` and becomes nested functions of the
kinds of nodes that stand in this module: nothing else can be written, and nothing is ever given to `eval`.
"""

from __future__ import annotations

import ast
import numbers
import operator
import re
from collections.abc import Mapping

__all__ = ["Formula"]

COMPARISONS = {
    ast.Lt: operator.lt, ast.LtE: operator.le, ast.Gt: operator.gt, ast.GtE: operator.ge, ast.Eq: operator.eq,
    ast.NotEq: operator.ne,
}  # fmt: skip
OPERATIONS = {ast.Add: operator.add, ast.Sub: operator.sub, ast.Mult: operator.mul, ast.Div: operator.truediv}
WORDS = {"AND": "and", "OR": "or", "NOT": "not", "TRUE": "True", "FALSE": "False"}
WORD = re.compile(rf"\b({'|'.join(WORDS)})\b", re.IGNORECASE)
EXAMPLE = "'h > 0.9 AND NOT stop'"


class Formula:
    """A condition, or the value of an action: a text and what it says.

    The words are AND, OR, NOT, TRUE and FALSE, in capitals or not; equality is ``=`` or ``==`` and inequality ``<>``;
    NOT is meant for the whole comparison behind it. ``Heat.X`` tells whether the step Heat is active, ``Heat.T`` for
    how long, or for how long it was when it was last active; times are plain numbers. A number that is used as a
    condition, such as a button, must be 0 or 1.

    Attributes:
        text: as it was written, with single blanks.
        names: the signals, steps' flags and steps' times in it, each once, in their order.
        kind: "boolean", "number", or "signal" where it is a signal alone, which can be both.

    Arguments:
        text: the formula.
        owner: what it belongs to, for messages: "the condition of T_Fill_Heat".
    Raises:
        ValueError: for what is none.

    >>> condition = Formula("h >= 0.9 AND NOT stop")
    >>> condition.names, condition.value({"h": 0.95, "stop": 0})
    (('h', 'stop'), True)
    """

    text: str
    names: tuple[str, ...]
    kind: str

    def __init__(self, text: str | bool, owner: str = "the formula"):
        self.owner = owner
        if isinstance(text, bool):
            text = str(text).upper()
        if not isinstance(text, str) or not text.strip():
            raise ValueError(f"{owner} is {text!r}: expected a text such as {EXAMPLE}")
        self.text = " ".join(text.split())
        if ":=" in self.text:
            raise ValueError(f"{owner} is {self.text!r}: := assigns, a condition compares with ==")
        if "#" in self.text:  # Python would read what follows as a comment
            raise ValueError(f"{owner} is {self.text!r}: expected a time as a plain number, as in 'Heat.T >= 600'")
        plain = re.sub(WORD, lambda word: WORDS[word[0].upper()], self.text.replace("<>", "!="))
        plain = re.sub(r"(?<![<>=!])=(?!=)", "==", plain)
        found = []
        try:
            self.kind, self._function = self._read(ast.parse(plain, mode="eval").body, found)
        except (SyntaxError, RecursionError, MemoryError):
            raise ValueError(f"{owner} is {self.text!r}: expected a formula such as {EXAMPLE}") from None
        self.names = tuple(dict.fromkeys(found))

    def __repr__(self) -> str:
        return f"Formula({self.text!r})"

    @property
    def constant(self) -> bool | float | None:
        """The value of a formula without names, else None."""
        return None if self.names else self.value({})

    def condition(self) -> Formula:
        """Return the formula if it is TRUE or FALSE, else raise ValueError."""
        if self.kind == "number":
            raise ValueError(f"{self.owner} is {self.text!r}, a number: expected a condition such as {EXAMPLE}")
        return self

    def value(self, values: Mapping[str, float]) -> bool | float:
        """Return the value, True or False for a condition, for values of the names in it."""
        try:
            return self._function(values)
        except ZeroDivisionError:
            raise ValueError(f"{self.owner} is {self.text!r}, which divides by zero here") from None

    def true(self, values: Mapping[str, float]) -> bool:
        """Tell whether a condition holds."""
        return self._truth((self.kind, self._function))(values)

    def _read(self, node, found):
        """The kind of a node, and a function of the values that gives its value."""
        match node:
            case ast.Constant(bool(x)):
                return "boolean", lambda values: x
            case ast.Constant(int() | float() as x):
                return "number", lambda values: x
            case ast.Name(name):
                found.append(name)
                return "signal", lambda values: values[name]
            case ast.Attribute(ast.Name(step), "X" | "T" as what):
                name = f"{step}.{what}"
                found.append(name)
                return ("boolean" if what == "X" else "number"), lambda values: values[name]
            case ast.UnaryOp(ast.Not(), operand):
                holds = self._truth(self._read(operand, found))
                return "boolean", lambda values: not holds(values)
            case ast.UnaryOp(ast.USub(), operand):
                number = self._number(self._read(operand, found))
                return "number", lambda values: -number(values)
            case ast.BoolOp(how, operands):
                parts = [self._truth(self._read(operand, found)) for operand in operands]
                together = all if isinstance(how, ast.And) else any
                return "boolean", lambda values: together(part(values) for part in parts)
            case ast.BinOp(left, how, right) if type(how) in OPERATIONS:
                one, other = (self._number(self._read(part, found)) for part in (left, right))
                combine = OPERATIONS[type(how)]
                return "number", lambda values: combine(one(values), other(values))
            case ast.Compare(left, [how], [right]) if type(how) in COMPARISONS:
                return "boolean", self._comparison(
                    COMPARISONS[type(how)], *(self._read(x, found) for x in (left, right))
                )
        part = ast.unparse(node)
        raise ValueError(f"{self.owner} is {self.text!r}, where {part!r} is not a part of a formula such as {EXAMPLE}")

    def _comparison(self, compare, left, right):
        equality = compare in (operator.eq, operator.ne)
        if "boolean" in (left[0], right[0]):  # two truth values can be alike, but neither is the larger one
            if not equality or "number" in (left[0], right[0]):
                raise ValueError(f"{self.owner} is {self.text!r}, which compares a number with TRUE or FALSE")
            one, other = self._truth(left), self._truth(right)
        else:
            one, other = left[1], right[1]
        return lambda values: compare(one(values), other(values))

    def _number(self, part):
        kind, function = part
        if kind == "boolean":
            raise ValueError(f"{self.owner} is {self.text!r}, which calculates with TRUE or FALSE")
        return function

    def _truth(self, part):
        kind, function = part
        if kind == "number":
            raise ValueError(f"{self.owner} is {self.text!r}, in which a number stands for TRUE or FALSE")
        if kind == "boolean":
            return function

        def truth(values):
            x = function(values)
            if x not in (0, 1):
                found = f"{x:g}" if isinstance(x, numbers.Real) else repr(x)
                raise ValueError(f"{self.owner} is {self.text!r}, with a signal of {found}: expected 1 or 0")
            return bool(x)

        return truth
