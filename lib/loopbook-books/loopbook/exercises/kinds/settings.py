"""Settings of a PID controller."""

from __future__ import annotations

import ast
import itertools
import math
import re
from collections.abc import Callable, Iterator
from fractions import Fraction
from typing import Any

import sympy

from exercisebook import grammar, units
from exercisebook.asked_names import also_called
from exercisebook.formulas import Formula
from exercisebook.grammar import Unreadable, bare, listed, shortened
from exercisebook.kinds.kind import AS_IT_IS, PARTS, Kind, Tried, how_rounded, literal, rounded, with_unit
from exercisebook.kinds.numeric import in_digits, near, one_number
from exercisebook.reading import alone, answered, in_a_row, listed_in
from exercisebook.wholes import Whole
from loopbook.pid import PID
from plainmath.expressions import exact, parse, s
from plainmath.validation import one_of

NAMES = ("Kp", "Ti", "Td", "Tf")
_USUAL = {"Ti": sympy.oo, "Td": 0, "Tf": 0}  # what need not be said


also_called(
    "k kp kc gain",
    "kp kc kprop proportionalgain controllergain",
    "ti taui integraltime resettime",
    "td taud derivativetime",
    "tau theta delay deadtime timedelay",
    "tau t tau1 t1 lag timeconstant",
    "tc tauc lambda",
    "ku kcu kcr ultimategain",
    "pu tu pcr ultimateperiod period p",
    "omega w frequency crossover",
    "zeta xi damping dampingratio",
    "gainmargin gm",
    "phasemargin pm",
    "delaymargin dm",
    "pole poles p",
    "zero zeros z",
    "settings controller pid pi c",
    "h g m tf transferfunction",
)
grammar.SAME_LETTERS |= {"kc": "kp", "kp": "kc"}


