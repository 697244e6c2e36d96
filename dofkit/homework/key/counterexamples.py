"""Finds a state that only an answer or only the right constraints allow, by a numerical search."""

from __future__ import annotations

import random
from collections.abc import Iterable, Sequence

from dofkit.base.errors import NoValueError
from dofkit.exact.points.real_search import RealSearch
from dofkit.exact.ring.program import values
from dofkit.exact.ring.ring import Ring
from dofkit.expressions import tree as ex
from dofkit.expressions.calculus import in_velocities, substitute
from dofkit.expressions.text import to_text
from dofkit.expressions.tree import Expr
from dofkit.relations.velocity_reductions import rate
from dofkit.scene.lowering import lower
from dofkit.scene.scene import Scene

#: The number of searches for a state.
SEARCHES = 16
#: The kinds of symbols that may occur in the expressions.
_SHOWN = ("coordinate", "velocity", "time")


def counterexample(
    scene: Scene, satisfied: Sequence[Expr], violated: Sequence[Expr], positive: Sequence[Expr] = ()
) -> str:
    """Return a state as text at which ``satisfied`` are 0, ``positive`` > 0 and one of ``violated`` is certainly not 0.

    The text is empty if none is found. ``scene``: the other constraints, which the state satisfies too. Parameters are
    whole numbers.
    """
    named = frozenset[Expr]().union(*(in_velocities(e)[0].symbols for e in (*satisfied, *violated, *positive)))
    free = [name for name, value in scene.parameters.items() if value in ("real", "positive", "nonzero")]
    numbers = {name: n for n, name in enumerate(free, 2)}
    table = {ex.parameter(name): ex.num(n) for name, n in numbers.items()}
    relations = [r for c in lower(scene).constraints for r in c.relations]
    zero = [*satisfied, *(r.expr for r in relations if r.sense == "=")]
    sides = [*positive, *(r.expr for r in relations if r.sense != "=")]
    zero, violated, sides = ([substitute(in_velocities(e)[0], table) for e in part] for part in (zero, violated, sides))
    if _has(zero, "velocity") or _has(violated, "velocity"):
        zero += [rate(e) for e in zero if not _has([e], "velocity")]
    symbols = frozenset[Expr]().union(*(e.symbols for e in (*zero, *violated, *sides)))
    if any(s.args[0] not in _SHOWN for s in symbols) or any("call" in e.functions for e in (*zero, *violated, *sides)):
        return ""
    ring = Ring([*zero, *violated, *sides], frozenset())
    nodes, failing, inside = ([ring.node(e) for e in part] for part in (zero, violated, sides))
    unknowns = sorted((s for s in symbols if s is not ex.TIME), key=repr)
    search, rng = RealSearch(ring, nodes, unknowns, frozenset()), random.Random("dofkit counterexample")
    for seed in range(SEARCHES):
        state = search.search(seed, {s: rng.randrange(-1024, 1025) / 256 for s in unknowns}, starts=1)
        if state is None or not state.certain:
            continue
        try:
            at = values(ring, state.point)
        except NoValueError:
            continue
        differs = not failing or any(not at[n].contains(0) for n in failing)
        if differs and all(at[n] > 0 for n in inside):
            values_of = {to_text(s): float(state.point.symbols[s]) for s in sorted(symbols & named, key=repr)}
            values_of |= {name: n for name, n in numbers.items() if ex.parameter(name) in named}
            return ", ".join(f"{name} = {value:.3g}" for name, value in values_of.items())
    return ""


def _has(expressions: Iterable[Expr], kind: str) -> bool:
    return any(s.args[0] == kind for e in expressions for s in e.symbols)
