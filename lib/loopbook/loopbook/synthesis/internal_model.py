"""Internal model control: a model is split and inverted, and the controller read as a PID controller."""

from __future__ import annotations

from collections.abc import Callable
from typing import NamedTuple, TypeAlias

import sympy

from loopbook.approximation import pade, taylor
from loopbook.laplace import by_delay, without_delays
from loopbook.pid import PID
from loopbook.synthesis.direct import known_roots
from loopbook.synthesis.settings import Match, as_pid
from loopbook.transfer import first_order, integrator, integrator_with_lag, second_order, transfer_function
from loopbook.types import Number, TransferFunctionLike
from plainmath.expressions import exact, s
from plainmath.tables import typeset
from plainmath.validation import exact_positive

#: What makes a rational transfer function of one with dead time, as `taylor` and `pade`.
Approximation: TypeAlias = Callable[[TransferFunctionLike], sympy.Expr]


class Design(NamedTuple):
    """The steps of a design by internal model control.

    Attributes:
        model: the model, its dead time approximated.
        invertible: its part that the controller inverts.
        remaining: its zeros in the right half-plane, as factors ``1 - T*s``; the closed loop keeps them.
        filter: what is asked of the closed loop besides.
        match: the controller that follows, read as a PID controller.
    """

    model: sympy.Expr
    invertible: sympy.Expr
    remaining: sympy.Expr
    filter: sympy.Expr
    match: Match

    def _repr_html_(self):
        *steps, (_, match) = self._asdict().items()
        steps = {name: typeset(value) for name, value in [*steps, ("controller", match.controller)]}
        rows = (
            f'<tr><td style="text-align:left">{name}</td><td style="text-align:left">{text}</td></tr>'
            for name, text in {**steps, "settings": match._repr_latex_()}.items()
        )
        return f"<table>{''.join(rows)}</table>"


def imc(model: TransferFunctionLike, Tc: Number, approximation: Approximation = taylor) -> PID:
    """Return the PID settings of internal model control: `imc_design` without its steps.

    Source: Seborg et al., Table 12.1 (Chien and Fruehauf), all of whose rows A to O come out.

    >>> imc(first_order(2, 10, delay=3), Tc=2)
    PID(Kp=1, Ti=10)
    >>> imc(first_order(2, 10, delay=3), Tc=2, approximation=pade)
    PID(Kp=23/14, Ti=23/2, Td=30/23)
    """
    return imc_design(model, Tc, approximation).match.settings


def imc_design(model: TransferFunctionLike, Tc: Number, approximation: Approximation = taylor) -> Design:
    """Design a controller by internal model control, and read it as a PID controller.

    The dead time is approximated, and the model is split: zeros in the right half-plane remain, the rest is inverted.
    The closed loop should be the remaining part times a filter: ``1/(Tc*s + 1)``; with an integrator
    ``(a*s + 1)/(Tc*s + 1)**2``, with the a for which a load leaves no offset. The controller follows by direct
    synthesis.

    Arguments:
        model: transfer function, with numbers or symbols, stable but for one integrator, with one dead time.
        Tc: closed-loop time constant, positive.
        approximation: `taylor` or `pade`, of the dead time.
    Returns:
        `Design`, with all steps.
    Raises:
        ValueError: for poles in the right half-plane or on the imaginary axis, but for one integrator; for zeros on the
            axis, or with symbols that leave their sign open; or for a Tc that is not positive.
    Source: Seborg et al., Table 12.1; the split without all-pass factors is the one that gives this table.

    >>> design = imc_design(integrator(2, delay=3), Tc=1)
    >>> design.remaining, design.filter, design.match.settings
    (1 - 3*s, (5*s + 1)/(s + 1)**2, PID(Kp=5/32, Ti=5))
    """
    G, Tc = transfer_function(model), exact_positive("Tc", Tc)
    if len(by_delay(G)) != 1:
        raise ValueError(
            f"{G} {'adds several dead times' if G != 0 else 'is zero'}: expected a model with one dead time"
        )
    if not callable(approximation):
        raise ValueError(f"approximation is {approximation!r}: expected taylor or pade")
    approximated = approximation(G)
    if without_delays(approximated)[1]:
        raise ValueError(f"the approximation leaves {approximated}: expected no dead time in it")
    above, below = sympy.fraction(sympy.cancel(approximated))
    poles = list(known_roots(below))
    for p in poles:
        if p != 0 and sympy.re(p).is_nonnegative:
            raise ValueError(f"{G} has a pole at {p}: expected a process that is stable, but for an integrator")
    integrators = poles.count(0)
    if integrators > 1:
        raise ValueError(f"{G} has two integrators: no rule is known")
    remaining, inverted = _split(above, G)
    invertible = inverted / _factored(below)
    lead = 2 * Tc - sympy.diff(remaining, s).subs(s, 0) if integrators else sympy.S.Zero
    ahead, behind = lead * s + 1, (Tc * s + 1) ** (1 + integrators)
    # direct synthesis for remaining*filter, of which the factors are known
    controller = ahead / (invertible * _factored(behind - remaining * ahead))
    return Design(approximated, invertible, remaining, ahead / behind, as_pid(controller))


