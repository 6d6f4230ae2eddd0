"""Exercises of chapter 16, tuning relations."""
