"""Python beside the page of exercise 1.6."""

import numpy as np

from exercisebook.parameters import written
from loopbook import diagrams as draw
from loopbook.exercises.authoring import criterion, design, number
from loopbook.figures import plane_plot


def both_demands(key, *limits):
    """A gain between two limits."""
    low, high, e_max, u_max = map(float, limits)

    def against_both_limits(Kp):
        gains = np.linspace(low / 2, max(1.3 * high, 1.1 * Kp), 200)
        curves = {"error that stays": (gains, low / gains), "noise of the control signal": (gains, gains / high)}
        curves["limit"] = gains, np.ones(200), "setpoint"
        plot = plane_plot(curves, "$K_p$", "part of what is allowed", "Both should be at most 1")
        return plot.points([Kp, Kp], [low / Kp, Kp / high], "your gain")

    noise = "the standard deviation of the control signal"
    return design(
        number(key, "", "the gain"),
        criterion("the gain is positive", lambda Kp: Kp > 0),
        criterion("the error that stays", lambda Kp: low * e_max / Kp, below=e_max, unit="cm"),
        criterion(noise, lambda Kp: Kp * u_max / high, below=u_max, unit="%"),
        draws=against_both_limits,
    )


def picture(reach, sigma, per_percent):
    """A tank with its level controller: the transmitter has a range of {reach} and a noise of {sigma}; a pump, of which
    one percent is {per_percent}, fills the tank."""
    layout = """
        .      .     .     K_p   .
        .      1     .     LC    .
        water  pump  2     .     .
        .      .     tank  LT    reach
        .      .     tank  .     drawn"""
    parts = {"pump": draw.pump(f"${written(per_percent)}$ L/s\nfor $1\\,\\%$"), "tank": draw.tank(level="h")}
    names = {"reach": f"$0$ to ${written(reach)}$ m,\nnoise ${written(sigma)}$ cm"}
    pipes, signals = "water pump 2 tank drawn", "tank LT LC 1 pump, K_p LC"
    return draw.instrumentation_diagram(layout, pipes, signals, parts, names)
