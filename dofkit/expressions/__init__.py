"""Exact expression trees, vectors of them, and the grammar in which people write and read them."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from dofkit.base.surface import handed_on

if TYPE_CHECKING:
    from dofkit.expressions.calculus import diff, substitute
    from dofkit.expressions.enclosures import interval_of
    from dofkit.expressions.text import parse_relations, to_text
    from dofkit.expressions.tree import (
        Expr,
        add,
        call,
        coordinate,
        differential,
        fn,
        mul,
        num,
        parameter,
        power,
        sqrt,
        sym,
        velocity,
    )

__all__ = [
    "Expr",
    "add",
    "call",
    "coordinate",
    "diff",
    "differential",
    "fn",
    "interval_of",
    "mul",
    "num",
    "parameter",
    "parse_relations",
    "power",
    "sqrt",
    "substitute",
    "sym",
    "to_text",
    "velocity",
]

#: Where the names live: a module is imported when a name of it is first asked for.
_HOMES = {
    "Expr": "dofkit.expressions.tree",
    "add": "dofkit.expressions.tree",
    "call": "dofkit.expressions.tree",
    "coordinate": "dofkit.expressions.tree",
    "diff": "dofkit.expressions.calculus",
    "differential": "dofkit.expressions.tree",
    "fn": "dofkit.expressions.tree",
    "interval_of": "dofkit.expressions.enclosures",
    "mul": "dofkit.expressions.tree",
    "num": "dofkit.expressions.tree",
    "parameter": "dofkit.expressions.tree",
    "parse_relations": "dofkit.expressions.text",
    "power": "dofkit.expressions.tree",
    "sqrt": "dofkit.expressions.tree",
    "substitute": "dofkit.expressions.calculus",
    "sym": "dofkit.expressions.tree",
    "to_text": "dofkit.expressions.text",
    "velocity": "dofkit.expressions.tree",
}


def __getattr__(name: str) -> Any:
    found = globals()[name] = handed_on(__name__, _HOMES, name)
    return found


def __dir__() -> list[str]:
    return sorted(__all__)
