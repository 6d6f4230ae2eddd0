"""Linear systems with exact dead time: algebra, responses in time, frequency response.

A system is a fraction of sums of polynomials in `s`, each with a dead time exp(-delay*s). Everything is computed from
that, without a Pade approximation or a time step: `System` for block diagrams, `Loop` for a process under control.
"""

import functools
import itertools
import math
import numbers
from dataclasses import dataclass
from fractions import Fraction
from types import MappingProxyType
from typing import NamedTuple

import sympy

from loopbook.expressions import function_of, s, t
from loopbook.laplace import evaluate, transform
from loopbook.transfer import transfer_function

__all__ = [
    "ChannelModel",
    "Loop",
    "LoopResponse",
    "Response",
    "System",
    "feedback",
    "normal_form",
    "real_numbers",
    "transfer_function",
]

NODES = 20  # where a segment of a response is known, so that it is a polynomial of degree 19
REACH = 4.0  # how many times the fastest lag a segment may be long
RESOLVED = 1e-12  # the share of a response that its last two coefficients may have
ROUNDED = Fraction(1, 2**48)  # by how much, as a share of them, two moments that are meant to be one may differ
MOST_SEGMENTS = 200_000
MOST_LENGTHS = 200  # of segments whose propagation is kept
MOST_MULTIPLES = 60  # of a common base, up to which delays are powers of one letter


# ------------------------------------------------------------------------------------------------ the normal form


def normal_form(H):
    """Return numerator and denominator of a transfer function, each a sum of polynomials with dead times.

    Common factors are cancelled, also those that contain dead times, if these are multiples of one, up to 60 times it.

    Arguments:
        H: expression in `s`, rational in `s` and in dead times exp(-delay*s), which may stand anywhere. Other letters
            are allowed, in delays too. Or a `System`.
    Returns:
        Two dictionaries ``{delay: polynomial}``, the polynomials as SymPy ``Poly`` in `s`. The denominator has a part
        without dead time.
    Raises:
        ValueError: if H is no such fraction, or its output depends on the input of a later time.

    >>> numerator, denominator = normal_form(1 / (s + 2 * sympy.exp(-s)))
    >>> {delay: part.as_expr() for delay, part in denominator.items()}
    {0: s, 1: 2}
    """
    if isinstance(H, System):
        return dict(H.numerator), dict(H.denominator)
    H = function_of(s, H)
    if H.has(sympy.oo, sympy.zoo):
        raise ValueError(f"{H} is infinite: expected a transfer function")
    H = H.xreplace({exponential: _split(exponential) for exponential in H.atoms(sympy.exp)})
    powers, delays = _dead_times(H)
    letters = sorted(H.free_symbols - {s}, key=str)
    field = sympy.QQ.frac_field(s, *delays, *letters)
    known = dict(zip(field.symbols, field.gens, strict=True))
    known |= {exponential: known[letter] ** n for exponential, (letter, n) in powers.items()}
    try:
        fraction = _in_field(H, field, known)
    except ZeroDivisionError:
        raise ValueError(f"{H} is infinite: expected a transfer function") from None
    except _NotRationalError:
        raise ValueError(f"{H} is not a rational function of s and dead times exp(-delay*s)") from None
    above, below = (_collected(part, list(delays.values()), letters) for part in (fraction.numer, fraction.denom))
    base = next((d for d in below if all((other - d).is_nonnegative for other in below)), None)
    if base is None:
        raise ValueError(f"the dead times {', '.join(map(str, below))} cannot be ordered: give numbers for letters")
    above, below = ({delay - base: part for delay, part in parts.items()} for parts in (above, below))
    for delay in above:
        if not delay.is_nonnegative:
            raise ValueError(f"{H} contains exp({-delay * s}): a dead time cannot be negative")
    return above, below


def _split(exponential):
    """exp(a - delay*s), as a shift of `s` makes it, with the number exp(a) to 30 digits as a factor."""
    number, rest = sympy.expand(exponential.exp).as_independent(s, as_Add=True)
    return _rational(sympy.exp(number)) * sympy.exp(rest) if number.is_number and rest.has(s) else exponential


