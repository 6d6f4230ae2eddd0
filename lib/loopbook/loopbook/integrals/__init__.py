"""Integral criteria of control loops with exact dead time: the integral of the squared error, and its relatives.

The integral of e(t)^2 is, by Parseval's theorem, 1/(2 pi j) times that of E(s) E(-s) along the imaginary axis. With one
dead time it is a sum of residues (Marshall, Gorecki, Korytowski and Walton, 1992), which gives closed formulas. With
any dead times it is that over the exact response, followed until its slowest modes are left. The sum of residues holds
for stable loops only, and is plausible but wrong for others: hence the proof of stability before it.
"""

from loopbook.integrals.closed_form import pi_first_order
from loopbook.integrals.error import UnstableLoopError
from loopbook.integrals.loops import integral_of_square, ise
from loopbook.integrals.residue_method import ResidueMethod, residue_method
from loopbook.integrals.responses import Criteria, criteria

__all__ = [
    "Criteria", "ResidueMethod", "UnstableLoopError", "criteria", "integral_of_square", "ise", "pi_first_order",
    "residue_method",
]  # fmt: skip
