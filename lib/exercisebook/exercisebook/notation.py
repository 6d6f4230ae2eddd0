"""Formulas as people write them, in Python's notation: products without a sign, LaTeX, decimal commas.

What can be read in two ways that differ is not guessed: a sentence asks for brackets. A fraction is followed by a
product only where everybody reads it alike, as in ``2/(10s + 1) e^(-3s)``.
"""

from __future__ import annotations

import re
import unicodedata
from collections.abc import Collection, Iterator
from dataclasses import dataclass

#: Names of steps, which are functions where the symbol is the time.
STEPS = ("Heaviside", "heaviside", "step", "unitstep", "u", "H", "sigma", "theta", "1")
#: Functions by other names.
OTHER_NAMES = {"Sqrt": "sqrt", "root": "sqrt", "Exp": "exp", "Ln": "ln", "Log": "log", "Sin": "sin", "Cos": "cos"}
#: Letters that stand for the same in different books, {one: the other} in both directions, as `bare` writes them.
SAME_LETTERS: dict[str, str] = {}
LONGEST_NAME, MOST_READINGS = 40, 500

_LATEX_WORDS = {
    "cdot": "*", "times": "*", "div": "/", "left": "", "right": "", "quad": " ", "qquad": " ", "infty": "oo",
    "pm": "±", "degree": "°", "circ": "°", "big": "", "Big": "", "bigl": "", "bigr": "", "displaystyle": "",
    "mathrm": "", "mathit": "", "text": "", "operatorname": "", "rm": "", "le": "<=", "leq": "<=", "ge": ">=",
    "geq": ">=", "vartheta": "theta", "varepsilon": "epsilon", "varphi": "phi", "dfrac": "frac", "tfrac": "frac",
}  # fmt: skip
_TOKEN = re.compile(
    r"(?P<space>\s*)(?:(?P<number>(?:\d+\.?\d*|\.\d+)(?:[eE][+-]?\d+)?)|(?P<name>[^\W\d]\w*)"
    r"|(?P<sign>\*\*|<=|>=|[-+*/<>&|,()]))"
)


class Ambiguous(ValueError):  # noqa: N818 - it is what the text is
    """A text with several readings, or none; the sentence says which.

    Arguments:
        several: whether there are several.
        name: that is not known.
    """

    def __init__(self, says: str, several: bool = False, name: str = ""):
        super().__init__(says)
        self.several, self.name = several, name


def from_latex(text: str) -> str:
    """Return LaTeX, as it is pasted, in plain signs; other text as it is.

    >>> from_latex(r"\\frac{2}{10 s + 1} e^{-3 s}"), from_latex("G{\\\\left(s \\\\right)}"), from_latex("K_{p}")
    ('((2)/(10 s + 1)) e^(-3 s)', 'G(s )', 'K_p')
    """
    if not re.search(r"[\\{]", text):
        return text
    if re.search(r"\\sqrt\s*\[", text):
        raise Ambiguous("a root other than the square root is a power: x^(1/3)")
    text = re.sub(r"\\[,;:! ]|~|\\\\|\$", " ", text)
    text = re.sub(r"\\([A-Za-z]+)", lambda word: _latex_word(word[1]), text)
    text = re.sub(r"_\{\s*(\w+)\s*\}", r"_\1", text)
    text = re.sub(r"\{\s*(\(\s*\w+\s*\))\s*\}", r"\1", text)  # the argument that SymPy prints
    while "\\frac" in text:  # the innermost ones have no fraction within
        head, _, rest = text.rpartition("\\frac")
        above, rest = _group(rest)
        below, rest = _group(rest)
        text = f"{head}(({above})/({below})){rest}"
    return text.replace("{", "(").replace("}", ")")


def _latex_word(word):
    word = _LATEX_WORDS.get(word, word)
    return "\\frac" if word == "frac" else f" {word}" if word.isalpha() else word


