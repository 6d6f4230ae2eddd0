"""What Python does in a reader's browser: it answers, says which part it lacks, and keeps what it compiled.

`_static/judge-worker.js` loads this file and calls it. It runs on a desk just as well, and its tests do so.
"""

from __future__ import annotations

import importlib
import importlib.abc
import importlib.util
import io
import json
import marshal
import os
import sys
import time
import zipfile
from collections.abc import Mapping
from pathlib import Path
from types import ModuleType

#: A .pyc file begins with Python's magic number, and then with what it is compared with its source by: with nothing.
_MAGIC, _HEADER = 4, 16
_UNCHECKED = (1).to_bytes(4, "little") + bytes(8)
#: What takes the time of importing a package, where that is not the package itself.
_HEART = {"matplotlib": "matplotlib.backends.backend_agg", "scipy": "scipy.optimize", "PIL": "PIL.Image"}


#: What can be said of an archive: it can be taken, there is more to gather for it, or there is nothing to be kept.
READY, MORE, NOTHING = "ready", "more", "nothing"
#: So many steps of a loop take so many seconds in the browser of a usual computer that has nothing else to do.
_STEPS, _USUAL = 50_000, 0.012


class Lacking(BaseException):
    """A package is asked for that was not loaded so far. It is no Exception, so that nobody goes on without it."""


class Later(importlib.abc.MetaPathFinder):
    """Finds out that a package is needed that is loaded only when it is.

    Attributes:
        parts: {package: name of the part that holds it}.
        lacks: the part that was needed and is not there; empty if none.
    """

    def __init__(self, parts: Mapping[str, str]):
        self.parts, self.lacks = dict(parts), ""

    def find_spec(self, name: str, path: object = None, target: ModuleType | None = None) -> None:
        """Raise `Lacking` for a module of a part that is not there; others are found by the next finder."""
        if part := self.parts.get(name.partition(".")[0]):
            self.lacks = part
            raise Lacking(part)

    def arrived(self, part: str) -> None:
        """From now on a part is there. Its packages are imported at once, while nobody counts the seconds."""
        packages = [package for package, other in self.parts.items() if other == part]
        self.parts = {package: other for package, other in self.parts.items() if other != part}
        importlib.invalidate_caches()
        for package in packages:
            importlib.import_module(_HEART.get(package, package))


class Judge:
    """Answers requests with `loopbook.exercises.forms.answer`.

    Arguments:
        later: {package: part} of what is loaded when it is needed.
        packages: the folder of the packages; what is compiled in it is kept.
    """

    def __init__(self, later: Mapping[str, str], packages: str = ""):
        self.later = Later(later)
        self._answer = None
        self._paces: list[float] = []
        self._keyed: set[tuple[str, str | None]] = set()
        self._packages = _Packages(Path(packages))
        self._archives = (self._packages, _StandardLibrary())

    def begin(self) -> None:
        """Import what every answer needs."""
        sys.dont_write_bytecode = False  # see `compile`
        for optional in ("scipy", "babel", "dask"):  # Pint imports them where it can, and uses none of them here
            sys.modules.setdefault(optional, None)
        importlib.import_module("pint")
        if sys.modules["scipy"] is None:
            del sys.modules["scipy"]
        sys.meta_path.insert(0, self.later)
        self._answer = importlib.import_module("loopbook.exercises.forms").answer
        importlib.import_module("exercisebook.grammar").parser()  # before the first answer waits for it

    def prepare(self, text: str) -> str:
        """Compute the key of the exercise of a request and judge it, once: that may take longer than an answer."""
        request = json.loads(text)
        wanted = request.get("exercise"), request.get("student")
        if request.get("do") != "check" or wanted in self._keyed:
            return ""
        lacks = self._asked(json.dumps(request | {"do": "prepare"}))[1]
        if not lacks:
            self._keyed.add(wanted)
        return lacks

    def slowness(self) -> float:
        """Return how many times longer than usual something takes here, from 1 to 10.

        A telephone is slower than a desk's computer, and a computer that has other things to do is slower than one that
        has none: neither makes an answer one without end.
        """
        begin, total = time.perf_counter(), 0
        for step in range(_STEPS):
            total += step * step % 7
        self._paces = [*self._paces[-2:], (time.perf_counter() - begin) / _USUAL]
        return min(max(1.0, *self._paces), 10.0)

    def reply(self, text: str) -> list[str]:
        """Return the reply to a request and the part that it lacks: then it is asked again with that part."""
        return list(self._asked(text))

    def _asked(self, text):
        self.later.lacks = ""
        try:
            reply = self._answer(text)
        except (Lacking, KeyboardInterrupt):  # it lacks a part, or takes too long and was ended
            reply = ""
        except Exception as error:  # a page can do nothing with a traceback
            reply = json.dumps({"problem": f"this cannot be answered ({type(error).__name__}: {error})"})
        return reply, self.later.lacks

    def compile(self, seconds: float = 0.05) -> str:
        """Gather what the next visit need not compile again, for so many seconds, and say what is ready for `take`.

        Returns "packages" or "standard library"; "" while there is more to do, and "nothing" where all is taken.
        """
        end = time.monotonic() + seconds
        for archive in self._archives:
            state = archive.gather(end)
            if state != NOTHING:
                return archive.name if state == READY else ""
        return NOTHING

    def take(self, name: str) -> bytes:
        """Return the archive that `compile` has said is ready."""
        return next(archive.taken() for archive in self._archives if archive.name == name)

    def restore(self, archive: bytes) -> None:
        """Unpack an archive of packages that an earlier visit has kept."""
        with zipfile.ZipFile(io.BytesIO(archive)) as members:
            members.extractall(self._packages.folder)
            self._packages.known.update(self._packages.folder / name for name in members.namelist())


