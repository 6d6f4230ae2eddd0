"""Python beside the page of exercise 7.10."""

import functools

import numpy as np

from loopbook.deadtime import System
from loopbook.expressions import s
from loopbook.figures import time_plot
from loopbook.pid import PID
from loopbook.transfer import second_order


@functools.lru_cache(maxsize=8)
def kicks(K_p, T_i, T_d, step_SP, u_0, order):
    """Times, the curves A, B and C as far as the picture shows them, and by letter what each is in the first moment."""
    times, curves, first = np.linspace(0, 2.5 * float(T_i), 1001), {}, {}
    pid = PID(K_p, T_i, T_d, T_d / 10).expr
    around = 1 + pid * second_order(0.8, 0.8 * T_i, 0.2 * T_i)
    for letter, (w_p, w_d) in zip(order, ((1, 1), (1, 0), (0, 0)), strict=True):
        of_setpoint = pid - K_p * (1 - w_p) - (1 - w_d) * K_p * T_d * s / (T_d / 10 * s + 1)
        u = float(u_0) + float(step_SP) * System(of_setpoint / around).step(times)
        first[letter] = u[0]
        curves[letter] = np.r_[float(u_0), float(u_0), np.minimum(u, float(u_0 + 1.6 * K_p * step_SP))]
    return np.r_[-0.1 * float(T_i), -1e-6, times], *dict(sorted(curves.items())).values(), first


def picture(t, A, B, C, K_p, step_SP, u_0):
    """Three control signals A, B and C after a setpoint step; values above the top of the picture are cut off."""
    jump = float(K_p * step_SP)
    limits = float(u_0) - 0.3 * jump, float(u_0) + 1.6 * jump
    return time_plot({"A": A, "B": B, "C": C}, t, ylabel="control signal [%]", ylim=limits)
