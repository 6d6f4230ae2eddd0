"""The submissions that belong to the students of a roster, in folders and in zip files."""

import dataclasses
import datetime
import io
import json
import os
import pickle
import stat
import sys
import zipfile

import pytest
from hypothesis import given
from hypothesis import strategies as st

from exercisegrader import GradingError, entries, sources
from exercisegrader.student import Student
from exercisegrader.submissions import Collection, collect
from rosters import ANNE, CLASS, JANE, JOHN, attempted

has_pipes = pytest.mark.skipif(sys.platform == "win32", reason="Windows has no pipes and seldom links among its files")
takes_any_name = pytest.mark.skipif(sys.platform != "linux", reason="elsewhere names of files are text")


# Submissions in folders.


def notebook(source):
    """A notebook of one cell, as text."""
    cell = {"cell_type": "code", "metadata": {}, "outputs": [], "source": source}
    return json.dumps({"nbformat": 4, "nbformat_minor": 5, "metadata": {}, "cells": [cell]})


def source(submission):
    """The source of the one cell of what was handed in."""
    (cell,) = json.loads(submission.read())["cells"]
    return cell["source"]


def lay(root, **files):
    for name, content in files.items():
        path = root / name.replace("__", "/").replace("_ipynb", ".ipynb")
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_text(notebook(content) if path.suffix == ".ipynb" else content)


def labels(collection):
    return {found.student.id: found.label for found in collection.submissions if not found.problem}


def test_a_folder_for_each_student(tmp_path):
    lay(tmp_path, s1003__heater_ipynb="3", s1001__inner__heater_ipynb="1", s1002_ipynb="2")
    for passed in (".DS_Store", "s1001/.ipynb_checkpoints/heater-checkpoint.ipynb", "__MACOSX/s1001/._heater.ipynb"):
        (tmp_path / passed).parent.mkdir(parents=True, exist_ok=True)
        (tmp_path / passed).write_text("?")
    found = collect(tmp_path, CLASS, "heater")
    assert [(item.student, item.label, item.problem, source(item)) for item in found.submissions] == [
        (JANE, "s1001/inner/heater.ipynb", "", "1"),
        (JOHN, "s1002.ipynb", "", "2"),
        (ANNE, "s1003/heater.ipynb", "", "3"),
    ]
    assert found.complaints == ()
    assert pickle.loads(pickle.dumps(found)) == found
    assert collect(str(tmp_path), CLASS, "heater") == found


def test_a_wrapping_folder_is_seen_through(tmp_path):
    lay(tmp_path / "heater", heater__s1001__a_ipynb="1")
    for root, label in ((tmp_path, "heater/heater/s1001/a.ipynb"), (tmp_path / "heater", "heater/s1001/a.ipynb")):
        found = collect(root, CLASS, "heater")
        assert labels(found) == ({} if root == tmp_path else {"s1001": label})
    assert labels(collect(tmp_path / "heater", CLASS, "tank")) == {"s1001": "heater/s1001/a.ipynb"}
    assert collect(tmp_path / "heater", [Student("heater", "H")], "heater").submissions[0].student.id == "heater"


def test_two_notebooks_of_one_student_are_not_run(tmp_path):
    lay(tmp_path, s1001__a_ipynb="1", s1001__b_ipynb="2", s1002__a_ipynb="1", s1002_ipynb="2", s1003__x_ipynb="3")
    found = collect(tmp_path, CLASS, "a")
    problem = "two notebooks: s1001/a.ipynb and s1001/b.ipynb; keep one"
    assert [item.problem for item in found.submissions][::2] == [problem, ""]
    assert found.complaints[0] == f"s1001/a.ipynb: {problem}"
    assert "two notebooks: s1002/a.ipynb and s1002.ipynb; keep one" in found.complaints[1]
    with pytest.raises(GradingError, match="two notebooks"):
        found.submissions[0].read()


def chosen(collection):
    """The file that counts for the one student who handed in, its problem, and what is said of it."""
    (found,) = collection.submissions
    (complaint,) = collection.complaints
    return found.label, found.problem, complaint


