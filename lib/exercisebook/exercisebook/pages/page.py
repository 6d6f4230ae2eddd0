"""Exercises as pages of text: what is given, the formulas of its physics, what is asked, and mistakes as changes.

The author's guide has pages to copy. A page has Python in a file of the same name only for pictures and for
what no formula says: formulas call its functions by name, and `picture` and `solution_picture` draw.
"""

from __future__ import annotations

import ast
import contextlib
import functools
import importlib.util
import inspect
import re
from collections.abc import Callable, Iterator, Mapping
from pathlib import Path
from typing import Any

import numpy as np
import sympy

from exercisebook.authoring import Exercise
from exercisebook.kinds import MAKERS, Kind, Number, Numbers, Poles
from exercisebook.pages import conversion, formula, parts
from exercisebook.pages.graph import Graph
from exercisebook.pages.parts import Front, PageError, PageText
from exercisebook.parameters import Parameter, Value, between, call, choice
from exercisebook.units import is_unit
from plainmath.validation import did_you_mean

_RANGE = re.compile(r"(\S+) *(?:…|\.\.\.) *(\S+?)(?: +by +(\S+))?")
#: One space before brackets with a unit, where there should be two.
_ONE_SPACE = re.compile(r"\S \[([^\]]*)\]$")
_FORMULA = re.compile(r"(\w+(?:, *\w+)*) *=(?!=) *(.+?)(?:  +\[(.*)\])?")
_CODE, _KIND = re.compile(r"`([^`]+)`[ ,:\n]*"), re.compile(r"[ ,:\n]*`([^`]+)`\.?$")
#: A name in braces that are LaTeX's: of an argument, an index or an exponent.
_LATEX = re.compile(r"(?:[_^]|\\(?:[dt]?frac(?:\{[^{}]*\})?|sqrt|text|math[a-z]+|operatorname|dot|bar|hat)) ?\{(\w+)\}")
#: Names in braces that are no argument of LaTeX's; a letter alone may be set apart by braces.
_ANY_PLACE = re.compile(r"(?<![\\\w}_^{])\{([A-Za-z]\w+)\}(?!\})")
_PLACE, _GIVEN = re.compile(r"(?<!\{)\{(\w+)\}(?!\})"), re.compile(r"\.given\(([^()]*)\)")
#: Two ways to a value agree, and a change is none, within this fraction.
SAME = 1e-6


