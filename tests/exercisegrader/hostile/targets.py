"""What masks are tried on: questions after a formula, each with right and wrong answers."""

import zlib
from typing import NamedTuple

from draws import draws
from exercisebook.judging import RIGHT, UNJUDGED, is_right, judge
from exercisebook.kinds import Kind
from hostile.masked import SPOILED, hedged


class Target(NamedTuple):
    """A question after a formula, its right answer, wrong ones, and a variable in all of them."""

    kind: Kind
    right: str
    wrong: tuple[str, ...]
    x: str

    def filled(self, form):
        """The right answer in a form, in the place of R, with the variable in that of X."""
        return form.replace("R", f"({self.right})").replace("X", self.x)


def target(kind, *wrong):
    return Target(kind, kind.key.text, wrong, kind.symbols[0])


def assert_masked_earns_nothing(mask, targets):
    """On some of the targets, each with one of its wrong answers; others for other masks."""
    number = zlib.crc32(mask.name.encode())
    for k in range(draws(3)):
        one = targets[(number + 17 * k) % len(targets)]
        answer = mask.wears(one.wrong[(number // len(targets) + k) % len(one.wrong)], one.x)
        assert not is_right(one.kind, answer), (one.kind.solution, answer)


def assert_looked_at(mask, one):
    """An answer that has no value somewhere is not right, and somebody is told."""
    verdict = judge("H", one.kind, mask.wears(one.right, one.x))
    assert verdict.status != RIGHT, verdict
    assert verdict.look or verdict.status == UNJUDGED, verdict


def assert_spoiled_earns_nothing(name, targets):
    for one in targets:
        answer = one.filled(SPOILED[name])
        assert not is_right(one.kind, answer), (one.kind.solution, answer)


def assert_stays_right(form, targets):
    for one in targets:
        assert is_right(one.kind, one.filled(form)), (one.kind.solution, one.filled(form))


def assert_earns_nothing(kind, answer):
    verdict = judge("x", kind, answer)
    assert verdict.status != RIGHT, (verdict, kind.solution, answer)


def assert_hedged_earns_nothing(hedge, pairs):
    for kind, right, wrong in pairs:
        assert_earns_nothing(kind, hedged(hedge, right, wrong))


def assert_each_alone_is_judged(pairs):
    for kind, right, wrong in pairs:
        assert is_right(kind, right), (kind.solution, right)
        assert not is_right(kind, wrong), (kind.solution, wrong)
