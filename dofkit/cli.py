"""The command line: every command reads files, tells what it found of each, and never lets one stop the others."""

from __future__ import annotations

import json
import os
import sys
from collections.abc import Iterable
from typing import TYPE_CHECKING, Annotated, Any, cast

import typer

from dofkit import __version__
from dofkit.errors import DofkitError, Fault, SceneError, TextError
from dofkit.methods import METHODS, MethodName

if TYPE_CHECKING:
    from dofkit.documents import Document
    from dofkit.report import Report

app = typer.Typer(
    name="dofkit",
    help="Tells how a mechanical system can move: degrees of freedom, labels of its constraints, what is redundant.",
    add_completion=False,
    no_args_is_help=True,
    pretty_exceptions_enable=False,
    rich_markup_mode=None,
)
catalog_app = typer.Typer(
    help="List the scenes of the catalog, or show one.", invoke_without_command=True, rich_markup_mode=None
)
app.add_typer(catalog_app, name="catalog")

#: The exit status where something could not be read, and after Ctrl-C.
UNREADABLE, INTERRUPTED = 2, 130
_STDIN = "stdin"

Files = Annotated[list[str], typer.Argument(metavar="FILE...", help="Scenes: paths, catalog names, - for stdin.")]
AsJson = Annotated[bool, typer.Option("--json", help="One JSON object a line, in the order given.")]
Budget = Annotated[
    float | None, typer.Option("--budget", metavar="SECONDS", min=0, help="Begin no new part of a scene after this.")
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
    failed = False
    for file in files:
        told = _Told(file)
        report = told.classified(budget, cast(MethodName, method))
        if report is None:
            failed = True
            _print_errors(told, as_json)
        elif as_json:
            _line(report.model_dump(mode="json"))
        else:
            _print_report(report, told.title)
        sys.stdout.flush()
    if failed:
        raise typer.Exit(UNREADABLE)


@catalog_app.callback()
def catalog(context: typer.Context, as_json: AsJson = False) -> None:
    """List the names of the catalog's scenes, one a line; with their titles on a terminal."""
    if context.invoked_subcommand is not None:
        return
    from dofkit.catalog import catalog_names, catalog_titles

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
    from dofkit.catalog import catalog_text

    try:
        typer.echo(catalog_text(name), nl=False)
    except SceneError as error:
        _complain(name, error.faults, None)
        raise typer.Exit(UNREADABLE) from None


@app.command()
def schema() -> None:
    """Print the JSON Schema of a scene."""
    from dofkit.scene import Scene

    typer.echo(json.dumps(Scene.model_json_schema(), indent=2))


class _Told:
    """One file on its way to a report, and what went wrong with it."""

    def __init__(self, file: str) -> None:
        self.file = file
        stem = os.path.splitext(os.path.basename(os.path.normpath(file)))[0]
        self.name = _STDIN if file == "-" else stem.encode("utf-8", "replace").decode("utf-8")
        self.title: str | None = None
        self.document: Document | None = None
        self.faults: tuple[Fault, ...] = ()

    def classified(self, budget: float | None, method: MethodName) -> Report | None:
        """The report, or None with ``faults``."""
        try:
            return self._classified(budget, method)
        except SceneError as error:
            self.faults = error.faults
        except TextError as error:
            self.faults = (Fault(error.message, hint=error.hint),)
        except DofkitError as error:
            self.faults = (Fault(str(error)),)
        except Exception as error:
            self.faults = (internal(error),)
        return None

    def _classified(self, budget: float | None, method: MethodName) -> Report:
        from dofkit.classify import classify
        from dofkit.reading import SceneFile, find

        if self.file == "-":
            file = SceneFile.read(_stdin(), _STDIN)
        else:
            self.name, data = find(self.file)
            file = SceneFile.read(data, self.name)
        self.document = file.document
        scene = file.scene(checked=False)
        self.title = scene.title
        try:
            return classify(scene, budget=budget, method=method)
        except SceneError as error:
            raise file.located(error) from None


def internal(error: Exception) -> Fault:
    """A fault of dofkit's own, told in one line."""
    said = " ".join(str(error).split())[:200]
    message = f"internal error, {type(error).__name__}" + (f": {said}" if said else "")
    return Fault(message, hint="this is a fault of dofkit, please report it with this scene")


def _stdin() -> bytes:
    from dofkit.documents.document import MOST_BYTES

    return sys.stdin.buffer.read(MOST_BYTES + 1)


def _print_report(report: Report, title: str | None) -> None:
    from rich.console import Console

    from dofkit.show.terminal import as_text

    typer.echo(as_text(report, title, Console()) + "\n")


def _print_errors(told: _Told, as_json: bool) -> None:
    if as_json:
        _line({"scene": told.name, "error": error_object(told.faults)})
    else:
        _complain(told.file if told.file != "-" else _STDIN, told.faults, told.document)


def error_object(faults: Iterable[Fault]) -> dict[str, Any]:
    """The first fault, with all further ones under ``faults``."""
    first, *others = [
        {"message": fault.message, "line": fault.line, "column": fault.column, "hint": fault.hint} for fault in faults
    ] or [{"message": "unknown error", "line": None, "column": None, "hint": None}]
    return {**first, "faults": others}


def _complain(file: str, faults: Iterable[Fault], document: Document | None) -> None:
    from dofkit.show.faults import complaint

    sys.stdout.flush()
    typer.echo(complaint(file, tuple(faults), document), err=True)


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
