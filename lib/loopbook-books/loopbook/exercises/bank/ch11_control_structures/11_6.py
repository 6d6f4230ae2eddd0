"""Python beside the page of exercise 11.6."""

import sympy

from loopbook.exercises.bank.ch11_control_structures.shared import cascade, lag


def in_numbers(left, *gains):
    """An expression in the four gains, with numbers."""
    return left.subs(dict(zip(sympy.symbols("K_1 K_2 K_p1 K_p2", positive=True), gains, strict=True)))


def picture(K_1, T_1, K_2, T_2):
    """The block diagram of the cascade: two P controllers, and the two parts of the process, both measured."""
    return cascade("K_{p1}", "K_{p2}", lag(K_1, T_1), lag(K_2, T_2))
