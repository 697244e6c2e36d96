"""The numbers that known errors give for a scene: a wrong answer that equals one of them is explained by it.

A new error is a row of `ERRORS`: its code, the degrees of freedom that it predicts, and its condition on the scene; the
catalogue of sentences contains its explanation.
"""

from __future__ import annotations

from collections.abc import Callable
from fractions import Fraction
from typing import NamedTuple, TypeAlias

from dofkit.homework.key.facts import SceneCounts
from dofkit.homework.key.key import Key
from dofkit.homework.sentences import Said, say
from dofkit.report import ConstraintEntry

Count: TypeAlias = Callable[[SceneCounts], int | Fraction]


class Misconception(NamedTuple):
    """An error: its stable ``code``, the number f that it predicts, and the condition on the scene (``where``).

    ``anyway``: the number is the same for all kinds of freedom; ``alone``: reported only if no other error gives it.
    """

    code: str
    predicted: Count
    where: Callable[[SceneCounts], object]
    anyway: bool = False
    alone: bool = False


def _more(code: str, count: Count, alone: bool = False) -> Misconception:
    """Return the error that gives ``count`` degrees of freedom too many, if the count is not 0."""
    return Misconception(code, lambda f: f.dof + count(f), count, alone=alone)


def _less(code: str, count: Count, anyway: bool = False, alone: bool = False) -> Misconception:
    """Return the error that gives ``count`` degrees of freedom too few, if the count is not 0."""
    return Misconception(code, lambda f: f.dof - count(f), count, anyway, alone)


def _naive(code: str, where: Callable[[SceneCounts], object], alone: bool = False) -> Misconception:
    """Return the error of subtracting all written equations between coordinates from the number of coordinates."""
    return Misconception(code, lambda f: f.naive, where, alone=alone)


def _squares_may_be_summed(f: SceneCounts) -> bool:
    return not f.links and f.naive > f.dof and not f.integrable and not f.nonholonomic


#: All errors; if several give the same number, the first is the most likely.
ERRORS: tuple[Misconception, ...] = (
    _naive("ALL_LINKS", lambda f: f.links > f.n - f.dof and f.naive < f.dof),
    _naive("ROD_3", lambda f: f.links and f.naive > f.dof),
    _less("NH_SUBTRACT", lambda f: f.nonholonomic),
    _less("NH_HALF", lambda f: Fraction(f.nonholonomic, 2), anyway=True),
    _more("ROLL_NH", lambda f: f.integrable),
    _less("INEQ_SUBTRACT", lambda f: f.walls),
    _less("INEQ_AS_EQ", lambda f: f.walls),
    _less("SPRING", lambda f: f.forces.count("spring")),
    _more("DRIVEN", lambda f: f.drives),
    Misconception("PULLEY", lambda f: f.dof - 1, lambda f: f.strings > 1),
    Misconception("PULLEY", lambda f: f.n - f.strings, lambda f: f.strings),
    _less("CART_FIXED", lambda f: f.guides if f.dof > 1 else 0),
    _more("ROD_SPIN", lambda f: f.rods if f.d == 3 else 0),
    _less("NO_SPIN", lambda f: f.bodies + f.clusters if f.d == 3 else 0),
    _more("PLANE_FORGOT", lambda f: f.planes if f.d == 3 else 0),
    _more("CURVE_ONE", lambda f: f.surplus),
    _naive("SUM_SQ", _squares_may_be_summed),
    _more("SUM_SQ", lambda f: 0 if _squares_may_be_summed(f) else f.surplus),
    _less("GROUND", lambda f: f.body_freedom if f.joints else 0),
    _more("GROUND", lambda f: f.body_freedom if f.joints else 0),
    Misconception("SPATIAL_GRUBLER", lambda f: 6 * f.bodies - 5 * f.joints, lambda f: f.d == 2 and f.joints),
    _less("PLANE_TWICE", lambda f: f.particles if f.d == 2 else 0),
    _less("BAR_TWO", lambda f: f.links),
    _less("BAR_POINT", lambda f: (f.d - 1) * f.links),
    Misconception("MOTION", lambda f: 1, lambda f: f.dof == f.n > 1 and not f.entries),
    Misconception(
        "CONSERVATION",
        lambda f: f.dof - 1,
        lambda f: f.dof > 1 and (f.energies or f.forces or not f.entries),
        alone=True,
    ),
    _less("PARAM_COUNT", lambda f: f.on_curves, alone=True),
    _naive("ALL_COUNTED", lambda f: f.naive < f.dof, alone=True),
    _more("FIXED_FORGOT", lambda f: f.fixed, alone=True),
    Misconception("NOT_SUBTRACTED", lambda f: f.n, lambda f: f.dof < f.n, anyway=True, alone=True),
    _more("POINT_6", lambda f: f.particles * (f.body_freedom - f.d), alone=True),
    _more("PLANE_FORGOT", lambda f: f.particles if f.d == 2 else 0, alone=True),
)


def explain(number: Fraction, ask: str, key: Key) -> tuple[str, ...]:
    """Return the codes of the errors that give ``number`` for the question ``ask``, the most likely first."""
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
    applying = [m for m in ERRORS if m.where(facts)]
    every = [m for m in applying if m.predicted(facts) == (number if m.anyway and ask != "k" else wanted)]
    likely = [m for m in every if not m.alone] or every
    return tuple(dict.fromkeys(m.code for m in likely))


def explain_label(part: str, entry: ConstraintEntry) -> tuple[str, str | Said]:
    """Return (code of a wrong label, feedback in place of the code's meaning or "")."""
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
