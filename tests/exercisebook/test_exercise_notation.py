"""Formulas as people write them: what is read, and how, and what is not read because it may mean two things."""

import pytest
from hypothesis import given
from hypothesis import strategies as st

from exercisebook import grammar
from exercisebook.agreement import agree
from exercisebook.authoring import expression, number, poles, time_function
from exercisebook.formulas import Formula
from exercisebook.grammar import Unreadable
from exercisebook.judging import RIGHT, judge
from exercisebook.points import points_for
from exercisebook.reading import listed_in

#: {symbols: {formula in Python's notation: the ways to write it, between bars}}.
READ = {
    "s": {
        "2*exp(-3*s)/(10*s + 1)": (
            "2exp(-3s)/(10s+1) | 2 exp(-3 s)/(10 s + 1) | 2e^(-3s)/(10s + 1) | 2*e^-3s/(10s + 1)"
            " | 2 e^{-3 s} / (10 s + 1) | 2e^(-3s)/[10s+1] | 2/(10s+1) e^(-3s) | 2/(10s+1)e^{-3s}"
            r" | 2/(10s+1) exp(-3s) | \frac{2}{10s+1}e^{-3s} | \frac{2}{10 s + 1} \cdot e^{-3 s}"
            r" | \dfrac{2\,\mathrm{e}^{-3s}}{10s+1} | $\frac{2 e^{-3s}}{10s+1}$"
            r" | \frac{2 \cdot \exp\left(-3s\right)}{\left(10s+1\right)} | G = 2 exp(-3s)/(10s+1)"
            " | H(s)=2e^(-3s)/(1+10s) | y(s)/u(s) = 2e^(-3s)/(10s+1)"
            r" | G{\left(s \right)} = \frac{2 e^{- 3 s}}{10 s + 1} | Y(s)/U(s) = 2/(10s + 1) e^{-3s}."
            " | 2·e^(−3s)/(10s+1) | 2×exp(−3s)÷(10s+1) | 2⋅e^(-3s)/(10s+1) | 0,2 exp(-3,0 s)/(s + 0,1)"
            " | {2 e^{-3s}}/{10s+1} | (2)(e^(-3s))/(10s+1) | 2exp(-3s)(10s+1)^-1 | 2e^(-3s)(10s+1)⁻¹"
            " | 2.0E0*exp(-3s)/(10s+1) | 2 Exp(-3s)/(10s+1) | 2 np.exp(-3s)/(10s+1) | 20·10^-1 e^(-3s)/(10s+1)"
            " | 0,02x10^2 e^(-3s)/(10s+1)"
        ),
        "5*(s + 1)*(s + 2)": (
            "5(s+1)(s+2) | 5 (s+1) (s+2) | (s+1)(s+2)*5 | 5[s+1][s+2] | 5{(s+1)(s+2)} | 5(s + 1)·(s + 2)"
            r" | 5\left(s+1\right)\left(s+2\right)"
        ),
        "2*s": "2s | 2 s | 2·s | s*2 | 2,0s | (2)s | 2(s) | 1/2*4s | 2s. | = 2s | F = 2s",
        "s*(s + 1)": "s(s+1) | s (s+1) | s[s+1] | (s+1)s | s²+s | s^{2}+s",
        "4*s**2 + 3*s + 1": "4s^2+3s+1 | 4s²+3s+1 | 4 s**2 + 3s + 1 | 4s^{2} + 3 s + 1 | (4s+3)s+1 | 4ss+3s+1",
        "sqrt(s + 1)": r"√(s+1) | \sqrt{s+1} | (s+1)^(1/2) | (s+1)^0,5 | √[s+1]",
        "sqrt(s)/2": "√s/2 | sqrt s/2 | 0.5√s | 1/2 √s | ½√s | 0,5 √s",
        "1/(s*(2*s + 3))": (
            r"1/(s(2s+3)) | 1/[s(2s+3)] | \frac{1}{s \left(2 s + 3\right)} | 1 / (s (2 s + 3)) | (s(2s+3))^-1"
        ),
        "20/s + 1/(2*s**2)": (
            r"20/s + 0,5/s^2 | 20/s+0.5/s² | \frac{20}{s}+\frac{1}{2s^2} | 20/s + 1/(2s^2)"
            r" | \frac{20}{s} + \frac{0,5}{s^2}"
        ),
        "(1 - 2*s)/(1 + 2*s)": r"\frac{1-2s}{1+2s} | [1 − 2s]/[1 + 2s] | (1–2s)/(1+2s)",
        "exp(-s)": "e^-s | e^{-s} | e**-s | e^(-s) | e^−s | e^(-1s) | E^(-s)",
        "exp(-2*s)*(1 + s)": "e^(-2s)(1+s) | (1+s)e^-2s | (1 + s) e^{-2s} | exp(-2s)(1+s)",
    },
    "t": {
        "1 - exp(-t/5)": (
            r"1-e^(-t/5) | 1-exp(-0.2t) | 1 - e^(-0,2t) | 1-e^-0.2t | 1 − e^(−t/5) | 1 - e^{-\frac{t}{5}}"
            " | y(t) = 1-e^(-t/5) | y = 1 - exp(-0,2 t)"
        ),
        "12*exp(-3*t/10)": r"12e^(-0.3t) | 12 e^(-0,3 t) | 12e^-0.3t | 12·e^(-0.3·t) | 12 e^{-\frac{3t}{10}}",
        "20*(1 - exp(-t/12))": (
            r"20(1-e^(-t/12)) | 20[1-e^(-t/12)] | 20 (1 − e^{−t/12}) | 20\left(1-e^{-t/12}\right) | 20{1-exp(-t/12)}"
        ),
        "sin(3*t)": r"sin 3t | sin 3 t | \sin 3t | \sin\left(3t\right) | Sin(3t)",
        "2*sin(3*t)*exp(-t)": r"2e^(-t)sin(3t) | 2 sin(3t) e^(-t) | 2sin(3t)e^-t | 2 e^(-t) sin 3t | 2 e^{-t} \sin(3t)",
        "sin(t)**2": r"sin^2(t) | sin²(t) | sin^2 t | (sin t)^2 | sin(t)^2 | sin² t | \sin^{2} t",
        "t*exp(-t/2)": "te^(-t/2) | t e^(-t/2) | t·e^(-t/2) | t exp(-t/2) | texp(-t/2) | te^(-0,5t) | te^-0.5t",
        "Heaviside(t - 3)*(t - 3)": (
            "(t-3)u(t-3) | u(t-3)(t-3) | (t-3)*step(t-3) | (t-3) 1(t-3) | 1(t-3)(t-3) | (t - 3) H(t - 3)"
            " | (t-3)1(t-3) | (t-3)·σ(t-3) | (t-3) sigma(t-3)"
        ),
        "2.5*Heaviside(t - 1.62)": "2,5*Heaviside(t - 1,62) | 2.5*Heaviside(t - 1,62) | 2,5 u(t - 1,62)",
        "2.5*Heaviside(t, 1)": "2,5 Heaviside(t, 1) | 2,5*Heaviside(t, 0.5)",
        "3 + 2*Heaviside(t)": "3+2u(t) | 3 + 2·1(t) | 3 + 2 step(t)",
        "3 - t/1600": (
            "3 - 0,000625t | 3 − t/1600 | 3 - 6.25e-4*t | 3-6.25·10^-4 t | 3 - 6,25·10^-4·t | 3 - 6.25x10^-4 t"
            " | 3-6.25×10⁻⁴t | h = 3 - 1/1600 t"
        ),
        "log(2)*t": r"t ln 2 | t ln(2) | ln(2)t | 0.69314718056 t | t\ln 2 | t*ln 2",
        "pi*t/4": r"πt/4 | pi t/4 | \pi t/4 | \frac{\pi}{4} t | t π/4 | 0,25 π t",
    },
    "K T s": {
        "K/(T*s + 1)": r"K/(Ts+1) | K/(T s + 1) | K/(1+sT) | \frac{K}{T s + 1} | K/[Ts+1] | K(Ts+1)^-1",
        "K*(T*s + 1)": r"K(Ts+1) | K (Ts+1) | KTs+K | (Ts+1)K | K\left(Ts+1\right) | K(1 + sT)",
        "K/(T*s)": r"K/(Ts) | K/Ts | \frac{K}{Ts} | K/(sT)",
        "K*(1 + 1/(T*s))": r"K(1 + 1/Ts) | K\left(1+\frac{1}{Ts}\right) | K(Ts+1)/(Ts) | K[1+1/(Ts)]",
        "2*K*T*s**2": "2KTs^2 | 2KTs² | 2 K T s^2 | 2KTss | 2 K·T·s^2",
    },
    "K_p K T_i s": {
        "K*K_p": "K Kp | KKp | K K_p | KK_p | K*Kp | K·K_p | Kp K | KpK | K K_{p} | K_{p}K",
        "K_p*(1 + 1/(T_i*s))": (
            r"Kp(1+1/(Ti s)) | K_p(1+1/(T_i s)) | K_{p}\left(1+\frac{1}{T_{i}s}\right) | Kp(1+1/Tis)"
            " | Kp (Ti s + 1)/(Ti s)"
        ),
    },
    "tau theta K s": {
        "K*exp(-theta*s)/(tau*s + 1)": (
            r"K e^(-theta s)/(tau s + 1) | Ke^(-θs)/(τs+1) | \frac{K e^{-\theta s}}{\tau s + 1} | Kexp(-θs)/(τs+1)"
            r" | \frac{K}{\tau s+1}e^{-\theta s} | K/(τs+1) e^(-θs)"
        ),
    },
    "x_1 x_2 u_1 J D T m g l": {
        "(T - D*x_2 - m*g*l*sin(x_1))/J": (
            "(T-Dx2-mgl sin(x1))/J | (T - Dx_2 - mgl sin x_1)/J | (T - D·x₂ - m·g·l·sin(x₁))/J"
            r" | (T - D x_2 - mglsin(x_1))/J | \frac{1}{J}\left(T-Dx_{2}-mgl\sin x_{1}\right)"
            " | dx2/dt = (T - Dx2 - mgl sin(x1))/J | J^-1 (T - Dx2 - mgl sin(x1))"
        ),
        "u_1*x_1": "u1 x1 | u1x1 | u_1 x_1 | u₁x₁ | u_{1}x_{1} | x1u1 | U1*x1 | u1·x1 | u1(t) x1(t)",
    },
    "h R H q_i q_o": {
        "pi*R**2*h**3/(3*H**2)": r"1/3 π R² h³/H² | \frac{\pi}{3}\frac{R^2}{H^2}h^3 | πh³R²/(3H²) | (π/3)(R/H)²h³",
        "(q_i - q_o)*H**2/(pi*R**2*h**2)": (
            r"(qi - qo)H^2/(πR²h²) | H²(q_i-q_o)/(πR²h²) | \frac{(q_i-q_o)H^2}{\pi R^2 h^2} | (qi-qo)/(π(Rh/H)²)"
            r" | (q_i − q_o)·H²/(π·R²·h²) | \frac{q_{i}-q_{o}}{\pi\left(\frac{R h}{H}\right)^2}"
        ),
    },
    "A K_v h_0 h_1": {
        "2*A*(sqrt(h_1) - sqrt(h_0))/K_v": (
            r"2A(√h1 - √h0)/Kv | 2A/Kv (√h₁ − √h₀) | \frac{2A}{K_v}\left(\sqrt{h_1}-\sqrt{h_0}\right)"
            " | 2 A (h1^0.5 - h0^0.5)/Kv | 2A[√h_1-√h_0]/K_v"
        ),
    },
    "ca": {"ca + 1": "ca + 1 | 1+ca | c_a + 1"},  # which is short for about
    "k K_c tau_1 tau_2": {
        "(tau_1 + tau_2)/(2*sqrt(tau_1*tau_2*(1 + k*K_c)))": (
            "(tau1+tau2)/(2 sqrt(tau1 tau2 (1+k Kc))) | (τ_1+τ_2)/(2√(τ_1τ_2(1+kK_c)))"
            r" | \frac{\tau_1+\tau_2}{2\sqrt{\tau_1\tau_2(1+kK_c)}} | ½(τ1+τ2)/√(τ1 τ2 (1+k Kc))"
        ),
    },
}
FORMS = [
    (form, text, symbols) for symbols, rows in READ.items() for form, ways in rows.items() for text in ways.split(" | ")
]


