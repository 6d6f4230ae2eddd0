"""Heated processes: the energy balance."""

import sympy

from loopbook.expressions import t
from loopbook.plants.plant import Plant, parameters, signals

__all__ = [
    "AirHeater", "AirHeaterWithFan", "HeatExchanger", "HeatedTank", "HeatedTankWithElement", "HeatedTankWithTransport",
    "JacketedTank",
]  # fmt: skip


class HeatedTank(Plant):
    """A stirred tank with a heating element and continuous flow. (Haugen, Example 3.3, equation 3.18)

    ``U_h=0`` makes it insulated, as in Example 6.2. The book prints no values; these are ours, and the operating point
    is a steady state.
    """

    T, P, F, T_i, T_e = signals("T P F T_i T_e")
    c, m, U_h = parameters("c m U_h")
    model = sympy.Eq(c * m * T.diff(t), P + c * F * (T_i - T) + U_h * (T_e - T))
    output, manipulated = T, P
    balances = {"energy": (c * m * T, P + c * F * (T_i - T) + U_h * (T_e - T))}
    quantities = {
        c: (4200, "J/(kg K)", "specific heat capacity"),
        m: (100, "kg", "mass of the liquid"),
        U_h: (160, "W/K", "heat transfer coefficient to the environment"),
        P: (10000, "W", "power of the heating element"),
        F: (0.2, "kg/s", "mass flow"),
        T_i: (20, "°C", "temperature of the inflow"),
        T_e: (20, "°C", "temperature of the environment"),
        T: (30, "°C", "temperature in the tank and of the outflow"),
    }


class HeatedTankWithElement(HeatedTank):
    """The heated tank whose heating element stores heat: its power reaches the liquid through a lag.

    Example 3.3 of Haugen neglects this lag; P is the power supplied, Q the power that the liquid receives.
    """

    T, P, F, T_i, T_e, Q = signals("T P F T_i T_e Q")
    c, m, U_h, T_h = parameters("c m U_h T_h")
    model = (
        sympy.Eq(c * m * T.diff(t), Q + c * F * (T_i - T) + U_h * (T_e - T)),
        sympy.Eq(T_h * Q.diff(t), P - Q),
    )
    balances = {"energy": (c * m * T, Q + c * F * (T_i - T) + U_h * (T_e - T))}
    quantities = HeatedTank.quantities | {
        T_h: (60, "s", "lag of the heating element"),
        Q: (10000, "W", "power that the liquid receives"),
    }


class HeatedTankWithTransport(Plant):
    """The insulated heated tank under control, its sensor some way off. (Haugen, equations 10.33 and 10.34)

    The delay is a parameter; in Example 10.4 it is inversely proportional to the flow. The book prints the flows 12 to
    24 kg/min. The other values are ours, and the operating point is a steady state.
    """

    T, T_1, u, w, T_in = signals("T T_1 u w T_in")
    c, rho, V, K_P, tau = parameters("c rho V K_P tau")
    model = (
        sympy.Eq(c * rho * V * T_1.diff(t), K_P * u + c * w * (T_in - T_1)),
        sympy.Eq(T, T_1.subs(t, t - tau)),
    )
    output, manipulated = T, u
    balances = {"energy": (c * rho * V * T_1, K_P * u + c * w * (T_in - T_1))}
    quantities = {
        c: (4200, "J/(kg K)", "specific heat capacity"),
        rho: (1000, "kg/m³", "density"),
        V: (0.2, "m³", "volume of the liquid"),
        K_P: (420, "W/%", "gain of the power amplifier"),
        tau: (60, "s", "transport delay from the tank to the sensor"),
        u: (40, "%", "control signal"),
        w: (0.2, "kg/s", "mass flow"),
        T_in: (20, "°C", "temperature of the inflow"),
        T_1: (40, "°C", "temperature in the tank"),
        T: (None, "°C", "temperature at the sensor"),
    }


