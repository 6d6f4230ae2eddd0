"""Python beside the page of exercise 11.7."""

from loopbook.approximation import half_rule
from loopbook.exercises.bank.ch11_control_structures.shared import cascade, lag
from loopbook.transfer import first_order


def by_half_rule(K_1, T_1, K_2, T_2, delay):
    """The model of first order that the half rule finds for the mould behind a lag with dead time."""
    return half_rule(first_order(K_1, T_1) * first_order(K_2, T_2, delay))


def picture(K_1, T_1, K_2, T_2, delay):
    """The block diagram of the cascade: two PI controllers, and the two parts of the process, both measured."""
    return cascade("PI controller", "PI controller", lag(K_1, T_1), lag(K_2, T_2, delay))
