"""Exercises of chapter 7, feedback control."""
