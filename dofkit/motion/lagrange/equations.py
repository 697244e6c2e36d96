"""Equations of motion: Lagrange's equations of a scene, in the coordinates that remain after elimination.

Constraints are used as they were classified: geometric equations are solved in closed form if possible, and keep a
multiplier if not, as non-holonomic ones always do; redundant ones are left out; inequalities are not used.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, replace
from functools import cached_property

from dofkit.base.deadline import DEFAULT_SECONDS, OutOfTimeError, by_processor, check, limited, remaining_seconds
from dofkit.base.errors import Fault, SceneError
from dofkit.base.wording import seconds_of
from dofkit.classification.passes import GENERIC, Examined, examined
from dofkit.exact.ring.canonical import is_identically_zero
from dofkit.expressions import tree as ex
from dofkit.expressions.calculus import diff
from dofkit.expressions.sympy_bridge import Bridge
from dofkit.expressions.text.characters import MAX_CHARACTERS
from dofkit.expressions.text.names import Names
from dofkit.expressions.text.printing import to_text
from dofkit.expressions.tree import Expr
from dofkit.motion.lagrange.derivation import SINGULAR, Derived, derive
from dofkit.motion.lagrange.elimination import Remaining
from dofkit.motion.lagrange.energies import Energy, energy_of, missing
from dofkit.motion.lagrange.joint_motion import joint_motion
from dofkit.motion.lagrange.model import LagrangeModel, NoEquationsError, lagrange_model
from dofkit.motion.lagrange.report import Conserved, Linearized, MotionReport
from dofkit.motion.lagrange.small_motions import linearized
from dofkit.motion.lagrange.tidying import Tidier, length
from dofkit.relations.normal.pieces import Nonlinear, Pfaffian
from dofkit.scene.drawing import Drawing
from dofkit.scene.lowering import survey, system_of
from dofkit.scene.reading import SceneLike, load
from dofkit.scene.scene import Scene
from dofkit.system import System

__all__ = ["Conserved", "Linearized", "MotionReport", "NoEquationsError", "derived_of", "lagrange"]

#: The most characters of a Lagrangian with roots (twice as many without) for readable equations after elimination.
LONGEST = 500
#: Seconds for the equations with every possible elimination.
TRYING = 8.0
#: Seconds for the equations of a tree in the angles of its joints, and the most nodes of such a Lagrangian.
JOINTS_TRYING, MOST_WRITTEN = 20.0, 2000
#: Seconds for sorting an energy, and the most nodes of an energy that is sorted.
SORTING, MOST_NODES = 2.0, 1500
#: The note if the elimination was given up.
LONG = "Elimination would make the equations too long to read, so the constraints keep multipliers."

#: The message for a tree that is too large.
TOO_LONG = (
    "in the angles and displacements of {} joints the Lagrangian has {} parts, and at most {} can be differentiated "
    "in the time available: weld some of the joints, or analyse a part of the tree"
)
#: The note for formulas that are too long for a scene.
LENGTHY = f"Some of these formulas have more than {MAX_CHARACTERS} characters, more than a scene can hold in one text."


def lagrange(scene: SceneLike, linearize: bool = False, budget: float | None = None) -> MotionReport:
    """Return Lagrange's equations d/dt dL/dqdot - dL/dq + sum lambda a = Q of a scene.

    Here L = T - V, Q are the non-conservative generalized forces, a the coefficients of the constraints that are not
    eliminated, and lambda their multipliers.

    Parameters
    ----------
    scene
        A Scene, a path, a catalog name or a mapping, with ``energies``, or with masses and forces.
    linearize
        Whether to add M, C and K of the linearization about an equilibrium.
    budget
        Seconds.

    Returns
    -------
    MotionReport
        Equations as texts, one for each coordinate that is kept, in the units of the scene.

    Raises
    ------
    SceneError
        If the scene cannot be read.
    NoEquationsError
        If no equations can be given; the message says why.
    ArgumentError
        If ``scene`` is no scene.

    References
    ----------
    J. L. Lagrange, Mecanique analytique, 1788.

    Examples
    --------
    >>> import dofkit
    >>> pendulum = {"coordinates": ["theta"], "parameters": {"m": "positive", "l": "positive", "g": "positive"}}
    >>> energies = {"kinetic": "m l^2 thetadot^2/2", "potential": "-m g l cos(theta)"}
    >>> dofkit.lagrange({**pendulum, "energies": energies}).equations
    ['m*l^2*thetaddot + m*g*l*sin(theta) = 0']
    """
    seconds, read_scene = DEFAULT_SECONDS if budget is None else seconds_of(budget), load(scene)
    try:
        with limited(seconds):
            derived = derived_of(read_scene)
            report = _report(derived, *(_small(read_scene, derived) if linearize else (None, ())))
    except OutOfTimeError as error:
        raise NoEquationsError(f"no equations of motion are given: {error}") from None
    report._companion.about = read_scene
    return report


def derived_of(scene: Scene) -> Derived:
    """Return the equations of motion as expressions.

    If they would be longer than a text of a scene may be, nothing is eliminated, and all multipliers are kept.
    """
    source = read(scene)
    by_joints = _by_joints(source)
    if by_joints is not None:
        return by_joints
    model = source.model()
    if not model.elimination.solved:
        return derive(model)
    model = _sorted(model)
    if _short(model.energy.lagrangian):
        try:
            with by_processor(min(TRYING, remaining_seconds())):
                derived = derive(model)
            if _readable(derived):
                return derived
        except OutOfTimeError:
            check()
    return _noted(derive(source.model(eliminates=False)), LONG)


def _by_joints(source: MotionSource) -> Derived | None:
    """Return the equations of a spatial tree in joint coordinates; None for other scenes. Raises if too long."""
    tree = joint_motion(source.scene, source.drawing, source.system)
    if tree is None:
        return None
    energy, scene = tree.energy, load(tree.value)
    terms = length(energy.lagrangian)
    if terms > MOST_WRITTEN:
        raise NoEquationsError(TOO_LONG.format(len(scene.coordinates), terms, MOST_WRITTEN))
    surveyed = survey(scene)
    joint_source = replace(source, system=system_of(scene, surveyed), energy=energy, names=surveyed.names)
    try:
        with by_processor(min(JOINTS_TRYING, 0.5 * remaining_seconds())):
            derived = derive(_sorted(joint_source.model()))
    except OutOfTimeError:
        check()
        raise NoEquationsError(TOO_LONG.format(len(scene.coordinates), terms, "fewer")) from None
    return derived if _readable(derived) else _noted(derived, LENGTHY)


def _noted(derived: Derived, note: str) -> Derived:
    return replace(derived, model=replace(derived.model, notes=(*derived.model.notes, note)))


def _short(lagrangian: Expr) -> bool:
    """Return whether a Lagrangian is short enough for readable equations; derivatives of roots are long."""
    roots = any(
        n.op == "pow" and n.args[1].op == "num" and n.args[1].args[0].denominator > 1 for n in ex.nodes(lagrangian)
    )
    return len(to_text(lagrangian)) <= (LONGEST if roots else 2 * LONGEST)


def _sorted(model: LagrangeModel) -> LagrangeModel:
    """Return the model with kinetic and potential energy sorted by velocities, if that is shorter."""
    tidy = Tidier(Bridge(model.names, model.positive), model.positive, SORTING)
    kinetic, potential = (
        e if ex.size(e) > MOST_NODES else tidy.shorter(e) for e in (model.energy.kinetic, model.energy.potential)
    )
    return replace(model, energy=replace(model.energy, kinetic=kinetic, potential=potential))


def _readable(derived: Derived) -> bool:
    """Return whether every formula is short enough to be read back as a text."""
    texts = (derived.lagrangian, *derived.equations.values(), *derived.momenta.values(), *derived.forces.values())
    return all(len(to_text(e)) + len(" = 0") <= MAX_CHARACTERS for e in texts)


@dataclass(frozen=True)
class MotionSource:
    """The input of the derivation: a scene, its system, energies, names and frames."""

    scene: Scene
    system: System
    energy: Energy
    names: Names
    drawing: Drawing

    @cached_property
    def study(self) -> Examined:
        """The classification of the scene's constraints."""
        return examined(self.system, passes=GENERIC)

    def model(self, eliminates: bool = True) -> LagrangeModel:
        """Return energies and constraints, with coordinates eliminated where possible, unless ``eliminates`` is False.

        Raises SceneError for missing masses on which the motion depends.
        """
        model = lagrange_model(self.study, self.energy, self.names, eliminates)
        faults = missing(model.energy.symbols, self.scene)
        if faults:
            raise SceneError(tuple(faults), self.scene.name)
        return model


