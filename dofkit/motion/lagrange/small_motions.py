"""Small motions about an equilibrium: M qddot + C qdot + K q = 0."""

from __future__ import annotations

from collections.abc import Iterable
from itertools import combinations, islice
from typing import Any, NamedTuple

from dofkit.exact.errors import NoValueError
from dofkit.exact.ring.canonical import is_identically_zero
from dofkit.expressions import tree as ex
from dofkit.expressions.calculus import diff, substitute
from dofkit.expressions.sympy_bridge import Bridge
from dofkit.expressions.text import to_text
from dofkit.expressions.tree import Expr
from dofkit.motion.lagrange.derivation import Derived
from dofkit.motion.lagrange.equilibria import MOST, Equilibrium, equilibria, still
from dofkit.motion.lagrange.model import NoEquationsError
from dofkit.motion.lagrange.report import Linearized
from dofkit.motion.lagrange.tidying import Tidier

#: Frequencies are given where the characteristic polynomial has factors of so small degree in s^2, for so many rows.
MOST_BY_FORMULA, MOST_ROWS = 2, 6
#: Choices of dependent coordinates that are tried.
CHOICES = 40


class Matrices(NamedTuple):
    """M, C and K in SymPy, for the deviations of ``names``."""

    names: tuple[str, ...]
    mass: Any
    damping: Any
    stiffness: Any


def linearized(derived: Derived) -> Linearized:
    """M, C and K at the reference configuration if that is an equilibrium, else at 0, else at another that is found.

    With E(q, qdot, qddot, lam) = 0 the equations: M = dE/dqddot, C = dE/dqdot, K = dE/dq there, all of them restricted
    to the deviations that the constraints which kept a multiplier allow. Raises NoEquationsError where time enters or
    no equilibrium is known.
    """
    if any(ex.TIME in e.symbols for e in (*derived.model.holonomic, *derived.model.nonholonomic)):
        raise NoEquationsError("the constraints depend on time, so there is no equilibrium")
    found = list(islice(equilibria(derived), MOST))
    if not found:
        if any(ex.TIME in e.symbols for e in derived.equations.values()):
            raise NoEquationsError("the equations depend on time, and no equilibrium is known")
        hint = "give one as the scene's `configuration`"
        raise NoEquationsError(f"no equilibrium was found; neither the reference configuration nor 0 is one: {hint}")
    bridge = Bridge(derived.model.names, derived.model.positive)
    for equilibrium in found:
        told = _matrices(derived, equilibrium, bridge)
        if told is not None:
            others = [_texts(derived, bridge, e) for e in found if e is not equilibrium]
            return _linearized(derived, bridge, equilibrium, told, others)
    raise NoEquationsError("the constraints are singular at the equilibrium")


def _matrices(derived: Derived, at: Equilibrium, bridge: Bridge) -> Matrices | None:
    names = derived.model.names
    known = {**at.place, **at.multipliers}
    kinds: tuple[ex.Kind, ...] = ("acceleration", "velocity", "coordinate")
    whole = []
    for kind in kinds:
        rows = [[still(diff(e, ex.sym(kind, n)), known) for n in names] for e in derived.equations.values()]
        if any(ex.TIME in e.symbols for row in rows for e in row):
            raise NoEquationsError("the equations depend on time at the equilibrium")
        whole.append(_matrix(bridge, rows))
    if not derived.multipliers:
        return Matrices(names, *whole)
    free, basis = _allowed(derived, at, bridge)
    if basis is None:
        return None
    mass, damping, stiffness = (basis.T * m * basis for m in whole)
    return Matrices(tuple(names[i] for i in free), mass, damping, stiffness)


def _matrix(bridge: Bridge, rows: Iterable[Iterable[Expr]]) -> Any:
    import sympy

    return sympy.Matrix([[bridge.sympy(e) for e in row] for row in rows])


def _allowed(derived: Derived, at: Equilibrium, bridge: Bridge) -> tuple[list[int], Any]:
    """The places of free deviations, and all deviations as combinations of them; no basis where none was found."""
    import sympy

    model = derived.model
    names = model.names
    rows = [[still(diff(g, ex.coordinate(n)), at.place) for n in names] for g in model.holonomic]
    for r in model.nonholonomic:
        if any(not still(diff(r, ex.coordinate(n)), at.place).is_zero for n in names):
            raise NoEquationsError(
                "a velocity constraint has a term without velocities that depends on the configuration"
            )
        rows.append([still(diff(r, ex.velocity(n)), at.place) for n in names])
    whole = _matrix(bridge, rows)
    for tied in islice(combinations(range(len(names) - 1, -1, -1), len(rows)), CHOICES):
        part = whole.extract(list(range(len(rows))), list(tied))
        det = part.det(method="berkowitz").expand()
        if is_identically_zero(bridge.expr(det), model.positive) is not False:
            continue
        free = [i for i in range(len(names)) if i not in tied]
        others = -(part.adjugate() * whole.extract(list(range(len(rows))), free)) / det
        basis = sympy.zeros(len(names), len(free))
        for k, i in enumerate(free):
            basis[i, k] = 1
            for j, t in enumerate(tied):
                basis[t, k] = sympy.cancel(others[j, k])
        return free, basis
    return [], None


