"""Grading a class from end to end: release, submissions, grades; interrupted, resumed, without a jail."""

import dataclasses
import html
import io
import json
import os
import shutil
import signal
import subprocess
import sys
import time
import zipfile
from pathlib import Path

import nbformat
import pytest
from typer.testing import CliRunner

from courses import Course
from executors import lasting
from exercisegrader import GradingError, NoJail, jail
from exercisegrader.__main__ import app
from exercisegrader.assignment import load
from exercisegrader.grade import grade, here
from exercisegrader.imprint import peek
from exercisegrader.judge import Judge
from exercisegrader.results import OWNER, Look, Result, Results
from needs import needs_jail


def files(folder):
    """All that lies in a folder, by its relative name."""
    return {str(path.relative_to(folder)): path.read_bytes() for path in sorted(folder.rglob("*")) if path.is_file()}


def points(folder):
    """What the class has, as it is written."""
    rows = (folder / "grades.csv").read_text(encoding="utf-8-sig").splitlines()
    return [row.split(",")[-1] for row in rows[1:]]


def hand_in(folder, **notebooks):
    """The folder with the bytes of these students' notebooks."""
    for student, content in notebooks.items():
        (folder / student).mkdir(parents=True)
        (folder / student / "lag.ipynb").write_bytes(content)
    return folder


@pytest.fixture(scope="module")
def course(tmp_path_factory):
    course = Course(tmp_path_factory.mktemp("course"))
    with lasting(2) as course.place:
        yield course


@pytest.fixture(scope="module")
def graded(course):
    summary = course.grade("graded")
    return summary, course.folder / "graded"