def test_a_formula_is_read_as_it_is_meant_and_said_in_pythons_notation():
    for form, text, symbols in FORMS:
        key, formula = Formula(form, symbols), Formula(text, symbols)
        assert agree(key, formula, points_for(key), within=0), text
        assert formula.remark in ("", f"read as {formula.text}"), text
        again = Formula(formula.text, symbols)
        assert (again.remark, again.text) == ("", formula.text), text


def test_letters_that_are_the_same_in_other_books_are_read(monkeypatch):
    monkeypatch.setattr(grammar, "SAME_LETTERS", {"kb": "kboltz", "kboltz": "kb"})
    assert Formula("T k_boltz", "k_B T").text == "T*k_B"


#: What may mean two things, or none: {symbols: {text: words of the sentence}}.
DOUBTFUL = {
    "s": {
        "1/2s": "set brackets", "1/10s+1": "set brackets", "2/s(s+1)": "set brackets", "1/(s+1)(s+2)": "set brackets",
        "3/s s": "set brackets", "s/2(s+1)": "set brackets", "1/s2": "", "s2": "", "s 2": "", "2 3": "", "(s+1)2": "",
        "e^-2s/5": "needs brackets", "e^-2 s": "needs brackets", "e^-s(s+1)": "needs brackets", "exp^-2s": "",
        "exp -s": "needs brackets",
        "sin^-1(s)": "inverse", "ln 2/3": "brackets", "sin s s": "brackets", "sqrt 2s/3": "", "√2s": "brackets",
        "2e-3s": "may be", "e(-3s)": "has a ^", "1,500*s": "may be", "12,300": "may be", "1,2,3": "", "0,5,5": "",
        "2,5;3": "", "(s+1": "", "s+1)": "", "s+": "", "*s": "", "2**": "", "2//s": "", "s!": "", "S": "did you mean",
        "2S": "did you mean", "K/(Ts+1)": "", "xs": "", "sx": "", "ess": "", "s = 2s = 3s": "", "2 s and 3": "",
        "about": "", r"\frac{1}{2": "", r"\sqrt[3]{s}": "", r"\sum s": "",
    },
    "t": {
        "1/2t": "set brackets", "u(3)": "", "u t": "", "f(t)": "", "t^2t^3x": "", "e^-t/5t": "", "sin": "",
        "sin()": "", "2 u(t": "", "delta(t)": "",
    },
    "K K_p p": {
        "KKp": "may be", "Kp": "may be",
    },
    "a b ab": {
        "aab": "may be",
    },
    "K s": {
        "K(s)": "may be a product", "k": "did you mean", "kS": "", "\\": "",
    },
    "x n m": {
        "x^nm": "needs brackets", "2x10^3": "may be the symbol",
    },
}  # fmt: skip
NOT_READ = [(text, symbols, says) for symbols, rows in DOUBTFUL.items() for text, says in rows.items()]


