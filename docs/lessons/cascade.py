"""A cascade beside a single loop on the jacketed tank: what a second measurement is good for."""

import functools

import numpy as np
from sympy import Rational as Q

from lessons.lesson import Answer, Curve, Lesson, Panel, Slider, figures
from loopbook import plants
from loopbook.pid import PID, Controller
from loopbook.signals import stepwise
from loopbook.simulation import simulate
from loopbook.structures import ControlLoop

# Skogestad's settings from chapter 11: primary, secondary, and single loop
PRIMARY, SECONDARY, SINGLE = PID(6.29, Ti=244), PID(0.301, Ti=48.6), PID(0.702, Ti=343)
TANK = plants.JacketedTank()
STEP, EVERY, BEGIN, UNTIL = 2, 2, 100, 900  # s
STRENGTHS = tuple(Q(n, 10) for n in (1, 2, 3, 5, 7, 10, 15, 20, 25, 30, 35, 40))
CHANGES = {
    "colder heating liquid": ("T_hin", 60, 55),
    "warmer product": ("T_pin", 20, 25),
    "a higher setpoint": ("T_SP", 40, 40.5),
}
TIMES = np.arange(0, UNTIL + 1, STEP * EVERY)


def controller(settings, u0, **more):
    """The practical controller as in the chapter: sampled every 2 s, behind a filter of 5 s."""
    return Controller(settings, step=STEP, u0=u0, T_filter=5, **more)


def single_loop():
    """The product's temperature controlled by the valve."""
    return [ControlLoop("TC3", controller(SINGLE, TANK.F_h, limits=(0, 2), w_d=0), "T_SP", "T_pm", "F_h")]


def cascade(strength):
    """The jacket's temperature controlled by the valve, and the product's by the setpoint of that loop."""
    settings = PID(strength * SECONDARY.Kp, SECONDARY.Ti)
    return [
        ControlLoop("TC1", controller(PRIMARY, TANK.T_h, w_d=0), "T_SP", "T_pm", "T_hSP"),
        ControlLoop("TC2", controller(settings, TANK.F_h, limits=(0, 2)), "T_hSP", "T_hm", "F_h"),
    ]


@functools.cache
def run_with(change, strength=None):
    """The simulation after a change, with a cascade of some strength or, without one, with the single loop."""
    name, before, after = CHANGES[change]
    inputs = {"T_SP": TANK.T_p} | {name: stepwise(before, {BEGIN: after})}
    return simulate(TANK, single_loop() if strength is None else cascade(strength), until=UNTIL, **inputs)


def area(run):
    """The area between setpoint and temperature, in K s."""
    return float(STEP * abs(run["T_SP"] - run["T_p"]).sum())


def respond(change, strength):
    """Answer for one change, and one strength of the secondary controller beside Skogestad's."""
    one, two = run_with(change), run_with(change, strength)
    signals = {"setpoint": two["T_SP"][::EVERY]}
    for name, run in (("single", one), ("cascade", two)):
        signals |= {f"T {name}": run["T_p"][::EVERY], f"F {name}": run["F_h"][::EVERY]}
    valve = abs(np.diff(two["F_h"])).sum(), abs(np.diff(one["F_h"])).sum()
    results = {
        "area, cascade": figures(area(two), unit="K\u202fs"),
        "area, single loop": figures(area(one), unit="K\u202fs"),
        "travel of the valve, cascade": figures(valve[0], 2, "kg/s"),
        "travel of the valve, single loop": figures(valve[1], 2, "kg/s"),
    }
    ratio = area(one) / area(two)
    end = -200 // STEP
    if abs(np.diff(two["F_h"][end:])).sum() > 1:
        verdict = "The inner loop oscillates and does not come to rest"
    elif np.ptp(two["T_p"][end:]) > 0.1:
        verdict = "The inner loop is too slow: the outer one oscillates"
    elif ratio > 1.05:
        verdict = f"The single loop has {ratio:.1f} times the area of the cascade"
    else:
        verdict = "The cascade is hardly better than the single loop" if ratio > 0.95 else "The single loop is better"
    return Answer(verdict, results, signals)


LESSON = Lesson(
    title="Live: a cascade, its secondary controller, and a single loop",
    about=(
        "The jacketed tank of Example 11.1 under both control systems, each with Skogestad's settings for an $M_s$ of "
        "1.7 at most, and simulated with the practical controller. After 100 s one thing changes. The gain of the "
        "secondary controller is multiplied by its strength."
    ),
    questions=(
        "Which of the three changes is the cascade made for, and which can it hardly help against?",
        "How weak may the secondary controller be until the cascade loses its advantage?",
        "And how strong, until the inner loop does not settle? What does the valve show long before that?",
    ),
    sliders=(
        Slider("change", "What changes", tuple(CHANGES), "colder heating liquid", words=tuple(CHANGES)),
        Slider("strength", "Strength of the secondary controller", STRENGTHS, Q(1)),
    ),
    panels=(Panel("temperature [°C]", 39.4, 40.8), Panel("heating flow [kg/s]", 0, 2)),
    curves=(
        Curve("setpoint", "setpoint", 0, "setpoint"),
        Curve("T single", "temperature, single loop", 0, 1),
        Curve("T cascade", "cascade", 0, "measurement"),
        Curve("F single", "flow, single loop", 1, 1),
        Curve("F cascade", "cascade", 1, "control signal"),
    ),
    times=TIMES,
    respond=respond,
)
