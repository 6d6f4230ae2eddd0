"""Bodies in motion: the momentum balance."""

from loopbook.plants.declarations import Balance, parameter, signal
from loopbook.plants.plant import Plant
from plainmath.expressions import t

__all__ = ["MassSpringDamper", "MotorWithLoad"]


class MassSpringDamper(Plant):
    """A mass on a spring and a damper, moved by a force. (Haugen, Example 2.1, equation 2.3)

    The book prints K and F. The mass and the damping are ours.
    """

    m = parameter(20, "kg", "mass")
    D = parameter(4, "N/(m/s)", "damping constant")
    K = parameter(2, "N/m", "spring constant")
    F = signal(0, "N", "applied force")
    y = signal(0, "m", "position")

    momentum = Balance(m * y.diff(t), F - D * y.diff(t) - K * y)
    output, manipulated = y, F
    at_work = {F: 2, y: 1}


class MotorWithLoad(Plant):
    """A motor that moves a load along a line, by a gear and a rod. (Haugen, Example 3.4, equation 3.33)

    The book prints no values; these are ours.
    """

    m = parameter(10, "kg", "mass of rod and load")
    J = parameter(0.004, "kg m²", "moment of inertia of motor and gear")
    r = parameter(0.02, "m", "radius of the gear")
    K_T = parameter(0.1, "N m/A", "torque constant of the motor")
    i_m = signal(0, "A", "motor current")
    F_L = signal(0, "N", "load force")
    y = signal(0, "m", "position")

    momentum = Balance((m + J / r**2) * y.diff(t), K_T / r * i_m - F_L)
    output, manipulated = y, i_m
    at_work = {i_m: 1, F_L: 5}