class Settings(Kind):
    """The settings of a controller; a `PID` knows its form, numbers alone are in the form that is asked.

    Arguments:
        key: `PID` with numbers.
        gain, time: units of Kp and of the times.
        form: "parallel", "serial", or "any" where both are right.

    >>> asked = Settings(PID(2.5, Ti=10, Td=1.6), form="any")
    >>> asked.agrees(asked.read(PID(2, Ti=8, Td=2, form="serial"))[0])
    True
    """

    FORM = ("gain", "time", "form")
    EACH = "each number "
    is_personal = True

    def __init__(
        self,
        key: PID,
        gain: str = "",
        time: str = "s",
        what: str = "the settings",
        form: str = "any",
        within: float = 0.01,
    ):
        one_of("form", form, ("any", "parallel", "serial"))
        if not (units.is_unit(gain) and units.is_unit(time)):
            raise ValueError(f"the units are {gain!r} and {time!r}: expected such as '%/K' and 's'")
        self.gain, self.time, self.form = gain, time, form
        super().__init__(key, "", what, within)

    @property
    def asked(self) -> str:
        """The settings with their units and form."""
        gain = f"Kp in {self.gain}, " if self.gain else ""
        form = "" if self.form == "any" else f", in {self.form} form"
        return f"{self.what}: {gain}times in {self.time}{form}"

    @property
    def expected(self) -> str:
        """A controller."""
        return f"a controller such as PID(1, Ti=10), or its numbers as [1, 10], with times in {self.time}"

    def read(self, given: object) -> tuple[PID, str]:
        """Return a `PID` of exact numbers; from a PID, a dictionary of its settings, a list Kp, Ti, Td, Tf, or a text.

        A dictionary may say the form too, {"Kp": 2, "Ti": 8, "Td": 2, "form": "serial"}, and use the names of other
        books. The gains Ki and Kd of a controller whose terms are added become times. A transfer function with numbers,
        2*(1 + 1/(10*s)), is recognised as well.
        """
        if controller := _of_transfer_function(answered(given)):
            controller = self._in_asked_form(controller)
            return controller, f"read as {self.written(controller)}"
        if isinstance(given, set | frozenset | sympy.FiniteSet) and len(given) > 1:
            raise Unreadable(f"a set has no order: expected {self.expected}")
        parts, remark = parts_of(given)
        if parts is None or "Kp" not in parts:
            raise Unreadable(_doubt(given) or f"this is no controller: expected {self.expected}")
        if unknown := _unknown(parts):
            raise Unreadable(f"{unknown} is not a setting: expected {self.expected}")
        form, parts = parts.get("form", self._understood), _USUAL | parts
        remarks, numbers = {remark}, {}
        for name in NAMES:
            value = alone(parts[name])
            if name == "Ti" and _is_infinite(value):
                numbers[name] = sympy.oo
                continue
            value, said = one_number(value, self.gain if name == "Kp" else self.time, f"a number for {name}")
            if value.imag:
                raise Unreadable(f"{name} is a complex number: expected {self.expected}")
            numbers[name] = value.real
            remarks.add(said)
        times = _times(parts, numbers["Kp"], self.expected)
        from_gains = [f"{name} = {in_digits(value)} from the gain K{name[1]}" for name, value in times.items()]
        try:
            controller = PID(**numbers | times, form=form)
        except ValueError as error:
            raise Unreadable(str(error)) from None
        as_read = [f"read as {self.written(controller)}"] if any(remarks) and not from_gains else []
        return controller, ", ".join((*as_read, *from_gains))

    def _in_asked_form(self, pid):
        """A controller in the parallel form as it is asked for, where a formula does not say a form."""
        try:
            return pid.serial() if self.form == "serial" else pid
        except ValueError:
            return pid

    def as_code(self, answer: PID | None = None) -> str:
        """The settings in a dictionary, with the form where it is not understood."""
        pid = self.key if answer is None else answer
        form = {} if pid.form == self._understood else {"form": pid.form}
        return literal({name: float(value) for name, value in _said(pid).items()} | form)

    def written(self, answer: PID) -> str:
        """The settings with their units, and the form where there are two."""
        parts = [
            f"{name} = {with_unit(in_digits(value), self.gain if name == 'Kp' else self.time)}"
            for name, value in _said(answer).items()
        ]
        return ", ".join(parts) + ("" if answer.Td == answer.Tf == 0 else f", {answer.form} form")

    def agrees(self, answer: PID) -> bool:
        """Whether all settings agree, in the asked form or, where both are right, after conversion."""
        if self.form != "any":
            return answer.form == self._asked_form(answer) and self._near(answer, self.key)
        return self._same_controller(answer)

    def is_value(self, answer: PID, wrong: Any) -> bool:
        """Whether an answer is the controller of a mistake; where one form is asked, in the form of the mistake."""
        other = self.like(wrong)
        if self.form == "any":
            return other._same_controller(answer)
        return answer.form == other.key.form and self._near(answer, other.key)

    def in_other_units(self, answer: PID) -> Iterator[tuple[str, PID]]:
        """The controller if its times had been given in another unit."""
        for unit in units.neighbours(self.time):
            factor = units.convert(1, unit, to=self.time)
            yield unit, PID(answer.Kp, factor * answer.Ti, factor * answer.Td, factor * answer.Tf, answer.form)

    @property
    def _understood(self):
        """The form of settings that do not say it."""
        return "serial" if self.form == "serial" else "parallel"

    def _asked_form(self, answer):
        # without a derivative term, both forms are one
        return answer.form if answer.Td == answer.Tf == 0 else self.form

    def _same_controller(self, answer):
        answer = self.in_form_of_key(answer)
        return answer is not None and self._near(answer, self.key)

    def _near(self, answer, key):
        return all(self._parts_near(answer, key).values())

    def _parts_near(self, answer, key):
        return {name: _near(getattr(answer, name), getattr(key, name), self.within) for name in NAMES}

    def mistakes(self) -> Iterator[tuple[str, PID]]:
        """Sign of the gain, the forms exchanged, other units, Kp/Ti for Ti, a proportional band for a gain."""
        key = self.key
        numbers = {name: getattr(key, name) for name in NAMES}

        def changed(**values):
            try:
                return PID(**(numbers | values), form=key.form)
            except ValueError:  # a serial form may be none
                return None

        wrong = [("the sign of Kp is wrong", changed(Kp=-key.Kp)), ("Kp is inverted", changed(Kp=1 / key.Kp))]
        wrong.append(("that is the proportional band, 100 % divided by Kp", changed(Kp=100 / key.Kp)))
        if key.Td != 0:
            other = other_form(key)
            if other:
                swapped = {name: getattr(other, name) for name in NAMES}
                wrong.append((f"those are the numbers of the {other.form} form", PID(**swapped, form=key.form)))
                if self.form != "any":
                    wrong.append((f"the controller is right, but the question asks for its {self.form} form", other))
            if key.Ti not in (key.Td, sympy.oo):
                wrong.append(("Ti and Td are exchanged", changed(Ti=key.Td, Td=key.Ti)))
        if key.Ti != sympy.oo:
            wrong.append(("instead of Ti there is the integral gain Kp/Ti", changed(Ti=abs(key.Kp / key.Ti))))
            wrong.append(("instead of Ti there is its inverse", changed(Ti=1 / key.Ti)))
        for unit, converted in units.neighbours(self.time).items():
            times = {n: v if v == sympy.oo else converted(v) for n, v in numbers.items() if n != "Kp"}
            wrong.append((f"the times are those in {unit}; asked are times in {self.time}", changed(**times)))
        yield from ((sentence, value) for sentence, value in wrong if value is not None)

    def in_form_of_key(self, answer: PID) -> PID | None:
        """The controller in the form of the key; None where it has no such form."""
        if answer.form == self.key.form:
            return answer
        try:
            return answer.serial() if self.key.form == "serial" else answer.parallel()
        except ValueError:
            return None

    def parts_near(self, answer: PID) -> dict[str, bool]:
        """Which of the settings of a controller in the form of the key are right."""
        return self._parts_near(answer, self.key)

    @property
    def field(self) -> dict[str, Any]:
        """A line for each setting."""
        form = {"any": "", "parallel": ", in parallel form", "serial": ", in serial form"}[self.form]
        parts = [("Kp", "gain", self.gain), ("Ti", "integral time", self.time)]
        parts += [("Td", "derivative time", self.time), ("Tf", "filter time", self.time)]
        # where both forms are right, an answer must be able to say which one it has
        more = {"forms": ("parallel", "serial")} if self.form == "any" else {}
        asked = {"asked": self.what + form, "help": "Leave empty what the controller does not have."}
        return {"control": PARTS, "parts": tuple(parts), "more": more} | asked

    def right_forms(self) -> Iterator[Tried]:
        """The settings rounded, as a `PID` and as a text."""
        yield AS_IT_IS, ast.literal_eval(self.as_code())
        short = _with_each(self.key, lambda name, x: rounded(x, self.within))
        yield how_rounded(self.within), short
        yield "as a PID of SymPy's numbers", self.key
        said = [(name, getattr(short, name)) for name in NAMES if _is_said(short, name)]
        form = "" if short.Td == short.Tf == 0 else f" ({short.form})"
        yield "as text", ", ".join(f"{name} = {float(value)!r}" for name, value in said) + form

    def wrong_forms(self) -> Iterator[Tried]:
        """Other gains."""
        for how, factor in (("with the other sign", -1), ("ten times the gain", 10), ("a tenth of the gain", 0.1)):
            yield how, _with_each(self.key, lambda name, x, by=factor: by * x if name == "Kp" else x)


