"""Exercises of chapter 1, introduction to control."""
