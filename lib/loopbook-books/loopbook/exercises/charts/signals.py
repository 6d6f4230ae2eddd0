"""The signals of a chart as readers write them: their names, conditions in them, and actions on them."""

from __future__ import annotations

import re
from collections.abc import Collection, Iterable, Mapping
from dataclasses import dataclass, field

from exercisebook.grammar import Unreadable, shortened
from exercisebook.units import convert
from loopbook.sequence import Formula
from plainmath.validation import did_you_mean

#: So many seconds has a unit of time.
SECONDS = {"s": 1, "min": 60, "h": 3600}
_TIMES = {
    **dict.fromkeys(("s", "sec", "secs", "second", "seconds"), "s"),
    **dict.fromkeys(("min", "mins", "minute", "minutes"), "min"),
    **dict.fromkeys(("h", "hour", "hours"), "h"),
}
_OTHER_UNITS = {
    "K": "K",
    "C": "°C",
    "%": "%",
    "m": "m",
    "cm": "cm",
    "mm": "mm",
    "k": "K",
    "c": "°C",
    "degC": "°C",
    "degc": "°C",
    "celsius": "°C",
}

_ON = ("on", "open", "opened", "true", "yes", "1", "high", "started", "running", "pressed", "active")
_OFF = ("off", "close", "closed", "shut", "false", "no", "0", "low", "stopped", "released", "inactive")
#: Verbs before an output.
_BEGINS = ("open", "start", "activate", "set", "sound", "ring", "energise", "energize")
_ENDS = ("shut", "close", "stop", "deactivate", "reset", "silence", "mute", "not", "!")
#: Words for comparisons and connections, the longer ones first.
_WORDS = [
    (r"(is )?not (above|over|more than|greater than)", "<="),
    (r"(is )?not (below|under|less than)", ">="),
    (r"(is )?(greater|larger|higher|more) than or equal( to)?|(is )?at least|has reached|reaches", ">="),
    (r"(is )?(less|smaller|lower) than or equal( to)?|(is )?at most|falls to|has fallen to", "<="),
    (r"(is |rises |goes )?(above|over|greater than|larger than|higher than|more than)|exceeds", ">"),
    (r"(is |falls |goes )?(below|under|less than|smaller than|lower than)", "<"),
    (r"is equal to|equals", "="),
]
_SIGNS = str.maketrans({"≥": ">=", "≤": "<=", "≠": "<>", "∧": "&", "∨": "|", "¬": "!", "−": "-", "–": "-", "\xa0": " "})
_TOKEN = re.compile(
    rf"(?P<number>-?\d+(?:[.,]\d+)?)\s*(?:(?P<unit>%|°\s?[Cc]|º\s?C|℃|(?:{'|'.join((*_TIMES, *_OTHER_UNITS))}))(?!\w))?"
    r"|(?P<time>\w+(?=\s*\.\s*[TtXx]\b)\s*\.\s*[TtXx])\b"
    r"|(?P<compare>>=|<=|=>|=<|==|<>|!=|=|<|>)"
    r"|(?P<join>&&|&|\|\||\||!|[()])"
    r"|(?P<word>[^\W\d]\w*)"
    r"|(?P<odd>\S)"
)
_JOINS = {"&&": "AND", "&": "AND", "||": "OR", "|": "OR", "!": "NOT", "and": "AND", "or": "OR", "not": "NOT"}
_FILLING = {
    "the",
    "is",
    "has",
    "have",
    "been",
    "if",
    "when",
    "then",
    "once",
    "passed",
    "elapsed",
    "after",
    "wait",
    "for",
}
_NOTHING = ("", "-", "–", "none", "nothing", "no action", "no actions", "wait", "...", "/")


#: Times as people say them: "1 min 40 s", "the time in Hold".
_MINUTES_AND_SECONDS = re.compile(r"\b(\d{1,4}) ?min(?:utes?)?,? (?:and )?(\d{1,4}) ?s(?:ec(?:onds?)?)?\b")
_TIME_IN = re.compile(r"\b(?:the )?(?:time|timer|clock)(?: spent)? (?:in|of) (?:step )?(\w+)\b", re.IGNORECASE)


