"""A configuration and time at which all blocks are satisfied and every equation as written has a value.

Blocks share no coordinate, but may share time, parameters and unknown functions: x^2 = t - 3 and y^2 = 2 - t are
satisfied at some time each, but at no time together. Cancelling keeps the domain: y = x/x has no value at x = 0.
"""

from __future__ import annotations

from collections.abc import Callable, Hashable, Iterable, Mapping, Sequence
from contextlib import suppress
from dataclasses import replace
from fractions import Fraction
from types import MappingProxyType
from typing import NamedTuple

from flint import arb

from dofkit.base.errors import NoValueError, PoleError, TextError
from dofkit.base.verdicts import weakest
from dofkit.configuration.generic_dimension import BALL_COLUMNS
from dofkit.configuration.variety import Witness, of_real_point
from dofkit.exact.analyticity import is_analytic
from dofkit.exact.matrices.sparse import components
from dofkit.exact.points.balls import RealPoint
from dofkit.exact.points.real_search import RealSearch
from dofkit.expressions import tree as ex
from dofkit.expressions.calculus import substitute
from dofkit.expressions.enclosures import interval_of
from dofkit.expressions.renaming import coordinates_in, is_name, shape_of
from dofkit.expressions.text import Names, parse_expression, to_text
from dofkit.expressions.tree import Expr
from dofkit.relations.answer import Answer
from dofkit.relations.blocks import Block, Chart, Row, depends_on_time, expressions_of, make_chart
from dofkit.relations.linear_relations import explicit_relations, number_coefficients
from dofkit.relations.normal.domain import DomainCondition, is_satisfied_at
from dofkit.relations.normal.no_solution import hold_nowhere
from dofkit.relations.normal.pieces import Finite, JointEquation
from dofkit.relations.setting import Setting

#: Number of searches for a point, and the factor from one starting time to the next but one (signs alternate).
SEEDS, LATER = 6, 4.0


def restricted_to_domain(block: Block, result: Answer, setting: Setting) -> Answer:
    """Return the answer of a block on the region where its conditions are satisfied.

    It is inconsistent if this region is empty, and undecided if that is not known or the reference is not inside.
    """
    finite = (r.piece.expr for r in block.finite if isinstance(r.piece, Finite))
    block = replace(block, conditions=without_satisfied(block.conditions, finite))
    if not block.conditions or result.consistent is False:
        return result
    if result.consistent is None:
        return _nowhere(block, result) if _is_empty(block, result, setting) else result
    if setting.reference is not None and result.instantaneous is not None:
        here = {**setting.reference, ex.TIME: ex.ZERO}
        inside = all(is_satisfied_at(c, here, setting.positive, strictly=True) for c in block.conditions)
        return result if inside else _undecided(block, result)
    return _at_a_point(block, result, setting)


def without_satisfied(conditions: Iterable[DomainCondition], finite: Iterable[Expr]) -> tuple[DomainCondition, ...]:
    """Return the conditions without those u >= 0 for which linear equations among ``finite`` = 0 imply u = 0."""
    with suppress(PoleError):
        explicit = explicit_relations(finite, number_coefficients).by_others
        return tuple(c for c in conditions if c.sense != ">=" or not substitute(c.expr, explicit).is_zero)
    return tuple(conditions)


def _equations(block: Block, result: Answer) -> list[Expr]:
    """Return the geometric equations of a block, hidden ones included."""
    return [*(r.piece.expr for r in block.finite if isinstance(r.piece, Finite)), *result.hidden]


def _is_empty(block: Block, result: Answer, setting: Setting) -> bool:
    """Return whether the conditions are proved to be false wherever the geometric equations are satisfied."""
    branches = (replace(result, hidden=h) for h in result.hidden_branches or [result.hidden])
    return all(hold_nowhere(_equations(block, branch), block.conditions, setting.positive) for branch in branches)


