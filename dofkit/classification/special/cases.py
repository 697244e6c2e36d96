"""The special cases of a small scene, each confirmed and told in a sentence."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from contextlib import suppress
from dataclasses import dataclass, replace
from typing import Any

from flint import arb, ctx

from dofkit.base.deadline import OutOfTimeError, expired, limited
from dofkit.base.errors import NoValueError
from dofkit.base.verdicts import Verdict, weakest
from dofkit.base.wording import many, verb
from dofkit.classification.freedom.branches import Outcome
from dofkit.classification.special.common_zeros import (
    Leaf,
    drop,
    flag,
    in_order,
    order_of,
    where,
)
from dofkit.classification.special.minors import (
    Candidates,
    MinorTable,
    candidates,
    table_of,
)
from dofkit.configuration.variety import on_variety
from dofkit.exact.matrices.certified import ball_part
from dofkit.exact.matrices.sparse import rank_of
from dofkit.exact.points.balls import PRECISION, BallPoint
from dofkit.exact.points.field import FieldPoint
from dofkit.exact.points.frames import field_frame
from dofkit.exact.points.real_search import RealSearch
from dofkit.exact.residues import null_vectors, residue, residue_matrix
from dofkit.exact.ring.canonical import Canon
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
from dofkit.relations.normal.pieces import Finite, Inequality, Reduced
from dofkit.relations.normal.semidefinite import never_holds
from dofkit.relations.setting import Setting
from dofkit.report import Report, SpecialCase
from dofkit.system import Constraint, Coordinate, Relation, System, TypeFacts

#: Starts and steps of the search for a real point of a locus; where it is regular a few are enough.
STARTS, STEPS = 2, 14


def points_of(chart: Chart) -> tuple[FieldPoint, BallPoint, bool] | None:
    """Return a random point of a locus over GF(p) and a certified real one; None where they were not found at once.

    The last entry tells whether the conditions are independent at the real one, so that it exists for certain.
    """
    solver = TriangularSolver(chart.ring, chart.nodes, seed=1)
    drawn = solver.draw(1)
    if drawn is None or not on_variety(chart, drawn):
        return None
    search = RealSearch(chart.ring, chart.nodes, chart.unknowns, chart.positive)
    real = search.search(starts=STARTS, steps=STEPS)
    if real is None or not real.certified or not real.consistent:
        return None
    return drawn, real.point, real.part.rank == len(chart.nodes)


@dataclass(frozen=True)
class Locus:
    """A block's rows on a locus.

    ``rank`` in the coordinates' columns; ``moves``: False where no velocity satisfies them (dt lies in their
    span); ``dependent``: the constraints whose independent rows depend on each other there; ``regular``: that such
    real configurations exist is proved. ``growth``: dimensions of D, D + [D, D], ..., where they were asked for, as far
    as they are certain.
    """

    rank: int
    moves: bool
    dependent: tuple[int, ...]
    regular: bool
    growth: tuple[int, ...] = ()


@raising_no_value
def place(
    block: Block, a: Answer, setting: Setting, conditions: Sequence[Expr], relations: Sequence[Expr], grows: int
) -> Locus | None:
    """The rows on the locus; None where there is no such real configuration, or the engines disagree on a rank.

    ``relations``: the finite relations that do not hold there anyway; ``grows``: the rank at which D's growth is asked.
    """
    forms = codistribution(block, setting, a.hidden, on=[*relations, *conditions])
    rows, chart, n = forms.rows, forms.chart, forms.n
    result = points_of(chart)
    if result is None:
        return None
    point, real, regular = result
    try:
        matrix = rows.matrix(values(chart.ring, point), point.number(ex.ZERO.args[0]))
        with ctx.workprec(PRECISION):
            balls = rows.matrix(values(chart.ring, real), arb(0))
            certified = ball_part(_part(balls, n)).rank, ball_part(balls).rank
    except NoValueError:
        return None
    rank, whole = rank_of(_part(matrix, n), point.p), rank_of(matrix, point.p)
    if certified != (rank, whole):
        return None
    owners = _owners(block, a, _dependent(a, _part(matrix, n), point.p))
    frame = field_frame(matrix, len(rows.columns), point.p)
    if not rank == whole == grows or not frame.rows or not frame.free:
        return Locus(rank, whole == rank, owners, regular)
    return Locus(
        rank, True, owners, regular, growth_at(rows, frame, point, a.growth[-1] if a.growth else len(rows.columns))
    )


def _part(matrix: list[list[Any]], n: int) -> list[list[Any]]:
    return [row[:n] for row in matrix]


def _dependent(a: Answer, matrix: list[list[Any]], p: int) -> set[int]:
    """Of rows that are independent elsewhere, those that a relation between them holds here."""
    n = len(matrix[0])
    chosen: Sequence[int] = range(len(matrix))
    if len(a.matrix) == len(matrix):
        chosen = field_frame(
            [[residue(row.get(c, 0), a.modulus) for c in range(n)] for row in a.matrix], n, a.modulus
        ).rows
    columns = residue_matrix([[int(matrix[r][c]) for r in chosen] for c in range(n)], p)
    vectors = null_vectors(columns)
    return {r for i, r in enumerate(chosen) if any(vector[i] for vector in vectors)}


def _owners(block: Block, a: Answer, rows: Iterable[int]) -> tuple[int, ...]:
    """The constraints of rows, hidden relations left out."""
    first, last = len(block.finite), len(block.finite) + len(a.hidden)
    places = [i if i < first else i - len(a.hidden) for i in rows if i < first or i >= last]
    return tuple(sorted({block.rows[i].constraint for i in places}))


#: Expressions for which the rest of the configuration space is looked at.
MAX_EXPRESSIONS = 4
_RECIPROCAL = "_reciprocal"

Again = Callable[[System], Report]


def branch_dimensions(
    system: System, reduced: Sequence[Reduced], outcome: Outcome, report: Report, again: Again
) -> Iterator[SpecialCase]:
    """Yield the branch to which the degrees of freedom belong, where the rest of the configuration space has fewer."""
    claim = report.verdicts.get("dof")
    if system.reference is not None or not report.dof or claim is None or claim.about == "component":
        return
    for h in list(dict.fromkeys(_separating(reduced, outcome)))[:MAX_EXPRESSIONS]:
        remainder = None if expired() else again(where_nonzero(system, h))
        elsewhere = None if remainder is None else remainder.verdicts.get("dof")
        if remainder is None or remainder.dof is None or elsewhere is None or elsewhere.about == "component":
            continue
        sure = weakest(claim.verdict, elsewhere.verdict)
        if remainder.consistent and remainder.dof < report.dof and sure != "undecided":
            text = to_text(in_order(h, order_of(system)))
            concerned = (c for c in system.constraints if any(h.symbols & r.expr.symbols for r in c.relations))
            yield SpecialCase(
                where=f"{text} = 0",
                kind="branch",
                what=f"only this branch has {many(report.dof, 'degree')} of freedom; "
                f"where {text} is not 0 there {verb(remainder.dof)} {remainder.dof}",
                constraints=[c.name for c in concerned],
                verdict=sure,
            )
            return


def where_nonzero(system: System, h: Expr) -> System:
    """Return the system on the set where an expression does not vanish: u h = 1 for one u [Rabinowitsch1929]."""
    reciprocal = Relation(ex.coordinate(_RECIPROCAL) * h - ex.ONE)
    facts = TypeFacts(written=True)
    condition = Constraint(_RECIPROCAL, _RECIPROCAL, facts, f"{to_text(h)} != 0", (reciprocal,))
    return replace(
        system,
        coordinates=(*system.coordinates, Coordinate(_RECIPROCAL)),
        constraints=(*system.constraints, condition),
    )


def _separating(reduced: Sequence[Reduced], outcome: Outcome) -> Iterator[Expr]:
    """Yield expressions that vanish on the branch that was answered, and may not do so on others."""
    products = [n for r in reduced for n in r.normals if len(n.branches) > 1]
    factors = {p.expr for n in products for branch in n.branches for p in branch if isinstance(p, Finite)}
    result = [r.piece.expr for r in outcome.rows if isinstance(r.piece, Finite) and r.piece.expr in factors]
    for h in [*result, *(h for a in outcome.answers for h in a.separating)]:
        yield ex.number_and_rest(h)[1]


#: Blocks with more rows, coordinates or terms are not searched, nor scenes with more blocks.
MAX_ROWS, MAX_COLUMNS, MAX_TERMS, MAX_BLOCKS = 6, 10, 20, 12
#: Loci that are confirmed for each block, and seconds for all of them.
MAX_PLACES, MAX_SECONDS = 6, 10.0
SEARCHED = "special cases by the zeros of minors and of curvature"

_UNFINISHED = (ArithmeticError, ValueError, OutOfTimeError)


@dataclass(frozen=True)
class GenericAnswer:
    """What a case is told against: the system, what may be assumed of it, and the generic answer."""

    system: System
    setting: Setting
    report: Report
    order: Mapping[Expr, int]
    inequalities: Sequence[Inequality] = ()

    def allows(self, canon: Canon, leaf: Leaf) -> bool:
        """Return whether no inequality forbids the conditions, as far as these are solved."""
        values = {canon.ring.var_expr[i]: canon.to_expr(v) for i, v in leaf.solved}
        coordinates = {s: v for s, v in values.items() if s.op == "sym"}
        positive = self.setting.positive
        return not any(never_holds(substitute(q.expr, coordinates), q.strict, positive) for q in self.inequalities)

    def names(self, constraints: Sequence[int]) -> list[str]:
        return [self.system.constraints[i].name for i in constraints]


@dataclass(frozen=True)
class SearchedBlock:
    """One block, its polynomials and its candidates.

    ``rank`` of its rows at a generic configuration; ``curved``: there is a form that does not integrate.
    """

    block: Block
    answer: Answer
    table: MinorTable
    candidates: Candidates
    rank: int
    curved: bool


def special_cases(
    system: System, reduced: Sequence[Reduced], setting: Setting, outcome: Outcome, report: Report, again: Again
) -> dict[str, Any]:
    """What a report has of them: ``special_cases``, and in ``method`` that they were sought.

    ``again`` answers another system.
    """
    if setting.tolerance is not None or len(outcome.blocks) > MAX_BLOCKS:
        return {}
    answer = GenericAnswer(system, setting, report, order_of(system), [q for r in reduced for q in r.inequalities])
    cases: list[SpecialCase] = []
    with limited(MAX_SECONDS):
        with suppress(*_UNFINISHED):
            cases.extend(branch_dimensions(system, reduced, outcome, report, again))
        blocks = zip(outcome.blocks, outcome.answers, strict=True)
        searched = (_search(b, a, answer) for b, a in blocks if _small(b, a) and _plain(b, answer))
        result = [s for s in searched if s is not None]
        if not result:
            return {"special_cases": cases} if cases else {}
        for block in result:
            with suppress(*_UNFINISHED):
                cases.extend(_places(block, answer))
    return {"special_cases": _merged(cases), "method": f"{report.method}; {SEARCHED}"}


def _merged(cases: Sequence[SpecialCase]) -> list[SpecialCase]:
    """What is said of several constraints at one place, said once."""
    kept: dict[tuple[str, str], SpecialCase] = {}
    for case in cases:
        key = (case.where, case.what)
        if key in kept:
            names = [*kept[key].constraints, *(n for n in case.constraints if n not in kept[key].constraints)]
            sure = weakest(kept[key].verdict, case.verdict)
            case = case.model_copy(update={"constraints": names, "verdict": sure})
        kept[key] = case
    return list(kept.values())


def _search(block: Block, a: Answer, answer_of_system: GenericAnswer) -> SearchedBlock | None:
    """The candidates of a block; None where it takes too long."""
    system = answer_of_system.system
    if expired():
        return None
    nonzero = frozenset(ex.parameter(p) for p, sign in system.parameters.items() if sign == "nonzero")
    rank = len(block.coordinates) - (a.velocity_dof or 0)
    curvature = a.growth[1] - a.growth[0] if a.growth and len(a.growth) > 1 else 0
    try:
        table = table_of(block, a.hidden, answer_of_system.setting, nonzero)
        curved = any(label.holonomic is False for label in a.labels.values())
        return SearchedBlock(block, a, table, candidates(table, rank, curvature, curved), rank, curved)
    except _UNFINISHED:
        return None


def _small(block: Block, a: Answer) -> bool:
    """Few short rows, all linear in the velocities, with an answer."""
    return (
        len(block.rows) + len(a.hidden) <= MAX_ROWS
        and len(block.coordinates) <= MAX_COLUMNS
        and sum(len(e.args) if e.op == "add" else 1 for e in expressions(block)) <= MAX_TERMS
        and not block.nonlinear
        and not a.degenerate
        and a.velocity_dof is not None
    )


def _plain(block: Block, answer: GenericAnswer) -> bool:
    """Coordinates that are what their names say, no generic geometry, and no drawing that speaks for itself."""
    system = answer.system
    turning = {name for r in system.rotations if r.chart == "gibbs" for name in r.names}
    if not turning.isdisjoint(block.coordinates) or (system.reference is not None and not block.forms):
        return False
    generic = {ex.parameter(p) for p in system.generic}
    system_names = {c.name for c in system.coordinates}
    return system_names.issuperset(block.coordinates) and all(generic.isdisjoint(e.symbols) for e in expressions(block))


# -- loci -----------------------------------------------------------------------------------------


def _places(searched: SearchedBlock, generic: GenericAnswer) -> Iterator[SpecialCase]:
    """Yield what changes on each locus, once where one locus with the same change lies in another."""
    located = list(_located(searched, generic))
    for what in dict.fromkeys(case.what for _, case in located):
        alike = [(leaf, case) for leaf, case in located if case.what == what]
        largest = searched.table.reals.largest([leaf for leaf, _ in alike])
        yield from (case for leaf, case in alike if leaf in largest)


def _located(searched: SearchedBlock, generic: GenericAnswer) -> Iterator[tuple[Leaf, SpecialCase]]:
    """Yield ranks that drop, then curvature that vanishes elsewhere."""
    if generic.report.velocity_dof is None:
        return
    dropped: list[Leaf] = []
    for leaf in searched.candidates.ranks[:MAX_PLACES]:
        seen = _locus_of(searched, generic, leaf, 0)
        if seen is not None and seen.rank < searched.rank:
            dropped.append(leaf)
            yield from ((leaf, case) for case in _dropping(searched, generic, leaf, seen))
    for leaf in searched.candidates.bends[:MAX_PLACES] if searched.curved else ():
        seen = None if leaf in dropped else _locus_of(searched, generic, leaf, searched.rank)
        if seen is not None:
            yield from ((leaf, case) for case in _bending(searched, generic, leaf, seen))


def _locus_of(searched: SearchedBlock, generic: GenericAnswer, leaf: Leaf, grows: int) -> Locus | None:
    canon, reals = searched.table.canon, searched.table.reals
    remaining = [g for g in searched.table.relations if not reals.vanishes_on(leaf, g)]
    if len(leaf.conditions(canon)) + len(remaining) > len(searched.block.coordinates):
        return None
    conditions, relations = ([canon.to_expr(p) for p in polys] for polys in (leaf.conditions(canon), remaining))
    try:
        return place(searched.block, searched.answer, generic.setting, conditions, relations, grows)
    except _UNFINISHED:
        return None


def _locus(
    searched: SearchedBlock, generic: GenericAnswer, leaf: Leaf, what: str, constraints: Sequence[int], sure: Verdict
) -> Iterator[SpecialCase]:
    at = where(searched.table.canon, leaf, generic.order)
    sure = weakest(sure, searched.answer.verdict)
    if sure != "undecided" and generic.allows(searched.table.canon, leaf):
        yield SpecialCase(where=at, kind="locus", what=what, constraints=generic.names(constraints), verdict=sure)


def _dropping(searched: SearchedBlock, generic: GenericAnswer, leaf: Leaf, seen: Locus) -> Iterator[SpecialCase]:
    """The minors vanish identically on the locus; a ball certifies the rank that is left."""
    by, velocities = searched.rank - seen.rank, generic.report.velocity_dof or 0
    rank = len(generic.system.coordinates) - velocities
    sure: Verdict = "proved" if by == 1 and seen.regular else "probable"
    return _locus(searched, generic, leaf, drop(rank, by, velocities, seen.moves), seen.dependent, sure)


def _bending(searched: SearchedBlock, generic: GenericAnswer, leaf: Leaf, seen: Locus) -> Iterator[SpecialCase]:
    """Curvature that vanishes, or of which less is independent, where no rank drops."""
    elsewhere, there = searched.answer.growth, seen.growth
    if seen.rank != searched.rank or not seen.moves or len(there) < 2:
        return
    vanishes = there[1] == there[0]
    if not vanishes and (elsewhere is None or len(elsewhere) < 2 or there[1] >= elsewhere[1]):
        return
    forms = tuple(sorted({r.constraint for r in searched.block.forms}))
    what, grown = flag(generic.report.growth_vector, elsewhere, there, vanishes)
    sure: Verdict = "proved" if vanishes and seen.regular and not grown else "probable"
    yield from _locus(searched, generic, leaf, what, forms, sure)
