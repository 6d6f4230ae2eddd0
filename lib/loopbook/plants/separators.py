"""Separators for water, oil and gas, which take up slugs."""

import sympy

from loopbook.expressions import t
from loopbook.plants.plant import Plant, parameters, signals

__all__ = ["TwoStageSeparator"]


class TwoStageSeparator(Plant):
    """The liquids of two separators in series. (Haugen, Example 11.4)

    Water and oil enter the first one ahead of a weir, where the water settles below the oil. This chamber is always
    full to the weir: a volume that enters and does not leave as water drives oil over the weir into the oil
    compartment. The oil that leaves this goes on to the second separator, which gets no water. The gas is not modelled.

    The equations hold as long as the water stays below the weir, oil flows over it, and no compartment runs empty or
    full. The book prints no values; these are ours, and the operating point is a steady state.
    """

    h_w, h_1, h_2, F_w, F_o, W, O_1, O_2 = signals("h_w h_1 h_2 F_w F_o W O_1 O_2")
    rho_w, rho_o, A_w, A_1, A_2 = parameters("rho_w rho_o A_w A_1 A_2")
    over_weir = F_o + rho_o / rho_w * (F_w - W)
    model = (
        sympy.Eq(rho_w * A_w * h_w.diff(t), F_w - W),
        sympy.Eq(rho_o * A_1 * h_1.diff(t), over_weir - O_1),
        sympy.Eq(rho_o * A_2 * h_2.diff(t), O_1 - O_2),
    )
    output, manipulated = h_1, O_1
    balances = {
        "water": (rho_w * A_w * h_w, F_w - W),
        # counted from the oil that fills the chamber ahead of the weir where there is no water in it
        "oil": (rho_o * (A_1 * h_1 + A_2 * h_2 - A_w * h_w), F_o - O_2),
    }
    quantities = {
        rho_w: (1000, "kg/m³", "density of the water"),
        rho_o: (800, "kg/m³", "density of the oil"),
        A_w: (5, "m²", "area of the first separator ahead of the weir"),
        A_1: (4, "m²", "area of the oil compartment of the first separator"),
        A_2: (6, "m²", "area of the second separator"),
        F_w: (20, "kg/s", "water from the reservoir"),
        F_o: (40, "kg/s", "oil from the reservoir"),
        W: (20, "kg/s", "water out of the first separator"),
        O_1: (40, "kg/s", "oil from the first to the second separator"),
        O_2: (40, "kg/s", "oil out of the second separator"),
        h_w: (1, "m", "level of the water in the first separator"),
        h_1: (1, "m", "level of the oil in the oil compartment of the first separator"),
        h_2: (1, "m", "level of the oil in the second separator"),
    }
