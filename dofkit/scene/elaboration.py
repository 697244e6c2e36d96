"""The constraints of a scene, one after another: each with its relations, what it connects, and its faults."""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterator, Sequence
from typing import NamedTuple

from dofkit.base.deadline import check as out_of_time
from dofkit.base.errors import Fault
from dofkit.expressions.renaming import Unwritten
from dofkit.scene.constraints import ConstraintBase
from dofkit.scene.drawing import Drawing
from dofkit.scene.ledger import Ledger
from dofkit.scene.world import NO_FINDINGS, Before, Findings, Mentioned, World
from dofkit.system import Connection, Constraint


class Elaboration(NamedTuple):
    """A constraint with its relations, what it connects, and what else came of reading it."""

    constraint: Constraint
    connection: Connection
    findings: Findings


def elaborations(constraints: Sequence[ConstraintBase], drawing: Drawing, faults: int) -> Iterator[Elaboration]:
    """Each constraint in its turn; ``faults``: how many were found in what was read earlier."""
    names = names_by_position("c", [c.name for c in constraints])
    drawn, generic = set(drawing.drawn), 0
    entries = dict(zip(names, constraints, strict=True))
    for index, constraint in enumerate(constraints):
        out_of_time()
        world = World(drawing, ("constraints", index), Before(faults, generic, drawn), entries)
        lowered = _constraint_of(world, constraint, names[index])
        found = world.findings()
        yield Elaboration(lowered, _connection(world.mentioned, index, lowered), found)
        if found is not NO_FINDINGS:
            drawn |= found.drawn
            generic += len(found.generic)
            faults += len(found.faults)


def names_by_position(letter: str, given: Sequence[str | None]) -> tuple[str, ...]:
    """``c1``, ``c2``, ... by position for those without a name."""
    return tuple(f"{letter}{i + 1}" if name is None else name for i, name in enumerate(given))


def repeat_faults(key: str, letter: str, given: Sequence[str | None]) -> Iterator[Fault]:
    """A fault for each entry of ``key`` whose name, given or by position, is that of an entry before it."""
    names = names_by_position(letter, given)
    repeated = {name for name, times in Counter(names).items() if times > 1}
    first: dict[str, int] = {}
    for i, name in enumerate(names):
        if name in repeated and first.setdefault(name, i) != i:
            ledger = Ledger((key, i))
            other = first[name]
            if given[i] is None or given[other] is None:
                default = i if given[i] is None else other
                message = f"the name '{name}' is given twice: it is the default name of entry {default + 1}"
            else:
                message = f"the name '{name}' is given twice"
            ledger.fault(
                message, *(() if given[i] is None else ("name",)), hint=f"rename one of them: `name: {name}_2`"
            )
            yield from ledger.faults


def _constraint_of(world: World, constraint: ConstraintBase, name: str) -> Constraint:
    kind = constraint.kind()
    if world.dimension not in constraint.dimensions:
        allowed = " or ".join(str(d) for d in constraint.dimensions)
        message = f"'{kind}' is defined in dimension {allowed}; this scene has dimension {world.dimension}"
        world.fault(message, "type", hint=_INSTEAD[world.dimension])
        return Constraint(name, kind, constraint.facts, constraint.in_words, ())
    found = constraint.relations(world)
    relations = found if isinstance(found, Unwritten) else tuple(found)
    return Constraint(name, kind, constraint.facts, constraint.in_words, relations, tuple(constraint.notes(world)))


def _connection(mentioned: Mentioned, index: int, constraint: Constraint) -> Connection:
    """What a constraint that has been lowered connects."""
    return Connection(
        index,
        constraint.facts,
        tuple(dict.fromkeys(mentioned.members)),
        tuple(mentioned.points),
        tuple(mentioned.places),
        tuple(mentioned.directions),
        mentioned.number,
        not isinstance(constraint.relations, Unwritten)
        and any(relation.part == "drive" for relation in constraint.relations),
        tuple(mentioned.rates),
    )


_INSTEAD = {
    1: "on a line use coincident, fixed, link or an equation",
    2: "in the plane use revolute, prismatic, weld or slot",
    3: "in space use cylindrical, screw or an equation",
}