class _Packages:
    """The compiled modules of the packages, as Python has written them beside the sources; later more of them.

    Arguments:
        folder: of the packages.
    Attributes:
        known: the paths that need not be kept again.
    """

    name = "packages"

    def __init__(self, folder: Path):
        self.folder, self.known = folder, set()
        self._content, self._pending = io.BytesIO(), []

    def gather(self, end):
        self._pending = self._pending or self._fresh()
        with zipfile.ZipFile(self._content, "a") as members:
            while self._pending:
                path = self._pending.pop()
                content = path.read_bytes()
                if path.suffix == ".pyc":
                    content = content[:_MAGIC] + _UNCHECKED + content[_HEADER:]
                members.writestr(path.relative_to(self.folder).as_posix(), content)
                self.known.add(path)
                if time.monotonic() > end:
                    return MORE
            return READY if members.namelist() else NOTHING

    def _fresh(self):
        compiled = {getattr(getattr(module, "__spec__", None), "cached", None) for module in list(sys.modules.values())}
        paths = {Path(path) for path in compiled if path}
        if "matplotlib" in sys.modules:  # it has looked through its fonts for seconds, and keeps what it found, too
            paths |= set(Path(sys.modules["matplotlib"].get_cachedir()).glob("fontlist*.json"))
        return [path for path in sorted(paths - self.known) if path.is_relative_to(self.folder) and path.is_file()]

    def taken(self):
        content, self._content = self._content.getvalue(), io.BytesIO()
        return content


class _StandardLibrary:
    """The archive from which Python imports its own modules, with those compiled that are used; once."""

    name = "standard library"

    def __init__(self):
        self._path = Path(next((path for path in sys.path if path.endswith(".zip")), ""))
        self._code: dict[str, bytes] = {}
        self._is_taken = not self._path.is_file()
        self._known = set() if self._is_taken else set(zipfile.ZipFile(self._path).namelist())

    def gather(self, end):
        if self._is_taken:
            return NOTHING
        home = f"{self._path}{os.sep}"
        for module in list(sys.modules.values()):
            spec = getattr(module, "__spec__", None)
            origin = (spec and spec.origin) or ""
            name = origin.removeprefix(home) + "c"
            if origin.startswith(home) and origin.endswith(".py") and name not in self._known:
                code = spec.loader.get_code(spec.name)
                self._code[name] = importlib.util.MAGIC_NUMBER + _UNCHECKED + marshal.dumps(code)
                self._known.add(name)
                if time.monotonic() > end:
                    return MORE
        return READY if self._code else NOTHING

    def taken(self):
        self._is_taken = True
        content = io.BytesIO(self._path.read_bytes())
        with zipfile.ZipFile(content, "a") as members:
            for name, code in self._code.items():
                members.writestr(name, code)
        self._code.clear()
        return content.getvalue()