def _dead_times(H):
    """Letters for the dead times in H: {exponential: (letter, power)} and {letter: dead time}.

    Dead times that are multiples of a common one are powers of one letter, so that common factors are seen.
    """
    families = []
    for exponential in sorted(H.atoms(sympy.exp), key=str):
        if not exponential.has(s):
            continue
        delay = -sympy.expand(exponential.exp / s)
        if delay.has(s):
            raise ValueError(f"{H} is not a rational function of s and dead times exp(-delay*s)")
        delay = _rational(delay) if delay.is_number else delay
        for family in families:
            ratio = sympy.cancel(delay / family[0][1])
            if ratio.is_Rational:
                family.append((exponential, delay, ratio))
                break
        else:
            families.append([(exponential, delay, sympy.S.One)])
    powers, delays = {}, {}
    for family in families:
        ratios = [ratio for *_, ratio in family]
        unit = sympy.Rational(math.gcd(*(r.p for r in ratios)), math.lcm(*(r.q for r in ratios)))
        base = unit * family[0][1]
        unit *= -1 if base.could_extract_minus_sign() else 1
        if max(abs(r / unit) for r in ratios) <= MOST_MULTIPLES:
            letter = sympy.Dummy()
            delays[letter] = unit * family[0][1]
            powers |= {exponential: (letter, int(ratio / unit)) for exponential, _, ratio in family}
        else:
            for exponential, delay, _ in family:
                letter = sympy.Dummy()
                sign = -1 if delay.could_extract_minus_sign() else 1
                delays[letter] = sign * delay
                powers[exponential] = letter, sign
    return powers, delays


class _NotRationalError(Exception):
    """An expression is no fraction of polynomials in the known letters."""


def _in_field(expression, field, known):
    """An expression as an element of a field of fractions, which cancels common factors."""

    def read(e):
        if e in known:
            return known[e]
        if e.is_number:
            e = _rational(e)
            return field(sympy.QQ(e.p, e.q))
        if e.is_Add:
            return sum(map(read, e.args), field.zero)
        if e.is_Mul:
            return math.prod(map(read, e.args), start=field.one)
        if e.is_Pow and e.exp.is_Integer:
            return read(e.base) ** int(e.exp)
        raise _NotRationalError

    return read(expression)


def _rational(number):
    """A number itself if it is a fraction, and otherwise to 30 digits."""
    if number.is_Rational:
        return number
    if not number.is_real:
        raise ValueError(f"{number} is complex: expected real coefficients")
    return sympy.Rational(str(number.evalf(30)))


def _collected(part, delays, letters):
    """A polynomial in s, letters for dead times and other letters, as {delay: polynomial in s}."""
    collected = {}
    for (power, *powers), coefficient in part.terms():
        delay = sympy.Add(*(n * d for n, d in zip(powers, delays, strict=False)))
        others = sympy.Mul(*(x**n for x, n in zip(letters, powers[len(delays) :], strict=True)))
        terms = collected.setdefault(sympy.expand(delay), {})
        terms[power,] = terms.get((power,), 0) + sympy.Rational(coefficient.numerator, coefficient.denominator) * others
    polynomials = {delay: sympy.Poly.from_dict(terms, s) for delay, terms in collected.items()}
    kept = {delay: polynomial for delay, polynomial in polynomials.items() if not polynomial.is_zero}
    return dict(sorted(kept.items(), key=lambda item: sympy.default_sort_key(item[0])))


def _fraction(above, below):
    """The expression for a normal form, with whole coefficients."""
    parts = [part for parts in (above, below) for part in parts.values()]
    scale = math.lcm(*(int(part.clear_denoms()[0]) for part in parts)) if all(p.domain.is_QQ for p in parts) else 1
    above, below = (
        sympy.Add(*((part * scale).as_expr() * sympy.exp(-delay * s) for delay, part in parts.items()))
        for parts in (above, below)
    )
    return above / below


# ------------------------------------------------------------------------------------------------ the system


class ChannelModel(NamedTuple):
    """A state-space model with delay channels: what `System.state_space` returns.

    x' = A x + B1 u + B2 w,  y = C1 x + D11 u + D12 w,  z = C2 x + D21 u + D22 w,  and w_k(t) = z_k(t - delays[k]).
    The arrays are two-dimensional; `delays` is a list of fractions.
    """

    A: object
    B1: object
    B2: object
    C1: object
    C2: object
    D11: object
    D12: object
    D21: object
    D22: object
    delays: list


