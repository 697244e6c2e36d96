"""Where a system can be at rest: candidates, each checked exactly against the equations and the constraints."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from itertools import product
from typing import Any, NamedTuple

from dofkit.exact.errors import NoValueError, raising_no_value
from dofkit.exact.ring.canonical import is_identically_zero
from dofkit.expressions import tree as ex
from dofkit.expressions.calculus import diff, substitute
from dofkit.expressions.sympy_bridge import Bridge
from dofkit.expressions.tree import HALF, MINUS_ONE, PI, ZERO, Expr
from dofkit.motion.lagrange.derivation import Derived
from dofkit.motion.lagrange.elimination import Care, EliminatedRelation, Elimination, Eliminator, by_potential
from dofkit.motion.lagrange.tidying import Tidier

Place = Mapping[Expr, Expr]

#: What angles are tried at, and for how many of them at once.
TURNS, MOST_ANGLES = (ZERO, PI, HALF * PI, MINUS_ONE * HALF * PI), 2
#: Relations are solved for a place by as many roots as they need.
ALL = Care(400, 12)
#: So many equilibria are told.
MOST = 8


class Equilibrium(NamedTuple):
    """Coordinates kept and multipliers at rest."""

    place: Place
    multipliers: Place


def equilibria(derived: Derived) -> Iterator[Equilibrium]:
    """The reference configuration if it is one, then 0, then where linear forces balance, angles and single roots."""
    seen: set[tuple[Expr, ...]] = set()
    names = [ex.coordinate(n) for n in derived.model.names]
    bridge = Bridge(derived.model.names, derived.model.positive)
    for written in _places(derived):
        place = {q: bridge.expr(bridge.sympy(v)) for q, v in written.items()}
        key = tuple(place[q] for q in names)
        if key in seen:
            continue
        seen.add(key)
        found = _at_rest(derived, place)
        if found is not None:
            yield found
            if len(seen) > MOST * MOST:
                return


def still(e: Expr, place: Place) -> Expr:
    """An expression without velocities and accelerations, at a place."""
    rest = {s: ZERO for s in e.symbols if s.args[0] in ("velocity", "acceleration")}
    return substitute(e, {**rest, **place})


@raising_no_value
def vanishing(e: Expr, derived: Derived) -> bool:
    """Is an expression 0 identically, sines of known angles inserted? Proved."""
    bridge = Bridge(derived.model.names, derived.model.positive)
    plain = e if e.is_zero else bridge.expr(bridge.sympy(e))
    return plain.is_zero or is_identically_zero(plain, derived.model.positive) is True


def _at_rest(derived: Derived, place: Place) -> Equilibrium | None:
    """The place with its multipliers, where the constraints hold without velocities and all forces balance."""
    model = derived.model
    try:
        held = [still(e, place) for e in (*model.holonomic, *model.nonholonomic)]
        if not all(vanishing(e, derived) for e in held):
            return None
        forces = [still(e, place) for e in derived.equations.values()]
        values = _multipliers(derived, forces)
        if values is None:
            return None
        balanced = all(vanishing(substitute(e, values), derived) for e in forces)
    except NoValueError:
        return None
    return Equilibrium(place, values) if balanced else None


@raising_no_value
def _multipliers(derived: Derived, forces: list[Expr]) -> Place | None:
    """The multipliers that balance the forces, if any do: least squares, which are checked afterwards."""
    own = [ex.parameter(n) for n in derived.multipliers]
    if not own:
        return {}
    import sympy

    bridge = Bridge(derived.model.names, derived.model.positive)
    matrix = sympy.Matrix([[bridge.sympy(diff(e, s)) for s in own] for e in forces])
    rest = sympy.Matrix([bridge.sympy(substitute(e, dict.fromkeys(own, ZERO))) for e in forces])
    normal = matrix.T * matrix
    whole = normal.det(method="berkowitz")
    if is_identically_zero(bridge.expr(sympy.expand(whole)), derived.model.positive) is not False:
        return None
    tidy = Tidier(bridge, derived.model.positive)
    found = -(normal.adjugate() * matrix.T * rest) / whole
    return {s: tidy(sympy.cancel(v)) for s, v in zip(own, found, strict=True)}


# candidates


def _places(derived: Derived) -> Iterator[Place]:
    names = [ex.coordinate(n) for n in derived.model.names]
    reference = derived.model.study.system.reference
    if reference is not None:
        yield {q: reference[q] for q in names}
    yield dict.fromkeys(names, ZERO)
    if not derived.multipliers:
        balanced = _balanced(derived)
        if balanced is not None:
            yield balanced
    for solved in _branches(derived):
        free = [q for q in names if str(q.args[1]) not in solved.solved]
        for own in _grid(derived, free):
            place = {**own, **{ex.coordinate(n): substitute(e, own) for n, e in solved.solved.items()}}
            yield {q: place[q] for q in names}
    if len(names) == 1 and not derived.multipliers:
        yield from _single(derived, names[0])


def _branches(derived: Derived) -> Iterator[Elimination]:
    """What the finite constraints give of the coordinates, on one branch each."""
    model = derived.model
    if not model.holonomic:
        yield Elimination()
        return
    choose = by_potential(model.energy.potential, model.study.system.reference)
    for names in (model.names, model.names[::-1]):
        relations = [EliminatedRelation(g) for g in model.holonomic]
        try:
            found = Eliminator(model.positive, choose, ALL).eliminated(relations, names, ())
        except NoValueError:
            continue
        if len(found.solved) == len(relations):
            yield found


def _grid(derived: Derived, free: list[Expr]) -> Iterator[Place]:
    """All at 0, and angles at quarters of a turn."""
    angles = [q for q in free if _turns(derived, q)]
    zeros = dict.fromkeys(free, ZERO)
    yield zeros
    if len(angles) <= MOST_ANGLES:
        for turns in product(TURNS, repeat=len(angles)):
            yield {**zeros, **dict(zip(angles, turns, strict=True))}


def _turns(derived: Derived, q: Expr) -> bool:
    """Does a coordinate occur in sines and cosines?"""
    every = (*derived.equations.values(), *derived.model.holonomic)
    return any(n.op == "fn" and n.args[0] in ("sin", "cos") and q in n.symbols for e in every for n in ex.nodes(e))


def _balanced(derived: Derived) -> Place | None:
    """Where the forces balance, if they are linear in the coordinates and there is one such place."""
    names = [ex.coordinate(n) for n in derived.model.names]
    rest = [still(e, {}) for e in derived.equations.values()]
    slopes = [[diff(e, q) for q in names] for e in rest]
    if any(s.args[0] in ("coordinate", "time") for row in slopes for e in row for s in e.symbols):
        return None
    import sympy

    bridge = Bridge(derived.model.names, derived.model.positive)
    matrix = sympy.Matrix([[bridge.sympy(e) for e in row] for row in slopes])
    here = sympy.Matrix([bridge.sympy(substitute(e, dict.fromkeys(names, ZERO))) for e in rest])
    whole = matrix.det(method="berkowitz")
    if is_identically_zero(bridge.expr(whole.expand()), derived.model.positive) is not False:
        return None
    tidy = Tidier(bridge, derived.model.positive)
    found: Any = -(matrix.adjugate() * here) / whole
    return {q: tidy(sympy.cancel(v)) for q, v in zip(names, found, strict=True)}


def _single(derived: Derived, q: Expr) -> Iterator[Place]:
    """Where a factor of the one force is 0: of the first degree in q, or in its sine or cosine."""
    (equation,) = derived.equations.values()
    bridge = Bridge(derived.model.names, derived.model.positive)
    force = Tidier(bridge, derived.model.positive)(bridge.sympy(still(equation, {})))
    for factor in force.args if force.op == "mul" else (force,):
        for inner, back in ((q, None), (ex.fn("cos", q), "acos"), (ex.fn("sin", q), "asin")):
            mark = ex.parameter("_inner ")
            plain = substitute(factor, {inner: mark}) if back is None else _replaced(factor, inner, mark)
            slope = diff(plain, mark)
            if q in plain.symbols or slope.is_zero or mark in slope.symbols:
                continue
            try:
                value = -substitute(plain, {mark: ZERO}) / slope
                yield {q: value if back is None else ex.fn(back, value)}
            except (ArithmeticError, ValueError):
                continue


def _replaced(e: Expr, part: Expr, by: Expr) -> Expr:
    memo: dict[Expr, Expr] = {}
    for node in ex.nodes(e):
        memo[node] = by if node == part else ex.rebuild(node, tuple(memo[child] for child in ex.children(node)))
    return memo[e]
