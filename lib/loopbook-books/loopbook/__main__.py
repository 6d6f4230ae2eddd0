"""The command line: `loopbook`, or ``python -m loopbook``, lists the commands."""

import os
from pathlib import Path
from typing import Annotated

import typer
from rich import box
from rich.console import Console
from rich.table import Table

from exercisegrader.__main__ import app as grader
from exercisegrader.__main__ import console, errors, fail, progress

app = typer.Typer(
    name="loopbook",
    add_completion=False,
    pretty_exceptions_show_locals=False,
)


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
        with console.status(f"executing {len(chosen)} notebooks") as status:
            for count, (path, seconds, changed, error) in enumerate(notebooks.execute_all(chosen), start=1):
                status.update(so_far := f"{count} of {len(chosen)} notebooks executed")
                if error:
                    failed += 1
                    errors.print(str(error), style="bold red", markup=False)
                else:
                    says = f"{path}: {'stored' if changed else 'unchanged'} ({seconds:.0f} s)"
                    console.print(says if console.is_terminal else f"{says}, {so_far}", markup=False)
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


@app.command()
def export(
    what: Annotated[
        list[str] | None,
        typer.Argument(
            help="An assignment, or chapters and exercises of the bank, as 10 and 3.4; all if none is named."
        ),
    ] = None,
    moodle: Annotated[Path | None, typer.Option(help="File for Moodle's question bank, as heater.xml.")] = None,
    stack: Annotated[
        bool,
        typer.Option("--stack", help="With --moodle: formulas, lists and poles, as questions of its plug-in STACK."),
    ] = False,
    scorm: Annotated[
        Path | None, typer.Option(help="File for a page of the bank's exercises, as practice.zip.")
    ] = None,
    variants: Annotated[int, typer.Option(min=1, help="Variants of each exercise for --moodle.")] = 5,
    site: Annotated[Path, typer.Option(help="The site, from which --scorm takes its parts.")] = Path("build/book"),
) -> None:
    """Write exercises for a learning management system: questions for its bank, or a page for practice."""
    from exercisebook.errors import ExerciseError
    from exercisebook.export import moodle as questions
    from exercisebook.export.stack import stack as formulas
    from exercisegrader import GradingError
    from exercisegrader.files import write
    from loopbook.exporting import chosen
    from loopbook.scorm import package

    if not moodle and not scorm:
        fail("nothing says for what: expected --moodle FILE or --scorm FILE")
    try:
        given = chosen(what or [])
        if scorm:
            if given.is_assignment:
                fail("the keys of an assignment would be in the page: expected exercises of the bank for --scorm")
            write(scorm, package(given.numbers, given.title, site))
            console.print(f"{len(given.numbers)} exercises in {scorm}, a SCORM 1.2 package, for practice", markup=False)
        if not moodle:
            return
        with progress("exporting") as show:
            forms = [questions.cloze, formulas] if stack else [questions.cloze]
            found = questions.exported(given.variants(variants, show), given.title, given.credit, forms)
        ends = [f"-{count}" for count in range(1, len(found.files) + 1)] if len(found.files) > 1 else [""]
        names = [moodle.with_stem(moodle.stem + end) for end in ends]
        for name, content in zip(names, found.files, strict=False):
            write(name, content)
    except (ExerciseError, GradingError) as error:
        fail(str(error))
    if found.left_out:
        kinds = ", ".join(sorted(set(found.left_out.values())))
        says = f"{len(found.left_out)} left out, since they ask for what has no place there ({kinds})"
        errors.print(f"{says}: {', '.join(found.left_out)}", style="yellow", markup=False)
    if not found.files:
        fail("nothing was written")
    count = f"{found.questions} questions, exercises in variants: {len(given.numbers) - len(found.left_out)}"
    console.print(f"{count}; {', '.join(map(str, names))}", markup=False)


app.registered_commands += grader.registered_commands

if __name__ == "__main__":
    app()
