"""Germs made by hand: relations on a few letters, and the manifold of the independent ones through a point."""

from __future__ import annotations

from collections.abc import Sequence

from dofkit.configuration.local.manifold import Manifold
from dofkit.exact.points.balls import BallPoint
from dofkit.exact.points.field import field_point
from dofkit.exact.points.frames import field_frame
from dofkit.exact.residues import residue
from dofkit.exact.ring.program import gradient, values
from dofkit.exact.ring.ring import Ring
from dofkit.expressions import tree as ex
from dofkit.expressions.text import Names, parse_expression
from dofkit.expressions.tree import Expr

LETTERS = "xyzuw"
SYMBOLS = [ex.coordinate(c) for c in LETTERS]
NAMES = Names(coordinates=frozenset(LETTERS))


def manifolds(relations: Sequence[Expr], at: dict[Expr, int]) -> list[Manifold]:
    """The independent relations through a point, over GF(p) and over balls."""
    ring = Ring(relations)
    nodes = [ring.node(g) for g in relations]
    columns = [-1 if (index := ring.var_index(s)) is None else index for s in at]
    point = field_point([ring], 5)
    for s, value in at.items():
        if (index := ring.var_index(s)) is not None:
            point.set(ring.vars[index], residue(value, point.p))
    placed = values(ring, point)
    assert all(placed[n] == 0 for n in nodes)
    zero = placed[0] * 0
    slopes = [gradient(ring, placed, point, [(n, zero + 1)]) for n in nodes]
    matrix = [[slope.get(c, zero) for c in columns] for slope in slopes]
    frame = field_frame(matrix, len(columns), point.p)
    ball = BallPoint({s: float(value) for s, value in at.items()}, 5)
    return [Manifold(ring, nodes, columns, frame, base) for base in (point, ball)]


def through(texts: Sequence[str], at: Sequence[int]) -> list[Manifold]:
    """The relations on the first letters, at the point with these coordinates."""
    relations = [parse_expression(text, NAMES) for text in texts]
    return manifolds(relations, dict(zip(SYMBOLS, at, strict=False)))


def on_plane(n: int, *functions: str) -> list[Manifold]:
    """The set {f = 0} in n of the letters, at 0: with the last letter, w = 0 and w + f = 0."""
    relations = [parse_expression(t, NAMES) for t in ("w", *(f"w + {f}" for f in functions))]
    return manifolds(relations, dict.fromkeys((*SYMBOLS[:n], SYMBOLS[-1]), 0))
