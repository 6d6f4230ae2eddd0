"""The command line: `exercisegrader`, or ``python -m exercisegrader``, lists the commands.

A package for whose subject this grader is used adds them to its own, as `loopbook` does.
"""

import contextlib
import os
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import Annotated

import typer
from rich.console import Console

app = typer.Typer(
    name="exercisegrader",
    add_completion=False,
    pretty_exceptions_show_locals=False,
)
console = Console(highlight=False, soft_wrap=True)
errors = Console(highlight=False, soft_wrap=True, stderr=True)
ROSTER = (
    "The class as CSV: id and name, or an export of Canvas, Moodle or Gradescope; if not given, roster.csv beside the "
    "assignment."
)


@app.callback(invoke_without_command=True)
def exercisegrader(context: typer.Context) -> None:
    """Notebooks for a class, each with numbers of its own, and a grader that lets no submission near the key."""
    if context.invoked_subcommand is None:
        typer.echo(context.get_help())


def fail(message: str) -> None:
    """End the command with exit code 1 and one line on the error stream."""
    errors.print(message, style="bold red", markup=False)
    raise typer.Exit(1)


@contextlib.contextmanager
def progress(word: str) -> Iterator[Callable[[int, int | None], None]]:
    """Yield a function that is told how much is done, and of how much, and shows it in a terminal."""
    from rich.progress import BarColumn, MofNCompleteColumn, Progress, TextColumn, TimeRemainingColumn

    columns = TextColumn(word), BarColumn(), MofNCompleteColumn(), TimeRemainingColumn()
    with Progress(*columns, console=errors, transient=True, disable=not errors.is_terminal) as bars:
        bar = bars.add_task("", total=None)
        yield lambda done, total: bars.update(bar, completed=done, total=total)


@app.command()
def release(
    assignment: Annotated[Path, typer.Argument(help="The assignment, a Python module in the exercise format.")],
    to: Annotated[Path, typer.Option(help="Folder for the notebooks, a folder a student.")],
    students: Annotated[Path | None, typer.Option(help=ROSTER)] = None,
    replace: Annotated[
        bool, typer.Option("--replace", help="Put mended notebooks in the place of those in which nobody has worked.")
    ] = False,
    new_numbers: Annotated[
        bool, typer.Option("--new-numbers", help="With --replace, draw numbers anew from ranges that have changed.")
    ] = False,
    place: Annotated[
        str | None,
        typer.Option(
            "--for", help="Pack them, too, as students get them there: canvas, moodle or drive, a shared one."
        ),
    ] = None,
    paper: Annotated[
        bool, typer.Option("--paper", help="Write sheets to print (PDF) in place of notebooks; needs Chromium.")
    ] = False,
) -> None:
    """Write one notebook per student: own numbers, places for answers, nothing of the key.

    The numbers are kept in a record beside the assignment, as heater.released.json. Released again, for students who
    joined later or with a statement that was mended, everybody keeps the numbers of the record, whatever the ranges
    are by then, and no notebook is replaced unless --replace says so.
    """
    from exercisegrader import GradingError, lms
    from exercisegrader.assignment import load
    from exercisegrader.files import write
    from exercisegrader.release import release
    from exercisegrader.roster import read_roster

    try:
        given = load(assignment)
        given.demand_own_secret()
        roster = read_roster(students or assignment.with_name("roster.csv"))
        if paper:
            if replace or new_numbers or place:
                fail("--paper writes sheets alone: expected no --replace, --new-numbers or --for beside it")
            _release_on_paper(given, roster, to)
            return
        if place:
            lms.demand_place(place)
        done = release(given, roster, to, replace=replace, new_numbers=new_numbers)
        remarks = [*lms.remarks(roster), *done.remarks]
        packed = None
        if place:
            packed = lms.packed(place, to, done.students, given.name, given.secret)
            beside = to.resolve().with_name(f"{to.resolve().name}_for_{place}")
            for name, content in packed.files.items():
                write(beside / name, content)
    except GradingError as error:
        fail(str(error))
    for remark in remarks:
        errors.print(remark, style="yellow", markup=False)
    counts = [(done.added, "new"), (done.replaced, "replaced"), (done.kept, "unchanged")]
    said = ", ".join(f"{len(ids)} {what}" for ids, what in counts if ids)
    count = f"{len(done.paths)} notebook{'' if len(done.paths) == 1 else 's'}"
    console.print(f"{count} of {given.title!r} in {to}{f': {said}' if said else ''}", markup=False)
    for student in done.worked_in:
        says = f"{to / student}: somebody has worked in this notebook; it stays, without what was mended"
        errors.print(says, style="yellow", markup=False)
    console.print(f"{done.record} has their numbers: keep it with the assignment, grade needs it", markup=False)
    if packed:
        console.print(f"{beside} is for {place}. {packed.says}", markup=False)


