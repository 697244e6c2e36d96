"""The command line: every command reads files, tells what it found of each, and never lets one stop the others."""

from __future__ import annotations

import json
import math
import os
import sys
from collections.abc import Generator
from contextlib import closing
from copy import copy
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, cast

import typer
from typer.main import get_command_name
from typer.models import CommandInfo

from dofkit.base.version import __version__
from dofkit.interface import options
from dofkit.interface.assignment_commands import assignment_app
from dofkit.interface.catalog_commands import catalog_app
from dofkit.interface.export_commands import export_app
from dofkit.interface.failures import INTERRUPTED, UNREADABLE, failures_of, print_json
from dofkit.interface.presentation import Telling

if TYPE_CHECKING:
    from dofkit.interface.supervised import Printed
    from dofkit.methods.names import MethodName

app = typer.Typer(
    name="dofkit",
    help="Tells how a mechanical system can move: degrees of freedom, labels of its constraints, what is redundant.",
    no_args_is_help=True,
    pretty_exceptions_enable=False,
    rich_markup_mode=None,
    context_settings={"help_option_names": ["-h", "--help"]},
)
app.add_typer(catalog_app, name="catalog")
app.add_typer(assignment_app, name="assignment")
app.add_typer(export_app, name="export")

#: Reports of more scenes than this are a line each, unless they are asked for in full.
MOST_IN_FULL = 3


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
    """Tell how a mechanical system can move."""


@app.command()
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
    """Classify scenes: degrees of freedom, labels, integrals, redundancy, each with a verdict."""
    from dofkit.interface.classification import Asked, classified, watched

    if budget is not None and math.isnan(budget):
        raise typer.BadParameter("it is a number of seconds", param_hint="--budget")
    if out is not None and (watch or full or how or brief):
        raise typer.BadParameter("it writes JSON lines, without --watch, --brief, --full, --how", param_hint="--out")
    telling = Telling.here(as_json, brief or (len(files) > MOST_IN_FULL and not (full or how)), how)
    telling = telling._replace(only=options.fields(only), without=options.listed(without), limits=limits)
    asked = Asked(tuple(files), telling, budget, cast("MethodName", method), certificate, options.failures(fail_on))
    asked = asked._replace(workers=workers, scheduler=scheduler, out=out)
    with failures_of("--watch" if watch else "classify"):
        status = watched(asked) if watch else classified(asked)
    raise typer.Exit(status)


@app.command()
def verify(files: options.CertificateFiles, strict: options.Strict = False, as_json: options.AsJson = False) -> None:
    """Recheck a certificate by a second program: so many of so many claims hold, and what is not covered."""
    from dofkit.interface.supervised import CertificateGiven, verification

    if len(files) > 2:
        raise typer.BadParameter("a scene and its certificate, or a certificate alone", param_hint="[SCENE] CERT")
    out, err, status = verification(CertificateGiven(files[0] if files[1:] else None, files[-1], strict, as_json))
    typer.echo(out, nl=False)
    typer.echo(err, nl=False, err=True)
    raise typer.Exit(status)


@app.command()
def convert(file: options.ModelPath, out: options.ScenePath = None, limits: options.Limits = False) -> None:
    """Make a scene of a model: MJCF, URDF or a SolveSpace sketch, as a file to go on from."""
    from dofkit.interface.conversion import write_converted

    with failures_of(file):
        typer.echo(write_converted(file, out, limits), nl=False)


@app.command()
def lagrange(
    files: options.Files,
    as_json: options.AsJson = False,
    linearize: options.Linearize = False,
    certificate: options.CertificatePath = None,
) -> None:
    """Derive equations of motion: Lagrangian, momenta, forces, one equation for each coordinate."""
    from dofkit.interface.supervised import motions

    _print(motions(files, linearize, Telling.here(as_json), certificate))


def _still(kind: str, about: str) -> None:
    """A command for a kind of still picture."""

    @app.command(kind, help=about)
    def still(files: options.Files, out: options.PicturePath = None, form: options.StillKind = "svg") -> None:
        _pictures(files, kind, out, form)


