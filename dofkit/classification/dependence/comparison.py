"""Comparisons of submitted constraints with wanted ones: multiples, gradients on the same set, inequalities.

Two equations are equivalent if one is a number times the other. This is tested only for polynomials in coordinates,
parameters, sines, cosines and exponentials: a root or a quotient may have no value where its multiple has one.
a sqrt(P) + b = 0 is the branch a b <= 0 of b^2 = a^2 P, and equivalent to it if other constraints imply a b <= 0.
"""

from __future__ import annotations

import random
from collections.abc import Iterable, Iterator, Sequence
from dataclasses import dataclass
from fractions import Fraction
from itertools import chain
from itertools import product as cartesian

from flint import arb

from dofkit.base.errors import NoValueError
from dofkit.classification.dependence.implication import follows
from dofkit.configuration.search import find
from dofkit.configuration.variety import field_jacobian
from dofkit.exact.matrices.certified import ball_part
from dofkit.exact.matrices.sparse import rank_of_rows
from dofkit.exact.points.balls import BallPoint, jacobian
from dofkit.exact.points.real_search import RealSearch
from dofkit.exact.ring.canonical import quotients_of
from dofkit.exact.ring.program import POW, false_without_value, none_without_value, values
from dofkit.exact.ring.ring import Ring
from dofkit.exact.zero import is_proved_zero
from dofkit.expressions import tree as ex
from dofkit.expressions.calculus import diff, in_velocities, replace_nodes, substitute
from dofkit.expressions.real_values import Requirement
from dofkit.expressions.tree import HALF, MINUS_ONE, ZERO, Expr
from dofkit.relations.blocks import NOBODY, Block, Row, make_chart, split
from dofkit.relations.normal.normal_form import velocities_of
from dofkit.relations.normal.pieces import Finite, Inequality, Nonlinear, Normal, Pfaffian, Piece, Reduced
from dofkit.relations.normal.polynomial_zeros import EXPONENT_NOTE, POWER_NOTE, SQUARES_NOTE
from dofkit.relations.setting import Setting
from dofkit.relations.velocity_reductions import eliminated

#: Generators of a ring that have a value everywhere.
_ENTIRE = frozenset({"symbol", "cos", "sin", "exp", "pi"})


def same_up_to_numbers(submitted: Sequence[Reduced], wanted: Sequence[Reduced], positive: frozenset[Expr]) -> bool:
    """Return whether every submitted equation, as written, is a number times a wanted one, and every wanted one occurs.

    True proves that the sets are equivalent and equally regular; False: not proved.
    """
    if _as_written(submitted) == _as_written(wanted):
        return True
    wanted_terms = [_terms(n) for r in wanted for n in r.normals]
    submitted_terms = [terms for r in submitted for terms in _written(r)]
    if not submitted_terms or [] in wanted_terms or [] in submitted_terms:
        return False
    table = [[_proportional(terms, other, positive) for other in wanted_terms] for terms in submitted_terms]
    return all(map(any, table)) and all(any(row[k] for row in table) for k in range(len(wanted_terms)))


def _as_written(constraints: Sequence[Reduced]) -> set[tuple[frozenset[Expr], frozenset[Requirement]]]:
    """Return the equations e = 0 as ({e, -e}, conditions for a value of e)."""
    relations = (e for r in constraints for e in r.constraint.relations)
    return {(frozenset((e.expr, -e.expr)), frozenset(e.domain)) for e in relations}


def _entire(ring: Ring) -> bool:
    """Return whether all nodes of a ring have a value everywhere."""
    kinds = {var.kind for var in ring.vars}
    return kinds <= _ENTIRE and not any(op == POW and p[1] < 0 for op, p in ring.code)


def _written(r: Reduced) -> list[list[tuple[str, Expr]]]:
    """Return `_terms` of each equation of a constraint; [[]] if any equation was changed by its normal form."""
    if len(r.normals) != len(r.constraint.relations) or any(n.notes for n in r.normals):
        return [[]]
    return [_terms(n) for n in r.normals]