class AirHeater(Plant):
    """A heated air tube, as of the laboratory process of Haugen, Example 8.2.

    The book prints only the temperatures 20 to 70 °C of its scale. The model, a lag with dead time above the
    temperature of the room, and its values are in the author's other public material.
    """

    T, T_rise, u, T_env = signals("T T_rise u T_env")
    K, theta, tau = parameters("K theta tau")
    model = (
        sympy.Eq(theta * T_rise.diff(t), K * u.subs(t, t - tau) - T_rise),
        sympy.Eq(T, T_env + T_rise),
    )
    output, manipulated = T, u
    quantities = {
        K: (3.5, "K/V", "gain of the heater"),
        theta: (23, "s", "lag of the heater"),
        tau: (3, "s", "dead time of the air flow"),
        u: (0, "V", "control signal of the heater"),
        T_env: (21.5, "°C", "temperature of the room"),
        T_rise: (0, "K", "rise of the temperature"),
        T: (None, "°C", "temperature at the outlet"),
    }


class AirHeaterWithFan(AirHeater):
    """The air heater with a fan, the disturbance of Haugen, Example 8.2. The model and its values are ours.

    The pressure of the fan grows with the square of its speed and adds to that of the natural draught, and the flow of
    air grows with the square root of the sum: relative to the fan at rest it is sqrt(1 + (d/d_0)^2). More air carries
    more heat away.
    """

    T, T_rise, u, T_env, d = signals("T T_rise u T_env d")
    K, theta, tau, d_0 = parameters("K theta tau d_0")
    flow = sympy.sqrt(1 + (d / d_0) ** 2)
    model = (
        sympy.Eq(theta * T_rise.diff(t), K * u.subs(t, t - tau) - flow * T_rise),
        sympy.Eq(T, T_env + T_rise),
    )
    quantities = AirHeater.quantities | {
        K: (0.5, "K/%", "gain of the heater"),
        d_0: (150, "%", "fan speed that doubles the pressure"),
        u: (37, "%", "control signal of the heater"),
        d: (0, "%", "fan speed"),
        T_rise: (18.5, "K", "rise of the temperature"),
    }


class JacketedTank(Plant):
    """A tank heated by a liquid that flows through its jacket. (Haugen, equations 11.1 and 11.2)

    The text prints the temperatures of the inflows, the environment and the product. The other values are ours, and the
    operating point is a steady state.
    """

    T_p, T_h, T_pm, T_hm, F_h, F_p, T_pin, T_hin, T_e = signals("T_p T_h T_pm T_hm F_h F_p T_pin T_hin T_e")
    c_p, d_p, V_p, c_h, d_h, V_h, U_hp, U_eh, tau = parameters("c_p d_p V_p c_h d_h V_h U_hp U_eh tau")
    model = (
        sympy.Eq(c_p * d_p * V_p * T_p.diff(t), c_p * F_p * (T_pin - T_p) + U_hp * (T_h - T_p)),
        sympy.Eq(c_h * d_h * V_h * T_h.diff(t), c_h * F_h * (T_hin - T_h) - U_hp * (T_h - T_p) + U_eh * (T_e - T_h)),
        sympy.Eq(T_pm, T_p.subs(t, t - tau)),
        sympy.Eq(T_hm, T_h.subs(t, t - tau)),
    )
    output, manipulated = T_pm, F_h
    balances = {
        "energy of the product": (c_p * d_p * V_p * T_p, c_p * F_p * (T_pin - T_p) + U_hp * (T_h - T_p)),
        "energy": (
            c_p * d_p * V_p * T_p + c_h * d_h * V_h * T_h,
            c_p * F_p * (T_pin - T_p) + c_h * F_h * (T_hin - T_h) + U_eh * (T_e - T_h),
        ),
    }
    quantities = {
        c_p: (4200, "J/(kg K)", "specific heat capacity of the product"),
        d_p: (1000, "kg/m³", "density of the product"),
        V_p: (0.5, "m³", "volume of the tank"),
        c_h: (4200, "J/(kg K)", "specific heat capacity of the heating liquid"),
        d_h: (1000, "kg/m³", "density of the heating liquid"),
        V_h: (0.1, "m³", "volume of the jacket"),
        U_hp: (5600, "W/K", "heat transfer coefficient from jacket to tank"),
        U_eh: (100, "W/K", "heat transfer coefficient from the environment to the jacket"),
        tau: (10, "s", "dead time of both measurements"),
        F_p: (0.4, "kg/s", "flow of the product"),
        F_h: (sympy.Rational(181, 294), "kg/s", "flow of the heating liquid"),
        T_pin: (20, "°C", "inlet temperature of the product"),
        T_hin: (60, "°C", "inlet temperature of the heating liquid"),
        T_e: (20, "°C", "temperature of the environment"),
        T_p: (40, "°C", "temperature in the tank"),
        T_h: (46, "°C", "temperature in the jacket"),
        T_pm: (None, "°C", "measured temperature of the tank"),
        T_hm: (None, "°C", "measured temperature of the jacket"),
    }


