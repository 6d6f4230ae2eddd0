"""Exercises of chapter 14, model approximation."""
