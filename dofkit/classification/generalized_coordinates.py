"""Generalized coordinates: which of the scene's own coordinates can be chosen freely, ``dof`` of them."""

from __future__ import annotations

from collections.abc import Collection, Iterable, Mapping, Sequence
from dataclasses import replace
from functools import partial

from dofkit.base.deadline import expired, unless_late
from dofkit.base.verdicts import OPEN, About, ArgumentKey, Claim, least, together
from dofkit.classification import tangent_spaces
from dofkit.classification.study import Decided, Study, counted, decided
from dofkit.classification.turned_coordinates import (
    TurnedGroup,
    are_coordinates,
    chosen_at_reference,
    partly_turned,
    rows_at_reference,
    turned_together,
)
from dofkit.configuration.rigid_motions import RigidOrbit
from dofkit.exact.matrices.certified import ball_part
from dofkit.exact.matrices.sparse import last_columns, rank_of_rows
from dofkit.exact.zero import BOTH
from dofkit.expressions import tree as ex
from dofkit.expressions.renaming import coordinates_in
from dofkit.expressions.tree import Expr
from dofkit.relations.answer import BITS, Answer
from dofkit.relations.blocks import Block, make_chart
from dofkit.relations.linear_relations import constant_coefficients, explicit_relations, number_coefficients
from dofkit.relations.normal.pieces import Finite
from dofkit.relations.setting import Setting
from dofkit.system import Rotation

#: Bound on the coordinates of a block for the slower methods.
MOST = 120
#: Arguments that are valid on every component of the configuration space.
ALIKE: frozenset[ArgumentKey | None] = frozenset(
    {
        "nothing constrains",
        "graph",
        "links in general position",
        "Lie algebra, certified",
        "states of motion",
        "exact elimination",
    }
)


def generalized_coordinates(study: Study) -> Decided:
    """Return a choice of ``dof`` independent coordinates by name, with its claim."""
    chosen = unless_late(partial(_of_system, study), None)
    return decided(study, chosen, OPEN if chosen is None else claim_of_choice(study, chosen))


def _of_system(study: Study) -> list[str] | None:
    system, outcome = study.system, study.outcome
    if outcome.dof is None:
        return None
    chosen = set(outcome.untouched)
    places_of: dict[int, list[int]] = {}  # blocks that are equal up to names get the same choice
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
        of_group = Answer(dof=len(free), dependent=group.block.coordinates, hidden=[*group.hidden])
        names = _of_block(group.block, of_group, study.setting, system.rotations)
        if names is None:
            return None
        chosen = chosen - free | set(names)
    return [c.name for c in system.coordinates if c.name in chosen]


def _turned_groups(study: Study, chosen: Collection[str]) -> Iterable[TurnedGroup]:
    """Return the groups of blocks with the angles of bodies of which some angles are chosen and some are not."""
    turning = partly_turned(chosen, study.system.rotations) if study.system.rotations else ()
    outcome = study.outcome
    return turned_together(outcome.blocks, outcome.answers, outcome.untouched, turning) if turning else ()


def claim_of_choice(study: Study, chosen: Sequence[str]) -> Claim:
    """Return the claim that ``chosen`` are coordinates: the columns of the others are independent at some point.

    The point is the reference or a generic one; if the set may have several components, it may lie on another one. At
    a singular reference, the choice is certain if the set is the orbit of the system as one body. If some angles of a
    body are chosen, the choice is tested at a certified configuration.
    """
    of_blocks = []
    for block, a in zip(study.outcome.blocks, study.outcome.answers, strict=True):
        scope: About = "component" if a.one_branch else "everywhere"
        alike = a.argument in ALIKE or (a.argument == "one relation" and not _may_be_parted(block))
        if alike or not a.dof or (a.about == "reference" and a.instantaneous == a.velocity_dof):
            of_blocks.append(counted(replace(a.claim, about=least(a.about, scope))))
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
            of_blocks.append(together(a.claim, Claim("probable", "generic points", bits=BITS, about=scope)))
    for group in _turned_groups(study, chosen):
        if not are_coordinates(group, chosen, study.setting, study.system.rotations):
            of_blocks.append(Claim("probable", "generic points", bits=BITS, about="component"))
    return together(*of_blocks) if of_blocks else counted(study.free)


