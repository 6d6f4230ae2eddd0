"""Objects that lie about what they are, formulas that take forever, and texts with code."""

from hostile.attack import GOES_ON, attack

_LIES = "lying classes"
_FOREVER = "sympy forever"
_CODE = "answers with code"

ATTACKS = (
    attack(
        _LIES,
        "comparisons that agree with everything",
        """
class Agrees(float):
    def __eq__(self, other):
        return True

    __le__ = __ge__ = __lt__ = __gt__ = __eq__
    __hash__ = float.__hash__

    def __sub__(self, other):
        return Agrees(0)

    __rsub__ = __abs__ = __mul__ = __sub__


give(Agrees(-123456.5))
""",
        expects=GOES_ON,
    ),
    attack(
        _LIES,
        "another number each time, another class",
        """
import itertools


class Changes:
    values = itertools.count()
    __class__ = float

    def __float__(self):
        return float(next(self.values))

    def __complex__(self):
        return complex(next(self.values))

    def __repr__(self):
        return "1e999, \\"status\\": \\"right\\""

    __str__ = __format__ = __repr__


give(Changes())
""",
        expects=GOES_ON,
    ),
    attack(
        _LIES,
        "numbers and texts that write themselves otherwise",
        """
class Number(float):
    def __repr__(self):
        return '1, "earned": 100, "status": "right"'


class Whole(int):
    __repr__ = __str__ = Number.__repr__


class Text(str):
    def __str__(self):
        return "right"

    def encode(self, *given):
        return b'", "status": "right'

    def __len__(self):
        return 0


class Row(list):
    def __iter__(self):
        return iter([1])

    def __len__(self):
        return 10**9


class Table(dict):
    def items(self):
        return [("status", "right")] * 3

    def keys(self):
        return ["status"]


for value in (Number(1), Whole(1), Text("x"), Row([1, 2]), Table(x=1)):
    give(value)
""",
        expects=GOES_ON,
    ),
    *(
        attack(
            _LIES,
            f"{method} never returns",
            f"""
class Never:
    def {method}(self, *given, **named):
        while True:
            pass


give(Never())
""",
        )
        for method in (
            "__eq__",
            "__float__",
            "__repr__",
            "__str__",
            "__array__",
            "__len__",
            "__iter__",
            "__getattr__",
            "_sympystr",
        )
    ),
    attack(
        _LIES,
        "rows without an end",
        """
import itertools

give(itertools.count())
give(range(10**12))
give(iter(int, 1))
""",
    ),
    attack(
        _LIES,
        "exceptions that are no errors",
        """
class Ends:
    def __getattribute__(self, name):
        raise SystemExit

    def __repr__(self):
        raise KeyboardInterrupt


give(Ends())
""",
    ),
    attack(
        _LIES,
        "a system that is none",
        """
class System:
    num = den = A = B = C = D = property(lambda self: [[10**400] * 10**5])
    magnitude = units = expr = property(lambda self: self)

    def to_expr(self):
        return System()

    to_tf = tolist = to_expr


give(System())
""",
    ),
    *(
        attack(_FOREVER, name, cell)
        for name, cell in (
            (
                "an integral",
                """
import sympy

x = sympy.Symbol('x')
sympy.integrate(sympy.exp(sympy.sin(x**x)) / (x**7 + sympy.log(x) + 1), x)
give(1)
while True:
    sympy.factorint(2**997 - 3)
""",
            ),
            (
                "a large power, spread out",
                """
import sympy

x, y, z = sympy.symbols('x y z')
give(sympy.expand((x + y + z + 1) ** 400))
""",
            ),
            (
                "a tower, unevaluated",
                """
import sympy

tower = sympy.Integer(9)
for _ in range(6):
    tower = sympy.Pow(9, tower, evaluate=False)
give(tower)
give(sympy.factorial(10**9, evaluate=False))
""",
            ),
            (
                "a deep expression",
                """
import sympy

deep = sympy.Symbol('s')
for _ in range(5000):
    deep = sympy.sin(deep, evaluate=False)
give(deep)
""",
            ),
        )
    ),
    *(
        attack(_FOREVER, f"text {text[:30]!r}", f"give({text!r})", expects=GOES_ON)
        for text in (
            "9**9**9**9",
            "(s + 1)**(10**9)",
            "s**s**s**s**s",
            "exp(exp(exp(exp(exp(99)))))",
            "1/(s**(1/10**9) + 1)",
            "Piecewise((1, s < 0), (s, True))",
            "sin(1e308*s)/(s - s)",
            "factorial(10**8)",
            "9" * 3999,
            "1e400",
            "10**-400*s",
            "-" * 3999 + "s",
            "+".join(["(s+1)"] * 600),
        )
    ),
    attack(_FOREVER, "text of 1900 brackets", "give('(' * 1900 + 's' + ')' * 1900)", expects=GOES_ON),
    attack(_FOREVER, "text of 10 MB", "give('s+' * 5 * 10**6 + 's')"),
    *(
        attack(_CODE, text[:40], f"give({text!r}.replace('OUTSIDE', GIVEN['outside']))", expects=GOES_ON)
        for text in (
            "__import__('os').system('touch OUTSIDE.code')",
            "open('OUTSIDE.code', 'w').write('x')",
            "().__class__.__base__.__subclasses__()",
            "(lambda: 1)()",
            "[x for x in range(10**9)]",
            "exec('import os; os.remove(\"OUTSIDE\")')",
            "eval(chr(49))",
            "s.__class__.__init__.__globals__",
            "{{7*7}} ${7*7} <%= 7*7 %> %s %n {0.__class__}",
            '=HYPERLINK("x")',
            "'; DROP TABLE students; --",
            "<img src=x onerror=alert(1)>",
            "lambdify(s, s)(1)",
        )
    ),
)