def _factored(polynomial):
    content, factors = sympy.Poly(polynomial, s).factor_list()
    return content * sympy.Mul(*(factor.as_expr() ** n for factor, n in factors))


def _split(above, G):
    """The numerator of G as a product of its zeros in the right half-plane, 1 at s = 0, and of all the rest."""
    constant, parts = sympy.Poly(above, s).factor_list()
    remaining, inverted = [], [constant]
    for part, n in parts:
        zeros, at_zero = list(known_roots(part)), part.eval(0)
        for z in zeros:
            if sympy.re(z).is_zero:
                raise ValueError(f"{G} has a zero at {z}: no rule is known for zeros on the imaginary axis")
            if sympy.re(z).is_positive is None:
                raise ValueError(f"{G} has a zero at {z}, on which side is not known: expected positive symbols")
        right = [z for z in zeros if sympy.re(z).is_positive]
        if not right:
            inverted.append(part.as_expr() ** n)
        elif len(right) == part.degree():
            remaining.append((part.as_expr() / at_zero).expand() ** n)
            inverted.append(at_zero**n)
        else:
            remaining.append(_with_zeros(right) ** n)
            inverted.append((at_zero * _with_zeros([z for z in zeros if z not in right])) ** n)
    return sympy.Mul(*remaining), sympy.Mul(*inverted)


def _with_zeros(zeros):
    """The polynomial with these zeros, of which the complex ones are pairs, that is 1 at s = 0."""
    product = sympy.Poly(sympy.Mul(*(1 - s / z for z in zeros)), s, extension=True)
    return sympy.Add(*(exact(sympy.re(c)) * s**k for (k,), c in product.terms()))


def _imc_table():
    K, T, T1, T2, T3, zeta, delay, beta = sympy.symbols("K T T1 T2 T3 zeta delay beta", positive=True)
    oscillating = K / (T**2 * s**2 + 2 * zeta * T * s + 1)
    late = sympy.exp(-delay * s)
    return {
        "A": (first_order(K, T), None),
        "B": (second_order(K, T1, T2), None),
        "C": (oscillating, None),
        "D": (oscillating * (1 - beta * s), None),
        "E": (integrator(K), None),
        "F": (integrator_with_lag(K, T), None),
        "G": (first_order(K, T, delay), taylor),
        "H": (first_order(K, T, delay), pade),
        "I": (second_order(K, T1, T2, delay) * (T3 * s + 1), taylor),
        "J": (oscillating * (T3 * s + 1) * late, taylor),
        "K": (second_order(K, T1, T2, delay) * (1 - T3 * s), taylor),
        "L": (oscillating * (1 - T3 * s) * late, taylor),
        "M": (integrator(K, delay), taylor),
        "N": (integrator(K, delay), pade),
        "O": (integrator_with_lag(K, T, delay), taylor),
    }


# The choices behind each row of the table of Chien and Fruehauf: the model, and what stands for its dead time.
IMC_TABLE: dict[str, tuple[sympy.Expr, Approximation | None]] = _imc_table()
