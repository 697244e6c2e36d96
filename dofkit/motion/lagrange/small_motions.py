"""Small motions M qddot + C qdot + K q = 0 about an equilibrium, with its characteristic equation and frequencies.

Equilibria are proposed (the reference configuration, 0, what SymPy solves the forces for, quarter turns of angles) and
each is checked exactly against the equations and the constraints. Constraints that keep a multiplier restrict the
deviations to those that they allow.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from itertools import combinations, islice, product
from typing import Any, NamedTuple

from dofkit.base.deadline import OutOfTimeError, by_processor, check, remaining_seconds
from dofkit.base.errors import NoValueError
from dofkit.exact.ring.canonical import is_identically_zero
from dofkit.exact.ring.program import raising_no_value
from dofkit.expressions import tree as ex
from dofkit.expressions.calculus import diff, substitute
from dofkit.expressions.sympy_bridge import Bridge, UntranslatableError
from dofkit.expressions.text.printing import to_text
from dofkit.expressions.tree import HALF, MINUS_ONE, PI, ZERO, Expr
from dofkit.motion.lagrange.derivation import Derived
from dofkit.motion.lagrange.elimination import Care, EliminatedRelation, Elimination, Eliminator, by_potential
from dofkit.motion.lagrange.model import NoEquationsError
from dofkit.motion.lagrange.report import Linearized
from dofkit.motion.lagrange.tidying import Tidier

Place = Mapping[Expr, Expr]

#: Values of angles that are tried, and for how many angles at once.
TURNS, MOST_ANGLES = (ZERO, PI, HALF * PI, MINUS_ONE * HALF * PI), 2
#: Relations are solved for a place by as many roots as they need.
ALL_ROOTS = Care(400, 12)
#: Equilibria that are reported, candidates that are tried, and seconds for SymPy to propose some.
MOST, CANDIDATES, SOLVING = 8, 72, 2.0
#: Frequencies are given where the characteristic polynomial has factors of so small degree in s^2, for so many rows.
MOST_BY_FORMULA, MOST_ROWS = 2, 6
#: Choices of dependent coordinates that are tried.
CHOICES = 40


class Equilibrium(NamedTuple):
    """The values of the coordinates kept, and of the multipliers, at rest."""

    place: Place
    multipliers: Place


class Matrices(NamedTuple):
    """M, C and K in SymPy, for the deviations of ``names``."""

    names: tuple[str, ...]
    mass: Any
    damping: Any
    stiffness: Any


def linearized(derived: Derived) -> Linearized:
    """Return M, C and K at the reference configuration if that is an equilibrium, else at 0, else at another one.

    With E(q, qdot, qddot, lam) = 0 the equations: M = dE/dqddot, C = dE/dqdot, K = dE/dq there. Raises NoEquationsError
    where time enters or no equilibrium is known.
    """
    if any(ex.TIME in e.symbols for e in (*derived.model.holonomic, *derived.model.nonholonomic)):
        raise NoEquationsError("the constraints depend on time, so there is no equilibrium")
    equilibria = list(islice(_Equilibria(derived).equilibria(), MOST))
    if not equilibria:
        if any(ex.TIME in e.symbols for e in derived.equations.values()):
            raise NoEquationsError("the equations depend on time, and no equilibrium is known")
        hint = "give one as the scene's `configuration`"
        raise NoEquationsError(f"no equilibrium was found; neither the reference configuration nor 0 is one: {hint}")
    work = _Linearization(derived)
    for equilibrium in equilibria:
        matrices = work.matrices(equilibrium)
        if matrices is not None:
            others = [work.texts(e) for e in equilibria if e is not equilibrium]
            return work.linearized(equilibrium, matrices, others)
    raise NoEquationsError("the constraints are singular at the equilibrium")


def _at_rest(e: Expr, place: Place) -> Expr:
    """Return an expression without velocities and accelerations, at a place."""
    rates = {s: ZERO for s in e.symbols if s.args[0] in ("velocity", "acceleration")}
    return substitute(e, {**rates, **place})


class _Translated:
    """The equations of a system with a bridge to SymPy."""

    def __init__(self, derived: Derived) -> None:
        self.derived, self.model = derived, derived.model
        self.names = [ex.coordinate(n) for n in self.model.names]
        self.bridge = Bridge(self.model.names, self.model.positive)
        self.tidy = Tidier(self.bridge, self.model.positive)

    def plain(self, e: Expr) -> Expr:
        """Return an expression with sines of known angles inserted."""
        return e if e.op == "num" else self.bridge.expr(self.bridge.sympy(e))

    def matrix(self, rows: Sequence[Sequence[Expr]]) -> Any:
        """Return a matrix in SymPy."""
        import sympy

        return sympy.Matrix([[self.bridge.sympy(e) for e in row] for row in rows])

    def may_vanish(self, det: Any) -> bool:
        """Return whether a determinant is not proved to be other than 0."""
        return is_identically_zero(self.bridge.expr(det.expand()), self.model.positive) is not False


class _Equilibria(_Translated):
    """The search for equilibria."""

    def equilibria(self) -> Iterator[Equilibrium]:
        """Yield the candidates at which the constraints are satisfied at rest and all forces balance."""
        seen: set[tuple[Expr, ...]] = set()
        for written in islice(self._candidates(), CANDIDATES):
            place = {q: self.plain(written[q]) for q in self.names}
            key = tuple(place.values())
            if key not in seen:
                seen.add(key)
                equilibrium = self._balanced(place)
                if equilibrium is not None:
                    yield equilibrium

    def _candidates(self) -> Iterator[Place]:
        reference = self.model.study.system.reference
        if reference is not None:
            yield {q: reference[q] for q in self.names}
        yield dict.fromkeys(self.names, ZERO)
        for branch in self._branches():
            free = [q for q in self.names if str(q.args[1]) not in branch.solved]
            for chosen in self._quarter_turns(free):
                tied = {ex.coordinate(n): substitute(e, chosen) for n, e in branch.solved.items()}
                yield {**chosen, **tied}
        if not self.derived.multipliers:
            yield from self._solved()

    def _solved(self) -> Iterator[Place]:
        """Yield what SymPy finds for the forces alone, in bounded time."""
        import sympy

        marks = {q: ex.parameter(f"_{q.args[1]} ") for q in self.names}
        forces = [self.bridge.sympy(_at_rest(e, marks)) for e in self.derived.equations.values()]
        unknowns = [self.bridge.sympy(mark) for mark in marks.values()]
        try:
            with by_processor(min(SOLVING, remaining_seconds())):
                solutions = sympy.solve(forces, unknowns, dict=True)
        except OutOfTimeError:
            check()
            return
        except (ArithmeticError, AttributeError, NotImplementedError, TypeError, ValueError):
            return
        for solution in solutions:
            if len(solution) == len(unknowns) and not any(v.free_symbols & set(unknowns) for v in solution.values()):
                try:
                    yield {q: self.tidy(solution[u]) for q, u in zip(self.names, unknowns, strict=True)}
                except (UntranslatableError, NoValueError):
                    continue

    def _branches(self) -> Iterator[Elimination]:
        """Yield what the finite constraints give of the coordinates, on one branch each."""
        if not self.model.holonomic:
            yield Elimination()
            return
        choose = by_potential(self.model.energy.potential, self.model.study.system.reference)
        relations = [EliminatedRelation(g) for g in self.model.holonomic]
        for names in (self.model.names, self.model.names[::-1]):
            try:
                branch = Eliminator(self.model.positive, choose, ALL_ROOTS).eliminated(relations, names, ())
            except NoValueError:
                continue
            if len(branch.solved) == len(relations):
                yield branch

    def _quarter_turns(self, free: Sequence[Expr]) -> Iterator[Place]:
        """Yield all at 0, and angles at quarters of a turn."""
        zeros = dict.fromkeys(free, ZERO)
        yield zeros
        every = (*self.derived.equations.values(), *self.model.holonomic)
        waves = [n for e in every for n in ex.nodes(e) if n.op == "fn" and n.args[0] in ("sin", "cos")]
        angles = [q for q in free if any(q in n.symbols for n in waves)]
        if len(angles) <= MOST_ANGLES:
            for turns in product(TURNS, repeat=len(angles)):
                yield {**zeros, **dict(zip(angles, turns, strict=True))}

    def _balanced(self, place: Place) -> Equilibrium | None:
        """Return the place with its multipliers if it is an equilibrium, proved."""
        try:
            if not all(self._vanishes(_at_rest(e, place)) for e in (*self.model.holonomic, *self.model.nonholonomic)):
                return None
            forces = [_at_rest(e, place) for e in self.derived.equations.values()]
            multipliers = self._multipliers(forces)
            if multipliers is None or not all(self._vanishes(substitute(e, multipliers)) for e in forces):
                return None
        except NoValueError:
            return None
        return Equilibrium(place, multipliers)

    @raising_no_value
    def _vanishes(self, e: Expr) -> bool:
        """Return whether an expression is 0 identically, sines of known angles inserted; proved."""
        plain = self.plain(e)
        return plain.is_zero or is_identically_zero(plain, self.model.positive) is True

    @raising_no_value
    def _multipliers(self, forces: list[Expr]) -> Place | None:
        """Return the multipliers that balance the forces, if any do: least squares, which are checked afterwards."""
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


class _Linearization(_Translated):
    """The matrices about an equilibrium, and the report's entry."""

    def matrices(self, at: Equilibrium) -> Matrices | None:
        """Return M, C and K there, or None where the constraints are singular."""
        place = {**at.place, **at.multipliers}
        kinds: tuple[ex.Kind, ...] = ("acceleration", "velocity", "coordinate")
        every = []
        for kind in kinds:
            rows = [
                [_at_rest(diff(e, ex.sym(kind, n)), place) for n in self.model.names]
                for e in self.derived.equations.values()
            ]
            if any(ex.TIME in e.symbols for row in rows for e in row):
                raise NoEquationsError("the equations depend on time at the equilibrium")
            every.append(self.matrix(rows))
        if not self.derived.multipliers:
            return Matrices(self.model.names, *every)
        free, basis = self._allowed(at)
        if basis is None:
            return None
        return Matrices(tuple(self.model.names[i] for i in free), *(basis.T * m * basis for m in every))

    def _allowed(self, at: Equilibrium) -> tuple[list[int], Any]:
        """Return the places of free deviations, and all deviations as combinations of them, or no basis."""
        import sympy

        names, model = self.model.names, self.model
        rows = [[_at_rest(diff(g, ex.coordinate(n)), at.place) for n in names] for g in model.holonomic]
        for r in model.nonholonomic:
            if any(not _at_rest(diff(r, ex.coordinate(n)), at.place).is_zero for n in names):
                raise NoEquationsError(
                    "a velocity constraint has a term without velocities that depends on the configuration"
                )
            rows.append([_at_rest(diff(r, ex.velocity(n)), at.place) for n in names])
        matrix, every = self.matrix(rows), list(range(len(rows)))
        for tied in islice(combinations(range(len(names) - 1, -1, -1), len(rows)), CHOICES):
            part = matrix.extract(every, list(tied))
            det = part.det(method="berkowitz")
            if self.may_vanish(det):
                continue
            free = [i for i in range(len(names)) if i not in tied]
            others = -(part.adjugate() * matrix.extract(every, free)) / det
            basis = sympy.zeros(len(names), len(free))
            for k, i in enumerate(free):
                basis[i, k] = 1
                for j, t in enumerate(tied):
                    basis[t, k] = sympy.cancel(others[j, k])
            return free, basis
        return [], None

    def texts(self, at: Equilibrium) -> dict[str, str]:
        """Return the coordinates at rest, those that were eliminated too."""
        values = {str(q.args[1]): to_text(v) for q, v in at.place.items()}
        for name, value in self.model.elimination.solved.items():
            try:
                values[name] = to_text(self.plain(substitute(value, at.place)))
            except NoValueError:
                continue
        return values

    def linearized(self, at: Equilibrium, matrices: Matrices, others: list[dict[str, str]]) -> Linearized:
        """Return the report's entry."""
        import sympy

        s = sympy.Dummy("s")
        polynomial = None
        if matrices.mass.rows <= MOST_ROWS:
            whole = matrices.mass * s**2 + matrices.damping * s + matrices.stiffness
            polynomial = sympy.cancel(whole.det(method="berkowitz")) if matrices.mass.rows else sympy.Integer(1)
        squares = [] if polynomial is None else _squares(polynomial, s, matrices.damping)
        mass, damping, stiffness = (
            [[to_text(self.tidy(e)) for e in m.row(i)] for i in range(m.rows)] for m in matrices[1:]
        )
        return Linearized(
            coordinates=list(matrices.names),
            equilibrium=self.texts(at),
            mass=mass,
            damping=damping,
            stiffness=stiffness,
            characteristic="" if polynomial is None else self._by_powers(polynomial, s),
            frequencies=[] if any(w.is_negative for w in squares) else [self._frequency(w) for w in squares],
            unstable=any(bool(w.is_negative) for w in squares),
            others=others,
        )

    def _by_powers(self, polynomial: Any, s: Any) -> str:
        """Return a polynomial in s as text, the highest power first, what its coefficients have in common before it."""
        import sympy

        system = self.model.study.system
        taken = {*(c.name for c in system.coordinates), *system.parameters, *system.functions}
        name = next(n for n in ("s", "sigma", "s_", "exponent", "characteristic_exponent") if n not in taken)
        symbol = self.bridge.sympy(ex.parameter(name))
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
        """Return the root of the square of a frequency: of the whole, or of its factors, whichever is shorter."""
        import sympy

        factored = sympy.factor(square)
        by_factors, whole = to_text(self.tidy(sympy.sqrt(factored))), f"sqrt({to_text(self.tidy(factored))})"
        return min(by_factors, whole, key=len)


def _squares(polynomial: Any, s: Any, damping: Any) -> list[Any]:
    """Return omega^2 with s = i omega, from the factors of the polynomial in s^2, or nothing where C is not 0."""
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
