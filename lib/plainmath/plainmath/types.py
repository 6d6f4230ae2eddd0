"""Names for what many functions take, as their type hints write it."""

from __future__ import annotations

from fractions import Fraction
from typing import TypeAlias

import sympy

__all__ = ["Number"]

#: A number of any kind; an expression where symbols may stand.
Number: TypeAlias = float | int | Fraction | sympy.Expr
