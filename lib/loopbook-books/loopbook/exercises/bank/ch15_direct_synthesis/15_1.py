"""What exercise 15.1 needs."""

from loopbook import first_order
from loopbook.synthesis import direct_synthesis

__all__ = ["direct_synthesis", "first_order"]
