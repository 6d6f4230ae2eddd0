"""What all kinds of asked quantities have in common."""

from __future__ import annotations

import ast
import inspect
import json
import re
from collections.abc import Iterable, Iterator
from typing import TYPE_CHECKING, Any, ClassVar, Self, TypeAlias

import numpy as np

from exercisebook import units
from plainmath.validation import did_you_mean

if TYPE_CHECKING:
    from exercisebook.wholes import Whole

#: How a field of a form is filled in: a line of text, several lines, one word or several of a list, words of a list in
#: an order, parts, each with its own line; or not in a page.
LINE, LINES, ONE, SEVERAL, ORDER, PARTS, ELSEWHERE = "line", "lines", "one", "several", "order", "parts", "elsewhere"
#: What stands for no word of a list, where several may be chosen.
NONE = "none"
#: An answer to try an exercise with, and in words what it is.
Tried: TypeAlias = tuple[str, Any]
AS_IT_IS = "as it is"
#: How many digits a careful student keeps; with a tolerance below this one, all that are needed.
DIGITS, MANY_DIGITS, ALL_DIGITS, ROUGHEST = 3, 8, 16, 0.005
#: Smaller whole numbers are written without a decimal point.
EXACT = 10**15

#: The kinds of answers by the names with which authors make them: {"number": `Number`, ...}.
MAKERS: dict[str, type[Kind]] = {}


