"""Grade the one submission that Gradescope has put into a folder, and write its results.json, whatever happens.

    python one_submission.py /autograder

The layout is Gradescope's: https://gradescope-autograders.readthedocs.io/en/latest/specs/ and, for the file that says
who has submitted, https://gradescope-autograders.readthedocs.io/en/latest/submission_metadata/.
"""

import json
import shutil
import subprocess
import sys
import tempfile
from pathlib import Path

from exercisegrader import GradingError
from exercisegrader.assignment import load
from exercisegrader.jail import Jail
from exercisegrader.released import Released
from exercisegrader.roster import read_roster


def main(base):
    """Write the results, or why there are none; what is meant for the instructor goes to the standard output."""
    results = base / "results" / "results.json"
    results.parent.mkdir(exist_ok=True)
    try:
        content = graded(base)
    except Exception as problem:  # a result that says why is better than none
        print(f"not graded: {problem}")
        says = str(problem) if isinstance(problem, GradingError) else "The autograder failed."
        content = {"score": 0, "output": f"Not graded. {says} Tell your instructor.", "output_format": "text"}
    results.write_text(json.dumps(content, ensure_ascii=False, indent=1) + "\n", encoding="utf-8")


def graded(base):
    """Return the results of the submission, in Gradescope's format. Raises GradingError where there are none."""
    course = base / "source" / "course"
    assignment = course / (course / "assignment").read_text(encoding="utf-8").strip()
    metadata = json.loads((base / "submission_metadata.json").read_text(encoding="utf-8"))
    roster, _ = Released.of(load(assignment)).identified(read_roster(course / "roster.csv"))
    student = submitter(metadata, roster)
    with tempfile.TemporaryDirectory() as folder:
        handed_in = Path(folder, "submissions", student.id)
        handed_in.mkdir(parents=True)
        put(notebooks(base / "submission"), handed_in)
        command = [sys.executable, "-m", "loopbook", "grade", assignment, handed_in.parent, "--to", f"{folder}/graded"]
        command += ["--students", course / "roster.csv", "--only", student.id, "--workers", "1", *jail()]
        run = subprocess.run(list(map(str, command)), capture_output=True, encoding="utf-8", check=False)
        print(run.stdout, run.stderr, sep="")
        if run.returncode:
            raise GradingError("The grader ended with an error.")
        return json.loads(Path(folder, "graded", "feedback", student.id, "results.json").read_text(encoding="utf-8"))


def submitter(metadata, roster):
    """Return the student of the roster who has submitted, found by a whole address and never by a likeness.

    Arguments:
        metadata: the content of submission_metadata.json.
        roster: the students.
    Raises:
        GradingError: where it is nobody, several, or a group.
    """
    users = metadata.get("users", [])
    if len(users) != 1:
        raise GradingError(f"{len(users)} students have submitted this together: expected one.")
    (user,) = users
    # student numbers are where Gradescope has them from the course's roster; documented are only the addresses
    given = {str(user.get(name) or "").casefold() for name in ("email", "sid")} - {""}
    found = [one for one in roster if given & {own.casefold() for own in (one.id, one.email, one.sis_id)}]
    if len(found) != 1:
        raise GradingError(f"{len(found) or 'No'} students of the roster have the address {user.get('email')!r}.")
    return found[0]


def notebooks(folder):
    """The notebooks in a submission. Raises GradingError unless there is one, which is no link."""
    found = [path for path in sorted(folder.rglob("*.ipynb")) if not any(part.startswith(".") for part in path.parts)]
    if len(found) != 1:
        raise GradingError(f"There are {len(found)} notebooks in this submission: expected one.")
    if found[0].is_symlink() or not found[0].is_file():
        raise GradingError("The notebook is no file of its own: expected one that is no link.")
    return found[0]


def put(notebook, folder):
    """Copy a notebook into a folder of submissions."""
    shutil.copyfile(notebook, folder / notebook.name, follow_symlinks=False)


def jail():
    """Return the option to grade without a jail, where none is possible; the output then says so."""
    try:
        Jail().close()
    except GradingError as problem:
        print(f"no jail: {problem}")
        return ["--without-jail"]
    return []


if __name__ == "__main__":
    main(Path(sys.argv[1]))
