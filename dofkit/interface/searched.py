"""A group of commands in which any other word is searched for."""

from __future__ import annotations

from typing import Any

from typer.core import TyperGroup


class SearchedGroup(TyperGroup):
    """``dofkit catalog WORD``: what names no command is given to `search`."""

    def resolve_command(self, ctx: Any, args: list[str]) -> tuple[str | None, Any, list[str]]:
        """The command, and its arguments."""
        if args and args[0] not in self.commands and not args[0].startswith("-"):
            args = ["search", *args]
        name, command, rest = super().resolve_command(ctx, args)
        return name, command, rest