def _terms(normal: Normal) -> list[tuple[str, Expr]]:
    """Return [("", g)] for g = 0, the (coordinate, coefficient) pairs of a form; [] for branches and conditions."""
    if len(normal.branches) != 1 or len(normal.branches[0]) != 1:
        return []
    (piece,) = normal.branches[0]
    if isinstance(piece, Finite):
        return [("", piece.expr)]
    if type(piece) is Pfaffian:
        return [*sorted(piece.coefficients.items()), ("dt", piece.dt)]
    return []


@false_without_value
def _proportional(a: Sequence[tuple[str, Expr]], b: Sequence[tuple[str, Expr]], positive: frozenset[Expr]) -> bool:
    """Return whether a_i = c b_i identically for one number c other than 0; proved in the canonical ring."""
    first, second = dict(a), dict(b)
    names = sorted(first.keys() | second.keys())
    canon, quotients = quotients_of([form.get(name, ZERO) for name in names for form in (first, second)], positive)
    tops = [top for top, _ in quotients]
    result = list(zip(tops[::2], tops[1::2], strict=True))
    if not _entire(canon.ring) or any((x == 0) != (y == 0) for x, y in result):
        return False
    leading = [(x.leading_coefficient(), y.leading_coefficient()) for x, y in result if x != 0]
    return all(x * d == y * c for x, y in result for c, d in leading[:1])


#: Bound on the choices of branches on which gradients are compared.
MAX_BRANCHES = 16


@dataclass(frozen=True)
class Regularity:
    """Submitted constraints with the same solutions as the wanted ones, together with the ``others``."""

    others: Sequence[Normal]
    wanted: Sequence[Reduced]
    submitted: Sequence[Reduced]
    setting: Setting
    coordinates: Sequence[str]

    def irregular(self) -> bool | None:
        """Return whether submitted gradients lose rank where wanted ones do not; None if undecided."""
        submitted, wanted = ([n for r in some for n in r.normals] for some in (self.submitted, self.wanted))
        nonlinear = any(isinstance(p, Nonlinear) for n in (*submitted, *wanted) for p in n.pieces)
        if _is_power(submitted, nonlinear) and not _is_power(wanted, nonlinear):
            return True
        if any(isinstance(p, Pfaffian) for n in (*submitted, *wanted) for p in n.pieces):
            choices = list(cartesian(*(n.branches for n in wanted if n.branches)))[:MAX_BRANCHES]
            return any(self._flat(self.submitted, c) and not self._flat(self.wanted, c) for c in choices)
        branches = list(cartesian(*(n.branches for n in (*self.others, *wanted) if n.branches)))
        regular = {self._as_regular(choice) for choice in branches[:MAX_BRANCHES]}
        if False in regular:
            return True
        return None if None in regular or len(branches) > MAX_BRANCHES else False

    def _as_regular(self, choice: Sequence[Sequence[Piece]]) -> bool | None:
        """Return whether the submitted gradients have at least the rank of the wanted ones on one branch, or None."""
        finite = [[p for p in branch if isinstance(p, Finite)] for branch in choice]
        others = len([n for n in self.others if n.branches])
        before = [p.expr for branch in finite[:others] for p in branch]
        wanted = [p.expr for branch in finite[others:] for p in branch]
        if not wanted:
            return True
        raw, raw_wanted = (
            [e.expr for r in some for e in r.constraint.relations] for some in (self.submitted, self.wanted)
        )
        ranks = self._ranks([*chain(*finite)], [*before, *raw], [*before, *wanted])
        if ranks is not None and ranks[0] < ranks[1]:  # the wanted equations as written may lose rank here too
            ranks = self._ranks([*chain(*finite)], [*before, *raw], [*before, *raw_wanted])
        return None if ranks is None else ranks[0] >= ranks[1]

    def _flat(self, some: Sequence[Reduced], choice: Sequence[Sequence[Piece]]) -> bool:
        return any(_is_flat(r, choice, self.setting.positive) for r in some)

    @none_without_value
    def _ranks(self, on: Sequence[Finite], *sets: Sequence[Expr]) -> list[int] | None:
        """Return the ranks of the gradients of sets of expressions at a generic point of ``on`` = 0; None if none."""
        blocks, _ = split(self.coordinates, [Row(NOBODY, p) for p in on])
        rows = tuple(row for b in blocks for row in b.rows)
        joined = Block(tuple(n for n in self.coordinates if any(n in b.coordinates for b in blocks)), rows)
        chart = make_chart(joined, self.setting, more=list(chain(*sets)))
        result = find(chart, {}, 7)
        nodes = [[chart.ring.node(e) for e in s] for s in sets]
        if result.samples:
            point = result.samples[0]
            return [rank_of_rows(field_jacobian(chart, point, some), point.p) for some in nodes]
        if result.real is None or not result.real.certified:
            return None
        real, columns = result.real.point, [c for c in chart.columns if c >= 0]
        at = values(chart.ring, real)
        slopes = [jacobian(chart.ring, at, real, some, columns, arb(0)) for some in nodes]
        return [ball_part(j).rank for j in slopes]


