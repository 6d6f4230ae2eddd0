"""Exercises of chapter 6, dynamic characteristics."""