def test_what_may_mean_two_things_is_not_read(subtests):
    for text, symbols, says in NOT_READ:
        with subtests.test(text):
            with pytest.raises(Unreadable) as caught:
                Formula(text, symbols)
            assert says in str(caught.value)
            assert len(str(caught.value)) < 250


#: What is Python's notation, and is read as Python reads it: {text: what it is not}.
LITERAL = {
    "1/2*s": "1/(2*s)",
    "e^-s/5": "exp(-s/5)",
    "2^s^2": "(2**s)**2",
    "-s^2": "(-s)**2",
    "s/2/3": "s/(2/3)",
    "2*-s": "s",
}


@pytest.mark.parametrize("text", LITERAL)
def test_pythons_notation_stays_what_it_is(text):
    formula = Formula(text, "s")
    assert formula.remark == ""
    key = Formula(LITERAL[text], "s")
    assert not agree(key, formula, points_for(key), within=0)


#: What may look alike and is not the same, as written and as it must not be read.
DIFFERENT = [
    ("2/(10s+1) e^(-3s)", "2/((10*s + 1)*exp(-3*s))"), ("s^2(s+1)", "s**(2*(s + 1))"), ("2s^2", "(2*s)**2"),
    ("-2s^2", "(-2*s)**2"), ("e^(-s)/2", "exp(-s/2)"), ("2,5s", "5*s"), ("sin 2s + 1", "sin(2*s + 1)"),
    ("√s + 1", "sqrt(s + 1)"), ("1/3 s", "1/(3*s)"), ("10^-3 s", "10**(-3*s)"), ("3e2*s", "3*exp(2)*s"),
    ("2e^-3s + 1", "2*exp(-3*s + 1)"), ("ln s^2 + 1", "log(s**2 + 1)"), ("5 s^2 + s", "5*s**(2 + s)"),
]  # fmt: skip


