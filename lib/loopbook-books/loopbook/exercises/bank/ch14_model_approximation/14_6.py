"""The design of exercise 14.6."""

from loopbook import Loop
from loopbook.exercises.authoring import criterion, design, largest_sensitivity, pi_controller, settings, stable
from loopbook.exercises.bank.ch14_model_approximation.shared import times_until
from loopbook.figures import time_plot


def somewhat_more(area):
    """Some 15 % more than the integral of the error with the settings by the half rule."""
    value = 1.15 * float(area)
    return round(value) if value < 50 else 5 * round(value / 5)


def quick_and_robust(process, T_1, pid, limit):
    """A PI controller with a largest sensitivity of 1.8 and an integral of the error of at most a limit."""

    def response(pid):
        times = times_until(6 * T_1)
        y = Loop(process, pid).regulator.step(times)
        plot = time_plot({"$y$": (y, "measurement")}, times, "Your loop after a load step of 1 %", ylabel="$y$ [%]")
        return plot.area("$y$", label=f"at most {limit:g} % s")

    return design(
        settings(pid, "", "s", "the settings"),
        pi_controller(),
        stable(process),
        largest_sensitivity(process, 100 / T_1, below=1.8),
        criterion("the integral of the error", lambda pid: float(pid.Ti / pid.Kp), below=limit, unit="% s"),
        draws=response,
    )
