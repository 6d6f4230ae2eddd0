"""The command line: `loopbook`, or ``python -m loopbook``, lists the commands."""

import os
from pathlib import Path
from typing import Annotated

import typer
from rich import box
from rich.console import Console
from rich.table import Table

app = typer.Typer(
    name="loopbook",
    add_completion=False,
    pretty_exceptions_show_locals=False,
)
console = Console(highlight=False, soft_wrap=True)
errors = Console(highlight=False, soft_wrap=True, stderr=True)


@app.callback(invoke_without_command=True)
def loopbook(context: typer.Context) -> None:
    """Process control books as notebooks in which every printed number is computed and checked."""
    if context.invoked_subcommand is None:
        typer.echo(context.get_help())


@app.command(context_settings={"allow_extra_args": True, "ignore_unknown_options": True})
def lab(context: typer.Context) -> None:
    """Open the start page in JupyterLab, in a copy of the notebooks that is yours. Options of JupyterLab may follow."""
    from loopbook import working_copy

    here, copy = Path(), Path(working_copy.FOLDER)
    if working_copy.START not in working_copy.originals(here):
        fail(f"no {working_copy.START} here: run this in the folder that holds chapters")
    from jupyterlab.labapp import LabApp

    try:
        news = working_copy.brought_up_to_date(here, copy)
    except OSError as error:
        fail(f"{error.filename or copy} cannot be written: {error.strerror}")
    for name in news:
        says = f"{copy}/{name} is yours, and there is a newer one: python -m loopbook fresh {name} puts it in place"
        console.print(f"{says} and keeps yours under another name", markup=False)
    options = {
        "config": "jupyter_lab_config.py",
        "ServerApp.root_dir": copy,
        "LabApp.default_url": f"/lab/tree/{working_copy.START}",
        "LabApp.workspaces_dir": copy.absolute() / ".workspaces",  # what was open in other folders stays there
    }
    LabApp.launch_instance([*(f"--{name}={value}" for name, value in options.items()), *context.args])


@app.command()
def fresh(
    chapter: Annotated[
        str, typer.Argument(help="Number or name of a chapter, or a notebook such as solutions/10_tuning.ipynb.")
    ],
) -> None:
    """Put a fresh notebook into your copy; the one that you have changed is kept under another name."""
    from loopbook import working_copy

    copy = Path(working_copy.FOLDER)
    try:
        done = working_copy.fresh(Path(), copy, chapter)
    except OSError as error:
        fail(f"{error.filename or copy} cannot be written: {error.strerror}")
    if not done:
        fail(f"no notebook {chapter}: expected a chapter's number, such as 10, or chapters/10_tuning.ipynb")
    for name, kept in done:
        console.print(f"{copy}/{name} is fresh{f'; yours is {copy}/{kept}' if kept else ''}", markup=False)


@app.command()
def execute(
    paths: Annotated[
        list[Path] | None,
        typer.Argument(help="Notebooks, or folders of notebooks; chapters and solutions when none is named."),
    ] = None,
) -> None:
    """Run notebooks from top to bottom and store their outputs."""
    # Imported here, because the other commands do without the notebook machinery.
    from loopbook import notebooks

    try:
        chosen = notebooks.found(paths or filter(Path.is_dir, [Path("chapters"), Path("solutions")]))
    except notebooks.NotebookError as error:
        fail(str(error))
    if not chosen:
        fail("no notebooks here: name some, or run this in the folder that holds chapters")
    failed = 0
    try:
        with console.status(f"executing {len(chosen)} notebooks"):
            for path, seconds, changed, error in notebooks.execute_all(chosen):
                if error:
                    failed += 1
                    errors.print(str(error), style="bold red", markup=False)
                else:
                    console.print(f"{path}: {'stored' if changed else 'unchanged'} ({seconds:.0f} s)", markup=False)
    except KeyboardInterrupt:
        # An ordinary exit would wait for the running cells; the kernels end by themselves once this process is gone.
        errors.print("interrupted; the notebooks not named above are as they were", style="bold red")
        os._exit(130)
    if failed:
        fail(f"{failed} of {len(chosen)} notebooks not stored")


@app.command()
def ledger(
    errata: Annotated[Path, typer.Option(help="Where to write the list of the books' errors.")] = Path("ERRATA.md"),
    pages: Annotated[
        Path, typer.Option(help="Folder for what was not reproduced, and what our copies have damaged.")
    ] = Path("docs"),
) -> None:
    """Print the totals of the ledger by source and status, and write errors, open questions and damage as pages."""
    from bookledger.errata import totals
    from bookledger.statuses import STATUSES
    from loopbook.errata import damaged, page, unreproduced
    from loopbook.ledger import LedgerError, sources

    try:
        books = sources()
    except LedgerError as error:
        fail(str(error))
    counts = totals(books)
    table = Table("source", box=box.SIMPLE_HEAD, pad_edge=False, collapse_padding=True)
    for name in (*STATUSES, "all"):
        table.add_column(name, justify="right")
    for name, count in counts.items():
        table.add_row(name, *map(str, count.values()), str(sum(count.values())))
    table.add_section()
    sums = [sum(count[status] for count in counts.values()) for status in STATUSES]
    table.add_row("all", *map(str, sums), str(sum(sums)))
    Console(highlight=False, width=1000).print(table)  # no name is cut where the terminal is narrow
    texts = {errata: page(books), pages / "unreproduced.md": unreproduced(books), pages / "damage.md": damaged(books)}
    for path, text in texts.items():
        try:
            path.parent.mkdir(exist_ok=True)
            path.write_text(text, encoding="utf-8", newline="\n")
        except OSError as error:
            fail(f"{path} cannot be written: {error.strerror}")
        console.print(f"{path} written", markup=False)


