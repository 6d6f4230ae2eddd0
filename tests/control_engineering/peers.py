"""The peers of the benchmark: what a careful user of python-control, NumPy and SciPy would write for dead time.

A dead time becomes a Pade approximation, held as a chain of all-pass sections of second order. As a polynomial its
coefficients reach (2m)!/m!/delay^m, 1e31 for order 10 and a delay of 0.01, and so do the entries of the companion
matrix that `control.ss(control.tf(...))` makes. The poles still come out well, because `eigvals` balances. SciPy's
solver of Lyapunov equations does not, and its answer may have no right digit, with a warning or without.

The references are independent of both sides: series of delays, whose terms are inverted with many digits.
"""

from __future__ import annotations

import functools
import itertools
import math
from collections.abc import Callable, Iterable
from types import SimpleNamespace
from typing import NamedTuple

import control
import mpmath
import numpy as np
from scipy import linalg, optimize, signal


class Linear(NamedTuple):
    """A system x' = A x + B u, y = C x + D u, with the algebra of block diagrams and nothing else."""

    A: np.ndarray
    B: np.ndarray
    C: np.ndarray
    D: float

    def __mul__(self, first: Linear) -> Linear:  # the right one comes first, as in transfer functions
        A = np.block([[first.A, np.zeros((len(first.A), len(self.A)))], [self.B @ first.C, self.A]])
        return Linear(
            A, np.vstack([first.B, self.B * first.D]), np.hstack([self.D * first.C, self.C]), self.D * first.D
        )

    def __add__(self, other: Linear) -> Linear:
        A = linalg.block_diag(self.A, other.A)
        return Linear(A, np.vstack([self.B, other.B]), np.hstack([self.C, other.C]), self.D + other.D)

    def __neg__(self) -> Linear:
        return Linear(self.A, self.B, -self.C, -self.D)


def closed(forward: Linear, back: Linear | None = None) -> Linear:
    """forward/(1 + forward*back); without `back`, a unit feedback."""
    if back is None:
        gain = 1 / (1 + forward.D)
        A, B = forward.A - gain * forward.B @ forward.C, gain * forward.B
        return Linear(A, B, gain * forward.C, gain * forward.D)
    (A1, B1, C1, D1), (A2, B2, C2, D2) = forward, back
    gain = 1 / (1 + D1 * D2)
    A = np.block([[A1 - gain * D2 * B1 @ C1, -gain * B1 @ C2], [gain * B2 @ C1, A2 - gain * D1 * B2 @ C2]])
    B, C = np.vstack([gain * B1, gain * D1 * B2]), np.hstack([gain * C1, -gain * D1 * C2])
    return Linear(A, B, C, gain * D1)


def rational(above: list[float], below: list[float]) -> Linear:
    """A transfer function of low order, the highest power first, in companion form."""
    return Linear(*(matrix if k < 3 else float(matrix[0, 0]) for k, matrix in enumerate(signal.tf2ss(above, below))))


@functools.cache
def _unit_delay(order: int) -> Linear:
    """Pade's approximation of exp(-s): sections (s^2 - 2 z s + w^2)/(s^2 + 2 z s + w^2), each with unit Gramians."""
    chain = None
    for pole in np.roots(control.pade(1, order)[1]):
        z, w = -pole.real, abs(pole)
        if pole.imag > 1e-9 * w:
            A, B, C, D = [[0, w], [-w, -2 * z]], [[0], [2 * math.sqrt(z)]], [[0, -2 * math.sqrt(z)]], 1.0
        elif pole.imag > -1e-9 * w:
            A, B, C, D = [[-z]], [[math.sqrt(2 * z)]], [[math.sqrt(2 * z)]], -1.0
        else:
            continue
        section = Linear(np.array(A, float), np.array(B), np.array(C), D)
        chain = section if chain is None else section * chain
    return chain


def late(delay: float, order: int = 10) -> Linear:
    """Pade's approximation of exp(-delay*s) as a chain of all-pass sections."""
    A, B, C, D = _unit_delay(order)
    return Linear(A / delay, B / math.sqrt(delay), C / math.sqrt(delay), D)


def _in_control(system: Linear) -> control.StateSpace:
    return control.ss(*system)


#: The same block diagram is built of NumPy's arrays, or of python-control's systems.
IN_NUMPY = SimpleNamespace(rational=rational, late=late, closed=closed)
IN_CONTROL = SimpleNamespace(
    rational=lambda above, below: _in_control(rational(above, below)),
    late=lambda delay, order=10: _in_control(late(delay, order)),
    closed=lambda forward, back=1: control.feedback(forward, back),
)


def pi_loop(
    K: float, T: float, delay: float, Kp: float, Ti: float, kit: SimpleNamespace = IN_NUMPY, order: int = 10
) -> Linear | control.StateSpace:
    """The open loop of a lag with dead time under PI control."""
    return kit.rational([K], [T, 1]) * kit.late(delay, order) * kit.rational([Kp * Ti, Kp], [Ti, 0])


