"""Exercises of chapter 17, dead-time compensation: what cannot be avoided, and Smith predictors."""
