"""Submissions that are no notebooks, or too much of one, and folders and archives that are traps."""

import io
import json
import os
import stat
import warnings
import zipfile

from hostile.attack import COMPLETE, MISSING, NOT_RUN, STOPPED, Attack, Expects, notebook

_NOT_RUN = Expects(counts=frozenset(), may=frozenset(), statuses=frozenset({NOT_RUN}))
_EITHER = Expects(counts=frozenset(), may=frozenset({"1", "2"}), statuses=frozenset({NOT_RUN, STOPPED, COMPLETE}))
#: The student's notebook is right, or a right one is beside the trap, and it counts.
_RIGHT = Expects(counts=frozenset({"1", "2"}), may=frozenset(), statuses=frozenset({COMPLETE}))
_NOTHING = Expects(counts=frozenset(), may=frozenset(), statuses=frozenset({MISSING, NOT_RUN}))
_ANY = Expects(counts=frozenset(), may=frozenset({"1", "2"}), statuses=frozenset({COMPLETE, NOT_RUN, MISSING}))


def _file(item, name, content, expects=_NOT_RUN):
    make = content if callable(content) else lambda cells: content
    return Attack(f"{item}: {name}", item, expects, content=make)


def _place(item, name, place, expects=_NOTHING):
    return Attack(f"{item}: {name}", item, expects, place=place)


def _archive(item, name, archive, expects=_RIGHT):
    return Attack(f"{item}: {name}", item, expects, archive=archive)


def _changed(**changes):
    """A right notebook with other parts."""

    def make(cells):
        return json.dumps(json.loads(notebook(cells)) | changes).encode()

    return make


def _cell(**changes):
    """A right notebook with one odd cell more."""

    def make(cells):
        content = json.loads(notebook([*cells, "1 + 1"]))
        content["cells"][-1] |= changes
        return json.dumps(content).encode("utf-8", "surrogatepass")

    return make


def _replaced(old, new):
    """A right notebook with other bytes."""
    return lambda cells: notebook(cells).replace(old, new, 1)


_DEEP = b"[" * 100_000 + b"]" * 100_000
_MINOR = b'"nbformat_minor": '


def _version_3(cells):
    cells = [
        {"cell_type": "code", "input": cell, "language": "python", "outputs": [], "collapsed": False, "metadata": {}}
        for cell in cells
    ]
    content = {"metadata": {"name": ""}, "nbformat": 3, "nbformat_minor": 0, "worksheets": [{"cells": cells}]}
    return json.dumps(content).encode()


def _claims_all_is_right(cells):
    content = json.loads(notebook([*cells, "sheet"], loopbook={"assignment": "other", "student": "s1002"}))
    text = {"output_type": "stream", "name": "stdout", "text": '{"number": "3", "status": "right", "earned": 100}'}
    content["cells"][-1]["outputs"] = [text]
    return json.dumps(content).encode()


_KERNEL = {"kernelspec": {"display_name": "R", "language": "R", "name": "ir"}, "language_info": {"name": "R"}}
_EVIL = {"kernelspec": {"display_name": "x", "language": "python", "name": "../../../tmp/evil"}}


def _linked(target):
    def place(folder, student, right):
        own = folder / student
        own.mkdir(parents=True)
        (own / "air_heater.ipynb").symlink_to(target(folder))

    return place


def _link_beside_the_own_file(folder, student, right):
    own = folder / student
    own.mkdir(parents=True)
    (own / "air_heater.ipynb").write_bytes(right)
    (own / "more.ipynb").symlink_to("/etc/shadow")


def _linked_folder(folder, student, right):
    (folder / "elsewhere").mkdir(parents=True)
    (folder / "elsewhere" / "air_heater.ipynb").write_bytes(right)
    (folder / student).symlink_to(folder / "elsewhere", target_is_directory=True)


def _endless_folder(folder, student, right):
    own = folder / student
    own.mkdir(parents=True)
    (own / "air_heater.ipynb").write_bytes(right)
    (own / "again").symlink_to(own, target_is_directory=True)


def _pipe(folder, student, right):
    (folder / student).mkdir(parents=True)
    os.mkfifo(folder / student / "air_heater.ipynb")


def _folder_named_as_a_notebook(folder, student, right):
    (folder / student / "air_heater.ipynb").mkdir(parents=True)


def _two(folder, student, right):
    (folder / student).mkdir(parents=True)
    for name in ("air_heater.ipynb", "air_heater (1).ipynb"):
        (folder / student / name).write_bytes(right)


def _nobody_s(folder, student, right):
    for name in (student, "nobody", "Final version", "-rf", "$(touch x)", "a\nb", "\udcff"):
        (folder / name).mkdir(parents=True)
        (folder / name / "air_heater.ipynb").write_bytes(right)


def _empty_folder(folder, student, right):
    (folder / student).mkdir(parents=True)


