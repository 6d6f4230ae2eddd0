"""Simple models for complicated processes: Taylor and Pade for dead time, and Skogestad's half rule.

A `Model` is what the tuning rules start from: a gain, one or two lags, and a dead time.
"""

from dataclasses import dataclass, field

import sympy

from loopbook.expressions import exact, s
from loopbook.laplace import by_delay
from loopbook.transfer import dead_time, transfer_function

__all__ = ["Model", "model_of"]


@dataclass(frozen=True)
class Model:
    """A gain with up to two lags and a dead time: K*exp(-delay*s)/((T1*s + 1)*(T2*s + 1)).

    An infinite lag is an integrator, and K is then the slope: K*exp(-delay*s)/(s*(T2*s + 1)) for T1 = oo, and
    K*exp(-delay*s)/s**2 for two of them.

    Arguments:
        K: gain, in units of the measurement for one unit of the control signal; of an integrator, that per time.
        T1, T2: lags, not negative, the larger one first; T1 may be oo, and then T2 too.
        delay: dead time, not negative, in the unit of the lags.
        steps: how the model was found, if by rules.
    Raises:
        ValueError: for a gain that is zero, a time that is negative, or T2 larger than T1.

    >>> Model(2, T1=10, delay=3).expr
    2*exp(-3*s)/(10*s + 1)
    >>> Model(2, T1=sympy.oo, T2=4).expr
    2/(s*(4*s + 1))
    """

    K: sympy.Expr
    T1: sympy.Expr = sympy.S.Zero
    T2: sympy.Expr = sympy.S.Zero
    delay: sympy.Expr = sympy.S.Zero
    steps: tuple = field(default=(), compare=False, repr=False)

    def __post_init__(self):
        for name in ("K", "T1", "T2", "delay"):
            value = exact(getattr(self, name))
            object.__setattr__(self, name, value)
            if (value.is_real is False and value != sympy.oo) or (value.is_infinite and name in ("K", "delay")):
                raise ValueError(f"{name} is {value}: expected a finite real number")
            if name != "K" and value.is_negative:
                raise ValueError(f"{name} is {value}: expected a time that is not negative")
        if self.K == 0:
            raise ValueError("K is 0: expected a gain that is not zero")
        if self.T1 != sympy.oo and (self.T2 - self.T1).is_positive:
            raise ValueError(f"T1 is {self.T1} and T2 is {self.T2}: expected the larger lag first")

    @property
    def expr(self):
        """The transfer function, an expression in `s` with exact dead time."""
        lags = sympy.Mul(*(1 / s if T == sympy.oo else 1 / (T * s + 1) for T in (self.T1, self.T2)))
        return self.K * lags * dead_time(self.delay)

    @property
    def is_integrating(self):
        """Whether the model has an integrator."""
        return self.T1 == sympy.oo

    def __repr__(self):
        shown = [f"{name}={value}" for name in ("T1", "T2", "delay") if (value := getattr(self, name)) != 0]
        return f"Model({', '.join([f'K={self.K}', *shown])})"


def model_of(H):
    """Return the `Model` that H is, in whatever form it is written.

    Arguments:
        H: a `Model`, a transfer function with at most two poles, both real, no zero and one dead time, or what
            `transfer_function` reads. Of two lags with letters, the one whose name comes first is T1.
    Raises:
        ValueError: for anything else.

    >>> model_of(6 / (30 * s**2 + 33 * s + 3))
    Model(K=2, T1=10, T2=1)
    """
    if isinstance(H, Model):
        return H
    H = transfer_function(H)
    parts = by_delay(H)
    wanted = "expected a gain with one or two lags or integrators, and one dead time"
    if len(parts) != 1:
        raise ValueError(f"{H} is no simple model: {wanted}")
    ((delay, rational),) = parts.items()
    found = _time_constants(rational)
    lags = sorted(found.lags, key=lambda T: (-T if T.is_number else 0, str(T)))
    if found.zeros or len(lags) > 2 or any(T.is_negative or T.is_real is False for T in lags):
        raise ValueError(f"{H} is no simple model: {wanted}; half_rule finds one")
    return Model(found.K, *lags, delay=delay)
