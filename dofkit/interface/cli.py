"""The command line: every command reads files, tells what it found of each, and never lets one stop the others."""

from __future__ import annotations

import json
import math
import os
import sys
from collections.abc import Iterable
from contextlib import closing
from pathlib import Path
from typing import Annotated, Any, cast

import typer

from dofkit.base.errors import DofkitError, Fault, SceneError
from dofkit.base.version import __version__
from dofkit.methods.names import MethodName
from dofkit.methods.table import METHODS

app = typer.Typer(
    name="dofkit",
    help="Tells how a mechanical system can move: degrees of freedom, labels of its constraints, what is redundant.",
    add_completion=False,
    no_args_is_help=True,
    pretty_exceptions_enable=False,
    rich_markup_mode=None,
)
assignment_app = typer.Typer(help="Write assignments.", no_args_is_help=True, rich_markup_mode=None)
export_app = typer.Typer(
    help="Write what a course platform needs to grade an assignment.", no_args_is_help=True, rich_markup_mode=None
)
catalog_app = typer.Typer(
    help="List the scenes of the catalog, or show one.", invoke_without_command=True, rich_markup_mode=None
)
app.add_typer(catalog_app, name="catalog")
app.add_typer(assignment_app, name="assignment")
app.add_typer(export_app, name="export")

#: The exit status where something could not be read, and after Ctrl-C.
UNREADABLE, INTERRUPTED = 2, 130

Files = Annotated[list[str], typer.Argument(metavar="FILE...", help="Scenes: paths, catalog names, - for stdin.")]
AsJson = Annotated[bool, typer.Option("--json", help="One JSON object a line, in the order given.")]
Budget = Annotated[
    float | None,
    typer.Option(
        "--budget", metavar="SECONDS", min=0, help="Seconds for each scene; what is not finished is undecided."
    ),
]


def _known_method(name: str) -> str:
    if name not in METHODS:
        raise typer.BadParameter(f"'{name}' is none of {', '.join(METHODS)}")
    return name


Method = Annotated[
    str,
    typer.Option(
        "--method", metavar="NAME", callback=_known_method, help=f"One way to answer alone: {', '.join(METHODS)}."
    ),
]


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
def classify(files: Files, as_json: AsJson = False, budget: Budget = None, method: Method = "auto") -> None:
    """Classify scenes: degrees of freedom, labels, integrals, redundancy, each with a verdict."""
    from dofkit.interface.supervised import told

    if budget is not None and math.isnan(budget):
        raise typer.BadParameter("it is a number of seconds", param_hint="--budget")
    failed = False
    with closing(told(files, budget, cast(MethodName, method), as_json)) as stream:
        for out, err, unread in stream:
            typer.echo(out, nl=False)
            typer.echo(err, nl=False, err=True)
            failed = failed or unread
    if failed:
        raise typer.Exit(UNREADABLE)


@app.command()
def lagrange(
    files: Files,
    as_json: AsJson = False,
    linearize: Annotated[
        bool, typer.Option("--linearize", help="Also M, C and K of small motions about an equilibrium.")
    ] = False,
) -> None:
    """Derive equations of motion: Lagrangian, momenta, forces, one equation for each coordinate."""
    from dofkit.interface.supervised import motions

    failed = False
    with closing(motions(files, linearize, as_json)) as stream:
        for out, err, unread in stream:
            typer.echo(out, nl=False)
            typer.echo(err, nl=False, err=True)
            failed = failed or unread
    if failed:
        raise typer.Exit(UNREADABLE)


