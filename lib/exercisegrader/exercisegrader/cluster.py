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
    try:
        from distributed import Client
    except ImportError:
        raise GradingError("a cluster needs Dask: install the extra loopbook[cluster]") from None
    with _quiet():
        client = _client(Client, address)
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


def _client(make, address):
    """A client of the scheduler at an address. Raises GradingError where none answers in time.

    It is made in a thread: where something else answers, the library waits forever for the next word.
    """
    from distributed.comm.addressing import parse_address
    from distributed.comm.registry import get_backend

    made: list[Any] = []
    failed: list[BaseException] = []

    def connect():
        try:
            made.append(make(address, timeout=ANSWER, set_as_default=False))
        except (OSError, ValueError, TimeoutError) as problem:
            failed.append(problem)

    try:
        scheme, place = parse_address(address)
        get_backend(scheme).get_address_host(place)
    except ValueError as problem:
        raise GradingError(
            f"{address!r} is not the address of a scheduler ({problem}): expected one such as tcp://10.0.0.5:8786"
        ) from None
    thread = threading.Thread(target=connect, daemon=True)
    thread.start()
    thread.join(2 * ANSWER)
    if not made:
        why = failed[0] if failed else "what answers there is something else"
        raise GradingError(f"no Dask scheduler answers at {address}: {why}")
    return made[0]


@contextlib.contextmanager
def _quiet():
    """Keep Dask's own words on what goes wrong away: there is a sentence for it."""
    loggers = [logging.getLogger(name) for name in logging.root.manager.loggerDict if name.startswith("distributed")]
    levels = [logger.level for logger in loggers]
    for logger in loggers:
        logger.setLevel(logging.CRITICAL + 1)
    try:
        yield
    finally:
        for logger, level in zip(loggers, levels, strict=True):
            logger.setLevel(level)


def _threads(client):
    """How many tasks the workers take at a time, all together."""
    return sum(client.sync(client.scheduler.ncores, callback_timeout=ANSWER).values())


def _own_mark() -> Callable[[], str]:
    """Return a function that returns a text which differs where this library does.

    It is a function within one, because such a one travels as it is: a worker may not have it yet.
    """

    def mark() -> str:
        import hashlib
        from pathlib import Path

        import exercisegrader
        from exercisebook import plugins

        digest = hashlib.sha256()
        for folder in (*map(Path, exercisegrader.__path__), *plugins.folders()):
            for path in sorted(folder.rglob("*.py")):
                digest.update(path.read_bytes())
        return digest.hexdigest()

    return mark


def _demand_same(client, address):
    """Raise GradingError where a worker has another version of this library, or none."""
    mark = _own_mark()
    marks = client.run(mark, on_error="return")
    for worker, other in sorted(marks.items()):
        if other != mark():
            why = f" ({harmless(f'{type(other).__name__}: {other}')})" if isinstance(other, Exception) else ""
            raise GradingError(
                f"the worker {worker} of the cluster at {address} has another version of loopbook{why}: expected the "
                "one that is installed here"
            )


class _Workers(Executor):
    """The workers of a cluster, as an executor whose tasks end, whatever becomes of the cluster."""

    def __init__(self, client: Client, address: str):
        self._client, self._address = client, address
        self._running: dict[Future[Any], Any] = {}  # with the tasks, which Dask forgets where nobody holds them
        self._left = threading.Event()
        self._watcher = threading.Thread(target=self._watch, daemon=True)
        self._watcher.start()

    def submit(self, function: Callable[..., Any], /, *arguments: Any, **options: Any) -> Future[Any]:
        future: Future[Any] = Future()
        self._running[future] = None
        try:
            self._running[future] = task = self._client.submit(function, *arguments, pure=False, **options)
        except Exception as problem:  # without a scheduler
            self._end(future, problem=self._gone(problem))
        else:
            task.add_done_callback(lambda task: self._take(task, future))
        return future

    def _take(self, task, future):
        """Give what became of a task to the one who waits for it."""
        from distributed.scheduler import KilledWorker

        if task.status == "finished":
            try:
                self._end(future, task.result())
            except Exception as problem:
                self._end(future, problem=self._gone(problem))
            return
        problem = task.exception() if task.status == "error" else None
        if isinstance(problem, KilledWorker):
            self._end(future, "the workers on which it ran ended, one after another")
        elif isinstance(problem, GradingError):
            self._end(future, problem=problem)
        else:
            self._end(future, problem=self._gone(problem))

    def _end(self, future, result=None, problem=None):
        self._running.pop(future, None)
        with contextlib.suppress(InvalidStateError):  # it has ended already
            if problem is None:
                future.set_result(result)
            else:
                future.set_exception(problem)

    def _gone(self, problem):
        why = f" ({harmless(f'{type(problem).__name__}: {problem}')})" if problem else ""
        return GradingError(
            f"the cluster at {self._address} no longer answers{why}; what is graded is kept, and the same command goes "
            "on from there"
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
                problem = GradingError(
                    f"the cluster at {self._address} has had no worker for {PATIENCE} s; what is graded is kept, and "
                    "the same command goes on from there"
                )
            except Exception as why:
                problem = self._gone(why)
            for future in list(self._running):
                self._end(future, problem=problem)

    def shutdown(self, wait: bool = True, *, cancel_futures: bool = False) -> None:
        """Stop looking at the cluster; what runs on it ends with the client."""
        self._left.set()
