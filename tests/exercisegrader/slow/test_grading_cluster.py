"""A Dask cluster that fails under the grader: each time one sentence, and no wait without an end."""

import os
import socket
import subprocess
import sys
import time

import pytest

from exercisegrader import GradingError, cluster
from exercisegrader.cluster import connected

pytest.importorskip("distributed")


class Cluster:
    """A scheduler and a worker, processes of their own that can be killed."""

    def __init__(self, folder):
        self.file = folder / "scheduler.json"
        self.scheduler = self._started("dask_scheduler", "--port", "0", "--host", "127.0.0.1", "--no-dashboard")
        self.worker = self._started("dask_worker", "--no-nanny", "--nthreads", "1", "--no-dashboard")
        self.address = f"file://{self.file}"

    def _started(self, name, *options):
        command = [sys.executable, "-m", f"distributed.cli.{name}", "--scheduler-file", str(self.file), *options]
        return subprocess.Popen(command, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)

    def ready(self):
        """The address, once there is a worker."""
        from distributed import Client

        while not self.file.exists():
            time.sleep(0.1)
        with Client(scheduler_file=str(self.file), timeout=60) as client:
            client.wait_for_workers(1, timeout=60)
            return client.scheduler.address

    def close(self):
        for process in (self.worker, self.scheduler):
            process.kill()
            process.wait()


@pytest.fixture
def failing(tmp_path, monkeypatch):
    monkeypatch.setattr(cluster, "PATIENCE", 2)
    monkeypatch.setattr(cluster, "ANSWER", 5)
    made = Cluster(tmp_path)
    yield made
    made.close()


def test_workers_that_all_end_are_no_wait_without_an_end(failing, caplog):
    with connected(failing.ready()) as (executor, at_a_time):
        assert at_a_time == 1
        assert executor.submit(abs, -3).result(60) == 3
        waiting = [executor.submit(time.sleep, 600) for _ in range(3)]
        failing.worker.kill()
        for future in waiting:
            with pytest.raises(GradingError, match=r"there has been no worker for 2 s\); what is graded is kept"):
                future.result(60)
    assert caplog.text == ""


def test_a_scheduler_that_ends_is_one_sentence(failing, caplog):
    address = failing.ready()
    with connected(address) as (executor, _):
        waiting = executor.submit(time.sleep, 600)
        failing.scheduler.kill()
        with pytest.raises(
            GradingError, match=r"^the cluster at .* no longer answers.*; what is graded is kept"
        ) as raised:
            waiting.result(60)
        with pytest.raises(GradingError, match="no longer answers"):
            executor.submit(abs, -3).result(60)
    assert "\n" not in str(raised.value)
    assert caplog.text == ""
    with pytest.raises(GradingError, match="no Dask scheduler answers at"), connected(address):
        pass


@pytest.mark.parametrize("there", ["another version", ""])
def test_a_worker_with_another_version_is_one_sentence(failing, monkeypatch, there):
    here = os.getpid()

    def installed(name):
        import os

        if os.getpid() == here:
            return "1"
        if not there:
            raise ModuleNotFoundError(name)
        return there

    monkeypatch.setattr(cluster, "installed", installed)
    says = f"has {f'exercisegrader {there}' if there else 'no exercisegrader'}: expected 1, as here"
    with pytest.raises(GradingError, match=f"^the worker .* {says}"), connected(failing.ready()):
        pass


@pytest.mark.parametrize("address", ["", "nonsense", "http://127.0.0.1:1", "tcp://127.0.0.1:port"])
def test_an_address_that_is_none_is_told(address):
    with pytest.raises(GradingError, match="expected an address such as tcp://"), connected(address):
        pass


def test_something_else_at_the_address_is_told(monkeypatch):
    monkeypatch.setattr(cluster, "ANSWER", 1)
    with socket.create_server(("127.0.0.1", 0)) as other:  # it listens, and says nothing
        address = f"tcp://127.0.0.1:{other.getsockname()[1]}"
        with pytest.raises(GradingError, match="no Dask scheduler answers at"), connected(address):
            pass
