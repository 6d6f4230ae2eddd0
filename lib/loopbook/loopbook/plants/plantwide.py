"""Whole plants: vessels in a row, between which material, a component and energy are handed on.

Every state is a content (a mass, an energy) or the position of a valve or pump, so that nothing is lost at a limit: a
vessel that runs empty gives less and less, and what it cannot hold leaves it as a flow of the model.
"""

from sympy import Max, Min, sqrt
from sympy import Rational as Q

from loopbook.plants.declarations import Balance, Lag, measured, parameter, signal
from loopbook.plants.plant import Plant

__all__ = ["AmmoniaEvaporator", "FlashPlant"]


def _pumped(flow, m, m_r, m_s):
    """A flow out of a vessel, less and less of it where the vessel runs empty."""
    return flow * Min(1, (m - m_r) / m_s)


def _overflow(x, rim, k):
    return k * Max(0, x - rim)


class FlashPlant(Plant):
    """Two feeds mixed in a ratio, heated and flashed. (Haugen, Section 11.5, Figure 11.17; the model is ours)

    Feed A is a solution of the component A, which is not volatile, feed B is solvent. Each has a vessel, 1 and 2; the
    mixed streams go to vessel 3, through a heat exchanger with condensing steam to vessel 4, where a part of the
    solvent evaporates; the liquid is the product, and its mass fraction of A is the product quality. In the exchanger
    the pump's pressure keeps it liquid. All values are ours, and the operating point is a steady state.

    Every pump and valve follows its control signal with a lag. A pump gets no more than what is above its suction
    pipe, and loses its grip on the last kilograms above it; what is above the rim of vessel 1, 2 or 3 overflows, and
    in vessel 4 it is carried over into the vapour. Vapour leaves through the valve in proportion to the pressure, as
    at the speed of sound, and beyond that through a relief valve. Energy is that of liquid at 0 °C and what it takes
    from there; vapour has the same heat capacity as liquid, and the heat of evaporation besides.
    """

    _mass_of_vapour = Q("2.5") * 5 / (Q("0.0046") * Q("403.15"))
    u_1 = signal(50, "%", "control signal of the inlet valve of vessel 1")
    u_2 = signal(50, "%", "control signal of the inlet valve of vessel 2")
    u_A = signal(50, "%", "control signal of the feed pump A")
    u_B = signal(50, "%", "control signal of the feed pump B")
    u_3 = signal(50, "%", "control signal of the pump behind vessel 3")
    u_h = signal(52, "%", "control signal of the steam valve")
    u_4 = signal(50, "%", "control signal of the liquid valve of vessel 4")
    u_V = signal(50, "%", "control signal of the vapour valve of vessel 4")
    p_1 = signal(4, "bar", "pressure drop over the inlet valve of vessel 1")
    p_2 = signal(4, "bar", "pressure drop over the inlet valve of vessel 2")
    x_A = signal(Q("0.38"), "1", "mass fraction of A in feed A")
    T_A = signal(25, "°C", "temperature of feed A")
    T_B = signal(25, "°C", "temperature of feed B")
    T_s = signal(185, "°C", "temperature of the steam")
    k_1 = parameter(Q("0.05"), "kg/(s % √bar)", "capacity of the inlet valve of vessel 1")
    k_2 = parameter(Q("0.03"), "kg/(s % √bar)", "capacity of the inlet valve of vessel 2")
    k_A = parameter(Q("0.1"), "kg/(s %)", "capacity of the feed pump A")
    k_B = parameter(Q("0.06"), "kg/(s %)", "capacity of the feed pump B")
    k_3 = parameter(Q("0.16"), "kg/(s %)", "capacity of the pump behind vessel 3")
    k_4 = parameter(Q("0.152"), "kg/(s %)", "capacity of the liquid valve of vessel 4")
    k_V = parameter(Q("0.0032"), "kg/(s % bar)", "capacity of the vapour valve")
    k_o = parameter(Q("0.1"), "1/s", "overflow for each kilogram above the rim")
    k_r = parameter(10, "kg/(s bar)", "capacity of the relief valve")
    k_e = parameter(2, "kg/(s bar)", "evaporation for the pressure below saturation")
    M_1 = parameter(3000, "kg", "what vessel 1 holds")
    M_2 = parameter(2000, "kg", "what vessel 2 holds")
    M_3 = parameter(4000, "kg", "what vessel 3 holds")
    M_4 = parameter(4000, "kg", "liquid that vessel 4 holds")
    m_r = parameter(20, "kg", "liquid below the suction pipe")
    m_s = parameter(60, "kg", "liquid above it where a pump begins to lose its grip")
    m_x = parameter(400, "kg", "liquid in the heat exchanger")
    tau = parameter(5, "s", "lag of the valves and pumps")
    c = parameter(Q("0.0042"), "MJ/(kg K)", "specific heat capacity")
    r = parameter(Q("2.1"), "MJ/kg", "heat of evaporation")
    U = parameter(Q("0.28"), "MW/K", "heat transfer with open steam valve")
    rho = parameter(1000, "kg/m³", "density of the liquid")
    V_4 = parameter(7, "m³", "volume of vessel 4")
    R = parameter(Q("0.0046"), "bar m³/(kg K)", "gas constant of the vapour")
    T_0 = parameter(Q("273.15"), "K", "0 °C")
    p_0 = parameter(Q("2.7"), "bar", "saturation pressure at T_e")
    T_e = parameter(130, "°C", "temperature at which p_0 is the saturation pressure")
    p_r = parameter(4, "bar", "pressure at which the relief valve opens")
    z_1 = signal(50, "%", "position of the inlet valve of vessel 1")
    z_2 = signal(50, "%", "position of the inlet valve of vessel 2")
    z_A = signal(50, "%", "speed of the feed pump A")
    z_B = signal(50, "%", "speed of the feed pump B")
    z_3 = signal(50, "%", "speed of the pump behind vessel 3")
    z_h = signal(52, "%", "position of the steam valve")
    z_4 = signal(50, "%", "position of the liquid valve of vessel 4")
    z_V = signal(50, "%", "position of the vapour valve")
    m_1 = signal(1500, "kg", "mass in vessel 1")
    m_2 = signal(1000, "kg", "mass in vessel 2")
    m_3 = signal(2000, "kg", "mass in vessel 3")
    m_4 = signal(2000, "kg", "mass of the liquid in vessel 4")
    m_V = signal(_mass_of_vapour, "kg", "mass of the vapour in vessel 4")
    a_1 = signal(570, "kg", "mass of A in vessel 1")
    a_3 = signal(475, "kg", "mass of A in vessel 3")
    a_4 = signal(500, "kg", "mass of A in vessel 4")
    E_3 = signal(210, "MJ", "energy of the liquid in vessel 3")
    E_x = signal(Q("260.4"), "MJ", "energy of the liquid in the heat exchanger")
    E_4 = signal((2000 + _mass_of_vapour) * Q("0.546") + _mass_of_vapour * Q("2.1"), "MJ", "energy of vessel 4")

    reach = (m_r, m_s)
    feed_1, feed_2 = k_1 * z_1 * sqrt(p_1), k_2 * z_2 * sqrt(p_2)
    flow_A, flow_B = _pumped(k_A * z_A, m_1, *reach), _pumped(k_B * z_B, m_2, *reach)
    flow_3, flow_4 = _pumped(k_3 * z_3, m_3, *reach), _pumped(k_4 * z_4, m_4, *reach)
    over_1, over_2, over_3, over_4 = map(_overflow, (m_1, m_2, m_3, m_4), (M_1, M_2, M_3, M_4), 4 * (k_o,))

    warm_3, warm_x, warm_4 = E_3 / (c * m_3), E_x / (c * m_x), (E_4 - r * m_V) / (c * (m_4 + m_V))
    steam = U * z_h / 100 * (T_s - warm_x)
    pressure = m_V * R * (warm_4 + T_0) / (V_4 - m_4 / rho)
    saturation = p_0 * ((warm_4 + T_0) / (T_e + T_0)) ** 12
    evaporated = _pumped(k_e * (saturation - pressure), m_4, *reach)  # the last kilograms do not evaporate either
    vapour, relief = k_V * z_V * pressure, _overflow(pressure, p_r, k_r)

    liquid_3, liquid_4, gas = flow_3 + over_3, flow_4 + over_4, vapour + relief
    A_to_3, A_to_4 = flow_A * a_1 / m_1, flow_3 * a_3 / m_3
    into_3 = c * (flow_A * T_A + flow_B * T_B)
    to_exchanger, to_4 = c * flow_3 * warm_3, c * flow_3 * warm_x
    out_of_4 = c * liquid_4 * warm_4 + gas * (c * warm_4 + r)

    F_1 = measured(feed_1, "kg/s", "flow into vessel 1")
    F_2 = measured(feed_2, "kg/s", "flow into vessel 2")
    F_A = measured(flow_A, "kg/s", "flow of feed A: the production rate")
    F_B = measured(flow_B, "kg/s", "flow of feed B")
    F_3 = measured(flow_3, "kg/s", "flow out of vessel 3")
    F_4 = measured(flow_4, "kg/s", "flow of the product")
    F_V = measured(vapour, "kg/s", "flow of the vapour")
    L_1 = measured(100 * m_1 / M_1, "%", "level of vessel 1")
    L_2 = measured(100 * m_2 / M_2, "%", "level of vessel 2")
    L_3 = measured(100 * m_3 / M_3, "%", "level of vessel 3")
    L_4 = measured(100 * m_4 / M_4, "%", "level of vessel 4")
    T_3 = measured(warm_3, "°C", "temperature of vessel 3")
    T_x = measured(warm_x, "°C", "temperature of the inflow to vessel 4")
    T_4 = measured(warm_4, "°C", "temperature in vessel 4")
    p_4 = measured(pressure, "bar", "pressure in vessel 4")
    x_4 = measured(100 * a_4 / m_4, "%", "mass fraction of A in the product")
    O_1 = measured(over_1, "kg/s", "overflow of vessel 1")
    O_2 = measured(over_2, "kg/s", "overflow of vessel 2")
    O_3 = measured(over_3, "kg/s", "overflow of vessel 3")
    O_4 = measured(over_4, "kg/s", "liquid carried over into the vapour")
    O_V = measured(relief, "kg/s", "flow through the relief valve")

    valve_1, valve_2, pump_A, pump_B = map(Lag, (z_1, z_2, z_A, z_B), (u_1, u_2, u_A, u_B), 4 * (tau,))
    pump_3, steam_valve, liquid_valve, vapour_valve = map(Lag, (z_3, z_h, z_4, z_V), (u_3, u_h, u_4, u_V), 4 * (tau,))
    mass_1 = Balance(m_1, feed_1 - flow_A - over_1)
    mass_2 = Balance(m_2, feed_2 - flow_B - over_2)
    mass_3 = Balance(m_3, flow_A + flow_B - liquid_3)
    mass_4 = Balance(m_4, flow_3 - evaporated - liquid_4)
    mass_V = Balance(m_V, evaporated - gas)
    mass = mass_1 + mass_2 + mass_3 + mass_4 + mass_V
    A_1 = Balance(a_1, feed_1 * x_A - A_to_3 - over_1 * a_1 / m_1)
    A_3 = Balance(a_3, A_to_3 - A_to_4 - over_3 * a_3 / m_3)
    A_4 = Balance(a_4, A_to_4 - liquid_4 * a_4 / m_4)
    mass_of_A = A_1 + A_3 + A_4
    energy_3 = Balance(E_3, into_3 - to_exchanger - c * over_3 * warm_3)
    energy_x = Balance(E_x, to_exchanger - to_4 + steam)
    energy_4 = Balance(E_4, to_4 - out_of_4)
    energy_behind_the_mixer = energy_3 + energy_x + energy_4
    output, manipulated = L_3, u_3


