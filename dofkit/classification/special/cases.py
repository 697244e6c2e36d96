"""The special cases of a small scene, each confirmed and told in a sentence."""

from __future__ import annotations

from collections.abc import Callable, Hashable, Iterator, Mapping, Sequence
from contextlib import suppress
from dataclasses import dataclass
from typing import Any

from dofkit.base.deadline import OutOfTimeError, expired, limited
from dofkit.base.errors import DofkitError
from dofkit.base.verdicts import Verdict, weakest
from dofkit.classification.freedom.branches import Outcome
from dofkit.classification.freedom.isomorphic_blocks import Likenesses
from dofkit.classification.special.branch_dimensions import branch_dimensions, meetings
from dofkit.classification.special.candidates import Candidates, candidates
from dofkit.classification.special.common_zeros import Leaf, drop, flag, order_of, where
from dofkit.classification.special.loci import Locus, place
from dofkit.classification.special.minors import MinorTable, table_of
from dofkit.classification.special.parameters import (
    ParameterCondition,
    Values,
    assignments,
    at_values,
    changed,
    differences,
)
from dofkit.exact.ring.canonical import Canon
from dofkit.expressions import tree as ex
from dofkit.expressions.calculus import substitute
from dofkit.expressions.tree import Expr
from dofkit.relations.answer import Answer
from dofkit.relations.blocks import Block, expressions
from dofkit.relations.normal.pieces import Inequality, Reduced
from dofkit.relations.normal.semidefinite import never_holds
from dofkit.relations.setting import Setting
from dofkit.report import Report, SpecialCase
from dofkit.system import System

#: Blocks with more rows, coordinates or terms are not searched, nor scenes with more blocks.
MAX_ROWS, MAX_COLUMNS, MAX_TERMS, MAX_BLOCKS = 6, 10, 20, 12
#: Times that a scene is answered again with special values, and loci that are confirmed a block.
MAX_VALUES, MAX_PLACES = 8, 6
#: Scenes with more coordinates are not answered again; and all of it takes no longer than this.
MAX_SCENE, MAX_SECONDS = 40, 10.0
SEARCHED = "special cases by the zeros of minors and of curvature"

_UNFINISHED = (ArithmeticError, ValueError, OutOfTimeError)

Again = Callable[[System], Report]


@dataclass(frozen=True)
class GenericAnswer:
    """What a case is told against: the system, what may be assumed of it, and the generic answer."""

    system: System
    setting: Setting
    report: Report
    order: Mapping[Expr, int]
    inequalities: Sequence[Inequality] = ()

    def allows(self, canon: Canon, leaf: Leaf) -> bool:
        """Does no inequality forbid the conditions, as far as these are solved?"""
        values = {canon.ring.var_expr[i]: canon.to_expr(v) for i, v in leaf.solved}
        known = {s: v for s, v in values.items() if s.op == "sym"}
        positive = self.setting.positive
        return not any(never_holds(substitute(q.expr, known), q.strict, positive) for q in self.inequalities)

    def names(self, constraints: Sequence[int]) -> list[str]:
        return [self.system.constraints[i].name for i in constraints]

    @property
    def velocities(self) -> int:
        """Independent velocities at a generic configuration."""
        return self.report.velocity_dof or 0

    @property
    def rank(self) -> int:
        """Of all rows at a generic configuration."""
        return len(self.system.coordinates) - self.velocities


@dataclass(frozen=True)
class SearchedBlock:
    """One block, its polynomials and its candidates."""

    block: Block
    answer: Answer
    table: MinorTable
    candidates: Candidates

    @property
    def rank(self) -> int:
        """Of its rows at a generic configuration."""
        return len(self.block.coordinates) - (self.answer.velocity_dof or 0)

    @property
    def curved(self) -> bool:
        """Is there curvature at a generic configuration: a form that does not integrate?"""
        return any(label.holonomic is False for label in self.answer.labels.values())


