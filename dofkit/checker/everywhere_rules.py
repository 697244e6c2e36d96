"""Rules for numbers that hold everywhere: no part of the set is larger."""

from __future__ import annotations

from dofkit.checker.derivatives import derivative, symbols_in
from dofkit.checker.dimension_rules import Told, equal, is_here, regular
from dofkit.checker.errors import CheckError, refuse
from dofkit.checker.evidence import CheckedEvidence, own_symbols
from dofkit.checker.texts import has_value_everywhere, heads_in


def nothing(evidence: CheckedEvidence, claim: Told) -> None:
    """No equation: every coordinate is free."""
    refuse(evidence.finite or evidence.moving, "there are equations")
    refuse(claim.get("about", "everywhere") != "everywhere", "where nothing is asked a claim is about everywhere")
    equal(claim, len(evidence.problem.coordinates))


def everywhere(evidence: CheckedEvidence, claim: Told) -> None:
    """The dimension of the whole set, from relations of three kinds, with a regular point where there are others.

    ``order``: a relation gives a coordinate, a number times it and what is free or given before (a graph).
    ``blocks``: a single analytic relation that is not 0 everywhere has zeros of dimension n - 1 at most.
    ``generic``: relations with a symbol of their own in which they are nowhere stationary: for almost all values of
    these the set is a manifold (Sard 1942). Blocks, and the generic relations together, share no free coordinate.
    """
    refuse(evidence.moving or claim.get("about") != "everywhere", "the rule is about everywhere, of finite relations")
    order = [(name, q) for name, q in claim.get("order", [])]
    blocks = list(claim.get("blocks", evidence.finite if claim["rule"] == "one relation" else []))
    generic = dict(claim.get("generic", []))
    names = [*(name for name, _ in order), *blocks, *generic]
    refuse(sorted(names) != sorted(evidence.finite), "each finite relation stands in one place")
    free = _free(evidence, order)
    groups = [_coordinates(evidence, name, free) for name in blocks]
    groups.append(frozenset().union(*(_coordinates(evidence, name, free) for name in generic)))
    refuse(sum(map(len, groups)) != len(frozenset().union(*groups)), "two blocks share a coordinate")
    if blocks:
        _analytic(evidence, names)
    own_symbols(evidence, generic)
    if blocks or generic:
        minor = regular(evidence, claim["minor"])
        is_here(evidence, minor.point)
        refuse(set(minor.rows) != set(names), "the minor is not of all relations")
    equal(claim, len(evidence.problem.coordinates) - len(names))


def _analytic(evidence: CheckedEvidence, names: list[str]) -> None:
    for name in names:
        left = evidence.relation(name).left
        refuse(not has_value_everywhere(left) or "apply" in heads_in(left), f"`{name}` is not analytic everywhere")


def _free(evidence: CheckedEvidence, order: list[tuple[str, str]]) -> dict[str, frozenset[str]]:
    """On which coordinates those that are given depend."""
    later, found = [q for _, q in order], dict[str, frozenset[str]]()
    if len(set(later)) != len(later) or not set(later) <= set(evidence.problem.coordinates):
        raise CheckError("each relation gives a coordinate of its own")
    for i, (name, q) in enumerate(order):
        left = evidence.relation(name).left
        if not evidence.ring.rational(derivative(left, q)) or not has_value_everywhere(left):
            raise CheckError(f"`{name}` does not give `{q}` everywhere")
        refuse(not symbols_in(left).isdisjoint(later[i + 1 :]), f"`{name}` holds what is given later")
        found[q] = _coordinates(evidence, name, found) - {q}
    return found


def _coordinates(evidence: CheckedEvidence, name: str, given: dict[str, frozenset[str]]) -> frozenset[str]:
    held = symbols_in(evidence.relation(name).left) & set(evidence.problem.coordinates)
    return frozenset().union(*(given.get(q, frozenset((q,))) for q in held))


def generic_rank(evidence: CheckedEvidence, claim: Told) -> None:
    """Relations of constant rank r with generic symbols of their own: for almost all values dimension n - r everywhere.

    The values of points where the rank is smaller have measure 0 among those that are taken (Sard, Federer 3.4.3).
    """
    refuse(evidence.moving or claim.get("about") != "everywhere", "the rule is about everywhere, of finite relations")
    order, generic = [(name, q) for name, q in claim.get("order", [])], dict(claim["generic"])
    if sorted([*(name for name, _ in order), *generic]) != sorted(evidence.finite):
        raise CheckError("each finite relation stands in one place")
    _free(evidence, order)
    own_symbols(evidence, generic)
    _analytic(evidence, list(evidence.finite))
    minor = regular(evidence, claim["minor"])
    is_here(evidence, minor.point)
    blocks = [evidence.named("covers", name)["blocks"] for name in claim["covers"]]
    if {row for one in blocks for block in one for row in block["rows"]} != set(evidence.finite) or len(blocks) != 1:
        raise CheckError("one cover of all finite relations is needed")
    equal(claim, len(evidence.problem.coordinates) - len(minor.rows))
