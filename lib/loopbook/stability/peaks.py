"""Peaks of the sensitivity: their tops, and intervals of frequency around them."""

from __future__ import annotations

from typing import TYPE_CHECKING

if TYPE_CHECKING:
    import numpy

    from loopbook.stability.crossings import Positive
    from loopbook.stability.loops import Loops


def to_the_top(loops: Loops, question: Positive) -> None:
    """Move the highest values that were seen to the tops of their peaks."""
    import numpy

    every = numpy.flatnonzero((question.place > 0) & numpy.isfinite(question.place))
    if not len(every):
        return

    def at(w):
        A, B = loops.values(every, w, 2)
        return B, A + B

    best, places, bend = _climbed(at, question.place[every], 30)
    question.see(every, best, places)
    with numpy.errstate(divide="ignore", invalid="ignore"):
        question.width = float(numpy.clip((-2 / bend[0]) ** 0.5, 1e-7 * places[0], places[0] / 4))
    place = question.place[every]
    if loops.exact is not None and loops.doubtful(every, place, loops.C.value(every, place))[0]:
        # rounding made what was seen, also if that is higher than what is there
        question.most[0] = 0.0
        question.see(every, *_climbed(lambda w: [each.taylor(w, 2) for each in loops.exact[1:]], place, 8)[:2])


def _climbed(at, w, most):
    """The largest abs(B/C) that Newton's steps find, where, and the second derivative of twice its logarithm there."""
    import numpy

    best, places, settled = -numpy.ones(len(w)), w.copy(), numpy.zeros(len(w), dtype=bool)
    for _ in range(most):
        (up, up1, up2), (down, down1, down2) = (
            (abs(x[0]) ** 2, 2 * (x[1] * x[0].conj()).real, 2 * abs(x[1]) ** 2 + 4 * (x[2] * x[0].conj()).real)
            for x in at(w)
        )
        with numpy.errstate(divide="ignore", invalid="ignore"):
            height = numpy.sqrt(up / down)
            slope = up1 / up - down1 / down
            bend = up2 / up - (up1 / up) ** 2 - down2 / down + (down1 / down) ** 2
            step = numpy.where(bend < 0, -slope / bend, numpy.sign(slope) * 0.1 * w)
            # the next step would be about the square of this one, as a share of the peak's width
            small = (bend < 0) & (abs(step) <= numpy.maximum(1e-5 * numpy.sqrt(-2 / bend), 4e-16 * w))
        step = numpy.clip(numpy.nan_to_num(step), -0.3 * w, 0.3 * w)
        better = height > best
        best, places = numpy.where(better, height, best), numpy.where(better, w, places)
        if settled.all():
            break
        # what did not rise is tried again with half the step
        settled = settled | small | (~better & (abs(w - places) <= 1e-8 * places))
        w = numpy.where(better, w + step, (w + places) / 2)
    return best, places, bend


def with_peaks(which, a, b, peaks: numpy.ndarray):
    """Intervals that hold the peaks of their loops, in three pieces, of which one has the peak in its middle."""
    import numpy

    p = peaks[which]
    r = numpy.minimum(numpy.minimum(p - a, b - p), (b - a) / 8)
    edges = (a, p - r, p + r, b)
    which, a, b = numpy.tile(which, 3), numpy.concatenate(edges[:3]), numpy.concatenate(edges[1:])
    some = b > a
    return which[some], a[some], b[some]
