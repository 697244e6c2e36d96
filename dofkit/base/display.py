"""What `print` and a notebook show of a value, and the colour scheme of a piece of a page.

The module that draws is named by `dofkit.DRAWN_BY`, because it imports what is drawn.
"""

from __future__ import annotations

import sys
from importlib import import_module
from typing import Any, ClassVar


def _drawn(name: str, *arguments: Any) -> Any:
    """Return what a function of the module that draws returns; it is imported when something is first drawn.

    It has ``text_of(value, width, how)``, lines for a terminal; ``html_of(value)``, a piece of a page;
    ``latex_of(value)``, a display of what has formulas, or None; and ``panel_of(error)``, the lines of an error.
    """
    return getattr(import_module(sys.modules["dofkit"].DRAWN_BY), name)(*arguments)


def text_of(value: object, width: int | None = None, how: bool = False) -> str:
    """Return what the command line prints of a value, for ``width`` columns (None: those of the terminal, or 80).

    ``how``: of a report also how certain each answer is and by which argument.
    """
    return str(_drawn("text_of", value, width, how))


def panel_of(error: BaseException) -> list[str]:
    """Return the lines that a notebook shows of an error: one panel, without the frames inside dofkit."""
    lines: list[str] = _drawn("panel_of", error)
    return lines


#: The scheme of a page as JupyterLab, VS Code, Sphinx and others mark it; else that of the reader's system holds.
_SCHEMES = {
    "dark": ("[data-jp-theme-light=false]", ".vscode-dark", "[data-theme=dark]", ".theme-dark"),
    "light": ("[data-jp-theme-light=true]", ".vscode-light", "[data-theme=light]", ".theme-light"),
}


def schemes(piece: str) -> str:
    """Return the style that puts a ``piece`` in the light or dark scheme of the page around it.

    >>> schemes(".a")[:30]
    '.a{color-scheme:light dark}[da'
    """
    rules = [f"{piece}{{color-scheme:light dark}}"]
    for scheme, pages in _SCHEMES.items():
        rules.append(f"{','.join(f'{page} {piece}' for page in pages)}{{color-scheme:{scheme}}}")
    return "".join(rules)


#: Methods of Pydantic's models that a notebook offers beside the fields.
_OF_USE = frozenset({"model_copy", "model_dump", "model_dump_json", "model_validate", "model_validate_json"})


class Displayed:
    """The base of values that `print` shows as at a terminal, and a notebook as a table."""

    __slots__ = ()
    #: The fields that ``repr`` shows.
    _in_brief: ClassVar[tuple[str, ...]] = ()

    def __str__(self) -> str:
        return text_of(self)

    def __repr__(self) -> str:
        fields = ", ".join(f"{name}={getattr(self, name)!r}" for name in self._in_brief)
        return f"{type(self).__name__}({fields})"

    def __dir__(self) -> list[str]:
        """Return the names for completion: of Pydantic's own methods only those that are of use here."""
        inner = {name for cls in type(self).__mro__ if cls.__module__.startswith("pydantic.") for name in vars(cls)}
        return sorted(n for n in super().__dir__() if n.startswith("_") or n in _OF_USE or n not in inner)

    def _repr_html_(self) -> str:
        return str(_drawn("html_of", self))

    def _repr_pretty_(self, printer: Any, cycle: bool) -> None:
        """Print what IPython shows where it has no page."""
        printer.text(repr(self) if cycle else str(self))


class DisplayedFormulas(Displayed):
    """The base of values that also have formulas to show by themselves."""

    __slots__ = ()

    def _repr_latex_(self) -> str | None:
        latex = _drawn("latex_of", self)
        return None if latex is None else str(latex)
