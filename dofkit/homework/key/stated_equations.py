"""The equations of a constraint, as an example of a right answer."""

from __future__ import annotations

import re

from dofkit.expressions.text import to_text
from dofkit.expressions.tree import Expr
from dofkit.homework.key.key import Key
from dofkit.scene.lowering import lower

#: A length that nobody named, as a scene's own equations call its square.
_UNNAMED = re.compile(r"\b_[A-Z]\d+\b")


def equations_of(key: Key, names: tuple[str, ...]) -> str:
    """The equations of these constraints, with semicolons between them; of one as it is written where it is a text.

    Where they hold names that an answer cannot have, such as the turns of a body in space, their words stand instead.
    """
    return "; ".join(_equations(key, name) for name in names)


def _equations(key: Key, name: str) -> str:
    entry = key.constraints[name]
    (constraint,) = (c for c in lower(key.scene).constraints if c.name == name)
    if constraint.facts.written or not all(_sayable(key, relation.expr) for relation in constraint.relations):
        return entry.text
    texts = [f"{to_text(relation.expr)} {relation.sense} 0" for relation in constraint.relations]
    return "; ".join(_UNNAMED.sub("const", text) for text in texts)


def _sayable(key: Key, expr: Expr) -> bool:
    """Are all names in it declared, lengths without a name apart?"""
    known = {*key.names.coordinates, *key.names.parameters}
    return all(
        s.args[0] == "time" or str(s.args[-1]) in known or _UNNAMED.fullmatch(str(s.args[-1])) for s in expr.symbols
    )
