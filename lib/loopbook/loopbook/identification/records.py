"""Recorded signals: arrays of numbers at increasing times, checked in one place."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from plainmath.validation import increasing, real_numbers

if TYPE_CHECKING:
    from numpy.typing import ArrayLike

EVEN = 1e-9  # by how much of a step samples that come evenly may be early or late


def record(times: ArrayLike, **signals: ArrayLike) -> tuple[np.ndarray, ...]:
    """Return times and signals as arrays of floats of one length, or raise ValueError.

    >>> record([0, 1, 2, 3], y=[0, 0, 1, 1])
    (array([0., 1., 2., 3.]), array([0., 0., 1., 1.]))
    """
    times = increasing("times", times, least=4)
    found = [real_numbers(f"values of {name}", signal) for name, signal in signals.items()]
    for name, signal in zip(signals, found, strict=True):
        if signal.shape != times.shape:
            raise ValueError(f"{name} has {signal.size} values for {len(times)} times")
    return times, *found


def even_step(times: np.ndarray) -> float | None:
    """Return the time between two samples; or None where they do not come evenly, apart from rounding.

    >>> import numpy as np
    >>> even_step(np.array([1.0, 1.5, 2.0])), even_step(np.array([1.0, 1.5, 2.1]))
    (0.5, None)
    """
    step = (times[-1] - times[0]) / (len(times) - 1)
    rounding = 2 * np.spacing(abs(times).max())  # as of seconds since 1970
    even = times[0] + step * np.arange(len(times))
    return float(step) if abs(times - even).max() <= EVEN * step + rounding else None
