"""Exercises of chapter 13, poles and zeros."""
