"""A first use of what notebooks use: what libraries do once only, they then have done before any submission."""

from __future__ import annotations

import contextlib
import io

import numpy as np


def rehearse() -> None:
    """Import the libraries, and do with each of them something of what a student does."""
    import control
    import ipywidgets  # noqa: F401 - the import is what takes time
    import matplotlib
    import scipy.integrate
    import scipy.optimize
    import scipy.signal
    import sympy

    from loopbook.deadtime import Loop
    from loopbook.exercises import exercise
    from loopbook.expressions import s, t
    from loopbook.pid import PID
    from loopbook.transfer import first_order
    from loopbook.tuning import simc

    matplotlib.use("agg")
    from matplotlib import pyplot

    x, K, T = sympy.symbols("x K T", positive=True)
    H = K / (T * s + 1)
    for expression in (sympy.apart(1 / (x * (x + 1))), sympy.diff(sympy.exp(-x / T), x), sympy.simplify(H + 1 / s)):
        str(expression), sympy.latex(expression), sympy.lambdify(x, expression)
    sympy.solve(x**2 - T, x), sympy.inverse_laplace_transform(1 / (s + 2), s, t)
    sympy.integrate(x * sympy.exp(-x), (x, 0, 1)), sympy.Matrix([[0, 1], [-2, -3]]).eigenvals()

    lag = control.tf([2], [3, 1])
    control.step_response(lag), control.poles(control.feedback(lag)), control.margin(lag), control.tf2ss(lag)
    control.frequency_response(lag, [0.1, 1])
    scipy.integrate.solve_ivp(lambda time, y: -y, (0, 1), [1.0]), scipy.optimize.brentq(np.cos, 0, 3)
    scipy.signal.step(scipy.signal.TransferFunction([1], [1, 1])), np.linalg.eigvals(np.eye(2)), np.roots([1, 2, 3])

    process = first_order(2, 5, delay=1)
    Loop(process, simc(process, Tc=1)).servo.step(np.linspace(0, 10, 11)), PID(1, Ti=2).expr
    exercise("10.1").check(K=1)

    figure, axes = pyplot.subplots()
    axes.plot([0, 1], [0, 1], label="$K$")
    axes.legend(), axes.set_xlabel("time (s)")
    with contextlib.closing(io.BytesIO()) as file:
        figure.savefig(file)
    pyplot.close(figure)