def _release_on_paper(given, roster, to):
    """Write the sheets of a class, and say where what is."""
    from exercisegrader import lms
    from exercisegrader.paper import sheets

    with progress("printing") as show:
        done = sheets.release(given, roster, to, show)
    for remark in (*lms.remarks(roster), *done.remarks):
        errors.print(remark, style="yellow", markup=False)
    console.print(f"{len(done.paths)} students have sheets of {given.title!r} in {to}", markup=False)
    says = "all sheets in one file to print, the key with a table for points, and the empty table for answers"
    console.print(f"{done.beside} is yours: {says}, which grade takes", markup=False)
    console.print(f"{done.record} has their numbers: keep it with the assignment, grade needs it", markup=False)


@app.command("try")
def try_out(
    context: typer.Context,
    assignment: Annotated[Path, typer.Argument(help="The assignment, before it is released.")],
    students: Annotated[
        Path | None, typer.Option(help=f"{ROSTER} Their variants are tried first; there need not be one.")
    ] = None,
    variants: Annotated[int, typer.Option(min=1, help="Variants of each exercise.")] = 200,
    seconds: Annotated[float, typer.Option(min=1, help="What an exercise may take.")] = 20,
    exercise: Annotated[list[str] | None, typer.Option(help="Number of an exercise; try this one alone.")] = None,
    student: Annotated[
        str | None, typer.Option(help="Id; show what this student sees, and what each answer is told.")
    ] = None,
) -> None:
    """Answer each exercise with its key, its mistakes and others, over many variants, and say what would surprise."""
    from exercisegrader import GradingError, trial
    from exercisegrader.assignment import load
    from exercisegrader.roster import read_roster

    try:
        given = trial.only(load(assignment), exercise or ())
        if student:
            for number in given.exercises:
                console.print(trial.one_variant(given, student, number), end="\n\n", markup=False)
            return
        there = students or assignment.with_name("roster.csv")
        ids = trial.ids([one.id for one in read_roster(there)] if students or there.exists() else [], variants)
        total = len(ids) * len(given.exercises)
        with progress("trying") as show:
            found = list(trial.try_all(given, ids, seconds, lambda done: show(done, total)))
    except GradingError as error:
        fail(str(error))
    except KeyboardInterrupt:
        fail("interrupted")
    console.print(trial.report(found), markup=False)
    try:
        given.demand_own_secret()
    except GradingError as error:
        errors.print(str(error), style="yellow", markup=False)
    if any(one.level == trial.WRONG for one in found):
        name = assignment if not students else f"{assignment} --students {students}"
        fail(f"something is wrong; {context.command_path} {name} --student ID --exercise N shows a variant")


@app.command()
def grade(
    assignment: Annotated[Path, typer.Argument(help="The assignment that was released.")],
    submissions: Annotated[
        Path, typer.Argument(help="Their folder, the zip file of Canvas or Moodle, or answers typed from paper (CSV).")
    ],
    to: Annotated[Path, typer.Option(help="Folder for grades and feedback; after an interruption, the same one.")],
    students: Annotated[Path | None, typer.Option(help=ROSTER)] = None,
    only: Annotated[list[str] | None, typer.Option(help="Id of a student; grade this one and keep the others.")] = None,
    regrade: Annotated[bool, typer.Option("--regrade", help="Grade again what is graded.")] = False,
    reveal: Annotated[bool, typer.Option("--reveal", help="Show the right answers in the feedback.")] = False,
    latest: Annotated[
        bool, typer.Option("--latest", help="Of several notebooks of a student, grade the latest instead of none.")
    ] = False,
    keep_notebooks: Annotated[
        bool, typer.Option("--keep-notebooks", help="Keep each notebook as executed, as a page without any script.")
    ] = False,
    workers: Annotated[int, typer.Option(min=1, help="Submissions at a time on this machine.")] = os.cpu_count() or 1,
    cell_seconds: Annotated[float, typer.Option(min=1, help="What a cell may take.")] = 60,
    seconds: Annotated[float, typer.Option(min=1, help="What a notebook may take.")] = 180,
    megabytes: Annotated[int, typer.Option(min=100, help="Memory that a notebook may take.")] = 1024,
    without_jail: Annotated[
        bool, typer.Option("--without-jail", help="Run submissions with your own rights; every output says so.")
    ] = False,
) -> None:
    """Run the submissions of a class in a jail, judge their answers, and write grades and feedback.

    Extensions are in extensions.csv beside the roster: student, until, and perhaps assignment.
    """
    from exercisegrader import GradingError

    try:
        from exercisegrader.assignment import load
        from exercisegrader.grade import grade as grade_all
        from exercisegrader.grade import here
        from exercisegrader.jail import MEGA, Limits
        from exercisegrader.roster import read_roster

        class_list = students or assignment.with_name("roster.csv")
        given, roster = load(assignment), read_roster(class_list)
        given.demand_own_secret()
        beside = class_list.with_name("extensions.csv")
        with progress("grading") as show:
            done = grade_all(
                given,
                roster,
                submissions,
                to,
                place=here(workers),
                extensions=beside if os.path.lexists(beside) else None,
                only=only or (),
                regrade=regrade,
                jailed=not without_jail,
                limits=Limits(cell=cell_seconds, total=seconds, memory=megabytes * MEGA),
                reveal=reveal,
                latest=latest,
                keep_notebooks=keep_notebooks,
                follow=show,
            )
    except GradingError as error:
        fail(str(error))
    except KeyboardInterrupt:
        # An ordinary exit would wait for the running submissions; they end by themselves once this process is gone.
        errors.print("interrupted; the same command goes on from here", style="bold red")
        os._exit(130)
    if without_jail:
        errors.print("graded without a jail: submissions ran with your own rights", style="bold red")
    for sentence in (*done.notes, *done.complaints):
        errors.print(sentence, style="yellow", markup=False)
    for student, why in done.failures:
        errors.print(f"{student}: {why}", style="bold red", markup=False)
    if done.outdated:
        first, *others = done.outdated
        who = f"{first} and {len(others)} more" if others else first
        says = f"{who}: graded before the assignment, the submission or the limits changed; grade without --only"
        errors.print(says, style="yellow", markup=False)
    counts = f"{done.graded} graded, {done.kept} kept, {done.missing} missing"
    console.print(f"{counts}; {to / 'summary.html'} tells the rest", markup=False)
    if done.failures:
        fail(f"{len(done.failures)} not graded")


