"""What each criterion for the local dimension concludes, from the first order, the second, or a higher one.

First order: with all relations independent the set is the manifold M that they cut out. With no velocities but those of
rigid motions of the system it is their orbit. Else the dependent relations f_i are followed along a random curve of M
as power series: all zero, and zero at a distance too, the set is M; not zero, and one motion besides rigid motions of
the system, only these remain.

Second order: one relation with an indefinite form changes sign: it separates M, and the set has dimension m - 1. A
form, or a combination of several, that is definite across the rigid motions leaves only these. Of several, the set's
tangent cone lies in the cone of their forms.

Beyond: one relation is f = Q(y) + g(z) in suitable coordinates, Q its second-order part, N = {y = 0} and g its values
on N (splitting lemma). Of several, N is a branch of the set if all of them vanish on it, and the second-order cone
bounds what else there is; the same holds for a branch that is continued numerically.

Where time is a column it is held against the set: if it is constant there, nothing moves through it (``confined``). A
definite form stops it, and the cone of an indefinite one lies in no hyperplane dt = 0.
"""

from __future__ import annotations

from dofkit.configuration.local.branches import largest_branch
from dofkit.configuration.local.germ import CRITICAL_ORDER, LONG_ORDER, LONGEST, Conclusion, Germ, time_moves
from dofkit.configuration.local.neighbourhood import holds_on_critical
from dofkit.configuration.local.quadratic_cone import definite_combination

INDEPENDENT = "all equations are independent here (implicit function theorem)"
KEPT = "the equations kept are independent within the precision"
UNSEEN = {False: "but not at a finite distance", None: "which could not be continued to a finite distance"}
FLAT = "may vanish here to a higher order than was examined"
WHOLE = "the only infinitesimal motions are rigid motions of the system"


def independent(germ: Germ) -> bool:
    """k = 0: are all relations independent at the point?"""
    return germ.dependent == 0


def manifold(germ: Germ) -> Conclusion:
    """The set is M, of dimension m [ImplicitFunctions]."""
    return _timed(germ, Conclusion(germ.m, INDEPENDENT if germ.exact else KEPT))


def rigid_to_first_order(germ: Germ) -> bool:
    """m = mu: is every velocity that the relations allow one of the whole as a rigid body?"""
    return germ.m == germ.rigid


def orbit(germ: Germ) -> Conclusion:
    """The set holds the orbit of the whole, and its tangents are no more than the orbit's [AsimowRoth1978]."""
    return Conclusion(germ.rigid, WHOLE, germ.time is not None)


def of_high_degree(germ: Germ) -> bool:
    """Is a dependent relation of a degree to which it is not followed?"""
    return germ.degree >= (LONGEST if germ.exact else LONG_ORDER)


def unfollowed(germ: Germ) -> Conclusion:
    """A polynomial of degree d may begin with s^d along a line: below that order nothing is seen [SchwartzZippel]."""
    return Conclusion(None, f"a relation of degree {germ.degree} {FLAT}" if germ.exact else f"a relation {FLAT}")


def vanishing(germ: Germ) -> bool:
    """Are the f_i 0 along a random curve of M, to an order above their degree, and at a distance?"""
    return germ.vanishes and germ.vanishes_away is True


def whole_manifold(germ: Germ) -> Conclusion:
    """What is 0 along a random curve to an order above its degree is 0 on M, with high probability [SchwartzZippel]."""
    if germ.exact:
        why = (
            f"the dependent equations are satisfied along a random curve to order {germ.order - 1}: the motion is "
            "finite"
        )
    else:
        why = "the dependent equations are satisfied along a random curve within the precision"
    return _timed(germ, Conclusion(germ.m, why))


def vanishing_here(germ: Germ) -> bool:
    """Are the f_i 0 along a random curve of M, and not seen to be 0 at a distance?"""
    return germ.vanishes


def flat(germ: Germ) -> Conclusion:
    """Where the degree is not known (a column given implicitly), 0 to some order is no proof of 0 [SchwartzZippel]."""
    to = f" to order {germ.order - 1}" if germ.exact else ""
    return Conclusion(
        None, f"the dependent equations are satisfied along a random curve{to}, {UNSEEN[germ.vanishes_away]}"
    )


def of_one_variable(germ: Germ) -> bool:
    """m - mu = 1 and some f_i is not 0 on M: functions of one variable across the motions of the whole."""
    return germ.m - germ.rigid == 1


def isolated_zero(germ: Germ) -> Conclusion:
    """An analytic function of one variable that is not 0 has isolated zeros: the set is the orbit [IsolatedZeros]."""
    why = "the one infinitesimal motion violates an equation"
    if germ.exact:
        first = min(k for s in germ.series for k in range(germ.order) if s.coefficient(k) != 0)
        why = f"{why} at order {first}"
    return Conclusion(germ.rigid, why, germ.time is not None)


def _timed(germ: Germ, told: Conclusion) -> Conclusion:
    """``told`` of the whole manifold M, with time held against a random curve of it."""
    if germ.time is None or any(time_moves(germ.manifold, germ.time, order) for order in (2, LONG_ORDER)):
        return told
    return told._replace(verdict="probable", confined=True)


