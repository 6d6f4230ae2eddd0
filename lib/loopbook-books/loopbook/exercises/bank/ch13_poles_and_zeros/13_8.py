"""The matrix of exercise 13.8, and how its numbers are written."""

import numpy as np
import sympy

from loopbook.exercises.bank.ch13_poles_and_zeros.shared import factor
from loopbook.figures import time_plot


def matrix(a_11, a_12, a_21, a_22):
    """The matrix of two states."""
    return sympy.ImmutableMatrix([[a_11, a_12], [a_21, a_22]])


def are_eigenvalues(values, A):
    """Whether numbers are the eigenvalues of a matrix, by numpy."""
    found = np.linalg.eigvals(np.array(A, dtype=float))
    return np.allclose(np.sort_complex(found), np.sort_complex([complex(value) for value in values]))


def largest_real(A):
    """The largest real part of an eigenvalue, by numpy."""
    return float(max(np.linalg.eigvals(np.array(A, dtype=float)).real))


def polynomial_of(trace, det):
    """The characteristic polynomial, as a formula."""

    def sign(value):
        return "-" if value < 0 else "+"

    return rf"\lambda^2 {sign(-trace)} {factor(abs(trace))}\lambda {sign(det)} {abs(float(det)):.4g}"


def in_brackets(value):
    """A number within a product or a power: a negative one in brackets."""
    return f"({float(value):.4g})" if value < 0 else f"{float(value):.4g}"


def written(value):
    """An eigenvalue, as a formula."""
    value = complex(value)
    sign = "-" if value.imag < 0 else "+"
    return rf"{value.real:g} {sign} {abs(value.imag):g}\,j" if value.imag else f"{value.real:g}"


def solution_picture(A, p):
    """Both states after a small disturbance of the first one."""
    times = np.linspace(0, 2.5 / float(p), 301)
    values, vectors = np.linalg.eig(np.array(A, dtype=float))
    shares = np.linalg.solve(vectors, np.array([1, 0]))
    x_1, x_2 = (vectors @ (shares[:, None] * np.exp(np.outer(values, times)))).real
    return time_plot({"$x_1$": x_1, "$x_2$": x_2}, times, xlabel="$t$ [min]", ylabel="deviation [%]", low=True)