def special_cases(
    system: System, reduced: Sequence[Reduced], setting: Setting, outcome: Outcome, report: Report, again: Again
) -> dict[str, Any]:
    """What a report has of them: ``special_cases``, parameter values first, and in ``method`` that they were sought.

    ``again`` answers another system.
    """
    if setting.tolerance is not None or len(outcome.blocks) > MAX_BLOCKS:
        return {}
    told = GenericAnswer(system, setting, report, order_of(system), [q for r in reduced for q in r.inequalities])
    cases: list[SpecialCase] = []
    with limited(MAX_SECONDS):
        with suppress(*_UNFINISHED):
            cases.extend(branch_dimensions(system, reduced, outcome, report, again))
        found = _searched(outcome, told)
        if not found:
            return {"special_cases": cases} if cases else {}
        conditions = [ParameterCondition(leaf, f.table.reals) for f in found for leaf in f.candidates.values]
        for part in (
            _values(conditions, told, again),
            meetings(system, reduced, setting, outcome),
            *(_places(f, told) for f in found),
        ):
            with suppress(*_UNFINISHED):
                cases.extend(part)
    return {"special_cases": _merged(cases), "method": f"{report.method}; {SEARCHED}"}


def _searched(outcome: Outcome, told: GenericAnswer) -> list[SearchedBlock]:
    """The blocks that are small, with their candidates; where one has none, those that are like it are left out."""
    likenesses = Likenesses(told.setting, {c.name: (c.owner, c.role) for c in told.system.coordinates})
    fruitless: set[Hashable] = set()
    found = []
    looked = [(b, a) for b, a in zip(outcome.blocks, outcome.answers, strict=True) if _is_searched(b, a, told)]
    for block, a in looked:
        key = likenesses.of(block).key if len(looked) > 1 else None
        one = None if key in fruitless else _search(block, a, told)
        if one is not None:
            found.append(one)
        if key is not None and (one is None or one.candidates.empty):
            fruitless.add(key)
    return found


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


def _is_searched(block: Block, a: Answer, told: GenericAnswer) -> bool:
    return _small(block, a) and _plain(block, told)


def _search(block: Block, a: Answer, told: GenericAnswer) -> SearchedBlock | None:
    """The candidates of a block; None where it takes too long."""
    system = told.system
    if expired():
        return None
    nonzero = frozenset(ex.parameter(p) for p, sign in system.parameters.items() if sign == "nonzero")
    rank = len(block.coordinates) - (a.velocity_dof or 0)
    curvature = a.growth[1] - a.growth[0] if a.growth and len(a.growth) > 1 else 0
    try:
        table = table_of(block, a.hidden, told.setting, nonzero)
        curved = any(label.holonomic is False for label in a.labels.values())
        return SearchedBlock(block, a, table, candidates(table, rank, curvature, curved))
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


def _plain(block: Block, told: GenericAnswer) -> bool:
    """Coordinates that are what their names say, no generic geometry, and no drawing that speaks for itself."""
    system = told.system
    turning = {name for r in system.rotations if r.chart == "gibbs" for name in r.names}
    if not turning.isdisjoint(block.coordinates) or (system.reference is not None and not block.forms):
        return False
    generic = {ex.parameter(p) for p in system.generic}
    own = {c.name for c in system.coordinates}
    return own.issuperset(block.coordinates) and all(generic.isdisjoint(e.symbols) for e in expressions(block))


# -- loci -----------------------------------------------------------------------------------------


def _places(found: SearchedBlock, told: GenericAnswer) -> Iterator[SpecialCase]:
    """Yield what changes on each locus, once where one locus with the same change lies in another."""
    located = list(_located(found, told))
    for what in dict.fromkeys(case.what for _, case in located):
        alike = [(leaf, case) for leaf, case in located if case.what == what]
        largest = found.table.reals.largest([leaf for leaf, _ in alike])
        yield from (case for leaf, case in alike if leaf in largest)


def _located(found: SearchedBlock, told: GenericAnswer) -> Iterator[tuple[Leaf, SpecialCase]]:
    """Yield ranks that drop, then curvature that vanishes elsewhere."""
    if told.report.velocity_dof is None:
        return
    dropped: list[Leaf] = []
    for leaf in found.candidates.ranks[:MAX_PLACES]:
        seen = _locus_of(found, told, leaf, 0)
        if seen is not None and seen.rank < found.rank:
            dropped.append(leaf)
            yield from ((leaf, case) for case in _dropping(found, told, leaf, seen))
    for leaf in found.candidates.bends[:MAX_PLACES] if found.curved else ():
        seen = None if leaf in dropped else _locus_of(found, told, leaf, found.rank)
        if seen is not None:
            yield from ((leaf, case) for case in _bending(found, told, leaf, seen))


