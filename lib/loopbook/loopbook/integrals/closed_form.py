"""The closed form for a PI loop around a lag with dead time, in fast and accurate numbers."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING

import numpy as np

from loopbook.integrals.error import MODES, UnstableLoopError
from plainmath.validation import one_of

if TYPE_CHECKING:
    from numpy.typing import ArrayLike

LARGEST = 2**53  # a whole number that is a float without loss
SETTINGS = ("K", "T", "delay", "Kp", "Ti")

__all__ = ["pi_first_order"]


def pi_first_order(
    K: ArrayLike,
    T: ArrayLike,
    delay: ArrayLike,
    Kp: ArrayLike,
    Ti: ArrayLike,
    mode: str = "servo",
    unstable: float | None = None,
) -> float | np.ndarray:
    """Return the integral of the squared error of a PI loop around a lag with dead time, by its closed formula.

    The process is ``K/(T*s + 1)*exp(-delay*s)``, the controller ``Kp*(1 + 1/(Ti*s))``, the setpoint or the load a unit
    step. With the zeros of Delta in the right half-plane and on the axis, sigma and j omega,

        ISE = Ti/(2 r) (P tan(x)/omega - Q y/sigma),
        x = (omega delay + atan(omega T) + atan(1/(omega Ti)))/2,  y = (1 - L(sigma))/(1 + L(sigma)),
        r = sqrt(Ti^2 (k^2 - 1)^2 + 4 k^2 T^2),  k = K Kp,

    with P = 1 + omega^2 T^2 and Q = 1 - sigma^2 T^2 for the setpoint, P = Q = K^2 for the load. The loop is stable
    where 2 x < pi. The relative error is about 1e-14, where the times have ratios beyond 1e6 up to 1e-12, and larger
    only very near to that limit.

    Arguments:
        K, Kp: gains of process and controller.
        T, delay, Ti: lag, dead time (0 is allowed) and integral time, in one unit of time.
        mode: "servo" or "regulator".
        unstable: the value to return for unstable settings, as ``math.inf``; without it they are an error.
        Each number may be an array; arrays are broadcast.
    Returns:
        A float, or an array, in the setpoint's unit squared, or the load's with K squared, times the unit of time.
    Raises:
        UnstableLoopError: for settings that are not stable, unless `unstable` is given.
        ValueError: for times that are not positive and finite, or another mode.

    >>> round(pi_first_order(K=1, T=1, delay=0.5, Kp=1, Ti=1), 6)
    0.842898
    >>> pi_first_order(1, 1, 0.5, Kp=[1, 9], Ti=1, unstable=math.inf).round(6)
    array([0.842898,      inf])
    """
    one_of("mode", mode, MODES)
    given = (K, T, delay, Kp, Ti)
    if all(isinstance(x, float) or (type(x) is int and abs(x) < LARGEST) for x in given):
        if not (0 < T < math.inf and 0 <= delay < math.inf and 0 < Ti < math.inf and math.isfinite(K * Kp)):
            raise _wrong(*given)
        if K * Kp > 0:
            x, value = _pi_first_order(math, lambda condition, one, other: one if condition else other, *given, mode)
            if x < math.pi / 2:
                return value
        if unstable is None:
            raise _unstable(*given)
        return unstable

    given = K, T, delay, Kp, Ti = _broadcast(given)
    with np.errstate(over="ignore", invalid="ignore"):
        right = (T > 0) & (delay >= 0) & (Ti > 0) & np.isfinite(K * Kp) & np.isfinite(T + delay + Ti)
    if not right.all():
        raise _wrong(*(float(x[~right][0]) for x in given))
    with np.errstate(divide="ignore", invalid="ignore", over="ignore"):
        x, value = _pi_first_order(np, np.where, *given, mode)
        stable = (x < math.pi / 2) & (K * Kp > 0)
    if not stable.all():
        if unstable is None:
            raise _unstable(*(float(x[~stable][0]) for x in given))
        value = np.where(stable, value, unstable)
    return value[()]


def _broadcast(given):
    """The settings as arrays of floats of one shape."""
    arrays = []
    for name, value in zip(SETTINGS, given, strict=True):
        try:
            array = np.asarray(value)
            if array.dtype.kind not in "fiuO":  # no truth values, no text, and no complex numbers, which would be cut
                raise TypeError
            arrays.append(array.astype(float))
        except (TypeError, ValueError, OverflowError):
            raise ValueError(f"{name} is {value!r}: expected a number, or an array of numbers") from None
    try:
        return np.broadcast_arrays(*arrays)
    except ValueError:
        shapes = ", ".join(f"{name} {array.shape}" for name, array in zip(SETTINGS, arrays, strict=True))
        raise ValueError(f"the shapes of the settings are {shapes}: expected shapes that fit together") from None


def _pi_first_order(m, where, K, T, delay, Kp, Ti, mode):
    """The angle x and the integral; `m` is math or NumPy."""
    k = K * Kp
    # k^2 - 1 is small where k is about 1, and then the rounding of the product K Kp counts
    b = Ti * ((k - 1) + _rounded_off(K, Kp, k)) * (k + 1)
    r = m.hypot(b, 2 * k * T)
    larger = (abs(b) + r) / 2
    # sigma and omega: the larger from the sum, which does not cancel, and the smaller from the product of both
    fast, slow = m.sqrt(larger / Ti) / T, k / m.sqrt(Ti * larger)
    omega, sigma = where(b >= 0, fast, slow), where(b >= 0, slow, fast)
    x = (omega * delay + m.atan(omega * T) + m.atan2(1, omega * Ti)) / 2
    L = k * (1 + Ti * sigma) / (Ti * sigma * (1 + T * sigma)) * m.exp(-sigma * delay)
    y = (1 - L) / (1 + L)
    P, Q = (1 + (omega * T) ** 2, (1 - T * sigma) * (1 + T * sigma)) if mode == "servo" else (K**2, K**2)
    return x, Ti / (2 * r) * (P * m.tan(x) / omega - Q * y / sigma)


def _rounded_off(a, b, product):
    """What floating point left out of the product of a and b. (T. J. Dekker, Numerische Mathematik 18, 1971)"""
    split = 134217729.0  # 2^27 + 1
    a_high, b_high = split * a - (split * a - a), split * b - (split * b - b)
    a_low, b_low = a - a_high, b - b_high
    return ((a_high * b_high - product) + a_high * b_low + a_low * b_high) + a_low * b_low


def _wrong(*given):
    return ValueError(
        f"the settings are {_words(given)}: expected finite numbers, T and Ti positive, delay not negative"
    )


def _unstable(*given):
    return UnstableLoopError(f"the loop is not stable for {_words(given)}: its error has no integral")


def _words(given):
    return ", ".join(f"{name} = {value:g}" for name, value in zip(SETTINGS, given, strict=True))
