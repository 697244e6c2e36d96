"""The page of commands, generated from their help."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any

import typer.main

from dofkit.interface.cli import app
from dofkit.site.markdown import SitePage, code, page, prose, table


def command_pages() -> Iterator[SitePage]:
    """One page with every command, its arguments and its options."""
    parts = [part for path, command in commands() for part in _told(path, command)]
    lead = "Every command has the option `--help`. The [guide](../guide/commands.md) shows examples."
    yield SitePage("reference/commands.md", page("Commands", lead, *parts))


def commands() -> Iterator[tuple[str, Any]]:
    """Every command by its words, groups of commands after what they hold."""
    yield from _below("dofkit", typer.main.get_command(app))


def _below(path: str, command: Any) -> Iterator[tuple[str, Any]]:
    for name, inner in getattr(command, "commands", {}).items():
        if getattr(inner, "commands", None) is None or inner.invoke_without_command:
            yield f"{path} {name}", inner
        yield from _below(f"{path} {name}", inner)


def _told(path: str, command: Any) -> Iterator[str]:
    arguments = [p for p in command.params if p.param_type_name == "argument"]
    choices = [p for p in command.params if p.param_type_name == "option"]
    usage = " ".join([path, *(metavar_of(p) for p in arguments), *(["[OPTIONS]"] if choices else [])])
    yield f"## {path}"
    yield prose(command.help or "")
    yield f"`{usage}`"
    rows = [(code(metavar_of(p)), prose(p.help or "")) for p in arguments]
    rows += [(_option(p), prose(p.help or "") + _default(p)) for p in choices]
    if rows:
        yield table(("argument or option", "meaning"), rows)


def _option(parameter: Any) -> str:
    words = ", ".join((*parameter.opts, *parameter.secondary_opts))
    flag = parameter.is_flag or parameter.count
    return code(words if flag else f"{words} {parameter.metavar or parameter.name.upper()}")


def _default(parameter: Any) -> str:
    default = parameter.default
    return "" if default in (None, False, (), []) or callable(default) else f" Default: {code(str(default))}."


def metavar_of(parameter: Any) -> str:
    """Return the name of an argument as a usage line shows it, such as ``FILE...``."""
    name = str(parameter.metavar or parameter.name.upper())
    return f"{name}..." if parameter.nargs == -1 and not name.endswith(("...", "]")) else name
