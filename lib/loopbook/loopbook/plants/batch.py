"""The tank of a batch process, which is filled, heated and stirred, and discharged."""

import sympy

from loopbook.plants.declarations import Balance, parameter, signal
from loopbook.plants.plant import Plant

__all__ = ["BatchTank"]


class BatchTank(Plant):
    """A tank with valves that are open or closed, a stirrer and a heating element. (Haugen, Example 12.1)

    Nothing has to be cut off at a limit: the outlet pipe begins above the bottom, so that its flow, by Torricelli's
    law, goes to zero at `h_out` and leaves a rest of water, and what rises over the brim at `h_max` runs over it as
    over a weir. The liquid is always mixed; its energy is counted from 0 °C. The book prints no values; these are ours.
    The operating point is the idle tank with what the batch before has left, at the temperature of the room.
    """

    A = parameter(0.25, "m²", "cross-sectional area")
    c = parameter(4200, "J/(kg K)", "specific heat capacity")
    rho = parameter(1000, "kg/m³", "density")
    q_max = parameter(0.0012, "m³/s", "flow through the open inlet valve")
    K_v = parameter(0.002, "m³/s/m^0.5", "outflow through the open outlet valve per root of the level above the outlet")
    K_w = parameter(1, "m³/s/m^1.5", "overflow per power 3/2 of the level above the brim")
    h_out = parameter(0.05, "m", "level of the outlet")
    h_max = parameter(1.2, "m", "level of the brim")
    P_max = parameter(36000, "W", "power of the heating element at 100 %")
    P_m = parameter(150, "W", "power of the stirrer, which becomes heat")
    U_h = parameter(15, "W/K", "heat transfer coefficient to the environment")
    u_valve_in = signal(0, "1", "inlet valve, 1 open or 0 closed")
    u_valve_out = signal(0, "1", "outlet valve, 1 open or 0 closed")
    u_motor = signal(0, "1", "motor of the stirrer, 1 on or 0 off")
    u_heat = signal(0, "%", "control signal of the heating element")
    u_hand = signal(1, "1", "hand valve in the supply line, 1 open or 0 closed")
    T_in = signal(15, "°C", "temperature of the inflow")
    T_env = signal(20, "°C", "temperature of the environment")
    h = signal(0.1, "m", "level")
    T = signal(20, "°C", "temperature of the liquid")

    inflow = rho * q_max * u_valve_in * u_hand
    discharge = rho * K_v * u_valve_out * sympy.sqrt(sympy.Max(h - h_out, 0))
    overflow = rho * K_w * sympy.Max(h - h_max, 0) ** sympy.Rational(3, 2)
    power = P_max * u_heat / 100 + P_m * u_motor + U_h * (T_env - T)
    mass = Balance(rho * A * h, inflow - discharge - overflow)
    energy = Balance(c * rho * A * h * T, c * inflow * T_in - c * (discharge + overflow) * T + power)
    output, manipulated = T, u_heat
    at_work = {h: 0.9, u_valve_in: 1, u_valve_out: 0.5, u_heat: 50, u_motor: 1}