def _group(text):
    """What stands in the first braces, or the first sign, and what follows."""
    text = text.lstrip()
    if not text.startswith("{"):
        return text[:1], text[1:]
    depth = 0
    for k, sign in enumerate(text):
        depth += (sign == "{") - (sign == "}")
        if depth == 0:
            return text[1:k], text[k + 1 :]
    raise Ambiguous("a brace is not closed")


def decimal_points(text: str) -> str:
    """Return a text with points for decimal commas, and without separators of thousands, where both are clear.

    A single comma is a decimal one. Raises Ambiguous for "1,500", which few write with zeros at the end.

    >>> decimal_points("2,5*exp(-0,3*t)"), decimal_points("1.234,5"), decimal_points("12,000,000")
    ('2.5*exp(-0.3*t)', '1234.5', '12000000')
    >>> decimal_points("1,364 K/%")
    '1.364 K/%'
    """
    text = re.sub(r"(?<![\d.,])\d{1,3}(?:,\d{3})+(?=\.\d)", lambda found: found[0].replace(",", ""), text)
    text = re.sub(r"(?<![\d.,])\d{1,3}(?:,\d{3}){2,}(?![\d,])", lambda found: found[0].replace(",", ""), text)
    text = re.sub(r"(?<![\d.,])\d{1,3}(?:\.\d{3})+,(?=\d)", lambda found: found[0].replace(".", ""), text)
    text = re.sub(r"(?<![\d.,])\d{1,3}(?:\.\d{3}){2,}(?![\d.])", lambda found: found[0].replace(".", ""), text)
    commas = re.findall(r"(?<![\d.,])(\d+),(\d+)(?![\d,])", text)
    if not commas:
        return text
    doubtful = [
        pair for pair in commas if re.fullmatch("[0-9]00", pair[1]) and len(pair[0]) <= 3 and pair[0].strip("0")
    ]
    if len(doubtful) == len(commas):
        (whole, part), *_ = doubtful
        raise Ambiguous(
            f"{whole},{part} may be {whole}.{part} or {whole}{part}: write the decimal comma as a point", several=True
        )
    return re.sub(r"(?<![\d.,])(\d+),(\d+)(?![\d,])", r"\1.\2", text)


@dataclass
class _Part:
    """A part of a formula in Python's notation, and what it is: number, name, product, group, call or e."""

    text: str
    kind: str

    @property
    def whole(self):
        """The part as one factor."""
        return f"({self.text})" if self.kind == "product" else self.text


def in_python(
    text: str, symbols: Collection[str] | None, functions: Collection[str], constants: Collection[str]
) -> str:
    """Return a formula with a sign for every product, and with the asked symbols as they are asked.

    Arguments:
        text: in plain signs, with ``**`` for powers.
        symbols: that may occur; None where any may.
        functions, constants: names that are known.
    Raises:
        Ambiguous: for what has no reading, or several.

    >>> in_python("2e**(-3s)/(Ts + 1)", ["T", "s"], ["exp"], ["e"])
    '2*e**(-3*s)/(T*s + 1)'
    """
    return _Reader(text, symbols, functions, constants).read()


