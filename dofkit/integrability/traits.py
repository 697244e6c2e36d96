"""Labels that one piece carries by itself: scleronomic, catastatic, exact."""

from __future__ import annotations

import random
from collections.abc import Callable
from fractions import Fraction
from itertools import combinations

from dofkit.base.records import dataclass
from dofkit.base.verdicts import VERDICTS, Verdict, weakest
from dofkit.exact.engines import BOTH, Engines
from dofkit.exact.errors import NoValueError
from dofkit.exact.points.real_search import RealSearch, at_another_time
from dofkit.exact.ring.canonical import Canon
from dofkit.exact.ring.program import values
from dofkit.exact.ring.ring import Ring
from dofkit.exact.solving.triangular import TriangularSolver
from dofkit.exact.zero.identity import is_proved_zero, zero_and_verdict
from dofkit.exact.zero.independence import independent_on_set
from dofkit.expressions import tree as ex
from dofkit.expressions.calculus import diff
from dofkit.expressions.enclosures import interval_of
from dofkit.expressions.tree import Expr
from dofkit.relations.normal.no_solution import no_solution
from dofkit.relations.normal.normal_form import velocities_of
from dofkit.relations.normal.pieces import Finite, Inequality, Pfaffian, Piece
from dofkit.relations.normal.zero_set import never_vanishes

TraitAnswer = tuple[bool | None, Verdict]

#: Points at which a degree is read off, the largest denominator that it has, and how close it comes.
DRAWS, MAX_DEGREE, CLOSE = 8, 64, 1e-9


@dataclass(frozen=True)
class Traits:
    """The labels of one piece; ``catastatic`` and ``exact`` are None for what is not Pfaffian."""

    scleronomic: TraitAnswer
    catastatic: TraitAnswer | None = None
    exact: TraitAnswer | None = None


def traits(piece: Piece, positive: frozenset[Expr], engines: Engines = BOTH, opened: bool = False) -> Traits:
    """All labels that a piece carries by itself; ``opened``: its differential is known not to be 0."""
    still = scleronomic(piece, positive, engines)
    if not isinstance(piece, Pfaffian):
        return Traits(still)
    closed: TraitAnswer = (False, "proved") if opened else exact(piece, positive, engines)
    return Traits(still, catastatic(piece, positive, engines), closed)


def scleronomic(piece: Piece, positive: frozenset[Expr], engines: Engines = BOTH) -> TraitAnswer:
    """Time enters neither as t nor as dt, once factors that never vanish are taken out."""
    if isinstance(piece, Pfaffian):
        return _pfaffian_without_time(piece, positive, engines)
    if isinstance(piece, Inequality):
        return _inequality_without_time(piece.expr, positive)
    if isinstance(piece, Finite):
        return _finite_without_time(piece.expr, positive, engines)
    return _nonlinear_without_time(piece.expr, positive, engines)


def _inequality_without_time(g: Expr, positive: frozenset[Expr]) -> TraitAnswer:
    """False is proved by a point on the boundary at which dg/dt is not 0: there the boundary moves."""
    if _factors_without_time(g, positive, never_vanishes):
        return True, "proved"
    if _moves(g, positive):
        return False, "proved"
    return (True, "proved") if _factors_without_time(g, positive, _has_no_zero) else (None, "undecided")


def _nonlinear_without_time(e: Expr, positive: frozenset[Expr], engines: Engines) -> TraitAnswer:
    """Neither t nor a hidden dt: on e = 0 both de/dt and v . de/dv vanish (Euler: the set is a cone in v)."""
    moving = sorted(velocities_of(e), key=repr)
    radial = ex.add(*(v * diff(e, v) for v in moving))
    cone: TraitAnswer = (True, "proved") if _homogeneous(e, radial) else _vanishes_on(e, radial, positive, engines)
    parts = [_finite_without_time(e, positive, engines), cone]
    if any(holds is False for holds, _ in parts):
        return False, min((sure for holds, sure in parts if holds is False), key=VERDICTS.index)
    return (None, "undecided") if any(holds is None for holds, _ in parts) else (True, weakest(*(s for _, s in parts)))


def _finite_without_time(g: Expr, positive: frozenset[Expr], engines: Engines) -> TraitAnswer:
    """dg/dt = 0 on g = 0. A point where it is not is found much sooner than it is proved that a factor has no zero."""
    if ex.TIME not in g.symbols or _factors_without_time(g, positive, never_vanishes):
        return True, "proved"
    found = _vanishes_on(g, diff(g, ex.TIME), positive, engines)
    if found[1] == "proved":
        return found
    return (True, "proved") if _factors_without_time(g, positive, _has_no_zero) else found


def _vanishes_on(g: Expr, slope: Expr, positive: frozenset[Expr], engines: Engines) -> TraitAnswer:
    """Is ``slope`` = 0 wherever g = 0? A certified point where it is not is a proof that it is not."""
    still, sure = zero_and_verdict(slope, positive, engines)
    if still:
        return True, sure
    ring = Ring([g, slope], positive)
    node, rate = ring.node(g), ring.node(slope)
    point = TriangularSolver(ring, [node]).draw(1) if "field" in engines else None
    if point is not None:
        try:
            if values(ring, point)[rate] == 0:
                return True, "probable"
        except NoValueError:
            return None, "undecided"
    if "balls" not in engines:
        known = point is not None and independent_on_set(ring, [node])
        return (False, "probable") if known else (None, "undecided")
    search = RealSearch(ring, [node], sorted(g.symbols - {ex.TIME}, key=repr), positive)
    real = search.search() or at_another_time(search)
    if real is None:
        real = RealSearch(ring, [node], sorted(g.symbols, key=repr), positive).search()
    apart = real is not None and not values(ring, real.point)[rate].contains(0)
    if real is not None and apart and real.certified:
        return False, "proved"
    if "field" not in engines:
        return (True, "numeric") if real is not None and real.certified else (None, "undecided")
    return (False, "numeric") if point is not None and apart else (None, "undecided")


