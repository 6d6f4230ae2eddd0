"""What several pages of chapter 6 call."""

import numpy as np

from loopbook.deadtime import System


def after(H, time):
    """The step response at a moment, by simulation."""
    return System(H).step(np.array([0, float(time)]))[-1]
