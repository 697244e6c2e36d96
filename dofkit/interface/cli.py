"""The command line: every command answers the files one by one, and no file stops the others."""

from __future__ import annotations

import json
import math
import os
import sys
from collections.abc import Callable, Generator
from contextlib import closing
from copy import copy
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any, TypeVar, cast

import typer
from typer.main import get_command_name
from typer.models import CommandInfo

from dofkit.base import __version__
from dofkit.base.arguments import format_of_path, is_folder_path
from dofkit.base.errors import ArgumentError
from dofkit.interface import options
from dofkit.interface.assignment_commands import assignment_app
from dofkit.interface.catalog_commands import catalog
from dofkit.interface.export_commands import export_app
from dofkit.interface.failures import INTERRUPTED, UNREADABLE, failures_of, print_json
from dofkit.interface.help_panels import MORE, PanelCommand, PanelGroup
from dofkit.interface.presentation import Telling

if TYPE_CHECKING:
    from dofkit.interface.supervised import Printed
    from dofkit.methods.table import MethodName

Handler = TypeVar("Handler", bound=Callable[..., Any])

app = typer.Typer(
    name="dofkit",
    cls=PanelGroup,
    help="Determine how a mechanical system can move: its degrees of freedom, constraint labels and redundancy.",
    no_args_is_help=True,
    pretty_exceptions_enable=False,
    rich_markup_mode=None,
    context_settings={"help_option_names": ["-h", "--help"]},
)
app.add_typer(assignment_app, name="assignment", rich_help_panel=MORE)
app.add_typer(export_app, name="export", rich_help_panel=MORE)

#: Reports of more scenes than this are printed as one line each, unless full reports are asked for.
MOST_IN_FULL = 3


def _command(panel: str | None = None) -> Callable[[Handler], Handler]:
    """Return what adds a function to the command line, under a heading of the help."""
    return app.command(cls=PanelCommand, rich_help_panel=panel)


def _version(asked: bool) -> None:
    if asked:
        typer.echo(__version__)
        raise typer.Exit


@app.callback()
def dofkit(
    version: Annotated[
        bool, typer.Option("--version", callback=_version, is_eager=True, help="Print the version and stop.")
    ] = False,
) -> None:
    """Determine how a mechanical system can move."""


@_command()
def classify(
    files: options.Files,
    as_json: options.AsJson = False,
    brief: options.Brief = False,
    full: options.Full = False,
    how: options.How = False,
    only: options.Only = None,
    without: options.Without = None,
    fail_on: options.FailOn = None,
    watch: options.Watch = False,
    budget: options.Budget = None,
    method: options.Method = "auto",
    certificate: options.CertificatePath = None,
    limits: options.Limits = False,
    workers: options.SceneWorkers = None,
    scheduler: options.Scheduler = None,
    out: options.ReportFolder = None,
) -> None:
    """Report degrees of freedom, constraint labels and redundancy.

    Every answer carries a verdict: proved, probable, numeric or undecided.
    """
    from dofkit.interface.classification import Asked, classified, watched

    if budget is not None and math.isnan(budget):
        raise typer.BadParameter("the budget is a number of seconds", param_hint="--budget")
    if out is not None and (watch or full or how or brief):
        raise typer.BadParameter("it cannot be combined with --watch, --brief, --full or --how", param_hint="--out")
    telling = Telling.here(as_json, brief or (len(files) > MOST_IN_FULL and not (full or how)), how)
    telling = telling._replace(only=options.fields(only), without=options.listed(without), limits=limits)
    asked = Asked(tuple(files), telling, budget, cast("MethodName", method), certificate, options.failures(fail_on))
    asked = asked._replace(workers=workers, scheduler=scheduler, out=out)
    with failures_of("--watch" if watch else "classify"):
        status = watched(asked) if watch else classified(asked)
    raise typer.Exit(status)


@_command()
def draw(
    files: options.Files,
    drawn_as: options.DrawnAs = "mechanism",
    out: options.PicturePath = None,
    form: options.StillKind = None,
) -> None:
    """Draw the mechanism, its constraint graph or its directions."""
    _pictures(files, drawn_as, out, form, options.STILL_KINDS)


@_command()
def animate(files: options.Files, out: options.PicturePath = None, form: options.MovingKind = None) -> None:
    """Animate the motion: a page with a slider, a GIF or an MP4."""
    _pictures(files, "motion", out, form, options.MOVING_KINDS)


@_command()
def lagrange(
    files: options.Files,
    as_json: options.AsJson = False,
    linearize: options.Linearize = False,
    certificate: options.CertificatePath = None,
) -> None:
    """Derive the equations of motion from the energies."""
    from dofkit.interface.supervised import motions

    _print(motions(files, linearize, Telling.here(as_json), certificate), as_json)


@_command()
def grade(
    assignment: options.Assignment,
    submissions: options.Submissions,
    form: options.ResultFormat = "native",
    out: options.ResultPath = None,
    workers: options.Workers = None,
    check_only: options.CheckOnly = False,
    reviewed: options.ReviewTable = None,
    roster: options.RosterPath = None,
) -> None:
    """Grade the submissions of an assignment, with feedback."""
    from dofkit.homework.runs.run import GradingOptions, run

    chosen = GradingOptions(form, out, workers, check_only, reviewed, roster)
    with failures_of(assignment):
        clean = run(assignment, submissions, chosen)
    if not clean:
        raise typer.Exit(UNREADABLE)


@_command(MORE)
def new(file: options.NewPath = None) -> None:
    """Write a first scene to edit, with the schema for editors."""
    from dofkit.interface.conversion import write_new

    with failures_of("new"):
        typer.echo(write_new(file), nl=False)