def _texts(derived: Derived, bridge: Bridge, at: Equilibrium) -> dict[str, str]:
    """The coordinates at rest, those that were eliminated too."""
    found = {str(q.args[1]): to_text(v) for q, v in at.place.items()}
    for name, value in derived.model.elimination.solved.items():
        try:
            here = substitute(value, at.place)
        except NoValueError:
            continue
        found[name] = to_text(bridge.expr(bridge.sympy(here)))
    return found


def _linearized(
    derived: Derived, bridge: Bridge, at: Equilibrium, found: Matrices, others: list[dict[str, str]]
) -> Linearized:
    import sympy

    tidy = Tidier(bridge, derived.model.positive)
    s = sympy.Dummy("s")
    polynomial = None
    if found.mass.rows <= MOST_ROWS:
        whole = found.mass * s**2 + found.damping * s + found.stiffness
        polynomial = sympy.cancel(whole.det(method="berkowitz")) if found.mass.rows else sympy.Integer(1)
    shown = bridge.sympy(ex.parameter(_free_name(derived)))

    def rows(matrix: Any) -> list[list[str]]:
        return [[to_text(tidy(e)) for e in matrix.row(i)] for i in range(matrix.rows)]

    squares = [] if polynomial is None else _squares(polynomial, s, found.damping)
    return Linearized(
        coordinates=list(found.names),
        equilibrium=_texts(derived, bridge, at),
        mass=rows(found.mass),
        damping=rows(found.damping),
        stiffness=rows(found.stiffness),
        characteristic="" if polynomial is None else _by_powers(polynomial, s, shown, tidy),
        frequencies=[] if any(w.is_negative for w in squares) else [_frequency(w, tidy) for w in squares],
        unstable=any(bool(w.is_negative) for w in squares),
        others=others,
    )


def _by_powers(polynomial: Any, s: Any, shown: Any, tidy: Tidier) -> str:
    """A polynomial in s as text, the highest power first, what its coefficients have in common before it."""
    import sympy

    top, bottom = sympy.fraction(sympy.together(polynomial))
    if s not in top.free_symbols:
        return to_text(tidy(polynomial.xreplace({s: shown})))
    common, rest = sympy.Poly(top, s).primitive()
    powers = [(sympy.factor(c), k) for (k,), c in rest.terms()]
    terms = [to_text(tidy(sympy.Mul(c, shown**k))) for c, k in powers]
    whole = terms[0] + "".join(f" - {t[1:]}" if t.startswith("-") else f" + {t}" for t in terms[1:])
    factor = to_text(tidy(common / bottom))
    if factor == "1":
        return whole
    return f"{factor}*({whole})" if len(terms) > 1 else to_text(tidy(polynomial.xreplace({s: shown})))


def _frequency(square: Any, tidy: Tidier) -> str:
    """The root of the square of a frequency: of the whole, or of its factors, whichever is shorter."""
    import sympy

    factored = sympy.factor(square)
    by_factors, whole = to_text(tidy(sympy.sqrt(factored))), f"sqrt({to_text(tidy(factored))})"
    return min(by_factors, whole, key=len)


def _free_name(derived: Derived) -> str:
    system = derived.model.study.system
    taken = {*(c.name for c in system.coordinates), *system.parameters, *system.functions}
    return next(n for n in ("s", "sigma", "s_", "exponent", "characteristic_exponent") if n not in taken)


def _squares(polynomial: Any, s: Any, damping: Any) -> list[Any]:
    """omega^2 with s = i omega, from the factors of the characteristic polynomial in s^2; none where C is not 0."""
    import sympy

    if not damping.is_zero_matrix or not damping.rows:
        return []
    square = sympy.Dummy("square")
    top = sympy.fraction(sympy.together(polynomial))[0].expand()
    found: list[Any] = []
    for factor, times in sympy.factor_list(top.subs(s, sympy.sqrt(square)).expand(), square)[1]:
        poly = sympy.Poly(factor, square)
        if poly.degree() > MOST_BY_FORMULA:
            return []
        found += [-root for root, k in sympy.roots(poly).items() for _ in range(k * times)]
    return found if len(found) == damping.rows else []
