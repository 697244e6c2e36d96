"""Pages from their templates: whatever a student wrote is escaped."""

from __future__ import annotations

import re
from functools import cache
from pathlib import Path
from typing import TYPE_CHECKING, Any

from dofkit.homework.formats.html.pages import BADGES
from dofkit.homework.formats.wording import line, number, plain, stop_of

if TYPE_CHECKING:
    from jinja2 import Environment

TEMPLATES = Path(__file__).parent / "templates"
_NAME = re.compile("`([^`\n]+)`")


def rendered(template: str, **values: Any) -> str:
    """A page."""
    return _environment().get_template(template).render(**values)


@cache
def _environment() -> Environment:
    from jinja2 import Environment, FileSystemLoader, StrictUndefined

    environment = Environment(
        loader=FileSystemLoader(TEMPLATES),
        autoescape=True,
        undefined=StrictUndefined,
        trim_blocks=True,
        lstrip_blocks=True,
    )
    environment.filters.update(plain=plain, line=line, number=number, stop=stop_of, pieces=_pieces)
    environment.globals["badges"] = BADGES
    return environment


def _pieces(text: str) -> list[str]:
    """A text cut at the names between backquotes: what is around them and, at every second place, a name."""
    return _NAME.split(plain(text))