class System:
    """A linear system with exact dead time, anywhere in it, as behind a feedback loop.

    The operators ``+ - * /`` work with other systems, expressions in `s` and numbers, so that an expression of systems
    is the block diagram. Common factors cancel exactly, as far as `normal_form` does.

    Arguments:
        H: transfer function with numbers, an expression in `s` with dead times ``exp(-delay*s)``; a system itself; or a
            continuous single-input single-output system of python-control, whose decimal numbers are taken as meant.
    Attributes:
        expr: the transfer function with common factors cancelled.
        numerator, denominator: ``{delay: polynomial in s}``, exact; the denominator's undelayed part has the leading
            coefficient 1.
    Raises:
        ValueError: for letters, an improper system, a negative dead time, or one whose output would depend on later
            inputs.

    >>> System(sympy.exp(-s) / s) * 2
    System(2*exp(-s)/s)
    >>> feedback(System(sympy.exp(-s) / s))
    System(exp(-s)/(s + exp(-s)))
    """

    def __init__(self, H):
        if isinstance(H, System):
            self.numerator, self.denominator = H.numerator, H.denominator
            return
        H = transfer_function(H)
        if letters := sorted(map(str, H.free_symbols - {s})):
            raise ValueError(f"give a number for {', '.join(letters)} in {H}")
        above, below = normal_form(H)
        above, below = ({delay: part.set_domain(sympy.QQ) for delay, part in parts.items()} for parts in (above, below))
        order = below[0].degree()
        for parts in (below, above):
            for delay, part in parts.items():
                if part.degree() > order:
                    late = f" with the dead time {delay}" if delay else ""
                    raise ValueError(
                        f"{H} is improper: it has s**{part.degree()}{late} over s**{order}; expected no more zeros "
                        f"than poles, as with a filter in the derivative term"
                    )
        leading = below[0].LC()
        self.numerator, self.denominator = (
            MappingProxyType({delay: part.quo_ground(leading) for delay, part in parts.items()})
            for parts in (above, below)
        )

    @functools.cached_property
    def expr(self):
        return _fraction(self.numerator, self.denominator)

    def __repr__(self):
        return f"System({self.expr})"

    def _repr_latex_(self):
        return self.expr._repr_latex_()

    def __eq__(self, other):
        if not isinstance(other, System):
            return NotImplemented
        return (self.numerator, self.denominator) == (other.numerator, other.denominator)

    def __hash__(self):
        return hash((tuple(self.numerator.items()), tuple(self.denominator.items())))

    def __add__(self, other):
        return System(self.expr + transfer_function(other))

    def __sub__(self, other):
        return System(self.expr - transfer_function(other))

    def __rsub__(self, other):
        return System(transfer_function(other) - self.expr)

    def __mul__(self, other):
        return System(self.expr * transfer_function(other))

    def __truediv__(self, other):
        return System(_divided(self.expr, transfer_function(other)))

    def __rtruediv__(self, other):
        return System(_divided(transfer_function(other), self.expr))

    def __neg__(self):
        return System(-self.expr)

    __radd__, __rmul__ = __add__, __mul__

    @property
    def delays(self):
        """The dead times in the numerator and in the denominator, sorted, without zero.

        >>> System((1 - sympy.exp(-2 * s)) / (s + sympy.exp(-s))).delays
        [1, 2]
        """
        return sorted({*self.numerator, *self.denominator} - {0})

    @property
    def is_neutral(self):
        """Whether the highest derivative of the output occurs with a dead time, so that a jump returns for ever.

        >>> System(1 / (s + 1 + s * sympy.exp(-s) / 2)).is_neutral
        True
        """
        order = self.denominator[0].degree()
        return any(delay and part.degree() == order for delay, part in self.denominator.items())

    def frequency(self, omega):
        """Return the frequency response H(j omega), exact but for rounding.

        Arguments:
            omega: frequencies in radians for one unit of time, a number or an array.
        Returns:
            A complex array of the same shape; not finite at a pole on the axis, also one that only dead times cancel,
            as in (1 - exp(-s))/s.

        >>> System(sympy.exp(-s) / s).frequency(2.0).round(6)
        np.complex128(-0.454649+0.208073j)
        """
        import numpy

        point = 1j * real_numbers("frequencies", omega)
        with numpy.errstate(divide="ignore", invalid="ignore"):  # at a pole on the axis
            return _value(self.numerator, point) / _value(self.denominator, point)

    def step(self, times):
        """Return the output for a unit step at t = 0 of the input, the system being at rest before.

        At a jump it is the value after the jump. The error is about 1e-13 of the largest value up to then; of a high
        order at first, while the response is still powers of ten smaller, about 1e-13 of what it is a lag later.

        Arguments:
            times: an array of times, not negative, in the unit of the lags.
        Raises:
            ValueError: for negative times, or where so many combinations of the dead times are points of discontinuity
                that the response cannot be followed.

        >>> feedback(System(sympy.exp(-s) / s)).step([0.5, 1.5, 2.5]).round(6)
        array([0.   , 0.5  , 1.375])
        """
        times = _times(times)
        return self.step_until(times.max(initial=0.0))(times)

    def step_until(self, end):
        """Return the step response up to the time `end` as a `Response`, a function of time with its integrals.

        >>> System(1 / (s + 1)).step_until(5)(1.0).round(6)
        np.float64(0.632121)
        """
        return Response(self.state_space(), end)

    def impulse(self, times):
        """Return the output for a unit impulse at t = 0: the step response of ``s*H``, with the accuracy of `step`.

        Raises ValueError if the system is not strictly proper, so that the output itself contains impulses.

        >>> System(sympy.exp(-s) / (s + 1)).impulse([0.5, 1, 2]).round(6)
        array([0.      , 1.      , 0.367879])
        """
        order = self.denominator[0].degree()
        if any(part.degree() == order for part in self.numerator.values()):
            raise ValueError(f"{self.expr} is not strictly proper: its response to an impulse contains impulses")
        return System(s * self.expr).step(times)

    def response(self, times, u):
        """Return the output for an input u(t) that begins at t = 0, the system being at rest before.

        Arguments:
            times: an array of times, not negative.
            u: an expression in `t` that has a rational Laplace transform apart from dead times (steps, ramps,
                polynomials, exponentials, sines, also later ones); or an array with a value for each of the times,
                increasing and beginning with 0, which are joined by straight lines.
        Returns:
            An array, exact in the sense of `step` for both kinds of input.
        Raises:
            ValueError: for a signal without a transform, an input with impulses where the output would have impulses,
                or arrays that do not fit.

        >>> System(2 / s).response([3, 4], sympy.Heaviside(t - 2)).round(6)
        array([2., 4.])
        """
        times = _times(times)
        if hasattr(u, "__len__") and not isinstance(u, str):
            return self._response_to_samples(times, real_numbers("values of u", u))
        return System(self.expr * transform(function_of(t, u))).impulse(times)

    def _response_to_samples(self, times, u):
        import numpy

        fit = u.shape == times.shape and times.ndim == 1 and len(times) > 1
        if not (fit and times[0] == 0 and (numpy.diff(times) > 0).all()):
            raise ValueError(
                f"{u.size} values of u for {times.size} times: expected one each for times that increase from 0"
            )
        slopes = numpy.diff(u) / numpy.diff(times)
        ramp = System(self.expr / s).step_until(times[-1])
        # each change of slope begins a ramp of its own, at those times that are later
        changes = numpy.diff(slopes, prepend=0)
        after = [changes[:k] @ ramp(times[k] - times[:k]) for k in range(len(times))]
        return u[0] * self.step(times) + after

    def state_space(self):
        """Return a state-space model with delay channels, the controllable canonical form with balanced states.

        Each dead time of the denominator is a channel that leads back to the states, and each one of the numerator a
        channel that leads to the output.

        >>> System(sympy.exp(-3 * s) / (s + 2)).state_space().delays
        [Fraction(3, 1)]
        """
        import numpy
        from scipy.linalg import matrix_balance

        n = self.denominator[0].degree()

        def rows(parts):  # lowest power first
            found = [[float(c) for c in reversed(part.all_coeffs())] for part in parts]
            return numpy.array([row + [0.0] * (n + 1 - len(row)) for row in found]).reshape(-1, n + 1)

        below = {delay: part for delay, part in self.denominator.items() if delay}
        above = {delay: part for delay, part in self.numerator.items() if delay}
        direct = rows([self.numerator.get(0, sympy.Poly(0, s))])
        own, back, ahead = rows([self.denominator[0]])[0, :n], rows(below.values()), rows(above.values())
        channels = numpy.vstack([back, ahead])
        # the last derivative is u - own x - (what comes back), and what it is multiplied with follows from that
        A = numpy.diag(numpy.ones(max(n - 1, 0)), 1)[:n, :n]
        B1, B2 = numpy.zeros((n, 1)), numpy.zeros((n, len(channels)))
        returns = numpy.r_[-numpy.ones(len(back)), numpy.zeros(len(ahead))]
        if n:
            A[-1], B1[-1], B2[-1] = -own, 1, returns
        C1, C2 = (c[:, :n] - c[:, n:] * own for c in (direct, channels))
        D11, D21 = direct[:, n:], channels[:, n:]
        to_output = numpy.r_[numpy.zeros(len(back)), numpy.ones(len(ahead))]
        D12, D22 = D11 * returns + to_output, D21 * returns
        if n:
            with numpy.errstate(invalid="ignore"):  # SciPy makes integers of scales
                _, (scale, _) = matrix_balance(A, permute=False, separate=True)
            A, B1, B2 = A * scale / scale[:, None], B1 / scale[:, None], B2 / scale[:, None]
            C1, C2 = C1 * scale, C2 * scale
        delays = [Fraction(int(d.p), int(d.q)) for d in (*below, *above)]
        return ChannelModel(A, B1, B2, C1, C2, D11, D12, D21, D22, delays)

    def to_control(self, order):
        """Return a state-space system of python-control, with a Pade approximation in place of each dead time.

        Arguments:
            order: of the approximations, at least 1; there is no default, because it decides what the result is worth.
        Raises:
            ValueError: for another order.

        >>> System(sympy.exp(-s) / (s + 1)).to_control(order=4).nstates
        5
        """
        import control
        import numpy

        if isinstance(order, bool) or not isinstance(order, numbers.Integral) or order < 1:
            raise ValueError(f"the order of the Pade approximation is {order!r}: expected 1, 2, 3 ...")
        A, B1, B2, C1, C2, D11, D12, D21, D22, delays = self.state_space()
        B, C = numpy.hstack([B1, B2]), numpy.vstack([C1, C2])
        D = numpy.block([[D11, D12], [D21, D22]])
        model = control.ss(A, B, C, D)
        if not delays:
            return model
        channels = control.append(*(control.ss(control.tf(*control.pade(float(delay), order))) for delay in delays))
        return model.lft(channels)


