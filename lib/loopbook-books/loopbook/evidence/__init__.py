"""Evidence in control engineering: `bookledger.evidence`, and what decides claims about loops and responses.

>>> from loopbook.evidence import greater
>>> greater(2.31, 1.59, "Ms")
holds: Ms 2.31 > 1.59
"""

from bookledger.evidence import *
from bookledger.evidence import __all__ as _of_any_book
from loopbook.evidence.loops import Stability, good_stability, poor_stability, stable, unstable
from loopbook.evidence.responses import no_overshoot, overshoots, poorly_damped, well_damped

__all__ = [
    *_of_any_book, "Stability", "good_stability", "no_overshoot", "overshoots", "poor_stability", "poorly_damped",
    "stable", "unstable", "well_damped",
]  # fmt: skip
