"""Answers that are settings of a controller, in the form that is asked."""

import numpy as np

from exercisebook.judging import MISTAKE, RIGHT, UNJUDGED, WRONG
from judged import assert_judged
from loopbook import s
from loopbook.exercises.authoring import settings
from loopbook.pid import PID

PI = settings(PID(2, Ti=10), gain="%/K", what="the settings")
PARALLEL = settings(PID(2.5, Ti=10, Td=1.6), gain="%/K", what="the settings", form="parallel")
SERIAL = settings(PID(2, Ti=8, Td=2, form="serial"), form="serial")
ANY = settings(PID(2.5, Ti=10, Td=1.6), gain="%/K", what="the settings")

JUDGED = [
    (PI, PID(2, Ti=10), RIGHT, "right"),
    (PI, PID(2, Ti=10, form="serial"), RIGHT, "right"),
    (PI, {"Kp": "2 %/K", "Ti": "10 s"}, RIGHT, "right"),
    (PI, {"Kp": 2, "Ti": "1 min"}, WRONG, "Kp is right; Ti is not: too large"),
    (PI, (2, 10), RIGHT, "right"),
    (PI, PID(-2, Ti=10), MISTAKE, "sign of Kp"),
    (PI, PID(0.5, Ti=10), MISTAKE, "inverted"),
    (PI, PID(50, Ti=10), MISTAKE, "proportional band"),
    (PI, PID(2, Ti=0.2), MISTAKE, "integral gain"),
    (PI, {"Kp": 2, "Ki": 0.2}, RIGHT, "Ti = 10 from the gain Ki"),
    (ANY, {"Kp": 2.5, "Ki": 0.25, "Kd": 4}, RIGHT, "Td = 1.6 from the gain Kd"),
    (PI, {"Kp": 2, "Ki": 3}, WRONG, "Kp is right; Ti is not"),
    (PI, {"Kp": 2, "Ki": 0}, UNJUDGED, "from Ki follows no Ti"),
    (PI, {"Kp": 2, "Ti": 10, "Ki": 3}, UNJUDGED, "Ki is not a setting"),
    (PI, {"Kp": 2, "PB": 50}, UNJUDGED, "PB is not a setting"),
    (PI, {2, 10}, UNJUDGED, "a set has no order"),
    (PI, {"Kp = 2", "Ti = 10"}, UNJUDGED, "a set has no order"),
    (PI, {"Kp": 2, "Kc": 2, "Ti": 10}, UNJUDGED, "two values for Kp"),
    # as people write settings
    *(
        (PI, text, RIGHT, "right")
        for text in (
            "PI(2, 10)",
            "PI(2, Ti=10)",
            "PID(2, Ti=10)",
            "PID(Kp=2, Ti=10)",
            "Kp=2, Ti=10 s",
            "Kp = 2, Ti = 10",
            "Kc = 2; tau_I = 10",
            "Kc=2 and tauI=10 s",
            "K_p = 2 %/K, T_i = 10 s",
            r"K_{c} = 2, \tau_I = 10",
            "(2, 10)",
            "2; 10",
            "[2, 10]",
            "PID(2, 10)",
            "PI: Kp = 2, Ti = 10",
            "Kp: 2, Ti: 10",
            "Kp=2\nTi=10",
            "{'Kp': 2, 'Ti': 10}",
            "{Kp: 2, Ti: 10}",
            "gain = 2, integral time = 10 s",
            "Kp = 2,0; Ti = 10,0 s",
            "pid(2, 10)",
            "Kp=2 Ti=10",
            "P = 2, Ti = 10.",
            "PI with Kp = 2 and Ti = 10 s",
            "a PI controller with gain 2 %/K and integral time 10 s",
            "PI, Kc = 2, tau_I = 10",
            "gain of 2 and integral time of 10 s",
            "Kp 2 Ti 10",
            "Kp = 2 / Ti = 10 s",
        )
    ),
    *(
        (PI, one, RIGHT, "right")
        for one in (
            {"Kc": 2, "tau_I": 10},
            {"K_c": 2, "T_i": 10},
            {"K_p": 2, "TI": 10},
            {"kc": "2", "tauI": "10 s"},
            {"gain": 2, "Ti": 10},
            [{"Kp": 2, "Ti": 10}],
        )
    ),
    *(
        (settings(PID(2)), one, RIGHT, "right")
        for one in ("P: 2", "Kp = 2", "P(2)", {"Kc": 2}, {"Kp": 2, "Ti": "∞"}, "Kp = 2, Ti = inf", "Kp=2, Ti=∞")
    ),
    *(
        (ANY, one, RIGHT, "right")
        for one in (
            "PID(2.5, 10, 1.6)",
            "Kc=2.5, tauI=10, tauD=1.6",
            "PID(2, 8, 2, form='serial')",
            "Kp = 2,5, Ti = 10, Td = 1,6",
            {"Kc": 2.5, "tau_I": 10, "tau_D": 1.6},
        )
    ),
    # the form in words
    *(
        (PARALLEL, text, RIGHT, "right")
        for text in (
            "2.5, 10, 1.6 (parallel)",
            "parallel: 2.5, 10, 1.6",
            "parallel form, Kp = 2.5, Ti = 10, Td = 1.6",
            "Kp = 2.5, Ti = 10, Td = 1.6, in parallel form",
            "PID(2.5, 10, 1.6), ideal",
        )
    ),
    *((ANY, text, RIGHT, "right") for text in ("2, 8, 2, serial form", "Kp = 2; Ti = 8; Td = 2 (series form)")),
    # transfer functions with numbers
    *(
        (PI, one, RIGHT, "right, read as Kp = 2\N{NO-BREAK SPACE}%/K, Ti = 10\N{NO-BREAK SPACE}s")
        for one in (
            2 * (1 + 1 / (10 * s)),
            "2*(1+1/(10*s))",
            "2(1 + 1/(10 s))",
            "2 + 0,2/s",
            "C(s) = 2(10s+1)/(10s)",
            r"2\left(1+\frac{1}{10s}\right)",
            "2000(s/100 + 0.001)/(10 s)",
            PID(2, Ti=10).expr,
        )
    ),
    *(
        (ANY, one, RIGHT, "Td = 1.6\N{NO-BREAK SPACE}s, parallel form")
        for one in (PID(2.5, 10, 1.6).expr, PID(2, 8, 2, form="serial").expr, "2.5(1 + 1/(10s) + 1.6s)")
    ),
    (SERIAL, "2.5*(1 + 1/(10*s) + 1.6*s)", RIGHT, "right, read as Kp = 2, Ti = 8\N{NO-BREAK SPACE}s"),
    (SERIAL, "2.5*(1 + 1/(3*s) + 1.6*s)", WRONG, ""),  # of which there is no serial form
    *(
        (settings(PID(2, Ti, Td, 0.1 * Td)), PID(2, Ti, Td, 0.1 * Td).expr, RIGHT, "Tf")
        for Ti, Td in ((0.01, 0.002), (10, 1.6), (4000, 900))
    ),
    (PI, "2 + 0.1/s", MISTAKE, "Kp is right; Ti: it is off by a factor of 2"),
    (PI, "2(1 + 1/10s)", UNJUDGED, "may be .../(10*s)"),
    *(
        (PI, one, UNJUDGED, "no controller")
        for one in (
            "2*s",
            "1/s",
            "2*(1 + 1/(-10*s))",
            "2*(1 + 1/(10*s))**2",
            "K*(1 + 1/s)",
            "2*exp(-s)/s",
            "s/(1 - s)",
            "1/(s - 1.3)",
            "0*s",
            "1/(s*s*s*s*s*s*s*s*s)",
            s**900,
            "sqrt(-1)*(1 + 1/s)",
        )
    ),
    # what was read is said of all settings
    (PI, "Kp = 2,0 %/K, Ti = 10 s", RIGHT, "right, read as Kp = 2\N{NO-BREAK SPACE}%/K, Ti = 10\N{NO-BREAK SPACE}s"),
    (PI, {"Kc": "2", "Ti": "1/6 min"}, RIGHT, "right, read as Kp = 2\N{NO-BREAK SPACE}%/K, Ti = 10\N{NO-BREAK SPACE}s"),
    *(
        (PI, text, UNJUDGED, "no controller")
        for text in ("Kp = 2, Kp = 3, Ti = 10", "2", "PI", "good settings", "Ti = 10", "I: 10", "2 or 10")
    ),
    (PI, 2, UNJUDGED, "no controller"),
    (PI, PID(2), MISTAKE, "Kp is right; Ti: the integral term is missing"),
    (ANY, PID(2, Ti=8, Td=2, form="serial"), RIGHT, "right"),
    (PARALLEL, PID(2, Ti=8, Td=2, form="serial"), MISTAKE, "asks for its parallel form"),
    (PARALLEL, PID(2, Ti=8, Td=2), MISTAKE, "numbers of the serial form"),
    (PARALLEL, PID(2.5, Ti=1.6, Td=10), MISTAKE, "exchanged"),
    (PARALLEL, PID(2.5, Ti=10, Td=1.6, form="serial"), WRONG, "not right"),
    # in other forms and spellings
    (PI, "2, 10", RIGHT, "right"),
    (PI, [[2, 10]], RIGHT, "right"),
    (PI, (2, np.array([10, 11])), UNJUDGED, "2 values"),
    (settings(PID(2)), (2, "inf"), RIGHT, "right"),
]


def test_judging(subtests):
    for kind, given, status, says in JUDGED:
        with subtests.test(f"{given!r:.60}"):
            assert_judged(kind, given, status, says)
