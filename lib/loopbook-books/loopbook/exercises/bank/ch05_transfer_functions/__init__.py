"""Exercises of chapter 5, transfer functions."""
