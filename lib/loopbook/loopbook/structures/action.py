"""The action of a controller, from the process that it controls."""

from __future__ import annotations

import sympy

from loopbook.laplace import by_delay
from loopbook.transfer import poles, simplified
from loopbook.types import Number
from plainmath.expressions import function_of, s

__all__ = ["controller_action"]


def controller_action(process: Number) -> str:
    """Return the action that a controller needs for a process: "reverse" or "direct". (Haugen, Section 7.3.3)

    The sign of the process gain decides, the limit of ``s**n H(s)`` at s = 0 with the number n of integrators: where
    the measurement rises with the control signal, the controller must lower that against a rise.

    Arguments:
        process: the transfer function from the control signal to the measurement, with numbers or positive symbols.
    Raises:
        ValueError: where the sign depends on the symbols, the control signal has no lasting effect, or the process is
            unstable, so that this sign does not decide.

    >>> from loopbook.plants import BufferTank
    >>> tank = BufferTank()
    >>> controller_action(tank.transfer_function("F_in")), controller_action(tank.transfer_function("F_out"))
    ('reverse', 'direct')
    """
    H = simplified(function_of(s, process))
    gain, power = H.leadterm(s) if H.has(s) else (H, 0)
    if H == 0 or power > 0:
        raise ValueError(f"the control signal has no lasting effect through {H}: expected a process gain")
    if not H.free_symbols - {s} and any(sympy.re(p).evalf() > 0 for part in by_delay(H).values() for p in poles(part)):
        raise ValueError(f"{H} is unstable: expected a stable or integrating process, whose gain decides the action")
    if not (gain.is_positive or gain.is_negative):
        raise ValueError(f"the sign of the process gain {gain} is not known: expected numbers or positive symbols")
    return "reverse" if gain.is_positive else "direct"
