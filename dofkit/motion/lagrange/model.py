"""A classified system with its energies, prepared for Lagrange's equations by eliminating coordinates."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from contextlib import suppress
from dataclasses import dataclass
from functools import cached_property

from dofkit.base.errors import DofkitError, Fault, NoValueError, SceneError, TextError
from dofkit.classification.freedom.branches import in_time
from dofkit.classification.passes import Examined
from dofkit.exact.matrices.sparse import echelon, without_time
from dofkit.exact.ring.program import raising_no_value
from dofkit.expressions import tree as ex
from dofkit.expressions.calculus import diff, substitute
from dofkit.expressions.text import parse_relations
from dofkit.expressions.text.names import Names, UnknownNameError
from dofkit.expressions.tree import ZERO, Expr
from dofkit.motion.lagrange.elimination import (
    EliminatedRelation,
    Elimination,
    Eliminator,
    Remaining,
    expressions_of,
    in_velocities,
    inserted,
    motions,
    vanishes,
    without_roots,
)
from dofkit.motion.lagrange.energies import MISSING, Energy
from dofkit.relations.blocks import Row, split
from dofkit.relations.normal.pieces import Finite, Nonlinear, Pfaffian
from dofkit.relations.setting import Setting
from dofkit.report import BRANCH_WARNING

#: The most constants of integration in one integral.
MOST_CONSTANTS = 4


class NoEquationsError(DofkitError):
    """The equations of motion of a scene cannot be written down; the message says why."""


@dataclass(frozen=True)
class LagrangeModel:
    """The energies and constraints from which Lagrange's equations are derived.

    ``names``: the remaining coordinates; ``energy`` in these, ``whole`` in all coordinates; ``constraints``: the
    independent relations that keep a multiplier; ``left_out``: the redundant constraints.
    """

    study: Examined
    names: tuple[str, ...]
    energy: Energy
    whole: Energy
    elimination: Elimination
    constraints: tuple[Remaining, ...]
    left_out: tuple[str, ...]
    notes: tuple[str, ...]

    @property
    def positive(self) -> frozenset[Expr]:
        """The positive parameters."""
        return self.study.setting.positive

    @cached_property
    def motions(self) -> dict[Expr, Expr]:
        """{eliminated coordinate, velocity or acceleration: expression in the remaining ones}."""
        return motions(self.elimination.solved)

    @property
    def holonomic(self) -> list[Expr]:
        """g of the geometric equations g(q, t) = 0 that keep a multiplier."""
        return [c.expr for c in self.constraints if isinstance(c, Finite)]

    @property
    def nonholonomic(self) -> list[Expr]:
        """The relations between velocities that keep a multiplier."""
        return [in_velocities(c) for c in self.constraints if not isinstance(c, Finite)]

    @cached_property
    def slopes(self) -> list[dict[str, Expr]]:
        """The coefficients a of each multiplier, by coordinate: dg/dq of g = 0, and dr/dqdot of r(q, qdot, t) = 0."""
        finite = [{n: diff(g, ex.coordinate(n)) for n in self.names} for g in self.holonomic]
        return finite + [{n: diff(r, ex.velocity(n)) for n in self.names} for r in self.nonholonomic]

    def applied(self, name: str) -> Expr:
        """Return the non-conservative generalized force along a coordinate, damping included."""
        return self.energy.forces.get(name, ZERO) - diff(self.energy.dissipation, ex.velocity(name))


def lagrange_model(study: Examined, energy: Energy, names: Names, eliminates: bool = True) -> LagrangeModel:
    """Return the model with as much eliminated as possible in closed form, or nothing if not ``eliminates``.

    Integrals of differential constraints are used if their constants do not enter the motion. Raises SceneError if the
    system is inconsistent, NoEquationsError if it is undecided.
    """
    _check_decided(study)
    outcome = study.outcome
    coordinates = [c.name for c in study.system.coordinates]
    free = study.report.generalized_coordinates or []
    finite = [EliminatedRelation(r.piece.expr) for r in outcome.rows if isinstance(r.piece, Finite)]
    finite += [EliminatedRelation(g) for a in outcome.answers for g in a.hidden]
    integrals = list(_integrals(study, names))
    eliminator = Eliminator(study.setting.positive, energy.potential, study.system.reference)
    for relations in ([*finite, *integrals], finite, []) if eliminates else ([],):
        elimination = _agreeing(eliminator, relations, coordinates, free)
        with suppress(NoValueError):  # an expression may have no value once coordinates are eliminated
            model = _built(study, energy, elimination, coordinates)
            if model is not None:
                return model
    raise NoEquationsError("it is undecided which constraints are independent, so no equations of motion are given")


def _agreeing(
    eliminator: Eliminator, relations: Sequence[EliminatedRelation], coordinates: Sequence[str], free: Sequence[str]
) -> Elimination:
    """Return an elimination that keeps the report's generalized coordinates ``free`` if it eliminates as many."""
    dependent = [c for c in coordinates if c not in free]
    elimination = eliminator.eliminated(relations, coordinates, dependent)
    if elimination.solved.keys() != set(dependent) and len(elimination.solved) == len(dependent):
        other = eliminator.eliminated(relations, dependent, dependent, roots=False)
        if len(other.solved) == len(dependent):
            return other
    return elimination


