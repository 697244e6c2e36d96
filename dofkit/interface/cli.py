"""The commands. Each processes its files one by one in a worker, and a failing file does not stop the next."""

from __future__ import annotations

import json
import math
import sys
from collections.abc import Generator, Mapping
from contextlib import closing
from dataclasses import replace
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, cast

import typer

from dofkit.base import __version__
from dofkit.base.deadline import DEFAULT_SECONDS
from dofkit.base.errors import ArgumentError
from dofkit.base.wording import format_of_path, is_folder_path
from dofkit.interface import options
from dofkit.interface.assignment_commands import assignment_app, export_app
from dofkit.interface.output import FAILURES, INTERRUPTED, UNREADABLE, Output, failures_of, print_json

if TYPE_CHECKING:
    from dofkit.interface.jobs import Printed
    from dofkit.methods.table import MethodName

#: The heading in the help above all commands but the five that most people need.
MORE = "More commands"
#: Reports of more scenes than this are printed as one line each, unless full reports are requested.
MOST_IN_FULL = 3

app = typer.Typer(
    name="dofkit",
    help="Determine how a mechanical system can move: its degrees of freedom, constraint labels and redundancy.",
    no_args_is_help=True,
    pretty_exceptions_enable=False,
    rich_markup_mode="rich",
    context_settings={"help_option_names": ["-h", "--help"]},
)
app.add_typer(assignment_app, name="assignment", rich_help_panel=MORE)
app.add_typer(export_app, name="export", rich_help_panel=MORE)


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
    budget: options.Budget = DEFAULT_SECONDS,
    method: options.Method = "auto",
    certificate: options.CertificatePath = None,
    strict: options.OnlyWithEvidence = False,
    limits: options.Limits = False,
    workers: options.SceneWorkers = None,
    scheduler: options.Scheduler = None,
    out: options.ReportFolder = None,
) -> None:
    """Report degrees of freedom, constraint labels and redundancy.

    Every answer carries a verdict: proved, probable, numeric or undecided.
    """
    from dofkit.interface.classification import classify_files, longest_name
    from dofkit.interface.jobs import Request, Run

    if math.isnan(budget):
        raise typer.BadParameter("the budget is a number of seconds", param_hint="--budget")
    if out is not None and (full or how or brief):
        raise typer.BadParameter("it cannot be combined with --brief, --full or --how", param_hint="--out")
    output = Output.here(as_json, brief or (len(files) > MOST_IN_FULL and not (full or how)), how)
    output = output._replace(only=options.fields(only), name_width=longest_name(files))
    request = Request("", output, budget, cast("MethodName", method), options.listed(without), limits)
    request = replace(request, certificate=certificate, strict=strict)
    run = Run(options.names_among(options.listed(fail_on), FAILURES, "failure", "--fail-on"), workers, scheduler, out)
    with failures_of("classify"):
        status = classify_files(files, request, run)
    raise typer.Exit(status)


@app.command()
def draw(
    files: options.Files,
    drawn_as: options.DrawnAs = "mechanism",
    out: options.PicturePath = None,
    form: options.StillKind = None,
) -> None:
    """Draw the mechanism, its constraint graph or its directions."""
    _pictures(files, drawn_as, out, form, options.STILL_KINDS)


@app.command()
def animate(
    files: options.Files,
    out: options.PicturePath = None,
    form: options.MovingKind = None,
    loop: options.Loop = False,
) -> None:
    """Animate the motion: a page with a slider, a GIF or an MP4."""
    _pictures(files, "loop" if loop else "motion", out, form, options.MOVING_KINDS)


@app.command()
def lagrange(
    files: options.Files,
    as_json: options.AsJson = False,
    linearize: options.Linearize = False,
    certificate: options.CertificatePath = None,
) -> None:
    """Derive the equations of motion from the energies."""
    from dofkit.interface.jobs import Request, replies

    request = Request("", Output.here(as_json), linearize=linearize, certificate=certificate)
    _print(replies("motion_lines", files, request), as_json)


@app.command()
def grade(
    assignment: options.Assignment,
    submissions: options.Submissions,
    form: options.ResultFormat = "native",
    out: options.ResultPath = None,
    workers: options.Workers = None,
    scheduler: options.Scheduler = None,
    check_only: options.CheckOnly = False,
    reviewed: options.ReviewTable = None,
    roster: options.RosterPath = None,
) -> None:
    """Grade the submissions of an assignment, with feedback."""
    from dofkit.homework.runs.run import GradingOptions, run

    chosen = GradingOptions(form, out, workers, scheduler, check_only, reviewed, roster)
    with failures_of(assignment):
        clean = run(assignment, submissions, chosen)
    if not clean:
        raise typer.Exit(UNREADABLE)


