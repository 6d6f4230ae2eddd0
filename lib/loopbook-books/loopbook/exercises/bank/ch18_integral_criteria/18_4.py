"""What exercise 18.4 needs."""

from loopbook import PID, Loop, first_order, margins
from loopbook.ise import ise, pi_first_order

__all__ = ["PID", "Loop", "first_order", "ise", "margins", "pi_first_order"]