def _check_decided(study: Examined) -> None:
    """Raise SceneError for an inconsistent system, NoEquationsError if it has branches or is undecided."""
    report = study.report
    if report.consistent is False:
        names = ", ".join(report.conflicting) or "its constraints"
        raise SceneError((Fault(f"the scene is inconsistent: no motion satisfies all of {names}", ("constraints",)),))
    several = [c.name for c in report.constraints if BRANCH_WARNING.format(name=c.name) in report.warnings]
    if several:
        raise NoEquationsError(
            f"{', '.join(several)} is satisfied on several branches, each with its own motions: write the branch"
            " that is meant"
        )
    if report.consistent is None or report.dof is None or report.velocity_dof is None:
        why = "; ".join(dict.fromkeys(r for a in study.outcome.answers for r in a.reasons)) or "it was not decided"
        raise NoEquationsError(f"it is undecided how the system can move, so no equations of motion are given: {why}")


def _integrals(study: Examined, names: Names) -> Iterator[EliminatedRelation]:
    """Yield the integrals, as geometric equations, of holonomic differential constraints."""
    owners = {r.constraint for r in study.outcome.rows if isinstance(r.piece, Pfaffian)}
    for i in sorted(owners):
        entry = study.report.constraints[i]
        if entry.holonomic and entry.integral is not None:
            relation = _read_integral(entry.integral, names)
            if relation is not None:
                yield relation


def _read_integral(text: str, names: Names) -> EliminatedRelation | None:
    """Return an integral with its unknown names as constants; None if it cannot be read so."""
    constants: dict[str, Expr] = {}
    while len(constants) <= MOST_CONSTANTS:
        vocabulary = Names(names.coordinates, {**names.parameters, **constants}, names.functions, names.arguments)
        try:
            (relation,) = parse_relations(text, vocabulary)
        except UnknownNameError as error:
            constants[error.name] = ex.parameter(error.name)
        except (TextError, ValueError):
            return None
        else:
            return EliminatedRelation(relation.left - relation.right, frozenset(constants.values()))
    return None


