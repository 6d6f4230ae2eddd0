"""Simple models for complicated processes: Taylor and Pade for dead time, and Skogestad's half rule.

A `Model` is what the tuning rules start from: a gain, one or two lags, and a dead time.
"""

from loopbook.approximation.dead_time import pade, repeated_pade, taylor
from loopbook.approximation.half_rule import Step, half_rule, zero_rule
from loopbook.approximation.model import Model, model_of

__all__ = ["Model", "Step", "half_rule", "model_of", "pade", "repeated_pade", "taylor", "zero_rule"]
