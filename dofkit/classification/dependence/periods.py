"""Relations that hold again after every period: cos(u) = 1 says u = 0, or 2 pi, or -2 pi, ...

What does not follow from one of these does not follow from the relation, which holds there too.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from fractions import Fraction

from dofkit.classification.dependence.implication import follows
from dofkit.expressions import tree as ex
from dofkit.expressions.calculus import replace_nodes
from dofkit.expressions.tree import PI, Expr
from dofkit.relations.normal.pieces import Finite, Normal
from dofkit.relations.setting import Setting

#: (function, its value) -> the first angle with this value, and the period, in units of pi.
_ANGLES: dict[tuple[str, int], tuple[Fraction, int]] = {
    ("cos", 1): (Fraction(0), 2), ("cos", -1): (Fraction(1), 2), ("cos", 0): (Fraction(1, 2), 1),
    ("sin", 0): (Fraction(0), 1), ("sin", 1): (Fraction(1, 2), 2), ("sin", -1): (Fraction(-1, 2), 2),
    ("tan", 0): (Fraction(0), 1),
}  # fmt: skip
#: The periods that are looked at.
_TURNS = (1, -1)
_VALUE = ex.parameter("value of a turning function")


def fails_on_part(what: Normal, others: Sequence[Normal], given: Sequence[Normal], setting: Setting) -> bool:
    """Does it not follow from a part of one of the relations given, such as u = 2 pi of cos(u) = 1?"""
    for i, normal in enumerate(given):
        for one in parts_of(normal):
            if follows(what, [*others, *given[:i], one, *given[i + 1 :]], setting) is False:
                return True
    return False


def parts_of(normal: Normal) -> Iterator[Normal]:
    """Relations that each say less than all of a periodic one: u = 2 pi and u = -2 pi for cos(u) = 1."""
    pieces = normal.pieces
    if len(pieces) != 1 or not isinstance(pieces[0], Finite):
        return
    found = _turning(pieces[0].expr)
    if found is None:
        return
    angle, start, period = found
    for turns in _TURNS:
        yield Normal(((Finite(angle - (start + period * turns) * PI),),))


def _turning(e: Expr) -> tuple[Expr, Fraction, int] | None:
    """The angle, where it begins and its period, where ``e`` is a multiple of cos(u) - 1 or the like."""
    nodes = [n for n in ex.nodes(e) if n.op == "fn" and n.args[0] in ("sin", "cos", "tan")]
    if len({*nodes}) != 1:
        return None
    linear = replace_nodes(e, {nodes[0]: _VALUE})
    if linear.symbols != {_VALUE}:
        return None
    for (name, value), (start, period) in _ANGLES.items():
        if nodes[0].args[0] == name and replace_nodes(linear, {_VALUE: ex.num(value)}).is_zero:
            return nodes[0].args[1], start, period
    return None
