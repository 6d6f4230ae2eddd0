"""Heated processes: the energy balance."""

import sympy

from loopbook.plants.declarations import Balance, Lag, delayed, measured, parameter, signal
from loopbook.plants.plant import Plant

__all__ = [
    "AirHeater", "AirHeaterWithFan", "HeatExchanger", "HeatedTank", "HeatedTankWithElement", "HeatedTankWithTransport",
    "JacketedTank",
]  # fmt: skip


class HeatedTank(Plant):
    """A stirred tank with a heating element and continuous flow. (Haugen, Example 3.3, equation 3.18)

    ``U_h=0`` makes it insulated, as in Example 6.2. The book prints no values; these are ours, and the operating point
    is a steady state.
    """

    c = parameter(4200, "J/(kg K)", "specific heat capacity")
    m = parameter(100, "kg", "mass of the liquid")
    U_h = parameter(160, "W/K", "heat transfer coefficient to the environment")
    P = signal(10000, "W", "power of the heating element")
    F = signal(0.2, "kg/s", "mass flow")
    T_i = signal(20, "°C", "temperature of the inflow")
    T_e = signal(20, "°C", "temperature of the environment")
    T = signal(30, "°C", "temperature in the tank and of the outflow")

    energy = Balance(c * m * T, P + c * F * (T_i - T) + U_h * (T_e - T))
    output, manipulated = T, P


class HeatedTankWithElement(HeatedTank):
    """The heated tank whose heating element stores heat: its power reaches the liquid through a lag.

    Example 3.3 of Haugen neglects this lag; P is the power supplied, Q the power that the liquid receives.
    """

    T_h = parameter(60, "s", "lag of the heating element")
    Q = signal(10000, "W", "power that the liquid receives")

    energy = HeatedTank.energy.subs(HeatedTank.P, Q)
    element = Lag(Q, HeatedTank.P, T_h)


class HeatedTankWithTransport(Plant):
    """The insulated heated tank under control, its sensor some way off. (Haugen, equations 10.33 and 10.34)

    The delay is a parameter; in Example 10.4 it is inversely proportional to the flow. The book prints the flows 12 to
    24 kg/min. The other values are ours, and the operating point is a steady state.
    """

    c = parameter(4200, "J/(kg K)", "specific heat capacity")
    rho = parameter(1000, "kg/m³", "density")
    V = parameter(0.2, "m³", "volume of the liquid")
    K_P = parameter(420, "W/%", "gain of the power amplifier")
    tau = parameter(60, "s", "transport delay from the tank to the sensor")
    u = signal(40, "%", "control signal")
    w = signal(0.2, "kg/s", "mass flow")
    T_in = signal(20, "°C", "temperature of the inflow")
    T_1 = signal(40, "°C", "temperature in the tank")
    T = measured(delayed(T_1, tau), "°C", "temperature at the sensor")

    energy = Balance(c * rho * V * T_1, K_P * u + c * w * (T_in - T_1))
    output, manipulated = T, u


class AirHeater(Plant):
    """A heated air tube, as of the laboratory process of Haugen, Example 8.2.

    The book prints only the temperatures 20 to 70 °C of its scale. The model, a lag with dead time above the
    temperature of the room, and its values are in the author's other public material. Heat is counted in degrees of the
    air that flows through in a second.
    """

    K = parameter(3.5, "K/V", "gain of the heater")
    theta = parameter(23, "s", "lag of the heater")
    tau = parameter(3, "s", "dead time of the air flow")
    u = signal(0, "V", "control signal of the heater")
    T_env = signal(21.5, "°C", "temperature of the room")
    T_rise = signal(0, "K", "rise of the temperature")
    T = measured(T_env + T_rise, "°C", "temperature at the outlet")

    supplied = K * delayed(u, tau)
    heat = Balance(theta * T_rise, supplied - T_rise)
    output, manipulated = T, u
    at_work = {u: 2, T_rise: 7}


class AirHeaterWithFan(AirHeater):
    """The air heater with a fan, the disturbance of Haugen, Example 8.2. The model and its values are ours.

    The pressure of the fan grows with the square of its speed and adds to that of the natural draught, and the flow of
    air grows with the square root of the sum: relative to the fan at rest it is sqrt(1 + (d/d_0)^2). More air carries
    more heat away.
    """

    K = parameter(0.5, "K/%", "gain of the heater")
    d_0 = parameter(150, "%", "fan speed that doubles the pressure")
    u = signal(37, "%", "control signal of the heater")
    d = signal(0, "%", "fan speed")
    T_rise = signal(18.5, "K", "rise of the temperature")

    flow = sympy.sqrt(1 + (d / d_0) ** 2)
    heat = Balance(AirHeater.heat.content, AirHeater.supplied - flow * T_rise)
    at_work = {}


