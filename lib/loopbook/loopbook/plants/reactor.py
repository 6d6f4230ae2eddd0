"""A reactor that must be heated and cooled."""

import sympy

from loopbook.plants.declarations import Balance, delayed, measured, parameter, signal
from loopbook.plants.plant import Plant

__all__ = ["JacketedReactor"]


class JacketedReactor(Plant):
    """A stirred reactor whose jacket is fed with cold and with hot water. (Haugen, Section 11.3)

    The reaction gives off heat, the feed is cold. Reactor and jacket are always full: what enters leaves, and the flow
    through a valve is proportional to its opening. The book prints no values; these are ours, and the operating point,
    at which a little hot water is needed, is a steady state.
    """

    c = parameter(4200, "J/(kg K)", "specific heat capacity of water and of the contents")
    m = parameter(1000, "kg", "mass in the reactor")
    m_j = parameter(200, "kg", "mass of water in the jacket")
    U = parameter(4000, "W/K", "heat transfer coefficient between jacket and reactor")
    F_max = parameter(1.5, "kg/s", "flow through a valve that is open")
    tau = parameter(60, "s", "dead time of the measurement")
    u_cold = signal(0, "%", "opening of the valve for cold water")
    u_hot = signal(sympy.Rational(4000, 147), "%", "opening of the valve for hot water")
    Q = signal(9600, "W", "heat of reaction")
    F = signal(0.2, "kg/s", "flow of the feed")
    T_in = signal(20, "°C", "temperature of the feed")
    T_cold = signal(10, "°C", "temperature of the cold water")
    T_hot = signal(80, "°C", "temperature of the hot water")
    T = signal(60, "°C", "temperature in the reactor")
    T_j = signal(66, "°C", "temperature in the jacket")
    T_m = measured(delayed(T, tau), "°C", "measured temperature of the reactor")

    cold, hot = F_max * u_cold / 100, F_max * u_hot / 100
    exchanged = U * (T_j - T)
    energy_of_the_contents = Balance(c * m * T, Q + c * F * (T_in - T) + exchanged)
    energy_of_the_jacket = Balance(c * m_j * T_j, c * cold * (T_cold - T_j) + c * hot * (T_hot - T_j) - exchanged)
    energy = energy_of_the_contents + energy_of_the_jacket
    output, manipulated = T_m, u_hot
