"""A reactor that must be heated and cooled."""

import sympy

from loopbook.expressions import t
from loopbook.plants.plant import Plant, parameters, signals

__all__ = ["JacketedReactor"]


class JacketedReactor(Plant):
    """A stirred reactor whose jacket is fed with cold and with hot water. (Haugen, Section 11.3)

    The reaction gives off heat, the feed is cold. Reactor and jacket are always full: what enters leaves, and the flow
    through a valve is proportional to its opening. The book prints no values; these are ours, and the operating point,
    at which a little hot water is needed, is a steady state.
    """

    T, T_j, T_m, u_cold, u_hot, Q, F, T_in, T_cold, T_hot = signals("T T_j T_m u_cold u_hot Q F T_in T_cold T_hot")
    c, m, m_j, U, F_max, tau = parameters("c m m_j U F_max tau")
    cold, hot = F_max * u_cold / 100, F_max * u_hot / 100
    water = c * cold * (T_cold - T_j) + c * hot * (T_hot - T_j)
    model = (
        sympy.Eq(c * m * T.diff(t), Q + c * F * (T_in - T) + U * (T_j - T)),
        sympy.Eq(c * m_j * T_j.diff(t), water - U * (T_j - T)),
        sympy.Eq(T_m, T.subs(t, t - tau)),
    )
    output, manipulated = T_m, u_hot
    balances = {"energy": (c * m * T + c * m_j * T_j, Q + c * F * (T_in - T) + water)}
    quantities = {
        c: (4200, "J/(kg K)", "specific heat capacity of water and of the contents"),
        m: (1000, "kg", "mass in the reactor"),
        m_j: (200, "kg", "mass of water in the jacket"),
        U: (4000, "W/K", "heat transfer coefficient between jacket and reactor"),
        F_max: (1.5, "kg/s", "flow through a valve that is open"),
        tau: (60, "s", "dead time of the measurement"),
        u_cold: (0, "%", "opening of the valve for cold water"),
        u_hot: (sympy.Rational(4000, 147), "%", "opening of the valve for hot water"),
        Q: (9600, "W", "heat of reaction"),
        F: (0.2, "kg/s", "flow of the feed"),
        T_in: (20, "°C", "temperature of the feed"),
        T_cold: (10, "°C", "temperature of the cold water"),
        T_hot: (80, "°C", "temperature of the hot water"),
        T: (60, "°C", "temperature in the reactor"),
        T_j: (66, "°C", "temperature in the jacket"),
        T_m: (None, "°C", "measured temperature of the reactor"),
    }
