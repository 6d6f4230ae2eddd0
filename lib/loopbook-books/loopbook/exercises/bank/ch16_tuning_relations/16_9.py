"""What exercise 16.9 needs."""

from loopbook import integrator
from loopbook.stability import dominant_poles


def first_pole(gain, delay):
    """The first pole of a loop of an integrator with dead time, the one above the real axis."""
    return max(dominant_poles(integrator(gain, delay)), key=lambda pole: pole.imag)
