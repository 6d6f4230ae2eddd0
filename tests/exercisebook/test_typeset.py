"""A formula in two dimensions while it is typed: as the reader understands it, and no more than that."""

import json

from exercisebook.forms import Desk
from exercisebook.forms.controls import html as controls_of
from exercisebook.forms.fields import field_of
from exercisebook.forms.typeset import LONGEST, mathml
from exercisebook.grammar import read
from exercisebook.judging import judge
from exercisebook.kinds import Expression, Number
from exercisebook.latex import latex
from exercisebook.response import Response
from shelf import exercise
from typed import Read

SYMBOLS = ["s", "t", "K", "T_i", "tau", "x_1", "Kp"]


def test_each_formula_is_shown_as_it_is_read(subtests):
    for typed, shown in {
        "K/(T_i s + 1) e^(-tau s)": r"\frac{K}{T_{i} s + 1} e^{-\tau s}",
        # a dot where digits or words would run together, and nowhere else
        "2*3*s*2*(1/3) + Kp*s": r"2 \cdot 3 s \cdot 2 \cdot \frac{1}{3} + \mathrm{Kp} \cdot s",
        # a minus in front is that of the whole product; brackets are there where they mean something
        "-2s t - 2/(s + 1)": r"-2 s t - \frac{2}{s + 1}",
        "K - (s - (-1))": r"K - \left(s - \left(-1\right)\right)",
        "-(K/s)^2*(-2)^2": r"-\left(\frac{K}{s}\right)^{2} \left(-2\right)^{2}",
        # in an exponent, a fraction is in the line
        "e^(-t/(2K)) + exp(1 - (t/2) s)": r"e^{-t/\left(2 K\right)} + e^{1 - \left(t/2\right) s}",
        "10^-3 s + 1e-7 + 2.5e-7*s": r"10^{-3} s + 10^{-7} + 2.5 \cdot 10^{-7} s",
        "sqrt(2 x_1)/ln(K) + 2i": r"\frac{\sqrt{2 x_{1}}}{\ln\left(K\right)} + 2 j",
        "abs(s) + sin(t)^2": r"\left|s\right| + \left(\sin\left(t\right)\right)^{2}",
        "min(K, 2) u(t - 3)": r"\min\left(K, 2\right) \operatorname{step}\left(t - 3\right)",
        "0 for t < 3, 2t for t > 3": r"\begin{cases} 0 & t \lt 3 \\ 2 t & \text{otherwise} \end{cases}",
    }.items():
        with subtests.test(typed):
            assert latex(read(typed, SYMBOLS).tree) == shown
            assert Read(mathml(typed, SYMBOLS)).all("math")


def test_what_cannot_be_read_yet_is_not_shown():
    for typed in ("", " ", "2/", "<b>x</b>", "# s", "y", "1 + " * LONGEST + "1"):
        assert mathml(typed, SYMBOLS) == ""
    assert mathml("exp(" * 60 + "s", SYMBOLS).count("<msup>") == 60  # in no time


def test_a_field_asks_for_it_without_an_exercise_and_has_keys():
    request = {"do": "typeset", "text": "K/(s + 1", "symbols": "s K"}
    assert "<mfrac>" in json.loads(Desk(exercise).answer(json.dumps(request)))["mathml"]
    html = controls_of("1.1", field_of("x", Expression("tau/K")))
    assert 'data-symbols="K tau"' in html
    assert [key["data-writes"] for key in Read(html).all("button")][:5] == ["e^(|)", "(|)/()", "", "K", "tau"]
    assert "<mi>τ</mi>" in html
    assert "keys" not in controls_of("1.1", field_of("x", Number(2)))


def test_the_response_shows_how_a_formula_was_read():
    response = Response("1.1", (judge("y", Expression("2*exp(-K/5)"), "2e^(-K/5)"),), 1)
    assert r"right, read as $\displaystyle 2 e^{-K/5}$" in response._repr_html_()
    assert repr(response).endswith("right, read as 2*e**(-K/5)")