_still("draw", "Draw scenes: ground, bodies, joints by their symbols, what moves, is redundant or contradicts.")


@app.command()
def animate(files: options.Files, out: options.PicturePath = None, form: options.MovingKind = "html") -> None:
    """Draw scenes in motion: a page with a slider, a gif or an mp4."""
    _pictures(files, "animate", out, form)


_still("graph", "Draw constraints and what they hold as a graph, redundant ones marked.")
_still("phase", "Draw the directions that differential constraints allow, and those that their brackets add.")


@app.command()
def grade(
    assignment: options.Assignment,
    submissions: options.Submissions,
    form: options.ResultFormat = "native",
    out: options.ResultPath = None,
    workers: options.Workers = None,
    scheduler: options.Scheduler = None,
    check_only: options.CheckOnly = False,
    certificates: options.CertificateFolder = None,
    reviewed: options.ReviewTable = None,
    roster: options.RosterPath = None,
) -> None:
    """Grade submissions: a result for each, in the order given."""
    from dofkit.homework.runs.run import GradingOptions, run

    chosen = GradingOptions(form, out, workers, scheduler, check_only, certificates, reviewed, roster)
    with failures_of(assignment):
        clean = run(assignment, submissions, chosen)
    if not clean:
        raise typer.Exit(UNREADABLE)


@app.command()
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
    """Chart speed against accuracy: every method on scenes whose answers are known."""
    from dofkit.benchmark.command import ChartOptions, chart
    from dofkit.benchmark.selecting import Selection

    selection = Selection(question or (), families or (), methods or (), quick, most)
    with failures_of("chart"):
        whole = chart(ChartOptions(selection, out, source, scheduler, workers, timeout))
    if not whole:
        raise typer.Exit(INTERRUPTED)


@app.command()
def explain(
    words: Annotated[
        list[str] | None,
        typer.Argument(
            metavar="WORD",
            show_default=False,
            help="A code of feedback, a field of a report, a verdict, an argument, a theorem, a type of constraint.",
            autocompletion=options.explained,
        ),
    ] = None,
    as_json: options.AsJson = False,
) -> None:
    """Explain a word of dofkit: what a code, a field, a verdict, a theorem or a type of constraint means.

    Without a WORD all that can be explained is listed.
    """
    from dofkit.interface.explanations import explanations_of, listed

    word = " ".join(words or ())
    if not word:
        typer.echo(listed())
        return
    with failures_of(word):
        found = explanations_of(word)
    for told in found:
        if as_json:
            print_json(told._asdict())
        else:
            typer.echo(told.text())


@app.command()
def schema(
    of: Annotated[
        str, typer.Argument(metavar="[WHAT]", help="scene, assignment, submission, result, report or chart.")
    ] = "scene",
) -> None:
    """Print the JSON Schema of a scene, or of what is named."""
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


def _pictures(files: list[str], kind: str, out: Path | None, ending: str) -> None:
    from dofkit.interface.supervised import pictures

    _print(pictures(files, kind, None if out is None else str(out), ending))


def _print(printed: Generator[Printed]) -> None:
    """Print what there is of each file; the exit status tells whether one could not be read."""
    from dofkit.interface.classification import echo

    failed = False
    with closing(printed) as stream:
        for printed_of_file in stream:
            echo(printed_of_file)
            failed = failed or printed_of_file.failed
    if failed:
        raise typer.Exit(UNREADABLE)


def _app_for(words: list[str]) -> typer.Typer:
    """The command line; where its first word names a command, with no other: to make all ready takes longer."""
    found = copy(app)
    found.registered_commands = [one for one in app.registered_commands if [_name_of(one)] == words]
    found.registered_groups = [one for one in app.registered_groups if [one.name] == words]
    return found if found.registered_commands or found.registered_groups else app


def _name_of(command: CommandInfo) -> str | None:
    return command.name or (command.callback and get_command_name(command.callback.__name__))


def main() -> None:
    """Run the command line; no exit is untidy."""
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
