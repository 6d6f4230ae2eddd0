"""Exercises of chapter 8, feedforward control."""
