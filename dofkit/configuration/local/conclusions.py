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

Where time is a column, the set decides: if it is constant there, nothing moves through it (``confined``). A
definite form stops it, and the cone of an indefinite one lies in no hyperplane dt = 0.
"""

from __future__ import annotations

from dofkit.configuration.local.branches import largest_branch
from dofkit.configuration.local.germ import CRITICAL_ORDER, LONG_ORDER, Conclusion, Germ, time_moves
from dofkit.configuration.local.neighbourhood import holds_on_critical
from dofkit.configuration.local.quadratic_cone import definite_combination

INDEPENDENT = "all equations are independent here (implicit function theorem)"
KEPT = "the equations kept are independent within the precision"
UNSEEN: dict[bool | None, str] = {
    False: "but not at a finite distance",
    None: "which could not be continued to a finite distance",
}
HIGH = "but their degree is higher than the order that was examined"
WHOLE = "the only infinitesimal motions are rigid motions of the system"


def manifold(germ: Germ) -> Conclusion | None:
    """k = 0: the set is M, of dimension m [ImplicitFunctions]."""
    if germ.dependent:
        return None
    return _timed(germ, Conclusion(germ.m, INDEPENDENT if germ.exact else KEPT))


def orbit(germ: Germ) -> Conclusion | None:
    """m = mu: the set contains the rigid motions' orbit, and its tangents are those of the orbit [AsimowRoth1978]."""
    return Conclusion(germ.rigid, WHOLE, germ.time is not None) if germ.m == germ.rigid else None


def whole_manifold(germ: Germ) -> Conclusion | None:
    """What is 0 along a random curve to an order above its degree is 0 on M, with high probability [SchwartzZippel]."""
    if not (germ.vanishes and germ.order > germ.degree and germ.vanishes_away):
        return None
    if germ.exact:
        why = (
            f"the dependent equations are satisfied along a random curve to order {germ.order - 1}: the motion is "
            "finite"
        )
    else:
        why = "the dependent equations are satisfied along a random curve within the precision"
    return _timed(germ, Conclusion(germ.m, why))


def flat(germ: Germ) -> Conclusion | None:
    """Return no dimension where the f_i are 0 along a random curve of M and not seen to be 0 on M [SchwartzZippel].

    They may begin at a higher order: a polynomial of degree d with s^d, one whose degree is not known (because a column
    is given implicitly) with any.
    """
    if not germ.vanishes:
        return None
    to = f" to order {germ.order - 1}" if germ.exact else ""
    but = HIGH if germ.order <= germ.degree else UNSEEN[germ.vanishes_away]
    return Conclusion(None, f"the dependent equations are satisfied along a random curve{to}, {but}")


def isolated_zero(germ: Germ) -> Conclusion | None:
    """m - mu = 1: an analytic function of one variable that is not 0 has isolated zeros [IsolatedZeros]."""
    if germ.m - germ.rigid != 1:
        return None
    why = "the one infinitesimal motion violates an equation"
    if germ.exact:
        first = min(k for s in germ.series for k in range(germ.order) if s.coefficient(k) != 0)
        why = f"{why} at order {first}"
    return Conclusion(germ.rigid, why, germ.time is not None)


def _timed(germ: Germ, conclusion: Conclusion) -> Conclusion:
    """``conclusion`` for all of the manifold M, with time held against a random curve of it."""
    if germ.time is None or any(time_moves(germ.manifold, germ.time, order) for order in (2, LONG_ORDER)):
        return conclusion
    return conclusion._replace(verdict="probable", confined=True)


# Second order

CROSS = "the second-order form is indefinite: branches of the motion cross here"
DEFINITE = "the second-order form of the dependent equation is definite: no finite motion"
TOGETHER = "a combination of the dependent equations is definite to second order: no finite motion"


