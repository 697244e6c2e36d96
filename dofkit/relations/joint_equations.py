"""The equations of a joint as pieces that are written out only where somebody looks at them."""

from __future__ import annotations

from dofkit.expressions.renaming import Unwritten
from dofkit.expressions.tree import Expr
from dofkit.relations.normal.pieces import Finite, Normal
from dofkit.system import Relation


class JointEquation(Finite):
    """g(q) = 0: equation ``number`` of the ``joint``, whose ``expr`` is written out when it is asked for."""

    def __init__(self, joint: Unwritten[Relation], number: int) -> None:
        object.__setattr__(self, "joint", joint)
        object.__setattr__(self, "number", number)

    joint: Unwritten[Relation]
    number: int

    def __getattr__(self, name: str) -> Expr:
        if name != "expr":
            raise AttributeError(name)
        written = self.joint[self.number].expr
        object.__setattr__(self, "expr", written)
        return written


def unwritten(joint: Unwritten[Relation]) -> tuple[Normal, ...]:
    """The equations of a joint as they stand: each says one thing over the reals."""
    return tuple(Normal(((JointEquation(joint, k),),)) for k in range(len(joint)))
