"""Bodies in motion: the momentum balance."""

import sympy

from loopbook.expressions import t
from loopbook.plants.plant import Plant, parameters, signals

__all__ = ["MassSpringDamper", "MotorWithLoad"]


class MassSpringDamper(Plant):
    """A mass on a spring and a damper, moved by a force. (Haugen, Example 2.1, equation 2.3)

    The book prints K and F. The mass and the damping are ours.
    """

    y, F = signals("y F")
    m, D, K = parameters("m D K")
    model = sympy.Eq(m * y.diff(t, 2), F - D * y.diff(t) - K * y)
    output, manipulated = y, F
    quantities = {
        m: (20, "kg", "mass"),
        D: (4, "N/(m/s)", "damping constant"),
        K: (2, "N/m", "spring constant"),
        F: (0, "N", "applied force"),
        y: (0, "m", "position"),
    }


class MotorWithLoad(Plant):
    """A motor that moves a load along a line, by a gear and a rod. (Haugen, Example 3.4, equation 3.33)

    The book prints no values; these are ours.
    """

    y, i_m, F_L = signals("y i_m F_L")
    m, J, r, K_T = parameters("m J r K_T")
    model = sympy.Eq((m + J / r**2) * y.diff(t, 2), K_T / r * i_m - F_L)
    output, manipulated = y, i_m
    quantities = {
        m: (10, "kg", "mass of rod and load"),
        J: (0.004, "kg m²", "moment of inertia of motor and gear"),
        r: (0.02, "m", "radius of the gear"),
        K_T: (0.1, "N m/A", "torque constant of the motor"),
        i_m: (0, "A", "motor current"),
        F_L: (0, "N", "load force"),
        y: (0, "m", "position"),
    }
