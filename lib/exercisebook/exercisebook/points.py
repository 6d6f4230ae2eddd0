"""The points at which formulas are compared, drawn from a text that no author of answers knows.

They are placed where the key has a safe value, so that a formula that has none there is not the key.
"""

from __future__ import annotations

import ast
import contextlib
import math
import random
from collections.abc import Collection, Iterable, Iterator, Mapping

import numpy as np

from exercisebook.arithmetic import Decimals, worked_out
from exercisebook.formulas import Formula, is_number
from exercisebook.freedoms import switches

#: So many points are drawn, and at least so many have a value of the key.
MOST, FEWEST = 120, 40
#: The size of a safe value of the key is between one divided by this and this.
LARGEST = 1e200
#: So many times are compared at most.
MOST_TIMES = 300
#: Of one part of a function, so many zeros are looked at.
MOST_MOMENTS = 20
#: So often points are drawn anew where the key has no safe value; the last ones from narrower ranges.
DRAWS = 6


def points_for(key: Formula, seed: str = "", real: Collection[str] = ()) -> dict[str, np.ndarray]:
    """Return values of the symbols of a formula at which others are compared with it: {symbol: array}.

    The symbol s takes complex values in the whole plane, of all sizes that the numbers of the key call for and of some
    decades on either side; other symbols are positive, or of either sign, two of three near one and the others of eight
    orders of magnitude.

    Arguments:
        key: the formula; with a safe value at each of the points, if there are such.
        seed: what they are drawn from, beside the key.
        real: the symbols that may be negative.

    >>> points = points_for(Formula("2*exp(-3*s)/(10*s + 1)", "s"), "a secret")
    >>> points["s"].shape, bool(np.isfinite(Formula("exp(-3*s)", "s")(**points)).all())
    ((120,), True)
    """
    dice = random.Random(f"{seed}\n{key.text}")
    sizes, kept = _sizes(key), []
    for draw in range(DRAWS):
        drawn = _drawn(key.symbols, sizes, dice, 1.0 if draw < DRAWS - 2 else 0.3)
        for name in sorted(real):
            drawn[name] = drawn[name] * [dice.choice((1, -1)) for _ in range(MOST)]
        kept.append({name: values[_safe(key, drawn)] for name, values in drawn.items()})
        found = {name: np.concatenate([one[name] for one in kept])[:MOST] for name in drawn}
        if not key.symbols or len(next(iter(found.values()))) >= (MOST if draw < DRAWS - 2 else FEWEST):
            break
    if key.symbols and len(next(iter(found.values()))) < FEWEST:  # worked out in more digits, then
        found = drawn
    if "s" in found:  # from small ones to large ones
        order = np.argsort(np.abs(found["s"]))
        found = {name: values[order] for name, values in found.items()}
    return found


def numbers_in(tree: ast.expr) -> Iterator[float]:
    """The sizes of the numbers of a formula, of those that stand together as one.

    >>> sorted(numbers_in(Formula("2*exp(-10*s/3)/(10*s + 1)", "s").tree))
    [1.0, 2.0, 3.0, 10.0, 10.0]
    """
    if is_number(tree) and not isinstance(tree, ast.Tuple | ast.Compare):
        with np.errstate(all="ignore"), contextlib.suppress(ArithmeticError):
            size = abs(complex(worked_out(tree, Decimals({}))))
            if math.isfinite(size) and size > 0:
                yield size
        return
    for part in ast.iter_child_nodes(tree):
        if isinstance(part, ast.expr) and not (isinstance(part, ast.Name)):
            yield from numbers_in(part)


def _sizes(key: Formula) -> list[float]:
    """The sizes of s at which something may happen in a key: one divided by a number of it, and ratios of two."""
    numbers = sorted({float(f"{size:.3g}") for size in numbers_in(key.tree) if 1e-9 < size < 1e9})
    sizes = {1 / size for size in numbers} | {one / other for one in numbers for other in numbers}
    return sorted(sizes | {1.0})


