"""Control structures: several controllers on one plant, as blocks that read and write signals by their names.

A structure is a list of blocks, which run in this order once a sample: cascade is a loop whose output is another loop's
setpoint, ratio control is a multiplication in between, split range is one signal shared out among several valves.
"""

from loopbook.structures.action import controller_action
from loopbook.structures.blocks import Calculation, ControlLoop, SplitRange
from loopbook.structures.structure import Structure

__all__ = ["Calculation", "ControlLoop", "SplitRange", "Structure", "controller_action"]
