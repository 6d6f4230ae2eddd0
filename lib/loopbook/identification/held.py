"""The output of simple processes at the samples, exact, for a control signal that is held between them.

A held signal that arrives late by a dead time changes once between two samples. The matrix exponential gives what it
does before and after this change, so that neither a Pade approximation nor a small step is needed.
"""

import math

TERMS = 15  # of the series of the exponential of a number below 1/2

KINDS = {  # how many lags, and how many integrators
    "first order": (1, 0),
    "second order": (2, 0),
    "integrator": (0, 1),
    "integrator with lag": (1, 1),
}


def chain(kind, lags):
    """Return A and B of a chain of lags, and perhaps an integrator at its end, with gain one; the output is its end."""
    import numpy

    rates = [1 / T for T in lags] + [0.0] * KINDS[kind][1]
    inflow = [1 / T for T in lags] + [1.0] * KINDS[kind][1]
    A = numpy.diag([-rate for rate in rates])
    A[range(1, len(rates)), range(len(rates) - 1)] = inflow[1:]
    B = numpy.zeros(len(rates))
    B[0] = inflow[0]
    return A, B


def responses(kind, lags, delay, step, u):
    """Return the response to the held input u, at rest before with u = 0, and the free ones.

    Returns:
        An array with a value for each sample, and one with a column for each way to move without that input: one for
        each state that is 1 at the first sample, the last one for a constant input of 1.
    """
    import numpy

    A, B = chain(kind, lags)
    n = len(B)
    whole = math.floor(delay / step)
    late = delay - whole * step  # after a sample, so long the input before it still acts
    extended = numpy.zeros((n + 1, n + 1))
    extended[:n, :n], extended[:n, n] = A, B
    over_step, over_rest = _exponential(extended * step), _exponential(extended * (step - late))
    transition, both, newer = over_step[:n, :n], over_step[:n, n], over_rest[:n, n]
    older = both - newer
    arrived = numpy.concatenate([numpy.zeros(whole + 1), u])[: len(u) + 1]
    drive = numpy.outer(arrived[:-1], older) + numpy.outer(arrived[1:], newer)
    forced = _states(transition, drive, numpy.zeros(n))[:, -1]
    nothing = numpy.zeros((len(u), n))
    free = [_states(transition, nothing, numpy.eye(n)[k])[:, -1] for k in range(n)]
    free.append(_states(transition, nothing + both, numpy.zeros(n))[:, -1])
    return forced, numpy.column_stack(free)


def _exponential(M):
    """The exponential of a small matrix: its series, for a part of it that is small, squared again and again.

    A search calls this thousands of times; `scipy.linalg.expm` solves equations in it, on several threads.
    """
    import numpy

    halvings = max(0, math.frexp(abs(M).sum(axis=1).max())[1] + 1)
    M = M / 2**halvings
    total = term = numpy.eye(len(M))
    for n in range(1, TERMS):
        term = term @ M / n
        total = total + term
    for _ in range(halvings):
        total = total @ total
    return total


def _states(transition, drive, initial):
    """The states at all samples, x[k+1] = transition x[k] + drive[k]: one after the other along the chain."""
    import numpy
    from scipy.signal import lfilter

    x = numpy.empty_like(drive)
    for i in range(len(initial)):
        from_before = x[:-1, :i] @ transition[i, :i] + drive[:-1, i]
        x[:, i] = lfilter([1.0], [1.0, -transition[i, i]], numpy.concatenate([initial[i : i + 1], from_before]))
    return x
