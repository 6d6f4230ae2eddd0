"""From the closed loop that is wanted to the controller: direct synthesis, internal model control, and PID settings.

The controller comes out of the algebra of the loop. A PID controller is then read off exactly, or as the first terms
of its series; which of the two it was is always said.
"""

from collections import Counter
from dataclasses import dataclass
from typing import NamedTuple

import sympy

from loopbook.approximation import pade, taylor
from loopbook.expressions import exact, s
from loopbook.laplace import by_delay, roots, without_delays
from loopbook.pid import PID
from loopbook.transfer import first_order, integrator, integrator_with_lag, second_order, simplified, transfer_function

__all__ = ["IMC_TABLE", "Design", "Match", "as_pid", "direct_synthesis", "imc", "imc_design"]

KINDS = ("P", "PI", "PID", "PID with filter")


# ------------------------------------------------------------------------------------------------ direct synthesis


def direct_synthesis(model, desired):
    """Return the controller that gives the loop with `model` the setpoint response `desired`.

    It is desired/(1 - desired)/model. Dead time stays exact: a desired response with dead time gives a controller that
    predicts, and `taylor` or `pade` makes a rational one of it.

    Arguments:
        model: transfer function of the process with all that stands in the loop.
        desired: transfer function from setpoint to measurement; 1 at s = 0 for a loop without offset.
    Returns:
        The controller, an expression in `s`.
    Raises:
        ValueError: where no controller can do it: the desired response is not stable or not proper, or faster than the
            dead time of the process, lacks a zero of the process in the right half-plane or on the imaginary axis, or
            leaves a pole there where it is; and for a desired response of 0 or 1. With letters, what they leave open is
            not refused.
    Source: Seborg et al., equation (12-3b); Haugen, equation (10.10); Haugen on tuning, equation (7.88).

    >>> K, T, Tc = sympy.symbols("K T Tc", positive=True)
    >>> direct_synthesis(K / (T * s + 1), 1 / (Tc * s + 1))
    (T*s + 1)/(K*Tc*s)
    """
    G, wanted = transfer_function(model), transfer_function(desired)
    if G == 0:
        raise ValueError("the model is 0: expected a process that the controller can reach")
    if wanted == 0 or simplified(1 - wanted) == 0:
        raise ValueError(f"the desired response is {desired}: expected one that lags behind the setpoint")
    _refuse_impossible(G, wanted)
    return simplified(wanted / (G * (1 - wanted)))


def _refuse_impossible(G, desired):
    for p in _poles_outside(desired):
        raise ValueError(f"the desired response {desired} has a pole at {p}: expected a stable one")
    answers, wanted = by_delay(G), by_delay(desired)
    for part in wanted.values():
        above, below = sympy.cancel(part).as_numer_denom()
        if sympy.degree(above, s) > sympy.degree(below, s):
            raise ValueError(f"the desired response {desired} has more zeros than poles: expected at most as many")
    if any(all((delay - d).is_negative for d in answers) for delay in wanted):
        raise ValueError(
            f"the desired response {desired} comes before the process {G} can answer: "
            f"expected at least the dead time of the process in it"
        )
    if len(answers) == 1:  # zeros of a sum of dead times are not known
        for p in _poles_outside(desired / G):
            raise ValueError(f"the process {G} has a zero at {p}: expected a desired response with that zero")
    for p, n in Counter(_poles_outside(G)).items():
        if _zeros_at(p, 1 - desired, n) < n:
            how = "1 there" if n == 1 else f"1 there, and flat up to its derivative {n - 1}"
            raise ValueError(f"the process {G} has a pole at {p}: expected a desired response that is {how}")


def _poles_outside(H):
    """The known poles that are known not to be in the left half-plane, each as often as it occurs."""
    by_delay(H)  # refuses a dead time in a denominator
    rational, delays = without_delays(H)
    above, below = sympy.fraction(sympy.cancel(rational))
    above = above.xreplace({letter: sympy.exp(-delay * s) for letter, delay in delays.items()})
    for p, n in Counter(_known_roots(below)).items():
        if sympy.re(p).is_nonnegative:  # dead times may leave no pole, as in (1 - exp(-s))/s
            yield from (n - (_zeros_at(p, above, n) if delays else 0)) * [p]


