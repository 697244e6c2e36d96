"""The special cases of a small scene: confirmed, and described in a sentence."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from contextlib import suppress
from dataclasses import replace
from typing import Any, NamedTuple

from flint import arb, ctx

from dofkit.base.deadline import OutOfTimeError, expired, limited
from dofkit.base.verdicts import Verdict, weakest
from dofkit.base.wording import many, verb
from dofkit.classification.freedom.branches import Outcome
from dofkit.classification.special.minors import Candidates, Locus, candidates
from dofkit.classification.study import Study
from dofkit.configuration.variety import on_variety
from dofkit.exact.matrices.certified import ball_part
from dofkit.exact.matrices.sparse import rank_of
from dofkit.exact.points.balls import PRECISION, BallPoint
from dofkit.exact.points.field import FieldPoint
from dofkit.exact.points.frames import field_frame
from dofkit.exact.points.real_search import RealSearch
from dofkit.exact.residues import null_vectors, residue, residue_matrix
from dofkit.exact.ring.program import raising_no_value, values
from dofkit.exact.triangular import TriangularSolver
from dofkit.expressions import tree as ex
from dofkit.expressions.calculus import substitute
from dofkit.expressions.text import to_text
from dofkit.expressions.tree import Expr
from dofkit.integrability.growth_vector import growth_at
from dofkit.integrability.pfaffian_system import codistribution
from dofkit.relations.answer import Answer
from dofkit.relations.blocks import Block, Chart, expressions
from dofkit.relations.normal.pieces import Finite, Reduced
from dofkit.relations.normal.semidefinite import never_holds
from dofkit.report import Report, SpecialCase
from dofkit.system import Constraint, Coordinate, Relation, System, TypeFacts

#: Starts and steps of the search for a real point of a locus; few are enough if it is regular.
STARTS, STEPS = 2, 14


def points_of(chart: Chart) -> tuple[FieldPoint, BallPoint, bool] | None:
    """Return (random point of a locus over GF(p), certified real point, regular); None if a search fails.

    ``regular``: the equations are independent at the real point, so that it exists for certain.
    """
    solver = TriangularSolver(chart.ring, chart.nodes, seed=1)
    random_point = solver.draw(1)
    if random_point is None or not on_variety(chart, random_point):
        return None
    search = RealSearch(chart.ring, chart.nodes, chart.unknowns, chart.setting.positive)
    real = search.search(starts=STARTS, steps=STEPS)
    if real is None or not real.certain:
        return None
    return random_point, real.point, real.part.rank == len(chart.nodes)


class RowsOnLocus(NamedTuple):
    """A block's rows at points of a locus.

    ``rank`` in the coordinates' columns; ``moves``: False if no velocity satisfies them (dt is in their span);
    ``dependent``: the constraints whose rows, independent elsewhere, are dependent there; ``regular``: the locus is
    proved to have real points; ``growth``: dimensions of D, D + [D, D], ..., as far as they are certain.
    """

    rank: int
    moves: bool
    dependent: tuple[int, ...]
    regular: bool
    growth: tuple[int, ...] = ()


def _dependent(block: Block, a: Answer, matrix: Sequence[Sequence[Any]], p: int) -> tuple[int, ...]:
    """Return the constraints whose rows, independent at generic points, are dependent in ``matrix``, modulo p."""
    n = len(matrix[0])
    chosen: Sequence[int] = range(len(matrix))
    if len(a.matrix) == len(matrix):
        elsewhere = [[residue(row.get(c, 0), a.modulus) for c in range(n)] for row in a.matrix]
        chosen = field_frame(elsewhere, n, a.modulus).rows
    vectors = null_vectors(residue_matrix([[int(matrix[r][c]) for r in chosen] for c in range(n)], p))
    first, forms = len(block.finite), [r.constraint for r in block.rows]
    owners = [*forms[:first], *(None for _ in a.hidden), *forms[first:]]
    dependent = {owners[r] for i, r in enumerate(chosen) if any(vector[i] for vector in vectors)}
    return tuple(sorted(owner for owner in dependent if owner is not None))


#: Bound on the expressions h for which the set h != 0 is analysed.
MAX_EXPRESSIONS = 4
_RECIPROCAL = "_reciprocal"

Reclassify = Callable[[System], Study]


def branch_dimensions(study: Study, report: Report, reclassify: Reclassify) -> Iterator[SpecialCase]:
    """Yield the branch h = 0 to which the degrees of freedom belong, if the set h != 0 is proved to have fewer."""
    system, claim = study.system, report.verdicts.get("dof")
    if system.reference is not None or not report.dof or claim is None or claim.about == "component":
        return
    for h in list(dict.fromkeys(_separating(study.reduced, study.outcome)))[:MAX_EXPRESSIONS]:
        if expired():
            return
        remainder = reclassify(where_nonzero(system, h))
        dof, elsewhere = remainder.outcome.dof, remainder.free
        if dof is None or elsewhere.about == "component" or not remainder.outcome.consistent:
            continue
        sure = weakest(claim.verdict, elsewhere.verdict)
        if dof < report.dof and sure != "undecided":
            text = to_text(ex.add(*_in_order(h, system)))
            concerned = (c for c in system.constraints if any(h.symbols & r.expr.symbols for r in c.relations))
            yield SpecialCase(
                where=f"{text} = 0",
                kind="branch",
                what=f"only this branch has {many(report.dof, 'degree')} of freedom; "
                f"where {text} is not 0 there {verb(dof)} {dof}",
                constraints=[c.name for c in concerned],
                verdict=sure,
            )
            return


def where_nonzero(system: System, h: Expr) -> System:
    """Return the system on the set h != 0, written u h = 1 with a new coordinate u [Rabinowitsch1929]."""
    reciprocal = Relation(ex.coordinate(_RECIPROCAL) * h - ex.ONE)
    facts = TypeFacts(written=True)
    condition = Constraint(_RECIPROCAL, _RECIPROCAL, facts, f"{to_text(h)} != 0", (reciprocal,))
    return replace(
        system,
        coordinates=(*system.coordinates, Coordinate(_RECIPROCAL)),
        constraints=(*system.constraints, condition),
    )


def _separating(reduced: Sequence[Reduced], outcome: Outcome) -> Iterator[Expr]:
    """Yield expressions that vanish on the branch that was analysed, and may not vanish on others."""
    for h in [*_factors(reduced, outcome), *(h for a in outcome.answers for h in a.separating)]:
        yield ex.number_and_rest(h)[1]


def _factors(reduced: Sequence[Reduced], outcome: Outcome) -> list[Expr]:
    """Return the factors of products that are zero on the branch that was analysed."""
    products = [n for r in reduced for n in r.normals if len(n.branches) > 1]
    factors = {p.expr for n in products for branch in n.branches for p in branch if isinstance(p, Finite)}
    return [r.piece.expr for r in outcome.rows if isinstance(r.piece, Finite) and r.piece.expr in factors]


def _in_order(e: Expr, system: System) -> list[Expr]:
    """Return the terms of a sum in the order in which their symbols are declared."""
    declared = [*map(ex.parameter, system.parameters), *(ex.coordinate(c.name) for c in system.coordinates)]
    place = {s: i for i, s in enumerate(declared)}
    terms: Sequence[Expr] = e.args if e.op == "add" else (e,)
    return sorted(terms, key=lambda term: min((place.get(s, len(place)) for s in term.symbols), default=len(place)))


#: Bounds on the rows, coordinates and terms of a block that is searched, and on the blocks of a scene.
MAX_ROWS, MAX_COLUMNS, MAX_TERMS, MAX_BLOCKS = 6, 10, 20, 12
#: Bound on the loci of each kind that are tested for a block, and seconds for the scene.
MAX_PLACES, MAX_SECONDS = 6, 10.0
SEARCHED = "special cases by the zeros of minors and of curvature"

_UNFINISHED = (ArithmeticError, ValueError, OutOfTimeError)


def special_cases(study: Study, report: Report, reclassify: Reclassify) -> dict[str, Any]:
    """Return the report's fields ``special_cases``, and ``method`` with a remark if they were searched.

    ``report``: the answer for generic configurations; ``reclassify`` analyses another system.
    """
    if study.setting.tolerance is not None or len(study.outcome.blocks) > MAX_BLOCKS:
        return {}
    cases, searched = list[SpecialCase](), False
    with limited(MAX_SECONDS):
        with suppress(*_UNFINISHED):
            cases.extend(branch_dimensions(study, report, reclassify))
        for block, a in zip(study.outcome.blocks, study.outcome.answers, strict=True):
            if _is_small(block, a) and _is_plain(block, study) and not expired():
                with suppress(*_UNFINISHED):
                    search = SpecialLoci(study, report, block, a)
                    searched = True
                    cases.extend(search.cases())
    changed: dict[str, Any] = {"special_cases": cases} if cases or searched else {}
    return {**changed, "method": f"{report.method}; {SEARCHED}"} if searched else changed


def _is_small(block: Block, a: Answer) -> bool:
    """Return whether a block has few short rows, all linear in the velocities, and a regular answer."""
    return (
        len(block.rows) + len(a.hidden) <= MAX_ROWS
        and len(block.coordinates) <= MAX_COLUMNS
        and sum(len(e.args) if e.op == "add" else 1 for e in expressions(block)) <= MAX_TERMS
        and not block.nonlinear
        and not a.degenerate
        and a.velocity_dof is not None
    )


def _is_plain(block: Block, study: Study) -> bool:
    """Return whether a block is as written: no Gibbs vectors, no unnamed parameters, no divided relation.

    Geometric equations with a reference configuration do not count either.
    """
    system, outcome = study.system, study.outcome
    divided = {reduced.written.constraint for reduced in outcome.reduced if outcome.divided}
    if not divided.isdisjoint(row.constraint for row in block.rows):
        return False
    turning = {name for r in system.rotations if r.chart == "gibbs" for name in r.names}
    if not turning.isdisjoint(block.coordinates) or (system.reference is not None and not block.forms):
        return False
    generic = {ex.parameter(p) for p in system.generic}
    system_names = {c.name for c in system.coordinates}
    return system_names.issuperset(block.coordinates) and all(generic.isdisjoint(e.symbols) for e in expressions(block))


# -- loci -----------------------------------------------------------------------------------------


class SpecialLoci:
    """The loci of one block on which its answer differs from the generic ``report``; raises NoValueError.

    ``rank``: of its rows at a generic configuration; ``branch``: the factors of products that are zero on its branch.
    """

    def __init__(self, study: Study, report: Report, block: Block, a: Answer) -> None:
        self.study, self.report, self.block, self.answer = study, report, block, a
        self.rank = len(block.coordinates) - (a.velocity_dof or 0)
        curved = any(label.holonomic is False for label in a.labels.values())
        independent = a.growth[1] - a.growth[0] if a.growth and len(a.growth) > 1 else 1
        curvature = independent if curved else 0
        places = {ex.coordinate(name) for name in block.coordinates}
        self.branch = [h for h in _factors(study.reduced, study.outcome) if not places.isdisjoint(h.symbols)]
        self.candidates: Candidates = candidates(block, a.hidden, study.setting, self.rank, curvature)

    def cases(self) -> Iterator[SpecialCase]:
        """Yield the case of each locus, unless it lies in another locus with the same change."""
        located = list(self._located())
        for k, (locus, case) in enumerate(located):
            others = [(j, other) for j, (other, same) in enumerate(located) if same.what == case.what and j != k]
            inside = [j for j, other in others if self.candidates.zeros.within(locus, other)]
            if not any(j < k or not self.candidates.zeros.within(located[j][0], locus) for j in inside):
                yield case

    def _located(self) -> Iterator[tuple[Locus, SpecialCase]]:
        """Yield the cases with a smaller rank, then those with less curvature on other loci."""
        dropped: list[Locus] = []
        for locus in self.candidates.ranks[:MAX_PLACES]:
            seen = self._rows_on(locus)
            if seen is not None and seen.rank < self.rank:
                dropped.append(locus)
                yield from ((locus, case) for case in self._dropping(locus, seen))
        for locus in self.candidates.bends[:MAX_PLACES]:
            seen = None if locus in dropped else self._rows_on(locus)
            if seen is not None:
                yield from ((locus, case) for case in self._bending(locus, seen))

    def _rows_on(self, locus: Locus) -> RowsOnLocus | None:
        """Return the rows on a locus; None where no such real configuration is found, or the engines disagree."""
        zeros, relations = self.candidates.zeros, self.candidates.relations
        if not all(zeros.branches(locus.on(g)) for g in relations):
            return None
        remaining = [g for g in relations if not zeros.holds_on(locus, g)]
        if len(locus.equations) + len(remaining) > len(self.block.coordinates):
            return None
        with suppress(*_UNFINISHED):
            return self._rows_where([*remaining, *locus.equations])
        return None

    @raising_no_value
    def _rows_where(self, equations: Sequence[Expr]) -> RowsOnLocus | None:
        """Return the rows on the locus of some equations; None as in `_rows_on`."""
        a = self.answer
        forms = codistribution(self.block, self.study.setting, a.hidden, on=equations)
        rows, chart, n = forms.rows, forms.chart, forms.n
        result = points_of(chart)
        if result is None:
            return None
        point, real, regular = result
        matrix = rows.matrix(values(chart.ring, point), point.number(ex.ZERO.args[0]))
        with ctx.workprec(PRECISION):
            balls = rows.matrix(values(chart.ring, real), arb(0))
            certified = ball_part([row[:n] for row in balls]).rank, ball_part(balls).rank
        in_coordinates = [row[:n] for row in matrix]
        rank, whole = rank_of(in_coordinates, point.p), rank_of(matrix, point.p)
        if certified != (rank, whole):
            return None
        seen = RowsOnLocus(rank, whole == rank, _dependent(self.block, a, in_coordinates, point.p), regular)
        frame = field_frame(matrix, len(rows.columns), point.p)
        if not rank == whole == self.rank or not frame.rows or not frame.free:
            return seen
        largest = a.growth[-1] if a.growth else len(rows.columns)
        return seen._replace(growth=growth_at(rows, frame, point, largest))

    def _case(self, locus: Locus, what: str, constraints: Sequence[int], sure: Verdict) -> Iterator[SpecialCase]:
        """Yield the special case of a locus, with what changes there, unless an inequality or domain excludes it."""
        sure, positive, reduced = weakest(sure, self.answer.verdict), self.study.setting.positive, self.study.reduced
        domain = [c for r in reduced for c in r.domain()]
        sides = [(q.expr, q.strict) for r in reduced for q in r.inequalities]
        sides += [(c.expr, c.sense == ">") for c in domain if c.sense != "!="]
        if any(c.sense == "!=" and self.candidates.zeros.holds_on(locus, c.expr) for c in domain):
            return
        if sure == "undecided" or any(never_holds(substitute(e, locus.explicit), s, positive) for e, s in sides):
            return
        order = [ex.coordinate(c.name) for c in self.study.system.coordinates]
        solved = [s - locus.explicit[s] for s in order if s in locus.explicit]
        branch = [h for h in self.branch if not self.candidates.zeros.holds_on(locus, h)]
        texts = [_equation(_in_order(e, self.study.system)) for e in (*branch, *solved, *locus.others)]
        names = [self.study.names[i] for i in constraints]
        yield SpecialCase(where=" and ".join(texts), kind="locus", what=what, constraints=names, verdict=sure)

    def _dropping(self, locus: Locus, seen: RowsOnLocus) -> Iterator[SpecialCase]:
        """Yield the case of a locus with a smaller rank, which a ball certifies; the minors are 0 there identically."""
        by, velocities = self.rank - seen.rank, self.report.velocity_dof or 0
        rank = len(self.study.system.coordinates) - velocities
        sure: Verdict = "proved" if by == 1 and seen.regular else "probable"
        what = (
            f"the rank of the constraints drops from {rank} to {rank - by} there, and the instantaneous freedom is "
            f"{velocities + by} instead of {velocities}"
        )
        what = what if seen.moves else "no velocity satisfies the constraints there"
        return self._case(locus, what, seen.dependent, sure)

    def _bending(self, locus: Locus, seen: RowsOnLocus) -> Iterator[SpecialCase]:
        """Yield the case of a locus with fewer (or no) bracket directions, if the rank is the generic one."""
        elsewhere, there = self.answer.growth, seen.growth
        if seen.rank != self.rank or not seen.moves or len(there) < 2:
            return
        vanishes = there[1] == there[0]
        if not vanishes and (elsewhere is None or len(elsewhere) < 2 or there[1] >= elsewhere[1]):
            return
        what = f"the first Lie brackets add {'no direction' if vanishes else 'fewer directions'} there"
        scene = self.report.growth_vector
        sure: Verdict = "proved" if vanishes and seen.regular and self.candidates.regular else "probable"
        if scene and elsewhere and there[-1] == elsewhere[-1]:
            more = scene[0] - elsewhere[0]
            if [g + more for g in elsewhere] == list(scene):
                special = tuple(g + more for g in there)
                what, sure = f"{what}: the growth vector is {special} instead of {tuple(scene)}", "probable"
        forms = sorted({r.constraint for r in self.block.forms})
        yield from self._case(locus, what, forms, sure)


def _equation(terms: Sequence[Expr]) -> str:
    """Return the text of a sum = 0: ``x*y = 1`` with the number on the right, or ``a = b`` for two terms."""
    number = ex.add(*(term for term in terms if term.op == "num"))
    sides = [term for term in terms if term.op != "num"]
    if len(sides) == 2 and number.is_zero and _is_negative(sides[0]) != _is_negative(sides[1]):
        first, second = (-e if _is_negative(e) else e for e in sides)
        return f"{to_text(first)} = {to_text(second)}"
    return f"{to_text(ex.add(*sides))} = {to_text(-number)}"


def _is_negative(term: Expr) -> bool:
    return ex.number_and_rest(term)[0] < 0
