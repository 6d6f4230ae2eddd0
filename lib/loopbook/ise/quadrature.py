"""Parseval's integral in numbers, for any dead times, with what E is for large s taken out."""

import math

from loopbook.ise.error import NotApplicableError

ERROR = 1e-9


def by_quadrature(fraction):
    """Parseval's integral, after what E is for large s has been taken out and integrated by a formula."""
    import numpy

    fraction.need_retarded()
    speed = fraction.speed
    above, above_delays, below, below_delays = fraction.arrays(speed)
    longest = below_delays.max()
    size, powers = abs(below), numpy.arange(below.shape[1])

    def D(w):
        return _sum(below, below_delays, w)

    expansion, rest = _for_large_s(above, above_delays, below, below_delays, fraction.pole)

    def integrand(w):
        asymptotic = sum(c * (1j * w + 1) ** -k * numpy.exp(-1j * w * delay) for (delay, k), c in expansion.items())
        E = _sum(above, above_delays, w) / D(w) / (1j * w) ** fraction.pole
        return abs(E) ** 2 - abs(asymptotic) ** 2

    def near(center, radius):  # whether a pole may lie within two radii
        far = center + 2 * radius
        growth = numpy.exp(2 * radius[:, None] * below_delays)
        terms = size[:, 1:] * powers[1:]
        slope = numpy.stack([numpy.polyval(row[::-1], far) for row in terms], axis=1)
        slope = slope + below_delays * numpy.stack([numpy.polyval(row[::-1], far) for row in size], axis=1)
        return (abs(D(center)) <= 2 * radius * (growth * slope).sum(axis=1)) | (2 * radius > numpy.hypot(center, 1))

    nodes, weights = numpy.polynomial.legendre.leggauss(16)
    fewer, their_weights = numpy.polynomial.legendre.leggauss(12)
    # of a unit of time in which the speed is 1; the integrand turns with twice the longest dead time
    longest = max(longest, above_delays.max())
    total, error, begin, end = _square_of_expansion(expansion), 0.0, 0.0, 8.0
    for _ in range(12):
        ends = numpy.linspace(begin, end, 1 + math.ceil((end - begin) * max(longest, 1)))
        a, b = ends[:-1], ends[1:]
        while len(a):
            center, radius = (a + b) / 2, (b - a) / 2
            split = near(center, radius)
            if split.any() and radius[split].min() < 1e-13 * end:
                raise NotApplicableError("a pole lies too near to the imaginary axis")
            c, r = center[~split, None], radius[~split, None]
            one, other = (integrand(c + r * x) @ w * r[:, 0] for x, w in ((nodes, weights), (fewer, their_weights)))
            total += one.sum() / math.pi
            error += abs(one - other).sum() / math.pi
            a, b = numpy.concatenate([a[split], center[split]]), numpy.concatenate([center[split], b[split]])
        left = rest(end) / math.pi
        if error + left <= ERROR * abs(total) / 10:
            return float(total) * speed
        begin, end = end, 2 * end
    raise NotApplicableError(f"an error of {(error + left) / abs(total):.0e} was left")


def _sum(coefficients, delays, w):
    """The value of a sum of polynomials with dead times at s = j w."""
    import numpy

    return sum(
        numpy.polyval(row[::-1] * 1j ** numpy.arange(len(row))[::-1], w) * numpy.exp(-1j * w * delay)
        for row, delay in zip(coefficients, delays, strict=True)
    )


TERMS = 3  # of the expansion for large s


def _for_large_s(above, above_delays, below, below_delays, pole):
    """E for large s as the sum of c exp(-delay*s)/(s + 1)^k, {(delay, k): c}, and a bound of what that leaves out."""
    import numpy

    def in_powers(row, order):  # the polynomial divided by (s + 1)^order, in powers of u = 1/(s + 1)
        shifted = numpy.polynomial.Polynomial(row)(numpy.polynomial.Polynomial([-1, 1])).coef  # in powers of s + 1
        found = numpy.zeros(TERMS + 2)
        for k, c in enumerate(shifted):
            if order - k < len(found):
                found[order - k] += c
        return found

    order = below.shape[1] - 1 + pole
    below = numpy.hstack([numpy.zeros((len(below), pole)), below])
    numerator, denominator = (
        [(round(delay, 12), in_powers(row, order)) for delay, row in zip(delays, rows, strict=True)]
        for delays, rows in ((above_delays, above), (below_delays, below))
    )
    levels = []  # the coefficients of u^k, by their dead times
    for k in range(TERMS + 2):
        level = {}
        for delay, row in numerator:
            level[delay] = level.get(delay, 0.0) + row[k]
        for delay, row in denominator:
            for q in range(1, k + 1):
                for earlier, c in levels[k - q].items():
                    later = round(delay + earlier, 12)
                    level[later] = level.get(later, 0.0) - row[q] * c
        levels.append({delay: c for delay, c in level.items() if c})
    sizes = [sum(map(abs, level.values())) for level in levels]

    def rest(w):
        asymptotic = sum(size / w**k for k, size in enumerate(sizes[:-1]) if k)
        return 4 * asymptotic * sizes[-1] * w**-TERMS / TERMS

    return {(delay, k): c for k, level in enumerate(levels[:-1]) for delay, c in level.items()}, rest


def _square_of_expansion(expansion):
    """The integral of the square of the sum of c t^(k-1)/(k-1)! exp(-t), each beginning at its dead time."""
    total = 0.0
    for (one, k), c in expansion.items():
        for (other, n), d in expansion.items():
            (p, q), apart = ((k - 1, n - 1) if one >= other else (n - 1, k - 1)), abs(one - other)
            # the integral of t^p/p! (t + apart)^q/q! exp(-2 t - apart)
            total += c * d * math.exp(-apart) * sum(
                apart ** (q - r) / math.factorial(q - r) * math.comb(p + r, p) / 2 ** (p + r + 1) for r in range(q + 1)
            )  # fmt: skip
    return total