@app.command()
def grade(
    assignment: Annotated[str, typer.Argument(metavar="ASSIGNMENT", help="What was handed out: YAML or JSON.")],
    submissions: Annotated[
        list[str],
        typer.Argument(metavar="SUBMISSION...", help="YAML, JSON, JSON lines, CSV, folders of these, - for stdin."),
    ],
    form: Annotated[
        str, typer.Option("--format", metavar="NAME", help="native, or what a gradebook reads.")
    ] = "native",
    out: Annotated[
        Path | None,
        typer.Option("--out", metavar="PATH", help="Where to write; an interrupted run goes on where it stopped."),
    ] = None,
    workers: Annotated[
        int | None, typer.Option("--workers", metavar="N", min=1, help="Processes; by default one for each core.")
    ] = None,
    scheduler: Annotated[
        str | None, typer.Option("--scheduler", metavar="ADDRESS", help="A Dask cluster that does the work.")
    ] = None,
    check_only: Annotated[
        bool, typer.Option("--check-only", help="Tell how every answer is read, and grade none.")
    ] = False,
) -> None:
    """Grade submissions: a result for each, in the order given."""
    from dofkit.homework.runs.run import GradingOptions, run

    try:
        clean = run(assignment, submissions, GradingOptions(form, out, workers, scheduler, check_only))
    except (DofkitError, OSError) as error:
        if isinstance(error, BrokenPipeError):
            raise
        _fail(assignment, error)
        raise typer.Exit(UNREADABLE) from None
    if not clean:
        raise typer.Exit(UNREADABLE)


@app.command()
def chart(
    question: Annotated[
        list[str] | None, typer.Option("--question", metavar="Q", help="dof, integrability, redundancy, equivalence.")
    ] = None,
    families: Annotated[
        list[str] | None, typer.Option("--families", metavar="NAME,...", help="Of the trials; by default all.")
    ] = None,
    methods: Annotated[list[str] | None, typer.Option("--methods", metavar="NAME,...", help="By default all.")] = None,
    out: Annotated[Path, typer.Option("--out", metavar="DIR", help="Where data and figures go.")] = Path(
        "dofkit-chart"
    ),
    source: Annotated[
        Path | None, typer.Option("--from", metavar="DIR", help="Draw again from the data of a run.")
    ] = None,
    quick: Annotated[bool, typer.Option("--quick", help="A few small trials of each family: under a minute.")] = False,
    most: Annotated[
        int | None, typer.Option("--most", metavar="N", min=0, help="Trials of each family and question; 0: all.")
    ] = None,
    scheduler: Annotated[
        str | None, typer.Option("--scheduler", metavar="ADDRESS", help="A Dask cluster that does the work.")
    ] = None,
    workers: Annotated[
        int | None, typer.Option("--workers", metavar="N", min=1, help="Processes; by default one for each core.")
    ] = None,
    timeout: Annotated[
        float | None,
        typer.Option("--timeout", metavar="SECONDS", min=0.01, help="Processor time for each trial and method."),
    ] = None,
) -> None:
    """Chart speed against accuracy: every method on scenes whose answers are known."""
    from dofkit.benchmark.command import ChartOptions, run
    from dofkit.benchmark.selecting import Selection

    selection = Selection(question or (), families or (), methods or (), quick, most)
    try:
        whole = run(ChartOptions(selection, out, source, scheduler, workers, timeout))
    except (DofkitError, OSError) as error:
        if isinstance(error, BrokenPipeError):
            raise
        _fail("chart", error)
        raise typer.Exit(UNREADABLE) from None
    if not whole:
        raise typer.Exit(INTERRUPTED)


@assignment_app.command("new")
def assignment_new(
    scenes: Annotated[list[str], typer.Argument(metavar="SCENE...", help="Paths or catalog names.")],
) -> None:
    """Print a starting assignment: all the questions that the scenes can be asked."""
    from dofkit.homework.starting import starting

    try:
        typer.echo(starting(scenes), nl=False)
    except SceneError as error:
        _complain(error.source or "assignment", error.faults)
        raise typer.Exit(UNREADABLE) from None


@export_app.command("gradescope")
def export_gradescope(
    assignment: Annotated[str, typer.Argument(metavar="ASSIGNMENT", help="What was handed out: YAML or JSON.")],
    out: Annotated[Path, typer.Option("--out", metavar="PATH", help="The zip to upload.")] = Path("autograder.zip"),
    python: Annotated[
        list[str] | None,
        typer.Option("--python", metavar="VERSION", help="The Python there; may be given again. By default 3.12."),
    ] = None,
    wheels: Annotated[
        bool, typer.Option(help="Put in dofkit and all it needs, so that no network is needed there.")
    ] = True,
) -> None:
    """Write the autograder of an assignment for Gradescope, as one zip to upload."""
    from dofkit.homework import export

    try:
        notes = export.export_gradescope(assignment, out, python or (export.PYTHON,), wheels=wheels)
    except DofkitError as error:
        _fail(assignment, error)
        raise typer.Exit(UNREADABLE) from None
    for note in notes:
        typer.echo(f"{out}: {note}", err=True)


