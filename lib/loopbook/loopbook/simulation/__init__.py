"""Simulation: a continuous plant, controllers that run once a sample, and signals in time.

Between two samples the control signal is held. A linear plant whose inputs are all held goes from sample to sample by
an exact recurrence, `loopbook.simulation.held`. Any other is integrated from one discontinuity to the next by the
Dormand-Prince method of order 5 (SciPy) to a relative tolerance of 1e-9. Dead time is a delayed signal, exact on any
grid: the moments at which a held signal arrives late are among the discontinuities. Of a delayed state, as behind a
recycle, `loopbook.simulation.delayed_states` keeps the history. A single controller is a control structure of one loop.
"""

from loopbook.simulation.driver import simulate
from loopbook.simulation.run import Run

__all__ = ["Run", "simulate"]
