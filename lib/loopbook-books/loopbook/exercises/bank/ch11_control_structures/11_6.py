"""Python beside the page of exercise 11.6."""

from loopbook.exercises.bank.ch11_control_structures.shared import cascade, lag


def picture(K_1, T_1, K_2, T_2):
    """The block diagram of the cascade: two P controllers, and the two parts of the process, both measured."""
    return cascade("K_{p1}", "K_{p2}", lag(K_1, T_1), lag(K_2, T_2))