def _zeros_at(p, f, most):
    """How many zeros f(s) has at p, of the first `most`."""
    for n in range(most):
        left = sympy.simplify(sympy.diff(f, s, n).subs(s, p))
        if abs(left.evalf()) > 1e-9 if left.has(sympy.Float) else left != 0:
            return n
    return most


def _known_roots(polynomial):
    """The roots of the factors whose roots are known: letters may stand in a factor of high degree."""
    for factor, n in sympy.Poly(polynomial, s).factor_list()[1]:
        if factor.degree() == 1:
            yield from n * [-factor.eval(0) / factor.LC()]
        elif factor.degree() == 2 or not factor.free_symbols_in_domain:
            yield from n * roots(factor.as_expr())


# ------------------------------------------------------------------------------------------------ PID settings


@dataclass(frozen=True)
class Match:
    """A controller read as a PID controller.

    Attributes:
        controller: the controller itself, an expression in `s`.
        settings: the `PID`.
        exact: whether both are the same; otherwise the settings are the first terms of a series around s = 0, which
            agree at low frequencies.
    """

    controller: sympy.Expr
    settings: PID
    exact: bool

    @property
    def rest(self):
        """What the PID controller lacks, an expression in `s`: 0 for an exact match."""
        return sympy.S.Zero if self.exact else simplified(self.controller - self.settings.expr)


def as_pid(controller, kind=None):
    """Read a controller as a PID controller, exactly if it is one, and otherwise by its series around s = 0.

    The series c[-1]/s + c[0] + c[1]*s + ... is that of Kp*(1 + 1/(Ti*s) + Td*s), for a PID with filter
    Kp*(1 + 1/(Ti*s) + Td*s/(Tf*s + 1)).

    Arguments:
        controller: an expression in `s`; dead times may stand anywhere in it.
        kind: "P", "PI", "PID" or "PID with filter", to keep no more than that; without it, the controller that matches
            exactly, or else a PID, or a PI where the derivative time would be negative.
    Returns:
        A `Match`. The form is serial where only that is exact, as for a PI controller behind a lag.
    Raises:
        ValueError: for a controller that is not a PID controller even at low frequencies: with two integrators, without
            proportional part, or whose series gives times that are negative. With letters, signs that they leave open
            are not refused.
    Source: Seborg et al., Table 12.1, where the rows K and L are such series.

    >>> as_pid((2 * s + 1) * (5 * s + 1) / (4 * s)).settings
    PID(Kp=7/4, Ti=7, Td=10/7)
    >>> match = as_pid(1 / (1 - sympy.exp(-2 * s)), "PI")
    >>> match.settings, match.exact
    (PID(Kp=1/2, Ti=1), False)
    """
    if kind not in (None, *KINDS):
        raise ValueError(f"kind is {kind!r}: expected one of {', '.join(KINDS)}")
    C = transfer_function(controller)
    without_delays(C)  # refuses what is neither rational nor a dead time
    settings = _exactly(C)
    if settings is not None and (kind is None or KINDS.index(_kind(settings)) <= KINDS.index(kind)):
        return Match(C, settings, exact=True)
    return Match(C, _by_series(C, kind), exact=False)


def _kind(settings):
    if settings.Tf != 0:
        return "PID with filter"
    return "PID" if settings.Td != 0 else "P" if sympy.oo == settings.Ti else "PI"


def _exactly(C):
    """The settings of C = (n2*s**2 + n1*s + n0)/(s*(Tf*s + 1)), or None where C is something else."""
    if any(factor.has(s) for factor in C.atoms(sympy.exp)):
        return None
    above, below, field = _coefficients(*sympy.fraction(sympy.together(C)))
    if below[0]:
        above = [field.zero, *above]  # s above and below the fraction bar
    else:
        below = below[1:]
    if len(below) > 2 or len(above) > 3 or not below[0]:
        return None
    n0, n1, n2 = (c / below[0] for c in [*above, field.zero, field.zero][:3])
    Tf = below[1] / below[0] if len(below) > 1 else field.zero
    if field.to_sympy(Tf).is_negative:
        return None
    try:
        return _pid(field, n0, n1 - n0 * Tf, n2 - n1 * Tf + n0 * Tf**2, Tf)
    except ValueError:
        pass
    try:
        return _serial_pid(*(_written(field, x) for x in (n0, n1, n2, Tf)))
    except ValueError:
        return None


