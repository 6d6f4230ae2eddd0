"""A heater that cannot give what is asked of it, and a controller that integrates all the same, or does not."""

import functools

import numpy as np
from sympy import Rational as Q

from lessons.lesson import Answer, Curve, Lesson, Panel, Slider
from loopbook import plants
from loopbook.pid import PID, Controller
from loopbook.signals import stepwise
from loopbook.simulation import simulate

SETPOINT, WARM = 70, 40
BEGIN, END, UNTIL = 2400, 7800, 21000  # s: the cold spell, and the end
STEP, EVERY = 20, 4  # s between samples, and how many of them make one point of a curve
SETTINGS = PID(6.7, Ti=252, Td=63, Tf=6.3)
TANK = plants.HeatedTankWithTransport(T_in=WARM, w=Q(1, 3), V=Q(7, 50), K_P=686, tau=122, T_1=SETPOINT)
NOMINAL = float(TANK.numbers(next(iter(TANK.static_response("u").values()))))
COLD = (30, 26, 22, 18, 14, 10, 6, 2)
LIMITS = (80, 90, 100, 120, 140)
TIMES = np.arange(0, UNTIL + 1, STEP * EVERY) / 60


@functools.cache
def run_with(cold, limit, anti_windup):
    """The simulation of one controller: times in minutes, temperature and control signal."""
    controller = Controller(SETTINGS, STEP, u0=NOMINAL, limits=(0, limit), T_filter=20, anti_windup=anti_windup)
    inflow = stepwise(WARM, {BEGIN: cold, END: WARM})
    run = simulate(TANK, controller, until=UNTIL, setpoint=SETPOINT, T_in=inflow)
    return run.times / 60, run["T"], run["u"]


def back_after(minutes, temperature):
    """The minutes after the cold spell until the temperature stays within one degree of the setpoint."""
    outside = minutes[abs(temperature - SETPOINT) > 1]
    return max(0.0, outside.max(initial=0) - END / 60)


def respond(cold, limit):
    """Answer for one temperature of the cold inflow, and one upper limit of the control signal."""
    signals, results = {"setpoint": np.full_like(TIMES, SETPOINT)}, {}
    needed = NOMINAL * (SETPOINT - cold) / (SETPOINT - WARM)
    results["needed control signal"] = f"{needed:.0f}\u202f%"
    for way, halt in (("without", False), ("with", True)):
        minutes, temperature, u = run_with(cold, limit, halt)
        signals |= {f"T {way}": temperature[::EVERY], f"u {way}": u[::EVERY]}
        results[f"{way} anti wind-up: highest"] = f"{temperature.max():.0f}\u202f°C"
        back = back_after(minutes, temperature)
        results[f"{way}: back"] = f"after {back:.0f}\u202fmin" if minutes[-1] - END / 60 - back > 1 else "not yet"
    verdict = "The heater is at its limit" if needed > limit else "The heater can do it"
    return Answer(verdict, results, signals)


LESSON = Lesson(
    title="Live: with and without anti wind-up",
    about=(
        "The heated tank of Example 7.4 with its PID controller, both as there, the controller sampled every 20 s. The "
        "inflow is at 40 °C, but between minutes 40 and 130 it is colder. The heater has an upper limit. One "
        "controller goes on integrating at the limit, the other one halts (anti wind-up). The results say which "
        "control signal would balance the cold inflow, and how long after the cold spell the temperature is within one "
        "degree of its setpoint for good."
    ),
    questions=(
        "How cold may the inflow be before the two controllers differ? Compare with the control signal that is needed.",
        "Beyond that, how does the time to return grow with each degree, without anti wind-up and with it?",
        "A larger heater is the expensive solution. How large must it be for an inflow of 10 °C?",
    ),
    sliders=(
        Slider("cold", "Temperature of the cold inflow", COLD, 10, "°C"),
        Slider("limit", "Upper limit of the control signal", LIMITS, 100, "%"),
    ),
    panels=(Panel("temperature [°C]", 50, 110), Panel("control signal [%]", -10, 150)),
    curves=(
        Curve("setpoint", "setpoint", 0, "setpoint"),
        Curve("T without", "temperature without anti wind-up", 0, 1),
        Curve("T with", "with anti wind-up", 0, "measurement"),
        Curve("u without", "control signal without anti wind-up", 1, 1),
        Curve("u with", "with anti wind-up", 1, "control signal"),
    ),
    times=TIMES,
    clock="time [min]",
    respond=respond,
)
