"""Exercises of chapter 2, heat and how it is lost."""

import numpy as np

from drawings import Drawing
from exercisebook.authoring import answers, between, exercise, number, word


@exercise("2.1", title="A cup cools")
def cup(T_0=between(50, 90, "°C", step=5, reference=80), right=between(2, 6, "min", reference=4)):
    """Tea of {T_0} cools; `t, theta = exercise("2.1").given("t", "theta")` are its record. Which curve is it?"""
    return answers(
        tau=number(right, "min", "the time constant"),
        curve=word("A" if right < 4 else "B", ["A", "B"], "the curve"),
    )


@cup.shows
def _(T_0, right):
    times = np.linspace(0, 10, 11)
    fast, slow = (20 + (float(T_0) - 20) * np.exp(-times / tau) for tau in (2, 5))
    curves = {"A": fast, "B": slow} if right < 4 else {"B": slow, "A": fast}
    return {"t": times, "theta": fast if right < 4 else slow} | curves


@cup.picture
def _(T_0):
    """Two curves that begin at {T_0}."""
    return Drawing()
