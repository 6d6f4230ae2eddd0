"""An assignment to release and to grade, whose text a test may change."""

from exercisegrader.assignment import Assignment
from exercisegrader.student import Student

SOURCE = '''"""Tuning $K$

An introduction.
"""
from exercisebook.authoring import *
from plainmath.expressions import s, t
import sympy

SECRET = "a secret of many letters"
z = sympy.Symbol("z")

@exercise("1", title="Gain", points=4)
def first(K=between(2, 6, "K/%"), T=between(15, 40, "s")):
    """It is {K} and {T}."""
    return answers(
        Kp=number(<gain> * K * T, "%/K", "the gain"<within>),
        H=expression(<gain> * K * s / (T + <letter>), symbols="q s z"),
        y=time_function(<gain> * sympy.exp(-t / T), 7 * T, "K"),
        A=numbers([<gain> * K, T], what="the matrix"),
        p=poles([-<gain>, -T]),
    )

@first.mistake("That is wrong.")
def _(K, T):
    return {"Kp": <gain> + 1000}

@exercise("2", title="Settings", points=3)
def second(K=between(1, 9), action=choice("heating", "cooling")):
    """K is {K}, {action}."""
    return answers(
        C=design(number(<gain>, "%/K"), criterion("the gain", lambda gain: gain, above=-10)),
        w=word("<word>", ["direct", "reverse"], "the action"),
        W=words(["<word>", "other"], ["direct", "reverse", "other"], "the steps", ordered=True),
    )
'''

#: What a test puts together itself.
SECRET = 'SECRET = "a secret of many letters"'
HEAD = f'"Title"\nfrom exercisebook.authoring import *\n{SECRET}\n'
ONE = '@exercise({}, title="A", points={})\ndef first(x=between(1, 9)):\n    "x is {{x}}"\n    return answers({})\n'


def written(gain="7.125", within="", letter="z", word="direct", text=SOURCE):
    for name, value in {"gain": gain, "within": within, "letter": letter, "word": word}.items():
        text = text.replace(f"<{name}>", value)
    return text


def students(*names):
    return [Student(f"s{1001 + k}", name) for k, name in enumerate(names)]


def tuning():
    """The assignment, with all kinds of answers."""
    return Assignment.of(written(), "tuning")
