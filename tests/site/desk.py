"""JupyterLab as ``make lab`` starts it, with the start page and a chapter to work on."""

import contextlib
import json
import os
import re
import secrets
import shutil
import socket
import subprocess
import sys
import time
import urllib.request
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import NamedTuple

import matplotlib
import pytest
from playwright.sync_api import TimeoutError, expect

from browser import PATIENCE, SCREENSHOTS, Complaints
from loopbook import working_copy

ROOT = Path(__file__).parents[2]
#: What JupyterLab and its packages write on the console by themselves, on a slow machine.
NOISE = (r"^Plugin \S+ .*(took [\d.]+ms|is taking too long) to activate", r"^Item with index \d+ did not appear within")


class Desk:
    """JupyterLab with a notebook in it."""

    def __init__(self, page, file):
        self.page, self.file, self.complaints = page, file, Complaints(page, NOISE)
        page.set_default_timeout(PATIENCE)
        page.add_locator_handler(page.locator("dialog.jp-Dialog"), self.dismiss)

    def dismiss(self, dialog):
        """Complain about a dialog that stands before what is to be clicked: none is expected. Then put it away."""
        self.complaints.append(f"dialog: {dialog.inner_text()}")
        dialog.locator(".jp-Dialog-button").last.click()  # JupyterLab's own choice, as the return key would

    def open(self, address):
        self.page.goto(address)
        self.code = self.page.locator(".jp-NotebookPanel:not(.lm-mod-hidden) .jp-CodeCell")
        self.ready()

    def ready(self):
        """Wait until the notebook in front has its kernel: until then a click on Run asks which one is meant."""
        panel = self.page.locator(".jp-NotebookPanel:not(.lm-mod-hidden)")
        expect(panel.locator(".jp-Toolbar-kernelName")).to_contain_text("Python 3")
        expect(panel.locator(".jp-Notebook-ExecutionIndicator")).to_have_attribute("data-status", "idle")

    def tabs(self):
        """The tabs of what is open."""
        return self.page.locator(".lm-DockPanel-tabBar .lm-TabBar-tab")

    def rest(self):
        """Wait until nothing is computed."""
        indicator = self.page.locator(".jp-NotebookPanel:not(.lm-mod-hidden) .jp-Notebook-ExecutionIndicator")
        expect(indicator).to_have_attribute("data-status", "idle")

    def choose(self, *names):
        """Choose from the menu, as ``choose("Run", "Run All Cells")``; again where the page has closed the menu."""
        labels = self.page.locator(".lm-MenuBar-itemLabel, .lm-Menu-itemLabel")
        *menus, command = [labels.get_by_text(name, exact=True) for name in names]
        for menu, entry in zip(menus, [*menus[1:], command], strict=True):
            until(lambda menu=menu, entry=entry: self.opens(menu, entry))
        command.click()

    @staticmethod
    def opens(menu, entry):
        """Click on a menu, and tell whether an entry of it is seen."""
        menu.click()
        try:
            entry.wait_for(timeout=10_000)
        except TimeoutError:
            return False
        return True

    def run_all(self):
        """Run all cells from the menu, after the stored outputs have been cleared, and wait for the last one."""
        last = self.code.last.locator(".jp-InputPrompt")
        self.choose("Edit", "Clear Outputs of All Cells")
        expect(last).to_have_text("[ ]:")
        self.choose("Run", "Run All Cells")
        expect(last).to_have_text(f"[{len(self.stored())}]:")  # the page still grows: count the file
        self.rest()

    def save(self):
        """Save from the menu, and wait until the file is written to its end."""
        before = self.file.stat().st_mtime_ns
        self.choose("File", "Save Notebook")
        until(lambda: self.file.stat().st_mtime_ns != before and self.is_whole())

    def is_whole(self):
        """Tell whether the file is not just being written."""
        try:
            return bool(self.stored())
        except ValueError:
            return False

    def cell(self, text):
        """The code cell whose source begins with a text."""
        source = self.page.locator(".cm-content").filter(has_text=re.compile("^" + re.escape(text)))
        return self.code.filter(has=source).first

    def answer(self, number, words):
        """Put an answer into the cell of an exercise and run it: what the response says."""
        cell = self.cell(f'exercise("{number}").check(')
        cell.scroll_into_view_if_needed()
        cell.evaluate("cell => cell.querySelectorAll('.jp-OutputArea-output').forEach(old => old.dataset.old = '')")
        editor, prompt = cell.locator(".cm-content"), cell.locator(".jp-InputPrompt")
        before = prompt.inner_text()
        editor.click()
        expect(editor).to_be_focused()
        self.page.keyboard.press("Control+a")
        self.page.keyboard.insert_text(f'exercise("{number}").check({words})')
        expect(editor).to_have_text(f'exercise("{number}").check({words})')
        self.page.keyboard.press("Shift+Enter")
        expect(prompt).not_to_have_text(before)
        expect(prompt).to_have_text(re.compile(r"\d"))
        return cell.locator(".jp-OutputArea-output:not([data-old])").inner_text()

    def stored(self):
        """The code cells of the file."""
        cells = json.loads(self.file.read_text(encoding="utf-8"))["cells"]
        return [cell for cell in cells if cell["cell_type"] == "code"]

    def picture(self, cell):
        return cell.locator(".jp-OutputArea-output img").get_attribute("src")

    def screenshot(self, name):
        self.page.screenshot(path=SCREENSHOTS / f"lab_{name}.png")


