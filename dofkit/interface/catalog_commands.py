"""The commands about the catalog: its names, those with a word, and the text of one scene."""

from __future__ import annotations

import sys
from collections.abc import Mapping
from typing import Annotated, Any

import typer

from dofkit.base.surface import handed_on
from dofkit.interface import options
from dofkit.interface.failures import failures_of, print_json
from dofkit.interface.searched import SearchedGroup

#: The catalog is looked at only where it is asked for.
_HOME = "dofkit.scene.catalog"


def _of(name: str) -> Any:
    """A function of the catalog."""
    return handed_on(__name__, {name: _HOME}, name)


catalog_app = typer.Typer(
    cls=SearchedGroup,
    help="List the scenes of the catalog, those with a WORD, or show one.",
    invoke_without_command=True,
    rich_markup_mode=None,
    subcommand_metavar="[WORD...] | COMMAND [ARGS]...",
)


@catalog_app.callback()
def catalog(context: typer.Context, as_json: options.AsJson = False) -> None:
    """List the names of the catalog's scenes, one a line; with their titles on a terminal, or of those with a WORD."""
    if context.invoked_subcommand is not None:
        return
    if as_json or sys.stdout.isatty():
        _titles(_of("catalog_titles")(), as_json)
    else:
        typer.echo("\n".join(_of("catalog_names")()))


@catalog_app.command("search")
def search(
    words: Annotated[list[str], typer.Argument(metavar="WORD...", help="All of them occur in name, title or text.")],
    as_json: options.AsJson = False,
) -> None:
    """List the scenes in which words occur; `dofkit catalog WORD` is the same."""
    with failures_of(" ".join(words)):
        _titles(_of("catalog_search")(words), as_json)


def _titles(titles: Mapping[str, str], as_json: bool) -> None:
    width = max(map(len, titles), default=0)
    for name, title in titles.items():
        if as_json:
            print_json({"name": name, "title": title})
        else:
            typer.echo(f"{name:<{width}}  {title}")


@catalog_app.command("show")
def show(name: Annotated[str, typer.Argument(help="A scene's name.", autocompletion=options.catalogued)]) -> None:
    """Print the YAML of a catalog scene."""
    with failures_of(name):
        typer.echo(_of("catalog_text")(name), nl=False)