def _at_a_point(block: Block, result: Answer, setting: Setting) -> Answer:
    """Return the answer with a witness that satisfies all conditions strictly, or an inconsistent or undecided one."""
    conditions = [c.expr for c in block.conditions]
    chart = make_chart(block, replace(setting, reference=None), result.hidden, conditions)
    dof = result.dof if not block.forms and not block.nonlinear else None
    point = _point_within(chart, block.conditions, dof)
    if point is not None and _is_same_component(block, result):
        within = _is_strict_at_witness(block, result)
        return result if within else replace(result, witness=of_real_point(chart.symbols, point))
    return _nowhere(block, result) if _is_empty(block, result, setting) else _undecided(block, result)


def _point_within(chart: Chart, conditions: Sequence[DomainCondition], dof: int | None) -> RealPoint | None:
    """Return a certified point at which all conditions are satisfied strictly, and the rank is right; else None.

    The rank must agree with ``dof``, so that the point is on the right component; without ``dof`` it must be the
    largest rank of all points in the search.
    """
    search = RealSearch(chart.ring, chart.nodes, chart.unknowns, chart.setting.positive, chart.symbols)
    points = []
    for seed in range(SEEDS):
        time = {ex.TIME: (-1.0) ** seed * LATER ** (seed // 2)} if seed else {}
        try:
            point = search.search(seed, time)
        except (OverflowError, ValueError, NoValueError):
            continue
        if point is not None and point.certain:
            points.append(point)
    wanted = max((p.part.rank for p in points), default=0) if dof is None else chart.coordinates - dof
    return next((p for p in points if p.part.rank == wanted and hold_strictly(conditions, p.point.symbols)), None)


def _is_same_component(block: Block, result: Answer) -> bool:
    """Return whether another point may be the witness of the answer.

    For forms and an answer about a component it may not, unless the answer's own witness satisfies the conditions.
    """
    if result.about != "component" or not (block.forms or block.nonlinear):
        return True
    return result.witness is not None and _is_strict_at_witness(block, result)


def _is_strict_at_witness(block: Block, result: Answer) -> bool:
    """Return whether all conditions hold strictly at the witness: True without one, False if it has roots in it."""
    try:
        configuration = {s: Fraction(text) for s, text in (result.witness or {}).items()}
    except ValueError:
        return False
    return not configuration or hold_strictly(block.conditions, configuration)


def hold_strictly(conditions: Iterable[DomainCondition], point: Mapping[Expr, arb | Fraction]) -> bool:
    """Return whether conditions are proved to be satisfied strictly at a point."""
    balls = [(c, interval_of(c.expr, point)) for c in conditions]
    return all(v is not None and not v.contains(0) and (c.sense == "!=" or bool(v > 0)) for c, v in balls)


def text_of_conditions(conditions: Iterable[DomainCondition]) -> str:
    """Return conditions as a text for messages."""
    return " and ".join(f"{to_text(c.expr)} {c.sense} 0" for c in conditions)


def _nowhere(block: Block, result: Answer) -> Answer:
    """Return the inconsistent answer of a block whose conditions are satisfied nowhere on its equations."""
    conditions = text_of_conditions(block.conditions)
    why = f"as written, the equations require {conditions}, which is satisfied nowhere where they are"
    reasons = [*result.reasons, why]
    return Answer(False, verdict="proved", argument="outside the domain", hidden=result.hidden, reasons=reasons)


def _undecided(block: Block, result: Answer) -> Answer:
    """Return the undecided answer of a block for which no point within its conditions was found."""
    conditions = text_of_conditions(block.conditions)
    why = f"no configuration was found that satisfies the equations and, as they require, {conditions}"
    most = result.dof if result.verdict == "proved" and result.about != "component" else None
    return Answer(None, verdict="undecided", hidden=result.hidden, reasons=[*result.reasons, why], most=most)


APART = "each part of the system can be satisfied at some time, but no common time was found"
OUTSIDE = "no configuration was found at which all equations have a value as they were written"
#: The relative error of a decimal number in a witness.
DIGITS_BALL = arb(10) ** -24


class CommonPoint(NamedTuple):
    """The blocks and their answers after the search for a common point.

    Blocks keep the conditions that were not satisfied. ``witness``: values of coordinates that occur only in
    conditions. ``nowhere``: constraints in no block whose domain is empty; ``unsettled``: for which this is undecided.
    """

    blocks: list[Block]
    answers: list[Answer]
    witness: Witness = MappingProxyType({})
    nowhere: tuple[int, ...] = ()
    unsettled: tuple[int, ...] = ()


def at_one_point(
    blocks: Sequence[Block],
    answers: Sequence[Answer],
    domain: Sequence[tuple[int, DomainCondition]],
    setting: Setting,
    answered: Callable[[Block], Answer],
) -> CommonPoint:
    """Return the answers after comparing the blocks' witnesses with each other and with the ``domain``.

    ``domain``: (constraint, condition for a value of it as written). Conditions that the witnesses do not satisfy are
    added to the blocks that share a coordinate with them, and these are ``answered`` again.
    """
    written = _with_conditions(blocks, domain)
    kept, result = list(blocks), simultaneous(written, answers)
    if any(a.consistent is not True for a in result):
        return CommonPoint(kept, [restricted_to_domain(b, a, setting) for b, a in zip(written, result, strict=True)])
    point = _point(blocks, result, setting) if domain else {}
    outside = {c for _, c in domain if not hold_strictly([c], {s: point.get(s, arb(0)) for s in c.expr.symbols})}
    if not outside:
        return CommonPoint(kept, result)
    names = [frozenset[Hashable]((*b.coordinates, *(row.constraint for row in b.rows))) for b in written]
    names += [coordinates_in(c.expr) or frozenset((owner,)) for owner, c in domain]
    free_values: dict[Expr, str] = {}
    failed: dict[bool | None, list[int]] = {False: [], None: []}
    for numbers in components(names):
        members = [i for i in numbers if i < len(blocks)]
        added = [domain[i - len(blocks)] for i in numbers if i >= len(blocks)]
        if outside.isdisjoint(c for _, c in added):
            continue
        conditions = tuple(dict.fromkeys(c for _, c in added))
        joined = merged([written[i] for i in members], conditions, setting)
        a = answered(joined)
        free = len(joined.coordinates) - sum(len(blocks[i].coordinates) for i in members)
        if a.consistent and a.dof == free + sum(result[i].dof or 0 for i in members):
            free_values |= a.witness or {}
            for i in members:
                result[i] = replace(result[i], witness=a.witness, verdict=weakest(result[i].verdict, a.verdict))
            continue
        consistent = False if a.consistent is False else None
        if not members:
            failed[consistent] += [i for i, _ in added]
        for i in members:
            kept[i], result[i] = written[i], _not_consistent(result[i], a, OUTSIDE)
    together = simultaneous(written, result)
    return CommonPoint(kept, together, free_values, tuple(failed[False]), tuple(failed[None]))


def _with_conditions(blocks: Sequence[Block], domain: Sequence[tuple[int, DomainCondition]]) -> list[Block]:
    """Return each block with the conditions in its coordinates only, or in none but from a constraint of the block."""
    result = list(blocks)
    for owner, c in domain:
        names = coordinates_in(c.expr)
        for k, block in enumerate(result):
            belongs = names <= {*block.coordinates} if names else any(row.constraint == owner for row in block.rows)
            if belongs and c not in block.conditions:
                result[k] = replace(block, conditions=(*block.conditions, c))
    return result


def _point(blocks: Sequence[Block], answers: Sequence[Answer], setting: Setting) -> dict[Expr, arb]:
    """Return the values of the witnesses as balls; NaN for coordinates of blocks without one."""
    pairs = zip(blocks, answers, strict=True)
    unknown = {ex.coordinate(name): arb("nan") for b, a in pairs if a.witness is None for name in b.coordinates}
    texts = {s: text for a in answers for s, text in (a.witness or {}).items()}
    exact = {s: e for s, e in (setting.reference or {}).items() if s in texts and to_text(e) == texts[s]}
    return unknown | {s: _ball(text, exact.get(s)) for s, text in texts.items()}


def _ball(text: str, exact: Expr | None) -> arb:
    """Return the ball of a value of a witness, from its text or its exact expression; NaN if it has no real value."""
    try:
        value = arb(text)
    except ValueError:
        try:
            ball = interval_of(parse_expression(text, Names()) if exact is None else exact)
        except TextError:  # it has no real value there, as log(0)
            ball = None
        return arb("nan") if ball is None else ball
    return value + arb(0, 1) * (1 + abs(value)) * DIGITS_BALL if {".", "e"} & {*text} else value


def simultaneous(blocks: Sequence[Block], answers: Sequence[Answer]) -> list[Answer]:
    """Return the answers, undecided if the witnesses of blocks have different times, parameters or functions."""
    result = list(answers)
    if any(a.consistent is not True for a in answers):
        return result
    shared = [_shared_symbols(block) for block in blocks]
    for numbers in components(shared):
        group = [i for i in numbers if shared[i]]
        if len(group) < 2 or _is_common([result[i].witness for i in group], [shared[i] for i in group]):
            continue
        restricting = [i for i in group if may_restrict(blocks[i], result[i])]
        for i in restricting if len(restricting) > 1 else ():
            result[i] = Answer(None, verdict="undecided", reasons=[APART], method=result[i].method)
    return result


def may_restrict(block: Block, a: Answer) -> bool:
    """Return whether a block may be satisfiable only at some times, or only for some parameters."""
    if a.linear or not (block.finite or a.hidden or block.nonlinear or block.conditions):
        return False
    relations = _equations(block, a)
    if block.nonlinear or block.conditions or len(relations) > BALL_COLUMNS:
        return True
    smooth = all(is_analytic(g, g.symbols, poles=False) for g in relations)
    return not smooth or bool(explicit_relations(relations).implicit)


def _shared_symbols(block: Block) -> frozenset[Expr]:
    """Return the time, the named parameters and, as symbols, the names of the unknown functions of a block."""
    pieces = (row.piece for row in block.rows if not isinstance(row.piece, JointEquation))
    written = [*(e for piece in pieces for e in expressions_of(piece)), *(c.expr for c in block.conditions)]
    named = {s for e in written for s in shape_of(e).skeleton.symbols if s.args[0] == "parameter" and not is_name(s)}
    calls = {n for e in written if "call" in e.functions for n in ex.nodes(e) if n.op == "call"}
    functions = {ex.parameter(f"{n.args[0]}(...)") for n in calls}
    timed = any(map(depends_on_time, (*(row.piece for row in block.rows), *block.conditions)))
    return frozenset({*named, *functions, *((ex.TIME,) if timed else ())})


def _is_common(witnesses: Sequence[Witness | None], shared: Sequence[frozenset[Expr]]) -> bool:
    """Return whether all witnesses are known, with equal values of all shared symbols, and share no function."""
    common: dict[Expr, str] = {}
    for witness, symbols in zip(witnesses, shared, strict=True):
        if witness is None or any(common.setdefault(s, witness[s]) != witness[s] for s in symbols & witness.keys()):
            return False
    return not any(s.args[1].endswith("(...)") for symbols in shared for s in symbols)


def _not_consistent(a: Answer, together: Answer, why: str) -> Answer:
    """Return the answer of a block that is inconsistent ``together`` with others, or for which this is undecided."""
    impossible = together.consistent is False
    answers = Answer(False if impossible else None, verdict=together.verdict if impossible else "undecided")
    reasons = [*together.reasons, why]
    return replace(answers, argument=together.argument if impossible else None, reasons=reasons, method=a.method)


def merged(blocks: Sequence[Block], conditions: Sequence[DomainCondition], setting: Setting) -> Block:
    """Return several blocks as one, with further conditions."""
    order = {c.name: k for k, c in enumerate(setting.roles)}
    every = tuple(dict.fromkeys((*(c for block in blocks for c in block.conditions), *conditions)))
    mentioned = {n for b in blocks for n in b.coordinates}.union(*(coordinates_in(c.expr) for c in every))
    rows: list[Row] = [row for block in blocks for row in block.rows]
    rows.sort(key=lambda row: not isinstance(row.piece, Finite))
    names = sorted(mentioned, key=lambda name: (order.get(name, len(order)), name))
    return Block(tuple(names), tuple(rows), every)