class Lab(NamedTuple):
    """A running JupyterLab: its address, its token, and the file of the chapter in the reader's copy."""

    server: str
    token: str
    file: Path

    @property
    def front(self) -> str:
        """What ``make lab`` opens in a browser."""
        return f"{self.server}/?token={self.token}"

    @property
    def chapter(self) -> str:
        """The address of the chapter."""
        return f"{self.server}/lab/tree/chapters/{self.file.name}?token={self.token}"


@contextlib.contextmanager
def jupyterlab(folder: Path, notebook: str) -> Iterator[Lab]:
    """JupyterLab as ``make lab`` starts it, for a reader who has never had it, in a folder with one chapter."""
    (folder / "chapters").mkdir(parents=True)
    for path in (working_copy.START, f"chapters/{notebook}", "jupyter_lab_config.py"):
        shutil.copy(ROOT / path, folder / path)
    shutil.copytree(ROOT / "docs" / "jupyterlab", folder / "docs" / "jupyterlab")
    port, token = free_port(), secrets.token_hex(16)
    own = {"HOME": "home", "IPYTHONDIR": "ipython", "JUPYTER_CONFIG_DIR": "config", "JUPYTER_DATA_DIR": "data"}
    own |= {"JUPYTER_RUNTIME_DIR": "runtime", "JUPYTERLAB_SETTINGS_DIR": "settings"}
    environment = {**os.environ, **{name: str(folder / place) for name, place in own.items()}}
    environment["MPLCONFIGDIR"] = matplotlib.get_cachedir()  # a new list of fonts costs seconds
    for name in ("LOOPBOOK_PROGRESS", "JUPYTER_PATH"):  # a reader has neither, and no forked kernels
        environment.pop(name, None)
    command = [sys.executable, "-m", "loopbook", "lab", "--no-browser"]
    command += [f"--ServerApp.port={port}", "--ServerApp.port_retries=0", f"--IdentityProvider.token={token}"]
    with open(folder / "log", "w", encoding="utf-8") as log:
        server = subprocess.Popen(command, cwd=folder, env=environment, stdout=log, stderr=log)
        try:
            # the list of kernels is slow to come for the first time, and a page without it asks for a kernel
            wait_for(f"http://127.0.0.1:{port}/api/kernelspecs?token={token}", server, folder / "log")
            file = folder / working_copy.FOLDER / "chapters" / notebook
            yield Lab(f"http://127.0.0.1:{port}", token, file)
        finally:
            shut_down(port, token)
            try:
                server.wait(timeout=60)
            except subprocess.TimeoutExpired:
                server.kill()
                server.wait()


def until(condition: Callable[[], bool], seconds: float = PATIENCE / 1000) -> None:
    """Wait for what no page shows."""
    end = time.monotonic() + seconds
    while not condition():
        assert time.monotonic() < end, f"it does not come within {seconds:g} s"
        time.sleep(0.1)


def free_port() -> int:
    with socket.socket() as free:
        free.bind(("127.0.0.1", 0))
        return free.getsockname()[1]


def wait_for(address: str, server: subprocess.Popen, log: Path, seconds: float = PATIENCE / 1000) -> None:
    end = time.monotonic() + seconds
    while time.monotonic() < end and server.poll() is None:
        with contextlib.suppress(OSError), urllib.request.urlopen(address, timeout=5):
            return
        time.sleep(0.1)
    pytest.fail(f"JupyterLab does not answer:\n{log.read_text(encoding='utf-8')}")


def shut_down(port: int, token: str) -> None:
    """Ask JupyterLab to end its kernels and itself."""
    request = urllib.request.Request(
        f"http://127.0.0.1:{port}/api/shutdown", method="POST", headers={"Authorization": f"token {token}"}
    )
    with contextlib.suppress(OSError):
        urllib.request.urlopen(request, timeout=60).close()
