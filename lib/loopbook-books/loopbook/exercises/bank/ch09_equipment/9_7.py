"""Python beside the page of exercise 9.7."""

import math

import numpy as np

from exercisebook.authoring import criterion, design, number
from exercisebook.parameters import written
from loopbook import diagrams as draw
from loopbook.figures import time_plot


def ripple_of(T, P):
    """The ripple of a lag at half power, where it is largest, in percent: P in s, T in min."""
    return 100 * math.tanh(float(P) / (4 * 60 * float(T)))


def _step(cycle, P):
    return float(cycle) / 10 / P if P > 0 else math.inf


def years_of(life, P):
    """How many years the relay lasts with a period, in s."""
    return float(life) * 1e6 * max(float(P), 0) / (365.25 * 24 * 3600)


def _at_half_power(T, ripple, P):
    """Four cycles at half power, where the ripple is largest, between the limits of it."""
    lag, P = 60 * float(T), max(float(P), 1e-3)
    times = np.linspace(0, 4 * P, 801)
    a, since = math.exp(-P / (2 * lag)), times % P
    low, high = 100 * a / (1 + a), 100 / (1 + a)
    on = since < P / 2
    y = np.where(on, 100 - (100 - low) * np.exp(-since / lag), high * np.exp(-(since - P / 2) / lag))
    edge = float(ripple) / 2
    curve = {"temperature [% of its range]": (y, "measurement")}
    plot = time_plot(curve, times, ylim=(50 - 3 * edge, 50 + 3 * edge))
    return plot.level(50 + edge, "highest allowed").level(50 - edge, "lowest allowed")


def period(P, T, ripple, cycle, fineness, life, years):
    """A period that is short enough for the ripple, and long enough for the pulses and for the relay."""
    return design(
        number(P, "s", "the period"),
        criterion("the period is positive", lambda P: P > 0),
        criterion("the ripple", lambda P: ripple_of(T, P), below=float(ripple), unit="%"),
        criterion("the step of the pulse width", lambda P: _step(cycle, P), below=float(fineness), unit="%"),
        criterion("the life of the relay", lambda P: years_of(life, P), above=float(years), unit="years"),
        draws=lambda P: _at_half_power(T, ripple, P),
    )


def picture(T, cycle, life):
    """From the duty cycle to the temperature: a PLC with a cycle of {cycle}, a relay for {life} million switching
    cycles, and a greenhouse with the time constant {T}."""
    plc = draw.block(f"PLC, a cycle\nof ${written(cycle)}$ ms")
    contacts = draw.block(f"Relay, ${written(life)}$\nmillion cycles")
    greenhouse = draw.block(f"Greenhouse\n$T = {written(T)}$ min")
    return draw.block_diagram("D", plc, "pulses", contacts, "heat", greenhouse, r"$\vartheta$")