class Kind:
    """An asked quantity: its key, and how an answer is read, compared and responded to.

    A class of its own is a kind of answers: it registers itself in `MAKERS`, from where authors, the answer sheet and
    the exports have it. It reads answers, says whether one agrees with the key, and names in ``FORM`` what of its
    arguments says how an answer looks.

    Arguments:
        key: the right answer.
        unit: of the answer; none for a number without unit.
        what: the quantity in words, with its article, as "the period".
        within: how far a number may be off, as a fraction of it.
    """

    #: The name of the function for authors that makes such a kind, as "transfer_function".
    maker: ClassVar[str]
    #: How an answer looks, for one that cannot be judged.
    expected: str = "an answer"
    #: The arguments that say how an answer looks. None of them comes from the key.
    FORM: tuple[str, ...] = ("unit",)
    #: Whether a person marks it, so that nothing is compared.
    by_hand: ClassVar[bool] = False
    #: Whether such an answer belongs to the numbers of one student, so that a right one to others' is recognised.
    is_personal: ClassVar[bool] = False
    #: What an answer is that may come in parts, under names of their own.
    whole: Whole | None = None
    #: Whether there is a picture of what an answer does.
    draws: Any = False
    #: What `precision` says before the accuracy: of the form of an answer, and of its numbers.
    ANY_FORM = EACH = ""
    key: Any
    within: float
    #: What is drawn for comparing an answer is drawn from this text, which no author of answers knows.
    seed = ""
    key, unit, what = None, "", "the value"

    def __init_subclass__(cls) -> None:
        super().__init_subclass__()
        for name, does in (("read", "returns an answer as it is compared"), ("agrees", "says whether one is right")):
            if getattr(cls, name) is getattr(Kind, name):
                raise ValueError(f"the kind {cls.__name__} has no {name}: expected a method that {does}")
        parameters = list(inspect.signature(cls).parameters)
        for name in cls.FORM:
            if name not in parameters[1:]:
                known = did_you_mean(name, parameters[1:])
                raise ValueError(f"FORM of the kind {cls.__name__} names {name!r}, which is not its argument: {known}")
        cls.maker = re.sub("(?<!^)(?=[A-Z])", "_", cls.__name__).lower()
        if cls.maker in MAKERS:
            other = MAKERS[cls.maker].__module__
            raise ValueError(f"the kind {cls.__name__} is in {other} already: expected another name")
        MAKERS[cls.maker] = cls

    def __init__(self, key: object, unit: str = "", what: str = "the value", within: float = 0.01):
        if not units.is_unit(unit):
            raise ValueError(f"the unit of {what} is {unit!r}: expected one such as 's', 'kg/min' or '%/K'")
        self.unit, self.what, self.within = unit, what, within
        self.key = self.read(key)[0]

    @classmethod
    def without_key(cls, *parts: Any, **named: Any) -> Self:
        """Return a kind that reads answers and has nothing to compare them with.

        Arguments:
            parts, named: those of the constructor that are in ``FORM``.

        >>> from exercisebook.kinds import Number
        >>> Number.without_key("s").read("2 min")
        (120.0, 'converted from min')
        """
        given = dict(zip(cls.FORM, parts, strict=False)) | named
        if unknown := [name for name in named if name not in cls.FORM] or parts[len(cls.FORM) :]:
            raise ValueError(f"{unknown[0]!r} says nothing about a form: {did_you_mean(unknown[0], cls.FORM)}")
        kind = object.__new__(cls)
        kind.__dict__ |= cls._usual_form() | given
        return kind

    @classmethod
    def _usual_form(cls):
        parameters = inspect.signature(cls).parameters
        return {name: parameters[name].default for name in cls.FORM}

    @property
    def keyless(self) -> Kind:
        """What of this kind says how an answer looks: the same without its key.

        >>> from exercisebook.kinds import Number
        >>> Number(2.5, "kg/m", "the density").keyless.expected
        'a number, in kg/m'
        """
        return self.without_key(**{name: getattr(self, name) for name in self.FORM})

    @property
    def asking(self) -> str:
        """The call, as code, that makes a kind of this form without the key; nothing in it comes from the key.

        >>> from exercisebook.kinds import Number
        >>> Number(2.5, "kg/m", "the density").asking
        'number("kg/m")'
        """
        usual = self._usual_form()
        said = {name: getattr(self, name) for name in self.FORM if getattr(self, name) != usual[name]}
        named = [f"{name}={literal(value)}" if name != self.FORM[0] else literal(value) for name, value in said.items()]
        return f"{self.maker}({', '.join(named)})"

    @property
    def making(self) -> str:
        """The call, as code, that makes this kind with its key; empty where no code says it.

        >>> from exercisebook.kinds import Number
        >>> Number(2.5, "s", "the period").making
        'number(2.5, unit="s", what="the period")'
        """
        _, *others = inspect.signature(type(self)).parameters.values()
        said = {one.name: self._argument(one.name) for one in others}
        named = [f"{one.name}={literal(said[one.name])}" for one in others if said[one.name] != one.default]
        return f"{self.maker}({', '.join([self.as_code(), *named])})"

    def _argument(self, name):
        """What the constructor was given under a name."""
        return getattr(self, name)

    def as_code(self, answer: Any = None) -> str:
        """Return an answer, as it was read, or the key as code that a reader can type, and that reads back the same.

        Raises ValueError for an answer that no code says.

        >>> from exercisebook.kinds import Poles
        >>> Poles([-1, -2 + 3j]).as_code()
        '[-1, (-2+3j)]'
        """
        return literal(self.key if answer is None else answer)

    def like(self, value: Any) -> Self:
        """The same quantity with another key, as a mistake has one."""
        other = object.__new__(type(self))
        other.__dict__ |= self.__dict__
        other.key = other.read(value)[0]
        return other

    def shuffled(self, text: str) -> Self:
        """Return the quantity with what it offers to choose from in an order drawn from a text; most offer nothing."""
        return self

    def draw_from(self, seed: str) -> None:
        """Draw what is drawn for comparing an answer, as the points of a formula, from a text."""
        self.seed = seed

    @property
    def asked(self) -> str:
        """The quantity with its unit, as in a sentence."""
        return f"{self.what}, in {self.unit}" if self.unit else self.what

    def written(self, answer: Any) -> str:
        """An answer, as it was read, as a text for people."""
        return str(answer)

    @property
    def solution(self) -> str:
        """The key as a text for people."""
        return self.written(self.key)

    @property
    def shown(self) -> Any:
        """The key as texts of an author show it: a text, an expression, or a pair of a number and its unit."""
        return self.solution

    def picture(self, answer: Any) -> Any:
        """Return a figure of what an answer, as it was read, does; None where there is nothing to draw."""
        return None

    @property
    def accuracy(self) -> str:
        """How near an answer must be, in words; empty where that is no question."""
        return "exact" if self.within == 0 else f"{100 * self.within:g}\N{NO-BREAK SPACE}%"

    @property
    def precision(self) -> str:
        """How an answer is compared, in words that tell nothing of the key; empty where that is no question.

        >>> from exercisebook.kinds import Number, Numbers
        >>> Number(120, "s").precision, Numbers([1, 2]).precision, Number(3, within=0).precision
        ('to 1\xa0%', 'each number to 1\xa0%', 'exact')
        """
        if not self.accuracy:
            return ""
        return self.ANY_FORM + ("exact" if self.within == 0 else f"{self.EACH}to {self.accuracy}")

    def read(self, given: object) -> tuple[Any, str]:
        """Return the answer as it is compared, and a remark on how it was understood, which may be empty.

        Reading looks at the form alone, never at the key. Raises Unreadable in a sentence.
        """
        raise NotImplementedError

    def as_read(self, answer: Any) -> str:
        """Return how an answer was read, for one that is not right; empty where it looks as it was given."""
        return ""

    def agrees(self, answer: Any) -> bool:
        """Whether an answer, as it was read, is right."""
        raise NotImplementedError

    def incomparable(self, answer: Any) -> tuple[str, str]:
        """Return why an answer that was read cannot be right whatever the key is.

        That is a sentence for its author, and one on why an instructor should see it; both are empty for most answers.
        """
        return "", ""

    def mistakes(self) -> Iterable[tuple[str, Any]]:
        """The mistakes that can be recognised in every exercise: pairs of a sentence and a wrong value, as read."""
        return ()

    def hint(self, answer: Any) -> str:
        """Return a sentence on a wrong answer that nothing else explains; it may be empty."""
        return ""

    def is_value(self, answer: Any, wrong: Any) -> bool:
        """Whether an answer, as it was read, is the value of a mistake."""
        return self.like(wrong).agrees(answer)

    def off_by(self, answer: Any, wrong: Any) -> float:
        """How far an answer is from the value of a mistake, where two are near; of most kinds nothing tells."""
        return 0.0

    def may_agree(self, answer: Any) -> bool:
        """Whether an answer may agree, by a look that is quicker than to compare it; most kinds are quick anyway."""
        return True

    def in_other_units(self, answer: Any) -> Iterable[tuple[str, Any]]:
        """What an answer would be if it had been given in another unit: pairs of the unit and the value."""
        return ()

    @property
    def field(self) -> dict[str, Any]:
        """How a field of a form looks, as arguments of `forms.fields.Field`, with texts in Markdown.

        Nothing in it comes from the key. A kind that says nothing else is typed in lines, below what is expected.
        """
        return {"control": LINES, "asked": self.asked, "unit": "", "help": f"Expected: {self.expected}."}

    def right_forms(self) -> Iterator[Tried]:
        """Yield the key in forms in which students write it, each with its words, the plainest first."""
        yield AS_IT_IS, ast.literal_eval(self.as_code())

    @property
    def as_given(self) -> Any:
        """The key as a student would give it."""
        return next(iter(self.right_forms()))[1]

    def wrong_forms(self) -> Iterator[Tried]:
        """Yield answers that are not the key, each with its words."""
        yield from ()


