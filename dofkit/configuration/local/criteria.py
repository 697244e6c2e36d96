"""The criteria for finite motion and rigidity, in the order in which they are asked.

The first row whose hypotheses hold and whose function comes to a conclusion decides. A new criterion is a function of
the germ (`germ.Germ`) and a row here; its theorem is a line of `dofkit/THEOREMS.md`.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import Literal

from dofkit.base.verdicts import ArgumentKey, Verdict, weakest
from dofkit.configuration.local import first_order, higher_order, second_order
from dofkit.configuration.local.germ import Conclusion, Germ
from dofkit.configuration.local.manifold import LocalDimension

UNDECIDED = LocalDimension(
    None, "undecided", "the equations are dependent here and their lowest-order terms do not decide"
)


@dataclass(frozen=True)
class Criterion:
    """A row of the table; m, mu, k, M and N as in `germ`.

    ``hypotheses`` in words, and ``applies``, which checks them; ``decide`` gives its conclusion, None where it comes to
    none. ``concludes``: "motion" where first-order motions, or some of them, are finite ones; "rigidity" where only
    motions of the whole are; "nothing" where the question is left open and no later row is asked. ``verdict``: how sure
    that is at the best; with balls alone it is "numeric".
    """

    key: ArgumentKey
    theorem: str
    hypotheses: str
    applies: Callable[[Germ], bool]
    concludes: Literal["motion", "rigidity", "nothing"]
    verdict: Verdict
    decide: Callable[[Germ], Conclusion | None]


#: What each conclusion means.
CONCLUSIONS = {
    "motion": "infinitesimal motions extend to finite motions",
    "rigidity": "there is no finite motion but the rigid motions of the system",
    "nothing": "no conclusion",
}
CRITERIA: tuple[Criterion, ...] = (
    Criterion(
        "independent relations",
        "ImplicitFunctions",
        "all equations are independent at the point (k = 0)",
        first_order.independent,
        "motion",
        "proved",
        first_order.manifold,
    ),
    Criterion(
        "rigid to first order",
        "AsimowRoth1978",
        "the equations allow only the velocities of rigid motions of the system (m = mu)",
        first_order.rigid_to_first_order,
        "rigidity",
        "proved",
        first_order.orbit,
    ),
    Criterion(
        "degree too high",
        "SchwartzZippel",
        "a dependent equation has a degree beyond the orders that are examined",
        first_order.of_high_degree,
        "nothing",
        "undecided",
        first_order.unfollowed,
    ),
    Criterion(
        "zero along a curve",
        "SchwartzZippel",
        "the dependent equations vanish along a random curve of M to an order above their degree, and at a "
        "finite distance",
        first_order.vanishing,
        "motion",
        "probable",
        first_order.whole_manifold,
    ),
    Criterion(
        "flat along a curve",
        "SchwartzZippel",
        "the dependent equations vanish along a random curve of M, but not, or not verifiably, at a finite distance",
        first_order.vanishing_here,
        "nothing",
        "undecided",
        first_order.flat,
    ),
    Criterion(
        "isolated zero of one variable",
        "IsolatedZeros",
        "one motion remains besides the rigid motions of the system (m = mu + 1), and a dependent equation "
        "is not zero along it",
        first_order.of_one_variable,
        "rigidity",
        "proved",
        first_order.isolated_zero,
    ),
    Criterion(
        "indefinite form",
        "HurewiczWallman1941",
        "one dependent equation, whose second order has certified squares of both signs; time, if any, moves on M",
        second_order.one_form,
        "motion",
        "proved",
        second_order.indefinite,
    ),
    Criterion(
        "definite form",
        "MorseBott",
        "one dependent equation, whose second order has m - mu certified squares, all of one sign",
        second_order.one_form,
        "rigidity",
        "proved",
        second_order.definite,
    ),
    Criterion(
        "definite combination",
        "ConnellyWhiteley1996",
        "several dependent equations, of whose second orders a combination has m - mu certified squares of one sign",
        second_order.several_forms,
        "rigidity",
        "proved",
        second_order.prestress_stable,
    ),
    Criterion(
        "least along a motion",
        "GromollMeyer1969",
        "one dependent equation, of second order of one sign, and which vanishes on its critical set N as "
        "far as examined",
        higher_order.split_form,
        "motion",
        "probable",
        higher_order.least_along_a_motion,
    ),
    Criterion(
        "change of sign",
        "HurewiczWallman1941",
        "one dependent equation, whose second order and lowest order on N together take both signs",
        higher_order.split_form,
        "motion",
        "probable",
        higher_order.changing_sign,
    ),
    Criterion(
        "definite at a higher order",
        "GromollMeyer1969",
        "one dependent equation, whose second order and lowest order on N are of one sign, and N has dimension mu + 1",
        higher_order.split_form,
        "rigidity",
        "probable",
        higher_order.definite_at_higher_order,
    ),
    Criterion(
        "no second-order flex",
        "TangentCone",
        "several dependent equations, whose second orders have a cone of common zeros of dimension mu, and no more",
        second_order.several_forms_over_both,
        "rigidity",
        "proved",
        second_order.no_second_order_flex,
    ),
    Criterion(
        "critical branch",
        "TangentCone",
        "several dependent equations, all zero on N as far as examined, which has the dimension of their "
        "second-order cone",
        second_order.several_forms_over_both,
        "motion",
        "probable",
        higher_order.critical_branch,
    ),
    Criterion(
        "branch followed",
        "TangentCone",
        "several dependent equations; a branch of the dimension of their second-order cone was found numerically",
        second_order.several_forms_over_both,
        "motion",
        "numeric",
        higher_order.branch_followed,
    ),
)


def decision(germ: Germ) -> tuple[Criterion | None, LocalDimension]:
    """The first criterion that decides, and what it says; None where all are asked and none does."""
    for criterion in CRITERIA:
        told = criterion.decide(germ) if criterion.applies(germ) else None
        if told is None:
            continue
        verdict = weakest(criterion.verdict, told.verdict, "proved" if germ.exact else "numeric")
        return criterion, LocalDimension(told.dimension, verdict, told.reason, told.confined, criterion.key)
    return None, UNDECIDED
