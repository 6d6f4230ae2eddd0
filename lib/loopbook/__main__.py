"""The command line: `python -m loopbook` lists the commands."""

import os
from pathlib import Path
from typing import Annotated

import typer
from rich import box
from rich.console import Console
from rich.table import Table

app = typer.Typer(
    name="python -m loopbook",
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
) -> None:
    """Print the totals of the ledger by source and status, and write the list of the books' errors."""
    from loopbook.ledger import LedgerError, sources
    from loopbook.ledger.errata import page, totals
    from loopbook.ledger.source import STATUSES

    try:
        books = sources()
    except LedgerError as error:
        fail(str(error))
    counts = totals(books)
    table = Table("", box=box.SIMPLE_HEAD, pad_edge=False)
    for name in (*counts, "all"):
        table.add_column(name, justify="right")
    for status in STATUSES:
        row = [count[status] for count in counts.values()]
        table.add_row(status, *map(str, row), str(sum(row)))
    table.add_section()
    sums = [sum(count.values()) for count in counts.values()]
    table.add_row("all", *map(str, sums), str(sum(sums)))
    console.print(table)
    try:
        errata.write_text(page(books), encoding="utf-8", newline="\n")
    except OSError as error:
        fail(f"{errata} cannot be written: {error.strerror}")
    console.print(f"{errata} written", markup=False)


def fail(message: str) -> None:
    """End the command with exit code 1 and one line on the error stream."""
    errors.print(message, style="bold red", markup=False)
    raise typer.Exit(1)


if __name__ == "__main__":
    app()