def read(scene: Scene) -> MotionSource:
    """Return the source of the equations of motion of a scene. Raises SceneError with all faults."""
    surveyed = survey(scene, euler=True)
    if surveyed.faults:
        raise SceneError(surveyed.faults, scene.name)
    energy, faults = energy_of(scene, surveyed.drawing)
    if faults:
        raise SceneError(faults, scene.name)
    if not _has_kinetics(scene):
        message = (
            "the scene has neither a kinetic energy in `energies` nor masses, so no equations of motion can be derived"
        )
        hint = "add `energies: {kinetic: ..., potential: ...}`, or a `mass` to its particles and bodies"
        raise SceneError((Fault(message, hint=hint),), scene.name)
    return MotionSource(scene, system_of(scene, surveyed), energy, surveyed.names, surveyed.drawing)


def _has_kinetics(scene: Scene) -> bool:
    """Return whether a scene has a kinetic energy or a mass."""
    if scene.energies is not None and scene.energies.kinetic is not None:
        return True
    return any(p.mass is not None for p in scene.particles) or any(b.mass is not None for b in scene.bodies)


def _small(scene: Scene, derived: Derived) -> tuple[Linearized | None, tuple[str, ...]]:
    """Return (linearization, ()), or (None, (reason,)); if it fails after elimination, it is tried without."""
    try:
        return linearized(derived), ()
    except NoEquationsError as error:
        why = f"Not linearized: {error}."
    if not derived.model.elimination.solved or derived.model.elimination.constants:
        return None, (why,)
    try:
        return linearized(derive(read(scene).model(eliminates=False))), ()
    except (NoEquationsError, SceneError):  # without elimination, masses may be missing
        return None, (why,)


