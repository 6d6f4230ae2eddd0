"""The sections about processes and loops: each formula is what a function of the library returns for symbols."""

import functools

import sympy
from sympy import cos, exp, sin, sqrt, symbols

from cheat_sheet.letters import (
    G0,
    T0,
    T1,
    T2,
    T3,
    C,
    G,
    K,
    Kp,
    T,
    Tc,
    Td,
    Tf,
    Ti,
    a,
    beta,
    omega,
    theta,
    zeta,
)
from cheat_sheet.section import Is, Section, joined, shown
from cheat_sheet.stated import (
    GAIN_MARGIN,
    ISE,
    MORE_DEAD_TIME,
    OMEGA,
    PHASE_MARGIN,
    QUOTIENT,
    RHO,
    SERVO_P,
    SERVO_Q,
    SIGMA,
    TWICE_X,
    ZERO_T3,
)
from loopbook import s, t
from loopbook.approximation import half_rule, pade, taylor
from loopbook.integrals import residue_method
from loopbook.laplace import transform
from loopbook.oscillation import Oscillation
from loopbook.pid import PID
from loopbook.transfer import (
    double_integrator,
    feedback,
    first_order,
    integrator,
    integrator_with_lag,
    poles,
    second_order,
    simplified,
    static_gain,
    step_response,
)
from plainmath.latex import latex


def laplace_pairs():
    signals = (
        sympy.Integer(1), t, exp(-a * t), t * exp(-a * t), sin(omega * t), cos(omega * t), exp(-a * t) * sin(omega * t)
    )  # fmt: skip
    f = sympy.Function("f")(t)
    derivative = transform(f.diff(t)).subs({sympy.Function("F")(s): symbols("F"), f.subs(t, 0): symbols("f_0")})
    pairs = [(f"${latex(x, flat=True)}$", compact(transform(x))) for x in signals]
    pairs.append((r"$df/dt$, from $f_0$ on", derivative))
    half = len(pairs) // 2
    rows = tuple((*left, *right) for left, right in zip(pairs[:half], pairs[half:], strict=True))
    return Section("Laplace transform", "04_laplace", rows, ("$f(t)$", "$F(s)$") * 2)


def compact(F):
    """The square completed where there is one: (s + a)^2 + omega^2."""
    above, below = sympy.fraction(F)
    square = (s + a) ** 2 + omega**2
    return above / square if sympy.expand(below - square) == 0 else F


def responses():
    models = (
        first_order(K, T), integrator(K), integrator_with_lag(K, T), second_order(K, T1, T2), second_order(K, T, T),
        double_integrator(K), K * (1 - beta * s) / (T * s + 1),
    )  # fmt: skip
    rows = tuple((model, factored(step_response(model))) for model in models)
    note = r"With dead time, $G(s)\,e^{-\theta s}$ answers with $y(t - \theta)$ from $t = \theta$ on."
    return Section("Responses to a unit step", "06_dynamics", rows, ("$G(s)$", "$y(t)$"), note)


def factored(y):
    """K taken out of a step response, and the exponentials with one factor each."""
    terms = [(term / K).as_independent(exp, as_Add=False) for term in sympy.Add.make_args(y)]
    powers = dict.fromkeys(power for _, power in terms)
    sums = {power: sympy.factor(sum(part for part, other in terms if other == power)) for power in powers}
    together = sympy.Add(*(part * power for power, part in sums.items()))
    return sympy.Mul(K, together, evaluate=False) if together.is_Add else K * together


def oscillations():
    swing = Oscillation(T, zeta)
    one, other = poles(SECOND)
    middle, distance = sympy.expand((one + other) / 2), sqrt(sympy.expand(-((one - other) ** 2) / 4)).simplify()
    rows = (
        (Is(r"\mathrm{overshoot}", swing.overshoot), Is(r"\mathrm{decay\ ratio}", swing.decay_ratio)),
        (Is(r"t_{\mathrm{peak}}", swing.peak_time), Is(r"\mathrm{period}", swing.period)),
        (f"poles ${latex(middle)} \\pm j\\,{latex(distance)}$", ""),
    )
    return Section(f"Second order, ${latex(SECOND, flat=True)}$", "13_poles_and_zeros", rows)


SECOND = K / (T**2 * s**2 + 2 * zeta * T * s + 1)


def controllers():
    serial = PID(Kp, Ti, Td, form="serial")
    there, back = serial.parallel(), PID(Kp, Ti, Td).serial()
    share = symbols("share", positive=True)  # Td/Ti
    root = sympy.simplify((back.Ti / Ti).subs(Td, share * Ti))
    rows = (
        ("parallel", PID(Kp, Ti, Td, Tf).expr),
        ("serial", PID(Kp, Ti, Td, Tf, form="serial").expr),
        ("serial to parallel", f"{shown(Is('f', there.Kp / Kp))}:  {FACTORS}"),
        ("parallel to serial", f"{shown(Is('f', root.subs(share, Td / Ti)))}:  {FACTORS}"),
    )
    return Section("PID controllers", "07_feedback", rows)


