"""Exercises of chapter 4, the Laplace transform."""