# ------------------------------------------------------------------------------------------------ responses


class Modes:
    """The step response of a Pade system as a sum of exponentials, from its eigenvalues and eigenvectors."""

    def __init__(self, system: Linear):
        self.poles, vectors = np.linalg.eig(system.A)
        self.final = system.D - (system.C @ np.linalg.solve(system.A, system.B)).item()
        self.shares = (system.C @ vectors)[0] * np.linalg.solve(vectors, system.B.astype(complex))[:, 0] / self.poles

    def step(self, times: np.ndarray) -> np.ndarray:
        y = np.full(np.shape(times), self.final)
        for pole, share in zip(self.poles, self.shares, strict=True):
            if pole.imag >= 0:
                y += (1 + (pole.imag > 0)) * (share * np.exp(pole * times)).real
        return y


def by_control(system: control.StateSpace, times: np.ndarray) -> np.ndarray:
    return control.forced_response(system, times, np.ones_like(times))[1]


# ------------------------------------------------------------------------------------------------ integrals and margins


def integral_of_square(L: Linear) -> float:
    """The integral of the squared error of the loop after a step of the setpoint, from a Lyapunov equation."""
    A, B, C = L.A - L.B @ L.C, L.B, L.C
    x = np.linalg.solve(A, B)
    return (x.T @ linalg.solve_continuous_lyapunov(A.T, -C.T @ C) @ x).item()


def pi_polynomials(K: float, T: float, delay: float, Kp: float, Ti: float, order: int = 10) -> control.TransferFunction:
    """The open loop of a lag with dead time under PI control, as one writes it first: a product of polynomials."""
    return control.tf(*control.pade(delay, order)) * control.tf([K], [T, 1]) * control.tf([Kp * Ti, Kp], [Ti, 0])


def companion(L: control.TransferFunction) -> Linear:
    """The same in state space, as `control.ss` converts it."""
    system = control.ss(L)
    return Linear(system.A, system.B, system.C, system.D.item())


def margins_on_grid(L: Callable[[np.ndarray], np.ndarray], omega: np.ndarray) -> tuple[float, float, float]:
    """Gain margin, phase margin and Ms of a loop with its exact dead time from a grid of frequencies, each refined.

    It cannot know what happens between two points, or beyond the last one, or whether the loop is stable.
    """
    values = L(1j * omega)

    def crossings(known: np.ndarray, function: Callable[[float], float]) -> list[float]:
        places = np.flatnonzero(known[:-1] * known[1:] < 0)
        return [optimize.brentq(function, omega[k], omega[k + 1], xtol=1e-15, rtol=1e-14) for k in places]

    half_turns = [w for w in crossings(values.imag, lambda w: L(1j * w).imag) if L(1j * w).real < 0]
    gains = [-1 / L(1j * w).real for w in half_turns]
    at_one = crossings(abs(values) - 1, lambda w: abs(L(1j * w)) - 1)
    phases = [(np.angle(L(1j * w)) + math.pi) % (2 * math.pi) for w in at_one]
    k = np.argmin(abs(1 + values))
    between = omega[max(k - 1, 0)], omega[min(k + 1, len(omega) - 1)]
    nearest = optimize.minimize_scalar(
        lambda w: abs(1 + L(1j * w)), bounds=between, method="bounded", options={"xatol": 1e-10}
    )
    return (
        min((g for g in gains if g > 1), default=math.inf),
        min((math.degrees(min(p, 2 * math.pi - p)) for p in phases), default=math.inf),
        1 / nearest.fun,
    )


# ------------------------------------------------------------------------------------------------ many settings


