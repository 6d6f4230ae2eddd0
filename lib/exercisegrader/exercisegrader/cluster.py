"""A Dask cluster that is there already, as the place where submissions are graded.

A cluster fails in its own ways: workers end, all of them or those that one submission ends; the scheduler goes; another
version of this library is installed. Each is one sentence, and no wait without an end.
"""

from __future__ import annotations

import contextlib
import logging
import threading
from collections.abc import Callable, Iterator
from concurrent.futures import Executor, Future, InvalidStateError
from importlib.metadata import version as installed
from time import monotonic
from typing import TYPE_CHECKING, Any

from exercisebook.judging import harmless
from exercisegrader import GradingError

if TYPE_CHECKING:
    from distributed import Client

#: How long (s) tasks wait while there is no worker: one that is restarted is back earlier.
PATIENCE = 20
#: How often (s) the cluster is looked at, and how long the scheduler may take to answer.
WATCH, ANSWER = 1, 10


@contextlib.contextmanager
def connected(address: str) -> Iterator[tuple[Executor, int]]:
    """Yield an executor of the cluster's workers, and how many tasks they take at a time.

    Its tasks end with a GradingError where the scheduler no longer answers, or no worker is there for PATIENCE.

    Raises GradingError where distributed is not installed, nobody answers, no worker is there, or one has another
    version of this library.
    """
    disabled = logging.root.manager.disable
    logging.disable(logging.CRITICAL)  # what goes wrong is said here, and not by Dask
    try:
        client = _client(address)
        try:
            threads = _threads(client)
            if not threads:
                raise GradingError(f"the cluster at {address} has no workers")
            _demand_same(client, address)
            with _Workers(client, address) as executor:
                yield executor, threads
        finally:
            # a scheduler that is gone makes this wait, and complain
            with contextlib.suppress(Exception):
                client.close(timeout=ANSWER)
    finally:
        logging.disable(disabled)


def _client(address):
    """A client of the scheduler at an address. Raises GradingError where none answers in time.

    It is made in a thread: where something else answers, the library waits forever for the next word.
    """
    try:
        from distributed import Client
    except ImportError:
        raise GradingError("a cluster needs Dask: install the extra exercisegrader[cluster]") from None
    made, why = [], ["what answers there is something else"]

    def connect():
        try:
            made.append(Client(address, timeout=ANSWER, set_as_default=False))
        except (OSError, ValueError, TimeoutError) as problem:
            why.append(str(problem))

    if "://" in address:
        thread = threading.Thread(target=connect, daemon=True)
        thread.start()
        thread.join(2 * ANSWER)
    else:
        why.append("it is no address of one")
    if not made:
        raise GradingError(
            f"no Dask scheduler answers at {address!r} ({why[-1]}): expected an address such as tcp://10.0.0.5:8786"
        )
    return made[0]


def _threads(client):
    """How many tasks the workers take at a time, all together."""
    return sum(client.sync(client.scheduler.ncores, callback_timeout=ANSWER).values())


def _demand_same(client, address):
    """Raise GradingError where a worker has another version of this library, or none."""
    here = installed("exercisegrader")
    for worker, there in sorted(client.run(installed, "exercisegrader", on_error="return").items()):
        if there != here:
            says = "no exercisegrader" if isinstance(there, Exception) else f"exercisegrader {there}"
            raise GradingError(f"the worker {worker} of the cluster at {address} has {says}: expected {here}, as here")


class _Workers(Executor):
    """The workers of a cluster, as an executor whose tasks end, whatever becomes of the cluster."""

    def __init__(self, client: Client, address: str):
        self._client, self._address = client, address
        self._running: dict[Future[Any], Any] = {}  # with the tasks, which Dask forgets where nobody holds them
        self._left = threading.Event()
        threading.Thread(target=self._watch, daemon=True).start()

    def submit(self, function: Callable[..., Any], /, *arguments: Any, **options: Any) -> Future[Any]:
        future: Future[Any] = Future()
        self._running[future] = None
        try:
            self._running[future] = task = self._client.submit(function, *arguments, pure=False, **options)
            task.add_done_callback(lambda task: self._take(task, future))
        except Exception as problem:  # without a scheduler
            self._end(future, problem=self._gone(problem))
        return future

    def _take(self, task, future):
        """Give what became of a task to the one who waits for it."""
        from distributed.scheduler import KilledWorker

        try:
            if task.status not in ("finished", "error"):
                raise RuntimeError(f"a task is {task.status}")
            self._end(future, task.result())
        except KilledWorker:
            self._end(future, "the workers on which it ran ended, one after another")
        except GradingError as problem:
            self._end(future, problem=problem)
        except Exception as problem:
            self._end(future, problem=self._gone(problem))

    def _end(self, future, result=None, problem=None):
        self._running.pop(future, None)
        with contextlib.suppress(InvalidStateError):  # it has ended already
            future.set_exception(problem) if problem else future.set_result(result)

    def _gone(self, problem):
        why = harmless(f"{type(problem).__name__}: {problem}")
        return GradingError(
            f"the cluster at {self._address} no longer answers ({why}); what is graded is kept, and the same command "
            "goes on from there"
        )

    def _watch(self):
        """End all tasks where no worker is there for a while, or the scheduler does not answer."""
        seen = monotonic()
        while not self._left.wait(WATCH):
            try:
                if _threads(self._client):
                    seen = monotonic()
                if monotonic() < seen + PATIENCE:
                    continue
                raise TimeoutError(f"there has been no worker for {PATIENCE} s")
            except Exception as problem:
                for future in list(self._running):
                    self._end(future, problem=self._gone(problem))

    def shutdown(self, wait: bool = True, *, cancel_futures: bool = False) -> None:
        """Stop looking at the cluster; what runs on it ends with the client."""
        self._left.set()
