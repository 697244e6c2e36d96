"""What `print` and a notebook show of a value. How that is drawn is known on the top floor: see `dofkit.DRAWN_BY`."""

from __future__ import annotations

import sys
from importlib import import_module
from typing import Any, ClassVar, Self


def _drawn(name: str, *given: Any) -> Any:
    """A function of the module that draws, which `dofkit.DRAWN_BY` names; it is imported when something is first drawn.

    It has ``text_of(value, width, how)``, lines for a terminal; ``html_of(value)``, a piece of a page;
    ``latex_of(value)``, a display of what has formulas, or None; and ``panel_of(error)``, the lines of an error.
    """
    return getattr(import_module(sys.modules["dofkit"].DRAWN_BY), name)(*given)


def text_of(value: object, width: int | None = None, how: bool = False) -> str:
    """What the command line prints of a value, for ``width`` columns (None: those of the terminal, or 80).

    ``how``: of a report also how sure each answer is and by which argument.
    """
    return str(_drawn("text_of", value, width, how))


def panel_of(error: BaseException) -> list[str]:
    """Return the lines that a notebook shows of an error: one panel, without the frames inside dofkit."""
    lines: list[str] = _drawn("panel_of", error)
    return lines


#: Methods of Pydantic's models that a notebook offers beside the fields.
_OF_USE = frozenset({"model_copy", "model_dump", "model_dump_json", "model_validate", "model_validate_json"})


class Displayed:
    """The base of what is drawn: by `print` as at a terminal, by a notebook as a table."""

    __slots__ = ()
    #: The fields that ``repr`` shows.
    _in_brief: ClassVar[tuple[str, ...]] = ()

    def __str__(self) -> str:
        return text_of(self)

    def __repr__(self) -> str:
        shown = ", ".join(f"{name}={getattr(self, name)!r}" for name in self._in_brief)
        return f"{type(self).__name__}({shown})"

    def __dir__(self) -> list[str]:
        """What a reader asks for: of Pydantic's own methods only those that are of use here."""
        inner = {name for cls in type(self).__mro__ if cls.__module__.startswith("pydantic.") for name in vars(cls)}
        return sorted(n for n in super().__dir__() if n.startswith("_") or n in _OF_USE or n not in inner)

    def _repr_html_(self) -> str:
        return str(_drawn("html_of", self))

    def _repr_pretty_(self, printer: Any, cycle: bool) -> None:
        """What IPython shows where it has no page."""
        printer.text(repr(self) if cycle else str(self))


class DisplayedFormulas(Displayed):
    """What also has formulas to show by themselves."""

    __slots__ = ()

    def _repr_latex_(self) -> str | None:
        found = _drawn("latex_of", self)
        return None if found is None else str(found)


class Companion:
    """What goes along with a value and is no part of it: equal to every other, and empty in another process.

    ``scene``: what a report is about, for its title and picture.
    """

    def __init__(self, scene: object = None) -> None:
        self.scene = scene

    def __eq__(self, other: object) -> bool:
        return isinstance(other, Companion)

    def __hash__(self) -> int:
        return 0

    def __reduce__(self) -> tuple[type[Self], tuple[()]]:
        return type(self), ()
