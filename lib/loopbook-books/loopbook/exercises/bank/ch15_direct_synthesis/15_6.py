"""What exercise 15.6 needs."""

from loopbook import Loop, margins, second_order
from loopbook.synthesis import imc

__all__ = ["Loop", "imc", "margins", "second_order"]
