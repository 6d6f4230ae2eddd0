"""A state-space model with delay channels: what responses in time are computed from."""

from __future__ import annotations

from typing import TYPE_CHECKING, NamedTuple

if TYPE_CHECKING:
    from fractions import Fraction

    import numpy as np

__all__ = ["ChannelModel"]


class ChannelModel(NamedTuple):
    """A state-space model with delay channels: what `System.state_space` returns.

    x' = A x + B1 u + B2 w,  y = C1 x + D11 u + D12 w,  z = C2 x + D21 u + D22 w,  and w_k(t) = z_k(t - delays[k]).
    The arrays are two-dimensional; `delays` is a list of fractions.
    """

    A: np.ndarray
    B1: np.ndarray
    B2: np.ndarray
    C1: np.ndarray
    C2: np.ndarray
    D11: np.ndarray
    D12: np.ndarray
    D21: np.ndarray
    D22: np.ndarray
    delays: list[Fraction]