def feedback(G, H=1):
    """Return the closed loop G/(1 + G*H), with G in the forward path and H in the path back, as a `System`.

    Arguments:
        G, H: systems, expressions in `s`, or systems of python-control. Their product may be improper.
    Raises:
        ValueError: for an algebraic loop that has no solution because 1 + G*H is zero at infinite frequency, or as
            `System`.

    >>> feedback(2 * sympy.exp(-s) / s, sympy.Rational(1, 2))
    System(2*exp(-s)/(s + exp(-s)))
    """
    G, H = transfer_function(G), transfer_function(H)
    return System(G / _return_difference(G * H))


def _return_difference(L):
    """1 + L, if a loop with the open loop L has a solution."""
    above, below = normal_form(1 + L)
    if 0 not in above or above[0].degree() < below[0].degree():
        raise ValueError(f"the algebraic loop around {L} has no solution: its gain at infinite frequency is -1")
    return 1 + L


def _divided(one, other):
    if other == 0:
        raise ValueError(f"{one} is divided by 0: expected a system that is not zero")
    return one / other


def _value(parts, point):
    """The value of a sum of polynomials with dead times at complex points."""
    import numpy

    total = numpy.zeros(numpy.shape(point), dtype=complex)
    for delay, part in parts.items():
        total = total + numpy.polyval([float(c) for c in part.all_coeffs()], point) * numpy.exp(-float(delay) * point)
    return total