class Page(Exercise):
    """An exercise that is written as a page.

    Arguments:
        page: its text by its parts.
        functions: those of the Python beside it, by name.
    Raises:
        PageError: for what cannot be read.

    Attributes:
        graph: of its givens and formulas.
        units: {name of a quantity: its unit as it is shown}.
        changes: its mistakes, pairs of a sentence and {name of a quantity: formula for what it is by mistake}.
    """

    def __init__(self, page: PageText, functions: Mapping[str, Callable[..., Any]]):
        self.page, self.functions = page, functions
        parameters = dict(_givens(page))
        words = {name for name, one in parameters.items() if any(isinstance(value, str) for value in one.values)}
        self.units = {name: one.unit for name, one in parameters.items()}
        self._units = {name: None if name in words else conversion.unit_of(unit) for name, unit in self.units.items()}
        self.graph = Graph(list(parameters), {}, functions)
        self._conditions = self._read_formulas()
        self._asked = dict(self._read_asked())
        key = _naming(self._key, parameters)
        key.__doc__ = page.statement.text
        insight = " ".join(page.section("Insight").text.split())
        super().__init__(page.number, page.title, page.points, lambda: True, key, insight)
        self.changes = list(self._read_mistakes())
        for part in (page.statement, *map(page.section, ("Mistakes", "Hints", "Solution", "Insight"))):
            self._look_at_places(part)
        for of in (self._at_once, self._carried):
            self.mistakes += [
                (sentence, _naming(functools.partial(of, place), parameters))
                for place, (sentence, _) in enumerate(self.changes)
            ]
        self.hints(*(" ".join(text.split()) for _, text in page.section("Hints").items()))
        drawing = [functions[name] for name in ("picture", "solution_picture") if name in functions]
        texts = [page.statement.text, self.insight, *self.rungs, *(sentence for sentence, _ in self.changes)]
        texts += [inspect.getdoc(function) or "" for function in drawing]
        self.shown = _naming(functools.partial(self._shown, "\n".join(texts)), parameters)
        if solution := page.section("Solution").text:
            self.worked = _naming(functools.partial(self._shown, solution), parameters, solution)
        for attribute, name in (("drawn", "picture"), ("drawn_in_solution", "solution_picture")):
            if name in functions:
                draw = functools.partial(self._drawing, functions[name])
                setattr(self, attribute, _naming(draw, parameters, inspect.getdoc(functions[name])))

    # ---- reading

    @contextlib.contextmanager
    def _at(self, line, last=0):
        """Say file and line of what cannot be read, and that indented lines below belong to it."""
        try:
            yield
        except ValueError as error:
            says = f"{error} (with line {last}, which is indented)" if last > line else str(error)
            raise PageError(self.page.file, line, says) from error

    def _read(self, text, also=None):
        """A formula of the quantities that are known so far, whose functions are those of the page or others."""
        known = [*self.graph.givens, *self.graph.formulas, *getattr(self, "_asked", ())]
        return formula.read(text, dict.fromkeys(known), self.functions if also is None else also)

    def _read_formulas(self):
        """Read the formulas into the graph; return the conditions, each with the number of formulas above it."""
        conditions = []
        for line, text, last in self.page.section("Formulas").lines():
            with self._at(line, last):
                if text.startswith("where "):
                    conditions.append((len(self.graph.formulas), self._read(text.removeprefix("where "))))
                else:
                    self._add(text)
        return conditions

    def _with_units(self, one, to=None):
        """A formula with the factors that its units need, in a unit if one is said, and its unit."""
        tree, own = conversion.converted(one.tree, self._units)
        if to is None:
            return one.with_tree(tree), own
        if own is not None and not isinstance(one.tree, ast.Constant):
            tree = conversion.times(tree, conversion.factor(own, to))  # a number alone is one in the unit
        return one.with_tree(tree), conversion.unit_of(to)

    def _add(self, text):
        found = _FORMULA.fullmatch(text)
        if not found:
            raise ValueError(f"{text!r} is no formula: expected one such as 'v = way/t  [m/s]', or 'where v > 0'")
        if (unit := _ONE_SPACE.search(text)) and unit[1] and is_unit(unit[1]):
            raise ValueError(f"{text!r} has one space before the unit: expected two")
        names = [name.strip() for name in found[1].split(",")]
        one, unit = self._with_units(self._read(found[2]), found[3])
        for place, name in enumerate(names):
            if name in self.graph.givens or name in self.graph.formulas:
                raise ValueError(f"{name} is there already: expected another name for this quantity")
            part = one.tree if len(names) == 1 else ast.Subscript(one.tree, ast.Constant(place))
            self.graph.formulas[name] = one.with_tree(part)
            self._units[name], self.units[name] = unit, found[3] or ""

    def _read_asked(self):
        if "Asked" not in self.page.sections:
            raise PageError(self.page.file, self.page.line, f"exercise {self.page.number} has no section Asked")
        for line, text in self.page.section("Asked").items():
            with self._at(line):
                name = _CODE.match(text)
                if not name:
                    raise ValueError(f"{text!r} names no quantity: expected one such as '`v` the speed of the car'")
                words = text[name.end() :]
                kind = _KIND.search(words)
                spelled = kind[1] if kind else "number()"
                one = self._read(f"{spelled}()" if spelled.isidentifier() else spelled, {**MAKERS, **self.functions})
                if not (isinstance(one.tree, ast.Call) and one.tree.func.id in {*MAKERS, *self.functions}):
                    raise ValueError(f"{one.text} is no kind of answers: {did_you_mean(one.text, MAKERS)}")
                if one.tree.func.id in MAKERS and name[1] not in self.units:
                    raise ValueError(f"{name[1]} has no formula: {did_you_mean(name[1], self.units)}")
                yield name[1], (one, " ".join((words[: kind.start()] if kind else words).split()))

    def _read_mistakes(self):
        for line, text in self.page.section("Mistakes").items():
            with self._at(line):
                code = _CODE.match(text)
                if not code or not text[code.end() :]:
                    raise ValueError(
                        f"{text!r} is no mistake: expected a change and a sentence, as '`c = 4` That is ...'"
                    )
                yield " ".join(text[code.end() :].split()), dict(map(self._read_change, code[1].split(";")))

    def _read_change(self, text):
        """A change of a mistake: with the numbers as they are, whatever their units."""
        found = _FORMULA.fullmatch(text.strip())
        known = dict.fromkeys([*self.graph.givens, *self.graph.formulas, *self._asked])
        name = found[1] if found else text.strip()
        if name not in known:
            raise ValueError(f"{name!r} is no quantity of this page: {did_you_mean(name, known)}")
        return name, self._read(found[2])

    def _look_at_places(self, part):
        """Refuse names in braces that are no quantity, or LaTeX's, and a formula without an end."""
        known = [*self.units, *(name for name in self._asked if name not in self.units)]
        if part.source.count("$") % 2:
            raise PageError(part.file, part.line, "a $ in this section has no other one")
        for place, line in enumerate(part.source.splitlines()):
            with self._at(part.line + place):
                for found in _LATEX.finditer(line):
                    if (name := found[1]) in known:
                        says = f"write {{{{{name}}}}} for the letter, or {{ {{{name}}} }} for its value"
                        raise ValueError(f"{found[0]}: {says}")
                for found in _ANY_PLACE.finditer(line):
                    if (name := found[1]) not in known:
                        raise ValueError(f"{found[0]}: there is no {name!r}: {did_you_mean(name, known)}")

    # ---- what follows for some values of the givens

    def quantities(self, values: Mapping[str, Value]) -> dict[str, Any]:
        """Return the values of all quantities for those of the givens."""
        return self._quantities(tuple(values.items()))

    @functools.lru_cache(maxsize=8)  # noqa: B019 - the exercises live as long as the program
    def _quantities(self, givens):
        return self.graph.values(dict(givens))

    def not_drawn(self, values: Mapping[str, Value]) -> str:
        """Return the condition that does not hold, or the mistake that would be right; empty for a variant."""
        found, formulas, done = dict(values), list(self.graph.formulas.items()), 0
        for above, condition in self._conditions:  # each before the formulas below it are worked out
            for name, one in formulas[done:above] if condition.names & {*self.graph.formulas} else ():
                found[name] = one(found, self.functions)
                done = above
            if not condition(found, self.functions):
                return f"'where {condition.text}' does not hold"
        for (_, changes), wrong in zip(self.changes, self._wrong(tuple(values.items())), strict=True):
            if wrong is None:
                made = "; ".join(f"{name} = {one.text}" for name, one in changes.items())
                return f"the mistake '{made}' would be right"
        return ""

    def _key(self, **values):
        quantities = self.quantities(values)
        return {name: self._kind(name, *asked, quantities) for name, asked in self._asked.items()}

    @functools.lru_cache(maxsize=8)  # noqa: B019 - the exercises live as long as the program
    def _key_of(self, givens):
        return self._key(**dict(givens))

    def sources(self, name: str) -> frozenset[str]:
        """Return the names of all quantities on which one depends."""
        return self.graph.sources(name)

    def following(self, values: Mapping[str, Value], changes: Mapping[str, Any], name: str) -> Kind | None:
        """Return the key of an asked quantity as it follows from changes of givens and other answers, by the formulas.

        Arguments:
            values: of the givens.
            changes: {name of a quantity: value}.
            name: of the asked quantity.
        """
        changed = self.graph.changed(self.quantities(values), changes, self._wanted([name]))
        return self._kind(name, *self._asked[name], changed)

    def _kind(self, name, one, words, quantities) -> Kind:
        """What is asked under a name, with its key."""
        maker = one.tree.func.id
        if maker in self.functions:
            return one(quantities, self.functions)
        signature = inspect.signature(MAKERS[maker])
        said = {part.arg for part in one.tree.keywords} | {"unit"} - {*signature.parameters}
        usual = {"what": words or name} | ({} if "unit" in said else {"unit": self.units[name]})
        if "until" in said and "time" in signature.parameters:
            usual["time"] = self._time_of(next(part.value for part in one.tree.keywords if part.arg == "until"))

        def make(*parts, **named):
            named = usual | {word: _plain(value) for word, value in named.items()}
            try:
                return MAKERS[maker](quantities[name], *map(_plain, parts), **named)
            except TypeError:
                raise ValueError(f"expected arguments such as {signature}") from None

        return one(quantities, {**self.functions, maker: make})

    def _time_of(self, tree):
        """The unit of time of a formula, as it stands; empty where it has none, as a number alone."""
        unit = conversion.converted(tree, self._units)[1]
        return next((time for time in ("s", "min", "h", "d") if unit == conversion.unit_of(time)), "")

    @functools.lru_cache(maxsize=8)  # noqa: B019 - the exercises live as long as the program
    def _wrong(self, givens):
        """For each mistake what is asked and is another value by it: {name: value}, or None where it is as good."""
        return [self._mistaken(changes, dict(givens)) for _, changes in self.changes]

    def _wanted(self, asked, changes=()):
        """The quantities that make what is asked under some names, also with formulas for changes of it."""
        formulas = [*(self._asked[name][0] for name in asked), *changes]
        return {*asked}.union(*(one.names for one in formulas))

    def _mistaken(self, changes, values):
        right, key = self.quantities(values), self._key_of(tuple(values.items()))
        of_graph = {name: one for name, one in changes.items() if name in right}
        found = self.graph.changed(right, of_graph, self._wanted(self._asked, changes.values()))
        for name, one in changes.items():
            if name not in right:  # a function of the page makes its key
                found[name] = one(found, self.functions)
        other = {name: found.get(name) for name in key if not _is_unchanged(found.get(name), right.get(name))}
        as_good = {name: _is_as_good(key[name], value) for name, value in other.items()}
        wrong = {name: value for name, value in other.items() if as_good[name] is False}
        numbers = [name for name in other if isinstance(key[name], Number | Numbers | Poles)]
        return None if not wrong and any(as_good[name] for name in numbers) else wrong

    def _at_once(self, place, /, **values):
        """What is wrong where the mistake is made: what it changes of all that is asked, or else all that follows."""
        changes, found = self.changes[place][1], self._wrong(tuple(values.items()))[place] or {}
        return {name: value for name, value in found.items() if name in changes or not {*changes} & {*self._asked}}

    def _carried(self, place, /, **values):
        """What follows from a mistake in what is asked, which is told after the mistakes of that quantity itself."""
        changes, found = self.changes[place][1], self._wrong(tuple(values.items()))[place] or {}
        return {name: value for name, value in found.items() if name not in changes and {*changes} & {*self._asked}}

    def _shown(self, text, **values):
        """The quantities that a text shows, each with its unit, and the data that it says are given."""
        given = {name for names in _GIVEN.findall(text) for name in re.findall(r"\w+", names)}
        names = ({*_PLACE.findall(text)} | given) & {*self.graph.formulas}
        found = {name: value for name, value in self.quantities(values).items() if name in names} if names else {}
        return {
            name: (value, self.units[name]) if self.units[name] and formula.is_number(value) else value
            for name, value in found.items()
            if not (name in self._asked and isinstance(value, list))  # which its kind shows
        }

    def _drawing(self, draw, **values):
        return call(draw, self.quantities(values))

    def second_ways(self, values: Mapping[str, Value]) -> Iterator[tuple[str, bool, str]]:
        """Yield what the section Check says, each with whether it holds for some values of the givens, and its sides.

        ``K = ...`` is another way to K; ``a == b``, to one part in a million, and other conditions hold as they are.
        """
        right = self.quantities(values)
        for line, text, last in self.page.section("Check").lines():
            with self._at(line, last):
                found = _FORMULA.fullmatch(text)
                if found and found[1] in right:
                    one = self._with_units(self._read(found[2]), self.units[found[1]] or None)[0]
                    value = one(right, self.functions)
                    yield text, are_same(value, right[found[1]]), f"{_short(right[found[1]])}, not {_short(value)}"
                    continue
                one = self._with_units(self._read(text))[0]
                match one.tree:
                    case ast.Compare(left, [ast.Eq()], [other]):
                        sides = [one.with_tree(side)(right, self.functions) for side in (left, other)]
                        yield text, are_same(*sides), " and ".join(map(_short, sides))
                    case _:
                        yield text, bool(one(right, self.functions)), ""