class Controller(Whole):
    """A controller, and its settings one by one."""

    called, parts = "pid", NAMES

    def part(self, name: str) -> str:
        """As `setting`."""
        return setting(name)

    def parts_of(self, given: object) -> tuple[dict[str, Any] | None, str]:
        """As the function of this name."""
        return parts_of(given)

    def is_one(self, given: object) -> bool:
        """Whether it is a `PID`, or a text that begins like one."""
        return isinstance(given, PID) or (isinstance(given, str) and given.lstrip(" ").startswith("PI"))

    def as_data(self, value: object) -> dict[str, Any] | None:
        """The settings and the form of a controller with numbers."""
        if not isinstance(value, PID) or any(getattr(value, name).free_symbols for name in NAMES):
            return None
        return {name: getattr(value, name) for name in NAMES} | {"form": value.form}

    def of_data(self, data: dict[str, Any]) -> PID | None:
        """The controller of settings with a form."""
        return Settings.without_key().read(data)[0] if {"Kp", "form"} <= data.keys() else None

    def in_words(self, data: dict[str, Any], written: Callable[[Any], str]) -> str | None:
        """The settings that a controller uses, and its form where there are two.

        >>> Settings.whole.in_words({"Kp": "30303/5000", "Ti": 12, "Td": 0, "Tf": 0, "form": "parallel"}, str)
        'Kp = 6.0606, Ti = 12'
        """
        if not {"Kp", "form"} <= data.keys() <= {"form", *NAMES}:
            return None
        usual = {"Ti": "inf", "Td": 0, "Tf": 0}
        used = [name for name in NAMES if data.get(name, usual.get(name)) != usual.get(name)]
        form = f", {data['form']} form" if {"Td", "Tf"} & {*used} else ""
        return ", ".join(f"{name} = {_in_decimals(data[name]) or written(data[name])}" for name in used) + form