def _times(times):
    times = real_numbers("times", times)
    if (times < 0).any():
        raise ValueError(f"the times begin at {times.min():g}: expected zero or later")
    return times


def real_numbers(name, values):
    """Return values as an array of floats, or raise ValueError for what is not real and finite.

    >>> real_numbers("times", [0, 1])
    array([0., 1.])
    """
    import numpy

    try:
        if numpy.iscomplexobj(values):  # which NumPy would cut down to their real parts
            raise TypeError
        array = numpy.asarray(values, dtype=float)
    except (TypeError, ValueError):
        raise ValueError(f"the {name} are {values!r}: expected real numbers") from None
    if not numpy.isfinite(array).all():
        raise ValueError(f"the {name} contain {array[~numpy.isfinite(array)][0]:g}: expected finite numbers")
    return array


# ------------------------------------------------------------------------------------------------ responses in time


class Response:
    """The step response of a state-space model with delay channels: polynomials between points of discontinuity.

    Where a delayed signal is not smooth, and what comes back from there, is known exactly: at the sums of the dead
    times. Between two such points a signal is smooth, and what comes out of a channel is known from earlier. The state
    follows by Gauss collocation, in segments short enough for polynomials of degree 19.

    Arguments:
        model: a `ChannelModel`; its input is a unit step.
        end: the time up to which the response is wanted.
    Attributes:
        edges: the ends of the segments, an array; the last one is at `end` or later.
    """

    def __init__(self, model, end):
        import numpy

        try:
            end = float(end)
        except (TypeError, ValueError):
            raise ValueError(f"the end is {end!r}: expected a number") from None
        if not 0 <= end < math.inf:
            raise ValueError(f"the end is {end}: expected a finite time, zero or later")
        speed = _speed(model)
        for _ in range(6):
            with numpy.errstate(over="ignore", invalid="ignore"):  # said in words below
                self.edges, self._coefficients, tail = _collocate(model, end, speed)
            if tail <= RESOLVED:
                return
            if tail == math.inf:
                raise ValueError(f"the response grows beyond all numbers before t = {end:g}")
            speed = 2 * max(speed, 1 / max(end, 1e-300))
        raise ValueError(f"the response up to t = {end:g} is not resolved: {tail:.0e} of it is left")

    def __call__(self, times):
        """Return the values at the given times, at a jump the one after it."""
        import numpy
        from numpy.polynomial import legendre

        times = _times(times)
        edges = self.edges
        if times.size and times.max() > edges[-1]:
            raise ValueError(f"t = {times.max():g} is later than {edges[-1]:g}, the end of the response")
        # a time that is an edge but for rounding belongs to the segment that begins there
        index = numpy.searchsorted(edges, times * (1 + float(ROUNDED)), side="right") - 1
        index = numpy.clip(index, 0, len(edges) - 2)
        length = edges[index + 1] - edges[index]
        return legendre.legval(2 * (times - edges[index]) / length - 1, self._coefficients[:, index], tensor=False)

    def quadrature(self):
        """Return times and weights, two arrays with a row for each segment, for integrals over the response.

        The sum of weight * response(time)**2 is the integral of the square, exact for these polynomials. It goes to the
        last of the edges, which may lie beyond the end that was asked for.
        """
        import numpy

        nodes, weights = numpy.polynomial.legendre.leggauss(NODES)
        half = numpy.diff(self.edges)[:, None] / 2
        return self.edges[:-1, None] + half * (nodes + 1), half * weights

    @property
    def coefficients(self):
        """The coefficients of the Legendre polynomials, an array with a row for each segment."""
        return self._coefficients.T


