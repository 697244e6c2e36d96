"""Equations of a student's answer: read with the names of a scene, and added to its constraints."""

from __future__ import annotations

import re
from collections.abc import Iterator, Sequence
from dataclasses import dataclass

from dofkit.base.errors import TextError
from dofkit.expressions.text import Comparison, Names, UnknownNameError, parse_relations, to_text
from dofkit.expressions.tree import parameter
from dofkit.scene.constraints.base import Equation
from dofkit.scene.scene import Scene

#: Undeclared names that an answer may use as constants of integration.
_CONSTANT = re.compile(r"(?!d\b)[^\W\d_](?:_?\w{1,5})?|const|constant", re.UNICODE)
MAX_CONSTANTS = 4
#: Equations in one answer.
MAX_EQUATIONS = 40
_SEPARATED = re.compile(r"[;\n]")


@dataclass(frozen=True)
class Read:
    """An answer as it was understood: its ``texts``, one for each equation, and the ``constants`` that it introduces.

    ``text``: all equations in the grammar of scenes; ``moving``: whether velocities or differentials occur.
    """

    texts: tuple[str, ...]
    constants: frozenset[str]
    text: str
    moving: bool


def read_equations(answer: str | Sequence[str], names: Names, constants: bool) -> Read:
    """Return the equations of an answer; with ``constants``, undeclared names may be constants of integration.

    Raises TextError; its column is counted within the answer, or within the answer at fault if there are several.
    """
    texts = [t for text in ((answer,) if isinstance(answer, str) else answer) for t in _equations_in(text)]
    if not any(text.strip() for _, text in texts):
        raise TextError("there is no equation", 1, "write an equation such as x^2 + y^2 = l^2")
    if len(texts) > MAX_EQUATIONS:
        raise TextError(f"there are {len(texts)} equations", texts[MAX_EQUATIONS][0] + 1, "give fewer equations")
    constants_found: dict[str, None] = {}
    read = [(text, _read(text, before, names, constants_found, constants)) for before, text in texts if text.strip()]
    text_read = "; ".join(as_text(c) for _, relations in read for c in relations)
    symbols = {s for _, relations in read for c in relations for side in (c.left, c.right) for s in side.symbols}
    moving = any(s.args[0] not in ("coordinate", "parameter", "time") for s in symbols)
    return Read(tuple(text for text, _ in read), frozenset(constants_found), text_read, moving)


def _equations_in(text: str) -> Iterator[tuple[int, str]]:
    """Yield (number of characters before the equation, its text) for every equation in a text."""
    start = 0
    for cut in _SEPARATED.finditer(text):
        yield start, text[start : cut.start()]
        start = cut.end()
    yield start, text[start:]


def _read(
    text: str, before: int, names: Names, constants_found: dict[str, None], constants: bool
) -> tuple[Comparison, ...]:
    """Return the relations in ``text``; unknown names that may be constants are added to ``constants_found``."""
    while True:
        extended = Names(
            names.coordinates,
            {**names.parameters, **{name: parameter(name) for name in constants_found}},
            names.functions,
            names.arguments,
        )
        try:
            return parse_relations(text, extended if constants_found else names)
        except UnknownNameError as error:
            if not constants or len(constants_found) == MAX_CONSTANTS or not _may_be_constant(error.name, names):
                raise _shifted(error, before) from None
            constants_found[error.name] = None
        except TextError as error:
            raise _shifted(error, before) from None


def _may_be_constant(name: str, names: Names) -> bool:
    """Return whether ``name`` is short and not an index of a declared name, as ``x_A`` is if x is declared."""
    stem, _, index = name.partition("_")
    declared = stem in names.coordinates or stem in names.parameters
    return bool(_CONSTANT.fullmatch(name)) and not (declared and index and not index.isdigit())


def _shifted(error: TextError, before: int) -> TextError:
    column = None if error.column is None else error.column + before
    return TextError(error.message, column, error.hint)


def as_text(c: Comparison) -> str:
    """Return the relation ``c`` in the grammar of scenes."""
    return f"{to_text(c.left)} {c.relation} {to_text(c.right)}"


def with_equations(scene: Scene, read: Read, called: str) -> Scene:
    """Return the scene with the equations of ``read`` added to its constraints, named ``called`` 1, 2, ...

    New constants become parameters; what the scene expects is left out, because it is about the scene as it was.
    """
    more = tuple(Equation(name=f"{called} {i + 1}", text=text) for i, text in enumerate(read.texts))
    parameters = {**scene.parameters, **dict.fromkeys(read.constants, "real")}
    changes = {"constraints": (*scene.constraints, *more), "parameters": parameters, "expect": {}}
    return scene.model_copy(update=changes)
