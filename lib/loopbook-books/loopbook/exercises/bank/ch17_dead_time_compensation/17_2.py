"""What exercise 17.2 needs."""