@pytest.mark.parametrize(("text", "other"), DIFFERENT)
def test_what_looks_alike_is_not_mixed_up(text, other):
    key = Formula(other, "s")
    assert not agree(key, Formula(text, "s"), points_for(key), within=0.001)


@pytest.mark.parametrize("made", ["\frac{1}{\tau s}", "\frac{1}{\tau \times s}", "1/(\tau s)"])
def test_latex_in_a_text_that_is_not_raw_is_latex_all_the_same(made):
    key = Formula("1/(tau*s)", "tau s")
    assert agree(key, Formula(made, "tau s"), points_for(key), within=0)


LONG = [
    "K" * 3999, "s" * 3999, "ss" * 60, "2s" * 1900, "(" * 1900 + "s" + ")" * 1900, "{" * 3000, "\\frac" * 700,
    "\\frac{" * 500 + "s" + "}{2}" * 500, "sin " * 900 + "s",
    "e^" * 1900 + "s", "2e^-s " * 600, "s^2" * 1300, "1," * 1900 + "1",
    "-" * 3900 + "2s", "√" * 2000 + "s", "a_" * 1900, "=" * 3900, "aab" * 1000, "(s)" * 1300, "u(t-" * 900,
]  # fmt: skip


@pytest.mark.parametrize("text", LONG, ids=range(len(LONG)))
@pytest.mark.parametrize("symbols", ["s", "a aa ab b aab s", "t"])
def test_no_text_takes_long_or_much(text, symbols):
    verdict = judge("x", expression(symbols.split()[0], symbols=symbols), text)
    assert verdict.status != RIGHT
    assert len(verdict.says) < 400


