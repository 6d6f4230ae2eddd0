"""Exercises of chapter 15, direct synthesis: from the wish to the controller."""