def are_same(one: Any, other: Any) -> bool:
    """Return whether two values of a quantity are the same, numbers to one part in a million.

    >>> are_same(sympy.Rational(1, 3), 0.33333334), are_same("up", "down"), are_same([1, 2], [1, 2.0000001])
    (True, False, True)
    """
    if isinstance(one, list) and isinstance(other, list):
        return len(one) == len(other) and all(map(are_same, one, other))
    if formula.is_number(one) and formula.is_number(other):
        one, other = complex(one), complex(other)
        return abs(one - other) <= SAME * abs(other)
    if isinstance(one, sympy.Expr) and isinstance(other, sympy.Expr):
        return bool(sympy.simplify(one - other) == 0)
    return bool(np.all(one == other))


def _is_unchanged(one, other):
    """Whether a change leaves a quantity as it is; of an expression only where it is written in the same way."""
    return one is None or (one == other if isinstance(one, sympy.Expr) and one.free_symbols else are_same(one, other))


def _is_as_good(kind, value):
    """Whether a value is within the accuracy of the key; None where it is no answer."""
    try:
        return kind.agrees(kind.like(value).key)
    except ValueError:
        return None


def _short(value):
    """A value as it is shown to an author."""
    return f"{float(value):.6g}" if formula.is_number(value) and not complex(value).imag else str(value)