class _Reader:
    def __init__(self, text, symbols, functions, constants):
        self.symbols, self.functions = symbols, set(functions)
        self.constants = set(constants) - set(symbols or ())
        self.source, self.at, self.tokens = text, 0, []
        place = 0
        while place < len(text.rstrip()):
            found = _TOKEN.match(text, place)
            if not found:
                raise Ambiguous(f"{text[place:].strip()[:1]!r} cannot be read")
            place = found.end()
            self._add(found.lastgroup, found[found.lastgroup], bool(found["space"]))
        self.tokens.append(("end", "", True))

    def _add(self, kind, text, space):
        """One token, or several where a name ends in e, or in a function."""
        before = self.tokens[-1] if self.tokens else ("end", "", True)
        if kind == "name" and before[0] == "number" and not space and text in {"i", "j", "I"} & self.constants:
            self.tokens[-1] = ("number", before[1] + "j", before[2])
            return
        if kind == "sign" and text in ("(", "**") and before[0] == "name" and not space:
            for end in sorted((*self.functions, "e"), key=len, reverse=True):
                start = before[1].removesuffix(end)
                known = before[1] in self.functions or self._readings(before[1])
                if (
                    start
                    and start != before[1]
                    and not known
                    and (end != "e" or text == "**")
                    and self._readings(start)
                ):
                    self.tokens[-1:] = [("name", start, before[2]), ("name", end, False)]
                    break
        self.tokens.append((kind, text, space))

    # The grammar: a list of conditions, each of sums, each of terms.

    def read(self):
        text = self._list()
        if self._kind != "end":
            raise Ambiguous(f"{self.source[:40]!r} has a bracket too many, or a comma")
        return text

    @property
    def _kind(self):
        return self.tokens[self.at][0]

    @property
    def _text(self):
        return self.tokens[self.at][1]

    @property
    def _space(self):
        """Whether a space is before the token."""
        return self.tokens[self.at][2]

    def _take(self, *signs):
        """The sign that stands here, if it is one of these, and on to the next token."""
        if self._kind == "sign" and self._text in signs:
            self.at += 1
            return self.tokens[self.at - 1][1]
        return None

    def _list(self):
        parts = [self._condition()]
        while self._take(","):
            parts.append(self._condition())
        return ", ".join(parts)

    def _condition(self):
        text = self._comparison()
        while sign := self._take("&", "|"):
            text += f" {sign} {self._comparison()}"
        return text

    def _comparison(self):
        text = self._sum()
        while sign := self._take("<", ">", "<=", ">="):
            text += f" {sign} {self._sum()}"
        return text

    def _sum(self):
        text = self._term()
        while sign := self._take("+", "-"):
            text += f" {sign} {self._term()}"
        return text

    def _term(self):
        part = self._factor()
        text, below, fraction = part.text, None, False
        first = part
        while True:
            if sign := self._take("*"):
                part, below = self._factor(), None
                text += f"*{part.text}"
            elif sign := self._take("/"):
                fraction = first is part and part.kind == "number"
                part = below = self._factor()
                text += f"{sign}{part.whole}"
            elif self._kind in ("number", "name") or self._text == "(":
                self._check_product(text, part, below, fraction)
                part, below = self._factor(), None
                text += f"*{part.text}"
            else:
                return _Part(text, "product").text
            first = None

    def _check_product(self, text, part, below, fraction):
        """Raise Ambiguous where a product without its sign does not go without saying."""
        if self._kind == "number":
            if self._text == "1" and self._is_step(self.at + 1):
                return
            if self._space and self.tokens[self.at - 1][1] == ")" and below is None:
                return
            raise Ambiguous(f"between {text[-20:]!r} and {self._text!r} a sign is missing")
        if part.kind == "number" and "e" in part.text.lower() and not self._space:
            raise Ambiguous(
                f"{part.text}{self._text} may be a number or a power of e: expected a * in it", several=True
            )
        if below is None:
            return
        power_of_e = self._text == "e" and "e" in self.constants and self.tokens[self.at + 1][1] == "**"
        is_call = self._text in self.functions
        if (power_of_e or is_call) and (self._space or part.kind in ("group", "call")):
            return
        if self._space and (self._text == "(" or (fraction and part.kind == "number")):
            return
        after = "(...)" if self._text == "(" else self._text
        bottom = part.text if len(part.text) < 20 else "(...)"
        raise Ambiguous(f".../{bottom}{' ' if self._space else ''}{after} may be .../({bottom}*{after}) "
                        f"or (.../{bottom})*{after}: set brackets, or a *", several=True)  # fmt: skip

    def _factor(self):
        if sign := self._take("+", "-"):
            part = self._factor()
            return _Part(f"-{part.text}" if sign == "-" else part.text, part.kind)
        *others, base = self._atom()
        if self._take("**"):
            base = _Part(f"{base.text}**{self._exponent(base)}", "power")
        if not others:
            return base
        return _Part("*".join(part.text for part in (*others, base)), "product")

    def _exponent(self, base):
        sign = "-" if self._take("+", "-") == "-" else ""
        *others, part = self._atom()
        if self._take("**"):
            part = _Part(f"{part.text}**{self._exponent(part)}", "power")
        run = [one.text for one in (*others, part)]
        of_e = base.kind == "e"
        if part.kind in ("number", "name") and not of_e:
            if others:
                raise Ambiguous(f"the exponent {'*'.join(run)} needs brackets", several=True)
        elif of_e and part.kind in ("number", "name", "power"):
            while self._kind == "name" and not self._space and self._text not in self.functions:
                run += [one.text for one in self._atom()]
            if len(run) > 1 or sign:
                follows = self._text == "(" or self._kind in ("name", "number")
                if follows or (self._text == "/" and self.tokens[self.at + 1][1] != "("):
                    raise Ambiguous(f"the exponent of e needs brackets: e^({sign}{'*'.join(run)}...)", several=True)
        text = "*".join(run)
        return f"({sign}{text})" if sign or len(run) > 1 else text

    def _atom(self):
        """The parts of a number, a group, a call or a name; several where the name is a product of symbols."""
        kind, text, _ = self.tokens[self.at]
        self.at += 1
        if kind == "sign" and text == "(":
            inside = self._list()
            if not self._take(")"):
                raise Ambiguous("a bracket is not closed")
            return [_Part(f"({inside})", "group")]
        if kind == "number" and not (text == "1" and self._is_step()):
            if len(text) > 1 and text[0] == "0" and text.isdigit():
                raise Ambiguous(f"{text!r} is no number")
            return [_Part(text, "number")]
        if kind not in ("name", "number"):
            raise Ambiguous("a bracket is not closed" if kind == "end" else f"before {text!r} something is missing")
        return self._named(text)

    def _is_step(self, at=None):
        """Whether a bracket with the time follows: u(t - 3) is a step."""
        at = self.at if at is None else at
        bracket, *inside = self.tokens[at : at + 3]
        opens = bracket[1] == "(" and not bracket[2] and len(inside) == 2
        return opens and "t" in (self.symbols or ()) and inside[0][1] == "t" and inside[1][1] in (")", "-", "+")

    def _named(self, name):
        opens = self._kind == "sign" and self._text == "("
        is_symbol = self.symbols is not None and name in self.symbols
        if not is_symbol and name in STEPS and self._is_step():
            return [self._call("Heaviside")]
        function = OTHER_NAMES.get(name, name)
        if not is_symbol and function in ("Min", "Max", "min", "max", "Piecewise") and not opens:
            raise Ambiguous(f"{function} needs brackets: {function}(...)", several=True)
        if not is_symbol and function in self.functions:
            return [self._call(function) if opens else self._applied(function)]
        parts = self._symbols_of(name)
        last = parts[-1]
        if opens and last.kind == "name":
            inside = self.tokens[self.at + 1 : self.at + 3]
            variable = [one[1] for one in inside] in (["t", ")"], ["s", ")"])
            if variable and self.symbols is not None and inside[0][1] not in self.symbols:
                self.at += 3  # a signal is a symbol here, and so is its transform
            elif variable and not self.symbols:
                self.at += 3
            elif variable:
                raise Ambiguous(
                    f"{name}({inside[0][1]}) may be a product or a function: write {name}*{inside[0][1]}", several=True
                )
        if opens and last.kind == "e":
            raise Ambiguous("a power of e has a ^: write e^(...) or exp(...)", several=True)
        return parts

    def _call(self, function):
        self.at += 1
        inside = self._list()
        if not self._take(")"):
            raise Ambiguous("a bracket is not closed")
        return _Part(f"{function}({inside})", "call")

    def _applied(self, function):
        """A function without brackets: sin 3t, ln 2, sin^2(x)."""
        power = ""
        if self._take("**"):
            opened = self._take("(")
            power = self._text
            if self._kind != "number" or power not in list("23456789"):
                raise Ambiguous(f"{function}^... may be a power or the inverse function: set brackets", several=True)
            self.at += 1
            if opened:
                self._take(")")
        if power and self._text == "(":
            part = self._call(function)
            return _Part(f"{part.text}**{power}", "power")
        sign = "-" if self._take("-") else ""
        if self._kind not in ("number", "name"):
            raise Ambiguous(f"{function} needs brackets: {function}(...)", several=True)
        is_number, root = self._kind == "number", function == "sqrt"
        run = self._power()
        while not root and self._kind == "name" and self._text not in self.functions and (not self._space or is_number):
            is_number = False
            run += self._power()
        if root and not self._space and self._kind in ("number", "name"):
            raise Ambiguous("a root of a product needs brackets: sqrt(...)", several=True)
        another = self._kind == "name" and self._text in self.functions
        ends = another or self._text not in (("**", "(") if root else ("/", "*", "**", "("))
        if not ends or (self._kind in ("number", "name") and not another):
            raise Ambiguous(f"{function} needs brackets: {function}(...)", several=True)
        text = f"{function}({sign}{'*'.join(one.text for one in run)})"
        return _Part(f"{text}**{power}" if power else text, "power" if power else "call")

    def _power(self):
        *others, part = self._atom()
        if self._take("**"):
            part = _Part(f"{part.text}**{self._exponent(part)}", "power")
        return [*others, part]

    # Names.

    def _symbols_of(self, name):
        """The parts that a name stands for: a symbol, a constant, or a product of them."""
        if self.symbols is None:
            return [_Part(name, "e" if name in ("e", "E") else "name")]
        if name in self.symbols:
            return [_Part(name, "name")]
        if name in self.constants:
            return [_Part(name, "e" if name in ("e", "E") else "name")]
        readings = self._readings(name)
        if not readings:
            raise Ambiguous(f"{name!r} is not known", name=name)
        if len(readings) > 1:
            several = " or ".join("*".join(one) for one in readings[:2])
            raise Ambiguous(f"{name!r} may be {several}: set a * or a space", several=True)
        return [_Part(one, "name") for one in readings[0]]

    def _readings(self, name):
        """The products of symbols that a name may stand for, each once: [["T", "s"]] for Ts."""
        if self.symbols is None:
            return [[name]]
        if name in self.symbols or name in self.constants:
            return [[name]]
        if len(name) > LONGEST_NAME:
            return []
        spelled = {}
        for symbol in (*self.symbols, *({"pi"} & self.constants)):
            for form in {symbol, symbol.replace("_", "")} | ({bare(symbol)} if len(symbol) > 1 else set()):
                spelled.setdefault(form, set()).add(symbol)
        alone = {one for form in {name, name.replace("_", "")} for one in spelled.get(form, ())}
        if not alone and len(name) > 1:
            same = {bare(name), SAME_LETTERS.get(bare(name))}
            alone = {symbol for symbol in self.symbols if len(symbol) > 1 and bare(symbol) in same}
        found = {(one,): [one] for one in sorted(alone)}
        steps = iter(range(MOST_READINGS))
        for parts in _split(name, {form: sorted(ones) for form, ones in spelled.items()}, steps):
            found.setdefault(tuple(sorted(parts)), parts)
            if len(found) > 2:
                break
        return list(found.values())


def _split(name: str, spelled: dict[str, list[str]], steps: Iterator[int]) -> Iterator[list[str]]:
    """The ways in which a name is a row of symbols; of so many steps."""
    if next(steps, None) is None:
        return
    if not name:
        yield []
    for form, symbols in spelled.items():
        # a digit belongs to the letter before it
        if name.startswith(form) and not name[len(form) :][:1].isdigit() and not name[len(form) :].startswith("_"):
            for rest in _split(name[len(form) :], spelled, steps):
                for symbol in symbols:
                    yield [symbol, *rest]


def bare(name: str) -> str:
    """A name without case and underscores, and with Greek letters spelled out.

    >>> bare("τ_1"), bare("T_SP")
    ('tau1', 'tsp')
    """
    letters = (
        unicodedata.name(letter, letter).split()[-1] if "Ͱ" <= letter <= "Ͽ" else letter
        for letter in unicodedata.normalize("NFKC", name)
    )
    return "".join(letters).replace("_", "").replace(" ", "").casefold()
