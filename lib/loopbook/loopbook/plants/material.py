"""Tanks: the balances of mass and of moles."""

import sympy

from loopbook.plants.declarations import Balance, Lag, delayed, parameter, signal
from loopbook.plants.plant import Plant

__all__ = ["BlendingTank", "BufferTank", "LiquidTank", "WoodChipTank", "WoodChipTankWithScale"]


class LiquidTank(Plant):
    """A tank with pumped inflow and outflow. (Haugen, Example 3.1, equation 3.7)

    The book prints no values; these are ours.
    """

    A = parameter(1, "m²", "cross-sectional area")
    h_min = parameter(0, "m", "lowest level")
    h_max = parameter(1, "m", "highest level")
    q_i = signal(0, "m³/s", "volumetric inflow")
    q_o = signal(0, "m³/s", "volumetric outflow")
    h = signal(0.5, "m", "level", limits=(h_min, h_max))

    volume = Balance(A * h, q_i - q_o)
    output, manipulated = h, q_i
    at_work = {q_i: 0.001, q_o: 0.001}


class BufferTank(Plant):
    """A liquid tank with mass flows, as for feedforward and for flow smoothing. (Haugen, equations 8.2 and 11.4)

    The density and the area are those of Example 11.5; Example 8.1's area is not printed. The heights are ours.
    """

    rho = parameter(1000, "kg/m³", "density")
    A = parameter(0.2, "m²", "cross-sectional area")
    h_min = parameter(0, "m", "lowest level")
    h_max = parameter(2, "m", "highest level")
    F_in = signal(0, "kg/s", "mass inflow")
    F_out = signal(0, "kg/s", "mass outflow")
    h = signal(1, "m", "level", limits=(h_min, h_max))

    mass = Balance(rho * A * h, F_in - F_out)
    output, manipulated = h, F_in
    at_work = {F_in: 3, F_out: 3}


class WoodChipTank(Plant):
    """The wood-chip tank with feed screw and conveyor belt. (Haugen, Section 1.2)

    The text prints the area, the time on the belt, the flow and that 45 % of the control signal are 1500 kg/min, from
    which the gain of the feed screw follows. The density is from the author's other public material. Flows are in kg/s.
    """

    rho = parameter(145, "kg/m³", "density of the wood chip")
    A = parameter(13.4, "m²", "cross-sectional area")
    K_s = parameter(sympy.Rational(5, 9), "(kg/s)/%", "gain of the feed screw")
    tau = parameter(250, "s", "time on the conveyor belt")
    h_min = parameter(0, "m", "lowest level")
    h_max = parameter(15, "m", "highest level")
    u = signal(45, "%", "control signal of the feed screw")
    w_out = signal(25, "kg/s", "outflow")
    h = signal(10, "m", "level", limits=(h_min, h_max))

    mass = Balance(rho * A * h, K_s * delayed(u, tau) - w_out)
    output, manipulated = h, u


class WoodChipTankWithScale(Plant):
    """The wood-chip tank whose belt carries a scale that measures the mass flow. (Haugen, Example 11.2)

    The disturbance d is a mass flow that is added at the beginning of the belt, as the book's figure has it. The mass
    on the belt is a state of its own, so that nothing is lost between the screw and the tank. The values are those of
    `WoodChipTank`; the book prints none for the scale, and those of it are ours. The level has no limits here.
    """

    rho, A, K_s, tau = WoodChipTank.declared("rho A K_s tau")
    tau_m = parameter(10, "s", "time on the belt from the feed screw to the scale")
    T_m = parameter(5, "s", "lag of the scale")
    u = signal(45, "%", "control signal of the feed screw")
    d = signal(0, "kg/s", "disturbance of the flow, as by lighter chips")
    w_out = signal(25, "kg/s", "outflow")
    h = signal(10, "m", "level")
    m_b = signal(6250, "kg", "mass on the belt")
    w_m = signal(25, "kg/s", "measured flow on the belt")

    w_in = K_s * u + d
    mass_in_the_tank = Balance(rho * A * h, delayed(w_in, tau) - w_out)
    mass_on_the_belt = Balance(m_b, w_in - delayed(w_in, tau))
    mass = mass_in_the_tank + mass_on_the_belt
    scale = Lag(w_m, delayed(w_in, tau_m), T_m)
    output, manipulated = h, u


class BlendingTank(Plant):
    """A stirred tank in which a material A is blended into a raw material. (Haugen, Example 3.2, equation 3.9)

    It is not linear: the outflow carries away the product of concentration and flow. The book prints no values; these
    are ours, and the operating point is a steady state.
    """

    V = parameter(2, "m³", "volume of the liquid")
    w_A = signal(0.02, "mol/s", "mole flow of material A")
    q = signal(0.01, "m³/s", "volumetric flow of the raw material, and out of the tank")
    c_A = signal(2, "mol/m³", "mole density of A in the tank", limits=(0, sympy.oo))

    moles_of_A = Balance(V * c_A, w_A - c_A * q)
    output, manipulated = c_A, w_A
