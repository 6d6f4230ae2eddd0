"""Exercises of chapter 11, control structures."""