@needs_jail
class TestAClass:
    def test_numbers_are_those_of_the_release(self, course, graded):
        folder = course.folder / "mended"
        with course.mended(course.path, "K=between(2, 6,", "K=between(20, 60,"):
            later = grade(load(course.path), course.students, course.submissions, folder, place=course.place())
        says = "other ranges than at the release: K in exercise 1, K in exercise 2; those who were released to keep"
        assert later.notes[0].startswith(says)
        assert points(folder) == points(graded[1])

    def test_most_notebooks_of_others_are_not_graded(self, course, tmp_path):
        ids = [student.id for student in course.students[:-1]]
        others = zip(ids, [*ids[1:], ids[0]], strict=True)
        submissions = hand_in(tmp_path / "in", **{own: course.handed_in(other) for own, other in others})
        with pytest.raises(GradingError, match="4 of 4 notebooks are not those that were released to these students"):
            course.grade(tmp_path / "out", submissions)
        assert not (tmp_path / "out" / "grades.csv").exists()

    def test_a_notebook_of_somebody_else_is_told(self, course, tmp_path):
        content = course.handed_in("s3")
        earlier = content.replace(peek(content).numbers["2"].encode(), b"of an earlier release")
        taken = course.handed_in("s2").replace(b'student=\\"s2\\"', b'student=\\"s0\\"')
        course.grade(tmp_path / "out", hand_in(tmp_path / "in", s0=taken, s3=earlier))
        results = course.results(tmp_path / "out")
        assert results.of("s3").looks == (Look(OWNER, "it was released with other numbers in exercise 2"),)
        found = results.of("s0")
        assert (found.looks, found.owner) == ((Look(OWNER, "it names another student: s2"),), "s2")

    def test_answers_under_another_name_or_in_no_code_cell_are_told(self, course, tmp_path):
        named, marked = (nbformat.reads(course.handed_in(one).decode(), as_version=4) for one in ("s0", "s3"))
        for cell in named.cells:
            if cell.source.startswith('sheet.answer("1"'):
                cell.source = 'sheet.answer("1", Y=2, P=-1 / 2, **{"p": None})'
        for cell in marked.cells:
            if 'sheet.answer("2"' in cell.source:
                cell.cell_type = "markdown"
                del cell["outputs"], cell["execution_count"]
        s0, s3 = (nbformat.writes(one).encode() for one in (named, marked))
        course.grade(tmp_path / "out", hand_in(tmp_path / "in", s0=s0, s3=s3))
        results = course.results(tmp_path / "out")
        says = "in exercise 1 it answers 'Y' and 'P', which are not asked"
        assert results.of("s0").looks == (Look("unasked", says, "1"),)
        (look,) = results.of("s3").looks
        assert (look.kind, look.exercise) == ("no code", "2")
        says = "exercise 2 is answered in the text of the notebook alone"
        assert look.says.startswith(says)
        assert says in (tmp_path / "out" / "feedback" / "s3" / "feedback.html").read_text(encoding="utf-8")

    def test_everybody_has_what_is_due(self, graded):
        summary, folder = graded
        assert (summary.graded, summary.kept, summary.missing, summary.failures) == (4, 0, 1, ())
        assert points(folder) == ["5", "0", "5", "5", ""]
        page = (folder / "feedback" / "s1" / "feedback.html").read_text(encoding="utf-8")
        assert "That is the gain." in page
        assert "ZeroDivisionError" in page

    def test_the_key_is_for_the_instructor(self, course, graded):
        kind = course.assignment.question("s1", "1").key["p"]
        kept = json.loads((graded[1] / "results" / "s1.json").read_text(encoding="utf-8"))
        assert kept["exercises"][0]["answers"][1]["key"] == kind.solution
        shown = files(graded[1] / "feedback" / "s1")
        assert not any(f"{kind.key:.4g}".encode() in content for content in shown.values())

    def test_again_nothing_is_graded_and_nothing_changes(self, course, graded):
        before = files(graded[1])
        summary = course.grade("graded")
        assert (summary.graded, summary.kept, summary.missing) == (0, 4, 1)
        assert files(graded[1]) == before

    def test_from_nothing_the_bytes_are_the_same_in_another_order_of_work(self, course, graded):
        course.grade("again", place=here(2))
        assert files(course.folder / "again") == files(graded[1])

    def test_what_changed_is_graded_again_and_only_that(self, course, graded):
        with course.another_answer():
            summary = course.grade("graded", reveal=True)
        assert (summary.graded, summary.kept) == (1, 3)
        key = course.assignment.question("s2", "1").key["y"].solution.replace("\N{NO-BREAK SPACE}", " ")
        page = (graded[1] / "feedback" / "s2" / "feedback.html").read_text(encoding="utf-8")
        assert f"Key: <code>{html.escape(key)}</code>" in page
        course.grade("graded")

    def test_one_student_alone_again(self, course, graded):
        before = files(graded[1])
        summary = course.grade("graded", only=["s1"], regrade=True)
        assert (summary.graded, summary.kept, summary.missing, summary.outdated) == (1, 0, 0, ())
        assert files(graded[1]) == before

    def test_results_of_before_a_change_are_told(self, course, graded):
        with course.another_answer():
            assert course.grade("graded", only=["s1"]).outdated == ("s2",)
            done = CliRunner().invoke(app, [*course.command("graded")[3:], "--only", "s1"])
        says = "s2: graded before the assignment, the submission or the limits changed; grade without --only"
        assert done.output.splitlines()[0] == says
        course.grade("graded")

    def test_executed_notebooks_are_kept_where_asked_and_change_no_grade(self, course, graded):
        folder = course.folder / "kept"
        shutil.copytree(graded[1], folder)
        summary = course.grade("kept", keep_notebooks=True)
        assert (summary.graded, summary.failures) == (4, ())
        once = files(folder)
        pages = {f"notebooks/s{number}.{kind}" for number in range(4) for kind in ("html", "ipynb")}
        assert once.keys() - files(graded[1]).keys() == pages
        for name, content in files(graded[1]).items():
            if name.startswith(("results/", "grades")):
                assert once[name] == content
        assert b"../../notebooks/s1.html" in once["feedback/s1/feedback.html"]
        assert b"ZeroDivisionError" in once["notebooks/s1.html"]
        nbformat.validate(nbformat.reads(once["notebooks/s1.ipynb"].decode(), as_version=4))
        assert course.grade("kept").kept == 4
        assert files(folder) == once

    def test_a_kept_notebook_is_that_of_the_result(self, course, graded):
        folder = course.folder / "kept of one"
        course.grade("kept of one", keep_notebooks=True, only=["s2"])
        with course.another_answer():
            course.grade("kept of one", only=["s2"])  # without being asked again
        assert b"* 3," in (folder / "notebooks" / "s2.html").read_bytes()
        assert b"* 3," in (folder / "notebooks" / "s2.ipynb").read_bytes()

    @pytest.mark.parametrize("bytes_of_a_file", [1000, 4000])
    def test_a_disk_that_is_full_is_a_sentence_and_later_goes_on(self, course, graded, bytes_of_a_file):
        import resource

        def filled():
            resource.setrlimit(resource.RLIMIT_FSIZE, (bytes_of_a_file, resource.RLIM_INFINITY))

        command = course.command(f"full {bytes_of_a_file}")
        done = subprocess.run(command, preexec_fn=filled, capture_output=True, encoding="utf-8")
        assert done.returncode == 1
        assert "File too large" in done.stderr
        assert "Traceback" not in done.stderr
        subprocess.run(command, check=True, capture_output=True)
        assert files(course.folder / f"full {bytes_of_a_file}") == files(graded[1])

    def test_killed_at_any_moment_it_goes_on(self, course, graded):
        for seconds in (2.5, 4.5):
            process = subprocess.Popen(
                course.command("killed"), stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL, start_new_session=True
            )
            time.sleep(seconds)
            os.kill(process.pid, signal.SIGKILL)
            process.wait()
        subprocess.run(course.command("killed"), check=True, capture_output=True)
        assert files(course.folder / "killed") == files(graded[1])


