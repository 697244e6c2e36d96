"""Labels of one piece on its own (scleronomic, catastatic, exact), and proofs that one form is integrable."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from itertools import combinations

from dofkit.base.errors import NoValueError, TextError
from dofkit.base.verdicts import TraitAnswer, Verdict, all_of, weakest
from dofkit.exact.analyticity import is_analytic
from dofkit.exact.points.balls import RealPoint
from dofkit.exact.points.real_search import RealSearch, at_another_time
from dofkit.exact.ring.canonical import quotients_of
from dofkit.exact.ring.program import false_without_value, values
from dofkit.exact.ring.ring import Ring
from dofkit.exact.triangular import TriangularSolver
from dofkit.exact.zero import BOTH, Engines, independent_on_set, odd_constants, zero_and_verdict
from dofkit.expressions import tree as ex
from dofkit.expressions.calculus import diff, differential_degree, substitute
from dofkit.expressions.tree import Expr
from dofkit.integrability.integrals import search
from dofkit.relations.normal.no_solution import no_solution
from dofkit.relations.normal.normal_form import velocities_of
from dofkit.relations.normal.pieces import Clause, Inequality, Nonlinear, Pfaffian
from dofkit.relations.normal.zero_set import never_vanishes
from dofkit.relations.setting import Setting


@dataclass(frozen=True)
class Traits:
    """The labels of one piece on its own, each with its certainty.

    ``timeless``: t does not occur explicitly (scleronomic). ``catastatic``: admits zero velocity; None for geometric
    equations and inequalities. ``exact``: the form is closed as written; None for all but Pfaffian pieces.
    """

    timeless: TraitAnswer
    catastatic: TraitAnswer | None = None
    exact: TraitAnswer | None = None


def traits_of(piece: Clause, positive: frozenset[Expr], engines: Engines = BOTH) -> Traits:
    """Return the labels of a piece."""
    without_t = timeless(piece, positive, engines)
    if isinstance(piece, Nonlinear):
        return Traits(without_t, _is_cone(piece.expr, positive, engines))
    if not isinstance(piece, Pfaffian):
        return Traits(without_t)
    return Traits(without_t, zero_and_verdict(piece.dt, positive, engines), exact(piece, positive, engines))


def timeless(piece: Clause, positive: frozenset[Expr], engines: Engines = BOTH) -> TraitAnswer:
    """Return whether the set that a piece describes is the same at all times, and how certain that is.

    The set is where a function of coordinates, velocities and time is 0, or for an inequality where it is positive.
    Factors without zeros are removed first, so that t may occur in them.
    """
    e = piece.rate if isinstance(piece, Pfaffian) else piece.expr
    if ex.TIME not in e.symbols:
        return True, "proved"
    sided = isinstance(piece, Inequality)
    if not sided and _is_of_time_alone(e):
        constant, sure = zero_and_verdict(diff(e, ex.TIME), positive, engines)
        return (constant, sure) if not constant or is_analytic(e, [ex.TIME], positive) else (None, "undecided")
    factors = [f for f in _factors_left(e, sided, positive) if ex.TIME in f.symbols]
    answers = [_is_still(f, sided, positive, engines) for f in factors]
    if (False, "proved") in answers:
        return False, "proved"
    # factors that have no zero do not count
    kept = [answer for f, answer in zip(factors, answers, strict=True) if not no_solution([f], positive)]
    return all_of(kept) if not sided or not kept else (None, "undecided")


def _is_still(f: Expr, sided: bool, positive: frozenset[Expr], engines: Engines) -> TraitAnswer:
    """Return whether the zero set of a factor f is the same at all times: df/dt = 0 on it, where it is regular."""
    moving = [s for s in f.symbols if s.args[0] in ("coordinate", "velocity")]
    if not moving:
        return None, "undecided"
    return vanishes_on(f, diff(f, ex.TIME), positive, engines, None if sided else moving)


def _factors_left(e: Expr, sided: bool, positive: frozenset[Expr]) -> list[Expr]:
    """Return the factors of e's numerator over the rationals, without those that do not matter for its zero set.

    Removed are factors with t that never vanish and, from an equation with other factors, analytic functions of time
    alone, which vanish only at single instants [IsolatedZeros], and declared functions, which are generic.
    """
    try:
        canon, [(top, _)] = quotients_of([e], positive)
        factors = [canon.to_expr(f) for f, _ in canon.factors(top)]
    except NoValueError:
        return [e]
    kept = [f for f in factors if ex.TIME not in f.symbols or not never_vanishes(f, positive)]
    at_instants = [f for f in kept if _is_declared_function(f) or (_is_of_time_alone(f) and is_analytic(f, [ex.TIME]))]
    return kept if sided else [f for f in kept if f not in at_instants] or kept


def _is_declared_function(e: Expr) -> bool:
    return all(part.op in ("call", "num") for part in (e.args if e.op == "mul" else (e,)))


def _is_of_time_alone(e: Expr) -> bool:
    return all(s.args[0] in ("time", "parameter") for s in e.symbols) and "call" not in e.functions


def _is_cone(e: Expr, positive: frozenset[Expr], engines: Engines) -> TraitAnswer:
    """Return whether the velocities with e = 0 form a cone: v . de/dv = 0 on e = 0 (Euler); then it is catastatic."""
    radial = ex.add(*(v * diff(e, v) for v in sorted(velocities_of(e), key=repr)))
    return (True, "proved") if _is_homogeneous(e) else vanishes_on(e, radial, positive, engines, velocities_of(e))


def vanishes_on(
    g: Expr, slope: Expr, positive: frozenset[Expr], engines: Engines = BOTH, regular_in: Sequence[Expr] | None = None
) -> TraitAnswer:
    """Return whether ``slope`` = 0 wherever g = 0, and how certain that is.

    ``slope`` is a derivative of g along a direction. With ``regular_in``, only points count at which g has a non-zero
    derivative by one of these symbols, because at singular points the slope is 0 in any case. True only if g is
    irreducible and analytic, since the random point lies on one factor, and on one branch of every root and sign.
    """
    if _is_multiple(slope, g, positive):
        return True, "proved"
    identical, sure = zero_and_verdict(slope, positive, engines)
    if identical:
        return (True, sure) if is_analytic(g, [ex.TIME], positive) else (None, "undecided")
    slopes = [diff(g, s) for s in sorted(regular_in or (), key=repr)]
    ring = Ring([g, slope, *slopes], positive)
    node, rate, *others = (ring.node(e) for e in (g, slope, *slopes))
    try:
        point = TriangularSolver(ring, [node]).draw(1) if "field" in engines else None
        at = [] if point is None else values(ring, point)
        if at and at[rate] == 0:
            regular = not others or any(at[k] != 0 for k in others)
            generic = regular and is_analytic(g, g.symbols, positive) and _is_irreducible(g, positive)
            return (True, "probable") if generic else (None, "undecided")
    except NoValueError:
        return None, "undecided"
    if "balls" not in engines:
        certain = point is not None and independent_on_set(ring, [node])
        return (False, "probable") if certain else (None, "undecided")
    real = _real_point(ring, node, g, positive)
    nonzero = real is not None and _is_nonzero(ring, real, rate, others)
    if real is not None and nonzero and real.certified:
        return False, "proved"
    return (False, "numeric") if point is not None and nonzero else (None, "undecided")


@false_without_value
def _is_multiple(slope: Expr, g: Expr, positive: frozenset[Expr]) -> bool:
    """Return whether the numerator of ``slope`` is a multiple of that of ``g``."""
    _, [(top, _), (other, _)] = quotients_of([slope, g], positive)
    return bool(other != 0 and top != 0 and divmod(top, other)[1] == 0)


@false_without_value
def _is_irreducible(g: Expr, positive: frozenset[Expr]) -> bool:
    """Return whether g's numerator is proved to be irreducible; False if it is too large to be factored.

    False also with roots of numbers, as x^2 + sqrt(2) x (1 - t) - 2 t is a product, but not over the rationals, and
    with sines and cosines: sin(x) + (1 - cos(x)) t is 2 sin(x/2) (cos(x/2) + t sin(x/2)).
    """
    canon, [(top, _)] = quotients_of([g], positive)
    generators = [canon.ring.vars[i] for i in canon.generators_in(top)]
    constants = [v for v in generators if not canon.ring.var_expr[v.index].symbols]
    hidden = any(v.kind in ("cos", "sin") for v in generators) or any(v.kind == "root" for v in constants)
    return not hidden and len(canon.factors(top)) == 1


def _real_point(ring: Ring, node: int, g: Expr, positive: frozenset[Expr]) -> RealPoint | None:
    """Return a real zero of g, at a random time if possible."""
    search = RealSearch(ring, [node], sorted(g.symbols - {ex.TIME}, key=repr), positive)
    real = search.search() or at_another_time(search)
    return real or RealSearch(ring, [node], sorted(g.symbols, key=repr), positive).search()


def _is_nonzero(ring: Ring, real: RealPoint, rate: int, others: list[int]) -> bool:
    """Return whether the node ``rate``, and one of ``others`` if there are any, is certainly not 0 at a real point."""
    at = values(ring, real.point)
    return not at[rate].contains(0) and (not others or any(not at[k].contains(0) for k in others))


def _is_homogeneous(e: Expr) -> bool:
    """Return whether an expression is, as written, homogeneous in the velocities."""
    try:
        differential_degree(substitute(e, {v: ex.differential(str(v.args[1])) for v in velocities_of(e)}))
    except TextError:
        return False
    return True


def exact(form: Pfaffian, positive: frozenset[Expr], engines: Engines = BOTH) -> TraitAnswer:
    """Return whether d(omega) = 0 in (q, t) for the form as written. x dy - y dx is integrable, but not closed."""
    sure: Verdict = "proved"
    for (s, a), (u, b) in combinations(form.components.items(), 2):
        closed, verdict = zero_and_verdict(diff(b, s) - diff(a, u), positive, engines)
        if not closed:
            return closed, verdict
        sure = weakest(sure, verdict)
    return True, sure


@dataclass(frozen=True)
class Integrability:
    """Whether a form is proved integrable, the reason as text, and the integrating factor and integral if found."""

    proved: bool
    reason: str = ""
    factor: str | None = None
    integral: str | None = None


def proved_integrability(form: Pfaffian, setting: Setting, alone: bool | None) -> Integrability:
    """Return the proof, if there is one, that a form is integrable on its own; without one it may still be.

    ``alone``: whether it is so at random points, None if undecided. An integral is searched for only with a proof, or
    if ``alone`` is True; if it is False nothing is tried.
    """
    if alone is False:
        return Integrability(False)
    positive = setting.positive
    reason = proof(form, positive)
    plain = bool(form.coefficients) and not odd_constants(_ring(form, positive))
    antiderivative = search.integrate(form, positive, setting.reference) if plain and (reason or alone) else None
    if antiderivative is not None:
        return Integrability(True, "an integral was found and checked", antiderivative.factor, antiderivative.integral)
    return Integrability(reason is not None, reason or "")


def _ring(form: Pfaffian, positive: frozenset[Expr]) -> Ring:
    """Return a ring with the coefficients of the form."""
    ring = Ring([e for _, e in form.items()], positive)
    for _, e in form.items():
        ring.node(e)
    return ring


def proof(form: Pfaffian, positive: frozenset[Expr]) -> str | None:
    """Return the reason why the form is integrable on its own, or None where that is not proved."""
    if exact(form, positive) == (True, "proved"):  # [PoincareLemma]
        return "it is closed, so locally it is the differential of a function"
    if len(form.components) <= 2:  # [Frobenius1877]
        return "a form in two variables is always integrable"
    if len(dict(form.items())) <= 5 and all(zero == (True, "proved") for zero in _curvature(form, positive)):
        return "d(omega) ^ omega = 0 identically"
    return None


def is_curved(form: Pfaffian, setting: Setting) -> bool:
    """Return whether d(omega) ^ omega is proved non-zero on an open dense set, so the form alone is not integrable."""
    analytic = all(is_analytic(e, e.symbols, setting.positive) for _, e in form.items())
    return analytic and setting.engines == BOTH and (False, "proved") in _curvature(form, setting.positive)


def _curvature(form: Pfaffian, positive: frozenset[Expr]) -> Iterator[TraitAnswer]:
    """Yield for every component of d(omega) ^ omega whether it is 0 [Frobenius1877]."""
    for (s, a), (u, b), (w, c) in combinations(form.components.items(), 3):
        total = a * (diff(c, u) - diff(b, w))
        total += b * (diff(a, w) - diff(c, s))
        total += c * (diff(b, s) - diff(a, u))
        yield zero_and_verdict(total, positive)
