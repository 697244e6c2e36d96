"""Small motions M qddot + C qdot + K q = 0 about an equilibrium, with its characteristic equation and frequencies.

The equilibrium is the reference configuration, else the configuration with all coordinates 0; the equations and the
constraints are checked there exactly. Constraints that keep a multiplier restrict the deviations.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from itertools import combinations, islice
from typing import Any, NamedTuple

from dofkit.base.errors import NoValueError
from dofkit.exact.ring.canonical import is_identically_zero
from dofkit.exact.ring.program import none_without_value, raising_no_value
from dofkit.expressions import tree as ex
from dofkit.expressions.calculus import diff, substitute
from dofkit.expressions.sympy_bridge import Bridge
from dofkit.expressions.text.printing import to_text
from dofkit.expressions.tree import ZERO, Expr
from dofkit.motion.lagrange.derivation import Derived
from dofkit.motion.lagrange.model import NoEquationsError
from dofkit.motion.lagrange.report import Linearized
from dofkit.motion.lagrange.tidying import Tidier

Place = Mapping[Expr, Expr]

#: Frequencies have formulas up to this degree of factors in s^2; the polynomial is computed up to this many rows.
MOST_BY_FORMULA, MOST_ROWS = 2, 6
#: The most choices of dependent coordinates that are tried.
CHOICES = 40


class Matrices(NamedTuple):
    """M, C and K in SymPy, for the deviations of ``names``."""

    names: tuple[str, ...]
    mass: Any
    damping: Any
    stiffness: Any


def linearized(derived: Derived) -> Linearized:
    """Return the linearization at the reference configuration if that is an equilibrium, else at 0.

    The equations are E(q, qdot, qddot, lam) = 0, and M = dE/dqddot, C = dE/dqdot, K = dE/dq. Raises NoEquationsError
    if time enters, or neither configuration is an equilibrium.
    """
    model = derived.model
    if any(ex.TIME in e.symbols for e in (*model.holonomic, *model.nonholonomic)):
        raise NoEquationsError("the constraints depend on time, so there is no equilibrium")
    names = [ex.coordinate(n) for n in model.names]
    reference = model.study.system.reference
    work = _Linearization(derived)
    places = [] if reference is None else [{q: work.plain(reference[q]) for q in names}]
    for place in (*places, dict.fromkeys(names, ZERO)):
        multipliers = work.balancing(place)
        if multipliers is not None:
            return work.linearized(place, work.matrices(place, multipliers))
    if any(ex.TIME in e.symbols for e in derived.equations.values()):
        raise NoEquationsError("the equations depend on time, and no equilibrium is known")
    hint = "give one as the scene's `configuration`"
    raise NoEquationsError(f"neither the reference configuration nor 0 is an equilibrium: {hint}")


def _at_rest(e: Expr, place: Place) -> Expr:
    """Return an expression at a configuration, with velocities and accelerations 0."""
    rates = {s: ZERO for s in e.symbols if s.args[0] in ("velocity", "acceleration")}
    return substitute(e, {**rates, **place})


class _Linearization:
    """The equations of a system at an equilibrium, with a bridge to SymPy."""

    def __init__(self, derived: Derived) -> None:
        self.derived, self.model = derived, derived.model
        self.bridge = Bridge(self.model.names, self.model.positive)
        self.tidy = Tidier(self.bridge, self.model.positive)

    def plain(self, e: Expr) -> Expr:
        """Return an expression with its known values, such as sin(pi/5), evaluated by SymPy."""
        return e if e.op == "num" else self.bridge.from_sympy(self.bridge.to_sympy(e))

    def matrix(self, rows: Sequence[Sequence[Expr]]) -> Any:
        """Return a matrix of expressions as a SymPy matrix."""
        import sympy

        return sympy.Matrix([[self.bridge.to_sympy(e) for e in row] for row in rows])

    def may_vanish(self, det: Any) -> bool:
        """Return whether a determinant may be 0: False only if it is proved not to be."""
        return is_identically_zero(self.bridge.from_sympy(det.expand()), self.model.positive) is not False

    @none_without_value
    def balancing(self, place: Place) -> Place | None:
        """Return the multipliers that balance the forces at ``place``; None if no equilibrium is proved there."""
        if not all(self._vanishes(_at_rest(e, place)) for e in (*self.model.holonomic, *self.model.nonholonomic)):
            return None
        forces = [_at_rest(e, place) for e in self.derived.equations.values()]
        multipliers = self._multipliers(forces)
        if multipliers is None or not all(self._vanishes(substitute(e, multipliers)) for e in forces):
            return None
        return multipliers

    @raising_no_value
    def _vanishes(self, e: Expr) -> bool:
        """Return whether an expression is proved to be 0 identically, with known values evaluated."""
        plain = self.plain(e)
        return plain.is_zero or is_identically_zero(plain, self.model.positive) is True

    @raising_no_value
    def _multipliers(self, forces: list[Expr]) -> Place | None:
        """Return the multipliers of forces = 0 by least squares, unchecked; None if they are not unique."""
        names = [ex.parameter(n) for n in self.derived.multipliers]
        if not names:
            return {}
        import sympy

        matrix = self.matrix([[diff(e, s) for s in names] for e in forces])
        constant = self.matrix([[substitute(e, dict.fromkeys(names, ZERO))] for e in forces])
        normal = matrix.T * matrix
        det = normal.det(method="berkowitz")
        if self.may_vanish(det):
            return None
        solution = -(normal.adjugate() * matrix.T * constant) / det
        return {s: self.tidy(sympy.cancel(v)) for s, v in zip(names, solution, strict=True)}

    def matrices(self, place: Place, multipliers: Place) -> Matrices:
        """Return M, C and K for the free deviations at ``place``. Raises NoEquationsError for singular constraints."""
        values = {**place, **multipliers}
        kinds: tuple[ex.Kind, ...] = ("acceleration", "velocity", "coordinate")
        every = []
        for kind in kinds:
            rows = [
                [_at_rest(diff(e, ex.sym(kind, n)), values) for n in self.model.names]
                for e in self.derived.equations.values()
            ]
            if any(ex.TIME in e.symbols for row in rows for e in row):
                raise NoEquationsError("the equations depend on time at the equilibrium")
            every.append(self.matrix(rows))
        if not self.derived.multipliers:
            return Matrices(self.model.names, *every)
        free, basis = self._allowed(place)
        return Matrices(tuple(self.model.names[i] for i in free), *(basis.T * m * basis for m in every))

    def _allowed(self, place: Place) -> tuple[list[int], Any]:
        """Return (indices of the free deviations, matrix of all deviations in terms of these)."""
        import sympy

        names, model = self.model.names, self.model
        rows = [[_at_rest(diff(g, ex.coordinate(n)), place) for n in names] for g in model.holonomic]
        for r in model.nonholonomic:
            if any(not _at_rest(diff(r, ex.coordinate(n)), place).is_zero for n in names):
                raise NoEquationsError(
                    "a velocity constraint has a term without velocities that depends on the configuration"
                )
            rows.append([_at_rest(diff(r, ex.velocity(n)), place) for n in names])
        matrix, every = self.matrix(rows), list(range(len(rows)))
        for dependent in islice(combinations(range(len(names) - 1, -1, -1), len(rows)), CHOICES):
            part = matrix.extract(every, list(dependent))
            det = part.det(method="berkowitz")
            if self.may_vanish(det):
                continue
            free = [i for i in range(len(names)) if i not in dependent]
            others = -(part.adjugate() * matrix.extract(every, free)) / det
            basis = sympy.zeros(len(names), len(free))
            for k, i in enumerate(free):
                basis[i, k] = 1
                for j, t in enumerate(dependent):
                    basis[t, k] = sympy.cancel(others[j, k])
            return free, basis
        raise NoEquationsError("the constraints are singular at the equilibrium")

    def texts(self, place: Place) -> dict[str, str]:
        """Return {coordinate: its value at equilibrium as text}, including eliminated ones."""
        values = {str(q.args[1]): to_text(v) for q, v in place.items()}
        for name, value in self.model.elimination.solved.items():
            try:
                values[name] = to_text(self.plain(substitute(value, place)))
            except NoValueError:
                continue
        return values

    def linearized(self, place: Place, matrices: Matrices) -> Linearized:
        """Return the linearization at ``place`` for the report."""
        import sympy

        s = sympy.Dummy("s")
        polynomial = None
        if matrices.mass.rows <= MOST_ROWS:
            whole = matrices.mass * s**2 + matrices.damping * s + matrices.stiffness
            polynomial = sympy.cancel(whole.det(method="berkowitz")) if matrices.mass.rows else sympy.Integer(1)
            if polynomial == 0:
                raise NoEquationsError("the equilibrium is singular: small motions about it are not determined")
        squares = [] if polynomial is None else _squares(polynomial, s, matrices.damping)
        mass, damping, stiffness = (
            [[to_text(self.tidy(e)) for e in m.row(i)] for i in range(m.rows)] for m in matrices[1:]
        )
        return Linearized(
            coordinates=list(matrices.names),
            equilibrium=self.texts(place),
            mass=mass,
            damping=damping,
            stiffness=stiffness,
            characteristic="" if polynomial is None else self._by_powers(polynomial, s),
            frequencies=[] if any(map(_is_no_frequency, squares)) else [self._frequency(w) for w in squares],
            unstable=None if polynomial is None else _grows(polynomial, s, squares, matrices.stiffness),
        )

    def _by_powers(self, polynomial: Any, s: Any) -> str:
        """Return a polynomial in s as text, the highest power first, with its common factor in front."""
        import sympy

        system = self.model.study.system
        taken = {*(c.name for c in system.coordinates), *system.parameters, *system.functions}
        name = next(n for n in ("s", "sigma", "s_", "exponent", "characteristic_exponent") if n not in taken)
        symbol = self.bridge.to_sympy(ex.parameter(name))
        top, bottom = sympy.fraction(sympy.together(polynomial))
        if s not in top.free_symbols:
            return to_text(self.tidy(polynomial.xreplace({s: symbol})))
        common, monic = sympy.Poly(top, s).primitive()
        terms = [to_text(self.tidy(sympy.Mul(sympy.factor(c), symbol**k))) for (k,), c in monic.terms()]
        factor = to_text(self.tidy(common / bottom))
        if factor != "1" and len(terms) == 1:
            return to_text(self.tidy(polynomial.xreplace({s: symbol})))
        total = terms[0] + "".join(f" - {t[1:]}" if t.startswith("-") else f" + {t}" for t in terms[1:])
        return total if factor == "1" else f"{factor}*({total})"

    def _frequency(self, square: Any) -> str:
        """Return the root of the square of a frequency as text, in the shorter of two forms."""
        import sympy

        factored = sympy.factor(square)
        by_factors, whole = to_text(self.tidy(sympy.sqrt(factored))), f"sqrt({to_text(self.tidy(factored))})"
        return min(by_factors, whole, key=len)


def _is_no_frequency(square: Any) -> bool:
    """Return whether a square of a frequency is negative, or not real (flutter)."""
    return bool(square.is_negative or square.is_real is False)


def _grows(polynomial: Any, s: Any, squares: Sequence[Any], stiffness: Any) -> bool | None:
    """Return whether some motion grows, from the characteristic polynomial; None if the signs do not tell.

    A real polynomial whose roots have no positive real part has coefficients of one sign. They all have a negative one
    if the principal minors of its Hurwitz matrix are positive [Hurwitz1895]. Equal frequencies may resonate unless the
    stiffness is symmetric.
    """
    import sympy

    coefficients = sympy.Poly(sympy.fraction(sympy.together(polynomial))[0], s).all_coeffs()
    monic = [sympy.expand(c * sympy.sign(coefficients[0])) for c in coefficients]
    if any(c.is_negative for c in monic) or any(map(_is_no_frequency, squares)):
        return True
    if (
        squares
        and all(w.is_positive for w in squares)
        and (len(set(squares)) == len(squares) or stiffness.is_symmetric())
    ):
        return False
    n = len(monic) - 1
    hurwitz = sympy.Matrix(n, n, lambda i, j: monic[2 * j - i + 1] if 0 <= 2 * j - i + 1 <= n else 0)
    minors = (hurwitz[:k, :k].det(method="berkowitz").expand() for k in range(1, n + 1))
    return False if n and monic[0].is_positive and all(minor.is_positive for minor in minors) else None


def _squares(polynomial: Any, s: Any, damping: Any) -> list[Any]:
    """Return the squares of the angular frequencies, s = i omega, from the factors of the polynomial in s^2.

    The list is empty with damping, and if a factor has no formula for its roots.
    """
    import sympy

    if not damping.is_zero_matrix or not damping.rows:
        return []
    square = sympy.Dummy("square")
    top = sympy.fraction(sympy.together(polynomial))[0].expand()
    squares: list[Any] = []
    for factor, times in sympy.factor_list(top.subs(s, sympy.sqrt(square)).expand(), square)[1]:
        poly = sympy.Poly(factor, square)
        if poly.degree() > MOST_BY_FORMULA:
            return []
        squares += [-root for root, k in sympy.roots(poly).items() for _ in range(k * times)]
    return squares if len(squares) == damping.rows else []
