"""What lies among the submissions, in a folder or in a zip file that nobody unpacks; no link is followed."""

from __future__ import annotations

import dataclasses
import datetime
import functools
import os
import stat
import struct
import zipfile
import zlib
from collections.abc import Callable, Iterable
from dataclasses import dataclass
from typing import IO, TYPE_CHECKING

from exercisegrader import GradingError

if TYPE_CHECKING:
    from pathlib import Path

#: The most files and folders that are looked at: in a zip file, in a folder, and below each folder in it.
MOST = 20_000
#: The most folders one in another.
DEEPEST = 6

#: What goes wrong where a file cannot be read, or a zip file or a member of one is damaged.
FAILURES = (OSError, EOFError, RuntimeError, ValueError, struct.error, zipfile.BadZipFile, zlib.error)


@dataclass(frozen=True)
class Entry:
    """A file, or whatever else lies there; `parts` are its names from the top, `fault` is why it is none of ours.

    When it was `changed`, in local time, is what the disk or the zip file says: copying and unpacking may change it.
    """

    label: str
    parts: tuple[str, ...]
    fault: str = ""
    size: int = 0
    open: Callable[[], IO[bytes]] | None = None
    changed: datetime.datetime | None = None


class _TooManyError(Exception):
    """More than MOST files and folders."""


def entries(path: Path, assignment_name: str, ids: Iterable[str]) -> list[Entry]:
    """All that lies in a folder or in a zip file, as entries; unusable ones have a fault.

    Names that begin with a dot and __MACOSX are skipped. Where all lies in one folder that is named like the folder
    or the zip file itself, or like the assignment, and like none of the students' ids, the entries begin below it.

    Raises GradingError where there is neither a folder nor a whole zip file, or far more than a class hands in.
    """
    path = path.absolute()
    wrappers = {path.name, path.stem, assignment_name} - set(ids)
    if path.is_dir():
        return _in_folder(path, wrappers)
    if path.is_file():
        return _in_zip(path, wrappers)
    raise GradingError(f"there is neither a folder nor a zip file {path}")


def _passed_over(parts):
    """Whether this is Jupyter's, the system's or an editor's own."""
    return any((part.startswith(".") and part != "..") or part == "__MACOSX" for part in parts)


def shown(text: str) -> str:
    """Text that any terminal and any file takes: what cannot be shown is spelled out, a long text is shortened."""
    text = text if len(text) <= 300 else f"{text[:200]} ... {text[-80:]}"
    return "".join(sign if sign.isprintable() else sign.encode("unicode_escape").decode() for sign in text)


def why(problem: BaseException) -> str:
    """The reason that a failure gives, without a path."""
    return shown(getattr(problem, "strerror", None) or str(problem) or type(problem).__name__)


def _too_deep():
    return f"is nested deeper than {DEEPEST} folders"


# In a folder.


def _open_file(path):
    """Open a file on the disk, if it is still one and no link; a pipe that took its place does not make us wait."""
    flags = os.O_RDONLY | sum(getattr(os, name, 0) for name in ("O_NOFOLLOW", "O_NONBLOCK", "O_BINARY", "O_CLOEXEC"))
    descriptor = os.open(path, flags)
    if not stat.S_ISREG(os.fstat(descriptor).st_mode):
        os.close(descriptor)
        raise ValueError("it is no longer a file")
    return os.fdopen(descriptor, "rb")


def _in_folder(root, wrappers):
    """All that lies in a folder, in the order of the names."""
    try:
        tops = _listed(root)
        within = ()
        if len(tops) == 1 and tops[0].name in wrappers and tops[0].is_dir(follow_symlinks=False):
            within, tops = (tops[0].name,), _listed(tops[0].path)
    except _TooManyError:
        raise GradingError(f"{root} has more than {MOST} files and folders: expected those of one class") from None
    except OSError as problem:
        raise GradingError(f"the folder {root} cannot be read: {problem.strerror}") from None
    for top in tops:
        found = []
        try:
            for entry in _below(top, (), within):
                found.append(entry)
                if len(found) > MOST:
                    raise _TooManyError
        except _TooManyError:
            found = [
                Entry(shown("/".join((*within, top.name))), (top.name,), f"has more than {MOST} files and folders")
            ]
        yield from found


def _listed(folder):
    """What lies in a folder and is not skipped."""
    found = []
    with os.scandir(folder) as listing:
        for number, item in enumerate(listing):
            if number == MOST:
                raise _TooManyError
            if not _passed_over([item.name]):
                found.append(item)
    return sorted(found, key=lambda item: item.name)


