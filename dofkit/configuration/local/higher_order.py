"""What is decided beyond the second order: on the critical set N of dependent equations, or by a branch.

For one equation f = Q(y) + g(z) in suitable coordinates, Q its second-order part, N = {y = 0} and g its values on N
(splitting lemma). If Q has one sign and g = 0, the set is N. If they take both signs together, the set has dimension
m - 1. If they have one sign and g is a function of one variable modulo rigid motions of the system, the set consists of
those motions. Of several equations, N is a branch of the set if all of them vanish on it, and the second-order cone
bounds what else there is; the same holds for a branch that is continued numerically.
"""

from __future__ import annotations

from dofkit.configuration.local.branches import largest_branch
from dofkit.configuration.local.germ import CRITICAL_ORDER, Conclusion, Germ
from dofkit.configuration.local.neighbourhood import holds_on_critical
from dofkit.configuration.local.second_order import one_form


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