def _serial_pid(n0, n1, n2, Tf):
    """The serial settings of (n2*s**2 + n1*s + n0)/(s*(Tf*s + 1)), or None; ValueError for times that are negative."""
    if n1 == 0:
        return None
    if n0 == 0:
        return PID(n1, Td=n2 / n1, Tf=Tf, form="serial")
    difference = sympy.sqrt(sympy.factor((n1 / n0) ** 2 - 4 * n2 / n0))
    if not difference.is_real:
        return None
    Ti, Td = ((n1 / n0 + sign * difference) / 2 for sign in (1, -1))
    return PID(n0 * Ti, Ti, Td, Tf, form="serial")


def _coefficients(above, below, cancelled=True):
    """The coefficients of two polynomials from the lowest power of s, without their common factors, in a field.

    In a field of fractions, sums and products cancel at once, which is quick even with many letters.
    """
    above, below = sympy.Poly(above, s), sympy.Poly(below, s)
    field = above.domain.unify(below.domain).get_field()
    if cancelled:
        above, below = above.set_domain(field).cancel(below.set_domain(field), include=True)
    return *(polynomial.set_domain(field).rep.to_list()[::-1] for polynomial in (above, below)), field


def _written(field, element):
    """An element of a field as an expression, factored."""
    parts = []
    for part in sympy.fraction(field.to_sympy(element)):
        letters = sorted(part.free_symbols, key=str)
        if letters and part.is_polynomial(*letters):
            content, factors = sympy.Poly(part, *letters).factor_list()
            part = content * sympy.Mul(*(factor.as_expr() ** n for factor, n in factors))
        parts.append(part)
    return parts[0] / parts[1]


def _pid(field, integral, proportional, derivative, Tf):
    """The settings of integral/s + proportional + derivative*s/(Tf*s + 1); ValueError where there are none."""
    if not proportional:
        raise ValueError("it has no proportional part")
    Ti = _written(field, proportional / integral) if integral else sympy.oo
    Td = _written(field, derivative / proportional)
    return PID(_written(field, proportional), Ti, Td, _written(field, Tf) if derivative else 0)


def _by_series(C, kind):
    (integral, proportional, derivative, second), field = _series(C)
    zero = Tf = field.zero
    falling = field.to_sympy(derivative / proportional if proportional else derivative).is_negative
    if kind == "P":
        integral = zero
    if kind in ("P", "PI") or (kind is None and falling):
        derivative = zero
    elif kind == "PID with filter" and derivative:
        Tf = -second / derivative  # of derivative*s/(Tf*s + 1), the next term is -Tf*derivative*s**2
    try:
        return _pid(field, integral, proportional, derivative, Tf)
    except ValueError as error:
        raise ValueError(f"{C} is no {kind or 'PID'} controller at low frequencies: {error}") from None


def _series(C):
    """The coefficients of 1/s, 1, s and s**2 in the series of C around s = 0, and the field they are in."""
    rational, delays = without_delays(C)
    dead_times = {letter: sympy.exp(-delay * s) for letter, delay in delays.items()}
    parts = [part.xreplace(dead_times) for part in sympy.fraction(sympy.together(rational))]
    for order in (8, 16, 32):  # powers of s may cancel, and those beyond the order are wrong
        above, below, field = _coefficients(*(taylor(part, order) for part in parts), cancelled=False)
        first_above, first_below = (next((k for k, c in enumerate(x) if c), order) for x in (above, below))
        if max(first_above, first_below) + 3 <= order or not delays:
            break
    else:
        raise ValueError(f"{C} has no series to read a controller off: more than 29 powers of s cancel")
    lowest = first_above - first_below
    if lowest < -1:
        raise ValueError(f"{C} grows faster than 1/s at low frequencies: expected at most one integrator")
    above, below = ([*x[first:], *[field.zero] * 4] for x, first in ((above, first_above), (below, first_below)))
    found = []
    for k in range(4):
        found.append((above[k] - sum((found[i] * below[k - i] for i in range(k)), field.zero)) / below[0])
    return ([field.zero] * (lowest + 1) + found)[:4], field


# ------------------------------------------------------------------------------------------- internal model control


