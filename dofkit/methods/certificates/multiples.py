"""A relation as a multiple of another, by normal forms."""

from __future__ import annotations

from fractions import Fraction
from typing import Any

from dofkit.checker.ring import CheckedRing
from dofkit.methods.certificates.scenery import Scenery
from dofkit.methods.certificates.texts import number_text


def multiple(scenery: Scenery, name: str, other: str) -> dict[str, Any] | None:
    """h and c with h name = c other, in symbols; None where other functions would be needed."""
    ring = scenery.evidence.ring
    one, by = (ring.read(scenery.evidence.relation(each).left) for each in (name, other))
    if by.above == 0:
        return None
    quotient = ring.times(one, ring.to_power(by, -1))
    above, below = (polynomial_text(ring, part) for part in quotient)
    return None if above is None or below is None else {"h": below, "c": {other: above}}


def polynomial_text(ring: CheckedRing, polynomial: Any) -> str | None:
    """A polynomial in symbols as a text."""
    names = {place: key[1] for key, place in ring.places.items() if key[0] == "symbol"}
    terms = []
    for exponents, coefficient in polynomial.terms():
        powers = {place: int(k) for place, k in enumerate(reversed(exponents)) if k}
        if not powers.keys() <= names.keys():
            return None
        factors = [f"{names[place]}^{k}" for place, k in powers.items()]
        terms.append("*".join([f"({number_text(Fraction(int(coefficient.p), int(coefficient.q)))})", *factors]))
    return " + ".join(terms) or "0"
