"""The published tuning rules, each a line of formulas beside its source.

A rule takes a process as an `SOPDT` or whatever `model_of` reads, or the result of an experiment, and returns `PID`
settings; all of it numbers or letters. A negative gain of the process makes a negative Kp, and all times are positive.
No rule names a filter for the derivative term: `PID.with_filter` adds one.
"""

from loopbook.tuning.experiments import (
    WeightedPID,
    good_gain,
    hang,
    modified_ziegler_nichols,
    tyreus_luyben,
    ziegler_nichols_ultimate,
)
from loopbook.tuning.reaction_curves import cohen_coon, itae, ziegler_nichols_reaction
from loopbook.tuning.skogestad import adjusted, closed_loop_time, simc, skogestad_integral_time

__all__ = [
    "WeightedPID", "adjusted", "closed_loop_time", "cohen_coon", "good_gain", "hang", "itae",
    "modified_ziegler_nichols", "simc", "skogestad_integral_time", "tyreus_luyben", "ziegler_nichols_reaction",
    "ziegler_nichols_ultimate",
]  # fmt: skip
