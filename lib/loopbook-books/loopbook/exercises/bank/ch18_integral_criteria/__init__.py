"""Exercises of chapter 18, integral criteria: what they punish, and how they are computed."""
