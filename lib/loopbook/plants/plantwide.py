"""Whole plants: vessels in a row, between which material, a component and energy are handed on.

Every state is a content (a mass, an energy) or the position of a valve or pump, so that nothing is lost at a limit: a
vessel that runs empty gives less and less, and what it cannot hold leaves it as a flow of the model.
"""

import sympy
from sympy import Max, Min, sqrt
from sympy import Rational as Q

from loopbook.expressions import t
from loopbook.plants.plant import Plant, parameters, signals

__all__ = ["AmmoniaEvaporator", "FlashPlant"]


def _pumped(flow, m, m_r, m_s):
    """A flow out of a vessel, less and less of it where the vessel runs empty."""
    return flow * Min(1, (m - m_r) / m_s)


def _overflow(x, rim, k):
    return k * Max(0, x - rim)


def _follows(z, u, tau):
    """A valve or a pump follows its control signal."""
    return sympy.Eq(tau * z.diff(t), u - z)


def _level(L, m, M):
    return sympy.Eq(L, 100 * m / M)


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

    u_1, u_2, u_A, u_B, u_3, u_h, u_4, u_V = signals("u_1 u_2 u_A u_B u_3 u_h u_4 u_V")
    z_1, z_2, z_A, z_B, z_3, z_h, z_4, z_V = signals("z_1 z_2 z_A z_B z_3 z_h z_4 z_V")
    p_1, p_2, x_A, T_A, T_B, T_s = signals("p_1 p_2 x_A T_A T_B T_s")
    m_1, m_2, m_3, m_4, m_V, a_1, a_3, a_4, E_3, E_x, E_4 = signals("m_1 m_2 m_3 m_4 m_V a_1 a_3 a_4 E_3 E_x E_4")
    F_1, F_2, F_A, F_B, F_3, F_4, F_V, L_1, L_2, L_3, L_4 = signals("F_1 F_2 F_A F_B F_3 F_4 F_V L_1 L_2 L_3 L_4")
    p_4, T_3, T_x, T_4, x_4, O_1, O_2, O_3, O_4, O_V = signals("p_4 T_3 T_x T_4 x_4 O_1 O_2 O_3 O_4 O_V")
    k_1, k_2, k_A, k_B, k_3, k_4, k_V, k_o, k_r, k_e = parameters("k_1 k_2 k_A k_B k_3 k_4 k_V k_o k_r k_e")
    M_1, M_2, M_3, M_4, m_r, m_s, m_x = parameters("M_1 M_2 M_3 M_4 m_r m_s m_x")
    tau, c, r, U, rho, V_4, R, T_0, p_0, T_e, p_r = parameters("tau c r U rho V_4 R T_0 p_0 T_e p_r")
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
    into_3 = c * (flow_A * T_A + flow_B * T_B)
    out_of_4 = c * liquid_4 * warm_4 + gas * (c * warm_4 + r)
    model = (
        *map(_follows, (z_1, z_2, z_A, z_B), (u_1, u_2, u_A, u_B), 4 * (tau,)),
        *map(_follows, (z_3, z_h, z_4, z_V), (u_3, u_h, u_4, u_V), 4 * (tau,)),
        sympy.Eq(m_1.diff(t), feed_1 - flow_A - over_1),
        sympy.Eq(m_2.diff(t), feed_2 - flow_B - over_2),
        sympy.Eq(m_3.diff(t), flow_A + flow_B - liquid_3),
        sympy.Eq(m_4.diff(t), flow_3 - evaporated - liquid_4),
        sympy.Eq(m_V.diff(t), evaporated - gas),
        sympy.Eq(a_1.diff(t), feed_1 * x_A - (flow_A + over_1) * a_1 / m_1),
        sympy.Eq(a_3.diff(t), flow_A * a_1 / m_1 - liquid_3 * a_3 / m_3),
        sympy.Eq(a_4.diff(t), flow_3 * a_3 / m_3 - liquid_4 * a_4 / m_4),
        sympy.Eq(E_3.diff(t), into_3 - c * liquid_3 * warm_3),
        sympy.Eq(E_x.diff(t), c * flow_3 * (warm_3 - warm_x) + steam),
        sympy.Eq(E_4.diff(t), c * flow_3 * warm_x - out_of_4),
        *map(sympy.Eq, (F_1, F_2, F_A, F_B, F_3, F_4, F_V), (feed_1, feed_2, flow_A, flow_B, flow_3, flow_4, vapour)),
        *map(_level, (L_1, L_2, L_3, L_4), (m_1, m_2, m_3, m_4), (M_1, M_2, M_3, M_4)),
        *map(sympy.Eq, (T_3, T_x, T_4, p_4, x_4), (warm_3, warm_x, warm_4, pressure, 100 * a_4 / m_4)),
        *map(sympy.Eq, (O_1, O_2, O_3, O_4, O_V), (over_1, over_2, over_3, over_4, relief)),
    )
    output, manipulated = L_3, u_3
    balances = {
        "mass": (m_1 + m_2 + m_3 + m_4 + m_V, feed_1 + feed_2 - over_1 - over_2 - over_3 - liquid_4 - gas),
        "mass of A": (
            a_1 + a_3 + a_4,
            feed_1 * x_A - over_1 * a_1 / m_1 - over_3 * a_3 / m_3 - liquid_4 * a_4 / m_4,
        ),
        "energy behind the mixer": (E_3 + E_x + E_4, into_3 + steam - c * over_3 * warm_3 - out_of_4),
    }
    _mass_of_vapour = Q("2.5") * 5 / (Q("0.0046") * Q("403.15"))
    quantities = {
        u_1: (50, "%", "control signal of the inlet valve of vessel 1"),
        u_2: (50, "%", "control signal of the inlet valve of vessel 2"),
        u_A: (50, "%", "control signal of the feed pump A"),
        u_B: (50, "%", "control signal of the feed pump B"),
        u_3: (50, "%", "control signal of the pump behind vessel 3"),
        u_h: (52, "%", "control signal of the steam valve"),
        u_4: (50, "%", "control signal of the liquid valve of vessel 4"),
        u_V: (50, "%", "control signal of the vapour valve of vessel 4"),
        p_1: (4, "bar", "pressure drop over the inlet valve of vessel 1"),
        p_2: (4, "bar", "pressure drop over the inlet valve of vessel 2"),
        x_A: (Q("0.38"), "1", "mass fraction of A in feed A"),
        T_A: (25, "°C", "temperature of feed A"),
        T_B: (25, "°C", "temperature of feed B"),
        T_s: (185, "°C", "temperature of the steam"),
        k_1: (Q("0.05"), "kg/(s % √bar)", "capacity of the inlet valve of vessel 1"),
        k_2: (Q("0.03"), "kg/(s % √bar)", "capacity of the inlet valve of vessel 2"),
        k_A: (Q("0.1"), "kg/(s %)", "capacity of the feed pump A"),
        k_B: (Q("0.06"), "kg/(s %)", "capacity of the feed pump B"),
        k_3: (Q("0.16"), "kg/(s %)", "capacity of the pump behind vessel 3"),
        k_4: (Q("0.152"), "kg/(s %)", "capacity of the liquid valve of vessel 4"),
        k_V: (Q("0.0032"), "kg/(s % bar)", "capacity of the vapour valve"),
        k_o: (Q("0.1"), "1/s", "overflow for each kilogram above the rim"),
        k_r: (10, "kg/(s bar)", "capacity of the relief valve"),
        k_e: (2, "kg/(s bar)", "evaporation for the pressure below saturation"),
        M_1: (3000, "kg", "what vessel 1 holds"),
        M_2: (2000, "kg", "what vessel 2 holds"),
        M_3: (4000, "kg", "what vessel 3 holds"),
        M_4: (4000, "kg", "liquid that vessel 4 holds"),
        m_r: (20, "kg", "liquid below the suction pipe"),
        m_s: (60, "kg", "liquid above it where a pump begins to lose its grip"),
        m_x: (400, "kg", "liquid in the heat exchanger"),
        tau: (5, "s", "lag of the valves and pumps"),
        c: (Q("0.0042"), "MJ/(kg K)", "specific heat capacity"),
        r: (Q("2.1"), "MJ/kg", "heat of evaporation"),
        U: (Q("0.28"), "MW/K", "heat transfer with open steam valve"),
        rho: (1000, "kg/m³", "density of the liquid"),
        V_4: (7, "m³", "volume of vessel 4"),
        R: (Q("0.0046"), "bar m³/(kg K)", "gas constant of the vapour"),
        T_0: (Q("273.15"), "K", "0 °C"),
        p_0: (Q("2.7"), "bar", "saturation pressure at T_e"),
        T_e: (130, "°C", "temperature at which p_0 is the saturation pressure"),
        p_r: (4, "bar", "pressure at which the relief valve opens"),
        z_1: (50, "%", "position of the inlet valve of vessel 1"),
        z_2: (50, "%", "position of the inlet valve of vessel 2"),
        z_A: (50, "%", "speed of the feed pump A"),
        z_B: (50, "%", "speed of the feed pump B"),
        z_3: (50, "%", "speed of the pump behind vessel 3"),
        z_h: (52, "%", "position of the steam valve"),
        z_4: (50, "%", "position of the liquid valve of vessel 4"),
        z_V: (50, "%", "position of the vapour valve"),
        m_1: (1500, "kg", "mass in vessel 1"),
        m_2: (1000, "kg", "mass in vessel 2"),
        m_3: (2000, "kg", "mass in vessel 3"),
        m_4: (2000, "kg", "mass of the liquid in vessel 4"),
        m_V: (_mass_of_vapour, "kg", "mass of the vapour in vessel 4"),
        a_1: (570, "kg", "mass of A in vessel 1"),
        a_3: (475, "kg", "mass of A in vessel 3"),
        a_4: (500, "kg", "mass of A in vessel 4"),
        E_3: (210, "MJ", "energy of the liquid in vessel 3"),
        E_x: (Q("260.4"), "MJ", "energy of the liquid in the heat exchanger"),
        E_4: ((2000 + _mass_of_vapour) * Q("0.546") + _mass_of_vapour * Q("2.1"), "MJ", "energy of vessel 4"),
        F_1: (None, "kg/s", "flow into vessel 1"),
        F_2: (None, "kg/s", "flow into vessel 2"),
        F_A: (None, "kg/s", "flow of feed A: the production rate"),
        F_B: (None, "kg/s", "flow of feed B"),
        F_3: (None, "kg/s", "flow out of vessel 3"),
        F_4: (None, "kg/s", "flow of the product"),
        F_V: (None, "kg/s", "flow of the vapour"),
        L_1: (None, "%", "level of vessel 1"),
        L_2: (None, "%", "level of vessel 2"),
        L_3: (None, "%", "level of vessel 3"),
        L_4: (None, "%", "level of vessel 4"),
        p_4: (None, "bar", "pressure in vessel 4"),
        T_3: (None, "°C", "temperature of vessel 3"),
        T_x: (None, "°C", "temperature of the inflow to vessel 4"),
        T_4: (None, "°C", "temperature in vessel 4"),
        x_4: (None, "%", "mass fraction of A in the product"),
        O_1: (None, "kg/s", "overflow of vessel 1"),
        O_2: (None, "kg/s", "overflow of vessel 2"),
        O_3: (None, "kg/s", "overflow of vessel 3"),
        O_4: (None, "kg/s", "liquid carried over into the vapour"),
        O_V: (None, "kg/s", "flow through the relief valve"),
    }


