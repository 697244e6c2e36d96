"""Generalized coordinates: which of the scene's own coordinates can be chosen freely, ``dof`` of them."""

from __future__ import annotations

from collections.abc import Collection, Iterable, Sequence
from dataclasses import dataclass, replace
from functools import partial

from dofkit.base.deadline import expired, unless_late
from dofkit.base.verdicts import ArgumentKey, Claim, together
from dofkit.classification import tangent_spaces
from dofkit.classification.freedom.bridged_blocks import with_still_parts
from dofkit.classification.study import Study
from dofkit.classification.turned_coordinates import (
    TurnedGroup,
    are_coordinates,
    chosen_at_drawing,
    partly_turned,
    rows_at_drawing,
    turned_together,
)
from dofkit.configuration.finite_blocks import dependent_names
from dofkit.configuration.rigid_motions import RigidOrbit
from dofkit.configuration.variety import field_jacobian, on_variety, pose_point
from dofkit.exact.matrices.certified import ball_part
from dofkit.exact.matrices.sparse import last_columns, rank_of_rows
from dofkit.exact.zero import BOTH
from dofkit.expressions import tree as ex
from dofkit.expressions.renaming import shape_of
from dofkit.expressions.tree import Expr
from dofkit.relations.answer import BITS, Answer
from dofkit.relations.blocks import Block, make_chart
from dofkit.relations.normal.pieces import Finite
from dofkit.relations.setting import Setting
from dofkit.system import Rotation

#: Relations and coordinates up to so many are looked at.
MOST = 120
#: How a coordinate occurs: once, times a number; in the first degree; in the second; in no such way.
PLAIN, LINEAR, QUADRATIC, OTHER = 0, 1, 2, 9


def explicit(relations: Sequence[Expr], names: Sequence[str], count: int, most: int = LINEAR) -> list[str] | None:
    """The coordinates that are left when ``count`` of the relations are solved for one each, one after another.

    None where that does not go on until the end. What is solved most plainly goes first, then the last of ``names``;
    ``most``: how a coordinate may occur that is solved for, only once in the second degree.
    """
    if len(relations) > MOST or len(names) > MOST:
        return None
    remaining = _readings(relations)
    solved: set[str] = set()
    while len(solved) < count:
        open_ = [n for n in reversed(names) if n not in solved]
        result = min(((r.of[n], k, i) for i, r in enumerate(remaining) for k, n in enumerate(open_) if n in r.of),
                    default=(OTHER, 0, 0))  # fmt: skip
        if result[0] > most:
            return None
        most = LINEAR if result[0] == QUADRATIC else most
        relation = remaining.pop(result[2])
        solved.add(open_[result[1]])
        remaining = [r.without(open_[result[1]], relation) for r in remaining]
    return [n for n in names if n not in solved]


@dataclass(frozen=True)
class _Reading:
    """How each coordinate of a relation occurs in it."""

    of: dict[str, int]

    def without(self, name: str, by: _Reading) -> _Reading:
        """After ``name`` was replaced by what the relation ``by`` gives."""
        if name not in self.of:
            return self
        return _Reading({**{n: k for n, k in self.of.items() if n != name}, **{n: OTHER for n in by.of if n != name}})


def _readings(relations: Iterable[Expr]) -> list[_Reading]:
    """How coordinates occur in every relation; looked at once in those that are the same up to names."""
    degrees_of: dict[Expr, list[tuple[int, int]]] = {}
    result = []
    for g in relations:
        shape = shape_of(g)
        if shape.skeleton not in degrees_of:
            place = {name: k for k, name in enumerate(shape.names)}
            degrees_of[shape.skeleton] = [(place[name], degree) for name, degree in _degrees(g).items()]
        result.append(_Reading({shape.names[k]: degree for k, degree in degrees_of[shape.skeleton]}))
    return result


def _degrees(g: Expr) -> dict[str, int]:
    """Every coordinate of ``g`` with how it occurs."""
    memo: dict[int, dict[str, int]] = {}
    stack = [g]
    while stack:
        node = stack.pop()
        operands = ex.children(node)
        waiting = [part for part in operands if id(part) not in memo]
        if waiting:
            stack += [node, *waiting]
        else:
            memo[id(node)] = _joined(node, [memo[id(part)] for part in operands])
    return memo[id(g)]


def _joined(e: Expr, operands: Sequence[dict[str, int]]) -> dict[str, int]:
    """How coordinates occur in a node, by how they occur in its parts."""
    if e.op == "sym":
        return {str(e.args[1]): PLAIN} if e.args[0] == "coordinate" else {}
    if e.op == "pow" and e.args[1] == ex.TWO:
        return {n: QUADRATIC if k <= LINEAR else OTHER for n, k in operands[0].items()}
    if e.op not in ("add", "mul"):
        return {n: OTHER for part in operands for n in part}
    single = e.op == "mul" and sum(p.op not in ("num", "const") for p in e.args) == 1
    result: dict[str, int] = {}
    for part in operands:
        for name, k in part.items():
            degree = k if single or e.op == "add" else max(k, LINEAR)
            result[name] = degree if name not in result else _both(e.op, result[name], degree)
    return result