@app.command()
def insight(
    assignment: Annotated[Path, typer.Argument(help="The assignment that was graded.")],
    folder: Annotated[Path, typer.Argument(help="With its grades, or with progress that pages have saved (JSON).")],
    students: Annotated[Path | None, typer.Option(help=ROSTER)] = None,
) -> None:
    """Say what a class tells: how hard each question is, for which numbers, and mistakes that no page knows yet."""
    from exercisegrader import GradingError
    from exercisegrader import insight as tells
    from exercisegrader.assignment import load
    from exercisegrader.files import write
    from exercisegrader.roster import read_roster

    try:
        given, days, remarks = load(assignment), [], []
        if (folder / "results").is_dir():
            roster = read_roster(students or assignment.with_name("roster.csv"))
            attempts = tells.of_results(given, folder, roster)
            days = tells.by_day(attempts, {one.id: one.handed_in for one in roster})
        else:
            attempts, remarks = tells.of_progress(given, folder)
        if not attempts:
            raise GradingError(f"{folder} has neither grades of {given.name} nor progress in its exercises")
        with progress("mining") as show:
            text, table = tells.report(attempts, days, tells.mined(attempts, show))
        write(folder / "insight.csv", table)
    except GradingError as error:
        fail(str(error))
    for remark in remarks:
        errors.print(remark, style="yellow", markup=False)
    console.print(f"{text}\n\n{folder / 'insight.csv'} has it as a table", markup=False)


@app.command()
def whose(
    assignment: Annotated[Path, typer.Argument(help="The assignment that was released.")],
    posted: Annotated[str, typer.Argument(help='Numbers that somebody has posted, as "K=2.4, T=31".')],
) -> None:
    """Name the students whose numbers these are, by the record of the release."""
    from exercisegrader import GradingError
    from exercisegrader.assignment import load
    from exercisegrader.insight import whose

    try:
        found = whose(load(assignment), posted)
    except GradingError as error:
        fail(str(error))
    for student, name, says in found:
        console.print(f"{student} {name}: {says}", markup=False)
    if not found:
        fail(f"nobody was given all of these numbers: {posted}")


@app.command()
def term(
    folder: Annotated[Path, typer.Argument(help="With the grades of each assignment in a folder, and term.toml.")],
) -> None:
    """Write the table of a term: a row for each student, a column for each assignment, and what they come to.

    Weights, what is dropped, and who is excused from what stand in term.toml in the folder. What is
    missing or waits for a mark is said.
    """
    from exercisegrader import GradingError
    from exercisegrader.files import write
    from exercisegrader.term import Term

    try:
        found = Term(folder)
        write(folder / "term.csv", found.table())
    except GradingError as error:
        fail(str(error))
    for sentence in found.notes():
        errors.print(sentence, style="yellow", markup=False)
    count = f"{len(found.students)} students in {', '.join(found.points)}"
    console.print(f"{count}; {folder / 'term.csv'} has them", markup=False)


if __name__ == "__main__":
    app()
