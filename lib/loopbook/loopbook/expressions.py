"""The symbols s and t, and `plainmath.expressions` for whoever works with this library alone."""

from plainmath.expressions import agreement, exact, function_of, parse, s, t, written

__all__ = ["agreement", "exact", "function_of", "parse", "s", "t", "written"]
