"""The commands ``dofkit export ...``: what course platforms need to grade an assignment, and results for others."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

import typer

from dofkit.interface import options
from dofkit.interface.failures import failures_of

export_app = typer.Typer(
    help="Write what a course platform needs to grade an assignment.", no_args_is_help=True, rich_markup_mode=None
)


@export_app.command("gradescope")
def export_gradescope(
    assignment: options.Assignment,
    out: Annotated[Path, typer.Option("--out", metavar="PATH", help="The zip to upload.")] = Path("autograder.zip"),
    python: Annotated[
        list[str] | None,
        typer.Option(
            "--python", metavar="VERSION", help="A Python there; may be given again. By default 3.11 to 3.13."
        ),
    ] = None,
    wheels: Annotated[
        bool, typer.Option(help="Put in dofkit and all it needs, so that no network is needed there.")
    ] = True,
    reviewed: options.ReviewTable = None,
) -> None:
    """Write the autograder of an assignment for Gradescope, as one zip to upload."""
    from dofkit.homework import export

    with failures_of(assignment):
        pythons = python or export.PYTHONS
        notes = export.export_gradescope(assignment, out, pythons, wheels=wheels, reviewed=reviewed)
    for note in notes:
        typer.echo(f"{out}: {note}", err=True)


@export_app.command("otter")
def export_otter(
    assignment: options.Assignment,
    out: Annotated[Path, typer.Option("--out", metavar="FOLDER", help="Where the notebook goes.")] = Path("otter"),
) -> None:
    """Write an assignment's master notebook for `otter assign`, and the two files that its tests read."""
    from dofkit.homework import export

    with failures_of(assignment):
        for path in export.export_otter(assignment, out):
            typer.echo(path)


@export_app.command("grades")
def export_grades(
    assignment: options.Assignment,
    results: Annotated[Path, typer.Argument(metavar="RESULTS", help="results.jsonl of `dofkit grade`, or its folder.")],
    form: Annotated[str, typer.Option("--format", metavar="NAME", help="What a gradebook or platform reads.")],
    out: Annotated[Path, typer.Option("--out", metavar="PATH", help="Where to write.")],
    roster: options.RosterPath = None,
) -> None:
    """Write results that are there for another platform: nothing is graded again."""
    from dofkit.homework.runs.conversion import convert
    from dofkit.homework.runs.run import GradingOptions

    with failures_of(assignment):
        count = convert(assignment, results, GradingOptions(form, out, roster=roster))
    typer.echo(f"{out}: {count} results")
