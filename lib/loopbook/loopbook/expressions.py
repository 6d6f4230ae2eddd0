"""The symbols s and t, and `plainmath.expressions` for whoever works with this library alone."""

from plainmath.expressions import agreement, equalities, exact, function_of, parse, s, t, written

__all__ = ["agreement", "equalities", "exact", "function_of", "parse", "s", "t", "written"]
