"""What exercise 16.3 needs."""

from loopbook.oscillation import oscillation
from loopbook.transfer import feedback, static_gain

__all__ = ["feedback", "oscillation", "static_gain"]