@app.command(rich_help_panel=MORE)
def new(file: options.NewPath = None) -> None:
    """Write a first scene to edit, with the schema for editors."""
    from dofkit.interface.named_files import write_new

    with failures_of("new"):
        typer.echo(write_new(file), nl=False)


@app.command(rich_help_panel=MORE)
def convert(file: options.ModelPath, out: options.ScenePath = None, limits: options.Limits = False) -> None:
    """Convert an MJCF, URDF or SolveSpace model to a scene."""
    from dofkit.interface.named_files import write_converted

    with failures_of(file):
        typer.echo(write_converted(file, out, limits), nl=False)


@app.command(rich_help_panel=MORE)
def explain(words: options.Word = None, as_json: options.AsJson = False) -> None:
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


@app.command(rich_help_panel=MORE)
def catalog(words: options.CatalogWords = None, as_json: options.AsJson = False) -> None:
    """List the catalog's scenes, search them, or show one.

    `catalog` lists the names, `catalog WORD...` the scenes in which all the
    words occur, and `catalog show NAME` prints the YAML of a scene.
    """
    from dofkit.scene.catalog import catalog_names, catalog_search, catalog_text, catalog_titles

    with failures_of(" ".join(words or ())):
        if words and words[0] == "show" and len(words) == 2:
            typer.echo(catalog_text(words[1]), nl=False)
        elif words:
            _titles(catalog_search(words), as_json)
        elif as_json or sys.stdout.isatty():
            _titles(catalog_titles(), as_json)
        else:
            typer.echo("\n".join(catalog_names()))


def _titles(titles: Mapping[str, str], as_json: bool) -> None:
    width = max(map(len, titles), default=0)
    for name, title in titles.items():
        if as_json:
            print_json({"name": name, "title": title})
        else:
            typer.echo(f"{name:<{width}}  {title}")


@app.command(rich_help_panel=MORE)
def verify(files: options.CertificateFiles, strict: options.Strict = False, as_json: options.AsJson = False) -> None:
    """Check a certificate with the independent checker."""
    from dofkit.interface.classification import echo
    from dofkit.interface.jobs import Request, replies

    if len(files) > 2:
        raise typer.BadParameter("a scene and its certificate, or a certificate alone", param_hint="[SCENE] CERT")
    request = Request(files[0], Output.here(as_json), certificate=files[-1], strict=strict)
    [printed] = replies("verification_lines", files[:1], request)
    echo(printed)
    raise typer.Exit(UNREADABLE if printed.outcome is None else printed.outcome["status"])


@app.command(rich_help_panel=MORE)
def schema(of: options.SchemaName = "scene") -> None:
    """Print the JSON Schema of scenes, assignments or reports."""
    if of == "scene":
        from dofkit.scene.schema import scene_schema

        typer.echo(json.dumps(scene_schema(), indent=2))
        return
    from dofkit.homework.schemas import SCHEMAS

    if of in SCHEMAS:
        typer.echo(json.dumps(SCHEMAS[of](), indent=2))
    else:
        raise typer.BadParameter(f"'{of}' is none of scene, {', '.join(SCHEMAS)}", param_hint="WHAT")


@app.command(rich_help_panel=MORE)
def chart(
    question: options.Questions = None,
    families: options.Families = None,
    methods: options.Methods = None,
    out: options.ChartFolder = Path("dofkit-chart"),
    source: options.ChartSource = None,
    quick: options.Quick = False,
    workers: options.Workers = None,
    timeout: options.Timeout = None,
) -> None:
    """Compare methods by speed and accuracy on known scenes."""
    from dofkit.benchmark.command import chart
    from dofkit.benchmark.tasks import ChartOptions

    with failures_of("chart"):
        whole = chart(ChartOptions(out, question or (), families or (), methods or (), quick, source, workers, timeout))
    if not whole:
        raise typer.Exit(INTERRUPTED)


def _pictures(files: list[str], kind: str, out: Path | None, form: str | None, kinds: tuple[str, ...]) -> None:
    """Write the picture of each file: to ``out`` if it is a file, else into this folder (None: the current one)."""
    from dofkit.interface.jobs import Request, distinct_names, replies

    paths = [str(out)]
    if out is None or is_folder_path(out):
        suffix = f"-{kind}" if kind in ("graph", "directions", "loop") else ""
        paths = [str((out or Path()) / f"{name}{suffix}.{form or kinds[0]}") for name in distinct_names(files)]
    else:
        with failures_of("--out"):
            format_of_path(out, kinds, form)
            if len(files) > 1:
                raise ArgumentError(f"'{out}' is one file, and {len(files)} scenes are drawn: name a folder")
    request = Request("", Output.here(), pictures=tuple((kind, path) for path in paths))
    _print(replies("picture_lines", files, request))


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
