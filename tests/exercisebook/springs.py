"""Springs, which are given whole, as Coil(2, 0.5), or in parts, by their stiffness k and their length l."""

import re
from dataclasses import asdict, dataclass
from unittest import mock

import sympy

from exercisebook.grammar import Unreadable
from exercisebook.kinds.kind import MAKERS, PARTS, Kind
from exercisebook.wholes import WHOLES, Whole


@dataclass(frozen=True)
class Coil:
    k: float
    l: float

    @property
    def expr(self):
        """The force at a length x."""
        return self.k * (sympy.Symbol("x") - self.l)


class Springs(Whole):
    called, parts = "spring", ("k", "l")

    def part(self, name):
        return {"k": "k", "stiffness": "k", "l": "l", "length": "l"}.get(name, "")

    def parts_of(self, given):
        if isinstance(given, str) and (found := re.fullmatch(r"Coil\((\S+), (\S+)\)|k = (\S+), l = (\S+)", given)):
            return dict(zip(self.parts, filter(None, found.groups()), strict=True)), ""
        if isinstance(given, dict) and {*given} - {*self.parts}:
            raise Unreadable("this is no spring: expected k and l")
        return (asdict(given) if isinstance(given, Coil) else given if isinstance(given, dict) else None), ""

    def is_one(self, given):
        return isinstance(given, Coil) or (isinstance(given, str) and given.startswith("Coil"))

    def of_data(self, data):
        return Coil(**data) if data.keys() == {*self.parts} else None


SPRINGS = Springs()
WHOLES.remove(SPRINGS)  # other tests know no springs
with mock.patch.dict(MAKERS):

    class Spring(Kind):
        expected = "a spring"
        whole = SPRINGS
        making = ""  # nobody else knows springs

        @property
        def field(self):
            return {"control": PARTS, "parts": (("k", "stiffness", "N/m"), ("l", "length", "m"))}

        def read(self, given):
            parts, _ = SPRINGS.parts_of(given)
            if not parts:
                raise Unreadable(f"this is no spring: expected {self.expected}")
            return Coil(**{name: float(parts[name]) for name in SPRINGS.parts}), ""

        def agrees(self, answer):
            return answer == self.key