def test_two_graders_do_not_share_a_folder(course):
    from exercisegrader.grade import _alone

    with _alone(course.folder / "busy"), pytest.raises(GradingError, match="another grader works in"):
        course.grade("busy", jailed=False)


def test_a_student_who_is_not_there(course):
    with pytest.raises(GradingError, match="no student 's99' on the roster"):
        course.grade("nobody", only=["s99"])


@pytest.mark.parametrize("inside", ["submissions", "submissions/graded"])
def test_what_is_written_does_not_lie_among_the_submissions(course, inside):
    with pytest.raises(GradingError, match="lies among the submissions in"):
        course.grade(inside)
    assert not (course.folder / inside / ".lock").exists()


def test_another_assignment_has_another_folder(course):
    other = dataclasses.replace(course.assignment, name="other")
    results = course.results("taken")
    lag = Result("lag", "s1", "s1.ipynb", True, "", "complete", "", (), (), ())
    results.keep(lag)
    with pytest.raises(GradingError, match="holds results of the assignment 'lag': expected a folder of its own for"):
        grade(other, course.students, course.submissions, course.folder / "taken", jailed=False)
    assert results.of("s1") == lag


def test_the_result_of_somebody_else_is_not_hers(course, tmp_path):
    results = Results(tmp_path, course.assignment.secret)
    results.keep(Result("lag", "s1", "s1.ipynb", True, "", "complete", "", (), (), ()))
    (tmp_path / "s2.json").write_bytes((tmp_path / "s1.json").read_bytes())
    with pytest.raises(GradingError, match=r"s2\.json is not as the grader of this assignment wrote it"):
        results.of("s2")


def test_where_most_submissions_are_gone_nothing_is_graded(course, tmp_path):
    folder, empty = course.folder / "gone", tmp_path / "empty"
    course.grade("gone")
    before = files(folder)
    empty.mkdir()
    with pytest.raises(GradingError, match=r"4 of 4 students who were graded have no submission in .*: s0, s1"):
        course.grade("gone", empty)
    assert files(folder) == before
    most = hand_in(empty, **{student: course.handed_in(student) for student in ("s0", "s1", "s2")})
    done = course.grade("gone", most)
    assert "Graded before, and without a submission now: s3." in done.notes


def test_a_system_without_locks_is_refused(course, monkeypatch):
    monkeypatch.setitem(sys.modules, "fcntl", None)
    with pytest.raises(GradingError, match="this system cannot lock a folder: grade on Linux"):
        course.grade("unlocked", jailed=False)


