"""The limit of stability: the gain with which a loop oscillates for ever, alone and over the times of a controller."""

import math

from loopbook.inputs import real_numbers
from loopbook.stability.counting import count_roots, open_loop
from loopbook.stability.former import limiting_gains
from loopbook.stability.sums import Sums, fraction_sums


def ultimate(process):
    """Return the ultimate gain Ku and the ultimate period Pu: with the gain Ku the loop oscillates with that period.

    Arguments:
        process: transfer function with numbers; dead times may stand anywhere. Of a loop with a controller in it, Ku is
            the factor by which its gain may grow.
    Returns:
        The floats ``(Ku, Pu)``, Pu in the unit of the lags. Ku is the upper end of the lowest range of gains for which
        the closed loop is stable; infinite, with Pu zero, where no gain makes it unstable.
    Raises:
        ValueError: if no positive gain makes the closed loop stable, or as `unstable_poles`.

    >>> import sympy
    >>> from loopbook import s
    >>> Ku, Pu = ultimate(sympy.exp(-s) / s)
    >>> round(Ku, 4), round(Pu, 4)    # pi/2 and 4
    (1.5708, 4.0)
    """
    L = open_loop(process)
    A, B = fraction_sums(L)
    gain, frequency = (float(found[0]) for found in _stable_range(A, B))
    if math.isnan(gain):
        other = _stable_range(-1 * A, B)[0][0]
        hint = "" if math.isnan(other) else ", but a negative one does"
        raise ValueError(f"no positive gain makes the closed loop of {L.expr} stable{hint}")
    return gain, 2 * math.pi / frequency if frequency else math.inf


def boundary_pi(process, Ti):
    """Return the gain Kp on the limit of stability for PI control, Kp*(1 + 1/(Ti*s)), of any process.

    Of a first-order lag with dead time, the limit solves equations (4) and (5) of the source, here without their
    approximation.

    Arguments:
        process: transfer function with numbers; dead times may stand anywhere.
        Ti: integral time in the unit of the lags, a number or an array; ``math.inf`` is not among them.
    Returns:
        Kp, a number or an array: the upper end of the lowest range of positive gains with a stable loop; infinite where
        no gain is too high, nan where no positive one makes the loop stable.
    Raises:
        ValueError: for an integral time that is not positive and finite, or as `ultimate`.
    Source: Syder, Heeg and O'Dwyer, equations (4) and (5), Figure 1.

    >>> import sympy
    >>> from loopbook import s
    >>> boundary_pi(2 * sympy.exp(-1.4 * s) / (0.7 * s + 1), [1, 2]).round(4)
    array([0.5183, 0.671 ])
    """
    return boundary_pid(process, Ti, 0)


def boundary_pid(process, Ti, Td, Tf=0):
    """Return the gain Kp on the limit of stability for PID control, Kp*(1 + 1/(Ti*s) + Td*s/(Tf*s + 1)).

    Arguments:
        process: as for `boundary_pi`.
        Ti, Td, Tf: integral time, derivative time and lag of its filter, in the unit of the lags, numbers or arrays
            that fit together.
    Returns:
        Kp, as `boundary_pi`.
    Raises:
        ValueError: for times that are negative or infinite, Ti = 0, or a loop that is improper without filter.

    >>> import sympy
    >>> from loopbook import s
    >>> round(boundary_pid(sympy.exp(-s) / (s + 1), Ti=2, Td=0.5, Tf=0.05), 4)
    1.7547
    """
    import numpy

    given = [real_numbers(f"values of {name}", x) for name, x in (("Ti", Ti), ("Td", Td), ("Tf", Tf))]
    try:
        Ti, Td, Tf = numpy.broadcast_arrays(*given)
    except ValueError:
        shapes = ", ".join(str(x.shape) for x in given)
        raise ValueError(f"Ti, Td and Tf have the shapes {shapes}: expected numbers, or arrays that fit") from None
    for name, times in (("Ti", Ti), ("Td", Td), ("Tf", Tf)):
        if wrong := [x for x in times.flat if x < 0 or (x == 0 and name == "Ti")]:
            raise ValueError(f"{name} is {wrong[0]:g}: expected a {'positive' if name == 'Ti' else 'finite'} time")
    L = open_loop(process)
    A, B = fraction_sums(L)
    i, d, f = 1 / Ti.ravel(), Td.ravel(), numpy.where(Td > 0, Tf, 0).ravel()
    found = numpy.empty(Ti.size)
    kinds = (d > 0) + 1 * (f > 0)  # PI, and PID without and with filter, are loops of different order
    for kind in set(kinds.tolist()):
        points = kinds == kind
        above, below = (
            part * of_pid for part, of_pid in zip((A, B), _pid(i[points], d[points], f[points]), strict=True)
        )
        order = numpy.flatnonzero(below.coefficients.any(axis=(0, 2)))[-1]
        if above.coefficients[:, order + 1 :].any():
            raise ValueError(f"PID control of {L.expr} without filter is improper: expected a lag Tf that is positive")
        above, below = (Sums(x.coefficients[:, : order + 1], x.delays) for x in (above, below))
        found[points] = _stable_range(above, below)[0]
    found = found.reshape(Ti.shape)
    return found if found.ndim else float(found)


