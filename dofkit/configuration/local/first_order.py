"""What the first order decides, and series along a random curve of the manifold M of the independent relations.

With all relations independent the set is M. With no velocities but those of the whole it is the orbit of the whole.
Else the dependent relations f_i are followed along a random curve of M as power series: all zero, and zero at a
distance too, the set is M; not zero, and one motion beside those of the whole, only these are left.

Where time is a column it is held against the set: if it is constant there, nothing moves through it (``confined``).
"""

from __future__ import annotations

from dofkit.configuration.local.germ import LONG_ORDER, LONGEST, Conclusion, Germ, time_moves

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
