"""The formulas of exercise 16.5, and the two questions put to them."""

import sympy

_FORMULAS = {
    "(0.4 + 0.6*tau/theta)/K": (
        r"K_c = \frac{1}{K}\left(0.4 + 0.6\,\frac{\tau}{\theta}\right)",
        "",
        "only a ratio of times is in the bracket, and for a long lag the gain tends to $0.6/(k\\theta)$",
    ),
    "(0.4 + 0.6*tau)/K": (
        r"K_c = \frac{1}{K}\left(0.4 + 0.6\,\tau\right)",
        "units",
        "a time is added to a pure number",
    ),
    "0.8*sqrt(tau/theta)/K": (
        r"K_c = \frac{0.8}{K}\sqrt{\frac{\tau}{\theta}}",
        "limit",
        "with $K = k\\tau$ the gain is $0.8/(k\\sqrt{\\tau\\theta})$, which vanishes for a long lag",
    ),
    "(tau + 0.5*theta)/(K*(tau_c + theta))": (
        r"K_c = \frac{\tau + 0.5\,\theta}{K\,(\tau_c + \theta)}",
        "",
        "times are divided by times, and for a long lag the gain tends to $1/(k(\\tau_c + \\theta))$",
    ),
    "(tau + 0.5)/(K*(tau_c + theta))": (
        r"K_c = \frac{\tau + 0.5}{K\,(\tau_c + \theta)}",
        "units",
        "a pure number is added to a time",
    ),
    "(0.7 + 0.3*theta/tau)/K": (
        r"K_c = \frac{1}{K}\left(0.7 + 0.3\,\frac{\theta}{\tau}\right)",
        "limit",
        "with $K = k\\tau$ the gain is about $0.7/(k\\tau)$, which vanishes for a long lag",
    ),
    "theta*(3 + 0.3*theta/tau)/(1 + 2*theta/tau)": (
        r"\tau_I = \theta\,\frac{3 + 0.3\,\theta/\tau}{1 + 2\,\theta/\tau}",
        "",
        "a time, multiplied by ratios, and for a long lag it tends to $3\\theta$",
    ),
    "theta*(3 + 0.3*theta)/(1 + 2*theta/tau)": (
        r"\tau_I = \theta\,\frac{3 + 0.3\,\theta}{1 + 2\,\theta/\tau}",
        "units",
        "a time is added to a pure number",
    ),
    "theta*(3 + 0.3*tau/theta)/(1 + 2*theta/tau)": (
        r"\tau_I = \theta\,\frac{3 + 0.3\,\tau/\theta}{1 + 2\,\theta/\tau}",
        "limit",
        "for a long lag it grows with $0.3\\tau$, without end",
    ),
    "0.4*theta/(1 + 0.2*theta/tau)": (
        r"\tau_D = \frac{0.4\,\theta}{1 + 0.2\,\theta/\tau}",
        "",
        "a time, divided by a pure number, and for a long lag it tends to $0.4\\theta$",
    ),
    "0.4/(1 + 0.2*theta/tau)": (
        r"\tau_D = \frac{0.4}{1 + 0.2\,\theta/\tau}",
        "units",
        "a derivative time that is a pure number",
    ),
    "0.4*sqrt(theta*tau)": (
        r"\tau_D = 0.4\,\sqrt{\theta\,\tau}",
        "limit",
        "for a long lag it grows with $\\sqrt{\\tau}$, without end",
    ),
}


def printed(*formulas):
    """The formulas as they stand on the copy."""
    return [_FORMULAS[one][0] for one in formulas]


def judged(*formulas):
    """What can be said of each."""
    return [_FORMULAS[one][2] for one in formulas]


def listed(letters):
    """Letters in a sentence."""
    return " and ".join(letters)


def which(fault, *formulas):
    """The letters of those that have a fault."""
    return [letter for letter, one in zip("ABCD", formulas, strict=True) if _FORMULAS[one][1] == fault]


def _value(formula, **numbers):
    return float(sympy.sympify(formula).subs(numbers))


def failing_in_units(*formulas):
    """The letters of those whose value depends on the unit of time: a gain should stay, and a time be 60 times it."""
    hours, minutes = {"tau": 3, "theta": 0.7, "tau_c": 0.4}, {"tau": 180, "theta": 42, "tau_c": 24}
    found = []
    for letter, one, times in zip("ABCD", formulas, (1, 1, 60, 60), strict=True):
        if abs(_value(one, K=2, **minutes) / (times * _value(one, K=2, **hours)) - 1) > 1e-9:
            found.append(letter)
    return found


def failing_in_limit(a, b, c, d, units):
    """The letters of the others that go on falling or growing with a long lag and its gain."""
    found = []
    for letter, one in zip("ABCD", (a, b, c, d), strict=True):
        long, longer = (_value(one, K=2 * tau, tau=tau, theta=0.7, tau_c=0.4) for tau in (1e7, 1e8))
        if letter not in units and abs(longer / long - 1) > 0.1:
            found.append(letter)
    return found
