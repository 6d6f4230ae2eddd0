"""Streams through valves: what a flow controller acts on."""

import sympy

from loopbook.expressions import t
from loopbook.plants.plant import Plant, parameters, signals

__all__ = ["BlendingStation"]


class BlendingStation(Plant):
    """Two streams through control valves into a mixing vessel, as for ratio control. (Haugen, Section 11.2)

    The flow through a valve is proportional to its opening and to the square root of the pressure drop across it; the
    valve follows its control signal with a lag. The vessel is always full: what enters leaves. The book prints no
    values; these are ours, and the operating point is a steady state.
    """

    x_1, x_2, c, F_1, F_2, u_1, u_2, p_1, p_2 = signals("x_1 x_2 c F_1 F_2 u_1 u_2 p_1 p_2")
    T_v, C_1, C_2, m = parameters("T_v C_1 C_2 m")
    through_1, through_2 = C_1 * x_1 * sympy.sqrt(p_1), C_2 * x_2 * sympy.sqrt(p_2)
    model = (
        sympy.Eq(T_v * x_1.diff(t), u_1 - x_1),
        sympy.Eq(T_v * x_2.diff(t), u_2 - x_2),
        sympy.Eq(m * c.diff(t), through_2 - c * (through_1 + through_2)),
        sympy.Eq(F_1, through_1),
        sympy.Eq(F_2, through_2),
    )
    output, manipulated = F_2, u_2
    balances = {"additive": (m * c, through_2 - c * (through_1 + through_2))}
    quantities = {
        T_v: (2, "s", "lag of both valves"),
        C_1: (0.1, "(kg/s)/(% bar^0.5)", "capacity of the valve in the main stream"),
        C_2: (0.025, "(kg/s)/(% bar^0.5)", "capacity of the valve for the additive"),
        m: (100, "kg", "mass in the mixing vessel"),
        u_1: (50, "%", "control signal of the valve in the main stream"),
        u_2: (50, "%", "control signal of the valve for the additive"),
        p_1: (4, "bar", "pressure drop across the valve in the main stream"),
        p_2: (4, "bar", "pressure drop across the valve for the additive"),
        x_1: (50, "%", "opening of the valve in the main stream"),
        x_2: (50, "%", "opening of the valve for the additive"),
        c: (0.2, "kg/kg", "share of the additive in the vessel and in the product"),
        F_1: (None, "kg/s", "main stream"),
        F_2: (None, "kg/s", "stream of the additive"),
    }
