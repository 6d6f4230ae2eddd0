"""Python beside the page of exercise 13.8."""

import numpy as np
import sympy


def matrix(a_11, a_12, a_21, a_22):
    """The matrix of two states."""
    return sympy.ImmutableMatrix([[a_11, a_12], [a_21, a_22]])


def by_numpy(A):
    """The eigenvalues of a matrix, the one with the largest real part first."""
    found = np.linalg.eigvals(np.array(A, dtype=complex)).round(9)
    return [sympy.sympify(value) for value in np.sort_complex(found)[::-1].tolist()]


def largest_real(A):
    """The largest real part of an eigenvalue."""
    return largest(by_numpy(A))


def largest(values):
    """The largest real part of some numbers."""
    return max(sympy.re(value) for value in values)


def written(value):
    """An eigenvalue, as a formula."""
    value = complex(value)
    sign = "-" if value.imag < 0 else "+"
    return rf"{value.real:g} {sign} {abs(value.imag):g}\,j" if value.imag else f"{value.real:g}"
