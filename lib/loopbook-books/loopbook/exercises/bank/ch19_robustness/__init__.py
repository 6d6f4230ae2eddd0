"""Exercises of chapter 19, robustness: margins, unstable poles, and processes that change."""
