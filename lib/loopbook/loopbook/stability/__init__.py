"""Stability of a feedback loop with dead time, without approximation.

A closed loop with dead times has infinitely many poles, the roots of a sum of polynomials in `s` with
``exp(-delay*s)``. The argument principle counts those in the right half-plane. All searches walk up the imaginary axis
and believe what they see only on intervals on which an expansion with a bound of its rest proves it. Intervals about
which nothing is proved are divided, and computed with more digits; what is then still undecided is an error that says
where. No search takes more than 60,000 intervals, and no count more than 400,000. Limits of gain and dead time are
confirmed by the number of poles on both sides of them; a phase margin, too, where that number is decided.
"""

from loopbook.stability.counting import (
    StabilityLimitError,
    is_closed_loop_stable,
    is_stable,
    unstable_closed_loop_poles,
    unstable_poles,
    unstable_roots,
)
from loopbook.stability.enclosures import UndecidedError
from loopbook.stability.limits import boundary_pi, boundary_pi_approximate, boundary_pid, ultimate
from loopbook.stability.maps import stability_map
from loopbook.stability.margins import Margins, delay_margin, margins
from loopbook.stability.poles import dominant_poles
from loopbook.stability.robustness import DelayRatios, robustness, robustness_pi_first_order
from loopbook.stability.window import robust_in_window, shinskey_window

__all__ = [
    "DelayRatios", "Margins", "StabilityLimitError", "UndecidedError", "boundary_pi", "boundary_pi_approximate",
    "boundary_pid", "delay_margin", "dominant_poles", "is_closed_loop_stable", "is_stable", "margins",
    "robust_in_window", "robustness", "robustness_pi_first_order", "shinskey_window", "stability_map", "ultimate",
    "unstable_closed_loop_poles", "unstable_poles", "unstable_roots",
]  # fmt: skip
