"""Exercises for other systems: files that these import, with what can be said of an answer beforehand."""
