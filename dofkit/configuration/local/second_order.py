"""Where independent relations leave a manifold M and dependent ones do not vanish on it: what remains of M.

In the order in which it is asked, with m the dimension of M and mu that of the motions of the whole:

- one relation f: it changes sign (an indefinite second order, or what is left of it on its kernel): f separates M, and
  the set has dimension m - 1; definite: mu; one sign and zero on its critical set N: the set is N;
- several: a definite combination leaves mu (prestress stability); a bound of the second-order cone over the complex
  numbers that is mu does so too; else the bound stands where a branch of that dimension is found;
- where two motions are in question, initial forms of higher degree without a common zero leave mu (`initial`).
"""

from __future__ import annotations

from collections.abc import Sequence

from flint import arb

from dofkit.configuration.local.branches import largest_branch
from dofkit.configuration.local.critical_set import Split, along, split
from dofkit.configuration.local.initial_forms import by_initial_forms
from dofkit.configuration.local.manifold import Form, LocalDimension, Manifold
from dofkit.configuration.local.neighbourhood import holds_on_critical
from dofkit.configuration.local.quadratic_cone import bound, definite_combination, signature_of

#: The order to which a relation is followed on its critical set, and random directions in which its sign is looked at.
ORDER, DIRECTIONS = 12, 12
UNDECIDED = LocalDimension(None, "undecided", "the relations are dependent here and their lowest order does not decide")
CROSS = "the second order is an indefinite form: branches of the motion cross here"
DEFINITE = "to second order the dependent relation is a definite form: no finite motion"
TOGETHER = "a combination of them is definite to second order: no finite motion"


def by_signs(forms: Sequence[Form], rigid: int) -> LocalDimension | None:
    """What certified signs of the second-order forms alone decide."""
    m = len(forms[0])
    if len(forms) > 1:
        return LocalDimension(rigid, "proved", TOGETHER) if definite_combination(forms, m - rigid) else None
    positive, negative = signature_of(forms[0])
    if positive and negative:
        return LocalDimension(m - 1, "proved", CROSS)
    return LocalDimension(rigid, "proved", DEFINITE) if positive + negative == m - rigid else None


def decide(field: Manifold, ball: Manifold | None, rigid: int) -> LocalDimension:
    """The dimension of the set, where not all dependent relations vanish on M and m - mu is more than 1."""
    if ball is None:
        return UNDECIDED
    signs = ball.quadratic_forms()
    told = by_signs(signs, rigid)
    if told is not None:
        return told
    forms = field.quadratic_forms()
    told = (_one if len(forms) == 1 else _several)(field, ball, forms, signs, rigid)
    return told if told.dimension is not None else by_initial_forms(field, ball, rigid) or UNDECIDED


def _one(field: Manifold, ball: Manifold, forms: Sequence[Form], signs: Sequence[Form], rigid: int) -> LocalDimension:
    """One relation whose second order is a form of one sign with a kernel beyond the rigid motions, or 0."""
    m = field.dimension
    parts = split(forms)
    positive, negative = signature_of(signs[0])
    if positive + negative != len(parts.solved):
        return UNDECIDED
    left = along(field, forms, parts, [field.base.random() for _ in parts.free], ORDER)[0]
    order = next((k for k in range(ORDER) if left.coefficient(k) != 0), None)
    if order is None:
        if not parts.solved or not holds_on_critical(ball, parts, _ahead(ball, parts)):
            return UNDECIDED
        why = f"to order {ORDER - 1} the dependent relation has its least value along a motion, all of it singular"
        return LocalDimension(len(parts.free), "probable", why)
    if order % 2:
        why = f"beyond its second order the dependent relation changes sign at order {order}: the motion goes on"
        return LocalDimension(m - 1, "probable", why)
    seen = {s for s in _signs(ball, signs, parts, order) if s}
    own = {1} if positive else {-1} if negative else set()
    if len(seen | own) > 1:
        return LocalDimension(
            m - 1, "probable", f"beyond its second order the dependent relation changes sign at order {order}"
        )
    if own == seen and len(parts.free) - rigid == 1:
        return LocalDimension(
            rigid, "probable", f"the dependent relation is definite at order {order}: no finite motion"
        )
    return UNDECIDED


def _ahead(ball: Manifold, parts: Split) -> list[float]:
    return [ball.base.rng.choice((-1, 1)) * ball.base.rng.randrange(128, 256) / 256 for _ in parts.free]


def _signs(ball: Manifold, signs: Sequence[Form], parts: Split, order: int) -> list[int]:
    """Signs of the relation's leading coefficient on its critical set; 0 where a ball does not tell."""
    rng = ball.base.rng
    found = []
    for _ in range(DIRECTIONS):
        direction = [arb(rng.choice((-1, 1)) * rng.randrange(64, 512)) / 256 for _ in parts.free]
        value = along(ball, signs, parts, direction, order + 1)[0].coefficient(order)
        found.append(0 if value.contains(0) else 1 if value > 0 else -1)
    return found


def _several(
    field: Manifold, ball: Manifold, forms: Sequence[Form], signs: Sequence[Form], rigid: int
) -> LocalDimension:
    most = bound(forms, rigid)
    if most == rigid:
        return LocalDimension(rigid, "proved", "no first-order motion satisfies the second order: no finite motion")
    parts = split(forms)
    if len(parts.free) == most:
        left = along(field, forms, parts, [field.base.random() for _ in parts.free], ORDER)
        if all(s.poly.degree() < 0 for s in left) and holds_on_critical(ball, parts, _ahead(ball, parts)):
            why = f"a motion that is singular all along holds to order {ORDER - 1}, and the second order allows no more"
            return LocalDimension(most, "probable", why)
    if largest_branch(ball, signs, most) == most:
        why = "a motion was followed away from here to high precision, and the second order allows no more"
        return LocalDimension(most, "numeric", why)
    return UNDECIDED
