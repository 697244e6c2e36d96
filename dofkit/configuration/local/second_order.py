"""What the second order decides, where the dependent relations f_1, ..., f_k do not vanish on the manifold M.

One relation with an indefinite form changes sign: it separates M, and the set has dimension m - 1. A form, or a
combination of several, that is definite across the motions of the whole leaves only these. Of several, the set's
tangent cone lies in the cone of their forms: where that is no more than the motions of the whole, so is the set.

Where time is a column, a definite form stops it, and an indefinite one's cone lies in no hyperplane dt = 0.
"""

from __future__ import annotations

from dofkit.configuration.local.germ import Conclusion, Germ, time_moves
from dofkit.configuration.local.quadratic_cone import definite_combination

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
