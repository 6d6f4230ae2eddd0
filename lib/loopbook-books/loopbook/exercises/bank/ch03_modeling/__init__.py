"""Exercises of chapter 3, mathematical modeling."""
