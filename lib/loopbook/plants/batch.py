"""The tank of a batch process, which is filled, heated and stirred, and discharged."""

import sympy

from loopbook.expressions import t
from loopbook.plants.plant import Plant, parameters, signals

__all__ = ["BatchTank"]


class BatchTank(Plant):
    """A tank with valves that are open or closed, a stirrer and a heating element. (Haugen, Example 12.1)

    Nothing has to be cut off at a limit: the outlet pipe begins above the bottom, so that its flow, by Torricelli's
    law, goes to zero at `h_out` and leaves a rest of water, and what rises over the brim at `h_max` runs over it as
    over a weir. The liquid is always mixed; its energy is counted from 0 °C. The book prints no values; these are ours.
    The operating point is the idle tank with what the batch before has left, at the temperature of the room.
    """

    h, T, u_valve_in, u_valve_out, u_motor, u_heat, u_hand, T_in, T_env = signals(
        "h T u_valve_in u_valve_out u_motor u_heat u_hand T_in T_env"
    )
    A, c, rho, q_max, K_v, K_w, h_out, h_max, P_max, P_m, U_h = parameters(
        "A c rho q_max K_v K_w h_out h_max P_max P_m U_h"
    )
    inflow = rho * q_max * u_valve_in * u_hand
    discharge = rho * K_v * u_valve_out * sympy.sqrt(sympy.Max(h - h_out, 0))
    overflow = rho * K_w * sympy.Max(h - h_max, 0) ** sympy.Rational(3, 2)
    power = P_max * u_heat / 100 + P_m * u_motor + U_h * (T_env - T)
    model = (
        sympy.Eq(rho * A * h.diff(t), inflow - discharge - overflow),
        sympy.Eq(c * rho * A * h * T.diff(t), c * inflow * (T_in - T) + power),
    )
    output, manipulated = T, u_heat
    balances = {
        "mass": (rho * A * h, inflow - discharge - overflow),
        "energy": (c * rho * A * h * T, c * inflow * T_in - c * (discharge + overflow) * T + power),
    }
    quantities = {
        A: (0.25, "m²", "cross-sectional area"),
        c: (4200, "J/(kg K)", "specific heat capacity"),
        rho: (1000, "kg/m³", "density"),
        q_max: (0.0012, "m³/s", "flow through the open inlet valve"),
        K_v: (0.002, "m³/s/m^0.5", "outflow through the open outlet valve per root of the level above the outlet"),
        K_w: (1, "m³/s/m^1.5", "overflow per power 3/2 of the level above the brim"),
        h_out: (0.05, "m", "level of the outlet"),
        h_max: (1.2, "m", "level of the brim"),
        P_max: (36000, "W", "power of the heating element at 100 %"),
        P_m: (150, "W", "power of the stirrer, which becomes heat"),
        U_h: (15, "W/K", "heat transfer coefficient to the environment"),
        u_valve_in: (0, "1", "inlet valve, 1 open or 0 closed"),
        u_valve_out: (0, "1", "outlet valve, 1 open or 0 closed"),
        u_motor: (0, "1", "motor of the stirrer, 1 on or 0 off"),
        u_heat: (0, "%", "control signal of the heating element"),
        u_hand: (1, "1", "hand valve in the supply line, 1 open or 0 closed"),
        T_in: (15, "°C", "temperature of the inflow"),
        T_env: (20, "°C", "temperature of the environment"),
        h: (0.1, "m", "level"),
        T: (20, "°C", "temperature of the liquid"),
    }