def test_the_latest_counts_where_the_instructor_says_so(tmp_path):
    names = ("doejane_123_9_heater.ipynb", "doejane_LATE_123_11_heater-1.ipynb", "doejane_123_10_notes.ipynb")
    for name in names:
        (tmp_path / name).write_text(notebook(name))
    assert chosen(collect(tmp_path, CLASS, "heater"))[1].startswith("3 notebooks: doejane_123_10_notes.ipynb, ")
    found = collect(tmp_path, CLASS, "heater", latest=True)
    label, problem, says = chosen(found)
    assert (label, problem, source(found.submissions[0])) == (names[1], "", names[1])
    assert says.startswith(f"{names[1]}: counts as the latest, by the numbers of the files in Canvas, of 3 notebooks: ")
    assert says == f"{names[1]}: {found.submissions[0].chosen}"
    assert found.submissions[0].late is True


def test_the_latest_is_told_by_the_times_of_files_or_not_at_all(tmp_path):
    lay(tmp_path, s1001__a_ipynb="1", s1001__b_ipynb="2")
    for name, seconds in (("a", 1_000_000_100), ("b", 1_000_000_000)):
        os.utime(tmp_path / "s1001" / f"{name}.ipynb", (seconds, seconds))
    found = collect(tmp_path, CLASS, "heater", latest=True)
    assert chosen(found)[2].startswith("s1001/a.ipynb: counts as the latest, by the times of the files, of two ")
    (counts,) = found.submissions
    assert (counts.handed_in, counts.late) == (None, None)  # of a file's time nothing is late
    os.utime(tmp_path / "s1001" / "b.ipynb", (1_000_000_099, 1_000_000_099))
    problem = chosen(collect(tmp_path, CLASS, "heater", latest=True))[1]
    assert problem.endswith("; which is the latest is not known, because their times are the same; keep one")


def test_the_latest_in_a_zip_file_that_may_not_tell_times(packed):
    old, new, untold = (zipfile.ZipInfo(f"s1001/{name}.ipynb", time) for name, time in (
        ("a", (2026, 12, 1, 10, 0, 0)), ("b", (2026, 12, 1, 10, 0, 4)), ("c", (1980, 1, 1, 0, 0, 0)),
    ))  # fmt: skip
    assert chosen(packed((old, "1"), (new, "2"), latest=True))[:2] == ("s1001/b.ipynb", "")
    problem = chosen(packed((old, "1"), (untold, "2"), latest=True))[1]
    assert "not known, because a file has no time" in problem


def test_what_the_roster_knows_of_the_time_comes_along(tmp_path):
    when = datetime.datetime(2026, 12, 1, 23, 59)
    lay(tmp_path, s1001_ipynb="1")
    (found,) = collect(tmp_path, [dataclasses.replace(JANE, handed_in=when)], "heater").submissions
    assert (found.handed_in, found.late) == (when, None)


@has_pipes
def test_what_is_no_notebook_of_a_student_is_said(tmp_path):
    lay(tmp_path, s1001__notes="", grades="", mallory__a_ipynb="", deep__1__2__3__4__5__6__a_ipynb="")
    lay(tmp_path, s1002__1__2__3__4__5__a_ipynb="as deep as may be")
    os.mkfifo(tmp_path / "s1003.ipynb")
    (tmp_path / "s1001" / "secret.ipynb").symlink_to("/etc/passwd")
    (tmp_path / "link").symlink_to(tmp_path)
    found = collect(tmp_path, CLASS, "a")
    assert labels(found) == {"s1002": "s1002/1/2/3/4/5/a.ipynb"}
    assert set(found.complaints) == {
        "deep/1/2/3/4/5/6: is nested deeper than 6 folders",
        "grades: is not a notebook (.ipynb)",
        "link: is a symbolic link, which is not followed",
        "mallory/a.ipynb: is named after no student of the roster",
        "s1001/notes: is not a notebook (.ipynb)",
        "s1001/secret.ipynb: is a symbolic link, which is not followed, beside s1001/notes",
        "s1003.ipynb: is not a file but a device, a pipe or a socket",
    }


