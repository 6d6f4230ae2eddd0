"""Recorded signals: arrays of numbers at increasing times, checked in one place."""

from loopbook.inputs import real_numbers


def record(times, **signals):
    """Return times and signals as arrays of floats of one length, or raise ValueError."""
    import numpy

    times = real_numbers("times", times)
    if times.ndim != 1 or len(times) < 4 or not (numpy.diff(times) > 0).all():
        raise ValueError("the times must be an array of at least four increasing numbers")
    found = [real_numbers(f"values of {name}", signal) for name, signal in signals.items()]
    for name, signal in zip(signals, found, strict=True):
        if signal.shape != times.shape:
            raise ValueError(f"{name} has {signal.size} values for {len(times)} times")
    return times, *found


def sampling_step(times):
    """Return the time between two samples, or raise ValueError where they do not come evenly."""
    import numpy

    step = (times[-1] - times[0]) / (len(times) - 1)
    rounding = 2 * numpy.spacing(abs(times).max())  # as of seconds since 1970
    if abs(numpy.diff(times) - step).max() > 1e-6 * step + rounding:
        raise ValueError("the samples do not come evenly: expected times with one step between them")
    return float(step)
