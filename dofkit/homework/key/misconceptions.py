"""What number would a known error give for this scene? An answer that is one of them is explained by it.

A new error is a row of `ERRORS`: its code, what to say, and the degrees of freedom that it predicts.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping
from fractions import Fraction
from typing import NamedTuple

from dofkit.homework.key.facts import SceneCounts, scene_counts
from dofkit.homework.key.key import Key
from dofkit.homework.sentences import Said, say
from dofkit.report import ConstraintEntry

Numbers = Iterator[int | Fraction]


class Misconception(NamedTuple):
    """An error: its stable ``code``, the ``hint`` for who made it, and the numbers f that it ``predicts``.

    ``anyway``: it gives this number whichever freedom is asked for; ``alone``: told where no other error gives it.
    """

    code: str
    hint: str
    predicts: Callable[[SceneCounts], Numbers]
    anyway: bool = False
    alone: bool = False


def _more(count: Callable[[SceneCounts], int]) -> Callable[[SceneCounts], Numbers]:
    """As many degrees of freedom too many, where that is not 0."""
    return lambda f: iter([f.dof + count(f)] if count(f) else [])


def _less(count: Callable[[SceneCounts], int | Fraction]) -> Callable[[SceneCounts], Numbers]:
    """As many too few."""
    return lambda f: iter([f.dof - count(f)] if count(f) else [])


def _all_links(f: SceneCounts) -> Numbers:
    if f.links > f.n - f.dof and f.naive < f.dof:
        yield f.naive


def _rod_three(f: SceneCounts) -> Numbers:
    if f.links and f.naive > f.dof:
        yield f.naive


def _plane_forgotten(f: SceneCounts) -> Numbers:
    if f.planes and f.d == 3:
        yield f.dof + f.planes


def _in_space(f: SceneCounts) -> Numbers:
    if f.d == 2 and f.particles:
        yield f.dof + f.particles


def _all_equations(f: SceneCounts) -> Numbers:
    if f.naive < f.dof:
        yield f.naive


def _no_constraint(f: SceneCounts) -> Numbers:
    if f.dof < f.n:
        yield f.n


def _sum_of_squares(f: SceneCounts) -> Numbers:
    if not f.links and f.naive > f.dof and not f.integrable and not f.nonholonomic:
        yield f.naive
    elif f.surplus:
        yield f.dof + f.surplus


def _trajectory(f: SceneCounts) -> Numbers:
    if f.dof == f.n > 1 and not f.entries:
        yield 1


def _conservation(f: SceneCounts) -> Numbers:
    if f.dof > 1 and (f.energies or f.forces or not f.entries):
        yield f.dof - 1


def _pulley(f: SceneCounts) -> Numbers:
    if f.strings > 1:
        yield f.dof - 1
    if f.strings:
        yield f.n - f.strings


def _ground(f: SceneCounts) -> Numbers:
    if f.joints:
        yield f.dof - f.body_freedom
        yield f.dof + f.body_freedom


def _spatial_grubler(f: SceneCounts) -> Numbers:
    if f.d == 2 and f.joints:
        yield 6 * f.bodies - 5 * f.joints


_IN_PLANE = "The motion stays in a plane: this is a constraint too."
#: In the order in which they are likely where several give the same number.
ERRORS: tuple[Misconception, ...] = (
    Misconception(
        "ALL_LINKS",
        "The distances between more than d + 1 particles in d dimensions are not all independent.",
        _all_links,
    ),
    Misconception(
        "ROD_3",
        "The masses stay on one straight line: this takes more equations than the distances alone suggest.",
        _rod_three,
    ),
    Misconception(
        "NH_SUBTRACT",
        "A non-holonomic constraint restricts the velocities only; it does not reduce the dimension of the "
        "configuration space.",
        _less(lambda f: f.nonholonomic),
    ),
    Misconception(
        "NH_HALF",
        "If half of each non-holonomic constraint was subtracted: it does not reduce the dimension of the "
        "configuration space at all.",
        _less(lambda f: Fraction(f.nonholonomic, 2)),
        True,
    ),
    Misconception(
        "ROLL_NH",
        "A differential constraint of this system is integrable: it reduces the number of degrees of freedom.",
        _more(lambda f: f.integrable),
    ),
    Misconception(
        "INEQ_SUBTRACT",
        "An inequality bounds the motion but does not reduce the number of degrees of freedom.",
        _less(lambda f: f.walls),
    ),
    Misconception(
        "INEQ_AS_EQ",
        "An inequality is not an equation: within its bound the system moves freely.",
        _less(lambda f: f.walls),
    ),
    Misconception(
        "SPRING",
        "A spring is not a rod: it exerts a force and is not a constraint.",
        _less(lambda f: f.forces.count("spring")),
    ),
    Misconception(
        "DRIVEN",
        "A prescribed motion is not a degree of freedom: it is a given function of time.",
        _more(lambda f: f.drives),
    ),
    Misconception(
        "PULLEY",
        "Check the pulleys and the strings: each inextensible string gives one equation, and each movable "
        "pulley has its own coordinate.",
        _pulley,
    ),
    Misconception(
        "CART_FIXED",
        "Was the motion of the support taken as prescribed? It moves freely along its guide.",
        _less(lambda f: f.guides if f.dof > 1 else 0),
    ),
    Misconception(
        "ROD_SPIN",
        "Two particles on a rod are not a rigid body: a rotation about the rod's axis changes nothing.",
        _more(lambda f: f.rods if f.d == 3 else 0),
    ),
    Misconception(
        "NO_SPIN",
        "A rigid body can also rotate about its own axis.",
        _less(lambda f: f.bodies + f.clusters if f.d == 3 else 0),
    ),
    Misconception("PLANE_FORGOT", _IN_PLANE, _plane_forgotten),
    Misconception(
        "CURVE_ONE",
        "A curve in space is the intersection of two surfaces: it takes two equations.",
        _more(lambda f: f.surplus),
    ),
    Misconception(
        "SUM_SQ", "A vanishing sum of squares stands for several equations: each square vanishes.", _sum_of_squares
    ),
    Misconception(
        "GROUND", "The ground is one of the n links in 3 (n - 1) - 2 j: count it there, but it cannot move.", _ground
    ),
    Misconception(
        "SPATIAL_GRUBLER",
        "In the plane a body has three degrees of freedom and a revolute joint removes two.",
        _spatial_grubler,
    ),
    Misconception(
        "PLANE_TWICE",
        "With two coordinates for each particle, the plane is already taken into account.",
        _less(lambda f: f.particles if f.d == 2 else 0),
    ),
    Misconception(
        "BAR_TWO", "A rod between two particles removes one degree of freedom, not two.", _less(lambda f: f.links)
    ),
    Misconception(
        "BAR_POINT",
        "Two particles joined by a rod are not one particle: the rod can rotate.",
        _less(lambda f: (f.d - 1) * f.links),
    ),
    Misconception(
        "MOTION",
        "The trajectory is determined by the forces and the initial conditions: it is not a constraint.",
        _trajectory,
    ),
    Misconception(
        "CONSERVATION",
        "Conservation of energy is a consequence of the equations of motion: it is not a constraint.",
        _conservation,
        alone=True,
    ),
    Misconception(
        "PARAM_COUNT",
        "A parametric curve adds its parameter as one more unknown.",
        _less(lambda f: f.on_curves),
        alone=True,
    ),
    Misconception(
        "ALL_COUNTED",
        "Not all of these equations are independent; a dependent equation does not reduce the number of "
        "degrees of freedom.",
        _all_equations,
        alone=True,
    ),
    Misconception(
        "FIXED_FORGOT",
        "An equation that fixes one coordinate is a constraint too.",
        _more(lambda f: f.fixed),
        alone=True,
    ),
    Misconception(
        "NOT_SUBTRACTED",
        "This is the number of coordinates: the constraints were not subtracted.",
        _no_constraint,
        True,
        alone=True,
    ),
    Misconception(
        "POINT_6",
        "A particle has no rotational degrees of freedom.",
        _more(lambda f: f.particles * (f.body_freedom - f.d)),
        alone=True,
    ),
    Misconception(
        "PLANE_FORGOT",
        _IN_PLANE,
        _in_space,
        alone=True,
    ),
)


def explain(number: Fraction, ask: str, key: Key) -> tuple[tuple[str, ...], str]:
    """(codes of the errors that give this number, the most likely first; what to say about the likeliest)."""
    report = key.report
    if report.dof is None:
        return (), ""
    facts = scene_counts(key)
    right = report.dof
    wanted = len(key.coordinates) - number if ask == "k" else number
    by_velocities = ask == "velocity_dof" or (ask == "dof" and key.convention == "velocity")
    if by_velocities:
        wanted += facts.nonholonomic
    if wanted == right or (ask == "k" and number < 0):
        return (), ""
    every = [m for m in ERRORS if (number if m.anyway and ask != "k" else wanted) in set(m.predicts(facts))]
    likely = [m for m in every if not m.alone] or every
    return tuple(m.code for m in likely), likely[0].hint if likely else ""


def explain_label(part: str, entry: ConstraintEntry, key: Key) -> tuple[str, str | Said]:
    """(code, what to say) where the label of a part is wrong."""
    del key
    if part == "scleronomic":
        if not entry.scleronomic and entry.integral is not None:
            sentence = "It integrates to {integral}, which contains time explicitly: it is rheonomic."
            return "RHEO_MISSED", say(sentence, integral=entry.integral)
        if not entry.scleronomic:
            return "RHEO_MISSED", "Time occurs explicitly in this constraint: look for t or for a prescribed motion."
        if entry.catastatic is False:
            return (
                "RHEO_NH",
                "It does not contain time explicitly and is not integrable, so it is scleronomic. A term "
                "without velocities makes it acatastatic.",
            )
        if entry.form in ("pfaffian", "nonlinear"):
            return "RHEO_NH", "A constraint on velocities is rheonomic only if t occurs explicitly."
        return "RHEO_MOVES", (
            "Time does not occur explicitly in it, so it is scleronomic; that something moves does not matter."
        )
    if part == "bilateral":
        if entry.bilateral:
            return "EQ_AS_INEQ", "It is an equation, so it is bilateral."
        return "INEQ_AS_EQ", "It is an inequality, so it is unilateral."
    if not entry.bilateral:
        return "INEQ_AS_EQ", "It is an inequality, so it is not holonomic."
    if entry.holonomic and entry.form != "finite":
        return "ROLL_NH", "It contains velocities, but it is integrable, so it is holonomic."
    if entry.holonomic:
        return "HOLONOMIC_MISSED", "It relates coordinates (and possibly time) only, so it is holonomic."
    return "NH_MISSED", "It constrains velocities and is not integrable."


_OF_LABELS = {
    "RHEO_MISSED": "Time occurs explicitly in the constraint or in its integral, so it is rheonomic; it was called "
    "scleronomic.",
    "RHEO_NH": "A constraint on velocities was called rheonomic, but time does not occur in it explicitly.",
    "RHEO_MOVES": "A constraint in which time does not occur explicitly was called rheonomic.",
    "EQ_AS_INEQ": "An equation, which is bilateral, was called unilateral.",
    "HOLONOMIC_MISSED": "A relation between coordinates (and possibly time) was called non-holonomic.",
    "NH_MISSED": "A constraint on velocities that is not integrable was called holonomic.",
}
_OF_NUMBERS = {
    "CARRIED": "The number is consistent with an earlier answer that was wrong: the step itself is correct.",
    "OTHER_CONVENTION": "The number of independent velocities was given instead of the dimension of the configuration "
    "space, or vice versa.",
}
_OF_EQUATIONS = {
    "SAME": "An equivalent form of the constraint.",
    "IRREGULAR": "The same set of configurations, but the gradient vanishes on it, as for a squared equation.",
    "ONE_BRANCH": "Only one branch of the constraint, such as a square root with one sign.",
    "DIFFERENTIATED": "The time derivative of the constraint: its constant is lost.",
    "INTEGRATED": "The integral of the differential constraint, with its constant.",
    "INTEGRATED_NO_CONSTANT": "The integral of the differential constraint without its constant.",
    "WEAKER": "A weaker condition: it is implied by the constraint but does not imply it.",
    "STRONGER": "A stronger condition: it implies the constraint but is not implied by it.",
    "DIFFERENT": "A different constraint.",
    "EMPTY": "No configuration satisfies it together with the other constraints.",
    "UNDECIDED": "It could not be decided whether this is the same constraint.",
    "INTEGRABLE": "The constraint is integrable but was said not to be.",
    "NOT_INTEGRABLE": "The constraint is not integrable, but an integral was given.",
    "NOT_INTEGRATED": "The answer still contains velocities instead of an integral.",
    "WRONG_INTEGRAL": "A relation between coordinates that is not an integral of the constraint.",
}
_OF_NAMES = {
    "REDUNDANT_MISSED": "A redundant constraint is missing from the answer.",
    "INCOMPLETE": "The named coordinates do not determine the configuration.",
    "DEPENDENT": "The named coordinates are not independent.",
    "NOT_REDUNDANT": "Without the named constraints the system would have more freedom.",
}
_OF_MOTION = {
    "TOTAL_ENERGY": "The energy T + V was given instead of the Lagrangian T - V.",
    "SIGN": "The sign is wrong, for example V - T instead of the Lagrangian T - V.",
    "WRONG_LAGRANGIAN": "A different Lagrangian: it does not give the equations of motion.",
    "WRONG_MOMENTUM": "Not the derivative of the Lagrangian with respect to that velocity.",
    "WRONG_FORCE": "Not the derivative of the Lagrangian with respect to that coordinate plus non-potential forces.",
    "WRONG_MOTION": "An equation that is not satisfied by the motion.",
    "SMALL_ANGLES": "The equations of motion linearized for small oscillations.",
    "NO_ACCELERATION": "A correct equation that does not determine the acceleration.",
    "INEQUALITY": "An inequality was given instead of an equation of motion.",
    "OTHER_COORDINATE": "The equation of motion of another coordinate.",
    "FOLLOWS": "An equation that is implied by the equations of motion.",
}

#: Code -> what it means.
CODES: Mapping[str, str] = {
    **{error.code: error.hint for error in ERRORS},
    **_OF_LABELS,
    **_OF_NUMBERS,
    **_OF_EQUATIONS,
    **_OF_NAMES,
    **_OF_MOTION,
}