def _zipped(*members, own=True):
    """An archive of members, each a name or `ZipInfo` with its bytes, beside the student's right notebook."""

    def make(student, right):
        buffer = io.BytesIO()
        with warnings.catch_warnings(), zipfile.ZipFile(buffer, "w", zipfile.ZIP_DEFLATED) as archive:
            warnings.simplefilter("ignore", UserWarning)  # a name twice is meant
            if own:
                archive.writestr(f"{student}/air_heater.ipynb", right)
            for member, content in members:
                member = member.replace("STUDENT", student) if isinstance(member, str) else member
                archive.writestr(member, right if content is None else content)
        return buffer.getvalue()

    return make


def _info(name, mode=0, system=3):
    info = zipfile.ZipInfo(name)
    info.create_system, info.external_attr = system, mode << 16
    return info


def _bomb(student, right):
    return _zipped(("s1002/air_heater.ipynb", bytes(2**28)), ("s1003/air_heater.ipynb", bytes(2**28)))(student, right)


def _bomb_that_calls_itself_small(student, right):
    size = 2**28
    content = _zipped(("s1002/air_heater.ipynb", bytes(size)))(student, right)
    return content.replace(size.to_bytes(4, "little"), (1000).to_bytes(4, "little"))


def _many(student, right):
    return _zipped(*((f"x/{k}.txt", b"") for k in range(30000)))(student, right)


def _damaged(student, right):
    content = bytearray(_zipped(("s1002/air_heater.ipynb", right))(student, right))
    second = content.rindex(b"PK\x03\x04")
    for k in range(second + 80, second + 120):
        content[k] ^= 0xFF
    return bytes(content)


def _encrypted(student, right):
    content = bytearray(_zipped(("s1002/air_heater.ipynb", right))(student, right))
    for mark, place in ((b"PK\x03\x04", 6), (b"PK\x01\x02", 8)):
        content[content.rindex(mark) + place] |= 1
    return bytes(content)


