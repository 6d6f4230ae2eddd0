"""Exercises of chapter 2, block diagrams and state-space models."""