def _pid(i, d, f):
    """Numerator and denominator, times s, of 1 + i/s + d*s/(f*s + 1)."""
    import numpy

    nothing = numpy.zeros((1, len(i)))
    return (
        Sums(numpy.array([[i, 1 + i * f, f + d]]), nothing),
        Sums(numpy.array([[0 * i, 1 + 0 * i, f]]), nothing),
    )


def _stable_range(A, B):
    """The upper end of the lowest range of gains for which loops are stable, and its frequency; nan without such."""
    import numpy

    found, frequency, lower = numpy.full(A.count, math.nan), numpy.full(A.count, math.nan), numpy.zeros(A.count)
    searched = numpy.ones(A.count, dtype=bool)

    def stable(which, gain):
        return count_roots(B[which] + gain * A[which]) == 0

    for points, gains, frequencies, top, endless in limiting_gains(A, B):
        # one after the other in each loop: is it stable between this gain and the one before?
        new = searched[points] & (gains > lower[points]) & (gains < top[points])
        points, gains, frequencies = (x[new] for x in (points, gains, frequencies))
        order = numpy.lexsort((gains, points))
        points, gains, frequencies = (x[order] for x in (points, gains, frequencies))
        while len(points):
            which, first = numpy.unique(points, return_index=True)
            good = stable(which, (lower[which] + gains[first]) / 2)
            found[which[good]], frequency[which[good]] = gains[first][good], frequencies[first][good]
            searched[which[good]] = False
            lower[which] = gains[first]
            left = searched[points]
            left[first] = False
            points, gains, frequencies = (x[left] for x in (points, gains, frequencies))
        last = numpy.flatnonzero(searched & (top == endless))
        if len(last):
            beyond = numpy.where(endless < math.inf, (lower + endless) / 2, 2 * lower + 1)
            good = last[stable(last, beyond[last])]
            found[good], frequency[good] = endless[good], math.inf
            searched[last] = False
        if not searched.any():
            return found, frequency
    last = numpy.flatnonzero(searched)
    highest = numpy.maximum(top, lower)
    if (last := last[stable(last, (lower + highest)[last] / 2)]).size:
        raise ValueError(
            f"no gain on the limit of stability was found up to {highest[last[0]]:.3g}, where the loop is still stable"
        )
    return found, frequency


def boundary_pi_approximate(T, delay, Ti, K=1):
    """Return the gain Kp on the limit of stability for PI control of a lag with dead time, as the source approximates.

    The difference of two arc tangents in equation (5) is one, of x = w*(Ti - T)/(1 + w**2*T*Ti). Where abs(x) <= 1 it
    is replaced by pi/4*x, which makes (5) the cubic equation (6); elsewhere by pi/2 - pi/(4*x), which makes it the
    quadratic equation (7). A root counts where it is positive and its x lies in the branch from which it came. Of
    several the lowest frequency is taken, as in the exact problem.

    The second branch is printed for x > 1 alone: for x < -1 it would need -pi/2. As abs(x) is never above
    abs(Ti - T)/(2*sqrt(Ti*T)), it is needed only for Ti > 5.8 T, and the other one for Ti < 0.17 T. There, and wherever
    no root lies in its branch, the result is nan.

    Arguments:
        T, delay: lag and dead time of the process, positive.
        Ti: integral time, in the same unit; a number or an array.
        K: gain of the process, positive.
    Returns:
        Kp, a number or an array.
    Raises:
        ValueError: for numbers that are not positive.
    Source: Syder, Heeg and O'Dwyer, equations (4), (6) and (7).

    >>> round(boundary_pi_approximate(0.7, 1.4, 1, K=2), 4)    # without approximation 0.5183
    0.5094
    """
    import numpy

    Ti = real_numbers("values of Ti", Ti)
    for name, value in (("T", T), ("delay", delay), ("K", K), ("Ti", Ti)):
        if not (real_numbers(f"values of {name}", value) > 0).all():
            raise ValueError(f"{name} is {value}: expected a positive number")
    T, delay, K = float(T), float(delay), float(K)
    found = numpy.full(Ti.size, math.nan)
    for number, I in enumerate(Ti.flat):
        cubic = [4 * delay * I * T / math.pi, -2 * I * T, (4 * delay - math.pi * I + math.pi * T) / math.pi, -2]
        quadratic = [delay * (I - T) + math.pi / 4 * I * T, -math.pi * (I - T), math.pi / 4]
        valid = []
        for equation, outer in ((cubic, False), (quadratic, True)):
            for root in numpy.roots(equation):
                w = root.real
                x = w * (I - T) / (1 + w**2 * I * T)
                if abs(root.imag) <= 1e-9 * abs(root) and w > 0 and (x > 1 if outer else abs(x) <= 1):
                    valid.append(w)
        if valid:
            w = min(valid)
            found[number] = I * w / K * math.sqrt((1 + (w * T) ** 2) / (1 + (w * I) ** 2))
    found = found.reshape(Ti.shape)
    return found if found.ndim else float(found)
