"""Exercises that are written as pages of text."""