Settings.whole = Controller()

#: Settings in a text have so many characters.
LONGEST = 300
#: The settings by the names of other books, without case and underscores.
_OTHER_NAMES = {
    "kp": "Kp", "kc": "Kp", "k": "Kp", "gain": "Kp", "p": "Kp", "ti": "Ti", "taui": "Ti", "td": "Td", "taud": "Td",
    "tf": "Tf", "tauf": "Tf", "form": "form", "ki": "Ki", "kd": "Kd", "integraltime": "Ti", "derivativetime": "Td",
    "proportionalgain": "Kp", "controllergain": "Kp", "integralgain": "Ki", "derivativegain": "Kd", "resettime": "Ti",
    "kr": "Kp", "tn": "Ti", "tv": "Td",
}  # fmt: skip
_CONTROLLER = r"(?:(?:an?|the) )?(?:PID?|PD|P|controller|settings)(?:[ -](?:controller|settings))?"
_CALL = re.compile(rf"(?:{_CONTROLLER})? ?\((.*)\)", re.IGNORECASE | re.DOTALL)
#: The kind of controller before its settings: "PI with", "a PI controller:".
_LEAD = re.compile(
    rf"{_CONTROLLER}(?: ?:| with(?: the)?(?: settings)?:?|,)? (?=[^\W\d][^=:]*(?:[=:≈]| is | of ))", re.IGNORECASE
)
_FORM = re.compile(r"[,;]? ?\(?(?:in )?(?:the )?(serial|series|cascade|parallel|ideal)(?: form)?\)?$", re.IGNORECASE)
#: A name before a number, without a sign between them: "gain 2".
_NAME_ALONE = re.compile(
    r"(?<!\w)(K_?[pc]|T_?[id]|tau_?[id]|(?:(?:proportional|controller) )?gain|(?:integral|derivative|reset) time)"
    r" (?=[-+]?[\d.])",
    re.IGNORECASE,
)
_PAIR = re.compile(
    r"(?P<name>[^\W\d]\w*(?:_?\{\w+\})?(?: (?:gain|time))?) ?(?:=|:|≈| is | of )\s*(?P<value>.*?)"
    r"(?=\s*(?:[;\n]|,(?!\d)|,? and\b|\Z|[,\s/]\s*[^\W\d]\w*(?: (?:gain|time))?\s*(?:=|:|≈| is | of )))"
)