def _both(op: str, first: int, second: int) -> int:
    """Of a coordinate in two terms, or in two factors."""
    if op == "add":
        return max(first, second, LINEAR)
    return QUADRATIC if max(first, second) == LINEAR else OTHER


#: Arguments by which every part of the set is as good as every other.
ALIKE: frozenset[ArgumentKey | None] = frozenset(
    {
        "nothing constrains",
        "one relation",
        "graph",
        "links in general position",
        "Lie algebra, certified",
        "states of motion",
        "exact elimination",
    }
)
#: Coordinates up to so many are looked for on a tangent space.
MAX_COLUMNS = 120


def generalized_coordinates(study: Study) -> list[str] | None:
    """Return an independent choice of ``dof`` coordinates: those that are not pivots of what integrates."""
    return unless_late(partial(_of_system, study), None)


def _of_system(study: Study) -> list[str] | None:
    system, outcome = study.system, study.outcome
    if outcome.dof is None:
        return None
    chosen = set(outcome.untouched)
    places_of: dict[int, list[int]] = {}
    for block, a in zip(outcome.blocks, outcome.answers, strict=True):
        places = None if a.kind is None else places_of.get(a.kind)
        if places is None:
            names = _of_block(block, a, study.setting, system.rotations)
        else:
            names = [block.coordinates[k] for k in places]
        if names is None:
            return None
        if a.kind is not None and not system.rotations:
            places_of[a.kind] = [block.coordinates.index(name) for name in names]
        chosen.update(names)
    for group in _turned_groups(study, chosen):
        if group.places == 1:
            continue
        free = chosen.intersection(group.block.coordinates)
        whole = Answer(dof=len(free), dependent=group.block.coordinates, hidden=[*group.hidden])
        names = _of_block(group.block, whole, study.setting, system.rotations)
        if names is None:
            return None
        chosen = chosen - free | set(names)
    return [c.name for c in system.coordinates if c.name in chosen]


def _turned_groups(study: Study, chosen: Collection[str]) -> Iterable[TurnedGroup]:
    """Return the groups of blocks that hold the angles of bodies of which some angles are chosen and some are not."""
    turning = partly_turned(chosen, study.system.rotations) if study.system.rotations else ()
    outcome = study.outcome
    return turned_together(outcome.blocks, outcome.answers, outcome.untouched, turning) if turning else ()


def claim_of_choice(study: Study, free: Claim, chosen: Sequence[str]) -> Claim:
    """Of the generalized coordinates: the others have independent rows, at the reference or at a generic point.

    Where the set may have several parts the point may lie on another one. At a singular reference the set is known
    where it is the orbit of the whole as one body; elsewhere it may be no graph over any coordinates. Where
    some angles of a body that turns are chosen, at a certified configuration.
    """
    of_blocks = []
    for block, a in zip(study.outcome.blocks, study.outcome.answers, strict=True):
        if a.argument in ALIKE or not a.dof or (a.about == "reference" and a.instantaneous == a.velocity_dof):
            of_blocks.append(counted(a.claim))
        elif a.argument == "joints that close no loop":
            of_blocks.append(replace(counted(a.claim), about="component"))
        elif a.about == "reference":
            orbit = orbit_at_reference(block, a, study.setting)
            sure = orbit is not None and orbit.rank(chosen) == a.dof
            near = Claim("probable", "generic points", bits=BITS, about="component")
            of_blocks.append(counted(a.claim) if sure else together(a.claim, near))
        elif regular_at_witness(block.coordinates, a, chosen):
            of_blocks.append(replace(a.claim, about="component"))
        else:
            of_blocks.append(together(a.claim, Claim("probable", "generic points", bits=BITS)))
    for group in _turned_groups(study, chosen):
        if not are_coordinates(group, chosen, study.setting, study.system.rotations):
            of_blocks.append(Claim("probable", "generic points", bits=BITS, about="component"))
    return together(*of_blocks) if of_blocks else counted(free)


def counted(claim: Claim) -> Claim:
    """A number that is counted from another: a proof of it is a proof by counting."""
    return Claim("proved", "count", claim.bits, claim.gap, claim.about) if claim.verdict == "proved" else claim


