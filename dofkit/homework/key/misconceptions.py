"""What number would a known error give for this scene? An answer that is one of them is explained by it.

A new error is a row of `ERRORS`: its code, what to say, and the degrees of freedom that it predicts.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator
from fractions import Fraction
from typing import NamedTuple

from dofkit.homework.key.facts import SceneCounts
from dofkit.homework.key.key import Key
from dofkit.homework.sentences.said import Said, say
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
    if f.bars.links > f.n - f.dof and f.naive < f.dof:
        yield f.naive


def _rod_three(f: SceneCounts) -> Numbers:
    if f.bars.links and f.naive > f.dof:
        yield f.naive


def _plane_forgotten(f: SceneCounts) -> Numbers:
    if f.surfaces.planes and f.d == 3:
        yield f.dof + f.surfaces.planes
    if f.d == 2 and f.particles:
        yield f.dof + f.particles


def _all_equations(f: SceneCounts) -> Numbers:
    if f.naive < f.dof:
        yield f.naive


def _no_constraint(f: SceneCounts) -> Numbers:
    if f.dof < f.n:
        yield f.n


def _sum_of_squares(f: SceneCounts) -> Numbers:
    if not f.bars.links and f.naive > f.dof and not f.integrable and not f.nonholonomic:
        yield f.naive
    elif f.surfaces.surplus:
        yield f.dof + f.surfaces.surplus


def _trajectory(f: SceneCounts) -> Numbers:
    if f.dof == f.n > 1 and not f.entries:
        yield 1


def _conservation(f: SceneCounts) -> Numbers:
    if f.dof > 1 and (f.key.scene.energies is not None or f.forces or not f.entries):
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


#: In the order in which they are likely where several give the same number.
ERRORS: tuple[Misconception, ...] = (
    Misconception("ALL_LINKS", "Not all links between N particles are independent where N > d + 1.", _all_links),
    Misconception("ROD_3", "Of masses on one straight rod fewer distances are independent, and more conditions hold "
                  "than their count says: they stay in line.", _rod_three),
    Misconception("NH_SUBTRACT", "A non-holonomic constraint ties velocities only: it leaves all configurations within "
                  "reach and does not reduce the dimension of the configuration space.",
                  _less(lambda f: f.nonholonomic)),
    Misconception("NH_HALF", "A non-holonomic constraint does not take half a degree of freedom away.",
                  _less(lambda f: Fraction(f.nonholonomic, 2)), True),
    Misconception("ROLL_NH", "This differential constraint integrates to a relation between coordinates, which counts.",
                  _more(lambda f: f.integrable)),
    Misconception("INEQ_SUBTRACT", "An inequality bounds the motion but takes no degree of freedom away.",
                  _less(lambda f: f.walls)),
    Misconception("INEQ_AS_EQ", "An inequality is no equation: inside its bound everything can still move.",
                  _less(lambda f: f.walls)),
    Misconception("SPRING", "A spring is no rod: it exerts a force and constrains nothing.",
                  _less(lambda f: f.forces.count("spring"))),
    Misconception("DRIVEN", "A prescribed motion is no degree of freedom: it is given as a function of time.",
                  _more(lambda f: f.drives)),
    Misconception("PULLEY", "What hangs on a string: count every pulley that moves, and every direction in which a "
                  "weight is guided.", _pulley),
    Misconception("CART_FIXED", "The support moves freely along its guide: its motion is not prescribed.",
                  _less(lambda f: f.guides if f.dof > 1 else 0)),
    Misconception("ROD_SPIN", "Two particles on a rod are no rigid body: turning about the rod's own axis changes "
                  "nothing.", _more(lambda f: f.bars.rods if f.d == 3 else 0)),
    Misconception("NO_SPIN", "A rigid body also turns about its own axis.",
                  _less(lambda f: f.bodies + f.bars.clusters if f.d == 3 else 0)),
    Misconception("PLANE_FORGOT", "That the motion stays in a plane is a constraint, and counts.", _plane_forgotten),
    Misconception("CURVE_ONE", "A curve in space is where two surfaces meet: it takes two equations.",
                  _more(lambda f: f.surfaces.surplus)),
    Misconception("SUM_SQ", "A sum of squares that is zero is several equations in one: every square vanishes.",
                  _sum_of_squares),
    Misconception("GROUND", "The ground is a link that does not move: count it neither as free nor not at all.",
                  _ground),
    Misconception("SPATIAL_GRUBLER", "In the plane a body has three degrees of freedom and a joint takes two.",
                  _spatial_grubler),
    Misconception("PLANE_TWICE", "With two coordinates for each particle the plane is counted already.",
                  _less(lambda f: f.particles if f.d == 2 else 0)),
    Misconception("BAR_TWO", "A bar between two particles takes one degree of freedom away, not two.",
                  _less(lambda f: f.bars.links)),
    Misconception("BAR_POINT", "Two particles joined by a bar are not one particle: they can turn.",
                  _less(lambda f: (f.d - 1) * f.bars.links)),
    Misconception("PARAM_COUNT", "A parametric curve brings its parameter as one more unknown.",
                  _less(lambda f: f.surfaces.on_curves)),
    Misconception("MOTION", "The trajectory follows from forces and the initial state: it is no constraint.",
                  _trajectory),
    Misconception("CONSERVATION", "That energy is conserved follows from the motion: it is no constraint.",
                  _conservation),
    Misconception("POINT_6", "A particle has d degrees of freedom: only a body also turns.",
                  _more(lambda f: f.particles * (f.body_freedom - f.d))),
    Misconception("ALL_COUNTED", "Not all of these equations are independent: one that follows from the others takes "
                  "nothing away.", _all_equations, alone=True),
    Misconception("FIXED_FORGOT", "An equation that holds one coordinate at a number is a constraint, and counts.",
                  _more(lambda f: f.surfaces.fixed), alone=True),
    Misconception("NOT_SUBTRACTED", "This leaves every coordinate free: the constraints were not subtracted.",
                  _no_constraint, True, alone=True),
)  # fmt: skip


def explain(given: Fraction, ask: str, key: Key) -> tuple[tuple[str, ...], str]:
    """(codes of the errors that give this number, the most likely first; what to say about the likeliest)."""
    report = key.report
    if report.dof is None:
        return (), ""
    facts = SceneCounts(key)
    right = report.dof
    wanted = len(key.coordinates) - given if ask == "k" else given
    if ask == "velocity_dof" or (ask == "dof" and key.convention == "velocity"):
        wanted += facts.nonholonomic
    if wanted == right or (ask == "k" and given < 0):
        return (), ""
    every = [m for m in ERRORS if (given if m.anyway and ask != "k" else wanted) in set(m.predicts(facts))]
    found = [m for m in every if not m.alone] or every
    return tuple(m.code for m in found), found[0].hint if found else ""


def explain_label(part: str, entry: ConstraintEntry, key: Key) -> tuple[str, str | Said]:
    """(code, what to say) where the label of a part is wrong."""
    del key
    if part == "scleronomic":
        if not entry.scleronomic and entry.integral is not None:
            sentence = "It integrates to {integral}, and time occurs in that relation: it is rheonomic."
            return "RHEO_MISSED", say(sentence, integral=entry.integral)
        if not entry.scleronomic:
            return "RHEO_MISSED", "Time enters this constraint: look for t, or a motion that is prescribed."
        if entry.catastatic is False:
            return (
                "RHEO_NH",
                "Time does not occur in it, and it does not integrate: it is scleronomic. A term without velocities "
                "makes it acatastatic.",
            )
        if entry.form in ("pfaffian", "nonlinear"):
            return "RHEO_NH", "Velocities are not time: a constraint on velocities is rheonomic only where t enters."
        return "RHEO_MOVES", "That what it is attached to moves does not matter: time itself does not enter."
    if part == "bilateral":
        if entry.bilateral:
            return "EQ_AS_INEQ", "It is an equation, which holds from both sides."
        return "INEQ_AS_EQ", "It is an inequality, which stops the motion from one side only."
    if not entry.bilateral:
        return "INEQ_AS_EQ", "It is an inequality: no relation between the coordinates holds because of it."
    if entry.holonomic and entry.form != "finite":
        return "ROLL_NH", "It holds velocities, but does it integrate to a relation between coordinates?"
    if entry.holonomic:
        return "HOLONOMIC_MISSED", "It is a relation between coordinates (and time) alone."
    return "NH_MISSED", "It ties velocities, and no relation between coordinates follows from it."
