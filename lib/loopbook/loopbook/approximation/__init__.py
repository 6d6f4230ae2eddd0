"""Simple models for complicated processes: Taylor and Pade for dead time, and Skogestad's half rule.

Tuning rules start from an `SOPDT`, a second-order-plus-dead-time model: a gain, one or two lags, and a dead time.
"""

from loopbook.approximation.dead_time import pade, repeated_pade, taylor
from loopbook.approximation.half_rule import half_rule, zero_rule
from loopbook.approximation.model import SOPDT, Step, model_of

__all__ = ["SOPDT", "Step", "half_rule", "model_of", "pade", "repeated_pade", "taylor", "zero_rule"]
