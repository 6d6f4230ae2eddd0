"""Separators for water, oil and gas, which take up slugs."""

from loopbook.plants.declarations import Balance, parameter, signal
from loopbook.plants.plant import Plant

__all__ = ["TwoStageSeparator"]


class TwoStageSeparator(Plant):
    """The liquids of two separators in series. (Haugen, Example 11.4)

    Water and oil enter the first one ahead of a weir, where the water settles below the oil. This chamber is always
    full to the weir: a volume that enters and does not leave as water drives oil over the weir into the oil
    compartment. The oil that leaves this goes on to the second separator, which gets no water. The gas is not modelled.

    The equations hold as long as the water stays below the weir, oil flows over it, and no compartment runs empty or
    full. The book prints no values; these are ours, and the operating point is a steady state.
    """

    rho_w = parameter(1000, "kg/m³", "density of the water")
    rho_o = parameter(800, "kg/m³", "density of the oil")
    A_w = parameter(5, "m²", "area of the first separator ahead of the weir")
    A_1 = parameter(4, "m²", "area of the oil compartment of the first separator")
    A_2 = parameter(6, "m²", "area of the second separator")
    F_w = signal(20, "kg/s", "water from the reservoir")
    F_o = signal(40, "kg/s", "oil from the reservoir")
    W = signal(20, "kg/s", "water out of the first separator")
    O_1 = signal(40, "kg/s", "oil from the first to the second separator")
    O_2 = signal(40, "kg/s", "oil out of the second separator")
    h_w = signal(1, "m", "level of the water in the first separator")
    h_1 = signal(1, "m", "level of the oil in the oil compartment of the first separator")
    h_2 = signal(1, "m", "level of the oil in the second separator")

    water = Balance(rho_w * A_w * h_w, F_w - W)
    # of the oil in the first separator, what the chamber ahead of the weir holds less than with no water in it
    oil_in_the_first = Balance(rho_o * (A_1 * h_1 - A_w * h_w), F_o - O_1)
    oil_in_the_second = Balance(rho_o * A_2 * h_2, O_1 - O_2)
    oil = oil_in_the_first + oil_in_the_second
    output, manipulated = h_1, O_1
