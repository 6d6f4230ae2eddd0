"""Tanks: the balances of mass and of moles."""

import sympy

from loopbook.expressions import t
from loopbook.plants.plant import Plant, parameters, signals

__all__ = ["BlendingTank", "BufferTank", "LiquidTank", "WoodChipTank", "WoodChipTankWithScale"]


class LiquidTank(Plant):
    """A tank with pumped inflow and outflow. (Haugen, Example 3.1, equation 3.7)

    The book prints no values; these are ours.
    """

    h, q_i, q_o = signals("h q_i q_o")
    A, h_min, h_max = parameters("A h_min h_max")
    model = sympy.Eq(A * h.diff(t), q_i - q_o)
    output, manipulated = h, q_i
    limits = {h: (h_min, h_max)}
    balances = {"volume": (A * h, q_i - q_o)}
    quantities = {
        A: (1, "m²", "cross-sectional area"),
        h_min: (0, "m", "lowest level"),
        h_max: (1, "m", "highest level"),
        q_i: (0, "m³/s", "volumetric inflow"),
        q_o: (0, "m³/s", "volumetric outflow"),
        h: (0.5, "m", "level"),
    }


class BufferTank(Plant):
    """A liquid tank with mass flows, as for feedforward and for flow smoothing. (Haugen, equations 8.2 and 11.4)

    The density and the area are those of Example 11.5; Example 8.1's area is not printed. The heights are ours.
    """

    h, F_in, F_out = signals("h F_in F_out")
    rho, A, h_min, h_max = parameters("rho A h_min h_max")
    model = sympy.Eq(rho * A * h.diff(t), F_in - F_out)
    output, manipulated = h, F_in
    limits = {h: (h_min, h_max)}
    balances = {"mass": (rho * A * h, F_in - F_out)}
    quantities = {
        rho: (1000, "kg/m³", "density"),
        A: (0.2, "m²", "cross-sectional area"),
        h_min: (0, "m", "lowest level"),
        h_max: (2, "m", "highest level"),
        F_in: (0, "kg/s", "mass inflow"),
        F_out: (0, "kg/s", "mass outflow"),
        h: (1, "m", "level"),
    }


class WoodChipTank(Plant):
    """The wood-chip tank with feed screw and conveyor belt. (Haugen, Section 1.2)

    The text prints the area, the time on the belt, the flow and that 45 % of the control signal are 1500 kg/min, from
    which the gain of the feed screw follows. The density is from the author's other public material. Flows are in kg/s.
    """

    h, u, w_out = signals("h u w_out")
    rho, A, K_s, tau, h_min, h_max = parameters("rho A K_s tau h_min h_max")
    model = sympy.Eq(rho * A * h.diff(t), K_s * u.subs(t, t - tau) - w_out)
    output, manipulated = h, u
    limits = {h: (h_min, h_max)}
    balances = {"mass": (rho * A * h, K_s * u.subs(t, t - tau) - w_out)}
    quantities = {
        rho: (145, "kg/m³", "density of the wood chip"),
        A: (13.4, "m²", "cross-sectional area"),
        K_s: (sympy.Rational(5, 9), "(kg/s)/%", "gain of the feed screw"),
        tau: (250, "s", "time on the conveyor belt"),
        h_min: (0, "m", "lowest level"),
        h_max: (15, "m", "highest level"),
        u: (45, "%", "control signal of the feed screw"),
        w_out: (25, "kg/s", "outflow"),
        h: (10, "m", "level"),
    }


class WoodChipTankWithScale(Plant):
    """The wood-chip tank whose belt carries a scale that measures the mass flow. (Haugen, Example 11.2)

    The disturbance d is a mass flow that is added at the beginning of the belt, as the book's figure has it. The mass
    on the belt is a state of its own, so that nothing is lost between the screw and the tank. The values are those of
    `WoodChipTank`; the book prints none for the scale, and those of it are ours. The level has no limits here.
    """

    h, m_b, w_m, u, d, w_out = signals("h m_b w_m u d w_out")
    rho, A, K_s, tau, tau_m, T_m = parameters("rho A K_s tau tau_m T_m")
    w_in = K_s * u + d
    model = (
        sympy.Eq(rho * A * h.diff(t), w_in.subs(t, t - tau) - w_out),
        sympy.Eq(m_b.diff(t), w_in - w_in.subs(t, t - tau)),
        sympy.Eq(T_m * w_m.diff(t), w_in.subs(t, t - tau_m) - w_m),
    )
    output, manipulated = h, u
    balances = {
        "mass in the tank": (rho * A * h, w_in.subs(t, t - tau) - w_out),
        "mass": (rho * A * h + m_b, w_in - w_out),
    }
    quantities = {
        **{letter: WoodChipTank.quantities[letter] for letter in (rho, A, K_s, tau)},
        tau_m: (10, "s", "time on the belt from the feed screw to the scale"),
        T_m: (5, "s", "lag of the scale"),
        u: (45, "%", "control signal of the feed screw"),
        d: (0, "kg/s", "disturbance of the flow, as by lighter chips"),
        w_out: (25, "kg/s", "outflow"),
        h: (10, "m", "level"),
        m_b: (6250, "kg", "mass on the belt"),
        w_m: (25, "kg/s", "measured flow on the belt"),
    }


class BlendingTank(Plant):
    """A stirred tank in which a material A is blended into a raw material. (Haugen, Example 3.2, equation 3.9)

    It is not linear: the outflow carries away the product of concentration and flow. The book prints no values; these
    are ours, and the operating point is a steady state.
    """

    c_A, w_A, q = signals("c_A w_A q")
    V = sympy.Symbol("V", positive=True)
    model = sympy.Eq(V * c_A.diff(t), w_A - c_A * q)
    output, manipulated = c_A, w_A
    limits = {c_A: (0, sympy.oo)}
    balances = {"moles of A": (V * c_A, w_A - c_A * q)}
    quantities = {
        V: (2, "m³", "volume of the liquid"),
        w_A: (0.02, "mol/s", "mole flow of material A"),
        q: (0.01, "m³/s", "volumetric flow of the raw material, and out of the tank"),
        c_A: (2, "mol/m³", "mole density of A in the tank"),
    }
