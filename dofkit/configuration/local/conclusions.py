"""A function for each criterion for the local dimension, which returns its `Conclusion` or None.

P, M, m, k, f_i and mu are those of `germ`: k dependent relations f_i on the manifold M of dimension m, and a
mu-dimensional orbit of rigid motions of the system.

First order: if all relations are independent the set is M. If there are no velocities other than those of rigid motions
it is their orbit. Otherwise the f_i are expanded along a random curve of M as power series: if they are 0, also at a
distance, the set is M; if they are not and m = mu + 1, the set is the orbit.

Second order: a single f with an indefinite form changes sign, so that it separates M, and the set has dimension m - 1.
If a form, or a combination of several, is definite modulo the rigid motions, the set is the orbit. In general the
tangent cone of the set is contained in the cone of the forms.

Higher order: a single f is Q(y) + g(z) in suitable coordinates, with its second-order part Q, N = {y = 0}, and its
values g on N (splitting lemma). For several f_i, N is a branch of the set if all of them vanish on it, and the
second-order cone bounds all branches; so it does for a branch that is followed numerically.

If time is a column and is constant on the set, no motion passes through the point (``confined``). It is constant if a
form is definite; the cone of an indefinite form is in no hyperplane dt = 0.
"""

from __future__ import annotations

from dofkit.configuration.local.branches import largest_branch
from dofkit.configuration.local.germ import CRITICAL_ORDER, LONG_ORDER, Conclusion, Germ, ahead, time_moves
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
    """Conclude the dimension m if k = 0: the set is M [ImplicitFunctions]."""
    if germ.dependent:
        return None
    return _timed(germ, Conclusion(germ.m, INDEPENDENT if germ.exact else KEPT))


def orbit(germ: Germ) -> Conclusion | None:
    """Conclude mu if m = mu: the set contains the orbit, and all its tangents are the orbit's [AsimowRoth1978]."""
    return Conclusion(germ.rigid, WHOLE, germ.time is not None) if germ.m == germ.rigid else None


def whole_manifold(germ: Germ) -> Conclusion | None:
    """Conclude m if all f_i are 0 along a random curve to an order above their degree, and away [SchwartzZippel]."""
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
    """Conclude no dimension if all f_i are 0 along a random curve of M, but not known to be 0 on M [SchwartzZippel].

    The first nonzero order may be higher: up to the degree of a polynomial, any if a column is given implicitly.
    """
    if not germ.vanishes:
        return None
    to = f" to order {germ.order - 1}" if germ.exact else ""
    but = HIGH if germ.order <= germ.degree else UNSEEN[germ.vanishes_away]
    return Conclusion(None, f"the dependent equations are satisfied along a random curve{to}, {but}")


def isolated_zero(germ: Germ) -> Conclusion | None:
    """Conclude mu if m - mu = 1 and an f_i is not 0: zeros of analytic functions are isolated [IsolatedZeros]."""
    if germ.m - germ.rigid != 1:
        return None
    why = "the one infinitesimal motion violates an equation"
    if germ.exact:
        first = min(k for s in germ.series for k in range(germ.order) if s.coefficient(k) != 0)
        why = f"{why} at order {first}"
    return Conclusion(germ.rigid, why, germ.time is not None)


def _timed(germ: Germ, conclusion: Conclusion) -> Conclusion:
    """Return a ``conclusion`` that the set is M, as ``confined`` if time is constant along random curves of M."""
    if germ.time is None or any(time_moves(germ.manifold, germ.time, order) for order in (2, LONG_ORDER)):
        return conclusion
    return conclusion._replace(verdict="probable", confined=True)


# Second order

CROSS = "the second-order form is indefinite: branches of the motion cross here"
DEFINITE = "the second-order form of the dependent equation is definite: no finite motion"
TOGETHER = "a combination of the dependent equations is definite to second order: no finite motion"


def indefinite(germ: Germ) -> Conclusion | None:
    """Conclude m - 1 if k = 1 and the form has both signs: the zeros of f separate M [HurewiczWallman1941]."""
    if not _has_one_form(germ) or not all(germ.signature):
        return None
    if germ.time is not None and not (germ.ball is not None and time_moves(germ.ball, germ.time, 2)):
        return None
    return Conclusion(germ.m - 1, CROSS)


def definite(germ: Germ) -> Conclusion | None:
    """Conclude mu if k = 1 and the form is definite modulo the orbit: elsewhere f has one sign [MorseBott]."""
    if not _has_one_form(germ) or all(germ.signature) or sum(germ.signature) != germ.m - germ.rigid:
        return None
    return Conclusion(germ.rigid, DEFINITE, germ.time is not None)


def prestress_stable(germ: Germ) -> Conclusion | None:
    """Conclude mu if k > 1 and a sum w_i f_i is definite modulo the orbit, a prestress [ConnellyWhiteley1996]."""
    if germ.ball is None or germ.dependent < 2 or not definite_combination(germ.signs, germ.m - germ.rigid):
        return None
    return Conclusion(germ.rigid, TOGETHER, germ.time is not None)


# Higher order, with both engines, if time is no column


def least_along_a_motion(germ: Germ) -> Conclusion | None:
    """Conclude dim N if k = 1, Q has one sign and g = 0: the set is N, all of it singular [GromollMeyer1969]."""
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
    """Conclude m - 1 if k = 1 and Q with the lowest order of g has both signs: f separates M [HurewiczWallman1941]."""
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
    """Conclude the dimension d of the second-order cone if k > 1, dim N = d and all f_i are 0 on N [TangentCone]."""
    if not _has_cone(germ) or len(germ.critical.free) != germ.cone:
        return None
    if any(s.poly.degree() >= 0 for s in germ.remainders) or not _vanishes_on_critical(germ):
        return None
    return Conclusion(
        germ.cone,
        f"a motion that is singular all along holds to order {CRITICAL_ORDER - 1}, and the second order allows no more",
    )


def branch_followed(germ: Germ) -> Conclusion | None:
    """Conclude the dimension d of the second-order cone if k > 1 and a branch of dimension d is found [TangentCone]."""
    if not _has_cone(germ) or germ.ball is None or largest_branch(germ.ball, germ.signs, germ.cone) != germ.cone:
        return None
    why = "a finite motion was continued from here to high precision, and the second-order condition allows no more"
    return Conclusion(germ.cone, why)


def _vanishes_on_critical(germ: Germ) -> bool:
    """Return whether the dependent relations are 0 on N at a distance from the point."""
    if germ.ball is None:
        return False
    return holds_on_critical(germ.ball, germ.critical, ahead(germ.ball, len(germ.critical.free)))


def _has_one_form(germ: Germ) -> bool:
    """Return whether k = 1, and balls are available for signs."""
    return germ.ball is not None and germ.dependent == 1


def _splits(germ: Germ) -> bool:
    """Return whether k = 1 with both engines, time is no column, and balls certify the full rank of Q."""
    both = _has_one_form(germ) and germ.exact and germ.time is None
    return both and sum(germ.signature) == len(germ.critical.solved)


def _has_cone(germ: Germ) -> bool:
    """Return whether k > 1 with both engines, and time is no column."""
    return germ.ball is not None and germ.dependent > 1 and germ.exact and germ.time is None
