"""Sets of names: do coordinates determine the configuration, and is a set of constraints redundant?"""

from __future__ import annotations

from collections.abc import Collection, Mapping, Sequence
from dataclasses import replace

from dofkit.classification.dependence.implication import follows
from dofkit.classification.freedom.branches import Outcome, solve
from dofkit.classification.freedom.preparation import all_of, prepared
from dofkit.expressions import tree as ex
from dofkit.expressions.calculus import substitute
from dofkit.expressions.text import to_text
from dofkit.expressions.tree import ZERO
from dofkit.homework.key.counterexamples import counterexample
from dofkit.methods.classify import classify
from dofkit.relations.normal.pieces import Finite, Normal
from dofkit.report import Report
from dofkit.scene.added_equations import read_equations, with_equations
from dofkit.scene.constraints.base import Equation
from dofkit.scene.lowering import lower
from dofkit.scene.names import vocabulary_of
from dofkit.scene.scene import Scene
from dofkit.system import System


def determine(scene: Scene, names: Sequence[str], report: Report) -> bool | None:
    """Return whether nothing moves if these coordinates are fixed (dq = 0), or None if undecided.

    ``report``: of the scene, possibly without its last constraints, which define coordinates. Time is constant, so
    prescribed motions do not move. Non-holonomic constraints are left out: they do not determine the configuration.

    If differentials do not decide it, the coordinates are fixed at their values in the reference configuration: if
    there is no infinitesimal motion, their differentials are independent there, and so nearby.
    """
    basis = report.integrable_part.basis if report.integrable_part is not None else []
    if basis is None:
        return None
    added = [c.name for c in scene.constraints[len(report.constraints) :]]
    constraint_names = [*(e.name for e in report.constraints), *added]
    named = [c.model_copy(update={"name": name}) for c, name in zip(scene.constraints, constraint_names, strict=True)]
    freedom = _outcome(scene, [*named, *_held({name: f"d{name} = 0" for name in names})], basis, constraint_names).dof
    reference = lower(scene).reference
    if freedom is not None or reference is None or any(ex.coordinate(name) not in reference for name in names):
        return None if freedom is None else freedom == 0
    fixed = _held({name: f"{name} = {to_text(reference[ex.coordinate(name)])}" for name in names})
    there = _outcome(scene, [*named, *fixed], basis, [*constraint_names, *(c.name for c in fixed)])
    rigid = there.consistent and not there.crossing and not there.untouched
    return True if rigid and all(a.instantaneous == 0 for a in there.answers) else None


def _held(equations: Mapping[str, str]) -> list[Equation]:
    return [Equation(name=f"held {name}", text=text) for name, text in equations.items()]


def _outcome(
    scene: Scene, constraints: Sequence[object], basis: Sequence[str], constraint_names: Collection[str | None]
) -> Outcome:
    """Return the solution for constraints and integrals ``basis``, of named ones without velocity relations."""
    whole = _with(scene, constraints)
    if basis:
        whole = with_equations(whole, read_equations(basis, vocabulary_of(scene).names, constants=True), "integral")
    system = _at_one_time(lower(whole))
    reduced, setting = prepared(system)
    finite = [r._replace(normals=_finite(r.normals)) if r.constraint.name in constraint_names else r for r in reduced]
    return solve(finite, setting)


def _at_one_time(system: System) -> System:
    """Return the system with time as a constant."""
    still = {ex.TIME: ex.parameter("this time"), ex.DT: ZERO}
    constraints = tuple(
        c._replace(relations=tuple(r._replace(expr=substitute(r.expr, still)) for r in c.relations))
        for c in system.constraints
    )
    return replace(system, constraints=constraints)


def _finite(normals: Sequence[Normal]) -> tuple[Normal, ...]:
    """Return the relations that contain no velocities."""
    return tuple(n for n in normals if all(isinstance(p, Finite) for p in n.pieces))


def is_redundant_set(scene: Scene, names: Sequence[str], report: Report) -> bool | None:
    """Return whether the motions are the same without the constraints of these names, or None if undecided.

    They follow from the others; or, near a reference or generic pose, all constraints are geometric, and the degrees of
    freedom are the same without these. An inequality is needed if a state violates it that the others allow.
    """
    system = lower(scene)
    reduced, setting = prepared(system)
    dropped = [r for r in reduced if r.constraint.name in set(names)]
    kept = [n for r in reduced if r not in dropped for n in r.normals]
    entries = zip(scene.constraints, report.constraints, strict=True)
    without = _with(scene, [c.model_copy(update={"name": e.name}) for c, e in entries if e.name not in names])
    inequalities = [i.expr for r in dropped for i in r.inequalities]
    if inequalities:
        return False if any(counterexample(without, (), (), [-e]) for e in inequalities) else None
    implied = all_of(follows(n, kept, setting) for r in dropped for n in r.normals)
    if implied:
        return True
    fewer = classify(without)
    freedom = [(r.dof, r.velocity_dof) for r in (report, fewer)]
    if any(None in pair for pair in freedom):
        return None
    if freedom[0] != freedom[1] or fewer.instantaneous_dof != report.instantaneous_dof:
        return False
    local = bool(setting.pose or setting.generic) and all(e.form == "finite" for e in report.constraints if e.bilateral)
    return True if local else implied


def _with(scene: Scene, constraints: Sequence[object]) -> Scene:
    """Return the scene with the given constraints in place of its own."""
    return scene.model_copy(update={"constraints": tuple(constraints), "expect": {}, "energies": None})