def _drawn(symbols: Iterable[str], sizes: list[float], dice: random.Random, share: float) -> dict[str, np.ndarray]:
    """Values of symbols; of a share of the usual ranges."""
    spans = [share * (1.2 if k % 3 else 9) for k in range(MOST)]
    found = {name: np.array([math.exp(dice.uniform(-a, a)) for a in spans]) for name in sorted({*symbols} - {"s"})}
    if "s" in symbols:
        least, most = math.log(sizes[0]) - 4 * share, math.log(sizes[-1]) + 4 * share
        values = []
        for k in range(MOST):
            if k % 2:  # near a size at which something may happen
                size = dice.choice(sizes) * math.exp(dice.uniform(-1.5, 1.5))
            else:
                size = math.exp(dice.uniform(least, most))
            # in the whole plane, and near the axis where exp(-3*s) leaves the range of decimal numbers elsewhere
            angle = math.copysign(math.pi / 2 + dice.gauss(0, 0.05), dice.uniform(-1, 1))
            if k % 4 < 3:
                angle = dice.uniform(-math.pi, math.pi)
            values.append(size * complex(math.cos(angle), math.sin(angle)))
        found["s"] = np.array(values)
    return found


def _safe(key: Formula, points: Mapping[str, np.ndarray]) -> np.ndarray:
    """Where a formula has a value that is far from the ends of the range of decimal numbers, and is sure."""
    shape = next((np.shape(values) for values in points.values()), ())
    found, error = (np.broadcast_to(one, shape) for one in key.with_errors(points))
    with np.errstate(all="ignore"):
        size = np.abs(found)
        return np.isfinite(size) & (error <= 1e-9 * size) & ((size == 0) | ((size > 1 / LARGEST) & (size < LARGEST)))


def times_for(key: Formula, until: float, seed: str = "") -> np.ndarray:
    """Return the times at which functions are compared with a key.

    They are finer in the beginning, and near the moments at which a step, a limiter or a piece of the key begins, and
    uneven: no simple number, at which a step might stand, is among them.

    Arguments:
        until: the end of the times.
        seed: what they are drawn from, beside the key.

    >>> times = times_for(Formula("Heaviside(t - 3)", "t"), until=10)
    >>> bool(times.min() > 0), bool(times.max() < 10), times.shape
    (True, True, (178,))
    """
    dice = random.Random(f"{seed}\n{key.text}")
    early = [10 ** dice.uniform(-9, -2) for _ in range(26)]
    late = [1 - 10 ** dice.uniform(-9, -3) for _ in range(4)]
    times = [until * share for share in early + late + [(k + dice.random()) / 120 for k in range(120)]]
    grid = until * np.linspace(0, 1, 2001)
    for switch in switches(key.tree):
        signs = np.real(worked_out(switch, Decimals({"t": grid}))) > 0
        for moment in grid[1:][np.diff(np.broadcast_to(signs, grid.shape)) != 0]:
            shares = [0.004 * 1.28 ** (k + dice.random()) for k in range(14)]
            times += [moment * (1 + sign * share) for share in shares for sign in (1, -1)]
    times = [one for one in times if 0 < one < until]
    return np.array(sorted(times[:MOST_TIMES]))


def moments_of(formula: Formula, until: float) -> np.ndarray:
    """Return the times just before and after the moments at which some part of a function of time is zero.

    There it may have a spike, or a step, that no drawn time would see.

    >>> moments_of(Formula("5 + Heaviside(t - 3) - Heaviside(t - 3.01)", "t"), until=10).round(3).tolist()
    [3.0, 3.0, 3.01, 3.01]
    """
    grid = until * np.linspace(1e-6, 1, 2001)
    begins, ends, parts = [], [], []
    for node in ast.walk(formula.tree):
        if isinstance(node, ast.BinOp) and isinstance(node.op, ast.Add | ast.Sub) and not is_number(node):
            signs = _real_values(node, grid) > 0
            changes = np.flatnonzero(signs[1:] != signs[:-1])[:MOST_MOMENTS]
            begins += [*grid[changes]]
            ends += [*grid[changes + 1]]
            parts += [node] * len(changes)
    found = []
    for begin, end, part in zip(begins[:MOST_TIMES], ends, parts, strict=False):
        rises = _real_values(part, np.array([end]))[0] > 0
        for _ in range(50):
            middle = (begin + end) / 2
            begin, end = (begin, middle) if (_real_values(part, np.array([middle]))[0] > 0) == rises else (middle, end)
        found += [begin * (1 - 1e-9), end * (1 + 1e-9)]
    return np.array(sorted(found))


def _real_values(part, times):
    with np.errstate(all="ignore"):
        return np.broadcast_to(np.real(worked_out(part, Decimals({"t": times}))), times.shape)
