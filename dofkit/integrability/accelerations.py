"""Second derivatives in a constraint: integrated once where that is possible.

E = sum a_i(q, qdot, t) qddot_i + b(q, qdot, t) = 0 is integrable once where mu E = dF/dt along every motion for some
F(q, qdot, t): a_i mu = dF/dqdot_i, and b mu = sum dF/dq_i qdot_i + dF/dt. The constraint then reads F = C,
with a constant C that the initial state sets. What is found is proved: dF/dt - mu E is 0 in the canonical ring.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from itertools import chain
from itertools import product as cartesian

from dofkit.base.errors import TextError
from dofkit.exact.ring.program import raising_no_value
from dofkit.exact.zero import certainly_nonzero, zero_and_verdict
from dofkit.expressions import tree as ex
from dofkit.expressions.calculus import (
    NOT_LINEAR,
    SOLVE_FOR_IT,
    accelerations_of,
    by_time,
    diff,
    in_velocities,
    substitute,
)
from dofkit.expressions.text.printing import to_text
from dofkit.expressions.tree import Expr
from dofkit.integrability.integrals.potentials import Algebra, GivenUpError, potential
from dofkit.relations.normal.normal_form import linear_form, normalise
from dofkit.relations.normal.pieces import Normal, Piece
from dofkit.relations.normal.zero_set import zero_set

#: Factors mu that are tried.
MAX_FACTORS = 24

NOT_INTEGRABLE = "the second derivatives are not the time derivative of any function of positions, velocities and time"
WHAT_TO_DO = "integrate it by hand and write the result, or write it as an equation of motion"


@dataclass(frozen=True)
class Once:
    """dF/dt = ``factor`` times what was integrated; F is ``integral``."""

    integral: Expr
    factor: Expr


def without_accelerations(e: Expr, positive: frozenset[Expr], fresh: Iterator[str]) -> Normal:
    """What ``e = 0`` says, its second derivatives integrated once; ``fresh`` names the constants.

    A constant is a coordinate of its own that does not move, so that what the other constraints say of it is seen.
    Raises TextError where a second derivative cannot be integrated.
    """
    rates, _ = in_velocities(e)
    moving = frozenset(s for s in rates.symbols if s.args[0] != "parameter")
    branches, notes = zero_set(rates, positive, moving)
    pieces_of: list[tuple[Piece, ...]] = []
    said, constants, integrated = list(notes), list[str](), list[str]()
    for branch in branches:
        of_factors = []
        for g in branch:
            if accelerations_of(g):
                once, constant = integrated_once(g, positive), next(fresh)
                constants.append(constant)
                integrated.append(_integration_note(once, constant))
                g = once.integral - ex.coordinate(constant)
            normal = normalise(g, positive, True)
            said += normal.notes
            of_factors.append(normal.branches)
        pieces_of += [tuple(p for part in choice for p in part) for choice in cartesian(*of_factors)]
    special = [f"{c} = 0 is a special case, in which time may not occur and the labels may differ" for c in constants]
    return Normal(
        tuple(pieces_of), tuple(dict.fromkeys((*integrated, *special, *said))), tuple(constants), "; ".join(integrated)
    )


def _integration_note(once: Once, constant: str) -> str:
    times = "" if once.factor == ex.ONE else f", after multiplying by {to_text(once.factor)}"
    return (
        f"integrated once{times}: {to_text(once.integral)} = {constant}; the constant is determined by the "
        "initial conditions"
    )


def integrated_once(e: Expr, positive: frozenset[Expr]) -> Once:
    """F and mu with dF/dt = mu E, proved. Raises TextError where none was found, with what stands in the way."""
    slopes = {ex.velocity(str(s.args[1])): diff(e, s) for s in accelerations_of(e)}
    if any(accelerations_of(slope) for slope in slopes.values()):
        raise TextError(NOT_LINEAR, hint=SOLVE_FOR_IT)
    static = substitute(e, dict.fromkeys(accelerations_of(e), ex.ZERO))
    work = Algebra(positive)
    try:
        for factor in _factors(slopes):
            integral = _with_factor(work, factor, slopes, static)
            if integral is not None and _sound(integral, factor) and _proved(e, Once(integral, factor), positive):
                return Once(integral, factor)
    except (GivenUpError, RecursionError, ArithmeticError):
        pass
    raise TextError(NOT_INTEGRABLE, hint=WHAT_TO_DO)


def _factors(slopes: Mapping[Expr, Expr]) -> Iterator[Expr]:
    """1; then one over a coefficient, over products of two coordinates or velocities, and over their squares."""
    symbols = chain.from_iterable(a.symbols | {v} for v, a in slopes.items())
    moving = sorted({s for s in symbols if s.args[0] in ("coordinate", "velocity")}, key=repr)
    products = [a * b for i, a in enumerate(moving) for b in moving[i:]]
    proposed = [ex.ONE, *(1 / a for a in slopes.values()), *(1 / s for s in moving), *(1 / p for p in products)]
    yield from dict.fromkeys(proposed[:MAX_FACTORS])


@raising_no_value
def _with_factor(work: Algebra, factor: Expr, slopes: Mapping[Expr, Expr], static_terms: Expr) -> Expr | None:
    """F, by the velocities first, then by coordinates and time; None where mu E is seen to be no rate."""
    form = {v: work.tidy(factor * a) for v, a in slopes.items()}
    mentioned = {s for a in form.values() for s in a.symbols if s.args[0] == "velocity"} - set(form)
    whole = form | dict.fromkeys(sorted(mentioned, key=repr), ex.ZERO)
    if not work.closed(whole):
        return None
    kinetic = potential(work, whole)
    rate = None if kinetic is None else by_time(kinetic)
    if kinetic is None or rate is None:
        return None
    carried = substitute(rate, dict.fromkeys(accelerations_of(rate), ex.ZERO))
    remainder = work.tidy(factor * static_terms - carried)
    if remainder.is_zero:
        return kinetic
    linear = linear_form(remainder)
    if linear is None:
        return None
    place = {ex.coordinate(name): a for name, a in linear.coefficients.items()} | {ex.TIME: linear.dt}
    others = {s for a in place.values() for s in a.symbols if s.args[0] == "coordinate"} - set(place)
    place |= dict.fromkeys(sorted(others, key=repr), ex.ZERO)
    static = potential(work, place) if work.closed(place) else None
    return None if static is None else kinetic + static


def _sound(integral: Expr, factor: Expr) -> bool:
    """A factor in velocities may not bring logarithms and roots: they know one sign of the velocities only."""
    if not any(s.args[0] == "velocity" for s in factor.symbols):
        return True
    return all(n.op not in ("fn", "call") and (n.op != "pow" or _whole(n.args[1])) for n in ex.nodes(integral))


def _whole(exponent: Expr) -> bool:
    return exponent.op == "num" and bool(exponent.args[0].denominator == 1)


def _proved(e: Expr, once: Once, positive: frozenset[Expr]) -> bool:
    """dF/dt = mu E identically, and mu is not 0."""
    rate = by_time(once.integral)
    if rate is None or zero_and_verdict(rate - once.factor * e, positive) != (True, "proved"):
        return False
    return once.factor.op == "num" or certainly_nonzero(once.factor, positive)
