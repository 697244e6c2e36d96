"""The command ``dofkit catalog``: the names of the catalog's scenes, those with a word, and the text of one."""

from __future__ import annotations

import sys
from collections.abc import Mapping
from typing import Annotated

import typer

from dofkit.interface import options
from dofkit.interface.failures import failures_of, print_json


def catalog(
    words: Annotated[
        list[str] | None,
        typer.Argument(
            metavar="[WORD...]",
            show_default=False,
            help="Words that occur in a scene; or `show` and the name of a scene.",
            autocompletion=options.catalogued,
        ),
    ] = None,
    as_json: options.AsJson = False,
) -> None:
    """List the catalog's scenes, search them, or show one.

    `dofkit catalog` lists the names, with their titles on a terminal. `dofkit catalog WORD...` lists the scenes in
    which all the words occur. `dofkit catalog show NAME` prints the YAML of a scene.
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
