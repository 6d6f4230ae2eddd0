"""Exercises of chapter 12, sequential control."""
