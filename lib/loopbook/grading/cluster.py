"""A Dask cluster that is there already, as the place where submissions are graded."""

from __future__ import annotations

import contextlib
from collections.abc import Iterator
from concurrent.futures import Executor

from loopbook.grading import GradingError


@contextlib.contextmanager
def connected(address: str) -> Iterator[tuple[Executor, int]]:
    """Yield an executor of the cluster's workers, and how many tasks they take at a time.

    Raises GradingError where distributed is not installed, nobody answers, or no worker is there.
    """
    try:
        from distributed import Client
    except ImportError:
        raise GradingError("a cluster needs Dask: install the extra loopbook[cluster]") from None
    try:
        client = Client(address, timeout=10, set_as_default=False)
    except (OSError, ValueError, TimeoutError) as problem:
        raise GradingError(f"no Dask scheduler answers at {address}: {problem}") from None
    with client:
        threads = sum(client.nthreads().values())
        if not threads:
            raise GradingError(f"the cluster at {address} has no workers")
        with client.get_executor(pure=False) as executor:
            yield executor, threads