#: What texts are made of that somebody types, or nobody.
PARTS = [
    *"()[]{}+-*/^.,;:=<>|&'_ 12st", "±", " and ", " for t < ", " 1/2", r"\frac", "²", "½", "%", "°C", " min",
    " (2 min)", r"\mathrm{m}", "e^", "exp(", "sin ", " otherwise", " then ", "√", "|", r"\begin{cases}", r"\\", "dB",
    "m3", "0", "x10^",
]  # fmt: skip


@given(st.lists(st.sampled_from(PARTS), max_size=14).map("".join))
def test_every_text_has_a_verdict(text):
    for kind in (number(5.2, "bar"), poles([-1, -2]), expression("2*s"), time_function("2*t", until=5, time="s")):
        assert judge("x", kind, text).status


@pytest.mark.parametrize(
    ("text", "parts"),
    [
        ("1; 2", ["1", "2"]), ("1,5; 2", ["1,5", "2"]), ("[1,2]", ["1", "2"]), ("(1, 2)", ["1", "2"]),
        ("{-1,-2}", ["-1", "-2"]), ("-1,-2", ["-1", "-2"]), ("1 and 2", ["1", "2"]), ("1, 2, and 3", ["1", "2", "3"]),
        ("1,5", ["1,5"]), ("(1+2j)", ["(1+2j)"]), ("[[1, 2]; [3, 4]]", ["[1, 2]", "[3, 4]"]),
        ("[[1,2],[3,4]]", ["[1,2]", "[3,4]"]), ("[1, 2; 3, 4]", ["1, 2", "3, 4"]), ("[]", []), ("", [""]),
        ("(s+1)(s+2)", ["(s+1)(s+2)"]), ("[5]", ["5"]), ("exp(1,2), 3", ["exp(1,2)", "3"]),
    ],
)  # fmt: skip
def test_a_list_in_a_text_has_its_parts(text, parts):
    assert listed_in(text) == parts


@pytest.mark.parametrize("word", ["until", "before", "up to", "from", "after"])
def test_a_piece_lasts_until_or_begins_when_its_words_say(word):
    sign = "<" if word in ("until", "before", "up to") else ">="
    key, said = (
        Formula(text, "t", "s") for text in (f"2*t for t {sign} 3, 6 otherwise", f"2t {word} 3 s, 6 otherwise")
    )
    assert agree(key, said, points_for(key), within=0)