def parts_of(given: object) -> tuple[dict[str, Any] | None, str]:
    """Return the settings in an answer as they were given, {"Kp": 2, "Ti": "10 s"}, and a remark on other names.

    None where there is no row of two to four settings, no dictionary of them, no `PID`, and no text that says them.

    >>> parts_of("PI with K_c = 2 and tau_I = 10 s")
    ({'Kp': '2', 'Ti': '10 s'}, 'read K_c as Kp and tau_I as Ti')
    """
    if isinstance(given, PID):
        return {name: getattr(given, name) for name in NAMES} | {"form": given.form}, ""
    given = _of_text(given) if isinstance(given, str) else alone(given)
    if not isinstance(given, dict):
        row = listed_in(given) if isinstance(given, str) else in_a_row(given)
        if row is None or not 2 <= len(row) <= len(NAMES):
            return None, ""
        given = dict(zip(NAMES, row, strict=False))
    return _by_our_names(given)


def setting(name: str) -> str:
    """Return which setting a name stands for, here or in other books; empty for another name.

    >>> setting("K_c"), setting("tauI"), setting("omega")
    ('Kp', 'Ti', '')
    """
    return _OTHER_NAMES.get(bare(name).replace("{", "").replace("}", ""), "")


def _of_text(text):
    """The settings in a text such as "PI(2, Ti=10 s)" or "Kc = 2; tau_I = 10"; the text where it is a list of numbers.

    Nothing is left of a text that says more, so that no name in it is left out unseen.
    """
    if len(text) > LONGEST:
        return None
    text = " ".join(re.sub(r"^\{|\}$|\$|\\[,;!: ]|\\(?=[A-Za-z]\w*\s*=)", " ", text.strip()).split()).rstrip(".")
    text = re.sub(r"^(?:in )?(?:the )?(serial|series|cascade|parallel|ideal)(?: form)? ?[:,] ?(.*)$", r"\2 (\1)", text)
    form = _FORM.search(text)
    text = _FORM.sub("", text)
    call = _CALL.fullmatch(text)
    inside = call[1] if call else _LEAD.sub("", _NAME_ALONE.sub(r"\1 = ", text), count=1)
    inside = inside.replace("'", "").replace('"', "")
    named = {}
    for pair in _PAIR.finditer(inside):
        if pair["name"] in named:
            return None
        named[pair["name"]] = pair["value"]
    first = inside[: pair.start()] if (pair := _PAIR.search(inside)) else inside
    left = _PAIR.sub("", inside[len(first) :])
    if not re.fullmatch(r"(?:[\s,;/]|and)*", left):
        return None
    first = first.strip(" ,;")
    if call and re.fullmatch(r"[^\s,]+(?:,[^\s,]+)+", first):  # as in Python, where no comma is a decimal one
        first = first.replace(",", ", ")
    alone = [part for part in listed_in(first) if part] if first else []
    if not named and not call and not form and not re.search("[=:]", text):
        return text
    positional = dict(zip(NAMES, alone, strict=False))
    if (alone and not (call or (form and not named))) or len(alone) > len(NAMES) or positional.keys() & named.keys():
        return None
    said = {"form": "parallel" if form[1].lower() in ("parallel", "ideal") else "serial"} if form else {}
    return positional | named | said


def _by_our_names(given):
    """A dictionary under the names Kp, Ti, Td, Tf, Ki, Kd and form, and a remark where it was under others."""
    found, others = {}, []
    for name, value in given.items():
        ours = setting(str(name)) or str(name)
        if ours in found:
            raise Unreadable(f"there are two values for {ours}: expected one")
        found[ours] = value
        if ours != str(name) and ours in NAMES:
            others.append(f"{shortened(str(name), 20)} as {ours}")
    return found, f"read {listed(others)}" if others else ""


#: As much of one as a number can be of it: not of 0, and of no length without end.
_FRACTION = re.compile(r"-?[0-9]{1,300}/[1-9][0-9]{0,6}")
#: A formula of a controller has so many parts at most.
_MOST_PARTS = 200


