"""The display of values by `print` and in notebooks, and the colour scheme of HTML in a page.

The module that renders values is named by `dofkit.DRAWN_BY`, because it imports the types of the values.
"""

from __future__ import annotations

import sys
from importlib import import_module
from typing import Any, ClassVar


def _rendered(name: str, *arguments: Any) -> Any:
    """Return the result of the function ``name`` of the rendering module, which is imported at the first call.

    The functions are ``text_of(value, width, how)``, lines for a terminal; ``html_of(value)``; ``latex_of(value)``, the
    formulas of a value or None; ``panel_of(error)``, the lines of an error.
    """
    return getattr(import_module(sys.modules["dofkit"].DRAWN_BY), name)(*arguments)


def text_of(value: object, width: int | None = None, how: bool = False) -> str:
    """Return a value as the command line prints it, in ``width`` columns (None: those of the terminal, or 80).

    ``how``: whether a report also shows how certain each answer is, and by which argument.
    """
    return str(_rendered("text_of", value, width, how))


def panel_of(error: BaseException) -> list[str]:
    """Return the lines that a notebook shows for an error: one panel, without the traceback inside dofkit."""
    lines: list[str] = _rendered("panel_of", error)
    return lines


#: CSS selectors by which JupyterLab, VS Code, Sphinx and others mark a page's scheme; else the system's scheme is used.
_SCHEMES = {
    "dark": ("[data-jp-theme-light=false]", ".vscode-dark", "[data-theme=dark]", ".theme-dark"),
    "light": ("[data-jp-theme-light=true]", ".vscode-light", "[data-theme=light]", ".theme-light"),
}


def schemes(selector: str) -> str:
    """Return the CSS that gives the elements of ``selector`` the light or dark scheme of the page around them.

    >>> schemes(".a")[:30]
    '.a{color-scheme:light dark}[da'
    """
    rules = [f"{selector}{{color-scheme:light dark}}"]
    for scheme, pages in _SCHEMES.items():
        rules.append(f"{','.join(f'{page} {selector}' for page in pages)}{{color-scheme:{scheme}}}")
    return "".join(rules)


#: Methods of Pydantic's models that a notebook completes, in addition to the fields.
_OF_USE = frozenset({"model_copy", "model_dump", "model_dump_json", "model_validate", "model_validate_json"})


class Displayed:
    """The base class of values that `print` shows as the command line does, and a notebook as a table."""

    __slots__ = ()
    #: The fields that ``repr`` shows.
    _in_brief: ClassVar[tuple[str, ...]] = ()

    def __str__(self) -> str:
        return text_of(self)

    def __repr__(self) -> str:
        fields = ", ".join(f"{name}={getattr(self, name)!r}" for name in self._in_brief)
        return f"{type(self).__name__}({fields})"

    def __dir__(self) -> list[str]:
        """Return the names for completion, without most of Pydantic's own methods."""
        inner = {name for cls in type(self).__mro__ if cls.__module__.startswith("pydantic.") for name in vars(cls)}
        return sorted(n for n in super().__dir__() if n.startswith("_") or n in _OF_USE or n not in inner)

    def _repr_html_(self) -> str:
        return str(_rendered("html_of", self))

    def _repr_pretty_(self, printer: Any, cycle: bool) -> None:
        """Print the value for IPython in a terminal."""
        printer.text(repr(self) if cycle else str(self))


class DisplayedFormulas(Displayed):
    """The base class of values whose formulas a notebook can show in LaTeX."""

    __slots__ = ()

    def _repr_latex_(self) -> str | None:
        latex = _rendered("latex_of", self)
        return None if latex is None else str(latex)