FACTORS = "$K_p f$,  $T_i f$,  $T_d/f$"  # what both conversions come to


def loops():
    rows = (
        (Is("y/y_{SP}", feedback(C * G)), Is("e/y_{SP}", feedback(1, C * G))),
        (Is("y/d", feedback(G, C)), Is("u/y_{SP}", feedback(C, G))),
    )
    offset = static_gain(feedback(1, Kp * first_order(K, T)))
    lag = shown(first_order(K, T), flat=True)
    note = f"P control of {lag} leaves the offset {shown(offset, flat=True)} of a setpoint step."
    return Section("A loop of controller $C$ and process $G$", "07_feedback", rows, note=note)


def smith_predictor():
    predictor = simplified(feedback(C, G0 - G0 * exp(-theta * s)))
    rows = ((Is(r"C_{\mathrm{Smith}}", tidy(predictor)), Is("y/y_{SP}", feedback(predictor * G0 * exp(-theta * s)))),)
    return Section(r"Smith predictor for $G_0\,e^{-\theta s}$", "17_dead_time_compensation", rows)


def tidy(H):
    """The predictor's denominator as 1 + C*G_0*(1 - exp(-theta*s))."""
    above, below = sympy.fraction(H)
    sign = -1 if below.subs(C, 0) == -1 else 1
    inside = sympy.expand(sympy.expand(sign * below - 1) / (C * G0))
    return sign * above / (1 + sympy.Mul(C, G0, inside, evaluate=False))


def dead_times():
    delay = exp(-theta * s)
    rows = ((taylor(delay), taylor(delay, inverted=True), *(sympy.cancel(pade(delay, order)) for order in (1, 2))),)
    return Section(
        r"Dead time $e^{-\theta s}$", "14_model_approximation", rows, ("Taylor", "inverse", "Pade", "Pade of order 2")
    )


def half_rules():
    process = (1 - beta * s) * exp(-theta * s) / ((T1 * s + 1) * (T2 * s + 1) * (T3 * s + 1))
    one, two = (half_rule(process, order, largest_first=[T1, T2, T3]) for order in (1, 2))
    rows = (
        ("one lag", one.T1, one.delay),
        ("two lags", f"{shown(two.T1)}, {shown(two.T2, flat=True)}", two.delay),
    )
    return Section(
        f"Half rule, ${latex(process, flat=True)}$", "14_model_approximation", rows, ("model", "lags", "dead time")
    )


def zero_rules():
    rows = (
        (r"T1: $T_0 \geq T \geq T_c$", T0 / T, r"T2: $T \geq T_0 \geq 5 T_c$", T0 / T),
        (r"T1a: $T_0 \geq T_c \geq T$", T0 / Tc, r"T3: $T \geq T_0$, $5 T_c \geq T_0$", ZERO_T3),
        (r"T1b: $T_c \geq T_0 \geq T$", "$1$", r"with $\tilde T = \min(T, 5 T_c)$", ""),
    )
    title = r"Zeros, $(T_0 s + 1)/(T s + 1)$"
    return Section(title, "14_model_approximation", rows, ("if", "becomes") * 2)


@functools.cache
def ise_of_integrator():
    """The integral of the squared error of the loop a*exp(-theta*s)/s after a unit step of the setpoint."""
    above, below = sympy.fraction(sympy.simplify(residue_method(1 / (1 + a * exp(-theta * s) / s) / s).expr))
    return -above / sympy.Mul(2 * a, sympy.expand(-below / (2 * a)))


def squared_error():
    """The closed form of `integrals.pi_first_order`, in the symbols of its docstring."""
    rows = (
        (rf"$L = a\,e^{{-\theta s}}/s$:  {shown(Is('J', ise_of_integrator()))}",),
        (f"PI control of a lag with dead time:  {shown(Is('J', ISE))}  with",),
        (joined("$k = K K_p$", Is(r"\rho^2", RHO**2)),),
        (joined(Is("2 x", TWICE_X)),),
        (joined(Is(r"\omega^2", OMEGA**2), Is(r"\sigma^2", SIGMA**2), Is("q", QUOTIENT)),),
        (f"setpoint:  {joined(Is('P', SERVO_P), Is('Q', SERVO_Q))};  load:  $P = Q = K^2$",),
    )
    note = r"$L$ is the loop's transfer function, in the last line but one at $s = \sigma$."
    return Section("Integral of the squared error $J$ after a unit step", "18_integral_criteria", rows, note=note)


def limits():
    grow = Is(r"\theta\ \mathrm{may\ grow\ by}", MORE_DEAD_TIME)
    rows = ((Is(r"\mathrm{GM}", GAIN_MARGIN), Is(r"\mathrm{PM}", PHASE_MARGIN), grow),)
    return Section(r"Margins of $L = a\,e^{-\theta s}/s$", "19_robustness", rows)
