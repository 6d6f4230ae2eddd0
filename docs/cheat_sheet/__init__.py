"""The cheat sheet: what stands on it, how its formulas are written, and how the page is drawn."""
