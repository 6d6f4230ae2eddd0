"""Integral criteria of control loops with exact dead time: the integral of the squared error, and its relatives.

The integral of e(t)^2 is, by Parseval's theorem, 1/(2 pi j) times that of E(s) E(-s) along the imaginary axis. With one
dead time it is a sum of residues (Marshall, Gorecki, Korytowski and Walton, 1992), which gives closed formulas; with
dead times that are multiples of one it follows from a boundary value problem of linear differential equations; and it
can always be integrated numerically. All of this holds for stable loops only, and is plausible but wrong for others.
"""

from loopbook.ise.closed_form import pi_first_order, symbolic_pi_first_order
from loopbook.ise.error import UnstableLoopError
from loopbook.ise.family import ise_family
from loopbook.ise.loops import integral_of_square, ise
from loopbook.ise.residue_method import ResidueMethod, residue_method
from loopbook.ise.responses import Criteria, criteria

__all__ = [
    "Criteria", "ResidueMethod", "UnstableLoopError", "criteria", "integral_of_square", "ise", "ise_family",
    "pi_first_order", "residue_method", "symbolic_pi_first_order",
]  # fmt: skip