def test_what_may_not_be_read_is_said(tmp_path, monkeypatch):
    lay(tmp_path, s1001_ipynb="", s1002__a_ipynb="")
    listing = os.scandir

    def refuses(folder):
        if str(folder).endswith("s1002"):
            raise PermissionError(13, "Permission denied", str(folder))
        return listing(folder)

    monkeypatch.setattr(entries.os, "access", lambda path, mode: False)
    monkeypatch.setattr(entries.os, "scandir", refuses)
    found = collect(tmp_path, CLASS, "a")
    says = ["cannot be read: no permission", "cannot be read: Permission denied"]
    assert [one.problem for one in found.submissions] == [f"the file {one}" for one in says]
    assert found.complaints == (f"s1001.ipynb: {says[0]}", f"s1002: {says[1]}")


@pytest.mark.parametrize(
    "becomes",
    [pytest.param("link", marks=has_pipes), pytest.param("pipe", marks=has_pipes), "folder", "gone", "larger"],
)
def test_a_file_that_has_changed_since(tmp_path, becomes, monkeypatch):
    monkeypatch.setattr(sources, "LARGEST", 2**20)
    lay(tmp_path, s1001_ipynb="")
    (found,) = collect(tmp_path, CLASS, "a").submissions
    path = tmp_path / "s1001.ipynb"
    if becomes == "larger":
        path.write_bytes(b" " * (2**20 + 1))
    else:
        path.unlink()
    if becomes == "link":
        path.symlink_to("/etc/passwd")
    elif becomes == "pipe":
        os.mkfifo(path)
    elif becomes == "folder":
        path.mkdir()
    with pytest.raises(GradingError, match=r"^the file (cannot be read: |is larger than 50 MiB)"):
        found.read()


def test_a_notebook_that_is_too_large(tmp_path, monkeypatch):
    monkeypatch.setattr(sources, "LARGEST", 2**20)
    (tmp_path / "s1001.ipynb").write_bytes(notebook("1").encode().ljust(2**20))
    (tmp_path / "s1002.ipynb").write_bytes(notebook("1").encode().ljust(2**20 + 1))
    fits, large = collect(tmp_path, CLASS, "a").submissions
    assert source(fits) == "1"
    assert large.problem == sources.TOO_LARGE


@takes_any_name
def test_names_that_cannot_be_shown_are_spelled_out(tmp_path):
    for name in (b"s1001/\xff\x1b[31m.ipynb", b"line\nbreak.ipynb"):
        path = os.path.join(os.fsencode(tmp_path), name)
        os.makedirs(os.path.dirname(path), exist_ok=True)
        with open(path, "wb") as file:
            file.write(notebook("1").encode())
    found = collect(tmp_path, CLASS, "a")
    assert found.submissions[0].label == r"s1001/\udcff\x1b[31m.ipynb"
    assert source(found.submissions[0]) == "1"
    assert found.complaints == (r"line\nbreak.ipynb: is named after no student of the roster",)


def test_a_flood_of_files_harms_nobody_else(tmp_path, monkeypatch):
    monkeypatch.setattr(entries, "MOST", 40)
    for number in range(30):
        lay(tmp_path, **{f"s1001__{number}": "", f"s1003__{number % 2}__{number}": ""})
        lay(tmp_path, **{f"s1003__{number % 2}__{number + 30}": ""})
    lay(tmp_path, s1002_ipynb="", s1001__a_ipynb="", s1003__a_ipynb="")
    found = collect(tmp_path, CLASS, "a")
    assert labels(found) == {"s1001": "s1001/a.ipynb", "s1002": "s1002.ipynb"}
    assert found.complaints[-1] == "s1003: has more than 40 files and folders"
    assert found.complaints[10] == "s1001: has 20 more that cannot be used"
    for number in range(50):
        lay(tmp_path, **{f"x{number}": ""})
    with pytest.raises(GradingError, match="more than 40 files and folders: expected those of one class"):
        collect(tmp_path, CLASS, "a")


@has_pipes
def test_where_there_is_nothing(tmp_path):
    assert collect(tmp_path, CLASS, "a") == Collection((), ())
    os.mkfifo(tmp_path / "pipe")
    for path in (tmp_path / "none", tmp_path / "pipe"):
        with pytest.raises(GradingError, match="there is neither a folder nor a zip file"):
            collect(path, CLASS, "a")


# Submissions in zip files.


