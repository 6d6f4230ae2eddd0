"""A first use of what submissions in control engineering use, before the grader's process forks for each of them."""

from __future__ import annotations

import contextlib

import numpy as np


def rehearse() -> None:
    """Import the libraries, and do with each of them something of what a student does."""
    import ipywidgets  # noqa: F401 - the import is what takes time
    import scipy.integrate
    import scipy.optimize
    import scipy.signal

    from loopbook.exercises import exercise
    from loopbook.loops import Loop
    from loopbook.pid import PID
    from loopbook.transfer import first_order
    from loopbook.tuning import simc

    with contextlib.suppress(ImportError):  # students use it, this library does without it
        import control

        lag = control.tf([2], [3, 1])
        control.step_response(lag), control.poles(control.feedback(lag)), control.margin(lag), control.tf2ss(lag)
        control.frequency_response(lag, [0.1, 1])

    scipy.integrate.solve_ivp(lambda time, y: -y, (0, 1), [1.0]), scipy.optimize.brentq(np.cos, 0, 3)
    scipy.signal.step(scipy.signal.TransferFunction([1], [1, 1]))
    process = first_order(2, 5, delay=1)
    Loop(process, simc(process, Tc=1)).servo.step(np.linspace(0, 10, 11)), PID(1, Ti=2).expr
    exercise("10.1").check(K=1)
