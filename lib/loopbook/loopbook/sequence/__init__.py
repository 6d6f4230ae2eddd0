"""Sequential function charts as data: steps, actions and transitions, checked before they run. (Haugen, Chapter 12)"""

from loopbook.sequence.chart import Chart, Scans, scan_by_scan
from loopbook.sequence.formulas import Formula
from loopbook.sequence.transitions import Transition

__all__ = ["Chart", "Formula", "Scans", "Transition", "scan_by_scan"]