def _speed(model):
    """About how fast the signals can change, in 1/time; what it misses is seen in the coefficients."""
    import numpy

    if not len(model.A):
        return 0.0
    # of the system without dead time, with each channel cut or closed either way: independent of the unit of time
    closed = [sign * numpy.outer(into, out) for into, out in zip(model.B2.T, model.C2, strict=True) for sign in (1, -1)]
    return float(max(abs(numpy.linalg.eigvals(model.A + change)).max() for change in [0 * model.A, *closed]))


def _edges(delays, end, speed):
    """The ends of the segments, exact: the sums of the delays, and points between them."""
    end = Fraction(end)
    last = end * (1 + ROUNDED)
    points, newest = {Fraction(0)}, {Fraction(0)}
    while newest:  # each sum is a smaller one plus a delay
        newest = {a + b for a in newest for b in delays if a + b <= last} - points
        points |= newest
        if len(points) > MOST_SEGMENTS:
            raise ValueError(
                f"the dead times {', '.join(map(str, delays))} have more than {MOST_SEGMENTS} sums before "
                f"t = {float(end):g}: expected an earlier end, or dead times that are multiples of one"
            )
    points = sorted(points)  # without those that are one but for rounding, as sums of irrational dead times
    points = [b for a, b in itertools.pairwise([Fraction(-1), *points]) if b - a > b * ROUNDED]
    if points[-1] >= end * (1 - ROUNDED):  # a jump there has a value after it
        points.append(points[-1] + min([*delays, Fraction(REACH / speed if speed else 1)]))
    else:
        points.append(end)
    edges = points[:1]
    for a, b in itertools.pairwise(points):
        pieces = max(1, math.ceil(float(b - a) * speed / REACH))
        if len(edges) + pieces > MOST_SEGMENTS:
            raise ValueError(
                f"the response up to t = {float(end):g} needs more than {MOST_SEGMENTS} segments: its fastest lag, "
                f"about {1 / speed:.2g}, is too short beside the end"
            )
        edges += [a + (b - a) * Fraction(k, pieces) for k in range(1, pieces + 1)]
    return edges