@pytest.fixture
def packed(tmp_path):
    """Writes a zip file of (name or ZipInfo, content) and collects from it."""

    def pack(*members, compression=zipfile.ZIP_DEFLATED, change=None, latest=False):
        memory = io.BytesIO()
        with zipfile.ZipFile(memory, "w", compression) as archive:
            for name, content in members:
                archive.writestr(name, notebook(content) if content.isalnum() else content)
        path = tmp_path / "heater submissions.zip"
        path.write_bytes(change(memory.getvalue()) if change else memory.getvalue())
        return collect(path, CLASS, "heater", latest)

    yield pack
    entries._archive.cache_clear()  # closes it


def test_downloads_of_both_systems(packed):
    found = packed(
        ("roejohn_LATE_124_9_heater.ipynb", "2"),
        ("doejane_123_8_heater.ipynb", "1"),
        ("doejane_123_7_notes.pdf", "?"),
        ("anon_Ab3dE_456_heater.ipynb", "?"),
        ("Anne Müller-Lüdenscheidt_77003_assignsubmission_file/inner/", ""),
        ("Anne Müller-Lüdenscheidt_77003_assignsubmission_file/inner/heater.ipynb", "3"),
        ("__MACOSX/._doejane_123_8_heater.ipynb", "?"),
    )
    assert [item.student for item in found.submissions] == [*CLASS]
    assert [source(item) for item in reversed(found.submissions)] == ["3", "2", "1"]
    assert found.complaints == (
        "anon_Ab3dE_456_heater.ipynb: is from an anonymous download of Canvas, which does not say whose it is",
        "doejane_123_7_notes.pdf: is not a notebook (.ipynb), beside doejane_123_8_heater.ipynb",
    )
    assert source(pickle.loads(pickle.dumps(found)).submissions[1]) == "2"


def test_what_is_no_notebook_is_the_one_of_its_student(packed):
    (one,) = packed(("doejane_123_7_homework.zip", "?"), ("doejane_123_8_notes.pdf", "?")).submissions
    assert (one.student, one.label) == (JANE, "doejane_123_7_homework.zip")
    assert one.problem == "the file is not a notebook (.ipynb)"


def test_names_that_are_utf_8_without_saying_so(packed):
    """As the zip files of Canvas have them."""
    name = "müllerlüdenscheidtanne_125_9_heater.ipynb"
    raw = name.encode()
    plain = "x" * len(raw)
    found = packed((plain, "3"), change=lambda content: content.replace(plain.encode(), raw))
    assert labels(found) == {"s1003": name}
    assert source(found.submissions[0]) == "3"
    found = packed((plain, "3"), change=lambda content: content.replace(plain.encode(), b"\xff" * len(raw)))
    assert len(found.complaints) == 1


def test_names_that_say_they_are_utf_8_and_are_not(packed):
    with pytest.raises(GradingError, match="is not a zip file, or it is damaged"):
        packed(("ü.ipynb", ""), change=lambda content: content.replace("ü".encode(), b"\xff\xff"))


def test_a_zip_file_of_a_folder(packed):
    found = packed(("heater submissions/s1001/a.ipynb", "1"), ("heater submissions/s1002.ipynb", "2"))
    assert labels(found) == {"s1001": "heater submissions/s1001/a.ipynb", "s1002": "heater submissions/s1002.ipynb"}
    assert labels(packed(("other/s1001/a.ipynb", "1"))) == {}


def info(name, mode=0):
    member = zipfile.ZipInfo(name)
    member.external_attr = mode << 16
    return member


@pytest.mark.parametrize(
    ("name", "says"),
    [
        ("../s1001.ipynb", "has a path that leads out of the folder"),
        ("s1001/../../x.ipynb", "has a path that leads out of the folder"),
        ("../.ssh/x.ipynb", "has a path that leads out of the folder"),
        ("..\\s1001.ipynb", "has a path that leads out of the folder"),
        ("/s1001.ipynb", "has an absolute path"),
        ("/", "has an absolute path"),
        ("C:\\s1001.ipynb", "has an absolute path"),
        (info("s1001.ipynb", stat.S_IFLNK | 0o777), "is a symbolic link, which is not followed"),
        (info("s1001.ipynb", stat.S_IFCHR | 0o666), "is not a file but a device, a pipe or a socket"),
        ("s1001/1/2/3/4/5/6/a.ipynb", "is nested deeper than 6 folders"),
        (f"s1001/{'x' * 300}.ipynb", "has a name longer than any file has"),
        ("s1001/a.py", "is not a notebook (.ipynb)"),
        ("mallory.ipynb", "is named after no student of the roster"),
    ],
)
def test_members_that_are_left_alone(packed, name, says):
    found = packed((name, "1"), ("s1002.ipynb", "2"))
    assert labels(found) == {"s1002": "s1002.ipynb"}
    (complaint,) = found.complaints
    shown = getattr(name, "filename", name).replace("\\", "/")
    assert complaint.replace("\\", "/").startswith(shown[:100])
    assert complaint.endswith(f": {says}")