class JacketedTank(Plant):
    """A tank heated by a liquid that flows through its jacket. (Haugen, equations 11.1 and 11.2)

    The text prints the temperatures of the inflows, the environment and the product. The other values are ours, and the
    operating point is a steady state.
    """

    c_p = parameter(4200, "J/(kg K)", "specific heat capacity of the product")
    d_p = parameter(1000, "kg/m³", "density of the product")
    V_p = parameter(0.5, "m³", "volume of the tank")
    c_h = parameter(4200, "J/(kg K)", "specific heat capacity of the heating liquid")
    d_h = parameter(1000, "kg/m³", "density of the heating liquid")
    V_h = parameter(0.1, "m³", "volume of the jacket")
    U_hp = parameter(5600, "W/K", "heat transfer coefficient from jacket to tank")
    U_eh = parameter(100, "W/K", "heat transfer coefficient from the environment to the jacket")
    tau = parameter(10, "s", "dead time of both measurements")
    F_p = signal(0.4, "kg/s", "flow of the product")
    F_h = signal(sympy.Rational(181, 294), "kg/s", "flow of the heating liquid")
    T_pin = signal(20, "°C", "inlet temperature of the product")
    T_hin = signal(60, "°C", "inlet temperature of the heating liquid")
    T_e = signal(20, "°C", "temperature of the environment")
    T_p = signal(40, "°C", "temperature in the tank")
    T_h = signal(46, "°C", "temperature in the jacket")
    T_pm = measured(delayed(T_p, tau), "°C", "measured temperature of the tank")
    T_hm = measured(delayed(T_h, tau), "°C", "measured temperature of the jacket")

    exchanged = U_hp * (T_h - T_p)
    energy_of_the_product = Balance(c_p * d_p * V_p * T_p, c_p * F_p * (T_pin - T_p) + exchanged)
    energy_of_the_jacket = Balance(c_h * d_h * V_h * T_h, c_h * F_h * (T_hin - T_h) - exchanged + U_eh * (T_e - T_h))
    energy = energy_of_the_product + energy_of_the_jacket
    output, manipulated = T_pm, F_h


class HeatExchanger(Plant):
    """A heat exchanger that warms a product by hot water through a valve. (Haugen, Example 11.3)

    Both sides are well mixed. The valve has an equal-percentage characteristic: each percent of opening multiplies the
    flow by the same factor. The flow also grows with the square root of the supply pressure, which other consumers
    disturb, and lags behind the valve. The book prints no values; these are ours, and the operating point is a steady
    state.
    """

    c = parameter(4200, "J/(kg K)", "specific heat capacity of water and product")
    m_p = parameter(10, "kg", "mass of the product inside")
    m_h = parameter(10, "kg", "mass of the hot water inside")
    U = parameter(2100, "W/K", "heat transfer coefficient")
    F_max = parameter(sympy.Rational(7, 2), "kg/s", "flow through the open valve at the nominal pressure")
    R = parameter(49, "1", "rangeability of the valve, its largest flow over its smallest")
    p_0 = parameter(2, "bar", "nominal supply pressure")
    T_v = parameter(2, "s", "lag of the flow behind the valve")
    tau = parameter(5, "s", "dead time of the temperature measurement")
    u = signal(50, "%", "opening of the valve")
    p = signal(2, "bar", "supply pressure of the hot water")
    F_p = signal(0.5, "kg/s", "flow of the product")
    T_pin = signal(20, "°C", "inlet temperature of the product")
    T_hin = signal(80, "°C", "inlet temperature of the hot water")
    T_p = signal(40, "°C", "outlet temperature of the product")
    T_h = signal(60, "°C", "outlet temperature of the hot water")
    F_h = signal(0.5, "kg/s", "flow of the hot water")
    T_m = measured(delayed(T_p, tau), "°C", "measured temperature of the product")

    exchanged = U * (T_h - T_p)
    energy_of_the_product = Balance(c * m_p * T_p, c * F_p * (T_pin - T_p) + exchanged)
    energy_of_the_water = Balance(c * m_h * T_h, c * F_h * (T_hin - T_h) - exchanged)
    energy = energy_of_the_product + energy_of_the_water
    valve = Lag(F_h, F_max * R ** (u / 100 - 1) * sympy.sqrt(p / p_0), T_v)
    output, manipulated = T_m, u
