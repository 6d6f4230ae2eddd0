"""Python beside the page of exercise 13.8."""

import numpy as np
import sympy

from loopbook.figures import time_plot


def matrix(a_11, a_12, a_21, a_22):
    """The matrix of two states."""
    return sympy.ImmutableMatrix([[a_11, a_12], [a_21, a_22]])


def by_numpy(A):
    """The eigenvalues of a matrix, the one with the largest real part first."""
    found = np.linalg.eigvals(np.array(A, dtype=complex)).round(9)
    return [sympy.sympify(value) for value in np.sort_complex(found)[::-1].tolist()]


def largest_real(A):
    """The largest real part of an eigenvalue."""
    return max(sympy.re(value) for value in by_numpy(A))


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