def _of_block(block: Block, a: Answer, setting: Setting, rotations: Sequence[Rotation]) -> list[str] | None:
    """Return a choice of ``a.dof`` coordinates of a block, by several methods in turn; None if all fail."""
    if a.dof is None:
        return None
    if a.dof == 0:
        return []
    block_coordinates = frozenset(block.coordinates)
    turning = [r for r in rotations if r.chart == "gibbs" and not block_coordinates.isdisjoint(r.names)]
    of_joints = partial(_dependent_at_reference, TurnedGroup(block, ()), setting, places_first=not a.answered_parts)
    dependent = set(a.dependent if a.answered_parts is None else of_joints())
    direct = [c for c in block.coordinates if c not in dependent]
    if a.real is not None and regular_at_witness(block.coordinates, a, direct) is False:
        dependent = {a.real.names[k] for k in ball_part(a.real.matrix).columns}
        direct = [c for c in block.coordinates if c not in dependent]
    if not turning and len(direct) == a.dof:
        chosen = _explicit(block, a.dof, setting)
        return direct if chosen is None or not _is_regular(block, a, chosen, setting) else chosen
    if setting.engines != BOTH:
        return direct if len(direct) == a.dof and not turning else None
    suitable = direct if len(direct) == a.dof and not (turning and partly_turned(direct, turning)) else None
    group = TurnedGroup(block, tuple(a.hidden))
    at_reference = None if suitable or not turning else chosen_at_reference(group, setting, turning)
    if at_reference is not None and len(at_reference) == a.dof:
        return at_reference
    if block.forms or block.nonlinear or len(block.coordinates) > MOST or expired():
        return suitable
    orbit = None if turning else orbit_at_reference(block, a, setting)
    if orbit is not None:
        return orbit.chart_of()
    result = tangent_spaces.nearby(block, a.dof, setting, turning)
    return result if result is not None or turning else suitable


def _dependent_at_reference(group: TurnedGroup, setting: Setting, places_first: bool = False) -> tuple[str, ...]:
    """Return coordinates for which the rows at the reference can be solved, later ones (or x, y, z) preferred."""
    result = rows_at_reference(group, setting)
    if result is None:
        return ()
    names, block_names = group.block.coordinates, frozenset(group.block.coordinates)
    if places_first:
        places = frozenset(c.name for c in setting.roles if c.name in block_names and c.role in ("x", "y", "z"))
        names = tuple(sorted(names, key=places.__contains__))
    place = {name: k for k, name in enumerate(names)}
    rows = [{place[name]: v for name, v in row.items()} for row in result.rows]
    return tuple(names[c] for c in last_columns(rows, len(place), result.p))


def _may_be_parted(block: Block) -> bool:
    """Return whether one relation has functions of coordinates: 2 x y + sin(x) has no factor x, and is 0 at x = 0."""
    relations = [r.piece.expr for r in block.finite if isinstance(r.piece, Finite)]
    nodes = (n for e in relations for n in ex.nodes(e) if n.op == "fn" or (n.op == "pow" and "pow" in n.functions))
    return any(map(coordinates_in, nodes)) and bool(explicit_relations(relations).implicit)


def orbit_at_reference(block: Block, a: Answer, setting: Setting) -> RigidOrbit | None:
    """Return the orbit of the system as one body, if the reference is singular and nothing else moves; else None."""
    singular = a.about == "reference" and a.instantaneous != a.velocity_dof and not block.forms and not block.nonlinear
    return RigidOrbit.at_reference(make_chart(block, setting), a.dof) if singular and a.dof else None


def regular_at_witness(names: Sequence[str], a: Answer, chosen: Sequence[str]) -> bool | None:
    """Return whether the columns of the coordinates that are not chosen are independent at the witness.

    None if no rows are known there. (A coefficient that was divided by may be 0 on the component of the witness.)
    """
    if a.real is None or a.dof is None:
        return None
    columns = [k for k, name in enumerate(a.real.names) if name in names and name not in chosen]
    return ball_part([[row[k] for k in columns] for row in a.real.matrix]).rank == len(names) - a.dof


def _is_regular(block: Block, a: Answer, chosen: Sequence[str], setting: Setting) -> bool:
    """Return whether the columns of the coordinates that are not chosen are independent at the examined point.

    (A coefficient that was divided by may be 0 on the set; at a reference only numbers are divided by, so that a block
    analysed in parts, of which no rows are known, is regular.)
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


def _explicit(block: Block, dof: int, setting: Setting) -> list[str] | None:
    """Return ``dof`` coordinates of which all others are explicit functions by the relations; None if there are none.

    Preferably those with a number as coefficient are solved for, then later ones. At a reference configuration another
    coefficient may be 0, so that only numbers are divided by there.
    """
    if block.forms or block.nonlinear or len(block.coordinates) > MOST:
        return None
    relations = [p.expr for r in block.finite if isinstance(p := r.piece, Finite)]
    place = {ex.coordinate(name): k for k, name in enumerate(block.coordinates)}
    coefficients = constant_coefficients if setting.reference is None else number_coefficients

    def last(g: Expr) -> Mapping[Expr, Expr]:
        slopes = coefficients(g)
        numbers_last = sorted(slopes, key=lambda s: (slopes[s].op == "num", place[s]))
        return {s: slopes[s] for s in numbers_last[-1:]}

    solved = explicit_relations(relations, last).explicit
    chosen = [name for name in block.coordinates if ex.coordinate(name) not in solved]
    return chosen if len(chosen) == dof else None