@raising_no_value
def _built(
    study: Examined, energy: Energy, elimination: Elimination, coordinates: Sequence[str]
) -> LagrangeModel | None:
    """Return the model after an elimination; None if constants enter it, or the number of constraints is not right."""
    kept = elimination.kept(coordinates)
    reduced = _reduced(energy, elimination, kept, study.setting)
    if reduced is None:
        return None
    pieces = [inserted(r.piece, elimination) for r in study.outcome.rows if isinstance(r.piece, Remaining)]
    pieces += [inserted(Finite(g), elimination) for a in study.outcome.answers for g in a.hidden]
    remaining = [p for p in pieces if not vanishes(p, study.setting.positive)]
    if any(e.symbols & elimination.constants for p in remaining for e in expressions_of(p)):
        return None
    chosen = independent(kept, remaining, study.setting)
    if chosen is None or len(elimination.solved) + len(chosen) != len(coordinates) - (study.report.velocity_dof or 0):
        return None
    notes = [*reduced.notes, *elimination.notes]
    if any(isinstance(c, Nonlinear) for c in chosen):
        notes.append(
            "Constraints nonlinear in the velocities follow Chetaev's rule: their force is along the velocity gradient."
        )
    one_sided = [e.name for e in study.report.constraints if e.form == "inequality"]
    if one_sided:
        notes.append(f"The equations are valid while no inequality is an equality: {', '.join(one_sided)}.")
    used = sorted(str(c.args[1]) for c in elimination.constants)
    if used:
        notes.append(f"Constants of integration, fixed by the initial conditions: {', '.join(used)}.")
    notes += [n for n in study.report.warnings if "branch" in n]
    notes += [f"Not modelled: {text}." for text in study.system.left_out]
    return LagrangeModel(
        study,
        tuple(kept),
        reduced,
        energy,
        elimination,
        tuple(chosen),
        tuple(study.report.redundant or ()),
        tuple(notes),
    )


def _reduced(energy: Energy, elimination: Elimination, kept: Sequence[str], setting: Setting) -> Energy | None:
    """Return the energies in the remaining coordinates; None if a constant of integration enters the motion.

    A constant, or missing mass, that only adds a function of time is dropped. Forces: Q_j = sum Q_i dq_i/dq_j.
    """
    solved = elimination.solved
    if not solved:
        return energy
    mapping = motions(solved)

    def insert(e: Expr) -> Expr:
        return substitute(e, mapping)

    potential, kinetic = insert(energy.potential), insert(energy.kinetic)
    for idle in (*elimination.constants, *(s for s in energy.symbols if str(s.args[1]).startswith(MISSING))):
        if not any(s.args[0] in ("coordinate", "velocity") for s in diff(kinetic - potential, idle).symbols):
            kinetic, potential = substitute(kinetic, {idle: ZERO}), substitute(potential, {idle: ZERO})
    forces: dict[str, Expr] = {n: insert(f) for n, f in energy.forces.items() if n not in solved}
    for name, force in energy.forces.items():
        if name in solved:
            for j in kept:
                slope = diff(solved[name], ex.coordinate(j))
                if not slope.is_zero:
                    forces[j] = forces.get(j, ZERO) + insert(force) * slope
    potential, notes = without_roots(potential, setting.positive, setting.reference)
    reduced = Energy(kinetic, potential, insert(energy.dissipation), forces, (*energy.notes, *notes))
    return None if reduced.symbols & elimination.constants else reduced


def independent(names: Sequence[str], pieces: Sequence[Remaining], setting: Setting) -> list[Remaining] | None:
    """Return a maximal independent set of the remaining constraints, or None if a block is undecided.

    A block of one relation, or with relations nonlinear in velocities, is taken as it is. In other blocks the relations
    with independent rows at a random point are chosen, which include the block's hidden relations.
    """
    if not pieces:
        return []
    chosen: list[Remaining] = []
    blocks, _ = split(names, [Row(i, p) for i, p in enumerate(pieces)])
    for block in blocks:
        if len(block.rows) == 1 or block.nonlinear:
            chosen += [r.piece for r in block.rows if isinstance(r.piece, Remaining)]
            continue
        a = in_time(block, setting)
        if a.dof is None or not a.matrix:
            return None
        rows = without_time(a.matrix, len(block.coordinates))
        relations = [r.piece for r in block.finite] + [Finite(g) for g in a.hidden] + [r.piece for r in block.forms]
        if len(relations) != len(rows):
            return None
        chosen += [p for i in echelon(rows, a.modulus).independent if isinstance(p := relations[i], Remaining)]
    return chosen