def _of_transfer_function(given):
    """The settings, in parallel form, of a transfer function with numbers; None where it is no PID controller.

    Without common factors it is (c0 + c1 s + c2 s²)/(s (1 + Tf s)).
    """
    if isinstance(given, PID | dict) or in_a_row(given) is not None:
        return None
    try:
        formula = Formula(given, "s")
        parts = list(itertools.islice(ast.walk(formula.tree), _MOST_PARTS + 1))
        is_simple = len(parts) <= _MOST_PARTS and any(isinstance(part, ast.Name) and part.id == "s" for part in parts)
        if not is_simple:  # a number alone tells no controller
            return None
        above, below = (sympy.Poly(part, s) for part in sympy.fraction(sympy.cancel(parse(formula.text))))
    except (ValueError, sympy.PolynomialError):
        return None
    if below.eval(0):
        above, below = above * s, below * s
    if max(above.degree(), below.degree()) > 2 or not below.coeff_monomial(s):
        return None
    terms = [above.coeff_monomial(s**k) for k in range(3)] + [below.coeff_monomial(s**2)]
    try:
        return _with_terms(*(float(term / below.coeff_monomial(s)) for term in terms))
    except TypeError:  # a complex number
        return None


def _doubt(given):
    """What is asked about a formula in s that has several readings; empty for anything else."""
    try:
        Formula(given, "s")
    except Unreadable as doubt:
        return str(doubt) if isinstance(given, str) and re.search("may be|needs? brackets", str(doubt)) else ""
    return ""


def _with_terms(c0, c1, c2, Tf):
    Kp = c1 - c0 * Tf
    try:
        return PID(_rounded(Kp), _rounded(Kp / c0) if c0 else sympy.oo, _rounded(c2 / Kp - Tf), _rounded(Tf))
    except (ValueError, ArithmeticError):  # a negative time, or no gain
        return None


def _rounded(value):
    return float(f"{value:.8g}")


def _in_decimals(value):
    """A fraction in a text as a decimal number; empty for anything else."""
    is_fraction = isinstance(value, str) and _FRACTION.fullmatch(value)
    return f"{float(Fraction(value)):.8g}" if is_fraction else ""


def _unknown(given):
    """A name that is no setting; empty where there is none."""
    known = {*NAMES, "form", *(gain for gain, time in (("Ki", "Ti"), ("Kd", "Td")) if time not in given)}
    return min((str(name) for name in given if name not in known), default="")


def _times(parts, gain, expected):
    """The times that belong to the gains Ki and Kd, {"Ti": Kp/Ki, "Td": Kd/Kp}."""
    found = {}
    for name, time in (("Ki", "Ti"), ("Kd", "Td")):
        if name in parts:
            value = one_number(parts[name], "", f"a number for {name}")[0].real
            if not (gain and (value or name == "Kd")):
                raise Unreadable(f"from {name} follows no {time}: expected {expected}")
            found[time] = exact(gain / value if name == "Ki" else value / gain)
    return found


def _is_infinite(value):
    if isinstance(value, str):
        return value.strip().casefold() in ("inf", "oo", "∞", "infinity", "infinite", "np.inf", "math.inf", "sympy.oo")
    return value in (math.inf, sympy.oo)


def _is_said(pid, name):
    return name == "Kp" or getattr(pid, name) not in (0, sympy.oo)


def _with_each(pid, change):
    """A controller whose settings, of those that it has, are changed by a function of their names and values."""
    changed = {
        name: change(name, float(getattr(pid, name))) if _is_said(pid, name) else getattr(pid, name) for name in NAMES
    }
    return PID(**changed, form=pid.form)


def _said(pid):
    """The settings of a controller that are not what they are by themselves, {name: value}."""
    return {name: value for name in NAMES if (value := getattr(pid, name)) != _USUAL.get(name)}


def _near(value, key, within):
    if sympy.oo in (value, key):
        return value == key
    return near(float(value), float(key), within if key else 1e-9)


def other_form(key: PID) -> PID | None:
    """A controller in its other form; None where it has no such form."""
    try:
        return key.parallel() if key.form == "serial" else key.serial()
    except ValueError:
        return None
