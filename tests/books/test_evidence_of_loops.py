"""Evidence about loops and responses holds for what is so and for nothing else."""

import control
import pytest

from bookledger.evidence.criteria import CRITERIA
from loopbook import PID, Loop, s
from loopbook.evidence import (
    EvidenceError,
    good_stability,
    no_overshoot,
    overshoots,
    poor_stability,
    poorly_damped,
    stable,
    unstable,
    well_damped,
)

LAG = 1 / (5 * s + 1)
LAGS = 1 / (s + 1) ** 3
INTEGRATOR = 1 / (s * (s + 1) ** 2)
#: Evidence, whether it holds and is a near thing, and what it says.
TOLD = [
    (no_overshoot(0.005), True, False, "overshoot 0.5 % ≤ 2 % (no overshoot: at most 2 % of the step)"),
    (no_overshoot(0.02), True, True, "overshoot 2 % ≤ 2 %"),
    (no_overshoot(0.021), False, True, "overshoot 2.1 % not ≤ 2 %"),
    (overshoots(0.3), True, False, "overshoot 30 % > 2 %"),
    (well_damped(0.1), True, False, "decay ratio 0.1 ≤ 0.25 (well damped: a decay ratio of at most 1/4)"),
    (well_damped(0.3), False, True, "decay ratio 0.3 not ≤ 0.25"),
    (poorly_damped(0.25), False, True, "decay ratio 0.25 not > 0.25"),
    (stable(LAG), True, False, "stable: no pole in the right half-plane"),
    (stable(Loop(LAG, PID(2, Ti=5))), True, False, "stable: gain margin ∞, phase margin 90°, Ms 1"),
    (stable(Loop(LAGS, PID(7.9))), True, True, "stable: gain margin 1.01"),
    (stable(Loop(1 / (s - 1), PID(1.02))), True, True, "stable: gain margin ∞"),
    (stable(1 / s), False, False, "on the limit of stability: poles on the imaginary axis"),
    (unstable(1 / (s**2 + 1)), False, False, "on the limit of stability: poles on the imaginary axis"),
    (unstable(1 / (s**2 - s + 1)), True, False, "unstable: 2 poles in the right half-plane"),
    (good_stability(Loop(INTEGRATOR, PID(3))), False, False, "unstable: 2 poles in the right half-plane"),
    (poor_stability(Loop(LAG, PID(-2))), True, False, "unstable: 1 pole in the right half-plane"),
    (poor_stability(Loop(LAGS, PID(8))), True, False, "gain margin 1 < 2 (good stability: a gain margin of at least"),
]


@pytest.mark.parametrize(("found", "holds", "near", "told"), TOLD)
def test_evidence_is_told_with_its_numbers(found, holds, near, told):
    assert (found.holds, found.near) == (holds, near)
    assert told in found.told()
    assert found.data["holds"] is holds
    assert found.quantities


@pytest.mark.parametrize(
    ("call", "words"),
    [
        (lambda: good_stability(LAG), "has no margins: expected a Loop"),
        (lambda: stable(control.ss([[-1, 0], [0, 1]], [[1], [0]], [[1, 0]], [[0]])), "state space"),
        (lambda: no_overshoot("0.1"), "a real number"),
    ],
)
def test_what_cannot_be_decided_is_refused_in_one_line(call, words):
    with pytest.raises(EvidenceError, match=words):
        call()


def test_margins_decide_good_stability():
    for gain in (0.1, 0.3, 0.6, 0.9, 1.1, 1.5, 2.5):
        loop = Loop(INTEGRATOR, PID(gain))
        margins = loop.margins() if loop.is_stable else None
        good = margins is not None and margins.gain_margin >= 2 and margins.phase_margin >= 30
        assert good_stability(loop).holds is good is not poor_stability(loop).holds
        assert stable(loop).holds is loop.is_stable is not unstable(loop).holds


def test_the_criteria_of_control_engineering_are_listed_with_all():
    assert {"no overshoot", "well damped", "good stability"} < {criterion.word for criterion in CRITERIA}