def indefinite(germ: Germ) -> Conclusion | None:
    """k = 1: a function that changes sign separates M: its zeros have dimension m - 1 [HurewiczWallman1941]."""
    if not _has_one_form(germ) or not all(germ.signature):
        return None
    if germ.time is not None and not (germ.ball is not None and time_moves(germ.ball, germ.time, 2)):
        return None
    return Conclusion(germ.m - 1, CROSS)


def definite(germ: Germ) -> Conclusion | None:
    """k = 1: a form that is definite across the orbit, on which f = 0, has f of one sign beside it [MorseBott]."""
    if not _has_one_form(germ) or all(germ.signature) or sum(germ.signature) != germ.m - germ.rigid:
        return None
    return Conclusion(germ.rigid, DEFINITE, germ.time is not None)


def prestress_stable(germ: Germ) -> Conclusion | None:
    """k > 1: a sum w_i f_i that is definite across the orbit: prestress stability [ConnellyWhiteley1996]."""
    if germ.ball is None or germ.dependent < 2 or not definite_combination(germ.signs, germ.m - germ.rigid):
        return None
    return Conclusion(germ.rigid, TOGETHER, germ.time is not None)


# Higher order, over both engines, where time is no column


def least_along_a_motion(germ: Germ) -> Conclusion | None:
    """k = 1, Q of one sign and g = 0: the set is N, all of it singular [GromollMeyer1969]."""
    if not _splits(germ) or germ.remainder_order is not None or not germ.critical.solved:
        return None
    if not _vanishes_on_critical(germ):
        return None
    why = (
        f"to order {CRITICAL_ORDER - 1} the dependent equation attains its minimum along a motion that is "
        "singular throughout"
    )
    return Conclusion(len(germ.critical.free), why)


def changing_sign(germ: Germ) -> Conclusion | None:
    """k = 1, Q and the lowest order of g have both signs together: f separates M [HurewiczWallman1941]."""
    order = germ.remainder_order if _splits(germ) else None
    if order is None:
        return None
    why = f"beyond its second order the dependent equation changes sign at order {order}"
    if order % 2:
        return Conclusion(germ.m - 1, f"{why}: the motion is finite")
    positive, negative = germ.signature
    signs = germ.remainder_signs | ({1} if positive else set()) | ({-1} if negative else set())
    return Conclusion(germ.m - 1, why) if len(signs) > 1 else None


def critical_branch(germ: Germ) -> Conclusion | None:
    """k > 1: all f_i vanish on N, whose dimension is that of the second-order cone [TangentCone]."""
    if not _has_cone(germ) or len(germ.critical.free) != germ.cone:
        return None
    if any(s.poly.degree() >= 0 for s in germ.remainders) or not _vanishes_on_critical(germ):
        return None
    return Conclusion(
        germ.cone,
        f"a motion that is singular all along holds to order {CRITICAL_ORDER - 1}, and the second order allows no more",
    )


def branch_followed(germ: Germ) -> Conclusion | None:
    """k > 1: a branch of the dimension of the second-order cone is seen; there is no larger one [TangentCone]."""
    if not _has_cone(germ) or germ.ball is None or largest_branch(germ.ball, germ.signs, germ.cone) != germ.cone:
        return None
    why = "a finite motion was continued from here to high precision, and the second-order condition allows no more"
    return Conclusion(germ.cone, why)


def _vanishes_on_critical(germ: Germ) -> bool:
    """Return whether the dependent relations vanish on N at a distance too."""
    return germ.ball is not None and holds_on_critical(germ.ball, germ.critical, germ.ahead())


def _has_one_form(germ: Germ) -> bool:
    """k = 1, with balls to tell signs."""
    return germ.ball is not None and germ.dependent == 1


def _splits(germ: Germ) -> bool:
    """k = 1 over both engines, time is no column, and balls see the whole rank of Q."""
    both = _has_one_form(germ) and germ.exact and germ.time is None
    return both and sum(germ.signature) == len(germ.critical.solved)


def _has_cone(germ: Germ) -> bool:
    """k > 1 over both engines, and time is no column."""
    return germ.ball is not None and germ.dependent > 1 and germ.exact and germ.time is None
