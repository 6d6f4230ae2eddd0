"""Figures: one look for the whole collection; signals against time, curves and areas in a plane, runs of a sequence."""

from loopbook.figures.picture import Picture
from loopbook.figures.plane import PlanePlot, level_plot, map_plot, plane_plot
from loopbook.figures.sequences import sequence_trends
from loopbook.figures.time import TimePlot, time_plot, trends

__all__ = [
    "Picture", "PlanePlot", "TimePlot", "level_plot", "map_plot", "plane_plot", "sequence_trends", "time_plot",
    "trends",
]  # fmt: skip
