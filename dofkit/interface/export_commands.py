"""The commands ``dofkit export ...``: assignments and results in the formats of course platforms."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

import typer

from dofkit.interface import options
from dofkit.interface.failures import failures_of
from dofkit.interface.help_panels import PanelCommand

export_app = typer.Typer(
    help="Export assignments and grades for course platforms.", no_args_is_help=True, rich_markup_mode=None
)


@export_app.command("gradescope", cls=PanelCommand)
def export_gradescope(
    assignment: options.Assignment,
    out: Annotated[
        Path, typer.Option("--out", metavar="PATH", callback=options.file_of("zip"), help="The zip to upload.")
    ] = Path("autograder.zip"),
    python: Annotated[
        list[str] | None,
        typer.Option(
            "--python",
            metavar="VERSION",
            help="A Python version on the platform; may be repeated. Default: 3.11 to 3.13.",
        ),
    ] = None,
    wheels: Annotated[
        bool, typer.Option(help="Include dofkit and its dependencies, so that no network is needed.")
    ] = True,
    reviewed: options.ReviewTable = None,
) -> None:
    """Write a Gradescope autograder as one zip to upload."""
    from dofkit.homework import export

    with failures_of(assignment):
        pythons = python or export.PYTHONS
        notes = export.export_gradescope(assignment, out, pythons, wheels=wheels, reviewed=reviewed)
    for note in notes:
        typer.echo(f"{out}: {note}", err=True)


@export_app.command("grades", cls=PanelCommand)
def export_grades(
    assignment: options.Assignment,
    results: Annotated[
        Path, typer.Argument(metavar="RESULTS", help="The results.jsonl of `dofkit grade`, or its folder.")
    ],
    form: Annotated[str, typer.Option("--format", metavar="NAME", help="The format of a gradebook or platform.")],
    out: Annotated[Path, typer.Option("--out", metavar="PATH", help="The file or folder to write.")],
    roster: options.RosterPath = None,
) -> None:
    """Write existing results in another format, without regrading."""
    from dofkit.homework.runs.run import GradingOptions, convert

    with failures_of(assignment):
        count = convert(assignment, results, GradingOptions(form, out, roster=roster))
    typer.echo(f"{out}: {count} results")
