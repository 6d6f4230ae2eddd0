"""Exercises of chapter 10, tuning of PID controllers."""
