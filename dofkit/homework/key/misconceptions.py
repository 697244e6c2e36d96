"""What number would a known error give for this scene? An answer that is one of them is explained by it.

A new error is a row of `ERRORS`: its code and the degrees of freedom that it predicts; the catalogue of sentences has
what is said of it.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator
from fractions import Fraction
from typing import NamedTuple

from dofkit.homework.key.facts import SceneCounts
from dofkit.homework.key.key import Key
from dofkit.homework.sentences import Said, say
from dofkit.report import ConstraintEntry

Numbers = Iterator[int | Fraction]


class Misconception(NamedTuple):
    """An error: its stable ``code``, and the numbers f that it ``predicts``.

    ``anyway``: it gives this number whichever freedom is asked for; ``alone``: told where no other error gives it.
    """

    code: str
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


#: In the order in which they are likely where several give the same number.
ERRORS: tuple[Misconception, ...] = (
    Misconception("ALL_LINKS", _all_links),
    Misconception("ROD_3", _rod_three),
    Misconception("NH_SUBTRACT", _less(lambda f: f.nonholonomic)),
    Misconception("NH_HALF", _less(lambda f: Fraction(f.nonholonomic, 2)), anyway=True),
    Misconception("ROLL_NH", _more(lambda f: f.integrable)),
    Misconception("INEQ_SUBTRACT", _less(lambda f: f.walls)),
    Misconception("INEQ_AS_EQ", _less(lambda f: f.walls)),
    Misconception("SPRING", _less(lambda f: f.forces.count("spring"))),
    Misconception("DRIVEN", _more(lambda f: f.drives)),
    Misconception("PULLEY", _pulley),
    Misconception("CART_FIXED", _less(lambda f: f.guides if f.dof > 1 else 0)),
    Misconception("ROD_SPIN", _more(lambda f: f.rods if f.d == 3 else 0)),
    Misconception("NO_SPIN", _less(lambda f: f.bodies + f.clusters if f.d == 3 else 0)),
    Misconception("PLANE_FORGOT", _plane_forgotten),
    Misconception("CURVE_ONE", _more(lambda f: f.surplus)),
    Misconception("SUM_SQ", _sum_of_squares),
    Misconception("GROUND", _ground),
    Misconception("SPATIAL_GRUBLER", _spatial_grubler),
    Misconception("PLANE_TWICE", _less(lambda f: f.particles if f.d == 2 else 0)),
    Misconception("BAR_TWO", _less(lambda f: f.links)),
    Misconception("BAR_POINT", _less(lambda f: (f.d - 1) * f.links)),
    Misconception("MOTION", _trajectory),
    Misconception("CONSERVATION", _conservation, alone=True),
    Misconception("PARAM_COUNT", _less(lambda f: f.on_curves), alone=True),
    Misconception("ALL_COUNTED", _all_equations, alone=True),
    Misconception("FIXED_FORGOT", _more(lambda f: f.fixed), alone=True),
    Misconception("NOT_SUBTRACTED", _no_constraint, anyway=True, alone=True),
    Misconception("POINT_6", _more(lambda f: f.particles * (f.body_freedom - f.d)), alone=True),
    Misconception("PLANE_FORGOT", _in_space, alone=True),
)


def explain(number: Fraction, ask: str, key: Key) -> tuple[str, ...]:
    """Return the codes of the errors that give this number, the most likely first."""
    report = key.report
    if report.dof is None:
        return ()
    facts = key.once(SceneCounts, lambda: SceneCounts(key))
    right = report.dof
    wanted = len(key.coordinates) - number if ask == "k" else number
    by_velocities = ask == "velocity_dof" or (ask == "dof" and key.convention == "velocity")
    if by_velocities:
        wanted += facts.nonholonomic
    if wanted == right or (ask == "k" and number < 0):
        return ()
    every = [m for m in ERRORS if (number if m.anyway and ask != "k" else wanted) in set(m.predicts(facts))]
    likely = [m for m in every if not m.alone] or every
    return tuple(m.code for m in likely)


def explain_label(part: str, entry: ConstraintEntry) -> tuple[str, str | Said]:
    """Return the code where the label of a part is wrong, and what to say if it is not what the code means."""
    if part == "scleronomic":
        if not entry.scleronomic and entry.integral is not None:
            sentence = "It integrates to {integral}, which contains time explicitly: it is rheonomic."
            return "RHEO_MISSED", say(sentence, integral=entry.integral)
        if not entry.scleronomic:
            return "RHEO_MISSED", ""
        if entry.catastatic is False:
            return (
                "RHEO_NH",
                "It does not contain time explicitly and is not integrable, so it is scleronomic. A term "
                "without velocities makes it acatastatic.",
            )
        if entry.form in ("pfaffian", "nonlinear"):
            return "RHEO_NH", ""
        return "RHEO_MOVES", ""
    if part == "bilateral":
        if entry.bilateral:
            return "EQ_AS_INEQ", ""
        return "INEQ_AS_EQ", "It is an inequality, so it is unilateral."
    if not entry.bilateral:
        return "INEQ_AS_EQ", "It is an inequality, so it is not holonomic."
    if entry.holonomic and entry.form != "finite":
        return "ROLL_NH", "It contains velocities, but it is integrable, so it is holonomic."
    if entry.holonomic:
        return "HOLONOMIC_MISSED", ""
    return "NH_MISSED", ""