def test_members_that_cannot_be_unpacked_safely(packed):
    def encrypted(content):
        place = content.index(b"PK\x01\x02") + 8
        return content[:place] + bytes([content[place] | 1]) + content[place + 1 :]

    assert packed(("s1001.ipynb", "1"), change=encrypted).complaints == ("s1001.ipynb: is encrypted",)
    (complaint,) = packed(("s1001.ipynb", "1"), compression=zipfile.ZIP_BZIP2).complaints
    assert complaint == "s1001.ipynb: is compressed in a way that the systems do not use"


def test_two_members_of_one_name(packed):
    with pytest.warns(UserWarning, match="Duplicate name"):
        found = packed(("s1001.ipynb", "1"), ("s1001.ipynb", "2"))
    assert found.submissions[0].problem == "two notebooks: s1001.ipynb and s1001.ipynb; keep one"


def test_a_zip_bomb_is_known_by_what_is_read(packed, monkeypatch):
    monkeypatch.setattr(sources, "LARGEST", 2**20)
    bomb = ("s1001.ipynb", b" " * (2**20 + 1))
    assert packed(bomb).submissions[0].problem == sources.TOO_LARGE

    def smaller(content):
        """The same, announced as a thousand bytes."""
        place = content.index(b"PK\x01\x02") + 24
        return content[:place] + (1000).to_bytes(4, "little") + content[place + 4 :]

    (found,) = packed(bomb, change=smaller).submissions
    assert found.problem == ""
    with pytest.raises(GradingError, match=r"^the file (is larger than|cannot be read: )"):
        found.read()


def test_damaged_zip_files(packed, tmp_path):
    def torn(content):
        place = content.index(b"Jupyter")
        return content[:place] + b"Jupiter" + content[place + 7 :]

    (found,) = packed(("s1001.ipynb", "Jupyter"), compression=zipfile.ZIP_STORED, change=torn).submissions
    with pytest.raises(GradingError, match=r"the file cannot be read: Bad CRC-32"):
        found.read()
    for change in (lambda content: content[:-30], lambda content: b"", lambda content: b"{}"):
        with pytest.raises(GradingError, match="is not a zip file, or it is damaged"):
            packed(("s1001.ipynb", "1"), change=change)
    (found,) = packed(("s1001.ipynb", "1")).submissions
    packed(("s1001.ipynb", "another"))
    with pytest.raises(GradingError, match="the zip file has changed"):
        found.read()


@given(st.integers(0, 10**6), st.binary(min_size=1, max_size=3))
def test_no_damage_does_more_than_say_so(tmp_path_factory, place, noise):
    memory = io.BytesIO()
    with zipfile.ZipFile(memory, "w", zipfile.ZIP_DEFLATED) as archive:
        archive.writestr("s1001.ipynb", "{}" * 50)
        archive.writestr("s1002/a.ipynb", "{}")
    content = bytearray(memory.getvalue())
    place %= len(content)
    content[place : place + len(noise)] = noise
    path = tmp_path_factory.getbasetemp() / "damaged.zip"
    path.write_bytes(content)
    found, problem = attempted(collect, path, CLASS, "a")
    for submission in found.submissions if found else ():
        problem += attempted(submission.read)[1]
    entries._archive.cache_clear()
    assert "\n" not in problem


def test_too_many_members(packed, monkeypatch):
    monkeypatch.setattr(entries, "MOST", 3)
    with pytest.raises(GradingError, match="more than 3 files and folders: expected those of one class"):
        packed(*((f"{number}.ipynb", "") for number in range(4)))
