"""The Nyquist curve of exercise 19.1."""

from loopbook import PID, Loop, first_order


def solution_picture(K, T, delay, Kc):
    """The Nyquist curve with the unit circle, and the two crossings at which gain and phase margin are read."""
    return Loop(first_order(K, T, delay), PID(Kc, T)).nyquist()