def _report(derived: Derived, small: Linearized | None, more: tuple[str, ...]) -> MotionReport:
    model = derived.model
    more = (*((SINGULAR,) if derived.is_degenerate() else ()), *more)
    report = MotionReport(
        scene=model.study.system.name,
        coordinates=list(model.names),
        lagrangian=to_text(derived.lagrangian),
        momenta={n: to_text(p) for n, p in derived.momenta.items()},
        forces={n: to_text(f) for n, f in derived.forces.items()},
        equations=[f"{to_text(e)} = 0" for e in derived.equations.values()],
        constraints=[f"{to_text(e)} = 0" for e in (*model.holonomic, *model.nonholonomic)],
        multipliers=list(derived.multipliers),
        eliminated={n: to_text(e) for n, e in model.elimination.solved.items()},
        left_out=list(model.left_out),
        non_conservative=[n for n in model.names if not _zero(derived, model.applied(n))],
        cyclic=cyclic(derived),
        conserved=list(conserved(derived)),
        linearized=small,
        notes=[*model.notes, *more],
        verdict=model.study.report.verdict,
    )
    report._derived = derived
    return report


#: Seconds for writing the energy shorter.
SECONDS = 2.0


def cyclic(derived: Derived) -> list[str]:
    """Return the coordinates with dL/dq = 0 identically."""
    return [n for n in derived.model.names if _zero(derived, diff(derived.lagrangian, ex.coordinate(n)))]


def conserved(derived: Derived) -> Iterator[Conserved]:
    """Yield the momenta on which no force acts, and the energy function h = sum qdot p - L if it is conserved.

    dp/dt = dL/dq + Q - sum lam a; dh/dt = -dL/dt + sum Q qdot - sum lam a qdot, where a qdot = 0 if a constraint
    has no term free of velocities.
    """
    model = derived.model
    for name in model.names:
        if _zero(derived, derived.forces[name]) and all(_zero(derived, row[name]) for row in model.slopes):
            quantity = to_text(derived.momenta[name])
            yield Conserved(name=f"p_{name}", quantity=quantity, reason=f"no generalized force acts along {name}.")
    energy = model.energy
    forceless = all(_zero(derived, e) for e in (energy.dissipation, *energy.forces.values()))
    timeless = _zero(derived, diff(derived.lagrangian, ex.TIME))
    if model.names and forceless and timeless and all(_workless(c, derived) for c in model.constraints):
        function, total = energy_function(derived)
        reason = "L has no explicit time dependence, and all non-conservative and constraint forces are workless."
        if not total:
            reason = (
                "L has no explicit time dependence, and no non-conservative force acts; this is the Jacobi integral "
                "sum p qdot - L, which differs from T + V."
            )
        yield Conserved(name="energy" if total else "h", quantity=to_text(function), reason=reason)


def energy_function(derived: Derived) -> tuple[Expr, bool]:
    """Return (h = sum qdot dL/dqdot - L, whether h = T + V, as for T quadratic in the velocities)."""
    energies = derived.model.energy
    powers = ex.add(*(ex.velocity(n) * p for n, p in derived.momenta.items()))
    function = powers - derived.lagrangian
    total = energies.kinetic + energies.potential
    is_total = _zero(derived, function - total)
    tidy = Tidier(Bridge(derived.model.names, derived.model.positive), derived.model.positive, SECONDS)
    return tidy.shorter(total if is_total else function), is_total


def _zero(derived: Derived, e: Expr) -> bool:
    return e.is_zero or is_identically_zero(e, derived.model.positive) is True


def _workless(piece: Remaining, derived: Derived) -> bool:
    """Return whether the constraint's force does no work in actual motions, because time does not enter."""
    if isinstance(piece, Pfaffian):
        return _zero(derived, piece.dt)
    return not isinstance(piece, Nonlinear) and _zero(derived, diff(piece.expr, ex.TIME))