def literal(value: object) -> str:
    """Return plain data as code: a text, a number, a truth value, lists, arrays and dictionaries of them.

    >>> literal(("up", "down")), literal({"m": 2.0, "v": 0.1}), literal(True)
    ('["up", "down"]', '{"m": 2, "v": 0.1}', 'True')
    """
    match value:
        case np.ndarray() | np.generic():
            return literal(value.tolist())
        case list() | tuple():
            return f"[{', '.join(map(literal, value))}]"
        case dict():
            return f"{{{', '.join(f'{literal(name)}: {literal(one)}' for name, one in value.items())}}}"
        case str():
            return json.dumps(value, ensure_ascii=False)
        case complex(imag=0):
            return literal(value.real)
        case float() if value.is_integer() and abs(value) < EXACT:
            return repr(int(value))
    return repr(value)


def rounded(x: float, within: float = 0.01) -> float:
    """Return a number as a careful student rounds it: to three digits, where the tolerance allows it.

    >>> rounded(12.3456), rounded(12.3456, within=0.001)
    (12.3, 12.3456)
    """
    return float(f"{x:.{DIGITS if within >= ROUGHEST else MANY_DIGITS}g}")


def how_rounded(within: float) -> str:
    """Return how `rounded` rounds, in words."""
    return "rounded to three digits" if within >= ROUGHEST else "with eight digits"


def with_unit(text: str, unit: str) -> str:
    """Return a text with a unit behind it."""
    return f"{text}\N{NO-BREAK SPACE}{unit}" if unit else text
