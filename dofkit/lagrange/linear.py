"""Small motions about an equilibrium: M qddot + C qdot + K q = 0."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from typing import Any

from dofkit import expr as ex
from dofkit.exact.canon import is_identically_zero
from dofkit.expr import ZERO, Expr
from dofkit.lagrange.bridge import Bridge
from dofkit.lagrange.derivation import Derived
from dofkit.lagrange.model import MotionError
from dofkit.lagrange.report import Linearized
from dofkit.lagrange.tidying import Tidier
from dofkit.text import to_text

#: Frequencies are given by a formula up to so many coordinates.
MOST_BY_FORMULA = 2


def linearized(derived: Derived) -> Linearized:
    """M, C and K at the reference configuration if that is an equilibrium, else at 0, else where linear forces balance.

    With E(q, qdot, qddot) = 0 the equations: M = dE/dqddot, C = dE/dqdot, K = dE/dq there. Raises MotionError where
    multipliers are left, time enters or no equilibrium is known.
    """
    if derived.multipliers:
        raise MotionError("equations with multipliers are not linearized: write the scene in independent coordinates")
    place = next((p for p in _places(derived) if _is_equilibrium(derived, p)), None)
    if place is None:
        hint = "give one as the scene's `configuration`"
        raise MotionError(f"no equilibrium is known, neither the reference configuration nor 0 is one: {hint}")
    names = derived.model.names
    kinds: tuple[ex.Kind, ...] = ("acceleration", "velocity", "coordinate")
    matrices = [
        [[_at(ex.diff(e, ex.sym(kind, n)), place) for n in names] for e in derived.equations.values()] for kind in kinds
    ]
    if any(ex.TIME in e.symbols for matrix in matrices for row in matrix for e in row):
        raise MotionError("time enters the equations at the equilibrium, so that they are not linearized")
    return _told(derived, place, matrices)


def _places(derived: Derived) -> Iterator[Mapping[Expr, Expr]]:
    reference = derived.model.study.system.reference
    names = [ex.coordinate(n) for n in derived.model.names]
    if reference is not None:
        yield {q: reference[q] for q in names}
    yield dict.fromkeys(names, ZERO)
    balanced = _balanced(derived)
    if balanced is not None:
        yield balanced


def _balanced(derived: Derived) -> Mapping[Expr, Expr] | None:
    """Where the forces balance, if they are linear in the coordinates and there is one such place."""
    names = [ex.coordinate(n) for n in derived.model.names]
    rest = [_at(e, {}) for e in derived.equations.values()]
    slopes = [[ex.diff(e, q) for q in names] for e in rest]
    if any(s.args[0] in ("coordinate", "time") for row in slopes for e in row for s in e.symbols):
        return None
    import sympy

    bridge = Bridge(derived.model.names, derived.model.positive)
    matrix = sympy.Matrix([[bridge.sympy(e) for e in row] for row in slopes])
    here = sympy.Matrix([bridge.sympy(ex.substitute(e, dict.fromkeys(names, ZERO))) for e in rest])
    whole = matrix.det(method="berkowitz")
    if is_identically_zero(bridge.expr(whole.expand()), derived.model.positive) is not False:
        return None
    tidy = Tidier(bridge, derived.model.positive)
    found = -(matrix.adjugate() * here) / whole
    return {q: tidy(sympy.cancel(v)) for q, v in zip(names, found, strict=True)}


def _at(e: Expr, place: Mapping[Expr, Expr]) -> Expr:
    still = {s: ZERO for s in e.symbols if s.args[0] in ("velocity", "acceleration")}
    return ex.substitute(e, {**still, **place})


def _is_equilibrium(derived: Derived, place: Mapping[Expr, Expr]) -> bool:
    try:
        left = [_at(e, place) for e in derived.equations.values()]
    except ZeroDivisionError:
        return False
    return all(e.is_zero or is_identically_zero(e, derived.model.positive) is True for e in left)


def _told(derived: Derived, place: Mapping[Expr, Expr], matrices: list[list[list[Expr]]]) -> Linearized:
    import sympy

    bridge = Bridge(derived.model.names, derived.model.positive)
    tidy = Tidier(bridge, derived.model.positive)
    mass, damping, stiffness = (sympy.Matrix([[bridge.sympy(e) for e in row] for row in matrix]) for matrix in matrices)
    s = sympy.Dummy("s")
    polynomial = (mass * s**2 + damping * s + stiffness).det(method="berkowitz").expand()
    shown = bridge.sympy(ex.parameter(_free_name(derived)))

    def rows(matrix: Any) -> list[list[str]]:
        return [[to_text(tidy(e)) for e in matrix.row(i)] for i in range(matrix.rows)]

    return Linearized(
        equilibrium={str(q.args[1]): to_text(v) for q, v in place.items()},
        mass=rows(mass),
        damping=rows(damping),
        stiffness=rows(stiffness),
        characteristic=to_text(tidy(polynomial.xreplace({s: shown}))),
        frequencies=[to_text(tidy(w)) for w in _frequencies(polynomial, s, damping)],
    )


def _free_name(derived: Derived) -> str:
    system = derived.model.study.system
    taken = {*(c.name for c in system.coordinates), *system.parameters, *system.functions}
    return next(n for n in ("s", "sigma", "s_", "exponent", "characteristic_exponent") if n not in taken)


def _frequencies(polynomial: Any, s: Any, damping: Any) -> list[Any]:
    """omega with s = i omega, from the roots of the characteristic polynomial in s^2."""
    import sympy

    if not damping.is_zero_matrix or damping.rows > MOST_BY_FORMULA:
        return []
    square = sympy.Dummy("square")
    roots = sympy.roots(sympy.Poly(polynomial.subs(s, sympy.sqrt(square)).expand(), square))
    squares = [-root for root, times in roots.items() for _ in range(times)]
    if len(squares) != damping.rows:
        return []
    found = [sympy.sqrt(sympy.factor(w)) for w in squares]
    return [] if any(w.has(sympy.I) for w in found) else found
