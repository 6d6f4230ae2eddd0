"""What exercise 17.3 needs."""
