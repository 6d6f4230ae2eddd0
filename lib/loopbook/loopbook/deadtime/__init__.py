"""Linear systems with exact dead time: algebra, responses in time, frequency response.

A system is a fraction of sums of polynomials in `s`, each with a dead time ``exp(-delay*s)``. Everything is computed
from that, without a Pade approximation or a time step: `System` for block diagrams, `loops.Loop` for a process under
control.
"""

from loopbook.deadtime.response import Response
from loopbook.deadtime.state_space import ChannelModel
from loopbook.deadtime.system import System, closed_loop
from loopbook.quasipolynomials import normal_form
from loopbook.transfer import transfer_function

__all__ = [
    "ChannelModel", "Response", "System", "closed_loop", "normal_form", "transfer_function",
]  # fmt: skip