class AmmoniaEvaporator(Plant):
    """Evaporator E1 of a nitric acid plant. (Haugen, Example 11.6; the model and the values are ours)

    Liquid ammonia is evaporated by cold water, which gives off a part of the heat that it has above the ammonia's
    temperature. The gas leaves through a valve in proportion to the pressure. Limits and energy are as in `FlashPlant`:
    there is a relief valve, liquid above the highest level is carried over, and the last of it does not evaporate.
    The operating point is a steady state.
    """

    u_1, u_2, u_3, T_in, T_w = signals("u_1 u_2 u_3 T_in T_w")
    z_1, z_2, z_3, m, m_G, E = signals("z_1 z_2 z_3 m m_G E")
    F_in, F_w, F_G, L, p, T, O, O_G = signals("F_in F_w F_G L p T O O_G")
    k_1, k_2, k_3, k_e, k_o, k_r, tau = parameters("k_1 k_2 k_3 k_e k_o k_r tau")
    M, m_r, m_s, V, rho, R, T_0, p_0, T_e, p_r = parameters("M m_r m_s V rho R T_0 p_0 T_e p_r")
    c, r, c_w, share = parameters("c r c_w share")

    warm = (E - r * m_G) / (c * (m + m_G))
    pressure = m_G * R * (warm + T_0) / (V - m / rho)
    saturation = p_0 * ((warm + T_0) / (T_e + T_0)) ** 10
    evaporated = _pumped(k_e * (saturation - pressure), m, m_r, m_s)
    feed, water, gas = k_1 * z_1, k_2 * z_2, k_3 * z_3 * pressure
    over, relief = _overflow(m, M, k_o), _overflow(pressure, p_r, k_r)
    supplied = c * feed * T_in + share * c_w * water * (T_w - warm)
    carried = c * over * warm + (gas + relief) * (c * warm + r)
    model = (
        *map(_follows, (z_1, z_2, z_3), (u_1, u_2, u_3), 3 * (tau,)),
        sympy.Eq(m.diff(t), feed - evaporated - over),
        sympy.Eq(m_G.diff(t), evaporated - gas - relief),
        sympy.Eq(E.diff(t), supplied - carried),
        *map(sympy.Eq, (F_in, F_w, F_G, p, T, O, O_G), (feed, water, gas, pressure, warm, over, relief)),
        _level(L, m, M),
    )
    output, manipulated = p, u_2
    balances = {"mass": (m + m_G, feed - over - gas - relief), "energy": (E, supplied - carried)}
    _mass_of_gas = Q("6.1") * 4 / (Q("0.00488") * Q("285.15"))
    quantities = {
        u_1: (50, "%", "control signal of the inlet valve V1"),
        u_2: (50, "%", "control signal of the water valve V2"),
        u_3: (50, "%", "control signal of the gas valve V3"),
        T_in: (12, "°C", "temperature of the liquid ammonia"),
        T_w: (22, "°C", "temperature of the water"),
        k_1: (Q("0.03"), "kg/(s %)", "capacity of the valve V1"),
        k_2: (Q("1.2"), "kg/(s %)", "capacity of the valve V2"),
        k_3: (Q(3, 610), "kg/(s % bar)", "capacity of the valve V3"),
        k_e: (3, "kg/(s bar)", "evaporation for the pressure below saturation"),
        k_o: (Q("0.1"), "1/s", "liquid carried over for each kilogram above the highest level"),
        k_r: (10, "kg/(s bar)", "capacity of the relief valve"),
        tau: (5, "s", "lag of the valves"),
        M: (1800, "kg", "liquid that the evaporator holds"),
        m_r: (20, "kg", "liquid below the tubes"),
        m_s: (60, "kg", "liquid above that where the evaporation begins to cease"),
        V: (6, "m³", "volume"),
        rho: (600, "kg/m³", "density of liquid ammonia"),
        R: (Q("0.00488"), "bar m³/(kg K)", "gas constant of ammonia"),
        T_0: (Q("273.15"), "K", "0 °C"),
        p_0: (Q("6.6"), "bar", "saturation pressure at T_e"),
        T_e: (12, "°C", "temperature at which p_0 is the saturation pressure"),
        p_r: (10, "bar", "pressure at which the relief valve opens"),
        c: (Q("0.0047"), "MJ/(kg K)", "specific heat capacity of ammonia"),
        r: (Q("1.26"), "MJ/kg", "heat of evaporation of ammonia"),
        c_w: (Q("0.0042"), "MJ/(kg K)", "specific heat capacity of water"),
        share: (Q("0.75"), "1", "part of its heat that the water gives off"),
        z_1: (50, "%", "position of the inlet valve V1"),
        z_2: (50, "%", "position of the water valve V2"),
        z_3: (50, "%", "position of the gas valve V3"),
        m: (1200, "kg", "mass of the liquid"),
        m_G: (_mass_of_gas, "kg", "mass of the gas"),
        E: ((1200 + _mass_of_gas) * Q("0.0564") + _mass_of_gas * Q("1.26"), "MJ", "energy"),
        F_in: (None, "kg/s", "flow of the liquid ammonia"),
        F_w: (None, "kg/s", "flow of the water"),
        F_G: (None, "kg/s", "flow of the ammonia gas"),
        L: (None, "%", "level"),
        p: (None, "bar", "pressure"),
        T: (None, "°C", "temperature"),
        O: (None, "kg/s", "liquid carried over into the gas"),
        O_G: (None, "kg/s", "flow through the relief valve"),
    }