def _moves(g: Expr, positive: frozenset[Expr]) -> bool:
    """Is there a certified zero of g at which dg/dt is not 0? False says nothing."""
    slope = diff(g, ex.TIME)
    ring = Ring([g, slope], positive)
    node, rate = ring.node(g), ring.node(slope)
    try:
        real = RealSearch(ring, [node], sorted(g.symbols, key=repr), positive).search()
        return real is not None and real.certified and not values(ring, real.point)[rate].contains(0)
    except (NoValueError, OverflowError, ValueError):
        return False


def _factors_without_time(
    e: Expr, positive: frozenset[Expr], without_zero: Callable[[Expr, frozenset[Expr]], bool]
) -> bool:
    """True where time is left in no factor that can vanish (the numerator's, over the rationals); False: not known."""
    if ex.TIME not in e.symbols:
        return True
    try:
        ring = Ring([e], positive)
        node = ring.node(e)
        canon = Canon(ring)
        factors = canon.factors(canon.quotient(node)[0])
        shown = [canon.to_expr(f) for f, _ in factors]
    except NoValueError:
        return False
    return all(ex.TIME not in f.symbols or without_zero(f, positive) for f in shown)


def _pfaffian_without_time(form: Pfaffian, positive: frozenset[Expr], engines: Engines) -> TraitAnswer:
    still, sure = zero_and_verdict(form.dt, positive, engines)
    if not still:
        return still, sure
    coefficients = list(form.coefficients.values())
    if all(ex.TIME not in e.symbols for e in coefficients):
        return True, sure
    turning = [a * diff(b, ex.TIME) - b * diff(a, ex.TIME) for a, b in combinations(coefficients, 2)]
    told = [zero_and_verdict(e, positive, engines) for e in turning]
    if any(zero is False for zero, _ in told):
        return False, min((v for zero, v in told if zero is False), key=VERDICTS.index)
    if not all(zero for zero, _ in told):
        return None, "undecided"
    still = _common_factor_without_zeros(coefficients, positive)
    return (None, "undecided") if still is None else (still, weakest(sure, *(v for _, v in told)))


def _common_factor_without_zeros(coefficients: list[Expr], positive: frozenset[Expr]) -> bool | None:
    """The direction does not turn: is the factor that carries the time free of zeros? None: not known."""
    try:
        ring = Ring(coefficients, positive)
        nodes = [ring.node(e) for e in coefficients]
        canon = Canon(ring)
        common = canon.quotient(nodes[0])[0]
        for node in nodes[1:]:
            common = common.gcd(canon.quotient(node)[0])
        shown = [canon.to_expr(f) for f, _ in canon.factors(common)]
    except NoValueError:
        return None
    timed = [f for f in shown if ex.TIME in f.symbols and not _of_time_alone(f) and not _has_no_zero(f, positive)]
    if not timed:
        return True
    return False if any(_moves(f, positive) for f in timed) else None


def _has_no_zero(e: Expr, positive: frozenset[Expr]) -> bool:
    """Is it proved that ``e`` vanishes at no real point?"""
    return never_vanishes(e, positive) or no_solution([e], positive)


def _of_time_alone(e: Expr) -> bool:
    """A known function of time: it vanishes at single instants only, and between them the constraint is the same."""
    return all(s.args[0] in ("time", "parameter") for s in e.symbols) and all(n.op != "call" for n in ex.nodes(e))


def _homogeneous(e: Expr, radial: Expr) -> bool:
    """Euler's relation ``radial`` = v . de/dv = k e for some k, which is read off at a random point."""
    degree = _ratio(radial, e)
    return degree is not None and is_proved_zero(radial - ex.num(degree) * e, frozenset())


def _ratio(a: Expr, b: Expr) -> Fraction | None:
    """A rational number of small denominator that a/b is close to at a random point; None where there is none."""
    symbols = sorted(a.symbols | b.symbols, key=repr)
    rng = random.Random("dofkit degree")
    for _ in range(DRAWS):
        point = {s: Fraction(rng.randrange(64, 257), 97) for s in symbols}
        above, below = interval_of(a, point), interval_of(b, point)
        if above is None or below is None or below.contains(0):
            continue
        value = float((above / below).mid())
        near = Fraction(value).limit_denominator(MAX_DEGREE)
        return near if abs(value - near) < CLOSE else None
    return None


def catastatic(form: Pfaffian, positive: frozenset[Expr], engines: Engines = BOTH) -> TraitAnswer:
    """No dt term."""
    return zero_and_verdict(form.dt, positive, engines)


def exact(form: Pfaffian, positive: frozenset[Expr], engines: Engines = BOTH) -> TraitAnswer:
    """Closed as written: d(omega) = 0 in (q, t). Not integrability: x dy - y dx integrates and is not closed."""
    items = list(form.items())
    symbols = dict(items)
    others = {s for _, e in items for s in e.symbols if s.args[0] in ("coordinate", "time")} - set(symbols)
    everything = [*items, *((s, ex.ZERO) for s in others)]
    sure: Verdict = "proved"
    for (s, a), (u, b) in combinations(everything, 2):
        closed, verdict = zero_and_verdict(diff(b, s) - diff(a, u), positive, engines)
        if not closed:
            return closed, verdict
        sure = weakest(sure, verdict)
    return True, sure