class AmmoniaEvaporator(Plant):
    """Evaporator E1 of a nitric acid plant. (Haugen, Example 11.6; the model and the values are ours)

    Liquid ammonia is evaporated by cold water, which gives off a part of the heat that it has above the ammonia's
    temperature. The gas leaves through a valve in proportion to the pressure. Limits and energy are as in `FlashPlant`:
    there is a relief valve, liquid above the highest level is carried over, and the last of it does not evaporate.
    The operating point is a steady state.
    """

    _mass_of_gas = Q("6.1") * 4 / (Q("0.00488") * Q("285.15"))
    u_1 = signal(50, "%", "control signal of the inlet valve V1")
    u_2 = signal(50, "%", "control signal of the water valve V2")
    u_3 = signal(50, "%", "control signal of the gas valve V3")
    T_in = signal(12, "°C", "temperature of the liquid ammonia")
    T_w = signal(22, "°C", "temperature of the water")
    k_1 = parameter(Q("0.03"), "kg/(s %)", "capacity of the valve V1")
    k_2 = parameter(Q("1.2"), "kg/(s %)", "capacity of the valve V2")
    k_3 = parameter(Q(3, 610), "kg/(s % bar)", "capacity of the valve V3")
    k_e = parameter(3, "kg/(s bar)", "evaporation for the pressure below saturation")
    k_o = parameter(Q("0.1"), "1/s", "liquid carried over for each kilogram above the highest level")
    k_r = parameter(10, "kg/(s bar)", "capacity of the relief valve")
    tau = parameter(5, "s", "lag of the valves")
    M = parameter(1800, "kg", "liquid that the evaporator holds")
    m_r = parameter(20, "kg", "liquid below the tubes")
    m_s = parameter(60, "kg", "liquid above that where the evaporation begins to cease")
    V = parameter(6, "m³", "volume")
    rho = parameter(600, "kg/m³", "density of liquid ammonia")
    R = parameter(Q("0.00488"), "bar m³/(kg K)", "gas constant of ammonia")
    T_0 = parameter(Q("273.15"), "K", "0 °C")
    p_0 = parameter(Q("6.6"), "bar", "saturation pressure at T_e")
    T_e = parameter(12, "°C", "temperature at which p_0 is the saturation pressure")
    p_r = parameter(10, "bar", "pressure at which the relief valve opens")
    c = parameter(Q("0.0047"), "MJ/(kg K)", "specific heat capacity of ammonia")
    r = parameter(Q("1.26"), "MJ/kg", "heat of evaporation of ammonia")
    c_w = parameter(Q("0.0042"), "MJ/(kg K)", "specific heat capacity of water")
    share = parameter(Q("0.75"), "1", "part of its heat that the water gives off")
    z_1 = signal(50, "%", "position of the inlet valve V1")
    z_2 = signal(50, "%", "position of the water valve V2")
    z_3 = signal(50, "%", "position of the gas valve V3")
    m = signal(1200, "kg", "mass of the liquid")
    m_G = signal(_mass_of_gas, "kg", "mass of the gas")
    E = signal((1200 + _mass_of_gas) * Q("0.0564") + _mass_of_gas * Q("1.26"), "MJ", "energy")

    warm = (E - r * m_G) / (c * (m + m_G))
    pressure = m_G * R * (warm + T_0) / (V - m / rho)
    saturation = p_0 * ((warm + T_0) / (T_e + T_0)) ** 10
    evaporated = _pumped(k_e * (saturation - pressure), m, m_r, m_s)
    feed, water, gas = k_1 * z_1, k_2 * z_2, k_3 * z_3 * pressure
    over, relief = _overflow(m, M, k_o), _overflow(pressure, p_r, k_r)
    supplied = c * feed * T_in + share * c_w * water * (T_w - warm)
    carried = c * over * warm + (gas + relief) * (c * warm + r)

    F_in = measured(feed, "kg/s", "flow of the liquid ammonia")
    F_w = measured(water, "kg/s", "flow of the water")
    F_G = measured(gas, "kg/s", "flow of the ammonia gas")
    p = measured(pressure, "bar", "pressure")
    T = measured(warm, "°C", "temperature")
    O = measured(over, "kg/s", "liquid carried over into the gas")
    O_G = measured(relief, "kg/s", "flow through the relief valve")
    L = measured(100 * m / M, "%", "level")

    valve_1, valve_2, valve_3 = map(Lag, (z_1, z_2, z_3), (u_1, u_2, u_3), 3 * (tau,))
    mass_of_liquid = Balance(m, feed - evaporated - over)
    mass_of_gas = Balance(m_G, evaporated - gas - relief)
    mass = mass_of_liquid + mass_of_gas
    energy = Balance(E, supplied - carried)
    output, manipulated = p, u_2