# Second order

CROSS = "the second-order form is indefinite: branches of the motion cross here"
DEFINITE = "the second-order form of the dependent equation is definite: no finite motion"
TOGETHER = "a combination of the dependent equations is definite to second order: no finite motion"
NO_FLEX = "no infinitesimal motion satisfies the second-order condition: no finite motion"


def one_form(germ: Germ) -> bool:
    """k = 1, with balls to tell signs."""
    return germ.ball is not None and germ.dependent == 1


def indefinite(germ: Germ) -> Conclusion | None:
    """A function that changes sign separates M: its zeros have dimension m - 1 [HurewiczWallman1941]."""
    positive, negative = germ.signature
    if not (positive and negative):
        return None
    if germ.time is not None and not (germ.ball is not None and time_moves(germ.ball, germ.time, 2)):
        return None
    return Conclusion(germ.m - 1, CROSS)


def definite(germ: Germ) -> Conclusion | None:
    """A form that is definite across the orbit, on which f = 0, has f of one sign beside it [MorseBott]."""
    positive, negative = germ.signature
    if (positive and negative) or positive + negative != germ.m - germ.rigid:
        return None
    return Conclusion(germ.rigid, DEFINITE, germ.time is not None)


def several_forms(germ: Germ) -> bool:
    """k > 1, with balls to tell signs."""
    return germ.ball is not None and germ.dependent > 1


def prestress_stable(germ: Germ) -> Conclusion | None:
    """A combination sum w_i f_i that is definite across the orbit: prestress stability [ConnellyWhiteley1996]."""
    if not definite_combination(germ.signs, germ.m - germ.rigid):
        return None
    return Conclusion(germ.rigid, TOGETHER, germ.time is not None)


def several_forms_over_both(germ: Germ) -> bool:
    """k > 1, over GF(p) and over balls, and time is no column."""
    return several_forms(germ) and germ.exact and germ.time is None


def no_second_order_flex(germ: Germ) -> Conclusion | None:
    """The cone {Q_1 = ... = Q_k = 0} holds the tangent cone: of dimension mu, it leaves the orbit [TangentCone]."""
    return Conclusion(germ.rigid, NO_FLEX) if germ.cone == germ.rigid else None


# Higher order


def split_form(germ: Germ) -> bool:
    """k = 1 over both engines, time is no column, and balls see the whole rank of Q."""
    if not one_form(germ) or not germ.exact or germ.time is not None:
        return False
    return sum(germ.signature) == len(germ.parts.solved)


def least_along_a_motion(germ: Germ) -> Conclusion | None:
    """Q of one sign and g = 0: the set is N, all of it singular [GromollMeyer1969]."""
    if germ.remainder_order is not None or not germ.parts.solved or not _vanishes_on_critical(germ):
        return None
    why = (
        f"to order {CRITICAL_ORDER - 1} the dependent equation attains its minimum along a motion that is "
        "singular throughout"
    )
    return Conclusion(len(germ.parts.free), why)


def changing_sign(germ: Germ) -> Conclusion | None:
    """Q and the lowest order of g have both signs together: f separates M [HurewiczWallman1941]."""
    order = germ.remainder_order
    if order is None:
        return None
    why = f"beyond its second order the dependent equation changes sign at order {order}"
    if order % 2:
        return Conclusion(germ.m - 1, f"{why}: the motion is finite")
    return Conclusion(germ.m - 1, why) if len(germ.remainder_signs | _sign(germ)) > 1 else None


def definite_at_higher_order(germ: Germ) -> Conclusion | None:
    """Q and g have one sign, and g depends on one variable beside the motions of the whole [GromollMeyer1969]."""
    order = germ.remainder_order
    if order is None or germ.remainder_signs != _sign(germ) or len(germ.parts.free) - germ.rigid != 1:
        return None
    return Conclusion(germ.rigid, f"the dependent equation is definite at order {order}: no finite motion")


def critical_branch(germ: Germ) -> Conclusion | None:
    """All f_i vanish on N, whose dimension is that of the second-order cone [TangentCone]."""
    if len(germ.parts.free) != germ.cone:
        return None
    if any(s.poly.degree() >= 0 for s in germ.remainders) or not _vanishes_on_critical(germ):
        return None
    return Conclusion(
        germ.cone,
        f"a motion that is singular all along holds to order {CRITICAL_ORDER - 1}, and the second order allows no more",
    )


def branch_followed(germ: Germ) -> Conclusion | None:
    """A branch of the dimension of the second-order cone is seen, and there is no larger one [TangentCone]."""
    if germ.ball is None or largest_branch(germ.ball, germ.signs, germ.cone) != germ.cone:
        return None
    why = "a finite motion was continued from here to high precision, and the second-order condition allows no more"
    return Conclusion(germ.cone, why)


def _vanishes_on_critical(germ: Germ) -> bool:
    """Do the dependent relations vanish on N at a distance too?"""
    return germ.ball is not None and holds_on_critical(germ.ball, germ.parts, germ.ahead())


def _sign(germ: Germ) -> set[int]:
    """The sign of Q, where it has one."""
    positive, negative = germ.signature
    return {1} if positive else {-1} if negative else set()