@dataclass(frozen=True)
class Signals:
    """The signals of a plant: what a chart reads and what it sets.

    Arguments:
        inputs: ``{name: unit}``; the unit of a truth value, such as a button, is empty.
        outputs: the names of what is on or off.
        also: ``{name: other names}`` under which readers may know a signal.
    """

    inputs: Mapping[str, str]
    outputs: Collection[str]
    also: Mapping[str, Iterable[str]] = field(default_factory=dict)

    @property
    def names(self) -> list[str]:
        """All names: what is read, and what is set."""
        return [*self.inputs, *self.outputs]

    def named(self, text: str, among: Collection[str] | None = None) -> str | None:
        """The signal that a text names, or None: capitals, blanks and the word valve make no difference.

        >>> tank = Signals({"T": "°C"}, ["inlet"], {"inlet": ["V1"]})
        >>> tank.named("Inlet valve"), tank.named("v1"), tank.named("t"), tank.named("pump")
        ('inlet', 'inlet', 'T', None)
        """
        among = self.names if among is None else among
        if text in among:
            return text
        known = {other: name for name in among for other in (name, *self.also.get(name, ()))}
        if text in known:
            return known[text]
        return {_bare(other): name for other, name in known.items()}.get(_bare(text))

    def _expected(self, name, among):
        return did_you_mean(name, [*among, *(other for one in among for other in self.also.get(one, ()))],
                            otherwise=f"expected one of {', '.join(among)}")  # fmt: skip

    # ------------------------------------------------------------------------------------------------- conditions

    def condition(self, text: str, step: str, steps: Mapping[str, str]) -> str:
        """Return a condition as `loopbook.sequence.Formula` reads it; raises Unreadable in a sentence.

        Arguments:
            text: as a reader writes it, "level ≥ 90 cm & not start", "120 s".
            step: the step that it leaves, whose time is meant by a time alone.
            steps: ``{name in small letters: name}``.

        >>> tank = Signals({"start": "", "level": "m"}, ["inlet"])
        >>> tank.condition("Level is above 90 cm or start pressed", "Fill", {})
        'level > 0.9 OR start'
        >>> tank.condition("after 2 min", "Hold", {})
        'Hold.T >= 120'
        """
        line = " ".join(text.translate(_SIGNS).strip(" .\"'").split())
        if line.casefold() in ("", "true", "1", "always", "else", "otherwise"):
            return "TRUE"
        if ":=" in line:
            raise Unreadable(":= assigns a value: expected a comparison, such as 'level >= 0.9'")
        line = _MINUTES_AND_SECONDS.sub(lambda time: f"{60 * int(time[1]) + int(time[2])} s", line)
        line = _TIME_IN.sub(lambda time: f"{time[1]}.T" if time[1].casefold() in steps else time[0], line)
        for pattern, sign in _WORDS:
            line = re.sub(rf"\b(?:{pattern})(?=\s|-?\d)", f" {sign} ", line, flags=re.IGNORECASE)
        tokens = self._known(list(_TOKEN.finditer(line)), step, steps)
        written = _tidy(" ".join(self._written(tokens, step)))
        try:
            formula = Formula(written, "the condition").condition()
        except ValueError as error:
            raise Unreadable(str(error)) from None
        return formula.text

    def _known(self, matches, step, steps):
        """The tokens, each as a pair of its kind and what it says."""
        tokens, n = [], 0
        while n < len(matches):
            match, kind = matches[n], matches[n].lastgroup
            text = match[0]
            if kind == "word":
                n, token = self._word(matches, n, tokens)
                tokens += [token] if token else []
                continue
            if kind in ("number", "unit"):
                tokens.append(("number", (float(match["number"].replace(",", ".")), match["unit"])))
            elif kind == "time":
                name, _, what = (part.strip() for part in text.partition("."))
                if name.casefold() not in steps:
                    raise Unreadable(f"{name} is not a step: {did_you_mean(name, steps.values())}")
                tokens.append(("time", f"{steps[name.casefold()]}.{what.upper()}"))
            elif kind == "compare":
                tokens.append(("compare", {"=>": ">=", "=<": "<=", "==": "=", "!=": "<>"}.get(text, text)))
            elif kind == "join":
                tokens.append(("join", _JOINS.get(text, text)))
            else:
                raise Unreadable(
                    f"{text!r} is no part of a condition: expected one such as 'level >= 0.9 and not stop'"
                )
            n += 1
        return tokens

    def _word(self, matches, n, tokens):
        """The token that begins with a word, which may take several of them, and where the next one begins."""
        words = []
        while n + len(words) < len(matches) and matches[n + len(words)].lastgroup == "word" and len(words) < 4:
            words.append(matches[n + len(words)][0])
        for count in range(len(words), 0, -1):
            text = " ".join(words[:count])
            if count == 1 and text in ("t", "timer", "time") and text not in self.names:
                return n + 1, ("clock", text)
            if name := self.named(text):
                return n + count, ("signal", name if text != "T" else f"{name}?")
        word = words[0].casefold()
        if word in _JOINS:
            return n + 1, ("join", _JOINS[word])
        if word == "timer":
            return n + 1, ("clock", word)
        if word in _FILLING:
            return n + 1, None
        if word in ("true", "false"):
            return n + 1, ("truth", word.upper())
        if tokens and tokens[-1][0] in ("signal", "compare") and word in (*_ON, *_OFF):
            return n + 1, ("state", word in _ON)
        raise Unreadable(f"{words[0]!r} is not a signal: {self._expected(words[0], self.names)}")

    def _written(self, tokens, step):
        """The condition in words of a formula, each value in the unit of the signal beside it."""
        out = []
        for n, (kind, what) in enumerate(tokens):
            before = tokens[n - 1] if n else ("", "")
            behind = tokens[n + 1] if n + 1 < len(tokens) else ("", "")
            if kind == "number":
                beside = tokens[n - 2] if before[0] == "compare" and n > 1 else None
                if beside is None and behind[0] == "compare" and n + 2 < len(tokens):
                    beside = tokens[n + 2]
                value, unit = what
                if beside is None:
                    if unit is None or unit.casefold() not in _TIMES:
                        raise Unreadable(f"{value:g} is compared with nothing: expected one such as 'level >= 0.9'")
                    out.append(f"{step}.T >= {value * SECONDS[_TIMES[unit.casefold()]]:g}")
                else:
                    out.append(self._amount(value, unit, beside))
            elif kind == "signal":
                out.append(self._meant(what, tokens, n, step))
            elif kind == "clock":
                # a time that is compared is that of the step; before a bare duration it says nothing
                out += [f"{step}.T"] if "compare" in (before[0], behind[0]) else []
            elif kind == "state":
                if before[0] == "compare":
                    out.append("TRUE" if what else "FALSE")
                elif not what:
                    out.insert(len(out) - 1, "NOT")
            else:
                out.append(what)
        return out

    def _meant(self, what, tokens, n, step):
        """A signal; but a T that is compared with seconds is the time of the step."""
        name = what.rstrip("?")
        is_compared = "compare" in {tokens[k][0] for k in (n - 1, n + 1) if 0 <= k < len(tokens)}
        if (unit := self.inputs.get(name, "")) and not is_compared:
            raise Unreadable(f"{name} is a number, in {unit}: expected a comparison, such as '{name} >= 0.5'")
        if name == what:
            return what
        beside = [tokens[k][1][1] for k in (n - 2, n + 2) if 0 <= k < len(tokens) and tokens[k][0] == "number"]
        if any(unit and unit.casefold() in _TIMES for unit in beside):
            return f"{step}.T"
        return name

    def _amount(self, value, unit, beside):
        """A number in the unit of the signal that it is compared with."""
        kind, what = beside
        if unit is None:
            return f"{value:.10g}"
        time = _TIMES.get(unit.casefold())
        name = what.rstrip("?") if kind == "signal" else ""
        if kind in ("time", "clock") or (what == f"{name}?" and time):
            if not time:
                raise Unreadable(f"{value:g} {unit} is compared with a time: expected it in s or min")
            return f"{value * SECONDS[time]:.10g}"
        unit = "°C" if unit[-1:].casefold() == "c" and len(unit) <= 3 else _OTHER_UNITS.get(unit.casefold(), unit)
        has = self.inputs.get(name, "")
        if unit == has:
            return f"{value:.10g}"
        try:
            if not has:
                raise ValueError(f"{name} has no unit")
            return f"{convert(value, time or unit, has):.10g}"
        except ValueError:
            wanted = f"which is in {has}" if has else "which is on or off"
            raise Unreadable(f"{value:g} {unit} is compared with {name or what}, {wanted}") from None

    # ---------------------------------------------------------------------------------------------------- actions

    def actions(self, text: str) -> dict[str, bool]:
        """Return the actions of a step, ``{output: whether it is on}``; raises Unreadable in a sentence.

        >>> tank = Signals({"level": "m"}, ["inlet", "heater"])
        >>> tank.actions("close the inlet valve, heater := TRUE"), tank.actions("all off")
        ({'inlet': False, 'heater': True}, {'inlet': False, 'heater': False})
        """
        line = " ".join(text.translate(_SIGNS).replace("\u2190", ":=").strip(" .\"'[]{}").split())
        if line.casefold() in _NOTHING:
            return {}
        if re.fullmatch(r"(all|everything)( outputs| valves)?( is| are)? (off|closed|false)", line.casefold()):
            return dict.fromkeys(self.outputs, False)
        found = {}
        for part in re.split(r",|;|&|\+|\band\b", line):
            if part.strip().casefold() not in _NOTHING:
                name, on = self._action(part.strip())
                if found.get(name, on) != on:
                    raise Unreadable(f"{name} is switched on and off in one step: expected one of the two")
                found[name] = on
        return found

    def _action(self, text):
        """One action: the output, and whether it is switched on."""
        plain = re.sub(r"\b(the|is|valve|P1)\b", " ", text, flags=re.IGNORECASE)
        plain = " ".join(re.sub(r":=|==|<-|=|:", " = ", plain).split())
        verbs = rf"{'|'.join((*_BEGINS, *_ENDS))}|[SR](?= )"
        patterns = (
            (r"(?:switch|turn|set|put) (?P<value>on|off) (?P<name>.+)", None),
            (r"(?:switch|turn|set|put) (?P<name>.+?)(?: to| =)? (?P<value>\S+)", None),
            (rf"(?P<value>{verbs}) ?(?P<name>.+)", None),
            (r"(?P<name>.+?) = ?(?P<value>\S+)(?: %)?", None),
            (r"(?P<name>.+) (?P<value>\S+)", None),
            (r"(?P<name>.+)", True),
        )
        for pattern, on in patterns:
            match = re.fullmatch(pattern, plain, flags=re.IGNORECASE)
            name = match and self.named(match["name"], self.outputs)
            if name:
                value = on if on is not None else _state(match["value"])
                if value is None:
                    raise Unreadable(f"{name} cannot be {match['value']!r}: expected on or off")
                return name, value
        if qualified := re.fullmatch(r"N (.+)", plain):
            raise Unreadable(
                f"{shortened(text, 40)!r} has the qualifier N; here values are stored: expected "
                f"'{self.named(qualified[1], self.outputs) or 'inlet'} on' where it begins and 'off' where it ends"
            )
        word = re.split(r" ?= ?| ", plain)[0]
        if (name := self.named(word)) in self.inputs:
            raise Unreadable(f"{name} is measured, an action cannot set it: {self._expected('', self.outputs)}")
        raise Unreadable(f"{shortened(text, 40)!r} is not an action: {self._expected(word, self.outputs)}, on or off")


def _state(word):
    word = word.casefold()
    if word in (*_ON, *_BEGINS, "s", "100"):
        return True
    return False if word in (*_OFF, *_ENDS, "r") else None


def _bare(text):
    """A name without what makes no difference."""
    words = re.sub(r"[\s_-]+", " ", text.casefold()).strip(" .:\"'`").removeprefix("the ")
    bare = words.replace(" valve", "").removesuffix(" button").replace(" ", "")
    return bare or words


def _tidy(text):
    """A formula with usual blanks."""
    return " ".join(text.replace("( ", "(").replace(" )", ")").split())
