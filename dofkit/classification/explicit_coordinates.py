"""Relations that give a coordinate as a function of the others: of the first degree in it, or of the second."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from dataclasses import dataclass

from dofkit.expressions import tree as ex
from dofkit.expressions.renaming import shape_of
from dofkit.expressions.tree import Expr

#: Relations and coordinates up to so many are looked at.
MOST = 120
#: How a coordinate occurs: once, times a number; in the first degree; in the second; in no such way.
PLAIN, LINEAR, QUADRATIC, OTHER = 0, 1, 2, 9


def explicit(relations: Sequence[Expr], names: Sequence[str], count: int, most: int = LINEAR) -> list[str] | None:
    """The coordinates that are left when ``count`` of the relations are solved for one each, one after another.

    None where that does not go on until the end. What is solved most plainly goes first, then the last of ``names``;
    ``most``: how a coordinate may occur that is solved for, only once in the second degree.
    """
    if len(relations) > MOST or len(names) > MOST:
        return None
    left = _readings(relations)
    solved: set[str] = set()
    while len(solved) < count:
        open_ = [n for n in reversed(names) if n not in solved]
        found = min(((r.of[n], k, i) for i, r in enumerate(left) for k, n in enumerate(open_) if n in r.of),
                    default=(OTHER, 0, 0))  # fmt: skip
        if found[0] > most:
            return None
        most = LINEAR if found[0] == QUADRATIC else most
        relation = left.pop(found[2])
        solved.add(open_[found[1]])
        left = [r.without(open_[found[1]], relation) for r in left]
    return [n for n in names if n not in solved]


@dataclass(frozen=True)
class _Reading:
    """How each coordinate of a relation occurs in it."""

    of: dict[str, int]

    def without(self, name: str, by: _Reading) -> _Reading:
        """After ``name`` was replaced by what the relation ``by`` gives."""
        if name not in self.of:
            return self
        return _Reading({**{n: k for n, k in self.of.items() if n != name}, **{n: OTHER for n in by.of if n != name}})


def _readings(relations: Iterable[Expr]) -> list[_Reading]:
    """How coordinates occur in every relation; looked at once in those that are the same up to names."""
    known: dict[Expr, list[tuple[int, int]]] = {}
    found = []
    for g in relations:
        shape = shape_of(g)
        if shape.skeleton not in known:
            place = {name: k for k, name in enumerate(shape.names)}
            known[shape.skeleton] = [(place[name], degree) for name, degree in _degrees(g).items()]
        found.append(_Reading({shape.names[k]: degree for k, degree in known[shape.skeleton]}))
    return found


def _degrees(g: Expr) -> dict[str, int]:
    """Every coordinate of ``g`` with how it occurs."""
    memo: dict[int, dict[str, int]] = {}
    stack = [g]
    while stack:
        node = stack.pop()
        parts = ex.children(node)
        waiting = [part for part in parts if id(part) not in memo]
        if waiting:
            stack += [node, *waiting]
        else:
            memo[id(node)] = _joined(node, [memo[id(part)] for part in parts])
    return memo[id(g)]


def _joined(e: Expr, parts: Sequence[dict[str, int]]) -> dict[str, int]:
    """How coordinates occur in a node, by how they occur in its parts."""
    if e.op == "sym":
        return {str(e.args[1]): PLAIN} if e.args[0] == "coordinate" else {}
    if e.op == "pow" and e.args[1] == ex.TWO:
        return {n: QUADRATIC if k <= LINEAR else OTHER for n, k in parts[0].items()}
    if e.op not in ("add", "mul"):
        return {n: OTHER for part in parts for n in part}
    single = e.op == "mul" and sum(p.op not in ("num", "const") for p in e.args) == 1
    found: dict[str, int] = {}
    for part in parts:
        for name, k in part.items():
            own = k if single or e.op == "add" else max(k, LINEAR)
            found[name] = own if name not in found else _both(e.op, found[name], own)
    return found


def _both(op: str, first: int, second: int) -> int:
    """Of a coordinate in two terms, or in two factors."""
    if op == "add":
        return max(first, second, LINEAR)
    return QUADRATIC if max(first, second) == LINEAR else OTHER