def _below(item, parts, within):
    """An item of a folder, or all that lies below it."""
    parts = (*parts, item.name)
    label = shown("/".join((*within, *parts)))
    try:
        state = item.stat(follow_symlinks=False)
        if not stat.S_ISDIR(state.st_mode):
            fault = _kind(state.st_mode) or ("" if os.access(item.path, os.R_OK) else "cannot be read: no permission")
            changed = datetime.datetime.fromtimestamp(state.st_mtime)
            yield Entry(label, parts, fault, state.st_size, functools.partial(_open_file, item.path), changed)
        elif len(parts) > DEEPEST:
            yield Entry(label, parts, _too_deep())
        else:
            for inner in _listed(item.path):
                yield from _below(inner, parts, within)
    except OSError as problem:
        yield Entry(label, parts, f"cannot be read: {why(problem)}")


def _kind(mode):
    """What is wrong with a file of this mode."""
    if stat.S_ISLNK(mode):
        return "is a symbolic link, which is not followed"
    return "" if stat.S_ISREG(mode) else "is not a file but a device, a pipe or a socket"


# In a zip file.


def _open_member(path, state, number):
    """Open a member of a zip file that is still the same."""
    if _state(path) != state:
        raise ValueError("the zip file has changed")
    archive = _archive(path, state, os.getpid())
    return archive.open(archive.infolist()[number])


@functools.lru_cache(maxsize=1)
def _archive(path, state, process):
    """The opened zip file, for many members; each process has its own, because the place where one reads is shared."""
    return zipfile.ZipFile(path)


def _state(path):
    state = os.stat(path)
    return state.st_size, state.st_mtime_ns


def _in_zip(path, wrappers):
    """All that a zip file says it has, in its order."""
    try:
        state = _state(path)
        with zipfile.ZipFile(path) as archive:
            members = archive.infolist()
    except FAILURES as problem:
        raise GradingError(f"{path} is not a zip file, or it is damaged: {why(problem)}") from None
    if len(members) > MOST:
        raise GradingError(f"{path} has more than {MOST} files and folders: expected those of one class")
    found = []
    for number, member in enumerate(members):
        name = _name(member)
        parts = tuple(part for part in name.split("/") if part not in ("", "."))
        fault = _escape(name)
        if not fault:
            if not parts or _passed_over(parts):
                continue
            fault = _fault(member, parts)
            if not fault and member.is_dir():
                continue
        opens = functools.partial(_open_member, str(path), state, number)
        found.append(Entry(shown(name), parts or (name,), fault, member.file_size, opens, _changed(member)))
    return _unwrapped(found, wrappers)


def _unwrapped(found, wrappers):
    """The entries without the one folder in which all of them lie, if that is only a wrapper."""
    tops = {entry.parts[0] for entry in found}
    if len(tops) != 1 or not tops <= wrappers or any(len(entry.parts) == 1 for entry in found):
        return found
    return [dataclasses.replace(entry, parts=entry.parts[1:]) for entry in found]


def _changed(member):
    """When a member was changed; None where the zip file does not say, or says what cannot be."""
    try:
        changed = datetime.datetime(*member.date_time)
    except ValueError:
        return None
    return changed if changed.year > 1980 else None


def _name(member):
    """The name of a member; where the zip file does not say that it is UTF-8 and it can be nothing else, it is."""
    if not member.flag_bits & 0x800:
        try:
            return member.filename.encode("cp437").decode("utf-8")
        except UnicodeError:
            pass
    return member.filename


def _escape(name):
    """Why a member's name is no place within the folder, which matters little as long as nothing is unpacked."""
    if name.startswith(("/", "\\")) or name[1:2] == ":":
        return "has an absolute path"
    if ".." in name.replace("\\", "/").split("/"):
        return "has a path that leads out of the folder"
    return ""


def _fault(member, parts):
    """What is wrong with a member."""
    mode = member.external_attr >> 16
    if stat.S_IFMT(mode) and not stat.S_ISDIR(mode) and _kind(mode):
        return _kind(mode)
    if len(parts) > DEEPEST + 1:
        return _too_deep()
    if max(map(len, parts)) > 255:
        return "has a name longer than any file has"
    if member.flag_bits & 0x41:
        return "is encrypted"
    if member.compress_type not in (zipfile.ZIP_STORED, zipfile.ZIP_DEFLATED):
        return "is compressed in a way that the systems do not use"  # and some of them cannot be read in small pieces
    return ""