@export_app.command("otter")
def export_otter(
    assignment: Annotated[str, typer.Argument(metavar="ASSIGNMENT", help="What was handed out: YAML or JSON.")],
    out: Annotated[Path, typer.Option("--out", metavar="FOLDER", help="Where the test files go.")] = Path("tests"),
) -> None:
    """Write otter-grader's test files for an assignment, and assignment.json beside their folder."""
    from dofkit.homework import otter

    try:
        for path in otter.write_tests(assignment, out):
            typer.echo(path)
    except (DofkitError, OSError) as error:
        _fail(assignment, error)
        raise typer.Exit(UNREADABLE) from None


@catalog_app.callback()
def catalog(context: typer.Context, as_json: AsJson = False) -> None:
    """List the names of the catalog's scenes, one a line; with their titles on a terminal."""
    if context.invoked_subcommand is not None:
        return
    from dofkit.scene.catalog import catalog_names, catalog_titles

    if not as_json and not sys.stdout.isatty():
        typer.echo("\n".join(catalog_names()))
        return
    titles = catalog_titles()
    width = max(map(len, titles), default=0)
    for name, title in titles.items():
        if as_json:
            _line({"name": name, "title": title})
        else:
            typer.echo(f"{name:<{width}}  {title}")


@catalog_app.command("show")
def catalog_show(name: Annotated[str, typer.Argument(help="A scene's name.")]) -> None:
    """Print the YAML of a catalog scene."""
    from dofkit.scene.catalog import catalog_text

    try:
        typer.echo(catalog_text(name), nl=False)
    except SceneError as error:
        _complain(name, error.faults)
        raise typer.Exit(UNREADABLE) from None


@app.command()
def schema(
    of: Annotated[
        str, typer.Argument(metavar="[WHAT]", help="scene, assignment, submission, result, report or chart.")
    ] = "scene",
) -> None:
    """Print the JSON Schema of a scene, or of what is named."""
    if of == "scene":
        from dofkit.scene.scene import Scene

        typer.echo(json.dumps(Scene.model_json_schema(), indent=2))
        return
    from dofkit.benchmark.record import ChartRun
    from dofkit.homework.schemas import SCHEMAS

    known = {**SCHEMAS, "chart": ChartRun.model_json_schema}
    if of not in known:
        raise typer.BadParameter(f"'{of}' is none of scene, {', '.join(known)}", param_hint="WHAT")
    typer.echo(json.dumps(known[of](), indent=2))


def _complain(file: str, faults: Iterable[Fault]) -> None:
    from dofkit.interface.show.faults import complaint

    sys.stdout.flush()
    typer.echo(complaint(file, tuple(faults), None), err=True)


def _fail(file: str, error: DofkitError | OSError) -> None:
    """Tell why nothing was done."""
    faults = getattr(error, "faults", None) or (Fault(str(error)),)
    _complain(file, faults)


def _line(value: Any) -> None:
    utf8 = (sys.stdout.encoding or "").lower().replace("-", "") == "utf8"
    typer.echo(json.dumps(value, ensure_ascii=not utf8))


def main() -> None:
    """Run the command line; no exit is untidy."""
    for stream in (sys.stdout, sys.stderr):
        if hasattr(stream, "reconfigure"):
            stream.reconfigure(errors="backslashreplace")
    try:
        app()
    except KeyboardInterrupt:
        sys.exit(INTERRUPTED)
    except BrokenPipeError:
        os.dup2(os.open(os.devnull, os.O_WRONLY), sys.stdout.fileno())
        sys.exit(1)


if __name__ == "__main__":
    main()