class HeatExchanger(Plant):
    """A heat exchanger that warms a product by hot water through a valve. (Haugen, Example 11.3)

    Both sides are well mixed. The valve has an equal-percentage characteristic: each percent of opening multiplies the
    flow by the same factor. The flow also grows with the square root of the supply pressure, which other consumers
    disturb, and lags behind the valve. The book prints no values; these are ours, and the operating point is a steady
    state.
    """

    T_p, T_h, F_h, T_m, u, p, F_p, T_pin, T_hin = signals("T_p T_h F_h T_m u p F_p T_pin T_hin")
    c, m_p, m_h, U, F_max, R, p_0, T_v, tau = parameters("c m_p m_h U F_max R p_0 T_v tau")
    model = (
        sympy.Eq(c * m_p * T_p.diff(t), c * F_p * (T_pin - T_p) + U * (T_h - T_p)),
        sympy.Eq(c * m_h * T_h.diff(t), c * F_h * (T_hin - T_h) - U * (T_h - T_p)),
        sympy.Eq(T_v * F_h.diff(t), F_max * R ** (u / 100 - 1) * sympy.sqrt(p / p_0) - F_h),
        sympy.Eq(T_m, T_p.subs(t, t - tau)),
    )
    output, manipulated = T_m, u
    balances = {"energy": (c * m_p * T_p + c * m_h * T_h, c * F_p * (T_pin - T_p) + c * F_h * (T_hin - T_h))}
    quantities = {
        c: (4200, "J/(kg K)", "specific heat capacity of water and product"),
        m_p: (10, "kg", "mass of the product inside"),
        m_h: (10, "kg", "mass of the hot water inside"),
        U: (2100, "W/K", "heat transfer coefficient"),
        F_max: (sympy.Rational(7, 2), "kg/s", "flow through the open valve at the nominal pressure"),
        R: (49, "1", "rangeability of the valve, its largest flow over its smallest"),
        p_0: (2, "bar", "nominal supply pressure"),
        T_v: (2, "s", "lag of the flow behind the valve"),
        tau: (5, "s", "dead time of the temperature measurement"),
        u: (50, "%", "opening of the valve"),
        p: (2, "bar", "supply pressure of the hot water"),
        F_p: (0.5, "kg/s", "flow of the product"),
        T_pin: (20, "°C", "inlet temperature of the product"),
        T_hin: (80, "°C", "inlet temperature of the hot water"),
        T_p: (40, "°C", "outlet temperature of the product"),
        T_h: (60, "°C", "outlet temperature of the hot water"),
        F_h: (0.5, "kg/s", "flow of the hot water"),
        T_m: (None, "°C", "measured temperature of the product"),
    }
