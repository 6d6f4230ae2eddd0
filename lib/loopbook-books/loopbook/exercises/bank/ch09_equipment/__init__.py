"""Exercises of chapter 9, controller equipment."""