@_command(MORE)
def convert(file: options.ModelPath, out: options.ScenePath = None, limits: options.Limits = False) -> None:
    """Convert a MJCF, URDF or SolveSpace model to a scene."""
    from dofkit.interface.conversion import write_converted

    with failures_of(file):
        typer.echo(write_converted(file, out, limits), nl=False)


@_command(MORE)
def explain(
    words: Annotated[
        list[str] | None,
        typer.Argument(
            metavar="WORD",
            show_default=False,
            help="A feedback code, report field, verdict, argument, theorem, constraint type or section of a scene.",
            autocompletion=options.explained,
        ),
    ] = None,
    as_json: options.AsJson = False,
) -> None:
    """Explain a field, verdict, constraint type or feedback code.

    Without a WORD, list every word that can be explained.
    """
    from dofkit.interface.explanations import explanations_of, listed

    word = " ".join(words or ())
    if not word:
        typer.echo(listed())
        return
    with failures_of(word):
        explanations = explanations_of(word)
    for explanation in explanations:
        if as_json:
            print_json(explanation._asdict())
        else:
            typer.echo(explanation.text())


_command(MORE)(catalog)


@_command(MORE)
def verify(files: options.CertificateFiles, strict: options.Strict = False, as_json: options.AsJson = False) -> None:
    """Check a certificate with the independent checker."""
    from dofkit.interface.supervised import CertificateGiven, verification

    if len(files) > 2:
        raise typer.BadParameter("a scene and its certificate, or a certificate alone", param_hint="[SCENE] CERT")
    out, err, status = verification(CertificateGiven(files[0] if files[1:] else None, files[-1], strict, as_json))
    typer.echo(out, nl=False)
    typer.echo(err, nl=False, err=True)
    raise typer.Exit(status)


@_command(MORE)
def schema(
    of: Annotated[
        str,
        typer.Argument(metavar="[WHAT]", help="scene, assignment, submission, result, report or chart."),
    ] = "scene",
) -> None:
    """Print the JSON Schema of scenes, assignments or reports."""
    if of == "scene":
        from dofkit.scene.schema import scene_schema

        typer.echo(json.dumps(scene_schema(), indent=2))
        return
    from dofkit.benchmark.record import ChartRun
    from dofkit.homework.schemas import SCHEMAS
    from dofkit.scene.schema import identified

    if of == "chart":
        typer.echo(json.dumps(identified(ChartRun.model_json_schema(), of), indent=2))
    elif of in SCHEMAS:
        typer.echo(json.dumps(SCHEMAS[of](), indent=2))
    else:
        raise typer.BadParameter(f"'{of}' is none of scene, {', '.join(SCHEMAS)}, chart", param_hint="WHAT")


@_command(MORE)
def chart(
    question: options.Questions = None,
    families: options.Families = None,
    methods: options.Methods = None,
    out: options.ChartFolder = Path("dofkit-chart"),
    source: options.ChartSource = None,
    quick: options.Quick = False,
    most: options.Most = None,
    scheduler: options.Scheduler = None,
    workers: options.Workers = None,
    timeout: options.Timeout = None,
) -> None:
    """Compare methods by speed and accuracy on known scenes."""
    from dofkit.benchmark.command import ChartOptions, chart
    from dofkit.benchmark.tasks import Selection

    selection = Selection(question or (), families or (), methods or (), quick, most)
    with failures_of("chart"):
        whole = chart(ChartOptions(selection, out, source, scheduler, workers, timeout))
    if not whole:
        raise typer.Exit(INTERRUPTED)


def _pictures(files: list[str], kind: str, out: Path | None, form: str | None, known: tuple[str, ...]) -> None:
    from dofkit.interface.supervised import pictures

    if out is not None and not is_folder_path(out):
        with failures_of("--out"):
            form = format_of_path(out, known, form)
            if len(files) > 1:
                raise ArgumentError(f"'{out}' is one file, and {len(files)} scenes are drawn: name a folder")
    _print(pictures(files, kind, out, form or known[0]))


def _print(printed: Generator[Printed], as_json: bool = False) -> None:
    """Print the output for each file; exit with status 2 if a file could not be read."""
    from dofkit.interface.classification import echo, echo_count

    errors = []
    with closing(printed) as stream:
        for printed_of_file in stream:
            echo(printed_of_file)
            errors.append(printed_of_file.errors)
    if any(errors):
        if not as_json:
            echo_count(errors)
        raise typer.Exit(UNREADABLE)


def _app_for(words: list[str]) -> typer.Typer:
    """Return the command line; where its first word names a command, with that command only, which starts sooner."""
    only = copy(app)
    only.registered_commands = [command for command in app.registered_commands if [_name_of(command)] == words]
    only.registered_groups = [group for group in app.registered_groups if [group.name] == words]
    return only if only.registered_commands or only.registered_groups else app


def _name_of(command: CommandInfo) -> str | None:
    return command.name or (command.callback and get_command_name(command.callback.__name__))


def main() -> None:
    """Run the command line; an interrupt or a closed pipe ends it without a traceback."""
    for stream in (sys.stdout, sys.stderr):
        if hasattr(stream, "reconfigure"):
            stream.reconfigure(errors="backslashreplace")
    try:
        _app_for(sys.argv[1:2])()
    except KeyboardInterrupt:
        sys.exit(INTERRUPTED)
    except BrokenPipeError:
        os.dup2(os.open(os.devnull, os.O_WRONLY), sys.stdout.fileno())
        sys.exit(1)


if __name__ == "__main__":
    main()
