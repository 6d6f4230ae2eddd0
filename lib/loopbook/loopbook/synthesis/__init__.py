"""From the closed loop that is wanted to the controller: direct synthesis, internal model control, and PID settings.

The controller comes out of the algebra of the loop. A PID controller is then read off exactly, or as the first terms
of its series; which of the two it was is always said.
"""

from loopbook.synthesis.direct import direct_synthesis
from loopbook.synthesis.internal_model import IMC_TABLE, Design, imc, imc_design
from loopbook.synthesis.settings import Match, as_pid

__all__ = ["IMC_TABLE", "Design", "Match", "as_pid", "direct_synthesis", "imc", "imc_design"]
