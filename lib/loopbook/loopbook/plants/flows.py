"""Streams through valves: what a flow controller acts on."""

import sympy

from loopbook.plants.declarations import Balance, Lag, measured, parameter, signal
from loopbook.plants.plant import Plant

__all__ = ["BlendingStation"]


class BlendingStation(Plant):
    """Two streams through control valves into a mixing vessel, as for ratio control. (Haugen, Section 11.2)

    The flow through a valve is proportional to its opening and to the square root of the pressure drop across it; the
    valve follows its control signal with a lag. The vessel is always full: what enters leaves. The book prints no
    values; these are ours, and the operating point is a steady state.
    """

    T_v = parameter(2, "s", "lag of both valves")
    C_1 = parameter(0.1, "(kg/s)/(% bar^0.5)", "capacity of the valve in the main stream")
    C_2 = parameter(0.025, "(kg/s)/(% bar^0.5)", "capacity of the valve for the additive")
    m = parameter(100, "kg", "mass in the mixing vessel")
    u_1 = signal(50, "%", "control signal of the valve in the main stream")
    u_2 = signal(50, "%", "control signal of the valve for the additive")
    p_1 = signal(4, "bar", "pressure drop across the valve in the main stream")
    p_2 = signal(4, "bar", "pressure drop across the valve for the additive")
    x_1 = signal(50, "%", "opening of the valve in the main stream")
    x_2 = signal(50, "%", "opening of the valve for the additive")
    c = signal(0.2, "kg/kg", "share of the additive in the vessel and in the product")
    through_1, through_2 = C_1 * x_1 * sympy.sqrt(p_1), C_2 * x_2 * sympy.sqrt(p_2)
    F_1 = measured(through_1, "kg/s", "main stream")
    F_2 = measured(through_2, "kg/s", "stream of the additive")

    valve_1, valve_2 = Lag(x_1, u_1, T_v), Lag(x_2, u_2, T_v)
    additive = Balance(m * c, through_2 - c * (through_1 + through_2))
    output, manipulated = F_2, u_2