def _collocate(model, end, speed):
    """Edges, Legendre coefficients of the output and the share of the response that they leave out."""
    import numpy
    from numpy.polynomial import legendre

    A, B1, B2, C1, C2, D11, D12, D21, D22, delays = model
    n, q = len(A), len(delays)
    edges = _edges(delays, end, speed)
    ends = numpy.array([float(edge) for edge in edges])
    place = {edge: number for number, edge in enumerate(edges)}
    nodes, weights, to_coefficients, integration = _gauss()
    integrate = weights / 2

    @functools.lru_cache(MOST_LENGTHS)
    def propagation(length):  # from the state at the beginning and the forces to the state at the nodes
        half = float(length) / 2
        system = numpy.eye(NODES * n) - half * numpy.kron(integration, A)
        from_start = numpy.tile(numpy.eye(n), (NODES, 1))
        from_forces = half * numpy.kron(integration, numpy.eye(n))
        solved = numpy.linalg.solve(system, numpy.hstack([from_start, from_forces]))
        return solved[:, :n], solved[:, n:]

    def from_channel(k, channel, delay):  # what went in one delay before, at the nodes of segment k
        source = place.get(edges[k] - delay)
        if source is not None and edges[source + 1] - edges[source] == edges[k + 1] - edges[k]:
            return Z[source, :, channel]
        past = ends[k] - float(delay) + (ends[k + 1] - ends[k]) / 2 * (nodes + 1)
        index = numpy.clip(numpy.searchsorted(ends, past, side="right") - 1, 0, k - 1)
        local = 2 * (past - ends[index]) / (ends[index + 1] - ends[index]) - 1
        return legendre.legval(local, to_coefficients @ Z[index, :, channel].T, tensor=False)

    m = len(edges) - 1
    Y, Z = numpy.zeros((m, NODES)), numpy.zeros((m, NODES, q))
    x = numpy.zeros(n)
    for k in range(m):
        length = edges[k + 1] - edges[k]
        w = numpy.zeros((NODES, q))
        for channel, delay in enumerate(delays):
            if edges[k] >= delay:
                w[:, channel] = from_channel(k, channel, delay)
        X = numpy.zeros((NODES, n))
        if n:
            forces = B1[:, 0] + w @ B2.T
            from_start, from_forces = propagation(length)
            X = (from_start @ x + from_forces @ forces.ravel()).reshape(NODES, n)
            x = x + float(length) * (integrate @ (X @ A.T + forces))
        Z[k] = X @ C2.T + D21[:, 0] + w @ D22.T
        Y[k] = X @ C1[0] + D11[0, 0] + w @ D12[0]
    coefficients = to_coefficients @ Y.T
    signals = [coefficients] + [to_coefficients @ Z[:, :, channel].T for channel in range(q)]
    tail = 0.0
    for signal in signals:
        largest = numpy.maximum.accumulate(abs(signal).max(axis=0))
        left = abs(signal[-2:]).max(axis=0)
        tail = max(tail, (left / numpy.where(largest > 0, largest, 1)).max())
    return ends, coefficients, tail if numpy.isfinite(coefficients).all() else math.inf


@functools.cache
def _gauss():
    """Gauss nodes and weights, the matrix to Legendre coefficients, and the one of integrals from the beginning."""
    import numpy
    from numpy.polynomial import legendre

    nodes, weights = legendre.leggauss(NODES)
    values = legendre.legvander(nodes, NODES)
    degree = numpy.arange(NODES)
    to_coefficients = (degree[:, None] + 0.5) * values[:, :NODES].T * weights
    # the integral of P_m from -1 is (P_{m+1} - P_{m-1})/(2m + 1)
    integrals = numpy.empty((NODES, NODES))
    integrals[:, 0] = nodes + 1
    integrals[:, 1:] = (values[:, 2:] - values[:, :-2]) / (2 * degree[1:] + 1)
    return nodes, weights, to_coefficients, integrals @ to_coefficients


# ------------------------------------------------------------------------------------------------ a loop


