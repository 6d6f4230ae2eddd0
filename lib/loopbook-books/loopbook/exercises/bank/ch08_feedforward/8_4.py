"""Python beside the page of exercise 8.4."""

import numpy as np


def largest(theta, P, k):
    """The amplitude of what is left of a sinusoid by another one of k times its size, by trying."""
    turns = np.linspace(0, 2, 4001)
    return max(abs(np.sin(2 * np.pi * turns) - float(k) * np.sin(2 * np.pi * (turns - float(theta / P)))))