def _is_power(normals: Sequence[Normal], nonlinear: bool) -> bool:
    """Return whether a relation was a power or a sum of squares, in exponentials or ``nonlinear`` in the velocities.

    Gradients of such relations are not compared at points.
    """
    powers = [n for n in normals if not {POWER_NOTE, SQUARES_NOTE}.isdisjoint(n.notes)]
    return any(nonlinear or EXPONENT_NOTE in n.notes for n in powers)


def _is_flat(r: Reduced, choice: Sequence[Sequence[Piece]], positive: frozenset[Expr]) -> bool:
    """Return whether the derivatives of relations by all velocities are 0 (as a square's are), or have no value.

    They are taken where the forms of a choice of branches are 0.
    """
    written = [in_velocities(e.expr)[0] for e in r.constraint.relations]
    slopes = [diff(e, v) for e in written for v in velocities_of(e)]
    if not slopes:
        return False
    try:
        forms = [p.rate for branch in choice for p in branch if isinstance(p, Pfaffian)]
        return all(is_proved_zero(eliminated(e, forms)[0], positive) for e in slopes)
    except NoValueError:
        return True


#: Number of random points at which signs are compared, and the sizes of their values.
POINTS, SCALES = 24, (1, 1, 10, 1000)
#: Near the boundaries: number of points for each small value of one of the two expressions, and these values.
NEAR, SHIFTS = 2, tuple(Fraction(sign, 10**digits) for digits in (2, 15) for sign in (1, -1))


def same_side(a: Inequality, b: Inequality, others: Sequence[Normal], setting: Setting) -> bool | None:
    """Return whether a >= 0 and b >= 0 are equivalent at all configurations that the others allow; None if undecided.

    False if the signs differ at some point; True if they agree at all random points, some near the boundaries, and the
    boundaries are the same sets. None if only the boundaries differ (x >= 0 and x (x - 1)^2 >= 0), or whether they are
    included. If the others allow the boundary only, they are ignored.
    """
    if a == b:
        return True
    finite = [p.expr for n in others for p in n.pieces if isinstance(p, Finite)]
    signs = list(_signs(a.expr, b.expr, finite, setting))
    if not signs and others:
        return same_side(a, b, (), setting)
    near = (x.expr - ex.num(shift) for x in (a, b) for shift in SHIFTS)
    close = (pair for g in near for pair in _signs(a.expr, b.expr, [*finite, g], setting, NEAR))
    if any(first != other for first, other in chain(signs, close)):
        return False
    same_boundary = [follows(_boundary(x), [*others, _boundary(y)], setting) for x, y in ((a, b), (b, a))]
    return True if signs and all(same_boundary) and a.strict == b.strict else None