def _plain(value):
    """A number as Python has it; anything else as it is."""
    if isinstance(value, sympy.Rational):
        return int(value) if value.is_Integer else float(value)
    return value


def _givens(page: PageText) -> Iterator[tuple[str, Parameter]]:
    """Read the table of the givens."""
    for line, cells in page.section("Given").rows():
        try:
            name, values, unit, reference = [*cells, "", ""][:4]
            if not name.isidentifier():
                raise ValueError(f"{name!r} is no name of a quantity: expected one such as 'T_1'")
            if found := _RANGE.fullmatch(values):
                low, high, step = (one and formula.number(one) for one in found.groups())
                example = formula.number(reference) if reference else None
                yield name, between(low, high, unit, reference=example, step=step)
            else:
                words = [formula.word(one.strip()) for one in values.split(",")]
                if len(words) < 2:
                    raise ValueError(f"{values!r} is no range: expected one as '50 … 400 by 10', or several values")
                yield name, choice(*words, unit=unit, reference=formula.word(reference) if reference else None)
        except ValueError as error:
            raise PageError(page.file, line, str(error)) from error


def _naming(
    function: Callable[..., Any], parameters: Mapping[str, Parameter], text: str | None = None
) -> Callable[..., Any]:
    """The same function, which says that its arguments are the givens of the page."""

    def named(**values):
        return function(**values)

    keyword = inspect.Parameter.KEYWORD_ONLY
    known = [inspect.Parameter(name, keyword, default=one) for name, one in parameters.items()]
    named.__signature__ = inspect.Signature(known)  # type: ignore[attr-defined]
    named.__doc__ = text
    return named


