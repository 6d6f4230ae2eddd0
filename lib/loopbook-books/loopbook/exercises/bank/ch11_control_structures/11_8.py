"""Python beside the page of exercise 11.8."""

import numpy as np

from exercisebook.parameters import written
from loopbook.figures import time_plot


def _effect(u, p, K_c, K_h):
    """What the signal does to the temperature at rest, with the range split at p."""
    p = float(p)
    return float(K_h) * np.interp(u, [p, 100], [0, 100]) - float(K_c) * np.interp(u, [0, p], [100, 0])


def slopes(p, K_c, K_h):
    """The gains below and above a split at p."""
    low, middle, high = _effect([float(p) - 1, float(p), float(p) + 1], p, K_c, K_h)
    return [middle - low, high - middle]


def picture(K_c, K_h):
    """The characteristics of the valves: chilled water over the lower half of the signal, steam over the upper half."""
    u = np.linspace(0, 100, 101)
    cold, warm = (f"{written(K)} K for 1 %" for K in (-K_c, K_h))
    curves = {f"chilled water, {cold}": np.interp(u, [0, 50], [100, 0])}
    curves |= {f"steam, +{warm}": np.interp(u, [50, 100], [0, 100])}
    return time_plot(curves, u, xlabel="$u$ [%]", ylabel="opening [%]")


def solution_picture(K_c, K_h, split):
    """What the signal does to the temperature at rest, split in the middle and split so that both gains are equal."""
    u = np.linspace(0, 100, 101)
    curves = {"split in the middle": _effect(u, 50, K_c, K_h), "split for equal gains": _effect(u, split, K_c, K_h)}
    return time_plot(curves, u, xlabel="$u$ [%]", ylabel="effect [K]", low=True)
