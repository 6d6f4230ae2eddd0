"""Python beside the page of exercise 11.8."""

import numpy as np

from exercisebook.parameters import written
from loopbook.figures import time_plot


def slopes(p, K_c, K_h):
    """The gains below and above a split at p: by how much the temperature at rest changes around it."""
    p = float(p)
    u = [p - 1, p, p + 1]
    effect = float(K_h) * np.interp(u, [p, 100], [0, 100]) - float(K_c) * np.interp(u, [0, p], [100, 0])
    return np.diff(effect).tolist()


def picture(K_c, K_h):
    """The characteristics of the valves: chilled water over the lower half of the signal, steam over the upper half."""
    u = np.linspace(0, 100, 101)
    cold, warm = (f"{written(K)} K for 1 %" for K in (-K_c, K_h))
    curves = {f"chilled water, {cold}": np.interp(u, [0, 50], [100, 0])}
    curves |= {f"steam, +{warm}": np.interp(u, [50, 100], [0, 100])}
    return time_plot(curves, u, xlabel="$u$ [%]", ylabel="opening [%]")