def _cut(student, right):
    content = _zipped()(student, right)
    return content[: len(content) // 2]


_TRAVERSAL, _BOMB, _LINKS, _JSON = "zip path traversal", "zip bomb", "symbolic links", "malformed JSON"
_OUTPUTS = b'"outputs": []'
_NONE, _LARGE, _MISSING = "not a notebook", "100 MB notebook", "missing file"

ATTACKS = (
    _file(_JSON, "cut off", lambda cells: notebook(cells)[:-40]),
    _file(_JSON, "empty file", b""),
    _file(_JSON, "zeros", bytes(10**6)),
    _file(_JSON, "no UTF-8", b'{"cells": [\xff\xfe]}'),
    _file(_JSON, "UTF-16", lambda cells: notebook(cells).decode().encode("utf-16"), _RIGHT),
    _file(_JSON, "byte order mark", lambda cells: b"\xef\xbb\xbf" + notebook(cells), _RIGHT),
    _file(_JSON, "nests of 100,000", _DEEP),
    _file(
        _JSON, "nests of 100,000 in the metadata", _replaced(b'"metadata": {}', b'"metadata": {"x": ' + _DEEP + b"}")
    ),
    _file(_JSON, "numbers beyond all", _replaced(_MINOR + b"5", _MINOR + b"9" * 10000), _EITHER),
    _file(_JSON, "NaN", _replaced(_MINOR + b"5", _MINOR + b"NaN"), _EITHER),
    _file(_JSON, "keys twice", _replaced(b'{"cells"', b'{"cells": [], "cells"'), _EITHER),
    _file(_NONE, "a picture", b"\x89PNG\r\n\x1a\n" + bytes(100)),
    _file(_NONE, "a program", b"#!/bin/sh\nrm -rf ~\n"),
    _file(_NONE, "a web page", b"<!doctype html><title>Sign in</title>"),
    *(
        _file(_NONE, f"JSON {text}", text.encode())
        for text in ("[]", "{}", "null", "1", '"x"', '{"cells": 5}', '{"cells": {}}')
    ),
    _file(_NONE, "cells that are none", _changed(cells=[1, None, "x", []])),
    _file(_NONE, "cells without a source", _cell(source=None), _EITHER),
    _file(_NONE, "a source of numbers", _cell(source=[1, 2]), _EITHER),
    _file(_NONE, "a cell of another kind", _cell(cell_type="evil"), _EITHER),
    _file(_NONE, "half a pair of UTF-16", _cell(source="x = '\ud800'"), _EITHER),
    _file(_NONE, "metadata of another kind", _changed(metadata=[]), _EITHER),
    _file(_NONE, "outputs that claim that all is right", _claims_all_is_right, _RIGHT),
    _file("nbformat 3", "with right answers", _version_3, _EITHER),
    _file("nbformat 3", "nbformat 2", _changed(nbformat=2), _EITHER),
    _file("nbformat 3", "nbformat 99", _changed(nbformat=99), _EITHER),
    _file("nbformat 3", "nbformat that is a text", _changed(nbformat="4"), _EITHER),
    _file("wrong kernel", "R", _changed(metadata=_KERNEL)),
    _file("wrong kernel", "a path", _changed(metadata=_EVIL), _EITHER),
    _file("wrong kernel", "none", _changed(metadata={}), _EITHER),
    _file(_LARGE, "spaces", lambda cells: notebook(cells) + b" " * 4 * 10**7, _RIGHT),
    _file(_LARGE, "a picture of 40 MB", _replaced(_OUTPUTS, b'"outputs": ["' + b"A" * 4 * 10**7 + b'"]'), _RIGHT),
    _file(_LARGE, "an output without an end", _replaced(_OUTPUTS, b'"outputs": ["' + b"A" * 10**8)),
    _file(_LARGE, "pictures beyond all", lambda cells: notebook(cells) + b" " * (50 * 2**20)),
    _file(_LARGE, "outputs of brackets", _replaced(_OUTPUTS, b'"outputs": [' + b"[[[]]]," * 6 * 10**6 + b"{}]")),
    _file(_LARGE, "one cell of 10 MB", lambda cells: notebook([*cells, "x = '" + "y" * 10**7 + "'"]), _EITHER),
    _file(_LARGE, "comments of 9 MB", lambda cells: notebook([*cells, "#" * 9 * 10**6]), _EITHER),
    _file(_LARGE, "100,000 cells", lambda cells: notebook([*cells, *["pass"] * 100_000]), _EITHER),
    _file(_LARGE, "60,000 cells", lambda cells: notebook([*cells, *["pass"] * 60_000]), _EITHER),
    _file(_LARGE, "5,000 cells that fail", lambda cells: notebook([*cells, *["1 / 0"] * 5000]), _EITHER),
    _file(_LARGE, "one line of 100,000 sums", lambda cells: notebook([*cells, "+".join(["1"] * 100_000)]), _EITHER),
    _place(_MISSING, "an empty folder", _empty_folder, _NOTHING),
    _place(_MISSING, "two notebooks", _two, _NOT_RUN),
    _place(_MISSING, "a folder with the name of a notebook", _folder_named_as_a_notebook, _NOTHING),
    _place(_MISSING, "folders of nobody", _nobody_s, _RIGHT),
    _place(_LINKS, "to another student's", _linked(lambda folder: folder / "s1002" / "air_heater.ipynb")),
    _place(_LINKS, "to /etc/shadow", _linked(lambda folder: "/etc/shadow")),
    _place(_LINKS, "to a device without an end", _linked(lambda folder: "/dev/zero")),
    _place(_LINKS, "to nothing", _linked(lambda folder: "nothing")),
    _place(_LINKS, "to itself", _linked(lambda folder: "air_heater.ipynb")),
    _place(_LINKS, "beside the own file", _link_beside_the_own_file, _RIGHT),
    _place(_LINKS, "the folder itself", _linked_folder),
    _place(_LINKS, "a folder in a ring", _endless_folder, _RIGHT),
    _place(_LINKS, "a pipe", _pipe),
    _archive(_BOMB, "two large members", _bomb),
    _archive(_BOMB, "a large member that calls itself small", _bomb_that_calls_itself_small, _ANY),
    _archive(_BOMB, "30,000 members", _many, _ANY),
    _archive(_BOMB, "an archive in an archive", _zipped(("s1002/more.zip", bytes(10**5)))),
    *(
        _archive(_TRAVERSAL, repr(name), _zipped((name, None)))
        for name in (
            "../evil.ipynb",
            "../../s1002/air_heater.ipynb",
            "/tmp/evil.ipynb",
            "s1002/../../evil.ipynb",
            "C:\\evil.ipynb",
            "..\\s1002\\air_heater.ipynb",
            "a/" * 200 + "evil.ipynb",
        )
    ),
    _archive(
        _TRAVERSAL, "a symbolic link", _zipped((_info("s1002/air_heater.ipynb", stat.S_IFLNK | 0o777), b"/etc/shadow"))
    ),
    _archive(_TRAVERSAL, "a device", _zipped((_info("s1002/air_heater.ipynb", stat.S_IFCHR | 0o666), b""))),
    _archive(_TRAVERSAL, "the same name twice", _zipped(("STUDENT/air_heater.ipynb", b"{}")), _ANY),
    _archive(_TRAVERSAL, "encrypted", _encrypted),
    _archive(_TRAVERSAL, "damaged member", _damaged, _RIGHT),
    _archive(_TRAVERSAL, "cut in the middle", _cut, _NOTHING),
    _archive(_TRAVERSAL, "no archive", lambda student, right: right, _NOTHING),
)
