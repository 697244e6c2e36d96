"""The help of commands in groups: what most people need first, the rest under a heading of its own."""

from __future__ import annotations

from typing import Any

from typer.core import TyperCommand, TyperGroup

#: The headings of what stands after the commands and options that most people need.
MORE, ADVANCED = "More commands", "Advanced"


class PanelCommand(TyperCommand):
    """A command whose options stand under the heading that each names."""

    def format_options(self, ctx: Any, formatter: Any) -> None:
        """Write the arguments and the options, group by group."""
        groups: dict[str, list[tuple[str, str]]] = {"Arguments": [], "Options": []}
        for parameter in self.get_params(ctx):
            if parameter.param_type_name == "argument":
                groups["Arguments"].append((metavar_of(parameter), str(getattr(parameter, "help", None) or "")))
            elif (record := parameter.get_help_record(ctx)) is not None:
                groups.setdefault(getattr(parameter, "rich_help_panel", None) or "Options", []).append(record)
        _write(groups, formatter)

    def collect_usage_pieces(self, ctx: Any) -> list[str]:
        """Return the words of the usage line after the command."""
        return ["[OPTIONS]", *(metavar_of(p) for p in self.get_params(ctx) if p.param_type_name == "argument")]


class PanelGroup(TyperGroup):
    """A group of commands, each under the heading that it names."""

    def format_commands(self, ctx: Any, formatter: Any) -> None:
        """Write the commands with their summaries, group by group."""
        groups: dict[str, list[tuple[str, str]]] = {"Commands": []}
        for name in self.list_commands(ctx):
            command: Any = self.get_command(ctx, name)
            panel = getattr(command, "rich_help_panel", None) or "Commands"
            groups.setdefault(panel, []).append((name, command.get_short_help_str(formatter.width)))
        _write(groups, formatter)


def metavar_of(parameter: Any) -> str:
    """Return the name of an argument as the usage line shows it, such as ``FILE...``."""
    name = str(parameter.metavar or parameter.name.upper())
    return f"{name}..." if parameter.nargs == -1 and not name.endswith(("...", "]")) else name


def _write(groups: dict[str, list[tuple[str, str]]], formatter: Any) -> None:
    for heading, rows in groups.items():
        if rows:
            with formatter.section(heading):
                formatter.write_dl(rows)