def _of_block(block: Block, a: Answer, setting: Setting, rotations: Sequence[Rotation]) -> list[str] | None:
    """The free coordinates of a block; None where none could be told."""
    if a.dof is None:
        return None
    if a.dof == 0:
        return []
    block_coordinates = frozenset(block.coordinates)
    turning = [r for r in rotations if r.chart == "gibbs" and not block_coordinates.isdisjoint(r.names)]
    dependent = set(a.dependent if a.answered_parts is None else _dependent_at_drawing(block, a, setting))
    direct = _regular_at_reference(block, a, setting) or [c for c in block.coordinates if c not in dependent]
    if not turning and len(direct) == a.dof:
        chosen = _explicit(block, a.dof, setting)
        return direct if chosen is None or not _is_regular(block, a, chosen, setting) else chosen
    if setting.engines != BOTH:
        return direct if len(direct) == a.dof and not turning else None
    whole = direct if len(direct) == a.dof and not (turning and partly_turned(direct, turning)) else None
    drawn = None if whole or not turning else chosen_at_drawing(TurnedGroup(block, tuple(a.hidden)), setting, turning)
    if drawn is not None and len(drawn) == a.dof:
        return drawn
    if len(block.coordinates) > MAX_COLUMNS or expired():
        return whole
    if block.forms or block.nonlinear:
        if whole or not (block.finite or a.hidden):
            return whole
        finite = Block(block.coordinates, block.finite, block.conditions)
        return tangent_spaces.nearby(finite, a.dof, setting, turning, a.hidden)
    orbit = None if turning else orbit_at_reference(block, a, setting)
    if orbit is not None:
        return orbit.chart_of()
    block = with_still_parts(block, a, setting)
    result = tangent_spaces.nearby(block, a.dof, setting, turning)
    return result if result is not None or turning else whole


def _dependent_at_drawing(block: Block, a: Answer, setting: Setting) -> tuple[str, ...]:
    """Coordinates that the rows at the reference can be solved for, the last ones where there is a choice.

    Of bodies whose joints close no loop places are solved for before angles.
    """
    result = rows_at_drawing(TurnedGroup(block, ()), setting)
    if result is None:
        return ()
    block_names = frozenset(block.coordinates)
    places = frozenset(
        c.name for c in setting.roles if not a.answered_parts and c.name in block_names and c.role in ("x", "y", "z")
    )
    names = sorted(block.coordinates, key=places.__contains__)
    place = {name: k for k, name in enumerate(names)}
    rows = [{place[name]: v for name, v in row.items()} for row in result.rows]
    return tuple(names[c] for c in last_columns(rows, len(place), result.p))


def orbit_at_reference(block: Block, a: Answer, setting: Setting) -> RigidOrbit | None:
    """Where a drawing is singular and yet moves as one body alone: its orbit. None elsewhere."""
    alone = a.about == "reference" and a.instantaneous != a.velocity_dof and not block.forms and not block.nonlinear
    return RigidOrbit.at_reference(make_chart(block, setting), a.dof) if alone and a.dof else None


def regular_at_witness(names: Sequence[str], a: Answer, chosen: Sequence[str]) -> bool | None:
    """Return whether the finite relations, by the coordinates that are not chosen, have full rank at the witness.

    None where no rows are known there. What divides by a coefficient may divide by 0 on the part of the witness.
    """
    if a.real is None or a.dof is None:
        return None
    columns = [k for k, name in enumerate(a.real.names) if name in names and name not in chosen]
    return ball_part([[row[k] for k in columns] for row in a.real.matrix]).rank == len(names) - a.dof


def _is_regular(block: Block, a: Answer, chosen: Sequence[str], setting: Setting) -> bool:
    """Return whether the relations, by the coordinates that are not chosen, have full rank at the examined point.

    A coefficient that was divided by may be 0 all over the set; at a reference these are numbers. Of what was answered
    by parts no rows are known.
    """
    if a.answered_parts is not None:
        return setting.reference is not None
    if regular_at_witness(block.coordinates, a, chosen) is False:
        return False
    if not a.matrix or a.modulus <= 2:
        return True
    remaining = {k for k, name in enumerate(block.coordinates) if name not in chosen}
    rows = [{c: v for c, v in row.items() if c in remaining} for row in a.matrix]
    return rank_of_rows(rows, a.modulus) == len(remaining)


def _regular_at_reference(block: Block, a: Answer, setting: Setting) -> list[str] | None:
    """Of a block with forms, none of which integrates: those for which its finite relations solve at the reference.

    None where there is no reference, or the relations are dependent there.
    """
    if setting.reference is None or not block.forms or "field" not in setting.engines:
        return None
    chart = make_chart(block, setting, a.hidden)
    point = pose_point(chart, {**setting.reference, ex.TIME: ex.ZERO}, 3)
    if point is None or not on_variety(chart, point):
        return None
    dependent = dependent_names(field_jacobian(chart, point), chart, point.p)
    return (
        [c for c in block.coordinates if c not in dependent]
        if len(block.coordinates) - len(dependent) == a.dof
        else None
    )


def _explicit(block: Block, dof: int, setting: Setting) -> list[str] | None:
    """Those by which the relations give all others at once: an angle rather than what it makes of lengths.

    At a reference configuration a coefficient may be 0, so that only numbers are divided by there.
    """
    if block.forms or block.nonlinear or len(block.coordinates) > MOST:
        return None
    relations = [p.expr for r in block.finite if isinstance(p := r.piece, Finite)]
    most = QUADRATIC if setting.reference is None else PLAIN
    return explicit(relations, block.coordinates, len(block.coordinates) - dof, most)
