"""What nbgrader's notebooks of earlier releases import."""

from exercisegrader.nbgrader import earned

__all__ = ["earned"]