class PISettings:
    """Many PI settings of one lag with dead time at once, in batches of matrices and of frequencies."""

    def __init__(self, K: float, T: float, delay: float, Kp: np.ndarray, Ti: np.ndarray, order: int = 10):
        self.K, self.T, self.delay, self.Kp, self.Ti = K, T, delay, np.asarray(Kp), np.asarray(Ti)
        plant = rational([K], [T, 1]) * late(delay, order)
        n = len(plant.A)
        # the states of the plant and the integral of the error e = 1 - C x; u = Kp (e + q/Ti)
        self.A = np.zeros((len(self.Kp), n + 1, n + 1))
        self.A[:, :n, :n] = plant.A - self.Kp[:, None, None] * (plant.B @ plant.C)
        self.A[:, :n, n] = (self.Kp / self.Ti)[:, None] * plant.B[:, 0]
        self.A[:, n, :n] = -plant.C[0]
        self.C = np.append(plant.C[0], 0)
        self.B = np.ones((len(self.Kp), n + 1))
        self.B[:, :n] = self.Kp[:, None] * plant.B[:, 0]

    def unstable_poles(self) -> np.ndarray:
        return (np.linalg.eigvals(self.A).real > 0).sum(axis=1)

    @functools.cached_property
    def modes(self) -> tuple[np.ndarray, np.ndarray]:
        """Poles p and shares r of the output: y = 1 + sum r exp(p t)."""
        poles, vectors = np.linalg.eig(self.A)
        return poles, self.C @ vectors * np.linalg.solve(vectors, self.B.astype(complex)[..., None])[..., 0] / poles

    def step(self, times: np.ndarray) -> np.ndarray:
        poles, shares = self.modes
        return 1 + np.einsum("np,npt->nt", shares, np.exp(poles[..., None] * times)).real

    def ise(self) -> np.ndarray:
        poles, shares = self.modes
        pairs = shares[:, :, None] * shares[:, None, :] / (poles[:, :, None] + poles[:, None, :])
        return np.where((poles.real < 0).all(axis=1), -pairs.sum(axis=(1, 2)).real, math.inf)

    def Ms(self, points: int = 400) -> np.ndarray:
        """The largest sensitivity with exact dead time, on a grid, with a parabola through the three highest points."""
        omega = np.geomspace(0.02, 20, points) / self.delay
        plant = self.K * np.exp(-1j * omega * self.delay) / (1 + 1j * omega * self.T)
        distance = abs(1 + plant * self.Kp[:, None] * (1 + 1 / (1j * omega * self.Ti[:, None]))) ** 2
        k = np.clip(distance.argmin(axis=1), 1, points - 2)
        left, middle, right = (np.take_along_axis(distance, (k + j)[:, None], axis=1)[:, 0] for j in (-1, 0, 1))
        return 1 / np.sqrt(middle - (right - left) ** 2 / (8 * (left - 2 * middle + right)))


# ------------------------------------------------------------------------------------------------ sampled loops


def held_loop(K: float, T: float, whole: int, Kp: float, Ti: float, step: float, count: int) -> np.ndarray:
    """A lag with a dead time of whole samples under PI control, a step of the setpoint: the output as one writes it."""
    a = math.exp(-step / T)
    y, integral, late, outputs = 0.0, 0.0, [0.0] * whole, []
    for k in range(count + 1):
        outputs.append(y)
        error = 1 - y
        late.append(Kp * error + integral)
        integral += Kp * step / Ti * error
        y = a * y + K * (1 - a) * late[k]
    return np.array(outputs)


def sampled_loop(K: float, T: float, whole: int, Kp: float, Ti: float, step: float, count: int) -> np.ndarray:
    """The same by python-control, in discrete time."""
    a = math.exp(-step / T)
    process = control.tf([K * (1 - a)], [1, -a, *[0] * whole], step)
    pi = control.tf([Kp, Kp * (step / Ti - 1)], [1, -1], step)
    servo = control.ss(control.feedback(process * pi))
    times = step * np.arange(count + 1)
    return control.forced_response(servo, times, np.ones(count + 1)).outputs


# ------------------------------------------------------------------------------------------------ references

Function = Callable[[mpmath.mpc], mpmath.mpc]


def _talbot(F: Function, time: mpmath.mpf, points: int) -> mpmath.mpf:
    """The inverse Laplace transform of a function without dead time, by Talbot's contour."""
    r = mpmath.mpf(2 * points) / (5 * time)
    total = mpmath.exp(r * time) * F(r) / 2
    for k in range(1, points):
        angle = k * mpmath.pi / points
        cot = mpmath.cot(angle)
        slope = mpmath.mpc(1, angle + (angle * cot - 1) * cot)
        s = r * angle * mpmath.mpc(cot, 1)
        total += (mpmath.exp(time * s) * F(s) * slope).real
    return total * r / points


def by_series(
    times: Iterable[float], above: dict[float, Function], first: Function, below: dict[float, Function]
) -> np.ndarray:
    """The step response of above/(first + below), with dead times `{delay: factor}` in both, as a series of delays.

    A term is a rational function with a sum of those delays; up to a time there are finitely many.
    """
    delays = list(below)

    def words(room: float, among: int = 0) -> Iterable[tuple[int, ...]]:
        if among == len(delays):
            yield ()
            return
        for n in range(int(room / delays[among]) + 1):
            for rest in words(room - n * delays[among], among + 1):
                yield (n, *rest)

    def value(time: float) -> mpmath.mpf:
        total = mpmath.mpf(0)
        for (delay, factor), counts in itertools.chain.from_iterable(
            ((item, counts) for counts in words(time - item[0])) for item in above.items() if time > item[0]
        ):
            left = mpmath.mpf(time) - delay - sum(n * mpmath.mpf(d) for n, d in zip(counts, delays, strict=True))
            if left <= 0:
                continue
            several = math.factorial(sum(counts)) // math.prod(map(math.factorial, counts))

            def term(s: mpmath.mpc, factor: Function = factor, counts: tuple[int, ...] = counts) -> mpmath.mpc:
                product = factor(s) / (s * first(s) ** (1 + sum(counts)))
                for n, d in zip(counts, delays, strict=True):
                    product *= (-below[d](s)) ** n
                return product

            total += several * _talbot(term, left, 40)
        return total

    with mpmath.workdps(45):
        return np.array([float(value(time)) for time in times])
