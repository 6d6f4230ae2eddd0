"""Writing exercises of control engineering: `exercisebook.authoring`, and criteria that many designs share."""

from exercisebook import authoring
from exercisebook.authoring import *
from loopbook.exercises.criteria import largest_sensitivity, pi_controller, stable

__all__ = [*authoring.__all__, "largest_sensitivity", "pi_controller", "stable"]
