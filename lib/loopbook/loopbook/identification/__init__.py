"""Models and settings from experiments: step responses, logged data, a relay, a P controller, and data as they come."""

from loopbook.identification.adaptive import AdaptiveController
from loopbook.identification.fitting import Fit, fit
from loopbook.identification.good_gain import GoodGain, good_gain_experiment, swing
from loopbook.identification.recursive import RecursiveLeastSquares, first_order_of
from loopbook.identification.relay import LimitCycle, Relay, limit_cycle, relay_experiment
from loopbook.identification.schedule import GainSchedule, ScheduledController
from loopbook.identification.steps import first_order_from_step, integrator_from_step

__all__ = [
    "AdaptiveController", "Fit", "GainSchedule", "GoodGain", "LimitCycle", "RecursiveLeastSquares", "Relay",
    "ScheduledController", "first_order_from_step", "first_order_of", "fit", "good_gain_experiment",
    "integrator_from_step", "limit_cycle", "relay_experiment", "swing",
]  # fmt: skip
