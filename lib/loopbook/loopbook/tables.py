"""Quantities with their names and units, and tables of them: `plainmath.tables`."""

from plainmath.tables import Table, quantities, rounded, table

__all__ = ["Table", "quantities", "rounded", "table"]
