"""The loop of exercise 15.3."""

from loopbook import Loop, first_order


def solution_picture(K, T, delay, controller):
    """The Nyquist curve of the loop. It crosses the negative real axis well to the right of the point minus one."""
    return Loop(first_order(K, T, delay), controller).nyquist()
