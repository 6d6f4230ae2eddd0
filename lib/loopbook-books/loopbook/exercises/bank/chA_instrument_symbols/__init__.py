"""Exercises of appendix A, letters and symbols of P&I diagrams."""