def read(file: Path) -> dict[str, Page]:
    """Return the exercises of a file: {number: `Page`}. Raises `PageError`."""
    return of(file.read_text(encoding="utf-8"), file.name, beside(file))[1]


def beside(file: Path) -> dict[str, Callable[..., Any]]:
    """Return the functions beside a page, which its formulas may call: of shared.py and of the Python with its name.

    Raises:
        PageError: where one has the name of a function of formulas or of a kind of answers.
    """
    return _functions_of(file.with_name("shared.py")) | _functions_of(file.with_suffix(".py"))


def _functions_of(code):
    return _functions_at(code, code.stat().st_mtime_ns) if code.exists() else {}


@functools.lru_cache(maxsize=64)  # all pages of a chapter share one file
def _functions_at(code, _changed):
    specification = importlib.util.spec_from_file_location(f"page_{code.stem}", code)
    assert specification
    assert specification.loader
    module = importlib.util.module_from_spec(specification)
    specification.loader.exec_module(module)
    found = {name: one for name, one in vars(module).items() if callable(one) and not name.startswith("_")}
    for name in found.keys() & {*MAKERS, *formula.FUNCTIONS, *formula.LIBRARY}:  # an import serves the Python alone
        if found.pop(name).__module__ == module.__name__:
            says = f"{name} is a function that all pages have: expected another name for this one"
            raise PageError(code.name, 1, says)
    return found


def of(
    source: str, file: str, functions: Mapping[str, Callable[..., Any]] | None = None
) -> tuple[Front | None, dict[str, Page]]:
    """Return the front of a text of pages, and the exercises in it: {number: `Page`}.

    Arguments:
        source: the text.
        file: its name, for errors.
        functions: those of the Python beside it.
    Raises:
        PageError: for what cannot be read, and for two pages of one number.
    """
    front, texts = parts.read(source, file)
    found: dict[str, Page] = {}
    for one in texts:
        if one.number in found:
            raise PageError(file, one.line, f"there are two exercises {one.number}: expected one")
        found[one.number] = Page(one, functions or {})
    return front, found
