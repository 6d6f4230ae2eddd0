"""Attacks that are made by the dozen, and one with a sign that no file of text should hold."""

from hostile.attack import GOES_ON, attack

METHODS = (
    "__eq__", "__float__", "__repr__", "__str__", "__array__", "__len__", "__iter__", "__getattr__", "_sympystr",
)  # fmt: skip
_NEVER = """
class Never:
    def {}(self, *given, **named):
        while True:
            pass


give(Never())
"""
#: Texts of formulas that take forever, or are none.
FOREVER = (
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
#: Texts with code; OUTSIDE is the file outside the jail.
CODE = (
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
_NO_LANGUAGE = (
    "library(ggplot2)\nx <- c(1, 2, 3)",
    "SELECT * FROM students;",
    "\x00",
    "    if x:\n  y",
    "'''never ends",
)

ATTACKS = (
    attack("endless loop", "ten cells of them", *["while True:\n    pass"] * 10),
    attack("segmentation fault", "signals", *(f"os.kill(os.getpid(), {number})" for number in (11, 7, 4, 6, 15, 9))),
    attack("magics and shells", "a language that is none", *_NO_LANGUAGE, expects=GOES_ON),
    *(attack("lying classes", f"{method} never returns", _NEVER.format(method)) for method in METHODS),
    *(attack("sympy forever", f"text {text[:30]!r}", f"give({text!r})", expects=GOES_ON) for text in FOREVER),
    attack("sympy forever", "text of 1900 brackets", "give('(' * 1900 + 's' + ')' * 1900)", expects=GOES_ON),
    attack("sympy forever", "text of 10 MB", "give('s+' * 5 * 10**6 + 's')"),
    *(
        attack("answers with code", text[:40], f"give({text!r}.replace('OUTSIDE', GIVEN['outside']))", expects=GOES_ON)
        for text in CODE
    ),
)
