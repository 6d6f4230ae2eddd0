"""The published tuning rules, each a line of formulas beside its source.

A rule takes a process as an `SOPDT` or whatever `model_of` reads, or the result of an experiment, and returns `PID`
settings; all of it numbers or symbols. A negative gain of the process makes a negative Kp, and all times are positive.
No rule names a filter for the derivative term: `PID.with_filter` adds one. `RULES` has all of them, with what they
start from, which settings they have, and where they are from.
"""

import importlib
import pkgutil

# the names of the rules are here for editors and type checkers; what __all__ has of them comes from the registry
from loopbook.tuning.experiments import (  # noqa: F401
    good_gain,
    hang,
    modified_ziegler_nichols,
    tyreus_luyben,
    ziegler_nichols_ultimate,
)
from loopbook.tuning.registry import RULES, Rule, rule
from loopbook.tuning.skogestad import adjusted, closed_loop_time, simc, skogestad_integral_time  # noqa: F401
from loopbook.tuning.step_response_rules import cohen_coon, itae, ziegler_nichols_reaction  # noqa: F401
from loopbook.tuning.weighted import WeightedPID

for _module in pkgutil.iter_modules(__path__):  # a rule in a module of its own is found by itself
    importlib.import_module(f"{__name__}.{_module.name}")
globals().update({name: found.function for name, found in RULES.items()})

__all__ = [
    "RULES", "Rule", "WeightedPID", "adjusted", "closed_loop_time", "rule", "skogestad_integral_time", *RULES,
]  # fmt: skip
