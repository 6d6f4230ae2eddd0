"""The largest sensitivity Ms, of one loop or of many at once."""

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
    w = question.place[every]
    best = -numpy.ones(len(every))
    places = w.copy()
    for _ in range(30):
        A, B = loops.values(every, w, 2)
        C = A + B
        (up, up1, up2), (down, down1, down2) = (
            (abs(x[0]) ** 2, 2 * (x[1] * x[0].conj()).real, 2 * abs(x[1]) ** 2 + 4 * (x[2] * x[0].conj()).real)
            for x in (B, C)
        )
        with numpy.errstate(divide="ignore", invalid="ignore"):
            height = numpy.sqrt(up / down)
            slope = up1 / up - down1 / down
            bend = up2 / up - (up1 / up) ** 2 - down2 / down + (down1 / down) ** 2
            step = numpy.where(bend < 0, -slope / bend, numpy.sign(slope) * 0.1 * w)
        step = numpy.clip(numpy.nan_to_num(step), -0.3 * w, 0.3 * w)
        better = height > best
        done = ~better | (abs(step) <= 1e-9 * w)
        best[better], places[better] = height[better], w[better]
        # what did not rise is tried again with half the step
        w = numpy.where(better, w + step, (w + places) / 2)
        if done.all() and (abs(w - places) <= 1e-8 * places).all():
            break
    question.see(every, best, places)


def with_peaks(which, a, b, peaks: numpy.ndarray):
    """Intervals that hold the peaks of their loops, in three pieces, of which one has the peak in its middle."""
    import numpy

    p = peaks[which]
    r = numpy.minimum(numpy.minimum(p - a, b - p), (b - a) / 8)
    edges = (a, p - r, p + r, b)
    which, a, b = numpy.tile(which, 3), numpy.concatenate(edges[:3]), numpy.concatenate(edges[1:])
    some = b > a
    return which[some], a[some], b[some]