def test_what_every_submission_could_read_is_refused(course):
    with pytest.raises(GradingError, match="which every submission can read: move it elsewhere"):
        course.grade("exposed", Path(sys.prefix) / "share")


def test_without_bubblewrap_it_says_what_to_install(course, monkeypatch):
    monkeypatch.setattr(jail.shutil, "which", lambda name: None)
    with pytest.raises(NoJail, match=r"install bubblewrap and libseccomp2 .* or say --without-jail"):
        course.grade("nowhere", place=None)  # in no jail that runs
    assert not (course.folder / "nowhere" / "grades.csv").exists()


@needs_jail
def test_without_a_jail_every_output_says_so(course):
    """Inside a jail's walls, where nobody can read Python, for root runs no submissions without one."""
    command = [*course.command("open"), "--without-jail"]
    if os.geteuid() == 0:
        walls = jail.command()
        os.chmod(course.folder, 0o777)
        folders = [str(folder) for folder in reversed(course.folder.parents[:-2])]
        place = [word for folder in folders for word in ("--perms", "0755", "--dir", folder)]
        place += ["--bind", str(course.folder), str(course.folder)]
        user = ["setpriv", "--reuid=65534", "--regid=65534", "--clear-groups"]
        command = [*walls[:-5], *place, "--chdir", "/tmp", "--", *user, *command]
    done = subprocess.run(command, capture_output=True, encoding="utf-8", env=jail.ENVIRONMENT)
    assert done.returncode == 0, done.stderr
    assert "graded without a jail" in done.stderr
    for name, content in files(course.folder / "open").items():
        if name not in (".lock", "marks.csv"):  # the latter is the instructor's
            told = [content]
            if name.endswith(".zip"):
                with zipfile.ZipFile(io.BytesIO(content)) as archive:
                    told = [archive.read(member) for member in archive.namelist()]
            assert all(b"without a jail" in one or b'"jailed": false' in one for one in told), name


def test_what_the_judge_cannot_finish_is_not_judged(tmp_path, monkeypatch):
    """An author's comparison that hangs in C, and one that takes the process down."""
    monkeypatch.setattr("exercisegrader.judge.PATIENCE", 1)
    source = '''"""Traps"""
import ctypes, os
from exercisebook.authoring import answers, criterion, design, exercise, number
SECRET = "a secret of the tests"
def hang(x):
    return ctypes.PyDLL(None).sleep(60) if x == 5 else 1
def die(x):
    return os._exit(1) if x == 5 else 1
@exercise("1", title="Traps", points=3)
def traps():
    "..."
    return answers(
        a=design(number(1), criterion("a", hang, below=2)),
        b=number(2),
        c=design(number(1), criterion("c", die, below=2)),
    )
'''
    with Judge("traps", source) as judge:
        (one,) = judge.judge("s1", {"1": {"a": 5, "b": 2, "c": 5}})
        assert [answer.status for answer in one.answers] == ["not judged", "right", "not judged"]
        assert one.earned == 1
        (one,) = judge.judge("s1", {"1": {"a": 1, "b": {"unreadable": "this is a $lambda$"}}})
        assert [answer.status for answer in one.answers] == ["right", "not judged", "open"]


def test_an_assignment_that_fails_says_where():
    with pytest.raises(GradingError, match=r"bad\.py, line 2: NameError"), Judge("bad", '"""Bad"""\nx = y\n') as judge:
        judge.judge("s1", {})


def test_the_commands(course, tmp_path):
    run = CliRunner().invoke
    result = run(app, ["release", str(course.path), "--to", str(tmp_path / "released")])
    assert result.exit_code == 0
    assert "5 notebooks of 'A lag' in" in result.output
    result = run(app, ["grade", str(course.path), str(tmp_path / "none"), "--to", str(tmp_path / "out")])
    assert result.exit_code == 1
    assert "there is neither a folder nor a zip file" in result.output
    result = run(app, ["grade", str(tmp_path / "none.py"), str(tmp_path), "--to", str(tmp_path / "out")])
    assert (result.exit_code, result.output.count("\n")) == (1, 1)
