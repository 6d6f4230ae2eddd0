"""The Good Gain experiment: a P controller whose step response has an undershoot that is barely observable."""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

import numpy as np

from loopbook.identification.records import record
from loopbook.loops import Loop
from loopbook.pid import PID
from loopbook.stability import ultimate
from loopbook.types import Number, TransferFunctionLike
from plainmath.validation import number, positive

if TYPE_CHECKING:
    from numpy.typing import ArrayLike

BARELY = 0.05  # the undershoot that is barely observable, as a share of the change of the measurement
PERIODS = 8  # of the loop on the limit of stability, for which a response is followed


@dataclass(frozen=True)
class GoodGain:
    """What a Good Gain experiment tells: `good_gain_experiment` returns it.

    Attributes:
        KpGG: the gain of the P controller.
        Tou: the time from the overshoot to the undershoot.
        overshoot, undershoot: of the response with that gain, shares of the change of the measurement.
        times, y: the response, two arrays.
    """

    KpGG: float
    Tou: float
    overshoot: float
    undershoot: float
    times: np.ndarray
    y: np.ndarray

    def __repr__(self) -> str:
        return (
            f"<Good Gain: KpGG = {self.KpGG:.4g}, Tou = {self.Tou:.4g}, "
            f"overshoot {self.overshoot:.1%}, undershoot {self.undershoot:.1%}>"
        )


def swing(times: ArrayLike, y: ArrayLike, final: Number | None = None) -> tuple[float, float, float]:
    """Return overshoot, undershoot and the time between the two, of the response to a step.

    Both are counted from the final value, as shares of the whole change. The undershoot is the lowest point after the
    overshoot, if it is below the final value. (A fall is treated as a rise.)

    Arguments:
        times, y: a response that begins at rest, two arrays.
        final: the final value; the last one if not given.
    Returns:
        (overshoot, undershoot, time between them), where there is none 0, 0 and nan.
    Raises:
        ValueError: for arrays that do not fit, or a response that does not move.

    >>> import numpy as np
    >>> t = np.linspace(0, 20, 2001)
    >>> [round(float(x), 3) for x in swing(t, 1 - np.exp(-t / 2) * np.cos(t), final=1)]
    [0.234, 0.049, 3.14]
    """
    times, y = record(times, y=y)
    final = y[-1] if final is None else number("the final value", final)
    if final == y[0]:
        raise ValueError("the response ends where it began: expected one to a step")
    share = (y - y[0]) / (final - y[0])
    top = int(share.argmax())
    if share[top] <= 1 or top == len(share) - 1:
        return 0.0, 0.0, math.nan
    # from the overshoot to the next crossing of the final value, and on to the one after it
    below = np.flatnonzero(share[top:] < 1)
    if not len(below):
        return float(share[top] - 1), 0.0, math.nan
    first = top + int(below[0])
    again = np.flatnonzero(share[first:] > 1)
    end = first + int(again[0]) if len(again) else len(share)
    bottom = first + int(share[first:end].argmin())
    return float(share[top] - 1), float(1 - share[bottom]), float(times[bottom] - times[top])


def good_gain_experiment(
    process: TransferFunctionLike | Callable[[float], Sequence[Any]],
    undershoot: Number = BARELY,
    highest: Number | None = None,
) -> GoodGain:
    """Find the gain of a P controller with which the step response has a barely observable undershoot.

    Barely observable means here: the undershoot after the first overshoot is 5 % of the change of the measurement, so
    that it just stays in the band by which a response is usually called settled. Where one pair of poles prevails, the
    overshoot is then the square root of that, 22 %, and the damping ratio 0.43. The share may be chosen otherwise.
    The gain is found by `scipy.optimize.brentq`, as the undershoot grows with it.

    Arguments:
        process: transfer function with numbers, with its exact dead time; or a function that makes the experiment on a
            simulator: from Kp to (times, measurement) or (times, measurement, final value).
        undershoot: the share that is barely observable.
        highest: the highest gain to try; the ultimate gain of a transfer function if not given.
    Returns:
        A `GoodGain`.
    Raises:
        ValueError: for a share that is not between 0 and 1, a simulator without a highest gain, or where no gain
            gives such an undershoot, as of one or two lags without dead time.
    Source: Haugen, Section 10.2, Figures 10.1 and 10.3.

    >>> import sympy
    >>> from loopbook import s
    >>> found = good_gain_experiment(sympy.exp(-s) / s)
    >>> round(found.KpGG, 3), round(found.Tou, 2)
    (0.724, 2.8)
    """
    from scipy.optimize import brentq

    undershoot = number("the undershoot", undershoot, "a share between 0 and 1", lambda x: 0 < x < 1)
    if callable(process) and type(process).__module__.split(".")[0] != "control":
        if highest is None:
            raise ValueError("the highest gain to try is missing: expected one, as for every simulator")
        respond = process
    else:
        Ku, Pu = ultimate(process)
        if not (math.isfinite(Ku) and 0 < Pu < math.inf):
            raise ValueError(
                f"no positive gain makes the loop of {process} oscillate: it has no barely observable undershoot"
            )
        highest, respond = 0.98 * Ku if highest is None else highest, _response_of(process, Pu)
        number("the highest gain", highest, f"one below the ultimate gain, {Ku:.4g}", lambda x: x < Ku)
    highest = positive("the highest gain", highest)

    def beyond(Kp):
        return swing(*respond(Kp))[1] - undershoot

    if beyond(highest) <= 0:
        raise ValueError(
            f"with the gain {highest:g} the undershoot is below {undershoot:g}: expected a higher gain to try"
        )
    if beyond(highest / 1000) > 0:
        raise ValueError(
            f"with the gain {highest / 1000:g} the undershoot is above {undershoot:g}: expected a process that does "
            "not oscillate without control"
        )
    KpGG = brentq(beyond, highest / 1000, highest, xtol=1e-6 * highest)
    times, y, *final = respond(KpGG)
    overshoot, found, Tou = swing(times, y, *final)
    if abs(found - undershoot) > 0.1 * undershoot:
        raise ValueError(f"near the gain {KpGG:g} the undershoot jumps past {undershoot:g}: expected a steady growth")
    return GoodGain(float(KpGG), Tou, overshoot, found, times, y)


def _response_of(process, Pu):
    """The experiment on a transfer function: the exact response of the loop with a P controller to a step."""
    times = np.linspace(0, PERIODS * Pu, 400 * PERIODS + 1)

    def respond(Kp):
        servo = Loop(process, PID(float(f"{Kp:.12g}"))).servo
        return times, servo.step(times), float(servo.static_gain)

    return respond
