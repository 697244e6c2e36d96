"""Motions along which every expression in velocities has a value as written.

The equation dy/dx = 2 means dy - 2 dx = 0 where dx is not 0. Together with x = 3, dy/dx has a value along no motion.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import replace
from functools import partial

from dofkit.base.deadline import unless_late
from dofkit.base.verdicts import weakest
from dofkit.classification.freedom.common_point import CommonPoint, merged, text_of_conditions
from dofkit.expressions.renaming import coordinates_in
from dofkit.expressions.tree import Expr
from dofkit.relations.answer import Answer
from dofkit.relations.blocks import Block, Row
from dofkit.relations.normal.domain import DomainCondition
from dofkit.relations.normal.no_solution import hold_nowhere, holds_somewhere
from dofkit.relations.normal.normal_form import normalise
from dofkit.relations.normal.pieces import Finite, Nonlinear, Pfaffian
from dofkit.relations.setting import Setting
from dofkit.relations.velocity_reductions import rate


def with_values_in_motion(
    result: CommonPoint,
    domain: Sequence[tuple[int, DomainCondition]],
    setting: Setting,
    answered: Callable[[Block], Answer],
) -> CommonPoint:
    """Return the result, inconsistent if no motion satisfies the ``domain``, undecided if none is known to do so.

    ``domain``: (constraint, condition in velocities for it to have a value as written). ``answered`` analyses a block.
    """
    blocks, answers = result[:2]
    if any(a.consistent is not True for a in answers):
        return result
    names = frozenset[str]().union(*(coordinates_in(c.expr) for _, c in domain))
    members = [i for i, block in enumerate(blocks) if not names.isdisjoint(block.coordinates)]
    conditions = tuple(dict.fromkeys(c for _, c in domain))
    unplaced = () if members else tuple(dict.fromkeys(i for i, _ in domain))
    together = [blocks[i] for i in members]
    within = tuple(c for block in together for c in block.conditions)
    block = replace(merged(together, conditions, setting), conditions=within)
    why = f"as written, the equations require {text_of_conditions(conditions)}, which"
    if unless_late(partial(hold_nowhere, _equations_of_motion(block), conditions, setting.positive), False):
        none = Answer(False, verdict="proved", argument="outside the domain", reasons=[f"{why} no motion satisfies"])
        refuted = [none if i in members else a for i, a in enumerate(answers)]
        return result._replace(answers=refuted, nowhere=(*result.nowhere, *unplaced))
    sides = [c.expr for c in conditions if c.sense != "!="]
    symbols = [s for e in sides for s in e.symbols]
    apart = len(symbols) == len({*symbols}) and all(s.args[0] in ("coordinate", "velocity") for s in symbols)
    if unplaced and apart and all(holds_somewhere(e, True, setting.positive) for e in sides):
        return result
    free = len(block.coordinates) - sum(len(block.coordinates) for block in together)
    freedoms = [n if n is None else n + free for n in _freedoms([answers[i] for i in members])]
    # states of nonlinear rows are searched only where these have a value
    owners = {row.constraint for row in block.nonlinear}
    outside = [a for i, c in domain if i not in owners for a in _where_it_vanishes(block, i, c, setting, answered)]
    if None not in freedoms and all(_is_less(a, freedoms) for a in outside):
        sure = weakest(*(a.verdict for a in outside))
        in_domain = [replace(a, verdict=weakest(a.verdict, sure)) if i in members else a for i, a in enumerate(answers)]
        return result._replace(answers=in_domain)
    unknown = Answer(None, verdict="undecided", reasons=[f"{why} no motion is known to satisfy"])
    undecided = [unknown if i in members else a for i, a in enumerate(answers)]
    return result._replace(answers=undecided, unsettled=(*result.unsettled, *unplaced))


def _where_it_vanishes(
    block: Block, owner: int, condition: DomainCondition, setting: Setting, answered: Callable[[Block], Answer]
) -> list[Answer]:
    """Return the answers of the block with each branch of u = 0, for a condition u != 0; undecided for others."""
    if condition.sense != "!=":
        return [Answer(None)]
    vanishing = [*_equations_of_motion(block), condition.expr]
    if unless_late(partial(hold_nowhere, vanishing, (), setting.positive), False):
        return []
    branches = normalise(condition.expr, setting.positive, True).branches
    # leaving out the conditions of a branch can only enlarge the set on which u is 0
    added = [[Row(owner, p) for p in branch if not isinstance(p, DomainCondition)] for branch in branches]
    return [answered(replace(block, rows=(*block.rows, *rows))) for rows in added]


def _equations_of_motion(block: Block) -> list[Expr]:
    """Return the expressions in coordinates and velocities that are 0 along every motion."""
    finite = [row.piece.expr for row in block.finite if isinstance(row.piece, Finite)]
    forms = [row.piece.rate for row in block.forms if isinstance(row.piece, Pfaffian)]
    others = [row.piece.expr for row in block.nonlinear if isinstance(row.piece, Nonlinear)]
    return [*finite, *map(rate, finite), *forms, *others]


def _is_less(outside: Answer, freedoms: Sequence[int | None]) -> bool:
    """Return whether the motions with u = 0 are none, or have other freedoms than all motions (then fewer)."""
    fewer = _freedoms([outside])
    return outside.consistent is False or bool(outside.consistent and None not in fewer and fewer != freedoms)


def _freedoms(answers: Sequence[Answer]) -> list[int | None]:
    """Return [sum of the freedoms, sum of the velocity freedoms] of some answers; None for an unknown sum."""
    numbers = [a.dof for a in answers], [a.velocity_dof for a in answers]
    return [None if None in some else sum(n for n in some if n is not None) for some in numbers]
