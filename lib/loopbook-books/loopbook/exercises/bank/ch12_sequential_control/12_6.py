"""Python beside the page of exercise 12.6."""


def integral(A, K_v, h_0, h_1):
    """The time of emptying as the integral over the level, in s; K_v is in litres."""
    from scipy.integrate import quad  # not before it is asked: a page of the site loads it then

    return quad(lambda h: float(1000 * A / K_v) / h**0.5, float(h_0), float(h_1))[0]
