"""What is found in wrong answers of the kinds of control engineering."""
