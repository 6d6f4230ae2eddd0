"""loopbook: process control by computation, with the books' printed numbers as its proof.

What is wanted most often is here; it is imported when it is first used.

>>> import loopbook as lb
>>> lb.Loop(lb.first_order(2, 5, delay=4), lb.PID(0.5, Ti=5)).margins().gain_margin.__round__(4)
1.9635
"""

from __future__ import annotations

import importlib
import pkgutil
from typing import TYPE_CHECKING

from sympy.printing.defaults import Printable

from plainmath.expressions import s, t
from plainmath.tables import typeset

# the chapters, exercises and ledgers are a package of their own, with names within this one
__path__ = pkgutil.extend_path(__path__, __name__)

if TYPE_CHECKING:
    from loopbook.approximation import half_rule as half_rule
    from loopbook.deadtime import System as System
    from loopbook.deadtime import closed_loop as closed_loop
    from loopbook.families import Family as Family
    from loopbook.identification import fit as fit
    from loopbook.integrals import criteria as criteria
    from loopbook.integrals import ise as ise
    from loopbook.loops import Loop as Loop
    from loopbook.pid import PID as PID
    from loopbook.stability import delay_margin as delay_margin
    from loopbook.stability import is_stable as is_stable
    from loopbook.stability import margins as margins
    from loopbook.stability import stability_map as stability_map
    from loopbook.stability import ultimate as ultimate
    from loopbook.transfer import dead_time as dead_time
    from loopbook.transfer import first_order as first_order
    from loopbook.transfer import integrator as integrator
    from loopbook.transfer import integrator_with_lag as integrator_with_lag
    from loopbook.transfer import second_order as second_order
    from loopbook.tuning import simc as simc

_HOMES = {
    "Family": "families", "Loop": "loops", "PID": "pid", "System": "deadtime", "closed_loop": "deadtime",
    "criteria": "integrals", "dead_time": "transfer", "delay_margin": "stability", "first_order": "transfer",
    "fit": "identification", "half_rule": "approximation", "integrator": "transfer",
    "integrator_with_lag": "transfer", "ise": "integrals", "is_stable": "stability", "margins": "stability",
    "second_order": "transfer", "simc": "tuning", "stability_map": "stability", "ultimate": "stability",
}  # fmt: skip

__all__ = ["s", "t", *_HOMES]


def __getattr__(name: str) -> object:
    if name not in _HOMES:
        raise AttributeError(f"module 'loopbook' has no attribute {name!r}")
    return getattr(importlib.import_module(f"loopbook.{_HOMES[name]}"), name)


def __dir__() -> list[str]:
    return sorted(__all__)


# Notebooks show SymPy's formulas with falling powers of s, as K e^(-tau s)/(T s + 1).
Printable._repr_latex_ = typeset