class Design(NamedTuple):
    """The steps of a design by internal model control.

    Attributes:
        model: the model, its dead time approximated.
        invertible: its part that the controller inverts.
        remaining: its zeros in the right half-plane, as factors 1 - T*s; the closed loop keeps them.
        filter: what is asked of the closed loop besides.
        match: the controller that follows, read as a PID controller.
    """

    model: sympy.Expr
    invertible: sympy.Expr
    remaining: sympy.Expr
    filter: sympy.Expr
    match: Match


def imc(model, Tc, approximation=taylor):
    """Return the PID settings of internal model control: `imc_design` without its steps.

    Source: Seborg et al., Table 12.1 (Chien and Fruehauf), all of whose rows A to O come out.

    >>> imc(first_order(2, 10, delay=3), Tc=2)
    PID(Kp=1, Ti=10)
    >>> imc(first_order(2, 10, delay=3), Tc=2, approximation=pade)
    PID(Kp=23/14, Ti=23/2, Td=30/23)
    """
    return imc_design(model, Tc, approximation).match.settings


def imc_design(model, Tc, approximation=taylor):
    """Design a controller by internal model control, and read it as a PID controller.

    The dead time is approximated, and the model is split: zeros in the right half-plane remain, the rest is inverted.
    The closed loop shall be the remaining part times a filter: 1/(Tc*s + 1); with an integrator
    (a*s + 1)/(Tc*s + 1)**2, with the a for which a load leaves no offset. The controller follows by direct synthesis.

    Arguments:
        model: transfer function, with numbers or letters, stable but for one integrator, with one dead time.
        Tc: closed-loop time-constant, positive.
        approximation: `taylor` or `pade`, of the dead time.
    Returns:
        `Design`, with all steps.
    Raises:
        ValueError: for poles in the right half-plane or on the imaginary axis, but for one integrator; for zeros on the
            axis, or with letters that leave their sign open; or for a Tc that is not positive.
    Source: Seborg et al., Table 12.1; the split without all-pass factors is the one that gives this table.

    >>> design = imc_design(integrator(2, delay=3), Tc=1)
    >>> design.remaining, design.filter, design.match.settings
    (1 - 3*s, (5*s + 1)/(s + 1)**2, PID(Kp=5/32, Ti=5))
    """
    G, Tc = transfer_function(model), exact(Tc)
    if Tc.is_positive is False:
        raise ValueError(f"Tc is {Tc}: expected a positive closed-loop time-constant")
    if len(by_delay(G)) != 1:
        raise ValueError(
            f"{G} {'adds several dead times' if G != 0 else 'is zero'}: expected a model with one dead time"
        )
    if not callable(approximation):
        raise ValueError(f"approximation is {approximation!r}: expected taylor or pade")
    approximated = approximation(G)
    if without_delays(approximated)[1]:
        raise ValueError(f"the approximation leaves {approximated}: expected no dead time in it")
    above, below = sympy.cancel(approximated).as_numer_denom()
    poles = list(_known_roots(below))
    for p in poles:
        if p != 0 and sympy.re(p).is_nonnegative:
            raise ValueError(f"{G} has a pole at {p}: expected a process that is stable, but for an integrator")
    integrators = poles.count(0)
    if integrators > 1:
        raise ValueError(f"{G} has two integrators: no rule is known")
    remaining, inverted = _split(above, G)
    invertible = inverted / below
    lead = 2 * Tc - sympy.diff(remaining, s).subs(s, 0) if integrators else sympy.S.Zero
    wanted = (lead * s + 1) / (Tc * s + 1) ** (1 + integrators)
    controller = simplified(1 / (invertible * (1 / wanted - remaining)))
    return Design(approximated, sympy.factor(invertible), remaining, wanted, as_pid(controller))


def _split(above, G):
    """The numerator of G as a product of its zeros in the right half-plane, 1 at s = 0, and of all the rest."""
    constant, parts = sympy.Poly(above, s).factor_list()
    remaining, inverted = [], [constant]
    for part, n in parts:
        zeros, at_zero = list(_known_roots(part)), part.eval(0)
        for z in zeros:
            if sympy.re(z).is_zero:
                raise ValueError(f"{G} has a zero at {z}: no rule is known for zeros on the imaginary axis")
            if sympy.re(z).is_positive is None:
                raise ValueError(f"{G} has a zero at {z}, on which side is not known: expected positive letters")
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
IMC_TABLE = _imc_table()