ROSTER = (
    "The class as CSV: id and name, or an export of Canvas, Moodle or Gradescope; if not given, roster.csv beside the "
    "assignment."
)


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
    nbgrader: Annotated[bool, typer.Option(help="Write one source assignment for nbgrader instead.")] = False,
) -> None:
    """Write one notebook per student: own numbers, places for answers, nothing of the key.

    The numbers are kept in a record beside the assignment, as heater.released.json. Released again, for students who
    joined later or with a statement that was mended, everybody keeps the numbers of the record, whatever the ranges
    are by then, and no notebook is replaced unless --replace says so.
    """
    from exercisegrader import GradingError
    from exercisegrader.assignment import load
    from exercisegrader.files import write

    try:
        given = load(assignment)
        if nbgrader:
            from exercisegrader.nbgrader import source
            from exercisegrader.release import as_text

            path = to / f"{given.name}.ipynb"
            write(path, as_text(source(given)))
            console.print(f"the source notebook of {given.title!r} is {path}", markup=False)
            return
        from exercisegrader import lms
        from exercisegrader.release import release
        from exercisegrader.roster import read_roster

        roster = read_roster(students or assignment.with_name("roster.csv"))
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


@app.command("try")
def try_out(
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
    from rich.progress import BarColumn, MofNCompleteColumn, Progress, TextColumn, TimeRemainingColumn

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
        columns = TextColumn("trying"), BarColumn(), MofNCompleteColumn(), TimeRemainingColumn()
        with Progress(*columns, console=errors, transient=True, disable=not errors.is_terminal) as progress:
            bar = progress.add_task("", total=len(ids) * len(given.exercises))
            found = list(trial.try_all(given, ids, seconds, lambda done: progress.update(bar, completed=done)))
    except GradingError as error:
        fail(str(error))
    except KeyboardInterrupt:
        fail("interrupted")
    console.print(trial.report(found), markup=False)
    if any(one.level == trial.WRONG for one in found):
        name = assignment if not students else f"{assignment} --students {students}"
        fail(f"something is wrong; loopbook try {name} --student ID --exercise N shows a variant")


class Grade(typer.core.TyperCommand):
    """A command that lists, where its help is asked for, what it writes."""

    def written(self) -> list[str]:
        """The outputs that are registered, each as its file and what it is."""
        from exercisegrader import GradingError
        from exercisegrader.reports import registered

        try:
            return [f"{output.file}: {output.what}" for output in registered()]
        except GradingError as error:
            fail(str(error))

    def format_help(self, context: typer.Context, formatter: object) -> None:
        """Print the help, and the list."""
        self.epilog = "\n\n".join(["What is written:", *self.written()])
        super().format_help(context, formatter)


@app.command(cls=Grade)
def grade(
    assignment: Annotated[Path, typer.Argument(help="The assignment that was released.")],
    submissions: Annotated[Path, typer.Argument(help="Their folder, or the zip file of Canvas or Moodle.")],
    to: Annotated[Path, typer.Option(help="Folder for grades and feedback; after an interruption, the same one.")],
    students: Annotated[Path | None, typer.Option(help=ROSTER)] = None,
    extensions: Annotated[
        Path | None,
        typer.Option(
            help="Extensions as CSV: student, until, assignment; if not given, extensions.csv beside the roster."
        ),
    ] = None,
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
    cluster: Annotated[str | None, typer.Option(help="Address of a Dask scheduler whose workers grade.")] = None,
    without_jail: Annotated[
        bool, typer.Option("--without-jail", help="Run submissions with your own rights; every output says so.")
    ] = False,
) -> None:
    """Run the submissions of a class in a jail, judge their answers, and write grades and feedback."""
    from rich.progress import BarColumn, MofNCompleteColumn, Progress, TextColumn, TimeRemainingColumn

    from exercisegrader import GradingError

    try:
        from exercisegrader.assignment import load
        from exercisegrader.cluster import connected
        from exercisegrader.grade import grade as grade_all
        from exercisegrader.grade import here
        from exercisegrader.jail import MEGA, Limits
        from exercisegrader.roster import read_roster

        class_list = students or assignment.with_name("roster.csv")
        given, roster = load(assignment), read_roster(class_list)
        beside = class_list.with_name("extensions.csv")
        columns = TextColumn("grading"), BarColumn(), MofNCompleteColumn(), TimeRemainingColumn()
        with Progress(*columns, console=errors, transient=True, disable=not errors.is_terminal) as progress:
            bar = progress.add_task("", total=None)
            done = grade_all(
                given,
                roster,
                submissions,
                to,
                place=here(workers) if cluster is None else connected(cluster),
                extensions=extensions or (beside if os.path.lexists(beside) else None),
                only=only or (),
                regrade=regrade,
                jailed=not without_jail,
                limits=Limits(cell=cell_seconds, total=seconds, memory=megabytes * MEGA),
                reveal=reveal,
                latest=latest,
                keep_notebooks=keep_notebooks,
                follow=lambda total, count: progress.update(bar, total=total, completed=count),
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


def fail(message: str) -> None:
    """End the command with exit code 1 and one line on the error stream."""
    errors.print(message, style="bold red", markup=False)
    raise typer.Exit(1)


if __name__ == "__main__":
    app()