@dataclass(frozen=True, repr=False)
class LoopResponse:
    """Signals of a loop, with exact dead time: what `Loop.run` returns, and `figures.trends` draws.

    Attributes:
        times: the moments, an array.
        signals: ``{"setpoint": ..., "d": ..., "y": ..., "u": ...}``, arrays with a value for each moment.
    """

    times: object
    signals: dict
    output: str = "y"
    manipulated: str = "u"
    held: frozenset = frozenset({"setpoint", "d"})

    def __getitem__(self, name):
        if name not in self.signals:
            raise ValueError(f"the response has no signal {name!r}: it has {', '.join(self.signals)}")
        return self.signals[name]

    def unit(self, name):
        """The unit of a signal: all of them are numbers."""
        return "1"

    def __repr__(self):
        import numpy

        times = numpy.ravel(self.times)
        span = f"t = {times[0]:g} to {times[-1]:g}" if times.size else "at no time"
        return f"<response of a loop, {span}: {', '.join(self.signals)}>"


class Loop:
    """A process under feedback control, with a load at its input: y = P (u + d), u = R y_SP - C y.

    Arguments:
        process: P, an expression in `s` with numbers, a `System` or a system of python-control.
        controller: C, a `PID`, or as the process; it may be improper where the loop is not.
        from_setpoint: R, from the setpoint to the control signal, as with setpoint weights; equal to C if not given.
    Attributes:
        process, controller, from_setpoint: expressions in `s`.
        open: the open loop L = C P, an expression.
        servo, regulator: `System` from the setpoint to y, and from the load to y.
        setpoint_to_control, load_to_control: `System` from the setpoint to u, and from the load to u.
    Raises:
        ValueError: for an algebraic loop without solution, or what is no `System`.

    >>> from loopbook.pid import PID
    >>> loop = Loop(2 * sympy.exp(-s) / (4 * s + 1), PID(1, Ti=4))
    >>> loop.servo
    System(exp(-s)/(2*s + exp(-s)))
    """

    def __init__(self, process, controller, from_setpoint=None):
        self.process, self.controller = transfer_function(process), transfer_function(controller)
        self.from_setpoint = self.controller if from_setpoint is None else transfer_function(from_setpoint)
        self.open = self.controller * self.process
        if letters := sorted(map(str, (self.open + self.from_setpoint).free_symbols - {s})):
            raise ValueError(f"give a number for {', '.join(letters)} in the loop of {self.process}")
        self._difference = _return_difference(self.open)

    def __repr__(self):
        return f"Loop({self.process}, {self.controller})"

    def _closed(self, forward):
        return System(forward / self._difference)

    @functools.cached_property
    def servo(self):
        return self._closed(self.from_setpoint * self.process)

    @functools.cached_property
    def regulator(self):
        return self._closed(self.process)

    @functools.cached_property
    def setpoint_to_control(self):
        return self._closed(self.from_setpoint)

    @functools.cached_property
    def load_to_control(self):
        return self._closed(-self.open)

    def error(self, mode):
        """Return E(s), the control error y_SP - y for a unit step of the setpoint ("servo") or load ("regulator").

        >>> from loopbook.pid import PID
        >>> Loop(1 / s, PID(2)).error("servo")
        System(1/(s + 2))
        """
        if mode not in ("servo", "regulator"):
            raise ValueError(f"the mode is {mode!r}: expected 'servo' or 'regulator'")
        if mode == "servo":
            return System((self._difference - self.from_setpoint * self.process) / self._difference / s)
        return System(-self.process / self._difference / s)

    def run(self, times, setpoint=1, load=0):
        """Return the signals of the loop for a setpoint and a load that change in time, the loop at rest before.

        Arguments:
            times: an array of times, not negative.
            setpoint, load: expressions in `t`, as `signals.stepwise` writes steps, or numbers.
        Returns:
            A `LoopResponse`, which `figures.trends` draws.

        >>> from loopbook.pid import PID
        >>> Loop(sympy.exp(-s) / s, PID(0.5)).run([2, 3])["y"].round(6)
        array([0.5  , 0.875])
        """
        times = _times(times)
        y_SP, d = (evaluate(function_of(t, signal), times) for signal in (setpoint, load))
        paths = {"y": (self.servo, self.regulator), "u": (self.setpoint_to_control, self.load_to_control)}
        signals = {"setpoint": y_SP, "d": d}
        for name, systems in paths.items():
            responses = [H.response(times, u) for H, u in zip(systems, (setpoint, load), strict=True) if u != 0]
            signals[name] = sum(responses, 0 * times)
        return LoopResponse(times, signals)