def _locus_of(found: SearchedBlock, told: GenericAnswer, leaf: Leaf, grows: int) -> Locus | None:
    canon, reals = found.table.canon, found.table.reals
    left = [g for g in found.table.relations if not reals.vanishes_on(leaf, g)]
    if len(leaf.conditions(canon)) + len(left) > len(found.block.coordinates):
        return None
    conditions, relations = ([canon.to_expr(p) for p in polys] for polys in (leaf.conditions(canon), left))
    try:
        return place(found.block, found.answer, told.setting, conditions, relations, grows)
    except _UNFINISHED:
        return None


def _locus(
    found: SearchedBlock, told: GenericAnswer, leaf: Leaf, what: str, constraints: Sequence[int], sure: Verdict
) -> Iterator[SpecialCase]:
    at = where(found.table.canon, leaf, told.order)
    sure = weakest(sure, found.answer.verdict)
    if sure != "undecided" and told.allows(found.table.canon, leaf):
        yield SpecialCase(where=at, kind="locus", what=what, constraints=told.names(constraints), verdict=sure)


def _dropping(found: SearchedBlock, told: GenericAnswer, leaf: Leaf, seen: Locus) -> Iterator[SpecialCase]:
    """The minors vanish identically on the locus; a ball certifies the rank that is left."""
    by = found.rank - seen.rank
    sure: Verdict = "proved" if by == 1 and seen.regular else "probable"
    return _locus(found, told, leaf, drop(told.rank, by, told.velocities, seen.moves), seen.dependent, sure)


def _bending(found: SearchedBlock, told: GenericAnswer, leaf: Leaf, seen: Locus) -> Iterator[SpecialCase]:
    """Curvature that vanishes, or of which less is independent, where no rank drops."""
    own, there = found.answer.growth, seen.growth
    if seen.rank != found.rank or not seen.moves or len(there) < 2:
        return
    vanishes = there[1] == there[0]
    if not vanishes and (own is None or len(own) < 2 or there[1] >= own[1]):
        return
    forms = tuple(sorted({r.constraint for r in found.block.forms}))
    what, grown = flag(told.report.growth_vector, own, there, vanishes)
    sure: Verdict = "proved" if vanishes and seen.regular and not grown else "probable"
    yield from _locus(found, told, leaf, what, forms, sure)


# -- parameters -----------------------------------------------------------------------------------


def _values(conditions: Sequence[ParameterCondition], told: GenericAnswer, again: Again) -> Iterator[SpecialCase]:
    """The scene answered again for every set of special values."""
    if len(told.system.coordinates) > MAX_SCENE:
        return
    different: dict[str, ParameterCondition] = {}
    for condition in conditions:
        at = where(condition.reals.canon, condition.leaf, told.order)
        different.setdefault(at, condition)
    left = MAX_VALUES
    found: dict[frozenset[str], str] = {}
    for at, condition in sorted(different.items(), key=lambda pair: pair[0].count(" and ")):
        ways = [] if expired() else assignments(condition, told.system.parameters)
        left -= len(ways)
        case = _at_values(condition, ways, at, told, again) if ways and left >= 0 else None
        parts = frozenset(at.split(" and "))
        if case is not None and not any(other < parts and what == case.what for other, what in found.items()):
            found[parts] = case.what
            yield case


def _at_values(
    condition: ParameterCondition, ways: Sequence[Values], at: str, told: GenericAnswer, again: Again
) -> SpecialCase | None:
    """What the answer becomes, where all values that satisfy the conditions give the same one."""
    system = told.system
    reports: list[Report] = []
    said: list[str] = []
    for way in ways:
        try:
            reports.append(again(at_values(system, way)))
        except (DofkitError, *_UNFINISHED):
            return None
        becomes = differences(told.report, reports[-1])
        said = said or becomes
        if not becomes or becomes != said:
            return None
    names = changed(told.report, reports[0])
    if not names:
        symbols = frozenset().union(*(way.keys() for way in ways))
        names = [c.name for c in system.constraints if any(not symbols.isdisjoint(r.expr.symbols) for r in c.relations)]
    sure = weakest(told.report.verdict, *(r.verdict for r in reports))
    if sure == "undecided":
        return None
    return SpecialCase(where=at, kind="parameters", what="; ".join(said), constraints=names, verdict=sure)