def _boundary(q: Inequality) -> Normal:
    return Normal(((Finite(q.expr),),))


def _signs(
    a: Expr, b: Expr, finite: Sequence[Expr], setting: Setting, points: int = POINTS
) -> Iterator[tuple[bool, bool]]:
    """Yield (a > 0, b > 0) at random points with ``finite`` = 0 at which both signs are certain."""
    ring = Ring([a, b, *finite], setting.positive, {})
    nodes = [ring.node(g) for g in finite]
    first, second = ring.node(a), ring.node(b)
    symbols = sorted({s for e in (a, b, *finite) for s in e.symbols}, key=repr)
    for k in range(points):
        point = _point(ring, nodes, symbols, setting, k)
        try:
            at = None if point is None else values(ring, point)
        except (NoValueError, OverflowError, ValueError):
            continue
        if at is not None and not at[first].contains(0) and not at[second].contains(0):
            yield bool(at[first] > 0), bool(at[second] > 0)


def _point(ring: Ring, nodes: Sequence[int], symbols: Sequence[Expr], setting: Setting, seed: int) -> BallPoint | None:
    """Return a certified real zero of the nodes, or a random point if there are no nodes; None if none is found."""
    if nodes:
        moving = [s for s in symbols if s.args[0] != "parameter"]
        result = RealSearch(ring, nodes, moving, setting.positive).search(seed)
        return None if result is None or not result.certain else result.point
    rng = random.Random(f"dofkit side {seed}")
    scale = SCALES[seed % len(SCALES)]

    def random_value(s: Expr) -> arb:
        size = rng.randint(1, 2**20)
        number = arb(size if s in setting.positive or rng.random() < 0.5 else -size) / 2**19
        return number if s.args[0] == "parameter" else number * scale

    return BallPoint({s: random_value(s) for s in symbols}, seed)


_ROOT = ex.parameter("value of a root")


def bounds(wanted: Sequence[Normal], others: Sequence[Reduced]) -> list[Inequality]:
    """Return the inequalities of ``others`` that mention a coordinate of the wanted geometric equations."""
    symbols = {s for n in wanted for p in n.pieces if isinstance(p, Finite) for s in p.expr.symbols}
    moving = {s for s in symbols if s.args[0] == "coordinate"}
    return [q for r in others for q in r.inequalities if moving & q.expr.symbols]


def unsound(submitted: Sequence[Reduced], sound: Sequence[bool | None]) -> list[Expr]:
    """Return the submitted expressions that are not ``sound`` (implied); none if there is not one for each relation."""
    written = [relation.expr for r in submitted for relation in r.constraint.relations]
    return [e for e, s in zip(written, sound, strict=True) if not s] if len(written) == len(sound) else []


def loses_nothing(
    e: Expr, wanted: Sequence[Normal], others: Sequence[Normal], sides: Iterable[Inequality], setting: Setting
) -> bool:
    """Return whether e = 0, with one root, is equivalent to ``wanted`` given the inequalities; False: not proved."""
    rooted = _by_root(e)
    if rooted is None:
        return False
    a, b, under = rooted
    squared = Normal(((Finite(b * b - a * a * under),),))
    if follows(squared, [*others, *wanted], setting) is not True:
        return False
    allowed = Inequality(ex.mul(MINUS_ONE, a, b))
    return any(same_side(allowed, side, others, setting) for side in sides)


def _by_root(e: Expr) -> tuple[Expr, Expr, Expr] | None:
    """Return (a, b, P) for e = a sqrt(P) + b with no other root; None if e is not so."""
    roots = {n for n in ex.nodes(e) if n.op == "pow" and n.args[1] == HALF}
    if len(roots) != 1:
        return None
    (root,) = roots
    named = replace_nodes(e, {root: _ROOT})
    slope = diff(named, _ROOT)
    if _ROOT in slope.symbols or slope.is_zero:
        return None
    return slope, substitute(named, {_ROOT: ZERO}), root.args[0]
