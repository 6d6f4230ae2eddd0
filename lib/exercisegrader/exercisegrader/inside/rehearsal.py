"""A first use of what notebooks use: what libraries do once only, they then have done before any submission."""

from __future__ import annotations

import contextlib
import io
from importlib import metadata

import numpy as np

#: Entry points of packages that submissions use: each names a module with a function `rehearse` of its own.
GROUP = "exercisegrader.rehearsals"


def rehearse() -> None:
    """Import the libraries, and do with each of them something of what a student does."""
    import matplotlib
    import sympy

    from plainmath.expressions import s, t

    matplotlib.use("agg")
    from matplotlib import pyplot

    x, K, T = sympy.symbols("x K T", positive=True)
    H = K / (T * s + 1)
    for expression in (sympy.apart(1 / (x * (x + 1))), sympy.diff(sympy.exp(-x / T), x), sympy.simplify(H + 1 / s)):
        str(expression), sympy.latex(expression), sympy.lambdify(x, expression)
    sympy.solve(x**2 - T, x), sympy.inverse_laplace_transform(1 / (s + 2), s, t)
    sympy.integrate(x * sympy.exp(-x), (x, 0, 1)), sympy.Matrix([[0, 1], [-2, -3]]).eigenvals()

    np.linalg.eigvals(np.eye(2)), np.roots([1, 2, 3])

    figure, axes = pyplot.subplots()
    axes.plot([0, 1], [0, 1], label="$K$")
    axes.legend(), axes.set_xlabel("time (s)")
    with contextlib.closing(io.BytesIO()) as file:
        figure.savefig(file)
    pyplot.close(figure)
    for plugin in metadata.entry_points(group=GROUP):
        plugin.load().rehearse()
