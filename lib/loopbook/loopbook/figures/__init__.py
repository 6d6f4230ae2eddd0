"""Figures in one look: signals against time, curves and areas in a plane, runs of a sequence, bars."""

from loopbook.figures.bars import half_rule_plot
from loopbook.figures.picture import Picture, stacked
from loopbook.figures.plane import PlanePlot, level_plot, map_plot, plane_plot
from loopbook.figures.sequences import sequence_trends
from loopbook.figures.time import TimePlot, time_plot, trends

__all__ = [
    "Picture", "PlanePlot", "TimePlot", "half_rule_plot", "level_plot", "map_plot", "plane_plot", "sequence_trends",
    "stacked", "time_plot", "trends",
]  # fmt: skip
